-- scene: rover, object: /rover/chassis, duration: 6
-- A rover that turns away from what its sensors see.
if (sim_call_type==sim_childscriptcall_initialization) then
    left=simGetObjectHandle('leftMotor')
    right=simGetObjectHandle('rightMotor')
    front=simGetObjectHandle('front')
    own=simGetObjectAssociatedWithScript(sim_handle_self)
    seen=0
end
if (sim_call_type==sim_childscriptcall_sensing) then
    result,distance,point,object=simReadProximitySensor(front)
    if (result>0) then seen=seen+1 end
    if (result>0 and distance<0.6) then
        simSetJointTargetVelocity(left,-2)
        simSetJointTargetVelocity(right,2)
    else
        simSetJointTargetVelocity(left,6)
        simSetJointTargetVelocity(right,6)
    end
end
if (sim_call_type==sim_childscriptcall_cleanup) then
    if (seen>3 and simGetObjectPosition(own,-1)[1]<2.7) then print('passed') end
end
