//! Meaning of formulas, and refusal of wrong ones.

use sincro_math::expression::{Expression, MAX_DEPTH, MAX_LENGTH, ParseError, is_name};

const NAMES: [&str; 6] = ["x", "y", "omega", "q1'", "q1''", "arm.q"];
const VALUES: [f64; 6] = [3.0, -2.0, 0.5, 7.0, 11.0, 13.0];

fn value(text: &str) -> f64 {
    let formula = Expression::parse(text, &NAMES).unwrap_or_else(|error| panic!("{text}: {error}"));
    formula.eval(&VALUES, &mut formula.scratch())
}

fn refusal(text: &str) -> ParseError {
    Expression::parse(text, &NAMES).expect_err(text)
}

fn all_have_values(cases: &[(&str, f64)]) {
    for &(text, expected) in cases {
        assert_eq!(value(text), expected, "{text}");
    }
}

#[test]
fn numbers_and_names() {
    all_have_values(&[
        ("1", 1.0),
        (".5", 0.5),
        ("2.", 2.0),
        ("1.5e-3", 0.0015),
        ("1E3", 1000.0),
        (" x ", 3.0),
        ("q1'", 7.0),
        ("q1''-q1'", 4.0),
        ("arm.q", 13.0),
        ("pi", core::f64::consts::PI),
    ]);
}

#[test]
fn operators_bind_as_in_mathematics() {
    all_have_values(&[
        ("1+2*3", 7.0),
        ("(1+2)*3", 9.0),
        ("7-2-1", 4.0),
        ("8/4/2", 1.0),
        ("-2^2", -4.0),
        ("-x^2", -9.0),
        ("(-2)^2", 4.0),
        ("2^3^2", 512.0),
        ("2^-1", 0.5),
        ("2^-2^2", 0.0625),
        ("x^-2*9", 1.0),
        ("2*-x", -6.0),
        ("--x", 3.0),
        ("+x - y", 5.0),
        ("+x^2", 9.0),
        ("2*+x", 6.0),
    ]);
}

#[test]
fn comparisons_and_logic_give_one_or_zero() {
    all_have_values(&[
        ("x < 3", 0.0),
        ("x <= 3", 1.0),
        ("x > y", 1.0),
        ("y >= x", 0.0),
        ("x == 3", 1.0),
        ("x != 3", 0.0),
        ("x + 1 > 2 * 1", 1.0),
        ("x > 0 and y > 0", 0.0),
        ("x > 0 or y > 0", 1.0),
        ("not x > 5", 1.0),
        ("not not x", 1.0),
        ("0 or x", 1.0),
        ("0 or 0", 0.0),
        ("x and y", 1.0),
        ("x and 0", 0.0),
        ("0 and x", 0.0),
        ("1 or 0 and 0", 1.0),
        ("not 0 and 0", 0.0),
        ("(x > 0) + (y < 0)", 2.0),
    ]);
}

#[test]
fn functions() {
    all_have_values(&[
        ("sin(0) + cos(0) + tan(0)", 1.0),
        ("atan2(0, -1)", core::f64::consts::PI),
        ("asin(1) - acos(0)", 0.0),
        ("atan(1)", core::f64::consts::FRAC_PI_4),
        ("sqrt(16) + exp(0) + ln(1) + log10(1000)", 8.0),
        ("sinh(0) + cosh(0) + tanh(0)", 1.0),
        ("abs(y) + sign(y) + sign(0)", 1.0),
        ("floor(-1.5) + ceil(-1.5)", -3.0),
        ("mod(-1, 3)", 2.0),
        ("min(3, x, y) + max(1, 2, x, 0)", 1.0),
        ("clamp(x, 0, 1) + clamp(y, -1, 1)", 0.0),
        ("hypot(3, 4)", 5.0),
        ("if(x > 0, 10, 20)", 10.0),
        ("if(y, 1, 2)", 1.0),
        ("if(y > 0, sqrt(y), 0)", 0.0),
    ]);
}

#[test]
fn what_is_not_a_number_is_not_hidden() {
    for text in ["ln(y) < 1", "not ln(y)", "0 and ln(y)", "min(1, ln(y))", "clamp(ln(y), 0, 1)", "if(ln(y) > 0, 1, 2)"]
    {
        assert!(value(text).is_nan(), "{text}");
    }
}

#[test]
fn refusals_name_the_place_the_fault_and_the_cure() {
    for (text, expected) in [
        ("", "column 1: the formula is empty"),
        ("1 +", "column 4: a value is missing at the end"),
        ("1 + * 2", "column 5: a value is missing before `*`"),
        ("sin()", "column 1: `sin` takes 1 argument, not 0\nhelp: write `sin(x)`"),
        ("min(1)", "column 1: `min` takes at least 2 arguments, not 1\nhelp: write `min(a, b, ...)`"),
        ("min(1, 2", "column 4: `(` is never closed"),
        ("min(1 2)", "column 7: missing operator before `2`\nhelp: a product is written `a*b`"),
        ("max(1,)", "column 7: a value is missing before `)`"),
        ("2*(x + 1", "column 3: `(` is never closed"),
        ("x)", "column 2: `)` closes nothing"),
        ("2x", "column 1: missing operator between `2` and `x`\nhelp: a product is written `2*x`"),
        ("1e", "column 1: missing operator between `1` and `e`\nhelp: a product is written `1*e`"),
        ("2e-x", "column 1: missing operator between `2` and `e`\nhelp: a product is written `2*e`"),
        ("x y", "column 3: missing operator before `y`\nhelp: a product is written `a*b`"),
        ("1,5", "column 2: `,` outside the arguments of a function\nhelp: decimals are written with a point: `1.5`"),
        ("x(2)", "column 1: `x` is a value, not a function\nhelp: a product is written `x*(...)`"),
        ("x*sin", "column 3: function `sin` without arguments\nhelp: write `sin(x)`"),
        ("omgea*x", "column 1: unknown name `omgea`\nhelp: did you mean `omega`?"),
        ("sqr(x)", "column 1: unknown function `sqr`\nhelp: did you mean `sqrt`?"),
        ("log(x)", "column 1: unknown function `log`\nhelp: `ln` is the natural logarithm, `log10` the decimal one"),
        ("e^x", "column 1: unknown name `e`\nhelp: Euler's number is `exp(1)`, a power of ten `1e3`"),
        ("true", "column 1: unknown name `true`\nhelp: true is 1, false is 0"),
        ("not false", "column 5: unknown name `false`\nhelp: true is 1, false is 0"),
        ("0 < x < 1", "column 7: comparisons do not chain\nhelp: write `a < b and b < c`"),
        ("1 + not x", "column 5: `not` binds weaker than what stands before it\nhelp: write `(not ...)`"),
        ("x**2", "column 2: unexpected `**`\nhelp: a power is written `x^2`"),
        ("2·x", "column 2: unexpected `·`\nhelp: a product is written `*`"),
        ("x = 1", "column 3: unexpected `=`\nhelp: equality is written `==`"),
        ("x # y", "column 3: unexpected `#`"),
        ("1e999", "column 1: number `1e999` is too large\nhelp: the largest is 1.79e308"),
        ("1.2.3", "column 1: `1.2.` is not a number"),
        ("x + .", "column 5: `.` is not a number"),
    ] {
        assert_eq!(refusal(text).to_string(), expected, "{text}");
    }
}

#[test]
fn names_up_to_a_third_of_the_letters_apart_are_offered() {
    let help = |name: &str, known: &str| Expression::parse(name, &[known]).expect_err(name).help;
    assert_eq!(help("stifnes", "stiffness").as_deref(), Some("did you mean `stiffness`?"));
    assert_eq!(help("torxxe", "torque").as_deref(), Some("did you mean `torque`?"));
    assert_eq!(help("toxxxe", "torque"), None);
    // the longest names that are compared have 64 letters
    let name = |n: usize, last: &str| format!("{}{last}", "a".repeat(n - 1));
    assert!(help(&name(64, "b"), &name(64, "c")).is_some());
    assert!(help(&name(65, "b"), &name(65, "c")).is_none());
}

#[test]
fn symbols_of_other_notations_are_explained() {
    for (symbol, help) in [
        ("**", "a power is written `x^2`"),
        ("²", "a power is written `x^2`"),
        ("&&", "write `and`"),
        ("&", "write `and`"),
        ("||", "write `or`"),
        ("|", "write `or`"),
        ("!", "write `not`, or `!=` for unequal"),
        ("=", "equality is written `==`"),
        ("≤", "write `<=`"),
        ("≥", "write `>=`"),
        ("≠", "write `!=`"),
        ("×", "a product is written `*`"),
        ("−", "minus is written `-`"),
        ("–", "minus is written `-`"),
        ("÷", "a quotient is written `/`"),
        ("√", "write `sqrt(x)`"),
        ("[", "only round brackets group"),
        ("}", "only round brackets group"),
        ("%", "a remainder is written `mod(x, modulus)`"),
        (";", "arguments are separated by `,`, decimals by `.`"),
    ] {
        let error = refusal(&format!("x {symbol} y"));
        assert_eq!((error.message, error.help.as_deref()), (format!("unexpected `{symbol}`"), Some(help)));
        assert_eq!((error.column, error.span), (3, 2..2 + symbol.len()), "{symbol}");
    }
    assert_eq!(refusal("x # y").help, None);
}

#[test]
fn columns_count_characters_and_spans_bytes() {
    let error = Expression::parse("θ + ψ", &["θ"]).expect_err("one name is unknown");
    assert_eq!((error.column, error.span), (5, 5..7));
    for (text, span) in [("x + 20omega*y", 4..11), ("x + 1.2.3", 4..8), ("x + 1e999", 4..9), ("2*min(1)", 2..8)] {
        assert_eq!(refusal(text).span, span, "{text}");
    }
}

#[test]
fn powers_with_small_whole_exponents_are_products() {
    let formula = |text: &str| Expression::parse(text, &["x"]).expect("it is a formula");
    let power = |text: &str, x: f64| formula(text).eval(&[x], &mut Vec::new());
    for k in 1..200 {
        let x = 0.37 * f64::from(k);
        assert_eq!(power("x^3", x), x * (x * x));
        assert_eq!(power("x^-2", -x), 1.0 / (x * x));
        assert_eq!(power("x^5", x), x * ((x * x) * (x * x)));
    }
    // the derivative of a power of zero is a number
    let slope = formula("x^2").eval(&[sincro_math::Dual::<1>::variable(0.0, 0)], &mut Vec::new());
    assert_eq!(slope.partials, [0.0]);
}

#[test]
fn depth_and_length_are_bounded() {
    let nested = |n: usize| format!("{}x{}", "(".repeat(n), ")".repeat(n));
    assert_eq!(value(&nested(MAX_DEPTH)), 3.0);
    for text in
        [nested(MAX_DEPTH + 1), "(".repeat(60_000), "-".repeat(60_000), "not ".repeat(10_000), "2^".repeat(30_000)]
    {
        assert_eq!(refusal(&text).message, "the formula is nested more than 100 levels deep");
    }
    let long = nested(1_000_000);
    assert_eq!(refusal(&long).message, "the formula is 2000001 bytes long, more than 65536");
    assert_eq!(value(&format!("x{}", "+x".repeat(MAX_LENGTH / 2 - 1))), 3.0 * 32768.0);
}

#[test]
fn scratch_memory_does_not_grow() {
    let text = format!("{}x{}", "min(1, 2, x*(y + ".repeat(40), "))".repeat(40));
    let formula = Expression::parse(&text, &NAMES).expect("it is a formula");
    let mut stack = formula.scratch();
    let capacity = stack.capacity();
    formula.eval(&VALUES, &mut stack);
    assert_eq!((stack.capacity(), capacity), (formula.stack_depth(), formula.stack_depth()));
}

#[test]
fn scratch_memory_is_as_deep_as_the_operands_that_wait() {
    for (text, depth) in [("x", 1), ("-x", 1), ("x + y", 2), ("(x + y)*x", 2), ("x + y*x", 3), ("min(x, y, x) + y", 3)]
    {
        assert_eq!(Expression::parse(text, &NAMES).map(|formula| formula.stack_depth()), Ok(depth), "{text}");
    }
}

#[test]
fn constants_are_computed_beforehand() {
    assert_eq!(Expression::parse("2^3 + min(1, 2)*sin(0)", &[]).map(|f| f.constant()), Ok(Some(8.0)));
    assert_eq!(Expression::parse("0*x", &NAMES).map(|f| f.constant()), Ok(None));
}

#[test]
fn the_callers_names_win() {
    let formula = Expression::parse("pi + min(min, 5)", &["pi", "min"]).expect("it is a formula");
    assert_eq!(formula.eval(&[1.0, 2.0], &mut formula.scratch()), 3.0);
    assert!(formula.uses(0) && formula.uses(1) && !formula.uses(2));
}

#[test]
fn free_names_are_listed_once_in_order() {
    let names = Expression::names_in("q' * sin(q) + k*(q - u1)^2*pi + if(q > arm.limit, 1, 0)");
    assert_eq!(names.expect("it is a formula"), ["q'", "q", "k", "u1", "arm.limit"]);
    assert!(Expression::names_in("q' +").is_err());
}

#[test]
fn a_name_is_what_a_formula_can_refer_to() {
    for name in ["x", "_x", "x0", "arm.q1''", "θ", "sin", "knot"] {
        assert!(is_name(name), "{name}");
    }
    for text in ["", "2x", "'", "a-b", "a b", "a.", "a.2", "x'y", "and", "or", "not"] {
        assert!(!is_name(text), "{text}");
    }
}

#[test]
fn a_formula_prints_as_it_was_written() {
    assert_eq!(Expression::parse(" x+ 1 ", &NAMES).expect("it is a formula").to_string(), " x+ 1 ");
}

#[test]
fn a_stack_of_fixed_length_gives_the_same_bits() {
    let names = ["x", "y"];
    for text in ["x", "-x", "x - y", "x - (y - 3*x)", "max(x, y)^2 + 1/(x - 2*y)", "if(x > y, sin(x), y*y - x)"] {
        let formula = Expression::parse(text, &names).unwrap_or_else(|e| panic!("{text}: {e}"));
        for values in [[0.7, -1.3], [-2.0, 5.5]] {
            let mut stack = vec![f64::NAN; formula.stack_depth()];
            let (fixed, growing) =
                (formula.eval_in(&values, &mut stack), formula.eval(&values, &mut formula.scratch()));
            assert_eq!(fixed.to_bits(), growing.to_bits(), "{text} at {values:?}");
        }
    }
}
