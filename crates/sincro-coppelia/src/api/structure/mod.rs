//! Structure that clients and scripts change: objects of the model are copied, removed, hung elsewhere, made and
//! loaded; joints get stops.
//!
//! Each change takes effect at once, between two steps: the scene is edited ([`SceneDraft`]), compiled, and the world
//! goes on with it ([`restructure`]). Handles stay. A body that is hung on another one is joined to it, as in a
//! perfectly inelastic impact; hung on the world it is free. What V-REP does not have, the free joint that carries a
//! free body, becomes a frame while the body is joined, and a joint again when it is parted.

mod belt;
mod copy;
mod group;
mod hang;
mod link;
mod make;
mod materials;
mod model;
mod motors;
mod needed;
mod remove;
mod statics;
mod stops;

pub(super) use belt::Belt;
pub(super) use link::Link;
pub(crate) use make::Role;
pub(super) use materials::Material;
pub(super) use needed::Needed;

use std::collections::{BTreeMap, BTreeSet};

use serde_json::{Map, Value};
use sincro_dynamics::joint::JointKind;
use sincro_dynamics::kinematics::Attached;
use sincro_dynamics::spatial::Pose;

use super::registry::{Handle, Kind};
use super::scene_objects::{handle_of_id, handle_of_object};
use super::tree::is_force_sensor;
use super::{ApiError, Phase, SimApi};
use sincro_scene::diagnostic::{Diagnostics, Severity};
use sincro_scene::draft::SceneDraft;
use sincro_scene::scene::{Object, ObjectKind, Scene, frame_of};
use sincro_sim::controller::Change;
use sincro_sim::restructure::{Edit, Restructured, restructure};

/// Change of energy or momentum that is put down to rounding, relative to what there is.
const ROUNDING: f64 = 1e-12;

/// Edit of the scene that has not been made yet.
struct Rebuild {
    draft: SceneDraft,
    /// Original of each copied object, by the path of the copy.
    copies: BTreeMap<String, Handle>,
    /// Handles of objects that are part of the model from now on, by their paths.
    joined: BTreeMap<String, Handle>,
    /// Paths of those of them that are bodies fixed in the world.
    fixed: BTreeSet<String>,
    /// True if velocities of bodies that are joined or parted follow from their momenta.
    conserves_momentum: bool,
    /// True if objects are put elsewhere and nothing else is changed.
    is_placement: bool,
}

impl Rebuild {
    /// Hangs an object on another parent (`/`: the world) at a pose there `[m]`, with another number behind its name if
    /// the parent has an object of that name. Returns its new path.
    fn hang(&mut self, path: &str, parent: &str, pose: &Pose<f64>) -> String {
        let (own, name) = path.rsplit_once('/').unwrap_or(("", path));
        let is_taken = |name: &str| {
            let there = format!("{}/{name}", parent.trim_end_matches('/'));
            there != path && self.draft.has(&there)
        };
        if !is_taken(name) {
            return self.draft.hang(path, parent, pose);
        }
        let stem = name.trim_end_matches(|c: char| c.is_ascii_digit());
        let mut others = (0..).map(|k: usize| format!("{stem}{k}"));
        let other = others.find(|name| !is_taken(name) && !self.draft.has(&format!("{own}/{name}")));
        let renamed = self.draft.set_name(path, &other.expect("there are not that many objects"));
        self.draft.hang(&renamed, parent, pose)
    }
}

/// Scripts that a scene may have at once; each has a state of its own.
const MAX_SCRIPTS: usize = 1_000;

impl SimApi<'_> {
    /// A draft of the scene as it is now.
    fn draft(&self) -> Result<Rebuild, ApiError> {
        let draft = SceneDraft::new(self.registry.scene());
        let draft = draft.ok_or_else(|| ApiError::new("the scene's file is not known: its structure stays"))?;
        let (copies, joined, fixed) = (BTreeMap::new(), BTreeMap::new(), BTreeSet::new());
        Ok(Rebuild { draft, copies, joined, fixed, conserves_momentum: true, is_placement: false })
    }

    /// Compiles an edited scene and lets the world go on with it.
    ///
    /// # Errors
    ///
    /// The scene cannot be: nothing has changed then.
    fn rebuild(&mut self, edit: Rebuild) -> Result<(), ApiError> {
        let Rebuild { mut draft, copies, joined, conserves_momentum, is_placement, .. } = edit;
        for (path, handle) in &joined {
            draft.set_id(path, handle.0 as usize - 1);
        }
        let next = self.registry.next_handle().0 as usize - 1;
        let mut to = draft.compile(next).map_err(|found| refused(&found))?;
        self.registry.put_scripts(&mut to);
        self.registry.needed.check(&to)?;
        if to.scripts.len() > MAX_SCRIPTS {
            return Err(ApiError(format!("more than {MAX_SCRIPTS} scripts at once")));
        }
        let ids: BTreeMap<usize, usize> =
            copies.iter().filter_map(|(path, original)| Some((to.object(path)?.id, original.0 as usize - 1))).collect();
        self.finish_pictures();
        let from = self.registry.scene().clone();
        let edit = Edit { from: &from, copies: &ids, conserves_momentum };
        let change = restructure(self.world, to, &edit);
        for handle in joined.values() {
            // it is a runtime object no longer: its pieces are those of the scene
            self.registry.senses.forget_parts(*handle);
            self.registry.parked.remove(handle);
            self.registry.masses.remove(handle);
            if self.registry.scene().objects.iter().any(|o| handle_of_object(o) == *handle && o.contact.is_some()) {
                self.registry.materials.remove(handle);
            }
            if self.registry.entry(*handle).is_ok_and(|entry| entry.is_runtime) {
                self.registry.n_created -= 1;
            }
            self.registry.entry_mut(*handle).is_runtime = false;
        }
        let model = self.world.model().clone();
        self.registry.follow(&change, &model);
        let known: Vec<usize> = from.objects.iter().map(|object| object.id).collect();
        for object in change.scene.objects.iter().filter(|object| !known.contains(&object.id)) {
            self.registry.added.insert(handle_of_object(object));
        }
        for script in change.scene.scripts.iter().filter(|script| !known.contains(&script.object)) {
            self.registry.take_parameters(script, ids.get(&script.object).map(|id| handle_of_id(*id)));
        }
        self.note_change(&from, &change);
        // where objects were for no time is nothing that the trace has to follow, and models between nobody has to keep
        let joins_last = is_placement && self.registry.is_last_placement;
        let last = self.registry.restructured.take();
        self.registry.restructured = Some(match last {
            Some(last) => last.then(change, joins_last),
            None => change,
        });
        self.registry.is_last_placement = is_placement;
        self.restore_pairs();
        self.moved();
        Ok(())
    }

    /// Makes scripts that were added, changed or taken away a part of the scene.
    ///
    /// # Errors
    ///
    /// There would be too many, or the scene's file is not known.
    pub(super) fn rebuild_scripts(&mut self) -> Result<(), ApiError> {
        let edit = self.draft()?;
        self.rebuild(edit)
    }

    /// Gives a joint without motor one that is off.
    ///
    /// # Errors
    ///
    /// The scene's file is not known, or the joint can have none.
    pub(super) fn give_motor(&mut self, joint: Handle) -> Result<(), ApiError> {
        let path = self.model_path(joint)?;
        let mut edit = self.draft()?;
        let (list, keys) = edit.draft.table(&path).ok_or_else(|| ApiError(format!("there is no joint `{path}`")))?;
        let (list, mut keys) = (list.to_owned(), keys.clone());
        keys.insert("motor".into(), Value::Object(table([("mode", "free".into())])));
        edit.draft.replace(&path, &list, keys);
        self.rebuild(edit)
    }

    /// Keeps what has changed with the run: objects, momentum, energy.
    fn note_change(&mut self, from: &Scene, change: &Restructured) {
        let mut notes: Vec<(&str, &'static str, Vec<f64>)> = Vec::new();
        for object in &from.objects {
            match change.scene.objects.iter().find(|other| other.id == object.id) {
                None => notes.push((&object.path, "removed", Vec::new())),
                Some(now) if now.path != object.path => notes.push((&now.path, "hung", Vec::new())),
                Some(_) => {}
            }
        }
        let is_new = |object: &&Object| !from.objects.iter().any(|other| other.id == object.id);
        notes.extend(change.scene.objects.iter().filter(is_new).map(|object| (&*object.path, "added", Vec::new())));
        let moved = &change.transferred;
        let jump = [moved.momentum_change.0, moved.angular_momentum_change.0].concat();
        if jump.iter().any(|x| x.abs() > ROUNDING) {
            notes.push(("/", "momentum", jump));
        }
        notes.push(("/", "energy", vec![moved.energy_change, moved.joining_loss]));
        let t = self.acts_at();
        let mut all_kept = true;
        for (object, quantity, mut value) in notes {
            // jumps of several changes at one time add up
            let same = |c: &&Change| (c.t, &*c.object, c.quantity) == (t, object, quantity);
            if let Some(before) = self.registry.changes().iter().find(same) {
                value.iter_mut().zip(&before.value).for_each(|(sum, x)| *sum += x);
            }
            let kept = self.registry.keep_change(Change { t, object: object.to_owned(), quantity, value });
            all_kept &= kept.is_ok();
        }
        self.registry.is_model_changed |= self.registry.phase == Phase::Stopped;
        if !all_kept {
            self.log(300, "more changes of the structure than are kept with the run");
        }
    }

    /// Returns true if an object is one of the scene that the world is of.
    pub(super) fn is_of_model(&self, handle: Handle) -> bool {
        self.registry.scene().objects.iter().any(|object| handle_of_object(object) == handle)
    }

    /// Path of an object in the scene that the world is of.
    fn model_path(&self, handle: Handle) -> Result<String, ApiError> {
        let own = self.registry.scene().objects.iter().find(|object| handle_of_object(object) == handle);
        match own {
            Some(object) => Ok(object.path.clone()),
            None => Err(ApiError(format!("`{}` is no part of the model", self.registry.entry(handle)?.path))),
        }
    }

    /// Handle of an object of the scene by its path.
    fn handle_at(&self, path: &str) -> Result<Handle, ApiError> {
        let found = self.registry.scene().object(path).map(handle_of_object);
        found.ok_or_else(|| ApiError(format!("there is no object `{path}`")))
    }

    /// Frame that children of an object of the model stand in, in the model's axes.
    fn carrier_frame(&self, handle: Handle) -> Result<Attached<f64>, ApiError> {
        let scene = self.registry.scene();
        let place = scene.objects.iter().position(|object| handle_of_object(object) == handle);
        let place = place.ok_or_else(|| ApiError::new("the object is no part of the model"))?;
        Ok(frame_of(scene, place))
    }

    /// Pose in the world of an object's own frame, as its keys in the scene give it: of a joint, its side of the
    /// parent.
    fn own_pose(&mut self, handle: Handle) -> Result<Pose<f64>, ApiError> {
        let entry = self.registry.entry(handle)?;
        let frame = match entry.kind {
            Kind::Joint(_) | Kind::ForceSensor(_) if self.is_of_model(handle) => {
                let path = self.model_path(handle)?;
                match self.world.model().names().joint(&path) {
                    Some(joint) => joint.base,
                    None => entry.frame,
                }
            }
            _ => entry.frame,
        };
        Ok(self.place(&frame))
    }

    /// Object of the model that carries what hangs on an object, with its path and the pose of its frame in the world;
    /// the world for none. Runtime objects carry nothing of the model: what carries them does.
    fn model_parent(&mut self, parent: Option<Handle>) -> Result<(String, Pose<f64>), ApiError> {
        let mut at = parent;
        while let Some(handle) = at {
            if self.is_of_model(handle) {
                let frame = self.carrier_frame(handle)?;
                return Ok((self.model_path(handle)?, self.place(&frame)));
            }
            at = self.registry.entry(handle)?.parent;
        }
        Ok(("/".to_owned(), Pose::identity()))
    }

    /// The free joint that carries an object and nothing else of the model, if there is one, or the frame that such a
    /// joint has become.
    fn free_carrier(&self, handle: Handle) -> Option<Handle> {
        let scene = self.registry.scene();
        let own = scene.objects.iter().position(|object| handle_of_object(object) == handle)?;
        let parent = scene.objects[own].parent?;
        let carrier = &scene.objects[parent];
        let is_free = matches!(carrier.kind, ObjectKind::Joint { kind: JointKind::Free, .. });
        let was_free = self.was_joint(handle_of_object(carrier));
        let is_alone = scene.objects.iter().filter(|object| object.parent == Some(parent)).count() == 1;
        ((is_free || was_free) && is_alone).then(|| handle_of_object(carrier))
    }

    /// Returns true if an object of the model is a frame that was a free joint.
    fn was_joint(&self, handle: Handle) -> bool {
        self.parked_keys(handle).is_some_and(|keys| !is_force_sensor(keys))
    }

    /// Keys of the joint that an object of the model was before it became a frame.
    fn parked_keys(&self, handle: Handle) -> Option<&Map<String, Value>> {
        self.registry.scene().source.as_ref()?.parked.get(&(handle.0 as usize - 1))
    }

    /// Returns true if an object of the model is a free joint.
    pub(super) fn is_free_joint(&self, handle: Handle) -> bool {
        let is_it = |object: &&Object| handle_of_object(object) == handle;
        let found = self.registry.scene().objects.iter().find(is_it);
        found.is_some_and(|object| matches!(object.kind, ObjectKind::Joint { kind: JointKind::Free, .. }))
    }

    /// A name that no object has, made of another one.
    fn fresh_name(&self, name: &str) -> String {
        self.unused_name(name, |_| false)
    }

    /// As [`SimApi::fresh_name`], of an object of the world that an edit adds beside others.
    fn fresh_name_in(&self, name: &str, draft: &SceneDraft) -> String {
        self.unused_name(name, |name| draft.table(&format!("/{name}")).is_some())
    }

    fn unused_name(&self, name: &str, is_taken: impl Fn(&str) -> bool) -> String {
        let is_taken = |name: &str| self.registry.names.contains_key(name) || is_taken(name);
        let is_plain = |c: char| c.is_ascii_alphanumeric() || c == '_' || c == '-';
        let plain: String = name.chars().map(|c| if is_plain(c) { c } else { '_' }).collect();
        let plain = if plain.is_empty() { "Object".to_owned() } else { plain };
        let stem = plain.trim_end_matches(|c: char| c.is_ascii_digit());
        let stem = if stem.is_empty() { &plain } else { stem };
        let mut candidates = (0..).map(|k: usize| format!("{stem}{k}"));
        if !is_taken(&plain) {
            return plain;
        }
        candidates.find(|name| !is_taken(name)).expect("there are not that many objects")
    }
}

/// The first finding about an edited scene, as the answer to a call.
fn refused(found: &Diagnostics) -> ApiError {
    let first = found.0.iter().find(|d| d.severity == Severity::Error).or_else(|| found.0.first());
    ApiError(first.map_or_else(
        || "the scene cannot be so".to_owned(),
        |d| match &d.help {
            Some(help) => format!("{}: {help}", d.message),
            None => d.message.clone(),
        },
    ))
}

/// Keys of a table, as a scene file has them.
fn table<const N: usize>(keys: [(&str, Value); N]) -> Map<String, Value> {
    keys.into_iter().map(|(key, value)| (key.to_owned(), value)).collect()
}

/// Keys of a free joint.
fn free_joint(name: &str, parent: &str, pose: &Pose<f64>) -> Map<String, Value> {
    let mut keys = table([("name", name.into()), ("parent", parent.into()), ("kind", "free".into())]);
    keys.extend(sincro_scene::draft::pose_keys(pose));
    keys
}
