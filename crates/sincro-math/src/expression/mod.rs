//! Formulas in text, such as `0.5*m*v^2 + k*x`, evaluated over any [`Real`].
//!
//! A formula is read once, its names resolved to slots and its constants computed; evaluating it then runs a short flat
//! program and allocates nothing.
//!
//! ```
//! use sincro_math::expression::Expression;
//! use sincro_math::Dual;
//!
//! let energy = Expression::parse("0.5*m*v^2", &["m", "v"])?;
//! assert_eq!(energy.eval(&[2.0, 3.0], &mut energy.scratch()), 9.0);
//!
//! // the same formula, differentiated by v
//! let (m, v) = (Dual::constant(2.0), Dual::<1>::variable(3.0, 0));
//! assert_eq!(energy.eval(&[m, v], &mut energy.scratch()).partials, [6.0]);
//! # Ok::<(), sincro_math::expression::ParseError>(())
//! ```
//!
//! # The language
//!
//! | | |
//! |---|---|
//! | numbers | `1`, `.5`, `1.5e-3`; `pi` |
//! | names | letters, digits and `_`, with dots inside and primes at the end: `x`, `u1`, `arm.q`, `q1'`, `q1''` |
//! | arithmetic | `+ - * /` and `^`, which goes from the right and before a sign: `-2^2` is −4, `2^3^2` is 512 |
//! | comparisons | `< <= > >= == !=`, which give 1 or 0 and do not chain |
//! | logic | `not`, `and`, `or`: zero is false, any other number true |
//! | angles `[rad]` | `sin cos tan asin acos atan atan2(y, x)` |
//! | growth | `sqrt exp ln log10 sinh cosh tanh hypot(x, y)` |
//! | corners | `abs sign floor ceil mod(x, modulus) min(a, b, ...) max(a, b, ...) clamp(x, low, high)` |
//! | choice | `if(condition, then, otherwise)` |
//!
//! Names differ by case. A name given by the caller wins over `pi`, and over a function that is not called; `and`, `or`
//! and `not` are never names. A power with a whole exponent up to ±8 in the text is computed as a product.
//!
//! A NaN is never hidden: comparisons, logic, `min`, `max`, `clamp` and the condition of `if` pass it on. The branch
//! that `if` does not take leaves no trace, neither in the value nor in the derivatives.

mod error;
mod eval;
mod function;
mod lexer;
mod parse;
mod unit;

use core::fmt;

use crate::{Branches, Real};
use eval::Op;
use parse::Names;

pub use error::ParseError;
pub use unit::Units;

/// Length limit of a formula in bytes; [`Expression::parse`] refuses longer ones. Bounds time and memory for pasted
/// text.
pub const MAX_LENGTH: usize = 65_536;

/// Limit on the nesting of brackets, arguments, signs and exponents; [`Expression::parse`] refuses deeper formulas.
/// Bounds the stack of the parser.
pub const MAX_DEPTH: usize = 100;

/// Compiled formula of named values, for scenes, blocks and force laws; displays as the text from which it was read.
///
/// ```
/// use sincro_math::expression::Expression;
///
/// let energy = Expression::parse("0.5*m*v^2", &["m", "v"])?;
/// assert_eq!(energy.eval(&[2.0, 3.0], &mut energy.scratch()), 9.0);
/// # Ok::<(), sincro_math::expression::ParseError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Expression {
    text: String,
    program: Vec<Op>,
    stack_depth: usize,
    n_names: usize,
}

impl Expression {
    /// Parses a formula of the given `names`; the value of `names[i]` is expected in `values[i]` by
    /// [`Expression::eval`].
    ///
    /// # Errors
    ///
    /// [`ParseError`] with the first fault of the text: position, description, and a help where there is one.
    ///
    /// ```
    /// use sincro_math::expression::Expression;
    ///
    /// assert!(Expression::parse("if(x > 0, sqrt(x), 0)", &["x"]).is_ok());
    /// let error = Expression::parse("3*siin(x)", &["x"]).unwrap_err();
    /// assert_eq!(error.message, "unknown function `siin`");
    /// assert_eq!(error.help.as_deref(), Some("did you mean `sin`?"));
    /// ```
    pub fn parse(text: &str, names: &[&str]) -> Result<Self, ParseError> {
        check_length(text)?;
        let (program, _) = parse::parse(text, Names::Known(names))?;
        let stack_depth = eval::stack_depth(&program);
        Ok(Self { text: text.to_owned(), program, stack_depth, n_names: names.len() })
    }

    /// Names that a formula uses, in the order in which they first appear; `pi` and functions are not among them.
    ///
    /// # Errors
    ///
    /// [`ParseError`] as of [`Expression::parse`], except that any name is known.
    ///
    /// ```
    /// use sincro_math::expression::Expression;
    ///
    /// assert_eq!(Expression::names_in("k*(x - x0) + sin(2*pi*x)")?, ["k", "x", "x0"]);
    /// # Ok::<(), sincro_math::expression::ParseError>(())
    /// ```
    pub fn names_in(text: &str) -> Result<Vec<String>, ParseError> {
        check_length(text)?;
        match parse::parse(text, Names::Collected(Vec::new()))? {
            (_, Names::Collected(names)) => Ok(names),
            (_, Names::Known(_)) => unreachable!("the parser returns the names it was given"),
        }
    }

    /// Value of the formula. `values[i]` belongs to the `i`-th name given to [`Expression::parse`]; units are the
    /// caller's, angles of trigonometric functions `[rad]`.
    ///
    /// `stack` is scratch memory of any content; one from [`Expression::scratch`], or with a capacity of at least
    /// [`Expression::stack_depth`], never grows.
    ///
    /// # Panics
    ///
    /// If there are fewer values than names.
    pub fn eval<R: Real>(&self, values: &[R], stack: &mut Vec<R>) -> R {
        assert!(values.len() >= self.n_names, "{} values for {} names", values.len(), self.n_names);
        if R::IS_SCALAR {
            return eval::run(&self.program, values, stack);
        }
        R::run_hot(eval::Run { program: &self.program, values, stack })
    }

    /// Value of the formula, as of [`Expression::eval`], with a stack of fixed length and any content.
    ///
    /// # Panics
    ///
    /// If there are fewer values than names, or the stack is shorter than [`Expression::stack_depth`].
    pub fn eval_in<R: Real>(&self, values: &[R], stack: &mut [R]) -> R {
        assert!(values.len() >= self.n_names, "{} values for {} names", values.len(), self.n_names);
        if R::IS_SCALAR {
            return eval::run_in(&self.program, values, stack);
        }
        R::run_hot(eval::RunIn { program: &self.program, values, stack })
    }

    /// Notes the branches that the formula takes at `values`: results of comparisons and logic, signs of `abs` and
    /// `sign`, steps of `floor`, `ceil` and `mod`, the argument that `min`, `max` and `clamp` give. Where they stay the
    /// same the formula is smooth. `stack` as for [`Expression::eval_in`].
    ///
    /// ```
    /// use sincro_math::Branches;
    /// use sincro_math::expression::Expression;
    ///
    /// let rope = Expression::parse("if(x > 0, -40*x, 0)", &["x"])?;
    /// let branches_at = |x: f64| {
    ///     let mut branches = Branches::default();
    ///     rope.note_branches(&[x], &mut vec![0.0; rope.stack_depth()], &mut branches);
    ///     branches
    /// };
    /// assert!(branches_at(-1.0) == branches_at(-2.0) && branches_at(-1.0) != branches_at(1.0));
    /// # Ok::<(), sincro_math::expression::ParseError>(())
    /// ```
    ///
    /// # Panics
    ///
    /// If there are fewer values than names, or the stack is shorter than [`Expression::stack_depth`].
    pub fn note_branches(&self, values: &[f64], stack: &mut [f64], branches: &mut Branches) {
        assert!(values.len() >= self.n_names, "{} values for {} names", values.len(), self.n_names);
        eval::note_branches(&self.program, values, stack, branches);
    }

    /// Empty stack for [`Expression::eval`], with memory for [`Expression::stack_depth`] values.
    #[must_use]
    pub fn scratch<R: Real>(&self) -> Vec<R> {
        Vec::with_capacity(self.stack_depth)
    }

    /// Largest number of intermediate values at once: the length that the stack of [`Expression::eval_in`] needs.
    #[must_use]
    pub fn stack_depth(&self) -> usize {
        self.stack_depth
    }

    /// Value of a formula that depends on no name; `None` if it uses one.
    ///
    /// ```
    /// use sincro_math::expression::Expression;
    ///
    /// assert_eq!(Expression::parse("2*pi/4", &[])?.constant(), Some(std::f64::consts::FRAC_PI_2));
    /// # Ok::<(), sincro_math::expression::ParseError>(())
    /// ```
    #[must_use]
    pub fn constant(&self) -> Option<f64> {
        match self.program[..] {
            [Op::Constant(value)] => Some(value),
            _ => None,
        }
    }

    /// Returns true if the name of index `slot` in the list given to [`Expression::parse`] appears in the formula;
    /// false for an index beyond the list.
    #[must_use]
    pub fn uses(&self, slot: usize) -> bool {
        self.program.iter().any(|op| matches!(op, Op::Value(used) if *used as usize == slot))
    }

    /// Formula as it was written.
    #[must_use]
    pub fn text(&self) -> &str {
        &self.text
    }
}

impl fmt::Display for Expression {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.text)
    }
}

/// Returns true if `text` can be a name in a formula: letters, digits and `_`, beginning with a letter or `_`, with
/// single dots inside and primes at the end, and no reserved word (`and`, `or`, `not`).
///
/// ```
/// use sincro_math::expression::is_name;
///
/// assert!(is_name("x0") && is_name("arm.q1''"));
/// assert!(!is_name("2x") && !is_name("a-b") && !is_name("not") && !is_name(""));
/// ```
#[must_use]
pub fn is_name(text: &str) -> bool {
    let reserved = matches!(text, "and" | "or" | "not");
    text.starts_with(lexer::starts_name) && lexer::name_length(text) == text.len() && !reserved
}

fn check_length(text: &str) -> Result<(), ParseError> {
    if text.len() <= MAX_LENGTH {
        return Ok(());
    }
    let message = format!("the formula is {} bytes long, more than {MAX_LENGTH}", text.len());
    Err(ParseError::new(text, 0..text.len(), message))
}
