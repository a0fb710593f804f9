//! Projected Gauss–Seidel for the contact problem, contact by contact: slow, but it needs neither an active set nor a
//! convex problem. Used where both [`super::solver`]'s iterations fail. Source: key `jean1999` (non-smooth contact
//! dynamics).

use sincro_math::Real;

use super::active_set::ContactProblem;
use super::cone::{ContactMode, FrictionGroup, UnilateralConstraint};
use super::solver::{norm, pair};

/// Share of the friction limit beyond which a group slips.
const AT_LIMIT: f64 = 1.0 - 1e-7;

/// Makes `sweeps` over all rows, from λ and its rates w = G λ + b; then sets the modes that λ implies.
pub(crate) fn sweep<R: Real>(
    problem: &ContactProblem<'_, R>,
    sweeps: usize,
    blocks: &mut [UnilateralConstraint<R>],
    (lambda, rates): (&mut [R], &mut [R]),
) {
    for _ in 0..sweeps {
        for i in 0..problem.n_free {
            relax(problem, i, |free| free, (lambda, rates));
        }
        for block in blocks.iter() {
            match block.given {
                Some(force) => set(problem, block.row, force.lane(0), (lambda, rates)),
                None => relax(problem, block.row, |free| free.max(0.0), (lambda, rates)),
            }
            let normal = lambda[block.row].lane(0).max(0.0);
            for group in block.groups.iter().flatten() {
                relax_friction(problem, group, normal, (lambda, rates));
            }
        }
    }
    for block in blocks.iter_mut() {
        let normal = lambda[block.row].lane(0);
        block.open = block.given.is_none() && normal <= 0.0;
        for group in block.groups.iter_mut().flatten().filter(|group| !group.is_sliding) {
            let force = pair(group, lambda);
            let size = norm(force);
            if size > AT_LIMIT * group.coefficient * normal && size > 0.0 {
                group.slip(force.map(|x| R::splat(x / size)), None);
            } else {
                group.stick();
            }
        }
    }
}

/// Sets the multiplier of a row to what `admits` makes of the one that would bring its rate to zero.
fn relax<R: Real>(
    problem: &ContactProblem<'_, R>,
    i: usize,
    admits: impl Fn(f64) -> f64,
    (lambda, rates): (&mut [R], &mut [R]),
) {
    let diagonal = problem.a[i * problem.m() + i].lane(0);
    if diagonal > 0.0 {
        let free = lambda[i].lane(0) - rates[i].lane(0) / diagonal;
        set(problem, i, admits(free), (lambda, rates));
    }
}

/// Friction of a group within its disc; of one that slides, against its velocity.
fn relax_friction<R: Real>(
    problem: &ContactProblem<'_, R>,
    group: &FrictionGroup<R>,
    normal: f64,
    (lambda, rates): (&mut [R], &mut [R]),
) {
    let (m, limit) = (problem.m(), group.coefficient * normal);
    let mut force = [0.0; 2];
    if group.is_sliding && group.mode == ContactMode::Slip {
        force = group.direction.map(|d| limit * d.lane(0));
    } else {
        let stiffest = (0..group.dim).map(|k| problem.a[(group.row + k) * (m + 1)].lane(0)).sum::<f64>();
        if stiffest > 0.0 {
            let (now, rate) = (pair(group, lambda), pair(group, rates));
            force = std::array::from_fn(|k| now[k] - rate[k] / stiffest);
            let size = norm(force);
            if size > limit {
                force = force.map(|x| x * limit / size);
            }
        }
    }
    for (k, force) in force.into_iter().enumerate().take(group.dim) {
        set(problem, group.row + k, force, (lambda, rates));
    }
}

fn set<R: Real>(problem: &ContactProblem<'_, R>, i: usize, force: f64, (lambda, rates): (&mut [R], &mut [R])) {
    let (m, change) = (problem.m(), R::splat(force) - lambda[i]);
    if change == R::zero() {
        return;
    }
    lambda[i] = R::splat(force);
    // G is symmetric: its columns are its rows
    for (rate, a) in rates.iter_mut().zip(&problem.a[i * m..(i + 1) * m]) {
        *rate += *a * change;
    }
}
