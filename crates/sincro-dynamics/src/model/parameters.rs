//! Parameters of a compiled model that may change between two steps: masses, gravity, bounds of joint limits, gears,
//! materials of pairs. The structure never changes.

use std::sync::Arc;

use super::{MassProperties, Model};
use crate::ids::BodyId;
use crate::spatial::{Pose, RigidInertia, Sym3, Vec3};

/// The inertia of a body that stands at `pose` in its link, about the link's origin.
pub(crate) fn carried(pose: &Pose<f64>, mass: &MassProperties) -> RigidInertia<f64> {
    let placed = mass.placed(&pose.rot, pose.pos);
    RigidInertia::from_center_of_mass(placed.mass, Vec3(placed.center_of_mass), &Sym3(placed.inertia))
}

impl Model<f64> {
    /// Sets the mass properties of a link from those of its bodies: all of them, by their index among the frames of the
    /// names and in that order. Gives the same bits as a model built with them.
    pub(crate) fn set_mass_properties(&mut self, link: usize, bodies: &[(BodyId, MassProperties)]) {
        let names = Arc::make_mut(&mut self.names);
        let mut sum = RigidInertia::zero();
        for (body, mass) in bodies {
            let info = &mut names.frames[body.index()];
            sum = sum.plus(&carried(&info.pose, mass));
            info.body = Some((mass.center_of_mass, mass.mass));
        }
        self.links[link].inertia = sum;
    }

    /// Copies the parameters of `other`, a model of the same structure: inertias, gravity, names and constraints.
    /// Motors and springs stay.
    pub fn copy_parameters_from(&mut self, other: &Self) {
        for (own, new) in self.links.iter_mut().zip(&other.links) {
            own.inertia = new.inertia;
        }
        self.gravity = other.gravity;
        self.names = Arc::clone(&other.names);
        self.constraints = Arc::clone(&other.constraints);
    }
}
