//! What a window would show: taken, and nothing is done. Scripts that draw run here as they are.

use mlua::MultiValue;

use super::Shelf;

/// Functions that give a handle of something that is not there.
const HANDLES: [&str; 7] = [
    "auxiliaryConsoleOpen",
    "floatingViewAdd",
    "addDrawingObject",
    "displayDialog",
    "addGraphStream",
    "addParticleObject",
    "getGraphHandle",
];

/// Functions that say that it went well.
const DONE: [&str; 22] = [
    "adjustView",
    "auxiliaryConsoleClose",
    "auxiliaryConsolePrint",
    "auxiliaryConsoleShow",
    "floatingViewRemove",
    "addDrawingObjectItem",
    "removeDrawingObject",
    "endDialog",
    "setGraphStreamValue",
    "setGraphUserData",
    "resetGraph",
    "handleGraph",
    "setObjectColor",
    "setShapeColor",
    "setShapeTexture",
    "setShapeMaterial",
    "addParticleObjectItem",
    "removeParticleObject",
    "cameraFitToView",
    "setEngineFloatParam",
    "setEngineInt32Param",
    "setEngineBoolParam",
];

pub(super) fn offer(shelf: &Shelf<'_>) -> mlua::Result<()> {
    for name in HANDLES {
        shelf.add(name, |_, _: MultiValue| Ok(1))?;
    }
    for name in DONE {
        shelf.add(name, |_, _: MultiValue| Ok(1))?;
    }
    Ok(())
}
