//! Bodies: mass, velocity of the centre of mass, forces for the coming step.

use sincro_dynamics::actuation::ExternalForce;
use sincro_dynamics::joint::JointKind;
use sincro_dynamics::kinematics::Attached;
use sincro_dynamics::model::MassProperties;
use sincro_dynamics::spatial::{Pose, Vec3};

use super::registry::{Handle, Kind};
use super::{ApiError, SimApi};

impl SimApi<'_> {
    /// Mass `[kg]`, centre of mass `[m]` and inertia about it `[kg·m²]` of a body, in the axes of the body's frame.
    ///
    /// # Errors
    ///
    /// `handle` is no object of the registry, or is no body (a runtime shape has no mass); the message names it.
    pub fn mass(&self, handle: Handle) -> Result<MassProperties, ApiError> {
        let entry = self.registry.entry(handle)?;
        match entry.kind {
            Kind::Body(mass) => Ok(mass),
            Kind::Shape => Err(ApiError(format!("`{}` has no mass: {}", entry.path, super::parameters::STATIC))),
            _ => Err(ApiError(format!("`{}` is no body", entry.path))),
        }
    }

    /// The body's frame moved to its centre of mass.
    fn center(&self, handle: Handle) -> Result<Attached<f64>, ApiError> {
        let mass = self.mass(handle)?;
        let frame = self.registry.entry(handle)?.frame;
        Ok(Attached { pose: frame.pose.compose(&Pose::translation(Vec3(mass.center_of_mass))), ..frame })
    }

    /// Velocity of a body's centre of mass `[m/s]` and its angular velocity `[rad/s]`, in this order, both as x, y, z
    /// in world axes.
    ///
    /// # Errors
    ///
    /// `handle` is no object of the registry, or is no body; the message names it.
    pub fn center_velocity(&mut self, handle: Handle) -> Result<([f64; 3], [f64; 3]), ApiError> {
        let center = self.center(handle)?;
        let twist = self.twist(&center);
        Ok((twist.lin.0, twist.ang.0))
    }

    /// Sets one component of the velocity that a body begins with: 0–2 of its centre of mass [m/s], 3–5 of its rotation
    /// [rad/s], world axes. The others stay.
    ///
    /// # Errors
    ///
    /// There is no such body, a run is on, it is not carried by a free joint of its own, or the number is not finite.
    pub(crate) fn set_initial_velocity(
        &mut self,
        handle: Handle,
        component: usize,
        value: f64,
    ) -> Result<(), ApiError> {
        self.mass(handle)?;
        let entry = self.registry.entry(handle)?.clone();
        if self.is_running() {
            return Err(ApiError(format!(
                "`{}`: an initial velocity is set while the simulation is stopped",
                entry.path
            )));
        }
        if !value.is_finite() {
            return Err(ApiError(format!("velocity {value} is not finite")));
        }
        let joints = &self.world.model().names().joints;
        let carrier = joints.iter().find(|j| j.kind == JointKind::Free && j.moving.link == entry.frame.link);
        let Some((v_idx, moving)) = carrier.filter(|j| j.base.link.is_none()).map(|j| (j.v_idx, j.moving)) else {
            let help = "set the velocities of the joints that carry it, `initial` in the scene";
            return Err(ApiError(format!("`{}` hangs on no free joint of the world: {help}", entry.path)));
        };
        let (mut v, mut w) = self.center_velocity(handle)?;
        *(if component < 3 { &mut v[component] } else { &mut w[component - 3] }) = value;
        // twist of the joint's moving frame, in its own axes
        let center = self.center(handle)?;
        let (x_wc, x_wm) = (self.place(&center), self.place(&moving));
        let lin = Vec3(v) + Vec3(w).cross(x_wm.pos - x_wc.pos);
        let (ang, lin) = (x_wm.rot.tr_mul_vec(Vec3(w)), x_wm.rot.tr_mul_vec(lin));
        if !ang.0.iter().chain(&lin.0).all(|x| x.is_finite()) {
            return Err(ApiError(format!("velocity {value} is too large")));
        }
        self.world.state.v[v_idx..v_idx + 3].copy_from_slice(&ang.0);
        self.world.state.v[v_idx + 3..v_idx + 6].copy_from_slice(&lin.0);
        self.moved();
        Ok(())
    }

    /// Applies a force `[N]` at a body's centre of mass and a torque `[N·m]` over the coming step of clients, both as
    /// x, y, z in world axes. Forces of several calls add up; they act for that step, and sensors show them at its end.
    ///
    /// # Errors
    ///
    /// `handle` is no object or no body, no run is on (start it first), or a number is not finite.
    pub fn add_force_and_torque(&mut self, handle: Handle, force: [f64; 3], torque: [f64; 3]) -> Result<(), ApiError> {
        let center = self.center(handle)?;
        self.push(&center, Vec3(force), Vec3(torque))
    }

    /// Applies a force `[N]` at a point `[m]` of a body over the coming step of clients, both as x, y, z in the axes of
    /// the body's frame as it stands now. It adds to those of [`SimApi::add_force_and_torque`].
    ///
    /// # Errors
    ///
    /// `handle` is no object or no body, no run is on (start it first), or a number is not finite.
    pub fn add_force(&mut self, handle: Handle, point: [f64; 3], force: [f64; 3]) -> Result<(), ApiError> {
        self.mass(handle)?;
        let frame = self.registry.entry(handle)?.frame;
        let force = self.place(&frame).rot.mul_vec(Vec3(force));
        let at = Attached { pose: frame.pose.compose(&Pose::translation(Vec3(point))), ..frame };
        self.push(&at, force, Vec3::zero())
    }

    fn push(&mut self, at: &Attached<f64>, force: Vec3<f64>, torque: Vec3<f64>) -> Result<(), ApiError> {
        if !self.is_running() {
            return Err(ApiError::new("a force acts over a step: start the simulation first"));
        }
        let numbers = force.0.iter().chain(&torque.0).chain(&at.pose.pos.0);
        if !numbers.copied().all(f64::is_finite) {
            return Err(ApiError::new("a force, torque or point has numbers that are not finite"));
        }
        self.registry.drop_spent_forces(self.world);
        if let Some(link) = at.link {
            self.world.apply_external_force(ExternalForce { link, point: at.pose.pos, force, torque });
        }
        Ok(())
    }
}
