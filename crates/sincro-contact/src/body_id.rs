//! Id of the body or frame that carries a surface.

/// Id of a body or frame: its index in the list `frames` of the names of a model. The world is no body: where it may
/// stand, the id is an [`Option`].
///
/// ```
/// use sincro_contact::BodyId;
///
/// let (bob, rod) = (BodyId::new(0), BodyId::new(1));
/// assert!(bob < rod && rod.index() == 1);
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct BodyId(u32);

impl BodyId {
    /// Makes the id of index `index`, counted from 0.
    ///
    /// # Panics
    ///
    /// If the index does not fit in 32 bits.
    #[must_use]
    pub fn new(index: usize) -> Self {
        Self(u32::try_from(index).expect("fewer than 2^32 objects"))
    }

    /// Index in its list, counted from 0.
    #[inline(always)]
    #[must_use]
    pub fn index(self) -> usize {
        self.0 as usize
    }
}
