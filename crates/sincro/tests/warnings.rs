//! Warnings, before the run, of mistakes that would pass silently; no shipped scene is warned of what it means.

use std::path::{Path, PathBuf};

use sincro_analysis::linearize::unstable_loop;
use sincro_scene::diagram::ControlDiagram;
use sincro_scene::record::Recorder;
use sincro_testing::{CommandLine, SceneFolder, repository_scene};

const SINCRO: CommandLine = CommandLine::new(env!("CARGO_BIN_EXE_sincro"));

/// A pendulum of 0.5 m that is driven by a torque; `initial` in radians from hanging.
fn pendulum(initial: f64, more: &str) -> String {
    format!(
        "format = 2\n[[joint]]\nname = \"hinge\"\nkind = \"revolute\"\naxis = [0, 1, 0]\ndamping = 0.1\n\
         initial = {{ position = {initial:?} }}\nmotor = {{ mode = \"torque\" }}\n\
         [[body]]\nname = \"bob\"\nparent = \"hinge\"\nmass = 1\ninertia = {{ xx = 0.01, yy = 0.01, zz = 0.01 }}\n\
         center_of_mass = [0, 0, -0.5]\n{more}"
    )
}

fn experiment(more: &str) -> String {
    format!("format = 2\ntitle = \"t\"\nduration = 5\nstep = 0.002\nrecord = [\"energy.balance\"]\n{more}")
}

/// Warnings of `check`.
fn warnings(scene: &str, more: &str, diagram: Option<&str>) -> Vec<String> {
    let more = if diagram.is_some() { format!("diagram = \"diagram.toml\"\n{more}") } else { more.to_owned() };
    let folder = SceneFolder::of(scene, &experiment(&more)).with("diagram.toml", diagram.unwrap_or(""));
    let exit = SINCRO.call(&["check", folder.to_str().unwrap()]);
    assert_eq!(exit.status, 0, "{}{}", exit.stdout, exit.stderr);
    let all = exit.stdout + &exit.stderr;
    all.lines().filter_map(|line| line.strip_prefix("warning: ")).map(str::to_owned).collect()
}

/// A PD loop on the hinge with these gains.
fn loop_of(kp: f64, kd: f64, sample_time: &str) -> String {
    format!(
        "{sample_time}wires = [\"/hinge.position -> kp\", \"/hinge.velocity -> kd\", \"kp -> sum.u1\", \"kd -> sum.u2\", \
         \"sum -> /hinge\"]\n\
         [[block]]\nname = \"kp\"\ntype = \"gain\"\ngain = {kp:?}\n[[block]]\nname = \"kd\"\ntype = \"gain\"\ngain = {kd:?}\n\
         [[block]]\nname = \"sum\"\ntype = \"sum\"\nsigns = \"--\"\n"
    )
}

#[test]
fn a_good_loop_from_a_sensor_is_not_told_of() {
    let sensor = "[[sensor]]\nname = \"imu\"\nparent = \"/hinge/bob\"\nimu = {}\n";
    for (gain, sample_time) in [(1.0, ""), (1.0, "sample_time = 0.01\n")] {
        let diagram = loop_of(20.0, gain, sample_time).replace("/hinge.velocity", "/hinge/bob/imu.gyro[1]");
        let said = warnings(&pendulum(0.3, sensor), "", Some(&diagram));
        assert!(!said.iter().any(|line| line.contains("unstable")), "{said:?}");
    }
}

#[test]
fn a_loop_that_is_unstable_from_the_first_is_told_of() {
    let is_told = |initial: f64, diagram: &str| {
        let said = warnings(&pendulum(initial, ""), "", Some(diagram));
        said.iter().any(|line| line.contains("unstable from the first"))
    };
    // a wrong sign, continuous and sampled; a sample time that is too long for its gain
    assert!(is_told(0.3, &loop_of(-20.0, 1.0, "")));
    assert!(is_told(0.3, &loop_of(-20.0, 1.0, "sample_time = 0.01\n")));
    assert!(is_told(0.3, &loop_of(20.0, 30.0, "sample_time = 0.05\n")));
    // upright, the loop is too weak to hold it: the start is an equilibrium that it leaves
    assert!(is_told(std::f64::consts::PI, &loop_of(0.0, 0.2, "")));
    // the same through a noisy sensor with a sample time of its own, in a continuous and a sampled diagram
    let sensed = |kd: f64, sample_time: &str| {
        let sensor = "[[sensor]]\nname = \"imu\"\nparent = \"/hinge/bob\"\nsample_time = 0.05\n\
                      imu = { gyro_noise_density = 1e-4 }\n";
        let diagram = loop_of(20.0, kd, sample_time).replace("/hinge.velocity", "/hinge/bob/imu.gyro[1]");
        let said = warnings(&pendulum(0.3, sensor), "", Some(&diagram));
        said.iter().any(|line| line.contains("unstable from the first"))
    };
    assert!(sensed(30.0, "") && sensed(30.0, "sample_time = 0.05\n"));
    assert!(!sensed(1.0, "") && !sensed(1.0, "sample_time = 0.05\n"));
    // a good loop, and one that swings off from a start beside an equilibrium
    assert!(!is_told(0.3, &loop_of(20.0, 1.0, "")));
    assert!(!is_told(0.3, &loop_of(20.0, 1.0, "sample_time = 0.01\n")));
    assert!(!is_told(2.5, &loop_of(0.0, 0.2, "")));
}

#[test]
fn unconnected_blocks_and_objects_are_told_of() {
    let good = loop_of(20.0, 1.0, "");
    let block = "[[block]]\nname = \"alone\"\ntype = \"constant\"\nvalue = 1.0\n";
    let said = warnings(&pendulum(0.3, ""), "", Some(&format!("{good}{block}")));
    assert_eq!(said, ["nothing uses the output of block `alone`"]);
    let said = warnings(
        &pendulum(0.3, ""),
        "[[plot]]\ntitle = \"p\"\nsignals = [\"alone\"]\n",
        Some(&format!("{good}{block}")),
    );
    assert!(said.is_empty(), "{said:?}");
    let frame =
        "[[frame]]\nname = \"mark\"\nparent = \"bob\"\n[[sensor]]\nname = \"imu\"\nparent = \"bob\"\nimu = {}\n";
    let said = warnings(&pendulum(0.3, frame), "", Some(&good));
    assert_eq!(said, ["nothing uses the frame `/hinge/bob/mark`", "nothing uses the sensor `/hinge/bob/imu`"]);
    // a body that was meant to fall
    let body = "[[body]]\nname = \"ball\"\ndensity = 1000\nshape = [{ sphere = { radius = 0.1 } }]\n";
    let said = warnings(&pendulum(0.3, body), "", None);
    assert_eq!(said, ["body `/ball` has mass and is fixed in the world: it never moves"]);
    // a default for objects that are not there
    let default = "[[default]]\nof = \"joint\"\ngroup = \"/leg*\"\nkeys = { damping = 1.0 }\n";
    assert_eq!(warnings(&pendulum(0.3, default), "", None), ["no joint has a path of the form `/leg*`"]);
}

/// A ball above a floor, each with its own contact.
fn ball(contact: &str, floor: &str, more: &str) -> String {
    format!(
        "format = 2\n[[joint]]\nname = \"air\"\nkind = \"free\"\ninitial = {{ position = [0, 0, 1, 1, 0, 0, 0] }}\n\
         [[body]]\nname = \"ball\"\nparent = \"air\"\ndensity = 1000\nshape = [{{ sphere = {{ radius = 0.1 }} }}]\n{contact}\n\
         [[body]]\nname = \"floor\"\nshape = [{{ plane = {{}} }}]\n{floor}\n{more}"
    )
}

#[test]
fn surfaces_that_can_touch_nothing_are_told_of() {
    let (own, other) = ("contact = { friction = 0.5 }", "contact = { friction = 0.5, group = 2 }");
    let idle = |scene: &str| {
        let said = warnings(scene, "", None);
        said.iter().filter(|line| line.contains("can touch nothing")).count()
    };
    assert_eq!(idle(&ball(own, own, "")), 0);
    assert_eq!(idle(&ball(other, other, "")), 2, "a group that excludes everything");
    assert_eq!(idle(&ball(own, own, "[[contact_pair]]\nbetween = [\"/floor\", \"/air/ball\"]\ntouches = false\n")), 2);
    // a wall beside the floor is touched by the ball
    let wall = "[[body]]\nname = \"wall\"\nposition = [3, 0, 0]\nshape = [{ cuboid = { size = [0.1, 1, 1] } }]\n\
                contact = { friction = 0.5 }\n";
    assert_eq!(idle(&ball(own, own, wall)), 0);
    // a wall in the group of the only thing that moves
    assert_eq!(idle(&ball(other, own, &wall.replace("0.5 }", "0.5, group = 2 }"))), 1);
}

#[test]
fn pulses_shorter_than_a_step_are_findings_of_the_audit() {
    let with = |width: f64| {
        let scene = pendulum(0.3, "").replace(
            "mode = \"torque\"",
            &format!("mode = \"torque\", command = {{ pulse = {{ period = 0.1, width = {width:?} }} }}"),
        );
        let folder = SceneFolder::of(&scene, &experiment(""));
        SINCRO.call(&["check", folder.to_str().unwrap()])
    };
    assert_eq!(with(0.002).status, 0);
    let exit = with(0.0007);
    assert!(exit.status == 1 && (exit.stdout + &exit.stderr).contains("source frequency of /hinge"));
}

#[test]
fn words_of_other_programs_are_answered_with_the_right_ones() {
    let help = |from: &str, to: &str| {
        let scene = pendulum(0.3, "");
        assert!(scene.contains(from));
        let folder = SceneFolder::of(&scene.replace(from, to), &experiment(""));
        let exit = SINCRO.call(&["check", folder.to_str().unwrap()]);
        assert_eq!(exit.status, 2, "{to}: {}", exit.stdout);
        exit.stderr
    };
    // a suggestion keeps the unit
    assert!(help("position = 0.3", "positon_deg = 17.0").contains("did you mean `position_deg`?"));
    assert!(help("position = 0.3", "position_dg = 17.0").contains("did you mean `position_deg`?"));
    assert!(help("position = 0.3", "angle_deg = 17.0").contains("write `position_deg`"));
    assert!(help("\"revolute\"", "\"hing\"").contains("did you mean `revolute`?"));
    let said = help("inertia = { xx = 0.01, yy = 0.01, zz = 0.01 }", "inertia = [0.01, 0.01, 0.01]");
    assert!(said.contains("expected a table of `xx`, `xy`, `xz`, `yy`, `yz`, `zz`"), "{said}");
    // blocks have a `type`, joints a `kind`: both are understood
    let blocks = loop_of(20.0, 1.0, "").replace("type = ", "kind = ");
    assert!(warnings(&pendulum(0.3, ""), "", Some(&blocks)).is_empty());
}

/// Folders with an experiment below `folder`.
fn experiments(folder: &Path, found: &mut Vec<PathBuf>) {
    for path in std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()).filter(|path| path.is_dir()) {
        // the FMUs of that example are made by its script
        if path.join("experiment.toml").is_file() && !path.ends_with("fmi/joint") {
            found.push(path.clone());
        }
        experiments(&path, found);
    }
}

/// Folders of all experiments of the repository.
fn shipped() -> Vec<PathBuf> {
    let mut scenes = Vec::new();
    let root = repository_scene("acrobot").join("../..");
    for folder in ["scenes", "models", "examples"] {
        experiments(&root.join(folder), &mut scenes);
    }
    assert!(scenes.len() > 100);
    scenes
}

#[test]
fn every_recorded_column_of_a_shipped_scene_has_a_unit() {
    let mut without = Vec::new();
    for scene in shipped() {
        let loaded = sincro::load(&scene, &[]).unwrap_or_else(|found| panic!("{}: {found}", scene.display()));
        let entries = loaded.controller.as_ref().map(ControlDiagram::entries).unwrap_or_default();
        let recorder = Recorder::new(&loaded.experiment.record, &loaded.scene.model, &entries).unwrap();
        let recorder = recorder.with_units(&loaded.experiment.units);
        let columns = recorder.columns().filter(|(_, unit)| unit.is_empty());
        without.extend(columns.map(|(name, _)| format!("{}: {name}", scene.display())));
    }
    assert!(without.is_empty(), "declare `unit` in the diagram, or `units` in the experiment: {without:#?}");
}

#[test]
fn no_shipped_scene_is_warned_of_what_it_means() {
    let scenes = shipped();
    let silent = ["nothing uses", "can touch nothing", "fixed in the world: it never", "has a path of the form"];
    let mut said = Vec::new();
    for scene in scenes {
        let loaded = sincro::load(&scene, &[]).unwrap_or_else(|found| panic!("{}: {found}", scene.display()));
        let of_files = loaded.warnings.iter().map(|warning| warning.message.clone());
        let of_files = of_files.filter(|message| silent.iter().any(|known| message.contains(known)));
        let of_loop = unstable_loop(&loaded).map(|found| found.to_string());
        // one sample too late is what that scene shows; the ground of the example is there to be seen
        let name = scene.file_name().unwrap().to_string_lossy().into_owned();
        let of_loop = of_loop.filter(|_| name != "quadrotor-latency");
        let of_files = of_files.filter(|message| name != "quadricopter" || !message.starts_with("`ground`"));
        said.extend(of_files.chain(of_loop).map(|message| format!("{}: {message}", scene.display())));
    }
    assert!(said.is_empty(), "{said:#?}");
}
