//! Patterns of Lua: parser and backtracking matcher.
//!
//! Source: Lua 5.4 reference manual, §6.4.1. Matching by backtracking takes exponential time in the worst case, so that
//! every step is counted and added to the script's instructions ([`Meter`]): a pathological pattern reaches the limit
//! of the call as a loop without end does.
//!
//! Errors of a pattern are found where the matcher arrives at them, as in Lua: `("abc"):find("x[")` is nil,
//! `("x"):find("x[")` an error.

use std::sync::Arc;

use mlua::{Error, Lua};

use crate::guard::Guard;

/// Captures of one pattern.
pub(super) const MAX_CAPTURES: usize = 32;

/// Nested calls of the matcher; beyond, a pattern is too complex.
const MAX_DEPTH: u32 = 200;

/// Longest pattern [bytes]: the parsed form is not part of the script's memory.
const MAX_PATTERN: usize = 1 << 16;

/// Steps of the matcher that count as one instruction.
const STEPS_PER_INSTRUCTION: u64 = 8;

/// Steps after which they are added to the count.
const STEPS_AT_ONCE: u64 = 8192;

/// Error of the matcher; boxed, because the matcher's results are small.
type Stop = Box<Error>;

fn stop(message: impl Into<String>) -> Stop {
    Box::new(Error::RuntimeError(message.into()))
}

/// Counter of the matcher's steps.
pub(super) struct Meter<'a> {
    lua: &'a Lua,
    guard: &'a Arc<Guard>,
    steps: u64,
}

impl<'a> Meter<'a> {
    pub fn new(lua: &'a Lua, guard: &'a Arc<Guard>) -> Self {
        Self { lua, guard, steps: 0 }
    }

    /// Counts steps.
    #[inline]
    pub fn spend(&mut self, steps: usize) -> Result<(), Stop> {
        self.steps += steps as u64;
        if self.steps < STEPS_AT_ONCE { Ok(()) } else { self.settle() }
    }

    /// Adds the steps taken so far to the count.
    pub fn settle(&mut self) -> Result<(), Stop> {
        let whole = self.steps / STEPS_PER_INSTRUCTION;
        self.steps %= STEPS_PER_INSTRUCTION;
        if whole == 0 { Ok(()) } else { self.guard.charge(self.lua, whole).map_err(Box::new) }
    }
}

/// Bytes of a set `[…]`, one bit each.
type Set = [u64; 4];

/// Class of characters.
#[derive(Clone, Debug, PartialEq)]
enum Class {
    Any,
    Byte(u8),
    /// `%a` and its like.
    Letter(u8),
    Set(Box<Set>),
}

impl Class {
    #[inline]
    fn contains(&self, byte: u8) -> bool {
        match self {
            Self::Any => true,
            Self::Byte(own) => *own == byte,
            Self::Letter(letter) => is_of_class(byte, *letter),
            Self::Set(set) => is_in(set, byte),
        }
    }
}

fn is_in(set: &Set, byte: u8) -> bool {
    set[usize::from(byte >> 6)] >> (byte & 63) & 1 == 1
}

/// Returns true if a byte is of the class `%letter`, as C's `isalpha` … have them; any other letter stands for itself.
fn is_of_class(byte: u8, letter: u8) -> bool {
    let is_of = match letter.to_ascii_lowercase() {
        b'a' => byte.is_ascii_alphabetic(),
        b'c' => byte.is_ascii_control(),
        b'd' => byte.is_ascii_digit(),
        b'g' => byte.is_ascii_graphic(),
        b'l' => byte.is_ascii_lowercase(),
        b'p' => byte.is_ascii_punctuation(),
        b's' => matches!(byte, b' ' | 9..=13),
        b'u' => byte.is_ascii_uppercase(),
        b'w' => byte.is_ascii_alphanumeric(),
        b'x' => byte.is_ascii_hexdigit(),
        // of older Lua, not in the manual
        b'z' => byte == 0,
        _ => return letter == byte,
    };
    is_of != letter.is_ascii_uppercase()
}

/// Number of repetitions of a class.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Repeat {
    Once,
    /// `?`
    Optional,
    /// `*`, or `+` with one at least.
    Greedy {
        is_one_needed: bool,
    },
    /// `-`
    Lazy,
}

/// Item of a pattern.
#[derive(Clone, Debug, PartialEq)]
enum Item {
    Class(Class, Repeat),
    Open,
    Close,
    Position,
    /// `%b`
    Balanced(u8, u8),
    /// `%f`
    Frontier(Box<Set>),
    /// `%1`
    BackReference(u8),
    /// `$` at the end.
    End,
    /// An error of the pattern.
    Malformed(&'static str),
}

/// Parsed pattern.
#[derive(Debug)]
pub(super) struct Pattern {
    items: Vec<Item>,
}

impl Pattern {
    /// Parses a pattern without its anchor `^`; takes a step for each byte.
    pub fn parse(text: &[u8], meter: &mut Meter<'_>) -> Result<Self, Stop> {
        if text.len() > MAX_PATTERN {
            return Err(stop("pattern too complex"));
        }
        meter.spend(text.len())?;
        let mut parser = Parser { text, at: 0 };
        let mut items = Vec::with_capacity(text.len().min(16));
        while let Some(first) = parser.next() {
            let item = parser.item(first).unwrap_or_else(Item::Malformed);
            let is_last = matches!(item, Item::Malformed(_));
            items.push(item);
            if is_last {
                break;
            }
        }
        Ok(Self { items })
    }
}

struct Parser<'a> {
    text: &'a [u8],
    at: usize,
}

impl Parser<'_> {
    fn next(&mut self) -> Option<u8> {
        let byte = self.peek()?;
        self.at += 1;
        Some(byte)
    }

    fn peek(&self) -> Option<u8> {
        self.text.get(self.at).copied()
    }

    fn item(&mut self, first: u8) -> Result<Item, &'static str> {
        match (first, self.peek()) {
            (b'(', Some(b')')) => {
                self.at += 1;
                Ok(Item::Position)
            }
            (b'(', _) => Ok(Item::Open),
            (b')', _) => Ok(Item::Close),
            (b'$', None) => Ok(Item::End),
            (b'%', Some(b'b')) => {
                let [Some(open), Some(close)] = [1, 2].map(|k| self.text.get(self.at + k).copied()) else {
                    return Err("malformed pattern (missing arguments to '%b')");
                };
                self.at += 3;
                Ok(Item::Balanced(open, close))
            }
            (b'%', Some(b'f')) => {
                self.at += 1;
                if self.next() != Some(b'[') {
                    return Err("missing '[' after '%f' in pattern");
                }
                Ok(Item::Frontier(Box::new(self.set()?)))
            }
            (b'%', Some(digit @ b'0'..=b'9')) => {
                self.at += 1;
                Ok(Item::BackReference(digit))
            }
            _ => {
                let class = self.class(first)?;
                Ok(Item::Class(class, self.repeat()))
            }
        }
    }

    fn class(&mut self, first: u8) -> Result<Class, &'static str> {
        Ok(match first {
            b'.' => Class::Any,
            b'%' => Class::Letter(self.next().ok_or("malformed pattern (ends with '%')")?),
            b'[' => Class::Set(Box::new(self.set()?)),
            byte => Class::Byte(byte),
        })
    }

    fn repeat(&mut self) -> Repeat {
        let repeat = match self.peek() {
            Some(b'?') => Repeat::Optional,
            Some(b'*') => Repeat::Greedy { is_one_needed: false },
            Some(b'+') => Repeat::Greedy { is_one_needed: true },
            Some(b'-') => Repeat::Lazy,
            _ => return Repeat::Once,
        };
        self.at += 1;
        repeat
    }

    /// A set, behind its `[`. A `]` that comes first is an element.
    fn set(&mut self) -> Result<Set, &'static str> {
        let is_complement = self.peek() == Some(b'^');
        self.at += usize::from(is_complement);
        let end = self.set_end()?;
        let mut set = [0; 4];
        while self.at < end {
            let first = self.text[self.at];
            if first == b'%' {
                let letter = self.text[self.at + 1];
                (0..=u8::MAX).filter(|byte| is_of_class(*byte, letter)).for_each(|byte| insert(&mut set, byte));
                self.at += 2;
            } else if self.text[self.at + 1] == b'-' && self.at + 2 < end {
                (first..=self.text[self.at + 2]).for_each(|byte| insert(&mut set, byte));
                self.at += 3;
            } else {
                insert(&mut set, first);
                self.at += 1;
            }
        }
        self.at = end + 1;
        Ok(if is_complement { set.map(|bits| !bits) } else { set })
    }

    /// Index of the `]` that ends the set whose first element is next.
    fn set_end(&self) -> Result<usize, &'static str> {
        let mut at = self.at;
        loop {
            let element = *self.text.get(at).ok_or("malformed pattern (missing ']')")?;
            at += if element == b'%' { 2 } else { 1 };
            if self.text.get(at) == Some(&b']') {
                return Ok(at);
            }
        }
    }
}

fn insert(set: &mut Set, byte: u8) {
    set[usize::from(byte >> 6)] |= 1 << (byte & 63);
}

/// Capture while a pattern is matched.
#[derive(Clone, Copy, Debug)]
enum Capture {
    Open { start: usize },
    Closed { start: usize, end: usize },
    Position { start: usize },
}

/// Value of a capture.
#[derive(Clone, Copy, Debug)]
pub(super) enum Captured {
    Bytes {
        start: usize,
        end: usize,
    },
    /// Index from 1.
    Position(usize),
}

/// Matcher of one pattern on one subject.
pub(super) struct Matcher<'a> {
    subject: &'a [u8],
    items: &'a [Item],
    captures: [Capture; MAX_CAPTURES],
    /// Captures that are open or closed.
    level: usize,
    depth: u32,
}

impl<'a> Matcher<'a> {
    pub fn new(subject: &'a [u8], pattern: &'a Pattern) -> Self {
        let captures = [Capture::Open { start: 0 }; MAX_CAPTURES];
        Self { subject, items: &pattern.items, captures, level: 0, depth: 0 }
    }

    /// Matches the pattern at one place; returns the end of the match.
    pub fn match_at(&mut self, start: usize, meter: &mut Meter<'_>) -> Result<Option<usize>, Stop> {
        (self.level, self.depth) = (0, 0);
        self.run(start, 0, meter)
    }

    /// Number of values of a match: its captures, or the whole if it has none.
    pub fn n_values(&self) -> usize {
        self.level.max(1)
    }

    pub fn n_captures(&self) -> usize {
        self.level
    }

    /// Capture of a match; the first is the whole match if there are no captures.
    pub fn value(&self, k: usize, (start, end): (usize, usize)) -> Result<Captured, Stop> {
        if k >= self.level {
            return if k == 0 { Ok(Captured::Bytes { start, end }) } else { Err(invalid_index(k + 1)) };
        }
        match self.captures[k] {
            Capture::Open { .. } => Err(stop("unfinished capture")),
            Capture::Closed { start, end } => Ok(Captured::Bytes { start, end }),
            Capture::Position { start } => Ok(Captured::Position(start + 1)),
        }
    }

    /// Matches the items from `k` on at `s`.
    fn run(&mut self, s: usize, k: usize, meter: &mut Meter<'_>) -> Result<Option<usize>, Stop> {
        if self.depth == MAX_DEPTH {
            return Err(stop("pattern too complex"));
        }
        self.depth += 1;
        let end = self.run_items(s, k, meter);
        self.depth -= 1;
        end
    }

    fn run_items(&mut self, mut s: usize, mut k: usize, meter: &mut Meter<'_>) -> Result<Option<usize>, Stop> {
        let items = self.items;
        while let Some(item) = items.get(k) {
            meter.spend(1)?;
            k += 1;
            let next = match item {
                Item::Class(class, Repeat::Once) => self.is_class_at(class, s).then_some(s + 1),
                Item::Class(class, Repeat::Optional) => {
                    if self.is_class_at(class, s)
                        && let Some(end) = self.run(s + 1, k, meter)?
                    {
                        return Ok(Some(end));
                    }
                    Some(s)
                }
                Item::Class(class, Repeat::Greedy { is_one_needed }) => {
                    return self.run_greedy(class, s, usize::from(*is_one_needed), k, meter);
                }
                Item::Class(class, Repeat::Lazy) => return self.run_lazy(class, s, k, meter),
                Item::Open => return self.run_opened(Capture::Open { start: s }, s, k, meter),
                Item::Position => return self.run_opened(Capture::Position { start: s }, s, k, meter),
                Item::Close => return self.run_closed(s, k, meter),
                Item::Balanced(open, close) => self.balanced_end(s, *open, *close, meter)?,
                Item::Frontier(set) => self.is_frontier(set, s).then_some(s),
                Item::BackReference(digit) => self.back_reference_end(s, *digit, meter)?,
                Item::End => (s == self.subject.len()).then_some(s),
                Item::Malformed(message) => return Err(stop(*message)),
            };
            match next {
                Some(next) => s = next,
                None => return Ok(None),
            }
        }
        Ok(Some(s))
    }

    #[inline]
    fn is_class_at(&self, class: &Class, s: usize) -> bool {
        self.subject.get(s).is_some_and(|byte| class.contains(*byte))
    }

    /// The longest repetition first.
    fn run_greedy(
        &mut self,
        class: &Class,
        s: usize,
        least: usize,
        k: usize,
        meter: &mut Meter<'_>,
    ) -> Result<Option<usize>, Stop> {
        let n = self.subject[s..].iter().take_while(|byte| class.contains(**byte)).count();
        meter.spend(n)?;
        for n in (least..=n).rev() {
            if let Some(end) = self.run(s + n, k, meter)? {
                return Ok(Some(end));
            }
        }
        Ok(None)
    }

    /// The shortest repetition first.
    fn run_lazy(
        &mut self,
        class: &Class,
        mut s: usize,
        k: usize,
        meter: &mut Meter<'_>,
    ) -> Result<Option<usize>, Stop> {
        loop {
            if let Some(end) = self.run(s, k, meter)? {
                return Ok(Some(end));
            }
            if !self.is_class_at(class, s) {
                return Ok(None);
            }
            s += 1;
        }
    }

    fn run_opened(
        &mut self,
        capture: Capture,
        s: usize,
        k: usize,
        meter: &mut Meter<'_>,
    ) -> Result<Option<usize>, Stop> {
        if self.level == MAX_CAPTURES {
            return Err(stop("too many captures"));
        }
        self.captures[self.level] = capture;
        self.level += 1;
        let end = self.run(s, k, meter)?;
        if end.is_none() {
            self.level -= 1;
        }
        Ok(end)
    }

    fn run_closed(&mut self, s: usize, k: usize, meter: &mut Meter<'_>) -> Result<Option<usize>, Stop> {
        let open = self.captures[..self.level].iter().rposition(|capture| matches!(capture, Capture::Open { .. }));
        let Some(open) = open else { return Err(stop("invalid pattern capture")) };
        let before = self.captures[open];
        if let Capture::Open { start } = before {
            self.captures[open] = Capture::Closed { start, end: s };
        }
        let end = self.run(s, k, meter)?;
        if end.is_none() {
            self.captures[open] = before;
        }
        Ok(end)
    }

    fn balanced_end(&self, s: usize, open: u8, close: u8, meter: &mut Meter<'_>) -> Result<Option<usize>, Stop> {
        if self.subject.get(s) != Some(&open) {
            return Ok(None);
        }
        let mut depth = 1_usize;
        for (n, byte) in self.subject[s + 1..].iter().enumerate() {
            if *byte == close {
                depth -= 1;
                if depth == 0 {
                    meter.spend(n)?;
                    return Ok(Some(s + n + 2));
                }
            } else if *byte == open {
                depth += 1;
            }
        }
        meter.spend(self.subject.len() - s)?;
        Ok(None)
    }

    /// Returns true at a place between a byte outside the set and one in it; the ends of the subject count as `\0`.
    fn is_frontier(&self, set: &Set, s: usize) -> bool {
        let before = s.checked_sub(1).map_or(0, |k| self.subject[k]);
        let after = self.subject.get(s).copied().unwrap_or(0);
        !is_in(set, before) && is_in(set, after)
    }

    fn back_reference_end(&self, s: usize, digit: u8, meter: &mut Meter<'_>) -> Result<Option<usize>, Stop> {
        let number = usize::from(digit - b'0');
        let capture = number.checked_sub(1).filter(|k| *k < self.level).map(|k| self.captures[k]);
        match capture {
            None | Some(Capture::Open { .. }) => Err(invalid_index(number)),
            // a position is equal to no text
            Some(Capture::Position { .. }) => Ok(None),
            Some(Capture::Closed { start, end }) => {
                meter.spend((end - start) / 8)?;
                let is_equal = self.subject[s..].starts_with(&self.subject[start..end]);
                Ok(is_equal.then_some(s + end - start))
            }
        }
    }
}

fn invalid_index(number: usize) -> Stop {
    stop(format!("invalid capture index %{number}"))
}
