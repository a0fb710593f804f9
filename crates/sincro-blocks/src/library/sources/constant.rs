//! Block `constant`.

use crate::library::prelude::*;

declare_block! {
    /// The same at all times.
    pub struct Constant("constant", Sources): "y = value" {
        /// Constant output.
        pub value: Vec<f64> as PerComponent,
    }
}

impl Constant {
    /// A scalar.
    #[must_use]
    pub fn new(value: f64) -> Self {
        Self { value: vec![value] }
    }
}

impl Block for Constant {
    type Work<R: Real> = ();
    const SAMPLE_TIME: SampleTimeKind = SampleTimeKind::Constant;

    fn ports(&self) -> Ports {
        Ports::source()
    }

    fn output<R: Real>(&self, _: &At<'_, R>, (): &mut (), y: &mut [R]) {
        for (y, value) in y.iter_mut().zip(&self.value) {
            *y = R::splat(*value);
        }
    }

    fn label(&self) -> String {
        short_list(&self.value)
    }
}
