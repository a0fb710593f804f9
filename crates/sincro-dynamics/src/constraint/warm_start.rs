//! Warm start of the solver: multipliers and contact modes of each slot, kept from one evaluation to the next.
//!
//! | per slot | meaning | part of the state |
//! |---|---|---|
//! | multipliers | λ of the normal and of up to five friction rows `[N]`, [N·m] | yes |
//! | code | 0 never solved, else 1 + 1·open + 2, 4, 8·slipping group | yes |
//! | closed, slides, directions | classification at the start of a sub-step | no: from positions and velocities |
//!
//! The last number is the [`ZenoFallback`].

use sincro_math::Real;

use super::cone::{ContactMode, UnilateralConstraint};
use crate::model::{SLOT_LEN, warm_start_len};

/// Fallback for Zeno behaviour (event storms): after a tick with too many events the next `pause` ticks are made at
/// velocity level without event location, `left` of which remain. The pause doubles until a tick succeeds; a heap that
/// comes to rest would otherwise cost a hundred located events a tick.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct ZenoFallback {
    pub pause: u32,
    pub left: u32,
}

impl ZenoFallback {
    /// Maximum number of ticks without event location.
    const MOST: u32 = 32;

    /// Fallback after one more tick with too many events.
    pub fn lost(self) -> Self {
        let pause = (2 * self.pause).clamp(1, Self::MOST);
        Self { pause, left: pause }
    }
}

#[derive(Clone, Debug)]
pub(crate) struct WarmStart<R> {
    /// Multipliers and codes, as in the state.
    pub numbers: Vec<R>,
    closed: Vec<bool>,
    /// Slots that have closed since they were last asked for.
    is_new: Vec<bool>,
    slides: Vec<[bool; 3]>,
    directions: Vec<[[R; 2]; 3]>,
    /// Multipliers and codes at the start of a sub-step.
    start: Vec<R>,
    /// Those that others were proposed for.
    decided: Vec<R>,
    start_directions: Vec<[[R; 2]; 3]>,
    /// Sliding velocity of each group along that at the start [m/s] or [rad/s]; below zero it has reversed.
    along_start: Vec<[f64; 3]>,
}

impl<R: Real> WarmStart<R> {
    pub fn new(n_slots: usize) -> Self {
        Self {
            numbers: vec![R::zero(); warm_start_len(n_slots)],
            closed: vec![false; n_slots],
            is_new: vec![false; n_slots],
            slides: vec![[false; 3]; n_slots],
            directions: vec![[[R::zero(); 2]; 3]; n_slots],
            start: vec![R::zero(); warm_start_len(n_slots)],
            decided: vec![R::zero(); warm_start_len(n_slots)],
            start_directions: vec![[[R::zero(); 2]; 3]; n_slots],
            along_start: vec![[0.0; 3]; n_slots],
        }
    }

    /// Takes over which slots are closed and which of their groups slide, and in which directions.
    pub fn take_modes(&mut self, other: &WarmStart<f64>) {
        self.closed.clone_from(&other.closed);
        self.slides.clone_from(&other.slides);
        for (own, other) in self.directions.iter_mut().zip(&other.directions) {
            *own = other.map(|direction| direction.map(R::splat));
        }
    }

    /// Takes multipliers and modes from a state; they are those that the motion came with.
    pub fn load(&mut self, numbers: &[R]) {
        self.numbers.copy_from_slice(numbers);
        self.start.copy_from_slice(numbers);
    }

    /// Forgets the modes that the motion came with: those of a step at velocity level are no modes of forces.
    pub fn forget_start(&mut self) {
        self.start.fill(R::zero());
    }

    pub fn zeno_fallback(&self) -> ZenoFallback {
        let number = self.numbers.last().map_or(0, |x| x.lane(0) as u32);
        ZenoFallback { pause: number / 256, left: number % 256 }
    }

    pub fn set_patience(&mut self, zeno_fallback: ZenoFallback) {
        if let Some(number) = self.numbers.last_mut() {
            *number = R::splat(f64::from(256 * zeno_fallback.pause + zeno_fallback.left));
        }
    }

    pub fn is_closed(&self, slot: usize) -> bool {
        self.closed[slot]
    }

    /// Returns true if any slot is closed.
    pub fn has_closed(&self) -> bool {
        self.closed.contains(&true)
    }

    /// Returns true once after a slot has closed.
    pub fn take_new(&mut self, slot: usize) -> bool {
        core::mem::take(&mut self.is_new[slot])
    }

    pub fn slides(&self, slot: usize, group: usize) -> bool {
        self.slides[slot][group]
    }

    pub fn direction(&self, slot: usize, group: usize) -> [R; 2] {
        self.directions[slot][group]
    }

    /// Sets the direction of a sliding group's friction, for its `speed`. Within a sub-step it does not reverse: the
    /// force continues smoothly until the instant of reversal has been located.
    pub fn set_direction(&mut self, slot: usize, group: usize, direction: [R; 2], speed: R) -> [R; 2] {
        let start = self.start_directions[slot][group];
        let along = (direction[0] * start[0] + direction[1] * start[1]).lane(0);
        self.along_start[slot][group] = along * speed.lane(0);
        let direction = if along < 0.0 { direction.map(|x| -x) } else { direction };
        self.directions[slot][group] = direction;
        direction
    }

    /// Classifies a slot; the warm start of one that is not closed is cleared.
    pub fn classify(&mut self, slot: usize, closed: bool, slides: [bool; 3]) {
        self.is_new[slot] = closed && (self.is_new[slot] || !self.closed[slot]);
        self.closed[slot] = closed;
        self.slides[slot] = slides;
        self.start_directions[slot] = [[R::zero(); 2]; 3];
        if !closed {
            self.numbers[slot * SLOT_LEN..(slot + 1) * SLOT_LEN].fill(R::zero());
        }
    }

    /// Restores multipliers and modes of the last solution, or with `holds` the modes of the start of the sub-step.
    pub fn restore(&self, blocks: &mut [UnilateralConstraint<R>], lambda: &mut [R], holds: bool) {
        for block in blocks.iter_mut().filter(|block| !block.is_drive()) {
            let code = code(if holds { &self.start } else { &self.numbers }, block.slot);
            if code == 0 {
                continue;
            }
            let kept = &self.numbers[block.slot * SLOT_LEN..];
            lambda[block.row] = kept[0];
            block.open = (code - 1) & 1 == 1 && block.given.is_none();
            for (g, group) in block.groups.iter_mut().enumerate() {
                let Some(group) = group else { continue };
                let first = [1, 3, 5][g];
                lambda[group.row..group.row + group.dim].copy_from_slice(&kept[first..first + group.dim]);
                if group.slides || (code - 1) >> (g + 1) & 1 == 0 {
                    continue;
                }
                let mut d = [R::zero(); 2];
                d[..group.dim].copy_from_slice(&kept[first..first + group.dim]);
                let square = d[0] * d[0] + d[1] * d[1];
                if square.lane(0) > 0.0 {
                    let inverse = R::one() / square.sqrt();
                    group.slip(d.map(|x| x * inverse), None);
                }
            }
        }
    }

    /// Stores a solution.
    pub fn keep(&mut self, blocks: &[UnilateralConstraint<R>], lambda: &[R]) {
        for block in blocks.iter().filter(|block| !block.is_drive()) {
            let kept = &mut self.numbers[block.slot * SLOT_LEN..(block.slot + 1) * SLOT_LEN];
            kept[0] = lambda[block.row];
            let mut code = 1 + u32::from(block.open);
            for (g, group) in block.groups.iter().enumerate() {
                let Some(group) = group else { continue };
                let first = [1, 3, 5][g];
                kept[first..first + group.dim].copy_from_slice(&lambda[group.row..group.row + group.dim]);
                if group.mode == ContactMode::Slip && !block.open {
                    code += 2 << g;
                }
            }
            kept[6] = R::splat(f64::from(code));
        }
    }

    /// Records multipliers and modes at the start of a sub-step.
    pub fn mark_start(&mut self) {
        self.start.copy_from_slice(&self.numbers);
        self.start_directions.copy_from_slice(&self.directions);
    }

    /// Returns true if a mode differs from the start of the sub-step.
    pub fn has_other_modes(&self) -> bool {
        (0..self.closed.len()).any(|slot| self.closed[slot] && code(&self.start, slot) != code(&self.numbers, slot))
    }

    /// Returns true if a mode differs from the start of the last sub-step, and every closed slot had one there.
    pub fn has_left_modes(&self) -> bool {
        let has_former = |slot: usize| !self.closed[slot] || code(&self.start, slot) != 0;
        self.has_other_modes() && (0..self.closed.len()).all(has_former)
    }

    /// Keeps the present multipliers and modes while others are looked at.
    pub fn set_aside(&mut self) {
        self.decided.copy_from_slice(&self.numbers);
    }

    /// Goes back to the multipliers and modes that were set aside.
    pub fn take_set_aside(&mut self) {
        self.numbers.copy_from_slice(&self.decided);
    }

    /// Takes the present multipliers and modes for those at the start of the sub-step; directions stay.
    pub fn propose_modes(&mut self) {
        self.decided.copy_from_slice(&self.start);
        self.start.copy_from_slice(&self.numbers);
        self.directions.copy_from_slice(&self.start_directions);
    }

    /// Takes back [`WarmStart::propose_modes`].
    pub fn reject_modes(&mut self) {
        self.start.copy_from_slice(&self.decided);
        self.return_to_start();
    }

    /// Goes back to multipliers and modes at the start of the sub-step.
    pub fn return_to_start(&mut self) {
        self.numbers.copy_from_slice(&self.start);
        self.directions.copy_from_slice(&self.start_directions);
    }

    /// Returns true if a slot carried a force, or none was needed of it, at the start of the sub-step.
    pub fn was_closed(&self, slot: usize) -> bool {
        self.closed[slot] && code(&self.start, slot).saturating_sub(1) & 1 == 0
    }

    /// Closed slot and group that slides fastest against its direction at the start of the sub-step.
    pub fn reversal(&self) -> Option<(usize, usize)> {
        let along = |(slot, g): &(usize, usize)| self.along_start[*slot][*g];
        let closed = (0..self.closed.len()).filter(|slot| self.closed[*slot]);
        closed
            .flat_map(|slot| (0..3).map(move |g| (slot, g)))
            .filter(|(slot, g)| self.slides[*slot][*g] && along(&(*slot, *g)) < 0.0)
            .min_by(|a, b| along(a).total_cmp(&along(b)))
    }

    /// Sliding velocity of a group along that at the start of the sub-step [m/s] or [rad/s].
    pub fn along_start(&self, slot: usize, group: usize) -> f64 {
        self.along_start[slot][group]
    }
}

/// Code of a slot.
fn code<R: Real>(numbers: &[R], slot: usize) -> u32 {
    numbers[slot * SLOT_LEN + 6].lane(0) as u32
}
