//! Frames of a run whose structure has changed: where what the frames describe is now.

use std::collections::BTreeMap;

use sincro_dynamics::kinematics::Attached;
use sincro_scene::scene::{ObjectKind, Scene, frame_of};

use super::trajectory::Layout;

/// Index of the surface of a contact that is of no object of the start.
const NO_SURFACE: usize = (1 << 24) - 1;

/// Place, in the present model, of everything that a [`Layout`] has of the scene at the start; `None` for what has
/// gone, which is NaN in frames.
#[derive(Clone, Debug)]
pub struct FrameMap {
    /// Frame of each mover: it goes with an object that stood on it at the start.
    pub(super) movers: Vec<Option<Attached<f64>>>,
    /// Index of each rotor.
    pub(super) rotors: Vec<Option<usize>>,
    /// Index of each external force.
    pub(super) forces: Vec<Option<usize>>,
    /// Index of each drag element.
    pub(super) drags: Vec<Option<usize>>,
    /// Index of each coordinate.
    pub(super) q: Vec<Option<usize>>,
    /// Index of each velocity.
    pub(super) v: Vec<Option<usize>>,
    /// Index at the start of each surface.
    pub(super) surfaces: Vec<usize>,
}

impl FrameMap {
    /// Returns the link that carries a mover now; `None` if it has gone or is fixed in the world.
    ///
    /// # Panics
    ///
    /// If there is no such mover.
    #[must_use]
    pub fn link(&self, mover: usize) -> Option<usize> {
        self.movers[mover].as_ref()?.link
    }

    /// Compares the scene at the start, which has the frames' `layout`, with the scene now.
    #[must_use]
    pub fn new(layout: &Layout, start: &Scene, now: &Scene) -> Self {
        let place: BTreeMap<usize, usize> = now.objects.iter().enumerate().map(|(k, o)| (o.id, k)).collect();
        let path: BTreeMap<&str, &str> = start
            .objects
            .iter()
            .filter_map(|o| place.get(&o.id).map(|k| (o.path.as_str(), now.objects[*k].path.as_str())))
            .collect();
        let mover = |link: &usize| {
            let on_link = |k: &usize| frame_of(start, *k).link == Some(*link);
            let is_body = |k: &usize| matches!(start.objects[*k].kind, ObjectKind::Body { .. });
            let there: Vec<usize> = (0..start.objects.len()).filter(on_link).collect();
            let witness = there.iter().find(|k| is_body(k)).or_else(|| there.first())?;
            let now_at = frame_of(now, *place.get(&start.objects[*witness].id)?);
            let offset = frame_of(start, *witness).pose.inverse();
            Some(Attached { pose: now_at.pose.compose(&offset), ..now_at })
        };
        let (old, new) = (start.model.names(), now.model.names());
        let rotor = |name: &String| {
            let now = path.get(name.as_str())?;
            new.rotors.iter().position(|rotor| rotor == now)
        };
        // forces and drags are added in the order of the objects
        let nth = |is_of: fn(&ObjectKind) -> bool| -> Vec<Option<usize>> {
            let present: Vec<usize> = now.objects.iter().filter(|o| is_of(&o.kind)).map(|o| o.id).collect();
            let of_start = start.objects.iter().filter(|o| is_of(&o.kind));
            of_start.map(|o| present.iter().position(|id| *id == o.id)).collect()
        };
        let (mut q, mut v) = (vec![None; start.model.n_q()], vec![None; start.model.n_v()]);
        for joint in &old.joints {
            let found = path.get(joint.name.as_str()).and_then(|name| new.joint(name));
            let Some(found) = found.filter(|other| (other.n_q, other.n_v) == (joint.n_q, joint.n_v)) else { continue };
            (0..joint.n_q).for_each(|k| q[joint.q_idx + k] = Some(found.q_idx + k));
            (0..joint.n_v).for_each(|k| v[joint.v_idx + k] = Some(found.v_idx + k));
        }
        let of_start = &start.model.constraints().colliders;
        let surface = |k: usize| {
            let all = &now.model.constraints().colliders;
            let n = all[..k].iter().filter(|c| c.name == all[k].name).count();
            let is_it =
                |c: &sincro_dynamics::contact::Collider| path.get(c.name.as_str()) == Some(&all[k].name.as_str());
            of_start.iter().enumerate().filter(|(_, c)| is_it(c)).nth(n).map_or(NO_SURFACE, |(k, _)| k)
        };
        Self {
            movers: layout.links().iter().map(mover).collect(),
            rotors: old.rotors.iter().map(rotor).collect(),
            forces: nth(|kind| *kind == ObjectKind::Force),
            drags: nth(|kind| *kind == ObjectKind::Drag),
            q,
            v,
            surfaces: (0..now.model.constraints().colliders.len()).map(surface).collect(),
        }
    }
}
