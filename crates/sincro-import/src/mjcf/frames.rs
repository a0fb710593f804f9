//! Frames and names of joints and bodies in custom data, which the export of scenes writes: those of the scene, where
//! MJCF has others.

use std::collections::BTreeMap;

use sincro_dynamics::spatial::{Pose, Quat, Vec3};

use super::Reader;
use crate::export::PREFIX;
use crate::findings::Findings;
use crate::robot::{Joint, JointKind, Keyframe, Placement, Robot, Rotation};
use crate::source::Element;

/// Largest difference of what is written twice `[m]`, (dimensionless).
const SAME: f64 = 1e-9;

/// Custom data by name.
struct Custom<'d> {
    texts: BTreeMap<&'d str, &'d str>,
    numbers: BTreeMap<&'d str, Vec<f64>>,
}

/// Name and place of a joint or body in the scene.
struct Frame {
    name: String,
    placement: Placement,
}

impl Custom<'_> {
    fn frame(&self, kind: &str, name: &str) -> Option<Frame> {
        let key = format!("{PREFIX}{kind}:{name}");
        let own = self.texts.get(&*key)?;
        let get = |what: &str| self.numbers.get(&*format!("{key}:{what}")).map(Vec::as_slice);
        let &[x, y, z] = get("position")? else { return None };
        let rotation = match (get("rotation_deg"), get("quaternion_wxyz")) {
            (Some(&[roll, pitch, yaw]), _) => Rotation::RollPitchYaw([roll, pitch, yaw].map(f64::to_radians)),
            (_, Some(&[w, i, j, k])) if w * w + i * i + j * j + k * k > 0.0 => Rotation::Quaternion([w, i, j, k]),
            _ => return None,
        };
        Some(Frame { name: (*own).to_owned(), placement: Placement { position: [x, y, z], rotation } })
    }

    fn axis(&self, name: &str) -> Option<[f64; 3]> {
        let &[x, y, z] = &self.numbers.get(&*format!("{PREFIX}joint:{name}:axis"))?[..] else { return None };
        Some([x, y, z])
    }

    fn group(&self, name: &str) -> Option<usize> {
        let &[x] = &self.numbers.get(&*format!("{PREFIX}body:{name}:group"))?[..] else { return None };
        (x >= 0.0 && x.fract() == 0.0 && x < 1e6).then_some(x as usize)
    }
}

/// True if two poses are the same but for rounding.
fn same(a: &Pose<f64>, b: &Pose<f64>) -> bool {
    let turned = (0..3).flat_map(|i| (0..3).map(move |j| (a.rot.0[i][j] - b.rot.0[i][j]).abs())).fold(0.0, f64::max);
    turned.max((a.pos - b.pos).norm()) < SAME
}

impl<'d> Reader<'d> {
    /// Takes frames and names from custom data where they agree with the bodies; `custom` are the elements of that
    /// name.
    pub(super) fn frames(&self, custom: &[Element<'d>], robot: &mut Robot, findings: &mut Findings) {
        let mut data = Custom { texts: BTreeMap::new(), numbers: BTreeMap::new() };
        let elements = custom.iter().flat_map(|element| self.files.elements(*element));
        let own = elements.filter(|e| e.peek("name").is_some_and(|name| name.starts_with(PREFIX)));
        let mut first = None;
        for element in own {
            element.keep();
            first = first.or(Some(element));
            let name = element.attribute("name").unwrap_or_default();
            if element.name() == "text" {
                data.texts.extend(element.attribute("data").map(|text| (name, text)));
            } else if let Some(Some(numbers)) = findings.take(element.numbers("data")) {
                data.numbers.insert(name, numbers);
            }
        }
        let Some(first) = first else { return };
        custom.iter().for_each(Element::keep);
        let mut left = Vec::new();
        for (name, &link) in self.bodies.iter().chain(&self.sites) {
            let Some(frame) = data.frame("body", name) else { continue };
            if !place(robot, link, frame, &data) {
                left.push(name.as_str());
            }
            robot.links[link].group = data.group(name);
        }
        if !left.is_empty() {
            let message =
                format!("frames of custom data that the bodies contradict are not taken: {}", left.join(", "));
            findings
                .warn(first.error(message).with_help("remove the custom data `sincro:…` after changes of the file"));
        }
    }
}

/// Joints from the link above to `link`, outermost first; those between have links without mass.
fn chain(robot: &Robot, link: usize) -> Vec<usize> {
    let mut joints: Vec<usize> = robot.joint_of(link).into_iter().collect();
    while let Some(above) = joints.last().and_then(|j| robot.joints[*j].parent)
        && robot.links[above].is_virtual
        && let Some(joint) = robot.joint_of(above)
    {
        joints.push(joint);
    }
    joints.reverse();
    joints
}

/// Coordinates of a joint in all keyframes.
fn coordinates(keyframes: &mut [Keyframe], joint: usize) -> impl Iterator<Item = &mut Vec<f64>> {
    let all = keyframes.iter_mut().flat_map(|keyframe| &mut keyframe.positions);
    all.filter(move |(k, _)| *k == joint).map(|(_, q)| q)
}

/// Gives a body and the joints before it their frames and names; false if these contradict those that they have.
fn place(robot: &mut Robot, link: usize, own: Frame, data: &Custom<'_>) -> bool {
    let joints = chain(robot, link);
    let is_fixed = |k: &usize| robot.joints[*k].kind == JointKind::Fixed;
    let links = || joints.iter().map(|k| robot.links[robot.joints[*k].child].pose.pose());
    if joints.iter().all(is_fixed) {
        let present = joints
            .iter()
            .zip(links())
            .fold(Pose::identity(), |x, (k, inner)| x.compose(&robot.joints[*k].pose.pose()).compose(&inner));
        let present = if joints.is_empty() { robot.links[link].pose.pose() } else { present };
        if !same(&present, &own.placement.pose()) {
            return false;
        }
        match joints[..] {
            [] => robot.links[link].pose = own.placement,
            [joint] => (robot.joints[joint].pose, robot.links[link].pose) = (own.placement, Placement::default()),
            _ => return false,
        }
        robot.links[link].name = own.name;
        return true;
    }
    let Some(frames) = joints.iter().map(|k| data.frame("joint", &robot.joints[*k].name)).collect::<Option<Vec<_>>>()
    else {
        return false;
    };
    if let [k] = joints[..]
        && robot.joints[k].kind == JointKind::Free
    {
        // where the body stands is the coordinate
        let [frame] = &frames[..] else { return false };
        let (outer, inner) = (frame.placement.pose().inverse(), own.placement.pose().inverse());
        let starts = robot.joints[k].initial.iter_mut();
        for q in starts.chain(coordinates(&mut robot.keyframes, k)) {
            if let [x, y, z, w, i, j, l] = q[..] {
                let stands = Placement { position: [x, y, z], rotation: Rotation::Quaternion([w, i, j, l]) }.pose();
                let moved = outer.compose(&stands).compose(&inner);
                q[..3].copy_from_slice(&moved.pos.0);
                Quat::from_matrix(&moved.rot).write(&mut q[3..]);
            }
        }
        let joint = &mut robot.joints[k];
        (joint.pose, joint.name) = (frame.placement, frame.name.clone());
        (robot.links[link].pose, robot.links[link].name) = (own.placement, own.name);
        return true;
    }
    let axis = |joint: &Joint| data.axis(&joint.name).unwrap_or(joint.axis);
    let (mut present, mut wanted) = (Pose::identity(), Pose::identity());
    // rotations from the axes that a joint has to those that it gets
    let mut turns = Vec::new();
    for ((k, inner), frame) in joints.iter().zip(links()).zip(&frames) {
        let joint = &robot.joints[*k];
        present = present.compose(&joint.pose.pose());
        wanted = wanted.compose(&frame.placement.pose());
        let turned = |x: &Pose<f64>, axis: [f64; 3]| {
            let axis = x.rot.mul_vec(Vec3(axis));
            axis.scale(1.0 / axis.norm())
        };
        let is_axis =
            joint.kind.dofs() != 1 || (turned(&present, joint.axis) - turned(&wanted, axis(joint))).norm() < SAME;
        if !is_axis || (present.pos - wanted.pos).norm() > SAME {
            return false;
        }
        turns.push(wanted.rot.transpose().mul(&present.rot));
        present = present.compose(&inner);
    }
    if !same(&present, &wanted.compose(&own.placement.pose())) {
        return false;
    }
    for ((k, frame), turn) in joints.into_iter().zip(frames).zip(turns) {
        for q in coordinates(&mut robot.keyframes, k).filter(|q| q.len() == 4) {
            let rotation = Quat::from_slice(q).normalized().matrix();
            Quat::from_matrix(&turn.mul(&rotation).mul(&turn.transpose())).write(q);
        }
        let joint = &mut robot.joints[k];
        joint.axis = axis(joint);
        (joint.pose, joint.name) = (frame.placement, frame.name);
        let child = joint.child;
        robot.links[child].pose = Placement::default();
    }
    (robot.links[link].pose, robot.links[link].name) = (own.placement, own.name);
    true
}
