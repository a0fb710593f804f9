//! The joint-space mass matrix.
//!
//! Composite-rigid-body algorithm. Source: key `featherstone2008`, section 6.2, table 6.2. Cost: links × depth. For
//! analysis; no step needs it.

use sincro_math::Real;

use crate::joint::{Link, Stage, StageVisitor};
use crate::model::Model;
use crate::recursions::kinematics;
use crate::scratch::Scratch;
use crate::spatial::{Force, RigidInertia};

/// Mass matrix M(q) at coordinates `q` (`n_q`) by the composite-rigid-body algorithm, armature included: `mass`
/// (`n_v × n_v`) is written row by row, in `[kg·m²]` between rotations, `[kg·m]` between a rotation and a translation,
/// `[kg]` between translations.
///
/// ```
/// use sincro_dynamics::crba::mass_matrix;
/// use sincro_dynamics::prelude::*;
/// use sincro_dynamics::scratch::Scratch;
///
/// # let mut builder = ModelBuilder::new([0.0, 0.0, -9.81]);
/// # let hinge = JointSpec::new(JointKind::Revolute { axis: [0.0, 1.0, 0.0] });
/// # let hinge = builder.joint("hinge", NodeId::WORLD, Pose::identity(), hinge);
/// # let mass = MassProperties { mass: 2.0, center_of_mass: [0.0, 0.0, -0.5], inertia: [0.0; 6] };
/// # builder.body("bob", hinge, Pose::identity(), BodySpec { mass });
/// # let model = builder.build()?.0;
/// // a pendulum, 2 kg at 0.5 m from its hinge: m l²
/// let mut mass = vec![0.0; model.n_v() * model.n_v()];
/// mass_matrix(&model, &[0.3], &mut Scratch::new(&model), &mut mass);
/// assert!((mass[0] - 2.0 * 0.5 * 0.5).abs() < 1e-15); // [kg·m²]
/// # Ok::<(), BuildError>(())
/// ```
pub fn mass_matrix<R: Real>(model: &Model<R>, q: &[R], scratch: &mut Scratch<R>, mass: &mut [R]) {
    let n = model.n_v();
    mass.fill(R::zero());
    kinematics::place(model, q, scratch);
    scratch.composite.copy_from_slice(&model.params.inertias);
    for i in (0..model.links.len()).rev() {
        let link = &model.links[i];
        if let Some(parent) = link.parent() {
            let seen =
                link.kind.dispatch(RigidToParent { link, at: &scratch.links[i].at, inertia: &scratch.composite[i] });
            scratch.composite[parent] = scratch.composite[parent].plus(&seen);
        }
        for j in 0..link.kind.n_v() {
            column(model, scratch, (i, j), n, mass);
        }
    }
    for (k, dof) in model.dofs.iter().enumerate() {
        mass[k * n + k] += dof.armature;
    }
}

/// The column of degree of freedom `j` of link `i`, and by symmetry its row.
fn column<R: Real>(model: &Model<R>, scratch: &Scratch<R>, (i, j): (usize, usize), n: usize, mass: &mut [R]) {
    let link = &model.links[i];
    let col = link.v_idx as usize + j;
    // F = I S_j, then down the tree: H_ji = F · S_k
    let mut force = link.kind.dispatch(Column { link, j, inertia: &scratch.composite[i] });
    let mut at = i;
    loop {
        let carrier = &model.links[at];
        for k in 0..carrier.kind.n_v() {
            let row = carrier.v_idx as usize + k;
            let h = carrier.kind.dispatch(Project { link: carrier, j: k, force: &force });
            mass[row * n + col] = h;
            mass[col * n + row] = h;
        }
        let Some(parent) = carrier.parent() else { return };
        force = carrier.kind.dispatch(ForceToParent { link: carrier, at: &scratch.links[at].at, force: &force });
        at = parent;
    }
}

struct RigidToParent<'a, R> {
    link: &'a Link<R>,
    at: &'a crate::joint::Placement<R>,
    inertia: &'a RigidInertia<R>,
}

impl<R: Real> StageVisitor for RigidToParent<'_, R> {
    type Number = R;
    type Output = RigidInertia<R>;
    fn visit<S: Stage>(self) -> Self::Output {
        self.link.rigid_to_parent::<S>(self.at, self.inertia)
    }
}

struct Column<'a, R> {
    link: &'a Link<R>,
    j: usize,
    inertia: &'a RigidInertia<R>,
}

impl<R: Real> StageVisitor for Column<'_, R> {
    type Number = R;
    type Output = Force<R>;
    fn visit<S: Stage>(self) -> Self::Output {
        let rate = self.link.signed::<S>(R::one());
        self.inertia.mul(&S::column(self.link, self.j, rate))
    }
}

struct Project<'a, R> {
    link: &'a Link<R>,
    j: usize,
    force: &'a Force<R>,
}

impl<R: Real> StageVisitor for Project<'_, R> {
    type Number = R;
    type Output = R;
    fn visit<S: Stage>(self) -> R {
        self.link.signed::<S>(S::project(self.link, self.j, self.force))
    }
}

struct ForceToParent<'a, R> {
    link: &'a Link<R>,
    at: &'a crate::joint::Placement<R>,
    force: &'a Force<R>,
}

impl<R: Real> StageVisitor for ForceToParent<'_, R> {
    type Number = R;
    type Output = Force<R>;
    fn visit<S: Stage>(self) -> Force<R> {
        self.link.force_to_parent::<S>(self.at, self.force)
    }
}
