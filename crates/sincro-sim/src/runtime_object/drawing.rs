//! Drawings that clients and scripts make at run time: points, lines, triangles and particles. Nothing in a run depends
//! on them.

use std::collections::HashMap;

use sincro_dynamics::spatial::Vec3;

/// Figure that each item of a [`Drawing`] is drawn as.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum DrawingKind {
    /// Point: one position.
    Points,
    /// Ball: one position.
    Balls,
    /// Line from the first position to the second.
    Lines,
    /// Line through the positions of all items, in their order: one position each.
    LineStrip,
    /// Triangle of three positions.
    Triangles,
    /// Particle: position and velocity at the time at which it was added, and that time.
    Particles,
}

impl DrawingKind {
    /// Name, as the page knows it.
    #[must_use]
    pub fn word(self) -> &'static str {
        match self {
            Self::Points => "points",
            Self::Balls => "balls",
            Self::Lines => "lines",
            Self::LineStrip => "line_strip",
            Self::Triangles => "triangles",
            Self::Particles => "particles",
        }
    }

    /// Number of entries of an item: positions `[m]`, of a particle also velocity `[m/s]` and time `[s]`.
    #[must_use]
    pub fn width(self) -> usize {
        match self {
            Self::Points | Self::Balls | Self::LineStrip => 3,
            Self::Lines => 6,
            Self::Triangles => 9,
            Self::Particles => 7,
        }
    }
}

/// Look of a [`Drawing`]: everything but its items.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DrawingStyle {
    /// Figure of an item.
    pub kind: DrawingKind,
    /// Diameter of a ball or particle `[m]`, of a point `[pixel]`, or width of a line `[pixel]`.
    pub size: f64,
    /// Colour: red, green, blue, 0 to 255.
    pub color: [u8; 3],
    /// Time for which a particle is seen `[s]`.
    pub lifetime: f64,
    /// True if particles fall with the gravity of the world.
    pub falls: bool,
}

/// Drawing made at run time: a bounded list of items of one kind, in the frame of what carries it.
///
/// ```
/// use sincro_sim::runtime_object::{Drawing, DrawingKind, DrawingStyle};
///
/// let style = DrawingStyle { kind: DrawingKind::Points, size: 2.0, color: [255, 0, 0], lifetime: 0.0, falls: false };
/// let mut path = Drawing::new(style, 2, true, 0.0); // the last two points
/// for x in [0.0, 0.1, 0.2] {
///     assert!(path.push(&[x, 0.0, 0.0]));
/// }
/// assert_eq!(path.n_items(), 2);
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Drawing {
    /// Look of its items.
    pub style: DrawingStyle,
    /// Number of items that it may have.
    capacity: usize,
    /// True if a new item takes the place of the oldest one when it is full.
    is_cyclic: bool,
    /// Distance up to which an item is the same as another one `[m]`; 0: none is.
    tolerance: f64,
    /// Items by the cell of space that they are in, as large as the tolerance.
    cells: HashMap<[i64; 3], Vec<usize>>,
    items: Vec<f32>,
    /// Number of items written since it was cleared.
    n_written: u64,
    /// Number of times that it was cleared.
    n_cleared: u64,
}

impl Drawing {
    /// Creates an empty drawing of at most `capacity` items. When it is full a new item replaces the oldest one if
    /// `is_cyclic`, or if that is a particle whose time is over, else it is not taken; nor is one within `tolerance`
    /// `[m]` of another one, unless that is 0.
    #[must_use]
    pub fn new(style: DrawingStyle, capacity: usize, is_cyclic: bool, tolerance: f64) -> Self {
        let (cells, items) = (HashMap::new(), Vec::new());
        Self { style, capacity, is_cyclic, tolerance, cells, items, n_written: 0, n_cleared: 0 }
    }

    /// Adds an item of [`DrawingKind::width`] entries. Returns false if it is not taken.
    ///
    /// # Panics
    ///
    /// If the item has another number of entries.
    pub fn push(&mut self, item: &[f64]) -> bool {
        let width = self.style.kind.width();
        assert_eq!(item.len(), width, "an item of {}", self.style.kind.word());
        if self.capacity == 0 {
            return false;
        }
        let index = (self.n_written % self.capacity as u64) as usize;
        let is_full = self.is_full();
        if is_full && !self.is_cyclic && !self.is_over(index, item) {
            return false;
        }
        if self.tolerance > 0.0 {
            let first = Vec3([item[0], item[1], item[2]]);
            if self.has_near(first) {
                return false;
            }
            if is_full {
                let old = self.cell(self.position(index));
                if let Some(list) = self.cells.get_mut(&old) {
                    list.retain(|known| *known != index);
                }
            }
            let cell = self.cell(first);
            self.cells.entry(cell).or_default().push(index);
        }
        let numbers = item.iter().map(|x| *x as f32);
        if index * width == self.items.len() {
            self.items.extend(numbers);
        } else {
            self.items[index * width..][..width].iter_mut().zip(numbers).for_each(|(old, new)| *old = new);
        }
        self.n_written += 1;
        true
    }

    /// Removes all items.
    pub fn clear(&mut self) {
        self.items.clear();
        self.cells.clear();
        self.n_written = 0;
        self.n_cleared += 1;
    }

    /// Returns the number of its items.
    #[must_use]
    pub fn n_items(&self) -> usize {
        self.items.len() / self.style.kind.width()
    }

    /// Returns true if there is no room: a new item is not taken, or takes the place of another one.
    #[must_use]
    pub fn is_full(&self) -> bool {
        self.n_written >= self.capacity as u64
    }

    /// True if the time of a particle is over when a new one is added.
    fn is_over(&self, index: usize, new: &[f64]) -> bool {
        let time = self.style.kind.width() - 1;
        self.style.kind == DrawingKind::Particles
            && f64::from(self.items[index * (time + 1) + time]) + self.style.lifetime <= new[time]
    }

    /// First position of an item.
    fn position(&self, index: usize) -> Vec3<f64> {
        Vec3([0, 1, 2].map(|k| f64::from(self.items[index * self.style.kind.width() + k])))
    }

    fn cell(&self, position: Vec3<f64>) -> [i64; 3] {
        // too far away for whole numbers is the last cell
        position.0.map(|x| (x / self.tolerance).floor() as i64)
    }

    fn has_near(&self, position: Vec3<f64>) -> bool {
        let [x, y, z] = self.cell(position);
        let is_near = |index: &usize| (self.position(*index) - position).norm() <= self.tolerance;
        let around = |k: i64| [k.saturating_sub(1), k, k.saturating_add(1)];
        around(x).into_iter().any(|x| {
            around(y).into_iter().any(|y| {
                around(z).into_iter().any(|z| self.cells.get(&[x, y, z]).is_some_and(|list| list.iter().any(is_near)))
            })
        })
    }

    /// Number of clearings, and of items written since the last.
    pub(crate) fn version(&self) -> (u64, u64) {
        (self.n_cleared, self.n_written)
    }

    /// Items that were written since there were `n_written`, as stretches: index of the first, and entries.
    pub(crate) fn since(&self, n_written: u64) -> Vec<(usize, &[f32])> {
        let (width, n) = (self.style.kind.width(), self.n_items());
        let new = self.n_written.saturating_sub(n_written).min(n as u64) as usize;
        if new == 0 {
            return Vec::new();
        }
        let first = ((self.n_written - new as u64) % self.capacity as u64) as usize;
        let before_end = new.min(n - first);
        let stretch = |from: usize, n: usize| (from, &self.items[from * width..(from + n) * width]);
        let mut all = vec![stretch(first, before_end)];
        if new > before_end {
            all.push(stretch(0, new - before_end));
        }
        all
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn drawing(kind: DrawingKind, capacity: usize, is_cyclic: bool, tolerance: f64) -> Drawing {
        let style = DrawingStyle { kind, size: 0.01, color: [0; 3], lifetime: 1.0, falls: false };
        Drawing::new(style, capacity, is_cyclic, tolerance)
    }

    fn points(capacity: usize, is_cyclic: bool) -> Drawing {
        drawing(DrawingKind::Points, capacity, is_cyclic, 0.0)
    }

    fn push(drawing: &mut Drawing, x: f64) -> bool {
        drawing.push(&[x, 0.0, 0.0])
    }

    #[test]
    fn a_full_drawing_takes_no_item_and_a_cyclic_one_replaces_the_oldest() {
        let mut fixed = points(2, false);
        assert_eq!([1.0, 2.0, 3.0].map(|x| push(&mut fixed, x)), [true, true, false]);
        assert_eq!(fixed.items, [1.0, 0.0, 0.0, 2.0, 0.0, 0.0]);
        let mut cyclic = points(2, true);
        assert_eq!([1.0, 2.0, 3.0].map(|x| push(&mut cyclic, x)), [true; 3]);
        assert_eq!(cyclic.items, [3.0, 0.0, 0.0, 2.0, 0.0, 0.0]);
        assert!(!push(&mut points(0, true), 1.0), "a drawing without room takes nothing");
    }

    #[test]
    fn stretches_give_every_new_item_once() {
        let mut drawing = points(5, true);
        let (mut copy, mut known) = (Vec::new(), 0);
        for k in 0..40 {
            push(&mut drawing, f64::from(k));
            // looked at after one, two, three … items, more than there is room for at last
            if [0, 2, 5, 9, 14, 20, 27, 39].contains(&k) {
                for (from, numbers) in drawing.since(known) {
                    let end = 3 * from + numbers.len();
                    copy.resize(copy.len().max(end), f32::NAN);
                    copy[3 * from..end].copy_from_slice(numbers);
                }
                known = drawing.version().1;
                assert_eq!(copy, drawing.items, "after item {k}");
            }
        }
        assert!(drawing.since(known).is_empty());
    }

    #[test]
    fn items_beside_others_are_not_taken() {
        let mut drawing = drawing(DrawingKind::Points, 3, true, 0.01);
        // 0.0101 lies in the next cell, −0.0099 in the one before
        let taken = [1.0, 1.0099, 1.0101, 0.9902, -1e300, 1e300].map(|x| push(&mut drawing, x));
        assert_eq!(taken, [true, false, true, false, true, true]);
        // the first item was replaced: its place is free again
        assert_eq!([1.0, 1.0, 1.0101].map(|x| push(&mut drawing, x)), [true, false, true]);
    }

    #[test]
    fn a_particle_takes_the_place_of_one_whose_time_is_over() {
        let mut jet = drawing(DrawingKind::Particles, 2, false, 0.0);
        let mut add = |t: f64| jet.push(&[0.0, 0.0, 0.0, 0.0, 0.0, 1.0, t]);
        assert_eq!([0.0, 0.5, 0.9, 1.0, 1.1, 1.5].map(&mut add), [true, true, false, true, false, true]);
    }
}
