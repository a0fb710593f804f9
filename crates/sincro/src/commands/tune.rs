//! `sincro tune`: parameters of a scene for the least value of a goal, within limits.

use std::path::{Path, PathBuf};

use clap::Args;
use sincro::load;
use sincro_campaign::fit::parse_all;
use sincro_campaign::tune::{Goal, Limit, Method, Robust, Tuned, Tuning, measure_tables};
use sincro_campaign::{Campaign, Plan};
use sincro_scene::diagnostic::{Diagnostic, Diagnostics};
use sincro_scene::folder::read_text;
use sincro_sim::run::RunError;

use super::console::Bar;
use super::run::interrupt;
use super::whole_number;
use crate::{Exit, diagnostics};

/// Arguments of `tune`.
#[derive(Debug, Args)]
pub(crate) struct Arguments {
    /// Folder of the scene, or the plan of a campaign whose runs every candidate makes
    #[arg(value_name = "SCENE|PLAN.toml")]
    subject_of: PathBuf,
    /// Parameters to be found: PATH=LOW..HIGH or "PATH=START in LOW..HIGH"; several with commas
    #[arg(long, value_name = "PATH=LOW..HIGH,…", required = true)]
    free: Vec<String>,
    /// Formula of measures and of the scene's checks that is to be small; given twice, the Pareto front of both is
    /// found
    #[arg(long, value_name = "FORMULA", required = true)]
    goal: Vec<String>,
    /// Limit that is kept: MEASURE <= NUMBER or MEASURE >= NUMBER; may be repeated
    #[arg(long, value_name = "LIMIT")]
    subject: Vec<String>,
    /// Measure for goal and limits: NAME=MEASURE(FORMULA), signals in braces; may be repeated
    #[arg(long, value_name = "NAME=MEASURE(…)")]
    measure: Vec<String>,
    /// Several runs as one: worst, mean, or the share of the runs that does not exceed the value
    #[arg(long, value_name = "worst|mean|SHARE", default_value = "worst")]
    robust: String,
    /// Search near the start only
    #[arg(long)]
    local: bool,
    /// Most candidates
    #[arg(long, value_name = "N", default_value_t = 600, value_parser = whole_number::<usize>)]
    budget: usize,
    /// Seed of the search
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = whole_number::<u64>)]
    seed: u64,
    /// Set a number first, as in `run`; may be repeated
    #[arg(long = "set", value_name = "PATH=VALUE")]
    set: Vec<String>,
    /// Folder for tune.json and report.html; nothing is written unless given
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Print nothing but errors
    #[arg(long, short)]
    quiet: bool,
}

/// Runs the command.
pub(crate) fn run(arguments: &Arguments) -> Exit {
    match tune(arguments) {
        Ok(exit) => exit,
        Err(found) => diagnostics::refuse_diagnostics(&found),
    }
}

/// The runs that every candidate makes: those of a plan, or one run of a scene.
fn campaign(arguments: &Arguments) -> Result<Campaign, Diagnostics> {
    let path = &arguments.subject_of;
    let measures = measure_tables(&arguments.measure)?;
    let is_plan = path.is_file() && path.file_name().is_none_or(|name| name != "experiment.toml");
    let mut plan = if is_plan {
        let text =
            read_text(path).map_err(|why| Diagnostic::without_location(format!("cannot read the plan: {why}")))?;
        Plan::parse(path, format!("{text}\n{measures}"))?
    } else {
        let scene = std::path::absolute(path).unwrap_or_else(|_| path.clone());
        let text = format!("scene = {:?}\nchecks = \"all\"\n{measures}", scene.display().to_string());
        Plan::parse(Path::new("--measure"), text)?
    };
    plan.set.extend(super::run::parse_settings(&arguments.set)?);
    Campaign::new(plan, load)
}

fn tune(arguments: &Arguments) -> Result<Exit, Diagnostics> {
    let campaign = campaign(arguments)?;
    let free = parse_all(&arguments.free, &campaign.loaded)?;
    if let Some(unbounded) = free.iter().find(|free| !(free.low.is_finite() && free.high.is_finite())) {
        let message = format!("`{}` has no bounds", unbounded.path);
        return Err(Diagnostic::without_location(message).with_help("write PATH=LOW..HIGH").into());
    }
    let names = &campaign.layout.measures;
    let mut goals: Vec<Goal> = arguments.goal.iter().map(|text| Goal::parse(text, names)).collect::<Result<_, _>>()?;
    if goals.len() > 2 || (goals.len() == 2 && arguments.local) {
        let message =
            if arguments.local { "a front of two goals is not searched locally" } else { "there are three goals" };
        let help = "give one `--goal`, or two without `--local`; make a limit of a third: --subject";
        return Err(Diagnostic::without_location(message).with_help(help).into());
    }
    let second = (goals.len() == 2).then(|| goals.remove(1));
    let goal = goals.remove(0);
    let limits: Vec<Limit> =
        arguments.subject.iter().map(|text| Limit::parse(text, names)).collect::<Result<_, _>>()?;
    let robust = Robust::of_word(&arguments.robust).ok_or_else(|| {
        Diagnostic::without_location(format!("`{}` is no way to make one value of several runs", arguments.robust))
            .with_help("write worst, mean or a share such as 0.9")
    })?;
    let method = if arguments.local { Method::Local } else { Method::Global };
    let (budget, seed) = (arguments.budget.max(1), arguments.seed);
    let tuning = Tuning { campaign: &campaign, free, goal, second, limits, robust, method, budget, seed };
    let bar = if arguments.quiet { Bar::none() } else { Bar::new("tune") };
    let interrupt = interrupt();
    let found = tuning.search(&interrupt, &mut |share, best| bar.show(&format!("best {best:.5}"), share));
    bar.finish();
    match found {
        Ok(Some(tuned)) => Ok(finish(arguments, &tuning, &tuned)),
        Ok(None) => Ok(Exit::Stopped),
        Err(RunError::Diagnostics(found)) => Err(found),
        Err(RunError::File(error)) => Ok(diagnostics::refuse_file(&error)),
    }
}

fn finish(arguments: &Arguments, tuning: &Tuning<'_>, tuned: &Tuned) -> Exit {
    if let Some(out) = &arguments.out
        && let Err(error) = tuning.write(tuned, out)
    {
        return diagnostics::refuse_file(&error);
    }
    if !arguments.quiet {
        say!("{}", tuning.text(tuned).trim_end());
        if let Some(out) = &arguments.out {
            say!("  report {}", out.join("report.html").display());
        }
    }
    if tuned.after.violation == 0.0 { Exit::Holds } else { Exit::Fails }
}
