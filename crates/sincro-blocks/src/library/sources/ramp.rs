//! `y = from + slope·(min(t, until) − start)` for `t ≥ start`, else `from`.

use sincro_math::Real;

use crate::block::{At, Block, Ports, SAME_INSTANT, elementwise, of};
use crate::kind::{Described, Group, Kind, Parameter, Takes};
use crate::library::short_list;
use crate::reader::Reader;

/// Rises at a constant rate between two instants.
#[derive(Clone, Debug, PartialEq)]
pub struct Ramp {
    /// When it begins to rise `[s]`.
    pub start: f64,
    /// Rate, in units of the output per second; one for all components or one for each.
    pub slope: Vec<f64>,
    /// Value before the start; one for all components or one for each.
    pub from: Vec<f64>,
    /// When it ceases to rise `[s]`; may be infinite.
    pub until: f64,
}

impl Ramp {
    /// From 0 at time 0, for ever.
    #[must_use]
    pub fn new(slope: f64) -> Self {
        Self { start: 0.0, slope: vec![slope], from: vec![0.0], until: f64::INFINITY }
    }
}

impl Described for Ramp {
    const KIND: &'static Kind = &Kind {
        name: "ramp",
        group: Group::Sources,
        summary: "Rises at a constant rate between two instants.",
        equation: "y = from + slope·(min(t, until) − start) for t ≥ start, else from",
        parameters: &[
            Parameter::optional("slope", Takes::Numbers, "rate of y [1/s]", "1"),
            Parameter::optional("start", Takes::Number, "when it begins to rise [s]", "0"),
            Parameter::optional("from", Takes::Numbers, "y before the start", "0"),
            Parameter::optional("until", Takes::Number, "when it ceases to rise [s]", "inf"),
        ],
    };

    fn read(p: &mut Reader<'_>) -> Self {
        let new = Self {
            start: p.number("start"),
            slope: p.numbers("slope"),
            from: p.numbers("from"),
            until: p.limit("until"),
        };
        if new.until < new.start {
            p.fault("until", format!("`until` {} is before `start` {}", new.until, new.start), "exchange them");
        }
        new
    }
}

impl Block for Ramp {
    type Work<R: Real> = ();

    fn ports(&self) -> Ports {
        Ports::source()
    }

    fn widths(&self, _: &[Option<usize>]) -> Result<Vec<Option<usize>>, String> {
        Ok(vec![elementwise(&[], &[("slope", self.slope.len()), ("from", self.from.len())])?])
    }

    fn output<R: Real>(&self, at: &At<'_, R>, (): &mut (), y: &mut [R]) {
        let rising = (at.t.min(self.until) - self.start).max(0.0);
        for (i, y) in y.iter_mut().enumerate() {
            *y = R::splat(of(&self.from, i) + of(&self.slope, i) * rising);
        }
    }

    fn next_corner(&self, t: f64) -> f64 {
        let later = [self.start, self.until].into_iter().filter(|corner| t + SAME_INSTANT < *corner);
        later.fold(f64::INFINITY, f64::min)
    }

    fn label(&self) -> String {
        format!("{}·t", short_list(&self.slope))
    }
}
