//! The experiment of a robot: it runs as it is.

use super::{Writer, one_line};
use crate::number::{list, number, quoted};

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
        let positions: Vec<String> = keyframe
            .positions
            .iter()
            .filter_map(|(joint, q)| {
                let path = writer.joint_paths[*joint].as_ref()?;
                let value = if let [x] = q[..] { number(x) } else { list(q) };
                Some(format!("    {} = {value},", quoted(&format!("{path}.initial.position"))))
            })
            .collect();
        let name = crate::number::name(&keyframe.name);
        if positions.is_empty() || !used.insert(name.clone()) {
            continue;
        }
        line(String::new());
        line("[[variant]]".into());
        line(format!("name = {}", quoted(&name)));
        line("[variant.set]".into());
        positions.iter().for_each(|text| line(text.trim().trim_end_matches(',').to_owned()));
    }
    out
}
