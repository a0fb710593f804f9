//! Exact derivatives of a run by a parameter: the lock-step on dual numbers.
//!
//! A parameter enters through the numbers of the model, the initial state and the commands of the scene. Their
//! derivatives by the parameter come from the scene loaded at neighbouring values: exact to rounding where a number is
//! a polynomial of the parameter up to the fourth degree, such as a stiffness, a mass or the inertia of a shape. From
//! there on dual numbers carry them through equations, diagram and integrator ([`TangentWorld`]), across impacts of
//! joints on their limits too.
//!
//! Whatever keeps a scene or a parameter from that is named ([`obstacle`], [`obstacle_of`]).

use std::cell::Cell;

use sincro_dynamics::coupled::{CoupledSystem, MechanismResponse, NoCoupling, StateView};
use sincro_dynamics::integrate::Control;
use sincro_dynamics::kinematics;
use sincro_dynamics::model::Model as DynamicsModel;
use sincro_dynamics::state::State;
use sincro_dynamics::tangent::{TangentWorld, constant_state, obstacle_to_tangent};
use sincro_dynamics::world::MethodKind;
use sincro_math::Dual;
use sincro_scene::diagram::is_known_at_ticks_only;
use sincro_scene::record::probe::{self, View, needs_kinematics};
use sincro_scene::record::{EnergyQuantity, Entry, Probe, catalogue};
use sincro_sim::Loaded;
use sincro_sim::diagram_controller::DiagramController;
use sincro_sim::run::{method_for, world_of};

use super::difference::{Difference, WIDTH};

/// Bend of a number that is rounding, relative to the number.
const ROUNDING: f64 = 1e-14;

/// Number with the derivative by one parameter.
pub(super) type D = Dual<1>;

/// Reason why a run of the scene has no exact derivatives of `signals`, as a sentence; `None` if it has.
pub(super) fn obstacle(loaded: &Loaded, signals: &[String]) -> Option<String> {
    let model = &loaded.scene.model;
    if let Some(reason) = obstacle_to_tangent(model, method_for(loaded).0) {
        return Some(reason);
    }
    if let Some(script) = loaded.scene.scripts.first() {
        return Some(format!("the script of `{}` acts in steps", script.path));
    }
    if !loaded.controllers.is_empty() {
        return Some("a controller of the program is attached".into());
    }
    if let Some(controller) = &loaded.controller {
        let wiring = &controller.wiring;
        if let Some(step) = wiring.program().steps.iter().find(|step| step.template.zero_crossing_count().is_some()) {
            return Some(format!("block `{}` has events of its own", step.path));
        }
        if !wiring.late.is_empty() {
            return Some("the diagram measures accelerations or motor torques".into());
        }
        if wiring.early.iter().flat_map(|reading| &reading.probes).any(|probe| is_known_at_ticks_only(*probe)) {
            return Some("the diagram measures sensors or forces of contact".into());
        }
    }
    signals.iter().find_map(|signal| match find_probe(loaded, signal) {
        Some(probe) if is_differentiable(probe) => None,
        _ => Some(format!("the signal `{signal}` has no derivative")),
    })
}

/// Obstacle to the exact derivative by one parameter.
pub(super) enum Obstacle {
    /// There is none.
    None,
    /// Blocks of the diagram hold other numbers, which they may or may not use: robots of the scene are such numbers.
    Suspected(String),
    /// The parameter enters where no derivatives are carried.
    Certain(String),
}

/// Obstacle to the exact derivative by the parameter in which two loaded scenes differ.
pub(super) fn obstacle_of(at: &Loaded, beside: &Loaded) -> Obstacle {
    let models = [&*at.scene.model, &*beside.scene.model];
    if let Err(error) = DynamicsModel::<D>::differentiated(&models, &|_| 0.0) {
        return Obstacle::Certain(format!("it changes the {}", error.0));
    }
    if at.experiment.step != beside.experiment.step || method_for(at).0 != method_for(beside).0 {
        return Obstacle::Certain("it changes the integration".into());
    }
    let program = |loaded: &Loaded| loaded.controller.as_ref().map(|c| format!("{:?}", c.wiring.program()));
    if program(at) == program(beside) {
        Obstacle::None
    } else {
        Obstacle::Suspected("it changes a block of the diagram".into())
    }
}

/// Entry of a signal of the scene or the diagram.
fn find(loaded: &Loaded, signal: &str) -> Option<Entry> {
    let of_diagram = loaded.controller.as_ref().map(|c| c.entries()).unwrap_or_default();
    catalogue(&loaded.scene.model).into_iter().chain(of_diagram).find(|entry| entry.name == signal)
}

fn find_probe(loaded: &Loaded, signal: &str) -> Option<Probe> {
    find(loaded, signal).map(|entry| entry.probe)
}

/// Unit of a signal of the scene or the diagram; empty if it is not known.
pub(super) fn unit(loaded: &Loaded, signal: &str) -> String {
    find(loaded, signal).map(|entry| entry.unit.into_owned()).unwrap_or_default()
}

fn is_differentiable(probe: Probe) -> bool {
    matches!(probe, Probe::MotorTorqueMean(_)) || !(is_known_at_ticks_only(probe) || is_of_constraints(probe))
}

/// Signals of what holds a mechanism together, which are no function of state and commands alone here.
fn is_of_constraints(probe: Probe) -> bool {
    matches!(
        probe,
        Probe::JointReaction(..)
            | Probe::FrictionTorque(_)
            | Probe::LimitTorque(_)
            | Probe::Opening(_)
            | Probe::Energy(EnergyQuantity::Balance)
    )
}

/// Scene at the values of the unknowns, and at neighbouring ones of the unknown that is differentiated by.
pub(super) struct Neighbours {
    /// At the values, then at the two points of the wider difference and, unless all numbers are affine, of the
    /// narrower one.
    pub scenes: Vec<Loaded>,
    /// The difference.
    pub difference: Difference,
}

impl Neighbours {
    /// Changes of the unknown at which scenes are needed beside the values, in their order.
    pub fn steps(difference: Difference) -> [f64; 4] {
        let ([a, b], [c, d]) = (difference.steps(WIDTH), difference.steps(0.5 * WIDTH));
        [a, b, c, d]
    }

    /// Derivative of a number by the unknown, from its values in all scenes.
    fn derivative(&self, x: &[f64]) -> f64 {
        let wide = self.difference.slope(WIDTH, x[1], x[2], x[0]);
        match x {
            [_, _, _] => wide,
            _ => Difference::extrapolated(wide, self.difference.slope(0.5 * WIDTH, x[3], x[4], x[0])),
        }
    }

    /// Returns true if no number of the model, the initial state or the commands bends between the values and the two
    /// points of the wider difference: then their slopes are the derivatives.
    pub fn are_affine(&self) -> bool {
        let is_affine = Cell::new(true);
        let look = |x: &[f64]| {
            let bend = if self.difference.side == 0.0 { x[1] + x[2] - 2.0 * x[0] } else { x[2] + x[0] - 2.0 * x[1] };
            is_affine.set(is_affine.get() && bend.abs() <= ROUNDING * (x[0].abs() + x[1].abs() + x[2].abs()));
            0.0
        };
        let models: Vec<&DynamicsModel<f64>> = self.scenes.iter().map(|at| &*at.scene.model).collect();
        let _ = DynamicsModel::<D>::differentiated(&models, &look);
        let initial = |at: &Loaded| {
            let State { q, v, rotors, .. } = &at.scene.initial;
            [&q[..], v, rotors].concat()
        };
        let states: Vec<Vec<f64>> = self.scenes.iter().map(initial).collect();
        for k in 0..states[0].len() {
            look(&[states[0][k], states[1][k], states[2][k]]);
        }
        let commands = |at: &Loaded| at.scene.commands.clone();
        is_affine.get() && commands(&self.scenes[0]) == commands(&self.scenes[1])
    }

    fn lift(&self, pick: impl Fn(&Loaded) -> f64) -> D {
        let values: Vec<f64> = self.scenes.iter().map(pick).collect();
        let is_constant = values.iter().all(|x| *x == values[0]);
        Dual { value: values[0], partials: [if is_constant { 0.0 } else { self.derivative(&values) }] }
    }

    /// State at the start of the run; without drives and contacts that switch it is that of the scene.
    fn initial(&self, method: MethodKind) -> State<D> {
        let states: Vec<State<f64>> =
            self.scenes.iter().map(|at| world_of(&at.scene, &at.experiment, method, false).state.clone()).collect();
        let mut state = constant_state(&states[0]);
        let lift = |to: &mut [D], pick: &dyn Fn(&State<f64>) -> &[f64]| {
            for (k, x) in to.iter_mut().enumerate() {
                let values: Vec<f64> = states.iter().map(|state| pick(state)[k]).collect();
                if values.iter().any(|value| *value != values[0]) {
                    x.partials = [self.derivative(&values)];
                }
            }
        };
        lift(&mut state.q, &|s| &s.q);
        lift(&mut state.v, &|s| &s.v);
        lift(&mut state.rotors, &|s| &s.rotors);
        lift(&mut state.commands, &|s| &s.commands);
        state
    }
}

/// Start of a part of a run: the state at a tick, and the entry of it that is differentiated by.
pub(super) struct Start<'a> {
    /// Tick at which the part begins.
    pub tick: u64,
    /// Coordinates, velocities, states of rotors there; `None`: the state of the scene.
    pub state: Option<&'a [f64]>,
    /// Entry of `state` that is differentiated by, in place of the unknown.
    pub direction: Option<usize>,
}

impl Start<'_> {
    /// The start of the whole run.
    pub const OF_RUN: Start<'static> = Start { tick: 0, state: None, direction: None };

    /// Puts the state in place of that of the scene.
    fn put(&self, into: &mut State<D>) {
        let Some(state) = self.state else { return };
        let all = into.q.iter_mut().chain(&mut into.v).chain(&mut into.rotors);
        for (k, (to, from)) in all.zip(state).enumerate() {
            *to = Dual { value: *from, partials: [if self.direction == Some(k) { 1.0 } else { 0.0 }] };
        }
        into.tick = self.tick;
    }
}

/// Rows of a run on dual numbers.
pub(super) struct Rows {
    /// Times of the ticks `[s]`, the first included.
    pub times: Vec<f64>,
    /// Value of each signal at each of them.
    pub signals: Vec<Vec<D>>,
    /// Coordinates, velocities, states of rotors at the end.
    pub end: Vec<D>,
}

/// Run on dual numbers over `n_ticks` base steps, with the values of `signals` at each tick.
///
/// # Errors
///
/// The reason why the run cannot go on.
pub(super) fn run(around: &Neighbours, start: &Start<'_>, signals: &[String], n_ticks: usize) -> Result<Rows, String> {
    let mut run = DualRun::new(around, start, signals)?;
    let mut rows = Vec::with_capacity(n_ticks + 1);
    let mut times = Vec::with_capacity(n_ticks + 1);
    for tick in 0..=n_ticks {
        if tick > 0 {
            run.advance()?;
        }
        times.push(run.t());
        rows.push(run.observe());
    }
    let State { q, v, rotors, .. } = &run.world.state;
    Ok(Rows { times, signals: rows, end: [&q[..], v, rotors].concat() })
}

/// The lock-step on dual numbers.
struct DualRun<'a> {
    around: &'a Neighbours,
    world: TangentWorld,
    control: Option<DiagramController<D>>,
    probes: Vec<Probe>,
    impulses: Vec<D>,
    zeros: Vec<D>,
    step: f64,
    first: u64,
    tick: u64,
}

impl<'a> DualRun<'a> {
    fn new(around: &'a Neighbours, start: &Start<'_>, signals: &[String]) -> Result<Self, String> {
        let at = &around.scenes[0];
        let (method, _) = method_for(at);
        let models: Vec<&DynamicsModel<f64>> = around.scenes.iter().map(|scene| &*scene.scene.model).collect();
        let model = DynamicsModel::<D>::differentiated(&models, &|x| around.derivative(x));
        let model = model.map_err(|error| error.to_string())?;
        let step = at.experiment.step;
        let control = at.controller.as_ref().map(|c| DiagramController::<D>::new(&c.wiring, &at.scene.model));
        let is_coupled = |control: &&DiagramController<D>| control.is_continuous();
        let n_coupled = control.as_ref().filter(is_coupled).map_or(0, |c| c.runner.state.continuous.len());
        let method = (method, Control::new(at.experiment.accuracy, (step * 0.1).min(1e-3)));
        let mut state = around.initial(method.0);
        start.put(&mut state);
        let (n_v, n_motors) = (model.n_v(), model.motors().len());
        let mut new = Self {
            around,
            world: TangentWorld::new(&at.scene.model, model, state, method, n_coupled),
            control,
            probes: signals.iter().filter_map(|signal| find_probe(at, signal)).collect(),
            impulses: vec![D::constant(0.0); n_motors],
            zeros: vec![D::constant(0.0); n_v],
            step,
            first: start.tick,
            tick: start.tick,
        };
        new.measure();
        Ok(new)
    }

    fn t(&self) -> f64 {
        self.tick as f64 * self.step
    }

    /// Evaluates the blocks that are due.
    fn measure(&mut self) {
        let t = self.t();
        if let Some(control) = &mut self.control {
            control.evaluate_at(&mut self.world.view(t), self.tick);
        }
    }

    /// One base step, in the order of the lock-step.
    fn advance(&mut self) -> Result<(), String> {
        let t = self.t();
        self.impulses.copy_from_slice(&self.world.state.totals[2..]);
        for k in 0..self.world.state.commands.len() {
            self.world.state.commands[k] = self.around.lift(|scene| scene.scene.commands[k].value(t));
        }
        if let Some(control) = &mut self.control {
            control.latch_into(&mut self.world.state.commands, t);
        }
        let made = match self.control.as_mut().filter(|control| control.is_continuous()) {
            Some(control) => self.world.advance(t, self.step, control),
            None => self.world.advance(t, self.step, &mut NoCoupling),
        };
        made.map_err(|stop| stop.to_string())?;
        self.tick += 1;
        let t = self.t();
        if let Some(control) = &mut self.control {
            let mut commands = self.world.state.commands.clone();
            control.evaluate_end(&mut self.world.view(t), &mut commands);
            self.world.state.commands = commands;
        }
        self.measure();
        Ok(())
    }

    /// Values of the signals in the present state.
    fn observe(&mut self) -> Vec<D> {
        let mut row = vec![D::constant(0.0); self.probes.len()];
        let t = self.t();
        if self.probes.iter().any(|probe| needs_kinematics(*probe)) {
            let seen = self.world.view(t);
            kinematics::motions(seen.model, seen.q, seen.v, &self.zeros, seen.scratch);
        }
        let mut missing = false;
        for (k, probe) in self.probes.iter().enumerate() {
            row[k] = match *probe {
                Probe::Signal(signal) => {
                    self.control.as_ref().map_or(D::constant(f64::NAN), |c| c.runner.signals()[signal])
                }
                Probe::Command(command) => self.world.state.commands[command],
                Probe::MotorTorqueMean(_) if self.tick == self.first => D::constant(0.0),
                Probe::MotorTorqueMean(motor) => {
                    (self.world.state.totals[2 + motor] - self.impulses[motor]) / D::constant(self.step)
                }
                probe => {
                    let found = probe::of_state(&View::of(&self.world.view(t)), probe);
                    missing |= found.is_none();
                    found.unwrap_or(D::constant(f64::NAN))
                }
            };
        }
        if missing {
            let z = self.control.as_ref().filter(|c| c.is_continuous()).map(|c| c.runner.state.continuous.clone());
            let mut watch = Watch { probes: &self.probes, row: &mut row, z: z.unwrap_or_default() };
            self.world.evaluate(t, &mut watch);
        }
        row
    }
}

/// Signals that depend on accelerations, read where the equations of motion are evaluated under the commands as they
/// are.
struct Watch<'a> {
    probes: &'a [Probe],
    row: &'a mut [D],
    z: Vec<D>,
}

impl CoupledSystem<D> for Watch<'_> {
    fn states(&mut self) -> &mut [D] {
        &mut self.z
    }

    fn set_time_event(&mut self, _: f64) {}

    fn next_time_event(&self, _: f64) -> f64 {
        f64::INFINITY
    }

    fn find_commands(&mut self, _: &mut StateView<'_, D>, _: &[D], _: &mut [D]) {}

    fn slope(&mut self, seen: &mut StateView<'_, D>, response: MechanismResponse<'_, D>, _: &[D], slope: &mut [D]) {
        slope.fill(D::constant(0.0));
        kinematics::motions(seen.model, seen.q, seen.v, response.accelerations, seen.scratch);
        let view = View::of(seen);
        for (value, probe) in self.row.iter_mut().zip(self.probes) {
            if value.value.is_nan() {
                *value = probe::of_response(&view, response, *probe).unwrap_or(*value);
            }
        }
    }

    fn negated_jacobian_diagonal(&mut self, diagonal: &mut [D]) {
        diagonal.fill(D::constant(0.0));
    }
}
