//! Programs compiled in memory, against the programs themselves.
#![cfg(feature = "jit")]

use sincro_compile::jit;
use sincro_math::Real;
use sincro_math::elementary::{Binary, Unary};
use sincro_math::record::{Program, Recorded, record};

/// The only program compiled.
fn compiled(program: &Program) -> jit::JittedProgram {
    jit::compile(&[program]).unwrap().programs.remove(0)
}

fn bits(x: &[f64]) -> Vec<u64> {
    x.iter().map(|x| x.to_bits()).collect()
}

#[test]
fn every_operation_has_the_bits_of_the_program() {
    let program = record(3, 1, |x| {
        let (sine, cosine) = (x[0] - x[1]).sin_cos();
        let all = [x[0] + x[1], x[0] - x[1], x[0] * x[1], x[0] / x[1], -x[0], x[0].abs().sqrt(), sine, cosine];
        let inner = sine.sin_cos().1.if_less(x[2], cosine, x[0].abs());
        let numbers = [inner, Recorded::splat(-0.0), Recorded::splat(1e-310), x[1]];
        all.into_iter().chain(numbers).collect()
    });
    let program = program.unwrap();
    let jitted = compiled(&program);
    let mut outputs = vec![0.0; program.outputs().len()];
    for k in 0..200_u32 {
        let inputs = [0.37 * f64::from(k) - 30.0, 1.0 - 0.013 * f64::from(k), 0.01 * f64::from(k) - 1.0];
        assert!(jitted.evaluate(&inputs, &mut outputs));
        assert_eq!(bits(&outputs), bits(&program.evaluate(&inputs, 0)), "{inputs:?}");
    }
}

#[test]
fn functions_have_the_bits_of_their_scalars() {
    let program = record(2, 1, |x| {
        let unary = Unary::ALL.iter().map(|f| x[0].unary(*f));
        unary.chain(Binary::ALL.iter().map(|f| x[0].binary(*f, x[1]))).collect()
    });
    let program = program.unwrap();
    let jitted = compiled(&program);
    let mut outputs = vec![0.0; program.outputs().len()];
    let mut n_known = 0;
    for k in 0..40_u32 {
        let inputs = [0.021 * f64::from(k) + 0.1, 0.03 * f64::from(k) - 0.6];
        if jitted.evaluate(&inputs, &mut outputs) {
            n_known += 1;
            assert_eq!(bits(&outputs), bits(&program.evaluate(&inputs, 0)), "{inputs:?}");
        }
    }
    assert!(n_known > 20);
}

#[test]
fn angles_of_any_size_have_the_bits_of_the_program() {
    let program = record(2, 1, |x| vec![x[0].sin_cos().0, (x[0] * x[1]).sin_cos().1]).unwrap();
    let jitted = compiled(&program);
    let mut outputs = [0.0; 2];
    for inputs in [[1e7, 3.0], [-0.0, 2.0], [1e99, 1e-3], [5e-324, 1e12]] {
        assert!(jitted.evaluate(&inputs, &mut outputs));
        assert_eq!(bits(&outputs), bits(&program.evaluate(&inputs, 0)), "{inputs:?}");
    }
}

#[test]
fn numbers_that_no_program_keeps_the_bits_of_are_refused() {
    let program = record(2, 1, |x| vec![x[0] / x[1], x[0].binary(Binary::Atan2, x[1])]).unwrap();
    let jitted = compiled(&program);
    let mut outputs = [0.0; 2];
    for inputs in [[1e100, 1.0], [f64::NAN, 1.0], [1.0, -f64::INFINITY], [1.0, 0.0]] {
        assert!(!jitted.evaluate(&inputs, &mut outputs), "{inputs:?}");
    }
    // π or −π, by the sign of the first zero
    assert!(!jitted.evaluate(&[0.0, -1.0], &mut outputs));
    assert!(jitted.evaluate(&[0.0, 1.0], &mut outputs));
}

#[test]
fn parameters_are_those_of_the_first_world() {
    let masses = [3.0, 5.0];
    let program = record(1, 2, |x| vec![x[0] / Recorded::from_lanes(|lane| masses[lane])]).unwrap();
    let mut outputs = [0.0];
    assert!(compiled(&program).evaluate(&[6.0], &mut outputs));
    assert_eq!(outputs, [2.0]);
}

/// A chain of operations, each set of angles dependent on the one before.
fn long(n: usize) -> Program {
    let program = record(4, 1, |x| {
        let mut x = x.to_vec();
        for k in 0..n {
            let (sine, cosine) = (x[k % 4] * x[(k + 1) % 4]).sin_cos();
            let next = if k % 50 == 0 { sine * cosine } else { x[k % 4] * Recorded::splat(0.4) };
            x[k % 4] = next - x[(k + 1) % 4] * Recorded::splat(0.3 + 1e-6 * k as f64);
        }
        x
    });
    program.unwrap()
}

#[test]
fn long_programs_have_the_bits_of_their_evaluation() {
    for n in [10, 1_000, 10_000] {
        let program = long(n);
        let jitted = compiled(&program);
        let mut outputs = [0.0; 4];
        for k in 0..5 {
            let inputs = [0.1, -0.2, 0.7, 0.3].map(|x| x + 0.01 * f64::from(k));
            assert!(jitted.evaluate(&inputs, &mut outputs));
            assert_eq!(bits(&outputs), bits(&program.evaluate(&inputs, 0)), "{n} operations at {inputs:?}");
        }
    }
}

#[test]
fn programs_that_are_compiled_together_do_not_mix() {
    let programs = [1.0, 2.0].map(|c| record(1, 1, |x| vec![x[0] + Recorded::splat(c)]).unwrap());
    let jitted = jit::compile(&[&programs[0], &programs[1]]).unwrap();
    let of = |k: usize| {
        let mut outputs = [0.0];
        assert!(jitted.programs[k].evaluate(&[0.5], &mut outputs));
        outputs[0]
    };
    assert_eq!([of(0), of(1)], [1.5, 2.5]);
}
