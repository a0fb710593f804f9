//! The scene in which `simOMPL` plans paths. States are tried without moving anything: joints for the time of a trial,
//! all other objects by shifting what hangs on them where surfaces are compared.

use sincro_conventions::poses::{numbers_of_pose, rotation_of_euler, rotation_vector};
use sincro_dynamics::spatial::Pose;
use sincro_planning::{Calculations, Component, Region, Scene, Tasks};
use sincro_sim::runtime_object::{DrawingKind, DrawingStyle};

use super::convention::{euler_of, pose_of_numbers};
use super::distances::Part;
use super::drawings::{DrawingRequest, ItemLayout};
use super::flags::COLLIDABLE;
use super::{ApiError, Entity, Handle, Reference, SimApi};

/// Operations that a checked pair of colliders counts as, 250 instructions of a script.
const OPERATIONS_PER_CHECK: u64 = 2_000;

/// Objects that are tried elsewhere, with the displacement of each in the world.
pub(super) type Shifts = Vec<(Vec<Handle>, Pose<f64>)>;

impl SimApi<'_> {
    /// Brings a part to where it is tried.
    pub(super) fn shift(&self, part: &mut Part) {
        let shifts = self.shifts.iter().filter(|(objects, _)| objects.binary_search(&part.object).is_ok());
        shifts.for_each(|(_, shift)| part.at = shift.compose(&part.at));
    }

    /// Pose of an object in the world where it is tried.
    fn tried(&mut self, handle: Option<Handle>) -> Result<Pose<f64>, ApiError> {
        let Some(object) = handle else { return Ok(Pose::identity()) };
        let at = self.pose(object, Reference::World)?;
        let shifts = self.shifts.iter().filter(|(objects, _)| objects.binary_search(&object).is_ok());
        Ok(shifts.fold(at, |at, (_, shift)| shift.compose(&at)))
    }

    /// Returns true if none of some pairs meets where joints are at some positions `[rad]` or `[m]`.
    ///
    /// # Errors
    ///
    /// One of the joints or colliders is gone.
    pub(super) fn is_free(&mut self, joints: &[Handle], q: &[f64], pairs: &[[Handle; 2]]) -> Result<bool, ApiError> {
        self.spend(pairs.len());
        self.trial(|sim| {
            for (joint, q) in joints.iter().zip(q) {
                let q_idx = sim.registry.joint(*joint)?.q_idx;
                sim.world.state.q[q_idx] = *q;
            }
            sim.moved();
            for pair in pairs {
                if sim.meets(*pair)? {
                    return Ok(false);
                }
            }
            Ok(true)
        })
    }

    /// Pose in the world that the numbers of a component say; what they do not say stays.
    fn meant(&mut self, component: &Component, numbers: &[f64]) -> Result<Pose<f64>, ApiError> {
        let x_wr = self.tried(component.reference)?;
        let mut pose = x_wr.inverse().compose(&self.tried(Some(component.object))?);
        let n_positions = if component.kind < 2 { 2 } else { 3 };
        pose.pos.0[..n_positions].copy_from_slice(&numbers[..n_positions]);
        match *numbers {
            [_, _, angle] if component.kind == 1 => {
                let [alpha, beta, _] = euler_of(&pose.rot);
                pose.rot = rotation_of_euler([alpha, beta, angle]);
            }
            [x, y, z, qx, qy, qz, qw] => {
                let given = pose_of_numbers([x, y, z, qx, qy, qz, qw]);
                pose = given.ok_or_else(|| ApiError::new("a state has a quaternion that is zero"))?;
            }
            _ => {}
        }
        Ok(x_wr.compose(&pose))
    }
}

impl Scene for SimApi<'_> {
    fn tasks(&mut self) -> &mut Tasks {
        &mut self.registry.planning
    }

    fn calculations(&mut self) -> &mut Calculations {
        &mut self.registry.calculations
    }

    fn touching(&mut self, [one, two]: [Handle; 2]) -> Result<Option<[Handle; 2]>, ApiError> {
        self.collision(self.entity(one)?, self.entity(two)?)
    }

    fn distance_between(&mut self, [one, two]: [Handle; 2]) -> Result<Option<f64>, ApiError> {
        let [one, two] = [self.entity(one)?, self.entity(two)?];
        Ok(self.distance(one, two, f64::INFINITY)?.map(|found| found.distance))
    }

    fn object(&mut self, handle: i32, is_joint: bool) -> Result<Handle, ApiError> {
        let object = super::functions::plain(self, handle)?;
        if is_joint { Ok(self.registry.joint(object)?.handle) } else { Ok(object) }
    }

    fn collider(&self, handle: i32) -> Result<Handle, ApiError> {
        match self.registry.is_collection(Handle(handle)) || handle == -2 {
            true => Ok(Handle(handle)),
            false => super::functions::plain(self, handle),
        }
    }

    fn read(&mut self, component: &Component) -> Result<Vec<f64>, ApiError> {
        if component.is_joint() {
            return Ok(vec![self.joint_position(component.object)?]);
        }
        let pose = self.tried(component.reference)?.inverse().compose(&self.tried(Some(component.object))?);
        Ok(match component.kind {
            1 => vec![pose.pos[0], pose.pos[1], euler_of(&pose.rot)[2]],
            _ => numbers_of_pose(&pose)[..component.len()].to_vec(),
        })
    }

    fn write(&mut self, component: &Component, numbers: &[f64]) -> Result<(), ApiError> {
        if component.is_joint() {
            return self.set_joint_position(component.object, numbers[0]);
        }
        let pose = self.meant(component, numbers)?;
        self.set_pose(component.object, &pose, Reference::World)
    }

    fn trial<T>(&mut self, act: impl FnOnce(&mut Self) -> Result<T, ApiError>) -> Result<T, ApiError> {
        let before = self.world.state.q.clone();
        let done = act(self);
        self.world.state.q.copy_from_slice(&before);
        self.shifts.clear();
        self.moved();
        done
    }

    fn attempt(&mut self, components: &[Component], state: &[f64]) -> Result<(), ApiError> {
        self.shifts.clear();
        let mut at = 0;
        for component in components {
            let numbers = &state[at..at + component.len()];
            at += component.len();
            if component.is_joint() {
                let q_idx = self.registry.joint(component.object)?.q_idx;
                self.world.state.q[q_idx] = numbers[0];
                self.moved();
                continue;
            }
            let shift = self.meant(component, numbers)?.compose(&self.tried(Some(component.object))?.inverse());
            let mut objects = self.registry.tree(component.object);
            objects.sort_unstable();
            self.shifts.push((objects, shift));
        }
        Ok(())
    }

    fn meets(&mut self, pair: [Handle; 2]) -> Result<bool, ApiError> {
        let [one, two]: [Entity; 2] = [self.entity(pair[0])?, self.entity(pair[1])?];
        Ok(self.distance_of([one, two], 0.0, COLLIDABLE)?.is_some())
    }

    fn gap(&mut self, region: &Region) -> Result<[f64; 4], ApiError> {
        let [robot, goal, axes] = region.objects;
        let (robot, goal) = (self.tried(robot)?, self.tried(goal)?);
        let [x, y, z] = self.tried(axes)?.rot.transpose().mul_vec(goal.pos - robot.pos).0;
        Ok([x, y, z, rotation_vector(&robot.rot.transpose().mul(&goal.rot)).norm()])
    }

    fn height(&mut self, component: &Component) -> Result<f64, ApiError> {
        let pose = self.tried(component.reference)?.inverse().compose(&self.tried(Some(component.object))?);
        Ok(pose.pos[2])
    }

    fn spend(&mut self, checks: usize) {
        self.add_operations(OPERATIONS_PER_CHECK * checks as u64);
    }

    fn draw(&mut self, points: &[[f64; 3]], size: f64, color: [f64; 3]) -> Result<i64, ApiError> {
        let color = color.map(|x| (x.clamp(0.0, 1.0) * 255.0).round() as u8);
        let style = DrawingStyle { kind: DrawingKind::LineStrip, size, color, lifetime: 0.0, falls: false };
        let layout = ItemLayout { n_drawn: 3, n_given: 3, is_local: false };
        let (parent, capacity) = (None, points.len() as i64);
        let (is_cyclic, tolerance, is_persistent) = (false, 0.0, false);
        let request = DrawingRequest { style, layout, parent, capacity, is_cyclic, tolerance, is_persistent };
        let handle = self.add_drawing(request)?;
        self.draw_items(handle, &points.concat(), true, false)?;
        Ok(handle)
    }

    fn remove_drawing(&mut self, handle: i64) -> Result<(), ApiError> {
        SimApi::remove_drawing(self, Some(handle), false)
    }
}
