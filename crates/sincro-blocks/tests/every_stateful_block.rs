//! Properties of every block of the categories matrices, nonlinear, continuous, discrete, adaptation and rotations,
//! with all its parameters in use: values on dual numbers and in lanes, the Jacobian's diagonal, refusals.

mod common;

use std::sync::Arc;

use common::{add, assert_same_bits_in_lanes, block, list, made, rows, table};
use sincro_blocks::compile::{Interface, compile};
use sincro_blocks::diagram::Diagram;
use sincro_blocks::kind::Category;
use sincro_blocks::library;
use sincro_blocks::library::sources::Constant;
use sincro_blocks::program::Program;
use sincro_blocks::reader::Value;
use sincro_blocks::runner::Runner;
use sincro_math::Dual;

const STEP: f64 = 0.01;

type Parameters = Vec<(&'static str, Value)>;

/// Every block of these categories: its name, its parameters, the widths of its inputs.
fn examples() -> Vec<(&'static str, Parameters, Vec<usize>)> {
    let linear = || -> Parameters {
        vec![
            ("a", rows(&[&[-3.0, -7.0], &[1.0, -0.5]])),
            ("b", rows(&[&[1.0, 0.5], &[0.0, 1.0]])),
            ("c", rows(&[&[2.0, 5.0]])),
            ("d", list(&[0.0, 1.0])),
            ("initial", list(&[0.1, 0.2])),
        ]
    };
    let pid = |more: Parameters| -> Parameters {
        let mut all: Parameters = vec![
            ("kp", 2.0.into()),
            ("ki", list(&[3.0, 4.0])),
            ("kd", 0.5.into()),
            ("upper", 0.7.into()),
            ("separate", true.into()),
            ("feedforward", true.into()),
            ("initial", 0.3.into()),
        ];
        all.extend(more);
        all
    };
    let lagged = || pid(vec![("output_time_constant", 0.1.into()), ("anti_windup", "clamping".into())]);
    let filter = || -> Parameters { vec![("numerator", list(&[1.0, 2.0])), ("denominator", list(&[1.0, 0.5, 0.25]))] };
    let convention = || -> Parameters { vec![("convention", "xyz".into())] };
    let plant: Parameters = vec![
        ("inputs", vec!["u"].into()),
        ("coordinates", vec!["p", "q"].into()),
        ("mass_matrix", Value::List(vec![vec!["2 + cos(q)", "0.5"].into(), vec!["0.5", "1"].into()])),
        ("forces", vec!["u*g", "t - q'"].into()),
        ("parameters", table(&[("g", 9.81.into())])),
        ("initial", table(&[("q", 0.4.into())])),
    ];
    let grid: Parameters = vec![
        ("row_breakpoints", list(&[0.0, 2.0])),
        ("column_breakpoints", list(&[0.0, 1.0])),
        ("values", rows(&[&[0.0, 1.0], &[2.0, 5.0]])),
    ];
    vec![
        ("integrator", vec![("upper", 0.32.into()), ("reset", true.into()), ("initial", 0.3.into())], vec![2, 1]),
        ("transfer-function", filter(), vec![2]),
        ("state-space", linear(), vec![2]),
        ("low-pass", vec![("time_constant", list(&[0.1, 0.2])), ("dc_gain", 2.0.into())], vec![2]),
        ("derivative", vec![("time_constant", list(&[0.1, 0.2]))], vec![2]),
        ("pid", pid(vec![]), vec![2, 1, 2]),
        ("pid", lagged(), vec![2, 2, 2]),
        ("transport-delay", vec![("delay", 0.025.into()), ("initial", 1.0.into())], vec![2]),
        ("equations", plant, vec![1]),
        ("unit-delay", vec![("initial", 1.0.into())], vec![2]),
        ("delay", vec![("samples", 3.0.into())], vec![2]),
        ("zero-order-hold", vec![], vec![2]),
        ("rate-transition", vec![("delayed", true.into())], vec![2]),
        ("discrete-integrator", vec![("method", "trapezoidal".into()), ("reset", true.into())], vec![2, 1]),
        ("discrete-derivative", vec![("gain", 2.0.into())], vec![2]),
        ("discrete-transfer-function", filter(), vec![2]),
        ("discrete-state-space", linear(), vec![2]),
        ("discrete-pid", pid(vec![("method", "trapezoidal".into())]), vec![2, 1, 2]),
        ("discrete-pid", lagged(), vec![2, 2, 2]),
        ("discrete-low-pass", vec![("time_constant", list(&[0.1, 0.0])), ("initial", 0.5.into())], vec![2]),
        ("command-filter", vec![("natural_frequency", list(&[3.0, 4.0])), ("damping_ratio", 0.5.into())], vec![2]),
        ("fir-filter", vec![("coefficients", list(&[1.0, 2.0, 3.0]))], vec![2]),
        ("iir-filter", vec![("sections", list(&[1.0, 1.0, 0.0, 1.0, -0.5, 0.0]))], vec![2]),
        ("matrix-product", vec![("rows", 2.0.into()), ("transposed", true.into())], vec![6, 4]),
        ("matrix-concatenate", vec![("rows", 2.0.into())], vec![2, 4]),
        ("diagonal", vec![], vec![2]),
        ("normalized-gradient", vec![("gain", list(&[2.0, 0.5, 8.0]))], vec![6, 2]),
        (
            "ellipsoid-projection",
            vec![("bound", 0.05.into()), ("weights", list(&[1.0, 2.0])), ("gain", list(&[800.0, 0.5]))],
            vec![2],
        ),
        ("saturation", vec![("upper", 0.35.into()), ("report", true.into())], vec![2]),
        ("rate-limiter", vec![("rising", 1.0.into()), ("initial", 0.0.into())], vec![2]),
        ("dead-zone", vec![("lower", 0.0.into()), ("upper", 0.2.into())], vec![2]),
        ("quantizer", vec![("interval", 0.1.into())], vec![2]),
        ("single-precision", vec![], vec![2]),
        ("backlash", vec![("width", 0.1.into())], vec![2]),
        ("relay", vec![("on_above", 0.4.into()), ("off_below", 0.1.into())], vec![2]),
        ("coulomb-friction", vec![("coulomb", 1.0.into()), ("viscous", 2.0.into())], vec![2]),
        ("lookup-table", vec![("breakpoints", list(&[0.0, 1.0])), ("values", list(&[2.0, 3.0]))], vec![2]),
        ("lookup-table-2d", grid, vec![2, 1]),
        ("euler-to-quaternion", convention(), vec![3]),
        ("quaternion-to-euler", convention(), vec![4]),
        ("euler-to-matrix", convention(), vec![3]),
        ("matrix-to-euler", convention(), vec![9]),
        ("quaternion-to-matrix", vec![], vec![4]),
        ("matrix-to-quaternion", vec![], vec![9]),
        ("rotate-vector", vec![("inverse", true.into())], vec![4, 3]),
        ("quaternion-product", vec![], vec![4, 4]),
        ("quaternion-conjugate", vec![], vec![4]),
        ("angular-velocity-to-quaternion-rate", vec![("world", true.into())], vec![4, 3]),
        ("euler-rates", convention(), vec![3, 3]),
        ("euler-rates-to-angular-velocity", convention(), vec![3, 3]),
    ]
}

/// The block with constants at its inputs.
fn fed(kind: &str, parameters: &[(&str, Value)], inputs: &[usize]) -> Arc<Program> {
    let made = block(kind, parameters);
    let ports = made.ports().inputs;
    assert_eq!(ports.len(), inputs.len(), "{kind}");
    let mut d = Diagram::new();
    add(&mut d, "block", made);
    for (k, (port, width)) in ports.iter().zip(inputs).enumerate() {
        // near the unit matrix, so that matrices may be taken for rotations
        let is_diagonal = |i: usize| *width == 9 && i.is_multiple_of(4);
        let value = (0..*width).map(|i| if is_diagonal(i) { 0.9 } else { 0.3 - 0.1 * (k + i) as f64 }).collect();
        let name = format!("input-{k}");
        d.block(&name, Constant { value }).wire(&name, &format!("block.{port}"));
    }
    Arc::new(compile(&d, &Interface::new(STEP)).unwrap_or_else(|e| panic!("{kind}: {e:?}")))
}

#[test]
fn no_block_is_forgotten_here() {
    use Category::{Adaptation, Continuous, Discrete, Matrices, Nonlinear, Rotations};
    let known: Vec<&str> = examples().iter().map(|e| e.0).collect();
    let is_own = |group| matches!(group, Matrices | Nonlinear | Continuous | Discrete | Adaptation | Rotations);
    let own = library::all().filter(|i| is_own(i.kind.category));
    for item in own {
        assert!(known.contains(&item.kind.name), "{}", item.kind.name);
    }
}

#[test]
fn values_on_dual_numbers_have_the_bits_of_plain_ones() {
    for (kind, parameters, inputs) in examples() {
        let program = fed(kind, &parameters, &inputs);
        let (mut plain, mut dual) = (Runner::<f64>::new(program.clone()), Runner::<Dual<1>>::new(program.clone()));
        let (mut rates, mut dual_rates) = (vec![0.0; program.n_states], vec![Dual::default(); program.n_states]);
        for tick in 0..20 {
            let t = tick as f64 * STEP;
            plain.evaluate(tick, t);
            dual.evaluate(tick, t);
            for (x, z) in plain.signals().iter().zip(dual.signals()) {
                assert!(x.is_finite() && x.to_bits() == z.value.to_bits(), "{kind}: {x} {z:?}");
            }
            plain.update(tick, t);
            dual.update(tick, t);
            plain.derivatives(tick, t, f64::INFINITY, &mut rates);
            dual.derivatives(tick, t, f64::INFINITY, &mut dual_rates);
            for k in 0..rates.len() {
                assert_eq!(rates[k].to_bits(), dual_rates[k].value.to_bits(), "{kind}");
                plain.state.continuous[k] += STEP * rates[k];
                dual.state.continuous[k] += Dual::constant(STEP) * dual_rates[k];
            }
        }
    }
}

#[test]
fn lanes_have_the_bits_of_each_run_alone() {
    for (kind, parameters, inputs) in examples() {
        assert_same_bits_in_lanes(kind, block(kind, &parameters), &inputs);
    }
}

#[test]
fn the_diagonal_of_the_jacobian_is_the_derivative_by_the_own_state() {
    // formulas may be anything: `equations` tells nothing
    for (kind, parameters, inputs) in examples().into_iter().filter(|e| e.0 != "equations") {
        let program = fed(kind, &parameters, &inputs);
        let n = program.n_states;
        for seed in 0..n {
            let mut runner = Runner::<Dual<1>>::new(program.clone());
            // one limited, one not
            runner.state.continuous[seed] = Dual::variable(0.1, 0);
            runner.evaluate(0, 0.0);
            let (mut rates, mut diagonal) = (vec![Dual::default(); n], vec![Dual::default(); n]);
            runner.derivatives(0, 0.0, f64::INFINITY, &mut rates);
            runner.neg_jacobian_diagonal(0, 0.0, &mut diagonal);
            let (own, told) = (-rates[seed].partials[0], diagonal[seed].value);
            assert!((own - told).abs() < 1e-12 * (1.0 + told.abs()), "{kind}, state {seed}: {own} {told}");
        }
    }
}

#[test]
fn no_parameter_takes_anything() {
    for (kind, parameters, _) in examples() {
        let item = library::find(kind).unwrap();
        for parameter in item.kind.parameters {
            let mut wrong: Parameters = parameters.iter().filter(|(key, _)| *key != parameter.name).cloned().collect();
            wrong.push((parameter.name, table(&[("?", true.into())])));
            assert!(made(kind, &wrong).is_err(), "{kind} takes anything for {}", parameter.name);
        }
    }
}

#[test]
fn every_block_has_a_text_for_its_box_or_none_that_is_long() {
    for (kind, parameters, _) in examples() {
        let label = block(kind, &parameters).label();
        assert!(label.chars().count() <= 32, "{kind}: {label}");
    }
}
