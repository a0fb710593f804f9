//! `report.html` of a campaign: yield first, then distributions, then causes, then the worst runs.

use sincro_figures::plot::number::{short, significant};
use sincro_figures::plot::{Axis, Figure, Guide, Panel, Role, Series, Stroke, Weight, escape, escape_raised};
use sincro_figures::report::figure;
use sincro_figures::report::shell::{PLOT_SCRIPT, cell, document, paragraph, sections, settings, table};

use super::charts::{Bar, ScatterAxis, Surface, scatter_matrix, surface, tornado};
use super::{Replay, Summary, ascending};
use crate::statistics::{correlation, correlation_interval, least_squares, quantile, quantile_interval, ranks, wilson};
use crate::store::{Manifest, Store};

/// Figures of distributions on the page; the table and `summary.json` have all measures.
const MAX_FIGURES: usize = 8;
/// Axes of the scatter matrix of each kind.
const MAX_PARAMETERS: usize = 4;
const MAX_MEASURES: usize = 3;
/// Measures whose causes are shown.
const MAX_CAUSES: usize = 3;

/// The page.
pub(super) fn html(store: &Store, summary: &Summary, replays: &[Replay]) -> String {
    let manifest = &store.manifest;
    let all = [
        ("Yield", yield_table(manifest, summary)),
        ("Worst runs", worst(store, summary, replays)),
        ("Measures", measures(manifest, summary)),
        ("Distributions", distributions(manifest, summary)),
        ("Sensitivities", sensitivities(manifest, summary)),
        ("Response surfaces", surfaces(manifest, summary)),
        ("Scatter matrix", scatter(manifest, summary)),
        ("Parameters", parameters(manifest)),
        ("Settings", settings(&setting_rows(store, summary))),
    ]
    .map(|(heading, content)| (heading.to_owned(), content));
    document(&manifest.title, "report", &(header(manifest, summary) + &sections(&all) + PLOT_SCRIPT))
}

fn percent(x: f64) -> String {
    format!("{} %", significant(100.0 * x, 4))
}

fn header(manifest: &Manifest, summary: &Summary) -> String {
    let (low, high) = summary.yield_interval(manifest.confidence);
    let share = summary.n_good as f64 / summary.n.max(1) as f64;
    let (class, symbol) = if summary.n_good == summary.n { ("good", "✓") } else { ("bad", "✗") };
    format!(
        "<header>\n<h1>{}</h1>\n{}<div class=\"banner {class}\" role=\"status\"><p class=\"verdict\"><span aria-hidden=\"true\">{symbol}</span> \
         {} of {} runs are good: {}</p><p>The yield lies between {} and {} at {} confidence.</p></div>\n</header>\n",
        escape(&manifest.title),
        paragraph("lead", &manifest.description),
        summary.n_good,
        summary.n,
        percent(share),
        percent(low),
        percent(high),
        percent(manifest.confidence)
    )
}

fn yield_table(manifest: &Manifest, summary: &Summary) -> String {
    let row = |name: &str, n: u64, good: u64| {
        let (low, high) = wilson(good, n, manifest.confidence);
        [
            cell("Of", "name", &escape(name)),
            cell("Runs", "num", &n.to_string()),
            cell("Good", "num", &good.to_string()),
            cell("Share", "num", &percent(good as f64 / n.max(1) as f64)),
            cell("From", "num", &percent(low)),
            cell("To", "num", &percent(high)),
        ]
        .concat()
    };
    let mut rows = vec![row("all runs", summary.n, summary.n_good)];
    if summary.variants.len() > 1 {
        rows.extend(summary.variants.iter().map(|(name, n, good)| row(&format!("variant {name}"), *n, *good)));
    }
    for (j, column) in manifest.measures.iter().enumerate() {
        let limit = [
            column.at_most.map(|x| format!("≤ {}", short(x, 6))),
            column.at_least.map(|x| format!("≥ {}", short(x, 6))),
        ];
        let limit: Vec<String> = limit.into_iter().flatten().collect();
        if !limit.is_empty() {
            let name = format!("{} {} {}", column.name, limit.join(", "), column.unit);
            rows.push(row(name.trim_end(), summary.n, summary.n - summary.misses[j]));
        }
    }
    for (word, n) in
        summary.statuses.iter().filter(|(word, n)| *n > 0 && matches!(word.as_str(), "stopped" | "refused"))
    {
        let name = if word == "stopped" { "runs that came to their end" } else { "runs whose values the scene takes" };
        rows.push(row(name, summary.n, summary.n - n));
    }
    if summary.n_with_findings > 0 {
        rows.push(row("runs without findings of the audit", summary.n, summary.n - summary.n_with_findings));
    }
    let columns = [("", "Of"), ("num", "Runs"), ("num", "Good"), ("num", "Share"), ("num", "From"), ("num", "To")];
    table("fold", &columns, &rows)
        + "<p class=\"key\">A run is good if it comes to its end, keeps all limits and holds all measured checks. From and to: Wilson's \
           interval of the share.</p>\n"
}

fn measures(manifest: &Manifest, summary: &Summary) -> String {
    let rows: Vec<String> = manifest
        .measures
        .iter()
        .enumerate()
        .map(|(j, column)| {
            let (moments, values) = (&summary.measures[j], ascending(summary, j));
            let num = |label: &str, x: f64| cell(label, "num", &escape_raised(&significant(x, 4)));
            let end = |end: Option<f64>| end.map_or_else(|| "–".into(), |x| escape_raised(&significant(x, 4)));
            let interval = |share: f64| {
                let (low, high) = quantile_interval(&values, share, manifest.confidence);
                format!(
                    "{}<br><small>{} … {}</small>",
                    escape_raised(&significant(quantile(&values, share), 4)),
                    end(low),
                    end(high)
                )
            };
            let half = significant(moments.mean_half_width(manifest.confidence), 2);
            [
                cell(
                    "Measure",
                    "name",
                    &format!("{}<br><small>{}</small>", escape(&column.name), escape(&column.words)),
                ),
                cell("Unit", "", &escape_raised(&column.unit)),
                cell(
                    "Mean",
                    "num",
                    &format!(
                        "{} <small>± {}</small>",
                        escape_raised(&significant(moments.mean, 4)),
                        escape_raised(&half)
                    ),
                ),
                num("Least", moments.min),
                cell("5 %", "num", &interval(0.05)),
                cell("Median", "num", &interval(0.5)),
                cell("95 %", "num", &interval(0.95)),
                num("Greatest", moments.max),
                cell("None", "num", &(summary.n - moments.n).to_string()),
            ]
            .concat()
        })
        .collect();
    let columns = [
        ("", "Measure"),
        ("", "Unit"),
        ("num", "Mean"),
        ("num", "Least"),
        ("num", "5 %"),
        ("num", "Median"),
        ("num", "95 %"),
        ("num", "Greatest"),
        ("num", "None"),
    ];
    let of_sample = match summary.sample.k.len() as u64 {
        n if n == summary.n => String::new(),
        n => format!(" Quantiles and pictures are of {n} runs that were drawn at random."),
    };
    format!("<div class=\"scroll\">\n{}</div>\n", table("fold", &columns, &rows))
        + &format!(
            "<p class=\"key\">Intervals at {} confidence: of the mean by Student's distribution, of quantiles by order statistics. \
             None: runs without a value.{of_sample}</p>\n",
            percent(manifest.confidence)
        )
}

fn distributions(manifest: &Manifest, summary: &Summary) -> String {
    let figures: String = (0..manifest.measures.len())
        .filter_map(|j| histogram(manifest, summary, j))
        .take(MAX_FIGURES)
        .map(|of| figure(&of))
        .collect();
    if figures.is_empty() { figures } else { format!("<div class=\"figures\">\n{figures}</div>\n") }
}

/// Histogram of a measure with its limits; none if it has one value alone.
fn histogram(manifest: &Manifest, summary: &Summary, j: usize) -> Option<Figure> {
    let (column, values) = (&manifest.measures[j], ascending(summary, j));
    let (low, high) = (*values.first()?, *values.last()?);
    if low == high {
        return None;
    }
    // Freedman and Diaconis 1981
    let spread = quantile(&values, 0.75) - quantile(&values, 0.25);
    let width = 2.0 * spread / libm::cbrt(values.len() as f64);
    let n_bins = if width > 0.0 { ((high - low) / width).ceil().clamp(8.0, 60.0) as usize } else { 30 };
    let width = (high - low) / n_bins as f64;
    let mut counts = vec![0.0; n_bins];
    for value in &values {
        counts[(((value - low) / width) as usize).min(n_bins - 1)] += 100.0 / values.len() as f64;
    }
    let (mut x, mut y) = (vec![low], vec![0.0]);
    for (k, count) in counts.iter().enumerate() {
        x.extend([low + k as f64 * width, low + (k + 1) as f64 * width]);
        y.extend([*count, *count]);
    }
    x.push(high);
    y.push(0.0);
    let mut panel = Panel::new(Axis::new("share of runs", "%"));
    panel.bands.push(sincro_figures::plot::Band {
        name: String::new(),
        signal: 0,
        x: x.clone(),
        lower: vec![0.0; x.len()],
        upper: y.clone(),
    });
    panel.series.push(Series { stroke: Stroke::Line, ..Series::new("", Role::Simulated, x, y) });
    let line = |value: f64, name: &str, weight: Weight| Guide {
        points: vec![(value, f64::NEG_INFINITY), (value, f64::INFINITY)],
        name: name.to_owned(),
        label: String::new(),
        weight,
    };
    let median = quantile(&values, 0.5);
    panel.guides.push(line(median, &format!("median {}", significant(median, 4)), Weight::Axis));
    let mut range = (low, high);
    for (limit, sign) in [(column.at_most, "≤"), (column.at_least, "≥")] {
        let Some(limit) = limit else { continue };
        panel.guides.push(line(limit, &format!("limit {sign} {}", short(limit, 6)), Weight::Strong));
        // a limit that is near belongs in the picture
        if limit > low - 1.5 * (high - low) && limit < high + 1.5 * (high - low) {
            range = (range.0.min(limit), range.1.max(limit));
        }
    }
    let margin = 0.02 * (range.1 - range.0);
    let x = Axis {
        range: Some((range.0 - margin, range.1 + margin)),
        ..Axis::new(column.name.clone(), column.unit.clone())
    };
    Some(Figure { title: format!("{} of {} runs", column.name, values.len()), x, panels: vec![panel], space: None })
}

/// Pairs of a parameter and a measure where both have a value.
fn pairs(summary: &Summary, parameter: usize, measure: usize) -> (Vec<f64>, Vec<f64>) {
    let (x, y) = (&summary.sample.parameters[parameter], &summary.sample.measures[measure]);
    x.iter().zip(y).filter(|(x, y)| x.is_finite() && y.is_finite()).map(|(x, y)| (*x, *y)).unzip()
}

/// Rank correlations of the parameters with a measure, the strongest first.
fn rank_correlations(manifest: &Manifest, summary: &Summary, measure: usize) -> Vec<(usize, f64, (f64, f64))> {
    let mut all: Vec<(usize, f64, (f64, f64))> = (0..manifest.parameters.len())
        .filter_map(|p| {
            let (x, y) = pairs(summary, p, measure);
            let r = correlation(&ranks(&x), &ranks(&y));
            r.is_finite().then(|| (p, r, correlation_interval(r, x.len(), manifest.confidence)))
        })
        .collect();
    all.sort_by(|a, b| b.1.abs().total_cmp(&a.1.abs()));
    all
}

/// Measures whose causes are worth a picture: those with limits first, then in the order of the plan.
fn of_interest(manifest: &Manifest, summary: &Summary) -> Vec<usize> {
    let varies = |j: &usize| summary.measures[*j].n > 3 && summary.measures[*j].std() > 0.0;
    let has_limit = |j: &usize| manifest.measures[*j].at_most.is_some() || manifest.measures[*j].at_least.is_some();
    let all = 0..manifest.measures.len();
    let (limited, others): (Vec<usize>, Vec<usize>) = all.filter(varies).partition(has_limit);
    limited.into_iter().chain(others).take(MAX_CAUSES).collect()
}

fn sensitivities(manifest: &Manifest, summary: &Summary) -> String {
    let mut out = String::new();
    for j in of_interest(manifest, summary) {
        let name = escape(&manifest.measures[j].name);
        if let Some(indices) = &summary.indices[j] {
            let bar = |p: usize, value: f64, half: f64| Bar {
                name: manifest.parameters[p].name.clone(),
                value,
                interval: (value - half, value + half),
            };
            let mut rows = indices.rows.clone();
            rows.sort_by(|a, b| b.3.total_cmp(&a.3));
            let first: Vec<Bar> = rows.iter().map(|(p, s, half, ..)| bar(*p, *s, *half)).collect();
            let total: Vec<Bar> = rows.iter().map(|(p, _, _, s, half)| bar(*p, *s, *half)).collect();
            let (n, all) = indices.n_blocks;
            let dropped = if n < all {
                format!(" {} blocks with a run without value are left out.", all - n)
            } else {
                String::new()
            };
            out += &format!(
                "<h3>{name}</h3>\n{}{}<p class=\"key\">Sobol' indices of {n} blocks: the share of the variance that a parameter makes \
                 alone, and with all its interactions (Jansen's estimators).{dropped}</p>\n",
                tornado(&first, "first-order index", true),
                tornado(&total, "total index", true)
            );
            continue;
        }
        let all = rank_correlations(manifest, summary, j);
        let bars: Vec<Bar> = all
            .iter()
            .take(12)
            .map(|(p, r, interval)| Bar { name: manifest.parameters[*p].name.clone(), value: *r, interval: *interval })
            .collect();
        if !bars.is_empty() {
            out += &format!("<h3>{name}</h3>\n{}", tornado(&bars, "rank correlation with the parameter", false));
        }
    }
    if out.contains("rank correlation") {
        out += "<p class=\"key\">Spearman's rank correlation with its interval: how much a measure rises or falls with a parameter, \
                whatever the shape. For shares of the variance, interactions included, take design = \"saltelli\".</p>\n";
    }
    out
}

fn surfaces(manifest: &Manifest, summary: &Summary) -> String {
    let mut out = String::new();
    for j in of_interest(manifest, summary).into_iter().take(2) {
        let strongest = rank_correlations(manifest, summary, j);
        let [(p, ..), (q, ..), ..] = strongest.as_slice() else { continue };
        let (p, q) = (*p, *q);
        let limits = |values: &[f64]| {
            let finite = values.iter().copied().filter(|x| x.is_finite());
            finite.fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), x| (a.min(x), b.max(x)))
        };
        let (xs, ys) = (&summary.sample.parameters[p], &summary.sample.parameters[q]);
        let ((x0, x1), (y0, y1)) = (limits(xs), limits(ys));
        if x0 >= x1 || y0 >= y1 {
            continue;
        }
        let terms = |x: f64, y: f64| vec![1.0, x, y, x * x, x * y, y * y];
        let (mut rows, mut values) = (Vec::new(), Vec::new());
        for (k, value) in summary.sample.measures[j].iter().enumerate().filter(|(_, value)| value.is_finite()) {
            rows.push(terms((xs[k] - x0) / (x1 - x0), (ys[k] - y0) / (y1 - y0)));
            values.push(*value);
        }
        let Some(fit) = least_squares(&rows, &values).filter(|_| rows.len() > 12) else { continue };
        let predicted = |row: &[f64]| row.iter().zip(&fit).map(|(a, b)| a * b).sum::<f64>();
        let r = correlation(&rows.iter().map(|row| predicted(row)).collect::<Vec<_>>(), &values);
        let bad = (0..summary.sample.k.len()).filter(|k| !summary.sample.good[*k]);
        let bad = bad.map(|k| ((xs[k] - x0) / (x1 - x0), (ys[k] - y0) / (y1 - y0))).collect();
        let column = &manifest.measures[j];
        let (px, py) = (&manifest.parameters[p], &manifest.parameters[q]);
        let picture = surface(&Surface {
            x: (&px.name, &px.unit, x0, x1),
            y: (&py.name, &py.unit, y0, y1),
            name: &column.name,
            unit: &column.unit,
            value: &|x, y| predicted(&terms(x, y)),
            bad,
        });
        out += &format!(
            "<h3>{}</h3>\n{picture}<p class=\"key\">Quadratic surface over the two parameters that matter most, fitted to all runs; it \
             explains {} of the variance, the rest is of the other parameters and of finer shape. Crosses: runs that are not good.</p>\n",
            escape(&column.name),
            percent(r * r)
        );
    }
    out
}

fn scatter(manifest: &Manifest, summary: &Summary) -> String {
    let interest = of_interest(manifest, summary);
    let strength = |p: usize| {
        let of = |j: &usize| {
            let (x, y) = pairs(summary, p, *j);
            let r = correlation(&ranks(&x), &ranks(&y)).abs();
            if r.is_nan() { 0.0 } else { r }
        };
        interest.iter().map(of).fold(0.0, f64::max)
    };
    let mut parameters: Vec<(usize, f64)> = (0..manifest.parameters.len()).map(|p| (p, strength(p))).collect();
    parameters.sort_by(|a, b| b.1.total_cmp(&a.1));
    parameters.truncate(MAX_PARAMETERS);
    parameters.sort_by_key(|(p, _)| *p);
    let of_parameter = parameters.iter().map(|(p, _)| ScatterAxis {
        name: &manifest.parameters[*p].name,
        unit: &manifest.parameters[*p].unit,
        values: &summary.sample.parameters[*p],
    });
    let of_measure = interest.iter().take(MAX_MEASURES).map(|j| ScatterAxis {
        name: &manifest.measures[*j].name,
        unit: &manifest.measures[*j].unit,
        values: &summary.sample.measures[*j],
    });
    let axes: Vec<ScatterAxis<'_>> = of_parameter.chain(of_measure).collect();
    let picture = scatter_matrix(&axes, &summary.sample.good);
    if picture.is_empty() {
        return picture;
    }
    picture
        + "<p class=\"key\">Dots are good runs, crosses the others. On the diagonal the distribution of each variable.</p>\n"
}

fn worst(store: &Store, summary: &Summary, replays: &[Replay]) -> String {
    let manifest = &store.manifest;
    let rows: Vec<String> = summary
        .worst
        .iter()
        .map(|worst| {
            let run = match replays.iter().find(|replay| replay.k == worst.k) {
                Some(replay) => format!("<a href=\"{}\">run {} ▸ replay</a>", escape(&replay.href), worst.k),
                None => format!("run {}", worst.k),
            };
            let variant = if manifest.variants.len() > 1 { format!("{}: ", worst.variant) } else { String::new() };
            let values: Vec<String> = manifest
                .parameters
                .iter()
                .zip(&worst.parameters)
                .take(6)
                .map(|(p, x)| format!("{} = {}", p.name.rsplit('/').next().unwrap_or(&p.name), significant(*x, 4)))
                .collect();
            [
                cell("Run", "name", &run),
                cell("Why", "", &escape(&format!("{variant}{}", worst.reason))),
                cell("Parameters", "", &format!("<small>{}</small>", escape(&values.join(", ")))),
            ]
            .concat()
        })
        .collect();
    let columns = [("", "Run"), ("", "Why"), ("", "Parameters")];
    let command = format!("sincro sweep {} --out {} --only K", manifest.plan, store.folder.display());
    table("fold", &columns, &rows)
        + &format!(
            "<p class=\"key\">Any run is made again, to the bit and with its replay, by <code>{}</code>.</p>\n",
            escape(&command)
        )
}

fn parameters(manifest: &Manifest) -> String {
    let rows: Vec<String> = manifest
        .parameters
        .iter()
        .map(|p| {
            [
                cell("Parameter", "name", &format!("<code>{}</code>", escape(&p.name))),
                cell("Unit", "", &escape_raised(&p.unit)),
                cell("Values", "", &escape(&p.words)),
            ]
            .concat()
        })
        .collect();
    table("fold", &[("", "Parameter"), ("", "Unit"), ("", "Values")], &rows)
}

fn setting_rows(store: &Store, summary: &Summary) -> Vec<(String, String)> {
    let manifest = &store.manifest;
    vec![
        ("scene".into(), manifest.scene.clone()),
        ("plan".into(), manifest.plan.clone()),
        ("design".into(), manifest.design.clone()),
        ("runs".into(), summary.n.to_string()),
        ("draws for each point of the grid".into(), manifest.n_draws.to_string()),
        ("seed".into(), manifest.seed.to_string()),
        ("hash of the inputs".into(), manifest.input.clone()),
        ("table of all runs".into(), crate::store::RUNS.into()),
        ("sincro".into(), manifest.sincro_version.clone()),
    ]
}
