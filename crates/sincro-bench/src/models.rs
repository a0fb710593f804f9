//! The robots: those of `crates/sincro-bench/models`, carried in the program so that it measures anywhere.

use std::fmt::Write;
use std::path::{Path, PathBuf};

use sincro_scene::scene::{self, Scene};

/// A robot and the name of its folder.
pub(super) struct Robot {
    /// As in `crates/sincro-bench/models`.
    pub name: &'static str,
    /// Compiled.
    pub scene: Scene,
}

impl Robot {
    /// Returns true if it has contact: only steps are compared then, and only with peers that know contact.
    pub fn touches(&self) -> bool {
        !self.scene.model.constraints().pairs.is_empty()
    }
}

/// Every robot, in the order of the table.
pub(super) const NAMES: [&str; 17] = [
    "pend_spring",
    "pend_free",
    "arm2",
    "arm2_free",
    "alexandros",
    "quad",
    "panda",
    "chain10",
    "chain50",
    "chain100",
    "chain200",
    "humanoid",
    "humanoid_lying",
    "heap10",
    "heap20",
    "heap40",
    "heap100",
];

/// Text of the scene of a robot.
fn text(name: &str) -> String {
    match name {
        "pend_spring" => include_str!("../models/pend_spring/scene.toml").into(),
        "pend_free" => include_str!("../models/pend_free/scene.toml").into(),
        "arm2" => include_str!("../models/arm2/scene.toml").into(),
        "arm2_free" => include_str!("../models/arm2_free/scene.toml").into(),
        "alexandros" => include_str!("../models/alexandros/scene.toml").into(),
        "quad" => include_str!("../models/quad/scene.toml").into(),
        "panda" => include_str!("../models/panda/scene.toml").into(),
        "humanoid" => include_str!("../models/humanoid/scene.toml").into(),
        "humanoid_lying" => include_str!("../models/humanoid_lying/scene.toml").into(),
        "heap10" => include_str!("../models/heap10/scene.toml").into(),
        "heap20" => include_str!("../models/heap20/scene.toml").into(),
        "heap40" => include_str!("../models/heap40/scene.toml").into(),
        "heap100" => include_str!("../models/heap100/scene.toml").into(),
        chain => chain_text(chain["chain".len()..].parse().expect("a chain's name ends in its length")),
    }
}

/// A chain of `n` links of 0.1 m and 0.1 kg, held level: the same text as in `crates/sincro-bench/models`, where it
/// takes half a megabyte.
fn chain_text(n: usize) -> String {
    let (mut joints, mut bodies, mut path) = (String::new(), String::new(), String::new());
    for k in 0..n {
        let (parent, place) = match k {
            0 => (String::new(), "initial = { position = 1.5707963267948966 }"),
            _ => (format!("parent = \"{path}\", "), "position = [0.0, 0.0, -0.1]"),
        };
        let axis = "axis = [0.0, 1.0, 0.0]";
        let _ = writeln!(joints, "  {{ name = \"j\", {parent}kind = \"revolute\", {axis}, {place} }},");
        let mass = "mass = 0.1, center_of_mass = [0.0, 0.0, -0.05]";
        let inertia = "inertia = { xx = 8.583333333333336e-5, yy = 8.583333333333336e-5, zz = 5.0e-6 }";
        let _ = writeln!(bodies, "  {{ name = \"c{k}\", parent = \"{path}/j\", {mass}, {inertia} }},");
        let _ = write!(path, "/j/c{k}");
    }
    let head = format!("Chain of {n} equal links, held level and let go. Generated.");
    format!(
        "#:schema ../../../../schemas/scene.schema.json\n# {head} The same robot as model.xml and model.urdf beside it.\n\n\
         joint = [\n{joints}]\n\nbody = [\n{bodies}]\n"
    )
}

/// The named robots, all if none is named.
pub(super) fn robots(only: &[String]) -> Result<Vec<Robot>, String> {
    if let Some(unknown) = only.iter().find(|name| !NAMES.contains(&name.as_str())) {
        return Err(format!("there is no model `{unknown}`; there are {}", NAMES.join(", ")));
    }
    let wanted = NAMES.into_iter().filter(|name| only.is_empty() || only.iter().any(|o| o == name));
    wanted.map(robot).collect()
}

/// One robot.
pub(super) fn robot(name: &'static str) -> Result<Robot, String> {
    let scene = scene::from_text(&text(name)).map_err(|p| format!("model `{name}` does not compile:\n{p}"))?;
    Ok(Robot { name, scene })
}

/// The arm `panda` with velocity motors of limited torque, dry friction and limits in every joint.
pub(super) fn limited_panda() -> Scene {
    let limits = "friction = 0.3\nmotor = { mode = \"velocity\", max_torque = 40.0, command = 0.2 }\n\
        limits = { lower = -2.2, upper = 2.2 }\n";
    let text = text("panda").replace("torque = 0.1\n", limits);
    scene::from_text(&text).expect("a scene that the program carries")
}

/// The folder with the peers' models: as given, else that of the checkout this program was built from.
pub(super) fn folder(given: Option<&Path>) -> Result<PathBuf, String> {
    let built_from = Path::new(env!("CARGO_MANIFEST_DIR")).join("models");
    let folder = given.map_or(built_from, Path::to_path_buf);
    let shown = folder.display();
    let help = "give the folder `crates/sincro-bench/models` of a checkout with --models DIR";
    if !folder.join("alexandros").join("model.xml").is_file() {
        return Err(format!("peers read their models from a checkout, and `{shown}` is not there; {help}"));
    }
    folder.canonicalize().map_err(|e| format!("`{shown}` cannot be opened: {e}; {help}"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn generated_chains_are_those_of_the_checkout() {
        let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("models");
        for name in NAMES.into_iter().filter(|name| name.starts_with("chain")) {
            let file = std::fs::read_to_string(folder.join(name).join("scene.toml")).unwrap();
            assert!(text(name) == file, "{name}");
        }
    }

    #[test]
    fn every_robot_compiles() {
        assert_eq!(robots(&[]).unwrap().len(), NAMES.len());
        assert!(robots(&["alexandra".into()]).is_err());
        let limited = limited_panda().model;
        assert_eq!((limited.constraints().limits.len(), limited.drives().len()), (14, 14));
    }
}
