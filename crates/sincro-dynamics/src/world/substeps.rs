//! Sub-steps of a tick: as many as the method and the events need, and what ends storms of events.

use sincro_complementarity::ZenoFallback;

use super::contacts::{MAX_CONTACT_EVENTS, MAX_EVENTS_AGAIN};
use super::{Method, SAME_INSTANT, Stop, World};
use crate::constraint::{ModeRule, SolverReport};
use crate::coupled::{Coupled, CoupledSystem};
use crate::integrate::{Control, Failure, FixedStep, System};

/// Maximum number of changes of drives in one tick; more are called chatter.
const MAX_EVENTS: usize = 10_000;

/// Maximum number of events in a row without progress in time.
const MAX_IDLE_EVENTS: usize = 20;

/// Number of those after which modes that violate a law now are not taken, however little: the law which they graze is
/// the event that ends the next sub-step at once, while the modes of the present instant may hold for a while.
const MAX_GRAZING_EVENTS: usize = 2;

/// Number of close events after which they are not taken.
const MAX_CLOSE_GRAZING_EVENTS: usize = 20;

/// Time between events, relative to the tick, that counts as none.
const IDLE: f64 = 1e-12;

/// Maximum number of events in a row that are close to each other: redundant contacts at the verge of slipping can have
/// forces that jump between solutions.
const MAX_CLOSE_EVENTS: usize = 150;

/// Time between close events, relative to the tick.
const CLOSE: f64 = 1e-5;

/// Maximum number of sub-steps in a row that make next to no progress: sliding friction that turns with a velocity near
/// zero can hold error control back without end.
const MAX_CRAWLING_STEPS: usize = 200;

/// Length of a sub-step, relative to the tick, that makes next to no progress.
const CRAWLING: f64 = 1e-9;

/// Maximum number of close sub-steps of one tick with contacts or limits, an event counting as ten, and after one that
/// had more: what keeps it from its end is then some noise, as of points of contact that are found to 1e-8 m.
const MAX_STEPS: [usize; 2] = [12_000, 4_000];

/// Maximum number of steps in which a sub-step, made in one, is repeated.
const MAX_REPEATED_STEPS: usize = 1000;

/// Length of the first step at velocity level after too many of them, relative to the tick.
const IDLE_STEP: f64 = 1e-3;

/// Length of the first step at velocity level where bodies jam, relative to the tick: finite forces make no difference
/// over it.
const JAM_STEP: f64 = 1e-9;

/// Growth from one of them to the next.
const JAM_GROWTH: f64 = 8.0;

/// Time after which bodies jam anew, relative to the tick.
const JAM_PAUSE: f64 = 1e-3;

/// Maximum number of constraint problems without convergence in a run.
const MAX_UNSOLVED: u64 = 100_000;

/// Lengths of the next steps at velocity level in a tick, relative to it.
#[derive(Clone, Copy)]
struct VelocityLevelSteps {
    /// After events without progress.
    idle: f64,
    /// After a jam.
    jam: f64,
    /// Time at the end of the last jam `[s]`.
    jam_end: f64,
}

impl World {
    /// Makes sub-steps over `span` from `start`, ending at time events and at events of drives and contacts.
    pub(super) fn sub_steps<A: CoupledSystem<f64>>(
        &mut self,
        start: f64,
        span: f64,
        system: &mut A,
    ) -> Result<(), (f64, Stop)> {
        let has_events = system.zero_crossing_count().is_some();
        if !(has_events || self.switches()) {
            return self.smooth_sub_steps(start, span, system);
        }
        let (mut t, end, mut events, mut idle, mut close) = (start, start + span, 0, 0, 0);
        let (mut after_event, mut crawling, mut short) = (false, 0, 0);
        let mut steps = VelocityLevelSteps { idle: IDLE_STEP, jam: JAM_STEP, jam_end: start };
        let zeno_fallback = self.zeno_fallback();
        if zeno_fallback.left > 0 {
            self.set_zeno_fallback(ZenoFallback { left: zeno_fallback.left - 1, ..zeno_fallback });
            return self.finish_at_velocity_level(start, span, system);
        }
        let is_first = zeno_fallback == ZenoFallback::default();
        let most_events = if is_first { MAX_CONTACT_EVENTS } else { MAX_EVENTS_AGAIN };
        while t < end {
            let corner = self.next_corner(t, end, system);
            if self.is_constrained() && end - t < 1e-13 * span {
                break;
            }
            let h_max = self.longest_sub_step((t, corner), (start, end, span));
            if self.is_constrained() {
                self.resolve_impacts();
                self.may_graze = idle <= MAX_GRAZING_EVENTS && close <= MAX_CLOSE_GRAZING_EVENTS;
                if !self.resolve_modes(t, (h_max, after_event), system) {
                    // no finite forces keep the laws here (Painlevé): impulses do
                    t = self.end_jam(t, (&mut steps, span), end, system)?;
                    after_event = false;
                    continue;
                }
                if let Some(report) = self.solver_report().filter(|r| r.not_converged > MAX_UNSOLVED) {
                    return Err((t, Stop::Unsolved { t, residual: report.worst_residual }));
                }
            }
            let limited = self.has_limited_drives() || self.is_constrained() || has_events;
            let control = if limited { self.control() } else { None };
            if limited {
                self.save_step_start();
                let band = self.mechanism.velocity_band();
                self.mechanism.drive_monitor.begin(&self.target_velocities, band);
            }
            let (reached, is_event) = match self.sub_step(t, (h_max, corner), (limited, control), system) {
                Err((_, Stop::Integration(_))) if limited && self.before.iter().all(|x| x.is_finite()) => {
                    // laws without a continuous solution here: no step is small enough
                    self.restore();
                    control.into_iter().for_each(|control| self.set_control(control));
                    t = self.end_jam(t, (&mut steps, span), end, system)?;
                    after_event = false;
                    continue;
                }
                Err((t, Stop::Integration(Failure::NotFinite { .. }))) if !self.y.iter().all(|x| x.is_finite()) => {
                    return Err(self.not_finite(start, t));
                }
                made => made?,
            };
            let is_event = self.handle_coupled_events(reached, system)? || is_event;
            self.mechanism.set_time_since_event(if is_event && after_event { reached - t } else { f64::INFINITY });
            after_event = is_event;
            if is_event {
                idle = if reached - t > IDLE * span { 0 } else { idle + 1 };
                close = if reached - t > CLOSE * span { 0 } else { close + 1 };
                events += 1;
                self.statistics.events += 1;
                if events > MAX_EVENTS {
                    return Err((reached, Stop::Chatter { t: reached }));
                }
            } else {
                (idle, close) = (0, 0);
            }
            short += usize::from(reached - t < CLOSE * span) * if is_event { 10 } else { 1 };
            let is_endless = events > most_events || short > MAX_STEPS[usize::from(!is_first)];
            if is_endless && reached < end && self.is_constrained() {
                self.set_zeno_fallback(zeno_fallback.lost());
                return self.finish_at_velocity_level(reached, end - reached, system);
            }
            crawling = if self.is_constrained() && reached - t < CRAWLING * span { crawling + 1 } else { 0 };
            t = reached;
            if idle > MAX_IDLE_EVENTS || close > MAX_CLOSE_EVENTS || crawling > MAX_CRAWLING_STEPS {
                // whatever alternates here is decided over a short step as a whole
                t = self.end_storm(t, (&mut steps, span), end, system)?;
                (idle, close, crawling, after_event) = (0, 0, 0, false);
            }
        }
        self.set_zeno_fallback(ZenoFallback::default());
        Ok(())
    }

    /// Makes sub-steps over `span` from `start` where nothing switches: they end at time events alone. The same steps
    /// as [`World::sub_steps`] makes, without what looks for events.
    fn smooth_sub_steps<A: CoupledSystem<f64>>(
        &mut self,
        start: f64,
        span: f64,
        system: &mut A,
    ) -> Result<(), (f64, Stop)> {
        let (mut t, end) = (start, start + span);
        while t < end {
            let corner = self.next_corner(t, end, system);
            let h_max = self.longest_sub_step((t, corner), (start, end, span));
            let made = self.method_step(t, h_max, ModeRule::HeldAndChecked, system);
            if !self.y.iter().all(|x| x.is_finite()) && matches!(made, Ok(_) | Err(Failure::NotFinite { .. })) {
                return Err(self.not_finite(start, t));
            }
            let h = made.map_err(|failure| (t, Stop::Integration(failure)))?;
            self.statistics.steps += 1;
            t = self.end_of_step(t, h, (h_max, corner));
        }
        Ok(())
    }

    /// Next time event after `t`, at most `end`; the coupled system is told if it is its own.
    fn next_corner<A: CoupledSystem<f64>>(&self, t: f64, end: f64, system: &mut A) -> f64 {
        let reach_target_velocities = system.next_time_event(t);
        let corner = self.model().next_time_event(t).min(reach_target_velocities).min(end);
        let is_own = reach_target_velocities <= corner + SAME_INSTANT;
        system.set_time_event(if is_own { corner } else { f64::INFINITY });
        corner
    }

    /// Longest sub-step from `t` up to the time event `corner`, of a tick from `start` to `end`.
    fn longest_sub_step(&self, (t, corner): (f64, f64), (start, end, span): (f64, f64, f64)) -> f64 {
        // the undivided step is exactly the tick, not (t + h) − t: lanes take it so
        let h_max = if t == start && corner == end { span } else { corner - t };
        if self.substeps > 1 { h_max.min(self.substep(span)) } else { h_max }
    }

    /// Time at the end of a step of length `h` from `t`, exactly that of the time event `corner` that it reaches.
    fn end_of_step(&self, t: f64, h: f64, (h_max, corner): (f64, f64)) -> f64 {
        if h >= h_max && (self.substeps == 1 || t + h >= corner) { corner } else { t + h }
    }

    /// Goes back to the start of the tick, at `start`, after numbers at `t` that are not finite.
    #[cold]
    fn not_finite(&mut self, start: f64, t: f64) -> (f64, Stop) {
        // the coupled system has last seen a trial state: its own is the saved one
        let own = self.mechanism.dim();
        self.mechanism.load(&self.state, &mut self.y);
        self.y[own..].copy_from_slice(&self.attached_before);
        (start, Stop::Integration(Failure::NotFinite { t }))
    }

    /// Makes one sub-step from `t`, at most `h_max` and up to the time event `corner`; with `limited` drives or
    /// contacts its events are located, from the error control at its start. Returns the time reached, and true if it
    /// ends at an event.
    pub(super) fn sub_step<A: CoupledSystem<f64>>(
        &mut self,
        t: f64,
        (h_max, corner): (f64, f64),
        (limited, control): (bool, Option<Control>),
        system: &mut A,
    ) -> Result<(f64, bool), (f64, Stop)> {
        let h = self
            .method_step(t, h_max, ModeRule::HeldAndChecked, system)
            .map_err(|failure| (t, Stop::Integration(failure)));
        let violated = self.mechanism.drive_monitor.end() - t;
        let h = h?;
        if !self.y.iter().all(|x| x.is_finite()) {
            return Err((t, Stop::Integration(Failure::NotFinite { t })));
        }
        self.statistics.steps += 1;
        let reached = self.end_of_step(t, h, (h_max, corner));
        let event = if limited { self.find_event(t, h, (reached, violated), control, system)? } else { None };
        if let Some(event) = event {
            return Ok((self.locate_event(t, event, (h, violated), control, system)?, true));
        }
        self.project();
        Ok((reached, false))
    }

    /// Lets impulses act at `t`, where no finite forces keep the laws: over a billionth of the tick of length `span`,
    /// and longer from one to the next. Where no friction hangs on a load it is not that: a longer step goes on, and
    /// the audit names it.
    fn end_jam(
        &mut self,
        t: f64,
        (steps, span): (&mut VelocityLevelSteps, f64),
        end: f64,
        system: &mut dyn CoupledSystem<f64>,
    ) -> Result<f64, (f64, Stop)> {
        if !self.has_friction_by_load() {
            return self.end_storm(t, (steps, span), end, system);
        }
        self.jams.note(t);
        if t - steps.jam_end > JAM_PAUSE * span {
            steps.jam = JAM_STEP;
        }
        steps.jam_end = self.fallback_step(t, (steps.jam * span, end), system)?;
        steps.jam *= JAM_GROWTH;
        Ok(steps.jam_end)
    }

    /// Makes a step at velocity level from `t`, twice as long from one to the next, after events or steps without
    /// progress.
    fn end_storm(
        &mut self,
        t: f64,
        (steps, span): (&mut VelocityLevelSteps, f64),
        end: f64,
        system: &mut dyn CoupledSystem<f64>,
    ) -> Result<f64, (f64, Stop)> {
        self.statistics.fallback_steps += 1;
        let h = steps.idle * span;
        steps.idle *= 2.0;
        self.fallback_step(t, (h, end), system)
    }

    /// Makes a step at velocity level from `t`, of length `h` up to the `end` of the tick.
    fn fallback_step(
        &mut self,
        t: f64,
        (h, end): (f64, f64),
        system: &mut dyn CoupledSystem<f64>,
    ) -> Result<f64, (f64, Stop)> {
        let h = h.min(end - t);
        self.statistics.fallback_square += h * h;
        self.mechanism.set_time_since_event(f64::INFINITY);
        self.velocity_level_step(t, h, &mut &mut *system)?;
        let reached = if h < end - t { t + h } else { end };
        if !self.is_constrained() {
            // with constraints that is the start of the next sub-step; the accelerations of this one end here
            self.resolve_actuator_modes(reached, end - reached, system);
        }
        Ok(reached)
    }

    /// Longest step within a tick of `span`, for methods with error control too: a finer run must not end up the same.
    pub(super) fn substep(&self, span: f64) -> f64 {
        // a hair longer, so that rounding leaves no sliver behind
        span / f64::from(self.substeps) * (1.0 + 1e-12)
    }

    /// One step of the method from `t`, at most `h_max`, with contact modes by `rule`; y is charted anew. Returns the
    /// length made.
    pub(super) fn method_step<A: CoupledSystem<f64>>(
        &mut self,
        t: f64,
        h_max: f64,
        rule: ModeRule,
        system: &mut A,
    ) -> Result<f64, Failure> {
        let acts = system.acts();
        if self.compiled_step(h_max, acts) {
            return Ok(h_max);
        }
        self.exchange_slope(acts);
        let h = self.control().map_or(h_max, |c| c.h.min(h_max));
        if let Some(constraints) = &mut self.mechanism.constraints {
            constraints.sub_step = h;
        }
        self.mechanism.set_mode_rule(rule);
        self.mechanism.begin_fixed_step();
        let system = &mut Coupled {
            mechanism: &mut self.mechanism,
            system,
            negated_jacobian_diagonal: &mut self.negated_jacobian_diagonal,
        };
        let y = &mut self.y;
        let made = match &mut self.method {
            Method::SemiImplicitEuler => unreachable!("its steps are those at velocity level"),
            Method::Rk4(m) => {
                m.step(system, t, h_max, y);
                Ok(h_max)
            }
            Method::Implicit(m) => {
                m.step(system, t, h_max, y);
                Ok(h_max)
            }
            Method::Adaptive(m) => m.step(system, t, h_max, y),
        };
        self.mechanism.set_mode_rule(ModeRule::Decided);
        self.exchange_slope(acts);
        made
    }

    pub(super) fn save_step_start(&mut self) {
        self.before.copy_from_slice(&self.y);
        self.base_before.copy_from_slice(self.mechanism.base());
        if let Some(report) = self.solver_report() {
            self.report_before = report;
        }
    }

    pub(super) fn restore(&mut self) {
        self.y.copy_from_slice(&self.before);
        self.mechanism.set_base(&self.base_before);
        let before = self.report_before;
        self.discard_failures(&before);
    }

    /// Takes back the failures of the constraint solver since `before`, of evaluations that nothing came of.
    pub(super) fn discard_failures(&mut self, before: &SolverReport) {
        if let Some(constraints) = &mut self.mechanism.constraints {
            constraints.solver.report.discard(before);
        }
    }

    /// Repeats the integration from the saved start of the sub-step, exactly `h` further. A finer run takes it in
    /// parts: events bound its steps at the same instants, and it must not end up the same.
    pub(super) fn repeat_step(
        &mut self,
        t: f64,
        h: f64,
        control: Option<Control>,
        system: &mut dyn CoupledSystem<f64>,
    ) -> Result<(), (f64, Stop)> {
        self.restore();
        self.mechanism.return_to_start();
        if let Some(control) = control {
            self.set_control(control);
        }
        let part = if self.substeps > 1 { self.substep(h) } else { h };
        let (mut done, mut steps) = (0.0, 0);
        while done < h {
            let at = t + done;
            let step = self
                .method_step(at, part.min(h - done), ModeRule::Held, &mut &mut *system)
                .map_err(|failure| (at, Stop::Integration(failure)))?;
            steps += 1;
            if steps > MAX_REPEATED_STEPS {
                return Err((at, Stop::Integration(Failure::StepTooSmall { t: at, h: step })));
            }
            done = if step >= h - done { h } else { done + step };
        }
        Ok(())
    }
}
