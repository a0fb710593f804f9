//! Pairs of bodies that may touch: who is near, and what a script says that a pair is to do in the coming step
//! (`sysCall_contact`).

use std::collections::BTreeMap;

use sincro_dynamics::contact::Material;

use super::registry::{Handle, ObjectRegistry};
use super::{ApiError, SimApi};
use sincro_scene::scene::Scene;

/// A pair of surfaces of the model, by its bodies.
#[derive(Clone, Debug)]
pub(super) struct Pair {
    bodies: [Handle; 2],
    /// Contact material of the scene for the pair.
    material: Material,
}

/// Contact law that a script (`sysCall_contact`) sets for a pair of bodies in the coming step, see
/// [`SimApi::override_contact`]. The default leaves the law of the scene.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ContactOverride {
    /// True if the bodies pass through each other: no contact force.
    pub passes: bool,
    /// Coefficient of friction of the pair (dimensionless, 0 or more); none: that of the scene.
    pub friction: Option<f64>,
    /// Coefficient of restitution of the pair (dimensionless, 0 to 1); none: that of the scene.
    pub restitution: Option<f64>,
}

/// The pairs of a scene, in the model's order.
pub(super) fn pairs_of(scene: &Scene, registry: &ObjectRegistry) -> Vec<Pair> {
    let set = scene.model.constraints();
    let mut handles: BTreeMap<&str, Handle> = BTreeMap::new();
    for entry in registry.entries() {
        handles.entry(&entry.path).or_insert(entry.handle);
    }
    let bodies: Vec<Handle> =
        set.colliders.iter().map(|c| handles.get(&*c.name).copied().unwrap_or(Handle(-1))).collect();
    let both = |a: usize, b: usize| {
        let mut bodies = [bodies[a], bodies[b]];
        bodies.sort_unstable();
        bodies
    };
    set.pairs.iter().map(|p| Pair { bodies: both(p.a, p.b), material: p.material }).collect()
}

impl SimApi<'_> {
    /// Pairs of bodies that may come to touch within the coming step of clients, each pair once, in the order of the
    /// scene; the two handles of a pair are in ascending order. Contact laws that were overridden before are those of
    /// the scene again.
    pub fn candidate_pairs(&mut self) -> Vec<[Handle; 2]> {
        self.restore_pairs();
        let mut near = Vec::new();
        let step = self.registry.sample_time();
        self.world.near(step, &mut near);
        self.moved();
        let mut bodies: Vec<[Handle; 2]> = Vec::new();
        for pair in near.into_iter().map(|k| &self.registry.pairs[k]) {
            let is_told = self.registry.is_passing(pair.bodies);
            if !is_told && !bodies.contains(&pair.bodies) {
                bodies.push(pair.bodies);
            }
        }
        bodies
    }

    /// Sets the contact law of two bodies, in the order of [`SimApi::candidate_pairs`], until that is called again.
    /// Bodies that are no pair of the scene are ignored.
    ///
    /// # Errors
    ///
    /// The coefficient of friction is negative or not finite, or that of restitution is outside 0 to 1.
    pub fn override_contact(&mut self, bodies: [Handle; 2], answer: ContactOverride) -> Result<(), ApiError> {
        if let Some(x) = answer.friction.filter(|x| !(x.is_finite() && *x >= 0.0)) {
            return Err(ApiError(format!("friction {x} of a contact, expected 0 or more")));
        }
        if let Some(x) = answer.restitution.filter(|x| !(0.0..=1.0).contains(x)) {
            return Err(ApiError(format!("restitution {x} of a contact, expected 0 to 1")));
        }
        for (k, pair) in self.registry.pairs.iter().enumerate().filter(|(_, pair)| pair.bodies == bodies) {
            let mut material = pair.material;
            material.friction = answer.friction.unwrap_or(material.friction);
            material.restitution = answer.restitution.unwrap_or(material.restitution);
            self.world.set_pair(k, answer.passes, material);
        }
        Ok(())
    }

    /// Every pair does what the scene says, but those of bodies that pass through all others.
    pub(crate) fn restore_pairs(&mut self) {
        for (k, pair) in self.registry.pairs.iter().enumerate() {
            self.world.set_pair(k, self.registry.is_passing(pair.bodies), pair.material);
        }
    }

    /// Respondable mask of a body or shape: the low byte for those of the same tree, the next byte for all others.
    pub(crate) fn respondable_mask(&self, handle: Handle) -> i64 {
        self.registry.respondable_masks.get(&handle).copied().unwrap_or(ALL_BITS)
    }

    /// Sets the respondable mask of a body or shape, between two steps.
    ///
    /// # Errors
    ///
    /// The mask has other bits than 16, or the change cannot be kept.
    pub(crate) fn set_respondable_mask(&mut self, handle: Handle, mask: i64) -> Result<(), ApiError> {
        if !(0..=ALL_BITS).contains(&mask) {
            return Err(ApiError(format!("the respondable mask {mask}, expected 0 to {ALL_BITS}")));
        }
        if mask == self.respondable_mask(handle) {
            return Ok(());
        }
        self.change(handle, "respondable_mask", vec![mask as f64])?;
        self.registry.respondable_masks.insert(handle, mask);
        self.restore_pairs();
        Ok(())
    }
}

/// Mask of a body that touches all others.
const ALL_BITS: i64 = 0xffff;
/// Bits for bodies of the same tree.
const LOCAL: i64 = 0xff;

impl ObjectRegistry {
    /// Returns true if two bodies of a pair pass through each other: one of them passes through all, or their
    /// respondable masks have no bit in common.
    fn is_passing(&self, bodies: [Handle; 2]) -> bool {
        if bodies.iter().any(|body| self.passing.contains(body)) {
            return true;
        }
        // what is fixed in the world touches nothing else that is, nor a belt
        let is_fixed = |body: &Handle| {
            self.belts.contains_key(body) || self.entry(*body).is_ok_and(|entry| entry.frame.link.is_none())
        };
        if bodies.iter().any(|body| self.belts.contains_key(body)) && bodies.iter().all(is_fixed) {
            return true;
        }
        let [a, b] = bodies.map(|body| self.respondable_masks.get(&body).copied().unwrap_or(ALL_BITS));
        if a & b == ALL_BITS {
            return false;
        }
        let [root_a, root_b] = bodies.map(|body| self.root(body));
        let which = if root_a == root_b { LOCAL } else { ALL_BITS & !LOCAL };
        a & b & which == 0
    }

    /// Topmost object above one.
    fn root(&self, handle: Handle) -> Handle {
        let chain = std::iter::successors(Some(handle), |at| self.visible_parent(*at));
        chain.take(self.entries.len() + 1).last().unwrap_or(handle)
    }
}
