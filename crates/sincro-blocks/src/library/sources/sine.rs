//! Block `sine`.

use core::f64::consts::TAU;

use crate::library::prelude::*;

declare_block! {
    /// A sine wave.
    ///
    /// Every parameter is one number for all components or one for each.
    pub struct Sine("sine", Sources):
        "y = offset + amplitude·sin(ω·t + phase), ω = angular_frequency or 2π·frequency_hz" {
        /// Amplitude of y.
        pub amplitude: Vec<f64> as PerComponent = "1",
        /// ω `[rad/s]`; this or `frequency_hz`.
        pub angular_frequency: Option<Vec<f64>> as OptionalParameter<PerComponent> = "none",
        /// Frequency `[Hz]`; this or `angular_frequency`.
        pub frequency_hz: Option<Vec<f64>> as OptionalParameter<PerComponent> = "none",
        /// Phase at t = 0 `[rad]`.
        pub phase: Vec<f64> as PerComponent = "0",
        /// Mean of y.
        pub offset: Vec<f64> as PerComponent = "0",
    } with {
        /// Angular frequency `[rad/s]`, whichever way it is given.
        pub omega: Vec<f64> = vec![1.0],
    }
}

impl Sine {
    /// Creates the block with an angular frequency in `[rad/s]`, from 0 upwards.
    #[must_use]
    pub fn new(amplitude: f64, angular_frequency: f64) -> Self {
        Self {
            amplitude: vec![amplitude],
            angular_frequency: Some(vec![angular_frequency]),
            frequency_hz: None,
            phase: vec![0.0],
            offset: vec![0.0],
            omega: vec![angular_frequency],
        }
    }
}

impl Block for Sine {
    type Work<R: Real> = ();

    fn validate(&mut self, p: &mut Reader<'_>) {
        self.omega = match (&self.angular_frequency, &self.frequency_hz) {
            (Some(omega), None) => omega.clone(),
            (None, Some(frequency)) => frequency.iter().map(|f| TAU * f).collect(),
            (both, _) => {
                let message = if both.is_some() { "`sine` has two frequencies" } else { "`sine` has no frequency" };
                p.fault("frequency_hz", message, "give either `angular_frequency` [rad/s] or `frequency_hz`");
                vec![1.0]
            }
        };
    }

    fn ports(&self) -> Ports {
        Ports::source()
    }

    fn output<R: Real>(&self, at: &At<'_, R>, (): &mut (), y: &mut [R]) {
        for (i, y) in y.iter_mut().enumerate() {
            let angle = of(&self.omega, i) * at.t + of(&self.phase, i);
            *y = R::splat(of(&self.offset, i) + of(&self.amplitude, i) * elementary::sin_cos(angle).0);
        }
    }

    fn highest_frequency(&self, _: f64, _: bool) -> f64 {
        let n = self.omega.len().max(self.amplitude.len());
        let sounding = (0..n).filter(|i| of(&self.amplitude, *i) != 0.0);
        sounding.map(|i| of(&self.omega, i).abs() / TAU).fold(0.0, f64::max)
    }

    fn label(&self) -> String {
        let wave = format!("sin({}·t)", short_list(&self.omega));
        if self.amplitude == [1.0] { wave } else { format!("{}·{wave}", short_list(&self.amplitude)) }
    }
}
