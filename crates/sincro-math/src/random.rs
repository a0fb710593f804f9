//! Random numbers of SplitMix64 (Steele, Lea, Flood 2014), whose n-th number is a hash of `seed + (n+1)·γ`.

/// 2⁶⁴ over the golden ratio, made odd.
const GAMMA: u64 = 0x9e37_79b9_7f4a_7c15;

/// Random number `n` (counted from 0) of the SplitMix64 generator of a `seed`: 64 uniformly distributed bits. A
/// function of both alone, so that any number of a sequence can be computed without those before it.
#[must_use]
pub fn splitmix64(seed: u64, n: u64) -> u64 {
    let mut z = seed.wrapping_add(n.wrapping_add(1).wrapping_mul(GAMMA));
    z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    z ^ (z >> 31)
}

/// SplitMix64 generator with its position in the sequence: for noise and turbulence that must be the same in every run.
///
/// ```
/// use sincro_math::random::SplitMix64;
///
/// let (mut a, mut b) = (SplitMix64::new(7), SplitMix64::new(7));
/// let x = a.unit();
/// assert!(x == b.unit() && (0.0..1.0).contains(&x));
/// ```
#[derive(Clone, Debug)]
pub struct SplitMix64 {
    seed: u64,
    n: u64,
}

impl SplitMix64 {
    /// Creates the generator of a `seed`, at the first number of its sequence.
    #[must_use]
    pub fn new(seed: u64) -> Self {
        Self { seed, n: 0 }
    }

    /// Returns the next number, uniformly distributed in [0, 1) with 53 bits (dimensionless), and advances.
    pub fn unit(&mut self) -> f64 {
        let bits = splitmix64(self.seed, self.n);
        self.n = self.n.wrapping_add(1);
        (bits >> 11) as f64 / (1_u64 << 53) as f64
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_generator_gives_its_published_numbers() {
        let found: Vec<u64> = (0..3).map(|n| splitmix64(1_234_567, n)).collect();
        assert_eq!(found, [6_457_827_717_110_365_317, 3_203_168_211_198_807_973, 9_817_491_932_198_370_423]);
        let mut generator = SplitMix64::new(1_234_567);
        for bits in found {
            assert_eq!(generator.unit(), (bits >> 11) as f64 / (1_u64 << 53) as f64);
        }
    }
}
