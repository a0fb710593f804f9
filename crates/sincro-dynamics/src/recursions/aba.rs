//! Forward dynamics: joint accelerations from torques, in time proportional to the number of links.
//!
//! Articulated-body algorithm: v̇ = M⁻¹ (τ − c). Source: key `featherstone2008`, section 7.3, table 7.1. Deviations:
//!
//! - Degrees of freedom of one joint are eliminated one after the other (rank-one updates instead of a block inverse),
//!   so that one piece of code serves every joint.
//! - A degree of freedom can be *prescribed*: its acceleration is given and the torque for it is found (hybrid
//!   dynamics, section 9.2). Locked drives (ideal velocity motors, sticking friction) are prescribed degrees of
//!   freedom; this costs nothing extra and is exact.
//! - A diagonal matrix is added to the mass matrix: armature, and what a linearly implicit integrator adds for springs
//!   and dampers.
//!
//! | symbol here | meaning | source |
//! |---|---|---|
//! | `v`, `c` | twist, velocity product | v, c |
//! | `ia`, `pa` | articulated inertia, bias force | Iᴬ, pᴬ |
//! | `u`, `d`, `force` | IA·S, SᵀIA·S + diagonal, τ − Sᵀ(pA + IA·c) | U, D, u |

use sincro_math::{Real, Task};

use crate::actuation::DriveKind;
use crate::joint::{Link, Stage, StageVisitor, WORLD};
use crate::model::Model;
use crate::scratch::{DofScratch, LinkScratch, Scratch};
use crate::spatial::{ArticulatedInertia, Force, Motion, RigidInertia};
use crate::state::State;

/// Inputs of [`forward_dynamics`]. Lengths are `n_q` for `q`, the number of links for `external`, `n_v` for all else;
/// vectors of `n_v` entries have the order of the degrees of freedom.
#[derive(Clone, Copy, Debug)]
pub struct Input<'a, R> {
    /// Coordinates `[rad]`, `[m]`, quaternions (w, x, y, z).
    pub q: &'a [R],
    /// Velocities `[rad/s]`, `[m/s]`.
    pub v: &'a [R],
    /// Joint torques `[N·m]` or forces `[N]`: the sum of all but gravity and `external`.
    pub torque: &'a [R],
    /// Terms added to the diagonal of the mass matrix, such as armature `[kg·m²]` or `[kg]`.
    pub diagonal: &'a [R],
    /// Degrees of freedom with prescribed acceleration; `None` if all are free.
    pub prescribed: Option<Prescribed<'a, R>>,
    /// External wrench on each link: moment about its origin `[N·m]` and force `[N]`, in link axes; `None` for zero.
    pub external: Option<&'a [Force<R>]>,
    /// True if gravity acts; false for impulses.
    pub gravity: bool,
}

/// Degrees of freedom whose acceleration is prescribed, such as locked drives; part of [`Input`]. Both slices have
/// `n_v` entries.
#[derive(Clone, Copy, Debug)]
pub struct Prescribed<'a, R> {
    /// 1 for a prescribed degree of freedom, 0 for a free one.
    pub mask: &'a [R],
    /// Prescribed acceleration `[rad/s²]` or `[m/s²]`; read where the mask is 1.
    pub acceleration: &'a [R],
}

/// Forward dynamics (articulated-body algorithm): writes the joint accelerations `v_dot` (`n_v`) `[rad/s²]` or `[m/s²]`
/// of `(M + diagonal)·v̇ = torque + gravity + external − bias`.
///
/// Afterwards [`Scratch::reaction`] has the torque that each prescribed degree of freedom needed.
///
/// ```
/// use sincro_dynamics::aba::{Input, forward_dynamics};
/// use sincro_dynamics::prelude::*;
/// use sincro_dynamics::scratch::Scratch;
///
/// # let mut builder = ModelBuilder::new([0.0, 0.0, -9.81]);
/// # let hinge = JointSpec::new(JointKind::Revolute { axis: [0.0, 1.0, 0.0] });
/// # let hinge = builder.joint("hinge", NodeId::WORLD, Pose::identity(), hinge);
/// # let mass = MassProperties { mass: 2.0, center_of_mass: [0.0, 0.0, -0.5], inertia: [0.0; 6] };
/// # builder.body("bob", hinge, Pose::identity(), BodySpec { mass });
/// # let model = builder.build()?.0;
/// // a pendulum, 2 kg at 0.5 m from its hinge, at 0.3 rad: q'' = −(g/l) sin q
/// let (q, zero) = ([0.3], [0.0]);
/// let input =
///     Input { q: &q, v: &zero, torque: &zero, diagonal: &zero, prescribed: None, external: None, gravity: true };
/// let mut v_dot = [0.0];
/// forward_dynamics(&model, &input, &mut Scratch::new(&model), &mut v_dot);
/// assert!((v_dot[0] + 9.81 / 0.5 * f64::sin(0.3)).abs() < 1e-12); // [rad/s²]
/// # Ok::<(), BuildError>(())
/// ```
#[inline(always)]
pub fn forward_dynamics<R: Real>(model: &Model<R>, input: &Input<'_, R>, scratch: &mut Scratch<R>, v_dot: &mut [R]) {
    R::run_hot(ForwardDynamics { model, input, scratch, v_dot });
}

impl Model<f64> {
    /// Computes the accelerations v̇ of plain numbers, as [`forward_dynamics`] does, which every crate compiles again.
    ///
    /// # Panics
    ///
    /// As [`forward_dynamics`].
    pub fn forward_dynamics(&self, input: &Input<'_, f64>, scratch: &mut Scratch<f64>, v_dot: &mut [f64]) {
        forward_dynamics(self, input, scratch, v_dot);
    }
}

struct ForwardDynamics<'a, R> {
    model: &'a Model<R>,
    input: &'a Input<'a, R>,
    scratch: &'a mut Scratch<R>,
    v_dot: &'a mut [R],
}

impl<R: Real> Task for ForwardDynamics<'_, R> {
    type Output = ();

    #[inline(always)]
    fn run(self) {
        velocities_base_to_tip(self.model, self.input, self.scratch);
        inertias_tip_to_base(self.model, self.input, self.scratch);
        accelerations_base_to_tip(self.model, self.input, self.scratch, self.v_dot);
    }
}

/// Links and their inertias, as many of each: indices of one are those of the other.
#[inline(always)]
fn of_links<R: Real>(model: &Model<R>) -> (&[Link<R>], &[RigidInertia<R>]) {
    (&model.links, &model.params.inertias[..model.links.len()])
}

#[inline(always)]
fn velocities_base_to_tip<R: Real>(model: &Model<R>, input: &Input<'_, R>, scratch: &mut Scratch<R>) {
    let (links, inertias) = of_links(model);
    for i in 0..links.len() {
        let (link, inertia) = (&links[i], &inertias[i]);
        let (done, rest) = scratch.links.split_at_mut(i);
        let parent = (link.parent != WORLD).then(|| &done[link.parent as usize].v);
        link.kind.dispatch(Velocity { link, inertia, q: input.q, v: input.v, parent, out: &mut rest[0] });
        if let Some(external) = input.external {
            rest[0].pa -= external[i];
        }
    }
}

/// Pass 1 for one link.
struct Velocity<'a, R> {
    link: &'a Link<R>,
    inertia: &'a RigidInertia<R>,
    q: &'a [R],
    v: &'a [R],
    parent: Option<&'a Motion<R>>,
    out: &'a mut LinkScratch<R>,
}

impl<R: Real> StageVisitor for Velocity<'_, R> {
    type Number = R;
    type Output = ();

    #[inline(always)]
    fn visit<S: Stage>(self) {
        let Self { link, inertia, q, v, parent, out } = self;
        S::place(link, &q[link.q_idx as usize..], &mut out.at);
        // v_J = S q̇
        let v_joint = joint_motion::<S, R>(link, &v[link.v_idx as usize..]);
        match parent {
            Some(v_parent) => {
                // v = X v_parent + v_J,  c = v × v_J
                out.v = link.motion_in_link::<S>(&out.at, v_parent) + v_joint;
                out.c = S::velocity_product(&out.v, &v_joint);
            }
            None => {
                out.v = v_joint;
                out.c = Motion::zero();
            }
        }
        // pA = v ×* I v
        out.pa = out.v.cross_force(&inertia.mul(&out.v));
    }
}

/// `S x` for the user's rates `x` of the stage.
#[inline(always)]
pub(crate) fn joint_motion<S: Stage, R: Real>(link: &Link<R>, x: &[R]) -> Motion<R> {
    let mut m = S::column(link, 0, link.signed::<S>(x[0]));
    for j in 1..S::N_V {
        m += S::column(link, j, x[j]);
    }
    m
}

#[inline(always)]
fn inertias_tip_to_base<R: Real>(model: &Model<R>, input: &Input<'_, R>, scratch: &mut Scratch<R>) {
    let (links, inertias) = of_links(model);
    for i in (0..links.len()).rev() {
        let (link, inertia) = (&links[i], &inertias[i]);
        let (done, rest) = scratch.links.split_at_mut(i);
        let parent = (link.parent != WORLD).then(|| &mut done[link.parent as usize]);
        let dofs = &mut scratch.dofs[link.v_idx as usize..];
        link.kind.dispatch(Inertia { link, inertia, input, this: &mut rest[0], parent, dofs });
    }
}

/// Pass 2 for one link.
struct Inertia<'a, R> {
    link: &'a Link<R>,
    inertia: &'a RigidInertia<R>,
    input: &'a Input<'a, R>,
    this: &'a mut LinkScratch<R>,
    parent: Option<&'a mut LinkScratch<R>>,
    dofs: &'a mut [DofScratch<R>],
}

impl<R: Real> StageVisitor for Inertia<'_, R> {
    type Number = R;
    type Output = ();

    #[inline(always)]
    fn visit<S: Stage>(self) {
        let Self { link, inertia, input, this, parent, dofs } = self;
        // `ia` holds what the children left there
        let ia = if link.has_children { this.ia.plus_rigid(inertia) } else { inertia.articulated() };
        let mut left = Remainder { ia, pa: this.pa, is_root: parent.is_none() };
        if !left.is_root {
            // bias of the velocity product, for the whole link at once
            left.pa += S::inertia_times_bias(&left.ia, &this.c);
        }
        // written out, so that each index is a constant and what it leaves unused is not computed
        if S::N_V == 6 {
            left.eliminate_dof::<S>(link, 5, input, dofs);
            left.eliminate_dof::<S>(link, 4, input, dofs);
            left.eliminate_dof::<S>(link, 3, input, dofs);
        }
        if S::N_V >= 3 {
            left.eliminate_dof::<S>(link, 2, input, dofs);
            left.eliminate_dof::<S>(link, 1, input, dofs);
        }
        left.eliminate_dof::<S>(link, 0, input, dofs);
        if let Some(parent) = parent {
            let ia = link.articulated_to_parent::<S>(&this.at, &left.ia);
            parent.ia = if link.is_last_child { ia } else { parent.ia.plus(&ia) };
            parent.pa += link.force_to_parent::<S>(&this.at, &left.pa);
        }
    }
}

/// Articulated inertia and bias force of a link while its degrees of freedom are eliminated one after the other.
struct Remainder<R> {
    ia: ArticulatedInertia<R>,
    pa: Force<R>,
    is_root: bool,
}

impl<R: Real> Remainder<R> {
    #[inline(always)]
    fn eliminate_dof<S: Stage>(&mut self, link: &Link<R>, j: usize, input: &Input<'_, R>, dofs: &mut [DofScratch<R>]) {
        let dof = &mut dofs[j];
        eliminate::<S, R>(link, j, &self.ia, &self.pa, input, link.v_idx as usize + j, dof);
        // Ia = IA − U Uᵀ/D,  pa = pA + U u/D   (prescribed: Ia = IA, pa = pA + U·acceleration)
        let ku = dof.u.scale(dof.inv_d);
        if !self.is_root {
            self.ia = self.ia.minus_outer(&dof.u, &ku);
            self.pa += dof.u.scale(dof.x);
        } else if S::N_V > 1 {
            self.ia = S::minus_outer_before(&self.ia, &dof.u, &ku, j);
            self.pa += dof.u.scale(dof.x);
        }
    }
}

/// U, D and u of degree of freedom `j` of a link, and what follows from them.
#[inline(always)]
fn eliminate<S: Stage, R: Real>(
    link: &Link<R>,
    j: usize,
    ia: &ArticulatedInertia<R>,
    pa: &Force<R>,
    input: &Input<'_, R>,
    dof_idx: usize,
    out: &mut DofScratch<R>,
) {
    out.u = S::inertia_column(link, j, ia);
    out.d = S::project(link, j, &out.u) + input.diagonal[dof_idx];
    out.force = link.signed::<S>(input.torque[dof_idx]) - S::project(link, j, pa);
    out.inv_d = R::one() / out.d;
    out.x = out.force * out.inv_d;
    if let Some(prescribed) = input.prescribed {
        let (half, mask) = (R::splat(0.5), prescribed.mask[dof_idx]);
        out.inv_d = half.if_less(mask, R::zero(), out.inv_d);
        out.x = half.if_less(mask, link.signed::<S>(prescribed.acceleration[dof_idx]), out.x);
    }
}

#[inline(always)]
fn accelerations_base_to_tip<R: Real>(
    model: &Model<R>,
    input: &Input<'_, R>,
    scratch: &mut Scratch<R>,
    v_dot: &mut [R],
) {
    // gravity as an upward acceleration of the base
    let gravity = if input.gravity { -model.params.gravity } else { crate::spatial::Vec3::zero() };
    let base = Motion { ang: crate::spatial::Vec3::zero(), lin: gravity };
    for (i, link) in model.links.iter().enumerate() {
        let (done, rest) = scratch.links.split_at_mut(i);
        let is_root = link.parent == WORLD;
        let a_parent = if is_root { &base } else { &done[link.parent as usize].a };
        let v_idx = link.v_idx as usize;
        link.kind.dispatch(Acceleration {
            link,
            this: &mut rest[0],
            a_parent,
            dofs: &scratch.dofs[v_idx..],
            v_dot: &mut v_dot[v_idx..],
            reaction: input.prescribed.map(|_| &mut scratch.reaction[v_idx..]),
        });
    }
}

/// Pass 3 for one link.
struct Acceleration<'a, R> {
    link: &'a Link<R>,
    this: &'a mut LinkScratch<R>,
    a_parent: &'a Motion<R>,
    dofs: &'a [DofScratch<R>],
    v_dot: &'a mut [R],
    reaction: Option<&'a mut [R]>,
}

impl<R: Real> StageVisitor for Acceleration<'_, R> {
    type Number = R;
    type Output = ();

    #[inline(always)]
    fn visit<S: Stage>(self) {
        let Self { link, this, a_parent, dofs, v_dot, mut reaction } = self;
        // a' = X a_parent
        let mut a = link.motion_in_link::<S>(&this.at, a_parent);
        advance::<S, R>(link, 0, &mut a, dofs, v_dot, &mut reaction);
        if S::N_V >= 3 {
            advance::<S, R>(link, 1, &mut a, dofs, v_dot, &mut reaction);
            advance::<S, R>(link, 2, &mut a, dofs, v_dot, &mut reaction);
        }
        if S::N_V == 6 {
            advance::<S, R>(link, 3, &mut a, dofs, v_dot, &mut reaction);
            advance::<S, R>(link, 4, &mut a, dofs, v_dot, &mut reaction);
            advance::<S, R>(link, 5, &mut a, dofs, v_dot, &mut reaction);
        }
        this.a = a + this.c;
    }
}

/// v̇ = x − Uᵀ a'/D,  a' += S v̇ for degree of freedom `j` of a link, and its reaction.
#[inline(always)]
fn advance<S: Stage, R: Real>(
    link: &Link<R>,
    j: usize,
    a: &mut Motion<R>,
    dofs: &[DofScratch<R>],
    v_dot: &mut [R],
    reaction: &mut Option<&mut [R]>,
) {
    let dof = &dofs[j];
    let along = a.dot(&dof.u);
    let acceleration = dof.x - dof.inv_d * along;
    *a += S::column(link, j, acceleration);
    v_dot[j] = link.signed::<S>(acceleration);
    if let Some(reaction) = reaction {
        reaction[j] = link.signed::<S>(dof.d * acceleration + along - dof.force);
    }
}

/// D of every degree of freedom at a state: the inertia that a torque on it meets with everything else left free but
/// force sensors [kg·m²] or `[kg]`, armature included. Springs and dampers against it give the rates that limit an
/// explicit integrator.
#[must_use]
pub(crate) fn joint_inertias(model: &Model<f64>, state: &State<f64>) -> Vec<f64> {
    let mut scratch = Scratch::new(model);
    AtRest::new(model).factor(model, &state.q, &mut scratch);
    scratch.dofs.iter().map(|d| d.d).collect()
}

/// Mechanism at rest and without gravity, all of it left free but force sensors, for factors of its mass matrix.
#[derive(Clone, Debug)]
pub(crate) struct AtRest {
    zeros: Vec<f64>,
    v_dot: Vec<f64>,
    diagonal: Vec<f64>,
    mask: Vec<f64>,
}

impl AtRest {
    pub fn new(model: &Model<f64>) -> Self {
        let zeros = vec![0.0; model.n_v()];
        let mut mask = zeros.clone();
        for drive in model.drives().iter().filter(|drive| drive.kind == DriveKind::Lock) {
            mask[drive.dof] = 1.0;
        }
        let diagonal = model.dofs.iter().map(|d| d.armature).collect();
        Self { v_dot: zeros.clone(), zeros, diagonal, mask }
    }

    /// Velocities and accelerations of the mechanism: zero.
    pub fn zeros(&self) -> &[f64] {
        &self.zeros
    }

    /// Factors the mass matrix at the coordinates `q`.
    pub fn factor(&mut self, model: &Model<f64>, q: &[f64], scratch: &mut Scratch<f64>) {
        self.accelerate(model, q, None, scratch);
    }

    /// Change M⁻¹ r of the velocities by an impulse `r` along each degree of freedom, at the coordinates `q`.
    pub fn respond(&mut self, model: &Model<f64>, q: &[f64], r: &[f64], scratch: &mut Scratch<f64>) -> &[f64] {
        self.accelerate(model, q, Some(r), scratch);
        &self.v_dot
    }

    fn accelerate(&mut self, model: &Model<f64>, q: &[f64], torque: Option<&[f64]>, scratch: &mut Scratch<f64>) {
        let input = Input {
            q,
            v: &self.zeros,
            torque: torque.unwrap_or(&self.zeros),
            diagonal: &self.diagonal,
            prescribed: Some(Prescribed { mask: &self.mask, acceleration: &self.zeros }),
            external: None,
            gravity: false,
        };
        forward_dynamics(model, &input, scratch, &mut self.v_dot);
    }
}
