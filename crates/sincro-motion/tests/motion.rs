//! Motion on command: closed forms, limits, arrival; random states, judged by Ruckig.

use proptest::prelude::*;
use proptest::test_runner::{Config, RngSeed};
use rsruckig::prelude as judge;
use sincro_motion::{Axis, Goal, Limits, Point, Profile, Synchronization, plan};

fn config(cases: u32) -> Config {
    Config { cases, failure_persistence: None, rng_seed: RngSeed::Fixed(7), ..Config::default() }
}

fn alone(start: Point, limits: Limits, goal: Goal) -> Profile {
    plan(&[Axis { start, limits, goal }], Synchronization::None).unwrap()[0]
}

fn at_rest(limits: Limits, way: f64) -> Profile {
    alone(Point::default(), limits, Goal::Position(way, 0.0))
}

/// Duration of the fastest motion according to the reference library `[s]`.
fn judged(axes: &[Axis], synchronization: judge::Synchronization) -> Option<f64> {
    let n = axes.len();
    let mut input = judge::InputParameter::<0>::new(Some(n));
    input.synchronization = synchronization;
    let mut low = (judge::DataArrayOrVec::new(Some(n), 0.0), judge::DataArrayOrVec::new(Some(n), 0.0));
    for (k, axis) in axes.iter().enumerate() {
        (input.current_position[k], input.current_velocity[k]) = (axis.start.p, axis.start.v);
        input.current_acceleration[k] = axis.start.a;
        match axis.goal {
            Goal::Position(p, v) => (input.target_position[k], input.target_velocity[k]) = (p, v),
            Goal::Velocity(v) => {
                input.control_interface = judge::ControlInterface::Velocity;
                input.target_velocity[k] = v;
            }
            Goal::Free => unreachable!(),
        }
        let limits = axis.limits;
        (input.max_velocity[k], input.max_acceleration[k]) = (limits.max_velocity, limits.max_acceleration);
        input.max_jerk[k] = limits.max_jerk;
        (low.0[k], low.1[k]) = (limits.min_velocity, limits.min_acceleration);
    }
    (input.min_velocity, input.min_acceleration) = (Some(low.0), Some(low.1));
    let mut ruckig = judge::Ruckig::<0, judge::ThrowErrorHandler>::new(Some(n), 0.01);
    let mut trajectory = judge::Trajectory::new(Some(n));
    ruckig.calculate(&input, &mut trajectory).ok()?;
    Some(trajectory.get_duration())
}

/// The states of a profile are one motion that keeps the limits, once it is within them.
fn is_a_motion(profile: &Profile, axis: &Axis) -> Result<(), TestCaseError> {
    let (limits, t_end) = (axis.limits, profile.duration());
    let n = 400;
    let mut before = profile.at(0.0);
    prop_assert_eq!(before, axis.start);
    let step = t_end / f64::from(n);
    let is_position = matches!(axis.goal, Goal::Position(..));
    let jerk = limits.max_jerk;
    for k in 1..=n {
        let x = profile.at(step * f64::from(k));
        let scale = 1.0 + x.p.abs() + x.v.abs() + x.a.abs();
        prop_assert!((x.a - before.a).abs() <= jerk * step * (1.0 + 1e-9) + 1e-9 * scale, "jerk at {k}");
        // the third derivative is bounded: the trapezium rule's error is
        let rest = jerk * step * step * step + 1e-8 * scale;
        prop_assert!((x.p - before.p - step * (x.v + before.v) / 2.0).abs() <= rest, "position at {k}");
        prop_assert!(
            (x.v - before.v - step * (x.a + before.a) / 2.0).abs() <= rest + jerk * step * step,
            "velocity at {k}"
        );
        let ok = |x: f64, before: f64, low: f64, high: f64| {
            let room = 1e-9 * (1.0 + high - low);
            (low - room..=high + room).contains(&x) || (before - x) * (x - (low + high) / 2.0) >= -room
        };
        prop_assert!(ok(x.a, before.a, limits.min_acceleration, limits.max_acceleration), "{x:?} after {before:?}");
        let inevitable = axis.start.v + axis.start.a * axis.start.a.abs() / (2.0 * jerk);
        let (low, high) = (limits.min_velocity.min(inevitable), limits.max_velocity.max(inevitable));
        prop_assert!(
            !is_position || ok(x.v, before.v, low.min(axis.start.v), high.max(axis.start.v)),
            "{x:?} after {before:?}"
        );
        before = x;
    }
    // what rounding leaves is dropped at the end: little, seen against the farthest that the motion goes
    let (close, end) = (profile.at(t_end * (1.0 - 1e-13)), profile.end());
    let scale = (0..=n).map(|k| profile.at(step * f64::from(k)).p.abs()).fold(1.0, f64::max);
    prop_assert!((close.p - end.p).abs() < 1e-8 * scale && (close.v - end.v).abs() < 1e-6, "{close:?} {end:?}");
    Ok(())
}

fn limits() -> impl Strategy<Value = Limits> {
    (0.3..3.0_f64, 0.3..3.0_f64, 0.5..5.0_f64, 0.5..5.0_f64, 1.0..20.0_f64).prop_map(|(v, w, a, b, j)| Limits {
        max_velocity: v,
        min_velocity: -w,
        max_acceleration: a,
        min_acceleration: -b,
        max_jerk: j,
    })
}

/// A state within limits and one that is not, and a goal.
fn axis(out: f64) -> impl Strategy<Value = Axis> {
    (limits(), -3.0..3.0_f64, -1.0..1.0_f64, -1.0..1.0_f64, -3.0..3.0_f64, prop_oneof![Just(0.0), -1.0..1.0_f64])
        .prop_map(move |(limits, p, v, a, p_end, v_end)| {
            let of = |x: f64, low: f64, high: f64| if x > 0.0 { x * high } else { -x * low };
            let start = Point {
                p,
                v: out * of(v, limits.min_velocity, limits.max_velocity),
                a: out * of(a, limits.min_acceleration, limits.max_acceleration),
            };
            let v_end = of(v_end, limits.min_velocity, limits.max_velocity);
            Axis { start, limits, goal: Goal::Position(p_end, v_end) }
        })
}

proptest! {
    #![proptest_config(config(4_000))]

    #[test]
    fn no_motion_is_faster(axis in axis(1.0)) {
        let profile = alone(axis.start, axis.limits, axis.goal);
        is_a_motion(&profile, &axis)?;
        if let Some(t) = judged(&[axis], judge::Synchronization::None) {
            prop_assert!((profile.duration() - t).abs() < 1e-6 * (1.0 + t), "{} {t}", profile.duration());
        }
    }

    #[test]
    fn what_is_out_of_its_limits_comes_back(axis in axis(2.0)) {
        let profile = alone(axis.start, axis.limits, axis.goal);
        is_a_motion(&profile, &axis)?;
        if let Some(t) = judged(&[axis], judge::Synchronization::None) {
            prop_assert!((profile.duration() - t).abs() < 1e-6 * (1.0 + t), "{} {t}", profile.duration());
        }
    }
}

#[test]
fn the_last_velocity_stays_behind_the_end() {
    let limits =
        Limits { max_velocity: 1.0, min_velocity: -1.0, max_acceleration: 2.0, min_acceleration: -2.0, max_jerk: 10.0 };
    let profile = alone(Point::default(), limits, Goal::Position(3.0, 0.5));
    let beyond = profile.at(profile.duration() + 2.0);
    assert!((beyond.p - 4.0).abs() < 1e-12 && beyond.v == 0.5 && beyond.a == 0.0, "{beyond:?}");
}

fn cube_root(x: f64) -> f64 {
    sincro_math::elementary::pow(x, 1.0 / 3.0).0
}

/// Closed form of the fastest motion from rest to rest over a way, alike both ways: seven pieces, of which some may
/// have no duration.
fn seven_pieces(way: f64, v: f64, a: f64, j: f64) -> f64 {
    // peak of the velocity if it is not limited: with and without the largest acceleration held
    let triangles = cube_root(way / (2.0 * j));
    if j * triangles <= a && j * triangles * triangles <= v {
        return 4.0 * triangles;
    }
    let held = -a * a / (2.0 * j) + (a * a / (2.0 * j) * (a * a / (2.0 * j)) + way * a).sqrt();
    if held <= v && held >= a * a / j {
        return 2.0 * (held / a + a / j);
    }
    let ramp = if v * j >= a * a { v / a + a / j } else { 2.0 * (v / j).sqrt() };
    way / v + ramp
}

#[test]
fn from_rest_to_rest_takes_what_seven_pieces_take() {
    let cases = [
        // nothing is reached; the acceleration is; both are; only the velocity is
        (0.01, 1.0, 1.0, 10.0),
        (0.5, 2.0, 1.0, 10.0),
        (5.0, 1.0, 1.0, 10.0),
        (5.0, 0.5, 10.0, 3.0),
        (std::f64::consts::PI, 110.0_f64.to_radians(), 40.0_f64.to_radians(), 80.0_f64.to_radians()),
    ];
    for (way, v, a, j) in cases {
        for sign in [1.0, -1.0] {
            let profile = at_rest(Limits::symmetric(v, a, j), sign * way);
            let t = seven_pieces(way, v, a, j);
            assert!((profile.duration() - t).abs() < 1e-12 * t, "{way} {v} {a} {j}: {} {t}", profile.duration());
            assert_eq!(profile.at(profile.duration()), Point { p: sign * way, v: 0.0, a: 0.0 });
            assert!((profile.at(t / 2.0).p - sign * way / 2.0).abs() < 1e-12 * way, "half the way in half the time");
        }
    }
}

#[test]
fn nowhere_to_go_takes_no_time() {
    let profile = at_rest(Limits::symmetric(1.0, 1.0, 1.0), 0.0);
    assert_eq!((profile.duration(), profile.at(3.0)), (0.0, Point::default()));
}

fn several(out: f64) -> impl Strategy<Value = Vec<Axis>> {
    prop::collection::vec(axis(out), 2..5)
}

fn stops(mut axes: Vec<Axis>) -> Vec<Axis> {
    axes.iter_mut().for_each(|axis| {
        if let Goal::Position(_, v) = &mut axis.goal {
            *v = 0.0;
        }
    });
    axes
}

proptest! {
    #![proptest_config(config(2_000))]

    #[test]
    fn all_have_arrived_when_the_slowest_does(axes in several(1.0).prop_map(stops)) {
        let profiles = plan(&axes, Synchronization::Time).unwrap();
        let slowest = axes.iter().map(|axis| alone(axis.start, axis.limits, axis.goal).duration()).fold(0.0, f64::max);
        for (axis, profile) in axes.iter().zip(&profiles) {
            is_a_motion(profile, axis)?;
            prop_assert_eq!(profile.at(slowest + 1e-9), profile.end());
        }
    }

    #[test]
    fn all_arrive_together_from_rest(axes in several(0.0).prop_map(stops)) {
        let profiles = plan(&axes, Synchronization::Time).unwrap();
        let slowest = axes.iter().map(|axis| alone(axis.start, axis.limits, axis.goal).duration()).fold(0.0, f64::max);
        for (axis, profile) in axes.iter().zip(&profiles) {
            is_a_motion(profile, axis)?;
            prop_assert!((profile.duration() - slowest).abs() < 1e-9, "{} {slowest} {axis:?}", profile.duration());
        }
    }

    #[test]
    fn what_is_on_a_line_stays_on_it(axes in several(1.0), factors in prop::collection::vec(-2.0..2.0_f64, 4)) {
        // all as the first, times a factor, with limits that allow it
        let first = axes[0];
        let Goal::Position(p_end, v_end) = first.goal else { unreachable!() };
        let line = |axis: &Axis, k: f64| Axis {
            start: Point { p: axis.start.p, v: k * first.start.v, a: k * first.start.a },
            goal: Goal::Position(axis.start.p + k * (p_end - first.start.p), k * v_end),
            limits: Limits::symmetric(20.0, 40.0, 100.0),
        };
        let mut all = vec![first];
        all.extend(axes[1..].iter().zip(&factors).map(|(axis, k)| line(axis, *k)));
        let profiles = plan(&all, Synchronization::Phase).unwrap();
        let alone = alone(first.start, first.limits, first.goal).duration();
        let t_end = profiles[0].duration();
        prop_assume!((t_end - alone).abs() < 1e-12);
        for (axis, profile) in all.iter().zip(&profiles) {
            is_a_motion(profile, axis)?;
        }
        for n in 0..20 {
            let lead = profiles[0].at(t_end * f64::from(n) / 20.0);
            for ((axis, profile), k) in all[1..].iter().zip(&profiles[1..]).zip(&factors) {
                let x = profile.at(t_end * f64::from(n) / 20.0);
                let room = 1e-9 * (1.0 + (lead.p - first.start.p).abs());
                prop_assert!((x.p - axis.start.p - k * (lead.p - first.start.p)).abs() < room);
                prop_assert!((x.v - k * lead.v).abs() < room && (x.a - k * lead.a).abs() < room);
            }
        }
    }

    #[test]
    fn velocities_are_reached_together(axes in several(1.0)) {
        let velocity = |axis: &Axis| {
            let Goal::Position(_, v) = axis.goal else { unreachable!() };
            Axis { goal: Goal::Velocity(v), ..*axis }
        };
        let axes: Vec<Axis> = axes.iter().map(velocity).collect();
        let profiles = plan(&axes, Synchronization::Time).unwrap();
        let slowest = axes.iter().map(|axis| alone(axis.start, axis.limits, axis.goal).duration()).fold(0.0, f64::max);
        for (axis, profile) in axes.iter().zip(&profiles) {
            is_a_motion(profile, axis)?;
            prop_assert!(profile.duration() <= slowest + 1e-9);
            prop_assert!((profile.at(slowest).v - profile.end().v).abs() < 1e-12);
        }
        let judged = judged(&axes, judge::Synchronization::Time).unwrap();
        prop_assert!((slowest - judged).abs() < 1e-9 * (1.0 + judged), "{slowest} {judged}");
    }

    #[test]
    fn all_arrive_together_with_velocities_too(axes in several(1.0)) {
        let profiles = plan(&axes, Synchronization::Time).unwrap();
        let t = profiles.iter().map(Profile::duration).fold(0.0, f64::max);
        for (axis, profile) in axes.iter().zip(&profiles) {
            is_a_motion(profile, axis)?;
            // one that is to stand there may wait there
            let waits = profile.end().v == 0.0 && profile.duration() <= t;
            prop_assert!(waits || (profile.duration() - t).abs() < 1e-9, "{} {t} {axis:?}", profile.duration());
        }
        if let Some(judged) = judged(&axes, judge::Synchronization::Time) {
            // where arriving together is possible at a few times only, ours is not always the first of them: 3 of 1000
            // of these are later, of other seeds one of 15 000 by a quarter
            prop_assert!(t > judged * (1.0 - 1e-6) && t < 1.1 * judged, "{t} {judged}");
        }
    }
}

#[test]
fn motions_with_velocities_at_their_ends_arrive_together_at_the_first_time_possible() {
    // state, limits (velocity up and down, acceleration up and down, jerk) and goal of two axes; drawn at random, and
    // kept where the corners of the families alone, without samples between them, miss the first solution, and those
    // with samples do not: of seven draws the numbers of which were rounded, four
    let cases = [
        [
            ([-0.789, -0.383, 2.305], [1.815, -1.262, 2.408, -3.033, 13.945], (-0.677, -0.420)),
            ([2.180, -1.272, 4.410], [1.502, -0.892, 4.348, -4.208, 9.675], (2.646, 1.445)),
        ],
        [
            ([-1.871, -0.169, 0.776], [1.075, -2.372, 1.277, -4.971, 13.717], (-2.175, -2.272)),
            ([1.866, 0.628, -1.813], [0.771, -1.809, 4.270, -1.462, 2.162], (0.546, -1.500)),
        ],
        [
            ([-2.436, 0.312, -1.000], [1.545, -1.112, 3.813, -0.831, 16.288], (-2.015, 1.284)),
            ([-2.625, 0.401, -1.070], [0.883, -1.414, 4.208, -1.117, 7.711], (-2.256, 0.672)),
        ],
        [
            ([2.923, -1.488, -0.037], [1.666, -2.963, 1.036, -0.740, 9.522], (1.923, -1.650)),
            ([0.447, 2.267, 5.898], [1.996, -2.693, 4.675, -4.913, 8.425], (0.331, -0.131)),
        ],
    ];
    for case in cases {
        let axes = case.map(|(start, limits, goal)| {
            let ([p, v, a], [max_velocity, min_velocity, max_acceleration, min_acceleration, max_jerk]) =
                (start, limits);
            let limits = Limits { max_velocity, min_velocity, max_acceleration, min_acceleration, max_jerk };
            Axis { start: Point { p, v, a }, limits, goal: Goal::Position(goal.0, goal.1) }
        });
        let profiles = plan(&axes, Synchronization::Time).unwrap();
        let t = profiles[0].duration();
        assert!((profiles[1].duration() - t).abs() < 1e-9, "{} {t}", profiles[1].duration());
        let judged = judged(&axes, judge::Synchronization::Time).unwrap();
        assert!((t - judged).abs() < 1e-6 * t, "{t} {judged} {axes:?}");
    }
}

#[test]
fn who_has_time_for_a_velocity_accelerates_less_then_jerks_less() {
    let limits = Limits::symmetric(2.0, 2.0, 10.0);
    let slow = Axis { start: Point::default(), limits: Limits::symmetric(2.0, 0.5, 1.0), goal: Goal::Velocity(1.0) };
    for sign in [1.0, -1.0] {
        // from rest: the peak of the acceleration is what makes it take longer, the jerk stays
        // from an acceleration that is its peak already: the jerk is less
        for a in [0.0, 1.5] {
            let start = Point { p: 0.0, v: 0.0, a: sign * a };
            let quick = Axis { start, limits, goal: Goal::Velocity(sign) };
            let [slowest, profile] = plan(&[slow, quick], Synchronization::Time).unwrap()[..] else { panic!() };
            let t = slowest.duration();
            assert!((profile.duration() - t).abs() < 1e-10, "{sign} {a}");
            let end = profile.end();
            assert!((end.v - sign).abs() < 1e-12 && end.a.abs() < 1e-12, "{sign} {a}: {end:?}");
            let points: Vec<Point> = (0..=2000).map(|k| profile.at(t * f64::from(k) / 2000.0)).collect();
            let peak = points.iter().map(|x| x.a.abs()).fold(0.0, f64::max);
            let jerk = points.windows(2).map(|x| (x[1].a - x[0].a).abs() * 2000.0 / t).fold(0.0, f64::max);
            // rest to rest with the peak a: t = v/a + a/j; both from the numbers of the slow axis
            if a == 0.0 {
                let expected = 0.5 * (10.0 * t - (100.0 * t * t - 40.0).sqrt());
                assert!((peak - expected).abs() < 1e-9 && (jerk - 10.0).abs() < 1e-6, "{peak} {expected} {jerk}");
            } else {
                assert!(peak < 2.0 && jerk < 10.0 - 1e-6, "{peak} {jerk}");
            }
        }
    }
}

#[test]
fn who_can_stay_at_no_velocity_in_between_jerks_or_accelerates_less() {
    // start, goal, limits (velocity, acceleration up and down, jerk) of an axis that no constant velocity brings there
    // in the time `t` of another one; drawn at random until there were seven
    let cases = [
        ([2.61, -1.84, 1.445], (1.83, 0.609), [2.75, -2.05, 2.19, -4.92, 7.74], 1.4526),
        ([2.63, 0.033, -3.11], (1.97, 0.1), [1.65, -1.22, 4.67, -4.59, 5.73], 1.525),
        ([-1.46, 0.571, 0.647], (-0.396, 0.0), [1.76, -2.14, 1.21, -0.719, 1.28], 2.3675),
        ([-0.32, -1.664, -2.606], (-2.693, 0.0), [1.402, -2.571, 1.049, -2.846, 12.03], 2.227),
        ([1.576, -2.315, 1.641], (0.19, 0.268), [0.983, -2.64, 2.135, -2.255, 4.44], 1.755),
        ([0.837, 2.159, 1.06], (2.946, -1.422), [2.4, -1.52, 1.385, -1.558, 2.56], 3.86),
        ([-0.346, 2.279, 0.379], (0.959, 0.0), [2.643, -0.54, 2.345, -4.5, 14.42], 1.145),
    ];
    for ([p, v, a], (p_end, v_end), limits, t) in cases {
        let [max_velocity, min_velocity, max_acceleration, min_acceleration, max_jerk] = limits;
        let limits = Limits { max_velocity, min_velocity, max_acceleration, min_acceleration, max_jerk };
        let axis = Axis { start: Point { p, v, a }, limits, goal: Goal::Position(p_end, v_end) };
        // v/a + a/j = 0.2 s more than at its velocity of 1
        let goal = Goal::Position(t - 0.2, 0.0);
        let other = Axis { start: Point::default(), limits: Limits::symmetric(1.0, 10.0, 100.0), goal };
        let [profile, slowest] = plan(&[axis, other], Synchronization::Time).unwrap()[..] else { panic!() };
        assert!((slowest.duration() - t).abs() < 1e-12, "{t}: {}", slowest.duration());
        assert!((profile.duration() - t).abs() < 1e-10, "{t}: {}", profile.duration());
        is_a_motion(&profile, &axis).unwrap();
    }
}

#[test]
fn what_makes_no_sense_is_refused_in_words() {
    let good =
        Axis { start: Point::default(), limits: Limits::symmetric(1.0, 1.0, 1.0), goal: Goal::Position(1.0, 0.0) };
    let told = |axis: Axis| plan(&[good, axis], Synchronization::Phase).unwrap_err();
    let limits = |limits: Limits| told(Axis { limits, ..good }).why;
    assert_eq!(told(Axis { goal: Goal::Position(f64::NAN, 0.0), ..good }).axis, 1);
    assert_eq!(
        told(Axis { goal: Goal::Position(f64::NAN, 0.0), ..good }).why,
        "its target position is NaN, expected a finite number"
    );
    assert_eq!(
        limits(Limits::symmetric(-1.0, 1.0, 1.0)),
        "its largest velocity is -1, expected a number above 0, from 1e-15 to 1e15"
    );
    assert_eq!(
        limits(Limits::symmetric(1.0, 1.0, 0.0)),
        "its largest jerk is 0, expected a number above 0, from 1e-15 to 1e15"
    );
    assert_eq!(
        limits(Limits { min_acceleration: 0.5, ..good.limits }),
        "its lowest acceleration is 0.5, expected a number below 0, from -1e15 to -1e-15"
    );
    assert_eq!(
        told(Axis { goal: Goal::Position(1.0, 2.0), ..good }).why,
        "its target velocity 2 is not within its limits, -1 to 1"
    );
    let far = told(Axis { goal: Goal::Position(1e12, 0.0), ..good }).why;
    assert_eq!(far, "the motion would take 1000000000002 s, more than 1000000000 s");
}

#[test]
fn large_and_small_numbers_are_as_good() {
    for scale in [1e-9, 1e-3, 1e6, 1e12] {
        let limits = Limits::symmetric(scale, 2.0 * scale, 5.0 * scale);
        let t = at_rest(limits, 3.0 * scale).duration();
        let one = at_rest(Limits::symmetric(1.0, 2.0, 5.0), 3.0).duration();
        assert!((t - one).abs() < 1e-12, "{scale}: {t} {one}");
    }
    // limits that mean none
    let free = at_rest(Limits::symmetric(9_999.0, 99_999.0, 9_999_999.0), 1.0);
    assert!((free.duration() - 4.0 * cube_root(1.0 / (2.0 * 9_999_999.0))).abs() < 1e-12);
}

/// Whatever is asked for, there is a motion or a reason.
#[test]
fn no_numbers_are_too_much() {
    let numbers = [0.0, -0.0, 1e-15, -1e-15, 1e-300, 3.0, -3.0, 1e15, -1e15, 1e16, 1e300, f64::INFINITY, f64::NAN];
    let limits = [1e-15, 1.0, 1e15];
    let mut counts = [0, 0];
    for (k, p) in numbers.into_iter().enumerate() {
        for (i, v) in numbers.into_iter().enumerate() {
            for (n, a) in numbers.into_iter().enumerate() {
                let limits = Limits::symmetric(limits[k % 3], limits[i % 3], limits[n % 3]);
                let (start, goal) = (Point { p, v, a }, Goal::Position(numbers[(k + i + n) % 13], 0.0));
                let planned = plan(&[Axis { start, limits, goal }; 2], Synchronization::Time);
                counts[usize::from(planned.is_ok())] += 1;
            }
        }
    }
    assert!(counts[0] > 100 && counts[1] > 100, "{counts:?}");
}

/// The bits of a planned motion that needs cube roots: the same on every platform.
#[test]
fn bits_are_the_same_everywhere() {
    let limits = Limits { min_velocity: -0.7, min_acceleration: -1.3, ..Limits::symmetric(1.1, 1.7, 9.0) };
    let start = Point { p: 0.1, v: 0.3, a: -0.4 };
    let axes = [
        Axis { start, limits, goal: Goal::Position(0.9, 0.0) },
        Axis { start: Point { v: -0.2, ..start }, limits, goal: Goal::Position(-0.35, 0.1) },
    ];
    let profiles = plan(&axes, Synchronization::Time).unwrap();
    let bits: Vec<u64> = profiles.iter().flat_map(|p| [p.duration().to_bits(), p.at(0.4).p.to_bits()]).collect();
    assert_eq!(
        bits,
        [0x3ff8_235b_f84b_656e, 0x3fd1_bb47_3992_5177, 0x3ff8_235b_f84b_656e, 0xbfa1_ea36_b1be_cc65],
        "{bits:x?}"
    );
}
