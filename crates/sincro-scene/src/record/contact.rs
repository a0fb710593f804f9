//! Contact signals of a body: the contact sensor that every body with a contact has.

use sincro_dynamics::constraint::ContactPoint;
use sincro_dynamics::model::Model;
use sincro_dynamics::spatial::Vec3;

/// Quantity of all contacts of a body together, for [`read`]; vectors in world axes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ContactQuantity {
    /// Sum of the contact forces on the body `[N]`, 3 components.
    Force,
    /// Sum of their moments about the world's origin and of rolling and spinning friction `[N·m]`, 3 components.
    Torque,
    /// Sum of the normal forces `[N]`, a scalar.
    NormalForce,
    /// Magnitude of the sum of the friction forces `[N]`, a scalar: how redundant points share them is not determined.
    FrictionForce,
    /// Centre of the normal forces in the world `[m]`, 3 components; NaN where nothing presses.
    Point,
    /// Mean normal, a unit vector into the body, weighted by the normal forces, 3 components; NaN where nothing
    /// presses.
    Normal,
    /// Number of contact points with a normal force, a scalar.
    Count,
}

/// Returns component `k` (0 to 2; ignored for scalars) of a contact quantity, in its unit, of the body whose frame has
/// the index `frame` in the model's names. `points` are the contact points of the present state. Without contact 0; NaN
/// of `Point` and `Normal`.
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
