//! A picture: what each pixel shows, and parts of it as bytes.

use crate::{BACKGROUND, Optics};

/// Piece index of a pixel that shows the background; see [`Image::pieces`].
pub const NO_PIECE: u32 = u32::MAX;

/// Image of a camera: colour, depth and visible piece of each pixel. Pixels are stored row by row from the bottom of
/// the picture, each row from left to right; pixel (column, row) has the index `row · columns + column`. Filled by
/// [`Renderer::draw`](crate::Renderer::draw).
#[derive(Clone, Debug, PartialEq)]
pub struct Image {
    resolution: [usize; 2],
    near: f64,
    far: f64,
    /// Red, green, blue.
    pub(crate) rgb: Vec<u8>,
    /// Along the camera's z `[m]`; `far` where nothing is.
    pub(crate) depth: Vec<f64>,
    /// Index of the piece; [`NO_PIECE`] where there is none.
    pub(crate) piece: Vec<u32>,
}

/// Rectangular part of an image, in pixels.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Part {
    /// Column and row of its lower left pixel, from 0; rows count from the bottom.
    pub position: [usize; 2],
    /// Numbers of columns and rows.
    pub size: [usize; 2],
}

/// Pixel format for the exchange of an image as bytes: grey (mean of red, green and blue) or colours, with or without a
/// byte of opacity.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Layer {
    /// True for one byte of intensity, false for three bytes: red, green, blue.
    pub is_grey: bool,
    /// With a byte of opacity behind them: 255 up to this depth, 0 beyond it. The depth is a share of the depth range:
    /// 0 at the near plane, 1 at the far plane.
    pub cut_off: Option<f64>,
}

impl Layer {
    /// Three bytes per pixel: red, green, blue.
    pub const RGB: Self = Self { is_grey: false, cut_off: None };
    /// One byte per pixel: intensity.
    pub const GREY: Self = Self { is_grey: true, cut_off: None };

    /// Returns the number of bytes per pixel, 1 to 4.
    #[must_use]
    pub fn width(&self) -> usize {
        (if self.is_grey { 1 } else { 3 }) + usize::from(self.cut_off.is_some())
    }
}

impl Image {
    /// Creates an image with the resolution and depth range of `optics` that shows the default background only.
    #[must_use]
    pub fn new(optics: &Optics) -> Self {
        let mut new =
            Self { resolution: [0; 2], near: 0.0, far: 1.0, rgb: Vec::new(), depth: Vec::new(), piece: Vec::new() };
        new.clear(optics, BACKGROUND);
        new
    }

    /// Sets all pixels to `background` (red, green, blue, 0 to 255) at the far plane, with the resolution and depth
    /// range of `optics`; allocates only if the image grows.
    pub fn clear(&mut self, optics: &Optics, background: [u8; 3]) {
        let n = optics.resolution[0] * optics.resolution[1];
        (self.resolution, self.near, self.far) = (optics.resolution, optics.near, optics.far);
        self.rgb.resize(3 * n, 0);
        for pixel in self.rgb.chunks_exact_mut(3) {
            pixel.copy_from_slice(&background);
        }
        self.depth.clear();
        self.depth.resize(n, optics.far);
        self.piece.clear();
        self.piece.resize(n, NO_PIECE);
    }

    /// Returns the numbers of columns and rows of pixels.
    #[must_use]
    pub fn resolution(&self) -> [usize; 2] {
        self.resolution
    }

    /// Returns the part that covers the whole image, for [`Image::bytes`] and the like.
    #[must_use]
    pub fn whole(&self) -> Part {
        Part { position: [0; 2], size: self.resolution }
    }

    /// Returns true if `part` lies inside the image and is not empty.
    #[must_use]
    pub fn has(&self, part: &Part) -> bool {
        let fits = |k: usize| {
            let end = part.position[k].checked_add(part.size[k]);
            part.size[k] > 0 && end.is_some_and(|end| end <= self.resolution[k])
        };
        fits(0) && fits(1)
    }

    /// Returns the colours of all pixels: red, green, blue (0 to 255) of each, `3 · columns · rows` bytes, row by row
    /// from the bottom of the picture, each row from left to right.
    #[must_use]
    pub fn rgb(&self) -> &[u8] {
        &self.rgb
    }

    /// Returns the depths of all pixels, `columns · rows` distances along the camera's z `[m]`, row by row from the
    /// bottom of the picture, each row from left to right; that of the far plane where nothing is.
    #[must_use]
    pub fn depth(&self) -> &[f64] {
        &self.depth
    }

    /// Returns the piece that each pixel shows, `columns · rows` indices into the list that was drawn ([`NO_PIECE`] for
    /// the background), row by row from the bottom of the picture, each row from left to right.
    #[must_use]
    pub fn pieces(&self) -> &[u32] {
        &self.piece
    }

    /// A depth as a share of the picture's: 0 where it begins, 1 where it ends.
    fn share(&self, depth: f64) -> f64 {
        (depth - self.near) / (self.far - self.near)
    }

    /// Places of the pixels of a part.
    fn places(&self, part: Part) -> impl Iterator<Item = usize> {
        let ([x, y], [w, h], columns) = (part.position, part.size, self.resolution[0]);
        (y..y + h).flat_map(move |row| row * columns + x..row * columns + x + w)
    }

    /// Returns the pixels of `part` in the format `layer`: `part.size[0] · part.size[1]` pixels of [`Layer::width`]
    /// bytes, row by row from the bottom, each row from left to right.
    ///
    /// # Panics
    ///
    /// If the part reaches beyond the last pixel. It must lie inside the image ([`Image::has`]); else pixels of other
    /// rows are read.
    #[must_use]
    pub fn bytes(&self, part: Part, layer: Layer) -> Vec<u8> {
        let mut bytes = Vec::with_capacity(layer.width() * part.size[0] * part.size[1]);
        for k in self.places(part) {
            let pixel = &self.rgb[3 * k..3 * k + 3];
            if layer.is_grey {
                bytes.push(grey(pixel));
            } else {
                bytes.extend_from_slice(pixel);
            }
            if let Some(cut_off) = layer.cut_off {
                bytes.push(if self.share(self.depth[k]) > cut_off { 0 } else { 255 });
            }
        }
        bytes
    }

    /// Returns the depths of the pixels of `part`, row by row from the bottom, each row from left to right: `[m]` along
    /// the camera's z if `in_metres`, else shares of the depth range, 0 at the near plane and 1 at the far plane.
    ///
    /// # Panics
    ///
    /// As [`Image::bytes`], when such a pixel is reached.
    pub fn depths(&self, part: Part, in_metres: bool) -> impl Iterator<Item = f64> {
        let of = move |k: usize| if in_metres { self.depth[k] } else { self.share(self.depth[k]) };
        self.places(part).map(of)
    }

    /// Writes bytes into the colours of `part`: pixels of [`Layer::width`] bytes in the format `layer`, row by row from
    /// the bottom, each row from left to right. Bytes of opacity are skipped, as in V-REP; depths stay. If there are
    /// fewer bytes than pixels, the rest of the part stays.
    ///
    /// # Panics
    ///
    /// As [`Image::bytes`].
    pub fn write(&mut self, part: Part, layer: Layer, bytes: &[u8]) {
        let places: Vec<usize> = self.places(part).collect();
        for (k, pixel) in places.into_iter().zip(bytes.chunks_exact(layer.width())) {
            let color = if layer.is_grey { [pixel[0]; 3] } else { [pixel[0], pixel[1], pixel[2]] };
            self.rgb[3 * k..3 * k + 3].copy_from_slice(&color);
        }
    }

    /// Returns statistics over all pixels: minima of intensity, red, green, blue and depth, then their maxima, then
    /// their means, each dimensionless from 0 to 1 (depth: 0 at the near plane, 1 at the far plane).
    #[must_use]
    pub fn statistics(&self) -> [f64; 15] {
        let n = self.depth.len() as f64;
        let (mut least, mut greatest, mut sum) = ([u32::MAX; 4], [0_u32; 4], [0_u64; 4]);
        for pixel in self.rgb.chunks_exact(3) {
            let [r, g, b] = [pixel[0], pixel[1], pixel[2]].map(u32::from);
            // three times the intensity, to stay whole
            for (c, x) in [r + g + b, r, g, b].into_iter().enumerate() {
                least[c] = least[c].min(x);
                greatest[c] = greatest[c].max(x);
                sum[c] += u64::from(x);
            }
        }
        let (mut near, mut far, mut total) = (f64::INFINITY, f64::NEG_INFINITY, 0.0);
        for depth in &self.depth {
            near = near.min(*depth);
            far = far.max(*depth);
            total += depth;
        }
        let scale = |c: usize, x: f64| x / if c == 0 { 765.0 } else { 255.0 };
        let mut out = [0.0; 15];
        for c in 0..4 {
            out[c] = scale(c, least[c].into());
            out[5 + c] = scale(c, greatest[c].into());
            out[10 + c] = scale(c, sum[c] as f64 / n);
        }
        [out[4], out[9], out[14]] = [near, far, total / n].map(|depth| self.share(depth));
        out
    }
}

/// The mean of red, green and blue, rounded down.
pub(crate) fn grey(pixel: &[u8]) -> u8 {
    ((u16::from(pixel[0]) + u16::from(pixel[1]) + u16::from(pixel[2])) / 3) as u8
}
