//! Blocks of maths against their closed forms.

use std::collections::BTreeMap;

use sincro_blocks::block::Block;
use sincro_blocks::compile::{Interface, compile};
use sincro_blocks::diagram::Diagram;
use sincro_blocks::instance::DynBlock;
use sincro_blocks::kind::Described;
use sincro_blocks::library::maths::{
    Abs, Cross, Divide, Dot, Expression, Function, MatrixGain, Max, Min, Norm, Polynomial, Power, Product, Sign, Sqrt,
    Trigonometric, Trigonometry, Unary,
};
use sincro_blocks::library::sources::{Clock, Constant};
use sincro_blocks::reader::{NoFiles, Reader, Value};
use sincro_blocks::runner::Runner;
use sincro_blocks::simulator::Simulator;
use sincro_math::{Dual, elementary};

/// A block with constants at its inputs.
fn fed(block: impl DynBlock + 'static, inputs: &[&[f64]]) -> Diagram {
    let ports = DynBlock::ports(&block).inputs;
    let mut d = Diagram::new();
    d.block("block", block);
    for (k, (port, value)) in ports.iter().zip(inputs).enumerate() {
        let name = format!("input-{k}");
        d.block(&name, Constant { value: value.to_vec() }).wire(&name, &format!("block.{port}"));
    }
    d
}

fn value(block: impl DynBlock + 'static, inputs: &[&[f64]]) -> Vec<f64> {
    Simulator::new(&fed(block, inputs), 0.1).unwrap().output("block").to_vec()
}

fn refusal(block: impl DynBlock + 'static, inputs: &[&[f64]]) -> String {
    compile(&fed(block, inputs), &Interface::new(0.1)).unwrap_err()[0].message.clone()
}

/// An expression from parameters, with the diagram's parameter k = 3, and the faults.
fn read_expression(given: &[(&str, Value)]) -> (Expression, Vec<String>) {
    let given: BTreeMap<String, Value> = given.iter().map(|(key, value)| ((*key).to_owned(), value.clone())).collect();
    let scope = BTreeMap::from([("k".to_owned(), 3.0)]);
    let mut reader = Reader::new(Expression::KIND, &given, &scope, &NoFiles);
    let block = Expression::read(&mut reader);
    (block, reader.finish().into_iter().map(|fault| fault.message).collect())
}

#[test]
fn vectors_multiply_as_in_the_book() {
    let (a, b): (&[f64], &[f64]) = (&[1.0, 2.0, 3.0], &[4.0, -5.0, 6.0]);
    assert_eq!(value(Dot, &[a, b]), [12.0]);
    assert_eq!(value(Cross, &[a, b]), [27.0, 6.0, -13.0]);
    assert_eq!(value(Product::new(2), &[a, b]), [4.0, -10.0, 18.0]);
    assert_eq!(value(Product::new(1), &[b]), [-120.0]);
    assert_eq!(value(Product::new(3), &[a, b, &[2.0]]), [8.0, -20.0, 36.0]);
    assert_eq!(value(Divide, &[b, a]), [4.0, -2.5, 2.0]);
    assert_eq!(value(Norm, &[&[2.0, -3.0, 6.0]]), [7.0]);
}

#[test]
fn a_cross_product_is_square_to_both_factors() {
    let mut d = fed(Cross, &[&[0.3, -1.2, 2.5], &[1.1, 0.7, -0.4]]);
    d.block("first", Dot).wire("block", "first.u1").wire("input-0", "first.u2");
    d.block("second", Dot).wire("block", "second.u1").wire("input-1", "second.u2");
    let simulator = Simulator::new(&d, 0.1).unwrap();
    // roundings of products below 4
    assert!(simulator.output("first")[0].abs() < 4e-15 && simulator.output("second")[0].abs() < 4e-15);
}

#[test]
fn a_matrix_makes_a_vector_of_its_height() {
    let gain = MatrixGain::new(&[&[1.0, 2.0, 3.0], &[0.0, -1.0, 4.0]]);
    assert_eq!(value(gain.clone(), &[&[1.0, 1.0, 2.0]]), [9.0, 7.0]);
    assert!(refusal(gain, &[&[1.0, 1.0]]).contains("the matrix has 3 columns, the input 2 components"));
}

#[test]
fn extrema_are_over_inputs_or_over_the_components_of_one() {
    assert_eq!(value(Min::new(2), &[&[1.0, 5.0], &[3.0, 2.0]]), [1.0, 2.0]);
    assert_eq!(value(Max::new(3), &[&[1.0, 5.0], &[3.0], &[2.0, 9.0]]), [3.0, 9.0]);
    assert_eq!(value(Min::new(1), &[&[4.0, -1.0, 2.0]]), [-1.0]);
    assert_eq!(value(Max::new(1), &[&[4.0, -1.0, 2.0]]), [4.0]);
}

#[test]
fn what_is_not_a_number_is_never_hidden() {
    let nan: &[f64] = &[f64::NAN];
    let one: &[f64] = &[1.0];
    let all_nan = |found: Vec<f64>| assert!(found.iter().all(|x| x.is_nan()), "{found:?}");
    for inputs in [[nan, one], [one, nan]] {
        all_nan(value(Min::new(2), &inputs));
        all_nan(value(Max::new(2), &inputs));
        all_nan(value(Product::new(2), &inputs));
    }
    all_nan(value(Max::new(1), &[&[0.0, f64::NAN, 3.0]]));
    all_nan(value(Min::new(1), &[&[f64::NAN, 3.0]]));
    all_nan(value(Sign, &[nan]));
    all_nan(value(Abs, &[nan]));
    all_nan(value(Norm, &[nan]));
    all_nan(value(Polynomial::new(&[2.0]), &[nan]));
    all_nan(value(Function::new(Unary::Round), &[nan]));
}

#[test]
fn a_division_by_zero_names_its_block() {
    let simulator = Simulator::new(&fed(Divide, &[&[1.0, 1.0], &[2.0, 0.0]]), 0.1).unwrap();
    let (step, component) = simulator.runner.not_finite().unwrap();
    assert_eq!((step.path.as_str(), component), ("block", 1));
}

#[test]
fn elementary_functions_are_those_of_every_other_part() {
    let x = 0.6;
    let at = |function| value(Trigonometry::new(function), &[&[x]])[0];
    assert_eq!((at(Trigonometric::Sin), at(Trigonometric::Cos)), elementary::sin_cos(x));
    assert_eq!(at(Trigonometric::Asin), elementary::asin(x).0);
    assert_eq!(at(Trigonometric::Acos), elementary::acos(x).0);
    assert_eq!(at(Trigonometric::Tan), elementary::tan(x).0);
    assert_eq!(at(Trigonometric::Atan), elementary::atan(x).0);
    let quadrants = value(Trigonometry::new(Trigonometric::Atan2), &[&[1.0, 1.0], &[1.0, -1.0]]);
    assert_eq!(quadrants, [std::f64::consts::FRAC_PI_4, 3.0 * std::f64::consts::FRAC_PI_4]);
    assert_eq!(value(Function::new(Unary::Ln), &[&[x]]), [elementary::ln(x).0]);
    assert_eq!(value(Function::new(Unary::Exp), &[&[x]]), [elementary::exp(x).0]);
    assert_eq!(value(Function::new(Unary::Reciprocal), &[&[4.0]]), [0.25]);
    assert_eq!(value(Function::new(Unary::Round), &[&[2.5, -0.4, -2.6]]), [3.0, 0.0, -3.0]);
    assert_eq!(value(Function::new(Unary::Floor), &[&[2.5, -0.4]]), [2.0, -1.0]);
    assert_eq!(value(Function::new(Unary::Ceil), &[&[2.5, -0.4]]), [3.0, 0.0]);
    assert_eq!(value(Sqrt, &[&[9.0]]), [3.0]);
    assert_eq!(value(Abs, &[&[-2.0, 3.0]]), [2.0, 3.0]);
    assert_eq!(value(Sign, &[&[-2.0, 0.0, 3.0]]), [-1.0, 0.0, 1.0]);
}

#[test]
fn powers_take_the_exponent_from_a_parameter_or_an_input() {
    assert_eq!(value(Power::new(3.0), &[&[2.0, -2.0]]), [8.0, -8.0]);
    assert_eq!(value(Power { exponent: None }, &[&[2.0], &[3.0, -1.0]]), [8.0, 0.5]);
    assert!(value(Power::new(0.5), &[&[-1.0]])[0].is_nan());
}

#[test]
fn a_polynomial_begins_with_its_highest_power() {
    assert_eq!(value(Polynomial::new(&[2.0, -3.0, 1.0]), &[&[0.0, 1.0, 3.0]]), [1.0, 0.0, 10.0]);
}

/// The derivative of a block's first output by the first component of its first input.
fn derivative(block: &(impl DynBlock + Clone + 'static), inputs: &[&[f64]]) -> f64 {
    let mut d = fed(block.clone(), inputs);
    // a block of constants is evaluated once; one with a sample time again, after the input has got its derivative
    d.entries[0].sample_time = Some(0.1);
    let mut runner = Runner::<Dual<1>>::new(compile(&d, &Interface::new(0.1)).unwrap().into());
    let start = |name: &str| runner.program().outputs().find(|(known, ..)| known == name).unwrap().1.start;
    let (input, output) = (start("input-0"), start("block"));
    runner.signals_mut()[input].partials[0] = 1.0;
    runner.evaluate(0, 0.0);
    runner.signals()[output].partials[0]
}

/// Compares with the central difference: its error is h²f‴/6 and 1e-16 f/h, below 1e-8 for what is tested here.
fn check_derivative(block: impl DynBlock + Clone + 'static, inputs: &[&[f64]]) {
    let h = 1e-5;
    let moved = |dx: f64| {
        let first: Vec<f64> = inputs[0].iter().enumerate().map(|(i, x)| if i == 0 { x + dx } else { *x }).collect();
        let all: Vec<&[f64]> = std::iter::once(&first[..]).chain(inputs[1..].iter().copied()).collect();
        value(block.clone(), &all)[0]
    };
    let (found, expected) = (derivative(&block, inputs), (moved(h) - moved(-h)) / (2.0 * h));
    assert!((found - expected).abs() < 1e-8, "{block:?}: {found} {expected}");
}

#[test]
fn smooth_blocks_carry_their_derivatives() {
    let (u, v): (&[f64], &[f64]) = (&[0.6, -0.3, 1.2], &[1.7, 0.4, -0.9]);
    use Trigonometric::{Acos, Asin, Atan, Atan2, Cos, Sin, Tan};
    for function in [Sin, Cos, Tan, Asin, Acos, Atan] {
        check_derivative(Trigonometry::new(function), &[&u[..1]]);
    }
    check_derivative(Trigonometry::new(Atan2), &[u, v]);
    use Unary::{Cosh, Exp, Ln, Log10, Reciprocal, Sinh, Square, Tanh};
    for function in [Exp, Ln, Log10, Sinh, Cosh, Tanh, Square, Reciprocal] {
        check_derivative(Function::new(function), &[&u[..1]]);
    }
    check_derivative(Norm, &[u]);
    check_derivative(Dot, &[u, v]);
    check_derivative(Product::new(2), &[u, v]);
    check_derivative(Product::new(1), &[u]);
    check_derivative(Divide, &[u, v]);
    check_derivative(Sqrt, &[&u[..1]]);
    check_derivative(Abs, &[u]);
    check_derivative(Abs, &[&[-0.6]]);
    check_derivative(Min::new(2), &[u, v]);
    check_derivative(Max::new(2), &[u, v]);
    check_derivative(Power::new(2.5), &[&u[..1]]);
    check_derivative(Power { exponent: None }, &[&u[..1], &v[..1]]);
    check_derivative(Polynomial::new(&[1.0, -2.0, 0.5, 3.0]), &[u]);
    check_derivative(MatrixGain::new(&[&[2.0, 0.0, 1.0]]), &[u]);
    check_derivative(Expression::new("u1^2*sin(u2*u1)"), &[u, v]);
}

#[test]
fn at_a_kink_the_derivative_is_that_of_one_side() {
    // of |u| that from above, also at the negative zero; of the least and the greatest of equals that of the first
    assert_eq!([0.0, -0.0, 1e-300, -1e-300].map(|u| derivative(&Abs, &[&[u]])), [1.0, 1.0, 1.0, -1.0]);
    for equals in [derivative(&Min::new(2), &[&[0.3], &[0.3]]), derivative(&Max::new(2), &[&[0.3], &[0.3]])] {
        assert_eq!(equals, 1.0);
    }
    assert_eq!(derivative(&Min::new(2), &[&[0.4], &[0.3]]), 0.0);
    assert_eq!(derivative(&Max::new(2), &[&[0.2], &[0.3]]), 0.0);
    assert_eq!(derivative(&Sign, &[&[0.2]]), 0.0);
}

#[test]
fn the_length_of_nothing_has_slope_zero() {
    assert_eq!(derivative(&Norm, &[&[0.0, 0.0]]), 0.0);
}

#[test]
fn a_formula_of_vectors_is_computed_component_by_component() {
    let spring = Expression::new("k*(u1 - u2)^2");
    assert_eq!(Block::ports(&spring).inputs, ["k", "u1", "u2"]);
    assert_eq!(value(spring, &[&[2.0], &[1.0, 5.0], &[0.0, 2.0]]), [2.0, 18.0]);
}

#[test]
fn parameters_of_the_diagram_are_no_inputs_of_a_formula() {
    let (spring, faults) = read_expression(&[("expression", "k*(u2 - u1)^2 + t".into())]);
    assert_eq!((Block::ports(&spring).inputs, faults.len()), (vec!["u2".to_owned(), "u1".to_owned()], 0));
    assert_eq!(value(spring, &[&[4.0], &[2.0]]), [12.0]);
    // unless they are declared to be
    let (spring, faults) = read_expression(&[("expression", "k*2".into()), ("inputs", vec!["k"].into())]);
    assert!(faults.is_empty());
    assert_eq!(value(spring, &[&[5.0]]), [10.0]);
}

#[test]
fn several_formulas_make_a_vector_of_scalars() {
    let (planar, faults) = read_expression(&[
        ("expressions", vec!["k*cos(q1)", "k*sin(q1) + q2"].into()),
        ("inputs", vec!["q1", "q2"].into()),
    ]);
    assert!(faults.is_empty(), "{faults:?}");
    assert_eq!(value(planar.clone(), &[&[0.0], &[0.5]]), [3.0, 0.5]);
    let found = refusal(planar, &[&[0.0, 1.0], &[0.5]]);
    assert!(found.contains("every input is a scalar, `q1` has 2 components"), "{found}");
}

#[test]
fn a_formula_of_time_moves_though_its_inputs_do_not() {
    let mut d = fed(Expression::new("u*t"), &[&[2.0]]);
    d.block("clock", Clock);
    let mut simulator = Simulator::new(&d, 0.25).unwrap();
    assert_eq!(simulator.record("block", 4), [0.0, 0.5, 1.0, 1.5, 2.0]);
    d.entries[0].sample_time = Some(0.5);
    assert_eq!(Simulator::new(&d, 0.25).unwrap().record("block", 4), [0.0, 0.0, 1.0, 1.0, 2.0]);
}

#[test]
fn formulas_that_cannot_be_read_are_refused_with_their_names() {
    let first = |given: &[(&str, Value)]| read_expression(given).1.first().cloned().unwrap_or_default();
    assert_eq!(first(&[]), "there is no formula");
    assert_eq!(first(&[("expression", "siin(u)".into())]), "unknown function `siin`");
    assert_eq!(first(&[("expression", "u".into()), ("inputs", vec!["t"].into())]), "`t` is the time in formulas");
    assert_eq!(first(&[("expression", "arm.q + 1".into())]), "`arm.q` cannot be the name of an input");
    assert_eq!(
        first(&[("expression", "1".into()), ("expressions", vec!["2"].into())]),
        "there are two kinds of formulas"
    );
    assert_eq!(first(&[("expressions", Value::List(Vec::new()))]), "there are no formulas");
}
