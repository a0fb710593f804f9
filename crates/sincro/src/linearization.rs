//! Files of a linearised scene: `linearization.json`, `bode.csv`, `step.csv`, the figures as SVG, `report.html`.
//!
//! JSON has no infinity; a number that is not finite is null (the time constant of an integrator, say).

use std::path::Path;

use serde::Serialize;
use sincro_analysis::linear::{Axis, Complex, DMatrix, Margin, Stability};
use sincro_analysis::linearize::{OpenLoop, Reduction};
use sincro_figures::linear::{self, Analysis, Channel};
use sincro_figures::plot::{self, Size};
use sincro_sim::file::{FileError, prepare};
use sincro_sim::table::CsvWriter;

use crate::results::write_text;

/// Writes a linear system into a folder, which is created if it is absent: `linearization.json`, `bode.csv`,
/// `step.csv`, `report.html` and the figures as SVG files. `reduction` describes the constraints that were eliminated
/// before.
///
/// # Errors
///
/// A folder or file cannot be written; the error has its path.
pub fn write(analysis: &Analysis, reduction: Option<&Reduction>, out: &Path) -> Result<(), FileError> {
    let folder = out.join("figures");
    prepare(out)?;
    prepare(&folder)?;
    write_text(&out.join("linearization.json"), &json(analysis, reduction))?;
    write_bode(analysis, &out.join("bode.csv"))?;
    write_step(analysis, &out.join("step.csv"))?;
    for (name, figure) in linear::figures(analysis) {
        write_text(&folder.join(format!("{name}.svg")), &plot::svg(&figure, Size::wide(&figure)))?;
    }
    write_text(&out.join("report.html"), &linear::html(analysis))
}

#[derive(Serialize)]
struct File<'a> {
    sincro_version: &'static str,
    title: &'a str,
    t: f64,
    sample_time: Option<f64>,
    states: Vec<Name<'a>>,
    inputs: Vec<Name<'a>>,
    outputs: Vec<Name<'a>>,
    a: Rows,
    b: Rows,
    c: Rows,
    d: Rows,
    stability: &'static str,
    poles: Vec<Pole>,
    controllable_dimensions: usize,
    observable_dimensions: usize,
    channels: Vec<ChannelFile<'a>>,
    #[serde(skip_serializing_if = "Vec::is_empty")]
    loops: Vec<LoopFile<'a>>,
    #[serde(skip_serializing_if = "Option::is_none")]
    reduction: Option<ReductionFile<'a>>,
}

#[derive(Serialize)]
struct ReductionFile<'a> {
    eliminated: Vec<Eliminated<'a>>,
    independent_equations: usize,
    of_them_holonomic: usize,
    dependent_coordinates: &'a [String],
    dependent_speeds: &'a [String],
    states_with_pole_at_zero: &'a [String],
}

#[derive(Serialize)]
struct Eliminated<'a> {
    name: &'a str,
    kind: &'static str,
    equations: usize,
}

type Rows = Vec<Vec<f64>>;

#[derive(Serialize)]
struct Name<'a> {
    name: &'a str,
    unit: &'a str,
}

#[derive(Serialize)]
struct Pole {
    pole: [f64; 2],
    damping_ratio: f64,
    natural_frequency: f64,
    time_constant: f64,
}

#[derive(Serialize)]
struct ChannelFile<'a> {
    input: &'a str,
    output: &'a str,
    zeros: Vec<[f64; 2]>,
    gain: Option<f64>,
    gain_margins_db: Vec<At>,
    phase_margins_deg: Vec<At>,
}

#[derive(Serialize)]
struct LoopFile<'a> {
    signal: &'a str,
    unit: &'a str,
    sample_time: f64,
    samples_per_period: usize,
    gain_margins_db: Vec<At>,
    phase_margins_deg: Vec<At>,
    modulus_margin: At,
    omega: &'a [f64],
    magnitude_db: Vec<Option<f64>>,
    phase_deg: &'a [f64],
}

#[derive(Serialize)]
struct At {
    omega: f64,
    value: f64,
}

/// Text of `linearization.json`: matrices A, B, C, D by rows, names and units of states, inputs and outputs, poles
/// `[1/s]`, gain margins `[dB]` and phase margins `[°]` at their frequencies `[rad/s]` of channels and of opened loops,
/// and the constraints eliminated before (`reduction`).
#[must_use]
pub fn json(analysis: &Analysis, reduction: Option<&Reduction>) -> String {
    let s = analysis.system;
    let poles = analysis.poles.iter().map(|mode| Pole {
        pole: pair(&mode.pole),
        damping_ratio: mode.damping_ratio,
        natural_frequency: mode.natural_frequency,
        time_constant: mode.time_constant,
    });
    let file = File {
        sincro_version: env!("CARGO_PKG_VERSION"),
        title: &analysis.title,
        t: s.t,
        sample_time: s.sample_time,
        states: names(&s.states),
        inputs: names(&s.inputs),
        outputs: names(&s.outputs),
        a: rows(&s.a),
        b: rows(&s.b),
        c: rows(&s.c),
        d: rows(&s.d),
        stability: match s.stability() {
            Stability::Stable => "stable",
            Stability::Marginal => "marginal",
            Stability::Unstable => "unstable",
        },
        poles: poles.collect(),
        controllable_dimensions: analysis.controllability.rank,
        observable_dimensions: analysis.observability.rank,
        channels: analysis.channels.iter().map(|channel| channel_file(analysis, channel)).collect(),
        loops: analysis.loops.iter().map(loop_file).collect(),
        reduction: reduction.filter(|reduction| !reduction.is_empty()).map(reduction_file),
    };
    let mut text = serde_json::to_string_pretty(&file).expect("numbers and texts are JSON");
    text.push('\n');
    text
}

fn reduction_file(reduction: &Reduction) -> ReductionFile<'_> {
    let eliminated =
        reduction.elements.iter().map(|e| Eliminated { name: &e.name, kind: e.kind.id(), equations: e.equations });
    ReductionFile {
        eliminated: eliminated.collect(),
        independent_equations: reduction.rank,
        of_them_holonomic: reduction.holonomic_rank,
        dependent_coordinates: &reduction.dependent_coordinates,
        dependent_speeds: &reduction.dependent_speeds,
        states_with_pole_at_zero: &reduction.cyclic,
    }
}

fn loop_file(open: &OpenLoop) -> LoopFile<'_> {
    let bode = &open.margins.bode;
    LoopFile {
        signal: &open.signal.name,
        unit: &open.signal.unit,
        sample_time: open.sample_time,
        samples_per_period: open.n_samples(),
        gain_margins_db: at(&bode.gain_margins),
        phase_margins_deg: at(&bode.phase_margins),
        modulus_margin: At { omega: open.margins.modulus_margin.omega, value: open.margins.modulus_margin.value },
        omega: &bode.omega,
        magnitude_db: bode.magnitude_db.iter().map(|x| x.is_finite().then_some(*x)).collect(),
        phase_deg: &bode.phase_deg,
    }
}

fn at(margins: &[Margin]) -> Vec<At> {
    margins.iter().map(|m| At { omega: m.omega, value: m.value }).collect()
}

fn channel_file<'a>(analysis: &'a Analysis, channel: &Channel) -> ChannelFile<'a> {
    ChannelFile {
        input: &analysis.system.inputs[channel.input].name,
        output: &analysis.system.outputs[channel.output].name,
        zeros: channel.zeros.iter().map(pair).collect(),
        gain: channel.gain,
        gain_margins_db: at(&channel.bode.gain_margins),
        phase_margins_deg: at(&channel.bode.phase_margins),
    }
}

fn names(axes: &[Axis]) -> Vec<Name<'_>> {
    axes.iter().map(|axis| Name { name: &axis.name, unit: &axis.unit }).collect()
}

fn rows(matrix: &DMatrix<f64>) -> Rows {
    matrix.row_iter().map(|row| row.iter().copied().collect()).collect()
}

fn pair(z: &Complex<f64>) -> [f64; 2] {
    [z.re, z.im]
}

/// `omega`, then magnitude `[dB]` and phase `[°]` of every channel.
fn write_bode(analysis: &Analysis, path: &Path) -> Result<(), FileError> {
    let Some(first) = analysis.channels.first() else { return Ok(()) };
    let of_channel = |channel: &Channel| {
        let name = channel_name(analysis, channel);
        [format!("{name} magnitude_db"), format!("{name} phase_deg")]
    };
    let head: Vec<String> =
        std::iter::once("omega".to_owned()).chain(analysis.channels.iter().flat_map(of_channel)).collect();
    let row = |k: usize| {
        let values = analysis.channels.iter().flat_map(move |c| [c.bode.magnitude_db[k], c.bode.phase_deg[k]]);
        std::iter::once(first.bode.omega[k]).chain(values).collect()
    };
    write_rows(path, &head, first.bode.omega.len(), row)
}

/// `t`, then the answer of every channel to a unit step.
fn write_step(analysis: &Analysis, path: &Path) -> Result<(), FileError> {
    let Some(first) = analysis.channels.first() else { return Ok(()) };
    let names = analysis.channels.iter().map(|channel| channel_name(analysis, channel));
    let head: Vec<String> = std::iter::once("t".to_owned()).chain(names).collect();
    let row = |k: usize| {
        std::iter::once(first.step.times[k]).chain(analysis.channels.iter().map(|c| c.step.values[k])).collect()
    };
    write_rows(path, &head, first.step.times.len(), row)
}

fn write_rows(path: &Path, head: &[String], n_rows: usize, row: impl Fn(usize) -> Vec<f64>) -> Result<(), FileError> {
    let head: Vec<&str> = head.iter().map(String::as_str).collect();
    let mut writer = CsvWriter::create(path, &head)?;
    for k in 0..n_rows {
        writer.push_row(&row(k))?;
    }
    writer.finish()
}

fn channel_name(analysis: &Analysis, channel: &Channel) -> String {
    let s = analysis.system;
    format!("{} -> {}", s.inputs[channel.input].name, s.outputs[channel.output].name)
}

#[cfg(test)]
mod tests {
    use sincro_figures::linear::text;
    use sincro_testing::SceneFolder;
    use sincro_testing::systems::{flexible, sampled, servo};

    use super::*;

    #[test]
    fn the_json_reads_back() {
        let system = servo();
        let json: serde_json::Value = serde_json::from_str(&json(&Analysis::of("Servo", &system), None)).unwrap();
        assert_eq!(json["a"][1][2], 2.0);
        let pole = &json["poles"][2]["pole"];
        assert!((pole[0].as_f64().unwrap() + 5.0).abs() < 1e-13 && pole[1] == 0.0, "{pole}");
        assert_eq!(json["poles"][0]["time_constant"], serde_json::Value::Null);
        assert_eq!(json["states"][2]["unit"], "A");
        assert_eq!(json["channels"][1]["zeros"], serde_json::json!([[0.0, 0.0]]));
    }

    #[test]
    fn the_folder_holds_every_file() {
        let temporary = SceneFolder::new();
        // a folder to look at, if one is named
        let out = std::env::var_os("SINCRO_LOOK").map_or(temporary.to_path_buf(), std::path::PathBuf::from);
        for (name, system) in [("servo", servo()), ("flexible", flexible()), ("sampled", sampled())] {
            let folder = out.join(name);
            std::fs::create_dir_all(&folder).unwrap();
            let analysis = Analysis::of(name, &system);
            std::fs::write(folder.join("terminal.txt"), text(&analysis)).unwrap();
            write(&analysis, None, &folder).unwrap();
            for file in ["linearization.json", "bode.csv", "step.csv", "report.html", "figures/01-bode.svg"] {
                assert!(folder.join(file).is_file(), "{file}");
            }
            let bode = std::fs::read_to_string(folder.join("bode.csv")).unwrap();
            assert!(bode.starts_with("omega,") && bode.lines().count() > 100);
        }
    }
}
