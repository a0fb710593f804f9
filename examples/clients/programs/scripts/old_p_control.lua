-- scene: table, object: /rail/cart, duration: 3
-- Old style (V-REP up to 3.4): the whole text is run at every call; a pole is balanced by forces.
if (sim_call_type==sim_childscriptcall_initialization) then
    rail=simGetObjectHandle('rail')
    hinge=simGetObjectHandle('hinge')
    simSetObjectIntParameter(rail,sim_jointintparam_motor_enabled,1)
end
if (sim_call_type==sim_childscriptcall_actuation) then
    x=simGetJointPosition(rail)
    q=simGetJointPosition(hinge)
    _,v=simGetObjectFloatParameter(rail,sim_jointfloatparam_velocity)
    _,w=simGetObjectFloatParameter(hinge,sim_jointfloatparam_velocity)
    u=1*x+2.1*v+30*q+6*w
    if (u<0) then simSetJointTargetVelocity(rail,-1000) else simSetJointTargetVelocity(rail,1000) end
    simSetJointForce(rail,math.abs(u))
end
if (sim_call_type==sim_childscriptcall_cleanup) then
    if (math.abs(simGetJointPosition(hinge))<0.05) then print('passed') end
end
