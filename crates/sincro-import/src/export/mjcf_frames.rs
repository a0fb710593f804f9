//! Frames of joints and bodies that MJCF has no place for, as custom data: a joint of MJCF stands in the frame of the
//! body that it carries, and all names of a kind are unique.
//!
//! For each joint and body `NAME` the file has the text `sincro:joint:NAME` or `sincro:body:NAME`, the name in the
//! scene, and the numbers `…:position` (in the frame of the object above), `…:rotation_deg` or `…:quaternion_wxyz`, of
//! a joint `…:axis` in its own frame, of a body that touches `…:group`. MuJoCo ignores them; the reader takes them
//! where they agree with the bodies.

use sincro_dynamics::joint::JointKind;

use super::{Joint, Tree, escaped, numbers};
use crate::robot::{Placement, Rotation};

/// Start of the names of custom data that the reader takes.
pub(crate) const PREFIX: &str = "sincro:";

/// The section of custom data; notes the frames that it cannot say.
pub(super) fn section(tree: &mut Tree<'_>) -> String {
    let mut lines = String::new();
    for k in 0..tree.links.len() {
        let scene = tree.scene;
        let object = &scene.objects[tree.links[k].object];
        let joints: Vec<Joint> = tree.links[k].joints.clone();
        let mut above = tree.links[k].parent.map(|p| tree.links[p].object);
        let mut own = String::new();
        let mut is_chain = joints.iter().all(|joint| joint.kind != JointKind::Fixed);
        for joint in &joints {
            let Some(at) = scene.objects.iter().position(|o| o.path == joint.path) else { continue };
            is_chain &= scene.objects[at].parent == above;
            above = Some(at);
            let name = format!("{PREFIX}joint:{}", joint.name);
            own += &frame(&name, tree, at);
            own += &numeric(&name, "axis", &joint.axis());
        }
        if !is_chain || object.parent != above {
            tree.note(&object.path, "its name and frame below its joints have no place in MJCF");
            continue;
        }
        let name = format!("{PREFIX}body:{}", tree.links[k].name);
        own += &frame(&name, tree, tree.links[k].object);
        if let Some(contact) = &object.contact {
            own += &numeric(&name, "group", &[contact.group as f64]);
        }
        lines += &own;
    }
    if lines.is_empty() { lines } else { format!("  <custom>\n{lines}  </custom>\n") }
}

fn numeric(name: &str, key: &str, list: &[f64]) -> String {
    format!("    <numeric name=\"{}:{key}\" data=\"{}\"/>\n", escaped(name), numbers(list))
}

/// Name and pose of an object, as the scene has them.
fn frame(name: &str, tree: &mut Tree<'_>, object: usize) -> String {
    let object = &tree.scene.objects[object];
    let mut lines = format!("    <text name=\"{}\" data=\"{}\"/>\n", escaped(name), escaped(&object.name));
    lines += &numeric(name, "position", &object.pose.pos.0);
    let (placement, is_exact) = Placement::exactly(&object.pose);
    if !is_exact {
        tree.note(&object.path, "its rotation is written to rounding");
    }
    match placement.rotation {
        Rotation::RollPitchYaw(rpy) => lines += &numeric(name, "rotation_deg", &rpy.map(crate::number::degrees)),
        Rotation::Quaternion(wxyz) => lines += &numeric(name, "quaternion_wxyz", &wxyz),
    }
    lines
}
