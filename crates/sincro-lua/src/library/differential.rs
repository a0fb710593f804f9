//! The pattern functions against those of Lua itself: the same results and the same errors for random patterns and
//! subjects.

use std::time::Duration;

use mlua::{Function, Lua, MultiValue, Value};
use proptest::prelude::*;
use proptest::test_runner::{Config, RngAlgorithm, TestRng, TestRunner};

use crate::fault;
use crate::guard::Guard;
use crate::sandbox;

/// Functions that are compared, as calls of a subject, a pattern and two more arguments.
const CALLS: &str = "
local function all(iterator, limit)
  local out = {}
  for k = 1, limit do
    local found = table.pack(iterator())
    out[#out + 1] = found.n
    for j = 1, found.n do out[#out + 1] = tostring(found[j]) end
  end
  return table.unpack(out)
end
local map = { a = 'A', b = false, ab = 7, [1] = 'one', [2] = 2.5 }
return {
  find = function(s, p, i, x) local a = table.pack(string.find(s, p, i)) return table.unpack(a, 1, a.n) end,
  plain = function(s, p, i, x) local a = table.pack(string.find(s, p, i, true)) return table.unpack(a, 1, a.n) end,
  match = function(s, p, i, x) local a = table.pack(string.match(s, p, i)) return table.unpack(a, 1, a.n) end,
  method = function(s, p, i, x) local a = table.pack(s:match(p, i)) return table.unpack(a, 1, a.n) end,
  gmatch = function(s, p, i, x) local a = table.pack(all(string.gmatch(s, p, i), 10)) return table.unpack(a, 1, a.n) end,
  text = function(s, p, i, x) local a = table.pack(string.gsub(s, p, x)) return table.unpack(a, 1, a.n) end,
  few = function(s, p, i, x) local a = table.pack(string.gsub(s, p, x, i)) return table.unpack(a, 1, a.n) end,
  table = function(s, p, i, x) local a = table.pack(string.gsub(s, p, map)) return table.unpack(a, 1, a.n) end,
  call = function(s, p, i, x)
    local seen = {}
    local a = table.pack(string.gsub(s, p, function(...)
      seen[#seen + 1] = table.concat({ select('#', ...), tostring((...)), tostring((select(2, ...))) }, ' ')
      if #seen % 3 == 0 then return nil end
      return x
    end))
    a[a.n + 1] = table.concat(seen, ';')
    return table.unpack(a, 1, a.n + 1)
  end,
}";

const NAMES: [&str; 9] = ["find", "plain", "match", "method", "gmatch", "text", "few", "table", "call"];

/// The functions in a state of Lua's own, and in one with the functions here.
struct Pair {
    plain: Lua,
    ours: Lua,
    functions: Vec<[Function; 2]>,
    guard: std::sync::Arc<Guard>,
}

impl Pair {
    fn new() -> Self {
        let plain = Lua::new();
        let guard = Guard::with_time_limit(u64::MAX, Duration::MAX);
        guard.begin();
        let ours = sandbox::new(&guard, 64 << 20).unwrap();
        let of = |lua: &Lua| lua.load(CALLS).set_name("=script").eval::<mlua::Table>().unwrap();
        let [theirs, own] = [of(&plain), of(&ours)];
        let functions = NAMES.map(|name| [theirs.get(name).unwrap(), own.get(name).unwrap()]).to_vec();
        Self { plain, ours, functions, guard }
    }

    /// Calls every function in both states; what is different.
    fn compare(&self, subject: &[u8], pattern: &[u8], init: Option<i64>, replacement: &[u8]) -> Result<(), String> {
        for (name, [theirs, own]) in NAMES.iter().zip(&self.functions) {
            let [expected, found] = [(&self.plain, theirs), (&self.ours, own)].map(|(lua, function)| {
                let texts = [subject, pattern, replacement].map(|bytes| lua.create_string(bytes).unwrap());
                let [s, p, x] = texts;
                told(function.call::<MultiValue>((s, p, init, x)))
            });
            if expected != found {
                let texts = [subject, pattern, replacement].map(|bytes| bytes.escape_ascii().to_string());
                return Err(format!("{name} {:?} {init:?}: expected {expected:?}, found {found:?}", &texts[1..]));
            }
        }
        self.guard.begin();
        Ok(())
    }
}

/// Results as bytes, or the error's message.
fn told(result: mlua::Result<MultiValue>) -> Result<Vec<String>, String> {
    let values = result.map_err(|error| fault::words(&error).0)?;
    Ok(values
        .iter()
        .map(|value| match value {
            Value::String(text) => format!("'{}'", text.as_bytes().escape_ascii()),
            other => format!("{other:?}"),
        })
        .collect())
}

/// Pieces that patterns are made of.
const PIECES: [&str; 64] = [
    "a", "b", "c", ".", "%a", "%d", "%s", "%w", "%A", "%W", "%p", "%l", "%u", "%x", "%c", "%g", "%z", "%%", "%.",
    "[ab]", "[^a]", "[a-c]", "[%a_]", "[]]", "[^]]", "[a-]", "[%-a]", "[a%]b]", "[c-a]", "[%d.-]", "[%w-z]", "(", ")",
    "()", "(a)", "(.-)", "(.*)", "(a*)", "%1", "%2", "%b()", "%bab", "%baa", "%f[%w]", "%f[^%w]", "%f[%z]", "*", "+",
    "-", "?", "a*", "a+", "a-", "a?", ".-", ".*", "$", "^", "%", "[", "%b", "%f", "%0", "]",
];

/// Pieces that subjects and replacements are made of.
const SUBJECTS: [&str; 16] =
    ["a", "a", "b", "ab", "c", "(", ")", " ", "1", "x_1", ".", "%", "-", "\0", "\u{e9}", "aab"];
const REPLACEMENTS: [&str; 10] = ["x", "", "%0", "%1", "%2", "%%", "%9", "%a", "%", "a"];

fn joined(pieces: &'static [&'static str], n: usize) -> impl Strategy<Value = String> {
    prop::collection::vec(prop::sample::select(pieces), 0..n).prop_map(|pieces| pieces.concat())
}

/// Number of random cases; each is a call of nine functions.
const CASES: u32 = 20_000;

#[test]
fn random_patterns_give_what_lua_gives() {
    let pair = Pair::new();
    let config = Config { cases: CASES, failure_persistence: None, ..Config::default() };
    let mut runner = TestRunner::new_with_rng(config, TestRng::deterministic_rng(RngAlgorithm::ChaCha));
    let cases = (joined(&SUBJECTS, 10), joined(&PIECES, 7), prop::option::of(-12_i64..14), joined(&REPLACEMENTS, 3));
    let done = runner.run(&cases, |(subject, pattern, init, replacement)| {
        pair.compare(subject.as_bytes(), pattern.as_bytes(), init, replacement.as_bytes()).map_err(TestCaseError::fail)
    });
    done.unwrap_or_else(|error| panic!("{error}"));
}

#[test]
fn random_bytes_give_what_lua_gives() {
    let pair = Pair::new();
    let config = Config { cases: CASES / 4, failure_persistence: None, ..Config::default() };
    let mut runner = TestRunner::new_with_rng(config, TestRng::deterministic_rng(RngAlgorithm::ChaCha));
    let bytes = || prop::collection::vec(prop_oneof![any::<u8>(), prop::sample::select(&b"%[]()*+-?^$.ab"[..])], 0..12);
    let done = runner.run(&(bytes(), bytes()), |(subject, pattern)| {
        pair.compare(&subject, &pattern, None, b"<%0>").map_err(TestCaseError::fail)
    });
    done.unwrap_or_else(|error| panic!("{error}"));
}

#[test]
fn classes_have_the_bytes_that_lua_gives_them() {
    let pair = Pair::new();
    let subject: Vec<u8> = (0..=u8::MAX).collect();
    for letter in 0..=u8::MAX {
        for pattern in [
            vec![b'%', letter],
            vec![b'[', b'%', letter, b']'],
            vec![b'[', b'^', b'%', letter, b']'],
            vec![b'[', letter, b'-', b'z', b']'],
        ] {
            pair.compare(&subject, &pattern, None, b"x").unwrap_or_else(|error| panic!("{error}"));
        }
    }
}

#[test]
fn chosen_patterns_give_what_lua_gives() {
    let pair = Pair::new();
    let many = "(a)".repeat(33);
    let deep = "a?".repeat(250);
    let cases: [(&str, &str); 40] = [
        ("", ""),
        ("", "^"),
        ("", "$"),
        ("", "()"),
        ("abc", ""),
        ("abc", "^$"),
        ("a$b", "a$b"),
        ("a^b", "a^b"),
        ("^a", "^^a"),
        ("key = value", "^(%w+)%s*=%s*(%w+)$"),
        ("  trim  ", "^%s*(.-)%s*$"),
        ("hello world", "o w"),
        ("f(a(b)c)d", "%b()"),
        ("THE (quick) fox", "%f[%a]%a+%f[%A]"),
        ("\"quoted\" 'x'", "([\"'])(.-)%1"),
        ("2024-01-31", "(%d+)-(%d+)-(%d+)"),
        ("abab", "(ab)%1"),
        ("aXb", "()X()"),
        ("aa", "()%1"),
        ("abc", "(a(b(c)))"),
        ("abc", "(a"),
        ("abc", "a)"),
        ("abc", "%"),
        ("abc", "[a"),
        ("abc", "[]"),
        ("abc", "[^]"),
        ("abc", "[%"),
        ("abc", "[%]"),
        ("abc", "x["),
        ("abc", "%f"),
        ("abc", "%b"),
        ("abc", "%ba"),
        ("abc", "%1"),
        ("abc", "(a)%2"),
        ("abc", "(a%1)"),
        ("a\0b", "a%zb"),
        ("a\0b", "[%z]"),
        ("a.b-c", "[.-]"),
        (&"a".repeat(40), &many),
        (&"a".repeat(300), &deep),
    ];
    for (subject, pattern) in cases {
        for init in [None, Some(1), Some(2), Some(-1), Some(0), Some(100), Some(i64::MIN), Some(i64::MAX)] {
            for replacement in ["x", "<%0>", "%1%2", "%", "%%", "%x"] {
                let done = pair.compare(subject.as_bytes(), pattern.as_bytes(), init, replacement.as_bytes());
                done.unwrap_or_else(|error| panic!("{error}"));
            }
        }
    }
}

/// Calls with arguments of wrong types, and library functions beside those of patterns: text of a function's body.
#[test]
fn arguments_are_taken_and_refused_as_in_lua() {
    let pair = Pair::new();
    let bodies = [
        "string.find()",
        "string.find('x')",
        "string.find({}, 'x')",
        "string.find('x', nil)",
        "string.find(12, 2)",
        "string.find('12', '2', '1')",
        "string.find('x', 'x', 'y')",
        "string.find('x', 'x', 1.5)",
        "string.find('x', 'x', 2.0)",
        "('x'):find({})",
        "('x').find(nil, 'x')",
        "string.gsub('x', 'x')",
        "string.gsub('x', 'x', true)",
        "string.gsub('x', 'x', 7)",
        "string.gsub('x', 'x', function() return {} end)",
        "string.gsub('abc', '%w', { a = 1, b = true })",
        "string.gsub('abc', '', '-', -1)",
        "string.gsub('hello', 'l', '%0%0', 1)",
        "string.gsub('abc', '%w', '%1')",
        "string.gmatch('x')",
        "string.gmatch('ab', '()', 2)()",
        "string.match('x', 'x', {})",
        "string.rep('ab', 3)",
        "string.rep('ab', 3, ',')",
        "string.rep('', 5, ',')",
        "string.rep('', 1000)",
        "string.rep('x', -1)",
        "string.rep('x')",
        "string.rep('x', 'y')",
        "string.rep('x', 1 << 62)",
        "string.rep('x', 2, {})",
        "table.concat({ 1, 2, 3 }, '-')",
        "table.concat({ 1, 2, 3 }, '-', 2)",
        "table.concat({ 1, {}, 3 })",
        "table.concat({ 1 }, '', 1, 3)",
        "table.concat('x')",
        "table.concat({}, {})",
        "table.concat({}, '', 'x')",
        "table.concat({ 1, 2 }, ', ', 2, 1)",
        "(function() local t = { 1, 2 } table.insert(t, 3) table.insert(t, 1, 0) table.insert(t, #t + 1, 9) return table.unpack(t) end)()",
        "table.insert({ 1 }, 5, 1)",
        "table.insert({}, 1, 2, 3)",
        "table.insert({})",
        "table.insert(nil, 1)",
        "table.insert({}, 'x', 1)",
        "table.insert({ 1, 2 }, 0, 1)",
        "table.insert({ 1, 2 }, 2.5, 1)",
        "(function() local t = { 1, 2, 3 } local a, b = table.remove(t, 1), table.remove(t) return a, b, #t, t[1] end)()",
        "table.remove({})",
        "table.remove({}, 0)",
        "table.remove({}, 1)",
        "table.remove({ 1 }, 2)",
        "table.remove({ 1, 2 }, 7)",
        "table.remove({ 1 }, 'x')",
        "table.unpack(table.move({ 1, 2, 3 }, 1, 3, 2))",
        "table.unpack(table.move({ 1, 2, 3 }, 2, 3, 1))",
        "table.move({}, 1, math.maxinteger, 2)",
        "table.move({}, 1, 'x', 2)",
        "table.move({}, 2, 1, 5)",
        "#table.move({ 1, 2 }, 1, 2, 1, {})",
        "table.move({ 1 }, 1, 1, 1, 7)",
        "(function() local t = { 3, 1.5, 2 } table.sort(t) return table.unpack(t) end)()",
        "(function() local t = { 'b', 'a\\0b', 'a', '' } table.sort(t) return table.unpack(t) end)()",
        "(function() local t = { 1, 2, 3 } table.sort(t, function(a, b) return a > b end) return table.unpack(t) end)()",
        "table.sort({ 1, 'x' })",
        "table.sort({ {}, {} })",
        "table.sort({ true, false })",
        "table.sort({ 1, 2 }, 7)",
        "table.sort(7)",
        "table.sort({ 7 }, 7)",
        "table.sort({ 1, 2 }, nil)",
        "(function() local t = setmetatable({}, {}) return getmetatable(t) ~= nil end)()",
        "setmetatable({}, 1)",
        "setmetatable(1, {})",
        "setmetatable({})",
        "setmetatable(setmetatable({}, { __metatable = 1 }), {})",
        "getmetatable(setmetatable({}, nil))",
        "collectgarbage('x')",
        "type(collectgarbage('count'))",
        "collectgarbage()",
        "collectgarbage('step')",
        "coroutine.close(coroutine.create(print))",
        "coroutine.close(7)",
        "coroutine.close(coroutine.running())",
        "(function() local l = setmetatable({ 5, 6 }, { __len = function() return 1 end }) table.insert(l, 7) return l[2], table.remove(l), #l, table.concat(l, ',') end)()",
        "(function() local l = setmetatable({}, { __len = function() return 'x' end }) table.insert(l, 7) end)()",
        "(function() local l = setmetatable({}, { __index = function(_, k) return k * 10 end }) return table.concat(l, ' ', 1, 5) end)()",
        "(function() local m = { __lt = function(a, b) return a.n < b.n end } local t = {} for k, n in ipairs { 3, 1, 2 } do t[k] = setmetatable({ n = n }, m) end table.sort(t) return t[1].n, t[2].n, t[3].n end)()",
    ];
    for body in bodies {
        let text = format!(
            "local function f() local r = table.pack({body}) return r end local r = f() return table.unpack(r, 1, r.n)"
        );
        let [expected, found] = [&pair.plain, &pair.ours].map(|lua| told(lua.load(&text).set_name("=script").call(())));
        let [expected, found] =
            [expected, found].map(|told| told.map(|values| values.iter().map(|v| plain(v)).collect::<Vec<_>>()));
        assert_eq!(found, expected, "{body}");
    }
}

/// Without addresses.
fn plain(text: &str) -> String {
    text.split("0x").next().unwrap_or("").split("Ref(").next().unwrap_or("").to_owned()
}

#[test]
fn sorting_is_stable_and_of_every_order() {
    let pair = Pair::new();
    let text = "
    local n, seed = ...
    local t, plain = {}, {}
    for k = 1, n do
      seed = (seed * 1103515245 + 12345) % 2147483648
      t[k] = { key = seed % 17, place = k }
      plain[k] = seed % 1000 - 500 + (seed % 2) * 0.5
    end
    table.sort(t, function(a, b) return a.key < b.key end)
    for k = 2, n do
      assert(t[k - 1].key < t[k].key or t[k - 1].key == t[k].key and t[k - 1].place < t[k].place)
    end
    table.sort(plain)
    for k = 2, n do assert(plain[k - 1] <= plain[k]) end
    table.sort(plain, function(a, b) return true end)
    return #t, #plain";
    for n in [0, 1, 2, 3, 7, 64, 999, 1000, 1001, 5000] {
        let sizes: (i64, i64) = pair.ours.load(text).call((n, n + 3)).unwrap();
        assert_eq!(sizes, (n, n));
    }
}
