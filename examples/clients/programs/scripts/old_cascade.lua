-- scene: rover, object: /rover/chassis, duration: 3
-- A script of V-REP 3 gives the scripts of its wheels, which it adds itself, the speed as an argument.
if (sim_call_type==sim_childscriptcall_initialization) then
    simSetScriptAttribute(sim_handle_self,sim_childscriptattribute_automaticcascadingcalls,false)
    text=[[
    local speed,share=...
    if (sim_call_type==sim_childscriptcall_initialization) then
        motor=simGetObjectAssociatedWithScript(sim_handle_self)
    end
    if (sim_call_type==sim_childscriptcall_actuation) then
        simSetJointTargetVelocity(motor,speed*share.all)
    end]]
    for i,name in ipairs({'leftMotor','rightMotor'}) do
        local script=simAddScript(sim_scripttype_childscript)
        simAssociateScriptWithObject(script,simGetObjectHandle(name))
        simSetScriptText(script,text)
    end
    own=simGetObjectAssociatedWithScript(sim_handle_self)
    start=simGetObjectPosition(own,-1)
    called=0
end
if (sim_call_type==sim_childscriptcall_actuation) then
    called=simHandleChildScripts(sim_call_type,4,{all=0.5})
end
if (sim_call_type==sim_childscriptcall_sensing) then
    simHandleChildScripts(sim_call_type,0,{all=0})
end
if (sim_call_type==sim_childscriptcall_cleanup) then
    local now=simGetObjectPosition(own,-1)
    local left=simGetJointTargetVelocity(simGetObjectHandle('leftMotor'))
    if (called==2 and math.abs(left-2)<1e-12 and now[1]-start[1]>0.1) then print('passed') end
end
