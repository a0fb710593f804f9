//! Defaults of MJCF: which elements they are for, and what an element takes of them. Figures are those of MuJoCo 4.0.0.

use crate::folder::{Folder, entry};

/// Two hinges, with a tendon of each and an equality between them.
fn with_tendons(defaults: &str, equalities: &str) -> String {
    format!(
        r#"<mujoco><compiler angle="radian"/><default>{defaults}</default><worldbody>
<body name="b"><joint name="j" axis="0 0 1"/><geom size="0.1" mass="2" pos="0.3 0 0"/>
<body name="c" pos="0.3 0 0"><joint name="k" axis="0 0 1"/><geom size="0.1" mass="1"/></body></body></worldbody>
<tendon><fixed name="t"><joint joint="j" coef="1"/></fixed>
<fixed name="u" class="q"><joint joint="k" coef="2"/></fixed></tendon>
<equality>{equalities}</equality></mujoco>"#
    )
}

#[test]
fn tendons_of_all_kinds_have_the_defaults_of_tendons() {
    let defaults = r#"<tendon stiffness="3" damping="0.5" armature="0.2" frictionloss="0.1" springlength="0.3"/>
<joint stiffness="0"/><default class="q"><tendon stiffness="4"/></default>"#;
    let folder = Folder::new();
    let imported = folder.import("m.xml", &with_tendons(defaults, "")).unwrap_or_else(|found| panic!("{found}"));
    let model = folder.open(&imported).scene.model;
    let laws: Vec<_> = model.spring_dampers().iter().map(|e| (e.law.stiffness, e.law.damping, e.free_length)).collect();
    assert_eq!(laws, [(3.0, 0.5, 0.3), (4.0, 0.5, 0.3)]);
    let dofs: Vec<_> = model.dofs().iter().map(|dof| (dof.armature, dof.friction.sliding)).collect();
    assert_eq!(dofs, [(0.2, 0.1), (0.2 * 4.0, 0.1 * 2.0)]);
}

#[test]
fn equalities_have_the_defaults_of_equalities() {
    let defaults = r#"<equality active="false"/><tendon frictionloss="0.4"/>
<default class="q"><equality active="true" solref="-50 -3"/></default>"#;
    let equalities = r#"<tendon name="held" tendon1="u" class="q"/><joint name="gear" joint1="j" joint2="k"/>"#;
    let folder = Folder::new();
    let text = with_tendons(defaults, equalities);
    let imported = folder.import("m.xml", &text).unwrap_or_else(|found| panic!("{found}"));
    assert!(entry(&imported, "joint[gear]").words.contains("it is not active"));
    // the tendon slides no more where the equality holds it
    let words = &entry(&imported, "fixed[u]").words;
    assert!(words.contains("an equality holds its length"), "{words}");
    let model = folder.open(&imported).scene.model;
    assert!(model.constraints().gears.is_empty());
    let held = &model.spring_dampers()[0].law;
    assert!((held.stiffness / held.damping - 50.0 / 3.0).abs() < 1e-12, "{held:?}");
}

/// A hinge with a range, and an actuator.
fn with_actuator(defaults: &str, actuator: &str) -> String {
    format!(
        r#"<mujoco><compiler angle="radian"/><default>{defaults}</default><worldbody>
<body name="b"><joint name="j" axis="0 0 1" range="-2 1"/><geom size="0.1" mass="2" pos="0.3 0 0"/></body>
</worldbody><actuator>{actuator}</actuator></mujoco>"#
    )
}

/// MuJoCo's `actuator_ctrlrange` and `actuator_actrange`.
#[test]
fn of_inherited_and_given_ranges_the_later_one_counts() {
    let all = [f64::NEG_INFINITY, f64::INFINITY];
    let (own, inherited) = ([-0.1, 0.2], [-2.0, 1.0]);
    let outer = r#"<position inheritrange="1"/>"#;
    let class = |inner: &str| format!(r#"{outer}<default class="q">{inner}</default>"#);
    let lagged = r#"<position joint="j" timeconst="0.1" class="q"/>"#;
    let rated = r#"<intvelocity inheritrange="1"/>"#;
    for (defaults, actuator, input, range) in [
        (outer.to_owned(), r#"<position joint="j" timeconst="0.1" ctrlrange="-0.1 0.2"/>"#, own, all),
        (outer.to_owned(), r#"<position joint="j" timeconst="0.1" ctrlrange="0 0"/>"#, all, all),
        (outer.to_owned(), r#"<position joint="j" timeconst="0.1" inheritrange="0"/>"#, all, all),
        (outer.to_owned(), r#"<position joint="j" timeconst="0.1" ctrllimited="false"/>"#, all, all),
        (class(r#"<position ctrlrange="-0.1 0.2"/>"#), lagged, own, all),
        (
            r#"<position ctrlrange="-0.1 0.2"/><default class="q"><position inheritrange="1"/></default>"#.to_owned(),
            lagged,
            inherited,
            all,
        ),
        (outer.to_owned(), r#"<general joint="j" dyntype="filterexact" ctrlrange="-0.1 0.2"/>"#, inherited, all),
        (outer.to_owned(), r#"<general joint="j" dyntype="integrator"/>"#, all, inherited),
        (outer.to_owned(), r#"<general joint="j" dyntype="filter" gainprm="3"/>"#, all, all),
        (outer.to_owned(), r#"<intvelocity joint="j"/>"#, all, all),
        (rated.to_owned(), r#"<intvelocity joint="j" actrange="-0.1 0.2"/>"#, all, own),
        (rated.to_owned(), r#"<intvelocity joint="j" ctrlrange="-0.1 0.2"/>"#, own, inherited),
        (rated.to_owned(), r#"<general joint="j" dyntype="filterexact"/>"#, inherited, all),
    ] {
        let folder = Folder::new();
        let imported =
            folder.import("m.xml", &with_actuator(&defaults, actuator)).unwrap_or_else(|found| panic!("{found}"));
        let found = folder.open(&imported).scene.model.activations()[0];
        assert_eq!((found.input_range, found.range), (input, range), "{actuator} after {defaults}");
    }
}

/// MuJoCo refuses each of them.
#[test]
fn contradicting_parameters_of_actuators_are_refused() {
    let class = r#"<position inheritrange="1"/><default class="q"><general ctrlrange="-0.1 0.2"/></default>"#;
    for (defaults, actuator, words) in [
        (
            "",
            r#"<position joint="j" inheritrange="1" ctrlrange="-1 1"/>"#,
            "`ctrlrange` and `inheritrange` are both given",
        ),
        ("", r#"<intvelocity joint="j" inheritrange="1" actrange="-1 1"/>"#, "`actrange` and `inheritrange` are both"),
        (class, r#"<position joint="j" class="q"/>"#, "`ctrlrange` and `inheritrange` are both given"),
        ("", r#"<position joint="j" kv="0" dampratio="0"/>"#, "`kv` and `dampratio` are both given"),
        ("", r#"<intvelocity joint="j" kv="1" dampratio="1"/>"#, "`kv` and `dampratio` are both given"),
        ("", r#"<position joint="j" dampratio="-1"/>"#, "`dampratio` is negative"),
        ("", r#"<general joint="j" actrange="-1 1"/>"#, "`actrange` is given, and it has no activation"),
        ("", r#"<motor joint="j" inheritrange="1"/>"#, "a `motor` has no `inheritrange`"),
        (
            r#"<position inheritrange="1"/>"#,
            r#"<general joint="j" dyntype="filter"/>"#,
            "its activation `filter` does not",
        ),
    ] {
        let text = with_actuator(defaults, actuator);
        let why = Folder::new().import("m.xml", &text).map(|_| ()).unwrap_err().to_string();
        assert!(why.contains(words) && why.contains("m.xml:3:"), "{actuator}: {why}");
    }
    // a damper is no ratio, and zeros are no range
    for (defaults, actuator) in [
        (r#"<position kv="1"/>"#, r#"<position joint="j" dampratio="1"/>"#),
        ("", r#"<position joint="j" inheritrange="1" ctrlrange="0 0"/>"#),
        ("", r#"<position joint="j" inheritrange="0" ctrlrange="-1 1"/>"#),
        (r#"<dcmotor motorconst="0.3" resistance="1"/>"#, r#"<motor joint="j"/>"#),
    ] {
        let text = with_actuator(defaults, actuator);
        let folder = Folder::new();
        let imported = folder.import("m.xml", &text).unwrap_or_else(|found| panic!("{found}"));
        assert_eq!(folder.open(&imported).scene.model.motors().len(), 1, "{actuator}");
    }
    let of_dcmotor = with_actuator(r#"<dcmotor motorconst="0.3" resistance="1"/>"#, r#"<general name="m" joint="j"/>"#);
    let imported = Folder::new().import("m.xml", &of_dcmotor).unwrap_or_else(|found| panic!("{found}"));
    assert!(entry(&imported, "general[m]").words.contains("its gain is of type `dcmotor`"));
}
