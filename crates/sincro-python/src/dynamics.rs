//! Terms of the equations of motion, their derivatives, linearisation, trim, import of robots: without Python.

use std::path::Path;

use serde_json::{Map, Value, json};
use sincro::Diagnostics;
use sincro_analysis::dynamics::{EquationTerms, EvaluationPoint, equation_terms};
use sincro_analysis::linear::Axis;
use sincro_analysis::linearize::{self, Linearization, Request, TrimRequest, open_loops, operating_point};
use sincro_dynamics::aba::{Input, forward_dynamics};
use sincro_dynamics::kinematics;
use sincro_dynamics::model::Model;
use sincro_dynamics::scratch::Scratch;
use sincro_dynamics::state::{State, displace};
use sincro_figures::linear::Analysis;
use sincro_import::{Motors, Options, Repair};
use sincro_math::Dual;
use sincro_scene::diagnostic::Diagnostic;
use sincro_scene::record::probe::attached;
use sincro_sim::Loaded;
use sincro_sim::run::LockStep;

use crate::function::located;

/// Terms at a point whose lists have the right lengths; none stands for zeros.
pub fn terms(
    loaded: &Loaded,
    q: Vec<f64>,
    v: Option<Vec<f64>>,
    v_dot: Option<Vec<f64>>,
    torque: Option<Vec<f64>>,
) -> EquationTerms {
    let [v, v_dot, torque] = [v, v_dot, torque].map(Option::unwrap_or_default);
    equation_terms(&loaded.scene.model, &EvaluationPoint { q, v, v_dot, torque }).expect("the lengths were checked")
}

/// Jacobian of a frame, `6 × n_v` row by row: `[ω; ṗ] = J(q)·v`, world axes.
pub fn jacobian(loaded: &Loaded, q: &[f64], frame: usize) -> Vec<f64> {
    let model = &*loaded.scene.model;
    let mut out = vec![0.0; 6 * model.n_v()];
    kinematics::jacobian(model, q, &attached(model, frame), &mut Scratch::new(model), &mut out);
    out
}

/// Derivatives of the forward dynamics by displacements of the coordinates, velocities and torques, `n_v × n_v` each,
/// row by row: exact, by dual numbers.
pub fn forward_derivatives(loaded: &Loaded, q: &[f64], v: &[f64], tau: &[f64]) -> [Vec<f64>; 3] {
    let scalar = &*loaded.scene.model;
    let n = scalar.n_v();
    let model = Model::<Dual<1>>::pack(&[scalar]).expect("one model has one structure");
    let mut scratch = Scratch::new(&model);
    let constants = |numbers: &[f64]| numbers.iter().map(|x| Dual::constant(*x)).collect::<Vec<Dual<1>>>();
    let diagonal: Vec<Dual<1>> = scalar.dofs().iter().map(|dof| Dual::constant(dof.armature)).collect();
    let mut out = [vec![0.0; n * n], vec![0.0; n * n], vec![0.0; n * n]];
    for (which, matrix) in out.iter_mut().enumerate() {
        for column in 0..n {
            let mut at = [vec![0.0; n], v.to_vec(), tau.to_vec()].map(|numbers| constants(&numbers));
            at[which][column] = Dual::variable(at[which][column].value, 0);
            let [change, v, torque] = at;
            let mut moved = constants(q);
            displace(&model, &constants(q), &change, &mut moved);
            let input = Input {
                q: &moved,
                v: &v,
                torque: &torque,
                diagonal: &diagonal,
                prescribed: None,
                external: None,
                gravity: true,
            };
            let mut v_dot = constants(&vec![0.0; n]);
            forward_dynamics(&model, &input, &mut scratch, &mut v_dot);
            for (row, acceleration) in v_dot.iter().enumerate() {
                matrix[row * n + column] = acceleration.partials[0];
            }
        }
    }
    out
}

/// Request of a linearisation.
pub struct LinearRequest {
    /// Inputs; empty: all commands of motors that are not ideal.
    pub inputs: Vec<String>,
    /// Outputs; empty: all coordinates.
    pub outputs: Vec<String>,
    /// True if the continuous blocks of the diagram are in the loop.
    pub closed_loop: bool,
    /// True if an equilibrium is found first.
    pub equilibrium: bool,
}

/// JSON of the system, then states, inputs, outputs and rates at the operating point, and notes.
type Linear = (String, [Vec<f64>; 4], Vec<String>);

/// Linearises where a run is at a time.
pub fn linearize_at(loaded: &Loaded, t: f64, request: &LinearRequest) -> Result<Linear, Diagnostics> {
    about(loaded, operating_point(loaded, t)?, request)
}

/// Linearises where a run is now.
pub fn linearize(loaded: &Loaded, at: &mut LockStep, request: &LinearRequest) -> Result<Linear, Diagnostics> {
    let mut at = at.fork().lockstep;
    at.latch();
    about(loaded, at, request)
}

fn about(loaded: &Loaded, mut at: LockStep, request: &LinearRequest) -> Result<Linear, Diagnostics> {
    let is_closed = request.closed_loop;
    if request.equilibrium {
        at = linearize::trim(loaded, &at, &TrimRequest { is_closed, ..TrimRequest::default() })?.at;
    }
    let (inputs, outputs) = (located("inputs", &request.inputs), located("outputs", &request.outputs));
    let found: Linearization = linearize::linearize(loaded, &at, &Request { inputs, outputs, is_closed })?;
    let analysis = Analysis::of(format!("{}, linearised", loaded.experiment.title), &found.system);
    let text = sincro::linearization::json(&analysis, Some(&found.reduction));
    Ok((text, [found.state, found.input, found.output, found.rate], found.notes))
}

/// JSON of the scene with its sampled controller, from one period of all sample times to the next, with the margins of
/// the loops that are opened at some signals; about where a fresh run is at a time.
pub fn sampled_at(loaded: &Loaded, t: f64, equilibrium: bool, loops: &[String]) -> Result<String, Diagnostics> {
    sampled_about(loaded, operating_point(loaded, t)?, equilibrium, loops)
}

/// The same about where a run is now.
pub fn sampled(loaded: &Loaded, at: &LockStep, equilibrium: bool, loops: &[String]) -> Result<String, Diagnostics> {
    let mut at = at.fork().lockstep;
    at.latch();
    sampled_about(loaded, at, equilibrium, loops)
}

fn sampled_about(
    loaded: &Loaded,
    mut at: LockStep,
    equilibrium: bool,
    loops: &[String],
) -> Result<String, Diagnostics> {
    if equilibrium {
        at = linearize::trim(loaded, &at, &TrimRequest::default())?.at;
    }
    let loops = open_loops(loaded, &at, &located("loops", loops))?;
    let found = linearize::linearize_sampled(loaded, &at)?;
    let title = format!("{}, sampled loop", loaded.experiment.title);
    Ok(sincro::linearization::json(&Analysis::of(title, &found.system).with_loops(&loops), None))
}

/// Request of a trim.
pub struct WantedTrim {
    /// Commands that may be changed.
    pub free: Vec<String>,
    /// Signals and the values that they must have.
    pub want: Vec<(String, f64)>,
    /// True if the diagram is in the loop.
    pub closed_loop: bool,
}

/// JSON of the equilibrium near a state, and the state of the world there.
pub fn trim(loaded: &Loaded, from: &LockStep, request: &WantedTrim) -> Result<(String, State<f64>), Diagnostics> {
    let mut from = from.fork().lockstep;
    from.latch();
    let names: Vec<String> = request.want.iter().map(|(name, _)| name.clone()).collect();
    let values = request.want.iter().map(|(_, value)| *value);
    let wanted = located("want", &names).into_iter().zip(values).collect();
    let request = TrimRequest { free: located("free", &request.free), wanted, is_closed: request.closed_loop };
    let found = linearize::trim(loaded, &from, &request)?;
    let table = |list: &[(Axis, f64)]| -> Value {
        let entries = list.iter().map(|(axis, x)| (axis.name.clone(), json!(x)));
        Value::Object(entries.collect::<Map<_, _>>())
    };
    let initial = found.trim.initial.iter().map(|(joint, q)| (joint.clone(), json!(q)));
    let text = json!({
        "states": table(&found.trim.states),
        "initial": Value::Object(initial.collect::<Map<_, _>>()),
        "inputs": table(&found.trim.inputs),
        "outputs": table(&found.trim.outputs),
        "largest_rate": found.trim.residual,
        "iterations": found.trim.iterations,
    });
    Ok((text.to_string(), found.at.state().clone()))
}

/// Imports a robot file into a folder that is absent or empty; returns the report as JSON and the warnings.
pub fn import(robot: &Path, folder: &Path, options: &ImportRequest) -> Result<(String, Vec<String>), Diagnostics> {
    let refuse = |message: String| Diagnostics::from(Diagnostic::without_location(message));
    if std::fs::read_dir(folder).is_ok_and(|mut entries| entries.next().is_some()) {
        let found = Diagnostic::without_location(format!("the folder `{}` is not empty", folder.display()));
        return Err(found.with_help("name a folder that is absent or empty").into());
    }
    let mut repairs = Vec::new();
    for word in &options.repairs {
        let known = Repair::ALL.into_iter().find(|repair| repair.word() == word);
        let names = Repair::ALL.map(Repair::word).join(", ");
        repairs.push(known.ok_or_else(|| refuse(format!("there is no repair `{word}`; there are: {names}")))?);
    }
    let motors = match options.motors.as_str() {
        "hold" => Motors::Hold,
        "torque" => Motors::Torque,
        "none" => Motors::None,
        other => return Err(refuse(format!("`{other}` is no drive of joints; there are: hold, torque, none"))),
    };
    let package_paths = options.package_paths.iter().map(Into::into).collect();
    let (free_base, merge_fixed) = (options.free_base, options.merge_fixed);
    let options = Options { package_paths, free_base, motors, repairs, merge_fixed };
    let imported = sincro_import::import(robot, &options)?;
    let written = imported.write(folder);
    written.map_err(|error| refuse(format!("`{}` cannot be written: {error}", folder.display())))?;
    Ok((imported.report.json(), imported.warnings.iter().map(ToString::to_string).collect()))
}

/// Settings of an import.
pub struct ImportRequest {
    /// True if the base of the robot moves freely.
    pub free_base: bool,
    /// `hold`, `torque` or `none`.
    pub motors: String,
    /// Names of repairs that may be made.
    pub repairs: Vec<String>,
    /// Folders in which packages are searched.
    pub package_paths: Vec<String>,
    /// True if links on fixed joints become parts of what carries them.
    pub merge_fixed: bool,
}
