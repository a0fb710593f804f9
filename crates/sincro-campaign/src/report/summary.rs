//! Statistics of a campaign, read from its table in two passes; memory does not grow with the number of runs.

use serde::Serialize;
use sincro_sim::formats::parquet::{ParquetFile, Values};

use crate::design::inverse_normal;
use crate::design::random::{Purpose, uniform};
use crate::row::N_LEADING;
use crate::statistics::{Moments, wilson};
use crate::store::{Manifest, Store, StoreError};

/// Number of rows about which are kept for quantiles, pictures and ranks; of more runs so many are drawn.
const MAX_SAMPLE: u64 = 20_000;
/// Worst runs that are listed.
const N_WORST: usize = 10;

/// Statistics of all runs of a campaign, the content of its report; made by [`Summary::of`]. Lists of parameters and
/// measures are in the order of the [`Manifest`].
#[derive(Clone, Debug)]
pub struct Summary {
    /// Number of runs.
    pub n: u64,
    /// Number of good runs: completed or ended as intended, within all limits, no measured check failed.
    pub n_good: u64,
    /// Number of runs of each status, in the order `completed`, `ended`, `stopped`, `refused`.
    pub statuses: Vec<(String, u64)>,
    /// Name of each variant, number of its runs, number of its good runs, in the order of the plan.
    pub variants: Vec<(String, u64, u64)>,
    /// Number of runs in which the audit found something.
    pub n_with_findings: u64,
    /// Mean, spread and extremes of each measure, in its unit, over the runs that have a value.
    pub measures: Vec<Moments>,
    /// Number of runs outside the limits of each measure; 0 if it has no limits.
    pub misses: Vec<u64>,
    /// Rows that are kept for quantiles and pictures.
    pub sample: Sample,
    /// Worst runs, the worst first, ten at most.
    pub worst: Vec<Worst>,
    /// Sobol' indices of each measure; `None` unless the design is `saltelli` and the measure varies.
    pub indices: Vec<Option<Indices>>,
}

/// Rows of a campaign kept in memory for quantiles and pictures: all, or about 20 000 drawn at random by the seed and
/// the number of the run alone. All lists have one entry per kept run, in the order of the runs.
#[derive(Clone, Debug, Default)]
pub struct Sample {
    /// Probability with which a row is kept; 1 and above: all are.
    pub share: f64,
    /// Numbers of the kept runs, ascending.
    pub k: Vec<u64>,
    /// Values of the parameters: one list for each parameter, in its unit.
    pub parameters: Vec<Vec<f64>>,
    /// Values of the measures: one list for each measure, in its unit; NaN where there is none.
    pub measures: Vec<Vec<f64>>,
    /// True for each good run.
    pub good: Vec<bool>,
}

impl Sample {
    /// Returns true for a run that is kept. Runs are drawn: every n-th would always be of one variant, or of one place
    /// in the blocks of a design.
    fn keeps(&self, seed: u64, k: u64) -> bool {
        self.share >= 1.0 || uniform(seed, Purpose::Sample, 0, k) < self.share
    }
}

/// One of the worst runs of a campaign, an entry of [`Summary::worst`].
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Worst {
    /// Number of the run, from 0.
    pub k: u64,
    /// Name of its variant.
    pub variant: String,
    /// Status of the run: `completed`, `ended`, `stopped` or `refused`.
    pub status: String,
    /// Distance beyond the limits in standard deviations of the measure, negative within them; infinite for a run that
    /// stopped or was refused.
    pub score: f64,
    /// Reason in English, such as the measure and its value.
    pub reason: String,
    /// Values of the parameters, in their order and units.
    pub parameters: Vec<f64>,
}

/// Sobol' indices of one measure: shares of its variance (dimensionless) that the drawn parameters cause.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Indices {
    /// One row for each drawn parameter: its index among all parameters, its first-order index, the half width of that
    /// one's confidence interval, its total index (with all interactions), the half width of that one's.
    pub rows: Vec<(usize, f64, f64, f64, f64)>,
    /// Number of blocks of the Saltelli design in which all runs have a value, and of all blocks.
    pub n_blocks: (u64, u64),
}

/// A row group with its columns by their use.
struct Group<'a> {
    manifest: &'a Manifest,
    columns: &'a [Values],
}

impl Group<'_> {
    fn ints(&self, column: usize) -> &[i64] {
        if let Values::Ints(values) = &self.columns[column] { values } else { &[] }
    }

    fn texts(&self, column: usize) -> &[String] {
        if let Values::Texts(values) = &self.columns[column] { values } else { &[] }
    }

    fn doubles(&self, column: usize) -> &[f64] {
        if let Values::Doubles(values) = &self.columns[column] { values } else { &[] }
    }

    fn parameter(&self, j: usize) -> &[f64] {
        self.doubles(N_LEADING + j)
    }

    fn measure(&self, j: usize) -> &[f64] {
        self.doubles(N_LEADING + self.manifest.parameters.len() + j)
    }

    /// A column behind the measures: 0 status, 1 t_end, 2 good, 3 failed checks, 4 findings, 5 trace, 6 reason.
    fn trailing(&self, k: usize) -> usize {
        N_LEADING + self.manifest.parameters.len() + self.manifest.measures.len() + k
    }

    fn n(&self) -> usize {
        self.columns[0].len()
    }
}

impl Summary {
    /// Computes the statistics from the table `runs.parquet` of a campaign, which [`crate::collect`] wrote.
    ///
    /// # Errors
    ///
    /// [`StoreError::Damaged`] with the file and the reason, if the table is missing or cannot be read.
    pub fn of(store: &Store) -> Result<Self, StoreError> {
        let manifest = &store.manifest;
        let (n_parameters, n_measures) = (manifest.parameters.len(), manifest.measures.len());
        let mut summary = Self {
            n: 0,
            n_good: 0,
            statuses: ["completed", "ended", "stopped", "refused"].map(|word| (word.to_owned(), 0)).to_vec(),
            variants: manifest.variants.iter().map(|name| (name.clone(), 0, 0)).collect(),
            n_with_findings: 0,
            measures: vec![Moments::default(); n_measures],
            misses: vec![0; n_measures],
            sample: Sample {
                share: MAX_SAMPLE as f64 / manifest.n_runs as f64,
                parameters: vec![Vec::new(); n_parameters],
                measures: vec![Vec::new(); n_measures],
                ..Sample::default()
            },
            worst: Vec::new(),
            indices: vec![None; n_measures],
        };
        let mut sobol: Vec<SobolSums> = vec![SobolSums::new(manifest); n_measures];
        each_group(store, |group| {
            summary.first_pass(&group);
            if manifest.design == "saltelli" {
                (0..n_measures).for_each(|j| sobol[j].add(&group, j));
            }
        })?;
        each_group(store, |group| summary.rank(&group))?;
        if manifest.design == "saltelli" {
            summary.indices = sobol.iter().map(|sums| sums.indices(manifest)).collect();
        }
        Ok(summary)
    }

    /// Returns the lower and upper bound, 0 to 1, of the confidence interval of the yield (share of good runs) after
    /// Wilson (1927), for the probability `confidence` in (0, 1); (0, 1) without runs.
    #[must_use]
    pub fn yield_interval(&self, confidence: f64) -> (f64, f64) {
        wilson(self.n_good, self.n, confidence)
    }

    fn first_pass(&mut self, group: &Group<'_>) {
        let (k, statuses) = (group.ints(0), group.texts(group.trailing(0)));
        let (good, findings) = (group.ints(group.trailing(2)), group.ints(group.trailing(4)));
        for row in 0..group.n() {
            let is_good = good[row] == 1;
            self.n += 1;
            self.n_good += u64::from(is_good);
            self.n_with_findings += u64::from(findings[row] > 0);
            if let Some(found) = self.statuses.iter_mut().find(|(word, _)| *word == statuses[row]) {
                found.1 += 1;
            }
            if let Some(variant) = self.variants.iter_mut().find(|(name, ..)| *name == group.texts(2)[row]) {
                variant.1 += 1;
                variant.2 += u64::from(is_good);
            }
            if self.sample.keeps(group.manifest.seed, k[row] as u64) {
                self.sample.k.push(k[row] as u64);
                self.sample.good.push(is_good);
                for (j, values) in self.sample.parameters.iter_mut().enumerate() {
                    values.push(group.parameter(j)[row]);
                }
                for (j, values) in self.sample.measures.iter_mut().enumerate() {
                    values.push(group.measure(j)[row]);
                }
            }
        }
        for (j, moments) in self.measures.iter_mut().enumerate() {
            let column = &group.manifest.measures[j];
            for x in group.measure(j) {
                if x.is_finite() {
                    moments.add(*x);
                }
                let misses = column.at_most.is_some_and(|most| x.is_nan() || *x > most)
                    || column.at_least.is_some_and(|least| x.is_nan() || *x < least);
                self.misses[j] += u64::from(misses);
            }
        }
    }

    /// Keeps the worst runs of a group.
    fn rank(&mut self, group: &Group<'_>) {
        for row in 0..group.n() {
            let (score, reason) = self.score(group, row);
            if self.worst.len() == N_WORST && self.worst.last().is_some_and(|last| score <= last.score) {
                continue;
            }
            let worst = Worst {
                k: group.ints(0)[row] as u64,
                variant: group.texts(2)[row].clone(),
                status: group.texts(group.trailing(0))[row].clone(),
                score,
                reason,
                parameters: (0..group.manifest.parameters.len()).map(|j| group.parameter(j)[row]).collect(),
            };
            // of equals the first run stays first
            let at = self.worst.partition_point(|other| other.score >= score);
            self.worst.insert(at, worst);
            self.worst.truncate(N_WORST);
        }
    }

    /// Badness of a run: beyond its limits by how many standard deviations, or nearest to them; without limits, how far
    /// the first measure is from its mean.
    fn score(&self, group: &Group<'_>, row: usize) -> (f64, String) {
        let status = &group.texts(group.trailing(0))[row];
        if status == "stopped" || status == "refused" {
            return (f64::INFINITY, format!("{status}: {}", group.texts(group.trailing(6))[row]));
        }
        let short = |x: f64| sincro_figures::plot::number::significant(x, 4);
        let mut worst = (f64::NEG_INFINITY, String::new());
        for (j, column) in group.manifest.measures.iter().enumerate() {
            let (x, spread) = (group.measure(j)[row], self.measures[j].std().max(f64::MIN_POSITIVE));
            let beyond = column.at_most.map(|most| x - most).into_iter().chain(column.at_least.map(|least| least - x));
            for beyond in beyond {
                let score = if beyond.is_nan() { 1e6 } else { beyond / spread };
                if score > worst.0 {
                    worst = (score, format!("{} = {} {}", column.name, short(x), column.unit).trim_end().to_owned());
                }
            }
        }
        let n_failed = group.ints(group.trailing(3))[row];
        if n_failed > 0 {
            let words = if n_failed == 1 { "check fails" } else { "checks fail" };
            let reason = format!("{n_failed} {words}; {}", worst.1);
            return (1e6 + n_failed as f64 + worst.0.clamp(-1e3, 1e3), reason.trim_end_matches("; ").to_owned());
        }
        if worst.1.is_empty() {
            let (x, moments) = (group.measure(0)[row], &self.measures[0]);
            let score = (x - moments.mean).abs() / moments.std().max(f64::MIN_POSITIVE);
            let column = &group.manifest.measures[0];
            let reason = format!("{} = {} {}", column.name, short(x), column.unit).trim_end().to_owned();
            return (if score.is_nan() { 1e6 } else { score }, reason);
        }
        worst
    }
}

fn each_group(store: &Store, mut of: impl FnMut(Group<'_>)) -> Result<(), StoreError> {
    let path = store.runs_path();
    let damaged =
        |error: sincro_sim::formats::parquet::ParquetError| StoreError::Damaged(path.clone(), error.to_string());
    let mut file = ParquetFile::open(&path).map_err(damaged)?;
    for k in 0..file.n_groups() {
        let columns = file.group(k).map_err(damaged)?;
        of(Group { manifest: &store.manifest, columns: &columns });
    }
    Ok(())
}

/// Sums over the blocks of a Saltelli design of the first variant and the first point of the grid (estimators of Jansen
/// 1999).
#[derive(Clone, Debug)]
struct SobolSums {
    n_drawn: usize,
    n_variants: u64,
    n_draws: u64,
    block: Vec<f64>,
    n_all: u64,
    variance: Moments,
    /// Terms of each parameter, (f(B) − f(AB))²/2 and (f(A) − f(AB))²/2.
    terms: Vec<(Moments, Moments)>,
}

impl SobolSums {
    fn new(manifest: &Manifest) -> Self {
        Self {
            n_drawn: manifest.n_drawn,
            n_variants: manifest.variants.len() as u64,
            n_draws: manifest.n_draws,
            block: Vec::new(),
            n_all: 0,
            variance: Moments::default(),
            terms: vec![(Moments::default(), Moments::default()); manifest.n_drawn],
        }
    }

    fn add(&mut self, group: &Group<'_>, j: usize) {
        for (row, value) in group.measure(j).iter().enumerate() {
            let k = group.ints(0)[row] as u64;
            if !k.is_multiple_of(self.n_variants) || k / self.n_variants >= self.n_draws {
                continue;
            }
            self.block.push(*value);
            if self.block.len() == self.n_drawn + 2 {
                self.close();
            }
        }
    }

    fn close(&mut self) {
        self.n_all += 1;
        let block = std::mem::take(&mut self.block);
        if block.iter().any(|x| !x.is_finite()) {
            return;
        }
        let half_square = |x: f64| 0.5 * x * x;
        self.variance.add(block[0]);
        self.variance.add(block[1]);
        for (j, (first, total)) in self.terms.iter_mut().enumerate() {
            first.add(half_square(block[1] - block[2 + j]));
            total.add(half_square(block[0] - block[2 + j]));
        }
    }

    fn indices(&self, manifest: &Manifest) -> Option<Indices> {
        let variance = self.variance.std() * self.variance.std();
        let n = self.terms.first()?.0.n;
        if n < 8 || variance <= 1e-24 * (1.0 + self.variance.mean * self.variance.mean) {
            return None;
        }
        let z = inverse_normal(0.5 + 0.5 * manifest.confidence);
        let half = |of: &Moments| z * of.std() / ((n as f64).sqrt() * variance);
        let drawn = (0..manifest.parameters.len()).filter(|j| manifest.is_drawn[*j]);
        let rows = drawn
            .zip(&self.terms)
            .map(|(j, (first, total))| {
                (j, 1.0 - first.mean / variance, half(first), total.mean / variance, half(total))
            })
            .collect();
        Some(Indices { rows, n_blocks: (n, self.n_all) })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_sample_has_all_variants_in_equal_parts() {
        let n_runs = 4 * MAX_SAMPLE;
        let sample = Sample { share: 0.25, ..Sample::default() };
        let mut of_variants = [0_u64; 4];
        (0..n_runs).filter(|k| sample.keeps(7, *k)).for_each(|k| of_variants[(k % 4) as usize] += 1);
        // five standard deviations of the binomial distribution
        assert!(of_variants.iter().all(|n| n.abs_diff(MAX_SAMPLE / 4) < 310), "{of_variants:?}");
        assert!((0..100).all(|k| Sample { share: 1.0, ..Sample::default() }.keeps(7, k)));
    }
}
