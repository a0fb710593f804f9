//! Functions of V-REP and CoppeliaSim that are not here: why, and what to do instead. They are not listed to clients.

/// Functions that are not offered: their names, and the reason that callers are given.
const ABSENT: &[(&[&str], &str)] = &[
    (
        &["createForceSensor", "createJoint", "createPath", "createScript", "addScript", "createTexture"],
        "joints, bodies that move and sensors of forces are made in the scene file; at run time there are points, shapes, proximity and vision sensors",
    ),
    (
        &["saveModel", "removeModel", "loadUI", "saveUI"],
        "a scene is compiled as a whole: put the model into the scene file and load the scene",
    ),
    (
        &["saveScene"],
        "clients write no scenes: what they change is in run.json (`changes`); edit scene.toml, or `save as scene` in `sincro view`",
    ),
    (&["setStringParam"], "texts of the simulator tell what it is: they are set by no client"),
    (
        &["getObjectStringParam", "setObjectStringParam"],
        "objects have no texts: use readCustomDataBlock and writeCustomDataBlock, or parameters of scripts",
    ),
    (&["setModelProperty", "setObjectSpecialProperty"], "what an object takes part in belongs to the scene"),
    (
        &["getObjectColor", "getShapeColor"],
        "what a body looks like stands in the scene file: scripts and clients are not told",
    ),
    (
        &["getEngineFloatParam", "getEngineInt32Param", "getEngineBoolParam"],
        "the parameters of Bullet, ODE, Vortex and Newton are not those of this program: its materials are in the scene",
    ),
    (&["broadcastMsg"], "scripts tell each other by signals and sim.callScriptFunction"),
    (&["registerScriptFuncHook"], "functions of scripts are called by their names only: wrap them in the script"),
    (&["breakForceSensor"], "what a force sensor carries stays on it: a scene keeps its joints during a run"),
    (
        &[
            "handleDistance",
            "readDistance",
            "getDistanceHandle",
            "handleCollision",
            "readCollision",
            "getCollisionHandle",
        ],
        "there are no distance and collision objects: checkDistance and checkCollision tell of any two bodies or collections",
    ),
    (
        &["moveToJointPositions", "moveToPosition"],
        "say how fast: sim.moveToConfig and sim.moveToPose take limits of velocity, acceleration and jerk",
    ),
    (
        &["moveToObject", "followPath"],
        "there are no path objects: sim.moveToPose goes to a pose, sim.getPathInterpolatedConfig gives points of a list",
    ),
    (
        &["generateTimeOptimalTrajectory"],
        "paths are not timed here: sim.moveToConfig goes from point to point in the least time",
    ),
    (
        &["setIkGroupProperties", "setIkElementProperties", "getConfigForTipPose"],
        "groups of inverse kinematics are made by `simIK`, with simIK.setGroupCalculation and simIK.setElementWeights",
    ),
    (
        &["launchExecutable", "loadModule", "loadPlugin", "unloadModule"],
        "programs and plug-ins are not started by clients and scripts",
    ),
    (
        &["handleJointMotion"],
        "targets of joints that go within limits (sim.setJointTargetPosition with them) go on by themselves, at every step",
    ),
    (&["setSphericalJointMatrix"], "a ball joint is moved by forces and by its initial state, not put somewhere"),
    (
        &[
            "handleDynamics",
            "handleMainScript",
            "handleChildScripts",
            "handleSimulationScripts",
            "handleSensingStart",
            "handleCustomizationScripts",
            "handleAddOnScripts",
        ],
        "there is no main script to be written: every step is made in the order of docs/lua.md",
    ),
];

/// Reason why a function, by its present name, is not offered; none if the name is unknown.
#[must_use]
pub fn why_absent(name: &str) -> Option<&'static str> {
    ABSENT.iter().find(|(names, _)| names.contains(&name)).map(|(_, why)| *why)
}

/// Names of all functions of V-REP and CoppeliaSim that are absent here, each with a reason in [`why_absent`].
pub fn absent() -> impl Iterator<Item = &'static str> {
    ABSENT.iter().flat_map(|(names, _)| names.iter().copied())
}
