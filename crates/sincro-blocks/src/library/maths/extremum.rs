//! Blocks `min` and `max`.

use crate::library::prelude::*;

/// Block `min` or `max` (`IS_MAX`): extremum of its inputs, component by component; of a single input, of its
/// components. Use the aliases [`Min`] and [`Max`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Extremum<const IS_MAX: bool> {
    /// Number of inputs, at least 1.
    pub inputs: usize,
}

/// Block `min`: least of its inputs, `y = min(u1, u2, …)`; of a single input its least component, `y = min uᵢ`.
pub type Min = Extremum<false>;
/// Block `max`: greatest of its inputs, `y = max(u1, u2, …)`; of a single input its greatest component, `y = max uᵢ`.
pub type Max = Extremum<true>;

const INPUTS: &[Parameter] = &[Parameter::optional("inputs", ValueKind::Count, "number of inputs", "2")];

const KINDS: [Kind; 2] = [
    Kind {
        name: "min",
        category: Category::Maths,
        summary: "The least of its inputs, component by component, or the least component of a single input.",
        equation: "y = min(u1, u2, …); of one input y = min uᵢ",
        parameters: INPUTS,
    },
    Kind {
        name: "max",
        category: Category::Maths,
        summary: "The greatest of its inputs, component by component, or the greatest component of a single input.",
        equation: "y = max(u1, u2, …); of one input y = max uᵢ",
        parameters: INPUTS,
    },
];

impl<const IS_MAX: bool> Extremum<IS_MAX> {
    /// Creates the block with this number of inputs, at least 1.
    #[must_use]
    pub fn new(inputs: usize) -> Self {
        Self { inputs }
    }

    #[inline(always)]
    fn pick<R: Real>(a: R, b: R) -> R {
        if IS_MAX { -smaller(-a, -b) } else { smaller(a, b) }
    }
}

/// The smaller of two, `a` where they are equal; NaN where one of them is.
#[inline(always)]
fn smaller<R: Real>(a: R, b: R) -> R {
    let takes_b = R::from_lanes(|k| if b.lane(k) < a.lane(k) || b.lane(k).is_nan() { 1.0 } else { 0.0 });
    takes_b.if_less(R::splat(0.5), a, b)
}

impl<const IS_MAX: bool> Described for Extremum<IS_MAX> {
    const KIND: &'static Kind = &KINDS[IS_MAX as usize];

    fn read(p: &mut Reader<'_>) -> Self {
        Self::new(p.input_count("inputs"))
    }
}

impl<const IS_MAX: bool> Block for Extremum<IS_MAX> {
    type Work<R: Real> = ();
    const KEEPS_UNIT: bool = true;

    fn ports(&self) -> Ports {
        Ports::numbered(self.inputs)
    }

    fn widths(&self, inputs: &[Option<usize>]) -> Result<Vec<Option<usize>>, String> {
        Ok(vec![if self.inputs == 1 { Some(1) } else { elementwise(inputs, &[])? }])
    }

    fn unit_rule(&self) -> UnitRule {
        if self.inputs == 1 { UnitRule::Uniform } else { UnitRule::Same((0..self.inputs).collect()) }
    }

    fn output<R: Real>(&self, at: &At<'_, R>, (): &mut (), y: &mut [R]) {
        if self.inputs == 1 {
            let (first, rest) = at.input(0).split_first().expect("a signal has a component");
            y[0] = rest.iter().fold(*first, |best, u| Self::pick(best, *u));
            return;
        }
        for (i, y) in y.iter_mut().enumerate() {
            *y = (1..self.inputs).fold(at.component(0, i), |best, k| Self::pick(best, at.component(k, i)));
        }
    }

    fn label(&self) -> String {
        Self::KIND.name.into()
    }
}
