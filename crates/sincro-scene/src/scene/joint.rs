//! Joints and motors: from what is written to the builder's specification.

use sincro_dynamics::actuation::{Activation, Motor, MotorMode, Winding};
use sincro_dynamics::joint::{Friction, JointKind};
use sincro_dynamics::model::JointSpec;
use sincro_dynamics::signal::Signal;

use super::file::{FrictionFile, JointFile, JointKindFile, MotorFile, MotorModeFile, OneOrList, StribeckFile};
use super::signal_file::SignalReader;
use super::spring_damper::nonlinear;
use crate::diagnostic::Diagnostic;

const X: [f64; 3] = [1.0, 0.0, 0.0];
const Y: [f64; 3] = [0.0, 1.0, 0.0];
const Z: [f64; 3] = [0.0, 0.0, 1.0];

/// The specification of a joint, and the commands of its motors.
pub(super) fn spec(file: &JointFile, pointer: &str, signals: &mut SignalReader<'_>) -> (JointSpec, Vec<Signal>) {
    let mut spec = JointSpec::new(kind(file, pointer, signals));
    spec.armature = numbers(&file.armature);
    spec.damping = numbers(&file.damping);
    let frictions = file.friction.as_ref().map(OneOrList::as_slice).unwrap_or_default();
    spec.friction = frictions.iter().map(friction).collect();
    let springs = file.spring.as_ref().map(OneOrList::as_slice).unwrap_or_default();
    spec.spring = springs.iter().map(|s| (s.stiffness.unwrap_or(0.0), s.rest)).collect();
    for (k, _) in springs.iter().enumerate().filter(|(_, s)| !s.has_force()) {
        let written = format!("{pointer}/spring/{k}");
        let at = if signals.document.get(&written).is_some() { written } else { format!("{pointer}/spring") };
        let diagnostic = Diagnostic::error(&signals.document.at(&at), "`stiffness` is missing in `spring`");
        let help =
            format!("give `stiffness` [N·m/rad] or [N/m] to the spring of `{}`, or a `law` or `table`", file.name);
        signals.diagnostics.push(diagnostic.with_help(help));
    }
    if springs.iter().any(|s| s.law.is_some() || s.table.is_some()) {
        let is_list = matches!(file.spring, Some(OneOrList::List(_)));
        let of = format!("the spring of `{}`", file.name);
        for (k, spring) in springs.iter().enumerate() {
            let pointer = if is_list { format!("{pointer}/spring/{k}") } else { format!("{pointer}/spring") };
            let (law, table) = (spring.law.as_deref(), spring.table.as_deref());
            spec.spring_law.push(nonlinear(law, table, &of, &pointer, signals).flatten());
        }
    }
    spec.sensor = file.force_sensor;
    if file.force_sensor && file.kind != JointKindFile::Fixed {
        let word = kind_word(file.kind);
        refuse_key(&format!("{pointer}/force_sensor"), "force_sensor", &format!("a {word} joint"), signals);
    }
    if let Some(limits) = &file.limits {
        spec.limits = super::contact::limits(limits.as_slice(), pointer, signals);
        spec.limit_restitution = limits.as_slice().iter().map(|l| l.restitution).fold(0.0, f64::max);
    }
    spec.torque = torques(file, pointer, signals);
    let motors = entries(&file.motor, &format!("{pointer}/motor"));
    let commands = motors.iter().map(|(file, pointer)| match &file.command {
        Some(command) => signals.read(command, &format!("{pointer}/command")),
        None => Signal::Constant(0.0),
    });
    let commands = commands.collect();
    spec.motor = motors.iter().map(|(file, pointer)| motor(file, pointer, signals)).collect();
    spec.winding = motors.iter().map(|(file, _)| winding(file)).collect();
    spec.activation = activations(file, &motors, signals);
    (spec, commands)
}

/// Activations of the motors of a joint, one entry a motor.
fn activations(
    file: &JointFile,
    motors: &[(&MotorFile, String)],
    signals: &mut SignalReader<'_>,
) -> Vec<Option<Activation<f64>>> {
    let of = format!("the motor of joint `{}`", file.name);
    let one = |(motor, pointer): &(&MotorFile, String)| {
        let own = motor.activation.as_ref()?;
        let is_driven = matches!(motor.mode, MotorModeFile::Torque | MotorModeFile::Spring | MotorModeFile::Voltage);
        let pointer = format!("{pointer}/activation");
        if !is_driven {
            let at = signals.document.key_at(&pointer);
            let message = format!("{of} has an `activation`, which is of modes `torque`, `spring` and `voltage`");
            signals.diagnostics.push(Diagnostic::error(&at, message).with_help("take one of them, or leave it out"));
            return None;
        }
        Some(own.spec(&of, &pointer, signals))
    };
    motors.iter().map(one).collect()
}

/// Entries of one value or a list, each with its pointer.
fn entries<'a, T>(file: &'a Option<OneOrList<T>>, pointer: &str) -> Vec<(&'a T, String)> {
    match file {
        None => Vec::new(),
        Some(OneOrList::One(x)) => vec![(x, pointer.to_owned())],
        Some(OneOrList::List(list)) => list.iter().enumerate().map(|(k, x)| (x, format!("{pointer}/{k}"))).collect(),
    }
}

fn numbers(list: &Option<OneOrList<f64>>) -> Vec<f64> {
    list.as_ref().map(|list| list.as_slice().to_vec()).unwrap_or_default()
}

fn friction(file: &FrictionFile) -> Friction<f64> {
    match *file {
        FrictionFile::Coulomb(limit) => Friction::coulomb(limit),
        FrictionFile::Stribeck(StribeckFile { sliding, at_rest, stribeck_velocity, load_coefficient }) => {
            Friction { sliding, at_rest: at_rest.unwrap_or(sliding), stribeck_velocity, load_coefficient }
        }
    }
}

fn torques(file: &JointFile, pointer: &str, signals: &mut SignalReader<'_>) -> Vec<Signal> {
    let torques = entries(&file.torque, &format!("{pointer}/torque"));
    torques.iter().map(|(torque, pointer)| signals.read(torque, pointer)).collect()
}

fn kind(file: &JointFile, pointer: &str, signals: &mut SignalReader<'_>) -> JointKind {
    use JointKindFile as K;
    let (axis, word) = (file.axis.unwrap_or(Z), kind_word(file.kind));
    let has_axis = matches!(file.kind, K::Revolute | K::Prismatic | K::Screw | K::Universal);
    let known = [("axis", has_axis), ("axis2", file.kind == K::Universal), ("pitch", file.kind == K::Screw)];
    for (key, _) in known.iter().filter(|(_, fits)| !fits) {
        refuse_key(&format!("{pointer}/{key}"), key, &format!("a {word} joint"), signals);
    }
    if file.kind == K::Screw && file.pitch.is_none() {
        let at = signals.document.title_at(pointer);
        let diagnostic = Diagnostic::error(&at, format!("`pitch` is missing in joint `{}`", file.name));
        signals.diagnostics.push(diagnostic.with_help("a screw joint needs its advance, `pitch` [m/rad]"));
    }
    match file.kind {
        K::Fixed => JointKind::Fixed,
        K::Revolute => JointKind::Revolute { axis },
        K::Prismatic => JointKind::Prismatic { axis },
        K::Screw => JointKind::Screw { axis, pitch: file.pitch.unwrap_or(0.0) },
        K::Universal => JointKind::Universal { axis: file.axis.unwrap_or(X), axis2: file.axis2.unwrap_or(Y) },
        K::Ball => JointKind::Ball,
        K::Planar => JointKind::Planar,
        K::Free => JointKind::Free,
    }
}

fn kind_word(kind: JointKindFile) -> &'static str {
    match kind {
        JointKindFile::Fixed => "fixed",
        JointKindFile::Revolute => "revolute",
        JointKindFile::Prismatic => "prismatic",
        JointKindFile::Screw => "screw",
        JointKindFile::Universal => "universal",
        JointKindFile::Ball => "ball",
        JointKindFile::Planar => "planar",
        JointKindFile::Free => "free",
    }
}

/// A key that is there but has no meaning.
fn refuse_key(pointer: &str, key: &str, of: &str, signals: &mut SignalReader<'_>) {
    if signals.document.get(pointer).is_some() {
        let at = signals.document.key_at(pointer);
        let diagnostic = Diagnostic::error(&at, format!("`{key}` has no meaning for {of}"));
        signals.diagnostics.push(diagnostic.with_help("leave it out"));
    }
}

/// Keys of a motor in mode `voltage`.
const ELECTRIC: [&str; 7] =
    ["resistance", "inductance", "torque_constant", "back_emf_constant", "gear_ratio", "rotor_inertia", "max_voltage"];

/// Winding of a motor in mode `voltage`; one that lacks a key is refused by [`motor`].
fn winding(file: &MotorFile) -> Option<Winding<f64>> {
    let plain = Winding::new(file.resistance.unwrap_or(1.0), file.torque_constant.unwrap_or(1.0));
    (file.mode == MotorModeFile::Voltage).then(|| Winding {
        inductance: file.inductance.unwrap_or(0.0),
        back_emf_constant: file.back_emf_constant.unwrap_or(plain.back_emf_constant),
        gear_ratio: file.gear_ratio.unwrap_or(1.0),
        rotor_inertia: file.rotor_inertia.unwrap_or(0.0),
        max_voltage: file.max_voltage.unwrap_or(f64::INFINITY),
        ..plain
    })
}

fn motor(file: &MotorFile, pointer: &str, signals: &mut SignalReader<'_>) -> Motor<f64> {
    let mode = match file.mode {
        MotorModeFile::Free => MotorMode::Free,
        MotorModeFile::Torque => MotorMode::Torque,
        MotorModeFile::Velocity => MotorMode::Velocity,
        MotorModeFile::Position => MotorMode::Position,
        MotorModeFile::Spring => MotorMode::Spring,
        MotorModeFile::Voltage => MotorMode::Voltage,
    };
    let word = signals.document.text(&format!("{pointer}/mode")).unwrap_or("").to_owned();
    let (position, spring) = (mode == MotorMode::Position, mode == MotorMode::Spring);
    let voltage = mode == MotorMode::Voltage;
    let driven = mode != MotorMode::Free;
    let keys = [
        ("kp", position),
        ("max_velocity", position),
        ("stiffness", spring),
        ("damping", spring),
        ("command", driven),
        ("max_torque", driven && !voltage),
    ];
    let electric = ELECTRIC.map(|key| (key, voltage));
    for (key, _) in keys.iter().chain(&electric).filter(|(_, fits)| !fits) {
        refuse_key(&format!("{pointer}/{key}"), key, &format!("a motor in mode `{word}`"), signals);
    }
    let needed = [
        ("kp", position, "[1/s]"),
        ("stiffness", spring, "[N·m/rad] or [N/m]"),
        ("resistance", voltage, "[Ω]"),
        ("torque_constant", voltage, "[N·m/A]"),
    ];
    for (key, needed, unit) in needed {
        if needed && signals.document.get(&format!("{pointer}/{key}")).is_none() {
            let at = signals.document.at(&format!("{pointer}/mode"));
            let diagnostic = Diagnostic::error(&at, format!("`{key}` is missing: mode `{word}` needs it"));
            signals.diagnostics.push(diagnostic.with_help(format!("give `{key}` {unit}")));
        }
    }
    Motor {
        max_torque: file.max_torque.unwrap_or(f64::INFINITY),
        kp: file.kp.unwrap_or(0.0),
        max_velocity: file.max_velocity.unwrap_or(f64::INFINITY),
        stiffness: file.stiffness.unwrap_or(0.0),
        damping: file.damping.unwrap_or(0.0),
        ..Motor::new(mode)
    }
}
