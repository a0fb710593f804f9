//! Every function of V-REP's APIs that clients use is answered, or refused with its reason.

use sincro_coppelia::api::Value;

use super::scene::serve;
use sincro_testing::clients::legacy::{Client as Legacy, Command, ONCE, ints, text};
use sincro_testing::clients::zmq::{Client as Zmq, field};

/// Functions that only scripts have: of a thread, of a Lua state.
const OF_SCRIPTS: [&str; 16] = [
    "waitForSignal",
    "setThreadResumeLocation",
    "getScriptHandle",
    "getScriptAssociatedWithObject",
    "getObjectAssociatedWithScript",
    "getNameSuffix",
    "setNameSuffix",
    "getThreadId",
    "getScriptExecutionCount",
    "getScriptAttribute",
    "setScriptAttribute",
    "handleChildScripts",
    "setScriptVariable",
    "getStackTraceback",
    "invertMatrix",
    "getRandom",
];

#[test]
fn every_function_of_the_api_is_listed_or_refused_with_a_reason() {
    let server = serve();
    let mut client = Zmq::connect(server.ports().zmq.unwrap(), Some("names"));
    let info = client.call("zmqRemoteApi.info", &[Value::from("sim")]).unwrap().remove(0);
    let file = concat!(env!("CARGO_MANIFEST_DIR"), "/../../tests/third-party/data/v-rep-functions.txt");
    let file = std::fs::read_to_string(file).unwrap();
    let names = file.lines().filter(|line| !line.starts_with('#')).flat_map(str::split_whitespace);
    let mut unknown = Vec::new();
    for name in names {
        if field(&info, name).is_some() {
            continue;
        }
        let why = client.call(&format!("sim.{name}"), &[]).unwrap_err();
        if !why.starts_with(&format!("sim.{name} is not offered: ")) && !OF_SCRIPTS.contains(&name) {
            unknown.push(name);
        }
    }
    assert_eq!(unknown, Vec::<&str>::new());
}

/// Commands of the legacy API, by their numbers; the first byte tells what identifies the object.
const COMMANDS: [i32; 97] = [
    0x0001, 0x0002, 0x0003, 0x0004, 0x0005, 0x0006, 0x0009, 0x1007, 0x3002, 0x3003, 0x3004, 0x3006, 0x3008, 0x3401,
    0x3001, 0x200e, 0x200d, 0x2801, 0x1019, 0x1018, 0x1036, 0x101b, 0x101a, 0x1801, 0x1012, 0x200b, 0x101c, 0x102a,
    0x200c, 0x2007, 0x2009, 0x2008, 0x200a, 0x1034, 0x1035, 0x1028, 0x1037, 0x102e, 0x102f, 0x1001, 0x1002, 0x1008,
    0x100c, 0x100d, 0x1038, 0x100e, 0x100a, 0x100b, 0x100f, 0x1010, 0x1009, 0x1003, 0x1004, 0x1005, 0x1006, 0x1017,
    0x1011, 0x200f, 0x2010, 0x1026, 0x1027, 0x300a, 0x300b, 0x3019, 0x3010, 0x3013, 0x300d, 0x3011, 0x3014, 0x300e,
    0x3012, 0x3015, 0x300f, 0x3016, 0x3017, 0x3018, 0x1021, 0x1022, 0x1023, 0x1024, 0x101f, 0x1020, 0x101d, 0x101e,
    0x1025, 0x1014, 0x1015, 0x1016, 0x3009, 0x1029, 0x2001, 0x2006, 0x3005, 0x3007, 0x102b, 0x102d, 0x300c,
];

#[test]
fn every_command_of_the_legacy_api_is_done_or_refused_with_a_reason() {
    let server = serve();
    let mut client = Legacy::connect(server.ports().legacy[0]);
    let mut unknown = Vec::new();
    for number in COMMANDS {
        let ident = match number {
            0x0000..0x1000 => vec![],
            0x1000..0x2000 => ints(&[1]),
            0x2000..0x3000 => ints(&[1, 1]),
            0x3000..0x3400 => text("x"),
            _ => [ints(&[1]), text("x"), text("x")].concat(),
        };
        let replies = client.exchange(&[Command::new(number, ONCE, &ident, &[])]);
        assert_eq!(replies.len(), 1, "0x{number:04x}");
        if replies[0].1.failed {
            let errors = client.last_errors();
            let is_told = errors.len() == 1 && !errors[0].contains(&format!("0x{number:04x} is not offered"));
            if !is_told {
                unknown.push((format!("0x{number:04x}"), errors));
            }
        }
    }
    assert_eq!(unknown, Vec::new());
    assert_eq!(client.ping(), 40_501);
}
