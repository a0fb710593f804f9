//! `y[k] = mean + std·g_k` or `low + (high − low)·r_k`: a new random number in every sample.
//!
//! `g_k` is of the normal distribution, `r_k` of the uniform one in (0, 1). Sample `k` is a hash of the run's seed, the block's path,
//! the component and `k` (SplitMix64 and Box–Muller, see `random.rs`): two blocks are independent of each other, and the samples
//! are the same in every run with that seed, from wherever it goes on. `std` is that of the samples, whatever the sample time: there
//! is no scaling to a power density.

use sincro_math::Real;

use super::random::{gaussian, splitmix, uniform};
use crate::block::{At, Block, Pace, Ports, elementwise, of};
use crate::kind::{Described, Group, Kind, Parameter, Takes};
use crate::library::short_list;
use crate::reader::Reader;

/// Random numbers, one in every sample.
#[derive(Clone, Debug, PartialEq)]
pub struct Noise {
    /// What they are like.
    pub distribution: Distribution,
}

/// How random numbers are distributed; every parameter is one number for all components or one for each.
#[derive(Clone, Debug, PartialEq)]
pub enum Distribution {
    /// The normal distribution.
    Gaussian {
        /// Mean.
        mean: Vec<f64>,
        /// Standard deviation.
        std: Vec<f64>,
    },
    /// Evenly between two bounds.
    Uniform {
        /// Lower bound.
        low: Vec<f64>,
        /// Upper bound.
        high: Vec<f64>,
    },
}

impl Noise {
    /// Gaussian, with mean 0.
    #[must_use]
    pub fn new(std: f64) -> Self {
        Self { distribution: Distribution::Gaussian { mean: vec![0.0], std: vec![std] } }
    }
}

impl Described for Noise {
    const KIND: &'static Kind = &Kind {
        name: "noise",
        group: Group::Sources,
        summary: "A new random number in every sample, the same in every run with the same seed.",
        equation: "y[k] = mean + std·g_k (gaussian) or low + (high − low)·r_k (uniform)",
        parameters: &[
            Parameter::optional(
                "distribution",
                Takes::Choice(&["gaussian", "uniform"]),
                "normal distribution, or evenly between two bounds",
                "gaussian",
            ),
            Parameter::optional("mean", Takes::Numbers, "mean, if gaussian", "0"),
            Parameter::optional("std", Takes::Numbers, "standard deviation of a sample, if gaussian", "1"),
            Parameter::optional("low", Takes::Numbers, "lower bound, if uniform", "-1"),
            Parameter::optional("high", Takes::Numbers, "upper bound, if uniform", "1"),
        ],
    };

    fn read(p: &mut Reader<'_>) -> Self {
        let is_uniform = p.choice("distribution") == 1;
        let (name, strangers) = if is_uniform { ("uniform", ["mean", "std"]) } else { ("gaussian", ["low", "high"]) };
        for key in strangers.into_iter().filter(|key| p.has(key)).collect::<Vec<_>>() {
            let help = "gaussian noise has `mean` and `std`, uniform noise `low` and `high`";
            p.fault(key, format!("{name} noise has no `{key}`"), help);
        }
        let distribution = if is_uniform {
            Distribution::Uniform { low: p.numbers("low"), high: p.numbers("high") }
        } else {
            let std = p.numbers("std");
            if std.iter().any(|s| *s < 0.0) {
                p.fault("std", "a standard deviation is negative", "it must be 0 or more");
            }
            Distribution::Gaussian { mean: p.numbers("mean"), std }
        };
        Self { distribution }
    }
}

impl Block for Noise {
    type Work<R: Real> = ();

    fn ports(&self) -> Ports {
        Ports::source()
    }

    fn widths(&self, _: &[Option<usize>]) -> Result<Vec<Option<usize>>, String> {
        Ok(vec![match &self.distribution {
            Distribution::Gaussian { mean, std } => elementwise(&[], &[("mean", mean.len()), ("std", std.len())])?,
            Distribution::Uniform { low, high } => elementwise(&[], &[("low", low.len()), ("high", high.len())])?,
        }])
    }

    fn pace(&self) -> Pace {
        Pace::Sampled
    }

    fn output<R: Real>(&self, at: &At<'_, R>, (): &mut (), y: &mut [R]) {
        let sample = at.tick / at.node.every;
        for (i, y) in y.iter_mut().enumerate() {
            let key = splitmix(at.node.seed, i as u64);
            *y = R::splat(match &self.distribution {
                Distribution::Gaussian { mean, std } => of(mean, i) + of(std, i) * gaussian(key, sample),
                Distribution::Uniform { low, high } => of(low, i) + (of(high, i) - of(low, i)) * uniform(key, sample),
            });
        }
    }

    fn label(&self) -> String {
        match &self.distribution {
            Distribution::Gaussian { std, .. } => format!("σ = {}", short_list(std)),
            Distribution::Uniform { low, high } => format!("{} … {}", short_list(low), short_list(high)),
        }
    }
}
