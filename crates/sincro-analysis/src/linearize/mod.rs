//! Linearisation and trim of a scene: exact, by dual numbers, no step width to choose.
//!
//! State x = (δ, v, z): displacements of the coordinates about the operating point (for a quaternion the rotation
//! vector in body axes), velocities, continuous states of the diagram. Inputs are commands of motors, or signals of the
//! diagram that something is added to; outputs are any recorded signals. Every column of A and B is one evaluation of
//! the equations of motion with the derivative carried along.
//!
//! The open loop is the world alone, its commands held. The closed loop has the diagram's continuous blocks in it;
//! blocks with a sample time hold what they gave last, as they do between ticks. A degree of freedom that an ideal
//! motor or sticking friction holds has no velocity among the states.

mod lens;
mod names;
mod point;
mod trim;

pub use point::{Request, operating_point};
pub use trim::{Trim, TrimRequest, Trimmed, trim};

use sincro_dynamics::world::MethodKind;
use sincro_math::Dual;

use crate::linear::{Axis, DMatrix, StateSpace};
use lens::Lens;
use sincro_scene::diagnostic::Diagnostics;
use sincro_sim::load::Loaded;
use sincro_sim::run::LockStep;

/// A linear system, and the point at which it holds.
#[derive(Clone, Debug, PartialEq)]
pub struct Linearization {
    /// The matrices with the names of their rows and columns.
    pub system: StateSpace,
    /// Values of the states at the operating point: coordinates themselves, not displacements.
    pub state: Vec<f64>,
    /// Values of the inputs.
    pub input: Vec<f64>,
    /// Values of the outputs.
    pub output: Vec<f64>,
    /// Rates of the states there: zero at an equilibrium.
    pub rate: Vec<f64>,
    /// Warnings about the accuracy of the numbers.
    pub notes: Vec<String>,
}

impl Linearization {
    /// Greatest rate at the operating point: how far it is from an equilibrium.
    #[must_use]
    pub fn drift(&self) -> f64 {
        self.rate.iter().fold(0.0_f64, |worst, r| worst.max(r.abs()))
    }
}

/// Linearises a scene at the state that a run is in.
///
/// # Errors
///
/// Inputs and outputs that mean nothing or cannot be linearised.
pub fn linearize(loaded: &Loaded, at: &LockStep, request: &Request) -> Result<Linearization, Diagnostics> {
    let names = names::resolve(loaded, at, request)?;
    let mut lens = Lens::<Dual<1>>::new(loaded, at, &names);
    let (n, m, p) = (lens.n_states(), names.inputs.len(), names.outputs.len());
    let mut system = StateSpace {
        a: DMatrix::zeros(n, n),
        b: DMatrix::zeros(n, m),
        c: DMatrix::zeros(p, n),
        d: DMatrix::zeros(p, m),
        states: lens.state_axes(),
        inputs: names.inputs.iter().map(|i| i.axis.clone()).collect(),
        outputs: names.outputs.iter().map(|o| o.axis.clone()).collect(),
        t: at.t(),
        sample_time: None,
    };
    for k in 0..n + m {
        let (rates, outputs) = lens.evaluate(Some(k));
        for (i, rate) in rates.iter().enumerate() {
            let entry = if k < n { &mut system.a[(i, k)] } else { &mut system.b[(i, k - n)] };
            *entry = rate.partials[0];
        }
        for (i, output) in outputs.iter().enumerate() {
            let entry = if k < n { &mut system.c[(i, k)] } else { &mut system.d[(i, k - n)] };
            *entry = output.partials[0];
        }
    }
    let (rates, outputs) = lens.evaluate(None);
    let (rate, output) = (rates.iter().map(|x| x.value).collect(), outputs.iter().map(|x| x.value).collect());
    let (state, input) = (lens.state_values(), lens.input_values());
    let mut notes = names.notes;
    let set = loaded.scene.model.constraints();
    if !set.pairs.is_empty() || !set.limits.is_empty() {
        notes.push("contacts and limits of joints are left out: the linearisation is of the free motion".into());
    }
    if set.n_bilateral() > 0 {
        notes.push("closed loops make some of the states depend on others: they show as poles at zero".into());
    }
    Ok(Linearization { system, state, input, output, rate, notes })
}

/// An axis from a name and a unit.
fn axis(name: impl Into<String>, unit: impl Into<String>) -> Axis {
    Axis { name: name.into(), unit: unit.into() }
}

/// Moduli [1/s] of the fastest poles at the start, with the diagram's continuous blocks in the loop and without; none
/// if there is no operating point. The experiment is loaded with it: [`sincro_sim::Extensions::fastest_poles`].
#[must_use]
pub fn fastest_poles(loaded: &Loaded, method: MethodKind) -> Option<(f64, f64)> {
    let mut at = LockStep::new(loaded, method, false);
    at.start().ok()?;
    at.latch();
    let fastest = |is_closed: bool| {
        let found = linearize(loaded, &at, &Request { is_closed, ..Request::default() }).ok()?;
        let moduli = found.system.poles().into_iter().map(|mode| mode.natural_frequency);
        Some(moduli.fold(0.0_f64, f64::max))
    };
    fastest(true).zip(fastest(false)).filter(|(closed, open)| closed.is_finite() && open.is_finite())
}

/// Rates with state `k` changed by `by` about where a run is: for whoever wants to check derivatives by differences.
/// The diagram is not in the loop.
#[must_use]
pub fn rates_near(loaded: &Loaded, at: &LockStep, k: usize, by: f64) -> Vec<f64> {
    let mut lens = Lens::<f64>::new(loaded, at, &names::Names::default());
    let mut change = vec![0.0; lens.n_states()];
    change[k] = by;
    lens.evaluate_at(&change).0.to_vec()
}
