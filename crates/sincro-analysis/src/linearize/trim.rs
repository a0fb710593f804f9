//! Trim: where a scene stays as it is.
//!
//! Unknown are the coordinates and the continuous states of the diagram, and those commands that are set free;
//! velocities are zero. All rates must vanish, and signals that are asked for must have their values. The Jacobian is
//! that of the linearisation, exact.

use sincro_math::Dual;

use super::lens::Lens;
use super::names::{self, InputKind, Names};
use super::point::Request;
use crate::linear::newton::{self, Solution};
use crate::linear::{Axis, DMatrix};
use sincro_scene::diagnostic::{Diagnostic, Diagnostics, Located};
use sincro_sim::load::Loaded;
use sincro_sim::run::LockStep;

/// Rates below this count as zero [rad/s²], [m/s²] and the like.
const AT_REST: f64 = 1e-10;
/// Most steps of Newton's method.
const MAX_STEPS: usize = 200;

/// Request for a trim.
#[derive(Clone, Debug, Default)]
pub struct TrimRequest {
    /// Commands that may be changed; the others are as the scene gives them.
    pub free: Vec<Located<String>>,
    /// Signals and the values that they must have.
    pub wanted: Vec<(Located<String>, f64)>,
    /// With the diagram in the loop.
    pub is_closed: bool,
}

/// An equilibrium, in numbers.
#[derive(Clone, Debug, PartialEq)]
pub struct Trim {
    /// States: coordinates, velocities (zero), states of the diagram.
    pub states: Vec<(Axis, f64)>,
    /// All commands that can be linearised by, whether they were free or not.
    pub inputs: Vec<(Axis, f64)>,
    /// The wanted signals as they came out.
    pub outputs: Vec<(Axis, f64)>,
    /// Greatest rate that is left.
    pub residual: f64,
    /// Steps of Newton's method.
    pub iterations: usize,
}

/// An equilibrium: its numbers, and the scene in it.
#[derive(Debug)]
pub struct Trimmed {
    /// The numbers.
    pub trim: Trim,
    /// The scene there.
    pub at: LockStep,
}

/// Finds an equilibrium near the state that a run is in.
///
/// # Errors
///
/// Names that mean nothing, or that there is no equilibrium nearby: what is left over, and of what.
pub fn trim(loaded: &Loaded, from: &LockStep, request: &TrimRequest) -> Result<Trimmed, Diagnostics> {
    let mut at = from.fork().lockstep;
    at.stop();
    let names = resolve(loaded, &at, request)?;
    let targets: Vec<f64> = request.wanted.iter().map(|(_, x)| *x).collect();
    let mut values = Lens::<f64>::new(loaded, &at, &names);
    let mut duals = Lens::<Dual<1>>::new(loaded, &at, &names);
    let unknowns = Unknowns::of(&values, names.inputs.len(), loaded.scene.model.n_v());
    let solution = solve(&mut values, &mut duals, &unknowns, &targets)?;
    let (state, z) = values.displaced(&unknowns.spread(&solution.x));
    at.place(state, &z);

    let outputs = request.wanted.iter().map(|(name, _)| name.clone()).collect();
    let found = super::linearize(loaded, &at, &Request { inputs: Vec::new(), outputs, is_closed: request.is_closed })?;
    let zip = |axes: &[Axis], values: &[f64]| axes.iter().cloned().zip(values.iter().copied()).collect();
    let trim = Trim {
        states: zip(&found.system.states, &found.state),
        inputs: zip(&found.system.inputs, &found.input),
        outputs: if targets.is_empty() { Vec::new() } else { zip(&found.system.outputs, &found.output) },
        residual: found.drift(),
        iterations: solution.iterations,
    };
    Ok(Trimmed { trim, at })
}

/// The commands that are free and the signals that are wanted; none of either where the request has none.
fn resolve(loaded: &Loaded, at: &LockStep, request: &TrimRequest) -> Result<Names, Diagnostics> {
    let wanted = request.wanted.iter().map(|(name, _)| name.clone()).collect();
    let asked = Request { inputs: request.free.clone(), outputs: wanted, is_closed: request.is_closed };
    let mut names = names::resolve(loaded, at, &asked)?;
    if request.free.is_empty() {
        names.inputs.clear();
    }
    if request.wanted.is_empty() {
        names.outputs.clear();
    }
    let of_diagram = request.free.iter().zip(&names.inputs).filter(|(_, i)| matches!(i.what, InputKind::Signal(_)));
    let diagnostics: Vec<Diagnostic> = of_diagram
        .map(|(name, _)| {
            let message = format!("`{}` is a signal of the diagram and cannot be set free", name.value);
            Diagnostic::error(&name.at, message).with_help("free are commands of motors, such as `/joint.command`")
        })
        .collect();
    if diagnostics.is_empty() { Ok(names) } else { Err(Diagnostics(diagnostics)) }
}

/// Which of the states and inputs are unknown: all but the velocities.
struct Unknowns {
    places: Vec<usize>,
    /// The rates that must vanish: all but those of the coordinates.
    equations: core::ops::Range<usize>,
    n_all: usize,
}

impl Unknowns {
    fn of(lens: &Lens<f64>, n_inputs: usize, n_v: usize) -> Self {
        let (n, n_all) = (lens.n_states(), lens.n_states() + n_inputs);
        Self { places: (0..n_v).chain(n_v + lens.n_velocities()..n_all).collect(), equations: n_v..n, n_all }
    }

    /// Unknowns as changes of all states and inputs.
    fn spread(&self, x: &[f64]) -> Vec<f64> {
        let mut change = vec![0.0; self.n_all];
        for (value, &place) in x.iter().zip(&self.places) {
            change[place] = *value;
        }
        change
    }
}

fn solve(
    values: &mut Lens<f64>,
    duals: &mut Lens<Dual<1>>,
    unknowns: &Unknowns,
    targets: &[f64],
) -> Result<Solution, Diagnostics> {
    let n_equations = unknowns.equations.len();
    let residual = |x: &[f64], r: &mut [f64]| {
        let (rates, outputs) = values.evaluate_at(&unknowns.spread(x));
        r[..n_equations].copy_from_slice(&rates[unknowns.equations.clone()]);
        for ((r, y), target) in r[n_equations..].iter_mut().zip(outputs).zip(targets) {
            *r = y - target;
        }
    };
    let jacobian = |x: &[f64], j: &mut DMatrix<f64>| {
        let change = unknowns.spread(x);
        for (column, &place) in unknowns.places.iter().enumerate() {
            let (rates, outputs) = duals.evaluate_about(&change, place);
            let all = rates[unknowns.equations.clone()].iter().chain(outputs);
            for (row, entry) in all.enumerate() {
                j[(row, column)] = entry.partials[0];
            }
        }
    };
    let x0 = vec![0.0; unknowns.places.len()];
    let n_residuals = n_equations + targets.len();
    newton::solve(n_residuals, residual, jacobian, &x0, AT_REST, MAX_STEPS).map_err(|failure| {
        let axes = duals.state_axes();
        let what = match unknowns.equations.clone().nth(failure.worst) {
            Some(k) => format!("the rate of `{}`", axes[k].name),
            None => "a signal that was asked for".to_owned(),
        };
        let message = format!("no equilibrium found: {:.3e} is left over in {what}", failure.residual);
        let help = "commands are held as they are at that time: set them free (--free NAME) or give others (--set); or start nearer \
                    (`initial` of the joints), or ask for less (--want)";
        Diagnostic::nowhere(message).with_help(help).into()
    })
}
