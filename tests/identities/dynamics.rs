//! Forward and inverse dynamics, mass matrix, kinematics and energy against each other.

use sincro_dynamics::aba::{Input, Prescribed, forward_dynamics};
use sincro_dynamics::crba::mass_matrix;
use sincro_dynamics::energy::{energy, energy_at, momentum};
use sincro_dynamics::kinematics::{self, Attached};
use sincro_dynamics::model::Model;
use sincro_dynamics::rnea::inverse_dynamics;
use sincro_dynamics::scratch::Scratch;
use sincro_dynamics::spatial::{Force, Vec3};
use sincro_dynamics::state::State;

use crate::random::{self, Random};

struct Case {
    model: Model<f64>,
    x: State<f64>,
    scratch: Scratch<f64>,
    r: Random,
}

/// Trees of 1 to 12 joints; each test walks through all of them.
fn cases(seed: u64) -> impl Iterator<Item = Case> {
    (0..120).map(move |k| {
        let mut r = Random::new(seed * 1000 + k);
        let model = random::tree(&mut r, 1 + (k as usize % 12));
        let x = random::state(&mut r, &model);
        let scratch = Scratch::new(&model);
        Case { model, x, scratch, r }
    })
}

fn armature(model: &Model<f64>) -> Vec<f64> {
    model.dofs().iter().map(|d| d.armature).collect()
}

fn scale(x: &[f64]) -> f64 {
    x.iter().fold(1.0, |a, b| a.max(b.abs()))
}

fn assert_close(a: &[f64], b: &[f64], tolerance: f64) {
    let limit = tolerance * scale(a);
    for (x, y) in a.iter().zip(b) {
        assert!((x - y).abs() <= limit, "{x} {y}, off by {:e}, allowed {limit:e}", (x - y).abs());
    }
}

#[test]
fn inverse_dynamics_undoes_forward_dynamics() {
    for mut c in cases(1) {
        let n = c.model.n_v();
        let torque: Vec<f64> = (0..n).map(|_| 5.0 * c.r.unit()).collect();
        let external: Vec<Force<f64>> =
            (0..c.model.links().len()).map(|_| Force { ang: Vec3(c.r.vector()), lin: Vec3(c.r.vector()) }).collect();
        let diagonal = armature(&c.model);
        let input = Input {
            q: &c.x.q,
            v: &c.x.v,
            torque: &torque,
            diagonal: &diagonal,
            prescribed: None,
            external: Some(&external),
            gravity: true,
        };
        let mut v_dot = vec![0.0; n];
        forward_dynamics(&c.model, &input, &mut c.scratch, &mut v_dot);
        let mut back = vec![0.0; n];
        inverse_dynamics(&c.model, &c.x.q, &c.x.v, &v_dot, Some(&external), &mut c.scratch, &mut back);
        for k in 0..n {
            back[k] += diagonal[k] * v_dot[k];
        }
        // 1e-9: condition of the mass matrix of random trees reaches 1e5
        let wide = scale(&v_dot) * 1e-11;
        assert_close(&torque, &back, 1e-10f64.max(wide));
    }
}

#[test]
fn a_held_joint_has_its_acceleration_and_names_the_torque_for_it() {
    for mut c in cases(2) {
        let n = c.model.n_v();
        let torque: Vec<f64> = (0..n).map(|_| c.r.unit()).collect();
        let mask: Vec<f64> = (0..n).map(|_| f64::from(u8::from(c.r.below(3) == 0))).collect();
        let acceleration: Vec<f64> = (0..n).map(|_| c.r.unit()).collect();
        let diagonal = armature(&c.model);
        let prescribed = Some(Prescribed { mask: &mask, acceleration: &acceleration });
        let input = Input {
            q: &c.x.q,
            v: &c.x.v,
            torque: &torque,
            diagonal: &diagonal,
            prescribed,
            external: None,
            gravity: true,
        };
        let mut v_dot = vec![0.0; n];
        forward_dynamics(&c.model, &input, &mut c.scratch, &mut v_dot);
        let reaction = c.scratch.reaction().to_vec();
        let mut needed = vec![0.0; n];
        inverse_dynamics(&c.model, &c.x.q, &c.x.v, &v_dot, None, &mut c.scratch, &mut needed);
        for k in 0..n {
            needed[k] += diagonal[k] * v_dot[k];
            if mask[k] == 1.0 {
                assert_eq!(v_dot[k].to_bits(), acceleration[k].to_bits());
            } else {
                assert!(reaction[k].abs() < 1e-9 * scale(&v_dot), "a free joint needs no reaction: {}", reaction[k]);
            }
        }
        let given: Vec<f64> = (0..n).map(|k| torque[k] + reaction[k]).collect();
        assert_close(&needed, &given, 1e-10f64.max(scale(&v_dot) * 1e-11));
    }
}

#[test]
fn mass_matrix_columns_are_inverse_dynamics_of_unit_accelerations() {
    for mut c in cases(3) {
        let n = c.model.n_v();
        let mut mass = vec![0.0; n * n];
        mass_matrix(&c.model, &c.x.q, &mut c.scratch, &mut mass);
        let zero = vec![0.0; n];
        let (mut bias, mut column) = (vec![0.0; n], vec![0.0; n]);
        inverse_dynamics(&c.model, &c.x.q, &zero, &zero, None, &mut c.scratch, &mut bias);
        for j in 0..n {
            let mut unit = zero.clone();
            unit[j] = 1.0;
            inverse_dynamics(&c.model, &c.x.q, &zero, &unit, None, &mut c.scratch, &mut column);
            for i in 0..n {
                let armature = if i == j { c.model.dofs()[i].armature } else { 0.0 };
                let expected = column[i] - bias[i] + armature;
                assert!((mass[i * n + j] - expected).abs() < 1e-11 * scale(&mass).max(scale(&bias)));
            }
        }
    }
}

#[test]
fn kinetic_energy_is_half_v_m_v() {
    for mut c in cases(4) {
        let n = c.model.n_v();
        let mut mass = vec![0.0; n * n];
        mass_matrix(&c.model, &c.x.q, &mut c.scratch, &mut mass);
        let quadratic: f64 = (0..n * n).map(|k| 0.5 * c.x.v[k / n] * mass[k] * c.x.v[k % n]).sum();
        let e = energy_at(&c.model, &c.x.q, &c.x.v, &mut c.scratch);
        assert!((quadratic - e.kinetic).abs() < 1e-11 * e.kinetic.max(1.0));
    }
}

#[test]
fn jacobian_times_rates_is_the_velocity_of_the_frame() {
    for mut c in cases(5) {
        let n = c.model.n_v();
        for link in 0..c.model.links().len() {
            let frame = Attached { link: Some(link), pose: c.r.pose() };
            let mut j = vec![0.0; 6 * n];
            kinematics::jacobian(&c.model, &c.x.q, &frame, &mut c.scratch, &mut j);
            let jv: Vec<f64> = (0..6).map(|i| (0..n).map(|k| j[i * n + k] * c.x.v[k]).sum()).collect();
            kinematics::motions(&c.model, &c.x.q, &c.x.v, &c.x.v, &mut c.scratch);
            let v = kinematics::frame_velocity(&c.scratch, &frame);
            assert_close(&[v.ang.0, v.lin.0].concat(), &jv, 1e-12);
        }
    }
}

#[test]
fn energy_changes_by_the_power_of_the_torques() {
    // d/dt (T + U) = τ·v along the true motion, by central differences of the exact energies
    for mut c in cases(6) {
        let n = c.model.n_v();
        let torque: Vec<f64> = (0..n).map(|_| c.r.unit()).collect();
        let diagonal = armature(&c.model);
        let mut v_dot = vec![0.0; n];
        let input = Input {
            q: &c.x.q,
            v: &c.x.v,
            torque: &torque,
            diagonal: &diagonal,
            prescribed: None,
            external: None,
            gravity: true,
        };
        forward_dynamics(&c.model, &input, &mut c.scratch, &mut v_dot);
        let h = 1e-5 / scale(&v_dot).sqrt();
        let at = |h: f64, scratch: &mut Scratch<f64>| {
            let mut x = c.x.clone();
            let step: Vec<f64> = (0..n).map(|k| h * c.x.v[k] + 0.5 * h * h * v_dot[k]).collect();
            sincro_dynamics::state::displace(&c.model, &c.x.q, &step, &mut x.q);
            let v: Vec<f64> = (0..n).map(|k| c.x.v[k] + h * v_dot[k]).collect();
            energy_at(&c.model, &x.q, &v, scratch).total()
        };
        let rate = (at(h, &mut c.scratch) - at(-h, &mut c.scratch)) / (2.0 * h);
        let power: f64 = torque.iter().zip(&c.x.v).map(|(t, v)| t * v).sum();
        let e = energy_at(&c.model, &c.x.q, &c.x.v, &mut c.scratch);
        let noise = 1e-15 * (e.kinetic + e.potential.abs()) / h + 1e-6 * e.kinetic + 1e-7;
        assert!((rate - power).abs() < 10.0 * noise, "{rate} {power} {noise:e}");
    }
}

#[test]
fn momentum_of_a_tree_that_floats_freely_changes_by_gravity_alone() {
    let mut seen = 0;
    for mut c in cases(7) {
        // only trees whose every root is a free joint exchange no force with the world
        let roots = c.model.links().iter().filter(|l| l.parent().is_none());
        if !roots.clone().all(|l| l.is_free()) {
            continue;
        }
        seen += 1;
        let n = c.model.n_v();
        let zero = vec![0.0; n];
        let diagonal = zero.clone();
        let mut v_dot = zero.clone();
        let input = Input {
            q: &c.x.q,
            v: &c.x.v,
            torque: &zero,
            diagonal: &diagonal,
            prescribed: None,
            external: None,
            gravity: true,
        };
        forward_dynamics(&c.model, &input, &mut c.scratch, &mut v_dot);
        let h = 1e-6;
        let at = |h: f64, scratch: &mut Scratch<f64>| {
            let mut q = c.x.q.clone();
            let step: Vec<f64> = (0..n).map(|k| h * c.x.v[k]).collect();
            sincro_dynamics::state::displace(&c.model, &c.x.q, &step, &mut q);
            let v: Vec<f64> = (0..n).map(|k| c.x.v[k] + h * v_dot[k]).collect();
            kinematics::motions(&c.model, &q, &v, &zero, scratch);
            let _ = energy(&c.model, &q, &v, scratch);
            momentum(&c.model, scratch).lin
        };
        let (after, before) = (at(h, &mut c.scratch), at(-h, &mut c.scratch));
        let mass: f64 = c.model.total_mass();
        for k in 0..3 {
            let rate = (after[k] - before[k]) / (2.0 * h);
            let weight = mass * c.model.gravity()[k];
            assert!((rate - weight).abs() < 1e-5 * (1.0 + weight.abs() + scale(&v_dot)), "{rate} {weight}");
        }
    }
    assert!(seen > 3, "{seen}");
}
