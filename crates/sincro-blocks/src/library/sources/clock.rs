//! Block `clock`.

use crate::library::prelude::*;

declare_block! {
    /// The time since the start in seconds.
    pub struct Clock("clock", Sources): "y = t";
}

impl Block for Clock {
    type Work<R: Real> = ();

    fn ports(&self) -> Ports {
        Ports::source()
    }

    fn units(&self, _: &[Option<Unit>]) -> Result<Vec<Option<Unit>>, String> {
        Ok(vec![Unit::parse("s").ok()])
    }

    fn output<R: Real>(&self, at: &At<'_, R>, (): &mut (), y: &mut [R]) {
        y[0] = R::splat(at.t);
    }

    fn label(&self) -> String {
        "t".into()
    }
}
