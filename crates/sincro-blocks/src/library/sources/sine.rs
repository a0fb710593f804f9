//! `y = offset + amplitude·sin(ω·t + phase)`.

use core::f64::consts::TAU;

use sincro_math::{Real, elementary};

use crate::block::{At, Block, Ports, elementwise, of};
use crate::kind::{Described, Group, Kind, Parameter, Takes};
use crate::library::short_list;
use crate::reader::Reader;

/// A sine wave. Every parameter is one number for all components or one for each.
#[derive(Clone, Debug, PartialEq)]
pub struct Sine {
    /// Amplitude.
    pub amplitude: Vec<f64>,
    /// Angular frequency `[rad/s]`.
    pub angular_frequency: Vec<f64>,
    /// Phase at time 0 `[rad]`.
    pub phase: Vec<f64>,
    /// Mean value.
    pub offset: Vec<f64>,
}

impl Sine {
    /// With an angular frequency in `[rad/s]`, from 0 upwards.
    #[must_use]
    pub fn new(amplitude: f64, angular_frequency: f64) -> Self {
        Self {
            amplitude: vec![amplitude],
            angular_frequency: vec![angular_frequency],
            phase: vec![0.0],
            offset: vec![0.0],
        }
    }

    fn sizes(&self) -> [(&str, usize); 4] {
        [
            ("amplitude", self.amplitude.len()),
            ("angular_frequency", self.angular_frequency.len()),
            ("phase", self.phase.len()),
            ("offset", self.offset.len()),
        ]
    }
}

impl Described for Sine {
    const KIND: &'static Kind = &Kind {
        name: "sine",
        group: Group::Sources,
        summary: "A sine wave.",
        equation: "y = offset + amplitude·sin(ω·t + phase), ω = angular_frequency or 2π·frequency_hz",
        parameters: &[
            Parameter::optional("amplitude", Takes::Numbers, "amplitude of y", "1"),
            Parameter::optional("angular_frequency", Takes::Numbers, "ω [rad/s]; this or `frequency_hz`", "none"),
            Parameter::optional("frequency_hz", Takes::Numbers, "frequency [Hz]; this or `angular_frequency`", "none"),
            Parameter::optional("phase", Takes::Numbers, "phase at t = 0 [rad]", "0"),
            Parameter::optional("offset", Takes::Numbers, "mean of y", "0"),
        ],
    };

    fn read(p: &mut Reader<'_>) -> Self {
        let angular_frequency = match (p.has("angular_frequency"), p.has("frequency_hz")) {
            (true, false) => p.numbers("angular_frequency"),
            (false, true) => p.numbers("frequency_hz").iter().map(|f| TAU * f).collect(),
            (both, _) => {
                let message = if both { "`sine` has two frequencies" } else { "`sine` has no frequency" };
                p.fault("frequency_hz", message, "give either `angular_frequency` [rad/s] or `frequency_hz`");
                vec![1.0]
            }
        };
        Self {
            amplitude: p.numbers("amplitude"),
            angular_frequency,
            phase: p.numbers("phase"),
            offset: p.numbers("offset"),
        }
    }
}

impl Block for Sine {
    type Work<R: Real> = ();

    fn ports(&self) -> Ports {
        Ports::source()
    }

    fn widths(&self, _: &[Option<usize>]) -> Result<Vec<Option<usize>>, String> {
        Ok(vec![elementwise(&[], &self.sizes())?])
    }

    fn output<R: Real>(&self, at: &At<'_, R>, (): &mut (), y: &mut [R]) {
        for (i, y) in y.iter_mut().enumerate() {
            let angle = of(&self.angular_frequency, i) * at.t + of(&self.phase, i);
            *y = R::splat(of(&self.offset, i) + of(&self.amplitude, i) * elementary::sin_cos(angle).0);
        }
    }

    fn label(&self) -> String {
        let wave = format!("sin({}·t)", short_list(&self.angular_frequency));
        if self.amplitude == [1.0] { wave } else { format!("{}·{wave}", short_list(&self.amplitude)) }
    }
}
