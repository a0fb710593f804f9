//! Names and call tips of the functions of [`widgets`](crate::widgets).

/// Gives names and call tips, one after the other, to a macro, as literals: functions of `simUI`.
#[macro_export]
macro_rules! for_ui_functions {
    ($table:ident) => {
        $table! {
            "create" "string handle=simUI.create(string xml)"
            "destroy" "simUI.destroy(string handle)"
            "isVisible" "bool visible=simUI.isVisible(string handle)"
            "getTitle" "string title=simUI.getTitle(string handle)"
            "setTitle" "simUI.setTitle(string handle,string title)"
            "getPosition" "int x,int y=simUI.getPosition(string handle)"
            "getSize" "int width,int height=simUI.getSize(string handle)"
        }
    };
}

/// Gives names and call tips, one after the other, to a macro, as literals: those of values of widgets.
#[macro_export]
macro_rules! for_ui_values {
    ($table:ident) => {
        $table! {
            "setEditValue" "simUI.setEditValue(string handle,int id,string value)"
            "getEditValue" "string value=simUI.getEditValue(string handle,int id)"
            "setLabelText" "simUI.setLabelText(string handle,int id,string value)"
            "getLabelText" "string value=simUI.getLabelText(string handle,int id)"
            "setButtonText" "simUI.setButtonText(string handle,int id,string value)"
            "getButtonText" "string value=simUI.getButtonText(string handle,int id)"
            "setText" "simUI.setText(string handle,int id,string value)"
            "getText" "string value=simUI.getText(string handle,int id)"
            "setSliderValue" "simUI.setSliderValue(string handle,int id,int value)"
            "getSliderValue" "int value=simUI.getSliderValue(string handle,int id)"
            "setCheckboxValue" "simUI.setCheckboxValue(string handle,int id,int value)"
            "getCheckboxValue" "int value=simUI.getCheckboxValue(string handle,int id)"
            "setRadiobuttonValue" "simUI.setRadiobuttonValue(string handle,int id,int value)"
            "getRadiobuttonValue" "int value=simUI.getRadiobuttonValue(string handle,int id)"
            "setComboboxSelectedIndex" "simUI.setComboboxSelectedIndex(string handle,int id,int value)"
            "getComboboxSelectedIndex" "int value=simUI.getComboboxSelectedIndex(string handle,int id)"
            "setSpinboxValue" "simUI.setSpinboxValue(string handle,int id,float value)"
            "getSpinboxValue" "float value=simUI.getSpinboxValue(string handle,int id)"
            "setProgress" "simUI.setProgress(string handle,int id,int value)"
            "getProgress" "int value=simUI.getProgress(string handle,int id)"
        }
    };
}

/// Gives names and call tips, one after the other, to a macro, as literals: those that only show something.
#[macro_export]
macro_rules! for_ui_shown {
    ($table:ident) => {
        $table! {
            "show" "simUI.show(string handle)"
            "hide" "simUI.hide(string handle)"
            "setPosition" "simUI.setPosition(string handle,int x,int y)"
            "setSize" "simUI.setSize(string handle,int width,int height)"
            "setEnabled" "simUI.setEnabled(string handle,int id,bool enabled)"
            "setWidgetVisibility" "simUI.setWidgetVisibility(string handle,int id,bool visible)"
            "setStyleSheet" "simUI.setStyleSheet(string handle,int id,string css)"
            "setCurrentTab" "simUI.setCurrentTab(string handle,int id,int index)"
            "setImageData" "simUI.setImageData(string handle,int id,buffer data,int width,int height)"
            "setComboboxItems" "simUI.setComboboxItems(string handle,int id,string[] items,int index)"
            "insertComboboxItem" "simUI.insertComboboxItem(string handle,int id,int index,string text)"
            "appendText" "simUI.appendText(string handle,int id,string text)"
            "addCurve" "simUI.addCurve(string handle,int id,int type,string name,int[] color,int style,map options)"
            "addCurveTimePoints" "simUI.addCurveTimePoints(string handle,int id,string name,float[] x,float[] y)"
            "addCurveXYPoints" "simUI.addCurveXYPoints(string handle,int id,string name,float[] sequence,float[] x,float[] y)"
            "clearCurve" "simUI.clearCurve(string handle,int id,string name)"
            "removeCurve" "simUI.removeCurve(string handle,int id,string name)"
            "rescaleAxes" "simUI.rescaleAxes(string handle,int id,string name)"
            "rescaleAxesAll" "simUI.rescaleAxesAll(string handle,int id)"
            "replot" "simUI.replot(string handle,int id)"
            "setMouseOptions" "simUI.setMouseOptions(string handle,int id,bool panX,bool panY,bool zoomX,bool zoomY)"
            "setLegendVisibility" "simUI.setLegendVisibility(string handle,int id,bool visible)"
            "setRowCount" "simUI.setRowCount(string handle,int id,int count)"
            "setColumnCount" "simUI.setColumnCount(string handle,int id,int count)"
            "setItem" "simUI.setItem(string handle,int id,int row,int column,string text)"
        }
    };
}

/// Gives names and call tips, one after the other, to a macro, as literals: those on windows of V-REP 3.
#[macro_export]
macro_rules! for_windows {
    ($table:ident) => {
        $table! {
            "getUIHandle" "int uiHandle=sim.getUIHandle(string uiName)"
            "getUIEventButton" "int buttonHandle,int[2] auxiliaryValues=sim.getUIEventButton(int uiHandle)"
            "setUIButtonLabel" "int result=sim.setUIButtonLabel(int uiHandle,int buttonHandle,string upStateLabel,string downStateLabel=nil)"
            "getUIButtonLabel" "string label=sim.getUIButtonLabel(int uiHandle,int buttonHandle)"
            "setUIButtonProperty" "int result=sim.setUIButtonProperty(int uiHandle,int buttonHandle,int buttonProperty)"
            "getUIButtonProperty" "int buttonProperty=sim.getUIButtonProperty(int uiHandle,int buttonHandle)"
            "setUISlider" "int result=sim.setUISlider(int uiHandle,int buttonHandle,int position)"
            "getUISlider" "int position=sim.getUISlider(int uiHandle,int buttonHandle)"
            "createUI" "int uiHandle=sim.createUI(string uiName,int menuAttributes,int[2] clientSize,int[2] cellSize)"
            "createUIButton" "int buttonHandle=sim.createUIButton(int uiHandle,int[2] position,int[2] size,int buttonProperty)"
            "removeUI" "int result=sim.removeUI(int uiHandle)"
            "setUIProperty" "int result=sim.setUIProperty(int uiHandle,int elementProperty)"
            "getUIProperty" "int elementProperty=sim.getUIProperty(int uiHandle)"
            "setUIButtonArrayColor" "int result=sim.setUIButtonArrayColor(int uiHandle,int buttonHandle,int[2] position,float[3] color)"
            "createUIButtonArray" "int result=sim.createUIButtonArray(int uiHandle,int buttonHandle)"
            "deleteUIButtonArray" "int result=sim.deleteUIButtonArray(int uiHandle,int buttonHandle)"
            "setUIButtonColor" "int result=sim.setUIButtonColor(int uiHandle,int buttonHandle,float[3] upStateColor,float[3] downStateColor=nil,float[3] labelColor=nil)"
            "setUIPosition" "int result=sim.setUIPosition(int uiHandle,int[2] position)"
        }
    };
}
