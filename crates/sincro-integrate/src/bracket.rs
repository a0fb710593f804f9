//! Bracket of the instant of an event, closed by Chandrupatla's method: inverse quadratic interpolation where it
//! promises progress, else bisection.
//!
//! Which end of the bracket an instant belongs to is decided by the event itself; a value of the zero crossing only
//! guides the search, and where it is missing or has the wrong sign the bracket is bisected. Source: key
//! `chandrupatla1997`.

/// Instant with the value of the zero crossing, NaN if it is not known.
#[derive(Clone, Copy, Debug)]
struct Point {
    t: f64,
    value: f64,
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
}

impl Bracket {
    /// Creates the bracket between an instant before the event and one after it `[s]`; `values` of the zero crossing
    /// there: below zero before, above zero after, NaN where unknown.
    #[must_use]
    pub fn new((before, after): (f64, f64), values: (f64, f64)) -> Self {
        let [before, after] = [(before, values.0), (after, values.1)].map(|(t, value)| Point { t, value });
        Self { before, after, replaced: Point { t: f64::NAN, value: f64::NAN }, last_is_after: true }
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
        let share = self.interpolated().unwrap_or(0.5).clamp(margin, 1.0 - margin);
        let (new, old) = self.ends();
        let t = new.t + share * (old.t - new.t);
        if t > self.before.t && t < self.after.t { t } else { 0.5 * (self.before.t + self.after.t) }
    }

    /// Takes the instant `t` `[s]`, which is after the event or not, with the value of the zero crossing there, NaN if
    /// it is not known.
    pub fn take(&mut self, t: f64, is_after: bool, value: f64) {
        let end = if is_after { &mut self.after } else { &mut self.before };
        self.replaced = core::mem::replace(end, Point { t, value });
        self.last_is_after = is_after;
    }

    /// Forgets the values: the zero crossing is another one, with the value `value_after` at the end of the bracket.
    pub fn forget(&mut self, value_after: f64) {
        self.before.value = f64::NAN;
        self.replaced.value = f64::NAN;
        self.after.value = value_after;
    }

    /// The end found last, and the other one.
    fn ends(&self) -> (Point, Point) {
        if self.last_is_after { (self.after, self.before) } else { (self.before, self.after) }
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
    fn event_decides_where_values_are_missing_or_wrong() {
        assert_eq!(probes(|t| t, |t| t > 0.4, false).0, 44);
        let (count, root) = probes(|t| t - 0.7, |t| t > 0.4, true);
        assert!(count <= 100 && (root - 0.4).abs() < 1e-12);
    }
}
