//! Scenes that are exported, and imported again.

use sincro_dynamics::crba::mass_matrix;
use sincro_dynamics::model::Model;
use sincro_dynamics::scratch::Scratch;
use sincro_import::export::{Format, export};

use crate::folder::Folder;

const EXPERIMENT: &str = "title = \"own\"\nduration = 0.1\nstep = 0.01\nrecord = [\"energy.total\"]\n";

const SCENE: &str = r##"
gravity = [0.0, 0.0, -3.7]

[[body]]
name = "base"
mass = 1.0
inertia = { xx = 1.0, yy = 1.0, zz = 1.0 }
shape = [{ cuboid = { size = [0.2, 0.3, 0.1] }, color = "#336699" }]
contact = { friction = 0.4 }

[[joint]]
name = "turn"
parent = "/base"
kind = "revolute"
axis = [0.0, 1.0, 0.0]
position = [0.1, 0.0, 0.2]
rotation_deg = [0.0, 0.0, 30.0]
limits = { lower = -1.0, upper = 2.0 }
damping = 0.3

[[body]]
name = "arm"
parent = "/base/turn"
position = [0.0, 0.0, 0.25]
rotation_deg = [10.0, 20.0, 0.0]
mass = 2.0
center_of_mass = [0.0, 0.01, 0.0]
inertia = { xx = 0.04, yy = 0.03, zz = 0.02, xy = 0.001 }
shape = [{ capsule = { radius = 0.05, length = 0.4 } }]

[[joint]]
name = "slide"
parent = "/base/turn/arm"
kind = "prismatic"
axis = [0.0, 0.0, 1.0]
position = [0.0, 0.0, 0.25]
motor = { mode = "torque", max_torque = 5.0 }

[[body]]
name = "tool"
parent = "/base/turn/arm/slide"
mass = 0.5
inertia = { xx = 0.001, yy = 0.001, zz = 0.001 }

[[frame]]
name = "tip"
parent = "/base/turn/arm/slide/tool"
position = [0.0, 0.0, 0.1]
"##;

fn masses(model: &Model<f64>) -> Vec<f64> {
    let (mut scratch, mut mass) = (Scratch::new(model), vec![0.0; model.n_v() * model.n_v()]);
    let q = [0.7, 0.1, -0.4, 0.9, 0.3];
    mass_matrix(model, &q[..model.n_q()], &mut scratch, &mut mass);
    mass
}

/// Joints that hang on a joint, beside its body, and on one that carries two joints and nothing else.
#[test]
fn a_joint_is_written_once_whatever_hangs_on_it() {
    let body = |name: &str, parent: &str, mass: f64| {
        format!(
            "[[body]]\nname = \"{name}\"\nparent = \"{parent}\"\nposition = [0.1, 0.02, 0.3]\nrotation_deg = [10.0, 20.0, 0.0]\nmass = {mass:?}\ninertia = {{ xx = 0.04, yy = 0.03, zz = 0.02 }}\n"
        )
    };
    let joint = |name: &str, parent: &str, axis: [f64; 3]| {
        let parent = if parent.is_empty() { String::new() } else { format!("parent = \"{parent}\"\n") };
        format!(
            "[[joint]]\nname = \"{name}\"\n{parent}kind = \"revolute\"\naxis = {axis:?}\nposition = [0.2, 0.1, 0.4]\nrotation_deg = [0.0, 30.0, 5.0]\n"
        )
    };
    let (x, y) = ([1.0, 0.0, 0.0], [0.0, 1.0, 0.0]);
    let scene = [
        joint("a", "", y),
        body("link", "/a", 2.0),
        joint("b", "/a", x),
        body("link", "/a/b", 1.0),
        joint("c", "/a/b", y),
        joint("d", "/a/b/c", x),
        body("left", "/a/b/c/d", 0.5),
        joint("e", "/a/b/c", y),
        body("right", "/a/b/c/e", 0.7),
    ];
    let folder = Folder::new();
    // MJCF wants mass on every joint: a joint with nothing but joints is refused there
    folder.file("heavy/scene.toml", scene[..4].concat());
    folder.file("heavy/experiment.toml", "title = \"own\"\nduration = 0.1\nstep = 0.01\nrecord = [\"energy.total\"]\n");
    folder.file("own/scene.toml", scene.concat());
    folder.file("own/experiment.toml", "title = \"own\"\nduration = 0.1\nstep = 0.01\nrecord = [\"energy.total\"]\n");
    let open = |name: &str| {
        sincro_scene::open::open(&folder.path().join(name), &[], sincro_scene::fmu::Loaders::default(), true).unwrap()
    };
    assert!(export(&open("own").scene, "own", Format::Mjcf).unwrap_err()[0].contains("`/a/b/c` moves on a joint"));
    for (name, format, file) in
        [("own", Format::Urdf, "r.urdf"), ("heavy", Format::Mjcf, "r.xml"), ("own", Format::Sdf, "r.sdf")]
    {
        let own = open(name);
        let (expected, n) = (masses(&own.scene.model), own.scene.model.n_v());
        let exported = export(&own.scene, "own", format).unwrap();
        let imported = folder.import(file, &exported.text).unwrap_or_else(|found| panic!("{found}\n{}", exported.text));
        let back = folder.open(&imported).scene;
        assert_eq!(back.model.n_v(), n, "{file}\n{}", exported.text);
        for (a, b) in masses(&back.model).iter().zip(&expected) {
            assert!((a - b).abs() < 1e-13, "{file}: {a} {b}\n{}", exported.text);
        }
    }
}

#[test]
fn the_mass_matrix_comes_back_from_every_format() {
    let folder = Folder::new();
    folder.file("own/scene.toml", SCENE);
    folder.file("own/experiment.toml", "title = \"own\"\nduration = 0.1\nstep = 0.01\nrecord = [\"energy.total\"]\n");
    let own =
        sincro_scene::open::open(&folder.path().join("own"), &[], sincro_scene::fmu::Loaders::default(), true).unwrap();
    let expected = masses(&own.scene.model);
    for (format, file) in [(Format::Urdf, "r.urdf"), (Format::Mjcf, "r.xml"), (Format::Sdf, "r.sdf")] {
        let exported = export(&own.scene, "own", format).unwrap();
        let imported = folder.import(file, &exported.text).unwrap_or_else(|found| panic!("{found}\n{}", exported.text));
        let back = folder.open(&imported).scene;
        assert_eq!(back.model.n_v(), 2, "{file}");
        for (a, b) in masses(&back.model).iter().zip(&expected) {
            assert!((a - b).abs() < 1e-14, "{file}: {a} {b}\n{}", exported.text);
        }
        let limits: Vec<f64> = back.model.constraints().limits.iter().map(|l| l.bound).collect();
        assert_eq!(limits, [-1.0, 2.0], "{file}");
        assert_eq!(back.model.dofs()[0].damping, 0.3, "{file}");
        assert!((back.model.total_mass() - 2.5).abs() < 1e-15, "{file}");
        // SDF has frames that poses refer to, and no objects of that kind
        assert_eq!(back.objects.iter().any(|o| o.name == "tip"), format != Format::Sdf, "{file}");
    }
}

#[test]
fn what_a_format_cannot_say_is_said() {
    let folder = Folder::new();
    folder.file("own/scene.toml", SCENE.replace("kind = \"prismatic\"", "kind = \"screw\"\npitch = 0.1"));
    folder.file("own/experiment.toml", "title = \"own\"\nduration = 0.1\nstep = 0.01\nrecord = [\"energy.total\"]\n");
    let own =
        sincro_scene::open::open(&folder.path().join("own"), &[], sincro_scene::fmu::Loaders::default(), true).unwrap();
    assert!(export(&own.scene, "own", Format::Urdf).unwrap_err()[0].contains("/base/turn/arm/slide"));
    let exported = export(&own.scene, "own", Format::Sdf).unwrap();
    assert!(exported.notes.iter().any(|(path, words)| path.ends_with("slide") && words.contains("motors")));
}

/// Springs between points and tendons that pass through MJCF.
const TENDONS: &str = r#"
[[spring_damper]]
name = "line"
between = ["/", "/base/turn/arm"]
points = [[0.5, 0.2, 0.3], [0.0, 0.1, 0.0]]
free_length = 0.2
stiffness = 20.0
damping = 1.5

[[tendon]]
name = "cord"
through = ["/", "/base/turn/arm", "/base/turn/arm/slide/tool/tip"]
stiffness = 30.0
free_length = 0.4
tension_only = true
actuator = { command = 0.0, max_force = 7.0 }

[[tendon]]
name = "sum"
joints = ["/base/turn", "/base/turn/arm/slide"]
coefficients = [0.2, 1.0]
free_length = [0.01, 0.05]
stiffness = 12.0
damping = 0.8

[[tendon]]
name = "leash"
through = ["/", "/base/turn/arm/slide/tool/tip"]
limits = { upper = 0.3, stiffness = 90.0 }
"#;

#[test]
fn springs_and_tendons_come_back_from_mjcf() {
    let folder = Folder::new();
    folder.file("own/scene.toml", [SCENE, TENDONS].concat());
    folder.file("own/experiment.toml", "title = \"own\"\nduration = 0.1\nstep = 0.01\nrecord = [\"energy.total\"]\n");
    let own =
        sincro_scene::open::open(&folder.path().join("own"), &[], sincro_scene::fmu::Loaders::default(), true).unwrap();
    let exported = export(&own.scene, "own", Format::Mjcf).unwrap();
    let imported = folder.import("r.xml", &exported.text).unwrap_or_else(|found| panic!("{found}\n{}", exported.text));
    let back = folder.open(&imported).scene;
    // the actuator of the cord is a tendon of its own
    let found = |name: &str| {
        let names = &back.model.names().spring_dampers;
        &back.model.spring_dampers()[names.iter().position(|n| n == name).unwrap()]
    };
    assert_eq!(back.model.spring_dampers().len(), 5, "{}", imported.scene());
    assert_eq!(found("/cord-2").actuator.unwrap().max_force, 7.0);
    for draw in 0..20 {
        let number = |k: usize| ((draw * 4 + k) as f64 * 0.618_033_988_749_895).fract() - 0.3;
        let (q, v) = ([number(0), number(1)], [number(2), number(3)]);
        let force = |model: &Model<f64>, name: &str| {
            let mut scratch = Scratch::new(model);
            sincro_dynamics::kinematics::motions(model, &q, &v, &v, &mut scratch);
            let k = model.names().spring_dampers.iter().position(|n| n == name).unwrap();
            let element = &model.spring_dampers()[k];
            let at = element.length(&q, &v, |link| (scratch.twist(link), scratch.link_poses()[link]));
            (at, element.forces(at.length, at.rate, &vec![0.0; model.n_commands()]).total())
        };
        for name in ["/line", "/cord", "/sum", "/leash"] {
            let ((at, expected), (there, found)) = (force(&own.scene.model, name), force(&back.model, name));
            assert!((at.length - there.length).abs() < 1e-14 && (at.rate - there.rate).abs() < 1e-13, "{name}");
            assert!((expected - found).abs() < 1e-12, "draw {draw}, {name}: {expected} {found}");
        }
    }
}

/// A dead band of MJCF has two lengths that are not negative; what has none is a stop there.
#[test]
fn a_one_sided_stop_of_a_fixed_tendon_is_no_spring_of_mjcf() {
    let folder = Folder::new();
    let stop = "\n[[tendon]]\nname = \"stop\"\njoints = [\"/base/turn\"]\ncoefficients = [1.0]\nlimits = { upper = 0.4, stiffness = 80.0 }\n";
    folder.file("own/scene.toml", [SCENE, stop].concat());
    folder.file("own/experiment.toml", "title = \"own\"\nduration = 0.1\nstep = 0.01\nrecord = [\"energy.total\"]\n");
    let own =
        sincro_scene::open::open(&folder.path().join("own"), &[], sincro_scene::fmu::Loaders::default(), true).unwrap();
    let exported = export(&own.scene, "own", Format::Mjcf).unwrap();
    assert!(exported.text.contains("range=\"-1000000000 0.4\""), "{}", exported.text);
    assert!(!exported.text.contains("springlength") && !exported.text.contains("inf"), "{}", exported.text);
    assert!(exported.notes.iter().any(|(path, words)| path.ends_with("stop") && words.contains("softness")));
    folder.import("r.xml", &exported.text).unwrap_or_else(|found| panic!("{found}\n{}", exported.text));
}

/// A bushing with the stiffness over mass of one time constant is a soft weld of MJCF; another is noted.
#[test]
fn bushings_of_one_time_constant_come_back_from_mjcf() {
    let folder = Folder::new();
    let text = r#"<mujoco><worldbody><body name="box" pos="0 0 1" quat="0.8 0.6 0 0"><freejoint/>
      <geom type="box" size="0.1 0.2 0.3" mass="2"/></body></worldbody>
      <equality><weld name="seat" body2="box" relpose="0.1 0 1 0.6 0 0.8 0" solref="0.05 0.7"/></equality></mujoco>"#;
    let own = folder.open(&folder.import("box.xml", text).unwrap()).scene;
    let exported = export(&own, "own", Format::Mjcf).unwrap();
    assert!(exported.notes.iter().any(|(path, words)| path == "/seat" && words.contains("at zero coordinates only")));
    assert!(exported.text.contains("torquescale=\"1.0"), "{}", exported.text);
    let back = folder.import("again.xml", &exported.text).unwrap_or_else(|found| panic!("{found}\n{}", exported.text));
    let back = folder.open(&back).scene;
    let ([a], [b]) = (own.model.bushings(), back.model.bushings()) else { panic!("{}", exported.text) };
    for k in 0..6 {
        assert!((a.stiffness[k] - b.stiffness[k]).abs() < 1e-8 * a.stiffness[k], "{k}: {a:?} {b:?}");
        assert!((a.damping[k] - b.damping[k]).abs() < 1e-8 * a.damping[k], "{k}: {a:?} {b:?}");
    }
    let of = |own: &sincro_scene::scene::Scene| {
        let mut scratch = Scratch::new(&own.model);
        let x = &own.initial;
        sincro_dynamics::kinematics::motions(&own.model, &x.q, &x.v, &x.v, &mut scratch);
        own.model.bushings()[0].motion(|link| (scratch.twist(link), scratch.link_poses()[link])).deflection
    };
    for (a, b) in of(&own).iter().zip(of(&back)) {
        assert!((a - b).abs() < 1e-12, "{a} {b}");
    }
    for format in [Format::Urdf, Format::Sdf] {
        let notes = export(&own, "own", format).map_or_else(|_| Vec::new(), |exported| exported.notes);
        assert!(notes.is_empty() || notes.iter().any(|(path, words)| path == "/seat" && words.contains("not written")));
    }
    folder.file("own/scene.toml", format!("{SCENE}\n[[bushing]]\nname = \"mount\"\nbetween = [\"/\", \"/base/turn/arm\"]\nstiffness = [1.0, 2.0, 30.0]\n"));
    folder.file("own/experiment.toml", "title = \"own\"\nduration = 0.1\nstep = 0.01\nrecord = [\"energy.total\"]\n");
    let own =
        sincro_scene::open::open(&folder.path().join("own"), &[], sincro_scene::fmu::Loaders::default(), true).unwrap();
    let exported = export(&own.scene, "own", Format::Mjcf).unwrap();
    assert!(!exported.text.contains("<weld") && !exported.text.contains("<connect"), "{}", exported.text);
    assert!(exported.notes.iter().any(|(path, words)| path == "/mount" && words.contains("not written")));
}

/// MuJoCo 4.0.0 measures 100 000.0 N/m and 5000.0 N·m/rad, load over deflection after 20 s with a steady force of 10 N
/// or torque of 0.1 N·m, on a weld of these keys to a free body of 2 kg and 0.1 kg·m²; 1250.0 N·m/rad with the torque
/// scale 1.
#[test]
fn bushings_yield_in_mujoco_as_here() {
    for (turning, scale) in [((5000.0, 200.0), "2"), ((1250.0, 50.0), "1")] {
        let folder = Folder::new();
        let scene = format!(
            "[[joint]]\nname = \"free\"\nkind = \"free\"\n[[body]]\nname = \"cab\"\nparent = \"/free\"\nmass = 2.0\n\
             inertia = {{ xx = 0.1, yy = 0.1, zz = 0.1 }}\n[[bushing]]\nname = \"mount\"\nbetween = [\"/\", \"/free/cab\"]\n\
             stiffness = 1e5\ndamping = 4000.0\nrotational_stiffness = {:?}\nrotational_damping = {:?}\n",
            turning.0, turning.1
        );
        folder.file("own/scene.toml", scene);
        let experiment = "title = \"own\"\nduration = 0.1\nstep = 0.01\nrecord = [\"energy.total\"]\n";
        folder.file("own/experiment.toml", experiment);
        let loaders = sincro_scene::fmu::Loaders::default();
        let own = sincro_scene::open::open(&folder.path().join("own"), &[], loaders, true).unwrap();
        let text = export(&own.scene, "own", Format::Mjcf).unwrap().text;
        let weld = text.lines().find(|line| line.contains("<weld")).unwrap_or_else(|| panic!("{text}"));
        let number = |key: &str, k: usize| {
            let (_, rest) = weld.split_once(&format!("{key}=\"")).unwrap();
            rest.split(['"', ' ']).nth(k).unwrap().parse::<f64>().unwrap()
        };
        let expected = [("torquescale", 0, scale.parse().unwrap()), ("solref", 0, -2500.0), ("solref", 1, -100.0)];
        for (key, k, expected) in expected {
            assert!((number(key, k) - expected).abs() < 1e-9 * expected.abs(), "{weld}");
        }
        assert!(weld.contains("solimp=\"0.95 0.95 0.001\""), "{weld}");
    }
}

#[test]
fn activations_come_back_from_mjcf() {
    let folder = Folder::new();
    let actuated = format!(
        "{}\n{}",
        SCENE.replace(
            "motor = { mode = \"torque\", max_torque = 5.0 }",
            "motor = { mode = \"torque\", max_torque = 5.0, activation = { kind = \"filter\", time_constant = 0.05, range = { lower = -2.0, upper = 1.5 } } }"
        )
        .replace(
            "damping = 0.3",
            "damping = 0.3\nmotor = { mode = \"spring\", stiffness = 8.0, damping = 0.5, activation = { kind = \"integrator\", input_range = { lower = -1.0, upper = 3.0 } } }"
        ),
        "[[tendon]]\nname = \"cord\"\njoints = [\"/base/turn/arm/slide\"]\ncoefficients = [2.0]\nactuator = { max_force = 3.0, activation = { kind = \"filter\", time_constant = 0.2 } }\n"
    );
    folder.file("own/scene.toml", &actuated);
    folder.file("own/experiment.toml", EXPERIMENT);
    let loaders = sincro_scene::fmu::Loaders::default();
    let own = sincro_scene::open::open(&folder.path().join("own"), &[], loaders, true).unwrap().scene;
    let exported = export(&own, "own", Format::Mjcf).unwrap();
    let imported = folder.import("r.xml", &exported.text).unwrap_or_else(|found| panic!("{found}\n{}", exported.text));
    let back = folder.open(&imported).scene.model;
    assert_eq!(back.activations(), own.model.activations(), "{}", exported.text);
    assert_eq!(back.activations().len(), 3);
    assert_eq!(back.motors(), own.model.motors());
    // other formats say what they leave out
    let notes = export(&own, "own", Format::Urdf).unwrap().notes;
    let left_out = notes.iter().filter(|(_, words)| words.contains("the activation of its motor is not written"));
    assert_eq!(left_out.count(), 2, "{notes:?}");
}

#[test]
fn polynomial_couplings_come_back_from_mjcf_and_are_noted_elsewhere() {
    let folder = Folder::new();
    let coupling = "[[coupling]]\nname = \"cam\"\njoints = [\"/base/turn\", \"/base/turn/arm/slide\"]\nratio = -0.2\npolynomial = [0.3, 0.0, -0.05]\n";
    folder.file("own/scene.toml", format!("{SCENE}\n{coupling}"));
    folder.file("own/experiment.toml", EXPERIMENT);
    let loaders = sincro_scene::fmu::Loaders::default();
    let own = sincro_scene::open::open(&folder.path().join("own"), &[], loaders, true).unwrap().scene;
    let exported = export(&own, "own", Format::Mjcf).unwrap();
    assert!(exported.text.contains("polycoef=\"0 -0.2 0.3 0 -0.05\""), "{}", exported.text);
    let imported = folder.import("r.xml", &exported.text).unwrap_or_else(|found| panic!("{found}"));
    let (back, gear) = (folder.open(&imported).scene.model, &own.model.constraints().gears[0]);
    assert_eq!(back.constraints().gears[0].higher, gear.higher);
    let urdf = export(&own, "own", Format::Urdf).unwrap();
    assert!(!urdf.text.contains("<mimic") && urdf.notes.iter().any(|(_, words)| words.contains("polynomial")));
}

#[test]
fn what_mjcf_says_otherwise_of_joints_and_motors_is_noted() {
    let with = |joint: &str| {
        let folder = Folder::new();
        let body = "[[body]]\nname = \"b\"\nparent = \"/j\"\nmass = 1.0\ninertia = { xx = 0.1, yy = 0.1, zz = 0.1 }\n";
        folder.file("own/scene.toml", format!("[[joint]]\nname = \"j\"\n{joint}\n{body}"));
        folder.file("own/experiment.toml", EXPERIMENT);
        let path = folder.path().join("own");
        let opened = sincro_scene::open::open(&path, &[], sincro_scene::fmu::Loaders::default(), true);
        let scene = opened.unwrap_or_else(|found| panic!("{found}")).scene;
        export(&scene, "own", Format::Mjcf)
            .unwrap()
            .notes
            .into_iter()
            .map(|(path, words)| {
                assert_eq!(path, "/j");
                words
            })
            .collect::<Vec<_>>()
    };
    let universal = "kind = \"universal\"\naxis = [1.0, 0.0, 0.0]\naxis2 = [0.0, 1.0, 0.0]\n";
    let (split, zero) = ("are joints each", "MJCF starts it at zero");
    for (joint, notes) in [
        (universal.to_owned(), vec![split]),
        (format!("{universal}initial = {{ position = [0.1, 0.0] }}"), vec![zero, split]),
        ("kind = \"planar\"".to_owned(), vec![split]),
        ("kind = \"planar\"\ninitial = { position = [0.0, 0.0, 0.5] }".to_owned(), vec![zero, split]),
        ("kind = \"ball\"".to_owned(), vec![]),
        ("kind = \"ball\"\ndamping = [0.1, 0.1, 0.1]\narmature = [0.02, 0.02, 0.02]".to_owned(), vec![]),
        (
            "kind = \"ball\"\ndamping = [0.1, 0.5, 2.0]\narmature = [0.01, 0.05, 0.2]".to_owned(),
            vec!["its damping is not written", "its armature is not written"],
        ),
        ("kind = \"free\"\ndamping = [1.0, 2.0, 3.0, 4.0, 5.0, 6.0]".to_owned(), vec!["its damping is not written"]),
        (
            format!("{universal}limits = [{{ lower = -0.5, upper = 0.5 }}, {{ lower = -1.0, upper = 1.0 }}]"),
            vec![split],
        ),
        ("kind = \"ball\"\ninitial = { position = [0.6, 0.8, 0.0, 0.0] }".to_owned(), vec![zero]),
        ("kind = \"revolute\"\ninitial = { position = 0.1 }".to_owned(), vec![zero]),
        (
            "kind = \"revolute\"\nmotor = { mode = \"voltage\", command = 3.0, resistance = 1.0, torque_constant = 0.05, activation = { kind = \"integrator\" } }".to_owned(),
            vec![
                "the command of its motor is not written",
                "take a voltage: none is written",
                "the activation of its motor is not written",
            ],
        ),
    ] {
        let found = with(&joint);
        let is_told = notes.len() == found.len() && notes.iter().zip(&found).all(|(words, note)| note.contains(words));
        assert!(is_told, "{joint}: {found:?}");
    }
}
