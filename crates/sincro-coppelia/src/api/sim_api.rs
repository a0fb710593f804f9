//! A object registry together with the world that it is about: where things are and how they move.

use sincro_dynamics::joint::JointKind;
use sincro_dynamics::kinematics::{self, Attached};
use sincro_dynamics::spatial::{Motion, Pose, Quat};
use sincro_dynamics::world::World;

use super::planning::Shifts;
use super::registry::{Entry, Handle, Kind, ObjectRegistry};
use super::{ApiError, Phase, convention};

/// Typed functions of the API on the object registry and its world: poses, joints, forces, sensors, parameters. Get one
/// from [`Session::sim`](crate::session::Session::sim) for one call or phase; nothing in it outlives the step.
///
/// ```
/// # let scene = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes/free-body");
/// use sincro_coppelia::api::{Kind, Reference};
/// use sincro_coppelia::session::Session;
///
/// let mut session = Session::open(&scene, &[], sincro_sim::Extensions::default(), None)?;
/// let is_body = |e: &&sincro_coppelia::api::Entry| matches!(e.kind, Kind::Body(_));
/// let body = session.registry().entries().find(is_body).expect("the scene has a body").handle;
/// let mut sim = session.sim();
/// assert!(sim.mass(body)?.mass > 0.0); // [kg]
/// let pose = sim.pose(body, Reference::World)?;
/// assert!(sim.pose(body, Reference::Object(body))?.pos.norm() < 1e-12, "at {:?} m", pose.pos);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub struct SimApi<'a> {
    /// Objects, signals and setpoints.
    pub registry: &'a mut ObjectRegistry,
    /// Model with its state.
    pub world: &'a mut World,
    /// Simulation time `[s]`.
    pub t: f64,
    /// Object of the script that calls (`sim.handle_self`); none for a client.
    pub own: Option<Handle>,
    is_located: bool,
    /// Operations of image filters on pixels, comparisons of points.
    pub(super) n_operations: u64,
    /// Objects that are tried elsewhere; none but in a trial.
    pub(super) shifts: Shifts,
}

/// Reference frame in which a function gives or takes the pose of an object.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Reference {
    /// The world frame.
    World,
    /// The frame of the object's parent as clients see it ([`ObjectRegistry::visible_parent`]), of a joint the one that
    /// moves; the world if it has none.
    Parent,
    /// The frame of another object; of a joint, the one that moves.
    Object(Handle),
    /// The fixed frame of a joint, on its parent's side; of any other object its frame.
    JointBase(Handle),
}

impl<'a> SimApi<'a> {
    /// Joins a registry with the world of the same scene at the simulation time `t` `[s]`, for one call or phase.
    pub fn new(registry: &'a mut ObjectRegistry, world: &'a mut World, t: f64) -> Self {
        Self { registry, world, t, own: None, is_located: false, n_operations: 0, shifts: Vec::new() }
    }

    /// Returns true if a run is on, paused or not.
    #[must_use]
    pub fn is_running(&self) -> bool {
        self.registry.phase != Phase::Stopped
    }

    /// Adds a message for the operator of the simulator, which is also kept with the run; `level` as in
    /// [`LogLine`](super::LogLine).
    pub fn log(&mut self, level: i64, text: &str) {
        let object =
            self.own.and_then(|own| self.registry.entry(own).ok()).map_or("client", |e| e.path.as_str()).to_owned();
        self.registry.note(self.t, &object, text);
        self.registry.log(level, text);
    }

    /// Brings the poses and twists of all links to the present state.
    fn locate(&mut self) {
        if self.is_located {
            return;
        }
        let zero = std::mem::take(&mut self.registry.zero);
        self.world.with_state_view(self.t, |seen| kinematics::motions(seen.model, seen.q, seen.v, &zero, seen.scratch));
        self.registry.zero = zero;
        self.is_located = true;
    }

    /// The state was changed: poses must be computed again.
    pub(super) fn moved(&mut self) {
        self.is_located = false;
        self.world.mark_changed();
    }

    pub(super) fn place(&mut self, frame: &Attached<f64>) -> Pose<f64> {
        self.locate();
        self.world.with_state_view(self.t, |seen| kinematics::frame_pose(seen.scratch, frame))
    }

    pub(super) fn twist(&mut self, frame: &Attached<f64>) -> Motion<f64> {
        self.locate();
        self.world.with_state_view(self.t, |seen| kinematics::frame_velocity(seen.scratch, frame))
    }

    /// Pose of the frame that a pose of `handle` is given against, in the world.
    fn reference(&mut self, handle: Handle, reference: Reference) -> Result<Pose<f64>, ApiError> {
        let frame = match reference {
            Reference::World => return Ok(Pose::identity()),
            Reference::Parent => match self.registry.entry(handle).map(|e| self.registry.visible_parent(e.handle))? {
                None => return Ok(Pose::identity()),
                Some(parent) => self.registry.entry(parent)?.moving,
            },
            Reference::Object(other) => self.registry.entry(other)?.moving,
            Reference::JointBase(other) => self.registry.entry(other)?.frame,
        };
        Ok(self.place(&frame))
    }

    /// Pose of an object in a reference frame, position in `[m]`. The frame of a joint is the fixed one, on its
    /// parent's side, z along its axis.
    ///
    /// # Errors
    ///
    /// `handle` is no object of the registry, or the reference is none.
    pub fn pose(&mut self, handle: Handle, reference: Reference) -> Result<Pose<f64>, ApiError> {
        let frame = self.registry.entry(handle)?.frame;
        let x_wr = self.reference(handle, reference)?;
        let x_wo = self.place(&frame);
        Ok(if reference == Reference::World { x_wo } else { x_wr.inverse().compose(&x_wo) })
    }

    /// Pose of the moving frame of a joint in its fixed one, position in `[m]`; the identity for any other object.
    ///
    /// # Errors
    ///
    /// `handle` is no object of the registry.
    pub fn joint_pose(&mut self, handle: Handle) -> Result<Pose<f64>, ApiError> {
        let entry = self.registry.entry(handle)?;
        let (frame, moving) = (entry.frame, entry.moving);
        let x_wb = self.place(&frame);
        Ok(x_wb.inverse().compose(&self.place(&moving)))
    }

    /// Turns the moving frame of a ball joint in its fixed one; `pose` gives the rotation. In a run the change of the
    /// energy counts as work.
    ///
    /// # Errors
    ///
    /// `handle` is no ball joint of the model.
    pub fn turn_ball_joint(&mut self, handle: Handle, pose: &Pose<f64>) -> Result<(), ApiError> {
        let path = &self.registry.entry(handle)?.path;
        let joint = self.world.model().names().joint(path).filter(|joint| joint.kind == JointKind::Ball);
        let help = "is no spherical joint that carries a body: sim.setJointPosition sets the others";
        let q_idx = joint.map(|joint| joint.q_idx).ok_or_else(|| ApiError(format!("`{path}` {help}")))?;
        self.count_as_work(|sim| {
            Quat::from_matrix(&pose.rot).normalized().write(&mut sim.world.state.q[q_idx..q_idx + 4]);
        });
        Ok(())
    }

    /// Moves an object to a pose in a reference frame, position in `[m]`: a runtime object, a vision sensor, a frame
    /// below which the model moves nothing, a body that is joined to another one, or a body on a free joint, whose
    /// joint is set and whose velocity coordinates stay. Runtime objects below move with it.
    ///
    /// # Errors
    ///
    /// `handle` or the reference is no object, the object hangs on joints that are not free (set their positions
    /// instead), or a number is not finite.
    pub fn set_pose(&mut self, handle: Handle, pose: &Pose<f64>, reference: Reference) -> Result<(), ApiError> {
        let finite = pose.pos.0.iter().chain(pose.rot.0.iter().flatten()).all(|x| x.is_finite());
        if !finite {
            return Err(ApiError::new("a pose has numbers that are not finite"));
        }
        let x_wo = self.reference(handle, reference)?.compose(pose);
        self.before_move(handle);
        let entry = self.registry.entry(handle)?;
        // a camera or frame of the scene is no part of the model: it can stand anywhere, until the run ends
        let is_shape = entry.is_runtime || matches!(entry.kind, Kind::Vision(_));
        if is_shape || (entry.kind == Kind::Frame && self.registry.is_loose(handle)) {
            let before = self.pose(handle, Reference::World)?;
            self.place_runtime_object(handle, &x_wo)?;
            // runtime objects and points below move with it
            let moved = x_wo.compose(&before.inverse());
            let below: Vec<Handle> = self.registry.tree(handle).into_iter().skip(1).collect();
            for child in below {
                let entry = self.registry.entry(child)?;
                if entry.is_runtime || matches!(entry.kind, Kind::Vision(_) | Kind::Frame) {
                    let x_wc = self.pose(child, Reference::World)?;
                    self.place_runtime_object(child, &moved.compose(&x_wc))?;
                }
            }
            return Ok(());
        }
        let entry = entry.clone();
        // what is fixed in the world, and what carries others, is put elsewhere with all that it carries
        let is_base = matches!(entry.kind, Kind::Frame | Kind::Joint(_) | Kind::Sensor | Kind::ForceSensor(_));
        let is_body = matches!(entry.kind, Kind::Body(_));
        let is_fixed = is_body && self.is_fixed(handle)?;
        if (is_fixed || is_base && !self.is_free_joint(handle)) && self.is_of_model(handle) {
            self.put_belt_back(handle)?;
            if self.stands_at(handle, &x_wo)? {
                return Ok(());
            }
            return self.place_fixed(handle, &x_wo);
        }
        if is_body && self.is_joined(handle) {
            return self.place_joined(handle, &x_wo);
        }
        if is_body && self.bring_by_joint(&entry, &x_wo)? {
            return Ok(());
        }
        self.set_free(&entry, &x_wo)
    }

    /// Puts a runtime object or frame somewhere in the world, fixed to what carries it.
    fn place_runtime_object(&mut self, handle: Handle, x_wo: &Pose<f64>) -> Result<(), ApiError> {
        if self.registry.recorded_frames.remove(&handle) {
            let path = self.registry.entry(handle)?.path.clone();
            let text = format!(
                "frame `{path}` is moved by clients or scripts: its recorded signals stay those of the scene's"
            );
            self.log(300, &text);
        }
        let carrier = match self.registry.entry(handle)?.parent {
            Some(parent) => self.registry.entry(parent)?.moving,
            None => super::registry::WORLD,
        };
        let x_wl = self.place(&Attached { pose: Pose::identity(), ..carrier });
        let at = Attached { pose: x_wl.inverse().compose(x_wo), ..carrier };
        let entry = self.registry.entry_mut(handle);
        (entry.frame, entry.moving) = (at, at);
        if !entry.is_runtime {
            self.registry.moved_frames.insert(handle);
        }
        self.registry.senses.moved(handle, &at);
        Ok(())
    }

    /// Changes the state of the world; once a run has begun, the change of its energy counts as work.
    pub(super) fn count_as_work(&mut self, change: impl FnOnce(&mut Self)) {
        let before = self.registry.has_begun.then(|| self.world.energy().total());
        change(self);
        self.moved();
        if let Some(before) = before {
            self.world.state.totals[0] += self.world.energy().total() - before;
        }
    }

    /// Moves the free joint that carries an object.
    fn set_free(&mut self, entry: &Entry, x_wo: &Pose<f64>) -> Result<(), ApiError> {
        let joints = &self.world.model().names().joints;
        let carrier = joints.iter().find(|j| j.kind == JointKind::Free && j.moving.link == entry.frame.link);
        let Some((base, moving, q_idx)) = carrier.map(|j| (j.base, j.moving, j.q_idx)) else {
            let help = "set the positions of the joints that carry it, or hang it on a free joint in the scene";
            return Err(ApiError(format!("`{}` cannot be put anywhere: {help}", entry.path)));
        };
        let x_mo = moving.pose.inverse().compose(&entry.frame.pose);
        let x_bm = self.place(&base).inverse().compose(&x_wo.compose(&x_mo.inverse()));
        // what it takes to put a body elsewhere while a run is on counts as work
        let before = self.registry.has_begun.then(|| self.world.energy().total());
        let q = &mut self.world.state.q[q_idx..q_idx + 7];
        q[..3].copy_from_slice(&x_bm.pos.0);
        Quat::from_matrix(&x_bm.rot).write(&mut q[3..]);
        self.moved();
        if let Some(before) = before {
            self.world.state.totals[0] += self.world.energy().total() - before;
        }
        // it is made anew there
        self.reset_dynamics(entry.handle)
    }

    /// Hangs an object on another object, or on the world for none. With `keep_in_place` its pose in the world stays,
    /// else that in its parent. A free body that is hung on another object is joined to it, as in a perfectly inelastic
    /// impact; a body that moves is free when it is hung on the world.
    ///
    /// # Errors
    ///
    /// `handle` or `parent` is no object, the object would hang on itself, or the model cannot be so.
    pub fn set_parent(&mut self, handle: Handle, parent: Option<Handle>, keep_in_place: bool) -> Result<(), ApiError> {
        let present = [self.registry.entry(handle)?.parent, self.registry.visible_parent(handle)];
        if keep_in_place && present.contains(&parent) {
            return Ok(());
        }
        if !self.registry.is_loose(handle) {
            return self.hang(handle, parent, keep_in_place);
        }
        let before = self.pose(handle, if keep_in_place { Reference::World } else { Reference::Parent })?;
        let path = match parent {
            None => String::new(),
            Some(parent) => {
                if self.registry.tree(handle).contains(&parent) {
                    return Err(ApiError::new("an object cannot hang on itself"));
                }
                self.registry.entry(parent)?.path.clone()
            }
        };
        let entry = self.registry.entry_mut(handle);
        entry.parent = parent;
        let new = format!("{path}/{}", entry.name);
        let old = std::mem::replace(&mut entry.path, new.clone());
        for below in self.registry.tree(handle).into_iter().skip(1) {
            let entry = self.registry.entry_mut(below);
            if let Some(rest) = entry.path.strip_prefix(&old) {
                entry.path = format!("{new}{rest}");
            }
        }
        self.set_pose(handle, &before, if keep_in_place { Reference::World } else { Reference::Parent })
    }

    /// Removes a runtime object; its children pass to its parent.
    ///
    /// # Errors
    ///
    /// `handle` is no object, or belongs to the scene.
    pub(crate) fn remove(&mut self, handle: Handle) -> Result<(), ApiError> {
        self.before_move(handle);
        self.registry.remove(handle)
    }

    /// Copies a runtime object, but for vision sensors, to the same place and parent; returns the handle of the copy,
    /// whose name has a number appended.
    ///
    /// # Errors
    ///
    /// `handle` is no object, belongs to the scene or is a vision sensor, or 10,000 objects were created already.
    pub(crate) fn copy(&mut self, handle: Handle) -> Result<Handle, ApiError> {
        let entry = self.registry.runtime_object(handle, "copied")?;
        if let Kind::Vision(_) = entry.kind {
            return Err(ApiError(format!("`{}` is not copied: make another one", entry.path)));
        }
        let (name, parent, kind) = (entry.name.clone(), entry.parent, entry.kind.clone());
        self.registry.senses.check_copy(handle)?;
        let pose = self.pose(handle, Reference::World)?;
        let copy = self.registry.create(&name, kind, super::registry::WORLD)?;
        self.registry.copy_senses(handle, copy);
        if let Some(mass) = self.registry.masses.get(&handle).copied() {
            self.registry.masses.insert(copy, mass);
        }
        if let Some(material) = self.registry.materials.get(&handle).cloned() {
            self.registry.materials.insert(copy, material);
        }
        self.set_pose(copy, &pose, Reference::World)?;
        self.set_parent(copy, parent, true)?;
        Ok(copy)
    }

    /// Velocity of an object's origin `[m/s]` and its angular velocity `[rad/s]`, in this order, both as x, y, z in
    /// world axes: the exact rates, not differences of positions.
    ///
    /// # Errors
    ///
    /// `handle` is no object of the registry.
    pub fn velocity(&mut self, handle: Handle) -> Result<([f64; 3], [f64; 3]), ApiError> {
        let frame = self.registry.entry(handle)?.frame;
        let twist = self.twist(&frame);
        Ok((twist.lin.0, twist.ang.0))
    }

    /// Orientation of an object in a reference frame as the Euler angles α, β, γ `[rad]` of `R = Rx(α) Ry(β) Rz(γ)`.
    ///
    /// # Errors
    ///
    /// `handle` is no object of the registry, or the reference is none.
    pub fn euler(&mut self, handle: Handle, reference: Reference) -> Result<[f64; 3], ApiError> {
        Ok(convention::euler_of(&self.pose(handle, reference)?.rot))
    }
}
