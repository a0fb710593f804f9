//! Tendons of MJCF: springs, dampers and actuators between points, and tendons; soft equalities: bushings.

use sincro_dynamics::actuation::NonlinearLaw;
use sincro_dynamics::actuation::bushing::Bushing;
use sincro_dynamics::model::Attached;
use sincro_dynamics::spatial::{Mat3, Pose, Vec3};

use super::mjcf::{activation_keys, is_site};
use super::{Tree, escaped, numbers, wxyz};
use crate::number::plain;
use crate::path_mass::masses_of;

/// Impedance of soft equalities (dimensionless).
const IMPEDANCE: f64 = 0.95;

/// Relative difference of stiffnesses over masses that is rounding of printed figures.
const SAME: f64 = 1e-6;

/// Ratio to `mass` of numbers along three axes that are the same; none if they differ, or act where no mass moves.
fn common(numbers: &[f64], mass: f64) -> Option<f64> {
    let most = numbers.iter().copied().fold(0.0, f64::max);
    let is_common = numbers.iter().all(|x| most - x <= SAME * most) && (mass > 0.0 || most == 0.0);
    is_common.then_some(if most == 0.0 { 0.0 } else { most / mass })
}

/// Stiffness and damping over mass, and the ratio of those over moment of inertia to them, of a bushing that has one
/// time constant.
fn time_constants(bushing: &Bushing<f64>, [mass, moment]: [f64; 2]) -> Option<([f64; 2], f64)> {
    let numbers = [&bushing.stiffness, &bushing.damping];
    let [along, about] = [(0, mass), (3, moment)].map(|(k, inertia)| numbers.map(|n| common(&n[k..k + 3], inertia)));
    let ([Some(stiffness), Some(damping)], [Some(turning), Some(turning_damping)]) = (along, about) else {
        return None;
    };
    let ratio = if stiffness > 0.0 { turning / stiffness } else { turning_damping / damping };
    let is_same = |a: f64, b: f64| (a - b).abs() <= SAME * a.max(b);
    let has_one = is_same(turning, ratio * stiffness) && is_same(turning_damping, ratio * damping);
    has_one.then_some(([stiffness, damping], ratio))
}

/// A site that a tendon runs through, or that is a frame of a bushing.
struct Site {
    name: String,
    /// Link of the tree that carries it; none for the world.
    link: Option<usize>,
    /// In the frame of that link.
    pose: Pose<f64>,
}

/// Tendons of a scene with their sites.
pub(super) struct Tendons {
    sites: Vec<Site>,
    /// Sites of each element of the model; empty for one over joints.
    of_elements: Vec<Vec<usize>>,
    /// Sites of each bushing of the model.
    of_bushings: Vec<[usize; 2]>,
    /// Names of the sites at the ends of each loop joint of the model.
    of_loops: Vec<[String; 2]>,
}

/// Name of an element in the file.
pub(super) fn name_of(path: &str) -> String {
    escaped(path.trim_start_matches('/'))
}

impl Tendons {
    /// The sites that the elements of a scene need.
    pub fn of(tree: &Tree<'_>) -> Self {
        let model = &tree.scene.model;
        let (mut sites, mut of_elements) = (Vec::new(), Vec::new());
        let site = |name: String, link: Option<usize>, pose: Pose<f64>| {
            let carrier = link.and_then(|link| {
                (0..tree.links.len()).filter(|k| !is_site(tree, *k)).find_map(|k| {
                    let path = &tree.scene.objects[tree.links[k].object].path;
                    let info = model.names().frames.iter().find(|frame| frame.name == *path)?;
                    (info.link == Some(link)).then(|| (k, info.pose.inverse().compose(&pose)))
                })
            });
            let (link, pose) = carrier.map_or((None, pose), |(k, pose)| (Some(k), pose));
            Site { name, link, pose }
        };
        for (element, path) in model.spring_dampers().iter().zip(&model.names().spring_dampers) {
            let ends = element.segments().first().map(|s| s.ends[0]);
            let points = ends.into_iter().chain(element.segments().iter().map(|s| s.ends[1]));
            let mut own = Vec::new();
            for (k, point) in points.enumerate() {
                own.push(sites.len());
                sites.push(site(format!("{}-{}", name_of(path), k + 1), point.link, Pose::translation(point.position)));
            }
            of_elements.push(own);
        }
        let mut of_bushings = Vec::new();
        for (element, path) in model.bushings().iter().zip(&model.names().bushings) {
            of_bushings.push([sites.len(), sites.len() + 1]);
            sites.extend((0..2).map(|k| {
                let end = element.ends[k];
                site(format!("{}-{}", name_of(path), k + 1), end.link, end.pose)
            }));
        }
        let mut of_loops = Vec::new();
        for closure in &model.constraints().loop_joints {
            of_loops.push([(0, &closure.a), (1, &closure.b)].map(|(k, end)| {
                let named = |l: &usize| tree.scene.objects[tree.links[*l].object].path == end.name;
                // a frame at the end is a site already
                if let Some(l) = (0..tree.links.len()).find(named).filter(|l| is_site(tree, *l)) {
                    return escaped(&tree.links[l].name);
                }
                let name = format!("{}-{}", name_of(&closure.name), k + 1);
                let link = model.names().frame(&end.name).and_then(|frame| frame.link);
                sites.push(site(name.clone(), link, end.pose));
                name
            }));
        }
        Self { sites, of_elements, of_bushings, of_loops }
    }

    /// Centre of mass of the body that carries a site, as a frame of its link in the model; MuJoCo takes the position
    /// of a body for that of one without mass.
    fn centre(&self, tree: &Tree<'_>, site: usize) -> Option<Attached<f64>> {
        let Some(k) = self.sites[site].link else { return Some(Attached { link: None, pose: Pose::identity() }) };
        let body = &tree.links[k];
        let path = &tree.scene.objects[body.object].path;
        let info = tree.scene.model.names().frame(path)?;
        let point = body.mass.map_or(body.pose.pos, |mass| Vec3(mass.center_of_mass));
        Some(Attached { link: info.link, pose: info.pose.compose(&Pose::translation(point)) })
    }

    /// Lines of the bushings as soft equalities, whose stiffness and damping are those of the masses that MuJoCo gives
    /// them; notes those that are none.
    pub fn bushings(&self, tree: &mut Tree<'_>) -> String {
        let model = &tree.scene.model;
        let mut lines = String::new();
        for (k, (element, path)) in model.bushings().iter().zip(&model.names().bushings).enumerate() {
            let is_point = element.stiffness[3..] == [0.0; 3] && element.damping[3..] == [0.0; 3];
            let centres = self.of_bushings[k].map(|site| self.centre(tree, site));
            let constants = match centres {
                [Some(a), Some(b)] => time_constants(element, masses_of(model, &[a, b])),
                _ => None,
            };
            let Some((rates, ratio)) = constants else {
                tree.note(
                    path,
                    "MJCF has no spring between frames, and its soft welds have one time constant: not written",
                );
                continue;
            };
            let [stiffness, damping] = rates.map(|x| -(1.0 - IMPEDANCE) * x);
            // the rotation of a weld has (torquescale/2)² of the stiffness and damping
            let scale = format!(" torquescale=\"{}\"", plain(2.0 * ratio.sqrt()));
            let (kind, scale) = if is_point { ("connect", "") } else { ("weld", scale.as_str()) };
            let [one, two] = self.of_bushings[k].map(|site| self.sites[site].name.clone());
            lines += &format!(
                "    <{kind} name=\"{}\" site1=\"{one}\" site2=\"{two}\"{scale} solref=\"{} {}\" solimp=\"{IMPEDANCE} {IMPEDANCE} 0.001\"/>\n",
                name_of(path),
                plain(stiffness),
                plain(damping)
            );
            tree.note(
                path,
                "MJCF's stiffness and damping follow the mass that moves: they are these at zero coordinates only",
            );
        }
        lines
    }

    /// Names of the sites at the ends of loop joint `k` of the model.
    pub fn of_loop(&self, k: usize) -> &[String; 2] {
        &self.of_loops[k]
    }

    /// Writes the sites on a link, or in the world.
    pub fn sites_of(&self, link: Option<usize>, out: &mut String, pad: &str) {
        for site in self.sites.iter().filter(|site| site.link == link) {
            let turned = site.pose.rot != Mat3::identity();
            let quat = if turned { format!(" quat=\"{}\"", numbers(&wxyz(&site.pose))) } else { String::new() };
            *out += &format!("{pad}<site name=\"{}\" pos=\"{}\"{quat}/>\n", site.name, numbers(&site.pose.pos.0));
        }
    }

    /// Writes the section of tendons; notes what they cannot say.
    pub fn write(&self, out: &mut String, tree: &mut Tree<'_>) {
        let scene = tree.scene;
        let model = &scene.model;
        let mut lines = String::new();
        for (k, (element, path)) in model.spring_dampers().iter().zip(&model.names().spring_dampers).enumerate() {
            let mut keys = format!("name=\"{}\"", name_of(path));
            let law = &element.law;
            if law.stiffness != 0.0 {
                let free = plain(element.free_length);
                let lengths = if element.tension_only { format!("0 {free}") } else { free };
                keys += &format!(" stiffness=\"{}\" springlength=\"{lengths}\"", plain(law.stiffness));
                if element.free_length == -1.0 && !element.tension_only {
                    tree.note(path, "MJCF takes a free length of −1 for that at the start");
                }
            }
            if law.damping != 0.0 {
                keys += &format!(" damping=\"{}\"", plain(law.damping));
                if element.tension_only {
                    tree.note(path, "its damper acts in MJCF when it is slack, too");
                }
            }
            if law.preload != 0.0 {
                tree.note(path, "MJCF has no preload: it is not written");
            }
            match law.nonlinear.as_deref() {
                None => {}
                Some(NonlinearLaw::Ranges(ranges)) => {
                    for range in ranges {
                        let [low, high] = [range.low, range.high].map(|x| x + element.free_length);
                        // a dead band of MJCF has lengths that are not negative, as those of lines are anyway
                        let low = if element.shares().is_empty() { low.max(0.0) } else { low };
                        let is_band = range.damping == 0.0 && low >= 0.0 && high.is_finite();
                        if is_band && law.stiffness == 0.0 && !keys.contains("springlength") {
                            let lengths = numbers(&[low, high]);
                            keys += &format!(" stiffness=\"{}\" springlength=\"{lengths}\"", plain(range.stiffness));
                        } else {
                            let [low, high] = [low.max(-1e9), high.min(1e9)];
                            keys += &format!(" range=\"{}\"", numbers(&[low, high]));
                            tree.note(path, "stops of MJCF have a softness of their own");
                        }
                    }
                }
                Some(_) => tree.note(path, "its law or table is not written"),
            }
            if element.shares().is_empty() {
                tree.note(path, "its points are sites of their own in MJCF");
            } else if element.actuator.is_some()
                && (law.stiffness != 0.0 || law.damping != 0.0 || law.nonlinear.is_some())
            {
                tree.note(path, "MJCF drives it by an element of its own");
            }
            let parts: String = if element.shares().is_empty() {
                let site = |s: &usize| format!("      <site site=\"{}\"/>\n", self.sites[*s].name);
                self.of_elements[k].iter().map(site).collect()
            } else {
                let joint = |dof: usize| {
                    let path = &model.names().joint_of(dof).name;
                    tree.links.iter().flat_map(|l| &l.joints).find(|j| j.path == *path).map(|j| escaped(&j.name))
                };
                let share = |share: &sincro_dynamics::actuation::spring_damper::JointShare<f64>| {
                    let name = joint(share.dof)?;
                    Some(format!("      <joint joint=\"{name}\" coef=\"{}\"/>\n", plain(share.coefficient)))
                };
                element.shares().iter().filter_map(share).collect()
            };
            let word = if element.shares().is_empty() { "spatial" } else { "fixed" };
            lines += &format!("    <{word} {keys}>\n{parts}    </{word}>\n");
        }
        if !lines.is_empty() {
            *out += &format!("  <tendon>\n{lines}  </tendon>\n");
        }
    }

    /// Lines of the actuators on tendons.
    pub fn actuators(&self, tree: &mut Tree<'_>) -> String {
        let scene = tree.scene;
        let model = &scene.model;
        let mut lines = String::new();
        for (element, path) in model.spring_dampers().iter().zip(&model.names().spring_dampers) {
            let Some(actuator) = element.actuator else { continue };
            let (name, max) = (name_of(path), actuator.max_force);
            let limit = if max.is_finite() && max > 0.0 {
                format!(" forcerange=\"{0} {1}\"", plain(-max), plain(max))
            } else {
                String::new()
            };
            if let Some(activation) = model.activations().iter().find(|own| own.command == actuator.command) {
                let keys = activation_keys(tree, path, activation);
                lines += &format!("    <general name=\"{name}\" tendon=\"{name}\" gainprm=\"1\" {keys}{limit}/>\n");
                continue;
            }
            lines += &format!("    <motor name=\"{name}\" tendon=\"{name}\"{limit}/>\n");
        }
        lines
    }
}
