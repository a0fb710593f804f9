//! The simulated mechanism as a page shows it: joints, bodies, equations of motion with their sizes.

use sincro_scene::scene::{Object, ObjectKind};
use sincro_sim::Loaded;
use sincro_sim::campaign::Campaign;
use sincro_sim::replay::{JointView, ObjectView, SceneView};

use crate::plot::number::{short, significant};
use crate::report::{BodyRow, JointRow, Mechanism};

/// The mechanism of the main run; `None`: nothing in it moves. The sketch and the
/// derivation are left empty: they are the caller's.
pub(super) fn of(loaded: &Loaded, campaign: &Campaign) -> Option<Mechanism> {
    let view = &campaign.main.view;
    if view.n_v == 0 {
        return None;
    }
    let row = |o: &ObjectView| o.joint.as_ref().filter(|j| j.n_v > 0).map(|j| joint_row(view, o, j, loaded));
    Some(Mechanism {
        sketch: String::new(),
        derivation: String::new(),
        equation: equation(loaded),
        sizes: sizes(loaded, view),
        joints: view.objects.iter().filter_map(row).collect(),
        bodies: loaded.scene.objects.iter().filter_map(|object| body_row(loaded, object)).collect(),
    })
}

fn joint_row(view: &SceneView, object: &ObjectView, joint: &JointView, loaded: &Loaded) -> JointRow {
    let start = loaded.scene.initial.q.get(joint.q_idx..joint.q_idx + joint.n_q).unwrap_or(&[]);
    let springs = joint.springs.iter().map(|(_, stiffness, _)| format!("spring {}", short(*stiffness, 4)));
    let motor = joint.motor.then(|| "motor".to_owned());
    JointRow {
        path: object.path.clone(),
        kind: object.kind.trim_end_matches(" joint").to_owned(),
        parent: parent(view, object),
        axes: joint.axes.iter().map(|axis| axis_name(*axis)).collect::<Vec<_>>().join(", "),
        coordinates: span("q", joint.q_idx, joint.n_q),
        start: start.iter().map(|x| short(*x, 4)).collect::<Vec<_>>().join(", "),
        actuation: motor.into_iter().chain(springs).collect::<Vec<_>>().join(", "),
    }
}

fn body_row(loaded: &Loaded, object: &Object) -> Option<BodyRow> {
    let ObjectKind::Body { mass } = &object.kind else { return None };
    let parent = object.parent.map(|k| loaded.scene.objects[k].path.clone());
    let inertia = [mass.inertia[0], mass.inertia[3], mass.inertia[5]];
    Some(BodyRow {
        path: object.path.clone(),
        parent: parent.unwrap_or_else(|| "world".into()),
        mass: short(mass.mass, 5),
        center: mass.center_of_mass.iter().map(|x| short(*x, 4)).collect::<Vec<_>>().join(", "),
        inertia: inertia.iter().map(|x| significant(*x, 3)).collect::<Vec<_>>().join(", "),
    })
}

fn parent(view: &SceneView, object: &ObjectView) -> String {
    object.parent.and_then(|k| view.objects.get(k)).map_or_else(|| "world".to_owned(), |o| o.path.clone())
}

/// `y` for a coordinate axis, the numbers for others.
fn axis_name(axis: [f64; 3]) -> String {
    let named = [("x", [1.0, 0.0, 0.0]), ("y", [0.0, 1.0, 0.0]), ("z", [0.0, 0.0, 1.0])];
    let same = |other: [f64; 3], sign: f64| (0..3).all(|k| axis[k] == sign * other[k]);
    for (name, unit) in named {
        if same(unit, 1.0) {
            return name.to_owned();
        }
        if same(unit, -1.0) {
            return format!("−{name}");
        }
    }
    format!("({})", axis.map(|x| short(x, 4)).join(", "))
}

/// `q0`, or `q0 … q6`.
fn span(letter: &str, first: usize, n: usize) -> String {
    match n {
        0 => String::new(),
        1 => format!("{letter}{first}"),
        _ => format!("{letter}{first} … {letter}{}", first + n - 1),
    }
}

/// Structure of the equations of motion: the terms that this model has.
fn equation(loaded: &Loaded) -> String {
    let model = &loaded.scene.model;
    let set = model.constraints();
    let has_forces = !set.is_empty() || model.n_drives() > 0;
    let forces = if has_forces { " + Jᵀ(q) λ" } else { "" };
    format!("M(q) v̇ + c(q, v) = τ(q, v, u, t){forces}")
}

/// Sizes of the parts of the equations, with what they count.
fn sizes(loaded: &Loaded, view: &SceneView) -> Vec<(String, String)> {
    let model = &loaded.scene.model;
    let set = model.constraints();
    let freedom = loaded.scene.freedom();
    let (n_q, n_v) = (view.n_q, view.n_v);
    let kinematics = if n_q == n_v { "q̇ = v" } else { "q̇ = N(q) v, with unit quaternions in q" };
    let mut rows = vec![
        ("q".to_owned(), format!("{n_q} coordinates; {kinematics}")),
        ("v".to_owned(), format!("{n_v} velocities")),
        ("M".to_owned(), format!("mass matrix, {n_v} × {n_v}, of {} moving links", model.links().len())),
        ("c".to_owned(), format!("{n_v} gyroscopic, Coriolis and gravity terms")),
        ("u".to_owned(), format!("{} commands of motors, forces and rotors", model.n_commands())),
    ];
    if freedom.loops > 0 {
        let redundant =
            if freedom.redundant > 0 { format!(", {} redundant", freedom.redundant) } else { String::new() };
        rows.push(("loops".into(), format!("{} with {} equations{redundant}", freedom.loops, freedom.equations)));
    }
    if !set.limits.is_empty() {
        rows.push(("limits".into(), format!("{} of joints", set.limits.len())));
    }
    if !set.pairs.is_empty() {
        rows.push((
            "contacts".into(),
            format!("{} pairs of surfaces, up to {} points", set.pairs.len(), set.n_contacts()),
        ));
    }
    if let Some(controller) = &loaded.controller {
        let program = controller.wiring.program();
        let memory =
            if program.n_memory > 0 { format!(", {} numbers in memory", program.n_memory) } else { String::new() };
        rows.push((
            "controller".into(),
            format!("{} blocks, {} continuous states{memory}", program.steps.len(), program.n_states),
        ));
    }
    rows
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn axes_have_their_names() {
        assert_eq!(axis_name([0.0, 1.0, 0.0]), "y");
        assert_eq!(axis_name([0.0, 0.0, -1.0]), "−z");
        assert_eq!(axis_name([0.6, 0.8, 0.0]), "(0.6, 0.8, 0)");
        assert_eq!(span("q", 3, 4), "q3 … q6");
    }
}
