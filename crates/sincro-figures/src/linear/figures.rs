//! The figures of a linearised scene: poles and zeros, Bode diagrams, step responses.

use sincro_analysis::linear::{Bode, Complex};
use sincro_analysis::linearize::OpenLoop;

use super::text::margins;
use super::{Analysis, Channel};
use crate::plot::{Axis, Figure, Guide, Limit, Panel, Role, Series, Stroke, Weight};

/// Damping ratios that have a line in the map of poles and zeros.
const DAMPING_RATIOS: [f64; 6] = [0.1, 0.2, 0.3, 0.5, 0.7, 0.9];
/// Width by height of the plot area of a wide figure with a panel of share [`MAP_SHARE`].
const MAP_ASPECT: f64 = 1.95;
/// The map is higher than other panels.
const MAP_SHARE: f64 = 1.5;
/// If the map is so much wider than high, or the other way round, its axes have scales of their own.
const MAX_ASPECT: f64 = 6.0;

/// Rays whose ends are nearer than this share of the map are left out.
const CROWDED: f64 = 0.07;

/// Figures of a linear system, each with a file name without its ending: Bode diagram, map of poles and zeros and step
/// response of each channel of [`Analysis::shown`].
#[must_use]
pub fn all(analysis: &Analysis) -> Vec<(String, Figure)> {
    let mut figures = Vec::new();
    for (k, channel) in analysis.shown().iter().enumerate() {
        let number = k + 1;
        figures.push((format!("{number:02}-bode"), bode(analysis, channel)));
        figures.push((format!("{number:02}-poles-and-zeros"), map(analysis, Some(channel))));
        figures.push((format!("{number:02}-step"), step(analysis, channel)));
    }
    if figures.is_empty() {
        figures.push(("poles".to_owned(), map(analysis, None)));
    }
    for (k, open) in analysis.loops.iter().enumerate() {
        figures.push((format!("loop-{:02}-bode", k + 1), loop_bode(open)));
    }
    figures
}

/// Bode diagram of an open loop, with its margins.
pub(super) fn loop_bode(open: &OpenLoop) -> Figure {
    bode_figure(format!("Bode diagram of the loop opened at {}", open.signal.name), "dB".to_owned(), &open.margins.bode)
}

/// Magnitude over phase, with the margins drawn in.
pub(super) fn bode(analysis: &Analysis, channel: &Channel) -> Figure {
    let unit = analysis.gain_unit(channel);
    let unit = if unit.is_empty() { "dB".to_owned() } else { format!("dB of {unit}") };
    bode_figure(format!("Bode diagram {}", analysis.name(channel)), unit, &channel.bode)
}

fn bode_figure(title: String, unit: String, bode: &Bode) -> Figure {
    let curve = |y: &[f64]| Series::new("", Role::Simulated, bode.omega.clone(), y.to_vec());
    let mut magnitude = Panel::new(Axis::new("magnitude", unit));
    magnitude.series.push(curve(&bode.magnitude_db));
    let mut phase = Panel { share: 0.8, ..Panel::new(Axis { degrees: true, ..Axis::new("phase", "°") }) };
    phase.series.push(curve(&bode.phase_deg));
    add_margins(&mut magnitude, &mut phase, bode);
    let x = Axis { log: true, ..Axis::new("angular frequency", "rad/s") };
    Figure { title, x, panels: vec![magnitude, phase], space: None }
}

/// The gain margin from the curve up to 0 dB, the phase margin from −180° up to the curve, dotted lines at the
/// crossovers.
fn add_margins(magnitude: &mut Panel, phase: &mut Panel, bode: &Bode) {
    let (gain_words, phase_words) = margins(bode);
    let full = |omega: f64| vec![(omega, f64::NEG_INFINITY), (omega, f64::INFINITY)];
    let guide = |points: Vec<(f64, f64)>, name: String, weight| Guide { points, name, label: String::new(), weight };
    // a logarithmic axis has no zero
    if let Some(margin) = bode.gain_margin().filter(|margin| margin.omega > 0.0) {
        let span = vec![(margin.omega, -margin.value), (margin.omega, 0.0)];
        magnitude.guides.push(guide(full(margin.omega), String::new(), Weight::Dotted));
        magnitude.guides.push(guide(span, format!("gain margin {gain_words}"), Weight::Strong));
        phase.guides.push(guide(full(margin.omega), String::new(), Weight::Dotted));
    }
    if let Some(margin) = bode.phase_margin() {
        let at = phase_at(bode, margin.omega);
        let span = vec![(margin.omega, at - margin.value), (margin.omega, at)];
        magnitude.guides.push(guide(full(margin.omega), String::new(), Weight::Dotted));
        phase.guides.push(guide(full(margin.omega), String::new(), Weight::Dotted));
        // the −180° that the margin is counted from, which a turn or two may have moved
        let foot = at - margin.value;
        phase.guides.push(guide(vec![(f64::NEG_INFINITY, foot), (f64::INFINITY, foot)], String::new(), Weight::Axis));
        phase.guides.push(guide(span, format!("phase margin {phase_words}"), Weight::Strong));
    }
}

/// The phase between two points of the grid.
fn phase_at(bode: &Bode, omega: f64) -> f64 {
    let k = bode.omega.partition_point(|w| *w < omega).clamp(1, bode.omega.len() - 1);
    let part = (omega - bode.omega[k - 1]) / (bode.omega[k] - bode.omega[k - 1]);
    bode.phase_deg[k - 1] + part * (bode.phase_deg[k] - bode.phase_deg[k - 1])
}

/// Poles as crosses, zeros as rings, over lines of equal damping.
pub(super) fn map(analysis: &Analysis, channel: Option<&Channel>) -> Figure {
    let poles: Vec<Complex<f64>> = analysis.poles.iter().map(|mode| mode.pole).collect();
    let zeros: &[Complex<f64>] = channel.map_or(&[], |channel| &channel.zeros);
    let circle = analysis.system.sample_time.map(|_| [Complex::new(-1.0, 1.0), Complex::new(1.0, -1.0)]);
    let (width, height) = map_range(poles.iter().chain(zeros).copied().chain(circle.into_iter().flatten()));
    let unit = if analysis.system.sample_time.is_some() { "" } else { "1/s" };
    let mut panel = Panel::new(Axis { range: Some(height), ..Axis::new("imaginary part", unit) });
    panel.share = MAP_SHARE;
    let line = |points: Vec<(f64, f64)>, weight| Guide { points, name: String::new(), label: String::new(), weight };
    panel.guides.push(line(vec![(0.0, f64::NEG_INFINITY), (0.0, f64::INFINITY)], Weight::Axis));
    if analysis.system.sample_time.is_none() {
        panel.guides.extend(damping_lines(width.0, height.1));
    } else {
        panel.guides.push(unit_circle());
    }
    let cloud = |name: &str, signal, stroke, values: &[Complex<f64>]| {
        let (x, y) = values.iter().map(|z| (z.re, z.im)).unzip();
        Series { signal, stroke, ..Series::new(name, Role::Simulated, x, y) }
    };
    panel.series.push(cloud("poles", 0, Stroke::Crosses, &poles));
    if !zeros.is_empty() {
        panel.series.push(cloud("zeros", 1, Stroke::Rings, zeros));
    }
    let title = match channel {
        Some(channel) => format!("Poles and zeros {}", analysis.name(channel)),
        None => "Poles".to_owned(),
    };
    Figure { title, x: Axis { range: Some(width), ..Axis::new("real part", unit) }, panels: vec![panel], space: None }
}

/// Ranges of the map across and up: all points with air, the axes through zero, the same scale on both where that
/// wastes little.
fn map_range(points: impl Iterator<Item = Complex<f64>>) -> ((f64, f64), (f64, f64)) {
    let (mut left, mut right, mut high) = (0.0_f64, 0.0_f64, 0.0_f64);
    for z in points.filter(|z| z.re.is_finite() && z.im.is_finite()) {
        (left, right, high) = (left.min(z.re), right.max(z.re), high.max(z.im.abs()));
    }
    let size = (right - left).max(high);
    let size = if size > 0.0 { size } else { 1.0 };
    let across = (right - left).max(0.02 * size);
    let up = high.max(0.02 * size);
    let (mut across, mut up) = (1.25 * across, 1.15 * up);
    let aspect = across / (2.0 * up);
    if aspect > MAP_ASPECT && aspect < MAP_ASPECT * MAX_ASPECT {
        up = across / (2.0 * MAP_ASPECT);
    } else if aspect < MAP_ASPECT && aspect > MAP_ASPECT / MAX_ASPECT {
        across = 2.0 * up * MAP_ASPECT;
    } else if high == 0.0 {
        up = across / (2.0 * MAP_ASPECT);
    }
    let spare = across - (right - left);
    // more air on the stable side
    ((left - 0.6 * spare, right + 0.4 * spare), (-up, up))
}

/// Rays of equal damping out of the map, with ζ at their ends; where they would crowd, only some.
fn damping_lines(left: f64, high: f64) -> Vec<Guide> {
    let mut lines = Vec::new();
    let mut last = (f64::INFINITY, f64::INFINITY);
    for zeta in DAMPING_RATIOS {
        let slope = (1.0 - zeta * zeta).sqrt() / zeta;
        // where the ray leaves the map, in shares of its width and height
        let steepness = -left * slope / high;
        let end = if steepness > 1.0 { (1.0 / steepness, 1.0) } else { (1.0, steepness) };
        if (end.0 - last.0).abs() < CROWDED && (end.1 - last.1).abs() < CROWDED {
            continue;
        }
        last = end;
        for side in [1.0, -1.0] {
            let label = if side > 0.0 { format!("ζ {zeta}") } else { String::new() };
            lines.push(Guide {
                points: vec![(0.0, 0.0), (2.0 * end.0 * left, 2.0 * end.1 * side * high)],
                name: String::new(),
                label,
                weight: Weight::Faint,
            });
        }
    }
    lines
}

/// The border of stability of a sampled system.
fn unit_circle() -> Guide {
    let corner = |k: i32| {
        let (sine, cosine) = sincro_math::elementary::sin_cos(std::f64::consts::TAU * f64::from(k) / 120.0);
        (cosine, sine)
    };
    let points = (0..=120).map(corner).collect();
    Guide { points, name: "unit circle".to_owned(), label: String::new(), weight: Weight::Faint }
}

/// The answer to a unit step, and where it settles.
pub(super) fn step(analysis: &Analysis, channel: &Channel) -> Figure {
    let (input, output) = (&analysis.system.inputs[channel.input], &analysis.system.outputs[channel.output]);
    let last_of = |name: &str| name.rsplit(['.', '/']).next().unwrap_or(name).replace('_', " ");
    let mut panel = Panel::new(Axis::new(last_of(&output.name), output.unit.as_str()));
    let step = &channel.step;
    let mut curve = Series::new("", Role::Simulated, step.times.clone(), step.values.clone());
    if analysis.system.sample_time.is_some() {
        curve.stroke = Stroke::Steps;
    }
    panel.series.push(curve);
    if let Some(value) = step.final_value {
        panel.limits.push(Limit { name: "settles at".into(), value });
    }
    let unit = if input.unit.is_empty() { String::new() } else { format!(" {}", input.unit) };
    let title = format!("Step of 1{unit} {}", analysis.name(channel));
    Figure { title, x: Axis::time(), panels: vec![panel], space: None }
}
