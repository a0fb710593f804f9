//! From text to program, by precedence climbing: every operator has a level, and an operand is everything of a higher
//! one.
//!
//! | level | operators |
//! |---|---|
//! | 1 | `or` |
//! | 2 | `and` |
//! | 3 | `not` before its operand |
//! | 4 | `<` `<=` `>` `>=` `==` `!=`, which do not chain |
//! | 5 | `+` `-` |
//! | 6 | `*` `/` |
//! | 7 | `^`, from the right; a sign before its operand reaches over powers only, so `-2^2` is −4 and `2^-1` is 1/2 |

use core::ops::Range;

use super::MAX_DEPTH;
use super::error::{ParseError, nearest};
use super::eval::{Binary, MAX_WHOLE_POWER, Op, run};
use super::function::{Arity, Function};
use super::lexer::{Lexer, Token};

const LEVEL_NOT: u8 = 3;
const LEVEL_COMPARISON: u8 = 4;
const LEVEL_POWER: u8 = 7;

/// Source of the slots of names.
pub(super) enum Names<'n> {
    /// The slot is the place in this list; another name is an error.
    Known(&'n [&'n str]),
    /// Every name is welcome and listed.
    Collected(Vec<String>),
}

/// Reads one formula.
pub(super) struct Parser<'t, 'n> {
    text: &'t str,
    lexer: Lexer<'t>,
    token: Token<'t>,
    span: Range<usize>,
    depth: usize,
    program: Vec<Op>,
    names: Names<'n>,
}

/// The program of the formula, and the names as they were given or found.
pub(super) fn parse<'n>(text: &str, names: Names<'n>) -> Result<(Vec<Op>, Names<'n>), ParseError> {
    let mut lexer = Lexer::new(text);
    let (token, span) = lexer.next()?;
    if token == Token::End {
        return Err(ParseError::new(text, 0..text.len(), "the formula is empty".to_owned()));
    }
    let mut parser = Parser { text, lexer, token, span, depth: 0, program: Vec::new(), names };
    parser.expression(0)?;
    match parser.token {
        Token::End => Ok((parser.program, parser.names)),
        _ => Err(parser.left_over()),
    }
}

impl<'t> Parser<'t, '_> {
    /// An operand and the operators of at least level `least` that follow it.
    fn expression(&mut self, least: u8) -> Result<(), ParseError> {
        self.operand(least)?;
        while let Token::Operator(operator) = self.token {
            let level = level(operator);
            if level < least {
                break;
            }
            self.advance()?;
            if operator == Binary::Pow {
                self.nested(|parser| parser.expression(LEVEL_POWER))?;
            } else {
                self.expression(level + 1)?;
            }
            self.emit(Op::Binary(operator));
            if level == LEVEL_COMPARISON {
                self.refuse_second_comparison()?;
            }
        }
        Ok(())
    }

    /// A value, or a sign or `not` and what it belongs to.
    fn operand(&mut self, least: u8) -> Result<(), ParseError> {
        match self.token {
            Token::Number(x) => {
                self.emit(Op::Constant(x));
                self.advance()
            }
            Token::Name(name) => self.named(name),
            Token::Open => self.bracketed(),
            Token::Operator(sign @ (Binary::Add | Binary::Sub)) => {
                self.advance()?;
                self.nested(|parser| parser.expression(LEVEL_POWER))?;
                if sign == Binary::Sub {
                    self.emit(Op::Neg);
                }
                Ok(())
            }
            Token::Not if least <= LEVEL_NOT => {
                self.advance()?;
                self.nested(|parser| parser.expression(LEVEL_NOT))?;
                self.emit(Op::Not);
                Ok(())
            }
            Token::Not => {
                Err(self.fail("`not` binds weaker than what stands before it").with_help("write `(not ...)`"))
            }
            Token::Operator(_) | Token::Close | Token::Comma | Token::End => Err(self.value_missing()),
        }
    }

    /// `( … )`
    fn bracketed(&mut self) -> Result<(), ParseError> {
        let open = self.span.clone();
        self.advance()?;
        self.nested(|parser| parser.expression(0))?;
        match self.token {
            Token::Close => self.advance(),
            Token::End => Err(self.never_closed(open)),
            _ => Err(self.left_over()),
        }
    }

    /// A name of a value, or a call.
    fn named(&mut self, name: &'t str) -> Result<(), ParseError> {
        let span = self.span.clone();
        self.advance()?;
        if self.token == Token::Open {
            return self.call(name, span);
        }
        let slot = match &mut self.names {
            Names::Known(names) => names.iter().position(|known| *known == name),
            Names::Collected(_) if name == "pi" || Function::named(name).is_some() => None,
            Names::Collected(found) => {
                if !found.iter().any(|known| known == name) {
                    found.push(name.to_owned());
                }
                Some(0) // the program of a formula whose names are collected is never run
            }
        };
        match slot {
            Some(slot) => self.emit(Op::Value(u32::try_from(slot).expect("fewer than 2^32 names"))),
            None if name == "pi" => self.emit(Op::Constant(core::f64::consts::PI)),
            None => return Err(self.unknown_name(name, span)),
        }
        Ok(())
    }

    /// The arguments after the name of a function; the opening bracket is the current token.
    fn call(&mut self, name: &str, span: Range<usize>) -> Result<(), ParseError> {
        let Some(function) = Function::named(name) else {
            return Err(self.unknown_function(name, span));
        };
        let open = self.span.clone();
        self.advance()?;
        let mut count: u16 = 0;
        if self.token != Token::Close {
            loop {
                self.nested(|parser| parser.expression(0))?;
                count += 1; // cannot overflow: an argument takes two bytes of a formula of bounded length
                match self.token {
                    Token::Comma => self.advance()?,
                    Token::Close => break,
                    Token::End => return Err(self.never_closed(open)),
                    _ => return Err(self.left_over()),
                }
            }
        }
        let span = span.start..self.span.end;
        if !function.arity().admits(usize::from(count)) {
            return Err(self.wrong_count(function, name, usize::from(count), span));
        }
        self.emit(Op::Call(function, count));
        self.advance()
    }

    fn advance(&mut self) -> Result<(), ParseError> {
        (self.token, self.span) = self.lexer.next()?;
        Ok(())
    }

    /// One level deeper, within the limit that keeps the parser's own stack bounded.
    fn nested(&mut self, read: impl FnOnce(&mut Self) -> Result<(), ParseError>) -> Result<(), ParseError> {
        if self.depth == MAX_DEPTH {
            return Err(self.fail(&format!("the formula is nested more than {MAX_DEPTH} levels deep")));
        }
        self.depth += 1;
        let result = read(self);
        self.depth -= 1;
        result
    }

    /// Appends a step; computes it now if its operands are constants, by the same code that would compute it later.
    fn emit(&mut self, op: Op) {
        let op = match (op, self.program.last()) {
            (Op::Binary(Binary::Pow), Some(&Op::Constant(exponent))) => match whole(exponent) {
                Some(exponent) => {
                    self.program.pop();
                    Op::Power(exponent)
                }
                None => op,
            },
            _ => op,
        };
        let first = self.program.len() - op.takes();
        let constant = op.takes() > 0 && self.program[first..].iter().all(|op| matches!(op, Op::Constant(_)));
        self.program.push(op);
        if constant {
            let value: f64 = run(&self.program[first..], &[], &mut Vec::new());
            self.program.truncate(first);
            self.program.push(Op::Constant(value));
        }
    }
}

/// Error message and correction.
impl Parser<'_, '_> {
    /// An error at the current token.
    fn fail(&self, message: &str) -> ParseError {
        ParseError::new(self.text, self.span.clone(), message.to_owned())
    }

    fn shown(&self) -> &str {
        &self.text[self.span.clone()]
    }

    fn value_missing(&self) -> ParseError {
        match self.token {
            Token::End => self.fail("a value is missing at the end"),
            _ => self.fail(&format!("a value is missing before `{}`", self.shown())),
        }
    }

    /// The current token stands where the formula should have ended or gone on with an operator.
    fn left_over(&self) -> ParseError {
        match self.token {
            Token::Close => self.fail("`)` closes nothing"),
            Token::Comma => self
                .fail("`,` outside the arguments of a function")
                .with_help("decimals are written with a point: `1.5`"),
            _ => self
                .fail(&format!("missing operator before `{}`", self.shown()))
                .with_help("a product is written `a*b`"),
        }
    }

    fn never_closed(&self, open: Range<usize>) -> ParseError {
        ParseError::new(self.text, open, "`(` is never closed".to_owned())
    }

    fn refuse_second_comparison(&self) -> Result<(), ParseError> {
        match self.token {
            Token::Operator(operator) if level(operator) == LEVEL_COMPARISON => {
                Err(self.fail("comparisons do not chain").with_help("write `a < b and b < c`"))
            }
            _ => Ok(()),
        }
    }

    fn unknown_name(&self, name: &str, span: Range<usize>) -> ParseError {
        if let Some(function) = Function::named(name) {
            let error = ParseError::new(self.text, span, format!("function `{name}` without arguments"));
            return error.with_help(format!("write `{}`", function.usage()));
        }
        let error = ParseError::new(self.text, span, format!("unknown name `{name}`"));
        let known = if let Names::Known(names) = self.names { names } else { &[] };
        match (nearest(name, known.iter().copied().chain(["pi"])), name) {
            (Some(near), _) => error.with_help(format!("did you mean `{near}`?")),
            (None, "e") => error.with_help("Euler's number is `exp(1)`, a power of ten `1e3`"),
            (None, "true" | "false") => error.with_help("true is 1, false is 0"),
            _ => error,
        }
    }

    fn unknown_function(&self, name: &str, span: Range<usize>) -> ParseError {
        if let Names::Known(names) = self.names
            && names.contains(&name)
        {
            let error = ParseError::new(self.text, span, format!("`{name}` is a value, not a function"));
            return error.with_help(format!("a product is written `{name}*(...)`"));
        }
        let error = ParseError::new(self.text, span, format!("unknown function `{name}`"));
        match (name, nearest(name, Function::names())) {
            ("log", _) => error.with_help("`ln` is the natural logarithm, `log10` the decimal one"),
            ("pow", _) => error.with_help("a power is written `x^y`"),
            (_, Some(near)) => error.with_help(format!("did you mean `{near}`?")),
            (_, None) => error,
        }
    }

    fn wrong_count(&self, function: Function, name: &str, count: usize, span: Range<usize>) -> ParseError {
        let (bound, n) = match function.arity() {
            Arity::Exactly(n) => ("", n),
            Arity::AtLeast(n) => ("at least ", n),
        };
        let noun = if n == 1 { "argument" } else { "arguments" };
        let message = format!("`{name}` takes {bound}{n} {noun}, not {count}");
        ParseError::new(self.text, span, message).with_help(format!("write `{}`", function.usage()))
    }
}

fn level(operator: Binary) -> u8 {
    match operator {
        Binary::Or => 1,
        Binary::And => 2,
        Binary::Less | Binary::LessEqual | Binary::Greater => LEVEL_COMPARISON,
        Binary::GreaterEqual | Binary::Equal | Binary::NotEqual => LEVEL_COMPARISON,
        Binary::Add | Binary::Sub => 5,
        Binary::Mul | Binary::Div => 6,
        Binary::Pow => LEVEL_POWER,
    }
}

/// The exponent, where the power is a product of a few factors.
fn whole(exponent: f64) -> Option<i8> {
    let small = exponent.abs() <= f64::from(MAX_WHOLE_POWER) && exponent == libm::trunc(exponent);
    small.then_some(exponent as i8)
}
