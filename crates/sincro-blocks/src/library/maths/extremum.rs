//! What the least and the greatest have in common: over several inputs component by component, over one input its components.

use sincro_math::Real;

use crate::block::{At, elementwise};

/// The smaller of two, `a` where they are equal; NaN where one of them is.
#[inline(always)]
pub(super) fn smaller<R: Real>(a: R, b: R) -> R {
    let takes_b = R::from_lanes(|k| if b.lane(k) < a.lane(k) || b.lane(k).is_nan() { 1.0 } else { 0.0 });
    takes_b.if_less(R::splat(0.5), a, b)
}

/// The larger of two, `a` where they are equal; NaN where one of them is.
#[inline(always)]
pub(super) fn larger<R: Real>(a: R, b: R) -> R {
    -smaller(-a, -b)
}

pub(super) fn widths(inputs: &[Option<usize>]) -> Result<Vec<Option<usize>>, String> {
    Ok(vec![if inputs.len() == 1 { Some(1) } else { elementwise(inputs, &[])? }])
}

/// Takes `pick` of two until one is left.
#[inline(always)]
pub(super) fn output<R: Real>(at: &At<'_, R>, y: &mut [R], pick: impl Fn(R, R) -> R) {
    let n_inputs = at.node.inputs.len();
    if n_inputs == 1 {
        let (first, rest) = at.input(0).split_first().expect("a signal has a component");
        y[0] = rest.iter().fold(*first, |best, u| pick(best, *u));
        return;
    }
    for (i, y) in y.iter_mut().enumerate() {
        *y = (1..n_inputs).fold(at.component(0, i), |best, k| pick(best, at.component(k, i)));
    }
}
