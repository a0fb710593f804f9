//! Range of a panel that a few extreme values do not flatten, and the spikes that lie beyond it.
//!
//! The core of a curve is the range of all but the hundredth of its values that is least and the hundredth that is
//! greatest; the core of a panel is the union over its curves. If the whole range of the values is more than
//! [`MIN_RATIO`] times as high as the core, the panel shows the core and [`AIR`] heights of it above and below, and
//! every excursion beyond is marked at the edge with its value. A curve of few points, a band and a logarithmic axis
//! are always shown whole.

use super::axis::is_drawable;
use super::{Panel, Series};

/// A curve of fewer points has no spikes.
const MIN_POINTS: usize = 100;
/// Share of the values at either end that are no part of the core, as its inverse.
const TRIM: usize = 100;
/// Least ratio of the whole range to the core at which a panel is cut.
const MIN_RATIO: f64 = 8.0;
/// Greatest ratio at which it is cut: beyond it the core is rounding error, and the excursion is the signal.
const MAX_RATIO: f64 = 1e5;
/// Heights of the core that are shown above and below it.
const AIR: f64 = 1.5;

/// Range of the values of a panel, and where they leave it.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct DataRange {
    /// Least and greatest value to be shown; `None`: there is none.
    pub(super) shown: Option<(f64, f64)>,
    /// Excursions beyond, the greatest first.
    pub(super) spikes: Vec<Spike>,
}

/// An excursion of a curve beyond the range that is shown.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Spike {
    /// Index of the curve in the panel.
    pub(super) series: usize,
    /// Abscissa of the extreme value.
    pub(super) x: f64,
    /// The extreme value.
    pub(super) y: f64,
}

impl DataRange {
    /// Finds the range of a panel.
    pub(super) fn of(panel: &Panel) -> Self {
        let whole = whole_range(panel);
        let cut = whole.filter(|_| !panel.y.log).and_then(|whole| cut_range(panel, whole));
        let Some(shown) = cut else { return Self { shown: whole, spikes: Vec::new() } };
        let middle = 0.5 * (shown.0 + shown.1);
        let mut spikes: Vec<Spike> =
            panel.series.iter().enumerate().flat_map(|(k, series)| excursions(k, series, shown)).collect();
        spikes.sort_by(|a, b| (b.y - middle).abs().total_cmp(&(a.y - middle).abs()));
        Self { shown: Some(shown), spikes }
    }
}

/// Least and greatest value of the curves and bands that can be drawn.
fn whole_range(panel: &Panel) -> Option<(f64, f64)> {
    let curves = panel.series.iter().flat_map(|series| series.points());
    let lower = panel.bands.iter().flat_map(|band| band.x.iter().copied().zip(band.lower.iter().copied()));
    let upper = panel.bands.iter().flat_map(|band| band.x.iter().copied().zip(band.upper.iter().copied()));
    range(curves.chain(lower).chain(upper).map(|(_, y)| y), panel.y.log)
}

/// Least and greatest of the values that can be drawn.
pub(super) fn range(values: impl Iterator<Item = f64>, log: bool) -> Option<(f64, f64)> {
    let drawable = values.filter(|&value| is_drawable(value, log));
    drawable.fold(None, |range, value| match range {
        None => Some((value, value)),
        Some((low, high)) => Some((value.min(low), value.max(high))),
    })
}

/// The range to be shown in place of the whole one; `None`: the whole one.
fn cut_range(panel: &Panel, whole: (f64, f64)) -> Option<(f64, f64)> {
    if panel.series.iter().all(|series| series.x.len() < MIN_POINTS) {
        return None;
    }
    let bands = panel.bands.iter().flat_map(|band| band.lower.iter().chain(&band.upper).copied());
    let cores = panel.series.iter().filter_map(core).flat_map(|(low, high)| [low, high]);
    let core = range(cores.chain(bands), false)?;
    let height = core.1 - core.0;
    let ratio = (whole.1 - whole.0) / height;
    if !(MIN_RATIO..MAX_RATIO).contains(&ratio) {
        return None;
    }
    let (low, high) = (core.0 - AIR * height, core.1 + AIR * height);
    let values = panel.series.iter().flat_map(|series| series.points()).map(|(_, y)| y);
    range(values.filter(|y| (low..=high).contains(y)).chain([core.0, core.1]), false)
}

/// Range of the values of a curve without the extreme ones.
fn core(series: &Series) -> Option<(f64, f64)> {
    let mut values: Vec<f64> = series.points().map(|(_, y)| y).filter(|&y| is_drawable(y, false)).collect();
    let n = values.len();
    if n < MIN_POINTS {
        return range(values.into_iter(), false);
    }
    let low = *values.select_nth_unstable_by(n / TRIM, f64::total_cmp).1;
    let high = *values.select_nth_unstable_by(n - 1 - n / TRIM, f64::total_cmp).1;
    Some((low, high))
}

/// The extreme value of every connected piece of a curve outside the range.
fn excursions(index: usize, series: &Series, (low, high): (f64, f64)) -> Vec<Spike> {
    let excess = |y: f64| (y - high).max(low - y);
    let mut spikes: Vec<Spike> = Vec::new();
    let mut is_outside = false;
    for (x, y) in series.points() {
        let leaves = is_drawable(y, false) && excess(y) > 0.0;
        let spike = Spike { series: index, x, y };
        let goes_on = is_outside && spikes.last().is_some_and(|last| (last.y > high) == (y > high));
        match spikes.last_mut().filter(|_| goes_on) {
            _ if !leaves => {}
            Some(last) if excess(y) > excess(last.y) => *last = spike,
            Some(_) => {}
            None => spikes.push(spike),
        }
        is_outside = leaves;
    }
    spikes
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::plot::{Axis, Role};
    use sincro_math::elementary::sin_cos;

    fn panel(values: Vec<f64>) -> Panel {
        let x = (0..values.len()).map(|k| k as f64).collect();
        let mut panel = Panel::new(Axis::new("force", "N"));
        panel.series.push(Series::new("contact", Role::Simulated, x, values));
        panel
    }

    fn wave() -> Vec<f64> {
        (0..1000).map(|k| sin_cos(0.02 * f64::from(k)).0).collect()
    }

    #[test]
    fn a_spike_is_cut_and_reported_with_its_value() {
        let mut values = wave();
        (values[400], values[401], values[700]) = (250.0, 300.0, -80.0);
        let range = DataRange::of(&panel(values));
        let (low, high) = range.shown.unwrap();
        assert!(low < -0.99 && low > -4.0 && high > 0.99 && high < 4.0, "{low} {high}");
        let spikes: Vec<(f64, f64)> = range.spikes.iter().map(|spike| (spike.x, spike.y)).collect();
        assert_eq!(spikes, [(401.0, 300.0), (700.0, -80.0)]);
    }

    #[test]
    fn a_smooth_curve_a_step_and_a_pulse_over_nothing_are_shown_whole() {
        let step: Vec<f64> = (0..1000).map(|k| f64::from(u8::from(k > 500))).collect();
        let pulse: Vec<f64> = (0..1000).map(|k| f64::from(u8::from(k == 500))).collect();
        let decay: Vec<f64> = (0..1000).map(|k| sincro_math::elementary::exp(-0.01 * f64::from(k)).0).collect();
        for values in [wave(), step, pulse, decay, vec![1.0, 2.0, 1e6]] {
            let range = DataRange::of(&panel(values.clone()));
            let whole = values.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), v| (v.min(l), v.max(h)));
            assert_eq!((range.shown, range.spikes.len()), (Some(whole), 0));
        }
    }

    #[test]
    fn a_curve_that_is_large_throughout_is_no_spike() {
        let mut both = panel(wave());
        let large = wave().into_iter().map(|y| 1000.0 * y).collect();
        both.series.push(Series::new("large", Role::Simulated, (0..1000).map(f64::from).collect(), large));
        assert!(DataRange::of(&both).spikes.is_empty());
    }
}
