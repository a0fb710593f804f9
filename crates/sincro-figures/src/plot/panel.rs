//! Draws one panel: grid, bands, limits, curves, axes, header.

use super::axis::Scale;
use super::decimate::{Point, decimate};
use super::draw::{Canvas, Context};
use super::layout::{Entry, Fonts, Layout, PanelLayout, Sample, is_near};
use super::number::{coordinate, push_hundredths, short};
use super::style::{self, Look};
use super::text::{fit, width};
use super::{Band, Guide, Role, Series, Stroke, Weight};

/// Overlap of curves over the plot area, so that lines and markers on the edge are whole `[px]`.
const SPILL: f64 = 5.0;
/// Distance of markers along the x axis `[px]`.
const MARKER_SPACING: f64 = 88.0;
/// Spikes that are marked in one panel, at most.
const MAX_SPIKES: usize = 12;
/// Points of one curve: never more than this, however wide the figure.
const MAX_COLUMNS: usize = 999;

/// Draws the panel at its place.
pub(super) fn draw(canvas: &mut Canvas, layout: &Layout, at: &PanelLayout, context: Context) {
    let frame =
        Frame { left: layout.left, right: layout.right, top: at.top, bottom: at.bottom, x: &layout.x, y: &at.y };
    frame.draw_grid(canvas);
    frame.draw_axes(canvas, layout, at);
    let corners = (frame.left - SPILL, frame.top - SPILL, frame.right + SPILL, frame.bottom + SPILL);
    let data = [
        ("x", frame.x.script_data()),
        ("y", frame.y.script_data()),
        ("x-unit", layout.x_unit.to_owned()),
        ("unit", at.panel.y.unit.clone()),
    ];
    canvas.open_clip(corners, &data);
    let inner = frame.shifted(SPILL - frame.left, SPILL - frame.top);
    for band in &at.panel.bands {
        inner.draw_band(canvas, band);
    }
    for guide in &at.panel.guides {
        inner.draw_guide(canvas, guide, layout.fonts);
    }
    for limit in at.panel.limits.iter().filter(|limit| is_near(limit.value, at.data.shown)) {
        inner.draw_limit(canvas, limit.value);
    }
    let mut stacked: Vec<(Look, &Series)> =
        at.panel.series.iter().map(|series| (style::look(series, context.n_signals), series)).collect();
    stacked.sort_by_key(|(look, _)| look.layer);
    for (look, series) in stacked {
        inner.draw_series(canvas, series, look, context);
    }
    canvas.close_clip();
    frame.draw_spikes(canvas, at, layout.fonts, context);
    if at.data.shown.is_none() {
        let middle = (0.5 * (frame.left + frame.right), 0.5 * (frame.top + frame.bottom));
        canvas.text(middle, "middle", layout.fonts.label, "sp-quiet", "no values to draw");
    }
    for entry in &at.header {
        draw_entry(canvas, layout, at, entry, context);
    }
}

/// A plot area and its two scales.
#[derive(Clone, Copy)]
struct Frame<'a> {
    left: f64,
    right: f64,
    top: f64,
    bottom: f64,
    x: &'a Scale,
    y: &'a Scale,
}

impl Frame<'_> {
    fn shifted(&self, dx: f64, dy: f64) -> Self {
        let (left, right) = (self.left + dx, self.right + dx);
        Self { left, right, top: self.top + dy, bottom: self.bottom + dy, ..*self }
    }

    fn across(&self, fraction: f64) -> f64 {
        self.left + fraction * (self.right - self.left)
    }

    fn up(&self, fraction: f64) -> f64 {
        self.bottom + fraction * (self.top - self.bottom)
    }

    /// Place of a value pair on the canvas; kept within a hundred figure sizes, which SVG viewers can
    /// count in.
    fn place(&self, x: f64, y: f64) -> Option<Point> {
        let (x, y) = (self.x.fraction(x)?.clamp(-9.0, 9.0), self.y.fraction(y)?.clamp(-99.0, 99.0));
        Some((self.across(x), self.up(y)))
    }

    fn draw_grid(&self, canvas: &mut Canvas) {
        let vertical =
            |at: f64| format!("M{} {}V{}", coordinate(self.across(at)), coordinate(self.top), coordinate(self.bottom));
        let horizontal =
            |at: f64| format!("M{} {}H{}", coordinate(self.left), coordinate(self.up(at)), coordinate(self.right));
        let fine: String =
            self.x.minor.iter().map(|&at| vertical(at)).chain(self.y.minor.iter().map(|&at| horizontal(at))).collect();
        let coarse: String = self
            .x
            .major
            .iter()
            .map(|tick| vertical(tick.at))
            .chain(self.y.major.iter().map(|tick| horizontal(tick.at)))
            .collect();
        canvas.path("sp-fine", "", &fine);
        canvas.path("sp-grid", "", &coarse);
    }

    fn draw_axes(&self, canvas: &mut Canvas, layout: &Layout, at: &PanelLayout) {
        let fonts = layout.fonts;
        for tick in &self.y.major {
            let baseline = self.up(tick.at) + 0.36 * fonts.tick;
            canvas.text((self.left - 8.0, baseline), "end", fonts.tick, "sp-quiet sp-tick", &tick.label);
        }
        let corner = (coordinate(self.left), coordinate(self.top), coordinate(self.bottom), coordinate(self.right));
        canvas.path("sp-axis", "", &format!("M{} {}V{}H{}", corner.0, corner.1, corner.2, corner.3));
        if let Some(zero) = self.y.fraction(0.0).filter(|at| (0.001..0.999).contains(at)) {
            let line = format!("M{} {}H{}", corner.0, coordinate(self.up(zero)), corner.3);
            canvas.path("sp-axis", r#"stroke-width="0.8""#, &line);
        }
        let (label, bracket) = self.y.caption(&at.panel.y);
        // Beside a low panel the label may lack room: it is cut, the unit is not.
        let room = self.bottom - self.top + 16.0 - width(&bracket, fonts.label) - 0.4 * fonts.label;
        let text = format!("{} {bracket}", fit(&label, fonts.label, room.max(0.0)));
        let middle = (8.0 + fonts.label, 0.5 * (self.top + self.bottom));
        canvas.rotated_text(middle, fonts.label, text.trim());
    }

    fn draw_limit(&self, canvas: &mut Canvas, value: f64) {
        if let Some(at) = self.y.fraction(value) {
            let line = format!("M{} {}H{}", coordinate(self.left), coordinate(self.up(at)), coordinate(self.right));
            canvas.path("sp-limit", "", &line);
        }
    }

    /// The line, and its label inside the plot beside its last corner.
    fn draw_guide(&self, canvas: &mut Canvas, guide: &Guide, fonts: Fonts) {
        let edge = |scale: &Scale, value: f64| match value {
            f64::INFINITY => Some(1.0),
            f64::NEG_INFINITY => Some(0.0),
            _ => scale.fraction(value),
        };
        let place = |&(x, y): &(f64, f64)| Some((edge(self.x, x)?, edge(self.y, y)?));
        let Some(places) = guide.points.iter().map(place).collect::<Option<Vec<Point>>>() else { return };
        let mut corners = places.clone();
        for k in 1..corners.len() {
            corners[k] = within_frame(places[k - 1], places[k]);
        }
        let corners: Vec<Point> = corners.into_iter().map(|(x, y)| (self.across(x), self.up(y))).collect();
        let (class, attributes) = guide_style(guide.weight);
        canvas.path(class, attributes, &polyline(&corners));
        if let (Some(&(x, y)), false) = (corners.last(), guide.label.is_empty() || fonts.is_thumbnail) {
            let half = 0.5 * width(&guide.label, fonts.tick);
            let x = x.clamp(self.left + half + 3.0, self.right - half - 3.0);
            let y = y.clamp(self.top + fonts.tick + 2.0, self.bottom - 5.0);
            canvas.text((x, y), "middle", fonts.tick, "sp-halo", &guide.label);
        }
    }

    fn draw_band(&self, canvas: &mut Canvas, band: &Band) {
        let edge = |values: &[f64]| -> Vec<Option<Point>> {
            band.x.iter().zip(values).map(|(&x, &y)| self.place(x, y)).collect()
        };
        let (lower, upper) = (edge(&band.lower), edge(&band.upper));
        let both: Vec<Option<(Point, Point)>> = lower.into_iter().zip(upper).map(|(l, u)| l.zip(u)).collect();
        let mut data = String::new();
        for run in both.split(Option::is_none).filter(|run| !run.is_empty()) {
            let (lower, upper): (Vec<Point>, Vec<Point>) = run.iter().copied().flatten().unzip();
            let mut outline = decimate(&lower, self.columns());
            outline.extend(decimate(&upper, self.columns()).into_iter().rev());
            data.push_str(&polyline(&outline));
            data.push('Z');
        }
        canvas.path(&format!("sp-band {}", style::color(band.signal)), "", &data);
    }

    /// Marks the greatest spikes at the edge that they cross, with their values where these have room.
    fn draw_spikes(&self, canvas: &mut Canvas, at: &PanelLayout, fonts: Fonts, context: Context) {
        let mut labelled: Vec<(bool, f64, f64)> = Vec::new();
        for spike in at.data.spikes.iter().take(MAX_SPIKES) {
            let Some(x) = self.x.fraction(spike.x).filter(|x| (0.0..=1.0).contains(x)) else { continue };
            let x = self.across(x);
            let is_above = self.y.fraction(spike.y).is_some_and(|y| y > 0.5);
            let (edge, tip) = if is_above { (self.top, "l4.5 8h-9z") } else { (self.bottom, "l4.5 -8h-9z") };
            let class = style::look(&at.panel.series[spike.series], context.n_signals).class;
            let mark = format!("M{} {}{tip}", coordinate(x), coordinate(edge));
            canvas.path(&format!("sp-mark sp-spike {class}"), "", &mark);
            let text = format!("{} {}", short(spike.y, 4), at.panel.y.unit);
            let length = width(text.trim_end(), fonts.tick);
            let is_right = x + 8.0 + length <= self.right;
            let start = if is_right { x + 8.0 } else { x - 8.0 - length };
            let is_free =
                |(above, from, to): &(bool, f64, f64)| *above != is_above || start > *to || start + length < *from;
            if labelled.iter().all(is_free) {
                labelled.push((is_above, start - 6.0, start + length + 6.0));
                let baseline = if is_above { edge + fonts.tick } else { edge - 3.0 };
                canvas.text((start, baseline), "start", fonts.tick, "sp-halo sp-spike", text.trim_end());
            }
        }
    }

    fn draw_series(&self, canvas: &mut Canvas, series: &Series, look: Look, context: Context) {
        let pieces = self.pieces(series);
        if series.stroke.is_loose() {
            draw_loose(canvas, series.stroke, look, &decimate(&pieces.concat(), self.columns()));
            return;
        }
        let thinned: Vec<Vec<Point>> = pieces.iter().map(|piece| decimate(piece, self.columns())).collect();
        let (lines, dots): (Vec<_>, Vec<_>) = thinned.iter().partition(|piece| piece.len() > 1);
        let line: String = lines.iter().map(|piece| polyline(piece)).collect();
        let dot: String = dots.iter().map(|piece| format!("{}h0", polyline(piece))).collect();
        let attributes = format!("{}{}", stroke_attributes(look), canvas.script_data("name", &series.name));
        canvas.path(&format!("sp-line {}", look.class), &attributes, &line);
        canvas.path(&format!("sp-dot {}", look.class), r#"stroke-width="4""#, &dot);
        if series.role == Role::Reference || context.marks_runs {
            draw_markers(canvas, look, &self.sparse(&thinned.concat(), series));
        }
    }

    /// The connected parts of a curve on the canvas.
    fn pieces(&self, series: &Series) -> Vec<Vec<Point>> {
        let places: Vec<Option<Point>> = series.points().map(|(x, y)| self.place(x, y)).collect();
        let runs = places.split(Option::is_none).filter(|run| !run.is_empty());
        let pieces = runs.map(|run| run.iter().copied().flatten().collect());
        match series.stroke {
            Stroke::Steps => pieces.map(|piece: Vec<Point>| staircase(&piece)).collect(),
            _ => pieces.collect(),
        }
    }

    /// A few points of a curve at which its markers stand; series are staggered so that markers do not hide one
    /// another.
    fn sparse(&self, points: &[Point], series: &Series) -> Vec<Point> {
        let turn = match series.role {
            Role::Simulated => 0.15 + 0.13 * series.signal as f64,
            Role::Reference => 0.55 + 0.13 * series.signal as f64,
            Role::Variant(index) => 0.35 + 0.19 * index as f64 + 0.07 * series.signal as f64,
        };
        let turn = turn.fract();
        if points.windows(2).any(|pair| pair[1].0 < pair[0].0) {
            let every = (points.len() / 12).max(1);
            return points.iter().copied().skip((turn * every as f64) as usize).step_by(every).collect();
        }
        let mut next = self.left + turn * MARKER_SPACING;
        let mut chosen = Vec::new();
        for &(x, y) in points.iter().filter(|point| point.0 <= self.right) {
            if x >= next {
                chosen.push((x, y));
                next += MARKER_SPACING * (1.0 + ((x - next) / MARKER_SPACING).floor());
            }
        }
        chosen
    }

    fn columns(&self) -> usize {
        ((self.right - self.left) as usize).clamp(2, MAX_COLUMNS)
    }
}

/// The corners of a curve that holds each value until the next.
fn staircase(points: &[Point]) -> Vec<Point> {
    let corners = points.windows(2).flat_map(|pair| [pair[0], (pair[1].0, pair[0].1)]);
    corners.chain(points.last().copied()).collect()
}

/// Path data through the points, as steps on a grid of hundredths of a pixel; steps of nothing are left out.
fn polyline(points: &[Point]) -> String {
    let on_grid = |&(x, y): &Point| ((100.0 * x).round(), (100.0 * y).round());
    let Some((mut x, mut y)) = points.first().map(on_grid) else { return String::new() };
    let mut data = String::with_capacity(8 * points.len());
    data.push('M');
    push_hundredths(&mut data, x);
    data.push(' ');
    push_hundredths(&mut data, y);
    let mut command = "l";
    let separator = |next: f64| if next < 0.0 { "" } else { " " };
    for (next_x, next_y) in points[1..].iter().map(on_grid) {
        if (next_x, next_y) != (x, y) {
            let (dx, dy) = (next_x - x, next_y - y);
            // One `l` holds for all steps that follow; a minus sign separates as well as a space.
            data.push_str(if command.is_empty() { separator(dx) } else { command });
            push_hundredths(&mut data, dx);
            data.push_str(separator(dy));
            push_hundredths(&mut data, dy);
            (x, y, command) = (next_x, next_y, "");
        }
    }
    data
}

fn stroke_attributes(look: Look) -> String {
    let dash = if look.dash.is_empty() { String::new() } else { format!(r#" stroke-dasharray="{}""#, look.dash) };
    format!(r#"stroke-width="{}"{dash}"#, coordinate(look.weight))
}

/// The end of a line, or where it leaves the frame, in fractions of the frame; what starts outside is left as it is.
fn within_frame(from: Point, to: Point) -> Point {
    let share = |from: f64, to: f64| match to {
        _ if !(0.0..=1.0).contains(&from) => 1.0,
        to if to > 1.0 => (1.0 - from) / (to - from),
        to if to < 0.0 => from / (from - to),
        _ => 1.0,
    };
    let share = share(from.0, to.0).min(share(from.1, to.1));
    (from.0 + share * (to.0 - from.0), from.1 + share * (to.1 - from.1))
}

/// Class and attributes of an auxiliary line.
fn guide_style(weight: Weight) -> (&'static str, &'static str) {
    match weight {
        Weight::Faint => ("sp-guide", r#"stroke-dasharray="5 4""#),
        Weight::Axis => ("sp-axis", r#"stroke-width="0.8""#),
        Weight::Dotted => ("sp-limit", ""),
        Weight::Strong => ("sp-guide sp-ref", r#"stroke-width="3""#),
    }
}

/// Markers of a series that is not joined.
fn draw_loose(canvas: &mut Canvas, stroke: Stroke, look: Look, points: &[Point]) {
    let shape = match stroke {
        Stroke::Crosses => "m-5 -5l10 10m0 -10l-10 10",
        Stroke::Rings => "m-5 0a5 5 0 1 0 10 0a5 5 0 1 0 -10 0z",
        _ => return draw_markers(canvas, look, points),
    };
    let data: String = points.iter().map(|&(x, y)| format!("M{} {}{shape}", coordinate(x), coordinate(y))).collect();
    canvas.path(&format!("sp-line {}", look.class), r#"stroke-width="2""#, &data);
}

fn draw_markers(canvas: &mut Canvas, look: Look, points: &[Point]) {
    let shape = style::marker(look.marker);
    let data: String = points.iter().map(|&(x, y)| format!("M{} {}{shape}", coordinate(x), coordinate(y))).collect();
    let fill = if look.is_filled { "" } else { " sp-hollow" };
    canvas.path(&format!("sp-mark {}{fill}", look.class), "", &data);
}

/// Draws one piece of the header: sample, then text.
fn draw_entry(canvas: &mut Canvas, layout: &Layout, at: &PanelLayout, entry: &Entry, context: Context) {
    let fonts = layout.fonts;
    let x = layout.left + entry.x;
    let baseline = at.header_baseline + entry.row as f64 * fonts.row();
    let middle = baseline - 0.35 * fonts.label;
    let sample = fonts.sample;
    let line = format!("M{} {}h{sample}", coordinate(x), coordinate(middle));
    let mut lead = sample + 6.0;
    match entry.sample {
        Sample::Title | Sample::Remark => lead = 0.0,
        Sample::Limit => canvas.path("sp-limit", "", &line),
        Sample::Guide(index) => {
            let (class, attributes) = guide_style(at.panel.guides[index].weight);
            canvas.path(class, attributes, &line);
        }
        Sample::Band(index) => {
            let class = style::color(at.panel.bands[index].signal);
            let shade = format!("M{} {}h{sample}v10h-{sample}z", coordinate(x), coordinate(middle - 5.0));
            canvas.path(&format!("sp-band {class}"), "", &shade);
        }
        Sample::Series(index) => {
            let series = &at.panel.series[index];
            let look = style::look(series, context.n_signals);
            if !series.stroke.is_loose() {
                canvas.path(&format!("sp-line {}", look.class), &stroke_attributes(look), &line);
            }
            if series.stroke.is_loose() || series.role == Role::Reference || context.marks_runs {
                draw_loose(canvas, series.stroke, look, &[(x + 0.5 * sample, middle)]);
            }
        }
    }
    let class = if entry.sample == Sample::Remark { "sp-quiet" } else { "" };
    canvas.text((x + lead, baseline), "start", fonts.label, class, &entry.text);
}
