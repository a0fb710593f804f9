//! Ray casts against solids: closed forms for the point where a ray enters, in the solid's own frame.

use super::Shape;
use super::{Hit, Ray};
use crate::spatial::Vec3;

/// Ray cast against a solid.
pub(super) fn solid(shape: &Shape, ray: &Ray) -> Option<Hit> {
    match *shape {
        Shape::Sphere { radius } => ball(Vec3::zero(), radius, ray),
        Shape::Cuboid { size } => cuboid(size, ray),
        Shape::Cylinder { radius, length } => cylinder(radius, length, ray),
        Shape::Capsule { radius, length } => capsule(radius, length, ray),
        Shape::Torus { major_radius, tube_radius } => rounded_disc(major_radius, tube_radius, ray),
        Shape::Cone { radius, length } => cone(radius, length, ray),
    }
}

/// Ray cast against the half space z ≤ 0.
pub(super) fn half_space(ray: &Ray) -> Option<Hit> {
    planes([(Vec3([0.0, 0.0, 1.0]), 0.0)].into_iter(), ray)
}

/// Ray cast against the intersection of half spaces: outward normals and distances from the origin.
pub(super) fn planes(planes: impl Iterator<Item = (Vec3<f64>, f64)>, ray: &Ray) -> Option<Hit> {
    let mut enters: Option<Hit> = None;
    let mut leaves = f64::INFINITY;
    for (normal, offset) in planes {
        let (above, towards) = (normal.dot(ray.origin) - offset, normal.dot(ray.direction));
        if towards < 0.0 {
            let distance = -above / towards;
            if enters.is_none_or(|hit| distance > hit.distance) {
                enters = Some(Hit { distance, normal });
            }
        } else if towards > 0.0 {
            leaves = leaves.min(-above / towards);
        } else if above > 0.0 {
            return None;
        }
    }
    enters.filter(|hit| hit.distance >= 0.0 && hit.distance <= leaves)
}

fn cuboid(size: [f64; 3], ray: &Ray) -> Option<Hit> {
    let face = |k: usize| {
        let sign = if k < 3 { 1.0 } else { -1.0 };
        let mut normal = Vec3::zero();
        normal[k % 3] = sign;
        (normal, 0.5 * size[k % 3])
    };
    planes((0..6).map(face), ray)
}

/// The smaller root of a t² + 2 b t + c = 0, for a > 0.
fn first_root(a: f64, b: f64, c: f64) -> Option<f64> {
    let inside = b * b - a * c;
    if inside < 0.0 {
        return None;
    }
    // of the two forms, the one that does not subtract what is nearly equal
    Some(if b < 0.0 { c / (inside.sqrt() - b) } else { -(b + inside.sqrt()) / a })
}

fn ball(center: Vec3<f64>, radius: f64, ray: &Ray) -> Option<Hit> {
    let from = ray.origin - center;
    let distance = first_root(1.0, from.dot(ray.direction), from.dot(from) - radius * radius)?;
    let normal = (ray.at(distance) - center).scale(1.0 / radius);
    (distance >= 0.0).then_some(Hit { distance, normal })
}

/// The flank of an endless cylinder along z.
fn flank(radius: f64, ray: &Ray) -> Option<Hit> {
    let ([x, y, _], [u, v, _]) = (ray.origin.0, ray.direction.0);
    let a = u * u + v * v;
    if a == 0.0 {
        return None;
    }
    let distance = first_root(a, x * u + y * v, x * x + y * y - radius * radius)?;
    let p = ray.at(distance);
    (distance >= 0.0).then_some(Hit { distance, normal: Vec3([p[0] / radius, p[1] / radius, 0.0]) })
}

/// A disc across z at a height, seen from the side that `up` points to.
fn disc(radius: f64, height: f64, up: f64, ray: &Ray) -> Option<Hit> {
    let towards = ray.direction[2] * up;
    if towards >= 0.0 {
        return None;
    }
    let distance = (height - ray.origin[2]) / ray.direction[2];
    let p = ray.at(distance);
    let is_on = distance >= 0.0 && p[0] * p[0] + p[1] * p[1] <= radius * radius;
    is_on.then_some(Hit { distance, normal: Vec3([0.0, 0.0, up]) })
}

fn nearer(one: Option<Hit>, two: Option<Hit>) -> Option<Hit> {
    match (one, two) {
        (Some(one), Some(two)) => Some(if two.distance < one.distance { two } else { one }),
        (one, two) => one.or(two),
    }
}

fn cylinder(radius: f64, length: f64, ray: &Ray) -> Option<Hit> {
    let half = 0.5 * length;
    let side = flank(radius, ray).filter(|hit| ray.at(hit.distance)[2].abs() <= half);
    let ends = nearer(disc(radius, half, 1.0, ray), disc(radius, -half, -1.0, ray));
    nearer(side, ends)
}

fn capsule(radius: f64, length: f64, ray: &Ray) -> Option<Hit> {
    let half = 0.5 * length;
    let side = flank(radius, ray).filter(|hit| ray.at(hit.distance)[2].abs() <= half);
    let cap = |sign: f64| {
        let center = Vec3([0.0, 0.0, sign * half]);
        ball(center, radius, ray).filter(|hit| sign * ray.at(hit.distance)[2] >= half)
    };
    nearer(side, nearer(cap(1.0), cap(-1.0)))
}

/// Convex hull of a torus: two flat discs, and the outer half of the tube.
fn rounded_disc(radius: f64, tube: f64, ray: &Ray) -> Option<Hit> {
    let faces = nearer(disc(radius, tube, 1.0, ray), disc(radius, -tube, -1.0, ray));
    nearer(faces, tube_of(radius, tube, ray))
}

/// Ray cast against the outer half of a tube about a circle: Newton's method for the distance to the disc in the
/// circle, less the radius of the tube, which is a convex function along the ray.
fn tube_of(radius: f64, tube: f64, ray: &Ray) -> Option<Hit> {
    // a ray that grazes the tube converges linearly, and by halves
    const STEPS: usize = 100;
    let reach = radius + tube;
    // where the ray is within reach of the centre
    let middle = -ray.origin.dot(ray.direction);
    let square = reach * reach - ray.at(middle).dot(ray.at(middle));
    if square < 0.0 {
        return None;
    }
    let (mut t, end) = ((middle - square.sqrt()).max(0.0), middle + square.sqrt());
    let outside = |t: f64| {
        let p = ray.at(t);
        let across = (p[0] * p[0] + p[1] * p[1]).sqrt();
        // inside the circle the nearest point of the hull is on a disc
        let k = if across > radius { radius / across } else { 1.0 };
        let from = p - Vec3([k * p[0], k * p[1], 0.0]);
        (from.norm() - tube, from)
    };
    for _ in 0..STEPS {
        let (apart, from) = outside(t);
        if apart.abs() < 1e-13 * reach {
            let p = ray.at(t);
            let is_on_tube = p[0] * p[0] + p[1] * p[1] >= radius * radius;
            let normal = from.scale(1.0 / from.norm());
            return (is_on_tube && normal.dot(ray.direction) < 0.0).then_some(Hit { distance: t, normal });
        }
        let along = from.dot(ray.direction) / from.norm();
        if along >= 0.0 || apart < 0.0 {
            return None;
        }
        // the distance is convex: from outside, the step stays in front of the surface
        t -= apart / along;
        if t > end {
            return None;
        }
    }
    None
}

/// Its apex at 3/4 of the length, its base at −1/4.
fn cone(radius: f64, length: f64, ray: &Ray) -> Option<Hit> {
    let (apex, base) = (0.75 * length, -0.25 * length);
    // x² + y² = s² (apex − z)²
    let slope = radius / length;
    let (o, d) = (ray.origin, ray.direction);
    let (h, s2) = (o[2] - apex, slope * slope);
    let a = d[0] * d[0] + d[1] * d[1] - s2 * d[2] * d[2];
    let b = o[0] * d[0] + o[1] * d[1] - s2 * h * d[2];
    let c = o[0] * o[0] + o[1] * o[1] - s2 * h * h;
    let inside = b * b - a * c;
    let side = |t: f64| {
        let p = ray.at(t);
        let (across, along) = ((p[0] * p[0] + p[1] * p[1]).sqrt(), radius / (length * length + radius * radius).sqrt());
        let lean = (1.0 - along * along).sqrt();
        let normal = Vec3([lean * p[0] / across, lean * p[1] / across, along]);
        let is_on = t >= 0.0 && (base..apex).contains(&p[2]) && normal.dot(d) < 0.0;
        is_on.then_some(Hit { distance: t, normal })
    };
    let flank = if inside < 0.0 {
        None
    } else if a == 0.0 {
        side(-0.5 * c / b)
    } else {
        let root = inside.sqrt();
        nearer(side((-b - root) / a), side((-b + root) / a))
    };
    nearer(flank, disc(radius, base, -1.0, ray))
}
