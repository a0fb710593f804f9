//! Recorded signals: from names to numbers.
//!
//! [`catalogue`] lists everything that a model can be asked for; a [`Recorder`] holds the chosen ones resolved, so that
//! a row costs no look-up and no allocation.

mod catalogue;
pub mod contact;
pub mod probe;
mod reference;

pub use catalogue::{Entry, catalogue};
pub use contact::ContactQuantity;
pub use reference::signal_reference;

use sincro_dynamics::coupled::MechanismResponse;
use sincro_dynamics::energy::Energy;
use sincro_dynamics::ids::JointId;
use sincro_dynamics::model::Model;
use sincro_dynamics::world::Observation;

use crate::diagnostic::{Diagnostic, Diagnostics, Located};
use crate::names::nearest_path;
use crate::suggest;
use probe::View;

/// One number that can be read off a world.
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
    /// Coordinate in q.
    Coordinate(usize),
    /// Entry of v.
    Rate(usize),
    /// Entry of v̇.
    Acceleration(usize),
    /// Latched command of a motor.
    Command(usize),
    /// Mean torque of a motor over the step that ended here.
    MotorTorqueMean(usize),
    /// Torque of a motor now.
    MotorTorqueNow(usize),
    /// Torque of a joint's spring.
    SpringTorque(usize),
    /// Torque of a joint's damper.
    DampingTorque(usize),
    /// Torque of Coulomb friction.
    FrictionTorque(usize),
    /// Torque applied by a signal.
    AppliedTorque(usize),
    /// Component of a frame's quantity in the world.
    Frame(FrameQuantity, usize, usize),
    /// Energy of the whole world.
    Energy(EnergyQuantity),
    /// Component 0–2 of the angular, 3–5 of the linear momentum.
    Momentum(usize),
    /// Quantity of a rotor.
    Rotor(RotorQuantity, usize),
    /// Component of the force of a drag element, world axes.
    Drag(usize, usize),
    /// Quantity of a spring and damper between two points.
    SpringDamper(LineQuantity, usize),
    /// Component of the wind at its reference height.
    Wind(usize),
    /// Component of what touches a body.
    Contact(ContactQuantity, usize, usize),
    /// Torque of the stops of a joint.
    LimitTorque(usize),
    /// Constraint residual of a closure.
    Opening(usize),
    /// Component 0–2 of the torque, 3–5 of the force of the parent of a joint on its child.
    JointReaction(JointId, usize),
    /// Constraint force of a degree of freedom of a force sensor.
    Reaction(usize),
    /// Value of a sensor, as it was last sampled.
    Sensor(usize),
    /// Signal of the diagram.
    Signal(usize),
    /// Float signal that scripts and clients set; its number among those that are recorded.
    FloatSignal(usize),
}

/// Prefix of the name of a float signal of scripts and clients in `record`.
const FLOAT_SIGNAL: &str = "float_signal.";

/// Names of the float signals among recorded names, in their order.
pub fn float_signals(names: &[Located<String>]) -> impl Iterator<Item = &str> {
    names.iter().filter_map(|name| name.value.strip_prefix(FLOAT_SIGNAL)).filter(|name| !name.is_empty())
}

/// Quantity of a rotor.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RotorQuantity {
    /// Speed [rad/s].
    Speed,
    /// Force along its axis `[N]`.
    Thrust,
    /// Reaction on the airframe about its axis [N·m].
    Torque,
    /// Air through the disc [m/s].
    Inflow,
    /// Power of the shaft `[W]`.
    Power,
    /// Validity of its law: 1 if it holds, else 0.
    Valid,
}

/// Quantity of a spring and damper between two points.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LineQuantity {
    /// Distance of the points `[m]`.
    Length,
    /// Rate of the length [m/s].
    Rate,
    /// Force along the line, positive where it pushes the points apart `[N]`.
    Force,
}

/// Quantity of a frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FrameQuantity {
    /// Origin `[m]`.
    Position,
    /// w, x, y, z.
    Quaternion,
    /// Roll, pitch, yaw `[rad]`.
    Angles,
    /// Velocity of the origin [m/s].
    Velocity,
    /// [rad/s]
    AngularVelocity,
    /// Acceleration of the origin [m/s²].
    Acceleration,
    /// Centre of mass of a body `[m]`.
    CenterOfMass,
    /// Velocity of the air at the origin [m/s].
    Wind,
}

/// Quantity of the energy.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[allow(missing_docs)]
pub enum EnergyQuantity {
    Kinetic,
    Potential,
    Total,
    Work,
    Dissipated,
    Balance,
}

/// The chosen signals of one model.
#[derive(Clone, Debug)]
pub struct Recorder {
    entries: Vec<Entry>,
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
    /// Resolves names against a model and the signals of a diagram.
    ///
    /// # Errors
    ///
    /// All names that mean nothing, each with the nearest ones that do.
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
        Ok(Self { entries, motor_impulse, last_t: 0.0, energy_at_start: 0.0, n_sensed, n_floats, row })
    }

    /// Names and units of the columns, `t` first.
    pub fn columns(&self) -> impl Iterator<Item = (&str, &str)> {
        [("t", "s")].into_iter().chain(self.entries.iter().map(|e| (e.name.as_str(), &*e.unit)))
    }

    /// The row of what is seen at time `t` `[s]`, `t` first; `signals` are the diagram's, after them the float signals
    /// that are recorded and the values of all sensors. To be called at every recorded instant, in order, the start
    /// included.
    pub fn row(&mut self, seen: &Observation<'_>, signals: &[f64], t: f64, is_start: bool) -> &[f64] {
        let (energy, momentum) = (seen.energy(), seen.momentum());
        if is_start {
            self.energy_at_start = energy.total();
            self.last_t = t;
        }
        self.row.clear();
        self.row.push(t);
        for i in 0..self.entries.len() {
            let value = match self.entries[i].probe {
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

    /// Notes an instant `t` `[s]` that no row is made of: the mean torques of the next row begin here. `totals` are
    /// those of the state.
    pub fn skip_row(&mut self, totals: &[f64], t: f64) {
        self.motor_impulse.copy_from_slice(&totals[2..]);
        self.last_t = t;
    }

    /// Memory from row to row: energy at the start `[J]`, time of the last row `[s]`, impulses of the motors [N·m·s].
    pub fn memory(&self) -> impl Iterator<Item = f64> {
        [self.energy_at_start, self.last_t].into_iter().chain(self.motor_impulse.iter().copied())
    }

    /// Goes back to what [`Recorder::memory`] gave. Returns false, and changes nothing, if it has another length.
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
