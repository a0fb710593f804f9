//! World with the derivative of its motion along one direction: dual numbers through the integrators, with the jump of
//! the derivative where a joint bounces off its limit.
//!
//! Value and derivative are one dual number each: x = x̄ + ε·∂x/∂θ. Steps are those of plain numbers, because error
//! control sees values alone. At an impact the instant τ itself depends on θ. With the gap g(x) and its rate ġ < 0 just
//! before, ∂τ/∂θ = −(∂g/∂θ)/ġ at a fixed time; the state is carried to τ along the slope before the impact, jumps, and
//! is carried back along the slope after it (saltation; source: key `hiskens2000`).
//!
//! Drives without limit, locked degrees of freedom and coupled systems act as in a [`World`](crate::world::World).
//! Contacts, loops and everything that sticks or saturates do not belong here ([`obstacle_to_tangent`]).

use core::fmt;

use sincro_math::Dual;

use crate::actuation::DriveKind;
use crate::aero::rotor::SpeedSource;
use crate::coupled::{Coupled, CoupledSystem, StateView};
use crate::integrate::{Adaptive, Bracket, Control, Extrapolated, Failure, FixedStep, Rk4, System};
use crate::mechanism::Mechanism;
use crate::model::{Limit, Model};
use crate::state::State;
use crate::world::MethodKind;

/// Width to which the instant of an impact is located, relative to the step.
const RESOLUTION: f64 = 1e-13;
/// Times closer than this are the same instant `[s]`.
const SAME_INSTANT: f64 = 1e-9;
/// Maximum number of impacts in one tick; more are a joint that comes to rest.
const MAX_IMPACTS: usize = 100;
/// Number with one derivative.
type D = Dual<1>;

/// World on dual numbers: a motion and its derivative along one direction of the numbers of its model, initial state
/// and commands.
///
/// ```
/// use sincro_dynamics::coupled::NoCoupling;
/// use sincro_dynamics::integrate::Control;
/// use sincro_dynamics::prelude::*;
/// use sincro_dynamics::tangent::{TangentWorld, constant_state};
/// use sincro_math::Dual;
///
/// // a fall of 1 s: the derivative of the height by gravity is −t²/2
/// let falling = |gravity: f64| {
///     let mut builder = ModelBuilder::new([0.0, 0.0, -gravity]);
///     let slide = JointSpec::new(JointKind::Prismatic { axis: [0.0, 0.0, 1.0] });
///     let slide = builder.joint("slide", NodeId::WORLD, Pose::identity(), slide);
///     let mass = Shape::Sphere { radius: 0.1 }.mass_properties(1000.0);
///     builder.body("ball", slide, Pose::identity(), BodySpec { mass });
///     builder.build().unwrap().0
/// };
/// let models = [falling(9.81), falling(9.81 + 0.01), falling(9.81 - 0.01)];
/// let model = Model::<Dual<1>>::differentiated(&models.each_ref(), &|x| (x[1] - x[2]) / 0.02)?;
/// let state = constant_state(&State::new(&models[0]));
/// let method = (MethodKind::DormandPrince, Control::new(1e-10, 0.01));
/// let mut world = TangentWorld::new(&models[0], model, state, method, 0);
/// for tick in 0..10 {
///     world.advance(0.1 * f64::from(tick), 0.1, &mut NoCoupling)?;
/// }
/// assert!((world.state.q[0].partials[0] + 0.5).abs() < 1e-10); // [m/(m/s²)]
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
pub struct TangentWorld {
    /// State with its derivative; commands are those of the next step.
    pub state: State<D>,
    mechanism: Mechanism<D>,
    nominal: Model<f64>,
    method: Method,
    limits: Vec<Limit>,
    rest_speed: f64,
    y: Vec<D>,
    slope: Vec<D>,
    before: Vec<D>,
    base_before: Vec<D>,
    velocity_change: Vec<D>,
    negated_jacobian_diagonal: Vec<D>,
}

#[derive(Clone, Debug)]
enum Method {
    Rk4(Rk4<D>),
    Implicit(Extrapolated<D>),
    Adaptive(Adaptive<D>),
}

/// Reason for which a [`TangentWorld`] cannot go on.
#[derive(Clone, Debug, PartialEq)]
pub enum TangentStop {
    /// The integrator could not make a step.
    Integration(Failure),
    /// A joint comes to rest at its limit, where its motion is no longer that of the free joint.
    Rests {
        /// Name of the joint.
        joint: String,
        /// Time `[s]`.
        t: f64,
    },
}

impl fmt::Display for TangentStop {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Integration(failure) => failure.fmt(f),
            Self::Rests { joint, t } => write!(f, "joint `{joint}` comes to rest at its limit at t = {t} s"),
        }
    }
}

impl std::error::Error for TangentStop {}

impl From<Failure> for TangentStop {
    fn from(failure: Failure) -> Self {
        Self::Integration(failure)
    }
}

/// Element of a model, or the method, that keeps a [`TangentWorld`] from following it, as a sentence; `None` if there
/// is none. Limits of joints are no obstacle as long as the joints bounce off them.
#[must_use]
pub fn obstacle_to_tangent(model: &Model<f64>, method: MethodKind) -> Option<String> {
    let names = model.names();
    if let Some(drive) = model.drives().iter().find(|drive| model.drive_limit(drive).is_some()) {
        let joint = names.dof_name(drive.dof);
        return Some(match drive.kind {
            DriveKind::Friction => format!("joint `{joint}` has friction, which sticks and slips"),
            DriveKind::Motor(_) | DriveKind::Lock => format!("the motor of joint `{joint}` has a torque limit"),
        });
    }
    let set = model.constraints();
    if !set.pairs.is_empty() {
        return Some("bodies can touch".into());
    }
    if let Some(joint) = set.loop_joints.first() {
        return Some(format!("`{}` closes a loop", joint.name));
    }
    if let Some(gear) = set.gears.first() {
        return Some(format!("`{}` couples joints", gear.name));
    }
    if model.rotors().iter().any(|rotor| matches!(rotor.speed, SpeedSource::Particles { .. })) {
        return Some("a rotor throws particles".into());
    }
    (method == MethodKind::SemiImplicitEuler).then(|| "the method is semi-implicit Euler".into())
}

/// State in dual numbers without derivatives.
#[must_use]
pub fn constant_state(state: &State<f64>) -> State<D> {
    let cast = |list: &[f64]| list.iter().map(|x| D::constant(*x)).collect::<Vec<D>>();
    State {
        q: cast(&state.q),
        v: cast(&state.v),
        commands: cast(&state.commands),
        drives: cast(&state.drives),
        contacts: Vec::new(),
        totals: cast(&state.totals),
        rotors: cast(&state.rotors),
        tick: state.tick,
    }
}

impl TangentWorld {
    /// Creates the world of `model`, whose values are those of `nominal` ([`Model::differentiated`]), in `state`, to be
    /// integrated by a method with its step-size control together with `n_coupled` states of a coupled system.
    ///
    /// # Panics
    ///
    /// If there is an obstacle ([`obstacle_to_tangent`]).
    #[must_use]
    pub fn new(
        nominal: &Model<f64>,
        model: Model<D>,
        state: State<D>,
        (method, control): (MethodKind, Control),
        n_coupled: usize,
    ) -> Self {
        assert!(obstacle_to_tangent(nominal, method).is_none(), "a motion without derivative");
        let mechanism = Mechanism::new(model, true);
        let (n_q, n_v) = (mechanism.model().n_q(), mechanism.model().n_v());
        let dim = mechanism.dim() + n_coupled;
        let zeros = |n: usize| vec![D::constant(0.0); n];
        let set = nominal.constraints();
        Self {
            state,
            nominal: nominal.clone(),
            method: Method::new(method, dim, control),
            limits: set.limits.clone(),
            rest_speed: set.rest_speed,
            y: zeros(dim),
            slope: zeros(dim),
            before: zeros(dim),
            base_before: zeros(n_q),
            velocity_change: zeros(n_v),
            negated_jacobian_diagonal: zeros(n_coupled),
            mechanism,
        }
    }

    /// Advances by one base step from `t` by `h` `[s]`, with `system` integrated along, which has as many states as
    /// there is room for.
    ///
    /// # Errors
    ///
    /// [`TangentStop`]: the integrator fails, or a joint comes to rest at its limit.
    pub fn advance(&mut self, t: f64, h: f64, system: &mut dyn CoupledSystem<D>) -> Result<(), TangentStop> {
        system.set_time_event(f64::INFINITY);
        self.load(system);
        self.jump_to_targets(h);
        self.sub_steps(t, h, system)?;
        self.mechanism.store(&self.y, &mut self.state);
        system.states().copy_from_slice(&self.y[self.mechanism.dim()..]);
        self.state.tick += 1;
        Ok(())
    }

    /// Evaluates the equations of motion in the present state at time `t` `[s]`: `system` is asked for commands and
    /// slopes, with the accelerations that follow.
    pub fn evaluate(&mut self, t: f64, system: &mut dyn CoupledSystem<D>) {
        self.load(system);
        self.mechanism.mark_locked();
        self.find_slope(t, system);
    }

    /// State as sensors and controllers see it at time `t` `[s]`.
    #[must_use]
    pub fn view(&mut self, t: f64) -> StateView<'_, D> {
        let State { q, v, rotors, commands, .. } = &self.state;
        let Mechanism { model, scratch, .. } = &mut self.mechanism;
        StateView { t, model, q, v, rotors, commands, scratch }
    }

    fn load(&mut self, system: &mut dyn CoupledSystem<D>) {
        self.mechanism.load(&self.state, &mut self.y);
        self.y[self.mechanism.dim()..].copy_from_slice(system.states());
    }

    /// Brings motors without limit to their target velocities of this tick of length `h` `[s]`.
    fn jump_to_targets(&mut self, h: f64) {
        if self.mechanism.drives.is_empty() {
            return;
        }
        self.mechanism.drives.fill(D::constant(0.0));
        self.mechanism.mark_locked();
        let velocities = self.mechanism.layout().velocities();
        for i in 0..self.mechanism.drives.len() {
            let dof = self.mechanism.model.params.drives[i].dof;
            self.mechanism.prescribed_acceleration[dof] = self.target_velocity(i, h) - self.y[velocities.start + dof];
        }
        self.apply_impulse();
        for i in 0..self.mechanism.drives.len() {
            let dof = self.mechanism.model.params.drives[i].dof;
            self.y[velocities.start + dof] = self.target_velocity(i, h);
        }
    }

    fn target_velocity(&self, drive: usize, h: f64) -> D {
        let Mechanism { model, commands, .. } = &self.mechanism;
        model.target_velocity_within(&model.params.drives[drive], self.mechanism.base(), commands, h)
    }

    /// Applies the impulses that bring about the prescribed changes of velocity, and adds those of motors to their
    /// totals.
    fn apply_impulse(&mut self) {
        let layout = self.mechanism.layout();
        self.mechanism.impulse(&mut self.velocity_change);
        for (v, change) in self.y[layout.velocities()].iter_mut().zip(&self.velocity_change) {
            *v += *change;
        }
        for drive in &self.mechanism.model.params.drives {
            if let DriveKind::Motor(motor) = drive.kind {
                self.y[layout.motor_impulse(motor)] += self.mechanism.scratch.reaction[drive.dof];
            }
        }
    }

    fn sub_steps(&mut self, start: f64, span: f64, system: &mut dyn CoupledSystem<D>) -> Result<(), TangentStop> {
        let (mut t, end, mut impacts) = (start, start + span, 0);
        while t < end {
            let of_system = system.next_time_event(t);
            let corner = self.nominal.next_time_event(t).min(of_system).min(end);
            system.set_time_event(if of_system <= corner + SAME_INSTANT { corner } else { f64::INFINITY });
            let h_max = if t == start && corner == end { span } else { corner - t };
            self.mechanism.mark_locked();
            self.before.copy_from_slice(&self.y);
            self.base_before.copy_from_slice(self.mechanism.base());
            let control = self.method.control();
            let h = self.method_step(t, h_max, system)?;
            if !self.y.iter().all(|x| x.value.is_finite()) {
                return Err(Failure::NotFinite { t }.into());
            }
            let reached = if h >= h_max { corner } else { t + h };
            let impact = self.find_impact(t, h, control, system)?;
            t = match impact {
                None => reached,
                Some((at, limit)) => {
                    impacts += 1;
                    self.impact(t + at, limit, impacts, system)?;
                    t + at
                }
            };
        }
        Ok(())
    }

    fn method_step(&mut self, t: f64, h_max: f64, system: &mut dyn CoupledSystem<D>) -> Result<f64, Failure> {
        let negated_jacobian_diagonal = &mut self.negated_jacobian_diagonal[..];
        let system = &mut Coupled { mechanism: &mut self.mechanism, system, negated_jacobian_diagonal };
        match &mut self.method {
            Method::Rk4(method) => method.step(system, t, h_max, &mut self.y),
            Method::Implicit(method) => method.step(system, t, h_max, &mut self.y),
            Method::Adaptive(method) => return method.step(system, t, h_max, &mut self.y),
        }
        Ok(h_max)
    }

    /// Slope f(t, y) under the modes last marked.
    fn find_slope(&mut self, t: f64, system: &mut dyn CoupledSystem<D>) {
        let negated_jacobian_diagonal = &mut self.negated_jacobian_diagonal[..];
        let system = &mut Coupled { mechanism: &mut self.mechanism, system, negated_jacobian_diagonal };
        system.slope(t, &self.y, &mut self.slope);
    }

    /// Distance of a joint from its limit; negative beyond it.
    fn gap(&self, limit: &Limit) -> D {
        D::constant(limit.sign) * (self.mechanism.base()[limit.coordinate] - D::constant(limit.bound))
    }

    /// Goes to the first impact within the step from `t` of length `h` that was just made, if there is one; returns its
    /// time after `t` `[s]` and the index of the limit.
    fn find_impact(
        &mut self,
        t: f64,
        h: f64,
        control: Option<Control>,
        system: &mut dyn CoupledSystem<D>,
    ) -> Result<Option<(f64, usize)>, Failure> {
        let Some(mut limit) = self.furthest_beyond() else { return Ok(None) };
        let after = -self.gap(&self.limits[limit]).value;
        let mut bracket = Bracket::new((0.0, h), (f64::NAN, after));
        while bracket.width() > RESOLUTION * h {
            let at = bracket.next(RESOLUTION * h);
            self.repeat(t, at, control, system)?;
            let beyond = self.furthest_beyond();
            if let Some(other) = beyond.filter(|other| *other != limit) {
                limit = other;
                bracket.change_crossing(f64::NAN, f64::NAN);
            }
            bracket.take(at, beyond.is_some(), -self.gap(&self.limits[limit]).value);
        }
        self.repeat(t, bracket.after(), control, system)?;
        Ok(Some((bracket.after(), limit)))
    }

    /// Limit that a joint is furthest beyond, and moves further.
    fn furthest_beyond(&self) -> Option<usize> {
        let velocities = self.mechanism.layout().velocities();
        let depth = |k: &usize| -self.gap(&self.limits[*k]).value;
        let is_beyond = |k: &usize| {
            let limit = &self.limits[*k];
            depth(k) > 0.0 && limit.sign * self.y[velocities.start + limit.dof].value <= 0.0
        };
        (0..self.limits.len()).filter(is_beyond).max_by(|a, b| depth(a).total_cmp(&depth(b)))
    }

    /// Repeats the integration from the start of the sub-step, exactly `h` further.
    fn repeat(
        &mut self,
        t: f64,
        h: f64,
        control: Option<Control>,
        system: &mut dyn CoupledSystem<D>,
    ) -> Result<(), Failure> {
        self.y.copy_from_slice(&self.before);
        self.mechanism.set_base(&self.base_before);
        self.method.set_control(control);
        let mut done = 0.0;
        while done < h {
            let step = self.method_step(t + done, h - done, system)?;
            done = if step >= h - done { h } else { done + step };
        }
        Ok(())
    }

    /// Impact on a limit at time `t`, Newton's law of restitution, with the jump of the derivatives.
    fn impact(
        &mut self,
        t: f64,
        limit: usize,
        n_impacts: usize,
        system: &mut dyn CoupledSystem<D>,
    ) -> Result<(), TangentStop> {
        let limit = self.limits[limit].clone();
        let at = self.mechanism.layout().velocities().start + limit.dof;
        let approach = limit.sign * self.y[at].value;
        if limit.restitution == 0.0 || approach >= -self.rest_speed || n_impacts > MAX_IMPACTS {
            let joint = self.mechanism.model.names().dof_name(limit.dof).to_owned();
            return Err(TangentStop::Rests { joint, t });
        }
        let delay = -self.gap(&limit).partials[0] / approach;
        self.find_slope(t, system);
        self.shift(delay);
        self.mechanism.mark_locked();
        self.mechanism.locked_mask[limit.dof] = D::constant(1.0);
        self.mechanism.prescribed_acceleration[limit.dof] = D::constant(-1.0 - limit.restitution) * self.y[at];
        self.apply_impulse();
        self.mechanism.mark_locked();
        self.find_slope(t, system);
        self.shift(-delay);
        Ok(())
    }

    /// Moves the derivatives of the state by `delay` `[s]` per unit of what is differentiated by, along the slope.
    fn shift(&mut self, delay: f64) {
        for (y, slope) in self.y.iter_mut().zip(&self.slope) {
            y.partials[0] += slope.value * delay;
        }
        let n = self.mechanism.dim();
        self.mechanism.rechart(&mut self.y[..n]);
    }
}

impl Method {
    fn new(kind: MethodKind, dim: usize, control: Control) -> Self {
        match (kind, kind.adaptive()) {
            (_, Some(adaptive)) => Self::Adaptive(Adaptive::new(adaptive, dim, control)),
            (MethodKind::Rk4, _) => Self::Rk4(Rk4::new(dim)),
            (MethodKind::Implicit, _) => Self::Implicit(Extrapolated::new(dim, 2, Control::new(1.0, 1.0))),
            _ => panic!("it has no derivative here"),
        }
    }

    fn control(&self) -> Option<Control> {
        match self {
            Self::Rk4(_) | Self::Implicit(_) => None,
            Self::Adaptive(method) => Some(method.control()),
        }
    }

    fn set_control(&mut self, control: Option<Control>) {
        if let (Self::Adaptive(method), Some(control)) = (self, control) {
            method.set_control(control);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::coupled::NoCoupling;
    use crate::prelude::*;

    const TICK: f64 = 0.02;
    /// Difference that the numbers of models are differentiated by, and that of runs, relative.
    const WIDTH: f64 = 1e-3;

    /// A rod on a motor and a spring, with a ball that slides along it between two limits.
    fn machine(stiffness: f64, mass: f64) -> Model<f64> {
        let mut builder = ModelBuilder::new([0.0, 0.0, -9.81]);
        let hinge = JointKind::Revolute { axis: [0.0, 1.0, 0.0] };
        let motor =
            JointSpec { armature: vec![1e-3], motor: vec![Motor::new(MotorMode::Velocity)], ..JointSpec::new(hinge) };
        let motor = builder.joint("motor", NodeId::WORLD, Pose::identity(), motor);
        let spring = JointSpec { spring: vec![(stiffness, 0.0)], damping: vec![0.2], ..JointSpec::new(hinge) };
        let spring = builder.joint("spring", motor, Pose::identity(), spring);
        let rod =
            MassProperties { mass: 1.5, center_of_mass: [0.3, 0.0, 0.0], inertia: [0.01, 0.0, 0.0, 0.05, 0.0, 0.05] };
        builder.body("rod", spring, Pose::identity(), BodySpec { mass: rod });
        let slide = JointSpec {
            limits: vec![(-0.1, 0.1)],
            limit_restitution: 0.8,
            ..JointSpec::new(JointKind::Prismatic { axis: [1.0, 0.0, 0.0] })
        };
        let slide = builder.joint("slide", spring, Pose::translation(Vec3([0.4, 0.0, 0.0])), slide);
        let ball = MassProperties { mass, center_of_mass: [0.0; 3], inertia: [1e-3, 0.0, 0.0, 1e-3, 0.0, 1e-3] };
        builder.body("ball", slide, Pose::identity(), BodySpec { mass: ball });
        builder.build().unwrap().0
    }

    fn command(tick: u32) -> f64 {
        if tick < 10 { 0.5 } else { -1.2 }
    }

    /// Coordinates, velocities and motor impulse at the end of a plain run, and its number of impacts.
    fn plain(model: &Model<f64>, n_ticks: u32) -> (Vec<f64>, u64) {
        let mut world = World::new(model.clone(), start(model), MethodKind::DormandPrince, 1e-13, 1e-4);
        world.initialize(0.0);
        for tick in 0..n_ticks {
            world.state.commands[0] = command(tick);
            world.advance(f64::from(tick) * TICK, TICK).unwrap();
        }
        let State { q, v, totals, .. } = &world.state;
        ([&q[..], v, &totals[2..]].concat(), world.statistics().impacts)
    }

    fn start(model: &Model<f64>) -> State<f64> {
        State { q: vec![0.0, 0.2, 0.02], v: vec![0.0, 0.0, 2.5], ..State::new(model) }
    }

    /// Largest error of the derivatives by one parameter against central differences of plain runs with Richardson's
    /// extrapolation, relative to the largest derivative.
    fn error(of: impl Fn(f64) -> Model<f64>, at: f64, n_ticks: u32) -> f64 {
        let h = WIDTH * at;
        let models = [of(at), of(at + h), of(at - h)];
        let model = Model::<D>::differentiated(&models.each_ref(), &|x| (x[1] - x[2]) / (2.0 * h)).unwrap();
        let method = (MethodKind::DormandPrince, Control::new(1e-13, 1e-4));
        let mut tangent = TangentWorld::new(&models[0], model, constant_state(&start(&models[0])), method, 0);
        for tick in 0..n_ticks {
            tangent.state.commands[0] = D::constant(command(tick));
            tangent.advance(f64::from(tick) * TICK, TICK, &mut NoCoupling).unwrap();
        }
        let State { q, v, totals, .. } = &tangent.state;
        let found = [&q[..], v, &totals[2..]].concat();
        let central = |h: f64| -> Vec<f64> {
            let (up, down) = (plain(&of(at + h), n_ticks), plain(&of(at - h), n_ticks));
            assert_eq!(up.1, down.1, "as many impacts on both sides");
            up.0.iter().zip(&down.0).map(|(a, b)| (a - b) / (2.0 * h)).collect()
        };
        let (wide, narrow) = (central(0.2 * h), central(0.1 * h));
        let expected: Vec<f64> = narrow.iter().zip(&wide).map(|(n, w)| n + (n - w) / 3.0).collect();
        let largest = expected.iter().fold(0.0_f64, |a, x| a.max(x.abs()));
        found.iter().zip(&expected).map(|(a, b)| (a.partials[0] - b).abs()).fold(0.0, f64::max) / largest
    }

    #[test]
    fn derivatives_are_those_of_plain_runs_also_across_impacts() {
        let n_ticks = 40;
        let n_impacts = plain(&machine(30.0, 0.4), n_ticks).1;
        assert!(n_impacts >= 3, "the ball bounces {n_impacts} times");
        let by_stiffness = error(|k| machine(k, 0.4), 30.0, n_ticks);
        let by_mass = error(|m| machine(30.0, m), 0.4, n_ticks);
        println!("relative error by stiffness {by_stiffness:.1e}, by mass {by_mass:.1e}");
        assert!(by_stiffness < 1e-7 && by_mass < 1e-7, "{by_stiffness} {by_mass}");
    }

    #[test]
    fn values_are_those_of_a_plain_run() {
        let model = machine(30.0, 0.4);
        let dual = Model::<D>::differentiated(&[&model, &model], &|_| 0.0).unwrap();
        let method = (MethodKind::DormandPrince, Control::new(1e-13, 1e-4));
        let mut tangent = TangentWorld::new(&model, dual, constant_state(&start(&model)), method, 0);
        for tick in 0..5 {
            tangent.state.commands[0] = D::constant(command(tick));
            tangent.advance(f64::from(tick) * TICK, TICK, &mut NoCoupling).unwrap();
        }
        let plain = plain(&model, 5).0;
        for (a, b) in tangent.state.q.iter().chain(&tangent.state.v).zip(&plain) {
            assert!((a.value - b).abs() < 1e-11, "{a:?} {b}");
        }
    }

    #[test]
    fn a_joint_that_comes_to_rest_at_its_limit_is_refused() {
        let model = machine(30.0, 0.4);
        let dual = Model::<D>::differentiated(&[&model, &model], &|_| 0.0).unwrap();
        let method = (MethodKind::DormandPrince, Control::new(1e-10, 1e-4));
        let mut state = start(&model);
        (state.q[2], state.v[2]) = (0.1, 0.0);
        state.q[1] = 1.2; // steep: gravity presses the ball against its limit
        let mut tangent = TangentWorld::new(&model, dual, constant_state(&state), method, 0);
        let stop = (0..50).find_map(|k| tangent.advance(f64::from(k) * TICK, TICK, &mut NoCoupling).err());
        assert!(matches!(stop, Some(TangentStop::Rests { joint, .. }) if joint == "slide"));
    }
}
