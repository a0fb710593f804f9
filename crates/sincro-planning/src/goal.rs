//! States near enough to a goal.

use sincro_math::random::SplitMix64;

use crate::space::Space;

/// First step of the descent, as a share of the range of each direction.
const FIRST_STEP: f64 = 0.1;
/// Step at which it ends.
const LAST_STEP: f64 = 1e-7;

/// States whose distance to a goal is within a tolerance, `n` at most: by going down from a state and from random ones,
/// one direction after the other with steps that are halved where none helps. `max_measured` distances are measured at
/// most; none of the states needs to be valid.
///
/// # Errors
///
/// Those of the measurement.
pub fn descend<E>(
    space: &Space,
    start: &[f64],
    (tolerance, n, max_measured): (f64, usize, usize),
    seed: u64,
    distance: &mut impl FnMut(&[f64]) -> Result<f64, E>,
) -> Result<Vec<Vec<f64>>, E> {
    let (mut found, mut random) = (Vec::new(), SplitMix64::new(seed));
    let (mut left, mut at) = (max_measured, start.to_vec());
    space.enforce(&mut at);
    while found.len() < n && left > 0 {
        left -= 1;
        let (mut best, mut step) = (distance(&at)?, FIRST_STEP);
        while best > tolerance && step > LAST_STEP && left > 0 {
            let mut is_better = false;
            for (k, sign) in (0..space.n_directions()).flat_map(|k| [(k, 1.0), (k, -1.0)]) {
                let mut next = at.clone();
                space.shift(&mut next, k, sign * step);
                left = left.saturating_sub(1);
                let there = distance(&next)?;
                if there < best {
                    (at, best, is_better) = (next, there, true);
                }
            }
            if !is_better {
                step *= 0.5;
            }
        }
        if best <= tolerance {
            found.push(at);
        }
        at = space.sample(&mut random);
    }
    Ok(found)
}
