//! Functions that are offered with less than V-REP and CoppeliaSim have: what is missing. For `docs/compatibility.md`.

/// Names, and what of them is not offered.
const PARTLY: &[(&[&str], &str)] = &[
    (&["setObjectParent"], "frames, cameras and runtime objects; bodies and joints hang as the scene file says"),
    (
        &[
            "setObjectPosition",
            "setObjectOrientation",
            "setObjectQuaternion",
            "setObjectPose",
            "setObjectMatrix",
            "setObjectChildPose",
        ],
        "frames, cameras, runtime objects and what a free joint carries; recorded signals of a frame stay those of the scene",
    ),
    (&["removeObject", "removeObjects", "copyPasteObjects"], "runtime objects only"),
    (&["setObjectAlias", "setObjectName"], "runtime objects only"),
    (
        &["createPrimitiveShape", "createPureShape", "createMeshShape", "createShape", "createHeightfieldShape"],
        "static, without contact",
    ),
    (&["importShape", "importMesh", "loadModel"], "STL and OBJ files of the scene's folder"),
    (&["scaleObject", "scaleObjects", "groupShapes", "ungroupShape"], "runtime shapes only"),
    (&["loadScene"], "scene folders of this program, beside the one that is served"),
    (&["getObjectSizeFactor"], "always 1: objects are not scaled"),
    (
        &["getObjectProperty", "setObjectProperty", "getObjectSpecialProperty", "getModelProperty"],
        "taken, and always 0",
    ),
    (&["getObjectSel", "setObjectSel"], "nothing is ever selected"),
    (&["getExtensionString"], "always empty"),
    (&["getSimulatorMessage"], "there are none: −1"),
    (&["setJointInterval", "setJointDependency"], "of joints that have limits or a coupling in the scene"),
    (&["getIsRealTimeSimulation"], "always 0: real time is a flag of the server"),
    (
        &["setBoolParam", "setInt32Param"],
        "settings of windows are taken without effect; parts of the step cannot be switched off",
    ),
    (&["tubeRead"], "never waits"),
    (&["getPathInterpolatedConfig"], "linear interpolation"),
    (&["saveImage"], "gives PNG bytes, writes no file"),
    (&["resetDynamicObject"], "taken: there is nothing to reset"),
    (
        &["getProperty", "setProperty", "getPropertyName", "getFloatProperty", "getIntProperty", "getVector3Property"],
        "the properties that correspond to functions, customData, signal",
    ),
    (
        &["simIK.findConfig", "simIK.findConfigs"],
        "seconds stand for a number of attempts; validation functions in Lua only",
    ),
    (&["simIK.generatePath"], "validation functions in Lua only"),
    (&["simIK.setGroupFlags"], "bits 1 to 8; limits of joints always hold"),
    (
        &[
            "simIK.createDummy",
            "simIK.setObjectPose",
            "simIK.setObjectMatrix",
            "simIK.setObjectParent",
            "simIK.eraseObject",
        ],
        "objects are those of the scene; an environment has positions of joints of its own",
    ),
    (&["simIK.setJointMode"], "passive and ik"),
];

/// Missing part of a function that is offered partly, by its present name; `simIK.…` with its module.
#[must_use]
pub fn missing_part(name: &str) -> Option<&'static str> {
    let display = super::is_display_only(name).then_some("taken without effect: nothing is drawn");
    PARTLY.iter().find(|(names, _)| names.contains(&name)).map(|(_, what)| *what).or(display)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_offered_partly_is_offered() {
        let absent: Vec<_> =
            PARTLY.iter().flat_map(|(names, _)| *names).filter(|name| super::super::function(name).is_none()).collect();
        assert_eq!(absent, Vec::<&&str>::new());
    }
}
