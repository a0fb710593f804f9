//! Consistency of initial velocities: rates at which they open loop joints and gears, and velocity motors without a
//! torque limit whose targets contradict the loops.

use sincro_math::orthogonalization::{norm, remove};

use super::placed;
use crate::actuation::DriveKind;
use crate::ids::MotorId;
use crate::mechanism::Mechanism;
use crate::model::Model;
use crate::state::State;
use crate::world::audit::Scales;

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
    /// The larger of the two relative to the velocities and the extent of the mechanism, as the audit of a run has it
    /// (dimensionless).
    pub relative: f64,
}

/// Velocity motors without a torque limit whose targets no motion of the mechanism satisfies.
#[derive(Clone, Debug, PartialEq)]
pub struct MotorConflict {
    /// The motors that no motion can satisfy together.
    pub motors: Vec<MotorId>,
    /// Loop joints and gears that open if all motors have their targets, with the rates at which they do.
    pub opened: Vec<ConstraintRate>,
}

impl MotorConflict {
    /// Names of the joints of the motors.
    #[must_use]
    pub fn joints<'a>(&self, model: &'a Model<f64>) -> Vec<&'a str> {
        let joints = model.names().joints.iter();
        let driven = joints.filter(|joint| joint.motors().any(|motor| self.motors.contains(&motor)));
        driven.map(|joint| joint.name.as_str()).collect()
    }
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
/// builder.gear("gear", GearSpec { joints, ratio: -0.25, offset: 0.0, higher: [0.0; 3] });
/// let (model, _warnings) = builder.build()?;
/// let state = State { v: vec![4.0, 0.0], ..State::new(&model) };
/// assert_eq!(constraint_rates(&model, &state)[0].speed, 1.0); // the wheel should turn at −1 rad/s
/// # Ok::<(), BuildError>(())
/// ```
#[must_use]
pub fn constraint_rates(model: &Model<f64>, x: &State<f64>) -> Vec<ConstraintRate> {
    let Some(loops) = Loops::at(model, x) else { return Vec::new() };
    by_constraint(model, &loops.rates(&x.v), &Scales::of(&x.v, &loops.0.scratch))
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
    let (mut ideal, mut targets) = (Vec::new(), vec![0.0; model.n_v()]);
    for drive in model.drives().iter().filter(|drive| model.drive_limit(drive).is_none()) {
        is_driven[drive.dof] = true;
        if let DriveKind::Motor(motor) = drive.kind {
            let target = model.target_velocity(drive, &x.q, &x.commands);
            targets[drive.dof] = target;
            ideal.push((motor, drive.dof, target));
        }
    }
    let mut unit = vec![0.0; model.n_v()];
    let mut column = |dof: usize| -> Vec<f64> {
        unit[dof] = 1.0;
        let column = loops.rates(&unit);
        unit[dof] = 0.0;
        column
    };
    let free = Span::of((0..model.n_v()).filter(|dof| !is_driven[*dof]).map(&mut column).collect());
    // what the targets ask of the loops beyond what the other joints can do
    let (mut missing, mut tolerance, mut asked) = (loops.rates(&vec![0.0; model.n_v()]), 0.0_f64, Vec::new());
    for (motor, dof, target) in ideal {
        let whole = column(dof);
        let least = DEPENDENT * norm(&whole);
        let left = free.remainder(whole);
        missing.iter_mut().zip(&left).for_each(|(sum, x)| *sum += x * target);
        tolerance += least * target.abs();
        asked.push((motor, left, least));
    }
    let has_part = |left: &[f64], least: f64| {
        left.iter().zip(&missing).any(|(x, missing)| missing.abs() > tolerance && x.abs() > least)
    };
    let of_conflict = asked.iter().filter(|(_, left, least)| has_part(left, *least));
    let motors: Vec<MotorId> = of_conflict.map(|(motor, ..)| *motor).collect();
    let is_open = |rate: &ConstraintRate| rate.speed.max(rate.angular_speed) > tolerance;
    let rates = by_constraint(model, &missing, &Scales::of(&targets, &loops.0.scratch));
    let opened = rates.into_iter().filter(is_open).collect();
    (!motors.is_empty()).then_some(MotorConflict { motors, opened })
}

/// Rates of the rows, in their order, by the loop joint or gear that they belong to.
fn by_constraint(model: &Model<f64>, rates: &[f64], scales: &Scales) -> Vec<ConstraintRate> {
    let set = model.constraints();
    let largest = |rates: &[f64]| rates.iter().fold(0.0_f64, |largest, rate| largest.max(rate.abs()));
    let mut rest = rates;
    let mut take = |n: usize| {
        let (own, others) = rest.split_at(n.min(rest.len()));
        rest = others;
        own
    };
    let mut all = Vec::new();
    for joint in &set.loop_joints {
        let n = joint.kind.n_translations();
        let (speed, angular_speed) = (largest(take(n)), largest(take(joint.kind.rows() - n)));
        let relative = (speed / scales.linear_speed).max(angular_speed / scales.speed);
        all.push(ConstraintRate { name: joint.name.clone(), speed, angular_speed, relative });
    }
    for gear in &set.gears {
        let speed = largest(take(1));
        let (angular_speed, relative) = (0.0, speed / scales.speed);
        all.push(ConstraintRate { name: gear.name.clone(), speed, angular_speed, relative });
    }
    all
}

/// Rows of all loop joints and gears at a configuration.
struct Loops(Mechanism<f64>);

impl Loops {
    /// None without loops.
    fn at(model: &Model<f64>, x: &State<f64>) -> Option<Self> {
        if model.constraints().n_bilateral() == 0 {
            return None;
        }
        let (mut mechanism, _) = placed(model, x);
        mechanism.unlock_joints();
        mechanism.place_loops(&x.v);
        Some(Self(mechanism))
    }

    /// Rates of the rows for joint velocities (n_v).
    fn rates(&self, v: &[f64]) -> Vec<f64> {
        let constraints = self.0.constraints.as_deref();
        constraints.map_or_else(Vec::new, |c| c.rows[..c.n_free].iter().map(|row| c.motions.rate(row, v)).collect())
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
