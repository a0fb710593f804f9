//! Cost of a block diagram in a step: a controller of a hundred blocks on a two-link arm, against the same arm without
//! it.

use sincro_blocks::diagram::Diagram;
use sincro_blocks::library::continuous::{Integrator, LowPass};
use sincro_blocks::library::discrete::{DiscretePid, DiscreteTransferFunction, UnitDelay};
use sincro_blocks::library::maths::{Gain, Product, Sum};
use sincro_blocks::library::nonlinear::{RateLimiter, Saturation};
use sincro_blocks::library::sources::Sine;
use sincro_dynamics::world::MethodKind;
use sincro_scene::diagram::ControlDiagram;
use sincro_scene::scene::from_text;
use sincro_sim::Loaded;
use sincro_sim::run::LockStep;

use super::clock::Subject;
use super::subjects::{STEP, STEPS_A_SECOND, default_experiment};

use crate::extensions;

/// Two links with torque motors.
const ARM: &str = r#"
joint = [
  { name = "shoulder", kind = "revolute", axis = [0, 1, 0], damping = 0.1, motor = { mode = "torque" } },
  { name = "elbow", parent = "/shoulder/upper", kind = "revolute", axis = [0, 1, 0], position = [0, 0, -0.5], damping = 0.1, motor = { mode = "torque" } },
]
body = [
  { name = "upper", parent = "/shoulder", mass = 1, center_of_mass = [0, 0, -0.25], inertia = { xx = 0.021, yy = 0.021, zz = 0.00045 } },
  { name = "fore", parent = "/shoulder/upper/elbow", mass = 0.8, center_of_mass = [0, 0, -0.2], inertia = { xx = 0.0108, yy = 0.0108, zz = 0.00036 } },
]
"#;

/// Ten loops of ten blocks, five on each motor: everything sampled at every step.
fn sampled() -> Diagram {
    let mut d = Diagram::new();
    for k in 0..10 {
        let name = |what: &str| format!("{what}{k}");
        let joint = ["/shoulder", "/shoulder/upper/elbow"][k / 5];
        d.sampled(&name("reference"), STEP, Sine::new(0.3, 2.0 + k as f64));
        d.sampled(&name("error"), STEP, Sum::new("+-"));
        d.block(&name("filter"), DiscreteTransferFunction::new(&[0.5], &[1.0, -0.5]));
        d.block(&name("pid"), DiscretePid::new(2.0, 1.0, 0.01));
        d.block(&name("scale"), Gain::new(0.5));
        d.block(&name("limit"), Saturation::new(-2.0, 2.0));
        d.block(&name("slew"), RateLimiter::new(500.0));
        d.block(&name("delay"), UnitDelay::new(0.0));
        d.block(&name("product"), Product::new(2));
        d.block(&name("sum"), Sum::new("+++"));
        d.wire(&name("reference"), &format!("error{k}.u1")).wire(&format!("{joint}.position"), &format!("error{k}.u2"));
        for (from, to) in
            [("error", "filter"), ("filter", "pid"), ("pid", "scale"), ("scale", "limit"), ("limit", "slew")]
        {
            d.wire(&name(from), &name(to));
        }
        d.wire(&name("slew"), &name("delay"));
        d.wire(&name("slew"), &format!("product{k}.u1")).wire(&name("delay"), &format!("product{k}.u2"));
        d.wire(&name("slew"), &format!("sum{k}.u1")).wire(&name("product"), &format!("sum{k}.u2"));
        let before = if k % 5 == 0 { name("delay") } else { format!("sum{}", k - 1) };
        d.wire(&before, &format!("sum{k}.u3"));
    }
    d.wire("sum4", "/shoulder").wire("sum9", "/shoulder/upper/elbow");
    d
}

/// Fifty lags and integrators with a sum or gain each: all integrated with the arm.
fn continuous() -> Diagram {
    let mut d = Diagram::new();
    d.block("reference", Sine::new(0.3, 2.0));
    for k in 0..25 {
        let name = |what: &str| format!("{what}{k}");
        let before = if k == 0 { "reference".to_owned() } else { format!("lag{}", k - 1) };
        d.block(&name("error"), Sum::new("+-")).block(&name("gain"), Gain::new(5.0));
        d.block(&name("integrator"), Integrator::new(0.0)).block(&name("lag"), LowPass::new(0.05));
        d.wire(&before, &format!("error{k}.u1")).wire(&name("integrator"), &format!("error{k}.u2"));
        d.wire(&name("error"), &name("gain")).wire(&name("gain"), &name("integrator"));
        d.wire(&name("integrator"), &name("lag"));
    }
    d.wire("lag24", "/shoulder");
    d
}

/// A step of the arm with a diagram, or without.
fn step(diagram: Option<Diagram>, method: MethodKind) -> Subject {
    let scene = from_text(ARM).expect("the scene is right");
    let controller = diagram.map(|d| ControlDiagram::new(d, &scene.model, STEP, 0).expect("the diagram is right"));
    let experiment = default_experiment(STEP, 1.0);
    let loaded = Loaded {
        experiment,
        scene: scene.into(),
        controller,
        warnings: Vec::new(),
        sources: Vec::new(),
        folder: std::sync::Arc::default(),
        overrides: Vec::new(),
        extensions: extensions(),
        controllers: Vec::new(),
        trials: std::sync::Arc::default(),
    };
    let mut run = LockStep::new(&loaded, method, false);
    run.start().expect("finite");
    let start = run.snapshot(sincro_sim::trace::Trace(0));
    let second = move || {
        run.restore(&start);
        for _ in 0..STEPS_A_SECOND {
            run.advance().expect("stays finite");
        }
    };
    Subject::new(second).with_units(f64::from(STEPS_A_SECOND))
}

/// A figure: its key, the number of blocks, the same step with and without the diagram.
pub(super) fn figures() -> [(&'static str, Subject, Subject); 2] {
    let euler = MethodKind::SemiImplicitEuler;
    [
        ("diagram of 100 blocks adds", step(Some(sampled()), euler), step(None, euler)),
        ("continuous diagram adds", step(Some(continuous()), euler), step(None, euler)),
    ]
}
