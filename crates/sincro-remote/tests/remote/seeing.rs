//! Pictures over the wires: the same bytes by every protocol, whole and in pieces, in the step that they belong to.

use sincro_coppelia::api::{Search, Value};

use super::scene::{serve, session};
use sincro_testing::clients::legacy::{Client, Command, ONCE, SPLIT, STREAM, ints};
use sincro_testing::clients::zmq::Client as Zmq;

/// Image of the scene's vision sensor after `steps` steps.
fn expected(steps: usize) -> Vec<u8> {
    let mut session = session();
    let eye = session.sim().registry.find("/eye", Search::default()).unwrap();
    session.start().unwrap();
    for _ in 0..steps {
        session.step().unwrap();
    }
    session.sim().vision_image(eye).unwrap().rgb().to_vec()
}

#[test]
fn pictures_are_those_after_the_step_by_every_door() {
    let server = serve();
    let expected = expected(3);
    let mut zmq = Zmq::connect(server.ports().zmq.unwrap(), Some("eye"));
    let eye = zmq.object("/eye");
    zmq.call("sim.setStepping", &[Value::Bool(true)]).unwrap();
    zmq.call("sim.startSimulation", &[]).unwrap();
    for _ in 0..3 {
        zmq.call("sim.step", &[]).unwrap();
    }
    let image = zmq.call("sim.getVisionSensorImg", std::slice::from_ref(&eye)).unwrap();
    assert_eq!(image[0], Value::Bytes(expected.clone()));
    assert_eq!(image[1], Value::List(vec![Value::Int(16), Value::Int(12)]));
    let mut legacy = Client::connect(server.ports().legacy[0]);
    let handle = ints(&[eye.as_int().unwrap() as i32]);
    let rgb = legacy.call(0x1004, &handle, &[]).unwrap();
    assert_eq!((rgb.int(0), rgb.int(4), &rgb.data[8..]), (16, 12, &expected[..]));
    let grey = legacy.call(0x1003, &handle, &[]).unwrap();
    let mean = |p: &[u8]| (p.iter().map(|x| u32::from(*x)).sum::<u32>() / 3) as u8;
    assert!(grey.data[8..].iter().copied().eq(expected.chunks(3).map(mean)));
    let depth = legacy.call(0x1017, &handle, &[]).unwrap();
    let depths: Vec<f32> = (2..2 + 16 * 12).map(|k| depth.float(k)).collect();
    assert!(depths.iter().all(|d| (0.0..=1.0).contains(d)) && depths.contains(&1.0));
    assert!(depths.iter().any(|d| (*d - 0.35).abs() < 0.02), "the ball is 1.9 m away");
    // state, one packet of 15 numbers, not aligned
    let read = legacy.call(0x1011, &handle, &[]).unwrap();
    let at = |k: usize| i32::from_le_bytes(read.data[k..k + 4].try_into().unwrap());
    assert_eq!((read.data.len(), read.data[0], at(1), at(5)), (1 + 8 + 60, 0, 1, 15));
    let least_depth = f32::from_le_bytes(read.data[9 + 16..9 + 20].try_into().unwrap());
    assert_eq!(least_depth, depths.iter().copied().fold(1.0, f32::min));
    zmq.call("sim.stopSimulation", &[]).unwrap();
}

#[test]
fn a_picture_in_pieces_is_the_whole_one() {
    let server = serve();
    let mut client = Client::connect(server.ports().legacy[0]);
    let handle = ints(&[client.handle("eye")]);
    client.start();
    client.trigger().unwrap();
    let whole = client.call(0x1004, &handle, &[]).unwrap().data;
    let mut command = Command::new(0x1004, SPLIT, &handle, &[]);
    command.delay = 200;
    let mut gathered = Vec::new();
    let mut replies = client.exchange(&[command]);
    while gathered.len() < whole.len() {
        for (_, reply) in replies.iter().filter(|(function, _)| *function == 0x1004) {
            gathered.extend_from_slice(&reply.data);
        }
        replies = client.exchange(&[]);
    }
    assert_eq!(gathered, whole);
    // what is streamed comes with each step, newly drawn
    client.exchange(&[Command::new(0x1011, STREAM, &handle, &[])]);
    let trigger = Command::new(0x0003, ONCE, &[], &[]);
    let replies = client.exchange(&[trigger]);
    assert!(replies.iter().any(|(function, reply)| *function == 0x1011 && !reply.failed && reply.time == 100));
}

#[test]
fn a_picture_of_a_client_is_shown_and_a_wrong_one_refused() {
    let server = serve();
    let mut client = Client::connect(server.ports().legacy[0]);
    let handle = ints(&[client.handle("eye")]);
    let bytes: Vec<u8> = (0..3 * 16 * 12).map(|k| (k % 251) as u8).collect();
    client.call(0x1006, &handle, &bytes).unwrap();
    assert_eq!(client.call(0x1004, &handle, &[]).unwrap().data[8..], bytes);
    client.call(0x1005, &handle, &[77; 16 * 12]).unwrap();
    assert_eq!(client.call(0x1004, &handle, &[]).unwrap().data[8..], [77; 3 * 16 * 12]);
    assert!(client.call(0x1006, &handle, &bytes[1..]).is_err());
    let ball = ints(&[client.handle("ball")]);
    assert!(client.call(0x1004, &ball, &[]).is_err());
    let errors = client.last_errors();
    assert!(errors[0].contains("there are 575 bytes, expected 576"), "{errors:?}");
    assert!(errors[1].contains("`/loose/ball` is no vision sensor"), "{errors:?}");
}
