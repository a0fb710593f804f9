//! Limits of joints and contacts of worlds in lanes: a lane in which none can take part in a step makes it with the
//! others, one in which a limit may be reached or surfaces may touch makes it by itself.
//!
//! The rule is that of [`World`](crate::world::World): a limit or contact which the step may reach at its start, or
//! which it has passed at its end, takes part in it as a constraint. Any other step is that of a world without
//! constraints.

use sincro_math::{Real, Task};

use super::BatchWorld;
use super::lane_worlds::LaneWorlds;
use super::near_pairs::NearPairs;
use crate::integrate::Control;
use crate::mechanism::constraints::ActivationRule;
use crate::mechanism::foresight::passed;
use crate::model::{Limit, Model};
use crate::state::State;
use crate::world::{MethodKind, Stop, World};

/// Limits of joints and contacts of worlds in lanes, and the worlds that make their steps by themselves.
#[derive(Clone, Debug)]
pub(super) struct LaneConstraints<R> {
    limits: Vec<Limit>,
    pairs: Option<NearPairs<R>>,
    /// World of each lane, with the warm start of its constraints.
    alone: Vec<World>,
    /// False for lanes that no world has been put into: they make no steps alone.
    is_used: Vec<bool>,
    /// Strongest gravity [m/s²].
    gravity: R,
    /// Unknowns, coordinates and modes of drives at the start of the step.
    start: [Vec<R>; 3],
    /// 1 for each lane whose step is made alone.
    is_alone: R,
    /// Number of steps that each lane has made alone.
    pub n_alone: Vec<u64>,
    /// Reason for which the step of a lane could not be made.
    pub stops: Vec<Option<Stop>>,
}

impl<R: Real> LaneConstraints<R> {
    /// Constraints of `models`, the last of which fills the remaining lanes; `None` if they have none.
    pub fn new(models: &[&Model<f64>], dim: usize) -> Option<Self> {
        let first = models[0];
        let set = first.constraints();
        if R::IS_SCALAR || set.is_empty() {
            return None;
        }
        let of = |k: usize| models[k.min(models.len() - 1)];
        // a step of its own length each time
        let control = Control::new(1.0, 1.0);
        let world = |k: usize| {
            let (model, state) = (of(k).clone(), State::new(of(k)));
            World::with_totals(model, state, MethodKind::SemiImplicitEuler, control, false)
        };
        let zeros = |n: usize| vec![R::zero(); n];
        Some(Self {
            limits: set.limits.clone(),
            pairs: NearPairs::new(set, first.n_v()),
            alone: (0..R::LANES).map(world).collect(),
            is_used: vec![false; R::LANES],
            gravity: R::from_lanes(|k| of(k).strongest_gravity(&[])),
            start: [zeros(dim), zeros(first.n_q()), zeros(first.n_drives())],
            is_alone: R::zero(),
            n_alone: vec![0; R::LANES],
            stops: vec![None; R::LANES],
        })
    }

    /// Begins a run of the worlds of a batch.
    pub fn load(&mut self, worlds: &[BatchWorld]) {
        self.is_used.fill(false);
        for (k, world) in worlds.iter().enumerate() {
            self.put(k, &world.state);
            self.n_alone[k] = 0;
        }
    }

    /// Puts a world into lane `k`.
    fn put(&mut self, k: usize, state: &State<f64>) {
        self.alone[k].state.clone_from(state);
        (self.is_used[k], self.stops[k]) = (true, None);
    }

    /// Warm start of the constraints of lane `k`.
    pub fn contacts(&self, k: usize) -> &Vec<f64> {
        &self.alone[k].state.contacts
    }

    /// Notes in the worlds of a batch which of them cannot go on, and which steps were made alone.
    pub fn note(&mut self, worlds: &mut [BatchWorld]) {
        for (k, world) in worlds.iter_mut().enumerate().filter(|(_, world)| world.stop.is_none()) {
            world.steps_alone += core::mem::take(&mut self.n_alone[k]);
            world.stop = self.stops[k];
            if world.stop.is_some() {
                let tick = world.state.tick;
                world.state.clone_from(&self.alone[k].state);
                world.state.tick = tick;
            }
        }
    }
}

/// Looks for the lanes whose limits and contacts the step of length `h` may reach at its start, or may have passed at
/// its end.
struct Look<'a, R> {
    worlds: &'a mut LaneWorlds<R>,
    constraints: &'a mut LaneConstraints<R>,
    h: f64,
    is_end: bool,
}

impl<R: Real> Task for Look<'_, R> {
    type Output = ();

    #[inline(always)]
    fn run(self) {
        let Self { worlds, constraints, h, is_end } = self;
        let gravity = constraints.gravity;
        let (q, v) = (worlds.coordinates(), worlds.velocities());
        let (zero, one) = (R::zero(), R::one());
        let mut is_alone = if is_end { constraints.is_alone } else { zero };
        let passed = passed(h, gravity);
        for limit in &constraints.limits {
            let sign = R::splat(limit.sign);
            let distance = sign * (q[limit.coordinate] - R::splat(limit.bound));
            let rate = sign * v[limit.dof];
            let takes_part = if is_end {
                distance.if_less(passed, rate.if_less(zero, one, zero), zero)
            } else {
                ActivationRule::reach(h, rate, gravity).if_less(distance, zero, one)
            };
            is_alone = is_alone.max(takes_part);
        }
        if let Some(pairs) = &mut constraints.pairs {
            // the velocities at the end, in the positions at the start
            let [_, base, _] = &constraints.start;
            let velocities = worlds.mechanism.layout().velocities();
            let LaneWorlds { mechanism, y, .. } = worlds;
            is_alone = is_alone.max(pairs.find(mechanism, (base, &y[velocities]), (h, gravity), is_end));
        }
        constraints.is_alone = is_alone;
    }
}

impl<R: Real> LaneWorlds<R> {
    /// Makes one step of length `h` `[s]` from time `t` `[s]` in all lanes beside their constraints; `step` makes it
    /// as if there were none.
    pub(super) fn step_beside_constraints(&mut self, t: f64, h: f64, step: impl FnOnce(&mut Self)) {
        let Some(mut constraints) = self.constraints.take() else { return };
        let [y, base, drives] = &mut constraints.start;
        y.copy_from_slice(&self.y);
        base.copy_from_slice(self.mechanism.base());
        drives.copy_from_slice(&self.mechanism.drives);
        R::run_hot(Look { worlds: self, constraints: &mut constraints, h, is_end: false });
        if (0..R::LANES).any(|k| constraints.is_alone.lane(k) < 0.5) {
            step(self);
            R::run_hot(Look { worlds: self, constraints: &mut constraints, h, is_end: true });
        }
        for k in 0..R::LANES {
            if !constraints.is_used[k] || constraints.stops[k].is_some() {
                continue;
            }
            if constraints.is_alone.lane(k) > 0.5 {
                self.step_alone(&mut constraints, k, (t, h));
            } else {
                // no constraint is loaded
                constraints.alone[k].state.contacts.clear();
                constraints.alone[k].state.contacts.push(0.0);
            }
        }
        self.constraints = Some(constraints);
    }

    /// Makes the step of lane `k` from its start by itself.
    fn step_alone(&mut self, constraints: &mut LaneConstraints<R>, k: usize, (t, h): (f64, f64)) {
        let LaneConstraints { alone, start: [y, base, drives], stops, n_alone, .. } = constraints;
        let world = &mut alone[k];
        self.store_lane(k, [base, y, drives], &mut world.state);
        stops[k] = world.advance(t, h).err().map(|(_, stop)| stop);
        self.set_numbers(k, &world.state);
        if stops[k].is_none() {
            n_alone[k] += 1;
            return;
        }
        // whoever looks sees that it cannot go on
        for v in &mut self.y[self.mechanism.layout().velocities()] {
            *v = v.with_lane(k, f64::NAN);
        }
    }

    /// Puts lane `k` into a state; its commands stay. Nothing for a `k` beyond the last lane.
    pub(super) fn set_lane(&mut self, k: usize, state: &State<f64>) {
        if k >= R::LANES {
            return;
        }
        self.set_numbers(k, state);
        if let Some(constraints) = &mut self.constraints {
            constraints.put(k, state);
        }
    }

    /// Sets coordinates, velocities, rotor states and modes of drives of lane `k`.
    fn set_numbers(&mut self, k: usize, state: &State<f64>) {
        let layout = self.mechanism.layout();
        let with = |old: &mut R, new: f64| *old = old.with_lane(k, new);
        self.mechanism.base_mut().iter_mut().zip(&state.q).for_each(|(old, new)| with(old, *new));
        self.mechanism.drives.iter_mut().zip(&state.drives).for_each(|(old, new)| with(old, *new));
        self.y[layout.displacement()].iter_mut().for_each(|old| with(old, 0.0));
        self.y[layout.velocities()].iter_mut().zip(&state.v).for_each(|(old, new)| with(old, *new));
        self.y[layout.rotor_states()].iter_mut().zip(&state.rotors).for_each(|(old, new)| with(old, *new));
    }
}
