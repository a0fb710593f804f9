//! Frames of SDF and their places: each is given relative to another, by name.

use std::collections::BTreeMap;

use sincro_dynamics::spatial::Pose;
use sincro_scene::diagnostic::{Diagnostic, Location};

use super::pose_of;
use crate::findings::Findings;
use crate::source::Element;

struct Frame {
    base: String,
    pose: Pose<f64>,
    at: Location,
}

/// Frames by their full names; the empty name is the world.
#[derive(Default)]
pub(super) struct Frames {
    all: BTreeMap<String, Frame>,
    aliases: BTreeMap<String, String>,
}

/// Poses of all frames in the world.
pub(super) struct Places(BTreeMap<String, Pose<f64>>);

impl Frames {
    /// Adds the frame of an element; `base` is what its pose is relative to unless it says otherwise in names below
    /// `prefix`.
    pub fn add(&mut self, name: &str, element: Element<'_>, base: &str, prefix: &str) -> Result<(), Diagnostic> {
        let mut base = base.to_owned();
        if let Some(pose) = element.child("pose")
            && let Some(relative) = pose.attribute("relative_to").filter(|r| !r.is_empty())
        {
            base = format!("{prefix}{relative}");
        }
        let pose = pose_of(element)?.unwrap_or_default().pose();
        self.all.insert(name.to_owned(), Frame { base, pose, at: element.location() });
        Ok(())
    }

    /// Lets `name` stand for another frame.
    pub fn alias(&mut self, name: &str, frame: &str) {
        self.aliases.insert(name.to_owned(), frame.to_owned());
    }

    /// Places of all frames; names that lead nowhere or in a circle are noted.
    pub fn resolve(&self, findings: &mut Findings) -> Places {
        let mut places: BTreeMap<String, Pose<f64>> = BTreeMap::from([(String::new(), Pose::identity())]);
        places.insert("world".into(), Pose::identity());
        for name in self.all.keys() {
            let mut chain: Vec<&str> = vec![name];
            let known = loop {
                let last = chain[chain.len() - 1];
                if let Some(pose) = places.get(last) {
                    break Some(*pose);
                }
                let real = self.aliases.get(last).map_or(last, String::as_str);
                let Some(frame) = self.all.get(real) else { break None };
                if chain.len() > self.all.len() + 1 {
                    break None;
                }
                chain.push(&frame.base);
            };
            let Some(mut pose) = known else {
                let at = &self.all[name].at;
                let missing = chain[chain.len() - 1];
                let message =
                    format!("the place of frame `{name}` leads to `{missing}`, which is no frame, or in a circle");
                findings.error(Diagnostic::error(at, message));
                continue;
            };
            for link in chain.iter().rev().skip(1) {
                let real = self.aliases.get(*link).map_or(*link, String::as_str);
                pose = pose.compose(&self.all[real].pose);
                places.insert((*link).to_owned(), pose);
            }
        }
        Places(places)
    }
}

impl Places {
    /// Pose of a frame in the world.
    pub fn of(&self, name: &str) -> Pose<f64> {
        self.0.get(name).copied().unwrap_or_default()
    }
}
