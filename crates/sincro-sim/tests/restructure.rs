//! Runs whose structure changes between two steps: snapshots, diagrams and hashes.

use std::collections::BTreeMap;

use sincro_dynamics::spatial::{Pose, Vec3};
use sincro_scene::draft::SceneDraft;
use sincro_scene::record::Recorder;
use sincro_scene::scene::Scene;
use sincro_scene::script::ScriptError;
use sincro_sim::controller::{Controller, Forked, Instant};
use sincro_sim::prelude::*;
use sincro_sim::restructure::{Edit, Restructured, restructure};
use sincro_sim::run::Followed;
use sincro_testing::SceneFolder;
use sincro_testing::scenes::{MOTOR_PENDULUM, box_above_floor};

const EXPERIMENT: &str = r#"
title = "Restructured"
duration = 1.0
step = 0.005
record = ["/hinge.position", "/box_joint/box.position.z"]
error_bar = "none"
diagram = "diagram.toml"
"#;

/// PD control of the hinge.
const DIAGRAM: &str = r#"
wires = ["/hinge.position -> pd.x", "/hinge.velocity -> pd.v", "pd -> /hinge"]
[[block]]
name = "pd"
type = "expression"
inputs = ["x", "v"]
expressions = ["-20*x - 4*v"]
"#;

fn loaded() -> Loaded {
    SceneFolder::of(&format!("{MOTOR_PENDULUM}{}", box_above_floor(0.3)), EXPERIMENT)
        .with("diagram.toml", DIAGRAM)
        .load(&[])
        .unwrap()
}

/// Copies the box at tick 20, and removes the first one at tick 60.
#[derive(Clone, Debug, Default)]
struct Spawner {
    scene: Option<std::sync::Arc<Scene>>,
    made: Vec<Restructured>,
    /// Position of the copy [m].
    place: [f64; 3],
}

impl Controller for Spawner {
    fn name(&self) -> &str {
        "spawner"
    }

    fn actuate(&mut self, at: Instant<'_>) -> Result<(), ScriptError> {
        let scene = self.scene.clone().expect("a scene");
        let mut draft = SceneDraft::new(&scene).unwrap();
        let mut copies = BTreeMap::new();
        match at.tick {
            20 => {
                // before the hinge in the order of the file or not: the model's order is another one
                draft.copy("/box_joint", "copy", "/", &Pose::translation(Vec3(self.place)));
            }
            60 => draft.remove(&["/box_joint", "/box_joint/box"].map(str::to_owned).into()),
            _ => return Ok(()),
        }
        let to = draft.compile(100).unwrap();
        for (new, old) in [("/copy", "/box_joint"), ("/copy/box", "/box_joint/box")] {
            if let (Some(new), Some(old)) = (to.object(new), scene.object(old)) {
                copies.insert(new.id, old.id);
            }
        }
        let edit = Edit { from: &scene, copies: &copies, conserves_momentum: true };
        let change = restructure(at.world, to, &edit);
        self.scene = Some(change.scene.clone());
        self.made.push(change);
        Ok(())
    }

    fn take_restructured(&mut self) -> Vec<Restructured> {
        std::mem::take(&mut self.made)
    }

    fn restructured(&mut self, change: &Restructured) -> Result<(), String> {
        self.scene = Some(change.scene.clone());
        Ok(())
    }

    fn fork(&self) -> Forked {
        Forked::Whole(Box::new(self.clone()))
    }
}

fn lockstep(loaded: &Loaded) -> LockStep {
    lockstep_with_copy_at(loaded, [0.5, 0.0, 0.0])
}

fn lockstep_with_copy_at(loaded: &Loaded, place: [f64; 3]) -> LockStep {
    let mut lockstep = LockStep::new(loaded, method_for(loaded).0, false);
    lockstep.attach(Box::new(Spawner { scene: Some(loaded.scene.clone()), made: Vec::new(), place }));
    lockstep.start().unwrap();
    lockstep
}

fn advance(lockstep: &mut LockStep, trace: &mut sincro_sim::trace::Trace, to: u64) {
    while lockstep.tick() < to {
        lockstep.advance().unwrap();
        lockstep.hash_into(trace);
    }
}

#[test]
fn the_diagram_goes_on_with_its_joint() {
    let loaded = loaded();
    let mut run = lockstep(&loaded);
    let mut trace = run.trace();
    advance(&mut run, &mut trace, 200);
    let scene = run.scene().clone();
    let joint = scene.model.names().joint("/hinge").unwrap().q_idx;
    // over-damped to within a few per cent after a second
    assert!(run.state().q[joint].abs() < 0.2, "{:?}", run.state().q);
    assert_eq!(run.state().v.len(), 7);
    let copy = scene.model.names().joint("/copy").unwrap().q_idx;
    let z = run.state().q[copy + 2];
    assert!((z - 0.05).abs() < 1e-9, "the copy rests at {z} m");
}

#[test]
fn a_snapshot_after_a_change_continues_with_the_same_bits() {
    let loaded = loaded();
    for tick in [10, 30, 59, 61, 100] {
        let mut run = lockstep(&loaded);
        let mut trace = run.trace();
        advance(&mut run, &mut trace, tick);
        let bytes = run.snapshot(trace).to_bytes(&loaded);
        let mut other = lockstep(&loaded);
        let read = Snapshot::from_bytes(&bytes, &loaded).unwrap();
        other.restore(&read);
        let mut others = read.trace;
        advance(&mut run, &mut trace, 160);
        advance(&mut other, &mut others, 160);
        assert_eq!(run.state(), other.state(), "from tick {tick}");
        assert_eq!(trace, others, "from tick {tick}");
        // and back to a time before the change
        let mut again = lockstep(&loaded);
        let mut start = again.trace();
        advance(&mut again, &mut start, 10);
        let early = again.snapshot(start);
        other.restore(&early);
        let mut back = early.trace;
        advance(&mut other, &mut back, 160);
        assert_eq!(trace, back, "back from tick 160 to 10");
    }
}

#[test]
fn a_recorder_follows_from_one_structure_to_another_with_as_many_changes() {
    let loaded = loaded();
    let at_30 = |place| {
        let mut run = lockstep_with_copy_at(&loaded, place);
        let mut trace = run.trace();
        advance(&mut run, &mut trace, 30);
        let snapshot = run.snapshot(trace);
        (run, snapshot)
    };
    let ((mut run, here), (_, there)) = (at_30([0.5, 0.0, 0.0]), at_30([0.5, 0.0, 0.4]));
    let mut recorder = Recorder::new(&loaded.experiment.record, &loaded.scene.model, &[]).unwrap();
    let mut known = Followed::default();
    assert!(run.bring_up(&mut recorder, &mut known) && !run.bring_up(&mut recorder, &mut known));
    let energy = known.energy;
    run.restore(&there);
    assert!(run.bring_up(&mut recorder, &mut known), "one change here and one there");
    assert!((known.energy - energy - 0.4 * 9.81).abs() < 1e-9, "a box of 1 kg, 0.4 m higher");
    run.restore(&here);
    assert!(run.bring_up(&mut recorder, &mut known) && (known.energy - energy).abs() < 1e-12);
}

#[test]
fn bytes_of_a_structure_that_were_cut_are_refused() {
    let loaded = loaded();
    let mut run = lockstep(&loaded);
    let mut trace = run.trace();
    advance(&mut run, &mut trace, 30);
    let bytes = run.snapshot(trace).to_bytes(&loaded);
    for n in [bytes.len() / 2, bytes.len() - 9, bytes.len() - 1] {
        assert!(Snapshot::from_bytes(&bytes[..n], &loaded).is_err());
    }
}
