//! The tables `simROS`, `simROS2` and `simB0`: topics between the scripts of the scene.
//!
//! Scripts that talk to ROS publish what they measure and wait for what others tell them. Here those others are scripts
//! of the same scene; nothing leaves the program, and messages are not checked against the types of ROS. Callbacks are
//! called before the actuation of a step, by [`DELIVER`].

use mlua::{Error, Function, MultiValue, Table, Value as LuaValue};
use sincro_coppelia::api::ApiError;

use super::ApiContext;
use crate::convert::{from_lua, to_lua};

/// Named value of the Lua state: the function that hands messages to those who have subscribed.
pub(crate) const DELIVER: &str = "sincro.topics";

fn refused(ApiError(message): ApiError) -> Error {
    Error::RuntimeError(format!("{message} (in module 'simROS')"))
}

/// The three modules.
pub(super) fn modules(context: &ApiContext<'_>) -> mlua::Result<[Table; 3]> {
    let (lua, index) = (context.lua, context.index);
    let told = std::sync::atomic::AtomicBool::new(false);
    let shared = context.shared.clone();
    let advertise = lua.create_function(move |_, (topic, latches): (String, bool)| {
        if !told.swap(true, std::sync::atomic::Ordering::Relaxed) {
            shared.say(
                index,
                "topics of simROS, simROS2 and simB0 join the scripts of this scene: there is no ROS".into(),
            );
        }
        shared.topics().advertise(index, &topic, latches).map_err(refused)
    })?;
    let shared = context.shared.clone();
    let subscribe = lua.create_function(move |_, (topic, capacity): (String, usize)| {
        shared.topics().subscribe(index, &topic, capacity).map_err(refused)
    })?;
    let shared = context.shared.clone();
    let publish = lua.create_function(move |_, (handle, message, _): (i64, LuaValue, MultiValue)| {
        let message = from_lua(message)?;
        shared.topics().publish(handle, &message).map_err(refused)
    })?;
    let shared = context.shared.clone();
    let shut_down = lua.create_function(move |_, handle: i64| shared.topics().shut_down(handle).map_err(refused))?;
    let shared = context.shared.clone();
    let take = lua.create_function(move |lua, ()| {
        let taken = shared.topics().take(index);
        let pairs = taken
            .iter()
            .map(|(handle, message)| lua.create_sequence_from([LuaValue::Integer(*handle), to_lua(lua, message)?]));
        lua.create_sequence_from(pairs.collect::<mlua::Result<Vec<_>>>()?)
    })?;
    let refuse = lua.create_function(|_, name: String| -> mlua::Result<()> {
        let why =
            "there is no ROS: topics join the scripts of the scene, and there are no services, actions and parameters";
        Err(Error::RuntimeError(format!("{name} is not offered: {why}")))
    })?;
    let text = lua.load(include_str!("../ros.lua")).set_name(crate::sandbox::OWN_SOURCE);
    let (ros, ros2, b0, deliver): (Table, Table, Table, Function) =
        text.call((&context.sim, advertise, subscribe, publish, shut_down, take, refuse))?;
    lua.set_named_registry_value(DELIVER, deliver)?;
    Ok([ros, ros2, b0])
}
