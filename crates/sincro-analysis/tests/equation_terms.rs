//! Terms of the equations of motion against each other, with armature, springs of every kind and tendons.

use sincro_analysis::dynamics::{EquationTerms, EvaluationPoint, equation_terms};
use sincro_testing::SceneFolder;

const SCENE: &str = r#"
[[joint]]
name = "shoulder"
kind = "revolute"
axis = [0.0, 1.0, 0.0]
armature = 0.3
spring = { stiffness = 4.0, rest = 0.2 }
damping = 0.5

[[body]]
name = "upper"
parent = "/shoulder"
position = [0.0, 0.0, -0.5]
mass = 2.0
inertia = { xx = 0.1, yy = 0.2, zz = 0.05 }

[[joint]]
name = "elbow"
parent = "upper"
kind = "revolute"
axis = [0.3, 1.0, 0.1]
position = [0.0, 0.0, -0.4]
armature = 0.2

[[body]]
name = "lower"
parent = "elbow"
position = [0.1, 0.0, -0.3]
mass = 1.0
inertia = { xx = 0.03, yy = 0.04, zz = 0.02 }

[[joint]]
name = "slide"
parent = "lower"
kind = "prismatic"
axis = [1.0, 0.0, 0.0]

[[body]]
name = "tool"
parent = "slide"
mass = 0.5
inertia = { xx = 0.01, yy = 0.01, zz = 0.01 }

[[frame]]
name = "eyelet"
parent = "upper"
position = [0.2, 0.1, 0.0]

[[spring_damper]]
name = "line"
between = ["/", "lower"]
points = [[0.5, 0.2, 0.3], [0.0, 0.1, 0.0]]
stiffness = 20.0
damping = 1.5

[[tendon]]
name = "cord"
through = ["/", "/shoulder/upper/eyelet", "tool"]
stiffness = 30.0
damping = 2.0
free_length = 0.4
actuator = { command = 9.0 }

[[tendon]]
name = "sum"
joints = ["shoulder", "elbow", "slide"]
coefficients = [0.2, -0.1, 1.0]
stiffness = 12.0
damping = 0.8
free_length = 0.05

[[coupling]]
name = "gear"
joints = ["shoulder", "elbow"]
ratio = 0.7
offset = 0.1
stiffness = 15.0
damping = 0.3
"#;

const EXPERIMENT: &str = "title = \"Terms\"\nduration = 0.1\nstep = 0.01\nrecord = [\"energy.potential\"]\n";

fn apply(matrix: &[f64], x: &[f64]) -> Vec<f64> {
    matrix.chunks(x.len()).map(|row| row.iter().zip(x).map(|(a, b)| a * b).sum()).collect()
}

#[test]
fn the_terms_are_those_of_one_equation() {
    let loaded = SceneFolder::of(SCENE, EXPERIMENT).load(&[]).unwrap();
    let model = &loaded.scene.model;
    let at = |q: [f64; 3], v: [f64; 3], v_dot: [f64; 3], torque: [f64; 3]| -> EquationTerms {
        let [q, v, v_dot, torque] = [q, v, v_dot, torque].map(Vec::from);
        equation_terms(model, &EvaluationPoint { q, v, v_dot, torque }).unwrap()
    };
    for draw in 0..40 {
        let number = |k: usize| 2.0 * ((draw * 12 + k) as f64 * 0.618_033_988_749_895).fract() - 1.0;
        let [q, v, a, torque] = [0, 3, 6, 9].map(|first| [number(first), number(first + 1), number(first + 2)]);
        let (terms, still) = (at(q, v, a, torque), at(q, v, [0.0; 3], [0.0; 3]));
        let close = |a: f64, b: f64| assert!((a - b).abs() < 1e-10 * (1.0 + b.abs()), "draw {draw}: {a} {b}");
        for (k, force) in apply(&terms.mass_matrix, &a).iter().enumerate() {
            close(terms.inverse_dynamics[k] - still.inverse_dynamics[k], *force);
        }
        for (k, force) in apply(&terms.mass_matrix, &terms.forward_dynamics).iter().enumerate() {
            close(force + still.inverse_dynamics[k], torque[k]);
        }
        // passive forces: minus the gradient of the energy stored in springs, here by differences, less damping
        let energy = |q: [f64; 3]| {
            let mut scratch = sincro_dynamics::scratch::Scratch::new(model);
            let weight = at(q, [0.0; 3], [0.0; 3], [0.0; 3]);
            (sincro_dynamics::energy::energy_at(model, &q, &[0.0; 3], &mut scratch).potential, weight)
        };
        let rest = at(q, [0.0; 3], [0.0; 3], [0.0; 3]);
        for k in 0..3 {
            let h = 1e-5;
            let moved = |s: f64| {
                let mut q = q;
                q[k] += s;
                energy(q).0
            };
            let slope = (moved(h) - moved(-h)) / (2.0 * h);
            // gravity is in inverse_dynamics
            assert!((rest.passive[k] - rest.inverse_dynamics[k] + slope).abs() < 1e-6, "draw {draw}, {k}");
        }
        let dissipated: f64 = (0..3).map(|k| (rest.passive[k] - still.passive[k]) * v[k]).sum();
        assert!(dissipated > 0.0, "draw {draw}: {dissipated}");
        let twice: [f64; 3] = std::array::from_fn(|k| 2.0 * v[k]);
        let double = at(q, twice, [0.0; 3], [0.0; 3]);
        for k in 0..3 {
            close(double.passive[k] - rest.passive[k], 2.0 * (still.passive[k] - rest.passive[k]));
        }
    }
}
