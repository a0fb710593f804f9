//! Exact derivatives of runs against central differences of the same runs.

use std::path::Path;
use std::sync::atomic::AtomicBool;

use sincro_campaign::fit::data::DataColumn;
use sincro_campaign::fit::{DataSet, FreeParameter, Model, Sensitivity};
use sincro_scene::overrides::Override;
use sincro_sim::{Extensions, Loaded, load};
use sincro_testing::SceneFolder;

static GO: AtomicBool = AtomicBool::new(false);

fn scene(name: &str, settings: &[Override]) -> Loaded {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes").join(name);
    load(&path, settings, Extensions::default()).unwrap()
}

fn settings(list: &[(&str, &str)]) -> Vec<Override> {
    list.iter().map(|(path, value)| Override::new(path, value)).collect()
}

/// Places of data every 20 steps up to `until`, of every signal; their values do not matter.
fn places(loaded: &Loaded, signals: &[&str], until: f64) -> DataSet {
    let step = 20.0 * loaded.experiment.step;
    let times: Vec<f64> = (0..).map(|k| f64::from(k) * step).take_while(|t| *t <= until + 1e-9).collect();
    let column = |signal: &&str| DataColumn {
        column: (*signal).into(),
        signal: (*signal).into(),
        weight: 1.0,
        values: vec![0.0; times.len()],
    };
    DataSet { path: "places.csv".into(), columns: signals.iter().map(column).collect(), times }
}

/// Largest difference between the exact derivatives and central differences of runs with Richardson's extrapolation,
/// for each parameter relative to its largest derivative.
fn departures(loaded: &Loaded, settings: &[Override], signals: &[&str], until: f64, free: &[(&str, f64)]) -> Vec<f64> {
    let sets = [places(loaded, signals, until)];
    let unbounded = |(path, start): &(&str, f64)| FreeParameter {
        path: (*path).into(),
        start: *start,
        low: f64::NEG_INFINITY,
        high: f64::INFINITY,
    };
    let model = Model::new(loaded, settings, free.iter().map(unbounded).collect(), &sets, false, &GO);
    let at: Vec<f64> = free.iter().map(|(_, start)| *start).collect();
    let exact = model.sensitivities(&at, false).unwrap();
    let departure = |k: usize| {
        assert_eq!(exact.ways[k], Sensitivity::Exact, "{}", free[k].0);
        let (differences, _) = model.differences(&at, k, true).unwrap();
        let largest = differences.iter().fold(0.0_f64, |a, x| a.max(x.abs()));
        assert!(largest > 0.0, "{} does something", free[k].0);
        exact.columns[k].iter().zip(&differences).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max) / largest
    };
    let found: Vec<f64> = (0..free.len()).map(departure).collect();
    println!("{}: {:?}", loaded.experiment.title, found.iter().map(|x| format!("{x:.1e}")).collect::<Vec<_>>());
    found
}

#[test]
fn of_spring_damper_masses_and_initial_state() {
    let settings = settings(&[("/shoulder.damping", "0.4"), ("/shoulder.initial.velocity", "1.0")]);
    let loaded = scene("spring-dynamic", &settings);
    let free = [
        ("/shoulder.spring.stiffness", 30.0),
        ("/shoulder.damping", 0.4),
        ("/shoulder/rod.mass", 3.9),
        ("/shoulder.initial.velocity", 1.0),
        ("/shoulder.initial.position", 0.1),
    ];
    let signals = ["/shoulder.position", "/shoulder.velocity", "/shoulder.acceleration"];
    assert!(departures(&loaded, &settings, &signals, 1.0, &free).iter().all(|x| *x < 1e-7));
}

#[test]
fn of_a_compliant_arm_under_a_sampled_controller_with_ideal_motors() {
    let settings = settings(&[("duration", "2.0")]);
    let loaded = scene("alexandros-position", &settings);
    let spring = "/motor1/spring1";
    let tip = "/motor1/spring1/motor2/spring2/motor3/spring3/motor4/spring4/link4/tip.position.z";
    let stiffness = format!("{spring}.spring.stiffness");
    let free = [(stiffness.as_str(), 2.93), ("/motor1/spring1.damping", 0.02)];
    let position = format!("{spring}.position");
    let signals = [position.as_str(), tip, "/motor1.motor_torque"];
    assert!(departures(&loaded, &settings, &signals, 1.6, &free).iter().all(|x| *x < 1e-7));
}

#[test]
fn of_a_servo_under_a_continuous_controller() {
    let settings = settings(&[("parameters.limit", "1e3")]);
    let loaded = scene("pid-tuning", &settings);
    let free = [("/shaft.damping", 0.1), ("/shaft/flywheel.inertia.zz", 0.01)];
    assert!(departures(&loaded, &settings, &["/shaft.position", "motor"], 1.0, &free).iter().all(|x| *x < 1e-7));
}

/// A ball on a rod that swings, between two stops that it bounces off.
const BOUNCING: &str = r#"
format = 2

[[joint]]
name = "hinge"
kind = "revolute"
axis = [0.0, 1.0, 0.0]
damping = 0.1
spring = { stiffness = 20.0 }
initial = { position = 0.2 }

[[body]]
name = "rod"
parent = "hinge"
mass = 2.0
center_of_mass = [0.2, 0.0, 0.0]
inertia = { xx = 0.01, yy = 0.05, zz = 0.05 }

[[joint]]
name = "slide"
parent = "hinge"
kind = "prismatic"
axis = [1.0, 0.0, 0.0]
position = [0.3, 0.0, 0.0]
initial = { velocity = 2.5 }
limits = { lower = -0.1, upper = 0.1, restitution = 0.8 }

[[body]]
name = "ball"
parent = "/hinge/slide"
mass = 0.5
inertia = { xx = 1e-3, yy = 1e-3, zz = 1e-3 }
"#;

#[test]
fn across_impacts_on_joint_limits() {
    let experiment = "format = 2\ntitle = \"Bouncing\"\nduration = 0.4\nstep = 0.002\nrecord = [\"/hinge.position\"]\n";
    let folder = SceneFolder::of(BOUNCING, experiment);
    let loaded = folder.load(&[]).unwrap();
    let free =
        [("/hinge.spring.stiffness", 20.0), ("/hinge/slide/ball.mass", 0.5), ("/hinge/slide.initial.velocity", 2.5)];
    let signals = ["/hinge.position", "/hinge/slide.position", "/hinge/slide.velocity"];
    assert!(departures(&loaded, &[], &signals, 0.4, &free).iter().all(|x| *x < 1e-7));
}

#[test]
fn what_has_no_exact_derivative_is_named() {
    let way = |loaded: &Loaded, signal: &str, path: &str, start: f64| {
        let sets = [places(loaded, &[signal], 0.2)];
        let free = FreeParameter { path: path.into(), start, low: 0.0, high: 1e4 };
        let model = Model::new(loaded, &[], vec![free], &sets, false, &GO);
        match model.sensitivities(&[start], false).unwrap().ways.remove(0) {
            Sensitivity::Differences(reason) => reason,
            Sensitivity::Exact => "exact".into(),
        }
    };
    let servo = scene("pid-tuning", &[]);
    assert_eq!(way(&servo, "/shaft.position", "parameters.kp", 10.0), "it changes a block of the diagram");
    let ball = scene("bouncing-ball", &[]);
    let signal = ball.experiment.record[0].value.clone();
    assert_eq!(way(&ball, &signal, "/air/ball.density", 1000.0), "bodies can touch");
    let folder = SceneFolder::of(
        &BOUNCING.replace("restitution = 0.8", "restitution = 0.0"),
        "format = 2\ntitle = \"Stop\"\nduration = 0.4\nstep = 0.002\nrecord = [\"/hinge.position\"]\n",
    );
    let reason = way(&folder.load(&[]).unwrap(), "/hinge.position", "/hinge.damping", 0.1);
    assert!(reason.contains("`/hinge/slide` comes to rest at its limit"), "{reason}");
}
