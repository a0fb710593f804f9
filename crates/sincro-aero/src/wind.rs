//! Wind: the velocity of the air as a function of time and height, and of nothing else.
//!
//! There is no state and no filter: the same instant has the same wind, whichever step or order asks for it, so
//! integrators may go back, and a snapshot needs nothing of it. An instant ([`Wind::at`]) costs a few operations, with
//! turbulence 192 sines; a place in it a few operations more.
//!
//! Source: key `mil-f-8785c`, section 3.7: logarithmic shear, discrete gust of 1 − cosine, Dryden's spectra at low
//! altitude.
//!
//! **Turbulence.** Dryden's spectra, each with ∫₀^∞ Φ dω = σ²,
//!
//! Φu(ω) = σu² (2/π)(Lu/V) / (1 + x²), x = Lu ω/V;
//! Φv(ω) = σv² (1/π)(Lv/V)(1 + 3x²)/(1 + x²)², x = Lv ω/V; Φw likewise with Lw,
//!
//! are not filtered out of noise here but summed: [`N_HARMONICS`] cosines of equal variance σ²/N and random phase.
//! Their frequencies divide the spectrum into N parts of equal area, one drawn at random in each, so that nothing
//! repeats with a period. The band ends at x = [`BAND`]; the tail beyond it, 0.6 % (u) and 1.0 % (v, w) of the
//! variance, is moved into the band, so that the variance is σ² exactly. Autocorrelations are σu² e^{−r} and σv²
//! e^{−r}(1 − r/2), with r = Vτ/L, to within about 1/N.
//!
//! | symbol | meaning | unit |
//! |---|---|---|
//! | u, v, w | turbulence along the mean wind, across it, upwards | m/s |
//! | σu, σv, σw | standard deviations | m/s |
//! | Lu, Lv, Lw | lengths | m |
//! | V | velocity at which the vehicle crosses the frozen turbulence | m/s |
//! | W₂₀ | mean wind at 20 feet (6.1 m) | m/s |
//! | h | height | m (feet in the source's formulas) |

use core::f64::consts::{PI, TAU};

use sincro_math::elementary::{atan, ln, pow, sin_cos};
use sincro_math::lanes::dispatch_lanes;
use sincro_math::random::SplitMix64;
use sincro_math::{LaneVisitor, Real};

use sincro_geometry::spatial::Vec3;
use sincro_math::error::InvalidParameters;

/// Profile of the mean wind over the height above ground (z of the world): a factor on the mean velocity of a [`Wind`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Profile {
    /// The same at every height.
    Constant,
    /// Proportional to the height above ground, zero below it.
    Linear {
        /// Height at which the factor is 1 `[m]`, positive.
        reference: f64,
    },
    /// Proportional to ln(height/roughness); zero at heights below the roughness.
    Logarithmic {
        /// Height at which the factor is 1 `[m]`, above the roughness.
        reference: f64,
        /// Roughness length of the ground `[m]`, positive: 0.046 in the source for approach and landing, 0.61
        /// elsewhere.
        roughness: f64,
    },
}

/// Discrete gust of the form 1 − cosine: peak·(1 − cos(π s))/2, s the time since its start over the rise time. Added to
/// the mean wind by [`Wind::new`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Gust {
    /// Time at which it begins `[s]`.
    pub start: f64,
    /// Time from the start to the peak `[s]`, positive.
    pub rise: f64,
    /// Velocity of the air at the peak `[m/s]`, in world axes (x, y, z).
    pub peak: [f64; 3],
    /// True if it stays at its peak, as in the source; otherwise it falls as it rose and ends after twice the rise
    /// time.
    pub holds: bool,
}

/// Standard deviations and length scales of turbulence, computed or given; field of a [`TurbulenceSpec`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Scales {
    /// Those of [`dryden_scales`], for flight near the ground.
    LowAltitude {
        /// Mean wind at 20 feet (6.1 m), W₂₀ `[m/s]`, 0 to 1000.
        wind_at_20_feet: f64,
        /// Height h `[m]`, 3.048 to 304.8; the scales are those of this height wherever the wind is evaluated.
        height: f64,
    },
    /// Given numbers, in the order u (along the mean wind), v (across it), w (upwards).
    Given {
        /// Standard deviations σu, σv, σw `[m/s]`, 0 to 1000.
        deviations: [f64; 3],
        /// Length scales Lu, Lv, Lw `[m]`, 0.001 to 1e6.
        lengths: [f64; 3],
    },
}

impl Scales {
    /// Standard deviations `[m/s]` and length scales `[m]`, each in the order u (along the mean wind), v (across), w
    /// (up).
    #[must_use]
    pub fn values(&self) -> ([f64; 3], [f64; 3]) {
        match *self {
            Self::LowAltitude { wind_at_20_feet, height } => dryden_scales(wind_at_20_feet, height),
            Self::Given { deviations, lengths } => (deviations, lengths),
        }
    }
}

/// Dryden turbulence to be added to a [`Wind`]: seed, scales and airspeed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TurbulenceSpec {
    /// Seed of the frequencies and phases: each seed is another sample of the same spectra.
    pub seed: u64,
    /// Standard deviations and length scales.
    pub scales: Scales,
    /// Speed V `[m/s]`, 0.001 to 1000, at which the vehicle crosses the turbulence: its velocity relative to the air,
    /// for a hovering vehicle that of the mean wind. Of a convected field it must be [`horizontal_speed`] of the mean
    /// wind, because a vehicle that moves crosses the field by itself.
    pub airspeed: f64,
    /// True if the turbulence is a frozen field that the horizontal mean wind carries past, so that places along the
    /// wind see it one after the other; otherwise it is the same at all places.
    pub convected: bool,
}

/// Number of harmonics in each turbulence component (u, v, w); more of them follow the spectrum closer, at proportional
/// cost.
pub const N_HARMONICS: usize = 64;

// whole bundles of lanes
const _: () = assert!(N_HARMONICS.is_multiple_of(8));

/// End of the turbulence band, as a multiple of the corner frequency V/L (dimensionless): no harmonic has a frequency
/// above `BAND`·V/L `[rad/s]`.
pub const BAND: f64 = 100.0;

/// Times closer than this are the same instant `[s]`.
const SAME_INSTANT: f64 = 1e-9;

/// Relative difference of two velocities that is put down to rounding.
const SAME_SPEED: f64 = 1e-9;

/// Magnitude `[m/s]` of the horizontal part (x, y) of a `mean` wind velocity `[m/s]` in world axes, z up.
#[must_use]
pub fn horizontal_speed(mean: [f64; 3]) -> f64 {
    (mean[0] * mean[0] + mean[1] * mean[1]).sqrt()
}

/// Velocity of the air over time and place: mean wind with a profile over the height, gusts and turbulence. Rotors and
/// drag elements of a model feel it (`ModelBuilder::wind`).
///
/// ```
/// use sincro_aero::wind::{Profile, Wind};
///
/// let shear = Profile::Logarithmic { reference: 6.096, roughness: 0.0457 };
/// let wind = Wind::new([5.0, 0.0, 0.0], shear, vec![], None).unwrap();
/// assert!((wind.velocity(0.0, 6.096)[0] - 5.0).abs() < 1e-12);
/// assert_eq!(wind.velocity(0.0, 0.01)[0], 0.0);
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Wind {
    mean: [f64; 3],
    profile: Profile,
    gusts: Vec<Gust>,
    turbulence: Option<Turbulence>,
}

#[derive(Clone, Debug, PartialEq)]
struct Turbulence {
    /// u, v, w
    components: [Component; 3],
    /// Cosine and sine of the mean wind's direction in the horizontal plane.
    along: (f64, f64),
    /// Velocity [m/s] at which the mean wind carries a frozen field; none if it is the same everywhere.
    convection: Option<f64>,
}

/// One component: amplitude·Σ cos(ωₖ t + φₖ).
#[derive(Clone, Debug, PartialEq)]
struct Component {
    amplitude: f64,
    /// ω `[rad/s]`
    frequencies: [f64; N_HARMONICS],
    /// φ `[rad]`
    phases: [f64; N_HARMONICS],
}

impl Wind {
    /// Creates a wind of velocity `mean` `[m/s]` (world axes, z up) at the reference height of `profile`, with gusts
    /// and turbulence added to it.
    ///
    /// # Errors
    ///
    /// [`InvalidParameters`] with one sentence for each number that is not finite or out of the range stated at its
    /// field, and for convected turbulence without a horizontal mean wind or with another airspeed than its own.
    pub fn new(
        mean: [f64; 3],
        profile: Profile,
        gusts: Vec<Gust>,
        turbulence: Option<TurbulenceSpec>,
    ) -> Result<Self, InvalidParameters> {
        let problems = problems(mean, profile, &gusts, turbulence);
        if !problems.is_empty() {
            return Err(InvalidParameters::new(problems));
        }
        let turbulence = turbulence.map(|spec| Turbulence::new(&spec, mean));
        Ok(Self { mean, profile, gusts, turbulence })
    }

    /// Velocity of the air `[m/s]` in world axes at time `t` `[s]`, at the place (0, 0, `height`) of the world `[m]`.
    #[must_use]
    #[inline(always)]
    pub fn velocity<R: Real>(&self, t: f64, height: R) -> Vec3<R> {
        self.at(t).velocity(height)
    }

    /// Wind at the instant `t` `[s]`, with gusts summed once: to be evaluated at several places.
    #[must_use]
    pub fn at(&self, t: f64) -> Air<'_> {
        let mut unsteady = [0.0; 3];
        for gust in &self.gusts {
            let share = gust.share(t);
            for (sum, peak) in unsteady.iter_mut().zip(gust.peak) {
                *sum += share * peak;
            }
        }
        // that of a frozen field is still open: it depends on the place
        let everywhere = self.turbulence.as_ref().filter(|turbulence| turbulence.convection.is_none());
        if let Some(turbulence) = everywhere {
            for (sum, part) in unsteady.iter_mut().zip(turbulence.velocity(t).0) {
                *sum += part;
            }
        }
        Air { wind: self, t, unsteady }
    }

    /// Height at which the mean wind has its given velocity `[m]`; `None` for a constant profile, where it has it
    /// everywhere.
    #[must_use]
    pub fn reference_height(&self) -> Option<f64> {
        match self.profile {
            Profile::Constant => None,
            Profile::Linear { reference } | Profile::Logarithmic { reference, .. } => Some(reference),
        }
    }

    /// Returns true if it has neither gusts nor turbulence, so that it does not depend on time.
    #[must_use]
    pub fn is_steady(&self) -> bool {
        self.gusts.is_empty() && self.turbulence.is_none()
    }

    /// Time of the next time event `[s]`: the first instant after `t` `[s]` at which a gust begins or ends, or one that
    /// holds reaches its peak; infinite if there is none. Steps of error-controlled methods end there.
    #[must_use]
    pub fn next_time_event(&self, t: f64) -> f64 {
        let ends = self.gusts.iter().flat_map(|g| [g.start, g.start + if g.holds { 1.0 } else { 2.0 } * g.rise]);
        ends.filter(|x| *x > t + SAME_INSTANT).fold(f64::INFINITY, f64::min)
    }
}

/// Wind at one instant, from [`Wind::at`]; gives the velocity of the air at any place.
#[derive(Clone, Copy, Debug)]
pub struct Air<'a> {
    wind: &'a Wind,
    /// The instant `[s]`.
    t: f64,
    /// Gusts, and turbulence that is the same everywhere `[m/s]`, world axes.
    unsteady: [f64; 3],
}

impl Air<'_> {
    /// Velocity of the air `[m/s]` in world axes, at the place (0, 0, `height`) of the world `[m]`.
    #[must_use]
    #[inline(always)]
    pub fn velocity<R: Real>(&self, height: R) -> Vec3<R> {
        self.velocity_at(Vec3([R::zero(), R::zero(), height]))
    }

    /// Velocity of the air `[m/s]` at the place `p` `[m]`, both in world axes; the height above ground is z of `p`.
    #[must_use]
    #[inline(always)]
    pub fn velocity_at<R: Real>(&self, p: Vec3<R>) -> Vec3<R> {
        let mean = Vec3::splat(self.wind.mean).scale(self.wind.profile.factor(p[2]));
        let everywhere = mean + Vec3::splat(self.unsteady);
        let field = self.wind.turbulence.as_ref().and_then(|field| Some((field, field.convection?)));
        let Some((field, speed)) = field else { return everywhere };
        // Taylor's hypothesis: what passes the origin at t passes a place s along the wind, of speed U, at t + s/U
        let (cos, sin) = field.along;
        let downstream = p[0] * R::splat(cos) + p[1] * R::splat(sin);
        everywhere + field.velocity(R::splat(self.t) - downstream * R::splat(1.0 / speed))
    }
}

impl Profile {
    /// Wind at `height` by that at the reference.
    #[inline(always)]
    fn factor<R: Real>(&self, height: R) -> R {
        match *self {
            Self::Constant => R::one(),
            Self::Linear { reference } => height.max(R::zero()) * R::splat(1.0 / reference),
            Self::Logarithmic { reference, roughness } => {
                let ratio = (height * R::splat(1.0 / roughness)).max(R::one());
                ratio.map(ln) * R::splat(1.0 / ln(reference / roughness).0)
            }
        }
    }
}

impl Gust {
    /// Part of the peak at time `t`, 0 to 1.
    fn share(&self, t: f64) -> f64 {
        let s = (t - self.start) / self.rise;
        let end = if self.holds { 1.0 } else { 2.0 };
        0.5 * (1.0 - sin_cos(PI * s.clamp(0.0, end)).1)
    }
}

/// Dryden scales at low altitude: standard deviations `[m/s]` and lengths `[m]`, each in the order u, v, w (along the
/// mean wind, across it, up), for the mean wind W₂₀ at 20 feet `[m/s]` and the height h `[m]`, 3.048 to 304.8.
///
/// σw = 0.1 W₂₀, σu = σv = σw/d^0.4, Lw = h, Lu = Lv = h/d^1.2, with d = 0.177 + 0.000823 h (here h in feet).
#[must_use]
pub fn dryden_scales(wind_at_20_feet: f64, height: f64) -> ([f64; 3], [f64; 3]) {
    const FOOT: f64 = 0.3048;
    let d = 0.177 + 0.000_823 * (height / FOOT);
    let (vertical, horizontal) = (0.1 * wind_at_20_feet, 0.1 * wind_at_20_feet / pow(d, 0.4).0);
    let length = height / pow(d, 1.2).0;
    ([horizontal, horizontal, vertical], [length, length, height])
}

impl Turbulence {
    fn new(spec: &TurbulenceSpec, mean: [f64; 3]) -> Self {
        let (deviations, lengths) = spec.scales.values();
        let mut random = SplitMix64::new(spec.seed);
        let components = core::array::from_fn(|k| {
            let area = if k == 0 { along_area } else { across_area };
            Component::new(deviations[k], spec.airspeed / lengths[k], area, &mut random)
        });
        let horizontal = horizontal_speed(mean);
        let along = if horizontal > 0.0 { (mean[0] / horizontal, mean[1] / horizontal) } else { (1.0, 0.0) };
        Self { components, along, convection: spec.convected.then_some(horizontal) }
    }

    /// In world axes at time `t`.
    #[inline(always)]
    fn velocity<R: Real>(&self, t: R) -> Vec3<R> {
        let [u, v, w] = &self.components;
        let (u, v, w) = (u.value(t), v.value(t), w.value(t));
        let (cos, sin) = (R::splat(self.along.0), R::splat(self.along.1));
        Vec3([cos * u - sin * v, sin * u + cos * v, w])
    }
}

/// Part of the variance of u below x: (2/π) atan x.
fn along_area(x: f64) -> f64 {
    2.0 / PI * atan(x).0
}

/// Part of the variance of v and w below x: (2 atan x − x/(1 + x²))/π.
fn across_area(x: f64) -> f64 {
    (2.0 * atan(x).0 - x / (1.0 + x * x)) / PI
}

impl Component {
    /// Standard deviation σ, corner frequency V/L [rad/s], and the part of the variance below x = ω/(V/L).
    fn new(deviation: f64, corner: f64, area: fn(f64) -> f64, random: &mut SplitMix64) -> Self {
        let share = area(BAND) / N_HARMONICS as f64;
        // each cosine has half the square of its amplitude as variance
        let amplitude = deviation * (2.0 / N_HARMONICS as f64).sqrt();
        let mut new = Self { amplitude, frequencies: [0.0; N_HARMONICS], phases: [0.0; N_HARMONICS] };
        for (k, (frequency, phase)) in new.frequencies.iter_mut().zip(&mut new.phases).enumerate() {
            *frequency = corner * inverse(area, share * (k as f64 + random.unit()));
            *phase = TAU * random.unit();
        }
        new
    }

    fn value<R: Real>(&self, t: R) -> R {
        t.map(|t| dispatch_lanes(Harmonics { component: self, t }))
    }
}

/// A component at an instant `[s]`, with its rate of change: its harmonics side by side in lanes, then summed one after
/// the other, so that the sum is the same on every processor.
struct Harmonics<'a> {
    component: &'a Component,
    t: f64,
}

impl LaneVisitor for Harmonics<'_> {
    type Output = (f64, f64);

    #[inline(always)]
    fn visit<R: Real>(self) -> (f64, f64) {
        let Component { amplitude, frequencies, phases } = self.component;
        let [mut cosines, mut rates] = [[0.0; N_HARMONICS]; 2];
        let outputs = cosines.chunks_exact_mut(R::LANES).zip(rates.chunks_exact_mut(R::LANES));
        let inputs = frequencies.chunks_exact(R::LANES).zip(phases.chunks_exact(R::LANES));
        for ((frequencies, phases), (cosines, rates)) in inputs.zip(outputs) {
            let frequency = R::from_row(frequencies);
            let (sin, cos) = (frequency * R::splat(self.t) + R::from_row(phases)).sin_cos();
            cos.to_row(cosines);
            (-(frequency * sin)).to_row(rates);
        }
        let sum = |terms: &[f64; N_HARMONICS]| terms.iter().fold(0.0, |sum, term| sum + term);
        (amplitude * sum(&cosines), amplitude * sum(&rates))
    }
}

/// Inverse of the increasing function `area` at `wanted` on the band, by bisection to within a few bits.
fn inverse(area: fn(f64) -> f64, wanted: f64) -> f64 {
    let (mut low, mut high) = (0.0, BAND);
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if area(middle) < wanted {
            low = middle;
        } else {
            high = middle;
        }
    }
    0.5 * (low + high)
}

fn problems(mean: [f64; 3], profile: Profile, gusts: &[Gust], turbulence: Option<TurbulenceSpec>) -> Vec<String> {
    let mut out = Vec::new();
    let mut check = |is_good: bool, message: String| {
        if !is_good {
            out.push(message);
        }
    };
    check(mean.iter().all(|x| x.is_finite()), format!("the mean wind is {mean:?} m/s: expected finite numbers"));
    let positive = |x: f64| x > 0.0 && x.is_finite();
    match profile {
        Profile::Constant => {}
        Profile::Linear { reference } => {
            check(positive(reference), format!("`reference` is {reference} m: expected a positive height"));
        }
        Profile::Logarithmic { reference, roughness } => {
            check(positive(roughness), format!("`roughness` is {roughness} m: expected a positive length"));
            let is_above = positive(reference) && reference > roughness;
            check(is_above, format!("`reference` is {reference} m: expected a height above the roughness"));
        }
    }
    for (k, gust) in gusts.iter().enumerate() {
        let Gust { start, rise, peak, .. } = *gust;
        check(start.is_finite(), format!("gust {} has `start` {start} s: expected a finite number", k + 1));
        check(positive(rise), format!("gust {} has `rise` {rise} s: expected a positive number", k + 1));
        check(
            peak.iter().all(|x| x.is_finite()),
            format!("gust {} has `peak` {peak:?} m/s: expected finite numbers", k + 1),
        );
    }
    if let Some(TurbulenceSpec { scales, airspeed, convected, .. }) = turbulence {
        match scales {
            Scales::LowAltitude { wind_at_20_feet: w, height } => {
                let is_wind = (0.0..=1e3).contains(&w);
                check(is_wind, format!("`wind_at_20_feet` is {w} m/s: expected a number from 0 to 1000 m/s"));
                let is_low = (3.048..=304.8).contains(&height);
                check(is_low, format!("`height` is {height} m: the spectra hold from 3.048 to 304.8 m"));
            }
            Scales::Given { deviations, lengths } => {
                let is_good = deviations.iter().all(|x| (0.0..=1e3).contains(x));
                check(is_good, format!("`deviation` is {deviations:?} m/s: expected three numbers from 0 to 1000 m/s"));
                let is_good = lengths.iter().all(|x| (1e-3..=1e6).contains(x));
                check(is_good, format!("`length` is {lengths:?} m: expected three numbers from 0.001 to 1000000 m"));
            }
        }
        let horizontal = horizontal_speed(mean);
        let is_carried = !convected || horizontal > 0.0;
        check(is_carried, "`convected` needs a horizontal mean wind: without it nothing carries the field past".into());
        if is_carried {
            let is_slow = (1e-3..=1e3).contains(&airspeed);
            check(is_slow, format!("`airspeed` is {airspeed} m/s: expected a number from 0.001 to 1000 m/s"));
            let is_that_of_the_field = !convected || (airspeed - horizontal).abs() <= SAME_SPEED * horizontal;
            let expected = format!("the mean wind carries a convected field past at {horizontal} m/s: leave it out");
            check(is_that_of_the_field, format!("`airspeed` is {airspeed} m/s, but {expected}"));
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;
    use sincro_math::Dual;

    fn component() -> Component {
        Component::new(1.3, 0.7, across_area, &mut SplitMix64::new(5))
    }

    #[test]
    fn harmonics_in_lanes_have_the_bits_of_their_sum_one_by_one() {
        let component = component();
        for t in [0.0, 0.37, -12.5, 4_321.0, 1e9] {
            let mut sum = 0.0;
            for (frequency, phase) in component.frequencies.iter().zip(&component.phases) {
                sum += sin_cos(frequency * t + phase).1;
            }
            assert_eq!(component.value(t).to_bits(), (component.amplitude * sum).to_bits(), "{t}");
        }
    }

    #[test]
    fn rate_is_that_of_the_value() {
        let component = component();
        for t in [0.0, 0.37, 55.0] {
            let h = 1e-5;
            let rate = (component.value(t + h) - component.value(t - h)) / (2.0 * h);
            let [found] = component.value(Dual::<1>::variable(t, 0)).partials;
            assert!((found - rate).abs() < 1e-7 * (1.0 + rate.abs()), "{found} {rate}");
        }
    }
}
