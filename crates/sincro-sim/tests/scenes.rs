//! Every scene of the repository loads, with its variants.

use std::path::{Path, PathBuf};

use sincro_sim::load;

fn scenes() -> Vec<PathBuf> {
    let all = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes");
    let mut found: Vec<PathBuf> = std::fs::read_dir(all)
        .unwrap()
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
        let loaded = load(&scene, &[]).unwrap_or_else(|problems| panic!("{problems}"));
        assert!(loaded.warnings.is_empty(), "{}: {:?}", scene.display(), loaded.warnings);
        assert_eq!(loaded.scene.commands.len(), loaded.scene.model.motors().len());
        for variant in &loaded.experiment.variants {
            let of_variant = load(&scene, &variant.set).unwrap_or_else(|problems| panic!("{problems}"));
            assert_eq!(of_variant.experiment.variants.len(), loaded.experiment.variants.len());
        }
    }
}
