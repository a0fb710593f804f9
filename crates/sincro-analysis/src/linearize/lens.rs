//! The equations of motion as one function, on any numbers: (x, u) → (ẋ, y).

use sincro_blocks::instance::Number;
use sincro_dynamics::coupled::{Coupled, CoupledSystem, MechanismResponse, StateView};
use sincro_dynamics::integrate::System;
use sincro_dynamics::kinematics;
use sincro_dynamics::mechanism::Mechanism;
use sincro_dynamics::model::Model;
use sincro_dynamics::state::{State, displace};
use sincro_math::Dual;

use super::axis;
use super::names::{InputKind, Names, Output};
use crate::linear::Axis;
use sincro_scene::record::{Probe, RotorQuantity, catalogue, probe};
use sincro_sim::diagram_controller::DiagramController;
use sincro_sim::load::Loaded;
use sincro_sim::run::LockStep;

/// A scene at an operating point.
pub(super) struct Lens<R: Number> {
    mechanism: Mechanism<R>,
    watch: LoopSystem<R>,
    state: State<f64>,
    inputs: Vec<InputKind>,
    commands: Vec<f64>,
    signals: Vec<f64>,
    /// Places in y of the states: held degrees of freedom have no velocity among them.
    places: Vec<usize>,
    axes: Vec<Axis>,
    values: Vec<f64>,
    t: f64,
    y: Vec<R>,
    slope: Vec<R>,
    decay: Vec<R>,
    rates: Vec<R>,
    own: usize,
}

/// The diagram, if it is in the loop, and the outputs that are read along the way.
struct LoopSystem<R: Number> {
    control: Option<DiagramController<R>>,
    perturbed: Option<(usize, R)>,
    outputs: Vec<Output>,
    values: Vec<R>,
    zero: Vec<R>,
}

impl<R: Number> Lens<R> {
    pub fn new(loaded: &Loaded, at: &LockStep, names: &Names) -> Self {
        let model = &loaded.scene.model;
        let cast = Model::<R>::pack(&[&**model]).expect("one model has one structure");
        let mut mechanism = Mechanism::new(cast, true);
        let control = at.control().filter(|_| names.is_closed).map(|c| DiagramController::<R>::like(c, model));
        let z: Vec<f64> = if names.is_closed {
            at.control().map_or(Vec::new(), |c| c.runner.state.continuous.clone())
        } else {
            Vec::new()
        };
        let state = at.state().clone();
        let (n_v, own, n_rotors) = (model.n_v(), mechanism.dim(), model.n_rotor_states());
        mechanism.drives = state.drives.iter().map(|x| R::splat(*x)).collect();
        mechanism.mark_locked();
        let places: Vec<usize> = (0..n_v)
            .chain((0..n_v).filter(|&k| !mechanism.is_locked(k) || state.drives.is_empty()).map(|k| n_v + k))
            .chain(own - n_rotors..own + z.len())
            .collect();
        let (all_axes, all_values) = describe(loaded, at, &state, &z);
        let pick = |place: usize| if place < 2 * n_v { place } else { place + n_rotors - own + 2 * n_v };
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
            axes: places.iter().map(|&p| all_axes[pick(p)].clone()).collect(),
            values: places.iter().map(|&p| all_values[pick(p)]).collect(),
            places,
            t: at.t(),
            y: vec![R::zero(); own + z.len()],
            slope: vec![R::zero(); own + z.len()],
            decay: vec![R::zero(); z.len()],
            rates: Vec::new(),
            own,
            mechanism,
            state,
        }
    }

    pub fn n_states(&self) -> usize {
        self.places.len()
    }

    /// Number of velocities among the states.
    pub fn n_velocities(&self) -> usize {
        let n_v = self.watch.zero.len();
        self.places.iter().filter(|&&p| (n_v..2 * n_v).contains(&p)).count()
    }

    pub fn state_axes(&self) -> Vec<Axis> {
        self.axes.clone()
    }

    pub fn state_values(&self) -> Vec<f64> {
        self.values.clone()
    }

    pub fn input_values(&self) -> Vec<f64> {
        let value = |input: &InputKind| match *input {
            InputKind::Command(m) => self.commands[m],
            InputKind::Signal(k) => self.signals[k],
        };
        self.inputs.iter().map(value).collect()
    }

    /// Rates and outputs with `change[k]` added to state or input `k`.
    fn evaluate_changed(&mut self, change: &[(usize, R)]) -> (&[R], &[R]) {
        let cast = |list: &[f64]| list.iter().map(|x| R::splat(*x)).collect::<Vec<R>>();
        let n_v = self.watch.zero.len();
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
        for &(k, by) in change {
            if k < self.places.len() {
                self.y[self.places[k]] += by;
                continue;
            }
            match self.inputs[k - self.places.len()] {
                InputKind::Command(m) => self.mechanism.commands[m] += by,
                InputKind::Signal(signal) => self.watch.perturb(signal, by, &self.signals),
            }
        }
        debug_assert!(self.y.len() >= 2 * n_v, "displacements and velocities first");
        let mut system = Coupled {
            mechanism: &mut self.mechanism,
            system: &mut self.watch,
            negated_jacobian_diagonal: &mut self.decay,
        };
        system.slope(self.t, &self.y, &mut self.slope);
        self.rates = self.places.iter().map(|&p| self.slope[p]).collect();
        self.watch.restore(&self.signals);
        (&self.rates, &self.watch.values)
    }
}

impl Lens<Dual<1>> {
    /// Rates and outputs with the states and inputs changed by so much, with the derivative by state or input `by`.
    pub fn evaluate_about(&mut self, change: &[f64], by: usize) -> (&[Dual<1>], &[Dual<1>]) {
        let seed = |(k, x): (usize, &f64)| (k, if k == by { Dual::variable(*x, 0) } else { Dual::constant(*x) });
        let change: Vec<(usize, Dual<1>)> = change.iter().enumerate().map(seed).collect();
        self.evaluate_changed(&change)
    }

    /// Rates and outputs, with the derivative by state or input `by`.
    pub fn evaluate(&mut self, by: Option<usize>) -> (&[Dual<1>], &[Dual<1>]) {
        let change: Vec<(usize, Dual<1>)> = by.map(|k| (k, Dual::variable(0.0, 0))).into_iter().collect();
        self.evaluate_changed(&change)
    }
}

impl Lens<f64> {
    /// Rates and outputs with the states and inputs changed by so much.
    pub fn evaluate_at(&mut self, change: &[f64]) -> (&[f64], &[f64]) {
        let change: Vec<(usize, f64)> = change.iter().copied().enumerate().collect();
        self.evaluate_changed(&change)
    }

    /// The state that a displacement leads to: what a run can be started from.
    pub fn displaced(&self, change: &[f64]) -> (State<f64>, Vec<f64>) {
        let n_v = self.watch.zero.len();
        let mut state = self.state.clone();
        displace(self.mechanism.model(), &self.state.q, &change[..n_v], &mut state.q);
        let mut z = Vec::new();
        for (k, &place) in self.places.iter().enumerate().skip(n_v) {
            if place < 2 * n_v {
                state.v[place - n_v] += change[k];
            } else if place < self.own {
                state.rotors[place - self.mechanism.rotor_states().start] += change[k];
            } else {
                z.push(self.values[k] + change[k]);
            }
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
            control.drive_whole(seen, z, commands, self.perturbed);
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
            control.slope_whole(seen, response, slope, self.perturbed);
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
