//! Numbers that a world can change between two base steps: tunable parameters.

use sincro_dynamics::ids::{BodyId, MotorId};
use sincro_dynamics::model::MassProperties;
use sincro_dynamics::world::World;
use sincro_scene::scene::ObjectKind;
use sincro_sim::Loaded;

/// Quantity of a running world behind a tunable parameter of an FMU: what
/// [`Role::Tunable`](crate::variables::Role::Tunable) changes.
#[derive(Clone, Debug, PartialEq)]
pub enum Tunable {
    /// Component of gravity `[m/s²]`, world axes: 0 x, 1 y, 2 z.
    Gravity(usize),
    /// Mass property of a body: the body's index among the model's frames, then 0 for the mass `[kg]`, 1–3 for the
    /// centre of mass x, y, z `[m]`, 4–9 for the inertia xx, xy, xz, yy, yz, zz `[kg·m²]`.
    Mass(usize, usize),
    /// Parameter of a motor, by the motor's index among the model's.
    Motor(usize, MotorNumber),
}

/// Parameter of a motor that can be changed while the world runs; the units are those of a revolute or of a prismatic
/// joint.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MotorNumber {
    /// Gain of position control `[1/s]`.
    Kp,
    /// Stiffness of spring-damper control `[N·m/rad]` or `[N/m]`.
    Stiffness,
    /// Damping of spring-damper control `[N·m·s/rad]` or `[N·s/m]`.
    Damping,
    /// Largest effort `[N·m]` or `[N]`.
    MaxTorque,
    /// Largest velocity `[rad/s]` or `[m/s]`.
    MaxVelocity,
}

/// Meaning of a path that a running world can change; none if it cannot.
pub(crate) fn tunable(path: &str, loaded: &Loaded) -> Option<Tunable> {
    if let Some(component) = path.strip_prefix("gravity.") {
        return component.parse().ok().filter(|k| *k < 3).map(Tunable::Gravity);
    }
    let (object, key) = path.split_once('.')?;
    let scene = &loaded.scene;
    match scene.object(object)?.kind {
        ObjectKind::Body { .. } => {
            let names = scene.model.names();
            let frame = names.frames.iter().position(|f| f.name == object && f.link.is_some() && f.is_body)?;
            mass_number(key).map(|number| Tunable::Mass(frame, number))
        }
        ObjectKind::Joint { motor: Some(motor), .. } => {
            let (motor, key) = match key.strip_prefix("motor.")?.split_once('.') {
                // one of several: `motor.K.max_torque`
                Some((k, key)) => (scene.model.names().joint(object)?.motors().nth(k.parse().ok()?)?.index(), key),
                None => (motor, key.strip_prefix("motor.")?),
            };
            let number = match key {
                "kp" => MotorNumber::Kp,
                "stiffness" => MotorNumber::Stiffness,
                "damping" => MotorNumber::Damping,
                "max_torque" => MotorNumber::MaxTorque,
                "max_velocity" => MotorNumber::MaxVelocity,
                _ => return None,
            };
            Some(Tunable::Motor(motor, number))
        }
        _ => None,
    }
}

fn mass_number(key: &str) -> Option<usize> {
    const KEYS: [&str; 10] = [
        "mass",
        "center_of_mass.0",
        "center_of_mass.1",
        "center_of_mass.2",
        "inertia.xx",
        "inertia.xy",
        "inertia.xz",
        "inertia.yy",
        "inertia.yz",
        "inertia.zz",
    ];
    KEYS.iter().position(|known| *known == key)
}

/// Sets a number of the world.
///
/// # Errors
///
/// No body has such a mass, or the number means nothing.
pub(crate) fn set(world: &mut World, what: &Tunable, value: f64) -> Result<(), String> {
    if value.is_nan() {
        return Err("not a number".into());
    }
    match *what {
        Tunable::Gravity(k) => {
            let mut gravity = world.model().gravity();
            gravity.0[k] = value;
            world.set_gravity(gravity);
        }
        Tunable::Mass(frame, number) => set_mass(world, BodyId::new(frame), number, value)?,
        Tunable::Motor(motor, number) => {
            if value < 0.0 {
                return Err(format!("{value} is negative"));
            }
            let mut changed = world.model().motors()[motor];
            match number {
                MotorNumber::Kp => changed.kp = value,
                MotorNumber::Stiffness => changed.stiffness = value,
                MotorNumber::Damping => changed.damping = value,
                MotorNumber::MaxTorque => changed.max_torque = value,
                MotorNumber::MaxVelocity => changed.max_velocity = value,
            }
            world.set_motor(MotorId::new(motor), changed);
        }
    }
    Ok(())
}

fn set_mass(world: &mut World, body: BodyId, number: usize, value: f64) -> Result<(), String> {
    let mut mass = *world.model().mass_properties(body).ok_or("it has no mass of its own")?;
    match number {
        0 => mass.mass = value,
        1..=3 => mass.center_of_mass[number - 1] = value,
        _ => mass.inertia[number - 4] = value,
    }
    check(&mass)?;
    world.set_mass_properties(body, mass);
    Ok(())
}

/// A body has a positive mass, and moments of inertia that satisfy the triangle inequality in its own axes.
fn check(mass: &MassProperties) -> Result<(), String> {
    let [xx, _, _, yy, _, zz] = mass.inertia;
    if !(mass.mass.is_finite() && mass.mass > 0.0) {
        return Err(format!("a mass of {} kg is not positive", mass.mass));
    }
    let is_finite = mass.inertia.iter().chain(&mass.center_of_mass).all(|x| x.is_finite());
    let slack = 1e-9 * (xx + yy + zz);
    let fits =
        xx >= 0.0 && yy >= 0.0 && zz >= 0.0 && xx <= yy + zz + slack && yy <= xx + zz + slack && zz <= xx + yy + slack;
    if is_finite && fits { Ok(()) } else { Err(format!("no body has the moments of inertia {xx}, {yy}, {zz}")) }
}
