-- scene: rover, object: /rover, duration: 1.5
-- Drives a rover by messages of topics, as robots under ROS are: velocities come by one topic, distances go by another.
sim = require 'sim'
simROS2 = require 'simROS2'

function drive(message)
    forwards = message.linear.x
    n_messages = n_messages + 1
end

function look(message)
    if message.range > 0 then seen = message.range end
end

function sysCall_init()
    forwards, n_messages, begun = 0, 0, sim.getObjectPosition(sim.getObject('.'), -1)
    commands = simROS2.createPublisher('/cmd_vel', 'geometry_msgs/msg/Twist')
    ranges = simROS2.createPublisher('/range', 'sensor_msgs/msg/Range')
    simROS2.createSubscription('/cmd_vel', 'geometry_msgs/msg/Twist', 'drive')
    simROS2.createSubscription('/range', 'sensor_msgs/msg/Range', 'look')
    motors = { sim.getObject('./leftMotor'), sim.getObject('./rightMotor') }
end

function sysCall_actuation()
    simROS2.publish(commands, { linear = { x = 0.2, y = 0, z = 0 }, angular = { x = 0, y = 0, z = 0 } })
    for _, motor in ipairs(motors) do sim.setJointTargetVelocity(motor, forwards / 0.1) end
end

function sysCall_sensing()
    simROS2.publish(ranges, { header = { stamp = simROS2.getTime() }, range = sim.getSimulationTime() + 0.1 })
    -- what has been published is taken now
    local before = seen
    simROS2.spinSome()
    if seen == before then seen = -1 end
end

function sysCall_cleanup()
    simROS2.shutdownPublisher(commands)
    simROS2.shutdownPublisher(ranges)
    if n_messages > 20 and forwards == 0.2 and seen and seen > 1 then print('passed') end
end
