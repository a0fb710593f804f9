//! Poles: eigenvalues of A and what they mean. Cost: 10 n³ or so.
//!
//! A is balanced by powers of two and brought to real Schur form (key `golub2013`, 7.4 and 7.5). The library's
//! iteration has no exceptional shifts and stalls on some matrices (a cyclic permutation); then the eigenvalues `ν` of
//! `(A − μ I)⁻¹` are taken instead, `λ = μ + 1/ν`.

use nalgebra::linalg::{Schur, balancing::balance_parlett_reinsch};
use sincro_math::elementary::{atan2, ln};

use super::{Complex, DMatrix, StateSpace, modulus};

/// Sweeps of the eigenvalue iteration; twenty or so are needed per eigenvalue at most.
const MAX_SWEEPS: usize = 3000;
/// A multiple eigenvalue is known only to the root of the rounding error; real parts below this share of A are taken as
/// zero.
const ZERO: f64 = 3e-8;

/// Pole λ of a linear system and the motion `e^{λ t}` that belongs to it; an entry of [`StateSpace::poles`].
///
/// ```
/// use sincro_analysis::prelude::*;
///
/// # fn main() -> Result<(), LinearError> {
/// // 1 kg on a spring of 4 N/m with a damper of 0.4 N·s/m: ζ = d/(2 √(k m))
/// let a = DMatrix::from_row_slice(2, 2, &[0.0, 1.0, -4.0, -0.4]);
/// let (b, c) = (DMatrix::from_row_slice(2, 1, &[0.0, 1.0]), DMatrix::from_row_slice(1, 2, &[1.0, 0.0]));
/// let mode: Mode = StateSpace::from_matrices(a, b, c, DMatrix::zeros(1, 1))?.poles()[0];
/// assert!((mode.natural_frequency - 2.0).abs() < 1e-12); // [rad/s]
/// assert!((mode.damping_ratio - 0.1).abs() < 1e-12);
/// assert!((mode.time_constant - 5.0).abs() < 1e-12); // [s]
/// # Ok(())
/// # }
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Mode {
    /// Eigenvalue of A: λ `[1/s]` of a continuous system, dimensionless (`e^{λ T}` over one sample time T) of a sampled
    /// one. The other fields are those of λ in both cases.
    pub pole: Complex<f64>,
    /// Damping ratio `ζ = −Re λ / |λ|` (dimensionless); negative if the motion grows, 1 for a pole at zero.
    pub damping_ratio: f64,
    /// Natural frequency `ω_n = |λ|` `[rad/s]`.
    pub natural_frequency: f64,
    /// Time constant `−1 / Re λ`, in which the motion decays to 1/e `[s]`; negative if it grows, infinite if it does
    /// neither.
    pub time_constant: f64,
}

/// Stability of a linear system, by the motion after a small disturbance; result of [`StateSpace::stability`].
///
/// ```
/// use sincro_analysis::prelude::*;
///
/// # fn main() -> Result<(), LinearError> {
/// // an inverted pendulum q'' = 9 q + u, alone and with the feedback u = −k q − 2 q'
/// let stability = |k: f64, d: f64| -> Result<Stability, LinearError> {
///     let a = DMatrix::from_row_slice(2, 2, &[0.0, 1.0, 9.0 - k, -d]);
///     let (b, c) = (DMatrix::from_row_slice(2, 1, &[0.0, 1.0]), DMatrix::from_row_slice(1, 2, &[1.0, 0.0]));
///     Ok(StateSpace::from_matrices(a, b, c, DMatrix::zeros(1, 1))?.stability())
/// };
/// assert_eq!(stability(0.0, 0.0)?, Stability::Unstable);
/// assert_eq!(stability(13.0, 0.0)?, Stability::Marginal);
/// assert_eq!(stability(13.0, 2.0)?, Stability::Stable);
/// # Ok(())
/// # }
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Stability {
    /// Asymptotically stable: every disturbance decays; all poles have negative real parts (sampled: lie inside the
    /// unit circle).
    Stable,
    /// Marginally stable: no disturbance grows, but some stay; poles on the imaginary axis (sampled: unit circle), or
    /// so near to it that rounding decides. A multiple pole at zero, whose motion grows linearly, counts as marginal,
    /// too.
    Marginal,
    /// Unstable: some disturbance grows exponentially.
    Unstable,
}

impl Mode {
    /// The meaning of an eigenvalue; `size` is the magnitude of A, against which a real part may be nothing.
    fn new(pole: Complex<f64>, sample_time: Option<f64>, size: f64) -> Self {
        let rate = match sample_time {
            None => pole,
            Some(tick) => Complex::new(ln(modulus(pole)).0 / tick, atan2(pole.im, pole.re).0 / tick),
        };
        let natural_frequency = modulus(rate);
        let is_zero = rate.re.abs() <= 1e-14 * size;
        Self {
            pole,
            // an integrator does not swing, nor does a sampled pole at zero, which is over after its tick
            damping_ratio: match natural_frequency {
                0.0 | f64::INFINITY => 1.0,
                _ => -rate.re / natural_frequency + 0.0,
            },
            natural_frequency,
            time_constant: if is_zero { f64::INFINITY } else { -1.0 / rate.re + 0.0 },
        }
    }
}

impl StateSpace {
    /// Returns the `n` poles with their motions, slowest first (ascending natural frequency); of a complex pair the one
    /// with positive imaginary part first. Poles at zero that follow from cyclic coordinates are exactly zero.
    ///
    /// ```
    /// use sincro_analysis::prelude::*;
    ///
    /// # fn main() -> Result<(), LinearError> {
    /// // two lags, of 0.5 s and 0.1 s: the slowest comes first
    /// let a = DMatrix::from_row_slice(2, 2, &[-10.0, 0.0, 3.0, -2.0]);
    /// let (b, c) = (DMatrix::from_row_slice(2, 1, &[1.0, 0.0]), DMatrix::from_row_slice(1, 2, &[0.0, 1.0]));
    /// let poles = StateSpace::from_matrices(a, b, c, DMatrix::zeros(1, 1))?.poles();
    /// let real: Vec<f64> = poles.iter().map(|mode| mode.pole.re).collect();
    /// assert!((real[0] + 2.0).abs() < 1e-12 && (real[1] + 10.0).abs() < 1e-12); // [1/s]
    /// # Ok(())
    /// # }
    /// ```
    #[must_use]
    pub fn poles(&self) -> Vec<Mode> {
        let size = self.a.norm();
        let poles = match self.sample_time {
            None => deflated_eigenvalues(&self.a),
            Some(_) => eigenvalues(&self.a),
        };
        let mut modes: Vec<Mode> = poles.into_iter().map(|pole| Mode::new(pole, self.sample_time, size)).collect();
        modes.sort_by(|a, b| {
            let by_speed = rough(a.natural_frequency).total_cmp(&rough(b.natural_frequency));
            by_speed.then(a.pole.re.total_cmp(&b.pole.re)).then(b.pole.im.total_cmp(&a.pole.im))
        });
        modes
    }

    /// Returns the stability of the system, from the pole with the greatest real part (sampled: modulus).
    #[must_use]
    pub fn stability(&self) -> Stability {
        let excess = |mode: &Mode| match self.sample_time {
            None => mode.pole.re / self.a.norm().max(f64::MIN_POSITIVE),
            Some(_) => modulus(mode.pole) - 1.0,
        };
        let worst = self.poles().iter().map(excess).fold(f64::NEG_INFINITY, f64::max);
        // only poles that may be multiple zeros get the wide bracket; a slow but sure decay is stable
        match worst {
            w if w < -1e-13 => Stability::Stable,
            w if w <= ZERO => Stability::Marginal,
            _ => Stability::Unstable,
        }
    }

    /// Returns true if every small disturbance decays: [`StateSpace::stability`] is [`Stability::Stable`].
    #[must_use]
    pub fn is_stable(&self) -> bool {
        self.stability() == Stability::Stable
    }
}

impl StateSpace {
    /// Returns the indices of the states, ascending, on which no rate depends but those of others in the list: cyclic
    /// coordinates and their speeds, which move at constant rates. Each has a pole at zero. Empty for a sampled system.
    #[must_use]
    pub fn cyclic_states(&self) -> Vec<usize> {
        let mut left: Vec<usize> = (0..self.n_states()).collect();
        let mut cyclic = Vec::new();
        let size = self.a.amax();
        if size == 0.0 || self.sample_time.is_some() {
            return if self.sample_time.is_some() { cyclic } else { left };
        }
        // a state on whose rate and value no other rate depends can be left out; then others may follow
        while let Some(at) = left.iter().position(|&k| left.iter().all(|&i| self.a[(i, k)].abs() <= NO_EFFECT * size)) {
            cyclic.push(left.remove(at));
        }
        cyclic.sort_unstable();
        cyclic
    }
}

/// Entries of A below this share of its largest are rounding of an effect that does not exist.
const NO_EFFECT: f64 = 1e-13;

/// Singular values below this share of the norm, and of the number of rows, count as zero where zero poles are taken
/// out.
const NULL: f64 = 1e-15;

/// Least size of the largest entry of a matrix that is taken as it is; its inverse is the greatest one.
const LEAST_SCALE: f64 = 1e-100;

/// Eigenvalues with those at zero exactly zero: multiple ones, of coordinates that no rate depends on, would come out
/// as roots of the rounding. The null space is split off by an orthogonal transformation until none is left (key
/// `golub2013`, 7.6.5).
fn deflated_eigenvalues(matrix: &DMatrix<f64>) -> Vec<Complex<f64>> {
    let mut rest = matrix.clone();
    if rest.is_empty() || rest.iter().any(|x| !x.is_finite()) {
        return eigenvalues(matrix);
    }
    let scale = scale_of(matrix);
    rest /= scale;
    let _ = balance_parlett_reinsch(&mut rest);
    let size = rest.norm();
    let mut zeros = 0;
    while !rest.is_empty() {
        let n = rest.nrows();
        let svd = rest.clone().svd(false, true);
        let Some(v_t) = svd.v_t else { break };
        let least = NULL * n as f64 * size;
        let null: Vec<usize> = (0..n).filter(|k| svd.singular_values[*k] <= least).collect();
        if null.is_empty() {
            break;
        }
        // the rows of V^T that are left span an invariant subspace of A^T
        let kept: Vec<usize> = (0..n).filter(|k| !null.contains(k)).collect();
        let v = v_t.select_rows(&kept);
        rest = &v * rest * v.transpose();
        zeros += null.len();
    }
    let mut found = vec![Complex::new(0.0, 0.0); zeros];
    found.extend(eigenvalues(&rest).into_iter().map(|value| value * scale));
    found
}

/// Factor of matrices whose entries have squares that are no numbers, with which the library's iterations do not end;
/// else 1.
fn scale_of(matrix: &DMatrix<f64>) -> f64 {
    let most = matrix.amax();
    if most == 0.0 || (LEAST_SCALE..1.0 / LEAST_SCALE).contains(&most) { 1.0 } else { most }
}

/// Returns the `n` eigenvalues of a real `n×n` matrix, in the unit of its entries (`[1/s]` for A of a continuous
/// system), ordered by modulus, then real part, then imaginary part from above. All are NaN if an entry is not finite.
///
/// # Panics
///
/// If the matrix is not square.
#[must_use]
pub fn eigenvalues(matrix: &DMatrix<f64>) -> Vec<Complex<f64>> {
    assert!(matrix.is_square(), "eigenvalues of a square matrix");
    if matrix.is_empty() {
        return Vec::new();
    }
    if matrix.iter().any(|x| !x.is_finite()) {
        return vec![Complex::new(f64::NAN, f64::NAN); matrix.nrows()];
    }
    let scale = scale_of(matrix);
    let mut balanced = matrix / scale;
    let _ = balance_parlett_reinsch(&mut balanced);
    let mut found = by_schur(&balanced).or_else(|| by_inverse(&balanced)).unwrap_or_else(|| {
        // both iterations stalled, which no matrix is known to do; say so rather than guess
        vec![Complex::new(f64::NAN, f64::NAN); matrix.nrows()]
    });
    found.sort_by(|a, b| {
        let by_size = rough(modulus(*a)).total_cmp(&rough(modulus(*b)));
        by_size.then(a.re.total_cmp(&b.re)).then(b.im.total_cmp(&a.im))
    });
    found.iter_mut().for_each(|value| *value *= scale);
    found
}

/// Seven digits: moduli that differ only by rounding, such as those of ±a, do not decide the order.
fn rough(modulus: f64) -> f32 {
    modulus as f32
}

fn by_schur(matrix: &DMatrix<f64>) -> Option<Vec<Complex<f64>>> {
    let schur = Schur::try_new(matrix.clone(), f64::EPSILON, MAX_SWEEPS)?;
    // `+ 0.0` makes negative zeros positive
    Some(schur.complex_eigenvalues().iter().map(|z| Complex::new(z.re + 0.0, z.im + 0.0)).collect())
}

fn by_inverse(matrix: &DMatrix<f64>) -> Option<Vec<Complex<f64>>> {
    let n = matrix.nrows();
    // any real number off the spectrum; it lies beyond the Frobenius norm, hence beyond every eigenvalue
    let shift = 1.37 * matrix.norm();
    let inverse = (matrix - DMatrix::identity(n, n) * shift).try_inverse()?;
    let found = by_schur(&inverse)?;
    Some(found.into_iter().map(|nu| Complex::new(shift, 0.0) + nu.inv()).collect())
}
