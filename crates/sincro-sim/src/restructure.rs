//! Change of the structure of a run between two steps: the world goes on with another scene.
//!
//! ```text
//! scene ── SceneDraft: add, remove, hang, load ──► scene'      compiled as any scene
//! world, state ── transfer by object ──► world'                state', parameters, statistics
//! ```
//!
//! Objects are known by their numbers ([`Object::id`](sincro_scene::scene::Object)), whatever their paths become. A
//! controller that changes the structure replaces the world by [`restructure`] while it is called and gives the result
//! to the lock-step ([`Controller::take_restructured`](crate::controller::Controller::take_restructured)), which tells
//! the others. Recorded columns are those of the start: signals of objects that have gone are NaN.

use std::collections::{BTreeMap, BTreeSet};
use std::hash::Hasher;
use std::sync::Arc;

use sincro_dynamics::kinematics::Attached;
use sincro_dynamics::model::Model;
use sincro_dynamics::transfer::{Origin, Transferred, transfer};
use sincro_dynamics::world::World;
use sincro_scene::scene::{Scene, frame_of};
use twox_hash::XxHash3_64;

/// Change of the structure that has been made in a world.
#[derive(Clone, Debug)]
pub struct Restructured {
    /// Scene from now on; its initial state is that of the world after the change.
    pub scene: Arc<Scene>,
    /// Model before the change.
    pub former: Model<f64>,
    /// Paths of the former objects now.
    pub renamed: Renamed,
    /// State and what it was made of.
    pub transferred: Transferred,
    /// Changes that this one is made of, in their order.
    pub steps: Vec<StructureStep>,
}

/// One change of the structure, as the trace of the run counts it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StructureStep {
    /// Hash of the scene after it.
    pub hash: u64,
    /// Energy that it has brought in or taken out `[J]`.
    pub energy: f64,
}

impl Restructured {
    /// Joins a change with one that was made at the same time after it: one change, from before the first to after the
    /// second, which the trace counts as both. If the second only put objects elsewhere that the first has put
    /// (`is_placement`), they are one for the trace, too.
    ///
    /// # Panics
    ///
    /// `next` is of a model with other commands than this change leads to.
    #[must_use]
    pub fn then(self, next: Self, is_placement: bool) -> Self {
        let (first, second) = (self.transferred, next.transferred);
        let commands = second.commands.iter().map(|middle| middle.and_then(|k| first.commands[k])).collect();
        let transferred = Transferred {
            state: second.state,
            commands,
            momentum_change: first.momentum_change + second.momentum_change,
            angular_momentum_change: first.angular_momentum_change + second.angular_momentum_change,
            energy_change: first.energy_change + second.energy_change,
            joining_loss: first.joining_loss + second.joining_loss,
        };
        let mut steps = self.steps;
        let mut added = next.steps;
        if let (true, Some(last), Some(first)) = (is_placement, steps.last().copied(), added.first_mut()) {
            first.energy += last.energy;
            steps.pop();
        }
        steps.append(&mut added);
        let renamed = self.renamed.then(&next.renamed);
        Self { scene: next.scene, former: self.former, renamed, transferred, steps }
    }
}

/// Edit of a structure: from which scene to which.
#[derive(Clone, Copy, Debug)]
pub struct Edit<'a> {
    /// Scene as it was.
    pub from: &'a Scene,
    /// Number of the object that each new object is a copy of, by its own number.
    pub copies: &'a BTreeMap<usize, usize>,
    /// True if velocities of bodies that were joined or parted follow from their momenta; false if objects were put
    /// elsewhere, so that all joints keep their velocities.
    pub conserves_momentum: bool,
}

/// Replaces a world by that of the scene `to`, with the state of all that both have; see [`transfer`].
///
/// ```
/// use std::collections::BTreeMap;
///
/// use sincro_scene::draft::SceneDraft;
/// use sincro_sim::prelude::*;
/// use sincro_sim::restructure::{Edit, restructure};
///
/// # fn main() -> Result<(), Box<dyn std::error::Error>> {
/// let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/../../scenes/free-body");
/// let loaded = load(folder.as_ref(), &[], Extensions::default())?;
/// let mut run = LockStep::new(&loaded, method_for(&loaded).0, false);
/// let scene = &loaded.scene;
/// let mut draft = SceneDraft::new(scene).unwrap();
/// let root = scene.objects[0].path.clone();
/// let copied = draft.copy(&root, "second", "/", &scene.objects[0].pose);
/// let to = draft.compile(scene.objects.len())?;
/// let id = |path: &str, scene: &sincro_scene::scene::Scene| scene.object(path).unwrap().id;
/// let copies = copied.iter().map(|(old, new)| (id(new, &to), id(old, scene))).collect();
/// let n = run.world().state.v.len();
/// restructure(run.world(), to, &Edit { from: scene, copies: &copies, conserves_momentum: true });
/// assert_eq!(run.world().state.v.len(), 2 * n);
/// # Ok(())
/// # }
/// ```
pub fn restructure(world: &mut World, mut to: Scene, edit: &Edit<'_>) -> Restructured {
    let Edit { from, copies, conserves_momentum } = *edit;
    let old_path: BTreeMap<usize, &str> = from.objects.iter().map(|o| (o.id, o.path.as_str())).collect();
    let mut origins = BTreeMap::new();
    for object in &to.objects {
        let same = old_path.get(&object.id).map(|path| (*path, true));
        let copied = || copies.get(&object.id).and_then(|id| old_path.get(id)).map(|path| (*path, false));
        if let Some((path, is_same)) = same.or_else(copied) {
            origins.insert(object.path.clone(), Origin { name: path.to_owned(), is_same });
        }
    }
    // what joins objects is no object: it is known by its name
    let objects: BTreeSet<&str> = to.objects.iter().map(|object| object.path.as_str()).collect();
    let origin = |name: &str| match origins.get(name) {
        None if !objects.contains(name) => Some(Origin { name: name.to_owned(), is_same: true }),
        found => found.cloned(),
    };
    let mut model = (*to.model).clone();
    let initial = to.initial.clone();
    let former = world.model().clone();
    let transferred = transfer((&former, &world.state), (&mut model, initial), &origin, conserves_momentum);
    let (links, renamed) = (links_of(from, &to), Renamed::new(from, &to));
    *world = world.continued(model, transferred.state.clone(), &|link| links.get(&link).copied());
    to.initial = transferred.state.clone();
    let steps = vec![StructureStep { hash: scene_hash(&to), energy: transferred.energy_change }];
    Restructured { scene: Arc::new(to), former, renamed, transferred, steps }
}

/// Hash of an edited scene: of the text that it was compiled from, or of its model if it knows none. A model has a
/// number for each pair of colliders, a text only for each object.
fn scene_hash(scene: &Scene) -> u64 {
    let mut hasher = XxHash3_64::with_seed(0);
    match &scene.source {
        Some(source) => hasher.write(source.document.source.text.as_bytes()),
        None => hasher.write(format!("{:?}", scene.model).as_bytes()),
    }
    hasher.finish()
}

/// New place of each former link: where an object on it is now.
fn links_of(from: &Scene, to: &Scene) -> BTreeMap<usize, Attached<f64>> {
    let place: BTreeMap<usize, usize> = to.objects.iter().enumerate().map(|(k, object)| (object.id, k)).collect();
    let mut links = BTreeMap::new();
    for (k, object) in from.objects.iter().enumerate() {
        let old = frame_of(from, k);
        let (Some(link), Some(now)) = (old.link, place.get(&object.id)) else { continue };
        let new = frame_of(to, *now);
        links.entry(link).or_insert(Attached { pose: new.pose.compose(&old.pose.inverse()), ..new });
    }
    links
}

/// Paths now of the objects of an earlier scene.
#[derive(Clone, Debug)]
pub struct Renamed {
    /// Path now of each earlier path; `None` for what has gone.
    paths: BTreeMap<String, Option<String>>,
}

impl Renamed {
    /// Compares the objects of an earlier scene with those now.
    #[must_use]
    pub fn new(earlier: &Scene, now: &Scene) -> Self {
        let present: BTreeMap<usize, &str> = now.objects.iter().map(|o| (o.id, o.path.as_str())).collect();
        let path = |id: &usize| present.get(id).map(|path| (*path).to_owned());
        Self { paths: earlier.objects.iter().map(|o| (o.path.clone(), path(&o.id))).collect() }
    }

    /// Paths after a further change.
    fn then(&self, next: &Self) -> Self {
        let path = |middle: &Option<String>| middle.as_ref().and_then(|middle| next.path(middle));
        Self { paths: self.paths.iter().map(|(earlier, middle)| (earlier.clone(), path(middle))).collect() }
    }

    /// Returns the path now of an object that had the path `earlier`; `None` if it has gone. What is no object, such as
    /// a closure or a spring between two bodies, keeps its name.
    #[must_use]
    pub fn path(&self, earlier: &str) -> Option<String> {
        self.paths.get(earlier).cloned().unwrap_or_else(|| Some(earlier.to_owned()))
    }
}
