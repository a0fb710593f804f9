//! Functions before which changes of the structure may wait, so that many of them are one compilation.

use std::collections::BTreeSet;
use std::sync::OnceLock;

use sincro_conventions::names::BEFORE_BODIES;

use super::{Function, bits, buffers, images, rotations, signals, transforms, tubes, ui, windows};
use crate::api::{ApiError, Arguments, Handle, Search, SimApi, Value};

/// Functions that remove objects.
const REMOVING: [&str; 3] = ["removeObject", "removeObjects", "removeModel"];
/// Functions that find an object by its name.
const FINDING: [&str; 2] = ["getObject", "getObjectHandle"];
/// Functions that tell something of one object which does not depend on others.
const ASKING: [&str; 3] = ["getObjectName", "getObjectPosition", "getObjectType"];

/// Functions that neither show nor change objects.
fn without_objects() -> &'static BTreeSet<&'static str> {
    static NAMES: OnceLock<BTreeSet<&'static str>> = OnceLock::new();
    let categories = [
        bits::FUNCTIONS,
        buffers::FUNCTIONS,
        images::FUNCTIONS,
        ui::WINDOWS,
        rotations::FUNCTIONS,
        signals::FUNCTIONS,
        transforms::FUNCTIONS,
        tubes::FUNCTIONS,
        ui::FUNCTIONS,
        windows::FUNCTIONS,
    ];
    NAMES.get_or_init(|| categories.into_iter().flatten().map(|f| f.name).collect())
}

/// Returns true if shapes that are to become bodies may be none while a function is called.
pub(super) fn bodies_may_wait(function: &Function) -> bool {
    let name = &function.name;
    BEFORE_BODIES.contains(name) || REMOVING.contains(name) || without_objects().contains(name)
}

/// Returns true if objects that are to be removed may be there while a function is called: it does not show them.
pub(super) fn removal_may_wait(sim: &SimApi<'_>, function: &Function, a: Arguments<'_>) -> bool {
    let name = &function.name;
    let stays = |own: Handle| !sim.registry.doomed.iter().any(|(doomed, _)| *doomed == own);
    if ASKING.contains(name) {
        let own = a.get(0).as_int().and_then(|own| i32::try_from(own).ok());
        return own.is_some_and(|own| stays(Handle(own))) && (!a.has(1) || a.get(1) == &Value::Int(-1));
    }
    if FINDING.contains(name) {
        let text = a.get(0).as_text().filter(|text| counts_nothing(text) && !a.has(1));
        let found = text.and_then(|text| sim.registry.find(text, Search::default()).ok());
        return found.is_some_and(stays);
    }
    REMOVING.contains(name) || without_objects().contains(name)
}

/// Returns true if the object of a path or name does not depend on how many others fit it.
fn counts_nothing(text: &str) -> bool {
    !text.contains(['[', '{', '#', '*', '?', '.', ':', '@'])
}

impl SimApi<'_> {
    /// Result of a search for an object by `text`, with objects that are to be removed gone if that makes a difference.
    ///
    /// # Errors
    ///
    /// As of the search; or an object cannot be removed.
    pub fn found_by(
        &mut self,
        text: &str,
        search: impl Fn(&mut Self) -> Result<Handle, ApiError>,
    ) -> Result<Handle, ApiError> {
        let found = search(self);
        let stays = |own: &Handle| !self.registry.doomed.iter().any(|(doomed, _)| doomed == own);
        if self.registry.doomed.is_empty() || counts_nothing(text) && found.as_ref().is_ok_and(stays) {
            return found;
        }
        self.remove_doomed()?;
        search(self)
    }
}
