//! Block `power`.

use crate::library::prelude::*;

declare_block! {
    /// Raises to a power, component by component.
    ///
    /// A negative number to a power that is not whole is not a number: the run stops and names this block.
    pub struct Power("power", Maths): "y = u^exponent; without the parameter y = u1^u2" {
        /// Exponent; if it is left out, there is a second input in its place.
        pub exponent: Option<Vec<f64>> as OptionalParameter<PerComponent> = "none",
    }
}

impl Power {
    /// Creates the block with a constant exponent.
    #[must_use]
    pub fn new(exponent: f64) -> Self {
        Self { exponent: Some(vec![exponent]) }
    }
}

impl Block for Power {
    type Work<R: Real> = ();
    const IN_LANES: bool = true;

    fn ports(&self) -> Ports {
        Ports::numbered(if self.exponent.is_some() { 1 } else { 2 })
    }

    fn unit_rule(&self) -> UnitRule {
        let exponent = self.exponent.as_deref().and_then(|all| match all {
            [e] if e.abs() <= 4.0 && *e == e.trunc() => Some(*e as i8),
            _ => None,
        });
        exponent.map_or(UnitRule::Unknown, |e| UnitRule::Powers(vec![e]))
    }

    #[inline(always)]
    fn output<R: Real>(&self, at: &At<'_, R>, (): &mut (), y: &mut [R]) {
        for (i, y) in y.iter_mut().enumerate() {
            let base = at.component(0, i);
            *y = match &self.exponent {
                None => base.binary(elementary::Binary::Pow, at.component(1, i)),
                Some(exponent) => base.map(|u| {
                    let (power, by_base, _) = elementary::pow(u, of(exponent, i));
                    (power, by_base)
                }),
            };
        }
    }

    fn label(&self) -> String {
        match &self.exponent {
            Some(exponent) => format!("u^{}", short_list(exponent)),
            None => "u1^u2".into(),
        }
    }
}
