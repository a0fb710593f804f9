#![doc = include_str!("../README.md")]
//! # Pictures of surfaces
//!
//! No part of a step.
//!
//! | file | content |
//! |---|---|
//! | `lib.rs` | [`Optics`]: how many pixels, which lens, from where to where |
//! | `image.rs` | [`Image`]: colours, depths, and what is seen, pixel by pixel; parts of it as bytes |
//! | `render.rs` | [`Renderer`]: one piece after the other, nearest first, each in the rectangle that holds it |
//! | `bounds.rs` | the rectangle of a piece |
//! | `light.rs` | colours of lit surfaces |
//! | `png.rs` | pictures as PNG |
//!
//! A camera looks along z of its frame, y is up in the picture, so x points to the left. Pixels are counted as V-REP
//! counts them: row by row from the bottom, from left to right. A pixel is the ray through its middle. The same scene
//! gives the same bytes on every machine.

mod bounds;
mod image;
mod light;
pub mod png;
mod render;
#[cfg(test)]
mod tests;

pub use image::{Image, Layer, NO_PIECE, Part};
pub use render::{Renderer, VisiblePiece};

use sincro_math::elementary;

/// Most columns, and most rows, of a picture.
const MAX_SIDE: usize = 4096;
/// Upper limit of the number of pixels of an image: 4 Mi, which take 60 MB.
pub const MAX_PIXELS: usize = 1 << 22;
/// Default distance of the near plane along the camera's z `[m]`.
pub const NEAR: f64 = 0.01;
/// Default distance of the far plane along the camera's z `[m]`; nothing beyond it is seen.
pub const FAR: f64 = 100.0;
/// Default background colour, red, green, blue (0 to 255): that of the viewer.
pub const BACKGROUND: [u8; 3] = [0xf7, 0xf8, 0xfa];
/// Farthest end of a picture, and largest height of an orthographic one `[m]`.
const MAX_LENGTH: f64 = 1e6;

/// Optics of a camera: resolution, depth range and projection. The camera looks along z of its frame, y is up in the
/// image.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Optics {
    /// Numbers of columns and rows of pixels.
    pub resolution: [usize; 2],
    /// Distance of the near plane along the camera's z `[m]`; nothing before it is seen.
    pub near: f64,
    /// Distance of the far plane along the camera's z `[m]`; nothing beyond it is seen.
    pub far: f64,
    /// Projection with its field of view.
    pub lens: Lens,
}

/// Projection of a camera, with its field of view.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Lens {
    /// Perspective projection through the camera's origin; the angle between the upper and the lower edge of the image
    /// `[rad]`.
    Perspective(f64),
    /// Orthographic projection parallel to the camera's z; the height of the image `[m]`.
    Orthographic(f64),
}

impl Optics {
    /// Returns half the height of the image `[m]`: of a perspective one in the plane 1 m before the camera, of an
    /// orthographic one at any distance.
    #[must_use]
    pub fn half_height(&self) -> f64 {
        match self.lens {
            Lens::Perspective(angle) => elementary::tan(0.5 * angle).0,
            Lens::Orthographic(height) => 0.5 * height,
        }
    }

    /// Returns the edge length of a (square) pixel `[m]`, measured where [`Optics::half_height`] is.
    #[must_use]
    pub fn pixel(&self) -> f64 {
        2.0 * self.half_height() / self.resolution[1] as f64
    }

    /// Width over height, but never less than one: V-REP's angles and sizes are those of the longer side.
    fn longer(&self) -> f64 {
        (self.resolution[0] as f64 / self.resolution[1] as f64).max(1.0)
    }

    /// Returns the angle over the longer side of a perspective image `[rad]`; 0 of an orthographic one.
    #[must_use]
    pub fn view_angle(&self) -> f64 {
        match self.lens {
            Lens::Perspective(_) => 2.0 * elementary::atan(self.half_height() * self.longer()).0,
            Lens::Orthographic(_) => 0.0,
        }
    }

    /// Returns the length of the longer side of an orthographic image `[m]`; 0 of a perspective one.
    #[must_use]
    pub fn view_size(&self) -> f64 {
        match self.lens {
            Lens::Perspective(_) => 0.0,
            Lens::Orthographic(height) => height * self.longer(),
        }
    }

    /// Returns these optics in perspective projection with the angle `angle` over the longer side of the image `[rad]`,
    /// clamped to 0 to 3.1.
    #[must_use]
    pub fn with_view_angle(self, angle: f64) -> Self {
        let tall = elementary::tan(0.5 * angle.clamp(0.0, 3.1)).0 / self.longer();
        Self { lens: Lens::Perspective(2.0 * elementary::atan(tall).0), ..self }
    }

    /// Returns these optics in orthographic projection with the length `size` of the longer side of the image `[m]`.
    #[must_use]
    pub fn with_view_size(self, size: f64) -> Self {
        Self { lens: Lens::Orthographic(size / self.longer()), ..self }
    }

    /// Checks that an image can be rendered with these optics.
    ///
    /// # Errors
    ///
    /// The first of [`Optics::invalid_settings`].
    pub fn check(&self) -> Result<(), InvalidSetting> {
        self.invalid_settings().into_iter().next().map_or(Ok(()), Err)
    }

    /// Returns every invalid setting, in the order resolution, near plane, far plane, projection; empty if all are
    /// valid.
    #[must_use]
    pub fn invalid_settings(&self) -> Vec<InvalidSetting> {
        [self.wrong_resolution(), self.wrong_near(), self.wrong_far(), self.wrong_lens()]
            .into_iter()
            .flatten()
            .collect()
    }

    fn wrong_resolution(&self) -> Option<InvalidSetting> {
        let [columns, rows] = self.resolution;
        let sides = [columns, rows].iter().all(|n| (1..=MAX_SIDE).contains(n));
        (!sides || columns * rows > MAX_PIXELS).then(|| InvalidSetting {
            key: "resolution",
            found: format!("a resolution of {columns} × {rows} pixels"),
            expected: format!("1 to {MAX_SIDE} columns and rows, and at most {MAX_PIXELS} pixels in all"),
        })
    }

    fn wrong_near(&self) -> Option<InvalidSetting> {
        let fits = self.near > 0.0 && self.near < MAX_LENGTH;
        let found = || format!("a picture that begins at {} m", self.near);
        (!fits).then(|| InvalidSetting { key: "near", found: found(), expected: "more than 0 m".into() })
    }

    fn wrong_far(&self) -> Option<InvalidSetting> {
        let fits = self.far > self.near && self.far <= MAX_LENGTH;
        (!fits).then(|| InvalidSetting {
            key: "far",
            found: format!("a picture that ends at {} m", self.far),
            expected: format!("more than where it begins, {} m, and at most {MAX_LENGTH} m", self.near),
        })
    }

    fn wrong_lens(&self) -> Option<InvalidSetting> {
        match self.lens {
            Lens::Perspective(angle) if !(angle > 0.0 && angle < 170_f64.to_radians()) => Some(InvalidSetting {
                key: "field_of_view_deg",
                found: format!("a field of view of {:.4}°", angle.to_degrees()),
                expected: "more than 0° and less than 170° from the upper to the lower edge".into(),
            }),
            Lens::Orthographic(height) if !(height > 0.0 && height <= MAX_LENGTH) => Some(InvalidSetting {
                key: "orthographic_height",
                found: format!("a picture {height} m high"),
                expected: format!("more than 0 m and at most {MAX_LENGTH} m"),
            }),
            _ => None,
        }
    }
}

/// Invalid setting of a camera, for a message to the user; found by [`Optics::invalid_settings`].
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct InvalidSetting {
    /// Key of the scene file that gives it, such as `near`.
    pub key: &'static str,
    /// Value found, in words with its unit: `a field of view of 180°`.
    pub found: String,
    /// Values allowed, in words with their unit.
    pub expected: String,
}
