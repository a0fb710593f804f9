//! Reduction to independent coordinates at an operating point.
//!
//! Equations g(q) = 0 (loops, gears, pressing limits, closed contacts, what friction holds) and W(q) v = u (their
//! rates, rolling without slipping, velocity motors) leave a manifold of states. Its tangent space is spanned by T, one
//! column for each independent coordinate and speed: with selection P (P T = 1) the linear system is
//!
//! A = P · Df · T, C = Dh · T,
//!
//! exact, by dual numbers along the columns of T; no second derivative of the manifold enters, since P is constant.
//! The number of speeds is n − rank W, the number of coordinates n − rank of the holonomic rows: of a rolling wheel all
//! coordinates remain.
//!
//! **Choice.** With M = L Lᵀ, rank and null space are those of W L⁻ᵀ (pivoted Gram–Schmidt elimination). Independent is
//! a coordinate whose mobility under the equations is large beside its mobility without them, √((M_c⁻¹)ₖₖ/(M⁻¹)ₖₖ): the
//! first one, in the order of the scene, of at least half the largest such number; the next ones after elimination of
//! those before. Neither rank nor choice depends on units. Sources: keys `golub2013` (5.4), `featherstone2008` (8).
//!
//! **Velocity motors.** The velocity u of an ideal motor is an input. A step of it makes all speeds jump by V u, with V
//! the response to a unit impulse of its joint at rest forces: v = T_v w + V u. The speeds w do not jump, their rate
//! does not depend on u̇, and V is the direct feedthrough of velocities.
//!
//! | symbol | meaning | shape |
//! |---|---|---|
//! | W, `rate_by_v` | rows of all equations by speeds | m × n |
//! | `rate_by_q` | derivatives of their rates by coordinates | m × n |
//! | T, `columns` | tangent vectors: full states and inputs | one a column |

use nalgebra::linalg::Cholesky;
use sincro_dynamics::constraint::ActiveSource;
use sincro_dynamics::crba::mass_matrix;
use sincro_dynamics::model::Model;
use sincro_dynamics::scratch::Scratch;
use sincro_math::Dual;

use super::lens::{EquationSource, Evaluation, Lens};
use super::names::InputKind;
use crate::linear::DMatrix;

/// Remainder of an independent row relative to the largest row of the same source.
const INDEPENDENT: f64 = 1e-9;

/// Share of the largest mobility from which the first coordinate in the order of the scene is taken.
const PREFERRED: f64 = 0.5;

/// Equations at a state, with their derivatives.
pub(super) struct Equations {
    pub sources: Vec<EquationSource>,
    pub is_holonomic: Vec<bool>,
    /// Position residuals; zero of nonholonomic equations.
    pub residual: Vec<f64>,
    /// Velocity residuals.
    pub rate: Vec<f64>,
    pub rate_by_v: DMatrix<f64>,
    pub rate_by_q: DMatrix<f64>,
    /// By the inputs.
    pub rate_by_input: DMatrix<f64>,
}

impl Equations {
    /// Evaluates the equations and their derivatives.
    pub fn of(lens: &mut Lens<Dual<1>>) -> Self {
        let (n_v, n_full, n_inputs) = (lens.n_v(), lens.n_full(), lens.n_inputs());
        let mut direction = vec![0.0; n_full + n_inputs];
        let at = lens.along(&direction);
        let m = at.equations.len();
        let mut new = Self {
            sources: at.equations.iter().map(|e| e.source).collect(),
            is_holonomic: at.equations.iter().map(|e| e.residual.is_some()).collect(),
            residual: at.equations.iter().map(|e| e.residual.map_or(0.0, |r| r.value)).collect(),
            rate: at.equations.iter().map(|e| e.rate.value).collect(),
            rate_by_v: DMatrix::zeros(m, n_v),
            rate_by_q: DMatrix::zeros(m, n_v),
            rate_by_input: DMatrix::zeros(m, n_inputs),
        };
        if m == 0 {
            return new;
        }
        for k in (0..2 * n_v).chain(n_full..n_full + n_inputs) {
            direction[k] = 1.0;
            let found: Evaluation<Dual<1>> = lens.along(&direction);
            direction[k] = 0.0;
            debug_assert_eq!(found.equations.len(), m, "modes do not depend on derivatives");
            let (into, column) = match k {
                k if k < n_v => (&mut new.rate_by_q, k),
                k if k < 2 * n_v => (&mut new.rate_by_v, k - n_v),
                k => (&mut new.rate_by_input, k - n_full),
            };
            for (row, equation) in found.equations.iter().enumerate() {
                into[(row, column)] = equation.rate.partials[0];
            }
        }
        new
    }

    /// Rows that are used, of those chosen by `wanted`: an independent set and an orthonormal basis of W L⁻ᵀ.
    fn independent(&self, inverse_root: &DMatrix<f64>, wanted: impl Fn(usize) -> bool) -> (Vec<usize>, DMatrix<f64>) {
        let n = self.rate_by_v.ncols();
        let mut rows = &self.rate_by_v * inverse_root;
        let m = rows.nrows();
        let norm: Vec<f64> = (0..m).map(|i| rows.row(i).norm()).collect();
        let size = |i: usize| {
            let same = (0..m).filter(|&j| self.same_element(i, j));
            same.map(|j| norm[j]).fold(0.0, f64::max)
        };
        let sizes: Vec<f64> = (0..m).map(size).collect();
        let mut chosen = Vec::new();
        let mut basis = DMatrix::zeros(n, 0);
        while chosen.len() < n {
            let share = |i: usize| rows.row(i).norm() / sizes[i];
            let left = (0..m).filter(|i| wanted(*i) && !chosen.contains(i) && sizes[*i] > 0.0);
            let Some(best) = left.reduce(|a, b| if share(b) > share(a) * (1.0 + 1e-12) { b } else { a }) else { break };
            if share(best) <= INDEPENDENT {
                break;
            }
            let unit = rows.row(best).transpose() / rows.row(best).norm();
            eliminate(&mut rows, &unit);
            let at = basis.ncols();
            basis = basis.insert_column(at, 0.0);
            basis.set_column(at, &unit);
            chosen.push(best);
        }
        chosen.sort_unstable();
        (chosen, basis)
    }

    /// Independent holonomic equations.
    pub fn holonomic_rows(&self, metric: &Metric) -> Vec<usize> {
        self.independent(&metric.inverse_root, |i| self.is_holonomic[i]).0
    }

    /// Returns true if two rows belong to one loop joint, one contact or one drive.
    fn same_element(&self, i: usize, j: usize) -> bool {
        use ActiveSource::{Contact, StickingFriction};
        let pair = |source: EquationSource| match source {
            EquationSource::Constraint(Contact(pair) | StickingFriction(pair)) => Some(pair),
            _ => None,
        };
        let (a, b) = (self.sources[i], self.sources[j]);
        let of_loop = |source: EquationSource| {
            matches!(source, EquationSource::Constraint(ActiveSource::LoopJoint(_) | ActiveSource::Gear(_)))
        };
        // rows of loops are an independent set already, and of different units
        if of_loop(a) { i == j } else { a == b || (pair(a).is_some() && pair(a) == pair(b)) }
    }
}

/// Removes the component along a unit vector from all rows, twice: the second pass removes the rounding of the first.
fn eliminate(rows: &mut DMatrix<f64>, unit: &nalgebra::DVector<f64>) {
    for _ in 0..2 {
        let along = &*rows * unit;
        *rows -= along * unit.transpose();
    }
}

/// Independent coordinates and the tangent space of the manifold of states.
pub(super) struct Tangent {
    /// Full states that are states of the linear system: coordinates, speeds, states of rotors and diagram.
    pub states: Vec<usize>,
    /// Number of coordinates among them.
    pub n_positions: usize,
    /// Number of speeds among them.
    pub n_speeds: usize,
    /// Directions of the full states and inputs, one for each state and then for each input.
    pub columns: Vec<Vec<f64>>,
    /// Inputs with direct feedthrough in velocity, and the response of the outputs to their rate.
    pub improper: Vec<(usize, Vec<f64>)>,
    /// Rank of all equations, and of the holonomic ones.
    pub rank: (usize, usize),
}

impl Tangent {
    /// Chooses independent coordinates where `lens` is, and finds the tangent space.
    pub fn of(lens: &mut Lens<Dual<1>>, equations: &Equations, metric: &Metric, inputs: &[InputKind]) -> Self {
        let (n_v, n_full, n_inputs) = (lens.n_v(), lens.n_full(), lens.n_inputs());
        let (all, basis) = equations.independent(&metric.inverse_root, |_| true);
        let (holonomic, holonomic_basis) = equations.independent(&metric.inverse_root, |i| equations.is_holonomic[i]);
        let speeds = metric.independent(&basis, &[], n_v - all.len());
        let positions = metric.independent(&holonomic_basis, &speeds, n_v - holonomic.len());
        let solve_q = Elimination::new(&equations.rate_by_v, &holonomic, &positions);
        let solve_v = Elimination::new(&equations.rate_by_v, &all, &speeds);
        let mut columns = Vec::new();
        let zero = || vec![0.0; n_full + n_inputs];
        for &k in &positions {
            let mut column = zero();
            column[k] = 1.0;
            solve_q.complete(&mut column[..n_v], |_| 0.0);
            let q: Vec<f64> = column[..n_v].to_vec();
            let by_q = |row: usize| -> f64 {
                // the derivative of a rate along the displacement
                equations.rate_by_q.row(row).iter().zip(&q).map(|(w, q)| w * q).sum()
            };
            solve_v.complete(&mut column[n_v..2 * n_v], by_q);
            columns.push(column);
        }
        for &k in &speeds {
            let mut column = zero();
            column[n_v + k] = 1.0;
            solve_v.complete(&mut column[n_v..2 * n_v], |_| 0.0);
            columns.push(column);
        }
        for k in 2 * n_v..n_full {
            let mut column = zero();
            column[k] = 1.0;
            columns.push(column);
        }
        let mut improper = Vec::new();
        for input in 0..n_inputs {
            let (column, response) = input_column(lens, equations, input, inputs);
            columns.push(column);
            improper.extend(response.map(|response| (input, response)));
        }
        let (n_positions, n_speeds) = (positions.len(), speeds.len());
        let states = positions.into_iter().chain(speeds.into_iter().map(|k| n_v + k)).chain(2 * n_v..n_full).collect();
        Self { states, n_positions, n_speeds, columns, improper, rank: (all.len(), holonomic.len()) }
    }
}

/// Direction of the full states for an input: that of a locked motor moves all speeds at once. Second: the response of
/// the outputs to the rate of such an input.
fn input_column(
    lens: &mut Lens<Dual<1>>,
    equations: &Equations,
    input: usize,
    inputs: &[InputKind],
) -> (Vec<f64>, Option<Vec<f64>>) {
    let (n_v, n_full) = (lens.n_v(), lens.n_full());
    let mut column = vec![0.0; n_full + lens.n_inputs()];
    column[n_full + input] = 1.0;
    let mut by_rate: Option<Vec<f64>> = None;
    for lock in lens.locks().to_vec() {
        let row = equations.sources.iter().position(|source| *source == EquationSource::Drive(lock.drive));
        let gain = row.map_or(0.0, |row| -equations.rate_by_input[(row, input)]);
        if gain == 0.0 || !matches!(inputs[input], InputKind::Command(_)) {
            continue;
        }
        let (rates, outputs) = lens.response_to(lock.dof);
        for k in 0..n_v {
            column[n_v + k] += gain * rates[n_v + k];
        }
        let known = by_rate.get_or_insert_with(|| vec![0.0; outputs.len()]);
        known.iter_mut().zip(&outputs).for_each(|(sum, x)| *sum += gain * x);
    }
    (column, by_rate)
}

/// Solution of independent rows for the dependent coordinates.
struct Elimination {
    rows: Vec<usize>,
    dependent: Vec<usize>,
    matrix: DMatrix<f64>,
    factors: nalgebra::linalg::LU<f64, nalgebra::Dyn, nalgebra::Dyn>,
}

impl Elimination {
    fn new(w: &DMatrix<f64>, rows: &[usize], independent: &[usize]) -> Self {
        let dependent: Vec<usize> = (0..w.ncols()).filter(|k| !independent.contains(k)).collect();
        let square = DMatrix::from_fn(rows.len(), dependent.len(), |i, j| w[(rows[i], dependent[j])]);
        Self { rows: rows.to_vec(), dependent, matrix: w.clone(), factors: square.lu() }
    }

    /// Completes a vector, whose independent entries are given, so that W x = −`right`.
    fn complete(&self, x: &mut [f64], right: impl Fn(usize) -> f64) {
        if self.rows.is_empty() {
            return;
        }
        let of_row = |i: &usize| -> f64 {
            let given: f64 = self.matrix.row(*i).iter().zip(x.iter()).map(|(w, x)| w * x).sum();
            -(given + right(*i))
        };
        let b = nalgebra::DVector::from_iterator(self.rows.len(), self.rows.iter().map(of_row));
        if let Some(solution) = self.factors.solve(&b) {
            for (k, value) in self.dependent.iter().zip(solution.iter()) {
                x[*k] = *value;
            }
        }
    }
}

/// Metric of the mass matrix: L⁻ᵀ of M = L Lᵀ.
pub(super) struct Metric {
    pub inverse_root: DMatrix<f64>,
}

impl Metric {
    /// At coordinates `q`.
    pub fn of(model: &Model<f64>, q: &[f64]) -> Self {
        let n = model.n_v();
        let mut mass = vec![0.0; n * n];
        mass_matrix(model, q, &mut Scratch::new(model), &mut mass);
        let mut mass = DMatrix::from_row_slice(n, n, &mass);
        for (k, dof) in model.dofs().iter().enumerate() {
            mass[(k, k)] += dof.armature;
        }
        let identity = || DMatrix::identity(n, n);
        let inverse_root = Cholesky::new(mass)
            .and_then(|factor| factor.l().solve_lower_triangular(&identity()))
            .map_or_else(identity, |inverse| inverse.transpose());
        Self { inverse_root }
    }

    /// Chooses `wanted` independent coordinates beside those `given`, under equations whose rows span `basis`.
    fn independent(&self, basis: &DMatrix<f64>, given: &[usize], wanted: usize) -> Vec<usize> {
        let n = self.inverse_root.nrows();
        // rows of L⁻ᵀ, scaled to a mobility of 1 without the equations, in the null space of these
        let mut rows = self.inverse_root.clone();
        for mut row in rows.row_iter_mut() {
            let size = row.norm();
            row /= if size > 0.0 { size } else { 1.0 };
        }
        for unit in basis.column_iter() {
            eliminate(&mut rows, &unit.into_owned());
        }
        let mut chosen: Vec<usize> = Vec::new();
        let mut given = given.iter();
        while chosen.len() < wanted {
            let largest = (0..n).filter(|k| !chosen.contains(k)).map(|k| rows.row(k).norm()).fold(0.0, f64::max);
            let next = given
                .next()
                .copied()
                .or_else(|| (0..n).find(|k| !chosen.contains(k) && rows.row(*k).norm() >= PREFERRED * largest));
            let Some(next) = next.filter(|_| largest > 0.0) else { break };
            let unit = rows.row(next).transpose() / rows.row(next).norm();
            eliminate(&mut rows, &unit);
            chosen.push(next);
        }
        chosen.sort_unstable();
        chosen
    }
}
