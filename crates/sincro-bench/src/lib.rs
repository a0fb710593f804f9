//! `sincro bench`: speed, memory and accuracy on this machine, beside peers if asked.
//!
//! Ours and the peer's are measured in turn, figure by figure (ours, peer, ours, peer …), after both have computed the
//! same accelerations; a ratio is the median of the ratios of neighbours. Times are processor time of the thread. What
//! is measured and why it is fair: `crates/sincro-bench/README.md`.

mod accuracy;
mod adapters;
mod bars;
mod clock;
#[cfg(feature = "jit")]
mod compiled;
mod diagrams;
mod figures;
mod flight;
mod models;
mod peer;
mod subjects;
mod table;

use sincro_sim::Extensions;
use std::path::PathBuf;
use std::time::Instant;

use serde_json::json;

use figures::{FigureKind, Session};
use peer::{Against, Peer};
use table::say;

/// Options of `sincro bench`, parsed from its command line by `clap`: which figures of which robots are measured, and
/// beside which peers.
#[derive(Debug, clap::Args)]
pub struct Options {
    /// Measure a peer in turn with us; may be given twice. Needs Python with the peer's package
    #[arg(long, value_enum, value_name = "PEER")]
    against: Vec<Against>,
    /// Robots, separated by commas; all unless given
    #[arg(long, value_name = "MODEL,…", value_delimiter = ',')]
    only: Vec<String>,
    /// Figures, separated by commas; all unless given
    #[arg(long, value_enum, value_name = "FIGURE,…", value_delimiter = ',')]
    figure: Vec<FigureKind>,
    /// Time spent on each figure `[s]`
    #[arg(long, value_name = "SECONDS", default_value_t = 0.2, value_parser = seconds)]
    seconds_per_figure: f64,
    /// Write everything that was measured to this file
    #[arg(long, value_name = "FILE")]
    json: Option<PathBuf>,
    /// Folder `crates/sincro-bench/models` of a checkout, from which peers read the robots
    #[arg(long, value_name = "DIR")]
    models: Option<PathBuf>,
    /// Threads of the second batch figure
    #[arg(long, value_name = "N", default_value_t = 2, value_parser = clap::value_parser!(u16).range(1..=1024))]
    threads: u16,
    /// Folder of the compiled Pinocchio; a folder for temporary files unless given
    #[arg(long, value_name = "DIR")]
    build_dir: Option<PathBuf>,
}

fn seconds(text: &str) -> Result<f64, String> {
    match text.parse() {
        Ok(s) if (0.001..=3600.0).contains(&s) => Ok(s),
        _ => Err("expected seconds from 0.001 to 3600".into()),
    }
}

/// Parts above the lock-step that measured scenes need: scripts in Lua.
fn extensions() -> Extensions {
    Extensions { scripts: Some(sincro_lua::engine()), ..Extensions::default() }
}

/// Measures speed, memory and accuracy on this machine and prints a table. Peers (MuJoCo, Pinocchio) that cannot be
/// started are reported as warnings, and the rest goes on.
///
/// # Errors
///
/// A robot is unknown, or the JSON file cannot be written; the text says which.
pub fn run(options: &Options) -> Result<(), String> {
    let clock = Instant::now();
    let robots = models::robots(&options.only)?;
    if let Some(path) = &options.json {
        // better now than after minutes of measuring
        write(path, "")?;
    }
    let peers = start_peers(options);
    say_header(options, &peers);
    let mut session = Session::new(options, peers, robots);
    say(&format!("about {:.0} s\n", session.estimate()));
    table::say_columns();
    session.measure();
    say("");
    table::say_bars(&session.rows);
    say(&format!("took {:.0} s", clock.elapsed().as_secs_f64()));
    match &options.json {
        Some(path) => write_json(path, &session, clock.elapsed().as_secs_f64()),
        None => Ok(()),
    }
}

fn start_peers(options: &Options) -> Vec<Peer> {
    let wanted = |which| options.against.iter().any(|a| *a == which || *a == Against::All);
    let names = [(Against::Mujoco, "mujoco"), (Against::Pinocchio, "pinocchio")];
    let names: Vec<&str> = names.iter().filter(|(which, _)| wanted(*which)).map(|(_, name)| *name).collect();
    if names.is_empty() {
        return Vec::new();
    }
    let folder = match models::folder(options.models.as_deref()) {
        Ok(folder) => folder,
        Err(problem) => {
            complain(&problem);
            return Vec::new();
        }
    };
    let build_dir = options.build_dir.clone().unwrap_or_else(|| std::env::temp_dir().join("sincro-bench-pinocchio"));
    let started = names.into_iter().filter_map(|name| {
        let peer = Peer::start(name, &folder, &build_dir);
        peer.map_err(|problem| complain(&format!("{problem}; measuring without {name}"))).ok()
    });
    started.collect()
}

/// A warning that stops nothing.
fn complain(problem: &str) {
    eprintln!("warning: {problem}");
}

/// Name of the processor, as far as the system tells.
fn processor() -> String {
    let told = std::fs::read_to_string("/proc/cpuinfo").unwrap_or_default();
    let name = told.lines().find_map(|line| line.strip_prefix("model name")?.split_once(':'));
    name.map_or_else(|| std::env::consts::ARCH.to_owned(), |(_, name)| name.trim().to_owned())
}

fn say_header(options: &Options, peers: &[Peer]) {
    let cores = std::thread::available_parallelism().map_or(1, usize::from);
    let set = sincro_math::lanes::instruction_set();
    say(&format!("sincro {} on {}, {cores} cores, {set}", env!("CARGO_PKG_VERSION"), processor()));
    if cfg!(debug_assertions) {
        complain("this is an unoptimised build: its times mean nothing (cargo run --release)");
    }
    for peer in peers {
        say(&format!("beside {} {}, measured in turn", peer.name, peer.version()));
    }
    say(&format!(
        "processor time of one thread, median over repetitions of 10 ms or more, {} s a figure; step 5 ms; batches of {} worlds on \
         several threads: time on the wall; ratio: the peer's time over ours",
        options.seconds_per_figure,
        subjects::WORLDS
    ));
}

fn write_json(path: &std::path::Path, session: &Session<'_>, seconds: f64) -> Result<(), String> {
    let peers: Vec<_> = session.peers.iter().map(|peer| json!({ "name": peer.name, "hello": peer.hello })).collect();
    let all = json!({
        "sincro": env!("CARGO_PKG_VERSION"),
        "processor": processor(),
        "instruction_set": sincro_math::lanes::instruction_set(),
        "lanes": sincro_math::lanes::width(),
        "step_s": subjects::STEP,
        "worlds": subjects::WORLDS,
        "took_s": seconds,
        "peers": peers,
        "figures": session.rows.iter().map(table::Row::json).collect::<Vec<_>>(),
        "bars": table::bars_json(&session.rows),
    });
    let text = serde_json::to_string_pretty(&all).expect("numbers and words");
    write(path, &(text + "\n"))
}

fn write(path: &std::path::Path, text: &str) -> Result<(), String> {
    std::fs::write(path, text).map_err(|e| format!("`{}` cannot be written: {e}", path.display()))
}
