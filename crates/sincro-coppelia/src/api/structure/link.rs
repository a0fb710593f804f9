//! Dummies that are linked (`sim.setLinkDummy`): the bodies that carry them are joined rigidly while they are.
//!
//! In V-REP such a link is a constraint of the dynamics that keeps the dummies at the same place. Here one of the
//! bodies, which has to be free, is hung on the other, as in a perfectly inelastic impact, and parted when the link
//! ends.

use std::collections::BTreeSet;

use crate::api::registry::{Handle, Kind, ObjectRegistry};
use crate::api::{ApiError, SimApi};

/// Link of a dummy with another one.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::api) struct Link {
    other: Handle,
    /// Body that was hung on another one for the link.
    joined: Handle,
    /// Body that it was hung on.
    carrier: Handle,
}

impl Link {
    /// Returns true if the link has joined a body to another one.
    pub(super) fn has_joined(&self, body: Handle) -> bool {
        self.joined == body
    }

    /// Returns true if an object is a dummy or a body of the link, `dummy` being the one that has it.
    fn concerns(&self, dummy: Handle, object: Handle) -> bool {
        [dummy, self.other, self.joined, self.carrier].contains(&object)
    }
}

impl ObjectRegistry {
    /// Forgets the links of an object that has gone.
    pub(in crate::api) fn forget_links(&mut self, object: Handle) {
        self.dummy_links.retain(|dummy, link| !link.concerns(*dummy, object));
    }
}

impl SimApi<'_> {
    /// Dummy that another one is linked with.
    pub(crate) fn linked_dummy(&self, dummy: Handle) -> Option<Handle> {
        self.registry.dummy_links.get(&dummy).map(|link| link.other)
    }

    /// Links a dummy with another one, or with none.
    ///
    /// # Errors
    ///
    /// None of the bodies that carry them is free, or they cannot be joined.
    pub(crate) fn link_dummies(&mut self, dummy: Handle, other: Option<Handle>) -> Result<(), ApiError> {
        for end in [Some(dummy), other].into_iter().flatten() {
            self.unlink(end)?;
        }
        let Some(other) = other else { return Ok(()) };
        let [a, b] = [self.body_above(dummy)?, self.body_above(other)?];
        let free = |sim: &Self, body: Option<Handle>| {
            body.filter(|body| sim.registry.entry(*body).is_ok_and(|entry| entry.frame.link.is_some()))
                .filter(|body| sim.is_carried_freely(*body))
        };
        let (joined, carrier) = match (free(self, a), free(self, b)) {
            (Some(a), _) => (a, b),
            (None, Some(b)) => (b, a),
            (None, None) => {
                let help = "one of the bodies that carry them has to be free; closures belong to the scene file";
                return Err(ApiError(format!("the dummies cannot be linked: {help}")));
            }
        };
        let carrier = carrier.ok_or_else(|| ApiError::new("a dummy that no body carries is linked with none"))?;
        self.set_parent(joined, Some(carrier), true)?;
        self.registry.dummy_links.insert(dummy, Link { other, joined, carrier });
        self.registry.dummy_links.insert(other, Link { other: dummy, joined, carrier });
        Ok(())
    }

    /// Ends the links of objects: of dummies, and those that join one of the bodies. Returns true if there were any.
    ///
    /// # Errors
    ///
    /// The bodies cannot be parted.
    pub(super) fn unlink_all(&mut self, objects: &BTreeSet<Handle>) -> Result<bool, ApiError> {
        let links = self.registry.dummy_links.iter();
        let concerned = links.filter(|(dummy, link)| objects.iter().any(|object| link.concerns(**dummy, *object)));
        let dummies: Vec<Handle> = concerned.map(|(dummy, _)| *dummy).collect();
        dummies.iter().try_for_each(|dummy| self.unlink(*dummy))?;
        Ok(!dummies.is_empty())
    }

    /// Ends the link of a dummy, and parts the bodies if they still hang on each other for it.
    fn unlink(&mut self, dummy: Handle) -> Result<(), ApiError> {
        let Some(link) = self.registry.dummy_links.get(&dummy).copied() else { return Ok(()) };
        if self.registry.visible_parent(link.joined) == Some(link.carrier) {
            self.set_parent(link.joined, None, true)?;
        }
        self.registry.dummy_links.remove(&dummy);
        self.registry.dummy_links.remove(&link.other);
        Ok(())
    }

    /// Nearest body above an object.
    fn body_above(&self, handle: Handle) -> Result<Option<Handle>, ApiError> {
        self.registry.entry(handle)?;
        let chain = std::iter::successors(Some(handle), |at| self.registry.visible_parent(*at));
        let is_body = |h: &Handle| self.registry.entry(*h).is_ok_and(|entry| matches!(entry.kind, Kind::Body(_)));
        Ok(chain.skip(1).find(is_body))
    }

    /// Returns true if a free joint of the world carries a body and nothing else of the model.
    fn is_carried_freely(&self, body: Handle) -> bool {
        self.free_carrier(body).is_some_and(|joint| self.is_free_joint(joint))
    }
}
