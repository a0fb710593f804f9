//! The experiment of a robot: it runs as it is.

use super::loops::OPEN;
use super::{Writer, one_line};
use crate::number::{list, number, quoted};
use crate::robot::{Actuator, Keyframe};
use crate::source::ElementStatus;

/// Joints that are recorded at most; more can be added by hand.
const MAX_RECORDED: usize = 32;

/// Text of `experiment.toml`.
pub(super) fn text(writer: &Writer<'_>) -> String {
    let robot = writer.robot;
    let mut out = String::new();
    let mut line = |text: String| {
        out.push_str(&text);
        out.push('\n');
    };
    line("format = 2".into());
    line(format!("title = {}", quoted(&one_line(&robot.name))));
    let file = writer.context.file.file_name().map_or_else(String::new, |n| n.to_string_lossy().into_owned());
    line(format!("description = {}", quoted(&format!("Imported from {}.", one_line(&file)))));
    line("scene = \"scene.toml\"".into());
    line("duration = 1.0".into());
    line("step = 0.005".into());
    line("error_bar = \"none\"".into());
    let mut record: Vec<String> = Vec::new();
    for (joint, path) in robot.joints.iter().zip(&writer.joint_paths) {
        let Some(path) = path else { continue };
        if joint.kind.dofs() == 1 && record.len() < MAX_RECORDED {
            record.push(format!("{path}.position"));
        }
    }
    record.push("energy.kinetic".into());
    record.push("energy.potential".into());
    line("record = [".into());
    record.iter().for_each(|signal| line(format!("    {},", quoted(signal))));
    line("]".into());
    let mut used = std::collections::BTreeSet::new();
    for keyframe in &robot.keyframes {
        let name = crate::number::name(&keyframe.name);
        let judge = |status, words: &str| writer.context.ledger.judge_place(keyframe.element, status, words);
        match settings(writer, keyframe) {
            Err(why) => judge(ElementStatus::Dropped, &why),
            Ok(settings) if settings.is_empty() => judge(ElementStatus::Dropped, "it sets nothing that is here"),
            Ok(_) if !used.insert(name.clone()) => judge(ElementStatus::Dropped, "there is a variant of that name"),
            Ok(settings) => {
                judge(ElementStatus::Changed, "a variant of the experiment");
                line(String::new());
                line("[[variant]]".into());
                line(format!("name = {}", quoted(&name)));
                line("[variant.set]".into());
                settings.into_iter().for_each(&mut line);
            }
        }
    }
    out
}

/// Lines of a variant for a keyframe; the reason if a run cannot start there.
fn settings(writer: &Writer<'_>, keyframe: &Keyframe) -> Result<Vec<String>, String> {
    let coordinates = coordinates(writer, keyframe)?;
    let positions = coordinates.iter().filter_map(|(joint, q)| {
        let path = writer.joint_paths[*joint].as_ref()?;
        let value = if let [x] = q[..] { number(x) } else { list(q) };
        Some(format!("{} = {value}", quoted(&format!("{path}.initial.position"))))
    });
    Ok(positions.chain(actuation(writer, keyframe)).collect())
}

/// Commands and activations of a keyframe.
fn actuation(writer: &Writer<'_>, keyframe: &Keyframe) -> Vec<String> {
    let path = |actuator: &Actuator| match *actuator {
        Actuator::Motor(joint) => writer.joint_paths[joint].as_ref().map(|path| format!("{path}.motor")),
        Actuator::Tendon(k) => writer.tendon_paths[k].as_ref().map(|path| format!("{path}.actuator")),
    };
    let keys = |list: &[(Actuator, f64)], key: &str| -> Vec<String> {
        let one = |(actuator, x): &(Actuator, f64)| {
            Some(format!("{} = {}", quoted(&format!("{}.{key}", path(actuator)?)), number(*x)))
        };
        list.iter().filter_map(one).collect()
    };
    [keys(&keyframe.commands, "command"), keys(&keyframe.activations, "activation.initial")].concat()
}

/// Coordinates of a keyframe with gears as they are coupled; the reason if a run cannot start there.
fn coordinates(writer: &Writer<'_>, keyframe: &Keyframe) -> Result<Vec<(usize, Vec<f64>)>, String> {
    let robot = writer.robot;
    let mut starts = writer.starts.clone();
    for (joint, q) in &keyframe.positions {
        if let [x] = q[..] {
            starts[*joint] = x;
        }
    }
    for _ in 0..robot.gears.len() {
        for gear in &robot.gears {
            starts[gear.joints[1]] = gear.second(starts[gear.joints[0]]);
        }
    }
    let beyond = |k: &usize| robot.joints[*k].limits.is_some_and(|[low, high]| starts[*k] < low || starts[*k] > high);
    if let Some(k) = (0..robot.joints.len()).find(beyond) {
        return Err(format!("joint `{}` stands at {}, beyond its limits", robot.joints[k].name, number(starts[k])));
    }
    let open = |closure: &&crate::robot::Loop| {
        let is_bushing = closure.softness.is_some_and(|softness| softness.is_moved);
        !is_bushing && writer.opening(closure, &writer.starts) <= OPEN && writer.opening(closure, &starts) > OPEN
    };
    if let Some(closure) = robot.loops.iter().find(open) {
        return Err(format!("`{}` is open there", closure.name));
    }
    let unit = |q: &[f64]| {
        let norm = q.iter().map(|x| x * x).sum::<f64>().sqrt();
        q.iter().map(|x| x / norm).collect::<Vec<f64>>()
    };
    let value = |(joint, q): &(usize, Vec<f64>)| match q.len() {
        1 => (*joint, vec![starts[*joint]]),
        7 => (*joint, [q[..3].to_vec(), unit(&q[3..])].concat()),
        _ => (*joint, unit(q)),
    };
    Ok(keyframe.positions.iter().map(value).collect())
}
