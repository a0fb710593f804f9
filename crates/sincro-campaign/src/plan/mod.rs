//! Plan of a campaign: which runs there are, as a function of their number, and which numbers are kept of each.
//!
//! | | |
//! |---|---|
//! | run `k` | sample `k / n_variants` in variant `k % n_variants` |
//! | sample `s` | point `s / n_draws` of the grid with draw `s % n_draws` |
//! | draw `i` | coordinates in the unit cube by the design, correlated, through the inverse distribution functions |
//!
//! Every point of the grid has the same draws (common random numbers), so that differences between points are theirs.

mod file;
mod read;
mod resolve;

use std::path::{Path, PathBuf};
use std::sync::Arc;

use sincro_scene::diagnostic::{Diagnostic, Diagnostics, Located, SourceText};
use sincro_scene::folder::read_text;
use sincro_scene::overrides::Override;

use crate::design::random::{Purpose, bits, permuted, uniform};
use crate::design::{Distribution, inverse_normal, normal_cdf, sobol};
use crate::measure::MeasurePlan;

/// Upper limit of the number of runs of a campaign; plans with more are refused.
pub const MAX_RUNS: u64 = 1_000_000_000;

/// Design of experiments: the rule by which the drawn parameters are spread over the runs.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Design {
    /// Simple random sampling: independent draws.
    Random,
    /// Latin hypercube: one draw in each of `n` intervals of equal probability of every parameter, for `n` draws.
    LatinHypercube,
    /// Points of the Sobol' sequence with a random digital shift (quasi-Monte Carlo).
    Sobol,
    /// Two Sobol' matrices and their mixtures, from which first-order and total Sobol' indices follow (Saltelli 2002).
    Saltelli,
}

impl Design {
    /// All designs, in the order of the help texts.
    pub const ALL: [Self; 4] = [Self::Random, Self::LatinHypercube, Self::Sobol, Self::Saltelli];

    /// Returns the name of the design in a plan file: `random`, `latin-hypercube`, `sobol` or `saltelli`.
    #[must_use]
    pub fn word(self) -> &'static str {
        match self {
            Self::Random => "random",
            Self::LatinHypercube => "latin-hypercube",
            Self::Sobol => "sobol",
            Self::Saltelli => "saltelli",
        }
    }
}

/// Parameter of a campaign: a number of the scene that differs from run to run; a `[[parameter]]` of the plan.
#[derive(Clone, Debug)]
pub struct Parameter {
    /// Name of its column in the results.
    pub name: String,
    /// Paths of the settings that take its value, as after `--set`.
    pub paths: Vec<Located<String>>,
    /// Unit as text, for reports; may be empty.
    pub unit: String,
    /// True if its values are rounded to whole numbers.
    pub is_integer: bool,
    /// Distribution that it is drawn from, or values of a grid.
    pub distribution: Distribution,
}

/// Choice of the experiment's checks that a campaign measures besides its own measures.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Checks {
    /// All checks of each variant.
    All,
    /// No check.
    None,
    /// Checks of these names.
    Named(Vec<String>),
}

/// Plan of a campaign, read from a plan file and validated as far as that is possible without its scene: which runs
/// there are, and which numbers are kept of each. [`crate::Campaign::new`] joins it with the scene.
#[derive(Clone, Debug)]
pub struct Plan {
    /// Title of the report; may be empty.
    pub title: String,
    /// Description under the title; may be empty.
    pub description: String,
    /// Path of the scene's folder.
    pub scene: PathBuf,
    /// Seed of all random draws.
    pub seed: u64,
    /// True if each sample gives the scene a seed of its own (for noise and the like).
    pub random_seeds: bool,
    /// Probability of all confidence intervals, 0.5 to below 1.
    pub confidence: f64,
    /// Design of experiments of the drawn parameters.
    pub design: Design,
    /// Number of draws for each point of the grid; 1 if nothing is drawn.
    pub n_draws: u64,
    /// Parameters in the order of the file.
    pub parameters: Vec<Parameter>,
    /// Lower Cholesky factor of the correlation matrix of the drawn parameters, `n_drawn` rows of `n_drawn` entries in
    /// the order of the file; `None` if they are independent.
    pub correlation: Option<Vec<Vec<f64>>>,
    /// Names of the variants of the experiment that are run, `main` being the experiment itself; at least one.
    pub variants: Vec<Located<String>>,
    /// Settings of all runs, as after `--set`.
    pub set: Vec<Override>,
    /// Measures that are kept of each run, in the order of the file.
    pub measures: Vec<MeasurePlan>,
    /// Checks of the experiment that are measured, too.
    pub checks: Checks,
    /// Signals of which the series of every run are kept in the table of signals; mostly none.
    pub signals: Vec<Located<String>>,
    /// Recorded rows from one row of that table to the next, 1 or more.
    pub signals_every: u64,
    /// Number of rows in each part of the results; `None`: by [`Plan::rows_per_part`].
    pub rows_per_part: Option<u64>,
    /// Text of the plan file, for messages and for the copy beside the results.
    pub source: Arc<SourceText>,
}

/// Point of one run in the space of a campaign: all that distinguishes it from the others, a function of the plan and
/// `k`. Made by [`Plan::point`].
#[derive(Clone, Debug, PartialEq)]
pub struct RunPoint {
    /// Number of the run, from 0.
    pub k: u64,
    /// Number of the sample, from 0: `k` divided by the number of variants.
    pub sample: u64,
    /// Index of the variant in [`Plan::variants`].
    pub variant_idx: usize,
    /// Seed that the scene is given; `None` if it keeps its own.
    pub seed: Option<u64>,
    /// Values of the parameters, in the order and units of [`Plan::parameters`].
    pub values: Vec<f64>,
}

impl Plan {
    /// Reads a plan file (TOML), or the table `[campaign]` of the experiment in a scene's folder; paths in it are
    /// relative to its folder.
    ///
    /// # Errors
    ///
    /// All findings at once, each at its place in the file: text that cannot be read or is no TOML, unknown keys,
    /// values without meaning, tables that cannot be read, too many runs.
    pub fn open(path: &Path) -> Result<Self, Diagnostics> {
        let path = &if path.is_dir() { path.join("experiment.toml") } else { path.to_owned() };
        let text =
            read_text(path).map_err(|why| Diagnostic::without_location(format!("cannot read the plan: {why}")))?;
        Self::parse(path, text)
    }

    /// Reads the text of a plan file; paths in it are relative to the folder of `path`, which is not read itself.
    ///
    /// # Errors
    ///
    /// As [`Plan::open`].
    pub fn parse(path: &Path, text: String) -> Result<Self, Diagnostics> {
        read::plan(path, text)
    }

    /// Returns the number of points of the full-factorial grid; 1 without grid parameters, `u64::MAX` if there are more
    /// than that.
    #[must_use]
    pub fn n_grid(&self) -> u64 {
        self.parameters.iter().map(|p| grid_len(&p.distribution)).fold(1, u64::saturating_mul)
    }

    /// Returns the number of samples: points of the grid times draws; `u64::MAX` if there are more than that.
    #[must_use]
    pub fn n_samples(&self) -> u64 {
        self.n_grid().saturating_mul(self.n_draws)
    }

    /// Returns the number of runs: samples times variants.
    #[must_use]
    pub fn n_runs(&self) -> u64 {
        self.n_samples().saturating_mul(self.variants.len() as u64)
    }

    /// Returns the number of parameters that are drawn, those of a grid left out.
    #[must_use]
    pub fn n_drawn(&self) -> usize {
        self.parameters.iter().filter(|p| !p.distribution.is_grid()).count()
    }

    /// Returns the point of run `k` (from 0, below [`Plan::n_runs`]): its sample, variant, seed and parameter values.
    #[must_use]
    pub fn point(&self, k: u64) -> RunPoint {
        let n_variants = self.variants.len() as u64;
        let (sample, variant_idx) = (k / n_variants, (k % n_variants) as usize);
        let (mut grid, draw) = (sample / self.n_draws, sample % self.n_draws);
        let drawn = self.draw(draw);
        let mut values = Vec::with_capacity(self.parameters.len());
        let mut next = drawn.iter();
        for parameter in &self.parameters {
            let value = if let Distribution::Grid(all) = &parameter.distribution {
                let place = (grid % all.len() as u64) as usize;
                grid /= all.len() as u64;
                all[place]
            } else {
                parameter.distribution.quantile(*next.next().expect("a coordinate for each drawn parameter"))
            };
            values.push(if parameter.is_integer { value.round() } else { value });
        }
        let seed = self.random_seeds.then(|| bits(self.seed, Purpose::Seed, 0, sample) >> 2);
        RunPoint { k, sample, variant_idx, seed, values }
    }

    /// Coordinates of draw `i` in the unit cube, one for each drawn parameter.
    fn draw(&self, i: u64) -> Vec<f64> {
        let drawn: Vec<&Distribution> =
            self.parameters.iter().map(|p| &p.distribution).filter(|d| !d.is_grid()).collect();
        let u: Vec<f64> = (0..drawn.len()).map(|j| self.coordinate(i, shared(&drawn, j), drawn.len())).collect();
        let Some(factor) = &self.correlation else { return u };
        let z: Vec<f64> = u.iter().map(|u| inverse_normal(*u)).collect();
        let row = |row: &Vec<f64>| row.iter().zip(&z).map(|(l, z)| l * z).sum::<f64>();
        // rounding must not lead out of the open interval
        factor.iter().map(|l| normal_cdf(row(l)).clamp(f64::MIN_POSITIVE, 1.0 - f64::EPSILON / 2.0)).collect()
    }

    fn coordinate(&self, i: u64, j: usize, n_drawn: usize) -> f64 {
        match self.design {
            Design::Random => uniform(self.seed, Purpose::Value, j as u32, i),
            Design::LatinHypercube => {
                let place = permuted(self.seed, j as u32, i, self.n_draws) as f64;
                (place + uniform(self.seed, Purpose::Value, j as u32, i)) / self.n_draws as f64
            }
            Design::Sobol => sobol::point(self.seed, i, j),
            Design::Saltelli => {
                let (block, which) = (i / (n_drawn as u64 + 2), (i % (n_drawn as u64 + 2)) as usize);
                let is_second = which == 1 || which == j + 2;
                sobol::point(self.seed, block, if is_second { n_drawn + j } else { j })
            }
        }
    }

    /// Returns the settings of the parameters and the seed of a run, which follow those of the plan and of its variant.
    /// `point` comes from [`Plan::point`] of this plan.
    #[must_use]
    pub fn settings(&self, point: &RunPoint) -> Vec<Override> {
        let mut settings = Vec::new();
        for (parameter, value) in self.parameters.iter().zip(&point.values) {
            let text = if parameter.is_integer { format!("{value:.0}") } else { format!("{value:?}") };
            settings.extend(parameter.paths.iter().map(|path| Override::new(&path.value, &text)));
        }
        settings.extend(point.seed.map(|seed| Override::new("seed", &seed.to_string())));
        settings
    }

    /// Returns the number of rows in each part of the results, 1 to 2²⁰ (the last part has the rest): a function of the
    /// plan alone, so that parts are the same for any sharding.
    #[must_use]
    pub fn rows_per_part(&self) -> u64 {
        self.rows_per_part.unwrap_or_else(|| self.n_runs().div_ceil(128).clamp(1, 1024))
    }
}

/// Factor of the grid; 1 for drawn parameters.
fn grid_len(distribution: &Distribution) -> u64 {
    if let Distribution::Grid(values) = distribution { values.len() as u64 } else { 1 }
}

/// Index of the coordinate that a drawn parameter uses: columns of one table share that of the first.
fn shared(drawn: &[&Distribution], j: usize) -> usize {
    let Distribution::Table { file, .. } = drawn[j] else { return j };
    drawn.iter().position(|d| matches!(d, Distribution::Table { file: other, .. } if other == file)).unwrap_or(j)
}

#[cfg(test)]
mod tests;
