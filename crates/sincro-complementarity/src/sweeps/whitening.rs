//! Whitened rows of contacts, A Jᵀ with M⁻¹ = Aᵀ A, the three rows of one at a time in lanes.
//!
//! The innovations factorisation of the articulated-body algorithm has one number for each degree of freedom on the
//! ways of the two links to the base: going down a way, the force of a row is projected on the axis of each degree of
//! freedom, over √D, and what that one takes up is subtracted. Sources: keys `featherstone2008` (section 7.3),
//! `jain2011` (chapter 7).

use sincro_math::{LaneVisitor, Real, lanes};

use super::body_rows::{Bodies, push_packed};
use super::local::{ContactLocal, TangentialProblem};
use super::{Block, IMMOBILE, Law, Local, NONE, Sweeper};

/// Link of [`MassFactors`] that does not move.
pub const FIXED: u32 = u32::MAX;

/// Factors of the mass matrix as forward dynamics leaves them, world axes, about the world's origin; motions and forces
/// have their angular part first.
#[derive(Clone, Debug, Default)]
pub struct MassFactors {
    /// Degrees of freedom; those of a link follow each other.
    pub dofs: Vec<DofFactors>,
    /// Links, after their parents.
    pub links: Vec<LinkDofs>,
}

/// Factors of a degree of freedom.
#[derive(Clone, Copy, Debug, Default)]
pub struct DofFactors {
    /// Motion of the link with unit velocity.
    pub axis: [f64; 6],
    /// U of the articulated-body algorithm.
    pub u: [f64; 6],
    /// 1/D.
    pub inv_d: f64,
    /// 1/√D.
    pub inv_root: f64,
}

/// Degrees of freedom of a link.
#[derive(Clone, Copy, Debug)]
pub struct LinkDofs {
    /// The first of them, and the one behind the last.
    pub dofs: [u32; 2],
    /// Parent, or [`FIXED`].
    pub parent: u32,
}

/// Contact with sliding friction: normal row and two across.
#[derive(Clone, Copy, Debug)]
pub struct Contact {
    /// Friction coefficient.
    pub friction: f64,
    /// First row of the problem.
    pub row: usize,
    /// The two links, or [`FIXED`].
    pub links: [u32; 2],
    /// Wrench of each row on the first link, and against the second: its six numbers, each of three rows and a zero.
    pub wrench: [[f64; 4]; 6],
    /// Rates of the rows without any force.
    pub b: [f64; 3],
    /// Forces to start from.
    pub lambda: [f64; 3],
}

/// Whitened rows of one contact.
#[derive(Clone, Debug, Default)]
pub(super) struct WhitenedRows {
    /// Number of degrees of freedom on the ways.
    len: usize,
    /// These, and their numbers of the three rows, with a zero; room for all of the mechanism.
    dofs: Vec<u32>,
    columns: Vec<[f64; 4]>,
}

impl WhitenedRows {
    /// Finds the rows of a contact. Where the ways of the two links meet, the rest of both goes on together.
    #[inline(always)]
    fn find<V: Real>(&mut self, factors: &MassFactors, contact: &Contact) {
        self.dofs.resize(factors.dofs.len(), 0);
        self.columns.resize(factors.dofs.len(), [0.0; 4]);
        // no list grows below: calls would take the forces out of their registers
        let Self { len, dofs, columns } = self;
        let mut n = 0;
        let [mut one, mut two] = contact.links;
        let (mut force, mut other) = ([V::zero(); 6], [V::zero(); 6]);
        for i in 0..6 {
            force[i] = V::from_row(&contact.wrench[i]);
            other[i] = -force[i];
        }
        loop {
            if one == two {
                for i in 0..6 {
                    (force[i], other[i]) = (force[i] + other[i], V::zero());
                }
                two = FIXED;
            } else if one == FIXED || (two != FIXED && two > one) {
                // links come after their parents
                (one, two) = (two, one);
                (force, other) = (other, force);
            }
            if one == FIXED {
                break;
            }
            let link = &factors.links[one as usize];
            for k in (link.dofs[0]..link.dofs[1]).rev() {
                let DofFactors { axis, u, inv_d, inv_root } = &factors.dofs[k as usize];
                let along = dot(axis, &force);
                (along * V::splat(*inv_root)).to_row(&mut columns[n]);
                dofs[n] = k;
                n += 1;
                let taken = along * V::splat(*inv_d);
                for i in 0..6 {
                    force[i] -= V::splat(u[i]) * taken;
                }
            }
            one = link.parent;
        }
        *len = n;
    }
}

/// Power of forces on a motion.
#[inline(always)]
fn dot<V: Real>(motion: &[f64; 6], force: &[V; 6]) -> V {
    let mut products = [V::zero(); 6];
    for i in 0..6 {
        products[i] = V::splat(motion[i]) * force[i];
    }
    let [a, b, c, d, e, f] = products;
    (a + b + c) + (d + e + f)
}

/// Addition of a contact to the problem.
struct AddContact<'a> {
    sweeper: &'a mut Sweeper,
    factors: &'a MassFactors,
    contact: &'a Contact,
}

impl LaneVisitor for AddContact<'_> {
    type Output = ();

    #[inline(always)]
    fn visit<V: Real>(self) {
        let Self { sweeper, factors, contact } = self;
        let mut rows = core::mem::take(&mut sweeper.whitened);
        rows.find::<V>(factors, contact);
        sweeper.push_contact::<V>(contact, &rows);
        sweeper.whitened = rows;
    }
}

impl Sweeper {
    /// Adds a contact with sliding friction.
    pub fn add_contact(&mut self, factors: &MassFactors, contact: &Contact) {
        lanes::dispatch_four_lanes(AddContact { sweeper: self, factors, contact });
    }

    /// Adds a block of `n` rows from `row` on, with their whitened rows one after the other in `values`.
    #[allow(clippy::too_many_arguments)]
    pub fn add(&mut self, law: Law, row: usize, n: usize, dofs: &[u32], values: &[f64], b: [f64; 3], lambda: [f64; 3]) {
        let index = self.push_places(dofs);
        let len = self.index.len() - index;
        let first = self.values.len();
        for row in values.chunks(dofs.len().max(1)).take(n) {
            self.values.extend_from_slice(row);
            self.values.extend(std::iter::repeat_n(0.0, len - dofs.len()));
        }
        let y = &self.values[first..];
        let dot = |i: usize, j: usize| super::dot(&y[i * len..(i + 1) * len], &y[j * len..(j + 1) * len]);
        let trace: f64 = (0..n).map(|k| dot(k, k)).sum();
        let local = match n {
            _ if trace <= IMMOBILE => Local::Immobile,
            1 => Local::Scalar { inverse: 1.0 / trace },
            2 => {
                let g = [dot(0, 0), dot(0, 1), dot(1, 1)];
                Local::Tangential { trace, g, problem: TangentialProblem::new(g, trace) }
            }
            _ => Local::Contact(ContactLocal::new([dot(0, 0), dot(0, 1), dot(0, 2), dot(1, 1), dot(1, 2), dot(2, 2)])),
        };
        let rows = self.rows.len();
        if n == 3 {
            self.rows.extend((0..len).map(|j| [y[j], y[len + j], y[2 * len + j], 0.0]));
        }
        self.push_block(law, (row, n), (first, index, rows), local, (b, lambda));
    }

    /// Appends a contact with its whitened rows.
    #[inline(always)]
    fn push_contact<V: Real>(&mut self, contact: &Contact, whitened: &WhitenedRows) {
        let index = self.push_places(&whitened.dofs[..whitened.len]);
        let len = self.index.len() - index;
        let (first, rows) = (self.values.len(), self.rows.len());
        self.rows.extend_from_slice(&whitened.columns[..whitened.len]);
        self.rows.resize(rows + len, [0.0; 4]);
        self.values.resize(first + 3 * len, 0.0);
        let columns = &self.rows[rows..];
        let (normal, across) = self.values[first..].split_at_mut(len);
        let (one, two) = across.split_at_mut(len);
        // products of the rows: sums over even and odd numbers, as everywhere
        let mut sums = [[V::zero(); 3]; 2];
        for j in 0..len {
            let column = columns[j];
            (normal[j], one[j], two[j]) = (column[0], column[1], column[2]);
            let row = V::from_row(&column);
            for i in 0..3 {
                sums[j % 2][i] += row * V::splat(column[i]);
            }
        }
        let mut g = [[0.0; 4]; 3];
        for i in 0..3 {
            (sums[0][i] + sums[1][i]).to_row(&mut g[i]);
        }
        let local = if g[0][0] + g[1][1] + g[2][2] <= IMMOBILE {
            Local::Immobile
        } else {
            Local::Contact(ContactLocal::new([g[0][0], g[0][1], g[0][2], g[1][1], g[1][2], g[2][2]]))
        };
        let law = Law::Coulomb { friction: contact.friction };
        self.push_block(law, (contact.row, 3), (first, index, rows), local, (contact.b, contact.lambda));
    }

    /// Appends the places of degrees of freedom, an even number; returns where they begin.
    #[inline(always)]
    fn push_places(&mut self, dofs: &[u32]) -> usize {
        let index = self.index.len();
        for dof in dofs {
            let place = &mut self.place[*dof as usize];
            if *place == NONE {
                *place = self.z.len() as u32;
                self.z.push(0.0);
            }
            self.index.push(*place);
        }
        if dofs.len() % 2 == 1 {
            self.index.push(0);
        }
        index
    }

    /// Appends a block, whose rows begin at these places of values, index and columns.
    #[inline(always)]
    fn push_block(
        &mut self,
        law: Law,
        (row, n): (usize, usize),
        (values, index, rows): (usize, usize, usize),
        local: Local,
        (b, lambda): ([f64; 3], [f64; 3]),
    ) {
        let len = self.index.len() - index;
        let bodies = match local {
            Local::Contact(_) => Bodies::at(&self.index[index..]),
            _ => Bodies::Other,
        };
        if bodies != Bodies::Other {
            push_packed(&self.values[values..], &mut self.rows);
        }
        let b = [b[0], b[1], b[2], 0.0];
        self.blocks.push(Block { law, row, n, values, index, len, bodies, rows, b, local });
        self.lambda.push(lambda);
    }
}

#[cfg(test)]
mod tests {
    use sincro_math::Lanes;

    use super::*;

    /// Number in (−1, 1).
    fn number(seed: &mut u64) -> f64 {
        *seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (*seed >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
    }

    /// A free body, a tree of hinges on it, and another free body.
    fn factors(seed: &mut u64) -> MassFactors {
        let mut factors = MassFactors::default();
        for (n, parent) in [(6, FIXED), (1, 0), (2, 1), (1, 0), (6, FIXED)] {
            let first = factors.dofs.len() as u32;
            factors.links.push(LinkDofs { dofs: [first, first + n], parent });
            for _ in 0..n {
                let mut six = || core::array::from_fn(|_| number(seed));
                let (axis, u, inv_d) = (six(), six(), 0.1 + number(seed).abs());
                factors.dofs.push(DofFactors { axis, u, inv_d, inv_root: inv_d.sqrt() });
            }
        }
        factors
    }

    /// Numbers of one row by degree of freedom, each with the operations of the lanes, link by link from the last one.
    fn row(factors: &MassFactors, links: [u32; 2], wrench: [f64; 6]) -> Vec<f64> {
        let mut forces = vec![[0.0; 6]; factors.links.len()];
        for (link, sign) in links.into_iter().zip([1.0, -1.0]).filter(|(link, _)| *link != FIXED) {
            (0..6).for_each(|i| forces[link as usize][i] += sign * wrench[i]);
        }
        let mut numbers = vec![0.0; factors.dofs.len()];
        for (k, link) in factors.links.iter().enumerate().rev() {
            for dof in (link.dofs[0]..link.dofs[1]).rev() {
                let of = &factors.dofs[dof as usize];
                let along = dot(&of.axis, &forces[k]);
                numbers[dof as usize] = along * of.inv_root;
                (0..6).for_each(|i| forces[k][i] -= of.u[i] * (along * of.inv_d));
            }
            if link.parent != FIXED {
                (0..6).for_each(|i| forces[link.parent as usize][i] += forces[k][i]);
            }
        }
        numbers
    }

    fn contact(links: [u32; 2], seed: &mut u64) -> Contact {
        let wrench = core::array::from_fn(|_| [number(seed), number(seed), number(seed), 0.0]);
        let b = core::array::from_fn(|_| number(seed));
        Contact { friction: 0.5, row: 0, links, wrench, b, lambda: [1.0, 0.2, 0.1] }
    }

    #[test]
    fn rows_by_lanes_are_those_of_each_row_by_itself() {
        let mut seed = 5;
        for links in [[0, FIXED], [FIXED, 4], [2, 4], [4, 2], [2, 3], [3, 1], [2, 1], [2, FIXED]] {
            let factors = factors(&mut seed);
            let contact = contact(links, &mut seed);
            let mut found = WhitenedRows::default();
            found.find::<Lanes<4>>(&factors, &contact);
            for c in 0..3 {
                let wanted = row(&factors, links, contact.wrench.map(|of_rows| of_rows[c]));
                let mut dense = vec![0.0; wanted.len()];
                for j in 0..found.len {
                    dense[found.dofs[j] as usize] = found.columns[j][c];
                }
                assert_eq!(dense, wanted, "{links:?}");
            }
        }
    }

    #[test]
    fn a_contact_is_the_block_of_its_rows() {
        let mut seed = 9;
        // ways of one and two bodies, of an odd number of degrees of freedom, and of none
        for links in [[0, FIXED], [0, 4], [1, FIXED], [3, 4], [FIXED, FIXED]] {
            let factors = factors(&mut seed);
            let contact = contact(links, &mut seed);
            let [mut one, mut other] = [Sweeper::default(), Sweeper::default()];
            one.clear(factors.dofs.len());
            other.clear(factors.dofs.len());
            one.add_contact(&factors, &contact);
            let mut found = WhitenedRows::default();
            found.find::<Lanes<4>>(&factors, &contact);
            let (dofs, columns) = (&found.dofs[..found.len], &found.columns[..found.len]);
            let values: Vec<f64> = (0..3).flat_map(|c| columns.iter().map(move |column| column[c])).collect();
            other.add(Law::Coulomb { friction: 0.5 }, 0, 3, dofs, &values, contact.b, contact.lambda);
            let all = |s: &Sweeper| format!("{:?} {:?} {:?} {:?}", s.blocks, s.values, s.index, s.lambda);
            assert_eq!((all(&one), &one.rows), (all(&other), &other.rows), "{links:?}");
            one.resize_buffers();
            one.z.iter_mut().for_each(|z| *z = number(&mut seed));
            assert_eq!(one.rates_by_columns::<Lanes<4>>(0), one.rates_of_others(0), "{links:?}");
        }
    }
}
