//! Searches in spaces without extent, with numbers that are too large, and without any effort left: they end.

use std::convert::Infallible;

use sincro_planning::{Kind, MAX_BOUND, MAX_WEIGHT, Part, Planner, Space, descend};

fn free(_: &[f64]) -> Result<bool, Infallible> {
    Ok(true)
}

#[test]
fn bounds_and_weights_are_numbers_whose_squares_are_finite() {
    let part = |low: f64, high: f64, weight: f64| Part::new(Kind::Real(1), vec![low], vec![high], weight);
    assert!(part(-MAX_BOUND, MAX_BOUND, MAX_WEIGHT).is_some() && part(1.0, 1.0, 0.0).is_some());
    for (low, high, weight) in [
        (-1e300, 1e300, 1.0),
        (0.0, f64::INFINITY, 1.0),
        (f64::NAN, 1.0, 1.0),
        (0.0, f64::NAN, 1.0),
        (1.0, 0.0, 1.0),
        (0.0, 1.0, -1.0),
        (0.0, 1.0, f64::NAN),
        (0.0, 1.0, 1e300),
    ] {
        assert!(part(low, high, weight).is_none(), "{low} to {high} with the weight {weight}");
    }
    assert!(Part::new(Kind::Pose2, vec![0.0; 3], vec![1.0; 3], 1.0).is_none());
}

#[test]
fn a_space_without_extent_has_one_state_and_its_path() {
    let point = Space::new(vec![Part::new(Kind::Real(2), vec![0.5; 2], vec![0.5; 2], 1.0).unwrap()]);
    let mut planner = Planner::new(&point, 1, 1_000);
    let path = planner.connect(&[0.5; 2], &[vec![0.5; 2]], &mut free).unwrap().unwrap();
    assert_eq!(planner.length(&path), 0.0);
    assert_eq!(planner.interpolate(&path, 5).len(), 5);
    let mut n = 0;
    let mut far = |_: &[f64]| {
        n += 1;
        Ok::<f64, Infallible>(f64::NAN)
    };
    assert!(descend(&point, &[0.5; 2], (1e-3, 3, 500), 1, &mut far).unwrap().is_empty());
    assert_eq!(n, 500);
}

#[test]
fn a_space_of_weight_zero_is_searched_to_the_limit() {
    let flat = Space::new(vec![Part::new(Kind::Real(1), vec![0.0], vec![1.0], 0.0).unwrap()]);
    let mut planner = Planner::new(&flat, 1, 2_000);
    let mut split = |x: &[f64]| Ok::<bool, Infallible>(!(0.4..0.6).contains(&x[0]));
    assert_eq!(planner.connect(&[0.0], &[vec![1.0]], &mut split).unwrap(), None);
    assert_eq!(planner.n_checks(), 2_000);
}

#[test]
fn a_long_path_is_left_as_it_is_where_no_effort_is_left() {
    let line = Space::new(vec![Part::new(Kind::Real(1), vec![0.0], vec![1.0], 1.0).unwrap()]);
    let path: Vec<Vec<f64>> = (0..20_000).map(|k| vec![f64::from(k % 2)]).collect();
    let (mut short, mut planner) = (path.clone(), Planner::new(&line, 1, 0));
    let mut n = 0;
    let mut check = |_: &[f64]| {
        n += 1;
        Ok::<bool, Infallible>(true)
    };
    planner.shorten(&mut short, &mut check).unwrap();
    assert!(short == path && n == 0);
}

#[test]
fn a_cyclic_joint_far_from_zero_is_brought_back_and_turns_the_shorter_way() {
    let turning = Space::new(vec![Part::new(Kind::Cyclic, Vec::new(), Vec::new(), 1.0).unwrap()]);
    let mut state = [1e6];
    turning.enforce(&mut state);
    assert!((-3.2..3.2).contains(&state[0]));
    assert!(turning.distance(&[3.0], &[-3.0]) < 0.3);
}

#[test]
fn poses_that_are_turned_are_sampled_within_their_bounds() {
    let space = Space::new(vec![Part::new(Kind::Pose3, vec![-1.0; 3], vec![1.0; 3], 1.0).unwrap()]);
    let mut random = sincro_math::random::SplitMix64::new(7);
    for _ in 0..1_000 {
        let state = space.sample(&mut random);
        let norm: f64 = state[3..].iter().map(|x| x * x).sum();
        assert!(space.contains(&state) && (norm - 1.0).abs() < 1e-12, "{state:?}");
    }
}
