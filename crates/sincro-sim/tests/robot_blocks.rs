//! Blocks that use the model, against the world that they are about.

use sincro_blocks::diagram::Diagram;
use sincro_dynamics::world::MethodKind;
use sincro_scene::diagram::ControlDiagram;
use sincro_scene::diagram::robot::{
    Context, ForwardKinematics, GravityTorque, InverseDynamics, Jacobian, JacobianRows, MassMatrix,
};
use sincro_scene::scene::{Scene, from_text};
use sincro_sim::run::LockStep;
use sincro_sim::{Extensions, Loaded, load};

/// A shoulder, an elbow out of plane and a tool, under gravity, with torque motors.
const ARM: &str = r#"
joint = [
  { name = "shoulder", kind = "revolute", axis = [0, 1, 0], initial = { position = 0.4, velocity = 0.7 }, motor = { mode = "torque" } },
  { name = "elbow", parent = "/shoulder/upper", kind = "revolute", axis = [1, 0, 0], position = [0, 0, -0.5], initial = { position = -0.3, velocity = 1.1 }, motor = { mode = "torque" } },
]
body = [
  { name = "upper", parent = "/shoulder", mass = 1.0, center_of_mass = [0.02, 0, -0.25], inertia = { xx = 0.021, yy = 0.022, zz = 0.002 } },
  { name = "fore", parent = "/shoulder/upper/elbow", mass = 0.8, center_of_mass = [0, 0.01, -0.2], inertia = { xx = 0.011, yy = 0.012, zz = 0.002 } },
]
frame = [{ name = "tool", parent = "/shoulder/upper/elbow/fore", position = [0.05, 0, -0.4], rotation_deg = [10, 20, 30] }]
"#;

fn arm() -> Scene {
    from_text(ARM).unwrap_or_else(|diagnostics| panic!("{diagnostics}"))
}

fn with(scene: Scene, draw: impl FnOnce(&mut Diagram, &Context, usize)) -> LockStep {
    let folder = sincro_testing::repository_scene("two-dof-position");
    let loaded = load(&folder, &[], Extensions::default()).unwrap();
    let tool = scene.model.names().frames.iter().position(|f| f.name.ends_with("tool")).unwrap();
    let (mut diagram, context) = (Diagram::new(), Context { parser: None, fmus: None, model: scene.model.clone() });
    draw(&mut diagram, &context, tool);
    let controller = ControlDiagram::new(diagram, &scene.model, 0.005, 0).unwrap_or_else(|p| panic!("{p:?}"));
    let loaded = Loaded { scene: scene.into(), controller: Some(controller), ..loaded };
    let mut run = LockStep::new(&loaded, MethodKind::DormandPrince, false);
    run.start().unwrap();
    run
}

fn output(run: &LockStep, name: &str) -> Vec<f64> {
    let control = run.control().unwrap();
    let program = control.wiring().program();
    let (_, range, _) = program.outputs().find(|(known, ..)| known == name).unwrap();
    control.signals()[range].to_vec()
}

fn assert_near(a: &[f64], b: &[f64], tolerance: f64) {
    assert!(a.len() == b.len() && a.iter().zip(b).all(|(a, b)| (a - b).abs() <= tolerance), "{a:?} {b:?}");
}

#[test]
fn kinematics_are_those_of_the_world() {
    let run = with(arm(), |d, context, tool| {
        d.block("fk", ForwardKinematics::new(context, tool, true));
        d.block("j", Jacobian::new(context, tool, JacobianRows::All));
        d.wire("world.q", "fk.q").wire("world.v", "fk.v").wire("world.q", "j");
        let path = "/shoulder/upper/elbow/fore/tool";
        for what in ["position", "quaternion", "velocity", "angular_velocity"] {
            d.block(&format!("world_{what}"), sincro_blocks::library::maths::Gain::new(1.0));
            d.wire(&format!("{path}.{what}"), &format!("world_{what}"));
        }
    });
    for what in ["position", "quaternion", "velocity", "angular_velocity"] {
        assert_near(&output(&run, &format!("fk.{what}")), &output(&run, &format!("world_{what}")), 1e-14);
    }
    let (j, v) = (output(&run, "j"), &run.state().v);
    let times_v: Vec<f64> = j.chunks(2).map(|row| row[0] * v[0] + row[1] * v[1]).collect();
    assert_near(&times_v[..3], &output(&run, "fk.angular_velocity"), 1e-14);
    assert_near(&times_v[3..], &output(&run, "fk.velocity"), 1e-14);
}

/// Inverse dynamics of the accelerations that torques cause are those torques.
#[test]
fn inverse_dynamics_undo_the_world() {
    let run = with(arm(), |d, context, _| {
        use sincro_blocks::library::sources::Constant;
        d.block("torque", Constant { value: vec![1.5, -0.7] });
        d.wire("torque[0]", "/shoulder").wire("torque[1]", "/shoulder/upper/elbow");
        d.block("id", InverseDynamics::new(context));
        d.wire("world.q", "id.q").wire("world.v", "id.v");
        d.wire("[/shoulder.acceleration, /shoulder/upper/elbow.acceleration]", "id.a");
        d.block("mass", MassMatrix::new(context)).wire("world.q", "mass");
    });
    assert_near(&output(&run, "id"), &[1.5, -0.7], 1e-12);
    let m = output(&run, "mass");
    assert!((m[1] - m[2]).abs() < 1e-15 && m[0] > 0.0 && m[0] * m[3] > m[1] * m[2], "{m:?}");
}

#[test]
fn gravity_torque_holds_the_arm_still() {
    let mut scene = arm();
    scene.initial.v.fill(0.0);
    let start = scene.initial.q.clone();
    let mut run = with(scene, |d, context, _| {
        d.block("g", GravityTorque::new(context)).wire("world.q", "g");
        d.wire("g[0]", "/shoulder").wire("g[1]", "/shoulder/upper/elbow");
    });
    assert!(output(&run, "g").iter().all(|g| g.abs() > 0.1), "{:?}", output(&run, "g"));
    (0..200).for_each(|_| run.advance().unwrap());
    assert_near(&run.state().q, &start, 1e-9);
}
