//! A linearised scene in words and tables, for the terminal. The page takes its cells from here.

use sincro_analysis::linear::{Axis, Bode, Complex, DMatrix, Mode, Stability, SubspaceRank};
use sincro_analysis::linearize::OpenLoop;

use super::{Analysis, Channel};
use crate::plot::number::{short, significant};

/// Digits of a matrix entry.
const DIGITS: usize = 5;
/// Columns of a matrix side by side; wider ones are continued below.
const MAX_COLUMNS: usize = 8;

/// A table: headings, and rows of cells. The first column reads from the left, the others are numbers.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct StateTable {
    /// Heading of each column.
    pub(super) head: Vec<String>,
    /// Rows of as many cells.
    pub(super) rows: Vec<Vec<String>>,
}

impl StateTable {
    /// A matrix with its rows named in full and its columns by symbol: `x1`, `u1`.
    pub(super) fn matrix(matrix: &DMatrix<f64>, rows: (&str, &[Axis]), column_symbol: &str, corner: &str) -> Self {
        let symbols = (1..=matrix.ncols()).map(|k| format!("{column_symbol}{k}"));
        let row = |(i, axis): (usize, &Axis)| {
            let name = format!("{}{} {}", rows.0, i + 1, named(axis));
            std::iter::once(name).chain(matrix.row(i).iter().map(|value| short(*value, DIGITS))).collect()
        };
        Self {
            head: std::iter::once(corner.to_owned()).chain(symbols).collect(),
            rows: rows.1.iter().enumerate().map(row).collect(),
        }
    }

    /// The four matrices with their titles: the dynamics, the outputs.
    pub(super) fn matrices(analysis: &Analysis) -> Vec<(&'static str, Self)> {
        let s = analysis.system;
        let (states, outputs) = ("x", "y");
        let dynamics = if s.sample_time.is_some() { "next x" } else { "d/dt x" };
        [
            ("A", Self::matrix(&s.a, (states, &s.states), "x", dynamics)),
            ("B", Self::matrix(&s.b, (states, &s.states), "u", dynamics)),
            ("C", Self::matrix(&s.c, (outputs, &s.outputs), "x", "y")),
            ("D", Self::matrix(&s.d, (outputs, &s.outputs), "u", "y")),
        ]
        .into_iter()
        .filter(|(_, table)| !table.rows.is_empty() && table.head.len() > 1)
        .collect()
    }

    /// The poles, a pair a row.
    pub(super) fn poles(analysis: &Analysis) -> Self {
        let pole = format!("pole{}", rate_unit(analysis));
        let head = [pole.as_str(), "damping ζ", "ω_n [rad/s]", "time constant [s]"].map(str::to_owned).to_vec();
        let is_first = |mode: &&Mode| mode.pole.im >= 0.0;
        let row = |mode: &Mode| {
            let value = |x: f64| short(x, DIGITS);
            vec![
                complex(mode.pole),
                value(mode.damping_ratio),
                value(mode.natural_frequency),
                value(mode.time_constant),
            ]
        };
        Self { head, rows: analysis.poles.iter().filter(is_first).map(row).collect() }
    }

    /// The channels: gain, zeros, margins.
    pub(super) fn channels(analysis: &Analysis) -> Self {
        let zero = format!("zeros{}", rate_unit(analysis));
        let head = ["channel", "static gain", "gain margin", "phase margin", &zero].map(str::to_owned).to_vec();
        let row = |channel: &Channel| {
            let gain = channel.gain.map_or("∞".to_owned(), |gain| {
                format!("{} {}", short(gain, DIGITS), analysis.gain_unit(channel)).trim_end().to_owned()
            });
            let (gain_margin, phase_margin) = margins(&channel.bode);
            vec![analysis.name(channel), gain, gain_margin, phase_margin, zeros(&channel.zeros)]
        };
        Self { head, rows: analysis.channels.iter().map(row).collect() }
    }

    /// The opened loops: sample times, margins.
    pub(super) fn loops(analysis: &Analysis) -> Self {
        let head =
            ["loop opened at", "sample time [s]", "samples a period", "gain margin", "phase margin", "modulus margin"];
        let row = |open: &OpenLoop| {
            let (gain, phase) = margins(&open.margins.bode);
            let modulus = open.margins.modulus_margin;
            vec![
                named(&open.signal),
                short(open.sample_time, 6),
                open.n_samples().to_string(),
                gain,
                phase,
                at_frequency(modulus.value, "", modulus.omega),
            ]
        };
        Self { head: head.map(str::to_owned).to_vec(), rows: analysis.loops.iter().map(row).collect() }
    }

    /// Aligned text, two blanks between columns.
    fn aligned(&self, indent: &str) -> String {
        let length = |text: &str| text.chars().count();
        let mut out = String::new();
        let columns: Vec<usize> = (1..self.head.len()).collect();
        let first = self.all_cells(0).map(length).max().unwrap_or(0);
        for chunk in columns.chunks(MAX_COLUMNS) {
            let widths: Vec<usize> = chunk.iter().map(|&k| self.all_cells(k).map(length).max().unwrap_or(0)).collect();
            for row in std::iter::once(&self.head).chain(&self.rows) {
                let mut line = format!("{indent}{:<first$}", row[0]);
                for (&k, width) in chunk.iter().zip(&widths) {
                    line += &format!("  {:>width$}", row[k]);
                }
                out += line.trim_end();
                out.push('\n');
            }
        }
        out
    }

    fn all_cells(&self, column: usize) -> impl Iterator<Item = &str> {
        std::iter::once(&self.head).chain(&self.rows).map(move |row| row[column].as_str())
    }
}

/// Summary, poles, channels and matrices of a linear system as text for a terminal, in lines of less than 130 columns.
#[must_use]
pub fn text(analysis: &Analysis) -> String {
    let mut out = format!("{}\n", analysis.title);
    out += &format!("  {}\n", summary(analysis));
    for (k, input) in analysis.system.inputs.iter().enumerate() {
        out += &format!("  u{} is {}\n", k + 1, named(input));
    }
    if !analysis.reduction.is_empty() {
        out += "\nreduced to independent coordinates\n";
        for line in &analysis.reduction {
            out += &format!("  {line}\n");
        }
    }
    for (title, table) in StateTable::matrices(analysis) {
        out += &format!("\n{title}\n{}", table.aligned("  "));
    }
    out += &format!("\npoles: {}\n{}", stability(analysis), StateTable::poles(analysis).aligned("  "));
    for line in reach_lines(analysis) {
        out += &format!("  {line}\n");
    }
    if !analysis.channels.is_empty() {
        out += &format!("\nchannels\n{}", StateTable::channels(analysis).aligned("  "));
    }
    for silent in &analysis.silent {
        out += &format!("  {silent}\n");
    }
    if !analysis.loops.is_empty() {
        out += &format!("\nopen loops, closed by −1\n{}", StateTable::loops(analysis).aligned("  "));
        for line in loop_notes(analysis) {
            out += &format!("  {line}\n");
        }
    }
    out
}

/// Meaning of the margins of loops with several samples in a period.
pub(super) fn loop_notes(analysis: &Analysis) -> Vec<String> {
    let is_lifted = analysis.loops.iter().any(|open| open.n_samples() > 1);
    let lines = [
        "several samples in a period: the gain margin is the factor on all of them, the phase margin the angle of all loci,",
        "at which a pole reaches the unit circle; the modulus margin is the smallest singular value of I + L,",
        "its frequency that of the period",
    ];
    if is_lifted { lines.map(str::to_owned).to_vec() } else { Vec::new() }
}

/// Unit of poles and zeros; those of a sampled system are factors of one tick.
fn rate_unit(analysis: &Analysis) -> &'static str {
    if analysis.system.sample_time.is_some() { " a tick" } else { " [1/s]" }
}

/// Sizes and operating point.
pub(super) fn summary(analysis: &Analysis) -> String {
    let s = analysis.system;
    let count = |n: usize, what: &str| format!("{n} {what}{}", if n == 1 { "" } else { "s" });
    let kind = match s.sample_time {
        None => "continuous".to_owned(),
        Some(tick) => format!("sampled every {} s", short(tick, 6)),
    };
    format!(
        "linearised at t = {} s, {kind}: {}, {}, {}",
        short(s.t, 9),
        count(s.n_states(), "state"),
        count(s.n_inputs(), "input"),
        count(s.n_outputs(), "output")
    )
}

/// Stability, in words.
pub(super) fn stability(analysis: &Analysis) -> &'static str {
    match analysis.system.stability() {
        Stability::Stable => "stable, every small disturbance decays",
        Stability::Marginal => "at the margin, some small disturbance neither grows nor decays to first order",
        Stability::Unstable => "unstable, some small disturbance grows",
    }
}

/// Controllability and observability in words.
pub(super) fn reach_lines(analysis: &Analysis) -> [String; 2] {
    let line = |reach: &SubspaceRank, whole: &str, act: &str| {
        if reach.is_full() {
            return format!("{whole}: yes, all {} dimensions", reach.n_states);
        }
        let names: Vec<String> =
            reach.outside.iter().map(|&k| format!("`{}`", analysis.system.states[k].name)).collect();
        let outside = if names.is_empty() { String::new() } else { format!("; {act} {}", names.join(", ")) };
        format!("{whole}: {} of {} dimensions{outside}", reach.rank, reach.n_states)
    };
    [
        line(&analysis.controllability, "controllable", "no input reaches"),
        line(&analysis.observability, "observable", "no output sees"),
    ]
}

/// Gain and phase margin in words: `9.54 dB at 2.24 rad/s`.
pub(super) fn margins(bode: &Bode) -> (String, String) {
    (
        bode.gain_margin().map_or("–".into(), |margin| at_frequency(margin.value, " dB", margin.omega)),
        bode.phase_margin().map_or("–".into(), |margin| at_frequency(margin.value, "°", margin.omega)),
    )
}

fn at_frequency(value: f64, unit: &str, omega: f64) -> String {
    format!("{}{unit} at {} rad/s", significant(value, 3), significant(omega, 3))
}

/// `−1.5 ± 4.77j`: a pair, or a real number.
pub(super) fn complex(z: Complex<f64>) -> String {
    if z.im == 0.0 {
        return short(z.re, DIGITS);
    }
    let real = if z.re == 0.0 { String::new() } else { format!("{} ", short(z.re, DIGITS)) };
    format!("{real}± {}j", short(z.im.abs(), DIGITS))
}

/// Zeros, a pair once.
pub(super) fn zeros(zeros: &[Complex<f64>]) -> String {
    let all: Vec<String> = zeros.iter().filter(|zero| zero.im >= 0.0).map(|zero| complex(*zero)).collect();
    if all.is_empty() { "none".to_owned() } else { all.join(", ") }
}

/// `/cart/rail.position [m]`.
pub(super) fn named(axis: &Axis) -> String {
    if axis.unit.is_empty() { axis.name.clone() } else { format!("{} [{}]", axis.name, axis.unit) }
}
