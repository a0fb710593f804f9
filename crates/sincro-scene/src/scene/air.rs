//! The air of a scene: wind, and drag elements on bodies; as written, and as the builder takes them.

#[cfg(test)]
use schemars::JsonSchema;
use serde::Deserialize;
use sincro_dynamics::aero::wind::{Gust, Profile, Scales, TurbulenceSpec, Wind, horizontal_speed};
use sincro_dynamics::model::DragSpec;

use crate::diagnostic::{Diagnostic, Diagnostics};
use crate::document::Document;
use crate::tree::join;

/// Wind: felt by rotors and drag elements.
#[derive(Debug, Deserialize)]
#[cfg_attr(test, derive(JsonSchema))]
#[serde(deny_unknown_fields)]
pub(crate) struct WindFile {
    /// Mean velocity, world axes [m/s].
    #[serde(default)]
    pub mean: [f64; 3],
    /// How the mean changes with height; default not at all.
    pub profile: Option<ProfileFile>,
    /// Gusts that rise, and fall, as a cosine.
    #[serde(default)]
    pub gust: Vec<GustFile>,
    /// Dryden's turbulence; the experiment's `seed` chooses which.
    pub turbulence: Option<TurbulenceFile>,
}

/// Mean wind over height; the ground is at z = 0 of the world.
#[derive(Clone, Copy, Debug, Deserialize)]
#[cfg_attr(test, derive(JsonSchema))]
#[serde(deny_unknown_fields)]
#[cfg_attr(test, schemars(extend("oneOf" = [{"required": ["linear"]}, {"required": ["logarithmic"]}])))]
pub(crate) struct ProfileFile {
    /// Proportional to height.
    pub linear: Option<LinearFile>,
    /// By the logarithm of height over roughness; none below it.
    pub logarithmic: Option<LogarithmicFile>,
}

/// A wind that grows with height.
#[derive(Clone, Copy, Debug, Deserialize)]
#[cfg_attr(test, derive(JsonSchema))]
#[serde(deny_unknown_fields)]
pub(crate) struct LinearFile {
    /// Height at which the wind is `mean` [m].
    #[cfg_attr(test, schemars(extend("exclusiveMinimum" = 0.0)))]
    pub reference: f64,
}

/// A wind over rough ground.
#[derive(Clone, Copy, Debug, Deserialize)]
#[cfg_attr(test, derive(JsonSchema))]
#[serde(deny_unknown_fields)]
pub(crate) struct LogarithmicFile {
    /// Height at which the wind is `mean` [m].
    #[cfg_attr(test, schemars(extend("exclusiveMinimum" = 0.0)))]
    pub reference: f64,
    /// Roughness of the ground: 0.046 for approach and landing, 0.61 elsewhere [m].
    #[cfg_attr(test, schemars(extend("exclusiveMinimum" = 0.0)))]
    pub roughness: f64,
}

/// A gust of 1 − cosine.
#[derive(Clone, Copy, Debug, Deserialize)]
#[cfg_attr(test, derive(JsonSchema))]
#[serde(deny_unknown_fields)]
pub(crate) struct GustFile {
    /// Where it begins [s].
    pub start: f64,
    /// Time to the peak [s].
    #[cfg_attr(test, schemars(extend("exclusiveMinimum" = 0.0)))]
    pub rise: f64,
    /// Velocity at the peak, world axes [m/s].
    pub peak: [f64; 3],
    /// Whether it stays at its peak; else it falls as it rose.
    #[serde(default)]
    pub holds: bool,
}

/// Dryden's turbulence: scales of the standard near the ground, or given outright.
#[derive(Clone, Copy, Debug, Deserialize)]
#[cfg_attr(test, derive(JsonSchema))]
#[serde(deny_unknown_fields)]
#[cfg_attr(test, schemars(extend("oneOf" = [{"required": ["low_altitude"]}, {"required": ["deviation"]}])))]
pub(crate) struct TurbulenceFile {
    /// Scales after MIL-F-8785C near the ground.
    pub low_altitude: Option<LowAltitudeFile>,
    /// Standard deviations along the mean wind, across it and upwards, with `length` [m/s].
    pub deviation: Option<[f64; 3]>,
    /// Lengths along the mean wind, across it and upwards, with `deviation` [m].
    pub length: Option<[f64; 3]>,
    /// Velocity at which the vehicle crosses the turbulence; default that of the mean wind, with `convected` its horizontal part and no other [m/s].
    #[cfg_attr(test, schemars(extend("exclusiveMinimum" = 0.0)))]
    pub airspeed: Option<f64>,
    /// True for a frozen field that the horizontal mean wind carries past: rotors side by side then feel different air.
    #[serde(default)]
    pub convected: bool,
}

/// Where turbulence is met near the ground.
#[derive(Clone, Copy, Debug, Deserialize)]
#[cfg_attr(test, derive(JsonSchema))]
#[serde(deny_unknown_fields)]
pub(crate) struct LowAltitudeFile {
    /// Mean wind at 20 feet, 6.1 m [m/s].
    #[cfg_attr(test, schemars(range(min = 0.0)))]
    pub wind_at_20_feet: f64,
    /// Height for which lengths and deviations are taken, 3.048 to 304.8 [m].
    #[cfg_attr(test, schemars(extend("exclusiveMinimum" = 0.0)))]
    pub height: f64,
}

/// Drag of a body: −½ρ·|u|·area·u − linear·u along each axis of its own frame, with u the velocity of its origin in the air.
#[derive(Debug, Deserialize)]
#[cfg_attr(test, derive(JsonSchema))]
#[serde(deny_unknown_fields)]
#[cfg_attr(test, schemars(extend("not" = {"required": ["rotation_deg", "quaternion_wxyz"]})))]
pub(crate) struct DragFile {
    /// Letters, digits, `_` and `-`; the path is the parent's path, `/` and the name.
    pub name: String,
    /// Path of the body or frame that feels it.
    pub parent: String,
    /// Centre of pressure in the parent frame [m].
    #[serde(default)]
    pub position: [f64; 3],
    /// Roll, pitch and yaw in the parent: R = Rz(yaw)·Ry(pitch)·Rx(roll) [deg].
    pub rotation_deg: Option<[f64; 3]>,
    /// Rotation in the parent as a quaternion (w, x, y, z), of any length but zero.
    pub quaternion_wxyz: Option<[f64; 4]>,
    /// Drag coefficient by area along x, y and z [m²].
    #[cfg_attr(test, schemars(extend("items" = {"type": "number", "minimum": 0.0})))]
    pub area: Option<[f64; 3]>,
    /// Linear coefficient along x, y and z [N·s/m].
    #[cfg_attr(test, schemars(extend("items" = {"type": "number", "minimum": 0.0})))]
    pub linear: Option<[f64; 3]>,
}

/// The wind; none, with the reasons noted, if it cannot be.
pub(super) fn wind(file: &WindFile, seed: u64, document: &Document, diagnostics: &mut Diagnostics) -> Option<Wind> {
    let profile = match file.profile {
        None => Profile::Constant,
        Some(ProfileFile { linear: Some(LinearFile { reference }), .. }) => Profile::Linear { reference },
        Some(ProfileFile { logarithmic: Some(LogarithmicFile { reference, roughness }), .. }) => {
            Profile::Logarithmic { reference, roughness }
        }
        Some(ProfileFile { linear: None, logarithmic: None }) => return None,
    };
    let gust = |g: &GustFile| Gust { start: g.start, rise: g.rise, peak: g.peak, holds: g.holds };
    let turbulence = match &file.turbulence {
        None => None,
        Some(turbulence) => Some(spec(turbulence, file.mean, seed, document, diagnostics)?),
    };
    match Wind::new(file.mean, profile, file.gust.iter().map(gust).collect(), turbulence) {
        Ok(wind) => Some(wind),
        Err(reasons) => {
            for reason in reasons {
                // a reason begins with the key that it is about, or with the number of a gust
                let key = reason.split('`').nth(1).unwrap_or("");
                let inner = ["turbulence/low_altitude", "turbulence", "profile/linear", "profile/logarithmic"];
                let mut pointers = inner.iter().map(|table| format!("/wind/{table}/{key}"));
                let written = pointers.find(|p| document.get(p).is_some()).unwrap_or_else(|| "/wind".into());
                diagnostics.push(Diagnostic::error(&document.at(&written), format!("wind: {reason}")));
            }
            None
        }
    }
}

fn spec(
    file: &TurbulenceFile,
    mean: [f64; 3],
    seed: u64,
    document: &Document,
    diagnostics: &mut Diagnostics,
) -> Option<TurbulenceSpec> {
    let at = |key: &str| document.at(&format!("/wind/turbulence{key}"));
    let scales = match (file.low_altitude, file.deviation, file.length) {
        (Some(LowAltitudeFile { wind_at_20_feet, height }), None, None) => {
            Scales::LowAltitude { wind_at_20_feet, height }
        }
        (Some(_), _, Some(_)) => {
            let diagnostic = Diagnostic::error(&at("/length"), "`length` has no meaning with `low_altitude`");
            diagnostics.push(diagnostic.with_help("leave it out: the standard gives the lengths at that height"));
            return None;
        }
        (None, Some(deviations), Some(lengths)) => Scales::Given { deviations, lengths },
        _ => {
            let diagnostic = Diagnostic::error(&at(""), "`length` is missing in `turbulence`");
            diagnostics.push(
                diagnostic.with_help("`length`: three lengths [m] that go with the deviations, or take `low_altitude`"),
            );
            return None;
        }
    };
    let of_mean = if file.convected {
        Some(horizontal_speed(mean))
    } else {
        Some(mean.iter().map(|x| x * x).sum::<f64>().sqrt()).filter(|speed| *speed > 0.0)
    };
    let Some(airspeed) = file.airspeed.or(of_mean) else {
        let diagnostic = Diagnostic::error(
            &at(""),
            "`airspeed` is missing in `turbulence`, and there is no mean wind to take it from",
        );
        diagnostics
            .push(diagnostic.with_help("`airspeed`: velocity [m/s] at which the vehicle crosses the turbulence"));
        return None;
    };
    Some(TurbulenceSpec { seed, scales, airspeed, convected: file.convected })
}

/// The drag element; notes one that does nothing.
pub(super) fn drag(
    file: &DragFile,
    pointer: &str,
    density: f64,
    document: &Document,
    diagnostics: &mut Diagnostics,
) -> DragSpec {
    if file.area.is_none() && file.linear.is_none() {
        let message = format!("drag `{}` has neither `area` nor `linear`", join(&file.parent, &file.name));
        let diagnostic = Diagnostic::error(&document.title_at(pointer), message);
        diagnostics.push(diagnostic.with_help("give drag areas [m²], linear coefficients [N·s/m], or both"));
    }
    DragSpec { area: file.area.unwrap_or_default(), linear: file.linear.unwrap_or_default(), density }
}
