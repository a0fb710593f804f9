//! The intermediate description of a robot: every reader fills it, one writer turns it into a scene.
//!
//! Links and joints form a tree by indices; each thing has its place in the source. Lengths are in metres, angles in
//! radians, the axes of a link are those of its joint's frame unless `pose` says otherwise.

use sincro_dynamics::spatial::{Mat3, Pose, Quat, Vec3};
use sincro_math::elementary::sin_cos;
use sincro_scene::diagnostic::Location;

use crate::Options;

/// A rotation as the source gives it, so that round figures stay round.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Rotation {
    /// Roll, pitch and yaw: R = Rz(yaw)·Ry(pitch)·Rx(roll) `[rad]`.
    RollPitchYaw([f64; 3]),
    /// A unit quaternion (w, x, y, z).
    Quaternion([f64; 4]),
}

/// Position and rotation in a parent frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Placement {
    /// Origin `[m]`.
    pub position: [f64; 3],
    /// Axes.
    pub rotation: Rotation,
}

impl Default for Placement {
    fn default() -> Self {
        Self { position: [0.0; 3], rotation: Rotation::RollPitchYaw([0.0; 3]) }
    }
}

impl Placement {
    /// From roll, pitch and yaw `[rad]`.
    pub fn new(position: [f64; 3], rpy: [f64; 3]) -> Self {
        Self { position, rotation: Rotation::RollPitchYaw(rpy) }
    }

    /// From a pose: as angles if they are round, else as a quaternion.
    pub fn of_pose(pose: &Pose<f64>) -> Self {
        let rpy = sincro_dynamics::kinematics::roll_pitch_yaw(&pose.rot).0;
        let snapped = rpy.map(|a| {
            let degrees = (a.to_degrees() * 1e6).round() / 1e6;
            if (degrees.to_radians() - a).abs() < 4e-16 { degrees.to_radians() + 0.0 } else { a }
        });
        let again = rotation_matrix(snapped);
        let error =
            (0..3).flat_map(|i| (0..3).map(move |j| (i, j))).map(|(i, j)| (again.0[i][j] - pose.rot.0[i][j]).abs());
        if error.fold(0.0, f64::max) < 1e-15 {
            return Self::new(pose.pos.0, snapped);
        }
        let mut wxyz = [0.0; 4];
        Quat::from_matrix(&pose.rot).write(&mut wxyz);
        Self { position: pose.pos.0, rotation: Rotation::Quaternion(wxyz) }
    }

    /// Roll, pitch and yaw `[°]` where each has six decimals at most.
    pub fn round_angles(&self) -> Option<[f64; 3]> {
        let Rotation::RollPitchYaw(rpy) = Self::of_pose(&self.pose()).rotation else { return None };
        let degrees = rpy.map(crate::number::degrees);
        degrees.iter().all(|a| (a * 1e6).round() / 1e6 == *a).then_some(degrees)
    }

    /// Placement whose rotation a scene reads as exactly that of `pose`, angles or a quaternion; the nearest, with
    /// false, if none of those within two units in the last place does.
    pub fn exactly(pose: &Pose<f64>) -> (Self, bool) {
        let own = Self::of_pose(pose);
        let mut wxyz = [0.0; 4];
        Quat::from_matrix(&pose.rot).write(&mut wxyz);
        let moved = |x: f64, ulps: i64| if x == 0.0 { x } else { f64::from_bits((x.to_bits() as i64 + ulps) as u64) };
        let nearby = (0..625_i64).map(|k| {
            let steps = [k % 5, k / 5 % 5, k / 25 % 5, k / 125].map(|n| (n + 1) / 2 * if n % 2 == 0 { -1 } else { 1 });
            let rotation = Rotation::Quaternion(std::array::from_fn(|c| moved(wxyz[c], steps[c])));
            Self { position: pose.pos.0, rotation }
        });
        let found = std::iter::once(own).chain(nearby).find(|placement| placement.rotation_in_scene() == pose.rot);
        found.map_or((own, false), |placement| (placement, true))
    }

    /// Rotation that a scene reads from this one as it is written: round angles, or a quaternion.
    fn rotation_in_scene(&self) -> Mat3<f64> {
        match (self.rotation, self.round_angles()) {
            (Rotation::Quaternion(q), None) => {
                let largest = q.iter().fold(0.0_f64, |a, x| a.max(x.abs()));
                Quat::from_slice(&q.map(|x| x / largest)).normalized().matrix()
            }
            (Rotation::Quaternion(_), Some(degrees)) => rotation_matrix(degrees.map(f64::to_radians)),
            // degrees with as few digits as give the same angles to rounding
            (Rotation::RollPitchYaw(rpy), _) => rotation_matrix(rpy.map(|a| crate::number::degrees(a).to_radians())),
        }
    }

    /// As a pose.
    pub fn pose(&self) -> Pose<f64> {
        let rot = match self.rotation {
            Rotation::RollPitchYaw(rpy) => rotation_matrix(rpy),
            Rotation::Quaternion(q) => Quat::from_slice(&q).normalized().matrix(),
        };
        Pose { rot, pos: Vec3(self.position) }
    }

    /// True for no displacement and no rotation.
    pub fn is_identity(&self) -> bool {
        let turned = match self.rotation {
            Rotation::RollPitchYaw(rpy) => rpy != [0.0; 3],
            Rotation::Quaternion(q) => q[1..] != [0.0; 3],
        };
        self.position == [0.0; 3] && !turned
    }

    /// This placement followed by another in its frame; what is not turned keeps its figures, and positions that cancel
    /// each other but for rounding are 0.
    pub fn then(&self, next: &Self) -> Self {
        if self.is_identity() {
            return *next;
        }
        if next.is_identity() {
            return *self;
        }
        let mut sum = if self.rotation == Rotation::RollPitchYaw([0.0; 3]) {
            let position = std::array::from_fn(|k| self.position[k] + next.position[k]);
            Self { position, rotation: next.rotation }
        } else {
            Self::of_pose(&self.pose().compose(&next.pose()))
        };
        let largest = self.position.iter().chain(&next.position).fold(0.0_f64, |largest, x| largest.max(x.abs()));
        for x in sum.position.iter_mut().filter(|x| x.abs() < 4.0 * f64::EPSILON * largest) {
            *x = 0.0;
        }
        sum
    }
}

/// Rz(yaw)·Ry(pitch)·Rx(roll) of angles `[rad]`.
pub(crate) fn rotation_matrix([roll, pitch, yaw]: [f64; 3]) -> Mat3<f64> {
    let ((sx, cx), (sy, cy), (sz, cz)) = (exact(roll), exact(pitch), exact(yaw));
    Mat3::rotation::<2>(sz, cz).mul(&Mat3::rotation::<1>(sy, cy)).mul(&Mat3::rotation::<0>(sx, cx))
}

/// Sine and cosine, exact for right angles.
fn exact(angle: f64) -> (f64, f64) {
    use std::f64::consts::{FRAC_PI_2, PI};
    match angle {
        0.0 => (0.0, 1.0),
        FRAC_PI_2 => (1.0, 0.0),
        PI => (0.0, -1.0),
        a if a == -FRAC_PI_2 => (-1.0, 0.0),
        a if a == -PI => (0.0, -1.0),
        a => sin_cos(a),
    }
}

/// A robot.
#[derive(Clone, Debug, Default)]
pub(crate) struct Robot {
    /// Its name in the source.
    pub name: String,
    /// [m/s²], if the source says.
    pub gravity: Option<[f64; 3]>,
    /// Bodies and frames.
    pub links: Vec<Link>,
    /// Joints: each link is the child of one at most.
    pub joints: Vec<Joint>,
    /// Loop joints.
    pub loops: Vec<Loop>,
    /// Pairs of joints that move together.
    pub gears: Vec<Gear>,
    /// Springs, dampers, stops and actuators along paths.
    pub tendons: Vec<Tendon>,
    /// Forces on frames that a controller commands.
    pub forces: Vec<CommandedForce>,
    /// Motors.
    pub motors: Vec<Motor>,
    /// Sensors.
    pub sensors: Vec<Sensor>,
    /// Named positions of all joints.
    pub keyframes: Vec<Keyframe>,
    /// True if the source says how its joints are driven; else the importer chooses.
    pub has_own_motors: bool,
    /// Pairs of links that do not touch each other.
    pub excluded: Vec<[usize; 2]>,
    /// True if the bodies of the robot touch each other too.
    pub self_contact: bool,
    /// True if bodies may overlap at the start, as the source's simulator lets them.
    pub may_overlap: bool,
}

/// A rigid body, or a frame if it has no mass.
#[derive(Clone, Debug)]
pub(crate) struct Link {
    /// Name in the source.
    pub name: String,
    /// Place in the source.
    pub at: Location,
    /// Frame of the link in that of its joint, or in the world for a root.
    pub pose: Placement,
    /// Mass properties.
    pub inertial: Option<Inertial>,
    /// Geometry that shows.
    pub visuals: Vec<Geometry>,
    /// Geometry that touches.
    pub collisions: Vec<Geometry>,
    /// Only there between two joints of one body: it has no name in the source.
    pub is_virtual: bool,
    /// Contact group in the scene, if the source says: bodies of one group other than 0 do not touch each other.
    pub group: Option<usize>,
}

/// Mass properties in the link's frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Inertial {
    /// `[kg]`
    pub mass: f64,
    /// `[m]`
    pub center_of_mass: [f64; 3],
    /// About the centre of mass, link axes: xx, xy, xz, yy, yz, zz [kg·m²].
    pub inertia: [f64; 6],
}

/// A solid or a mesh of a link.
#[derive(Clone, Debug)]
pub(crate) struct Geometry {
    /// Place in the source.
    pub at: Location,
    /// Element in the ledger's documents.
    pub element: (usize, u32),
    /// In the link's frame.
    pub pose: Placement,
    /// Its kind.
    pub shape: Shape,
    /// Red, green, blue.
    pub color: Option<[u8; 3]>,
    /// Contact properties, if the source gives them.
    pub surface: Option<SurfaceLaw>,
}

/// Contact properties of a geometry.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct SurfaceLaw {
    /// Coulomb's coefficient.
    pub friction: f64,
    /// Lever arm of the friction torque about the normal `[m]`.
    pub spinning_friction: f64,
    /// Lever arm of rolling resistance `[m]`.
    pub rolling_friction: f64,
}

/// Kinds of geometry.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Shape {
    /// Full lengths of a box `[m]`.
    Cuboid([f64; 3]),
    /// Radius `[m]`.
    Sphere(f64),
    /// Radius and length along z `[m]`.
    Cylinder(f64, f64),
    /// Radius and length of the cylinder alone `[m]`.
    Capsule(f64, f64),
    /// Semi-axes `[m]`.
    Ellipsoid([f64; 3]),
    /// Half-space below z = 0.
    Plane,
    /// Heights over a grid centred on its frame, rows along x from the least y on `[m]`, and its extent along x and y
    /// `[m]`.
    HeightField {
        /// Name in the source.
        name: String,
        /// Rows of heights.
        rows: std::sync::Arc<Vec<Vec<f64>>>,
        /// Distance from the first height to the last.
        size: [f64; 2],
    },
    /// Mesh of a file: as it is named, and its scale.
    Mesh {
        /// URI or path in the source.
        uri: String,
        /// Factors along x, y and z.
        scale: [f64; 3],
    },
}

/// Kinds of joints.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum JointKind {
    /// None.
    Fixed,
    /// About `axis`.
    Revolute,
    /// Along `axis`.
    Prismatic,
    /// About `axis`, advancing by this length a radian.
    Screw(f64),
    /// About `axis`, then about this axis.
    Universal([f64; 3]),
    /// In all directions.
    Ball,
    /// In the plane normal to z of its frame.
    Planar,
    /// Six degrees of freedom.
    Free,
}

impl JointKind {
    /// Number of degrees of freedom.
    pub fn dofs(self) -> usize {
        match self {
            Self::Fixed => 0,
            Self::Revolute | Self::Prismatic | Self::Screw(_) => 1,
            Self::Universal(_) => 2,
            Self::Ball | Self::Planar => 3,
            Self::Free => 6,
        }
    }

    /// Word of the scene language.
    pub fn word(self) -> &'static str {
        match self {
            Self::Fixed => "fixed",
            Self::Revolute => "revolute",
            Self::Prismatic => "prismatic",
            Self::Screw(_) => "screw",
            Self::Universal(_) => "universal",
            Self::Ball => "ball",
            Self::Planar => "planar",
            Self::Free => "free",
        }
    }
}

/// A joint from a link (none: the world) to a link.
#[derive(Clone, Debug)]
pub(crate) struct Joint {
    /// Name in the source.
    pub name: String,
    /// Element in the ledger's documents.
    pub element: (usize, u32),
    /// Kind.
    pub kind: JointKind,
    /// Index of the link that carries it; none for the world.
    pub parent: Option<usize>,
    /// Index of the link that it carries.
    pub child: usize,
    /// Its frame in that of the parent.
    pub pose: Placement,
    /// In its frame.
    pub axis: [f64; 3],
    /// Smallest and largest coordinate.
    pub limits: Option<[f64; 2]>,
    /// Viscous coefficients, one a degree of freedom or none.
    pub damping: Vec<f64>,
    /// Coulomb friction, one a degree of freedom or none.
    pub friction: Vec<f64>,
    /// Reflected inertia, one a degree of freedom or none.
    pub armature: Vec<f64>,
    /// Stiffness and rest coordinate.
    pub spring: Option<[f64; 2]>,
    /// Largest torque or force, if the source gives one.
    pub effort: Option<f64>,
    /// Largest speed, if the source gives one.
    pub speed: Option<f64>,
    /// Coordinates at the start, if the source gives them.
    pub initial: Option<Vec<f64>>,
}

/// A loop joint between two links.
#[derive(Clone, Debug)]
pub(crate) struct Loop {
    /// Name in the source.
    pub name: String,
    /// Place in the source.
    pub at: Location,
    /// Element in the ledger's documents.
    pub element: (usize, u32),
    /// Kind: `point`, `hinge`, `weld`, and its axis for a hinge.
    pub kind: LoopKind,
    /// Softness, if the source holds it by a soft constraint, which may be open; none for a hard one.
    pub softness: Option<Softness>,
    /// Links (none: the world) and the frame in each.
    pub ends: [(Option<usize>, Placement); 2],
}

/// Spring and damper that a soft constraint stands for, by the mass that it moves.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Softness {
    /// Stiffness over mass `[1/s²]`.
    pub stiffness: f64,
    /// Damping over mass `[1/s]`.
    pub damping: f64,
    /// Ratio of the stiffness and damping over moment of inertia to those over mass (dimensionless).
    pub rotation: f64,
    /// Bodies whose masses count, as links (none: the world), and the centre of mass in each `[m]`.
    pub bodies: [(Option<usize>, [f64; 3]); 2],
    /// True if it is to be a bushing even where it is closed at the start, since one end may be moved.
    pub is_moved: bool,
}

/// Kinds of loop joints.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum LoopKind {
    /// Origins coincide.
    Point,
    /// Origins and an axis coincide.
    Hinge([f64; 3]),
    /// Frames coincide.
    Weld,
}

/// Two joints: second = offset + ratio·first, with higher powers of first.
#[derive(Clone, Debug)]
pub(crate) struct Gear {
    /// Name in the scene.
    pub name: String,
    /// Place in the source.
    pub at: Location,
    /// Indices of the joints.
    pub joints: [usize; 2],
    /// Rate of the second over that of the first.
    pub ratio: f64,
    /// Coordinate of the second where the first is zero.
    pub offset: f64,
    /// Coefficients of the second, third and fourth power of the first.
    pub higher: [f64; 3],
}

impl Gear {
    /// Coordinate of the second joint where that of the first is `q`.
    pub fn second(&self, q: f64) -> f64 {
        let [c2, c3, c4] = self.higher;
        self.ratio * q + self.offset + if self.higher == [0.0; 3] { 0.0 } else { q * q * (c2 + q * (c3 + q * c4)) }
    }
}

/// A spring, damper, stop or actuator along a path.
#[derive(Clone, Debug)]
pub(crate) struct Tendon {
    /// Name in the source.
    pub name: String,
    /// Place in the source.
    pub at: Location,
    /// Its path.
    pub path: TendonPath,
    /// Stiffness `[N/m]`.
    pub stiffness: f64,
    /// Damping `[N·s/m]`.
    pub damping: f64,
    /// Constant force `[N]`.
    pub preload: f64,
    /// Shortest and longest length without elastic force `[m]`.
    pub free_length: [f64; 2],
    /// Stops.
    pub limits: Option<TendonLimits>,
    /// Largest force of its actuator, infinite for none; none without actuator `[N]`.
    pub actuator: Option<f64>,
    /// Command of its actuator at the start `[N]`, or its rate for an activation that integrates `[N/s]`.
    pub command: f64,
    /// Activation of its actuator `[N]`.
    pub activation: Option<Activation>,
}

/// Stops of a tendon, a spring and damper beyond each.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct TendonLimits {
    /// Shortest and longest length, infinite for none `[m]`.
    pub range: [f64; 2],
    /// Stiffness `[N/m]`.
    pub stiffness: f64,
    /// Damping `[N·s/m]`.
    pub damping: f64,
}

/// Paths of tendons.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum TendonPath {
    /// Through the origins of these links.
    Through(Vec<usize>),
    /// Joints with one degree of freedom, and lengths for each unit of their coordinates.
    Joints(Vec<(usize, f64)>),
}

/// A force and torque on a link, commanded by one control.
#[derive(Clone, Debug)]
pub(crate) struct CommandedForce {
    /// Name in the source.
    pub name: String,
    /// Place in the source.
    pub at: Location,
    /// Link or frame that it acts on, at its origin and along its axes.
    pub link: usize,
    /// Force x, y, z `[N]` and torque x, y, z `[N·m]` for each unit of the control.
    pub wrench: [f64; 6],
}

/// A state between the command of an actuator and what acts, in the unit of the command.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Activation {
    /// Time constant `[s]`; none of an integrator, whose command is the rate.
    pub time_constant: Option<f64>,
    /// Range of the input, that is of the command.
    pub input_range: Option<[f64; 2]>,
    /// Range of the activation.
    pub range: Option<[f64; 2]>,
    /// Activation at the start.
    pub initial: f64,
}

impl Activation {
    /// The activation of a command that is `scale` times this one plus `offset`; it starts within its range.
    pub fn scaled(&self, scale: f64, offset: f64) -> Self {
        let of = |range: Option<[f64; 2]>, offset: f64| {
            let ends = range.map(|range| range.map(|x| scale * x + offset));
            ends.map(|[a, b]| [a.min(b), a.max(b)])
        };
        // the command of an integrator is a rate
        let of_input = if self.time_constant.is_some() { offset } else { 0.0 };
        let range = of(self.range, offset);
        let scaled = Self { input_range: of(self.input_range, of_input), range, ..*self };
        Self { initial: scaled.saturated(scale * self.initial + offset), ..scaled }
    }

    /// The end of the range that is nearest to `x`, or `x` within it.
    pub fn saturated(&self, x: f64) -> f64 {
        self.range.map_or(x, |[low, high]| x.max(low).min(high))
    }
}

/// A motor of a joint.
#[derive(Clone, Debug)]
pub(crate) struct Motor {
    /// Index of the joint.
    pub joint: usize,
    /// Its law.
    pub law: MotorLaw,
    /// Largest torque or force.
    pub max_torque: Option<f64>,
    /// Command at the start.
    pub command: f64,
    /// Activation, in the unit of the command.
    pub activation: Option<Activation>,
}

/// Laws of motors.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum MotorLaw {
    /// The command is the torque.
    Torque,
    /// τ = stiffness·(command − q) − damping·q̇.
    Spring(f64, f64),
}

/// A sensor on a link.
#[derive(Clone, Debug)]
pub(crate) struct Sensor {
    /// Name in the source.
    pub name: String,
    /// Place in the source.
    pub at: Location,
    /// Link that carries it.
    pub link: usize,
    /// In the link's frame.
    pub pose: Placement,
    /// Measured quantity.
    pub kind: SensorKind,
}

/// Kinds of sensors.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum SensorKind {
    /// Accelerometer and gyro.
    Imu,
    /// Contacts of its body.
    Contact,
    /// Pictures.
    Camera(Optics),
}

/// Optics of a camera that looks along z of its frame, with y up in the picture and x to the left.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Optics {
    /// Angle between the upper and the lower edge of the picture `[rad]`.
    pub field_of_view: f64,
    /// Columns and rows, if the source gives them.
    pub resolution: Option<[u32; 2]>,
    /// Distances at which pictures begin and end, if the source gives them `[m]`.
    pub range: Option<[f64; 2]>,
}

/// Positions of joints under a name.
#[derive(Clone, Debug)]
pub(crate) struct Keyframe {
    /// Name in the source.
    pub name: String,
    /// Element in the ledger's documents.
    pub element: (usize, u32),
    /// Index of a joint and its coordinates.
    pub positions: Vec<(usize, Vec<f64>)>,
    /// Actuators with their commands, in the unit of these.
    pub commands: Vec<(Actuator, f64)>,
    /// Actuators with their activations at the start, in the unit of their commands.
    pub activations: Vec<(Actuator, f64)>,
}

/// An actuator of the robot.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Actuator {
    /// The motor of the joint with this index.
    Motor(usize),
    /// That of the tendon with this index.
    Tendon(usize),
}

impl Joint {
    /// A joint about or along x with nothing acting in it.
    pub fn new(name: &str, element: (usize, u32), kind: JointKind, parent: Option<usize>, child: usize) -> Self {
        Self {
            name: name.to_owned(),
            element,
            kind,
            parent,
            child,
            pose: Placement::default(),
            axis: [1.0, 0.0, 0.0],
            limits: None,
            damping: Vec::new(),
            friction: Vec::new(),
            armature: Vec::new(),
            spring: None,
            effort: None,
            speed: None,
            initial: None,
        }
    }
}

impl Joint {
    /// Pose of its moving frame at the start; `q` is the coordinate of a joint with one degree of freedom.
    fn motion(&self, q: f64) -> Pose<f64> {
        let axis = Vec3(self.axis);
        let unit = axis.scale(1.0 / axis.norm());
        match (self.kind, self.initial.as_deref()) {
            (JointKind::Revolute, _) => Pose { rot: Quat::exp(unit.scale(q)).matrix(), pos: Vec3::zero() },
            (JointKind::Prismatic, _) => Pose::translation(unit.scale(q)),
            (JointKind::Screw(pitch), _) => Pose { rot: Quat::exp(unit.scale(q)).matrix(), pos: unit.scale(pitch * q) },
            (JointKind::Free, Some(&[x, y, z, a, b, c, d])) => {
                Placement { position: [x, y, z], rotation: Rotation::Quaternion([a, b, c, d]) }.pose()
            }
            _ => Pose::identity(),
        }
    }
}

impl Robot {
    /// Returns true if the source lets a robot move freely in the world.
    pub fn has_free_root(&self) -> bool {
        self.joints.iter().any(|joint| joint.parent.is_none() && joint.kind == JointKind::Free)
    }

    /// For each link, true if it belongs to a tree whose base moves freely, with shapes that touch.
    pub fn floating(&self, options: &Options) -> Vec<bool> {
        let mut carriers = vec![None; self.links.len()];
        for joint in &self.joints {
            carriers[joint.child] = Some(joint);
        }
        let root_of = |mut k: usize| {
            while let Some(parent) = carriers[k].and_then(|joint: &Joint| joint.parent) {
                k = parent;
            }
            k
        };
        let roots: Vec<usize> = (0..self.links.len()).map(root_of).collect();
        let mut touches = vec![false; self.links.len()];
        for (link, root) in self.links.iter().zip(&roots) {
            touches[*root] |= !link.collisions.is_empty();
        }
        let is_free = |root: usize| carriers[root].map_or(options.free_base, |joint| joint.kind == JointKind::Free);
        roots.into_iter().map(|root| touches[root] && is_free(root)).collect()
    }

    /// Pose of a link in the world (none: the world itself); `starts` has the coordinates of the joints with one degree
    /// of freedom, zero where it is too short.
    pub fn link_pose(&self, link: Option<usize>, starts: &[f64]) -> Pose<f64> {
        let mut pose = Pose::identity();
        let mut at = link;
        for _ in 0..=self.links.len() {
            let Some(link) = at else { break };
            pose = self.links[link].pose.pose().compose(&pose);
            let Some(k) = self.joint_of(link) else { break };
            let joint = &self.joints[k];
            pose = joint.pose.pose().compose(&joint.motion(starts.get(k).copied().unwrap_or(0.0))).compose(&pose);
            at = joint.parent;
        }
        pose
    }

    /// The joint that carries each link.
    pub fn carriers(&self) -> Vec<Option<usize>> {
        let mut list = vec![None; self.links.len()];
        self.joints.iter().enumerate().for_each(|(k, joint)| list[joint.child] = Some(k));
        list
    }

    /// The joint that carries a link.
    pub fn joint_of(&self, link: usize) -> Option<usize> {
        self.joints.iter().position(|joint| joint.child == link)
    }
}

/// An inertia matrix (xx, xy, xz, yy, yz, zz) with its components turned by a rotation: from frame B to A by R_ab.
pub(crate) fn turned_inertia(rot: &Mat3<f64>, inertia: [f64; 6]) -> [f64; 6] {
    if *rot == Mat3::identity() {
        return inertia;
    }
    let [xx, xy, xz, yy, yz, zz] = inertia;
    let full = Mat3([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]]);
    let Mat3(m) = rot.mul(&full).mul(&rot.transpose());
    [m[0][0], 0.5 * (m[0][1] + m[1][0]), 0.5 * (m[0][2] + m[2][0]), m[1][1], 0.5 * (m[1][2] + m[2][1]), m[2][2]]
}
