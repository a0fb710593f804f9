//! Scripts that clients and scripts add to objects, change and take away.
//!
//! A script that has an object and a text becomes a part of the scene at once; the host of the scripts starts it before
//! the next phase of the step. A script of the scene whose text is changed ends, and begins anew with the new text.

use std::collections::BTreeSet;
use std::path::PathBuf;
use std::sync::Arc;

use super::registry::{Handle, ObjectRegistry};
use super::scene_objects::handle_of_id;
use super::{ApiError, SimApi};
use sincro_scene::diagnostic::{Location, SourceText};
use sincro_scene::scene::Scene;
use sincro_scene::script::{Kind, Script, ScriptParser, Style};

/// Handle of the first script that was added: beyond those of the scripts of a scene.
const FIRST: i64 = 1_030_000;
/// Scripts that may be added in a run.
const MAX_COUNT: usize = 1_000;
/// Length of a text [bytes].
const MAX_LEN: usize = 1 << 20;

/// Limits of an added script, those that a script of a scene file has by default: memory [bytes], instructions of one
/// call.
const LIMITS: (usize, u64) = (64 << 20, 20_000_000);

/// Bit pattern of a script type that launches a thread.
const THREADED: i64 = 0xf0;
const CHILD: i64 = 1;
const CUSTOMIZATION: i64 = 6;

/// Script that was added, or that takes the place of one of the scene.
#[derive(Clone, Debug)]
pub(super) struct AddedScript {
    kind: Kind,
    is_threaded: bool,
    object: Option<Handle>,
    text: String,
    /// True once it was taken away, or if it takes a script of the scene away.
    is_removed: bool,
}

impl ObjectRegistry {
    /// Object and kind of the script of a handle that `sim.addScript` has given; none if it was not, or if the script
    /// has no object yet.
    #[must_use]
    pub fn added_script(&self, number: i64) -> Option<(Handle, Kind)> {
        let k = usize::try_from(number.checked_sub(FIRST)?).ok()?;
        let script = self.added_scripts.get(k).filter(|script| !script.is_removed)?;
        Some((script.object?, script.kind))
    }

    /// Takes the scripts that are to begin anew, by their objects and kinds.
    #[must_use]
    pub fn take_script_restarts(&mut self) -> BTreeSet<(Handle, Kind)> {
        std::mem::take(&mut self.script_restarts)
    }

    /// Puts scripts that were added into a scene, in place of its own on the same objects.
    pub(super) fn put_scripts(&self, scene: &mut Scene) {
        for added in &self.added_scripts {
            let Some(handle) = added.object.filter(|handle| self.entry(*handle).is_ok()) else { continue };
            let is_same = |script: &Script| handle_of_id(script.object) == handle && script.kind == added.kind;
            let former = scene.scripts.iter().position(is_same).map(|k| scene.scripts.remove(k));
            if added.is_removed || added.text.is_empty() {
                continue;
            }
            let object = handle.0 as usize - 1;
            let of_scene = scene.objects.iter().find(|other| other.id == object).map(|other| other.path.clone());
            let path = of_scene.or_else(|| self.entry(handle).ok().map(|entry| entry.path.clone()));
            scene.scripts.push(script_of(added, (object, path.unwrap_or_default()), former));
        }
    }
}

/// The script as a scene holds it; parameters, files and limits are those of one that it takes the place of.
fn script_of(added: &AddedScript, (object, path): (usize, String), former: Option<Script>) -> Script {
    let source = Arc::new(SourceText { path: PathBuf::from("added script"), text: added.text.clone() });
    let at = Location { source: source.clone(), span: 0..0 };
    let (max_memory, max_instructions) = former.as_ref().map_or(LIMITS, |s| (s.max_memory, s.max_instructions));
    let (parameters, files) = former.map_or_else(Default::default, |s| (s.parameters, s.files));
    Script {
        object,
        path,
        source,
        text: added.text.clone(),
        lines_before: 0,
        parameters,
        files,
        style: Style::Detect,
        kind: added.kind,
        is_threaded: added.is_threaded,
        max_memory,
        max_instructions,
        at,
    }
}

impl SimApi<'_> {
    /// Makes a script without object and text: 1 child, 6 customization, with 0xf0 a thread. Returns its handle.
    ///
    /// # Errors
    ///
    /// There is no such type, no scripts can be run, or there are too many.
    pub(crate) fn add_script(&mut self, script_type: i64) -> Result<i64, ApiError> {
        let kind = match script_type & !THREADED {
            CHILD => Kind::Child,
            CUSTOMIZATION => Kind::Customization,
            _ => return Err(ApiError(format!("{script_type} is no type of script: child 1, customization 6"))),
        };
        self.parser()?;
        self.keep_script(AddedScript {
            kind,
            is_threaded: script_type & THREADED != 0,
            object: None,
            text: String::new(),
            is_removed: false,
        })
    }

    /// Returns true if a number is the handle of a script that was added.
    pub(crate) fn is_added_script(&self, number: i64) -> bool {
        (FIRST..FIRST + self.registry.added_scripts.len() as i64).contains(&number)
    }

    fn keep_script(&mut self, script: AddedScript) -> Result<i64, ApiError> {
        if self.registry.added_scripts.len() >= MAX_COUNT {
            return Err(ApiError(format!("{MAX_COUNT} scripts were added already")));
        }
        self.registry.added_scripts.push(script);
        Ok(FIRST + self.registry.added_scripts.len() as i64 - 1)
    }

    /// The parser of texts, if the caller may add, change and remove scripts.
    fn parser(&self) -> Result<&'static dyn ScriptParser, ApiError> {
        if self.own.is_none() && !self.registry.takes_script_texts {
            let refused = "clients change no scripts here: `sincro serve --grant scripts` lets them";
            return Err(ApiError::new(refused));
        }
        self.registry.script_parser.ok_or_else(|| ApiError::new("no scripts can be run here"))
    }

    /// The script of a handle, or the one on an object: a child script before a customization script. One of the scene
    /// is added in its own place.
    fn script_entry(&mut self, number: i64) -> Result<usize, ApiError> {
        let none = || ApiError(format!("there is no script {number}"));
        if let Some(k) = number.checked_sub(FIRST).and_then(|k| usize::try_from(k).ok()) {
            let is_there = self.registry.added_scripts.get(k).is_some_and(|script| !script.is_removed);
            return if is_there { Ok(k) } else { Err(none()) };
        }
        let object = self.registry.entry(Handle(i32::try_from(number).map_err(|_| none())?))?.handle;
        let scripts = &self.registry.scene().scripts;
        let of_object = scripts.iter().filter(|script| handle_of_id(script.object) == object);
        let script = of_object.min_by_key(|script| script.kind).ok_or_else(none)?;
        let is_known = |added: &AddedScript| (added.object, added.kind) == (Some(object), script.kind);
        let known = self.registry.added_scripts.iter().rposition(is_known);
        if let Some(k) = known {
            return Ok(k);
        }
        let (text, is_threaded, kind) = (script.text.clone(), script.is_threaded, script.kind);
        let added = AddedScript { kind, is_threaded, object: Some(object), text, is_removed: false };
        Ok((self.keep_script(added)? - FIRST) as usize)
    }

    /// Gives a script a text; if it has an object, it begins anew.
    ///
    /// # Errors
    ///
    /// There is no such script, or the text cannot be parsed or is too long.
    pub(crate) fn set_script_text(&mut self, number: i64, text: &str) -> Result<(), ApiError> {
        if text.len() > MAX_LEN {
            return Err(ApiError(format!("a text of {} bytes, expected {MAX_LEN} at most", text.len())));
        }
        let parser = self.parser()?;
        let k = self.script_entry(number)?;
        let added = AddedScript { text: text.to_owned(), ..self.registry.added_scripts[k].clone() };
        let object = added.object.map_or(0, |handle| handle.0 as usize - 1);
        let path = added.object.and_then(|handle| Some(self.registry.entry(handle).ok()?.path.clone()));
        let script = script_of(&added, (object, path.unwrap_or_default()), None);
        parser.check(&script).map_err(|fault| ApiError(fault.to_string()))?;
        self.change_script(k, added)
    }

    /// Puts a script on an object; for none it is taken off.
    ///
    /// # Errors
    ///
    /// There is no such script or object, or the object has a script of that kind.
    pub(crate) fn associate_script(&mut self, number: i64, object: Option<Handle>) -> Result<(), ApiError> {
        self.parser()?;
        let k = self.script_entry(number)?;
        let added = self.registry.added_scripts[k].clone();
        if let Some(handle) = object.filter(|_| added.object != object) {
            let own = self.registry.entry(handle)?;
            let is_taken = |script: &Script| handle_of_id(script.object) == handle && script.kind == added.kind;
            if self.registry.scene().scripts.iter().any(is_taken) {
                return Err(ApiError(format!("`{}` has a script of that kind already", own.path)));
            }
        }
        self.change_script(k, AddedScript { object, ..added })
    }

    /// Lets a script begin anew, before the next phase of the step.
    ///
    /// # Errors
    ///
    /// There is no such script.
    pub(crate) fn init_script(&mut self, number: i64) -> Result<(), ApiError> {
        self.parser()?;
        let k = self.script_entry(number)?;
        let added = self.registry.added_scripts[k].clone();
        self.change_script(k, added)
    }

    /// Takes a script away.
    ///
    /// # Errors
    ///
    /// There is no such script.
    pub(crate) fn remove_script(&mut self, number: i64) -> Result<(), ApiError> {
        self.parser()?;
        let k = self.script_entry(number)?;
        let added = self.registry.added_scripts[k].clone();
        self.change_script(k, AddedScript { is_removed: true, ..added })
    }

    /// Makes a change of a script a part of the scene; without an object there is nothing to change yet.
    fn change_script(&mut self, k: usize, to: AddedScript) -> Result<(), ApiError> {
        let before = std::mem::replace(&mut self.registry.added_scripts[k], to.clone());
        if before.object.is_none() && to.object.is_none() {
            return Ok(());
        }
        if let Err(refused) = self.rebuild_scripts() {
            self.registry.added_scripts[k] = before;
            return Err(refused);
        }
        let objects = [before.object, to.object];
        self.registry.script_restarts.extend(objects.into_iter().flatten().map(|object| (object, to.kind)));
        Ok(())
    }
}
