//! Ways out of the limits, each tried: finalizers, work in library functions that no instruction counts, errors caught,
//! coroutines, the clock.

use std::sync::Arc;
use std::time::Duration;

use mlua::Lua;

use crate::fault;
use crate::guard::Guard;
use crate::sandbox::{self, Services};

/// Instructions of a call in these tests.
const BUDGET: u64 = 200_000;

struct Sandbox {
    lua: Lua,
    guard: Arc<Guard>,
}

impl Sandbox {
    fn new() -> Self {
        Self::with(Guard::new(BUDGET))
    }

    /// Without time: the first check ends the call.
    fn without_time() -> Self {
        Self::with(Guard::with_time_limit(u64::MAX, Duration::ZERO))
    }

    fn with(guard: Arc<Guard>) -> Self {
        let lua = sandbox::new(&guard, 64 << 20).unwrap();
        let services =
            Services { time: Box::new(|| 0.0), signal: Box::new(|_, _| Ok(mlua::Value::Nil)), print: Box::new(drop) };
        sandbox::furnish(&lua, &guard, 0, services).unwrap();
        Self { lua, guard }
    }

    /// Runs a text as one call; its first result as text, or the message.
    fn call(&self, text: &str) -> Result<String, String> {
        self.guard.begin();
        let done = self.lua.load(text).set_name("=script").call::<mlua::Value>(());
        let done = done.and_then(|value| self.guard.check().map(|()| value));
        done.and_then(|value| value.to_string())
            .map_err(|error| if self.guard.is_stopped() { self.guard.words() } else { fault::words(&error).0 })
    }

    fn reaches_the_limit(&self, text: &str) {
        let words = format!("one call took more than {BUDGET} instructions");
        assert_eq!(self.call(text), Err(words), "{text}");
        self.guard.resume_script(&self.lua);
    }
}

/// A loop without end, as a function.
const LOOP: &str = "function() while true do end end";

#[test]
fn no_script_has_a_finalizer() {
    let refused = "a metatable with `__gc` is not allowed: scripts have no finalizers";
    for text in [
        format!("setmetatable({{}}, {{ __gc = {LOOP} }}) collectgarbage()"),
        format!("local m = {{ __gc = {LOOP} }} setmetatable({{}}, m)"),
        "setmetatable({}, { __gc = true })".to_owned(),
        "setmetatable({}, { __gc = false })".to_owned(),
        "setmetatable(_G, { __gc = print })".to_owned(),
        "local s = getmetatable('') s.__gc = print setmetatable({}, s)".to_owned(),
        "load('setmetatable({}, { __gc = print })')()".to_owned(),
        "coroutine.wrap(function() setmetatable({}, { __gc = print }) end)()".to_owned(),
        "local ok, e = pcall(setmetatable, {}, { __gc = print }) error(e, 0)".to_owned(),
    ] {
        let message = Sandbox::new().call(&text).unwrap_err();
        assert!(message.ends_with(refused), "{text}: {message}");
    }
}

#[test]
fn a_finalizer_that_comes_later_is_never_called() {
    let sandbox = Sandbox::new();
    let text = "called = 0
    local m = {} setmetatable({}, m) m.__gc = function() called = called + 1 end
    setmetatable({}, setmetatable({}, { __index = { __gc = function() called = called + 1 end } }))
    getmetatable('').__gc = function() called = called + 1 end
    m = nil collectgarbage() collectgarbage()
    return called";
    assert_eq!(sandbox.call(text), Ok("0".to_owned()));
}

#[test]
fn errors_give_no_metatable_of_the_host() {
    // what is closed sees errors of the host as they are
    let text = "local seen
    pcall(function()
      local x <close> = setmetatable({}, { __close = function(_, e) seen = e end })
      string.rep({})
    end)
    local co = coroutine.create(function() string.rep({}) end)
    coroutine.resume(co)
    local _, other = coroutine.close(co)
    return type(seen) .. tostring(getmetatable(seen)) .. type(other) .. tostring(getmetatable(other))
      .. tostring(pcall(setmetatable, seen, {})) .. tostring(rawequal(getmetatable(print), nil))";
    assert_eq!(Sandbox::new().call(text), Ok("userdatafalseuserdatafalsefalsetrue".to_owned()));
}

#[test]
fn debug_and_warn_reach_nothing() {
    let text = "local names = {}
    for name in pairs(debug) do names[#names + 1] = name end
    warn('@on') warn('text') warn('@off')
    return table.concat(names, ' ')";
    assert_eq!(Sandbox::new().call(text), Ok("traceback".to_owned()));
}

#[test]
fn work_of_library_functions_reaches_the_limit() {
    let sandbox = Sandbox::new();
    let lying = "local t = setmetatable({}, { __len = function() return 1 << 40 end, __index = rawlen, __newindex = rawequal })";
    for text in [
        "string.find(('a'):rep(28), ('a?'):rep(28) .. ('a'):rep(28))",
        "string.find(('a'):rep(10000), '.-.-.-.-b')",
        "string.match(('a'):rep(100000), '.-b')",
        "for x in string.gmatch(('a'):rep(100000), 'a*b') do end",
        "string.gsub(('a'):rep(10000), '(.*)(.*)(.*)b', '')",
        "string.gsub(('a'):rep(10000), '.-.-b', print)",
        "string.find(('('):rep(100000), '%b()')",
        "string.match(('ab'):rep(20000), '(.*)%1c')",
        "string.gsub(('x'):rep(1000), '(x-)', ('%1'):rep(10000))",
        "('a'):rep(10000):find('.-.-.-b')",
        "local s = ('a'):rep(1 << 20) while true do s:find('b', 1, true) end",
        "while true do ('x'):rep(1 << 20) end",
        "table.move({}, 1, 1e15, 2)",
        "table.move({}, math.mininteger, -1, 2)",
        "table.concat(setmetatable({}, { __index = rawlen }), '', 1, 1 << 40)",
        "local t = {} for k = 1, 1000 do t[k] = k end while true do table.insert(t, 1, 0) table.remove(t, 1) end",
        "local t = {} for k = 1, 1000 do t[k] = 'x' end while true do table.concat(t) end",
        "local t = {} for k = 1, 1000 do t[k] = -k end while true do table.sort(t) end",
        "local t = {} for k = 1, 1000 do t[k] = -k end while true do table.sort(t, math.ult) end",
        "local t = {} for k = 1, 100 do t['k' .. k] = k end while true do for k in pairs(t) do break end end",
        "while true do collectgarbage() end",
        "while true do collectgarbage('step') end",
        "load(function() return ' ' end)",
        "load(('goto a '):rep(5000))",
        "load(('::a::'):rep(5000))",
        "load('if x then ' .. ('elseif x then '):rep(5000) .. ' end')",
        &format!("{lying} table.concat(t)"),
        &format!("{lying} table.insert(t, 1, 7)"),
        &format!("{lying} table.remove(t, 1)"),
    ] {
        sandbox.reaches_the_limit(text);
        sandbox.reaches_the_limit(&format!("while true do pcall(function() {text} end) end"));
        sandbox.reaches_the_limit(&format!("coroutine.wrap(function() {text} end)()"));
    }
}

#[test]
fn what_is_refused_at_once_needs_no_limit() {
    let sandbox = Sandbox::new();
    for (text, expected) in [
        ("return #string.rep('', 1e15)", Ok("0")),
        ("return #string.rep('', 1 << 62, '')", Ok("0")),
        ("string.rep('x', 1 << 62)", Err("resulting string too large")),
        ("table.concat({}, '', 1, 1e15)", Err("invalid value (nil) at index 1 in table for 'concat'")),
        ("table.unpack({}, 1, 1e15)", Err("too many results to unpack")),
        (
            "table.unpack(setmetatable({}, { __len = function() return 1 << 40 end }))",
            Err("too many results to unpack"),
        ),
        (
            "table.sort(setmetatable({}, { __len = function() return 1 << 40 end }))",
            Err("bad argument #1 to 'sort' (array too big)"),
        ),
        ("string.find('x', ('a'):rep(100000) .. '.')", Err("pattern too complex")),
        ("return load((' '):rep(2 << 20))", Err("a text of more than 1024 KiB is not compiled in a run")),
        // deeper than the compiler goes
        ("return tostring(load('return ' .. ('1^'):rep(100000) .. '1'))", Ok("nil")),
    ] {
        assert_eq!(sandbox.call(text), expected.map(str::to_owned).map_err(str::to_owned), "{text}");
    }
}

#[test]
fn results_of_gsub_are_within_the_memory() {
    let sandbox = Sandbox::with(Guard::new(u64::MAX));
    let text = "return #string.gsub(('x'):rep(1 << 20), 'x', ('y'):rep(1 << 20))";
    assert_eq!(sandbox.call(text), Err("not enough memory".to_owned()));
}

#[test]
fn hooks_count_in_everything_that_calls_back() {
    for text in [
        format!("string.gsub('x', 'x', {LOOP})"),
        format!("string.gsub('x', 'x', setmetatable({{}}, {{ __index = {LOOP} }}))"),
        format!("table.sort({{ 1, 2 }}, {LOOP})"),
        format!("local m = {{ __lt = {LOOP} }} table.sort {{ setmetatable({{}}, m), setmetatable({{}}, m) }}"),
        format!("table.sort(setmetatable({{}}, {{ __len = {LOOP} }}))"),
        format!("table.sort(setmetatable({{}}, {{ __index = {LOOP}, __len = function() return 9 end }}))"),
        format!("table.sort(setmetatable({{ 2, 1 }}, {{ __newindex = {LOOP}, __len = function() return 5000 end, __index = rawlen }}))"),
        format!("table.concat(setmetatable({{}}, {{ __len = {LOOP} }}))"),
        format!("table.insert(setmetatable({{}}, {{ __len = {LOOP} }}), 1)"),
        format!("table.insert(setmetatable({{}}, {{ __newindex = {LOOP} }}), 1)"),
        format!("table.remove(setmetatable({{}}, {{ __len = {LOOP} }}))"),
        format!("table.move(setmetatable({{}}, {{ __index = {LOOP} }}), 1, 2, 3)"),
        format!("print(setmetatable({{}}, {{ __tostring = {LOOP} }}))"),
        format!("tostring(setmetatable({{}}, {{ __tostring = {LOOP} }}))"),
        format!("string.format('%s', setmetatable({{}}, {{ __tostring = {LOOP} }}))"),
        format!("error(setmetatable({{}}, {{ __tostring = {LOOP} }}))"),
        format!("coroutine.wrap(function() error(setmetatable({{}}, {{ __tostring = {LOOP} }})) end)()"),
        format!("for k in pairs(setmetatable({{}}, {{ __pairs = {LOOP} }})) do end"),
        format!("return {{}} .. setmetatable({{}}, {{ __concat = {LOOP} }})"),
        format!("return setmetatable({{}}, {{ __pow = {LOOP} }}) ^ 3"),
        format!("load({LOOP})"),
        format!("local x <close> = setmetatable({{}}, {{ __close = {LOOP} }})"),
        format!("local x <close> = setmetatable({{}}, {{ __close = {LOOP} }}) error('x')"),
        format!(
            "local co = coroutine.create(function() local x <close> = setmetatable({{}}, {{ __close = {LOOP} }}) coroutine.yield() end)
             coroutine.resume(co) coroutine.close(co)"
        ),
        format!(
            "local co = coroutine.create(function() local x <close> = setmetatable({{}}, {{ __close = {LOOP} }}) error('x') end)
             coroutine.resume(co) coroutine.close(co)"
        ),
        format!("xpcall(error, {LOOP})"),
        format!("xpcall({LOOP}, {LOOP})"),
        format!("local function f() return 1 + f() end xpcall(f, {LOOP})"),
        format!("xpcall(string.rep, {LOOP}, 'x', 1 << 25)  xpcall(error, {LOOP})"),
    ] {
        // each in a state of its own: after a limit fewer coroutines are closed
        Sandbox::new().reaches_the_limit(&text);
        Sandbox::new().reaches_the_limit(&format!("while true do pcall(function() {text} end) end"));
    }
}

#[test]
fn what_a_limit_unwinds_is_not_closed() {
    let endless = format!("setmetatable({{}}, {{ __close = {LOOP} }})");
    for text in [
        format!("local x <close> = {endless} while true do end"),
        format!("local x <close> = {endless} local y <close> = {endless} while true do end"),
        format!("local m = {{}} local t = setmetatable({{}}, m) m.__close = {LOOP} local x <close> = t while true do end"),
        format!("getmetatable('').__close = {LOOP} local x <close> = 'text' while true do end"),
        format!("for _ in function() return 1 end, nil, nil, {endless} do end"),
        format!("for _ in function() return 1 end, nil, nil, {endless} do while true do end end"),
        format!("string.gsub('x', 'x', function() local x <close> = {endless} while true do end end)"),
        format!("table.sort({{ 1, 2 }}, function() local x <close> = {endless} while true do end end)"),
        format!("local x <close> = setmetatable({{}}, {{ __close = function() local x <close> = {endless} while true do end end }})"),
        format!("local x <close> = {endless} string.find(('a'):rep(10000), '.-.-b')"),
        format!("setmetatable({{}}, {{ __index = function() local x <close> = {endless} while true do end end }}).x = nil
                 local t = setmetatable({{}}, {{ __index = function() local x <close> = {endless} while true do end end }}) return t.x"),
        format!("local x <close> = {endless} local t = {{}} while true do t[#t + 1] = setmetatable({{}}, {{}}) t[#t] = nil end"),
    ] {
        for text in [
            text.clone(),
            format!("while true do pcall(function() {text} end) end"),
            format!("xpcall(function() {text} end, {LOOP})"),
            format!("coroutine.wrap(function() {text} end)()"),
            format!("local co = coroutine.create(function() {text} end) coroutine.resume(co) coroutine.close(co)"),
        ] {
            Sandbox::new().reaches_the_limit(&text);
        }
    }
}

#[test]
fn closing_works_again_after_a_limit() {
    let sandbox = Sandbox::new();
    let text = "log = ''
    object = setmetatable({}, { __close = function() log = log .. 'x' end })
    do local x <close> = object end
    return log";
    assert_eq!(sandbox.call(text), Ok("x".to_owned()));
    sandbox.reaches_the_limit("local x <close> = object while true do end");
    assert_eq!(sandbox.call("do local x <close> = object end return log"), Ok("xx".to_owned()));
}

#[test]
fn a_coroutine_that_a_limit_ended_is_not_closed() {
    let sandbox = Sandbox::new();
    sandbox.reaches_the_limit(&format!(
        "co = coroutine.create(function()
           local x <close> = setmetatable({{}}, {{ __close = {LOOP} }})
           while true do end
         end)
         coroutine.resume(co)"
    ));
    // its hooks are off for good: without the refusal this would not return
    let text = "local ok, why = coroutine.close(co) return tostring(ok) .. ' ' .. why";
    assert_eq!(sandbox.call(text), Ok("false a coroutine that a limit may have ended is not closed".to_owned()));
    assert_eq!(sandbox.call("return tostring(coroutine.close(coroutine.create(print)))"), Ok("true".to_owned()));
    assert_eq!(sandbox.call("return tostring(coroutine.resume(co))"), Ok("false".to_owned()));
}

#[test]
fn error_values_stay_what_they_are_on_their_way_through() {
    let sandbox = Sandbox::new();
    for text in [
        "table.sort({ 1, 2 }, raise)",
        "string.gsub('x', 'x', raise)",
        "string.gsub('x', 'x', function() table.sort({ 1, 2 }, raise) end)",
    ] {
        let text = format!(
            "local object = {{}}
             local function raise() error(object) end
             local ok, e = pcall(function() {text} end)
             local other, ee = coroutine.resume(coroutine.create(function() {text} end))
             return tostring(not ok and e == object and ee == object)"
        );
        assert_eq!(sandbox.call(&text), Ok("true".to_owned()), "{text}");
    }
}

#[test]
fn a_call_without_time_ends_at_its_first_check() {
    for text in [
        "while true do end",
        "while true do pcall(function() while true do end end) end",
        "for k = 1, 400 do local s = ('x'):rep(1000) .. k end while true do end",
        "collectgarbage()",
        "collectgarbage('count')",
        "pcall(collectgarbage)",
        "string.find(('a'):rep(200), 'a*b')",
        "string.rep('x', 64)",
        "table.sort({ 2, 1 })",
        "table.move({}, 1, 8, 2)",
        "load('return 1')",
        "coroutine.wrap(function() while true do end end)()",
    ] {
        let sandbox = Sandbox::without_time();
        assert_eq!(sandbox.call(text), Err("one call took more than 0 s".to_owned()), "{text}");
        assert!(sandbox.guard.help().unwrap().contains("collects garbage"));
        sandbox.guard.resume_script(&sandbox.lua);
        assert_eq!(sandbox.call("return 1 + 1"), Ok("2".to_owned()));
    }
}

#[test]
fn time_that_is_lent_is_given_back() {
    let (without, with) = (Sandbox::without_time(), Sandbox::new());
    without.guard.begin();
    with.guard.begin();
    let late = without.guard.lend_time(&with.guard, || with.guard.check_clock(&with.lua));
    assert!(late.is_err() && with.guard.words().contains(" s"));
    with.guard.resume_script(&with.lua);
    assert!(with.guard.check_clock(&with.lua).is_ok());
}

#[test]
fn the_time_limit_grows_with_the_instructions() {
    for (budget, expected) in [(1, "30 s"), (20_000_000, "30 s"), (100_000_000, "30 s"), (1_000_000_000, "300 s")] {
        assert_eq!(Guard::new(budget).time_limit().as_secs_f64().to_string() + " s", expected);
    }
}
