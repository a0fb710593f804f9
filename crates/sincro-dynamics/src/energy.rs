//! Energies and momentum of all bodies.

use sincro_math::{Real, Task};

use crate::actuation::{GravityField, spring};
use crate::model::Model;
use crate::recursions::kinematics;
use crate::scratch::Scratch;
use crate::spatial::{Force, Pose, RigidInertia, Vec3};

/// Mechanical energy of a mechanism `[J]`: kinetic, and potential of gravity and springs.
///
/// ```
/// use sincro_dynamics::prelude::*;
///
/// let mut builder = ModelBuilder::new([0.0, 0.0, -9.81]);
/// let slide = JointSpec::new(JointKind::Prismatic { axis: [0.0, 0.0, 1.0] });
/// let slide = builder.joint("slide", NodeId::WORLD, Pose::translation(Vec3([0.0, 0.0, 3.0])), slide);
/// let mass = MassProperties { mass: 2.0, center_of_mass: [0.0; 3], inertia: [0.01, 0.0, 0.0, 0.01, 0.0, 0.01] };
/// builder.body("hammer", slide, Pose::identity(), BodySpec { mass });
/// let (model, _warnings) = builder.build()?;
/// let slide = model.names().joint_id("slide").unwrap();
/// let energy = World::builder(model).velocities(slide, &[-5.0]).build()?.energy();
/// assert!((energy.kinetic - 0.5 * 2.0 * 25.0).abs() < 1e-12); // m v²/2 [J]
/// assert!((energy.potential - 2.0 * 9.81 * 3.0).abs() < 1e-12); // m g z [J]
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Energy<R> {
    /// Kinetic energy ½ vᵀ M v `[J]`, armature included.
    pub kinetic: R,
    /// Potential energy `[J]`: of gravity, zero at the world's origin, of springs, zero at rest, and, if
    /// [added](Energy::with_stored), of the magnetic fields of windings.
    pub potential: R,
}

impl<R: Real> Energy<R> {
    /// Sum of kinetic and potential energy `[J]`.
    #[inline(always)]
    pub fn total(&self) -> R {
        self.kinetic + self.potential
    }

    /// This energy with `stored` `[J]` of other elements added to the potential energy.
    #[must_use]
    #[inline(always)]
    pub fn with_stored(self, stored: R) -> Self {
        Self { potential: self.potential + stored, ..self }
    }
}

/// Energy `[J]` at the coordinates `q` (n_q) and velocities `v` (n_v); `scratch` must hold [`kinematics::motions`] of
/// the same state.
pub fn energy<R: Real>(model: &Model<R>, q: &[R], v: &[R], scratch: &Scratch<R>) -> Energy<R> {
    R::run_lanes(FindEnergy { model, q, v, scratch })
}

/// Task of [`energy`].
struct FindEnergy<'a, R> {
    model: &'a Model<R>,
    q: &'a [R],
    v: &'a [R],
    scratch: &'a Scratch<R>,
}

impl<R: Real> Task for FindEnergy<'_, R> {
    type Output = Energy<R>;

    #[inline(always)]
    fn run(self) -> Energy<R> {
        let Self { model, q, v, scratch } = self;
        let half = R::splat(0.5);
        let mut e = Energy { kinetic: R::zero(), potential: R::zero() };
        for (i, inertia) in model.params.inertias.iter().enumerate() {
            let twist = &scratch.links[i].v;
            e.kinetic += half * twist.dot(&inertia.mul(twist));
            e.potential += gravity_energy(model.params.gravity, inertia, &scratch.poses[i]);
        }
        if let Some(field) = &model.gravity_field {
            e.potential += field_energy(model, field, &scratch.poses);
        }
        for (k, dof) in model.dofs.iter().enumerate() {
            e.kinetic += half * dof.armature * v[k] * v[k];
            if model.has_scalar_coordinate(k) {
                e.potential += spring::energy(dof, q[dof.q_idx as usize]);
            }
        }
        for spring in &model.nonlinear_springs {
            let dof = &model.dofs[spring.dof];
            e.potential += spring.law.potential(q[dof.q_idx as usize] - dof.rest);
        }
        for gear in &model.elastic_gears {
            e.potential += gear.energy(gear.error(q, v).0);
        }
        for element in &model.spring_dampers {
            let at = element.length(q, v, |link| (scratch.links[link].v, scratch.poses[link]));
            e.potential += element.potential(at.length);
        }
        for bushing in &model.bushings {
            e.potential += bushing.potential(&bushing.motion(|link| (scratch.links[link].v, scratch.poses[link])));
        }
        for &link in &model.sprung {
            let link = &model.links[link];
            e.potential += spring::stored_energy(link, &model.dofs[link.v_idx as usize..], q);
        }
        e
    }
}

/// Potential energy −m g·c `[J]` of a link whose frame stands at `pose` in the world; zero at the world's origin.
#[inline(always)]
fn gravity_energy<R: Real>(gravity: Vec3<R>, inertia: &RigidInertia<R>, pose: &Pose<R>) -> R {
    let first_moment = pose.rot.mul_vec(inertia.moment) + pose.pos.scale(inertia.mass);
    -gravity.dot(first_moment)
}

/// Potential energy m U(p) `[J]` of all bodies in a gravity field, after kinematics; zero without a potential.
#[inline(always)]
fn field_energy<R: Real>(model: &Model<R>, field: &GravityField, poses: &[Pose<R>]) -> R {
    let Some(potential) = &field.potential else { return R::zero() };
    let mut sum = R::zero();
    for (mass, link, center) in model.centers_of_mass() {
        sum += mass * potential.at(poses[link].point(center).0);
    }
    sum
}

/// Momentum of all bodies about the world's origin, in world axes: angular `[kg·m²/s]`, linear `[kg·m/s]`; armature
/// left out. `scratch` must hold [`kinematics::motions`].
#[inline(always)]
pub fn momentum<R: Real>(model: &Model<R>, scratch: &Scratch<R>) -> Force<R> {
    let mut sum = Force::zero();
    for (i, inertia) in model.params.inertias.iter().enumerate() {
        let h = inertia.mul(&scratch.links[i].v);
        let pose = &scratch.poses[i];
        let lin = pose.rot.mul_vec(h.lin);
        sum.ang += pose.rot.mul_vec(h.ang) + pose.pos.cross(lin);
        sum.lin += lin;
    }
    sum
}

/// Mechanical energy `[J]` at coordinates `q` (n_q) and velocities `v` (n_v); recomputes the kinematics of that state
/// in `scratch`.
#[must_use]
pub fn energy_at(model: &Model<f64>, q: &[f64], v: &[f64], scratch: &mut Scratch<f64>) -> Energy<f64> {
    kinematics::motions(model, q, v, v, scratch);
    energy(model, q, v, scratch)
}
