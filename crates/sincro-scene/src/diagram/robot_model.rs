//! Models that robot blocks compute with in place of the scene's own: another scene file, other numbers, or both.
//!
//! A controller designed with wrong masses, lengths or stiffness is a block with `model` or `set`. The model file is
//! read as a scene file is: includes, instances, defaults and formulas are resolved, the experiment's parameters win
//! over those of the file. Equal requests share one compiled model.

use std::collections::BTreeMap;
use std::sync::Arc;

use sincro_dynamics::model::Model;

use crate::apply_overrides::{Target, apply_all, whole_paths};
use crate::diagnostic::{Diagnostic, Diagnostics, Located};
use crate::document::Document;
use crate::expand::expand;
use crate::folder::Folder;
use crate::names::resolve_objects;
use crate::normalize::{Parameters, newer_format, normalize, parameters_of};
use crate::overrides::Override;
use crate::scene::{self, scene_schema};
use crate::schema::validate;
use crate::script::ScriptParser;
use crate::tree;

/// Request of a block: file of the model (`model`) and numbers that differ in it (`set`).
#[derive(Clone, Debug)]
pub(super) struct Request {
    /// Scene file; none is the scene of the experiment.
    pub file: Option<Located<String>>,
    /// Numbers that differ, by path.
    pub set: Vec<Override>,
}

/// Models compiled so far, and what others are made from.
#[derive(Debug)]
pub(super) struct Models<'a> {
    folder: &'a Folder,
    scene: Option<&'a Document>,
    parameters: &'a Parameters,
    parser: Option<&'static dyn ScriptParser>,
    known: BTreeMap<String, Arc<Model<f64>>>,
}

impl<'a> Models<'a> {
    /// `scene` is the experiment's scene as it was compiled, `parameters` those of the experiment.
    pub fn new(
        folder: &'a Folder,
        scene: Option<&'a Document>,
        parameters: &'a Parameters,
        parser: Option<&'static dyn ScriptParser>,
    ) -> Self {
        Self { folder, scene, parameters, parser, known: BTreeMap::new() }
    }

    /// The model that a block asks for.
    ///
    /// # Errors
    ///
    /// Everything that is wrong with the file or the settings.
    pub fn get(&mut self, request: &Request) -> Result<Arc<Model<f64>>, Diagnostics> {
        let key = key_of(request);
        if let Some(model) = self.known.get(&key) {
            return Ok(model.clone());
        }
        let model = self.compile(request)?;
        self.known.insert(key, model.clone());
        Ok(model)
    }

    fn compile(&self, request: &Request) -> Result<Arc<Model<f64>>, Diagnostics> {
        let mut diagnostics = Diagnostics::new();
        let (mut document, parameters, set) = match (&request.file, self.scene) {
            (Some(file), _) => self.read(file, &request.set, &mut diagnostics)?,
            (None, Some(scene)) => (scene.clone(), self.parameters.clone(), request.set.clone()),
            // the scene itself could not be read: that was said
            (None, None) => return Err(diagnostics),
        };
        let paths: Vec<String> = tree::raw_objects(&document).into_iter().map(|object| object.path).collect();
        let set = whole_paths(&set, Some(&document), &paths, &[], &mut diagnostics);
        diagnostics.merge(apply_all(&mut document, Target::Scene, &set));
        diagnostics.merge(normalize(&mut document, scene_schema(), &parameters));
        diagnostics.merge(resolve_objects(&mut document));
        diagnostics.merge(validate(&document, scene_schema()));
        if diagnostics.any_error() {
            return Err(diagnostics);
        }
        let parser = self.parser.map(|parser| parser as &dyn ScriptParser);
        let model = scene::compile(&document, self.folder, 0, parser).map(|scene| scene.model)?;
        if model.gravity_field().is_some() {
            // the recursions of the blocks know uniform gravity alone
            let message = "blocks with a model of the robot do not know gravity that depends on the position";
            let diagnostic = Diagnostic::error(&document.at("/gravity"), message);
            return Err(diagnostic.with_help("give their scene `gravity = [x, y, z]`, or `set` it for them").into());
        }
        Ok(model)
    }

    /// Reads a scene file with everything reused in it written out, the parameters that its formulas know, and those of
    /// the settings that are not of an instance in it.
    fn read(
        &self,
        file: &Located<String>,
        set: &[Override],
        diagnostics: &mut Diagnostics,
    ) -> Result<(Document, Parameters, Vec<Override>), Diagnostics> {
        let mut document = Document::parse(&self.folder.read_named(file)?)?;
        diagnostics.merge(newer_format(&document).map(Diagnostics::from).unwrap_or_default());
        let mut parameters = parameters_of(&document);
        parameters.extend(self.parameters.iter().map(|(name, x)| (name.clone(), *x)));
        let set = expand(&mut document, self.folder, &parameters, set, diagnostics);
        Ok((document, parameters, set))
    }
}

/// File and settings of a request as one text.
fn key_of(request: &Request) -> String {
    let file = request.file.as_ref().map_or("", |file| &file.value);
    let settings = request.set.iter().map(|set| format!("\n{}={}", set.path.value, set.value.value));
    std::iter::once(file.to_owned()).chain(settings).collect()
}
