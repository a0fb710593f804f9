//! Solid shapes and their mass properties from density.
//!
//! Frames are centred on the centre of mass; axes of symmetry lie along z. Source of the formulas: key `meriam2015`,
//! table D/4.

use core::f64::consts::PI;

use super::MassProperties;

/// Homogeneous solid, centred on its centre of mass, with its axis of symmetry along z. Of bodies it gives the mass
/// properties, of colliders and sensors the surface ([`Surface::Solid`](crate::Surface::Solid)).
///
/// ```
/// use sincro_geometry::Shape;
///
/// let rod = Shape::Cylinder { radius: 0.02, length: 1.0 };
/// let aluminium = rod.mass_properties(2700.0); // [kg/m³]
/// assert!((aluminium.mass - 2700.0 * rod.volume()).abs() < 1e-12); // [kg]
/// // about its centre, across its axis: m (3 r² + l²)/12
/// let expected = aluminium.mass * (3.0 * 0.02 * 0.02 + 1.0) / 12.0;
/// assert!((aluminium.inertia[0] - expected).abs() < 1e-12); // [kg·m²]
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Shape {
    /// Box with edges along the axes.
    Cuboid {
        /// Full edge lengths along x, y, z `[m]`.
        size: [f64; 3],
    },
    /// Ball.
    Sphere {
        /// Radius `[m]`.
        radius: f64,
    },
    /// Circular cylinder along z.
    Cylinder {
        /// Radius `[m]`.
        radius: f64,
        /// Length `[m]`.
        length: f64,
    },
    /// Cylinder along z with two half spheres; `length` is that of the cylinder alone.
    Capsule {
        /// Radius `[m]`.
        radius: f64,
        /// Length between the centres of the caps `[m]`.
        length: f64,
    },
    /// Torus about z: a circle of the `major_radius` in the plane z = 0, thickened by the `tube_radius`. Contact,
    /// distances and ray casts take it for its convex hull, without the hole: a disc with a rounded edge.
    Torus {
        /// Radius of the circle in the middle of the tube `[m]`.
        major_radius: f64,
        /// Radius of the tube `[m]`, at most the major radius.
        tube_radius: f64,
    },
    /// Circular cone along z: base at z = −length/4, apex at z = 3·length/4.
    Cone {
        /// Radius of the base `[m]`.
        radius: f64,
        /// Height `[m]`.
        length: f64,
    },
}

impl Shape {
    /// Volume of the solid `[m³]`.
    #[must_use]
    pub fn volume(&self) -> f64 {
        match *self {
            Self::Cuboid { size: [x, y, z] } => x * y * z,
            Self::Sphere { radius: r } => 4.0 / 3.0 * PI * r * r * r,
            Self::Cylinder { radius: r, length } => PI * r * r * length,
            Self::Capsule { radius: r, length } => PI * r * r * (length + 4.0 / 3.0 * r),
            Self::Torus { major_radius, tube_radius } => 2.0 * PI * PI * major_radius * tube_radius * tube_radius,
            Self::Cone { radius: r, length } => PI * r * r * length / 3.0,
        }
    }

    /// Dimensions `[m]` with the names of their fields, in the order of the fields (three times `size` for a cuboid, in
    /// the order x, y, z): each must be positive and finite in a scene.
    #[must_use]
    pub fn dimensions(&self) -> Vec<(&'static str, f64)> {
        match *self {
            Self::Cuboid { size } => size.iter().map(|&x| ("size", x)).collect(),
            Self::Sphere { radius } => vec![("radius", radius)],
            Self::Cylinder { radius, length } | Self::Capsule { radius, length } | Self::Cone { radius, length } => {
                vec![("radius", radius), ("length", length)]
            }
            Self::Torus { major_radius, tube_radius } => {
                vec![("major_radius", major_radius), ("tube_radius", tube_radius)]
            }
        }
    }

    /// Mass properties at a uniform `density` `[kg/m³]`, in the shape's own frame: the centre of mass is the origin.
    #[must_use]
    pub fn mass_properties(&self, density: f64) -> MassProperties {
        let mass = density * self.volume();
        // (transverse, axial) moments of the bodies of revolution
        let (transverse, axial) = match *self {
            Self::Cuboid { size: [x, y, z] } => {
                let k = mass / 12.0;
                let inertia = [k * (y * y + z * z), 0.0, 0.0, k * (x * x + z * z), 0.0, k * (x * x + y * y)];
                return MassProperties { mass, center_of_mass: [0.0; 3], inertia };
            }
            Self::Sphere { radius: r } => (0.4 * mass * r * r, 0.4 * mass * r * r),
            Self::Cylinder { radius: r, length: l } => (mass * (l * l / 12.0 + r * r / 4.0), 0.5 * mass * r * r),
            Self::Cone { radius: r, length: l } => (mass * (0.15 * r * r + 3.0 / 80.0 * l * l), 0.3 * mass * r * r),
            Self::Capsule { radius: r, length: l } => capsule_moments(density, r, l),
            Self::Torus { major_radius: a, tube_radius: r } => {
                (mass * (0.5 * a * a + 0.625 * r * r), mass * (a * a + 0.75 * r * r))
            }
        };
        MassProperties { mass, center_of_mass: [0.0; 3], inertia: [transverse, 0.0, 0.0, transverse, 0.0, axial] }
    }
}

fn capsule_moments(density: f64, r: f64, l: f64) -> (f64, f64) {
    let cylinder = density * PI * r * r * l;
    let caps = density * 4.0 / 3.0 * PI * r * r * r;
    // a half sphere's centre of mass lies 3r/8 from its flat face; Steiner twice
    let transverse = cylinder * (l * l / 12.0 + r * r / 4.0) + caps * (0.4 * r * r + l * l / 4.0 + 0.375 * r * l);
    let axial = 0.5 * cylinder * r * r + 0.4 * caps * r * r;
    (transverse, axial)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Volume integrals over a fine grid of the shape's bounding box: mass, axial and transverse moment, height of the
    /// centre.
    fn by_integration(inside: impl Fn(f64, f64) -> bool, r_max: f64, z: (f64, f64)) -> (f64, f64, f64, f64) {
        let (n_r, n_z) = (2000, 2000);
        let (dr, dz) = (r_max / f64::from(n_r), (z.1 - z.0) / f64::from(n_z));
        let mut sums = (0.0, 0.0, 0.0, 0.0);
        for i in 0..n_r {
            for k in 0..n_z {
                let (r, h) = ((f64::from(i) + 0.5) * dr, z.0 + (f64::from(k) + 0.5) * dz);
                if inside(r, h) {
                    let dm = 2.0 * PI * r * dr * dz;
                    sums.0 += dm;
                    sums.1 += dm * r * r;
                    sums.2 += dm * (0.5 * r * r + h * h);
                    sums.3 += dm * h;
                }
            }
        }
        sums
    }

    #[test]
    fn solids_of_revolution_agree_with_their_integrals() {
        let (r, l) = (0.3, 0.8);
        let cone = by_integration(|x, z| x < r * (0.75 * l - z) / l, r, (-0.25 * l, 0.75 * l));
        let capsule = by_integration(
            |x, z| {
                let over = (z.abs() - 0.5 * l).max(0.0);
                x * x + over * over < r * r
            },
            r,
            (-0.5 * l - r, 0.5 * l + r),
        );
        let torus = by_integration(|x, z| (x - l) * (x - l) + z * z < r * r, l + r, (-r, r));
        for (shape, (m, axial, transverse, moment)) in [
            (Shape::Cone { radius: r, length: l }, cone),
            (Shape::Capsule { radius: r, length: l }, capsule),
            (Shape::Torus { major_radius: l, tube_radius: r }, torus),
        ] {
            let p = shape.mass_properties(1.0);
            assert!((p.mass - m).abs() < 2e-3 * m, "{shape:?}");
            assert!((p.inertia[5] - axial).abs() < 2e-3 * axial, "{shape:?}");
            assert!((p.inertia[0] - transverse).abs() < 2e-3 * transverse, "{shape:?}");
            assert!(moment.abs() < 1e-3 * m * l, "{shape:?}");
        }
    }

    #[test]
    fn the_thesis_cylinder_weighs_what_the_thesis_says() {
        let p = Shape::Cylinder { radius: 0.05, length: 0.5 }.mass_properties(1000.0);
        assert!((p.mass - 3.926_991).abs() < 1e-6);
        // about the end, as in the thesis: 0.3297
        assert!((p.inertia[0] + p.mass * 0.0625 - 0.329_704).abs() < 1e-6);
    }
}
