-- scene: arm, object: /base, duration: 4, threaded: true
-- A threaded child script: it waits, switches, sets joints one after the other.
simSetThreadSwitchTiming(2)
joint=simGetObjectHandle('joint1')
start=simGetSimulationTime()
simWait(0.5)
if (math.abs(simGetSimulationTime()-start-0.5)<0.06) then
    simSetJointTargetPosition(joint,0.7)
    while (math.abs(simGetJointPosition(joint)-0.7)>0.01) do
        simSwitchThread()
    end
    simSetIntegerSignal('arrived',1)
    simWaitForSignal('arrived')
    print('passed')
end
