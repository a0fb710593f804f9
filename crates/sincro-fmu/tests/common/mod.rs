//! FMUs that a C compiler makes from sources beside the tests, and the scene that they drive.

// each test uses a part of it
#![allow(dead_code)]

use std::path::Path;
use std::process::Command;

use sincro_fmu::FmiVersion;
use sincro_fmu::archive::pack;
use sincro_fmu::platform::Platform;
use sincro_testing::SceneFolder;

/// A cart on a slide, driven by a force.
pub const SCENE: &str = "
    joint = [{ name = \"slide\", kind = \"prismatic\", axis = [1, 0, 0], motor = { mode = \"torque\" } }]
    [[body]]
    name = \"cart\"
    parent = \"/slide\"
    mass = 1.0
    inertia = { xx = 0.01, yy = 0.01, zz = 0.01 }
";

/// FMU of `NAME.c` beside the tests with a model description.
pub fn compiled(name: &str, version: FmiVersion, description: &str) -> Vec<u8> {
    compiled_in(&Path::new(env!("CARGO_MANIFEST_DIR")).join("tests"), name, version, description)
}

/// FMU of `NAME.c` in a folder with a model description.
pub fn compiled_in(sources: &Path, name: &str, version: FmiVersion, description: &str) -> Vec<u8> {
    let folder = SceneFolder::new();
    let library = folder.join("fmu.so");
    let source = sources.join(format!("{name}.c"));
    let options = ["-shared", "-fPIC", "-ffp-contract=off", "-o"];
    let status = Command::new("cc").args(options).arg(&library).arg(source).status();
    assert!(status.expect("there is a C compiler").success());
    let platform = Platform::here().expect("a platform that FMI names");
    let path = format!("binaries/{}/{name}.{}", platform.folder(version), platform.ending());
    let bytes = std::fs::read(library).unwrap();
    pack(&[("modelDescription.xml".into(), description.as_bytes().to_vec()), (path, bytes)]).unwrap()
}
