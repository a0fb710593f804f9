//! A small scene folder that tests change and load.
#![allow(dead_code, reason = "each test uses its part")]

use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicUsize, Ordering};

use sincro_scene::overrides::Override;
use sincro_sim::{Extensions, Loaded, load};

pub const SCENE: &str = r##"gravity = [0.0, 0.0, -9.81]

[[joint]]
name = "shoulder"
kind = "revolute"
axis = [0.0, 1.0, 0.0]
spring = { stiffness = 30.0, rest = 0.0 }
damping = 0.5
initial = { position = 0.1 }

[[body]]
name = "rod"
parent = "/shoulder"
density = 1000.0
shape = [ { cylinder = { radius = 0.05, length = 0.5 }, position = [0.0, 0.0, 0.25], color = "#8a5a2b" } ]

[[frame]]
name = "tip"
parent = "/shoulder/rod"
position = [0.0, 0.0, 0.5]

[[joint]]
name = "wrist"
parent = "/shoulder/rod/tip"
kind = "revolute"
motor = { mode = "velocity", command = { ramp = { slope = 1.0 } } }

[[body]]
name = "hand"
parent = "/shoulder/rod/tip/wrist"
mass = 0.5
inertia = { xx = 0.001, yy = 0.001, zz = 0.001 }
"##;

pub const EXPERIMENT: &str = r#"title = "Test"
scene = "scene.toml"
duration = 1.0
step = 0.01
record = ["/shoulder.position", "energy.total"]

[parameters]
k = 30.0

[[check]]
name = "angle"
signals = { x = "/shoulder.position" }
formula = "k*x + 0"
value = "2*k"
tolerance = 1e-6

[[check]]
name = "reference"
signal = "/shoulder.position"
reference = { file = "reference.csv", column = "x" }
tolerance = 1e-6

[[check]]
name = "at half time"
signal = "/shoulder.position"
at = 0.5
value = 1.0
tolerance = 1e-6

[[check]]
name = "late"
signal = "/shoulder.position"
window = [0.5, 1.0]
value = 1.0
tolerance = 1e-6

[sweep]
parameter = "/shoulder.spring.stiffness"
range = { from = 10.0, to = 30.0, step = 10.0 }

[[variant]]
name = "soft"
set = { "/shoulder.spring.stiffness" = 10.0, "integrator" = "rk4" }

[[plot]]
title = "Angle"
signals = ["/shoulder.position"]
"#;

/// A folder of its own for each call, so that tests can run side by side.
pub struct TestFolder {
    pub path: PathBuf,
}

impl TestFolder {
    pub fn new() -> Self {
        static COUNT: AtomicUsize = AtomicUsize::new(0);
        let name = format!("scene-{}-{}", std::process::id(), COUNT.fetch_add(1, Ordering::Relaxed));
        let path = Path::new(env!("CARGO_TARGET_TMPDIR")).join(name);
        std::fs::create_dir_all(&path).unwrap();
        let folder = Self { path };
        folder.write("scene.toml", SCENE);
        folder.write("experiment.toml", EXPERIMENT);
        folder.write("reference.csv", "t,x\n0,0\n0.5,1\n1,2\n");
        folder
    }

    pub fn write(&self, name: &str, text: &str) {
        std::fs::write(self.path.join(name), text).unwrap();
    }

    /// Puts `to` in place of the first `from` in a file, which must be there.
    pub fn change(&self, name: &str, from: &str, to: &str) {
        let text = std::fs::read_to_string(self.path.join(name)).unwrap();
        assert!(text.contains(from), "{name} has no {from:?}");
        self.write(name, &text.replacen(from, to, 1));
    }

    pub fn load(&self, settings: &[&str]) -> Result<Loaded, String> {
        let settings: Result<Vec<Override>, _> = settings.iter().map(|text| Override::parse(text)).collect();
        let settings = settings.map_err(|diagnostic| diagnostic.to_string())?;
        load(&self.path, &settings, Extensions::default()).map_err(|diagnostics| self.short(&diagnostics.to_string()))
    }

    /// A message without the folder's path.
    pub fn short(&self, message: &str) -> String {
        message.replace(&format!("{}/", self.path.display()), "").replace(&self.path.display().to_string(), "FOLDER")
    }
}

impl Drop for TestFolder {
    fn drop(&mut self) {
        let _ = std::fs::remove_dir_all(&self.path);
    }
}

/// Diagnostics of a folder in which one file was changed.
pub fn refused(file: &str, from: &str, to: &str) -> String {
    let folder = TestFolder::new();
    folder.change(file, from, to);
    match folder.load(&[]) {
        Ok(loaded) => {
            let warnings: Vec<String> = loaded.warnings.iter().map(|w| folder.short(&w.to_string())).collect();
            format!("loads\n{}", warnings.join("\n"))
        }
        Err(message) => message,
    }
}
