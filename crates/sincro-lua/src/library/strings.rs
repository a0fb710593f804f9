//! `string.find`, `match`, `gmatch`, `gsub` and `rep`.
//!
//! Source: Lua 5.4 reference manual, §6.4.

use std::sync::Arc;

use memchr::memmem;
use mlua::{Error, Function, Lua, LuaString, MultiValue, Table, Value};

use super::pattern::{Captured, Matcher, Meter, Pattern};
use super::{Arguments, Library, Original, one, put, type_name};

pub(super) fn install(lua: &Lua, library: &Arc<Library>) -> mlua::Result<()> {
    let strings: Table = lua.globals().get("string")?;
    put(lua, library, &strings, "find", |library, arguments| search(library, arguments, true))?;
    put(lua, library, &strings, "match", |library, arguments| search(library, arguments, false))?;
    put(lua, library, &strings, "gsub", substitute)?;
    let shared = library.clone();
    put(lua, library, &strings, "gmatch", move |_, arguments| iterate(&shared, arguments))?;
    let own = Original::of(library, &strings, "rep")?;
    put(lua, library, &strings, "rep", move |library, arguments| repeat(library, &own, arguments))
}

/// Index from 0 of a position, which counts from the end if it is negative; `None` behind the end.
fn start_of(position: i64, len: usize) -> Option<usize> {
    let from_end = usize::try_from(position.unsigned_abs()).unwrap_or(usize::MAX);
    let start = if position >= 0 { from_end.saturating_sub(1) } else { len.saturating_sub(from_end) };
    (start <= len).then_some(start)
}

fn has_specials(pattern: &[u8]) -> bool {
    pattern.iter().any(|byte| b"^$*+?.([%-".contains(byte))
}

/// The pattern behind its anchor, and true if it has one.
fn split_anchor(pattern: &[u8]) -> (&[u8], bool) {
    pattern.strip_prefix(b"^").map_or((pattern, false), |rest| (rest, true))
}

/// `string.find` and `string.match`.
fn search(library: &Library, arguments: &Arguments<'_>, is_find: bool) -> mlua::Result<MultiValue> {
    let lua = arguments.lua;
    let (subject, pattern) = (arguments.string(1)?, arguments.string(2)?);
    let (subject, pattern) = (subject.as_bytes(), pattern.as_bytes());
    let Some(start) = start_of(arguments.integer_or(3, 1)?, subject.len()) else { return one(Value::Nil) };
    if is_find && (arguments.is_true(4) || !has_specials(&pattern)) {
        library.charge_bytes(lua, subject.len() - start + pattern.len())?;
        let found = memmem::find(&subject[start..], &pattern).map(|at| start + at);
        return Ok(found.map_or_else(|| MultiValue::from_iter([Value::Nil]), |at| bounds(at, at + pattern.len())));
    }
    let mut meter = Meter::new(lua, &library.guard);
    let result = search_pattern(lua, &subject, &pattern, start, is_find, &mut meter);
    meter.settle().map_err(|stop| *stop)?;
    result
}

fn search_pattern(
    lua: &Lua,
    subject: &[u8],
    pattern: &[u8],
    start: usize,
    is_find: bool,
    meter: &mut Meter<'_>,
) -> mlua::Result<MultiValue> {
    let (pattern, is_anchored) = split_anchor(pattern);
    let pattern = Pattern::parse(pattern, meter).map_err(|stop| *stop)?;
    let mut matcher = Matcher::new(subject, &pattern);
    let last = if is_anchored { start } else { subject.len() };
    for at in start..=last {
        let Some(end) = matcher.match_at(at, meter).map_err(|stop| *stop)? else { continue };
        if !is_find {
            return captures(lua, subject, &matcher, (at, end), matcher.n_values());
        }
        let mut results = bounds(at, end);
        results.extend(captures(lua, subject, &matcher, (at, end), matcher.n_captures())?);
        return Ok(results);
    }
    one(Value::Nil)
}

/// First and last position of a match.
fn bounds(start: usize, end: usize) -> MultiValue {
    MultiValue::from_iter([Value::Integer(start as i64 + 1), Value::Integer(end as i64)])
}

fn captures(
    lua: &Lua,
    subject: &[u8],
    matcher: &Matcher<'_>,
    whole: (usize, usize),
    n: usize,
) -> mlua::Result<MultiValue> {
    (0..n).map(|k| capture(lua, subject, matcher, whole, k)).collect()
}

fn capture(lua: &Lua, subject: &[u8], matcher: &Matcher<'_>, whole: (usize, usize), k: usize) -> mlua::Result<Value> {
    Ok(match matcher.value(k, whole).map_err(|stop| *stop)? {
        Captured::Bytes { start, end } => Value::String(lua.create_string(&subject[start..end])?),
        Captured::Position(position) => Value::Integer(position as i64),
    })
}

/// `string.gmatch`. A match that is empty where the last one ended is none; `^` is no anchor.
///
/// The pattern is parsed again for each match: an iterator holds nothing beside the two strings.
fn iterate(library: &Arc<Library>, arguments: &Arguments<'_>) -> mlua::Result<MultiValue> {
    let (subject, pattern) = (arguments.string(1)?, arguments.string(2)?);
    let len = subject.as_bytes().len();
    let mut start = start_of(arguments.integer_or(3, 1)?, len).unwrap_or(len + 1);
    let (library, mut last_end) = (library.clone(), None);
    let next = arguments.lua.create_function_mut(move |lua, ()| {
        let mut meter = Meter::new(lua, &library.guard);
        let found = next_match(lua, &subject, &pattern, (start, last_end), &mut meter);
        meter.settle().map_err(|stop| *stop)?;
        let Some((end, values)) = found? else { return Ok(MultiValue::new()) };
        (start, last_end) = (end, Some(end));
        Ok(values)
    })?;
    one(Value::Function(next))
}

/// End and captures of the next match.
fn next_match(
    lua: &Lua,
    subject: &LuaString,
    pattern: &LuaString,
    (start, last_end): (usize, Option<usize>),
    meter: &mut Meter<'_>,
) -> mlua::Result<Option<(usize, MultiValue)>> {
    let (subject, pattern) = (subject.as_bytes(), pattern.as_bytes());
    let pattern = Pattern::parse(&pattern, meter).map_err(|stop| *stop)?;
    let mut matcher = Matcher::new(&subject, &pattern);
    for at in start..=subject.len() {
        let end = matcher.match_at(at, meter).map_err(|stop| *stop)?;
        if let Some(end) = end.filter(|end| last_end != Some(*end)) {
            return Ok(Some((end, captures(lua, &subject, &matcher, (at, end), matcher.n_values())?)));
        }
    }
    Ok(None)
}

/// Replacement of `string.gsub`.
enum Replacement {
    Text(LuaString),
    Table(Table),
    Function(Function),
}

impl Replacement {
    fn of(arguments: &Arguments<'_>) -> mlua::Result<Self> {
        Ok(match arguments.get(3) {
            Some(Value::String(_) | Value::Integer(_) | Value::Number(_)) => Self::Text(arguments.string(3)?),
            Some(Value::Table(table)) => Self::Table(table.clone()),
            Some(Value::Function(function)) => Self::Function(function.clone()),
            _ => return Err(arguments.wrong_type(3, "string/function/table")),
        })
    }
}

/// `string.gsub`.
fn substitute(library: &Library, arguments: &Arguments<'_>) -> mlua::Result<MultiValue> {
    let lua = arguments.lua;
    let (subject, pattern) = (arguments.string(1)?, arguments.string(2)?);
    let replacement = Replacement::of(arguments)?;
    let whole = subject.clone();
    let (subject, pattern) = (subject.as_bytes(), pattern.as_bytes());
    let most = arguments.integer_or(4, subject.len() as i64 + 1)?;
    let (pattern, is_anchored) = split_anchor(&pattern);
    let mut meter = Meter::new(lua, &library.guard);
    let pattern = Pattern::parse(pattern, &mut meter).map_err(|stop| *stop)?;
    let mut matcher = Matcher::new(&subject, &pattern);
    let mut out = Output { bytes: Vec::new(), is_changed: false, library, lua };
    let (mut at, mut last_end, mut n) = (0, None, 0);
    while n < most {
        let end = matcher.match_at(at, &mut meter).map_err(|stop| *stop)?;
        if let Some(end) = end.filter(|end| last_end != Some(*end)) {
            n += 1;
            out.replace(&replacement, &subject, &matcher, (at, end), &mut meter)?;
            (at, last_end) = (end, Some(end));
        } else if let Some(byte) = subject.get(at) {
            out.push(&[*byte])?;
            at += 1;
        } else {
            break;
        }
        if is_anchored {
            break;
        }
    }
    meter.settle().map_err(|stop| *stop)?;
    let text = if out.is_changed {
        out.push(&subject[at..])?;
        lua.create_string(&out.bytes)?
    } else {
        whole
    };
    library.charge_bytes(lua, text.as_bytes().len())?;
    Ok(MultiValue::from_iter([Value::String(text), Value::Integer(n)]))
}

/// Result of `string.gsub` while it is made.
struct Output<'a> {
    bytes: Vec<u8>,
    is_changed: bool,
    library: &'a Library,
    lua: &'a Lua,
}

impl Output<'_> {
    fn push(&mut self, bytes: &[u8]) -> mlua::Result<()> {
        if self.bytes.len() + bytes.len() > self.library.max_memory {
            return Err(Error::MemoryError("not enough memory".into()));
        }
        self.bytes.extend_from_slice(bytes);
        Ok(())
    }

    /// Appends what replaces a match; false and nil leave it.
    fn replace(
        &mut self,
        replacement: &Replacement,
        subject: &[u8],
        matcher: &Matcher<'_>,
        whole: (usize, usize),
        meter: &mut Meter<'_>,
    ) -> mlua::Result<()> {
        let value = match replacement {
            Replacement::Text(text) => {
                self.is_changed = true;
                let text = text.as_bytes();
                // captures may be empty, however many are put in
                meter.spend(text.len()).map_err(|stop| *stop)?;
                return self.expand(&text, subject, matcher, whole);
            }
            Replacement::Table(table) => table.get(capture(self.lua, subject, matcher, whole, 0)?)?,
            Replacement::Function(function) => {
                let values = captures(self.lua, subject, matcher, whole, matcher.n_values())?;
                self.library.call(self.lua, function, values)?.pop_front().unwrap_or(Value::Nil)
            }
        };
        match &value {
            Value::Nil | Value::Boolean(false) => return self.push(&subject[whole.0..whole.1]),
            Value::String(text) => self.push(&text.as_bytes())?,
            Value::Integer(_) | Value::Number(_) => {
                let text = self.lua.coerce_string(value.clone())?;
                self.push(&text.map_or_else(Vec::new, |text| text.as_bytes().to_vec()))?;
            }
            other => {
                return Err(Error::RuntimeError(format!("invalid replacement value (a {})", type_name(other))));
            }
        }
        self.is_changed = true;
        Ok(())
    }

    /// Appends a replacement text: `%0` is the whole match, `%1` … are captures, `%%` is a percent sign.
    fn expand(
        &mut self,
        text: &[u8],
        subject: &[u8],
        matcher: &Matcher<'_>,
        whole: (usize, usize),
    ) -> mlua::Result<()> {
        let mut rest = text;
        while let Some(percent) = memchr::memchr(b'%', rest) {
            self.push(&rest[..percent])?;
            match rest.get(percent + 1) {
                Some(b'%') => self.push(b"%")?,
                Some(b'0') => self.push(&subject[whole.0..whole.1])?,
                Some(digit @ b'1'..=b'9') => {
                    let value = matcher.value(usize::from(digit - b'1'), whole).map_err(|stop| *stop)?;
                    match value {
                        Captured::Bytes { start, end } => self.push(&subject[start..end])?,
                        Captured::Position(position) => self.push(position.to_string().as_bytes())?,
                    }
                }
                _ => return Err(Error::RuntimeError("invalid use of '%' in replacement string".into())),
            }
            rest = &rest[percent + 2..];
        }
        self.push(rest)
    }
}

/// `string.rep`: nothing repeated is nothing, however often.
fn repeat(library: &Library, own: &Original, arguments: &Arguments<'_>) -> mlua::Result<MultiValue> {
    let text = arguments.string(1)?;
    let n = u64::try_from(arguments.integer(2)?).unwrap_or(0);
    let separator = if arguments.is_absent(3) { 0 } else { arguments.string(3)?.as_bytes().len() };
    let len = n.saturating_mul((text.as_bytes().len() + separator) as u64);
    if len == 0 {
        return one(Value::String(arguments.lua.create_string("")?));
    }
    // Lua refuses what does not fit before it is made
    if let Some(len) = usize::try_from(len).ok().filter(|len| *len <= library.max_memory) {
        library.charge_bytes(arguments.lua, len)?;
    }
    own.call(arguments.lua, &arguments.values)
}
