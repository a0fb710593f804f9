//! Tendons.

use super::joint::activation;
use super::{Writer, last, place};
use crate::number::{list, number, quoted};
use crate::robot::TendonPath;

impl Writer<'_> {
    /// Writes all tendons whose path is in the scene.
    pub(super) fn tendons(&mut self) {
        for (k, tendon) in self.robot.tendons.iter().enumerate() {
            let keys = match &tendon.path {
                TendonPath::Through(links) => {
                    let paths: Option<Vec<_>> = links.iter().map(|link| self.link_paths[*link].as_ref()).collect();
                    let Some(paths) = paths else { continue };
                    vec![format!("through = [{}]", paths.iter().map(|p| quoted(p)).collect::<Vec<_>>().join(", "))]
                }
                TendonPath::Joints(shares) => {
                    let paths: Option<Vec<_>> = shares.iter().map(|(k, _)| self.joint_paths[*k].as_ref()).collect();
                    let Some(paths) = paths else { continue };
                    let coefficients: Vec<f64> = shares.iter().map(|(_, c)| *c).collect();
                    vec![
                        format!("joints = [{}]", paths.iter().map(|p| quoted(p)).collect::<Vec<_>>().join(", ")),
                        format!("coefficients = {}", list(&coefficients)),
                    ]
                }
            };
            let path = self.unique("/", &tendon.name);
            self.tendon_paths[k] = Some(path.clone());
            self.line(&format!("# {}", place(&tendon.at)));
            self.line("[[tendon]]");
            self.line(&format!("name = {}", quoted(last(&path))));
            keys.iter().for_each(|key| self.line(key));
            let [low, high] = tendon.free_length;
            if tendon.stiffness != 0.0 {
                let text = if low == high { number(low) } else { list(&[low, high]) };
                self.line(&format!("free_length = {text}"));
            }
            for (key, x) in [("stiffness", tendon.stiffness), ("damping", tendon.damping), ("preload", tendon.preload)]
            {
                if x != 0.0 {
                    self.line(&format!("{key} = {}", number(x)));
                }
            }
            if let Some(limits) = tendon.limits {
                let [low, high] = limits.range;
                let bound = |key: &str, x: f64| x.is_finite().then(|| format!("{key} = {}, ", number(x)));
                let bounds = [bound("lower", low), bound("upper", high)].into_iter().flatten().collect::<String>();
                let (stiffness, damping) = (number(limits.stiffness), number(limits.damping));
                self.line(&format!("limits = {{ {bounds}stiffness = {stiffness}, damping = {damping} }}"));
            }
            if let Some(max_force) = tendon.actuator {
                let limit = max_force.is_finite().then(|| format!("max_force = {}", number(max_force)));
                let command = (tendon.command != 0.0).then(|| format!("command = {}", number(tendon.command)));
                let activation = tendon.activation.as_ref().map(activation);
                let keys: Vec<String> = [command, limit, activation].into_iter().flatten().collect();
                self.line(&format!("actuator = {{ {} }}", keys.join(", ")));
            }
            self.line("");
        }
    }
}
