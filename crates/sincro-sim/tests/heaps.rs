//! Heaps: many contacts at once, solved island by island at the time-stepping level.

use std::fmt::Write;
use std::sync::atomic::AtomicBool;

use sincro_dynamics::actuation::ExternalForce;
use sincro_dynamics::integrate::Control;
use sincro_dynamics::prelude::*;
use sincro_sim::campaign::{Campaign, run_campaign};
use sincro_sim::run::LockStep;
use sincro_sim::snapshot::Snapshot;
use sincro_testing::SceneFolder;
use sincro_testing::random::{Draw, uniform};

const G: f64 = 9.81;
const STEP: f64 = 0.005;

const FLOOR: &str = "[[body]]\nname = \"floor\"\nshape = [{ plane = {} }]\ncontact = { friction = 0.6 }\n";

/// A box of 800 kg/m³ on its own.
fn a_box(text: &mut String, name: usize, position: [f64; 3], rotation: [f64; 4], size: [f64; 3]) {
    let [x, y, z] = position;
    let [a, b, c, d] = rotation;
    let _ = write!(
        text,
        "[[joint]]\nname = \"air{name}\"\nkind = \"free\"\ninitial = {{ position = [{x}, {y}, {z}, {a}, {b}, {c}, {d}] }}\n\
         [[body]]\nname = \"box\"\nparent = \"/air{name}\"\ndensity = 800.0\nshape = [{{ cuboid = {{ size = {size:?} }} }}]\n\
         contact = {{ friction = 0.6 }}\n"
    );
}

/// `n` boxes of random sizes, turned at random, above each other and beside each other; and their mass `[kg]`.
fn heap(n: usize, seed: u64) -> (String, f64) {
    let (mut text, mut number, mut mass) = (FLOOR.to_owned(), uniform(seed), 0.0);
    for k in 0..n {
        let size: [f64; 3] = std::array::from_fn(|_| 0.08 + 0.08 * number());
        mass += 800.0 * size.iter().product::<f64>();
        let beside = |k: usize, number: &mut dyn FnMut() -> f64| 0.22 * k as f64 + 0.04 * (number() - 0.5);
        let position = [beside(k % 2, &mut number), beside(k / 2 % 2, &mut number), 0.16 + 0.23 * (k / 4) as f64];
        let axis: [f64; 3] = std::array::from_fn(|_| 0.4 * (number() - 0.5));
        let norm = (1.0 + axis.iter().map(|x| x * x).sum::<f64>()).sqrt();
        a_box(&mut text, k, position, [1.0 / norm, axis[0] / norm, axis[1] / norm, axis[2] / norm], size);
    }
    (text, mass)
}

fn experiment(duration: f64, record: &str) -> String {
    format!(
        "title = \"Heap\"\nscene = \"scene.toml\"\nduration = {duration}\nstep = {STEP}\n\
         integrator = \"semi-implicit-euler\"\nerror_bar = \"none\"\nrecord = [{record}]\n"
    )
}

fn run(scene: &str, duration: f64, record: &str) -> Campaign {
    let folder = SceneFolder::of(scene, &experiment(duration, record));
    let loaded = folder.load(&[]).unwrap_or_else(|message| panic!("{message}"));
    run_campaign(&folder, &[], &loaded, None, &AtomicBool::new(false), &mut |_, _| {}).unwrap()
}

fn column<'a>(campaign: &'a Campaign, name: &str) -> &'a [f64] {
    &campaign.main.simulated.table.column(name).unwrap_or_else(|| panic!("no column {name}")).values
}

#[test]
fn a_heap_comes_to_rest_and_the_floor_carries_its_weight() {
    for seed in [1, 2, 3] {
        let (scene, mass) = heap(12, seed);
        let done = run(&scene, 5.0, "\"energy.kinetic\", \"energy.total\", \"/floor.normal_force\"");
        assert!(done.main.audit.ok, "seed {seed}: {:?}", done.main.audit.findings);
        let kinetic = column(&done, "energy.kinetic");
        assert!(*kinetic.last().unwrap() < 1e-12, "seed {seed}: {:e} J", kinetic.last().unwrap());
        let total = column(&done, "energy.total");
        let risen = total.windows(2).map(|pair| pair[1] - pair[0]).fold(0.0, f64::max);
        assert!(risen < 1e-2 * (total[0] - total.last().unwrap()), "seed {seed}: energy rose by {risen:e} J");
        let weight = column(&done, "/floor.normal_force").last().unwrap().abs();
        assert!((weight / (mass * G) - 1.0).abs() < 1e-5, "seed {seed}: {weight} N for {} N", mass * G);
    }
}

#[test]
fn boxes_that_hit_each_other_keep_to_their_laws() {
    for (n, seed) in [(40, 1), (40, 2), (60, 3), (80, 4), (80, 5)] {
        let done = run(&heap(n, seed).0, 0.9, "\"energy.total\"");
        assert!(done.main.audit.ok, "{n} boxes, seed {seed}: {:?}", done.main.audit.findings);
    }
}

#[test]
fn a_wall_of_bricks_stays_where_it_is() {
    let mut scene = FLOOR.to_owned();
    let (rows, edge) = (6, 0.1);
    for row in 0..rows {
        for k in 0..rows - row {
            let x = (k as f64 - 0.5 * (rows - row) as f64) * 0.11;
            let position = [x, 0.0, edge * (row as f64 + 0.5)];
            a_box(&mut scene, 10 * row + k, position, [1.0, 0.0, 0.0, 0.0], [edge; 3]);
        }
    }
    let done = run(&scene, 3.0, "\"/air50.position\", \"energy.kinetic\"");
    assert!(done.main.audit.ok, "{:?}", done.main.audit.findings);
    let columns = &done.main.simulated.table.columns;
    for column in columns.iter().filter(|column| column.name.starts_with("/air50")) {
        let moved = column.values.iter().map(|x| (x - column.values[0]).abs()).fold(0.0, f64::max);
        assert!(moved < 1e-6, "{} moved by {moved:e}", column.name);
    }
    assert!(*column(&done, "energy.kinetic").last().unwrap() < 1e-15);
}

#[test]
fn a_heap_goes_on_bit_for_bit_from_a_snapshot() {
    let folder = SceneFolder::of(&heap(10, 5).0, &experiment(2.0, "\"energy.total\""));
    let loaded = folder.load(&[]).unwrap_or_else(|message| panic!("{message}"));
    let method = MethodKind::SemiImplicitEuler;
    let mut run = LockStep::new(&loaded, method, false);
    run.start().unwrap();
    for _ in 0..140 {
        run.advance().unwrap();
    }
    let bytes = run.snapshot(run.trace()).to_bytes(&loaded);
    let mut other = LockStep::new(&loaded, method, false);
    other.start().unwrap();
    other.restore(&Snapshot::from_bytes(&bytes, &loaded).unwrap());
    for tick in 140..260 {
        assert_eq!(
            run.observe(f64::from(tick) * STEP).0.accelerations,
            other.observe(f64::from(tick) * STEP).0.accelerations
        );
        run.advance().unwrap();
        other.advance().unwrap();
        assert_eq!(run.state(), other.state(), "tick {tick}");
    }
}

/// World of a scene, stepped by semi-implicit Euler without totals.
fn world(scene: &str) -> World {
    let scene = sincro_scene::scene::from_text(scene).unwrap_or_else(|e| panic!("{e}"));
    let model = (*scene.model).clone();
    let mut world =
        World::with_totals(model, scene.initial, MethodKind::SemiImplicitEuler, Control::new(1e-9, STEP), false);
    world.initialize(0.0);
    world
}

fn bits(world: &World) -> Vec<u64> {
    let State { q, v, contacts, .. } = &world.state;
    q.iter().chain(v).chain(contacts).map(|x| x.to_bits()).collect()
}

fn moving(world: &World) -> usize {
    world.state.v.chunks(6).filter(|v| v.iter().any(|v| *v != 0.0)).count()
}

#[test]
fn a_heap_asleep_is_the_heap_awake_bit_for_bit() {
    for (seed, is_mixed) in [(1, false), (2, false), (3, false), (4, true), (5, true)] {
        let mut scene = heap(10, seed).0;
        if is_mixed {
            // every other one a cylinder or a capsule that fits in
            for (k, kind) in (0..5).zip(["cylinder", "capsule"].into_iter().cycle()) {
                let of_body = scene.match_indices("cuboid = { size = ").nth(k + 1).map(|(at, _)| at).unwrap();
                let end = of_body + scene[of_body..].find('}').unwrap() + 1;
                let [radius, length] = if kind == "cylinder" { [0.05, 0.1] } else { [0.04, 0.05] };
                scene.replace_range(of_body..end, &format!("{kind} = {{ radius = {radius}, length = {length} }}"));
            }
        }
        // one world leaves out what rests; the other is told in every step that something may have changed; a third
        // one is looked at
        let [mut asleep, mut awake, mut seen] = [world(&scene), world(&scene), world(&scene)];
        let mut slept = [0; 3];
        for k in 0..3000 {
            let t = STEP * f64::from(k);
            for world in [&mut asleep, &mut awake, &mut seen] {
                match k {
                    // thrown up, it falls on what sleeps
                    1600 => world.state.v[..6].copy_from_slice(&[0.3, 0.0, 2.0, 0.1, -0.1, 4.0]),
                    // pushed by a force that moves nothing, and lifted
                    2300 => world.apply_external_force(push([0.0, 0.0, -1.0])),
                    2320 => world.apply_external_force(push([0.0, 0.0, 60.0])),
                    2340 => world.clear_external_forces(),
                    // what lay on it is pushed off
                    2800 => world.set_gravity(Vec3([0.5, 0.0, -G])),
                    _ => {}
                }
            }
            awake.mark_changed();
            if k % 3 == 0 {
                seen.observe(t);
            }
            for world in [&mut asleep, &mut awake, &mut seen] {
                world.advance(t, STEP).unwrap();
            }
            if k % 20 == 0 || [1601, 2301, 2321, 2341, 2801].contains(&k) {
                assert!(bits(&asleep) == bits(&awake), "seed {seed}: asleep and awake differ at step {k}");
                assert!(bits(&asleep) == bits(&seen), "seed {seed}: it matters at step {k} whether it is looked at");
            }
            for (slept, end) in slept.iter_mut().zip([1600, 2300, 2800]) {
                *slept = if k + 1 == end { 10 - moving(&asleep) } else { *slept };
            }
        }
        assert!(
            // round ones roll on
            slept.into_iter().all(|slept| slept >= if is_mixed { 2 } else { 5 }),
            "seed {seed}: {slept:?} of 10 boxes came to rest"
        );
    }
}

fn push(force: [f64; 3]) -> ExternalForce<f64> {
    ExternalForce { link: 3, point: Vec3([0.0; 3]), force: Vec3(force), torque: Vec3([0.0; 3]) }
}

#[test]
fn what_sleeps_does_not_move_and_the_floor_carries_it() {
    let (scene, mass) = heap(12, 4);
    let mut world = world(&scene);
    for k in 0..2400 {
        world.advance(STEP * f64::from(k), STEP).unwrap();
    }
    assert_eq!(moving(&world), 0, "boxes still move: {:?}", world.state.v);
    let before = bits(&world);
    for k in 2400..4400 {
        world.advance(STEP * f64::from(k), STEP).unwrap();
        if k % 500 == 0 {
            world.rates(STEP * f64::from(k + 1));
            let floor = world.model().constraints().colliders.iter().position(|c| c.name.contains("floor"));
            let on_floor = world.contacts().filter(|point| floor.is_some_and(|floor| point.surfaces.contains(&floor)));
            let carried: f64 = on_floor.map(|point| point.force[2].abs()).sum();
            assert!((carried / (mass * G) - 1.0).abs() < 1e-6, "{carried} N for {} N", mass * G);
        }
    }
    assert!(bits(&world) == before, "what sleeps has moved");
}

/// Three bodies in a row along x, 1 to 10 mm apart, that a heavy one flies at from behind; in front of them a wall, or
/// a stop of the joint along which the last of them slides. All of it is turned about z, and falls.
fn row_before_a_stop(r: &mut Draw, shape: &str, is_stop: bool) -> String {
    let angle = r.between(-3.0, 3.0);
    let (cos, sin) = (libm::cos(angle), libm::sin(angle));
    let turned = [libm::cos(0.5 * angle), 0.0, 0.0, libm::sin(0.5 * angle)];
    let mut gap = || r.between(1e-3, 1e-2);
    let (last_gap, mut behind, mut text) = (gap(), -0.05, FLOOR.to_owned());
    let mut add = |name: &str, joint: &str, at: f64, velocity: f64, density: f64| {
        let position = [at * cos, at * sin, 1.0];
        let _ = write!(text, "[[joint]]\nname = \"{name}\"\n");
        let _ = match joint {
            "free" => {
                let [x, y, z] = position;
                let [a, b, c, d] = turned;
                // velocities of a free joint are those in the axes of the body
                writeln!(
                    text,
                    "kind = \"free\"\ninitial = {{ position = [{x}, {y}, {z}, {a}, {b}, {c}, {d}], \
                     velocity = [0.0, 0.0, 0.0, {velocity}, 0.0, 0.0] }}"
                )
            }
            _ => writeln!(
                text,
                "kind = \"prismatic\"\naxis = [1.0, 0.0, 0.0]\nposition = {position:?}\nquaternion_wxyz = {turned:?}\n\
                 limits = {{ lower = -0.5, upper = {last_gap} }}"
            ),
        };
        let _ = write!(
            text,
            "[[body]]\nname = \"body\"\nparent = \"/{name}\"\ndensity = {density}\nshape = [{{ {shape} }}]\n\
             contact = {{ friction = 0.3 }}\n"
        );
    };
    let mut last = if is_stop { "prismatic" } else { "free" };
    for k in 0..3 {
        add(&format!("row{k}"), last, behind - last_gap, 0.0, 300.0);
        last = "free";
        behind -= 0.1 + gap();
    }
    add("striker", "free", behind - last_gap, 4.0, 8000.0);
    if !is_stop {
        let wall = [0.5 * cos, 0.5 * sin, 1.0];
        let _ = write!(
            text,
            "[[body]]\nname = \"wall\"\nposition = {wall:?}\nquaternion_wxyz = {turned:?}\n\
             shape = [{{ cuboid = {{ size = [1.0, 2.0, 2.0] }} }}]\ncontact = {{ friction = 0.3 }}\n"
        );
    }
    text
}

#[test]
fn what_a_blow_moves_does_not_pass_what_lies_in_its_way() {
    let mut r = Draw(7);
    for (shape, law) in [
        ("sphere = { radius = 0.05 }", "penetration"),
        ("cuboid = { size = [0.1, 0.1, 0.1] }", "penetration"),
        ("sphere = { radius = 0.05 }", "joint-limit"),
        ("cuboid = { size = [0.1, 0.1, 0.1] }", "joint-limit"),
    ] {
        for draw in 0..6 {
            let done = run(&row_before_a_stop(&mut r, shape, law == "joint-limit"), 0.04, "\"energy.kinetic\"");
            assert!(done.main.audit.ok, "{shape}, {law}, draw {draw}: {:?}", done.main.audit.findings);
            let checked = done.main.audit.laws.iter().find(|checked| checked.law == law);
            let passed = checked.unwrap_or_else(|| panic!("no {law}")).value;
            // twice what gravity adds within a step
            assert!(passed < 2.0 * G * STEP * STEP, "{shape}, {law}, draw {draw}: {passed:e}");
        }
    }
}
