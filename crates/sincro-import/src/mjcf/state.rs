//! Sensors and keyframes.

use super::Reader;
use crate::findings::Findings;
use crate::robot::{JointKind, Keyframe, Placement, Robot, Sensor, SensorKind};
use crate::source::Element;

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

    /// Keyframes as named positions.
    pub(super) fn keyframes(&self, keyframes: Element<'d>, robot: &mut Robot, findings: &mut Findings) {
        for (k, key) in self.files.elements(keyframes).into_iter().enumerate() {
            key.keep();
            let name = key.attribute("name").map_or_else(|| format!("key{}", k + 1), str::to_owned);
            let Some(Some(q)) = findings.take(key.numbers("qpos")) else { continue };
            let width = |joint: usize| match robot.joints[joint].kind {
                JointKind::Free => 7,
                JointKind::Ball => 4,
                _ => 1,
            };
            if q.len() != self.order.iter().map(|j| width(*j)).sum::<usize>() {
                key.drop("the number of its coordinates is not that of the model");
                continue;
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
            key.change("a variant of the experiment");
            robot.keyframes.push(Keyframe { name, element: key.id(), positions });
        }
    }
}
