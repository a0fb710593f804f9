//! Random formulas against a tree that is evaluated directly; duals against differences; lanes against scalars.

use proptest::prelude::*;
use proptest::test_runner::{Config, RngSeed};
use sincro_math::expression::Expression;
use sincro_math::{Dual, Lanes, Real};

const NAMES: [&str; 3] = ["x", "y'", "arm.z"];

/// A formula as it is meant, before it is written down.
#[derive(Clone, Debug)]
enum Tree {
    Number(f64),
    Name(usize),
    Neg(Box<Tree>),
    Not(Box<Tree>),
    Binary(&'static str, Box<Tree>, Box<Tree>),
    Call(&'static str, Vec<Tree>),
}

impl Tree {
    fn level(&self) -> u8 {
        match self {
            Self::Binary("or", ..) => 1,
            Self::Binary("and", ..) => 2,
            Self::Not(_) => 3,
            Self::Binary("<" | "<=" | ">" | ">=" | "==" | "!=", ..) => 4,
            Self::Binary("+" | "-", ..) => 5,
            Self::Binary("*" | "/", ..) => 6,
            Self::Neg(_) => 7,
            Self::Binary(..) => 8,
            Self::Number(_) | Self::Name(_) | Self::Call(..) => 9,
        }
    }

    /// The text with as few brackets as the rules allow, so that the rules are tested too; names are written by `name`.
    fn text(&self, least: u8, name: &dyn Fn(usize) -> String) -> String {
        let level = self.level();
        let text = match self {
            Self::Number(x) => format!("{x:?}"),
            Self::Name(slot) => name(*slot),
            Self::Neg(a) => format!("-{}", a.text(7, name)),
            Self::Not(a) => format!("not {}", a.text(3, name)),
            Self::Binary(op, a, b) => {
                let (left, right) = match level {
                    4 => (5, 5),
                    8 => (9, 7),
                    _ => (level, level + 1),
                };
                format!("{} {op} {}", a.text(left, name), b.text(right, name))
            }
            Self::Call(function, arguments) => {
                let arguments: Vec<String> = arguments.iter().map(|a| a.text(0, name)).collect();
                format!("{function}({})", arguments.join(", "))
            }
        };
        if level < least { format!("({text})") } else { text }
    }

    fn value(&self, values: &[f64]) -> f64 {
        match self {
            Self::Number(x) => *x,
            Self::Name(slot) => values[*slot],
            Self::Neg(a) => -a.value(values),
            Self::Not(a) => truth(&[a.value(values)], |x| x[0] == 0.0),
            Self::Binary(op, a, b) => binary(op, a.value(values), b.value(values)),
            Self::Call(function, arguments) => {
                call(function, &arguments.iter().map(|a| a.value(values)).collect::<Vec<_>>())
            }
        }
    }
}

fn truth(x: &[f64], holds: impl Fn(&[f64]) -> bool) -> f64 {
    if x.iter().any(|x| x.is_nan()) { f64::NAN } else { f64::from(u8::from(holds(x))) }
}

fn binary(op: &str, a: f64, b: f64) -> f64 {
    match op {
        "+" => a + b,
        "-" => a - b,
        "*" => a * b,
        "/" => a / b,
        "^" if b == 2.0 => a * a,
        "^" if b == -1.0 => 1.0 / a,
        "^" => libm::pow(a, b),
        "<" => truth(&[a, b], |x| x[0] < x[1]),
        "<=" => truth(&[a, b], |x| x[0] <= x[1]),
        ">" => truth(&[a, b], |x| x[0] > x[1]),
        ">=" => truth(&[a, b], |x| x[0] >= x[1]),
        "==" => truth(&[a, b], |x| x[0] == x[1]),
        "!=" => truth(&[a, b], |x| x[0] != x[1]),
        "and" => truth(&[a, b], |x| x[0] != 0.0 && x[1] != 0.0),
        "or" => truth(&[a, b], |x| x[0] != 0.0 || x[1] != 0.0),
        _ => unreachable!("{op}"),
    }
}

fn call(function: &str, x: &[f64]) -> f64 {
    let not_a_number = x.iter().any(|x| x.is_nan());
    match function {
        "sin" => Real::sin_cos(x[0]).0,
        "cos" => Real::sin_cos(x[0]).1,
        "tan" => libm::tan(x[0]),
        "asin" => libm::asin(x[0]),
        "acos" => libm::acos(x[0]),
        "atan" => libm::atan(x[0]),
        "sqrt" => libm::sqrt(x[0]),
        "exp" => libm::exp(x[0]),
        "ln" => libm::log(x[0]),
        "log10" => libm::log10(x[0]),
        "sinh" => libm::sinh(x[0]),
        "cosh" => libm::cosh(x[0]),
        "tanh" => libm::tanh(x[0]),
        "abs" => libm::fabs(x[0]),
        "floor" => libm::floor(x[0]),
        "ceil" => libm::ceil(x[0]),
        "atan2" => libm::atan2(x[0], x[1]),
        "hypot" => libm::hypot(x[0], x[1]),
        "sign" if x[0] == 0.0 || not_a_number => x[0],
        "sign" => libm::copysign(1.0, x[0]),
        "min" | "max" | "clamp" if not_a_number => f64::NAN,
        "min" => x.iter().fold(f64::INFINITY, |a, &b| if b < a { b } else { a }),
        "max" => x.iter().fold(f64::NEG_INFINITY, |a, &b| if b > a { b } else { a }),
        "clamp" if x[0] < x[1] => call("min", &[x[1], x[2]]),
        "clamp" => call("min", &[x[0], x[2]]),
        "if" if x[0].is_nan() => f64::NAN,
        "if" => x[if x[0] != 0.0 { 1 } else { 2 }],
        _ => unreachable!("{function}"),
    }
}

const ONE_ARGUMENT: [&str; 17] = [
    "sin", "cos", "tan", "asin", "acos", "atan", "sqrt", "exp", "ln", "log10", "sinh", "cosh", "tanh", "abs", "floor",
    "ceil", "sign",
];
const OPERATORS: [&str; 12] = ["+", "-", "*", "/", "<", "<=", ">", ">=", "==", "!=", "and", "or"];

fn leaf() -> impl Strategy<Value = Tree> {
    prop_oneof![
        (0..NAMES.len()).prop_map(Tree::Name),
        (0u16..40).prop_map(|n| Tree::Number(f64::from(n) / 8.0)),
        (0.0..1e6).prop_map(Tree::Number),
    ]
}

fn exponent() -> impl Strategy<Value = Tree> {
    let minus_one = Tree::Neg(Box::new(Tree::Number(1.0)));
    prop_oneof![Just(Tree::Number(2.0)), Just(Tree::Number(0.5)), Just(minus_one)]
}

/// Any formula of the language.
fn formula() -> impl Strategy<Value = Tree> {
    leaf().prop_recursive(6, 40, 3, |inner| {
        let several = |n| prop::collection::vec(inner.clone(), n);
        prop_oneof![
            inner.clone().prop_map(|a| Tree::Neg(Box::new(a))),
            inner.clone().prop_map(|a| Tree::Not(Box::new(a))),
            (prop::sample::select(&OPERATORS[..]), inner.clone(), inner.clone()).prop_map(|(op, a, b)| Tree::Binary(
                op,
                Box::new(a),
                Box::new(b)
            )),
            (inner.clone(), exponent()).prop_map(|(a, b)| Tree::Binary("^", Box::new(a), Box::new(b))),
            (prop::sample::select(&ONE_ARGUMENT[..]), several(1..2)).prop_map(|(f, a)| Tree::Call(f, a)),
            (prop::sample::select(&["atan2", "hypot"][..]), several(2..3)).prop_map(|(f, a)| Tree::Call(f, a)),
            (prop::sample::select(&["min", "max"][..]), several(2..5)).prop_map(|(f, a)| Tree::Call(f, a)),
            (prop::sample::select(&["if", "clamp"][..]), several(3..4)).prop_map(|(f, a)| Tree::Call(f, a)),
        ]
    })
}

/// Formulas that are smooth and moderate everywhere.
fn smooth() -> impl Strategy<Value = Tree> {
    let leaf = prop_oneof![(0..NAMES.len()).prop_map(Tree::Name), (0.0..2.0).prop_map(Tree::Number)];
    leaf.prop_recursive(4, 16, 2, |inner| {
        let pair = (inner.clone(), inner.clone());
        prop_oneof![
            (prop::sample::select(&["+", "-", "*"][..]), pair.clone()).prop_map(|(op, (a, b))| Tree::Binary(
                op,
                Box::new(a),
                Box::new(b)
            )),
            (prop::sample::select(&["sin", "cos", "atan", "tanh"][..]), inner.clone())
                .prop_map(|(f, a)| Tree::Call(f, vec![a])),
            pair.prop_map(|(a, b)| {
                let square = Tree::Binary("^", Box::new(b), Box::new(Tree::Number(2.0)));
                let above_one = Tree::Binary("+", Box::new(Tree::Number(1.0)), Box::new(square));
                Tree::Binary("/", Box::new(a), Box::new(above_one))
            }),
        ]
    })
}

fn slot_name(slot: usize) -> String {
    NAMES[slot].to_owned()
}

fn compiled(tree: &Tree) -> Expression {
    let text = tree.text(0, &slot_name);
    Expression::parse(&text, &NAMES).unwrap_or_else(|error| panic!("{text}: {error}"))
}

/// Equal to the bit; a NaN has no particular bits.
fn same(a: f64, b: f64) -> bool {
    a.to_bits() == b.to_bits() || a.is_nan() && b.is_nan()
}

fn config() -> Config {
    Config { cases: 2000, rng_seed: RngSeed::Fixed(7), failure_persistence: None, ..Config::default() }
}

proptest! {
    #![proptest_config(config())]

    #[test]
    fn no_text_makes_the_parser_panic(text in any::<String>()) {
        let _ = Expression::parse(&text, &NAMES);
        let _ = Expression::names_in(&text);
    }

    #[test]
    fn no_row_of_tokens_makes_it_panic(tokens in prop::collection::vec(prop::sample::select(vec![
        "1", "2.5e3", "x", "y'", "q", "pi", "+", "-", "*", "/", "^", "<", "==", "!=", "and", "or", "not ", "(", ")", ",",
        "sin(", "min(", "if(", " ", ".", "e", "'", "é",
    ]), 0..20)) {
        let text = tokens.concat();
        match Expression::parse(&text, &NAMES) {
            Ok(formula) => drop(formula.eval(&[1.0, 2.0, 3.0], &mut formula.scratch())),
            Err(error) => prop_assert!(text.get(error.span.clone()).is_some(), "{text}: {error}"),
        }
    }

    #[test]
    fn a_formula_means_what_was_written(tree in formula(), values in prop::array::uniform3(-4.0..4.0)) {
        let formula = compiled(&tree);
        let mut stack = formula.scratch();
        let (value, expected) = (formula.eval(&values, &mut stack), tree.value(&values));
        prop_assert!(same(value, expected), "{formula}: {value} instead of {expected}");
        prop_assert!(stack.capacity() == formula.stack_depth());
    }

    #[test]
    fn computing_constants_beforehand_changes_no_bit(tree in formula(), values in prop::array::uniform3(0.0..4.0)) {
        let text = tree.text(0, &|slot| format!("{:?}", values[slot]));
        let constant = Expression::parse(&text, &[]).expect("it is a formula").constant();
        let formula = compiled(&tree);
        prop_assert!(constant.is_some_and(|c| same(c, formula.eval(&values, &mut formula.scratch()))), "{text}");
    }

    #[test]
    fn a_lane_has_the_bits_of_the_scalar(tree in formula(), worlds in prop::array::uniform4(prop::array::uniform3(-4.0..4.0))) {
        let formula = compiled(&tree);
        let values: [Lanes<4>; 3] = core::array::from_fn(|slot| Lanes(worlds.map(|world: [f64; 3]| world[slot])));
        let lanes = formula.eval(&values, &mut formula.scratch());
        for (k, world) in worlds.iter().enumerate() {
            let alone = formula.eval(world, &mut formula.scratch());
            prop_assert!(same(lanes.0[k], alone), "{formula}, lane {k}: {} instead of {alone}", lanes.0[k]);
        }
    }

    #[test]
    fn a_dual_has_the_value_of_the_scalar(tree in formula(), values in prop::array::uniform3(-4.0..4.0)) {
        let formula = compiled(&tree);
        let duals: [Dual<3>; 3] = core::array::from_fn(|slot| Dual::variable(values[slot], slot));
        let dual = formula.eval(&duals, &mut formula.scratch());
        prop_assert!(same(dual.value, formula.eval(&values, &mut formula.scratch())), "{formula}");
    }

    #[test]
    fn duals_are_the_limit_of_differences(tree in smooth(), values in prop::array::uniform3(-1.0..1.0)) {
        let formula = compiled(&tree);
        let duals: [Dual<3>; 3] = core::array::from_fn(|slot| Dual::variable(values[slot], slot));
        let exact = formula.eval(&duals, &mut formula.scratch()).partials;
        let difference = |slot: usize, h: f64| {
            let at = |x: f64| {
                let mut values = values;
                values[slot] = x;
                formula.eval(&values, &mut formula.scratch())
            };
            (at(values[slot] + h) - at(values[slot] - h)) / (2.0 * h)
        };
        for (slot, exact) in exact.into_iter().enumerate() {
            // the error falls by four when h is halved, so the finer one is off by a third of what they differ;
            // the rest is rounding, 1e-16/h of intermediate results up to some hundred
            let (coarse, fine) = (difference(slot, 1e-4), difference(slot, 5e-5));
            let room = (coarse - fine).abs() + 1e-9 * (1.0 + exact.abs());
            prop_assert!((exact - fine).abs() <= room, "{formula}, {}: {exact} {fine}", NAMES[slot]);
        }
    }

    #[test]
    fn the_names_found_are_those_used(tree in formula()) {
        let formula = compiled(&tree);
        let found = Expression::names_in(formula.text()).expect("it is a formula");
        for (slot, name) in NAMES.iter().enumerate() {
            prop_assert_eq!(formula.uses(slot), found.iter().any(|f| f == name));
        }
    }
}
