//! Limited drives as constraints of the contact problem ([`crate::constraint::kink`]), for the evaluations that follow.

use sincro_actuation::Kink;
use sincro_complementarity::WarmStart;

use super::Mechanism;

impl Mechanism<f64> {
    /// Returns true if a contact or limit is closed.
    pub(crate) fn has_closed(&self) -> bool {
        self.constraints.as_ref().is_some_and(|c| WarmStart::has_closed(&c.memory))
    }

    /// Returns true if limited drives at their kink are constraints of one problem with contacts: where any are closed,
    /// and where prescribed accelerations of locked drives contradict loops.
    pub(crate) fn couples_drives(&self) -> bool {
        !self.drives.is_empty() && (self.has_closed() || self.constraints.as_ref().is_some_and(|c| c.couples_drives))
    }

    /// Sets whether limited drives at their kink are constraints of one problem with loops.
    pub(crate) fn couple_drives_with_loops(&mut self, are_coupled: bool) {
        self.constraints.iter_mut().for_each(|c| c.couples_drives = are_coupled);
    }

    /// Returns true if the last evaluation left accelerations across loops and gears: prescribed ones contradict them.
    pub(crate) fn contradicts_loops(&self) -> bool {
        self.constraints.as_ref().is_some_and(|c| c.leaves_loop_rates())
    }

    /// Returns true if limited drives are constraints of one problem at velocity level: with closed contacts, or with
    /// loop joints and gears, beside which locked drives may be redundant, so that pivoting need not end.
    pub(crate) fn couples_step_drives(&self) -> bool {
        self.couples_drives() || (!self.drives.is_empty() && self.model.params.constraints.n_bilateral() > 0)
    }

    /// Marks locked drives for evaluations with their modes: with closed contacts, limited ones are constraints of the
    /// same problem, the others prescribed degrees of freedom.
    pub(crate) fn mark_modes(&mut self) {
        self.mark_locked();
        if !self.couples_drives() {
            return;
        }
        let (model, drives) = (&self.model, &self.drives);
        let c = self.constraints.as_deref_mut().expect("there are contacts");
        for (drive, _) in model.params.drives.iter().zip(drives).filter(|(_, saturation)| **saturation == 0.0) {
            let dof = drive.dof;
            let Some(limit) = model.drive_limit(drive).filter(|_| !model.is_held(dof)) else { continue };
            self.locked_mask[dof] = 0.0;
            let load_coefficient = model.load_coefficient(drive);
            match c.kinks.iter_mut().find(|kink| kink.dof == dof) {
                Some(kink) => kink.add(limit, load_coefficient),
                None => c.kinks.push(Kink { limit, load_coefficient, ..Kink::locked(dof) }),
            }
        }
    }

    /// Makes drives constraints of the contact problem, whatever their modes; those of the problem apply no torque of
    /// their own.
    pub(crate) fn pose_kinks<'a>(&mut self, kinks: impl Iterator<Item = &'a Kink>) {
        let c = self.constraints.as_deref_mut().expect("there are contacts");
        c.kinks.clear();
        for kink in kinks {
            self.locked_mask[kink.dof] = 0.0;
            c.kinks.push(*kink);
        }
    }

    /// Reads the modes of the drives that were posed from the last evaluation.
    pub(crate) fn read_kinks(&self, kinks: &mut [Kink]) {
        self.constraints.iter().for_each(|c| c.read_kinks(kinks));
    }

    /// Returns true if the contact problem last solved was swept.
    pub(crate) fn was_swept(&self) -> bool {
        self.constraints.as_ref().is_some_and(|c| c.is_swept)
    }

    /// Returns true if kink `n` of those last posed needs all of its limit, or more.
    pub(crate) fn posed_kink_slips(&self, n: usize) -> bool {
        self.constraints.as_ref().is_some_and(|c| c.posed_kink_slips(n))
    }
}
