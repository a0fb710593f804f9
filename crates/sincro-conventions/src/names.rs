//! Old names of functions, as their present ones.

use std::borrow::Cow;

/// Old name without `sim`, its first letter small; and the present name. What follows the rule is not listed.
const IRREGULAR: &[(&str, &str)] = &[
    ("jointGetForce", "getJointForce"),
    ("getJointMaxForce", "getJointTargetForce"),
    ("getRealTimeSimulation", "getIsRealTimeSimulation"),
    ("getIntegerSignal", "getInt32Signal"),
    ("setIntegerSignal", "setInt32Signal"),
    ("clearIntegerSignal", "clearInt32Signal"),
    ("getBooleanParameter", "getBoolParam"),
    ("setBooleanParameter", "setBoolParam"),
    ("getBoolParameter", "getBoolParam"),
    ("setBoolParameter", "setBoolParam"),
    ("getIntegerParameter", "getInt32Param"),
    ("setIntegerParameter", "setInt32Param"),
    ("getInt32Parameter", "getInt32Param"),
    ("setInt32Parameter", "setInt32Param"),
    ("getIntParam", "getInt32Param"),
    ("getFloatingParameter", "getFloatParam"),
    ("setFloatingParameter", "setFloatParam"),
    ("getFloatParameter", "getFloatParam"),
    ("setFloatParameter", "setFloatParam"),
    ("getStringParameter", "getStringParam"),
    ("getArrayParameter", "getArrayParam"),
    ("setArrayParameter", "setArrayParam"),
    ("getObjectIntParameter", "getObjectInt32Param"),
    ("setObjectIntParameter", "setObjectInt32Param"),
    ("getObjectInt32Parameter", "getObjectInt32Param"),
    ("setObjectInt32Parameter", "setObjectInt32Param"),
    ("getObjectFloatParameter", "getObjectFloatParam"),
    ("setObjectFloatParameter", "setObjectFloatParam"),
    ("getVisionSensorResolution", "getVisionSensorRes"),
    ("packFloats", "packFloatTable"),
    ("packDoubles", "packDoubleTable"),
    ("packInts", "packInt32Table"),
    ("packUInts", "packUInt32Table"),
    ("packWords", "packUInt16Table"),
    ("packBytes", "packUInt8Table"),
    ("unpackFloats", "unpackFloatTable"),
    ("unpackDoubles", "unpackDoubleTable"),
    ("unpackInts", "unpackInt32Table"),
    ("unpackUInts", "unpackUInt32Table"),
    ("unpackWords", "unpackUInt16Table"),
    ("unpackBytes", "unpackUInt8Table"),
    ("setEngineFloatParameter", "setEngineFloatParam"),
    ("setEngineInt32Parameter", "setEngineInt32Param"),
    ("setEngineBoolParameter", "setEngineBoolParam"),
    ("getEngineFloatParameter", "getEngineFloatParam"),
    ("getEngineInt32Parameter", "getEngineInt32Param"),
    ("getEngineBoolParameter", "getEngineBoolParam"),
    ("getGraphHandle", "getObjectHandle"),
    ("getObjectUniqueIdentifier", "getObjectUid"),
    ("setObjectSelection", "setObjectSel"),
    ("getInvertedMatrix", "getMatrixInverse"),
    ("getObjectStringParameter", "getObjectStringParam"),
    ("setObjectStringParameter", "setObjectStringParam"),
    ("setStringParameter", "setStringParam"),
    ("clearBufferSignal", "clearStringSignal"),
    ("setStringNamedParam", "setNamedStringParam"),
    ("getStringNamedParam", "getNamedStringParam"),
    ("getDoubleSignal", "getFloatSignal"),
    ("setDoubleSignal", "setFloatSignal"),
    ("clearDoubleSignal", "clearFloatSignal"),
    ("isHandleValid", "isHandle"),
    ("getObjectSelection", "getObjectSel"),
    ("rmlPos", "ruckigPos"),
    ("rmlVel", "ruckigVel"),
    ("rmlStep", "ruckigStep"),
    ("rmlRemove", "ruckigRemove"),
    ("rMLPos", "ruckigPos"),
    ("rMLVel", "ruckigVel"),
    ("rMLStep", "ruckigStep"),
    ("rMLRemove", "ruckigRemove"),
];

/// Irregular older names of functions of `sim` with their present names, both without `sim`, the first letter small.
/// Names that differ only in the prefix (`simGetObject`, `sim.getObject`) are not listed.
pub fn old_names() -> impl Iterator<Item = (&'static str, &'static str)> {
    IRREGULAR.iter().copied()
}

/// Present name, without `sim.`, of a function that may be given by an older one: `simJointGetForce` gives
/// `getJointForce`. A name that is not known comes back without its prefix.
#[must_use]
pub fn present_name(name: &str) -> Cow<'_, str> {
    let bare: Cow<'_, str> = match name.strip_prefix("sim.") {
        Some(bare) => bare.into(),
        None => match name.strip_prefix("sim").and_then(|rest| Some((rest.chars().next()?, rest))) {
            Some((first, rest)) if first.is_ascii_uppercase() => {
                format!("{}{}", first.to_ascii_lowercase(), &rest[1..]).into()
            }
            _ => name.into(),
        },
    };
    IRREGULAR.iter().find(|(old, _)| *old == bare).map_or(bare, |(_, present)| (*present).into())
}
/// Functions that see a shape which is to be a body (`shapeintparam_static`, `shapeintparam_respondable`) as they see
/// the body, and those that look at no objects: with them, shapes that a script makes one after the other become bodies
/// in one compilation of the scene.
pub const BEFORE_BODIES: &[&str] = &[
    "addLog",
    "addStatusbarMessage",
    "buildMatrix",
    "buildPose",
    "createDummy",
    "createMeshShape",
    "createPrimitiveShape",
    "createPureShape",
    "createShape",
    "getObjectHandle",
    "getObject",
    "getEngineFloatParam",
    "getObjectAlias",
    "getObjectMatrix",
    "getObjectName",
    "getObjectOrientation",
    "getObjectPose",
    "getObjectPosition",
    "getObjectQuaternion",
    "getRandom",
    "getSimulationTime",
    "getSimulationTimeStep",
    "groupShapes",
    "isHandle",
    "setEngineFloatParam",
    "setObjectAlias",
    "setObjectColor",
    "setObjectInt32Param",
    "setObjectMatrix",
    "setObjectName",
    "setObjectOrientation",
    "setObjectPose",
    "setObjectPosition",
    "setObjectQuaternion",
    "setObjectSpecialProperty",
    "setShapeColor",
    "setShapeMass",
];
