//! Consistency of initial velocities: rates at which they open loop joints and gears, and velocity motors without a
//! torque limit whose targets contradict the loops.

use super::placed;
use crate::actuation::DriveKind;
use crate::ids::MotorId;
use crate::mechanism::Mechanism;
use crate::model::Model;
use crate::state::State;

/// Part of a column of the constraint Jacobian below which it depends on others, relative to its norm.
const DEPENDENT: f64 = 1e-9;

/// Rate at which a loop joint or gear opens in a state.
#[derive(Clone, Debug, PartialEq)]
pub struct ConstraintRate {
    /// Its name.
    pub name: String,
    /// Largest rate of its position equations [m/s]; of a gear, in the units of its second joint.
    pub speed: f64,
    /// Largest rate of its orientation equations [rad/s].
    pub angular_speed: f64,
}

/// Velocity motors without a torque limit whose targets no motion of the mechanism satisfies.
#[derive(Clone, Debug, PartialEq)]
pub struct MotorConflict {
    /// The motors that no motion can satisfy together.
    pub motors: Vec<MotorId>,
    /// Loop joints and gears between them.
    pub constraints: Vec<String>,
    /// Rate at which one of these opens if all motors have their targets [m/s], [rad/s].
    pub rate: f64,
}

/// Rates of every loop joint and gear in a state, zero where its velocities keep it closed [m/s], [rad/s].
///
/// ```
/// use sincro_dynamics::initial::constraint_rates;
/// use sincro_dynamics::model::GearSpec;
/// use sincro_dynamics::prelude::*;
///
/// let mut builder = ModelBuilder::new([0.0; 3]);
/// let mass = Shape::Sphere { radius: 0.1 }.mass_properties(1000.0);
/// let joints = ["motor", "wheel"].map(|name| {
///     let hinge = JointSpec::new(JointKind::Revolute { axis: [0.0, 0.0, 1.0] });
///     let joint = builder.joint(name, NodeId::WORLD, Pose::identity(), hinge);
///     builder.body(&format!("{name}'s body"), joint, Pose::identity(), BodySpec { mass });
///     joint
/// });
/// builder.gear("gear", GearSpec { joints, ratio: -0.25, offset: 0.0 });
/// let (model, _warnings) = builder.build()?;
/// let state = State { v: vec![4.0, 0.0], ..State::new(&model) };
/// assert_eq!(constraint_rates(&model, &state)[0].speed, 1.0); // the wheel should turn at −1 rad/s
/// # Ok::<(), BuildError>(())
/// ```
#[must_use]
pub fn constraint_rates(model: &Model<f64>, x: &State<f64>) -> Vec<ConstraintRate> {
    let set = model.constraints();
    let Some(loops) = Loops::at(model, x) else { return Vec::new() };
    let rates: Vec<f64> = loops.rows().map(|row| loops.rate(row, &x.v).abs()).collect();
    let largest = |rates: &[f64]| rates.iter().copied().fold(0.0, f64::max);
    let mut rest = &rates[..];
    let loop_joints = set.loop_joints.iter().map(|joint| {
        let (own, others) = rest.split_at(joint.kind.rows());
        rest = others;
        let (linear, angular) = own.split_at(joint.kind.n_translations());
        ConstraintRate { name: joint.name.clone(), speed: largest(linear), angular_speed: largest(angular) }
    });
    let mut all: Vec<ConstraintRate> = loop_joints.collect();
    let gears = set.gears.iter().zip(rest);
    all.extend(gears.map(|(gear, rate)| ConstraintRate { name: gear.name.clone(), speed: *rate, angular_speed: 0.0 }));
    all
}

/// Velocities (n_v) [rad/s], [m/s] that keep all loop joints and gears closed, nearest to those of a state by the
/// kinetic energy of the difference; none without loops.
#[must_use]
pub fn consistent_velocities(model: &Model<f64>, x: &State<f64>) -> Option<Vec<f64>> {
    let Loops(mut mechanism) = Loops::at(model, x)?;
    let change = mechanism.velocity_change_of_loops(&x.v);
    Some(x.v.iter().zip(&change).map(|(v, change)| v + change).collect())
}

/// Conflict of velocity motors without a torque limit with the loops, in a state with its commands; none if a motion
/// satisfies all.
#[must_use]
pub fn motor_conflict(model: &Model<f64>, x: &State<f64>) -> Option<MotorConflict> {
    let loops = Loops::at(model, x)?;
    let mut is_driven = vec![false; model.n_v()];
    let mut ideal = Vec::new();
    for drive in model.drives().iter().filter(|drive| model.drive_limit(drive).is_none()) {
        is_driven[drive.dof] = true;
        if let DriveKind::Motor(motor) = drive.kind {
            ideal.push((motor, drive.dof, model.target_velocity(drive, &x.q, &x.commands)));
        }
    }
    let mut unit = vec![0.0; model.n_v()];
    let mut column = |dof: usize| -> Vec<f64> {
        unit[dof] = 1.0;
        let column = loops.rows().map(|row| loops.rate(row, &unit)).collect();
        unit[dof] = 0.0;
        column
    };
    let free = Span::of((0..model.n_v()).filter(|dof| !is_driven[*dof]).map(&mut column).collect());
    let (mut motors, mut missing, mut size) = (Vec::new(), vec![0.0; loops.rows().len()], 0.0_f64);
    for (motor, dof, target) in ideal {
        let whole = column(dof);
        let left = free.remainder(whole.clone());
        if norm(&left) > DEPENDENT * norm(&whole) {
            motors.push(motor);
        }
        missing.iter_mut().zip(&left).for_each(|(sum, x)| *sum += x * target);
        size += norm(&whole) * target.abs();
    }
    let rate = missing.iter().fold(0.0_f64, |a, x| a.max(x.abs()));
    let opens = |row: usize| missing[row].abs() > DEPENDENT * size;
    (rate > DEPENDENT * size).then(|| MotorConflict { motors, constraints: loops.names(model, opens), rate })
}

/// Rows of all loop joints and gears at a configuration.
struct Loops(Mechanism<f64>);

impl Loops {
    /// None without loops.
    fn at(model: &Model<f64>, x: &State<f64>) -> Option<Self> {
        let (mut mechanism, _) = placed(model, x);
        if model.constraints().n_bilateral() == 0 || mechanism.constraints.is_none() {
            return None;
        }
        // every joint may move
        mechanism.drives.fill(1.0);
        mechanism.mark_locked();
        mechanism.place_loops(&x.v);
        Some(Self(mechanism))
    }

    fn rows(&self) -> std::ops::Range<usize> {
        0..self.0.constraints.as_deref().map_or(0, |c| c.n_free)
    }

    fn rate(&self, row: usize, v: &[f64]) -> f64 {
        self.0.constraints.as_deref().map_or(0.0, |c| c.motions.rate(&c.rows[row], v))
    }

    /// Names of the loop joints and gears that have one of these rows.
    fn names(&self, model: &Model<f64>, has: impl Fn(usize) -> bool) -> Vec<String> {
        let set = model.constraints();
        let joints = set.loop_joints.iter().map(|joint| (&joint.name, joint.kind.rows()));
        let all = joints.chain(set.gears.iter().map(|gear| (&gear.name, 1)));
        let mut first = 0;
        let with_rows = all.filter(|(_, n)| {
            first += n;
            (first - n..first).any(&has)
        });
        with_rows.map(|(name, _)| name.clone()).collect()
    }
}

/// Orthonormal basis of the span of columns.
struct Span(Vec<Vec<f64>>);

impl Span {
    /// Gram–Schmidt with pivoting.
    fn of(mut columns: Vec<Vec<f64>>) -> Self {
        let sizes: Vec<f64> = columns.iter().map(|column| norm(column)).collect();
        let mut span = Self(Vec::new());
        loop {
            let share = |k: &usize| norm(&columns[*k]) / sizes[*k];
            let left = (0..columns.len()).filter(|k| sizes[*k] > 0.0 && share(k) > DEPENDENT);
            let Some(best) = left.max_by(|a, b| share(a).total_cmp(&share(b))) else { return span };
            let size = norm(&columns[best]);
            let unit: Vec<f64> = columns[best].iter().map(|x| x / size).collect();
            columns.iter_mut().for_each(|column| remove(column, &unit));
            span.0.push(unit);
        }
    }

    /// Part of a column outside of the span.
    fn remainder(&self, mut column: Vec<f64>) -> Vec<f64> {
        self.0.iter().for_each(|unit| remove(&mut column, unit));
        column
    }
}

/// Removes from a column its part along a unit vector; twice, because the first pass leaves its rounding.
fn remove(column: &mut [f64], unit: &[f64]) {
    for _ in 0..2 {
        let along: f64 = column.iter().zip(unit).map(|(x, u)| x * u).sum();
        column.iter_mut().zip(unit).for_each(|(x, u)| *x -= along * u);
    }
}

fn norm(x: &[f64]) -> f64 {
    x.iter().map(|x| x * x).sum::<f64>().sqrt()
}
