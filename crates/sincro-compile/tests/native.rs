//! Programs for lanes that call elementary functions, against the functions themselves.

use sincro_compile::native::{self, OutputForm};
use sincro_math::Real;
use sincro_math::elementary::{Binary, Unary};
use sincro_math::record::{Program, Recorded, record};

/// Values of all elementary functions at small numbers.
fn all_functions(x: &[Recorded]) -> Vec<Recorded> {
    let unary = Unary::ALL.iter().map(|f| x[0].unary(*f));
    unary.chain(Binary::ALL.iter().map(|f| x[0].binary(*f, x[1]))).collect()
}

/// The program compiled; none without a compiler or lanes.
fn compiled(program: &Program, form: OutputForm) -> Option<native::NativeProgram> {
    native::compile_in_form(&[(program, form)]).ok().map(|mut native| native.programs.remove(0))
}

#[test]
fn functions_have_the_bits_of_their_scalars() {
    let program = record(2, 1, all_functions).unwrap();
    let Some(native) = compiled(&program, OutputForm::default()) else { return };
    let width = native.width();
    let inputs: Vec<f64> = (0..2 * width).map(|k| 0.17 * (k as f64 + 0.5) - 0.6).collect();
    let mut outputs = vec![0.0; program.outputs().len() * width];
    assert!(native.evaluate(&inputs, &[], &mut outputs));
    for lane in 0..width {
        let (x, y) = (inputs[lane], inputs[width + lane]);
        let expected = Unary::ALL.iter().map(|f| x.unary(*f)).chain(Binary::ALL.iter().map(|f| x.binary(*f, y)));
        for (k, expected) in expected.enumerate() {
            let found = outputs[k * width + lane];
            assert!(found.to_bits() == expected.to_bits() || found.is_nan() && expected.is_nan(), "{k} at {x}, {y}");
        }
    }
}

#[test]
fn the_sign_of_a_zero_decides_nothing() {
    let program = record(2, 1, |x| vec![x[0].binary(Binary::Atan2, x[1])]).unwrap();
    let Some(native) = compiled(&program, OutputForm::default()) else { return };
    let width = native.width();
    // π or −π, by the sign of the first zero
    let mut inputs = [vec![1.0; width], vec![-1.0; width]].concat();
    let mut outputs = vec![0.0; width];
    assert!(native.evaluate(&inputs, &[], &mut outputs));
    inputs[1] = -0.0;
    assert!(!native.evaluate(&inputs, &[], &mut outputs));
    inputs[width + 1] = 1.0;
    assert!(native.evaluate(&inputs, &[], &mut outputs));
}

#[test]
fn results_and_flags_have_places_of_their_own() {
    let program = record(1, 1, |x| {
        let (zero, one) = (Recorded::zero(), Recorded::one());
        vec![x[0] + one, x[0] * x[0], x[0].if_less(zero, one, zero)]
    });
    let form = OutputForm { n_results: 1, n_flags: 1, inputs_are_checked: false };
    let Some(native) = compiled(&program.unwrap(), form) else { return };
    let width = native.width();
    let inputs: Vec<f64> = (0..width).map(|k| k as f64 - 1.5).collect();
    let [mut outputs, mut results] = [vec![0.0; width], vec![0.0; width]];
    assert_eq!(native.evaluate_in_form(&inputs, &[], &mut outputs, &mut results), Some(0b11));
    assert!((0..width).all(|k| outputs[k] == inputs[k] + 1.0 && results[k] == inputs[k] * inputs[k]));
}
