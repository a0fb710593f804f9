//! Contact, limits, closures and couplings: from what is written to the builder's specifications.

use sincro_dynamics::constraint::LoopJointKind;
use sincro_dynamics::contact::{Material, PairLaw, Surface, WORLD};
use sincro_dynamics::model::{GearSpec, LoopJointSpec, Model, ModelBuilder, NodeId};
use sincro_dynamics::spatial::{Mat3, Pose, Vec3};

use super::body;
use super::file::{
    BodyFile, ClosureFile, ClosureKindFile, ContactFile, ContactPairFile, CouplingFile, JointKindFile, LimitsFile,
    SceneFile,
};
use super::height_field;
use super::mesh::MeshInstance;
use super::object::{Object, ObjectKind, ShapeInstance};
use super::placement::{self, Placement};
use super::signal_file::SignalReader;
use crate::diagnostic::{Diagnostic, Diagnostics};
use crate::document::Document;
use crate::folder::Folder;
use crate::names::fits;
use crate::suggest;
use crate::tree;

/// Contact geometry and material of a body.
#[derive(Default)]
pub(super) struct Skin {
    pub material: Option<Material>,
    /// Surfaces that are no solids.
    pub surfaces: Vec<(Surface, Pose<f64>)>,
    /// Colours of those, as far as they have one.
    pub colors: Vec<Option<[u8; 3]>>,
}

impl Skin {
    /// Tells the builder of all surfaces of the body `node`.
    pub fn add_to(&self, builder: &mut ModelBuilder, node: NodeId, shapes: &[ShapeInstance]) {
        let Some(material) = self.material else { return };
        for (surface, pose) in &self.surfaces {
            builder.collider(node, *pose, surface.clone(), material);
        }
        for shape in shapes {
            builder.collider(node, shape.pose, Surface::Solid(shape.shape), material);
        }
    }
}

/// Material and surfaces of a body.
pub(super) fn skin(
    file: &BodyFile,
    meshes: &[MeshInstance],
    pointer: &str,
    document: &Document,
    folder: &Folder,
    diagnostics: &mut Diagnostics,
) -> Skin {
    let mut surfaces: Vec<_> = meshes.iter().map(|mesh| (mesh.surface(), mesh.pose)).collect();
    let mut colors: Vec<_> = meshes.iter().map(|mesh| mesh.color).collect();
    for (k, shape) in file.shape.iter().enumerate() {
        let pointer = format!("{pointer}/shape/{k}");
        let surface = match (&shape.plane, &shape.hull, &shape.height_field) {
            (Some(_), _, _) => Surface::HalfSpace,
            (None, Some(hull), _) => {
                check_hull(&hull.points, &format!("{pointer}/hull/points"), &file.name, document, diagnostics);
                Surface::Hull(hull.points.clone())
            }
            (None, None, Some(field)) => {
                let pointer = format!("{pointer}/height_field");
                let Some(surface) = height_field::surface(field, &pointer, document, folder, diagnostics) else {
                    continue;
                };
                surface
            }
            (None, None, None) => continue,
        };
        if file.contact.is_none() {
            let at = document.at(&pointer);
            let diagnostic =
                Diagnostic::error(&at, format!("body `{}` has a surface that nothing can touch", file.name));
            diagnostics.push(diagnostic.with_help("give the body a `contact`, such as contact = { friction = 0.5 }"));
        }
        let placement = Placement::new(shape.position, shape.rotation_deg, shape.quaternion_wxyz);
        surfaces.push((surface, placement::pose(&placement, &pointer, document, diagnostics)));
        colors.push(shape.color.as_ref().and_then(|text| body::color_of(text, &pointer, document, diagnostics)));
    }
    let material = file.contact.as_ref().map(|contact| {
        if file.shape.is_empty() {
            let at = document.key_at(&format!("{pointer}/contact"));
            let diagnostic = Diagnostic::error(&at, format!("body `{}` has a contact and no shape", file.name));
            diagnostics.push(diagnostic.with_help("give it the shapes that touch"));
        }
        material(contact, &format!("{pointer}/contact"), document, diagnostics)
    });
    Skin { material, surfaces, colors }
}

fn material(file: &ContactFile, pointer: &str, document: &Document, diagnostics: &mut Diagnostics) -> Material {
    if file.dissipation.is_some() && file.stiffness.is_none_or(f64::is_infinite) {
        let at = document.key_at(&format!("{pointer}/dissipation"));
        let diagnostic = Diagnostic::error(&at, "`dissipation` has no meaning for a rigid contact");
        diagnostics.push(diagnostic.with_help("give `stiffness` [N/m] too, or `restitution` instead"));
    }
    check_restitution(file.restitution, pointer, document, diagnostics);
    Material {
        friction: file.friction,
        restitution: file.restitution,
        rolling_friction: file.rolling_friction,
        spinning_friction: file.spinning_friction,
        stiffness: file.stiffness.unwrap_or(f64::INFINITY),
        dissipation: file.dissipation.unwrap_or(0.0),
        group: file.group,
    }
}

fn check_restitution(restitution: f64, pointer: &str, document: &Document, diagnostics: &mut Diagnostics) {
    if restitution > 1.0 {
        let at = document.at(&format!("{pointer}/restitution"));
        let message = format!("`restitution` is {restitution}, expected 0 to 1");
        diagnostics.push(Diagnostic::error(&at, message).with_help("above 1 an impact would add energy"));
    }
}

/// A hull needs finite points that span a volume.
fn check_hull(points: &[[f64; 3]], pointer: &str, name: &str, document: &Document, diagnostics: &mut Diagnostics) {
    let p: Vec<Vec3<f64>> = points.iter().map(|p| Vec3(*p)).collect();
    let spans = p.len() >= 4 && {
        let far =
            |f: &dyn Fn(Vec3<f64>) -> f64| p.iter().copied().max_by(|a, b| f(*a).total_cmp(&f(*b))).unwrap_or(p[0]);
        let a = far(&|x| (x - p[0]).norm()) - p[0];
        let b = far(&|x| a.cross(x - p[0]).norm()) - p[0];
        let n = a.cross(b);
        let c = far(&|x| n.dot(x - p[0]).abs()) - p[0];
        n.dot(c).abs() > 1e-9 * a.norm() * a.norm() * a.norm()
    };
    if !spans {
        let diagnostic = Diagnostic::error(&document.at(pointer), format!("the hull of body `{name}` has no volume"));
        diagnostics.push(diagnostic.with_help("give four points or more that do not lie in one plane [m]"));
    }
}

/// Lower and upper limits of each coordinate.
pub(super) fn limits(list: &[LimitsFile], pointer: &str, signals: &mut SignalReader<'_>) -> Vec<(f64, f64)> {
    let one = |limits: &LimitsFile| {
        let (lower, upper) = (limits.lower.unwrap_or(f64::NEG_INFINITY), limits.upper.unwrap_or(f64::INFINITY));
        if limits.restitution > 1.0 {
            let at = signals.document.at(&format!("{pointer}/limits"));
            let message = format!("`restitution` of a stop is {}, expected 0 to 1", limits.restitution);
            signals.diagnostics.push(Diagnostic::error(&at, message).with_help("above 1 an impact would add energy"));
        }
        if lower >= upper {
            let at = signals.document.at(&format!("{pointer}/limits"));
            let diagnostic =
                Diagnostic::error(&at, format!("lower limit {lower} is not below the upper limit {upper}"));
            signals.diagnostics.push(diagnostic.with_help("exchange them, or use a fixed joint"));
        }
        (lower, upper)
    };
    list.iter().map(one).collect()
}

/// Finds the objects that closures and couplings name.
pub(super) struct Joiner<'a> {
    pub objects: &'a [Object],
    pub nodes: &'a [NodeId],
    pub document: &'a Document,
    pub diagnostics: &'a mut Diagnostics,
}

impl Joiner<'_> {
    /// The two bodies or frames of `between`, notes what is none.
    pub fn ends(&mut self, between: &[String; 2], pointer: &str) -> Option<[NodeId; 2]> {
        let ends = [0, 1].map(|k| self.end(&between[k], &format!("{pointer}/between/{k}")));
        let [Some(a), Some(b)] = ends else { return None };
        Some([a, b])
    }

    /// The body or frame of a path.
    pub fn end(&mut self, path: &str, pointer: &str) -> Option<NodeId> {
        let fits =
            |kind: &Object| matches!(kind.kind, ObjectKind::Body { .. } | ObjectKind::Frame | ObjectKind::Fixture);
        self.find(path, pointer, fits, "body or frame")
    }

    /// The joint with one degree of freedom of a path.
    pub fn scalar_joint(&mut self, path: &str, pointer: &str) -> Option<NodeId> {
        use sincro_dynamics::joint::JointKind as K;
        let fits = |o: &Object| {
            let ObjectKind::Joint { kind, .. } = o.kind else { return false };
            matches!(kind, K::Revolute { .. } | K::Prismatic { .. } | K::Screw { .. })
        };
        self.find(path, pointer, fits, "joint with one degree of freedom")
    }

    pub fn closure(&mut self, file: &ClosureFile, pointer: &str) -> Option<LoopJointSpec> {
        let ends = self.ends(&file.between, pointer);
        let length = file.length.filter(|_| file.kind == ClosureKindFile::Distance);
        if (file.kind == ClosureKindFile::Distance) != file.length.is_some() {
            let at = self.document.title_at(pointer);
            let message =
                format!("closure `{}`: `length` belongs to the kind `distance`, and is needed there", file.name);
            self.diagnostics.push(Diagnostic::error(&at, message).with_help("give `length` [m] for `distance` only"));
        }
        let axes = self.closure_axes(file, pointer)?;
        let kind = match file.kind {
            ClosureKindFile::Point => LoopJointKind::Point,
            ClosureKindFile::Hinge => LoopJointKind::Hinge,
            ClosureKindFile::Weld => LoopJointKind::Weld,
            ClosureKindFile::Slider => LoopJointKind::Slider,
            ClosureKindFile::Cylindrical => LoopJointKind::Cylindrical,
            ClosureKindFile::Universal => LoopJointKind::Universal,
            ClosureKindFile::Planar => LoopJointKind::Planar,
            ClosureKindFile::Distance => LoopJointKind::Distance(length?),
        };
        let poses = axes.map(|axis| Pose { rot: with_z_along(axis), pos: Vec3::zero() });
        Some(LoopJointSpec { kind, ends: ends?, poses })
    }

    /// Axes of a closure in its two frames; notes keys that its kind has not, and axes without direction.
    fn closure_axes(&mut self, file: &ClosureFile, pointer: &str) -> Option<[Vec3<f64>; 2]> {
        use ClosureKindFile as K;
        let is_universal = file.kind == K::Universal;
        let has_axis = matches!(file.kind, K::Hinge | K::Slider | K::Cylindrical | K::Planar) || is_universal;
        let keys = [
            ("axis", file.axis, has_axis, "`hinge`, `slider`, `cylindrical`, `planar` and `universal`"),
            ("axis2", file.axis2, is_universal, "`universal`"),
        ];
        for (key, _, _, kinds) in keys.iter().filter(|(_, axis, fits, _)| axis.is_some() && !fits) {
            let at = self.document.key_at(&format!("{pointer}/{key}"));
            let message = format!("closure `{}`: `{key}` belongs to {kinds}", file.name);
            self.diagnostics.push(Diagnostic::error(&at, message).with_help("leave it out"));
        }
        let axis = file.axis.unwrap_or([0.0, 0.0, 1.0]);
        let axes = [axis, if is_universal { file.axis2.unwrap_or([1.0, 0.0, 0.0]) } else { axis }].map(Vec3);
        for (axis, key) in axes.iter().zip(["axis", "axis2"]) {
            if axis.norm() < 1e-12 || !axis.norm().is_finite() {
                let at = self.document.at(&format!("{pointer}/{key}"));
                let message = format!("{key} {:?} of closure `{}` has no direction", axis.0, file.name);
                let diagnostic = Diagnostic::error(&at, message);
                self.diagnostics.push(diagnostic.with_help("give three finite numbers, not all zero"));
                return None;
            }
        }
        Some(axes)
    }

    /// The pairs of bodies that a contact law is meant for.
    pub fn contact_pair(&mut self, file: &ContactPairFile, pointer: &str) -> Vec<([NodeId; 2], PairLaw)> {
        if file.dissipation.is_some() && file.stiffness.is_some_and(f64::is_infinite) {
            let at = self.document.key_at(&format!("{pointer}/dissipation"));
            let diagnostic = Diagnostic::error(&at, "`dissipation` has no meaning for a rigid contact");
            self.diagnostics.push(diagnostic.with_help("give a finite `stiffness` [N/m], or `restitution` instead"));
        }
        check_restitution(file.restitution.unwrap_or(0.0), pointer, self.document, self.diagnostics);
        let law = PairLaw {
            is_excluded: !file.touches,
            friction: file.friction,
            restitution: file.restitution,
            rolling_friction: file.rolling_friction,
            spinning_friction: file.spinning_friction,
            stiffness: file.stiffness,
            dissipation: file.dissipation,
        };
        let [a, b] = [0, 1].map(|k| self.touching(&file.between[k], &format!("{pointer}/between/{k}")));
        let pairs = a.iter().flat_map(|a| b.iter().map(move |b| [*a, *b])).filter(|[a, b]| a != b);
        pairs.map(|bodies| (bodies, law)).collect()
    }

    /// Bodies with a contact whose paths fit a pattern.
    fn touching(&mut self, pattern: &str, pointer: &str) -> Vec<NodeId> {
        let touches = |o: &Object| o.contact.is_some();
        if !pattern.contains('*') {
            return self.find(pattern, pointer, touches, "body with a `contact`").into_iter().collect();
        }
        let fitting = self.objects.iter().zip(self.nodes).filter(|(o, _)| touches(o) && fits(pattern, &o.path));
        let found: Vec<NodeId> = fitting.map(|(_, node)| *node).collect();
        if found.is_empty() {
            let message = format!("no body with a `contact` has a path of the form `{pattern}`");
            let diagnostic = Diagnostic::error(&self.document.at(pointer), message);
            self.diagnostics.push(diagnostic.with_help("`*` stands for characters within a name, `**` for any at all"));
        }
        found
    }

    pub fn coupling(&mut self, file: &CouplingFile, pointer: &str) -> Option<GearSpec> {
        let joints = [0, 1].map(|k| self.scalar_joint(&file.joints[k], &format!("{pointer}/joints/{k}")));
        if file.joints[0] == file.joints[1] {
            let at = self.document.at(&format!("{pointer}/joints"));
            let diagnostic = Diagnostic::error(&at, format!("coupling `{}` is of a joint with itself", file.name));
            self.diagnostics.push(diagnostic.with_help("give two joints"));
            return None;
        }
        for key in ["damping", "backlash"].into_iter().filter(|_| file.stiffness.is_none()) {
            let pointer = format!("{pointer}/{key}");
            if self.document.get(&pointer).is_some() {
                let message = format!("`{key}` has no meaning for the rigid coupling `{}`", file.name);
                let diagnostic = Diagnostic::error(&self.document.key_at(&pointer), message);
                self.diagnostics.push(diagnostic.with_help("give `stiffness` of its teeth too, or leave it out"));
            }
        }
        if file.stiffness.is_some() && file.ratio == 0.0 {
            let at = self.document.at(&format!("{pointer}/ratio"));
            let diagnostic = Diagnostic::error(&at, format!("the ratio of coupling `{}` is 0", file.name));
            self.diagnostics.push(diagnostic.with_help("give the rate of the second joint over that of the first"));
        }
        let given = file.polynomial.as_deref().unwrap_or_default();
        if file.stiffness.is_some() && file.polynomial.is_some() {
            let at = self.document.key_at(&format!("{pointer}/polynomial"));
            let message = format!("`polynomial` has no meaning for the elastic coupling `{}`", file.name);
            self.diagnostics.push(Diagnostic::error(&at, message).with_help("leave it out, or `stiffness`"));
        }
        let [Some(a), Some(b)] = joints else { return None };
        let higher = std::array::from_fn(|k| given.get(k).copied().unwrap_or(0.0));
        Some(GearSpec { joints: [a, b], ratio: file.ratio, offset: file.offset, higher })
    }

    fn find(&mut self, path: &str, pointer: &str, fits: impl Fn(&Object) -> bool, what: &str) -> Option<NodeId> {
        if path == "/" && what.starts_with("body") {
            return Some(NodeId::WORLD);
        }
        let found = self.objects.iter().position(|o| o.path == path);
        if let Some(k) = found.filter(|k| fits(&self.objects[*k])) {
            return Some(self.nodes[k]);
        }
        let at = self.document.at(pointer);
        let known: Vec<&str> = self.objects.iter().filter(|o| fits(o)).map(|o| o.path.as_str()).collect();
        let diagnostic = match found {
            Some(k) => Diagnostic::error(&at, format!("`{path}` is a {}, not a {what}", self.objects[k].kind.word())),
            None => Diagnostic::error(&at, format!("there is no object `{path}`")),
        };
        self.diagnostics.push(diagnostic.with_help(suggest::help(path, &known, "objects")));
        None
    }
}

/// A rotation whose z axis is along `n`.
fn with_z_along(n: Vec3<f64>) -> Mat3<f64> {
    let z = n.scale(1.0 / n.norm());
    if z.0 == [0.0, 0.0, 1.0] {
        return Mat3::identity();
    }
    let k = (1..3).fold(0, |best, k| if z[k].abs() < z[best].abs() { k } else { best });
    let e = Vec3::along(k, 1.0);
    let x = e - z.scale(z[k]);
    let x = x.scale(1.0 / x.norm());
    Mat3([x.0, z.cross(x).0, z.0]).transpose()
}

/// Warns of surfaces that can touch nothing: all are in the same group, or no other body has a contact, where a body
/// moves freely and would fall through. A floor under a machine that is held by joints is scenery.
pub(super) fn warn_of_idle(file: &SceneFile, document: &Document, diagnostics: &mut Diagnostics) {
    let group = |k: usize| file.body[k].contact.as_ref().map(|contact| contact.group);
    let touching: Vec<usize> =
        (0..file.body.len()).filter(|k| group(*k).is_some() && !file.body[*k].shape.is_empty()).collect();
    // seldom are there many groups: the bodies of each are counted
    let mut counts = std::collections::BTreeMap::new();
    for k in &touching {
        *counts.entry(group(*k)).or_insert(0_usize) += 1;
    }
    let moves_freely = file.joint.iter().any(|joint| joint.kind == JointKindFile::Free);
    for k in touching.iter().copied().filter(|_| touching.len() > 1 || moves_freely) {
        let is_own_group = group(k) != Some(0);
        let excluded = if is_own_group { counts[&group(k)] } else { 1 };
        if touching.len() > excluded {
            continue;
        }
        let pointer = format!("/body/{k}/contact");
        let name = &file.body[k].name;
        let (at, message, help) = if touching.len() == 1 {
            let message = format!("`{name}` can touch nothing: no other body has a `contact`");
            (document.key_at(&pointer), message, "give the others a `contact` too; shapes without one only show")
        } else {
            let message = format!("`{name}` can touch nothing: all bodies with a `contact` are in its group");
            (
                document.at(&format!("{pointer}/group")),
                message,
                "bodies of one group (other than 0) do not touch each other",
            )
        };
        diagnostics.push(Diagnostic::error(&at, message).as_warning().with_help(help));
    }
}

/// Warns of surfaces among others that can touch none of them, for another reason than [`warn_of_idle`] finds: all
/// others are fixed to them, or joined to them directly, or excluded by a `[[contact_pair]]`.
pub(super) fn warn_of_excluded(
    model: &Model<f64>,
    file: &SceneFile,
    document: &Document,
    diagnostics: &mut Diagnostics,
) {
    let set = model.constraints();
    let is_fixed = |k: usize| set.colliders[k].link == WORLD;
    let touches = |k: usize| set.pairs.iter().any(|pair| !pair.is_ignored && (pair.a == k || pair.b == k));
    // a heap of scenery touches nothing, and nobody expects it to
    if set.colliders.len() < 2 || (0..set.colliders.len()).all(is_fixed) {
        return;
    }
    for (k, body) in file.body.iter().enumerate().filter(|(_, body)| body.contact.is_some()) {
        let path = tree::join(&body.parent, &body.name);
        let mut own = (0..set.colliders.len()).filter(|k| set.colliders[*k].name == path).peekable();
        let is_known = diagnostics
            .0
            .iter()
            .any(|found| found.message.starts_with(&format!("`{}` can touch nothing", body.name)) && !found.is_error());
        if own.peek().is_none() || is_known || own.any(touches) {
            continue;
        }
        let at = document.key_at(&format!("/body/{k}/contact"));
        let message = format!("`{}` can touch nothing of what has a `contact`", body.name);
        let help = "bodies do not touch what they are fixed to or joined to directly, those of their group, and those \
                    that a `[[contact_pair]]` lets them pass through; two fixed bodies do not touch either";
        diagnostics.push(Diagnostic::error(&at, message).as_warning().with_help(help));
    }
}
