//! Contact, stops and closures that cannot be.
//!
//! Each case changes one thing in the folder of the sprung arm and states the whole message.

use sincro_testing::scenes::refused;

/// Replacement of the last body of the scene, and expected message.
const CASES: &[(&str, &str)] = &[
    (
        "contact = { friction = -0.1 }\nshape = [ { sphere = { radius = 0.1 } } ]",
        r#"scene.toml:33:24: error: `friction` is -0.1, expected a number, at least 0
  help: Coulomb's coefficient, sliding and sticking."#,
    ),
    (
        "contact = { restitution = 1.5 }\nshape = [ { sphere = { radius = 0.1 } } ]",
        r#"scene.toml:33:27: error: `restitution` is 1.5, expected 0 to 1
  help: above 1 an impact would add energy"#,
    ),
    (
        "contact = { dissipation = 0.5 }\nshape = [ { sphere = { radius = 0.1 } } ]",
        r#"scene.toml:33:13: error: `dissipation` has no meaning for a rigid contact
  help: give `stiffness` [N/m] too, or `restitution` instead"#,
    ),
    (
        "contact = {}",
        r#"scene.toml:33:1: error: body `hand` has a contact and no shape
  help: give it the shapes that touch"#,
    ),
    (
        "shape = [ { plane = {} } ]\ncontact = {}",
        r#"scene.toml:29:8: error: body `/shoulder/rod/tip/wrist/hand` moves and has a plane
  help: planes are fixed in the world; use a cuboid, or hang the body on `/`"#,
    ),
    (
        "shape = [ { hull = { points = [[0, 0, 0], [1, 0, 0], [0, 1, 0], [1, 1, 0]] } } ]\ncontact = {}",
        r#"scene.toml:33:31: error: the hull of body `hand` has no volume
  help: give four points or more that do not lie in one plane [m]"#,
    ),
    (
        "\n[[closure]]\nname = \"pin\"\nkind = \"point\"\nbetween = [\"/shoulder/rod/tip\", \"/\"]",
        r#"scene.toml:35:8: error: closure `/pin` is open at the start: its ends are 5.000000e-1 m apart
  help: no position of the joints near the given ones closes it: check lengths and places"#,
    ),
    (
        "\n[[closure]]\nname = \"pin\"\nkind = \"distance\"\nbetween = [\"/shoulder/rod/tp\", \"/\"]\nlength = 0.5",
        r#"scene.toml:37:12: error: there is no object `/shoulder/rod/tp`
  help: did you mean `/shoulder/rod/tip`? objects: `/shoulder/rod`, `/shoulder/rod/tip`, `/shoulder/rod/tip/wrist/hand`"#,
    ),
    (
        "\n[[coupling]]\nname = \"gear\"\njoints = [\"/shoulder\", \"/shoulder/rod\"]\nratio = 2.0",
        r#"scene.toml:36:24: error: `/shoulder/rod` is a body, not a joint with one degree of freedom
  help: did you mean `/shoulder`? objects: `/shoulder`, `/shoulder/rod/tip/wrist`"#,
    ),
    (
        "\n[[coupling]]\nname = \"gear\"\njoints = [\"/shoulder\", \"/shoulder/rod/tip/wrist\"]\nratio = 2.0\noffset = -0.2\n\n[[spring_damper]]\nname = \"gear\"\nbetween = [\"/\", \"/shoulder/rod\"]\nstiffness = 1.0\n\n[[closure]]\nname = \"shoulder\"\nkind = \"point\"\nbetween = [\"/shoulder/rod\", \"/\"]",
        r#"scene.toml:41:8: error: there are two objects `/gear`
  help: the other one is in line 35; give one of them another name
scene.toml:46:8: error: there are two objects `/shoulder`
  help: give one of them another name"#,
    ),
];

#[test]
fn impossible_contacts_and_closures_are_refused() {
    for (replacement, expected) in CASES {
        let message = refused(
            "scene.toml",
            "inertia = { xx = 0.001, yy = 0.001, zz = 0.001 }\n",
            &format!("inertia = {{ xx = 0.001, yy = 0.001, zz = 0.001 }}\n{replacement}\n"),
        );
        assert!(message.contains(expected), "{replacement}\nsays\n{message}\nexpected\n{expected}");
    }
}

#[test]
fn what_overlaps_at_the_start_is_refused_with_pair_and_depth() {
    let two = "inertia = { xx = 0.001, yy = 0.001, zz = 0.001 }\nshape = [ { sphere = { radius = 0.1 } } ]\ncontact = {}\n\n\
               [[body]]\nname = \"floor\"\nposition = [0.0, 0.0, 0.45]\nshape = [ { plane = {} } ]\ncontact = {}\n";
    let message = refused("scene.toml", "inertia = { xx = 0.001, yy = 0.001, zz = 0.001 }\n", two);
    assert!(message.contains("`/shoulder/rod/tip/wrist/hand` and `/floor` overlap at the start by "), "{message}");
    assert!(message.contains("or set allow_overlap = true"), "{message}");
    let message =
        refused("scene.toml", "gravity = [0.0, 0.0, -9.81]\n", "gravity = [0.0, 0.0, -9.81]\nallow_overlap = true\n");
    assert!(message.starts_with("loads"), "{message}");
}

#[test]
fn a_joint_beyond_its_stop_is_refused() {
    let message = refused("scene.toml", "damping = 0.5", "damping = 0.5\nlimits = { lower = -1.0, upper = 0.05 }");
    assert!(message.contains("joint `/shoulder` starts at 0.1, beyond its limit 0.05"), "{message}");
    let message = refused("scene.toml", "damping = 0.5", "damping = 0.5\nlimits = { lower = 1.0, upper = -1.0 }");
    assert!(message.contains("lower limit 1 is not below the upper limit -1"), "{message}");
}
