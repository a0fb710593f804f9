//! Closed forms for everything that is derived from the four matrices.

use sincro_math::elementary::{exp, sin_cos};

use super::*;

fn matrix(rows: usize, columns: usize, entries: &[f64]) -> DMatrix<f64> {
    DMatrix::from_row_slice(rows, columns, entries)
}

/// One input, one output, from rows.
fn system(n: usize, a: &[f64], b: &[f64], c: &[f64], d: f64) -> StateSpace {
    StateSpace::from_matrices(matrix(n, n, a), matrix(n, 1, b), matrix(1, n, c), matrix(1, 1, &[d])).unwrap()
}

/// `(c₀ + c₁ s + …) / (a₀ + a₁ s + … + sⁿ) + d` in controller form.
fn transfer(numerator: &[f64], denominator: &[f64], d: f64) -> StateSpace {
    let n = denominator.len();
    let mut a = DMatrix::zeros(n, n);
    for k in 0..n - 1 {
        a[(k, k + 1)] = 1.0;
    }
    for k in 0..n {
        a[(n - 1, k)] = -denominator[k];
    }
    let mut b = DMatrix::zeros(n, 1);
    b[n - 1] = 1.0;
    let mut c = DMatrix::zeros(1, n);
    c.columns_mut(0, numerator.len()).copy_from_slice(numerator);
    StateSpace::from_matrices(a, b, c, matrix(1, 1, &[d])).unwrap()
}

/// The same system in other coordinates: a fixed full transformation.
fn mixed(mut system: StateSpace) -> StateSpace {
    let n = system.n_states();
    let t = DMatrix::from_fn(n, n, |i, j| ((i * 7 + j * 3 + 1) % 5) as f64 - 1.7 + if i == j { 4.0 } else { 0.0 });
    let inverse = t.clone().try_inverse().unwrap();
    system.a = &t * &system.a * &inverse;
    system.b = &t * &system.b;
    system.c = &system.c * inverse;
    system
}

fn assert_near(found: &[Complex<f64>], expected: &[(f64, f64)], tolerance: f64) {
    assert_eq!(found.len(), expected.len(), "{found:?} {expected:?}");
    for (z, (re, im)) in found.iter().zip(expected) {
        assert!((z.re - re).abs() <= tolerance && (z.im - im).abs() <= tolerance, "{found:?} {expected:?}");
    }
}

#[test]
fn an_oscillator_has_its_damping_ratio_and_frequency() {
    // s² + 2 ζ ω s + ω²: ω = 5, ζ = 0.3
    let modes = transfer(&[1.0], &[25.0, 3.0], 0.0).poles();
    assert!((modes[0].natural_frequency - 5.0).abs() < 1e-13 && (modes[0].damping_ratio - 0.3).abs() < 1e-14);
    assert!((modes[0].time_constant - 1.0 / 1.5).abs() < 1e-13);
    assert!(modes[0].pole.im > 0.0 && modes[1].pole.im < 0.0);
}

#[test]
fn poles_are_sorted_from_slow_to_fast_in_any_coordinates() {
    // (s + 1)(s + 20)(s² + 2 s + 26)
    let denominator = [520.0, 586.0, 88.0, 23.0];
    for system in [transfer(&[1.0], &denominator, 0.0), mixed(transfer(&[1.0], &denominator, 0.0))] {
        let poles: Vec<_> = system.poles().iter().map(|mode| mode.pole).collect();
        assert_near(&poles, &[(-1.0, 0.0), (-1.0, 5.0), (-1.0, -5.0), (-20.0, 0.0)], 1e-10);
    }
}

/// Squares of such entries are no numbers, with which the library's iterations did not end.
#[test]
fn huge_and_tiny_matrices_have_eigenvalues() {
    for size in [1e-200, 1e-160, 1e160, 1e200] {
        let matrix = DMatrix::from_row_slice(2, 2, &[0.0, size, -2.0 * size, -3.0 * size]);
        let found: Vec<f64> = modes::eigenvalues(&matrix).iter().map(|z| z.re / size).collect();
        assert!((found[0] + 1.0).abs() < 1e-14 && (found[1] + 2.0).abs() < 1e-14, "{size:e}: {found:?}");
    }
}

#[test]
fn a_cyclic_permutation_does_not_stall_the_eigenvalues() {
    for n in 3..12 {
        let cycle = DMatrix::from_fn(n, n, |i, j| if (i + 1) % n == j { 1.0 } else { 0.0 });
        for z in modes::eigenvalues(&cycle) {
            assert!((modulus(z) - 1.0).abs() < 1e-12, "{n}: {z}");
        }
    }
}

#[test]
fn stability_is_told_from_the_margin() {
    assert_eq!(transfer(&[1.0], &[25.0, 3.0], 0.0).stability(), Stability::Stable);
    assert_eq!(transfer(&[1.0], &[25.0, 0.0], 0.0).stability(), Stability::Marginal);
    assert_eq!(transfer(&[1.0], &[0.0, 0.0], 0.0).stability(), Stability::Marginal);
    assert_eq!(transfer(&[1.0], &[25.0, -1e-3], 0.0).stability(), Stability::Unstable);
    let mut sampled = system(1, &[0.9], &[1.0], &[1.0], 0.0);
    sampled.sample_time = Some(0.01);
    assert!(sampled.is_stable());
    sampled.a[0] = -1.1;
    assert!(!sampled.is_stable());
}

#[test]
fn a_sampled_pole_has_the_rates_of_its_continuous_one() {
    // exp(−3 · 0.01)
    let mut sampled = system(1, &[exp(-0.03).0], &[1.0], &[1.0], 0.0);
    sampled.sample_time = Some(0.01);
    assert!((sampled.poles()[0].time_constant - 1.0 / 3.0).abs() < 1e-13);
    // dead beat: over after one tick
    sampled.a[0] = 0.0;
    let mode = sampled.poles()[0];
    assert_eq!((mode.damping_ratio, mode.time_constant), (1.0, 0.0));
}

#[test]
fn zeros_are_those_of_the_numerator() {
    type Case<'a> = (&'a [f64], f64, &'a [(f64, f64)]);
    let cases: [Case; 6] = [
        // none
        (&[1.0], 0.0, &[]),
        // at zero: s
        (&[0.0, 1.0], 0.0, &[(0.0, 0.0)]),
        // two at zero
        (&[0.0, 0.0, 2.0], 0.0, &[(0.0, 0.0), (0.0, 0.0)]),
        // non-minimum phase: 3 − s
        (&[3.0, -1.0], 0.0, &[(3.0, 0.0)]),
        // a pair: s² + 2 s + 10
        (&[10.0, 2.0, 1.0], 0.0, &[(-1.0, 3.0), (-1.0, -3.0)]),
        // with feedthrough: s³ + 6 s² + 11 s + 6 = (s + 1)(s + 2)(s + 3), less the denominator
        (&[2.0, 7.0, 2.0], 1.0, &[(-1.0, 0.0), (-2.0, 0.0), (-3.0, 0.0)]),
    ];
    for (numerator, d, expected) in cases {
        let plain = transfer(numerator, &[4.0, 4.0, 4.0], d);
        assert_near(&plain.zeros(0, 0).unwrap(), expected, 1e-7);
        // a double zero is known to the root of the rounding
        assert_near(&mixed(plain).zeros(0, 0).unwrap(), expected, 1e-6);
    }
}

#[test]
fn zeros_do_not_depend_on_units() {
    // cart and pendulum, force to position: zeros at ±√(g/l), whatever position and force are measured in
    let (g, l, ratio) = (9.81_f64, 0.5, 0.1);
    let a = [0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, -ratio * g, 0.0, 0.0, 0.0, (1.0 + ratio) * g / l, 0.0, 0.0];
    let expected = (g / l).sqrt();
    for (force, position) in [(1.0, 1.0), (1e6, 1e-3), (1e-9, 1e9)] {
        let cart = system(4, &a, &[0.0, 0.0, force, -force / l], &[position, 0.0, 0.0, 0.0], 0.0);
        assert_near(&cart.zeros(0, 0).unwrap(), &[(-expected, 0.0), (expected, 0.0)], 1e-12);
    }
}

#[test]
fn a_hidden_mode_is_pole_and_zero_and_no_path_is_said() {
    // the second state is not seen
    let hidden = system(2, &[-1.0, 0.0, 0.0, -5.0], &[1.0, 1.0], &[1.0, 0.0], 0.0);
    assert_near(&hidden.zeros(0, 0).unwrap(), &[(-5.0, 0.0)], 1e-14);
    let cut = system(2, &[-1.0, 0.0, 0.0, -5.0], &[0.0, 1.0], &[1.0, 0.0], 0.0);
    assert_eq!(cut.zeros(0, 0).unwrap_err().to_string(), "`y1` does not depend on `u1`");
    // feedthrough alone
    assert_near(&system(1, &[-2.0], &[0.0], &[1.0], 3.0).zeros(0, 0).unwrap(), &[(-2.0, 0.0)], 0.0);
}

#[test]
fn static_gain_is_the_transfer_function_at_zero() {
    assert!((transfer(&[6.0, 1.0], &[3.0, 2.0], 0.5).gain(0, 0).unwrap() - 2.5).abs() < 1e-14);
    assert_eq!(transfer(&[6.0], &[0.0, 2.0], 0.0).gain(0, 0), None);
    // the velocity of a pushed mass with friction settles, though its position does not
    let pushed = system(2, &[0.0, 1.0, 0.0, -2.0], &[0.0, 1.0], &[0.0, 1.0], 0.0);
    assert!((pushed.gain(0, 0).unwrap() - 0.5).abs() < 1e-15);
    assert!(pushed.step_response(0, 0, None).final_value.is_some());
    assert_eq!(pushed.minimal(0, 0).n_states(), 1);
    let mut sampled = system(1, &[0.75], &[1.0], &[1.0], 0.0);
    sampled.sample_time = Some(0.1);
    assert!((sampled.gain(0, 0).unwrap() - 4.0).abs() < 1e-14);
}

#[test]
fn frequency_response_is_the_closed_form() {
    // 1 / (1 + 2jζw − w²) with ω = 1, ζ = 0.1
    let oscillator = mixed(transfer(&[1.0], &[1.0, 0.2], 0.0));
    for w in [1e-3, 0.5, 1.0, 3.0, 1e3] {
        let expected = Complex::new(1.0 - w * w, 0.2 * w).inv();
        let found = oscillator.frequency_response(0, 0, &[w])[0];
        assert!(modulus(found - expected) < 1e-11 * modulus(expected) + 1e-15, "{w}: {found} {expected}");
    }
}

#[test]
fn phase_takes_the_turns_of_its_factors() {
    let ends = |system: StateSpace| {
        let bode = system.bode(0, 0).unwrap();
        let jumps = bode.phase_deg.windows(2).all(|pair| (pair[1] - pair[0]).abs() < 181.0);
        assert!(jumps, "{:?}", bode.phase_deg);
        (bode.phase_deg[0].round(), bode.phase_deg.last().unwrap().round())
    };
    // far from the corners: within a tenth of a decade's worth of 90°, rounded to a third of it
    let near = |found: (f64, f64), start: f64, end: f64| {
        assert!((found.0 - start).abs() < 30.0 && (found.1 - end).abs() < 30.0, "{found:?}: {start} to {end}");
    };
    near(ends(transfer(&[1.0], &[0.0, 0.0], 0.0)), -180.0, -180.0);
    near(ends(transfer(&[1.0], &[0.0, 0.0, 0.0], 0.0)), -270.0, -270.0);
    near(ends(transfer(&[1.0], &[1.0, 0.0], 0.0)), 0.0, -180.0); // undamped
    near(ends(transfer(&[1.0], &[1.0, 1e-9], 0.0)), 0.0, -180.0); // hardly damped
    near(ends(transfer(&[1.0, -1.0], &[1.0, 2.0], 0.0)), 0.0, -270.0); // non-minimum phase
    near(ends(transfer(&[1.0], &[-1.0, 0.0], 0.0)), -180.0, -180.0); // upright pendulum
    near(ends(transfer(&[0.0, 1.0], &[1.0, 2.0], 0.0)), 90.0, -90.0); // band pass
    near(ends(transfer(&[1.0], &[1.0, 3.0, 3.0], 0.0)), 0.0, -270.0);
}

#[test]
fn margins_of_a_third_order_loop_are_the_closed_form() {
    // k / (s (s + 1) (s + 5)): −180° at ω = √5, where |G| = k/30 (a classic, key `ogata2010`, chapter 7)
    let bode = transfer(&[10.0], &[0.0, 5.0, 6.0], 0.0).bode(0, 0).unwrap();
    let gain = bode.gain_margin().unwrap();
    assert!((gain.omega - 5.0_f64.sqrt()).abs() < 1e-9 && (gain.value - 9.542_425_094_393_25).abs() < 1e-9);
    // |G| = 1: ω²(ω² + 1)(ω² + 25) = 100, and 90° − atan ω − atan ω/5 there
    let phase = bode.phase_margin().unwrap();
    let w2 = phase.omega * phase.omega;
    assert!((w2 * (w2 + 1.0) * (w2 + 25.0) - 100.0).abs() < 1e-10);
    let atan = |x: f64| sincro_math::elementary::atan(x).0.to_degrees();
    assert!((phase.value - (90.0 - atan(phase.omega) - atan(phase.omega / 5.0))).abs() < 1e-10);
}

#[test]
fn a_gain_margin_at_a_frequency_of_the_grid_is_found() {
    // 0.1 / (s (0.01 s + 0.1) (0.01 s + 1)) crosses the axis at ω² = 1000, half a decade
    let bode = transfer(&[1000.0], &[0.0, 1000.0, 110.0], 0.0).bode(0, 0).unwrap();
    assert_eq!(bode.gain_margins.len(), 1);
    let gain = bode.gain_margin().unwrap();
    assert!((gain.omega - 1000.0_f64.sqrt()).abs() < 1e-6);
    // |G| = 1/110
    assert!((gain.value - 40.827_853_703_164_5).abs() < 1e-6);
}

#[test]
fn a_double_integrator_has_no_phase_margin() {
    let bode = transfer(&[1.0], &[0.0, 0.0], 0.0).bode(0, 0).unwrap();
    let phase = bode.phase_margin().unwrap();
    assert!((phase.omega - 1.0).abs() < 1e-12 && phase.value.abs() < 1e-12);
    assert!(bode.gain_margins.is_empty());
}

#[test]
fn a_negative_gain_lags_half_a_turn_at_all_frequencies() {
    // −1/(s + 1)
    let bode = transfer(&[-1.0], &[1.0], 0.0).bode(0, 0).unwrap();
    for (omega, phase) in bode.omega.iter().zip(&bode.phase_deg) {
        let expected = -180.0 - sincro_math::elementary::atan(*omega).0.to_degrees();
        assert!((phase - expected).abs() < 1e-9, "{omega}: {phase} {expected}");
    }
}

#[test]
fn the_imaginary_axis_is_not_the_negative_real_one() {
    // s/(s² + 1) changes its sign through infinity at ω = 1, on the imaginary axis
    let bode = transfer(&[0.0, 1.0], &[1.0, 0.0], 0.0).bode(0, 0).unwrap();
    assert!(bode.gain_margins.is_empty(), "{:?}", bode.gain_margins);
}

#[test]
fn the_grid_reaches_a_decade_beyond_poles_and_zeros() {
    // (s + 10) / ((s + 100) (s + 5000))
    let omega = transfer(&[10.0, 1.0], &[5e5, 5100.0], 0.0).bode(0, 0).unwrap().omega;
    assert_eq!((omega[0], omega[omega.len() - 1]), (1.0, 1e5));
}

#[test]
fn cyclic_states_are_those_that_no_rate_depends_on() {
    let of = |a: &[f64]| system(2, a, &[0.0, 1.0], &[1.0, 0.0], 0.0).cyclic_states();
    assert_eq!(of(&[0.0, 1.0, 0.0, -1.0]), [0]);
    assert_eq!(of(&[-1.0, 0.0, 1.0, 0.0]), [1]);
    assert_eq!(of(&[0.0, 1.0, 0.0, 0.0]), [0, 1]);
    assert_eq!(of(&[0.0, 1.0, -1.0, 0.0]), [0_usize; 0]);
}

#[test]
fn a_mode_that_no_input_reaches_is_named_by_its_pole() {
    let named = |mode| LinearError::NotStabilisable { mode }.to_string();
    assert!(named((1.0, 0.0)).contains("the mode at 1.000000, which"), "{}", named((1.0, 0.0)));
    assert!(named((0.5, -2.0)).contains("the mode at 0.500000 ± 2.000000j, which"), "{}", named((0.5, -2.0)));
}

#[test]
fn step_response_is_the_closed_form_at_every_point() {
    // ω = 2, ζ = 0.25
    let (w, z) = (2.0, 0.25_f64);
    let response = mixed(transfer(&[4.0], &[4.0, 1.0], 0.0)).step_response(0, 0, None);
    let damped = w * (1.0 - z * z).sqrt();
    for (t, y) in response.times.iter().zip(&response.values) {
        let (sine, cosine) = sin_cos(damped * t);
        let expected = 1.0 - exp(-z * w * t).0 * (cosine + z * w / damped * sine);
        assert!((y - expected).abs() < 1e-12, "{t}: {y} {expected}");
    }
    let info = response.info.unwrap();
    // exp(−π ζ / √(1 − ζ²)), between two points of the grid
    let overshoot = exp(-std::f64::consts::PI * z * w / damped).0;
    assert!(info.overshoot <= overshoot && info.overshoot > overshoot - 1e-4);
    assert!((info.peak_time - std::f64::consts::PI / damped).abs() < 0.02);
}

#[test]
fn a_lag_rises_and_settles_as_its_time_constant_says() {
    let response = transfer(&[3.0], &[1.0], 0.0).step_response(0, 0, None);
    let info = response.info.unwrap();
    // ln 9 and ln 50
    assert!((info.rise_time - 2.197_224_577_336_219).abs() < 1e-4);
    assert!((info.settling_time - 3.912_023_005_428_146).abs() < 1e-4);
    assert_eq!((info.overshoot, response.final_value), (0.0, Some(3.0)));
}

#[test]
fn what_does_not_settle_has_a_horizon_and_no_final_value() {
    let integrator = transfer(&[1.0], &[0.0], 0.0).step_response(0, 0, None);
    assert!((integrator.values.last().unwrap() - 10.0).abs() < 1e-10 && integrator.final_value.is_none());
    let growing = transfer(&[1.0], &[-2.0], 0.0);
    assert_eq!(growing.step_duration(), 1.5);
    let swinging = transfer(&[1.0], &[1.0, 0.0], 0.0).step_duration();
    assert!((250.0..=300.0).contains(&swinging), "{swinging}");
}

#[test]
fn the_exponential_of_a_rotation_is_a_rotation() {
    for angle in [1e-3, 1.0, 30.0, 1000.0] {
        let found = step::exponential(&matrix(2, 2, &[0.0, angle, -angle, 0.0]));
        let (sine, cosine) = sin_cos(angle);
        // rounding of the angle itself, through the squarings
        assert!((found - matrix(2, 2, &[cosine, sine, -sine, cosine])).amax() < 1e-15 * angle.max(1.0) * 10.0);
    }
}

#[test]
fn what_no_input_reaches_is_named() {
    let two = system(2, &[-1.0, 0.0, 0.0, -5.0], &[1.0, 0.0], &[0.0, 1.0], 0.0);
    let (reached, seen) = (two.controllability(), two.observability());
    assert_eq!((reached.rank, reached.outside), (1, vec![1]));
    assert_eq!((seen.rank, seen.outside), (1, vec![0]));
    // equal masses pushed alike: only their sum is reached, though no state lies outside
    let alike = system(2, &[-1.0, 0.0, 0.0, -1.0], &[1.0, 1.0], &[1.0, 0.0], 0.0).controllability();
    assert_eq!((alike.rank, alike.outside.len()), (1, 0));
}

#[test]
fn a_long_stiff_chain_is_reached() {
    // twelve lags from 1 to 10⁴ /s one behind the other: the controllability matrix spans 44 decades
    let n = 12;
    let a = DMatrix::from_fn(n, n, |i, j| {
        let rate = 10.0_f64.powi((i / 3) as i32 + 1);
        if i == j {
            -rate
        } else if i == j + 1 {
            rate
        } else {
            0.0
        }
    });
    let mut b = DMatrix::zeros(n, 1);
    b[0] = 1.0;
    let mut c = DMatrix::zeros(1, n);
    c[n - 1] = 1.0;
    let chain = StateSpace::from_matrices(a, b, c, DMatrix::zeros(1, 1)).unwrap();
    assert!(chain.controllability().is_full() && chain.observability().is_full());
}

#[test]
fn a_gain_without_states_is_a_system_too() {
    let empty = StateSpace::from_matrices(
        DMatrix::zeros(0, 0),
        DMatrix::zeros(0, 1),
        DMatrix::zeros(1, 0),
        matrix(1, 1, &[-10.0]),
    );
    let empty = empty.unwrap();
    assert_eq!((empty.poles().len(), empty.gain(0, 0), empty.is_stable()), (0, Some(-10.0), true));
    let bode = empty.bode(0, 0).unwrap();
    assert!(bode.magnitude_db.iter().all(|db| (db - 20.0).abs() < 1e-13));
    assert!(bode.phase_deg.iter().all(|phase| (phase + 180.0).abs() < 1e-13));
    assert!(empty.step_response(0, 0, None).values.iter().all(|y| *y == -10.0));
    assert_eq!(lqr(&empty.a, &empty.b, &empty.a, &DMatrix::identity(1, 1)), Err(LinearError::Empty));
}

#[test]
fn regulators_have_their_closed_forms() {
    let one = DMatrix::identity(1, 1);
    // ẋ = a x + u, ∫ x² + u²: k = a + √(a² + 1)
    for a in [-3.0, 0.0, 2.0] {
        let k = lqr(&matrix(1, 1, &[a]), &one, &one, &one).unwrap().k[0];
        assert!((k - (a + (a * a + 1.0_f64).sqrt())).abs() < 1e-13);
    }
    let double = lqr(&matrix(2, 2, &[0.0, 1.0, 0.0, 0.0]), &matrix(2, 1, &[0.0, 1.0]), &DMatrix::identity(2, 2), &one);
    let double = double.unwrap();
    let root3 = 3.0_f64.sqrt();
    assert!((&double.k - matrix(1, 2, &[1.0, root3])).amax() < 1e-13);
    assert!((&double.p - matrix(2, 2, &[root3, 1.0, 1.0, root3])).amax() < 1e-13);
    // x⁺ = x + u, Σ x² + u²: p = (1 + √5) / 2, k = p / (1 + p)
    let golden = (1.0 + 5.0_f64.sqrt()) / 2.0;
    let sampled = dlqr(&one, &one, &one, &one).unwrap();
    assert!((sampled.p[0] - golden).abs() < 1e-14 && (sampled.k[0] - golden / (1.0 + golden)).abs() < 1e-14);
}

#[test]
fn a_cart_with_a_pendulum_is_held_upright_in_both_times() {
    let a = matrix(4, 4, &[0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, -0.981, -0.1, 0.0, 0.0, 21.582, 0.2, 0.0]);
    let b = matrix(4, 1, &[0.0, 0.0, 1.0, -2.0]);
    let q = DMatrix::from_diagonal(&DVector::from_column_slice(&[10.0, 100.0, 1.0, 1.0]));
    let r = matrix(1, 1, &[0.1]);
    let regulator = lqr(&a, &b, &q, &r).unwrap();
    assert!(regulator.residual < 1e-13, "{}", regulator.residual);
    assert!(regulator.poles.iter().all(|pole| pole.re < 0.0));
    let mut augmented = DMatrix::zeros(5, 5);
    augmented.view_mut((0, 0), (4, 4)).copy_from(&(&a * 0.01));
    augmented.view_mut((0, 4), (4, 1)).copy_from(&(&b * 0.01));
    let whole = step::exponential(&augmented);
    let (phi, gamma) = (whole.view((0, 0), (4, 4)).into_owned(), whole.view((0, 4), (4, 1)).into_owned());
    let sampled = dlqr(&phi, &gamma, &q, &r).unwrap();
    assert!(sampled.residual < 1e-13, "{}", sampled.residual);
    assert!(sampled.poles.iter().all(|pole| modulus(*pole) < 1.0));
}

#[test]
fn impossible_regulators_are_refused_in_words() {
    let (one, two) = (DMatrix::identity(1, 1), DMatrix::identity(2, 2));
    let said = |a: &DMatrix<f64>, b: &DMatrix<f64>, q: &DMatrix<f64>, r: &DMatrix<f64>| {
        let continuous = lqr(a, b, q, r).unwrap_err().to_string();
        let _ = dlqr(a, b, q, r);
        continuous
    };
    let b = matrix(2, 1, &[1.0, 0.0]);
    assert_eq!(said(&two, &b, &one, &one), "`Q` is 1×1, expected 2×2");
    let lost = said(&matrix(2, 2, &[-1.0, 0.0, 0.0, 2.0]), &b, &two, &one);
    assert!(lost.starts_with("not stabilisable: no input reaches the mode at 2.0"), "{lost}");
    assert!(said(&one, &one, &one, &-&one).starts_with("`R` is not positive definite"));
    assert!(said(&one, &one, &-&one, &one).starts_with("`Q` has the negative eigenvalue -1"));
    assert_eq!(said(&two, &b, &matrix(2, 2, &[1.0, 1.0, 0.0, 1.0]), &one), "`Q` is not symmetric");
    // an integrator that costs nothing
    assert_eq!(lqr(&matrix(1, 1, &[0.0]), &one, &matrix(1, 1, &[0.0]), &one), Err(LinearError::NotDetectable));
    assert!(dlqr(&one, &one, &matrix(1, 1, &[0.0]), &one).is_err());
    let bad = StateSpace::from_matrices(one.clone(), matrix(2, 1, &[0.0, 0.0]), one.clone(), one);
    assert_eq!(bad.unwrap_err().to_string(), "`B` is 2×1, expected 1×1");
}

#[test]
fn the_phase_of_delays_goes_on_beyond_a_turn() {
    // three delays of one tick: z⁻³ has the phase −3 ω T
    let tick = 0.1;
    let mut system = system(3, &[0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0], &[0.0, 0.0, 1.0], &[1.0, 0.0, 0.0], 0.0);
    system.sample_time = Some(tick);
    let omega = [1.0, 5.0, 10.0, 15.0, 20.0, 25.0, 30.0];
    let bode = system.bode_at(0, 0, &omega).unwrap();
    assert_eq!(bode.phase_deg.len(), omega.len());
    for (w, phase) in omega.iter().zip(&bode.phase_deg) {
        assert!((phase + (3.0 * w * tick).to_degrees()).abs() < 1e-9, "{w} {phase}");
    }
}

#[test]
fn a_zero_on_the_grid_leaves_the_phase_beside_it() {
    // (s² + 1) / (s + 1)²: zero at 1 rad/s, phase −2 atan ω below it
    let bode = transfer(&[0.0, -2.0], &[1.0, 2.0], 1.0).bode_at(0, 0, &[0.1, 1.0, 10.0]).unwrap();
    let expected = -2.0 * sincro_math::elementary::atan(0.1).0.to_degrees();
    assert!((bode.phase_deg[0] - expected).abs() < 1e-9, "{:?}", bode.phase_deg);
}

#[test]
fn the_grid_has_sixty_points_a_decade_and_more_about_a_resonance() {
    // undamped at 100 rad/s: from one decade below to one above, and six on each side of the resonance
    let omega = transfer(&[1.0], &[1e4, 0.0], 0.0).bode(0, 0).unwrap().omega;
    assert_eq!((omega[0], omega[omega.len() - 1], omega.len()), (10.0, 1000.0, 2 * 60 + 1 + 12));
    // its width is taken for 10⁻⁴ of its frequency
    for distance in [-0.04, -0.0012, 0.0012, 0.04] {
        assert!(omega.iter().any(|w| (w - 100.0 - distance).abs() < 1e-9), "{distance}");
    }
}

#[test]
fn the_residual_of_a_regulator_is_a_share_of_its_terms() {
    let (a, b) = (matrix(2, 2, &[0.0, 1.0, 2.0, -0.5]), matrix(2, 1, &[0.0, 1.0]));
    let regulator = lqr(&a, &b, &DMatrix::identity(2, 2), &matrix(1, 1, &[0.5])).unwrap();
    // rounding, and no exact zero
    assert!(regulator.residual > 0.0 && regulator.residual < 1e-13, "{}", regulator.residual);
}

#[test]
fn a_sampled_negative_gain_begins_as_a_lag() {
    // −1 delayed by a tick: on the negative real axis at first
    let mut delay = system(1, &[0.0], &[-1.0], &[1.0], 0.0);
    delay.sample_time = Some(1.0);
    let phase = delay.bode_at(0, 0, &[0.001, 1.0]).unwrap().phase_deg;
    assert!((phase[0] + 180.0 + 0.001_f64.to_degrees()).abs() < 1e-9, "{phase:?}");
}
