//! A controller in Rust, in lock-step with the simulation: it measures, computes, commands, and the simulation steps.

use std::error::Error;
use std::path::Path;

use sincro::serve;
use sincro_coppelia::api::Search;
use sincro_math::elementary::sin_cos;

/// Angle to be reached `[rad]`.
const SETPOINT: f64 = 0.5;

fn main() -> Result<(), Box<dyn Error>> {
    let scene = Path::new(env!("CARGO_MANIFEST_DIR")).join("motor");
    // a step of the controller is one base step of the experiment
    let mut session = serve::open(&scene, &[], Some(0.005))?;
    let hinge = session.registry().find("/hinge", Search::default())?;
    session.start()?;
    let weight = 1.0 * 9.81 * 0.25;
    while session.t() < 3.0 {
        let mut objects = session.sim();
        let (angle, velocity) = (objects.joint_position(hinge)?, objects.joint_velocity(hinge)?);
        // the sine of the library has the same bits on every platform
        let (sin, _) = sin_cos(angle);
        // proportional-derivative control with the weight of the arm compensated
        let torque = 20.0 * (SETPOINT - angle) - 2.0 * velocity + weight * sin;
        objects.set_target_force(hinge, torque, true)?;
        if session.steps() % 100 == 0 {
            println!("{:5.2} s   {angle:8.5} rad   {torque:8.4} N·m", session.t());
        }
        session.step()?;
    }
    let angle = session.sim().joint_position(hinge)?;
    println!("control error after 3 s: {:.1e} rad", (SETPOINT - angle).abs());
    session.stop()?;
    Ok(())
}
