//! Chapters of the gallery of `sincro reproduce`: which scenes stand under which heading, with the sections of the
//! thesis that they are about.

use std::path::Path;

/// Heading for scenes that no chapter has.
const OTHERS: &str = "Textbook scenes and examples";
/// Heading for scenes of published problems, below a folder of this name.
const PUBLISHED: (&str, &str) = ("third-party", "Published problems of others");

/// Heading of a chapter, and its scenes in order, each with its sections.
type Chapter = (&'static str, &'static [(&'static str, &'static str)]);

const CHAPTERS: [Chapter; 5] = [
    (
        "Chapter 3: motor and spring",
        &[
            ("motor-step", "3.2.1"),
            ("motor-ramp", "3.2.1"),
            ("thesis-motor", "3.2.1"),
            ("spring-static", "3.2.2.1"),
            ("spring-static-equations", "3.2.2.1"),
            ("spring-dynamic", "3.2.2.2"),
            ("thesis-spring", "3.2.2.2"),
        ],
    ),
    (
        "Chapter 4: two joints, stiff and flexible",
        &[
            ("two-dof-open-loop", "4.1"),
            ("two-dof-equations", "4.1"),
            ("two-dof-position", "4.1"),
            ("two-dof-remote", "4.1"),
            ("thesis-two-dof", "4.1"),
            ("flexible-open-loop", "4.2"),
            ("flexible-equations", "4.2"),
            ("flexible-velocity-step", "4.2"),
            ("flexible-position", "4.2"),
            ("thesis-flexible", "4.2"),
        ],
    ),
    (
        "Chapter 5: compliant arm",
        &[
            ("alexandros-release", "5.2"),
            ("alexandros-position", "5.2, 5.3"),
            ("alexandros-remote", "5.2"),
            ("thesis-arm", "5.2"),
            ("alexandros-force", "5.3.1 to 5.3.3"),
            ("thesis-arm-force", "5.3"),
            ("alexandros-force-feedback", "beyond 5.3"),
            ("alexandros-wrong-model", "beyond 5.2"),
        ],
    ),
    (
        "Chapter 6: propeller and quadrotor",
        &[
            ("stock-propeller", "6.1.1"),
            ("rotor-bemt", "6.1.2, table 1"),
            ("propeller-lua", "6.1.2"),
            ("quadrotor-open-loop", "6.2"),
            ("quadrotor-lua", "6.2"),
            ("quadrotor-flight-1", "6.3"),
            ("quadrotor-flight-2", "6.4"),
            ("quadrotor-latency", "6.3"),
            ("quadrotor-remote", "6.3"),
            ("thesis-quadrotor", "6.2 to 6.4"),
            ("thesis-quadrotor-lua", "6.3"),
            ("quadrotor-robustness", "beyond 6.3"),
            ("quadrotor-wrong-model", "beyond 6.3"),
            ("quadrotor-hover", "beyond 6.3"),
            ("quadrotor-wind", "beyond 6.3"),
        ],
    ),
    (
        "Beyond: arm of chapter 5 on the quadrotor of chapter 6",
        &[
            ("aerial-manipulator-hover", ""),
            ("aerial-manipulator-contact", ""),
            ("aerial-manipulator-grasp", ""),
            ("aerial-manipulator-remote", ""),
            ("aerial-manipulator-contact-remote", ""),
            ("aerial-manipulator-grasp-remote", ""),
        ],
    ),
];

/// Place of a scene in the gallery.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct Place {
    /// Chapter, then scene of the chapter.
    rank: (usize, usize),
    /// Heading.
    pub(super) group: &'static str,
    /// Section of the thesis; may be empty.
    section: &'static str,
}

impl Place {
    /// Place of the scene in a folder.
    pub(super) fn of(scene: &Path) -> Self {
        let name = scene.file_name().map_or_else(String::new, |n| n.to_string_lossy().into_owned());
        for (i, (group, scenes)) in CHAPTERS.iter().enumerate() {
            if let Some(k) = scenes.iter().position(|(scene, _)| *scene == name) {
                return Self { rank: (i, k), group, section: scenes[k].1 };
            }
        }
        let is_published = scene.parent().and_then(Path::file_name).is_some_and(|folder| folder == PUBLISHED.0);
        Self { rank: (CHAPTERS.len(), 0), group: if is_published { PUBLISHED.1 } else { OTHERS }, section: "" }
    }

    /// The words on the card of a scene that say where it belongs: `§ 4.1 · two-dof-position`.
    pub(super) fn source(&self, scene: &str) -> String {
        match self.section {
            "" => scene.to_owned(),
            section if section.starts_with(|c: char| c.is_ascii_digit()) => format!("§ {section} · {scene}"),
            section => format!("{section} · {scene}"),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn scenes_of_the_chapters_exist_and_come_in_order() {
        let scenes = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes");
        let mut places = Vec::new();
        for (name, _) in CHAPTERS.iter().flat_map(|(_, scenes)| *scenes) {
            let folder = scenes.join(name);
            assert!(folder.join("experiment.toml").is_file(), "{name}");
            places.push(Place::of(&folder));
        }
        assert!(places.is_sorted());
        assert_eq!(places[0].source("motor-step"), "§ 3.2.1 · motor-step");
    }

    #[test]
    fn every_scene_of_the_thesis_tables_has_a_chapter() {
        let table = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/thesis.md");
        let table = std::fs::read_to_string(table).unwrap();
        for link in table.split("](../scenes/").skip(1) {
            let name = link.split(')').next().unwrap();
            assert!(CHAPTERS.iter().any(|(_, scenes)| scenes.iter().any(|(scene, _)| *scene == name)), "{name}");
        }
    }

    #[test]
    fn other_scenes_come_last() {
        let [acrobot, published] = ["scenes/acrobot", "scenes/third-party/bicycle"].map(|s| Place::of(Path::new(s)));
        assert!(acrobot > Place::of(Path::new("scenes/aerial-manipulator-grasp")));
        assert_eq!((acrobot.group, published.group), (OTHERS, PUBLISHED.1));
        assert_eq!(acrobot.source("acrobot"), "acrobot");
    }
}
