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
