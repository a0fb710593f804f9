//! Alternating direction method of multipliers on the whitened rows of an island, where sweeps and Newton steps do not
//! converge: heavy bodies on light ones, many points that share a load beside a stop, friction that goes round in
//! circles. It needs no guess of modes.
//!
//! The forces are split into x, which obey w = G x + b, and y, which the laws admit, with ζ the multiplier of x = y;
//! the correction s = μ‖w_t‖ of a contact's normal rate makes Coulomb friction associated (de Saxcé), and is that of
//! the last iterate. With G = Y Yᵀ and D a multiple of the inverse traces of the blocks,
//!
//! f ← y − D (ζ + b + s), (1 + Yᵀ D Y) v = Yᵀ f, x ← f − D Y v, y ← P(x + D ζ), ζ ← ζ + D⁻¹ (x − y),
//!
//! by the inversion lemma: the matrix is that of a Newton step, of the size of the bodies, and factored once for every
//! D. The iterates are over-relaxed, and D balances both residuals. Sources: keys `acary2008` (section 3.9.4, the
//! correction), `carpentier2024` (the method).

use core::ops::Range;

use sincro_math::{LaneVisitor, Lanes, Real, lanes};

use super::newton::NewtonStep;
use super::{Block, Island, Sweeper, TOLERANCE, minus, square};

/// Share of the new x in the over-relaxed one.
const RELAXATION: f64 = 1.6;

/// Iterations between updates of D.
const BALANCE: usize = 25;

/// Bounds of D, in units of the step lengths of the natural map.
const MIN_SCALE: f64 = 1e-4;
const MAX_SCALE: f64 = 1e6;

/// Number of iterations between looks at the residual, and of these looks.
const ITERATIONS: usize = 50;
const MAX_LOOKS: usize = 40;

/// Working memory: one entry a block.
#[derive(Clone, Debug, Default)]
pub(super) struct Splitting {
    /// ζ.
    multiplier: Vec<[f64; 3]>,
    /// f.
    free: Vec<[f64; 3]>,
    /// y.
    admitted: Vec<[f64; 3]>,
    /// D, in units of the step lengths of the natural map.
    scale: f64,
}

impl Island<'_> {
    /// Improves the best forces, with a residual of `best`, by the alternating direction method. The best ones are then
    /// the present ones; returns their residual.
    pub(super) fn split(&mut self, step: &mut NewtonStep, mut best: f64) -> f64 {
        let mut splitting = core::mem::take(&mut self.sweeper.splitting);
        self.restore();
        self.find_velocities();
        splitting.begin(self.sweeper, self.blocks.clone());
        for _ in 0..MAX_LOOKS {
            if !lanes::dispatch_four_lanes(Iterations { splitting: &mut splitting, step, island: self }) {
                break;
            }
            self.find_velocities();
            self.sweeper.settle_drives();
            let residual = self.residual();
            if residual < best {
                best = residual;
                self.keep();
            }
            if best <= TOLERANCE {
                break;
            }
        }
        self.restore();
        self.sweeper.splitting = splitting;
        best
    }
}

/// Iterations on an island; false if its matrix has too many numbers.
struct Iterations<'a, 'b> {
    splitting: &'a mut Splitting,
    step: &'a mut NewtonStep,
    island: &'a mut Island<'b>,
}

impl LaneVisitor for Iterations<'_, '_> {
    type Output = bool;

    #[inline(always)]
    fn visit<V: Real>(self) -> bool {
        let Self { splitting, step, island: Island { sweeper, blocks, z, .. } } = self;
        sweeper.lambda[blocks.clone()].copy_from_slice(&splitting.admitted);
        for _ in 0..ITERATIONS / BALANCE {
            if !step.factor_scaled::<V>(sweeper, blocks.clone(), z.clone(), splitting.scale) {
                return false;
            }
            let mut sizes = [0.0; 2];
            for _ in 0..BALANCE {
                sizes = splitting.iterate::<V>(step, sweeper, blocks.clone(), z.start);
            }
            splitting.balance(sizes);
        }
        splitting.admitted.copy_from_slice(&sweeper.lambda[blocks.clone()]);
        true
    }
}

impl Splitting {
    /// Begins with the present forces and velocities of an island.
    fn begin(&mut self, sweeper: &mut Sweeper, blocks: Range<usize>) {
        self.scale = 1.0;
        self.admitted.clear();
        self.admitted.extend_from_slice(&sweeper.lambda[blocks.clone()]);
        self.free.clear();
        self.free.resize(blocks.len(), [0.0; 3]);
        self.multiplier.clear();
        for k in blocks {
            let u = sweeper.rates::<Lanes<4>>(k);
            let correction = sweeper.blocks[k].law.correction(u);
            self.multiplier.push([-u[0] - correction, -u[1], -u[2]]);
        }
    }

    /// One iteration, with y the forces of the blocks; returns the largest ‖x − y‖ and ‖Δy‖.
    #[inline(always)]
    fn iterate<V: Real>(
        &mut self,
        step: &mut NewtonStep,
        sweeper: &mut Sweeper,
        blocks: Range<usize>,
        start: usize,
    ) -> [f64; 2] {
        step.clear_right_hand_side();
        for k in blocks.clone() {
            let Block { law, b, .. } = &sweeper.blocks[k];
            let d = self.scale * sweeper.blocks[k].step_length();
            let (y, multiplier) = (sweeper.lambda[k], self.multiplier[k - blocks.start]);
            let free = [
                y[0] - d * (multiplier[0] + b[0] + law.correction(multiplier)),
                y[1] - d * (multiplier[1] + b[1]),
                y[2] - d * (multiplier[2] + b[2]),
            ];
            self.free[k - blocks.start] = free;
            step.push::<V>(sweeper, k, start, free);
        }
        step.substitute::<V>();
        let (mut apart, mut moved) = (0.0_f64, 0.0_f64);
        for k in blocks.clone() {
            let d = self.scale * sweeper.blocks[k].step_length();
            let growth = step.growth::<V>(sweeper, k, start);
            let (free, multiplier) = (self.free[k - blocks.start], &mut self.multiplier[k - blocks.start]);
            let before = sweeper.lambda[k];
            let (mut x, mut wanted) = ([0.0; 3], [0.0; 3]);
            for c in 0..3 {
                x[c] = RELAXATION * (free[c] - d * growth[c]) + (1.0 - RELAXATION) * before[c];
                wanted[c] = x[c] + d * multiplier[c];
            }
            let y = sweeper.admitted(k, wanted).0;
            sweeper.lambda[k] = y;
            let left = minus(x, y);
            if d > 0.0 {
                for c in 0..3 {
                    multiplier[c] += left[c] / d;
                }
            }
            apart = apart.max(square(left));
            moved = moved.max(square(minus(y, before)));
        }
        [apart.sqrt(), moved.sqrt()]
    }

    /// Adapts D to the sizes of ‖x − y‖ and ‖Δy‖: where x is far from y, they have to be held together more.
    fn balance(&mut self, [apart, moved]: [f64; 2]) {
        let ratio = if moved > 0.0 { (apart / moved).clamp(1e-4, 1e4).sqrt() } else { 1.0 };
        if !(0.5..2.0).contains(&ratio) {
            self.scale = (self.scale / ratio).clamp(MIN_SCALE, MAX_SCALE);
        }
    }
}
