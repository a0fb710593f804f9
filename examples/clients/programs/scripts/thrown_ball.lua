-- scene: table, object: /floor, duration: 1
-- Throws a ball again and again: its place, an initial velocity, a reset of its dynamics.
function sysCall_init()
    ball=sim.getObjectHandle('core')
    throws,good=0,0
end

function throw(speed)
    sim.setObjectPosition(ball,-1,{0,0,1})
    sim.setObjectFloatParam(ball,sim.shapefloatparam_init_velocity_x,speed)
    sim.setObjectFloatParam(ball,sim.shapefloatparam_init_velocity_z,2)
    sim.resetDynamicObject(ball)
end

function sysCall_actuation()
    local t=sim.getSimulationTime()
    if t>=0.3*throws+0.05 and throws<3 then
        throws=throws+1
        throw(throws)
        thrown,start=t,sim.getObjectPosition(ball,-1)
    elseif thrown and t>thrown+0.095 then
        local place=sim.getObjectPosition(ball,-1)
        if math.abs(place[1]-start[1]-throws*(t-thrown))<1e-6 then good=good+1 end
        thrown=nil
    end
end

function sysCall_cleanup()
    if throws==3 and good==3 then print('passed') end
end
