//! The legacy remote API.

use std::f64::consts::{PI, TAU};

use std::io::{Read, Write};
use std::net::TcpListener;
use std::thread;
use std::time::{Duration, Instant};

use sincro_remote::{Options, Server};

use super::scene::{finished, options, serve, serve_with, session};
use sincro_testing::clients::legacy::{Client, Command, DISCONTINUE, ONCE, SPLIT, STREAM, floats, ints, text};

fn client(server: &Server) -> Client {
    Client::connect(server.ports().legacy[0])
}

#[test]
fn a_client_is_answered_with_the_version_and_its_own_number() {
    let server = serve();
    let mut client = client(&server);
    assert!(client.exchange(&[]).is_empty());
    assert_eq!((client.version, client.ping(), client.reply_id), (11, 40501, 1));
    assert_eq!(client.state, 0, "nothing runs");
    assert!(client.call(0x000a, &[], &ints(&[0])).is_ok());
    let mut byte = [0];
    assert_eq!(client.stream().read(&mut byte).unwrap(), 0, "simxFinish closes");
}

/// The thesis's loop: handles with `#`, blocking set, streaming get, trigger. Gives the streamed positions and the
/// times.
fn thesis_loop(client: &mut Client, steps: i32) -> Vec<(f32, i32)> {
    let joint = client.handle("joint1#");
    client.start();
    let key = ints(&[joint]);
    let first = client.exchange(&[Command::new(0x1001, STREAM, &key, &[])]);
    assert_eq!(first.len(), 1);
    let mut seen = Vec::new();
    for k in 0..steps {
        // quarters are the same number in single and in double precision
        client.set_velocity(joint, 0.25 * (k % 8) as f32 - 0.5);
        client.exchange(&[Command::new(0x1001, STREAM, &key, &[]), Command::new(0x0003, ONCE, &[], &[])]);
        let reply = &client.inbox[&(0x1001, key.clone())];
        seen.push((reply.float(0), reply.time));
    }
    client.exchange(&[Command::new(0x1001, DISCONTINUE, &key, &[])]);
    client.simulation(2);
    seen
}

#[test]
fn the_loop_of_the_thesis_sees_values_after_the_step_and_the_same_bits_twice() {
    let server = serve();
    let mut client = client(&server);
    let seen = thesis_loop(&mut client, 1000);
    let mut q = 0.0;
    for (k, (position, time)) in seen.iter().enumerate() {
        q += 0.05 * (0.25 * (k % 8) as f64 - 0.5);
        // a joint that turns without end is told within a turn, as by V-REP
        let told = q - TAU * ((q - PI) / TAU).ceil();
        assert!((f64::from(*position) - told).abs() < 1e-5, "step {k}: {position} instead of {told}");
        assert_eq!(*time, 50 * (k as i32 + 1), "k·dt");
    }
    let first = finished(&server).simulated;
    assert_eq!(first.table.n_rows(), 401, "memory is that of the experiment, however long the clients go on");
    assert_eq!(thesis_loop(&mut client, 1000), seen);
    assert_eq!(finished(&server).simulated.trace, first.trace);
    assert_eq!(client.joint_position(1), 0.0, "stopped is where it began");
}

#[test]
fn what_was_measured_on_the_original_is_measured_here() {
    let server = serve();
    let mut client = client(&server);
    let handles: Vec<i32> = ["joint1", "joint1#", "/joint1"].map(|name| client.handle(name)).to_vec();
    assert!(handles.iter().all(|h| *h == handles[0]));
    let [joint1, joint2, link2] = ["joint1", "joint2", "link2"].map(|name| client.handle(name));
    assert!(client.trigger().is_err(), "synchronous mode is off");
    client.start();
    assert_eq!(client.state & 3, 1, "a run is on");
    assert_eq!(client.joint_position(joint1), 0.0);
    assert_eq!(client.trigger().unwrap().time, 50);
    let force = |client: &mut Client, joint| client.call(0x100d, &ints(&[joint]), &[]).unwrap().float(0);
    assert!((force(&mut client, joint1) + 9.810).abs() < 1e-3);
    assert!((force(&mut client, joint2) + 2.4525).abs() < 1e-3);
    client.set_velocity(joint1, 1.0);
    client.trigger().unwrap();
    let velocity = client.call(0x1036, &ints(&[link2]), &[]).unwrap();
    assert!((velocity.float(4) + 1.0).abs() < 1e-6, "plain angular velocity of the world");
    assert_eq!(client.call(0x1012, &ints(&[joint1]), &[]).unwrap().int(0), -1, "the parent of a root object");
    assert!(client.call(0x1001, &ints(&[link2]), &[]).is_err(), "a joint getter on a body");
    assert!(client.call(0x3010, &text("unset"), &[]).is_err());
    let missing = client.call(0x3001, &text("nothing"), &[]).unwrap_err();
    assert_eq!(missing.int(0), -1);
    let errors = client.last_errors();
    assert!(errors.iter().any(|e| e.contains("`/joint1/link1/joint2/link2` is no joint")), "{errors:?}");
    assert!(client.last_errors().is_empty(), "they are told once");
}

#[test]
fn every_function_of_the_protocol_is_answered() {
    let server = serve();
    let mut client = client(&server);
    let [joint, ball] = ["joint2", "ball"].map(|name| client.handle(name));
    let at = ints(&[ball, -1]);
    client.call(0x101b, &ints(&[ball]), &[ints(&[-1]), floats(&[1.0, 2.0, 3.0])].concat()).unwrap();
    let p = client.call(0x200e, &at, &[]).unwrap();
    assert_eq!([p.float(0), p.float(1), p.float(2)], [1.0, 2.0, 3.0]);
    client.call(0x101a, &ints(&[ball]), &[ints(&[-1]), floats(&[0.1, 0.2, 0.3])].concat()).unwrap();
    let e = client.call(0x200d, &at, &[]).unwrap();
    assert!((0..3).all(|k| (e.float(k) - 0.1 * (k + 1) as f32).abs() < 1e-6));
    let q = client.call(0x2801, &at, &[]).unwrap();
    client.call(0x1801, &ints(&[ball]), &[ints(&[-1]), q.data.clone()].concat()).unwrap();
    assert!(
        (client.call(0x1018, &ints(&[ball]), &ints(&[-1])).unwrap().float(2) - 0.3).abs() < 1e-6,
        "the older getters"
    );
    // parameters
    assert_eq!(client.call(0x1023, &ints(&[1]), &[]).unwrap().float(0), 0.05);
    assert_eq!(client.call(0x101d, &ints(&[0]), &[]).unwrap().float(2), -9.81);
    assert!(client.call(0x1025, &ints(&[13]), &[]).unwrap().data.ends_with(b"scene.toml\0"));
    assert!(!client.call(0x1025, &ints(&[15]), &[]).unwrap().data.contains(&b'/'), "the scene's name");
    client.call(0x1022, &ints(&[26]), &ints(&[0])).expect("the rate of idle frames is taken");
    assert!(client.call(0x1022, &ints(&[8]), &ints(&[0])).is_err(), "there is one engine");
    assert_eq!(client.call(0x1021, &ints(&[22]), &[]).unwrap().int(0), 0, "the mouse");
    assert!(client.call(0x1021, &ints(&[9999]), &[]).is_err());
    client.call(0x1024, &ints(&[1]), &floats(&[0.1])).unwrap();
    client.start();
    assert_eq!(client.trigger().unwrap().time, 100, "the step that the client has set");
    client.call(0x1024, &ints(&[1]), &floats(&[0.05])).expect("taken in a run");
    assert_eq!(client.trigger().unwrap().time, 200, "without effect");
    // motors
    client.call(0x100e, &ints(&[joint]), &floats(&[7.5])).unwrap();
    assert_eq!(client.call(0x1038, &ints(&[joint]), &[]).unwrap().float(0), 7.5);
    client.call(0x200a, &ints(&[joint, 2001]), &ints(&[1])).unwrap();
    assert_eq!(client.call(0x2008, &ints(&[joint, 2039]), &[]).unwrap().int(0), 8, "position control");
    client.call(0x100c, &ints(&[joint]), &floats(&[0.2])).unwrap();
    (0..20).for_each(|_| drop(client.trigger().unwrap()));
    assert!((client.joint_position(joint) - 0.2).abs() < 1e-3);
    assert_eq!(client.call(0x100a, &ints(&[joint]), &[]).unwrap().data.len(), 48);
    // points, the tree, groups
    let dummy = client.call(0x0009, &[], &[&floats(&[0.01])[..], &[0; 13]].concat()).unwrap().int(0);
    client.call(0x101c, &ints(&[dummy]), &[&ints(&[ball])[..], &[1]].concat()).unwrap();
    assert_eq!(client.call(0x200b, &ints(&[ball, 0]), &[]).unwrap().int(0), dummy);
    assert_eq!(client.call(0x200b, &ints(&[ball, 1]), &[]).unwrap().int(0), -1);
    let joints = client.call(0x102a, &ints(&[1]), &[]).unwrap();
    assert_eq!((joints.int(0), joints.int(4), joints.int(8)), (2, 1, joint));
    let group = client.call(0x200c, &ints(&[1, 15]), &[]).unwrap();
    assert_eq!([0, 4, 8, 12].map(|k| group.int(k)), [2, 0, 4, 0]);
    let names = client.call(0x200c, &ints(&[109, 0]), &[]).unwrap();
    assert!(names.data.ends_with(b"eye\0Dummy\0"));
    for what in 0..=21 {
        let reply = client.call(0x200c, &ints(&[109, what]), &[]);
        assert!(reply.is_ok(), "group data {what}");
    }
    client.call(0x1028, &ints(&[dummy]), &[]).unwrap();
    assert!(client.call(0x1028, &ints(&[dummy]), &[]).is_err(), "it is gone");
    client.call(0x1028, &ints(&[ball]), &[]).unwrap();
    assert!(client.call(0x200e, &ints(&[ball, -1]), &[]).is_err(), "objects of the scene go, too");
    // what is not offered says so, and the connection goes on
    for function in [0x1029, 0x2001, 0x300c, 0x3004, 0x3003, 0x0fff, 0x3fff] {
        assert!(client.call(function, &ints(&[0, 0]), &[]).is_err(), "0x{function:04x}");
    }
    client.ping();
}

#[test]
fn signals_pass_between_clients() {
    let server = serve();
    let (mut a, mut b) = (client(&server), client(&server));
    a.call(0x3013, &text("f"), &floats(&[1.5])).unwrap();
    a.call(0x3014, &text("i"), &ints(&[-7])).unwrap();
    a.call(0x3015, &text("s"), b"a\0b").unwrap();
    assert_eq!(b.call(0x3010, &text("f"), &[]).unwrap().float(0), 1.5);
    assert_eq!(b.call(0x3011, &text("i"), &[]).unwrap().int(0), -7);
    a.call(0x3016, &text("s"), b"c").unwrap();
    assert_eq!(b.call(0x3012, &text("s"), &[]).unwrap().data, b"a\0bc");
    assert_eq!(b.call(0x3018, &text("s"), &[]).unwrap().data, b"a\0bc", "a stream is read and empty");
    assert_eq!(b.call(0x3018, &text("s"), &[]).unwrap().data, b"");
    assert!(b.call(0x3017, &text("s"), &[]).is_err());
    b.call(0x300e, &text(""), &[]).unwrap();
    assert!(a.call(0x3011, &text("i"), &[]).is_err(), "no name clears all");
    a.call(0x300d, &text("f"), &[]).unwrap();
    assert!(a.call(0x3010, &text("f"), &[]).is_err());
}

#[test]
fn a_stored_request_for_a_string_ends_with_its_delivery() {
    let server = serve();
    let (mut a, mut b) = (client(&server), client(&server));
    let key = text("s");
    assert!(a.exchange(&[Command::new(0x3017, STREAM, &key, &[])])[0].1.failed);
    b.call(0x3015, &key, b"x").unwrap();
    assert_eq!(a.exchange(&[])[0].1.data, b"x");
    assert!(a.exchange(&[]).is_empty());
}

#[test]
fn a_blocking_call_does_not_end_a_stream_of_the_same() {
    let server = serve();
    let mut client = client(&server);
    let key = ints(&[1]);
    assert_eq!(client.exchange(&[Command::new(0x1001, STREAM, &key, &[])]).len(), 1);
    client.call(0x1001, &key, &[]).unwrap();
    assert_eq!(client.exchange(&[]).len(), 1, "it is still streamed");
    // asking again replaces
    client.exchange(&[Command::new(0x1001, STREAM, &key, &[]), Command::new(0x1001, STREAM, &key, &[])]);
    assert_eq!(client.exchange(&[]).len(), 1);
    let late = Command { delay: 60_000, ..Command::new(0x1001, STREAM, &key, &[]) };
    client.exchange(&[late]);
    assert!(client.exchange(&[]).is_empty(), "not before its time");
    client.start();
    assert_eq!(client.exchange(&[Command::new(0x0003, ONCE, &[], &[])]).len(), 2, "but with a step");
    client.exchange(&[Command::new(0x1001, DISCONTINUE, &key, &[])]);
    assert!(client.exchange(&[]).is_empty());
}

#[test]
fn large_messages_travel_in_packets_and_large_data_in_pieces() {
    let server = serve();
    let mut client = client(&server);
    let big: Vec<u8> = (0..200_000_u32).map(|k| ((k * 7919) >> 3) as u8).collect();
    client.call(0x3015, &text("big"), &big).unwrap();
    assert_eq!(client.call(0x3012, &text("big"), &[]).unwrap().data, big);
    assert_eq!(client.packets, (200_000 + 26 + 4 + 18_usize).div_ceil(1294));
    // in pieces there, in pieces back
    let (ident, piece) = (text("parts"), 70_000);
    let full = (26 + ident.len() + big.len()) as i32;
    for (k, part) in big.chunks(piece).enumerate() {
        let command = Command::new(0x3015, SPLIT, &ident, part);
        let replies = client.exchange(&[Command {
            delay: 70_000_u32 as u16,
            piece: Some((full, (k * piece) as i32)),
            ..command
        }]);
        assert_eq!(replies.len(), usize::from(k == 2), "answered when complete");
    }
    let ask = Command { delay: 50_000, ..Command::new(0x3012, SPLIT, &ident, &[]) };
    let (mut got, mut message) = (Vec::<u8>::new(), vec![ask]);
    while got.len() < big.len() {
        let replies = client.exchange(&message);
        let reply = &replies[0].1;
        assert_eq!((reply.full_size as usize, reply.offset as usize), (26 + ident.len() + big.len(), got.len()));
        got.extend(&reply.data);
        message.clear();
    }
    assert_eq!(got, big);
    assert!(client.exchange(&[]).is_empty());
}

#[test]
fn time_advances_when_all_synchronous_clients_have_triggered() {
    let server = serve();
    let (mut a, mut b) = (client(&server), client(&server));
    a.call(0x0001, &[], &[]).unwrap();
    b.start();
    let other = thread::spawn(move || {
        let reply = a.trigger().unwrap();
        (a, reply.time)
    });
    thread::sleep(Duration::from_millis(100));
    assert_eq!(b.ping(), 40501, "others are served while one waits");
    assert!(!other.is_finished(), "one alone steps nothing");
    assert_eq!(b.trigger().unwrap().time, 50);
    let (a, time) = other.join().unwrap();
    assert_eq!(time, 50);
    drop(a);
    let start = Instant::now();
    assert_eq!(b.trigger().unwrap().time, 100, "one that has gone holds nobody");
    assert!(start.elapsed() < Duration::from_secs(60));
}

#[test]
fn a_client_that_is_silent_for_too_long_is_let_go() {
    let options = Options { client_timeout: Duration::from_millis(300), ..options() };
    let server = serve_with(&options);
    let (mut a, mut b) = (client(&server), client(&server));
    a.call(0x0001, &[], &[]).unwrap();
    b.start();
    let start = Instant::now();
    assert_eq!(b.trigger().unwrap().time, 50);
    assert!((250..60_000).contains(&start.elapsed().as_millis()), "after its time: {:?}", start.elapsed());
    let mut told = server.events().try_iter().filter_map(|e| match e {
        sincro_remote::hub::Event::Log(300, text) => Some(text),
        _ => None,
    });
    assert!(told.next().unwrap().contains("has held the simulation without a word for 0.3 s"));
    assert_eq!(a.ping(), 40501, "its connection stays");
}

#[test]
fn without_synchronous_clients_it_runs_by_itself_pauses_and_stops() {
    let server = serve();
    let mut client = client(&server);
    client.simulation(0);
    let time = |client: &mut Client| client.call(0x1021, &ints(&[1]), &[]).unwrap().time;
    let start = Instant::now();
    while time(&mut client) < 1000 {
        assert!(start.elapsed() < Duration::from_secs(20), "it does not move");
    }
    client.simulation(1);
    let paused = time(&mut client);
    thread::sleep(Duration::from_millis(50));
    assert_eq!((time(&mut client), client.state & 2), (paused, 2));
    client.simulation(2);
    assert_eq!((time(&mut client), client.state), (0, 0));
    for _ in 0..3 {
        client.simulation(0);
        client.simulation(2);
        assert_eq!(client.joint_position(1), 0.0);
    }
}

#[test]
fn a_port_in_use_is_named_with_its_flag() {
    let taken = TcpListener::bind("127.0.0.1:0").unwrap();
    let port = taken.local_addr().unwrap().port();
    let error = session().try_serve(&Options { legacy: vec![port], ..options() }).err().unwrap().to_string();
    assert!(
        error.contains(&format!("port {port} is in use on 127.0.0.1")) && error.contains("--legacy-port"),
        "{error}"
    );
}

#[test]
fn a_port_can_be_had_again_at_once() {
    let server = serve();
    let port = server.ports().legacy[0].port();
    let mut client = client(&server);
    client.ping();
    drop(server);
    drop(client);
    drop(session().serve(&Options { legacy: vec![port], ..options() }));
}

#[test]
fn what_is_no_message_ends_its_connection_alone() {
    let server = serve();
    let mut good = client(&server);
    good.start();
    for bytes in [&b"GET / HTTP/1.1\r\n\r\n"[..], &[1, 0, 4, 0, 0, 0, 9, 9, 9, 9], &[1, 0, 0xff, 0xff, 0, 0]] {
        let mut bad = client(&server);
        bad.stream().write_all(bytes).unwrap();
        let mut byte = [0];
        assert!(matches!(bad.stream().read(&mut byte), Ok(0) | Err(_)));
    }
    assert_eq!(good.trigger().unwrap().time, 50);
}
