//! Proximity sensors of the file: the volume that they look into, and what they see.

#[cfg(test)]
use schemars::JsonSchema;
use serde::Deserialize;
use sincro_dynamics::geometry::{FieldOfView, Volume};

use super::object::{Object, ObjectKind};
use crate::diagnostic::{Diagnostic, Diagnostics};
use crate::document::Document;
use crate::sensor::{SensorKind, SensorSpec};
use crate::suggest;

/// The closest point, inside a volume, of bodies that the sensor is not fixed to. It looks along its own z.
#[derive(Clone, Debug, Deserialize)]
#[cfg_attr(test, derive(JsonSchema))]
#[serde(deny_unknown_fields)]
#[cfg_attr(test, schemars(extend("oneOf" = [{"required": ["ray"]}, {"required": ["cylinder"]}, {"required": ["disc"]}, {"required": ["cone"]}, {"required": ["pyramid"]}])))]
pub(crate) struct ProximityFile {
    /// A line.
    pub ray: Option<RayFile>,
    /// Round, with flat ends.
    pub cylinder: Option<CylinderVolumeFile>,
    /// A fan of rays in the plane of x and z.
    pub disc: Option<AngleFile>,
    /// All directions within half an angle of z; its far end is a part of a sphere.
    pub cone: Option<AngleFile>,
    /// Rectangular, with flat ends.
    pub pyramid: Option<PyramidFile>,
    /// How far it sees, from its near end on [m].
    #[cfg_attr(test, schemars(extend("exclusiveMinimum" = 0.0)))]
    pub range: f64,
    /// Where its volume begins before it [m].
    #[serde(default)]
    #[cfg_attr(test, schemars(range(min = 0.0)))]
    pub offset: f64,
    /// Paths of the bodies that it sees; left out: all that it is not fixed to.
    #[cfg_attr(test, schemars(length(min = 1)))]
    pub with: Option<Vec<String>>,
    /// Standard deviation of the distance [m].
    #[serde(default)]
    #[cfg_attr(test, schemars(range(min = 0.0)))]
    pub noise: f64,
}

/// A ray has no measures.
#[derive(Clone, Copy, Debug, Deserialize)]
#[cfg_attr(test, derive(JsonSchema))]
#[serde(deny_unknown_fields)]
pub(crate) struct RayFile {}

/// A cylinder or truncated cone.
#[derive(Clone, Copy, Debug, Deserialize)]
#[cfg_attr(test, derive(JsonSchema))]
#[serde(deny_unknown_fields)]
pub(crate) struct CylinderVolumeFile {
    /// At its near end [m].
    #[cfg_attr(test, schemars(range(min = 0.0)))]
    pub radius: f64,
    /// At its far end; default the same [m].
    #[cfg_attr(test, schemars(range(min = 0.0)))]
    pub far_radius: Option<f64>,
}

/// An opening.
#[derive(Clone, Copy, Debug, Deserialize)]
#[cfg_attr(test, derive(JsonSchema))]
#[serde(deny_unknown_fields)]
pub(crate) struct AngleFile {
    /// Between its outermost directions, at most 180 [deg].
    #[cfg_attr(test, schemars(extend("exclusiveMinimum" = 0.0)))]
    pub angle_deg: f64,
}

/// A box or truncated pyramid.
#[derive(Clone, Copy, Debug, Deserialize)]
#[cfg_attr(test, derive(JsonSchema))]
#[serde(deny_unknown_fields)]
pub(crate) struct PyramidFile {
    /// Widths along x and y at its near end [m].
    pub size: [f64; 2],
    /// Widths at its far end; default the same [m].
    pub far_size: Option<[f64; 2]>,
}

/// Kind of the sensor; none, with a diagnostic, if it has no volume.
pub(super) fn kind(
    file: &ProximityFile,
    name: &str,
    pointer: &str,
    document: &Document,
    diagnostics: &mut Diagnostics,
) -> Option<SensorKind> {
    let (key, volume) = match file {
        ProximityFile { cylinder: Some(c), .. } => {
            ("cylinder", Volume::Cylinder { radius: c.radius, far_radius: c.far_radius.unwrap_or(c.radius) })
        }
        ProximityFile { disc: Some(d), .. } => ("disc", Volume::Disc { angle: d.angle_deg.to_radians() }),
        ProximityFile { cone: Some(c), .. } => ("cone", Volume::Cone { angle: c.angle_deg.to_radians() }),
        ProximityFile { pyramid: Some(p), .. } => {
            ("pyramid", Volume::Pyramid { size: p.size, far_size: p.far_size.unwrap_or(p.size) })
        }
        ProximityFile { ray: Some(RayFile {}), .. } => ("ray", Volume::Ray),
        // the schema wants one of them
        _ => return None,
    };
    let &ProximityFile { offset, range, noise, .. } = file;
    if FieldOfView::new(volume, offset, range).is_some() {
        return Some(SensorKind::Proximity { volume, offset, range, noise });
    }
    let (at, what, help) = match volume {
        Volume::Disc { angle } | Volume::Cone { angle } => (
            format!("{key}/angle_deg"),
            format!("an angle of {}°", angle.to_degrees()),
            "expected more than 0° and at most 180°, from one outermost direction to the other",
        ),
        Volume::Cylinder { .. } => {
            (key.to_owned(), "no width".to_owned(), "give a radius above zero at one end at least, or use a ray")
        }
        Volume::Pyramid { size, far_size } => (
            key.to_owned(),
            format!("the widths {size:?} and {far_size:?}"),
            "give widths that are not negative, and above zero at one end at least, or use a disc or ray",
        ),
        Volume::Ray => ("range".to_owned(), format!("a range of {}", file.range), "give lengths that are finite"),
    };
    let at = document.at(&format!("{pointer}/proximity/{at}"));
    diagnostics.push(Diagnostic::error(&at, format!("proximity sensor `{name}` has {what}")).with_help(help));
    None
}

/// Returns true if anything of an object can be seen.
fn is_visible(object: &Object) -> bool {
    object.shown().next().is_some()
}

/// Finds the bodies that proximity sensors are fixed to and see.
pub(super) fn find_bodies(specs: &mut [SensorSpec], objects: &[Object], diagnostics: &mut Diagnostics) {
    let known: Vec<&str> = objects.iter().filter(|o| is_visible(o)).map(|o| o.path.as_str()).collect();
    for spec in specs.iter_mut().filter(|s| matches!(s.kind, SensorKind::Proximity { .. })) {
        let sensor = objects.iter().find(|o| o.path == spec.path).expect("a sensor is an object");
        let mut carrier = sensor.parent.map(|k| &objects[k]);
        while let Some(frame) = carrier.filter(|o| matches!(o.kind, ObjectKind::Frame)) {
            carrier = frame.parent.map(|k| &objects[k]);
        }
        spec.of = carrier.map_or_else(String::new, |o| o.path.clone());
        for path in spec.with.iter().filter(|path| !known.contains(&path.value.as_str())) {
            let message = match objects.iter().find(|o| o.path == path.value) {
                Some(o) => format!("`{}` is a {} without a shape to be seen", path.value, o.kind.word()),
                None => format!("there is no object `{}`", path.value),
            };
            let help = suggest::help(&path.value, &known, "bodies with shapes");
            diagnostics.push(Diagnostic::error(&path.at, message).with_help(help));
        }
    }
}
