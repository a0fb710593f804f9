//! Points of a depth map: where the rays through its pixels end, in the frame of the sensor.
//!
//! The sensor looks along its z, y is up in the image, x points to the left. Intensities are depths along z: 0 at the
//! near plane, 1 at the far plane. Points beyond the far distance, measured along the ray, are brought to it.

use crate::{WorkImage, intensity};
use sincro_math::elementary::{atan, sin_cos, tan};

/// Lens of a sensor whose depths are turned into points.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DepthLens {
    /// Depth of intensity 0 `[m]`.
    pub near: f64,
    /// Depth of intensity 1 `[m]`.
    pub far: f64,
    /// Half width and half height of what is seen: 1 m before the sensor in perspective, everywhere else.
    pub half: [f64; 2],
    /// True for a perspective projection, false for a parallel one.
    pub is_perspective: bool,
}

/// Arrangement of points.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Sampling {
    /// Rows of points at equal distances in the image.
    Grid,
    /// Rows of points at equal angles; of a parallel projection as [`Sampling::Grid`].
    Angles,
    /// Columns of a lidar: each at one angle about y, its points at equal angles of elevation, which span this angle
    /// `[rad]` in all.
    Scan(f64),
}

/// Places from −`half` to `half`; one place is the middle.
fn places(n: usize, half: f64) -> impl Iterator<Item = f64> {
    (0..n).map(move |k| if n > 1 { half * (2.0 * k as f64 / (n - 1) as f64 - 1.0) } else { 0.0 })
}

/// Pixel of a place from −1 to 1, of `n`.
fn pixel(place: f64, n: usize) -> usize {
    let at = 0.5 * (1.0 + place) * (n as f64 - 0.5);
    (at.max(0.0) as usize).min(n - 1)
}

impl WorkImage {
    /// Points of a depth map, `counts` columns and rows of them: x, y, z and the distance `[m]`, and the pixel that
    /// each was read from. Rows begin at the bottom, each at its right end, where x is least; scans give column by
    /// column.
    #[must_use]
    pub fn points(
        &self,
        lens: &DepthLens,
        [n_columns, n_rows]: [usize; 2],
        sampling: Sampling,
    ) -> Vec<([f64; 4], usize)> {
        let mut points = Vec::with_capacity(n_columns * n_rows);
        let angles = lens.half.map(|half| atan(half).0);
        match sampling {
            Sampling::Scan(elevation) if lens.is_perspective => {
                for azimuth in places(n_columns, angles[0]) {
                    let (x, away) = (tan(azimuth).0, 1.0 / sin_cos(azimuth).1);
                    points.extend(places(n_rows, 0.5 * elevation).map(|y| self.point(lens, [x, tan(y).0 * away])));
                }
            }
            Sampling::Angles if lens.is_perspective => {
                for y in places(n_rows, angles[1]).map(|angle| tan(angle).0) {
                    points.extend(places(n_columns, angles[0]).map(|x| self.point(lens, [tan(x).0, y])));
                }
            }
            _ => {
                for y in places(n_rows, lens.half[1]) {
                    points.extend(places(n_columns, lens.half[0]).map(|x| self.point(lens, [x, y])));
                }
            }
        }
        points
    }

    /// Point of the ray through a place of what is seen.
    fn point(&self, lens: &DepthLens, [x, y]: [f64; 2]) -> ([f64; 4], usize) {
        let [columns, rows] = self.size;
        let k = pixel(-x / lens.half[0], columns) + pixel(y / lens.half[1], rows) * columns;
        let z = lens.near + intensity(&self.pixels[k]) * (lens.far - lens.near);
        if !lens.is_perspective {
            return ([x, y, z, z], k);
        }
        let at = [x * z, y * z, z];
        let distance = at.iter().map(|x| x * x).sum::<f64>().sqrt();
        let scale = if distance > lens.far { lens.far / distance } else { 1.0 };
        ([at[0] * scale, at[1] * scale, at[2] * scale, distance.min(lens.far)], k)
    }
}
