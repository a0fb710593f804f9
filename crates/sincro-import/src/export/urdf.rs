//! Writer of URDF: a link's frame is that of its joint, so the contents of a body are moved into it.

use sincro_dynamics::contact::Surface;
use sincro_dynamics::joint::JointKind;
use sincro_dynamics::spatial::Pose;

use super::{Joint, Piece, Tree, escaped, numbers, rpy, solid};
use crate::number::plain;
use crate::robot::turned_inertia;

/// Text of the file.
pub(super) fn text(tree: &mut Tree<'_>) -> Result<String, Vec<String>> {
    let refused: Vec<String> = tree
        .links
        .iter()
        .flat_map(|l| &l.joints)
        .filter(|j| matches!(j.kind, JointKind::Ball | JointKind::Screw { .. } | JointKind::Universal { .. }))
        .map(|j| format!("joint `{}`: URDF has no such joint", j.path))
        .collect();
    if !refused.is_empty() {
        return Err(refused);
    }
    let mut out =
        format!("<?xml version=\"1.0\"?>\n<robot name=\"{}\">\n  <link name=\"world\"/>\n", escaped(&tree.name));
    let gears = tree.gears();
    // frame of each link in the frame that URDF has for it
    let mut inner: Vec<Pose<f64>> = Vec::new();
    for k in 0..tree.links.len() {
        let parent = tree.links[k].parent;
        let (mut carrier, mut above) =
            (parent.map_or("world".to_owned(), |p| tree.links[p].name.clone()), Pose::identity());
        if let Some(p) = parent {
            above = inner[p];
        }
        let name = tree.links[k].name.clone();
        let joints: Vec<Joint> = tree.links[k].joints.iter().filter(|j| j.kind != JointKind::Fixed).cloned().collect();
        let mut last = Pose::identity();
        for (i, joint) in joints.iter().enumerate() {
            let child = if i + 1 == joints.len() { name.clone() } else { format!("{name}.{}", i + 1) };
            if i + 1 != joints.len() {
                out += &format!("  <link name=\"{}\"/>\n", escaped(&child));
            }
            let origin = if i == 0 { above.compose(&joint.pose) } else { last.inverse().compose(&joint.pose) };
            joint_text(&mut out, tree, joint, &carrier, &child, &origin, &gears);
            (carrier, last) = (child, joint.pose);
        }
        let link_pose = tree.links[k].pose;
        if joints.is_empty() {
            let origin = above.compose(&link_pose);
            out += &format!(
                "  <joint name=\"{}.fixed\" type=\"fixed\">\n    {}\n    <parent link=\"{}\"/>\n    <child link=\"{}\"/>\n  </joint>\n",
                escaped(&name),
                origin_text(&origin),
                escaped(&carrier),
                escaped(&name)
            );
            inner.push(Pose::identity());
        } else {
            inner.push(last.inverse().compose(&link_pose));
        }
        link_text(&mut out, tree, k, &inner[k].clone());
    }
    for closure in &tree.scene.model.constraints().loop_joints.clone() {
        tree.note(&closure.name, "URDF has no loops");
    }
    out += "</robot>\n";
    Ok(out)
}

fn origin_text(pose: &Pose<f64>) -> String {
    format!("<origin xyz=\"{}\" rpy=\"{}\"/>", numbers(&pose.pos.0), numbers(&rpy(pose)))
}

#[allow(clippy::too_many_arguments)]
fn joint_text(
    out: &mut String,
    tree: &mut Tree<'_>,
    joint: &Joint,
    parent: &str,
    child: &str,
    origin: &Pose<f64>,
    gears: &[(String, String, [f64; 5])],
) {
    let kind = match joint.kind {
        JointKind::Revolute { .. } if joint.is_limited() => "revolute",
        JointKind::Revolute { .. } => "continuous",
        JointKind::Prismatic { .. } => "prismatic",
        JointKind::Planar => "planar",
        _ => "floating",
    };
    *out += &format!("  <joint name=\"{}\" type=\"{kind}\">\n    {}\n", escaped(&joint.name), origin_text(origin));
    *out += &format!("    <parent link=\"{}\"/>\n    <child link=\"{}\"/>\n", escaped(parent), escaped(child));
    if kind != "floating" {
        *out += &format!("    <axis xyz=\"{}\"/>\n", numbers(&joint.axis()));
    }
    let effort = joint.motor.map(|m| m.max_torque).filter(|x| x.is_finite()).unwrap_or(1e9);
    let speed = joint.motor.map(|m| m.max_velocity).filter(|x| x.is_finite()).unwrap_or(1e9);
    if matches!(kind, "revolute" | "prismatic") {
        let bound = |x: f64| plain(x.clamp(-1e9, 1e9));
        let [lower, upper] = joint.limits_of(0).unwrap_or([f64::NEG_INFINITY, f64::INFINITY]).map(bound);
        *out += &format!(
            "    <limit lower=\"{lower}\" upper=\"{upper}\" effort=\"{}\" velocity=\"{}\"/>\n",
            plain(effort),
            plain(speed)
        );
    } else if kind == "continuous" && joint.motor.is_some() {
        *out += &format!("    <limit effort=\"{}\" velocity=\"{}\"/>\n", plain(effort), plain(speed));
    }
    if let [dof] = joint.dofs[..] {
        if dof.damping != 0.0 || dof.friction.sliding != 0.0 {
            *out += &format!(
                "    <dynamics damping=\"{}\" friction=\"{}\"/>\n",
                plain(dof.damping),
                plain(dof.friction.sliding)
            );
        }
        for (value, words) in [(dof.armature, "armature"), (dof.stiffness, "spring")] {
            if value != 0.0 {
                tree.note(&joint.path, &format!("URDF has no {words}"));
            }
        }
    }
    if joint.dofs.len() > 1 {
        tree.note_left_out(joint, |_| true);
    }
    if joint.motor.is_some() {
        tree.note(&joint.path, "URDF has no motors: the largest torque and speed alone are written");
    }
    for (first, _, [offset, ratio, higher @ ..]) in gears.iter().filter(|g| g.1 == joint.name) {
        if *higher != [0.0; 3] {
            tree.note(&joint.path, "URDF couples joints linearly only: the polynomial is not written");
            continue;
        }
        *out += &format!(
            "    <mimic joint=\"{}\" multiplier=\"{}\" offset=\"{}\"/>\n",
            escaped(first),
            plain(*ratio),
            plain(*offset)
        );
    }
    *out += "  </joint>\n";
}

fn link_text(out: &mut String, tree: &mut Tree<'_>, k: usize, inner: &Pose<f64>) {
    *out += &format!("  <link name=\"{}\">\n", escaped(&tree.links[k].name));
    if let Some(mass) = tree.links[k].mass {
        let com = inner.point(sincro_dynamics::spatial::Vec3(mass.center_of_mass));
        let [xx, xy, xz, yy, yz, zz] = turned_inertia(&inner.rot, mass.inertia).map(plain);
        *out += &format!(
            "    <inertial>\n      <origin xyz=\"{}\"/>\n      <mass value=\"{}\"/>\n      <inertia ixx=\"{xx}\" ixy=\"{xy}\" ixz=\"{xz}\" iyy=\"{yy}\" iyz=\"{yz}\" izz=\"{zz}\"/>\n    </inertial>\n",
            numbers(&com.0),
            plain(mass.mass)
        );
    }
    let (shown, touching) = tree.pieces(k);
    for (word, pieces) in [("visual", shown), ("collision", touching)] {
        for piece in pieces {
            piece_text(out, tree, k, word, &piece, inner);
        }
    }
    if tree.object(k).contact.is_some() {
        let path = tree.object(k).path.clone();
        tree.note(&path, "URDF has no friction and no restitution");
    }
    *out += "  </link>\n";
}

fn piece_text(out: &mut String, tree: &mut Tree<'_>, k: usize, word: &str, piece: &Piece, inner: &Pose<f64>) {
    let path = tree.object(k).path.clone();
    let geometry = match &piece.surface {
        Surface::Solid(shape) => match solid(shape) {
            Some(("box", size)) => format!("<box size=\"{}\"/>", numbers(&size)),
            Some(("sphere", size)) => format!("<sphere radius=\"{}\"/>", plain(size[0])),
            Some(("capsule", size)) => {
                tree.note(&path, "a capsule is no shape of URDF: some readers leave it out");
                format!("<capsule radius=\"{}\" length=\"{}\"/>", plain(size[0]), plain(size[1]))
            }
            Some((word, size)) => format!("<{word} radius=\"{}\" length=\"{}\"/>", plain(size[0]), plain(size[1])),
            None => return tree.note(&path, "URDF has no cones and tori"),
        },
        Surface::HalfSpace => return tree.note(&path, "URDF has no planes"),
        surface => match tree.mesh_file(k, surface) {
            Some(file) => format!("<mesh filename=\"{}\"/>", escaped(&file)),
            None => return tree.note(&path, "URDF has no height fields"),
        },
    };
    *out += &format!(
        "    <{word}>\n      {}\n      <geometry>{geometry}</geometry>\n",
        origin_text(&inner.compose(&piece.pose))
    );
    if let Some(color) = piece.color.filter(|_| word == "visual") {
        let [r, g, b] = color.map(|x| plain(f64::from(x) / 255.0));
        *out += &format!("      <material name=\"{}\"><color rgba=\"{r} {g} {b} 1\"/></material>\n", hex(color));
    }
    *out += &format!("    </{word}>\n");
}

fn hex([r, g, b]: [u8; 3]) -> String {
    format!("#{r:02x}{g:02x}{b:02x}")
}
