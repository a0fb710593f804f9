//! The laws of contact, checked on the solver's results for random problems of every kind.

use super::active_set::ContactProblem;
use super::cone::{ContactMode, FrictionGroup, SlowSliding, UnilateralConstraint};
use super::held::{ConstraintId, Load};
use super::solver::Solver;

/// Numbers between −1 and 1, always the same.
struct Numbers(u64);

impl Numbers {
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        ((self.0 >> 11) as f64) / (1u64 << 52) as f64 - 1.0
    }
}

/// A = U Uᵀ of `m` rows over `n` degrees of freedom: redundant if m > n.
fn products(numbers: &mut Numbers, m: usize, n: usize) -> Vec<f64> {
    let u: Vec<f64> = (0..m * n).map(|_| numbers.next()).collect();
    let entry = |i: usize, j: usize| (0..n).map(|k| u[i * n + k] * u[j * n + k]).sum();
    (0..m * m).map(|k| entry(k / m, k % m)).collect()
}

fn contacts(count: usize, n_free: usize, friction: f64) -> Vec<UnilateralConstraint<f64>> {
    let tangents = |row: usize| FrictionGroup {
        row,
        dim: 2,
        coefficient: friction,
        slack: 1.0,
        is_sliding: false,
        mode: ContactMode::Stick,
        direction: [0.0; 2],
        compliance: None,
        slow_sliding: SlowSliding::default(),
    };
    let block = |k: usize| {
        let row = n_free + 3 * k;
        UnilateralConstraint {
            slot: k,
            row,
            open: false,
            given: None,
            is_compliant: false,
            groups: [Some(tangents(row + 1)), None, None],
        }
    };
    (0..count).map(block).collect()
}

/// Complementarity residual relative to the largest force and rate.
fn residual(problem: &ContactProblem<'_, f64>, blocks: &[UnilateralConstraint<f64>], lambda: &[f64]) -> f64 {
    let m = lambda.len();
    let w: Vec<f64> =
        (0..m).map(|i| problem.b[i] + (0..m).map(|j| problem.a[i * m + j] * lambda[j]).sum::<f64>()).collect();
    let (force, rate) = (
        lambda.iter().fold(1e-300, |s: f64, x| s.max(x.abs())),
        problem.b.iter().fold(0.0, |s: f64, x| s.max(x.abs())),
    );
    let mut worst = w[..problem.n_free].iter().fold(0.0, |s: f64, x| s.max(x.abs() / rate));
    for block in blocks {
        let (normal, leaving) = (lambda[block.row] / force, w[block.row] / rate);
        worst = worst.max(-normal).max(-leaving).max(normal.min(leaving).abs());
        let g = block.groups[0].as_ref().unwrap();
        let (t, v) = ([lambda[g.row], lambda[g.row + 1]], [w[g.row], w[g.row + 1]]);
        let (size, speed) = ((t[0] * t[0] + t[1] * t[1]).sqrt(), (v[0] * v[0] + v[1] * v[1]).sqrt());
        let limit = g.coefficient * lambda[block.row];
        worst = worst.max((size - limit) / force);
        if speed > 1e-7 * rate {
            // what slips meets all of friction, straight against it
            worst = worst.max((t[0] * v[0] + t[1] * v[1] + limit * speed).abs() / (force * speed));
        }
    }
    worst
}

fn solve(numbers: &mut Numbers, count: usize, n: usize, n_free: usize, friction: f64) -> (f64, u64) {
    let m = n_free + 3 * count;
    let a = products(numbers, m, n);
    // rates that motions have: in the range of U, so that there is a solution
    let push: Vec<f64> = (0..m).map(|_| numbers.next()).collect();
    let b: Vec<f64> = (0..m).map(|i| (0..m).map(|j| a[i * m + j] * push[j]).sum()).collect();
    let mut blocks = contacts(count, n_free, friction);
    let problem = ContactProblem { a: &a, b: &b, n_free };
    let (mut solver, mut lambda) = (Solver::default(), vec![0.0; m]);
    solver.solve(&problem, &mut blocks, &mut lambda);
    (residual(&problem, &blocks, &lambda), solver.report.not_converged)
}

#[test]
fn contacts_that_determine_their_forces_obey_the_laws() {
    let mut numbers = Numbers(7);
    for k in 0..300 {
        let (worst, unsolved) = solve(&mut numbers, 1 + k % 5, 20, k % 3, 0.1 + 0.3 * (k % 4) as f64);
        assert_eq!(unsolved, 0, "problem {k}");
        assert!(worst < 1e-7, "problem {k}: {worst:e}");
    }
}

/// The tip of an arm that one force on it hardly accelerates (by 2e-6, others by 1 and 11 1/kg), which slips next to
/// nothing under it: sticking takes a force 3e-5 beyond the cone.
#[test]
fn a_contact_that_a_force_hardly_accelerates_slips_slowly() {
    let a = [
        [0.5530714844569221, 0.5683970642269698, -0.18585274795015877],
        [0.5683970642269698, 2.376301462443709, 3.9714212077376616],
        [-0.18585274795015877, 3.9714212077376616, 9.730045785102392],
    ];
    let b = [-3.07447339236395, -3.116427252756181, 1.1332634845043377];
    let mut numbers = Numbers(5);
    for k in 0..100 {
        // in other units and other tangents
        let (mass, angle) = (libm::exp(5.0 * numbers.next()), 3.0 * numbers.next());
        let (sin, cos) = if k == 0 { (0.0, 1.0) } else { (libm::sin(angle), libm::cos(angle)) };
        let turn = [[1.0, 0.0, 0.0], [0.0, cos, sin], [0.0, -sin, cos]];
        let product =
            |i: usize, j: usize| (0..9).map(|e| turn[i][e / 3] * a[e / 3][e % 3] * turn[j][e % 3]).sum::<f64>() / mass;
        let a: Vec<f64> = (0..9).map(|e| product(e / 3, e % 3)).collect();
        let b: Vec<f64> = (0..3).map(|i| (0..3).map(|j| turn[i][j] * b[j]).sum()).collect();
        let (problem, mut blocks) = (ContactProblem { a: &a, b: &b, n_free: 0 }, contacts(1, 0, 0.8));
        let (mut solver, mut lambda) = (Solver::default(), vec![0.0; 3]);
        solver.solve(&problem, &mut blocks, &mut lambda);
        assert_eq!(solver.report.not_converged, 0, "problem {k}: {:?}", solver.report);
        assert!(residual(&problem, &blocks, &lambda) < 1e-7, "problem {k}");
    }
}

#[test]
fn redundant_contacts_obey_them_too() {
    let mut numbers = Numbers(11);
    let mut unsolved = 0;
    for k in 0..200 {
        let (worst, not_converged) = solve(&mut numbers, 4 + k % 5, 6 + k % 4, 0, 0.2 + 0.2 * (k % 3) as f64);
        // Coulomb's law promises no solution here; what is not found is counted, never hidden
        unsolved += not_converged;
        assert!(not_converged > 0 || worst < 1e-7, "problem {k}: {worst:e}");
    }
    println!("{unsolved} of 200 problems not solved");
    assert!(unsolved <= 10, "{unsolved} of 200 problems not solved");
}

#[test]
fn where_everything_leaves_there_are_no_forces() {
    let mut numbers = Numbers(3);
    let m = 12;
    let a = products(&mut numbers, m, 9);
    let b: Vec<f64> = (0..m).map(|i| if i % 3 == 0 { 1.0 } else { numbers.next() }).collect();
    let mut blocks = contacts(4, 0, 0.7);
    let (mut solver, mut lambda) = (Solver::default(), vec![0.3; m]);
    solver.solve(&ContactProblem { a: &a, b: &b, n_free: 0 }, &mut blocks, &mut lambda);
    assert_eq!(solver.report.not_converged, 0);
    assert!(lambda.iter().all(|x| *x == 0.0), "{lambda:?}");
}

#[test]
fn sweeps_come_to_the_forces_of_the_active_set() {
    let mut numbers = Numbers(5);
    for k in 0..50 {
        let (count, n_free) = (1 + k % 4, k % 3);
        let m = n_free + 3 * count;
        let a = products(&mut numbers, m, 20);
        let b: Vec<f64> = (0..m).map(|_| numbers.next()).collect();
        let problem = ContactProblem { a: &a, b: &b, n_free };
        let mut blocks = contacts(count, n_free, 0.4);
        let (mut solver, mut lambda) = (Solver::default(), vec![0.0; m]);
        solver.solve(&problem, &mut blocks, &mut lambda);
        let (mut swept, mut rates) = (vec![0.0; m], b.clone());
        super::gauss_seidel::sweep(&problem, 20_000, &mut blocks, (&mut swept, &mut rates));
        let largest = lambda.iter().fold(0.0_f64, |s, x| s.max(x.abs()));
        let apart = lambda.iter().zip(&swept).fold(0.0_f64, |s, (x, y)| s.max((x - y).abs()));
        assert!(apart <= 1e-6 * largest, "problem {k}: {apart:e} of {largest:e}");
    }
}

/// Held modes are those that the complementarity problem decides, as long as they obey the laws; beyond that they go on
/// smoothly, and the law that they violate is named.
#[test]
fn held_modes_go_on_smoothly_beyond_the_laws() {
    // a contact that carries load until b passes zero, without friction
    let a = [2.0];
    let mut block = contacts(1, 0, 0.0);
    block[0].groups = [None; 3];
    let mut solver = Solver::default();
    for (b, force) in [(-1.0, 0.5), (1.0, -0.5)] {
        let problem = ContactProblem { a: &a, b: &[b], n_free: 0 };
        let mut lambda = [0.0];
        assert!(solver.hold(&problem, &mut block, &mut lambda, Load::Shared));
        assert!((lambda[0] - force).abs() < 1e-15);
        let violated = solver.worst_law(&problem, &block, &lambda);
        assert_eq!(violated, (force < 0.0).then_some(super::HeldLaw::Unilateral(ConstraintId::of(&block, 0))));
        if let Some(law) = violated {
            assert!(solver.excess(law, &problem, &block, &lambda) > 0.9);
        }
    }
}

/// A law is that of its constraint, also where another one before it is in the list no more.
#[test]
fn a_law_stays_with_its_constraint_when_another_one_leaves() {
    // three contacts beside each other; the middle one pulls
    let (a, b) = ([2.0, 0.0, 0.0, 0.0, 2.0, 0.0, 0.0, 0.0, 2.0], [-1.0, 1.0, -1.0]);
    let without_friction = |rows: &[usize]| {
        let mut blocks: Vec<_> = contacts(3, 0, 0.0);
        for (k, block) in blocks.iter_mut().enumerate() {
            (block.slot, block.row, block.groups) = (10 + k, k, [None; 3]);
        }
        let mut kept: Vec<_> = rows.iter().map(|k| blocks[*k]).collect();
        kept.iter_mut().enumerate().for_each(|(row, block)| block.row = row);
        kept
    };
    let mut solver = Solver::default();
    let (mut blocks, mut lambda) = (without_friction(&[0, 1, 2]), vec![0.0; 3]);
    let problem = ContactProblem { a: &a, b: &b, n_free: 0 };
    assert!(solver.hold(&problem, &mut blocks, &mut lambda, Load::Shared));
    let law = solver.worst_law(&problem, &blocks, &lambda).unwrap();
    assert_eq!(law, super::HeldLaw::Unilateral(ConstraintId::of(&blocks, 1)));
    let excess = solver.excess(law, &problem, &blocks, &lambda);
    assert!(excess > 0.9);
    // the first one has left: the law is still that of the second, at another place
    let (mut fewer, mut lambda) = (without_friction(&[1, 2]), vec![0.0; 2]);
    let (a, b) = ([2.0, 0.0, 0.0, 2.0], [1.0, -1.0]);
    let problem = ContactProblem { a: &a, b: &b, n_free: 0 };
    assert!(solver.hold(&problem, &mut fewer, &mut lambda, Load::Shared));
    assert!((solver.excess(law, &problem, &fewer, &lambda) - excess).abs() < 1e-12);
    // it has left itself: it obeys its law
    let (mut last, mut lambda) = (without_friction(&[2]), vec![0.0; 1]);
    let problem = ContactProblem { a: &[2.0], b: &[-1.0], n_free: 0 };
    assert!(solver.hold(&problem, &mut last, &mut lambda, Load::Shared));
    assert!((solver.excess(law, &problem, &last, &lambda) + 1.0).abs() < 1e-15);
}

/// Four legs at the corners of a square share a load at (x, y) as springs of equal stiffness do, whatever the forces
/// were before: (1 ± x ± y)/4.
#[test]
fn four_legs_share_a_load_as_springs_do() {
    let corners = [[1.0, 1.0], [-1.0, 1.0], [-1.0, -1.0], [1.0, -1.0]];
    // heave, roll and pitch of a plate of mass 1 with both moments of inertia 1
    let a: Vec<f64> = (0..16)
        .map(|k| (corners[k / 4], corners[k % 4]))
        .map(|(one, two)| 1.0 + one[0] * two[0] + one[1] * two[1])
        .collect();
    let (x, y) = (0.3, -0.2);
    let b: Vec<f64> = corners.iter().map(|c| -(1.0 + x * c[0] + y * c[1])).collect();
    let problem = ContactProblem { a: &a, b: &b, n_free: 0 };
    for before in [[0.0; 4], [0.9, 0.0, 0.4, 0.0]] {
        let mut legs: Vec<_> = (0..4)
            .map(|k| UnilateralConstraint { slot: k, row: k, groups: [None; 3], ..contacts(1, 0, 0.0)[0] })
            .collect();
        legs.iter_mut().zip(before).for_each(|(leg, force)| leg.open = force == 0.0);
        let (mut solver, mut lambda) = (Solver::default(), before);
        solver.solve(&problem, &mut legs, &mut lambda);
        for (force, c) in lambda.iter().zip(corners) {
            let expected = (1.0 + x * c[0] + y * c[1]) / 4.0;
            assert!((force - expected).abs() < 1e-14, "{lambda:?}");
        }
    }
}

/// The share of redundant contacts that stick does not depend on the order of contacts, the tangents, the unit of
/// force, or the warm start.
#[test]
fn redundant_contacts_share_the_load_the_same_in_every_frame() {
    let mut numbers = Numbers(17);
    let mut compared = 0;
    for k in 0..60 {
        let (count, n) = (3 + k % 4, 6 + k % 3);
        let m = 3 * count;
        let a = products(&mut numbers, m, n);
        let push: Vec<f64> = (0..m).map(|i| if i % 3 == 0 { -1.0 } else { 0.2 * numbers.next() }).collect();
        let b: Vec<f64> = (0..m).map(|i| (0..m).map(|j| a[i * m + j] * push[j]).sum()).collect();
        let angles: Vec<f64> = (0..count).map(|_| 3.0 * numbers.next()).collect();
        // row i of the other frame: coefficients on the rows of this one
        let rows: Vec<Vec<(usize, f64)>> = (0..m)
            .map(|i| {
                let contact = count - 1 - i / 3;
                let (sin, cos) = (libm::sin(angles[contact]), libm::cos(angles[contact]));
                let tangents = [3 * contact + 1, 3 * contact + 2];
                match i % 3 {
                    0 => vec![(3 * contact, 1.0)],
                    1 => vec![(tangents[0], cos), (tangents[1], sin)],
                    _ => vec![(tangents[0], -sin), (tangents[1], cos)],
                }
            })
            .collect();
        let turned = |x: &dyn Fn(usize) -> f64, i: usize| rows[i].iter().map(|(j, c)| c * x(*j)).sum::<f64>();
        let a_turned: Vec<f64> = (0..m * m).map(|e| turned(&|i| turned(&|j| a[i * m + j], e % m), e / m)).collect();
        let b_turned: Vec<f64> = (0..m).map(|i| turned(&|j| b[j], i)).collect();
        let found = |a: &[f64], b: &[f64], start: f64| {
            let problem = ContactProblem { a, b, n_free: 0 };
            let (mut solver, mut lambda) = (Solver::default(), vec![start; m]);
            solver.solve(&problem, &mut contacts(count, 0, 2.0), &mut lambda);
            (solver.report.not_converged == 0 && solver.report.split == 0).then_some(lambda)
        };
        if let (Some(one), Some(two)) = (found(&a, &b, 0.0), found(&a_turned, &b_turned, 0.1)) {
            let largest = one.iter().fold(0.0_f64, |s, x| s.max(x.abs()));
            let apart = (0..m).map(|i| (turned(&|j| one[j], i) - two[i]).abs()).fold(0.0, f64::max);
            assert!(apart < 1e-8 * largest, "problem {k}: {apart:e} of {largest:e}");
            compared += 1;
        }
    }
    assert!(compared >= 50, "{compared} of 60 compared");
}

#[test]
fn sliding_that_presses_itself_down_has_two_solutions() {
    // wₙ = (1 − 0.9 μ) λₙ + bₙ of a contact that slides (Painlevé): with μ = 2 and bₙ = 0.4 both λₙ = 0 and λₙ = 0.5
    let a = [1.0, 0.9, 0.0, 0.9, 1.0, 0.0, 0.0, 0.0, 1.0];
    for (friction, b, several) in [(2.0, 0.4, true), (0.5, 0.4, false), (0.5, -0.4, false)] {
        let b = [b, 0.0, 0.0];
        let problem = ContactProblem { a: &a, b: &b, n_free: 0 };
        let mut blocks = contacts(1, 0, friction);
        let group = blocks[0].groups[0].as_mut().unwrap();
        group.is_sliding = true;
        group.slip([-1.0, 0.0], None);
        let (mut solver, mut lambda) = (Solver::default(), vec![0.0; 3]);
        solver.solve(&problem, &mut blocks, &mut lambda);
        let found = lambda.clone();
        assert_eq!(solver.has_other_solution(&problem, false, &mut blocks, &mut lambda), several, "{friction} {b:?}");
        assert_eq!(lambda, found);
    }
}

#[test]
fn redundant_contacts_without_slip_have_one_motion() {
    // a plate at rest on 4 to 8 legs: loads are not determined, accelerations are
    let mut numbers = Numbers(31);
    for k in 0..50 {
        let (count, n) = (4 + k % 5, 6);
        let a = products(&mut numbers, 3 * count, n);
        let push: Vec<f64> = (0..3 * count).map(|i| if i % 3 == 0 { -1.0 } else { 0.0 }).collect();
        let b: Vec<f64> =
            (0..3 * count).map(|i| (0..3 * count).map(|j| a[i * 3 * count + j] * push[j]).sum()).collect();
        let mut blocks = contacts(count, 0, 1.5);
        let problem = ContactProblem { a: &a, b: &b, n_free: 0 };
        let (mut solver, mut lambda) = (Solver::default(), vec![0.0; 3 * count]);
        solver.solve(&problem, &mut blocks, &mut lambda);
        if solver.report.not_converged == 0
            && blocks.iter().all(|block| !block.open && block.groups[0].unwrap().mode == ContactMode::Stick)
        {
            assert!(!solver.has_other_solution(&problem, false, &mut blocks, &mut lambda), "problem {k}");
        }
    }
}

/// A wheel that stands on a corner which sticks and turns about it, so that its other corner slides: the share of the
/// load between the corners decides what friction the first one needs. It has four motions, x, y, z and the turn, and
/// is pushed along x and y.
fn pivoting_wheel(push: [f64; 2]) -> (Vec<f64>, Vec<f64>, Vec<UnilateralConstraint<f64>>) {
    let (mass, moment, arm) = (2.0, 0.03, 0.05);
    // normal, then two tangents of each corner
    let rows: [[f64; 4]; 6] = [
        [0.0, 0.0, 1.0, 0.0],
        [1.0, 0.0, 0.0, 0.0],
        [0.0, 1.0, 0.0, 0.0],
        [0.0, 0.0, 1.0, 0.0],
        // its first tangent is the direction in which it slides
        [0.0, 1.0, 0.0, arm],
        [1.0, 0.0, 0.0, 0.0],
    ];
    let inverse = [1.0 / mass, 1.0 / mass, 1.0 / mass, 1.0 / moment];
    let entry = |i: usize, j: usize| (0..4).map(|k| rows[i][k] * inverse[k] * rows[j][k]).sum::<f64>();
    let a = (0..36).map(|k| entry(k / 6, k % 6)).collect();
    let free = [push[0] / mass, push[1] / mass, -9.81, 0.0];
    let b = rows.iter().map(|row| row.iter().zip(&free).map(|(x, y)| x * y).sum()).collect();
    let mut blocks = contacts(2, 0, 0.8);
    let sliding = blocks[1].groups[0].as_mut().unwrap();
    sliding.is_sliding = true;
    sliding.slip([-1.0, 0.0], None);
    (a, b, blocks)
}

#[test]
fn the_load_shifts_before_friction_that_holds_alone_is_beyond_its_limit() {
    // pushes in units of weight, each within what some share can hold
    let weight = 2.0 * 9.81;
    for push in [[0.0, 0.3], [0.41, 0.4], [0.45, 0.45], [-0.5, 0.5], [0.3, -0.1]] {
        let (a, b, mut blocks) = pivoting_wheel(push.map(|x: f64| x * weight));
        let problem = ContactProblem { a: &a, b: &b, n_free: 0 };
        let (mut solver, mut lambda) = (Solver::default(), vec![0.0; 6]);
        solver.solve(&problem, &mut blocks, &mut lambda);
        assert_eq!(solver.report.not_converged, 0, "{push:?}");
        let first = blocks[0].groups[0].as_ref().unwrap();
        assert_eq!(first.mode, ContactMode::Stick, "{push:?}: {lambda:?}");
        // friction is what balance asks for, and within its limit: at it, where an equal share would need more
        let share = lambda[0] / weight;
        let needed = |share: f64| f64::hypot(push[0], push[1] - 0.8 * (1.0 - share));
        let friction = f64::hypot(lambda[1], lambda[2]) / weight;
        assert!((lambda[0] + lambda[3] - weight).abs() < 1e-9 * weight, "{push:?}: {lambda:?}");
        assert!((friction - needed(share)).abs() < 1e-9, "{push:?}: {friction}, {share}");
        if needed(0.5) > 0.8 * 0.5 {
            assert!((friction - 0.8 * share).abs() < 1e-9, "{push:?}: {friction}, {share}");
        } else {
            assert!((share - 0.5).abs() < 1e-9, "{push:?}: {share}");
        }
        // the same modes give the same forces, from wherever they start
        lambda.iter_mut().for_each(|x| *x *= 1.7);
        assert!(solver.hold(&problem, &mut blocks, &mut lambda, Load::Shared), "{push:?}");
        assert_eq!(solver.worst_law(&problem, &blocks, &lambda), None, "{push:?}: {lambda:?}");
        assert!((lambda[0] / weight - share).abs() < 1e-9, "{push:?}: {lambda:?}, {share}");
    }
}

/// A load that is kept makes the same motion, and is shared afterwards as if it had been at once.
#[test]
fn a_kept_load_moves_as_a_shared_one() {
    let mut numbers = Numbers(11);
    for _ in 0..50 {
        let m = 12;
        let a = products(&mut numbers, m, 6);
        // the rates of a body that moves: redundant rows agree
        let forces: Vec<f64> = (0..m).map(|_| numbers.next()).collect();
        let b: Vec<f64> = (0..m).map(|i| (0..m).map(|k| a[i * m + k] * forces[k]).sum()).collect();
        let problem = ContactProblem { a: &a, b: &b, n_free: 0 };
        let mut solver = Solver::default();
        let start: Vec<f64> = (0..m).map(|_| numbers.next()).collect();
        let mut find = |load| {
            let (mut blocks, mut lambda) = (contacts(4, 0, 0.5), start.clone());
            assert!(solver.hold(&problem, &mut blocks, &mut lambda, load));
            let rates = solver.rates().to_vec();
            let kept = lambda.clone();
            let is_shared = load == Load::Kept && solver.share_kept_load(&problem, &blocks, &mut lambda);
            (rates, kept, lambda, is_shared)
        };
        let (shared, kept) = (find(Load::Shared), find(Load::Kept));
        let distance = |x: &[f64], y: &[f64]| x.iter().zip(y).fold(0.0_f64, |s, (x, y)| s.max((x - y).abs()));
        assert!(kept.3 && distance(&shared.0, &kept.0) < 1e-9);
        assert!(distance(&shared.1, &kept.1) > 1e-3, "the load was kept");
        assert!(distance(&shared.2, &kept.2) < 1e-7 * (1.0 + shared.2.iter().fold(0.0_f64, |s, x| s.max(x.abs()))));
    }
}

/// A limited drive on `row` + 1, under a given normal force on `row` as sincro-dynamics poses it.
fn drive(row: usize, limit: f64) -> UnilateralConstraint<f64> {
    const NORMAL: f64 = 1.0 / (1_u128 << 100) as f64;
    UnilateralConstraint {
        given: Some(NORMAL),
        ..UnilateralConstraint::contact(
            crate::NO_SLOT,
            row,
            [Some(FrictionGroup::sticking(row + 1, 1, limit / NORMAL)), None, None],
        )
    }
}

#[test]
fn problems_without_a_solution_leave_finite_forces() {
    let mut numbers = Numbers(11);
    let mut unsolved = 0;
    for draw in 0..2000 {
        // contacts that slide under friction so large that there need be no forces (Painlevé), beside drives
        let (sliding, drives) = (1 + draw % 3, draw % 4);
        let m = 3 * sliding + 2 * drives;
        let mut a = products(&mut numbers, m, 2 + m / 3);
        let mut b: Vec<f64> = (0..m).map(|_| numbers.next()).collect();
        let mut blocks = contacts(sliding, 0, 2.0);
        for group in blocks.iter_mut().flat_map(|block| block.groups.iter_mut().flatten()) {
            group.is_sliding = true;
            group.slip([-1.0, 0.0], None);
        }
        let mut lambda = vec![0.0; m];
        for k in 0..drives {
            let row = 3 * sliding + 2 * k;
            blocks.push(drive(row, numbers.next().abs()));
            for i in 0..m {
                (a[row * m + i], a[i * m + row]) = (0.0, 0.0);
            }
            (b[row], lambda[row]) = (0.0, 1.0 / (1_u128 << 100) as f64);
        }
        let mut solver = Solver::default();
        solver.solve(&ContactProblem { a: &a, b: &b, n_free: 0 }, &mut blocks, &mut lambda);
        unsolved += solver.report.not_converged;
        assert!(lambda.iter().all(|force| force.is_finite()), "draw {draw}: {lambda:?}");
    }
    assert!(unsolved > 20, "{unsolved} without a solution");
}
