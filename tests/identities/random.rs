//! Random mechanisms: trees with every joint kind, any axis, any joint pose, bodies hung on bodies.

use sincro_dynamics::joint::JointKind;
use sincro_dynamics::model::{BodySpec, JointSpec, Model, ModelBuilder, NodeId, Shape};
use sincro_dynamics::spatial::{Pose, Quat, Vec3};
use sincro_dynamics::state::State;

/// A small generator (SplitMix64) with a fixed seed a test.
pub struct Random(u64);

impl Random {
    pub fn new(seed: u64) -> Self {
        Self(seed)
    }

    pub fn below(&mut self, n: usize) -> usize {
        (self.bits() % n as u64) as usize
    }

    /// Uniform in [-1, 1].
    pub fn unit(&mut self) -> f64 {
        (self.bits() >> 11) as f64 / (1u64 << 52) as f64 - 1.0
    }

    pub fn vector(&mut self) -> [f64; 3] {
        [self.unit(), self.unit(), self.unit()]
    }

    fn bits(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    /// Half of the poses are pure translations, some nothing at all, as in real robots.
    pub fn pose(&mut self) -> Pose<f64> {
        let pos = if self.below(4) == 0 { Vec3::zero() } else { Vec3(self.vector()) };
        match self.below(2) {
            0 => Pose::translation(pos),
            _ => Pose { rot: Quat::exp(Vec3(self.vector()).scale(2.0)).matrix(), pos },
        }
    }

    fn axis(&mut self) -> [f64; 3] {
        let k = self.below(3);
        let mut axis = [0.0; 3];
        match self.below(3) {
            0 => axis[k] = 1.0,
            1 => axis[k] = -2.0,
            _ => return self.vector(),
        }
        axis
    }

    pub fn kind(&mut self) -> JointKind {
        match self.below(8) {
            0 => JointKind::Fixed,
            1 | 2 => JointKind::Revolute { axis: self.axis() },
            3 => JointKind::Prismatic { axis: self.axis() },
            4 => JointKind::Screw { axis: self.axis(), pitch: self.unit() },
            5 => JointKind::Universal { axis: self.axis(), axis2: self.vector() },
            6 => JointKind::Ball,
            _ => [JointKind::Planar, JointKind::Free][self.below(2)],
        }
    }
}

/// A tree of `n` joints, each with a body, some with a second body welded on.
pub fn tree(r: &mut Random, n: usize) -> Model<f64> {
    let mut builder = ModelBuilder::new([0.3, -0.2, -9.81]);
    let mut nodes = vec![NodeId::WORLD];
    for i in 0..n {
        let parent = if r.below(3) == 0 { nodes[r.below(nodes.len())] } else { nodes[nodes.len() - 1] };
        let mut spec = JointSpec::new(r.kind());
        if matches!(spec.kind, JointKind::Revolute { .. }) {
            spec.armature = vec![r.unit().abs()];
        }
        let joint = builder.joint(&format!("j{i}"), parent, r.pose(), spec);
        let body = builder.body(&format!("b{i}"), joint, r.pose(), body(r));
        if r.below(3) == 0 {
            builder.body(&format!("extra{i}"), body, r.pose(), self::body(r));
        }
        nodes.push(body);
    }
    builder.build().expect("a random tree is a valid model").0
}

fn body(r: &mut Random) -> BodySpec {
    let size = r.vector().map(|x| 0.1 + x.abs());
    let mut mass = Shape::Cuboid { size }.mass_properties(3.0);
    mass.center_of_mass = r.vector();
    BodySpec { mass }
}

/// A random state with unit quaternions.
pub fn state(r: &mut Random, model: &Model<f64>) -> State<f64> {
    let mut x = State::new(model);
    for joint in &model.names().joints {
        let q = &mut x.q[joint.q_idx..joint.q_idx + joint.n_q];
        q.iter_mut().for_each(|q| *q = 2.0 * r.unit());
        let quat = match joint.kind {
            JointKind::Ball => 0,
            JointKind::Free => 3,
            _ => continue,
        };
        Quat::from_slice(&q[quat..]).normalized().write(&mut q[quat..]);
    }
    x.v.iter_mut().for_each(|v| *v = 2.0 * r.unit());
    x
}
