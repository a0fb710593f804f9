//! Mass properties that no robot can have: found, told, and repaired on request only.
//!
//! | found | told as | repair |
//! |---|---|---|
//! | a joint moves nothing that has mass | error | `min-inertia` |
//! | a moving link has mass and no inertia | warning | `min-inertia` |
//! | a principal moment is negative | error (warning if the link cannot move) | `positive-inertia` |
//! | the triangle inequality does not hold | warning: the dynamics is right for the matrix given | none |
//! | an inertia of rounding noise | warning: taken as zero | none |
//! | mass 0 with an inertia | warning: 1e-15 kg | none |
//!
//! A missing mass is never made up from shapes and a density.

use sincro_dynamics::model::MassProperties;
use sincro_scene::diagnostic::Diagnostic;

use crate::findings::Findings;
use crate::report::RepairMade;
use crate::robot::{Inertial, JointKind, Robot};
use crate::{Options, Repair};

/// Mass of a link that has inertia and no mass `[kg]`: bodies have mass, and this one changes no digit.
const NEXT_TO_NOTHING: f64 = 1e-15;
/// Mass that `min-inertia` gives `[kg]`.
const MIN_MASS: f64 = 1e-3;
/// Moments that `min-inertia` gives [kg·m²].
const MIN_MOMENT: f64 = 1e-6;
/// Share of the largest moment that `positive-inertia` leaves at least.
const MIN_SHARE: f64 = 1e-6;
/// Inertia a kilogram that no figure of a robot can mean [m²].
const ROUNDING: f64 = 1e-16;
/// Relative excess over the triangle inequality that is put down to rounding.
const TRIANGLE_SLACK: f64 = 1e-9;

/// Links that are fixed in the world.
pub(crate) fn fixed_in_world(robot: &Robot, free_base: bool) -> Vec<bool> {
    let mut fixed = vec![false; robot.links.len()];
    let carriers = robot.carriers();
    // a chain is as long as there are links at most
    for _ in 0..robot.links.len() {
        let mut changed = false;
        for link in 0..robot.links.len() {
            let now = match carriers[link] {
                None => !free_base,
                Some(j) => {
                    let joint = &robot.joints[j];
                    joint.kind == JointKind::Fixed && joint.parent.is_none_or(|p| fixed[p])
                }
            };
            changed |= now != fixed[link];
            fixed[link] = now;
        }
        if !changed {
            break;
        }
    }
    fixed
}

/// Checks and repairs all links.
pub(crate) fn check(robot: &mut Robot, options: &Options, findings: &mut Findings) -> Vec<RepairMade> {
    let fixed = fixed_in_world(robot, options.free_base);
    let mut repairs = Vec::new();
    for (link, fixed) in robot.links.iter_mut().zip(&fixed) {
        let Some(inertial) = &mut link.inertial else { continue };
        let name = &link.name;
        if inertial.mass < 0.0 {
            let message = format!("link `{name}` has a mass of {} kg", inertial.mass);
            findings.error(Diagnostic::error(&link.at, message).with_help("masses are positive"));
            continue;
        }
        let massless = inertial.mass == 0.0;
        if massless && inertial.inertia == [0.0; 6] {
            link.inertial = None;
            continue;
        }
        if massless {
            if *fixed {
                link.inertial = None;
                continue;
            }
            inertial.mass = NEXT_TO_NOTHING;
            let message = format!("link `{name}` has inertia and no mass: it gets {NEXT_TO_NOTHING:e} kg");
            findings.warn(
                Diagnostic::error(&link.at, message)
                    .with_help("bodies of the scene have mass; this one changes no digit"),
            );
        }
        if inertial.inertia != [0.0; 6] && inertial.inertia.iter().all(|i| i.abs() < ROUNDING * inertial.mass) {
            inertial.inertia = [0.0; 6];
            let message = format!("the inertia of link `{name}` is rounding noise: it is taken as zero");
            findings.warn(Diagnostic::error(&link.at, message).with_help("its entries are below 1e-16 times the mass"));
        }
        let properties = properties(inertial);
        let moments = properties.principal_moments();
        if moments[0] < -1e-12 * moments[2].abs() {
            let message =
                format!("the inertia of link `{name}` is not positive: its principal moments are {}", triple(moments));
            let at = Diagnostic::error(&link.at, message);
            if options.repairs.contains(&Repair::PositiveInertia) {
                let floor = (MIN_SHARE * moments[2].abs()).max(f64::MIN_POSITIVE);
                inertial.inertia = raised(inertial.inertia, floor);
                let after = self::properties(inertial).principal_moments();
                let what = format!("principal moments {} raised to {}", triple(moments), triple(after));
                repairs.push(RepairMade::new(Repair::PositiveInertia, &link.at, name, what));
            } else if *fixed {
                findings.warn(at.with_help("the link cannot move: its inertia is left out"));
                link.inertial = None;
            } else {
                findings.error(at.with_help("correct the file, or let `--repair positive-inertia` raise the moments"));
            }
        } else if properties.triangle_excess() > TRIANGLE_SLACK {
            let message =
                format!("no rigid body has the inertia of link `{name}`: principal moments {}", triple(moments));
            let help =
                "the triangle inequality does not hold; the matrix is kept as it is, and the dynamics is right for it";
            findings.warn(Diagnostic::error(&link.at, message).with_help(help));
        } else if moments[2] == 0.0 && !*fixed && options.repairs.contains(&Repair::MinInertia) {
            inertial.inertia = [MIN_MOMENT, 0.0, 0.0, MIN_MOMENT, 0.0, MIN_MOMENT];
            let what = format!("moments 0 raised to {MIN_MOMENT:e} kg·m²");
            repairs.push(RepairMade::new(Repair::MinInertia, &link.at, name, what));
        }
    }
    massless_joints(robot, options, findings, &mut repairs);
    repairs
}

/// Joints beyond which nothing has mass.
fn massless_joints(robot: &mut Robot, options: &Options, findings: &mut Findings, repairs: &mut Vec<RepairMade>) {
    let children: Vec<Vec<usize>> = (0..robot.links.len())
        .map(|link| robot.joints.iter().filter(|j| j.parent == Some(link)).map(|j| j.child).collect())
        .collect();
    let carriers = robot.carriers();
    for k in 0..robot.joints.len() {
        if robot.joints[k].kind == JointKind::Fixed {
            continue;
        }
        let (mut stack, mut has_mass, mut moving_beyond) = (vec![robot.joints[k].child], false, false);
        while let Some(link) = stack.pop() {
            has_mass |= robot.links[link].inertial.is_some();
            let moves = |c: &usize| carriers[*c].is_some_and(|j| robot.joints[j].kind != JointKind::Fixed);
            moving_beyond |= children[link].iter().any(moves);
            stack.extend(&children[link]);
        }
        if has_mass {
            continue;
        }
        let child = robot.joints[k].child;
        if options.repairs.contains(&Repair::MinInertia) && !moving_beyond {
            let inertia = [MIN_MOMENT, 0.0, 0.0, MIN_MOMENT, 0.0, MIN_MOMENT];
            let link = &mut robot.links[child];
            link.inertial = Some(Inertial { mass: MIN_MASS, center_of_mass: [0.0; 3], inertia });
            let what = format!("no mass: {MIN_MASS} kg with moments of {MIN_MOMENT:e} kg·m²");
            repairs.push(RepairMade::new(Repair::MinInertia, &link.at, &link.name, what));
        } else if !moving_beyond || !options.repairs.contains(&Repair::MinInertia) {
            let (joint, link) = (&robot.joints[k], &robot.links[child]);
            let message = format!(
                "joint `{}` moves link `{}`, which has no mass, and nothing beyond it has",
                joint.name, link.name
            );
            let help = format!("give the link an inertial, or let `--repair min-inertia` give it {MIN_MASS} kg");
            findings.error(Diagnostic::error(&link.at, message).with_help(help));
        }
    }
}

/// Mass properties as the dynamics has them.
pub(crate) fn properties(inertial: &Inertial) -> MassProperties {
    MassProperties { mass: inertial.mass, center_of_mass: inertial.center_of_mass, inertia: inertial.inertia }
}

fn triple(m: [f64; 3]) -> String {
    format!("{:.3e}, {:.3e}, {:.3e} kg·m²", m[0], m[1], m[2])
}

/// The matrix with its principal moments raised to `floor`, its axes kept.
fn raised([xx, xy, xz, yy, yz, zz]: [f64; 6], floor: f64) -> [f64; 6] {
    let mut a = [[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]];
    let mut axes = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    // Jacobi's method: each rotation zeroes one off-diagonal entry; a dozen sweeps are far more than enough
    for _ in 0..12 {
        for (p, q) in [(0, 1), (0, 2), (1, 2)] {
            if a[p][q] == 0.0 {
                continue;
            }
            let theta = (a[q][q] - a[p][p]) / (2.0 * a[p][q]);
            let t = theta.signum() / (theta.abs() + (theta * theta + 1.0).sqrt());
            let c = 1.0 / (t * t + 1.0).sqrt();
            let s = t * c;
            for k in 0..3 {
                (a[k][p], a[k][q]) = (c * a[k][p] - s * a[k][q], s * a[k][p] + c * a[k][q]);
            }
            for k in 0..3 {
                (a[p][k], a[q][k]) = (c * a[p][k] - s * a[q][k], s * a[p][k] + c * a[q][k]);
                (axes[k][p], axes[k][q]) = (c * axes[k][p] - s * axes[k][q], s * axes[k][p] + c * axes[k][q]);
            }
        }
    }
    let moments: [f64; 3] = std::array::from_fn(|k| a[k][k].max(floor));
    let entry = |i: usize, j: usize| (0..3).map(|k| axes[i][k] * moments[k] * axes[j][k]).sum::<f64>();
    [entry(0, 0), entry(0, 1), entry(0, 2), entry(1, 1), entry(1, 2), entry(2, 2)]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn raising_moments_keeps_the_positive_ones_and_the_axes() {
        let bad = [2.0, 3.0, 0.0, 2.0, 0.0, 1.0];
        let good = raised(bad, 0.1);
        let moments =
            |inertia| properties(&Inertial { mass: 1.0, center_of_mass: [0.0; 3], inertia }).principal_moments();
        assert!((moments(bad)[0] + 1.0).abs() < 1e-12);
        for (moment, expected) in moments(good).iter().zip([0.1, 1.0, 5.0]) {
            assert!((moment - expected).abs() < 1e-12, "{moment} {expected}");
        }
        assert!((good[0] - good[3]).abs() < 1e-12, "the axes are at 45°");
    }
}
