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
        vec![x[0] + one, x[0] * x[0], -x[0], x[0] * zero, x[0].if_less(zero, one, zero)]
    });
    let form = OutputForm { n_results: [1, 2], n_flags: 1, ..OutputForm::default() };
    let Some(native) = compiled(&program.unwrap(), form) else { return };
    let width = native.width();
    let inputs: Vec<f64> = (0..width).map(|k| k as f64 - 1.5).collect();
    let [mut outputs, mut squares] = [vec![0.0; width], vec![0.0; width]];
    let mut others = vec![0.0; 2 * width];
    let results = [&mut squares[..], &mut others];
    assert_eq!(native.evaluate_in_form(&inputs, &[], &mut outputs, results, 0), Some(0b11));
    assert!((0..width).all(|k| outputs[k] == inputs[k] + 1.0 && squares[k] == inputs[k] * inputs[k]));
    let expected: Vec<[u64; 2]> = inputs.iter().map(|x| [-x, 0.0].map(f64::to_bits)).collect();
    assert_eq!(
        others.iter().map(|x| x.to_bits()).collect::<Vec<_>>(),
        expected.concat(),
        "lane by lane, zeros unsigned"
    );
}

#[test]
fn a_first_flag_refuses_inputs() {
    let program = record(2, 1, |x| {
        let (zero, one) = (Recorded::zero(), Recorded::one());
        vec![x[0] + one, x[0] * x[1], x[0].if_less(zero, one, zero)]
    });
    let form = OutputForm { n_results: [1, 0], n_flags: 1, refuses_by_flag: true, ..OutputForm::default() };
    let Some(native) = compiled(&program.unwrap(), form) else { return };
    let width = native.width();
    let mut rows: Vec<f64> = (0..2 * width).map(|k| if k == 2 { -1.0 } else { k as f64 }).collect();
    let (before, mut products) = (rows.clone(), vec![7.0; width]);
    assert_eq!(native.evaluate_in_form_in_place(&mut rows, &[], [&mut products, &mut []], 0b1011), None);
    assert_eq!((&rows, &products), (&before, &vec![7.0; width]), "nothing is written");
    assert_eq!(native.evaluate_in_form_in_place(&mut rows, &[], [&mut products, &mut []], 0b100), Some(0b100));
    let (first, second) = before.split_at(width);
    assert!((0..width).all(|k| rows[k] == first[k] + 1.0 && products[k] == first[k] * second[k]));
    assert_eq!(&rows[width..], second, "inputs that no output takes the place of stay");
}
