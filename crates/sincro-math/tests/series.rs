//! Frequencies of sampled series.

use sincro_math::series::highest_frequency;

#[test]
fn noise_before_the_first_rise_is_no_turning_point() {
    let times = [0.0, 1.0, 1.1, 2.0, 3.0];
    let value = |k: usize| [0.5, 0.499, 1.0, 0.0, 1.0][k];
    assert_eq!(highest_frequency(&times, value, 9.0), 0.5 / (2.0 - 1.1));
}

#[test]
fn a_reversal_by_a_hundredth_of_the_range_is_noise() {
    // a range of 100: reversals by exactly 1
    let times = [0.0, 1.0, 2.0, 3.0];
    assert_eq!(highest_frequency(&times, |k| [0.0, 100.0, 99.0, 100.0][k], 9.0), 0.0);
    // the first change, of 1, begins no direction: the turning points are at 2 and 3
    let times = [0.0, 1.9, 2.0, 3.0, 4.0];
    assert_eq!(highest_frequency(&times, |k| [0.0, -1.0, 99.0, 0.0, 99.0][k], 9.0), 0.5);
}
