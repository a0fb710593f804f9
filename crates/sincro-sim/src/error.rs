//! Errors of runs as [`Error`]s, with their causes in words.

use std::error::Error;
use std::fmt;

use crate::run::{Halt, RunError};

impl fmt::Display for RunError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Diagnostics(diagnostics) => write!(f, "{diagnostics}"),
            Self::File(error) => write!(f, "{error}"),
        }
    }
}

impl Error for RunError {}

impl fmt::Display for Halt {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::World { tick, t, cause } => write!(f, "stopped at t = {t} s (tick {tick}): {cause}"),
            Self::Block { tick, t, culprit } => {
                write!(f, "stopped at t = {t} s (tick {tick}): the output of block `{}` is not finite", culprit.block)?;
                culprit.fault.iter().try_for_each(|fault| write!(f, ": {fault}"))
            }
            Self::Controller { tick, t, fault, .. } => write!(f, "stopped at t = {t} s (tick {tick}): {fault}"),
        }
    }
}

impl Error for Halt {}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::controller::NotFinite;

    #[test]
    fn a_halt_says_when_and_why() {
        let culprit = NotFinite {
            block: "pid".into(),
            kind: "pid",
            outputs: vec![f64::NAN],
            inputs: Vec::new(),
            fault: Some("its input is not finite".into()),
        };
        let halt: Box<dyn Error> = Halt::Block { tick: 3, t: 0.03, culprit }.into();
        let expected =
            "stopped at t = 0.03 s (tick 3): the output of block `pid` is not finite: its input is not finite";
        assert_eq!(halt.to_string(), expected);
    }
}
