//! Subjects of the timing: each figure as something that can be called again and again.
//!
//! States go back to their start every simulated second, so that they stay finite. A method that diverges even so is
//! timed at a tenth of the step, or a hundredth …, and says so: the work is the same, and huge angles would make sine
//! and cosine slow.

use std::hint::black_box;

use sincro_dynamics::aba;
use sincro_dynamics::batch::{self, BatchSettings, BatchWorld};
use sincro_dynamics::constraint::SLOT_LEN;
use sincro_dynamics::integrate::Control;
use sincro_dynamics::model::Model;
use sincro_dynamics::scratch::Scratch;
use sincro_dynamics::state::State;
use sincro_dynamics::world::{MethodKind, World};
use sincro_scene::camera::{Lens, NO_PIECE, Optics};
use sincro_scene::experiment::{ErrorBar, Experiment, Integrator};
use sincro_scene::scene::{Camera, ObjectKind, Scene};
use sincro_sim::rollout::{Compile, Rollout, StepsBy};
use sincro_sim::run::choose_method;

use super::clock::Subject;
use super::models;

/// The step of every figure `[s]`.
pub(super) const STEP: f64 = 0.005;
/// Steps in a simulated second.
pub(super) const STEPS_A_SECOND: u32 = 200;
/// Worlds of a batch.
pub(super) const WORLDS: usize = 256;
/// Tolerance of an experiment that names none.
const DEFAULT_ACCURACY: f64 = 1e-9;

/// An experiment that leaves everything to sincro.
pub(super) fn default_experiment(step: f64, duration: f64) -> Experiment {
    Experiment {
        title: String::new(),
        description: String::new(),
        scene_path: "scene.toml".into(),
        duration,
        step,
        n_steps: (duration / step).round() as u64,
        simulation_ticks: 1,
        record_every: 1,
        integrator: Integrator::Auto,
        accuracy: DEFAULT_ACCURACY,
        error_bar: ErrorBar::None,
        seed: 0,
        record: Vec::new(),
        units: Default::default(),
        parameters: Default::default(),
        stops: Vec::new(),
        checks: Vec::new(),
        sweep: None,
        variants: Vec::new(),
        plots: Vec::new(),
        task: None,
    }
}

/// The method that sincro chooses for a scene at the step of the figures.
pub(super) fn default_method(scene: &Scene) -> MethodKind {
    choose_method(scene, &default_experiment(STEP, 1.0)).0
}

/// Picture of the robot at its start by a camera beside it: colours, depths and bodies.
pub(super) fn picture(scene: &Scene) -> Subject {
    let lens = Lens::Perspective(38_f64.to_radians());
    let optics = Optics { resolution: [256, 256], near: 0.01, far: 100.0, lens };
    let camera = Camera::looking_at(scene, optics, [1.6, -2.6, 1.6], [0.0, 0.0, 0.7]);
    let (mut camera, q) = (camera.expect("it stands beside the robot"), scene.initial.q.clone());
    let seen = camera.render(&q).pieces().iter().filter(|piece| **piece != NO_PIECE).count();
    let note = format!("{seen} of 65536 pixels show something");
    Subject::new(move || {
        black_box(camera.render(black_box(&q)));
    })
    .with_note(note)
}

/// A world at the scene's start.
pub(super) fn world(scene: &Scene, method: MethodKind, accuracy: f64, totals: bool) -> World {
    let control = Control::new(accuracy, (STEP * 0.1).min(1e-3));
    let mut world = World::with_totals((*scene.model).clone(), scene.initial.clone(), method, control, totals);
    world.initialize(0.0);
    world
}

/// A world that steps, and starts over every simulated second.
pub(super) struct Stepper {
    world: World,
    start: State<f64>,
    control: Option<Control>,
    step: f64,
    tick: u32,
}

impl Stepper {
    pub fn new(scene: &Scene, method: MethodKind, totals: bool) -> Self {
        let world = world(scene, method, DEFAULT_ACCURACY, totals);
        let (start, control) = (world.state.clone(), world.control());
        let mut stepper = Self { world, start, control, step: STEP, tick: 0 };
        while !stepper.survives() && stepper.step > 1e-6 {
            stepper.step /= 10.0;
        }
        stepper.restart();
        stepper
    }

    /// Calls `prepare` with the world and its step `[s]`.
    #[cfg(feature = "jit")]
    pub fn prepared(mut self, prepare: impl FnOnce(&mut World, f64)) -> Self {
        prepare(&mut self.world, self.step);
        self
    }

    /// Returns true if a round of steps stays within anything physical.
    fn survives(&mut self) -> bool {
        self.restart();
        (0..STEPS_A_SECOND).all(|_| self.advance()) && self.world.state.v.iter().all(|v| v.abs() < 1e6)
    }

    fn restart(&mut self) {
        self.tick = 0;
        restore(&mut self.world.state, &self.start);
        if let Some(control) = self.control {
            self.world.set_control(control);
        }
    }

    #[inline]
    fn advance(&mut self) -> bool {
        let t = f64::from(self.tick) * self.step;
        self.tick += 1;
        self.world.advance(t, self.step).is_ok()
    }

    #[inline]
    fn call(&mut self) {
        if self.tick == STEPS_A_SECOND {
            self.restart();
        }
        if !black_box(self.advance()) {
            self.restart();
        }
    }

    fn note(&mut self) -> String {
        let finer =
            if self.step < STEP { format!("diverges at 5 ms, timed at {} ms", self.step * 1e3) } else { String::new() };
        match self.world.model().constraints().pairs.is_empty() {
            true => finer,
            false => [finer, self.pressing()].into_iter().filter(|s| !s.is_empty()).collect::<Vec<_>>().join("; "),
        }
    }

    /// Size of the contact problem: points of contact and active joint limits, on average over the steps of the second
    /// that is timed.
    fn pressing(&mut self) -> String {
        self.restart();
        let unsolved = |world: &World| world.solver_report().map_or(0, |r| r.not_converged + r.unconverged_islands);
        let (mut points, mut active_limits, before) = (0, 0, unsolved(&self.world));
        for _ in 0..STEPS_A_SECOND {
            self.advance();
            // the normal force that the step found for each slot, limits first
            let limits = self.world.model().constraints().limits.len();
            let records = self.world.state.contacts.get(1..).unwrap_or_default().chunks_exact(1 + SLOT_LEN);
            for record in records.filter(|record| record[1] > 0.0) {
                *(if (record[0] as usize) < limits { &mut active_limits } else { &mut points }) += 1;
            }
        }
        let unsolved = unsolved(&self.world) - before;
        self.restart();
        let mean = |n: u32| f64::from(n) / f64::from(STEPS_A_SECOND);
        let text = format!("{:.1} contacts and {:.1} joint limits active", mean(points), mean(active_limits));
        if unsolved > 0 { format!("{text}, {unsolved} problems not solved") } else { text }
    }
}

/// Puts a state back without allocating.
fn restore(state: &mut State<f64>, start: &State<f64>) {
    state.q.copy_from_slice(&start.q);
    state.v.copy_from_slice(&start.v);
    state.commands.copy_from_slice(&start.commands);
    state.drives.copy_from_slice(&start.drives);
    state.contacts.clone_from(&start.contacts);
    state.totals.copy_from_slice(&start.totals);
    state.rotors.copy_from_slice(&start.rotors);
    state.tick = start.tick;
}

/// One step of a world. An error-controlled method is timed by whole seconds, whose ticks differ.
pub(super) fn step(scene: &Scene, method: MethodKind, totals: bool) -> Subject {
    step_of(Stepper::new(scene, method, totals))
}

/// One step of the world of a stepper.
pub(super) fn step_of(mut stepper: Stepper) -> Subject {
    let note = stepper.note();
    let subject = if stepper.control.is_some() {
        let second = move || (0..STEPS_A_SECOND).for_each(|_| stepper.call());
        Subject::new(second).with_units(f64::from(STEPS_A_SECOND))
    } else {
        Subject::new(move || stepper.call())
    };
    subject.with_note(note)
}

/// Start with all velocities 0.1, and the joint torques there: the state at which peers time their dynamics too.
pub(super) fn moving(scene: &Scene) -> (State<f64>, Vec<f64>) {
    let mut state = scene.initial.clone();
    state.v.fill(0.1);
    let model = &scene.model;
    let torque = model.dofs().iter().enumerate().map(|(k, dof)| {
        let deflection = dof.coordinate().map_or(0.0, |q| state.q[q] - dof.rest);
        model.applied_torque(k, 0.0) - dof.stiffness * deflection - dof.damping * state.v[k]
    });
    let torque = torque.collect();
    (state, torque)
}

/// Accelerations from torques, the recursion alone.
pub(super) fn forward(scene: &Scene) -> Subject {
    let model = Model::clone(&scene.model);
    let (state, torque) = moving(scene);
    let diagonal: Vec<f64> = model.dofs().iter().map(|d| d.armature).collect();
    let (mut scratch, mut v_dot) = (Scratch::new(&model), vec![0.0; model.n_v()]);
    Subject::new(move || {
        let input = aba::Input {
            q: black_box(&state.q),
            v: &state.v,
            torque: &torque,
            diagonal: &diagonal,
            prescribed: None,
            external: None,
            gravity: true,
        };
        model.forward_dynamics(&input, &mut scratch, &mut v_dot);
        black_box(&v_dot);
    })
}

/// Torques from accelerations.
pub(super) fn inverse(scene: &Scene) -> Subject {
    let model = Model::clone(&scene.model);
    let (state, _) = moving(scene);
    let v_dot = vec![0.1; model.n_v()];
    let (mut scratch, mut torque) = (Scratch::new(&model), vec![0.0; model.n_v()]);
    Subject::new(move || {
        let q = black_box(&state.q);
        model.inverse_dynamics(q, &state.v, &v_dot, None, &mut scratch, &mut torque);
        black_box(&torque);
    })
}

/// Accelerations of a world with everything that acts in it.
pub(super) fn rates(scene: &Scene) -> Subject {
    let mut world = world(scene, MethodKind::SemiImplicitEuler, 1.0, false);
    world.state.v.fill(0.1);
    Subject::new(move || {
        black_box(world.rates(0.0));
    })
}

/// A simulated second of many worlds, per world and step; steps compiled or by the recursions.
pub(super) fn batch(scene: &Scene, threads: usize, compile: Compile) -> Subject {
    let world = BatchWorld::new((*scene.model).clone(), scene.initial.clone());
    let start = scene.initial.clone();
    let prepared = move |h: f64| {
        let settings =
            BatchSettings { method: MethodKind::SemiImplicitEuler, h, n_steps: STEPS_A_SECOND, record_every: 0 };
        Rollout::new(vec![world.clone(); WORLDS], settings, compile)
    };
    let run = move |rollout: &mut Rollout| -> bool {
        (0..WORLDS).for_each(|k| rollout.restart(k, &start));
        rollout.advance(threads).expect("the worlds are copies of one");
        let first = &rollout.worlds()[0];
        first.stop.is_none() && first.state.v.iter().all(|v| v.abs() < 1e6)
    };
    let mut h = STEP;
    let mut rollout = prepared(h);
    while !run(&mut rollout) && h > 1e-6 {
        h /= 10.0;
        rollout = prepared(h);
    }
    let mut notes = Vec::new();
    if h < STEP {
        notes.push(format!("diverges at 5 ms, timed at {} ms", h * 1e3));
    }
    match rollout.steps_by() {
        StepsBy::Compiled { elapsed, is_cached: false } => {
            notes.push(format!("compiled in {:.2} s", elapsed.as_secs_f64()));
        }
        StepsBy::Compiled { is_cached: true, .. } => notes.push("compiled before".to_owned()),
        StepsBy::Recursions { reason } if compile == Compile::IfPossible => {
            notes.push(format!("not compiled: {reason}"));
        }
        StepsBy::Recursions { .. } => {}
    }
    let note = notes.join("; ");
    let call = move || {
        black_box(run(&mut rollout));
    };
    Subject::new(call).with_units(WORLDS as f64 * f64::from(STEPS_A_SECOND)).with_note(note)
}

/// A simulated second of many arms with limited motors, dry friction and limits of joints, each from a start of its
/// own, per world and step: in lanes, or one by one.
pub(super) fn limited_batch(in_lanes: bool) -> Subject {
    let scene = models::limited_panda();
    let settings =
        BatchSettings { method: MethodKind::SemiImplicitEuler, h: STEP, n_steps: STEPS_A_SECOND, record_every: 0 };
    let start = |k: usize| {
        let mut state = scene.initial.clone();
        // quasi-random starts and speeds
        let share = |i: usize| (0.618_033_988_749_895 * (8 * k + i) as f64).fract() - 0.5;
        state.q.iter_mut().enumerate().for_each(|(i, q)| *q += share(i));
        state.v.iter_mut().enumerate().for_each(|(i, v)| *v = share(i + 3));
        BatchWorld::new((*scene.model).clone(), state)
    };
    let worlds: Vec<BatchWorld> = (0..WORLDS).map(start).collect();
    let advance = move |worlds: &mut [BatchWorld]| {
        if in_lanes {
            batch::advance(worlds, &settings).expect("the worlds are copies of one");
        } else {
            worlds.iter_mut().for_each(|world| batch::advance_alone(world, &settings));
        }
    };
    let mut first = worlds.clone();
    advance(&mut first);
    let alone: u64 = first.iter().map(|world| world.steps_alone).sum();
    let n_steps = WORLDS as f64 * f64::from(STEPS_A_SECOND);
    let note = format!("{:.0} % of the steps alone", 100.0 * alone as f64 / n_steps);
    let call = move || {
        let mut worlds = worlds.clone();
        advance(&mut worlds);
        black_box(&worlds);
    };
    Subject::new(call).with_units(n_steps).with_note(note)
}

/// Bytes of one world: its state and working memory, the model left out, which worlds could share.
pub(super) fn memory(scene: &Scene, method: MethodKind) -> usize {
    world(scene, method, 1.0, true).heap_bytes() + size_of::<World>()
}

/// Joint accelerations at the start with every hinge at 0.3 rad/s and free bodies at rest: name of the body, then one a
/// degree of freedom of the joints that carry it, angular first. Peers give the same, and so prove that they compute
/// the same robot. Nothing is touched: what stands on a floor does so 100 m above it.
pub(super) fn accelerations(scene: &Scene) -> Vec<(String, Vec<f64>)> {
    let mut world = world(scene, MethodKind::SemiImplicitEuler, 1.0, false);
    for k in 0..scene.model.n_v() {
        world.state.v[k] = if scene.model.has_scalar_coordinate(k) { 0.3 } else { 0.0 };
    }
    let lifted = !scene.model.constraints().pairs.is_empty();
    for joint in scene.model.names().joints.iter().filter(|joint| lifted && joint.n_q == 7) {
        world.state.q[joint.q_idx + 2] += 100.0;
    }
    let rates = world.rates(0.0).0.to_vec();
    let mut list: Vec<(String, Vec<f64>)> = Vec::new();
    for joint in &scene.model.names().joints {
        let (name, rates) = (carried(scene, &joint.name), &rates[joint.v_idx..joint.v_idx + joint.n_v]);
        match list.iter_mut().find(|(other, _)| *other == name) {
            Some((_, before)) => before.extend(rates),
            None => list.push((name, rates.to_vec())),
        }
    }
    list
}

/// Name of the body that a joint carries, maybe through other joints.
fn carried(scene: &Scene, joint: &str) -> String {
    let is_child = |parent: Option<usize>, path: &str| parent.is_some_and(|k| scene.objects[k].path == path);
    let child = scene.objects.iter().find(|object| is_child(object.parent, joint));
    match child.map(|child| (&child.kind, child)) {
        Some((ObjectKind::Joint { .. }, joint)) => carried(scene, &joint.path),
        Some((_, body)) => body.name.clone(),
        None => joint.to_owned(),
    }
}

#[cfg(test)]
mod tests {
    use super::super::models;
    use super::*;

    #[test]
    fn a_second_is_two_hundred_steps() {
        assert_eq!(default_experiment(STEP, 1.0).n_steps, u64::from(STEPS_A_SECOND));
    }

    #[test]
    fn stiff_robots_get_the_stiff_method() {
        let method = |name| default_method(&models::robot(name).unwrap().scene);
        assert_eq!(method("alexandros"), MethodKind::Stiff);
        assert_eq!(method("arm2"), MethodKind::DormandPrince);
    }

    #[test]
    fn humanoids_press_on_the_floor_while_they_are_timed() {
        for name in ["humanoid", "humanoid_lying"] {
            let scene = models::robot(name).unwrap().scene;
            assert_eq!(scene.model.n_v(), 27);
            let note = Stepper::new(&scene, MethodKind::SemiImplicitEuler, false).note();
            let points: f64 = note.split(' ').next().and_then(|n| n.parse().ok()).unwrap();
            assert!(points > 4.0 && !note.contains("diverges"), "{name}: {note}");
        }
    }

    #[test]
    fn a_step_that_diverges_is_timed_finer() {
        let scene = models::robot("alexandros").unwrap().scene;
        assert!(Stepper::new(&scene, MethodKind::Rk4, false).step < STEP);
        assert!(Stepper::new(&scene, MethodKind::Implicit, false).step == STEP);
    }
}
