//! Storage by name of clients and scripts: limits of names, values of widgets in several runs, signals that a refused
//! property leaves, data blocks and `customData` under one tag.

use sincro_coppelia::api::Value;
use sincro_sim::Extensions;
use sincro_testing::{OpenSession, scenes};

const SCENE: i64 = -12;

fn scene() -> OpenSession {
    scenes::two_link_arm("").session(Extensions::default(), Some(0.05))
}

fn call(session: &mut OpenSession, name: &str, arguments: &[Value]) -> Vec<Value> {
    session.call(name, arguments).unwrap_or_else(|error| panic!("{name}: {error:?}"))
}

fn refused(session: &mut OpenSession, name: &str, arguments: &[Value]) -> String {
    session.call(name, arguments).expect_err(name).0
}

fn table() -> Value {
    Value::Map(vec![("a".into(), 1_i64.into())])
}

#[test]
fn names_of_more_than_1024_bytes_are_refused_everywhere() {
    let mut session = scene();
    let bytes = || Value::Bytes(vec![1]);
    for (n, is_taken) in [(1_024, true), (1_025, false)] {
        let name = || Value::from("é".repeat(n / 2) + &"x".repeat(n % 2));
        let property = |kind: &str| Value::Text(format!("{kind}.{}", "x".repeat(n)));
        let calls: &[(&str, Vec<Value>)] = &[
            ("sim.setInt32Signal", vec![name(), Value::Int(1)]),
            ("sim.setFloatSignal", vec![name(), Value::Real(1.0)]),
            ("sim.setStringSignal", vec![name(), bytes()]),
            ("sim.writeCustomDataBlock", vec![Value::Int(SCENE), name(), bytes()]),
            ("sim.writeCustomStringData", vec![Value::Int(SCENE), name(), "text".into()]),
            ("sim.writeCustomTableData", vec![Value::Int(SCENE), name(), table()]),
            ("sim.setProperty", vec![Value::Int(SCENE), property("customData"), bytes()]),
            ("sim.setProperty", vec![Value::Int(SCENE), property("signal"), bytes()]),
            ("sim.setNamedStringParam", vec![name(), bytes()]),
            ("sim.tubeOpen", vec![Value::Int(0), name(), Value::Int(1)]),
        ];
        for (function, arguments) in calls {
            let result = session.call(function, arguments);
            assert_eq!(result.is_ok(), is_taken, "{function}, {n} bytes: {result:?}");
            if let Err(error) = result {
                assert!(error.0.contains("1025 bytes") && error.0.contains("more than 1024"), "{function}: {error}");
                assert!(error.0.len() < 300, "{error}");
            }
        }
    }
}

#[test]
fn lengths_of_names_count_as_stored_bytes() {
    let mut session = scene();
    let room = |session: &mut OpenSession| {
        let registry = &session.sim().registry;
        let (mut low, mut high) = (0_usize, 1 << 40);
        while low < high {
            let middle = (low + high).div_ceil(2);
            if registry.check_stored_size(middle).is_ok() { low = middle } else { high = middle - 1 }
        }
        low
    };
    let before = room(&mut session);
    let name = || Value::from("n".repeat(1_000));
    call(&mut session, "sim.setInt32Signal", &[name(), Value::Int(1)]);
    assert_eq!(before - room(&mut session), 1_000);
    call(&mut session, "sim.writeCustomDataBlock", &[Value::Int(SCENE), name(), Value::Bytes(vec![0; 10])]);
    assert_eq!(before - room(&mut session), 2_010);
    call(&mut session, "sim.tubeOpen", &[Value::Int(0), name(), Value::Int(1)]);
    assert_eq!(before - room(&mut session), 3_010);
    let ui = call(&mut session, "simUI.create", &["<ui></ui>".into()]).remove(0);
    call(&mut session, "simUI.setLabelText", &[ui.clone(), Value::Int(1), "12345".into()]);
    let of_handle = ui.as_text().unwrap().len();
    assert_eq!(before - room(&mut session), 3_015 + of_handle);
}

#[test]
fn values_of_widgets_need_an_interface_and_end_with_the_run() {
    let mut session = scene();
    let why = refused(&mut session, "simUI.setSliderValue", &["mine".into(), Value::Int(1), Value::Int(5)]);
    assert!(why.contains("no interface `mine`"), "{why}");
    let kept = call(&mut session, "simUI.create", &["<ui></ui>".into()]).remove(0);
    call(&mut session, "simUI.setSliderValue", &[kept.clone(), Value::Int(1), Value::Int(7)]);
    let mut of_runs = Vec::new();
    for _ in 0..3 {
        session.start().unwrap();
        let own = call(&mut session, "simUI.create", &["<ui></ui>".into()]).remove(0);
        let slider = [own.clone(), Value::Int(1)];
        assert_eq!(call(&mut session, "simUI.getSliderValue", &slider), [Value::Int(0)], "nothing of the last run");
        call(&mut session, "simUI.setSliderValue", &[own.clone(), Value::Int(1), Value::Int(40)]);
        call(&mut session, "simUI.setSliderValue", &[kept.clone(), Value::Int(1), Value::Int(8)]);
        session.step().unwrap();
        assert_eq!(call(&mut session, "simUI.getSliderValue", &slider), [Value::Int(40)]);
        session.stop().unwrap();
        assert_eq!(call(&mut session, "simUI.getSliderValue", &slider), [Value::Int(0)]);
        let why = refused(&mut session, "simUI.setSliderValue", &[own.clone(), Value::Int(1), Value::Int(1)]);
        assert!(why.contains("no interface"), "{why}");
        let before = call(&mut session, "simUI.getSliderValue", &[kept.clone(), Value::Int(1)]);
        assert_eq!(before, [Value::Int(7)], "made before the runs: as it was");
        of_runs.push(own);
    }
    assert!(of_runs.iter().all(|own| *own == of_runs[0]), "each run has the same handle: {of_runs:?}");
    call(&mut session, "simUI.destroy", std::slice::from_ref(&kept));
    assert!(session.call("simUI.setSliderValue", &[kept, Value::Int(1), Value::Int(1)]).is_err());
}

#[test]
fn a_refused_property_leaves_the_signal_of_its_name() {
    let mut session = scene();
    let signal = || Value::from("signal.k");
    call(&mut session, "sim.setProperty", &[Value::Int(SCENE), signal(), Value::Int(3)]);
    let why = refused(&mut session, "sim.setProperty", &[Value::Int(SCENE), signal(), table()]);
    assert!(why.contains("sim.packTable"), "{why}");
    assert_eq!(call(&mut session, "sim.getInt32Signal", &["k".into()]), [Value::Int(3)]);
    let long = Value::Bytes(vec![0; (256 << 20) + 1]);
    assert!(refused(&mut session, "sim.setProperty", &[Value::Int(SCENE), signal(), long]).contains("MiB"));
    assert_eq!(call(&mut session, "sim.getInt32Signal", &["k".into()]), [Value::Int(3)]);
    // another kind replaces it
    call(&mut session, "sim.setProperty", &[Value::Int(SCENE), signal(), Value::Real(0.5)]);
    assert_eq!(call(&mut session, "sim.getInt32Signal", &["k".into()]), []);
    assert_eq!(call(&mut session, "sim.getProperty", &[Value::Int(SCENE), signal()]), [Value::Real(0.5)]);
    call(&mut session, "sim.setProperty", &[Value::Int(SCENE), signal(), true.into()]);
    assert_eq!(call(&mut session, "sim.getFloatSignal", &["k".into()]), []);
    assert_eq!(call(&mut session, "sim.getInt32Signal", &["k".into()]), [Value::Int(1)]);
}

/// Every function that writes data under a tag, and what each that reads then gives; none where it refuses.
#[test]
fn data_blocks_and_properties_are_one_under_a_tag() {
    let mut session = scene();
    let packed = call(&mut session, "sim.packTable", &[table()]).remove(0);
    let text = || Value::from("abc");
    let raw = || Value::Bytes(b"abc".to_vec());
    // block, text, table; property of any kind, buffer, string, table
    let of_bytes = [Some(raw()), Some(text()), None, Some(raw()), Some(raw()), Some(text()), None];
    let of_text = [Some(raw()), Some(text()), None, Some(text()), Some(raw()), Some(text()), None];
    let of_table = [Some(packed.clone()), None, Some(table()), Some(table()), None, None, Some(table())];
    let writers: &[(&str, &str, Value, &[Option<Value>; 7])] = &[
        ("writeCustomDataBlock", "s", raw(), &of_bytes),
        ("writeCustomBufferData", "s", raw(), &of_bytes),
        ("writeCustomStringData", "s", text(), &of_text),
        ("writeCustomTableData", "s", table(), &of_table),
        ("setProperty", "customData.s", raw(), &of_bytes),
        ("setProperty", "customData.s", text(), &of_text),
        ("setProperty", "customData.s", table(), &of_table),
        ("setBufferProperty", "customData.s", raw(), &of_bytes),
        ("setStringProperty", "customData.s", text(), &of_text),
        ("setTableProperty", "customData.s", table(), &of_table),
    ];
    let readers = [
        ("readCustomDataBlock", "s"),
        ("readCustomStringData", "s"),
        ("readCustomTableData", "s"),
        ("getProperty", "customData.s"),
        ("getBufferProperty", "customData.s"),
        ("getStringProperty", "customData.s"),
        ("getTableProperty", "customData.s"),
    ];
    let joint = call(&mut session, "sim.getObject", &["/joint1".into()]).remove(0);
    for target in [joint, Value::Int(SCENE)] {
        for (writer, tag, value, expected) in writers {
            call(&mut session, &format!("sim.{writer}"), &[target.clone(), (*tag).into(), value.clone()]);
            for ((reader, tag), expected) in readers.iter().zip(*expected) {
                let got = session.call(&format!("sim.{reader}"), &[target.clone(), (*tag).into()]);
                assert_eq!(got.ok().map(|mut all| all.remove(0)), *expected, "{writer}, {reader}");
            }
            let tags = call(&mut session, "sim.readCustomDataTags", std::slice::from_ref(&target));
            assert_eq!(tags, [Value::List(vec!["s".into()])], "{writer}");
        }
        // bytes that sim.packTable gave are a table, too
        call(&mut session, "sim.writeCustomDataBlock", &[target.clone(), "s".into(), packed.clone()]);
        assert_eq!(call(&mut session, "sim.readCustomTableData", &[target.clone(), "s".into()]), [table()]);
        call(&mut session, "sim.writeCustomDataBlock", &[target.clone(), "s".into(), Value::Bytes(Vec::new())]);
        assert!(session.call("sim.getProperty", &[target.clone(), "customData.s".into()]).is_err());
    }
}

#[test]
fn a_tag_with_a_zero_byte_is_refused() {
    let mut session = scene();
    for (function, tag) in [
        ("writeCustomDataBlock", "\0s"),
        ("writeCustomTableData", "s\0"),
        ("readCustomDataBlock", "\0s"),
        ("setTableProperty", "customData.\0s"),
        ("getProperty", "customData.\0s"),
        ("removeProperty", "customData.\0s"),
    ] {
        let why = refused(&mut session, &format!("sim.{function}"), &[Value::Int(SCENE), tag.into(), table()]);
        let is_named = why.contains("zero byte");
        // data blocks look at their data first
        assert!(is_named || (function == "writeCustomDataBlock" && why.contains("argument 3")), "{function}: {why}");
    }
    let block = [Value::Int(SCENE), "\0s".into(), Value::Bytes(vec![1])];
    assert!(refused(&mut session, "sim.writeCustomDataBlock", &block).contains("zero byte"));
}
