//! Rotations: closed forms on the axes, round trips and identities on random ones. A few products of numbers up to 1:
//! 1e-14.

mod common;

use common::{Random, add, block, faults, value};
use sincro_blocks::block::Block;
use sincro_blocks::diagram::Diagram;
use sincro_blocks::instance::DynBlock;
use sincro_blocks::library::rotations::{Convention, EulerToQuaternion};
use sincro_blocks::library::sources::Constant;
use sincro_blocks::simulator::Simulator;
use std::f64::consts::{FRAC_PI_2, PI};

const CONVENTIONS: [&str; 2] = ["zyx", "xyz"];

fn close(a: &[f64], b: &[f64]) -> bool {
    a.len() == b.len() && a.iter().zip(b).all(|(a, b)| (a - b).abs() < 1e-14)
}

fn by(kind: &str, convention: &str, u: &[f64]) -> Vec<f64> {
    value(u, block(kind, &[("convention", convention.into())]))
}

fn plain(kind: &str, u: &[f64]) -> Vec<f64> {
    value(u, block(kind, &[]))
}

/// A block with two inputs.
fn both(block: Box<dyn DynBlock>, first: &[f64], second: &[f64]) -> Vec<f64> {
    let ports = block.ports().inputs;
    let mut d = Diagram::new();
    d.block("a", Constant { value: first.to_vec() }).block("b", Constant { value: second.to_vec() });
    add(&mut d, "y", block);
    d.wire("a", &format!("y.{}", ports[0])).wire("b", &format!("y.{}", ports[1]));
    Simulator::new(&d, 0.01).unwrap().output("y").to_vec()
}

fn matrix_product(a: &[f64], b: &[f64]) -> Vec<f64> {
    (0..9).map(|n| (0..3).map(|k| a[n / 3 * 3 + k] * b[3 * k + n % 3]).sum()).collect()
}

/// Angles with the middle one inside ±π/2.
fn angles(random: &mut Random) -> Vec<f64> {
    vec![PI * random.next(), 1.5 * random.next(), PI * random.next()]
}

#[test]
fn a_quarter_turn_about_z_takes_x_to_y() {
    let m = by("euler-to-matrix", "zyx", &[0.0, 0.0, FRAC_PI_2]);
    assert!(close(&m, &[0.0, -1.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0]));
    let q = by("euler-to-quaternion", "zyx", &[0.0, 0.0, FRAC_PI_2]);
    let half = 0.5f64.sqrt();
    assert!(close(&q, &[half, 0.0, 0.0, half]));
    assert!(close(&both(block("rotate-vector", &[]), &q, &[1.0, 0.0, 0.0]), &[0.0, 1.0, 0.0]));
    let back = both(block("rotate-vector", &[("inverse", true.into())]), &q, &[1.0, 0.0, 0.0]);
    assert!(close(&back, &[0.0, -1.0, 0.0]));
}

#[test]
fn the_conventions_are_products_of_turns_about_axes() {
    let mut random = Random(21);
    for _ in 0..20 {
        let e = angles(&mut random);
        let axis = |k: usize| {
            let mut one = [0.0; 3];
            one[k] = e[k];
            // alone, an angle means the same in both
            by("euler-to-matrix", "zyx", &one)
        };
        let (x, y, z) = (axis(0), axis(1), axis(2));
        let zyx = matrix_product(&z, &matrix_product(&y, &x));
        let xyz = matrix_product(&x, &matrix_product(&y, &z));
        assert!(close(&by("euler-to-matrix", "zyx", &e), &zyx));
        assert!(close(&by("euler-to-matrix", "xyz", &e), &xyz));
    }
}

#[test]
fn angles_matrices_and_quaternions_go_round() {
    let mut random = Random(22);
    for _ in 0..50 {
        let e = angles(&mut random);
        for convention in CONVENTIONS {
            let m = by("euler-to-matrix", convention, &e);
            let q = by("euler-to-quaternion", convention, &e);
            // cos 1.5 = 0.07: angles are found to 1e-16/0.07
            assert!(close(&by("matrix-to-euler", convention, &m), &e), "{e:?}");
            assert!(close(&by("quaternion-to-euler", convention, &q), &e), "{e:?}");
            assert!(close(&plain("quaternion-to-matrix", &q), &m));
            let sign = if q[0] < 0.0 { -1.0 } else { 1.0 };
            let positive: Vec<f64> = q.iter().map(|x| sign * x).collect();
            assert!(close(&plain("matrix-to-quaternion", &m), &positive));
            // of any length
            let long: Vec<f64> = q.iter().map(|x| -3.0 * x).collect();
            assert!(close(&plain("quaternion-to-matrix", &long), &m));
        }
    }
}

#[test]
fn half_turns_have_quaternions_too() {
    for k in 0..3 {
        let mut m = [0.0; 9];
        (0..3).for_each(|i| m[4 * i] = if i == k { 1.0 } else { -1.0 });
        let q = plain("matrix-to-quaternion", &m);
        assert_eq!((q[0], q[k + 1].abs()), (0.0, 1.0));
    }
}

#[test]
fn angles_fit_together_however_near_the_lock() {
    for distance in [0.0, 1e-13, 1e-9, 1e-5] {
        for middle in [FRAC_PI_2 - distance, distance - FRAC_PI_2] {
            for convention in CONVENTIONS {
                let m = by("euler-to-matrix", convention, &[0.7, middle, -0.4]);
                let again = by("euler-to-matrix", convention, &by("matrix-to-euler", convention, &m));
                assert!(m.iter().zip(&again).all(|(a, b)| (a - b).abs() < 2e-12), "{middle} {convention}");
            }
        }
    }
}

#[test]
fn the_product_of_quaternions_is_that_of_their_matrices() {
    let mut random = Random(23);
    for _ in 0..20 {
        let [p, q] = [0, 1].map(|_| by("euler-to-quaternion", "zyx", &angles(&mut random)));
        let product = both(block("quaternion-product", &[]), &p, &q);
        let (mp, mq) = (plain("quaternion-to-matrix", &p), plain("quaternion-to-matrix", &q));
        assert!(close(&plain("quaternion-to-matrix", &product), &matrix_product(&mp, &mq)));
        let conjugate = plain("quaternion-conjugate", &p);
        assert!(close(&both(block("quaternion-product", &[]), &p, &conjugate), &[1.0, 0.0, 0.0, 0.0]));
        let v = random.list(3);
        let turned = both(block("rotate-vector", &[]), &p, &v);
        assert!(close(&both(block("rotate-vector", &[("inverse", true.into())]), &p, &turned), &v));
    }
}

#[test]
fn rates_are_the_slopes_of_angles_and_quaternions() {
    // central differences of step 1e-5: off by 1e-10 from the third derivative and by 1e-11 from rounding
    const H: f64 = 1e-5;
    let mut random = Random(24);
    for convention in CONVENTIONS {
        for _ in 0..10 {
            let (e, w) = (angles(&mut random), random.list(3));
            let rates = both(block("euler-rates", &[("convention", convention.into())]), &e, &w);
            let at = |h: f64| {
                let moved: Vec<f64> = e.iter().zip(&rates).map(|(e, rate)| e + h * rate).collect();
                by("euler-to-quaternion", convention, &moved)
            };
            let (q, before, after) = (at(0.0), at(-H), at(H));
            let rate = both(block("angular-velocity-to-quaternion-rate", &[]), &q, &w);
            let w_world = both(block("rotate-vector", &[]), &q, &w);
            let kind = "angular-velocity-to-quaternion-rate";
            let from_world = both(block(kind, &[("world", true.into())]), &q, &w_world);
            assert!(close(&rate, &from_world));
            for k in 0..4 {
                // rates grow as 1/cos of the middle angle, their derivatives with its powers
                assert!(((after[k] - before[k]) / (2.0 * H) - rate[k]).abs() < 1e-6, "{e:?}");
            }
        }
    }
}

#[test]
fn the_matrices_of_euler_rates_are_inverse_and_transposed_to_each_other() {
    let mut random = Random(25);
    for convention in CONVENTIONS {
        for _ in 0..10 {
            let (e, w, torque) = (angles(&mut random), random.list(3), random.list(3));
            let of = |kind: &str, transposed: bool, x: &[f64]| {
                let parameters = [("convention", convention.into()), ("transposed", transposed.into())];
                both(block(kind, &parameters), &e, x)
            };
            let (rates, back) = ("euler-rates", "euler-rates-to-angular-velocity");
            assert!(close(&of(back, false, &of(rates, false, &w)), &w));
            assert!(close(&of(back, true, &of(rates, true, &torque)), &torque));
            // the same power about both sets of axes: (Eᵀτ)·rates = τ·(E·rates)
            let power = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
            let (one, other) = (power(&of(back, true, &torque), &of(rates, false, &w)), power(&torque, &w));
            assert!((one - other).abs() < 1e-9 * (1.0 + one.abs()), "{e:?}: {one} {other}");
        }
    }
}

#[test]
fn a_vector_of_the_wrong_size_is_told() {
    let found = Simulator::new(&common::driven(&[1.0, 2.0], block("quaternion-conjugate", &[])), 0.01).unwrap_err();
    assert!(found[0].message.contains("`u` has 4 components here, it gets 2"), "{}", found[0]);
    assert!(faults("euler-to-matrix", &[("convention", "zxz".into())]).contains("zyx, xyz"));
    assert_eq!(Block::label(&EulerToQuaternion::new(Convention::Xyz)), "xyz → q");
}
