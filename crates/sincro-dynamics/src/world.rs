//! One world that advances from tick to tick.
//!
//! [`World::advance`] is stage 4 of the step: commands are latched before it, and it takes the state from t to t + h, in as many
//! sub-steps as the method and the events need. Two kinds of event end a sub-step: a corner of an input signal, known beforehand,
//! and a drive that changes between holding and pulling, located by bisection.
//!
//! What has changed when it fails: the state is that of the last sub-step that could be made, everything finite.

use crate::drive::DriveKind;
use crate::energy::{Energy, energy, momentum};
use crate::integrate::{Control, DormandPrince, Extrapolated, Failure, FixedStep, Rk4, SemiImplicitEuler, System};
use crate::mechanism::Mechanism;
use crate::model::Model;
use crate::scratch::Scratch;
use crate::spatial::Force;
use crate::state::State;

/// Relative width below which two velocities count as equal.
const SAME_VELOCITY: f64 = 1e-12;
/// Changes of drives in one tick beyond which they are said to chatter.
const MAX_EVENTS: usize = 10_000;

/// How a world is integrated.
#[derive(Clone, Debug)]
pub enum Method {
    /// Semi-implicit Euler, fixed step, order 1.
    SemiImplicitEuler(SemiImplicitEuler<f64>),
    /// Runge–Kutta, fixed step, order 4.
    Rk4(Rk4<f64>),
    /// Extrapolated implicit Euler with two rows, fixed step, order 2.
    Implicit(Extrapolated<f64>),
    /// Dormand–Prince 5(4), error control.
    DormandPrince(DormandPrince),
    /// Extrapolated implicit Euler, error control.
    Stiff(Extrapolated<f64>),
}

/// The methods by name.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[allow(missing_docs)]
pub enum MethodKind {
    SemiImplicitEuler,
    Rk4,
    Implicit,
    DormandPrince,
    Stiff,
}

/// Why a world stopped.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Stop {
    /// The integrator could not go on.
    Integration(Failure),
    /// Drives changed state too often within one tick.
    Chatter {
        /// Where [s].
        t: f64,
    },
}

/// Counts of what was done since the world was made.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Effort {
    /// Sub-steps accepted.
    pub steps: u64,
    /// Changes of drives located.
    pub events: u64,
}

/// A mechanism, its state and a method.
#[derive(Clone, Debug)]
pub struct World {
    /// The state.
    pub state: State<f64>,
    mechanism: Mechanism<f64>,
    method: Method,
    y: Vec<f64>,
    before: Vec<f64>,
    base_before: Vec<f64>,
    wanted: Vec<f64>,
    jumps: Vec<bool>,
    accelerations: Vec<f64>,
    slope: Vec<f64>,
    substeps: u32,
    effort: Effort,
}

/// A world looked at: kinematics are computed, nothing can be changed.
#[derive(Clone, Copy, Debug)]
pub struct Observation<'a> {
    /// The state.
    pub state: &'a State<f64>,
    /// Accelerations [rad/s²] or [m/s²].
    pub accelerations: &'a [f64],
    mechanism: &'a Mechanism<f64>,
}

impl Observation<'_> {
    /// The model.
    #[must_use]
    pub fn model(&self) -> &Model<f64> {
        self.mechanism.model()
    }

    /// Smooth torque of each motor now [N·m] or [N].
    #[must_use]
    pub fn motor_torque(&self) -> &[f64] {
        self.mechanism.motor_torque()
    }

    /// Torque [N·m] of Coulomb friction on a degree of freedom.
    #[must_use]
    pub fn friction_torque(&self, dof: usize) -> f64 {
        let drives = self.model().drives();
        let friction = drives.iter().position(|d| d.dof == dof && d.kind == DriveKind::Friction);
        friction.map_or(0.0, |i| self.mechanism.friction_torque(i))
    }

    /// Poses, twists and accelerations of the links.
    #[must_use]
    pub fn scratch(&self) -> &Scratch<f64> {
        &self.mechanism.scratch
    }

    /// Kinetic and potential energy.
    #[must_use]
    pub fn energy(&self) -> Energy<f64> {
        energy(self.model(), &self.state.q, &self.state.v, self.scratch())
    }

    /// Momentum of all bodies about the world's origin.
    #[must_use]
    pub fn momentum(&self) -> Force<f64> {
        momentum(self.model(), self.scratch())
    }
}

impl World {
    /// A world of `model` in `state`.
    ///
    /// `accuracy` and `first_step` [s] matter to error-controlled methods only.
    #[must_use]
    pub fn new(model: Model<f64>, state: State<f64>, kind: MethodKind, accuracy: f64, first_step: f64) -> Self {
        Self::with_totals(model, state, kind, Control::new(accuracy, first_step), true)
    }

    /// As [`World::new`]; without totals no work, dissipation or motor impulse is integrated, which saves time.
    #[must_use]
    pub fn with_totals(
        model: Model<f64>,
        state: State<f64>,
        kind: MethodKind,
        control: Control,
        tracks_totals: bool,
    ) -> Self {
        let n_drives = model.n_drives();
        let mechanism = Mechanism::new(model, tracks_totals);
        let dim = mechanism.dim();
        let method = match kind {
            MethodKind::SemiImplicitEuler => Method::SemiImplicitEuler(SemiImplicitEuler::new(dim)),
            MethodKind::Rk4 => Method::Rk4(Rk4::new(dim)),
            MethodKind::Implicit => Method::Implicit(Extrapolated::new(dim, 2, control)),
            MethodKind::DormandPrince => Method::DormandPrince(DormandPrince::new(dim, control)),
            MethodKind::Stiff => Method::Stiff(Extrapolated::new(dim, 6, control)),
        };
        let base_before = vec![0.0; mechanism.model().n_q()];
        let accelerations = vec![0.0; mechanism.model().n_v()];
        Self {
            state,
            mechanism,
            method,
            y: vec![0.0; dim],
            before: vec![0.0; dim],
            slope: vec![0.0; dim],
            substeps: 1,
            base_before,
            wanted: vec![0.0; n_drives],
            jumps: vec![false; n_drives],
            accelerations,
            effort: Effort::default(),
        }
    }

    /// The model.
    #[must_use]
    pub fn model(&self) -> &Model<f64> {
        self.mechanism.model()
    }

    /// What was done so far.
    #[must_use]
    pub fn effort(&self) -> Effort {
        self.effort
    }

    /// The error control of the method, none for fixed steps. Part of what a snapshot holds.
    #[must_use]
    pub fn control(&self) -> Option<Control> {
        match &self.method {
            Method::DormandPrince(m) => Some(m.control),
            Method::Stiff(m) => Some(m.control),
            _ => None,
        }
    }

    /// Puts the error control back to what a snapshot holds.
    pub fn set_control(&mut self, control: Control) {
        match &mut self.method {
            Method::DormandPrince(m) => m.control = control,
            Method::Stiff(m) => m.control = control,
            _ => {}
        }
    }

    /// Divides every fixed step into `n` equal ones; commands are still latched once a tick. For estimating errors.
    pub fn set_substeps(&mut self, n: u32) {
        self.substeps = n.max(1);
    }

    /// Decides which drives hold at the start of a run, velocities as they are (nothing jumps before the first command).
    pub fn settle_start(&mut self, t: f64) {
        self.mechanism.load(&self.state, &mut self.y);
        self.latch();
        self.settle(t);
        self.mechanism.store(&self.y, &mut self.state);
    }

    /// Everything that can be looked at in the present state.
    pub fn observe(&mut self, t: f64) -> Observation<'_> {
        self.rates(t);
        self.mechanism.locate(&self.state, &self.accelerations);
        Observation { state: &self.state, accelerations: &self.accelerations, mechanism: &self.mechanism }
    }

    /// Bytes that this world takes beside the shared model's numbers.
    #[must_use]
    pub fn heap_bytes(&self) -> usize {
        let own = self.y.len() * 3 + self.base_before.len() + self.wanted.len() + self.accelerations.len();
        let method = match &self.method {
            Method::SemiImplicitEuler(_) => self.y.len(),
            Method::Rk4(_) => 5 * self.y.len(),
            Method::Implicit(_) | Method::Stiff(_) => 10 * self.y.len(),
            Method::DormandPrince(_) => 9 * self.y.len(),
        };
        self.state.heap_bytes() + self.mechanism.heap_bytes() + 8 * (own + method)
    }

    /// Advances the state from time `t` by `h` [s] under the latched commands; the tick is counted up.
    ///
    /// # Errors
    ///
    /// When the method cannot go on; the state is then that of the last instant reached.
    pub fn advance(&mut self, t: f64, h: f64) -> Result<(), (f64, Stop)> {
        self.mechanism.load(&self.state, &mut self.y);
        self.latch();
        let reached = if let Method::SemiImplicitEuler(_) = self.method {
            let h = h / f64::from(self.substeps);
            (0..self.substeps).try_for_each(|k| self.euler_step(t + f64::from(k) * h, h))
        } else {
            self.begin(t);
            self.sub_steps(t, h)
        };
        self.mechanism.store(&self.y, &mut self.state);
        reached?;
        self.state.tick += 1;
        Ok(())
    }

    /// Accelerations [rad/s²], [m/s²] and motor torques [N·m], [N] at the present state, as the drives now stand.
    pub fn rates(&mut self, t: f64) -> (&[f64], &[f64]) {
        let n = self.model().n_v();
        self.mechanism.load(&self.state, &mut self.y);
        self.mechanism.mark_held();
        self.mechanism.slope(t, &self.y, &mut self.slope);
        self.mechanism.find_motor_torques(&self.state.v, (0.0, 0.0));
        self.accelerations.copy_from_slice(&self.slope[n..2 * n]);
        (&self.accelerations, self.mechanism.motor_torque())
    }

    /// The mechanism, for kinematics and energies at the state.
    pub fn mechanism(&mut self) -> &mut Mechanism<f64> {
        &mut self.mechanism
    }

    /// Velocity that each drive wants during this tick.
    fn latch(&mut self) {
        for (i, drive) in self.mechanism.model.drives.iter().enumerate() {
            self.wanted[i] = drive.wanted(&self.mechanism.model, self.mechanism.base(), &self.mechanism.commands);
        }
    }

    fn velocity(&self, dof: usize) -> f64 {
        self.y[self.model().n_v() + dof]
    }

    fn is_unlimited(&self, drive: usize) -> bool {
        self.mechanism.model.drives[drive].limit(&self.mechanism.model).is_none()
    }

    /// The jump at the start of a tick and the state of the drives after it.
    fn begin(&mut self, t: f64) {
        if self.mechanism.drives.is_empty() {
            return;
        }
        self.jump();
        self.settle(t);
    }

    /// Unlimited motors take their commanded velocity at once.
    fn jump(&mut self) {
        for i in 0..self.wanted.len() {
            self.jumps[i] = self.is_unlimited(i);
        }
        self.strike();
        for i in 0..self.wanted.len() {
            if self.jumps[i] {
                self.mechanism.drives[i] = 0.0;
            }
        }
    }

    /// Brings the drives marked in `jumps` to their velocity by an impulse that leaves every other generalised momentum as it is;
    /// unlimited motors keep what they have.
    fn strike(&mut self) {
        let n = self.model().n_v();
        let mut needed = false;
        self.mechanism.held_mask.fill(0.0);
        self.mechanism.held_acceleration.fill(0.0);
        for i in 0..self.wanted.len() {
            if self.jumps[i] || self.is_unlimited(i) {
                let dof = self.mechanism.model.drives[i].dof;
                let change = self.wanted[i] - self.velocity(dof);
                self.mechanism.held_mask[dof] = 1.0;
                self.mechanism.held_acceleration[dof] = change;
                needed |= change != 0.0;
            }
        }
        if needed {
            self.mechanism.impulse(&mut self.accelerations);
            for k in 0..n {
                self.y[n + k] += self.accelerations[k];
            }
            self.count_impulses();
        }
        for i in 0..self.wanted.len() {
            if self.jumps[i] {
                self.y[n + self.mechanism.model.drives[i].dof] = self.wanted[i];
            }
        }
    }

    /// Adds the work and the impulses of a strike to the totals: ΔT = Σ λ·(mean of the velocities before and after).
    fn count_impulses(&mut self) {
        let n = self.model().n_v();
        if self.y.len() == 2 * n {
            return;
        }
        for (i, drive) in self.mechanism.model.drives.iter().enumerate() {
            if !self.jumps[i] && !self.is_unlimited(i) {
                continue;
            }
            let impulse = self.mechanism.scratch.reaction[drive.dof];
            let work = impulse * (self.wanted[i] - 0.5 * self.mechanism.held_acceleration[drive.dof]);
            match drive.kind {
                DriveKind::Friction => self.y[2 * n + 1] -= work,
                DriveKind::Motor(motor) => {
                    self.y[2 * n] += work;
                    self.y[2 * n + 2 + motor] += impulse;
                }
            }
        }
    }

    /// Decides for each limited drive whether it holds: those at their velocity hold if their limit allows it.
    fn settle(&mut self, t: f64) {
        for i in 0..self.wanted.len() {
            if !self.is_unlimited(i) {
                let missing = self.missing_velocity(i);
                self.mechanism.drives[i] = if missing == 0.0 { 0.0 } else { missing.signum() };
            }
        }
        self.mechanism.mark_held();
        if !self.has_limited_drives() {
            return;
        }
        for _ in 0..=self.wanted.len() {
            self.mechanism.mark_held();
            self.mechanism.slope(t, &self.y, &mut self.slope);
            if !self.release_overloaded() {
                return;
            }
        }
    }

    /// Wanted minus present velocity of a drive, zero within rounding.
    fn missing_velocity(&self, i: usize) -> f64 {
        let v = self.velocity(self.mechanism.model.drives[i].dof);
        let missing = self.wanted[i] - v;
        if missing.abs() <= SAME_VELOCITY * self.wanted[i].abs().max(v.abs()).max(1e-3) { 0.0 } else { missing }
    }

    /// Lets go of the holding drives whose reaction in the last evaluation exceeds their limit; says whether any did.
    fn release_overloaded(&mut self) -> bool {
        let mut released = false;
        for i in 0..self.wanted.len() {
            if let Some(reaction) = self.overload(i) {
                self.mechanism.drives[i] = reaction.signum();
                released = true;
            }
        }
        released
    }

    /// The reaction on a holding drive, if the drives that hold its joint cannot give it together.
    fn overload(&self, i: usize) -> Option<f64> {
        if self.mechanism.drives[i] != 0.0 {
            return None;
        }
        let dof = self.mechanism.model.drives[i].dof;
        let mut limit = 0.0;
        for (drive, pull) in self.mechanism.model.drives.iter().zip(&self.mechanism.drives) {
            if drive.dof == dof && *pull == 0.0 {
                limit += drive.limit(&self.mechanism.model)?;
            }
        }
        let reaction = self.mechanism.scratch.reaction[dof];
        (reaction.abs() > limit * (1.0 + 1e-12)).then_some(reaction)
    }

    /// Sub-steps over `span` from `start`, ending at corners of signals and at events of drives.
    fn sub_steps(&mut self, start: f64, span: f64) -> Result<(), (f64, Stop)> {
        let (mut t, end, mut events) = (start, start + span, 0);
        while t < end {
            let corner = self.model().next_corner(t).min(end);
            // the undivided step is exactly the tick, not (t + h) − t: lanes take it so
            let h_max = if t == start && corner == end { span } else { corner - t };
            let h_max = if self.substeps > 1 { h_max.min(self.substep(span)) } else { h_max };
            let limited = self.has_limited_drives();
            let control = if limited { self.control() } else { None };
            if limited {
                self.keep();
            }
            let h = self.method_step(t, h_max).map_err(|failure| (t, Stop::Integration(failure)))?;
            if !self.y.iter().all(|x| x.is_finite()) {
                self.mechanism.load(&self.state, &mut self.y);
                return Err((start, Stop::Integration(Failure::NotFinite { t })));
            }
            self.effort.steps += 1;
            let reached = if h >= h_max && (self.substeps == 1 || t + h >= corner) { corner } else { t + h };
            if limited && self.is_violated(reached) {
                t = self.locate(t, h, control)?;
                events += 1;
                self.effort.events += 1;
                if events > MAX_EVENTS {
                    return Err((t, Stop::Chatter { t }));
                }
            } else {
                t = reached;
            }
        }
        Ok(())
    }

    /// Longest step of a fixed-step method within a tick of `span`.
    fn substep(&self, span: f64) -> f64 {
        // a hair longer, so that rounding leaves no sliver behind
        if self.control().is_some() { span } else { span / f64::from(self.substeps) * (1.0 + 1e-12) }
    }

    /// One step of the method from `t`, at most `h_max`; y is charted anew. Returns the length made.
    fn method_step(&mut self, t: f64, h_max: f64) -> Result<f64, Failure> {
        let (mechanism, y) = (&mut self.mechanism, &mut self.y);
        match &mut self.method {
            Method::SemiImplicitEuler(m) => m.step(mechanism, t, h_max, y),
            Method::Rk4(m) => m.step(mechanism, t, h_max, y),
            Method::Implicit(m) => m.step(mechanism, t, h_max, y),
            Method::DormandPrince(m) => return m.step(mechanism, t, h_max, y),
            Method::Stiff(m) => return m.adaptive_step(mechanism, t, h_max, y),
        }
        Ok(h_max)
    }

    fn keep(&mut self) {
        self.before.copy_from_slice(&self.y);
        self.base_before.copy_from_slice(self.mechanism.base());
    }

    fn restore(&mut self) {
        self.y.copy_from_slice(&self.before);
        self.mechanism.set_base(&self.base_before);
    }

    fn has_limited_drives(&self) -> bool {
        (0..self.wanted.len()).any(|i| !self.is_unlimited(i))
    }

    /// Whether a limited drive is past the point where it should have changed: it pulled beyond its velocity, or holds more than
    /// its limit.
    fn is_violated(&mut self, t: f64) -> bool {
        let crossed = (0..self.wanted.len()).any(|i| {
            let pull = self.mechanism.drives[i];
            !self.is_unlimited(i) && pull != 0.0 && self.missing_velocity(i) * pull < 0.0
        });
        if crossed {
            return true;
        }
        if self.mechanism.drives.iter().all(|pull| *pull != 0.0) {
            return false;
        }
        self.mechanism.slope(t, &self.y, &mut self.slope);
        (0..self.wanted.len()).any(|i| self.overload(i).is_some())
    }

    /// Finds the first instant in (t, t + h] at which a drive must change, goes there and changes it.
    fn locate(&mut self, t: f64, h: f64, control: Option<Control>) -> Result<f64, (f64, Stop)> {
        let (mut good, mut bad) = (0.0, h);
        let resolution = (h * 1e-13).max(4.0 * f64::EPSILON * t.abs());
        while bad - good > resolution {
            let middle = 0.5 * (good + bad);
            self.replay(t, middle, control)?;
            if self.is_violated(t + middle) { bad = middle } else { good = middle }
        }
        self.replay(t, bad, control)?;
        // a pulling drive that has just passed its velocity is brought back to it, momentum and impulses kept right
        for i in 0..self.wanted.len() {
            let pull = self.mechanism.drives[i];
            self.jumps[i] = !self.is_unlimited(i) && pull != 0.0 && self.missing_velocity(i) * pull < 0.0;
        }
        if self.jumps.contains(&true) {
            self.strike();
        }
        self.settle(t + bad);
        Ok(t + bad)
    }

    /// From the kept sub-step start, exactly `h` further.
    fn replay(&mut self, t: f64, h: f64, control: Option<Control>) -> Result<(), (f64, Stop)> {
        self.restore();
        if let Some(control) = control {
            self.set_control(control);
        }
        let mut done = 0.0;
        while done < h {
            let step = self.method_step(t + done, h - done).map_err(|f| (t + done, Stop::Integration(f)))?;
            done = if step >= h - done { h } else { done + step };
        }
        Ok(())
    }

    /// Semi-implicit Euler with drives as engines have them: over the whole step a drive either reaches its velocity exactly or
    /// pulls with its limit. Which, is found by trying.
    fn euler_step(&mut self, t: f64, h: f64) -> Result<(), (f64, Stop)> {
        self.effort.steps += 1;
        self.keep();
        for _ in 0..2 * self.wanted.len() + 4 {
            self.mark_targets(h);
            self.restore();
            self.method_step(t, h).map_err(|f| (t, Stop::Integration(f)))?;
            if self.wanted.is_empty() || !self.correct_drives() {
                break;
            }
        }
        if !self.y.iter().all(|x| x.is_finite()) {
            self.restore();
            return Err((t, Stop::Integration(Failure::NotFinite { t })));
        }
        let n = self.model().n_v();
        for i in 0..self.wanted.len() {
            if self.mechanism.drives[i] == 0.0 {
                self.y[n + self.mechanism.model.drives[i].dof] = self.wanted[i];
            }
        }
        Ok(())
    }

    /// Holding drives reach their velocity within `h`.
    fn mark_targets(&mut self, h: f64) {
        self.mechanism.mark_held();
        let n = self.model().n_v();
        for i in 0..self.wanted.len() {
            if self.mechanism.drives[i] == 0.0 {
                let dof = self.mechanism.model.drives[i].dof;
                self.mechanism.held_acceleration[dof] = (self.wanted[i] - self.before[n + dof]) / h;
            }
        }
    }

    /// After a trial step: overloaded drives let go, drives that passed their velocity hold; says whether any changed.
    fn correct_drives(&mut self) -> bool {
        if self.release_overloaded() {
            return true;
        }
        let mut changed = false;
        for i in 0..self.wanted.len() {
            let pull = self.mechanism.drives[i];
            if pull != 0.0 && self.missing_velocity(i) * pull <= 0.0 {
                self.mechanism.drives[i] = 0.0;
                changed = true;
            }
        }
        changed
    }
}
