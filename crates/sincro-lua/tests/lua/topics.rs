//! `simROS`, `simROS2` and `simB0`: topics between the scripts of a scene.

use sincro_sim::results::Status;

use super::world::{EXPERIMENT, PENDULUM, open, run, said, stop};

/// Messages of two scripts, on the arm of the pendulum and on its hinge.
fn said_by_two(arm: &str, hinge: &str) -> Vec<String> {
    let scripts =
        "[[script]]\nobject = \"/hinge/arm\"\nfile = \"a.lua\"\n[[script]]\nobject = \"/hinge\"\nfile = \"b.lua\"\n";
    let scene = format!("{PENDULUM}\n{scripts}");
    let files = [("scene.toml", &*scene), ("experiment.toml", EXPERIMENT), ("a.lua", arm), ("b.lua", hinge)];
    let run = run(&open(&files).unwrap_or_else(|problems| panic!("{problems}")));
    assert_eq!(run.status, Status::Completed, "{:?}", run.messages);
    run.messages.into_iter().map(|m| m.text).collect()
}

#[test]
fn a_message_is_a_table_of_another_script_before_its_next_actuation() {
    let sender = "function sysCall_init() n = 0 speed = simROS.advertise('/speed', 'geometry_msgs/Twist') end
        function sysCall_sensing()
            n = n + 1
            simROS.publish(speed, { linear = { x = n, y = 0.5 }, name = 'arm', list = { 1, 2 } })
        end";
    let receiver =
        "function told(m) print(#order, m.linear.x, m.linear.y, m.name, m.list[2]) order[#order + 1] = 'told' end
        function sysCall_init() order = {} simROS.subscribe('speed', 'geometry_msgs/Twist', 'told') end
        function sysCall_actuation() order[#order + 1] = 'actuation' end";
    let told = said_by_two(sender, receiver);
    assert!(told[0].contains("there is no ROS"), "{told:?}");
    let told: Vec<&str> = told.iter().filter(|line| line.contains("arm")).map(|line| &**line).collect();
    // one actuation before the first message, then told and actuation in turn
    assert_eq!(told[..2], ["1\t1\t0.5\tarm\t2", "3\t2\t0.5\tarm\t2"]);
}

#[test]
fn ros_2_and_the_names_of_v_rep_3_are_the_same_topics() {
    let sender = "function sysCall_init() a = simROS2.createPublisher('/x', 'std_msgs/msg/Float32') end
        function sysCall_sensing() simROS2.publish(a, { data = 2.5 }) end
        function sysCall_cleanup() simROS2.shutdownPublisher(a) print(pcall(simROS2.publish, a, {})) end";
    let receiver = "function sysCall_init()
            s = simExtRosInterface_subscribe('/x', 'std_msgs/Float32', 'heard')
            simExtRosInterface_subscriberTreatUInt8ArrayAsString(s)
        end
        function heard(message) heard_data = message.data end
        function sysCall_cleanup() print(heard_data) simROS.shutdownSubscriber(s) print(pcall(simROS.shutdownSubscriber, s)) end";
    let told = said_by_two(sender, receiver);
    assert!(told.contains(&"2.5".to_owned()), "{told:?}");
    assert!(told.iter().any(|line| line.contains("there is no publisher 1")), "{told:?}");
    assert!(told.iter().any(|line| line.contains("there is no publisher or subscriber")), "{told:?}");
}

#[test]
fn what_a_topic_does_not_do_is_refused() {
    let (reason, _) = stop("function sysCall_init() simROS.advertiseService('/s', 'std_srvs/Empty', 'f') end");
    assert!(reason.contains("simROS.advertiseService is not offered: there is no ROS"), "{reason}");
    let (reason, _) = stop("function sysCall_init() require('simROS').subscribe(3, 'x', 'f') end");
    assert!(reason.contains("is no name of a topic"), "{reason}");
    let (reason, _) = stop(
        "function sysCall_init() p = simROS.advertise('x', 'y') simROS.subscribe('x', 'y', 'nobody') end
        function sysCall_sensing() simROS.publish(p, {}) end",
    );
    assert!(reason.contains("there is no function `nobody`"), "{reason}");
}

#[test]
fn times_and_pictures_are_messages_as_ros_has_them() {
    let code = "function sysCall_init()
            eye = simROS.imageTransportAdvertise('/eye')
            simROS.imageTransportSubscribe('/eye', function(m) print(m.width, m.height, m.step, #m.data, m.encoding) end)
            simROS.subscribe('/tf', 'tf2_msgs/TFMessage', function(m) print(m.transforms[1].child_frame_id) end)
        end
        function sysCall_sensing()
            if done then return end
            done = true
            simROS.imageTransportPublish(eye, ('abc'):rep(4), 2, 2, 'eye')
            simROS.sendTransform { child_frame_id = 'arm' }
            print(simROS.getTime() >= 0, simROS2.getTime().sec)
        end";
    let told = said(code);
    assert_eq!(told[1..], ["true\t0", "2\t2\t6\t12\trgb8", "arm"], "{told:?}");
}

#[test]
fn messages_of_a_node_wait_until_it_spins() {
    let sender = "function sysCall_init()
            node = simB0.create('sender')
            topic = simB0.createPublisher(node, 'speed')
            simB0.init(node)
        end
        function sysCall_sensing() simB0.publish(topic, 'fast') end
        function sysCall_cleanup() simB0.cleanup(node) simB0.destroyPublisher(topic) simB0.destroy(node) end";
    let receiver = "function heard(message) print(spins, message) end
        function sysCall_init()
            spins = 0
            node = simB0.nodeCreate('receiver')
            simB0.subscriberCreate(node, 'speed', 'heard')
            print(simB0.pingResolver(), require('simB0') == simB0)
        end
        function sysCall_sensing()
            n = (n or 0) + 1
            if n == 4 then
                spins = 1
                simB0.nodeSpinOnce(node)
                spins = 2
            end
        end";
    let told = said_by_two(sender, receiver);
    let heard = told.iter().filter(|line| line.contains("fast")).collect::<Vec<_>>();
    assert!(heard.len() >= 3 && heard.iter().all(|line| *line == "1\tfast"), "{told:?}");
    assert!(told.contains(&"true\ttrue".to_owned()), "{told:?}");
}
