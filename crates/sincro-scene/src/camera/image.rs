//! A picture: what each pixel shows, and parts of it as bytes.

use super::render::NO_PIECE;
use super::{BACKGROUND, Optics};

/// A picture, row by row from the bottom, each from left to right.
#[derive(Clone, Debug, PartialEq)]
pub struct Image {
    resolution: [usize; 2],
    near: f64,
    far: f64,
    /// Red, green, blue.
    pub(super) rgb: Vec<u8>,
    /// Along the camera's z `[m]`; `far` where nothing is.
    pub(super) depth: Vec<f64>,
    /// Index of the piece; [`NO_PIECE`] where there is none.
    pub(super) piece: Vec<u32>,
}

/// A rectangle of pixels.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Part {
    /// Column and row of its lower left corner.
    pub position: [usize; 2],
    /// Columns and rows.
    pub size: [usize; 2],
}

/// Pixel format of an image: grey (the mean of the three) or colours; with or without a byte of opacity.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Layer {
    /// One byte instead of three.
    pub is_grey: bool,
    /// One byte more: 255 up to this depth, 0 beyond it; 0 is where the picture begins, 1 where it ends.
    pub cut_off: Option<f64>,
}

impl Layer {
    /// Three bytes a pixel: red, green, blue.
    pub const RGB: Self = Self { is_grey: false, cut_off: None };
    /// One byte a pixel: intensity.
    pub const GREY: Self = Self { is_grey: true, cut_off: None };

    /// Number of bytes of a pixel.
    #[must_use]
    pub fn width(&self) -> usize {
        (if self.is_grey { 1 } else { 3 }) + usize::from(self.cut_off.is_some())
    }
}

impl Image {
    /// Creates an image of the resolution of `optics` that shows nothing but background.
    #[must_use]
    pub fn new(optics: &Optics) -> Self {
        let mut new =
            Self { resolution: [0; 2], near: 0.0, far: 1.0, rgb: Vec::new(), depth: Vec::new(), piece: Vec::new() };
        new.clear(optics, BACKGROUND);
        new
    }

    /// Makes it nothing but background; allocates only if it grows.
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

    /// Number of columns and of rows.
    #[must_use]
    pub fn resolution(&self) -> [usize; 2] {
        self.resolution
    }

    /// The part that is the whole image.
    #[must_use]
    pub fn whole(&self) -> Part {
        Part { position: [0; 2], size: self.resolution }
    }

    /// Returns true if a part lies in it, and is not empty.
    #[must_use]
    pub fn has(&self, part: &Part) -> bool {
        let fits = |k: usize| {
            let end = part.position[k].checked_add(part.size[k]);
            part.size[k] > 0 && end.is_some_and(|end| end <= self.resolution[k])
        };
        fits(0) && fits(1)
    }

    /// Colours of all pixels: red, green, blue.
    #[must_use]
    pub fn rgb(&self) -> &[u8] {
        &self.rgb
    }

    /// Depths of all pixels: along the camera's z `[m]`, where the picture ends if nothing is there.
    #[must_use]
    pub fn depth(&self) -> &[f64] {
        &self.depth
    }

    /// Which piece of the scenery each pixel shows, [`NO_PIECE`] if none.
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

    /// Bytes of a part, which lies in it.
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

    /// Depths of a part, which lies in it: `[m]`, or shares from where it begins, 0, to where it ends, 1.
    pub fn depths(&self, part: Part, in_metres: bool) -> impl Iterator<Item = f64> {
        let of = move |k: usize| if in_metres { self.depth[k] } else { self.share(self.depth[k]) };
        self.places(part).map(of)
    }

    /// Puts colours into a part, which lies in it; opacity is passed over, as V-REP does.
    ///
    /// # Panics
    ///
    /// There are fewer bytes than the part has.
    pub fn write(&mut self, part: Part, layer: Layer, bytes: &[u8]) {
        let places: Vec<usize> = self.places(part).collect();
        for (k, pixel) in places.into_iter().zip(bytes.chunks_exact(layer.width())) {
            let color = if layer.is_grey { [pixel[0]; 3] } else { [pixel[0], pixel[1], pixel[2]] };
            self.rgb[3 * k..3 * k + 3].copy_from_slice(&color);
        }
    }

    /// Least, greatest and mean of intensity, red, green, blue and depth, in this order, each dimensionless from 0 to
    /// 1.
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
pub(super) fn grey(pixel: &[u8]) -> u8 {
    ((u16::from(pixel[0]) + u16::from(pixel[1]) + u16::from(pixel[2])) / 3) as u8
}
