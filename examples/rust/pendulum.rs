//! A pendulum and its energy: a model from the builder, advanced step by step.

use std::error::Error;

use sincro_dynamics::joint::JointKind;
use sincro_dynamics::model::{BodySpec, JointSpec, MassProperties, ModelBuilder, NodeId};
use sincro_dynamics::spatial::Pose;
use sincro_dynamics::state::State;
use sincro_dynamics::world::{MethodKind, World};

fn main() -> Result<(), Box<dyn Error>> {
    let mut builder = ModelBuilder::new([0.0, 0.0, -9.81]);
    let hinge = JointSpec::new(JointKind::Revolute { axis: [0.0, 1.0, 0.0] });
    let hinge = builder.joint("hinge", NodeId::WORLD, Pose::identity(), hinge);
    // a thin rod of 1 kg and 1 m that hangs from its end; inertia about the centre: xx, xy, xz, yy, yz, zz
    let inertia = [1.0 / 12.0, 0.0, 0.0, 1.0 / 12.0, 0.0, 1e-4];
    let mass = MassProperties { mass: 1.0, center_of_mass: [0.0, 0.0, -0.5], inertia };
    builder.body("rod", hinge, Pose::identity(), BodySpec { mass });
    let (model, _warnings) = builder.build().map_err(|diagnostics| format!("{diagnostics:?}"))?;

    let mut state = State::new(&model);
    state.q[0] = 1.0;
    let (accuracy, first_step) = (1e-9, 1e-3);
    let mut world = World::new(model, state, MethodKind::DormandPrince, accuracy, first_step);
    let step = 0.01;
    let start = world.observe(0.0).energy().total();
    println!("   t [s]   angle [rad]   energy [J]");
    for tick in 0..=200_u32 {
        let t = f64::from(tick) * step;
        if tick % 20 == 0 {
            let (angle, energy) = (world.state.q[0], world.observe(t).energy().total());
            println!("{t:8.2}   {angle:11.6}   {energy:10.6}");
        }
        world.advance(t, step).map_err(|(t, stop)| format!("the world stopped at {t} s: {stop:?}"))?;
    }
    let end = world.observe(2.0).energy().total();
    println!("energy drift over 2 s: {:.1e} J", (end - start).abs());
    Ok(())
}
