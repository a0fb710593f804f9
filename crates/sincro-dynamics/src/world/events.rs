//! Events that end a sub-step: zero crossings of drives, contacts and the coupled system, detected at its end and
//! within it, located by repeating it.
//!
//! Modes are held over a sub-step ([`crate::constraint`]), so that a zero crossing is a smooth function of time up to
//! its event and beyond.

use super::{Stop, World};
use crate::constraint::ModeRule;
use crate::coupled::CoupledSystem;
use crate::integrate::{Bracket, Control, Sample, System};
use crate::mechanism::constraints::ContactEvent;
use crate::mechanism::passages::Looks;

/// Width to which the instant of an event is located, relative to the step.
const EVENT_RESOLUTION: f64 = 1e-13;

/// Error of the state by the width to which the instant of an event is located, relative to the accuracy.
const EVENT_ACCURACY: f64 = 1e-4;

/// Largest width, relative to the step, to which the instant is located at which a force reaches its bound, where slow
/// states would allow more: what is at rest shows nothing of the forces on it, and begins to move with an acceleration
/// that grows from zero.
const FORCE_RESOLUTION: f64 = 1e-9;

/// The same of an event of the coupled system, from which any acceleration may follow at once.
const COUPLED_RESOLUTION: f64 = 1e-11;

/// Value of a zero crossing that is as good as zero, relative to its terms.
const VALUE_RESOLUTION: f64 = 1e-14;

/// Size of a value relative to the last one above which a search has come no nearer to zero.
const STALLED: f64 = 0.25;

/// Values between which such a search may end, relative to those that are as good as zero.
const NOISE: f64 = 30.0;

/// Distance of the instants within a step that are looked at where a law seems violated, relative to the step.
const INTERIOR_STEP: f64 = 0.125;

/// Number of kinds of zero crossings.
pub(super) const MAX_CROSSINGS: usize = 7;

/// Maximum number of events of the coupled system at one instant that follow from each other.
const MAX_EVENT_ITERATIONS: usize = 100;

/// Zero crossing.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Crossing {
    /// A saturated drive passes its target velocity.
    Target(usize),
    /// The reaction on a locked drive exceeds its limit.
    Overload(usize),
    /// A contact or limit.
    Contact(ContactEvent),
    /// Zero-crossing function of the coupled system.
    Coupled(usize),
}

impl World {
    /// Finds the zero crossings that have happened in the present state, of each kind the one that is furthest beyond
    /// zero: a saturated drive has passed its target velocity, a locked one exceeds its limit, a contact has changed.
    /// Returns one of them.
    fn find_crossings(&mut self, t: f64, system: &mut dyn CoupledSystem<f64>) -> Option<Crossing> {
        self.crossings.clear();
        let passed = (0..self.target_velocities.len()).filter(|i| self.has_passed_target(*i));
        let furthest = passed.max_by(|i, j| self.target_passage(*i).total_cmp(&self.target_passage(*j)));
        self.crossings.extend(furthest.map(Crossing::Target));
        let of_system = !self.coupled_crossings.is_empty();
        if self.mechanism.drives.contains(&0.0) || self.is_constrained() || of_system {
            self.evaluate_held(t, system);
            let of_contacts = self.mechanism.contact_events(&self.y[self.layout().velocities()]);
            self.crossings.extend(of_contacts.into_iter().flatten().map(Crossing::Contact));
            let overload = self.find_overload();
            self.crossings.extend(overload.map(Crossing::Overload));
            let coupled = self.coupled_crossings.iter().position(|value| *value > 0.0);
            self.crossings.extend(coupled.map(Crossing::Coupled));
        }
        self.crossings.first().copied()
    }

    /// Zero crossing among those last found that is not located yet: its value is more than as good as zero.
    fn unlocated_crossing(&mut self) -> Option<Crossing> {
        (0..self.crossings.len()).find_map(|k| {
            let crossing = self.crossings[k];
            let (value, resolution) = (self.crossing_value(crossing), self.crossing_resolution(crossing));
            // a missing value says nothing
            (value.is_nan() || value > resolution).then_some(crossing)
        })
    }

    /// f(t, y) with held modes into `self.slope`.
    pub(super) fn evaluate_held(&mut self, t: f64, system: &mut dyn CoupledSystem<f64>) {
        self.mechanism.mark_modes();
        self.evaluate_checked(t, system);
    }

    /// f(t, y) into `self.slope` with the modes held that are marked.
    pub(super) fn evaluate_checked(&mut self, t: f64, system: &mut dyn CoupledSystem<f64>) {
        self.mechanism.set_mode_rule(ModeRule::HeldAtInstant);
        self.evaluate_slope(t, system);
        self.mechanism.set_mode_rule(ModeRule::Decided);
        if !self.coupled_crossings.is_empty() {
            system.zero_crossings(t, &mut self.coupled_crossings);
        }
    }

    /// Lets the coupled system handle its events at the end of an accepted step, in the present state at time `t`
    /// `[s]`, until no event follows from another. Returns true if there was one.
    pub(super) fn handle_coupled_events(
        &mut self,
        t: f64,
        system: &mut dyn CoupledSystem<f64>,
    ) -> Result<bool, (f64, Stop)> {
        if system.zero_crossing_count().is_none() {
            return Ok(false);
        }
        let own = self.mechanism.dim();
        for n_events in 0..MAX_EVENT_ITERATIONS {
            self.evaluate_held(t, system);
            if !system.handle_events(t, &mut self.y[own..]) {
                return Ok(n_events > 0);
            }
        }
        Err((t, Stop::EndlessEvents { t }))
    }

    /// Value of a zero crossing in the present state, last evaluated: above zero where it has happened; NaN if it is
    /// not known.
    fn crossing_value(&mut self, crossing: Crossing) -> f64 {
        self.crossing_sample(crossing).value
    }

    /// Zero crossing in the present state, last evaluated, with its rate where that is known.
    fn crossing_sample(&mut self, crossing: Crossing) -> Sample {
        match crossing {
            Crossing::Contact(event) => {
                let velocities = self.layout().velocities();
                self.mechanism.contact_event_sample(event, &self.y[velocities])
            }
            Crossing::Target(i) => self.target_passage(i).into(),
            Crossing::Overload(i) => self.mechanism.drive_overload(i).into(),
            Crossing::Coupled(k) => self.coupled_crossings[k].into(),
        }
    }

    /// Time in which no state changes by more than a share of the accuracy, by the slope last evaluated `[s]`.
    fn time_resolution(&self, control: Option<Control>) -> f64 {
        let states = self.y.iter().zip(&self.slope);
        let fastest = states.map(|(y, slope)| slope.abs() / (1.0 + y.abs())).fold(f64::MIN_POSITIVE, f64::max);
        control.map_or(0.0, |control| EVENT_ACCURACY * control.accuracy) / fastest
    }

    /// Sum of the sizes of the powers of all saturated drives `[W]`.
    fn saturated_power(&self) -> f64 {
        let of_drive = |i: usize| {
            let drive = &self.mechanism.model.params.drives[i];
            self.mechanism.limit(drive).map_or(0.0, |limit| (limit * self.velocity(drive.dof)).abs())
        };
        let saturated = (0..self.target_velocities.len()).filter(|i| self.mechanism.drives[*i] != 0.0);
        saturated.map(of_drive).sum()
    }

    /// Value of a zero crossing that is as good as zero.
    fn crossing_resolution(&self, crossing: Crossing) -> f64 {
        match crossing {
            Crossing::Target(i) => VALUE_RESOLUTION * self.target_velocities[i].abs(),
            Crossing::Overload(_) | Crossing::Coupled(_) => 0.0,
            Crossing::Contact(event) => self.mechanism.contact_event_resolution(event),
        }
    }

    /// Time after `t` at which a zero crossing has happened `[s]`, with it; none if there is none: at the end of the
    /// sub-step of length `h`, or at the earliest stage of it at which a law was violated (`violated` after `t`).
    pub(super) fn find_event(
        &mut self,
        t: f64,
        h: f64,
        (reached, violated): (f64, f64),
        control: Option<Control>,
        system: &mut dyn CoupledSystem<f64>,
    ) -> Result<Option<(f64, Crossing)>, (f64, Stop)> {
        if let Some(crossing) = self.find_crossings(reached, system) {
            return Ok(Some((h, crossing)));
        }
        self.find_event_within(t, h, (reached, violated), control, system)
    }

    /// The same of what has happened within the sub-step, whether or not it shows at its end: the state last evaluated.
    fn find_event_within(
        &mut self,
        t: f64,
        h: f64,
        (reached, violated): (f64, f64),
        control: Option<Control>,
        system: &mut dyn CoupledSystem<f64>,
    ) -> Result<Option<(f64, Crossing)>, (f64, Stop)> {
        let violated = violated.min(self.find_passage(reached, h, system)).min(self.limit_passage(h));
        let mut looks = Looks { first: violated, interval: INTERIOR_STEP * h };
        let is_parting = self.is_constrained() && self.mechanism.find_parting(h);
        if is_parting {
            self.restore();
            self.mechanism.return_to_start();
            self.evaluate_held(t, system);
            looks = self.mechanism.surface_passages(h, looks);
        }
        // stage and cubic are estimates: what they told is looked at, and the rest of the step from there
        let has_looks = looks.first > 0.0 && looks.first < h;
        let mut at = if has_looks { looks.first } else { h };
        while at < h * (1.0 - 1e-6) {
            self.repeat_step(t, at, control, system)?;
            if let Some(crossing) = self.find_crossings(t + at, system) {
                return Ok(Some((at, crossing)));
            }
            at += looks.interval;
        }
        if has_looks || is_parting {
            self.repeat_step(t, h, control, system)?;
        }
        Ok(None)
    }

    /// Earliest time within the sub-step of length `h` at which an open limit seems to have been passed and left again
    /// `[s]`, after an evaluation at its end.
    fn limit_passage(&self, h: f64) -> f64 {
        let velocities = self.layout().velocities();
        let start = (&self.base_before[..], &self.before[velocities.clone()]);
        self.mechanism.limit_passage(h, start, &self.y[velocities])
    }

    /// Earliest time within the sub-step at which a saturated drive seems to be beyond its target velocity `[s]`.
    fn find_passage(&mut self, reached: f64, h: f64, system: &mut dyn CoupledSystem<f64>) -> f64 {
        if self.mechanism.drives.iter().all(|saturation| *saturation == 0.0) {
            return f64::INFINITY;
        }
        self.evaluate_held(reached, system);
        let layout = self.layout();
        self.mechanism.drive_monitor.passage(h, |i| {
            let dof = self.mechanism.model.params.drives[i].dof;
            let at = layout.velocity(dof);
            (self.mechanism.drives[i], self.y[at], self.slope[at])
        })
    }

    /// Locates the first instant in (t, t + bad] at which a drive or contact changes mode, goes there and changes it;
    /// `h` is the length of the sub-step, in which a law was violated first at the stage `violated` after `t`.
    pub(super) fn locate_event(
        &mut self,
        t: f64,
        (bad, crossing): (f64, Crossing),
        (h, violated): (f64, f64),
        control: Option<Control>,
        system: &mut dyn CoupledSystem<f64>,
    ) -> Result<f64, (f64, Stop)> {
        // of the step's own time: t itself may be too coarse
        let resolution = h * EVENT_RESOLUTION;
        let (at, crossing) = self.first_crossing(t, (bad, crossing), (h, violated), control, system)?;
        let has_closed = matches!(crossing, Crossing::Contact(ContactEvent::Closing(_) | ContactEvent::Meeting(_)));
        self.mode_changes += u32::from(!has_closed);
        // beyond the event the modes of the sub-step may fit no forces; those after it are found below
        let report = self.solver_report();
        self.evaluate_slope(t + at, system);
        report.into_iter().for_each(|before| self.discard_failures(&before));
        // saturated drives that have just passed their target velocity, or reach it at the same instant, are brought to
        // it and locked ones kept there, momentum and impulses consistent
        let mut reached = false;
        for i in 0..self.target_velocities.len() {
            self.jumps[i] = self.has_passed_target(i) || self.reaches_target(i, resolution);
            reached |= self.jumps[i];
            self.jumps[i] |= self.mechanism.drives[i] == 0.0;
        }
        // under the modes of the sub-step: a contact that slid until now need not slip on when a drive has locked
        let of_rates = self.project();
        let width = resolution.max(self.time_resolution(control));
        self.statistics.event_work += of_rates + width * self.saturated_power();
        if reached {
            self.apply_impulse();
        }
        if !self.mechanism.couples_drives() {
            self.resolve_actuator_modes(t + at, h, system);
        }
        Ok(t + at)
    }

    /// Time after `t` of the first zero crossing of [`World::locate_event`], and which one it is; the state is that of
    /// this instant. The sub-step up to there is looked at as a whole one is: what ends it says nothing of what is
    /// passed and left again before.
    fn first_crossing(
        &mut self,
        t: f64,
        (mut bad, mut crossing): (f64, Crossing),
        (h, violated): (f64, f64),
        control: Option<Control>,
        system: &mut dyn CoupledSystem<f64>,
    ) -> Result<(f64, Crossing), (f64, Stop)> {
        loop {
            self.mechanism.set_locating(true);
            let located = self.narrow(t, (bad, h), crossing, control, system);
            self.mechanism.set_locating(false);
            let (at, found) = located?;
            if at <= h * EVENT_RESOLUTION {
                return Ok((at, found));
            }
            let report = self.solver_report();
            let earlier = self.find_event_within(t, at, (t + at, violated), control, system)?;
            report.into_iter().for_each(|before| self.discard_failures(&before));
            let Some(earlier) = earlier else { return Ok((at, found)) };
            (bad, crossing) = earlier;
        }
    }

    /// Zero crossing at the start of the sub-step at `t`, to which the state goes back.
    fn sample_at_start(&mut self, t: f64, crossing: Crossing, system: &mut dyn CoupledSystem<f64>) -> Sample {
        self.restore();
        self.mechanism.return_to_start();
        self.evaluate_held(t, system);
        self.crossing_sample(crossing)
    }

    /// Returns true if the state last evaluated, with this sample of a zero crossing that is not exactly located, is as
    /// good as its instant: a contact that comes to its surface, where the last bit of its distance decides whether it
    /// is past it, or stays within what counts as closed; or a reversal whose value has come little nearer to zero than
    /// the `last` one: slow sliding depends on the length of the repeated sub-step, which limits how near it comes.
    fn is_close(&self, crossing: Crossing, (sample, last): (Sample, f64), has_happened: bool) -> bool {
        let resolution = self.crossing_resolution(crossing);
        match crossing {
            Crossing::Contact(ContactEvent::Closing(_) | ContactEvent::Meeting(_)) => {
                !has_happened && sample.value >= -resolution && sample.rate > 0.0
            }
            Crossing::Contact(ContactEvent::Reversal(..)) => {
                let size = sample.value.abs();
                size <= if size > STALLED * last { NOISE * resolution } else { resolution }
            }
            _ => false,
        }
    }

    /// Time after `t` of the first zero crossing, known to have happened at `bad` of the sub-step of length `h`, and
    /// which one it is; the state is that of this instant.
    fn narrow(
        &mut self,
        t: f64,
        (bad, h): (f64, f64),
        mut crossing: Crossing,
        control: Option<Control>,
        system: &mut dyn CoupledSystem<f64>,
    ) -> Result<(f64, Crossing), (f64, Stop)> {
        let after = self.crossing_sample(crossing);
        let before = self.sample_at_start(t, crossing, system);
        let mut bracket = Bracket::new((0.0, bad), (before, after));
        let of_states = self.time_resolution(control);
        let width = |crossing: Crossing| {
            let most = match crossing {
                Crossing::Contact(ContactEvent::Law(_)) | Crossing::Overload(_) => FORCE_RESOLUTION * h,
                Crossing::Coupled(_) => COUPLED_RESOLUTION * h,
                Crossing::Contact(_) | Crossing::Target(_) => f64::INFINITY,
            };
            of_states.min(most).max(EVENT_RESOLUTION * h)
        };
        let mut last = f64::INFINITY;
        while bracket.width() > width(crossing) {
            let at = bracket.next(width(crossing));
            self.repeat_step(t, at, control, system)?;
            let has_happened = self.find_crossings(t + at, system).is_some();
            let unlocated = if has_happened { self.unlocated_crossing() } else { None };
            if has_happened && unlocated.is_none() {
                return Ok((at, crossing));
            }
            // another one has happened before it
            let other = unlocated.filter(|_| !self.crossings.contains(&crossing));
            crossing = other.unwrap_or(crossing);
            let sample = self.crossing_sample(crossing);
            bracket.take(at, has_happened, sample);
            if other.is_some() {
                let is_start = bracket.before() == 0.0;
                let before = if is_start { self.sample_at_start(t, crossing, system) } else { f64::NAN.into() };
                bracket.change_crossing(before, sample);
                last = f64::INFINITY;
            } else if self.is_close(crossing, (sample, last), has_happened) {
                return Ok((at, crossing));
            } else {
                last = sample.value.abs();
            }
        }
        let at = bracket.after();
        self.repeat_step(t, at, control, system)?;
        // beyond the event the modes of the sub-step may fit no forces
        let report = self.solver_report();
        self.evaluate_held(t + at, system);
        report.into_iter().for_each(|before| self.discard_failures(&before));
        Ok((at, crossing))
    }
}
