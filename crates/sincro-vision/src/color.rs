//! Colours: selection, segmentation, scales.
//!
//! Hue, saturation and lightness are numbers from 0 to 1; the hue is periodic: 0 and 1 are red.

use crate::{WorkImage, intensity};

/// Space in which colours are compared or changed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ColorSpace {
    /// Red, green, blue.
    Rgb,
    /// Hue, saturation, lightness.
    Hsl,
}

impl ColorSpace {
    fn of_rgb(self, rgb: [f64; 3]) -> [f64; 3] {
        if self == Self::Rgb { rgb } else { hsl_of(rgb) }
    }

    fn to_rgb(self, color: [f64; 3]) -> [f64; 3] {
        if self == Self::Rgb { color } else { rgb_of(color) }
    }
}

/// Hue, saturation and lightness of a colour; of grey the hue is 0.
fn hsl_of([r, g, b]: [f64; 3]) -> [f64; 3] {
    let (greatest, least) = (r.max(g).max(b), r.min(g).min(b));
    let (lightness, range) = (0.5 * (greatest + least), greatest - least);
    if range == 0.0 {
        return [0.0, 0.0, lightness];
    }
    let saturation = range / if lightness < 0.5 { greatest + least } else { 2.0 - greatest - least };
    let sextant = if r == greatest {
        (g - b) / range
    } else if g == greatest {
        2.0 + (b - r) / range
    } else {
        4.0 + (r - g) / range
    };
    let hue = sextant / 6.0;
    [if hue < 0.0 { hue + 1.0 } else { hue }, saturation, lightness]
}

/// Colour of hue, saturation and lightness.
fn rgb_of([hue, saturation, lightness]: [f64; 3]) -> [f64; 3] {
    let chroma = saturation * (1.0 - (2.0 * lightness - 1.0).abs());
    // distance of the hue from that of the component, on the circle, in sextants
    let component = |of: f64| {
        let away = ((hue - of).rem_euclid(1.0) - 0.5).abs();
        let share = (6.0 * away - 1.0).clamp(0.0, 1.0);
        lightness + chroma * (share - 0.5)
    };
    [component(0.0), component(1.0 / 3.0), component(2.0 / 3.0)]
}

/// Colour of an intensity: black, blue, red, yellow at 0, 1/3, 2/3, 1.
fn heat(intensity: f64) -> [f64; 3] {
    const COLORS: [[f64; 3]; 4] = [[0.0, 0.0, 0.0], [0.0, 0.0, 1.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0]];
    let at = 3.0 * intensity.clamp(0.0, 1.0);
    let k = (at as usize).min(2);
    let share = at - k as f64;
    [0, 1, 2].map(|c| COLORS[k][c] * (1.0 - share) + COLORS[k + 1][c] * share)
}

/// Result of [`WorkImage::segment_colors`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Segmentation {
    /// False if there are more colours than were allowed: nothing has changed.
    pub is_complete: bool,
    /// Comparisons of two colours that were made.
    pub n_comparisons: u64,
}

impl WorkImage {
    /// Blackens the pixels that do not have a colour within `tolerance` of each component, or, without `keeps`, those
    /// that have it; returns an image of what was removed.
    pub fn select_color(&mut self, color: [f64; 3], tolerance: [f64; 3], space: ColorSpace, keeps: bool) -> Self {
        let mut removed = Self::black(self.size);
        let is_near = |c: usize, x: f64| x >= color[c] - tolerance[c] && x <= color[c] + tolerance[c];
        for (own, other) in self.pixels.iter_mut().zip(&mut removed.pixels) {
            let of = space.of_rgb(*own);
            let is_first_near = match space {
                ColorSpace::Rgb => is_near(0, of[0]),
                // once around the circle in either direction
                ColorSpace::Hsl => [of[0] - 1.0, of[0], of[0] + 1.0].iter().any(|hue| is_near(0, *hue)),
            };
            if (is_first_near && is_near(1, of[1]) && is_near(2, of[2])) != keeps {
                std::mem::swap(own, other);
            }
        }
        removed
    }

    /// Replaces each colour by the first one met before that is less than `distance` away in the space of red, green
    /// and blue. At most `max_colors` colours are compared: if there are more, the image is as it was.
    #[must_use]
    pub fn segment_colors(&mut self, distance: f64, max_colors: usize) -> Segmentation {
        let (mut known, mut n_comparisons) = (Vec::<[f64; 3]>::new(), 0);
        let mut pixels = self.pixels.clone();
        for pixel in &mut pixels {
            let is_near = |color: &[f64; 3]| {
                let square: f64 = (0..3).map(|c| (color[c] - pixel[c]) * (color[c] - pixel[c])).sum();
                square < distance * distance
            };
            let found = known.iter().position(is_near);
            n_comparisons += found.map_or(known.len(), |k| k + 1) as u64;
            match found {
                Some(k) => *pixel = known[k],
                None if known.len() == max_colors => return Segmentation { is_complete: false, n_comparisons },
                None => known.push(*pixel),
            }
        }
        self.pixels = pixels;
        Segmentation { is_complete: true, n_comparisons }
    }

    /// Takes intensities from 0 to 1 to those from `start` to `end`, as grey or as colours from black over blue and
    /// red to yellow.
    pub fn scale_intensity(&mut self, start: f64, end: f64, is_grey: bool) {
        for pixel in &mut self.pixels {
            let scaled = start + (end - start) * intensity(pixel);
            *pixel = if is_grey { [scaled; 3] } else { heat(scaled) };
        }
    }

    /// Takes each component `x` of the colour space to `post + (x + pre) · scale`, clamped to 0 to 1.
    pub fn scale_and_offset(&mut self, pre: [f64; 3], scale: [f64; 3], post: [f64; 3], space: ColorSpace) {
        for pixel in &mut self.pixels {
            let of = space.of_rgb(*pixel);
            let scaled = [0, 1, 2].map(|c| (post[c] + (of[c] + pre[c]) * scale[c]).clamp(0.0, 1.0));
            *pixel = space.to_rgb(scaled);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn hue_saturation_and_lightness_give_their_color_back() {
        for r in 0..6 {
            for g in 0..6 {
                for b in 0..6 {
                    let color = [r, g, b].map(|x| f64::from(x) / 5.0);
                    let back = rgb_of(hsl_of(color));
                    assert!((0..3).all(|c| (back[c] - color[c]).abs() < 1e-12), "{color:?} → {back:?}");
                }
            }
        }
        assert_eq!(hsl_of([0.0, 1.0, 0.0]), [1.0 / 3.0, 1.0, 0.5]);
    }

    #[test]
    fn intensities_have_the_colors_of_heat() {
        assert_eq!(heat(-1.0), [0.0; 3]);
        assert_eq!(heat(0.5), [0.5, 0.0, 0.5]);
        assert_eq!(heat(2.0), [1.0, 1.0, 0.0]);
    }
}
