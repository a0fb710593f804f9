//! Objects made at run time as pictures show them: what appears, moves, is drawn and goes, and when.

use sincro_coppelia::api::Value;
use sincro_coppelia::session::Session;
use sincro_sim::Extensions;
use sincro_sim::replay::{RuntimeChange, RuntimeEvent};
use sincro_testing::{OpenSession, SceneFolder};

/// A cart that goes along x at 1 m/s, and a mark. The rail's frame is at the origin, its moving side at x = 0.5 m.
const SCENE: &str = r#"
[[joint]]
name = "rail"
kind = "prismatic"
axis = [1.0, 0.0, 0.0]
initial = { position = 0.5, velocity = 1.0 }
[[body]]
name = "cart"
parent = "/rail"
density = 500.0
shape = [{ cuboid = { size = [0.4, 0.2, 0.2] } }]
[[frame]]
name = "mark"
position = [0.0, 0.0, 3.0]
"#;

const EXPERIMENT: &str = r#"
title = "Drawings"
scene = "scene.toml"
duration = 1.0
step = 0.01
record = ["/rail.position"]
"#;

const LINES: i64 = 1;
const BALLS: i64 = 7;
const POINT_STRIP: i64 = 8;
const DISCS: i64 = 11;
const ITEM_SIZES: i64 = 128;
const ITEM_COLORS: i64 = 32;
const VERTEX_COLORS: i64 = 64;
const CYCLIC: i64 = 4096;
const LOCAL: i64 = 8_388_608;
const ADD_MULTIPLE: i64 = 1 << 24;

fn session() -> OpenSession {
    SceneFolder::of(SCENE, EXPERIMENT).session(Extensions::default(), None)
}

fn call(session: &mut Session, name: &str, arguments: &[Value]) -> Value {
    let mut values = session.call(name, arguments).unwrap_or_else(|error| panic!("{name}: {error}"));
    if values.is_empty() { Value::Nil } else { values.remove(0) }
}

fn object(session: &mut Session, path: &str) -> Value {
    call(session, "sim.getObject", &[Value::from(path)])
}

/// A drawing of a kind on an object, with room for `n` items.
fn drawing(session: &mut Session, kind: i64, parent: Value, n: i64) -> i64 {
    let (size, tolerance) = (Value::Real(0.01), Value::Real(0.0));
    let made = call(session, "sim.addDrawingObject", &[Value::Int(kind), size, tolerance, parent, Value::Int(n)]);
    made.as_int().expect("a handle")
}

fn draw(session: &mut Session, handle: i64, numbers: &[f64]) -> i64 {
    let numbers = Value::reals(numbers.iter().copied());
    call(session, "sim.addDrawingObjectItem", &[Value::Int(handle), numbers]).as_int().expect("a result")
}

/// Runs to the end; what has happened to the objects whose path begins so.
fn run(mut session: OpenSession, path: &str, mut each: impl FnMut(&mut Session, usize)) -> Vec<RuntimeEvent> {
    session.start().unwrap();
    for k in 0..20 {
        each(&mut session, k);
        session.step().unwrap();
    }
    session.stop().unwrap();
    let finished = session.take_finished().remove(0);
    let events = finished.simulated.trajectory.expect("frames are recorded").runtime.events;
    let is_put = |e: &&RuntimeEvent| matches!(&e.change, RuntimeChange::Put(view) if view.path.starts_with(path));
    let ids: Vec<u64> = events.iter().filter(is_put).map(|e| e.id).collect();
    assert!(events.is_sorted_by(|a, b| a.t <= b.t), "in the order of time");
    events.into_iter().filter(|e| ids.contains(&e.id)).collect()
}

#[test]
fn shapes_sensors_and_moved_frames_are_seen_from_when_they_are_made_until_they_go() {
    let mut s = session();
    let mark = object(&mut s, "/mark");
    let mut made = Value::Nil;
    let events = run(s, "/", |s, k| match k {
        0 => {
            let sizes = Value::reals([0.1, 0.2, 0.3]);
            made = call(s, "sim.createPrimitiveShape", &[Value::Int(3), sizes, Value::Int(0)]);
        }
        5 => {
            call(s, "sim.setObjectPosition", &[made.clone(), Value::reals([1.0, 2.0, 3.0])]);
            call(s, "sim.setObjectPosition", &[mark.clone(), Value::reals([0.0, 0.0, 4.0])]);
        }
        10 => {
            call(s, "sim.removeObjects", &[Value::List(vec![made.clone()])]);
        }
        _ => {}
    });
    let words: Vec<String> = events
        .iter()
        .map(|e| match &e.change {
            RuntimeChange::Put(view) => format!("{} {:?} at {:?}", view.kind, view.shapes.len(), &view.pose[..3]),
            RuntimeChange::Move(mover, pose) => format!("on {mover:?} at {:?}", &pose[..3]),
            other => format!("{other:?}"),
        })
        .collect();
    assert_eq!(
        words,
        ["shape 1 at [0.0, 0.0, 0.0]", "frame 0 at [0.0, 0.0, 4.0]", "on None at [1.0, 2.0, 3.0]", "Gone(())"]
    );
}

#[test]
fn items_are_in_the_frame_of_what_carries_them() {
    let mut s = session();
    let cart = object(&mut s, "/cart");
    let (given, local) = (drawing(&mut s, LINES, cart.clone(), 5), drawing(&mut s, LINES + LOCAL, cart, 5));
    for handle in [given, local] {
        assert_eq!(draw(&mut s, handle, &[1.0, 2.0, 3.0, 4.0, 5.0, 6.0]), 1);
    }
    let events = run(s, "/drawing", |_, _| ());
    let items = events.iter().filter_map(|e| match &e.change {
        RuntimeChange::Items(0, numbers) => Some(numbers.clone()),
        _ => None,
    });
    // the cart stands at x = 0.5 m
    let expected = [vec![0.5, 2.0, 3.0, 3.5, 5.0, 6.0], vec![1.0, 2.0, 3.0, 4.0, 5.0, 6.0]];
    assert_eq!(items.collect::<Vec<_>>(), expected);
    let movers = events.iter().filter_map(|e| match &e.change {
        RuntimeChange::Put(view) => Some(view.mover),
        _ => None,
    });
    assert_eq!(movers.collect::<Vec<_>>(), [Some(0), Some(0)], "the cart's joint carries both");
}

#[test]
fn a_full_drawing_takes_nothing_a_cyclic_one_replaces_and_nil_removes_all() {
    let mut s = session();
    let world = Value::Int(-1);
    let fixed = drawing(&mut s, BALLS, world.clone(), 2);
    assert_eq!([1.0, 2.0, 3.0].map(|x| draw(&mut s, fixed, &[x, 0.0, 0.0])), [1, 1, 0]);
    let cyclic = drawing(&mut s, BALLS + CYCLIC, world, 2);
    assert_eq!(draw(&mut s, cyclic + ADD_MULTIPLE, &[1.0, 0.0, 0.0, 2.0, 0.0, 0.0, 3.0, 0.0, 0.0]), 1);
    let events = run(s, "/drawing2", |s, k| {
        if k == 10 {
            call(s, "sim.addDrawingObjectItem", &[Value::Int(cyclic), Value::Nil]);
        }
    });
    let changes: Vec<&RuntimeChange> = events.iter().skip(1).map(|e| &e.change).collect();
    let third = RuntimeChange::Items(1, vec![2.0, 0.0, 0.0]);
    let first = RuntimeChange::Items(0, vec![3.0, 0.0, 0.0]);
    assert_eq!(changes, [&third, &first, &RuntimeChange::Clear(())]);
}

#[test]
fn drawings_of_a_run_go_with_it_and_wrong_items_are_refused() {
    let mut s = session();
    let handle = drawing(&mut s, LINES, Value::Int(-1), 5);
    let refused = |s: &mut Session, name: &str, arguments: &[Value]| s.call(name, arguments).expect_err(name).0;
    let few = [Value::Int(handle), Value::reals([1.0, 2.0, 3.0])];
    assert!(refused(&mut s, "sim.addDrawingObjectItem", &few).contains("3 numbers for an item that has 6"));
    let nan = [Value::Int(handle), Value::reals([f64::NAN; 6])];
    assert!(refused(&mut s, "sim.addDrawingObjectItem", &nan).contains("finite"));
    assert!(refused(&mut s, "sim.removeDrawingObject", &[Value::Int(77)]).contains("no drawing 77"));
    let no_kind = [Value::Int(30), Value::Real(1.0), Value::Real(0.0), Value::Int(-1), Value::Int(5)];
    assert!(refused(&mut s, "sim.addDrawingObject", &no_kind).contains("30 is no figure"));
    s.start().unwrap();
    s.step().unwrap();
    s.stop().unwrap();
    assert!(refused(&mut s, "sim.removeDrawingObject", &[Value::Int(handle)]).contains("no drawing"));
}

/// Entries of all items that a drawing was given.
fn items(events: &[RuntimeEvent]) -> Vec<Vec<f32>> {
    let of = |e: &RuntimeEvent| match &e.change {
        RuntimeChange::Items(_, numbers) => Some(numbers.clone()),
        _ => None,
    };
    events.iter().filter_map(of).collect()
}

#[test]
fn what_hangs_on_a_joint_stays_on_its_fixed_side() {
    let mut s = session();
    let rail = object(&mut s, "/rail");
    let lines = drawing(&mut s, LINES, rail, 5);
    draw(&mut s, lines, &[1.0, 2.0, 3.0, 4.0, 5.0, 6.0]);
    let events = run(s, "/drawing", |_, _| ());
    let RuntimeChange::Put(view) = &events[0].change else { panic!("{events:?}") };
    assert_eq!(view.mover, None);
}

/// The second point of a particle is where it comes to in one second; it is seen from the state in which it was made.
#[test]
fn particles_go_from_the_first_point_towards_the_second() {
    let mut s = session();
    let (size, density, lifetime) = (Value::Real(0.1), Value::Real(1.0), Value::Real(0.05));
    let kind = Value::Int(256); // no gravity
    let arguments = [kind, size, density, Value::Nil, lifetime, Value::Int(2)];
    let jet = call(&mut s, "sim.addParticleObject", &arguments).as_int().unwrap();
    let mut taken = Vec::new();
    let events = run(s, "/particles", |s, _| {
        let numbers = Value::reals([5.0, 0.0, 2.0, 5.0, 0.0, -1.0]);
        let result = call(s, "sim.addParticleObjectItem", &[Value::Int(jet), numbers]);
        taken.push(result.as_int().unwrap());
    });
    let first = &items(&events)[0];
    assert_eq!(first[..6], [5.0, 0.0, 2.0, 0.0, 0.0, -3.0]);
    // room for two, each for 0.05 s: the third has to wait for the end of the first
    assert_eq!(taken[..8], [1, 1, 0, 0, 0, 1, 1, 0]);
}

#[test]
fn items_have_as_many_numbers_as_their_flags_say() {
    let mut s = session();
    let n_numbers = [
        (0, 3),
        (VERTEX_COLORS, 3),
        (ITEM_COLORS + ITEM_SIZES, 7),
        (LINES + VERTEX_COLORS + ITEM_COLORS, 12),
        (2 + ITEM_SIZES, 9),
        (POINT_STRIP + VERTEX_COLORS, 6),
        (5 + ITEM_SIZES, 7),
        (DISCS + ITEM_SIZES, 8),
        (DISCS + 131_072, 7),
        (3 + 131_072, 3),
    ];
    for (kind, n) in n_numbers {
        let handle = drawing(&mut s, kind, Value::Int(-1), 5);
        let numbers = |n: usize| [Value::Int(handle), Value::reals(vec![0.5; n])];
        let few = s.call("sim.addDrawingObjectItem", &numbers(n - 1)).expect_err("too few").0;
        assert!(few.contains(&format!("item that has {n},")), "kind {kind}: {few}");
        assert_eq!(call(&mut s, "sim.addDrawingObjectItem", &numbers(n)), Value::Int(1), "kind {kind}");
    }
}

#[test]
fn drawings_and_particles_are_removed_apart_and_with_what_carries_them() {
    let mut s = session();
    let point = call(&mut s, "sim.createDummy", &[Value::Real(0.01)]);
    let on_point = drawing(&mut s, LINES, point.clone(), 5);
    let lines = drawing(&mut s, LINES, Value::Int(-1), 0);
    let (size, density, lifetime) = (Value::Real(0.1), Value::Real(1.0), Value::Real(1.0));
    let of_jet = [Value::Int(0), size, density, Value::Nil, lifetime, Value::Int(2)];
    let jet = call(&mut s, "sim.addParticleObject", &of_jet);
    let refused = |s: &mut Session, name: &str, handle: Value| s.call(name, &[handle]).expect_err(name).0;
    assert!(refused(&mut s, "sim.removeDrawingObject", jet.clone()).contains("is particles, no drawing"));
    assert!(refused(&mut s, "sim.removeDrawingObject", Value::Int(-1)).contains("no drawing -1"));
    call(&mut s, "sim.removeObjects", &[Value::List(vec![point])]);
    assert!(refused(&mut s, "sim.removeDrawingObject", Value::Int(on_point)).contains("no drawing"));
    call(&mut s, "sim.removeParticleObject", &[Value::Int(-2)]);
    // as in V-REP particles that are not there are no error
    assert_eq!(call(&mut s, "sim.removeParticleObject", &[jet]), Value::Int(-1));
    assert_eq!(call(&mut s, "sim.removeParticleObject", &[Value::Int(-1)]), Value::Int(-1));
    // 0 items are 1,000
    let all: Vec<f64> = (0..6 * 1001).map(f64::from).collect();
    assert_eq!(draw(&mut s, lines + ADD_MULTIPLE, &all), 0, "one does not fit");
    call(&mut s, "sim.removeDrawingObject", &[Value::Int(lines)]);
}
