//! Colours of lit surfaces, as the page has them: one sun and a sky, surfaces without gloss, no shadows.
//!
//! Light is added up in linear measure: a colour c (sRGB) in the light E gives the linear colour c E/π (Lambert),
//! written as sRGB again.

use sincro_geometry::spatial::Vec3;
use sincro_math::elementary;

/// From where the sun shines, not normalised; and how strong, as the page has it.
const SUN: ([f64; 3], f64) = ([0.5, -0.7, 1.6], 2.1);
/// Intensity of the sky, which is white on the side of the world's y; the opposite side has a grey of this linear
/// measure (`#8d939c`). The page's light lies so.
const SKY: (f64, [f64; 3]) = (1.5, [0.266_356, 0.291_771, 0.332_452]);

/// Steps of the table from linear measure to bytes.
const STEPS: usize = 4096;

/// The light, with tables between bytes and linear measure.
#[derive(Clone, Debug)]
pub(crate) struct Light {
    sun: Vec3<f64>,
    linear: Vec<f64>,
    bytes: Vec<u8>,
}

impl Light {
    pub fn new() -> Self {
        let sun = Vec3(SUN.0);
        let linear = |byte: usize| {
            let x = byte as f64 / 255.0;
            if x <= 0.04045 { x / 12.92 } else { elementary::pow((x + 0.055) / 1.055, 2.4).0 }
        };
        let byte = |step: usize| {
            let x = step as f64 / STEPS as f64;
            let y = if x <= 0.003_130_8 { 12.92 * x } else { 1.055 * elementary::pow(x, 1.0 / 2.4).0 - 0.055 };
            (255.0 * y + 0.5) as u8
        };
        Self {
            sun: sun.scale(1.0 / sun.norm()),
            linear: (0..256).map(linear).collect(),
            bytes: (0..=STEPS).map(byte).collect(),
        }
    }

    /// A colour in linear measure.
    pub fn linear(&self, color: [u8; 3]) -> [f64; 3] {
        color.map(|byte| self.linear[usize::from(byte)])
    }

    /// A surface of a colour (linear) and a normal of length one in the world.
    #[inline]
    pub fn shade(&self, color: &[f64; 3], normal: Vec3<f64>) -> [u8; 3] {
        let sun = SUN.1 * normal.dot(self.sun).max(0.0);
        let share = 0.5 + 0.5 * normal[1];
        std::array::from_fn(|c| {
            let (strength, grey) = (SKY.0, SKY.1[c]);
            let light = sun + strength * (grey + (1.0 - grey) * share);
            let step = color[c] * light * (STEPS as f64 * std::f64::consts::FRAC_1_PI) + 0.5;
            // a signed number, which processors convert to at once
            self.bytes[(step as i32 as usize).min(STEPS)]
        })
    }
}
