//! Dormand–Prince 8(5,3), known as DOP853: explicit, error-controlled, for smooth problems at high accuracy.
//!
//! Source: key `hairer1993`, section II.5 for the method and section II.10 for its two error estimates, whose
//! combination falls with the eighth power of the step; coefficients as in the authors' program.

use sincro_math::Real;

use crate::embedded::{self, EmbeddedPair, add_weighted, find_error, slope};
use crate::{Control, Failure, System};

const C: [f64; 12] = [
    0.0,
    0.05260015195876773,
    0.0789002279381516,
    0.1183503419072274,
    0.2816496580927726,
    1.0 / 3.0,
    0.25,
    4.0 / 13.0,
    127.0 / 195.0,
    0.6,
    6.0 / 7.0,
    1.0,
];
const A_1: [f64; 1] = [0.05260015195876773];
const A_2: [f64; 2] = [0.0197250569845379, 0.0591751709536137];
const A_3: [f64; 2] = [0.02958758547680685, 0.08876275643042054];
const A_4: [f64; 3] = [0.2413651341592667, -0.8845494793282861, 0.924834003261792];
const A_5: [f64; 3] = [0.037037037037037035, 0.17082860872947386, 0.12546768756682242];
const A_6: [f64; 4] = [0.037109375, 0.17025221101954405, 0.06021653898045596, -0.017578125];
const A_7: [f64; 5] =
    [0.03709200011850479, 0.17038392571223998, 0.10726203044637328, -0.015319437748624402, 0.008273789163814023];
const A_8: [f64; 6] = [
    0.6241109587160757,
    -3.3608926294469414,
    -0.868219346841726,
    27.59209969944671,
    20.154067550477894,
    -43.48988418106996,
];
const A_9: [f64; 7] = [
    0.47766253643826434,
    -2.4881146199716677,
    -0.590290826836843,
    21.230051448181193,
    15.279233632882423,
    -33.28821096898486,
    -0.020331201708508627,
];
const A_10: [f64; 8] = [
    -0.9371424300859873,
    5.186372428844064,
    1.0914373489967295,
    -8.149787010746927,
    -18.52006565999696,
    22.739487099350505,
    2.4936055526796523,
    -3.0467644718982196,
];
const A_11: [f64; 9] = [
    2.273310147516538,
    -10.53449546673725,
    -2.0008720582248625,
    -17.9589318631188,
    27.94888452941996,
    -2.8589982771350235,
    -8.87285693353063,
    12.360567175794303,
    0.6433927460157636,
];
const B: [f64; 8] = [
    0.054293734116568765,
    4.450312892752409,
    1.8915178993145003,
    -5.801203960010585,
    0.3111643669578199,
    -0.1521609496625161,
    0.20136540080403034,
    0.04471061572777259,
];

/// Weights of the error estimate of order 5, for the slopes that have a weight in [`B`].
const E_5: [f64; 8] = [
    0.01312004499419488,
    -1.2251564463762044,
    -0.4957589496572502,
    1.6643771824549864,
    -0.35032884874997366,
    0.3341791187130175,
    0.08192320648511571,
    -0.022355307863886294,
];
/// Eighth-order weights minus those of order 3, which has the slopes 0, 8 and 11 alone.
const E_3: [f64; 8] =
    [B[0] - 0.2440944881889764, B[1], B[2], B[3], B[4] - 0.7338466882816119, B[5], B[6], B[7] - 0.02205882352941176];

/// Dormand–Prince method of order 8 with error control (embedded orders 5 and 3), and its working memory: for smooth
/// systems at accuracies beyond 1e-7. On dual numbers the values alone are controlled.
#[derive(Clone, Debug)]
pub struct DormandPrince8<R = f64> {
    /// Tolerance and next step size.
    pub control: Control,
    /// Slopes of the stages, one after the other.
    slopes: Vec<R>,
    stage: Vec<R>,
    errors: [Vec<R>; 2],
}

impl<R: Real> DormandPrince8<R> {
    /// Creates the method for systems with `dim` unknowns ([`System::dim`]).
    #[must_use]
    pub fn new(dim: usize, control: Control) -> Self {
        let zero = vec![R::zero(); dim];
        let errors = [zero.clone(), zero.clone()];
        Self { control, slopes: vec![R::zero(); 12 * dim], stage: zero, errors }
    }

    /// Makes one accepted step from `t` `[s]`, no longer than `h_max` `[s]`, and returns its length `[s]`. `y`
    /// ([`System::dim`] entries) is the state in a fresh chart before and after.
    ///
    /// # Errors
    ///
    /// [`Failure::StepTooSmall`] if no step meets the tolerance, [`Failure::NotFinite`] if slopes are not finite.
    pub fn step<S: System<R>>(&mut self, system: &mut S, t: f64, h_max: f64, y: &mut [R]) -> Result<f64, Failure> {
        embedded::step(self, system, t, h_max, y)
    }
}

impl<R: Real> EmbeddedPair<R> for DormandPrince8<R> {
    const ERROR_ORDER: f64 = 8.0;
    const BETA: f64 = 0.0;

    fn control(&mut self) -> &mut Control {
        &mut self.control
    }

    fn stages<S: System<R>>(&mut self, system: &mut S, t: f64, h: f64, y: &[R]) {
        for s in 0..=12 {
            let (k, stage) = (split(&self.slopes), &mut self.stage[..]);
            match s {
                0 => stage.copy_from_slice(y),
                1 => add_weighted(stage, y, [k[0]], A_1, h),
                2 => add_weighted(stage, y, [k[0], k[1]], A_2, h),
                3 => add_weighted(stage, y, [k[0], k[2]], A_3, h),
                4 => add_weighted(stage, y, [k[0], k[2], k[3]], A_4, h),
                5 => add_weighted(stage, y, [k[0], k[3], k[4]], A_5, h),
                6 => add_weighted(stage, y, [k[0], k[3], k[4], k[5]], A_6, h),
                7 => add_weighted(stage, y, [k[0], k[3], k[4], k[5], k[6]], A_7, h),
                8 => add_weighted(stage, y, [k[0], k[3], k[4], k[5], k[6], k[7]], A_8, h),
                9 => add_weighted(stage, y, [k[0], k[3], k[4], k[5], k[6], k[7], k[8]], A_9, h),
                10 => add_weighted(stage, y, [k[0], k[3], k[4], k[5], k[6], k[7], k[8], k[9]], A_10, h),
                11 => add_weighted(stage, y, [k[0], k[3], k[4], k[5], k[6], k[7], k[8], k[9], k[10]], A_11, h),
                _ => add_weighted(stage, y, [k[0], k[5], k[6], k[7], k[8], k[9], k[10], k[11]], B, h),
            }
            if s < 12 {
                let n = y.len();
                slope(system, t + C[s] * h, &self.stage, &mut self.slopes[s * n..(s + 1) * n]);
            }
        }
        let k = split(&self.slopes);
        let k = [k[0], k[5], k[6], k[7], k[8], k[9], k[10], k[11]];
        let [of_order_5, of_order_3] = &mut self.errors;
        find_error(of_order_5, k, E_5, h);
        find_error(of_order_3, k, E_3, h);
    }

    fn new_y(&self) -> &[R] {
        &self.stage
    }

    fn share<S: System<R>>(&mut self, system: &mut S) -> f64 {
        let [of_order_5, of_order_3] = self.errors.each_mut().map(|error| {
            system.project_error(&self.stage, error);
            self.control.share(system, &self.stage, error)
        });
        match of_order_5 {
            0.0 => 0.0,
            _ if !(of_order_5 + of_order_3).is_finite() => f64::INFINITY,
            // without squares that would overflow
            _ => of_order_5 / (1.0 + 0.01 * (of_order_3 / of_order_5) * (of_order_3 / of_order_5)).sqrt(),
        }
    }
}

/// Slopes of each stage.
fn split<R>(slopes: &[R]) -> [&[R]; 12] {
    let n = slopes.len() / 12;
    std::array::from_fn(|k| &slopes[k * n..(k + 1) * n])
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Implicit;

    /// A body on an ellipse about the origin, with the eccentricity 0.3: x, y and their velocities.
    struct Kepler;

    impl System<f64> for Kepler {
        fn dim(&self) -> usize {
            4
        }
        fn is_controlled(&self, _: usize) -> bool {
            true
        }
        fn slope(&mut self, _: f64, y: &[f64], slope: &mut [f64]) {
            let cube = (y[0] * y[0] + y[1] * y[1]).powi(3).sqrt();
            slope.copy_from_slice(&[y[2], y[3], -y[0] / cube, -y[1] / cube]);
        }
        fn implicit_slope(&mut self, t: f64, _: f64, _: Implicit, y: &[f64], slope: &mut [f64]) {
            self.slope(t, y, slope);
        }
        fn rechart(&mut self, _: &mut [f64]) {}
        fn magnitude(&self, y: &[f64], k: usize) -> f64 {
            y[k].abs()
        }
    }

    fn perihelion() -> [f64; 4] {
        [0.7, 0.0, 0.0, (1.3_f64 / 0.7).sqrt()]
    }

    /// Distance from the start after one revolution.
    fn miss(y: &[f64]) -> f64 {
        y.iter().zip(perihelion()).fold(0.0, |worst, (y, start)| worst.max((y - start).abs()))
    }

    /// Error after one revolution in `n` equal steps, and the largest error estimates within: after the eighth power of
    /// the step, and of orders 5 and 3.
    fn revolution(n: u32) -> (f64, [f64; 2]) {
        let h = 2.0 * std::f64::consts::PI / f64::from(n);
        let mut method = DormandPrince8::new(4, Control::new(1.0, h));
        let (mut y, mut estimates) = (perihelion(), [0.0_f64; 2]);
        for step in 0..n {
            method.stages(&mut Kepler, f64::from(step) * h, h, &y);
            y.copy_from_slice(method.new_y());
            for (estimate, error) in estimates.iter_mut().zip(&method.errors) {
                *estimate = error.iter().fold(*estimate, |worst, e| worst.max(e.abs()));
            }
        }
        (miss(&y), estimates)
    }

    /// Slope over one halving of the step.
    fn order(coarse: f64, fine: f64) -> f64 {
        (coarse / fine).log2()
    }

    #[test]
    fn errors_and_estimates_fall_with_their_powers_of_the_step() {
        let ((e, [e_5, e_3]), (f, [f_5, f_3])) = (revolution(60), revolution(120));
        assert!(e < 3e-10 && (7.4..8.6).contains(&order(e, f)), "{e:e} {f:e}");
        // local errors: one power more than the order
        assert!((5.5..6.6).contains(&order(e_5, f_5)), "{e_5:e} {f_5:e}");
        assert!((3.5..4.6).contains(&order(e_3, f_3)), "{e_3:e} {f_3:e}");
    }

    #[test]
    fn rows_add_up_to_their_instants_and_weights_integrate_powers() {
        let sums = [
            A_1.iter().sum::<f64>(),
            A_2.iter().sum(),
            A_3.iter().sum(),
            A_4.iter().sum(),
            A_5.iter().sum(),
            A_6.iter().sum(),
            A_7.iter().sum(),
            A_8.iter().sum(),
            A_9.iter().sum(),
            A_10.iter().sum(),
            A_11.iter().sum(),
        ];
        for (sum, c) in sums.iter().zip(&C[1..]) {
            assert!((sum - c).abs() < 1e-13, "{sum} {c}");
        }
        let instants = [0, 5, 6, 7, 8, 9, 10, 11].map(|k| C[k]);
        for power in 0..8 {
            let moment = |weights: [f64; 8]| weights.iter().zip(instants).map(|(w, c)| w * c.powi(power)).sum::<f64>();
            assert!((moment(B) - 1.0 / f64::from(power + 1)).abs() < 1e-14, "power {power}");
            assert_eq!(moment(E_5).abs() < 1e-14, power < 5, "power {power}");
            assert_eq!(moment(E_3).abs() < 1e-14, power < 3, "power {power}");
        }
    }

    #[test]
    fn tolerances_are_kept_in_fewer_evaluations_than_by_order_5() {
        for accuracy in [1e-6, 1e-9, 1e-12] {
            let control = Control::new(accuracy, 0.1);
            let (mut method, mut t, mut y, mut n) = (DormandPrince8::new(4, control), 0.0, perihelion(), 0);
            let (mut other, mut t_5, mut y_5, mut n_5) = (crate::DormandPrince::new(4, control), 0.0, perihelion(), 0);
            let end = 2.0 * std::f64::consts::PI;
            while t < end {
                t += method.step(&mut Kepler, t, end - t, &mut y).unwrap();
                n += 12;
            }
            while t_5 < end {
                t_5 += other.step(&mut Kepler, t_5, end - t_5, &mut y_5).unwrap();
                n_5 += 7;
            }
            assert!(miss(&y) < 100.0 * accuracy && miss(&y_5) < 100.0 * accuracy, "{:e} {:e}", miss(&y), miss(&y_5));
            assert!(n < n_5, "{accuracy:e}: {n} {n_5}");
        }
    }

    #[test]
    fn what_is_not_finite_is_an_error_and_no_step() {
        struct Broken;
        impl System<f64> for Broken {
            fn dim(&self) -> usize {
                1
            }
            fn is_controlled(&self, _: usize) -> bool {
                true
            }
            fn slope(&mut self, _: f64, _: &[f64], slope: &mut [f64]) {
                slope[0] = f64::NAN;
            }
            fn implicit_slope(&mut self, _: f64, _: f64, _: Implicit, _: &[f64], slope: &mut [f64]) {
                slope[0] = f64::NAN;
            }
            fn rechart(&mut self, _: &mut [f64]) {}
            fn magnitude(&self, _: &[f64], _: usize) -> f64 {
                1.0
            }
        }
        let mut y = [0.5];
        let failed = DormandPrince8::new(1, Control::new(1e-9, 0.1)).step(&mut Broken, 0.0, 0.1, &mut y);
        assert!(matches!(failed, Err(Failure::NotFinite { .. })) && y == [0.5], "{failed:?}");
    }
}
