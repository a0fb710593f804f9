//! Random numbers by their place: no state, so that any sample can be computed again on its own.
//!
//! The numbers are those of SplitMix64 ([`sincro_math::random`]), whose n-th number is a hash of seed and n. The key
//! of a component is number `component` of the generator seeded with the block's seed; the numbers of that component
//! are those of the generator seeded with its key.

use sincro_math::random::splitmix64;

/// Random number `n` (counted from 0) of the stream of `seed`, uniformly distributed in the open interval (0, 1), so
/// that its logarithm is finite; dimensionless.
#[must_use]
pub fn uniform(seed: u64, n: u64) -> f64 {
    // the upper 52 bits, each interval represented by its middle
    ((splitmix64(seed, n) >> 12) as f64 + 0.5) / (1u64 << 52) as f64
}

/// Random number `n` (counted from 0) of the stream of `seed`, normally distributed with mean 0 and variance 1
/// (Box–Muller of the uniform numbers `2n` and `2n+1`); dimensionless.
#[must_use]
pub fn gaussian(seed: u64, n: u64) -> f64 {
    let (u1, u2) = (uniform(seed, n.wrapping_mul(2)), uniform(seed, n.wrapping_mul(2).wrapping_add(1)));
    let radius = (-2.0 * sincro_math::elementary::ln(u1).0).sqrt();
    radius * sincro_math::elementary::sin_cos(core::f64::consts::TAU * u2).1
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn gaussian_numbers_have_the_moments_of_the_normal_distribution() {
        let n = 100_000;
        let moment = |power: i32| (0..n).map(|k| gaussian(7, k).powi(power)).sum::<f64>() / n as f64;
        // standard deviations of the estimates: 1/√n, √2/√n, √15/√n, √96/√n; four of them are allowed
        let bound = |deviation: f64| 4.0 * deviation / (n as f64).sqrt();
        assert!(moment(1).abs() < bound(1.0));
        assert!((moment(2) - 1.0).abs() < bound(2f64.sqrt()));
        assert!(moment(3).abs() < bound(15f64.sqrt()));
        assert!((moment(4) - 3.0).abs() < bound(96f64.sqrt()));
    }
}
