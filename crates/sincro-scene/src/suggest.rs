//! "Did you mean": the known names nearest to an unknown one.

pub use sincro_blocks::suggest::{help_with_list as help, nearest, quoted};
