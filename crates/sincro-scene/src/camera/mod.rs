//! Pictures of a scene: what a camera sees, by rays that meet every surface where it really is. No part of a step.
//!
//! | file | has |
//! |---|---|
//! | `mod.rs` | [`Optics`]: how many pixels, which lens, from where to where |
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

pub use image::{Image, Layer, Part};
pub use render::{NO_PIECE, Renderer};

use sincro_math::elementary;

/// Most columns, and most rows, of a picture.
pub const MAX_SIDE: usize = 4096;
/// Most pixels of a picture: 4 Mi, which take 60 MB.
pub const MAX_PIXELS: usize = 1 << 22;
/// Default distance of the near clipping plane `[m]`.
pub const NEAR: f64 = 0.01;
/// Default distance of the far clipping plane `[m]`.
pub const FAR: f64 = 100.0;
/// Default background colour: red, green, blue, as in the viewer's page.
pub const BACKGROUND: [u8; 3] = [0xf7, 0xf8, 0xfa];
/// Farthest end of a picture, and largest height of an orthographic one `[m]`.
const MAX_LENGTH: f64 = 1e6;

/// Optics of a camera.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Optics {
    /// Columns and rows.
    pub resolution: [usize; 2],
    /// Distance along the camera's z at which the picture begins `[m]`.
    pub near: f64,
    /// Distance along the camera's z at which it ends `[m]`.
    pub far: f64,
    /// Projection.
    pub lens: Lens,
}

/// Projection of an image.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Lens {
    /// In the camera's origin; the angle between the upper and the lower edge `[rad]`.
    Perspective(f64),
    /// Nowhere: all are parallel to z; the height of the picture `[m]`.
    Orthographic(f64),
}

impl Optics {
    /// Half the height of the picture: at a distance of one metre, or anywhere, if it is orthographic `[m]`.
    #[must_use]
    pub fn half_height(&self) -> f64 {
        match self.lens {
            Lens::Perspective(angle) => elementary::tan(0.5 * angle).0,
            Lens::Orthographic(height) => 0.5 * height,
        }
    }

    /// Edge of a pixel, where [`Optics::half_height`] is measured `[m]`.
    #[must_use]
    pub fn pixel(&self) -> f64 {
        2.0 * self.half_height() / self.resolution[1] as f64
    }

    /// Width over height, but never less than one: V-REP's angles and sizes are those of the longer side.
    fn longer(&self) -> f64 {
        (self.resolution[0] as f64 / self.resolution[1] as f64).max(1.0)
    }

    /// Angle over the longer side of a perspective picture `[rad]`; 0 of an orthographic one.
    #[must_use]
    pub fn view_angle(&self) -> f64 {
        match self.lens {
            Lens::Perspective(_) => 2.0 * elementary::atan(self.half_height() * self.longer()).0,
            Lens::Orthographic(_) => 0.0,
        }
    }

    /// The longer side of an orthographic picture `[m]`; 0 of a perspective one.
    #[must_use]
    pub fn view_size(&self) -> f64 {
        match self.lens {
            Lens::Perspective(_) => 0.0,
            Lens::Orthographic(height) => height * self.longer(),
        }
    }

    /// These optics in perspective, with an angle over the longer side of the picture of `angle` `[rad]` (at most 3.1).
    #[must_use]
    pub fn with_view_angle(self, angle: f64) -> Self {
        let tall = elementary::tan(0.5 * angle.clamp(0.0, 3.1)).0 / self.longer();
        Self { lens: Lens::Perspective(2.0 * elementary::atan(tall).0), ..self }
    }

    /// These optics in orthographic projection, with `size` as the longer side of the picture `[m]`.
    #[must_use]
    pub fn with_view_size(self, size: f64) -> Self {
        Self { lens: Lens::Orthographic(size / self.longer()), ..self }
    }

    /// Checks that a picture can be rendered.
    ///
    /// # Errors
    ///
    /// What is wrong first.
    pub fn check(&self) -> Result<(), InvalidSetting> {
        self.invalid_settings().into_iter().next().map_or(Ok(()), Err)
    }

    /// Every setting that has no meaning, with its key and what was expected; empty if all are fine.
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

/// Invalid setting of a camera.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct InvalidSetting {
    /// The key of the scene file that says it.
    pub key: &'static str,
    /// Value found.
    pub found: String,
    /// Value expected.
    pub expected: String,
}
