//! Writer of SDF 1.9: links in the frame of the model, joints in that of their child.

use sincro_dynamics::contact::Surface;
use sincro_dynamics::joint::JointKind;
use sincro_dynamics::spatial::Pose;

use super::{Joint, Piece, Tree, escaped, numbers, rpy, solid};
use crate::number::plain;

/// Text of the file.
pub(super) fn text(tree: &mut Tree<'_>) -> Result<String, Vec<String>> {
    let moving = |l: &super::Link| l.joints.iter().filter(|j| j.kind != JointKind::Fixed).count();
    let mut refused = Vec::new();
    for link in &tree.links {
        let path = &tree.scene.objects[link.object].path;
        if moving(link) > 1 {
            refused.push(format!(
                "`{path}` moves on {} joints at once: SDF wants a body with mass between them",
                moving(link)
            ));
        }
        if link
            .joints
            .iter()
            .any(|j| j.kind == JointKind::Planar || (j.kind == JointKind::Free && link.parent.is_some()))
        {
            refused.push(format!("the joint of `{path}`: SDF has none of its kind"));
        }
    }
    if !refused.is_empty() {
        return Err(refused);
    }
    let gravity = numbers(&tree.scene.model.gravity().0);
    let mut out = format!(
        "<?xml version=\"1.0\"?>\n<sdf version=\"1.9\">\n  <world name=\"world\">\n    <gravity>{gravity}</gravity>\n    <model name=\"{}\">\n",
        escaped(&tree.name)
    );
    let mut places: Vec<Pose<f64>> = Vec::new();
    let mut bodies: Vec<bool> = Vec::new();
    for k in 0..tree.links.len() {
        let (name, parent) = (escaped(&tree.links[k].name), tree.links[k].parent);
        let above = parent.map_or_else(Pose::identity, |p| places[p]);
        let joint = tree.links[k].joints.iter().find(|j| j.kind != JointKind::Fixed).cloned();
        let start = joint.as_ref().filter(|j| j.kind == JointKind::Free).map(|j| j.start.clone());
        let mut here = above.compose(&tree.links[k].pose);
        if let Some([x, y, z, a, b, c, d]) = start.as_deref() {
            let q = sincro_dynamics::spatial::Quat::from_slice(&[*a, *b, *c, *d]).normalized();
            here = Pose { rot: q.matrix(), pos: sincro_dynamics::spatial::Vec3([*x, *y, *z]) };
        }
        places.push(here);
        let is_body = tree.links[k].mass.is_some() || joint.is_some() || tree.object(k).shown().next().is_some();
        bodies.push(is_body);
        let carrier = {
            let mut at = parent;
            while let Some(p) = at.filter(|p| !bodies[*p]) {
                at = tree.links[p].parent;
            }
            at.map_or_else(|| "world".to_owned(), |p| escaped(&tree.links[p].name))
        };
        if !is_body {
            let attached = if carrier == "world" { "__model__".to_owned() } else { carrier };
            out += &format!(
                "      <frame name=\"{name}\" attached_to=\"{attached}\">{}</frame>\n",
                pose_text(&here, "__model__")
            );
            continue;
        }
        link_text(&mut out, tree, k, &here);
        match joint {
            Some(joint) if joint.kind != JointKind::Free => {
                joint_text(
                    &mut out,
                    tree,
                    &joint,
                    &carrier,
                    &name,
                    &here.inverse().compose(&above.compose(&joint.pose)),
                );
            }
            // a free joint is none in SDF
            Some(joint) => tree.note_left_out(&joint, |_| true),
            None => {
                out += &format!(
                    "      <joint name=\"{name}.fixed\" type=\"fixed\"><parent>{carrier}</parent><child>{name}</child></joint>\n"
                );
            }
        }
    }
    for gear in tree.gears() {
        tree.note(&gear.1, "SDF couples joints by plugins only: the coupling is not written");
    }
    for closure in &tree.scene.model.constraints().loop_joints.clone() {
        tree.note(&closure.name, "the loop is not written");
    }
    out += "    </model>\n  </world>\n</sdf>\n";
    Ok(out)
}

fn pose_text(pose: &Pose<f64>, relative: &str) -> String {
    let relative = if relative.is_empty() { String::new() } else { format!(" relative_to=\"{relative}\"") };
    format!("<pose{relative}>{} {}</pose>", numbers(&pose.pos.0), numbers(&rpy(pose)))
}

fn link_text(out: &mut String, tree: &mut Tree<'_>, k: usize, here: &Pose<f64>) {
    *out += &format!("      <link name=\"{}\">\n        {}\n", escaped(&tree.links[k].name), pose_text(here, ""));
    if let Some(mass) = tree.links[k].mass {
        let [xx, xy, xz, yy, yz, zz] = mass.inertia.map(plain);
        *out += &format!(
            "        <inertial>\n          <pose>{} 0 0 0</pose>\n          <mass>{}</mass>\n          <inertia><ixx>{xx}</ixx><ixy>{xy}</ixy><ixz>{xz}</ixz><iyy>{yy}</iyy><iyz>{yz}</iyz><izz>{zz}</izz></inertia>\n        </inertial>\n",
            numbers(&mass.center_of_mass),
            plain(mass.mass)
        );
    }
    let material = tree.object(k).contact;
    let friction = material.map(|c| c.friction);
    let (shown, touching) = tree.pieces(k);
    if let Some(m) = material.filter(|_| !touching.is_empty()) {
        let path = tree.object(k).path.clone();
        if m.restitution != 0.0 || m.stiffness.is_finite() {
            tree.note(&path, "the restitution and compliance of its contact are not written");
        }
        if m.rolling_friction != 0.0 || m.spinning_friction != 0.0 {
            tree.note(&path, "the rolling and spinning friction of its contact are not written");
        }
    }
    for (word, pieces) in [("visual", shown), ("collision", touching)] {
        for (i, piece) in pieces.iter().enumerate() {
            piece_text(out, tree, k, (word, i), piece, friction);
        }
    }
    *out += "      </link>\n";
}

fn piece_text(
    out: &mut String,
    tree: &mut Tree<'_>,
    k: usize,
    (word, i): (&str, usize),
    piece: &Piece,
    friction: Option<f64>,
) {
    let path = tree.object(k).path.clone();
    let geometry = match &piece.surface {
        Surface::Solid(shape) => match solid(shape) {
            Some(("box", size)) => format!("<box><size>{}</size></box>", numbers(&size)),
            Some(("sphere", size)) => format!("<sphere><radius>{}</radius></sphere>", plain(size[0])),
            Some((word, size)) => {
                format!("<{word}><radius>{}</radius><length>{}</length></{word}>", plain(size[0]), plain(size[1]))
            }
            None => return tree.note(&path, "cones and tori are not written"),
        },
        Surface::HalfSpace => "<plane><normal>0 0 1</normal><size>100 100</size></plane>".to_owned(),
        surface => match tree.mesh_file(k, surface) {
            Some(file) => format!("<mesh><uri>{}</uri></mesh>", escaped(&file)),
            None => return tree.note(&path, "height fields are not written"),
        },
    };
    *out +=
        &format!("        <{word} name=\"{word}{i}\">{}<geometry>{geometry}</geometry>", pose_text(&piece.pose, ""));
    if let Some(color) = piece.color.filter(|_| word == "visual") {
        let [r, g, b] = color.map(|x| plain(f64::from(x) / 255.0));
        *out += &format!("<material><ambient>{r} {g} {b} 1</ambient><diffuse>{r} {g} {b} 1</diffuse></material>");
    }
    if let Some(friction) = friction.filter(|_| word == "collision") {
        let mu = plain(friction);
        *out += &format!("<surface><friction><ode><mu>{mu}</mu><mu2>{mu}</mu2></ode></friction></surface>");
    }
    *out += &format!("</{word}>\n");
}

fn joint_text(out: &mut String, tree: &mut Tree<'_>, joint: &Joint, parent: &str, child: &str, own: &Pose<f64>) {
    let (kind, axes) = match joint.kind {
        JointKind::Revolute { axis } if !joint.is_limited() => ("continuous", vec![axis]),
        JointKind::Revolute { axis } => ("revolute", vec![axis]),
        JointKind::Prismatic { axis } => ("prismatic", vec![axis]),
        JointKind::Screw { axis, .. } => ("screw", vec![axis]),
        JointKind::Universal { axis, axis2 } => ("universal", vec![axis, axis2]),
        _ => ("ball", Vec::new()),
    };
    *out += &format!(
        "      <joint name=\"{}\" type=\"{kind}\">\n        {}\n        <parent>{parent}</parent><child>{child}</child>\n",
        escaped(&joint.name),
        pose_text(own, "")
    );
    if let JointKind::Screw { pitch, .. } = joint.kind {
        *out += &format!("        <screw_thread_pitch>{}</screw_thread_pitch>\n", plain(pitch * std::f64::consts::TAU));
    }
    for (k, axis) in axes.iter().enumerate() {
        let word = if k == 0 { "axis" } else { "axis2" };
        *out += &format!("        <{word}><xyz>{}</xyz>", numbers(axis));
        if let Some(limits) = joint.limits_of(k) {
            let [lower, upper] = limits.map(|x| plain(x.clamp(-1e16, 1e16)));
            *out += &format!("<limit><lower>{lower}</lower><upper>{upper}</upper></limit>");
        }
        if let Some(dof) = joint.dofs.get(k) {
            *out += &format!(
                "<dynamics><damping>{}</damping><friction>{}</friction><spring_stiffness>{}</spring_stiffness><spring_reference>{}</spring_reference></dynamics>",
                plain(dof.damping),
                plain(dof.friction.sliding),
                plain(dof.stiffness),
                plain(dof.rest)
            );
        }
        *out += &format!("</{word}>\n");
    }
    *out += "      </joint>\n";
    let is_ball = joint.kind == JointKind::Ball;
    tree.note_left_out(joint, |word| is_ball || word == "armature");
    if joint.motor.is_some() {
        tree.note(&joint.path, "SDF has no motors");
    }
}
