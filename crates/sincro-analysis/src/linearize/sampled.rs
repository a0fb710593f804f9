//! Sampled loops as a whole: the map of the state from one sample to the next.
//!
//! A controller with sample times and a world between them are a discrete system x⁺ = f(x). With several sample times
//! the system is *lifted*: one period is their least common multiple, after which everything is due again (key
//! `chen1995`, chapter 8). The derivative of f is found from the run itself: each state is moved to both sides, all
//! blocks that are due measure it, and the lock-step goes over one period, with its holds, jumps of velocity motors,
//! limits and contacts. Poles are the eigenvalues of the derivative.
//!
//! States are the independent coordinates and speeds of the world, states of rotors, continuous states and memory of
//! the diagram, last samples of sensors. Memory and samples that a period overwrites without a trace, or that nothing
//! depends on, are left out.

use sincro_blocks::program::Rate;
use sincro_dynamics::model::Model;
use sincro_math::Dual;
use sincro_sim::snapshot::Snapshot;

use super::lens::Lens;
use super::names::Names;
use super::point;
use super::reduction::{Equations, Metric, Tangent};
use crate::linear::{Axis, DMatrix, DVector, StateSpace};
use sincro_scene::diagnostic::Diagnostic;
use sincro_sim::load::Loaded;
use sincro_sim::run::{Halt, LockStep};

/// Change of each state `[rad]`, `[m]` and the like: differences are central, their error is of its square.
pub(super) const CHANGE: f64 = 1e-5;

/// Derivatives below this are rounding of an effect that does not exist.
const NO_EFFECT: f64 = 1e-9;

/// Base steps in a period that is still lifted.
const MAX_PERIOD: u64 = 100_000;

/// Linear map of a scene with its sampled controller over one period, the least common multiple of all sample times
/// (lifting). Its poles tell the stability of the sampled loop; result of [`linearize_sampled`].
#[derive(Clone, Debug, PartialEq)]
pub struct SampledLoop {
    /// Discrete system x⁺ = A x from one period to the next, without inputs and outputs. Its sample time is the period
    /// `[s]`.
    pub system: StateSpace,
    /// Length of the period in base steps of the experiment.
    pub period: u64,
    /// Largest magnitude among the changes of the states over one period `[unit of the state]`; zero at an equilibrium.
    pub drift: f64,
}

/// Linearises a scene together with its sampled controller at the state that a run is in, by central differences over
/// one period of the lock-step. States are those of the world, of the diagram, and the last samples of sensors.
///
/// # Errors
///
/// A message that the run stops within the period, that a block gives a number that is not finite, or that the sample
/// times have no common multiple of 100 000 base steps or less.
pub fn linearize_sampled(loaded: &Loaded, at: &LockStep) -> Result<SampledLoop, Diagnostic> {
    let period = period(loaded, at)?;
    let mut map = PeriodMap::new(loaded, at, period)?;
    let middle = map.after(&vec![0.0; map.n_states()])?;
    let n = map.n_states();
    let mut a = DMatrix::zeros(n, n);
    let mut change = vec![0.0; n];
    for k in 0..n {
        let mut side = |by: f64| {
            change[k] = by;
            let end = map.after(&change);
            change[k] = 0.0;
            end
        };
        let (up, down) = (side(CHANGE)?, side(-CHANGE)?);
        a.set_column(k, &map.slope(&up, &down, &middle));
    }
    let start = map.at_start();
    let drift = map.difference(&middle, &start).iter().fold(0.0_f64, |worst, x| worst.max(x.abs()));
    let kept = map.kept(&a, &DMatrix::zeros(0, n));
    let a = a.select_rows(&kept).select_columns(&kept);
    let n = kept.len();
    let system = StateSpace {
        b: DMatrix::zeros(n, 0),
        c: DMatrix::zeros(0, n),
        d: DMatrix::zeros(0, 0),
        states: kept.iter().map(|&k| map.axes[k].clone()).collect(),
        inputs: Vec::new(),
        outputs: Vec::new(),
        t: at.t(),
        sample_time: Some(period as f64 * at.step()),
        a,
    };
    Ok(SampledLoop { system, period, drift })
}

/// Moment of a period at which the blocks that are due are evaluated, with the number of base steps done.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Moment {
    Before(u64),
    After(u64),
}

/// Base steps after which every block and sensor is due again.
pub(super) fn period(loaded: &Loaded, at: &LockStep) -> Result<u64, Diagnostic> {
    let of_blocks = at.control().into_iter().flat_map(|control| {
        let steps = control.wiring().program().steps.iter();
        steps.filter_map(|step| if let Rate::Sampled(every) = step.rate { Some(every) } else { None })
    });
    let of_sensors = loaded.scene.sensors.iter().filter_map(|sensor| sensor.sample_time.as_ref());
    let of_sensors = of_sensors.map(|time| (time.value / at.step()).round().max(1.0) as u64);
    let period = of_blocks.chain(of_sensors).try_fold(1, |all, every| {
        let lifted = all / common(all, every) * every;
        (lifted <= MAX_PERIOD).then_some(lifted)
    });
    period.ok_or_else(|| {
        let message = format!("the sample times have no common multiple of {MAX_PERIOD} base steps or less");
        Diagnostic::without_location(message).with_help("choose sample times that are multiples of one another")
    })
}

/// Greatest common divisor.
fn common(a: u64, b: u64) -> u64 {
    if b == 0 { a } else { common(b, a % b) }
}

/// The state over a period as a function of its change at the start.
pub(super) struct PeriodMap<'a> {
    lens: Lens<f64>,
    model: &'a Model<f64>,
    run: LockStep,
    start: Snapshot,
    tangent: Tangent,
    period: u64,
    axes: Vec<Axis>,
    n_continuous: usize,
    n_memory: usize,
}

impl<'a> PeriodMap<'a> {
    pub fn new(loaded: &'a Loaded, at: &LockStep, period: u64) -> Result<Self, Diagnostic> {
        let mut run = at.fork().lockstep;
        // everything is due where the period begins
        while !run.tick().is_multiple_of(period) {
            run.advance().map_err(|halt| stopped(&halt))?;
        }
        let start = run.snapshot(run.trace());
        point::select_loop_equations(&mut run);
        let mut settled = run.fork().lockstep;
        point::initialize(&mut settled);
        let names = Names::default();
        let mut lens = Lens::<f64>::new(loaded, &mut settled, &names);
        let mut duals = Lens::<Dual<1>>::new(loaded, &mut settled, &names);
        // motors jump to their velocity: it is a state until then
        lens.release_motors();
        duals.release_motors();
        let equations = Equations::of(&mut duals);
        let q = settled.state().q.clone();
        let metric = Metric::of(settled.world().model(), &q);
        let tangent = Tangent::of(&mut duals, &equations, &metric, &[]);
        let mut axes: Vec<Axis> = tangent.states.iter().map(|&k| lens.axes()[k].clone()).collect();
        let (n_continuous, n_memory) = start.diagram.as_ref().map_or((0, 0), |d| (d.continuous.len(), d.memory.len()));
        let named = |what: &str, n: usize| (1..=n).map(|k| Axis::new(format!("{what} {k}"), "")).collect::<Vec<_>>();
        axes.extend(named("continuous state", n_continuous));
        axes.extend(named("memory", n_memory));
        axes.extend(named("sample", start.sensors.len()));
        let model = &loaded.scene.model;
        Ok(Self { lens, model, run, start, tangent, period, axes, n_continuous, n_memory })
    }

    pub fn n_states(&self) -> usize {
        self.axes.len()
    }

    /// Names and units of the states.
    pub fn axes(&self) -> &[Axis] {
        &self.axes
    }

    /// States with an effect: all of the world, and of the others those that something else or an output depends on.
    pub fn kept(&self, a: &DMatrix<f64>, c: &DMatrix<f64>) -> Vec<usize> {
        let n_world = self.tangent.states.len() + self.n_continuous;
        let mut kept: Vec<usize> = (0..self.n_states()).collect();
        let has_effect = |k: usize, kept: &[usize]| {
            kept.iter().any(|&i| i != k && a[(i, k)].abs() > NO_EFFECT)
                || c.column(k).iter().any(|x| x.abs() > NO_EFFECT)
        };
        while let Some(at) = kept.iter().rposition(|&k| {
            let stays = (a[(k, k)] - 1.0).abs() <= NO_EFFECT || a[(k, k)].abs() <= NO_EFFECT;
            k >= n_world && stays && !has_effect(k, &kept)
        }) {
            kept.remove(at);
        }
        kept
    }

    /// The state itself, before any change.
    fn at_start(&self) -> Snapshot {
        self.start.clone()
    }

    /// Derivative of the state by a change of [`CHANGE`] to both sides, from the states that these lead to and the one
    /// between.
    pub fn slope(&self, up: &Snapshot, down: &Snapshot, middle: &Snapshot) -> DVector<f64> {
        let sides = (self.difference(up, middle), self.difference(down, middle));
        let slopes = sides.0.iter().zip(&sides.1).map(|(up, down)| (up - down) / (2.0 * CHANGE));
        DVector::from_iterator(sides.0.len(), slopes)
    }

    /// The state after one period from a changed one.
    pub fn after(&mut self, change: &[f64]) -> Result<Snapshot, Diagnostic> {
        self.after_with(change, |_, _| ())
    }

    /// The state after one period from a changed one; `visit` sees the run before and after each evaluation of the
    /// blocks, to open a loop and to read what is given there.
    pub fn after_with(
        &mut self,
        change: &[f64],
        mut visit: impl FnMut(Moment, &mut LockStep),
    ) -> Result<Snapshot, Diagnostic> {
        let n_world = self.tangent.states.len();
        let mut full = vec![0.0; self.lens.n_full()];
        for (x, column) in change.iter().zip(&self.tangent.columns) {
            full.iter_mut().zip(column).for_each(|(sum, c)| *sum += x * c);
        }
        let mut snapshot = self.start.clone();
        let (state, _) = self.lens.displaced(&full);
        (snapshot.state.q, snapshot.state.v, snapshot.state.rotors) = (state.q, state.v, state.rotors);
        let mut rest = change[n_world..].iter();
        if let Some(diagram) = &mut snapshot.diagram {
            diagram.continuous.iter_mut().zip(&mut rest).for_each(|(x, by)| *x += by);
            diagram.memory.iter_mut().zip(&mut rest).for_each(|(x, by)| *x += by);
        }
        snapshot.sensors.iter_mut().zip(rest).for_each(|(x, by)| *x += by);
        self.run.restore(&snapshot);
        visit(Moment::Before(0), &mut self.run);
        if let (Some(control), Some(diagram)) = (self.run.control(), &mut snapshot.diagram) {
            let (mut control, tick, t) = (control.clone(), self.run.tick(), self.run.t());
            // its own samples are those of the run before
            control.set_samples(&snapshot.sensors);
            let measured = control.evaluate(self.run.world(), tick, t);
            measured.map_err(|_| {
                Diagnostic::without_location("a block of the diagram gives what is not a finite number")
            })?;
            *diagram = control.runner.save();
            self.run.restore(&snapshot);
            self.run.set_opening(control.runner.opening);
        }
        visit(Moment::After(0), &mut self.run);
        for tick in 1..=self.period {
            visit(Moment::Before(tick), &mut self.run);
            self.run.advance().map_err(|halt| stopped(&halt))?;
            visit(Moment::After(tick), &mut self.run);
        }
        Ok(self.run.snapshot(self.run.trace()))
    }

    /// The states by which one snapshot differs from another.
    fn difference(&self, a: &Snapshot, b: &Snapshot) -> Vec<f64> {
        let n_v = self.model.n_v();
        let q = coordinate_difference(self.model, &a.state.q, &b.state.q);
        let minus = |x: &[f64], y: &[f64]| x.iter().zip(y).map(|(x, y)| x - y).collect::<Vec<f64>>();
        let (v, rotors) = (minus(&a.state.v, &b.state.v), minus(&a.state.rotors, &b.state.rotors));
        let full: Vec<f64> = q.into_iter().chain(v).chain(rotors).collect();
        debug_assert!(full.len() >= 2 * n_v, "coordinates and velocities first");
        let mut all: Vec<f64> = self.tangent.states.iter().map(|&k| full[k]).collect();
        if let (Some(a), Some(b)) = (&a.diagram, &b.diagram) {
            debug_assert_eq!((a.continuous.len(), a.memory.len()), (self.n_continuous, self.n_memory));
            all.extend(minus(&a.continuous, &b.continuous));
            all.extend(minus(&a.memory, &b.memory));
        }
        all.extend(minus(&a.sensors, &b.sensors));
        all
    }
}

/// Displacement from coordinates `b` to near ones `a`, `n_v` numbers: to first order for rotations.
fn coordinate_difference(model: &Model<f64>, a: &[f64], b: &[f64]) -> Vec<f64> {
    let mut all = vec![0.0; model.n_v()];
    for joint in &model.names().joints {
        let (q, v) = (joint.q_idx, joint.v_idx);
        match (joint.n_q, joint.n_v) {
            (4, 3) => all[v..v + 3].copy_from_slice(&turn_between(&a[q..q + 4], &b[q..q + 4])),
            (7, 6) => {
                all[v..v + 3].copy_from_slice(&turn_between(&a[q + 3..q + 7], &b[q + 3..q + 7]));
                let shift = sincro_dynamics::spatial::Vec3([a[q] - b[q], a[q + 1] - b[q + 1], a[q + 2] - b[q + 2]]);
                let rotation = sincro_dynamics::spatial::Quat::from_slice(&b[q + 3..q + 7]).matrix();
                all[v + 3..v + 6].copy_from_slice(&rotation.tr_mul_vec(shift).0);
            }
            (n_q, _) => (0..n_q).for_each(|k| all[v + k] = a[q + k] - b[q + k]),
        }
    }
    all
}

/// Rotation vector from quaternion `b` to a near one `a`, in the axes of `b`: twice the vector part of b⁻¹ a.
fn turn_between(a: &[f64], b: &[f64]) -> [f64; 3] {
    let scalar = a[0] * b[0] + a[1] * b[1] + a[2] * b[2] + a[3] * b[3];
    let sign = if scalar < 0.0 { -2.0 } else { 2.0 };
    [
        sign * (b[0] * a[1] - b[1] * a[0] - b[2] * a[3] + b[3] * a[2]),
        sign * (b[0] * a[2] + b[1] * a[3] - b[2] * a[0] - b[3] * a[1]),
        sign * (b[0] * a[3] - b[1] * a[2] + b[2] * a[1] - b[3] * a[0]),
    ]
}

fn stopped(halt: &Halt) -> Diagnostic {
    let after = if halt.is_after_step() { "after a step" } else { "within a step" };
    Diagnostic::without_location(format!("the run stops {after} of a period")).with_help("`sincro run` says why")
}
