//! Anderson acceleration of sweeps: after each, the forces move on from what the sweep made of them, along the
//! differences between the results of the last sweeps.
//!
//! With r the change of the whitened velocities by a sweep, g their value after it, and Δ the difference of a number
//! from that of the sweep before, the next sweep begins at g − Σ γⱼ Δgⱼ, where γ makes ‖r − Σ γⱼ Δrⱼ‖ least over the
//! last [`DEPTH`] differences. Velocities weigh forces and torques by their effect; the forces, of which the velocities
//! are a linear function, move by the same γ. Where a sweep changes the velocities by more than the last one did,
//! contacts have changed their modes, and the differences are dropped. Source: key `walker2011`.

use core::array::from_fn;

use sincro_math::Real;

/// Number of differences.
const DEPTH: usize = 3;

/// Square of a difference beyond what the later ones explain of it, relative to the whole, below which it says nothing
/// new.
const LEAST_SHARE: f64 = 1e-14;

/// Sum of all |γⱼ| beyond which the differences are dropped.
const MAX_SUM: f64 = 1e3;

/// Results of the last sweeps of an island.
#[derive(Clone, Debug, Default)]
pub(super) struct Anderson {
    /// Number of results in use, the last included; the differences are one fewer, and not more than the depth.
    sweeps: usize,
    /// Square of the change of the velocities by the last sweep.
    square: f64,
    velocities: Vec<VelocityHistory>,
    forces: Vec<ForceHistory>,
    /// Scalar products of the differences of changes.
    products: [[f64; DEPTH]; DEPTH],
}

/// Four velocities: their change by the last sweep, their values after it, and the differences of both. The
/// differences of sweep k stand at k modulo the depth.
#[derive(Clone, Copy, Debug, Default)]
struct VelocityHistory {
    change: [f64; 4],
    value: [f64; 4],
    changes: [[f64; 4]; DEPTH],
    values: [[f64; 4]; DEPTH],
}

/// Four numbers of forces after the last sweep, and their differences.
#[derive(Clone, Copy, Debug, Default)]
struct ForceHistory {
    value: [f64; 4],
    values: [[f64; 4]; DEPTH],
}

impl Anderson {
    /// Begins with an island of so many velocities and numbers of forces.
    pub fn restart(&mut self, velocities: usize, forces: usize) {
        self.sweeps = 0;
        self.velocities.clear();
        self.velocities.resize(velocities.div_ceil(4), VelocityHistory::default());
        self.forces.clear();
        self.forces.resize(forces.div_ceil(4), ForceHistory::default());
    }

    /// Moves `velocities` and `forces`, which a sweep has made of the velocities `before`.
    #[inline(always)]
    pub fn advance<V: Real>(&mut self, before: &[f64], velocities: &mut [f64], forces: &mut [f64]) {
        let new = self.sweeps % DEPTH;
        let (mut square, mut right, mut products) = (V::zero(), [V::zero(); DEPTH], [V::zero(); DEPTH]);
        for (k, of) in self.velocities.iter_mut().enumerate() {
            let value = four::<V>(velocities, k);
            let change = value - four::<V>(before, k);
            let difference = change - V::from_row(&of.change);
            difference.to_row(&mut of.changes[new]);
            (value - V::from_row(&of.value)).to_row(&mut of.values[new]);
            change.to_row(&mut of.change);
            value.to_row(&mut of.value);
            square += change * change;
            for j in 0..DEPTH {
                let other = V::from_row(&of.changes[j]);
                right[j] += other * change;
                products[j] += other * difference;
            }
        }
        let square = sum(square);
        let is_larger = self.sweeps > 0 && square > self.square;
        self.square = square;
        self.sweeps = if is_larger { 1 } else { self.sweeps + 1 };
        let count = if self.sweeps <= DEPTH { self.sweeps - 1 } else { DEPTH };
        for j in 0..DEPTH {
            let product = sum(products[j]);
            (self.products[new][j], self.products[j][new]) = (product, product);
        }
        let gamma = self.find_gamma(new, count, right);
        let by = [V::splat(gamma[0]), V::splat(gamma[1]), V::splat(gamma[2])];
        for (k, of) in self.forces.iter_mut().enumerate() {
            let value = four::<V>(forces, k);
            (value - V::from_row(&of.value)).to_row(&mut of.values[new]);
            value.to_row(&mut of.value);
            if count > 0 {
                put(moved(value, &of.values, by), forces, k);
            }
        }
        if count > 0 {
            for (k, of) in self.velocities.iter().enumerate() {
                put(moved(V::from_row(&of.value), &of.values, by), velocities, k);
            }
        }
    }

    /// The γ of each place of differences, of which `count` count, the latest at `new`: zero for the others.
    #[inline(always)]
    fn find_gamma<V: Real>(&mut self, new: usize, count: usize, of_places: [V; DEPTH]) -> [f64; DEPTH] {
        // Gauss's method on the normal equations, the latest difference first
        let mut gamma = [0.0; DEPTH];
        let places: [usize; DEPTH] = from_fn(|age| (new + DEPTH - age) % DEPTH);
        let mut matrix: [[f64; DEPTH]; DEPTH] = from_fn(|i| from_fn(|j| self.products[places[i]][places[j]]));
        let mut right = [0.0; DEPTH];
        for i in 0..DEPTH {
            right[i] = sum(of_places[places[i]]);
        }
        let mut inverse = [0.0; DEPTH];
        for i in 0..count {
            let whole = self.products[places[i]][places[i]];
            inverse[i] = if matrix[i][i] > LEAST_SHARE * whole { 1.0 / matrix[i][i] } else { 0.0 };
            for j in i + 1..count {
                let share = matrix[j][i] * inverse[i];
                for c in i + 1..count {
                    matrix[j][c] -= share * matrix[i][c];
                }
                right[j] -= share * right[i];
            }
        }
        let mut size = 0.0;
        for i in (0..count).rev() {
            let mut rest = right[i];
            for j in i + 1..count {
                rest -= matrix[i][j] * gamma[places[j]];
            }
            gamma[places[i]] = rest * inverse[i];
            size += gamma[places[i]].abs();
        }
        if size < MAX_SUM {
            return gamma;
        }
        self.sweeps = 1;
        [0.0; DEPTH]
    }
}

/// A value less the differences, each times its γ.
#[inline(always)]
fn moved<V: Real>(value: V, differences: &[[f64; 4]; DEPTH], by: [V; DEPTH]) -> V {
    let mut moved = value;
    for j in 0..DEPTH {
        moved -= V::from_row(&differences[j]) * by[j];
    }
    moved
}

/// Four numbers of a list, or what there are of them and zeros.
#[inline(always)]
fn four<V: Real>(list: &[f64], k: usize) -> V {
    if 4 * k + 4 <= list.len() {
        return V::from_row(&list[4 * k..4 * k + 4]);
    }
    let mut row = [0.0; 4];
    let rest = &list[4 * k..];
    row[..rest.len()].copy_from_slice(rest);
    V::from_row(&row)
}

/// Puts them back.
#[inline(always)]
fn put<V: Real>(numbers: V, list: &mut [f64], k: usize) {
    if 4 * k + 4 <= list.len() {
        return numbers.to_row(&mut list[4 * k..4 * k + 4]);
    }
    let mut row = [0.0; 4];
    numbers.to_row(&mut row);
    let rest = &mut list[4 * k..];
    let n = rest.len();
    rest.copy_from_slice(&row[..n]);
}

/// Sum of four lanes.
#[inline(always)]
fn sum<V: Real>(lanes: V) -> f64 {
    let mut row = [0.0; 4];
    lanes.to_row(&mut row);
    (row[0] + row[1]) + (row[2] + row[3])
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

    /// Forces of which a sweep makes c + Σ aᵢ (bᵢ·λ), and their velocities, a linear function of them.
    struct LinearSweep {
        a: Vec<Vec<f64>>,
        b: Vec<Vec<f64>>,
        c: Vec<f64>,
        y: Vec<Vec<f64>>,
    }

    impl LinearSweep {
        fn of(forces: usize, velocities: usize, rank: usize, seed: &mut u64) -> Self {
            let mut list = |n: usize, scale: f64| -> Vec<f64> { (0..n).map(|_| scale * number(seed)).collect() };
            let mut lists =
                |count: usize, n: usize, scale: f64| -> Vec<Vec<f64>> { (0..count).map(|_| list(n, scale)).collect() };
            let (a, b) = (lists(rank, forces, 0.4), lists(rank, forces, 0.4));
            let (y, c) = (lists(velocities, forces, 1.0), lists(1, forces, 1.0).remove(0));
            Self { a, b, c, y }
        }

        fn product(x: &[f64], y: &[f64]) -> f64 {
            x.iter().zip(y).map(|(x, y)| x * y).sum()
        }

        fn velocities(&self, forces: &[f64]) -> Vec<f64> {
            self.y.iter().map(|y| Self::product(y, forces)).collect()
        }

        /// Result of a sweep.
        fn swept(&self, forces: &[f64]) -> Vec<f64> {
            let along: Vec<f64> = self.b.iter().map(|b| Self::product(b, forces)).collect();
            (0..forces.len())
                .map(|k| self.c[k] + along.iter().zip(&self.a).map(|(x, a)| x * a[k]).sum::<f64>())
                .collect()
        }
    }

    #[test]
    fn a_sweep_that_mixes_along_two_directions_is_solved_by_the_fourth() {
        let mut seed = 11;
        for case in 0..200 {
            let (n, n_z) = (6 + case % 9, 6 + case % 7);
            let problem = LinearSweep::of(n, n_z, 2, &mut seed);
            let (mut anderson, mut forces) = (Anderson::default(), vec![0.0; n]);
            anderson.restart(n_z, n);
            let mut before = problem.velocities(&forces);
            for _ in 0..4 {
                forces = problem.swept(&forces);
                let mut z = problem.velocities(&forces);
                anderson.advance::<Lanes<4>>(&before, &mut z, &mut forces);
                // velocities stay those of the forces
                for (z, wanted) in z.iter().zip(problem.velocities(&forces)) {
                    assert!((z - wanted).abs() < 1e-9 * (1.0 + wanted.abs()), "case {case}: {z} for {wanted}");
                }
                before = z;
            }
            for (force, wanted) in forces.iter().zip(problem.swept(&forces)) {
                assert!((force - wanted).abs() < 1e-6 * (1.0 + wanted.abs()), "case {case}: {force} for {wanted}");
            }
        }
    }

    #[test]
    fn forces_stay_where_a_sweep_changes_more_than_the_last() {
        let (mut anderson, mut seed) = (Anderson::default(), 3);
        anderson.restart(6, 9);
        let mut before = vec![0.0; 6];
        for sweep in 1..6 {
            let z: Vec<f64> = before.iter().map(|z| z + f64::from(sweep) + 0.1 * number(&mut seed)).collect();
            let forces: Vec<f64> = (0..9).map(|_| number(&mut seed)).collect();
            let (mut moved_z, mut moved) = (z.clone(), forces.clone());
            anderson.advance::<Lanes<4>>(&before, &mut moved_z, &mut moved);
            assert_eq!((&moved_z, &moved), (&z, &forces), "sweep {sweep}");
            before = z;
        }
    }
}
