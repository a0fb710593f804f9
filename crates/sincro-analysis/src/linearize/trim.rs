//! Trim: where a scene stays as it is.
//!
//! Unknown are the independent coordinates ([`super::reduction`]), the continuous states of the diagram, and those
//! commands that are set free; velocities are zero. All rates must vanish, the velocities that motors ask for too, and
//! signals that are asked for must have their values. The Jacobian is that of the linearisation, exact.
//!
//! Each step of Newton's method is put back onto the closed loops and contacts, in the metric of the mass matrix. A
//! step that would pass a joint limit or let bodies overlap ends there; then the modes of contacts, limits and drives
//! are found anew. Joints that friction or a velocity motor holds keep their position, unless signals are asked for.

use sincro_dynamics::actuation::drive::DriveKind;
use sincro_dynamics::initial;
use sincro_dynamics::model::Model;
use sincro_dynamics::state::State;
use sincro_math::Dual;

use super::lens::{EquationSource, Evaluation, Lens};
use super::names::{self, InputKind, Names};
use super::point::{self, Request};
use super::reduction::{Equations, Metric, Tangent};
use crate::linear::newton::newton_step;
use crate::linear::{Axis, DMatrix, DVector};
use sincro_scene::diagnostic::{Diagnostic, Diagnostics, Located};
use sincro_sim::load::Loaded;
use sincro_sim::run::LockStep;

/// Rates below this count as zero [rad/s²], [m/s²] and the like.
const AT_REST: f64 = 1e-10;
/// Most steps of Newton's method.
const MAX_STEPS: usize = 200;
/// Halvings of a step before it counts as none.
const MAX_HALVINGS: usize = 40;
/// Share of the promised descent that a step must bring.
const DESCENT: f64 = 1e-4;
/// Largest change of a coordinate in a step of a mechanism with loops or contacts `[rad]` or `[m]`.
const MAX_MOVE: f64 = 0.1;
/// Iterations that put a step back onto the loops.
const MAX_PROJECTIONS: usize = 30;
/// Position residual of a closed loop `[m]` or `[rad]`.
const CLOSED: f64 = 1e-12;
/// Position residual up to which rounding may keep a loop open.
const NEARLY_CLOSED: f64 = 1e-10;
/// Depth beyond a limit or of an overlap at which a step ends `[m]` or `[rad]`.
const TOUCHES: f64 = 5e-10;

/// Choice of free commands and wanted signals for [`trim`]; the default holds all commands and searches an equilibrium
/// of the position alone.
///
/// ```
/// use sincro_analysis::prelude::*;
/// use sincro_sim::prelude::*;
///
/// # fn main() -> Result<(), Box<dyn std::error::Error>> {
/// let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/../../scenes/acrobot");
/// let loaded = load(folder.as_ref(), &[], Extensions::default())?;
/// // the torque that holds the elbow bent by 0.5 rad
/// let named = |name: &str| Override::new(name, "").path;
/// let mut request = TrimRequest { free: vec![named("/shoulder/upper/elbow")], ..TrimRequest::default() };
/// request.wanted.push((named("/shoulder/upper/elbow.position"), 0.5));
/// let trimmed = trim(&loaded, &operating_point(&loaded, 0.0).map_err(Diagnostics::from)?, &request)?;
/// // m g l/2 sin(q₁ + q₂) of the lower link
/// let (q, torque) = (&trimmed.at.state().q, trimmed.trim.inputs[0].1);
/// assert!((torque - 1.0 * 9.8 * 0.5 * f64::sin(q[0] + q[1])).abs() < 1e-9); // [N·m]
/// # Ok(())
/// # }
/// ```
#[derive(Clone, Debug, Default)]
pub struct TrimRequest {
    /// Names of motor commands that the search may change (`/joint.command`, or the joint's path); the others are held
    /// as they are at the start.
    pub free: Vec<Located<String>>,
    /// Signals and the values that they must have in the equilibrium, in the units of the signals.
    pub wanted: Vec<(Located<String>, f64)>,
    /// True: the continuous blocks of the diagram are in the loop, and their states are unknowns, too.
    pub is_closed: bool,
}

/// Equilibrium in numbers, each value with its name and unit; part of [`Trimmed`].
///
/// ```
/// use sincro_analysis::prelude::*;
/// # use sincro_sim::prelude::*;
///
/// # fn main() -> Result<(), Box<dyn std::error::Error>> {
/// # let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/../../scenes/acrobot");
/// # let loaded = load(folder.as_ref(), &[], Extensions::default())?;
/// let from = operating_point(&loaded, 0.0).map_err(Diagnostics::from)?; // two links, 0.1 rad from hanging
/// let found: Trim = trim(&loaded, &from, &TrimRequest::default())?.trim;
/// let (axis, angle) = &found.states[0];
/// assert_eq!((axis.name.as_str(), axis.unit.as_str()), ("/shoulder.position", "rad"));
/// assert!(angle.abs() < 1e-10 && found.residual < 1e-9); // it hangs
/// # Ok(())
/// # }
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Trim {
    /// States with their values: coordinates, velocities (zero), states of rotors and of the diagram.
    pub states: Vec<(Axis, f64)>,
    /// Coordinates of each joint as its `initial.position` takes them, by path: one number, or a list such as x, y, z
    /// and quaternion of a free joint. A scene that starts with them, at rest and with the commands of
    /// [`Trim::inputs`], starts in the equilibrium.
    pub initial: Vec<(String, Vec<f64>)>,
    /// Motor commands with their values, free ones and held ones; those that the diagram gives are left out.
    pub inputs: Vec<(Axis, f64)>,
    /// Wanted signals with the values reached, in the order of [`TrimRequest::wanted`].
    pub outputs: Vec<(Axis, f64)>,
    /// Greatest magnitude among the rates of the states that is left `[unit of the state / s]`.
    pub residual: f64,
    /// Number of Newton steps taken.
    pub iterations: usize,
}

/// Equilibrium of a scene as [`trim`] found it: the numbers, and a run that stands in it, for
/// [`linearize`](super::linearize).
///
/// ```
/// use sincro_analysis::prelude::*;
/// # use sincro_sim::prelude::*;
///
/// # fn main() -> Result<(), Box<dyn std::error::Error>> {
/// # let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/../../scenes/acrobot");
/// # let loaded = load(folder.as_ref(), &[], Extensions::default())?;
/// let from = operating_point(&loaded, 0.0).map_err(Diagnostics::from)?; // two links, 0.1 rad from hanging
/// let Trimmed { at, .. } = trim(&loaded, &from, &TrimRequest::default())?;
/// // the modes of the hanging arm: it swings, undamped
/// let modes = linearize(&loaded, &at, &Request::default())?.system.poles();
/// assert!(modes.iter().all(|mode| mode.pole.re.abs() < 1e-7 && mode.natural_frequency > 1.0));
/// # Ok(())
/// # }
/// ```
#[derive(Debug)]
pub struct Trimmed {
    /// Values of states, inputs and outputs in the equilibrium.
    pub trim: Trim,
    /// Run at rest in the equilibrium; it can be advanced or linearised.
    pub at: LockStep,
}

/// Finds an equilibrium near the state that a run is in: velocities are zero and all rates vanish, with loops closed,
/// contacts and limits respected, and the wanted signals at their values. `from` is not changed.
///
/// # Errors
///
/// One diagnostic for each name that is no free command or recorded signal; or one that there is no equilibrium nearby,
/// with the greatest residual that is left, its name and the reason.
///
/// ```
/// use sincro_analysis::prelude::*;
/// use sincro_sim::prelude::*;
///
/// # fn main() -> Result<(), Box<dyn std::error::Error>> {
/// let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/../../scenes/acrobot");
/// let loaded = load(folder.as_ref(), &[], Extensions::default())?;
/// let from = operating_point(&loaded, 0.0).map_err(Diagnostics::from)?; // 0.1 rad from hanging
/// let mut trimmed = trim(&loaded, &from, &TrimRequest::default())?;
/// assert!(trimmed.trim.iterations > 0);
/// trimmed.at.advance()?;
/// assert!(trimmed.at.state().v.iter().all(|v| v.abs() < 1e-9)); // it stays where it is
/// # Ok(())
/// # }
/// ```
pub fn trim(loaded: &Loaded, from: &LockStep, request: &TrimRequest) -> Result<Trimmed, Diagnostics> {
    let mut at = from.fork().lockstep;
    at.stop();
    let names = resolve(loaded, &at, request)?;
    close(loaded, &mut at)?;
    let mut search =
        Search { loaded, names: &names, targets: request.wanted.iter().map(|(_, x)| *x).collect(), iterations: 0 };
    search.find(&mut at)?;
    let iterations = search.iterations;
    check(loaded, &at)?;

    let outputs = request.wanted.iter().map(|(name, _)| name.clone()).collect();
    let asked = Request { inputs: Vec::new(), outputs, is_closed: request.is_closed };
    let all = names::resolve(loaded, &at, &asked)?;
    let mut lens = Lens::<f64>::new(loaded, &mut at, &all);
    let found = lens.evaluate(&vec![0.0; lens.n_full() + lens.n_inputs()], None);
    let zip = |axes: Vec<Axis>, values: &[f64]| axes.into_iter().zip(values.iter().copied()).collect();
    let wanted = all.outputs.iter().map(|o| o.axis.clone()).collect();
    let initial = initial_positions(&loaded.scene.model, at.state());
    let trim = Trim {
        initial,
        states: zip(lens.axes().to_vec(), lens.values()),
        inputs: zip(all.inputs.iter().map(|i| i.axis.clone()).collect(), &lens.input_values()),
        outputs: if request.wanted.is_empty() { Vec::new() } else { zip(wanted, &found.outputs) },
        residual: found.rates.iter().fold(0.0, |worst, rate| rate.abs().max(worst)),
        iterations,
    };
    Ok(Trimmed { trim, at })
}

/// Coordinates of the joints by path; force sensors, whose degrees of freedom are locked, have none.
fn initial_positions(model: &Model<f64>, state: &State<f64>) -> Vec<(String, Vec<f64>)> {
    let is_locked = |dof: usize| model.drives().iter().any(|d| d.dof == dof && d.kind == DriveKind::Lock);
    let joints = model.names().joints.iter().filter(|joint| !is_locked(joint.v_idx));
    joints.map(|joint| (joint.name.clone(), state.q[joint.q_idx..joint.q_idx + joint.n_q].to_vec())).collect()
}

/// Closes loops that are open where the search starts.
fn close(loaded: &Loaded, at: &mut LockStep) -> Result<(), Diagnostics> {
    let model = &loaded.scene.model;
    let is_open = |state: &State<f64>| openings(loaded, state).1 > NEARLY_CLOSED;
    if !is_open(at.state()) {
        return Ok(());
    }
    let Some(q) = initial::assemble(model, at.state()) else {
        let (name, gap) = openings(loaded, at.state());
        let message = format!("loop `{name}` is open by {gap:.3e} and does not close near where the search starts");
        return Err(Diagnostic::without_location(message).with_help("start where it is closed").into());
    };
    let mut state = at.state().clone();
    state.q = q;
    at.set_state(state, &[]);
    Ok(())
}

/// The loop that is open farthest, and by how much.
fn openings(loaded: &Loaded, state: &State<f64>) -> (String, f64) {
    let all = initial::constraint_residuals(&loaded.scene.model, state);
    let worst = |a: (String, f64), r: initial::ConstraintResidual| {
        let gap = r.distance.max(r.angle);
        if gap > a.1 { (r.name, gap) } else { a }
    };
    all.into_iter().fold((String::new(), 0.0), worst)
}

/// Deepest passage of a limit or overlap of bodies, beyond what a state has already.
fn depth(loaded: &Loaded, state: &State<f64>) -> f64 {
    let model = &loaded.scene.model;
    let limits = model.constraints().limits.iter().map(|l| -l.sign * (state.q[l.coordinate] - l.bound));
    let overlaps = initial::penetrations(model, state).into_iter().map(|p| p.depth);
    limits.chain(overlaps).fold(0.0, f64::max)
}

/// Refuses a state that a scene could not start from.
fn check(loaded: &Loaded, at: &LockStep) -> Result<(), Diagnostics> {
    let model = &loaded.scene.model;
    let (name, gap) = openings(loaded, at.state());
    if gap > 1e-9 {
        return Err(Diagnostic::without_location(format!(
            "no equilibrium found: loop `{name}` stays open by {gap:.3e}"
        ))
        .into());
    }
    match initial::limit_violations(model, at.state()).first() {
        Some(v) => {
            let message = format!("no equilibrium found: `{}` would be at {}, beyond {}", v.joint, v.position, v.limit);
            Err(Diagnostic::without_location(message).into())
        }
        None => Ok(()),
    }
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

/// Newton's method on the manifold of closed loops and contacts.
struct Search<'a> {
    loaded: &'a Loaded,
    names: &'a Names,
    targets: Vec<f64>,
    iterations: usize,
}

/// Residuals, each with the words for it.
struct Residuals {
    values: Vec<f64>,
    labels: Vec<String>,
}

/// Step of Newton's method in the full states and inputs.
struct Direction {
    change: Vec<f64>,
    /// Sum of the squares of the residuals before it.
    square: f64,
    /// Derivative of that sum along the step.
    slope: f64,
}

impl Search<'_> {
    fn find(&mut self, at: &mut LockStep) -> Result<(), Diagnostics> {
        loop {
            point::initialize(at);
            // an impact may have moved it
            if at.state().v.iter().any(|v| *v != 0.0) {
                at.stop();
            }
            let mut values = Lens::<f64>::new(self.loaded, at, self.names);
            let mut duals = Lens::<Dual<1>>::new(self.loaded, at, self.names);
            let holds = self.targets.is_empty();
            values.hold_positions(holds);
            duals.hold_positions(holds);
            let rest = vec![0.0; values.n_full() + values.n_inputs()];
            let now = self.residuals(&values.evaluate(&rest, None), values.axes(), values.n_v());
            if now.values.iter().any(|r| !r.is_finite()) {
                return Err(self.failure(&now, "a rate is not finite"));
            }
            if now.largest().1 <= AT_REST {
                return Ok(());
            }
            if self.iterations == MAX_STEPS {
                return Err(self.failure(&now, "the steps ran out while it was still getting smaller"));
            }
            let manifold = Manifold::of(&mut duals, at, self.names);
            let change = match self.released_change(&mut values, &mut duals, &manifold) {
                Some(change) => change,
                None => {
                    values.release(&[]);
                    duals.release(&[]);
                    let direction = self.direction(&mut duals, &manifold, &now);
                    let change = direction.and_then(|direction| {
                        let found = self.line_search(&mut values, &manifold, &direction);
                        found.ok_or("every step makes it greater, or leads beyond a limit")
                    });
                    change.map_err(|why| self.failure(&now, why))?
                }
            };
            let (state, z) = values.displaced(&change);
            at.set_state(state, &z);
            self.iterations += 1;
        }
    }

    /// A step that leads activations away from the ends of their ranges at which they rest, where free commands can.
    /// Active set: the ends are first left out, and count again for activations that the step would take beyond them.
    fn released_change(
        &self,
        values: &mut Lens<f64>,
        duals: &mut Lens<Dual<1>>,
        manifold: &Manifold,
    ) -> Option<Vec<f64>> {
        if values.n_inputs() == 0 {
            return None;
        }
        let rest = vec![0.0; values.n_full() + values.n_inputs()];
        let mut released = values.stopped().to_vec();
        while !released.is_empty() {
            values.release(&released);
            duals.release(&released);
            let found = values.evaluate(&rest, None);
            let now = self.residuals(&found, values.axes(), values.n_v());
            let direction = self.direction(duals, manifold, &now).ok()?;
            let n = released.len();
            // the rate leads out of the range
            released.retain(|k| direction.change[*k] * found.rates[*k] < 0.0);
            if released.len() == n {
                return self.line_search(values, manifold, &direction);
            }
        }
        None
    }

    /// The step of Newton's method, for the residuals at the operating point; the reason if there is none.
    fn direction(
        &self,
        duals: &mut Lens<Dual<1>>,
        manifold: &Manifold,
        now: &Residuals,
    ) -> Result<Direction, &'static str> {
        let nothing = "no position near the start changes it";
        let (unknowns, jacobian) = self.jacobian(duals, &manifold.tangent);
        let r = DVector::from_column_slice(&now.values);
        let (step, _) = newton_step(&jacobian, &r).ok_or(nothing)?;
        let gradient = jacobian.tr_mul(&r);
        let mut change = vec![0.0; duals.n_full() + duals.n_inputs()];
        for (share, column) in step.iter().zip(&unknowns) {
            change.iter_mut().zip(column).for_each(|(d, c)| *d += share * c);
        }
        // stopped states are left out of the step exactly
        duals.stopped().iter().for_each(|k| change[*k] = 0.0);
        // farther than this the loops may close on another branch
        let largest = change[..duals.n_v()].iter().fold(0.0_f64, |most, d| most.max(d.abs()));
        let share = if manifold.rows.is_empty() { 1.0 } else { (MAX_MOVE / largest).min(1.0) };
        change.iter_mut().for_each(|d| *d *= share);
        if gradient.norm() <= 1e-9 * jacobian.norm() * r.norm() {
            return Err(nothing);
        }
        Ok(Direction { change, square: r.norm_squared(), slope: 2.0 * share * gradient.dot(&step) })
    }

    /// The residuals of an evaluation: rates of speeds, of rotors and diagram, velocities that motors ask for, wanted
    /// signals.
    fn residuals<R: sincro_blocks::instance::Number>(
        &self,
        found: &Evaluation<R>,
        axes: &[Axis],
        n_v: usize,
    ) -> Residuals {
        let mut new = Residuals { values: Vec::new(), labels: Vec::new() };
        self.each(found, n_v, |x, k| {
            new.values.push(x.lane(0));
            new.labels.push(k.map_or("a motor's velocity or a wanted signal".into(), |k| {
                format!("the rate of `{}`", axes.get(k).map_or("", |axis| &axis.name))
            }));
        });
        new
    }

    /// Visits all residuals of an evaluation, with the full state of a rate.
    fn each<R: sincro_blocks::instance::Number>(
        &self,
        found: &Evaluation<R>,
        n_v: usize,
        mut visit: impl FnMut(R, Option<usize>),
    ) {
        for (k, rate) in found.rates.iter().enumerate().skip(n_v) {
            visit(*rate, Some(k));
        }
        for drive in 0..self.loaded.scene.model.drives().len() {
            let of_drive = found.equations.iter().find(|e| e.source == EquationSource::Drive(drive));
            visit(of_drive.map_or(R::zero(), |e| e.rate), None);
        }
        for (output, target) in found.outputs.iter().zip(&self.targets) {
            visit(*output - R::splat(*target), None);
        }
    }

    /// Directions of the unknowns, and the derivatives of all residuals along them.
    fn jacobian(&self, duals: &mut Lens<Dual<1>>, tangent: &Tangent) -> (Vec<Vec<f64>>, DMatrix<f64>) {
        let n_v = duals.n_v();
        let speeds = tangent.n_positions..tangent.n_positions + tangent.n_speeds;
        let columns = tangent.columns.iter().enumerate().filter(|(k, _)| !speeds.contains(k));
        let at_rest = |(_, column): (usize, &Vec<f64>)| {
            let mut column = column.clone();
            column[n_v..2 * n_v].fill(0.0);
            column
        };
        let unknowns: Vec<Vec<f64>> = columns.map(at_rest).collect();
        let mut columns: Vec<f64> = Vec::new();
        for direction in &unknowns {
            let found = duals.along(direction);
            let stopped = duals.stopped();
            // what rests at an end of its range stays there, as a − end = 0
            let stays = |k: Option<usize>| k.filter(|k| stopped.contains(k)).map(|k| direction[k]);
            self.each(&found, n_v, |x, k| columns.push(stays(k).unwrap_or(x.partials[0])));
        }
        let n_rows = if unknowns.is_empty() { 0 } else { columns.len() / unknowns.len() };
        (unknowns.clone(), DMatrix::from_column_slice(n_rows, unknowns.len(), &columns))
    }

    /// Halves the step until it brings enough descent; one that leads beyond a limit or into a body ends there.
    fn line_search(
        &self,
        values: &mut Lens<f64>,
        manifold: &Manifold,
        &Direction { change: ref direction, square, slope }: &Direction,
    ) -> Option<Vec<f64>> {
        let n_v = values.n_v();
        let before = depth(self.loaded, &values.displaced(&vec![0.0; direction.len()]).0);
        let mut trial = |share: f64| {
            let change: Vec<f64> = direction.iter().map(|d| share * d).collect();
            let change = manifold.project(values, change)?;
            let state = values.displaced(&change).0;
            // equations that are redundant on the branch of the mechanism may be open on another one
            if openings(self.loaded, &state).1 > NEARLY_CLOSED {
                return None;
            }
            let deep = depth(self.loaded, &state) > before + TOUCHES;
            let r = self.residuals(&values.evaluate(&change, None), &[], n_v);
            Some((change, deep, r.values.iter().map(|r| r * r).sum::<f64>()))
        };
        let mut share = 1.0;
        for _ in 0..MAX_HALVINGS {
            match trial(share) {
                Some((_, true, _)) => {
                    // up to where it touches
                    let (mut good, mut bad) = (0.0, share);
                    for _ in 0..60 {
                        let middle = 0.5 * (good + bad);
                        let fits = trial(middle).is_some_and(|(_, deep, _)| !deep);
                        if fits { good = middle } else { bad = middle }
                    }
                    let (change, _, _) = trial(good)?;
                    return (good > 1e-14).then_some(change);
                }
                Some((change, false, reached)) if reached <= square + DESCENT * share * slope => return Some(change),
                _ => share *= 0.5,
            }
        }
        None
    }

    fn failure(&self, now: &Residuals, why: &str) -> Diagnostics {
        let (worst, size) = now.largest();
        let message = format!("no equilibrium found: {size:.3e} is left over in {}; {why}", now.labels[worst]);
        let help = "commands are held as they are at that time: set them free (--free NAME) or give others (--set); or start nearer \
                    (`initial` of the joints), or ask for less (--want)";
        Diagnostic::without_location(message).with_help(help).into()
    }
}

impl Residuals {
    /// Index and size of the largest; what is not a number is the largest.
    fn largest(&self) -> (usize, f64) {
        let greater = |best: (usize, f64), (k, v): (usize, &f64)| {
            if v.abs() > best.1 || v.is_nan() { (k, v.abs()) } else { best }
        };
        self.values.iter().enumerate().fold((0, 0.0), greater)
    }
}

/// Closed loops, contacts and held joints near a state.
struct Manifold {
    tangent: Tangent,
    /// L⁻ᵀ of the mass matrix.
    inverse_root: DMatrix<f64>,
    /// Holonomic equations that are used, their rows in W L⁻ᵀ, and the pseudo-inverse of these.
    rows: Vec<usize>,
    pseudo_inverse: DMatrix<f64>,
}

impl Manifold {
    fn of(duals: &mut Lens<Dual<1>>, at: &mut LockStep, names: &Names) -> Self {
        let equations = Equations::of(duals);
        let q = at.state().q.clone();
        let metric = Metric::of(at.world().model(), &q);
        let kinds: Vec<InputKind> = names.inputs.iter().map(|i| i.what).collect();
        let tangent = Tangent::of(duals, &equations, &metric, &kinds);
        let rows = equations.holonomic_rows(&metric);
        let w = equations.rate_by_v.select_rows(&rows) * &metric.inverse_root;
        let gram = &w * w.transpose();
        let pseudo_inverse = match gram.cholesky() {
            Some(factor) => w.transpose() * factor.inverse(),
            None => DMatrix::zeros(w.ncols(), w.nrows()),
        };
        Self { tangent, inverse_root: metric.inverse_root, rows, pseudo_inverse }
    }

    /// Puts a change of the full states onto the manifold; `None` if it does not come there. The factors are those of
    /// where it started: the error falls by a factor that is small for small changes.
    fn project(&self, values: &mut Lens<f64>, mut change: Vec<f64>) -> Option<Vec<f64>> {
        if self.rows.is_empty() {
            return Some(change);
        }
        let n_v = values.n_v();
        let mut last = f64::INFINITY;
        for _ in 0..MAX_PROJECTIONS {
            let equations = values.evaluate(&change, None).equations;
            let of_row = |i: &usize| equations.get(*i).and_then(|e| e.residual).unwrap_or(f64::NAN);
            let g = DVector::from_iterator(self.rows.len(), self.rows.iter().map(of_row));
            let worst = g.amax();
            if worst <= CLOSED || (worst <= NEARLY_CLOSED && worst >= 0.5 * last) {
                return Some(change);
            }
            if !worst.is_finite() || worst > 2.0 * last {
                return None;
            }
            last = worst;
            let back = &self.inverse_root * (&self.pseudo_inverse * g);
            change[..n_v].iter_mut().zip(back.iter()).for_each(|(x, b)| *x -= b);
        }
        None
    }
}
