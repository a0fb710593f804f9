//! Paths in spaces whose shortest ways are known.

use std::convert::Infallible;
use std::f64::consts::{FRAC_1_SQRT_2, PI};

use sincro_planning::{Kind, Part, Planner, Space, descend};

fn square() -> Space {
    Space::new(vec![Part::new(Kind::Real(2), vec![0.0; 2], vec![1.0; 2], 1.0).unwrap()])
}

/// A wall with a gap at the top.
fn has_room(p: &[f64]) -> Result<bool, Infallible> {
    Ok(!(0.4..=0.6).contains(&p[0]) || p[1] > 0.8)
}

fn solved(seed: u64) -> (Vec<Vec<f64>>, usize) {
    let space = square();
    let mut planner = Planner::new(&space, seed, 20_000);
    let mut path = planner.connect(&[0.1, 0.1], &[vec![0.9, 0.1]], &mut has_room).unwrap().expect("there is a gap");
    planner.shorten(&mut path, &mut has_room).unwrap();
    (path, planner.n_checks())
}

#[test]
fn the_shortest_way_where_nothing_stands_is_straight() {
    let space = square();
    let mut planner = Planner::new(&space, 1, 1_000);
    let mut free = |_: &[f64]| Ok::<bool, Infallible>(true);
    let path = planner.connect(&[0.0, 0.2], &[vec![1.0, 0.7]], &mut free).unwrap().unwrap();
    assert_eq!(path, [[0.0, 0.2], [1.0, 0.7]]);
    let even = planner.interpolate(&path, 11);
    assert_eq!(even.len(), 11);
    for (k, p) in even.iter().enumerate() {
        assert!((p[0] - 0.1 * k as f64).abs() < 1e-15 && (p[1] - 0.2 - 0.05 * k as f64).abs() < 1e-15, "{p:?}");
    }
}

#[test]
fn a_path_is_valid_at_its_resolution_and_near_the_shortest() {
    let space = square();
    // from corner to corner of the wall: two slopes and its width
    let slope = (0.3_f64 * 0.3 + 0.7 * 0.7).sqrt();
    for seed in 1..20 {
        let (path, _) = solved(seed);
        let planner = Planner::new(&space, 0, 0);
        let length = planner.length(&path);
        assert!((2.0 * slope + 0.2 - 0.03..1.25 * (2.0 * slope + 0.2)).contains(&length), "{length} m");
        for p in planner.interpolate(&path, 0) {
            assert!(has_room(&p).unwrap(), "seed {seed}: {p:?} is in the wall");
        }
        assert_eq!((&path[0], path.last().unwrap()), (&vec![0.1, 0.1], &vec![0.9, 0.1]));
    }
}

#[test]
fn the_same_seed_gives_the_same_bits() {
    assert_eq!(solved(3), solved(3));
    assert_ne!(solved(3).0, solved(4).0);
}

#[test]
fn there_is_no_way_out_of_a_closed_box_and_the_search_ends_at_its_limit() {
    let space = square();
    let mut planner = Planner::new(&space, 5, 3_000);
    let mut n = 0;
    let mut closed = |p: &[f64]| {
        n += 1;
        let ring = (p[0] - 0.5).abs().max((p[1] - 0.5).abs());
        Ok::<bool, Infallible>(!(0.2..0.3).contains(&ring))
    };
    assert_eq!(planner.connect(&[0.5, 0.5], &[vec![0.05, 0.05]], &mut closed).unwrap(), None);
    assert!(n <= 3_000, "{n} states were checked");
    assert_eq!(planner.n_checks(), 3_000);
}

#[test]
fn invalid_ends_give_no_path_and_errors_pass() {
    let space = square();
    let mut planner = Planner::new(&space, 5, 3_000);
    assert_eq!(planner.connect(&[0.5, 0.5], &[vec![0.1, 0.1]], &mut has_room).unwrap(), None);
    assert_eq!(planner.connect(&[0.1, 0.1], &[vec![0.5, 0.5]], &mut has_room).unwrap(), None);
    assert_eq!(planner.connect(&[0.1, 0.1], &[vec![0.2, 0.2]], &mut |_: &[f64]| Err("gone")), Err("gone"));
}

#[test]
fn turns_go_the_shorter_way() {
    let turning = Space::new(vec![Part::new(Kind::Pose2, vec![-1.0; 2], vec![1.0; 2], 1.0).unwrap()]);
    let half = turning.interpolate(&[0.0, 0.0, 3.0], &[1.0, 0.0, -3.0], 0.5);
    assert!((half[2].abs() - PI).abs() < 1e-12 && half[0] == 0.5, "{half:?}");
    // half the angle of 0.28 rad, and a length of 1 m
    let apart = turning.distance(&[0.0, 0.0, 3.0], &[1.0, 0.0, -3.0]);
    assert!((apart - 1.0 - (PI - 3.0)).abs() < 1e-12, "{apart}");
    let space = Space::new(vec![Part::new(Kind::Pose3, vec![-1.0; 3], vec![1.0; 3], 1.0).unwrap()]);
    let a = [0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0];
    // a quarter turn about z, by the quaternion of the other sign
    let b = [0.2, 0.0, 0.0, 0.0, 0.0, -FRAC_1_SQRT_2, -FRAC_1_SQRT_2];
    assert!((space.distance(&a, &b) - 0.2 - PI / 4.0).abs() < 1e-7);
    let half = space.interpolate(&a, &b, 0.5);
    let eighth = [(0.5 - 0.125_f64.sqrt()).sqrt(), (0.5 + 0.125_f64.sqrt()).sqrt()];
    assert!((half[5] - eighth[0]).abs() < 1e-12 && (half[6] - eighth[1]).abs() < 1e-12, "{half:?}");
}

#[test]
fn a_descent_finds_the_two_postures_of_an_arm() {
    // two links of 1 m whose tip is to be at (1, 1): joints (0, π/2) and (π/2, −π/2)
    let limits = [vec![-3.0; 2], vec![3.0; 2]];
    let space = Space::new(vec![Part::new(Kind::Real(2), limits[0].clone(), limits[1].clone(), 1.0).unwrap()]);
    let mut n = 0;
    let mut gap = |q: &[f64]| {
        n += 1;
        let [(s1, c1), (s2, c2)] = [q[0], q[0] + q[1]].map(sincro_math::elementary::sin_cos);
        let (x, y) = (c1 + c2 - 1.0, s1 + s2 - 1.0);
        Ok::<f64, Infallible>((x * x + y * y).sqrt())
    };
    let found = descend(&space, &[0.3, 1.0], (1e-4, 6, 20_000), 1, &mut gap).unwrap();
    assert!(n <= 20_100, "{n} were measured");
    let is_near = |q: &[f64], p: [f64; 2]| (q[0] - p[0]).abs() + (q[1] - p[1]).abs() < 1e-3;
    for posture in [[0.0, PI / 2.0], [PI / 2.0, -PI / 2.0]] {
        assert!(found.iter().any(|q| is_near(q, posture)), "{posture:?} is not among {found:?}");
    }
}
