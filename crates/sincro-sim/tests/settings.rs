//! `--set PATH=VALUE`: what it reaches, and what is said when it does not.

use std::sync::Arc;

use sincro_dynamics::signal::Signal;
use sincro_scene::overrides::Override;
use sincro_scene::scene::ObjectKind;
use sincro_sim::Extensions;
use sincro_sim::load;
use sincro_testing::scenes;

/// Setting, and what is said.
const REFUSED: &[(&str, &str)] = &[
    (
        "step=0.5.5",
        r#"--set:1:6: error: `step`: `0.5.5` is not a number: column 1: `0.5.` is not a number
  help: a number, or a formula of the parameters: `k`"#,
    ),
    (
        "/elbow.mass=2",
        r#"--set:1:1: error: there is no object `/elbow`
  help: objects: `/shoulder`, `/shoulder/rod/tip/wrist`, `/shoulder/rod`, `/shoulder/rod/tip/wrist/hand`, `/shoulder/rod/tip`"#,
    ),
    (
        "/shoulder.masss=2",
        r#"--set:1:1: error: `/shoulder.masss`: `/shoulder` has no `masss`
  help: keys: `axis`, `axis2`, `limits`, `force_sensor`, `motor`, `spring`, `position`, `rotation_deg` and 8 more"#,
    ),
    (
        "/shoulder.sprng.stiffness=2",
        r#"--set:1:1: error: `/shoulder.sprng.stiffness`: `/shoulder` has no `sprng`
  help: did you mean `spring`? keys: `spring`, `damping`, `force_sensor`, `rotation_deg`, `quaternion_wxyz`, `kind`, `pitch`, `torque` and 8 more"#,
    ),
    (
        "wrist.mass=2",
        r#"--set:1:1: error: `/shoulder/rod/tip/wrist.mass`: `/shoulder/rod/tip/wrist` has no `mass`
  help: keys: `axis`, `axis2`, `limits`, `motor`, `spring`, `position`, `force_sensor`, `rotation_deg` and 8 more"#,
    ),
    (
        "k=3",
        r#"--set:1:1: error: `k`: a scene or experiment has no `k`
  help: did you mean `parameters.k`?"#,
    ),
    (
        "stpe=0.1",
        r#"--set:1:1: error: `stpe`: a scene or experiment has no `stpe`
  help: did you mean `step`? keys: `step`, `stop_when`, `seed`, `scene`, `sweep`, `title`, `rest_speed`, `script` and 39 more"#,
    ),
    (
        "/shoulder=2",
        r#"--set:1:1: error: the path names an object, none of its keys
  help: keys: `armature`, `axis`, `axis2`, `damping`, `force_sensor`, `friction`, `initial`, `kind` and 10 more"#,
    ),
    (
        "/shoulder/rod.inertia.xx=2",
        r#"--set:1:1: error: `yy` is missing in `inertia`
  help: `yy`: Moment about y [kg·m²].
--set:1:1: error: `zz` is missing in `inertia`
  help: `zz`: Moment about z [kg·m²]."#,
    ),
    (
        "parameters.m=2",
        r#"--set:1:1: error: there is no `m` in `parameters`
  help: known: `k`"#,
    ),
    (
        "parameters.k=x",
        r#"--set:1:14: error: `k`: `x` is not a number: column 1: unknown name `x`
  help: a number, or a formula such as "pi/6"; [parameters] of the experiment give it names"#,
    ),
    (
        "/shoulder.axis.3=1",
        r#"--set:1:1: error: `/shoulder.axis.3` has 3 entries, there is no entry 3
  help: entries are counted from 0"#,
    ),
    (
        "/shoulder/rod.mass=-1",
        r#"--set:1:20: error: `mass` is -1, expected a number in kg, greater than 0
  help: With `inertia`, or with shapes that say how it is distributed [kg]."#,
    ),
    (
        "record=3",
        r#"--set:1:8: error: `record` is the number 3, expected a list of strings
  help: Names of the signals to be recorded, such as `/shoulder.position` or `energy.total`."#,
    ),
    (
        "integrator=rk5",
        r#"--set:1:12: error: `integrator` is "rk5", expected one of `auto`, `semi-implicit-euler`, `rk4`, `implicit`, `dormand-prince`, `dormand-prince-8`, `stiff`
  help: did you mean `rk4`?"#,
    ),
    (
        "integrator",
        r#"--set:1:1: error: `integrator` has no `=`
  help: write PATH=VALUE, such as /shoulder.spring.stiffness=30 or step=0.001"#,
    ),
    (
        "/shoulder.motor.command.step.time=1",
        r#"--set:1:1: error: `to` is missing in `step`
  help: `to`: Value from `time` on.
--set:1:1: error: `mode` is missing in `motor`
  help: `mode`: What it does with its command."#,
    ),
    (
        "/shoulder.spring={stiffness=",
        r#"--set:1:18: error: `{stiffness=` is not a TOML value
  help: numbers, [lists], { tables = 1 }, "strings" or bare words"#,
    ),
    (
        "gravity.x=1",
        r#"--set:1:1: error: `gravity.x`: `gravity` has no `x`
  help: keys: `acceleration`, `potential`"#,
    ),
    (
        "/shoulder.initial.position.1=3",
        r#"--set:1:1: error: `position` has no `1` in the file as it is
  help: set `position` as a whole"#,
    ),
    (
        "=3",
        r#"--set:1:1: error: `=3` has no path before the `=`
  help: write PATH=VALUE, such as /shoulder.spring.stiffness=30 or step=0.001"#,
    ),
    (
        "step=",
        r#"--set:1:1: error: `step=` has no value after the `=`
  help: write PATH=VALUE, such as /shoulder.spring.stiffness=30 or step=0.001"#,
    ),
    (
        "sweep.range.too=3",
        r#"--set:1:1: error: `sweep.range.too`: `range` has no `too`
  help: did you mean `to`? keys: `from`, `step`, `to`"#,
    ),
    (
        "/shoulder/rod/tip/wrist.motor.command.ramp.slop=3",
        r#"--set:1:1: error: `/shoulder/rod/tip/wrist.motor.command.ramp.slop`: `ramp` has no `slop`
  help: did you mean `slope`? keys: `from`, `slope`, `start`, `until`"#,
    ),
    (
        "/shoulder/rod/tip/wrist.axis.0=nan",
        r#"--set:1:1: error: `axis` is not in the file
  help: set `axis` as a whole"#,
    ),
];

#[test]
fn settings_that_reach_nothing_are_refused() {
    let folder = scenes::sprung_arm();
    let mut wrong = Vec::new();
    for (setting, expected) in REFUSED {
        let said = folder.load(&[setting]).expect_err(setting);
        if said != *expected {
            wrong.push(format!("{setting}\nfound\n{said}\nexpected\n{expected}\n"));
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn settings_reach_scene_and_experiment() {
    let folder = scenes::sprung_arm();
    let settings = [
        "/shoulder.spring.stiffness=12.5",
        "/shoulder.axis[1]=-1",
        "/shoulder.initial.velocity=3",
        "/shoulder/rod.shape.0.cylinder.length=1.0",
        "/shoulder/rod/tip/wrist/hand.mass=0.25",
        "/shoulder/rod/tip/wrist/hand.inertia.xy=1e-5",
        "/shoulder/rod/tip/wrist.motor.command={ step = { to = 2.0 } }",
        "/shoulder/rod/tip/wrist.motor.max_torque=inf",
        "/shoulder/rod/tip/wrist.spring.stiffness=7",
        "gravity.2=-1.62",
        "integrator=rk4",
        "parameters.k=2",
        "step = 0.02",
        "sweep.range.to=20.0",
    ];
    let loaded = folder.load(&settings).unwrap();
    let (scene, experiment) = (&loaded.scene, &loaded.experiment);
    assert_eq!(scene.model.dofs()[0].stiffness, 12.5);
    assert_eq!(scene.model.dofs()[1].stiffness, 7.0);
    assert_eq!(scene.initial.v, [3.0, 0.0]);
    assert_eq!(scene.model.gravity().0, [0.0, 0.0, -1.62]);
    assert_eq!(scene.commands, [Signal::Step { time: 0.0, from: 0.0, to: 2.0 }]);
    let rod = std::f64::consts::PI * 0.05 * 0.05 * 1000.0;
    assert!((scene.model.total_mass() - (rod + 0.25)).abs() < 1e-12);
    assert_eq!(experiment.integrator.word(), "rk4");
    assert_eq!((experiment.step, experiment.n_steps), (0.02, 50));
    assert_eq!(experiment.checks[0].parameters[..], [("k".to_owned(), 2.0)]);
    assert_eq!(experiment.sweep.as_ref().unwrap().values, [10.0, 20.0]);
}

#[test]
fn what_the_file_leaves_out_can_be_set() {
    let folder = scenes::sprung_arm();
    folder.change("scene.toml", "gravity = [0.0, 0.0, -9.81]\n", "");
    let loaded = folder.load(&["gravity.2=-3.7", "/shoulder/rod/tip.position.0=0.1"]).unwrap();
    assert_eq!(loaded.scene.model.gravity().0, [0.0, 0.0, -3.7]);
    assert_eq!(loaded.scene.object("/shoulder/rod/tip").unwrap().pose.pos.0, [0.1, 0.0, 0.5]);
}

#[test]
fn the_last_setting_wins() {
    let loaded = scenes::sprung_arm().load(&["/shoulder.damping=1", "/shoulder.damping=2"]).unwrap();
    assert_eq!(loaded.scene.model.dofs()[0].damping, 2.0);
}

#[test]
fn a_variant_is_the_experiment_with_its_settings() {
    let folder = scenes::sprung_arm();
    let variant = folder.load(&[]).unwrap().experiment.variants[0].clone();
    let loaded = load(&folder, &variant.set, Extensions::default()).unwrap();
    assert_eq!(loaded.scene.model.dofs()[0].stiffness, 10.0);
    assert_eq!(loaded.experiment.integrator.word(), "rk4");
}

#[test]
fn a_sweep_sets_its_parameter() {
    let folder = scenes::sprung_arm();
    let sweep = folder.load(&[]).unwrap().experiment.sweep.unwrap();
    assert_eq!(sweep.values, [10.0, 20.0, 30.0]);
    let loaded = load(&folder, &sweep.settings(1e-7).collect::<Vec<_>>(), Extensions::default()).unwrap();
    assert_eq!(loaded.scene.model.dofs()[0].stiffness, 1e-7);
}

/// Who shortens a run to look at it has made no mistake; the checks of the rest cannot be made.
#[test]
fn a_shorter_run_loads_although_checks_look_beyond_it() {
    let loaded = scenes::sprung_arm().load(&["duration=0.1"]).unwrap();
    assert_eq!(loaded.experiment.n_steps, 10);
}

#[test]
fn another_scene_can_be_set() {
    let folder = scenes::sprung_arm();
    folder.write("other.toml", &scenes::SPRUNG_ARM.replace("damping = 0.5", "damping = 0.25"));
    assert_eq!(folder.load(&["scene=other.toml"]).unwrap().scene.model.dofs()[0].damping, 0.25);
}

#[test]
fn nothing_pasted_makes_it_fall_over() {
    let folder = scenes::sprung_arm();
    let paths =
        ["/", "//", "/.", ".", "..", "[", "]", "[[0]]", "/shoulder[", "/shoulder..", "é", "record.0.x", "check.0.x.y"];
    let deep = "{ a = ".repeat(500) + "1" + &" }".repeat(500);
    for path in paths.into_iter().chain(["/shoulder.axis", "parameters", "check", "joint", "joint.0", "body.0.shape"]) {
        for value in ["1", "[]", "{}", "inf", "\"", "é", "[[1]]", "{ a = 1 }", &deep] {
            let _ = load(&folder, &[Override::new(path, value)], Extensions::default());
        }
    }
}

#[test]
fn sources_are_all_files_that_were_read() {
    let loaded = scenes::sprung_arm().load(&[]).unwrap();
    let names: Vec<_> = loaded.sources.iter().map(|s| s.path.file_name().unwrap().to_str().unwrap()).collect();
    assert_eq!(names, ["experiment.toml", "reference.csv", "scene.toml"]);
    assert!(Arc::strong_count(&loaded.sources[0]) >= 1);
    let body = loaded.scene.object("/shoulder/rod").unwrap();
    assert!(matches!(body.kind, ObjectKind::Body { .. }));
}
