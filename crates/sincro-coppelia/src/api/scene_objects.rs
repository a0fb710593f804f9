//! Objects of a scene in the registry: at the start, and after the structure has changed.

use std::collections::BTreeSet;
use std::sync::Arc;

use sincro_dynamics::joint::JointKind;
use sincro_dynamics::kinematics::Attached;
use sincro_dynamics::model::{MassProperties, Model};
use sincro_dynamics::spatial::{Mat3, Pose};

use super::collections::Entity;
use super::registry::{Entry, Handle, JointEntry, Kind, ObjectRegistry, WORLD, axis_of, turned, unit_mass};
use super::senses::ProximityEntry;
use super::structure::Belt;
use super::{convention, pairs};
use sincro_scene::scene::{Object, ObjectKind, Scene};
use sincro_sim::proximity::ProximitySensor;
use sincro_sim::restructure::Restructured;

/// Mass properties of what has none.
const NO_MASS: MassProperties = MassProperties { mass: 0.0, center_of_mass: [0.0; 3], inertia: [0.0; 6] };

/// Handle of an object of a scene.
pub(super) fn handle_of_object(object: &Object) -> Handle {
    handle_of_id(object.id)
}

/// Handle of the object of a number.
pub(super) fn handle_of_id(id: usize) -> Handle {
    Handle(id as i32 + 1)
}

impl ObjectRegistry {
    /// Takes over the objects of a scene, parents before children; objects that are known keep what clients and scripts
    /// have set. `model` is the scene's with its present parameters.
    pub(super) fn take_objects(&mut self, scene: &Scene, model: &Model<f64>) {
        let former = std::mem::take(&mut self.joints);
        self.joint_of.clear();
        self.left_out = super::tree::left_out(scene);
        self.left_out.extend(self.belts.values().filter_map(Belt::joint));
        for object in &scene.objects {
            let handle = handle_of_object(object);
            let parent = object.parent.map(|k| handle_of_object(&scene.objects[k]));
            let of_parent = parent.and_then(|p| self.entry(p).ok()).map_or(WORLD, |p| p.moving);
            let beside = Attached { pose: of_parent.pose.compose(&object.pose), ..of_parent };
            let (kind, frame, moving) = self.described(object, (scene, model), beside, &former);
            self.solids.extend(unit_mass(object).map(|mass| (handle, mass)));
            self.put(object, kind, parent, (frame, moving));
        }
        self.body_on = self.bodies_on_joints();
    }

    /// Kind of an object with its frame and that of its children; `beside` is its frame by its parent.
    fn described(
        &mut self,
        object: &Object,
        (scene, model): (&Scene, &Model<f64>),
        beside: Attached<f64>,
        former: &[JointEntry],
    ) -> (Kind, Attached<f64>, Attached<f64>) {
        let (handle, names) = (handle_of_object(object), model.names());
        let known = self.entry(handle).ok().filter(|entry| !entry.is_runtime).map(|entry| entry.kind.clone());
        let at = names.frame(&object.path).map_or(beside, |f| Attached { link: f.link, pose: f.pose });
        match &object.kind {
            ObjectKind::Joint { kind, motor } => match names.joint(&object.path) {
                None => (Kind::Joint(None), beside, beside),
                Some(joint) if *kind == JointKind::Fixed => {
                    (Kind::ForceSensor(Some(joint.v_idx)), joint.base, joint.moving)
                }
                Some(joint) => {
                    let turn = axis_of(kind).map_or_else(Mat3::identity, convention::rotation_to);
                    let own = axis_of(kind).is_some().then(|| {
                        self.joint_of.insert(handle, self.joints.len());
                        let before = former.iter().find(|before| before.handle == handle);
                        self.joints.push(JointEntry {
                            handle,
                            kind: *kind,
                            q_idx: joint.q_idx,
                            v_idx: joint.v_idx,
                            motor: *motor,
                            drive: motor.map(|m| model.motors()[m]),
                            scene_mode: motor.map(|m| scene.model.motors()[m].mode),
                            target_velocity: before.and_then(|joint| joint.target_velocity),
                            target_position: before.and_then(|joint| joint.target_position),
                            target_force: before.and_then(|joint| joint.target_force),
                        });
                        self.joints.len() - 1
                    });
                    (Kind::Joint(own), turned(joint.base, &turn), turned(joint.moving, &turn))
                }
            },
            ObjectKind::Body { mass } => {
                // a mass that was set stays
                let set = match known {
                    Some(Kind::Body(set)) if set.mass > 0.0 => set,
                    _ => *mass,
                };
                (Kind::Body(set), at, at)
            }
            // it carries nothing now
            ObjectKind::Frame if self.is_parked_sensor(scene, object) => (Kind::ForceSensor(None), at, at),
            ObjectKind::Frame | ObjectKind::Sensor => {
                let other = if object.kind == ObjectKind::Frame { Kind::Frame } else { Kind::Sensor };
                let is_proximity = self.senses.proximity.contains_key(&handle);
                (if is_proximity { Kind::Proximity } else { other }, at, at)
            }
            ObjectKind::Camera { sensor, .. } => {
                let kind = match (known, sensor) {
                    (Some(Kind::Vision(slot)), Some(_)) => Kind::Vision(slot),
                    (_, Some(sensor)) => Kind::Vision(self.vision.add(sensor.clone(), false)),
                    (_, None) => Kind::Sensor,
                };
                (kind, beside, beside)
            }
            ObjectKind::Fixture => (Kind::Body(NO_MASS), at, at),
            ObjectKind::Force | ObjectKind::Drag => (Kind::Force, beside, beside),
            ObjectKind::Rotor => {
                let index = names.rotors.iter().position(|name| *name == object.path);
                (Kind::Rotor(index.expect("every rotor has a name")), beside, beside)
            }
        }
    }

    /// Returns true if an object is a force sensor that carries nothing, which is a frame in the scene.
    fn is_parked_sensor(&self, scene: &Scene, object: &Object) -> bool {
        let keys = scene.source.as_ref().and_then(|source| source.parked.get(&object.id));
        keys.is_some_and(super::tree::is_force_sensor)
    }

    /// Puts an object of the scene at its place: a new one, or one that is known.
    fn put(&mut self, object: &Object, kind: Kind, parent: Option<Handle>, at: (Attached<f64>, Attached<f64>)) {
        let (handle, name, path) = (handle_of_object(object), object.name.clone(), object.path.clone());
        let place = handle.0 as usize - 1;
        if self.entries.len() <= place {
            self.entries.resize(place + 1, None);
        }
        let before = self.entries[place].as_ref().map(|entry| entry.name.clone());
        if before.as_ref() != Some(&name) {
            before.iter().for_each(|name| self.free_name(name));
            *self.names.entry(name.clone()).or_default() += 1;
        }
        let is_runtime = false;
        if self.moved_frames.contains(&handle)
            && let Some(entry) = &mut self.entries[place]
        {
            // a client has put it elsewhere: it goes with what it hangs on there
            entry.kind = kind;
            return;
        }
        self.entries[place] = Some(Entry { handle, name, path, kind, is_runtime, parent, frame: at.0, moving: at.1 });
    }

    /// Takes over a change of the structure. Handles stay; what has no object any more is forgotten. `model` is that of
    /// the world after the change. Runtime objects go with their parents, which must be there.
    pub(super) fn follow(&mut self, change: &Restructured, model: &Model<f64>) {
        let scene = &change.scene;
        let loose = self.poses_in_parents();
        let present: BTreeSet<Handle> = scene.objects.iter().map(handle_of_object).collect();
        let gone: Vec<Handle> =
            self.entries().filter(|e| !e.is_runtime && !present.contains(&e.handle)).map(|e| e.handle).collect();
        for handle in gone {
            self.forget(handle);
        }
        self.follow_sensors(scene);
        self.take_objects(scene, model);
        self.follow_numbers(change, model);
        self.pairs = pairs::pairs_of(scene, self);
        self.place_in_parents(&loose);
        self.scene = Arc::clone(scene);
    }

    /// Forgets an object of the scene that has gone.
    fn forget(&mut self, handle: Handle) {
        let Some(entry) = self.entries[handle.0 as usize - 1].take() else { return };
        if let Kind::Vision(slot) = entry.kind {
            self.vision.remove(slot);
        }
        self.free_name(&entry.name);
        self.data.retain(|(owner, _), _| *owner != handle);
        self.script_parameters.retain(|(owner, _), _| *owner != handle);
        self.senses.forget(handle);
        self.drawings.forget(handle);
        self.joint_motions.remove(&handle);
        self.passing.remove(&handle);
        self.respondable_masks.remove(&handle);
        self.joint_modes.remove(&handle);
        self.statics.remove(&handle);
        self.belts.remove(&handle);
        self.forget_links(handle);
        self.looks.retain(|(owner, _), _| *owner != handle);
        self.component_colors.retain(|(owner, _), _| *owner != handle);
        self.textures.forget(handle);
        self.solids.remove(&handle);
        self.recorded_frames.remove(&handle);
        self.moved_frames.remove(&handle);
        self.added.remove(&handle);
        self.flags.forget(handle);
        self.forget_entity(Entity::Object(handle));
    }

    /// Commands, impulses and lists in the order of the model.
    fn follow_numbers(&mut self, change: &Restructured, model: &Model<f64>) {
        let former = &change.transferred.commands;
        let held = std::mem::take(&mut self.held);
        self.held = former.iter().map(|old| old.and_then(|k| held[k])).collect();
        let commands = std::mem::take(&mut self.commands);
        let of_scene = change.scene.commands.iter();
        self.commands = of_scene.zip(former).map(|(new, old)| old.map_or(new, |k| &commands[k]).clone()).collect();
        if !self.upcoming.is_empty() {
            let upcoming = std::mem::take(&mut self.upcoming);
            let t = change.transferred.state.tick as f64 * self.step;
            let new = self.commands.iter().map(|signal| signal.value(t));
            self.upcoming = new.zip(former).map(|(new, old)| old.map_or(new, |k| upcoming[k])).collect();
        }
        let impulse = std::mem::take(&mut self.impulse);
        let n_motors = model.motors().len();
        self.impulse = former[..n_motors].iter().map(|old| old.map_or(0.0, |k| impulse[k])).collect();
        self.zero = vec![0.0; model.n_v()];
        self.vision.restructured();
    }

    /// Visible pieces and proximity sensors of the scene; colours that were set stay.
    fn follow_sensors(&mut self, scene: &Scene) {
        let mut scenery = scene.scenery().clone();
        for piece in &mut scenery.pieces {
            let own = |pieces: &[sincro_scene::scenery::Piece]| -> Vec<[u8; 3]> {
                pieces.iter().filter(|p| p.object == piece.object).map(|p| p.color).collect()
            };
            if let [first, rest @ ..] = &own(&self.senses.scenery.pieces)[..]
                && self.senses.is_painted(piece.object)
                && rest.iter().all(|color| color == first)
            {
                piece.color = *first;
            }
        }
        self.senses.scenery = scenery;
        let mut of_scene = BTreeSet::new();
        for spec in &scene.sensors {
            let object = scene.object(&spec.path);
            let (Some(sensor), Some(object)) = (ProximitySensor::of(spec, scene), object) else { continue };
            let handle = handle_of_object(object);
            of_scene.insert(handle);
            let entity = Entity::All;
            let fresh =
                ProximityEntry { sensor, is_explicit: false, is_of_scene: true, blind_below: 0.0, saw: None, entity };
            match self.senses.proximity.get_mut(&handle) {
                Some(known) => known.sensor = fresh.sensor,
                None => {
                    self.senses.proximity.insert(handle, fresh);
                }
            }
        }
        self.senses.proximity.retain(|handle, entry| !entry.is_of_scene || of_scene.contains(handle));
    }

    /// Runtime objects and frames that were moved, parents before children, each with its pose in its parent.
    fn poses_in_parents(&self) -> Vec<(Handle, Pose<f64>)> {
        let is_loose = |e: &&Entry| e.is_runtime || self.moved_frames.contains(&e.handle);
        let mut found: Vec<(usize, Handle, Pose<f64>)> = self
            .entries()
            .filter(is_loose)
            .map(|entry| {
                let parent = entry.parent.and_then(|p| self.entry(p).ok()).map_or(WORLD, |p| p.moving);
                (self.depth(entry.handle), entry.handle, parent.pose.inverse().compose(&entry.frame.pose))
            })
            .collect();
        found.sort_by_key(|(depth, handle, _)| (*depth, *handle));
        found.into_iter().map(|(_, handle, pose)| (handle, pose)).collect()
    }

    fn depth(&self, handle: Handle) -> usize {
        let parent = |h: &Handle| self.entry(*h).ok().and_then(|entry| entry.parent);
        std::iter::successors(Some(handle), parent).take(self.entries.len() + 1).count()
    }

    fn place_in_parents(&mut self, poses: &[(Handle, Pose<f64>)]) {
        for (handle, pose) in poses {
            let Ok(entry) = self.entry(*handle) else { continue };
            if !entry.is_runtime && !self.moved_frames.contains(handle) {
                continue;
            }
            let parent = entry.parent.and_then(|p| self.entry(p).ok());
            let carrier = parent.map_or(WORLD, |p| p.moving);
            let above = parent.map_or_else(String::new, |p| p.path.clone());
            let at = Attached { pose: carrier.pose.compose(pose), ..carrier };
            let entry = self.entry_mut(*handle);
            (entry.frame, entry.moving) = (at, at);
            entry.path = format!("{above}/{}", entry.name);
            self.senses.moved(*handle, &at);
        }
    }
}
