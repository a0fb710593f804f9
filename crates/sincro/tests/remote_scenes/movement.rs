//! `movement`: three clients move three arms at once, as CoppeliaSim's example `simpleMovement.py` does; the bits are
//! those of the scripts of `movement-lua`.

use sincro_coppelia::api::Value;

use super::{finished, in_process, serve};
use sincro_testing::clients::zmq::{Client as Zmq, map};

/// 15 s.
const STEPS: i64 = 1_500;
const DEG: f64 = std::f64::consts::PI / 180.0;

fn joints(client: &mut Zmq, robot: &str) -> Value {
    let path = Value::from(format!("/{robot}/joint"));
    let joint = |k: i64| {
        let options = map(&[("index", Value::Int(k))]);
        client.call("sim.getObject", &[path.clone(), options]).unwrap().remove(0)
    };
    Value::List((0..7).map(joint).collect())
}

fn configurations(mut client: Zmq, robot: &str, [acceleration, jerk]: [f64; 2]) {
    let joints = joints(&mut client, robot);
    for goal in [[90.0, 90.0, 170.0, -90.0, 90.0, 90.0, 0.0], [-90.0, 90.0, 180.0, -90.0, 90.0, 90.0, 0.0], [0.0; 7]] {
        let given = map(&[
            ("joints", joints.clone()),
            ("targetPos", Value::reals(goal.map(|x| x * DEG))),
            ("maxVel", Value::reals([110.0 * DEG; 7])),
            ("maxAccel", Value::reals([acceleration * DEG; 7])),
            ("maxJerk", Value::reals([jerk * DEG; 7])),
        ]);
        client.call("sim.moveToConfig", &[given]).unwrap();
    }
    client.call("sim.setStepping", &[Value::Bool(false)]).unwrap();
}

fn poses(mut client: Zmq) {
    let target = client.object("/greenRobot/target");
    let start = client.call("sim.getObjectPose", std::slice::from_ref(&target)).unwrap().remove(0);
    let numbers = start.as_reals().unwrap();
    let mut up = numbers.clone();
    up[2] += 0.2;
    let turn = [
        start.clone(),
        Value::reals([1.0, 0.0, 0.0]),
        Value::reals(numbers[..3].to_vec()),
        Value::Real(std::f64::consts::PI / 2.0),
    ];
    let turned = client.call("sim.rotateAroundAxis", &turn).unwrap().remove(0);
    for goal in [Value::reals(up), start.clone(), turned, start] {
        let given = map(&[
            ("object", target.clone()),
            ("targetPose", goal),
            ("maxVel", Value::reals([0.5; 4])),
            ("maxAccel", Value::reals([0.1, 0.1, 0.1, 1.0])),
            ("maxJerk", Value::reals([3.0; 4])),
        ]);
        client.call("sim.moveToPose", &[given]).unwrap();
    }
    client.call("sim.setStepping", &[Value::Bool(false)]).unwrap();
}

#[test]
fn three_clients_move_three_arms_with_the_bits_of_scripts() {
    let server = serve("movement");
    let zmq = server.ports().zmq.unwrap();
    let mut first = Zmq::connect(zmq, Some("first"));
    let [blue, red, green] = ["blue", "red", "green"].map(|robot| {
        let mut client = Zmq::connect(zmq, Some(robot));
        client.call("sim.setStepping", &[Value::Bool(true)]).unwrap();
        client
    });
    first.call("sim.setStepping", &[Value::Bool(true)]).unwrap();
    first.call("sim.startSimulation", &[]).unwrap();
    std::thread::scope(|scope| {
        scope.spawn(|| configurations(blue, "blueRobot", [40.0, 80.0]));
        scope.spawn(|| configurations(red, "redRobot", [100.0, 200.0]));
        scope.spawn(|| poses(green));
        // so that the run is as long as the other
        first.call("sim.step", &[Value::Int(STEPS)]).unwrap();
    });
    first.call("sim.stopSimulation", &[]).unwrap();
    assert_eq!(finished(&server), (in_process("movement-lua"), STEPS as u64));
}
