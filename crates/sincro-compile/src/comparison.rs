//! Random inputs by which compiled programs are compared with [`Program::evaluate`](sincro_math::record::Program).

use sincro_math::random::splitmix64;

/// Rounds of the comparison with the programs, each with other random inputs.
pub(crate) const ROUNDS: u64 = 10;

/// Rounds of them with inputs of many sizes, then those up to which all are small: some programs have results near the
/// origin alone.
const ROUNDS_OF_SIZES: u64 = 4;
const ROUNDS_OF_SMALL: u64 = 8;

/// Input number `k` of a round.
pub(crate) fn number(round: u64, k: u64) -> f64 {
    let bits = splitmix64(round, k);
    if (ROUNDS_OF_SIZES..ROUNDS_OF_SMALL).contains(&round) {
        return 1e-2 * ((bits >> 11) as f64 / (1_u64 << 52) as f64 - 1.0);
    }
    if round >= ROUNDS_OF_SMALL {
        // four such numbers are nearly a rotation: no state of a machine with quaternions is wilder
        return 0.5 + 0.01 * ((bits >> 11) as f64 / (1_u64 << 53) as f64);
    }
    let size = [1.0, 1e-3, 30.0, 1.0][(bits % 4) as usize];
    size * ((bits >> 11) as f64 / (1_u64 << 52) as f64 - 1.0)
}
