//! `sincro sweep`: campaigns of runs, their shards, their collection and their report.

use std::path::{Path, PathBuf};
use std::sync::atomic::Ordering;
use std::time::Instant;

use clap::{Args, Subcommand, ValueEnum};
use sincro::{RunRequest, Verdict, load};
use sincro_campaign::engine::{ShardDone, ShardError};
use sincro_campaign::report::{self, Replay};
use sincro_campaign::store::{Collected, StoreError};
use sincro_campaign::{Campaign, Plan, Shard, Store, collect, run_shard};
use sincro_sim::result_folder::ResultFolder;
use sincro_sim::run::RunError;

use super::console::{self, Bar};
use super::run::interrupt;
use super::whole_number;
use crate::{Exit, diagnostics};

/// Arguments of `sweep`.
#[derive(Debug, Args)]
#[command(args_conflicts_with_subcommands = true, subcommand_negates_reqs = true)]
pub(crate) struct Arguments {
    #[command(subcommand)]
    action: Option<Action>,
    /// Plan of the campaign, or the folder of a scene whose experiment has a [campaign]
    #[arg(value_name = "PLAN.toml|SCENE", required = true)]
    plan: Option<PathBuf>,
    /// Folder of the results; one that holds part of this campaign is completed
    #[arg(long, value_name = "DIR", required = true)]
    out: Option<PathBuf>,
    /// Make only share I of N, from 1 to N; all shares into the same folder, in any order, then `sincro sweep collect`
    #[arg(long, value_name = "I/N", value_parser = Shard::parse)]
    shard: Option<Shard>,
    /// Make run K again, with all its files, into DIR/runs/K
    #[arg(long, value_name = "K", conflicts_with = "shard", value_parser = whole_number::<u64>)]
    only: Option<u64>,
    /// Number of threads [default: one for each processor]
    #[arg(long, value_name = "N", value_parser = whole_number::<usize>)]
    threads: Option<usize>,
    /// Number of the worst runs that are made again for their replay in the report
    #[arg(long, value_name = "N", default_value_t = 3, value_parser = whole_number::<usize>)]
    replays: usize,
    /// Print nothing but errors
    #[arg(long, short)]
    quiet: bool,
}

/// Action on the folder of a campaign.
#[derive(Debug, Subcommand)]
enum Action {
    /// Collect the parts of all shards into DIR/runs.parquet, prove that each run is there once, write the report
    Collect {
        /// Folder of the campaign
        #[arg(value_name = "DIR")]
        folder: PathBuf,
        /// Number of the worst runs that are made again for their replay in the report
        #[arg(long, value_name = "N", default_value_t = 3, value_parser = whole_number::<usize>)]
        replays: usize,
    },
    /// Write the job of all shards for an engine, and give it to the engine
    Submit {
        /// Plan of the campaign
        #[arg(value_name = "PLAN.toml")]
        plan: PathBuf,
        /// Folder of the results, on a disk that all machines see
        #[arg(long, value_name = "DIR")]
        out: PathBuf,
        /// local: processes of this machine; hq: HyperQueue; slurm: an array of Slurm
        #[arg(long, value_name = "ENGINE", value_enum)]
        on: Engine,
        /// Number of shards
        #[arg(long, value_name = "N", default_value_t = 2, value_parser = clap::value_parser!(u64).range(1..))]
        shards: u64,
        /// Write the script, and do not submit it
        #[arg(long)]
        dry_run: bool,
    },
    /// Say how much of a campaign is done
    Status {
        /// Folder of the campaign
        #[arg(value_name = "DIR")]
        folder: PathBuf,
    },
}

/// Engines that run shards.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum Engine {
    /// Processes of this machine, one after the other started in the background.
    Local,
    /// HyperQueue: `hq submit`.
    Hq,
    /// Slurm: `sbatch` with an array.
    Slurm,
}

/// Runs the command.
pub(crate) fn run(arguments: &Arguments) -> Exit {
    match (&arguments.action, &arguments.plan, &arguments.out) {
        (Some(Action::Collect { folder, replays }), ..) => collect_folder(folder, *replays, false),
        (Some(Action::Status { folder }), ..) => status(folder),
        (Some(Action::Submit { plan, out, on, shards, dry_run }), ..) => submit(plan, out, *on, *shards, *dry_run),
        (None, Some(plan), Some(out)) => sweep(arguments, plan, out),
        _ => diagnostics::refuse("a plan and --out DIR are needed", None),
    }
}

fn sweep(arguments: &Arguments, plan: &Path, out: &Path) -> Exit {
    let campaign = match Plan::open(plan).and_then(|plan| Campaign::new(plan, load)) {
        Ok(campaign) => campaign,
        Err(found) => return diagnostics::refuse_diagnostics(&found),
    };
    let n_runs = campaign.plan.n_runs();
    if let Some(k) = arguments.only.filter(|k| *k >= n_runs) {
        let message = format!("there is no run {k}: the campaign has the runs 0 to {}", n_runs.saturating_sub(1));
        return diagnostics::refuse(&message, None);
    }
    let store = match Store::open(out, &campaign, &plan.display().to_string()) {
        Ok(store) => store,
        Err(error) => return refuse_store(&error),
    };
    if let Some(k) = arguments.only {
        return only(&campaign, &store, k, arguments.quiet);
    }
    let shard = arguments.shard.unwrap_or(Shard::WHOLE);
    let started = Instant::now();
    let done = match make(arguments, &campaign, &store, shard) {
        Ok(done) => done,
        Err(exit) => return exit,
    };
    let seconds = started.elapsed().as_secs_f64();
    if !arguments.quiet {
        say!("{}", shard_line(&done, shard, seconds));
    }
    if done.n_left > 0 {
        if !arguments.quiet {
            say!("  the same command goes on where this one ended");
        }
        return Exit::Stopped;
    }
    if arguments.shard.is_some() {
        return Exit::Holds;
    }
    finish(&campaign, &store, arguments.replays, arguments.quiet)
}

/// The runs of a shard with a progress bar.
fn make(arguments: &Arguments, campaign: &Campaign, store: &Store, shard: Shard) -> Result<ShardDone, Exit> {
    let bar = if arguments.quiet { Bar::none() } else { Bar::new(&store.manifest.scene) };
    let n_threads = arguments.threads.unwrap_or_else(|| std::thread::available_parallelism().map_or(1, usize::from));
    let mut show = |done: u64, all: u64| bar.show(&format!("{done} of {all} runs"), done as f64 / all.max(1) as f64);
    let done = run_shard(campaign, store, shard, n_threads, &interrupt(), &mut show);
    bar.finish();
    done.map_err(|error| match error {
        ShardError::Run(RunError::Diagnostics(found)) => diagnostics::refuse_diagnostics(&found),
        ShardError::Run(RunError::File(error)) => diagnostics::refuse_file(&error),
        ShardError::Store(error) => refuse_store(&error),
    })
}

fn shard_line(done: &ShardDone, shard: Shard, seconds: f64) -> String {
    let of = if shard == Shard::WHOLE { String::new() } else { format!("shard {}/{}: ", shard.index, shard.count) };
    let found = if done.n_found > 0 { format!(", {} were there", done.n_found) } else { String::new() };
    let left = if done.n_left > 0 { format!(", {} are left", done.n_left) } else { String::new() };
    let rate = done.n_made as f64 / seconds.max(1e-9);
    format!(
        "{of}{} made in {} s{}{found}{left}",
        diagnostics::count(done.n_made as usize, "run"),
        console::short((seconds * 100.0).round() / 100.0),
        if done.n_made > 0 { format!(" ({rate:.0} a second)") } else { String::new() }
    )
}

fn collect_folder(folder: &Path, replays: usize, is_quiet: bool) -> Exit {
    let store = match Store::existing(folder) {
        Ok(store) => store,
        Err(error) => return refuse_store(&error),
    };
    // the plan is needed for replays alone; the table and the report do without
    let plan = Path::new(&store.manifest.plan);
    let campaign = Plan::open(plan).and_then(|plan| Campaign::new(plan, load)).ok();
    match campaign.filter(|campaign| campaign.input == store.manifest.input) {
        Some(campaign) => finish(&campaign, &store, replays, is_quiet),
        None => finish_without_replays(&store, is_quiet),
    }
}

/// Collects, makes the worst runs again, writes the report.
fn finish(campaign: &Campaign, store: &Store, n_replays: usize, is_quiet: bool) -> Exit {
    let collected = match collect(store) {
        Ok(collected) => collected,
        Err(error) => return refuse_store(&error),
    };
    let summary = match report::Summary::of(store) {
        Ok(summary) => summary,
        Err(error) => return refuse_store(&error),
    };
    let mut replays = Vec::new();
    // a run that the scene refuses has nothing to be shown
    for worst in summary.worst.iter().filter(|worst| worst.status != "refused").take(n_replays) {
        if interrupt().load(Ordering::Relaxed) {
            break;
        }
        match rerun(campaign, store, worst.k) {
            Ok((path, _)) => replays.push(Replay { k: worst.k, href: path }),
            Err(_) => continue,
        }
    }
    write_report(store, &summary, &replays, &collected, is_quiet)
}

fn finish_without_replays(store: &Store, is_quiet: bool) -> Exit {
    let collected = match collect(store) {
        Ok(collected) => collected,
        Err(error) => return refuse_store(&error),
    };
    match report::Summary::of(store) {
        Ok(summary) => write_report(store, &summary, &[], &collected, is_quiet),
        Err(error) => refuse_store(&error),
    }
}

fn write_report(
    store: &Store,
    summary: &report::Summary,
    replays: &[Replay],
    collected: &Collected,
    is_quiet: bool,
) -> Exit {
    if let Err(error) = report::write(store, summary, replays) {
        return refuse_store(&error);
    }
    if !is_quiet {
        say!("{}", report::text(store, summary).trim_end());
        say!("  trace {}   inputs {}", collected.trace, store.manifest.input);
        say!("  report {}", store.folder.join("report.html").display());
    }
    Exit::Holds
}

/// Makes one run again and says whether it is the same.
fn only(campaign: &Campaign, store: &Store, k: u64, is_quiet: bool) -> Exit {
    match rerun(campaign, store, k) {
        Ok((href, done)) => {
            let known = match store.trace_of(k) {
                Ok(known) => known.filter(|trace| !trace.is_empty()),
                Err(error) => return refuse_store(&error),
            };
            if let Some(known) = known.as_ref().filter(|known| **known != done.report.trace_hash) {
                let message = format!("run {k} has the trace {}, and {known} in the results", done.report.trace_hash);
                let help = "the motion differs on this machine: compare the processor, the system and the version";
                return diagnostics::refuse(&message, Some(help));
            }
            if !is_quiet {
                let same = if known.is_some() { ", as in the results" } else { "" };
                say!("run {k}: trace {}{same}", done.report.trace_hash);
                say!("  {}", console::verdict_line(&done.report));
                say!("  report {}", store.folder.join(href).display());
            }
            // its checks are those of the files as they are; the limits of the plan are in the table
            if Verdict::of(&done) == Verdict::Stopped { Exit::Stopped } else { Exit::Holds }
        }
        Err(exit) => exit,
    }
}

/// Makes run `k` again as `sincro run` does, into `runs/K`; returns the address of its report below the folder.
fn rerun(campaign: &Campaign, store: &Store, k: u64) -> Result<(String, sincro::Campaign), Exit> {
    let point = campaign.plan.point(k);
    let mut loaded = campaign.loaded_at(&point).map_err(|found| diagnostics::refuse_diagnostics(&found))?;
    loaded.experiment.title += &format!(", run {k}");
    let settings = campaign.settings(&point);
    let out = store.folder.join("runs").join(k.to_string());
    let folder = ResultFolder::replace(&out).map_err(|error| diagnostics::refuse_folder(&error))?;
    let index = sincro::results::Link { label: "campaign", href: "../../report.html" };
    let request = RunRequest { scene: &campaign.plan.scene, overrides: &settings, loaded: &loaded, index: Some(index) };
    let done = request
        .run_into(folder.path(), &interrupt(), &mut |_, _| {})
        .map_err(|failure| diagnostics::refuse_run(&failure))?;
    folder.publish().map_err(|error| diagnostics::refuse_file(&error))?;
    Ok((format!("runs/{k}/report.html"), done))
}

/// Writes the script of an engine into the folder of the campaign, and submits it.
fn submit(plan: &Path, out: &Path, engine: Engine, n_shards: u64, is_dry: bool) -> Exit {
    let campaign = match Plan::open(plan).and_then(|plan| Campaign::new(plan, load)) {
        Ok(campaign) => campaign,
        Err(found) => return diagnostics::refuse_diagnostics(&found),
    };
    if let Err(error) = Store::open(out, &campaign, &plan.display().to_string()) {
        return refuse_store(&error);
    }
    let whole = |path: &Path| std::path::absolute(path).unwrap_or_else(|_| path.to_owned());
    let quoted = |path: &Path| format!("'{}'", whole(path).display().to_string().replace('\'', "'\\''"));
    let program = std::env::current_exe().unwrap_or_else(|_| "sincro".into());
    let jobs = whole(out).join("jobs");
    let shard = |index: &str| {
        format!(
            "exec {} sweep {} --out {} --shard {index}/{n_shards} --quiet",
            quoted(&program),
            quoted(plan),
            quoted(out)
        )
    };
    let (name, text, command) = match engine {
        Engine::Local => {
            // the processes share the processors
            let all = std::thread::available_parallelism().map_or(1, |n| n.get() as u64);
            let n_threads = (all / n_shards).max(1);
            let line = |i: u64| format!("({} --threads {n_threads}) &", shard(&i.to_string()));
            let lines: Vec<String> = (1..=n_shards).map(line).collect();
            let wait = "failed=0\nfor job in $(jobs -p); do wait \"$job\" || failed=1; done\nexit $failed\n";
            ("local.sh", format!("#!/bin/bash\n{}\n{wait}", lines.join("\n")), vec!["bash".to_owned()])
        }
        Engine::Hq => {
            let array = format!("1-{n_shards}");
            // it would write them to the folder that one happens to be in
            let log = |kind: &str| format!("{}/hq-%{{JOB_ID}}-%{{TASK_ID}}.{kind}", jobs.display());
            let (out, err) = (log("out"), log("err"));
            let command = ["hq", "submit", "--array", &array, "--stdout", &out, "--stderr", &err, "--"];
            let command = command.map(str::to_owned).to_vec();
            ("hq.sh", format!("#!/bin/bash\n{} --threads 1\n", shard("$HQ_TASK_ID")), command)
        }
        Engine::Slurm => {
            let head =
                format!("#!/bin/bash\n#SBATCH --array=1-{n_shards}\n#SBATCH --ntasks=1\n#SBATCH --cpus-per-task=1");
            let logs = format!("#SBATCH --output=\"{}/slurm-%A-%a.log\"", jobs.display());
            let run = format!("{} --threads 1", shard("$SLURM_ARRAY_TASK_ID"));
            ("slurm.sh", format!("{head}\n{logs}\n{run}\n"), vec!["sbatch".to_owned()])
        }
    };
    let script = jobs.join(name);
    let written = sincro_sim::file::prepare(&jobs)
        .and_then(|()| sincro_sim::file::write_atomically(&script, text.as_bytes()))
        .and_then(|()| make_executable(&script));
    if let Err(error) = written {
        return diagnostics::refuse_file(&error);
    }
    let mut command = command;
    command.push(script.display().to_string());
    say!("{}", command.join(" "));
    if is_dry {
        return Exit::Holds;
    }
    match std::process::Command::new(&command[0]).args(&command[1..]).status() {
        Ok(status) if status.success() => {
            say!("then: sincro sweep status {0}, and at the end: sincro sweep collect {0}", out.display());
            Exit::Holds
        }
        Ok(status) => diagnostics::refuse(&format!("`{}` failed: {status}", command[0]), None),
        Err(error) => {
            let help = "install the engine, or write the script alone with --dry-run";
            diagnostics::refuse(&format!("cannot start `{}`: {error}", command[0]), Some(help))
        }
    }
}

fn make_executable(path: &Path) -> Result<(), sincro_sim::file::FileError> {
    #[cfg(unix)]
    {
        use std::os::unix::fs::PermissionsExt as _;
        let set = std::fs::set_permissions(path, std::fs::Permissions::from_mode(0o755));
        set.map_err(|error| sincro_sim::file::FileError::new("make executable", path, error))?;
    }
    Ok(())
}

fn status(folder: &Path) -> Exit {
    let found = Store::existing(folder).and_then(|store| {
        let n = store.n_present()?;
        Ok((store, n))
    });
    let (store, n_present) = match found {
        Ok(found) => found,
        Err(error) => return refuse_store(&error),
    };
    let manifest = &store.manifest;
    let n_parts = store.n_parts();
    say!("{}", manifest.title);
    say!(
        "  {} of {n_parts} parts are there: about {} of {} runs",
        n_present,
        (n_present * manifest.rows_per_part).min(manifest.n_runs),
        manifest.n_runs
    );
    if store.runs_path().is_file() {
        say!("  collected: {}", store.runs_path().display());
    } else if n_present == n_parts {
        say!("  complete: sincro sweep collect {}", folder.display());
    } else {
        say!("  what is missing: sincro sweep {} --out {}", manifest.plan, folder.display());
    }
    Exit::Holds
}

fn refuse_store(error: &StoreError) -> Exit {
    let help = error.help();
    let exit = diagnostics::refuse(&error.to_string(), Some(help.as_str()).filter(|help| !help.is_empty()));
    match error {
        StoreError::File(_) | StoreError::Missing(_) => Exit::Stopped,
        _ => exit,
    }
}
