-- scene: arm, object: /base, duration: 5
-- A thread as CoppeliaSim 4.1 converted them: a coroutine that the script resumes itself; it polls time and positions without a yield.
function sysCall_init()
    joint=sim.getObjectHandle('joint1')
    corout=coroutine.create(coroutineMain)
end

function sysCall_actuation()
    if coroutine.status(corout)~='dead' then
        local ok,errorMsg=coroutine.resume(corout)
        if errorMsg then
            error(debug.traceback(corout,errorMsg),2)
        end
    end
end

function coroutineMain()
    local reached=0
    for _,angle in ipairs{0.6,-0.4} do
        sim.setJointTargetPosition(joint,angle)
        local start=sim.getSimulationTime()
        while math.abs(sim.getJointPosition(joint)-angle)>0.01 and sim.getSimulationTime()<start+2 do end
        if sim.getSimulationTime()<start+2 then reached=reached+1 end
    end
    if reached==2 and sim.getSimulationTime()>0.2 then print('passed') end
end
