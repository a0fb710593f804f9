//! A bundle of worlds in lanes.

use std::any::Any;
use std::fmt;

use sincro_dynamics::batch::SteppedLanes;
use sincro_math::Real;
use sincro_math::lanes::{LaneVisitor, dispatch_lanes};

use super::plan::{Drawn, Plan};
use sincro_scene::record::Probe;
use sincro_scene::record::probe::{View, of_state};

/// Worlds side by side; their type is that of this processor's lanes, which only the dispatch can name.
pub(super) struct LaneBundle {
    /// A `SteppedLanes<R>`, once it was needed.
    lanes: Option<Box<dyn Any + Send>>,
}

impl fmt::Debug for LaneBundle {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("LaneBundle")
    }
}

impl LaneBundle {
    pub fn new() -> Self {
        Self { lanes: None }
    }

    /// Puts the worlds of a mask into the states that were drawn for them.
    pub fn place(&mut self, plan: &Plan, drawn: &[Drawn], mask: &[bool]) {
        dispatch_lanes(Place { bundle: self, plan, drawn, mask });
    }

    /// Advances all worlds by one action's period under commands (`lane × command`).
    pub fn advance(&mut self, plan: &Plan, commands: &[f64], n_worlds: usize) {
        dispatch_lanes(Advance { bundle: self, plan, commands, n_worlds });
    }

    /// Signals of all worlds, `lane × signal`, and if each is finite.
    pub fn observe(&mut self, plan: &Plan, n_worlds: usize, signals: &mut [f64], is_finite: &mut [bool]) {
        dispatch_lanes(Observe { bundle: self, plan, n_worlds, signals, is_finite });
    }

    /// Coordinates of one world.
    pub fn coordinates(&mut self, plan: &Plan, lane: usize) -> Vec<f64> {
        dispatch_lanes(Coordinates { bundle: self, plan, lane })
    }

    fn lanes<R: Real>(&mut self, plan: &Plan) -> &mut SteppedLanes<R> {
        let make = || {
            let mut made = SteppedLanes::<R>::new(&[&plan.loaded.scene.model], plan.method)
                .expect("the plan refuses lanes where they cannot be");
            for (command, signal) in made.commands().iter_mut().zip(&plan.loaded.scene.commands) {
                *command = R::splat(signal.value(0.0));
            }
            Box::new(made) as Box<dyn Any + Send>
        };
        let lanes = self.lanes.get_or_insert_with(make);
        lanes.downcast_mut().expect("the dispatch takes the same lanes each time")
    }
}

struct Place<'a> {
    bundle: &'a mut LaneBundle,
    plan: &'a Plan,
    drawn: &'a [Drawn],
    mask: &'a [bool],
}

impl LaneVisitor for Place<'_> {
    type Output = ();

    #[inline(always)]
    fn visit<R: Real>(self) {
        let lanes = self.bundle.lanes::<R>(self.plan);
        for lane in (0..self.drawn.len()).filter(|lane| self.mask[*lane]) {
            lanes.set_lane(lane, &self.drawn[lane].state);
        }
    }
}

struct Advance<'a> {
    bundle: &'a mut LaneBundle,
    plan: &'a Plan,
    commands: &'a [f64],
    n_worlds: usize,
}

impl LaneVisitor for Advance<'_> {
    type Output = ();

    #[inline(always)]
    fn visit<R: Real>(self) {
        let Self { bundle, plan, commands, n_worlds } = self;
        let lanes = bundle.lanes::<R>(plan);
        let n = plan.loaded.scene.commands.len();
        for (k, command) in lanes.commands().iter_mut().enumerate() {
            *command = R::from_lanes(|lane| commands[lane.min(n_worlds - 1) * n + k]);
        }
        let h = plan.loaded.experiment.step;
        for _ in 0..plan.task.ticks {
            lanes.step(h);
        }
    }
}

struct Observe<'a> {
    bundle: &'a mut LaneBundle,
    plan: &'a Plan,
    n_worlds: usize,
    signals: &'a mut [f64],
    is_finite: &'a mut [bool],
}

impl LaneVisitor for Observe<'_> {
    type Output = ();

    #[inline(always)]
    fn visit<R: Real>(self) {
        let Self { bundle, plan, n_worlds, signals, is_finite } = self;
        let lanes = bundle.lanes::<R>(plan);
        let n = plan.probes.len();
        let seen = lanes.view(plan.needs_kinematics);
        let view = View::of(&seen);
        // 0·x is 0, or NaN where x is not finite
        let mut probe_of_all = R::zero();
        for x in view.q.iter().chain(view.v).chain(view.rotors) {
            probe_of_all += R::zero() * *x;
        }
        for (i, probe) in plan.probes.iter().enumerate() {
            let value = match *probe {
                Probe::Command(k) => view.commands[k],
                probe => of_state(&view, probe).expect("the plan refuses other signals"),
            };
            for lane in 0..n_worlds {
                signals[lane * n + i] = value.lane(lane);
            }
        }
        for (lane, is_finite) in is_finite.iter_mut().enumerate().take(n_worlds) {
            *is_finite = probe_of_all.lane(lane).is_finite();
        }
    }
}

struct Coordinates<'a> {
    bundle: &'a mut LaneBundle,
    plan: &'a Plan,
    lane: usize,
}

impl LaneVisitor for Coordinates<'_> {
    type Output = Vec<f64>;

    #[inline(always)]
    fn visit<R: Real>(self) -> Vec<f64> {
        let Self { bundle, plan, lane } = self;
        bundle.lanes::<R>(plan).view(false).q.iter().map(|q| q.lane(lane)).collect()
    }
}
