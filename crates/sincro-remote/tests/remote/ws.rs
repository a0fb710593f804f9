//! The WebSocket remote API.

use std::io::Read;

use super::scene::serve;
use super::ws_client::Client;

#[test]
fn a_browser_steps_the_simulation_in_json_and_cbor() {
    let server = serve("ws");
    let mut client = Client::connect(server.ports().ws.unwrap());
    let mut call = |text: &str| {
        client.send(1, text.as_bytes());
        let (code, body) = client.receive();
        assert_eq!(code, 1);
        String::from_utf8(body).unwrap()
    };
    assert_eq!(call(r#"{"func":"setStepping","args":[true],"id":7}"#), r#"{"id":7,"ret":[],"success":true}"#);
    call(r#"{"func":"sim.startSimulation"}"#);
    call(r#"{"func":"step"}"#);
    assert_eq!(call(r#"{"func":"sim.getSimulationTime","args":[]}"#), r#"{"ret":[0.05],"success":true}"#);
    assert!(call(r#"{"func":"sim.getObject","args":["/x"]}"#).contains(r#""success":false"#));
    assert!(call(r#"{"func":3}"#).contains("the request has no `func`"));
    assert!(call(r"{").contains("no JSON"));
    assert!(call(r#"{"func":"wsRemoteApi.info","args":["simOMPL"]}"#).contains("no module"));
    client.send(2, b"\xa1\x64func\x78\x19sim.getSimulationTimeStep");
    let (code, body) = client.receive();
    assert_eq!((code, body[0] >> 5), (2, 5), "CBOR is answered in CBOR");
    client.send(9, b"ping");
    assert_eq!(client.receive(), (10, b"ping".to_vec()));
    client.send(8, &[3, 0xe8]);
    assert_eq!(client.receive().0, 8);
    let mut byte = [0];
    assert_eq!(client.stream.read(&mut byte).unwrap(), 0);
}
