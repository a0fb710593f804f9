//! Programs as text in C: statements and the functions that they call.
//!
//! Every operation is a statement of its own, in the order of the program, so that no compiler may reassociate; only
//! contraction to fused operations must be forbidden, which the texts do.

mod lanes;
mod support;

use core::fmt::Write;

use sincro_math::elementary::{Binary, Unary};
use sincro_math::record::{Operation, Program, record, sin_cos_of_operations};

pub(crate) use lanes::lane_support;
pub(crate) use support::scalar_support;

/// Kind of C that statements are written in; `prefix` starts the names of the functions of its support.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Dialect<'a> {
    /// C99 on `double`; see [`scalar_support`].
    Double { prefix: &'a str },
    /// The GNU dialect on vectors, one world in each lane; see [`lane_support`].
    Lanes,
}

impl Dialect<'_> {
    fn prefix(&self) -> &str {
        match self {
            Self::Double { prefix } => prefix,
            Self::Lanes => "",
        }
    }

    /// Type of a number.
    fn number_type(&self) -> &'static str {
        match self {
            Self::Double { .. } => "double",
            Self::Lanes => "lanes",
        }
    }

    fn constant(&self, x: f64) -> String {
        match self {
            Self::Double { .. } => number(x),
            Self::Lanes => format!("ALL({})", number(x)),
        }
    }

    fn parameter(&self, i: u32) -> String {
        match self {
            Self::Double { .. } => format!("parameters[{i}]"),
            Self::Lanes => format!("AT(parameters, {i})"),
        }
    }

    /// Call of elementary function number `f`, those of two arguments after the others.
    fn call(&self, f: usize, x: &[String]) -> String {
        match self {
            Self::Double { .. } => unreachable!("exported programs call no functions"),
            Self::Lanes => format!("called(call, {f}, {}, {})", x[0], x.last().unwrap_or(&x[0])),
        }
    }

    /// Selection by [`Operation::IfLess`].
    fn if_less(&self, x: &[String]) -> String {
        match self {
            Self::Double { .. } => format!("{} < {} ? {} : {}", x[0], x[1], x[2], x[3]),
            Self::Lanes => format!("if_less({})", x.join(", ")),
        }
    }
}

/// Number as C reads it back to the same bits.
pub(crate) fn number(x: f64) -> String {
    if x.is_nan() {
        "(0.0 / 0.0)".to_owned()
    } else if x.is_infinite() {
        if x > 0.0 { "(1.0 / 0.0)".to_owned() } else { "(-1.0 / 0.0)".to_owned() }
    } else if x.is_sign_negative() {
        format!("({x:?})")
    } else {
        format!("{x:?}")
    }
}

/// Statements of a program: inputs are read first, by the expression `input(k)`, operations follow, and the outputs are
/// written last, to `output(k)`.
pub(crate) fn statements(
    program: &Program,
    dialect: Dialect<'_>,
    input: impl Fn(usize) -> String,
    output: impl Fn(usize) -> String,
) -> String {
    let StatementParts { computed, outputs } = statement_parts(program, dialect, input, output);
    computed + &outputs.concat()
}

/// Statements of a program in parts.
pub(crate) struct StatementParts {
    /// Those that read the inputs and compute.
    pub computed: String,
    /// The one that writes each output.
    pub outputs: Vec<String>,
}

/// As [`statements`], in parts.
pub(crate) fn statement_parts(
    program: &Program,
    dialect: Dialect<'_>,
    input: impl Fn(usize) -> String,
    output: impl Fn(usize) -> String,
) -> StatementParts {
    let (mut text, prefix) = (String::new(), dialect.prefix());
    let operations = program.operations();
    let mut has_angle = vec![false; operations.len()];
    let name = |k: u32| match operations[k as usize] {
        Operation::Constant(x) => dialect.constant(x),
        Operation::Sin(a) => format!("s{a}"),
        Operation::Cos(a) => format!("c{a}"),
        _ => format!("t{k}"),
    };
    for (k, operation) in operations.iter().enumerate() {
        let x: Vec<String> = operation.operands().iter().map(|&x| name(x)).collect();
        let value = match operation {
            Operation::Constant(_) => continue,
            Operation::Input(i) => input(*i as usize),
            Operation::Parameter(i) => dialect.parameter(*i),
            Operation::Add(..) => format!("{} + {}", x[0], x[1]),
            Operation::Sub(..) => format!("{} - {}", x[0], x[1]),
            Operation::Mul(..) => format!("{} * {}", x[0], x[1]),
            Operation::Div(..) => format!("{} / {}", x[0], x[1]),
            Operation::Neg(_) => format!("-{}", x[0]),
            Operation::Sqrt(_) => format!("{prefix}square_root({})", x[0]),
            Operation::Abs(_) => format!("{prefix}absolute({})", x[0]),
            Operation::Sin(a) | Operation::Cos(a) => {
                if !core::mem::replace(&mut has_angle[*a as usize], true) {
                    _ = writeln!(text, "    {} s{a}, c{a};", dialect.number_type());
                    _ = writeln!(text, "    {prefix}sine_cosine({}, &s{a}, &c{a});", x[0]);
                    if matches!(dialect, Dialect::Lanes) {
                        _ = writeln!(text, "    angles += absolute({});", x[0]);
                    }
                }
                continue;
            }
            Operation::Unary(f, _) => dialect.call(*f as usize, &x),
            Operation::Binary(f, ..) => {
                if matches!(f, Binary::Atan2 | Binary::Pow) {
                    // the value depends on the sign of a zero, which programs do not keep
                    _ = writeln!(text, "    angles += if_undecided({}, {});", x[0], x[1]);
                }
                dialect.call(Unary::ALL.len() + *f as usize, &x)
            }
            Operation::IfLess(_) => dialect.if_less(&x),
            Operation::CopySign(..) => format!("{prefix}copy_sign({}, {})", x[0], x[1]),
            Operation::IfOdd(_) => format!("{prefix}if_odd({}, {}, {})", x[0], x[1], x[2]),
            Operation::FlipBy { bit, .. } => format!("{prefix}flip_by_{bit}({}, {})", x[0], x[1]),
        };
        _ = writeln!(text, "    const {} t{k} = {value};", dialect.number_type());
    }
    let write = |(k, &result): (usize, &u32)| format!("    {} = {};\n", output(k), name(result));
    StatementParts { computed: text, outputs: program.outputs().iter().enumerate().map(write).collect() }
}

/// Statements of sine and cosine of `x` within the limit of the reduction, into `*sine` and `*cosine`.
fn sine_statements(dialect: Dialect<'_>) -> String {
    let program = record(1, 1, |x| {
        let (sine, cosine) = sin_cos_of_operations(x[0]);
        vec![sine, cosine]
    });
    let program = program.expect("the sine has no branch");
    let output = |k: usize| ["*sine", "*cosine"][k].to_owned();
    statements(&program, dialect, |_| "x".to_owned(), output)
}
