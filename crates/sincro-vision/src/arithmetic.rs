//! Images with images, and what only moves or removes pixels.

use crate::WorkImage;

impl WorkImage {
    /// Combines each colour with that of another image of the same size; the result is clamped to 0 to 1.
    fn combine(&mut self, other: &Self, of: impl Fn(f64, f64) -> f64) {
        for (own, other) in self.pixels.iter_mut().zip(&other.pixels) {
            for c in 0..3 {
                own[c] = of(own[c], other[c]).clamp(0.0, 1.0);
            }
        }
    }

    /// Adds another image of the same size; sums are at most 1.
    pub fn add(&mut self, other: &Self) {
        self.combine(other, |a, b| a + b);
    }

    /// Subtracts another image of the same size; differences are at least 0.
    pub fn subtract(&mut self, other: &Self) {
        self.combine(other, |a, b| a - b);
    }

    /// Multiplies by another image of the same size.
    pub fn multiply(&mut self, other: &Self) {
        self.combine(other, |a, b| a * b);
    }

    /// Gives all pixels one colour.
    pub fn fill(&mut self, color: [f64; 3]) {
        self.pixels.fill(color);
    }

    /// Scales all colours so that the least component is 0 and the greatest 1; an image of one value stays.
    pub fn normalize(&mut self) {
        let all = || self.pixels.iter().flatten().copied();
        let (least, greatest) = (all().fold(1.0, f64::min), all().fold(0.0, f64::max));
        if greatest > least {
            self.pixels.iter_mut().flatten().for_each(|x| *x = (*x - least) / (greatest - least));
        }
    }

    /// Exchanges left and right.
    pub fn flip_horizontally(&mut self) {
        self.pixels.chunks_exact_mut(self.size[0].max(1)).for_each(<[_]>::reverse);
    }

    /// Exchanges top and bottom.
    pub fn flip_vertically(&mut self) {
        let columns = self.size[0].max(1);
        let rows: Vec<&[[f64; 3]]> = self.pixels.chunks_exact(columns).rev().collect();
        self.pixels = rows.concat();
    }

    /// Moves the image by shares of its size, to the right and upwards, rounded to whole pixels. What leaves it comes
    /// in at the other side if it `wraps`, else the pixels that become free are black.
    pub fn shift(&mut self, shift: [f64; 2], wraps: bool) {
        let [columns, rows] = self.size.map(|n| n as i64);
        let by = |k: usize| (shift[k].clamp(-1.0, 1.0) * self.size[k] as f64).round() as i64;
        let (right, up) = (by(0), by(1));
        let before = std::mem::take(&mut self.pixels);
        let source = |column: i64, row: i64| {
            let (x, y) = (column - right, row - up);
            let is_inside = (0..columns).contains(&x) && (0..rows).contains(&y);
            let k = x.rem_euclid(columns) + y.rem_euclid(rows) * columns;
            if is_inside || wraps { before[k as usize] } else { [0.0; 3] }
        };
        self.pixels = (0..rows)
            .flat_map(|row| (0..columns).map(move |column| (column, row)))
            .map(|(x, y)| source(x, y))
            .collect();
    }

    /// Blackens what is outside a circle about the middle, `radius` relative to half the shorter side; returns what
    /// was removed.
    pub fn cut_circle(&mut self, radius: f64) -> Self {
        let [w, h] = self.size.map(|n| n as f64);
        let limit = 0.5 * radius * w.min(h);
        self.split(|x, y| x * x + y * y <= limit * limit)
    }

    /// Blackens what is outside a rectangle about the middle, `sizes` relative to those of the image; returns what was
    /// removed.
    pub fn cut_rectangle(&mut self, sizes: [f64; 2]) -> Self {
        let [w, h] = [0, 1].map(|k| 0.5 * sizes[k] * self.size[k] as f64);
        self.split(|x, y| x.abs() <= w && y.abs() <= h)
    }

    /// Keeps the pixels that are wanted by their places from the middle, in pixels; returns an image of the others.
    fn split(&mut self, is_kept: impl Fn(f64, f64) -> bool) -> Self {
        let [columns, rows] = self.size;
        let middle = [0.5 * columns as f64, 0.5 * rows as f64];
        let mut removed = Self::black(self.size);
        for (k, (own, other)) in self.pixels.iter_mut().zip(&mut removed.pixels).enumerate() {
            let (x, y) = ((k % columns) as f64 + 0.5 - middle[0], (k / columns) as f64 + 0.5 - middle[1]);
            if !is_kept(x, y) {
                std::mem::swap(own, other);
            }
        }
        removed
    }
}
