//! Block Gauss–Seidel sweeps with Anderson acceleration, island by island.
//!
//! A sweep solves each contact's own problem, one after the other (`local`): exactly where it is open or sticks, a slip
//! nearly so, from sweep to sweep better. Between sweeps the forces move on along the differences of what the last
//! sweeps made of them (`anderson`).
//!
//! Where that converges slowly, Newton steps for all forces of the island together take turns with sweeps (`newton`),
//! where bodies move only once sweeps do not help: contacts change their modes there, which sweeps find;
//! where both leave much, the forces are split into those that obey the equations of motion and those that the laws
//! admit (`splitting`).
//! Wherever sweeps would end, limited drives are settled beside the contact forces found (`drives`).
//!
//! Residual of an island: natural map of the Coulomb law, the largest ‖λ − P_K(λ − ρ (u + μ‖u_t‖ n))‖ of its contacts
//! with ρ = 3/tr G, relative to its largest force (key `acary2008`, section 3.9.4).

mod anderson;
mod body_rows;
mod disjoint_sets;
mod drives;
pub mod islands;
pub(crate) mod local;
mod newton;
pub mod rest;
mod splitting;
pub mod usable_distance;
pub mod whitening;

use sincro_math::{LaneVisitor, Real, lanes};

use crate::solver::SolverReport;
use anderson::Anderson;
use body_rows::{Bodies, BodyRows};
use drives::Drives;
use local::{ContactLocal, TangentialProblem};
use newton::NewtonStep;
use splitting::Splitting;
use whitening::WhitenedRows;

/// Residual at which an island counts as solved.
const TOLERANCE: f64 = 1e-6;

/// Residual that an island which hardly moves is solved to, with few sweeps a step: where every step stopped at the
/// tolerance, the next ones would have to make up for it.
const REST_TOLERANCE: f64 = 1e-10;

/// Number of sweeps a step towards that residual.
const REST_SWEEPS: usize = 10;

/// Speed of all contacts of an island below which it hardly moves [m/s].
const REST_SPEED: f64 = 2e-3;

/// Share of that speed below which Newton steps follow where those sweeps do not get near it, up to which residual, and
/// their number a step.
const STILL: f64 = 0.05;
const STILL_TOLERANCE: f64 = 1e-9;
const STILL_NEWTON_STEPS: usize = 4;

/// Residual up to which the forces of an island in which nothing moves stand where a step does not halve it: several
/// pairs may want gap corrections that contradict each other.
const STANDING_RESIDUAL: f64 = 1e-8;

/// Number of sweeps before the first round of a Newton step or more sweeps, with one more for every eight blocks.
const FIRST_SWEEPS: usize = 50;

/// Number of sweeps after each Newton step, with one more for every sixteen blocks; twice as many without it.
const NEXT_SWEEPS: usize = 12;

/// Limit of these rounds of an island; beyond it the best iterate is taken and its residual reported.
const MAX_ROUNDS: usize = 12;

/// The same where bodies move: the forces of hits, which soon are others, are left sooner.
const MAX_MOVING_ROUNDS: usize = 5;

/// Share of the residual that a Newton step which fails leaves at least: pairs may want gap corrections that contradict
/// each other, and nothing makes that better.
const FAILURE: f64 = 0.9;

/// Residual above which the alternating direction method follows, and above which further sweeps follow that one, while
/// they make it smaller: they need no matrix.
const LARGEST_RESIDUAL: f64 = 3e-3;

/// Number of these sweeps at a time, and how often they are made.
const LAST_SWEEPS: usize = 200;
const MAX_LAST_ROUNDS: usize = 20;

/// Residual below which sweeps end after their number, unless the island hardly moves: bodies that hit each other share
/// forces that soon are others, and those at rest would creep.
const ROUGH_TOLERANCE: f64 = 1e-4;

/// Force law of a block of rows.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Law {
    /// Loop joint or gear: any force.
    Bilateral,
    /// Joint limit, contact without friction: pushes.
    Unilateral,
    /// Contact with sliding friction: normal row and two across.
    Coulomb {
        /// Friction coefficient.
        friction: f64,
    },
    /// Force that is given: of a compliant contact.
    Given {
        /// That force.
        force: f64,
    },
    /// Limited drive: |λ| ≤ `limit`.
    Interval {
        /// Largest torque or force.
        limit: f64,
    },
    /// Rolling or spinning friction: at most `coefficient` times the first force of the block `normal`.
    Disc {
        /// Coefficient.
        coefficient: f64,
        /// Index of the block of the contact.
        normal: usize,
    },
}

impl Law {
    /// Force of one row that the law admits instead of the `free` one, which brings the rate to zero; `limit` is that
    /// of friction or a drive.
    #[inline(always)]
    fn admitted(self, free: f64, limit: f64) -> f64 {
        match self {
            Self::Bilateral => free,
            Self::Unilateral => free.max(0.0),
            Self::Given { force } => force,
            Self::Coulomb { .. } | Self::Interval { .. } | Self::Disc { .. } => free.clamp(-limit, limit),
        }
    }

    /// Correction μ‖u_t‖ of the normal rate of a contact that slides by `u`, which makes Coulomb friction associated
    /// (de Saxcé).
    #[inline(always)]
    fn correction(self, u: [f64; 3]) -> f64 {
        match self {
            Self::Coulomb { friction } => friction * (u[1] * u[1] + u[2] * u[2]).sqrt(),
            _ => 0.0,
        }
    }
}

/// Meaning of the forces given with the blocks.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum GivenForces {
    /// Guess to start from.
    #[default]
    Start,
    /// Solution for the contacts, which stands in islands that never rest: drives and bilateral rows alone are solved
    /// beside them.
    Solution,
}

/// Rows with one law.
#[derive(Clone, Debug)]
struct Block {
    law: Law,
    /// First row of the problem, and number of rows.
    row: usize,
    n: usize,
    /// First number and first index of its whitened rows; length of each, even.
    values: usize,
    index: usize,
    len: usize,
    bodies: Bodies,
    /// Place of the rows by four lanes: of a contact column by column, and packed where it moves free bodies.
    rows: usize,
    /// Rates without any force, and a zero.
    b: [f64; 4],
    local: Local,
}

impl Block {
    /// ρ of the natural map.
    #[inline(always)]
    fn step_length(&self) -> f64 {
        match &self.local {
            Local::Scalar { inverse } => *inverse,
            Local::Tangential { trace, .. } => 2.0 / trace,
            Local::Contact(local) => 3.0 / local.trace(),
            Local::Immobile => 0.0,
        }
    }
}

/// Own problem of a block.
#[derive(Clone, Copy, Debug)]
enum Local {
    Scalar {
        inverse: f64,
    },
    Tangential {
        trace: f64,
        g: [f64; 3],
        problem: TangentialProblem,
    },
    /// A block that no force moves.
    Immobile,
    Contact(ContactLocal),
}

/// Part of the lists that belongs to one island.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct IslandRange {
    blocks: (usize, usize),
    z: (usize, usize),
    stillness: Stillness,
}

/// Ability of an island to come to rest.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Stillness {
    /// It has drives or other constraints, and never sleeps.
    Awake,
    /// It can come to rest.
    CanRest,
    /// Nothing in it moves.
    Still,
}

/// Result of an island.
#[derive(Clone, Copy, Debug)]
struct Outcome {
    residual: f64,
    sweeps: usize,
    /// True if the forces are those to start from.
    stands: bool,
}

/// Blocks of all islands with their whitened rows.
#[derive(Clone, Debug, Default)]
pub struct Sweeper {
    blocks: Vec<Block>,
    /// Force of each block.
    lambda: Vec<[f64; 3]>,
    values: Vec<f64>,
    /// The rows of contacts once more, by four lanes.
    rows: Vec<[f64; 4]>,
    /// Those of the contact last added.
    whitened: WhitenedRows,
    /// Places in z of the numbers of each row.
    index: Vec<u32>,
    islands: Vec<IslandRange>,
    z: Vec<f64>,
    /// Place in z of each degree of freedom.
    place: Vec<u32>,
    z_before: Vec<f64>,
    anderson: Anderson,
    /// Velocities along one block.
    along: Vec<f64>,
    /// Forces with the least residual so far.
    best: Vec<[f64; 3]>,
    /// Forces that an island starts from in which nothing moves.
    start: Vec<[f64; 3]>,
    newton: NewtonStep,
    splitting: Splitting,
    drives: Drives,
    last: Solved,
}

/// Problem last solved, and its solution. A step whose forces were looked at beforehand is solved twice.
#[derive(Clone, Debug, Default)]
struct Solved {
    h: f64,
    values: Vec<f64>,
    index: Vec<u32>,
    islands: Vec<IslandRange>,
    /// Law, first row, b and the forces to start from, of each block.
    blocks: Vec<(Law, usize, [f64; 4], [f64; 3])>,
    forces: Vec<[f64; 3]>,
    /// One for each island.
    outcomes: Vec<Outcome>,
    /// Entries that its solution added to the report.
    report: SolverReport,
}

const NONE: u32 = u32::MAX;

/// Sum of the inverse masses and inertias of a block below which no force moves it [1/kg], [1/(kg·m²)].
const IMMOBILE: f64 = 1e-24;

impl Sweeper {
    /// Begins a problem of a mechanism with `n_v` degrees of freedom.
    pub fn clear(&mut self, n_v: usize) {
        self.blocks.clear();
        self.lambda.clear();
        self.values.clear();
        self.rows.clear();
        self.index.clear();
        self.islands.clear();
        self.place.clear();
        self.place.resize(n_v, NONE);
        // the first number belongs to no degree of freedom: it fills up rows of odd length
        self.z.clear();
        self.z.push(0.0);
    }

    /// Number of blocks so far.
    #[must_use]
    pub fn block_count(&self) -> usize {
        self.blocks.len()
    }

    /// Ends an island; where nothing in it moves and the forces to start from solve its problem within
    /// 1e-10, or within 1e-8 and hardly better ones are found, they stand as they are.
    pub fn end_island(&mut self, stillness: Stillness) {
        let (blocks, z) = self.islands.last().map_or((0, 1), |island| (island.blocks.1, island.z.1));
        self.islands.push(IslandRange { blocks: (blocks, self.blocks.len()), z: (z, self.z.len()), stillness });
    }

    /// Returns true if an island of the problem last solved has a residual within the tolerance.
    #[must_use]
    pub fn is_solved(&self, island: usize) -> bool {
        self.last.outcomes[island].residual <= TOLERANCE
    }

    /// Returns true if the forces of an island of the problem last solved are those that it started from.
    #[must_use]
    pub fn was_at_rest(&self, island: usize) -> bool {
        self.last.outcomes[island].stands
    }

    /// Solves all islands of a step of length `h` `[s]` from the forces given with the blocks.
    pub fn solve(&mut self, h: f64, given: GivenForces, report: &mut SolverReport) {
        if self.is_last(h) {
            self.lambda.clone_from(&self.last.forces);
        } else {
            self.keep_problem(h);
            self.solve_islands(h, given);
            self.last.forces.clone_from(&self.lambda);
        }
        let SolverReport { islands, sweeps, unconverged_islands, worst_island, .. } = self.last.report;
        report.islands += islands;
        report.sweeps += sweeps;
        report.unconverged_islands += unconverged_islands;
        report.worst_island = report.worst_island.max(worst_island);
    }

    /// Returns true if the problem is the one last solved, to the last bit.
    fn is_last(&self, h: f64) -> bool {
        let last = &self.last;
        let same = |x: &[f64], y: &[f64]| x.iter().zip(y).all(|(x, y)| x.to_bits() == y.to_bits());
        h.to_bits() == last.h.to_bits()
            && self.blocks.len() == last.blocks.len()
            && self.values.len() == last.values.len()
            && self.islands == last.islands
            && self.blocks.iter().zip(&self.lambda).zip(&last.blocks).all(|((block, force), (law, row, b, start))| {
                block.law == *law && block.row == *row && same(&block.b, b) && same(force, start)
            })
            && self.index == last.index
            && same(&self.values, &last.values)
    }

    fn keep_problem(&mut self, h: f64) {
        let Self { last, values, index, islands, blocks, lambda, .. } = self;
        last.h = h;
        last.values.clone_from(values);
        last.index.clone_from(index);
        last.islands.clone_from(islands);
        last.blocks.clear();
        last.blocks.extend(blocks.iter().zip(lambda).map(|(block, force)| (block.law, block.row, block.b, *force)));
    }

    fn solve_islands(&mut self, h: f64, given: GivenForces) {
        let mut report = SolverReport::default();
        self.resize_buffers();
        self.last.outcomes.clear();
        for k in 0..self.islands.len() {
            let IslandRange { blocks, z, stillness } = self.islands[k];
            let (blocks, z) = (blocks.0..blocks.1, z.0..z.1);
            let island = Island { sweeper: self, blocks, z, rest_rate: REST_SPEED / h, stillness };
            let outcome = match (given, stillness) {
                (GivenForces::Solution, Stillness::Awake) => island.settle(),
                _ => island.solve(),
            };
            self.last.outcomes.push(outcome);
            let Outcome { residual, sweeps, .. } = outcome;
            report.islands += 1;
            report.sweeps += sweeps as u64;
            report.unconverged_islands += u64::from(residual > TOLERANCE);
            report.worst_island = report.worst_island.max(residual);
        }
        self.last.report = report;
    }

    /// Takes the drives of an island ([`Drives::collect`]).
    fn collect_drives(&mut self, blocks: core::ops::Range<usize>, z: core::ops::Range<usize>, all: bool) {
        let mut drives = core::mem::take(&mut self.drives);
        drives.collect(self, blocks, z, all);
        self.drives = drives;
    }

    /// Settles the drives last taken ([`Drives::settle`]).
    fn settle_drives(&mut self) {
        if self.drives.is_empty() {
            return;
        }
        let mut drives = core::mem::take(&mut self.drives);
        drives.settle(self);
        self.drives = drives;
    }

    /// Places in z of the numbers of the first row of a block, and these.
    fn first_row(&self, k: usize) -> impl Iterator<Item = (usize, f64)> {
        let block = &self.blocks[k];
        let index = &self.index[block.index..block.index + block.len];
        index.iter().map(|i| *i as usize).zip(self.values[block.values..].iter().copied())
    }

    /// Working memory for the present problem.
    fn resize_buffers(&mut self) {
        self.z_before.clear();
        self.z_before.resize(self.z.len(), 0.0);
        let longest = self.blocks.iter().map(|block| block.len).max().unwrap_or(0);
        self.along.clear();
        self.along.resize(longest, 0.0);
    }

    /// Hands each row with its multiplier to `take`.
    pub fn read(&self, mut take: impl FnMut(usize, f64)) {
        for (block, force) in self.blocks.iter().zip(&self.lambda) {
            for (k, force) in force.iter().enumerate().take(block.n) {
                take(block.row + k, *force);
            }
        }
    }

    /// Rates of a block: b + y·z.
    #[inline(always)]
    fn rates<V: Real>(&mut self, k: usize) -> [f64; 3] {
        let Self { blocks, rows, z, .. } = self;
        let Block { bodies, rows: first, b, .. } = &blocks[k];
        match *bodies {
            Bodies::One(one) => BodyRows::first_of(&rows[*first..], [one]).rates::<V>(b, z),
            Bodies::Two(one, two) => BodyRows::first_of(&rows[*first..], [one, two]).rates::<V>(b, z),
            Bodies::Other if blocks[k].n == 3 => self.rates_by_columns::<V>(k),
            Bodies::Other => self.rates_of_others(k),
        }
    }

    /// The same for a contact with any velocities, with the bits of [`Sweeper::rates_of_others`].
    #[inline(always)]
    fn rates_by_columns<V: Real>(&mut self, k: usize) -> [f64; 3] {
        let Self { blocks, rows, index, along, z, .. } = self;
        let Block { index: first, len, rows: column, b, .. } = blocks[k];
        let index = &index[first..first + len];
        let columns = &rows[column..column + len];
        let along = &mut along[..len];
        let mut sums = [V::zero(); 2];
        for j in 0..len {
            along[j] = z[index[j] as usize];
            sums[j % 2] += V::from_row(&columns[j]) * V::splat(along[j]);
        }
        let mut u = [0.0; 4];
        (V::from_row(&b) + (sums[0] + sums[1])).to_row(&mut u);
        [u[0], u[1], u[2]]
    }

    #[inline(always)]
    fn rates_of_others(&mut self, k: usize) -> [f64; 3] {
        let block = &self.blocks[k];
        let len = block.len;
        let index = &self.index[block.index..block.index + len];
        let along = &mut self.along[..len];
        for (along, i) in along.iter_mut().zip(index) {
            *along = self.z[*i as usize];
        }
        let mut u = [block.b[0], block.b[1], block.b[2]];
        let y = &self.values[block.values..block.values + block.n * len];
        for (u, y) in u.iter_mut().zip(y.chunks_exact(len.max(1))) {
            *u += dot(y, along);
        }
        u
    }

    /// Changes the forces of a block; the velocities along it are those last taken by [`Sweeper::rates`].
    #[inline(always)]
    fn change<V: Real>(&mut self, k: usize, lambda: [f64; 3]) {
        let d = minus(lambda, self.lambda[k]);
        self.lambda[k] = lambda;
        if d == [0.0; 3] {
            return;
        }
        let Self { blocks, rows, z, .. } = self;
        let Block { bodies, rows: first, .. } = &blocks[k];
        match *bodies {
            Bodies::One(one) => BodyRows::first_of(&rows[*first..], [one]).add_to::<V>(d, z),
            Bodies::Two(one, two) => BodyRows::first_of(&rows[*first..], [one, two]).add_to::<V>(d, z),
            Bodies::Other => self.change_others(k, d),
        }
    }

    #[inline(always)]
    fn change_others(&mut self, k: usize, d: [f64; 3]) {
        let block = &self.blocks[k];
        let len = block.len;
        let along = &mut self.along[..len];
        let y = &self.values[block.values..block.values + block.n * len];
        for (d, y) in d.iter().zip(y.chunks_exact(len.max(1))) {
            for (along, y) in along.iter_mut().zip(y) {
                *along += y * d;
            }
        }
        for (along, i) in along.iter().zip(&self.index[block.index..block.index + len]) {
            self.z[*i as usize] = *along;
        }
    }

    /// Solves a block's own problem. Returns the squares of the change and of the force.
    #[inline(always)]
    fn relax<V: Real>(&mut self, k: usize) -> [f64; 2] {
        let Self { blocks, rows, z, lambda, .. } = self;
        if let Block { law: Law::Coulomb { friction }, local: Local::Contact(local), bodies, rows: first, b, .. } =
            &mut blocks[k]
        {
            match *bodies {
                Bodies::One(one) => {
                    let rows = BodyRows::first_of(&rows[*first..], [one]);
                    return relax_contact::<V, 1>(rows, b, *friction, local, z, &mut lambda[k]);
                }
                Bodies::Two(one, two) => {
                    let rows = BodyRows::first_of(&rows[*first..], [one, two]);
                    return relax_contact::<V, 2>(rows, b, *friction, local, z, &mut lambda[k]);
                }
                Bodies::Other => {}
            }
        }
        let before = self.lambda[k];
        let u = self.rates::<V>(k);
        let lambda = self.own_force(k, u);
        self.change::<V>(k, lambda);
        [square(minus(lambda, before)), square(lambda)]
    }

    /// Force of a block that solves its own problem, for its present rates.
    #[inline(always)]
    fn own_force(&mut self, k: usize, u: [f64; 3]) -> [f64; 3] {
        let limit = self.limit(k);
        let lambda = self.lambda[k];
        let Block { law, local, .. } = &mut self.blocks[k];
        match (local, *law) {
            (Local::Contact(local), Law::Coulomb { friction }) => local.solve(friction, lambda, u),
            (Local::Scalar { inverse }, law) => [law.admitted(lambda[0] - u[0] * *inverse, limit), 0.0, 0.0],
            (Local::Tangential { g, problem, .. }, _) => {
                let own = [g[0] * lambda[0] + g[1] * lambda[1], g[1] * lambda[0] + g[2] * lambda[1]];
                let r = [own[0] - u[0], own[1] - u[1]];
                let free = problem.slip_or_stick(r, limit);
                [free[0], free[1], 0.0]
            }
            (Local::Immobile, Law::Given { force }) => [force, 0.0, 0.0],
            _ => [0.0; 3],
        }
    }

    /// Limit of the force of a friction block or drive.
    #[inline(always)]
    fn limit(&self, k: usize) -> f64 {
        match self.blocks[k].law {
            Law::Interval { limit } => limit,
            Law::Disc { coefficient, normal } => coefficient * self.lambda[normal][0].max(0.0),
            _ => 0.0,
        }
    }

    /// Natural map of a block's law at its present force and rates.
    #[inline(always)]
    fn natural_map(&self, k: usize, u: [f64; 3]) -> f64 {
        distance(&self.lambda[k], &self.projected(k, u).0)
    }

    /// P(λ − ρ (u + μ‖u_t‖ n)) of a block, and the derivative of P.
    #[inline(always)]
    fn projected(&self, k: usize, u: [f64; 3]) -> ([f64; 3], [f64; 6]) {
        let block = &self.blocks[k];
        let rho = block.step_length();
        let shift = block.law.correction(u);
        let [normal, one, two] = self.lambda[k];
        self.admitted(k, [normal - rho * (u[0] + shift), one - rho * u[1], two - rho * u[2]])
    }

    /// Force that the law of a block admits nearest to `x`, and the derivative of this projection.
    #[inline(always)]
    fn admitted(&self, k: usize, x: [f64; 3]) -> ([f64; 3], [f64; 6]) {
        let Block { law, local, .. } = &self.blocks[k];
        let limit = self.limit(k);
        match (local, *law) {
            (Local::Contact(_), Law::Coulomb { friction }) => project_on_cone(friction, x),
            (Local::Scalar { .. }, law) => {
                let force = law.admitted(x[0], limit);
                let slope = if force == x[0] && !matches!(law, Law::Given { .. }) { 1.0 } else { 0.0 };
                ([force, 0.0, 0.0], [slope, 0.0, 0.0, 0.0, 0.0, 0.0])
            }
            (Local::Tangential { .. }, _) => {
                let size = (x[0] * x[0] + x[1] * x[1]).sqrt();
                if size <= limit {
                    return ([x[0], x[1], 0.0], [1.0, 0.0, 0.0, 1.0, 0.0, 0.0]);
                }
                let (share, [t1, t2]) = (limit / size, [x[0] / size, x[1] / size]);
                let slope = [share * t2 * t2, -share * t1 * t2, 0.0, share * t1 * t1, 0.0, 0.0];
                ([x[0] * share, x[1] * share, 0.0], slope)
            }
            (Local::Immobile, Law::Given { force }) => ([force, 0.0, 0.0], [0.0; 6]),
            _ => ([0.0; 3], [0.0; 6]),
        }
    }
}

/// Solves the own problem of a contact of bodies with six velocities each. Returns the squares of the change and of the
/// force.
#[inline(always)]
fn relax_contact<V: Real, const N: usize>(
    rows: BodyRows<'_, N>,
    b: &[f64; 4],
    friction: f64,
    local: &mut ContactLocal,
    z: &mut [f64],
    force: &mut [f64; 3],
) -> [f64; 2] {
    let before = *force;
    *force = local.solve(friction, before, rows.rates::<V>(b, z));
    let change = minus(*force, before);
    if change != [0.0; 3] {
        rows.add_to::<V>(change, z);
    }
    [square(change), square(*force)]
}

/// Result of some sweeps.
struct Swept {
    residual: f64,
    sweeps: usize,
    /// Largest rate of what carries a force, over that below which the island hardly moves.
    motion: f64,
}

/// One island to be solved.
struct Island<'a> {
    sweeper: &'a mut Sweeper,
    blocks: core::ops::Range<usize>,
    z: core::ops::Range<usize>,
    /// Rate below which it hardly moves.
    rest_rate: f64,
    stillness: Stillness,
}

impl Island<'_> {
    fn solve(mut self) -> Outcome {
        self.sweeper.collect_drives(self.blocks.clone(), self.z.clone(), false);
        self.find_velocities();
        if self.stillness != Stillness::Still {
            return self.improve();
        }
        let Sweeper { start, lambda, .. } = &mut *self.sweeper;
        start.clear();
        start.extend_from_slice(&lambda[self.blocks.clone()]);
        let residual = self.residual();
        if residual <= REST_TOLERANCE {
            return Outcome { residual, sweeps: 0, stands: true };
        }
        let improved = self.improve();
        if residual > STANDING_RESIDUAL || improved.residual < 0.5 * residual {
            return improved;
        }
        let Sweeper { start, lambda, .. } = &mut *self.sweeper;
        lambda[self.blocks.clone()].copy_from_slice(start);
        Outcome { residual, sweeps: improved.sweeps, stands: true }
    }

    /// Makes sweeps and Newton steps from the present forces on.
    fn improve(&mut self) -> Outcome {
        let Swept { residual: mut best, mut sweeps, mut motion } = self.sweep(FIRST_SWEEPS + self.blocks.len() / 8);
        if best <= self.enough(motion, 0) {
            return Outcome { residual: best, sweeps, stands: false };
        }
        let mut newton = core::mem::take(&mut self.sweeper.newton);
        self.keep();
        let next_sweeps = NEXT_SWEEPS + self.blocks.len() / 16;
        let can_rest = self.stillness != Stillness::Awake;
        let (mut stalls, mut fails, mut do_sweeps_help) = (0, 0, true);
        for round in 1..=MAX_ROUNDS {
            let last = best;
            let is_swept = can_rest && motion >= 1.0 && do_sweeps_help;
            if !is_swept {
                lanes::dispatch_four_lanes(newton.prepare(self.sweeper, self.blocks.clone(), self.z.clone()));
            }
            let mut swept = self.sweep(if is_swept { 2 * next_sweeps } else { next_sweeps });
            sweeps += swept.sweeps;
            if swept.residual >= best {
                // the step was none
                self.restore();
                self.find_velocities();
                if !is_swept {
                    swept = self.sweep(2 * next_sweeps);
                    sweeps += swept.sweeps;
                }
            }
            motion = swept.motion;
            if swept.residual < best {
                best = swept.residual;
                self.keep();
            }
            // what hardly gets better is left, the sooner the smaller it is
            let has_halved = best < 0.5 * last;
            do_sweeps_help &= !is_swept || has_halved;
            stalls += usize::from(!has_halved);
            if !is_swept {
                fails = if best > FAILURE * last { fails + 1 } else { 0 };
            }
            let has_stalled = (best <= TOLERANCE && stalls > 1)
                || (best <= ROUGH_TOLERANCE && stalls > 3)
                || (best <= if motion >= 1.0 { LARGEST_RESIDUAL } else { ROUGH_TOLERANCE } && fails > 1);
            let is_at_moving_limit = motion >= 1.0 && round >= MAX_MOVING_ROUNDS;
            if best <= self.enough(motion, round) || has_stalled || is_at_moving_limit {
                break;
            }
        }
        self.restore();
        if best > LARGEST_RESIDUAL {
            best = self.split(&mut newton, best);
        }
        self.sweeper.newton = newton;
        for _ in 0..MAX_LAST_ROUNDS {
            if best <= LARGEST_RESIDUAL {
                break;
            }
            self.find_velocities();
            let swept = self.sweep(LAST_SWEEPS);
            sweeps += swept.sweeps;
            if swept.residual >= best {
                break;
            }
            best = swept.residual;
            self.keep();
        }
        self.restore();
        Outcome { residual: best, sweeps, stands: false }
    }

    /// Residual with which an island that moves so is left after so many rounds.
    fn enough(&self, motion: f64, rounds: usize) -> f64 {
        match (motion, self.stillness) {
            // what never rests may move where nothing touches
            (_, Stillness::Awake) if rounds == 0 => TOLERANCE,
            (m, Stillness::CanRest | Stillness::Still) if m < STILL && rounds < STILL_NEWTON_STEPS => STILL_TOLERANCE,
            (m, _) if m < 1.0 => TOLERANCE,
            _ => ROUGH_TOLERANCE,
        }
    }

    /// Settles drives and bilateral rows beside the present forces of contacts, which stand.
    fn settle(mut self) -> Outcome {
        self.sweeper.collect_drives(self.blocks.clone(), self.z.clone(), true);
        self.find_velocities();
        self.sweeper.settle_drives();
        Outcome { residual: self.residual(), sweeps: 0, stands: false }
    }

    /// Residual of the present forces, relative to the largest.
    fn residual(&mut self) -> f64 {
        let forces = &self.sweeper.lambda[self.blocks.clone()];
        let largest = forces.iter().map(|force| square(*force)).fold(0.0, f64::max).sqrt();
        lanes::dispatch_four_lanes(FindResidual { island: self, largest })
    }

    /// The velocities of the present forces.
    fn find_velocities(&mut self) {
        lanes::dispatch_four_lanes(FindVelocities { island: self });
    }

    /// Keeps the present forces as the best ones.
    fn keep(&mut self) {
        let Sweeper { best, lambda, .. } = &mut *self.sweeper;
        best.clear();
        best.extend_from_slice(&lambda[self.blocks.clone()]);
    }

    /// Returns to the best forces; velocities stay.
    fn restore(&mut self) {
        let Sweeper { best, lambda, .. } = &mut *self.sweeper;
        lambda[self.blocks.clone()].copy_from_slice(best);
    }

    /// Makes up to `most` sweeps, fewer if they suffice.
    fn sweep(&mut self, most: usize) -> Swept {
        lanes::dispatch_four_lanes(Sweeps { island: self, most })
    }
}

/// The velocities of the present forces of an island.
struct FindVelocities<'a, 'b> {
    island: &'a mut Island<'b>,
}

impl LaneVisitor for FindVelocities<'_, '_> {
    type Output = ();

    #[inline(always)]
    fn visit<V: Real>(self) {
        let Island { sweeper, blocks, z, .. } = self.island;
        sweeper.z[z.clone()].fill(0.0);
        for k in blocks.clone() {
            sweeper.rates::<V>(k);
            let lambda = core::mem::take(&mut sweeper.lambda[k]);
            sweeper.change::<V>(k, lambda);
        }
    }
}

/// Residual of an island, with its largest force.
struct FindResidual<'a, 'b> {
    island: &'a mut Island<'b>,
    largest: f64,
}

impl LaneVisitor for FindResidual<'_, '_> {
    type Output = f64;

    #[inline(always)]
    fn visit<V: Real>(self) -> f64 {
        let Island { sweeper, blocks, .. } = self.island;
        residual::<V>(sweeper, blocks.clone(), self.largest, true).0
    }
}

/// Sweeps over an island, at most so many.
struct Sweeps<'a, 'b> {
    island: &'a mut Island<'b>,
    most: usize,
}

impl LaneVisitor for Sweeps<'_, '_> {
    type Output = Swept;

    #[inline(always)]
    fn visit<V: Real>(self) -> Swept {
        let Self { island: Island { sweeper, blocks, z, rest_rate, stillness }, most } = self;
        sweeper.anderson.restart(z.len(), 3 * blocks.len());
        for sweep in 1..=most {
            sweeper.z_before[z.clone()].copy_from_slice(&sweeper.z[z.clone()]);
            let (mut change, mut largest) = (0.0_f64, 0.0_f64);
            for k in blocks.clone() {
                let [of_change, of_force] = sweeper.relax::<V>(k);
                change = if of_change > change { of_change } else { change };
                largest = if of_force > largest { of_force } else { largest };
            }
            let is_last = sweep == most;
            if change <= TOLERANCE * TOLERANCE * largest || is_last || largest == 0.0 {
                sweeper.settle_drives();
                let (residual, fastest) =
                    residual::<V>(sweeper, blocks.clone(), largest.sqrt(), *stillness != Stillness::Awake);
                let motion = fastest / *rest_rate;
                let tolerance = if motion < 1.0 && sweep < REST_SWEEPS { REST_TOLERANCE } else { TOLERANCE };
                if residual <= tolerance || is_last {
                    return Swept { residual, sweeps: sweep, motion };
                }
            }
            let Sweeper { z: velocities, z_before, lambda, anderson, .. } = &mut **sweeper;
            let forces = lambda[blocks.clone()].as_flattened_mut();
            anderson.advance::<V>(&z_before[z.clone()], &mut velocities[z.clone()], forces);
        }
        unreachable!("the last sweep returns")
    }
}

/// Residual of an island relative to its `largest` force, and the largest rate, of what carries a force if only what is
/// `loaded` counts: surfaces that do not touch may have any.
#[inline(always)]
fn residual<V: Real>(sweeper: &mut Sweeper, blocks: core::ops::Range<usize>, largest: f64, loaded: bool) -> (f64, f64) {
    let (mut worst, mut fastest) = (0.0_f64, 0.0_f64);
    for k in blocks {
        let u = sweeper.rates::<V>(k);
        let miss = sweeper.natural_map(k, u);
        // a maximum passes over what is not a number
        worst = if miss.is_nan() { f64::INFINITY } else { worst.max(miss) };
        if !loaded || sweeper.lambda[k] != [0.0; 3] {
            for u in u {
                fastest = fastest.max(u.abs());
            }
        }
    }
    (if worst > 0.0 { worst / largest } else { 0.0 }, fastest)
}

/// Projection on the cone ‖x_t‖ ≤ μ xₙ, and its derivative: entries 00, 01, 02, 11, 12, 22.
#[inline(always)]
fn project_on_cone(friction: f64, x: [f64; 3]) -> ([f64; 3], [f64; 6]) {
    let size = (x[1] * x[1] + x[2] * x[2]).sqrt();
    if size <= friction * x[0] {
        return (x, [1.0, 0.0, 0.0, 1.0, 0.0, 1.0]);
    }
    if friction * size <= -x[0] {
        return ([0.0; 3], [0.0; 6]);
    }
    let of_normal = 1.0 / (1.0 + friction * friction);
    let normal = (x[0] + friction * size) * of_normal;
    let share = friction * normal / size;
    // μ/(1 + μ²) couples normal and sliding direction; across that the force turns
    let (t1, t2) = (x[1] / size, x[2] / size);
    let (coupled, along) = (friction * of_normal, friction * friction * of_normal);
    let slope = [
        of_normal,
        coupled * t1,
        coupled * t2,
        along * t1 * t1 + share * t2 * t2,
        (along - share) * t1 * t2,
        along * t2 * t2 + share * t1 * t1,
    ];
    ([normal, x[1] * share, x[2] * share], slope)
}

#[inline(always)]
fn distance(x: &[f64; 3], y: &[f64; 3]) -> f64 {
    square(minus(*x, *y)).sqrt()
}

#[inline(always)]
fn square(x: [f64; 3]) -> f64 {
    x[0] * x[0] + x[1] * x[1] + x[2] * x[2]
}

// written out: closures are not inlined into code for other registers
#[inline(always)]
fn minus(x: [f64; 3], y: [f64; 3]) -> [f64; 3] {
    [x[0] - y[0], x[1] - y[1], x[2] - y[2]]
}

/// Scalar product of two lists of even length, in two lanes.
#[inline(always)]
fn dot(x: &[f64], y: &[f64]) -> f64 {
    let mut sums = [0.0; 2];
    for (x, y) in x.chunks_exact(2).zip(y.chunks_exact(2)) {
        sums[0] += x[0] * y[0];
        sums[1] += x[1] * y[1];
    }
    sums[0] + sums[1]
}
