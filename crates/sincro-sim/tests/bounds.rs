//! Bounds that end a run, checks that want a divergence, paths as plots: how they come out, and what is refused.

use std::sync::atomic::AtomicBool;

use sincro_sim::campaign::{Campaign, run_campaign};
use sincro_sim::check::Verdict;
use sincro_sim::results::{Status, VerdictReport};
use sincro_testing::{SceneFolder, scenes};

/// A mass on a spring with a negative damper: it swings ever wider.
const SCENE: &str = r#"
[[joint]]
name = "hinge"
kind = "prismatic"
axis = [1.0, 0.0, 0.0]
spring = { stiffness = 9.0, rest = 0.0 }
motor = { mode = "torque" }
initial = { position = 0.1 }

[[body]]
name = "ball"
parent = "/hinge"
mass = 1.0
inertia = { xx = 0.1, yy = 0.1, zz = 0.1 }
"#;

const DIAGRAM: &str = r#"
wires = ["/hinge.velocity -> push -> /hinge"]

[[block]]
name = "push"
type = "gain"
gain = "negative"
"#;

const EXPERIMENT: &str = r#"title = "Swings ever wider"
diagram = "diagram.toml"
duration = 10.0
step = 0.01
error_bar = "none"
record = ["/hinge.position", "/hinge.velocity", "/hinge/ball.position.x", "/hinge/ball.position.y", "/hinge/ball.position.z"]

[parameters]
negative = 1.0
bound = 0.5

[[check]]
name = "it is lost"
signal = "/hinge.position"
diverges = "bound"
window = [1.0, 10.0]

[[plot]]
title = "Path"
kind = "path"
signals = ["/hinge/ball.position"]
"#;

fn folder() -> SceneFolder {
    let folder = scenes::sprung_arm();
    folder.write("scene.toml", SCENE);
    folder.write("diagram.toml", DIAGRAM);
    folder.write("experiment.toml", EXPERIMENT);
    folder
}

fn run(folder: &SceneFolder) -> Campaign {
    let loaded = folder.load(&[]).unwrap_or_else(|e| panic!("{e}"));
    run_campaign(folder, &[], &loaded, None, &AtomicBool::new(false), &mut |_, _| {}).unwrap()
}

/// x = 0.1·e^(t/2)·(cos ωt − sin ωt/2ω), ω² = 9 − 1/4, first passes 0.5 in its fifth half swing.
#[test]
fn a_divergence_ends_the_run_at_its_bound_and_holds() {
    let campaign = run(&folder());
    let Status::Ended { time, reason, .. } = &campaign.report.status else { panic!("{:?}", campaign.report.status) };
    let x = |t: f64| {
        let w = 8.75_f64.sqrt();
        let (sin, cos) = sincro_math::elementary::sin_cos(w * t);
        0.1 * sincro_math::elementary::exp(0.5 * t).0 * (cos - sin / (2.0 * w))
    };
    let first = (0..1000).map(|k| 0.01 * f64::from(k)).find(|t| x(*t).abs() > 0.5).unwrap();
    assert!((time - first).abs() < 1e-9, "{time} {first}");
    assert!(
        reason.starts_with("`/hinge.position` is ") && reason.ends_with(" m, beyond the bound of 0.5 m"),
        "{reason}"
    );
    let check = &campaign.report.checks[0];
    assert_eq!((check.verdict, check.at, check.deviation), (VerdictReport::Holds, Some(*time), Some(0.0)));
    assert_eq!(check.about, "/hinge.position leaves the bound of 0.5, from t = 1 s to 10 s");
}

#[test]
fn a_divergence_that_comes_not_or_too_early_does_not_hold() {
    let damped = folder();
    damped.change("experiment.toml", "negative = 1.0", "negative = -1.0");
    let campaign = run(&damped);
    assert_eq!(campaign.report.status, Status::Completed);
    let outcome = &campaign.main.outcomes[0];
    assert_eq!((&outcome.verdict, outcome.at), (&Verdict::Fails, Some(0.0)), "the start was its greatest");
    assert!((outcome.deviation.unwrap() - 0.4).abs() < 1e-12);

    let early = folder();
    early.change("experiment.toml", "window = [1.0, 10.0]", "window = [9.0, 10.0]");
    match &run(&early).main.outcomes[0].verdict {
        Verdict::NotMade(reason) => assert!(reason.starts_with("it leaves the bound at t = "), "{reason}"),
        other => panic!("{other:?}"),
    }
    let exact = folder();
    exact.change("experiment.toml", "negative = 1.0", "negative = -1.0");
    exact.change("experiment.toml", "diverges = \"bound\"", "diverges = 0.1");
    assert_eq!(run(&exact).main.outcomes[0].verdict, Verdict::Fails, "a bound that is met is not left");
}

#[test]
fn the_last_of_several_divergences_ends_the_run() {
    let two = folder();
    let second = "[[check]]\nname = \"faster\"\nsignal = \"/hinge.velocity\"\ndiverges = 4.0\n\n[[plot]]";
    two.change("experiment.toml", "[[plot]]", second);
    let campaign = run(&two);
    let Status::Ended { reason, .. } = &campaign.report.status else { panic!("{:?}", campaign.report.status) };
    assert!(reason.starts_with("`/hinge.velocity`"), "{reason}");
    assert!(campaign.report.checks.iter().all(|c| c.verdict == VerdictReport::Holds), "{:?}", campaign.report.checks);
    let stop = "[[stop_when]]\nsignal = \"/hinge.position\"\nbelow = \"-0.4*bound\"\n\n[[plot]]";
    two.change("experiment.toml", "[[plot]]", stop);
    let Status::Ended { reason, .. } = run(&two).report.status else { panic!("a bound of the experiment ends it") };
    assert!(reason.ends_with(" m, below the bound of -0.2 m"), "{reason}");
}

/// Replaced text, replacement, and part of the expected message.
const REFUSED: &[(&str, &str, &[&str])] = &[
    ("diverges = \"bound\"", "diverges = \"bund\"", &["unknown name `bund`"]),
    (
        "diverges = \"bound\"",
        "diverges = -1.0",
        &["experiment.toml:15:1: error: a magnitude is always beyond a negative bound"],
    ),
    ("diverges = \"bound\"", "diverges = nan", &["`diverges` is not a number"]),
    ("diverges = \"bound\"", "diverges = 1.0\ntolerance = 0.1", &["`tolerance` has no meaning with `diverges`"]),
    ("diverges = \"bound\"", "diverges = 1.0\nmeasure = \"max\"", &["`measure` has no meaning with `diverges`"]),
    ("diverges = \"bound\"", "diverges = 1.0\nvalue = 0.1", &["experiment.toml"]),
    ("window = [1.0, 10.0]", "at = 2.0", &["`at` has no meaning with `diverges`", "give a `window`"]),
    (
        "signal = \"/hinge.position\"\ndiverges",
        "signals = { x = \"/hinge.position\" }\nformula = \"x\"\ndiverges",
        &["`diverges` looks at one signal"],
    ),
    (
        "signal = \"/hinge.position\"",
        "signal = \"/hinge.acceleration\"",
        &["`/hinge.acceleration` is not recorded, so that its bound cannot be seen", "help: add it to `record`"],
    ),
    ("[[plot]]", "[[stop_when]]\nsignal = \"/hinge.position\"\n\n[[plot]]", &["`above`, `below`, `beyond`"]),
    (
        "[[plot]]",
        "[[stop_when]]\nsignal = \"/hinge.position\"\nabove = 1.0\nbelow = 0.0\n\n[[plot]]",
        &["experiment.toml"],
    ),
    (
        "[[plot]]",
        "[[stop_when]]\nsignal = \"/hinge.position\"\nbeyond = -1.0\n\n[[plot]]",
        &["a magnitude is always beyond -1"],
    ),
    (
        "[[plot]]",
        "[[stop_when]]\nsignal = \"/hinge.positon\"\nabove = 1.0\n\n[[plot]]",
        &["`/hinge.positon` is not recorded", "`/hinge.position` is recorded"],
    ),
    (
        "signals = [\"/hinge/ball.position\"]",
        "signals = [\"/hinge/ball.velocity\"]",
        &[
            "the three components of `/hinge/ball.velocity` are not recorded",
            "help: add `/hinge/ball.velocity.x`, `/hinge/ball.velocity.y` and `/hinge/ball.velocity.z` to `record`",
        ],
    ),
    (
        "kind = \"path\"",
        "kind = \"orbit\"",
        &["experiment.toml:20:8: error: `kind` is \"orbit\", expected one of `lines`, `path`"],
    ),
    (
        "kind = \"path\"",
        "kind = \"path\"\ndifference = \"variants\"",
        &["`difference` has no meaning in a plot of kind `path`"],
    ),
];

#[test]
fn bounds_that_cannot_be_are_refused_in_words() {
    let mut wrong = Vec::new();
    for (from, to, expected) in REFUSED {
        let folder = folder();
        folder.change("experiment.toml", from, to);
        let words = folder.load(&[]).expect_err(to);
        wrong.extend(
            expected.iter().filter(|part| !words.contains(**part)).map(|part| format!("{part}\n--- said\n{words}\n")),
        );
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}
