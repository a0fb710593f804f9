//! Constraint solver in generalized coordinates: loop joints, gears, joint limits and contacts with friction.
//!
//! The Lagrange multipliers λ of all constraints solve one mixed complementarity problem. With w = J v̇ + J̇ v at the
//! acceleration level (or J v⁺/h at the velocity level):
//!
//! M v̇ = τ + Jᵀλ; w = 0 for bilateral rows; 0 ≤ λₙ ⊥ wₙ ≥ 0 for unilateral rows; |λ_t| ≤ μ λₙ opposing w_t for
//! friction.
//!
//! Eliminating v̇ leaves w = G λ + b with the Delassus matrix G = J M⁻¹ Jᵀ, built from the factors that the
//! articulated-body recursion leaves (`delassus`); prescribed degrees of freedom (velocity motors, sticking joint
//! friction) and the implicit terms of an integrator are thereby included. The problem is solved by an active-set
//! method with a warm start; where that does not converge, by ADMM ([`sincro_complementarity`]). Rigid constraints are
//! not regularised: there is no stiffness, penalty or stabilisation gain. After each accepted sub-step the world
//! projects positions and velocities onto the constraints in the metric of the mass matrix.
//!
//! | file | content |
//! |---|---|
//! | `assembly` | rows, residuals and unilateral constraints of what is closed, vector b |
//! | `row` | constraint rows in world coordinates, their rates and Jacobians |
//! | `loop_joint` | rows and residuals of loop joints |
//! | `rank` | independent rows of loop joints and gears |
//! | `delassus` | Delassus matrix G; products with M⁻¹ |
//! | `foresight` | what counts as closed because of a blow within a step |
//! | `kink` | limited drives at the kink of their law, as constraints of the contact problem |
//! | `implicit_forces` | forces along lines between two points at the new state of a linearly implicit step |
//! | `time_stepping` | problem of a whole step at velocity level with many contacts |
//! | `impact` | impacts, contact points |
//! | `projection` | projection of positions and velocities |
//! | `active_rows` | equations that hold at a state, for analysis |
//!
//! What the world asks of a constrained mechanism (detect contacts, apply an impact, project) is in `crate::mechanism`.
//!
//! Sources: keys `featherstone2008` (chapter 8, loops; chapter 11, contact), `acary2008` (chapters 3 and 13).

mod active_rows;
mod assembly;
mod delassus;
pub(crate) mod foresight;
mod impact;
pub(crate) mod implicit_forces;
pub(crate) mod kink;
mod loop_joint;
mod projection;
pub(crate) mod rank;
pub(crate) mod row;
mod time_stepping;

use sincro_actuation::Kink;
pub(crate) use sincro_complementarity::HeldLaw;
use sincro_complementarity::sweeps::GivenForces;
use sincro_complementarity::sweeps::rest::Rest;
use sincro_complementarity::{
    ContactMode, ContactProblem, HELD_RATE, Load, SlowSliding, Solution, Solver, UnilateralConstraint, WarmStart,
    is_observable,
};
use sincro_math::{Real, dot};

pub use crate::model::{Anchor, ConstraintSet, GearConstraint, Limit, LoopJoint, LoopJointKind, SLOT_LEN};
pub use active_rows::{ActiveRow, ActiveSource};
pub use sincro_complementarity::SolverReport;

use crate::contact::candidate::{ContactCandidate, ContactKinematics};
use crate::contact::{Detector, Pair, candidate_list::CandidateList, pair_of_slot};
use crate::model::Model;
use crate::recursions::kinematics;
use crate::scratch::Scratch;
use crate::spatial::{Force, Vec3};
use foresight::Foresight;
use implicit_forces::ImplicitForces;
use kink::drive_groups;
use row::{Motions, Row};
pub(crate) use time_stepping::DIRECT_ROWS;
use time_stepping::TimeStepping;

/// Signed distance below which a constraint counts as closed `[m]` or `[rad]`; projection leaves a thousandth of it.
pub(crate) const CLOSED_DISTANCE: f64 = 1e-9;

/// Speed below which a contact neither slides nor approaches [m/s] or [rad/s], of methods without error control.
const ZERO_SPEED: f64 = 1e-8;

/// Bounds of that speed with error control; within them it is ten times the accuracy, so that the finer run of an error
/// bar shows what it does.
pub(crate) const LEAST_ZERO_SPEED: f64 = 1e-10;
pub(crate) const MAX_ZERO_SPEED: f64 = 1e-6;

/// Speed below which contacts that meet come to rest [m/s] or [rad/s], with the speed that counts as none where that is
/// larger; at most ten times that speed.
pub(crate) const SETTLING_SPEED: f64 = 1e-7;

/// Distance to which the closing of contacts is located, of a mechanism of 1 m or more `[m]`, `[rad]`.
pub(crate) const LOCATED_DISTANCE: f64 = 1e-5 * CLOSED_DISTANCE;

/// Conditioning of the loops below which a position is singular: no stage of a step may stand there.
pub(crate) const SINGULAR: f64 = 1e-8;

/// Number of contact rows for which memory is reserved beforehand.
const RESERVED: usize = 48;

/// Level at which the constraints are solved.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Level {
    /// Accelerations; contact modes are those classified at the start of the sub-step.
    Acceleration,
    /// Velocities at the end of a step of length h `[s]`, impacts included.
    Velocity(f64),
}

/// Treatment of contact modes in an evaluation.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum ModeRule {
    /// The complementarity problem decides them.
    Decided,
    /// Those of the start of the sub-step stand: stages of a sub-step that is repeated.
    Held,
    /// As `Held`; laws that they violate are noted: stages of a sub-step that is new.
    HeldAndChecked,
    /// As `HeldAndChecked`, and the forces are those of the instant: redundant constraints share the load, which a
    /// stage whose motion does not hang on it leaves about as it was.
    HeldAtInstant,
}

/// Two points of surfaces that part at the end of a sub-step, so close that they may have turned within it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Parting {
    pub candidate: ContactCandidate,
    /// Distance `[m]` and rate [m/s] at the end.
    pub end: (f64, f64),
}

/// Contact point with its force, from [`Observation::contacts`](crate::world::Observation::contacts).
#[derive(Clone, Copy, Debug)]
pub struct ContactPoint {
    /// Index of the pair in [`ConstraintSet::pairs`].
    pub pair: usize,
    /// Indices of the two colliders in [`ConstraintSet::colliders`]; the force is on the first.
    pub surfaces: [usize; 2],
    /// Position in world axes `[m]`.
    pub point: Vec3<f64>,
    /// Unit normal from the second surface to the first, in world axes.
    pub normal: Vec3<f64>,
    /// Force on the body of the first surface, in world axes `[N]`; minus this on the second.
    pub force: Vec3<f64>,
    /// Torque of rolling and spinning friction on the same body, in world axes `[N·m]`.
    pub torque: Vec3<f64>,
    /// Signed distance of the surfaces `[m]`; negative if they penetrate.
    pub distance: f64,
}

/// Constraints of one world with all working memory.
#[derive(Clone, Debug)]
pub(crate) struct Constraints<R> {
    /// Warm start and classification of every slot.
    pub memory: WarmStart<R>,
    pub candidates: CandidateList,
    /// Kinematics of each at the last classification.
    pub kinematics: Vec<ContactKinematics<R>>,
    /// Slots that are open beyond their surface or bound since the start of the sub-step.
    pub open_inside: Vec<usize>,
    pub foresight: Foresight,
    /// Candidates of a later instant, for the detection of new contacts.
    pub later_candidates: CandidateList,
    /// Points of surfaces that may have touched and parted within the sub-step.
    pub parting: Vec<Parting>,
    pub detector: Detector,
    pub motions: Motions<R>,
    inverse_mass: delassus::InverseMass<R>,
    pub rows: Vec<Row<R>>,
    /// Constraint residual of each row: signed distance, position error of a loop joint.
    pub residual: Vec<R>,
    pub n_free: usize,
    pub blocks: Vec<UnilateralConstraint<R>>,
    /// Limited drives that are constraints of the next evaluation.
    pub kinks: Vec<Kink>,
    jacobian: Vec<R>,
    delassus_factors: delassus::Delassus<R>,
    a: Vec<R>,
    b: Vec<R>,
    pub lambda: Vec<R>,
    torque: Vec<R>,
    change: Vec<R>,
    velocity_change: Vec<R>,
    before: Vec<R>,
    kept: Vec<usize>,
    /// Conditioning of the loops in the last evaluation: smallest pivot of G with rows scaled to their sizes, about the
    /// square of the smallest singular value; 1 with contacts.
    pub conditioning: f64,
    /// True while limited drives at their kink are rows beside loops: prescribed, their accelerations contradict them.
    pub couples_drives: bool,
    /// Size of each bilateral row that is used ([`rank`]), squared.
    pub row_sizes: Vec<f64>,
    /// Squares of these rows in the metric of the mass matrix where they were selected.
    pub row_squares: Vec<f64>,
    /// Bilateral rows that are used; the others depend on them.
    pub is_independent: Vec<bool>,
    /// Length of the sub-step that is being made `[s]`; 0: none.
    pub sub_step: f64,
    /// Speed below which a contact neither slides nor approaches [m/s] or [rad/s].
    pub zero_speed: f64,
    /// Speed below which contacts that meet come to rest [m/s] or [rad/s].
    pub settling_speed: f64,
    /// Time from the event before to that of the present instant `[s]`; infinite if it is none.
    pub time_since_event: f64,
    /// Treatment of contact modes.
    pub mode_rule: ModeRule,
    /// True if the held modes had no solution in the last evaluation, which decided them.
    pub lost_modes: bool,
    /// Law that the held modes violate in the last evaluation.
    pub violation: Option<HeldLaw>,
    held: Solution<R>,
    /// True while the instant of a violation is being located: other modes are looked for near the held ones only.
    pub is_locating: bool,
    pub solver: Solver<R>,
    time_stepping: TimeStepping,
    pub rest: Rest<R>,
    /// Wrench on each link about the world's origin, world axes.
    wrenches: Vec<Force<R>>,
    /// Generalized forces of all constraints but drives, of a problem solved by sweeps.
    contact_torque: Vec<R>,
    /// True while problems at velocity level are solved by sweeps ([`time_stepping`]).
    pub sweeps: bool,
    /// Meaning of the contact forces kept, for sweeps.
    pub given_forces: GivenForces,
    /// True if the forces last found are those of sweeps.
    pub is_swept: bool,
}

impl<R: Real> Constraints<R> {
    pub fn new(model: &Model<R>) -> Option<Box<Self>> {
        let set = &model.params.constraints;
        if set.is_empty() {
            return None;
        }
        let n = vec![R::zero(); model.n_v()];
        let mut new = Self {
            memory: WarmStart::new(set.n_slots()),
            candidates: CandidateList::default(),
            kinematics: Vec::new(),
            open_inside: Vec::with_capacity(RESERVED),
            foresight: Foresight::default(),
            later_candidates: CandidateList::default(),
            parting: Vec::with_capacity(RESERVED),
            detector: Detector::new(&set.colliders, &set.pairs),
            motions: Motions::new(model),
            inverse_mass: delassus::InverseMass::new(model),
            rows: Vec::new(),
            residual: Vec::new(),
            n_free: 0,
            blocks: Vec::new(),
            kinks: Vec::with_capacity(model.n_drives()),
            jacobian: Vec::new(),
            delassus_factors: delassus::Delassus::new(model),
            a: Vec::new(),
            b: Vec::new(),
            lambda: Vec::new(),
            torque: n.clone(),
            change: n.clone(),
            velocity_change: n,
            before: Vec::new(),
            kept: Vec::new(),
            conditioning: 1.0,
            couples_drives: false,
            row_sizes: Vec::new(),
            row_squares: Vec::new(),
            is_independent: vec![true; set.n_bilateral()],
            sub_step: 0.0,
            zero_speed: ZERO_SPEED,
            settling_speed: SETTLING_SPEED,
            time_since_event: f64::INFINITY,
            mode_rule: ModeRule::Decided,
            lost_modes: false,
            violation: None,
            held: Solution::default(),
            is_locating: false,
            solver: Solver::default(),
            time_stepping: TimeStepping::default(),
            rest: Rest::new(model.all_trees()),
            wrenches: vec![Force::zero(); model.links.len()],
            contact_torque: vec![R::zero(); model.n_v()],
            sweeps: false,
            given_forces: GivenForces::Start,
            is_swept: false,
        };
        // more contacts than this at once enlarge the memory, once for every new maximum
        let groups = |p: &Pair| 1 + 2 * usize::from(p.material.friction > 0.0);
        let of_contacts: usize = set.pairs.iter().map(|p| p.slots * groups(p)).sum();
        let of_drives = 2 * model.n_drives();
        new.reserve(set.n_bilateral() + set.limits.len() + of_drives + of_contacts.min(RESERVED), model.n_v());
        Some(Box::new(new))
    }

    /// Memory for `m` rows.
    fn reserve(&mut self, m: usize, n: usize) {
        self.rows.reserve(m);
        self.blocks.reserve(m);
        self.kept.reserve(m);
        self.held.reserve(m);
        for list in [&mut self.residual, &mut self.b, &mut self.lambda, &mut self.before] {
            list.reserve(m);
        }
        self.jacobian.reserve(m * n);
        self.delassus_factors.reserve(m);
        self.a.reserve(m * m);
        self.solver.reserve(m);
    }

    /// Adds the constraint forces to the accelerations that forward dynamics found, and with them those of lines at the
    /// new state (`implicit`). Out of line, so that mechanisms without constraints do not carry it in their loop.
    #[allow(clippy::too_many_arguments)]
    #[inline(never)]
    pub fn apply(
        &mut self,
        model: &Model<R>,
        (q, v): (&[R], &[R]),
        level: Level,
        scratch: &mut Scratch<R>,
        v_dot: &mut [R],
        has_drives: bool,
        mut implicit: Option<&mut ImplicitForces<R>>,
    ) {
        if level == Level::Acceleration {
            kinematics::chain_poses(model, scratch);
            self.motions.place(model, scratch, v);
        }
        // at velocity level the poses and twists of the last contact detection stand
        self.assemble(model, q, v, scratch, level == Level::Acceleration);
        self.add_kinks();
        let left_out = if let Level::Velocity(_) = level { self.rest.hold(v_dot) } else { 0 };
        self.solver.report.islands += left_out;
        if self.rows.is_empty() {
            self.is_swept = false;
            if left_out > 0 {
                self.leave_all_out();
            }
            if let Some(implicit) = implicit {
                implicit.respond(model, scratch, v_dot, has_drives);
            }
            return;
        }
        if let (true, Level::Velocity(h)) = (self.sweeps, level) {
            return self.apply_by_sweeps(model, (h, v), scratch, v_dot, has_drives);
        }
        self.is_swept = false;
        self.assemble_delassus(model, scratch);
        self.b.clear();
        match level {
            Level::Acceleration => {
                self.motions.accelerate(model, scratch);
                self.b.extend(self.rows.iter().map(|row| self.motions.acceleration(row, v_dot)));
            }
            Level::Velocity(h) => {
                self.velocity_level_rates(model, h, v, v_dot);
                self.aim_at_targets(h);
            }
        }
        if let Some(implicit) = implicit.as_deref_mut() {
            implicit.reduce(self.delassus_factors.values(), &mut self.a, &mut self.b);
        }
        let vanishing = self.drop_vanishing_rows();
        self.solve();
        // redundant contacts are no singular position
        self.conditioning = if self.blocks.is_empty() { vanishing * self.solver.smallest_pivot } else { 1.0 };
        self.push(model, scratch, v_dot, has_drives, implicit);
        self.take_drive_torques(level == Level::Acceleration, scratch, v_dot);
    }

    /// Drops loop rows that vanish at a singular position, whose forces would be rounding; returns the smallest square
    /// of a row relative to its size.
    fn drop_vanishing_rows(&mut self) -> f64 {
        let sizes = core::mem::take(&mut self.row_sizes);
        let smallest = self.drop_rows_below(SINGULAR, &sizes);
        self.row_sizes = sizes;
        smallest
    }

    /// Drops loop rows whose square is below `rank` of its reference; returns the smallest ratio.
    fn drop_rows_below(&mut self, rank: f64, references: &[f64]) -> f64 {
        let m = self.rows.len();
        let mut smallest = 1.0_f64;
        for i in 0..self.n_free.min(references.len()) {
            let of_row = self.a[i * m + i].lane(0) / references[i];
            smallest = smallest.min(of_row);
            if of_row < rank {
                for j in 0..m {
                    (self.a[i * m + j], self.a[j * m + i]) = (R::zero(), R::zero());
                }
                self.b[i] = R::zero();
            }
        }
        smallest
    }

    /// Sliding rate and compliance of groups that slide so slowly that friction can turn their velocity within the
    /// step.
    fn find_slow_sliding(&mut self) {
        let m = self.rows.len();
        let h = self.sub_step;
        for block in &mut self.blocks {
            let normal = self.lambda[block.row].lane(0);
            for group in block.groups.iter_mut().flatten() {
                let Some(speed) = group.compliance.take() else { continue };
                let across = group.row + 1;
                group.slow_sliding =
                    SlowSliding { speed: speed.lane(0), h, mobility: self.a[across * m + across].lane(0) };
                group.compliance = group.sliding_rate(normal).map(|rate| R::splat(rate / (group.coefficient * normal)));
            }
        }
    }

    fn solve(&mut self) {
        self.find_slow_sliding();
        self.violation = None;
        let problem = ContactProblem { a: &self.a, b: &self.b, n_free: self.n_free };
        let holds = self.mode_rule != ModeRule::Decided;
        let load = if self.mode_rule == ModeRule::HeldAtInstant { Load::Shared } else { Load::Kept };
        let held = holds && self.solver.hold(&problem, &mut self.blocks, &mut self.lambda, load);
        self.lost_modes = holds && !held;
        if held {
            self.solver.is_approximate = false;
            if self.mode_rule != ModeRule::Held {
                self.check_held_modes();
            }
        } else {
            self.solver.solve(&problem, &mut self.blocks, &mut self.lambda);
        }
        self.memory.keep(&self.blocks, &self.lambda);
    }

    /// Checks the solution with held modes; one of another set of modes with the same accelerations takes its place
    /// where it violates a law.
    fn check_held_modes(&mut self) {
        let problem = ContactProblem { a: &self.a, b: &self.b, n_free: self.n_free };
        let Some(mut law) = self.solver.worst_law(&problem, &self.blocks, &self.lambda) else { return };
        if self.mode_rule == ModeRule::HeldAndChecked
            && self.solver.share_kept_load(&problem, &self.blocks, &mut self.lambda)
        {
            // a load that no share could carry violates a law however it is shared: nothing is missed
            let Some(of_shared) = self.solver.worst_law(&problem, &self.blocks, &self.lambda) else { return };
            law = of_shared;
        }
        self.held.keep(&self.blocks, &self.lambda, self.solver.rates());
        let report = self.solver.report;
        let is_solved = if self.is_locating {
            self.solver.solve_nearby(&problem, &mut self.blocks, &mut self.lambda)
        } else {
            self.solver.solve(&problem, &mut self.blocks, &mut self.lambda);
            self.solver.report.not_converged == report.not_converged
        };
        if is_solved && !is_observable(&problem, self.solver.rates(), &self.held.rates) && !self.releases_drives() {
            return;
        }
        self.solver.report.discard(&report);
        self.blocks.copy_from_slice(&self.held.blocks);
        self.lambda.copy_from_slice(&self.held.lambda);
        self.solver.find_rates(&problem, &self.lambda);
        self.violation = Some(law);
    }

    /// Returns true if drives that the held modes lock move in the last solution, by more than what counts as none over
    /// the sub-step: a strong motor that pushes against a joint limit makes the largest rate of the problem, of which
    /// that of a weak drive is no share.
    fn releases_drives(&self) -> bool {
        let (rates, h) = (self.solver.rates(), self.sub_step);
        drive_groups(&self.blocks).zip(drive_groups(&self.held.blocks)).any(|(now, held)| {
            held.mode == ContactMode::Stick
                && now.mode == ContactMode::Slip
                && rates[now.row].lane(0).abs() * h > self.zero_speed
        })
    }

    /// Returns true if the multipliers last found leave rates of bilateral rows, beyond rounding.
    pub fn leaves_loop_rates(&self) -> bool {
        let m = self.rows.len();
        if self.is_swept || self.b.len() < m {
            return false;
        }
        let largest = self.b.iter().fold(0.0_f64, |s, x| s.max(x.lane(0).abs()));
        let rate = |i: usize| self.b[i] + dot(&self.a[i * m..(i + 1) * m], &self.lambda);
        (0..self.n_free.min(m)).any(|i| rate(i).lane(0).abs() > HELD_RATE * largest)
    }

    /// Rate of the sliding velocity of a group along that at the start of the sub-step, in the evaluation last made;
    /// NaN if it slides no more.
    pub fn sliding_rate(&self, slot: usize, group: usize) -> f64 {
        let block = self.blocks.iter().find(|block| block.slot == slot);
        let group = block.and_then(|block| block.groups[group].as_ref()).filter(|group| group.is_sliding);
        group.map_or(f64::NAN, |group| {
            let rate = self.solver.rates()[group.row];
            // of two rows the first is along that velocity, of one the friction is against it
            (if group.dim == 2 { rate } else { -(rate * group.direction[0]) }).lane(0)
        })
    }

    /// Returns true if the problem last solved has another solution, with other accelerations; `takes` it then.
    pub fn has_other_solution(&mut self, takes: bool) -> bool {
        let problem = ContactProblem { a: &self.a, b: &self.b, n_free: self.n_free };
        let is_found =
            !self.is_swept && self.solver.has_other_solution(&problem, takes, &mut self.blocks, &mut self.lambda);
        if is_found && takes {
            self.memory.keep(&self.blocks, &self.lambda);
        }
        is_found
    }

    /// Excess of a law over its tolerance in the last evaluation, above zero if it is violated.
    pub fn excess(&self, law: HeldLaw) -> f64 {
        debug_assert!(!self.is_swept, "sweeps hold no modes");
        let problem = ContactProblem { a: &self.a, b: &self.b, n_free: self.n_free };
        self.solver.excess(law, &problem, &self.blocks, &self.lambda)
    }

    /// Adds the response to the constraint forces to accelerations and reactions.
    fn push(
        &mut self,
        model: &Model<R>,
        scratch: &mut Scratch<R>,
        v_dot: &mut [R],
        has_drives: bool,
        implicit: Option<&mut ImplicitForces<R>>,
    ) {
        let n = model.n_v();
        self.torque.fill(R::zero());
        for (i, lambda) in self.lambda.iter().enumerate() {
            for (t, j) in self.torque.iter_mut().zip(&self.jacobian[i * n..(i + 1) * n]) {
                *t += *lambda * *j;
            }
        }
        if let Some(implicit) = implicit {
            for (torque, of_lines) in self.torque.iter_mut().zip(implicit.torque(model, &self.lambda)) {
                *torque += *of_lines;
            }
        }
        self.respond(model, scratch, v_dot, has_drives);
    }

    /// Adds the response to the generalized forces in `torque` to accelerations and reactions.
    fn respond(&mut self, model: &Model<R>, scratch: &mut Scratch<R>, v_dot: &mut [R], has_drives: bool) {
        let mut reaction = core::mem::take(&mut scratch.reaction);
        let wanted = has_drives.then_some(&mut reaction[..]);
        self.inverse_mass.find(model, scratch, &self.torque, &mut self.change, wanted);
        scratch.reaction = reaction;
        for (v_dot, change) in v_dot.iter_mut().zip(&self.change) {
            *v_dot += *change;
        }
    }

    /// Scale of the forces of the problem last solved: the largest multiplier, or the force that would stop the largest
    /// rate of the lightest row.
    pub fn force_scale(&self) -> f64 {
        let largest = |x: &[R]| x.iter().fold(f64::MIN_POSITIVE, |s, x| s.max(x.lane(0).abs()));
        if self.is_swept {
            // sweeps have no Delassus matrix
            return largest(&self.lambda);
        }
        let m = self.rows.len();
        let lightest = (0..m).map(|i| self.a[i * m + i].lane(0)).fold(0.0, f64::max);
        let stopping = if lightest > 0.0 { largest(&self.b) / lightest } else { 0.0 };
        largest(&self.lambda).max(stopping)
    }

    /// Power dissipated by all constraint forces at joint rates `v` `[W]`, after [`Constraints::apply`].
    pub fn dissipation(&self, v: &[R]) -> R {
        if self.is_swept {
            return -dot(&self.contact_torque, v);
        }
        let n = v.len();
        let mut sum = R::zero();
        // the work of drives is counted by themselves
        let of_drives = self.blocks.iter().find(|block| block.is_drive());
        let rows = of_drives.map_or(self.lambda.len(), |block| block.row);
        for (i, lambda) in self.lambda[..rows].iter().enumerate() {
            sum += *lambda * dot(&self.jacobian[i * n..(i + 1) * n], v);
        }
        -sum
    }
}

/// The pair that a contact slot belongs to.
pub(crate) fn pair_of(set: &ConstraintSet, slot: usize) -> usize {
    pair_of_slot(&set.pairs, slot)
}
