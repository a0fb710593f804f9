//! The operating point: where a run is at some time.

use super::lens::{EquationSource, Lens};
use super::names::Names;
use sincro_scene::diagnostic::{Diagnostic, Located};
use sincro_sim::load::Loaded;
use sincro_sim::run::{LockStep, method_for};

/// Choice of inputs, outputs and loop for [`linearize`](super::linearize); the default is the open loop from all motor
/// commands to all coordinates.
///
/// ```
/// use sincro_analysis::prelude::*;
/// use sincro_sim::prelude::*;
///
/// # fn main() -> Result<(), Box<dyn std::error::Error>> {
/// let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/../../scenes/cart-pole-lqr");
/// let loaded = load(folder.as_ref(), &[], Extensions::default())?;
/// let start = operating_point(&loaded, 0.0).map_err(Diagnostics::from)?;
/// // the pole falls by itself; with the diagram in the loop it is balanced
/// let open = linearize(&loaded, &start, &Request::default())?.system;
/// assert_eq!(open.stability(), Stability::Unstable);
/// # Ok(())
/// # }
/// ```
#[derive(Clone, Debug, Default)]
pub struct Request {
    /// Names of the inputs in their order: commands of motors (`/joint.command`, or the joint's path) or signals of the
    /// diagram, to which the input is added. Empty: all motor commands that have a unit and that the diagram does not
    /// give.
    pub inputs: Vec<Located<String>>,
    /// Names of the outputs in their order, recorded signals such as `/joint.position`. Empty: all coordinates.
    pub outputs: Vec<Located<String>>,
    /// True: the continuous blocks of the diagram are in the loop. False: commands are held.
    pub is_closed: bool,
}

/// Runs a scene from its start to the tick nearest to `t` `[s]` and latches the commands that hold from there on: the
/// point for [`linearize`](super::linearize) and [`trim`](super::trim).
///
/// # Errors
///
/// A message that the run stops before `t`, or that `t` is negative, not finite or beyond 10¹² steps.
///
/// ```
/// use sincro_analysis::prelude::*;
/// use sincro_sim::prelude::*;
///
/// # fn main() -> Result<(), Box<dyn std::error::Error>> {
/// let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/../../scenes/acrobot");
/// let loaded = load(folder.as_ref(), &[], Extensions::default())?;
/// let at = operating_point(&loaded, 0.5).map_err(Diagnostics::from)?;
/// assert_eq!((at.tick(), at.t()), (10, 0.5)); // steps of 50 ms
/// assert!(operating_point(&loaded, -1.0).is_err());
/// # Ok(())
/// # }
/// ```
pub fn operating_point(loaded: &Loaded, t: f64) -> Result<LockStep, Diagnostic> {
    let n = (t / loaded.experiment.step).round();
    if !(0.0..1e12).contains(&n) {
        let diagnostic = Diagnostic::without_location(format!("there is no operating point at {t} s"));
        return Err(diagnostic.with_help("give a time from 0 on"));
    }
    let (method, _) = method_for(loaded);
    let mut run = LockStep::new(loaded, method, false);
    let mut go = run.start();
    for _ in 0..n as u64 {
        if go.is_err() {
            break;
        }
        go = run.advance();
    }
    if go.is_err() {
        let diagnostic = Diagnostic::without_location(format!("the run stops before {t} s, at {} s", run.t()));
        return Err(diagnostic.with_help("`sincro run` says why"));
    }
    run.latch();
    Ok(run)
}

/// Settles a copy of a run in its present state: contacts and limits are found, drives and contacts take their modes,
/// ideal motors have their velocities.
pub(super) fn settle(loaded: &Loaded, at: &LockStep, names: &Names) -> LockStep {
    let mut settled = at.fork().lockstep;
    initialize(&mut settled);
    let mut lens = Lens::<f64>::new(loaded, &mut settled, names);
    let rest = vec![0.0; lens.n_full() + lens.n_inputs()];
    let n_v = lens.n_v();
    let base = lens.evaluate(&rest, None);
    let mut change = rest.clone();
    for lock in lens.locks().to_vec() {
        let source = EquationSource::Drive(lock.drive);
        let missing = base.equations.iter().find(|e| e.source == source).map_or(0.0, |e| -e.rate);
        if missing != 0.0 {
            // the velocities jump by an impulse on the joint
            let with = lens.evaluate(&rest, Some((lock.dof, 1.0)));
            let without = lens.evaluate(&rest, Some((lock.dof, 0.0)));
            for k in n_v..2 * n_v {
                change[k] += missing * (with.rates[k] - without.rates[k]);
            }
        }
    }
    if change.iter().any(|x| *x != 0.0) {
        let (state, _) = lens.displaced(&change);
        settled.set_state(state, &[]);
        initialize(&mut settled);
    }
    settled
}

/// Chooses the independent equations of loops in the state that a run is in: those of its start can be dependent here.
pub(super) fn select_loop_equations(run: &mut LockStep) {
    let q = run.state().q.clone();
    run.world().mechanism().select_loop_rows(&q);
}

/// Finds the modes of drives and contacts and the equations of loops in the state that a run is in.
pub(super) fn initialize(run: &mut LockStep) {
    let t = run.t();
    select_loop_equations(run);
    let commands = run.state().commands.clone();
    match run.control().filter(|control| control.is_continuous()).cloned() {
        Some(mut control) => run.world().initialize_with(t, &mut control),
        None => run.world().initialize(t),
    }
    run.world().state.commands = commands;
}
