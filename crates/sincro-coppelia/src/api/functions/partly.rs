//! Functions that are offered with less than V-REP and CoppeliaSim have: what is missing. For `docs/compatibility.md`.

use super::{Function, properties, ui};

/// Names, and what of them is not offered.
const PARTLY: &[(&[&str], &str)] = &[
    (&["setObjectParent"], "a body that is hung on another one is joined to it; hung on the world it is free"),
    (
        &[
            "setObjectPosition",
            "setObjectOrientation",
            "setObjectQuaternion",
            "setObjectPose",
            "setObjectMatrix",
            "setObjectChildPose",
        ],
        "of bodies that other joints than free ones carry where their joint can bring them; recorded signals of a frame stay those of the scene",
    ),
    (&["setObjectAlias", "setObjectName"], "runtime objects only"),
    (
        &["createPrimitiveShape", "createPureShape", "createMeshShape", "createShape", "createHeightfieldShape"],
        "dynamic ones have the friction of V-REP's default material; meshes touch with their convex hulls; planes and height fields are seen only",
    ),
    (
        &["addDrawingObject", "addDrawingObjectItem"],
        "shown in the viewer; all items of one colour and size, points with a normal as balls",
    ),
    (
        &["addParticleObject", "addParticleObjectItem"],
        "shown in the viewer on their way by velocity and gravity; they touch and push nothing",
    ),
    (&["importShape", "importMesh"], "STL and OBJ files of the scene's folder"),
    (
        &["loadModel"],
        "scene files of this program, the robots in `models/`, STL and OBJ files of the scene's folder; scripts of models that clients have sent are left out",
    ),
    (&["saveModel"], "scene files of this program: their text, or a file in the folder for files of clients"),
    (&["createJoint"], "moves something as soon as a body is hung on it"),
    (
        &["createForceSensor"],
        "measures as soon as a body is hung on it; its values are not filtered, it does not break",
    ),
    (&["scaleObject", "scaleObjects", "ungroupShape"], "runtime shapes only"),
    (&["groupShapes"], "runtime shapes, and bodies that were made at run time and stand still against each other"),
    (&["loadScene"], "scene folders of this program, beside the one that is served"),
    (&["getObjectSizeFactor"], "always 1: objects are not scaled"),
    (&["getObjectProperty", "setObjectProperty"], "kept and given back: there are no windows"),
    (
        &["getObjectSpecialProperty", "setObjectSpecialProperty"],
        "collidable, measurable, detectable (one bit suffices), renderable; the others are kept and given back",
    ),
    (
        &["getModelProperty", "setModelProperty"],
        "not collidable, measurable, detectable, renderable, visible hold for the whole model; not dynamic, respondable or reset and scripts inactive are refused",
    ),
    (&["getObjectSel", "setObjectSel"], "nothing shows what is selected"),
    (
        &[
            "getUIHandle",
            "getUIEventButton",
            "setUIButtonLabel",
            "getUIButtonLabel",
            "setUIButtonProperty",
            "getUIButtonProperty",
            "setUISlider",
            "getUISlider",
            "setUIButtonColor",
            "setUIProperty",
            "setUIPosition",
        ],
        "there is no window: values are kept and given back, nothing is pressed",
    ),
    (&["setPathTargetNominalVelocity"], "0: the position on a path does not move by itself"),
    (
        &["setLinkDummy"],
        "joins the bodies that carry the dummies rigidly: one of them has to be free; the free one hangs on the other then",
    ),
    (&["addScript", "createScript"], "Lua; child and customization scripts"),
    (&["getShapeViz"], "one colour for each part, no textures"),
    (&["getExtensionString"], "always empty"),
    (&["getModuleName", "getPluginName"], "RemoteApi, IK and UI, whose functions are built in; version 0"),
    (&["getSimulatorMessage"], "there are none: −1"),
    (&["setJointDependency"], "of joints that have a coupling in the scene"),
    (&["getIsRealTimeSimulation"], "always 0: real time is a flag of the server"),
    (
        &["setBoolParam", "setInt32Param"],
        "settings of windows are taken without effect; of the parts of the step dynamics and inverse kinematics can be switched off",
    ),
    (&["tubeRead"], "never waits"),
    (&["insertPathCtrlPoints"], "positions and orientations of control points, straight lines between them"),
    (&["sendData"], "antennas send in all directions"),
    (&["saveImage"], "PNG and BMP; a script's files are kept with the run, a client's need `--grant files`"),
    (&["resetDynamicObject"], "an initial velocity that was set takes effect; there is nothing else to reset"),
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

/// Names of functions that only scripts have as told here, and what of them is not offered.
const IN_SCRIPTS: &[(&[&str], &str)] = &[
    (&["acquireLock", "releaseLock"], "in scripts taken without effect: they run one after the other"),
    (
        &["setThreadResumeLocation", "setThreadSwitchTiming", "setAutoYieldDelay", "setThreadIsFree"],
        "taken without effect: a waiting script is resumed at the next step",
    ),
    (&["getScriptAttribute", "setScriptAttribute"], "executioncount and automaticcascadingcalls"),
    (
        &["handleChildScripts"],
        "for actuation and sensing; −1 and a message while automaticcascadingcalls is set: the step calls those below then",
    ),
    (&["getThreadId"], "always 0"),
    (&["getNameSuffix", "setNameSuffix"], "a script's suffix is that of its object: setting is without effect"),
    (
        &["simRemoteApi.start"],
        "up to 8 ports above 1023, opened before the next step; what the system refuses is in the log",
    ),
    (&["simRemoteApi.stop", "simRemoteApi.reset"], "always −1: a port stays open until the server ends"),
    (&["simRemoteApi.status"], "1 if the port is open, else −1; not whether a client is connected"),
];

/// Missing part of a function that is offered with less than V-REP and CoppeliaSim have, for the table of
/// `docs/compatibility.md`. `name` is the present name, those of `simIK` and `simUI` with their module; none if nothing
/// is missing.
#[must_use]
pub fn missing_part(name: &str) -> Option<&'static str> {
    let is_in = |list: &[Function], name: &str| list.iter().any(|f| f.name == name);
    let by_table = if let Some(name) = name.strip_prefix("simUI.") {
        let is_shown = is_in(ui::SHOWN, name).then_some("taken without effect: nothing is shown");
        is_shown.or_else(|| {
            let what = "there is no window: values are kept and given back, nothing is pressed or called";
            (is_in(ui::FUNCTIONS, name) || is_in(ui::KEPT, name)).then_some(what)
        })
    } else if super::is_display_only(name) {
        Some("taken without effect: nothing is drawn")
    } else {
        let is_property = is_in(properties::TYPED, name) || is_in(properties::FUNCTIONS, name);
        is_property.then_some("the properties that correspond to functions, customData, signal")
    };
    PARTLY.iter().find(|(names, _)| names.contains(&name)).map(|(_, what)| *what).or(by_table)
}

/// Missing part of a function in scripts, where clients have it whole or not at all, for `docs/compatibility.md`.
/// `name` is the present name without `sim.`; none if scripts have it as clients do.
#[must_use]
pub fn missing_in_scripts(name: &str) -> Option<&'static str> {
    IN_SCRIPTS.iter().find(|(names, _)| names.contains(&name)).map(|(_, what)| *what)
}

/// Present names of the functions for which [`missing_in_scripts`] has a text.
pub fn partly_in_scripts() -> impl Iterator<Item = &'static str> {
    IN_SCRIPTS.iter().flat_map(|(names, _)| names.iter().copied())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_parts_of_modules_and_properties_come_from_their_tables() {
        let properties = super::super::functions().map(|f| f.name).filter(|name| {
            let is_object = ["getObjectProperty", "setObjectProperty"].contains(name);
            name.ends_with("Property") && !is_object
        });
        let of_ui = super::super::ui_functions().map(|f| format!("simUI.{}", f.name));
        let whole: Vec<String> =
            properties.map(str::to_owned).chain(of_ui).filter(|name| missing_part(name).is_none()).collect();
        assert_eq!(whole, Vec::<String>::new());
    }

    #[test]
    fn what_is_offered_partly_is_offered() {
        let absent: Vec<_> =
            PARTLY.iter().flat_map(|(names, _)| *names).filter(|name| super::super::function(name).is_none()).collect();
        assert_eq!(absent, Vec::<&&str>::new());
    }
}
