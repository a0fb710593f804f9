//! Numbers that other programs computed for the same mechanisms.

use std::path::Path;

use sincro_dynamics::world::{MethodKind, World};
use sincro_scene::scene::from_text;

/// Joint accelerations at the initial position with every hinge at 0.3 rad/s, a free body at rest.
fn accelerations(model: &str) -> Vec<f64> {
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("../sincro-bench/models").join(model).join("scene.toml");
    let scene = from_text(&std::fs::read_to_string(file).unwrap()).unwrap();
    let mut state = scene.initial.clone();
    for joint in scene.model.names().joints.iter().filter(|j| j.n_v == 1) {
        state.v[joint.v_idx] = 0.3;
    }
    let mut world = World::new((*scene.model).clone(), state, MethodKind::Rk4, 1.0, 1.0);
    world.observe(0.0).accelerations.to_vec()
}

#[test]
fn accelerations_agree_with_mujoco_and_pinocchio() {
    let table: toml::Table = include_str!("accelerations.toml").parse().unwrap();
    let mut compared = 0;
    for (program, models) in &table {
        for (model, theirs) in models.as_table().unwrap() {
            let toml::Value::Array(theirs) = theirs else { continue };
            let theirs: Vec<f64> = theirs.iter().map(|x| x.as_float().unwrap()).collect();
            let ours = accelerations(model);
            let scale = theirs.iter().fold(1.0_f64, |s, x| s.max(x.abs()));
            assert_eq!(ours.len(), theirs.len(), "{program} {model}");
            for (a, b) in ours.iter().zip(&theirs) {
                // 1e-11 of the largest: what the two programs themselves differ by on alexandros is 1e-12
                assert!((a - b).abs() < 1e-11 * scale, "{program} {model}: {a} {b}");
            }
            compared += 1;
        }
    }
    assert_eq!(compared, 7);
}
