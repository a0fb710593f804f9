//! Parameter changes of a world between two steps: masses, gravity, bounds of joint limits, gears, contact laws of
//! pairs.

use std::sync::Arc;

use super::World;
use crate::contact::Material;
use crate::ids::BodyId;
use crate::model::{MassProperties, Model, ModelParams};
use crate::recursions::kinematics;
use crate::spatial::Vec3;

/// Distance below which surfaces count as near whatever their speed `[m]`.
const NEAR: f64 = 1e-3;

impl World {
    /// Replaces all parameters, as when a snapshot is restored; no work is counted. Drives that were not there are
    /// locked.
    ///
    /// # Panics
    ///
    /// If they are of a model of another structure.
    pub fn set_params(&mut self, params: &ModelParams<f64>) {
        self.mark_model_changed();
        self.mechanism.model.set_params(params);
        self.mechanism.resize_drives();
        self.resize_drives();
    }

    /// Sets the mass properties of a body in its own frame. Coordinates and rates stay; the change of energy is counted
    /// as work, unless no step has been made yet.
    ///
    /// # Panics
    ///
    /// If the model has no such body.
    pub fn set_mass_properties(&mut self, body: BodyId, mass: MassProperties) {
        self.mark_model_changed();
        let before = self.energy().total();
        self.mechanism.model.set_mass_properties(body, mass);
        if self.state.tick > 0 {
            self.state.totals[0] += self.energy().total() - before;
        }
    }

    /// Sets the gravitational acceleration `[m/s²]`, world axes; the change of energy is counted as work, unless no
    /// step has been made yet.
    pub fn set_gravity(&mut self, gravity: Vec3<f64>) {
        self.mark_model_changed();
        let before = self.energy().total();
        self.mechanism.model.params.gravity = gravity;
        if self.state.tick > 0 {
            self.state.totals[0] += self.energy().total() - before;
        }
    }

    /// Sets the lower and upper limit `[rad]` or `[m]` of degree of freedom `dof` (0 to n_v − 1), `None` where it has
    /// none. Returns false, and changes nothing, if it has other limits than those given.
    pub fn set_limits(&mut self, dof: usize, bounds: [Option<f64>; 2]) -> bool {
        self.mark_model_changed();
        let has = |sign: f64, model: &Model<f64>| {
            model.params.constraints.limits.iter().any(|l| l.dof == dof && l.sign == sign)
        };
        let model = &mut self.mechanism.model;
        let signs = [1.0, -1.0];
        if signs.iter().zip(bounds).any(|(sign, bound)| bound.is_some() != has(*sign, model)) {
            return false;
        }
        for limit in Arc::make_mut(&mut model.params.constraints).limits.iter_mut().filter(|l| l.dof == dof) {
            let bound = bounds[usize::from(limit.sign < 0.0)];
            limit.bound = bound.unwrap_or(limit.bound);
        }
        true
    }

    /// Sets ratio (q̇₂ over q̇₁) and offset `[rad]` or `[m]` of gear `k`, an index in
    /// [`ConstraintSet::gears`](crate::model::ConstraintSet).
    ///
    /// # Panics
    ///
    /// If there is no such gear.
    pub fn set_gear(&mut self, k: usize, ratio: f64, offset: f64) {
        self.mark_model_changed();
        let gear = &mut Arc::make_mut(&mut self.mechanism.model.params.constraints).gears[k];
        (gear.ratio, gear.offset) = (ratio, offset);
    }

    /// Sets the contact law of a pair of colliders, an index in [`ConstraintSet::pairs`](crate::model::ConstraintSet);
    /// `is_ignored` ends its contacts from the next step on.
    ///
    /// # Panics
    ///
    /// If there is no such pair.
    pub fn set_pair(&mut self, pair: usize, is_ignored: bool, material: Material) {
        self.mark_model_changed();
        let set = &mut self.mechanism.model.params.constraints;
        let known = &set.pairs[pair];
        // the scene's own set of constraints is copied once, when the first pair differs
        if known.is_ignored != is_ignored || known.material != material {
            let changed = &mut Arc::make_mut(set).pairs[pair];
            (changed.is_ignored, changed.material) = (is_ignored, material);
        }
    }

    /// Broad phase over a step of `h` `[s]`: replaces the content of `found` by the pairs of colliders (indices in
    /// [`ConstraintSet::pairs`](crate::model::ConstraintSet), ascending) that may come into contact in it.
    ///
    /// Their bounding spheres are closer than 1 mm plus twice the distance that the two surfaces travel plus four times
    /// the fall.
    pub fn near(&mut self, h: f64, found: &mut Vec<usize>) {
        found.clear();
        let mechanism = &mut self.mechanism;
        let Some(c) = mechanism.constraints.as_deref_mut() else { return };
        let (model, scratch) = (&mechanism.model, &mut mechanism.scratch);
        kinematics::poses(model, &self.state.q, scratch);
        c.motions.place(model, scratch, &self.state.v);
        let set = &*model.params.constraints;
        let fall = 4.0 * h * h * model.strongest_gravity(&scratch.poses);
        let speed = |k: usize| c.speed(k, &set.colliders[k], &scratch.poses);
        let is_near = |k: &usize| {
            let pair = &set.pairs[*k];
            let margin = NEAR + 2.0 * h * (speed(pair.a) + speed(pair.b)) + fall;
            c.detector.is_near(pair, (&set.colliders[pair.a], &set.colliders[pair.b]), &scratch.poses, margin)
        };
        found.extend((0..set.pairs.len()).filter(is_near));
    }
}
