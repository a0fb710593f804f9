//! Counter-based random numbers: Philox 4×32-10 (Salmon, Moraes, Dror, Shaw 2011), and permutations by index.
//!
//! A draw is a function of the seed and a counter alone. It depends neither on the draws before it nor on the thread or
//! the machine that asks for it, which is what makes shards, restarts and the repetition of a single run exact.

/// Factors and increments of Philox.
const FACTORS: [u64; 2] = [0xD251_1F53, 0xCD9E_8D57];
const INCREMENTS: [u32; 2] = [0x9E37_79B9, 0xBB67_AE85];
/// Rounds: the number of the source that passes all its tests with margin.
const ROUNDS: usize = 10;

/// The block of four words of a counter under a key.
#[must_use]
fn philox(mut counter: [u32; 4], mut key: [u32; 2]) -> [u32; 4] {
    for _ in 0..ROUNDS {
        let products = [FACTORS[0] * u64::from(counter[0]), FACTORS[1] * u64::from(counter[2])];
        counter = [
            (products[1] >> 32) as u32 ^ counter[1] ^ key[0],
            products[1] as u32,
            (products[0] >> 32) as u32 ^ counter[3] ^ key[1],
            products[0] as u32,
        ];
        key = [key[0].wrapping_add(INCREMENTS[0]), key[1].wrapping_add(INCREMENTS[1])];
    }
    counter
}

/// Purpose of a draw, an argument of [`uniform`]: draws of different purposes are independent of one another.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Purpose {
    /// Value of a parameter in a run.
    Value,
    /// Key of a permutation in a Latin hypercube.
    Permutation,
    /// Digital shift of a Sobol' sequence.
    Shift,
    /// Seed of a run.
    Seed,
    /// Resampling of results.
    Bootstrap,
    /// Mutation of a candidate by the optimiser.
    Mutation,
    /// Noise added to data.
    Noise,
    /// Choice of the runs that a report shows.
    Sample,
}

/// 64 random bits: a function of the seed, the purpose, a stream and an index.
#[must_use]
pub(crate) fn bits(seed: u64, purpose: Purpose, stream: u32, index: u64) -> u64 {
    // the stream holds 28 bits beside the purpose
    let lane = (stream << 4) | purpose as u32;
    let block = philox([index as u32, (index >> 32) as u32, lane, 0], [seed as u32, (seed >> 32) as u32]);
    u64::from(block[0]) | u64::from(block[1]) << 32
}

/// Returns a random number in the open interval (0, 1), uniformly distributed: the middle of one of 2⁵² equal
/// intervals. It is a function of the arguments alone: the seed, the purpose, a stream (such as the index of a
/// parameter, below 2²⁸) and an index in the stream (such as the number of the run).
///
/// ```
/// use sincro_campaign::design::random::{Purpose, uniform};
///
/// let draw = |run: u64| uniform(42, Purpose::Value, 0, run);
/// assert!(draw(7) > 0.0 && draw(7) < 1.0 && draw(7) == draw(7) && draw(7) != draw(8));
/// ```
#[must_use]
pub fn uniform(seed: u64, purpose: Purpose, stream: u32, index: u64) -> f64 {
    unit(bits(seed, purpose, stream, index))
}

/// The number in (0, 1) of 64 bits, of which the 52 highest count.
#[must_use]
pub(crate) fn unit(bits: u64) -> f64 {
    ((bits >> 12) as f64 + 0.5) * 2.0_f64.powi(-52)
}

/// Place of `index` in a permutation of `0..n`: a Feistel network over the next power of four, walked until it is back
/// inside. It needs no memory.
///
/// # Panics
///
/// If `index` is not below `n`.
#[must_use]
pub(crate) fn permuted(seed: u64, stream: u32, index: u64, n: u64) -> u64 {
    assert!(index < n, "a place among the {n}");
    if n == 1 {
        return 0;
    }
    let half = (64 - (n - 1).leading_zeros()).div_ceil(2);
    let mask = (1_u64 << half) - 1;
    let mut at = index;
    loop {
        let (mut left, mut right) = (at >> half, at & mask);
        for round in 0..6 {
            let mixed = bits(seed, Purpose::Permutation, stream, right | round << 32);
            (left, right) = (right, left ^ (mixed & mask));
        }
        at = left << half | right;
        if at < n {
            return at;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn philox_gives_the_published_answers() {
        // known answers of Random123, philox4x32-10
        assert_eq!(philox([0; 4], [0; 2]), [0x6627_e8d5, 0xe169_c58d, 0xbc57_ac4c, 0x9b00_dbd8]);
        assert_eq!(philox([u32::MAX; 4], [u32::MAX; 2]), [0x408f_276d, 0x41c8_3b0e, 0xa20b_c7c6, 0x6d54_51fd]);
    }

    #[test]
    fn a_permutation_takes_every_place_once() {
        for n in [1, 2, 3, 7, 64, 100, 1023] {
            let mut places: Vec<u64> = (0..n).map(|k| permuted(5, 2, k, n)).collect();
            places.sort_unstable();
            assert!(places.into_iter().eq(0..n), "{n}");
        }
    }

    #[test]
    fn uniform_numbers_fill_the_unit_interval_evenly() {
        let n = 100_000;
        let mut counts = [0_u32; 20];
        for k in 0..n {
            counts[(20.0 * uniform(1, Purpose::Value, 3, k)) as usize] += 1;
        }
        // χ² of 19 degrees of freedom: 43.8 is exceeded once in a thousand
        let expected = n as f64 / 20.0;
        let chi: f64 = counts.iter().map(|c| (f64::from(*c) - expected) * (f64::from(*c) - expected) / expected).sum();
        assert!(chi < 43.8, "{chi}");
    }
}
