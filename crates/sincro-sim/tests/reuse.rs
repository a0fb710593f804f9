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
fn pairs_of_bodies_have_laws_by_patterns() {
    let contact = "contact = { friction = 0.5 }";
    let ball = format!("{BALL}{contact}\n");
    let floor = format!("[[body]]\nname = \"floor\"\nshape = [ {{ plane = {{}} }} ]\n{contact}\n");
    let balls = "[[instance]]\nfile = \"ball.toml\"\nposition = [0.0, 0.0, 1.0]\nrepeat = { count = 3, step = [0.5, 0.0, 0.0] }\n";
    let pairs = "[[contact_pair]]\nbetween = [\"/ball*/air/ball\", \"/ball**\"]\ntouches = false\n\
                 [[contact_pair]]\nbetween = [\"floor\", \"/ball2/air/ball\"]\nfriction = 0.1\nrestitution = 0.7\n";
    let folder = |pairs: &str| SceneFolder::of(&format!("{floor}{balls}{pairs}"), EXPERIMENT).with("ball.toml", &ball);
    let laws = |pairs: &str| -> Vec<(f64, f64)> {
        let loaded = folder(pairs).load(&[]).unwrap();
        let all = &loaded.scene.model.constraints().pairs;
        all.iter().map(|pair| (pair.material.friction, pair.material.restitution)).collect()
    };
    assert_eq!(laws("").len(), 6);
    assert_eq!(laws(pairs), [(0.5, 0.0), (0.1, 0.7), (0.5, 0.0)]);
    let refused = |pairs: &str| folder(pairs).load(&[]).unwrap_err();
    let found = refused("[[contact_pair]]\nbetween = [\"/box*\", \"floor\"]\n");
    assert!(found.contains("no body with a `contact` has a path of the form `/box*`"), "{found}");
    let found = refused("[[contact_pair]]\nbetween = [\"/ball1/air\", \"floor\"]\n");
    assert!(found.contains("`/ball1/air` is a free joint, not a body with a `contact`"), "{found}");
    let found = refused("[[contact_pair]]\nbetween = [\"/ball1/air/ball\", \"floor\"]\nrestitution = 2.0\n");
    assert!(found.contains("`restitution` is 2"), "{found}");
}

#[test]
fn friction_of_a_joint_is_a_number_a_table_or_a_list() {
    let friction = |text: &str| {
        let scene = format!(
            "[[joint]]\nname = \"j\"\nkind = \"ball\"\nfriction = {text}\n[[body]]\nname = \"b\"\nparent = \"/j\"\n\
             mass = 1.0\ninertia = {{ xx = 1.0, yy = 1.0, zz = 1.0 }}\n"
        );
        let loaded = SceneFolder::of(&scene, EXPERIMENT).load(&[])?;
        let of = |dof: usize| loaded.scene.model.dofs()[dof].friction;
        Ok::<_, String>([of(0), of(1), of(2)].map(|f| (f.sliding, f.at_rest, f.stribeck_velocity)))
    };
    assert_eq!(friction("[0.1, 0.2, 0.3]").unwrap(), [0.1, 0.2, 0.3].map(|x| (x, x, 1.0)));
    assert_eq!(friction("[{ sliding = 0.3 }, 0.0, 0.0]").unwrap()[0], (0.3, 0.3, 0.01));
    let table = "{ sliding = 0.1, static = 0.2 }";
    let mixed = friction(&format!("[{table}, 0.0, {{ sliding = 1.0, static = 2.0, stribeck_velocity = 0.5 }}]"));
    assert_eq!(mixed.unwrap(), [(0.1, 0.2, 0.01), (0.0, 0.0, 1.0), (1.0, 2.0, 0.5)]);
    for (text, message) in [
        (table, "`friction` of `/j` has 1 entries, the joint has 3 degrees of freedom"),
        ("[{ sliding = 0.3, static = 0.2 }, 0.0, 0.0]", "friction of `/j` is 0.2 at rest, less than 0.3 in motion"),
        ("[-1.0, 0.0, 0.0]", "friction -1 of `/j` is negative or not finite"),
        ("[{ load_coefficient = 0.3 }, 0.0, 0.0]", "friction of `/j` cannot grow with the load of the joint"),
        ("[{ load_coefficient = -0.3 }, 0.0, 0.0]", "`load_coefficient` is -0.3"),
        ("[{ sliding = 0.3, static = 0.4, stribeck = 1.0 }, 0.0, 0.0]", "stribeck_velocity"),
    ] {
        let found = friction(text).unwrap_err();
        assert!(found.contains(message), "{text}: {found}");
    }
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

#[test]
fn files_of_a_scene_file_are_looked_for_in_its_own_folder() {
    let robot =
        "include = [\"more/floor.toml\"]\n[[instance]]\nfile = \"../ball.toml\"\n[[instance]]\nfile = \"part.toml\"\n";
    let part = "[[body]]\nname = \"rock\"\nmass = 1.0\ninertia = { xx = 1.0, yy = 1.0, zz = 1.0 }\nvisual = [ { mesh = { file = \"rock.obj\" } } ]\n";
    let tetrahedron = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n";
    let scene = folder("[[instance]]\nfile = \"robots/robot.toml\"\n")
        .with("robots/robot.toml", robot)
        .with("robots/part.toml", part)
        .with("robots/rock.obj", tetrahedron)
        .with("robots/more/floor.toml", "[[frame]]\nname = \"floor\"\n");
    let found = paths(&scene, &[]);
    for path in ["/robot/floor", "/robot/ball/air/ball", "/robot/part/rock"] {
        assert!(found.contains(&path.to_owned()), "{path}: {found:?}");
    }
}

/// A ball whose file has a default with a formula of its own parameter.
const BALL_WITH_DEFAULT: &str = r#"
[parameters]
half = 0.05
density = 1000.0

[[default]]
of = "body"
keys = { density = "2*density", shape = [ { sphere = { radius = "2*half" } } ] }

[[joint]]
name = "air"
kind = "free"

[[body]]
name = "ball"
parent = "air"
"#;

fn ball_mass(radius: f64, density: f64) -> f64 {
    4.0 / 3.0 * std::f64::consts::PI * radius.powi(3) * density
}

#[test]
fn defaults_know_the_parameters_of_their_own_file() {
    // the same name in the file that reuses it, and in another one, has another value
    let other = "[parameters]\nhalf = 0.3\n[[default]]\nof = \"frame\"\nkeys = { position = [\"half\", 0, 0] }\n\
                 [[frame]]\nname = \"mark\"\n";
    let include = "include = [\"ball.toml\", \"other.toml\"]\n";
    let instance = "include = [\"other.toml\"]\n[[instance]]\nfile = \"ball.toml\"\n";
    for scene in [include, instance] {
        let folder = SceneFolder::of(scene, EXPERIMENT).with("ball.toml", BALL_WITH_DEFAULT).with("other.toml", other);
        let mass = total_mass(&folder, &[]);
        assert!((mass - ball_mass(0.1, 2000.0)).abs() < 1e-9, "{scene}: {mass}");
        assert_eq!(folder.load(&[]).unwrap().scene.object("/mark").unwrap().pose.pos.0[0], 0.3);
    }
}

#[test]
fn settings_reach_parameters_of_included_files() {
    let folder = SceneFolder::of("include = [\"ball.toml\"]\n", EXPERIMENT).with("ball.toml", BALL_WITH_DEFAULT);
    let mass = total_mass(&folder, &["parameters.half=0.1"]);
    assert!((mass - ball_mass(0.2, 2000.0)).abs() < 1e-9, "{mass}");
    let refused = folder.load(&["parameters.haf=0.1"]).unwrap_err();
    assert!(refused.contains("`haf`"), "{refused}");
}

#[test]
fn settings_reach_parameters_of_instances_by_their_paths() {
    let arm = "[[instance]]\nfile = \"ball.toml\"\nname = \"first\"\nposition = [1, 0, 0]\n\
               [[instance]]\nfile = \"ball.toml\"\nname = \"row\"\nrepeat = { count = 2, step = [0.0, 1.0, 0.0] }\n\
               parameters = { radius = 0.2 }\n";
    // an instance in an instance
    let folder = folder("[[instance]]\nfile = \"arm.toml\"\nname = \"arm\"\n").with("arm.toml", arm);
    let mass = |settings: &[&str]| total_mass(&folder, settings);
    let (small, large) = (ball_mass(0.1, 1000.0), ball_mass(0.2, 1000.0));
    assert!((mass(&[]) - small - 2.0 * large).abs() < 1e-9);
    // by its whole path, by a short name, a pattern, and a formula
    assert!((mass(&["/arm/first.parameters.radius=0.2"]) - 3.0 * large).abs() < 1e-9);
    assert!((mass(&["first.parameters.radius=0.2"]) - 3.0 * large).abs() < 1e-9);
    assert!((mass(&["/arm/row*.parameters.radius=0.1"]) - 3.0 * small).abs() < 1e-9);
    assert!((mass(&["/arm/row2.parameters.radius=m/20"]) - 2.0 * small - large).abs() < 1e-9);
    let refused = |setting: &str| folder.load(&[setting]).unwrap_err();
    let found = refused("/arm/first.parameters.radus=1");
    assert!(found.contains("has no parameter `radus`") && found.contains("did you mean `radius`?"), "{found}");
    let found = refused("/arm/fist.parameters.radius=1");
    assert!(found.contains("no instance `/arm/fist`") && found.contains("did you mean `/arm/first`?"), "{found}");
    let found = refused("/arm/first.parameters.radius=two");
    assert!(found.contains("`radius` is not a number"), "{found}");
}

#[test]
fn a_parameter_of_an_instance_is_none_of_the_experiment() {
    let scene = folder("[[instance]]\nfile = \"ball.toml\"\nname = \"ball\"\n");
    let found = scene.load(&["parameters.radius=0.2"]).unwrap_err();
    assert!(found.contains("is a parameter of the instance `/ball`"), "{found}");
    assert!(found.contains("write /ball.parameters.radius=0.2"), "{found}");
}
