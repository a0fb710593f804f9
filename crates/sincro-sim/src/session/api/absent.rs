//! Functions of V-REP and CoppeliaSim that are not here: why, and what to do instead. They are not listed to clients.

/// What a function would be about, its names, and what is told.
const ABSENT: &[(&[&str], &str)] = &[
    (
        &[
            "createPrimitiveShape",
            "createPureShape",
            "createShape",
            "createMeshShape",
            "createHeightfieldShape",
            "importShape",
            "importMesh",
            "groupShapes",
            "ungroupShape",
            "scaleObjects",
            "scaleObject",
            "createForceSensor",
            "createProximitySensor",
            "createVisionSensor",
            "createJoint",
            "createPath",
            "createScript",
            "addScript",
            "createTexture",
        ],
        "bodies, joints and sensors are made in the scene file; at run time there are points only (createDummy)",
    ),
    (
        &["loadModel", "saveModel", "removeModel", "loadUI", "saveUI"],
        "a scene is compiled as a whole: put the model into the scene file and load the scene",
    ),
    (&["saveScene"], "scenes are text: edit scene.toml, or `save as scene` in `sincro view`"),
    (
        &[
            "setShapeMass",
            "setShapeInertia",
            "setShapeMassAndInertia",
            "computeMassAndInertia",
            "setJointInterval",
            "setJointDependency",
        ],
        "masses, limits and couplings belong to the scene: change them there, or with --set when it is opened",
    ),
    (
        &[
            "readProximitySensor",
            "checkProximitySensor",
            "checkProximitySensorEx",
            "handleProximitySensor",
            "resetProximitySensor",
        ],
        "there are no proximity sensors: a sensor of kind `height` measures a distance downwards, getContactInfo tells what touches",
    ),
    (
        &[
            "readVisionSensor",
            "handleVisionSensor",
            "resetVisionSensor",
            "getVisionSensorImg",
            "setVisionSensorImg",
            "getVisionSensorDepth",
            "getVisionSensorRes",
            "getVisionSensorCharImage",
            "getVisionSensorImage",
            "getVisionSensorDepthBuffer",
        ],
        "there are no vision sensors",
    ),
    (&["breakForceSensor"], "force sensors do not break"),
    (
        &[
            "checkDistance",
            "handleDistance",
            "readDistance",
            "getDistanceHandle",
            "handleCollision",
            "readCollision",
            "getCollisionHandle",
        ],
        "distances between shapes are not computed: checkCollision and getContactInfo tell what touches",
    ),
    (
        &["createCollection", "addItemToCollection", "getCollectionObjects", "getCollectionHandle"],
        "there are no collections: use lists of handles",
    ),
    (
        &[
            "moveToConfig",
            "moveToPose",
            "ruckigPos",
            "ruckigVel",
            "ruckigStep",
            "ruckigRemove",
            "rmlPos",
            "rmlVel",
            "rmlStep",
            "rmlRemove",
            "rmlMoveToPosition",
            "rmlMoveToJointPositions",
            "moveToObject",
            "followPath",
            "generateTimeOptimalTrajectory",
        ],
        "no motion is planned here: give targets step by step, from a script, a client or a diagram",
    ),
    (
        &[
            "handleIkGroup",
            "getIkGroupHandle",
            "checkIkGroup",
            "setIkGroupProperties",
            "setIkElementProperties",
            "getConfigForTipPose",
        ],
        "the old groups of inverse kinematics are not part of scenes: use `simIK`",
    ),
    (
        &["launchExecutable", "loadModule", "loadPlugin", "unloadModule"],
        "programs and plug-ins are not started by clients and scripts",
    ),
    (&["setSphericalJointMatrix"], "a ball joint is moved by forces and by its initial state, not put somewhere"),
    (
        &[
            "handleDynamics",
            "handleMainScript",
            "handleChildScripts",
            "handleSimulationScripts",
            "handleJointMotion",
            "handleSensingStart",
            "handleCustomizationScripts",
            "handleAddOnScripts",
        ],
        "there is no main script to be written: every step is made in the order of docs/lua.md",
    ),
];

/// Why a function, by its present name, is not offered; none if nobody knows it.
#[must_use]
pub fn why_absent(name: &str) -> Option<&'static str> {
    ABSENT.iter().find(|(names, _)| names.contains(&name)).map(|(_, why)| *why)
}

/// The names of all of them.
pub fn absent() -> impl Iterator<Item = &'static str> {
    ABSENT.iter().flat_map(|(names, _)| names.iter().copied())
}
