-- scene: arm, object: /base, duration: 0.3
-- A configuration that reaches a target and a straight way to it, by a group of inverse kinematics with a name.
if (sim_call_type==sim_childscriptcall_initialization) then
    env=simIK.createEnvironment()
    group=simIK.createGroup(env,'reach')
    tip=simGetObjectHandle('tip')
    target=simCreateDummy(0.01)
    local place=simGetObjectPosition(tip,-1)
    simSetObjectPosition(target,-1,{place[1]-0.1,place[2]+0.1,place[3]})
    simIK.addElementFromScene(env,group,simGetObjectHandle('base'),tip,target,simIK.constraint_position)
    handle=simGetIkGroupHandle('reach')
    joints={}
    for k=1,3,1 do joints[k]=simGetObjectHandle('joint'..k) end
    arm=simCreateCollection('fore',0)
    simAddObjectToCollection(arm,simGetObjectHandle('fore'),sim_handle_single,0)
    box=simCreatePureShape(0,16,{0.1,0.1,0.1},0,nil)
    simSetObjectPosition(box,-1,{5,5,5})
    free=simGetConfigForTipPose(handle,joints,0.65,100,{1,1,1,0.1},{arm,box},{0,0,0},{-3,-1.5,-2.5},{6,4,5})
    way=simGenerateIkPath(handle,joints,20,{arm,box})
    -- the box stands where the arm is to go
    local goal=simGetObjectPosition(target,-1)
    simSetObjectPosition(box,-1,goal)
    blocked=simGetConfigForTipPose(handle,joints,0.65,100,{1,1,1,0.1},{arm,box})
    no_way=simGenerateIkPath(handle,joints,20,{arm,box})
    simRemoveObject(box)
end
if (sim_call_type==sim_childscriptcall_cleanup) then
    ok=free and (#free==3) and way and (#way==60) and (blocked==nil) and (no_way==nil)
    ok=ok and (math.abs(way[1]-simGetJointPosition(joints[1]))<0.1)
    if (ok) then print('passed') end
end
