//! Stiffness estimate: rates of springs and dampers, of joints, between points and of bushings, which an explicit
//! method must resolve.
//!
//! For each degree of freedom with stiffness k, damping c and the inertia D that a torque on it meets with everything
//! beyond left free (`joint_inertias` in `recursions/aba.rs`), the rate is that of the faster root of D s² + c s + k
//! = 0. Coupling between joints is neglected, and D changes with the pose.

use crate::actuation::MotorMode;
use crate::actuation::bushing::BushingMotion;
use crate::actuation::spring_damper::{Line, PathLength};
use crate::constraint::implicit_forces::ImplicitForces;
use crate::model::{Attached, Model};
use crate::recursions::aba::AtRest;
use crate::recursions::crba::mass_matrix;
use crate::recursions::kinematics;
use crate::scratch::Scratch;
use crate::state::State;

/// Stability limit of RK4 on the negative real axis: largest |h·λ| (dimensionless), for step h and root λ. Source: key
/// `hairer1996`, section IV.2.
pub const RK4_LIMIT: f64 = 2.785;

/// Element of a [`Stiffness`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum StiffElement {
    /// Spring and damper of the degree of freedom of this index in v.
    Dof(usize),
    /// Spring and damper between two points, or tendon, by its index in [`Model::spring_dampers`].
    SpringDamper(usize),
    /// Elastic gear, by its index in [`Model::elastic_gears`], taken as touching.
    ElasticGear(usize),
    /// Bushing, by its index in [`Model::bushings`]: along or about one of its axes.
    Bushing(usize),
    /// Winding with inductance, by its index in [`Model::windings`]: a spring of stiffness N² k_t k_e/L in series with
    /// a damper of N² k_t k_e/R.
    Winding(usize),
}

/// Element with the fastest dynamics, from [`stiffest`]: the one that limits the step of explicit methods.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stiffness {
    /// Element that it is.
    pub element: StiffElement,
    /// Magnitude of the fastest root of its mass–spring–damper equation `[1/s]`.
    pub rate: f64,
    /// Stiffness `[N·m/rad]` or `[N/m]`.
    pub stiffness: f64,
    /// Damping `[N·m·s/rad]` or `[N·s/m]`.
    pub damping: f64,
    /// Inertia on which it acts, with all else free `[kg·m²]` or `[kg]`.
    pub inertia: f64,
}

impl Stiffness {
    fn new(element: StiffElement, stiffness: f64, damping: f64, inertia: f64) -> Self {
        Self { element, rate: fastest_root(inertia, damping, stiffness), stiffness, damping, inertia }
    }

    /// Description of the element for messages, with the name that the user gave it. `model` must be that of
    /// [`stiffest`].
    #[must_use]
    pub fn element_name(&self, model: &Model<f64>) -> String {
        match self.element {
            StiffElement::Dof(dof) => format!("joint `{}`", model.names().dof_name(dof)),
            StiffElement::Winding(k) => {
                format!("winding of the motor of `{}`", model.names().dof_name(model.windings[k].dof))
            }
            StiffElement::ElasticGear(k) => format!("coupling `{}`", model.names().elastic_gears[k]),
            StiffElement::Bushing(k) => format!("bushing `{}`", model.names().bushings[k]),
            StiffElement::SpringDamper(k) => format!("spring or tendon `{}`", model.names().spring_dampers[k]),
        }
    }
}

/// Fastest spring or damper of `model` at a state, those of spring motors included; `None` if there is none. Joints
/// held by ideal velocity motors are left out.
#[must_use]
pub fn stiffest(model: &Model<f64>, state: &State<f64>) -> Option<Stiffness> {
    StiffnessProbe::new(model).stiffest(model, state)
}

/// Mean inverse mass `[1/kg]` and mean inverse moment of inertia `[1/(kg·m²)]` of a frame at coordinates `q` (n_q): a
/// third of the traces of the translational and the rotational block of J M⁻¹ Jᵀ, J the Jacobian of the frame; of loop
/// joints, springs and contacts all free. Zero for a frame that does not move; not finite where M is singular.
#[must_use]
pub fn mean_inverse_inertias(model: &Model<f64>, q: &[f64], frame: &Attached<f64>) -> [f64; 2] {
    let n = model.n_v();
    let mut scratch = Scratch::new(model);
    let (mut mass, mut rows) = (vec![0.0; n * n], vec![0.0; 6 * n]);
    mass_matrix(model, q, &mut scratch, &mut mass);
    kinematics::jacobian(model, q, frame, &mut scratch, &mut rows);
    // M = L Lᵀ in place; a diagonal entry of J M⁻¹ Jᵀ is ‖L⁻¹ jᵀ‖² of its row j
    for i in 0..n {
        for j in 0..=i {
            let sum = (0..j).fold(mass[i * n + j], |sum, k| sum - mass[i * n + k] * mass[j * n + k]);
            mass[i * n + j] = if i == j { sum.sqrt() } else { sum / mass[j * n + j] };
        }
    }
    let mut squares = [0.0; 6];
    for (row, square) in rows.chunks_exact_mut(n.max(1)).zip(&mut squares) {
        for i in 0..n {
            row[i] = (0..i).fold(row[i], |sum, k| sum - mass[i * n + k] * row[k]) / mass[i * n + i];
            *square += row[i] * row[i];
        }
    }
    let mean = |three: &[f64]| three.iter().sum::<f64>() / 3.0;
    [mean(&squares[3..]), mean(&squares[..3])]
}

/// Working memory of [`stiffest`], for many states of one model without allocation.
#[derive(Clone, Debug)]
pub struct StiffnessProbe {
    scratch: Scratch<f64>,
    at_rest: AtRest,
    forces: Option<Box<ImplicitForces<f64>>>,
    lines: Vec<Line<f64>>,
    lengths: Vec<PathLength<f64>>,
    bushings: Vec<BushingMotion<f64>>,
}

impl StiffnessProbe {
    /// Memory for states of `model`.
    #[must_use]
    pub fn new(model: &Model<f64>) -> Self {
        Self {
            scratch: Scratch::new(model),
            at_rest: AtRest::new(model),
            forces: ImplicitForces::new(model),
            lines: Vec::new(),
            lengths: Vec::with_capacity(model.spring_dampers.len()),
            bushings: Vec::with_capacity(model.bushings.len()),
        }
    }

    /// Fastest spring or damper at a state, as [`stiffest`]; `model` may have other parameters than that of
    /// [`StiffnessProbe::new`], and must have the same structure.
    #[must_use]
    pub fn stiffest(&mut self, model: &Model<f64>, state: &State<f64>) -> Option<Stiffness> {
        let of_lines = self.stiffest_line(model, state);
        if self.forces.is_none() {
            if !has_sprung_joints(model) {
                return None;
            }
            self.at_rest.factor(model, &state.q, &mut self.scratch);
        }
        let joints = (0..model.n_v()).filter_map(|k| stiffness_of_joint(model, state, k, self.scratch.dofs[k].d));
        let windings = (0..model.windings.len()).filter_map(|k| stiffness_of_winding(model, k, &self.scratch));
        of_lines.into_iter().chain(joints).chain(windings).max_by(|a, b| a.rate.total_cmp(&b.rate))
    }

    /// Fastest spring or damper between two points, with everything between them left free; leaves the factors of the
    /// mass matrix.
    fn stiffest_line(&mut self, model: &Model<f64>, state: &State<f64>) -> Option<Stiffness> {
        let Self { scratch, at_rest, forces, lines, lengths, bushings } = self;
        let forces = forces.as_mut()?;
        kinematics::motions(model, &state.q, &state.v, at_rest.zeros(), scratch);
        lines.clear();
        lengths.clear();
        let motion = |link: usize| (scratch.links[link].v, scratch.poses[link]);
        for element in &model.spring_dampers {
            lines.extend(element.segments().iter().map(|segment| segment.line(motion)));
            lengths.push(element.length(&state.q, &state.v, motion));
        }
        bushings.clear();
        bushings.extend(model.bushings.iter().map(|bushing| bushing.motion(motion)));
        at_rest.factor(model, &state.q, scratch);
        forces.place(model, (lines, bushings), scratch, at_rest.zeros());
        let n_rows = ImplicitForces::n_rows(model);
        forces.factor(model, scratch, core::iter::repeat_n(1.0, n_rows), at_rest.zeros());
        let each = model.spring_dampers.iter().zip(lengths.iter()).zip(forces.inverse_inertias()).enumerate();
        let each = each.filter(|(_, (_, inverse))| *inverse > 0.0).map(|(k, ((element, at), inverse))| {
            let (stiffness, damping) = element.implicit_terms(at.length, at.rate);
            Stiffness::new(StiffElement::SpringDamper(k), stiffness, damping, 1.0 / inverse)
        });
        let of_gears = model.elastic_gears.iter().zip(forces.inverse_inertias().skip(lengths.len())).enumerate();
        let of_gears = of_gears.filter(|(_, (_, inverse))| *inverse > 0.0).map(|(k, (gear, inverse))| {
            Stiffness::new(StiffElement::ElasticGear(k), gear.stiffness, gear.damping, 1.0 / inverse)
        });
        let of_bushings = forces.inverse_inertias().skip(lengths.len() + model.elastic_gears.len()).enumerate();
        let of_bushings = of_bushings.filter(|(_, inverse)| *inverse > 0.0).map(|(i, inverse)| {
            let (bushing, k) = (&model.bushings[i / 6], i % 6);
            Stiffness::new(StiffElement::Bushing(i / 6), bushing.stiffness[k], bushing.damping[k], 1.0 / inverse)
        });
        each.chain(of_gears).chain(of_bushings).filter(|s| s.rate > 0.0).max_by(|a, b| a.rate.total_cmp(&b.rate))
    }
}

/// Returns true if a joint may have a spring or damper, spring motors included.
fn has_sprung_joints(model: &Model<f64>) -> bool {
    model.dofs.iter().any(|dof| dof.stiffness != 0.0 || dof.damping != 0.0)
        || !model.nonlinear_springs.is_empty()
        || model.motors().iter().any(|motor| motor.mode == MotorMode::Spring)
        || !model.windings.is_empty()
}

/// Winding with inductance against the inertia of its joint: s² + (R/L) s + N² k_t k_e/(L D) = 0.
fn stiffness_of_winding(model: &Model<f64>, k: usize, scratch: &Scratch<f64>) -> Option<Stiffness> {
    let winding = &model.windings[k];
    winding.state?;
    let held = model.is_held(winding.dof) || model.motors()[winding.motor].mode != MotorMode::Voltage;
    let (inertia, damping) = (scratch.dofs[winding.dof].d, winding.shorted_damping());
    let stiffness = if held { 0.0 } else { damping * winding.resistance / winding.inductance };
    let rate = fastest_root(1.0, winding.resistance / winding.inductance, stiffness / inertia);
    Some(Stiffness { element: StiffElement::Winding(k), rate, stiffness, damping, inertia })
}

/// Spring and damper of degree of freedom `k` on `inertia`, spring motors included; `None` without, and where an ideal
/// velocity motor holds it.
fn stiffness_of_joint(model: &Model<f64>, state: &State<f64>, k: usize, inertia: f64) -> Option<Stiffness> {
    if model.is_held(k) {
        return None;
    }
    let dof = &model.dofs[k];
    let (mut stiffness, mut damping) = (dof.stiffness, dof.damping);
    for spring in model.nonlinear_springs.iter().filter(|spring| spring.dof == k) {
        let x = dof.coordinate_in(&state.q) - dof.rest;
        let (of_x, of_v) = spring.law.negated_partials(x, state.v[k]);
        stiffness += of_x.max(0.0);
        damping += of_v.max(0.0);
    }
    for motor in model.motors().iter().filter(|m| m.dof == k && m.mode == MotorMode::Spring) {
        stiffness += motor.stiffness;
        damping += motor.damping;
    }
    for winding in model.active_windings().filter(|w| w.dof == k && w.state.is_none()) {
        damping += winding.shorted_damping();
    }
    Some(Stiffness::new(StiffElement::Dof(k), stiffness, damping, inertia)).filter(|s| s.rate > 0.0)
}

/// Magnitude of the larger root of D s² + c s + k.
fn fastest_root(inertia: f64, damping: f64, stiffness: f64) -> f64 {
    let half = 0.5 * damping / inertia;
    let discriminant = half * half - stiffness / inertia;
    if discriminant > 0.0 { half + discriminant.sqrt() } else { (stiffness / inertia).sqrt() }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::joint::JointKind;
    use crate::model::{BodySpec, JointSpec, MassProperties, ModelBuilder, NodeId};
    use crate::spatial::{Pose, Vec3};

    /// 3 kg at 0.5 m from a hinge about y, and a slide that carries 2 kg on it at 1 m.
    #[test]
    fn a_frame_on_a_hinge_has_the_inverse_inertias_of_its_lever() {
        let mut builder = ModelBuilder::new([0.0; 3]);
        let hinge = JointSpec::new(JointKind::Revolute { axis: [0.0, 1.0, 0.0] });
        let hinge = builder.joint("hinge", NodeId::WORLD, Pose::identity(), hinge);
        let mass =
            MassProperties { mass: 3.0, center_of_mass: [0.5, 0.0, 0.0], inertia: [0.1, 0.0, 0.0, 0.2, 0.0, 0.3] };
        let arm = builder.body("arm", hinge, Pose::identity(), BodySpec { mass });
        let slide = JointSpec { armature: vec![1.0], ..JointSpec::new(JointKind::Prismatic { axis: [1.0, 0.0, 0.0] }) };
        let slide = builder.joint("slide", arm, Pose::translation(Vec3([1.0, 0.0, 0.0])), slide);
        builder.body(
            "tip",
            slide,
            Pose::identity(),
            BodySpec { mass: MassProperties { mass: 2.0, center_of_mass: [0.0; 3], inertia: [0.0; 6] } },
        );
        let (model, _) = builder.build().unwrap();
        let moment = 0.2 + 3.0 * 0.25 + 2.0;
        let of = |name: &str| {
            let info = model.names().frame(name).unwrap();
            mean_inverse_inertias(&model, &[0.0, 0.0], &Attached { link: info.link, pose: info.pose })
        };
        let close = |a: [f64; 2], b: [f64; 2]| assert!((0..2).all(|k| (a[k] - b[k]).abs() < 1e-15), "{a:?} {b:?}");
        close(of("arm"), [0.0, 1.0 / (3.0 * moment)]);
        close(of("tip"), [(1.0 / moment + 1.0 / 3.0) / 3.0, 1.0 / (3.0 * moment)]);
        let world = Attached { link: None, pose: Pose::identity() };
        close(mean_inverse_inertias(&model, &[0.0, 0.0], &world), [0.0; 2]);
    }

    #[test]
    fn roots_of_an_oscillator_and_of_an_overdamped_one() {
        assert!((fastest_root(2.0, 0.0, 18.0) - 3.0).abs() < 1e-15);
        // s² + 5 s + 4 = (s + 1)(s + 4)
        assert!((fastest_root(1.0, 5.0, 4.0) - 4.0).abs() < 1e-15);
    }
}
