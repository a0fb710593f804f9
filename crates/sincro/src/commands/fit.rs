//! `sincro fit`: parameters of a scene from measured data.

use std::path::PathBuf;

use clap::{Args, ValueEnum};
use sincro::load;
use sincro_campaign::fit::{
    DataSet, Fit, FitOptions, Loss, Model, ModelError, Sensitivity, SignalChoice, SolveError, parse_all,
};
use sincro_scene::diagnostic::{Diagnostic, Diagnostics};

use super::run::{interrupt, parse_settings};
use crate::{Exit, diagnostics};

/// Arguments of `fit`.
#[derive(Debug, Args)]
pub(crate) struct Arguments {
    /// Folder of the scene, or its experiment.toml
    scene: PathBuf,
    /// Measured data: CSV whose first column is the time; may be repeated
    #[arg(long, value_name = "FILE", required = true)]
    data: Vec<PathBuf>,
    /// Parameters to be found: PATH, PATH=START, PATH=LOW..HIGH or "PATH=START in LOW..HIGH"; several with commas
    #[arg(long, value_name = "PATH,…", required = true)]
    free: Vec<String>,
    /// Signal that a column measures, with the standard deviation of its noise: SIGNAL[=COLUMN][@SIGMA]; every column
    /// with the name of a recorded signal unless given
    #[arg(long, value_name = "SIGNAL=COLUMN")]
    signal: Vec<String>,
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
