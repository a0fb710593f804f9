//! Blobs: connected components of the pixels above a threshold, each with the smallest rectangle around it.
//!
//! Pixels are connected to their eight neighbours; components are found in one pass by union-find, numbered by their
//! first pixels. The rectangle is searched over its angle, first in steps of 22.5°, then three times in a third of the
//! step before, two steps to either side: as in CoppeliaSim, so that angles agree to their last step.

use crate::{WorkImage, intensity};
use sincro_math::elementary::sin_cos;

/// Blob of an image, relative to the size of the image.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Blob {
    /// Number of its pixels relative to that of all.
    pub size: f64,
    /// Angle of its rectangle `[rad]`.
    pub angle: f64,
    /// Centre of its rectangle, from the lower left corner.
    pub center: [f64; 2],
    /// Width and height of its rectangle, between the middles of its outermost pixels.
    pub extent: [f64; 2],
}

/// Step of the first search for the angle of a rectangle `[rad]`.
const FIRST_STEP: f64 = std::f64::consts::PI / 8.0;

/// Colours of blobs, red, green, blue.
const COLORS: [[f64; 3]; 7] = [
    [1.0, 0.0, 0.0],
    [0.0, 1.0, 0.0],
    [1.0, 1.0, 0.0],
    [0.0, 0.0, 1.0],
    [1.0, 0.0, 1.0],
    [0.0, 1.0, 1.0],
    [1.0, 1.0, 1.0],
];

/// Component of each pixel; none below the threshold.
type Labels = Vec<Option<usize>>;

/// Representative of a component.
fn root(parents: &mut [usize], mut k: usize) -> usize {
    while parents[k] != k {
        parents[k] = parents[parents[k]];
        k = parents[k];
    }
    k
}

impl WorkImage {
    /// Connected components of the pixels whose intensity is at least `threshold`, and their number.
    fn components(&self, threshold: f64) -> (Labels, usize) {
        let [columns, _] = self.size;
        let mut parents: Vec<usize> = (0..self.pixels.len()).collect();
        let is_set: Vec<bool> = self.pixels.iter().map(|pixel| intensity(pixel) >= threshold).collect();
        for k in (0..is_set.len()).filter(|k| is_set[*k]) {
            let (is_left, is_right) = (k % columns == 0, k % columns == columns - 1);
            let neighbours = [
                (!is_left).then(|| k - 1),
                (!is_left).then(|| k.checked_sub(columns + 1)).flatten(),
                k.checked_sub(columns),
                (!is_right).then(|| k.checked_sub(columns - 1)).flatten().filter(|_| k >= columns),
            ];
            for neighbour in neighbours.into_iter().flatten().filter(|k| is_set[*k]) {
                let (a, b) = (root(&mut parents, k), root(&mut parents, neighbour));
                // the first pixel of a component stands for it
                parents[a.max(b)] = a.min(b);
            }
        }
        let (mut numbers, mut n) = (vec![None; is_set.len()], 0);
        for k in (0..is_set.len()).filter(|k| is_set[*k]) {
            let first = root(&mut parents, k);
            if first == k {
                numbers[k] = Some(n);
                n += 1;
            } else {
                numbers[k] = numbers[first];
            }
        }
        (numbers, n)
    }

    /// Blobs of the pixels whose intensity is at least `threshold`, those with a share of at least `min_size` of all
    /// pixels; the pixels of smaller ones become black.
    pub fn blobs(&mut self, threshold: f64, min_size: f64) -> Vec<Blob> {
        let (labels, n) = self.components(threshold);
        self.remove_small_and_measure(&labels, n, min_size)
    }

    /// As [`WorkImage::blobs`]; each component gets a colour of its own, and pixels below the threshold become black.
    pub fn colored_blobs(&mut self, threshold: f64, min_size: f64) -> Vec<Blob> {
        let (labels, n) = self.components(threshold);
        for (pixel, label) in self.pixels.iter_mut().zip(&labels) {
            *pixel = label.map_or([0.0; 3], |k| {
                let brightness = 0.8 - 0.2 * ((k / COLORS.len()) % 4) as f64;
                COLORS[k % COLORS.len()].map(|x| x * brightness)
            });
        }
        self.remove_small_and_measure(&labels, n, min_size)
    }

    fn remove_small_and_measure(&mut self, labels: &[Option<usize>], n: usize, min_size: f64) -> Vec<Blob> {
        let (mut counts, mut members) = (vec![0_usize; n], vec![Vec::new(); n]);
        for (k, label) in labels.iter().enumerate() {
            if let Some(label) = label {
                counts[*label] += 1;
                if self.is_border(labels, k) {
                    members[*label].push([(k % self.size[0]) as f64, (k / self.size[0]) as f64]);
                }
            }
        }
        let share = |label: usize| counts[label] as f64 / labels.len() as f64;
        for (pixel, label) in self.pixels.iter_mut().zip(labels) {
            if label.is_some_and(|label| share(label) < min_size) {
                *pixel = [0.0; 3];
            }
        }
        let large = (0..n).filter(|label| share(*label) >= min_size);
        large.map(|label| self.measure(share(label), &members[label])).collect()
    }

    /// True if a pixel of a component lies at the border of the image or beside one of none: the others are within
    /// the rectangle of these.
    fn is_border(&self, labels: &[Option<usize>], k: usize) -> bool {
        let ([columns, rows], [x, y]) = (self.size, [k % self.size[0], k / self.size[0]]);
        let is_outer = x == 0 || y == 0 || x + 1 == columns || y + 1 == rows;
        is_outer || [k - 1, k + 1, k - columns, k + columns].iter().any(|k| labels[*k].is_none())
    }

    fn measure(&self, size: f64, members: &[[f64; 2]]) -> Blob {
        let rectangle = smallest_rectangle(members);
        let [w, h] = self.size.map(|n| n as f64);
        // the middle of a pixel
        let center = [(rectangle.center[0] + 0.5) / w, (rectangle.center[1] + 0.5) / h];
        Blob { size, angle: -rectangle.angle, center, extent: [rectangle.sides[0] / w, rectangle.sides[1] / h] }
    }

    /// Draws the rectangle of a blob.
    pub fn draw_blob(&mut self, blob: &Blob, color: [f64; 3]) {
        let (sin, cos) = sin_cos(blob.angle);
        let [w, h] = self.size.map(|n| n as f64);
        let corner = |right: f64, up: f64| {
            let (x, y) = (0.5 * right * blob.extent[0], 0.5 * up * blob.extent[1]);
            [w * (blob.center[0] + x * cos - y * sin), h * (blob.center[1] + x * sin + y * cos)]
        };
        let corners = [corner(1.0, 1.0), corner(-1.0, 1.0), corner(-1.0, -1.0), corner(1.0, -1.0)];
        for k in 0..4 {
            self.draw_line(corners[k], corners[(k + 1) % 4], color);
        }
    }
}

/// Rectangle about points `[pixels]`.
#[derive(Clone, Copy, Debug)]
struct Rectangle {
    /// Angle by which the points were turned `[rad]`.
    angle: f64,
    sides: [f64; 2],
    center: [f64; 2],
}

impl Rectangle {
    fn at(angle: f64, points: &[[f64; 2]]) -> Self {
        let (sin, cos) = sin_cos(angle);
        let (mut low, mut high) = ([f64::INFINITY; 2], [f64::NEG_INFINITY; 2]);
        for [x, y] in points {
            let turned = [x * cos - y * sin, x * sin + y * cos];
            for axis in 0..2 {
                low[axis] = low[axis].min(turned[axis]);
                high[axis] = high[axis].max(turned[axis]);
            }
        }
        let middle = [0, 1].map(|axis| 0.5 * (low[axis] + high[axis]));
        let center = [middle[0] * cos + middle[1] * sin, middle[1] * cos - middle[0] * sin];
        Self { angle, sides: [high[0] - low[0], high[1] - low[1]], center }
    }

    fn area(&self) -> f64 {
        self.sides[0] * self.sides[1]
    }
}

fn smallest_rectangle(points: &[[f64; 2]]) -> Rectangle {
    let mut best = Rectangle::at(0.0, points);
    let mut step = FIRST_STEP;
    let take = |best: &mut Rectangle, angle: f64| {
        let other = Rectangle::at(angle, points);
        if other.area() < best.area() {
            *best = other;
        }
    };
    (1..4).for_each(|k| take(&mut best, step * f64::from(k)));
    for _ in 0..3 {
        step /= 3.0;
        let middle = best.angle;
        [-2.0, -1.0, 1.0, 2.0].into_iter().for_each(|k| take(&mut best, middle + step * k));
    }
    best
}
