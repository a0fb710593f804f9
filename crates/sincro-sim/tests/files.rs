//! Folders and files that cannot be read.

use std::path::Path;
use std::sync::atomic::AtomicBool;

use sincro_sim::Extensions;
use sincro_sim::campaign::run_campaign;
use sincro_sim::load;
use sincro_testing::{SceneFolder, scenes};

fn refused(folder: &SceneFolder, path: &Path) -> String {
    folder.short(&load(path, &[], Extensions::default()).expect_err("it cannot be read").to_string())
}

#[test]
fn a_folder_that_is_not_there() {
    let folder = scenes::sprung_arm();
    assert_eq!(
        refused(&folder, &folder.join("absent")),
        "error: there is no folder `absent`\n  help: name a folder with an `experiment.toml`"
    );
}

#[test]
fn a_folder_without_an_experiment() {
    let folder = scenes::sprung_arm();
    let empty = folder.join("empty");
    std::fs::create_dir(&empty).unwrap();
    assert_eq!(
        refused(&folder, &empty),
        "error: the folder `empty` has no `experiment.toml`\n  help: name a folder with an `experiment.toml`"
    );
    let above = folder.join("above/scene-1");
    std::fs::create_dir_all(&above).unwrap();
    std::fs::write(above.join("experiment.toml"), "").unwrap();
    assert_eq!(
        refused(&folder, &folder.join("above")),
        "error: the folder `above` has no `experiment.toml`\n  help: there is one in `above/scene-1`"
    );
}

#[test]
fn the_experiment_file_names_its_folder() {
    let folder = scenes::sprung_arm();
    assert!(load(&folder.join("experiment.toml"), &[], Extensions::default()).is_ok());
    assert_eq!(
        refused(&folder, &folder.join("scene.toml")),
        "error: `scene.toml` is not a folder and not an `experiment.toml`\n  help: name a folder with an `experiment.toml`"
    );
}

#[test]
fn a_scene_file_that_is_not_there_and_not_named() {
    let folder = scenes::sprung_arm();
    folder.change("experiment.toml", "scene = \"scene.toml\"\n", "");
    assert!(load(&folder, &[], Extensions::default()).is_ok());
    std::fs::remove_file(folder.join("scene.toml")).unwrap();
    assert_eq!(
        refused(&folder, &folder),
        "error: there is no file `scene.toml`\n  help: name the scene file in `experiment.toml`: scene = \"scene.toml\""
    );
}

#[test]
fn files_that_are_no_text() {
    let folder = scenes::sprung_arm();
    std::fs::write(folder.join("scene.toml"), b"gravity = [0, 0, 0]\n# caf\xe9\n").unwrap();
    assert_eq!(
        refused(&folder, &folder).lines().next(),
        Some("experiment.toml:2:9: error: `scene.toml` is not UTF-8 text (line 2)")
    );
    std::fs::remove_file(folder.join("scene.toml")).unwrap();
    std::fs::create_dir(folder.join("scene.toml")).unwrap();
    assert_eq!(
        refused(&folder, &folder).lines().next(),
        Some("experiment.toml:2:9: error: `scene.toml` is a folder, not a file")
    );
}

#[test]
fn files_that_are_too_large_are_not_read() {
    let folder = scenes::sprung_arm();
    let file = std::fs::File::create(folder.join("scene.toml")).unwrap();
    file.set_len(1 << 40).unwrap();
    assert_eq!(
        refused(&folder, &folder).lines().next(),
        Some("experiment.toml:2:9: error: `scene.toml` has 1099511627776 bytes, more than 64 MiB")
    );
}

#[test]
fn problems_of_both_files_are_told_at_once() {
    let folder = scenes::sprung_arm();
    folder.change("experiment.toml", "step = 0.01", "stpe = 0.01");
    folder.change("scene.toml", "damping = 0.5", "damping = \"much\"");
    folder.change("scene.toml", "mass = 0.5", "mass = -0.5");
    let said = refused(&folder, &folder);
    let places: Vec<&str> =
        said.lines().filter(|l| !l.starts_with(' ')).map(|l| l.split(' ').next().unwrap()).collect();
    assert_eq!(places, ["scene.toml:8:11:", "scene.toml:31:8:", "experiment.toml:1:1:", "experiment.toml:4:1:"]);
}

#[test]
fn a_byte_order_mark_is_no_part_of_the_text() {
    let folder = scenes::sprung_arm();
    folder.write("scene.toml", &format!("\u{feff}{}", scenes::SPRUNG_ARM));
    assert!(load(&folder, &[], Extensions::default()).is_ok());
}

#[test]
fn broken_toml_is_told_line_by_line() {
    let folder = scenes::sprung_arm();
    folder.write("experiment.toml", "title = \nstep = 1\nstep = 2\n");
    let said = refused(&folder, &folder);
    assert!(
        said.contains("experiment.toml:1:") && said.contains("experiment.toml:3:1: error: duplicate key"),
        "{said}"
    );
}

#[test]
fn variants_and_points_of_a_sweep_read_nothing_again() {
    let folder = scenes::sprung_arm();
    folder.write("tetrahedron.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n");
    folder.write(
        "diagram.toml",
        "block = [{ name = \"one\", type = \"constant\", value = 1.0 }]\nwires = [\"one -> /shoulder/rod/tip/wrist\"]\n",
    );
    folder.change(
        "scene.toml",
        "mass = 0.5\ninertia = { xx = 0.001, yy = 0.001, zz = 0.001 }",
        "density = 100.0\nshape = [{ mesh = { file = \"tetrahedron.obj\", scale = 0.1 } }]",
    );
    folder.change("experiment.toml", "\"integrator\" = \"rk4\"", "\"diagram\" = \"diagram.toml\"");
    let loaded = folder.load(&[]).unwrap_or_else(|message| panic!("{message}"));
    let path = folder.to_path_buf();
    drop(folder);
    assert!(!path.exists());
    let campaign = run_campaign(&path, &[], &loaded, None, &AtomicBool::new(false), &mut |_, _| {}).unwrap();
    assert_eq!((campaign.variants.len(), campaign.sweep.unwrap().0.values.len()), (1, 3));
}
