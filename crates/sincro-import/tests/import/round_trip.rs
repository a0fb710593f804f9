//! Scenes that are exported to MJCF and imported again: the same model, to the last bit, where MJCF says it completely.

use std::path::{Path, PathBuf};

use sincro_import::export::{Format, export};
use sincro_scene::fmu::Loaders;
use sincro_scene::open::open;
use sincro_scene::scene::Scene;

use crate::folder::Folder;

const EXPERIMENT: &str = "title = \"own\"\nduration = 0.1\nstep = 1e-3\nrecord = [\"energy.total\"]\n";

/// Notes that do not concern the model: its start, commands, what only shows, and the softness of MuJoCo's constraints.
const BESIDE_THE_MODEL: [&str; 8] = [
    "MJCF starts it at zero",
    "the command of its motor is not written",
    "the command of its actuator is not written",
    "a camera is not written",
    "MJCF's loops are soft",
    "MJCF's couplings are soft",
    "velocities at the start are not written",
    "the friction of two bodies is the geometric mean",
];

/// Folders of a folder of the repository that have a scene, in the order of their names.
fn folders(name: &str) -> Vec<PathBuf> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..").join(name);
    let inside = |folder: &Path| -> Vec<PathBuf> {
        std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()).filter(|path| path.is_dir()).collect()
    };
    let mut all: Vec<PathBuf> =
        inside(&root).iter().flat_map(|folder| [vec![folder.clone()], inside(folder)].concat()).collect();
    all.retain(|folder| folder.join("scene.toml").is_file());
    all.sort();
    all
}

/// The scene of a folder, without what its experiment names beside it; none if it needs more than this crate has.
fn scene_of(path: &Path, folder: &Folder) -> Option<Scene> {
    for file in std::fs::read_dir(path).unwrap().map(|f| f.unwrap().path()).filter(|f| f.is_file()) {
        let name = file.file_name().unwrap().to_string_lossy().into_owned();
        folder.file(&format!("own/{name}"), std::fs::read(&file).unwrap());
    }
    folder.file("own/experiment.toml", EXPERIMENT);
    open(&folder.path().join("own"), &[], Loaders::default(), true).ok().map(|opened| opened.scene)
}

/// Exports a scene and imports it again. The reasons why MJCF does not say its model, empty if it says it completely,
/// and the lines of the model that differ.
fn round_trip(own: &Scene, folder: &Folder) -> (Vec<String>, Vec<String>) {
    let exported = match export(own, "own", Format::Mjcf) {
        Ok(exported) => exported,
        Err(why) => return (why, Vec::new()),
    };
    exported.meshes.iter().for_each(|(file, bytes)| drop(folder.file(file, bytes)));
    let imported =
        folder.import("robot.xml", &exported.text).unwrap_or_else(|found| panic!("{found}\n{}", exported.text));
    let back = folder.open(&imported).scene;
    // the hash of a model is that of its debug form: every number and name in it counts
    let (before, after) = (format!("{:#?}", own.model), format!("{:#?}", back.model));
    let notes = exported.notes.into_iter().filter(|(_, words)| !BESIDE_THE_MODEL.iter().any(|b| words.starts_with(b)));
    let differences = before.lines().zip(after.lines()).filter(|(a, b)| a != b).take(8);
    let lines = differences.map(|(a, b)| format!("{} -> {}", a.trim(), b.trim())).collect();
    let lines =
        if before.len() == after.len() || before == after { lines } else { [lines, vec!["length".into()]].concat() };
    (notes.map(|(path, words)| format!("{path}: {words}")).collect(), lines)
}

#[test]
fn robots_in_the_box_come_back_as_the_same_model_or_it_is_said_why_not() {
    let cannot = [
        ("delta", "moves on a joint and has no mass"),
        ("line-follower", "a sensor is not written"),
        ("pioneer-p3dx", "MJCF has no cones and tori"),
        ("quadcopter", "a rotor is not written"),
    ];
    let all = folders("models");
    assert_eq!(all.len(), 8);
    for path in all {
        let (name, folder) = (path.file_name().unwrap().to_string_lossy().into_owned(), Folder::new());
        let own = scene_of(&path, &folder).unwrap();
        let (reasons, lines) = round_trip(&own, &folder);
        match cannot.iter().find(|(known, _)| *known == name) {
            Some((_, reason)) => assert!(reasons.iter().any(|r| r.contains(reason)), "{name}: {reasons:#?}"),
            None => assert!(reasons.is_empty() && lines.is_empty(), "{name}: {reasons:#?} {lines:#?}"),
        }
    }
}

#[test]
fn scenes_that_mjcf_says_completely_come_back_as_the_same_model() {
    let mut complete = Vec::new();
    for path in folders("scenes") {
        let folder = Folder::new();
        // some need scripts or FMUs, which this crate does not read
        let Some(own) = scene_of(&path, &folder) else { continue };
        let (reasons, lines) = round_trip(&own, &folder);
        if reasons.is_empty() {
            assert!(lines.is_empty(), "{}: {lines:#?}", path.display());
            complete.push(path.file_name().unwrap().to_string_lossy().into_owned());
        }
    }
    for name in ["acrobot", "cart-pole-balance", "humanoid", "free-body", "rolling-sphere", "gazebo-boxes-complex"] {
        assert!(complete.iter().any(|known| known == name), "{name} is none of {complete:?}");
    }
    assert!(complete.len() >= 19, "{complete:?}");
}

/// A file that was changed after the export: the bodies count, and what they contradict is told.
#[test]
fn frames_of_custom_data_give_way_to_the_bodies() {
    let folder = Folder::new();
    let path = folders("models").into_iter().find(|path| path.ends_with("ur5e")).unwrap();
    let own = scene_of(&path, &folder).unwrap();
    let text = export(&own, "own", Format::Mjcf).unwrap().text;
    let moved = text.replacen("<body name=\"forearm\" pos=\"", "<body name=\"forearm\" pos=\"0.5 0 0\" user=\"", 1);
    assert_ne!(moved, text);
    let imported = folder.import("robot.xml", &moved).unwrap_or_else(|found| panic!("{found}"));
    let warnings = format!("{:?}", imported.report.warnings);
    assert!(warnings.contains("frames of custom data that the bodies contradict are not taken: forearm"), "{warnings}");
    let back = folder.open(&imported).scene;
    let place = |scene: &Scene, path: &str| scene.object(path).unwrap().pose.pos.0;
    assert_eq!(place(&back, "/pan/shoulder/lift"), place(&own, "/pan/shoulder/lift"));
    assert!(back.object("/pan/shoulder/lift/upper_arm/elbow").is_some());
}

/// Angles whose shortest degrees are those of a neighbour: the file has a rotation that is read as exactly theirs, or
/// the note that it has not.
#[test]
fn rotations_of_many_digits_come_back_or_it_is_said_why_not() {
    let mut n_same = 0;
    for angles in [
        "-16.48863093628581, -59.9564284812669, -152.5777779995412",
        "97.2801068507142, 41.16844534591898, 80.5646530146497",
        "10.00000000000001, 20.00000000000001, 30.00000000000001",
        "30.0, 0.0, 0.0",
    ] {
        let folder = Folder::new();
        let joint = format!(
            "[[joint]]\nname = \"j\"\nkind = \"revolute\"\naxis = [0.0, 1.0, 0.0]\nrotation_deg = [{angles}]\n"
        );
        let body = "[[body]]\nname = \"b\"\nparent = \"/j\"\nmass = 1.0\ninertia = { xx = 0.1, yy = 0.1, zz = 0.1 }\n";
        folder.file("given/scene.toml", format!("{joint}{body}"));
        let own = scene_of(&folder.path().join("given"), &folder).unwrap();
        let (reasons, lines) = round_trip(&own, &folder);
        assert_eq!(lines.is_empty(), reasons.is_empty(), "{angles}: {reasons:?} {lines:#?}");
        n_same += usize::from(lines.is_empty());
    }
    assert!(n_same > 0);
}
