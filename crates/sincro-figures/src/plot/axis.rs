//! Division of an axis: nice ticks (1-2-5 times a power of ten), minor grid, labels that stay short.
//!
//! Tick values are integers times a power of ten, so no tick reads 0.30000000000000004. Numbers that would be long are
//! shortened by a common power of ten, which goes into the unit (`[10⁻⁹ rad]`), and numbers that differ
//! only far behind the point by a common offset, which goes into the label (`energy − 1234.5 J`).

use super::Axis;
use super::number::{exponent, fixed, log10, pow10, superscript};

/// Magnitudes outside `1/LARGEST … LARGEST` are not drawn, so that differences and quotients of ticks stay finite.
pub(super) const LARGEST: f64 = 1e280;
/// An axis of angles that spans less than this is divided in decimals `[°]`.
const DECIMAL_DEGREES: f64 = 25.0;
/// Numbers with more digits than this get an offset.
const MAX_DIGITS: i32 = 6;

/// A divided axis: maps values to fractions of its length.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Scale {
    /// Value (or its logarithm) at the start.
    low: f64,
    /// Value (or its logarithm) at the end; greater than `low`.
    high: f64,
    log: bool,
    /// Labelled ticks, ascending.
    pub(super) major: Vec<Tick>,
    /// Fractions of the fine grid lines, some of which coincide with labelled ones.
    pub(super) minor: Vec<f64>,
    /// The labels are multiples of ten to this power.
    power: i32,
    /// Offset that is subtracted in the labels, as text with sign; empty if there is none.
    offset: String,
    /// The same as a number.
    origin: f64,
}

/// A labelled tick.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Tick {
    /// Place along the axis, 0 to 1.
    pub(super) at: f64,
    /// Its label.
    pub(super) label: String,
}

impl Scale {
    /// Divides an axis so that it covers `range` and has at most about `max_ticks` labels. `None`: there are no data.
    pub(super) fn of(axis: &Axis, range: Option<(f64, f64)>, max_ticks: usize) -> Self {
        let range = match (axis.range, range) {
            (Some((a, b)), Some((low, high))) => Some((a.min(low), b.max(high))),
            (range, data) => range.or(data),
        };
        match range {
            Some((low, high)) if axis.degrees && high - low > DECIMAL_DEGREES && high - low < 1e6 => {
                Self::in_degrees((low, high), max_ticks.max(2))
            }
            _ => Self::new(range, axis.log, max_ticks),
        }
    }

    /// As [`Scale::of`], for an axis that is divided in decimals.
    fn new(range: Option<(f64, f64)>, log: bool, max_ticks: usize) -> Self {
        let max_ticks = max_ticks.max(2);
        if log {
            Self::logarithmic(range.unwrap_or((1.0, 10.0)), max_ticks as i32)
        } else {
            Self::linear(widened(range.unwrap_or((0.0, 1.0))), max_ticks)
        }
    }

    /// Fraction of the axis at which a value lies, or `None` if it cannot be drawn. May lie outside 0 to 1.
    pub(super) fn fraction(&self, value: f64) -> Option<f64> {
        if !is_drawable(value, self.log) {
            return None;
        }
        let place = if self.log { log10(value) } else { value };
        Some((place - self.low) / (self.high - self.low))
    }

    /// Numbers by which a page's script reads values: both ends (of the logarithm, if it is one), 1 for a logarithmic
    /// axis, offset of the labels, and their power of ten.
    pub(super) fn script_data(&self) -> String {
        format!("{} {} {} {} {}", self.low, self.high, u8::from(self.log), self.origin, self.power)
    }

    /// Label and bracketed unit of an axis divided like this: `("energy − 1234.5 J", "[10⁻⁹ J]")`.
    pub(super) fn caption(&self, axis: &Axis) -> (String, String) {
        let gap = if axis.unit.is_empty() || self.offset.is_empty() { "" } else { " " };
        let offset_unit = if self.offset.is_empty() { "" } else { axis.unit.as_str() };
        let label = format!("{}{}{gap}{offset_unit}", axis.label, self.offset);
        let bracket = match (self.power, axis.unit.as_str()) {
            (0, "") => String::new(),
            (0, unit) => format!("[{unit}]"),
            (power, unit) => format!("[10{} {unit}]", superscript(power)).replace(" ]", "]"),
        };
        (label, bracket)
    }

    fn linear((low, high): (f64, f64), max_ticks: usize) -> Self {
        let grid = Grid::covering(low, high, max_ticks);
        let (first, last) = (grid.first, grid.last);
        let fraction = |units: f64| (units - first) / (last - first);
        let step = grid.step;
        let majors: Vec<f64> = multiples(step, first, last).collect();
        let origin = grid.label_origin(&majors);
        let power = grid.label_power(&majors, origin);
        let label = |units: f64| {
            let value = scaled(units - origin, grid.unit - power);
            fixed(value, (power - grid.unit - 1).max(0) as usize)
        };
        Self {
            low: scaled(first, grid.unit),
            high: scaled(last, grid.unit),
            log: false,
            major: majors.iter().map(|&units| Tick { at: fraction(units), label: label(units) }).collect(),
            minor: multiples(grid.minor, first, last).map(fraction).collect(),
            power,
            offset: grid.offset_text(origin),
            origin: scaled(origin, grid.unit),
        }
    }

    /// Labels at 15°, 30°, 45°, 90° or multiples of 180°; the axis ends at fine grid lines, of which each step has
    /// three.
    fn in_degrees((low, high): (f64, f64), max_ticks: usize) -> Self {
        let whole_turns = (1..).map(|k| 180.0 * f64::from(k));
        let mut steps = [15.0, 30.0, 45.0, 90.0].into_iter().chain(whole_turns);
        let step = steps.find(|step| (high - low) / step <= max_ticks as f64).unwrap_or(360.0);
        let fine = step / 3.0;
        let (first, last) = ((low / fine + 1e-3).floor() * fine, (high / fine - 1e-3).ceil() * fine);
        let fraction = |value: f64| (value - first) / (last - first);
        let major = multiples(step, first, last).map(|value| Tick { at: fraction(value), label: fixed(value, 0) });
        Self {
            low: first,
            high: last,
            log: false,
            major: major.collect(),
            minor: multiples(fine, first, last).map(fraction).collect(),
            power: 0,
            offset: String::new(),
            origin: 0.0,
        }
    }

    fn logarithmic((low, high): (f64, f64), max_ticks: i32) -> Self {
        let first = (log10(low) + 1e-9).floor() as i32;
        let last = ((log10(high) - 1e-9).ceil() as i32).max(first + 1);
        let decades = last - first;
        let every = (decades + max_ticks - 1) / max_ticks;
        let is_plain = first >= -3 && last <= 4;
        let name = |decade: i32| match is_plain {
            true => fixed(pow10(decade), (-decade).max(0) as usize),
            false => format!("10{}", superscript(decade)),
        };
        let fraction = |log: f64| (log - f64::from(first)) / f64::from(decades);
        let labelled = (first..=last).step_by(every as usize);
        let inner = if decades > 10 { 1..2 } else { 1..10 };
        let minor = (first..last)
            .flat_map(|decade| inner.clone().map(move |m| fraction(f64::from(decade) + log10(f64::from(m)))));
        Self {
            low: f64::from(first),
            high: f64::from(last),
            log: true,
            major: labelled.map(|d| Tick { at: fraction(f64::from(d)), label: name(d) }).collect(),
            minor: minor.chain([1.0]).collect(),
            power: 0,
            offset: String::new(),
            origin: 0.0,
        }
    }
}

/// Returns true if a value has a place on an axis at all.
pub(super) fn is_drawable(value: f64, log: bool) -> bool {
    value.is_finite() && value.abs() < LARGEST && (!log || value > 1.0 / LARGEST)
}

/// A linear division in integers: everything is counted in `10^unit`.
struct Grid {
    /// Decimal exponent of the unit, one below that of the step.
    unit: i32,
    /// Distance of labelled ticks in units: 10, 20 or 50.
    step: f64,
    /// Distance of fine grid lines in units: 2, 5 or 10.
    minor: f64,
    /// Start of the axis in units.
    first: f64,
    /// End of the axis in units.
    last: f64,
}

impl Grid {
    /// The finest division of at most `max_ticks` steps; its ends lie on fine grid lines.
    fn covering(low: f64, high: f64, max_ticks: usize) -> Self {
        let raw = (high - low) / max_ticks as f64;
        let decade = exponent(raw);
        let mantissa = raw / pow10(decade);
        let (step, minor, unit) = match mantissa {
            m if m <= 1.0 => (10.0, 2.0, decade - 1),
            m if m <= 2.0 => (20.0, 5.0, decade - 1),
            m if m <= 5.0 => (50.0, 10.0, decade - 1),
            _ => (10.0, 2.0, decade),
        };
        let ends = |snap: f64| {
            // Data may lie beyond the end by a billionth of a grid line: rounding must not cost a whole one.
            let first = (scaled(low, -unit) / snap + 1e-9).floor() * snap;
            let last = (scaled(high, -unit) / snap - 1e-9).ceil() * snap;
            (first, last)
        };
        let (mut first, mut last) = ends(minor);
        if multiples(step, first, last).count() < 2 {
            (first, last) = ends(step);
        }
        Self { unit, step, minor, first, last: last.max(first + minor) }
    }

    /// Offset of the labels: zero, or the roundest tick if labels counted from zero would be too long.
    fn label_origin(&self, majors: &[f64]) -> f64 {
        let digits = exponent(largest(majors, 0.0) / 10.0) + 1;
        let roundest = majors.iter().copied().max_by_key(|&units| trailing_zeros(units));
        roundest.filter(|_| digits > MAX_DIGITS).unwrap_or(0.0)
    }

    /// The power of ten taken out of the labels: a multiple of three, zero for handy numbers.
    fn label_power(&self, majors: &[f64], origin: f64) -> i32 {
        let order = exponent(largest(majors, origin)) + self.unit;
        if (-3..5).contains(&order) { 0 } else { order.div_euclid(3) * 3 }
    }

    fn offset_text(&self, origin: f64) -> String {
        if origin == 0.0 {
            return String::new();
        }
        let sign = if origin > 0.0 { '−' } else { '+' };
        let digits = fixed(scaled(origin.abs(), self.unit), (-self.unit - 1).max(0) as usize);
        let digits = if digits.contains('.') { digits.trim_end_matches('0').trim_end_matches('.') } else { &digits };
        format!(" {sign} {digits}")
    }
}

/// `x·10ⁿ` with one rounding: divides by a whole power where the power is negative.
fn scaled(x: f64, n: i32) -> f64 {
    if n < 0 { x / pow10(-n) } else { x * pow10(n) }
}

/// Number of times that ten divides a whole number.
fn trailing_zeros(units: f64) -> usize {
    (1..18).take_while(|&n| (units / pow10(n)).fract() == 0.0).count()
}

/// Multiples of `step` within the ends, both included. All are integers, hence exact.
fn multiples(step: f64, first: f64, last: f64) -> impl Iterator<Item = f64> {
    let (from, to) = ((first / step).ceil(), (last / step).floor());
    let count = (to - from + 1.0).max(0.0) as usize;
    (0..count).map(move |i| (from + i as f64) * step)
}

fn largest(values: &[f64], origin: f64) -> f64 {
    values.iter().map(|value| (value - origin).abs()).fold(0.0, f64::max)
}

/// A range that can be divided: a constant, or what differs only by rounding, gets room above and below.
fn widened((low, high): (f64, f64)) -> (f64, f64) {
    let size = low.abs().max(high.abs());
    if size < 1.0 / LARGEST {
        (-1.0, 1.0)
    } else if high - low < 1e-12 * size {
        (low - 0.1 * size, high + 0.1 * size)
    } else {
        (low, high)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn labels(scale: &Scale) -> Vec<&str> {
        scale.major.iter().map(|tick| tick.label.as_str()).collect()
    }

    #[test]
    fn ticks_are_nice_and_cover_the_range() {
        for i in 1..4000_i32 {
            let low = f64::from((i * 7919) % 2003 - 1000) * pow10(i % 17 - 8);
            let high = low + f64::from(i) * pow10((i * 31) % 13 - 6);
            let scale = Scale::new(Some((low, high)), false, 3 + (i % 8) as usize);
            let minor = (scale.high - scale.low) / scale.minor.len() as f64;
            assert!(scale.low <= low + 1e-6 * minor && scale.high >= high - 1e-6 * minor, "{low} {high}");
            assert!((2..=13).contains(&scale.major.len()), "{low} {high} {:?}", labels(&scale));
            let step = (scale.major[1].at - scale.major[0].at) * (scale.high - scale.low);
            let mantissa = step / pow10(exponent(step * 1.001));
            assert!([1.0, 2.0, 5.0].iter().any(|nice| (mantissa - nice).abs() < 1e-2), "step {step}");
            assert!(labels(&scale).iter().all(|label| label.chars().count() <= 9), "{:?}", labels(&scale));
        }
    }

    #[test]
    fn time_reads_as_one_would_write_it() {
        let scale = Scale::new(Some((0.0, 3.0)), false, 8);
        assert_eq!(labels(&scale), ["0.0", "0.5", "1.0", "1.5", "2.0", "2.5", "3.0"]);
        assert_eq!(scale.minor.len(), 31);
        assert_eq!(scale.fraction(1.5), Some(0.5));
    }

    #[test]
    fn angles_are_divided_as_one_reads_them() {
        let axis = Axis { degrees: true, ..Axis::new("phase", "°") };
        assert_eq!(
            labels(&Scale::of(&axis, Some((-268.0, -91.0)), 8)),
            ["−270", "−240", "−210", "−180", "−150", "−120", "−90"]
        );
        assert_eq!(labels(&Scale::of(&axis, Some((-178.0, -2.0)), 5)), ["−180", "−135", "−90", "−45", "0"]);
        assert_eq!(labels(&Scale::of(&axis, Some((-1.0, 1.0)), 4)).len(), 5);
    }

    #[test]
    fn small_numbers_share_a_power_of_ten() {
        let scale = Scale::new(Some((-1.3e-9, 2.9e-9)), false, 5);
        assert_eq!(labels(&scale), ["−1", "0", "1", "2", "3"]);
        assert_eq!(scale.caption(&Axis::new("error", "rad")), ("error".into(), "[10⁻⁹ rad]".into()));
    }

    #[test]
    fn a_small_drift_on_a_large_value_shares_an_offset() {
        let scale = Scale::new(Some((1234.5, 1234.5 + 4e-7)), false, 5);
        assert_eq!(labels(&scale), ["0", "100", "200", "300", "400"]);
        let (label, bracket) = scale.caption(&Axis::new("energy", "J"));
        assert_eq!((label.as_str(), bracket.as_str()), ("energy − 1234.5 J", "[10⁻⁹ J]"));
    }

    #[test]
    fn a_constant_gets_room() {
        for value in [0.0, 1e-300, 9.81, -3e7, 1e250] {
            let scale = Scale::new(Some((value, value)), false, 5);
            let at = scale.fraction(value).unwrap();
            assert!(at > 0.1 && at < 0.9, "{value}: {at}");
        }
    }

    #[test]
    fn what_is_not_finite_has_no_place() {
        let scale = Scale::new(None, false, 5);
        for value in [f64::NAN, f64::INFINITY, -f64::INFINITY, 1e300] {
            assert_eq!(scale.fraction(value), None);
        }
        assert_eq!(Scale::new(Some((1.0, 2.0)), true, 5).fraction(0.0), None);
    }

    #[test]
    fn decades_are_labelled_on_a_log_axis() {
        let scale = Scale::new(Some((0.02, 300.0)), true, 8);
        assert_eq!(labels(&scale), ["0.01", "0.1", "1", "10", "100", "1000"]);
        let scale = Scale::new(Some((1e-15, 1e-3)), true, 4);
        assert_eq!(labels(&scale), ["10⁻¹⁵", "10⁻¹²", "10⁻⁹", "10⁻⁶", "10⁻³"]);
    }
}
