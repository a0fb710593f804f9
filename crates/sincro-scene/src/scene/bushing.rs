//! Bushings in scene files: as written, and as the builder takes them.

#[cfg(test)]
use schemars::JsonSchema;
use serde::Deserialize;
use sincro_dynamics::model::{BushingSpec, NodeId};
use sincro_dynamics::spatial::Pose;

use super::file::OneOrList;
use crate::diagnostic::{Diagnostic, Diagnostics};
use crate::document::Document;

/// Compliant element with six degrees of freedom between two bodies or frames: without force where their frames
/// coincide. Lists have one number for each axis of the first of them, one number counts for all three.
#[derive(Clone, Debug, Deserialize)]
#[cfg_attr(test, derive(JsonSchema))]
#[serde(deny_unknown_fields)]
pub(crate) struct BushingFile {
    /// Letters, digits, `_` and `-`; its path is `/` and the name.
    pub name: String,
    /// Paths of the two bodies or frames, or `/`, whose frames it keeps together.
    pub between: [String; 2],
    /// Force −stiffness·x on the second, x its position in the first [N/m].
    pub stiffness: Option<OneOrList<f64>>,
    /// Force −damping·v on the second, v the rate of that position [N·s/m].
    pub damping: Option<OneOrList<f64>>,
    /// Stiffness against rotation: the torque is that of the energy ½ Σ kᵢ φᵢ², φ the rotation vector [N·m/rad].
    pub rotational_stiffness: Option<OneOrList<f64>>,
    /// Torque −damping·ω on the second, ω its angular velocity as seen from the first [N·m·s/rad].
    pub rotational_damping: Option<OneOrList<f64>>,
}

/// The specification, for ends that were found; none, with the reasons noted, if it cannot be.
pub(super) fn spec(
    file: &BushingFile,
    ends: [NodeId; 2],
    pointer: &str,
    document: &Document,
    diagnostics: &mut Diagnostics,
) -> Option<BushingSpec> {
    let of = format!("bushing `{}`", file.name);
    let mut is_whole = true;
    let mut three = |key: &str, own: &Option<OneOrList<f64>>| match own.as_ref().map(OneOrList::as_slice) {
        None => [0.0; 3],
        Some(&[x]) if matches!(own, Some(OneOrList::One(_))) => [x; 3],
        Some(&[x, y, z]) => [x, y, z],
        Some(list) => {
            let message = format!("{key} of {of} has {} numbers", list.len());
            let at = document.at(&format!("{pointer}/{key}"));
            let help = "give one number, or three: of the axes x, y and z of the first frame";
            diagnostics.push(Diagnostic::error(&at, message).with_help(help));
            is_whole = false;
            [0.0; 3]
        }
    };
    let ([a, b, c], [d, e, f]) =
        (three("stiffness", &file.stiffness), three("rotational_stiffness", &file.rotational_stiffness));
    let stiffness = [a, b, c, d, e, f];
    let ([a, b, c], [d, e, f]) =
        (three("damping", &file.damping), three("rotational_damping", &file.rotational_damping));
    let spec =
        BushingSpec { ends, poses: [Pose::identity(), Pose::identity()], stiffness, damping: [a, b, c, d, e, f] };
    let problems = spec.problems(&of);
    for (key, message, help) in &problems {
        let at = document.at(&format!("{pointer}/{key}"));
        diagnostics.push(Diagnostic::error(&at, message.clone()).with_help(*help));
    }
    if is_whole && spec.stiffness == [0.0; 6] && spec.damping == [0.0; 6] {
        let diagnostic = Diagnostic::error(&document.title_at(pointer), format!("{of} has no force"));
        let help = "give `stiffness` [N/m], `damping` [N·s/m], `rotational_stiffness` [N·m/rad] or \
                    `rotational_damping` [N·m·s/rad]";
        diagnostics.push(diagnostic.with_help(help));
        return None;
    }
    (is_whole && problems.is_empty()).then_some(spec)
}
