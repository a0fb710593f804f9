//! Margins of a sampled loop that is opened at one signal. Cost: m³ a frequency, m samples a period.
//!
//! A loop with several sample times is periodic. Lifted over one period (key `chen1995`, chapter 8) it is a
//! time-invariant system L(z) of m inputs and m outputs: the samples of the opened signal in their order, closed by −1.
//! A factor k on that signal closes it with det(I + k L) = 0, so the margins are those of the *characteristic loci*,
//! the eigenvalues of L on the unit circle: key `macfarlane1977`. For m = 1 they are the margins of the Nyquist plot. A
//! loop with one sample time that is lifted all the same has its own frequency response, at the m frequencies that one
//! period cannot tell apart, as loci.
//!
//! The frequency response that is drawn is the share of the output at the frequency of the input; what comes out at
//! other frequencies is in the loci only.
//!
//! | symbol | meaning |
//! |---|---|
//! | m, T | samples in a period, its length `[s]` |
//! | λ | eigenvalue of L(exp(jωT)), a characteristic locus |
//! | σ | smallest singular value of I + L |

use std::f64::consts::PI;

use nalgebra::linalg::{SVD, Schur};
use sincro_math::elementary::{atan2, sin_cos};

use super::bode::{Bode, Corners, Margin, decibel, unwrapped};
use super::modes::eigenvalues;
use super::{Complex, DMatrix, DVector, StateSpace, modulus};

/// Frequencies evenly spaced from zero to the highest, beside those that show the poles.
const EVEN: usize = 240;
/// Lowest frequency relative to the highest. Poles at 1 are known to the rounding of differences; below, L is not.
const SLOWEST: f64 = 1e-4;
/// Halvings of a bracket around a crossover.
const HALVINGS: usize = 60;
/// Loci beyond this are at a pole, where they cross no line.
const AT_POLE: f64 = 1e6;
/// Imaginary part of a real eigenvalue relative to its modulus.
const REAL: f64 = 1e-9;
/// Iterations of the Schur decomposition.
const MAX_SWEEPS: usize = 3000;

/// Frequency response and margins of a sampled loop that is opened at one signal; result of
/// [`StateSpace::loop_margins`].
#[derive(Clone, Debug, PartialEq)]
pub struct LoopMargins {
    /// Response of the signal at the frequency of the input, up to half the sampling frequency of the signal, with all
    /// gain and phase margins.
    pub bode: Bode,
    /// Modulus margin: smallest distance of the response from −1 (dimensionless), with several samples in a period the
    /// smallest singular value of I + L; its inverse is the largest sensitivity. The frequency is that of the period.
    pub modulus_margin: Margin,
}

type ComplexMatrix = DMatrix<Complex<f64>>;

impl StateSpace {
    /// Returns frequency response and margins of a sampled loop that is opened at one signal: inputs are the m samples
    /// of the signal in one period as the loop sees them, outputs the same samples as it gives them with the sign
    /// changed (the loop is closed by −1), and the sample time is the period.
    ///
    /// A gain margin is the factor on all samples, a phase margin the angle by which all loci may turn, until a pole of
    /// the closed loop is on the unit circle. With several samples in a period a frequency is that at which the signal
    /// then oscillates most.
    ///
    /// # Panics
    ///
    /// If the system is continuous, or has not as many inputs as outputs, or none.
    ///
    /// ```
    /// use sincro_analysis::prelude::*;
    ///
    /// # fn main() -> Result<(), LinearError> {
    /// // an integrator sampled at 10 Hz under the gain 5: L = 0.5/(z − 1)
    /// let one = DMatrix::identity(1, 1);
    /// let mut l = StateSpace::from_matrices(one.clone(), one.clone(), 0.5 * &one, 0.0 * &one)?;
    /// l.sample_time = Some(0.1);
    /// let margins = l.loop_margins();
    /// let gain = margins.bode.gain_margin().unwrap(); // at half the sampling frequency, |L| = 0.5/2
    /// assert!((gain.value - 20.0 * f64::log10(4.0)).abs() < 1e-9); // [dB]
    /// assert!((gain.omega - 10.0 * std::f64::consts::PI).abs() < 1e-9); // [rad/s]
    /// // |L| = 1 at 2 sin(θ/2) = 0.5, with the phase −90° − θ/2
    /// let phase = margins.bode.phase_margin().unwrap();
    /// assert!((phase.value - (90.0 - f64::asin(0.25).to_degrees())).abs() < 1e-9); // [°]
    /// // the line Re L = −0.25 is nearest to −1 at half the sampling frequency
    /// assert!((margins.modulus_margin.value - 0.75).abs() < 1e-9);
    /// # Ok(())
    /// # }
    /// ```
    #[must_use]
    pub fn loop_margins(&self) -> LoopMargins {
        let loci = Loci::new(self);
        let grid = loci.grid(PI / loci.period);
        let (gain_margins, phase_margins) = loci.margins(&grid);
        let omega = loci.grid(PI * loci.n as f64 / loci.period);
        let values: Vec<Complex<f64>> = omega.iter().map(|&w| loci.fundamental(w)).collect();
        let bode = Bode {
            magnitude_db: values.iter().map(|g| decibel(modulus(*g))).collect(),
            phase_deg: unwrapped(&values).into_iter().map(f64::to_degrees).collect(),
            gain_margins,
            phase_margins,
            omega,
        };
        LoopMargins { bode, modulus_margin: loci.modulus_margin(&grid) }
    }
}

/// Characteristic loci of a lifted loop.
struct Loci<'a> {
    system: &'a StateSpace,
    /// Samples in a period.
    n: usize,
    /// Length of the period `[s]`.
    period: f64,
    corners: Corners,
}

/// Locus at a frequency.
#[derive(Clone, Copy)]
struct Point {
    omega: f64,
    locus: Complex<f64>,
}

impl<'a> Loci<'a> {
    fn new(system: &'a StateSpace) -> Self {
        let period = system.sample_time.expect("a sampled system");
        let n = system.n_inputs();
        assert!(n == system.n_outputs() && n > 0, "as many inputs as outputs");
        let corners = Corners::new(system, &eigenvalues(&system.a), &[]);
        Self { system, n, period, corners }
    }

    /// L at an angular frequency `[rad/s]`.
    fn response(&self, omega: f64) -> ComplexMatrix {
        self.system.frequency_responses(&[omega]).pop().expect("one frequency")
    }

    /// Share of the output at the frequency of the input: mean of L by the shifts of both.
    fn fundamental(&self, omega: f64) -> Complex<f64> {
        let l = self.response(omega);
        let h = self.period / self.n as f64;
        let mut sum = Complex::new(0.0, 0.0);
        for i in 0..self.n {
            for j in 0..self.n {
                let (sine, cosine) = sin_cos(omega * h * (j as f64 - i as f64));
                sum += l[(i, j)] * Complex::new(cosine, sine);
            }
        }
        sum / Complex::new(self.n as f64, 0.0)
    }

    /// Angular frequencies up to `last`, ascending: some for the poles, some evenly spaced.
    fn grid(&self, last: f64) -> Vec<f64> {
        let mut omega: Vec<f64> =
            self.corners.grid().into_iter().filter(|w| *w > SLOWEST * last && *w < last).collect();
        omega.push(SLOWEST * last);
        omega.extend((1..=EVEN).map(|k| last * k as f64 / EVEN as f64));
        omega.sort_by(f64::total_cmp);
        omega.dedup();
        omega
    }

    /// Eigenvalues of L; none where it has a pole.
    fn at(&self, omega: f64) -> Vec<Complex<f64>> {
        let l = self.response(omega);
        if l.iter().any(|x| !x.re.is_finite() || !x.im.is_finite()) {
            return Vec::new();
        }
        if self.n == 1 {
            return vec![l[(0, 0)]];
        }
        let schur = Schur::try_new(l, f64::EPSILON, MAX_SWEEPS);
        schur.map_or(Vec::new(), |schur| schur.unpack().1.diagonal().iter().copied().collect())
    }

    /// All gain and phase margins, ascending in frequency; `grid` reaches to half the frequency of the period.
    fn margins(&self, grid: &[f64]) -> (Vec<Margin>, Vec<Margin>) {
        let (mut gains, mut phases) = (Vec::new(), Vec::new());
        let mut before: Option<(f64, Vec<Complex<f64>>)> = None;
        for &omega in grid {
            let now = self.at(omega);
            if let Some((from, loci)) = &before {
                for (a, b) in pairs(loci, &now) {
                    let ends = [Point { omega: *from, locus: a }, Point { omega, locus: b }];
                    let crosses = |of: fn(Complex<f64>) -> f64| (of(a) < 0.0) != (of(b) < 0.0);
                    let is_left = |z: Complex<f64>| z.re < 0.0 && z.im.abs() > REAL * z.re.abs();
                    if crosses(|z| z.im) && is_left(a) && is_left(b) {
                        gains.extend(self.cross(ends, |z| z.im).map(|at| self.gain_margin(at)));
                    }
                    if crosses(|z| modulus(z) - 1.0) {
                        phases.extend(self.cross(ends, |z| modulus(z) - 1.0).map(|at| self.phase_margin(at)));
                    }
                }
            }
            before = Some((omega, now));
        }
        // L is real at both ends
        for omega in [0.0, PI / self.period] {
            let real = self.at(omega).into_iter().filter(|z| z.im.abs() <= REAL * z.re.abs() && z.re < 0.0);
            gains.extend(real.filter(|z| z.re > -AT_POLE).map(|locus| self.gain_margin(Point { omega, locus })));
        }
        for list in [&mut gains, &mut phases] {
            list.retain(|margin| margin.value.is_finite());
            list.sort_by(|a, b| a.omega.total_cmp(&b.omega));
        }
        (gains, phases)
    }

    /// Point between two at which `of` changes its sign; none at a pole.
    fn cross(&self, ends: [Point; 2], of: impl Fn(Complex<f64>) -> f64) -> Option<Point> {
        let [mut low, mut high] = ends;
        for _ in 0..HALVINGS {
            let omega = 0.5 * (low.omega + high.omega);
            let between = (low.locus + high.locus) / Complex::new(2.0, 0.0);
            let nearest = |a: &Complex<f64>, b: &Complex<f64>| modulus(a - between).total_cmp(&modulus(b - between));
            let middle = Point { omega, locus: self.at(omega).into_iter().min_by(nearest)? };
            if (of(middle.locus) < 0.0) == (of(low.locus) < 0.0) {
                low = middle;
            } else {
                high = middle;
            }
        }
        (modulus(low.locus) < AT_POLE && modulus(low.locus - high.locus) < 1e-3 * (1.0 + modulus(low.locus)))
            .then_some(low)
    }

    fn gain_margin(&self, at: Point) -> Margin {
        Margin { omega: self.frequency(at).0, value: -decibel(modulus(at.locus)) }
    }

    fn phase_margin(&self, at: Point) -> Margin {
        let (omega, is_negative) = self.frequency(at);
        // a locus at a negative frequency is the conjugate of that at the positive one
        let im = if is_negative { -at.locus.im } else { at.locus.im };
        Margin { omega, value: atan2(-im, -at.locus.re).0.to_degrees() }
    }

    /// Frequency at which the eigenvector of a locus oscillates most, of those that the period cannot tell apart, and
    /// true if it is a negative one.
    fn frequency(&self, at: Point) -> (f64, bool) {
        if self.n == 1 {
            return (at.omega, false);
        }
        let n = self.n;
        let mut shifted = self.response(at.omega);
        // a little beside the eigenvalue, so that the factors are those of a regular matrix
        let shift = at.locus * Complex::new(1.0 + 1e-9, 0.0);
        (0..n).for_each(|k| shifted[(k, k)] -= shift);
        let factors = shifted.lu();
        let mut vector = DVector::from_fn(n, |k, _| Complex::new(1.0, 0.3 * k as f64));
        for _ in 0..3 {
            if let Some(next) = factors.solve(&vector) {
                let size = next.norm();
                vector = next / Complex::new(size, 0.0);
            }
        }
        let h = self.period / n as f64;
        let rate = |i: usize| at.omega + 2.0 * PI * i as f64 / self.period;
        let share = |i: usize| {
            let term = |(k, v): (usize, &Complex<f64>)| {
                let (sine, cosine) = sin_cos(-rate(i) * h * k as f64);
                v * Complex::new(cosine, sine)
            };
            modulus(vector.iter().enumerate().map(term).sum::<Complex<f64>>())
        };
        let most = (0..n).max_by(|a, b| share(*a).total_cmp(&share(*b))).unwrap_or(0);
        match rate(most) {
            rate if rate > PI / h => (2.0 * PI / h - rate, true),
            rate => (rate, false),
        }
    }

    /// Smallest singular value of I + L over the frequencies.
    fn modulus_margin(&self, grid: &[f64]) -> Margin {
        let at = |&omega: &f64| {
            let mut sum = self.response(omega);
            (0..self.n).for_each(|k| sum[(k, k)] += Complex::new(1.0, 0.0));
            let is_finite = sum.iter().all(|x| x.re.is_finite() && x.im.is_finite());
            let value = match self.n {
                _ if !is_finite => f64::INFINITY,
                1 => modulus(sum[(0, 0)]),
                _ => SVD::new(sum, false, false).singular_values.min(),
            };
            Margin { omega, value }
        };
        let all: Vec<Margin> = core::iter::once(&0.0).chain(grid).map(at).collect();
        let best =
            (0..all.len()).min_by(|a, b| all[*a].value.total_cmp(&all[*b].value)).expect("a grid has frequencies");
        let (mut low, mut high) = (all[best.saturating_sub(1)].omega, all[(best + 1).min(all.len() - 1)].omega);
        let mut least = all[best];
        // golden sections
        let share = 0.5 * (3.0 - 5.0_f64.sqrt());
        for _ in 0..HALVINGS {
            let (a, b) = (at(&(low + share * (high - low))), at(&(high - share * (high - low))));
            if a.value < b.value {
                high = b.omega
            } else {
                low = a.omega
            }
            least = [a, b].into_iter().fold(least, |least, x| if x.value < least.value { x } else { least });
        }
        least
    }
}

/// Each locus with the nearest one at the next frequency that is left; none where their numbers differ.
fn pairs(before: &[Complex<f64>], now: &[Complex<f64>]) -> Vec<(Complex<f64>, Complex<f64>)> {
    if before.len() != now.len() {
        return Vec::new();
    }
    let mut left: Vec<Complex<f64>> = now.to_vec();
    let near = |z: &Complex<f64>, left: &mut Vec<Complex<f64>>| {
        let distance = |k: &usize| modulus(left[*k] - z);
        let nearest = (0..left.len()).min_by(|a, b| distance(a).total_cmp(&distance(b))).expect("as many");
        left.swap_remove(nearest)
    };
    before.iter().map(|z| (*z, near(z, &mut left))).collect()
}
