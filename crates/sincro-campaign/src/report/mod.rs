//! Report of a campaign: `report.html`, `summary.json`, and a summary for the terminal.

mod charts;
mod page;
mod summary;

use std::fmt::Write as _;

use serde_json::{Value, json};
use sincro_figures::plot::number::{short, significant};
use sincro_sim::file::write_atomically_shared;

use crate::statistics::{quantile, quantile_interval, wilson};
use crate::store::{Store, StoreError};

pub use summary::{Indices, Sample, Summary, Worst};

/// Run that was made again with its own report, for the link in the report of the campaign.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Replay {
    /// Number of the run in the campaign, from 0.
    pub k: u64,
    /// Address of its report, relative to the folder of the campaign.
    pub href: String,
}

/// Writes `report.html` and `summary.json` into the folder of a campaign that was collected; `replays` are runs made
/// again, to which the report links.
///
/// # Errors
///
/// [`StoreError::File`] with the path of the file that cannot be written.
pub fn write(store: &Store, summary: &Summary, replays: &[Replay]) -> Result<(), StoreError> {
    let json = json_text(store, summary) + "\n";
    write_atomically_shared(&store.folder.join("summary.json"), json.as_bytes())?;
    let page = page::html(store, summary, replays);
    write_atomically_shared(&store.folder.join("report.html"), page.as_bytes()).map_err(StoreError::from)
}

/// Finite values of a measure in ascending order, as far as the sample has them.
pub(crate) fn ascending(summary: &Summary, measure: usize) -> Vec<f64> {
    let mut values: Vec<f64> = summary.sample.measures[measure].iter().copied().filter(|x| x.is_finite()).collect();
    values.sort_by(f64::total_cmp);
    values
}

/// Returns a summary of the campaign for the terminal, several lines of English: yield, statistics of the measures,
/// worst run.
#[must_use]
pub fn text(store: &Store, summary: &Summary) -> String {
    let manifest = &store.manifest;
    let mut out = format!("{}\n", manifest.title);
    let (low, high) = summary.yield_interval(manifest.confidence);
    let percent = |x: f64| significant(100.0 * x, 4);
    let _ = writeln!(
        out,
        "  {} of {} runs are good: yield {} % (between {} % and {} % at {} % confidence)",
        summary.n_good,
        summary.n,
        percent(summary.n_good as f64 / summary.n.max(1) as f64),
        percent(low),
        percent(high),
        short(100.0 * manifest.confidence, 4)
    );
    for (word, n) in
        summary.statuses.iter().filter(|(word, n)| *n > 0 && matches!(word.as_str(), "stopped" | "refused"))
    {
        let _ = writeln!(out, "  {n} {word}");
    }
    let width = manifest.measures.iter().map(|m| m.name.chars().count()).max().unwrap_or(0).min(48);
    for (j, column) in manifest.measures.iter().enumerate() {
        let (moments, values) = (&summary.measures[j], ascending(summary, j));
        let unit = if column.unit.is_empty() { String::new() } else { format!(" {}", column.unit) };
        let _ = writeln!(
            out,
            "  {:<width$}  mean {} ± {}, from {} to {}, median {}{unit}",
            column.name,
            significant(moments.mean, 4),
            significant(moments.mean_half_width(manifest.confidence), 2),
            significant(moments.min, 4),
            significant(moments.max, 4),
            significant(quantile(&values, 0.5), 4)
        );
    }
    if let Some(worst) = summary.worst.first() {
        let _ = writeln!(out, "  worst run {}: {}", worst.k, worst.reason);
        let _ = writeln!(out, "    sincro sweep {} --out {} --only {}", manifest.plan, store.folder.display(), worst.k);
    }
    out
}

/// The statistics as JSON; numbers that are not finite are null.
fn json_text(store: &Store, summary: &Summary) -> String {
    let manifest = &store.manifest;
    let confidence = manifest.confidence;
    let (low, high) = summary.yield_interval(confidence);
    let of_measure = |j: usize| {
        let (column, moments) = (&manifest.measures[j], &summary.measures[j]);
        let values = ascending(summary, j);
        let quantiles: Vec<Value> = [0.05, 0.25, 0.5, 0.75, 0.95]
            .into_iter()
            .map(|share| {
                let (low, high) = quantile_interval(&values, share, confidence);
                json!({ "share": share, "value": quantile(&values, share), "low": low, "high": high })
            })
            .collect();
        json!({
            "name": column.name, "unit": column.unit, "measure": column.words,
            "at_most": column.at_most, "at_least": column.at_least, "misses": summary.misses[j],
            "n": moments.n, "mean": moments.mean, "mean_half_width": moments.mean_half_width(confidence),
            "std": moments.std(), "min": moments.min, "max": moments.max, "quantiles": quantiles,
            "sobol": summary.indices[j].as_ref().map(|indices| indices.rows.iter().map(|(p, s, sw, t, tw)| json!({
                "parameter": manifest.parameters[*p].name,
                "first": s, "first_half_width": sw, "total": t, "total_half_width": tw,
            })).collect::<Vec<_>>()),
        })
    };
    let variants: Vec<Value> = summary
        .variants
        .iter()
        .map(|(name, n, good)| {
            let (low, high) = wilson(*good, *n, confidence);
            json!({ "name": name, "n": n, "good": good, "low": low, "high": high })
        })
        .collect();
    let document = json!({
        "title": manifest.title, "input": manifest.input, "sincro_version": manifest.sincro_version,
        "n": summary.n, "good": summary.n_good, "confidence": confidence, "yield_low": low, "yield_high": high,
        "statuses": summary.statuses.iter().map(|(word, n)| (word.clone(), json!(n))).collect::<serde_json::Map<_, _>>(),
        "variants": variants,
        "measures": (0..manifest.measures.len()).map(of_measure).collect::<Vec<_>>(),
        "worst": summary.worst,
    });
    serde_json::to_string_pretty(&document).expect("plain data")
}
