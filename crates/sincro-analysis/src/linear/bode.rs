//! Frequency response: magnitude, phase that does not jump, margins. Cost: one complex decomposition a frequency, for
//! all channels together ([`StateSpace::frequency_responses`]) or for one.
//!
//! `G(jω) = C (jω I − A)⁻¹ B + D`. The phase is known from `G` up to whole turns; the turns come from the poles and
//! zeros, each of which adds its own angle of at most a quarter turn (key `ogata2010`, 7-2): an undamped pair turns the
//! phase by −180° and not by +180°, however coarse the grid is.

use std::f64::consts::{PI, TAU};

use sincro_math::elementary::{atan, atan2, exp, ln, log10, sin_cos};

use super::modes::eigenvalues;
use super::{Complex, DMatrix, DVector, LinearError, StateSpace, modulus};

/// Frequencies a decade.
const PER_DECADE: usize = 60;
/// More decades than this are not shown; the slow end is cut.
const MAX_DECADES: f64 = 12.0;
/// A pole below this share of A is taken as zero: rounding scatters multiple ones that far.
const NOTHING: f64 = 1e-8;
/// Halvings of a bracket around a crossover.
const HALVINGS: usize = 60;

/// Frequency response of one channel, one input to one output, over a grid of frequencies, with its stability margins:
/// the data of a Bode plot. Made by [`StateSpace::bode`] and [`StateSpace::bode_at`]; the first three lists have one
/// entry per frequency.
///
/// ```
/// use sincro_analysis::prelude::*;
///
/// # fn main() -> Result<(), LinearError> {
/// // an integrator with a lag of 1 s: G = 1/(s (s + 1))
/// let a = DMatrix::from_row_slice(2, 2, &[0.0, 1.0, 0.0, -1.0]);
/// let (b, c) = (DMatrix::from_row_slice(2, 1, &[0.0, 1.0]), DMatrix::from_row_slice(1, 2, &[1.0, 0.0]));
/// let bode: Bode = StateSpace::from_matrices(a, b, c, DMatrix::zeros(1, 1))?.bode(0, 0)?;
/// assert!((bode.phase_margin().unwrap().value - 51.827).abs() < 1e-3); // [°]
/// assert!(bode.gain_margin().is_none()); // the phase never reaches −180°
/// # Ok(())
/// # }
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Bode {
    /// Angular frequencies, ascending `[rad/s]`.
    pub omega: Vec<f64>,
    /// Magnitude `20 log₁₀ |G|` at each frequency `[dB]`, `G` in unit of the output per unit of the input; −∞ at a
    /// zero.
    pub magnitude_db: Vec<f64>,
    /// Phase `arg G` at each frequency, unwrapped (without jumps of whole turns) `[°]`.
    pub phase_deg: Vec<f64>,
    /// Gain margins `−20 log₁₀ |G|` `[dB]` at all frequencies of the grid's range with phase −180° (mod 360°),
    /// ascending in frequency: the factor by which `|G|` may grow until the loop closed by −1 oscillates. Empty if
    /// there is none.
    pub gain_margins: Vec<Margin>,
    /// Phase margins `180° + arg G`, in (−180°, 180°] `[°]`, at all frequencies with `|G| = 1`, ascending in frequency:
    /// the angle by which the phase may fall until the loop closed by −1 oscillates. Empty if there is none.
    pub phase_margins: Vec<Margin>,
}

/// Gain or phase margin at one crossover frequency, an entry of [`Bode::gain_margins`] or [`Bode::phase_margins`].
///
/// ```
/// use sincro_analysis::prelude::*;
///
/// # fn main() -> Result<(), LinearError> {
/// // three lags: G = 1/(s + 1)³ reaches −180° at √3 rad/s with |G| = 1/8
/// let a = DMatrix::from_row_slice(3, 3, &[-1.0, 1.0, 0.0, 0.0, -1.0, 1.0, 0.0, 0.0, -1.0]);
/// let (b, c) = (DMatrix::from_row_slice(3, 1, &[0.0, 0.0, 1.0]), DMatrix::from_row_slice(1, 3, &[1.0, 0.0, 0.0]));
/// let bode = StateSpace::from_matrices(a, b, c, DMatrix::zeros(1, 1))?.bode(0, 0)?;
/// let margin: Margin = bode.gain_margin().unwrap();
/// assert!((margin.omega - f64::sqrt(3.0)).abs() < 1e-6); // [rad/s]
/// assert!((margin.value - 20.0 * f64::log10(8.0)).abs() < 1e-6); // [dB]
/// # Ok(())
/// # }
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Margin {
    /// Crossover frequency `[rad/s]`.
    pub omega: f64,
    /// Gain margin `[dB]` or phase margin `[°]`; negative where the limit of stability is passed already.
    pub value: f64,
}

impl Bode {
    /// Returns the gain margin of least magnitude `[dB]`, usually quoted as *the* gain margin; `None` if the phase
    /// crosses −180° nowhere in the range of frequencies.
    #[must_use]
    pub fn gain_margin(&self) -> Option<Margin> {
        tightest(&self.gain_margins)
    }

    /// Returns the phase margin of least magnitude `[°]`, usually quoted as *the* phase margin; `None` if `|G|` crosses
    /// 1 nowhere in the range of frequencies.
    #[must_use]
    pub fn phase_margin(&self) -> Option<Margin> {
        tightest(&self.phase_margins)
    }
}

fn tightest(margins: &[Margin]) -> Option<Margin> {
    margins.iter().copied().min_by(|a, b| a.value.abs().total_cmp(&b.value.abs()))
}

impl StateSpace {
    /// Returns `G(jω)` from one input to one output at each of `omegas` `[rad/s]`, in their order, in unit of the
    /// output per unit of the input; of a sampled system `G(exp(jω T))`. Both parts are NaN exactly at a pole.
    ///
    /// # Panics
    ///
    /// If `input` is not below [`StateSpace::n_inputs`] or `output` not below [`StateSpace::n_outputs`].
    #[must_use]
    pub fn frequency_response(&self, input: usize, output: usize, omegas: &[f64]) -> Vec<Complex<f64>> {
        let channel = Channel::new(self, input, output);
        omegas.iter().map(|&omega| channel.at(omega)).collect()
    }

    /// Returns `G(jω)` of all channels at each of `omegas` `[rad/s]`, in their order: a matrix each, one row an output
    /// and one column an input, in units of outputs per unit of inputs; the numbers of
    /// [`StateSpace::frequency_response`] for one decomposition a frequency.
    ///
    /// ```
    /// use sincro_analysis::prelude::*;
    ///
    /// # fn main() -> Result<(), LinearError> {
    /// let one = DMatrix::from_element(1, 1, 1.0);
    /// let lag = StateSpace::from_matrices(-&one, one.clone(), one, DMatrix::zeros(1, 1))?; // 1/(s + 1)
    /// let responses = lag.frequency_responses(&[1.0, 10.0]);
    /// assert_eq!(responses[1][(0, 0)], lag.frequency_response(0, 0, &[10.0])[0]);
    /// # Ok(())
    /// # }
    /// ```
    #[must_use]
    pub fn frequency_responses(&self, omegas: &[f64]) -> Vec<DMatrix<Complex<f64>>> {
        let complex = |x: f64| Complex::new(x, 0.0);
        let (b, c, d) = (self.b.map(complex), self.c.map(complex), self.d.map(complex));
        let at = |&omega: &f64| match self.pencil(omega) {
            None => d.clone(),
            Some(pencil) => match pencil.lu().solve(&b) {
                Some(x) => DMatrix::from_fn(c.nrows(), b.ncols(), |output, input| {
                    c.row(output).transpose().dot(&x.column(input)) + d[(output, input)]
                }),
                None => d.map(|_| Complex::new(f64::NAN, f64::NAN)),
            },
        };
        omegas.iter().map(at).collect()
    }

    /// `s I − A` at `s = jω`, of a sampled system at `exp(jω T)`; `None` without states.
    fn pencil(&self, omega: f64) -> Option<DMatrix<Complex<f64>>> {
        let s = match self.sample_time {
            None => Complex::new(0.0, omega),
            Some(tick) => {
                let (sine, cosine) = sin_cos(omega * tick);
                Complex::new(cosine, sine)
            }
        };
        let a = &self.a;
        (!a.is_empty()).then(|| {
            DMatrix::from_fn(a.nrows(), a.nrows(), |row, column| {
                let own = if row == column { s } else { Complex::new(0.0, 0.0) };
                own - a[(row, column)]
            })
        })
    }

    /// Returns the frequency response from input `input` to output `output` (indices from 0), from a decade below its
    /// poles and zeros to a decade above; of a sampled system up to the Nyquist frequency.
    ///
    /// # Errors
    ///
    /// [`LinearError::NoPath`]: the output does not depend on the input.
    ///
    /// # Panics
    ///
    /// If `input` or `output` is no index of an input or output.
    ///
    /// ```
    /// use sincro_analysis::prelude::*;
    ///
    /// # fn main() -> Result<(), LinearError> {
    /// // a low-pass with its corner at 10 rad/s: −3.01 dB and −45° there
    /// let one = DMatrix::identity(1, 1);
    /// let filter = StateSpace::from_matrices(-10.0 * &one, 10.0 * &one, one.clone(), 0.0 * &one)?;
    /// let bode = filter.bode_at(0, 0, &[10.0])?;
    /// assert!((bode.magnitude_db[0] + 10.0 * f64::log10(2.0)).abs() < 1e-12);
    /// assert!((bode.phase_deg[0] + 45.0).abs() < 1e-12);
    /// let all = filter.bode(0, 0)?; // over the frequencies that show it
    /// assert!(all.omega[0] < 2.0 && *all.omega.last().unwrap() > 50.0);
    /// # Ok(())
    /// # }
    /// ```
    pub fn bode(&self, input: usize, output: usize) -> Result<Bode, LinearError> {
        let corners = Corners::new(self, &eigenvalues(&self.a), &self.zeros(input, output)?);
        let omega = corners.grid();
        let values = self.frequency_response(input, output, &omega);
        Ok(corners.bode(&Channel::new(self, input, output), omega, values))
    }

    /// Returns the frequency response from input `input` to output `output` (indices from 0) at the frequencies
    /// `omega`, ascending `[rad/s]`. Crossovers, and so margins, are searched between neighbours of `omega` only.
    ///
    /// # Errors
    ///
    /// [`LinearError::NoPath`]: the output does not depend on the input.
    ///
    /// # Panics
    ///
    /// If `input` or `output` is no index of an input or output.
    pub fn bode_at(&self, input: usize, output: usize, omega: &[f64]) -> Result<Bode, LinearError> {
        let values = self.frequency_response(input, output, omega);
        self.bode_of(input, output, omega, values)
    }

    /// Returns what [`StateSpace::bode_at`] does, for the frequency response `values` at `omega`, of the same length;
    /// of several channels at the same frequencies it comes from [`StateSpace::frequency_responses`].
    ///
    /// # Errors
    ///
    /// [`LinearError::NoPath`]: the output does not depend on the input.
    ///
    /// # Panics
    ///
    /// If `input` or `output` is no index of an input or output.
    ///
    /// ```
    /// use sincro_analysis::prelude::*;
    ///
    /// # fn main() -> Result<(), LinearError> {
    /// let one = DMatrix::from_element(1, 1, 1.0);
    /// let lag = StateSpace::from_matrices(-&one, one.clone(), one, DMatrix::zeros(1, 1))?; // 1/(s + 1)
    /// let omega = [0.1, 1.0, 10.0];
    /// let values = lag.frequency_responses(&omega).iter().map(|g| g[(0, 0)]).collect();
    /// assert_eq!(lag.bode_of(0, 0, &omega, values)?, lag.bode_at(0, 0, &omega)?);
    /// # Ok(())
    /// # }
    /// ```
    pub fn bode_of(
        &self,
        input: usize,
        output: usize,
        omega: &[f64],
        values: Vec<Complex<f64>>,
    ) -> Result<Bode, LinearError> {
        let corners = Corners::new(self, &eigenvalues(&self.a), &self.zeros(input, output)?);
        Ok(corners.bode(&Channel::new(self, input, output), omega.to_vec(), values))
    }

    /// Returns a grid of angular frequencies that shows every pole and the zeros of every channel, ascending `[rad/s]`:
    /// evenly spaced in the logarithm, 60 per decade, denser near resonances. For [`StateSpace::frequency_response`]
    /// and [`StateSpace::bode_at`].
    #[must_use]
    pub fn frequencies(&self) -> Vec<f64> {
        let channels = (0..self.n_inputs()).flat_map(|i| (0..self.n_outputs()).map(move |o| (i, o)));
        let zeros: Vec<Complex<f64>> = channels.filter_map(|(i, o)| self.zeros(i, o).ok()).flatten().collect();
        Corners::new(self, &eigenvalues(&self.a), &zeros).grid()
    }
}

/// One input, one output, ready to be evaluated.
struct Channel<'a> {
    system: &'a StateSpace,
    b: DVector<Complex<f64>>,
    c: DVector<Complex<f64>>,
    d: f64,
}

impl<'a> Channel<'a> {
    fn new(system: &'a StateSpace, input: usize, output: usize) -> Self {
        let complex = |x: f64| Complex::new(x, 0.0);
        Self {
            system,
            b: system.b.column(input).map(complex),
            c: system.c.row(output).transpose().map(complex),
            d: system.d[(output, input)],
        }
    }

    fn at(&self, omega: f64) -> Complex<f64> {
        let Some(pencil) = self.system.pencil(omega) else { return Complex::new(self.d, 0.0) };
        match pencil.lu().solve(&self.b) {
            Some(x) => self.c.dot(&x) + self.d,
            None => Complex::new(f64::NAN, f64::NAN),
        }
    }
}

/// Poles and zeros as rates, with the real parts that are rounding taken away.
pub(super) struct Corners {
    poles: Vec<Complex<f64>>,
    zeros: Vec<Complex<f64>>,
    /// Half the sampling frequency `[rad/s]`.
    nyquist: Option<f64>,
}

impl Corners {
    pub(super) fn new(system: &StateSpace, poles: &[Complex<f64>], zeros: &[Complex<f64>]) -> Self {
        let size = system.a.norm();
        let rate = |&z: &Complex<f64>| match system.sample_time {
            None if modulus(z) <= NOTHING * size => Complex::new(0.0, 0.0),
            None if z.re.abs() <= NOTHING * size => Complex::new(0.0, z.im),
            None => z,
            Some(tick) => Complex::new(ln(modulus(z)).0 / tick, atan2(z.im, z.re).0 / tick),
        };
        Self {
            poles: poles.iter().map(rate).collect(),
            zeros: zeros.iter().map(rate).collect(),
            nyquist: system.sample_time.map(|tick| PI / tick),
        }
    }

    fn all(&self) -> impl Iterator<Item = Complex<f64>> {
        self.poles.iter().chain(&self.zeros).copied()
    }

    /// Whole decades that reach one beyond the corners.
    fn range(&self) -> (f64, f64) {
        let sizes = || self.all().map(modulus).filter(|size| *size > 1e-12 && size.is_finite());
        let (slow, fast) = (sizes().fold(f64::INFINITY, f64::min), sizes().fold(0.0, f64::max));
        let (slow, fast) = if fast > 0.0 { (slow, fast) } else { (1.0, 1.0) };
        let last = (log10(fast).0 - 1e-9).ceil() + 1.0;
        let first = ((log10(slow).0 + 1e-9).floor() - 1.0).max(last - MAX_DECADES);
        (power_of_ten(first), self.nyquist.unwrap_or_else(|| power_of_ten(last)))
    }

    fn bode(&self, channel: &Channel, omega: Vec<f64>, values: Vec<Complex<f64>>) -> Bode {
        let phase = if self.nyquist.is_some() { unwrapped(&values) } else { self.phases(&omega, &values) };
        Bode {
            magnitude_db: values.iter().map(|g| decibel(modulus(*g))).collect(),
            phase_deg: phase.into_iter().map(f64::to_degrees).collect(),
            gain_margins: gain_margins(channel, &omega, &values),
            phase_margins: phase_margins(channel, &omega, &values),
            omega,
        }
    }

    /// Even in the logarithm, with more points about each resonance.
    pub(super) fn grid(&self) -> Vec<f64> {
        let (first, last) = self.range();
        let decades = log10(last / first).0;
        let n = ((decades * PER_DECADE as f64).ceil() as usize).max(2);
        let ratio = ln(last / first).0;
        let mut omega: Vec<f64> = (0..=n).map(|k| first * exp(ratio * k as f64 / n as f64).0).collect();
        omega[n] = last;
        for corner in self.all().filter(|corner| corner.im > 0.0 && corner.re.abs() < 0.3 * corner.im) {
            let width = corner.re.abs().max(1e-4 * corner.im);
            for share in [0.12, 0.25, 0.5, 1.0, 2.0, 4.0] {
                omega.extend([corner.im - share * width, corner.im + share * width]);
            }
            // exactly at an undamped one there is no value
            if corner.re != 0.0 {
                omega.push(corner.im);
            }
        }
        omega.retain(|w| *w >= first && *w <= last);
        omega.sort_by(f64::total_cmp);
        omega.dedup();
        omega
    }

    /// The phase, with the turns that the corners say.
    fn phases(&self, omega: &[f64], values: &[Complex<f64>]) -> Vec<f64> {
        let turns: Vec<f64> = omega.iter().map(|&w| self.angle(w)).collect();
        let offset = self.sign_angle(&turns, values);
        let near = |(turn, g): (&f64, &Complex<f64>)| {
            let phase = atan2(g.im, g.re).0;
            phase + TAU * ((turn + offset - phase) / TAU).round()
        };
        turns.iter().zip(values).map(near).collect()
    }

    /// Sum of the angles of all factors: `1 − s/z` and `1 / (1 − s/p)`, or `s` and `1/s`.
    fn angle(&self, omega: f64) -> f64 {
        let of = |corner: &Complex<f64>| {
            let angle = match corner.re.abs() {
                0.0 if omega >= corner.im => 0.5 * PI,
                0.0 => -0.5 * PI,
                distance => atan((omega - corner.im) / distance).0,
            };
            if corner.re > 0.0 { -angle } else { angle }
        };
        self.zeros.iter().map(of).sum::<f64>() - self.poles.iter().map(of).sum::<f64>()
    }

    /// 0 or −180°: what is left of the phase once all factors are taken away, by majority over the grid.
    fn sign_angle(&self, turns: &[f64], values: &[Complex<f64>]) -> f64 {
        let agreement = |(turn, g): (&f64, &Complex<f64>)| {
            let (sine, cosine) = sin_cos(*turn);
            let size = modulus(*g);
            if size > 0.0 && size.is_finite() { (g.re * cosine + g.im * sine) / size } else { 0.0 }
        };
        if turns.iter().zip(values).map(agreement).sum::<f64>() >= 0.0 { 0.0 } else { -PI }
    }
}

/// The phase with each step the shortest way.
pub(super) fn unwrapped(values: &[Complex<f64>]) -> Vec<f64> {
    let mut phases: Vec<f64> = Vec::with_capacity(values.len());
    for g in values {
        let phase = atan2(g.im, g.re).0;
        // a real negative start counts as a lag
        let near = phases.last().copied().unwrap_or(-0.25 * PI);
        phases.push(phase + TAU * ((near - phase) / TAU).round());
    }
    phases
}

/// `20 log₁₀`.
pub(super) fn decibel(magnitude: f64) -> f64 {
    if magnitude == 0.0 { f64::NEG_INFINITY } else { 20.0 * log10(magnitude).0 }
}

fn power_of_ten(power: f64) -> f64 {
    format!("1e{power}").parse().unwrap_or(1.0)
}

fn gain_margins(channel: &Channel, omega: &[f64], values: &[Complex<f64>]) -> Vec<Margin> {
    // the negative real axis is crossed, perhaps just at a frequency of the grid; what stays on it up to rounding does
    // not cross
    let is_left = |g: &Complex<f64>| g.re < 0.0 && g.im.abs() > 1e-9 * g.re.abs();
    // of a sampled system G is real at half the sampling frequency
    let nyquist = channel.system.sample_time.map(|tick| PI / tick);
    let may = |a: &Complex<f64>, b: &Complex<f64>| match (is_left(a), is_left(b)) {
        (true, true) => true,
        (false, false) => false,
        _ => nyquist.is_none() && a.re < 0.0 && b.re < 0.0,
    };
    let mut found = crossings(channel, omega, values, |g| g.im, may);
    if let (Some(&last), Some(g)) = (omega.last(), values.last())
        && nyquist.is_some_and(|nyquist| (last - nyquist).abs() <= 1e-12 * nyquist)
        && g.re < 0.0
        && !is_left(g)
    {
        found.push(last);
    }
    found.into_iter().map(|w| Margin { omega: w, value: -decibel(modulus(channel.at(w))) }).collect()
}

fn phase_margins(channel: &Channel, omega: &[f64], values: &[Complex<f64>]) -> Vec<Margin> {
    let found = crossings(channel, omega, values, |g| modulus(*g) - 1.0, |_, _| true);
    let margin = |w: f64| {
        let g = channel.at(w);
        // the angle from −1 to G, which lies in (−180°, 180°]
        Margin { omega: w, value: atan2(-g.im, -g.re).0.to_degrees() }
    };
    found.into_iter().map(margin).collect()
}

/// Frequencies at which `of(G)` changes its sign, between neighbours that `may` cross.
fn crossings(
    channel: &Channel,
    omega: &[f64],
    values: &[Complex<f64>],
    of: impl Fn(&Complex<f64>) -> f64,
    may: impl Fn(&Complex<f64>, &Complex<f64>) -> bool,
) -> Vec<f64> {
    let mut found = Vec::new();
    for k in 1..omega.len() {
        let (before, after) = (of(&values[k - 1]), of(&values[k]));
        let changes = (before < 0.0) != (after < 0.0) && before.is_finite() && after.is_finite();
        if !changes || !may(&values[k - 1], &values[k]) {
            continue;
        }
        let (mut low, mut high) = (omega[k - 1], omega[k]);
        for _ in 0..HALVINGS {
            let middle = 0.5 * (low + high);
            if (of(&channel.at(middle)) < 0.0) == (before < 0.0) {
                low = middle;
            } else {
                high = middle;
            }
        }
        // at a pole the sign changes through infinity
        if may(&channel.at(low), &channel.at(high)) || modulus(channel.at(low)) < 1e6 {
            found.push(0.5 * (low + high));
        }
    }
    found
}
