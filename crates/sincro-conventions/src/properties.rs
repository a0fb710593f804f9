//! Properties of CoppeliaSim 4.7 and later that are functions under another name, by object and scene.

/// Arguments of a call before and behind the value, with the function.
type Setter = (&'static str, &'static [i64], &'static [i64]);

/// Property that is one of the functions under another name.
#[derive(Clone, Copy, Debug)]
pub struct Property {
    /// Name.
    pub name: &'static str,
    /// Function that reads it, with the arguments behind the handle.
    pub get: (&'static str, &'static [i64]),
    /// Function that sets it, with the arguments before and behind the value; none if it is only read.
    pub set: Option<Setter>,
}

const fn of(name: &'static str, get: (&'static str, &'static [i64]), set: Option<Setter>) -> Property {
    Property { name, get, set }
}

/// Properties of objects.
pub const PROPERTIES: &[Property] = &[
    of("alias", ("getObjectAlias", &[]), Some(("setObjectAlias", &[], &[]))),
    of("absPosition", ("getObjectPosition", &[-1]), Some(("setObjectPosition", &[], &[-1]))),
    of("absQuaternion", ("getObjectQuaternion", &[-1]), Some(("setObjectQuaternion", &[], &[-1]))),
    of("absEulerAngles", ("getObjectOrientation", &[-1]), Some(("setObjectOrientation", &[], &[-1]))),
    of("absPose", ("getObjectPose", &[-1]), Some(("setObjectPose", &[], &[-1]))),
    of("position", ("getObjectPosition", &[-11]), Some(("setObjectPosition", &[], &[-11]))),
    of("quaternion", ("getObjectQuaternion", &[-11]), Some(("setObjectQuaternion", &[], &[-11]))),
    of("eulerAngles", ("getObjectOrientation", &[-11]), Some(("setObjectOrientation", &[], &[-11]))),
    of("pose", ("getObjectPose", &[-11]), Some(("setObjectPose", &[], &[-11]))),
    of("parentHandle", ("getObjectParent", &[]), Some(("setObjectParent", &[], &[]))),
    of("objectUid", ("getObjectUid", &[]), None),
    of("jointType", ("getJointType", &[]), None),
    of("jointPosition", ("getJointPosition", &[]), Some(("setJointPosition", &[], &[]))),
    of("calcVelocity", ("getJointVelocity", &[]), None),
    of("jointForce", ("getJointForce", &[]), None),
    of("targetPos", ("getJointTargetPosition", &[]), Some(("setJointTargetPosition", &[], &[]))),
    of("targetVel", ("getJointTargetVelocity", &[]), Some(("setJointTargetVelocity", &[], &[]))),
    of("targetForce", ("getJointTargetForce", &[]), Some(("setJointTargetForce", &[], &[]))),
    of("jointMode", ("getJointMode", &[]), None),
    of("dynCtrlMode", ("getObjectInt32Param", &[2039]), Some(("setObjectInt32Param", &[2039], &[]))),
    of("cyclic", ("getJointInterval", &[]), None),
    of("mass", ("getShapeMass", &[]), Some(("setShapeMass", &[], &[]))),
    of("respondable", ("getObjectInt32Param", &[3004]), Some(("setObjectInt32Param", &[3004], &[]))),
    of("dynLinearVelocity", ("getVelocity", &[]), None),
    of("layer", ("getObjectInt32Param", &[10]), Some(("setObjectInt32Param", &[10], &[]))),
];

/// Flags of objects that are truth values, and their bits in `sim.objectspecialproperty_…`.
pub const FLAGS: [(&str, i64); 4] =
    [("collidable", 1), ("measurable", 2), ("detectable", 0x1f0), ("renderable", 0x200)];

/// Flags of objects in the windows of CoppeliaSim, and their bits in `sim.objectproperty_…`: kept, and of no effect.
pub const KEPT_FLAGS: [(&str, i64); 7] = [
    ("collapsed", 0x10),
    ("selectable", 0x20),
    ("selectModelBase", 0x40),
    ("dontShowAsInsideModel", 0x80),
    ("selectInvisible", 0x400),
    ("depthInvisible", 0x800),
    ("ignoreViewFitting", 0x4000),
];
/// Property of an object that vision sensors see it, by its layer.
pub const VISIBLE: &str = "visible";

/// Properties of the scene.
pub const OF_SCENE: &[Property] = &[
    of("gravity", ("getArrayParam", &[0]), Some(("setArrayParam", &[0], &[]))),
    of("simulationTime", ("getSimulationTime", &[]), None),
    of("simulationState", ("getSimulationState", &[]), None),
    of("timeStep", ("getFloatParam", &[1]), Some(("setFloatParam", &[1], &[]))),
    of("dynamicsStepSize", ("getFloatParam", &[5]), None),
];
