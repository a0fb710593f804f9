//! Projected Gauss–Seidel for the contact problem, contact by contact: slow, but it needs neither an active set nor a
//! convex problem. Used where both [`super::solver`]'s iterations fail. Source: key `jean1999` (non-smooth contact
//! dynamics).

use sincro_math::Real;

use super::active_set::ContactProblem;
use super::cone::{ContactMode, FrictionGroup, UnilateralConstraint};
use super::solver::{norm, pair};
use super::sweeps::local::ContactLocal;

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
        relax_free(problem, (lambda, rates));
        blocks.iter().for_each(|block| relax_block(problem, block, (lambda, rates)));
    }
    blocks.iter_mut().for_each(|block| imply_modes(block, lambda));
}

/// As [`sweep`], with the forces of each contact that sticks or slips found together and exactly: where one force on it
/// hardly accelerates it, one after the other they come nowhere.
pub(crate) fn sweep_contacts<R: Real>(
    problem: &ContactProblem<'_, R>,
    sweeps: usize,
    (blocks, locals): (&mut [UnilateralConstraint<R>], &mut [LocalProblem]),
    (lambda, rates): (&mut [R], &mut [R]),
) {
    for _ in 0..sweeps {
        relax_free(problem, (lambda, rates));
        for (block, local) in blocks.iter().zip(&mut *locals) {
            let (Some((local, rows)), Some(group)) = (local, &block.groups[0]) else {
                relax_block(problem, block, (lambda, rates));
                continue;
            };
            let [force, rate] = [&*lambda, &*rates].map(|list| rows.map(|row| list[row].lane(0)));
            let force = local.solve(group.coefficient, force, rate);
            rows.iter().zip(force).for_each(|(row, force)| set(problem, *row, force, (lambda, rates)));
        }
    }
    blocks.iter_mut().for_each(|block| imply_modes(block, lambda));
}

/// The problem of a contact with sliding friction in two directions and its rows; none of other constraints.
pub(crate) type LocalProblem = Option<(ContactLocal, [usize; 3])>;

/// The problem of one constraint, all other forces given.
pub(crate) fn local_problem<R: Real>(problem: &ContactProblem<'_, R>, block: &UnilateralConstraint<R>) -> LocalProblem {
    let [Some(group), None, None] = &block.groups else { return None };
    if block.given.is_some() || group.is_sliding || group.dim != 2 {
        return None;
    }
    let rows = [block.row, group.row, group.row + 1];
    let g = [(0, 0), (0, 1), (0, 2), (1, 1), (1, 2), (2, 2)];
    let g = g.map(|(i, j)| problem.a[rows[i] * problem.m() + rows[j]].lane(0));
    (g[0] + g[3] + g[5] > 0.0).then(|| (ContactLocal::new(g), rows))
}

/// Brings the rates of the rows without bounds to zero, one after the other.
fn relax_free<R: Real>(problem: &ContactProblem<'_, R>, (lambda, rates): (&mut [R], &mut [R])) {
    for i in 0..problem.n_free {
        relax(problem, i, |free| free, (lambda, rates));
    }
}

/// Relaxes the rows of a constraint, one after the other.
fn relax_block<R: Real>(
    problem: &ContactProblem<'_, R>,
    block: &UnilateralConstraint<R>,
    (lambda, rates): (&mut [R], &mut [R]),
) {
    match block.given {
        Some(force) => set(problem, block.row, force.lane(0), (lambda, rates)),
        None => relax(problem, block.row, |free| free.max(0.0), (lambda, rates)),
    }
    let normal = lambda[block.row].lane(0).max(0.0);
    for group in block.groups.iter().flatten() {
        relax_friction(problem, group, normal, (lambda, rates));
    }
}

/// Sets the modes of a constraint that λ implies.
fn imply_modes<R: Real>(block: &mut UnilateralConstraint<R>, lambda: &[R]) {
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
