//! The simulated counterpart of measured data, and its derivatives by the free parameters.
//!
//! Derivatives are differences of runs at a tight tolerance (Richardson's extrapolation of two widths), central inside
//! of the bounds and one-sided at a bound, because the lock-step computes on plain numbers. The two widths give an
//! estimate of their error, which the report states.

use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};

use sincro_scene::diagnostic::{Diagnostic, Diagnostics, Located, Location, SourceText};
use sincro_scene::overrides::Override;
use sincro_sim::Loaded;
use sincro_sim::run::{RunError, RunMonitor, RunOptions, simulate};

use super::data::{DataSet, interpolate};
use super::free::{FreeParameter, settings};

/// Width of the wider difference, relative to the scale of a parameter; the narrower is half of it. With Richardson's
/// extrapolation the truncation is of the fourth power, 1e-12, and the rounding of a run at 1e-12 about 1e-9.
const WIDTH: f64 = 1e-3;
/// Tolerance of the runs at the solution.
const ACCURACY: f64 = 1e-12;
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
    /// True while the search is on its way.
    is_coarse: AtomicBool,
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
    /// Estimated error of the derivatives, relative to the largest one of the same unknown (dimensionless); 0 if it was
    /// not asked for.
    pub error: f64,
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
        let (n_runs, is_coarse) = (AtomicUsize::new(0), AtomicBool::new(false));
        Self { loaded, fixed, n_own, free, sets, has_offsets, interrupt, n_runs, is_coarse }
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
        self.n_runs.fetch_add(1, Ordering::Relaxed);
        let values = &unknowns[..self.free.len()];
        let mut settings = settings(&self.fixed, &self.free, values);
        let accuracy = if self.is_coarse.load(Ordering::Relaxed) { COARSE } else { ACCURACY };
        settings.push(Override::new("accuracy", &format!("{accuracy:?}")));
        let mut at = self.loaded.with_overrides_without_variants(&settings)?;
        let source = std::sync::Arc::new(SourceText { path: "--signal".into(), text: String::new() });
        at.experiment.record.clear();
        for column in self.sets.iter().flat_map(|set| &set.columns) {
            if !at.experiment.record.iter().any(|known| known.value == column.signal) {
                let place = Location { source: source.clone(), span: 0..0 };
                at.experiment.record.push(Located { value: column.signal.clone(), at: place });
            }
        }
        at.experiment.stops.clear();
        at.experiment.checks.clear();
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
        let times = run.table.times();
        let mut predicted = Vec::new();
        for (s, set) in self.sets.iter().enumerate() {
            let offset = unknowns.get(self.free.len() + s).copied().unwrap_or(0.0);
            for column in &set.columns {
                let simulated = run.table.column(&column.signal).map_or(&[][..], |c| c.values.as_slice());
                let value = |(t, measured): (&f64, &f64)| {
                    if !measured.is_finite() { f64::NAN } else { interpolate(times, simulated, t + offset) }
                };
                predicted.extend(set.times.iter().zip(&column.values).map(value));
            }
        }
        Ok(predicted)
    }

    /// Computes the derivatives of all predicted values by all unknowns at the point `unknowns` by differences of runs,
    /// on all processors. With `with_error` (twice the runs) they are extrapolated and their error is estimated.
    ///
    /// # Errors
    ///
    /// As [`Model::predict`].
    pub fn sensitivities(&self, unknowns: &[f64], with_error: bool) -> Result<Sensitivities, ModelError> {
        let n = self.n_unknowns();
        let widths: &[f64] = if with_error { &[WIDTH, 0.5 * WIDTH] } else { &[0.5 * WIDTH] };
        let differences: Vec<Difference> = (0..n).map(|k| Difference::at(unknowns[k], self.bounds(k))).collect();
        let points = |k: usize| widths.iter().flat_map(move |w| [(k, *w, 0), (k, *w, 1)]);
        let mut jobs: Vec<(usize, f64)> =
            (0..n).flat_map(points).map(|(k, width, i)| (k, differences[k].steps(width)[i])).collect();
        // one-sided differences need the place itself
        let needs_middle = differences.iter().any(|d| d.side != 0.0);
        jobs.extend(needs_middle.then_some((0, 0.0)));
        let next = AtomicUsize::new(0);
        let mut results: Vec<Option<Result<Vec<f64>, ModelError>>> = jobs.iter().map(|_| None).collect();
        let n_threads = std::thread::available_parallelism().map_or(1, usize::from).min(jobs.len().max(1));
        let worker = || {
            let mut mine = Vec::new();
            loop {
                let j = next.fetch_add(1, Ordering::Relaxed);
                let Some((k, step)) = jobs.get(j) else { return mine };
                let mut at = unknowns.to_vec();
                let (_, low, high, _) = self.bounds(*k);
                at[*k] = (at[*k] + step).clamp(low, high);
                mine.push((j, self.predict(&at)));
            }
        };
        std::thread::scope(|scope| {
            let others: Vec<_> = (1..n_threads).map(|_| scope.spawn(worker)).collect();
            let own = worker();
            let all = others.into_iter().flat_map(|thread| thread.join().expect("a run does not panic")).chain(own);
            all.for_each(|(j, result)| results[j] = Some(result));
        });
        let middle = if needs_middle { results.pop().flatten().transpose()? } else { None }.unwrap_or_default();
        let mut values = results.into_iter().map(|result| result.expect("every job was done"));
        let (mut columns, mut worst) = (Vec::with_capacity(n), 0.0_f64);
        for k in 0..n {
            let mut slopes = Vec::new();
            for width in widths {
                let (first, second) = (values.next().expect("two a width")?, values.next().expect("two a width")?);
                slopes.push(differences[k].slopes(*width, &first, &second, &middle));
            }
            if let [wide, narrow] = slopes.as_slice() {
                let better: Vec<f64> = narrow.iter().zip(wide).map(|(n, w)| n + (n - w) / 3.0).collect();
                let largest = better.iter().copied().filter(|x| x.is_finite()).fold(0.0_f64, |a, b| a.max(b.abs()));
                // what is left after the extrapolation is of the square of what it took away, one-sided of its power
                // 3/2
                let taken = narrow.iter().zip(wide).map(|(n, w)| (n - w).abs() / 3.0).filter(|x| x.is_finite());
                let share = taken.fold(0.0_f64, f64::max) / largest.max(f64::MIN_POSITIVE);
                let left = if differences[k].side == 0.0 { share * share } else { share * share.sqrt() };
                worst = worst.max(left.max(1e-15 / WIDTH));
                columns.push(better);
            } else {
                columns.push(slopes.pop().expect("one width"));
            }
        }
        Ok(Sensitivities { columns, error: worst })
    }
}

/// Difference of second order for the derivative by an unknown: central, or one-sided where that would leave its
/// bounds.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Difference {
    /// 0 for a central difference, 1 for one towards larger values, −1 for one towards smaller.
    side: f64,
    /// Unit of the widths.
    scale: f64,
}

impl Difference {
    /// The difference at a value; `bounds` as of [`Model::bounds`].
    fn at(value: f64, (_, low, high, scale): (f64, f64, f64, f64)) -> Self {
        // the wider difference fits between the bounds to one side or the other
        let scale = scale.min((high - low) / (4.0 * WIDTH));
        let side = match scale * WIDTH {
            h if value - h >= low && value + h <= high => 0.0,
            h if value + 2.0 * h <= high => 1.0,
            _ => -1.0,
        };
        Self { side, scale }
    }

    /// Distances of its two points from the value.
    fn steps(self, width: f64) -> [f64; 2] {
        let h = width * self.scale;
        if self.side == 0.0 { [h, -h] } else { [self.side * h, 2.0 * self.side * h] }
    }

    /// Slopes from what is predicted at its two points and, if it is one-sided, at the value.
    fn slopes(self, width: f64, first: &[f64], second: &[f64], middle: &[f64]) -> Vec<f64> {
        let h = width * self.scale;
        let points = first.iter().zip(second);
        if self.side == 0.0 {
            points.map(|(up, down)| (up - down) / (2.0 * h)).collect()
        } else {
            let slope = |((near, far), at): ((&f64, &f64), &f64)| (4.0 * near - far - 3.0 * at) / (2.0 * h * self.side);
            points.zip(middle).map(slope).collect()
        }
    }
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn differences_stay_between_the_bounds_and_are_of_second_order() {
        let square = |x: f64| [x * x];
        for (value, low, high, side) in
            [(2.0, 0.0, 9.0, 0.0), (0.0, 0.0, 9.0, 1.0), (9.0, 0.0, 9.0, -1.0), (3.0, 3.0, 3.0 + 1e-6, 1.0)]
        {
            let difference = Difference::at(value, (value, low, high, 2.0));
            assert_eq!(difference.side, side, "{value}");
            let points = difference.steps(WIDTH).map(|step| value + step);
            assert!(points.iter().all(|x| (low..=high).contains(x)), "{points:?}");
            let slope = difference.slopes(WIDTH, &square(points[0]), &square(points[1]), &square(value))[0];
            assert!((slope - 2.0 * value).abs() < 1e-6, "{value}: {slope}");
        }
    }
}
