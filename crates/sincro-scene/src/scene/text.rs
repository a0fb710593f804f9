//! A scene from a text instead of a folder.

use std::collections::BTreeMap;
use std::path::Path;
use std::sync::Arc;

use super::{Scene, SceneSource, scene_schema};
use crate::diagnostic::{Diagnostics, SourceText};
use crate::document::Document;
use crate::folder::Folder;
use crate::names::resolve_objects;
use crate::normalize::{Parameters, normalize};
use crate::schema::validate;

/// Compiles the text of a scene file, for tests and examples without a folder. Files that it names are looked for in
/// the working directory; the seed of its turbulence is 0.
///
/// ```
/// let text = r#"
///     [[joint]]
///     name = "hinge"
///     kind = "revolute"
///     axis = [0.0, 1.0, 0.0]
///
///     [[body]]
///     name = "rod"
///     parent = "/hinge"
///     mass = 1.0
///     center_of_mass = [0.0, 0.0, -0.5]
///     inertia = { xx = 0.1, yy = 0.1, zz = 0.01 }
/// "#;
/// let scene = sincro_scene::scene::from_text(text).unwrap();
/// assert_eq!(scene.model.n_v(), 1);
/// ```
///
/// # Errors
///
/// All findings about the text, warnings included, in its order.
pub fn from_text(text: &str) -> Result<Scene, Diagnostics> {
    let source = Arc::new(SourceText { path: "scene.toml".into(), text: text.to_owned() });
    let mut document = Document::parse(&source)?;
    let mut found = normalize(&mut document, scene_schema(), &Parameters::new());
    found.merge(resolve_objects(&mut document));
    found.merge(validate(&document, scene_schema()));
    if found.any_error() {
        return Err(found.sorted());
    }
    let folder = Arc::new(Folder::new(Path::new("")));
    let scene = super::compile(&document, &folder, 0, None)?;
    Ok(Scene { source: Some(Arc::new(SceneSource { document, folder, seed: 0, parked: BTreeMap::new() })), ..scene })
}
