//! Functions of V-REP and CoppeliaSim that are not here: why, and what to do instead. They are not listed to clients.

/// The rows of a table such as `absent.txt`: names below a text, each with it.
pub fn rows(table: &'static str) -> impl Iterator<Item = (&'static str, &'static str)> {
    let mut why = "";
    table.lines().filter(|line| !line.starts_with('#')).flat_map(move |line| {
        if !line.starts_with(' ') {
            why = line;
        }
        line.strip_prefix("  ")
            .unwrap_or_default()
            .split(' ')
            .filter(|name| !name.is_empty())
            .map(move |name| (name, why))
    })
}

/// Functions that are not offered, each with the reason.
fn all() -> impl Iterator<Item = (&'static str, &'static str)> {
    rows(include_str!("absent.txt"))
}

/// Reason why a function of V-REP or CoppeliaSim is not offered, with what to do instead: the text of the error that
/// callers get. `name` is the present name without `sim.`; none if the function is offered, or unknown.
#[must_use]
pub fn why_absent(name: &str) -> Option<&'static str> {
    all().find(|(absent, _)| *absent == name).map(|(_, why)| why)
}

/// Present names, without `sim.`, of the functions of V-REP and CoppeliaSim that are not offered; [`why_absent`] has
/// the reason of each.
pub fn absent() -> impl Iterator<Item = &'static str> {
    all().map(|(name, _)| name)
}

/// Functions of `simVision` that are not offered, without `simVision.`, each with the reason.
pub const VISION: &[(&str, &str)] = &[
    ("resizeWorkImg", RESAMPLED),
    ("rotateWorkImg", RESAMPLED),
    ("workImgToSensorDepthMap", "depths are what a sensor measures: only its colours can be written"),
    ("distort", SEVERAL),
    ("handleAnaglyphStereo", SEVERAL),
    ("createVelodyneHDL64E", VELODYNE),
    ("destroyVelodyneHDL64E", VELODYNE),
    ("handleVelodyneHDL64E", VELODYNE),
    ("createVelodyneVPL16", VELODYNE),
    ("destroyVelodyneVPL16", VELODYNE),
    ("handleVelodyneVPL16", VELODYNE),
    ("createVelodyneROSModel", VELODYNE),
    ("destroyVelodyneROSModel", VELODYNE),
    ("handleVelodyneROSModel", VELODYNE),
];
const RESAMPLED: &str = "work images are not resampled: give the sensor another resolution, or turn it";
const SEVERAL: &str = "pictures are not distorted, and those of two sensors not put together: read each of them";
const VELODYNE: &str = "four sensors are not turned into one lidar: simVision.velodyneDataFromWorkImg gives the points of each, in the world with sim.handleflag_abscoords";
