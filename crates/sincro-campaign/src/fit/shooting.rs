//! Multiple shooting: a fit from a start that is far off.
//!
//! The run is cut into parts, each of which begins in a state of its own; the states are unknowns like the parameters.
//! A part is too short for the prediction to leave the data, so that the cost has no other minima on the way, where a
//! single run of oscillations that are out of step has many. The gaps between parts are residuals, whose weight grows
//! tenfold from round to round until they are closed. What comes out is a start for the fit by single runs, which alone
//! gives the solution and its statistics. Source: key `bock1981`.
//!
//! Notation: θ parameters; s_j = (q, v, rotors) state at the start of part j > 0; residuals w·(y − data) and
//! ρ·(x_j(θ, s_j) − s_{j+1})/scale; all derivatives exact, by runs on dual numbers.

use std::sync::atomic::{AtomicUsize, Ordering};

use sincro_analysis::linear::{DMatrix, DVector};
use sincro_dynamics::joint::JointKind;
use sincro_figures::plot::number::significant;
use sincro_scene::diagnostic::Diagnostic;
use sincro_scene::record::{Probe, catalogue};
use sincro_sim::Loaded;

use super::data::interpolate;
use super::difference::Difference;
use super::exact::{D, Neighbours, Rows, Start};
use super::model::{Model, ModelError, Sensitivity, ticks};

/// Weights of the gaps, relative to the size of the data, from round to round.
const WEIGHTS: [f64; 5] = [0.1, 1.0, 10.0, 1e2, 1e3];
/// Iteration limit of a round.
const MAX_ITERATIONS: usize = 12;
/// Relative decrease of the cost below which a round ends.
const CONVERGED: f64 = 1e-6;
/// Measured values on each side of an instant that its state is estimated from.
const NEIGHBOURS: usize = 3;

/// Result of [`shoot`].
#[derive(Clone, Debug, PartialEq)]
pub struct Shot {
    /// Values of the unknowns, a start for [`solve`](super::solve()).
    pub unknowns: Vec<f64>,
    /// Number of parts.
    pub n_parts: usize,
    /// Largest gap that is left between two parts, relative to the size of its state (dimensionless).
    pub gap: f64,
    /// Number of Gauss–Newton iterations, all rounds together.
    pub n_iterations: usize,
}

impl Shot {
    /// Sentence for summary and report.
    #[must_use]
    pub fn words(&self) -> String {
        let gap = significant(self.gap, 2);
        format!("multiple shooting in {} parts, {} iterations, gaps closed to {gap}", self.n_parts, self.n_iterations)
    }
}

/// Finds values of the free parameters by multiple shooting in `n_parts` parts (2 or more).
///
/// # Errors
///
/// [`ModelError::Refused`]: the scene has no exact derivatives, or it has a diagram, a ball or free joint, or the model
/// has time offsets. [`ModelError::Stopped`]: a part cannot be run from the starts. [`ModelError::Interrupted`].
pub fn shoot(model: &Model<'_>, n_parts: usize) -> Result<Shot, ModelError> {
    let shooting = Shooting::new(model, n_parts)?;
    let mut x = shooting.start()?;
    let (mut n_iterations, size) = (0, shooting.size());
    for weight in WEIGHTS {
        n_iterations += shooting.minimise(&mut x, weight * size)?;
    }
    let n = model.free.len();
    let gap = shooting.evaluate(&x, 1.0, false)?.gaps.iter().fold(0.0_f64, |a, g| a.max(g.abs()));
    Ok(Shot { unknowns: x[..n].to_vec(), n_parts: shooting.parts.len(), gap, n_iterations })
}

/// One datum: row of the model's data, part, signal, time, value, weight.
struct Datum {
    part: usize,
    signal: usize,
    t: f64,
    value: f64,
    weight: f64,
}

struct Shooting<'a> {
    model: &'a Model<'a>,
    /// First and last tick of each part.
    parts: Vec<(usize, usize)>,
    step: f64,
    n_states: usize,
    data: Vec<Datum>,
    /// Typical size of each state.
    scales: Vec<f64>,
    /// Scene at the starts.
    at_start: Loaded,
}

/// Residuals and their derivatives.
struct Evaluation {
    residuals: Vec<f64>,
    /// Gaps relative to the sizes of their states.
    gaps: Vec<f64>,
    /// Columns by unknown; empty if they were not asked for.
    jacobian: Vec<Vec<f64>>,
}

impl<'a> Shooting<'a> {
    fn new(model: &'a Model<'a>, n_parts: usize) -> Result<Self, ModelError> {
        let start: Vec<f64> = model.free.iter().map(|free| free.start).collect();
        let at_start = model.at(&start)?;
        if let Some(reason) = obstacle(model, &at_start)? {
            let problem = Diagnostic::without_location(format!("multiple shooting cannot be done: {reason}"));
            let help = "leave `--shooting` out, or give a start that is near: --free PATH=START";
            return Err(ModelError::Refused(problem.with_help(help).into()));
        }
        let (step, n_ticks) = ticks(&at_start);
        // the cubic between rows needs four of them
        let n_parts = n_parts.clamp(2, (n_ticks / 4).max(2));
        let parts: Vec<(usize, usize)> =
            (0..n_parts).map(|j| (j * n_ticks / n_parts, (j + 1) * n_ticks / n_parts)).collect();
        let signals = model.signals();
        let part_of = |t: f64| parts.iter().position(|(_, last)| t < *last as f64 * step - 1e-9).unwrap_or(n_parts - 1);
        let mut data = Vec::new();
        for column in model.sets.iter().flat_map(|set| set.columns.iter().map(move |column| (set, column))) {
            let (set, column) = column;
            let signal = signals.iter().position(|known| *known == column.signal).unwrap_or(0);
            let measured = set.times.iter().zip(&column.values).filter(|(_, value)| value.is_finite());
            data.extend(measured.map(|(t, value)| Datum {
                part: part_of(*t),
                signal,
                t: *t,
                value: *value,
                weight: column.weight,
            }));
        }
        let scene = &at_start.scene.model;
        let n_states = scene.n_q() + scene.n_v() + scene.n_rotor_states();
        Self { model, parts, step, n_states, data, scales: vec![1.0; n_states], at_start }.with_scales()
    }

    /// Root mean square of the weighted data.
    fn size(&self) -> f64 {
        let squares: f64 = self.data.iter().map(|d| d.weight * d.weight * d.value * d.value).sum();
        (squares / self.data.len().max(1) as f64).sqrt().max(f64::MIN_POSITIVE)
    }

    /// Sizes of the states: their largest values at the starts of the parts.
    fn with_scales(mut self) -> Result<Self, ModelError> {
        let x = self.start()?;
        let states = &x[self.model.free.len()..];
        let largest = states.iter().fold(0.0_f64, |a, s| a.max(s.abs())).max(1e-9);
        for (k, scale) in self.scales.iter_mut().enumerate() {
            let all = states.iter().skip(k).step_by(self.n_states);
            *scale = all.fold(0.0_f64, |a, s| a.max(s.abs())).max(1e-3 * largest);
        }
        Ok(self)
    }

    /// Starts of the parameters, then of the states: as measured where a coordinate or its rate is, else as a run from
    /// the starts has them.
    fn start(&self) -> Result<Vec<f64>, ModelError> {
        let values: Vec<f64> = self.model.free.iter().map(|free| free.start).collect();
        let around = self.nominal(&values)?;
        let entries = catalogue(&self.at_start.scene.model);
        let n_q = self.at_start.scene.model.n_q();
        let place = |signal: &str| match entries.iter().find(|entry| entry.name == signal)?.probe {
            Probe::Coordinate(k) => Some(k),
            Probe::Rate(k) => Some(n_q + k),
            _ => None,
        };
        let mut x = values.clone();
        let mut simulated: Option<Vec<f64>> = None;
        for (j, (first, last)) in self.parts.iter().enumerate() {
            let start = match &simulated {
                None => Start::OF_RUN,
                Some(state) => Start { tick: *first as u64, state: Some(state), direction: None },
            };
            if j > 0 {
                x.extend(simulated.clone().unwrap_or_default());
                let own = x.len() - self.n_states;
                let t = *first as f64 * self.step;
                for set in self.model.sets {
                    for column in &set.columns {
                        let Some(k) = place(&column.signal) else { continue };
                        let Some((value, slope)) = local_line(&set.times, &column.values, t) else { continue };
                        x[own + k] = value;
                        let rate_is_measured = set.columns.iter().any(|c| place(&c.signal) == Some(n_q + k));
                        if k < n_q && !rate_is_measured {
                            x[own + n_q + k] = slope;
                        }
                    }
                }
            }
            let rows = self.model.dual_run(&around, &start, last - first).map_err(ModelError::Stopped)?;
            simulated = Some(rows.end.iter().map(|s| s.value).collect());
        }
        Ok(x)
    }

    /// The scene at values of the parameters, without neighbours.
    fn nominal(&self, values: &[f64]) -> Result<Neighbours, ModelError> {
        Ok(Neighbours { scenes: vec![self.model.at(values)?], difference: Difference::at(0.0, self.model.bounds(0)) })
    }

    /// Levenberg–Marquardt iterations with the weight `rho` of the gaps; returns their number.
    fn minimise(&self, x: &mut Vec<f64>, rho: f64) -> Result<usize, ModelError> {
        let n = x.len();
        let n_free = self.model.free.len();
        let scale = |k: usize| match k.checked_sub(n_free) {
            None => self.model.bounds(k).3,
            Some(state) => self.scales[state % self.n_states],
        };
        let clamp = |k: usize, value: f64| match k < n_free {
            true => value.clamp(self.model.bounds(k).1, self.model.bounds(k).2),
            false => value,
        };
        let mut damping = 1e-3;
        for iteration in 0..MAX_ITERATIONS {
            let at = self.evaluate(x, rho, true)?;
            let r = DVector::from_fn(at.residuals.len(), |i, _| at.residuals[i]);
            let jacobian = DMatrix::from_fn(at.residuals.len(), n, |i, k| at.jacobian[k][i] * scale(k));
            let (hessian, right) = (jacobian.transpose() * &jacobian, -(jacobian.transpose() * &r));
            let cost = r.norm_squared();
            let accepted = loop {
                if damping > 1e10 {
                    break None;
                }
                let mut damped = hessian.clone();
                (0..n).for_each(|k| damped[(k, k)] += damping * hessian[(k, k)].max(1e-12));
                let step = damped.cholesky().map(|factor| factor.solve(&right));
                let tried = step.map(|step| (0..n).map(|k| clamp(k, x[k] + step[k] * scale(k))).collect::<Vec<f64>>());
                let found = match tried {
                    None => None,
                    Some(next) => match self.evaluate(&next, rho, false) {
                        Err(ModelError::Interrupted) => return Err(ModelError::Interrupted),
                        Err(_) => None,
                        Ok(of) => Some((next, of.residuals.iter().map(|r| r * r).sum::<f64>())),
                    },
                };
                match found {
                    Some((next, tried)) if tried <= cost => break Some((next, tried)),
                    _ => damping *= 5.0,
                }
            };
            let Some((next, tried)) = accepted else { return Ok(iteration + 1) };
            *x = next;
            damping = (damping * 0.2).max(1e-12);
            if cost - tried <= CONVERGED * cost {
                return Ok(iteration + 1);
            }
        }
        Ok(MAX_ITERATIONS)
    }

    /// Residuals of data and gaps at `x`, and their derivatives if wanted.
    fn evaluate(&self, x: &[f64], rho: f64, with_derivatives: bool) -> Result<Evaluation, ModelError> {
        let n_free = self.model.free.len();
        let (values, states) = x.split_at(n_free);
        let nominal = self.nominal(values)?;
        let along: Vec<Neighbours> = match with_derivatives {
            true => (0..n_free).map(|k| self.model.neighbours(values, k)).collect::<Result<_, _>>()?,
            false => Vec::new(),
        };
        // part, and the unknown that is differentiated by
        let mut jobs: Vec<(usize, Option<usize>)> = Vec::new();
        for j in 0..self.parts.len() {
            if with_derivatives {
                jobs.extend((0..n_free).map(|k| (j, Some(k))));
                let own = n_free + (j.max(1) - 1) * self.n_states;
                jobs.extend((own..own + self.n_states).filter(|_| j > 0).map(|k| (j, Some(k))));
            } else {
                jobs.push((j, None));
            }
        }
        let run = |(j, by): (usize, Option<usize>)| {
            let (first, last) = self.parts[j];
            let own = j.checked_sub(1).map(|j| &states[j * self.n_states..(j + 1) * self.n_states]);
            let direction = by.and_then(|k| k.checked_sub(n_free)).map(|k| k % self.n_states);
            let start = Start { tick: first as u64, state: own, direction };
            let around = by.and_then(|k| along.get(k)).unwrap_or(&nominal);
            self.model.dual_run(around, &start, last - first)
        };
        let rows = in_parallel(&jobs, &run);
        let mut found = Evaluation { residuals: Vec::new(), gaps: Vec::new(), jacobian: Vec::new() };
        let n_rows = self.data.len() + (self.parts.len() - 1) * self.n_states;
        if with_derivatives {
            found.jacobian = vec![vec![0.0; n_rows]; x.len()];
        }
        let mut residuals = vec![0.0; n_rows];
        for ((j, by), rows) in jobs.iter().zip(rows) {
            if self.model.interrupt.load(Ordering::Relaxed) {
                return Err(ModelError::Interrupted);
            }
            let rows = rows.map_err(ModelError::Stopped)?;
            self.fill(*j, &rows, rho, &mut residuals, by.map(|k| &mut found.jacobian[k]));
        }
        for j in 1..self.parts.len() {
            for k in 0..self.n_states {
                let row = self.data.len() + (j - 1) * self.n_states + k;
                residuals[row] -= rho / self.scales[k] * states[(j - 1) * self.n_states + k];
                if with_derivatives {
                    found.jacobian[n_free + (j - 1) * self.n_states + k][row] -= rho / self.scales[k];
                }
            }
        }
        found.gaps = residuals[self.data.len()..].iter().map(|gap| gap / rho).collect();
        found.residuals = residuals;
        Ok(found)
    }

    /// Residuals of the data of part `j` and of the gap at its end, from its rows; its derivatives go to `column`.
    fn fill(&self, j: usize, rows: &Rows, rho: f64, residuals: &mut [f64], mut column: Option<&mut Vec<f64>>) {
        let n_signals = rows.signals.first().map_or(0, Vec::len);
        let series = |pick: fn(&D) -> f64| -> Vec<Vec<f64>> {
            (0..n_signals).map(|s| rows.signals.iter().map(|row| pick(&row[s])).collect()).collect()
        };
        let (values, slopes) = (series(|x| x.value), series(|x| x.partials[0]));
        for (i, datum) in self.data.iter().enumerate().filter(|(_, datum)| datum.part == j) {
            residuals[i] = datum.weight * (interpolate(&rows.times, &values[datum.signal], datum.t) - datum.value);
            if let Some(column) = &mut column {
                column[i] += datum.weight * interpolate(&rows.times, &slopes[datum.signal], datum.t);
            }
        }
        if j + 1 < self.parts.len() {
            for (k, end) in rows.end.iter().enumerate() {
                let row = self.data.len() + j * self.n_states + k;
                residuals[row] = rho / self.scales[k] * end.value;
                if let Some(column) = &mut column {
                    column[row] += rho / self.scales[k] * end.partials[0];
                }
            }
        }
    }
}

/// Runs all jobs on all processors; results in their order.
fn in_parallel<T: Send, J: Copy + Sync>(jobs: &[J], run: &(impl Fn(J) -> T + Sync)) -> Vec<T> {
    let next = AtomicUsize::new(0);
    let worker = || {
        let mut mine = Vec::new();
        loop {
            let k = next.fetch_add(1, Ordering::Relaxed);
            let Some(job) = jobs.get(k) else { return mine };
            mine.push((k, run(*job)));
        }
    };
    let n_threads = std::thread::available_parallelism().map_or(1, usize::from).min(jobs.len().max(1));
    let mut all: Vec<(usize, T)> = std::thread::scope(|scope| {
        let others: Vec<_> = (1..n_threads).map(|_| scope.spawn(worker)).collect();
        let own = worker();
        others.into_iter().flat_map(|thread| thread.join().expect("a run does not panic")).chain(own).collect()
    });
    all.sort_by_key(|(k, _)| *k);
    all.into_iter().map(|(_, result)| result).collect()
}

/// Value and slope at `t` of the line through the measured values nearest to it; `None` of fewer than three.
fn local_line(times: &[f64], values: &[f64], t: f64) -> Option<(f64, f64)> {
    let finite: Vec<(f64, f64)> =
        times.iter().zip(values).filter(|(_, x)| x.is_finite()).map(|(t, x)| (*t, *x)).collect();
    let middle = finite.partition_point(|(time, _)| *time < t);
    let near = &finite[middle.saturating_sub(NEIGHBOURS)..(middle + NEIGHBOURS).min(finite.len())];
    if near.len() < 3 {
        return None;
    }
    let n = near.len() as f64;
    let (mean_t, mean_x) = (near.iter().map(|p| p.0).sum::<f64>() / n, near.iter().map(|p| p.1).sum::<f64>() / n);
    let spread: f64 = near.iter().map(|p| (p.0 - mean_t) * (p.0 - mean_t)).sum();
    let slope = near.iter().map(|p| (p.0 - mean_t) * (p.1 - mean_x)).sum::<f64>() / spread;
    Some((mean_x + slope * (t - mean_t), slope))
}

/// Reason why the run of a model cannot be cut into parts.
fn obstacle(model: &Model<'_>, at: &Loaded) -> Result<Option<String>, ModelError> {
    if model.has_offsets {
        return Ok(Some("the data have time offsets".into()));
    }
    if at.controller.is_some() {
        return Ok(Some("the scene has a diagram, whose memory would be unknown".into()));
    }
    let of_joints = &at.scene.model.names().joints;
    if let Some(joint) = of_joints.iter().find(|joint| matches!(joint.kind, JointKind::Ball | JointKind::Free)) {
        return Ok(Some(format!("joint `{}` has a quaternion", joint.name)));
    }
    let reason = |way: &Sensitivity| match way {
        Sensitivity::Exact => None,
        Sensitivity::Differences(reason) => Some(format!("there are no exact derivatives: {reason}")),
    };
    Ok(model.ways()?.iter().find_map(reason))
}
