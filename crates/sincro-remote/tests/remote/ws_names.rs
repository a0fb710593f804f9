//! WebSocket: every name with arguments right and wrong, in JSON and in CBOR; and whatever else arrives.

use std::io::Read;
use std::time::Duration;

use proptest::prelude::*;
use proptest::strategy::ValueTree;
use sincro_coppelia::api::Value;

use super::arguments::{ELSEWHERE, Made, NEEDS_MORE, Things, arguments_for, fitting};
use super::scene::serve;
use sincro_testing::clients::ws::{Client, frame};
use sincro_testing::clients::zmq::field;

/// Objects that are created for each name.
fn made(client: &mut Client) -> Made {
    Made::new(|name, arguments| {
        let told = client.cbor(name, arguments);
        let Some(Value::List(ret)) = field(&told, "ret") else { panic!("{told:?}") };
        ret[0].clone()
    })
}

#[test]
fn every_name_answers_any_arguments_in_json_and_cbor() {
    let server = serve();
    let mut client = Client::connect(server.ports().ws.unwrap());
    let told = client.cbor("wsRemoteApi.info", &[Value::from("sim")]);
    let Some(Value::List(info)) = field(&told, "ret") else { panic!("{told:?}") };
    let Value::Map(members) = &info[0] else { panic!("{info:?}") };
    let names: Vec<String> =
        members.iter().filter(|(_, m)| field(m, "func").is_some()).map(|(name, _)| name.clone()).collect();
    let in_json = client.json("wsRemoteApi.info", &[Value::from("sim")]);
    assert_eq!(in_json["ret"][0].as_object().unwrap().len(), members.len());
    let handle = |client: &mut Client, path: &str| {
        let told = client.cbor("sim.getObject", &[Value::from(path)]);
        let Some(Value::List(ret)) = field(&told, "ret") else { panic!("{told:?}") };
        ret[0].clone()
    };
    let [joint, body, eye] = ["/joint1", "/ball", "/eye"].map(|path| handle(&mut client, path));
    let mut things = Things { joint, body, eye, made: made(&mut client) };
    client.json("setStepping", &[Value::Bool(true)]);
    client.json("sim.startSimulation", &[]);
    let (mut n_results, mut n_reasons, mut refused) = (0, 0, Vec::new());
    for name in names.iter().filter(|name| !ELSEWHERE.contains(&&***name) && **name != "testCB") {
        let mut fits = false;
        things.made = made(&mut client);
        let fitting = fitting(name, &things);
        for (k, args) in arguments_for(name, &things.joint, &things.body).into_iter().chain(fitting).enumerate() {
            let whole = format!("sim.{name}");
            // CBOR has all values; the same in JSON, where it has them
            let answer = client.cbor(&whole, &args);
            let reason = field(&answer, "error").and_then(Value::as_text).map(str::to_owned);
            let is_done = field(&answer, "success") == Some(&Value::Bool(true));
            assert_eq!(
                is_done,
                reason.is_none() && matches!(field(&answer, "ret"), Some(Value::List(_))),
                "{answer:?}"
            );
            fits |= is_done;
            if let Some(reason) = reason {
                assert!(reason.len() > 10 && !reason.contains('\n'), "{name}: {reason}");
                n_reasons += 1;
            } else {
                n_results += 1;
            }
            if k % 3 == 0 {
                let answer = client.json(&whole, &args);
                let is_done = answer["success"].as_bool().unwrap_or_else(|| panic!("{name}: {answer}"));
                let reason = answer["error"].as_str().unwrap_or_default();
                assert!(if is_done { answer["ret"].is_array() } else { reason.len() > 10 }, "{name}: {answer}");
            }
        }
        if !fits {
            refused.push(name.as_str());
        }
        for object in things.made.objects() {
            client.cbor("sim.removeObject", &[object]);
        }
        client.cbor("sim.ruckigRemove", &[things.made.motion()]);
    }
    assert!(n_results > 300 && n_reasons > 1000, "{n_results} results, {n_reasons} reasons");
    // called twice, what makes something fits what takes it more often
    refused.retain(|name| !NEEDS_MORE.contains(name));
    assert_eq!(refused, Vec::<&str>::new());
    for name in sincro_coppelia::api::functions::absent() {
        let answer = client.json(&format!("sim.{name}"), &[]);
        let why = answer["error"].as_str().unwrap_or_default();
        assert!(why.starts_with(&format!("sim.{name} is not offered: ")), "{answer}");
    }
    assert_eq!(client.json("sim.getSimulationTime", &[])["success"], true);
}

#[test]
fn frames_of_any_bytes_end_their_connection_at_most() {
    let server = serve();
    let address = server.ports().ws.unwrap();
    let mut good = Client::connect(address);
    good.json("setStepping", &[Value::Bool(true)]);
    good.json("sim.startSimulation", &[]);
    let mut runner = proptest::test_runner::TestRunner::deterministic();
    let bytes = prop::collection::vec(any::<u8>(), 0..400);
    for k in 0..160_u32 {
        let body = bytes.new_tree(&mut runner).unwrap().current();
        let first = any::<u8>().new_tree(&mut runner).unwrap().current();
        let thrown = match k % 4 {
            // bytes without any frame, bytes in a frame of any kind, a message in pieces, a request that is nearly
            // right
            0 => body,
            1 => frame(first, &body),
            2 => [frame(first & 0x0f, &body), frame(0x80, &body), frame(first & 0x8f, &[])].concat(),
            _ => {
                let mut text = br#"{"func":"sim.getObject","args":["/ball",{"index":0}],"id":1}"#.to_vec();
                let at = body.len() % text.len();
                text[at] = first;
                frame(0x81, &text)
            }
        };
        let mut bad = Client::connect(address);
        bad.throw(&thrown);
        let stream = bad.stream();
        let _ = stream.shutdown(std::net::Shutdown::Write);
        stream.set_read_timeout(Some(Duration::from_secs(5))).unwrap();
        let mut all = Vec::new();
        let _ = stream.take(1 << 20).read_to_end(&mut all);
    }
    good.json("step", &[]);
    assert_eq!(good.json("sim.getSimulationTime", &[])["ret"][0], 0.05);
}

#[test]
fn lengths_that_are_made_up_end_the_connection() {
    let server = serve();
    let address = server.ports().ws.unwrap();
    let long = |n: u64| [&[0x82, 0xff][..], &n.to_be_bytes(), &[0; 4]].concat();
    // a frame of nearly 2⁶⁴ bytes, one just above the limit, pieces that are too long together, one that is not masked
    let mut pieces = [&[0x02, 0xff][..], &(15_u64 << 20).to_be_bytes(), &[0; 4]].concat();
    pieces.extend(vec![0; 15 << 20]);
    pieces.extend([&[0x80, 0xff][..], &(2_u64 << 20).to_be_bytes(), &[0; 4]].concat());
    pieces.extend(vec![0; 2 << 20]);
    for thrown in [long(u64::MAX), long((16 << 20) + 1), pieces, vec![0x81, 1, b'x']] {
        let mut client = Client::connect(address);
        client.throw(&thrown);
        // at most a frame that says goodbye, then the end
        let mut all = Vec::new();
        let ended = client.stream().read_to_end(&mut all);
        assert!(ended.as_ref().err().is_none_or(|e| e.kind() == std::io::ErrorKind::ConnectionReset), "{ended:?}");
        assert!(all.len() < 200 && all.first().is_none_or(|first| *first == 0x88), "{ended:?} {all:?}");
    }
    let mut client = Client::connect(address);
    // lists inside each other, and a list of 2⁶⁴ values
    for body in [vec![0x81; 5000], vec![0x9b, 0xff, 0xff, 0xff, 0xff, 0xff, 0xff, 0xff, 0xff]] {
        client.send_bytes(&body);
        client.bytes();
    }
    for text in ["[".repeat(100_000), format!("{{\"func\":{}", "[".repeat(100_000))] {
        client.send_text(&text);
        assert!(client.text().contains("no JSON"));
    }
    assert_eq!(client.json("sim.getSimulationState", &[])["ret"][0], 0);
}
