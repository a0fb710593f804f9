//! Step response, exact at every point of its grid. Cost: one matrix exponential, then a product a point.
//!
//! With a constant input `[x; u]⁺ = exp([A B; 0 0] h) [x; u]`, whatever h is. The exponential is the Padé approximant
//! of degree 13 with scaling and squaring (key `higham2005`).

use super::{DMatrix, DVector, Mode, StateSpace};

/// Time constants after which a mode has settled: e⁻⁶ is a quarter of a percent.
const SETTLED: f64 = 6.0;
/// Growth is shown up to e³.
const GROWN: f64 = 3.0;
/// Periods of the slowest swinging mode that are shown at most.
const MAX_PERIODS: f64 = 40.0;
/// Points of a response.
const N_POINTS: usize = 1201;
/// Norm below which the approximant is exact to rounding.
const PADE_RADIUS: f64 = 5.37;

/// Response of one output to a unit step of one input at time 0, from rest at the operating point; made by
/// [`StateSpace::step_response`].
///
/// ```
/// use sincro_analysis::prelude::*;
///
/// # fn main() -> Result<(), LinearError> {
/// // ω = 2 rad/s, ζ = 0.5: overshoot exp(−π ζ/√(1 − ζ²)) = 16.3 %
/// let a = DMatrix::from_row_slice(2, 2, &[0.0, 1.0, -4.0, -2.0]);
/// let (b, c) = (DMatrix::from_row_slice(2, 1, &[0.0, 4.0]), DMatrix::from_row_slice(1, 2, &[1.0, 0.0]));
/// let response: StepResponse = StateSpace::from_matrices(a, b, c, DMatrix::zeros(1, 1))?.step_response(0, 0, None);
/// assert!((response.final_value.unwrap() - 1.0).abs() < 1e-12);
/// let overshoot = f64::exp(-std::f64::consts::PI * 0.5 / f64::sqrt(0.75));
/// assert!((response.info.unwrap().overshoot - overshoot).abs() < 1e-4);
/// # Ok(())
/// # }
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct StepResponse {
    /// Times since the step, ascending and evenly spaced from 0 `[s]`.
    pub times: Vec<f64>,
    /// Output at each time, as difference from the operating point `[unit of the output / unit of the input]`.
    pub values: Vec<f64>,
    /// Final value, in the unit of `values`; `None` if the channel is not stable.
    pub final_value: Option<f64>,
    /// Characteristics of the response; `None` if it has no final value, settles at zero, or does not settle within
    /// `times`.
    pub info: Option<StepInfo>,
}

/// Characteristics of a step response that settles, relative to its final value; see [`StepResponse::info`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StepInfo {
    /// Rise time from 10 % to 90 % of the final value `[s]`.
    pub rise_time: f64,
    /// Settling time, after which the response stays within 2 % of the final value `[s]`.
    pub settling_time: f64,
    /// Overshoot beyond the final value, relative to it (0.1 is 10 %); 0 if there is none.
    pub overshoot: f64,
    /// Time of the response's peak, the largest value in the direction of the final one `[s]`.
    pub peak_time: f64,
}

impl StateSpace {
    /// Returns a duration that shows the step response `[s]`, rounded up: six time constants of the slowest decaying
    /// mode (40 periods of an oscillation at most), or three of the fastest growing one; 10 s if nothing moves. Of a
    /// sampled system a multiple of its sample time.
    #[must_use]
    pub fn step_duration(&self) -> f64 {
        let poles = self.poles();
        let fastest = poles.iter().map(|mode| mode.natural_frequency).fold(0.0, f64::max);
        let stays = |mode: &Mode| mode.natural_frequency <= 1e-8 * fastest.max(1.0);
        let moving: Vec<Mode> = poles.iter().copied().filter(|mode| !stays(mode)).collect();
        let growth = moving.iter().filter(|mode| mode.time_constant < 0.0).map(|mode| -mode.time_constant);
        let longest = match growth.reduce(f64::min) {
            Some(grows) => GROWN * grows,
            None => moving.iter().map(settled).fold(0.0, f64::max),
        };
        let longest = if longest > 0.0 { longest } else { 10.0 };
        match self.sample_time {
            None => rounded_up(longest),
            Some(tick) => (longest / tick).ceil().max(10.0) * tick,
        }
    }

    /// Returns the response of output `output` to a unit step of input `input` (indices from 0) over `duration` `[s]`;
    /// `None`: over [`StateSpace::step_duration`]. A continuous system is evaluated at 1201 times, exactly at each; a
    /// sampled one at its samples, at most 100 000 of them.
    ///
    /// # Panics
    ///
    /// If `input` or `output` is no index of an input or output.
    ///
    /// ```
    /// use sincro_analysis::prelude::*;
    ///
    /// # fn main() -> Result<(), LinearError> {
    /// // a lag of 0.5 s: y = 1 − exp(−t/0.5)
    /// let one = DMatrix::identity(1, 1);
    /// let lag = StateSpace::from_matrices(-2.0 * &one, 2.0 * &one, one.clone(), 0.0 * &one)?;
    /// let response = lag.step_response(0, 0, Some(1.0)); // over 1 s
    /// for (t, y) in response.times.iter().zip(&response.values) {
    ///     assert!((y - (1.0 - f64::exp(-t / 0.5))).abs() < 1e-12);
    /// }
    /// # Ok(())
    /// # }
    /// ```
    #[must_use]
    pub fn step_response(&self, input: usize, output: usize, duration: Option<f64>) -> StepResponse {
        let duration = duration.unwrap_or_else(|| self.step_duration());
        let n = self.n_states();
        let (n_points, step, phi, gamma) = match self.sample_time {
            Some(tick) => {
                let n_points = ((duration / tick).round() as usize).min(100_000) + 1;
                (n_points, tick, self.a.clone(), self.b.column(input).into_owned())
            }
            None => {
                let step = duration / (N_POINTS - 1) as f64;
                let mut augmented = DMatrix::zeros(n + 1, n + 1);
                augmented.view_mut((0, 0), (n, n)).copy_from(&(&self.a * step));
                augmented.view_mut((0, n), (n, 1)).copy_from(&(self.b.column(input) * step));
                let whole = exponential(&augmented);
                (
                    N_POINTS,
                    step,
                    whole.view((0, 0), (n, n)).into_owned(),
                    whole.view((0, n), (n, 1)).column(0).into_owned(),
                )
            }
        };
        let mut x = DVector::zeros(n);
        let mut response = StepResponse { times: Vec::new(), values: Vec::new(), final_value: None, info: None };
        for k in 0..n_points {
            response.times.push(step * k as f64);
            response.values.push(self.c.row(output).transpose().dot(&x) + self.d[(output, input)]);
            x = &phi * x + &gamma;
        }
        response.final_value = if self.minimal(input, output).is_stable() { self.gain(input, output) } else { None };
        response.info = response.final_value.and_then(|end| info(&response, end));
        response
    }
}

/// Settling time of a mode, or the time over which it is drawn.
fn settled(mode: &Mode) -> f64 {
    let period = std::f64::consts::TAU / mode.natural_frequency;
    let decay = if mode.time_constant.is_finite() { SETTLED * mode.time_constant } else { f64::INFINITY };
    if mode.pole.im == 0.0 { decay } else { decay.min(MAX_PERIODS * period) }
}

/// The next of 1, 1.2, 1.5, 2, 2.5, 3, 4, 5, 6, 8 times a power of ten.
fn rounded_up(duration: f64) -> f64 {
    // exact powers of ten, from their decimal form
    let text = format!("{duration:e}");
    let power: i32 = text.split_once('e').and_then(|(_, digits)| digits.parse().ok()).unwrap_or(0);
    let decimal = |mantissa: f64| format!("{mantissa}e{power}").parse::<f64>().unwrap_or(duration);
    let nice = [1.0, 1.2, 1.5, 2.0, 2.5, 3.0, 4.0, 5.0, 6.0, 8.0, 10.0];
    nice.into_iter().map(decimal).find(|&candidate| candidate >= duration * (1.0 - 1e-12)).unwrap_or(duration)
}

fn info(response: &StepResponse, end: f64) -> Option<StepInfo> {
    (end != 0.0).then_some(())?;
    let share: Vec<f64> = response.values.iter().map(|value| value / end).collect();
    let at = |k: usize| response.times[k];
    // where the response first reaches a share, between the points
    let reaches = |level: f64| {
        let k = share.iter().position(|&s| s >= level)?;
        if k == 0 {
            return Some(at(0));
        }
        let part = (level - share[k - 1]) / (share[k] - share[k - 1]);
        Some(at(k - 1) + part * (at(k) - at(k - 1)))
    };
    let last_outside = share.iter().rposition(|s| (s - 1.0).abs() > 0.02);
    let settling_time = match last_outside {
        None => 0.0,
        Some(k) if k + 1 < share.len() => {
            let edge = if share[k] > 1.0 { 1.02 } else { 0.98 };
            at(k) + (edge - share[k]) / (share[k + 1] - share[k]) * (at(k + 1) - at(k))
        }
        Some(_) => return None,
    };
    let mut peak = 0;
    for k in 1..share.len() {
        if share[k] > share[peak] {
            peak = k;
        }
    }
    Some(StepInfo {
        rise_time: reaches(0.9)? - reaches(0.1)?,
        settling_time,
        overshoot: (share[peak] - 1.0).max(0.0),
        peak_time: at(peak),
    })
}

/// Returns the matrix exponential `exp(M)`, `n×n`, of a square, dimensionless `M` with finite entries: `exp(A t)` maps
/// the state of `ẋ = A x` over the time `t`. Padé approximant of degree 13 of `M / 2ˢ`, squared s times.
///
/// # Panics
///
/// If the matrix is not square.
#[must_use]
pub fn exponential(m: &DMatrix<f64>) -> DMatrix<f64> {
    const B: [f64; 14] = [
        64_764_752_532_480_000.0,
        32_382_376_266_240_000.0,
        7_771_770_303_897_600.0,
        1_187_353_796_428_800.0,
        129_060_195_264_000.0,
        10_559_470_521_600.0,
        670_442_572_800.0,
        33_522_128_640.0,
        1_323_241_920.0,
        40_840_800.0,
        960_960.0,
        16_380.0,
        182.0,
        1.0,
    ];
    let n = m.nrows();
    let size = m.column_iter().map(|column| column.lp_norm(1)).fold(0.0, f64::max);
    let (mut halvings, mut scale) = (0, 1.0);
    while size * scale > PADE_RADIUS {
        (halvings, scale) = (halvings + 1, 0.5 * scale);
    }
    let m = m * scale;
    let identity = DMatrix::<f64>::identity(n, n);
    let m2 = &m * &m;
    let m4 = &m2 * &m2;
    let m6 = &m4 * &m2;
    let high = |k: usize| &m6 * (&m6 * B[k + 12] + &m4 * B[k + 10] + &m2 * B[k + 8]);
    let low = |k: usize| &m6 * B[k + 6] + &m4 * B[k + 4] + &m2 * B[k + 2] + &identity * B[k];
    let odd = &m * (high(1) + low(1));
    let even = high(0) + low(0);
    let mut result = (&even - &odd).lu().solve(&(&even + &odd)).expect("the denominator is regular within the radius");
    for _ in 0..halvings {
        result = &result * &result;
    }
    result
}
