//! Bodies: mass, velocity of the centre of mass, forces for the coming step.

use sincro_dynamics::force::Push;
use sincro_dynamics::kinematics::Attached;
use sincro_dynamics::model::MassProperties;
use sincro_dynamics::spatial::{Pose, Vec3};

use super::table::{Handle, Kind};
use super::{Desk, Refusal};

impl Desk<'_> {
    /// Mass, centre of mass and inertia of a body, in its frame.
    ///
    /// # Errors
    ///
    /// There is no such object, or it is no body.
    pub fn mass(&self, handle: Handle) -> Result<MassProperties, Refusal> {
        let entry = self.table.entry(handle)?;
        match entry.kind {
            Kind::Body(mass) => Ok(mass),
            _ => Err(Refusal(format!("`{}` is no body", entry.path))),
        }
    }

    /// The body's frame moved to its centre of mass.
    fn center(&self, handle: Handle) -> Result<Attached<f64>, Refusal> {
        let mass = self.mass(handle)?;
        let frame = self.table.entry(handle)?.frame;
        Ok(Attached { pose: frame.pose.compose(&Pose::translation(Vec3(mass.center_of_mass))), ..frame })
    }

    /// Velocity of a body's centre of mass [m/s] and its angular velocity [rad/s], world axes.
    ///
    /// # Errors
    ///
    /// There is no such object, or it is no body.
    pub fn center_velocity(&mut self, handle: Handle) -> Result<([f64; 3], [f64; 3]), Refusal> {
        let center = self.center(handle)?;
        let twist = self.twist(&center);
        Ok((twist.lin.0, twist.ang.0))
    }

    /// Pushes on a body's centre of mass over the coming step: force `[N]` and torque [N·m], world axes. What is added
    /// before the step adds up; after it, it is gone.
    ///
    /// # Errors
    ///
    /// There is no such object, it is no body, no run is on, or a number is not finite.
    pub fn add_force_and_torque(&mut self, handle: Handle, force: [f64; 3], torque: [f64; 3]) -> Result<(), Refusal> {
        let center = self.center(handle)?;
        self.push(&center, Vec3(force), Vec3(torque))
    }

    /// Pushes on a point of a body over the coming step: point `[m]` and force `[N]` in the body's frame as it stands now.
    ///
    /// # Errors
    ///
    /// As [`Desk::add_force_and_torque`].
    pub fn add_force(&mut self, handle: Handle, point: [f64; 3], force: [f64; 3]) -> Result<(), Refusal> {
        self.mass(handle)?;
        let frame = self.table.entry(handle)?.frame;
        let force = self.place(&frame).rot.mul_vec(Vec3(force));
        let at = Attached { pose: frame.pose.compose(&Pose::translation(Vec3(point))), ..frame };
        self.push(&at, force, Vec3::zero())
    }

    fn push(&mut self, at: &Attached<f64>, force: Vec3<f64>, torque: Vec3<f64>) -> Result<(), Refusal> {
        if !self.is_running() {
            return Err(Refusal::new("a force acts over a step: start the simulation first"));
        }
        let numbers = force.0.iter().chain(&torque.0).chain(&at.pose.pos.0);
        if !numbers.copied().all(f64::is_finite) {
            return Err(Refusal::new("a force, torque or point has numbers that are not finite"));
        }
        if let Some(link) = at.link {
            self.world.push(Push { link, point: at.pose.pos, force, torque });
        }
        Ok(())
    }
}
