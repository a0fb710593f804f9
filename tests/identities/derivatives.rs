//! The recursions on dual numbers give the exact derivatives of the recursions on `f64`.

use sincro_dynamics::aba::{Input, forward_dynamics};
use sincro_dynamics::model::Model;
use sincro_dynamics::scratch::Scratch;
use sincro_math::Dual;

use crate::random::{self, Random};

/// Accelerations over any kind of number, torques and velocities given.
fn accelerations<R: sincro_math::Real>(model: &Model<f64>, q: &[R], v: &[R], torque: &[R]) -> Vec<R> {
    let model = Model::<R>::pack(&[model]).unwrap();
    let mut scratch = Scratch::new(&model);
    let diagonal: Vec<R> = model.dofs().iter().map(|d| d.armature).collect();
    let mut v_dot = vec![R::zero(); v.len()];
    let input = Input { q, v, torque, diagonal: &diagonal, prescribed: None, external: None, gravity: true };
    forward_dynamics(&model, &input, &mut scratch, &mut v_dot);
    v_dot
}

#[test]
fn dual_numbers_differentiate_forward_dynamics() {
    for seed in 0..30 {
        let mut r = Random::new(9000 + seed);
        let model = random::tree(&mut r, 1 + seed as usize % 6);
        let x = random::state(&mut r, &model);
        let torque: Vec<f64> = x.v.iter().map(|_| r.unit()).collect();
        let (n_q, n_v) = (model.n_q(), model.n_v());
        // one direction in (q, v, torque) at a time: a random one
        let direction: Vec<f64> = (0..n_q + 2 * n_v).map(|_| r.unit()).collect();
        let dual = |values: &[f64], at: usize| -> Vec<Dual<1>> {
            values.iter().zip(&direction[at..]).map(|(x, d)| Dual { value: *x, partials: [*d] }).collect()
        };
        let exact = accelerations(&model, &dual(&x.q, 0), &dual(&x.v, n_q), &dual(&torque, n_q + n_v));
        let moved = |h: f64| {
            let at = |values: &[f64], from: usize| -> Vec<f64> {
                values.iter().zip(&direction[from..]).map(|(x, d)| x + h * d).collect()
            };
            accelerations(&model, &at(&x.q, 0), &at(&x.v, n_q), &at(&torque, n_q + n_v))
        };
        let h = 1e-6;
        let (plus, minus) = (moved(h), moved(-h));
        let scale = exact.iter().fold(1.0_f64, |s, a| s.max(a.partials[0].abs()).max(a.value.abs()));
        for k in 0..n_v {
            let difference = (plus[k] - minus[k]) / (2.0 * h);
            // truncation h² f‴ and rounding 1e-16/h of the central difference
            assert!((exact[k].partials[0] - difference).abs() < 1e-6 * scale, "{} {difference}", exact[k].partials[0]);
        }
    }
}
