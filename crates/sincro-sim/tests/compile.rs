//! Compilation of a scene file: masses, poses, order, initial states, signals.

use sincro_dynamics::joint::JointKind;
use sincro_dynamics::signal::Signal;
use sincro_scene::scene::ObjectKind;
use sincro_sim::Loaded;
use sincro_testing::{SceneFolder, scenes};

fn with_scene(scene: &str) -> Loaded {
    let folder = SceneFolder::new().with("scene.toml", scene);
    folder.write("experiment.toml", "title = \"T\"\nduration = 1.0\nstep = 0.01\nrecord = [\"energy.total\"]\n");
    folder.load(&[]).unwrap_or_else(|diagnostics| panic!("{diagnostics}"))
}

#[test]
fn the_order_in_the_file_does_not_matter() {
    let folder = scenes::sprung_arm();
    let blocks: Vec<&str> = scenes::SPRUNG_ARM.split("\n\n").collect();
    let turned: Vec<&str> = blocks[1..].iter().rev().copied().collect();
    folder.write("scene.toml", &format!("{}\n\n{}\n", blocks[0], turned.join("\n\n")));
    let (turned, straight) = (folder.load(&[]).unwrap().scene, scenes::sprung_arm().load(&[]).unwrap().scene);
    let paths = |scene: &sincro_scene::scene::Scene| scene.objects.iter().map(|o| o.path.clone()).collect::<Vec<_>>();
    assert_eq!(paths(&turned), paths(&straight));
    assert_eq!(turned.initial, straight.initial);
    assert_eq!(paths(&straight)[..3], ["/shoulder", "/shoulder/rod", "/shoulder/rod/tip"]);
    assert_eq!(straight.objects[2].parent, Some(1));
}

fn mass_of(loaded: &Loaded, path: &str) -> sincro_dynamics::model::MassProperties {
    match loaded.scene.object(path).unwrap().kind {
        ObjectKind::Body { mass } => mass,
        _ => panic!("{path} is no body"),
    }
}

/// Two cubes of 0.1 m side by side are a brick; at a given mass the same, scaled.
#[test]
fn shapes_are_summed_and_scaled() {
    let cubes = "shape = [ { cuboid = { size = [0.1, 0.1, 0.1] }, position = [-0.05, 0, 0] }, \
                 { cuboid = { size = [0.1, 0.1, 0.1] }, position = [0.05, 0, 0] } ]";
    let loaded = with_scene(&format!(
        "[[joint]]\nname = \"j\"\nkind = \"free\"\n[[body]]\nname = \"a\"\nparent = \"/j\"\ndensity = 1000\n{cubes}\n\
         [[body]]\nname = \"b\"\nparent = \"/j\"\nmass = 4\n{cubes}\n"
    ));
    let (a, b) = (mass_of(&loaded, "/j/a"), mass_of(&loaded, "/j/b"));
    assert!((a.mass - 2.0).abs() < 1e-12 && b.mass == 4.0);
    let brick = [2.0 / 12.0 * 0.02, 0.0, 0.0, 2.0 / 12.0 * 0.05, 0.0, 2.0 / 12.0 * 0.05];
    for k in 0..6 {
        assert!((a.inertia[k] - brick[k]).abs() < 1e-12, "{:?}", a.inertia);
        assert!((b.inertia[k] - 2.0 * brick[k]).abs() < 1e-12);
    }
}

#[test]
fn initial_states_of_every_kind_of_joint() {
    let mut scene = String::new();
    let joints = [
        ("u", "universal", "position = [0.1, 0.2], velocity = [1, 2]"),
        ("p", "planar", "position = [0.3, 0.4, 0.5]"),
        ("b", "ball", "position = [0.6, 0, 0.8, 0], velocity = [3, 4, 5]"),
        ("f", "free", "position = [1, 2, 3, 0, 1, 0, 0], velocity = [1, 2, 3, 4, 5, 6]"),
    ];
    for (name, kind, initial) in joints {
        scene += &format!("[[joint]]\nname = \"{name}\"\nkind = \"{kind}\"\ninitial = {{ {initial} }}\n");
        scene += &format!(
            "[[body]]\nname = \"m\"\nparent = \"/{name}\"\ndensity = 1\nshape = [{{ sphere = {{ radius = 1 }} }}]\n"
        );
    }
    let state = with_scene(&scene).scene.initial.clone();
    assert_eq!(state.q, [0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.0, 0.8, 0.0, 1.0, 2.0, 3.0, 0.0, 1.0, 0.0, 0.0]);
    assert_eq!(state.v, [1.0, 2.0, 0.0, 0.0, 0.0, 3.0, 4.0, 5.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0]);
}

#[test]
fn lists_have_one_entry_a_degree_of_freedom() {
    let loaded = with_scene(
        "[[joint]]\nname = \"u\"\nkind = \"universal\"\ndamping = [1, 2]\nspring = [{ stiffness = 3 }, { stiffness = 4, rest = 5 }]\n\
         armature = [6, 7]\ntorque = [0, { constant = 8 }]\n[[body]]\nname = \"m\"\nparent = \"/u\"\ndensity = 1\n\
         shape = [{ capsule = { radius = 0.1, length = 1 } }]\n",
    );
    let dofs = loaded.scene.model.dofs();
    let of = |k: usize| [dofs[k].damping, dofs[k].stiffness, dofs[k].rest, dofs[k].armature, dofs[k].torque];
    assert_eq!((of(0), of(1)), ([1.0, 3.0, 0.0, 6.0, 0.0], [2.0, 4.0, 5.0, 7.0, 8.0]));
    assert!(matches!(
        loaded.scene.objects[0].kind,
        ObjectKind::Joint { kind: JointKind::Universal { .. }, motor: None }
    ));
}

#[test]
fn signals_are_read() {
    let cases = [
        ("2", Signal::Constant(2.0)),
        ("{ constant = 3.0 }", Signal::Constant(3.0)),
        ("{ step = { time = 0.5, to = 1 } }", Signal::Step { time: 0.5, from: 0.0, to: 1.0 }),
        ("{ ramp = { slope = 2 } }", Signal::Ramp { start: 0.0, slope: 2.0, from: 0.0, until: f64::INFINITY }),
        (
            "{ ramp = { slope = 2, until = inf } }",
            Signal::Ramp { start: 0.0, slope: 2.0, from: 0.0, until: f64::INFINITY },
        ),
        (
            "{ sine = { amplitude = 1, frequency_hz = 0.5, phase = 1 } }",
            Signal::Sine { amplitude: 1.0, angular_frequency: std::f64::consts::PI, phase: 1.0, offset: 0.0 },
        ),
        (
            "{ pulse = { period = 1, width = 0.25 } }",
            Signal::Pulse { period: 1.0, width: 0.25, low: 0.0, high: 1.0, start: 0.0 },
        ),
        (
            "{ table = { times = [0, 1], values = [2, 3], interpolation = \"hold\" } }",
            Signal::Table { times: [0.0, 1.0].into(), values: [2.0, 3.0].into(), linear: false },
        ),
        (
            "{ table = { file = \"reference.csv\", column = \"x\" } }",
            Signal::Table { times: [0.0, 0.5, 1.0].into(), values: [0.0, 1.0, 2.0].into(), linear: true },
        ),
    ];
    for (text, signal) in cases {
        let folder = scenes::sprung_arm();
        folder.change("scene.toml", "{ ramp = { slope = 1.0 } }", text);
        assert_eq!(folder.load(&[]).unwrap_or_else(|e| panic!("{e}")).scene.commands, [signal], "{text}");
    }
}

#[test]
fn motors_and_commands_are_paired() {
    let joint = |name: &str, command: f64| {
        format!(
            "[[joint]]\nname = \"{name}\"\nkind = \"revolute\"\nmotor = {{ mode = \"torque\", command = {command} }}\n[[body]]\n\
             name = \"m\"\nparent = \"/{name}\"\nmass = 1\ninertia = {{ xx = 1, yy = 1, zz = 1 }}\n"
        )
    };
    let scene = with_scene(&(joint("z", 1.0) + &joint("a", 2.0) + &joint("m", 3.0))).scene;
    assert_eq!(scene.commands, [1.0, 2.0, 3.0].map(Signal::Constant));
    for (name, motor) in [("/z", 0), ("/a", 1), ("/m", 2)] {
        assert_eq!(scene.model.names().joint(name).unwrap().motor.map(|id| id.index()), Some(motor));
        assert!(matches!(scene.object(name).unwrap().kind, ObjectKind::Joint { motor: Some(m), .. } if m == motor));
    }
}

#[test]
fn shapes_keep_their_colour_and_place() {
    let scene = scenes::sprung_arm().load(&[]).unwrap().scene;
    let shape = &scene.object("/shoulder/rod").unwrap().shapes[0];
    assert_eq!((shape.color, shape.density), (Some([0x8a, 0x5a, 0x2b]), Some(1000.0)));
    assert_eq!(shape.pose.pos.0, [0.0, 0.0, 0.25]);
}

#[test]
fn a_nearly_unit_quaternion_is_made_one() {
    let folder = scenes::sprung_arm();
    folder.change(
        "scene.toml",
        "kind = \"revolute\"\nmotor",
        "kind = \"ball\"\ninitial = { position = [0.6000001, 0, 0.8, 0] }\n# motor",
    );
    let q = folder.load(&[]).unwrap().scene.initial.q.clone();
    let norm: f64 = q[1..].iter().map(|x| x * x).sum();
    assert!((norm - 1.0).abs() < 1e-15);
}

#[test]
fn a_long_chain_is_no_reason_to_fall_over() {
    let mut scene = String::new();
    let mut parent = String::new();
    for k in 0..400 {
        scene += &format!("[[frame]]\nname = \"f{k}\"\nparent = \"{}\"\n", if k == 0 { "/" } else { &parent });
        parent += &format!("/f{k}");
    }
    assert_eq!(with_scene(&scene).scene.objects.len(), 400);
}
