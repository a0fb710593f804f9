//! Delassus matrix G = J M⁻¹ Jᵀ (`n_rows × n_rows`) and products with M⁻¹, from the factors that forward dynamics left
//! in the scratch.
//!
//! M⁻¹ τ ([`InverseMass`]) is the second half of the articulated-body algorithm with velocities, gravity and bias
//! forces zero, linear in the number of links. Prescribed degrees of freedom do not respond; the torque they need
//! instead is added to their reaction. Source: key `featherstone2008`, section 7.3.

use sincro_complementarity::sweeps::whitening::{DofFactors, LinkDofs, MassFactors};
use sincro_math::{Real, Task};

use super::row::Row;
use crate::joint::{Link, Stage, StageVisitor, WORLD};
use crate::model::Model;
use crate::scratch::{DofScratch, LinkScratch, Scratch};
use crate::spatial::{Force, Motion, Vec3};

/// Working memory of [`InverseMass::find`]: forces and accelerations of the links, solution of each degree of freedom.
#[derive(Clone, Debug, Default)]
pub(crate) struct InverseMass<R> {
    force: Vec<Force<R>>,
    motion: Vec<Motion<R>>,
    x: Vec<R>,
    torque: Vec<R>,
    /// First link of the tree that each link belongs to.
    tree: Vec<u32>,
    /// True if a torque acts in a tree.
    touched: Vec<bool>,
}

impl<R: Real> InverseMass<R> {
    pub fn new(model: &Model<R>) -> Self {
        let n = model.links.len();
        let tree = model.trees();
        let dofs = vec![R::zero(); model.n_v()];
        Self {
            force: vec![Force::zero(); n],
            motion: vec![Motion::zero(); n],
            x: dofs.clone(),
            torque: dofs,
            tree,
            touched: vec![false; n],
        }
    }

    /// Computes `out = M⁻¹ torque`; with `reaction`, the torques that prescribed degrees of freedom need are added
    /// there.
    pub fn find(
        &mut self,
        model: &Model<R>,
        scratch: &Scratch<R>,
        torque: &[R],
        out: &mut [R],
        mut reaction: Option<&mut [R]>,
    ) {
        self.mark(model, torque);
        for i in (0..model.links.len()).rev() {
            if !self.touched[self.tree[i] as usize] {
                continue;
            }
            let link = &model.links[i];
            let (done, rest) = self.force.split_at_mut(i);
            let k = link.v_idx as usize;
            link.kind.dispatch(Up {
                link,
                at: &scratch.links[i],
                dofs: &scratch.dofs[k..],
                torque: &torque[k..],
                this: &rest[0],
                parent: (link.parent != WORLD).then(|| &mut done[link.parent as usize]),
                x: &mut self.x[k..],
                given: &mut self.torque[k..],
            });
        }
        for i in 0..model.links.len() {
            let link = &model.links[i];
            let k = link.v_idx as usize;
            if !self.touched[self.tree[i] as usize] {
                out[k..k + link.kind.n_v()].fill(R::zero());
                continue;
            }
            let (done, rest) = self.motion.split_at_mut(i);
            let base = Motion::zero();
            let parent = if link.parent == WORLD { &base } else { &done[link.parent as usize] };
            link.kind.dispatch(Down {
                link,
                at: &scratch.links[i],
                dofs: &scratch.dofs[k..],
                parent,
                x: &self.x[k..],
                given: &self.torque[k..],
                this: &mut rest[0],
                out: &mut out[k..],
                reaction: reaction.as_deref_mut().map(|r| &mut r[k..]),
            });
        }
    }

    fn mark(&mut self, model: &Model<R>, torque: &[R]) {
        self.touched.fill(false);
        for (i, link) in model.links.iter().enumerate() {
            let k = link.v_idx as usize;
            if torque[k..k + link.kind.n_v()].iter().any(|t| *t != R::zero()) {
                self.touched[self.tree[i] as usize] = true;
            }
            self.force[i] = Force::zero();
        }
    }
}

/// Factors of the Delassus matrix: for every row and degree of freedom on the way to the base, the innovation of the
/// row's wrench over √D.
///
/// With M = (1 + …) D (1 + …)ᵀ factored as the articulated-body algorithm does it, G is the sum over the degrees of
/// freedom of products of these, and a row costs as much as its way to the base is long. Sources: keys
/// `featherstone2008` (section 7.3), `jain2011` (chapter 7, innovations factorisation).
#[derive(Clone, Debug, Default)]
pub(crate) struct Delassus<R> {
    /// U of each degree of freedom, world axes, about the world's origin.
    u: Vec<Force<R>>,
    inv_d: Vec<R>,
    inv_root: Vec<R>,
    link_of: Vec<u32>,
    /// First link of the tree that each link belongs to.
    tree: Vec<u32>,
    /// For each degree of freedom, one number a row.
    values: Vec<R>,
    /// The factors once more, for sweeps.
    mass: MassFactors,
}

impl<R: Real> Delassus<R> {
    pub fn new(model: &Model<R>) -> Self {
        let n = model.n_v();
        let link_of = model.links_of_dofs();
        let o = R::zero();
        let tree = model.trees();
        let links = model
            .links
            .iter()
            .map(|link| LinkDofs { dofs: [link.v_idx, link.v_idx + link.kind.n_v() as u32], parent: link.parent });
        let mass = MassFactors { dofs: vec![DofFactors::default(); n], links: links.collect() };
        let (zeros, values) = (vec![o; n], Vec::new());
        Self { u: vec![Force::zero(); n], inv_d: zeros.clone(), inv_root: zeros, link_of, tree, values, mass }
    }

    /// Memory for `m` rows.
    pub fn reserve(&mut self, m: usize) {
        self.values.reserve((m * self.u.len()).saturating_sub(self.values.len()));
    }

    /// Delassus matrix of `rows`, row by row, from the factors that forward dynamics left in the scratch.
    pub fn products(
        &mut self,
        model: &Model<R>,
        scratch: &Scratch<R>,
        columns: &[Motion<R>],
        rows: &[Row<R>],
        a: &mut Vec<R>,
    ) {
        let m = rows.len();
        let values = self.factors(model, scratch, columns, rows);
        a.clear();
        a.resize(m * m, R::zero());
        // loops that join nothing that moves leave no rows
        if m > 0 {
            R::run_hot(Products { m, values, a });
        }
    }

    /// Rows of J M^(−1/2): for each degree of freedom one number a row.
    pub fn factors(&mut self, model: &Model<R>, scratch: &Scratch<R>, columns: &[Motion<R>], rows: &[Row<R>]) -> &[R] {
        let (m, n) = (rows.len(), model.n_v());
        self.place(model, scratch);
        self.values.clear();
        self.values.resize(m * n, R::zero());
        let mut values = core::mem::take(&mut self.values);
        for (i, row) in rows.iter().enumerate() {
            self.factor_row(model, columns, row, |k, value| values[k as usize * m + i] = value);
        }
        self.values = values;
        &self.values
    }

    /// Factors last computed by [`Delassus::products`].
    pub fn values(&self) -> &[R] {
        &self.values
    }

    /// Takes the factors of the degrees of freedom from the scratch, for [`Delassus::factor_row`].
    pub fn place(&mut self, model: &Model<R>, scratch: &Scratch<R>) {
        for (i, link) in model.links.iter().enumerate() {
            let pose = &scratch.poses[i];
            let sign = if link.kind.n_v() == 1 { link.sign } else { R::one() };
            for k in link.v_idx as usize..link.v_idx as usize + link.kind.n_v() {
                let dof = &scratch.dofs[k];
                let lin = pose.rot.mul_vec(dof.u.lin);
                let ang = pose.rot.mul_vec(dof.u.ang) + pose.pos.cross(lin);
                self.u[k] = Force { ang, lin }.scale(sign);
                self.inv_d[k] = dof.inv_d;
                self.inv_root[k] = dof.inv_d.sqrt();
            }
        }
    }

    /// Writes the factors last placed, with the axes of the joints, to [`Delassus::mass_factors`].
    pub fn place_mass_factors(&mut self, columns: &[Motion<R>]) {
        let numbers = |ang: Vec3<R>, lin: Vec3<R>| -> [f64; 6] {
            core::array::from_fn(|i| (if i < 3 { ang[i] } else { lin[i - 3] }).lane(0))
        };
        for (k, dof) in self.mass.dofs.iter_mut().enumerate() {
            let (axis, u) = (columns[k], self.u[k]);
            let (inv_d, inv_root) = (self.inv_d[k].lane(0), self.inv_root[k].lane(0));
            *dof = DofFactors { axis: numbers(axis.ang, axis.lin), u: numbers(u.ang, u.lin), inv_d, inv_root };
        }
    }

    /// The factors for sweeps.
    pub fn mass_factors(&self) -> &MassFactors {
        &self.mass
    }

    /// Trees that a row acts on, by their first links; `WORLD` for none.
    pub fn trees(&self, row: &Row<R>) -> [u32; 2] {
        self.ends(row).map(|link| if link == WORLD { WORLD } else { self.tree[link as usize] })
    }

    /// Links that a row acts on; `WORLD` for none.
    fn ends(&self, row: &Row<R>) -> [u32; 2] {
        let mut ends = [row.a, row.b];
        for (end, (dof, _)) in ends.iter_mut().zip(&row.joints) {
            if *dof != WORLD {
                *end = self.link_of[*dof as usize];
            }
        }
        ends
    }

    /// Factors of one row: hands each degree of freedom on the ways of its two links to the base to `take`, with its
    /// number. Where the two ways meet, the rest of both goes on together.
    #[inline(always)]
    pub fn factor_row(&self, model: &Model<R>, columns: &[Motion<R>], row: &Row<R>, mut take: impl FnMut(u32, R)) {
        let [a, b] = self.ends(row);
        let mut ends = [(a, row.wa), (b, -row.wb)];
        loop {
            let [(one, f_one), (two, f_two)] = ends;
            if one == two {
                ends = [(one, f_one + f_two), (WORLD, Force::zero())];
            } else if one == WORLD || (two != WORLD && two > one) {
                // links come after their parents
                ends = [(two, f_two), (one, f_one)];
            }
            let (at, force) = &mut ends[0];
            if *at == WORLD {
                return;
            }
            let link = &model.links[*at as usize];
            let first = link.v_idx as usize;
            for k in (first..first + link.kind.n_v()).rev() {
                let mut u = columns[k].dot(force);
                for (dof, c) in row.joints {
                    if dof as usize == k {
                        u += c;
                    }
                }
                take(k as u32, u * self.inv_root[k]);
                *force -= self.u[k].scale(u * self.inv_d[k]);
            }
            *at = link.parent;
        }
    }
}

/// Sum over the degrees of freedom of the products of the factors.
struct Products<'a, R> {
    m: usize,
    values: &'a [R],
    a: &'a mut [R],
}

impl<R: Real> Task for Products<'_, R> {
    type Output = ();

    #[inline(always)]
    fn run(self) {
        let Self { m, values, a } = self;
        for values in values.chunks_exact(m) {
            for (i, x) in values.iter().enumerate() {
                // most rows do not pass through most degrees of freedom
                if *x == R::zero() {
                    continue;
                }
                for (a, y) in a[i * m..=i * m + i].iter_mut().zip(values) {
                    *a += *x * *y;
                }
            }
        }
        for i in 0..m {
            for j in 0..i {
                a[j * m + i] = a[i * m + j];
            }
        }
    }
}

struct Up<'a, R> {
    link: &'a Link<R>,
    at: &'a LinkScratch<R>,
    dofs: &'a [DofScratch<R>],
    torque: &'a [R],
    this: &'a Force<R>,
    parent: Option<&'a mut Force<R>>,
    x: &'a mut [R],
    given: &'a mut [R],
}

impl<R: Real> StageVisitor for Up<'_, R> {
    type Number = R;
    type Output = ();
    #[inline(always)]
    fn visit<S: Stage>(self) {
        let mut pa = *self.this;
        for j in (0..S::N_V).rev() {
            // u = τ − Sᵀ pA,  pa = pA + U u/D
            let u = self.link.signed::<S>(self.torque[j]) - S::project(self.link, j, &pa);
            self.given[j] = u;
            self.x[j] = u * self.dofs[j].inv_d;
            pa += self.dofs[j].u.scale(self.x[j]);
        }
        if let Some(parent) = self.parent {
            *parent += self.link.force_to_parent::<S>(&self.at.at, &pa);
        }
    }
}

struct Down<'a, R> {
    link: &'a Link<R>,
    at: &'a LinkScratch<R>,
    dofs: &'a [DofScratch<R>],
    parent: &'a Motion<R>,
    x: &'a [R],
    given: &'a [R],
    this: &'a mut Motion<R>,
    out: &'a mut [R],
    reaction: Option<&'a mut [R]>,
}

impl<R: Real> StageVisitor for Down<'_, R> {
    type Number = R;
    type Output = ();
    #[inline(always)]
    fn visit<S: Stage>(self) {
        let mut a = self.link.motion_in_link::<S>(&self.at.at, self.parent);
        let mut reaction = self.reaction;
        for j in 0..S::N_V {
            // v̇ = x − Uᵀ a'/D,  a' += S v̇
            let dof = &self.dofs[j];
            let along = a.dot(&dof.u);
            let acceleration = self.x[j] - dof.inv_d * along;
            a += S::column(self.link, j, acceleration);
            self.out[j] = self.link.signed::<S>(acceleration);
            if let Some(reaction) = &mut reaction {
                // zero for a degree of freedom that is not prescribed
                let needed = dof.d * acceleration + along - self.given[j];
                let held = dof.inv_d.abs().if_less(R::splat(f64::MIN_POSITIVE), needed, R::zero());
                reaction[j] += self.link.signed::<S>(held);
            }
        }
        *self.this = a;
    }
}
