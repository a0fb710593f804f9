//! Sensors and keyframes.

use super::Reader;
use crate::findings::Findings;
use crate::robot::{Actuator, JointKind, Keyframe, Placement, Robot, Sensor, SensorKind};
use crate::source::Element;

/// Norm below which a quaternion has no direction; MuJoCo's `mjMINVAL`.
const LEAST_NORM: f64 = 1e-15;

impl<'d> Reader<'d> {
    /// Accelerometers and gyros of a site are one inertial measurement unit.
    pub(super) fn sensors(&self, sensors: Element<'d>, robot: &mut Robot) {
        for element in self.files.elements(sensors) {
            if !matches!(element.name(), "accelerometer" | "gyro") {
                continue;
            }
            element.keep();
            let name = element.attribute("name").unwrap_or("imu").to_owned();
            let Some(&link) = element.attribute("site").and_then(|site| self.sites.get(site)) else {
                element.drop("its site is not there");
                continue;
            };
            element.change("part of an imu, which measures acceleration and angular velocity");
            if robot.sensors.iter().any(|s| s.link == link && s.kind == SensorKind::Imu) {
                continue;
            }
            robot.sensors.push(Sensor {
                name: format!("{name}-imu"),
                at: element.location(),
                link,
                pose: Placement::default(),
                kind: SensorKind::Imu,
            });
        }
    }

    /// Keyframes as named positions, commands and activations.
    pub(super) fn keyframes(&self, keyframes: Element<'d>, robot: &mut Robot, findings: &mut Findings) {
        for (k, key) in self.files.elements(keyframes).into_iter().enumerate() {
            key.keep();
            let name = key.attribute("name").map_or_else(|| format!("key{}", k + 1), str::to_owned);
            let [Some(q), Some(controls), Some(activations)] =
                ["qpos", "ctrl", "act"].map(|list| findings.take(key.numbers(list)))
            else {
                continue;
            };
            let Some(mut positions) = self.positions_of(q.as_deref(), robot) else {
                key.drop("the number of its coordinates is not that of the model");
                continue;
            };
            positions.iter_mut().for_each(|(_, own)| without_zero_rotation(key, own));
            robot.keyframes.push(Keyframe {
                name,
                element: key.id(),
                positions,
                commands: controls.map_or_else(Vec::new, |list| self.commands_of(key, &list)),
                activations: activations.map_or_else(Vec::new, |list| self.activations_of(key, &list)),
            });
        }
    }

    /// Joints with their coordinates, none where the file gives none: those of the reference. `None` if their number is
    /// not that of the model.
    fn positions_of(&self, q: Option<&[f64]>, robot: &Robot) -> Option<Vec<(usize, Vec<f64>)>> {
        let Some(q) = q else { return Some(Vec::new()) };
        let width = |joint: usize| match robot.joints[joint].kind {
            JointKind::Free => 7,
            JointKind::Ball => 4,
            _ => 1,
        };
        if q.len() != self.order.iter().map(|j| width(*j)).sum::<usize>() {
            return None;
        }
        let (mut at, mut positions) = (0, Vec::new());
        for joint in &self.order {
            let n = width(*joint);
            let mut own = q[at..at + n].to_vec();
            if n == 1 {
                own[0] -= self.references[*joint];
            }
            at += n;
            positions.push((*joint, own));
        }
        Some(positions)
    }

    /// Actuators with the commands of controls.
    fn commands_of(&self, key: Element<'d>, controls: &[f64]) -> Vec<(Actuator, f64)> {
        let n: usize = self.actuators.iter().map(|known| known.n_controls).sum();
        if controls.len() != n {
            key.change(&format!("`ctrl` has {} numbers, not {n}: it is left out", controls.len()));
            return Vec::new();
        }
        let (mut rest, mut commands) = (controls, Vec::new());
        for known in &self.actuators {
            let (values, others) = rest.split_at(known.n_controls);
            rest = others;
            match (known.made, values) {
                (Some((actuator, unit)), [control]) => {
                    let acts = unit.clamped(*control);
                    if acts != *control && unit.scale != 0.0 {
                        key.change(&format!("a control of {control} is beyond its `ctrlrange`: it is {acts}"));
                    }
                    commands.push((actuator, unit.command(*control)));
                }
                _ if values.iter().any(|x| *x != 0.0) => {
                    key.change("`ctrl` of an actuator that is no motor here is left out");
                }
                _ => {}
            }
        }
        commands
    }

    /// Actuators with activations, which start within their ranges.
    fn activations_of(&self, key: Element<'d>, given: &[f64]) -> Vec<(Actuator, f64)> {
        let n: usize = self.actuators.iter().map(|known| known.n_activations).sum();
        if given.len() != n {
            key.change(&format!("`act` has {} numbers, not {n}: it is left out", given.len()));
            return Vec::new();
        }
        let (mut rest, mut activations) = (given, Vec::new());
        for known in &self.actuators {
            let (values, others) = rest.split_at(known.n_activations);
            rest = others;
            let Some(x) = values.first() else { continue };
            match (known.made, known.activation) {
                (Some((actuator, unit)), Some(own)) => {
                    let wanted = unit.scale * x + unit.offset;
                    let start = own.saturated(wanted);
                    if start != wanted {
                        key.change("an activation of `act` is beyond its range: it starts at the end");
                    }
                    activations.push((actuator, start));
                }
                _ if values.iter().any(|x| *x != 0.0) => {
                    key.change("`act` of an actuator without activation here is left out")
                }
                _ => {}
            }
        }
        activations
    }
}

/// Makes a quaternion of zeros in the coordinates of a joint that of no rotation.
fn without_zero_rotation(key: Element<'_>, coordinates: &mut [f64]) {
    let Some(first) = coordinates.len().checked_sub(4) else { return };
    let quaternion = &mut coordinates[first..];
    if quaternion.iter().map(|x| x * x).sum::<f64>().sqrt() < LEAST_NORM {
        quaternion.copy_from_slice(&[1.0, 0.0, 0.0, 0.0]);
        key.change("a quaternion of zeros is no rotation, as in MuJoCo");
    }
}
