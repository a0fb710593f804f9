//! Image processing of vision sensors: the work image of CoppeliaSim's `simVision`.
//!
//! | file | has |
//! |---|---|
//! | `lib.rs` | [`WorkImage`]: colours of pixels, in and out of bytes |
//! | `arithmetic.rs` | sums, differences and products of images; normalization, flips, shifts, cuts |
//! | `color.rs` | selection by colour, segmentation, scales, hue-saturation-lightness |
//! | `convolution.rs` | 3 × 3 and 5 × 5 kernels: blur, sharpening, edges |
//! | `binary.rs` | threshold, and the moments of what is above it |
//! | `blobs.rs` | [`Blob`]: connected components with their smallest oriented rectangles |
//! | `changes.rs` | pixels that have changed since the last time |
//! | `pictures.rs` | pictures as bytes: turned over, scaled, as a bitmap |
//! | `picture_files.rs` | pictures from PNG and BMP files |
//! | `filters.rs` | the functions by name, on the sensors of a [`Sensors`]; [`for_filters!`] has their call tips |
//! | `points.rs` | [`DepthLens`]: points of a depth map, by rows and columns or by angles |
//! | `spherical.rs` | pictures of all directions, from those of six sensors |
//! | `textures.rs` | pictures that shapes are given |
//! | `work_images.rs` | [`WorkImages`]: a work image and its two buffers |
//!
//! An image has columns and rows; pixels are counted row by row from the bottom, each row from left to right. Colours
//! are red, green, blue from 0 to 1; intensity is their mean. What the functions compute, and the layout of what they
//! return, are those of CoppeliaSim's module; the algorithms are the textbook ones.

mod arithmetic;
mod binary;
mod blobs;
mod changes;
mod color;
mod convolution;
mod filters;
pub mod picture_files;
pub mod pictures;
mod points;
mod spherical;
pub mod textures;
mod work_images;

pub use binary::Moments;
pub use blobs::Blob;
pub use changes::ChangedPixel;
pub use color::{ColorSpace, Segmentation};
pub use convolution::gaussian;
pub use filters::{Sensors, call};
pub use points::{DepthLens, Sampling};
pub use work_images::WorkImages;

/// Image that filters work on: red, green and blue of each pixel, dimensionless, 0 to 1 unless a filter exceeds that.
#[derive(Clone, Debug, PartialEq)]
pub struct WorkImage {
    size: [usize; 2],
    pixels: Vec<[f64; 3]>,
}

impl WorkImage {
    /// Black image of `size` columns and rows.
    #[must_use]
    pub fn black(size: [usize; 2]) -> Self {
        Self { size, pixels: vec![[0.0; 3]; size[0] * size[1]] }
    }

    /// Image of `size` columns and rows from bytes: red, green, blue (0 to 255) of each pixel. Pixels for which there
    /// are no bytes are black.
    #[must_use]
    pub fn from_rgb(size: [usize; 2], bytes: &[u8]) -> Self {
        let mut image = Self::black(size);
        for (pixel, bytes) in image.pixels.iter_mut().zip(bytes.chunks_exact(3)) {
            *pixel = [bytes[0], bytes[1], bytes[2]].map(|x| f64::from(x) / 255.0);
        }
        image
    }

    /// Grey image of `size` columns and rows from intensities, such as depths (0 near plane, 1 far plane). Pixels for
    /// which there are none are black.
    #[must_use]
    pub fn from_intensities(size: [usize; 2], intensities: impl IntoIterator<Item = f64>) -> Self {
        let mut image = Self::black(size);
        for (pixel, x) in image.pixels.iter_mut().zip(intensities) {
            *pixel = [x; 3];
        }
        image
    }

    /// Numbers of columns and rows.
    #[must_use]
    pub fn size(&self) -> [usize; 2] {
        self.size
    }

    /// Colours of all pixels.
    #[must_use]
    pub fn pixels(&self) -> &[[f64; 3]] {
        &self.pixels
    }

    /// Colours of all pixels as bytes, red, green, blue (0 to 255, rounded, clamped).
    #[must_use]
    pub fn rgb(&self) -> Vec<u8> {
        self.pixels.iter().flatten().map(|x| (255.0 * x.clamp(0.0, 1.0) + 0.5) as u8).collect()
    }

    /// Draws a straight line between two pixels, columns and rows; what is outside is left out.
    pub fn draw_line(&mut self, from: [f64; 2], to: [f64; 2], color: [f64; 3]) {
        let length = (to[0] - from[0]).abs().max((to[1] - from[1]).abs());
        // lines of blobs are no longer than a few images
        let n = (length.min(65_536.0) as usize).max(1);
        for k in 0..=n {
            let share = k as f64 / n as f64;
            let at = [0, 1].map(|axis| (from[axis] + share * (to[axis] - from[axis])).floor());
            if (0..2).all(|axis| at[axis] >= 0.0 && at[axis] < self.size[axis] as f64) {
                self.pixels[at[0] as usize + at[1] as usize * self.size[0]] = color;
            }
        }
    }
}

/// Mean of red, green and blue.
fn intensity(pixel: &[f64; 3]) -> f64 {
    (pixel[0] + pixel[1] + pixel[2]) / 3.0
}
