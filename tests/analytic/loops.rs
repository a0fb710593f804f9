//! Stops of joints, closed loops and couplings against closed forms.

use sincro_dynamics::constraint::LoopJointKind;
use sincro_dynamics::initial;
use sincro_dynamics::joint::JointKind;
use sincro_dynamics::model::{
    BodySpec, GearSpec, JointSpec, LoopJointSpec, MassProperties, Model, ModelBuilder, NodeId, Shape,
};
use sincro_dynamics::signal::Signal;
use sincro_dynamics::spatial::{Pose, Vec3};
use sincro_dynamics::state::State;
use sincro_dynamics::world::{MethodKind, World};

use crate::mechanisms::{ALL, cart, run, slider};

const LOCATING: [MethodKind; 5] =
    [MethodKind::Rk4, MethodKind::Implicit, MethodKind::DormandPrince, MethodKind::DormandPrince8, MethodKind::Stiff];

#[test]
fn a_cart_bounces_between_its_stops() {
    for kind in LOCATING {
        let model = cart(2.0, JointSpec { limits: vec![(-0.5, 0.5)], limit_restitution: 0.5, ..slider() });
        let mut x = State::new(&model);
        x.v[0] = 1.0;
        let mut world = World::new(model, x, kind, 1e-9, 1e-3);
        run(&mut world, 0.01, 300);
        // 0.5 s to the upper stop, 2 s back at half the speed, then a quarter of it
        assert!((world.state.q[0] - (-0.5 + 0.25 * 0.5)).abs() < 1e-12, "{kind:?} {}", world.state.q[0]);
        assert_eq!(world.statistics().impacts, 2, "{kind:?}");
    }
}

#[test]
fn a_stop_holds_a_load_and_says_how_much() {
    for kind in ALL {
        let spec = JointSpec {
            limits: vec![(f64::NEG_INFINITY, 0.2)],
            torque: vec![sincro_dynamics::signal::Signal::Constant(3.0)],
            ..slider()
        };
        let mut world = World::new(cart(2.0, spec), State::new(&cart(2.0, slider())), kind, 1e-9, 1e-3);
        world.state = State::new(world.model());
        run(&mut world, 0.01, 100);
        assert!((world.state.q[0] - 0.2).abs() < 1e-9, "{kind:?} {}", world.state.q[0]);
        let seen = world.observe(1.0);
        assert!((seen.limit_torque(0) + 3.0).abs() < 1e-9, "{kind:?}");
    }
}

/// A slider against its stop, pressed on it with `hold` until a force `f` away from it at 0.1 s; 3 g, 120 N·s/m.
fn gripper_finger(hold: f64, f: f64) -> Model<f64> {
    let spec = JointSpec {
        limits: vec![(0.0, 0.02)],
        damping: vec![120.0],
        torque: vec![Signal::Step { time: 0.1, from: -hold, to: f }],
        ..slider()
    };
    cart(0.003, spec)
}

#[test]
fn a_stop_lets_go_of_a_heavily_damped_slider_at_once() {
    // x = f/c·(t − m/c) once the transient of 25 µs is over; a step of 20 ms is 800 times that
    let expected = 0.6 / 120.0 * (0.04 - 0.003 / 120.0);
    for (kind, tolerance) in [(MethodKind::DormandPrince, 1e-9), (MethodKind::Stiff, 1e-7)] {
        for accuracy in [1e-6, 1e-7, 1e-8] {
            let model = gripper_finger(0.3, 0.6);
            let mut world = World::new(model.clone(), State::new(&model), kind, accuracy, 1e-3);
            run(&mut world, 0.02, 7);
            let found = world.state.q[0];
            assert!((found - expected).abs() < tolerance, "{kind:?} {accuracy:e}: {found} is not {expected}");
        }
    }
}

/// A point mass on two coordinates that a distance closure makes a pendulum.
fn pendulum(length: f64) -> (Model<f64>, State<f64>) {
    let mut b = ModelBuilder::new([0.0, 0.0, -9.81]);
    let along = |axis| JointSpec { armature: vec![1e-300], ..JointSpec::new(JointKind::Prismatic { axis }) };
    let x = b.joint("x", NodeId::WORLD, Pose::identity(), along([1.0, 0.0, 0.0]));
    let z = b.joint("z", x, Pose::identity(), along([0.0, 0.0, 1.0]));
    let mass = MassProperties { mass: 1.0, center_of_mass: [0.0; 3], inertia: [0.0; 6] };
    let bob = b.body("bob", z, Pose::identity(), BodySpec { mass });
    let spec = LoopJointSpec {
        kind: LoopJointKind::Distance(length),
        ends: [bob, NodeId::WORLD],
        poses: [Pose::identity(), Pose::identity()],
    };
    b.loop_joint("string", spec);
    let model = b.build().unwrap().0;
    let mut x = State::new(&model);
    x.q[0] = length * libm::sin(1.0);
    x.q[1] = -length * libm::cos(1.0);
    (model, x)
}

/// The same pendulum with a hinge.
fn hinged(length: f64) -> (Model<f64>, State<f64>) {
    let mut b = ModelBuilder::new([0.0, 0.0, -9.81]);
    let hinge = JointSpec::new(JointKind::Revolute { axis: [0.0, -1.0, 0.0] });
    let hinge = b.joint("hinge", NodeId::WORLD, Pose::identity(), hinge);
    let mass = MassProperties { mass: 1.0, center_of_mass: [0.0; 3], inertia: [0.0; 6] };
    b.body("bob", hinge, Pose::translation(Vec3([0.0, 0.0, -length])), BodySpec { mass });
    let model = b.build().unwrap().0;
    let mut x = State::new(&model);
    x.q[0] = 1.0;
    (model, x)
}

#[test]
fn a_closed_loop_keeps_the_order_of_the_integrator_and_does_not_drift() {
    let exact = {
        let (model, x) = hinged(0.8);
        let mut world = World::new(model, x, MethodKind::DormandPrince, 1e-13, 1e-3);
        run(&mut world, 0.01, 300);
        0.8 * libm::sin(world.state.q[0])
    };
    let error = |kind: MethodKind, n: u32| {
        let (model, x) = pendulum(0.8);
        let mut world = World::new(model, x, kind, 1e-12, 1e-3);
        world.initialize(0.0);
        let mut worst = 0.0_f64;
        for k in 0..n {
            world.advance(3.0 / f64::from(n) * f64::from(k), 3.0 / f64::from(n)).unwrap();
            let open = initial::constraint_residuals(world.model(), &world.state)[0].distance;
            worst = worst.max(open);
        }
        assert!(worst < 1e-10, "{kind:?} drifts {worst:e}");
        (world.state.q[0] - exact).abs()
    };
    assert!(error(MethodKind::DormandPrince, 300) < 1e-9);
    assert!(error(MethodKind::Stiff, 300) < 1e-9);
    for (kind, order) in [(MethodKind::Rk4, 4.0), (MethodKind::Implicit, 2.0), (MethodKind::SemiImplicitEuler, 1.0)] {
        let measured = libm::log2(error(kind, 300) / error(kind, 600));
        assert!(measured > order - 0.25, "{kind:?}: order {measured}");
    }
}

#[test]
fn a_coupling_makes_two_shafts_one() {
    // I1 + ratio² I2 under a torque
    let mut b = ModelBuilder::new([0.0; 3]);
    let wheel = |i: f64| BodySpec {
        mass: MassProperties { mass: 1.0, center_of_mass: [0.0; 3], inertia: [i, 0.0, 0.0, i, 0.0, i] },
    };
    let shaft = |torque: f64| JointSpec {
        torque: vec![sincro_dynamics::signal::Signal::Constant(torque)],
        ..JointSpec::new(JointKind::Revolute { axis: [0.0, 0.0, 1.0] })
    };
    let one = b.joint("one", NodeId::WORLD, Pose::identity(), shaft(2.0));
    b.body("first", one, Pose::identity(), wheel(0.3));
    let two = b.joint("two", NodeId::WORLD, Pose::translation(Vec3([1.0, 0.0, 0.0])), shaft(0.0));
    b.body("second", two, Pose::identity(), wheel(0.05));
    b.gear("gear", GearSpec { joints: [one, two], ratio: -3.0, offset: 0.0, higher: [0.0; 3] });
    let model = b.build().unwrap().0;
    for kind in LOCATING {
        let mut world = World::new(model.clone(), State::new(&model), kind, 1e-10, 1e-3);
        run(&mut world, 0.01, 100);
        let a = 2.0 / (0.3 + 9.0 * 0.05);
        assert!((world.state.q[0] - 0.5 * a).abs() < 1e-9, "{kind:?}");
        assert!((world.state.q[1] + 3.0 * world.state.q[0]).abs() < 1e-12, "{kind:?}");
    }
}

#[test]
fn redundant_equations_are_counted() {
    // a plane four-bar linkage closed by a hinge: 5 equations, 3 of them redundant
    let mut b = ModelBuilder::new([0.0, 0.0, -9.81]);
    let hinge = || JointSpec::new(JointKind::Revolute { axis: [0.0, 1.0, 0.0] });
    let bar = || BodySpec { mass: Shape::Cuboid { size: [0.02, 0.02, 1.0] }.mass_properties(1000.0) };
    let up = Pose::translation(Vec3([0.0, 0.0, 0.5]));
    let left = b.joint("left", NodeId::WORLD, Pose::identity(), hinge());
    b.body("rod", left, up, bar());
    let top = b.joint("top", left, Pose::translation(Vec3([0.0, 0.0, 1.0])), hinge());
    b.body("coupler", top, Pose::translation(Vec3([0.5, 0.0, 0.0])), bar());
    let right = b.joint("right", NodeId::WORLD, Pose::translation(Vec3([1.0, 0.0, 0.0])), hinge());
    b.body("other", right, up, bar());
    let end = b.frame("end", top, Pose::translation(Vec3([1.0, 0.0, 0.0])));
    let tip = b.frame("tip", right, Pose::translation(Vec3([0.0, 0.0, 1.0])));
    let turn = sincro_dynamics::spatial::Mat3::rotation::<0>(-1.0, 0.0);
    let pose = Pose { rot: turn, pos: Vec3::zero() };
    b.loop_joint("pin", LoopJointSpec { kind: LoopJointKind::Hinge, ends: [end, tip], poses: [pose, pose] });
    let model = b.build().unwrap().0;
    let freedom = initial::mobility(&model, &State::new(&model));
    assert_eq!((freedom.tree_dofs, freedom.equations, freedom.redundant, freedom.dofs()), (3, 5, 3, 1));
}

/// N-four-bar of `n` loops: vertical rods of 1 m and 1 kg on the ground 1 m apart, joined by horizontal ones at their
/// tops, which move at 1 m/s. Source: IFToMM benchmark A02, key `iftomm-a02`.
fn four_bars(n: usize) -> (Model<f64>, State<f64>) {
    let mut b = ModelBuilder::new([0.0, -9.81, 0.0]);
    let hinge = || JointSpec::new(JointKind::Revolute { axis: [0.0, 0.0, 1.0] });
    let rod = |x: f64, y: f64| {
        let inertia = [y * y / 3.0, 0.0, 0.0, x * x / 3.0, 0.0, 1.0 / 12.0];
        BodySpec { mass: MassProperties { mass: 1.0, center_of_mass: [x, y, 0.0], inertia } }
    };
    let (top, end) = (Vec3([0.0, 1.0, 0.0]), Vec3([1.0, 0.0, 0.0]));
    let mut tops = Vec::new();
    for k in 0..=n {
        let at = Pose::translation(Vec3([k as f64, 0.0, 0.0]));
        let vertical = b.joint(&format!("v{k}"), NodeId::WORLD, at, hinge());
        b.body(&format!("vertical{k}"), vertical, Pose::identity(), rod(0.0, 0.5));
        tops.push(b.frame(&format!("top{k}"), vertical, Pose::translation(top)));
        if k < n {
            let horizontal = b.joint(&format!("h{k}"), vertical, Pose::translation(top), hinge());
            b.body(&format!("horizontal{k}"), horizontal, Pose::identity(), rod(0.5, 0.0));
            tops.push(b.frame(&format!("end{k}"), horizontal, Pose::translation(end)));
        }
    }
    for k in 0..n {
        let ends = [tops[2 * k + 1], tops[2 * k + 2]];
        let spec = LoopJointSpec { kind: LoopJointKind::Hinge, ends, poses: [Pose::identity(), Pose::identity()] };
        b.loop_joint(&format!("pin{k}"), spec);
    }
    let model = b.build().unwrap().0;
    let mut x = State::new(&model);
    for k in 0..=n {
        let names = model.names();
        x.v[names.joint_info(names.joint_id(&format!("v{k}")).unwrap()).v_idx] = -1.0;
        if k < n {
            x.v[names.joint_info(names.joint_id(&format!("h{k}")).unwrap()).v_idx] = 1.0;
        }
    }
    (model, x)
}

/// The pendulum that moves as they do: all rods of one kind stay parallel, and the horizontal ones only shift.
fn of_four_bars(n: usize) -> (Model<f64>, State<f64>) {
    let mut b = ModelBuilder::new([0.0, -9.81, 0.0]);
    let hinge = b.joint(
        "hinge",
        NodeId::WORLD,
        Pose::identity(),
        JointSpec::new(JointKind::Revolute { axis: [0.0, 0.0, 1.0] }),
    );
    let n = n as f64;
    let (mass, first) = (2.0 * n + 1.0, 0.5 * (n + 1.0) + n);
    let about_hinge = (n + 1.0) / 3.0 + n;
    let i = about_hinge - first * first / mass;
    let mass = MassProperties { mass, center_of_mass: [0.0, first / mass, 0.0], inertia: [i, 0.0, 0.0, i, 0.0, i] };
    b.body("all", hinge, Pose::identity(), BodySpec { mass });
    let model = b.build().unwrap().0;
    let mut x = State::new(&model);
    x.v[0] = -1.0;
    (model, x)
}

fn world_of((model, x): (Model<f64>, State<f64>), method: MethodKind, accuracy: f64, tick: f64) -> World {
    World::new(model, x, method, accuracy, tick)
}

/// Angle of the first rod after 10 s `[rad]`.
fn angle((model, x): (Model<f64>, State<f64>), accuracy: f64, tick: f64) -> f64 {
    let mut world = World::new(model, x, MethodKind::DormandPrince, accuracy, tick);
    run(&mut world, tick, libm::round(10.0 / tick) as u32);
    world.state.q[0]
}

#[test]
fn four_bars_pass_their_singular_positions_on_their_branch() {
    let expected = angle(of_four_bars(2), 1e-13, 0.01);
    // the published solution
    let (x, y) = (0.328_458_111_54, 0.944_518_538_179);
    assert!(libm::hypot(-libm::sin(expected) - x, libm::cos(expected) - y) < 1e-10);
    for tick in [0.01, 0.02, 0.05, 0.1, 0.2] {
        for accuracy in [1e-6, 1e-9, 1e-11, 1e-13] {
            let error = (angle(four_bars(2), accuracy, tick) - expected).abs();
            // a thousand steps; rounding where the loops are nearly singular
            assert!(error < 1e3 * accuracy + 1e-9, "tick {tick} s, accuracy {accuracy:e}: off by {error:e} rad");
        }
    }
}

/// Time at which the rods of two four-bars lie down for the first time `[s]`: their first singular position.
fn first_singular_instant() -> f64 {
    let (mut low, mut high) = (0.5, 1.0);
    for _ in 0..50 {
        let middle = 0.5 * (low + high);
        let (model, x) = of_four_bars(2);
        let mut world = World::new(model, x, MethodKind::DormandPrince, 1e-14, middle);
        run(&mut world, middle, 1);
        let is_before = world.state.q[0] > -core::f64::consts::FRAC_PI_2;
        (low, high) = if is_before { (middle, high) } else { (low, middle) };
    }
    0.5 * (low + high)
}

#[test]
fn steps_may_end_at_singular_positions() {
    let instant = first_singular_instant();
    for off in [0.0, 1e-9, -1e-9, 1e-6, -1e-5, 1e-3] {
        for ticks in [1, 16, 71] {
            let tick = (instant + off) / f64::from(ticks);
            let n = libm::round(10.0 / tick) as u32;
            let mut exact = world_of(of_four_bars(2), MethodKind::DormandPrince, 1e-13, tick);
            run(&mut exact, tick, n);
            for method in [MethodKind::DormandPrince, MethodKind::DormandPrince8, MethodKind::Stiff] {
                for accuracy in [1e-6, 1e-9, 1e-13] {
                    let mut world = world_of(four_bars(2), method, accuracy, tick);
                    run(&mut world, tick, n);
                    let error = (world.state.q[0] - exact.state.q[0]).abs();
                    let case = format!("{method:?}, {off:e} s beside, tick {tick} s, accuracy {accuracy:e}");
                    assert!(error < 1e3 * accuracy + 1e-8, "{case}: off by {error:e} rad");
                    // the rods lie down twice a turn
                    let passed = world.passed_singularities();
                    let expected = libm::floor((-exact.state.q[0]) / core::f64::consts::PI + 0.5) as usize;
                    // steps of a tenth of a turn and more do not show every passage
                    let is_enough = if accuracy > 1e-9 { passed.count >= 1 } else { passed.count == expected };
                    assert!(is_enough, "{case}: {} of {expected} passages", passed.count);
                    // told by the step that passes it, which is longer by order 8
                    let step = if method == MethodKind::DormandPrince8 { 0.05 } else { 0.02 };
                    assert!((passed.first - instant).abs() < step, "{case}: first at {} s", passed.first);
                }
            }
        }
    }
}

#[test]
fn many_four_bars_pass_them_too() {
    let error = (angle(four_bars(40), 1e-9, 0.01) - angle(of_four_bars(40), 1e-13, 0.01)).abs();
    assert!(error < 1e-6, "off by {error:e} rad");
}
