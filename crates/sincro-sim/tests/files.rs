//! Folders and files that cannot be read.

mod common;

use std::path::Path;

use common::TestFolder;
use sincro_sim::Extensions;
use sincro_sim::load;

fn refused(folder: &TestFolder, path: &Path) -> String {
    folder.short(&load(path, &[], Extensions::default()).expect_err("it cannot be read").to_string())
}

#[test]
fn a_folder_that_is_not_there() {
    let folder = TestFolder::new();
    assert_eq!(
        refused(&folder, &folder.path.join("absent")),
        "error: there is no folder `absent`\n  help: name a folder with an `experiment.toml`"
    );
}

#[test]
fn a_folder_without_an_experiment() {
    let folder = TestFolder::new();
    let empty = folder.path.join("empty");
    std::fs::create_dir(&empty).unwrap();
    assert_eq!(
        refused(&folder, &empty),
        "error: the folder `empty` has no `experiment.toml`\n  help: name a folder with an `experiment.toml`"
    );
    let above = folder.path.join("above/scene-1");
    std::fs::create_dir_all(&above).unwrap();
    std::fs::write(above.join("experiment.toml"), "").unwrap();
    assert_eq!(
        refused(&folder, &folder.path.join("above")),
        "error: the folder `above` has no `experiment.toml`\n  help: there is one in `above/scene-1`"
    );
}

#[test]
fn the_experiment_file_names_its_folder() {
    let folder = TestFolder::new();
    assert!(load(&folder.path.join("experiment.toml"), &[], Extensions::default()).is_ok());
    assert_eq!(
        refused(&folder, &folder.path.join("scene.toml")),
        "error: `scene.toml` is not a folder and not an `experiment.toml`\n  help: name a folder with an `experiment.toml`"
    );
}

#[test]
fn a_scene_file_that_is_not_there_and_not_named() {
    let folder = TestFolder::new();
    folder.change("experiment.toml", "scene = \"scene.toml\"\n", "");
    assert!(load(&folder.path, &[], Extensions::default()).is_ok());
    std::fs::remove_file(folder.path.join("scene.toml")).unwrap();
    assert_eq!(
        refused(&folder, &folder.path),
        "error: there is no file `scene.toml`\n  help: name the scene file in `experiment.toml`: scene = \"scene.toml\""
    );
}

#[test]
fn files_that_are_no_text() {
    let folder = TestFolder::new();
    std::fs::write(folder.path.join("scene.toml"), b"gravity = [0, 0, 0]\n# caf\xe9\n").unwrap();
    assert_eq!(
        refused(&folder, &folder.path).lines().next(),
        Some("experiment.toml:2:9: error: `scene.toml` is not UTF-8 text (line 2)")
    );
    std::fs::remove_file(folder.path.join("scene.toml")).unwrap();
    std::fs::create_dir(folder.path.join("scene.toml")).unwrap();
    assert_eq!(
        refused(&folder, &folder.path).lines().next(),
        Some("experiment.toml:2:9: error: `scene.toml` is a folder, not a file")
    );
}

#[test]
fn files_that_are_too_large_are_not_read() {
    let folder = TestFolder::new();
    let file = std::fs::File::create(folder.path.join("scene.toml")).unwrap();
    file.set_len(1 << 40).unwrap();
    assert_eq!(
        refused(&folder, &folder.path).lines().next(),
        Some("experiment.toml:2:9: error: `scene.toml` has 1099511627776 bytes, more than 64 MiB")
    );
}

#[test]
fn problems_of_both_files_are_told_at_once() {
    let folder = TestFolder::new();
    folder.change("experiment.toml", "step = 0.01", "stpe = 0.01");
    folder.change("scene.toml", "damping = 0.5", "damping = \"much\"");
    folder.change("scene.toml", "mass = 0.5", "mass = -0.5");
    let said = refused(&folder, &folder.path);
    let places: Vec<&str> =
        said.lines().filter(|l| !l.starts_with(' ')).map(|l| l.split(' ').next().unwrap()).collect();
    assert_eq!(places, ["experiment.toml:1:1:", "experiment.toml:4:1:", "scene.toml:8:11:", "scene.toml:31:8:"]);
}

#[test]
fn a_byte_order_mark_is_no_part_of_the_text() {
    let folder = TestFolder::new();
    folder.write("scene.toml", &format!("\u{feff}{}", common::SCENE));
    assert!(load(&folder.path, &[], Extensions::default()).is_ok());
}

#[test]
fn broken_toml_is_told_line_by_line() {
    let folder = TestFolder::new();
    folder.write("experiment.toml", "title = \nstep = 1\nstep = 2\n");
    let said = refused(&folder, &folder.path);
    assert!(
        said.contains("experiment.toml:1:") && said.contains("experiment.toml:3:1: error: duplicate key"),
        "{said}"
    );
}
