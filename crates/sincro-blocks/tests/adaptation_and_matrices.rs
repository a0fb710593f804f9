//! Matrices as signals, and adaptation.

mod common;

use common::{Random, add, block, faults, list};
use sincro_blocks::block::Block;
use sincro_blocks::diagram::Diagram;
use sincro_blocks::library::adaptation::EllipsoidProjection;
use sincro_blocks::library::sources::Constant;
use sincro_blocks::reader::Value;
use sincro_blocks::simulator::Simulator;

/// Output of a block for constants at its inputs.
fn given(inputs: &[(&str, &[f64])], kind: &str, parameters: &[(&str, Value)]) -> Vec<f64> {
    let mut d = Diagram::new();
    add(&mut d, "block", block(kind, parameters));
    for (k, (port, value)) in inputs.iter().enumerate() {
        let name = format!("constant-{k}");
        d.block(&name, Constant { value: value.to_vec() }).wire(&name, &format!("block.{port}"));
    }
    Simulator::new(&d, 0.01).unwrap().output("block").to_vec()
}

#[test]
fn a_matrix_times_a_vector_and_its_transpose() {
    let a: &[f64] = &[1.0, 2.0, 3.0, 4.0, 5.0, 6.0];
    let plain = given(&[("a", a), ("b", &[1.0, -1.0, 2.0])], "matrix-product", &[("rows", 2.0.into())]);
    assert_eq!(plain, [5.0, 11.0]);
    let parameters = [("rows", 2.0.into()), ("transposed", true.into())];
    assert_eq!(given(&[("a", a), ("b", &[1.0, -1.0])], "matrix-product", &parameters), [-3.0, -3.0, -3.0]);
}

#[test]
fn the_product_of_two_matrices_is_row_by_row() {
    let (a, b): (&[f64], &[f64]) = (&[1.0, 2.0, 3.0, 4.0], &[0.0, 1.0, 2.0, 3.0, 4.0, 5.0]);
    let y = given(&[("a", a), ("b", b)], "matrix-product", &[("rows", 2.0.into())]);
    assert_eq!(y, [6.0, 9.0, 12.0, 12.0, 19.0, 26.0]);
}

#[test]
fn matrices_stand_side_by_side() {
    let y = given(&[("u1", &[1.0, 2.0]), ("u2", &[3.0, 4.0, 5.0, 6.0])], "matrix-concatenate", &[("rows", 2.0.into())]);
    assert_eq!(y, [1.0, 3.0, 4.0, 2.0, 5.0, 6.0]);
    assert_eq!(given(&[("u", &[7.0, 8.0])], "diagonal", &[]), [7.0, 0.0, 0.0, 8.0]);
}

#[test]
fn sizes_that_do_not_fit_are_named() {
    let product = block("matrix-product", &[("rows", 2.0.into())]);
    let wrong = product.widths(&[Some(6), Some(4)]).unwrap_err();
    assert_eq!(wrong, "`a` is 2 × 3, `b` has 4 components: no matrix of 3 rows");
    assert!(product.widths(&[Some(5), None]).unwrap_err().contains("`a` has 5 components: no matrix of 2 rows"));
    let gradient = block("normalized-gradient", &[("gain", list(&[1.0, 2.0]))]);
    assert!(
        gradient.widths(&[Some(6), Some(2)]).unwrap_err().contains("`gain` has 2 numbers, the regressor 3 columns")
    );
    assert!(faults("normalized-gradient", &[("gain", list(&[1.0, 0.0]))]).contains("gain"));
    assert!(faults("matrix-product", &[("rows", 0.0.into())]).contains("rows"));
}

#[test]
fn a_scalar_error_gives_the_projection_algorithm() {
    // y = Γφε/(1 + φᵀΓφ)
    let (phi, gain): (&[f64], [f64; 3]) = (&[1.0, -2.0, 0.5], [3.0, 0.5, 8.0]);
    let y = given(&[("regressor", phi), ("error", &[0.7])], "normalized-gradient", &[("gain", list(&gain))]);
    let norm = 1.0 + (0..3).map(|k| gain[k] * phi[k] * phi[k]).sum::<f64>();
    for k in 0..3 {
        assert!((y[k] - gain[k] * phi[k] * 0.7 / norm).abs() < 1e-15);
    }
}

#[test]
fn adaptation_comes_nearer_to_the_true_parameters_for_every_rate_below_two() {
    let mut random = Random(1);
    for rate in [0.1, 1.0, 1.9] {
        let gain: Vec<f64> = random.list(5).iter().map(|x| 100.0 * (1.01 + x)).collect();
        let truth = random.list(5);
        let mut guess = random.list(5);
        let distance =
            |guess: &[f64]| (0..5).map(|k| (truth[k] - guess[k]) * (truth[k] - guess[k]) / gain[k]).sum::<f64>();
        for _ in 0..50 {
            let (before, phi) = (distance(&guess), random.list(10));
            let error: Vec<f64> =
                (0..2).map(|i| (0..5).map(|k| phi[5 * i + k] * (truth[k] - guess[k])).sum()).collect();
            let y = given(&[("regressor", &phi), ("error", &error)], "normalized-gradient", &[("gain", list(&gain))]);
            guess.iter_mut().zip(&y).for_each(|(guess, y)| *guess += rate * y);
            assert!(distance(&guess) <= before * (1.0 + 1e-14), "{rate}");
        }
    }
}

const GAIN: [f64; 8] = [8e3, 8e3, 80.0, 800.0, 800.0, 800.0, 80.0, 800.0];

fn projected(u: &[f64]) -> Vec<f64> {
    given(&[("u", u)], "ellipsoid-projection", &[("bound", 6.0.into()), ("gain", list(&GAIN))])
}

#[test]
fn the_projection_has_the_known_value() {
    // gains of the compliant arm's adaptation; computed by bisection, nine digits
    let y = projected(&[0.5, -0.4, 0.2, 0.1, 1.2, 1.0, 2.0, 1.5]);
    let known =
        [0.093_151_69, -0.074_521_35, 0.191_630_37, 0.069_601_1, 0.835_213_2, 0.696_011, 1.916_303_73, 1.044_016_5];
    for (y, known) in y.iter().zip(known) {
        assert!((y - known).abs() < 5e-8, "{y} {known}");
    }
    assert!((y.iter().map(|y| y * y).sum::<f64>() - 6.0).abs() < 1e-14);
}

#[test]
fn the_projection_leaves_what_is_inside_and_never_expands() {
    let mut random = Random(2);
    let square = |x: &[f64]| x.iter().map(|x| x * x).sum::<f64>();
    for _ in 0..100 {
        let near = |x: f64| 0.8 * x;
        let inside: Vec<f64> = random.list(8).into_iter().map(near).collect();
        assert!(square(&inside) > 6.0 || projected(&inside) == inside);
        let far: Vec<f64> = random.list(8).into_iter().map(|x| 1e3 * x * x * x).collect();
        let y = projected(&far);
        assert!(square(&y) <= 6.0 * (1.0 + 1e-14));
        let to = |x: &[f64]| (0..8).map(|k| (x[k] - inside[k]) * (x[k] - inside[k]) / GAIN[k]).sum::<f64>();
        assert!(square(&inside) > 6.0 || to(&y) <= to(&far));
    }
}

#[test]
fn the_projection_stands_for_huge_vectors() {
    let y = EllipsoidProjection::new(1.0, &[1.0], &[1.0]);
    assert!(y.has_direct_feedthrough(0));
    let y = given(&[("u", &[3e150, -4e150])], "ellipsoid-projection", &[("bound", 1.0.into())]);
    assert!((y[0] - 0.6).abs() < 1e-14 && (y[1] + 0.8).abs() < 1e-14);
}
