//! The objects of a scene as plain data: what stands where, how it moves, what it looks like.
//!
//! Poses are seven numbers: position `[m]`, then the quaternion x, y, z, w, as pictures want it. An object is carried
//! by a *mover*: the link of the joint of that index in the model, whose pose is in the frames; what is fixed in the
//! world has none.

use serde::Serialize;
use sincro_dynamics::aero::rotor::{RotorLaw, Spin};
use sincro_dynamics::constraint::{Anchor, LoopJointKind};
use sincro_dynamics::contact::Surface;
use sincro_dynamics::joint::JointKind;
use sincro_dynamics::kinematics;
use sincro_dynamics::model::{Model, Shape};
use sincro_dynamics::scratch::Scratch;
use sincro_dynamics::spatial::{Pose, Quat, Vec3};
use sincro_dynamics::state::State;

use super::surface::{self, Triangles};
use super::trajectory::Layout;
use super::volume::{self, Edge};
use sincro_scene::scene::{Object, ObjectKind, Scene, ShownSurface};
use sincro_scene::sensor::{SensorKind, SensorSpec};

/// Visible scene for replay and pictures: objects, shapes, and the layout of the trajectory's frames. Frames hold in
/// turn: movers (7 numbers each), rotors, external forces, drag elements and winds (3 each), coordinates, velocities;
/// see [`Layout`](super::Layout).
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct SceneView {
    /// Objects of the scene, parents before children.
    pub objects: Vec<ObjectView>,
    /// Number of movers, whose poses a frame has: one for each joint of the model, its last link.
    pub n_movers: usize,
    /// Number of rotors in a frame.
    pub n_rotors: usize,
    /// Number of external forces in a frame.
    pub n_forces: usize,
    /// Number of drag elements in a frame.
    pub n_drags: usize,
    /// Indices of the movers at which frames have the wind; empty where the air stands still.
    pub winds: Vec<usize>,
    /// Object index of each contact surface, by the surface index of contact points; `None` for the world's own.
    pub surfaces: Vec<Option<usize>>,
    /// Number of generalized coordinates.
    pub n_q: usize,
    /// Number of generalized velocities.
    pub n_v: usize,
    /// Gravitational acceleration in world axes `[m/s²]`.
    pub gravity: [f64; 3],
}

/// Object of the scene as it is drawn: joint, body, frame, force, rotor, drag element, sensor, camera, closure,
/// spring-damper, tendon or coupling.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ObjectView {
    /// Path of the object, such as `/arm/link`.
    pub path: String,
    /// Name, the last part of the path.
    pub name: String,
    /// Kind in English, such as `revolute joint`, `body`, `rotor`.
    pub kind: String,
    /// Index of its parent among the objects; `None` for children of the world.
    pub parent: Option<usize>,
    /// Index of the mover that carries it; `None` if it is fixed in the world. For a joint, its moving side.
    pub mover: Option<usize>,
    /// Pose of its frame in that of its mover, or in the world: position x, y, z `[m]`, quaternion x, y, z, w.
    pub pose: [f64; 7],
    /// Visible shapes.
    pub shapes: Vec<ShapeView>,
    /// Mass properties of a body: mass `[kg]`, centre of mass in its frame `[m]`, inertia about that centre in its axes
    /// (xx, xy, xz, yy, yz, zz) `[kg·m²]`; `None` for all else.
    pub mass: Option<(f64, [f64; 3], [f64; 6])>,
    /// Motion of a joint; `None` for all else.
    pub joint: Option<JointView>,
    /// Data of a rotor; `None` for all else.
    pub rotor: Option<RotorView>,
    /// Index among the external forces of a frame, of a force that acts on something that moves.
    pub force: Option<usize>,
    /// Index among the drag elements of a frame, of a drag element.
    pub drag: Option<usize>,
    /// Edges of the volume of a proximity sensor, in its frame `[m]`; empty for all else.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub volume: Vec<Edge>,
    /// Data of a camera; `None` for all else.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub camera: Option<CameraView>,
    /// Other end of a loop joint: index of its mover (`None`: the world), and pose there as in `pose`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub other_end: Option<(Option<usize>, [f64; 7])>,
    /// Points of a spring-damper or spatial tendon in their order: index of a mover (`None`: the world), and position
    /// in its frame `[m]`; empty for all else.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub line: Vec<(Option<usize>, [f64; 3])>,
}

/// Camera of the scene as it is drawn; it looks along z of its frame, y is up in the image.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct CameraView {
    /// Angle between the upper and the lower edge of its image `[deg]`.
    pub field_of_view_deg: f64,
}

/// Visible solid or surface of an object.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ShapeView {
    /// Kind: `cuboid`, `sphere`, `cylinder`, `capsule` or `cone`; `plane` for the half space z < 0, `mesh` for
    /// triangles.
    pub kind: &'static str,
    /// Dimensions `[m]`: edge lengths x, y, z of a cuboid; radius and length (along z) of the others, the length of a
    /// sphere being 0; empty for planes and meshes.
    pub size: Vec<f64>,
    /// Corners of a mesh, x, y, z in the shape's frame `[m]`.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub vertices: Vec<[f32; 3]>,
    /// Indices of the corners of each triangle of a mesh, counter-clockwise seen from outside.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub triangles: Vec<[u32; 3]>,
    /// Pose of the shape's frame in that of its object: position x, y, z `[m]`, quaternion x, y, z, w.
    pub pose: [f64; 7],
    /// Colour as `#rrggbb`; `None`: chosen by the viewer.
    pub color: Option<String>,
}

/// Motion of a joint as it is drawn: its frame on the fixed side, axes, coordinates.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct JointView {
    /// Index of the mover on its fixed side; `None` for the world.
    pub base_mover: Option<usize>,
    /// Pose of the joint's frame on the fixed side in the frame of that mover: position x, y, z `[m]`, quaternion x, y,
    /// z, w.
    pub base_pose: [f64; 7],
    /// Unit vectors of its axes in the joint's frame: none for fixed, ball and free joints, two for universal ones.
    pub axes: Vec<[f64; 3]>,
    /// Index of its first coordinate in q.
    pub q_idx: usize,
    /// Number of its coordinates.
    pub n_q: usize,
    /// Index of its first degree of freedom in v.
    pub v_idx: usize,
    /// Number of its degrees of freedom.
    pub n_v: usize,
    /// Springs: index of the degree of freedom within the joint (from 0), stiffness `[N·m/rad]` or `[N/m]`, rest
    /// position `[rad]` or `[m]`.
    pub springs: Vec<(usize, f64, f64)>,
    /// True if the joint has a motor.
    pub motor: bool,
}

/// Rotor as it is drawn; thrust is along z of its frame.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct RotorView {
    /// Index among the rotors of a frame.
    pub index: usize,
    /// Radius of the disc `[m]`, if the rotor's law has one.
    pub radius: Option<f64>,
    /// True if it turns counter-clockwise, seen from above (with the thrust towards the viewer).
    pub is_ccw: bool,
}

impl SceneView {
    /// Creates the view of a compiled scene, for its replay; poses relative to movers do not depend on the state.
    #[must_use]
    pub fn new(scene: &Scene) -> Self {
        let model = &*scene.model;
        let mut scratch = Scratch::new(model);
        kinematics::poses(model, &State::new(model).q, &mut scratch);
        let mut maker = Maker {
            model,
            links: Layout::new(model).links().to_vec(),
            scratch,
            placed: Vec::new(),
            n_forces: 0,
            sensors: &scene.sensors,
            has_visuals: scene.objects.iter().any(|o| !o.visuals.is_empty()),
        };
        let mut objects: Vec<ObjectView> = scene.objects.iter().map(|object| maker.object(object)).collect();
        let place = |path: &str| scene.objects.iter().position(|o| o.path == path);
        maker.closures(&mut objects);
        Self {
            objects,
            n_movers: maker.links.len(),
            n_rotors: model.rotors().len(),
            n_forces: maker.n_forces,
            n_drags: model.drags().len(),
            winds: Layout::new(model).wind_links().to_vec(),
            surfaces: model.constraints().colliders.iter().map(|c| place(&c.name)).collect(),
            n_q: model.n_q(),
            n_v: model.n_v(),
            gravity: model.gravity().0,
        }
    }

    /// Returns the index, in a frame of the trajectory, of the three numbers of rotor `k` (from 0): speed `[rad/s]`,
    /// thrust `[N]`, torque `[N·m]`.
    #[must_use]
    pub fn rotor_at(&self, k: usize) -> usize {
        7 * self.n_movers + 3 * k
    }

    /// Returns the index, in a frame of the trajectory, of the first of three components of external force `k` (from
    /// 0), in world axes `[N]`.
    #[must_use]
    pub fn force_at(&self, k: usize) -> usize {
        self.rotor_at(self.n_rotors + k)
    }

    /// Returns the index, in a frame of the trajectory, of the first of three components of the force of drag element
    /// `k` (from 0), in world axes `[N]`.
    #[must_use]
    pub fn drag_at(&self, k: usize) -> usize {
        self.force_at(self.n_forces + k)
    }

    /// Returns the index, in a frame of the trajectory, of the first of three components of the wind at mover
    /// `winds[k]`, in world axes `[m/s]`.
    #[must_use]
    pub fn wind_at(&self, k: usize) -> usize {
        self.drag_at(self.n_drags + k)
    }
}

/// Finds what each object rides on, parents first.
struct Maker<'a> {
    model: &'a Model<f64>,
    /// Link of each mover.
    links: Vec<usize>,
    /// Link poses at zero coordinates.
    scratch: Scratch<f64>,
    /// Link index of each object so far, and its pose in the world at zero coordinates.
    placed: Vec<(Option<usize>, Pose<f64>)>,
    /// External forces so far; those on what is fixed in the world are not in the model.
    n_forces: usize,
    sensors: &'a [SensorSpec],
    /// True if the scene says what shows: bodies without geometry then show nothing, not the box of their inertia.
    has_visuals: bool,
}

impl Maker<'_> {
    fn object(&mut self, object: &Object) -> ObjectView {
        let (base_mover, x_wp) = object.parent.map_or((None, Pose::identity()), |k| self.placed[k]);
        let x_wo = x_wp.compose(&object.pose);
        let joint = self.model.names().joints.iter().position(|j| j.name == object.path);
        let mover = joint.or(base_mover);
        self.placed.push((mover, x_wo));
        let force = (matches!(object.kind, ObjectKind::Force) && mover.is_some()).then_some(self.n_forces);
        self.n_forces += usize::from(force.is_some());
        let shapes: Vec<ShapeView> = object.shown().map(|shown| shown_view(&shown)).collect();
        let hidden = self.has_visuals && shapes.is_empty();
        ObjectView {
            path: object.path.clone(),
            name: object.name.clone(),
            kind: object.kind.word().to_owned(),
            parent: object.parent,
            mover,
            pose: self.on(mover, &x_wo),
            shapes,
            mass: match &object.kind {
                ObjectKind::Body { mass } if !hidden => Some((mass.mass, mass.center_of_mass, mass.inertia)),
                _ => None,
            },
            joint: joint.map(|k| self.joint(k, base_mover, &x_wo)),
            rotor: self.rotor(object),
            force,
            drag: self.model.names().drags.iter().position(|name| *name == object.path),
            volume: self.volume(object),
            camera: match object.kind {
                ObjectKind::Camera { field_of_view_deg, .. } => Some(CameraView { field_of_view_deg }),
                _ => None,
            },
            other_end: None,
            line: Vec::new(),
        }
    }

    /// Closures, springs between points and couplings, which stand beside the tree, as objects after it.
    fn closures(&self, objects: &mut Vec<ObjectView>) {
        let (set, n) = (self.model.constraints(), objects.len());
        let of_anchor = |anchor: &Anchor, objects: &[ObjectView]| {
            let mover = objects[..n].iter().find(|o| o.path == anchor.name).and_then(|o| o.mover);
            (mover, seven(&anchor.pose))
        };
        for closure in &set.loop_joints {
            let kind = match closure.kind {
                LoopJointKind::Point => "point closure",
                LoopJointKind::Hinge => "hinge closure",
                LoopJointKind::Weld => "weld closure",
                LoopJointKind::Slider => "slider closure",
                LoopJointKind::Cylindrical => "cylindrical closure",
                LoopJointKind::Universal => "universal closure",
                LoopJointKind::Planar => "planar closure",
                LoopJointKind::Distance(_) => "distance closure",
            };
            let (mover, pose) = of_anchor(&closure.a, objects);
            let other_end = Some(of_anchor(&closure.b, objects));
            objects.push(ObjectView { mover, pose, other_end, ..beside(&closure.name, kind) });
        }
        for (element, name) in self.model.spring_dampers().iter().zip(&self.model.names().spring_dampers) {
            let first = element.segments().first().map(|segment| segment.ends[0]);
            let points = first.into_iter().chain(element.segments().iter().map(|segment| segment.ends[1]));
            let line: Vec<_> = points
                .map(|end| {
                    let mover = end.link.and_then(|link| self.links.iter().position(|l| *l == link));
                    (mover, end.position.0)
                })
                .collect();
            let (mover, position) = line.first().copied().unwrap_or((None, [0.0; 3]));
            let pose = seven(&Pose::translation(Vec3(position)));
            let kind = if line.len() == 2 { "spring_damper" } else { "tendon" };
            objects.push(ObjectView { mover, pose, line, ..beside(name, kind) });
        }
        for (element, name) in self.model.bushings().iter().zip(&self.model.names().bushings) {
            let [(mover, pose), other_end] = element.ends.map(|end| {
                let mover = end.link.and_then(|link| self.links.iter().position(|l| *l == link));
                (mover, seven(&end.pose))
            });
            objects.push(ObjectView { mover, pose, other_end: Some(other_end), ..beside(name, "bushing") });
        }
        objects.extend(set.gears.iter().map(|coupling| beside(&coupling.name, "coupling")));
    }

    /// A pose in the world at zero coordinates as one in the frame of a mover.
    fn on(&self, mover: Option<usize>, x_wo: &Pose<f64>) -> [f64; 7] {
        match mover {
            Some(k) => seven(&self.scratch.link_poses()[self.links[k]].inverse().compose(x_wo)),
            None => seven(x_wo),
        }
    }

    fn joint(&self, k: usize, base_mover: Option<usize>, x_wo: &Pose<f64>) -> JointView {
        let info = &self.model.names().joints[k];
        let dofs = self.model.dofs()[info.v_idx..info.v_idx + info.n_v].iter().enumerate();
        let has_law = |i: usize| self.model.nonlinear_springs().iter().any(|spring| spring.dof == info.v_idx + i);
        JointView {
            base_mover,
            base_pose: self.on(base_mover, x_wo),
            axes: axes(&info.kind),
            q_idx: info.q_idx,
            n_q: info.n_q,
            v_idx: info.v_idx,
            n_v: info.n_v,
            springs: dofs
                .filter(|(i, d)| d.stiffness > 0.0 || has_law(*i))
                .map(|(i, d)| (i, d.stiffness, d.rest))
                .collect(),
            motor: info.motor.is_some(),
        }
    }

    fn volume(&self, object: &Object) -> Vec<Edge> {
        let spec = self.sensors.iter().find(|sensor| sensor.path == object.path);
        match spec.map(|sensor| sensor.kind) {
            Some(SensorKind::Proximity { volume, offset, range, .. }) => volume::edges(volume, offset, range),
            _ => Vec::new(),
        }
    }

    fn rotor(&self, object: &Object) -> Option<RotorView> {
        let index = self.model.names().rotors.iter().position(|name| *name == object.path)?;
        let (radius, spin) = match &self.model.rotors()[index].law {
            RotorLaw::Blade(rotor) => (Some(rotor.spec().radius), rotor.spec().spin),
            law => (None, law.spin().unwrap_or(Spin::CounterClockwise)),
        };
        Some(RotorView { index, radius, is_ccw: spin == Spin::CounterClockwise })
    }
}

/// An object that stands beside the tree, at the world's origin.
fn beside(path: &str, kind: &str) -> ObjectView {
    ObjectView {
        path: path.to_owned(),
        name: path.trim_start_matches('/').to_owned(),
        kind: kind.to_owned(),
        parent: None,
        mover: None,
        pose: seven(&Pose::identity()),
        shapes: Vec::new(),
        mass: None,
        joint: None,
        rotor: None,
        force: None,
        drag: None,
        volume: Vec::new(),
        camera: None,
        other_end: None,
        line: Vec::new(),
    }
}

fn axes(kind: &JointKind) -> Vec<[f64; 3]> {
    match *kind {
        JointKind::Revolute { axis } | JointKind::Prismatic { axis } | JointKind::Screw { axis, .. } => vec![axis],
        JointKind::Universal { axis, axis2 } => vec![axis, axis2],
        JointKind::Planar => vec![[0.0, 0.0, 1.0]],
        JointKind::Fixed | JointKind::Ball | JointKind::Free => Vec::new(),
    }
}

fn shown_view(shown: &ShownSurface) -> ShapeView {
    shape_view(&shown.surface, &shown.pose, shown.color)
}

/// A surface with its pose in its object and its colour.
pub(super) fn shape_view(surface: &Surface, pose: &Pose<f64>, color: Option<[u8; 3]>) -> ShapeView {
    let view = match surface {
        Surface::Solid(shape) => solid_view(*shape),
        Surface::HalfSpace => made_of("plane", Triangles::default()),
        Surface::Hull(points) => made_of("mesh", surface::of_hull(points)),
        Surface::Mesh(points, triangles) => made_of("mesh", surface::of_mesh(points, triangles)),
        Surface::HeightField { columns, heights, size } => {
            made_of("mesh", surface::of_heights(*columns, heights, *size))
        }
    };
    ShapeView { pose: seven(pose), color: color.map(hex), ..view }
}

fn solid_view(shape: Shape) -> ShapeView {
    let (kind, size) = match shape {
        // drawn by its triangles, as what every viewer knows
        Shape::Torus { major_radius, tube_radius } => {
            return made_of("mesh", surface::of_torus(major_radius, tube_radius));
        }
        Shape::Cuboid { size } => ("cuboid", size.to_vec()),
        Shape::Sphere { radius } => ("sphere", vec![radius, 0.0]),
        Shape::Cylinder { radius, length } => ("cylinder", vec![radius, length]),
        Shape::Capsule { radius, length } => ("capsule", vec![radius, length]),
        Shape::Cone { radius, length } => ("cone", vec![radius, length]),
    };
    ShapeView { size, ..made_of(kind, Triangles::default()) }
}

fn made_of(kind: &'static str, (vertices, triangles): Triangles) -> ShapeView {
    ShapeView { kind, size: Vec::new(), vertices, triangles, pose: seven(&Pose::identity()), color: None }
}

/// A colour as `#rrggbb`.
pub(super) fn hex([r, g, b]: [u8; 3]) -> String {
    format!("#{r:02x}{g:02x}{b:02x}")
}

/// Position and quaternion x, y, z, w.
pub(super) fn seven(pose: &Pose<f64>) -> [f64; 7] {
    let mut wxyz = [0.0; 4];
    Quat::from_matrix(&pose.rot).write(&mut wxyz);
    let [w, x, y, z] = wxyz;
    [pose.pos[0], pose.pos[1], pose.pos[2], x, y, z, w]
}
