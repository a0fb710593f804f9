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
            let is_told = pair.bodies.iter().any(|body| self.registry.passing.contains(body));
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
            let passes = pair.bodies.iter().any(|body| self.registry.passing.contains(body));
            self.world.set_pair(k, passes, pair.material);
        }
    }
}
