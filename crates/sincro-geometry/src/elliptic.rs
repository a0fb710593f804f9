//! Convex hulls that stand for solids with elliptic sections.

use sincro_math::elementary::sin_cos;

use super::Surface;

/// Corners of one ring of a hull that stands for a shape with elliptic sections.
const N_CORNERS: u32 = 32;

/// Ring of corners on an ellipse, `height` and `scale` relative to the lengths of the shape's box.
fn ring([x, y, z]: [f64; 3], height: f64, scale: f64) -> impl Iterator<Item = [f64; 3]> {
    (0..N_CORNERS).map(move |k| {
        let (sin, cos) = sin_cos(std::f64::consts::TAU * f64::from(k) / f64::from(N_CORNERS));
        [0.5 * x * scale * cos, 0.5 * y * scale * sin, height * z]
    })
}

impl Surface {
    /// Convex hull in place of an ellipsoid with full lengths `size` along the axes `[m]`, its centre at the origin:
    /// rings at equal angles between its poles.
    #[must_use]
    pub fn ellipsoid(size: [f64; 3]) -> Self {
        const N_RINGS: u32 = 15;
        let rings = (1..=N_RINGS).flat_map(|k| {
            let (sin, cos) = sin_cos(std::f64::consts::PI * f64::from(k) / f64::from(N_RINGS + 1));
            ring(size, -0.5 * cos, sin)
        });
        let poles = [-0.5, 0.5].into_iter().flat_map(|height| ring(size, height, 0.0).take(1));
        Self::Hull(rings.chain(poles).collect())
    }

    /// Convex hull in place of a cylinder about z with an elliptic section, full lengths `size` along the axes `[m]`,
    /// the middle of its box at the origin.
    #[must_use]
    pub fn elliptic_cylinder(size: [f64; 3]) -> Self {
        Self::Hull(ring(size, -0.5, 1.0).chain(ring(size, 0.5, 1.0)).collect())
    }

    /// Convex hull in place of a cone along z with an elliptic base, full lengths `size` along the axes `[m]`, the
    /// middle of its box at the origin and its tip upwards.
    #[must_use]
    pub fn elliptic_cone(size: [f64; 3]) -> Self {
        Self::Hull(ring(size, -0.5, 1.0).chain(ring(size, 0.5, 0.0).take(1)).collect())
    }
}
