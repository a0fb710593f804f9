//! Units in names of keys, and other names of keys and words: those of URDF, MJCF, SDF, Simulink and everyday speech.
//!
//! A name that can mean only one thing is understood; one that needs a thought is answered with the right word.

/// Keys that are understood: written, meant.
const KEYS: [(&str, &str); 23] = [
    ("ixx", "xx"),
    ("iyy", "yy"),
    ("izz", "zz"),
    ("ixy", "xy"),
    ("ixz", "xz"),
    ("iyz", "yz"),
    ("type", "kind"),
    ("box", "cuboid"),
    ("com", "center_of_mass"),
    ("centre_of_mass", "center_of_mass"),
    ("pos", "position"),
    ("colour", "color"),
    ("reflected_inertia", "armature"),
    ("rotor_inertia", "armature"),
    ("min", "lower"),
    ("max", "upper"),
    ("lower_limit", "lower"),
    ("upper_limit", "upper"),
    ("limit", "limits"),
    ("max_force", "max_torque"),
    ("effort", "max_torque"),
    ("time_step", "step"),
    ("timestep", "step"),
];

/// Words that are understood in the place of one of a list: written, meant.
const WORDS: [(&str, &str); 25] = [
    ("hinge", "revolute"),
    ("continuous", "revolute"),
    ("rotary", "revolute"),
    ("rotational", "revolute"),
    ("pin", "revolute"),
    ("slide", "prismatic"),
    ("slider", "prismatic"),
    ("linear", "prismatic"),
    ("translational", "prismatic"),
    ("floating", "free"),
    ("freejoint", "free"),
    ("spherical", "ball"),
    ("cardan", "universal"),
    ("weld", "fixed"),
    ("revolute", "hinge"),
    ("fixed", "weld"),
    ("ball", "point"),
    ("euler", "semi-implicit-euler"),
    ("runge-kutta", "rk4"),
    ("ode45", "dormand-prince"),
    ("rk45", "dormand-prince"),
    ("dop853", "dormand-prince-8"),
    ("ode78", "dormand-prince-8"),
    ("ode89", "dormand-prince-8"),
    ("ode15s", "stiff"),
];

/// Keys that are answered: written, key that the table must know, advice.
const ADVICE: [(&str, &str, &str); 27] = [
    ("rpy", "rotation_deg", "write `rotation_deg = [roll, pitch, yaw]`, in degrees"),
    ("rotation", "rotation_deg", "write `rotation_deg = [roll, pitch, yaw]`, in degrees, or `quaternion_wxyz`"),
    ("orientation", "rotation_deg", "write `rotation_deg = [roll, pitch, yaw]`, in degrees, or `quaternion_wxyz`"),
    ("euler", "rotation_deg", "write `rotation_deg = [roll, pitch, yaw]`, in degrees: R = Rz(yaw)·Ry(pitch)·Rx(roll)"),
    ("quat", "quaternion_wxyz", "write `quaternion_wxyz`: w comes first"),
    ("quaternion", "quaternion_wxyz", "write `quaternion_wxyz`: w comes first"),
    ("quaternion_xyzw", "quaternion_wxyz", "write `quaternion_wxyz`: w comes first"),
    ("origin", "position", "write `position = [x, y, z]` and `rotation_deg = [roll, pitch, yaw]`"),
    ("xyz", "position", "write `position = [x, y, z]`"),
    ("stiffness", "spring", "write `spring = { stiffness = … }`"),
    ("qpos", "initial", "write `initial = { position = … }`"),
    ("initial_position", "initial", "write `initial = { position = … }`"),
    ("initial_velocity", "initial", "write `initial = { velocity = … }`"),
    ("geometry", "shape", "write `shape = [ { cuboid = { size = [x, y, z] } } ]`"),
    ("collision", "contact", "write `contact = { friction = … }`: the shapes of a body with it touch others"),
    ("child", "parent", "a body names the joint that carries it: `parent = \"/joint\"`"),
    ("end", "duration", "write `duration`"),
    ("angle", "rotation_deg", "write `rotation_deg = [roll, pitch, yaw]`, in degrees"),
    ("angle", "position", "write `position` [rad] or `position_deg`"),
    ("angle_deg", "position", "write `position_deg`"),
    ("speed", "velocity", "write `velocity`, `velocity_rpm` or `velocity_deg_s`"),
    ("of", "file", "write `file = \"…\"`: another scene file, its path relative to the folder"),
    ("scene", "file", "write `file = \"…\"`: another scene file, its path relative to the folder"),
    ("count", "repeat", "write `repeat = { count = …, step = [x, y, z] }`"),
    ("step", "repeat", "write `repeat = { count = …, step = [x, y, z] }`"),
    ("spacing", "repeat", "write `repeat = { count = …, step = [x, y, z] }`"),
    ("frequency", "frequency_hz", "write `frequency_hz` [Hz], or `angular_frequency` [rad/s]"),
];

/// Units that a key can carry as a suffix: suffix, unit of the key without it, factor.
pub(crate) const SUFFIXES: [(&str, &str, f64); 4] = [
    ("_deg", "rad", std::f64::consts::PI / 180.0),
    ("_rpm", "rad/s", std::f64::consts::PI / 30.0),
    ("_deg_s", "rad/s", std::f64::consts::PI / 180.0),
    ("_deg_per_s", "rad/s", std::f64::consts::PI / 180.0),
];

/// The key that is meant by one that a table does not know.
pub(crate) fn key(written: &str) -> Option<&'static str> {
    KEYS.iter().find(|(name, _)| *name == written).map(|(_, meant)| *meant)
}

/// The words that may be meant by one that a list does not have.
pub(crate) fn words(written: &str) -> impl Iterator<Item = &'static str> {
    let written = written.to_lowercase();
    WORDS.iter().filter(move |(name, _)| *name == written).map(|(_, meant)| *meant)
}

/// The word of a list that is meant by one near to another word for it, such as `hing` for `revolute`.
pub(crate) fn near_word(written: &str, known: &[&str]) -> Option<&'static str> {
    let others = WORDS.iter().filter(|(_, meant)| known.contains(meant));
    let near = crate::suggest::nearest(written, others.clone().map(|(name, _)| *name))?;
    others.clone().find(|(name, _)| *name == near).map(|(_, meant)| *meant)
}

/// Advice on a key that a table does not know; `known` are those that it knows.
pub(crate) fn advice(written: &str, known: &[&str]) -> Option<&'static str> {
    let found = ADVICE.iter().find(|(name, needed, _)| *name == written && known.contains(needed));
    found.map(|(.., advice)| *advice)
}

/// The key and the suffix of a key that carries another unit.
pub(crate) fn unit_suffix(key: &str) -> Option<(&str, &'static str)> {
    // the longest suffix wins
    let found = SUFFIXES.iter().filter_map(|(suffix, ..)| Some((key.strip_suffix(suffix)?, *suffix)));
    found.max_by_key(|(_, suffix)| suffix.len())
}

/// The unit of a key that may carry a suffix of [`unit_suffix`]; empty for any other text.
pub(crate) fn unit_of_suffix(suffix: &str) -> &'static str {
    SUFFIXES.iter().find(|(known, ..)| *known == suffix).map_or("", |(_, unit, _)| unit)
}
