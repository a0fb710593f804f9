//! Writer of MJCF: joints stand in the body they carry, as at zero coordinates; inertias are written in full.

use sincro_dynamics::actuation::{Activation, MotorMode};
use sincro_dynamics::constraint::LoopJointKind;
use sincro_dynamics::contact::{Material, Surface};
use sincro_dynamics::joint::JointKind;
use sincro_dynamics::spatial::{Pose, Vec3};

use super::mjcf_tendon::{self, Tendons, name_of};
use super::{Joint, Piece, Tree, escaped, numbers, solid, wxyz};
use crate::number::plain;
use crate::robot::Placement;

/// End of a range that MuJoCo takes for none: its largest number (`mjMAXVAL`).
pub(crate) const UNLIMITED: f64 = 1e10;

/// Text of the file.
pub(super) fn text(tree: &mut Tree<'_>) -> Result<String, Vec<String>> {
    let all = tree.links.iter().flat_map(|l| &l.joints);
    let refused = all.filter(|j| matches!(j.kind, JointKind::Screw { .. }));
    let mut refused: Vec<String> = refused.map(|j| format!("joint `{}`: MJCF has no screws", j.path)).collect();
    for link in tree.links.iter().filter(|l| l.mass.is_none() && !l.joints.is_empty()) {
        refused.push(format!(
            "`{}` moves on a joint and has no mass: MJCF wants mass there",
            tree.scene.objects[link.object].path
        ));
    }
    for link in tree.links.iter().filter(|l| l.parent.is_some() && l.joints.iter().any(|j| j.kind == JointKind::Free)) {
        refused.push(format!("`{}`: free joints of MJCF are at the top", tree.scene.objects[link.object].path));
    }
    if !refused.is_empty() {
        return Err(refused);
    }
    let mut out = format!(
        "<mujoco model=\"{}\">\n  <compiler angle=\"radian\" autolimits=\"true\" inertiafromgeom=\"false\"/>\n  <option gravity=\"{}\"/>\n",
        escaped(&tree.name),
        numbers(&tree.scene.model.gravity().0)
    );
    let mut world = String::new();
    let tendons = mjcf_tendon::Tendons::of(tree);
    tendons.sites_of(None, &mut world, "    ");
    let roots: Vec<usize> = (0..tree.links.len()).filter(|k| tree.links[*k].parent.is_none()).collect();
    for root in roots {
        body(&mut world, tree, &tendons, root, 2);
    }
    if !tree.meshes.is_empty() {
        out += "  <asset>\n";
        for file in tree.meshes.keys() {
            out += &format!("    <mesh name=\"{0}\" file=\"{0}\"/>\n", escaped(file));
        }
        out += "  </asset>\n";
    }
    out += &format!("  <worldbody>\n{world}  </worldbody>\n");
    tendons.write(&mut out, tree);
    equality(&mut out, tree, &tendons);
    actuators(&mut out, tree, &tendons);
    out += &super::mjcf_frames::section(tree);
    out += "</mujoco>\n";
    Ok(out)
}

fn place(pose: &Pose<f64>) -> String {
    format!("pos=\"{}\" quat=\"{}\"", numbers(&pose.pos.0), numbers(&wxyz(pose)))
}

/// True for a frame that carries nothing, which is a site.
pub(super) fn is_site(tree: &Tree<'_>, k: usize) -> bool {
    tree.links[k].mass.is_none()
        && tree.object(k).shown().next().is_none()
        && !(0..tree.links.len()).any(|c| tree.links[c].parent == Some(k))
}

fn body(out: &mut String, tree: &mut Tree<'_>, tendons: &Tendons, k: usize, depth: usize) {
    let pad = "  ".repeat(depth);
    let (name, pose) = (tree.links[k].name.clone(), tree.links[k].pose);
    if is_site(tree, k) {
        *out += &format!("{pad}<site name=\"{}\" {}/>\n", escaped(&name), place(&pose));
        return;
    }
    let joints: Vec<Joint> = tree.links[k].joints.iter().filter(|j| j.kind != JointKind::Fixed).cloned().collect();
    let free = joints.iter().find(|j| j.kind == JointKind::Free);
    let at = free.map_or(pose, |j| match j.start[..] {
        [x, y, z, a, b, c, d] => {
            let q = sincro_dynamics::spatial::Quat::from_slice(&[a, b, c, d]).normalized();
            j.pose.compose(&Pose { rot: q.matrix(), pos: Vec3([x, y, z]) }).compose(&j.pose.inverse().compose(&pose))
        }
        _ => pose,
    });
    *out += &format!("{pad}<body name=\"{}\" {}>\n", escaped(&name), place(&at));
    for joint in &joints {
        joint_text(out, tree, joint, &pose.inverse().compose(&joint.pose), &pad);
    }
    if let Some(mass) = tree.links[k].mass {
        let [xx, xy, xz, yy, yz, zz] = mass.inertia;
        *out += &format!(
            "{pad}  <inertial pos=\"{}\" mass=\"{}\" fullinertia=\"{}\"/>\n",
            numbers(&mass.center_of_mass),
            plain(mass.mass),
            numbers(&[xx, yy, zz, xy, xz, yz])
        );
    }
    tendons.sites_of(Some(k), out, &format!("{pad}  "));
    let (shown, touching) = tree.pieces(k);
    let own = tree.object(k).visuals.is_empty();
    let material = tree.object(k).contact.unwrap_or(Material { friction: 1.0, ..Material::default() });
    let (group, rolls) = (material.group, material.spinning_friction != 0.0 || material.rolling_friction != 0.0);
    let friction = numbers(&[material.friction, material.spinning_friction, material.rolling_friction]);
    let friction = format!("friction=\"{friction}\"{}", if rolls { " condim=\"6\"" } else { "" });
    if !touching.is_empty() && (material.restitution != 0.0 || material.stiffness.is_finite()) {
        let path = tree.object(k).path.clone();
        tree.note(&path, "the restitution and compliance of its contact are not written");
    }
    if !own || touching.is_empty() {
        for piece in shown {
            geom(out, tree, k, &piece, "contype=\"0\" conaffinity=\"0\" group=\"1\"", &pad);
        }
    }
    for piece in touching {
        if !Placement::exactly(&piece.pose).1 {
            let path = tree.object(k).path.clone();
            tree.note(&path, "the rotation of its geometry is written to rounding");
        }
        // bodies of one group do not touch each other: their bits do not meet
        let bits = if group == 0 {
            "contype=\"1\" conaffinity=\"3\"".to_owned()
        } else {
            "contype=\"2\" conaffinity=\"1\"".to_owned()
        };
        let hidden = if own { "" } else { " group=\"3\"" };
        geom(out, tree, k, &piece, &format!("{bits} {friction}{hidden}"), &pad);
    }
    let children: Vec<usize> = (0..tree.links.len()).filter(|c| tree.links[*c].parent == Some(k)).collect();
    for child in children {
        body(out, tree, tendons, child, depth + 1);
    }
    *out += &format!("{pad}</body>\n");
}

fn joint_text(out: &mut String, tree: &mut Tree<'_>, joint: &Joint, x: &Pose<f64>, pad: &str) {
    let axis = |axis: [f64; 3]| numbers(&x.rot.mul_vec(Vec3(axis)).0);
    let pos = numbers(&x.pos.0);
    let name = escaped(&joint.name);
    let property = |k: usize| {
        let Some(dof) = joint.dofs.get(k) else { return String::new() };
        let all = [
            ("damping", dof.damping),
            ("armature", dof.armature),
            ("frictionloss", dof.friction.sliding),
            ("stiffness", dof.stiffness),
        ];
        let mut text: String =
            all.iter().filter(|(_, x)| *x != 0.0).map(|(key, x)| format!(" {key}=\"{}\"", plain(*x))).collect();
        if dof.stiffness != 0.0 && dof.rest != 0.0 {
            text += &format!(" springref=\"{}\"", plain(dof.rest));
        }
        text
    };
    let range = |k: usize| {
        joint.limits_of(k).map_or_else(String::new, |ends| {
            format!(" range=\"{}\"", numbers(&ends.map(|x| x.clamp(-UNLIMITED, UNLIMITED))))
        })
    };
    let mut line = |kind: &str, suffix: &str, a: [f64; 3], k: usize| {
        *out += &format!(
            "{pad}  <joint name=\"{name}{suffix}\" type=\"{kind}\" pos=\"{pos}\" axis=\"{}\"{}{}/>\n",
            axis(a),
            range(k),
            property(k)
        );
    };
    match joint.kind {
        JointKind::Fixed | JointKind::Screw { .. } => {}
        JointKind::Revolute { axis } => line("hinge", "", axis, 0),
        JointKind::Prismatic { axis } => line("slide", "", axis, 0),
        JointKind::Universal { axis, axis2 } => {
            line("hinge", ".1", axis, 0);
            line("hinge", ".2", axis2, 1);
        }
        JointKind::Planar => {
            line("slide", ".x", [1.0, 0.0, 0.0], 0);
            line("slide", ".y", [0.0, 1.0, 0.0], 1);
            line("hinge", ".angle", [0.0, 0.0, 1.0], 2);
        }
        JointKind::Ball => {
            *out +=
                &format!("{pad}  <joint name=\"{name}\" type=\"ball\" pos=\"{pos}\"{}/>\n", of_all_axes(tree, joint))
        }
        JointKind::Free => match of_all_axes(tree, joint) {
            none if none.is_empty() => *out += &format!("{pad}  <freejoint name=\"{name}\"/>\n"),
            all => *out += &format!("{pad}  <joint name=\"{name}\" type=\"free\"{all}/>\n"),
        },
    }
    let kind = joint.kind;
    let is_zero = match joint.start[..] {
        [w, ref rest @ ..] if kind == JointKind::Ball => w.abs() == 1.0 && rest.iter().all(|x| *x == 0.0),
        ref all => all.iter().all(|x| *x == 0.0),
    };
    if kind != JointKind::Free && !is_zero {
        tree.note(&joint.path, "MJCF starts it at zero");
    }
    if let Some(word) = word_of_several(kind) {
        let words = format!("MJCF has no {word} joints: its {} axes are joints each", joint.dofs.len());
        tree.note(&joint.path, &words);
    }
}

/// Properties of a ball or free joint, of which MJCF has one number for all axes; notes those that differ, and springs
/// and limits.
fn of_all_axes(tree: &mut Tree<'_>, joint: &Joint) -> String {
    let all = [
        ("damping", "damping", joint.common(|dof| dof.damping)),
        // of a free joint it is along other axes there
        (
            "armature",
            "armature",
            joint.common(|dof| dof.armature).filter(|x| *x == 0.0 || joint.kind == JointKind::Ball),
        ),
        // friction of a ball joint is bounded axis by axis there
        ("friction", "frictionloss", joint.common(|dof| dof.friction.sliding).filter(|x| *x == 0.0)),
    ];
    tree.note_left_out(joint, |word| !all.iter().any(|(own, _, number)| *own == word && number.is_some()));
    let given = all.iter().filter_map(|(_, key, number)| Some((key, number.filter(|x| *x != 0.0)?)));
    given.map(|(key, x)| format!(" {key}=\"{}\"", plain(x))).collect()
}

/// Word for a kind of joint that is several in MJCF.
fn word_of_several(kind: JointKind) -> Option<&'static str> {
    match kind {
        JointKind::Planar => Some("planar"),
        JointKind::Universal { .. } => Some("universal"),
        _ => None,
    }
}

fn geom(out: &mut String, tree: &mut Tree<'_>, k: usize, piece: &Piece, more: &str, pad: &str) {
    let path = tree.object(k).path.clone();
    let shape = match &piece.surface {
        Surface::Solid(shape) => match solid(shape) {
            Some(("box", s)) => format!("type=\"box\" size=\"{}\"", numbers(&[0.5 * s[0], 0.5 * s[1], 0.5 * s[2]])),
            Some(("sphere", s)) => format!("type=\"sphere\" size=\"{}\"", plain(s[0])),
            Some((word, s)) => format!("type=\"{word}\" size=\"{}\"", numbers(&[s[0], 0.5 * s[1]])),
            None => return tree.note(&path, "MJCF has no cones and tori"),
        },
        Surface::HalfSpace => "type=\"plane\" size=\"0 0 1\"".to_owned(),
        surface => match tree.mesh_file(k, surface) {
            Some(file) => format!("type=\"mesh\" mesh=\"{}\"", escaped(&file)),
            None => return tree.note(&path, "height fields are not written"),
        },
    };
    let color = piece.color.map_or_else(String::new, |c| {
        let [r, g, b] = c.map(|x| plain(f64::from(x) / 255.0));
        format!(" rgba=\"{r} {g} {b} 1\"")
    });
    *out += &format!("{pad}  <geom {shape} {} {more}{color}/>\n", place(&piece.pose));
}

fn equality(out: &mut String, tree: &mut Tree<'_>, tendons: &Tendons) {
    let mut lines = String::new();
    let names: Vec<String> = tree.scene.model.constraints().gears.iter().map(|gear| gear.name.clone()).collect();
    for ((first, second, coefficients), name) in tree.gears().into_iter().zip(names) {
        tree.note(&name, "MJCF's couplings are soft");
        lines += &format!(
            "    <joint name=\"{}\" joint1=\"{}\" joint2=\"{}\" polycoef=\"{}\"/>\n",
            name_of(&name),
            escaped(&second),
            escaped(&first),
            numbers(&coefficients)
        );
    }
    for (k, closure) in tree.scene.model.constraints().loop_joints.clone().into_iter().enumerate() {
        let (name, [a, b]) = (name_of(&closure.name), tendons.of_loop(k));
        for (end, site) in [(&closure.a.name, a), (&closure.b.name, b)] {
            if site.starts_with(&format!("{name}-")) {
                tree.note(&closure.name, &format!("its end `{end}` is a site of its own in MJCF"));
            }
        }
        let words = match closure.kind {
            LoopJointKind::Point => format!("<connect name=\"{name}\" site1=\"{a}\" site2=\"{b}\"/>"),
            LoopJointKind::Weld => format!("<weld name=\"{name}\" site1=\"{a}\" site2=\"{b}\"/>"),
            _ => {
                tree.note(&closure.name, "MJCF closes loops by points and welds of frames only");
                continue;
            }
        };
        lines += &format!("    {words}\n");
        tree.note(&closure.name, "MJCF's loops are soft");
    }
    lines += &tendons.bushings(tree);
    if !lines.is_empty() {
        *out += &format!("  <equality>\n{lines}  </equality>\n");
    }
}

fn actuators(out: &mut String, tree: &mut Tree<'_>, tendons: &Tendons) {
    let joints: Vec<Joint> = tree.links.iter().flat_map(|l| l.joints.iter().cloned()).collect();
    let mut lines = String::new();
    for joint in joints {
        let Some(motor) = joint.motor else { continue };
        let limit = if motor.max_torque.is_finite() && motor.max_torque > 0.0 {
            format!(" forcerange=\"{0} {1}\"", plain(-motor.max_torque), plain(motor.max_torque))
        } else {
            String::new()
        };
        let name = escaped(&joint.name);
        if let Some(activation) = joint.activation
            && matches!(motor.mode, MotorMode::Torque | MotorMode::Spring)
        {
            let (kp, kv) = (plain(motor.stiffness), plain(motor.damping));
            let law = match motor.mode {
                MotorMode::Spring => format!("gainprm=\"{kp}\" biastype=\"affine\" biasprm=\"0 -{kp} -{kv}\""),
                _ => "gainprm=\"1\"".to_owned(),
            };
            let keys = activation_keys(tree, &joint.path, &activation);
            lines += &format!("    <general name=\"{name}\" joint=\"{name}\" {law} {keys}{limit}/>\n");
            continue;
        }
        match motor.mode {
            MotorMode::Torque => lines += &format!("    <motor name=\"{name}\" joint=\"{name}\"{limit}/>\n"),
            MotorMode::Spring => {
                let (kp, kv) = (plain(motor.stiffness), plain(motor.damping));
                lines += &format!("    <position name=\"{name}\" joint=\"{name}\" kp=\"{kp}\" kv=\"{kv}\"{limit}/>\n");
            }
            MotorMode::Voltage => {
                tree.note(&joint.path, "MJCF has no motors with a resistance that take a voltage: none is written");
                if joint.activation.is_some() {
                    tree.note(&joint.path, "the activation of its motor is not written");
                }
            }
            _ => tree.note(&joint.path, "MJCF has no ideal motors: none is written"),
        }
    }
    lines += &tendons.actuators(tree);
    if !lines.is_empty() {
        *out += &format!("  <actuator>\n{lines}  </actuator>\n");
    }
}

/// Attributes of an activation; notes what MJCF does not say.
pub(super) fn activation_keys(tree: &mut Tree<'_>, path: &str, own: &Activation<f64>) -> String {
    let mut keys = match own.time_constant() {
        Some(time_constant) => format!("dyntype=\"filterexact\" dynprm=\"{}\"", plain(time_constant)),
        None => "dyntype=\"integrator\"".to_owned(),
    };
    for (key, range) in [("actrange", own.range), ("ctrlrange", own.input_range)] {
        if range.iter().any(|x| x.is_finite()) {
            keys += &format!(" {key}=\"{}\"", numbers(&range.map(|x| x.clamp(-UNLIMITED, UNLIMITED))));
        }
    }
    if own.initial != 0.0 {
        tree.note(path, "MuJoCo starts its activation at zero");
    }
    keys
}
