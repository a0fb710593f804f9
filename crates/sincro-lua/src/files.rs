//! Files of scripts: those that a scene gives a script, read when the scene is loaded, so that a run depends on nothing
//! that may change, and found by the names that stand in the scene; and those that scripts write, kept with the results
//! of the run. A script reaches no other files.

use std::sync::Arc;

use mlua::{Error, Function, Lua, LuaString, Table};
use sincro_coppelia::api::{ApiError, SimApi};
use sincro_sim::result_folder::TEXT_FILES;

use crate::guard::Guard;
use crate::shared::Shared;

/// Instructions that a call counts as, and bytes that count as one more.
const COST: (u64, usize) = (20, 16);

/// Lets a script read its files and write others.
pub(crate) fn offer(lua: &Lua, shared: &Arc<Shared>, index: usize, guard: &Arc<Guard>) -> mlua::Result<()> {
    let script = shared.script(index);
    let own = crate::shared::handle_of(&script);
    let (files, of_reads) = (script.files.clone(), shared.clone());
    let text = lua.create_function(move |lua, name: String| {
        // the second tells that the scene has it
        if let Some(source) = given(&files, &name) {
            return Ok((Some(lua.create_string(&source.text)?), true));
        }
        let written = of_reads.with_sim(own, |sim| Ok(sim.registry.kept_text(&file_name(&name)).map(<[u8]>::to_vec)));
        Ok((written.ok().flatten().map(|text| lua.create_string(text)).transpose()?, false))
    })?;
    let (of_writes, guard) = (shared.clone(), guard.clone());
    let keep = lua.create_function(move |lua, (name, text, is_behind): (String, LuaString, bool)| {
        guard.charge(lua, COST.0 + (text.as_bytes().len() / COST.1) as u64)?;
        let kept = of_writes.with_sim(own, |sim| keep(sim, &name, &text.as_bytes(), is_behind));
        kept.map_err(|ApiError(message)| Error::RuntimeError(format!("{message} (in function 'io.open')")))
    })?;
    let has_files = !script.files.is_empty();
    let (open, lines, kind): (Function, Function, Function) =
        lua.load(include_str!("files.lua")).set_name(crate::sandbox::OWN_SOURCE).call((text, keep, has_files))?;
    let io: Table = lua.globals().get("io")?;
    io.set("open", open)?;
    io.set("type", kind)?;
    if has_files {
        io.set("lines", lines)?;
    }
    Ok(())
}

/// The file of the scene that a script means by `name`: that of this name, or, of a path on some computer, the one
/// whose name in the scene is the longest end of it.
fn given<'a, T>(files: &'a [(String, T)], name: &str) -> Option<&'a T> {
    let path = name.replace('\\', "/");
    let is_end = |known: &str| path.strip_suffix(known).is_some_and(|before| before.ends_with('/'));
    let exact = files.iter().find(|(known, _)| *known == name || *known == path);
    let ending = || files.iter().filter(|(known, _)| is_end(known)).max_by_key(|(known, _)| known.len());
    exact.or_else(ending).map(|(_, file)| file)
}

/// Name in the results of a file that a script writes: the last part of a path, with an extension of texts.
fn file_name(path: &str) -> String {
    let last = path.rsplit(['/', '\\']).next().unwrap_or_default();
    let extension = last.rsplit_once('.').map(|(_, extension)| extension.to_ascii_lowercase());
    match extension {
        Some(extension) if TEXT_FILES.contains(&&*extension) => last.to_owned(),
        _ => format!("{last}.txt"),
    }
}

fn keep(sim: &mut SimApi<'_>, path: &str, text: &[u8], is_behind: bool) -> Result<(), ApiError> {
    let name = file_name(path);
    if !sim.is_running() {
        let when = "scripts write files while a run is on";
        return Err(ApiError(format!("`{name}` is not written: {when}, into the folder `files` of its results")));
    }
    sim.registry.keep_text(&name, text, is_behind)
}

#[cfg(test)]
mod tests {
    use super::given;

    #[test]
    fn files_are_found_by_the_end_of_a_path() {
        let files = [("path.csv".to_owned(), 1), ("data/path.csv".to_owned(), 2)];
        for (name, expected) in [
            ("path.csv", Some(1)),
            ("/scenes/of/others/path.csv", Some(1)),
            (r"C:\scenes\data\path.csv", Some(2)),
            ("data/path.csv", Some(2)),
            ("mypath.csv", None),
            ("path.csv/other", None),
        ] {
            assert_eq!(given(&files, name).copied(), expected, "{name}");
        }
    }
}
