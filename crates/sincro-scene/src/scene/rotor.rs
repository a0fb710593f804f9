//! Rotors: as written, and as the builder takes them.

#[cfg(test)]
use schemars::JsonSchema;
use serde::Deserialize;
use sincro_dynamics::aero::rotor::{
    CoefficientTable, ConstantCoefficients, Drag, PrintedScript, Rotor, RotorLaw, RotorSpec as Blades, Spin,
    StockPropeller, TableRow,
};
use sincro_dynamics::model::{RotorDrive, RotorSpec};

use super::Spec;
use super::signal_file::{SignalFile, SignalReader};
use crate::diagnostic::{Diagnostic, Located};
use crate::series;
use crate::tree::join;

/// A rotor: thrust along z of its own frame, and the reaction of its torque.
#[derive(Debug, Deserialize)]
#[cfg_attr(test, derive(JsonSchema))]
#[serde(deny_unknown_fields)]
#[cfg_attr(test, schemars(extend(
    "oneOf" = [
        {"required": ["blade"]}, {"required": ["constant"]}, {"required": ["table"]}, {"required": ["stock"]},
        {"required": ["printed"]}
    ],
    "not" = {"required": ["rotation_deg", "quaternion_wxyz"]},
    "allOf" = [{"not": {"required": ["joint", "speed"]}}, {"not": {"required": ["joint", "lag"]}}]
)))]
pub(crate) struct RotorFile {
    /// Letters, digits, `_` and `-`; the path is the parent's path, `/` and the name.
    pub name: String,
    /// Path of the body, joint or frame that carries it.
    pub parent: String,
    /// Hub in the parent frame [m].
    #[serde(default)]
    pub position: [f64; 3],
    /// Roll, pitch and yaw in the parent: R = Rz(yaw)·Ry(pitch)·Rx(roll) [deg].
    pub rotation_deg: Option<[f64; 3]>,
    /// Rotation in the parent as a quaternion (w, x, y, z), of any length but zero.
    pub quaternion_wxyz: Option<[f64; 4]>,
    /// Which way it turns at positive speed, seen from above; of all but `stock` and `printed`, which know none.
    pub spin: Option<SpinFile>,
    /// Blade elements in the flow of momentum theory.
    pub blade: Option<BladeFile>,
    /// T = thrust·Ω², Q = torque·Ω².
    pub constant: Option<ConstantRotorFile>,
    /// Coefficients over the advance ratio J = v/(nD): T = ρn²D⁴·c_T, Q = ρn²D⁵·c_Q, n in turns a second.
    pub table: Option<RotorTableFile>,
    /// V-REP's stock propeller: whole particles, counted each base step; `speed` is their velocity [m/s].
    pub stock: Option<StockFile>,
    /// The thesis's script as printed, defects and NaN included: to compare with, not to fly.
    pub printed: Option<BladeFile>,
    /// Speed over time, default 0; a diagram may give it through the port PATH [rad/s].
    pub speed: Option<SignalFile>,
    /// The speed follows `speed` with a first-order lag.
    pub lag: Option<LagFile>,
    /// Moment of inertia of the turning part about its axis, for its gyroscopic moment on the airframe [kg·m²].
    #[cfg_attr(test, schemars(range(min = 0.0)))]
    #[serde(default)]
    pub inertia: f64,
    /// The ground at z = 0 holds the induced velocity back; of `blade` only.
    #[serde(default)]
    pub ground_effect: bool,
    /// Path of the revolute joint that turns it, in place of `speed`: its rate is the rotor's speed, and the air brakes it.
    pub joint: Option<String>,
}

/// Which way a rotor turns, seen from above (against the thrust).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, serde::Serialize)]
#[cfg_attr(test, derive(JsonSchema))]
#[serde(rename_all = "lowercase")]
pub(crate) enum SpinFile {
    /// Counter-clockwise.
    Ccw,
    /// Clockwise.
    Cw,
}

/// Blades of a rotor, untwisted and of one chord.
#[derive(Clone, Copy, Debug, Deserialize)]
#[cfg_attr(test, derive(JsonSchema))]
#[serde(deny_unknown_fields)]
pub(crate) struct BladeFile {
    /// Radius of the disc [m].
    pub radius: f64,
    /// Chord of a blade [m].
    pub chord: f64,
    /// Number of blades.
    pub n_blades: u32,
    /// Slope of the lift coefficient [1/rad].
    pub lift_slope: f64,
    /// Collective pitch [rad].
    pub collective_pitch: f64,
    /// Drag coefficient at zero incidence: c_d = cd0 + k_cd·α².
    pub cd0: f64,
    /// Growth of the drag coefficient with the incidence squared [1/rad²].
    pub k_cd: f64,
}

/// Constant coefficients of a rotor.
#[derive(Clone, Copy, Debug, Deserialize)]
#[cfg_attr(test, derive(JsonSchema))]
#[serde(deny_unknown_fields)]
pub(crate) struct ConstantRotorFile {
    /// Thrust over speed squared [N·s²/rad²].
    pub thrust: f64,
    /// Torque over speed squared [N·m·s²/rad²].
    #[cfg_attr(test, schemars(range(min = 0.0)))]
    pub torque: f64,
}

/// Coefficients measured over the advance ratio: linear between the rows, constant outside.
#[derive(Clone, Debug, Deserialize)]
#[cfg_attr(test, derive(JsonSchema))]
#[serde(deny_unknown_fields)]
pub(crate) struct RotorTableFile {
    /// CSV file, its path relative to the folder.
    pub file: String,
    /// Diameter of the disc [m].
    pub diameter: f64,
    /// Column of advance ratios, which increase.
    #[serde(default = "advance_column")]
    pub advance: String,
    /// Column of c_T.
    #[serde(default = "thrust_column")]
    pub thrust: String,
    /// Column of c_Q, which is c_P/2π.
    #[serde(default = "torque_column")]
    pub torque: String,
}

/// V-REP's stock propeller.
#[derive(Clone, Copy, Debug, Deserialize)]
#[cfg_attr(test, derive(JsonSchema))]
#[serde(deny_unknown_fields)]
pub(crate) struct StockFile {
    /// Particles a second; default 430.
    pub particles_per_second: Option<u32>,
    /// Diameter of a particle; default 0.005 [m].
    pub diameter: Option<f64>,
    /// Density of a particle; default 8500 [kg/m³].
    pub density: Option<f64>,
    /// Torque about the axis by velocity of the particles, as a magnitude; default 0.002 [N·s].
    pub torque_by_velocity: Option<f64>,
}

/// A first-order lag: Ω' = (speed − Ω)/time_constant.
#[derive(Clone, Copy, Debug, Deserialize)]
#[cfg_attr(test, derive(JsonSchema))]
#[serde(deny_unknown_fields)]
pub(crate) struct LagFile {
    /// Time to 63 % of a step [s].
    #[cfg_attr(test, schemars(extend("exclusiveMinimum" = 0.0)))]
    pub time_constant: f64,
    /// Speed at the start [rad/s].
    #[serde(default)]
    pub initial: f64,
}

fn advance_column() -> String {
    "J".into()
}

fn thrust_column() -> String {
    "c_T".into()
}

fn torque_column() -> String {
    "c_Q".into()
}

/// Rotor before the tree is built: its joint is still a path.
pub(super) struct RotorMade {
    pub law: RotorLaw,
    pub density: f64,
    pub lag: Option<LagFile>,
    pub joint: Option<String>,
    pub inertia: f64,
    pub ground_effect: bool,
}

impl RotorMade {
    /// For the builder, with the node of its joint.
    pub fn spec(self, joint: Option<sincro_dynamics::model::NodeId>) -> RotorSpec {
        let drive = match (joint, self.lag) {
            (Some(joint), _) => RotorDrive::Joint(joint),
            (None, Some(LagFile { time_constant, initial })) => RotorDrive::Lag { time_constant, initial },
            (None, None) => RotorDrive::Command,
        };
        let Self { law, density, inertia, ground_effect, .. } = self;
        RotorSpec { law, density, drive, inertia, ground_effect }
    }
}

/// The rotor with its speed; a rotor that cannot be becomes a frame, and the reason is noted.
pub(super) fn spec(file: &RotorFile, pointer: &str, density: f64, signals: &mut SignalReader<'_>) -> Spec {
    let zero = SignalFile::Number(0.0);
    let speed = signals.read(file.speed.as_ref().unwrap_or(&zero), &format!("{pointer}/speed"));
    let mut judge = Judge { file, pointer, signals };
    match judge.law() {
        Some(law) => {
            let (inertia, ground_effect) = (file.inertia, file.ground_effect);
            let made = RotorMade { law, density, lag: file.lag, joint: file.joint.clone(), inertia, ground_effect };
            Spec::Rotor(Box::new(made), speed)
        }
        None => Spec::Frame,
    }
}

struct Judge<'a, 'b> {
    file: &'a RotorFile,
    pointer: &'a str,
    signals: &'a mut SignalReader<'b>,
}

impl Judge<'_, '_> {
    fn law(&mut self) -> Option<RotorLaw> {
        let file = self.file;
        let spin = match file.spin {
            Some(SpinFile::Cw) => Spin::Clockwise,
            _ => Spin::CounterClockwise,
        };
        self.check_spin();
        self.check_extras();
        if let Some(blade) = &file.blade {
            return self.or_note("blade", Rotor::new(blades(blade, spin))).map(RotorLaw::Blade);
        }
        if let Some(blade) = &file.printed {
            return self.or_note("printed", PrintedScript::new(blades(blade, spin))).map(RotorLaw::Printed);
        }
        if let Some(c) = &file.constant {
            return Some(RotorLaw::Constant(ConstantCoefficients { thrust: c.thrust, torque: c.torque, spin }));
        }
        if let Some(table) = &file.table {
            let rows = self.rows(table)?;
            return self.or_note("table", CoefficientTable::new(table.diameter, spin, rows)).map(RotorLaw::Table);
        }
        let stock = stock(file.stock.as_ref()?);
        let diagnostics = stock.problems();
        let made = if diagnostics.is_empty() { Ok(stock) } else { Err(diagnostics) };
        self.or_note("stock", made).map(RotorLaw::Stock)
    }

    fn check_spin(&mut self) {
        let knows_spin = self.file.stock.is_none() && self.file.printed.is_none();
        let document = self.signals.document;
        if knows_spin && self.file.spin.is_none() {
            let message = format!("`spin` is missing in rotor `{}`", self.file.name);
            let diagnostic = Diagnostic::error(&document.title_at(self.pointer), message);
            self.signals.diagnostics.push(diagnostic.with_help("`spin`: \"ccw\" or \"cw\", seen from above"));
        } else if !knows_spin && self.file.spin.is_some() {
            let at = document.key_at(&format!("{}/spin", self.pointer));
            let word = if self.file.stock.is_some() { "stock" } else { "printed" };
            let diagnostic = Diagnostic::error(&at, format!("`spin` has no meaning with `{word}`"));
            self.signals.diagnostics.push(diagnostic.with_help("leave it out: that law knows no sense of rotation"));
        }
    }

    /// Notes an inertia or a ground effect that the law cannot have.
    fn check_extras(&mut self) {
        let (file, document) = (self.file, self.signals.document);
        let mut note = |key: &str, message: &str, help: &str| {
            let diagnostic = Diagnostic::error(&document.key_at(&format!("{}/{key}", self.pointer)), message);
            self.signals.diagnostics.push(diagnostic.with_help(help));
        };
        if file.inertia != 0.0 && file.joint.is_some() {
            let help = "leave it out: the bodies that the joint carries have it";
            note("inertia", "`inertia` has no meaning with `joint`", help);
        } else if file.inertia != 0.0 && file.spin.is_none() {
            let help = "leave it out: that law knows no sense of rotation";
            note("inertia", "`inertia` has no meaning with `stock` or `printed`", help);
        } else if !(file.inertia >= 0.0 && file.inertia.is_finite()) {
            let message = format!("`inertia` is {} kg·m²: expected a positive number", file.inertia);
            note("inertia", &message, "the moment of inertia of the turning part about its axis, or leave it out");
        }
        if file.ground_effect && file.blade.is_none() {
            let help = "leave it out, or give the blades: only they have an induced velocity";
            note("ground_effect", "`ground_effect` belongs to `blade`", help);
        }
    }

    /// Returns the value, or reports its errors, each at the key that it begins with.
    fn or_note<T>(&mut self, table: &str, made: Result<T, impl IntoIterator<Item = String>>) -> Option<T> {
        let document = self.signals.document;
        let reasons = match made {
            Ok(made) => return Some(made),
            Err(reasons) => reasons,
        };
        for reason in reasons {
            let key = reason.split('`').nth(1).unwrap_or("");
            let inner = format!("{}/{table}/{key}", self.pointer);
            let at = if document.get(&inner).is_some() { document.at(&inner) } else { document.title_at(self.pointer) };
            let diagnostic = Diagnostic::error(&at, format!("rotor `{}`: {reason}", self.file.name));
            self.signals.diagnostics.push(diagnostic);
        }
        None
    }

    fn rows(&mut self, table: &RotorTableFile) -> Option<Vec<TableRow>> {
        let located = |key: &str, value: &str| {
            let pointer = format!("{}/table/{key}", self.pointer);
            let written = self.signals.document.get(&pointer).is_some();
            let at = if written { pointer } else { format!("{}/table", self.pointer) };
            Located { value: value.to_owned(), at: self.signals.document.at(&at) }
        };
        let (file, key) = (located("file", &table.file), located("advance", &table.advance));
        let columns = [located("thrust", &table.thrust), located("torque", &table.torque)];
        let SignalReader { folder, diagnostics, .. } = &mut *self.signals;
        let mut read = |column: &Located<String>| {
            series::read(folder, &series::Query { file: &file, key: &key, column }, diagnostics)
        };
        let (of_thrust, of_torque) = (read(&columns[0])?, read(&columns[1])?);
        let ([advances, thrusts], [_, torques]) = (&*of_thrust, &*of_torque);
        let row = |k: usize| TableRow { advance: advances[k], thrust: thrusts[k], torque: torques[k] };
        Some((0..advances.len()).map(row).collect())
    }
}

fn blades(file: &BladeFile, spin: Spin) -> Blades {
    Blades {
        radius: file.radius,
        chord: file.chord,
        n_blades: file.n_blades,
        lift_slope: file.lift_slope,
        collective_pitch: file.collective_pitch,
        drag: Drag { cd0: file.cd0, k_cd: file.k_cd },
        spin,
    }
}

fn stock(file: &StockFile) -> StockPropeller {
    let of_vrep = StockPropeller::default();
    StockPropeller {
        particles_per_second: file.particles_per_second.unwrap_or(of_vrep.particles_per_second),
        diameter: file.diameter.unwrap_or(of_vrep.diameter),
        density: file.density.unwrap_or(of_vrep.density),
        torque_by_velocity: file.torque_by_velocity.unwrap_or(of_vrep.torque_by_velocity),
    }
}

/// Notes a rotor whose joint is not there or does not carry it.
pub(super) fn check_joint(file: &RotorFile, pointer: &str, joints: &[&str], signals: &mut SignalReader<'_>) {
    let Some(joint) = &file.joint else { return };
    let path = join(&file.parent, &file.name);
    let at = signals.document.at(&format!("{pointer}/joint"));
    if !joints.contains(&joint.as_str()) {
        let diagnostic = Diagnostic::error(&at, format!("there is no joint `{joint}` to turn rotor `{path}`"));
        signals.diagnostics.push(diagnostic.with_help(crate::suggest::help(joint, joints, "joints")));
    } else if !path.starts_with(&format!("{joint}/")) {
        let message = format!("rotor `{path}` takes its speed from joint `{joint}`, but does not turn with it");
        let diagnostic = Diagnostic::error(&at, message);
        signals
            .diagnostics
            .push(diagnostic.with_help("hang the rotor on the joint, or on a body that the joint carries"));
    }
}
