//! Structure that a script changes: the same bits as by a client, and by a run that goes on from a snapshot.

use sincro_coppelia::api::{Search, Value};
use sincro_sim::Extensions;
use sincro_sim::prelude::*;
use sincro_testing::scenes::box_above_floor;
use sincro_testing::{OpenSession, SceneFolder};

use super::world::{open, run};

const EXPERIMENT: &str = r#"
title = "Structure"
duration = 0.5
step = 0.005
record = ["/box_joint/box.position.z"]
error_bar = "none"
"#;

/// Copies the box at 0.1 s, hangs the copy on the box at 0.2 s, parts them at 0.3 s.
const SPAWNER: &str = "
local function is(t) return math.abs(sim.getSimulationTime() - t) < 1e-9 end
function sysCall_init() box = sim.getObject('/box') end
function sysCall_actuation()
    if is(0.1) then
        copy = sim.copyPasteObjects({ box }, 0)[1]
        sim.setObjectPosition(copy, -1, { 0.3, 0, 0.2 })
        sim.setObjectAlias(copy, 'second')
    end
    if is(0.2) then sim.setObjectParent(sim.getObject('/second'), box, true) end
    if is(0.3) then sim.setObjectParent(sim.getObject('/second'), -1, true) end
end";

fn scripted() -> Loaded {
    let scene = format!("{}\n[[script]]\nobject = \"/floor\"\nfile = \"a.lua\"\n", box_above_floor(0.1));
    open(&[("scene.toml", &scene), ("experiment.toml", EXPERIMENT), ("a.lua", SPAWNER)]).unwrap()
}

#[test]
fn a_script_and_a_client_that_change_the_structure_give_the_same_trace() {
    let of_script = run(&scripted());
    assert_eq!(of_script.status, Status::Completed);
    let mut session =
        OpenSession::open(SceneFolder::of(&box_above_floor(0.1), EXPERIMENT), &[], Extensions::default(), None);
    session.start().unwrap();
    let find = |session: &mut OpenSession, path: &str| -> Value {
        i64::from(session.registry().find(path, Search::default()).unwrap().0).into()
    };
    let body = find(&mut session, "/box");
    for tick in 0..100 {
        match tick {
            20 => {
                let list = Value::List(vec![body.clone()]);
                let copies = session.call("sim.copyPasteObjects", &[list, Value::Int(0)]).unwrap().remove(0);
                let Value::List(copies) = copies else { panic!("{copies:?}") };
                let place = Value::reals([0.3, 0.0, 0.2]);
                session.call("sim.setObjectPosition", &[copies[0].clone(), Value::Int(-1), place]).unwrap();
                session.call("sim.setObjectAlias", &[copies[0].clone(), Value::from("second")]).unwrap();
            }
            40 | 60 => {
                let parent = if tick == 40 { body.clone() } else { Value::Int(-1) };
                let second = find(&mut session, "/second");
                session.call("sim.setObjectParent", &[second, parent, Value::Bool(true)]).unwrap();
            }
            _ => {}
        }
        session.step().unwrap();
    }
    session.stop().unwrap();
    let of_client = session.take_finished().remove(0).simulated;
    assert_eq!(of_client.trace, of_script.trace);
    assert_eq!(of_client.changes, of_script.changes);
    assert_eq!(run(&scripted()).trace, of_script.trace, "and each time");
}

#[test]
fn a_run_with_scripts_goes_on_from_a_snapshot_after_a_change() {
    let loaded = scripted();
    let lockstep = || {
        let mut lockstep = LockStep::new(&loaded, method_for(&loaded).0, false);
        lockstep.start().unwrap();
        lockstep
    };
    for tick in [30, 45, 70] {
        let (mut whole, mut other) = (lockstep(), lockstep());
        let mut trace = whole.trace();
        while whole.tick() < tick {
            whole.advance().unwrap();
            whole.hash_into(&mut trace);
        }
        let bytes = whole.snapshot(trace).to_bytes(&loaded);
        let read = Snapshot::from_bytes(&bytes, &loaded).unwrap();
        other.restore(&read);
        let mut others = read.trace;
        while whole.tick() < 100 {
            whole.advance().unwrap();
            other.advance().unwrap();
            whole.hash_into(&mut trace);
            other.hash_into(&mut others);
            assert_eq!(whole.state(), other.state(), "tick {} after {tick}", whole.tick());
        }
        assert_eq!(trace, others, "from tick {tick}");
    }
}
