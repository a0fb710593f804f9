//! The tree of a scene: who hangs on whom, whatever the order in the file.
//!
//! A path is the parent's path, `/` and the name, so a parent's path is always shorter than its child's and no object
//! can be its own ancestor; what a user means as a circle shows as parents that do not exist, and is told as a circle.

use std::collections::{BTreeMap, BTreeSet};

use super::air::DragFile;
use super::camera::CameraFile;
use super::file::{BodyFile, ForceFile, FrameFile, JointFile, SceneFile};
use super::placement::Placement;
use super::rotor::RotorFile;
use super::sensor::SensorFile;
use crate::diagnostic::{Diagnostic, Diagnostics};
use crate::document::Document;
use crate::suggest;
use crate::tree::join;

/// An object of the file, whatever its kind.
pub(super) struct Entry<'a> {
    pub name: &'a str,
    pub parent: &'a str,
    pub path: String,
    /// Its table in the document.
    pub pointer: String,
    pub file: AnyFile<'a>,
}

/// The kinds of objects.
#[derive(Clone, Copy)]
pub(super) enum AnyFile<'a> {
    Joint(&'a JointFile),
    Body(&'a BodyFile),
    Frame(&'a FrameFile),
    Force(&'a ForceFile),
    Rotor(&'a RotorFile),
    Drag(&'a DragFile),
    Sensor(&'a SensorFile),
    Camera(&'a CameraFile),
}

impl AnyFile<'_> {
    /// The word for it.
    fn word(self) -> &'static str {
        match self {
            Self::Joint(_) => "joint",
            Self::Body(_) => "body",
            Self::Frame(_) => "frame",
            Self::Force(_) => "force",
            Self::Rotor(_) => "rotor",
            Self::Drag(_) => "drag",
            Self::Sensor(_) => "sensor",
            Self::Camera(_) => "camera",
        }
    }
}

/// An object that hangs, by a chain of others, on the world.
pub(super) struct PlaceInTree {
    /// Index among the entries.
    pub entry: usize,
    /// Index of the parent among the places; none for the world.
    pub parent: Option<usize>,
    pub path: String,
}

impl Entry<'_> {
    /// Placement of its frame in its parent's.
    pub(super) fn placement(&self) -> Placement {
        match self.file {
            AnyFile::Joint(f) => Placement::new(f.position, f.rotation_deg, f.quaternion_wxyz),
            AnyFile::Body(f) => Placement::new(f.position, f.rotation_deg, f.quaternion_wxyz),
            AnyFile::Frame(f) => Placement::new(f.position, f.rotation_deg, f.quaternion_wxyz),
            AnyFile::Rotor(f) => Placement::new(f.position, f.rotation_deg, f.quaternion_wxyz),
            AnyFile::Drag(f) => Placement::new(f.position, f.rotation_deg, f.quaternion_wxyz),
            AnyFile::Sensor(f) => Placement::new(f.position, f.rotation_deg, f.quaternion_wxyz),
            AnyFile::Camera(f) => Placement::new(f.position, f.rotation_deg, f.quaternion_wxyz),
            AnyFile::Force(_) => Placement::new([0.0; 3], None, None),
        }
    }
}

/// Every object of the file.
pub(super) fn entries(file: &SceneFile) -> Vec<Entry<'_>> {
    let joints = file.joint.iter().map(|f| (&*f.name, &*f.parent, AnyFile::Joint(f))).enumerate();
    let bodies = file.body.iter().map(|f| (&*f.name, &*f.parent, AnyFile::Body(f))).enumerate();
    let frames = file.frame.iter().map(|f| (&*f.name, &*f.parent, AnyFile::Frame(f))).enumerate();
    let forces = file.force.iter().map(|f| (&*f.name, &*f.parent, AnyFile::Force(f))).enumerate();
    let rotors = file.rotor.iter().map(|f| (&*f.name, &*f.parent, AnyFile::Rotor(f))).enumerate();
    let drags = file.drag.iter().map(|f| (&*f.name, &*f.parent, AnyFile::Drag(f))).enumerate();
    let sensors = file.sensor.iter().map(|f| (&*f.name, &*f.parent, AnyFile::Sensor(f))).enumerate();
    let cameras = file.camera.iter().map(|f| (&*f.name, &*f.parent, AnyFile::Camera(f))).enumerate();
    let named = |list: &'static str| {
        move |(k, (name, parent, file))| Entry {
            name,
            parent,
            path: join(parent, name),
            pointer: format!("/{list}/{k}"),
            file,
        }
    };
    let joints = joints.map(named("joint")).chain(bodies.map(named("body")));
    joints
        .chain(frames.map(named("frame")))
        .chain(forces.map(named("force")))
        .chain(rotors.map(named("rotor")))
        .chain(drags.map(named("drag")))
        .chain(sensors.map(named("sensor")))
        .chain(cameras.map(named("camera")))
        .collect()
}

/// The objects, parents before children and children in the order of the file; notes what does not fit.
pub(super) fn order(entries: &[Entry<'_>], document: &Document, diagnostics: &mut Diagnostics) -> Vec<PlaceInTree> {
    check_names(entries, document, diagnostics);
    let mut by_path: BTreeMap<&str, usize> = BTreeMap::new();
    for (k, entry) in entries.iter().enumerate() {
        match by_path.get(entry.path.as_str()) {
            Some(&first) => diagnostics.push(duplicate(entry, &entries[first], document)),
            None => {
                by_path.insert(&entry.path, k);
            }
        }
    }
    let parents: Vec<Result<Option<usize>, ()>> = entries.iter().map(|e| parent_of(e, entries, &by_path)).collect();
    report_orphans(entries, &parents, document, diagnostics);
    let mut children: BTreeMap<Option<usize>, Vec<usize>> = BTreeMap::new();
    for (k, parent) in parents.iter().enumerate() {
        if let Ok(parent) = *parent {
            check_parent(&entries[k], parent.map(|p| &entries[p]), document, diagnostics);
            children.entry(parent).or_default().push(k);
        }
    }
    for list in children.values_mut() {
        list.sort_by_key(|k| document.at(&entries[*k].pointer).span.start);
    }
    let mut places = Vec::new();
    descend(None, None, &children, entries, &mut places);
    places
}

/// Depth first with a stack of our own: a chain of ten thousand links is no reason to fall over.
fn descend(
    root: Option<usize>,
    parent_place: Option<usize>,
    children: &BTreeMap<Option<usize>, Vec<usize>>,
    entries: &[Entry<'_>],
    places: &mut Vec<PlaceInTree>,
) {
    let of = |entry: Option<usize>| children.get(&entry).map(Vec::as_slice).unwrap_or_default();
    let mut stack: Vec<(usize, Option<usize>)> = of(root).iter().rev().map(|k| (*k, parent_place)).collect();
    while let Some((entry, parent)) = stack.pop() {
        let place = places.len();
        places.push(PlaceInTree { entry, parent, path: entries[entry].path.clone() });
        stack.extend(of(Some(entry)).iter().rev().map(|k| (*k, Some(place))));
    }
}

fn parent_of(entry: &Entry<'_>, entries: &[Entry<'_>], by_path: &BTreeMap<&str, usize>) -> Result<Option<usize>, ()> {
    if entry.parent == "/" {
        return Ok(None);
    }
    let parent = by_path.get(entry.parent).copied().ok_or(())?;
    debug_assert!(entries[parent].path.len() < entry.path.len(), "a parent's path is shorter than its child's");
    Ok(Some(parent))
}

fn check_names(entries: &[Entry<'_>], document: &Document, diagnostics: &mut Diagnostics) {
    for entry in entries {
        let good = |c: char| c.is_ascii_alphanumeric() || c == '_' || c == '-';
        // copies of V-REP 3
        let number = |digits: &str| !digits.is_empty() && digits.chars().all(|c| c.is_ascii_digit());
        let name =
            entry.name.rsplit_once('#').filter(|(_, digits)| number(digits)).map_or(entry.name, |(name, _)| name);
        if name.is_empty() || !name.chars().all(good) {
            let at = document.at(&format!("{}/name", entry.pointer));
            let diagnostic = Diagnostic::error(&at, format!("`{}` is not a name", entry.name));
            diagnostics.push(diagnostic.with_help("names have letters a–z and A–Z, digits, `_` and `-`; `#` and a number may end them, as of copies of V-REP 3"));
        }
    }
}

fn duplicate(entry: &Entry<'_>, first: &Entry<'_>, document: &Document) -> Diagnostic {
    let at = document.title_at(&entry.pointer);
    let (line, _) = document.title_at(&first.pointer).line_column();
    Diagnostic::error(&at, format!("there are two objects `{}`", entry.path))
        .with_help(format!("the other one is in line {line}; give one of them another name or parent"))
}

fn check_parent(entry: &Entry<'_>, parent: Option<&Entry<'_>>, document: &Document, diagnostics: &mut Diagnostics) {
    let at = document.at(&format!("{}/parent", entry.pointer));
    let carrier = parent.map(|p| p.file);
    match (entry.file, carrier) {
        (
            _,
            Some(AnyFile::Force(_) | AnyFile::Rotor(_) | AnyFile::Drag(_) | AnyFile::Sensor(_) | AnyFile::Camera(_)),
        ) => {
            let word = carrier.map_or("", AnyFile::word);
            let diagnostic = Diagnostic::error(&at, format!("`{}` is a {word}, it carries nothing", entry.parent));
            diagnostics.push(diagnostic.with_help("the parent is a body, joint or frame, or `/`"));
        }
        // a rotor may hang on the joint that turns it
        (AnyFile::Rotor(_), Some(AnyFile::Joint(_))) => {}
        (AnyFile::Force(_) | AnyFile::Rotor(_) | AnyFile::Drag(_), None | Some(AnyFile::Joint(_))) => {
            let word = entry.file.word();
            let message = format!("{word} `{}` acts on `{}`, which is no body and no frame", entry.path, entry.parent);
            diagnostics.push(
                Diagnostic::error(&at, message).with_help(format!("the parent of a {word} is a body or a frame")),
            );
        }
        _ => {}
    }
}

/// Tells whose parents are not there; once for each circle, and not again for what hangs on those already told.
fn report_orphans(
    entries: &[Entry<'_>],
    parents: &[Result<Option<usize>, ()>],
    document: &Document,
    diagnostics: &mut Diagnostics,
) {
    let told_before = diagnostics.0.len();
    let mut in_circles: BTreeSet<&str> = BTreeSet::new();
    let orphans = || (0..entries.len()).filter(|k| parents[*k].is_err()).map(|k| &entries[k]);
    for entry in orphans() {
        let Some(circle) = circle(entry, entries) else { continue };
        if !in_circles.contains(entry.name) {
            let at = document.at(&format!("{}/parent", entry.pointer));
            let diagnostic =
                Diagnostic::error(&at, format!("`{}` hangs on itself: {}", entry.name, circle.join(" on ")));
            diagnostics.push(diagnostic.with_help("one of them must hang on something that hangs on the world, `/`"));
        }
        in_circles.extend(circle);
    }
    let adrift = |k: usize| {
        let mut at = Ok(Some(k));
        while let Ok(Some(k)) = at {
            at = parents[k];
        }
        at.is_err()
    };
    for entry in orphans().filter(|entry| !in_circles.contains(entry.name)) {
        let wanted = last_name(entry.parent);
        let namesake = (0..entries.len()).find(|k| entries[*k].name == wanted);
        if !namesake.is_some_and(adrift) {
            diagnostics.push(unknown_parent(entry, entries, namesake.map(|k| &entries[k]), document));
        }
    }
    // same names in several places can hide all of them behind each other: nothing is dropped in silence
    if diagnostics.0.len() == told_before {
        orphans().for_each(|entry| diagnostics.push(unknown_parent(entry, entries, None, document)));
    }
}

fn unknown_parent(
    entry: &Entry<'_>,
    entries: &[Entry<'_>],
    namesake: Option<&Entry<'_>>,
    document: &Document,
) -> Diagnostic {
    let at = document.at(&format!("{}/parent", entry.pointer));
    let diagnostic =
        Diagnostic::error(&at, format!("there is no object `{}` to hang `{}` on", entry.parent, entry.name));
    if let Some(meant) = namesake {
        return diagnostic.with_help(format!("did you mean `{}`?", meant.path));
    }
    let known: Vec<&str> = entries.iter().filter(|e| !std::ptr::eq(*e, entry)).map(|e| e.path.as_str()).collect();
    diagnostic.with_help(suggest::help(entry.parent, &known, "objects"))
}

/// The names of a circle that leads from an object, by the last names of parents, back to it.
fn circle<'a>(entry: &'a Entry<'_>, entries: &'a [Entry<'_>]) -> Option<Vec<&'a str>> {
    let mut names = vec![entry.name];
    let mut seen = BTreeSet::new();
    let mut at = entry;
    while seen.insert(at.pointer.as_str()) {
        let parent = last_name(at.parent);
        names.push(parent);
        if parent == entry.name {
            return Some(names);
        }
        at = entries.iter().find(|e| e.name == parent)?;
    }
    None
}

fn last_name(path: &str) -> &str {
    path.rsplit('/').next().unwrap_or(path)
}
