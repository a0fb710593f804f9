//! Pictures of all directions, put together from those of six square vision sensors.
//!
//! A column of the picture is a direction about the vertical, a row one above or below the horizon, at equal steps from
//! −h/2 to h/2 and from −v/2 to v/2. The pixel at the angles (a, e) looks along (cos a · cos e, sin a · cos e, sin e):
//! the sensor whose axis that is closest to has the pixel. The sensors look ahead, up, back, down, to the left and to
//! the right, each over 90°, mounted as in CoppeliaSim's model of a spherical sensor: those that look up, back and down
//! are turned about their transverse axis.

use sincro_math::elementary::sin_cos;

/// Angles over a picture [rad]: the least one, and the largest ones across and up.
const LEAST: f64 = 5.0 * std::f64::consts::PI / 180.0;
const MOST: [f64; 2] = [2.0 * std::f64::consts::PI, std::f64::consts::PI];

/// Origin of a pixel of the picture.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Origin {
    /// Sensor that has it: ahead, up, back, down, left, right.
    pub sensor: usize,
    /// Pixel of that sensor, row by row.
    pub pixel: usize,
    /// Distance along the ray for a distance of 1 along the sensor's axis (dimensionless).
    pub stretch: f64,
}

/// Origins of the pixels of a picture of `size` columns and rows that spans some angles across and up `[rad]`, from
/// sensors of `side` columns and rows. Angles are at least 5°, at most 360° across and 180° up.
pub(crate) fn origins(size: [usize; 2], angles: [f64; 2], side: usize) -> Vec<Origin> {
    let angles = [0, 1].map(|k| angles[k].clamp(LEAST, MOST[k]));
    // one column or row looks ahead
    let at = |k: usize, i: usize| {
        if size[k] > 1 { angles[k] * (i as f64 / (size[k] - 1) as f64 - 0.5) } else { 0.0 }
    };
    let across: Vec<(f64, f64)> = (0..size[0]).map(|i| sin_cos(at(0, i))).collect();
    let mut origins = Vec::with_capacity(size[0] * size[1]);
    for j in 0..size[1] {
        let (sin_e, cos_e) = sin_cos(at(1, j));
        origins.extend(across.iter().map(|(sin_a, cos_a)| origin([cos_a * cos_e, sin_a * cos_e, sin_e], side)));
    }
    origins
}

/// Origin of the pixel that looks along a direction.
fn origin(direction: [f64; 3], side: usize) -> Origin {
    let [ax, ay, az] = direction.map(f64::abs);
    let largest = ax.max(ay).max(az);
    let [x, y, z] = direction.map(|d| d / largest);
    // column and row from −1 to 1
    let (sensor, u, v) = if ax >= ay && ax >= az {
        if x >= 0.0 { (0, -y, z) } else { (2, -y, -z) }
    } else if ay >= az {
        if y >= 0.0 { (4, x, z) } else { (5, -x, z) }
    } else if z >= 0.0 {
        (1, -y, -x)
    } else {
        (3, -y, x)
    };
    // what is less than half a pixel from the edge is of the first or last one
    let pixel = |w: f64| ((0.5 * (w + 1.0) * side as f64 - 0.5) as usize).min(side.saturating_sub(1));
    Origin { sensor, pixel: pixel(u) + side * pixel(v), stretch: (1.0 + u * u + v * v).sqrt() }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Sensors that the pixels of row `j` of the whole sphere come from.
    fn row(j: usize) -> Vec<usize> {
        origins([7, 5], MOST, 10)[7 * j..7 * (j + 1)].iter().map(|origin| origin.sensor).collect()
    }

    #[test]
    fn each_direction_is_seen_by_the_sensor_that_looks_there() {
        // from back over the right, ahead and the left to back again, by 60°
        assert_eq!(row(2), [2, 5, 5, 0, 4, 4, 2]);
        assert!(row(0).iter().all(|sensor| *sensor == 3) && row(4).iter().all(|sensor| *sensor == 1));
        let ahead = origins([1, 1], MOST, 11)[0];
        assert_eq!(ahead, Origin { sensor: 0, pixel: 5 + 11 * 5, stretch: 1.0 });
    }

    #[test]
    fn a_corner_of_a_sensor_is_farther_than_its_middle() {
        let angle = std::f64::consts::FRAC_PI_2;
        let corner = origins([2, 1], [angle, angle], 10)[0];
        assert!((corner.stretch - 2.0_f64.sqrt()).abs() < 1e-12, "{corner:?}");
        // a picture of 1° is one of 5°
        assert_eq!(origins([3, 1], [0.01, 1.0], 100), origins([3, 1], [LEAST, 1.0], 100));
    }
}
