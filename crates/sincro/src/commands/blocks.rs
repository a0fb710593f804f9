//! `sincro blocks`: the library of blocks, as a list or one by one.

use clap::Args;
use sincro_blocks::kind::Category;
use sincro_blocks::suggest;
use sincro_sim::diagram::reference::{kinds, page};

use crate::{Exit, diagnostics};

/// What `blocks` takes.
#[derive(Debug, Args)]
pub(crate) struct Arguments {
    /// Type of a block, such as `pid`: everything about it, with an example
    name: Option<String>,
}

/// Runs the command.
pub(crate) fn run(arguments: &Arguments) -> Exit {
    let kinds = kinds();
    let Some(name) = &arguments.name else {
        let width = kinds.iter().map(|kind| kind.name.len()).max().unwrap_or(0);
        let mut category: Option<Category> = None;
        for kind in kinds {
            if category != Some(kind.category) {
                say!("{}", kind.category.title());
                category = Some(kind.category);
            }
            say!("  {:<width$}  {}", kind.name, kind.summary);
        }
        return Exit::Holds;
    };
    match kinds.iter().find(|kind| kind.name == *name) {
        Some(kind) => {
            say!("{}", page(kind).trim_end());
            Exit::Holds
        }
        None => {
            let near = suggest::nearest(name, kinds.iter().map(|kind| kind.name));
            let help = near.map_or("`sincro blocks` lists them".to_owned(), |near| format!("did you mean `{near}`?"));
            diagnostics::refuse(&format!("there is no block type `{name}`"), Some(&help))
        }
    }
}
