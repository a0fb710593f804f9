//! Loop joints: hard ones as closures, soft ones that are open at the start, or whose end may be moved, as bushings.

use super::{Writer, last, place};
use crate::number::{list, name, number, quoted};
use crate::path_mass::masses_between;
use crate::robot::{Loop, LoopKind, Softness};
use crate::source::ElementStatus;

/// A soft loop joint that is open by more than this at the start is a bushing `[m]`, `[rad]`.
pub(super) const OPEN: f64 = 1e-7;

impl Writer<'_> {
    /// Distance and angle (a measure of it) by which a loop joint is open at the start.
    pub(super) fn opening(&self, closure: &Loop, starts: &[f64]) -> f64 {
        let place = |k: usize| {
            let (link, placement) = &closure.ends[k];
            self.robot.link_pose(*link, starts).compose(&placement.pose())
        };
        let gap = place(0).inverse().compose(&place(1));
        let turned = (0..3).map(|k| 1.0 - gap.rot.0[k][k]).sum::<f64>().abs().sqrt();
        if closure.kind == LoopKind::Weld { gap.pos.norm().max(turned) } else { gap.pos.norm() }
    }

    /// Writes all loop joints.
    pub(super) fn loops(&mut self) {
        for closure in &self.robot.loops {
            let open = self.opening(closure, &self.starts);
            let soft = closure.softness.filter(|softness| softness.is_moved || open > OPEN);
            let keys = match soft {
                Some(softness) => {
                    let Some(keys) = self.bushing(closure, softness, open) else { continue };
                    keys
                }
                None => {
                    let (kind, axis) = match closure.kind {
                        LoopKind::Point => ("point", None),
                        LoopKind::Hinge(axis) => ("hinge", Some(axis)),
                        LoopKind::Weld => ("weld", None),
                    };
                    let axis = axis.map(|axis| format!("axis = {}", list(&axis)));
                    [format!("kind = \"{kind}\"")].into_iter().chain(axis).collect()
                }
            };
            let base = name(&closure.name);
            let mut ends = Vec::new();
            for (k, (link, placement)) in closure.ends.iter().enumerate() {
                let parent = link.and_then(|l| self.link_paths[l].clone()).unwrap_or_else(|| "/".into());
                if placement.is_identity() && link.is_some() {
                    ends.push(parent);
                    continue;
                }
                let path = self.unique(&parent, &format!("{base}-{}", ["a", "b"][k]));
                self.line("[[frame]]");
                self.line(&format!("name = {}", quoted(last(&path))));
                self.line(&format!("parent = {}", quoted(&parent)));
                self.placement(placement);
                self.line("");
                ends.push(path);
            }
            let path = self.unique("/", &base);
            self.line(&format!("# {}", place(&closure.at)));
            self.line(if soft.is_some() { "[[bushing]]" } else { "[[closure]]" });
            self.line(&format!("name = {}", quoted(last(&path))));
            if soft.is_none() {
                self.line(&keys[0]);
            }
            self.line(&format!("between = [{}, {}]", quoted(&ends[0]), quoted(&ends[1])));
            let rest = if soft.is_some() { &keys[..] } else { &keys[1..] };
            rest.iter().for_each(|key| self.line(key));
            self.line("");
        }
    }

    /// Keys of a soft loop as a bushing; none, with the reason noted, if it moves nothing.
    fn bushing(&mut self, closure: &Loop, softness: Softness, open: f64) -> Option<Vec<String>> {
        let at_anchors = closure.ends.map(|(link, placement)| (link, placement.position));
        let own = masses_between(self.robot, &softness.bodies).unwrap_or_default();
        // MuJoCo holds rigidly what moves at the anchor alone: the body turns about its centre of mass
        let anchored = if own[0] > 0.0 { own } else { masses_between(self.robot, &at_anchors).unwrap_or_default() };
        let ([mass, moment], is_weld) = ([anchored[0], own[1]], closure.kind == LoopKind::Weld);
        if mass == 0.0 && !(is_weld && moment > 0.0) {
            let words = "it moves nothing";
            self.context.ledger.judge_place(closure.element, ElementStatus::Dropped, words);
            self.written.warnings.push((closure.at.clone(), format!("`{}` is left out: {words}", closure.name)));
            return None;
        }
        let mut keys = Vec::new();
        let mut add = |key: &str, x: f64| {
            if x > 0.0 {
                // ten digits: masses are sums of rounded products
                keys.push(format!("{key} = {}", number(format!("{x:.9e}").parse().unwrap_or(x))));
            }
        };
        add("stiffness", mass * softness.stiffness);
        add("damping", mass * softness.damping);
        if is_weld {
            add("rotational_stiffness", softness.rotation * moment * softness.stiffness);
            add("rotational_damping", softness.rotation * moment * softness.damping);
        }
        let moments = match softness.rotation.sqrt() {
            _ if !is_weld => String::new(),
            half => format!(" and {moment:.4} kg·m², times (`torquescale`/2)² = {}²", number(half)),
        };
        let rigid = if own[0] > 0.0 || mass == 0.0 { "" } else { "; its source holds the anchor rigidly" };
        let why = if open > OPEN { format!("open at the start by {open:.3e}") } else { "to a mocap body".to_owned() };
        let words = format!(
            "soft and {why}: a [[bushing]], with the stiffness and damping of `solref` and `solimp` for {mass:.4} kg{moments}{rigid}"
        );
        self.context.ledger.judge_place(closure.element, ElementStatus::Changed, &words);
        Some(keys)
    }
}
