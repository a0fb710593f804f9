-- scene: arm, object: /base, duration: 1, parameters: fakeShadow = "true"
-- The calls of V-REP's own models: parameters of scripts for the whole tree, views, drawing objects, a dialog, size factors.
if (sim_call_type==sim_childscriptcall_initialization) then
    v=simGetInt32Parameter(sim_intparam_program_version)
    if (v<20413) then
        simDisplayDialog('Warning','An older version',sim_dlgstyle_ok,false,'',nil,{0.8,0,0,0,0,0})
    end
    fakeShadow=simGetScriptSimulationParameter(sim_handle_self,'fakeShadow')
    simSetScriptSimulationParameter(sim_handle_tree,'fakeShadow',tostring(fakeShadow))
    if (fakeShadow) then
        shadow=simAddDrawingObject(sim_drawing_discpoints+sim_drawing_cyclic+sim_drawing_itemsizes,0.2,0,-1,1)
    end
    view=simFloatingViewAdd(0.9,0.9,0.2,0.2,0)
    simAdjustView(view,simGetObjectHandle('eye'),64)
    heli=simGetObjectAssociatedWithScript(sim_handle_self)
    script=simGetScriptHandle('base')
    calls=0
end
if (sim_call_type==sim_childscriptcall_actuation) then
    calls=calls+1
    s=simGetObjectSizeFactor(heli)
    pos=simGetObjectPosition(heli,-1)
    simAddDrawingObjectItem(shadow,{pos[1],pos[2],0.002,0,0,1,0.2*s})
end
if (sim_call_type==sim_childscriptcall_cleanup) then
    simRemoveDrawingObject(shadow)
    simFloatingViewRemove(view)
    if (calls==20 and fakeShadow==true and script~=-1) then print('passed') end
end
