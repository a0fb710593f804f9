//! Proximity sensors, distances and collections through both protocols, in the scene `stop-at-wall`; its law by a
//! legacy client gives the bits of its diagram.

use std::path::PathBuf;

use sincro_coppelia::api::Value;
use sincro_coppelia::session::Session;
use sincro_remote::Server;
use sincro_sim::Extensions;
use sincro_sim::load;

use super::scene::{finished, options};
use sincro_testing::clients::legacy::{Client as Legacy, Reply, floats, ints, text};
use sincro_testing::clients::zmq::Client as Zmq;
use sincro_testing::{repository_scene, run};

fn folder() -> PathBuf {
    repository_scene("stop-at-wall")
}

fn serve() -> Server {
    let session = Session::open(&folder(), &[], Extensions::default(), None).unwrap_or_else(|p| panic!("{p}"));
    Server::start(session, &options()).unwrap()
}

/// State, point, object and normal: not aligned.
fn reading(reply: &Reply) -> (u8, [f32; 3], i32, [f32; 3]) {
    assert_eq!(reply.data.len(), 29);
    let float = |at: usize| f32::from_le_bytes(reply.data[at..at + 4].try_into().unwrap());
    let three = |at: usize| [float(at), float(at + 4), float(at + 8)];
    (reply.data[0], three(1), reply.int(13), three(17))
}

#[test]
fn the_cart_stops_before_the_wall_through_the_legacy_door_with_the_same_bits() {
    let loaded = load(&folder(), &[], Extensions::default()).unwrap_or_else(|p| panic!("{p}"));
    let by_diagram = run(&loaded).trace;
    let server = serve();
    for _ in 0..2 {
        let mut client = Legacy::connect(server.ports().legacy[0]);
        let (rail, nose, wall) = (client.handle("rail"), client.handle("nose"), client.handle("wall"));
        client.start();
        for k in 0..160 {
            let (state, point, object, normal) = reading(&client.call(0x1009, &ints(&[nose]), &[]).unwrap());
            assert_eq!(state == 1, k > 11, "the wall is in reach from 0.6 s on: {k}");
            if state == 1 {
                assert_eq!((object, normal[2]), (wall, -1.0));
            }
            let d = if state == 1 { f64::from(point[2]) } else { 1.5 };
            let speed = ((2.03 * (d - 0.3)).clamp(0.0, 0.5) * 1024.0).round() / 1024.0;
            client.set_velocity(rail, speed as f32);
            client.trigger().unwrap();
        }
        client.simulation(2);
        assert_eq!(finished(&server).simulated.trace, by_diagram);
    }
}

#[test]
fn distances_collections_and_readings_are_told_to_legacy_clients() {
    let server = serve();
    let mut client = Legacy::connect(server.ports().legacy[0]);
    let mut other = Zmq::connect(server.ports().zmq.unwrap(), Some("other"));
    let (cart, wall, post, watch) =
        (client.handle("cart"), client.handle("wall"), client.handle("post"), client.handle("watch"));
    let distance = client.call(0x2010, &ints(&[cart, wall]), &[]).unwrap();
    assert!((distance.float(0) - 1.8).abs() < 1e-6);
    assert_eq!(client.call(0x200f, &ints(&[cart, -2]), &[]).unwrap().int(0), 0);
    // a collection that a script or another client has made
    let made = other.call("simCreateCollection", &[Value::from("obstacles"), Value::Int(0)]).unwrap().remove(0);
    for object in [wall, post] {
        let item = [made.clone(), Value::Int(-8), Value::Int(object.into()), Value::Int(0)];
        other.call("sim.addItemToCollection", &item).unwrap();
    }
    let obstacles = client.call(0x3019, &text("obstacles"), &[]).unwrap().int(0);
    assert_eq!(Value::Int(obstacles.into()), made);
    let distance = client.call(0x2010, &ints(&[obstacles, cart]), &[]).unwrap().float(0);
    // from the edge of the cart to the post
    assert!((distance - (1.0_f32.hypot(0.1) - 0.05)).abs() < 1e-6, "{distance}");
    let group = client.call(0x200c, &ints(&[obstacles, 0]), &[]).unwrap();
    assert_eq!((group.int(0), group.int(12)), (2, 2));
    client.start();
    client.trigger().unwrap();
    // all proximity sensors: two ints, six floats each
    let group = client.call(0x200c, &ints(&[5, 13]), &[]).unwrap();
    assert_eq!([0, 4, 8, 12].map(|at| group.int(at)), [3, 6, 18, 0]);
    let k = (0..3).find(|k| group.int(16 + 4 * k) == watch).unwrap();
    assert_eq!((group.int(28 + 8 * k), group.int(32 + 8 * k)), (1, post));
    let seen = other.call("sim.readProximitySensor", &[Value::Int(watch.into())]).unwrap();
    assert_eq!((&seen[0], &seen[3]), (&Value::Int(1), &Value::Int(post.into())));
    assert!(client.call(0x1009, &ints(&[cart]), &[]).is_err());
    assert!(client.last_errors()[0].contains("`/rail/cart` is no proximity sensor"));
    assert!(client.call(0x1027, &ints(&[0]), &floats(&[])).is_err());
    assert!(client.last_errors()[0].contains("sim.createDistanceObject"));
    // the cart and the post as a distance and a collision object
    let [cart, post] = [cart, post].map(|handle| Value::Int(handle.into()));
    for maker in ["sim.createDistanceObject", "sim.createCollisionObject"] {
        other.call(maker, &[Value::from("gap"), cart.clone(), post.clone()]).unwrap();
    }
    let expected = other.call("sim.checkDistance", &[cart, post]).unwrap().remove(1).as_reals().unwrap()[6];
    let gap = client.call(0x300b, &text("gap#"), &[]).unwrap().int(0);
    assert_eq!(client.call(0x1027, &ints(&[gap]), &[]).unwrap().float(0), expected as f32);
    let touch = client.call(0x300a, &text("gap"), &[]).unwrap().int(0);
    assert_eq!((touch == gap, client.call(0x1026, &ints(&[touch]), &[]).unwrap().int(0)), (false, 0));
    assert!(client.call(0x1026, &ints(&[gap]), &[]).is_err(), "one of the other kind");
}
