//! Identification on scenes whose truth is known.

use std::path::{Path, PathBuf};
use std::sync::atomic::AtomicBool;

use sincro_campaign::design::inverse_normal;
use sincro_campaign::design::random::{Purpose, uniform};
use sincro_campaign::fit::data::DataColumn;
use sincro_campaign::fit::{DataSet, Fit, FitOptions, FreeParameter, Loss, Model, SignalChoice, SolveError, parse_all};
use sincro_scene::overrides::Override;
use sincro_sim::run::{RunMonitor, RunOptions, simulate};
use sincro_sim::{Extensions, Loaded, load};

fn scene(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes").join(name)
}

static GO: AtomicBool = AtomicBool::new(false);

/// Data of a run with Gaussian noise, every `every`-th row.
fn measured(loaded: &Loaded, signals: &[&str], sigma: f64, seed: u64, every: usize) -> DataSet {
    let mut monitor = RunMonitor { interrupt: &GO, progress: &mut |_| {} };
    let run = simulate(loaded, RunOptions::default(), &mut monitor).unwrap();
    let rows: Vec<usize> = (0..run.table.n_rows()).step_by(every).collect();
    let column = |(c, signal): (usize, &&str)| {
        let values = &run.table.column(signal).unwrap().values;
        let noise = |k: usize| sigma * inverse_normal(uniform(seed, Purpose::Noise, c as u32, k as u64));
        DataColumn {
            column: (*signal).into(),
            signal: (*signal).into(),
            weight: 1.0 / if sigma > 0.0 { sigma } else { 1.0 },
            values: rows.iter().map(|k| values[*k] + noise(*k)).collect(),
        }
    };
    let times = rows.iter().map(|k| run.table.times()[*k]).collect();
    DataSet { path: "data.csv".into(), times, columns: signals.iter().enumerate().map(column).collect() }
}

fn free(path: &str, start: f64) -> FreeParameter {
    FreeParameter { path: path.into(), start, low: 0.0, high: f64::INFINITY }
}

fn fit<'a>(loaded: &'a Loaded, sets: &'a [DataSet], all: Vec<FreeParameter>) -> Result<Fit<'a>, SolveError> {
    let model = Model::new(loaded, &[], all, sets, false, &GO);
    Fit::new("test".into(), model, FitOptions::default(), &[])
}

/// The spring of the thesis, tightened so that it swings and tells inertia, stiffness and damping apart.
fn swinging() -> Loaded {
    let settings = [Override::new("/shoulder.damping", "0.4"), Override::new("/shoulder.initial.velocity", "1.0")];
    load(&scene("spring-dynamic"), &settings, Extensions::default()).unwrap()
}

/// As [`swinging`]: the settings belong to every run of a fit.
fn base() -> Vec<Override> {
    vec![Override::new("/shoulder.initial.velocity", "1.0")]
}

#[test]
fn the_spring_of_the_thesis_is_found_in_noisy_data() {
    let loaded = load(&scene("spring-dynamic"), &[], Extensions::default()).unwrap();
    let sets = [measured(&loaded, &["/shoulder.position"], 1e-3, 7, 5)];
    let all = vec![free("/shoulder.spring.stiffness", 20.0), free("/shoulder.damping", 5.0)];
    let fit = fit(&loaded, &sets, all).unwrap();
    assert!(fit.solution.has_converged, "{}", fit.text());
    for (estimate, truth) in fit.inference.estimates.iter().zip([30.0, 10.0]) {
        assert!(estimate.is_identifiable && (estimate.value - truth).abs() < 3.0 * estimate.std, "{}", fit.text());
    }
    // the noise that was put in is what is left
    assert!((fit.inference.sigma - 1.0).abs() < 0.25, "{}", fit.inference.sigma);
}

#[test]
fn ninety_five_percent_intervals_hold_the_truth_in_ninety_to_ninety_eight_of_a_hundred() {
    let loaded = swinging();
    let truths = [30.0, 0.4];
    let (mut held, n) = ([0; 2], 100);
    for seed in 0..n {
        let sets = [measured(&loaded, &["/shoulder.position"], 5e-3, seed, 10)];
        let all = vec![free("/shoulder.spring.stiffness", 25.0), free("/shoulder.damping", 0.6)];
        let model = Model::new(&loaded, &base(), all, &sets, false, &GO);
        let fit = Fit::new("test".into(), model, FitOptions::default(), &[]).unwrap();
        for (k, (estimate, truth)) in fit.inference.estimates.iter().zip(truths).enumerate() {
            held[k] += u32::from((estimate.value - truth).abs() <= estimate.half_width);
        }
    }
    println!("truths inside their intervals: {held:?} of {n}");
    assert!(held.iter().all(|held| (90..=99).contains(held)), "{held:?}");
}

#[test]
fn sensitivities_agree_with_the_closed_form() {
    // an undamped rotation without gravity: q = q0·cos(√(k/I)·t), ∂q/∂k = −q0·sin(ωt)·t/(2·ω·I)
    let settings = [
        Override::new("gravity", "[0.0, 0.0, 0.0]"),
        Override::new("/shoulder.damping", "0.0"),
        Override::new("/shoulder.initial.position", "0.3"),
    ];
    let loaded = load(&scene("spring-dynamic"), &settings, Extensions::default()).unwrap();
    let sets = [measured(&loaded, &["/shoulder.position"], 0.0, 0, 1)];
    let model = Model::new(&loaded, &settings, vec![free("/shoulder.spring.stiffness", 30.0)], &sets, false, &GO);
    let found = model.sensitivities(&[30.0], true).unwrap();
    let inertia = 0.0842625 + 3.927 * 0.0625;
    let omega = (30.0_f64 / inertia).sqrt();
    let mut worst = 0.0_f64;
    for (t, slope) in sets[0].times.iter().zip(&found.columns[0]) {
        let exact = -0.3 * sincro_math::elementary::sin_cos(omega * t).0 * t / (2.0 * omega * inertia);
        worst = worst.max((slope - exact).abs());
    }
    let largest = found.columns[0].iter().fold(0.0_f64, |a, b| a.max(b.abs()));
    println!("largest error of a sensitivity, relative: {:.1e}; estimated {:.1e}", worst / largest, found.error);
    assert!(worst < 1e-7 * largest, "{worst} of {largest}");
}

#[test]
fn parameters_that_only_act_together_are_named() {
    // without gravity the motion knows k/I and c/I alone
    let settings = [Override::new("gravity", "[0.0, 0.0, 0.0]"), Override::new("/shoulder.initial.position", "0.3")];
    let loaded = load(&scene("spring-dynamic"), &settings, Extensions::default()).unwrap();
    let sets = [measured(&loaded, &["/shoulder.position"], 1e-5, 3, 5)];
    let all = vec![
        free("/shoulder.spring.stiffness", 30.0),
        free("/shoulder.damping", 10.0),
        free("/shoulder/rod.mass", 3.9),
    ];
    let mut settings = settings.to_vec();
    settings.push(Override::new("/shoulder/rod.inertia", "{ xx = 1e-9, yy = 1e-9, zz = 1e-9 }"));
    let model = Model::new(&loaded, &settings, all, &sets, false, &GO);
    let fit = Fit::new("test".into(), model, FitOptions::default(), &[]).unwrap();
    assert_eq!(fit.inference.unidentifiable.len(), 1, "{}", fit.text());
    assert!(fit.inference.estimates.iter().all(|estimate| !estimate.is_identifiable), "{}", fit.text());
    assert!(fit.text().contains("/shoulder/rod.mass"), "{}", fit.text());
}

#[test]
fn a_parameter_without_effect_is_an_error() {
    let loaded = load(&scene("spring-dynamic"), &[], Extensions::default()).unwrap();
    let sets = [measured(&loaded, &["/shoulder.position"], 1e-3, 7, 5)];
    let all = vec![free("/shoulder.spring.stiffness", 20.0), free("parameters.k", 30.0)];
    assert!(matches!(fit(&loaded, &sets, all), Err(SolveError::Dead(dead)) if dead == [1]));
}

#[test]
fn outliers_do_not_move_a_robust_fit() {
    let loaded = load(&scene("spring-dynamic"), &[], Extensions::default()).unwrap();
    let mut sets = [measured(&loaded, &["/shoulder.position"], 1e-4, 7, 5)];
    (10..100).step_by(9).for_each(|k| sets[0].columns[0].values[k] += 0.1);
    let solve = |loss| {
        let all = vec![free("/shoulder.spring.stiffness", 20.0), free("/shoulder.damping", 5.0)];
        let model = Model::new(&loaded, &[], all, &sets, false, &GO);
        Fit::new("test".into(), model, FitOptions { loss, ..FitOptions::default() }, &[]).unwrap().solution.unknowns[0]
    };
    let (squares, cauchy) = (solve(Loss::Squares), solve(Loss::Cauchy));
    assert!((squares - 30.0).abs() > 0.5 && (cauchy - 30.0).abs() < 0.02, "{squares} {cauchy}");
}

#[test]
fn a_time_offset_is_found_with_the_parameters() {
    let loaded = swinging();
    let mut sets = [measured(&loaded, &["/shoulder.position"], 1e-4, 7, 5)];
    // a clock that is 23 ms behind; what was measured before the run began is cut
    sets[0].times.iter_mut().for_each(|t| *t -= 0.023);
    let late = sets[0].times.iter().filter(|t| **t < 0.0).count();
    sets[0].times.drain(..late);
    sets[0].columns[0].values.drain(..late);
    let all = vec![free("/shoulder.spring.stiffness", 28.0), free("/shoulder.damping", 0.5)];
    let model = Model::new(&loaded, &base(), all, &sets, true, &GO);
    let fit = Fit::new("test".into(), model, FitOptions::default(), &[]).unwrap();
    assert!((fit.solution.unknowns[2] - 0.023).abs() < 3.0 * fit.inference.estimates[2].std + 1e-6, "{}", fit.text());
}

#[test]
fn six_parameters_of_the_compliant_arm_are_found() {
    let settings = [Override::new("duration", "8.0")];
    let loaded = load(&scene("alexandros-position"), &settings, Extensions::default()).unwrap();
    let springs = [
        ("/motor1/spring1", 2.93),
        ("/motor1/spring1/motor2/spring2", 2.1),
        ("/motor1/spring1/motor2/spring2/motor3/spring3", 0.8),
        ("/motor1/spring1/motor2/spring2/motor3/spring3/motor4/spring4", 1.48),
    ];
    let signals: Vec<String> = springs.iter().map(|(path, _)| format!("{path}.position")).collect();
    let mut recorded = loaded.clone();
    let of_first = loaded.experiment.record[0].clone();
    let signal = |name: &String| sincro_scene::diagnostic::Located { value: name.clone(), at: of_first.at.clone() };
    recorded.experiment.record = signals.iter().map(signal).collect();
    recorded.experiment.checks.clear();
    let signals: Vec<&str> = signals.iter().map(String::as_str).collect();
    let sets = [measured(&recorded, &signals, 2e-4, 11, 1)];
    let mut all: Vec<FreeParameter> =
        springs.iter().map(|(path, k)| free(&format!("{path}.spring.stiffness"), 1.15 * k)).collect();
    all.extend([0, 3].map(|k| free(&format!("{}.damping", springs[k].0), 0.025)));
    let truths = [2.93, 2.1, 0.8, 1.48, 0.02, 0.02];
    let fit = fit(&loaded, &sets, all).unwrap();
    println!("{}", fit.text());
    for (estimate, truth) in fit.inference.estimates.iter().zip(truths) {
        assert!(estimate.is_identifiable && (estimate.value - truth).abs() < 3.5 * estimate.std, "{}", fit.text());
    }
}

#[test]
fn starts_come_from_the_files() {
    let loaded = load(&scene("spring-dynamic"), &[], Extensions::default()).unwrap();
    let texts = ["/shoulder.spring.stiffness, /shoulder.damping=1..100".to_owned(), "parameters.k".to_owned()];
    let all = parse_all(&texts, &loaded).unwrap();
    assert_eq!(all.iter().map(|f| f.start).collect::<Vec<_>>(), [30.0, 10.0, 30.0]);
    assert_eq!((all[1].low, all[1].high), (1.0, 100.0));
    for wrong in
        ["/shoulder.damping=x", "/shoulder.damping=3..1", "/nothing.damping", "=3", "/shoulder.damping=5 in 6..7"]
    {
        assert!(parse_all(&[wrong.to_owned()], &loaded).is_err(), "{wrong}");
    }
}

#[test]
fn multiple_shooting_finds_the_masses_of_a_chaotic_pendulum() {
    let settings = [Override::new("/upper/lower.damping", "0.02")];
    let loaded = load(&scene("double-pendulum"), &settings, Extensions::default()).unwrap();
    let sets = [measured(&loaded, &["/upper.position", "/upper/lower.position"], 1e-3, 7, 5)];
    let fit = |shooting| {
        let all = vec![free("/upper/lower/bob2.mass", 3.0), free("/upper/lower.damping", 0.2)];
        let model = Model::new(&loaded, &[], all, &sets, false, &GO);
        Fit::new("test".into(), model, FitOptions { shooting, ..FitOptions::default() }, &[]).unwrap()
    };
    // the predictions of single runs leave the data for good: minima everywhere
    let single = fit(None);
    println!("{}", single.text());
    assert!((single.solution.unknowns[0] - 1.0).abs() > 0.1, "{}", single.text());
    let multiple = fit(Some(20));
    println!("{}", multiple.text());
    assert!(multiple.solution.has_converged && multiple.shot.as_ref().is_some_and(|shot| shot.gap < 0.01));
    for (estimate, truth) in multiple.inference.estimates.iter().zip([1.0, 0.02]) {
        assert!((estimate.value - truth).abs() < 4.0 * estimate.std, "{}", multiple.text());
    }
}

#[test]
fn shooting_is_refused_by_name_where_it_cannot_be() {
    let loaded = load(&scene("pid-tuning"), &[], Extensions::default()).unwrap();
    let sets = [measured(&loaded, &["/shaft.position"], 1e-3, 7, 20)];
    let model = Model::new(&loaded, &[], vec![free("/shaft.damping", 0.1)], &sets, false, &GO);
    let options = FitOptions { shooting: Some(4), ..FitOptions::default() };
    let Err(SolveError::Model(error)) = Fit::new("test".into(), model, options, &[]) else { panic!("it is refused") };
    let words = sincro_scene::diagnostic::Diagnostics::from(error).to_string();
    assert!(words.contains("the scene has a diagram"), "{words}");
}

#[test]
fn the_examples_of_identification_find_their_truths() {
    let examples = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../examples/identification");
    let check = |folder: PathBuf, file: &str, signals: &[&str], parameters: &[(&str, f64)]| {
        let loaded = load(&folder, &[], Extensions::default()).unwrap();
        let choices: Vec<SignalChoice> = signals.iter().map(|text| SignalChoice::parse(text).unwrap()).collect();
        let sets = [DataSet::read(&examples.join("data").join(file), &choices, &[]).unwrap()];
        let free = parameters.iter().map(|(path, truth)| free(path, 1.3 * truth)).collect();
        let model = Model::new(&loaded, &[], free, &sets, false, &GO);
        let fit = Fit::new(file.into(), model, FitOptions::default(), &[]).unwrap();
        assert!(fit.solution.has_converged, "{}", fit.text());
        for (estimate, (path, truth)) in fit.inference.estimates.iter().zip(parameters) {
            assert!(estimate.is_identifiable, "{path}");
            assert!(
                (estimate.value - truth).abs() < 3.5 * estimate.std,
                "{path}: {} ± {}",
                estimate.value,
                estimate.std
            );
        }
    };
    let spring = [("/shoulder.spring.stiffness", 30.0), ("/shoulder.damping", 10.0)];
    check(scene("spring-dynamic"), "spring.csv", &["/shoulder.position=angle@1e-3"], &spring);
    let ramp = [("/motor/link.inertia.zz", 1e-12)];
    check(scene("motor-ramp"), "ramp.csv", &["/motor.motor_torque=torque@2e-14"], &ramp);
    let motor = [
        ("/shaft.motor.resistance", 1.2),
        ("/shaft.motor.inductance", 0.06),
        ("/shaft.motor.torque_constant", 0.3),
        ("/shaft.damping", 0.01),
        ("/shaft/flywheel.inertia.zz", 0.02),
    ];
    let signals = ["/shaft.velocity=speed@0.05", "/shaft.current=current@0.02"];
    check(examples.join("motor"), "motor.csv", &signals, &motor);
}
