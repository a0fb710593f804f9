//! Bracket of the instant of an event, closed by Chandrupatla's method: inverse quadratic interpolation where it
//! promises progress, else bisection; first by cubic Hermite interpolation where the rates of the zero crossing are
//! known at both ends.
//!
//! Which end of the bracket an instant belongs to is decided by the event itself; a value of the zero crossing only
//! guides the search, and where it is missing or has the wrong sign the bracket is bisected. Source: key
//! `chandrupatla1997`.

/// Maximum number of instants found by the rates: where these do not close the bracket, they mislead.
const MAX_BY_RATES: u32 = 8;

/// Value of a zero crossing, and its rate in units of the value per second; NaN where they are not known.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sample {
    /// Value: below zero before the event, above zero after it.
    pub value: f64,
    /// Rate.
    pub rate: f64,
}

impl From<f64> for Sample {
    fn from(value: f64) -> Self {
        Self { value, rate: f64::NAN }
    }
}

/// Instant with the value of the zero crossing and its rate, NaN if it is not known.
#[derive(Clone, Copy, Debug)]
struct Point {
    t: f64,
    value: f64,
    rate: f64,
}

impl Point {
    fn of(t: f64, Sample { value, rate }: Sample) -> Self {
        Self { t, value, rate }
    }
}

/// Bracket of the first instant at which an event has happened.
///
/// ```
/// use sincro_integrate::Bracket;
///
/// // the zero of t² − 2, between 1 s and 2 s, to 1e-12 s
/// let crossing = |t: f64| t * t - 2.0;
/// let mut bracket = Bracket::new((1.0, 2.0), (crossing(1.0), crossing(2.0)));
/// while bracket.width() > 1e-12 {
///     let t = bracket.next(1e-12);
///     bracket.take(t, crossing(t) >= 0.0, crossing(t));
/// }
/// assert!((bracket.after() - 2.0_f64.sqrt()).abs() < 1e-12); // [s]
/// ```
#[derive(Clone, Copy, Debug)]
pub struct Bracket {
    before: Point,
    after: Point,
    /// The end that the last instant replaced, and true if the last instant became `after`.
    replaced: Point,
    last_is_after: bool,
    n_taken: u32,
}

impl Bracket {
    /// Creates the bracket between an instant before the event and one after it `[s]`; `samples` of the zero crossing
    /// there: values below zero before, above zero after, NaN where unknown.
    #[must_use]
    pub fn new((before, after): (f64, f64), samples: (impl Into<Sample>, impl Into<Sample>)) -> Self {
        let (before, after) = (Point::of(before, samples.0.into()), Point::of(after, samples.1.into()));
        let replaced = Point { t: f64::NAN, value: f64::NAN, rate: f64::NAN };
        Self { before, after, replaced, last_is_after: true, n_taken: 0 }
    }

    /// First instant known to be before the event `[s]`.
    #[must_use]
    pub fn before(&self) -> f64 {
        self.before.t
    }

    /// Last instant known to be after the event `[s]`.
    #[must_use]
    pub fn after(&self) -> f64 {
        self.after.t
    }

    /// Length of the bracket `[s]`.
    #[must_use]
    pub fn width(&self) -> f64 {
        self.after.t - self.before.t
    }

    /// Instant to be looked at next `[s]`, at least half of `resolution` `[s]` away from both ends.
    #[must_use]
    pub fn next(&self, resolution: f64) -> f64 {
        let margin = (0.5 * resolution / self.width()).min(0.5);
        let share = self.interpolated_by_rates().or_else(|| self.interpolated());
        let share = share.unwrap_or(0.5).clamp(margin, 1.0 - margin);
        let (new, old) = self.ends();
        let t = new.t + share * (old.t - new.t);
        if t > self.before.t && t < self.after.t { t } else { 0.5 * (self.before.t + self.after.t) }
    }

    /// Takes the instant `t` `[s]`, which is after the event or not, with a sample of the zero crossing there, NaN if
    /// it is not known.
    pub fn take(&mut self, t: f64, is_after: bool, sample: impl Into<Sample>) {
        let end = if is_after { &mut self.after } else { &mut self.before };
        self.replaced = core::mem::replace(end, Point::of(t, sample.into()));
        self.last_is_after = is_after;
        self.n_taken += 1;
    }

    /// Changes the zero crossing to another one, with these samples at the ends of the bracket. Instants that were
    /// found by rates still count: crossings that alternate must not mislead the search for ever.
    pub fn change_crossing(&mut self, before: impl Into<Sample>, after: impl Into<Sample>) {
        self.before = Point::of(self.before.t, before.into());
        self.after = Point::of(self.after.t, after.into());
        self.replaced = Point::of(self.replaced.t, f64::NAN.into());
    }

    /// The end found last, and the other one.
    fn ends(&self) -> (Point, Point) {
        if self.last_is_after { (self.after, self.before) } else { (self.before, self.after) }
    }

    /// Zero of the cubic through values and rates at both ends, as a share of the way from the last end to the other
    /// one; none where they are not known, or where there is none. A zero crossing that begins above zero falls first.
    fn interpolated_by_rates(&self) -> Option<f64> {
        let Self { before, after, .. } = self;
        let falls_first = before.value >= 0.0 && before.rate < 0.0 && after.rate > 0.0;
        if !((before.value < 0.0 || falls_first) && after.value > 0.0 && self.n_taken < MAX_BY_RATES) {
            return None;
        }
        let (first, last) = (before.rate * self.width(), after.rate * self.width());
        // in a form whose rounding is as small near the end as near the start
        let cubic = |s: f64| {
            let left = 1.0 - s;
            left * left * ((1.0 + 2.0 * s) * before.value + s * first)
                + s * s * ((1.0 + 2.0 * left) * after.value - left * last)
        };
        let slope = |s: f64| {
            let left = 1.0 - s;
            6.0 * s * left * (after.value - before.value) + left * (1.0 - 3.0 * s) * first + s * (3.0 * s - 2.0) * last
        };
        let lowest = if falls_first { rise(0.0, slope)? } else { 0.0 };
        let zero = if cubic(lowest) > 0.0 { None } else { rise(lowest, cubic) }?;
        Some(if self.last_is_after { 1.0 - zero } else { zero })
    }

    /// Zero of the inverse parabola, or of the chord, as a share of the way from the last end to the other one; none
    /// where the values say nothing.
    fn interpolated(&self) -> Option<f64> {
        if !(self.before.value <= 0.0 && self.after.value > 0.0) {
            return None;
        }
        let (a, b) = self.ends();
        let c = self.replaced;
        if c.value.is_nan() {
            return Some(a.value / (a.value - b.value));
        }
        // Chandrupatla's criterion: the inverse parabola is monotonic in the bracket
        let xi = (a.t - b.t) / (c.t - b.t);
        let phi = (a.value - b.value) / (c.value - b.value);
        if !(phi * phi < xi && (1.0 - phi) * (1.0 - phi) < 1.0 - xi) {
            return None;
        }
        let alpha = (c.t - a.t) / (b.t - a.t);
        let quadratic = a.value / (b.value - a.value) * c.value / (b.value - c.value)
            + alpha * a.value / (c.value - a.value) * b.value / (c.value - b.value);
        quadratic.is_finite().then_some(quadratic)
    }
}

/// Zero between `low` and 1 of a function that is not above zero at `low` and above it at 1, from above, by bisection;
/// none where a value is missing.
fn rise(mut low: f64, function: impl Fn(f64) -> f64) -> Option<f64> {
    let mut high = 1.0;
    while high - low > f64::EPSILON * high {
        let middle = 0.5 * (low + high);
        if middle <= low || middle >= high {
            break;
        }
        match function(middle) {
            value if value > 0.0 => high = middle,
            value if value <= 0.0 => low = middle,
            _ => return None,
        }
    }
    Some(high)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn probes(f: impl Fn(f64) -> f64, shows: impl Fn(f64) -> bool, values: bool) -> (usize, f64) {
        let value = |t: f64| if values { f(t) } else { f64::NAN };
        let mut bracket = Bracket::new((0.0, 1.0), (value(0.0), value(1.0)));
        let mut count = 0;
        while bracket.width() > 1e-13 {
            let t = bracket.next(1e-13);
            bracket.take(t, shows(t), value(t));
            count += 1;
            assert!(count < 100, "no end");
        }
        (count, bracket.after())
    }

    #[test]
    fn smooth_crossings_take_few_probes() {
        let crossings: [fn(f64) -> f64; 4] =
            [|t| t * t - 0.3, |t| 1.0 / (1.2 - t) - 2.0, |t| t - 0.987, |t| (t - 0.5).powi(3) + (t - 0.5) * 1e-3];
        for f in crossings {
            let (count, root) = probes(f, |t| f(t) > 0.0, true);
            assert!(count <= 14, "{count}");
            assert!(f(root) > 0.0 && f(root - 2e-13) <= 0.0);
        }
    }

    #[test]
    fn rates_take_a_few_probes_less() {
        type Function = fn(f64) -> f64;
        let crossings: [(Function, Function); 3] = [
            (|t| t * t - 0.3 + 0.1 * t, |t| 2.0 * t + 0.1),
            (|t| 1.0 / (1.2 - t) - 2.0, |t| 1.0 / (1.2 - t) / (1.2 - t)),
            (|t| t - 0.987, |_| 1.0),
        ];
        for (f, rate) in crossings {
            let sample = |t: f64| Sample { value: f(t), rate: rate(t) };
            let mut bracket = Bracket::new((0.0, 1.0), (sample(0.0), sample(1.0)));
            let mut count = 0;
            while bracket.width() > 1e-13 {
                let t = bracket.next(1e-13);
                bracket.take(t, f(t) > 0.0, sample(t));
                count += 1;
            }
            assert!(count <= 6, "{count}");
            assert!(f(bracket.after()) > 0.0 && f(bracket.after() - 2e-13) <= 0.0);
        }
        // one that begins at zero and falls first
        let sample = |t: f64| Sample { value: t * (t - 0.7), rate: 2.0 * t - 0.7 };
        let mut bracket = Bracket::new((0.0, 1.0), (sample(0.0), sample(1.0)));
        let t = bracket.next(1e-13);
        assert!((t - 0.7).abs() < 1e-12, "{t}");
        bracket.take(t, t > 0.7, sample(t));
        // one that begins above zero, falls below it and comes back
        let sample = |t: f64| Sample { value: (t - 0.1) * (t - 0.7), rate: 2.0 * t - 0.8 };
        let bracket = Bracket::new((0.0, 1.0), (sample(0.0), sample(1.0)));
        assert!((bracket.next(1e-13) - 0.7).abs() < 1e-12, "{}", bracket.next(1e-13));
        // and one that only comes near it: the middle, as if nothing were known
        let sample = |t: f64| Sample { value: 1.0 + t * (t - 0.7), rate: 2.0 * t - 0.7 };
        assert!((Bracket::new((0.0, 1.0), (sample(0.0), sample(1.0))).next(1e-13) - 0.5).abs() < 1e-12);
        // wrong rates cost no more than so many probes
        let mut bracket = Bracket::new((0.0, 1.0), [-0.3, 0.7].map(|value| Sample { value, rate: 1e-3 }).into());
        let mut count = 0;
        while bracket.width() > 1e-13 {
            let t = bracket.next(1e-13);
            bracket.take(t, t > 0.3, Sample { value: t - 0.3, rate: 1e-3 });
            count += 1;
        }
        assert!(count <= 30, "{count}");
    }

    #[test]
    fn another_crossing_begins_the_search_anew() {
        let mut bracket = Bracket::new((0.0, 1.0), (-1.0, 1.0));
        bracket.take(0.5, true, f64::NAN);
        // t − 0.3, with its rate
        let sample = |t: f64| Sample { value: t - 0.3, rate: 1.0 };
        assert_eq!((bracket.before(), bracket.after()), (0.0, 0.5));
        bracket.change_crossing(sample(0.0), sample(0.5));
        assert!((bracket.next(1e-13) - 0.3).abs() < 1e-12, "{}", bracket.next(1e-13));
        // two that alternate, whose rates say that the event is at the start
        let misleading = |value: f64| Sample { value, rate: 1e9 };
        let mut count = 0;
        while bracket.width() > 1e-13 {
            let t = bracket.next(1e-13);
            bracket.take(t, t > 0.2, misleading(t - 0.2));
            bracket.change_crossing(misleading(-0.2), misleading(t.max(0.2)));
            count += 1;
            assert!(count <= 100, "no end");
        }
    }

    #[test]
    fn event_decides_where_values_are_missing_or_wrong() {
        assert_eq!(probes(|t| t, |t| t > 0.4, false).0, 44);
        let (count, root) = probes(|t| t - 0.7, |t| t > 0.4, true);
        assert!(count <= 100 && (root - 0.4).abs() < 1e-12);
    }
}
