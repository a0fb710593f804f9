//! Programs of recorded algorithms against the algorithms themselves.

use proptest::prelude::*;
use sincro_math::record::{Program, Recorded, record, sin_cos_of_operations};
use sincro_math::{Dual, Real, elementary};

/// Every operation of a number once, with operations that fold.
fn everything<R: Real>(x: R, y: R) -> Vec<R> {
    let (s, c) = x.sin_cos();
    let folded = R::one() * x + R::zero() - (-y) + (-x) * y - R::splat(-1.0) * (-y) * (-x);
    let mut changed = x;
    changed += y;
    changed *= s;
    changed -= c;
    let selected = x.if_less(y, s * y, c / (R::splat(2.0) + y * y));
    vec![
        folded,
        selected,
        changed,
        (x * x + y.abs()).sqrt(),
        x.clamp_abs(R::one()).max(y),
        (x - y) / (R::one() + s * s),
    ]
}

fn recorded() -> Program {
    record(2, 1, |x| everything(x[0], x[1])).unwrap()
}

proptest! {
    #[test]
    fn a_program_has_the_bits_of_its_algorithm(x in -1e4..1e4, y in -10.0..10.0) {
        let of = |list: Vec<f64>| list.iter().map(|x| x.to_bits()).collect::<Vec<_>>();
        prop_assert_eq!(of(recorded().evaluate(&[x, y], 0)), of(everything(x, y)));
    }

    #[test]
    fn partial_derivatives_are_those_of_dual_numbers(x in -10.0..10.0, y in -10.0..10.0) {
        let with_partials = recorded().with_partials(0..2).unwrap().evaluate(&[x, y], 0);
        let n = recorded().outputs().len();
        let duals = everything(Dual::<2>::variable(x, 0), Dual::<2>::variable(y, 1));
        for (k, dual) in duals.iter().enumerate() {
            prop_assert_eq!(with_partials[k], dual.value);
            for j in 0..2 {
                let (ours, theirs) = (with_partials[n * (1 + j) + k], dual.partials[j]);
                prop_assert!((ours - theirs).abs() <= 1e-13 * (1.0 + theirs.abs()), "{k} by {j}: {ours} {theirs}");
            }
        }
    }

    #[test]
    fn the_operations_of_the_sine_are_the_sine(x in -9e5..9e5) {
        let program = record(1, 1, |x| {
            let (s, c) = sin_cos_of_operations(x[0]);
            vec![s, c]
        });
        let (s, c) = elementary::sin_cos(x);
        prop_assert_eq!(program.unwrap().evaluate(&[x], 0), vec![s, c]);
    }
}

#[test]
fn numbers_that_differ_among_lanes_are_parameters() {
    let mass = [1.0, 2.0, 3.0];
    let program = record(1, 3, |x| {
        let of_lanes = Recorded::from_lanes(|k| mass[k]);
        let same = Recorded::from_lanes(|_| 0.5);
        vec![of_lanes * same * x[0], Recorded::from_lanes(|k| mass[k])]
    });
    let program = program.unwrap();
    assert_eq!(program.parameters(), [mass.to_vec()]);
    for (k, mass) in mass.iter().enumerate() {
        assert_eq!(program.evaluate(&[4.0], k), [mass * 2.0, *mass]);
    }
    assert_eq!(program.evaluate(&[4.0], 9), [6.0, 3.0], "lanes beyond the last are the last");
}

#[test]
fn branches_and_unknown_functions_are_refused() {
    let reason = |algorithm: fn(Recorded) -> Recorded| record(1, 1, |x| vec![algorithm(x[0])]).unwrap_err().to_string();
    assert_eq!(reason(|x| if x.is_finite() { x } else { -x }), "it branches on a computed number");
    assert_eq!(reason(|x| if x == Recorded::one() { x } else { -x }), "it compares computed numbers");
    assert!(reason(|x| x.map(elementary::exp)).starts_with("it calls a function"));
    // the next recording of the thread is a fresh one, after a panic too
    assert_eq!(record(1, 1, |x| vec![x[0]]).unwrap().evaluate(&[2.0], 0), [2.0]);
    assert!(std::panic::catch_unwind(|| record(1, 1, |_| panic!("an algorithm that panics"))).is_err());
    assert_eq!(record(1, 1, |x| vec![x[0]]).unwrap().evaluate(&[2.0], 0), [2.0]);
}

#[test]
fn what_no_output_needs_is_left_out() {
    let program = record(2, 1, |x| {
        let _unused = x[0].sqrt() / x[1];
        vec![x[0] + x[1], x[1] + x[0]]
    });
    let program = program.unwrap();
    assert_eq!((program.n_computed(), program.operations().len()), (1, 3));
    assert_eq!(program.outputs()[0], program.outputs()[1]);
}

#[test]
fn constants_are_known_while_recording() {
    let program = record(1, 1, |x| {
        let two = Recorded::splat(2.0);
        assert!(
            two != Recorded::one() && two.lane(0) == 2.0 && two == Recorded::one() + Recorded::one() && x[0] == x[0]
        );
        let branch = if two.lane(0) > 1.0 { x[0] } else { -x[0] };
        vec![branch * two.map(elementary::exp), two.map2(two, elementary::pow)]
    });
    assert_eq!(program.unwrap().evaluate(&[3.0], 0), [3.0 * elementary::exp(2.0).0, 4.0]);
}

#[test]
fn exact_simplifications_leave_operations_out() {
    let n_computed = |algorithm: fn(Recorded, Recorded) -> Recorded| {
        let program = record(2, 1, |x| vec![algorithm(x[0], x[1])]).unwrap();
        assert_eq!(program.n_inputs(), 2);
        program.n_computed()
    };
    let number = Recorded::splat;
    let to_nothing: [fn(Recorded, Recorded) -> Recorded; 12] = [
        |x, _| x + Recorded::zero(),
        |x, _| Recorded::zero() + x,
        |x, _| x - Recorded::zero(),
        |x, _| x * Recorded::zero(),
        |x, _| Recorded::zero() * x,
        |x, _| x * Recorded::one(),
        |x, _| Recorded::one() * x,
        |x, _| x / Recorded::one(),
        |x, _| -(-x),
        |x, y| x.if_less(y, y, y),
        |x, y| Recorded::splat(1.0).if_less(Recorded::splat(2.0), x, y),
        |_, _| Recorded::splat(2.0) * Recorded::splat(3.0) + Recorded::splat(1.0),
    ];
    for (k, algorithm) in to_nothing.into_iter().enumerate() {
        assert_eq!(n_computed(algorithm), 0, "{k}");
    }
    let to_one: [fn(Recorded, Recorded) -> Recorded; 8] = [
        |x, y| x + (-y),
        |x, y| (-x) + y,
        |x, y| x - (-y),
        |x, y| (-x) * (-y),
        |x, _| Recorded::splat(-1.0) * x,
        |x, _| x * Recorded::splat(-1.0),
        |x, y| x * y,
        |x, y| x - y,
    ];
    for (k, algorithm) in to_one.into_iter().enumerate() {
        assert_eq!(n_computed(algorithm), 1, "{k}");
    }
    let opposite = record(1, 1, |x| vec![Recorded::splat(-1.0) * x[0], x[0] * Recorded::splat(-1.0), -x[0]]).unwrap();
    assert_eq!(opposite.n_computed(), 1, "{:?}", opposite.operations());
    assert_eq!(n_computed(|x, y| (-x) * y), 2);
    assert_eq!(n_computed(|x, y| (x + y) * (y + x) + x * y - y * x), 5);
    // which branch a constant condition takes
    let chosen = |a: f64, b: f64| {
        record(2, 1, |x| vec![number(a).if_less(number(b), x[0], x[1])]).unwrap().evaluate(&[5.0, 7.0], 0)[0]
    };
    assert_eq!([chosen(1.0, 2.0), chosen(2.0, 1.0), chosen(1.0, 1.0)], [5.0, 7.0, 7.0]);
}

#[test]
fn opposites_have_opposite_derivatives() {
    let program = record(1, 1, |x| vec![-(x[0] * x[0]), x[0].abs()]).unwrap();
    assert_eq!(program.with_partials(0..1).unwrap().evaluate(&[-3.0], 0), [-9.0, 3.0, 6.0, -1.0]);
}
