//! Classes of MJCF defaults: actuators of several kinds in one class and in nested ones, their order, and errors.
//! Figures are those of MuJoCo 4.0.0.

use crate::folder::{Folder, entry};

/// A hinge with an actuator.
fn with_actuator(defaults: &str, actuator: &str) -> String {
    format!(
        r#"<mujoco><compiler angle="radian"/>{defaults}<worldbody>
<body name="b"><joint name="j" axis="0 0 1" range="-2 1"/><geom size="0.1" mass="2" pos="0.3 0 0"/><site name="s"/>
</body></worldbody><actuator>
{actuator}
</actuator></mujoco>"#
    )
}

const GENERAL: &str = r#"<general gainprm="5" biastype="affine" biasprm="1 -2 -3" dyntype="filter" dynprm="0.3"/>"#;
const POSITION: &str = r#"<position kp="3" kv="2" timeconst="0.4"/>"#;

/// A shortcut takes the numbers of its own kind or of a `general`, from the nearest class.
#[test]
fn a_shortcut_inherits_the_nearest_class_that_has_its_numbers() {
    let class = |inner: &str| format!(r#"<default class="q">{inner}</default>"#);
    // −bias of length and rate; time constant of the activation, zero for an integrator
    for (outer, inner, actuator, law, lag) in [
        (format!("{GENERAL}<position kp=\"7\"/>"), "", "velocity", [0.0, 1.0], None),
        (r#"<general gainprm="5"/><velocity kv="7"/>"#.into(), "", "intvelocity", [1.0, 0.0], Some(0.0)),
        (GENERAL.into(), "<velocity/>", "position", [5.0, 3.0], None),
        (GENERAL.into(), "<velocity/>", "cylinder", [2.0, 3.0], Some(0.3)),
        (GENERAL.into(), "<velocity/>", "general", [0.0, 5.0], None),
        (POSITION.into(), r#"<general gainprm="5"/>"#, "cylinder", [3.0, 2.0], Some(0.4)),
        (POSITION.into(), r#"<velocity kv="9"/>"#, "position", [3.0, 2.0], Some(0.4)),
        (POSITION.into(), r#"<velocity kv="9"/><intvelocity kp="8"/>"#, "position", [3.0, 2.0], Some(0.4)),
        (POSITION.into(), r#"<general gaintype="affine" gainprm="6"/>"#, "position", [3.0, 2.0], Some(0.4)),
        (POSITION.into(), "<motor/>", "general", [0.0, 0.0], None),
        (r#"<velocity kv="4"/>"#.into(), r#"<general gainprm="5"/>"#, "position", [5.0, 4.0], None),
        (r#"<velocity kv="4"/>"#.into(), "<general/>", "position", [4.0, 4.0], None),
        (
            r#"<general dyntype="filterexact" dynprm="0.2" biasprm="0 0 -3" gainprm="5" actdim="1"/>"#.into(),
            "",
            "position",
            [5.0, 3.0],
            Some(0.2),
        ),
    ] {
        let defaults = format!("<default>{outer}{}</default>", class(inner));
        let folder = Folder::new();
        let text = with_actuator(&defaults, &format!(r#"<{actuator} joint="j" class="q"/>"#));
        let imported = folder.import("m.xml", &text).unwrap_or_else(|found| panic!("{found}"));
        let model = folder.open(&imported).scene.model;
        let motor = model.motors().first().map(|motor| [motor.stiffness, motor.damping]);
        let found = motor.unwrap_or_else(|| {
            let law = &model.spring_dampers()[0].law;
            [law.stiffness, law.damping]
        });
        let time = model.activations().first().map(|own| own.time_constant().unwrap_or(0.0));
        assert_eq!((found, time), (law, lag), "{actuator} after {defaults}");
    }
}

/// A class is a copy of the one around it, as that is where the class stands.
#[test]
fn later_defaults_do_not_change_classes_that_are_there() {
    let folder = Folder::new();
    let defaults =
        r#"<default><default class="q"/></default><default><position kp="3"/><joint damping="2"/></default>"#;
    let text =
        with_actuator(defaults, r#"<position joint="j" class="q"/>"#).replace(r#"name="j""#, r#"name="j" class="q""#);
    let imported = folder.import("m.xml", &text).unwrap_or_else(|found| panic!("{found}"));
    let model = folder.open(&imported).scene.model;
    assert_eq!((model.motors()[0].stiffness, model.dofs()[0].damping), (1.0, 0.0));
}

/// Each of them is refused by MuJoCo, too, except for the numbers of a muscle.
#[test]
fn contradicting_classes_are_refused_by_line() {
    let motor = r#"<motor joint="j"/>"#;
    for (defaults, actuator, line, words) in [
        (r#"<default class="x"/>"#, motor, 1, "the outermost class of defaults is `main`"),
        ("<default><default/></default>", motor, 1, "a class of defaults has no name"),
        (r#"<default><default class="q"/><default class="q"/></default>"#, motor, 1, "two classes of defaults"),
        ("", r#"<motor joint="j" class="z"/>"#, 4, "there is no class of defaults `z`"),
        // of a class that nothing uses, too
        (
            r#"<default><general ctrlrange="-1 1" inheritrange="1"/><default class="q"><position/></default></default>"#,
            motor,
            1,
            "`ctrlrange` and `inheritrange` are both given",
        ),
        (
            r#"<default><dcmotor motorconst="0.3" resistance="2" saturation="3"/><motor forcerange="0 0"/></default>"#,
            r#"<intvelocity joint="j"/>"#,
            4,
            "`forcelimited` says that it limits",
        ),
        (r#"<default><damper kv="-1"/></default>"#, motor, 1, "`kv` is negative"),
        (r#"<default><general gainprm="-1"/><adhesion/></default>"#, motor, 1, "`gain` is negative"),
        ("", r#"<general joint="j" actdim="1"/>"#, 4, "`actdim` is 1"),
        (r#"<default><damper kv="1"/></default>"#, motor, 4, "`ctrllimited` says that it limits"),
        (
            "<default><muscle/></default>",
            r#"<general joint="j" gaintype="fixed" biastype="none" dyntype="none"/>"#,
            4,
            "its class gives it numbers of a `muscle`",
        ),
        (
            r#"<default><dcmotor motorconst="0.3" resistance="2" saturation="3"/></default>"#,
            motor,
            4,
            "its class gives it numbers of a `dcmotor`",
        ),
        (
            r#"<default><joint damping="1 2"/></default>"#,
            r#"<motor joint="j"/><!-- the second number counts -->"#,
            2,
            "`damping` of joint `j` depends on the rate",
        ),
    ] {
        let text = with_actuator(defaults, actuator).replace(r#"name="j""#, r#"name="j" damping="3""#);
        let why = Folder::new().import("m.xml", &text).map(|_| ()).unwrap_err().to_string();
        assert!(why.contains(words) && why.contains(&format!("m.xml:{line}:")), "{defaults}: {why}");
    }
}

#[test]
fn flags_of_a_range_follow_the_last_element_that_sets_them() {
    let folder = Folder::new();
    let defaults =
        r#"<default><general dyntype="filter" actlimited="false" actrange="-0.1 0.1" biasprm="0 -1"/></default>"#;
    let imported = folder.import("m.xml", &with_actuator(defaults, r#"<cylinder joint="j"/>"#));
    let model = folder.open(&imported.unwrap_or_else(|found| panic!("{found}"))).scene.model;
    // a shortcut says no more that it does not limit
    assert_eq!(model.activations()[0].range, [-0.1, 0.1]);
    let text = with_actuator("", r#"<intvelocity joint="j" actrange="-0.1 0.1" actlimited="false"/>"#);
    let imported = folder.import("n.xml", &text).unwrap_or_else(|found| panic!("{found}"));
    assert_eq!(folder.open(&imported).scene.model.activations()[0].range, [-0.1, 0.1]);
    let text = with_actuator("", motor_with_range());
    let text = text.replace("<compiler ", r#"<compiler autolimits="false" "#).replace(r#" range="-2 1""#, "");
    let why = Folder::new().import("m.xml", &text).map(|_| ()).unwrap_err().to_string();
    assert!(why.contains("neither `ctrllimited` nor `autolimits`"), "{why}");
}

fn motor_with_range() -> &'static str {
    r#"<motor joint="j" ctrlrange="-1 1"/>"#
}

/// Sizes, gears and coefficients that an element leaves out are those of its class.
#[test]
fn an_element_overwrites_the_first_numbers_of_its_class() {
    let folder = Folder::new();
    let defaults = r#"<default><motor gear="1 0 0 0 0 6"/><geom type="capsule" size="0.2 0.5"/></default>"#;
    let imported = folder.import("m.xml", &with_actuator(defaults, r#"<motor name="m" site="s" gear="7"/>"#));
    let imported = imported.unwrap_or_else(|found| panic!("{found}"));
    let words = &entry(&imported, "motor[m]").words;
    assert!(words.contains("force [7.0, 0.0, 0.0] N, torque [0.0, 0.0, 6.0] N·m"), "{words}");
    // a half of 0.5 from the class
    let scene = imported.scene();
    assert!(scene.contains("radius = 0.1") && scene.contains("length = 1"), "{scene}");
}

/// M and passive force of MuJoCo: 0.188 kg·m² and the armature, by the square of the gear and of the tendon.
#[test]
fn armature_and_damping_of_actuators_are_those_of_the_joint() {
    let tendon = r#"<tendon><fixed name="t"><joint joint="j" coef="-3"/></fixed></tendon></mujoco>"#;
    for (actuator, armature, damping) in [
        (r#"<motor joint="j" armature="2" damping="3" gear="2"/>"#, 8.0, 12.0),
        (r#"<motor tendon="t" armature="2" damping="3" gear="2"/>"#, 72.0, 108.0),
        (r#"<motor joint="j" armature="2" damping="3" gear="0"/>"#, 0.0, 0.0),
    ] {
        let folder = Folder::new();
        let text = with_actuator("", actuator).replace("</mujoco>", tendon);
        let imported = folder.import("m.xml", &text).unwrap_or_else(|found| panic!("{found}"));
        let model = folder.open(&imported).scene.model;
        assert_eq!((model.dofs()[0].armature, model.dofs()[0].damping), (armature, damping), "{actuator}");
    }
    // the damping of a ratio is 2·1·√(3·8.188/4), MuJoCo's −4.95620823
    let folder = Folder::new();
    let text = with_actuator("", r#"<position joint="j" armature="2" gear="2" kp="3" dampratio="1"/>"#);
    let imported = folder.import("m.xml", &text).unwrap_or_else(|found| panic!("{found}"));
    let damping = folder.open(&imported).scene.model.motors()[0].damping / 4.0;
    assert!((damping - 4.956_208_23).abs() < 1e-8, "{damping}");
    for (actuator, words) in [
        (r#"<motor joint="j" damping="3 1"/>"#, "`damping` of an actuator is a polynomial"),
        (r#"<motor joint="j" armature="-1"/>"#, "`armature` of an actuator is negative"),
        (r#"<motor site="s" armature="1"/>"#, "acts on what is not one joint"),
    ] {
        let why = Folder::new().import("m.xml", &with_actuator("", actuator)).map(|_| ()).unwrap_err().to_string();
        assert!(why.contains(words) && why.contains("m.xml:4:"), "{why}");
    }
}

/// MuJoCo's tendon_lengthspring is 2·springref; the reference is no matter.
#[test]
fn a_spring_of_a_tendon_rests_where_those_of_its_joints_do() {
    let tendon = r#"<tendon><fixed name="t" stiffness="3"><joint joint="j" coef="2"/></fixed></tendon></mujoco>"#;
    for (joint, rest) in [(r#"springref="0.5" ref="0.2""#, 0.6), (r#"ref="0.2""#, -0.4), ("", 0.0)] {
        let folder = Folder::new();
        let text = with_actuator("", "").replace("</mujoco>", tendon);
        let text = text.replace(r#"name="j""#, &format!(r#"name="j" {joint}"#));
        let imported = folder.import("m.xml", &text).unwrap_or_else(|found| panic!("{found}"));
        let found = folder.open(&imported).scene.model.spring_dampers()[0].free_length;
        assert!((found - rest).abs() < 1e-15, "{joint}: {found}");
    }
}

/// MuJoCo's principal moments: 1.14051248, 1 and 0.4; 13/6 each.
#[test]
fn bounds_are_those_of_principal_moments() {
    for (compiler, inertial, expected) in [
        (
            r#"boundinertia="0.4""#,
            r#"fullinertia="1 1 0.5 0 0.3 0""#,
            // 0.75 ± √(0.25² + 0.3²) in x and z, of which the lower one is 0.4
            {
                let (root, sum) = (f64::hypot(0.25, 0.3), 0.75);
                let (high, low) = (sum + root, 0.4);
                let (cc, ss) = (0.5 * (1.0 + 0.25 / root), 0.5 * (1.0 - 0.25 / root));
                [high * cc + low * ss, 0.0, (high - low) * 0.5 * 0.3 / root, 1.0, 0.0, high * ss + low * cc]
            },
        ),
        (r#"balanceinertia="true""#, r#"diaginertia="1 2 3.5""#, [13.0 / 6.0, 0.0, 0.0, 13.0 / 6.0, 0.0, 13.0 / 6.0]),
        (r#"balanceinertia="true""#, r#"diaginertia="1 2 3""#, [1.0, 0.0, 0.0, 2.0, 0.0, 3.0]),
    ] {
        let text = format!(
            r#"<mujoco><compiler {compiler}/><worldbody><body name="b"><joint name="j"/>
<inertial pos="0 0 0" mass="1" {inertial}/></body></worldbody></mujoco>"#
        );
        let imported = Folder::new().import("m.xml", &text).unwrap_or_else(|found| panic!("{found}"));
        let inertia = imported.scene().split("inertia = {").nth(1).unwrap().split('}').next().unwrap();
        for (key, x) in ["xx", "xy", "xz", "yy", "yz", "zz"].iter().zip(expected) {
            let given = inertia.split(',').filter_map(|part| part.split_once('='));
            let found = given
                .filter(|(name, _)| name.trim() == *key)
                .map(|(_, x)| x.trim().parse::<f64>().unwrap())
                .sum::<f64>();
            assert!((found - x).abs() < 1e-12, "{compiler} {key}: {found}, not {x}");
        }
    }
}

/// MuJoCo's M of the hinge about z through (−0.101, 0): 0.023 + 0.589 (0.305² + 0.366²).
#[test]
fn a_body_that_has_only_a_bound_of_mass_has_it_where_mujoco_does() {
    let text = r#"<mujoco><compiler inertiafromgeom="false" boundmass="0.589" boundinertia="0.023"/><worldbody>
<body name="b" pos="0.204 -0.366 0.313"><joint name="j" pos="-0.101 0 0.2"/><geom size="0.1"/></body></worldbody></mujoco>"#;
    let imported = Folder::new().import("m.xml", text).unwrap_or_else(|found| panic!("{found}"));
    assert!(imported.scene().contains("center_of_mass = [0.204, -0.366, 0.313]"), "{}", imported.scene());
    assert!(entry(&imported, "body[b]").words.contains("its centre of mass is where its `pos` is"));
}

/// The nearest orientation counts, whichever attribute gives it; two on one element are refused.
#[test]
fn an_orientation_takes_the_place_of_another_one_of_the_class() {
    let of = |class: &str, own: &str| {
        let text = with_actuator(&format!("<default><geom {class}/></default>"), r#"<motor joint="j"/>"#);
        let text = text.replace(r#"<geom size="0.1""#, &format!(r#"<geom type="capsule" size="0.1 0.2" {own}"#));
        Folder::new().import("m.xml", &text).map(|imported| imported.scene().to_owned())
    };
    let kinds = [
        r#"quat="0.5 0.5 -0.5 0.5""#,
        r#"euler="0.3 0.2 0.1""#,
        r#"axisangle="1 0 1 0.7""#,
        r#"xyaxes="1 0.2 0 0 1 0.3""#,
        r#"zaxis="0.3 0.4 0.5""#,
    ];
    for (class, own) in kinds.iter().flat_map(|class| kinds.iter().map(move |own| (class, own))) {
        assert_eq!(of(class, own).unwrap(), of("", own).unwrap(), "{own} after {class}");
    }
    let why = of("", &format!("{} {}", kinds[0], kinds[1])).unwrap_err().to_string();
    assert!(why.contains("more than one orientation"), "{why}");
}

/// A `pid` has two controls, and as many activations as it has states.
#[test]
fn keyframes_count_the_controls_of_each_kind() {
    let folder = Folder::new();
    let text = with_actuator("", r#"<pid joint="j" ki="2"/><motor name="m" joint="j"/>"#)
        .replace("</mujoco>", r#"<keyframe><key name="k" ctrl="0 0 0.5" act="0"/></keyframe></mujoco>"#);
    let imported = folder.import("m.xml", &text).unwrap_or_else(|found| panic!("{found}"));
    assert!(!entry(&imported, "key[k]").words.contains("left out"), "{}", entry(&imported, "key[k]").words);
}
