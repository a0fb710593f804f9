//! Files that a scene gives a script: read when the scene is loaded, so that a run depends on nothing that may change,
//! and found by the names that stand in the scene. Without any, `io` is shut off whole.

use mlua::{Function, Lua, Table};
use sincro_scene::script::Script;

/// Lets a script read its files.
pub(crate) fn offer(lua: &Lua, script: &Script) -> mlua::Result<()> {
    if script.files.is_empty() {
        return Ok(());
    }
    let files = script.files.clone();
    let text = lua.create_function(move |lua, name: String| {
        let found = files.iter().find(|(known, _)| *known == name);
        found.map(|(_, source)| lua.create_string(&source.text)).transpose()
    })?;
    let (open, lines, kind): (Function, Function, Function) =
        lua.load(include_str!("files.lua")).set_name(crate::sandbox::OWN_SOURCE).call(text)?;
    let io: Table = lua.globals().get("io")?;
    io.set("open", open)?;
    io.set("lines", lines)?;
    io.set("type", kind)
}
