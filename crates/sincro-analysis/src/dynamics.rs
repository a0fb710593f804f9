//! Terms of the equations of motion of a model at given states: `M(q)·v̇ + h(q, v) = τ + τ_passive(q, v)`.
//!
//! For users who need the numbers themselves, and for comparison with other programs. The mass matrix is that of the
//! tree with the armature on its diagonal: loop joints, gears, limits and contacts act as constraints beside it.

use sincro_dynamics::aba::Input;
use sincro_dynamics::crba::mass_matrix;
use sincro_dynamics::kinematics;
use sincro_dynamics::model::Model;
use sincro_dynamics::scratch::Scratch;
use sincro_dynamics::spatial::{Force, Quat};

/// Terms of the equations of motion `M(q) v̇ + h(q, v) = τ` at one state, for comparison with other programs; result of
/// [`equation_terms`]. Lists have one entry per degree of freedom, `n_v`, in the order of the model's velocities.
#[derive(Clone, Debug, PartialEq)]
pub struct EquationTerms {
    /// Mass matrix M with the armature on its diagonal, row by row, `n_v × n_v`: `[kg·m²]` between two revolute degrees
    /// of freedom, `[kg]` between two prismatic ones, `[kg·m]` between one of each.
    pub mass_matrix: Vec<f64>,
    /// Generalized forces τ = M·v̇ + h at the accelerations `v_dot`, without springs and dampers, `n_v`: `[N·m]` or
    /// `[N]`.
    pub inverse_dynamics: Vec<f64>,
    /// Accelerations v̇ under the generalized forces `torque`, without springs and dampers, `n_v`: `[rad/s²]` or
    /// `[m/s²]`.
    pub forward_dynamics: Vec<f64>,
    /// Generalized forces of the joints' springs and dampers, `n_v`: `[N·m]` or `[N]`.
    pub passive: Vec<f64>,
}

/// State and inputs at which [`equation_terms`] evaluates a model; an empty list stands for zeros (for `q`: the model's
/// zero configuration, with unit quaternions). Order and layout are those of [`sincro_dynamics::state::State`].
#[derive(Clone, Debug, Default, PartialEq)]
pub struct EvaluationPoint {
    /// Generalized coordinates, `n_q`: `[rad]`, `[m]`, entries of quaternions dimensionless.
    pub q: Vec<f64>,
    /// Generalized velocities, `n_v`: `[rad/s]` or `[m/s]`.
    pub v: Vec<f64>,
    /// Accelerations for the inverse dynamics, `n_v`: `[rad/s²]` or `[m/s²]`.
    pub v_dot: Vec<f64>,
    /// Generalized forces for the forward dynamics, `n_v`: `[N·m]` or `[N]`.
    pub torque: Vec<f64>,
}

/// Scales the quaternions of ball and free joints among coordinates (n_q) to length 1.
///
/// # Errors
///
/// One that is zero is no rotation: a sentence.
pub fn normalize_quaternions(model: &Model<f64>, q: &mut [f64]) -> Result<(), String> {
    for joint in model.names().joints.iter().filter(|joint| joint.n_q > joint.n_v) {
        let own = &mut q[joint.q_idx + joint.n_q - 4..joint.q_idx + joint.n_q];
        let square: f64 = own.iter().map(|x| x * x).sum();
        if !(square > 0.0 && square.is_finite()) {
            return Err(format!("the quaternion of `{}` is zero, or too large: it is no rotation", joint.name));
        }
        // one that has been normalized keeps its bits
        if (square - 1.0).abs() > 1e-12 {
            Quat::from_slice(own).normalized().write(own);
        }
    }
    Ok(())
}

/// Evaluates mass matrix, inverse dynamics, forward dynamics and passive forces of a model at one point, with gravity
/// and in SI units. Loop joints, gears, limits and contacts are left out.
///
/// # Errors
///
/// A message with the name of the list whose length is not `n_q` or `n_v` (`q`, `v`, `a` for `v_dot`, `tau` for
/// `torque`) and both numbers.
///
/// ```
/// use sincro_analysis::dynamics::{EvaluationPoint, equation_terms};
/// use sincro_scene::scene::from_text;
///
/// let scene = from_text(r#"
///     joint = [{ name = "h", kind = "revolute", axis = [0.0, 1.0, 0.0] }]
///     [[body]]
///     name = "bob"
///     parent = "/h"
///     position = [0.5, 0.0, 0.0]
///     density = 1000.0
///     shape = [{ sphere = { radius = 0.1 } }]
/// "#).unwrap();
/// let at = EvaluationPoint { q: vec![0.3], v: vec![2.0], ..EvaluationPoint::default() };
/// let terms = equation_terms(&scene.model, &at).unwrap();
/// // without torque M v̇ + h = 0; the inverse dynamics at v̇ = 0 is h
/// assert!((terms.mass_matrix[0] * terms.forward_dynamics[0] + terms.inverse_dynamics[0]).abs() < 1e-12); // [N·m]
/// ```
pub fn equation_terms(model: &Model<f64>, at: &EvaluationPoint) -> Result<EquationTerms, String> {
    if model.gravity_field().is_some() {
        return Err("gravity depends on the position, which these terms do not have".into());
    }
    let (n_q, n_v) = (model.n_q(), model.n_v());
    let filled = |name: &str, list: &[f64], zero: Vec<f64>| match list.len() {
        0 => Ok(zero),
        n if n == zero.len() => Ok(list.to_vec()),
        n => Err(format!("`{name}` has {n} numbers, the model has {}", zero.len())),
    };
    let zeros = || vec![0.0; n_v];
    let mut q = filled("q", &at.q, sincro_dynamics::state::State::new(model).q)?;
    normalize_quaternions(model, &mut q)?;
    debug_assert_eq!(q.len(), n_q);
    let (v, v_dot) = (filled("v", &at.v, zeros())?, filled("a", &at.v_dot, zeros())?);
    let torque = filled("tau", &at.torque, zeros())?;
    let armature: Vec<f64> = model.dofs().iter().map(|dof| dof.armature).collect();
    let mut scratch = Scratch::new(model);
    let mut mass = vec![0.0; n_v * n_v];
    mass_matrix(model, &q, &mut scratch, &mut mass);
    let mut inverse = zeros();
    model.inverse_dynamics(&q, &v, &v_dot, None, &mut scratch, &mut inverse);
    for k in 0..n_v {
        inverse[k] += armature[k] * v_dot[k];
    }
    let input =
        Input { q: &q, v: &v, torque: &torque, diagonal: &armature, prescribed: None, external: None, gravity: true };
    let mut forward = zeros();
    model.forward_dynamics(&input, &mut scratch, &mut forward);
    let mut passive = zeros();
    for joint in &model.names().joints {
        for k in 0..joint.n_v {
            let i = joint.v_idx + k;
            passive[i] = model.spring_torque(i, &q) + model.damping_torque(i, &q, &v);
        }
    }
    add_path_forces(model, (&q, &v), &mut scratch, &mut passive);
    Ok(EquationTerms { mass_matrix: mass, inverse_dynamics: inverse, forward_dynamics: forward, passive })
}

/// Adds the generalized forces of springs and dampers between points, of tendons, bushings and elastic gears,
/// without those of actuators.
fn add_path_forces(model: &Model<f64>, (q, v): (&[f64], &[f64]), scratch: &mut Scratch<f64>, passive: &mut [f64]) {
    let zeros = vec![0.0; v.len()];
    kinematics::motions(model, q, v, &zeros, scratch);
    let mut wrenches = vec![Force::zero(); model.links().len()];
    for element in model.spring_dampers() {
        let motion = |link: usize| (scratch.twist(link), scratch.link_poses()[link]);
        let path = element.length(q, v, motion);
        let forces = element.forces(path.length, path.rate, &vec![0.0; model.n_commands()]);
        let force = forces.elastic + forces.damping;
        for share in element.shares() {
            passive[share.dof] += share.coefficient * force;
        }
        for segment in element.segments() {
            let line = segment.line(motion);
            for (end, at) in segment.ends.iter().enumerate() {
                if let Some(link) = at.link {
                    wrenches[link] += segment.wrench(end, &line, force, &scratch.link_poses()[link]);
                }
            }
        }
    }
    for bushing in model.bushings() {
        let at = bushing.motion(|link| (scratch.twist(link), scratch.link_poses()[link]));
        let force = bushing.force(&at);
        for (end, frame) in bushing.ends.iter().enumerate() {
            if let Some(link) = frame.link {
                wrenches[link] += bushing.wrench(end, &at, &force, &scratch.link_poses()[link]);
            }
        }
    }
    for gear in model.elastic_gears() {
        let (x, rate) = gear.error(q, v);
        let torque = gear.torque(x, rate);
        passive[gear.dofs[1]] += torque;
        passive[gear.dofs[0]] -= gear.ratio * torque;
    }
    // Σ Jᵀ W: what is less to be done with them than without
    let (mut without, mut with) = (zeros.clone(), zeros.clone());
    model.inverse_dynamics(q, v, &zeros, None, scratch, &mut without);
    model.inverse_dynamics(q, v, &zeros, Some(&wrenches), scratch, &mut with);
    for (passive, (without, with)) in passive.iter_mut().zip(without.iter().zip(&with)) {
        *passive += without - with;
    }
}
