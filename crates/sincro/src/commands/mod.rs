//! The commands, one file each.

/// Prints a line; a reader that has gone away (`| head`) is no reason to panic.
macro_rules! say {
    ($($words:tt)*) => {{
        use std::io::Write as _;
        let _ = writeln!(std::io::stdout(), $($words)*);
    }};
}

pub(crate) mod blocks;
pub(crate) mod check;
pub(crate) mod console;
pub(crate) mod convert;
pub(crate) mod diff;
pub(crate) mod draw;
#[cfg(feature = "analysis")]
pub(crate) mod dynamics;
#[cfg(any(feature = "formats", feature = "adapters"))]
pub(crate) mod export;
#[cfg(feature = "formats")]
pub(crate) mod export_c;
#[cfg(feature = "adapters")]
pub(crate) mod export_fmu;
#[cfg(feature = "formats")]
pub(crate) mod export_robot;
#[cfg(feature = "campaigns")]
pub(crate) mod fit;
mod gallery;
#[cfg(feature = "formats")]
pub(crate) mod import;
#[cfg(feature = "analysis")]
pub(crate) mod linearize;
mod mutate;
pub(crate) mod new;
pub(crate) mod reproduce;
pub(crate) mod robot_file;
pub(crate) mod run;
pub(crate) mod runs;
#[cfg(feature = "adapters")]
pub(crate) mod serve;
pub(crate) mod shell;
#[cfg(feature = "campaigns")]
pub(crate) mod sweep;
#[cfg(feature = "analysis")]
pub(crate) mod trim;
#[cfg(feature = "campaigns")]
pub(crate) mod tune;
#[cfg(feature = "adapters")]
pub(crate) mod view;

/// Value of an option that counts something.
fn whole_number<N: std::str::FromStr>(text: &str) -> Result<N, String> {
    text.parse().map_err(|_| "expected a whole number from 0 on".to_owned())
}
