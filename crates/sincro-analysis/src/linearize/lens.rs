//! The equations of motion as one function, on any numbers: (x, u) → (ẋ, y).

use sincro_blocks::instance::Number;
use sincro_dynamics::actuation::MotorMode;
use sincro_dynamics::actuation::drive::DriveKind;
use sincro_dynamics::constraint::ActiveSource;
use sincro_dynamics::coupled::{CompiledNumber, Coupled, CoupledSystem, MechanismResponse, StateView};
use sincro_dynamics::integrate::System;
use sincro_dynamics::kinematics;
use sincro_dynamics::mechanism::Mechanism;
use sincro_dynamics::model::Model;
use sincro_dynamics::state::{State, displace};
use sincro_math::Dual;

use super::axis;
use super::names::{InputKind, Names, Output};
use crate::linear::Axis;
use sincro_scene::record::{Probe, RotorQuantity, WindingQuantity, catalogue, probe};
use sincro_sim::diagram_controller::DiagramController;
use sincro_sim::load::Loaded;
use sincro_sim::run::LockStep;

/// A scene at an operating point.
///
/// Its *full* state is (δ, v, r, z): displacements and velocities of all degrees of freedom of the tree, states of
/// rotors, continuous states of the diagram. What constraints leave of it is found by [`super::reduction`].
pub(super) struct Lens<R: Number> {
    mechanism: Mechanism<R>,
    watch: LoopSystem<R>,
    state: State<f64>,
    inputs: Vec<InputKind>,
    commands: Vec<f64>,
    signals: Vec<f64>,
    /// Place in y of each full state.
    places: Vec<usize>,
    axes: Vec<Axis>,
    values: Vec<f64>,
    /// Locked degrees of freedom and what holds each.
    locks: Vec<Lock>,
    /// Full states that rest at an end of their range, where they were last evaluated: activations.
    stopped: Vec<usize>,
    /// Full states that may leave the end of their range: the rate out of it is as without range.
    released: Vec<usize>,
    t: f64,
    y: Vec<R>,
    slope: Vec<R>,
    decay: Vec<R>,
    own: usize,
}

/// A locked degree of freedom.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Lock {
    pub dof: usize,
    /// Index of the drive that gives the velocity.
    pub drive: usize,
    /// True if its position is held, too: by friction, by a motor that is no input.
    pub holds_position: bool,
}

/// Equation that holds at the operating point.
#[derive(Clone, Copy, Debug)]
pub(super) struct Equation<R> {
    pub source: EquationSource,
    /// Position residual of a holonomic constraint.
    pub residual: Option<R>,
    /// Velocity residual.
    pub rate: R,
}

/// Source of an equation.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum EquationSource {
    Constraint(ActiveSource),
    Drive(usize),
}

/// Values at a state: rates of the full states, outputs, equations that hold.
#[derive(Clone, Debug)]
pub(super) struct Evaluation<R> {
    pub rates: Vec<R>,
    pub outputs: Vec<R>,
    pub equations: Vec<Equation<R>>,
}

/// The diagram, if it is in the loop, and the outputs that are read along the way.
struct LoopSystem<R: Number> {
    control: Option<DiagramController<R>>,
    perturbed: Option<(usize, R)>,
    outputs: Vec<Output>,
    values: Vec<R>,
    zero: Vec<R>,
}

impl<R: Number + CompiledNumber> Lens<R> {
    /// At the state that `at` is in, its modes settled ([`super::point::settle`]).
    pub fn new(loaded: &Loaded, at: &mut LockStep, names: &Names) -> Self {
        let model = loaded.scene.model.clone();
        let cast = Model::<R>::pack(&[at.world().model()]).expect("one model has one structure");
        let mut mechanism = Mechanism::new(cast, true);
        mechanism.take_constraint_modes(at.world().mechanism());
        let control = at.control().filter(|_| names.is_closed).map(|c| DiagramController::<R>::cast_from(c, &model));
        let z: Vec<f64> = if names.is_closed {
            at.control().map_or(Vec::new(), |c| c.runner.state.continuous.clone())
        } else {
            Vec::new()
        };
        let state = at.state().clone();
        let (n_v, own, n_rotors) = (model.n_v(), mechanism.dim(), model.n_rotor_states());
        mechanism.drives = state.drives.iter().map(|x| R::splat(*x)).collect();
        mechanism.mark_locked();
        let places: Vec<usize> = (0..2 * n_v).chain(own - n_rotors..own + z.len()).collect();
        let (axes, values) = describe(loaded, at, &state, &z);
        let signals = at.control().map_or(Vec::new(), |c| c.runner.state.signals.clone());
        Self {
            watch: LoopSystem {
                control,
                perturbed: None,
                outputs: names.outputs.clone(),
                values: vec![R::zero(); names.outputs.len()],
                zero: vec![R::zero(); n_v],
            },
            inputs: names.inputs.iter().map(|i| i.what).collect(),
            commands: state.commands.clone(),
            signals,
            axes,
            values,
            places,
            locks: locks(at, names),
            stopped: Vec::new(),
            released: Vec::new(),
            t: at.t(),
            y: vec![R::zero(); own + z.len()],
            slope: vec![R::zero(); own + z.len()],
            decay: vec![R::zero(); z.len()],
            own,
            mechanism,
            state,
        }
    }

    /// Number of full states.
    pub fn n_full(&self) -> usize {
        self.places.len()
    }

    /// Degrees of freedom of the tree.
    pub fn n_v(&self) -> usize {
        self.watch.zero.len()
    }

    /// Number of inputs.
    pub fn n_inputs(&self) -> usize {
        self.inputs.len()
    }

    /// Names and units of the full states.
    pub fn axes(&self) -> &[Axis] {
        &self.axes
    }

    /// Values of the full states.
    pub fn values(&self) -> &[f64] {
        &self.values
    }

    /// Locked degrees of freedom.
    pub fn locks(&self) -> &[Lock] {
        &self.locks
    }

    /// Lets velocities that motors give be states.
    pub fn release_motors(&mut self) {
        let drives = self.mechanism.model().drives();
        self.locks.retain(|lock| !matches!(drives[lock.drive].kind, DriveKind::Motor(_)));
    }

    /// Lets velocity motors and friction hold positions as they would, or none at all.
    pub fn hold_positions(&mut self, holds: bool) {
        let drives = self.mechanism.model().drives();
        let keeps = |lock: &Lock| holds || drives[lock.drive].kind == DriveKind::Lock;
        self.locks.iter_mut().for_each(|lock| lock.holds_position &= keeps(lock));
    }

    /// Values of the inputs.
    pub fn input_values(&self) -> Vec<f64> {
        let value = |input: &InputKind| match *input {
            InputKind::Command(m) => self.commands[m],
            InputKind::Signal(k) => self.signals[k],
        };
        self.inputs.iter().map(value).collect()
    }

    /// Evaluates at the full states and inputs changed by `change`; with `prescribed` the acceleration of that locked
    /// degree of freedom is given, too.
    pub fn evaluate(&mut self, change: &[R], prescribed: Option<(usize, R)>) -> Evaluation<R> {
        let cast = |list: &[f64]| list.iter().map(|x| R::splat(*x)).collect::<Vec<R>>();
        let n_v = self.n_v();
        // a chart is laid at the operating point, and the displacement stays in it
        let x = State {
            q: cast(&self.state.q),
            v: cast(&self.state.v),
            commands: cast(&self.commands),
            drives: cast(&self.state.drives),
            contacts: cast(&self.state.contacts),
            totals: cast(&self.state.totals),
            rotors: cast(&self.state.rotors),
            tick: self.state.tick,
        };
        self.mechanism.load(&x, &mut self.y);
        self.mechanism.mark_locked();
        let z = self.values[self.places.iter().filter(|&&p| p < self.own).count()..].iter();
        for (y, z) in self.y[self.own..].iter_mut().zip(z) {
            *y = R::splat(*z);
        }
        self.watch.perturbed = None;
        for (&place, by) in self.places.iter().zip(change) {
            self.y[place] += *by;
        }
        let n_full = self.n_full();
        for (input, by) in self.inputs.iter().zip(&change[n_full..]) {
            match *input {
                InputKind::Command(m) => self.mechanism.commands[m] += *by,
                InputKind::Signal(signal) => self.watch.perturb(signal, *by, &self.signals),
            }
        }
        let of_drives = self.lock_equations();
        for (lock, equation) in self.locks.iter().zip(&of_drives) {
            self.mechanism.prescribe_acceleration(lock.dof, equation.1);
        }
        if let Some((dof, acceleration)) = prescribed {
            self.mechanism.prescribe_acceleration(dof, acceleration);
        }
        let mut coupled = Coupled {
            mechanism: &mut self.mechanism,
            system: &mut self.watch as &mut dyn CoupledSystem<R>,
            negated_jacobian_diagonal: &mut self.decay,
        };
        R::evaluate(&mut coupled, self.t, &self.y, &mut self.slope);
        self.stop_activations();
        let of_mechanism = self.mechanism.active_constraints(&self.y[n_v..2 * n_v]);
        let equations = of_mechanism.into_iter().map(|row| Equation {
            source: EquationSource::Constraint(row.source),
            residual: row.residual,
            rate: row.rate,
        });
        let equations = equations.chain(of_drives.into_iter().map(|(equation, _)| equation)).collect();
        self.watch.restore(&self.signals);
        Evaluation {
            rates: self.places.iter().map(|&p| self.slope[p]).collect(),
            outputs: self.watch.values.clone(),
            equations,
        }
    }

    /// Full states that rest at an end of their range where they were last evaluated: activations.
    pub fn stopped(&self) -> &[usize] {
        &self.stopped
    }

    /// Lets these full states, and no others, have rates that lead out of their ranges.
    pub fn release(&mut self, states: &[usize]) {
        self.released = states.to_vec();
    }

    /// Stops activations at the ends of their ranges, as the dynamics does, but for those that are released.
    fn stop_activations(&mut self) {
        let states = self.mechanism.layout().rotor_states();
        let free: Vec<(usize, R)> =
            self.released.iter().map(|k| (self.places[*k], self.slope[self.places[*k]])).collect();
        let driven: Vec<bool> = self.slope[states.clone()].iter().map(|rate| rate.lane(0) != 0.0).collect();
        self.mechanism.model().stop_activations(&self.y[states.clone()], &mut self.slope[states.clone()]);
        free.into_iter().for_each(|(place, rate)| self.slope[place] = rate);
        let is_stopped = |place: usize| {
            let state = place.checked_sub(states.start).filter(|state| *state < driven.len());
            state.is_some_and(|state| driven[state] && self.slope[place].lane(0) == 0.0)
        };
        self.stopped = (0..self.places.len()).filter(|k| is_stopped(self.places[*k])).collect();
    }

    /// Equations of the locked degrees of freedom at y, with the acceleration that each prescribes.
    fn lock_equations(&self) -> Vec<(Equation<R>, R)> {
        let n_v = self.n_v();
        let model = self.mechanism.model();
        let of = |lock: &Lock| {
            let v = self.y[n_v + lock.dof];
            let drive = &model.drives()[lock.drive];
            let (mut target, mut acceleration) = (R::zero(), R::zero());
            if let DriveKind::Motor(id) = drive.kind {
                let motor = model.motor(id);
                let displacement = self.y[lock.dof];
                let q = model.dofs()[lock.dof].coordinate().map_or(R::zero(), |k| R::splat(self.state.q[k]));
                let command = self.mechanism.commands[id.index()];
                // a position motor that is held keeps its velocity
                let q = if lock.holds_position { q } else { q + displacement };
                target = motor.target_velocity(q, command);
                let is_position = motor.mode == MotorMode::Position && !lock.holds_position;
                let follows = is_position && target.lane(0).abs() < motor.max_velocity.lane(0);
                acceleration = if follows { -(motor.kp * v) } else { R::zero() };
            }
            let equation = Equation {
                source: EquationSource::Drive(lock.drive),
                residual: lock.holds_position.then_some(self.y[lock.dof]),
                rate: v - target,
            };
            (equation, acceleration)
        };
        self.locks.iter().map(of).collect()
    }
}

/// Locked degrees of freedom: a motor governs before friction.
fn locks(at: &mut LockStep, names: &Names) -> Vec<Lock> {
    let drives = at.state().drives.clone();
    let model = at.world().model();
    let mut locks: Vec<Lock> = Vec::new();
    for (i, drive) in model.drives().iter().enumerate().filter(|(i, _)| drives[*i] == 0.0) {
        let holds_position = match drive.kind {
            DriveKind::Friction | DriveKind::Lock => true,
            DriveKind::Motor(id) => {
                let is_input = names.inputs.iter().any(|input| input.what == InputKind::Command(id.index()));
                !is_input && (names.holds_motors || model.motor(id).mode == MotorMode::Velocity)
            }
        };
        let lock = Lock { dof: drive.dof, drive: i, holds_position };
        match locks.iter_mut().find(|lock| lock.dof == drive.dof) {
            Some(known) => *known = lock,
            None => locks.push(lock),
        }
    }
    locks
}

impl Lens<Dual<1>> {
    /// Evaluates with the derivative along a direction of the full states and inputs.
    pub fn along(&mut self, direction: &[f64]) -> Evaluation<Dual<1>> {
        let change: Vec<Dual<1>> = direction.iter().map(|d| Dual { value: 0.0, partials: [*d] }).collect();
        self.evaluate(&change, None)
    }

    /// Response of all rates to the acceleration of a locked degree of freedom, and that of the outputs.
    pub fn response_to(&mut self, dof: usize) -> (Vec<f64>, Vec<f64>) {
        let change = vec![Dual::constant(0.0); self.n_full() + self.n_inputs()];
        let found = self.evaluate(&change, Some((dof, Dual::variable(0.0, 0))));
        let partial = |list: &[Dual<1>]| list.iter().map(|x| x.partials[0]).collect();
        (partial(&found.rates), partial(&found.outputs))
    }
}

impl Lens<f64> {
    /// The state that a displacement of the full states leads to.
    pub fn displaced(&self, change: &[f64]) -> (State<f64>, Vec<f64>) {
        let n_v = self.n_v();
        let mut state = self.state.clone();
        displace(self.mechanism.model(), &self.state.q, &change[..n_v], &mut state.q);
        let mut z = Vec::new();
        for (k, &place) in self.places.iter().enumerate().skip(n_v) {
            if place < 2 * n_v {
                state.v[place - n_v] += change[k];
            } else if place < self.own {
                state.rotors[place - self.mechanism.layout().rotor_states().start] += change[k];
            } else {
                z.push(self.values[k] + change[k]);
            }
        }
        for activation in self.mechanism.model().activations() {
            let own = &mut state.rotors[activation.state];
            *own = activation.saturated(*own);
        }
        for (k, input) in self.inputs.iter().enumerate() {
            if let InputKind::Command(m) = *input {
                state.commands[m] += change[self.places.len() + k];
            }
        }
        (state, z)
    }
}

impl<R: Number> LoopSystem<R> {
    /// Something is added to a signal: at once if it is held, as soon as it is known if it is evaluated.
    fn perturb(&mut self, signal: usize, by: R, signals: &[f64]) {
        use sincro_blocks::program::Rate;
        let Some(control) = &mut self.control else { return };
        let steps = &control.wiring().program().steps;
        let is_continuous = steps.iter().any(|s| s.out.contains(&signal) && s.rate == Rate::Continuous);
        if is_continuous {
            self.perturbed = Some((signal, self.perturbed.filter(|p| p.0 == signal).map_or(by, |p| p.1 + by)));
        } else {
            control.runner.signals_mut()[signal] = R::splat(signals[signal]) + by;
        }
    }

    /// Held signals as they were.
    fn restore(&mut self, signals: &[f64]) {
        if let Some(control) = &mut self.control {
            for (now, then) in control.runner.signals_mut().iter_mut().zip(signals) {
                *now = R::splat(*then);
            }
        }
    }
}

impl<R: Number> CoupledSystem<R> for LoopSystem<R> {
    fn states(&mut self) -> &mut [R] {
        self.control.as_mut().map_or(&mut [], |c| c.states())
    }

    fn set_time_event(&mut self, _: f64) {}

    fn next_time_event(&self, _: f64) -> f64 {
        f64::INFINITY
    }

    fn find_commands(&mut self, seen: &mut StateView<'_, R>, z: &[R], commands: &mut [R]) {
        if let Some(control) = &mut self.control {
            control.find_all_commands(seen, z, commands, self.perturbed);
            // sampled commands are part of the operating point, with whatever was added to them
            for command in &control.wiring().program().commands {
                if !command.is_continuous {
                    commands[command.terminal] = control.runner.signals()[command.signal.start];
                }
            }
        }
    }

    fn slope(&mut self, seen: &mut StateView<'_, R>, response: MechanismResponse<'_, R>, _: &[R], slope: &mut [R]) {
        if let Some(control) = &mut self.control {
            control.all_derivatives(seen, response, slope, self.perturbed);
        }
        kinematics::motions(seen.model, seen.q, seen.v, response.accelerations, seen.scratch);
        let view = probe::View::of(seen);
        for (value, output) in self.values.iter_mut().zip(&self.outputs) {
            *value = match output.probe {
                Probe::Signal(k) => self.control.as_ref().map_or(R::zero(), |c| c.runner.signals()[k]),
                other => probe::of_state(&view, other)
                    .or_else(|| probe::of_response(&view, response, other))
                    .unwrap_or(R::zero()),
            };
        }
    }

    fn negated_jacobian_diagonal(&mut self, _: &mut [R]) {}
}

/// Names, units and values of displacements, velocities, states of rotors and continuous states of the diagram.
fn describe(loaded: &Loaded, at: &LockStep, state: &State<f64>, z: &[f64]) -> (Vec<Axis>, Vec<f64>) {
    let model = &loaded.scene.model;
    let entries = catalogue(model);
    let named = |probe: Probe| entries.iter().find(|e| e.probe == probe);
    let (mut axes, mut values) = (Vec::new(), Vec::new());
    for (k, dof) in model.dofs().iter().enumerate() {
        let coordinate = dof.coordinate().filter(|_| model.has_scalar_coordinate(k));
        match (coordinate.and_then(|q| named(Probe::Coordinate(q))), named(Probe::Rate(k))) {
            (Some(entry), _) => axes.push(axis(&entry.name, &*entry.unit)),
            (None, rate) => {
                let (name, unit) = rate.map_or((String::new(), ""), |e| (e.name.clone(), &*e.unit));
                let name = name.replace("angular_velocity", "rotation").replace("velocity", "displacement");
                axes.push(axis(name, unit.trim_end_matches("/s")));
            }
        }
        values.push(coordinate.map_or(0.0, |q| state.q[q]));
    }
    for k in 0..model.n_v() {
        let rate = named(Probe::Rate(k));
        axes.push(rate.map_or_else(|| axis(format!("v[{k}]"), ""), |e| axis(&e.name, &*e.unit)));
        values.push(state.v[k]);
    }
    for rotor in 0..model.rotors().len() {
        let Some(k) = model.rotors()[rotor].speed.state() else { continue };
        let speed = named(Probe::Rotor(RotorQuantity::Speed, rotor));
        // of a stock propeller it is what is thrown during a tick: constant
        axes.push(speed.map_or_else(
            || axis(format!("{}.flow", model.names().rotors[rotor]), "kg/s"),
            |e| axis(&e.name, &*e.unit),
        ));
        values.push(state.rotors[k]);
    }
    for (winding, mounted) in model.windings().iter().enumerate() {
        let Some(k) = mounted.state else { continue };
        let current = named(Probe::Winding(WindingQuantity::Current, winding));
        axes.push(current.map_or_else(|| axis(format!("current[{winding}]"), "A"), |e| axis(&e.name, &*e.unit)));
        values.push(state.rotors[k]);
    }
    for (k, activation) in model.activations().iter().enumerate() {
        let own = named(Probe::Activation(k));
        axes.push(own.map_or_else(|| axis(format!("activation[{k}]"), ""), |e| axis(&e.name, &*e.unit)));
        values.push(state.rotors[activation.state]);
    }
    if let Some(control) = at.control() {
        for step in control.wiring().program().steps.iter().filter(|_| !z.is_empty()) {
            for k in step.states.clone() {
                let name = match step.states.len() {
                    1 => step.path.clone(),
                    _ => format!("{}.x{}", step.path, k - step.states.start + 1),
                };
                axes.push(axis(name, ""));
                values.push(z[k]);
            }
        }
    }
    (axes, values)
}
