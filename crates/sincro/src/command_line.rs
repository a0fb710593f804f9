//! The command line of sincro.
//!
//! Exit status: 0 all checks hold and the audit has no findings, 1 a check fails or could not be made or the audit has
//! findings, 2 bad input (nothing is written), 3 the run stopped (what was recorded is kept).

use std::ffi::OsString;

use clap::error::{ContextKind, ContextValue};
use clap::{CommandFactory, FromArgMatches, Parser, Subcommand};

use crate::diagnostics;
use crate::{Verdict, commands};

/// Simulates robots and their controllers in lock-step: exact, deterministic, with an error bar on every run.
#[derive(Debug, Parser)]
#[command(name = "sincro", version, about, propagate_version = true, arg_required_else_help = true)]
struct Cli {
    #[cfg(feature = "adapters")]
    /// Run each FMU in a process of its own, which may crash
    #[arg(long, global = true)]
    isolate: bool,
    #[command(subcommand)]
    command: Command,
}

#[derive(Debug, Subcommand)]
enum Command {
    /// Run a scene folder, judge its checks, write signals, figures and a report
    Run(commands::run::Arguments),
    #[cfg(feature = "campaigns")]
    /// Run a campaign: many runs with drawn or gridded parameters, in shards, with a report
    Sweep(commands::sweep::Arguments),
    #[cfg(feature = "campaigns")]
    /// Find parameters of a scene from measured data, with intervals and what the data cannot tell
    Fit(commands::fit::Arguments),
    #[cfg(feature = "campaigns")]
    /// Find parameters of a scene for the least value of a goal, within limits, over one run or a campaign
    Tune(commands::tune::Arguments),
    /// Check a scene without running it: objects, degrees of freedom, warnings, available signals
    Check(commands::check::Arguments),
    /// Draw the block diagram of a scene as SVG
    Draw(commands::draw::Arguments),
    #[cfg(feature = "analysis")]
    /// Linearise a scene: matrices, poles, zeros, Bode and step plots
    Linearize(commands::linearize::Arguments),
    #[cfg(feature = "analysis")]
    /// Find an equilibrium of a scene
    Trim(commands::trim::Arguments),
    #[cfg(feature = "analysis")]
    /// Print mass matrix, inverse and forward dynamics of a scene at given states
    Dynamics(commands::dynamics::Arguments),
    #[cfg(feature = "formats")]
    /// Import a robot from URDF, SDF or MJCF as a scene folder, with a report of every element
    Import(commands::import::Arguments),
    #[cfg(any(feature = "formats", feature = "adapters"))]
    /// Write a scene in another format, and say what the format cannot
    #[command(subcommand)]
    Export(commands::export::Format),
    #[cfg(feature = "adapters")]
    /// Show a scene live, or replay a finished run, in the browser: 3-D, plots, transport controls, parameters
    View(commands::view::Arguments),
    #[cfg(feature = "adapters")]
    /// Show a finished run in the browser
    Replay(commands::view::ReplayArguments),
    /// Make a scene folder to start from
    New(commands::new::Arguments),
    /// Rewrite scene folders in the present format, comments kept
    Convert(commands::convert::Arguments),
    /// Write the schemas of scene and experiment files where editors find them
    Schema(commands::shell::SchemaArguments),
    #[cfg(feature = "cli")]
    /// Print completions for a shell
    Completions(commands::shell::CompletionArguments),
    #[cfg(feature = "cli")]
    /// Print the manual page
    Man(commands::shell::ManArguments),
    /// List, compare or prune finished runs
    Runs(commands::runs::Arguments),
    /// Compare two finished runs: the first and the greatest difference of each signal
    Diff(commands::diff::Arguments),
    /// List the blocks that diagrams are made of, or show one with its parameters and an example
    Blocks(commands::blocks::Arguments),
    #[cfg(feature = "adapters")]
    /// Serve a scene to clients of V-REP and CoppeliaSim: legacy, ZeroMQ and WebSocket remote APIs
    Serve(commands::serve::Arguments),
    /// Run every experiment of the thesis and show measured and expected values on one page
    Reproduce(commands::reproduce::Arguments),
    #[cfg(feature = "adapters")]
    /// Be the process of an FMU, for `--isolate`
    #[command(hide = true)]
    FmuWorker,
    #[cfg(feature = "cli")]
    /// Measure speed, memory and accuracy on this machine, next to MuJoCo and Pinocchio on request
    Bench(sincro_bench::Options),
}

/// Exit of a command.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Exit {
    /// All checks hold, and the audit has no findings.
    Holds,
    /// A check fails or could not be made, or the audit has findings.
    Fails,
    /// Bad input.
    Refused,
    /// The run stopped.
    Stopped,
}

impl From<Verdict> for Exit {
    fn from(verdict: Verdict) -> Self {
        match verdict {
            Verdict::Holds => Self::Holds,
            Verdict::Fails => Self::Fails,
            Verdict::Stopped => Self::Stopped,
        }
    }
}

impl From<Exit> for u8 {
    fn from(exit: Exit) -> Self {
        match exit {
            Exit::Holds => 0,
            Exit::Fails => 1,
            Exit::Refused => 2,
            Exit::Stopped => 3,
        }
    }
}

/// Runs the command line `sincro` on its arguments, the first of which is the name of the program, and returns the exit
/// status: 0 done and all checks hold, 1 a check fails, 2 bad input, 3 a run stopped. Unlike the rest of this library
/// it prints, and ends the process at a second Ctrl-C.
pub fn run(arguments: impl IntoIterator<Item = OsString>) -> u8 {
    let parsed = with_negative_numbers(Cli::command()).try_get_matches_from(arguments);
    let command = match parsed.and_then(|matches| Cli::from_arg_matches(&matches)) {
        Ok(cli) => {
            #[cfg(feature = "adapters")]
            if cli.isolate
                && let Err(error) = isolate_fmus()
            {
                eprintln!("this program cannot be found, to be started for each FMU: {error}");
                return Exit::Refused.into();
            }
            cli.command
        }
        Err(refused) => {
            if let Some(exit) = refuse_absent(&refused) {
                return exit.into();
            }
            let _ = refused.print();
            return u8::try_from(refused.exit_code()).unwrap_or(2);
        }
    };
    let exit = match command {
        Command::Run(arguments) => commands::run::run(&arguments),
        #[cfg(feature = "campaigns")]
        Command::Sweep(arguments) => commands::sweep::run(&arguments),
        #[cfg(feature = "campaigns")]
        Command::Fit(arguments) => commands::fit::run(&arguments),
        #[cfg(feature = "campaigns")]
        Command::Tune(arguments) => commands::tune::run(&arguments),
        Command::Check(arguments) => commands::check::run(&arguments),
        Command::Draw(arguments) => commands::draw::run(&arguments),
        #[cfg(feature = "analysis")]
        Command::Linearize(arguments) => commands::linearize::run(&arguments),
        #[cfg(feature = "analysis")]
        Command::Trim(arguments) => commands::trim::run(&arguments),
        #[cfg(feature = "analysis")]
        Command::Dynamics(arguments) => commands::dynamics::run(&arguments),
        #[cfg(feature = "formats")]
        Command::Import(arguments) => commands::import::run(&arguments),
        #[cfg(any(feature = "formats", feature = "adapters"))]
        Command::Export(format) => commands::export::run(&format),
        #[cfg(feature = "adapters")]
        Command::View(arguments) => commands::view::run(&arguments),
        #[cfg(feature = "adapters")]
        Command::Replay(arguments) => commands::view::replay(&arguments),
        Command::New(arguments) => commands::new::run(&arguments),
        Command::Convert(arguments) => commands::convert::run(&arguments),
        Command::Schema(arguments) => commands::shell::schema(&arguments),
        #[cfg(feature = "cli")]
        Command::Completions(arguments) => commands::shell::completions(&arguments, Cli::command()),
        #[cfg(feature = "cli")]
        Command::Man(arguments) => commands::shell::man(&arguments, Cli::command()),
        Command::Runs(arguments) => commands::runs::run(&arguments),
        Command::Diff(arguments) => commands::diff::run(&arguments),
        Command::Blocks(arguments) => commands::blocks::run(&arguments),
        #[cfg(feature = "adapters")]
        Command::Serve(arguments) => commands::serve::run(&arguments),
        Command::Reproduce(arguments) => commands::reproduce::run(&arguments),
        #[cfg(feature = "adapters")]
        Command::FmuWorker => match sincro_fmu::import::isolated::serve() {
            Ok(()) => Exit::Holds,
            Err(_) => Exit::Stopped,
        },
        #[cfg(feature = "cli")]
        Command::Bench(options) => match sincro_bench::run(&options) {
            Ok(()) => Exit::Holds,
            Err(message) => diagnostics::refuse(&message, None),
        },
    };
    exit.into()
}

/// Commands that are there with a feature of the program only.
const OPTIONAL: [(&str, bool, &[&str]); 5] = [
    ("campaigns", cfg!(feature = "campaigns"), &["sweep", "fit", "tune"]),
    ("analysis", cfg!(feature = "analysis"), &["linearize", "trim", "dynamics"]),
    ("formats", cfg!(feature = "formats"), &["import", "export", "c", "urdf", "mjcf", "sdf"]),
    ("adapters", cfg!(feature = "adapters"), &["view", "replay", "serve", "fmu"]),
    ("cli", cfg!(feature = "cli"), &["completions", "man", "bench"]),
];

/// Says which feature a command needs, if it is one that this program was built without.
fn refuse_absent(refused: &clap::Error) -> Option<Exit> {
    let ContextValue::String(command) = refused.get(ContextKind::InvalidSubcommand)? else { return None };
    let is_absent =
        |(_, is_there, commands): &&(&str, bool, &[&str])| !is_there && commands.contains(&command.as_str());
    let (feature, ..) = OPTIONAL.iter().find(is_absent)?;
    let message = format!("this program was built without `{command}`");
    let help = format!(
        "build it with `cargo build --release -p sincro --no-default-features --features run,{feature}`, or with all commands: `cargo build --release`"
    );
    Some(diagnostics::refuse(&message, Some(&help)))
}

/// Lets FMUs run in processes of their own: this program again, as their worker.
#[cfg(feature = "adapters")]
fn isolate_fmus() -> std::io::Result<()> {
    crate::load::isolate_fmus(std::env::current_exe()?, vec!["fmu-worker".to_owned()]);
    Ok(())
}

/// Takes negative numbers for values of every option, not for unknown flags: a wrong one is then refused by what it
/// means.
fn with_negative_numbers(command: clap::Command) -> clap::Command {
    let options = command.mut_args(|argument| {
        let is_option = argument.get_action().takes_values() && !argument.is_positional();
        if is_option { argument.allow_negative_numbers(true) } else { argument }
    });
    options.mut_subcommands(with_negative_numbers)
}
