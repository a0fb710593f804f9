//! Contact signals of a body: the contact sensor that every body with a contact has.

use sincro_dynamics::constraint::ContactPoint;
use sincro_dynamics::model::Model;
use sincro_dynamics::spatial::Vec3;

/// Quantity of the contacts of a body.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ContactQuantity {
    /// Sum of all forces on it `[N]`, world axes.
    Force,
    /// Sum of their moments about the world's origin and of rolling and spinning friction [N·m], world axes.
    Torque,
    /// Sum of the normal forces `[N]`.
    NormalForce,
    /// Size of the sum of the friction forces `[N]`: how redundant points share them is not determined.
    FrictionForce,
    /// Centre of the normal forces `[m]`; NaN where nothing presses.
    Point,
    /// Mean normal, into the body, weighted by the normal forces; NaN where nothing presses.
    Normal,
    /// Number of points that press.
    Count,
}

/// Component `k` of a contact quantity `[N]`, `[N·m]`, `[m]` of the body with index `frame`; 0 if nothing touches it.
pub fn read(
    model: &Model<f64>,
    points: impl Iterator<Item = ContactPoint>,
    quantity: ContactQuantity,
    frame: usize,
    k: usize,
) -> f64 {
    use ContactQuantity as Q;
    let colliders = &model.constraints().colliders;
    let (mut sum, mut weight, mut count) = (Vec3::zero(), 0.0, 0_u32);
    for point in points {
        let [a, b] = point.surfaces.map(|s| colliders[s].body.is_some_and(|body| body.index() == frame));
        let sign = match (a, b) {
            (true, false) => 1.0,
            (false, true) => -1.0,
            _ => continue,
        };
        let press = point.force.dot(point.normal);
        weight += press;
        count += u32::from(press > 0.0);
        let friction = point.force - point.normal.scale(press);
        sum += match quantity {
            Q::Force => point.force.scale(sign),
            Q::Torque => (point.torque + point.point.cross(point.force)).scale(sign),
            Q::Point => point.point.scale(press),
            Q::Normal => point.normal.scale(sign * press),
            Q::FrictionForce => friction,
            Q::NormalForce | Q::Count => Vec3::zero(),
        };
    }
    match quantity {
        Q::Force | Q::Torque => sum[k],
        Q::FrictionForce => sum.norm(),
        Q::NormalForce => weight,
        Q::Count => f64::from(count),
        Q::Point => sum[k] / weight,
        Q::Normal => sum[k] / sum.norm(),
    }
}
