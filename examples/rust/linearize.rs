//! Linearisation of a scene: matrices, poles, and the gains of a linear-quadratic regulator.

use std::error::Error;
use std::path::Path;

use sincro_analysis::linear::{DMatrix, DVector, lqr};
use sincro_analysis::linearize::{Request, linearize, operating_point};

fn main() -> Result<(), Box<dyn Error>> {
    let scene = Path::new(env!("CARGO_MANIFEST_DIR")).join("motor");
    let loaded = sincro::load(&scene, &[])?;

    // about the state at t = 0: the arm hangs at rest, which is an equilibrium
    let point = operating_point(&loaded, 0.0).map_err(|diagnostic| diagnostic.to_string())?;
    let found = linearize(&loaded, &point, &Request::default())?;
    let system = &found.system;
    println!("A ={}B ={}", system.a, system.b);
    println!("rates at the operating point: at most {:.1e}", found.drift());
    for mode in system.poles() {
        println!("pole {:.3}{:+.3}i 1/s, damping ratio {:.3}", mode.pole.re, mode.pole.im, mode.damping_ratio);
    }

    // x = (angle, velocity), u = (torque): minimises the integral of xᵀQx + uᵀRu
    let diagonal = |weights: &[f64]| DMatrix::from_diagonal(&DVector::from_column_slice(weights));
    let design = lqr(&system.a, &system.b, &diagonal(&[10.0, 1.0]), &diagonal(&[0.1]))?;
    println!("gains K of u = −K·x:{}", design.k);
    Ok(())
}
