//! Frequencies of sampled series.

use sincro_math::series::highest_frequency;

#[test]
fn noise_before_the_first_rise_is_no_turning_point() {
    let times = [0.0, 1.0, 1.1, 2.0, 3.0];
    let value = |k: usize| [0.5, 0.499, 1.0, 0.0, 1.0][k];
    assert_eq!(highest_frequency(&times, value, 9.0), 0.5 / (2.0 - 1.1));
}
