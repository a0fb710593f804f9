//! Changes of the model by clients and scripts: masses, joint limits, couplings, whether a body is respondable. Each
//! change is kept with the run that has it.

use sincro_dynamics::joint::JointKind;
use sincro_dynamics::model::MassProperties;
use sincro_dynamics::spatial::Vec3;
use sincro_dynamics::world::World;

use super::registry::{Handle, Kind, ObjectRegistry};
use super::{ApiError, Phase, SimApi};
use sincro_sim::controller::Change;

/// Changes that are kept.
const MAX_CHANGES: usize = 10_000;
/// Relative excess over the triangle inequality that is put down to rounding.
const TRIANGLE_SLACK: f64 = 1e-9;
/// A coupling may be that far from its new law `[rad]` or `[m]`.
const FITS: f64 = 1e-9;

/// Error of a change that is one too many.
fn too_many() -> ApiError {
    ApiError(format!("the model was changed {MAX_CHANGES} times already"))
}

impl ObjectRegistry {
    /// Keeps a change; a later one of the same number at the same time takes its place.
    pub(super) fn keep_change(&mut self, change: Change) -> Result<(), ApiError> {
        let same = |c: &Change| (c.t, &*c.object, c.quantity) == (change.t, &*change.object, change.quantity);
        let is_full = self.changes.len() >= MAX_CHANGES;
        match self.changes.iter().position(same) {
            Some(k) => self.changes[k] = change,
            None if is_full => return Err(too_many()),
            None => self.changes.push(change),
        }
        self.is_model_changed |= self.phase == Phase::Stopped;
        Ok(())
    }

    /// Returns true if a change of a number at a time can still be kept.
    fn can_keep(&self, t: f64, object: &str, quantity: &str) -> bool {
        let same = |c: &Change| (c.t, &*c.object, c.quantity) == (t, object, quantity);
        self.changes.len() < MAX_CHANGES || self.changes.iter().any(same)
    }

    /// Differences from the scene.
    #[must_use]
    pub(crate) fn changes(&self) -> &[Change] {
        &self.changes
    }
}

impl SimApi<'_> {
    /// When the next step begins `[s]`; 0 while stopped.
    pub(super) fn acts_at(&self) -> f64 {
        if self.is_running() { self.world.state.tick as f64 * self.registry.base_step() } else { 0.0 }
    }

    /// Keeps a change of a number of an object.
    pub(super) fn change(&mut self, handle: Handle, quantity: &'static str, value: Vec<f64>) -> Result<(), ApiError> {
        let object = self.registry.entry(handle)?.path.clone();
        let t = self.acts_at();
        self.registry.keep_change(Change { t, object, quantity, value })
    }

    /// Checks that a change of a number of an object can be kept, before it is made.
    ///
    /// # Errors
    ///
    /// There is no such object, or the model was changed 10,000 times already.
    pub(super) fn check_change(&self, handle: Handle, quantity: &str) -> Result<(), ApiError> {
        let object = &self.registry.entry(handle)?.path;
        if self.registry.can_keep(self.acts_at(), object, quantity) { Ok(()) } else { Err(too_many()) }
    }

    /// Changes the world; the energy that this adds before the first step of a run that has begun counts as work, as it
    /// does after it.
    fn counted(&mut self, change: impl FnOnce(&mut World)) {
        let is_first = self.registry.has_begun && self.world.state.tick == 0;
        let before = is_first.then(|| self.world.energy().total());
        change(self.world);
        if let Some(before) = before {
            self.world.state.totals[0] += self.world.energy().total() - before;
        }
    }

    /// Gives a body another mass `[kg]`, centre of mass `[m]` and inertia about it `[kg·m²]`, in the axes of the body's
    /// frame. While a run is on the body keeps its velocity, and the energy that this adds or removes counts as work.
    ///
    /// # Errors
    ///
    /// `handle` is no body or is fixed in the world, the mass is not positive, a number is not finite, or no rigid body
    /// has such an inertia (a negative principal moment, or one larger than the sum of the others).
    pub fn set_mass(&mut self, handle: Handle, mass: MassProperties) -> Result<(), ApiError> {
        self.mass(handle)?;
        let path = self.registry.entry(handle)?.path.clone();
        if self.is_fixed(handle)? {
            return Err(ApiError(format!("`{path}` is fixed in the world: it has no mass")));
        }
        check_mass(&path, &mass)?;
        self.change(handle, "mass", vec![mass.mass])?;
        self.change(handle, "center_of_mass", mass.center_of_mass.to_vec())?;
        self.change(handle, "inertia", mass.inertia.to_vec())?;
        self.registry.entry_mut(handle).kind = Kind::Body(mass);
        let body = self.world.model().names().body_id(&path).expect("a body of the scene is one of the model");
        self.counted(|world| world.set_mass_properties(body, mass));
        self.moved();
        Ok(())
    }

    /// The mass properties of a body with another mass `[kg]`, distributed as it is.
    ///
    /// # Errors
    ///
    /// There is no such body.
    pub(crate) fn mass_scaled(&self, handle: Handle, mass: f64) -> Result<MassProperties, ApiError> {
        let old = self.mass(handle)?;
        let factor = mass / old.mass;
        Ok(MassProperties { mass, inertia: old.inertia.map(|i| i * factor), ..old })
    }

    /// Mass, centre of mass and inertia that the solids of a body have at a density [kg/m³].
    ///
    /// # Errors
    ///
    /// There is no such body, it has no solids or a mesh, or the density is not positive.
    pub(crate) fn mass_at_density(&self, handle: Handle, density: f64) -> Result<MassProperties, ApiError> {
        self.mass(handle)?;
        if !(density.is_finite() && density > 0.0) {
            return Err(ApiError(format!("density {density} kg/m³ is not positive")));
        }
        let path = &self.registry.entry(handle)?.path;
        let unit = self.registry.solids.get(&handle).ok_or_else(|| {
            ApiError(format!("`{path}` has no solids of closed form: give it `density` or `mass` in the scene"))
        })?;
        Ok(MassProperties { mass: unit.mass * density, inertia: unit.inertia.map(|i| i * density), ..*unit })
    }

    /// Moves the stops of a joint `[rad]` or `[m]`, or makes them if it has none: a change of the structure.
    ///
    /// # Errors
    ///
    /// There is no such joint, the stops are not in order, or the joint stands beyond them.
    pub(crate) fn set_joint_interval(&mut self, handle: Handle, lower: f64, upper: f64) -> Result<(), ApiError> {
        let is_parked = self.registry.parked.contains_key(&handle);
        let (dof, q) = match self.registry.joint(handle) {
            Ok(joint) => (joint.v_idx, self.world.state.q[joint.q_idx]),
            // it moves nothing yet
            Err(_) if is_parked => (0, 0.0),
            Err(error) => return Err(error),
        };
        let path = self.registry.entry(handle)?.path.clone();
        if !(lower.is_finite() && upper.is_finite() && lower < upper) {
            return Err(ApiError(format!("{lower} to {upper} is no interval for `{path}`")));
        }
        if !(lower..=upper).contains(&q) {
            return Err(ApiError(format!("`{path}` stands at {q}, beyond {lower} to {upper}: put it there first")));
        }
        if is_parked {
            return self.replace_stops(handle, Some([lower, upper]));
        }
        self.check_change(handle, "limits")?;
        if !self.world.set_limits(dof, [Some(lower), Some(upper)]) {
            self.replace_stops(handle, Some([lower, upper]))?;
        }
        self.change(handle, "limits", vec![lower, upper])
    }

    /// Takes the stops of a revolute joint away: it turns without end.
    ///
    /// # Errors
    ///
    /// There is no such joint, or it is not revolute.
    pub(crate) fn remove_joint_stops(&mut self, handle: Handle) -> Result<(), ApiError> {
        if self.registry.parked.contains_key(&handle) {
            return self.replace_stops(handle, None);
        }
        match self.joint_interval(handle)? {
            (true, _) => Ok(()),
            _ if matches!(self.registry.joint(handle)?.kind, JointKind::Revolute { .. }) => {
                self.check_change(handle, "no_limits")?;
                self.replace_stops(handle, None)?;
                self.change(handle, "no_limits", Vec::new())
            }
            _ => Err(ApiError(format!("`{}` is not revolute: it cannot be cyclic", self.registry.entry(handle)?.path))),
        }
    }

    /// Gives the coupling of a joint with its master another offset and factor. While stopped the joint goes to where
    /// the new law has it.
    ///
    /// # Errors
    ///
    /// There is no such joint, the scene couples it with no other or another one, a number is not finite, or a run is
    /// on and the joint stands elsewhere.
    pub(crate) fn set_joint_dependency(
        &mut self,
        handle: Handle,
        master: Handle,
        (offset, factor): (f64, f64),
    ) -> Result<(), ApiError> {
        let (joint, of) = (self.registry.joint(handle)?.clone(), self.registry.joint(master)?.clone());
        let path = self.registry.entry(handle)?.path.clone();
        if !(offset.is_finite() && factor.is_finite() && factor != 0.0) {
            return Err(ApiError(format!(
                "offset {offset} and factor {factor}: expected numbers, the factor not zero"
            )));
        }
        let couplings = &self.world.model().constraints().gears;
        let found = couplings.iter().position(|c| c.dofs == [of.v_idx, joint.v_idx]);
        let Some(k) = found else {
            let master = &self.registry.entry(master)?.path;
            let help = "couplings are changed, not made: add a [[coupling]] to the scene";
            return Err(ApiError(format!("the scene does not couple `{path}` with `{master}`: {help}")));
        };
        if couplings[k].higher != [0.0; 3] {
            let master = &self.registry.entry(master)?.path;
            let help = "change `polynomial` of its [[coupling]] in the scene";
            return Err(ApiError(format!(
                "`{path}` follows `{master}` by a polynomial, which has no one factor: {help}"
            )));
        }
        self.check_change(handle, "coupling")?;
        let q = &mut self.world.state.q;
        let wanted = factor * q[of.q_idx] + offset;
        if !wanted.is_finite() {
            return Err(ApiError(format!("factor {factor} has `{path}` at {wanted}")));
        }
        if self.registry.phase == Phase::Stopped {
            q[joint.q_idx] = wanted;
        } else if (wanted - q[joint.q_idx]).abs() > FITS {
            let now = q[joint.q_idx];
            return Err(ApiError(format!(
                "`{path}` stands at {now}, the new law has it at {wanted}: stop the run first"
            )));
        }
        self.world.set_gear(k, factor, offset);
        self.moved();
        self.change(handle, "coupling", vec![factor, offset])
    }

    /// Sets the acceleration of gravity `[m/s²]` as x, y, z in world axes. While a run is on, the energy that this adds
    /// or removes counts as work.
    ///
    /// # Errors
    ///
    /// A number is not finite, or the model was changed 10,000 times already; gravity is then as it was.
    pub fn set_gravity(&mut self, gravity: [f64; 3]) -> Result<(), ApiError> {
        if !gravity.iter().all(|x| x.is_finite()) {
            return Err(ApiError(format!("gravity {gravity:?} is not finite")));
        }
        let t = self.acts_at();
        let change = Change { t, object: "/".into(), quantity: "gravity", value: gravity.to_vec() };
        self.registry.keep_change(change)?;
        self.counted(|world| world.set_gravity(Vec3(gravity)));
        self.moved();
        Ok(())
    }

    /// Returns true if a body touches others.
    ///
    /// # Errors
    ///
    /// There is no such body, or it has no contact in the scene.
    pub(crate) fn is_respondable(&self, handle: Handle) -> Result<bool, ApiError> {
        self.mass(handle)?;
        Ok(self.can_touch(handle).is_ok() && !self.registry.passing.contains(&handle))
    }

    /// Lets a body pass through all others, or touch them again.
    ///
    /// # Errors
    ///
    /// There is no such body, or it is to touch others and has no contact in the scene.
    pub(crate) fn set_respondable(&mut self, handle: Handle, touches: bool) -> Result<(), ApiError> {
        self.mass(handle)?;
        match self.can_touch(handle) {
            Err(_) if !touches => return Ok(()),
            able => able?,
        }
        self.change(handle, "respondable", vec![f64::from(u8::from(touches))])?;
        if touches {
            self.registry.passing.remove(&handle);
        } else {
            self.registry.passing.insert(handle);
        }
        self.restore_pairs();
        Ok(())
    }
}

/// Refuses what the scene file would refuse or warn of.
fn check_mass(path: &str, mass: &MassProperties) -> Result<(), ApiError> {
    let m = mass.mass;
    if !(m.is_finite() && m > 0.0) {
        return Err(ApiError(format!("mass {m} kg of `{path}` is not positive")));
    }
    if !mass.center_of_mass.iter().chain(&mass.inertia).all(|x| x.is_finite()) {
        return Err(ApiError(format!("centre of mass or inertia of `{path}` has numbers that are not finite")));
    }
    let [least, middle, largest] = mass.principal_moments();
    if least < -1e-12 * largest.abs() {
        return Err(ApiError(format!("inertia of `{path}` has a negative principal moment, {least:.6e} kg·m²")));
    }
    if mass.triangle_excess() > TRIANGLE_SLACK {
        let sum = least + middle;
        return Err(ApiError(format!(
            "no rigid body has the inertia of `{path}`: its largest principal moment {largest:.6e} kg·m² exceeds the sum of the others, {sum:.6e}"
        )));
    }
    Ok(())
}
