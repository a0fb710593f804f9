//! A PID controller in a block diagram that is drawn in Rust, on an arm with a torque motor.

use std::error::Error;
use std::path::Path;

use sincro_blocks::diagram::Diagram;
use sincro_blocks::library::discrete::DiscretePid;
use sincro_blocks::library::maths::Sum;
use sincro_blocks::library::sources::Constant;
use sincro_scene::diagram::ControlDiagram;

/// Angle to be reached `[rad]`.
const SETPOINT: f64 = 0.5;
/// Sample time of the controller `[s]`: a whole multiple of the base step.
const SAMPLE_TIME: f64 = 0.01;

fn main() -> Result<(), Box<dyn Error>> {
    let scene = Path::new(env!("CARGO_MANIFEST_DIR")).join("motor");
    let mut loaded = sincro::load(&scene, &[])?;

    let mut diagram = Diagram::new();
    diagram.block("setpoint", Constant::new(SETPOINT));
    diagram.sampled("error", SAMPLE_TIME, Sum::new("+-"));
    diagram.sampled("pid", SAMPLE_TIME, DiscretePid::new(20.0, 15.0, 2.0));
    diagram.wire("setpoint", "error.u1").wire("/hinge.position", "error.u2");
    diagram.wire("error", "pid").wire("pid", "/hinge");
    let (step, seed) = (loaded.experiment.step, loaded.experiment.seed);
    let controller = ControlDiagram::new(diagram, &loaded.scene.model, step, seed);
    loaded.controller = Some(controller.map_err(|diagnostics| format!("{diagnostics:?}"))?);

    let simulated = sincro::simulate(&loaded)?;
    let angle = simulated.table.column("/hinge.position").ok_or("the experiment records the angle")?;
    for (t, angle) in simulated.table.times().iter().zip(&angle.values).step_by(50) {
        println!("{t:5.2} s   {angle:8.5} rad");
    }
    let last = angle.values.last().ok_or("nothing was recorded")?;
    println!("control error after {} s: {:.1e} rad", loaded.experiment.duration, (SETPOINT - last).abs());
    Ok(())
}
