//! Warm start of the solver: multipliers and contact modes of each slot, kept from one evaluation to the next.
//!
//! | per slot | meaning | part of the state |
//! |---|---|---|
//! | multipliers | λ of the normal and of up to five friction rows `[N]`, [N·m] | yes |
//! | code | 0 never solved, else 1 + 1·open + 2, 4, 8·slipping group, + 32·feature after sweeps | yes |
//! | closed, is_sliding, directions | classification at the start of a sub-step | no: from positions and velocities |
//!
//! In the state stands the [`ZenoFallback`], then one record a slot that has been solved: its index and these numbers.

use sincro_math::Real;

use super::cone::{ContactMode, UnilateralConstraint};

/// Numbers of a slot behind its index: six multipliers (normal, two of sliding friction, two of rolling, one of
/// spinning) and the code of its modes.
pub const SLOT_LEN: usize = 7;

/// Number of slots that there is room for from the start; more take memory once they are closed.
pub const RESERVED_SLOTS: usize = 64;

/// Numbers of a slot in the state: its index, then its multipliers and code.
const RECORD_LEN: usize = 1 + SLOT_LEN;

/// Factor of the feature in a code.
const FEATURE: f64 = 32.0;

/// Fallback for Zeno behaviour (event storms): after a tick with too many events the next `pause` ticks are made at
/// velocity level without event location, `left` of which remain. The pause doubles until a tick succeeds; a heap that
/// comes to rest would otherwise cost a hundred located events a tick.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct ZenoFallback {
    /// Number of ticks without event location after a tick with too many events.
    pub pause: u32,
    /// Number of those that remain.
    pub left: u32,
}

impl ZenoFallback {
    /// Maximum number of ticks without event location.
    const MOST: u32 = 32;

    /// Fallback after one more tick with too many events.
    #[must_use]
    pub fn lost(self) -> Self {
        let pause = (2 * self.pause).clamp(1, Self::MOST);
        Self { pause, left: pause }
    }
}

/// Warm start and classification of one slot.
#[derive(Clone, Copy, Debug)]
struct Entry<R> {
    slot: u32,
    closed: bool,
    /// True if the slot is left out of the classification that is being made, and stays as it is.
    is_held: bool,
    /// True if the slot has closed since it was last asked for.
    is_new: bool,
    is_sliding: [bool; 3],
    /// Multipliers and code: of the last solution, at the start of the sub-step, and those that others were proposed
    /// for.
    numbers: [R; SLOT_LEN],
    start: [R; SLOT_LEN],
    decided: [R; SLOT_LEN],
    directions: [[R; 2]; 3],
    start_directions: [[R; 2]; 3],
    /// Sliding velocity of each group along that at the start [m/s] or [rad/s]; below zero it has reversed.
    along_start: [f64; 3],
}

impl<R: Real> Entry<R> {
    fn new(slot: usize) -> Self {
        let zeros = [R::zero(); SLOT_LEN];
        Self {
            slot: slot as u32,
            closed: false,
            is_held: false,
            is_new: false,
            is_sliding: [false; 3],
            numbers: zeros,
            start: zeros,
            decided: zeros,
            directions: [[R::zero(); 2]; 3],
            start_directions: [[R::zero(); 2]; 3],
            along_start: [0.0; 3],
        }
    }

    /// Returns true if nothing would be different without this entry.
    fn is_idle(&self) -> bool {
        !self.closed && self.start.iter().chain(&self.numbers).all(|x| *x == R::zero())
    }

    /// Classifies the slot; the warm start of one that is not closed is cleared.
    fn classify(&mut self, closed: bool, is_sliding: [bool; 3]) {
        self.is_new = closed && (self.is_new || !self.closed);
        (self.closed, self.is_sliding) = (closed, is_sliding);
        self.start_directions = [[R::zero(); 2]; 3];
        if !closed {
            self.numbers = [R::zero(); SLOT_LEN];
        }
    }
}

/// Entries of the slots that are closed or were, in increasing order of slots.
#[derive(Clone, Debug)]
pub struct WarmStart<R> {
    entries: Vec<Entry<R>>,
    /// Entries before the classification that is being made.
    former: Vec<Entry<R>>,
    /// Number of those that have been classified.
    taken: usize,
    /// Features and numbers of the pair that is being classified; none if its features are not known.
    of_features: Vec<(u32, [R; SLOT_LEN])>,
    /// Numbers of its new points, from the last to the first.
    continued: Vec<[R; SLOT_LEN]>,
    /// Slots at rest with their numbers.
    resting: Vec<(u32, [R; SLOT_LEN])>,
    zeno_fallback: ZenoFallback,
    /// True if there are slots at all.
    has_slots: bool,
}

impl<R: Real> WarmStart<R> {
    /// Nothing kept yet, for a mechanism with `n_slots` contacts and limits.
    #[must_use]
    pub fn new(n_slots: usize) -> Self {
        let usual = n_slots.min(RESERVED_SLOTS);
        Self {
            entries: Vec::with_capacity(usual),
            former: Vec::with_capacity(usual),
            taken: 0,
            of_features: Vec::new(),
            continued: Vec::new(),
            resting: Vec::with_capacity(usual),
            zeno_fallback: ZenoFallback::default(),
            has_slots: n_slots > 0,
        }
    }

    fn entry(&self, slot: usize) -> Option<&Entry<R>> {
        let k = self.entries.binary_search_by_key(&slot, |entry| entry.slot as usize).ok()?;
        Some(&self.entries[k])
    }

    fn entry_mut(&mut self, slot: usize) -> &mut Entry<R> {
        match self.entries.binary_search_by_key(&slot, |entry| entry.slot as usize) {
            Ok(k) => &mut self.entries[k],
            Err(k) => {
                self.entries.insert(k, Entry::new(slot));
                &mut self.entries[k]
            }
        }
    }

    /// Takes over which slots are closed and which of their groups slide, and in which directions.
    pub fn take_modes(&mut self, other: &WarmStart<f64>) {
        for entry in &mut self.entries {
            (entry.closed, entry.is_sliding, entry.directions) = (false, [false; 3], [[R::zero(); 2]; 3]);
        }
        for theirs in &other.entries {
            let own = self.entry_mut(theirs.slot as usize);
            (own.closed, own.is_sliding) = (theirs.closed, theirs.is_sliding);
            own.directions = theirs.directions.map(|direction| direction.map(R::splat));
        }
    }

    /// Takes multipliers and modes from a state; they are those that the motion came with.
    pub fn load(&mut self, numbers: &[R]) {
        for entry in &mut self.entries {
            (entry.numbers, entry.start) = ([R::zero(); SLOT_LEN], [R::zero(); SLOT_LEN]);
        }
        self.zeno_fallback = ZenoFallback::default();
        let Some((fallback, records)) = numbers.split_first() else { return };
        let number = fallback.lane(0) as u32;
        self.zeno_fallback = ZenoFallback { pause: number / 256, left: number % 256 };
        for record in records.chunks_exact(RECORD_LEN) {
            let entry = self.entry_mut(record[0].lane(0) as usize);
            entry.numbers.copy_from_slice(&record[1..]);
            entry.start = entry.numbers;
        }
    }

    /// Writes what belongs to the state: the fallback, then the slots that have been solved, each with its numbers;
    /// nothing where there are no slots.
    pub fn store(&self, numbers: &mut Vec<R>) {
        numbers.clear();
        if !self.has_slots {
            return;
        }
        let ZenoFallback { pause, left } = self.zeno_fallback;
        numbers.push(R::splat(f64::from(256 * pause + left)));
        for entry in self.entries.iter().filter(|entry| entry.numbers.iter().any(|x| *x != R::zero())) {
            numbers.push(R::splat(f64::from(entry.slot)));
            numbers.extend_from_slice(&entry.numbers);
        }
    }

    /// Forgets the modes that the motion came with: those of a step at velocity level are no modes of forces.
    pub fn forget_start(&mut self) {
        self.entries.iter_mut().for_each(|entry| entry.start = [R::zero(); SLOT_LEN]);
    }

    /// Fallback for Zeno behaviour, part of the state.
    pub fn zeno_fallback(&self) -> ZenoFallback {
        self.zeno_fallback
    }

    /// Sets the fallback for Zeno behaviour.
    pub fn set_zeno_fallback(&mut self, zeno_fallback: ZenoFallback) {
        if self.has_slots {
            self.zeno_fallback = zeno_fallback;
        }
    }

    /// Returns true if a slot was last classified as closed.
    pub fn is_closed(&self, slot: usize) -> bool {
        self.entry(slot).is_some_and(|entry| entry.closed)
    }

    /// Returns true if the slot has no force in the modes of the start of the sub-step.
    pub fn starts_open(&self, slot: usize) -> bool {
        self.entry(slot).is_some_and(|entry| is_open(code(&entry.start)))
    }

    /// Slots that are closed, in increasing order.
    pub fn closed_slots(&self) -> impl Iterator<Item = usize> {
        self.entries.iter().filter(|entry| entry.closed).map(|entry| entry.slot as usize)
    }

    /// Returns true if any slot is closed.
    pub fn has_closed(&self) -> bool {
        self.entries.iter().any(|entry| entry.closed)
    }

    /// Returns true once after a slot has closed.
    pub fn take_new(&mut self, slot: usize) -> bool {
        core::mem::take(&mut self.entry_mut(slot).is_new)
    }

    /// Returns true if a friction group of a slot was last classified as sliding.
    pub fn is_sliding(&self, slot: usize, group: usize) -> bool {
        self.entry(slot).is_some_and(|entry| entry.is_sliding[group])
    }

    /// Direction of the friction of a group of a slot.
    pub fn direction(&self, slot: usize, group: usize) -> [R; 2] {
        self.entry(slot).map_or([R::zero(); 2], |entry| entry.directions[group])
    }

    /// Sets the direction of a sliding group's friction, for its `speed`. Within a sub-step it does not reverse: the
    /// force continues smoothly until the instant of reversal has been located.
    pub fn set_direction(&mut self, slot: usize, group: usize, direction: [R; 2], speed: R) -> [R; 2] {
        let entry = self.entry_mut(slot);
        let start = entry.start_directions[group];
        let along = (direction[0] * start[0] + direction[1] * start[1]).lane(0);
        entry.along_start[group] = along * speed.lane(0);
        let direction = if along < 0.0 { direction.map(|x| -x) } else { direction };
        entry.directions[group] = direction;
        direction
    }

    /// Feature of the first loaded slot of a range, as of the last sweeps; 0 if there is none.
    pub fn feature_among(&self, slots: core::ops::Range<usize>) -> u32 {
        let first = self.entries.partition_point(|entry| (entry.slot as usize) < slots.start);
        let of_range = self.entries[first..].iter().take_while(|entry| (entry.slot as usize) < slots.end);
        of_range.map(|entry| feature(&entry.numbers)).find(|feature| *feature != 0).unwrap_or(0)
    }

    /// Begins a classification of all slots but those that `is_held` says stay as they are.
    pub fn begin_classification(&mut self, is_held: impl Fn(usize) -> bool) {
        core::mem::swap(&mut self.entries, &mut self.former);
        for entry in &mut self.former {
            entry.is_held = is_held(entry.slot as usize);
        }
        self.entries.clear();
        self.continued.clear();
        self.taken = 0;
    }

    /// Goes back to what was known before the classification last made.
    pub fn undo_classification(&mut self) {
        core::mem::swap(&mut self.entries, &mut self.former);
    }

    /// Keeps the numbers of the closed slots that are at rest.
    pub fn keep_resting(&mut self, rests: impl Fn(usize) -> bool) {
        self.resting.clear();
        let closed = self.entries.iter().filter(|entry| entry.closed && rests(entry.slot as usize));
        self.resting.extend(closed.map(|entry| (entry.slot, entry.numbers)));
    }

    /// Returns true if there are slots at rest, all of them closed and with the numbers kept, to the last bit.
    pub fn rests(&self) -> bool {
        let mut entries = self.entries.iter();
        let same = |one: &R, two: &R| one.lane(0).to_bits() == two.lane(0).to_bits();
        let holds = |(slot, numbers): &(u32, [R; SLOT_LEN])| {
            let entry = entries.find(|entry| entry.slot == *slot);
            entry.is_some_and(|entry| entry.closed && entry.numbers.iter().zip(numbers).all(|(x, y)| same(x, y)))
        };
        !self.resting.is_empty() && self.resting.iter().all(holds)
    }

    /// Begins the slots of a pair with the features of its new points in the order of slots. Where the features of the
    /// former points are known, a new point continues the one of the same feature, in whatever slot that was; new and
    /// former points that are left over continue each other in their order, since a corner on an edge is now one
    /// feature, now another.
    pub fn begin_pair(&mut self, slots: core::ops::Range<usize>, features: impl Iterator<Item = u32> + Clone) {
        self.leave_open(slots.start);
        self.of_features.clear();
        self.continued.clear();
        for entry in self.former[self.taken..].iter().take_while(|entry| (entry.slot as usize) < slots.end) {
            let feature = feature(&entry.numbers);
            if feature != 0 {
                self.of_features.push((feature, entry.numbers));
            }
        }
        if self.of_features.is_empty() {
            return;
        }
        let former = &self.of_features;
        let mut left_over = former.iter().filter(|(known, _)| !features.clone().any(|feature| feature == *known));
        for feature in features.clone() {
            let same = former.iter().find(|(known, _)| *known == feature);
            let numbers = same.or_else(|| left_over.next());
            self.continued.push(numbers.map_or([R::zero(); SLOT_LEN], |(_, numbers)| *numbers));
        }
        self.continued.reverse();
    }

    /// Classifies a slot, slots in increasing order; those left out are not closed.
    pub fn classify(&mut self, slot: usize, closed: bool, is_sliding: [bool; 3]) {
        self.leave_open(slot);
        let known = self.former.get(self.taken).filter(|entry| entry.slot as usize == slot);
        self.taken += usize::from(known.is_some());
        let mut entry = known.copied().unwrap_or_else(|| Entry::new(slot));
        if let Some(numbers) = self.continued.pop() {
            entry.numbers = numbers;
        }
        entry.classify(closed, is_sliding);
        self.keep_entry(entry);
    }

    /// Ends a classification.
    pub fn end_classification(&mut self) {
        self.leave_open(usize::MAX);
    }

    /// Classifies the known slots before `slot` as not closed.
    fn leave_open(&mut self, slot: usize) {
        while let Some(entry) = self.former.get(self.taken).filter(|entry| (entry.slot as usize) < slot) {
            let mut entry = *entry;
            self.taken += 1;
            if !entry.is_held {
                entry.classify(false, [false; 3]);
            }
            self.keep_entry(entry);
        }
    }

    fn keep_entry(&mut self, entry: Entry<R>) {
        if !entry.is_idle() {
            self.entries.push(entry);
        }
    }

    /// Restores multipliers and modes of the last solution, or with `holds` the modes of the start of the sub-step.
    pub fn restore(&self, blocks: &mut [UnilateralConstraint<R>], lambda: &mut [R], holds: bool) {
        for block in blocks.iter_mut().filter(|block| !block.is_drive()) {
            let Some(entry) = self.entry(block.slot) else { continue };
            let code = code(if holds { &entry.start } else { &entry.numbers });
            if code == 0 {
                continue;
            }
            let kept = &entry.numbers;
            lambda[block.row] = kept[0];
            block.open = is_open(code) && block.given.is_none();
            for (g, group) in block.groups.iter_mut().enumerate() {
                let Some(group) = group else { continue };
                let first = [1, 3, 5][g];
                lambda[group.row..group.row + group.dim].copy_from_slice(&kept[first..first + group.dim]);
                if group.is_sliding || (code - 1) >> (g + 1) & 1 == 0 {
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
            let kept = &mut self.entry_mut(block.slot).numbers;
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

    /// Adds the features of the contact points to what [`WarmStart::keep`] stored; `feature` gives that of a slot.
    pub fn keep_features(&mut self, feature: impl Fn(usize) -> u32) {
        for entry in self.entries.iter_mut().filter(|entry| entry.closed) {
            let number = &mut entry.numbers[SLOT_LEN - 1];
            *number += R::splat(FEATURE * f64::from(feature(entry.slot as usize)));
        }
    }

    /// Records multipliers and modes at the start of a sub-step.
    pub fn mark_start(&mut self) {
        for entry in &mut self.entries {
            (entry.start, entry.start_directions) = (entry.numbers, entry.directions);
        }
    }

    /// Returns true if a mode differs from the start of the sub-step.
    pub fn has_other_modes(&self) -> bool {
        self.entries.iter().any(|entry| entry.closed && code(&entry.start) != code(&entry.numbers))
    }

    /// Returns true if a mode differs from the start of the last sub-step, and every closed slot had one there.
    pub fn has_left_modes(&self) -> bool {
        self.has_other_modes() && self.entries.iter().all(|entry| !entry.closed || code(&entry.start) != 0)
    }

    /// Keeps the present multipliers and modes while others are looked at.
    pub fn set_aside(&mut self) {
        self.entries.iter_mut().for_each(|entry| entry.decided = entry.numbers);
    }

    /// Goes back to the multipliers and modes that were set aside.
    pub fn take_set_aside(&mut self) {
        self.entries.iter_mut().for_each(|entry| entry.numbers = entry.decided);
    }

    /// Takes the present multipliers and modes for those at the start of the sub-step; directions stay.
    pub fn propose_modes(&mut self) {
        for entry in &mut self.entries {
            (entry.decided, entry.start) = (entry.start, entry.numbers);
            entry.directions = entry.start_directions;
        }
    }

    /// Takes back [`WarmStart::propose_modes`].
    pub fn reject_modes(&mut self) {
        self.entries.iter_mut().for_each(|entry| entry.start = entry.decided);
        self.return_to_start();
    }

    /// Goes back to multipliers and modes at the start of the sub-step.
    pub fn return_to_start(&mut self) {
        for entry in &mut self.entries {
            (entry.numbers, entry.directions) = (entry.start, entry.start_directions);
        }
    }

    /// Returns true if a slot carried a force, or none was needed of it, at the start of the sub-step.
    pub fn was_closed(&self, slot: usize) -> bool {
        self.entry(slot).is_some_and(|entry| entry.closed && code(&entry.start).saturating_sub(1) & 1 == 0)
    }

    /// Returns true if one of `n` slots from `first` on was classified as closed.
    pub fn is_any_closed(&self, first: usize, n: usize) -> bool {
        let from = self.entries.partition_point(|entry| (entry.slot as usize) < first);
        let of_range = self.entries[from..].iter().take_while(|entry| (entry.slot as usize) < first + n);
        of_range.into_iter().any(|entry| entry.closed)
    }

    /// Closed slot and group that slides fastest against its direction at the start of the sub-step.
    pub fn reversal(&self) -> Option<(usize, usize)> {
        let along = |(entry, g): &(&Entry<R>, usize)| entry.along_start[*g];
        let closed = self.entries.iter().filter(|entry| entry.closed);
        closed
            .flat_map(|entry| (0..3).map(move |g| (entry, g)))
            .filter(|(entry, g)| entry.is_sliding[*g] && along(&(*entry, *g)) < 0.0)
            .min_by(|a, b| along(a).total_cmp(&along(b)))
            .map(|(entry, g)| (entry.slot as usize, g))
    }

    /// Sliding velocity of a group along that at the start of the sub-step [m/s] or [rad/s].
    pub fn along_start(&self, slot: usize, group: usize) -> f64 {
        self.entry(slot).map_or(0.0, |entry| entry.along_start[group])
    }
}

/// Code of a slot, without its feature.
fn code<R: Real>(numbers: &[R; SLOT_LEN]) -> u32 {
    (numbers[SLOT_LEN - 1].lane(0) as u64 % FEATURE as u64) as u32
}

/// Returns true if a mode code stands for a slot without force.
fn is_open(code: u32) -> bool {
    code != 0 && (code - 1) & 1 == 1
}

/// Feature of a slot; 0 if it is not known.
fn feature<R: Real>(numbers: &[R; SLOT_LEN]) -> u32 {
    (numbers[SLOT_LEN - 1].lane(0) as u64 / FEATURE as u64) as u32
}
