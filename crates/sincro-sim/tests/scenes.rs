//! Every scene and model of the repository loads, with its variants.

use std::path::PathBuf;

use sincro_scene::overrides::Override;
use sincro_sim::load;

fn scenes() -> Vec<PathBuf> {
    let mut found: Vec<PathBuf> = ["", "third-party", "../models"]
        .iter()
        .flat_map(|folder| std::fs::read_dir(sincro_testing::repository_scene(folder)).unwrap())
        .map(|entry| entry.unwrap().path())
        .filter(|path| path.join("experiment.toml").is_file())
        .collect();
    found.sort();
    found
}

#[test]
fn every_scene_loads_without_warnings() {
    let scenes = scenes();
    assert!(scenes.len() >= 10);
    for scene in scenes {
        let loaded =
            load(&scene, &[], sincro_testing::with_scripts()).unwrap_or_else(|diagnostics| panic!("{diagnostics}"));
        // the thesis's quadrotor has an inertia that no body has, and is warned of, once in each scene file: one has
        // three
        let name = scene.file_name().unwrap().to_string_lossy().into_owned();
        let expected = match name.as_str() {
            "quadrotor-open-loop" => 3,
            // two scene files, and a variant with another inertia
            "quadrotor-robustness" => 3,
            // their inertia is one that a body can have
            "quadrotor-lua" | "quadrotor-hover" => 0,
            "thesis-quadrotor" => 1,
            _ if name.starts_with("quadrotor-") => 1,
            _ => 0,
        };
        let inertia = loaded.warnings.iter().filter(|w| w.message.contains("no rigid body has the inertia")).count();
        assert_eq!(
            (loaded.warnings.len(), inertia),
            (expected, expected),
            "{}: {:?}",
            scene.display(),
            loaded.warnings
        );
        assert_eq!(loaded.scene.commands.len(), loaded.scene.model.n_commands());
        for variant in &loaded.experiment.variants {
            let of_variant = load(&scene, &variant.set, sincro_testing::with_scripts())
                .unwrap_or_else(|diagnostics| panic!("{diagnostics}"));
            assert_eq!(of_variant.experiment.variants.len(), loaded.experiment.variants.len());
        }
    }
}

/// A row shows the torque of its own instant, not that of the tick before, when the diagram commands it continuously.
#[test]
fn continuous_commands_are_seen_as_of_now() {
    let folder = sincro_testing::repository_scene("motor-step");
    let settings = [
        ("diagram", "velocity-loop.toml"),
        ("/motor.motor", "{ mode = \"torque\" }"),
        ("record", "[\"/motor.motor_torque_now\", \"pi\"]"),
    ];
    let settings = settings.map(|(path, value)| Override::new(path, value));
    let loaded =
        load(&folder, &settings, sincro_testing::with_scripts()).unwrap_or_else(|diagnostics| panic!("{diagnostics}"));
    let table = sincro_testing::run(&loaded).table;
    let column = |name: &str| &table.column(name).unwrap().values;
    let (now, pi) = (column("/motor.motor_torque_now"), column("pi"));
    // the row of the step itself shows the torque before it, and what the controller asks for from then on
    let step = table.times().iter().position(|t| *t >= 0.05).unwrap();
    assert_eq!((now[step], pi[step] > 0.0), (0.0, true));
    assert_eq!(now[step + 1..], pi[step + 1..]);
    assert!(now[step + 1] != 0.0);
}
