//! The reference of units, conventions and signals, from the catalogue: `docs/signals.md`.
//!
//! A scene with one object of each kind is compiled, and its catalogue is the list of signals: none can be missing. The
//! meanings are those of [`meaning`], which has an arm for every probe.

use std::fmt::Write as _;

use super::{
    BushingQuantity, ContactQuantity, EnergyQuantity, Entry, FrameQuantity, GearQuantity, LineQuantity, Probe,
    RotorQuantity, WindingQuantity, catalogue,
};
use crate::scene::from_text;

/// A scene that has all signals.
const SAMPLE: &str = include_str!("sample.toml");

/// Objects of the sample with the headings of their tables; `""` takes the rest.
const SECTIONS: [(&str, &str); 21] = [
    ("/slide", "Prismatic joint"),
    ("/hinge", "Revolute joint, with a motor, a spring and stops; a screw joint has the same"),
    ("/wheel", "Revolute joint with a motor in mode `voltage`"),
    ("/universal", "Universal joint: two angles"),
    ("/ball", "Ball joint, with velocity motors"),
    ("/planar", "Planar joint"),
    ("/free", "Free joint, with torque motors"),
    (
        "/free/solid",
        "Body with contact; without contact the first seven rows, and for a frame without the centre of mass",
    ),
    ("/free/solid/load", "Force cell: a fixed joint with `force_sensor`"),
    ("/free/solid/push", "External force that takes commands"),
    ("/free/solid/rotor", "Rotor; without a lag there is no command beside the speed"),
    ("/free/solid/hull", "Drag element"),
    (
        "/cable",
        "Spring, damper and actuator between two points; without an actuator there is no command, without an activation none",
    ),
    ("/mount", "Bushing: a compliant element between two frames"),
    ("/teeth", "Elastic coupling; a rigid one has the signal of closures"),
    ("/free/solid/imu", "Inertial measurement unit; this and all other sensors also have the signals of a frame"),
    ("/free/solid/pose", "Pose sensor"),
    ("/free/solid/speed", "Velocity sensor"),
    ("/free/solid/height", "Height sensor"),
    ("/free/solid/bumper", "Contact sensor"),
    ("/free/solid/eye", "Proximity sensor"),
];

/// Returns the reference of recorded signals `docs/signals.md` as Markdown.
#[must_use]
pub fn signal_reference() -> String {
    let scene = from_text(SAMPLE).unwrap_or_else(|found| panic!("the sample scene does not compile: {found}"));
    let all = catalogue(&scene.model);
    let mut text = String::from(include_str!("conventions.md"));
    for (object, heading) in SECTIONS {
        let of_object = || all.iter().filter(|entry| object_of(&entry.name) == object);
        // a sensor is a frame too
        let is_sensor = of_object().any(|entry| matches!(entry.probe, Probe::Sensor(_)));
        let own: Vec<&Entry> =
            of_object().filter(|entry| !is_sensor || matches!(entry.probe, Probe::Sensor(_))).collect();
        assert!(!own.is_empty(), "the sample scene has no {object}");
        section(&mut text, heading, object, &own);
    }
    let is_known = |name: &str| SECTIONS.iter().any(|(object, _)| object_of(name) == *object);
    let closures: Vec<&Entry> = all.iter().filter(|e| matches!(e.probe, Probe::Opening(_))).collect();
    section(&mut text, "Closures and couplings", "/pin", &closures);
    let world: Vec<&Entry> = all.iter().filter(|e| !e.name.starts_with('/') && !is_known(&e.name)).collect();
    section(&mut text, "The world", "", &world);
    text.push_str(
        "\n## Other signals\n\nOutputs of blocks are signals under the name of the block or the wire, with the unit that the diagram gives them; \
         vectors have components in brackets, `speed[0]`. `float_signal.NAME` is the float signal NAME that scripts and clients set, NaN where it is not set. \
         `sincro check SCENE --signals` lists all signals of a scene.\n",
    );
    text
}

/// Path of the object to which a signal belongs; for the world's the whole name.
fn object_of(name: &str) -> &str {
    match name.split_once('.') {
        Some((object, _)) if object.starts_with('/') => object,
        _ => name,
    }
}

fn section(text: &mut String, heading: &str, object: &str, entries: &[&Entry]) {
    let _ = write!(text, "\n### {heading}\n\n| signal | unit | meaning |\n|---|---|---|\n");
    let mut k = 0;
    while k < entries.len() {
        let entry = entries[k];
        let stem = stem(&entry.name);
        let same = entries[k..].iter().take_while(|e| self::stem(&e.name) == stem && means(e) == means(entry)).count();
        let short = |name: &str| if object.is_empty() { name.to_owned() } else { name.replacen(object, "", 1) };
        let components: Vec<&str> = entries[k..k + same].iter().map(|e| &e.name[stem.len()..]).collect();
        let name = match same {
            1 => format!("`{}`", short(&entry.name)),
            _ => format!("`{}` `{}`", short(&format!("{stem}{}", components[0])), components[1..].join("` `")),
        };
        let unit = if entry.unit.is_empty() { "—" } else { &entry.unit };
        let _ = writeln!(text, "| {name} | {unit} | {} |", means(entry));
        k += same;
    }
}

/// The name without its last component, if that is one of a vector.
fn stem(name: &str) -> &str {
    let is_component = |last: &str| ["x", "y", "z", "w", "1", "2", "angle", "roll", "pitch", "yaw"].contains(&last);
    name.rsplit_once('.').filter(|(_, last)| is_component(last)).map_or(name, |(stem, _)| stem)
}

fn means(entry: &Entry) -> String {
    match entry.probe {
        Probe::Sensor(_) => measured(stem(&entry.name)).to_owned(),
        probe => meaning(probe).to_owned(),
    }
}

/// Meaning of the values of sensors, which the model knows by name alone.
fn measured(name: &str) -> &'static str {
    match name.rsplit('.').next().unwrap_or(name) {
        "accelerometer" => {
            "specific force (acceleration minus gravity), own axes, as last sampled, with bias and noise"
        }
        "gyro" => "angular velocity, own axes, as last sampled, with bias and noise",
        "measured_position" => "position in the world, as last sampled",
        "measured_quaternion" => "orientation in the world, as last sampled",
        "measured_roll" | "measured_pitch" | "measured_yaw" => "angle of the measured orientation",
        "measured_velocity" => "velocity of its origin, as last sampled",
        "measured_height" => "height over z = 0, as last sampled",
        "measured_force" => "sum of the contact forces on its body, own axes",
        "measured_torque" => "sum of their moments about its origin, own axes",
        "touching" => "1 where a point of contact presses with more than the threshold, else 0",
        "points" => "number of points that press",
        "detected" => "1 where something is in its volume, else 0",
        "distance" => "distance of the closest point in its volume; its far end where there is none",
        "detected_point" => "the closest point, own axes; 0 where there is none",
        "detected_normal" => "normal of the surface there, own axes; 0 where there is none",
        other => panic!("the value `{other}` of a sensor has no meaning in the reference"),
    }
}

/// Meaning of a signal.
fn meaning(probe: Probe) -> &'static str {
    use ContactQuantity as C;
    use EnergyQuantity as E;
    use FrameQuantity as F;
    use RotorQuantity as R;
    use WindingQuantity as W;
    match probe {
        Probe::Coordinate(_) => "joint coordinate",
        Probe::Rate(_) => "its rate; of ball and free joints the velocity against the parent, in axes of the child",
        Probe::Acceleration(_) => "derivative of the rate at this instant",
        Probe::Command(_) => "command as it was latched, held until the next one",
        Probe::MotorTorqueMean(_) => "mean torque of the motor over the step that ends at this row, impulses included",
        Probe::MotorTorqueNow(_) => "smooth torque of the motor at this instant",
        Probe::SpringTorque(_) => {
            "torque of the spring on the joint: −stiffness·(q − rest), with the elastic part of its law"
        }
        Probe::DampingTorque(_) => {
            "torque of the damper on the joint: −damping·q̇, with the part of a law that depends on the rate"
        }
        Probe::FrictionTorque(_) => "torque of Coulomb friction on the joint",
        Probe::AppliedTorque(_) => "torque that the signal `torque` applies",
        Probe::Frame(F::Position, ..) => "origin of the frame in the world",
        Probe::Frame(F::Quaternion, ..) => "orientation in the world, a unit quaternion",
        Probe::Frame(F::Angles, ..) => "orientation in the world: R = Rz(yaw)·Ry(pitch)·Rx(roll)",
        Probe::Frame(F::Velocity, ..) => "velocity of the origin, world axes",
        Probe::Frame(F::AngularVelocity, ..) => "angular velocity, world axes",
        Probe::Frame(F::Acceleration, ..) => "acceleration of the origin, world axes",
        Probe::Frame(F::CenterOfMass, ..) => "centre of mass in the world",
        Probe::Frame(F::Wind, ..) => "velocity of the air at the origin, world axes; where the scene has wind",
        Probe::Energy(E::Kinetic) => "kinetic energy of all bodies, rotors and armatures",
        Probe::Energy(E::Potential) => "potential energy of gravity and springs, and that of currents in inductances",
        Probe::Energy(E::Total) => "their sum",
        Probe::Energy(E::Work) => "work done by motors, applied torques, forces, rotors and wind since the start",
        Probe::Energy(E::Dissipated) => "energy taken by dampers, friction, impacts and drag since the start",
        Probe::Energy(E::Balance) => "total − total(0) − work + dissipated: zero up to integration error",
        Probe::Momentum(0..3) => "angular momentum of all bodies about the origin of the world",
        Probe::Momentum(_) => "linear momentum of all bodies",
        Probe::Rotor(R::Speed, _) => "speed; of a stock propeller the velocity of its particles [m/s]",
        Probe::Rotor(R::Thrust, _) => "force of the air along its axis",
        Probe::Rotor(R::Torque, _) => "torque of the air about its axis, on its parent",
        Probe::Rotor(R::Inflow, _) => "velocity of the air through the disc, induced by the rotor and by its motion",
        Probe::Rotor(R::Power, _) => "power of the shaft",
        Probe::Rotor(R::Valid, _) => "1 where the theory holds, else 0",
        Probe::Drag(..) => "force of the air, world axes",
        Probe::SpringDamper(LineQuantity::Length, _) => "distance of its ends, or length of the tendon",
        Probe::SpringDamper(LineQuantity::Rate, _) => "rate of that distance",
        Probe::SpringDamper(LineQuantity::Force, _) => "force along it, positive where it pushes the ends apart",
        Probe::Bushing(BushingQuantity::Deflection, ..) => "position of the second frame, axes of the first",
        Probe::Bushing(BushingQuantity::Rotation, ..) => "rotation vector of the second frame, axes of the first",
        Probe::Bushing(BushingQuantity::Force, ..) => "force on the second body, axes of the first frame",
        Probe::Bushing(BushingQuantity::Torque, ..) => {
            "torque on the second body about the origin of its frame, axes of the first frame"
        }
        Probe::ElasticGear(GearQuantity::MeshError, _) => {
            "mesh error, second − ratio·first − offset, the travel within the backlash included"
        }
        Probe::ElasticGear(GearQuantity::Torque, _) => "torque of the teeth on the second joint",
        Probe::Winding(W::Current, _) => "current of the winding",
        Probe::Winding(W::Voltage, _) => "voltage across the motor: the command within the limits of the supply",
        Probe::Winding(W::BackEmf, _) => "voltage that the rotation induces",
        Probe::Winding(W::ElectricalPower, _) => "power of the source, voltage times current",
        Probe::Activation(_) => "activation of the actuator, in the place of the command",
        Probe::Wind(_) => "velocity of the air at the reference height, world axes; where the scene has wind",
        Probe::Contact(C::Force, ..) => "sum of the contact forces on the body, world axes",
        Probe::Contact(C::Torque, ..) => "sum of their moments about the origin of the world, world axes",
        Probe::Contact(C::NormalForce, ..) => "sum of the normal forces",
        Probe::Contact(C::FrictionForce, ..) => "size of the sum of the friction forces",
        Probe::Contact(C::Point, ..) => "centre of the normal forces in the world; NaN without contact",
        Probe::Contact(C::Normal, ..) => "mean normal into the body; NaN without contact",
        Probe::Contact(C::Count, ..) => "number of points that press",
        Probe::LimitTorque(_) => "torque of the stops on the joint",
        Probe::Opening(_) => "residual of the constraint: zero where it is closed",
        Probe::JointReaction(_, 0..3) => {
            "torque of the parent on the child through the joint, motor and springs included, about the origin of the child's joint frame, axes of the parent's"
        }
        Probe::JointReaction(..) => {
            "force of the parent on the child through the joint, axes of the parent's joint frame"
        }
        Probe::Reaction(_) => "force and torque of the parent on what hangs on the cell, in its axes",
        Probe::Sensor(_) | Probe::Signal(_) | Probe::FloatSignal(_) => "value of a sensor, a diagram or a script",
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::path::Path;

    /// The committed reference must be the one the catalogue gives; `SINCRO_BLESS=1` rewrites it.
    #[test]
    fn committed_reference_is_that_of_the_catalogue() {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/signals.md");
        if std::env::var_os("SINCRO_BLESS").is_some() {
            std::fs::write(&path, signal_reference()).unwrap();
        }
        let committed = std::fs::read_to_string(&path).unwrap_or_default();
        assert!(
            committed == signal_reference(),
            "{} is out of date: run the tests with SINCRO_BLESS=1",
            path.display()
        );
    }

    #[test]
    fn every_signal_of_the_sample_is_in_the_reference() {
        let scene = from_text(SAMPLE).unwrap();
        let missing: Vec<String> = catalogue(&scene.model)
            .into_iter()
            .filter(|e| e.name.starts_with('/') && !matches!(e.probe, Probe::Opening(_)))
            .map(|e| object_of(&e.name).to_owned())
            .filter(|object| !SECTIONS.iter().any(|(known, _)| known == object) && !object.contains("/unlisted"))
            .collect();
        assert_eq!(missing, Vec::<String>::new());
    }
}
