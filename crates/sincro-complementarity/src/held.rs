//! Solution with held contact modes, and the laws that it may violate.
//!
//! Between two events the contact modes of the start of the sub-step stand: a contact that carries load may pull, a
//! sticking one exceed its cone, an open one be approached. Forces and accelerations are then smooth functions of the
//! state up to the event and beyond it, as the integrator's error estimate and the search for the instant of the event
//! need them. Where a law is violated, the complementarity problem is solved as a whole: if its accelerations are the
//! same (redundant contacts, of which others can carry what these cannot), its solution is taken, else the violation is
//! a zero crossing. Source: key `acary2008`, chapter 8 (event-driven schemes, index sets).

use sincro_math::Real;

use super::active_set::ContactProblem;
use super::cone::{ContactMode, FrictionGroup, UnilateralConstraint};
use super::solver::{MAX_TURNS, RANK, SLACK, Solver, Tolerances, norm, pair, turn_impending_slip, turn_slow_friction};

/// Least change of a rate that is an observable one, relative to the largest rate.
const OBSERVABLE: f64 = 0.1 * SLACK;

/// Size of a turn that has only let the direction of a compliant contact turn, without changing it.
const RELEASED: f64 = f64::from_bits(1);

/// Number of turns after which redundant constraints share the load in each of them.
const UNSHARED_TURNS: usize = 4;

/// Constraint by what it stands for, wherever it is in the list of an evaluation: contacts that have left are in none.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ConstraintId {
    /// Slot of the constraint.
    slot: usize,
    /// Number among the constraints of this slot: drives share one.
    number: usize,
}

impl ConstraintId {
    /// Returns the identity of constraint `k` of a list.
    ///
    /// # Panics
    ///
    /// If there is no such constraint.
    #[must_use]
    pub fn of<R: Real>(blocks: &[UnilateralConstraint<R>], k: usize) -> Self {
        let slot = blocks[k].slot;
        Self { slot, number: blocks[..k].iter().filter(|block| block.slot == slot).count() }
    }

    /// The constraint in a list.
    fn find<R: Real>(self, blocks: &[UnilateralConstraint<R>]) -> Option<&UnilateralConstraint<R>> {
        blocks.iter().filter(|block| block.slot == self.slot).nth(self.number)
    }
}

/// Law that held modes may violate; constraint, and index of its friction group.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum HeldLaw<C = ConstraintId> {
    /// A closed contact does not pull.
    Unilateral(C),
    /// An open contact is not approached.
    Open(C),
    /// Sticking friction stays within its cone.
    Stick(C, usize),
    /// Impending slip is opposed by its friction.
    Slip(C, usize),
}

impl<C: Copy> HeldLaw<C> {
    /// Constraint that it is about.
    fn constraint(self) -> C {
        match self {
            Self::Unilateral(c) | Self::Open(c) | Self::Stick(c, _) | Self::Slip(c, _) => c,
        }
    }

    /// The same law of a constraint that is named in another way.
    fn about<D>(self, constraint: D) -> HeldLaw<D> {
        match self {
            Self::Unilateral(_) => HeldLaw::Unilateral(constraint),
            Self::Open(_) => HeldLaw::Open(constraint),
            Self::Stick(_, g) => HeldLaw::Stick(constraint, g),
            Self::Slip(_, g) => HeldLaw::Slip(constraint, g),
        }
    }
}

/// Load of redundant constraints in a solution with held modes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Load {
    /// Shared as by equally stiff constraints.
    Shared,
    /// About as it was before, where that makes no difference to the motion.
    Kept,
}

/// A solution, kept while another one is sought.
#[derive(Clone, Debug, Default)]
pub struct Solution<R> {
    /// Constraints with their modes.
    pub blocks: Vec<UnilateralConstraint<R>>,
    /// Multipliers λ.
    pub lambda: Vec<R>,
    /// Rates w.
    pub rates: Vec<R>,
}

impl<R: Real> Solution<R> {
    /// Memory for problems of `m` rows.
    pub fn reserve(&mut self, m: usize) {
        self.blocks.reserve(m.saturating_sub(self.blocks.len()));
        for list in [&mut self.lambda, &mut self.rates] {
            list.reserve(m.saturating_sub(list.len()));
        }
    }

    /// Takes over a solution.
    pub fn keep(&mut self, blocks: &[UnilateralConstraint<R>], lambda: &[R], rates: &[R]) {
        self.blocks.clear();
        self.blocks.extend_from_slice(blocks);
        for (kept, list) in [(&mut self.lambda, lambda), (&mut self.rates, rates)] {
            kept.clear();
            kept.extend_from_slice(list);
        }
    }
}

impl<R: Real> Solver<R> {
    /// Finds λ for the modes of `blocks`; returns false if they have no solution. Directions of friction are part of
    /// the solution.
    pub fn hold(
        &mut self,
        problem: &ContactProblem<'_, R>,
        blocks: &mut [UnilateralConstraint<R>],
        lambda: &mut [R],
        load: Load,
    ) -> bool {
        self.report.solved += 1;
        self.hold_modes(problem, blocks, lambda, (load, MAX_TURNS))
    }

    /// Lets redundant constraints share the load where [`Solver::hold`] has kept it; returns false where it has not.
    pub fn share_kept_load(
        &mut self,
        problem: &ContactProblem<'_, R>,
        blocks: &[UnilateralConstraint<R>],
        lambda: &mut [R],
    ) -> bool {
        let is_shared = !slips(blocks) && self.share_load(problem, blocks, lambda);
        if is_shared {
            self.active_set.find_rates(problem, lambda);
        }
        is_shared
    }

    /// As [`Solver::hold`], as a part of another problem; from turn `patience` on, directions that converge too slowly
    /// are given up.
    pub(crate) fn hold_modes(
        &mut self,
        problem: &ContactProblem<'_, R>,
        blocks: &mut [UnilateralConstraint<R>],
        lambda: &mut [R],
        (load, patience): (Load, usize),
    ) -> bool {
        self.rank = RANK;
        let (mut last, mut is_shared) = ([f64::INFINITY; 2], turns_by_load(blocks));
        let wants_share = load == Load::Shared || slips(blocks);
        for n_turns in 0..MAX_TURNS {
            self.correct_rates(problem, blocks, lambda);
            // until the directions are found the load is shared as before
            if wants_share && (is_shared || n_turns >= UNSHARED_TURNS || blocks.is_empty()) {
                self.share_load(problem, blocks, lambda);
                is_shared = true;
            }
            if blocks.is_empty() {
                return true;
            }
            let mut turned = self.turn_slip(problem, blocks, lambda);
            if wants_share && turned == 0.0 && !is_shared && self.share_load(problem, blocks, lambda) {
                is_shared = true;
                turned = self.turn_slip(problem, blocks, lambda);
            }
            if turned > RELEASED {
                if n_turns >= patience && !converges(turned, last[0], MAX_TURNS - n_turns) {
                    return false;
                }
                last = [last[1], turned];
            }
            if turned > 0.0 {
                continue;
            }
            self.refine(problem, blocks, lambda);
            return self.is_consistent(Tolerances::of(problem, blocks, (lambda, &self.active_set.rates)), blocks);
        }
        false
    }

    /// Finds the rates of λ, and turns friction against them; returns the largest change of a direction.
    fn turn_slip(
        &mut self,
        problem: &ContactProblem<'_, R>,
        blocks: &mut [UnilateralConstraint<R>],
        lambda: &[R],
    ) -> f64 {
        self.active_set.find_rates(problem, lambda);
        let small = Tolerances::of(problem, blocks, (lambda, &self.active_set.rates));
        turn(small, &self.active_set.rates, blocks, lambda)
    }

    /// Returns true if the rates that the modes hold at zero are zero.
    fn is_consistent(&self, small: Tolerances, blocks: &[UnilateralConstraint<R>]) -> bool {
        let rates = &self.active_set.rates;
        let sticks = |group: &&FrictionGroup<R>| group.mode == ContactMode::Stick;
        blocks.iter().filter(|block| !block.open).all(|block| {
            let normal = if block.given.is_some() { 0.0 } else { rates[block.row].lane(0).abs() };
            let mut sticking = block.groups.iter().flatten().filter(sticks);
            normal <= small.held && sticking.all(|group| norm(pair(group, rates)) <= small.stick)
        })
    }

    /// Law that the solution with held modes violates most; none if it violates none.
    #[must_use]
    pub fn worst_law(
        &self,
        problem: &ContactProblem<'_, R>,
        blocks: &[UnilateralConstraint<R>],
        lambda: &[R],
    ) -> Option<HeldLaw> {
        let small = Tolerances::of(problem, blocks, (lambda, &self.active_set.rates));
        let mut worst: (Option<HeldLaw<usize>>, f64) = (None, 0.0);
        let mut look = |law: HeldLaw<usize>| {
            let block = &blocks[law.constraint()];
            let excess = excess(law.about(block), small, &self.active_set.rates, lambda);
            if excess > worst.1 {
                worst = (Some(law), excess);
            }
        };
        for (k, block) in blocks.iter().enumerate() {
            if block.open {
                look(HeldLaw::Open(k));
                continue;
            }
            if block.given.is_none() {
                look(HeldLaw::Unilateral(k));
            }
            for (g, group) in block.groups.iter().enumerate() {
                match group {
                    Some(group) if group.mode == ContactMode::Stick => look(HeldLaw::Stick(k, g)),
                    Some(group) if !group.is_sliding => look(HeldLaw::Slip(k, g)),
                    _ => {}
                }
            }
        }
        worst.0.map(|law| law.about(ConstraintId::of(blocks, law.constraint())))
    }

    /// Excess of `law` over its tolerance, relative to the largest force or rate; above zero if it is violated. That of
    /// a constraint which is none any more is −1.
    #[must_use]
    pub fn excess(
        &self,
        law: HeldLaw,
        problem: &ContactProblem<'_, R>,
        blocks: &[UnilateralConstraint<R>],
        lambda: &[R],
    ) -> f64 {
        let block = law.constraint().find(blocks);
        block.map_or(-1.0, |block| {
            let small = Tolerances::of(problem, blocks, (lambda, &self.active_set.rates));
            excess(law.about(block), small, &self.active_set.rates, lambda)
        })
    }

    /// Finds the rates of `lambda`.
    pub fn find_rates(&mut self, problem: &ContactProblem<'_, R>, lambda: &[R]) {
        self.active_set.find_rates(problem, lambda);
    }

    /// Rates of the last solution.
    #[must_use]
    pub fn rates(&self) -> &[R] {
        &self.active_set.rates
    }
}

/// Returns true if `rates` differ from those of another solution of the problem.
#[must_use]
pub fn is_observable<R: Real>(problem: &ContactProblem<'_, R>, rates: &[R], others: &[R]) -> bool {
    differ(problem, rates, others, OBSERVABLE)
}

/// Returns true if rates differ from others by more than a `share` of the largest rate of the problem.
pub(crate) fn differ<R: Real>(problem: &ContactProblem<'_, R>, rates: &[R], others: &[R], share: f64) -> bool {
    let largest = problem.b.iter().fold(f64::MIN_POSITIVE, |s, x| s.max(x.lane(0).abs()));
    rates.iter().zip(others).any(|(x, y)| (*x - *y).lane(0).abs() > share * largest)
}

fn excess<R: Real>(law: HeldLaw<&UnilateralConstraint<R>>, small: Tolerances, rates: &[R], lambda: &[R]) -> f64 {
    let of_group = |block: &UnilateralConstraint<R>, g: usize, f: &dyn Fn(&FrictionGroup<R>, f64) -> f64| {
        block.groups[g].as_ref().map_or(f64::NAN, |group| f(group, lambda[block.row].lane(0)))
    };
    match law {
        HeldLaw::Unilateral(block) => -lambda[block.row].lane(0) / small.force * SLACK - SLACK,
        HeldLaw::Open(block) => -rates[block.row].lane(0) / small.rate * SLACK - SLACK,
        HeldLaw::Stick(block, g) => of_group(block, g, &|group, normal| {
            let beyond = norm(pair(group, lambda)) - group.coefficient * normal.max(0.0);
            beyond / small.force * SLACK - SLACK * group.slack
        }),
        HeldLaw::Slip(block, g) => of_group(block, g, &|group, _| {
            let (rate, d) = (pair(group, rates), group.direction.map(|d| d.lane(0)));
            (rate[0] * d[0] + rate[1] * d[1] - small.stick) / small.rate * SLACK
        }),
    }
}

/// Returns true if a group slides so slowly that its direction hangs on its share of the load.
fn turns_by_load<R: Real>(blocks: &[UnilateralConstraint<R>]) -> bool {
    let groups = blocks.iter().filter(|block| !block.open).flat_map(|block| block.groups.iter().flatten());
    groups.into_iter().any(|group| group.is_sliding && group.compliance.is_some())
}

/// Returns true if friction of a closed constraint slips.
fn slips<R: Real>(blocks: &[UnilateralConstraint<R>]) -> bool {
    let mut groups = blocks.iter().filter(|block| !block.open).flat_map(|block| block.groups.iter().flatten());
    groups.any(|group| group.mode == ContactMode::Slip)
}

/// Returns true if changes of directions, now of size `turned` and of size `before` two turns before, come down to
/// rounding in `n` more turns at this pace.
fn converges(turned: f64, before: f64, n: usize) -> bool {
    let of_two_turns = turned / before;
    turned * of_two_turns.powi(n.div_ceil(2) as i32) <= SLACK
}

/// Moves on in the search for the direction of an impending slip that seems to go along its friction: the direction is
/// that of an instant before and has not been free to turn yet, or the iterate is beyond the limit. Returns false where
/// neither is so: it sticks then.
fn seek_direction<R: Real>(
    group: &mut FrictionGroup<R>,
    normal: f64,
    small: Tolerances,
    rates: &[R],
    lambda: &[R],
) -> bool {
    let (limit, force) = (group.coefficient * normal, pair(group, lambda));
    let (size, compliance) = (norm(force), norm(pair(group, rates)) / limit);
    if group.dim != 2 || !compliance.is_finite() || compliance <= 0.0 {
        return false;
    }
    if group.compliance.is_none() {
        group.compliance = Some(R::splat(compliance));
        return true;
    }
    let is_beyond = size > limit + small.force * group.slack;
    if is_beyond {
        group.slip(force.map(|x| R::splat(x / size)), None);
    }
    is_beyond
}

/// Turns friction that slips against its velocity or rate, and of compliant contacts seeks directions that go along it;
/// returns the largest change of a direction, zero if all were turned so. A rate that counts as none for sticking
/// friction gives impending slip no direction.
fn turn<R: Real>(mut small: Tolerances, rates: &[R], blocks: &mut [UnilateralConstraint<R>], lambda: &[R]) -> f64 {
    small.slip = small.stick;
    let mut turned = 0.0_f64;
    for block in blocks.iter_mut().filter(|block| !block.open) {
        let (normal, seeks) = (lambda[block.row].lane(0), block.is_compliant);
        for group in block.groups.iter_mut().flatten() {
            let before = group.direction;
            let is_turned = match group.mode {
                ContactMode::Slip if group.is_sliding => turn_slow_friction(group, normal, rates, lambda),
                ContactMode::Slip => turn_impending_slip(group, normal.max(0.0), small, rates, lambda)
                    .unwrap_or_else(|| seeks && seek_direction(group, normal, small, rates, lambda)),
                ContactMode::Stick => false,
            };
            if is_turned {
                let change = [0, 1].map(|k| (group.direction[k] - before[k]).lane(0));
                turned = turned.max(norm(change).max(if seeks { RELEASED } else { f64::MIN_POSITIVE }));
            }
        }
    }
    turned
}
