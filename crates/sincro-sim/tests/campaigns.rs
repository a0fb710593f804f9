//! Variants on all processors: none is lost, whatever ends first, is refused, or is interrupted.

use std::fmt::Write as _;
use std::sync::atomic::{AtomicBool, AtomicU32, Ordering};

use sincro_sim::Extensions;
use sincro_sim::campaign::{Campaign, run_campaign};
use sincro_sim::load;
use sincro_sim::results::Status;
use sincro_sim::run::RunError;
use sincro_sim::workers::on_all_processors;
use sincro_testing::SceneFolder;

const SCENE: &str = r#"
[[joint]]
name = "slide"
kind = "prismatic"
axis = [1.0, 0.0, 0.0]
initial = { velocity = 1.0 }

[[body]]
name = "block"
parent = "/slide"
mass = 1.0
inertia = { xx = 0.1, yy = 0.1, zz = 0.1 }
"#;

/// A block that slides for times that differ, the longest first; each variant has a check against the one before.
fn campaign(durations: &[f64], interrupt: bool) -> Result<Campaign, RunError> {
    let folder = SceneFolder::new();
    folder.write("scene.toml", SCENE);
    let mut experiment =
        "title = \"Slide\"\nscene = \"scene.toml\"\nduration = 4.0\nstep = 0.01\nrecord = [\"/slide.position\"]\n"
            .to_owned();
    for (k, duration) in durations.iter().enumerate() {
        let _ = write!(
            experiment,
            "\n[[variant]]\nname = \"v{k}\"\nset = {{ duration = {duration:?} }}\n\n[[variant.check]]\nname = \"way\"\nsignal = \"/slide.position\"\nat = 0.5\nvalue = 0.5\ntolerance = 1e-9\n"
        );
    }
    folder.write("experiment.toml", &experiment);
    let loaded = load(&folder, &[], Extensions::default()).unwrap_or_else(|diagnostics| panic!("{diagnostics}"));
    run_campaign(&folder, &[], &loaded, None, &AtomicBool::new(interrupt), &mut |_, _| {})
}

#[test]
fn variants_stand_in_the_order_of_the_file_with_their_own_checks() {
    let durations = [3.0, 1.0, 2.0, 0.5, 2.5, 0.6, 0.7];
    let done = campaign(&durations, false).unwrap();
    let names: Vec<&str> = done.report.variants.iter().map(|variant| variant.name.as_str()).collect();
    assert_eq!(names, ["v0", "v1", "v2", "v3", "v4", "v5", "v6"]);
    for (duration, (_, run)) in durations.iter().zip(&done.variants) {
        assert!((run.simulated.table.times().last().unwrap() - duration).abs() < 1e-12);
        assert!(run.outcomes.len() == 1 && run.outcomes[0].deviation.unwrap() < 1e-12, "{:?}", run.outcomes);
    }
}

#[test]
fn an_interrupted_campaign_leaves_no_variant_out() {
    let done = campaign(&[3.0, 1.0, 2.0, 0.5], true).unwrap();
    assert_eq!(done.report.variants.len(), 4);
    assert!(matches!(done.report.status, Status::Interrupted { .. }));
    assert!(done.report.variants.iter().all(|variant| matches!(variant.status, Status::Interrupted { .. })));
}

#[test]
fn jobs_keep_their_order_and_the_caller_is_called() {
    let calls = AtomicU32::new(0);
    // the last job goes on when the caller has been called: it is, as long as a job is under way
    let square = |k| {
        while k == 99 && calls.load(Ordering::Relaxed) == 0 {
            std::thread::yield_now();
        }
        k * k
    };
    let count = &mut || {
        calls.fetch_add(1, Ordering::Relaxed);
    };
    let squares = on_all_processors(100, &square, count);
    assert!(squares.iter().enumerate().all(|(k, square)| *square == k * k) && squares.len() == 100);
    assert!(calls.into_inner() > 0 && on_all_processors(0, &|k| k, &mut || ()).is_empty());
}
