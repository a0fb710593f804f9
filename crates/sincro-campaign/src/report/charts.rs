//! Drawings of a campaign that are no line charts: scatter matrix, response surface, bars of sensitivities.
//!
//! SVG for a page that carries the style of the figures, whose colours they take.

use std::fmt::Write as _;

use sincro_figures::plot::escape;
use sincro_figures::plot::number::{fixed, significant};

/// An axis of the scatter matrix.
pub(super) struct ScatterAxis<'a> {
    pub(super) name: &'a str,
    pub(super) unit: &'a str,
    pub(super) values: &'a [f64],
}

/// A label cut to so many characters.
fn cut(text: &str, n: usize) -> String {
    if text.chars().count() <= n { text.to_owned() } else { text.chars().take(n - 1).chain(['…']).collect() }
}

/// Last part of a path: what tells axes apart where there is no room.
fn tail(name: &str) -> &str {
    name.rsplit('/').next().filter(|tail| !tail.is_empty()).unwrap_or(name)
}

fn range(values: &[f64]) -> Option<(f64, f64)> {
    let finite = values.iter().copied().filter(|x| x.is_finite());
    let (low, high) = finite.fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), x| (a.min(x), b.max(x)));
    (low < high).then_some((low, high))
}

/// Coordinate with a tenth of a pixel.
fn px(x: f64) -> String {
    fixed(x, 1)
}

/// Every variable against every other; bad runs stand out in colour and shape.
pub(super) fn scatter_matrix(axes: &[ScatterAxis<'_>], good: &[bool]) -> String {
    const SIDE: f64 = 880.0;
    const LEFT: f64 = 74.0;
    const BOTTOM: f64 = 46.0;
    let axes: Vec<(&ScatterAxis<'_>, (f64, f64))> =
        axes.iter().filter_map(|axis| range(axis.values).map(|range| (axis, range))).collect();
    let n = axes.len();
    if n < 2 {
        return String::new();
    }
    let cell = (SIDE - LEFT) / n as f64;
    let height = n as f64 * cell.min(170.0);
    let high = height / n as f64;
    let gap = 6.0;
    let stride = good.len().div_ceil(700).max(1);
    let mut out = format!(
        "<svg class=\"sp\" viewBox=\"0 0 {} {}\" role=\"img\" aria-label=\"scatter matrix\">\n",
        px(SIDE),
        px(height + BOTTOM)
    );
    for (row, (y_axis, y_range)) in axes.iter().enumerate() {
        for (column, (x_axis, x_range)) in axes.iter().enumerate() {
            let (x0, y0) = (LEFT + column as f64 * cell, row as f64 * high);
            let (w, h) = (cell - gap, high - gap);
            let _ = writeln!(
                out,
                "<rect x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\" fill=\"none\" stroke=\"var(--sp-grid)\"/>",
                px(x0),
                px(y0),
                px(w),
                px(h)
            );
            if row == column {
                out += &bars_of(y_axis.values, *y_range, (x0, y0, w, h));
                continue;
            }
            let at = |value: f64, (low, high): (f64, f64)| 0.04 + 0.92 * (value - low) / (high - low);
            let (mut of_good, mut of_bad) = (String::new(), String::new());
            for k in (0..good.len()).step_by(stride) {
                let (x, y) = (x_axis.values[k], y_axis.values[k]);
                if !x.is_finite() || !y.is_finite() {
                    continue;
                }
                let (cx, cy) = (x0 + w * at(x, *x_range), y0 + h * (1.0 - at(y, *y_range)));
                if good[k] {
                    let _ = write!(of_good, "M{} {}h0", px(cx), px(cy));
                } else {
                    let (a, b) = (cx - 2.0, cy - 2.0);
                    let _ = write!(of_bad, "M{} {}l4 4m-4 0l4 -4", px(a), px(b));
                }
            }
            if !of_good.is_empty() {
                let _ = writeln!(
                    out,
                    "<path d=\"{of_good}\" stroke=\"var(--sp-c0)\" stroke-width=\"3\" stroke-linecap=\"round\" opacity=\"0.6\"/>"
                );
            }
            if !of_bad.is_empty() {
                let _ =
                    writeln!(out, "<path d=\"{of_bad}\" stroke=\"var(--sp-c1)\" stroke-width=\"1.2\" fill=\"none\"/>");
            }
        }
        let middle = row as f64 * high + 0.5 * (high - gap);
        out += &label_of_axis(y_axis, *y_range, (LEFT - 8.0, middle, high - gap), true);
    }
    for (column, (axis, range)) in axes.iter().enumerate() {
        let middle = LEFT + column as f64 * cell + 0.5 * (cell - gap);
        out += &label_of_axis(axis, *range, (middle, height + 10.0, cell - gap), false);
    }
    out + "</svg>\n"
}

/// Name and ends of an axis of the matrix.
fn label_of_axis(
    axis: &ScatterAxis<'_>,
    (low, high): (f64, f64),
    (x, y, length): (f64, f64, f64),
    is_y: bool,
) -> String {
    let room = ((length / 6.6) as usize).clamp(5, 22);
    let unit = if axis.unit.is_empty() { String::new() } else { format!(" [{}]", axis.unit) };
    let name = escape(&cut(&format!("{}{unit}", tail(axis.name)), room));
    let (low, high) = (escape(&significant(low, 3)), escape(&significant(high, 3)));
    let style = "font-size=\"10.5\" fill=\"var(--sp-quiet)\"";
    if is_y {
        let half = 0.5 * length;
        format!(
            "<text transform=\"translate({} {}) rotate(-90)\" text-anchor=\"middle\" font-size=\"12\">{name}</text>\n\
             <text x=\"{}\" y=\"{}\" text-anchor=\"end\" {style}>{high}</text>\n\
             <text x=\"{}\" y=\"{}\" text-anchor=\"end\" {style}>{low}</text>\n",
            px(x - 50.0),
            px(y),
            px(x + 4.0),
            px(y - half + 11.0),
            px(x + 4.0),
            px(y + half - 3.0)
        )
    } else {
        let half = 0.5 * length;
        format!(
            "<text x=\"{}\" y=\"{}\" text-anchor=\"middle\" font-size=\"12\">{name}</text>\n\
             <text x=\"{}\" y=\"{}\" {style}>{low}</text>\n<text x=\"{}\" y=\"{}\" text-anchor=\"end\" {style}>{high}</text>\n",
            px(x),
            px(y + 22.0),
            px(x - half),
            px(y + 4.0),
            px(x + half),
            px(y + 4.0)
        )
    }
}

/// Histogram of the diagonal.
fn bars_of(values: &[f64], (low, high): (f64, f64), (x, y, w, h): (f64, f64, f64, f64)) -> String {
    const N: usize = 16;
    let mut counts = [0_usize; N];
    for value in values.iter().filter(|value| value.is_finite()) {
        counts[((N as f64 * (value - low) / (high - low)) as usize).min(N - 1)] += 1;
    }
    let most = counts.iter().max().copied().unwrap_or(1).max(1) as f64;
    let mut out = String::new();
    for (k, count) in counts.iter().enumerate() {
        let (width, height) = (0.92 * w / N as f64, 0.9 * h * *count as f64 / most);
        let left = x + 0.04 * w + k as f64 * width;
        let _ = writeln!(
            out,
            "<rect x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\" fill=\"var(--sp-c0)\" opacity=\"0.35\"/>",
            px(left),
            px(y + h - height),
            px(width - 1.0),
            px(height)
        );
    }
    out
}

/// A bar of a tornado diagram: name, value between −1 and 1, its interval.
pub(super) struct Bar {
    pub(super) name: String,
    pub(super) value: f64,
    pub(super) interval: (f64, f64),
}

/// Horizontal bars about zero with their intervals, the longest on top.
pub(super) fn tornado(bars: &[Bar], label: &str, from_zero: bool) -> String {
    const WIDTH: f64 = 880.0;
    const LEFT: f64 = 230.0;
    const ROW: f64 = 26.0;
    let most = bars
        .iter()
        .flat_map(|b| [b.value.abs(), b.interval.0.abs(), b.interval.1.abs()])
        .filter(|x| x.is_finite())
        .fold(0.0, f64::max)
        .max(1e-9);
    let most = if from_zero { most.max(0.2) } else { most.clamp(0.2, 1.0) };
    let (x0, span) = if from_zero {
        (LEFT, WIDTH - LEFT - 70.0)
    } else {
        (0.5 * (LEFT + WIDTH - 70.0), 0.5 * (WIDTH - LEFT - 70.0))
    };
    let at = |value: f64| x0 + span * (value / most).clamp(if from_zero { 0.0 } else { -1.0 }, 1.0);
    let height = bars.len() as f64 * ROW;
    let mut out = format!(
        "<svg class=\"sp\" viewBox=\"0 0 {} {}\" role=\"img\" aria-label=\"{}\">\n",
        px(WIDTH),
        px(height + 34.0),
        escape(label)
    );
    for (k, bar) in bars.iter().enumerate() {
        let y = k as f64 * ROW + 4.0;
        let (a, b) = (at(0.0).min(at(bar.value)), at(0.0).max(at(bar.value)));
        let colour = if bar.value < 0.0 { "--sp-c1" } else { "--sp-c0" };
        let _ = writeln!(
            out,
            "<text x=\"{}\" y=\"{}\" text-anchor=\"end\" font-size=\"13\">{}</text>",
            px(LEFT - 10.0),
            px(y + 13.0),
            escape(&cut(tail(&bar.name), 32))
        );
        let _ = writeln!(
            out,
            "<rect x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\" fill=\"var({colour})\" opacity=\"0.75\"/>",
            px(a),
            px(y),
            px((b - a).max(0.5)),
            px(ROW - 9.0)
        );
        if bar.interval.0.is_finite() && bar.interval.1.is_finite() {
            let middle = y + 0.5 * (ROW - 9.0);
            let _ = writeln!(
                out,
                "<path d=\"M{} {}H{}m0 -4v8M{} {}v8\" stroke=\"var(--sp-ink)\" stroke-width=\"1.3\" fill=\"none\"/>",
                px(at(bar.interval.0)),
                px(middle),
                px(at(bar.interval.1)),
                px(at(bar.interval.0)),
                px(middle - 4.0)
            );
        }
        let _ = writeln!(
            out,
            "<text x=\"{}\" y=\"{}\" text-anchor=\"end\" font-size=\"12\" fill=\"var(--sp-quiet)\">{}</text>",
            px(WIDTH - 4.0),
            px(y + 13.0),
            escape(&significant(bar.value, 2))
        );
    }
    let _ = writeln!(
        out,
        "<path d=\"M{} 0V{}\" stroke=\"var(--sp-quiet)\"/>\n<text x=\"{}\" y=\"{}\" text-anchor=\"middle\" font-size=\"12\">{}</text>\n</svg>",
        px(at(0.0)),
        px(height),
        px(x0 + if from_zero { 0.5 * span } else { 0.0 }),
        px(height + 24.0),
        escape(label)
    );
    out
}

/// A response surface on a square of cells.
pub(super) struct Surface<'a> {
    pub(super) x: (&'a str, &'a str, f64, f64),
    pub(super) y: (&'a str, &'a str, f64, f64),
    pub(super) name: &'a str,
    pub(super) unit: &'a str,
    /// Value at shares of the ranges.
    pub(super) value: &'a dyn Fn(f64, f64) -> f64,
    /// Bad runs, as shares of the ranges.
    pub(super) bad: Vec<(f64, f64)>,
}

/// Corners of a colour scale that is read in grey and by colour-blind eyes: dark blue, green, yellow.
const SCALE: [[f64; 3]; 4] = [[0.20, 0.16, 0.44], [0.16, 0.47, 0.56], [0.37, 0.75, 0.45], [0.98, 0.90, 0.30]];

fn colour(share: f64) -> String {
    let place = share.clamp(0.0, 1.0) * (SCALE.len() - 1) as f64;
    let below = (place as usize).min(SCALE.len() - 2);
    let part = place - below as f64;
    let byte = |c: usize| (255.0 * (SCALE[below][c] + part * (SCALE[below + 1][c] - SCALE[below][c]))).round() as u8;
    format!("#{:02x}{:02x}{:02x}", byte(0), byte(1), byte(2))
}

/// Heat map with a scale beside it.
pub(super) fn surface(of: &Surface<'_>) -> String {
    const N: usize = 30;
    const LEFT: f64 = 90.0;
    const WIDTH: f64 = 600.0;
    const HEIGHT: f64 = 360.0;
    let share = |k: usize| (k as f64 + 0.5) / N as f64;
    let cells: Vec<f64> = (0..N * N).map(|k| (of.value)(share(k % N), share(k / N))).collect();
    let Some((low, high)) = range(&cells) else { return String::new() };
    let mut out = format!(
        "<svg class=\"sp\" viewBox=\"0 0 880 {}\" role=\"img\" aria-label=\"response surface\">\n",
        px(HEIGHT + 48.0)
    );
    let (w, h) = (WIDTH / N as f64, HEIGHT / N as f64);
    for (k, value) in cells.iter().enumerate() {
        let (i, j) = (k % N, k / N);
        let _ = writeln!(
            out,
            "<rect x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\" fill=\"{}\"/>",
            px(LEFT + i as f64 * w),
            px(HEIGHT - (j + 1) as f64 * h),
            px(w + 0.4),
            px(h + 0.4),
            colour((value - low) / (high - low))
        );
    }
    let crosses: String = of
        .bad
        .iter()
        .take(400)
        .map(|(x, y)| format!("M{} {}l6 6m-6 0l6 -6", px(LEFT + x * WIDTH - 3.0), px(HEIGHT * (1.0 - y) - 3.0)))
        .collect();
    let _ = writeln!(out, "<path d=\"{crosses}\" stroke=\"#fff\" stroke-width=\"2.6\" fill=\"none\"/>");
    let _ = writeln!(out, "<path d=\"{crosses}\" stroke=\"#b3261e\" stroke-width=\"1.4\" fill=\"none\"/>");
    let end = |x: f64, y: f64, anchor: &str, value: f64| {
        format!(
            "<text x=\"{}\" y=\"{}\" text-anchor=\"{anchor}\" font-size=\"12\" fill=\"var(--sp-quiet)\">{}</text>\n",
            px(x),
            px(y),
            escape(&significant(value, 3))
        )
    };
    out += &end(LEFT, HEIGHT + 18.0, "start", of.x.2);
    out += &end(LEFT + WIDTH, HEIGHT + 18.0, "end", of.x.3);
    out += &end(LEFT - 8.0, HEIGHT, "end", of.y.2);
    out += &end(LEFT - 8.0, 12.0, "end", of.y.3);
    let named = |name: &str, unit: &str| {
        if unit.is_empty() { cut(tail(name), 40) } else { format!("{} [{unit}]", cut(tail(name), 34)) }
    };
    let _ = writeln!(
        out,
        "<text x=\"{}\" y=\"{}\" text-anchor=\"middle\" font-size=\"13\">{}</text>\n\
         <text transform=\"translate(16 {}) rotate(-90)\" text-anchor=\"middle\" font-size=\"13\">{}</text>",
        px(LEFT + 0.5 * WIDTH),
        px(HEIGHT + 40.0),
        escape(&named(of.x.0, of.x.1)),
        px(0.5 * HEIGHT),
        escape(&named(of.y.0, of.y.1))
    );
    let bar = LEFT + WIDTH + 30.0;
    for k in 0..60 {
        let part = k as f64 / 60.0;
        let _ = writeln!(
            out,
            "<rect x=\"{}\" y=\"{}\" width=\"18\" height=\"{}\" fill=\"{}\"/>",
            px(bar),
            px((1.0 - part) * (HEIGHT - 40.0) + 34.0 - (HEIGHT - 40.0) / 60.0),
            px((HEIGHT - 40.0) / 60.0 + 0.4),
            colour(part)
        );
    }
    out += &end(bar + 26.0, 44.0, "start", high);
    out += &end(bar + 26.0, HEIGHT - 8.0, "start", low);
    let _ = writeln!(
        out,
        "<text x=\"{}\" y=\"16\" font-size=\"13\">{}</text>\n</svg>",
        px(bar),
        escape(&cut(&named(of.name, of.unit), 24))
    );
    out
}
