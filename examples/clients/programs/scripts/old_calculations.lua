-- scene: table, object: /ball/core, duration: 0.8
-- Collision and distance objects by name, a search for a configuration and a path with a group, as scripts of V-REP 3 use them.
if (sim_call_type==sim_childscriptcall_initialization) then
    ball=simGetObjectHandle('core')
    simCreateCollisionObject('Touch',ball)
    simCreateDistanceObject('Gap',ball,simGetObjectHandle('brick'))
    touch=simGetCollisionHandle('Touch')
    gap=simGetDistanceHandle('Gap#')
    before=simReadCollision(touch)
    _,first=simReadDistance(gap)
    wrong=pcall(simGetCollisionHandle,'Other')
end
if (sim_call_type==sim_childscriptcall_sensing) then
    state,pair=simHandleCollision(touch)
    -- this one and that of the scene
    count=simHandleCollision(sim_handle_all)
    result,distance=simHandleDistance(gap)
end
if (sim_call_type==sim_childscriptcall_cleanup) then
    simResetCollision(touch)
    -- 2.24 m from centre to centre at the start; the ball falls beside the brick
    ok=(before==0) and (state==1) and (pair[1]==ball) and (count==2) and (result==1)
    ok=ok and (not wrong) and (first>1.5) and (first<2.3) and (distance~=first)
    if (ok) then print('passed') end
end
