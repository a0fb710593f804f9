//! A scene folder, run as `sincro run` does it: signals, checks, figures and a report in a folder.
//!
//! Usage: `run-scene SCENE RESULTS [PATH=VALUE]…`

use std::error::Error;
use std::path::PathBuf;
use std::sync::atomic::AtomicBool;

use sincro::{Override, RunRequest, Verdict};

fn main() -> Result<(), Box<dyn Error>> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [scene, out, settings @ ..] = arguments.as_slice() else {
        return Err("usage: run-scene SCENE RESULTS [PATH=VALUE]…".into());
    };
    let (scene, out) = (PathBuf::from(scene), PathBuf::from(out));
    let overrides: Result<Vec<Override>, _> = settings.iter().map(|text| Override::parse(text)).collect();
    let overrides = overrides.map_err(|diagnostic| diagnostic.to_string())?;
    let loaded = sincro::load(&scene, &overrides)?;

    let request = RunRequest { scene: &scene, overrides: &overrides, loaded: &loaded, index: None };
    let campaign = request.run(&out, &AtomicBool::new(false), &mut |_, _| {})?;
    for check in &campaign.report.checks {
        println!("{:?}  {}", check.verdict, check.name);
    }
    let verdict = match Verdict::of(&campaign) {
        Verdict::Holds => "all checks hold",
        Verdict::Fails => "a check fails",
        Verdict::Stopped => "the run stopped before its end",
    };
    println!("{verdict}; report in {}", out.join("report.html").display());
    Ok(())
}
