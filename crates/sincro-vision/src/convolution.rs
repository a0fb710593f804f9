//! Convolutions with square kernels. At the border the kernel is cut, and the sum is scaled by its whole number of
//! entries over those that are left, as in CoppeliaSim.

use crate::{WorkImage, intensity};
use sincro_math::elementary::exp;

/// Kernel of edges: eight neighbours against the middle, 3 times.
const EDGES: [f64; 9] = [-3.0, -3.0, -3.0, -3.0, 24.0, -3.0, -3.0, -3.0, -3.0];

/// Standard deviation of the blur that CoppeliaSim takes where no kernel is given [pixels].
const DEVIATION: f64 = 2.0;

/// Kernel of a Gaussian blur with a standard deviation of two pixels, `side` × `side`; its sum is 1.
#[must_use]
pub fn gaussian(side: usize) -> Vec<f64> {
    let middle = 0.5 * (side as f64 - 1.0);
    let along = |k: usize| (k as f64 - middle) * (k as f64 - middle);
    let places = (0..side * side).map(|k| along(k % side) + along(k / side));
    let weights: Vec<f64> = places.map(|square| exp(-square / (2.0 * DEVIATION * DEVIATION)).0).collect();
    let total: f64 = weights.iter().sum();
    weights.into_iter().map(|weight| weight / total).collect()
}

impl WorkImage {
    /// Convolution with a square kernel of an odd side, row by row from the bottom.
    ///
    /// # Panics
    ///
    /// If the number of weights is no square of an odd number.
    pub fn convolve(&mut self, kernel: &[f64]) {
        let side = (1..=kernel.len()).step_by(2).find(|side| side * side == kernel.len()).expect("an odd square");
        let (reach, [columns, rows]) = (side / 2, self.size);
        let mut out = Vec::with_capacity(self.pixels.len());
        for row in 0..rows {
            for column in 0..columns {
                out.push(self.weighted(kernel, (side, reach), (column, row)));
            }
        }
        self.pixels = out;
    }

    fn weighted(&self, kernel: &[f64], (side, reach): (usize, usize), (column, row): (usize, usize)) -> [f64; 3] {
        let ([columns, rows], mut sum, mut n) = (self.size, [0.0; 3], 0_usize);
        for y in row.saturating_sub(reach)..(row + reach + 1).min(rows) {
            for x in column.saturating_sub(reach)..(column + reach + 1).min(columns) {
                let weight = kernel[x + reach - column + (y + reach - row) * side];
                let pixel = &self.pixels[x + y * columns];
                (0..3).for_each(|c| sum[c] += weight * pixel[c]);
                n += 1;
            }
        }
        let scale = kernel.len() as f64 / n as f64;
        sum.map(|x| x * scale)
    }

    /// Sharpens: the image and its difference from the mean of each neighbourhood of 3 × 3, clamped to 0 to 1.
    pub fn sharpen(&mut self) {
        let mut kernel = [-1.0 / 9.0; 9];
        kernel[4] += 2.0;
        self.convolve(&kernel);
        self.pixels.iter_mut().flatten().for_each(|x| *x = x.clamp(0.0, 1.0));
    }

    /// White where the intensity differs from that around it by more than `threshold`, measured with the kernel −3 … 24
    /// … −3, else black.
    pub fn detect_edges(&mut self, threshold: f64) {
        self.convolve(&EDGES);
        for pixel in &mut self.pixels {
            *pixel = [if intensity(pixel) > threshold { 1.0 } else { 0.0 }; 3];
        }
    }
}
