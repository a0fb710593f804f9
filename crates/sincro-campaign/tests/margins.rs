//! Margins of the loop that a diagram closes, against the formula of the loop.

use std::path::Path;

use sincro_campaign::tune::margins;
use sincro_scene::overrides::Override;
use sincro_sim::{Extensions, load};

#[test]
fn a_proportional_controller_with_a_lag_has_the_margins_of_its_formula() {
    let set = [
        ("parameters.kp", "2.0"),
        ("parameters.ki", "0.0"),
        ("parameters.kd", "0.0"),
        ("parameters.limit", "1e6"),
        ("/shaft.damping", "0.08"),
    ];
    let settings: Vec<Override> = set.iter().map(|(path, value)| Override::new(path, value)).collect();
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes/pid-tuning");
    let found = margins(&load(&path, &settings, Extensions::default()).unwrap());
    assert_eq!(found.len(), 1, "{found:?}");
    // L = kp / (s (J s + b) (τ s + 1)) with J = 0.01, b = 0.08, τ = 0.01, kp = 2
    let (kp, j, b, lag) = (2.0, 0.01, 0.08, 0.01);
    let magnitude = |w: f64| kp / (w * (j * w).hypot(b) * (lag * w).hypot(1.0));
    let (mut low, mut high) = (0.1, 1000.0);
    for _ in 0..200 {
        let middle = 0.5 * (low + high);
        if magnitude(middle) > 1.0 { low = middle } else { high = middle }
    }
    let degrees = 180.0 / std::f64::consts::PI;
    let atan = |x: f64| sincro_math::elementary::atan2(x, 1.0).0 * degrees;
    let phase = 90.0 - atan(j * low / b) - atan(lag * low);
    // the phase is −180° where J τ ω² = b
    let gain = -20.0 * libm::log10(magnitude((b / (j * lag)).sqrt()));
    let margin = &found[0];
    println!("{margin:?}, expected {gain} dB, {phase}°");
    assert!((margin.phase_deg.unwrap() - phase).abs() < 1e-3 && (margin.gain_db.unwrap() - gain).abs() < 1e-3);
    assert!(margin.modulus > 0.0 && margin.modulus < 2.0 * libm::sin(0.5 * phase / degrees));
}
