//! Whatever arrives: a reasoned refusal or a dropped connection, never a panic, never a world that has changed.

use std::io::{Read, Write};
use std::net::{Shutdown, SocketAddr, TcpStream};
use std::time::Duration;

use proptest::prelude::*;
use proptest::strategy::ValueTree;
use sincro_coppelia::api::Value;
use sincro_remote::cbor;
use sincro_remote::legacy::{message, packet};
use sincro_remote::zmq::wire;

use super::scene::{serve, session};
use sincro_testing::clients::legacy::{Client as Legacy, Command, ints};

fn values() -> impl Strategy<Value = Value> {
    let leaf = prop_oneof![
        Just(Value::Nil),
        any::<bool>().prop_map(Value::Bool),
        any::<i64>().prop_map(Value::Int),
        (-20_i64..20).prop_map(Value::Int),
        any::<f64>().prop_map(Value::Real),
        ".{0,12}".prop_map(Value::Text),
        prop::collection::vec(any::<u8>(), 0..20).prop_map(Value::Bytes),
    ];
    leaf.prop_recursive(4, 40, 8, |inner| {
        prop_oneof![
            prop::collection::vec(inner.clone(), 0..8).prop_map(Value::List),
            prop::collection::vec((".{0,5}", inner), 0..5).prop_map(Value::Map),
        ]
    })
}

/// Equal, NaN taken for itself.
fn same(a: &Value, b: &Value) -> bool {
    format!("{a:?}") == format!("{b:?}")
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 400, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn values_survive_the_wire(value in values()) {
        let mut bytes = Vec::new();
        cbor::encode(&value, &mut bytes);
        prop_assert!(same(&cbor::decode(&bytes).unwrap(), &value));
        // cut short it is no value any more
        for n in 0..bytes.len() {
            prop_assert!(cbor::decode(&bytes[..n]).is_err());
        }
    }

    #[test]
    fn any_bytes_are_read_as_cbor_or_refused(bytes in prop::collection::vec(any::<u8>(), 0..200)) {
        if let Ok(value) = cbor::decode(&bytes) {
            let mut again = Vec::new();
            cbor::encode(&value, &mut again);
            prop_assert!(same(&cbor::decode(&again).unwrap(), &value));
        }
    }

    #[test]
    fn any_bytes_are_read_as_a_message_or_refused(
        bytes in prop::collection::vec(any::<u8>(), 0..200),
        sizes in prop::collection::vec(-3_i32..60, 0..5),
    ) {
        if let Ok(commands) = message::commands(&bytes) {
            let total: usize = commands.iter().map(|c| 26 + c.ident.len() + c.data.len()).sum();
            prop_assert_eq!(total + 18, bytes.len());
        }
        // the same with commands that are nearly right
        let mut near = bytes;
        near.resize(18, 0);
        for size in sizes {
            near.extend(size.to_le_bytes());
            near.extend([0; 30]);
        }
        let _ = message::commands(&near);
        let head: [u8; 6] = near[..6].try_into().unwrap();
        if let Some((length, left)) = packet::parse_head(&head) {
            prop_assert!(length <= 32767 && left <= 32767);
        }
        let mut greeting = [0; 64];
        greeting[..18].copy_from_slice(&near[..18]);
        let _ = wire::is_greeting(&greeting);
    }

    #[test]
    fn any_function_takes_any_arguments(name in 0_usize..400, arguments in prop::collection::vec(values(), 0..5)) {
        thread_local! {
            static SESSION: std::cell::RefCell<sincro_testing::OpenSession> =
                std::cell::RefCell::new(session());
        }
        let names: Vec<&str> = sincro_coppelia::api::functions::functions().map(|f| f.name).collect();
        let name = names[name % names.len()];
        SESSION.with_borrow_mut(|session| {
            let _ = session.call(name, &arguments);
            // the first argument an object, so that more of it is reached
            let mut arguments = arguments;
            arguments.insert(0, Value::Int(1 + (name.len() % 7) as i64));
            let _ = session.call(name, &arguments);
            let finite = session.sim().world.state.q.iter().all(|x| x.is_finite());
            session.registry().take_log();
            session.take_finished();
            prop_assert!(finite, "{name} {arguments:?} left a state that is not finite");
            Ok(())
        })?;
    }
}

fn throw(address: SocketAddr, bytes: &[u8]) {
    let Ok(mut stream) = TcpStream::connect(address) else { return };
    stream.set_read_timeout(Some(Duration::from_secs(5))).unwrap();
    // it may be closed while we write
    let _ = stream.write_all(bytes);
    let _ = stream.shutdown(Shutdown::Write);
    let mut all = Vec::new();
    let _ = (&stream).take(1 << 20).read_to_end(&mut all);
}

#[test]
fn ports_survive_what_is_thrown_at_them_and_the_world_is_unharmed() {
    let server = serve();
    let ports = server.ports().clone();
    let mut good = Legacy::connect(ports.legacy[0]);
    good.start();
    let mut runner = proptest::test_runner::TestRunner::deterministic();
    let bytes = prop::collection::vec(any::<u8>(), 0..300);
    let addresses = [ports.legacy[0], ports.zmq.unwrap(), ports.zmq_steps.unwrap(), ports.ws.unwrap()];
    for k in 0..120 {
        let mut bytes = bytes.new_tree(&mut runner).unwrap().current();
        let address = addresses[k % 4];
        // half of it beyond the beginning that each protocol wants
        if k % 8 > 3 {
            let start: Vec<u8> = match k % 4 {
                0 => {
                    let mut head = vec![1, 0];
                    head.extend((bytes.len() as i16).to_le_bytes());
                    head.extend([0, 0]);
                    head
                }
                1 | 2 => [&wire::greeting()[..], &wire::ready("REQ")].concat(),
                _ => b"GET / HTTP/1.1\r\nSec-WebSocket-Key: x\r\n\r\n".to_vec(),
            };
            bytes.splice(0..0, start);
        }
        throw(address, &bytes);
    }
    assert_eq!(good.trigger().unwrap().time, 50);
    assert_eq!(good.joint_position(1), 0.0);
}

#[test]
fn messages_that_are_too_long_end_the_connection() {
    let server = serve();
    let ports = server.ports().clone();
    // packets without end
    let mut stream = TcpStream::connect(ports.legacy[0]).unwrap();
    let packet = [&[1, 0, 0xff, 0x7f, 0xff, 0x7f][..], &[0; 32767]].concat();
    let sent = (0..2000).take_while(|_| stream.write_all(&packet).is_ok()).count();
    assert!(sent < 1000, "closed after 16 MiB, not after {sent} packets of 32 KiB");
    let mut legacy = Legacy::connect(ports.legacy[0]);
    let many: Vec<Command> = (0..5000).map(|k| Command::new(0x1001, 0x2_0000, &ints(&[k]), &[])).collect();
    let mut bytes = vec![0; 18];
    many.iter().for_each(|c| bytes.extend(c.bytes()));
    legacy.send_packets(&bytes, 1294);
    let mut byte = [0];
    assert!(matches!(legacy.stream().read(&mut byte), Ok(0) | Err(_)), "too many commands end the connection");
}
