//! The simulated counterpart of measured data, and its derivatives by the free parameters.
//!
//! Derivatives are exact where they can be: the run on dual numbers (`exact.rs`), and the slope of the prediction
//! for a time offset. Elsewhere they are differences of runs at a tight tolerance (Richardson's extrapolation of two
//! widths), central inside of the bounds and one-sided at a bound; the two widths give an estimate of their error.
//! Which way is taken for which unknown, and why, is part of the result ([`Sensitivity`]).

use std::sync::OnceLock;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};

use sincro_figures::plot::number::significant;
use sincro_scene::diagnostic::{Diagnostic, Diagnostics, Located, Location, SourceText};
use sincro_scene::overrides::Override;
use sincro_sim::Loaded;
use sincro_sim::run::{RunError, RunMonitor, RunOptions, simulate};
use sincro_sim::table::Table;

use super::data::{DataSet, interpolate, interpolated_slope};
use super::difference::{Difference, WIDTH};
use super::exact::{self, D, Neighbours, Obstacle, Rows, Start};
use super::free::{FreeParameter, settings};

/// Tolerance of the runs at the solution.
const ACCURACY: f64 = 1e-12;
/// Difference between a run on dual numbers and plain ones, relative to the largest value, above which they are
/// different motions, or the derivatives are not all: events or paths that only one of them sees.
const DEPARTURE: f64 = 1e-4;
/// Tolerance of the runs on the way there.
const COARSE: f64 = 1e-9;

/// Model of measured data: the scene with its free parameters and, if wanted, one time offset for each data set. The
/// unknowns are the free parameters in their order, then the offsets in the order of the sets.
#[derive(Debug)]
pub struct Model<'a> {
    /// Scene that is fitted.
    pub loaded: &'a Loaded,
    /// Settings of all runs, in this order: those of the caller, then those that the runs of a fit need.
    pub fixed: Vec<Override>,
    /// Number of the caller's settings.
    n_own: usize,
    /// Free parameters, the first unknowns.
    pub free: Vec<FreeParameter>,
    /// Data sets that are fitted.
    pub sets: &'a [DataSet],
    /// True if the data of each set may be shifted in time: one more unknown for each `[s]`.
    pub has_offsets: bool,
    /// Flag that ends all runs once it is true.
    pub interrupt: &'a AtomicBool,
    /// Runs that were made.
    n_runs: AtomicUsize,
    /// Runs on dual numbers that were made.
    n_dual_runs: AtomicUsize,
    /// True while the search is on its way.
    is_coarse: AtomicBool,
    ways: OnceLock<Vec<Sensitivity>>,
}

/// Failure of the runs of a [`Model`] at some values of the unknowns.
#[derive(Debug)]
pub enum ModelError {
    /// The scene refuses the values; its findings.
    Refused(Diagnostics),
    /// The run stopped before its end; the reason in English.
    Stopped(String),
    /// The flag `interrupt` of the model became true.
    Interrupted,
}

impl From<Diagnostics> for ModelError {
    fn from(found: Diagnostics) -> Self {
        Self::Refused(found)
    }
}

/// Sensitivities: derivatives of all predicted values by the unknowns; result of [`Model::sensitivities`].
#[derive(Clone, Debug)]
pub struct Sensitivities {
    /// One column for each unknown, each with an entry for every value of [`Model::predict`], in its order
    /// `[unit of the signal / unit of the unknown]`; NaN where nothing was measured.
    pub columns: Vec<Vec<f64>>,
    /// Way to the derivatives by each unknown.
    pub ways: Vec<Sensitivity>,
    /// Estimated error of derivatives by differences, relative to the largest one of the same unknown (dimensionless);
    /// 0 if all are exact, or if it was not asked for.
    pub error: f64,
}

impl Sensitivities {
    /// Sentences about how the derivatives were computed; `names` are those of the unknowns.
    #[must_use]
    pub fn words(&self, names: &[String]) -> Vec<String> {
        let reason = |k: &usize| match &self.ways[*k] {
            Sensitivity::Exact => None,
            Sensitivity::Differences(reason) => Some(reason.as_str()),
        };
        let by_differences: Vec<usize> = (0..self.ways.len()).filter(|k| reason(k).is_some()).collect();
        if by_differences.is_empty() {
            return vec!["exact, by dual numbers".into()];
        }
        let error = significant(self.error, 1);
        let how = format!("by central differences of runs at accuracy 1e-12, relative error about {error}");
        let first = reason(&by_differences[0]);
        if by_differences.len() == self.ways.len() && by_differences.iter().all(|k| reason(k) == first) {
            return vec![format!("{how}: {}", first.unwrap_or_default())];
        }
        let one = |k: &usize| format!("of `{}` {how}: {}", names[*k], reason(k).unwrap_or_default());
        std::iter::once("exact, by dual numbers".into()).chain(by_differences.iter().map(one)).collect()
    }
}

/// Way to the derivatives by one unknown, an entry of [`Sensitivities::ways`].
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Sensitivity {
    /// Dual numbers through the run, exact to its own tolerance; of a time offset the slope of the prediction.
    Exact,
    /// Differences of runs, and the reason why, as part of a sentence.
    Differences(String),
}

impl<'a> Model<'a> {
    /// Creates a model of a scene with the settings `fixed`. Settings for its runs are added: they last until the last
    /// time of the data, record at every step, and leave out checks, plots and variants.
    #[must_use]
    pub fn new(
        loaded: &'a Loaded,
        fixed: &[Override],
        free: Vec<FreeParameter>,
        sets: &'a [DataSet],
        has_offsets: bool,
        interrupt: &'a AtomicBool,
    ) -> Self {
        let (mut fixed, n_own) = (fixed.to_vec(), fixed.len());
        let last = sets.iter().filter_map(|set| set.times.last()).fold(0.0_f64, |a, b| a.max(*b));
        let step = loaded.experiment.step;
        // four rows behind the last time, for the cubic
        let duration = if has_offsets { last + 0.25 * last + 4.0 * step } else { last };
        let duration = (duration / step - 1e-6).ceil().max(1.0) * step;
        fixed.push(Override::new("duration", &format!("{duration:?}")));
        fixed.push(Override::new("record_every", "1"));
        fixed.push(Override::new("error_bar", "none"));
        // what a fit does not look at is not read
        fixed.extend(["check", "plot", "variant"].map(|key| Override::new(key, "[]")));
        let (n_runs, n_dual_runs, is_coarse) = (AtomicUsize::new(0), AtomicUsize::new(0), AtomicBool::new(false));
        let ways = OnceLock::new();
        Self { loaded, fixed, n_own, free, sets, has_offsets, interrupt, n_runs, n_dual_runs, is_coarse, ways }
    }

    /// Settings that the caller gave.
    #[must_use]
    pub(crate) fn own_settings(&self) -> &[Override] {
        &self.fixed[..self.n_own]
    }

    /// Sets the tolerance of the integrator for the runs from now on: the coarse one of the search (true), or the fine
    /// one at which the solution and its uncertainty are computed (false).
    pub(crate) fn set_coarse(&self, is_coarse: bool) {
        self.is_coarse.store(is_coarse, Ordering::Relaxed);
    }

    /// Returns the number of unknowns: free parameters and time offsets.
    #[must_use]
    pub fn n_unknowns(&self) -> usize {
        self.free.len() + if self.has_offsets { self.sets.len() } else { 0 }
    }

    /// Returns the names of the unknowns in their order: paths of the free parameters, then `time offset of FILE`.
    #[must_use]
    pub fn names(&self) -> Vec<String> {
        let offsets = self.sets.iter().take(self.n_unknowns() - self.free.len());
        let names = self.free.iter().map(|free| free.path.clone());
        names.chain(offsets.map(|set| format!("time offset of {}", set.path.display()))).collect()
    }

    /// Returns start, lower bound, upper bound and typical size of unknown `k`, in its unit; those of a time offset
    /// `[s]` follow from the length of its data.
    ///
    /// # Panics
    ///
    /// If `k` is not below [`Model::n_unknowns`].
    #[must_use]
    pub fn bounds(&self, k: usize) -> (f64, f64, f64, f64) {
        match self.free.get(k) {
            Some(free) => (free.start, free.low, free.high, free.scale()),
            None => {
                let last = self.sets[k - self.free.len()].times.last().copied().unwrap_or(1.0);
                (0.0, -0.2 * last, 0.2 * last, 0.01 * last)
            }
        }
    }

    /// Returns the number of simulations made so far, for predictions and sensitivities together.
    #[must_use]
    pub fn n_runs(&self) -> usize {
        self.n_runs.load(Ordering::Relaxed)
    }

    /// Loads the scene at values of the free parameters, with the settings of a fit's runs and the recorded signals
    /// that the data need.
    pub(super) fn at(&self, values: &[f64]) -> Result<Loaded, ModelError> {
        let mut settings = settings(&self.fixed, &self.free, values);
        let accuracy = if self.is_coarse.load(Ordering::Relaxed) { COARSE } else { ACCURACY };
        settings.push(Override::new("accuracy", &format!("{accuracy:?}")));
        let mut at = self.loaded.with_overrides_without_variants(&settings)?;
        let source = std::sync::Arc::new(SourceText { path: "--signal".into(), text: String::new() });
        let located = |signal: String| Located { value: signal, at: Location { source: source.clone(), span: 0..0 } };
        at.experiment.record = self.signals().into_iter().map(located).collect();
        at.experiment.stops.clear();
        at.experiment.checks.clear();
        Ok(at)
    }

    /// Signals that the data measure, each once.
    pub(super) fn signals(&self) -> Vec<String> {
        let mut signals: Vec<String> = Vec::new();
        for column in self.sets.iter().flat_map(|set| &set.columns) {
            if !signals.contains(&column.signal) {
                signals.push(column.signal.clone());
            }
        }
        signals
    }

    /// Recorded signals of one run at values of the free parameters.
    pub(super) fn table(&self, values: &[f64]) -> Result<Table, ModelError> {
        self.n_runs.fetch_add(1, Ordering::Relaxed);
        let at = self.at(values)?;
        let mut monitor = RunMonitor { interrupt: self.interrupt, progress: &mut |_| {} };
        let run = simulate(&at, RunOptions::default(), &mut monitor).map_err(|error| match error {
            RunError::Diagnostics(found) => ModelError::Refused(found),
            RunError::File(error) => ModelError::Stopped(error.to_string()),
        })?;
        if self.interrupt.load(Ordering::Relaxed) {
            return Err(ModelError::Interrupted);
        }
        if let sincro_sim::results::Status::Stopped { reason, .. } = run.status {
            return Err(ModelError::Stopped(reason));
        }
        Ok(run.table)
    }

    /// One value for each datum in the order of [`Model::predict`], from the series of its signal; NaN where nothing
    /// was measured. `at` gets the series and a time on the clock of the run.
    fn collect<'s>(
        &self,
        unknowns: &[f64],
        series: impl Fn(&str) -> &'s [f64],
        at: impl Fn(&[f64], f64) -> f64,
    ) -> Vec<f64> {
        let mut all = Vec::new();
        for (s, set) in self.sets.iter().enumerate() {
            let offset = unknowns.get(self.free.len() + s).copied().unwrap_or(0.0);
            for column in &set.columns {
                let simulated = series(&column.signal);
                let value = |(t, measured): (&f64, &f64)| {
                    if !measured.is_finite() { f64::NAN } else { at(simulated, t + offset) }
                };
                all.extend(set.times.iter().zip(&column.values).map(value));
            }
        }
        all
    }

    /// Returns the number of runs on dual numbers made so far; each gives the derivatives by one parameter.
    #[must_use]
    pub fn n_dual_runs(&self) -> usize {
        self.n_dual_runs.load(Ordering::Relaxed)
    }

    /// Predicts all data by one run: set by set, in each column by column, in each one value per time, in the unit of
    /// the signal; NaN where nothing was measured. `unknowns` has [`Model::n_unknowns`] values in the order of
    /// [`Model::names`].
    ///
    /// # Errors
    ///
    /// [`ModelError`]: the scene refuses the values, the run stops, or it was interrupted.
    ///
    /// # Panics
    ///
    /// If there are fewer values than free parameters.
    pub fn predict(&self, unknowns: &[f64]) -> Result<Vec<f64>, ModelError> {
        let table = self.table(&unknowns[..self.free.len()])?;
        let series = |signal: &str| table.column(signal).map_or(&[][..], |c| c.values.as_slice());
        Ok(self.collect(unknowns, series, |values, t| interpolate(table.times(), values, t)))
    }

    /// Returns the way to the derivatives by each unknown, found once, at the starts of the free parameters. A run that
    /// meets an obstacle later takes differences there ([`Sensitivities::ways`]).
    ///
    /// # Errors
    ///
    /// As [`Model::predict`].
    pub fn ways(&self) -> Result<&[Sensitivity], ModelError> {
        if let Some(ways) = self.ways.get() {
            return Ok(ways);
        }
        let start: Vec<f64> = self.free.iter().map(|free| free.start).collect();
        let at = self.at(&start)?;
        let of_scene = exact::obstacle(&at, &self.signals());
        let mut ways = Vec::with_capacity(self.n_unknowns());
        for k in 0..self.n_unknowns() {
            let way = match &of_scene {
                _ if k >= self.free.len() => Sensitivity::Exact,
                Some(reason) => Sensitivity::Differences(reason.clone()),
                None => self.way_of_parameter(&at, &start, k)?,
            };
            ways.push(way);
        }
        if let Some(k) = (0..self.free.len()).find(|k| ways[*k] == Sensitivity::Exact)
            && self.departs(&start, k)?
        {
            let reason = "the run on dual numbers departs from the plain one";
            ways[..self.free.len()].fill(Sensitivity::Differences(reason.into()));
        }
        Ok(self.ways.get_or_init(|| ways))
    }

    /// Takes over the ways to the derivatives from a model of the same scene, parameters and signals.
    pub(super) fn take_ways(&self, ways: Vec<Sensitivity>) {
        let _ = self.ways.set(ways);
    }

    /// Way to the derivative by free parameter `k` of a scene without obstacle, `at` the values `start`. A block that
    /// holds other numbers is an obstacle if the exact derivative is not that of differences.
    fn way_of_parameter(&self, at: &Loaded, start: &[f64], k: usize) -> Result<Sensitivity, ModelError> {
        let mut beside = start.to_vec();
        beside[k] += Difference::at(start[k], self.bounds(k)).steps(WIDTH)[0];
        let reason = match exact::obstacle_of(at, &self.at(&beside)?) {
            Obstacle::None => return Ok(Sensitivity::Exact),
            Obstacle::Certain(reason) => return Ok(Sensitivity::Differences(reason)),
            Obstacle::Suspected(reason) => reason,
        };
        let mut unknowns = start.to_vec();
        unknowns.resize(self.n_unknowns(), 0.0);
        let Ok(exact) = self.exact_column(&unknowns, k)? else { return Ok(Sensitivity::Differences(reason)) };
        let (differences, _) = self.differences(&unknowns, k, true)?;
        let largest = differences.iter().filter(|x| x.is_finite()).fold(0.0_f64, |a, x| a.max(x.abs()));
        let agrees = |(a, b): (&f64, &f64)| !a.is_finite() || (a - b).abs() <= DEPARTURE * largest;
        let is_exact = exact.iter().zip(&differences).all(agrees);
        Ok(if is_exact { Sensitivity::Exact } else { Sensitivity::Differences(reason) })
    }

    /// Returns true if the values of a run on dual numbers are not those of a plain one.
    fn departs(&self, values: &[f64], k: usize) -> Result<bool, ModelError> {
        let Ok(Rows { signals: rows, .. }) = self.dual_rows(values, k)? else { return Ok(false) };
        let table = self.table(values)?;
        Ok(self.signals().iter().enumerate().any(|(s, signal)| {
            let plain = table.column(signal).map_or(&[][..], |c| c.values.as_slice());
            let size = plain.iter().fold(0.0_f64, |a, x| a.max(x.abs()));
            let departs = |(row, plain): (&Vec<D>, &f64)| {
                (row[s].value - plain).abs() > DEPARTURE * size || row[s].value.is_nan()
            };
            rows.len() != plain.len() || rows.iter().zip(plain).any(departs)
        }))
    }

    /// Derivatives by free parameter `k`, exact; the reason as an error where the run on dual numbers cannot go on.
    fn exact_column(&self, unknowns: &[f64], k: usize) -> Result<Result<Vec<f64>, String>, ModelError> {
        let Rows { times, signals: rows, .. } = match self.dual_rows(&unknowns[..self.free.len()], k)? {
            Ok(found) => found,
            Err(reason) => return Ok(Err(reason)),
        };
        let signals = self.signals();
        let slopes: Vec<Vec<f64>> =
            (0..signals.len()).map(|s| rows.iter().map(|row| row[s].partials[0]).collect()).collect();
        let series =
            |signal: &str| signals.iter().position(|known| known == signal).map_or(&[][..], |s| slopes[s].as_slice());
        Ok(Ok(self.collect(unknowns, series, |values, t| interpolate(&times, values, t))))
    }

    /// Whole run on dual numbers, differentiated by free parameter `k`; the reason as an error where it cannot go on.
    fn dual_rows(&self, values: &[f64], k: usize) -> Result<Result<Rows, String>, ModelError> {
        let around = self.neighbours(values, k)?;
        let (_, n_ticks) = ticks(&around.scenes[0]);
        Ok(self.dual_run(&around, &Start::OF_RUN, n_ticks))
    }

    /// A run on dual numbers.
    pub(super) fn dual_run(&self, around: &Neighbours, start: &Start<'_>, n_ticks: usize) -> Result<Rows, String> {
        self.n_dual_runs.fetch_add(1, Ordering::Relaxed);
        exact::run(around, start, &self.signals(), n_ticks)
    }

    /// Scenes beside the values of the free parameters along parameter `k`.
    pub(super) fn neighbours(&self, values: &[f64], k: usize) -> Result<Neighbours, ModelError> {
        let difference = Difference::at(values[k], self.bounds(k));
        let mut around = Neighbours { scenes: vec![self.at(values)?], difference };
        for (i, step) in Neighbours::steps(difference).into_iter().enumerate() {
            // a parameter that numbers are proportional to needs no narrower difference
            if i == 2 && around.are_affine() {
                break;
            }
            let mut at = values.to_vec();
            at[k] += step;
            around.scenes.push(self.at(&at)?);
        }
        Ok(around)
    }

    /// Derivatives by the time offset of set `s`: the slope of the prediction.
    fn offset_column(&self, unknowns: &[f64], s: usize) -> Result<Vec<f64>, ModelError> {
        let table = self.table(&unknowns[..self.free.len()])?;
        let series = |signal: &str| table.column(signal).map_or(&[][..], |c| c.values.as_slice());
        let mut slopes = self.collect(unknowns, series, |values, t| interpolated_slope(table.times(), values, t));
        let mut place = 0;
        for (k, set) in self.sets.iter().enumerate() {
            let n = set.times.len() * set.columns.len();
            if k != s {
                slopes[place..place + n].iter_mut().filter(|x| x.is_finite()).for_each(|x| *x = 0.0);
            }
            place += n;
        }
        Ok(slopes)
    }

    /// Computes the derivatives of all predicted values by all unknowns at the point `unknowns`, on all processors:
    /// exactly where that can be, else by differences of runs. With `with_error` differences are extrapolated and their
    /// error is estimated.
    ///
    /// # Errors
    ///
    /// As [`Model::predict`].
    pub fn sensitivities(&self, unknowns: &[f64], with_error: bool) -> Result<Sensitivities, ModelError> {
        let n = self.n_unknowns();
        let ways = self.ways()?.to_vec();
        let next = AtomicUsize::new(0);
        let mut results: Vec<Option<Result<Column, ModelError>>> = (0..n).map(|_| None).collect();
        let n_threads = std::thread::available_parallelism().map_or(1, usize::from).min(n.max(1));
        let worker = || {
            let mut mine = Vec::new();
            loop {
                let k = next.fetch_add(1, Ordering::Relaxed);
                if k >= n {
                    return mine;
                }
                mine.push((k, self.column(unknowns, k, &ways[k], with_error)));
            }
        };
        std::thread::scope(|scope| {
            let others: Vec<_> = (1..n_threads).map(|_| scope.spawn(worker)).collect();
            let own = worker();
            let all = others.into_iter().flat_map(|thread| thread.join().expect("a run does not panic")).chain(own);
            all.for_each(|(k, result)| results[k] = Some(result));
        });
        let mut found = Sensitivities { columns: Vec::new(), ways: Vec::new(), error: 0.0 };
        for result in results {
            let column = result.expect("every column was found")?;
            found.columns.push(column.values);
            found.ways.push(column.way);
            found.error = found.error.max(column.error);
        }
        Ok(found)
    }

    fn column(&self, unknowns: &[f64], k: usize, way: &Sensitivity, with_error: bool) -> Result<Column, ModelError> {
        let exact = |values| Column { values, way: Sensitivity::Exact, error: 0.0 };
        let reason = match way {
            Sensitivity::Differences(reason) => reason.clone(),
            Sensitivity::Exact if k >= self.free.len() => {
                return self.offset_column(unknowns, k - self.free.len()).map(exact);
            }
            Sensitivity::Exact => match self.exact_column(unknowns, k)? {
                Ok(values) => return Ok(exact(values)),
                Err(reason) => reason,
            },
        };
        let (values, error) = self.differences(unknowns, k, with_error)?;
        Ok(Column { values, way: Sensitivity::Differences(reason), error })
    }

    /// Computes the derivatives of all predicted values by unknown `k` at the point `unknowns` by differences of runs,
    /// whatever other way there is; with `with_error` extrapolated, with an estimate of their error relative to the
    /// largest one, else 0.
    ///
    /// # Errors
    ///
    /// As [`Model::predict`].
    ///
    /// # Panics
    ///
    /// If `k` is not below [`Model::n_unknowns`].
    pub fn differences(&self, unknowns: &[f64], k: usize, with_error: bool) -> Result<(Vec<f64>, f64), ModelError> {
        let widths: &[f64] = if with_error { &[WIDTH, 0.5 * WIDTH] } else { &[0.5 * WIDTH] };
        let difference = Difference::at(unknowns[k], self.bounds(k));
        let beside = |step: f64| {
            let mut at = unknowns.to_vec();
            let (_, low, high, _) = self.bounds(k);
            at[k] = (at[k] + step).clamp(low, high);
            self.predict(&at)
        };
        let middle = if difference.side == 0.0 { Vec::new() } else { self.predict(unknowns)? };
        let mut slopes = Vec::new();
        for width in widths {
            let [first, second] = difference.steps(*width);
            slopes.push(difference.slopes(*width, &beside(first)?, &beside(second)?, &middle));
        }
        let [wide, narrow] = slopes.as_slice() else {
            return Ok((slopes.pop().expect("one width"), 0.0));
        };
        let better: Vec<f64> = narrow.iter().zip(wide).map(|(n, w)| Difference::extrapolated(*w, *n)).collect();
        let largest = better.iter().copied().filter(|x| x.is_finite()).fold(0.0_f64, |a, b| a.max(b.abs()));
        // what is left after the extrapolation is of the square of what it took away, one-sided of its power 3/2
        let taken = narrow.iter().zip(wide).map(|(n, w)| (n - w).abs() / 3.0).filter(|x| x.is_finite());
        let share = taken.fold(0.0_f64, f64::max) / largest.max(f64::MIN_POSITIVE);
        let left = if difference.side == 0.0 { share * share } else { share * share.sqrt() };
        Ok((better, left.max(1e-15 / WIDTH)))
    }
}

/// Base step `[s]` of a scene, and their number in its run.
pub(super) fn ticks(loaded: &Loaded) -> (f64, usize) {
    let (step, duration) = (loaded.experiment.step, loaded.experiment.duration);
    (step, (duration / step).round() as usize)
}

/// Derivatives by one unknown.
struct Column {
    values: Vec<f64>,
    way: Sensitivity,
    error: f64,
}

/// Problem in words for a model that cannot be run.
impl From<ModelError> for Diagnostics {
    fn from(error: ModelError) -> Self {
        match error {
            ModelError::Refused(found) => found,
            ModelError::Stopped(reason) => {
                Diagnostic::without_location(format!("the run with these values stopped: {reason}"))
                    .with_help("start elsewhere, or give bounds: --free PATH=START in LOW..HIGH")
                    .into()
            }
            ModelError::Interrupted => Diagnostic::without_location("it was interrupted").into(),
        }
    }
}
