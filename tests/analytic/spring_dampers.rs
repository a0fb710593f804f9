//! Springs, dampers and actuators between two points, against published figures and closed forms.
//!
//! TS2, TS3 and TS4 are the cases of Project Chrono's unit tests of spring–dampers with the results of MSC ADAMS (six
//! digits); Andrews' mechanism is the problem of the IVP/DAE test set with its published end state; the governor is the
//! stiff benchmark of the IFToMM library, with figures of an independent integration.

use std::sync::Arc;

use sincro_dynamics::actuation::force_law::FreeRange;
use sincro_dynamics::actuation::{ForceLaw, ForceTable, NonlinearLaw};
use sincro_dynamics::batch::{BatchSettings, BatchWorld, advance, advance_alone};
use sincro_dynamics::constraint::LoopJointKind;
use sincro_dynamics::energy::energy_at;
use sincro_dynamics::joint::JointKind;
use sincro_dynamics::kinematics;
use sincro_dynamics::model::{
    BodySpec, JointSpec, LoopJointSpec, MassProperties, Model, ModelBuilder, NodeId, PathSpec, SpringDamperSpec,
};
use sincro_dynamics::spatial::{Pose, Quat, Vec3};
use sincro_dynamics::state::State;
use sincro_dynamics::stiffness::{StiffElement, stiffest};
use sincro_dynamics::world::{MethodKind, World};
use sincro_math::expression::Expression;
use sincro_math::random::SplitMix64;

use crate::mechanisms::{ALL, run};

fn linear(stiffness: f64, damping: f64) -> ForceLaw<f64> {
    ForceLaw { stiffness, damping, preload: 0.0, nonlinear: None }
}

fn formula(text: &str) -> ForceLaw<f64> {
    let formula = Expression::parse(text, &["x", "v"]).unwrap();
    ForceLaw { nonlinear: Some(Arc::new(NonlinearLaw::formula(formula).unwrap())), ..linear(0.0, 0.0) }
}

fn between(a: (NodeId, [f64; 3]), b: (NodeId, [f64; 3]), law: ForceLaw<f64>) -> SpringDamperSpec {
    let path = PathSpec::Points(vec![a, b]);
    SpringDamperSpec { path, free_length: None, law, tension_only: false, actuator: None, activation: None }
}

fn at(p: [f64; 3]) -> Pose<f64> {
    Pose::translation(Vec3(p))
}

fn point_mass(mass: f64, center_of_mass: [f64; 3]) -> BodySpec {
    inertial(mass, center_of_mass, [0.0; 3])
}

fn inertial(mass: f64, center_of_mass: [f64; 3], moments: [f64; 3]) -> BodySpec {
    let [x, y, z] = moments;
    BodySpec { mass: MassProperties { mass, center_of_mass, inertia: [x, 0.0, 0.0, y, 0.0, z] } }
}

/// The pendulum of the cases: 1 kg, inertia along a bar of 4 m along x, on a free joint whose frame is its centre of
/// mass at `com`, turned by `turn`; a spring from `ground` to `point` of the bar.
fn bar(
    com: [f64; 3],
    turn: Vec3<f64>,
    ground: [f64; 3],
    point: [f64; 3],
    law: ForceLaw<f64>,
) -> (Model<f64>, State<f64>) {
    let mut b = ModelBuilder::new([0.0, 0.0, -9.80665]);
    let free = b.joint("free", NodeId::WORLD, Pose::identity(), JointSpec::new(JointKind::Free));
    let bar = b.body("bar", free, Pose::identity(), inertial(1.0, [0.0; 3], [0.04, 0.1, 0.1]));
    b.spring_damper("spring", between((NodeId::WORLD, ground), (bar, point), law));
    let mut model = b.build().unwrap().0;
    let mut x = State::new(&model);
    x.q[..3].copy_from_slice(&com);
    Quat::exp(turn).write(&mut x.q[3..]);
    let start = Pose { rot: Quat::exp(turn).matrix(), pos: Vec3(com) };
    model.set_free_length(0, (start.point(Vec3(point)) - Vec3(ground)).norm());
    (model, x)
}

/// Position of the centre of mass, angular velocity, force of the spring on the ground, world axes.
fn seen(world: &mut World) -> [Vec3<f64>; 3] {
    let (x, model) = (world.state.clone(), world.model().clone());
    let scratch = world.mechanism().scratch();
    kinematics::motions(&model, &x.q, &x.v, &x.v, scratch);
    let element = &model.spring_dampers()[0];
    let line = element.segments()[0].line(|link| (scratch.twist(link), scratch.link_poses()[link]));
    let force = element.forces(line.length, line.rate, &[]).total();
    let turn = scratch.link_poses()[0].rot;
    [Vec3([x.q[0], x.q[1], x.q[2]]), turn.mul_vec(Vec3([x.v[0], x.v[1], x.v[2]])), line.direction.scale(-force)]
}

/// Runs to each instant and compares with the figures, each to `tolerance` of the largest component.
fn compare(model: &Model<f64>, x: &State<f64>, expected: &[(u32, [[f64; 3]; 3], f64)]) {
    for kind in [MethodKind::DormandPrince, MethodKind::DormandPrince8, MethodKind::Stiff] {
        let mut world = World::new(model.clone(), x.clone(), kind, 1e-10, 1e-3);
        let mut done = 0;
        for (seconds, figures, tolerance) in expected {
            for k in done..100 * seconds {
                world.advance(f64::from(k) * 0.01, 0.01).unwrap();
            }
            done = 100 * seconds;
            for (what, (found, figure)) in seen(&mut world).iter().zip(figures).enumerate() {
                let difference = (*found - Vec3(*figure)).norm();
                let scale = Vec3(*figure).norm().max(1.0);
                assert!(difference < tolerance * scale, "{kind:?} {seconds} s, {what}: {found:?} for {figure:?}");
            }
        }
    }
}

#[test]
fn a_linear_spring_and_damper_moves_as_that_of_adams() {
    let (model, x) = bar([0.0, 2.0, 0.0], Vec3::zero(), [0.0; 3], [0.0; 3], linear(100.0, 5.0));
    let o = [0.0; 3];
    compare(
        &model,
        &x,
        &[
            (1, [[0.0, -0.597_327, -2.18907], o, [0.0, -6.94731, -25.4603]], 2e-5),
            (5, [[0.0, -1.94520, -0.767_401], o, [0.0, -6.49326, -2.56166]], 2e-5),
        ],
    );
}

#[test]
fn a_nonlinear_spring_moves_as_that_of_adams() {
    let law = formula("-50*x - 10*abs(x)*x - 5*v");
    let (model, x) = bar([-1.0, 4.0, 3.0], Vec3::zero(), [1.0, 2.0, 3.0], [2.0, 0.0, 0.0], law);
    compare(
        &model,
        &x,
        &[
            (1, [[-0.526_662, 3.48692, -1.04642], [-5.97321, 2.03366, 1.71560], [-15.5234, 13.8286, -29.1612]], 2e-5),
            // a spatial motion that amplifies differences: six digits of the start are three here
            (5, [[-1.44492, 4.41956, 1.32242], [-2.71826, 0.016_184, 1.61252], [-1.55689, 1.06010, -0.331_531]], 1e-3),
        ],
    );
}

#[test]
fn a_bar_on_a_nonlinear_spring_moves_as_that_of_adams() {
    let law = formula("-50*x - 10*abs(x)*x - 5*v");
    let turn = Vec3([0.0, 0.0, -core::f64::consts::FRAC_PI_2]);
    let (model, x) = bar([0.0, 4.0, 0.0], turn, [0.0; 3], [2.0, 0.0, 0.0], law);
    let figures = [[0.0, 2.10074, -3.87481], [-2.85594, 0.0, 0.0], [0.0, 11.4057, -21.4882]];
    compare(&model, &x, &[(1, figures, 2e-5)]);
}

/// Andrews' squeezing mechanism: three loops closed in E by points, a spring from C to D, a constant torque.
fn andrews() -> (Model<f64>, State<f64>) {
    let (rr, d, ss, e, zt, zf, u) = (0.007, 0.028, 0.035, 0.02, 0.04, 0.02, 0.04);
    let mut b = ModelBuilder::new([0.0; 3]);
    let revolute = || JointSpec::new(JointKind::Revolute { axis: [0.0, 0.0, 1.0] });
    let a = [-0.06934, -0.00227, 0.0];
    let mut body = |name: &str, parent: NodeId, place: [f64; 3], com: [f64; 2], mass: f64, inertia: f64| {
        let mut spec = revolute();
        if name == "k1" {
            spec.torque = vec![sincro_dynamics::signal::Signal::Constant(0.033)];
        }
        let joint = b.joint(&format!("{name}.joint"), parent, at(place), spec);
        b.body(name, joint, Pose::identity(), inertial(mass, [com[0], com[1], 0.0], [inertia; 3]))
    };
    let k1 = body("k1", NodeId::WORLD, [0.0; 3], [0.00092, 0.0], 0.04325, 2.194e-6);
    let k2 = body("k2", k1, [rr, 0.0, 0.0], [-0.0115, 0.0], 0.00365, 4.410e-7);
    let k3 = body("k3", NodeId::WORLD, [-0.03635, 0.03273, 0.0], [0.01043, -0.01874], 0.02373, 5.255e-6);
    let k5 = body("k5", NodeId::WORLD, a, [0.02308, 0.00916], 0.07050, 1.169e-5);
    let k4 = body("k4", k5, [zt, 0.0, 0.0], [0.0, -(e - 0.01421)], 0.00706, 5.667e-7);
    let k7 = body("k7", NodeId::WORLD, a, [0.00449, -0.01228], 0.05498, 1.912e-5);
    let k6 = body("k6", k7, [0.0, -u, 0.0], [zf - 0.01421, 0.0], 0.00706, 5.667e-7);
    let in_k3 = at([0.0, -ss, 0.0]);
    for (name, link, place) in [("k2", k2, [-d, 0.0, 0.0]), ("k4", k4, [0.0, -e, 0.0]), ("k6", k6, [zf, 0.0, 0.0])] {
        let poses = [at(place), in_k3];
        b.loop_joint(name, LoopJointSpec { kind: LoopJointKind::Point, ends: [link, k3], poses });
    }
    let spring = between((NodeId::WORLD, [0.014, 0.072, 0.0]), (k3, [0.02, -0.018, 0.0]), linear(4530.0, 0.0));
    b.spring_damper("spring", SpringDamperSpec { free_length: Some(0.07785), ..spring });
    let model = b.build().unwrap().0;
    let mut x = State::new(&model);
    // β, Θ; γ; δ, Φ; ε, Ω in the order of the bodies
    x.q.copy_from_slice(&[
        -0.061_713_890_014_276_45,
        0.0,
        0.455_279_819_163_070_4,
        0.487_364_979_543_842_55,
        0.222_668_390_165_885_9,
        1.230_547_444_549_821_2,
        -0.222_668_390_165_885_9,
    ]);
    (model, x)
}

fn total(world: &mut World) -> f64 {
    let (q, v) = (world.state.q.clone(), world.state.v.clone());
    let model = world.model().clone();
    energy_at(&model, &q, &v, world.mechanism().scratch()).total()
}

#[test]
fn andrews_mechanism_ends_where_the_test_set_says() {
    let (model, x) = andrews();
    let published = [
        15.810_771_196_299_04,
        -15.756_371_059_842_98,
        0.040_822_240_130_731_01,
        0.524_409_965_880_530_4,
        -0.534_730_116_322_694_8,
        1.048_080_741_042_263,
        0.534_730_116_322_694_8,
    ];
    for (kind, tolerance) in [(MethodKind::DormandPrince, 1e-7), (MethodKind::Stiff, 1e-6)] {
        let mut world = World::new(model.clone(), x.clone(), kind, 1e-12, 1e-5);
        let start = total(&mut world);
        run(&mut world, 1e-4, 300);
        for (q, published) in world.state.q.iter().zip(published) {
            assert!((q - published).abs() < tolerance, "{kind:?}: {q} for {published}");
        }
        let balance = total(&mut world) - start - world.state.totals[0];
        assert!(balance.abs() < 1e-9, "{kind:?}: {balance:e} J");
        // the torque is constant
        let work = 0.033 * (world.state.q[0] - x.q[0]);
        assert!((world.state.totals[0] - work).abs() < 1e-9);
    }
}

#[test]
fn implicit_steps_with_loops_are_of_second_order() {
    let (model, x) = andrews();
    let error = |h: f64| {
        let mut world = World::new(model.clone(), x.clone(), MethodKind::Implicit, 1e-9, h);
        run(&mut world, h, (0.005 / h).round() as u32);
        (world.state.q[0] - 0.211_076_385_9).abs()
    };
    let (coarse, fine) = (error(2e-5), error(1e-5));
    assert!(coarse < 1e-4 && coarse / fine > 3.5, "{coarse:e} {fine:e}");
}

/// The stiff flyball governor: shaft, slider, two rods with balls, two spring-dampers.
fn governor() -> (Model<f64>, State<f64>) {
    let mut b = ModelBuilder::new([0.0, 0.0, -9.81]);
    let shaft = b.joint(
        "shaft",
        NodeId::WORLD,
        Pose::identity(),
        JointSpec::new(JointKind::Revolute { axis: [0.0, 0.0, 1.0] }),
    );
    let thin = |mass: f64, length: f64| mass * (length * length + 1e-4) / 12.0;
    let shaft =
        b.body("shaft.body", shaft, Pose::identity(), inertial(0.3, [0.0; 3], [thin(0.3, 1.0), thin(0.3, 1.0), 5e-6]));
    let slide =
        b.joint("slide", shaft, Pose::identity(), JointSpec::new(JointKind::Prismatic { axis: [0.0, 0.0, 1.0] }));
    let slider = b.body("slider", slide, Pose::identity(), inertial(3.0, [0.0; 3], [0.005; 3]));
    for (name, side) in [("right", 1.0), ("left", -1.0)] {
        // a positive angle lowers the rod
        let hinge = JointSpec::new(JointKind::Revolute { axis: [0.0, side, 0.0] });
        let hinge = b.joint(&format!("{name}.hinge"), shaft, at([side * 0.05, 0.0, 1.0]), hinge);
        let moments = [5e-6, thin(0.3, 1.0), thin(0.3, 1.0)];
        let rod = b.body(name, hinge, Pose::identity(), inertial(0.3, [side * 0.5, 0.0, 0.0], moments));
        b.body(&format!("{name}.ball"), hinge, Pose::identity(), point_mass(5.0, [side, 0.0, 0.0]));
        let ends = ((slider, [side * 0.05, 0.0, 0.0]), (rod, [side * 0.5, 0.0, 0.0]));
        let spring = between(ends.0, ends.1, linear(8e5, 4e4));
        b.spring_damper(&format!("{name}.spring"), SpringDamperSpec { free_length: Some(0.5), ..spring });
    }
    let model = b.build().unwrap().0;
    let mut x = State::new(&model);
    let angle = core::f64::consts::FRAC_PI_6;
    x.q.copy_from_slice(&[0.0, 0.5, angle, angle]);
    x.v[0] = core::f64::consts::TAU;
    (model, x)
}

#[test]
fn the_stiff_governor_runs_at_steps_of_a_millisecond() {
    // slider [m], rod below horizontal [deg], shaft [rad/s]
    let figures = [
        (0.1, 0.523_836_476, 28.428_668_60, 6.103_717_809),
        (0.2, 0.585_079_812, 24.506_577_65, 5.722_380_646),
        (0.5, 0.743_249_425, 14.867_760_98, 5.103_415_422),
        (1.0, 0.501_420_922, 29.898_845_79, 6.271_125_742),
        (2.0, 0.505_909_294, 29.602_655_02, 6.236_223_614),
        (3.0, 0.513_246_078, 29.120_323_65, 6.180_672_706),
        (5.0, 0.535_563_104, 27.666_675_27, 6.022_496_500),
        (7.0, 0.565_938_158, 25.718_439_58, 5.830_800_911),
        (10.0, 0.619_622_917, 22.349_576_81, 5.548_203_623),
    ];
    let (model, x) = governor();
    let stiffness = stiffest(&model, &x).unwrap();
    assert!(matches!(stiffness.element, StiffElement::SpringDamper(_)));
    // c/m of one line alone: 4e4 N·s/m on 8.3 kg
    assert!((stiffness.rate - 4e4 / stiffness.inertia).abs() < 0.01 * stiffness.rate, "{stiffness:?}");
    for (kind, tolerance) in [(MethodKind::Implicit, 1e-4), (MethodKind::Stiff, 1e-6)] {
        let mut world = World::new(model.clone(), x.clone(), kind, 1e-10, 1e-3);
        let (start, mut done) = (total(&mut world), 0);
        for (t, slider, rod, speed) in figures {
            let end = (t * 1e3_f64).round() as u32;
            for k in done..end {
                world.advance(f64::from(k) * 1e-3, 1e-3).unwrap();
            }
            done = end;
            let (q, v) = (&world.state.q, &world.state.v);
            for (found, figure) in [(q[1], slider), (q[2].to_degrees() / 50.0, rod / 50.0), (v[0] / 10.0, speed / 10.0)]
            {
                assert!((found - figure).abs() < tolerance, "{kind:?} at {t} s: {found} for {figure}");
            }
        }
        let imbalance = total(&mut world) - start - world.state.totals[0] + world.state.totals[1];
        assert!(imbalance.abs() < 10.0 * tolerance, "{kind:?}: {imbalance:e} J");
    }
}

/// Two carts on rails at an angle, joined by a line; the command of its actuator is the first one.
fn carts(law: ForceLaw<f64>, tension_only: bool, actuator: Option<f64>) -> Model<f64> {
    let mut b = ModelBuilder::new([0.2, 0.0, -0.3]);
    let mut cart = |name: &str, axis: [f64; 3], place: [f64; 3]| {
        let rail =
            b.joint(&format!("{name}.rail"), NodeId::WORLD, at(place), JointSpec::new(JointKind::Prismatic { axis }));
        b.body(name, rail, Pose::identity(), point_mass(2.0, [0.0; 3]))
    };
    let (one, two) = (cart("one", [1.0, 0.0, 0.0], [0.0; 3]), cart("two", [0.0, 1.0, 1.0], [0.5, 1.0, 0.0]));
    let line = between((one, [0.0; 3]), (two, [0.0, 0.1, 0.0]), law);
    b.spring_damper("line", SpringDamperSpec { free_length: Some(1.1), tension_only, actuator, ..line });
    b.build().unwrap().0
}

#[test]
fn every_kind_of_line_is_accounted_for() {
    let table = ForceTable::new(&[[-0.5, 60.0], [0.0, 3.0], [0.4, -30.0], [0.8, -100.0]]).unwrap();
    let table = ForceLaw { nonlinear: Some(Arc::new(NonlinearLaw::Table(table))), ..linear(5.0, 1.0) };
    // totals have no error control: a step of extrapolation that crosses a corner of a law is of first order in them
    let (smooth, cornered) = (1e-7, 1e-4);
    let laws = [
        (linear(40.0, 3.0), false, smooth),
        (ForceLaw { preload: -4.0, ..linear(40.0, 3.0) }, false, smooth),
        (formula("-30*x - 20*x^3 - 2*v"), false, smooth),
        (formula("-30*x - 20*x^3 - 2*v*abs(v)"), false, cornered),
        (table, false, cornered),
        // a damped rope that becomes taut jumps
        (linear(200.0, 0.0), true, 1e-3),
        (linear(200.0, 5.0), true, 1e-3),
        (formula("-200*x - 100*x^2 - 3*v"), true, 1e-3),
    ];
    for (law, tension_only, tolerance) in laws {
        let model = carts(law, tension_only, Some(6.0));
        let mut x = State::new(&model);
        (x.q[0], x.v[0], x.v[1], x.commands[0]) = (-0.3, -1.0, 2.0, 2.5);
        for kind in [MethodKind::DormandPrince, MethodKind::DormandPrince8, MethodKind::Stiff] {
            let mut world = World::new(model.clone(), x.clone(), kind, 1e-11, 1e-3);
            let start = total(&mut world);
            run(&mut world, 0.01, 100);
            let imbalance = total(&mut world) - start - world.state.totals[0] + world.state.totals[1];
            let law = &model.spring_dampers()[0];
            assert!(imbalance.abs() < tolerance, "{kind:?} {law:?} {imbalance:e}");
            let damped = model.spring_dampers()[0].forces(1.3, 1.0, &x.commands).damping != 0.0;
            assert_eq!(world.state.totals[1] > 0.01, damped, "{law:?}");
        }
    }
}

#[test]
fn the_stiff_method_sees_a_jump_behind_its_last_stage() {
    // what flies freely is exact in long steps, at whose ends no stage is
    let range = FreeRange { low: -0.6, high: 0.1, stiffness: 200.0, damping: 5.0 };
    let ranges = ForceLaw { nonlinear: Some(Arc::new(NonlinearLaw::Ranges(vec![range]))), ..linear(0.0, 0.0) };
    let laws = [
        (linear(200.0, 5.0), true),
        (formula("if(x > 0.05, -200*x - 5*v, 0)"), false),
        (formula("-200*max(x, 0) - 3*sign(max(x, 0))*v"), false),
        (ranges, false),
    ];
    let mut random = SplitMix64::new(7);
    let mut between = |low: f64, high: f64| low + (high - low) * random.unit();
    for (law, tension_only) in laws {
        let model = carts(law, tension_only, None);
        for _ in 0..10 {
            let mut x = State::new(&model);
            (x.q[0], x.v[0], x.v[1]) = (between(-0.3, 0.0), between(-1.0, 0.0), between(0.5, 2.0));
            let end = |kind, accuracy| {
                let mut world = World::new(model.clone(), x.clone(), kind, accuracy, 1e-3);
                run(&mut world, 0.01, 60);
                world.state.v
            };
            let (exact, found) = (end(MethodKind::DormandPrince8, 1e-13), end(MethodKind::Stiff, 1e-10));
            let error = found.iter().zip(&exact).fold(0.0, |e: f64, (a, b)| e.max((a - b).abs()));
            let law = &model.spring_dampers()[0].law;
            assert!(error < 2e-8, "{law:?} {x:?} {error:e}");
        }
    }
}

#[test]
fn every_method_finds_the_same_motion() {
    let model = carts(linear(400.0, 30.0), false, None);
    let mut x = State::new(&model);
    (x.q[0], x.v[1]) = (-0.3, 2.0);
    let end = |kind: MethodKind, h: f64| {
        let mut world = World::new(model.clone(), x.clone(), kind, 1e-11, h);
        run(&mut world, h, (0.5 / h).round() as u32);
        world.state.q
    };
    let exact = end(MethodKind::DormandPrince, 1e-3);
    for (kind, order) in ALL.into_iter().zip([1, 4, 2, 5, 8]) {
        let error = |h: f64| end(kind, h).iter().zip(&exact).fold(0.0, |e: f64, (a, b)| e.max((a - b).abs()));
        let (coarse, fine) = (error(1e-3), error(5e-4));
        assert!(fine < if order == 1 { 2e-3 } else { 2e-5 }, "{kind:?} {fine:e}");
        let shrinks = f64::from(1 << order.min(2)) * 0.85;
        assert!(fine < 1e-9 || coarse / fine > shrinks, "{kind:?} {coarse:e} {fine:e}");
    }
}

#[test]
fn a_rope_never_pushes_and_its_actuator_is_limited() {
    let rope = &carts(linear(200.0, 50.0), true, None).spring_dampers()[0].clone();
    assert_eq!(rope.forces(1.0, -3.0, &[]).total(), 0.0);
    assert_eq!(rope.forces(1.0, 3.0, &[]).total(), 0.0);
    assert_eq!(rope.forces(1.2, -3.0, &[]).total(), 0.0);
    assert!((rope.forces(1.2, 0.0, &[]).total() + 20.0).abs() < 1e-12);
    assert_eq!((rope.potential(1.0), rope.implicit_terms(1.0, 0.0)), (0.0, (0.0, 0.0)));
    assert!((rope.potential(1.2) - 1.0).abs() < 1e-13);
    let driven = &carts(linear(0.0, 0.0), false, Some(6.0)).spring_dampers()[0].clone();
    assert_eq!(driven.forces(1.0, 0.0, &[2.5]).total(), 2.5);
    assert_eq!(driven.forces(1.0, 0.0, &[-9.0]).total(), -6.0);
}

#[test]
fn points_that_coincide_feel_no_force() {
    let model = carts(linear(200.0, 50.0), false, None);
    let element = &model.spring_dampers()[0];
    let pose = Pose::identity();
    let twist = sincro_dynamics::spatial::Motion::zero();
    let mut segment = element.segments()[0];
    segment.ends[1].position = segment.ends[0].position;
    let line = segment.line(|_| (twist, pose));
    assert_eq!(segment.wrench(1, &line, element.forces(line.length, line.rate, &[]).total(), &pose).lin, Vec3::zero());
}

#[test]
fn lanes_have_the_bits_of_single_worlds() {
    let models: Vec<Model<f64>> =
        (0..4).map(|k| carts(linear(400.0 + 100.0 * f64::from(k), 30.0), false, Some(4.0))).collect();
    let states: Vec<State<f64>> = (0..4)
        .map(|k| {
            let mut x = State::new(&models[k]);
            (x.q[0], x.v[1], x.commands[0]) = (-0.3, 2.0 - 0.1 * k as f64, 1.0);
            x
        })
        .collect();
    for kind in [MethodKind::Rk4, MethodKind::Implicit, MethodKind::SemiImplicitEuler] {
        let settings = BatchSettings { method: kind, h: 1e-3, n_steps: 50, record_every: 0 };
        let start = || -> Vec<BatchWorld> {
            models.iter().zip(&states).map(|(model, x)| BatchWorld::new(model.clone(), x.clone())).collect()
        };
        let (mut together, mut alone) = (start(), start());
        advance(&mut together, &settings).unwrap();
        alone.iter_mut().for_each(|world| advance_alone(world, &settings));
        for (one, other) in together.iter().zip(&alone) {
            assert_eq!(one.state.q, other.state.q, "{kind:?}");
            assert!(one.state.q[0] != states[0].q[0]);
        }
    }
}

#[test]
fn numbers_that_cannot_be_are_refused_by_name() {
    let refused = |change: &dyn Fn(&mut SpringDamperSpec)| {
        let mut b = ModelBuilder::new([0.0; 3]);
        let free = b.joint("free", NodeId::WORLD, Pose::identity(), JointSpec::new(JointKind::Free));
        let body = b.body("body", free, Pose::identity(), inertial(1.0, [0.0; 3], [0.1; 3]));
        let mut spec = between((NodeId::WORLD, [0.0; 3]), (body, [1.0, 0.0, 0.0]), linear(1.0, 0.0));
        change(&mut spec);
        b.spring_damper("cable", spec);
        b.build().unwrap_err().to_string()
    };
    fn points(spec: &mut SpringDamperSpec) -> &mut Vec<(NodeId, [f64; 3])> {
        let PathSpec::Points(points) = &mut spec.path else { panic!("a line has points") };
        points
    }
    type Change = fn(&mut SpringDamperSpec);
    let cases: [(Change, &str); 11] = [
        (|s| s.law.stiffness = -1.0, "stiffness -1 N/m of spring_damper `cable`"),
        (|s| s.law.damping = f64::NAN, "damping NaN N·s/m of spring_damper `cable`"),
        (|s| s.free_length = Some(-0.5), "free_length -0.5 m of spring_damper `cable`"),
        (|s| s.actuator = Some(-2.0), "max_force -2 N of spring_damper `cable`"),
        (|s| points(s)[1].1[2] = f64::INFINITY, "points"),
        (|s| (s.tension_only, s.law.preload) = (true, 3.0), "its preload 3 N pushes"),
        (|s| points(s)[1].0 = NodeId::WORLD, "both ends of spring_damper `cable`"),
        (|s| points(s).truncate(1), "tendon `cable` has no path"),
        (|s| points(s).push((NodeId::WORLD, [f64::NAN; 3])), "points"),
        (|s| s.path = PathSpec::Joints(Vec::new()), "the length of tendon `cable` never changes"),
        (|s| s.path = PathSpec::Joints(vec![(points(s)[1].0, 1.0)]), "tendon `cable` takes a coordinate of `body`"),
    ];
    for (change, message) in cases {
        let found = refused(&change);
        assert!(found.contains(message), "{found}");
    }
}
