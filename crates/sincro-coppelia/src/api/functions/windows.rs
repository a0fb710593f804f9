//! Functions: what a window would show. It is taken, and nothing is done: scripts and clients that open views and
//! consoles run here as they are.

use super::{Function, Outcome, one};
use crate::api::{Arguments, SimApi, Value};

/// Gives a handle of something that is not there, or says that it went well.
fn taken(_: &mut SimApi<'_>, _: Arguments<'_>) -> Outcome {
    one(1_i64)
}

/// A function of which nothing is seen.
const fn shown(name: &'static str, tip: &'static str) -> Function {
    Function { name, tip, run: taken }
}

pub(super) const FUNCTIONS: &[Function] = &[
    shown(
        "adjustView",
        "int result=sim.adjustView(int viewHandleOrIndex,int associatedViewableObjectHandle,int options,string viewLabel=nil)",
    ),
    shown(
        "floatingViewAdd",
        "int floatingViewHandle=sim.floatingViewAdd(float posX,float posY,float sizeX,float sizeY,int options)",
    ),
    shown("floatingViewRemove", "int result=sim.floatingViewRemove(int floatingViewHandle)"),
    shown(
        "cameraFitToView",
        "int result=sim.cameraFitToView(int viewHandleOrIndex,int[] objectHandles=nil,int options=0,float scaling=1)",
    ),
    shown("auxiliaryConsoleOpen", "int consoleHandle=sim.auxiliaryConsoleOpen(string title,int maxLines,int mode)"),
    shown("auxiliaryConsolePrint", "int result=sim.auxiliaryConsolePrint(int consoleHandle,string text)"),
    shown("auxiliaryConsoleShow", "int result=sim.auxiliaryConsoleShow(int consoleHandle,bool showState)"),
    shown("auxiliaryConsoleClose", "int result=sim.auxiliaryConsoleClose(int consoleHandle)"),
    shown(
        "displayDialog",
        "int dlgHandle=sim.displayDialog(string title,string mainTxt,int style,bool modal,string initTxt)",
    ),
    shown("setNavigationMode", "int result=sim.setNavigationMode(int navigationMode)"),
    shown("setPage", "int result=sim.setPage(int pageIndex)"),
    shown("refreshDialogs", "int result=sim.refreshDialogs(int refreshDegree)"),
    shown("announceSceneContentChange", "int result=sim.announceSceneContentChange()"),
    Function {
        name: "fileDialog",
        tip: "string pathAndName=sim.fileDialog(int mode,string title,string startPath,string initName,string extName,string ext)",
        run: |_, _| one(Value::Nil),
    },
    shown("endDialog", "int result=sim.endDialog(int dialogHandle)"),
    shown(
        "addBanner",
        "int bannerID=sim.addBanner(string label,float size,int options,float[6] positionAndEulerAngles=nil,int parentObjectHandle=nil)",
    ),
    shown("removeBanner", "int result=sim.removeBanner(int bannerID)"),
    shown(
        "setLightParameters",
        "int result=sim.setLightParameters(int lightHandle,int state,float[3] ambientPart=nil,float[3] diffusePart=nil,float[3] specularPart=nil)",
    ),
];

/// Returns true if the function with a present name, without `sim.`, only affects what windows show (views, consoles,
/// banners): it takes any arguments and does nothing.
#[must_use]
pub fn is_display_only(name: &str) -> bool {
    FUNCTIONS.iter().any(|f| f.name == name)
}
