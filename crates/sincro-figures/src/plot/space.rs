//! Paths in space: an axonometric picture of curves in a box, with their shadows on its floor.
//!
//! Parallel projection, z upwards: parallel lines stay parallel, and equal lengths along one axis stay equal, so that
//! the grid can be read. One scale serves all axes (a metre is a metre), and one distance of grid lines. The three
//! faces that are drawn are the far ones.

use super::draw::{Canvas, Kind};
use super::layout::Fonts;
use super::number::{coordinate, exponent, fixed, pow10};
use super::style::{color, look};
use super::text::{width, wrap};
use super::{Figure, Role, Series, Size};

/// Curves in space, all axes in one unit: what a [`Figure`](crate::plot::Figure) shows in place of panels.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Space {
    /// The curves; references are drawn over the others.
    pub tracks: Vec<Track>,
    /// Unit of the points and of all axes: `m`.
    pub unit: String,
}

/// Curve of a [`Space`].
#[derive(Clone, Debug, PartialEq)]
pub struct Track {
    /// Name in the legend.
    pub name: String,
    /// Part in the figure, which decides dash and weight.
    pub role: Role,
    /// Index of the signal that it shows, from 0, which decides the colour.
    pub signal: usize,
    /// Points x, y, z in [`Space::unit`], in their order along the curve; those that are not finite leave a gap.
    pub points: Vec<[f64; 3]>,
}

/// Cosine and sine of the direction that is looked from, about z: from the right and the front, 60°.
const LOOK: (f64, f64) = (0.5, -0.866_025_403_784_438_6);
/// Sine and cosine of the height that is looked from.
const RISE: (f64, f64) = (0.4, 0.916_515_138_991_168);
/// Least extent of the box along an axis, as a share of the largest.
const MIN_EXTENT: f64 = 0.4;
/// Divisions of the longest axis, about.
const DIVISIONS: f64 = 5.0;
/// Points closer than this on the paper are one `[px]`.
const SAME_PLACE: f64 = 0.4;

/// Right and up on the paper of a place in space.
fn project(p: [f64; 3]) -> (f64, f64) {
    let right = -LOOK.1 * p[0] + LOOK.0 * p[1];
    let back = -(LOOK.0 * p[0] + LOOK.1 * p[1]);
    (right, RISE.0 * back + RISE.1 * p[2])
}

/// Limits of the drawing in numbers of grid lines: every face ends at one.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Frame {
    step: f64,
    low: [i64; 3],
    high: [i64; 3],
}

impl Frame {
    /// Around all points, which are finite; a cube of one unit around the origin if there are none.
    fn around(points: impl Iterator<Item = [f64; 3]>) -> Self {
        let (mut low, mut high) = ([f64::INFINITY; 3], [f64::NEG_INFINITY; 3]);
        for p in points {
            for i in 0..3 {
                (low[i], high[i]) = (low[i].min(p[i]), high[i].max(p[i]));
            }
        }
        if !low[0].is_finite() {
            (low, high) = ([0.0; 3], [1.0; 3]);
        }
        let largest = (0..3).map(|i| high[i] - low[i]).fold(0.0_f64, f64::max);
        let largest = if largest > 0.0 { largest } else { 1.0 };
        let least = MIN_EXTENT * largest;
        for i in 0..3 {
            let lack = 0.5 * (least - (high[i] - low[i])).max(0.0);
            (low[i], high[i]) = (low[i] - lack, high[i] + lack);
        }
        let rough = largest / DIVISIONS;
        let power = pow10(exponent(rough));
        let step = [1.0, 2.0, 5.0, 10.0].map(|nice| nice * power).into_iter().find(|step| *step >= rough * 0.999);
        let step = step.unwrap_or(10.0 * power);
        // a curve that touches a grid line does not need the next one
        let (down, up) = (|x: f64| (x / step + 1e-6).floor() as i64, |x: f64| (x / step - 1e-6).ceil() as i64);
        Self { step, low: low.map(down), high: high.map(up) }
    }

    fn place(&self, lines: [i64; 3]) -> [f64; 3] {
        lines.map(|n| n as f64 * self.step)
    }

    fn corners(&self) -> impl Iterator<Item = [i64; 3]> {
        let (low, high) = (self.low, self.high);
        (0..8).map(move |k: usize| core::array::from_fn(|i| if k >> i & 1 == 1 { high[i] } else { low[i] }))
    }
}

/// From places in space to pixels.
struct Paper {
    scale: f64,
    origin: (f64, f64),
}

impl Paper {
    fn fit(frame: &Frame, (left, top): (f64, f64), (right, bottom): (f64, f64)) -> Self {
        let (mut low, mut high) = ((f64::INFINITY, f64::INFINITY), (f64::NEG_INFINITY, f64::NEG_INFINITY));
        for corner in frame.corners() {
            let (x, y) = project(frame.place(corner));
            (low, high) = ((low.0.min(x), low.1.min(y)), (high.0.max(x), high.1.max(y)));
        }
        let scale = ((right - left) / (high.0 - low.0)).min((bottom - top) / (high.1 - low.1));
        let spare = ((right - left) - scale * (high.0 - low.0), (bottom - top) - scale * (high.1 - low.1));
        Self { scale, origin: (left + 0.5 * spare.0 - scale * low.0, bottom - 0.5 * spare.1 + scale * low.1) }
    }

    fn at(&self, p: [f64; 3]) -> (f64, f64) {
        let (x, y) = project(p);
        (self.origin.0 + self.scale * x, self.origin.1 - self.scale * y)
    }

    fn line(&self, a: [f64; 3], b: [f64; 3]) -> String {
        let ((x1, y1), (x2, y2)) = (self.at(a), self.at(b));
        format!("M{} {}L{} {}", coordinate(x1), coordinate(y1), coordinate(x2), coordinate(y2))
    }

    /// A curve, without points that fall together.
    fn curve(&self, points: impl Iterator<Item = [f64; 3]>) -> String {
        let (mut data, mut last): (String, Option<(f64, f64)>) = (String::new(), None);
        let mut skipped = None;
        for p in points {
            if !p.iter().all(|x| x.is_finite()) {
                last = None;
                continue;
            }
            let (x, y) = self.at(p);
            let is_same = last.is_some_and(|(a, b)| (x - a).abs() < SAME_PLACE && (y - b).abs() < SAME_PLACE);
            skipped = is_same.then_some((x, y));
            if !is_same {
                data += &format!("{}{} {}", if last.is_some() { "L" } else { "M" }, coordinate(x), coordinate(y));
                last = Some((x, y));
            }
        }
        if let Some((x, y)) = skipped {
            data += &format!("L{} {}", coordinate(x), coordinate(y));
        }
        data
    }
}

/// Draws a figure of paths.
pub(super) fn picture(figure: &Figure, space: &Space, size: Size, kind: Kind) -> String {
    let fonts = if kind == Kind::Thumbnail { Fonts::THUMBNAIL } else { Fonts::FULL };
    let mut canvas = Canvas::open(&figure.title, size, kind);
    let mut top = 8.0;
    if !fonts.is_thumbnail {
        for line in wrap(&figure.title, fonts.title, size.width - 16.0, 3) {
            canvas.bold_text((8.0, top + fonts.title), fonts.title, &line);
            top += fonts.title + 6.0;
        }
        top = legend(&mut canvas, space, fonts, size, top);
    }
    let finite = |p: &&[f64; 3]| p.iter().all(|x| x.is_finite());
    let frame = Frame::around(space.tracks.iter().flat_map(|track| &track.points).filter(finite).copied());
    let margin = 3.2 * fonts.label + 8.0;
    let paper = Paper::fit(&frame, (margin + 20.0, top + fonts.label), (size.width - margin, size.height - margin));
    faces(&mut canvas, &frame, &paper);
    labels(&mut canvas, &frame, &paper, &space.unit, fonts);
    let mut order: Vec<&Track> = space.tracks.iter().collect();
    order.sort_by_key(|track| look_of(track, space).layer);
    for track in &order {
        let shadow = track.points.iter().map(|p| [p[0], p[1], frame.place(frame.low)[2]]);
        canvas.path("sp-line sp-guide", r#"stroke-width="1.1" stroke-opacity="0.45""#, &paper.curve(shadow));
    }
    for track in &order {
        draw_track(&mut canvas, &paper, &frame, track, space, fonts);
    }
    canvas.close()
}

fn look_of(track: &Track, space: &Space) -> super::style::Look {
    let n_signals = space.tracks.iter().map(|track| track.signal + 1).max().unwrap_or(1);
    let series = Series { signal: track.signal, ..Series::new("", track.role, Vec::new(), Vec::new()) };
    look(&series, n_signals)
}

/// Names of the curves in rows; gives the lower edge.
fn legend(canvas: &mut Canvas, space: &Space, fonts: Fonts, size: Size, top: f64) -> f64 {
    let named: Vec<&Track> = space.tracks.iter().filter(|track| !track.name.is_empty()).collect();
    let (mut x, mut baseline) = (8.0, top + fonts.label + 4.0);
    for track in &named {
        let needed = 34.0 + width(&track.name, fonts.tick) + 18.0;
        if x > 8.0 && x + needed > size.width - 8.0 {
            (x, baseline) = (8.0, baseline + fonts.row());
        }
        let look = look_of(track, space);
        let line = format!("M{} {}h26", coordinate(x), coordinate(baseline - 4.0));
        canvas.path(&format!("sp-line {}", look.class), &stroke(&look), &line);
        canvas.text((x + 32.0, baseline), "start", fonts.tick, "", &track.name);
        x += needed;
    }
    baseline + 6.0
}

fn stroke(look: &super::style::Look) -> String {
    let dash = if look.dash.is_empty() { String::new() } else { format!(r#" stroke-dasharray="{}""#, look.dash) };
    format!(r#"stroke-width="{}"{dash}"#, coordinate(look.weight))
}

/// Grids of the floor, of the wall at the least x and of the wall at the greatest y: those behind everything.
fn faces(canvas: &mut Canvas, frame: &Frame, paper: &Paper) {
    let Frame { low, high, .. } = *frame;
    let at = |x: i64, y: i64, z: i64| frame.place([x, y, z]);
    let mut grid = String::new();
    for x in low[0]..=high[0] {
        grid += &paper.line(at(x, low[1], low[2]), at(x, high[1], low[2]));
        grid += &paper.line(at(x, high[1], low[2]), at(x, high[1], high[2]));
    }
    for y in low[1]..=high[1] {
        grid += &paper.line(at(low[0], y, low[2]), at(high[0], y, low[2]));
        grid += &paper.line(at(low[0], y, low[2]), at(low[0], y, high[2]));
    }
    for z in low[2]..=high[2] {
        grid += &paper.line(at(low[0], low[1], z), at(low[0], high[1], z));
        grid += &paper.line(at(low[0], high[1], z), at(high[0], high[1], z));
    }
    canvas.path("sp-grid", r#"stroke-width="1""#, &grid);
    let edges = [
        paper.line(at(low[0], low[1], low[2]), at(high[0], low[1], low[2])),
        paper.line(at(high[0], low[1], low[2]), at(high[0], high[1], low[2])),
        paper.line(at(low[0], low[1], low[2]), at(low[0], low[1], high[2])),
    ];
    canvas.path("sp-axis", r#"stroke-width="1.2""#, &edges.concat());
}

/// Numbers and names along the front edges of the floor and the left edge.
fn labels(canvas: &mut Canvas, frame: &Frame, paper: &Paper, unit: &str, fonts: Fonts) {
    let Frame { low, high, step } = *frame;
    let decimals = (-exponent(step * 1.001)).max(0) as usize;
    let number = |n: i64| fixed(n as f64 * step, decimals);
    let bracket = if unit.is_empty() { String::new() } else { format!(" [{unit}]") };
    // least distance of two numbers on the paper
    let every = |a: [i64; 3], i: usize| {
        let mut b = a;
        b[i] += 1;
        let ((x1, y1), (x2, y2)) = (paper.at(frame.place(a)), paper.at(frame.place(b)));
        let apart = (x2 - x1).abs().max((y2 - y1).abs() * 1.5);
        ((2.2 * fonts.tick / apart.max(1e-9)).ceil() as i64).clamp(1, 1000)
    };
    let mut along = |i: usize, corner: [i64; 3], anchor: &str, shift: (f64, f64), far: (f64, f64), name: &str| {
        let every = every(corner, i);
        for n in (low[i]..=high[i]).filter(|n| n.rem_euclid(every) == 0) {
            let mut place = corner;
            place[i] = n;
            let (x, y) = paper.at(frame.place(place));
            canvas.text((x + shift.0, y + shift.1), anchor, fonts.tick, "sp-quiet", &number(n));
        }
        let mut middle = frame.place(corner);
        middle[i] = 0.5 * (low[i] + high[i]) as f64 * step;
        let (x, y) = paper.at(middle);
        let label = format!("{name}{bracket}");
        match anchor {
            "end" => canvas.rotated_text((x + far.0, y + far.1), fonts.label, &label),
            _ => canvas.text((x + far.0, y + far.1), "middle", fonts.label, "", &label),
        }
    };
    let (tick, row) = (fonts.tick, fonts.row());
    along(0, [low[0], low[1], low[2]], "middle", (-4.0, tick + 6.0), (-1.6 * row, tick + 6.0 + row), "x");
    along(1, [high[0], low[1], low[2]], "start", (8.0, 0.7 * tick), (3.0 * row, tick + 0.6 * row), "y");
    along(2, [low[0], low[1], low[2]], "end", (-7.0, 0.35 * tick), (-3.4 * tick, 0.0), "z");
}

/// A curve, a ring where it starts, a dot where it ends, and lines from both down to the floor.
fn draw_track(canvas: &mut Canvas, paper: &Paper, frame: &Frame, track: &Track, space: &Space, fonts: Fonts) {
    let look = look_of(track, space);
    let finite = |p: &&[f64; 3]| p.iter().all(|x| x.is_finite());
    let (first, last) = (track.points.iter().find(finite), track.points.iter().rev().find(finite));
    canvas.path(&format!("sp-line {}", look.class), &stroke(&look), &paper.curve(track.points.iter().copied()));
    let (Some(first), Some(last)) = (first, last) else { return };
    let floor = frame.place(frame.low)[2];
    for p in [first, last] {
        canvas.path("sp-limit", "", &paper.line(*p, [p[0], p[1], floor]));
    }
    let mark = |p: &[f64; 3]| {
        let (x, y) = paper.at(*p);
        format!("M{} {}m-4.5 0a4.5 4.5 0 1 0 9 0a4.5 4.5 0 1 0 -9 0z", coordinate(x), coordinate(y))
    };
    let class = if track.role == Role::Reference { look.class } else { color(slot(track, space)) };
    canvas.path(&format!("{class} sp-hollow"), r#"stroke-width="1.8""#, &mark(first));
    canvas.path(&format!("sp-mark {class}"), "", &mark(last));
    if track.role == Role::Simulated && !fonts.is_thumbnail {
        for (p, word) in [(first, "start"), (last, "end")] {
            let (x, y) = paper.at(*p);
            // away from the other mark
            let other = paper.at(if word == "start" { *last } else { *first }).0;
            let (shift, anchor) = if x < other { (-9.0, "end") } else { (9.0, "start") };
            canvas.text((x + shift, y - 5.0), anchor, fonts.tick, "sp-halo", word);
        }
    }
}

/// The colour slot of a curve, as [`look`] has it.
fn slot(track: &Track, space: &Space) -> usize {
    let n_signals = space.tracks.iter().map(|track| track.signal + 1).max().unwrap_or(1);
    match track.role {
        Role::Variant(index) => (index + 1) * n_signals + track.signal,
        Role::Simulated | Role::Reference => track.signal,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::plot::{Axis, svg};

    fn helix(n: usize) -> Figure {
        let points = (0..n).map(|k| {
            let (s, c) = sincro_math::elementary::sin_cos(0.01 * k as f64);
            [c, s, 0.002 * k as f64]
        });
        let track =
            Track { name: "/drone.position".into(), role: Role::Simulated, signal: 0, points: points.collect() };
        let space = Space { tracks: vec![track], unit: "m".into() };
        Figure { title: "Path".into(), x: Axis::default(), panels: Vec::new(), space: Some(space) }
    }

    #[test]
    fn the_box_holds_every_point_and_ends_at_grid_lines() {
        for scale in [1e-6, 0.3, 1.0, 7.0, 4e5] {
            let points: Vec<[f64; 3]> =
                helix(900).space.unwrap().tracks[0].points.iter().map(|p| p.map(|x| scale * x)).collect();
            let frame = Frame::around(points.iter().copied());
            for p in &points {
                for i in 0..3 {
                    let slack = 1e-5 * frame.step;
                    assert!(p[i] >= frame.place(frame.low)[i] - slack && p[i] <= frame.place(frame.high)[i] + slack);
                }
            }
            assert!((0..3).all(|i| (2..=9).contains(&(frame.high[i] - frame.low[i]))), "{frame:?}");
        }
        let flat = Frame::around([[2.0, 2.0, 2.0]].into_iter());
        assert!((0..3).all(|i| flat.high[i] > flat.low[i]), "a point has a box too");
    }

    #[test]
    fn the_projection_keeps_z_upright_and_x_to_the_right() {
        let (zero, up, right) = (project([0.0; 3]), project([0.0, 0.0, 1.0]), project([1.0, 0.0, 0.0]));
        assert!(zero == (0.0, 0.0) && up.0 == 0.0 && up.1 > 0.9 && right.0 > 0.8 && right.1 < 0.0);
        let length = |v: [f64; 3]| v.iter().map(|x| x * x).sum::<f64>();
        assert!(
            (length([LOOK.0, LOOK.1, 0.0]) - 1.0).abs() < 1e-15 && (length([RISE.0, RISE.1, 0.0]) - 1.0).abs() < 1e-15
        );
    }

    #[test]
    fn a_long_path_is_written_short_and_a_gap_stays_a_gap() {
        let (short, long) = (svg(&helix(2_000), Size::wide(&helix(2))), svg(&helix(200_000), Size::wide(&helix(2))));
        assert!(short.contains("start") && short.contains("end") && short.contains("x [m]"));
        assert!(long.len() < 2_000_000, "{}", long.len());
        let mut broken = helix(100);
        broken.space.as_mut().unwrap().tracks[0].points[50] = [f64::NAN; 3];
        let text = svg(&broken, Size::wide(&broken));
        assert!(!text.contains("NaN") && text != svg(&helix(100), Size::wide(&broken)));
    }
}
