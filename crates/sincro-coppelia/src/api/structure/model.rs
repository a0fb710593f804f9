//! Models: scene files that are loaded below an object of their own, and written.

use std::fmt::Write;
use std::path::{Component, Path, PathBuf};

use crate::api::registry::Handle;
use crate::api::{ApiError, SimApi};
use sincro_scene::script::Kind as ScriptKind;

/// Largest model that is written [bytes].
const MAX_TEXT: usize = 16 << 20;

/// Text as a string of TOML on one line.
fn quoted(text: &str) -> String {
    let mut out = "\"".to_owned();
    for c in text.chars() {
        match c {
            '"' | '\\' => out.extend(['\\', c]),
            '\n' => out.push_str("\\n"),
            c if c.is_control() => {
                let _ = write!(out, "\\u{:04X}", u32::from(c));
            }
            c => out.push(c),
        }
    }
    out.push('"');
    out
}

/// Ends of a whole path of another computer, the longest first: `D:/me/walls/a.ttm` gives `walls/a.ttm`.
fn ends_of(path: &str) -> impl Iterator<Item = &str> {
    let is_drive = path.as_bytes().get(1) == Some(&b':');
    let parts = path.match_indices('/').skip(1).map(|(k, _)| &path[k + 1..]);
    parts.filter(move |end| (path.starts_with('/') || is_drive) && end.contains('/'))
}

impl SimApi<'_> {
    /// Loads the objects of a scene file, or of the scene of a folder, below a new object at the world's origin, and
    /// returns its handle. Its gravity and experiment are left out; its scripts run from the next phase on, but for
    /// those of models that clients have sent.
    ///
    /// A name is looked for in the folder of the scene, in the one that holds it, and in folders `models` beside these,
    /// further up and in the working directory; a name of V-REP (`robots/Pioneer P3DX.ttm`) means the folder
    /// `pioneer-p3dx`.
    ///
    /// # Errors
    ///
    /// There is no such model, it lies elsewhere, or something in it is wrong.
    pub(crate) fn load_model(&mut self, name: &str) -> Result<Handle, ApiError> {
        let last = name.rsplit(['/', '\\']).next().unwrap_or_default();
        if let Some(text) = self.registry.kept_text(last) {
            // one that a script has saved in this run
            let text = String::from_utf8_lossy(text).into_owned();
            return self.load_model_text_as(&text, last.split('.').next().unwrap_or_default());
        }
        let file = self.find_model(name)?;
        let is_sent = self.registry.sent_folder.as_ref().and_then(|folder| folder.canonicalize().ok());
        if is_sent.is_some_and(|folder| file.starts_with(folder)) {
            // what a client has sent names no file outside of the folder of the scene
            let text = std::fs::read_to_string(&file);
            let text = text.map_err(|e| ApiError(format!("`{}` cannot be read: {e}", file.display())))?;
            let stem = file.file_stem().map(|stem| stem.to_string_lossy().into_owned());
            return self.load_model_text_as(&text, &stem.unwrap_or_default());
        }
        self.load_model_file(&file)
    }

    /// Loads a model from its file.
    fn load_model_file(&mut self, file: &Path) -> Result<Handle, ApiError> {
        let stem = |path: &Path| path.file_stem().map(|stem| stem.to_string_lossy().into_owned());
        let is_scene = file.file_name().is_some_and(|name| name == "scene.toml");
        let own = if is_scene { file.parent().and_then(stem) } else { stem(file) };
        let name = self.fresh_name(&own.unwrap_or_else(|| "model".to_owned()));
        self.check_room(1)?;
        let mut edit = self.draft()?;
        let loaded =
            edit.draft.load(file, &name, self.registry.script_parser).map_err(|found| super::refused(&found))?;
        self.check_room(loaded.len())?;
        self.rebuild(edit)?;
        self.handle_at(&format!("/{name}"))
    }

    /// Loads a model from its text, as [`SimApi::model_text`] gives it.
    ///
    /// # Errors
    ///
    /// Something in it is wrong.
    pub(crate) fn load_model_text(&mut self, text: &str) -> Result<Handle, ApiError> {
        self.load_model_text_as(text, "model")
    }

    fn load_model_text_as(&mut self, text: &str, name: &str) -> Result<Handle, ApiError> {
        let name = self.fresh_name(name);
        self.check_room(1)?;
        let mut edit = self.draft()?;
        let loaded = edit.draft.load_text(text, &name).map_err(|found| super::refused(&found))?;
        self.check_room(loaded.len())?;
        self.rebuild(edit)?;
        self.handle_at(&format!("/{name}"))
    }

    /// The file of a model.
    fn find_model(&self, name: &str) -> Result<PathBuf, ApiError> {
        let short: String = name.chars().take(100).collect();
        let text = name.replace('\\', "/");
        if text.is_empty() || text.contains('\0') {
            return Err(ApiError(format!("`{short}` is no name of a model")));
        }
        let scene = Path::new(&self.registry.scene_path).parent().unwrap_or(Path::new(".")).to_path_buf();
        let whole = |path: &Path| path.canonicalize().ok();
        let mut roots: Vec<PathBuf> = whole(&scene).into_iter().collect();
        let above: Vec<PathBuf> =
            roots.iter().flat_map(|scene| scene.ancestors().skip(1)).map(Path::to_path_buf).collect();
        roots.extend(above.iter().filter_map(|folder| whole(&folder.join("models"))));
        roots.extend(whole(Path::new("models")));
        roots.extend(self.registry.sent_folder.as_deref().and_then(whole));
        let plain = text.strip_suffix(".ttm").or_else(|| text.strip_suffix(".simmodel.xml")).unwrap_or(&text);
        let last = plain.rsplit('/').next().unwrap_or(plain);
        let spelled: String = last.to_lowercase().split_whitespace().collect::<Vec<_>>().join("-");
        let under_models = plain.split_once("models/").map_or(plain, |(_, rest)| rest);
        let stays =
            |candidate: &str| Path::new(candidate).components().all(|part| matches!(part, Component::Normal(_)));
        let within = |root: &Path, candidate: &str| {
            let path = root.join(candidate);
            let file = if path.is_dir() { path.join("scene.toml") } else { path };
            whole(&file).filter(|file| file.is_file() && file.starts_with(root))
        };
        for root in &roots {
            // whole paths, which scripts make of sim.stringparam_scene_path
            let below = |text| Path::new(text).strip_prefix(root).or_else(|_| Path::new(text).strip_prefix(&scene));
            let [whole, whole_plain] =
                [&*text, plain].map(|text| below(text).ok().and_then(Path::to_str).unwrap_or(text));
            let ends = ends_of(&text).flat_map(|end| [end, end.strip_suffix(".ttm").unwrap_or(end)]);
            let candidates = [whole, whole_plain, under_models].into_iter().chain(ends).chain([last, &*spelled]);
            let candidates = candidates.filter(|name| stays(name));
            if let Some(file) = candidates.filter_map(|name| within(root, name)).next() {
                return Ok(file);
            }
        }
        // a scene beside this one, by the name of its folder
        let beside = above.first().into_iter().flat_map(|folder| [last, &spelled].map(|name| (folder, name)));
        let mut beside = beside.filter(|(folder, name)| stays(name) && folder.join(name).is_dir());
        if let Some(file) = beside.find_map(|(folder, name)| within(folder, name)) {
            return Ok(file);
        }
        let help =
            "give a folder or scene file inside the folder of the scene, a scene folder beside it, or one of `models/`";
        Err(ApiError(format!("there is no model `{short}`: {help}")))
    }

    /// Text of the scene file of the model, as runs begin with it, and the number of runtime objects that it does not
    /// have.
    ///
    /// # Errors
    ///
    /// The scene's file is not known, or too long.
    pub(crate) fn scene_text(&mut self) -> Result<(String, usize), ApiError> {
        let mut text = self.draft()?.draft.text();
        for script in &self.registry.scene().scripts {
            let kind = if script.kind == ScriptKind::Customization { "kind = \"customization\"\n" } else { "" };
            let threaded = if script.is_threaded { "threaded = true\n" } else { "" };
            let (object, code) = (quoted(&script.path), quoted(&script.text));
            let _ = write!(text, "\n[[script]]\nobject = {object}\n{kind}{threaded}code = {code}\n");
        }
        if text.len() > MAX_TEXT {
            return Err(ApiError(format!("the scene takes more than {} MiB", MAX_TEXT >> 20)));
        }
        Ok((text, self.registry.entries().filter(|entry| entry.is_runtime).count()))
    }

    /// Text of a scene file with an object of the model and all below it, joints at their present positions; it can be
    /// loaded as a model.
    ///
    /// # Errors
    ///
    /// `handle` is no object, or none of the model.
    pub(crate) fn model_text(&mut self, handle: Handle) -> Result<String, ApiError> {
        let edit = self.draft()?;
        self.registry.entry(handle)?;
        // a free body goes with the joint that lets it move, and with what is beside it there
        let carrier = self.registry.joint_below(handle);
        let root = carrier.filter(|joint| self.is_free_joint(*joint)).unwrap_or(handle);
        let path = self.model_path(root)?;
        let (names, q) = (self.world.model().names(), &self.world.state.q);
        let free_root = self.is_free_joint(root);
        let text = edit.draft.part(&path, &|joint| {
            // a model that moves freely stands at its origin
            let info = names.joint(joint).filter(|_| !(free_root && joint == path))?;
            Some(q[info.q_idx..][..info.n_q].to_vec())
        });
        if text.len() > MAX_TEXT {
            return Err(ApiError(format!("the model takes more than {} MiB", MAX_TEXT >> 20)));
        }
        Ok(text)
    }
}
