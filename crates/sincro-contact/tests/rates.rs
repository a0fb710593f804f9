//! Rates of contact points and normals against differences of detections a moment apart, of random bodies that overlap
//! a little: what a contact constraint differentiates must be how the contact found moves.

use sincro_contact::candidate::{ContactCandidate, Edge, LinkMotions};
use sincro_contact::candidate_list::CandidateList;
use sincro_contact::{Collider, Detector, Margin, Material, PairLaw, Surface, pairs};
use sincro_geometry::Shape;
use sincro_geometry::spatial::{Motion, Pose, Quat, Vec3};

/// Time between the detections `[s]`.
const STEP: f64 = 1e-5;

/// Random numbers from −1 to 1.
struct Random(u64);

impl Random {
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
    }

    fn vector(&mut self) -> Vec3<f64> {
        Vec3([self.next(), self.next(), self.next()])
    }
}

fn collider(link: u32, shape: &Shape) -> Collider {
    let material = Material { friction: 0.5, ..Material::default() };
    let (name, surface) = (link.to_string(), Surface::Solid(*shape));
    Collider { name, body: None, link, pose: Pose::identity(), surface, material }
}

/// Two bodies with their poses and twists about the world's origin.
struct Bodies {
    colliders: [Collider; 2],
    poses: [Pose<f64>; 2],
    twists: [Motion<f64>; 2],
}

impl Bodies {
    /// Random bodies of these shapes that move apart until they overlap by some millimetres.
    fn random(shapes: [&Shape; 2], random: &mut Random) -> Self {
        let [a, b] = shapes;
        let colliders = [collider(0, a), collider(1, b)];
        let mut pose = |pos: Vec3<f64>| {
            let v = random.vector();
            Pose { rot: Quat::from_slice(&[random.next(), v[0], v[1], v[2]]).normalized().matrix(), pos }
        };
        let poses = [pose(Vec3::zero()), pose(Vec3::zero())];
        let twists = [0, 1].map(|_| Motion { ang: random.vector().scale(3.0), lin: random.vector() });
        let mut new = Self { colliders, poses, twists };
        let direction = random.vector();
        let direction = direction.scale(1.0 / direction.norm());
        let (mut near, mut far) = (0.0, 2.0);
        for _ in 0..40 {
            let at = 0.5 * (near + far);
            new.poses[1].pos = direction.scale(at);
            let deepest = new.detect(0.0).iter().map(|(_, c)| new.distance(c)).fold(f64::INFINITY, f64::min);
            (near, far) = if deepest < -2e-3 { (at, far) } else { (near, at) };
        }
        new
    }

    /// Poses after a time `t` `[s]`, each body turning about the world's origin as its twist says.
    fn poses_at(&self, t: f64) -> [Pose<f64>; 2] {
        std::array::from_fn(|k| {
            let (x, v) = (self.poses[k], self.twists[k]);
            let turn = Quat::exp(v.ang.scale(t)).matrix();
            let lin = v.lin.scale(t) + v.ang.cross(v.lin).scale(0.5 * t * t);
            Pose { rot: turn.mul(&x.rot), pos: turn.mul_vec(x.pos) + lin }
        })
    }

    fn detect(&self, t: f64) -> Vec<(usize, ContactCandidate)> {
        let pairs = pairs(&self.colliders, |_, _| false, |_, _| PairLaw::default());
        let mut detector = Detector::new(&self.colliders, &pairs);
        let mut found = CandidateList::default();
        let margin = Margin { base: 1e-3, time: 0.0 };
        let velocity = |_: &Collider, _: Vec3<f64>| (Vec3::zero(), 0.0);
        let poses = self.poses_at(t);
        detector.detect((&self.colliders, &pairs), &poses, margin, velocity, |_| 0, |_| false, &mut found);
        found.iter().map(|c| (c.slot as usize, c.candidate)).collect()
    }

    fn distance(&self, candidate: &ContactCandidate) -> f64 {
        candidate.kinematics(&LinkMotions { poses: &self.poses, twists: &self.twists }).distance
    }

    /// Raises `worst` to the errors of the rates of point, normal and gap of the deepest contact point, or of `all`
    /// that overlap, and of point and normal as the candidate itself moves; returns the number of points.
    fn check(&self, all: bool, worst: &mut [f64; 4]) -> usize {
        let (before, now, after) = (self.detect(-STEP), self.detect(0.0), self.detect(STEP));
        let same = |list: &[(usize, ContactCandidate)], (slot, c): (usize, ContactCandidate)| {
            let is_alike = |d: &ContactCandidate| {
                d.a == c.a
                    && d.id == c.id
                    && d.edge.map(|e| std::mem::discriminant(&e)) == c.edge.map(|e| std::mem::discriminant(&e))
            };
            list.iter().find(|(s, d)| *s == slot && is_alike(d)).map(|(_, d)| *d)
        };
        let deepest = now.iter().map(|(_, c)| self.distance(c)).fold(f64::INFINITY, f64::min);
        let mut n_points = 0;
        for (slot, candidate) in now {
            let (Some(before), Some(after)) = (same(&before, (slot, candidate)), same(&after, (slot, candidate)))
            else {
                continue;
            };
            let at = |c: &ContactCandidate, t: f64| {
                let (poses, twists) = (self.poses_at(t), self.twists);
                c.kinematics(&LinkMotions { poses: &poses, twists: &twists })
            };
            let (k, one, two) = (at(&candidate, 0.0), at(&before, -STEP), at(&after, STEP));
            if k.distance > if all { 0.0 } else { deepest + 1e-9 } {
                continue;
            }
            // within a step the candidate found at its start moves with the bodies
            let [early, late] = [-STEP, STEP].map(|t| at(&candidate, t));
            let of_one = ((late.point - early.point).scale(0.5 / STEP) - k.point_dot).norm();
            let of_one = of_one.max(((late.normal - early.normal).scale(0.5 / STEP) - k.normal_dot).norm());
            let rate = |f: &dyn Fn(&sincro_contact::candidate::ContactKinematics<f64>) -> Vec3<f64>| {
                (f(&two) - f(&one)).scale(0.5 / STEP)
            };
            let of_point = (rate(&|k| k.point) - k.point_dot).norm();
            let of_normal = (rate(&|k| k.normal) - k.normal_dot).norm();
            // the point of a may be one of the other surface: the gap changes as the point moves over b
            let velocity_b = {
                let v = self.twists[candidate.b as usize];
                v.lin + v.ang.cross(k.point)
            };
            let gap_rate = match candidate.edge {
                Some(Edge::Cut { .. } | Edge::OverVertex { .. }) => k.normal.dot(k.point_dot - velocity_b),
                _ => {
                    let v = self.twists[candidate.a as usize];
                    k.normal.dot(v.lin + v.ang.cross(k.point) - velocity_b)
                }
            };
            let of_gap = ((two.distance - one.distance) * (0.5 / STEP) - gap_rate).abs();
            for (worst, error) in worst.iter_mut().zip([of_point, of_normal, of_gap, of_one]) {
                *worst = worst.max(error);
            }
            n_points += 1;
        }
        n_points
    }
}

/// Largest errors of the rates of points, normals and gaps over random poses and motions of two shapes, and the number
/// of points.
fn errors(shapes: [&Shape; 2], all: bool, seed: u64) -> ([f64; 4], usize) {
    let mut random = Random(seed);
    let (mut worst, mut n_points) = ([0.0; 4], 0);
    for _ in 0..60 {
        n_points += Bodies::random(shapes, &mut random).check(all, &mut worst);
    }
    (worst, n_points)
}

#[test]
fn points_and_normals_move_as_their_rates_say() {
    let cuboid = Shape::Cuboid { size: [0.3, 0.2, 0.16] };
    let cylinder = Shape::Cylinder { radius: 0.1, length: 0.15 };
    let capsule = Shape::Capsule { radius: 0.06, length: 0.2 };
    let sphere = Shape::Sphere { radius: 0.1 };
    // the library clips against an approximation of curved surfaces: of these the deepest point alone is exact
    for (name, shapes, all, bar) in [
        ("cuboids", [&cuboid, &cuboid], true, 1e-6),
        ("sphere and cuboid", [&sphere, &cuboid], true, 1e-5),
        ("capsule and cuboid", [&capsule, &cuboid], false, 1e-5),
        ("capsules", [&capsule, &capsule], false, 1e-5),
        ("capsule and cylinder", [&capsule, &cylinder], false, 1e-5),
        ("cylinder and cuboid", [&cylinder, &cuboid], false, 1e-3),
    ] {
        let (worst, n_points) = errors(shapes, all, 7);
        println!("{name}: {n_points} points, errors {worst:?}");
        assert!(n_points > 40, "{name}: {n_points}");
        assert!(
            worst.iter().all(|error| *error < bar),
            "{name}: errors of the rates of point, normal and gap {worst:?}, allowed {bar}"
        );
    }
}
