//! The WebSocket remote API.

use tungstenite::{Bytes, Message};

use super::scene::serve;
use sincro_testing::clients::ws::Client;

#[test]
fn a_browser_steps_the_simulation_in_json_and_cbor() {
    let server = serve();
    let mut client = Client::connect(server.ports().ws.unwrap());
    let mut call = |text: &str| {
        client.send_text(text);
        client.text()
    };
    assert_eq!(call(r#"{"func":"setStepping","args":[true],"id":7}"#), r#"{"id":7,"ret":[],"success":true}"#);
    call(r#"{"func":"sim.startSimulation"}"#);
    call(r#"{"func":"step"}"#);
    assert_eq!(call(r#"{"func":"sim.getSimulationTime","args":[]}"#), r#"{"ret":[0.05],"success":true}"#);
    assert!(call(r#"{"func":"sim.getObject","args":["/x"]}"#).contains(r#""success":false"#));
    assert!(call(r#"{"func":3}"#).contains("the request has no `func`"));
    assert!(call(r"{").contains("no JSON"));
    assert!(call(r#"{"func":"wsRemoteApi.info","args":["simConvex"]}"#).contains("no module"));
    client.send_bytes(b"\xa1\x64func\x78\x19sim.getSimulationTimeStep");
    assert_eq!(client.bytes()[0] >> 5, 5, "CBOR is answered in CBOR");
    client.send_bytes(br#"{"func":"sim.getSimulationTime"}"#);
    assert_eq!(client.bytes(), br#"{"ret":[0.05],"success":true}"#, "JSON in bytes is answered in bytes");
    client.socket.send(Message::Ping(Bytes::from_static(b"ping"))).unwrap();
    assert_eq!(client.socket.read().unwrap(), Message::Pong(Bytes::from_static(b"ping")));
    client.socket.close(None).unwrap();
    assert!(client.socket.read().unwrap().is_close());
    assert!(matches!(client.socket.read(), Err(tungstenite::Error::ConnectionClosed)));
}
