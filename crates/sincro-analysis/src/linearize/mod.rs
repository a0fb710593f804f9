//! Linearisation and trim of a scene: exact, by dual numbers, no step width to choose.
//!
//! State x = (δ, v, z): displacements of the coordinates about the operating point (for a quaternion the rotation
//! vector in body axes), velocities, continuous states of the diagram. Inputs are commands of motors, or signals of the
//! diagram that something is added to; outputs are any recorded signals. Every column of A and B is one evaluation of
//! the equations of motion with the derivative carried along.
//!
//! The open loop is the world alone, its commands held. The closed loop has the diagram's continuous blocks in it;
//! blocks with a sample time hold what they gave last, as they do between ticks.
//!
//! Closed loops, gears, velocity motors, joints stuck in friction or at a limit and closed contacts are eliminated
//! (`reduction.rs`): the states are independent coordinates and speeds, and what was eliminated is said
//! ([`Linearization::reduction`]).

mod lens;
mod names;
mod open_loop;
mod point;
mod reduction;
mod sampled;
mod trim;
mod unstable_loop;
mod words;

pub use open_loop::{OpenLoop, open_loops, openable_signals};
pub use point::{Request, operating_point};
pub use sampled::{SampledLoop, linearize_sampled};
pub use trim::{Trim, TrimRequest, Trimmed, trim};
pub use unstable_loop::{UnstableLoop, unstable_loop};
pub use words::{ReducedElement, ReducedKind, Reduction};

use sincro_dynamics::initial::constraint_residuals;
use sincro_dynamics::model::Model;
use sincro_dynamics::state::{State, displace};
use sincro_dynamics::world::MethodKind;
use sincro_math::Dual;

use crate::linear::{Axis, DMatrix, StateSpace};
use lens::Lens;
use names::{InputKind, Names};
use reduction::{Equations, Metric, Tangent};
use sincro_scene::diagnostic::{Diagnostic, Diagnostics};
use sincro_sim::load::Loaded;
use sincro_sim::run::LockStep;

/// Linear system of a scene about an operating point, with the values there and a record of how it was reduced; result
/// of [`linearize`].
///
/// ```
/// use sincro_analysis::prelude::*;
/// # use sincro_sim::prelude::*;
///
/// # fn main() -> Result<(), Box<dyn std::error::Error>> {
/// # let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/../../scenes/acrobot");
/// # let loaded = load(folder.as_ref(), &[], Extensions::default())?;
/// // two links, 0.1 rad from hanging: no equilibrium, they begin to fall
/// let start = operating_point(&loaded, 0.0).map_err(Diagnostics::from)?;
/// let found: Linearization = linearize(&loaded, &start, &Request::default())?;
/// assert_eq!((found.system.n_states(), found.system.n_inputs()), (4, 1)); // the motor of the elbow
/// assert_eq!(found.state[..2], [0.1, 0.0]); // [rad]
/// assert!(found.drift() > 0.1 && !found.is_steady());
/// # Ok(())
/// # }
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Linearization {
    /// Linear system, with names and units of its states, inputs and outputs.
    pub system: StateSpace,
    /// Values of the states at the operating point, in the order and units of `system.states`: coordinates themselves,
    /// not displacements.
    pub state: Vec<f64>,
    /// Values of the inputs there, in the order and units of `system.inputs`.
    pub input: Vec<f64>,
    /// Values of the outputs there, in the order and units of `system.outputs`.
    pub output: Vec<f64>,
    /// Rates of the states there, in the order of `system.states` `[unit of the state / s]`; zero at an equilibrium.
    pub rate: Vec<f64>,
    /// Record of the equations and states that were eliminated.
    pub reduction: Reduction,
    /// Warnings about the validity of the numbers, one sentence each; may be empty.
    pub notes: Vec<String>,
}

impl Linearization {
    /// Greatest magnitude among the rates of the states at the operating point `[unit of the state / s]`; 0 at an
    /// equilibrium.
    #[must_use]
    pub fn drift(&self) -> f64 {
        self.rate.iter().fold(0.0_f64, |worst, r| worst.max(r.abs()))
    }

    /// Returns true if no state changes but those on which no other rate depends: a motion at constant rates.
    #[must_use]
    pub fn is_steady(&self) -> bool {
        let moves = |(axis, rate): (&Axis, &f64)| rate.abs() >= 1e-8 && !self.reduction.cyclic.contains(&axis.name);
        !self.system.states.iter().zip(&self.rate).any(moves)
    }
}

/// Linearises a scene at the state that a run is in, with exact derivatives. `at` comes from [`operating_point`] or
/// [`trim`] and is not changed; `request` chooses inputs, outputs, and open or closed loop.
///
/// # Errors
///
/// One diagnostic for each name of `request` that is no input or output, or has no derivative by the state; further for
/// an output that contains the rate of a motor's velocity, and for loops whose equations are dependent at this
/// position.
///
/// ```
/// use sincro_analysis::prelude::*;
/// use sincro_sim::prelude::*;
///
/// # fn main() -> Result<(), Box<dyn std::error::Error>> {
/// let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/../../scenes/double-pendulum");
/// let hanging = [Override::new("/upper.initial.position", "0"), Override::new("/upper/lower.initial.position", "0")];
/// let loaded = load_without_variants(folder.as_ref(), &hanging, Extensions::default())?;
/// let at = operating_point(&loaded, 0.0).map_err(Diagnostics::from)?;
/// let system = linearize(&loaded, &at, &Request::default())?.system;
/// // in phase, the slower mode: ω² = (2 − √2) g/l
/// let slow = system.poles()[0].natural_frequency;
/// assert!((slow - f64::sqrt((2.0 - f64::sqrt(2.0)) * 9.8)).abs() < 1e-6); // [rad/s]
/// # Ok(())
/// # }
/// ```
pub fn linearize(loaded: &Loaded, at: &LockStep, request: &Request) -> Result<Linearization, Diagnostics> {
    let names = names::resolve(loaded, at, request)?;
    linearize_settled(loaded, &mut point::settle(loaded, at, &names), names)
}

/// Linearises at a state that is settled.
fn linearize_settled(loaded: &Loaded, at: &mut LockStep, names: Names) -> Result<Linearization, Diagnostics> {
    let mut lens = Lens::<Dual<1>>::new(loaded, at, &names);
    let equations = Equations::of(&mut lens);
    let kinds: Vec<_> = names.inputs.iter().map(|i| i.what).collect();
    let q = at.state().q.clone();
    let metric = Metric::of(at.world().model(), &q);
    let tangent = Tangent::of(&mut lens, &equations, &metric, &kinds);
    refuse_improper(&tangent, &names)?;
    refuse_open_tangent(at.world().model(), &q, &tangent)?;
    let (n, m, p) = (tangent.states.len(), names.inputs.len(), names.outputs.len());
    let pick = |list: &[f64]| tangent.states.iter().map(|&k| list[k]).collect::<Vec<f64>>();
    let mut system = StateSpace {
        a: DMatrix::zeros(n, n),
        b: DMatrix::zeros(n, m),
        c: DMatrix::zeros(p, n),
        d: DMatrix::zeros(p, m),
        states: tangent.states.iter().map(|&k| lens.axes()[k].clone()).collect(),
        inputs: names.inputs.iter().map(|i| i.axis.clone()).collect(),
        outputs: names.outputs.iter().map(|o| o.axis.clone()).collect(),
        t: at.t(),
        sample_time: None,
    };
    for (k, column) in tangent.columns.iter().enumerate() {
        let found = lens.along(column);
        for (i, &state) in tangent.states.iter().enumerate() {
            let entry = if k < n { &mut system.a[(i, k)] } else { &mut system.b[(i, k - n)] };
            *entry = found.rates[state].partials[0];
        }
        for (i, output) in found.outputs.iter().enumerate() {
            let entry = if k < n { &mut system.c[(i, k)] } else { &mut system.d[(i, k - n)] };
            *entry = output.partials[0];
        }
    }
    let found = lens.along(&vec![0.0; lens.n_full() + m]);
    let values = |list: &[Dual<1>]| list.iter().map(|x| x.value).collect::<Vec<f64>>();
    let (rate, output) = (pick(&values(&found.rates)), values(&found.outputs));
    let (state, input) = (pick(lens.values()), lens.input_values());
    let mut reduction = Reduction::of(at.world().model(), &equations, &tangent, lens.axes(), lens.locks());
    reduction.cyclic = system.cyclic_states().into_iter().map(|k| system.states[k].name.clone()).collect();
    let mut notes = names.notes;
    note_jumps(&tangent, &system, &mut notes);
    note_openings(&equations, &mut notes);
    Ok(Linearization { system, state, input, output, rate, reduction, notes })
}

/// Refuses outputs that contain the rate of a motor's velocity.
fn refuse_improper(tangent: &Tangent, names: &Names) -> Result<(), Diagnostics> {
    let mut diagnostics = Diagnostics::new();
    for (input, response) in &tangent.improper {
        for (output, response) in names.outputs.iter().zip(response) {
            if *response != 0.0 {
                let message = format!(
                    "`{}` contains the rate of `{}`, which a motor follows at once",
                    output.axis.name, names.inputs[*input].axis.name
                );
                let help =
                    "name positions and velocities as outputs, or other inputs: a step of that velocity is an impulse";
                diagnostics.push(Diagnostic::without_location(message).with_help(help));
            }
        }
    }
    if diagnostics.any_error() { Err(diagnostics) } else { Ok(()) }
}

/// Refuses a tangent space that opens loops: the equations that are used for them are dependent here.
fn refuse_open_tangent(model: &Model<f64>, q: &[f64], tangent: &Tangent) -> Result<(), Diagnostics> {
    const MOVE: f64 = 1e-5;
    let opening = |q: &[f64]| {
        let state = State { q: q.to_vec(), ..State::new(model) };
        let all = constraint_residuals(model, &state);
        all.into_iter().map(|r| r.distance.max(r.angle)).fold(0.0, f64::max)
    };
    let before = opening(q);
    for column in &tangent.columns[..tangent.n_positions] {
        let step = &column[..model.n_v()];
        let largest = step.iter().fold(1.0_f64, |most, x| most.max(x.abs()));
        let opening_at = |by: f64| {
            let step: Vec<f64> = step.iter().map(|x| x * by / largest).collect();
            let mut moved = q.to_vec();
            displace(model, q, &step, &mut moved);
            opening(&moved)
        };
        // along the loops it is of second order: 16 times as large at 4 times the move
        let (near, far) = (opening_at(MOVE), opening_at(4.0 * MOVE));
        if near > 2.0 * before + 2e-9 && far < 8.0 * near {
            let message = "the equations of the loops are dependent at this position";
            let help = "it is a singular one, or almost: choose another (`initial` of the joints, or another time)";
            return Err(Diagnostic::without_location(message).with_help(help).into());
        }
    }
    Ok(())
}

/// Speeds that jump with an input.
fn note_jumps(tangent: &Tangent, system: &StateSpace, notes: &mut Vec<String>) {
    let speeds = tangent.n_positions..tangent.n_positions + tangent.n_speeds;
    for (input, _) in &tangent.improper {
        let column = &tangent.columns[system.n_states() + input];
        let jump = |k: &usize| column[tangent.states[*k]] != 0.0;
        let list: Vec<String> = speeds.clone().filter(jump).map(|k| format!("`{}`", system.states[k].name)).collect();
        if !list.is_empty() {
            notes.push(format!(
                "a step of `{}` makes velocities jump: the states {} are without the share that jumps, the outputs with it",
                system.inputs[*input].name,
                list.join(", ")
            ));
        }
    }
}

/// Equations that do not hold at the operating point.
fn note_openings(equations: &Equations, notes: &mut Vec<String>) {
    let largest = |list: &[f64]| list.iter().fold(0.0_f64, |a, x| a.max(x.abs()));
    let (open, moving) = (largest(&equations.residual), largest(&equations.rate));
    if open > 1e-8 || moving > 1e-6 {
        notes.push(format!(
            "the equations that were eliminated hold to {open:.1e} m or rad, their rates to {moving:.1e} per second"
        ));
    }
}

/// An axis from a name and a unit.
fn axis(name: impl Into<String>, unit: impl Into<String>) -> Axis {
    Axis { name: name.into(), unit: unit.into() }
}

/// Returns the greatest moduli `[1/s]` of the poles at the start of a scene: with the diagram's continuous blocks in
/// the loop, then without. `None` if there is no operating point or a pole is not finite. They tell whether the step of
/// an integrator is short enough; an experiment is loaded with this function as
/// [`sincro_sim::Extensions::fastest_poles`].
///
/// ```
/// use sincro_analysis::prelude::*;
/// use sincro_sim::prelude::*;
///
/// # fn main() -> Result<(), Box<dyn std::error::Error>> {
/// let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/../../scenes/double-pendulum");
/// let hanging = [Override::new("/upper.initial.position", "0"), Override::new("/upper/lower.initial.position", "0")];
/// let loaded = load_without_variants(folder.as_ref(), &hanging, Extensions::default())?;
/// let (closed, open) = fastest_poles(&loaded, method_for(&loaded).0).unwrap();
/// // two masses on rods of 1 m: ω² = (2 + √2) g/l; no diagram closes a loop
/// assert!((open - f64::sqrt((2.0 + f64::sqrt(2.0)) * 9.8)).abs() < 1e-6 && closed == open); // [1/s]
/// # Ok(())
/// # }
/// ```
#[must_use]
pub fn fastest_poles(loaded: &Loaded, method: MethodKind) -> Option<(f64, f64)> {
    let mut at = LockStep::new(loaded, method, false);
    at.start().ok()?;
    at.latch();
    let fastest = |is_closed: bool| {
        let request = Request { is_closed, ..Request::default() };
        let mut names = names::resolve(loaded, &at, &request).ok()?;
        // motors are driven from tick to tick: their gains are no poles of what is integrated
        names.inputs.retain(|input| !is_velocity_motor(loaded, input.what));
        names.outputs.clear();
        names.holds_motors = true;
        let found = linearize_settled(loaded, &mut at.fork().lockstep, names).ok()?;
        let moduli = found.system.poles().into_iter().map(|mode| mode.natural_frequency);
        Some(moduli.fold(0.0_f64, f64::max))
    };
    fastest(true).zip(fastest(false)).filter(|(closed, open)| closed.is_finite() && open.is_finite())
}

/// Returns the rates `[unit of the state / s]` of the full state with entry `k` changed by `by` `[unit of the state]`
/// about the state of a run, to check derivatives by differences. The full state is: displacements of all `n_v` degrees
/// of freedom, their velocities, states of rotors. The diagram is not in the loop.
///
/// # Panics
///
/// If `k` is not below the length of the full state.
#[must_use]
pub fn perturbed_rates(loaded: &Loaded, at: &LockStep, k: usize, by: f64) -> Vec<f64> {
    let names = Names::default();
    let mut lens = Lens::<f64>::new(loaded, &mut point::settle(loaded, at, &names), &names);
    let mut change = vec![0.0; lens.n_full()];
    change[k] = by;
    lens.evaluate(&change, None).rates
}

/// Returns true if an input is the command of a motor that gives a velocity.
fn is_velocity_motor(loaded: &Loaded, input: InputKind) -> bool {
    let motors = loaded.scene.model.motors();
    matches!(input, InputKind::Command(m) if motors.get(m).is_some_and(|motor| motor.is_drive()))
}
