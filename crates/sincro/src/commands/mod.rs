//! The commands, one file each.

pub(crate) mod check;
pub(crate) mod console;
pub(crate) mod reproduce;
pub(crate) mod run;
