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
use sincro_scene::script::{Kind, OnError, Script, ScriptParser, Style};

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
    /// Object that it is being taken off; none but during that change.
    former_object: Option<Handle>,
    text: String,
    /// Script of the scene that it takes the place of.
    origin: Option<Arc<Script>>,
    /// True once it was taken away: its handle is not given again.
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

    /// Puts scripts that were added into a scene: first all of theirs are erased, where they are and where they were,
    /// then those that have a text are put on their objects.
    pub(super) fn put_scripts(&self, scene: &mut Scene) {
        let is_known = |script: &Script| {
            let object = Some(handle_of_id(script.object));
            let is_its_own = |added: &AddedScript| {
                added.kind == script.kind && (added.object == object || added.former_object == object)
            };
            self.added_scripts.iter().any(is_its_own)
        };
        scene.scripts.retain(|script| !is_known(script));
        for added in self.added_scripts.iter().filter(|added| !added.text.is_empty()) {
            let Some(handle) = added.object else { continue };
            let object = handle.0 as usize - 1;
            let of_scene = scene.objects.iter().find(|other| other.id == object).map(|other| other.path.clone());
            let at_runtime = || Some(self.entry(handle).ok().filter(|entry| entry.is_runtime)?.path.clone());
            if let Some(path) = of_scene.or_else(at_runtime) {
                scene.scripts.push(script_of(added, (object, path)));
            }
        }
    }
}

/// The script as a scene holds it. One that takes the place of a script of the scene is this script as long as the text
/// is the same; with another text it keeps the parameters, files and limits.
fn script_of(added: &AddedScript, (object, path): (usize, String)) -> Script {
    let origin = added.origin.as_deref();
    if let Some(same) = origin.filter(|origin| origin.text == added.text) {
        return Script { object, path, ..same.clone() };
    }
    let source = Arc::new(SourceText { path: PathBuf::from("added script"), text: added.text.clone() });
    let at = Location { source: source.clone(), span: 0..0 };
    let (max_memory, max_instructions) = origin.map_or(LIMITS, |s| (s.max_memory, s.max_instructions));
    let (parameters, files) = origin.map_or_else(Default::default, |s| (s.parameters.clone(), s.files.clone()));
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
        on_error: origin.map_or(OnError::Detect, |s| s.on_error),
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
        let script = self.new_script(script_type)?;
        self.keep_script(script)
    }

    /// Makes a script with a text, without object. Returns its handle.
    ///
    /// # Errors
    ///
    /// There is no such type, the text cannot be parsed or is too long, no scripts can be run, or there are too many.
    pub(crate) fn create_script(&mut self, script_type: i64, text: &str) -> Result<i64, ApiError> {
        let script = self.new_script(script_type)?;
        let script = self.with_text(&script, text)?;
        self.keep_script(script)
    }

    fn new_script(&self, script_type: i64) -> Result<AddedScript, ApiError> {
        let kind = match script_type & !THREADED {
            CHILD => Kind::Child,
            CUSTOMIZATION => Kind::Customization,
            _ => return Err(ApiError(format!("{script_type} is no type of script: child 1, customization 6"))),
        };
        self.parser()?;
        Ok(AddedScript {
            kind,
            is_threaded: script_type & THREADED != 0,
            object: None,
            former_object: None,
            text: String::new(),
            origin: None,
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

    /// The script of a handle, or the one on an object: a child script before a customization script; with its place
    /// among those that were added. One of the scene is not there yet: its place is the next one. When it was taken
    /// off, its object in the scene file still names it as long as no other script is there.
    fn script_entry(&self, number: i64) -> Result<(usize, AddedScript), ApiError> {
        let none = || ApiError(format!("there is no script {number}"));
        let all = &self.registry.added_scripts;
        if let Some(k) = number.checked_sub(FIRST).and_then(|k| usize::try_from(k).ok()) {
            let own = all.get(k).filter(|script| !script.is_removed).ok_or_else(none)?;
            return Ok((k, own.clone()));
        }
        let object = self.registry.entry(Handle(i32::try_from(number).map_err(|_| none())?))?.handle;
        let on_object = all.iter().enumerate().filter(|(_, added)| added.object == Some(object));
        let of_added = on_object.min_by_key(|(_, added)| added.kind);
        let of_object = self.registry.scene().scripts.iter().filter(|script| handle_of_id(script.object) == object);
        let of_scene = of_object.min_by_key(|script| script.kind);
        let is_first = |kind: Kind| of_scene.is_none_or(|script| kind <= script.kind);
        if let Some((k, added)) = of_added.filter(|(_, added)| is_first(added.kind)) {
            return Ok((k, added.clone()));
        }
        if let Some(script) = of_scene {
            let added = AddedScript {
                kind: script.kind,
                is_threaded: script.is_threaded,
                object: Some(object),
                former_object: None,
                text: script.text.clone(),
                origin: Some(Arc::new(script.clone())),
                is_removed: false,
            };
            return Ok((all.len(), added));
        }
        let was_there = |added: &AddedScript| {
            added.object.is_none() && added.origin.as_ref().is_some_and(|script| handle_of_id(script.object) == object)
        };
        let k = all.iter().position(was_there).ok_or_else(none)?;
        Ok((k, all[k].clone()))
    }

    /// A script with another text.
    fn with_text(&self, script: &AddedScript, text: &str) -> Result<AddedScript, ApiError> {
        if text.len() > MAX_LEN {
            return Err(ApiError(format!("a text of {} bytes, expected {MAX_LEN} at most", text.len())));
        }
        let added = AddedScript { text: text.to_owned(), ..script.clone() };
        let object = added.object.map_or(0, |handle| handle.0 as usize - 1);
        let path = added.object.and_then(|handle| Some(self.registry.entry(handle).ok()?.path.clone()));
        let script = script_of(&added, (object, path.unwrap_or_default()));
        self.parser()?.check(&script).map_err(|fault| ApiError(fault.to_string()))?;
        Ok(added)
    }

    /// Gives a script a text; if it has an object, it begins anew.
    ///
    /// # Errors
    ///
    /// There is no such script, the text cannot be parsed or is too long, or the caller may not change scripts.
    pub(crate) fn set_script_text(&mut self, number: i64, text: &str) -> Result<(), ApiError> {
        self.parser()?;
        let (k, before) = self.script_entry(number)?;
        let to = self.with_text(&before, text)?;
        self.change_script(k, before, to)
    }

    /// Puts a script on an object; for none it is taken off.
    ///
    /// # Errors
    ///
    /// There is no such script or object, the object has a script of that kind, or the caller may not change scripts.
    pub(crate) fn associate_script(&mut self, number: i64, object: Option<Handle>) -> Result<(), ApiError> {
        self.parser()?;
        let (k, before) = self.script_entry(number)?;
        if let Some(handle) = object.filter(|_| before.object != object) {
            let own = self.registry.entry(handle)?;
            let of_scene = |script: &Script| handle_of_id(script.object) == handle && script.kind == before.kind;
            let of_added = |other: &AddedScript| other.object == object && other.kind == before.kind;
            let is_taken =
                self.registry.scene().scripts.iter().any(of_scene) || self.registry.added_scripts.iter().any(of_added);
            if is_taken {
                return Err(ApiError(format!("`{}` has a script of that kind already", own.path)));
            }
        }
        let to = AddedScript { object, ..before.clone() };
        self.change_script(k, before, to)
    }

    /// Lets a script begin anew, before the next phase of the step.
    ///
    /// # Errors
    ///
    /// There is no such script, or the caller may not change scripts.
    pub(crate) fn init_script(&mut self, number: i64) -> Result<(), ApiError> {
        self.parser()?;
        let (k, before) = self.script_entry(number)?;
        let to = before.clone();
        self.change_script(k, before, to)
    }

    /// Takes a script away.
    ///
    /// # Errors
    ///
    /// There is no such script, or the caller may not change scripts.
    pub(crate) fn remove_script(&mut self, number: i64) -> Result<(), ApiError> {
        self.parser()?;
        let (k, before) = self.script_entry(number)?;
        let to = AddedScript { object: None, text: String::new(), origin: None, is_removed: true, ..before.clone() };
        self.change_script(k, before, to)
    }

    /// Makes a change of the script of a place a part of the scene; without an object there is nothing to change yet.
    fn change_script(&mut self, k: usize, before: AddedScript, to: AddedScript) -> Result<(), ApiError> {
        let objects = [before.object, to.object];
        let restarts = objects.into_iter().flatten().map(|object| (object, to.kind)).collect::<Vec<_>>();
        let is_new = k == self.registry.added_scripts.len();
        let now = AddedScript { former_object: before.object, ..to };
        if is_new {
            self.keep_script(now)?;
        } else {
            self.registry.added_scripts[k] = now;
        }
        if !restarts.is_empty()
            && let Err(refused) = self.rebuild_scripts()
        {
            if is_new {
                self.registry.added_scripts.truncate(k);
            } else {
                self.registry.added_scripts[k] = before;
            }
            return Err(refused);
        }
        self.registry.added_scripts[k].former_object = None;
        self.registry.script_restarts.extend(restarts);
        Ok(())
    }
}
