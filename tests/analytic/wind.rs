//! Wind: profiles and gusts in closed form; turbulence has the variance and the autocorrelation of Dryden's spectra.

use sincro_dynamics::aero::wind::{Gust, Profile, Scales, TurbulenceSpec, Wind, dryden_scales};
use sincro_dynamics::spatial::Vec3;
use sincro_math::{Dual, Lanes, Real};

fn turbulent(seed: u64) -> Wind {
    let spec = TurbulenceSpec {
        seed,
        scales: Scales::LowAltitude { wind_at_20_feet: 8.0, height: 30.0 },
        airspeed: 10.0,
        convected: false,
    };
    Wind::new([0.0, 0.0, 0.0], Profile::Constant, vec![], Some(spec)).unwrap()
}

#[test]
fn profiles_follow_height() {
    let at = |profile, height: f64| Wind::new([4.0, -2.0, 0.0], profile, vec![], None).unwrap().velocity(3.0, height).0;
    assert_eq!(at(Profile::Constant, 7.0), [4.0, -2.0, 0.0]);
    assert_eq!(at(Profile::Linear { reference: 10.0 }, 5.0), [2.0, -1.0, 0.0]);
    assert_eq!(at(Profile::Linear { reference: 10.0 }, -5.0)[0], 0.0);
    let log = Profile::Logarithmic { reference: 10.0, roughness: 0.1 };
    assert!((at(log, 1.0)[0] - 2.0).abs() < 1e-14); // ln 10 of ln 100
    assert_eq!(at(log, 0.0)[0], 0.0);
}

#[test]
fn the_slope_over_height_is_exact_and_lanes_agree() {
    let log = Profile::Logarithmic { reference: 10.0, roughness: 0.1 };
    let wind = Wind::new([4.0, 0.0, 0.0], log, vec![], None).unwrap();
    let slope = wind.velocity(0.0, Dual::<1>::variable(2.0, 0))[0].partials[0];
    assert!((slope - 4.0 / 2.0 / libm::log(100.0)).abs() < 1e-15);
    let lanes = wind.velocity(0.0, Lanes([0.01, 0.5, 2.0, 50.0]))[0];
    for (k, height) in [0.01, 0.5, 2.0, 50.0].into_iter().enumerate() {
        assert_eq!(lanes.lane(k).to_bits(), wind.velocity(0.0, height)[0].to_bits());
    }
}

#[test]
fn gusts_rise_by_a_cosine() {
    for (holds, after) in [(true, 6.0), (false, 0.0)] {
        let gust = Gust { start: 1.0, rise: 2.0, peak: [0.0, 6.0, 0.0], holds };
        let wind = Wind::new([1.0, 0.0, 0.0], Profile::Constant, vec![gust], None).unwrap();
        let at = |t: f64| wind.velocity(t, 1.0)[1];
        assert_eq!((at(0.0), at(1.0)), (0.0, 0.0));
        assert!((at(2.0) - 3.0).abs() < 1e-15 && (at(3.0) - 6.0).abs() < 1e-15);
        assert!((at(9.0) - after).abs() < 1e-15);
    }
}

#[test]
fn scales_are_those_of_the_standard() {
    // at 1000 feet, d = 1: all lengths are the height, all deviations a tenth of the wind
    let (deviations, lengths) = dryden_scales(15.0, 304.8);
    for k in 0..3 {
        assert!((deviations[k] - 1.5).abs() < 1e-12 && (lengths[k] - 304.8).abs() < 1e-9);
    }
}

#[test]
fn turbulence_has_the_variance_and_autocorrelation_of_dryden() {
    const N_SEEDS: u64 = 8;
    const SAMPLES: u32 = 4000;
    let (deviations, lengths) = dryden_scales(8.0, 30.0);
    // ratios r = Vτ/L at which the autocorrelation is compared
    let ratios = [0.0, 0.1, 0.3, 1.0, 2.0, 4.0];
    let mut worst = [0.0f64; 2];
    for k in 0..3 {
        let corner = 10.0 / lengths[k];
        for (j, r) in ratios.into_iter().enumerate() {
            let mut mean = 0.0;
            for seed in 0..N_SEEDS {
                let wind = turbulent(seed);
                for i in 0..SAMPLES {
                    let t = f64::from(i) * 1.7 / corner;
                    mean += wind.velocity(t, 30.0)[k] * wind.velocity(t + r / corner, 30.0)[k];
                }
            }
            let correlation = mean / (deviations[k] * deviations[k] * (N_SEEDS as f64) * f64::from(SAMPLES));
            let fall = libm::exp(-r);
            let expected = if k == 0 { fall } else { fall * (1.0 - 0.5 * r) };
            let error = (correlation - expected).abs();
            let which = usize::from(j > 0);
            worst[which] = worst[which].max(error);
        }
    }
    // the variance to what the finite time leaves of products of neighbouring harmonics; the rest to two harmonics of
    // 64
    assert!(worst[0] < 0.02 && worst[1] < 2.0 / 64.0, "{worst:?}");
}

#[test]
fn turbulence_depends_on_seed_and_time_alone() {
    let (a, b, other) = (turbulent(3), turbulent(3), turbulent(4));
    let backwards: Vec<_> = (0..100).rev().map(|k| a.velocity(f64::from(k) * 0.1, 30.0)).collect();
    for (k, before) in (0..100).zip(backwards.into_iter().rev()) {
        let t = f64::from(k) * 0.1;
        assert_eq!(b.velocity(t, 99.0).0.map(f64::to_bits), before.0.map(f64::to_bits));
        assert_ne!(other.velocity(t, 30.0), before);
    }
}

#[test]
fn wrong_winds_are_refused_all_at_once() {
    let log = Profile::Logarithmic { reference: 0.05, roughness: 0.1 };
    let gust = Gust { start: f64::NAN, rise: 0.0, peak: [0.0; 3], holds: true };
    let spec = TurbulenceSpec {
        seed: 0,
        scales: Scales::LowAltitude { wind_at_20_feet: -1.0, height: 1.0 },
        airspeed: 0.0,
        convected: false,
    };
    let diagnostics = Wind::new([f64::NAN, 0.0, 0.0], log, vec![gust], Some(spec)).unwrap_err();
    assert_eq!(diagnostics.len(), 7, "{diagnostics:?}");
}

#[test]
fn a_convected_field_moves_with_the_horizontal_mean_wind_and_no_other() {
    let scales = Scales::Given { deviations: [1.0, 0.8, 0.5], lengths: [20.0, 10.0, 5.0] };
    let field = |mean: [f64; 3], airspeed: f64, convected: bool| {
        let spec = TurbulenceSpec { seed: 3, scales, airspeed, convected };
        Wind::new(mean, Profile::Constant, vec![], Some(spec)).map(|_| ()).map_err(|reasons| reasons.to_vec())
    };
    for mean in [[0.0; 3], [0.0, 0.0, 2.0]] {
        let reasons = field(mean, 2.0, true).unwrap_err();
        assert!(
            reasons.len() == 1 && reasons[0].starts_with("`convected` needs a horizontal mean wind"),
            "{reasons:?}"
        );
        assert_eq!(field(mean, 2.0, false), Ok(()));
    }
    // 5 m/s along the ground, whatever rises
    let mean = [3.0, -4.0, 2.0];
    assert_eq!(field(mean, 5.0, true), Ok(()));
    for airspeed in [29.0f64.sqrt(), 5.001, 4.999, 12.0] {
        let reasons = field(mean, airspeed, true).unwrap_err();
        assert!(reasons.len() == 1 && reasons[0].contains("past at 5 m/s: leave it out"), "{reasons:?}");
        assert_eq!(field(mean, airspeed, false), Ok(()));
    }
}

/// Frozen turbulence passes: a place s along the wind sees at t what the origin saw s/V before; across it nothing
/// changes.
#[test]
fn convected_turbulence_is_a_frozen_field() {
    let scales = Scales::Given { deviations: [1.0, 0.8, 0.5], lengths: [20.0, 10.0, 5.0] };
    let spec = TurbulenceSpec { seed: 3, scales, airspeed: 5.0, convected: true };
    // the updraught carries it nowhere
    let field = |spec| Wind::new([3.0, 4.0, 2.0], Profile::Constant, vec![], Some(spec)).unwrap();
    let (frozen, everywhere) = (field(spec), field(TurbulenceSpec { convected: false, ..spec }));
    for t in [0.0, 1.3, 7.0] {
        let at = |x: f64, y: f64| frozen.at(t).velocity_at(Vec3([x, y, 2.0])).0;
        assert_eq!(at(0.0, 0.0), everywhere.velocity(t, 2.0).0);
        // 2.5 m along (0.6, 0.8) are half a second
        for (here, before) in at(1.5, 2.0).into_iter().zip(frozen.velocity(t - 0.5, 2.0).0) {
            assert!((here - before).abs() < 1e-12);
        }
        for (aside, here) in at(-0.8, 0.6).into_iter().zip(at(0.0, 0.0)) {
            assert!((aside - here).abs() < 1e-12);
        }
        assert_eq!(everywhere.at(t).velocity_at(Vec3([9.0, 9.0, 2.0])).0, everywhere.velocity(t, 2.0).0);
    }
}
