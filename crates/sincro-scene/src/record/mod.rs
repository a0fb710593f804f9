//! Recorded signals: from names to numbers.
//!
//! [`catalogue`] lists everything that a model can be asked for; a [`Recorder`] holds the chosen ones resolved, so that
//! a row costs no look-up and no allocation.

mod catalogue;
pub mod contact;
mod follow;
pub mod probe;
mod reference;

pub use catalogue::{Entry, catalogue};
pub use contact::ContactQuantity;
pub use follow::{ProbeMap, present_name};
pub use reference::signal_reference;

use std::collections::BTreeMap;

use sincro_dynamics::coupled::MechanismResponse;
use sincro_dynamics::energy::Energy;
use sincro_dynamics::ids::JointId;
use sincro_dynamics::model::Model;
use sincro_dynamics::world::Observation;

use crate::diagnostic::{Diagnostic, Diagnostics, Located};
use crate::names::nearest_path;
use crate::suggest;
use probe::View;

/// Measurement: one number that can be read off a world, in SI units. Indices count from 0; those of degrees of freedom
/// are indices of the model's velocities v, those of frames of the frames in the model's names, vectors have components
/// 0 to 2 in world axes. [`catalogue`] gives the probes of a model with names and units.
///
/// ```
/// use sincro_scene::prelude::*;
/// use sincro_scene::record::EnergyQuantity;
///
/// let scene = from_text("")?; // signals of the world alone
/// let signals = catalogue(&scene.model);
/// let kinetic = signals.iter().find(|signal| signal.name == "energy.kinetic").unwrap();
/// assert_eq!(kinetic.probe, Probe::Energy(EnergyQuantity::Kinetic));
/// # Ok::<(), Diagnostics>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Probe {
    /// Generalized coordinate, by its index in q `[rad]`, `[m]`.
    Coordinate(usize),
    /// Generalized velocity, by its index in v `[rad/s]`, `[m/s]`.
    Rate(usize),
    /// Generalized acceleration, by its index in v̇ `[rad/s²]`, `[m/s²]`.
    Acceleration(usize),
    /// Latched command, by its index in the command vector, in the unit of its actuator.
    Command(usize),
    /// Mean torque `[N·m]` or force `[N]` of a motor since the last recorded row, by the motor's index.
    MotorTorqueMean(usize),
    /// Torque `[N·m]` or force `[N]` of a motor at the instant, by the motor's index.
    MotorTorqueNow(usize),
    /// Torque `[N·m]` or force `[N]` of the spring of a degree of freedom.
    SpringTorque(usize),
    /// Torque `[N·m]` or force `[N]` of the damper of a degree of freedom.
    DampingTorque(usize),
    /// Torque `[N·m]` or force `[N]` of Coulomb friction of a degree of freedom.
    FrictionTorque(usize),
    /// Torque `[N·m]` or force `[N]` that a signal of the scene applies to a degree of freedom.
    AppliedTorque(usize),
    /// Component of a frame's quantity in the world: quantity, frame, component.
    Frame(FrameQuantity, usize, usize),
    /// Energy of the whole world `[J]`.
    Energy(EnergyQuantity),
    /// Component of the momentum of the whole world: 0–2 angular, about the world's origin `[N·m·s]`, 3–5 linear
    /// `[N·s]`.
    Momentum(usize),
    /// Quantity of a rotor: quantity, index of the rotor.
    Rotor(RotorQuantity, usize),
    /// Component of the force of a drag element `[N]`: index of the element, component.
    Drag(usize, usize),
    /// Quantity of a spring and damper between two points, or of a tendon: quantity, index of the element.
    SpringDamper(LineQuantity, usize),
    /// Quantity of a bushing: quantity, index of the bushing, component in the axes of its first frame.
    Bushing(BushingQuantity, usize, usize),
    /// Quantity of an elastic gear: quantity, index of the gear.
    ElasticGear(GearQuantity, usize),
    /// Quantity of a motor's winding: quantity, index of the winding.
    Winding(WindingQuantity, usize),
    /// Activation of an actuator, by its index among them, in the unit of its command.
    Activation(usize),
    /// Component of the wind at its reference height `[m/s]`.
    Wind(usize),
    /// Quantity of the contacts of a body: quantity, frame of the body, component.
    Contact(ContactQuantity, usize, usize),
    /// Torque `[N·m]` or force `[N]` of the position limits of a degree of freedom.
    LimitTorque(usize),
    /// Position residual of a closure or gear, by its index among both: `[m]` of a loop joint, in the unit of its joint
    /// of a gear.
    Opening(usize),
    /// Component of the wrench of a joint's parent on its child: 0–2 torque about the origin of the child's joint frame
    /// `[N·m]`, 3–5 force `[N]`, both in the axes of the parent's joint frame.
    JointReaction(JointId, usize),
    /// Constraint force `[N]` or torque `[N·m]` of a degree of freedom of a force sensor.
    Reaction(usize),
    /// Value of a sensor as it was last sampled, by its index among the values of all sensors.
    Sensor(usize),
    /// Signal of the diagram, by its index.
    Signal(usize),
    /// Float signal that scripts and clients set, by its index among those that are recorded.
    FloatSignal(usize),
}

/// Prefix of the name of a float signal of scripts and clients in `record`.
const FLOAT_SIGNAL: &str = "float_signal.";

/// Returns the names of the float signals (of scripts and clients) among recorded names, in their order, without their
/// prefix.
pub fn float_signals(names: &[Located<String>]) -> impl Iterator<Item = &str> {
    names.iter().filter_map(|name| name.value.strip_prefix(FLOAT_SIGNAL)).filter(|name| !name.is_empty())
}

/// Returns true if the name is that of a float signal.
pub(crate) fn is_float_signal(name: &str) -> bool {
    name.strip_prefix(FLOAT_SIGNAL).is_some_and(|name| !name.is_empty())
}

/// Quantity of a rotor, for [`Probe::Rotor`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RotorQuantity {
    /// Speed of rotation `[rad/s]`.
    Speed,
    /// Force on the airframe along the rotor's axis `[N]`.
    Thrust,
    /// Reaction torque on the airframe about the rotor's axis `[N·m]`.
    Torque,
    /// Velocity of the air through the disc `[m/s]`.
    Inflow,
    /// Shaft power `[W]`.
    Power,
    /// Validity of the rotor's law at this state: 1 if it holds, else 0.
    Valid,
}

/// Quantity of a spring and damper between two points, or of a tendon, for [`Probe::SpringDamper`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LineQuantity {
    /// Length of the path: the distance of two points `[m]`.
    Length,
    /// Rate of the length, positive where it grows `[m/s]`.
    Rate,
    /// Force along the path, positive where it makes it longer `[N]`.
    Force,
}

/// Quantity of a bushing, for [`Probe::Bushing`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum BushingQuantity {
    /// Position of the second frame in the first `[m]`.
    Deflection,
    /// Rotation vector of the second frame in the first `[rad]`.
    Rotation,
    /// Force on the second body `[N]`.
    Force,
    /// Torque on the second body about the origin of the second frame `[N·m]`.
    Torque,
}

/// Quantity of an elastic gear, for [`Probe::ElasticGear`], in the units of its second joint.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum GearQuantity {
    /// Mesh error q₂ − ratio·q₁ − offset, the travel within the backlash included `[rad]` or `[m]`.
    MeshError,
    /// Torque on the second joint `[N·m]` or force `[N]`.
    Torque,
}

/// Quantity of the winding of a direct-current motor, for [`Probe::Winding`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum WindingQuantity {
    /// Current `[A]`.
    Current,
    /// Voltage across the motor: the command within the limits of the supply `[V]`.
    Voltage,
    /// Voltage that the rotation induces `[V]`.
    BackEmf,
    /// Power of the source `[W]`.
    ElectricalPower,
}

/// Quantity of a frame in the world, for [`Probe::Frame`]; vectors in world axes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FrameQuantity {
    /// Position of the origin `[m]`, 3 components.
    Position,
    /// Orientation as a unit quaternion, 4 components w, x, y, z.
    Quaternion,
    /// Roll, pitch, yaw of R = Rz(yaw)·Ry(pitch)·Rx(roll) `[rad]`, 3 components.
    Angles,
    /// Velocity of the origin `[m/s]`, 3 components.
    Velocity,
    /// Angular velocity `[rad/s]`, 3 components.
    AngularVelocity,
    /// Acceleration of the origin `[m/s²]`, 3 components.
    Acceleration,
    /// Centre of mass of a body in the world `[m]`, 3 components.
    CenterOfMass,
    /// Velocity of the air at the origin `[m/s]`, 3 components.
    Wind,
}

/// Quantity of the energy of the whole world, for [`Probe::Energy`] `[J]`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum EnergyQuantity {
    /// Kinetic energy.
    Kinetic,
    /// Potential energy of gravity and springs.
    Potential,
    /// Kinetic and potential energy.
    Total,
    /// Work done by motors and applied forces since the start.
    Work,
    /// Energy dissipated by dampers and friction since the start.
    Dissipated,
    /// Error of the energy balance: total − total at the start − work + dissipated.
    Balance,
}

/// Recorder of the chosen signals of one model: returns a row of numbers for each recorded instant.
#[derive(Clone, Debug)]
pub struct Recorder {
    entries: Vec<Entry>,
    /// Probe of each entry in the present model; none for what has gone.
    bound: Vec<Option<Probe>>,
    motor_impulse: Vec<f64>,
    last_t: f64,
    energy_at_start: f64,
    /// Values of all sensors.
    n_sensed: usize,
    /// Float signals of scripts and clients.
    n_floats: usize,
    row: Vec<f64>,
}

impl Recorder {
    /// Creates a recorder of the signals `names`, in this order, of a model and of its diagram, whose signals are
    /// `diagram` ([`ControlDiagram::entries`](crate::diagram::ControlDiagram::entries); empty without one).
    ///
    /// # Errors
    ///
    /// One diagnostic at each name that is no signal, with the nearest ones that are.
    pub fn new(names: &[Located<String>], model: &Model<f64>, diagram: &[Entry]) -> Result<Self, Diagnostics> {
        let all: Vec<Entry> = catalogue(model).into_iter().chain(diagram.iter().cloned()).collect();
        let mut diagnostics = Diagnostics::new();
        let (mut entries, mut n_floats) = (Vec::with_capacity(names.len()), 0);
        for name in names {
            let of_scripts = float_signals(std::slice::from_ref(name)).next().is_some();
            match all.iter().find(|e| e.name == name.value) {
                _ if of_scripts => {
                    let (name, probe) = (name.value.clone(), Probe::FloatSignal(n_floats));
                    entries.push(Entry { name, unit: "".into(), probe });
                    n_floats += 1;
                }
                Some(entry) => entries.push(entry.clone()),
                None => diagnostics.push(unknown(name, &all)),
            }
        }
        if diagnostics.any_error() {
            return Err(diagnostics);
        }
        let row = Vec::with_capacity(entries.len() + 1);
        let motor_impulse = vec![0.0; model.motors().len()];
        let n_sensed = model.names().sensors.iter().map(|s| s.values.len()).sum();
        let bound = entries.iter().map(|entry| Some(entry.probe)).collect();
        Ok(Self { entries, bound, motor_impulse, last_t: 0.0, energy_at_start: 0.0, n_sensed, n_floats, row })
    }

    /// Gives units, by the names of columns, to float signals, which have none of their own.
    #[must_use]
    pub fn with_units(mut self, units: &BTreeMap<String, String>) -> Self {
        for entry in self.entries.iter_mut().filter(|e| matches!(e.probe, Probe::FloatSignal(_))) {
            if let Some(unit) = units.get(&entry.name) {
                entry.unit = unit.clone().into();
            }
        }
        self
    }

    /// Returns names and units of the columns of a row: `t` in `s`, then the signals in the order of their names.
    pub fn columns(&self) -> impl Iterator<Item = (&str, &str)> {
        [("t", "s")].into_iter().chain(self.entries.iter().map(|e| (e.name.as_str(), &*e.unit)))
    }

    /// Returns the row of the world at time `t` `[s]`, in the order and units of [`Recorder::columns`]. `signals` holds
    /// the diagram's signals, then the recorded float signals, then the values of all sensors. To be called at every
    /// recorded instant, in order, the start included (`is_start`).
    pub fn row(&mut self, seen: &Observation<'_>, signals: &[f64], t: f64, is_start: bool) -> &[f64] {
        let (energy, momentum) = (seen.energy(), seen.momentum());
        if is_start {
            self.energy_at_start = energy.total();
            self.last_t = t;
        }
        self.row.clear();
        self.row.push(t);
        for i in 0..self.entries.len() {
            let Some(probe) = self.bound[i] else {
                self.row.push(f64::NAN);
                continue;
            };
            let value = match probe {
                Probe::Energy(quantity) => self.energy(&energy, &seen.state.totals, quantity),
                Probe::Momentum(k) if k < 3 => momentum.ang[k],
                Probe::Momentum(k) => momentum.lin[k - 3],
                Probe::Signal(k) => signals[k],
                Probe::Sensor(k) => signals[signals.len() - self.n_sensed + k],
                Probe::FloatSignal(k) => signals[signals.len() - self.n_sensed - self.n_floats + k],
                probe => self.read(seen, probe, t),
            };
            self.row.push(value);
        }
        for (kept, now) in self.motor_impulse.iter_mut().zip(&seen.state.totals[2..]) {
            *kept = *now;
        }
        self.last_t = t;
        &self.row
    }

    /// Starts the averaging of mean torques anew at time `t` `[s]` without making a row. `totals` is
    /// [`State::totals`](sincro_dynamics::state::State::totals) of the state at that time.
    pub fn skip_row(&mut self, totals: &[f64], t: f64) {
        self.motor_impulse.copy_from_slice(&totals[2..]);
        self.last_t = t;
    }

    /// Returns the recorder's memory between rows, for a snapshot: energy at the start `[J]`, time of the last row
    /// `[s]`, impulse of each motor at that time `[N·m·s]`.
    pub fn memory(&self) -> impl Iterator<Item = f64> {
        [self.energy_at_start, self.last_t].into_iter().chain(self.motor_impulse.iter().copied())
    }

    /// Restores what [`Recorder::memory`] returned. Returns false, and changes nothing, if it has another length, as of
    /// another model.
    pub fn set_memory(&mut self, memory: &[f64]) -> bool {
        let [energy, last_t, impulse @ ..] = memory else { return false };
        if impulse.len() != self.motor_impulse.len() {
            return false;
        }
        (self.energy_at_start, self.last_t) = (*energy, *last_t);
        self.motor_impulse.copy_from_slice(impulse);
        true
    }

    fn read(&self, seen: &Observation<'_>, probe: Probe, t: f64) -> f64 {
        let state = seen.state;
        match probe {
            Probe::Command(m) => state.commands[m],
            Probe::MotorTorqueMean(m) => {
                let span = t - self.last_t;
                if span > 0.0 { (state.totals[2 + m] - self.motor_impulse[m]) / span } else { 0.0 }
            }
            Probe::FrictionTorque(k) => seen.friction_torque(k),
            Probe::LimitTorque(k) => seen.limit_torque(k),
            Probe::Contact(quantity, frame, k) => contact::read(seen.model(), seen.contacts(), quantity, frame, k),
            Probe::Opening(k) => seen.residual(k),
            Probe::JointReaction(joint, k) => {
                let wrench = seen.joint_wrench(joint);
                if k < 3 { wrench.ang[k] } else { wrench.lin[k - 3] }
            }
            Probe::Reaction(k) => seen.scratch().reaction()[k],
            probe => {
                let view = View::observed(seen, t);
                let response =
                    MechanismResponse { accelerations: seen.accelerations, motor_torque: seen.motor_torque() };
                let value = probe::of_state(&view, probe).or_else(|| probe::of_response(&view, response, probe));
                value.expect("what is neither of the state nor of its response is read above")
            }
        }
    }

    fn energy(&self, energy: &Energy<f64>, totals: &[f64], quantity: EnergyQuantity) -> f64 {
        match quantity {
            EnergyQuantity::Kinetic => energy.kinetic,
            EnergyQuantity::Potential => energy.potential,
            EnergyQuantity::Total => energy.total(),
            EnergyQuantity::Work => totals[0],
            EnergyQuantity::Dissipated => totals[1],
            EnergyQuantity::Balance => energy.total() - self.energy_at_start - totals[0] + totals[1],
        }
    }
}

/// The finding about a name that means nothing: what is near, or what the object it names offers.
fn unknown(name: &Located<String>, all: &[Entry]) -> Diagnostic {
    let message = format!("there is no signal `{}`", name.value);
    let of_object: Vec<&str> = match name.value.split_once('.') {
        Some((object, _)) => {
            let prefix = format!("{object}.");
            all.iter().map(|e| e.name.as_str()).filter(|n| n.starts_with(&prefix)).collect()
        }
        None => Vec::new(),
    };
    let names = || all.iter().map(|e| e.name.as_str());
    let nearest = nearest_path(&name.value, names()).or_else(|| suggest::nearest(&name.value, names()));
    let component = format!("{}[", name.value);
    let components: Vec<&str> = all.iter().map(|e| e.name.as_str()).filter(|n| n.starts_with(&component)).collect();
    if let [first, .., last] = components[..] {
        let help = format!("it is a vector: name its components, `{first}` to `{last}`");
        return Diagnostic::error(&name.at, message).with_help(help);
    }
    let help = match (nearest, of_object.is_empty()) {
        (Some(near), _) => format!("did you mean `{near}`?"),
        (None, false) => format!("its object has {}", of_object.join(", ")),
        (None, true) => "`sincro check SCENE` lists every signal".into(),
    };
    Diagnostic::error(&name.at, message).with_help(help)
}
