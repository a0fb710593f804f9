//! Robot blocks that compute with a model of their own: another scene file, other numbers, or both.

use sincro_sim::Loaded;
use sincro_testing::{SceneFolder, last, run};

const SCENE: &str = r#"
[parameters]
m = 2.0

[[joint]]
name = "hinge"
kind = "revolute"
axis = [0.0, 1.0, 0.0]
initial = { position = 0.5 }
motor = { mode = "velocity" }

[[body]]
name = "rod"
parent = "/hinge"
mass = "m"
center_of_mass = [0.25, 0.0, 0.0]
inertia = { xx = 0.1, yy = 0.1, zz = 0.01 }
"#;

const EXPERIMENT: &str = r#"title = "Models"
scene = "scene.toml"
diagram = "diagram.toml"
duration = 0.1
step = 0.05
record = ["own", "other", "heavier", "light"]
[parameters]
share = 1.5
"#;

const DIAGRAM: &str = r#"
wires = ["world.q -> own", "world.q -> other", "world.q -> heavier", "world.q -> light"]
block = [
  { name = "own", type = "gravity-torque" },
  { name = "other", type = "gravity-torque", model = "other.toml" },
  { name = "heavier", type = "gravity-torque", set = { "/hinge/rod.mass" = "share*2.0" } },
  { name = "light", type = "gravity-torque", model = "other.toml", set = { "gravity.2" = -1.62 } },
]
"#;

fn folder() -> SceneFolder {
    let folder = SceneFolder::of(SCENE, EXPERIMENT).with("diagram.toml", DIAGRAM);
    // a parameter of the experiment wins over that of the file, one that it does not have stays
    folder.with("other.toml", &SCENE.replace("m = 2.0", "m = 3.0\nlever = 0.5").replace("[0.25,", "[\"lever\","))
}

fn torque(loaded: &Loaded, block: &str) -> f64 {
    last(&run(loaded), block)
}

#[test]
fn each_block_computes_with_its_own_model() {
    let loaded = folder().load(&[]).unwrap();
    // −m g l cos q, the axis along y
    let expected = |m: f64, g: f64, l: f64| -m * g * l * sincro_math::elementary::sin_cos(0.5).1;
    for (block, value) in [
        ("own", expected(2.0, 9.81, 0.25)),
        // the scene's parameter m = 2 is the experiment's, and wins
        ("other", expected(2.0, 9.81, 0.5)),
        ("heavier", expected(3.0, 9.81, 0.25)),
        ("light", expected(2.0, 1.62, 0.5)),
    ] {
        let measured = torque(&loaded, block);
        assert!((measured - value).abs() < 1e-12, "{block}: {measured} {value}");
    }
}

#[test]
fn settings_of_the_scene_reach_a_model_that_is_made_of_it() {
    let loaded = folder().load(&["/hinge/rod.center_of_mass=[0.4, 0.0, 0.0]", "parameters.share=2.0"]).unwrap();
    let (own, heavier, other) = (torque(&loaded, "own"), torque(&loaded, "heavier"), torque(&loaded, "other"));
    assert!((heavier - 2.0 * own).abs() < 1e-12, "{own} {heavier}");
    assert!((other / own - 0.5 / 0.4).abs() < 1e-12);
}

#[test]
fn what_is_wrong_with_a_model_is_said_where_it_is_written() {
    let refused = |from: &str, to: &str| {
        let folder = folder();
        folder.change("diagram.toml", from, to);
        folder.short(&folder.load(&[]).unwrap_err())
    };
    let missing = refused("model = \"other.toml\" }", "model = \"othre.toml\" }");
    assert!(missing.contains("diagram.toml:5") && missing.contains("othre.toml"), "{missing}");
    let unknown = refused("/hinge/rod.mass", "/hinge/rid.mass");
    assert!(unknown.contains("diagram.toml:6") && unknown.contains("/hinge/rid"), "{unknown}");
    let negative = refused("\"share*2.0\"", "-1.0");
    assert!(negative.contains("-1"), "{negative}");
    let absolute = refused("model = \"other.toml\" }", "model = \"/other.toml\" }");
    assert!(absolute.contains("absolute"), "{absolute}");
    let no_table = refused("set = { \"gravity.2\" = -1.62 }", "set = 3");
    assert!(no_table.contains("`set` is not a table"), "{no_table}");
}

#[test]
fn a_model_with_other_joints_asks_for_other_widths() {
    let folder = folder();
    let second = "[[joint]]\nname = \"second\"\nparent = \"/hinge/rod\"\nkind = \"prismatic\"\n\n[[body]]\nname = \"tool\"\nparent = \"/hinge/rod/second\"\nmass = 1.0\ninertia = { xx = 0.1, yy = 0.1, zz = 0.1 }\n";
    folder.write("other.toml", &format!("{SCENE}\n{second}"));
    let message = folder.load(&[]).unwrap_err();
    assert!(message.contains("`q` has 1 component") && message.contains("the model has 2"), "{message}");
}
