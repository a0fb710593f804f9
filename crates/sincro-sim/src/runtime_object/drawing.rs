//! Drawings that clients and scripts make at run time: points, lines, triangles and particles. Nothing in a run depends
//! on them.

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
/// let style = DrawingStyle { kind: DrawingKind::Points, size: 0.01, color: [255, 0, 0], lifetime: 0.0, falls: false };
/// let mut path = Drawing::new(style, 2, true); // the last two points
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
    items: Vec<f32>,
    /// Number of items written since it was cleared.
    n_written: u64,
    /// Number of times that it was cleared.
    n_cleared: u64,
}

impl Drawing {
    /// Creates an empty drawing of at most `capacity` items. When it is full a new item replaces the oldest one if
    /// `is_cyclic`, else it is not taken.
    #[must_use]
    pub fn new(style: DrawingStyle, capacity: usize, is_cyclic: bool) -> Self {
        Self { style, capacity, is_cyclic, items: Vec::new(), n_written: 0, n_cleared: 0 }
    }

    /// Adds an item of [`DrawingKind::width`] entries. Returns false if the drawing is full and not cyclic.
    ///
    /// # Panics
    ///
    /// If the item has another number of entries.
    pub fn push(&mut self, item: &[f64]) -> bool {
        let width = self.style.kind.width();
        assert_eq!(item.len(), width, "an item of {}", self.style.kind.word());
        let is_full = self.n_written >= self.capacity as u64;
        if self.capacity == 0 || (is_full && !self.is_cyclic) {
            return false;
        }
        let place = (self.n_written % self.capacity as u64) as usize * width;
        let numbers = item.iter().map(|x| *x as f32);
        if place == self.items.len() {
            self.items.extend(numbers);
        } else {
            self.items[place..place + width].iter_mut().zip(numbers).for_each(|(old, new)| *old = new);
        }
        self.n_written += 1;
        true
    }

    /// Removes all items.
    pub fn clear(&mut self) {
        self.items.clear();
        self.n_written = 0;
        self.n_cleared += 1;
    }

    /// Returns the number of its items.
    #[must_use]
    pub fn n_items(&self) -> usize {
        self.items.len() / self.style.kind.width()
    }

    /// Returns the number of items that it may have.
    #[must_use]
    pub fn capacity(&self) -> usize {
        self.capacity
    }

    /// Returns true if there is an item within `distance` `[m]` of a position.
    #[must_use]
    pub fn has_near(&self, position: Vec3<f64>, distance: f64) -> bool {
        let is_near = |item: &[f32]| {
            let apart = Vec3([0, 1, 2].map(|k| f64::from(item[k]) - position.0[k]));
            apart.dot(apart) < distance * distance
        };
        self.items.chunks_exact(self.style.kind.width()).any(is_near)
    }

    /// Number of clearings, and of items written since the last.
    pub(crate) fn version(&self) -> (u64, u64) {
        (self.n_cleared, self.n_written)
    }

    /// Items that were written since there were `n_written`, as stretches: index of the first, and entries.
    pub(crate) fn since(&self, n_written: u64) -> Vec<(usize, &[f32])> {
        let (width, n) = (self.style.kind.width(), self.n_items());
        let new = (self.n_written - n_written).min(n as u64) as usize;
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

    fn points(capacity: usize, is_cyclic: bool) -> Drawing {
        let kind = DrawingKind::Points;
        let style = DrawingStyle { kind, size: 0.01, color: [0; 3], lifetime: 0.0, falls: false };
        Drawing::new(style, capacity, is_cyclic)
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
    fn near_items_are_found() {
        let mut drawing = points(5, false);
        push(&mut drawing, 1.0);
        assert!(drawing.has_near(Vec3([1.0, 0.009, 0.0]), 0.01));
        assert!(!drawing.has_near(Vec3([1.0, 0.011, 0.0]), 0.01));
    }
}
