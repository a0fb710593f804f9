//! Bodies that spin and move in steps of semi-implicit Euler: what is only turned does not grow.

use std::fmt::Write;

use sincro_dynamics::integrate::Control;
use sincro_dynamics::prelude::*;
use sincro_testing::random::uniform;

/// Mass, centre of mass, rotational inertia about it (xx, yy, zz, xy, xz, yz), in the axes of the body.
struct Body {
    mass: f64,
    center: [f64; 3],
    inertia: [f64; 6],
}

impl Body {
    /// A cloud of eight points of random masses and places: no axis of it is special.
    fn random(number: &mut impl FnMut() -> f64) -> Self {
        let points: Vec<(f64, [f64; 3])> =
            (0..8).map(|_| (0.1 + number(), std::array::from_fn(|k| [0.3, 0.2, 0.1][k] * (number() - 0.5)))).collect();
        let mass: f64 = points.iter().map(|(m, _)| m).sum();
        let center: [f64; 3] = std::array::from_fn(|k| points.iter().map(|(m, x)| m * x[k]).sum::<f64>() / mass);
        let product = |i: usize, j: usize| -> f64 {
            points.iter().map(|(m, x)| m * (x[i] - center[i]) * (x[j] - center[j])).sum()
        };
        let [xx, yy, zz] = [product(0, 0), product(1, 1), product(2, 2)];
        let inertia = [yy + zz, xx + zz, xx + yy, -product(0, 1), -product(0, 2), -product(1, 2)];
        let far = std::array::from_fn(|k| center[k] + 0.4 * (number() - 0.5));
        Self { mass, center: far, inertia }
    }

    /// Inertia about the origin of the body.
    fn about_origin(&self) -> [f64; 6] {
        let ([x, y, z], m) = (self.center, self.mass);
        let [xx, yy, zz, xy, xz, yz] = self.inertia;
        let about = [xx + m * (y * y + z * z), yy + m * (x * x + z * z), zz + m * (x * x + y * y)];
        [about[0], about[1], about[2], xy - m * x * y, xz - m * x * z, yz - m * y * z]
    }

    /// The numbers as scene files have them.
    fn keys(&self) -> String {
        let Self { mass, center, inertia: [xx, yy, zz, xy, xz, yz] } = self;
        format!(
            "mass = {mass:?}\ncenter_of_mass = {center:?}\n\
             inertia = {{ xx = {xx:?}, yy = {yy:?}, zz = {zz:?}, xy = {xy:?}, xz = {xz:?}, yz = {yz:?} }}\n"
        )
    }

    /// Scene with this body on a joint to the world, without gravity.
    fn scene(&self, joint: &str) -> String {
        format!(
            "gravity = [0.0, 0.0, 0.0]\n[[joint]]\nname = \"joint\"\nkind = \"{joint}\"\n[[body]]\nname = \"body\"\n\
             parent = \"/joint\"\n{}",
            self.keys()
        )
    }
}

fn multiply([xx, yy, zz, xy, xz, yz]: [f64; 6], [x, y, z]: [f64; 3]) -> [f64; 3] {
    [xx * x + xy * y + xz * z, xy * x + yy * y + yz * z, xz * x + yz * y + zz * z]
}

fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    std::array::from_fn(|k| a[(k + 1) % 3] * b[(k + 2) % 3] - a[(k + 2) % 3] * b[(k + 1) % 3])
}

fn plus(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    std::array::from_fn(|k| a[k] + b[k])
}

fn norm(a: [f64; 3]) -> f64 {
    dot(a, a).sqrt()
}

/// Vector in the axes of a body turned by the unit quaternion (w, x, y, z), in the axes of the world.
fn in_world(q: &[f64], a: [f64; 3]) -> [f64; 3] {
    let axis = [q[1], q[2], q[3]];
    let once = cross(axis, a);
    let twice = cross(axis, once);
    std::array::from_fn(|k| a[k] + 2.0 * (q[0] * once[k] + twice[k]))
}

fn world(scene: &str, method: MethodKind, h: f64, v: &[f64]) -> World {
    let scene = sincro_scene::scene::from_text(scene).unwrap();
    let mut world =
        World::with_totals((*scene.model).clone(), scene.initial.clone(), method, Control::new(1e-11, h), false);
    world.state.v[..v.len()].copy_from_slice(v);
    world.initialize(0.0);
    world
}

fn advance(world: &mut World, h: f64, n: u32) {
    for k in 0..n {
        world.advance(h * f64::from(k), h).unwrap();
    }
}

fn vector(x: &[f64]) -> [f64; 3] {
    [x[0], x[1], x[2]]
}

/// Random velocity of the given size.
fn velocity(number: &mut impl FnMut() -> f64, size: f64) -> [f64; 3] {
    let v: [f64; 3] = std::array::from_fn(|_| number() - 0.5);
    v.map(|x| x * size / norm(v))
}

#[test]
fn free_bodies_keep_their_momenta_and_energy() {
    let mut number = uniform(11);
    for draw in 0..20 {
        let body = Body::random(&mut number);
        let (omega, linear) = (velocity(&mut number, 20.0), velocity(&mut number, 3.0));
        let v = [omega, linear].concat();
        let mut largest = [0.0_f64; 2];
        for (largest, h) in largest.iter_mut().zip([5e-3, 1e-3]) {
            let mut world = world(&body.scene("free"), MethodKind::SemiImplicitEuler, h, &v);
            let of_center = |world: &World| {
                let v = &world.state.v;
                in_world(&world.state.q[3..], plus(vector(&v[3..]), cross(vector(v), body.center)))
            };
            let angular = |world: &World| norm(multiply(body.inertia, vector(&world.state.v)));
            let energy = |world: &World| {
                let omega = vector(&world.state.v);
                0.5 * dot(omega, multiply(body.inertia, omega))
            };
            let before = (of_center(&world), angular(&world), energy(&world));
            for _ in 0..20 {
                advance(&mut world, h, 100);
                let moved = of_center(&world);
                let change = norm(std::array::from_fn(|k| moved[k] - before.0[k])) / norm(before.0);
                assert!(change < 1e-11, "draw {draw}: the momentum changed by {change:e} of it");
                let change = (angular(&world) / before.1 - 1.0).abs();
                assert!(change < 1e-11, "draw {draw}: the angular momentum changed by {change:e} of it");
                *largest = largest.max((energy(&world) / before.2 - 1.0).abs());
            }
        }
        // of third order: a hundredth in as many steps five times as short
        assert!(largest[0] < 0.02 && largest[1] < 3e-4, "draw {draw}: energies changed by {largest:?}");
    }
}

#[test]
fn a_body_on_a_ball_joint_keeps_its_energy() {
    let mut number = uniform(12);
    for draw in 0..20 {
        let body = Body::random(&mut number);
        let omega = velocity(&mut number, 20.0);
        let inertia = body.about_origin();
        let energy = |omega: [f64; 3]| 0.5 * dot(omega, multiply(inertia, omega));
        let mut world = world(&body.scene("ball"), MethodKind::SemiImplicitEuler, 5e-3, &omega);
        advance(&mut world, 5e-3, 2000);
        let now = vector(&world.state.v);
        let momentum = norm(multiply(inertia, now)) / norm(multiply(inertia, omega)) - 1.0;
        assert!(momentum.abs() < 1e-11, "draw {draw}: the angular momentum changed by {momentum:e} of it");
        let change = energy(now) / energy(omega) - 1.0;
        assert!(change.abs() < 0.02, "draw {draw}: the energy changed by {change:e} of it");
    }
}

#[test]
fn what_rolls_keeps_its_speed() {
    for shape in ["sphere = { radius = 0.04 }", "capsule = { radius = 0.04, length = 0.05 }"] {
        // the axis of the capsule lies along −y
        let s = 0.5_f64.sqrt();
        let scene = format!(
            "[[body]]\nname = \"floor\"\nshape = [{{ plane = {{}} }}]\ncontact = {{ friction = 0.6 }}\n[[joint]]\n\
             name = \"air\"\nkind = \"free\"\ninitial = {{ position = [0.0, 0.0, 0.04, {s}, {s}, 0.0, 0.0] }}\n[[body]]\n\
             name = \"body\"\nparent = \"/air\"\ndensity = 800.0\nshape = [{{ {shape} }}]\ncontact = {{ friction = 0.6 }}\n"
        );
        let h = 5e-3;
        let rolling = [0.0, 0.0, -25.0, 1.0, 0.0, 0.0];
        let mut world = world(&scene, MethodKind::SemiImplicitEuler, h, &rolling);
        advance(&mut world, h, 1000);
        let (q, v) = (&world.state.q, &world.state.v);
        let now = in_world(&q[3..], vector(&v[3..]));
        assert!((now[0] - 1.0).abs() < 1e-9 && norm(now) - now[0] < 1e-9, "{shape}: {now:?} m/s");
        assert!((q[0] - 5.0).abs() < 1e-8, "{shape}: at {} m after 5 m", q[0]);
    }
}

/// A chain in free fall: the first body on a free joint, others on hinges and a ball joint.
fn chain(number: &mut impl FnMut() -> f64) -> String {
    let mut text = String::from("gravity = [0.0, 0.0, -9.81]\n");
    let mut parent = String::new();
    for (k, kind) in ["free", "revolute", "ball", "revolute"].into_iter().enumerate() {
        let keys = Body::random(number).keys();
        let on = if parent.is_empty() { String::new() } else { format!("parent = \"{parent}\"\n") };
        let axis = if kind == "revolute" { "axis = [0.0, 0.6, 0.8]\n" } else { "" };
        let at = [0.1, 0.05, -0.2];
        let position = if k == 0 { String::new() } else { format!("position = {at:?}\n") };
        let _ = write!(
            text,
            "[[joint]]\nname = \"joint{k}\"\nkind = \"{kind}\"\n{on}{axis}{position}[[body]]\nname = \"body{k}\"\n\
             parent = \"{parent}/joint{k}\"\n{keys}"
        );
        parent = format!("{parent}/joint{k}/body{k}");
    }
    text
}

#[test]
fn spinning_chains_converge_at_first_order() {
    let mut number = uniform(13);
    for draw in 0..5 {
        let scene = chain(&mut number);
        let v = [velocity(&mut number, 4.0), velocity(&mut number, 2.0)].concat();
        let end = |method, h: f64| {
            let mut world = world(&scene, method, h, &v);
            advance(&mut world, h, (0.5 / h).round() as u32);
            [world.state.q.clone(), world.state.v.clone()].concat()
        };
        let truth = end(MethodKind::DormandPrince, 0.01);
        let error = |h| {
            let found = end(MethodKind::SemiImplicitEuler, h);
            found.iter().zip(&truth).fold(0.0_f64, |largest, (a, b)| largest.max((a - b).abs()))
        };
        let [coarse, fine] = [error(2e-4), error(1e-4)];
        let ratio = coarse / fine;
        assert!(coarse < 0.1 && (1.8..2.2).contains(&ratio), "draw {draw}: errors {coarse:e} and {fine:e}");
    }
}

/// Scene of a body on a free joint that a loop joint holds to the world at a point of it.
fn held(body: &Body, kind: &str, point: [f64; 3]) -> String {
    let scene = body.scene("free");
    format!(
        "{scene}[[frame]]\nname = \"anchor\"\nposition = {point:?}\n[[frame]]\nname = \"pin\"\n\
         parent = \"/joint/body\"\nposition = {point:?}\n[[closure]]\nname = \"loop\"\nkind = \"{kind}\"\n\
         between = [\"/anchor\", \"/joint/body/pin\"]\n"
    )
}

#[test]
fn bodies_that_loop_joints_hold_keep_their_energy() {
    let mut number = uniform(14);
    for draw in 0..10 {
        let body = Body::random(&mut number);
        let point = velocity(&mut number, 0.3);
        let speed = 10.0 + 10.0 * number();
        for kind in ["point", "hinge"] {
            let omega = if kind == "point" { velocity(&mut number, speed) } else { [0.0, 0.0, speed] };
            let linear = cross(point, omega);
            let energy = |world: &mut World| world.energy().kinetic;
            let v = [omega, linear].concat();
            let mut world = world(&held(&body, kind, point), MethodKind::SemiImplicitEuler, 5e-3, &v);
            let before = energy(&mut world);
            advance(&mut world, 5e-3, 1000);
            let change = energy(&mut world) / before - 1.0;
            assert!(change.abs() < 0.02, "draw {draw}, {kind}: the energy changed by {change:e} of it");
        }
    }
}

#[test]
fn an_armature_of_a_ball_joint_takes_part() {
    // a point mass below: nothing turns it about the vertical
    let scene = "[[joint]]\nname = \"joint\"\nkind = \"ball\"\narmature = [0.01, 0.01, 0.01]\n[[body]]\nname = \"body\"\n\
                 parent = \"/joint\"\nmass = 1.0\ncenter_of_mass = [0.0, 0.0, -0.5]\n\
                 inertia = { xx = 0.0, yy = 0.0, zz = 0.0 }\n";
    let mut world = world(scene, MethodKind::SemiImplicitEuler, 5e-3, &[1.0, 2.0, 3.0]);
    advance(&mut world, 5e-3, 200);
    assert!((world.state.v[2] - 3.0).abs() < 1e-9, "{:?}", world.state.v);
}

/// Scene of a body that wobbles on its flat end over a floor, alone or beside boxes that make the problem a large one.
fn wobbling(shape: &str, height: f64, restitution: f64, with_boxes: bool) -> String {
    let contact = format!("contact = {{ friction = 0.3, restitution = {restitution:?} }}\n");
    let mut text = format!(
        "[[body]]\nname = \"floor\"\nshape = [{{ plane = {{}} }}]\n{contact}[[joint]]\nname = \"air\"\nkind = \"free\"\n\
         initial = {{ position = [0.0, 0.0, {height:?}, 1.0, 0.0, 0.0, 0.0] }}\n[[body]]\nname = \"body\"\n\
         parent = \"/air\"\ndensity = 800.0\nshape = [{{ {shape} }}]\n{contact}"
    );
    for k in 0..if with_boxes { 3 } else { 0 } {
        let _ = write!(
            text,
            "[[joint]]\nname = \"k{k}\"\nkind = \"free\"\n\
             initial = {{ position = [{:?}, 3.0, 0.05, 1.0, 0.0, 0.0, 0.0] }}\n[[body]]\nname = \"box\"\n\
             parent = \"/k{k}\"\ndensity = 800.0\nshape = [{{ cuboid = {{ size = [0.1, 0.1, 0.1] }} }}]\n\
             contact = {{ friction = 0.3 }}\n",
            0.3 * f64::from(k)
        );
    }
    text
}

#[test]
fn discs_and_tori_that_wobble_gain_no_energy_and_sink_nowhere() {
    let mut number = uniform(15);
    for (shape, half) in [
        ("cylinder = { radius = 0.3, length = 0.1 }", 0.05),
        ("cylinder = { radius = 0.08, length = 0.06 }", 0.03),
        ("torus = { major_radius = 0.06, tube_radius = 0.03 }", 0.03),
    ] {
        for (restitution, with_boxes) in [(0.0, false), (0.0, true), (0.3, false), (0.3, true), (0.05, true)] {
            let [x, y] = [number(), number()].map(|x| 4.0 * (x - 0.5));
            let scene = wobbling(shape, half + 2e-4, restitution, with_boxes);
            let mut world = world(&scene, MethodKind::SemiImplicitEuler, 5e-3, &[x, y, 1.0]);
            let (before, mut lowest) = (world.energy().total(), f64::INFINITY);
            for _ in 0..20 {
                advance(&mut world, 5e-3, 50);
                lowest = lowest.min(world.state.q[2]);
                let growth = world.energy().total() - before;
                assert!(growth < 1e-9, "{shape}, {restitution}, {with_boxes}: the energy grew by {growth:e} J");
            }
            assert!(lowest > half - 2e-3, "{shape}, {restitution}, {with_boxes}: down to {lowest} m");
        }
    }
}
