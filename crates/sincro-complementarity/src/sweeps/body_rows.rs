//! Rows of contacts of bodies with six velocities one after the other, such as free ones: products by four lanes.
//!
//! A contact has three rows yᵢ, with six numbers for each of its one or two bodies. They stand twice: column by column,
//! which takes the rates y·z without a sum across lanes, and row by row, which takes z + Σ yᵢ dᵢ so. Rows are packed:
//! the first four numbers of each body, then the last two of both.

use sincro_math::Real;

/// Bodies that the rows of a contact with sliding friction move, where each has six velocities one after the other:
/// free ones, and links of robots with so many joints before them. The velocities of two contacts may overlap.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Bodies {
    /// First velocity of one body.
    One(usize),
    /// First velocities of two bodies.
    Two(usize, usize),
    /// Any others.
    Other,
}

impl Bodies {
    /// The bodies with velocities at these places.
    pub fn at(index: &[u32]) -> Self {
        let first = |run: &[u32]| run.iter().zip(run[0]..).all(|(i, j)| *i == j).then_some(run[0] as usize);
        match index.len() {
            6 => first(index).map_or(Self::Other, Self::One),
            12 => first(&index[..6]).zip(first(&index[6..])).map_or(Self::Other, |(one, two)| Self::Two(one, two)),
            _ => Self::Other,
        }
    }
}

/// Appends the rows `y` of a contact, one after the other, to `to`, packed.
pub(super) fn push_packed(y: &[f64], to: &mut Vec<[f64; 4]>) {
    let len = y.len() / 3;
    for row in y.chunks_exact(len) {
        to.extend(row.chunks_exact(6).map(|body| [body[0], body[1], body[2], body[3]]));
        let second = if len == 12 { [row[10], row[11]] } else { [0.0; 2] };
        to.push([row[4], row[5], second[0], second[1]]);
    }
}

/// Three rows of a contact of `N` bodies.
#[derive(Clone, Copy, Debug)]
pub(super) struct BodyRows<'a, const N: usize> {
    pub columns: &'a [[f64; 4]],
    packed: &'a [[f64; 4]],
    /// First velocity of each body.
    pub at: [usize; N],
}

impl<'a, const N: usize> BodyRows<'a, N> {
    /// The rows that begin a list: their columns, then they are packed.
    #[inline(always)]
    pub fn first_of(list: &'a [[f64; 4]], at: [usize; N]) -> Self {
        let (columns, rest) = list.split_at(6 * N);
        Self { columns, packed: &rest[..3 * (N + 1)], at }
    }

    /// b + y·z, without the last number of b.
    #[inline(always)]
    pub fn rates<V: Real>(&self, b: &[f64; 4], z: &[f64]) -> [f64; 3] {
        let mut sums = [V::from_row(b), V::zero(), V::zero(), V::zero()];
        // loops over numbers: closures are not inlined into code for other registers
        for i in 0..N {
            let z = &z[self.at[i]..self.at[i] + 6];
            for j in 0..6 {
                sums[(2 * i + j) % 4] += V::from_row(&self.columns[6 * i + j]) * V::splat(z[j]);
            }
        }
        let mut u = [0.0; 4];
        ((sums[0] + sums[1]) + (sums[2] + sums[3])).to_row(&mut u);
        [u[0], u[1], u[2]]
    }

    /// Part `i` of Σ yᵢ dᵢ, packed.
    #[inline(always)]
    pub fn part<V: Real>(&self, i: usize, d: [V; 3]) -> V {
        let (one, two) = (V::from_row(&self.packed[i]), V::from_row(&self.packed[N + 1 + i]));
        (one * d[0] + two * d[1]) + V::from_row(&self.packed[2 * (N + 1) + i]) * d[2]
    }

    /// Adds Σ yᵢ dᵢ to z.
    #[inline(always)]
    pub fn add_to<V: Real>(&self, d: [f64; 3], z: &mut [f64]) {
        let d = [V::splat(d[0]), V::splat(d[1]), V::splat(d[2])];
        let mut last = [0.0; 4];
        self.part(N, d).to_row(&mut last);
        for i in 0..N {
            let z = &mut z[self.at[i]..self.at[i] + 6];
            (V::from_row(z) + self.part(i, d)).to_row(z);
            z[4] += last[2 * i];
            z[5] += last[2 * i + 1];
        }
    }
}

#[cfg(test)]
mod tests {
    use sincro_math::Lanes;

    use super::*;

    fn columns(y: &[f64]) -> Vec<[f64; 4]> {
        let len = y.len() / 3;
        (0..len).map(|j| [y[j], y[len + j], y[2 * len + j], 0.0]).collect()
    }

    #[test]
    fn products_by_lanes_are_those_of_the_rows() {
        let y: Vec<f64> = (0..36).map(|k| f64::from(k * k % 23) - 11.0).collect();
        let z: Vec<f64> = (0..20).map(|k| f64::from(k * 7 % 13) - 6.0).collect();
        let (b, d, places) = ([1.0, -2.0, 3.0, 0.0], [2.0, -1.0, 5.0], [13, 1]);
        let mut list = columns(&y);
        push_packed(&y, &mut list);
        let rows = BodyRows::first_of(&list, places);
        let at: Vec<usize> = (13..19).chain(1..7).collect();
        let (mut moved, mut wanted) = (z.clone(), z.clone());
        rows.add_to::<Lanes<4>>(d, &mut moved);
        let u = rows.rates::<Lanes<4>>(&b, &z);
        for k in 0..3 {
            // whole numbers: any order of sums has the same result
            assert_eq!(u[k], b[k] + at.iter().enumerate().map(|(j, i)| y[12 * k + j] * z[*i]).sum::<f64>());
            at.iter().enumerate().for_each(|(j, i)| wanted[*i] += y[12 * k + j] * d[k]);
        }
        assert_eq!(moved, wanted);
        // a single body
        let mut list = columns(&y[..18]);
        push_packed(&y[..18], &mut list);
        let rows = BodyRows::first_of(&list, [2]);
        let (mut moved, mut wanted) = (z.clone(), z.clone());
        rows.add_to::<Lanes<4>>(d, &mut moved);
        (0..18).for_each(|k| wanted[2 + k % 6] += y[k] * d[k / 6]);
        assert_eq!(moved, wanted);
    }
}
