//! Tuning: free parameters of a scene for the least value of a goal, within limits, over one run or a whole campaign.
//!
//! Candidates are compared by Deb's rules (2000): of two that keep all limits the one with the smaller goal is better,
//! else the one that breaks them less. Neither method needs more than the order, so that no penalty has to be chosen.

pub(crate) mod cma;
mod goal;
mod local;
mod margins;
mod page;
mod pareto;

use std::path::Path;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};

use serde_json::json;
use sincro_figures::plot::number::{short, significant};
use sincro_math::elementary::{exp, ln};
use sincro_scene::overrides::Override;
use sincro_sim::file::FileError;
use sincro_sim::run::RunError;

use crate::campaign::Campaign;
use crate::fit::FreeParameter;
use cma::Cma;
pub use goal::{Goal, Limit, measure_tables};
use local::Simplex;
pub use margins::{LoopMargin, margins};
use pareto::Member;

/// Search method of a tuning.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Method {
    /// Global search between the bounds by CMA-ES.
    #[default]
    Global,
    /// Local search from the start by the simplex of Nelder and Mead.
    Local,
}

/// Rule by which the values of a goal or limit over several runs become one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Robust {
    /// Greatest value of all runs.
    Worst,
    /// Value that this share of the runs, 0 to 1, does not exceed.
    Quantile(f64),
    /// Mean of all runs.
    Mean,
}

/// Tuning: search for the free parameters of a scene that minimise a goal within limits, over one run or all runs of a
/// campaign. Fill it in, then call [`Tuning::search`].
#[derive(Debug)]
pub struct Tuning<'a> {
    /// Campaign whose runs every candidate makes; its measures are the arguments of goal and limits.
    pub campaign: &'a Campaign,
    /// Free parameters, with finite bounds.
    pub free: Vec<FreeParameter>,
    /// Goal that is minimised.
    pub goal: Goal,
    /// Second goal that is minimised as well: the result is a Pareto front; global search only.
    pub second: Option<Goal>,
    /// Limits that must be kept; may be empty.
    pub limits: Vec<Limit>,
    /// Rule by which the values of several runs become one.
    pub robust: Robust,
    /// Search method.
    pub method: Method,
    /// Upper limit of the number of candidates.
    pub budget: usize,
    /// Seed of the search's random draws.
    pub seed: u64,
}

/// Candidate of a tuning: values of the free parameters with what came out.
#[derive(Clone, Debug, PartialEq)]
pub struct Candidate {
    /// Values of the free parameters, in their order and units.
    pub values: Vec<f64>,
    /// Value of the goal over all runs; infinite if a run has none.
    pub goal: f64,
    /// Value of the second goal over all runs; NaN if there is none.
    pub second: f64,
    /// Sum of `violations`; 0 if all limits are kept, infinite if the goal has no value.
    pub violation: f64,
    /// Violation of each limit over all runs, relative to the limit, in the order of [`Tuning::limits`]; 0 if it is
    /// kept.
    pub violations: Vec<f64>,
    /// Measures of the first run, in the order of the campaign's layout and in their units.
    pub measures: Vec<f64>,
}

impl Candidate {
    /// Returns true if the candidate is better than `other` by Deb's rules: less violation of the limits first, then
    /// the smaller goal.
    #[must_use]
    pub fn is_better_than(&self, other: &Self) -> bool {
        match (self.violation > 0.0, other.violation > 0.0) {
            (false, true) => true,
            (true, false) => false,
            (true, true) => self.violation < other.violation,
            (false, false) => self.goal < other.goal,
        }
    }
}

/// Result of [`Tuning::search`].
#[derive(Clone, Debug)]
pub struct Tuned {
    /// Candidate at the start of the search.
    pub before: Candidate,
    /// Best candidate; of two goals the one of the front that is nearest to the best of both.
    pub after: Candidate,
    /// Candidates that keep all limits and that no other is better than in both goals, by ascending first goal; empty
    /// with one goal.
    pub front: Vec<Candidate>,
    /// Margins of the loops of the diagram before and after, at the end of the first run.
    pub margins: (Vec<LoopMargin>, Vec<LoopMargin>),
    /// Progress of the search: after how many candidates the best one changed, and its goal; the first entry is the
    /// start.
    pub history: Vec<(usize, f64)>,
    /// Number of candidates tried.
    pub n_candidates: usize,
    /// True if the search converged before its budget was used up.
    pub has_converged: bool,
    /// True if the search was interrupted.
    pub is_interrupted: bool,
    /// Wall time of the search `[s]`.
    pub wall_time: f64,
}

impl Tuned {
    /// Returns the end of the search in English: `converged`, `interrupted` or `ended by its budget`.
    #[must_use]
    pub fn ended(&self) -> &'static str {
        match (self.has_converged, self.is_interrupted) {
            (true, _) => "converged",
            (_, true) => "interrupted",
            _ => "ended by its budget",
        }
    }
}

impl Tuning<'_> {
    /// Searches the best candidate, from the start of the free parameters, on all processors. After each generation or
    /// candidate `progress` receives the share of the budget used so far, from 0 to about 1, and the goal of the best
    /// candidate. `None` if `interrupt` became true before the first candidate was complete.
    ///
    /// # Errors
    ///
    /// [`RunError`]: a run could not be begun, such as for a measured signal that does not exist.
    pub fn search(
        &self,
        interrupt: &AtomicBool,
        progress: &mut dyn FnMut(f64, f64),
    ) -> Result<Option<Tuned>, RunError> {
        let clock = std::time::Instant::now();
        let start: Vec<f64> = self.free.iter().map(|free| to_unit(free, free.start)).collect();
        let Some(before) = self.evaluate(std::slice::from_ref(&start), interrupt)?.pop() else { return Ok(None) };
        let mut best = before.clone();
        let (mut history, mut n, mut has_converged) = (vec![(1, before.goal)], 1, false);
        let mut front = Vec::new();
        match self.method {
            _ if self.second.is_some() => {
                (n, front) = self.search_front(&start, interrupt, progress)?;
                if let Some(knee) = pareto::knee(&front) {
                    best = knee.clone();
                    history.push((n, best.goal));
                }
            }
            Method::Global => {
                let mut search = Cma::new(&start, 0.3, self.seed);
                while n < self.budget && !has_converged {
                    let points = search.ask();
                    let tried = self.evaluate(&points, interrupt)?;
                    if tried.len() < points.len() {
                        break;
                    }
                    n += tried.len();
                    let mut order: Vec<usize> = (0..tried.len()).collect();
                    order.sort_by(|a, b| compare(&tried[*a], &tried[*b]));
                    if tried[order[0]].is_better_than(&best) {
                        best = tried[order[0]].clone();
                        history.push((n, best.goal));
                    }
                    search.tell(&order.iter().map(|i| points[*i].clone()).collect::<Vec<_>>());
                    has_converged = search.has_converged();
                    progress(n as f64 / self.budget as f64, best.goal);
                }
            }
            Method::Local => {
                let mut failure = None;
                let merit = |x: &[f64]| {
                    let candidate = match self.evaluate(&[x.to_vec()], interrupt) {
                        Ok(mut found) => found.pop()?,
                        Err(error) => {
                            failure = Some(error);
                            return None;
                        }
                    };
                    n += 1;
                    if candidate.is_better_than(&best) {
                        best = candidate.clone();
                        history.push((n, best.goal));
                    }
                    progress(n as f64 / self.budget as f64, best.goal);
                    Some(candidate)
                };
                let made = Simplex::new(&start, 0.05).search(self.budget, merit, Candidate::is_better_than);
                has_converged = made < self.budget;
                if let Some(error) = failure {
                    return Err(error);
                }
            }
        }
        let is_interrupted = interrupt.load(Ordering::Relaxed);
        has_converged &= !is_interrupted;
        let wall_time = clock.elapsed().as_secs_f64();
        let margins = (self.margins_of(&before), self.margins_of(&best));
        let n_candidates = n;
        let found = Tuned {
            before,
            after: best,
            front,
            margins,
            history,
            n_candidates,
            has_converged,
            is_interrupted,
            wall_time,
        };
        Ok(Some(found))
    }

    /// Searches the front of two goals; returns the number of candidates and the front.
    fn search_front(
        &self,
        start: &[f64],
        interrupt: &AtomicBool,
        progress: &mut dyn FnMut(f64, f64),
    ) -> Result<(usize, Vec<Candidate>), RunError> {
        let (mut front, mut parents, mut n, mut generation) = (Vec::new(), Vec::<Member>::new(), 0, 0);
        while n < self.budget {
            let points = match parents.is_empty() {
                true => pareto::first(start, self.seed),
                false => pareto::children(&parents, generation, self.seed),
            };
            let tried = self.evaluate(&points, interrupt)?;
            if tried.len() < points.len() {
                break;
            }
            n += tried.len();
            generation += 1;
            tried.iter().for_each(|candidate| pareto::add(&mut front, candidate));
            let new = points.into_iter().zip(tried).map(|(point, candidate)| Member { point, candidate });
            parents = pareto::survivors(new.chain(parents).collect());
            progress(n as f64 / self.budget as f64, pareto::knee(&front).map_or(f64::NAN, |knee| knee.goal));
        }
        Ok((n, front))
    }

    /// Margins of the loops of the first run with a candidate.
    fn margins_of(&self, candidate: &Candidate) -> Vec<LoopMargin> {
        let point = self.campaign.plan.point(0);
        let loaded = self.campaign.loaded_with(&point, &self.settings(&candidate.values));
        loaded.map(|loaded| margins(&loaded)).unwrap_or_default()
    }

    /// Evaluates points of the unit cube on all processors; fewer come back if it was interrupted.
    fn evaluate(&self, points: &[Vec<f64>], interrupt: &AtomicBool) -> Result<Vec<Candidate>, RunError> {
        let n_runs = self.campaign.plan.n_runs();
        let jobs = points.len() as u64 * n_runs;
        let next = AtomicUsize::new(0);
        let worker = || {
            let mut mine = Vec::new();
            loop {
                let job = next.fetch_add(1, Ordering::Relaxed) as u64;
                if job >= jobs || interrupt.load(Ordering::Relaxed) {
                    return mine;
                }
                let settings = self.settings(&self.values(&points[(job / n_runs) as usize]));
                mine.push((job, self.campaign.run_with(job % n_runs, &settings, interrupt)));
            }
        };
        let n_threads = std::thread::available_parallelism().map_or(1, usize::from).min(jobs.max(1) as usize);
        let mut rows: Vec<_> = std::thread::scope(|scope| {
            let others: Vec<_> = (1..n_threads).map(|_| scope.spawn(worker)).collect();
            let own = worker();
            others.into_iter().flat_map(|thread| thread.join().expect("a run does not panic")).chain(own).collect()
        });
        rows.sort_by_key(|(job, _)| *job);
        let mut found = Vec::with_capacity(rows.len());
        for (_, row) in rows {
            match row? {
                Some(row) => found.push(row.measures),
                None => return Ok(Vec::new()),
            }
        }
        if found.len() as u64 != jobs {
            return Ok(Vec::new());
        }
        let of_point = |(point, runs): (&Vec<f64>, &[Vec<f64>])| {
            let value = |of: &dyn Fn(&[f64]) -> f64| self.robust.of(runs.iter().map(|run| of(run)).collect());
            let goal = value(&|run| self.goal.value(run));
            let second = self.second.as_ref().map_or(f64::NAN, |second| value(&|run| second.value(run)));
            let violations: Vec<f64> = self.limits.iter().map(|limit| value(&|run| limit.violation(run))).collect();
            let violation = violations.iter().sum::<f64>();
            // a goal without value is worse than any limit that is broken
            let violation = if goal.is_finite() { violation } else { f64::INFINITY };
            Candidate { values: self.values(point), goal, second, violation, violations, measures: runs[0].clone() }
        };
        Ok(points.iter().zip(found.chunks(n_runs as usize)).map(of_point).collect())
    }

    fn values(&self, unit: &[f64]) -> Vec<f64> {
        self.free.iter().zip(unit).map(|(free, u)| from_unit(free, *u)).collect()
    }

    /// Returns the settings that give the free parameters the values `values`, one for each in their order and units.
    #[must_use]
    pub fn settings(&self, values: &[f64]) -> Vec<Override> {
        self.free.iter().zip(values).map(|(free, value)| free.setting(*value)).collect()
    }

    /// Returns the values (one for each free parameter, in their order and units) as arguments of the command line:
    /// `--set 'PATH=VALUE'` each, separated by spaces.
    #[must_use]
    pub fn command(&self, values: &[f64]) -> String {
        let set = self.free.iter().zip(values);
        set.map(|(free, value)| format!("--set '{}={value:?}'", free.path)).collect::<Vec<_>>().join(" ")
    }

    /// Returns a summary of the search for the terminal, several lines of English.
    #[must_use]
    pub fn text(&self, tuned: &Tuned) -> String {
        use std::fmt::Write as _;
        let mut out = format!("{}, tuned\n", self.campaign.loaded.experiment.title);
        let width = self.free.iter().map(|free| free.path.chars().count()).max().unwrap_or(0);
        for (k, free) in self.free.iter().enumerate() {
            let (before, after) = (significant(tuned.before.values[k], 5), significant(tuned.after.values[k], 6));
            let _ = writeln!(out, "  {:<width$}  {before} → {after}", free.path);
        }
        let change = 100.0 * (tuned.after.goal / tuned.before.goal - 1.0);
        let _ = writeln!(
            out,
            "  goal {}: {} → {} ({} %)",
            self.goal.text,
            significant(tuned.before.goal, 5),
            significant(tuned.after.goal, 5),
            significant(change, 3)
        );
        if let Some(second) = &self.second {
            let (before, after) = (significant(tuned.before.second, 5), significant(tuned.after.second, 5));
            let _ = writeln!(out, "  goal {}: {before} → {after}", second.text);
            let _ = writeln!(out, "  front of {} candidates, the one nearest to the best of both", tuned.front.len());
        }
        for after in &tuned.margins.1 {
            let before = tuned.margins.0.iter().find(|before| before.signal == after.signal);
            let before = before.map_or_else(|| "open".into(), LoopMargin::words);
            let _ = writeln!(out, "  loop at {}: {before} → {}", after.signal, after.words());
        }
        for (limit, violation) in self.limits.iter().zip(&tuned.after.violations) {
            let of = |candidate: &Candidate| significant(limit.left(&candidate.measures), 4);
            let kept = if *violation > 0.0 { "BROKEN" } else { "kept" };
            let _ = writeln!(out, "  {}: {} → {}, {kept}", limit.text, of(&tuned.before), of(&tuned.after));
        }
        let ended = tuned.ended();
        let _ = writeln!(
            out,
            "  {ended} after {} candidates of {} in {} s, seed {}",
            tuned.n_candidates,
            runs(self.campaign.plan.n_runs()),
            significant(tuned.wall_time, 2),
            self.seed
        );
        let _ = writeln!(out, "  {}", self.command(&tuned.after.values));
        out
    }

    /// Writes `tune.json` and `report.html` into a folder, which is created if it is absent.
    ///
    /// # Errors
    ///
    /// [`FileError`] with the path of the file or folder that cannot be written.
    pub fn write(&self, tuned: &Tuned, folder: &Path) -> Result<(), FileError> {
        sincro_sim::file::prepare(folder)?;
        let names = &self.campaign.layout.measures;
        let of = |candidate: &Candidate| {
            json!({
                "goal": candidate.goal, "second": candidate.second, "violation": candidate.violation, "violations": candidate.violations,
                "values": self.free.iter().zip(&candidate.values).map(|(f, x)| (f.path.clone(), json!(x))).collect::<serde_json::Map<_, _>>(),
                "measures": names.iter().zip(&candidate.measures).map(|(n, x)| (n.clone(), json!(x))).collect::<serde_json::Map<_, _>>(),
            })
        };
        let of_loops = |loops: &[LoopMargin]| {
            let one = |m: &LoopMargin| json!({ "signal": m.signal, "gain_db": m.gain_db, "phase_deg": m.phase_deg, "modulus": m.modulus });
            loops.iter().map(one).collect::<Vec<_>>()
        };
        let document = json!({
            "title": self.campaign.loaded.experiment.title, "goal": self.goal.text, "seed": self.seed,
            "sincro_version": env!("CARGO_PKG_VERSION"),
            "subject": self.limits.iter().map(|limit| limit.text.clone()).collect::<Vec<_>>(),
            "before": of(&tuned.before), "after": of(&tuned.after),
            "second": self.second.as_ref().map(|second| second.text.clone()),
            "front": tuned.front.iter().map(of).collect::<Vec<_>>(),
            "margins": { "before": of_loops(&tuned.margins.0), "after": of_loops(&tuned.margins.1) },
            "candidates": tuned.n_candidates, "converged": tuned.has_converged,
        });
        let text = serde_json::to_string_pretty(&document).expect("plain data") + "\n";
        sincro_sim::file::write_atomically_shared(&folder.join("tune.json"), text.as_bytes())?;
        sincro_sim::file::write_atomically_shared(&folder.join("report.html"), page::html(self, tuned).as_bytes())
    }
}

fn runs(n: u64) -> String {
    if n == 1 { "one run".into() } else { format!("{n} runs") }
}

/// Order of candidates, the better first; equals keep theirs.
fn compare(a: &Candidate, b: &Candidate) -> std::cmp::Ordering {
    match (a.is_better_than(b), b.is_better_than(a)) {
        (true, _) => std::cmp::Ordering::Less,
        (_, true) => std::cmp::Ordering::Greater,
        _ => std::cmp::Ordering::Equal,
    }
}

impl Robust {
    /// Reads `worst`, `mean` or a quantile as a share from 0 to 1, such as `0.9`; `None` for anything else.
    #[must_use]
    pub fn of_word(word: &str) -> Option<Self> {
        match word {
            "worst" => Some(Self::Worst),
            "mean" => Some(Self::Mean),
            share => share.parse().ok().filter(|x| (0.0..=1.0).contains(x)).map(Self::Quantile),
        }
    }

    fn of(self, mut values: Vec<f64>) -> f64 {
        // what has no value is worse than anything
        values.iter_mut().filter(|x| x.is_nan()).for_each(|x| *x = f64::INFINITY);
        values.sort_by(f64::total_cmp);
        match self {
            Self::Worst => values.last().copied().unwrap_or(f64::INFINITY),
            Self::Mean => values.iter().sum::<f64>() / values.len() as f64,
            // no straight line towards an infinite value
            Self::Quantile(share) => {
                values[((share * (values.len() - 1) as f64).ceil() as usize).min(values.len() - 1)]
            }
        }
    }
}

/// True if a parameter is searched on a logarithmic scale: positive bounds that are far apart.
fn is_logarithmic(free: &FreeParameter) -> bool {
    free.low > 0.0 && free.high / free.low > 10.0
}

pub(crate) fn to_unit(free: &FreeParameter, value: f64) -> f64 {
    let u = if is_logarithmic(free) {
        (ln(value).0 - ln(free.low).0) / (ln(free.high).0 - ln(free.low).0)
    } else {
        (value - free.low) / (free.high - free.low)
    };
    u.clamp(0.0, 1.0)
}

pub(crate) fn from_unit(free: &FreeParameter, u: f64) -> f64 {
    let value = if is_logarithmic(free) {
        exp(ln(free.low).0 + u * (ln(free.high).0 - ln(free.low).0)).0
    } else {
        free.low + u * (free.high - free.low)
    };
    value.clamp(free.low, free.high)
}

/// Words of a number for the page.
pub(crate) fn number(x: f64) -> String {
    if x.is_finite() { short(x, 6) } else { "none".into() }
}
