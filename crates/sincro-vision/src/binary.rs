//! Threshold of an image, and the moments of what is above it.
//!
//! With the second moments `a = Σ x²`, `b = 2 Σ x y`, `c = Σ y²` about the centre, the axis of the least moment of
//! inertia is at the angle `θ = ½ atan2(b, a − c)`; the roundness is the least moment over the greatest one.

use crate::{WorkImage, intensity};
use sincro_math::elementary::atan2;

/// Moments of the pixels above a threshold.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Moments {
    /// Their number relative to that of all.
    pub proportion: f64,
    /// Their centre, relative to the size of the image.
    pub center: [f64; 2],
    /// Angle of their longer axis from the row, −π/2 to π/2 `[rad]`.
    pub angle: f64,
    /// Least moment of inertia over the greatest one: 0 a line, 1 round.
    pub roundness: f64,
}

impl WorkImage {
    /// Makes pixels whose intensity is at least `threshold` white, the others black; returns the moments of the white
    /// ones.
    pub fn binarize(&mut self, threshold: f64) -> Moments {
        let ([columns, rows], mut white) = (self.size, Vec::new());
        for (k, pixel) in self.pixels.iter_mut().enumerate() {
            let is_white = intensity(pixel) >= threshold;
            *pixel = [if is_white { 1.0 } else { 0.0 }; 3];
            if is_white {
                white.push([(k % columns) as f64, (k / columns) as f64]);
            }
        }
        let (size, n) = ([columns as f64, rows as f64], white.len() as f64);
        if white.is_empty() {
            // as CoppeliaSim has it
            return Moments { proportion: 0.0, center: size.map(|n| 0.5 / n), angle: 0.0, roundness: 1.0 };
        }
        let middle = [0, 1].map(|axis| white.iter().map(|at| at[axis]).sum::<f64>() / n);
        let (mut a, mut b, mut c) = (0.0, 0.0, 0.0);
        for at in &white {
            let (x, y) = (at[0] - middle[0], at[1] - middle[1]);
            (a, b, c) = (a + x * x, b + 2.0 * x * y, c + y * y);
        }
        let difference = (b * b + (a - c) * (a - c)).sqrt();
        let is_round = difference == 0.0;
        Moments {
            proportion: n / (size[0] * size[1]),
            center: [middle[0] / size[0], middle[1] / size[1]],
            angle: if is_round { 0.0 } else { 0.5 * atan2(b, a - c).0 },
            roundness: if is_round { 1.0 } else { (a + c - difference) / (a + c + difference) },
        }
    }
}
