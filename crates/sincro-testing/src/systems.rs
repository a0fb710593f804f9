//! Linear systems that figures, texts and files are tested with.

use sincro_analysis::linear::{Axis, DMatrix, StateSpace};

/// `k / (s (s + 1) (s + 5))` as motor and load.
#[must_use]
pub fn servo() -> StateSpace {
    let a = DMatrix::from_row_slice(3, 3, &[0.0, 1.0, 0.0, 0.0, -1.0, 2.0, 0.0, 0.0, -5.0]);
    let b = DMatrix::from_row_slice(3, 1, &[0.0, 0.0, 5.0]);
    let c = DMatrix::from_row_slice(2, 3, &[1.0, 0.0, 0.0, 0.0, 1.0, 0.0]);
    StateSpace {
        a,
        b,
        c,
        d: DMatrix::zeros(2, 1),
        states: vec![
            Axis::new("/arm/hinge.position", "rad"),
            Axis::new("/arm/hinge.velocity", "rad/s"),
            Axis::new("/motor.current", "A"),
        ],
        inputs: vec![Axis::new("/motor.voltage", "V")],
        outputs: vec![Axis::new("/arm/hinge.position", "rad"), Axis::new("/arm/hinge.velocity", "rad/s")],
        t: 0.5,
        sample_time: None,
    }
}

/// A flexible joint with three swings, hardly damped.
#[must_use]
pub fn flexible() -> StateSpace {
    let mut a = DMatrix::zeros(6, 6);
    for (k, (w, zeta)) in [(3.0, 0.3), (8.0, 0.05), (20.0, 0.12)].into_iter().enumerate() {
        a[(2 * k, 2 * k + 1)] = 1.0;
        a[(2 * k + 1, 2 * k)] = -w * w;
        a[(2 * k + 1, 2 * k + 1)] = -2.0 * zeta * w;
    }
    let b = DMatrix::from_row_slice(6, 1, &[0.0, 9.0, 0.0, 12.0, 0.0, 40.0]);
    let c = DMatrix::from_row_slice(1, 6, &[1.0, 0.0, 1.0, 0.0, 1.0, 0.0]);
    let mut system = StateSpace::from_matrices(a, b, c, DMatrix::zeros(1, 1)).unwrap();
    system.outputs[0] = Axis::new("/tip.position", "mm");
    system.inputs[0] = Axis::new("/shaker.force", "N");
    system
}

/// A lag behind two ticks of delay, sampled at 20 Hz.
#[must_use]
pub fn sampled() -> StateSpace {
    let a = DMatrix::from_row_slice(3, 3, &[0.9, 0.1, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0]);
    let b = DMatrix::from_row_slice(3, 1, &[0.0, 0.0, 1.0]);
    let c = DMatrix::from_row_slice(1, 3, &[1.0, 0.0, 0.0]);
    let system = StateSpace::from_matrices(a, b, c, DMatrix::zeros(1, 1)).unwrap();
    StateSpace { sample_time: Some(0.05), ..system }
}
