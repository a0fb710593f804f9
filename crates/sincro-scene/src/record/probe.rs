//! One measurement, on any kind of number: what is recorded, what a diagram sees at ticks and between, what is
//! linearised.

use sincro_dynamics::actuation::MotorMode;
use sincro_dynamics::aero::rotor::{Hub, Load, Validity};
use sincro_dynamics::coupled::{MechanismResponse, StateView};
use sincro_dynamics::energy::{Energy, energy, momentum};
use sincro_dynamics::ids::BodyId;
use sincro_dynamics::kinematics::{self, Attached};
use sincro_dynamics::model::Model;
use sincro_dynamics::scratch::Scratch;
use sincro_dynamics::spatial::{Mat3, Pose, Quat, Vec3};
use sincro_dynamics::state::State;
use sincro_dynamics::world::Observation;
use sincro_math::{Real, Task};

use super::{
    BushingQuantity, EnergyQuantity, FrameQuantity, GearQuantity, LineQuantity, Probe, RotorQuantity, WindingQuantity,
};

/// State at which a [`Probe`] is evaluated, in any number type; lists have the order of the model's state.
#[derive(Clone, Copy, Debug)]
pub struct View<'a, R> {
    /// Time `[s]`.
    pub t: f64,
    /// Model of the state.
    pub model: &'a Model<R>,
    /// Generalized coordinates, `n_q`: `[rad]`, `[m]`.
    pub q: &'a [R],
    /// Generalized velocities, `n_v`: `[rad/s]`, `[m/s]`.
    pub v: &'a [R],
    /// States of rotors with a lag, [`State::rotors`].
    pub rotors: &'a [R],
    /// Latched commands, in the units of their actuators; empty where they are not known yet.
    pub commands: &'a [R],
    /// Scratch with the kinematics at (q, v), for probes that need them ([`needs_kinematics`]).
    pub scratch: &'a Scratch<R>,
}

impl<'a, R> View<'a, R> {
    /// Creates the view of the state that a coupled system, such as a diagram, is given at ticks and between them.
    pub fn of(seen: &'a StateView<'_, R>) -> Self {
        let &StateView { t, model, q, v, rotors, commands, ref scratch } = seen;
        Self { t, model, q, v, rotors, commands, scratch }
    }
}

impl<'a> View<'a, f64> {
    /// Creates the view of an observed world at time `t` `[s]`.
    pub fn observed(seen: &'a Observation<'_>, t: f64) -> Self {
        let State { q, v, rotors, commands, .. } = seen.state;
        Self { t, model: seen.model(), q, v, rotors, commands, scratch: seen.scratch() }
    }
}

/// Returns true if a probe needs the poses and twists of links in [`View::scratch`].
pub fn needs_kinematics(probe: Probe) -> bool {
    matches!(
        probe,
        Probe::Frame(..)
            | Probe::Energy(_)
            | Probe::Momentum(_)
            | Probe::Rotor(..)
            | Probe::Drag(..)
            | Probe::SpringDamper(..)
            | Probe::Bushing(..)
    )
}

/// Returns the value, in SI units, of a measurement that is a function of the state alone; `None` for one that depends
/// on accelerations or is known at ticks only. For probes that need it, `at.scratch` must hold the kinematics.
///
/// # Panics
///
/// If an index of the probe does not exist in the model.
pub fn of_state<R: Real>(at: &View<'_, R>, probe: Probe) -> Option<R> {
    R::run_lanes(OfState { at, probe })
}

/// Task of [`of_state`].
struct OfState<'a, 'b, R> {
    at: &'a View<'b, R>,
    probe: Probe,
}

impl<R: Real> Task for OfState<'_, '_, R> {
    type Output = Option<R>;

    #[inline(always)]
    fn run(self) -> Option<R> {
        let Self { at, probe } = self;
        let model = at.model;
        Some(match probe {
            Probe::Coordinate(i) => at.q[i],
            Probe::Rate(k) => at.v[k],
            Probe::SpringTorque(k) => model.spring_torque(k, at.q),
            Probe::DampingTorque(k) => model.damping_torque(k, at.q, at.v),
            Probe::AppliedTorque(k) => model.applied_torque(k, at.t),
            Probe::Frame(quantity, frame, component) => of_frame(at, quantity, frame, component),
            Probe::Energy(EnergyQuantity::Kinetic) => stored(at).kinetic,
            Probe::Energy(EnergyQuantity::Potential) => stored(at).potential,
            Probe::Energy(EnergyQuantity::Total) => stored(at).total(),
            Probe::Momentum(k) => {
                let momentum = momentum(model, at.scratch);
                if k < 3 { momentum.ang[k] } else { momentum.lin[k - 3] }
            }
            Probe::Rotor(quantity, k) if depends_on_command(model, quantity, k) => return None,
            Probe::SpringDamper(quantity, k) if has_actuated_force(model, quantity, k) => return None,
            Probe::Winding(quantity, k) if has_commanded_circuit(model, quantity, k) => return None,
            Probe::Rotor(..) | Probe::Drag(..) | Probe::SpringDamper(..) | Probe::Bushing(..) | Probe::Winding(..) => {
                R::run_part(OfElement { at, probe })
            }
            Probe::ElasticGear(quantity, k) => {
                let gear = &model.elastic_gears()[k];
                let (x, rate) = gear.error(at.q, at.v);
                if quantity == GearQuantity::MeshError { x } else { gear.torque(x, rate) }
            }
            Probe::Activation(k) => {
                let activation = &model.activations()[k];
                activation.saturated(at.rotors[activation.state])
            }
            Probe::Wind(k) => {
                let wind = model.wind()?;
                wind.velocity(at.t, R::splat(wind.reference_height().unwrap_or(0.0)))[k]
            }
            _ => return None,
        })
    }
}

/// Measurement of an element: rotor, drag, spring and damper, bushing or winding.
struct OfElement<'a, 'b, R> {
    at: &'a View<'b, R>,
    probe: Probe,
}

impl<R: Real> Task for OfElement<'_, '_, R> {
    type Output = R;

    #[inline(always)]
    fn run(self) -> R {
        let Self { at, probe } = self;
        match probe {
            Probe::Rotor(quantity, k) => of_rotor(at, quantity, k),
            Probe::Drag(k, component) => drag(at, k)[component],
            Probe::SpringDamper(quantity, k) => of_line(at, quantity, k),
            Probe::Bushing(quantity, k, component) => of_bushing(at, quantity, k, component),
            Probe::Winding(quantity, k) => of_winding(at, quantity, k),
            _ => unreachable!("no element"),
        }
    }
}

/// Returns the value, in SI units, of a measurement that depends on accelerations or commands; `None` for others.
/// `at.scratch` must hold the kinematics with the accelerations.
///
/// # Panics
///
/// If an index of the probe does not exist in the model.
pub fn of_response<R: Real>(at: &View<'_, R>, response: MechanismResponse<'_, R>, probe: Probe) -> Option<R> {
    Some(match probe {
        Probe::Acceleration(k) => response.accelerations[k],
        Probe::MotorTorqueNow(m) => response.motor_torque[m],
        Probe::Rotor(..) | Probe::SpringDamper(..) | Probe::Winding(..) => R::run_part(OfElement { at, probe }),
        Probe::Frame(FrameQuantity::Acceleration, frame, k) => {
            kinematics::frame_acceleration(at.scratch, &attached(at.model, frame)).lin[k]
        }
        _ => return None,
    })
}

/// Returns true if the load of a rotor depends on its present command.
pub(crate) fn depends_on_command<R: Real>(model: &Model<R>, quantity: RotorQuantity, rotor: usize) -> bool {
    quantity != RotorQuantity::Speed && model.rotors()[rotor].speed.follows_at_once()
}

/// Returns the speed of rotor `k` `[rad/s]`, its aerodynamic load, and the motion of its hub through the air.
/// `at.scratch` must hold the kinematics.
///
/// # Panics
///
/// If `k` is not below the number of the model's rotors.
#[inline(always)]
pub fn rotor<'a, R: Real>(at: &View<'a, R>, k: usize) -> (R, Load<R>, Hub<'a, R>) {
    let rotor = &at.model.rotors()[k];
    let speed = rotor.speed.value(at.v, at.commands, at.rotors);
    let air = at.model.wind().map(|wind| wind.at(at.t));
    let hub = rotor.hub(&at.scratch.twist(rotor.link), &at.scratch.link_poses()[rotor.link], air.as_ref());
    (speed, rotor.load(speed, at.rotors, &hub), hub)
}

#[inline(always)]
fn of_rotor<R: Real>(at: &View<'_, R>, quantity: RotorQuantity, k: usize) -> R {
    if quantity == RotorQuantity::Speed {
        return at.model.rotors()[k].speed.value(at.v, at.commands, at.rotors);
    }
    let (speed, load, hub) = rotor(at, k);
    match quantity {
        RotorQuantity::Speed => speed,
        RotorQuantity::Thrust => load.thrust,
        RotorQuantity::Torque => load.torque,
        RotorQuantity::Inflow => load.inflow,
        RotorQuantity::Power => load.power,
        RotorQuantity::Valid => {
            let rotor = &at.model.rotors()[k];
            R::from_lanes(|lane| f64::from(rotor.validity(speed, &hub, &load, lane) == Validity::Valid))
        }
    }
}

/// Returns the force of drag element `k` on its body in world axes `[N]`. `at.scratch` must hold the kinematics.
///
/// # Panics
///
/// If `k` is not below the number of the model's drag elements.
#[inline(always)]
pub fn drag<R: Real>(at: &View<'_, R>, k: usize) -> Vec3<R> {
    let drag = &at.model.drags()[k];
    let x_wl = &at.scratch.link_poses()[drag.link];
    let air = at.model.wind().map(|wind| wind.at(at.t));
    let force = drag.resistance(drag.velocity(&at.scratch.twist(drag.link), x_wl, air.as_ref()), x_wl).force;
    x_wl.rot.mul_vec(drag.pose.rot.mul_vec(force))
}

/// Returns true for the force of a spring and damper with an actuator, which depends on its present command: not where
/// it has an activation.
pub(crate) fn has_actuated_force<R: Real>(model: &Model<R>, quantity: LineQuantity, k: usize) -> bool {
    let is_direct = |command: usize| model.activations().iter().all(|own| own.command != command);
    quantity == LineQuantity::Force && model.spring_dampers()[k].actuator.is_some_and(|own| is_direct(own.command))
}

/// Returns true for a quantity of a winding that depends on its present command: all but the back-EMF, and the current
/// where it is a state; none where the motor has an activation.
pub(crate) fn has_commanded_circuit<R: Real>(model: &Model<R>, quantity: WindingQuantity, k: usize) -> bool {
    match quantity {
        WindingQuantity::BackEmf => false,
        WindingQuantity::Current if model.windings()[k].state.is_some() => false,
        WindingQuantity::Current | WindingQuantity::Voltage | WindingQuantity::ElectricalPower => {
            let winding = &model.windings()[k];
            model.activations().iter().all(|own| own.command != winding.motor)
        }
    }
}

#[inline(always)]
fn of_winding<R: Real>(at: &View<'_, R>, quantity: WindingQuantity, k: usize) -> R {
    let winding = &at.model.windings()[k];
    let v = at.v[winding.dof];
    // in another mode the command is no voltage; of the state alone there is none
    let is_active = at.model.motors()[winding.motor].mode == MotorMode::Voltage;
    let command = if is_active { at.model.actuation(winding.motor, at.commands, at.rotors) } else { R::zero() };
    let current = match winding.state {
        Some(k) => at.rotors[k],
        None if is_active => winding.current(R::zero(), v, command),
        None => R::zero(),
    };
    match quantity {
        WindingQuantity::Current => current,
        WindingQuantity::Voltage => winding.voltage(command),
        WindingQuantity::BackEmf => winding.back_emf(v),
        WindingQuantity::ElectricalPower => winding.voltage(command) * current,
    }
}

/// Energy of the mechanism and its windings.
#[inline(always)]
fn stored<R: Real>(at: &View<'_, R>) -> Energy<R> {
    energy(at.model, at.q, at.v, at.scratch).with_stored(at.model.magnetic_energy(at.rotors))
}

#[inline(always)]
fn of_line<R: Real>(at: &View<'_, R>, quantity: LineQuantity, k: usize) -> R {
    let element = &at.model.spring_dampers()[k];
    let path = element.length(at.q, at.v, |link| (at.scratch.twist(link), at.scratch.link_poses()[link]));
    match quantity {
        LineQuantity::Length => path.length,
        LineQuantity::Rate => path.rate,
        LineQuantity::Force => {
            let command = element.actuator.map_or(R::zero(), |a| at.model.actuation(a.command, at.commands, at.rotors));
            element.forces_under(path.length, path.rate, command).total()
        }
    }
}

#[inline(always)]
fn of_bushing<R: Real>(at: &View<'_, R>, quantity: BushingQuantity, k: usize, component: usize) -> R {
    let element = &at.model.bushings()[k];
    let motion = element.motion(|link| (at.scratch.twist(link), at.scratch.link_poses()[link]));
    match quantity {
        BushingQuantity::Deflection => motion.deflection[component],
        BushingQuantity::Rotation => motion.deflection[3 + component],
        BushingQuantity::Force => element.force(&motion)[component],
        BushingQuantity::Torque => element.force(&motion)[3 + component],
    }
}

/// Returns the link (or the world) to which the frame with index `frame` in the model's names is fixed, and its pose
/// there `[m]`.
///
/// # Panics
///
/// If there is no such frame.
#[inline(always)]
pub fn attached<R: Real>(model: &Model<R>, frame: usize) -> Attached<R> {
    let info = &model.names().frames[frame];
    Attached { link: info.link, pose: Pose { rot: Mat3::splat(info.pose.rot.0), pos: Vec3::splat(info.pose.pos.0) } }
}

#[inline(always)]
fn of_frame<R: Real>(at: &View<'_, R>, quantity: FrameQuantity, frame: usize, component: usize) -> R {
    let fixed = attached(at.model, frame);
    let of_motion =
        matches!(quantity, FrameQuantity::Velocity | FrameQuantity::AngularVelocity | FrameQuantity::Acceleration);
    // no closure on lanes: it would be compiled for the baseline instruction set
    let pose = if of_motion { Pose::identity() } else { kinematics::frame_pose(at.scratch, &fixed) };
    match quantity {
        FrameQuantity::Position => pose.pos[component],
        FrameQuantity::Quaternion => {
            let q = Quat::from_matrix(&pose.rot);
            [q.w, q.xyz[0], q.xyz[1], q.xyz[2]][component]
        }
        FrameQuantity::Angles => kinematics::roll_pitch_yaw(&pose.rot)[component],
        FrameQuantity::Velocity => kinematics::frame_velocity(at.scratch, &fixed).lin[component],
        FrameQuantity::AngularVelocity => kinematics::frame_velocity(at.scratch, &fixed).ang[component],
        FrameQuantity::Acceleration => kinematics::frame_acceleration(at.scratch, &fixed).lin[component],
        FrameQuantity::Wind => {
            let Some(wind) = at.model.wind() else { return R::zero() };
            wind.at(at.t).velocity_at(pose.pos)[component]
        }
        FrameQuantity::CenterOfMass => {
            let com = at.model.mass_properties(BodyId::new(frame)).map_or([0.0; 3], |mass| mass.center_of_mass);
            pose.point(Vec3(com.map(R::splat)))[component]
        }
    }
}
