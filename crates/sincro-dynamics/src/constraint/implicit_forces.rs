//! Forces along paths, between two points or of tendons, at the new state of a linearly implicit step.
//!
//! A spring and damper with stiffness k and damping c along the path with Jacobian j (one row, ℓ̇ = j v) gives at the
//! end of a step h the force F(x + h ℓ̇⁺, ℓ̇⁺) ≈ F + h (−k) ℓ̇ − κ ℓ̈, κ = h (c + h k), ℓ̈ = j v̇ + j̇ v. The last term
//! couples all degrees of freedom between the points (of an elastic gear, whose row is ẋ = q̇₂ − r q̇₁, its two); joint
//! springs are on the diagonal of the mass matrix only. A path of several lines has the sum of their rows, a linear
//! combination of joint coordinates that of rows of two joints each.
//! A bushing has six rows. Forces λ = −κ ℓ̈ of all m rows solve, with the rows scaled by √κ,
//!
//! (1 + Ĵ M⁻¹ Ĵᵀ) λ̂ = −(Ĵ v̇₀ + Ĵ˙ v), λ = √κ λ̂,
//!
//! where v̇₀ are the accelerations without them: the Woodbury identity for M + Jᵀ κ J. Constraint rows see that sum as
//! their mass matrix: G and b of the constraint problem are reduced by the Schur complement.
//!
//! | symbol here | meaning | shape |
//! |---|---|---|
//! | `rows`, `ends` | parts of the rows ℓ̇ = j v; where those of each path end | m |
//! | `scale` | √κ | m |
//! | `factors` | Ĵ M^(−1/2), one column a path | `n_v` × m |
//! | `lower` | Cholesky factor L of 1 + Ĵ M⁻¹ Ĵᵀ | m × m |
//! | `cross` | L⁻¹ Ĵ M⁻¹ J_cᵀ for constraint rows J_c | m × `n_rows` |
//! | `rates` | L⁻¹ (Ĵ v̇₀ + Ĵ˙ v) | m |

use sincro_math::Real;

use super::delassus::{Delassus, InverseMass};
use super::row::{Motions, Row, force_at, force_rate};
use crate::actuation::Bushing;
use crate::actuation::bushing::BushingMotion;
use crate::actuation::spring_damper::{JointShare, Line, PathLength, Segment};
use crate::joint::WORLD;
use crate::model::Model;
use crate::scratch::Scratch;
use crate::spatial::{Force, Vec3};

/// Forces along all paths at the new state, with working memory.
#[derive(Clone, Debug)]
pub(crate) struct ImplicitForces<R> {
    motions: Motions<R>,
    delassus: Delassus<R>,
    inverse_mass: InverseMass<R>,
    rows: Vec<Row<R>>,
    ends: Vec<usize>,
    scale: Vec<R>,
    factors: Vec<R>,
    lower: Vec<R>,
    cross: Vec<R>,
    rates: Vec<R>,
    lambda: Vec<R>,
    torque: Vec<R>,
    row: Vec<R>,
    part: Vec<R>,
    change: Vec<R>,
}

/// Row ℓ̇ = j v of a line: the force +1 on its second link, −1 on its first.
fn row_of<R: Real>(segment: &Segment<R>, line: &Line<R>) -> Row<R> {
    let [one, two] = segment.ends.map(|end| end.link.map_or(WORLD, |link| link as u32));
    let (n, p) = (line.direction, line.points[1]);
    let across = line.velocities[1] - line.velocities[0] - n.scale(line.rate);
    let n_dot = across.scale(R::one() / line.length);
    Row::between(two, one, force_at(p, n), force_rate(p, n, line.velocities[1], n_dot))
}

/// Row ℓ̇ = Σ cᵢ q̇ᵢ of two joints of a linear combination, or of its last one.
fn row_of_shares<R: Real>(shares: &[JointShare<R>]) -> Row<R> {
    let of = |k: usize| shares.get(k).map_or((WORLD, R::zero()), |share| (share.dof as u32, share.coefficient));
    Row::of_joints([of(0), of(1)])
}

/// Row of a bushing: of its translation along axis `k` of A (0–2), or of its rotation (3–5).
fn row_of_bushing<R: Real>(element: &Bushing<R>, at: &BushingMotion<R>, k: usize) -> Row<R> {
    let [one, two] = element.ends.map(|end| end.link.map_or(WORLD, |link| link as u32));
    if k < 3 {
        let n = at.axes.col(k);
        let w_dot = force_rate(at.point, n, at.velocity, at.turning.cross(n));
        return Row::between(two, one, force_at(at.point, n), w_dot);
    }
    let n = at.axes.mul_vec(at.rotation_rows.row(k - 3));
    let moment = |ang: Vec3<R>| Force { ang, lin: Vec3::zero() };
    Row::between(two, one, moment(n), moment(at.turning.cross(n)))
}

impl<R: Real> ImplicitForces<R> {
    /// Number of rows of a model, with all parts of a path taken as one.
    pub fn n_rows(model: &Model<R>) -> usize {
        model.spring_dampers.len() + model.elastic_gears.len() + 6 * model.bushings.len()
    }

    /// Working memory for the model; none if it has no springs and dampers along paths, elastic gears or bushings.
    pub fn new(model: &Model<R>) -> Option<Box<Self>> {
        let m = Self::n_rows(model);
        if m == 0 {
            return None;
        }
        let (n, o) = (model.n_v(), R::zero());
        let mut delassus = Delassus::new(model);
        delassus.reserve(m);
        Some(Box::new(Self {
            motions: Motions::new(model),
            delassus,
            inverse_mass: InverseMass::new(model),
            rows: Vec::with_capacity(m),
            ends: Vec::with_capacity(m),
            scale: vec![o; m],
            factors: vec![o; n * m],
            lower: vec![o; m * m],
            cross: Vec::with_capacity(m * model.params.constraints.n_bilateral()),
            rates: vec![o; m],
            lambda: vec![o; m],
            torque: vec![o; n],
            row: vec![o; n],
            part: vec![o; n],
            change: vec![o; n],
        }))
    }

    /// Bytes on the heap of the matrices.
    pub fn heap_bytes(&self) -> usize {
        size_of_val(&*self.factors) + size_of_val(&*self.lower) + size_of_val(&*self.row) * 4
    }

    /// Rows of the paths, with all their lines one after the other, and of the bushings, at joint rates `v`, at the
    /// poses of `scratch`.
    pub fn place(
        &mut self,
        model: &Model<R>,
        (lines, bushings): (&[Line<R>], &[BushingMotion<R>]),
        scratch: &Scratch<R>,
        v: &[R],
    ) {
        self.motions.place(model, scratch, v);
        self.rows.clear();
        self.ends.clear();
        let mut lines = lines.iter();
        for element in &model.spring_dampers {
            self.rows.extend(element.segments().iter().zip(&mut lines).map(|(segment, line)| row_of(segment, line)));
            self.rows.extend(element.shares().chunks(2).map(row_of_shares));
            self.ends.push(self.rows.len());
        }
        for gear in &model.elastic_gears {
            let [one, two] = gear.dofs.map(|dof| dof as u32);
            self.rows.push(Row::of_joints([(two, R::one()), (one, -gear.ratio)]));
            self.ends.push(self.rows.len());
        }
        for (element, at) in model.bushings.iter().zip(bushings) {
            for k in 0..6 {
                self.rows.push(row_of_bushing(element, at, k));
                self.ends.push(self.rows.len());
            }
        }
    }

    /// Parts of the row of path `i`.
    fn parts(&self, i: usize) -> &[Row<R>] {
        let first = if i == 0 { 0 } else { self.ends[i - 1] };
        &self.rows[first..self.ends[i]]
    }

    /// Factors of the system for the coefficients `kappa` [N·s²/m], after forward dynamics gave the accelerations
    /// `v_dot` without these forces.
    pub fn factor(&mut self, model: &Model<R>, scratch: &Scratch<R>, kappa: impl Iterator<Item = R>, v_dot: &[R]) {
        let m = self.ends.len();
        for (scale, kappa) in self.scale.iter_mut().zip(kappa) {
            // a root has no slope at zero
            *scale = kappa.max(R::splat(f64::MIN_POSITIVE)).sqrt();
        }
        self.motions.accelerate(model, scratch);
        self.delassus.place(model, scratch);
        self.factors.fill(R::zero());
        let mut first = 0;
        for (i, (&end, scale)) in self.ends.iter().zip(&self.scale).enumerate() {
            let factors = &mut self.factors;
            let mut acceleration = R::zero();
            for row in &self.rows[first..end] {
                self.delassus.factor_row(model, self.motions.columns(), row, |k, value| {
                    factors[k as usize * m + i] += value * *scale;
                });
                acceleration += self.motions.acceleration(row, v_dot);
            }
            self.rates[i] = *scale * acceleration;
            first = end;
        }
        self.cholesky();
        for i in 0..m {
            self.rates[i] = self.solve_lower(i, self.rates[i], |j| self.rates[j]);
        }
    }

    /// j M⁻¹ jᵀ of each line, its inverse inertia [1/kg], after [`ImplicitForces::factor`] with positive coefficients.
    pub fn inverse_inertias(&self) -> impl Iterator<Item = R> {
        let m = self.ends.len();
        (0..m).map(move |i| {
            let square = self.factors.chunks_exact(m).fold(R::zero(), |sum, column| sum + column[i] * column[i]);
            square / (self.scale[i] * self.scale[i])
        })
    }

    /// L of 1 + Ĵ M⁻¹ Ĵᵀ: every pivot is 1 or more, no row is exchanged.
    fn cholesky(&mut self) {
        let m = self.ends.len();
        for i in 0..m {
            for j in 0..=i {
                let mut sum = if i == j { R::one() } else { R::zero() };
                for column in self.factors.chunks_exact(m) {
                    sum += column[i] * column[j];
                }
                for k in 0..j {
                    sum -= self.lower[i * m + k] * self.lower[j * m + k];
                }
                self.lower[i * m + j] = if i == j { sum.sqrt() } else { sum / self.lower[j * m + j] };
            }
        }
    }

    /// Row `i` of the solution of L x = b, the rows before it known.
    fn solve_lower(&self, i: usize, b: R, x: impl Fn(usize) -> R) -> R {
        let m = self.ends.len();
        let mut sum = b;
        for j in 0..i {
            sum -= self.lower[i * m + j] * x(j);
        }
        sum / self.lower[i * m + i]
    }

    /// Takes the forces of the lines out of the constraint problem w = G λ + b (`n_rows` rows): what remains is that of
    /// the mass matrix M + Jᵀ κ J. `values` are the factors of the constraint rows, `n_v` × `n_rows`.
    pub fn reduce(&mut self, values: &[R], g: &mut [R], b: &mut [R]) {
        let (m, n) = (self.ends.len(), b.len());
        self.cross.clear();
        self.cross.resize(m * n, R::zero());
        for (own, other) in self.factors.chunks_exact(m).zip(values.chunks_exact(n)) {
            for (i, own) in own.iter().enumerate() {
                for (cross, other) in self.cross[i * n..(i + 1) * n].iter_mut().zip(other) {
                    *cross += *own * *other;
                }
            }
        }
        for k in 0..n {
            for i in 0..m {
                self.cross[i * n + k] = self.solve_lower(i, self.cross[i * n + k], |j| self.cross[j * n + k]);
            }
        }
        for i in 0..m {
            let cross = &self.cross[i * n..(i + 1) * n];
            for k in 0..n {
                b[k] -= cross[k] * self.rates[i];
                for l in 0..n {
                    g[k * n + l] -= cross[k] * cross[l];
                }
            }
        }
    }

    /// Generalized forces of the lines, with the multipliers of the constraint rows they were taken out of; none: no
    /// constraints act.
    pub fn torque(&mut self, model: &Model<R>, multipliers: &[R]) -> &[R] {
        let (m, n) = (self.ends.len(), multipliers.len());
        for i in 0..m {
            let mut sum = self.rates[i];
            for (k, multiplier) in multipliers.iter().enumerate() {
                sum += self.cross[i * n + k] * *multiplier;
            }
            self.lambda[i] = -sum;
        }
        // Lᵀ λ̂ = −(…)
        for i in (0..m).rev() {
            let mut sum = self.lambda[i];
            for j in i + 1..m {
                sum -= self.lower[j * m + i] * self.lambda[j];
            }
            self.lambda[i] = sum / self.lower[i * m + i];
        }
        self.torque.fill(R::zero());
        for i in 0..m {
            let first = if i == 0 { 0 } else { self.ends[i - 1] };
            self.motions.jacobian(model, &self.rows[first], &mut self.row);
            for part in &self.rows[first + 1..self.ends[i]] {
                self.motions.jacobian(model, part, &mut self.part);
                for (row, part) in self.row.iter_mut().zip(&self.part) {
                    *row += *part;
                }
            }
            let force = self.scale[i] * self.lambda[i];
            for (torque, j) in self.torque.iter_mut().zip(&self.row) {
                *torque += force * *j;
            }
        }
        &self.torque
    }

    /// Adds the response to the forces of the lines to accelerations and, with `reaction`, to reactions of prescribed
    /// degrees of freedom, where no constraint acts.
    pub fn respond(&mut self, model: &Model<R>, scratch: &mut Scratch<R>, v_dot: &mut [R], has_drives: bool) {
        self.torque(model, &[]);
        let mut reaction = core::mem::take(&mut scratch.reaction);
        let wanted = has_drives.then_some(&mut reaction[..]);
        self.inverse_mass.find(model, scratch, &self.torque, &mut self.change, wanted);
        scratch.reaction = reaction;
        for (v_dot, change) in v_dot.iter_mut().zip(&self.change) {
            *v_dot += *change;
        }
    }

    /// Sets the rate of each path and bushing for other joint rates `v` at the same poses `[m/s]`, `[rad/s]`.
    pub fn rates_at(
        &mut self,
        model: &Model<R>,
        v: &[R],
        lengths: &mut [PathLength<R>],
        bushings: &mut [BushingMotion<R>],
    ) {
        self.motions.place_velocities(model, v);
        let rate = |i: usize| self.parts(i).iter().fold(R::zero(), |sum, row| sum + self.motions.placed_rate(row, v));
        for (i, at) in lengths.iter_mut().enumerate() {
            at.rate = rate(i);
        }
        let first = lengths.len() + model.elastic_gears.len();
        for (i, at) in bushings.iter_mut().enumerate() {
            at.rates = at.rates_of_rows(core::array::from_fn(|k| rate(first + 6 * i + k)));
        }
    }
}
