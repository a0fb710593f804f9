//! Equations of motion of a scene that does not switch, with the continuous blocks of its diagram, on any kind of
//! number: plain ones for an importer that integrates, dual numbers for derivatives.
//!
//! Notation: x = (q, v, r, z): coordinates, velocities, speeds of rotors with a lag, currents of windings and
//! activations, states of continuous blocks. Quaternions are four states with q̇ = ½ q ω; whatever their length, the
//! pose is that of the unit quaternion.

use sincro_blocks::instance::Number;
use sincro_dynamics::coupled::{CompiledNumber, Coupled, CoupledSystem, MechanismResponse, StateView};
use sincro_dynamics::integrate::System;
use sincro_dynamics::joint::JointKind;
use sincro_dynamics::kinematics;
use sincro_dynamics::mechanism::Mechanism;
use sincro_dynamics::model::Model;
use sincro_dynamics::spatial::{Quat, Vec3};
use sincro_dynamics::state::State;
use sincro_scene::record::Probe;
use sincro_scene::record::probe::{self, View, needs_kinematics};
use sincro_sim::diagram_controller::DiagramController;

/// Equations of a scene at one instant: x ↦ ẋ.
#[derive(Debug)]
pub(super) struct Equations<R: Number> {
    /// Mechanism, with the commands that it was last evaluated with.
    pub mechanism: Mechanism<R>,
    /// State of the mechanism that was last placed, its quaternions of length one.
    pub state: State<R>,
    z: Vec<R>,
    /// Quaternions: place in q, place of their angular velocity in v.
    quaternions: Vec<(usize, usize)>,
    /// Joints that are free: place in q, place in v. Their velocities are in their own axes.
    free: Vec<(usize, usize)>,
    y: Vec<R>,
    slope: Vec<R>,
    diagonal: Vec<R>,
}

impl<R: Number + CompiledNumber> Equations<R> {
    /// Equations of a model whose modes and memory are those of `at`, with `n_z` states of continuous blocks.
    pub(super) fn new(model: Model<R>, at: &State<f64>, n_z: usize) -> Self {
        let joints = &model.names().joints;
        let quaternion = |kind: JointKind, q: usize, v: usize| match kind {
            JointKind::Ball => Some((q, v)),
            JointKind::Free => Some((q + 3, v)),
            _ => None,
        };
        let quaternions = joints.iter().filter_map(|j| quaternion(j.kind, j.q_idx, j.v_idx)).collect();
        let free = joints.iter().filter(|j| matches!(j.kind, JointKind::Free)).map(|j| (j.q_idx, j.v_idx)).collect();
        let mechanism = Mechanism::new(model, true);
        let dim = mechanism.dim() + n_z;
        Self {
            mechanism,
            state: cast_state(at),
            z: vec![R::zero(); n_z],
            quaternions,
            free,
            y: vec![R::zero(); dim],
            slope: vec![R::zero(); dim],
            diagonal: vec![R::zero(); n_z],
        }
    }

    /// Places the mechanism and the states of the diagram at `x`, under `commands`.
    pub(super) fn place(&mut self, x: &[R], commands: &[R]) {
        let state = &mut self.state;
        let (q, rest) = x.split_at(state.q.len());
        let (v, rest) = rest.split_at(state.v.len());
        let (rotors, z) = rest.split_at(state.rotors.len());
        state.q.copy_from_slice(q);
        state.v.copy_from_slice(v);
        state.rotors.copy_from_slice(rotors);
        for &(at, _) in &self.quaternions {
            let unit = Quat::from_slice(&q[at..at + 4]).normalized();
            unit.write(&mut state.q[at..at + 4]);
        }
        state.commands.copy_from_slice(commands);
        self.z.copy_from_slice(z);
    }

    /// States of the diagram that were last placed.
    pub(super) fn diagram_states(&self) -> &[R] {
        &self.z
    }

    /// Evaluates the equations at time `t` `[s]` where they were placed, with `system` in the loop.
    pub(super) fn evaluate(&mut self, t: f64, system: &mut dyn CoupledSystem<R>) {
        self.mechanism.load(&self.state, &mut self.y);
        self.mechanism.mark_locked();
        let own = self.mechanism.dim();
        self.y[own..].copy_from_slice(&self.z);
        let (mechanism, negated_jacobian_diagonal) = (&mut self.mechanism, &mut self.diagonal[..]);
        let mut coupled = Coupled { mechanism, system, negated_jacobian_diagonal };
        R::evaluate(&mut coupled, t, &self.y, &mut self.slope);
        let states = self.mechanism.layout().rotor_states();
        self.mechanism.model().stop_activations(&self.y[states.clone()], &mut self.slope[states]);
    }

    /// Writes ẋ, as it was last evaluated, at the states `x` that were placed.
    pub(super) fn derivatives(&self, x: &[R], out: &mut [R]) {
        let (n_q, n_v) = (self.state.q.len(), self.state.v.len());
        let own = self.mechanism.dim();
        let (q, v) = (&x[..n_q], &x[n_q..n_q + n_v]);
        let rotors = self.mechanism.layout().rotor_states();
        if self.quaternions.is_empty() {
            out[..n_q].copy_from_slice(v);
        } else {
            self.rates_of_coordinates(q, v, &mut out[..n_q]);
        }
        out[n_q..n_q + n_v].copy_from_slice(&self.slope[n_v..2 * n_v]);
        let n_rotors = rotors.len();
        out[n_q + n_v..n_q + n_v + n_rotors].copy_from_slice(&self.slope[rotors]);
        out[n_q + n_v + n_rotors..].copy_from_slice(&self.slope[own..]);
    }

    /// q̇ of a scene with quaternions.
    fn rates_of_coordinates(&self, q: &[R], v: &[R], out: &mut [R]) {
        for joint in &self.mechanism.model().names().joints {
            let (at, from) = (joint.q_idx, joint.v_idx);
            if !matches!(joint.kind, JointKind::Ball | JointKind::Free) {
                out[at..at + joint.n_v].copy_from_slice(&v[from..from + joint.n_v]);
            }
        }
        let half = R::splat(0.5);
        for &(at, from) in &self.quaternions {
            // q̇ = ½ q (0, ω), ω in the axes of the child
            let ([w, x, y, z], [p, r, s]) =
                ([q[at], q[at + 1], q[at + 2], q[at + 3]], [v[from], v[from + 1], v[from + 2]]);
            out[at] = half * (-x * p - y * r - z * s);
            out[at + 1] = half * (w * p + y * s - z * r);
            out[at + 2] = half * (w * r - x * s + z * p);
            out[at + 3] = half * (w * s + x * r - y * p);
        }
        for &(at, from) in &self.free {
            let rotation = Quat::from_slice(&q[at + 3..at + 7]).normalized().matrix();
            let velocity = rotation.mul_vec(Vec3([v[from + 3], v[from + 4], v[from + 5]]));
            out[at..at + 3].copy_from_slice(&velocity.0);
        }
    }
}

/// The same state in another kind of number, without derivatives.
fn cast_state<R: Number>(at: &State<f64>) -> State<R> {
    let cast = |list: &[f64]| list.iter().map(|x| R::splat(*x)).collect::<Vec<R>>();
    State {
        q: cast(&at.q),
        v: cast(&at.v),
        commands: cast(&at.commands),
        drives: cast(&at.drives),
        contacts: cast(&at.contacts),
        totals: cast(&at.totals),
        rotors: cast(&at.rotors),
        tick: at.tick,
    }
}

/// Diagram in the loop, of which all continuous blocks are evaluated, also those that the derivatives do not need, and
/// outputs of the scene, which are read on the way.
pub(super) struct Watch<'a, R: Number> {
    /// The diagram, if there is one.
    pub control: Option<&'a mut DiagramController<R>>,
    /// Outputs to be read.
    pub probes: &'a [Probe],
    /// Their values; none for what is no function of state and commands on this kind of number.
    pub values: &'a mut [Option<R>],
}

impl<R: Number> CoupledSystem<R> for Watch<'_, R> {
    fn states(&mut self) -> &mut [R] {
        self.control.as_mut().map_or(&mut [], |control| control.states())
    }

    fn set_time_event(&mut self, _: f64) {}

    fn next_time_event(&self, _: f64) -> f64 {
        f64::INFINITY
    }

    fn find_commands(&mut self, seen: &mut StateView<'_, R>, z: &[R], commands: &mut [R]) {
        if let Some(control) = &mut self.control {
            control.find_all_commands(seen, z, commands, None);
        }
    }

    fn slope(&mut self, seen: &mut StateView<'_, R>, response: MechanismResponse<'_, R>, _: &[R], slope: &mut [R]) {
        if let Some(control) = &mut self.control {
            control.all_derivatives(seen, response, slope, None);
        }
        if self.probes.iter().any(|probe| needs_kinematics(*probe)) {
            kinematics::motions(seen.model, seen.q, seen.v, response.accelerations, seen.scratch);
        }
        let view = View::of(seen);
        for (value, probe) in self.values.iter_mut().zip(self.probes) {
            *value = match *probe {
                Probe::Signal(k) => self.control.as_ref().map(|control| control.runner.signals()[k]),
                Probe::Command(k) => Some(view.commands[k]),
                Probe::MotorTorqueMean(k) => Some(response.motor_torque[k]),
                other => probe::of_state(&view, other).or_else(|| probe::of_response(&view, response, other)),
            };
        }
    }

    fn negated_jacobian_diagonal(&mut self, _: &mut [R]) {}
}
