//! `sincro fit`: parameters of a scene from measured data.

use std::path::PathBuf;

use clap::{Args, ValueEnum};
use sincro::load;
use sincro_campaign::fit::excitation::planned;
use sincro_campaign::fit::{
    DataSet, Excitation, Fit, FitOptions, FreeParameter, Loss, Model, ModelError, Sensitivity, SignalChoice,
    SolveError, parse_all,
};
use sincro_scene::diagnostic::{Diagnostic, Diagnostics};
use sincro_scene::overrides::Override;
use sincro_sim::Loaded;

use super::console::Bar;
use super::run::{interrupt, parse_settings};
use super::whole_number;
use crate::{Exit, diagnostics};

/// Arguments of `fit`.
#[derive(Debug, Args)]
pub(crate) struct Arguments {
    /// Folder of the scene, or its experiment.toml
    scene: PathBuf,
    /// Measured data: CSV whose first column is the time; may be repeated
    #[arg(long, value_name = "FILE", required_unless_present = "design")]
    data: Vec<PathBuf>,
    /// Parameters to be found: PATH, PATH=START, PATH=LOW..HIGH or "PATH=START in LOW..HIGH"; several with commas
    #[arg(long, value_name = "PATH,…", required = true)]
    free: Vec<String>,
    /// Signal that a column measures, with the standard deviation of its noise: SIGNAL[=COLUMN][@SIGMA]; every column
    /// with the name of a recorded signal unless given
    #[arg(long, value_name = "SIGNAL=COLUMN")]
    signal: Vec<String>,
    /// Propose the input that tells most instead of fitting: its numbers with their bounds; several with commas. The
    /// signals of `--signal` need their noise
    #[arg(long, value_name = "PATH=LOW..HIGH,…")]
    design: Vec<String>,
    /// Time between the planned measurements of `--design` [s]; the base step unless given. With `--data` they are
    /// those of the file
    #[arg(long, value_name = "S", requires = "design")]
    every: Option<f64>,
    /// Most inputs that `--design` tries
    #[arg(long, value_name = "N", default_value_t = 200, value_parser = whole_number::<usize>)]
    budget: usize,
    /// Seed of the search of `--design`
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = whole_number::<u64>)]
    seed: u64,
    /// Data that are held back to judge the fit
    #[arg(long, value_name = "FILE")]
    validate: Vec<PathBuf>,
    /// Find a time offset of each file, too
    #[arg(long)]
    time_offset: bool,
    /// Find a start by multiple shooting in N parts first: for starts that are far off
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(2..=1000))]
    shooting: Option<u32>,
    /// Refuse a fit with derivatives by differences; exact ones are taken wherever they can be
    #[arg(long)]
    exact: bool,
    /// Loss of a residual; the robust ones bear outliers
    #[arg(long, value_enum, default_value_t = LossWord::Squares)]
    loss: LossWord,
    /// Set a number first, as in `run`; may be repeated
    #[arg(long = "set", value_name = "PATH=VALUE")]
    set: Vec<String>,
    /// Folder for fit.json and report.html; nothing is written unless given
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Print fit.json on standard output instead of the summary
    #[arg(long)]
    json: bool,
}

/// Losses by their words.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum LossWord {
    /// Least squares.
    Squares,
    /// Linear beyond 1.3 standard deviations.
    Huber,
    /// Logarithmic beyond 2.4 standard deviations.
    Cauchy,
}

/// Runs the command.
pub(crate) fn run(arguments: &Arguments) -> Exit {
    match fit(arguments) {
        Ok(exit) => exit,
        Err(found) => diagnostics::refuse_diagnostics(&found),
    }
}

fn fit(arguments: &Arguments) -> Result<Exit, Diagnostics> {
    let set = parse_settings(&arguments.set)?;
    let loaded = load(&arguments.scene, &set)?;
    let free = parse_all(&arguments.free, &loaded)?;
    let choices: Vec<SignalChoice> =
        arguments.signal.iter().map(|text| SignalChoice::parse(text)).collect::<Result<_, _>>()?;
    let recorded: Vec<String> = loaded.experiment.record.iter().map(|signal| signal.value.clone()).collect();
    let read = |paths: &[PathBuf]| -> Result<Vec<DataSet>, Diagnostics> {
        paths.iter().map(|path| DataSet::read(path, &choices, &recorded)).collect()
    };
    let (sets, held_back) = (read(&arguments.data)?, read(&arguments.validate)?);
    let interrupt = interrupt();
    if !arguments.design.is_empty() {
        return design(arguments, &loaded, set, free, (&choices, sets));
    }
    let model = Model::new(&loaded, &set, free, &sets, arguments.time_offset, &interrupt);
    let names = model.names();
    let loss = match arguments.loss {
        LossWord::Squares => Loss::Squares,
        LossWord::Huber => Loss::Huber,
        LossWord::Cauchy => Loss::Cauchy,
    };
    if arguments.exact {
        refuse_differences(&model)?;
    }
    let options = FitOptions { loss, shooting: arguments.shooting.map(|n| n as usize), ..FitOptions::default() };
    let fit = match Fit::new(loaded.experiment.title.clone(), model, options, &held_back) {
        Ok(fit) => fit,
        Err(SolveError::Model(ModelError::Interrupted)) => {
            eprintln!("the fit was interrupted");
            return Ok(Exit::Stopped);
        }
        Err(SolveError::Model(error)) => return Err(error.into()),
        Err(SolveError::Dead(dead)) => {
            let dead: Vec<String> = dead.iter().map(|k| format!("`{}`", names[*k])).collect();
            let message = format!("{} changes nothing of what was measured", dead.join(" and "));
            let help =
                "a fit of it would stay where it starts: set it, excite it, or measure a signal that depends on it";
            return Err(Diagnostic::without_location(message).with_help(help).into());
        }
        Err(SolveError::TooFew(n)) => {
            let message = format!("{n} measured values lie within the run, for {} unknowns", names.len());
            let help = "the times of the data are those of the run, from 0; `--time-offset` shifts them";
            return Err(Diagnostic::without_location(message).with_help(help).into());
        }
    };
    if let Some(out) = &arguments.out
        && let Err(error) = fit.write(out)
    {
        return Ok(diagnostics::refuse_file(&error));
    }
    if arguments.json {
        say!("{}", serde_json::to_string_pretty(&fit.json()).expect("plain data"));
    } else {
        say!("{}", fit.text().trim_end());
        if let Some(out) = &arguments.out {
            say!("  report {}", out.join("report.html").display());
        }
    }
    let is_identifiable = fit.inference.estimates.iter().all(|estimate| estimate.is_identifiable);
    Ok(if fit.solution.has_converged && is_identifiable { Exit::Holds } else { Exit::Fails })
}

/// Proposes the input that tells most about the free parameters.
fn design(
    arguments: &Arguments,
    loaded: &Loaded,
    set: Vec<Override>,
    free: Vec<FreeParameter>,
    (choices, mut data): (&[SignalChoice], Vec<DataSet>),
) -> Result<Exit, Diagnostics> {
    let input = parse_all(&arguments.design, loaded)?;
    if let Some(unbounded) = input.iter().find(|input| !(input.low.is_finite() && input.high.is_finite())) {
        let message = format!("`{}` of `--design` has no bounds", unbounded.path);
        return Err(Diagnostic::without_location(message).with_help("write PATH=LOW..HIGH").into());
    }
    let without_noise = |signal: &str| {
        let message = format!("the noise of `{signal}` is not given");
        let help = "an input is judged by the intervals that it leads to: --signal SIGNAL=COLUMN@SIGMA";
        Diagnostics::from(Diagnostic::without_location(message).with_help(help))
    };
    if choices.is_empty() {
        return Err(without_noise("--signal"));
    }
    if let Some(choice) = choices.iter().find(|choice| choice.sigma.is_none()) {
        return Err(without_noise(&choice.signal));
    }
    if data.is_empty() {
        let every = arguments.every.unwrap_or(loaded.experiment.step);
        if !(every > 0.0 && every <= loaded.experiment.duration) {
            let message = format!("`--every {every}` is no time between measurements of this run");
            let help = format!("it is above 0 and at most the duration, {} s", loaded.experiment.duration);
            return Err(Diagnostic::without_location(message).with_help(help).into());
        }
        data.push(planned(loaded, choices, every).map_err(|signal| without_noise(&signal))?);
    }
    let (budget, seed) = (arguments.budget.max(1), arguments.seed);
    let excitation = Excitation { loaded, set, free, input, data, confidence: 0.95, budget, seed };
    let bar = if arguments.json { Bar::none() } else { Bar::new("design") };
    let interrupt = interrupt();
    let found = excitation.search(&interrupt, &mut |share, best| bar.show(&format!("log det F {best:.4}"), share));
    bar.finish();
    let Some(excited) = found? else { return Ok(Exit::Stopped) };
    if let Some(out) = &arguments.out
        && let Err(error) = excitation.write(&excited, out)
    {
        return Ok(diagnostics::refuse_file(&error));
    }
    if arguments.json {
        say!("{}", serde_json::to_string_pretty(&excitation.json(&excited)).expect("plain data"));
    } else {
        say!("{}", excitation.text(&excited).trim_end());
        if let Some(out) = &arguments.out {
            say!("  report {}", out.join("report.html").display());
        }
    }
    Ok(if excited.after.log_det.is_finite() { Exit::Holds } else { Exit::Fails })
}

/// Refuses parameters whose derivatives are differences, each with its reason.
fn refuse_differences(model: &Model<'_>) -> Result<(), Diagnostics> {
    let mut found = Diagnostics::new();
    for (name, way) in model.names().iter().zip(model.ways()?) {
        if let Sensitivity::Differences(reason) = way {
            let message = format!("there is no exact derivative by `{name}`: {reason}");
            found.push(
                Diagnostic::without_location(message).with_help("leave `--exact` out to take differences of runs"),
            );
        }
    }
    if found.any_error() { Err(found) } else { Ok(()) }
}
