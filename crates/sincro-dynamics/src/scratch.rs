//! Working memory of the recursions. It holds nothing that cannot be recomputed from model and state, and may be
//! dropped at any time; it is allocated once and never grows.

use sincro_math::Real;

use crate::joint::Placement;
use crate::model::Model;
use crate::spatial::{ArticulatedInertia, Force, Motion, Pose, RigidInertia};

/// Per link.
///
/// | field | meaning | frame | computed by |
/// |---|---|---|---|
/// | `at` | configuration of the joint | parent | every recursion, base to tip |
/// | `v` | twist | link | base to tip |
/// | `c` | velocity product v × S q̇ | link | base to tip (ABA) |
/// | `a` | acceleration, gravity included as −g of the base | link | base to tip |
/// | `ia` | articulated inertia | link | tip to base (ABA) |
/// | `pa` | articulated bias force; in RNEA the wrench through the joint | link | tip to base |
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct LinkScratch<R> {
    pub(crate) at: Placement<R>,
    pub(crate) v: Motion<R>,
    pub(crate) c: Motion<R>,
    pub(crate) a: Motion<R>,
    pub(crate) ia: ArticulatedInertia<R>,
    pub(crate) pa: Force<R>,
}

/// Per degree of freedom, in stage coordinates (the link's sign applied).
///
/// | field | meaning |
/// |---|---|
/// | `u` | U = IA·S |
/// | `d` | D = Sᵀ·U + armature |
/// | `inv_d` | 1/D, or 0 for a held degree of freedom |
/// | `x` | u/D, or the prescribed acceleration of a held one |
/// | `force` | u = τ − Sᵀ·pA |
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct DofScratch<R> {
    pub(crate) u: Force<R>,
    pub(crate) d: R,
    pub(crate) inv_d: R,
    pub(crate) x: R,
    pub(crate) force: R,
}

/// Working memory of the algorithms on one model: intermediate results of recursions and kinematics. Made once by
/// [`Scratch::new`], may be dropped at any time; each algorithm says what it leaves in it.
#[derive(Clone, Debug)]
pub struct Scratch<R> {
    pub(crate) links: Vec<LinkScratch<R>>,
    pub(crate) dofs: Vec<DofScratch<R>>,
    /// Poses of the link frames in the world, [`crate::recursions::kinematics::poses`].
    pub(crate) poses: Vec<Pose<R>>,
    /// Inertia of each link with everything hanging on it held rigid (mass matrix).
    pub(crate) composite: Vec<RigidInertia<R>>,
    /// Torque that each held degree of freedom needed beyond the given one [N·m].
    pub(crate) reaction: Vec<R>,
}

impl<R: Real> Scratch<R> {
    /// Twist of link `link` (index in [`Model::links`]) about its origin, in link axes: angular `[rad/s]`, linear
    /// `[m/s]`; after [`motions`](crate::recursions::kinematics::motions). Panics if there is no such link.
    #[must_use]
    pub fn twist(&self, link: usize) -> crate::spatial::Motion<R> {
        self.links[link].v
    }

    /// Allocates the working memory for `model`, filled with zeros; for no other model.
    #[must_use]
    pub fn new(model: &Model<R>) -> Self {
        Self {
            links: vec![LinkScratch::default(); model.links.len()],
            dofs: vec![DofScratch::default(); model.n_v()],
            poses: vec![Pose::default(); model.links.len()],
            composite: vec![RigidInertia::zero(); model.links.len()],
            reaction: vec![R::zero(); model.n_v()],
        }
    }

    /// Bytes that it takes on the heap; for memory statistics.
    #[must_use]
    pub fn heap_bytes(&self) -> usize {
        size_of_val(&*self.links) + size_of_val(&*self.dofs) + size_of_val(&*self.poses) + size_of_val(&*self.reaction)
    }

    /// Poses of the link frames in the world `[m]`, in the order of [`Model::links`], as last computed by
    /// [`crate::recursions::kinematics::poses`].
    #[must_use]
    pub fn link_poses(&self) -> &[Pose<R>] {
        &self.poses
    }

    /// Torque `[N·m]` or force `[N]` that each prescribed degree of freedom needed beyond the given one in the last
    /// [`crate::recursions::aba::forward_dynamics`]: n_v entries, meaningless for free ones.
    #[must_use]
    pub fn reaction(&self) -> &[R] {
        &self.reaction
    }
}
