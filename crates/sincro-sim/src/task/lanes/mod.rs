//! A bundle of worlds in lanes, with the diagrams and sensors of each.

mod diagrams;
mod measured;
mod sensors;

use sincro_blocks::runner::State as DiagramState;
use sincro_dynamics::batch::{LaneObserver, SteppedLanes};
use sincro_dynamics::coupled::StateView;
use sincro_dynamics::state::State;
use sincro_math::Real;

use diagrams::LaneDiagrams;
pub(super) use diagrams::SharedBlocks;
use measured::Measured;
use sensors::LaneSensors;

use super::plan::{Drawn, Plan};
use sincro_scene::record::Probe;
use sincro_scene::record::probe::View;

/// Worlds side by side, made when the first of them is placed.
#[derive(Debug)]
pub(super) struct LaneBundle {
    lanes: Option<SteppedLanes>,
    /// Base steps of each world since the start of its episode.
    ticks: Vec<u64>,
    /// False for each world of which a block gave what is not finite.
    is_good: Vec<bool>,
    diagrams: Option<LaneDiagrams>,
    sensors: Option<LaneSensors>,
}

impl LaneBundle {
    /// `n_worlds` worlds before their first episode.
    pub fn new(plan: &Plan, n_worlds: usize) -> Self {
        Self {
            lanes: None,
            ticks: vec![0; n_worlds],
            is_good: vec![true; n_worlds],
            diagrams: LaneDiagrams::new(plan, n_worlds),
            sensors: LaneSensors::new(plan, n_worlds),
        }
    }

    /// Puts a world into a state; its diagram, sensors and clock stay.
    pub fn place(&mut self, plan: &Plan, lane: usize, state: &State<f64>) {
        self.lanes(plan).set_lane(lane, state);
    }

    /// Begins an episode of a world, up to its first samples and the evaluation of its diagram: [`LaneBundle::start`].
    pub fn begin(&mut self, plan: &Plan, lane: usize, drawn: &Drawn) {
        self.place(plan, lane, &plan.with_drawn(&plan.start, &drawn.state));
        (self.ticks[lane], self.is_good[lane]) = (0, true);
        if let Some(sensors) = &mut self.sensors {
            sensors.begin(lane, drawn.noise_seed);
        }
        if let Some(diagrams) = &mut self.diagrams {
            diagrams.begin(lane);
        }
    }

    /// Takes the blocks of diagrams that the bundles of a thread share, or gives them back: it needs them to start and
    /// to advance.
    pub fn exchange_blocks(&mut self, shared: &mut Option<SharedBlocks>) {
        if let (Some(diagrams), Some(shared)) = (&mut self.diagrams, shared) {
            diagrams.exchange_blocks(shared);
        }
    }

    /// Starts the episodes that have begun in the worlds of a mask, all worlds under commands (`lane × command`).
    pub fn start(&mut self, plan: &Plan, commands: &mut [f64], mask: &[bool]) {
        self.lanes(plan).set_commands(commands);
        self.measure(plan, |lane| mask[lane]);
        if let Some(diagrams) = self.diagrams.as_mut().filter(|diagrams| diagrams.is_continuous()) {
            diagrams.write_outputs(mask, commands);
            self.lanes(plan).set_commands(commands);
        }
    }

    /// Advances all worlds but those that `is_over` by one action's period under commands (`lane × command`), among
    /// which those that diagrams and signals of the scene give are set.
    pub fn advance(&mut self, plan: &Plan, commands: &mut [f64], is_over: &[bool]) {
        let kept = is_over.contains(&true).then(|| {
            let mut rows = vec![0.0; plan.n_state() * sincro_math::lanes::width()];
            self.copy_state(plan, &mut rows);
            rows
        });
        let mut left = plan.task.ticks;
        while left > 0 {
            self.latch(plan, commands, is_over);
            let n_steps = self.steps_to_samples(plan, is_over, left);
            self.lanes(plan).set_commands(commands);
            match self {
                Self { lanes: Some(lanes), ticks, diagrams: Some(diagrams), .. } if diagrams.is_continuous() => {
                    diagrams.advance(lanes, ticks, is_over, commands);
                    lanes.set_commands(commands);
                }
                _ => self.lanes(plan).advance(plan.loaded.experiment.step, n_steps),
            }
            for (tick, is_over) in self.ticks.iter_mut().zip(is_over) {
                *tick += if *is_over { 0 } else { n_steps };
            }
            self.measure(plan, |lane| !is_over[lane]);
            left -= n_steps;
        }
        let Some(kept) = kept else { return };
        let mut state = plan.loaded.scene.initial.clone();
        for lane in (0..is_over.len()).filter(|lane| is_over[*lane]) {
            let numbers = state.q.iter_mut().chain(&mut state.v).chain(&mut state.rotors);
            numbers.zip(kept.iter().skip(lane).step_by(sincro_math::lanes::width())).for_each(|(to, x)| *to = *x);
            self.place(plan, lane, &state);
        }
    }

    /// Number of base steps, `left` at most, until something acts or samples are taken that anyone sees.
    fn steps_to_samples(&self, plan: &Plan, is_over: &[bool], left: u64) -> u64 {
        if self.diagrams.is_some() || !plan.varying_commands.is_empty() {
            return 1;
        }
        let Some(sensors) = &self.sensors else { return left };
        let under_way = self.ticks.iter().zip(is_over).filter(|(_, is_over)| !**is_over);
        under_way.map(|(tick, _)| sensors.steps_to_sample(*tick, left)).min().unwrap_or(left)
    }

    /// Commands of signals of the scene and of diagrams for the step that begins; those of worlds that are over stay.
    fn latch(&mut self, plan: &Plan, commands: &mut [f64], is_over: &[bool]) {
        if self.diagrams.is_none() && plan.varying_commands.is_empty() {
            return;
        }
        let n = plan.n_commands();
        for lane in (0..is_over.len()).filter(|lane| !is_over[*lane]) {
            let (tick, commands) = (self.ticks[lane], &mut commands[lane * n..(lane + 1) * n]);
            let t = tick as f64 * plan.loaded.experiment.step;
            for command in &plan.varying_commands {
                commands[*command] = plan.loaded.scene.commands[*command].value(t);
            }
        }
        if let Some(diagrams) = &mut self.diagrams {
            diagrams.latch(&self.ticks, is_over, commands);
        }
    }

    /// Takes the samples that are due and evaluates the diagrams, in the worlds that `is_active`.
    fn measure(&mut self, plan: &Plan, is_active: impl Fn(usize) -> bool) {
        self.lanes(plan);
        let Self { lanes: Some(lanes), ticks, is_good, diagrams, sensors } = self else { return };
        if let Some(sensors) = sensors {
            sensors.sample(lanes, ticks, |lane| is_active(lane) && is_good[lane]);
        }
        let Some(diagrams) = diagrams else { return };
        diagrams.evaluate((lanes, sensors.as_ref()), ticks, is_active, is_good);
    }

    /// Signals of all worlds, `lane × signal`, and if each world can go on.
    pub fn observe(&mut self, plan: &Plan, signals: &mut [f64], is_finite: &mut [bool]) {
        let probes = &plan.probes;
        self.lanes(plan).observe(plan.needs_kinematics, Observation { probes, signals, is_finite });
        if self.diagrams.is_none() && self.sensors.is_none() {
            return;
        }
        for (i, probe) in probes.iter().enumerate() {
            match (*probe, &mut self.diagrams, &self.sensors) {
                (Probe::Signal(k), Some(diagrams), _) => diagrams.copy_signal(k, &mut signals[i..], probes.len()),
                (Probe::Sensor(k), _, Some(sensors)) => {
                    for (lane, signals) in signals.chunks_exact_mut(probes.len()).enumerate() {
                        signals[i] = sensors.values(lane)[k];
                    }
                }
                _ => {}
            }
        }
        for (lane, is_finite) in is_finite.iter_mut().enumerate() {
            let of_lane = &signals[lane * probes.len()..(lane + 1) * probes.len()];
            *is_finite &= self.is_good[lane] && of_lane.iter().all(|x| x.is_finite());
        }
    }

    /// State of the diagram of a world; none if there is no diagram.
    pub fn diagram(&mut self, lane: usize) -> Option<DiagramState<f64>> {
        self.diagrams.as_mut().map(|diagrams| diagrams.state(lane))
    }

    /// Puts a world into the state in which its episode is at tick `tick`, its diagram into that which `set` makes.
    pub fn resume(
        &mut self,
        plan: &Plan,
        lane: usize,
        tick: u64,
        state: &State<f64>,
        set: impl FnOnce(&mut DiagramState<f64>),
    ) {
        self.place(plan, lane, state);
        (self.ticks[lane], self.is_good[lane]) = (tick, true);
        if let Some(diagrams) = &mut self.diagrams {
            diagrams.resume(lane, set);
        }
    }

    /// Sets the commands of all worlds (`lane × command`).
    pub fn set_commands(&mut self, plan: &Plan, commands: &[f64]) {
        self.lanes(plan).set_commands(commands);
    }

    /// Copies coordinates, velocities and rotor states of all worlds, row by row.
    pub fn copy_state(&mut self, plan: &Plan, rows: &mut [f64]) {
        self.lanes(plan).observe(false, StateRows { rows });
    }

    /// Number of base steps that the worlds have made by themselves.
    pub fn steps_alone(&mut self) -> u64 {
        self.lanes.as_mut().map_or(0, SteppedLanes::steps_alone)
    }

    /// Coordinates of one world.
    pub fn coordinates(&mut self, plan: &Plan, lane: usize) -> Vec<f64> {
        self.lanes(plan).observe(false, Coordinates { lane })
    }

    fn lanes(&mut self, plan: &Plan) -> &mut SteppedLanes {
        self.lanes.get_or_insert_with(|| {
            let controller = plan.loaded.controller.as_ref();
            let n_states = controller.map_or(0, |controller| controller.wiring.program().n_states);
            let mut made = SteppedLanes::with_coupled_states(&[&plan.loaded.scene.model], plan.method, n_states)
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
        let mut measured = Measured::new(&view);
        for (i, probe) in probes.iter().enumerate() {
            let value = match *probe {
                Probe::Command(k) => view.commands[k],
                // written by the bundle
                Probe::Signal(_) | Probe::Sensor(_) => continue,
                probe => measured.value(probe).expect("the plan refuses other signals"),
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
