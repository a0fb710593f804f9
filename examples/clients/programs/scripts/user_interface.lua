-- scene: rover, object: /rover/chassis, duration: 0.2
-- A user interface where there are no windows: what is set is kept, nothing is pressed.
sim = require 'sim'
simUI = require 'simUI'

function speedChanged(ui, id, value)
    error('nobody can move the slider')
end

function sysCall_init()
    ui = simUI.create('<ui title="Rover" closeable="true"><label text="speed"/><hslider id="1" on-change="speedChanged"/></ui>')
    simUI.setSliderValue(ui, 1, 25)
    simUI.setLabelText(ui, 2, 'ready')
end

function sysCall_actuation()
    sim.setJointTargetVelocity(sim.getObject('./leftMotor'), simUI.getSliderValue(ui, 1) / 10)
end

function sysCall_cleanup()
    if simUI.getLabelText(ui, 2) == 'ready' and sim.getJointTargetVelocity(sim.getObject('./leftMotor')) == 2.5 then print('passed') end
    simUI.destroy(ui)
end
