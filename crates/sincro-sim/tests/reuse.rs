//! Reuse in scene files, short names, wildcards, parameters: what the loaded scene has.

use sincro_testing::SceneFolder;

const EXPERIMENT: &str =
    "title = \"T\"\nduration = 0.1\nstep = 0.01\nrecord = [\"energy.total\"]\n[parameters]\nm = 2.0\n";

const BALL: &str = r#"
format = 2

[parameters]
radius = 0.1
density = 1000.0

[[joint]]
name = "air"
kind = "free"

[[body]]
name = "ball"
parent = "air"
density = "density"
shape = [ { sphere = { radius = "radius" } } ]
"#;

fn folder(scene: &str) -> SceneFolder {
    SceneFolder::of(scene, EXPERIMENT).with("ball.toml", BALL)
}

fn paths(folder: &SceneFolder, settings: &[&str]) -> Vec<String> {
    folder.load(settings).unwrap().scene.objects.iter().map(|o| o.path.clone()).collect()
}

fn total_mass(folder: &SceneFolder, settings: &[&str]) -> f64 {
    folder.load(settings).unwrap().scene.model.total_mass()
}

#[test]
fn a_grid_of_instances_has_indices_and_parameters() {
    let scene = folder(
        "[[instance]]\nfile = \"ball.toml\"\nposition = [0.0, 0.0, 1.0]\nparameters = { radius = \"0.05 + 0.01*i\" }\n\
         repeat = { count = [5, 5, 1], step = [0.5, 0.5, 0.5] }\n",
    );
    let all = paths(&scene, &[]);
    assert_eq!(all.len(), 75);
    assert!(all.contains(&"/ball25/air/ball".to_owned()) && !all.contains(&"/ball".to_owned()));
    let loaded = scene.load(&[]).unwrap();
    let position = |path: &str| loaded.scene.object(path).unwrap().pose.pos.0;
    assert_eq!((position("/ball2"), position("/ball6")), ([0.5, 0.0, 1.0], [0.0, 0.5, 1.0]));
}

#[test]
fn settings_reach_one_copy_or_all() {
    let scene =
        folder("[[instance]]\nfile = \"ball.toml\"\nname = \"a\"\n[[instance]]\nfile = \"ball.toml\"\nname = \"b\"\n");
    assert_eq!(paths(&scene, &[]), ["/a", "/a/air", "/a/air/ball", "/b", "/b/air", "/b/air/ball"]);
    let share = |settings: &[&str]| total_mass(&scene, settings) / total_mass(&scene, &[]);
    for (settings, expected) in [
        (&["/a/air/ball.density=500"][..], 0.75),
        (&["/*/air/ball.density=500"], 0.5),
        (&["instance.0.parameters.density=500"], 0.75),
        (&["a/air/ball.density=\"2*500\""], 1.0),
    ] {
        assert!((share(settings) - expected).abs() < 1e-12, "{settings:?}: {}", share(settings));
    }
    assert!(scene.load(&["/c*.density=500"]).unwrap_err().contains("`/c*` fits no object"));
    let said = scene.load(&["ball.density=500"]).unwrap_err();
    assert!(said.contains("`ball` may mean `/a/air/ball`, `/b/air/ball`"), "{said}");
}

#[test]
fn parameters_that_a_file_does_not_have_are_refused() {
    let scene = folder("[[instance]]\nfile = \"ball.toml\"\nparameters = { radus = 0.2 }\n");
    let said = scene.load(&[]).unwrap_err();
    assert!(said.contains("has no parameter `radus`") && said.contains("did you mean `radius`?"), "{said}");
}

#[test]
fn files_inside_themselves_are_refused() {
    let scene = folder("include = [\"other.toml\"]\n").with("other.toml", "include = [\"other.toml\"]\n");
    let said = scene.load(&[]).unwrap_err();
    assert!(said.contains("`other.toml` is read inside itself"), "{said}");
    let scene =
        folder("[[instance]]\nfile = \"other.toml\"\n").with("other.toml", "[[instance]]\nfile = \"other.toml\"\n");
    assert!(scene.load(&[]).unwrap_err().contains("is read inside itself"));
}

#[test]
fn included_objects_stand_beside_those_of_the_file() {
    let scene = folder("include = [\"ball.toml\"]\n[[frame]]\nname = \"mark\"\nparent = \"ball\"\n");
    assert_eq!(paths(&scene, &[]), ["/air", "/air/ball", "/air/ball/mark"]);
}

#[test]
fn defaults_fill_up_what_objects_of_a_group_do_not_give() {
    let scene = folder(
        "[[default]]\nof = \"joint\"\nkeys = { kind = \"hinge\", damping = 0.1 }\n\
         [[default]]\nof = \"joint\"\ngroup = \"/b**\"\nkeys = { kind = \"slide\", motor = { mode = \"velocity\", max_torque = 5.0 } }\n\
         [[joint]]\nname = \"a\"\n[[body]]\nname = \"of_a\"\nparent = \"a\"\nmass = \"m\"\ninertia = { ixx = 1, iyy = 1, izz = 1 }\n\
         [[joint]]\nname = \"b\"\nmotor = { command = 1.0 }\n[[body]]\nname = \"of_b\"\nparent = \"b\"\nmass = \"2*m\"\n\
         inertia = { ixx = 1, iyy = 1, izz = 1 }\n",
    );
    let loaded = scene.load(&[]).unwrap();
    let kinds: Vec<String> =
        loaded.scene.model.names().joints.iter().map(|joint| format!("{:?}", joint.kind)).collect();
    assert!(kinds[0].starts_with("Revolute") && kinds[1].starts_with("Prismatic"), "{kinds:?}");
    assert_eq!(loaded.scene.model.motors().len(), 1);
    assert_eq!((total_mass(&scene, &[]), total_mass(&scene, &["parameters.m=3"])), (6.0, 9.0));
}

#[test]
fn names_in_an_experiment_may_be_short_vectors_or_patterns() {
    let scene =
        folder("[[instance]]\nfile = \"ball.toml\"\nname = \"a\"\n[[instance]]\nfile = \"ball.toml\"\nname = \"b\"\n");
    let record = |list: &str| scene.load(&[&format!("record={list}")]).map(|loaded| loaded.experiment.record.len());
    assert_eq!(record("[\"/a/air/ball.position\"]"), Ok(3));
    assert_eq!(record("[\"a/air/ball.position.x\", \"/*/air/ball.position.x\"]"), Ok(2));
    assert!(record("[\"ball.position\"]").unwrap_err().contains("`ball.position` may mean"));
    let said = record("[\"/a/air/ball.positon.x\"]").unwrap_err();
    assert!(said.contains("did you mean `/a/air/ball.position.x`?"), "{said}");
}

#[test]
fn a_file_of_a_newer_format_is_refused() {
    let said = folder("format = 3\n").load(&[]).unwrap_err();
    assert!(said.contains("the file has format 3"), "{said}");
}
