//! `sincro diff`: the first and the greatest difference of each signal of two finished runs.

use std::path::PathBuf;

use clap::Args;
use sincro::compare::{Comparison, Difference, FinishedRun};
use sincro::results::write_text;
use sincro_figures::plot::number::{short, significant};

use crate::{Exit, diagnostics};

/// Arguments of `diff`.
#[derive(Debug, Args)]
pub(crate) struct Arguments {
    /// Folder of a finished run
    first: PathBuf,
    /// Folder of another one
    second: PathBuf,
    /// Page with both runs over each other; `-` for none
    #[arg(long, value_name = "FILE", default_value = "diff.html")]
    out: PathBuf,
}

/// Runs the command: 0 if both runs have the same bits, else 1.
pub(crate) fn run(arguments: &Arguments) -> Exit {
    let runs = [&arguments.first, &arguments.second].map(|folder| FinishedRun::read(folder));
    let [a, b] = match runs {
        [Ok(a), Ok(b)] => [a, b],
        [Err(error), _] | [_, Err(error)] => {
            return diagnostics::refuse(&error.to_string(), Some("name two folders that `sincro run` wrote"));
        }
    };
    let comparison = Comparison::of(&a, &b);
    print(&comparison);
    if arguments.out.as_os_str() != "-" {
        if let Err(error) = write_text(&arguments.out, &comparison.html()) {
            return diagnostics::refuse_file(&error);
        }
        say!("  page {}", arguments.out.display());
    }
    if comparison.is_same() { Exit::Holds } else { Exit::Fails }
}

fn print(found: &Comparison<'_>) {
    say!("{}", found.verdict());
    for (name, x, y) in &found.settings {
        say!("  {name}: {x} against {y}");
    }
    let mut differing: Vec<&Difference> = found.signals.iter().filter(|d| d.first.is_some()).collect();
    differing
        .sort_by(|p, q| p.first.map(|f| f.0).partial_cmp(&q.first.map(|f| f.0)).unwrap_or(std::cmp::Ordering::Equal));
    let width = differing.iter().map(|d| d.name.chars().count()).max().unwrap_or(0);
    for d in differing {
        let (greatest, at) = d.greatest;
        let first = d.first.map_or(0.0, |f| f.0);
        say!(
            "  {:<width$}  from {} s on, at most {} {} at {} s",
            d.name,
            short(first, 6),
            significant(greatest, 3),
            d.unit,
            short(at, 6)
        );
    }
}
