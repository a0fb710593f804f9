//! Links as bodies, frames and fixtures, with what shows and what touches.

use std::path::PathBuf;

use super::{Context, Writer, keys, last, one_line, place};
use crate::mesh::MeshUse;
use crate::number::{list, number, quoted};
use crate::policy;
use crate::resolve::Resolver;
use crate::robot::{Geometry, JointKind, Link, Placement, Robot, Shape};
use crate::source::ElementStatus;

/// Friction coefficient where the source gives none.
pub(super) const FRICTION: f64 = 1.0;

/// Inline table of a shape, and the colour of its material.
type Form = (String, Option<[u8; 3]>);

/// Gives collision geometry of moving links without mass to the bodies they are fixed to: what touches is a body.
pub(super) fn gather_collisions(robot: &mut Robot, fixed: &[bool], context: &Context<'_>) {
    for link in 0..robot.links.len() {
        if robot.links[link].inertial.is_some() || fixed[link] || robot.links[link].collisions.is_empty() {
            continue;
        }
        let carrier = carrier(robot, link);
        let pieces = std::mem::take(&mut robot.links[link].collisions);
        for piece in pieces {
            match &carrier {
                Some((body, pose)) => {
                    let words =
                        format!("it touches as part of `{}`: its own link has no mass", robot.links[*body].name);
                    context.ledger.judge_place(piece.element, ElementStatus::Changed, &words);
                    let pose = pose.then(&piece.pose);
                    robot.links[*body].collisions.push(Geometry { pose, ..piece });
                }
                None => {
                    context.ledger.judge_place(
                        piece.element,
                        ElementStatus::Dropped,
                        "its link has no mass: nothing can touch it",
                    );
                }
            }
        }
    }
}

/// The body that a link without mass is fixed to, nearest first, and the link's frame in it.
fn carrier(robot: &Robot, link: usize) -> Option<(usize, Placement)> {
    let (mut at, mut pose) = (link, Placement::default());
    loop {
        let joint = &robot.joints[robot.joint_of(at)?];
        if joint.kind != JointKind::Fixed {
            // what is fixed to the link may have mass
            return below(robot, link);
        }
        pose = joint.pose.then(&robot.links[at].pose).then(&pose);
        at = joint.parent?;
        if robot.links[at].inertial.is_some() {
            return Some((at, pose));
        }
    }
}

/// The first body fixed to a link, and the link's frame in it.
fn below(robot: &Robot, link: usize) -> Option<(usize, Placement)> {
    let joint = robot
        .joints
        .iter()
        .find(|j| j.parent == Some(link) && j.kind == JointKind::Fixed && robot.links[j.child].inertial.is_some())?;
    let there = joint.pose.then(&robot.links[joint.child].pose).pose();
    Some((joint.child, Placement::of_pose(&there.inverse())))
}

/// Meshes that the links use: path, true if it shows, and factors. Those that are not found are left out.
pub(super) fn mesh_uses(robot: &Robot, resolver: &Resolver) -> Vec<(PathBuf, bool, [f64; 3])> {
    let pieces = robot.links.iter().filter(|link| !link.is_virtual).flat_map(|link| {
        let collisions = link.collisions.iter().map(|piece| (piece, false));
        collisions.chain(link.visuals.iter().map(|piece| (piece, true)))
    });
    let used = pieces.filter_map(|(piece, shows)| match &piece.shape {
        Shape::Mesh { uri, scale } => Some((resolver.find(uri).ok()?, shows, *scale)),
        _ => None,
    });
    used.collect()
}

impl Writer<'_> {
    /// Writes a link below `parent`; `fixed_by` is the fixed joint that places it, if there is one.
    pub(super) fn link(&mut self, k: usize, parent: &str, pose: Placement, fixed_by: Option<usize>) {
        let robot = self.robot;
        let link = &robot.links[k];
        if link.is_virtual {
            // the next joint hangs on this one
            self.link_paths[k] = Some(parent.to_owned());
            return;
        }
        let shapes = self.pieces(&link.collisions, false, link.visuals.is_empty());
        let visuals = self.pieces(&link.visuals, true, true);
        let is_body = link.inertial.is_some() || !shapes.is_empty();
        let path = self.unique(parent, &link.name);
        let by = fixed_by.map_or_else(String::new, |j| format!(" on joint `{}`", one_line(&self.robot.joints[j].name)));
        self.line(&format!("# link `{}`{by}, {}", one_line(&link.name), place(&link.at)));
        self.line(if is_body { "[[body]]" } else { "[[frame]]" });
        self.line(&format!("name = {}", quoted(last(&path))));
        if parent != "/" {
            self.line(&format!("parent = {}", quoted(parent)));
        }
        self.placement(&pose);
        if let Some(inertial) = &link.inertial {
            self.line(&format!("mass = {}", number(inertial.mass)));
            if inertial.center_of_mass != [0.0; 3] {
                self.line(&format!("center_of_mass = {}", list(&inertial.center_of_mass)));
            }
            let [xx, xy, xz, yy, yz, zz] = inertial.inertia;
            let off = [("xy", xy), ("xz", xz), ("yz", yz)].into_iter().filter(|(_, x)| *x != 0.0);
            let off: String = off.map(|(key, x)| format!(", {key} = {}", number(x))).collect();
            self.line(&format!("inertia = {{ xx = {}, yy = {}, zz = {}{off} }}", number(xx), number(yy), number(zz)));
            debug_assert!(policy::properties(inertial).mass > 0.0);
        }
        self.list("shape", &shapes);
        if is_body && !shapes.is_empty() {
            self.contact(k, link);
        }
        self.list("visual", &visuals);
        self.line("");
        self.link_paths[k] = Some(path);
    }

    fn list(&mut self, key: &str, pieces: &[String]) {
        match pieces {
            [] => {}
            [one] if one.len() < 90 => self.line(&format!("{key} = [{{ {one} }}]")),
            many => {
                self.line(&format!("{key} = ["));
                many.iter().for_each(|piece| self.line(&format!("    {{ {piece} }},")));
                self.line("]");
            }
        }
    }

    fn contact(&mut self, k: usize, link: &Link) {
        let given: Vec<_> = link.collisions.iter().filter_map(|c| c.surface).collect();
        let group = match link.group.unwrap_or(self.groups[k]) {
            n if n > 0 && !self.robot.self_contact => format!(", group = {n}"),
            _ => String::new(),
        };
        let Some(first) = given.first() else {
            return self.line(&format!("contact = {{ friction = {}{group} }}", number(FRICTION)));
        };
        if given.iter().any(|s| s != first) {
            let words = format!("surfaces of `{}` differ in friction: the body has the largest", link.name);
            self.written.warnings.push((link.at.clone(), words));
        }
        let most = |f: &dyn Fn(&crate::robot::SurfaceLaw) -> f64| given.iter().map(f).fold(0.0, f64::max);
        let friction = number(most(&|s| s.friction));
        let more = [
            ("rolling_friction", most(&|s| s.rolling_friction)),
            ("spinning_friction", most(&|s| s.spinning_friction)),
        ];
        let more: String =
            more.into_iter().filter(|(_, x)| *x > 0.0).map(|(key, x)| format!(", {key} = {}", number(x))).collect();
        self.line(&format!("contact = {{ friction = {friction}{more}{group} }}"));
    }

    /// Inline tables of geometry.
    fn pieces(&mut self, pieces: &[Geometry], shows: bool, with_color: bool) -> Vec<String> {
        let mut out = Vec::new();
        for piece in pieces {
            match self.forms(piece, shows) {
                Ok(forms) => {
                    for (form, own_color) in forms {
                        let mut words = vec![form];
                        words.extend(keys(&piece.pose));
                        if let Some([r, g, b]) = piece.color.or(own_color).filter(|_| with_color) {
                            words.push(format!("color = \"#{r:02x}{g:02x}{b:02x}\""));
                        }
                        out.push(words.join(", "));
                    }
                }
                Err(why) => {
                    self.context.ledger.judge_place(piece.element, ElementStatus::Dropped, &why);
                    let kind = if shows { "visual" } else { "collision" };
                    self.written.warnings.push((piece.at.clone(), format!("{kind} geometry is left out: {why}")));
                    if !shows && let Shape::Mesh { uri, .. } = &piece.shape {
                        self.written.missing_collisions.push(format!("{uri}: {why}"));
                    }
                }
            }
        }
        out
    }

    /// The shapes that a geometry becomes, with the colours of their materials; the reason if there is none.
    fn forms(&mut self, piece: &Geometry, shows: bool) -> Result<Vec<Form>, String> {
        let positive = |all: &[f64]| all.iter().all(|x| x.is_finite() && *x > 0.0);
        let solid = |sizes: &[f64], text: String| {
            if positive(sizes) { Ok(vec![(text, None)]) } else { Err(format!("its size {sizes:?} is not positive")) }
        };
        match &piece.shape {
            Shape::Cuboid(size) => solid(size, format!("cuboid = {{ size = {} }}", list(size))),
            Shape::Sphere(r) => solid(&[*r], format!("sphere = {{ radius = {} }}", number(*r))),
            Shape::Cylinder(r, l) => {
                solid(&[*r, *l], format!("cylinder = {{ radius = {}, length = {} }}", number(*r), number(*l)))
            }
            Shape::Capsule(r, l) => {
                solid(&[*r, *l], format!("capsule = {{ radius = {}, length = {} }}", number(*r), number(*l)))
            }
            Shape::Ellipsoid(axes) if positive(axes) => {
                let file = self.meshes.ellipsoid();
                self.context.ledger.judge_place(
                    piece.element,
                    ElementStatus::Changed,
                    "an ellipsoid: a mesh of 320 triangles",
                );
                let used = MeshUse { file, scale: *axes, color: None };
                Ok(vec![(mesh_text(&used, shows), None)])
            }
            Shape::Ellipsoid(axes) => Err(format!("its size {axes:?} is not positive")),
            Shape::Plane if shows => Err("a plane shows by its contact".into()),
            Shape::Plane => Ok(vec![("plane = {}".into(), None)]),
            Shape::HeightField { .. } if shows => Err("a height field shows by its contact".into()),
            Shape::HeightField { name, rows, size } => {
                let file = self.meshes.heights(name, rows)?;
                self.context.ledger.judge_place(
                    piece.element,
                    ElementStatus::Changed,
                    "a height field: its triangles may be split along the other diagonal",
                );
                Ok(vec![(format!("height_field = {{ file = {}, size = {} }}", quoted(&file), list(size)), None)])
            }
            Shape::Mesh { uri, scale } => {
                let path = self.context.resolver.find(uri)?;
                let placed =
                    if shows { self.meshes.visual(&path, *scale) } else { self.meshes.collision(&path, *scale) }?;
                if let Some(change) = &placed.change {
                    self.context.ledger.judge_place(piece.element, ElementStatus::Changed, change);
                }
                Ok(placed.uses.iter().map(|used| (mesh_text(used, shows), used.color)).collect())
            }
        }
    }
}

fn mesh_text(used: &MeshUse, shows: bool) -> String {
    let scale = match used.scale {
        [1.0, 1.0, 1.0] => String::new(),
        [x, y, z] if x == y && y == z => format!(", scale = {}", number(x)),
        scale => format!(", scale = {}", list(&scale)),
    };
    let convex = if shows { "" } else { ", convex = true" };
    format!("mesh = {{ file = {}{scale}{convex} }}", quoted(&used.file))
}
