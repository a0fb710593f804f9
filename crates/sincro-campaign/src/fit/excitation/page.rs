//! `report.html` of an excitation: input and predicted intervals, before and after.

use std::sync::atomic::AtomicBool;

use sincro_figures::plot::number::{short, significant};
use sincro_figures::plot::{Axis, Figure, Panel, Role, Series, Stroke, escape, escape_raised};
use sincro_figures::report::figure;
use sincro_figures::report::shell::{PLOT_SCRIPT, cell, document, list, paragraph, sections, settings, table};
use sincro_sim::run::{RunMonitor, RunOptions, simulate};
use sincro_sim::table::Table;

use super::super::exact::unit;
use super::{Excitation, Excited, Information};

/// Figures of signals.
const MAX_FIGURES: usize = 6;

/// The page.
pub(super) fn html(of: &Excitation<'_>, excited: &Excited) -> String {
    let all = [
        ("Input", input(of, excited)),
        ("Predicted intervals", intervals(of, excited)),
        ("Motion", motions(of, excited)),
        ("Search", search(excited)),
        ("Settings", settings(&setting_rows(of, excited))),
    ]
    .map(|(heading, content)| (heading.to_owned(), content));
    let title = format!("{}: the input that tells most", of.loaded.experiment.title);
    document(&title, "report", &(header(&title, of, excited) + &sections(&all) + PLOT_SCRIPT))
}

fn header(title: &str, of: &Excitation<'_>, excited: &Excited) -> String {
    let is_better = excited.after.log_det.is_finite();
    let (class, symbol) = if is_better { ("good", "✓") } else { ("bad", "✗") };
    let words = match (excited.before.log_det.is_finite(), is_better) {
        (_, false) => "no input of the family identifies all parameters".to_owned(),
        (false, true) => "the present input does not identify all parameters, the proposed one does".to_owned(),
        (true, true) => {
            let n = of.free.len() as f64;
            let gain = sincro_math::elementary::exp(0.5 * (excited.after.log_det - excited.before.log_det) / n).0;
            format!("the intervals become {} times narrower in the geometric mean", significant(gain, 3))
        }
    };
    let n: usize = of.data.iter().map(|set| set.columns.len() * set.times.len()).sum();
    let lead = format!("{} parameters from {n} measured values with the noise as given.", of.free.len());
    format!(
        "<header>\n<h1>{}</h1>\n{}<div class=\"banner {class}\" role=\"status\"><p class=\"verdict\"><span aria-hidden=\"true\">{symbol}</span> \
         {words}</p></div>\n</header>\n",
        escape(title),
        paragraph("lead", &lead)
    )
}

fn number(x: f64, digits: usize) -> String {
    if x.is_finite() { escape_raised(&significant(x, digits)) } else { "not identifiable".into() }
}

fn input(of: &Excitation<'_>, excited: &Excited) -> String {
    let rows: Vec<String> = of
        .input
        .iter()
        .enumerate()
        .map(|(k, input)| {
            let bounds = format!("{} … {}", short(input.low, 6), short(input.high, 6));
            [
                cell("Number", "name", &format!("<code>{}</code>", escape(&input.path))),
                cell("Before", "num", &number(excited.before.input[k], 5)),
                cell("After", "num", &number(excited.after.input[k], 5)),
                cell("Bounds", "", &escape_raised(&bounds)),
            ]
            .concat()
        })
        .collect();
    table("fold", &[("", "Number"), ("num", "Before"), ("num", "After"), ("", "Bounds")], &rows)
        + &format!(
            "<p class=\"key\">Run with this input: <code>{}</code></p>\n",
            escape(&of.command(&excited.after.input))
        )
}

fn intervals(of: &Excitation<'_>, excited: &Excited) -> String {
    let rows: Vec<String> = of
        .free
        .iter()
        .enumerate()
        .map(|(k, free)| {
            let width = |information: &Information| {
                let half = information.half_widths[k];
                let share = if half.is_finite() && free.start != 0.0 {
                    format!(" ({} %)", escape_raised(&significant(100.0 * (half / free.start).abs(), 2)))
                } else {
                    String::new()
                };
                let sign = if half.is_finite() { "± " } else { "" };
                format!("{sign}{}{share}", number(half, 2))
            };
            [
                cell("Parameter", "name", &format!("<code>{}</code>", escape(&free.path))),
                cell("Value", "num", &number(free.start, 5)),
                cell("Before", "num", &width(&excited.before)),
                cell("After", "num", &width(&excited.after)),
            ]
            .concat()
        })
        .collect();
    table("fold", &[("", "Parameter"), ("num", "Value"), ("num", "Before"), ("num", "After")], &rows)
        + &format!(
            "<p class=\"key\">Half widths of the intervals at {} % that data with this noise will have at best, in the units of the \
             parameters. The proposed input has the greatest determinant of the Fisher information among those tried.</p>\n",
            short(100.0 * of.confidence, 4)
        )
}

/// Motion under an input.
fn motion(of: &Excitation<'_>, information: &Information) -> Option<Table> {
    let loaded = of.loaded.with_overrides_without_variants(&of.settings(&information.input)).ok()?;
    let mut monitor = RunMonitor { interrupt: &AtomicBool::new(false), progress: &mut |_| {} };
    simulate(&loaded, RunOptions::default(), &mut monitor).ok().map(|run| run.table)
}

fn motions(of: &Excitation<'_>, excited: &Excited) -> String {
    let (Some(before), Some(after)) = (motion(of, &excited.before), motion(of, &excited.after)) else {
        return String::new();
    };
    let figures: String = after
        .columns
        .iter()
        .skip(1)
        .filter(|column| column.name != "energy.balance")
        .take(MAX_FIGURES)
        .filter_map(|column| {
            let old = before.column(&column.name)?;
            let label = column.name.rsplit('/').next().unwrap_or(&column.name);
            let mut panel = Panel::new(Axis::new(label, unit(of.loaded, &column.name)));
            let series = |name: &str, role, table: &Table, values: &[f64]| {
                Series::new(name, role, table.times().to_vec(), values.to_vec())
            };
            panel.series.push(series("before", Role::Variant(0), &before, &old.values));
            panel.series.push(series("after", Role::Simulated, &after, &column.values));
            Some(figure(&Figure { title: column.name.clone(), x: Axis::time(), panels: vec![panel], space: None }))
        })
        .collect();
    format!("<div class=\"figures\">\n{figures}</div>\n")
}

fn search(excited: &Excited) -> String {
    let finite = excited.history.iter().filter(|(_, log_det)| log_det.is_finite());
    let (mut x, mut y): (Vec<f64>, Vec<f64>) = finite.map(|(n, log_det)| (*n as f64, *log_det)).unzip();
    if y.is_empty() {
        return String::new();
    }
    x.push(excited.n_tried as f64);
    y.push(excited.after.log_det);
    let mut panel = Panel::new(Axis::new("log det F", ""));
    panel.series.push(Series { stroke: Stroke::Steps, ..Series::new("best so far", Role::Simulated, x, y) });
    let title = "Information of the best input".to_owned();
    figure(&Figure { title, x: Axis::new("inputs tried", ""), panels: vec![panel], space: None })
        + &list(&excited.sensitivities.iter().map(|words| format!("Sensitivities {words}.")).collect::<Vec<_>>())
}

fn setting_rows(of: &Excitation<'_>, excited: &Excited) -> Vec<(String, String)> {
    let signals: Vec<String> = of
        .data
        .iter()
        .flat_map(|set| &set.columns)
        .map(|c| format!("{} ± {} {}", c.signal, significant(1.0 / c.weight, 3), unit(of.loaded, &c.signal)))
        .collect();
    vec![
        ("measured signals and noise".into(), signals.join(", ")),
        ("criterion".into(), "D-optimal".into()),
        ("method".into(), "CMA-ES".into()),
        ("inputs tried".into(), excited.n_tried.to_string()),
        ("seed".into(), of.seed.to_string()),
        ("wall time".into(), format!("{} s", significant(excited.wall_time, 2))),
        ("sincro".into(), env!("CARGO_PKG_VERSION").into()),
    ]
}
