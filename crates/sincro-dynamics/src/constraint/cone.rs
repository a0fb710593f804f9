//! Unilateral constraints with friction: exact cones, solved block by block.
//!
//! A block is a normal row with λ ≥ 0 ⊥ w ≥ 0 and up to three groups of friction rows: tangential (2 rows, coefficient μ), rolling (2 rows, a length)
//! and spinning (1 row, a length). Each group obeys |λ_g| ≤ c λ_n and opposes its own w_g with all of it where w_g ≠ 0: a disc, not a polygon.
//! The sweeps are projected Gauss–Seidel in a fixed order; they only have to find out who sticks, slips or lets go, what the numbers
//! are is then solved directly ([`super::solve`]).
//! Source: key `acary2008`, sections 13.3 (local solutions) and 13.4 (sweeps).

/// What a group of friction rows does.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Grip {
    Stick,
    Slip,
}

/// One group of friction rows of a block.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Group<R> {
    pub row: usize,
    pub dim: usize,
    pub coefficient: f64,
    /// Whether it slides with a velocity that gives the direction; else the direction follows from what it is about to do.
    pub slides: bool,
    pub grip: Grip,
    /// Direction of its force, if it slips.
    pub direction: [R; 2],
    /// Of a group that slides so slowly that friction could turn its velocity within the step: how much acceleration across the direction of
    /// sliding a unit of force across it comes with, so that the force is that of the end of the step. Else friction that turns
    /// with a small velocity would be stiff without bound.
    pub give: Option<R>,
}

impl<R> Group<R> {
    /// Whether its second row is solved for although it slides.
    pub fn is_slow(&self) -> bool {
        self.give.is_some()
    }
}

/// A unilateral constraint.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Block<R> {
    pub slot: usize,
    pub row: usize,
    /// Whether it lets go.
    pub open: bool,
    /// A normal force that is given, of a compliant contact.
    pub given: Option<R>,
    pub groups: [Option<Group<R>>; 3],
    /// What can be seen of it: bit 0, it leaves; bits 1 to 3, a group starts to move. One of several redundant contacts may bear nothing and
    /// still neither leave nor move.
    pub effect: u8,
}

/// Most sweeps of one solution.
pub(crate) const MAX_SWEEPS: usize = 2000;

/// A problem w = A λ + b, A row by row.
pub(crate) struct Problem<'a> {
    pub m: usize,
    pub a: &'a [f64],
    pub b: &'a [f64],
    /// Rows without bounds come first.
    pub n_free: usize,
}

impl Problem<'_> {
    pub fn w(&self, i: usize, lambda: &[f64]) -> f64 {
        let row = &self.a[i * self.m..(i + 1) * self.m];
        self.b[i] + row.iter().zip(lambda).map(|(a, x)| a * x).sum::<f64>()
    }

    fn diagonal(&self, i: usize) -> f64 {
        self.a[i * self.m + i]
    }

    /// Sweeps until nothing moves by more than `tolerance` (as a share of the largest λ); returns the sweeps done.
    pub fn sweep(&self, blocks: &[Block<f64>], lambda: &mut [f64], tolerance: f64) -> usize {
        for k in 0..MAX_SWEEPS {
            let mut moved = 0.0_f64;
            for i in 0..self.n_free {
                moved = moved.max(self.free(i, lambda));
            }
            for block in blocks {
                moved = moved.max(self.block(block, lambda));
            }
            let largest = lambda.iter().fold(0.0_f64, |a, x| a.max(x.abs()));
            if moved <= tolerance * largest {
                return k + 1;
            }
        }
        MAX_SWEEPS
    }

    fn free(&self, i: usize, lambda: &mut [f64]) -> f64 {
        let d = self.diagonal(i);
        // a row that nothing moves
        if d <= 0.0 {
            return 0.0;
        }
        let step = -self.w(i, lambda) / d;
        lambda[i] += step;
        step.abs()
    }

    fn block(&self, block: &Block<f64>, lambda: &mut [f64]) -> f64 {
        let n = block.row;
        let before = lambda[n];
        lambda[n] = match block.given {
            Some(force) => force,
            None if self.diagonal(n) <= 0.0 => 0.0,
            None => (before - self.w(n, lambda) / self.diagonal(n)).max(0.0),
        };
        let mut moved = (lambda[n] - before).abs();
        for group in block.groups.iter().flatten() {
            moved = moved.max(self.group(group, lambda[n], lambda));
        }
        moved
    }

    fn group(&self, group: &Group<f64>, normal: f64, lambda: &mut [f64]) -> f64 {
        let (g, limit) = (group.row, group.coefficient * normal);
        let old: [f64; 2] = std::array::from_fn(|k| if k < group.dim { lambda[g + k] } else { 0.0 });
        let new = if group.slides {
            group.direction.map(|d| d * limit)
        } else {
            let rate = (0..group.dim).map(|k| self.diagonal(g + k)).sum::<f64>();
            let toward: [f64; 2] = std::array::from_fn(|k| {
                if k < group.dim && rate > 0.0 { old[k] - self.w(g + k, lambda) / rate } else { 0.0 }
            });
            let size = (toward[0] * toward[0] + toward[1] * toward[1]).sqrt();
            if size > limit { toward.map(|x| x * (limit / size)) } else { toward }
        };
        let mut moved = 0.0_f64;
        for k in 0..group.dim {
            lambda[g + k] = new[k];
            moved = moved.max((new[k] - old[k]).abs());
        }
        moved
    }
}
