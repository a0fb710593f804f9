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

/// Mass matrix at `q`, row by row into `mass` (`n_v × n_v`, [kg·m²] between rotations), armature on its diagonal.
pub fn mass_matrix<R: Real>(model: &Model<R>, q: &[R], scratch: &mut Scratch<R>, mass: &mut [R]) {
    let n = model.n_v();
    mass.fill(R::zero());
    kinematics::place(model, q, scratch);
    for (composite, link) in scratch.composite.iter_mut().zip(&model.links) {
        *composite = link.inertia;
    }
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
    type Output = Force<R>;
    fn visit<S: Stage>(self) -> Force<R> {
        self.link.force_to_parent::<S>(self.at, self.force)
    }
}
