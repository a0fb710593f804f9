//! Actuators, tendons and keyframes of MJCF: ranges, defaults, and frames. Figures are those of MuJoCo 4.0.0.

use sincro_dynamics::kinematics;
use sincro_dynamics::scratch::Scratch;
use sincro_dynamics::spatial::Pose;
use sincro_import::Imported;
use sincro_import::export::{Format, export};
use sincro_scene::fmu::Loaders;
use sincro_scene::open::open;
use sincro_scene::scene::Scene;

use crate::folder::{Folder, entry};
use crate::mjcf::actuated;

const ALL: [f64; 2] = [f64::NEG_INFINITY, f64::INFINITY];

/// Imports the chain of three hinges with actuators.
fn imported(actuators: &str) -> (Folder, Imported) {
    let folder = Folder::new();
    let imported = folder.import("m.xml", &actuated(actuators)).unwrap_or_else(|found| panic!("{found}"));
    (folder, imported)
}

fn refused(text: &str) -> String {
    Folder::new().import("m.xml", text).map(|_| ()).unwrap_err().to_string()
}

#[test]
fn activations_whose_range_excludes_zero_start_at_its_nearest_end() {
    for (actuator, start) in [
        (r#"<general name="m" joint="j0" dyntype="integrator" gainprm="-2" actrange="0.5 3"/>"#, -1.0),
        (r#"<general name="m" joint="j0" dyntype="filter" gainprm="2" actrange="-3 -0.5"/>"#, -1.0),
        (r#"<cylinder name="m" tendon="t" area="4" actrange="0.25 3"/>"#, 1.0),
        (r#"<position name="m" joint="j1" kp="5" timeconst="0.1" actrange="0.5 1"/>"#, 0.5),
        (r#"<intvelocity name="m" joint="j1" kp="5" actrange="-1 -0.5"/>"#, -0.5),
    ] {
        let (folder, imported) = imported(actuator);
        let scene = folder.open(&imported).scene;
        assert_eq!((scene.model.activations()[0].initial, &scene.initial.rotors[..]), (start, &[start][..]));
        let words = &entry(&imported, "[m]").words;
        assert!(words.contains("starts at the end of its range, since zero is outside"), "{words}");
    }
}

/// MuJoCo's ranges are those of the joint with its `ref`: control and activation are within −0.25 to 1.25.
#[test]
fn inherited_ranges_are_those_of_what_the_actuator_acts_on() {
    let with_reference = |actuator: &str| {
        let text = actuated(actuator).replace(r#"name="j1" axis="0 1 0""#, r#"name="j1" axis="0 1 0" ref="0.25""#);
        text.replace(r#"<fixed name="t""#, r#"<fixed name="t" range="-3 1""#)
    };
    let ranges = |actuator: &str| {
        let folder = Folder::new();
        let imported = folder.import("m.xml", &with_reference(actuator)).unwrap_or_else(|found| panic!("{found}"));
        let own = folder.open(&imported).scene.model.activations()[0];
        (own.range, own.input_range)
    };
    let over_gear = [-0.25 / 2.0 - 0.25, 1.25 / 2.0 - 0.25];
    let (range, input) = ranges(r#"<intvelocity joint="j1" gear="2" kp="8" inheritrange="0.5"/>"#);
    assert_eq!((range, input), (over_gear, ALL));
    let (range, input) = ranges(r#"<position joint="j1" gear="2" kp="8" timeconst="0.1" inheritrange="0.5"/>"#);
    assert_eq!((range, input), (ALL, over_gear));
    // half of the range of a tendon, as forces of 8 N/m
    let (range, input) = ranges(r#"<intvelocity tendon="t" kp="8" inheritrange="0.5"/>"#);
    assert_eq!((range, input), ([-16.0, 0.0], ALL));
    // degrees are converted where the range limits
    for (limited, unit) in [("", std::f64::consts::PI / 180.0), (" limited=\"false\"", 1.0)] {
        let text = actuated(r#"<intvelocity joint="j1" kp="8" inheritrange="1"/>"#)
            .replace("radian", "degree")
            .replace(r#" range="-1 2""#, &format!(" range=\"-1 2\"{limited}"));
        let folder = Folder::new();
        let range = folder.open(&folder.import("m.xml", &text).unwrap()).scene.model.activations()[0].range;
        for (found, end) in range.iter().zip([-1.0, 2.0]) {
            assert!((found - end * unit).abs() < 1e-15, "{limited}: {range:?}");
        }
    }
    let unlimited = ranges(r#"<intvelocity joint="j1" kp="8"/>"#);
    assert_eq!(unlimited, (ALL, ALL));

    // without activation a command has no limits here
    let (_, servo) = imported(r#"<position name="m" joint="j1" inheritrange="0.5"/>"#);
    let words = &entry(&servo, "position[m]").words;
    assert!(words.contains("the range of its control, from -0.25 to 1.25, is left out"), "{words}");
    let (_, servo) = imported(r#"<position name="m" joint="j1" ctrlrange="-1 1"/>"#);
    let words = &entry(&servo, "position[m]").words;
    assert!(words.contains("the range of its control, from -1 to 1, is left out"), "{words}");

    for (actuator, words) in [
        (r#"<position joint="j1" inheritrange="1"/>"#, "`inheritrange` needs a range of joint `j1`, which has none"),
        (r#"<intvelocity joint="j1" inheritrange="1"/>"#, "`inheritrange` needs a range of joint `j1`"),
        (r#"<intvelocity tendon="t" inheritrange="1"/>"#, "`inheritrange` needs a range of its tendon"),
    ] {
        let text = actuated(actuator).replace(r#" range="-1 2""#, "");
        assert!(refused(&text).contains(words), "{actuator}: {}", refused(&text));
    }
}

#[test]
fn empty_ranges_limit_nothing_unless_they_are_said_to() {
    for (actuator, words) in [
        (r#"<motor name="m" joint="j0" ctrlrange="0 0"/>"#, None),
        (r#"<motor name="m" joint="j0" ctrlrange="1 -1" forcerange="0 0"/>"#, None),
        (r#"<motor name="m" joint="j0" ctrlrange="0 0" ctrllimited="true"/>"#, Some("`ctrlrange` is no range")),
        (r#"<motor name="m" joint="j0" forcelimited="true"/>"#, Some("`forcerange` is no range")),
        (
            r#"<general name="m" joint="j0" dyntype="integrator" actrange="0 0" actlimited="true"/>"#,
            Some("`actrange` is no range, and `actlimited` says"),
        ),
    ] {
        match words {
            None => {
                let (folder, imported) = imported(actuator);
                let motor = folder.open(&imported).scene.model.motors()[0];
                assert_eq!(motor.max_torque, f64::INFINITY, "{actuator}");
            }
            Some(words) => assert!(refused(&actuated(actuator)).contains(words), "{actuator}"),
        }
    }
    let with_tendon = |range: &str| {
        let text = actuated(r#"<motor name="m" tendon="t"/>"#);
        text.replace(r#"<fixed name="t""#, &format!(r#"<fixed name="t" {range}"#))
    };
    for range in [r#"range="0 0""#, r#"range="1 -1" limited="auto""#, r#"range="-1 1" limited="false""#] {
        let folder = Folder::new();
        let imported = folder.import("m.xml", &with_tendon(range)).unwrap_or_else(|found| panic!("{found}"));
        assert!(!entry(&imported, "fixed[t]").words.contains("stops with"), "{range}");
    }
    let stops =
        Folder::new().import("m.xml", &with_tendon(r#"range="-1 1""#)).unwrap_or_else(|found| panic!("{found}"));
    assert!(entry(&stops, "fixed[t]").words.contains("stops with"));
    for range in [r#"range="1 1" limited="true""#, r#"limited="true""#] {
        let why = refused(&with_tendon(range));
        assert!(why.contains("`range` is no range, and `limited` says that it limits"), "{why}");
    }
    let (folder, of_activation) =
        imported(r#"<general name="m" joint="j0" dyntype="integrator" actrange="0 0" ctrlrange="0 0"/>"#);
    let own = folder.open(&of_activation).scene.model.activations()[0];
    assert_eq!((own.range, own.input_range), (ALL, ALL));
    // ends that differ are told
    let (_, one_sided) = imported(r#"<motor name="m" joint="j0" ctrlrange="0 1"/>"#);
    let words = &entry(&one_sided, "motor[m]").words;
    assert!(words.contains("`ctrlrange` has two ends that differ"), "{words}");
}

#[test]
fn actuators_that_exert_no_force_are_left_out_by_name() {
    for (actuator, words) in [
        (r#"<motor name="m" joint="j0" gear="0"/>"#, "its `gear` is 0"),
        (r#"<general name="m" joint="j0" gainprm="0"/>"#, "its gain is 0"),
        (r#"<general name="m" joint="j0" gainprm="0" dyntype="integrator" actrange="-1 1"/>"#, "its gain is 0"),
        (r#"<cylinder name="m" tendon="t" area="0" actrange="-1 1"/>"#, "its gain is 0"),
        (r#"<motor name="m" tendon="t" gear="0"/>"#, "its `gear` is 0"),
        (r#"<position name="m" joint="j0" dampratio="1" gear="0"/>"#, "its `gear` is 0"),
    ] {
        let (folder, imported) = imported(actuator);
        assert!(entry(&imported, "[m]").words.contains(words), "{actuator}: {}", entry(&imported, "[m]").words);
        assert!(imported.warnings.iter().any(|w| w.to_string().contains(words)), "{actuator}");
        assert!(folder.open(&imported).scene.model.motors().is_empty());
    }
    // a spring that no control moves
    let spring = r#"<general name="m" joint="j0" gainprm="0" biastype="affine" biasprm="0 -8 -1" dyntype="filter" dynprm="0.1" actrange="-1 1"/>"#;
    let (folder, imported) = imported(spring);
    let model = folder.open(&imported).scene.model;
    assert_eq!((model.motors()[0].stiffness, model.activations().len()), (8.0, 0));
}

/// Gain and bias that MuJoCo compiles, of a kind after another one in the defaults.
#[test]
fn kinds_of_actuators_share_their_defaults() {
    let general = r#"<general gainprm="5" biastype="affine" biasprm="0 -4 -2" dyntype="filter" dynprm="0.3"/>"#;
    let position = r#"<position kp="7" kv="3" timeconst="0.2"/>"#;
    // stiffness, damping, and time constant of the activation
    for (defaults, kind, servo, lag) in [
        (position, "general", (7.0, 3.0), Some(0.2)),
        (position, "position", (7.0, 3.0), Some(0.2)),
        (position, "motor", (0.0, 0.0), None),
        (position, "velocity", (0.0, 1.0), None),
        (general, "general", (4.0, 2.0), Some(0.3)),
        (general, "motor", (0.0, 0.0), None),
        (general, "position", (5.0, 2.0), None),
        (general, "velocity", (0.0, 5.0), None),
        (general, "cylinder", (4.0, 2.0), Some(0.3)),
        (r#"<position kp="7"/><motor/>"#, "general", (0.0, 0.0), None),
        (r#"<motor/><position kp="7"/>"#, "general", (7.0, 0.0), None),
        (r#"<velocity kv="7"/>"#, "general", (0.0, 7.0), None),
        (r#"<velocity kv="7"/>"#, "position", (1.0, 0.0), None),
        (r#"<muscle/>"#, "position", (1.0, 0.0), None),
    ] {
        let text = actuated(&format!("<{kind} name=\"m\" joint=\"j0\"/>"))
            .replace("<worldbody>", &format!("<default>{defaults}</default><worldbody>"));
        let folder = Folder::new();
        let imported = folder.import("m.xml", &text).unwrap_or_else(|found| panic!("{found}"));
        let model = folder.open(&imported).scene.model;
        let motor = model.motors().first().map(|motor| (motor.stiffness, motor.damping));
        // a damper is a tendon
        let own = motor.unwrap_or_else(|| (0.0, model.spring_dampers()[0].law.damping));
        let time = model.activations().first().and_then(sincro_dynamics::actuation::Activation::time_constant);
        assert_eq!((own, time), (servo, lag), "{kind} after {defaults}");
    }
    let text =
        actuated(r#"<general name="m" joint="j0"/>"#).replace("<worldbody>", "<default><muscle/></default><worldbody>");
    let imported = Folder::new().import("m.xml", &text).unwrap();
    assert!(entry(&imported, "general[m]").words.contains("of type `muscle`"), "{}", entry(&imported, "[m]").words);
}

/// MuJoCo's `actuator_biasprm[2]` of these actuators.
#[test]
fn a_damping_ratio_is_a_damping_with_the_inertia_at_the_reference() {
    for (actuator, damping, gear) in [
        (r#"<position name="m" joint="j0" kp="3" dampratio="0.7"/>"#, 0.484_974_226_119_286, 1.0),
        (r#"<position name="m" joint="j1" kp="3" gear="-2" dampratio="1"/>"#, 0.154_919_333_848_296_81, 2.0),
        (r#"<intvelocity name="m" joint="j2" kp="5" dampratio="1"/>"#, 0.338_061_701_891_406_66, 1.0),
        (r#"<position name="m" tendon="t" kp="5" gear="2" dampratio="1"/>"#, 0.178_885_438_199_983_2, 2.0),
        (
            r#"<general name="m" joint="j0" gainprm="3" biastype="affine" biasprm="0 -3 0.7"/>"#,
            0.484_974_226_119_286,
            1.0,
        ),
    ] {
        let (folder, imported) = imported(actuator);
        let model = folder.open(&imported).scene.model;
        let motor = model.motors().first().map(|motor| motor.damping);
        let found = motor.unwrap_or_else(|| model.spring_dampers()[0].law.damping) / (gear * gear);
        assert!((found - damping).abs() < 1e-12 * damping, "{actuator}: {found}");
        assert!(entry(&imported, "[m]").words.contains("its damping ratio is a damping of"));
    }
}

/// MuJoCo has the coefficients 0.1, 1, 0, 0, 0.
#[test]
fn a_short_polynomial_keeps_the_slope_of_one() {
    for equality in [
        r#"<joint joint1="j1" joint2="j0" polycoef="0.1"/>"#,
        r#"<tendon tendon1="one" tendon2="two" polycoef="0.1"/>"#,
    ] {
        let text = actuated("").replace("</mujoco>", &format!("<equality>{equality}</equality></mujoco>")).replace(
            "</tendon>",
            r#"<fixed name="one"><joint joint="j1" coef="1"/></fixed><fixed name="two"><joint joint="j0" coef="1"/></fixed></tendon>"#,
        );
        let folder = Folder::new();
        let model = folder.open(&folder.import("m.xml", &text).unwrap()).scene.model;
        match model.constraints().gears.first() {
            Some(gear) => assert_eq!((gear.offset, gear.ratio, gear.higher), (0.1, 1.0, [0.0; 3])),
            None => {
                let held = &model.spring_dampers()[0];
                let shares: Vec<f64> = held.shares().iter().map(|share| share.coefficient).collect();
                assert_eq!((shares, held.free_length), (vec![1.0, -1.0], 0.1));
            }
        }
    }
}

/// With a control of 3 MuJoCo has after 3 s an activation of 3 and a force of 12 N: the control is clamped to 1, which
/// is a rate.
#[test]
fn the_control_of_an_activation_on_a_tendon_bounds_no_force() {
    let (folder, imported) =
        imported(r#"<general name="m" tendon="t" gainprm="4" dyntype="integrator" ctrlrange="-1 1"/>"#);
    let model = folder.open(&imported).scene.model;
    let element = &model.spring_dampers()[0];
    assert_eq!(element.actuator.unwrap().max_force, f64::INFINITY);
    let own = model.activations()[0];
    assert_eq!((own.rate(0.0, 12.0, 0.0), own.input_range), (4.0, [-4.0, 4.0]));
    assert_eq!(own.saturated(3.0 * own.rate(0.0, 12.0, 0.0)), 12.0);
}

#[test]
fn friction_and_armature_of_a_tendon_of_one_joint_are_those_of_the_joint() {
    let with = |tendon: &str| actuated("").replace("</tendon>", &format!("{tendon}</tendon>"));
    let folder = Folder::new();
    let text = with(
        r#"<fixed name="own" frictionloss="0.3" armature="0.5"><joint joint="j1" coef="-2"/></fixed>
<fixed name="more" frictionloss="0.1"><joint joint="j1" coef="0.5"/></fixed>"#,
    )
    .replace(r#"name="j1" axis"#, r#"name="j1" armature="0.25" frictionloss="0.75" axis"#);
    let imported = folder.import("m.xml", &text).unwrap_or_else(|found| panic!("{found}"));
    let dof = folder.open(&imported).scene.model.dofs()[1];
    assert_eq!((dof.armature, dof.friction.sliding), (0.25 + 0.5 * 4.0, 0.75 + 0.3 * 2.0 + 0.1 * 0.5));
    assert!(entry(&imported, "fixed[own]").words.contains("its `armature` is that of joint `j1`, by 2"));
    // nothing slides along a length that is held
    let text =
        with(r#"<fixed name="f" frictionloss="1"><joint joint="j0" coef="1"/><joint joint="j1" coef="1"/></fixed>"#)
            .replace("</mujoco>", r#"<equality><tendon tendon1="f"/></equality></mujoco>"#);
    let imported = folder.import("m.xml", &text).unwrap_or_else(|found| panic!("{found}"));
    assert!(entry(&imported, "fixed[f]").words.contains("an equality holds its length"));
    let loose = text.replace("tendon1=\"f\"", "tendon1=\"f\" active=\"false\"");
    assert!(refused(&loose).contains("of several joints"));
    for (tendon, words) in [
        (
            r#"<fixed name="f" frictionloss="1"><joint joint="j0" coef="1"/><joint joint="j1" coef="1"/></fixed>"#,
            "joints",
        ),
        (r#"<spatial armature="1"><site site="a"/><site site="b"/></spatial>"#, "through sites"),
    ] {
        let text = with(tendon)
            .replace(r#"<body name="b0""#, r#"<site name="a"/><site name="b" pos="1 0 0"/><body name="b0""#);
        let why = refused(&text);
        assert!(why.contains("of a tendon ") && why.contains(words) && why.contains("m.xml:2:"), "{why}");
    }
}

/// MuJoCo's `jnt_stiffness` and `dof_damping`.
#[test]
fn springs_that_are_tuned_have_the_armatures_of_tendons() {
    let text = r#"<mujoco><worldbody><body name="b"><joint name="j" axis="0 0 1" springdamper="0.1 1"/>
<geom size="0.1" mass="2" pos="0.3 0 0"/><body name="c" pos="1 0 0.2"><joint name="k" axis="0 0.3 1" ref="30"/>
<geom type="box" size="0.1 0.2 0.3" mass="1" pos="0.2 0.1 0"/></body></body></worldbody>
<tendon><fixed armature="2"><joint joint="j" coef="1"/></fixed></tendon></mujoco>"#;
    let folder = Folder::new();
    let imported = folder.import("m.xml", text).unwrap_or_else(|found| panic!("{found}"));
    let dof = folder.open(&imported).scene.model.dofs()[0];
    let close = |found: f64, wanted: f64| (found - wanted).abs() < 1e-12 * wanted;
    assert!(
        close(dof.stiffness, 268.408_735_213_830_65) && close(dof.damping, 53.681_747_042_766_14),
        "{} {}",
        dof.stiffness,
        dof.damping
    );
}

#[test]
fn tendons_that_are_none_are_told_once_with_the_reason() {
    for (parts, words) in [
        ("", "a fixed tendon has no joint"),
        (r#"<joint joint="x" coef="1"/>"#, "there is no joint `x`"),
        (r#"<joint joint="j0" coef="1"/><joint joint="j0" coef="2"/>"#, "joint `j0` stands twice"),
    ] {
        let tendon = format!(r#"<fixed name="f" armature="1" frictionloss="1">{parts}</fixed></tendon>"#);
        let why = refused(&actuated("").replace("</tendon>", &tendon));
        assert!(why.matches("error").count() == 1 && why.contains(words) && why.contains("m.xml:2:"), "{why}");
    }
}

#[test]
fn keyframes_have_commands_and_activations() {
    let keys = r#"<keyframe><key name="k" qpos="0.1 0.2 0.3" ctrl="0.5 2 -1 0.25" act="0.75 -3 0.5"/>
<key name="few" act="1"/><key name="none"/></keyframe></mujoco>"#;
    let text = actuated(
        r#"<general name="a" joint="j0" gear="2" dyntype="filter" dynprm="0.1"/>
<muscle name="b" joint="j2"/>
<intvelocity name="c" joint="j1" kp="4" gear="2" actrange="-1 0.25"/>
<motor name="d" tendon="t" gear="3"/>"#,
    )
    .replace("</mujoco>", keys)
    .replace(r#"name="j1" axis="0 1 0""#, r#"name="j1" axis="0 1 0" ref="0.25""#);
    let folder = Folder::new();
    let imported = folder.import("m.xml", &text).unwrap_or_else(|found| panic!("{found}"));
    let opened = folder.open(&imported);
    let variants = opened.experiment.variants;
    assert_eq!(variants.iter().map(|v| v.name.as_str()).collect::<Vec<_>>(), ["k"]);
    let scene = with_settings(&folder, &imported, &variants[0].set);
    assert_eq!(scene.initial.q, [0.1, 0.2 - 0.25, 0.3]);
    // torque; rate of an angle; force
    let commands: Vec<f64> = scene.commands.iter().map(|command| command.value(0.0)).collect();
    assert_eq!(commands, [1.0, -0.5, 0.75]);
    assert_eq!(scene.initial.rotors, [1.5, 0.25 / 2.0 - 0.25]);
    let words = &entry(&imported, "key[k]").words;
    for part in ["`act` of an actuator without", "`ctrl` of an actuator that is no motor", "beyond its range"] {
        assert!(words.contains(part), "{words}");
    }
    assert!(entry(&imported, "key[few]").words.contains("`act` has 1 numbers, not 3"));
    assert_eq!(entry(&imported, "key[none]").words, "it sets nothing that is here");
}

/// Values of the commands at the start.
fn commands(scene: &Scene) -> Vec<f64> {
    scene.commands.iter().map(|command| command.value(0.0)).collect()
}

/// MuJoCo's `actuator_force` of a control of 2 and a rate of 0.5 of the joint, and of a `ctrl` of 2 in a keyframe.
#[test]
fn a_velocity_servo_of_a_joint_takes_its_control() {
    let key = r#"<keyframe><key name="k" ctrl="2"/></keyframe></mujoco>"#;
    for (actuator, damping, command) in [
        (r#"<velocity name="m" joint="j1" kv="3"/>"#, 3.0, 6.0),
        (r#"<velocity name="m" joint="j1" kv="3" gear="-2"/>"#, 12.0, -12.0),
        (r#"<velocity name="m" joint="j1" kv="3" ctrlrange="-1 1" forcerange="-4 4"/>"#, 3.0, 3.0),
        (r#"<general name="m" joint="j1" gainprm="5" biastype="affine" biasprm="0 0 -3"/>"#, 3.0, 10.0),
        (r#"<general name="m" joint="j1" gainprm="5" biastype="affine" biasprm="0.5 0 -3"/>"#, 3.0, 10.0),
    ] {
        let folder = Folder::new();
        let text = actuated(actuator).replace("</mujoco>", key);
        let imported = folder.import("m.xml", &text).unwrap_or_else(|found| panic!("{found}"));
        let set = folder.open(&imported).experiment.variants[0].set.clone();
        let scene = with_settings(&folder, &imported, &set);
        let law = &scene.model.spring_dampers()[0].law;
        assert_eq!((law.stiffness, law.damping), (0.0, damping), "{actuator}");
        assert_eq!((law.preload != 0.0, commands(&scene)), (actuator.contains("0.5"), vec![command]), "{actuator}");
        let words = &entry(&imported, "[m]").words;
        assert!(words.contains("a [[tendon]] of joint `j1`, a spring and damper with an actuator"), "{words}");
        assert_eq!(words.contains("`forcerange` is left out"), actuator.contains("forcerange"), "{words}");
    }
    // a constant is a preload
    let (folder, constant) =
        imported(r#"<general name="m" joint="j1" gainprm="2" biastype="affine" biasprm="0.5 -4 -3" gear="-2"/>"#);
    let model = folder.open(&constant).scene.model;
    let law = &model.spring_dampers()[0].law;
    assert_eq!((law.stiffness, law.damping, law.preload.abs()), (16.0, 12.0, 1.0));
    // beside a position servo, and with an activation
    let (folder, both) = imported(
        r#"<position name="p" joint="j1" kp="2"/><velocity name="m" joint="j1" kv="3"/>
<general name="lag" joint="j1" gainprm="5" biastype="affine" biasprm="0 0 -3" dyntype="filter" dynprm="0.1"/>"#,
    );
    let model = folder.open(&both).scene.model;
    let dampings: Vec<f64> = model.spring_dampers().iter().map(|element| element.law.damping).collect();
    assert_eq!((model.motors()[0].stiffness, dampings, model.activations().len()), (2.0, vec![3.0, 3.0], 1));
    // without gain there is no control
    let (folder, damper) =
        imported(r#"<general name="m" joint="j1" gainprm="0" biastype="affine" biasprm="0 0 -3" dyntype="filter"/>"#);
    let model = folder.open(&damper).scene.model;
    assert_eq!((model.motors()[0].damping, model.activations().len()), (3.0, 0));
    let words = &entry(&damper, "[m]").words;
    assert!(words.contains("its gain is 0, and it has no command") && !words.contains("activation"), "{words}");
}

/// MuJoCo clamps a control where it acts, that of zero at the start, too.
#[test]
fn controls_beyond_their_range_are_at_its_end() {
    for (actuator, start, of_key) in [
        (r#"<motor name="m" joint="j1" ctrlrange="0.2 1"/>"#, 0.2, 0.2),
        (r#"<motor name="m" joint="j1" ctrlrange="-3 -2" gear="2"/>"#, -4.0, -6.0),
        (r#"<motor name="m" tendon="t" ctrlrange="0.2 1" gear="3"/>"#, 0.2 * 3.0, 0.2 * 3.0),
        (r#"<position name="m" joint="j1" kp="5" ctrlrange="0.2 1"/>"#, 0.2 - 0.25, 0.2 - 0.25),
        (r#"<position name="m" joint="j1" kp="5" ctrlrange="-1 1"/>"#, -0.25, -1.0 - 0.25),
        (r#"<position name="m" joint="j1" kp="5" ctrlrange="-1 1" ctrllimited="false"/>"#, -0.25, -5.0 - 0.25),
        (r#"<position name="m" joint="j1" kp="5" inheritrange="1"/>"#, -0.25, -1.0 - 0.25),
        (r#"<intvelocity name="m" joint="j1" kp="5" gear="2" ctrlrange="0.5 1"/>"#, 0.25, 0.25),
        (r#"<motor name="m" joint="j1" ctrlrange="-1 1"/>"#, 0.0, -1.0),
    ] {
        let folder = Folder::new();
        let text = actuated(actuator)
            .replace("</mujoco>", r#"<keyframe><key name="k" ctrl="-5"/></keyframe></mujoco>"#)
            .replace(r#"name="j1" axis="0 1 0""#, r#"name="j1" axis="0 1 0" ref="0.25""#);
        let imported = folder.import("m.xml", &text).unwrap_or_else(|found| panic!("{found}"));
        let opened = folder.open(&imported);
        assert_eq!(commands(&opened.scene), [start], "{actuator}");
        let varied = with_settings(&folder, &imported, &opened.experiment.variants[0].set);
        assert_eq!(commands(&varied), [of_key], "{actuator}");
        let excludes_zero = actuator.contains(r#"="0."#) || actuator.contains("-3 -2");
        let words = &entry(&imported, "[m]").words;
        assert_eq!(words.contains("its control starts at"), excludes_zero, "{words}");
        let words = &entry(&imported, "key[k]").words;
        assert_eq!(words.contains("a control of -5 is beyond its `ctrlrange`"), !actuator.contains("false"), "{words}");
    }
    let text = actuated(r#"<motor name="m" site="s" ctrlrange="0.2 1"/>"#)
        .replace(r#"<body name="b0""#, r#"<site name="s"/><body name="b0""#);
    let words = entry(&Folder::new().import("m.xml", &text).unwrap(), "motor[m]").words.clone();
    assert!(words.contains("the force starts at zero, not at that of a control of 0.2"), "{words}");
}

/// MuJoCo's `actuator_actnum`.
#[test]
fn activations_of_a_keyframe_are_counted_as_in_mujoco() {
    for (actuator, n) in [
        (r#"<dcmotor joint="j1" motorconst="0.1" resistance="1"/>"#, 0),
        (r#"<dcmotor joint="j1" motorconst="0.1" resistance="1" inductance="0.1" lugre="0.1 0 0"/>"#, 2),
        (r#"<dcmotor joint="j1" motorconst="0.1" resistance="1" input="pos" controller="1 0.5 0.1 2"/>"#, 2),
        (r#"<general joint="j1" dyntype="user" actdim="3"/>"#, 3),
        (r#"<general joint="j1" dyntype="user"/>"#, 1),
        (r#"<muscle joint="j1"/>"#, 1),
        (r#"<damper joint="j1" kv="1" ctrlrange="0 1"/>"#, 0),
        (r#"<motor joint="j1"/>"#, 0),
    ] {
        let activations = vec!["0"; n].join(" ") + " 0.5";
        let key = format!(r#"<keyframe><key name="k" qpos="0 0 0" act="{activations}"/></keyframe></mujoco>"#);
        let all = format!(r#"{actuator}<general name="m" joint="j0" dyntype="filter"/>"#);
        let folder = Folder::new();
        let imported = folder.import("m.xml", &actuated(&all).replace("</mujoco>", &key)).unwrap();
        let set = folder.open(&imported).experiment.variants[0].set.clone();
        let scene = with_settings(&folder, &imported, &set);
        assert_eq!(scene.initial.rotors, [0.5], "{actuator}: {}", entry(&imported, "key[k]").words);
    }
}

/// MuJoCo has the rotations of the joints as none.
#[test]
fn a_quaternion_of_zeros_in_a_keyframe_is_no_rotation() {
    let text = r#"<mujoco><worldbody><body name="b"><freejoint name="f"/><geom size="0.1" mass="2"/>
<body name="c" pos="0 0 1"><joint name="ball" type="ball"/><geom size="0.1" mass="1" pos="0.2 0 0"/></body></body></worldbody>
<keyframe><key name="zero" qpos="0 0 1 0 0 0 0 0 0 0 0"/><key name="half" qpos="0 0 1 2 0 0 0 0 3 0 0"/></keyframe></mujoco>"#;
    let folder = Folder::new();
    let imported = folder.import("m.xml", text).unwrap_or_else(|found| panic!("{found}"));
    let variants = folder.open(&imported).experiment.variants;
    let zero = with_settings(&folder, &imported, &variants[0].set).initial.q;
    assert_eq!(zero, [0.0, 0.0, 1.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0]);
    let half = with_settings(&folder, &imported, &variants[1].set).initial.q;
    assert_eq!(half[7..], [0.0, 1.0, 0.0, 0.0]);
    assert!(entry(&imported, "key[zero]").words.contains("a quaternion of zeros is no rotation"));
    assert!(!entry(&imported, "key[half]").words.contains("zeros"));
}

/// The scene of an import with settings of a variant.
fn with_settings(folder: &Folder, imported: &Imported, set: &[sincro_scene::overrides::Override]) -> Scene {
    let path = folder.path().join("varied");
    imported.write(&path).unwrap();
    open(&path, set, Loaders::default(), true).unwrap_or_else(|found| panic!("{found}")).scene
}

/// Pose of a body at the start.
fn stands(scene: &Scene, ending: &str) -> Pose<f64> {
    let model = &scene.model;
    let mut scratch = Scratch::new(model);
    kinematics::poses(model, &scene.initial.q, &mut scratch);
    let info = model.names().frames.iter().find(|frame| frame.name.ends_with(ending)).unwrap();
    scratch.link_poses()[info.link.unwrap()].compose(&info.pose)
}

/// Frames of the scene are not those of the file: a keyframe places the bodies where the file alone has them.
#[test]
fn keyframes_place_bodies_in_frames_of_custom_data_as_without() {
    let joint = |name: &str, kind: &str, parent: &str| {
        format!(
            "[[joint]]\nname = \"{name}\"\nkind = \"{kind}\"\n{parent}position = [0.1, -0.3, 0.2]\nrotation_deg = [20.0, 40.0, -70.0]\n"
        )
    };
    let body = |name: &str, parent: &str| {
        format!(
            "[[body]]\nname = \"{name}\"\nparent = \"{parent}\"\nposition = [0.3, 0.2, -0.1]\nrotation_deg = [-30.0, 10.0, 50.0]\nmass = 1.0\ninertia = {{ xx = 0.1, yy = 0.1, zz = 0.1 }}\n"
        )
    };
    let scene = [
        "gravity = [0.0, 0.0, -9.8]\n".to_owned(),
        joint("loose", "free", ""),
        body("trunk", "/loose"),
        joint("hip", "ball", "parent = \"/loose/trunk\"\n"),
        body("leg", "/loose/trunk/hip"),
        joint("knee", "revolute", "parent = \"/loose/trunk/hip/leg\"\naxis = [0.0, 1.0, 0.0]\n"),
        body("foot", "/loose/trunk/hip/leg/knee"),
    ]
    .concat();
    let folder = Folder::new();
    folder.file("own/scene.toml", &scene);
    folder.file("own/experiment.toml", "title = \"own\"\nduration = 0.1\nstep = 1e-3\nrecord = [\"energy.total\"]\n");
    let own = open(&folder.path().join("own"), &[], Loaders::default(), true).unwrap_or_else(|found| panic!("{found}"));
    let text = export(&own.scene, "own", Format::Mjcf).unwrap().text;
    let key = r#"<keyframe><key name="k" qpos="1 2 3 0.5 -0.5 0.5 0.5 0.6 0 0.64 -0.48 0.7"/></keyframe></mujoco>"#;
    let text = text.replace("</mujoco>", key);
    let (start, end) = (text.find("<custom>").unwrap(), text.find("</custom>").unwrap());
    let plain = format!("{}{}", &text[..start], &text[end + "</custom>".len()..]);
    let places = [&text, &plain].map(|text| {
        let imported = folder.import("robot.xml", text).unwrap_or_else(|found| panic!("{found}"));
        let set = folder.open(&imported).experiment.variants[0].set.clone();
        let scene = with_settings(&folder, &imported, &set);
        ["/trunk", "/leg", "/foot"].map(|name| stands(&scene, name))
    });
    for (own, wanted) in places[0].iter().zip(&places[1]) {
        let turned = own.rot.transpose().mul(&wanted.rot);
        let error = (0..3).map(|k| (turned.0[k][k] - 1.0).abs()).fold((own.pos - wanted.pos).norm(), f64::max);
        assert!(error < 1e-12, "{own:?} {wanted:?}");
    }
}

#[test]
fn a_height_field_is_one_file_however_often_it_stands() {
    let row = |y: usize| (0..100).map(|x| format!("{}", (x * 7 + y * 3) % 11)).collect::<Vec<_>>().join(" ");
    let elevation: String = (0..100).map(|y| row(y) + " ").collect();
    let geoms = |n: usize| -> String {
        (0..n).map(|k| format!("<geom type=\"hfield\" hfield=\"h\" pos=\"{k} 0 0\"/>")).collect()
    };
    let text = |n: usize| {
        format!(
            r#"<mujoco><asset><hfield name="h" nrow="100" ncol="100" size="1 2 0.6 0.1" elevation="{elevation}"/></asset>
<worldbody>{}<body name="b" pos="0 0 3"><freejoint/><geom size="0.1"/></body></worldbody></mujoco>"#,
            geoms(n)
        )
    };
    let folder = Folder::new();
    let few = folder.import("m.xml", &text(3)).unwrap();
    assert_eq!(few.scene().matches("file = \"meshes/h.csv\"").count(), 3, "{}", few.scene());
    folder.open(&few);
    assert_eq!(std::fs::read_dir(folder.path().join("scene/meshes")).unwrap().count(), 1);
    // a million heights in all
    let many = folder.import("m.xml", &text(200)).unwrap();
    assert_eq!(many.scene().matches("height_field").count(), (1 << 20) / 10_000);
    assert!(many.warnings.iter().any(|w| w.to_string().contains("more than 1048576 heights")), "{:?}", many.warnings);
    assert!(many.scene().len() < 100_000);
}

#[test]
fn actuators_on_sites_with_activations_or_springs_are_left_out_by_name() {
    for (actuator, words) in [
        (r#"<general name="m" site="s" dyntype="integrator"/>"#, "its activation has no counterpart on a site"),
        (r#"<position name="m" site="s" kp="2"/>"#, "has no counterpart on a site"),
        (r#"<general name="m" site="s" gainprm="0"/>"#, "its gain is 0"),
        (r#"<motor name="m" site="s" gear="0 0 0 0 0 0"/>"#, "its `gear` is 0"),
        (
            r#"<position name="m" site="s" kp="2" dampratio="1"/>"#,
            "its bias [0.0, -2.0, 0.0] has no counterpart on a site",
        ),
        (r#"<muscle name="m" tendon="t"/>"#, "a `muscle` has no counterpart"),
    ] {
        let text = actuated(actuator).replace(r#"<body name="b0""#, r#"<site name="s"/><body name="b0""#);
        let imported = Folder::new().import("m.xml", &text).unwrap_or_else(|found| panic!("{found}"));
        let told = imported.warnings.iter().map(ToString::to_string).find(|told| told.contains(words));
        assert!(told.is_some_and(|told| told.contains("m.xml:3:")), "{actuator}: {:?}", imported.warnings);
    }
}
