//! A bundle of worlds in lanes.

use sincro_dynamics::batch::{LaneObserver, SteppedLanes};
use sincro_dynamics::coupled::StateView;
use sincro_dynamics::state::State;
use sincro_math::Real;

use super::plan::Plan;
use sincro_scene::record::Probe;
use sincro_scene::record::probe::{View, of_state};

/// Worlds side by side, made when the first of them is placed.
#[derive(Debug, Default)]
pub(super) struct LaneBundle {
    lanes: Option<SteppedLanes>,
}

impl LaneBundle {
    /// Puts a world into a state.
    pub fn place(&mut self, plan: &Plan, lane: usize, state: &State<f64>) {
        self.lanes(plan).set_lane(lane, state);
    }

    /// Advances all worlds but those that `is_over` by one action's period under commands (`lane × command`).
    pub fn advance(&mut self, plan: &Plan, commands: &[f64], is_over: &[bool]) {
        let kept = is_over.contains(&true).then(|| {
            let mut rows = vec![0.0; plan.n_state() * sincro_math::lanes::width()];
            self.copy_state(plan, &mut rows);
            rows
        });
        let lanes = self.lanes(plan);
        lanes.set_commands(commands);
        lanes.advance(plan.loaded.experiment.step, plan.task.ticks);
        let Some(kept) = kept else { return };
        let mut state = plan.loaded.scene.initial.clone();
        for lane in (0..is_over.len()).filter(|lane| is_over[*lane]) {
            let numbers = state.q.iter_mut().chain(&mut state.v).chain(&mut state.rotors);
            numbers.zip(kept.iter().skip(lane).step_by(sincro_math::lanes::width())).for_each(|(to, x)| *to = *x);
            self.place(plan, lane, &state);
        }
    }

    /// Signals of all worlds, `lane × signal`, and if each is finite.
    pub fn observe(&mut self, plan: &Plan, signals: &mut [f64], is_finite: &mut [bool]) {
        let probes = &plan.probes;
        self.lanes(plan).observe(plan.needs_kinematics, Observation { probes, signals, is_finite });
    }

    /// Sets the commands of all worlds (`lane × command`).
    pub fn set_commands(&mut self, plan: &Plan, commands: &[f64]) {
        self.lanes(plan).set_commands(commands);
    }

    /// Copies coordinates, velocities and rotor states of all worlds, row by row.
    pub fn copy_state(&mut self, plan: &Plan, rows: &mut [f64]) {
        self.lanes(plan).observe(false, StateRows { rows });
    }

    /// Coordinates of one world.
    pub fn coordinates(&mut self, plan: &Plan, lane: usize) -> Vec<f64> {
        self.lanes(plan).observe(false, Coordinates { lane })
    }

    fn lanes(&mut self, plan: &Plan) -> &mut SteppedLanes {
        self.lanes.get_or_insert_with(|| {
            let mut made = SteppedLanes::new(&[&plan.loaded.scene.model], plan.method)
                .expect("the plan refuses lanes where they cannot be");
            made.set_commands(&plan.loaded.scene.initial.commands);
            made
        })
    }
}

struct Observation<'a> {
    probes: &'a [Probe],
    signals: &'a mut [f64],
    is_finite: &'a mut [bool],
}

impl LaneObserver for Observation<'_> {
    type Output = ();

    #[inline(always)]
    fn observe<R: Real>(self, seen: &StateView<'_, R>) {
        let Self { probes, signals, is_finite } = self;
        let view = View::of(seen);
        // 0·x is 0, or NaN where x is not finite
        let mut probe_of_all = R::zero();
        for x in view.q.iter().chain(view.v).chain(view.rotors) {
            probe_of_all += R::zero() * *x;
        }
        for (i, probe) in probes.iter().enumerate() {
            let value = match *probe {
                Probe::Command(k) => view.commands[k],
                probe => of_state(&view, probe).expect("the plan refuses other signals"),
            };
            for lane in 0..is_finite.len() {
                signals[lane * probes.len() + i] = value.lane(lane);
            }
        }
        for (lane, is_finite) in is_finite.iter_mut().enumerate() {
            *is_finite = probe_of_all.lane(lane).is_finite();
        }
    }
}

struct Coordinates {
    lane: usize,
}

impl LaneObserver for Coordinates {
    type Output = Vec<f64>;

    #[inline(always)]
    fn observe<R: Real>(self, view: &StateView<'_, R>) -> Vec<f64> {
        view.q.iter().map(|q| q.lane(self.lane)).collect()
    }
}

struct StateRows<'a> {
    rows: &'a mut [f64],
}

impl LaneObserver for StateRows<'_> {
    type Output = ();

    #[inline(always)]
    fn observe<R: Real>(self, view: &StateView<'_, R>) {
        let numbers = view.q.iter().chain(view.v).chain(view.rotors);
        for (row, x) in self.rows.chunks_exact_mut(R::LANES).zip(numbers) {
            x.to_row(row);
        }
    }
}
