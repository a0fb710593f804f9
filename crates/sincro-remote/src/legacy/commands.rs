//! Table of the commands of the legacy API: number on the wire, name in the clients' library, function.
//!
//! A function is a call of [`SimApi`] between two codecs: it reads its arguments from a [`Call`] and gives the data of
//! the reply.

use sincro_coppelia::api::{ApiError, SimApi};

use super::functions::{self, Call, Reply};
use super::{files, group, joints, objects, parameters, script, seeing, sensing, signals};
use crate::hub::SessionGuard;

/// A row of the table.
pub(super) struct Row {
    pub number: u16,
    /// Function of the clients' library that sends the command.
    pub name: &'static str,
    pub function: Function,
}

/// Executor of a command.
#[derive(Clone, Copy)]
pub(super) enum Function {
    /// On the objects of the scene.
    Sim(fn(&mut SimApi<'_>, &Call<'_>) -> Reply),
    /// On the session: starts, stops, loads.
    Session(fn(&mut SessionGuard, &Call<'_>) -> Reply),
    /// On the connection, by its client: synchronous mode, errors, closing.
    Client,
    /// Not offered, with the reason. A client sees return code 8, and the text by `simxGetLastErrors`.
    Refused(&'static str),
}

use Function::{Client, Refused, Session, Sim};

const DIALOGS: &str = "there is nobody to answer a dialog here";
const INTERFACES: &str = "there are no user interfaces here";

/// Enables synchronous mode.
pub(super) const SYNCHRONOUS_ON: u16 = 0x0001;
/// Disables synchronous mode.
pub(super) const SYNCHRONOUS_OFF: u16 = 0x0002;
/// Triggers a step in synchronous mode.
pub(super) const TRIGGER: u16 = 0x0003;
/// Texts of the errors since the last call.
pub(super) const LAST_ERRORS: u16 = 0x0004;
/// Closes the connection.
pub(super) const FINISH: u16 = 0x000a;
/// Handle of an object by its name.
pub(super) const GET_HANDLE: u16 = 0x3001;
/// Takes a string signal: its stream ends with what it was waiting for.
pub(super) const TAKE_STRING: u16 = 0x3017;

const fn row(number: u16, name: &'static str, function: Function) -> Row {
    Row { number, name, function }
}

/// All commands, by number.
pub(super) const COMMANDS: &[Row] = &[
    row(SYNCHRONOUS_ON, "simxSynchronous", Client),
    row(SYNCHRONOUS_OFF, "simxSynchronous", Client),
    row(TRIGGER, "simxSynchronousTrigger", Client),
    row(LAST_ERRORS, "simxGetLastErrors", Client),
    row(0x0005, "simxCloseScene", Session(functions::close)),
    row(0x0006, "simxGetObjectSelection", Sim(objects::selection)),
    row(0x0009, "simxCreateDummy", Sim(objects::create_dummy)),
    row(FINISH, "simxFinish", Client),
    row(0x1001, "simxGetJointPosition", Sim(joints::position)),
    row(0x1002, "simxSetJointPosition", Sim(joints::set_position)),
    row(0x1003, "simxGetVisionSensorImage", Sim(seeing::grey_image)),
    row(0x1004, "simxGetVisionSensorImage", Sim(seeing::rgb_image)),
    row(0x1005, "simxSetVisionSensorImage", Sim(seeing::set_grey_image)),
    row(0x1006, "simxSetVisionSensorImage", Sim(seeing::set_rgb_image)),
    row(0x1007, "simxStartSimulation", Session(functions::simulation)),
    row(0x1008, "simxSetJointTargetVelocity", Sim(joints::set_target_velocity)),
    row(0x1009, "simxReadProximitySensor", Sim(sensing::proximity)),
    row(0x100a, "simxGetJointMatrix", Sim(joints::matrix)),
    row(0x100b, "simxSetSphericalJointMatrix", Sim(joints::set_matrix)),
    row(0x100c, "simxSetJointTargetPosition", Sim(joints::set_target_position)),
    row(0x100d, "simxGetJointForce", Sim(joints::force)),
    row(0x100e, "simxSetJointMaxForce", Sim(joints::set_target_force)),
    row(0x100f, "simxReadForceSensor", Sim(sensing::force_sensor)),
    row(0x1010, "simxBreakForceSensor", Sim(sensing::break_force_sensor)),
    row(0x1011, "simxReadVisionSensor", Sim(seeing::read)),
    row(0x1012, "simxGetObjectParent", Sim(objects::parent)),
    row(0x1014, "simxAuxiliaryConsoleClose", Sim(functions::nothing)),
    row(0x1015, "simxAuxiliaryConsolePrint", Sim(functions::nothing)),
    row(0x1016, "simxAuxiliaryConsoleShow", Sim(functions::nothing)),
    row(0x1017, "simxGetVisionSensorDepthBuffer", Sim(seeing::depths)),
    // of older clients: the reference frame is in the data
    row(0x1018, "simxGetObjectOrientation", Sim(objects::old_orientation)),
    row(0x1019, "simxGetObjectPosition", Sim(objects::old_position)),
    row(0x101a, "simxSetObjectOrientation", Sim(objects::set_orientation)),
    row(0x101b, "simxSetObjectPosition", Sim(objects::set_position)),
    row(0x101c, "simxSetObjectParent", Sim(objects::set_parent)),
    row(0x101d, "simxGetArrayParameter", Sim(parameters::array)),
    row(0x101e, "simxSetArrayParameter", Sim(parameters::set_array)),
    row(0x101f, "simxGetBooleanParameter", Sim(parameters::bool)),
    row(0x1020, "simxSetBooleanParameter", Sim(parameters::set_bool)),
    row(0x1021, "simxGetIntegerParameter", Sim(parameters::int)),
    row(0x1022, "simxSetIntegerParameter", Sim(parameters::set_int)),
    row(0x1023, "simxGetFloatingParameter", Sim(parameters::float)),
    row(0x1024, "simxSetFloatingParameter", Sim(parameters::set_float)),
    row(0x1025, "simxGetStringParameter", Sim(parameters::text)),
    row(0x1026, "simxReadCollision", Sim(sensing::read_collision)),
    row(0x1027, "simxReadDistance", Sim(sensing::read_distance)),
    row(0x1028, "simxRemoveObject", Sim(objects::remove)),
    row(0x1029, "simxRemoveUI", Refused(INTERFACES)),
    row(0x102a, "simxGetObjects", Sim(objects::of_type)),
    row(0x102b, "simxEndDialog", Refused(DIALOGS)),
    row(0x102c, "simxGetDialogInput", Refused(DIALOGS)),
    row(0x102d, "simxGetDialogResult", Refused(DIALOGS)),
    row(0x102e, "simxCopyPasteObjects", Sim(objects::copies)),
    row(0x102f, "simxSetObjectSelection", Sim(objects::select)),
    row(0x1034, "simxGetModelProperty", Sim(objects::model_property)),
    row(0x1035, "simxSetModelProperty", Sim(objects::set_model_property)),
    row(0x1036, "simxGetObjectVelocity", Sim(objects::velocity)),
    row(0x1037, "simxRemoveModel", Sim(objects::remove_model)),
    row(0x1038, "simxGetJointMaxForce", Sim(joints::target_force)),
    row(0x1801, "simxSetObjectQuaternion", Sim(objects::set_quaternion)),
    row(0x2001, "simxGetUISlider", Refused(INTERFACES)),
    row(0x2002, "a function of user interfaces", Refused(INTERFACES)),
    row(0x2003, "a function of user interfaces", Refused(INTERFACES)),
    row(0x2004, "a function of user interfaces", Refused(INTERFACES)),
    row(0x2005, "a function of user interfaces", Refused(INTERFACES)),
    row(0x2006, "a function of user interfaces", Refused(INTERFACES)),
    row(0x2007, "simxGetObjectFloatParameter", Sim(objects::float)),
    row(0x2008, "simxGetObjectIntParameter", Sim(objects::int)),
    row(0x2009, "simxSetObjectFloatParameter", Sim(objects::set_float)),
    row(0x200a, "simxSetObjectIntParameter", Sim(objects::set_int)),
    row(0x200b, "simxGetObjectChild", Sim(objects::child)),
    row(0x200c, "simxGetObjectGroupData", Sim(group::run)),
    row(0x200d, "simxGetObjectOrientation", Sim(objects::orientation)),
    row(0x200e, "simxGetObjectPosition", Sim(objects::position)),
    row(0x200f, "simxCheckCollision", Sim(sensing::collision)),
    row(0x2010, "simxCheckDistance", Sim(sensing::distance)),
    row(0x2801, "simxGetObjectQuaternion", Sim(objects::quaternion)),
    row(GET_HANDLE, "simxGetObjectHandle", Sim(objects::handle)),
    row(0x3002, "simxLoadScene", Session(files::load_scene)),
    row(0x3003, "simxLoadModel", Session(files::load_model)),
    row(0x3004, "simxTransferFile", Session(files::receive)),
    row(0x3005, "simxLoadUI", Refused(INTERFACES)),
    row(0x3006, "simxEraseFile", Session(files::erase)),
    row(0x3007, "simxGetUIHandle", Refused(INTERFACES)),
    row(0x3008, "simxAddStatusbarMessage", Sim(functions::log)),
    row(0x3009, "simxAuxiliaryConsoleOpen", Sim(functions::console)),
    row(0x300a, "simxGetCollisionHandle", Sim(sensing::collision_handle)),
    row(0x300b, "simxGetDistanceHandle", Sim(sensing::distance_handle)),
    row(0x300c, "simxDisplayDialog", Refused(DIALOGS)),
    row(0x300d, "simxClearFloatSignal", Sim(signals::clear_float)),
    row(0x300e, "simxClearIntegerSignal", Sim(signals::clear_int)),
    row(0x300f, "simxClearStringSignal", Sim(signals::clear_text)),
    row(0x3010, "simxGetFloatSignal", Sim(signals::float)),
    row(0x3011, "simxGetIntegerSignal", Sim(signals::int)),
    row(0x3012, "simxGetStringSignal", Sim(signals::text)),
    row(0x3013, "simxSetFloatSignal", Sim(signals::set_float)),
    row(0x3014, "simxSetIntegerSignal", Sim(signals::set_int)),
    row(0x3015, "simxSetStringSignal", Sim(signals::set_text)),
    row(0x3016, "simxAppendStringSignal", Sim(signals::append_text)),
    row(TAKE_STRING, "simxGetAndClearStringSignal", Sim(signals::take_text)),
    row(0x3018, "simxReadStringStream", Sim(signals::read_stream)),
    row(0x3019, "simxGetCollectionHandle", Sim(objects::collection)),
    row(0x3401, "simxCallScriptFunction", Session(script::run)),
];

/// The row of a number.
pub(super) fn find_row(number: u16) -> Option<&'static Row> {
    COMMANDS.binary_search_by_key(&number, |row| row.number).ok().map(|k| &COMMANDS[k])
}

/// A command for messages: `simxGetJointPosition, command 0x1001`.
pub(super) fn shown(number: u16) -> String {
    match find_row(number) {
        Some(row) => format!("{}, command 0x{number:04x}", row.name),
        None => format!("command 0x{number:04x}"),
    }
}

/// Runs a command that is no command of the connection.
pub(super) fn run(guard: &mut SessionGuard, call: &Call<'_>) -> Reply {
    let number = call.function;
    match find_row(number).map(|row| row.function) {
        Some(Sim(function)) => function(&mut guard.session.sim(), call),
        Some(Session(function)) => function(guard, call),
        Some(Refused(why)) => Err(ApiError::new(why)),
        Some(Client) | None => Err(ApiError(format!("command 0x{number:04x} is not offered here"))),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_ascend_so_that_each_is_found() {
        assert!(COMMANDS.is_sorted_by(|a, b| a.number < b.number));
        assert!(find_row(0x0000).is_none() && find_row(0x3401).is_some_and(|row| row.name == "simxCallScriptFunction"));
    }
}
