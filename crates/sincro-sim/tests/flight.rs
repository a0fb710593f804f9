//! The flight tests of the quadrotor: what must hold whatever the reference files say, and how a run ends at a bound.

use std::path::PathBuf;
use std::sync::atomic::AtomicBool;

use sincro_scene::overrides::Override;
use sincro_sim::Extensions;
use sincro_sim::campaign::run_campaign;
use sincro_sim::load;
use sincro_sim::results::{Status, VerdictReport};
use sincro_sim::run::Simulated;

fn scene(name: &str) -> PathBuf {
    sincro_testing::repository_scene(name)
}

fn settings(set: &[(&str, &str)]) -> Vec<Override> {
    set.iter().map(|(path, value)| Override::new(path, value)).collect()
}

/// The main run of a scene.
fn flown(name: &str, set: &[(&str, &str)]) -> Simulated {
    let loaded =
        load(&scene(name), &settings(set), Extensions::default()).unwrap_or_else(|diagnostics| panic!("{diagnostics}"));
    sincro_testing::run(&loaded)
}

fn column<'a>(run: &'a Simulated, name: &str) -> &'a [f64] {
    &run.table.column(name).unwrap_or_else(|| panic!("`{name}` is recorded")).values
}

const POSITION: [&str; 3] = ["/air/quadrotor.position.x", "/air/quadrotor.position.y", "/air/quadrotor.position.z"];

/// The vehicle and its controller are the same along x and y.
#[test]
fn a_step_to_the_side_is_a_step_forward() {
    let (side, forward) = (flown("quadrotor-flight-1", &[]), flown("quadrotor-flight-2", &[]));
    let (y, x) = (column(&side, POSITION[1]), column(&forward, POSITION[0]));
    for (k, t) in side.table.times().iter().enumerate().filter(|(_, t)| (20.0..40.0).contains(*t)) {
        assert!((x[k] - y[k]).abs() < 1e-9, "at {t} s: {} {}", x[k], y[k]);
    }
    assert!(x[790] > 0.09, "the step is in the window");
}

/// The result of the diagram with its own reference filter, loops and mixer does not depend on the sample time of
/// recording.
#[test]
fn a_controller_at_its_sample_time_does_not_see_the_base_step() {
    let short = ("duration", "24.0");
    let coarse = flown("quadrotor-flight-1", &[short]);
    let fine = flown("quadrotor-flight-1", &[short, ("step", "0.01"), ("record_every", "5")]);
    for name in POSITION {
        let worst =
            column(&coarse, name).iter().zip(column(&fine, name)).fold(0.0_f64, |w, (a, b)| w.max((a - b).abs()));
        // two runs with error control at 1e-9
        assert!(worst < 1e-8, "{name}: {worst}");
    }
}

/// dL/dt about the centre of mass is the torque: without any, the angular momentum in the world stays.
#[test]
fn without_torque_the_angular_momentum_stays() {
    // in air that is hardly there the rotors give neither thrust nor torque: the body is left alone
    let run = flown(
        "quadrotor-flight-1",
        &[
            ("air_density", "1e-12"),
            ("/air.initial", "{ velocity = [0.3, -0.2, 0.5, 0.0, 0.0, 0.0] }"),
            ("attitude_loop.ixx", "0.0"),
            ("attitude_loop.izz", "0.0"),
            ("duration", "2.0"),
        ],
    );
    let inertia = [0.0251085, 0.0251085, 0.144875];
    let momentum = |k: usize| {
        let w = ["x", "y", "z"].map(|a| column(&run, &format!("/air.angular_velocity.{a}"))[k]);
        let [qw, x, y, z] = ["w", "x", "y", "z"].map(|a| column(&run, &format!("/air.quaternion.{a}"))[k]);
        let l: [f64; 3] = core::array::from_fn(|i| inertia[i] * w[i]);
        let t = [y * l[2] - z * l[1], z * l[0] - x * l[2], x * l[1] - y * l[0]].map(|c| 2.0 * c);
        [
            l[0] + qw * t[0] + y * t[2] - z * t[1],
            l[1] + qw * t[1] + z * t[0] - x * t[2],
            l[2] + qw * t[2] + x * t[1] - y * t[0],
        ]
    };
    let (start, last) = (momentum(0), run.table.n_rows() - 1);
    for k in 0..=last {
        let now = momentum(k);
        for i in 0..3 {
            // error control at 1e-9, torques of 1e-12 of the usual ones
            assert!((now[i] - start[i]).abs() < 1e-9, "row {k}: {now:?} {start:?}");
        }
    }
}

/// After the step that excites it the roll grows by the spectral radius of the sampled loop, 1.057 a sample (its slow
/// integral left out).
#[test]
fn one_sample_late_the_roll_grows_as_its_linearisation_says() {
    let run = flown("quadrotor-latency", &[]);
    let Status::Ended { time, ref reason, .. } = run.status else { panic!("{:?}", run.status) };
    assert!((12.0..20.0).contains(&time) && reason.contains("/air/quadrotor.roll"), "{time}: {reason}");
    assert_eq!(*run.table.times().last().unwrap(), time, "the row that left the bound is the last");
    let roll = column(&run, "/air/quadrotor.roll");
    // mean squares over two periods of 10 samples, 40 samples apart
    let square = |from: usize| roll[from..from + 20].iter().map(|x| x * x).sum::<f64>();
    let end = roll.len() - 30;
    let growth = sincro_math::elementary::pow(square(end) / square(end - 40), 0.5 / 40.0).0;
    assert!((1.055..1.061).contains(&growth), "{growth}");
}

/// A bound of the experiment ends any run of it, and the checks that look at the whole run are not made.
#[test]
fn a_bound_of_the_experiment_ends_the_run() {
    let set = settings(&[("stop_when", "[{ signal = \"/air/quadrotor.position.z\", above = 0.5 }]")]);
    let loaded = load(&scene("quadrotor-flight-1"), &set, Extensions::default())
        .unwrap_or_else(|diagnostics| panic!("{diagnostics}"));
    let interrupt = AtomicBool::new(false);
    let campaign = run_campaign(&scene("quadrotor-flight-1"), &set, &loaded, None, &interrupt, &mut |_, _| {}).unwrap();
    let report = &campaign.report;
    let Status::Ended { reason, .. } = &report.status else { panic!("{:?}", report.status) };
    assert!(reason.starts_with("`/air/quadrotor.position.z` is 0.5"), "{reason}");
    let ended = report.variants.iter().filter(|v| matches!(v.status, Status::Ended { .. })).count();
    assert_eq!((ended, report.variants.len()), (4, 4), "variants end there too");
    // references run to the end of the file, far beyond the bound
    let reference = report.checks.iter().find(|check| check.name == "x against the reference").unwrap();
    assert_eq!(reference.verdict, VerdictReport::NotMade, "{reference:?}");
}

#[test]
fn what_the_mixer_cannot_give_is_told() {
    let run = flown("quadrotor-flight-1", &[("mixer.most", "722.0"), ("duration", "1.0")]);
    let told: Vec<&String> = run.warnings.iter().filter(|w| w.contains("mixer/possible")).collect();
    assert_eq!(told.len(), 1, "{:?}", run.warnings);
    assert!(told[0].contains("to its greatest value in") && told[0].contains("first at t = 0.000000 s"), "{}", told[0]);
    let hasty = [("omega_r", "8.0"), ("y1", "20.0")].map(|(name, x)| (format!("parameters.{name}"), x));
    let hasty: Vec<(&str, &str)> = hasty.iter().map(|(path, x)| (path.as_str(), *x)).collect();
    let negative = flown("quadrotor-flight-1", &[&hasty[..], &[("duration", "22.0")]].concat());
    assert!(
        negative.warnings.iter().any(|w| w.contains("least value") && w.contains("mixer/possible")),
        "{:?}",
        negative.warnings
    );
}

/// Gains belong to the controller that they were said for: the variant with a cascaded PID has no such blocks.
#[test]
fn gains_of_one_controller_do_not_reach_the_other() {
    let set = settings(&[("attitude_loop.gamma1_xy", "8.0"), ("parameters.y1", "0.2"), ("duration", "0.1")]);
    let folder = scene("quadrotor-flight-1");
    let loaded = load(&folder, &set, Extensions::default()).unwrap_or_else(|diagnostics| panic!("{diagnostics}"));
    let campaign = run_campaign(&folder, &set, &loaded, None, &AtomicBool::new(false), &mut |_, _| {}).unwrap();
    assert!(campaign.report.variants.iter().any(|v| v.name == "pid" && v.status.is_good()));
    let wrong = settings(&[("attitude_loop.gamma9", "8.0")]);
    assert!(
        load(&folder, &wrong, Extensions::default()).unwrap_err().to_string().contains("has no parameter `gamma9`")
    );
}
