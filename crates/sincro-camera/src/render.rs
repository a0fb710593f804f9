//! Draws pictures: pieces from near to far, each in its rectangle, one ray a pixel.
//!
//! For pixel (i, j) of w × h, s the edge of a pixel one metre ahead: u = (i + ½ − w/2) s to the right, v = (j + ½ −
//! h/2) s up. The ray of a perspective picture leaves the origin along a + u r + v o (ahead, right, up), that of an
//! orthographic one leaves the near plane along a. Surfaces are met where their closed forms say; depth is measured
//! along a. What lies before the near plane is cut away: a solid that it cuts is seen through, as from inside.

use std::sync::Arc;

use sincro_geometry::spatial::{Pose, Vec3};
use sincro_geometry::{Geometry, Hit, Ray};

use crate::bounds::{Extent, Rectangle};
use crate::light::Light;
use crate::{Image, Lens, Optics};

/// Solid or surface that a picture may show, with its colour and place.
#[derive(Clone, Copy, Debug)]
pub struct VisiblePiece<'a> {
    /// Geometry in the piece's own frame `[m]`.
    pub geometry: &'a Arc<Geometry>,
    /// Colour: red, green, blue, 0 to 255.
    pub color: [u8; 3],
    /// Pose of the piece's frame in the world `[m]`.
    pub pose: Pose<f64>,
}

/// Software renderer: draws pieces of a scene as a camera sees them. It keeps its buffers, and so should be used again
/// for the next image.
#[derive(Clone, Debug)]
pub struct Renderer {
    light: Light,
    /// Boxes of the pieces, and what they are boxes of.
    extents: Vec<(Arc<Geometry>, Extent)>,
    /// Pieces that can be seen.
    order: Vec<Seen>,
}

/// A piece that can be seen.
#[derive(Clone, Debug)]
struct Seen {
    /// Distance along the camera's z at which it begins `[m]`.
    begins: f64,
    /// Its place among all pieces.
    place: usize,
    /// The pixels that it can be in.
    rectangle: Rectangle,
    geometry: Arc<Geometry>,
    color: [u8; 3],
    x_wp: Pose<f64>,
}

impl Default for Renderer {
    fn default() -> Self {
        Self::new()
    }
}

impl Renderer {
    /// Creates a renderer; its buffers grow with the first image.
    #[must_use]
    pub fn new() -> Self {
        Self { light: Light::new(), extents: Vec::new(), order: Vec::new() }
    }

    /// Draws pieces into `image`, whose former content is lost: `x_wc` is the camera's pose in the world `[m]` (it
    /// looks along its z, y up). Pixels without a piece get the colour `background` (red, green, blue, 0 to 255). Piece
    /// indices in the image count the iterator's items from 0.
    pub fn draw<'p>(
        &mut self,
        pieces: impl Iterator<Item = VisiblePiece<'p>>,
        (x_wc, optics): (&Pose<f64>, &Optics),
        background: [u8; 3],
        image: &mut Image,
    ) {
        image.clear(optics, background);
        self.sort(pieces, x_wc, optics);
        for seen in &self.order {
            let (color, piece) = (self.light.linear(seen.color), seen.place as u32);
            let view = View::new(&seen.geometry, &seen.x_wp, x_wc, optics);
            view.paint(seen.rectangle, &mut Canvas { light: &self.light, color, piece, x_wp: &seen.x_wp, image });
        }
        // nothing that is removed is kept
        self.order.clear();
    }

    /// The pieces that can be seen, the nearest first: what is behind them is often not painted then.
    fn sort<'p>(&mut self, pieces: impl Iterator<Item = VisiblePiece<'p>>, x_wc: &Pose<f64>, optics: &Optics) {
        let x_cw = x_wc.inverse();
        self.order.clear();
        for (place, VisiblePiece { geometry, color, pose: x_wp }) in pieces.enumerate() {
            let extent = self.extent(place, geometry);
            let x_cp = x_cw.compose(&x_wp);
            let reach = geometry.reach();
            let begins = if reach.is_finite() { x_cp.pos[2] - reach } else { f64::MAX };
            // behind, or beyond the end
            if reach.is_finite() && (x_cp.pos[2] + reach < optics.near || begins > optics.far) {
                continue;
            }
            if let Some(rectangle) = extent.rectangle(&x_cp, optics) {
                let geometry = geometry.clone();
                self.order.push(Seen { begins, place, rectangle, geometry, color, x_wp });
            }
        }
        self.order.sort_unstable_by(|a, b| a.begins.total_cmp(&b.begins).then(a.place.cmp(&b.place)));
    }

    /// The box of piece `k`, made once.
    fn extent(&mut self, k: usize, geometry: &Arc<Geometry>) -> Extent {
        match self.extents.get(k) {
            Some((known, extent)) if Arc::ptr_eq(known, geometry) => *extent,
            known => {
                let is_new = known.is_none();
                let entry = (geometry.clone(), Extent::of(geometry.surface()));
                let extent = entry.1;
                if is_new {
                    self.extents.push(entry);
                } else {
                    self.extents[k] = entry;
                }
                extent
            }
        }
    }
}

/// Image and depth buffer into which a piece is rendered.
struct Canvas<'a> {
    light: &'a Light,
    color: [f64; 3],
    piece: u32,
    x_wp: &'a Pose<f64>,
    image: &'a mut Image,
}

impl Canvas<'_> {
    /// A pixel shows the piece; the normal and the way of looking are in its axes.
    #[inline(always)]
    fn put(&mut self, place: usize, depth: f64, normal: Vec3<f64>, direction: Vec3<f64>) {
        // an open surface is lit on both sides
        let towards = if normal.dot(direction) > 0.0 { -normal } else { normal };
        let color = self.light.shade(&self.color, self.x_wp.rot.mul_vec(towards));
        self.image.depth[place] = depth;
        self.image.piece[place] = self.piece;
        self.image.rgb[3 * place..3 * place + 3].copy_from_slice(&color);
    }
}

/// A camera as a piece sees it: everything in the piece's axes.
struct View<'a> {
    geometry: &'a Geometry,
    optics: &'a Optics,
    origin: Vec3<f64>,
    right: Vec3<f64>,
    up: Vec3<f64>,
    ahead: Vec3<f64>,
    pixel: f64,
}

impl<'a> View<'a> {
    fn new(geometry: &'a Geometry, x_wp: &Pose<f64>, x_wc: &Pose<f64>, optics: &'a Optics) -> Self {
        let x_pc = x_wp.inverse().compose(x_wc);
        Self {
            geometry,
            optics,
            origin: x_pc.pos,
            right: -x_pc.rot.col(0),
            up: x_pc.rot.col(1),
            ahead: x_pc.rot.col(2),
            pixel: optics.pixel(),
        }
    }

    fn paint(&self, rectangle: Rectangle, canvas: &mut Canvas<'_>) {
        match self.optics.lens {
            Lens::Perspective(_) => self.paint_perspective(rectangle, canvas),
            Lens::Orthographic(_) => self.paint_orthographic(rectangle, canvas),
        }
    }

    /// Distance of the middle of a pixel from that of the picture.
    fn middle(&self, k: usize, n: usize) -> f64 {
        (k as f64 + 0.5 - 0.5 * n as f64) * self.pixel
    }

    fn paint_perspective(&self, rectangle: Rectangle, canvas: &mut Canvas<'_>) {
        let [columns, rows] = self.optics.resolution;
        for j in rectangle.rows.0..rectangle.rows.1 {
            let v = self.middle(j, rows);
            let row = self.ahead + self.up.scale(v);
            for i in rectangle.columns.0..rectangle.columns.1 {
                let (u, place) = (self.middle(i, columns), j * columns + i);
                let length = (1.0 + u * u + v * v).sqrt();
                let direction = (row + self.right.scale(u)).scale(1.0 / length);
                let ray = Ray { origin: self.origin, direction };
                let most = canvas.image.depth[place] * length;
                if let Some(hit) = self.beyond_near(&ray, most, self.optics.near * length) {
                    let depth = hit.distance / length;
                    if depth < canvas.image.depth[place] {
                        canvas.put(place, depth, hit.normal, direction);
                    }
                }
            }
        }
    }

    fn paint_orthographic(&self, rectangle: Rectangle, canvas: &mut Canvas<'_>) {
        let [columns, rows] = self.optics.resolution;
        let near = self.optics.near;
        for j in rectangle.rows.0..rectangle.rows.1 {
            let row = self.origin + self.up.scale(self.middle(j, rows)) + self.ahead.scale(near);
            for i in rectangle.columns.0..rectangle.columns.1 {
                let place = j * columns + i;
                let origin = row + self.right.scale(self.middle(i, columns));
                let ray = Ray { origin, direction: self.ahead };
                if let Some(hit) = self.geometry.cast_ray(&ray, canvas.image.depth[place] - near) {
                    let depth = near + hit.distance;
                    if depth < canvas.image.depth[place] {
                        canvas.put(place, depth, hit.normal, self.ahead);
                    }
                }
            }
        }
    }

    /// First intersection of a ray beyond a distance.
    #[inline]
    fn beyond_near(&self, ray: &Ray, most: f64, near: f64) -> Option<Hit> {
        let hit = self.geometry.cast_ray(ray, most)?;
        if hit.distance >= near {
            return Some(hit);
        }
        let later = Ray { origin: ray.at(near), direction: ray.direction };
        let hit = self.geometry.cast_ray(&later, most - near)?;
        Some(Hit { distance: hit.distance + near, ..hit })
    }
}
