//! Margins of sampled loops against closed forms of the discretised plant, and against gains at which a run becomes
//! unstable.

use std::f64::consts::PI;

use sincro_analysis::linear::{Complex, DMatrix, Margin, StateSpace};
use sincro_analysis::linearize::{OpenLoop, linearize_sampled, open_loops, openable_signals, operating_point};
use sincro_math::elementary::{atan2, exp, hypot, ln, sin_cos};
use sincro_scene::diagnostic::{Located, Location, SourceText};
use sincro_sim::Loaded;
use sincro_testing::SceneFolder;

fn name(text: &str) -> Located<String> {
    let source = std::sync::Arc::new(SourceText { path: "test".into(), text: text.into() });
    Located { value: text.into(), at: Location { source, span: 0..text.len() } }
}

/// Mass of 2 kg on a rail with a damper of 3 N·s/m, base step 10 ms, under a diagram.
fn mass_on_rail(diagram: &str) -> SceneFolder {
    let scene = r#"
[[joint]]
name = "rail"
kind = "prismatic"
axis = [1.0, 0.0, 0.0]
damping = 3.0
motor = { mode = "torque" }
initial = { position = 0.1 }
[[body]]
name = "cart"
parent = "/rail"
mass = 2.0
inertia = { xx = 1.0, yy = 1.0, zz = 1.0 }
"#;
    let experiment = "title = \"t\"\nscene = \"scene.toml\"\ndiagram = \"diagram.toml\"\nduration = 1.0\nstep = 0.01\naccuracy = 1e-12\n\
                      record = [\"/rail.position\"]\n";
    SceneFolder::of(scene, experiment).with("diagram.toml", diagram)
}

const PID: &str = r#"
wires = ["/rail.position -> error -> pid -> /rail"]
[[block]]
name = "error"
type = "gain"
gain = -1.0
sample_time = 0.02
[[block]]
name = "pid"
type = "discrete-pid"
unit = "N"
sample_time = 0.02
kp = 60.0
ki = 40.0
kd = 12.0
filter_time_constant = 0.05
"#;

fn opened(loaded: &Loaded, signal: &str) -> OpenLoop {
    let at = operating_point(loaded, 0.0).unwrap();
    let mut found = open_loops(loaded, &at, &[name(signal)]).unwrap_or_else(|diagnostics| panic!("{diagnostics}"));
    found.pop().unwrap()
}

fn modulus(z: Complex<f64>) -> f64 {
    hypot(z.re, z.im).0
}

/// Factor of a number of decibels.
fn factor(decibels: f64) -> f64 {
    exp(decibels / 20.0 * core::f64::consts::LN_10).0
}

fn unit(angle: f64) -> Complex<f64> {
    let (sine, cosine) = sin_cos(angle);
    Complex::new(cosine, sine)
}

/// L of the discrete PID controller and the mass under zero-order hold.
fn pid_and_mass(z: Complex<f64>) -> Complex<f64> {
    let (h, m, c) = (0.02, 2.0, 3.0);
    let (kp, ki, kd, tf) = (60.0, 40.0, 12.0, 0.05);
    let a = exp(-c * h / m).0;
    let tau = m / c;
    let one = Complex::new(1.0, 0.0);
    let plant = (Complex::new(tau * (1.0 - a) * (1.0 - a) / c, 0.0) / (z - a) + (h - tau * (1.0 - a)) / c) / (z - one);
    let filter = Complex::new(h, 0.0) / (Complex::new(tf + h, 0.0) - Complex::new(tf, 0.0) / z);
    let derivative = (one - filter / z) / Complex::new(tf + h, 0.0);
    let controller = Complex::new(kp, 0.0) + Complex::new(ki * h, 0.0) / (z - one) + derivative * Complex::new(kd, 0.0);
    controller * plant
}

/// Zero of `of` between two angles.
fn zero(of: impl Fn(f64) -> f64, mut low: f64, mut high: f64) -> f64 {
    assert!((of(low) < 0.0) != (of(high) < 0.0));
    for _ in 0..80 {
        let middle = 0.5 * (low + high);
        if (of(middle) < 0.0) == (of(low) < 0.0) { low = middle } else { high = middle }
    }
    0.5 * (low + high)
}

fn nearest(margins: &[Margin], omega: f64) -> Margin {
    *margins.iter().min_by(|a, b| (a.omega - omega).abs().total_cmp(&(b.omega - omega).abs())).unwrap()
}

#[test]
fn a_sampled_pid_has_the_margins_of_its_discrete_transfer_function() {
    let loaded = mass_on_rail(PID).load(&[]).unwrap();
    // one loop: the same margins wherever it is opened
    for signal in ["pid", "/rail", "/rail.command", "error"] {
        let found = opened(&loaded, signal);
        assert_eq!((found.n_samples(), found.sample_time, found.system.sample_time), (1, 0.02, Some(0.02)));
        let (h, bode) = (0.02, &found.margins.bode);
        for (omega, (magnitude, phase)) in bode.omega.iter().zip(bode.magnitude_db.iter().zip(&bode.phase_deg)) {
            let l = pid_and_mass(unit(omega * h));
            let found = unit(phase.to_radians()) * Complex::new(factor(*magnitude), 0.0);
            if omega * h < 2e-3 {
                // two poles at 1, known to the rounding of differences
                continue;
            }
            assert!(modulus(found - l) <= 1e-6 * modulus(l), "{omega}: {found} {l}");
        }
        // where the phase is −180°, and where |L| = 1
        let at_axis = zero(|angle| pid_and_mass(unit(angle)).im, 0.6, 3.0);
        let gain = nearest(&bode.gain_margins, at_axis / h);
        let expected = -20.0 * f64::log10(modulus(pid_and_mass(unit(at_axis))));
        eprintln!("{signal}: gain margin {} dB, error {:.1e}", gain.value, gain.value - expected);
        assert!((gain.value - expected).abs() < 1e-6 && (gain.omega - at_axis / h).abs() < 1e-6 * gain.omega);
        let at_one = zero(|angle| modulus(pid_and_mass(unit(angle))) - 1.0, 0.01, 3.0);
        let phase = nearest(&bode.phase_margins, at_one / h);
        let l = pid_and_mass(unit(at_one));
        let expected = atan2(-l.im, -l.re).0.to_degrees();
        eprintln!("{signal}: phase margin {}°, error {:.1e}", phase.value, phase.value - expected);
        assert!((phase.value - expected).abs() < 1e-6 && (phase.omega - at_one / h).abs() < 1e-6 * phase.omega);
        let distance = |k: u32| modulus(pid_and_mass(unit(PI * f64::from(k) / 1e5)) + Complex::new(1.0, 0.0));
        let least = (1..=100_000).map(distance).fold(f64::INFINITY, f64::min);
        assert!(
            (found.margins.modulus_margin.value - least).abs() < 1e-6,
            "{:?} {least}",
            found.margins.modulus_margin
        );
    }
}

#[test]
fn a_factor_of_the_gain_margin_puts_a_pole_on_the_unit_circle() {
    let folder = mass_on_rail(PID);
    let margins = opened(&folder.load(&[]).unwrap(), "pid").margins.bode.gain_margins;
    assert!(!margins.is_empty());
    for margin in margins {
        let factor = self::factor(margin.value);
        let loaded = folder.load(&[&format!("error.gain={}", -factor)]).unwrap();
        let at = operating_point(&loaded, 0.0).unwrap();
        let poles = linearize_sampled(&loaded, &at).unwrap().system.poles();
        let nearest = poles.iter().map(|m| (modulus(m.pole) - 1.0).abs()).fold(f64::INFINITY, f64::min);
        assert!(nearest < 1e-7, "{margin:?}: {nearest:e}");
    }
}

/// Position loop of 30 ms around a velocity loop of 10 ms.
const CASCADE: &str = r#"
wires = ["/rail.position -> outer -> difference.u1", "/rail.velocity -> difference.u2", "difference -> inner -> /rail"]
[[block]]
name = "outer"
type = "gain"
gain = -8.0
unit = "m/s"
sample_time = 0.03
[[block]]
name = "difference"
type = "sum"
signs = "+-"
sample_time = 0.01
[[block]]
name = "inner"
type = "gain"
gain = 60.0
unit = "N"
sample_time = 0.01
"#;

/// Growth of the motion from period 200 to period 400 [nepers].
fn growth(loaded: &Loaded, ticks: u64) -> f64 {
    let mut run = operating_point(loaded, 0.0).unwrap();
    let mut size = |n: u64| {
        for _ in 0..n * ticks {
            run.advance().unwrap();
        }
        // over a few periods, so that an oscillation is seen at its peak
        let mut largest = 0.0_f64;
        for _ in 0..20 * ticks {
            run.advance().unwrap();
            largest = largest.max(run.state().q[0].abs() + 0.01 * run.state().v[0].abs());
        }
        largest
    };
    let (early, late) = (size(180), size(180));
    ln(late / early).0
}

#[test]
fn margins_of_a_loop_with_two_sample_times_are_those_of_runs() {
    let folder = mass_on_rail(CASCADE);
    let loaded = folder.load(&[]).unwrap();
    for (signal, n_samples, gain) in [("inner", 3, 60.0), ("outer", 1, -8.0)] {
        let found = opened(&loaded, signal);
        assert_eq!(found.n_samples(), n_samples);
        let up = found.margins.bode.gain_margins.iter().filter(|m| m.value > 0.0);
        let margin = *up.min_by(|a, b| a.value.total_cmp(&b.value)).expect("a gain margin");
        let factor = self::factor(margin.value);
        // the factor at which a run begins to grow, by halving
        let (mut low, mut high) = (0.9 * factor, 1.1 * factor);
        let grows = |factor: f64| {
            let set = format!("{signal}.gain={}", factor * gain);
            growth(&folder.load(&[&set]).unwrap(), 3) > 0.0
        };
        assert!(!grows(low) && grows(high), "{signal}: {margin:?}");
        for _ in 0..12 {
            let middle = 0.5 * (low + high);
            if grows(middle) { high = middle } else { low = middle }
        }
        eprintln!("{signal}: factor {factor}, by runs {low}…{high}, {margin:?}");
        assert!((0.5 * (low + high) / factor - 1.0).abs() < 1e-3, "{signal}: {factor} {low}");
    }
}

/// A loop with one sample time, lifted over three of them, keeps its margins.
#[test]
fn lifting_a_loop_changes_no_margin() {
    let a = DMatrix::from_row_slice(3, 3, &[0.9, 0.2, 0.0, -0.2, 0.9, 0.1, 0.0, 0.0, 0.5]);
    let b = DMatrix::from_row_slice(3, 1, &[0.0, 0.1, 1.0]);
    let c = DMatrix::from_row_slice(1, 3, &[1.5, 0.2, 0.1]);
    let once = StateSpace {
        sample_time: Some(0.1),
        ..StateSpace::from_matrices(a.clone(), b.clone(), c.clone(), DMatrix::zeros(1, 1)).unwrap()
    };
    let n = 3;
    let power = |k: usize| (0..k).fold(DMatrix::identity(3, 3), |p, _| p * &a);
    let mut lifted_b = DMatrix::zeros(3, n);
    let mut lifted_c = DMatrix::zeros(n, 3);
    let mut lifted_d = DMatrix::zeros(n, n);
    for k in 0..n {
        lifted_b.set_column(k, &(power(n - 1 - k) * &b).column(0));
        lifted_c.set_row(k, &(&c * power(k)).row(0));
        for j in 0..k {
            lifted_d[(k, j)] = (&c * power(k - 1 - j) * &b)[(0, 0)];
        }
    }
    let lifted = StateSpace {
        sample_time: Some(0.3),
        ..StateSpace::from_matrices(power(n), lifted_b, lifted_c, lifted_d).unwrap()
    };
    let (one, three) = (once.loop_margins(), lifted.loop_margins());
    let bode = once.bode(0, 0).unwrap();
    let agree = |a: &[Margin], b: &[Margin]| {
        assert_eq!(a.len(), b.len(), "{a:?} {b:?}");
        for (a, b) in a.iter().zip(b) {
            assert!((a.value - b.value).abs() < 1e-7 && (a.omega - b.omega).abs() < 1e-7, "{a:?} {b:?}");
        }
    };
    assert!(!one.bode.gain_margins.is_empty() && !one.bode.phase_margins.is_empty(), "{one:?}");
    agree(&one.bode.gain_margins, &bode.gain_margins);
    agree(&one.bode.phase_margins, &bode.phase_margins);
    agree(&one.bode.gain_margins, &three.bode.gain_margins);
    agree(&one.bode.phase_margins, &three.bode.phase_margins);
    assert!((one.modulus_margin.value - three.modulus_margin.value).abs() < 1e-9);
    for (k, omega) in three.bode.omega.iter().enumerate() {
        let expected = 20.0 * f64::log10(modulus(once.frequency_response(0, 0, &[*omega])[0]));
        assert!((three.bode.magnitude_db[k] - expected).abs() < 1e-9, "{omega}");
    }
}

#[test]
fn only_sampled_signals_open_a_loop() {
    let loaded = mass_on_rail(PID).load(&[]).unwrap();
    let at = operating_point(&loaded, 0.0).unwrap();
    assert_eq!(openable_signals(&loaded, &at), ["error", "pid"]);
    let refused = |signal: &str| open_loops(&loaded, &at, &[name(signal)]).unwrap_err().to_string();
    assert!(refused("pdi").contains("there is no signal `pdi`"), "{}", refused("pdi"));
    assert!(refused("pdi").contains("`pid`"), "{}", refused("pdi"));
    assert!(refused("/rail.position").contains("no block of the diagram gives"), "{}", refused("/rail.position"));
    let continuous =
        mass_on_rail(&PID.replace("sample_time = 0.02\n", "").replace("discrete-pid", "pid")).load(&[]).unwrap();
    let at = operating_point(&continuous, 0.0).unwrap();
    let message = open_loops(&continuous, &at, &[name("pid")]).unwrap_err().to_string();
    assert!(message.contains("`pid` is not sampled"), "{message}");
}

/// Sensors on the cart: position every 20 ms, as a diagram at 20 ms samples it, and velocity every 10 ms.
const SENSORS: &str = r#"
[[sensor]]
name = "gps"
parent = "cart"
sample_time = 0.02
pose = { position_noise = 0.0 }
[[sensor]]
name = "speed"
parent = "cart"
sample_time = 0.01
velocity = { noise = 0.0 }
"#;

/// Poles that are not zero, by modulus, then by angle.
fn moving_poles(folder: &SceneFolder) -> Vec<Complex<f64>> {
    let loaded = folder.load(&[]).unwrap();
    let at = operating_point(&loaded, 0.0).unwrap();
    let found = linearize_sampled(&loaded, &at).unwrap();
    let mut poles: Vec<_> = found.system.poles().iter().map(|mode| mode.pole).collect();
    poles.retain(|p| modulus(*p) > 1e-6);
    poles.sort_by(|a, b| (modulus(*a), a.im).partial_cmp(&(modulus(*b), b.im)).unwrap());
    poles
}

#[test]
fn a_loop_through_sensors_has_the_poles_of_one_that_measures_the_motion() {
    let with_sensors = |diagram: &str| {
        let folder = mass_on_rail(diagram);
        let scene = folder.join("scene.toml");
        let text = std::fs::read_to_string(&scene).unwrap();
        std::fs::write(&scene, text + SENSORS).unwrap();
        folder
    };
    // the same samples, so the same discrete system
    let through = PID.replace("/rail.position", "/rail/cart/gps.measured_position.x");
    let cascade = CASCADE.replace("/rail.velocity", "/rail/cart/speed.measured_velocity.x");
    for (direct, sensed) in [(PID, through.as_str()), (CASCADE, cascade.as_str())] {
        let (direct, sensed) = (moving_poles(&with_sensors(direct)), moving_poles(&with_sensors(sensed)));
        assert!(direct.len() >= 2 && direct.len() == sensed.len(), "{direct:?} {sensed:?}");
        for (a, b) in direct.iter().zip(&sensed) {
            assert!(modulus(a - b) < 1e-7, "{a} {b}");
        }
    }
    // a gain that is too high for the sensor's sample time, in a diagram without one
    let continuous = "wires = [\"/rail/cart/gps.measured_position.x -> pid -> /rail\"]\n[[block]]\nname = \"pid\"\n\
                      type = \"gain\"\ngain = -20000.0\nunit = \"N\"\n";
    let fastest = moving_poles(&with_sensors(continuous)).pop().unwrap();
    assert!(modulus(fastest) > 1.5, "{fastest}");
}
