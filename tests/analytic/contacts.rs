//! Contact against closed forms: bouncing, sliding, sticking, rolling.

use sincro_dynamics::contact::{Material, PairLaw, Surface};
use sincro_dynamics::joint::JointKind;
use sincro_dynamics::model::{BodySpec, JointSpec, Model, ModelBuilder, NodeId, Shape};
use sincro_dynamics::spatial::{Pose, Quat, Vec3};
use sincro_dynamics::state::State;
use sincro_dynamics::world::{MethodKind, World};
use sincro_math::random::SplitMix64;

use crate::mechanisms::run;

const G: f64 = 9.81;

/// Methods that locate events.
const LOCATING: [MethodKind; 5] =
    [MethodKind::Rk4, MethodKind::Implicit, MethodKind::DormandPrince, MethodKind::DormandPrince8, MethodKind::Stiff];

/// A free body of a shape over a plane that is tilted about y by an angle; gravity points down.
fn on_a_plane(shape: Shape, tilt: f64, floor: Material, body: Material) -> Model<f64> {
    let mut b = ModelBuilder::new([0.0, 0.0, -G]);
    let turn = Quat::exp(Vec3([0.0, tilt, 0.0])).matrix();
    b.collider(NodeId::WORLD, Pose { rot: turn, pos: Vec3::zero() }, Surface::HalfSpace, floor);
    let free = b.joint("free", NodeId::WORLD, Pose::identity(), JointSpec::new(JointKind::Free));
    let it = b.body("it", free, Pose::identity(), BodySpec { mass: shape.mass_properties(1000.0) });
    b.collider(it, Pose::identity(), Surface::Solid(shape), body);
    b.build().unwrap().0
}

/// A state with the body's axes along the plane's and its centre at a height over it.
fn placed(model: &Model<f64>, tilt: f64, height: f64) -> State<f64> {
    let mut x = State::new(model);
    let turn = Quat::exp(Vec3([0.0, tilt, 0.0]));
    let n = turn.matrix().col(2);
    x.q[..3].copy_from_slice(&n.scale(height).0);
    turn.write(&mut x.q[3..7]);
    x
}

fn material(friction: f64, restitution: f64) -> Material {
    Material { friction, restitution, ..Material::default() }
}

#[test]
fn a_ball_bounces_as_its_closed_form_says() {
    let (r, e, h0) = (0.05, 0.8, 1.0);
    for kind in LOCATING {
        let model = on_a_plane(Shape::Sphere { radius: r }, 0.0, material(0.0, 0.0), material(0.0, e));
        let x = placed(&model, 0.0, r + h0);
        let mut world = World::new(model, x, kind, 1e-10, 1e-3);
        let v0 = (2.0 * G * h0).sqrt();
        // the instant of the third impact, and the height between it and the next
        let t3 = v0 / G * (1.0 + 2.0 * e + 2.0 * e * e);
        let end = t3 + 0.1;
        let v3 = v0 * e * e * e;
        let expected = r + v3 * 0.1 - 0.5 * G * 0.01;
        let n = 200;
        run(&mut world, end / f64::from(n), n);
        assert!((world.state.q[2] - expected).abs() < 1e-9, "{kind:?} {:e}", world.state.q[2] - expected);
        assert_eq!(world.statistics().impacts, 3, "{kind:?}");
    }
}

#[test]
fn a_ball_comes_to_rest_in_finite_time() {
    let (r, e) = (0.05, 0.5);
    let model = on_a_plane(Shape::Sphere { radius: r }, 0.0, material(0.0, e), material(0.0, e));
    let mut x = State::new(&model);
    x.q[2] = r + 0.1;
    let mut world = World::new(model, x, MethodKind::DormandPrince, 1e-9, 1e-3);
    run(&mut world, 0.01, 100);
    assert!((world.state.q[2] - r).abs() < 1e-11);
    assert!(world.state.v[5].abs() < 1e-11);
}

#[test]
fn a_block_sticks_just_below_the_critical_angle_and_slides_just_above() {
    let size = [0.2, 0.1, 0.05];
    let mu: f64 = 0.5;
    let critical = libm::atan(mu);
    for kind in LOCATING {
        for (tilt, slides) in [(critical - 1e-6, false), (critical + 1e-6, true), (critical + 0.1, true)] {
            let model = on_a_plane(Shape::Cuboid { size }, tilt, material(mu, 0.0), material(mu, 0.0));
            let x = placed(&model, tilt, 0.025);
            let start = x.q.clone();
            let mut world = World::new(model, x, kind, 1e-10, 1e-3);
            world.initialize(0.0);
            run(&mut world, 0.01, 100);
            let moved: f64 =
                (0..3).map(|k| (world.state.q[k] - start[k]) * (world.state.q[k] - start[k])).sum::<f64>().sqrt();
            if slides {
                let a = G * (libm::sin(tilt) - mu * libm::cos(tilt));
                assert!((moved - 0.5 * a).abs() < 1e-9, "{kind:?} {tilt}: {moved:e} {:e}", 0.5 * a);
            } else {
                assert!(moved < 1e-12, "{kind:?}: creeps {moved:e}");
            }
        }
    }
}

#[test]
fn a_pair_has_a_law_of_its_own() {
    // two blocks of one material on one floor: the one with a law of its own slides further
    let (mu, mu_pair, v0) = (0.5, 0.02, 1.0);
    let mut b = ModelBuilder::new([0.0, 0.0, -G]);
    let floor = b.frame("floor", NodeId::WORLD, Pose::identity());
    b.collider(floor, Pose::identity(), Surface::HalfSpace, material(mu, 0.0));
    let cube = Shape::Cuboid { size: [0.2; 3] };
    let blocks = [0.0, 1.0, 2.0].map(|y| {
        let at = Pose::translation(Vec3([0.0, y, 0.1]));
        let free = b.joint(&format!("free{y}"), NodeId::WORLD, at, JointSpec::new(JointKind::Free));
        let mass = cube.mass_properties(1000.0);
        let it = b.body(&format!("it{y}"), free, Pose::identity(), BodySpec { mass });
        b.collider(it, Pose::identity(), Surface::Solid(cube), material(mu, 0.0));
        it
    });
    b.contact_pair([blocks[1], floor], PairLaw { friction: Some(mu_pair), ..PairLaw::default() });
    b.contact_pair([floor, blocks[2]], PairLaw { is_excluded: true, ..PairLaw::default() });
    let model = b.build().unwrap().0;
    let mut x = State::new(&model);
    for k in 0..3 {
        x.v[6 * k + 3] = v0;
    }
    let mut world = World::new(model, x, MethodKind::DormandPrince, 1e-10, 1e-3);
    run(&mut world, 0.01, 100);
    let q = |block: usize, axis: usize| world.state.q[7 * block + axis];
    assert!((q(0, 0) - v0 * v0 / (2.0 * mu * G)).abs() < 1e-9, "{}", q(0, 0));
    assert!((q(1, 0) - (v0 - 0.5 * mu_pair * G)).abs() < 1e-9, "{}", q(1, 0));
    assert!((q(2, 2) + 0.5 * G).abs() < 1e-9 && (q(2, 0) - v0).abs() < 1e-12, "{}", q(2, 2));
}

#[test]
fn a_ball_slips_then_rolls() {
    // v0 = 1, no spin: rolls from t = 2 v0/(7 μ g) with 5/7 v0
    let (r, mu, v0) = (0.05, 0.2, 1.0);
    let error = |kind: MethodKind, n: u32| {
        let model = on_a_plane(Shape::Sphere { radius: r }, 0.0, material(mu, 0.0), material(mu, 0.0));
        let mut x = placed(&model, 0.0, r);
        x.v[3] = v0;
        let mut world = World::new(model, x, kind, 1e-10, 1e-3);
        world.initialize(0.0);
        let t = 2.0 * v0 / (7.0 * mu * G);
        run(&mut world, 0.5 / f64::from(n), n);
        let slipped = v0 * t - 0.5 * mu * G * t * t;
        assert!((world.state.q[2] - r).abs() < 1e-11, "{kind:?}");
        assert_eq!(world.statistics().events, 1, "{kind:?}");
        (world.state.q[0] - slipped - 5.0 / 7.0 * v0 * (0.5 - t)).abs()
    };
    for kind in [MethodKind::DormandPrince, MethodKind::DormandPrince8, MethodKind::Stiff] {
        assert!(error(kind, 100) < 1e-9, "{kind:?}");
    }
    // the order of the method survives the transition
    for (kind, order) in [(MethodKind::Rk4, 4.0), (MethodKind::Implicit, 2.0)] {
        let measured = libm::log2(error(kind, 100) / error(kind, 200));
        assert!((measured - order).abs() < 0.2, "{kind:?} {measured}");
    }
}

/// Free balls without gravity: (position, velocity, radius), bounced with a restitution.
fn balls(list: &[([f64; 3], [f64; 3], f64)], m: Material) -> (Model<f64>, State<f64>) {
    let mut b = ModelBuilder::new([0.0; 3]);
    for (k, (_, _, radius)) in list.iter().enumerate() {
        let shape = Shape::Sphere { radius: *radius };
        let free = b.joint(&format!("free{k}"), NodeId::WORLD, Pose::identity(), JointSpec::new(JointKind::Free));
        let ball =
            b.body(&format!("ball{k}"), free, Pose::identity(), BodySpec { mass: shape.mass_properties(1000.0) });
        b.collider(ball, Pose::identity(), Surface::Solid(shape), m);
    }
    let model = b.build().unwrap().0;
    let mut x = State::new(&model);
    for (k, (p, v, _)) in list.iter().enumerate() {
        x.q[7 * k..7 * k + 3].copy_from_slice(p);
        x.v[6 * k + 3..6 * k + 6].copy_from_slice(v);
    }
    (model, x)
}

#[test]
fn free_collisions_keep_momentum_and_lose_what_restitution_says() {
    let list = [
        ([0.0, 0.0, 0.0], [1.0, 0.1, 0.0], 0.05),
        ([0.3, 0.03, 0.01], [-0.5, 0.0, 0.2], 0.07),
        ([0.1, 0.5, 0.0], [0.0, -2.0, 0.0], 0.06),
    ];
    for (friction, restitution) in [(0.0, 1.0), (0.3, 0.7), (0.5, 0.0)] {
        let (model, x) = balls(&list, material(friction, restitution));
        let mut world = World::new(model, x, MethodKind::DormandPrince, 1e-13, 1e-3);
        // tight: between impacts a spinning ball keeps its momentum to the accuracy of the integrator
        let before = world.observe(0.0).momentum();
        let energy = world.observe(0.0).energy().total();
        run(&mut world, 0.01, 60);
        let seen = world.observe(0.6);
        let after = seen.momentum();
        for k in 0..3 {
            assert!((after.lin[k] - before.lin[k]).abs() < 1e-12, "{friction} {restitution}");
            assert!((after.ang[k] - before.ang[k]).abs() < 1e-12, "{friction} {restitution}");
        }
        let lost = energy - seen.energy().total();
        assert!((lost - seen.state.totals[1]).abs() < 1e-9, "{friction} {restitution} {lost:e}");
        assert!(if restitution == 1.0 { lost.abs() < 1e-9 } else { lost > 1e-3 }, "{friction} {restitution} {lost:e}");
        assert!(world.statistics().impacts >= 1);
    }
}

#[test]
fn a_row_of_equal_balls_passes_a_blow_on() {
    let at = |x: f64, v: f64| ([x, 0.0, 0.0], [v, 0.0, 0.0], 0.05);
    let (model, x) = balls(&[at(-0.3, 1.0), at(0.0, 0.0), at(0.1001, 0.0), at(0.2002, 0.0)], material(0.0, 1.0));
    let mut world = World::new(model, x, MethodKind::Rk4, 1e-9, 1e-3);
    run(&mut world, 0.01, 50);
    for (k, expected) in [0.0, 0.0, 0.0, 1.0].into_iter().enumerate() {
        assert!((world.state.v[6 * k + 3] - expected).abs() < 1e-12, "{k}: {}", world.state.v[6 * k + 3]);
    }
}

#[test]
fn the_order_of_the_bodies_does_not_matter() {
    // the first two meet obliquely, then the third hits one of them: with friction, so that they spin afterwards
    let list = [
        ([0.0, 0.0, 0.0], [1.0, 0.1, 0.0], 0.05),
        ([0.3, 0.03, 0.01], [-0.5, 0.0, 0.2], 0.07),
        ([0.22, 0.5, 0.05], [0.0, -2.0, 0.0], 0.06),
    ];
    let end = |order: [usize; 3]| {
        let (model, x) = balls(&order.map(|k| list[k]), material(0.3, 0.7));
        let mut world = World::new(model, x, MethodKind::DormandPrince, 1e-11, 1e-3);
        run(&mut world, 0.01, 40);
        assert_eq!(world.statistics().impacts, 2, "{order:?}");
        let mut found = [[0.0; 9]; 3];
        for (place, k) in order.into_iter().enumerate() {
            found[k][..3].copy_from_slice(&world.state.q[7 * place..7 * place + 3]);
            found[k][3..].copy_from_slice(&world.state.v[6 * place..6 * place + 6]);
        }
        found
    };
    let expected = end([0, 1, 2]);
    for (ball, (_, before, _)) in expected.iter().zip(&list) {
        let change: f64 = (0..3).map(|k| (ball[6 + k] - before[k]).abs()).sum();
        let spin: f64 = ball[3..6].iter().map(|w| w.abs()).sum();
        assert!(change > 0.1 && spin > 0.1, "every ball is hit: {ball:?}");
    }
    for order in [[0, 2, 1], [1, 0, 2], [1, 2, 0], [2, 0, 1], [2, 1, 0]] {
        for (a, b) in expected.iter().flatten().zip(end(order).iter().flatten()) {
            assert!((a - b).abs() < 1e-9, "{order:?}: {a} {b}");
        }
    }
}

#[test]
fn solids_stand_on_a_plane_as_they_should() {
    let m = material(0.5, 0.0);
    let turned = |shape, turn: [f64; 3], height: f64| {
        let model = on_a_plane(shape, 0.0, m, m);
        let mut x = placed(&model, 0.0, height);
        Quat::exp(Vec3(turn)).write(&mut x.q[3..7]);
        let start = x.q.clone();
        let mut world = World::new(model, x, MethodKind::DormandPrince, 1e-9, 1e-3);
        world.initialize(0.0);
        run(&mut world, 0.02, 50);
        let seen = world.observe(1.0);
        let force: f64 = seen.contacts().map(|c| c.force[2]).sum();
        let weight = G * seen.model().total_mass();
        assert!((force - weight).abs() < 1e-9 * weight, "{shape:?} {turn:?}: {force} {weight}");
        for k in 0..7 {
            assert!((seen.state.q[k] - start[k]).abs() < 1e-11, "{shape:?} {turn:?} {k}");
        }
    };
    let half_pi = std::f64::consts::FRAC_PI_2;
    turned(Shape::Cylinder { radius: 0.1, length: 0.3 }, [0.0; 3], 0.15);
    turned(Shape::Cylinder { radius: 0.1, length: 0.3 }, [half_pi, 0.0, 0.0], 0.1);
    turned(Shape::Capsule { radius: 0.1, length: 0.3 }, [half_pi, 0.0, 0.0], 0.1);
    turned(Shape::Cuboid { size: [0.1, 0.2, 0.3] }, [half_pi, 0.0, 0.0], 0.1);
    turned(Shape::Cone { radius: 0.1, length: 0.2 }, [0.0; 3], 0.05);
}

#[test]
fn a_compliant_floor_bounces_like_a_spring() {
    // without dissipation the ball leaves as fast as it came, after half a period and a little
    let (r, h, k) = (0.05, 0.1, 1e4);
    let soft = Material { stiffness: k, ..material(0.0, 0.0) };
    let model = on_a_plane(Shape::Sphere { radius: r }, 0.0, soft, material(0.0, 0.0));
    let m = model.total_mass();
    let x = placed(&model, 0.0, r + h);
    let mut world = World::new(model, x, MethodKind::DormandPrince, 1e-11, 1e-3);
    let t0 = (2.0 * h / G).sqrt();
    let v0 = G * t0;
    let w = (k / m).sqrt();
    // δ'' = g − ω² δ from δ = 0, δ' = v0: back at δ = 0 after (2π − 2 atan2(v0 ω, g))/ω… measured from the static depth
    let contact = 2.0 * (std::f64::consts::PI - libm::atan2(v0 * w, G)) / w;
    let t = 2.0 * t0 + contact;
    run(&mut world, t / 100.0, 100);
    assert!((world.state.q[2] - r - h).abs() < 1e-8, "{:e}", world.state.q[2] - r - h);
}

#[test]
fn a_block_rocks_on_compliant_ground_until_it_rests() {
    // its corners sink in to different depths; the friction at one must not contradict that at another
    let mut random = SplitMix64::new(11);
    let mut between = |low: f64, high: f64| low + (high - low) * random.unit();
    for _ in 0..8 {
        let (stiffness, friction) = (between(3e3, 3e4), between(0.1, 0.9));
        let soft = Material { stiffness, dissipation: between(0.5, 3.0), ..material(friction, 0.0) };
        let model = on_a_plane(Shape::Cuboid { size: [0.2, 0.15, 0.1] }, 0.0, material(friction, 0.0), soft);
        let mut x = placed(&model, 0.0, 0.2);
        let turn = Vec3(std::array::from_fn(|_| between(-0.3, 0.3)));
        Quat::exp(turn).write(&mut x.q[3..7]);
        let mut world = World::new(model, x, MethodKind::DormandPrince, 1e-9, 1e-3);
        run(&mut world, 0.01, 300);
        let (s, fastest) = (world.statistics(), world.state.v.iter().fold(0.0, |f: f64, v| f.max(v.abs())));
        let drawn = format!("{stiffness} {friction} {turn:?}: {s:?}, {fastest:e}");
        // where a corner begins to slip beside others, a short step at velocity level may find its direction
        assert!(s.fallback_ticks == 0 && s.fallback_square < 1e-9 && s.events < 600, "{drawn}");
        assert!(fastest < 1e-2, "{drawn}");
    }
}

#[test]
fn a_tumbling_box_never_gains_energy_and_its_books_balance() {
    let m = material(0.4, 0.3);
    let model = on_a_plane(Shape::Cuboid { size: [0.2, 0.14, 0.1] }, 0.1, m, m);
    let mut x = placed(&model, 0.1, 0.5);
    Quat::exp(Vec3([0.5, -0.3, 0.2])).write(&mut x.q[3..7]);
    x.v.copy_from_slice(&[3.0, -5.0, 2.0, 0.5, 0.2, 0.0]);
    let mut world = World::new(model, x, MethodKind::DormandPrince, 1e-10, 1e-3);
    world.initialize(0.0);
    let start = world.observe(0.0).energy().total();
    let (mut energy, mut lost) = (start, 0.0);
    for k in 0..150 {
        world.advance(0.01 * f64::from(k), 0.01).unwrap();
        let seen = world.observe(0.0);
        let (now, dissipated) = (seen.energy().total(), seen.state.totals[1]);
        assert!(now <= energy + 1e-9 * start.abs(), "tick {k}: energy rises by {:e}", now - energy);
        assert!(dissipated >= lost - 1e-9 * start.abs(), "tick {k}: friction gives back {:e}", lost - dissipated);
        assert!((now + dissipated - start).abs() < 1e-7 * start.abs(), "tick {k}: {:e}", now + dissipated - start);
        (energy, lost) = (now, dissipated);
    }
    let report = world.solver_report().unwrap();
    assert_eq!((report.not_converged, world.statistics().fallback_ticks), (0, 0), "{report:?}");
}

#[test]
fn at_velocity_level_a_ball_bounces_to_first_order() {
    // the instant of an impact is a whole step: the third bounce comes out with an error in proportion to it
    let (r, e, h0) = (0.05, 0.8, 1.0);
    let v0 = (2.0 * G * h0).sqrt();
    let end = v0 / G * (1.0 + 2.0 * e + 2.0 * e * e) + 0.1;
    let expected = r + v0 * e * e * e * 0.1 - 0.5 * G * 0.01;
    let error = |n: u32| {
        let model = on_a_plane(Shape::Sphere { radius: r }, 0.0, material(0.0, 0.0), material(0.0, e));
        let x = placed(&model, 0.0, r + h0);
        let mut world = World::new(model, x, MethodKind::SemiImplicitEuler, 1e-9, 1e-3);
        let h = end / f64::from(n);
        let mut lowest = f64::INFINITY;
        for k in 0..n {
            world.advance(f64::from(k) * h, h).unwrap();
            lowest = lowest.min(world.state.q[2]);
        }
        assert!(lowest > r - 1e-9, "it goes {:e} m into the floor", r - lowest);
        (world.state.q[2] - expected).abs()
    };
    // single errors jump with where the impact falls in its step; the worst of a few steps of nearly one size does not
    let worst = |n: u32| (0..7).map(|k| error(n + 13 * k)).fold(0.0, f64::max);
    let (coarse, fine, finest) = (worst(400), worst(4000), worst(40_000));
    assert!(fine < 0.2 * coarse && finest < 0.2 * fine, "{coarse:e} {fine:e} {finest:e}");
    assert!(finest < 1e-3, "{finest:e}");
}

#[test]
fn friction_only_takes_energy_at_every_point_at_every_instant() {
    let m = material(0.4, 0.3);
    let model = on_a_plane(Shape::Cuboid { size: [0.2, 0.14, 0.1] }, 0.1, m, m);
    let mut x = placed(&model, 0.1, 0.3);
    Quat::exp(Vec3([0.5, -0.3, 0.2])).write(&mut x.q[3..7]);
    x.v.copy_from_slice(&[3.0, -5.0, 2.0, 0.5, 0.2, 0.0]);
    let mut world = World::new(model, x, MethodKind::DormandPrince, 1e-10, 1e-3);
    world.initialize(0.0);
    let mut slips = 0;
    for k in 0..150 {
        world.advance(0.01 * f64::from(k), 0.01).unwrap();
        let seen = world.observe(0.0);
        let (q, v) = (&seen.state.q, &seen.state.v);
        let rot = Quat { w: q[3], xyz: Vec3([q[4], q[5], q[6]]) }.matrix();
        let (w, lin) = (rot.mul_vec(Vec3([v[0], v[1], v[2]])), rot.mul_vec(Vec3([v[3], v[4], v[5]])));
        for point in seen.contacts() {
            let velocity = lin + w.cross(point.point - Vec3([q[0], q[1], q[2]]));
            let press = point.normal.dot(point.force);
            let friction = point.force - point.normal.scale(press);
            let power = friction.dot(velocity);
            assert!(power <= 1e-9, "tick {k}: friction gives {power:e} W");
            assert!(friction.norm() <= 0.4 * press * (1.0 + 1e-9), "tick {k}: outside the cone");
            slips += u32::from(power < -1e-6);
        }
    }
    assert!(slips > 5, "{slips}");
}

#[test]
fn a_club_that_turns_about_the_origin_does_not_pass_through_a_ball_at_velocity_level() {
    // the club's head goes 0.1 m a step, the two are 0.08 m thick together
    let (speed, radius, step) = (20.0, 0.02, 5e-3);
    let mut b = ModelBuilder::new([0.0; 3]);
    let along_z = JointSpec::new(JointKind::Revolute { axis: [0.0, 0.0, 1.0] });
    let hinge = b.joint("hinge", NodeId::WORLD, Pose::identity(), along_z);
    let head = Shape::Sphere { radius };
    let at = Pose { pos: Vec3([1.0, 0.0, 0.0]), ..Pose::identity() };
    let club = b.body("club", hinge, at, BodySpec { mass: head.mass_properties(8000.0) });
    b.collider(club, Pose::identity(), Surface::Solid(head), material(0.0, 0.0));
    let free = b.joint("free", NodeId::WORLD, Pose::identity(), JointSpec::new(JointKind::Free));
    let ball = b.body("ball", free, Pose::identity(), BodySpec { mass: head.mass_properties(1000.0) });
    b.collider(ball, Pose::identity(), Surface::Solid(head), material(0.0, 0.0));
    let model = b.build().unwrap().0;
    for phase in [0.0, 0.3, 0.6, 0.9] {
        let mut x = State::new(&model);
        let place = Quat::exp(Vec3([0.0, 0.0, 0.5 + 0.1 * phase])).matrix().col(0);
        x.q[1..4].copy_from_slice(&place.0);
        Quat::identity().write(&mut x.q[4..8]);
        x.v[0] = speed;
        let mut world = World::new(model.clone(), x, MethodKind::SemiImplicitEuler, 1e-9, 1e-3);
        let mut nearest = f64::INFINITY;
        for _ in 0..10 {
            run(&mut world, step, 1);
            let q = &world.state.q;
            let club = Quat::exp(Vec3([0.0, 0.0, q[0]])).matrix().col(0);
            nearest = nearest.min((Vec3([q[1], q[2], q[3]]) - club).norm() - 2.0 * radius);
        }
        // a light ball struck by a heavy club without bounce goes with it, along the tangent
        let fast = Vec3([world.state.v[4], world.state.v[5], world.state.v[6]]).norm();
        assert!(fast > 0.8 * speed * 8.0 / 9.0, "{phase}: {fast} m/s");
        assert!(nearest > -2e-3, "{phase}: {nearest} m");
    }
}
