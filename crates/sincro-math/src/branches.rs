//! Branches that laws in pieces take at one state, for methods that must not step over the border of a piece unseen.

/// Hash of the branches that piecewise laws take, noted one after the other. As long as it stays the same, all of them
/// are smooth.
///
/// ```
/// use sincro_math::Branches;
///
/// let branches_at = |x: f64| {
///     let mut branches = Branches::default();
///     branches.note(u64::from(x > 0.0));
///     branches
/// };
/// assert!(branches_at(-1.0) == branches_at(-2.0) && branches_at(-1.0) != branches_at(1.0));
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Branches(u64);

impl Branches {
    /// Notes the number of one branch.
    #[inline]
    pub fn note(&mut self, branch: u64) {
        self.0 = (self.0 ^ branch).wrapping_mul(0x9e37_79b9_7f4a_7c15).rotate_left(29).wrapping_add(1);
    }

    /// Notes on which side of `bound` a value is, or that it is there.
    #[inline]
    pub fn note_side(&mut self, value: f64, bound: f64) {
        self.note(u64::from(value > bound) + 2 * u64::from(value < bound));
    }
}
