//! Pixels that have changed: what an event camera sees.

use crate::{WorkImage, intensity};

/// Pixel whose intensity has changed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ChangedPixel {
    /// True if it has become brighter.
    pub is_brighter: bool,
    /// Column and row.
    pub at: [usize; 2],
}

/// Intensity in place of none, where a change is relative to it.
const DARK: f64 = 0.001;

impl WorkImage {
    /// Compares the intensities with those of `before`, an image of the same size: pixels that differ by `threshold` or
    /// more of the intensity before are returned, white (brighter) or black, and `before` has their new intensity; all
    /// others become grey.
    pub fn changed_pixels(&mut self, before: &mut Self, threshold: f64) -> Vec<ChangedPixel> {
        let (columns, mut changed) = (self.size[0], Vec::new());
        for (k, (now, then)) in self.pixels.iter_mut().zip(&mut before.pixels).enumerate() {
            let (new, old) = (intensity(now), intensity(then));
            let base = if old == 0.0 { DARK } else { old };
            if (new - old).abs() / base >= threshold {
                let is_brighter = new > old;
                (*then, *now) = ([new; 3], [if is_brighter { 1.0 } else { 0.0 }; 3]);
                changed.push(ChangedPixel { is_brighter, at: [k % columns, k / columns] });
            } else {
                *now = [0.5; 3];
            }
        }
        changed
    }
}
