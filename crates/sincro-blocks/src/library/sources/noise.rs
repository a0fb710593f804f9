//! `y[k] = mean + std·g_k` or `low + (high − low)·r_k`: a new random number in every sample.
//!
//! `g_k` is of the normal distribution, `r_k` of the uniform one in (0, 1). Sample `k` is a hash of the run's seed, the
//! block's path, the component and `k` (SplitMix64 and Box–Muller, see `random.rs`): two blocks are independent of each
//! other, and the samples are the same in every run with that seed, from wherever it goes on. `std` is that of the
//! samples, whatever the sample time: there is no scaling to a power density.

use sincro_math::random::splitmix64;

use super::random::{gaussian, uniform};
use crate::library::prelude::*;

declare_block! {
    /// A new random number in every sample, the same in every run with the same seed.
    pub struct Noise("noise", Sources): "y[k] = mean + std·g_k (gaussian) or low + (high − low)·r_k (uniform)" {
        /// Normal distribution, or evenly between two bounds.
        pub distribution: Distribution as Choice = "gaussian",
        /// Mean, if gaussian.
        pub mean: Vec<f64> as PerComponent = "0",
        /// Standard deviation of a sample, if gaussian.
        pub std: Vec<f64> as PerComponent = "1",
        /// Lower bound, if uniform.
        pub low: Vec<f64> as PerComponent = "-1",
        /// Upper bound, if uniform.
        pub high: Vec<f64> as PerComponent = "1",
    }
}

choice! {
    /// Distribution of random numbers.
    pub enum Distribution {
        /// Normal distribution.
        Gaussian = "gaussian",
        /// Uniform distribution between two bounds.
        Uniform = "uniform",
    }
}

impl Noise {
    /// Gaussian, with mean 0.
    #[must_use]
    pub fn new(std: f64) -> Self {
        Self { std: vec![std], ..Self::with_defaults() }
    }
}

impl Block for Noise {
    type Work<R: Real> = ();
    const SAMPLE_TIME: SampleTimeKind = SampleTimeKind::Discrete;

    fn validate(&mut self, p: &mut Reader<'_>) {
        let strangers = if self.distribution == Distribution::Uniform { ["mean", "std"] } else { ["low", "high"] };
        for key in strangers.into_iter().filter(|key| p.has(key)).collect::<Vec<_>>() {
            let help = "gaussian noise has `mean` and `std`, uniform noise `low` and `high`";
            p.fault(key, format!("{} noise has no `{key}`", self.distribution.word()), help);
        }
        if self.std.iter().any(|s| *s < 0.0) {
            p.fault("std", "a standard deviation is negative", "it must be 0 or more");
        }
    }

    fn ports(&self) -> Ports {
        Ports::source()
    }

    fn widths(&self, _: &[Option<usize>]) -> Result<Vec<Option<usize>>, String> {
        let own = if self.distribution == Distribution::Uniform { ["low", "high"] } else { ["mean", "std"] };
        let mut parameters = self.parameter_widths();
        parameters.retain(|(name, _)| own.contains(name));
        Ok(vec![elementwise(&[], &parameters)?])
    }

    fn output<R: Real>(&self, at: &At<'_, R>, (): &mut (), y: &mut [R]) {
        let sample = at.tick / at.node.every;
        for (i, y) in y.iter_mut().enumerate() {
            let key = splitmix64(at.node.seed, i as u64);
            *y = R::splat(match self.distribution {
                Distribution::Gaussian => of(&self.mean, i) + of(&self.std, i) * gaussian(key, sample),
                Distribution::Uniform => {
                    let (low, high) = (of(&self.low, i), of(&self.high, i));
                    low + (high - low) * uniform(key, sample)
                }
            });
        }
    }

    fn label(&self) -> String {
        match self.distribution {
            Distribution::Gaussian => format!("σ = {}", short_list(&self.std)),
            Distribution::Uniform => format!("{} … {}", short_list(&self.low), short_list(&self.high)),
        }
    }
}
