//! Scenes that switch: model exchange, whose importer integrates, cannot follow them yet.

use sincro_dynamics::actuation::DriveKind;
use sincro_sim::Loaded;

/// Reasons why a scene cannot be exported for model exchange, one sentence each with the name of the element (friction,
/// joint limits, contacts, closed loops, sampled sensors, scripts); empty if it can.
#[must_use]
pub fn reasons(loaded: &Loaded) -> Vec<String> {
    let mut reasons = Vec::new();
    let model = &loaded.scene.model;
    let names = model.names();
    for drive in model.drives() {
        let joint = names.dof_name(drive.dof);
        reasons.push(match drive.kind {
            DriveKind::Lock => continue,
            DriveKind::Friction => format!("joint `{joint}` has friction, which sticks and slips"),
            DriveKind::Motor(_) => format!("the motor of joint `{joint}` is ideal, or has a limit"),
        });
    }
    let set = model.constraints();
    if !set.limits.is_empty() {
        reasons.push(format!("joint `{}` has limits", names.dof_name(set.limits[0].dof)));
    }
    if !set.pairs.is_empty() {
        reasons.push("bodies can touch".into());
    }
    if let Some(joint) = set.loop_joints.first() {
        reasons.push(format!("`{}` closes a loop", joint.name));
    }
    if let Some(gear) = set.gears.first() {
        reasons.push(format!("`{}` couples joints", gear.name));
    }
    if let Some(sensor) = loaded.scene.sensors.first() {
        reasons.push(format!("the sensor `{}` samples", sensor.path));
    }
    if let Some(script) = loaded.scene.scripts.first() {
        reasons.push(format!("the script of `{}` acts in steps", script.path));
    }
    reasons
}
