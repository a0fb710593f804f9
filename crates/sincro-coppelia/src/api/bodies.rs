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

    /// One component of the velocity that a body begins with, as [`SimApi::set_initial_velocity`] has set it in this
    /// run; of that which it has if none was set.
    pub(crate) fn initial_velocity(&mut self, handle: Handle, component: usize) -> Result<f64, ApiError> {
        let set = self.registry.initial_velocities.get(&handle).and_then(|given| given[component]);
        let (v, w) = self.center_velocity(handle)?;
        Ok(set.unwrap_or(if component < 3 { v[component] } else { w[component - 3] }))
    }

    /// Sets one component of the velocity that a body begins with: 0–2 of its centre of mass [m/s], 3–5 of its rotation
    /// [rad/s], world axes. While stopped, and until a run has begun (`sysCall_init`), it is that of the start, and the
    /// others stay; in a run it acts when the dynamics of the body are reset in the same step or later
    /// ([`SimApi::reset_dynamics`]). A static body carries others along with it in the coming step (a conveyor belt).
    ///
    /// # Errors
    ///
    /// There is no such body, it is not carried by a free joint of its own, or the number is not finite or too large.
    pub(crate) fn set_initial_velocity(
        &mut self,
        handle: Handle,
        component: usize,
        value: f64,
    ) -> Result<(), ApiError> {
        self.mass(handle)?;
        if !value.is_finite() {
            return Err(ApiError(format!("velocity {value} is not finite")));
        }
        let path = self.registry.entry(handle)?.path.clone();
        if self.own_free_joint(handle)?.is_none() {
            let help = match self.is_fixed(handle)? {
                true if component < 3 => return self.set_belt_velocity(handle, component, value),
                true => "it is fixed in the world: conveyor belts go along a line, they do not turn",
                false => "set the velocities of the joints that carry it, `initial` in the scene",
            };
            return Err(ApiError(format!("`{path}` hangs on no free joint of the world: {help}")));
        }
        if !self.registry.has_begun {
            let (mut v, mut w) = self.center_velocity(handle)?;
            *(if component < 3 { &mut v[component] } else { &mut w[component - 3] }) = value;
            return self.set_free_velocity(handle, v, w);
        }
        let tick = self.world.state.tick;
        match self.registry.resets.get_mut(&handle).filter(|(at, _)| *at == tick) {
            Some((_, given)) => {
                given[component] = value;
                let [vx, vy, vz, wx, wy, wz] = *given;
                self.set_free_velocity(handle, [vx, vy, vz], [wx, wy, wz])
            }
            None => {
                self.registry.initial_velocities.entry(handle).or_default()[component] = Some(value);
                Ok(())
            }
        }
    }

    /// Resets the dynamics of a body on a free joint of its own: it goes on with the velocity that was set for it since
    /// the last reset, components that were not set being zero. The change of its energy counts as work. Nothing if
    /// none was set, or for any other object: the engine has no copies of objects that could be out of date.
    ///
    /// # Errors
    ///
    /// The velocity is too large.
    pub(crate) fn reset_dynamics(&mut self, handle: Handle) -> Result<(), ApiError> {
        self.reset_belt(handle);
        if !self.registry.has_begun {
            return Ok(());
        }
        let tick = self.world.state.tick;
        let reset = self.registry.resets.entry(handle).or_insert((tick, [0.0; 6]));
        if reset.0 != tick {
            *reset = (tick, [0.0; 6]);
        }
        let Some(set) = self.registry.initial_velocities.remove(&handle) else { return Ok(()) };
        for (component, value) in reset.1.iter_mut().zip(set) {
            *component = value.unwrap_or(*component);
        }
        let [vx, vy, vz, wx, wy, wz] = reset.1;
        if self.own_free_joint(handle)?.is_none() {
            return Ok(());
        }
        self.set_free_velocity(handle, [vx, vy, vz], [wx, wy, wz])
    }

    /// Velocity index and moving frame of the free joint of the world that carries a body, if there is one.
    fn own_free_joint(&self, handle: Handle) -> Result<Option<(usize, Attached<f64>)>, ApiError> {
        let link = self.registry.entry(handle)?.frame.link;
        let joints = &self.world.model().names().joints;
        let carrier = joints.iter().find(|j| j.kind == JointKind::Free && j.moving.link == link);
        Ok(carrier.filter(|j| j.base.link.is_none()).map(|j| (j.v_idx, j.moving)))
    }

    /// Sets the velocity of the centre of mass [m/s] and the angular velocity [rad/s] of a body on a free joint, world
    /// axes. In a run the change of its energy counts as work.
    fn set_free_velocity(&mut self, handle: Handle, v: [f64; 3], w: [f64; 3]) -> Result<(), ApiError> {
        let Some((v_idx, moving)) = self.own_free_joint(handle)? else { return Ok(()) };
        // twist of the joint's moving frame, in its own axes
        let center = self.center(handle)?;
        let (x_wc, x_wm) = (self.place(&center), self.place(&moving));
        let lin = Vec3(v) + Vec3(w).cross(x_wm.pos - x_wc.pos);
        let (ang, lin) = (x_wm.rot.tr_mul_vec(Vec3(w)), x_wm.rot.tr_mul_vec(lin));
        if !ang.0.iter().chain(&lin.0).all(|x| x.is_finite()) {
            return Err(ApiError(format!("velocity {v:?}, {w:?} is too large")));
        }
        let before = self.registry.has_begun.then(|| self.world.energy().total());
        self.world.state.v[v_idx..v_idx + 3].copy_from_slice(&ang.0);
        self.world.state.v[v_idx + 3..v_idx + 6].copy_from_slice(&lin.0);
        self.moved();
        if let Some(before) = before {
            self.world.state.totals[0] += self.world.energy().total() - before;
        }
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
