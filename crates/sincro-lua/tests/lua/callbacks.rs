//! Callbacks of pauses, of the step as a whole, of contacts.

use sincro_coppelia::api::Phase;
use sincro_coppelia::session::Session;
use sincro_sim::results::Status;
use sincro_sim::run::Simulated;
use sincro_testing::{OpenSession, with_scripts};

use super::world::{EXPERIMENT, PENDULUM, folder, open, run};

/// A session of the pendulum with a script on its arm.
fn session(code: &str) -> OpenSession {
    let scene = format!("{PENDULUM}\n[[script]]\nobject = \"/hinge/arm\"\nfile = \"a.lua\"\n");
    let folder = folder(&[("scene.toml", &scene), ("experiment.toml", EXPERIMENT), ("a.lua", code)]);
    folder.session(with_scripts(), None)
}

fn told(session: &mut Session) -> Vec<String> {
    session.registry().take_log().into_iter().map(|line| line.text).collect()
}

#[test]
fn scripts_are_told_of_pauses() {
    let code = "
        function sysCall_suspend() print('suspend', sim.getSimulationState()) end
        function sysCall_suspended() print('suspended', sim.getSimulationState()) end
        function sysCall_resume() print('resume', sim.getSimulationState()) end
        function sysCall_actuation() print('acts') end";
    let mut session = session(code);
    session.pause().unwrap();
    session.idle().unwrap();
    session.start().unwrap();
    session.step().unwrap();
    assert_eq!(told(&mut session), ["acts"], "nothing is told before there is a run");
    session.idle().unwrap();
    session.pause().unwrap();
    session.pause().unwrap();
    session.step().unwrap();
    session.idle().unwrap();
    session.idle().unwrap();
    session.start().unwrap();
    session.step().unwrap();
    assert_eq!(told(&mut session), ["suspend\t17", "suspended\t8", "suspended\t8", "resume\t8", "acts"]);
    session.stop().unwrap();
    assert_eq!(session.take_finished().remove(0).simulated.trace, {
        let mut other = self::session("x = 1");
        other.start().unwrap();
        (0..2).for_each(|_| other.step().unwrap());
        other.stop().unwrap();
        other.take_finished().remove(0).simulated.trace
    });
}

#[test]
fn a_script_may_end_its_pause_and_one_that_fails_ends_the_run() {
    let mut going = session("function sysCall_suspended() sim.startSimulation() end");
    going.start().unwrap();
    going.pause().unwrap();
    going.idle().unwrap();
    assert_eq!(going.phase(), Phase::Running);
    let mut failing = session("function sysCall_suspend() error('no') end");
    failing.start().unwrap();
    failing.step().unwrap();
    let why = failing.pause().unwrap_err().to_string();
    assert!(why.contains("a.lua:1") && why.contains("no"), "{why}");
    assert_eq!(failing.phase(), Phase::Stopped);
    let status = failing.take_finished().remove(0).simulated.status;
    assert!(matches!(status, Status::Stopped { tick: 1, .. }), "{status:?}");
}

/// The pendulum with a customization script.
fn customized(code: &str) -> Simulated {
    let scene = format!("{PENDULUM}\n[[script]]\nobject = \"/hinge\"\nkind = \"customization\"\nfile = \"a.lua\"\n");
    run(&open(&[("scene.toml", &scene), ("experiment.toml", EXPERIMENT), ("a.lua", code)]).unwrap())
}

#[test]
fn a_customization_script_holds_a_step_back_as_often_as_it_says() {
    let code = "local n = 0
        function sysCall_beforeMainScript() n = n + 1 print('before', sim.getSimulationTime()) return { doNotRunMainScript = n % 3 ~= 0 } end
        function sysCall_actuation() print('acts', sim.getSimulationTime()) end";
    let held = customized(code);
    let texts: Vec<&str> = held.messages.iter().map(|m| m.text.as_str()).collect();
    assert_eq!(texts[..5], ["before\t0.0", "before\t0.0", "before\t0.0", "acts\t0.0", "before\t0.01"]);
    assert_eq!(texts.len(), 20, "four calls in each of five steps");
    assert_eq!(held.trace, customized("x = 1").trace);
    let Status::Stopped { tick: 0, reason, help, .. } =
        customized("function sysCall_beforeMainScript() return { doNotRunMainScript = true } end").status
    else {
        panic!("it went on")
    };
    assert!(reason.contains("held back one step 1000 times") && help.contains("number of calls"), "{reason}; {help}");
}

/// A ball that lies on a floor, a box that slides on it, and another ball far above.
const SCENE: &str = r#"
[[body]]
name = "floor"
shape = [{ plane = {} }]
contact = { friction = MU }
[[joint]]
name = "loose"
kind = "free"
initial = { position = [0.0, 0.0, 0.1, 1.0, 0.0, 0.0, 0.0] }
[[body]]
name = "ball"
parent = "/loose"
density = 1000.0
shape = [{ sphere = { radius = 0.1 } }]
contact = { friction = MU }
[[joint]]
name = "slide"
kind = "free"
initial = { position = [1.0, 0.0, 0.05, 1.0, 0.0, 0.0, 0.0], velocity = [0.0, 0.0, 0.0, 1.0, 0.0, 0.0] }
[[body]]
name = "box"
parent = "/slide"
density = 1000.0
shape = [{ cuboid = { size = [0.1, 0.1, 0.1] } }]
contact = { friction = MU }
[[joint]]
name = "high"
kind = "free"
initial = { position = [2.0, 0.0, 9.0, 1.0, 0.0, 0.0, 0.0] }
[[body]]
name = "far"
parent = "/high"
density = 1000.0
shape = [{ sphere = { radius = 0.1 } }]
contact = {}
[[script]]
object = "/loose/ball"
file = "a.lua"
"#;

fn touching(friction: &str, code: &str) -> Simulated {
    let experiment = "title = \"t\"\nduration = 0.3\nstep = 0.01\nerror_bar = \"none\"
        record = [\"/loose.position.z\", \"/slide.position.x\", \"energy.balance\"]\n";
    let files = [("scene.toml", &*SCENE.replace("MU", friction)), ("experiment.toml", experiment), ("a.lua", code)];
    let run = run(&open(&files).unwrap_or_else(|problems| panic!("{problems}")));
    assert_eq!(run.status, Status::Completed, "{:?}", run.messages);
    run
}

#[test]
fn two_bodies_pass_through_each_other_while_a_script_says_so() {
    let code = "
        local seen = {}
        function sysCall_contact(inData)
            local names = sim.getObjectAlias(inData.handle1) .. ' ' .. sim.getObjectAlias(inData.handle2)
            if not seen[names] then seen[names] = true print(names, inData.engine) end
            if names:find('box') then return { ignoreContact = true, collisionResponse = false } end
            return { ignoreContact = false, collisionResponse = sim.getSimulationTime() < 0.095 }
        end";
    let passing = touching("0.2", code);
    let texts: Vec<&str> = passing.messages.iter().map(|m| m.text.as_str()).collect();
    assert_eq!(texts, ["floor ball\t4", "floor box\t4"], "nobody is asked of what is far");
    let times = passing.table.times();
    for (k, z) in passing.table.column("/loose.position.z").unwrap().values.iter().enumerate() {
        // from the start of the step at 0.1 s on it falls, to the bit of what free fall is
        let t = (times[k] - 0.1).max(0.0);
        assert!((z - (0.1 - 0.5 * 9.81 * t * t)).abs() < 1e-9, "z = {z} at {}", times[k]);
    }
    let balance = &passing.table.column("energy.balance").unwrap().values;
    assert!(balance.iter().all(|x| x.abs() < 1e-9), "{balance:?}");
    let plain = touching("0.2", "x = 1");
    let of = |run: &Simulated| run.table.column("/slide.position.x").unwrap().values.clone();
    assert_eq!(of(&passing), of(&plain), "what a script leaves to others goes by the scene");
}

#[test]
fn friction_that_a_script_gives_is_that_of_a_scene_which_has_it() {
    let code = "function sysCall_contactCallback(inData)
            return { ignoreContact = false, collisionResponse = true, bullet = { friction = 0.2, restitution = 0 } }
        end";
    let given = touching("0.7", code);
    // the scene's own friction is what the start was settled with: forces begin from another guess
    let path = |run: &Simulated| run.table.column("/slide.position.x").unwrap().values.clone();
    let (given, wanted, other) = (path(&given), path(&touching("0.2", "x = 1")), path(&touching("0.7", "x = 1")));
    assert!(given.iter().zip(&wanted).all(|(a, b)| (a - b).abs() < 1e-12), "{given:?} {wanted:?}");
    assert!(given.iter().zip(&other).any(|(a, b)| (a - b).abs() > 0.1), "{given:?}");
    for (answer, why) in [
        ("bullet = { friction = -1 }", "friction -1 of a contact"),
        ("newton = { staticFriction = 1, kineticFriction = 0.5 }", "one coefficient here"),
        ("collisionResponse = 1", "collisionResponse is a"),
        ("ode = { mu = 0, bounce = 2 }", "restitution 2 of a contact"),
    ] {
        let code = format!("function sysCall_contact() return {{ {answer} }} end");
        let experiment = "title = \"t\"\nduration = 0.1\nstep = 0.01\nrecord = [\"/loose.position.z\"]\n";
        let scene = SCENE.replace("MU", "0.2");
        let loaded = open(&[("scene.toml", &scene), ("experiment.toml", experiment), ("a.lua", &code)]).unwrap();
        let Status::Stopped { reason, .. } = run(&loaded).status else { panic!("{answer} was taken") };
        assert!(reason.contains(why) && reason.contains("sysCall_contact"), "{reason}");
    }
}

#[test]
fn a_mass_that_a_script_sets_at_the_start_is_that_of_a_scene_which_has_it() {
    let code = "function sysCall_init() sim.setShapeMass(sim.getObject('/arm'), 3) end";
    // under a torque: without one, a pendulum swings alike whatever it weighs
    let pushed = PENDULUM.replace("mode = \"torque\"", "mode = \"torque\", command = 2.0");
    let script = "[[script]]\nobject = \"/hinge/arm\"\nfile = \"a.lua\"\n";
    let with_script = format!("{pushed}{script}");
    let given = run(&open(&[("scene.toml", &with_script), ("experiment.toml", EXPERIMENT), ("a.lua", code)]).unwrap());
    let light = run(&open(&[("scene.toml", &pushed), ("experiment.toml", EXPERIMENT)]).unwrap());
    let heavy = pushed
        .replace("mass = 1.0", "mass = 3.0")
        .replace("xx = 0.1, yy = 0.1, zz = 0.01", "xx = 0.3, yy = 0.3, zz = 0.03");
    let wanted = run(&open(&[("scene.toml", &heavy), ("experiment.toml", EXPERIMENT)]).unwrap());
    // 3 · 0.1 is not the 0.3 of the file to the last bit
    let path = |run: &Simulated| run.table.column("/hinge.position").unwrap().values.clone();
    assert!(path(&given).iter().zip(path(&wanted)).all(|(a, b)| (a - b).abs() < 1e-14));
    assert!(path(&given).last().unwrap() - path(&light).last().unwrap() < -1e-4, "the light one goes farther");
    assert!((given.energy.potential_start - wanted.energy.potential_start).abs() < 1e-12, "{:?}", given.energy);
    // the change itself is no work
    assert!((given.energy.work - wanted.energy.work).abs() < 1e-12, "{:?}", given.energy);
    assert!(given.energy.residual < 1e-9, "{:?}", given.energy);
    assert_eq!(given.changes.len(), 3);
}
