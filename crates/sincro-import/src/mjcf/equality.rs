//! Equalities as loop joints or bushings, gears, and stiff tendons.

use sincro_dynamics::spatial::{Pose, Vec3};
use sincro_scene::diagnostic::Diagnostic;

use super::Reader;
use super::tendon::softness;
use crate::findings::Findings;
use crate::robot::{Gear, Loop, LoopKind, Placement, Robot, Softness};
use crate::source::Element;

/// Impedance of an open constraint where the source gives none (dimensionless).
const IMPEDANCE: f64 = 0.95;

impl<'d> Reader<'d> {
    /// All equalities.
    pub(super) fn equalities(&mut self, equality: Element<'d>, robot: &mut Robot, findings: &mut Findings) {
        for element in self.files.elements(equality) {
            element.keep();
            element.attribute("name");
            if !self.defaults.is_active(element) {
                element.drop("it is not active");
                continue;
            }
            let made = match element.name() {
                "connect" => self.connect(element, robot),
                "weld" => self.weld(element, robot),
                "joint" => self.coupled(element, robot),
                "tendon" => self.held_tendon(element, robot, findings),
                other => Err(element.error(format!("equality of `{other}` has no counterpart"))),
            };
            findings.take(made);
        }
    }

    fn end(&self, e: Element<'d>, key: &str) -> Result<Option<usize>, Diagnostic> {
        match e.attribute(key) {
            None | Some("world") => Ok(None),
            Some(name) => {
                let found = self.bodies.get(name).copied();
                found.map(Some).ok_or_else(|| e.error(format!("there is no body `{name}`")))
            }
        }
    }

    fn site_end(&self, e: Element<'d>, key: &str) -> Result<Option<usize>, Diagnostic> {
        let name = e.attribute(key).unwrap_or_default();
        self.sites.get(name).copied().map(Some).ok_or_else(|| e.error(format!("there is no site `{name}`")))
    }

    fn connect(&mut self, e: Element<'d>, robot: &mut Robot) -> Result<(), Diagnostic> {
        let by_sites = e.peek("site1").is_some();
        let ends = if by_sites {
            [self.site_end(e, "site1")?, self.site_end(e, "site2")?]
        } else {
            [self.end(e, "body1")?, self.end(e, "body2")?]
        };
        let anchor = Placement::new(e.vector("anchor")?.unwrap_or_default(), [0.0; 3]);
        let [x_wa, x_wb] = ends.map(|end| robot.link_pose(end, &[]));
        let point = x_wb.inverse().point(x_wa.point(Vec3(anchor.position)));
        let other = if by_sites { Placement::default() } else { Placement::new(point.0, [0.0; 3]) };
        let softness = self.loop_softness(e, ends, robot, 1.0)?;
        e.change("a hard ball joint that closes a loop: a [[closure]]");
        let name = e.peek("name").map_or_else(|| format!("connect{}", robot.loops.len() + 1), str::to_owned);
        robot.loops.push(Loop {
            name,
            at: e.location(),
            element: e.id(),
            kind: LoopKind::Point,
            softness: Some(softness),
            ends: [(ends[0], anchor), (ends[1], other)],
        });
        Ok(())
    }

    fn weld(&mut self, e: Element<'d>, robot: &mut Robot) -> Result<(), Diagnostic> {
        let by_sites = e.peek("site1").is_some();
        let ends = if by_sites {
            [self.site_end(e, "site1")?, self.site_end(e, "site2")?]
        } else {
            [self.end(e, "body1")?, self.end(e, "body2")?]
        };
        let [x_wa, x_wb] = ends.map(|end| robot.link_pose(end, &[]));
        let anchor = Pose::translation(Vec3(e.vector("anchor")?.unwrap_or_default()));
        // the frame on the first body that the anchor on the second is held in
        let (first, second) = match e.numbers("relpose")?.as_deref() {
            _ if by_sites => (Placement::default(), Placement::default()),
            Some(&[x, y, z, w, i, j, k]) if w * w + i * i + j * j + k * k > 0.0 => {
                let rotation = crate::robot::Rotation::Quaternion([w, i, j, k]);
                let given = Placement { position: [x, y, z], rotation }.pose();
                (Placement::of_pose(&given), Placement::of_pose(&anchor))
            }
            _ => (Placement::of_pose(&x_wa.inverse().compose(&x_wb).compose(&anchor)), Placement::of_pose(&anchor)),
        };
        let torque_scale = e.number("torquescale")?.unwrap_or(1.0);
        let softness = self.loop_softness(e, ends, robot, torque_scale)?;
        let kind = if torque_scale == 0.0 { LoopKind::Point } else { LoopKind::Weld };
        e.change(match kind {
            LoopKind::Weld => "a hard weld: a [[closure]]",
            _ => "with a `torquescale` of 0 it holds no rotation: a hard ball joint, a [[closure]]",
        });
        let name = e.peek("name").map_or_else(|| format!("weld{}", robot.loops.len() + 1), str::to_owned);
        robot.loops.push(Loop {
            name,
            at: e.location(),
            element: e.id(),
            kind,
            softness: Some(softness),
            ends: [(ends[0], first), (ends[1], second)],
        });
        Ok(())
    }

    /// Softness of a loop that holds two links together.
    ///
    /// A constraint with the impedance d accelerates a mass by (1 − d) of what other forces would, plus d of its
    /// reference acceleration: it is the spring and damper that the time constant gives to a mass m/(1 − d). The
    /// residual of a weld in rotation by θ is s sin(θ/2) with the torque scale s, its Jacobian about s/2, and the
    /// moment of inertia is not scaled: (s/2)² of the stiffness and damping.
    fn loop_softness(
        &self,
        e: Element<'d>,
        ends: [Option<usize>; 2],
        robot: &Robot,
        torque_scale: f64,
    ) -> Result<Softness, Diagnostic> {
        let impedance = self.defaults.equality_numbers(e, "solimp")?.and_then(|d| d.get(1).copied());
        let apparent = 1.0 / (1.0 - impedance.unwrap_or(IMPEDANCE).clamp(1e-4, 0.9999));
        let (stiffness, damping) = softness(self.defaults.equality_numbers(e, "solref")?, apparent);
        let carrier = |site: usize| robot.joints.iter().find(|joint| joint.child == site)?.parent;
        let is_site = |link: usize| self.sites.values().any(|site| *site == link);
        let bodies = ends.map(|end| end.and_then(|link| if is_site(link) { carrier(link) } else { Some(link) }));
        let is_moved = bodies.iter().flatten().any(|link| self.mocap.contains(link));
        let centre = |link: usize| match &robot.links[link].inertial {
            Some(inertial) if inertial.mass > 0.0 => inertial.center_of_mass,
            _ => self.positions.get(&link).copied().unwrap_or_default(),
        };
        let bodies = bodies.map(|body| (body, body.map_or([0.0; 3], centre)));
        Ok(Softness { stiffness, damping, rotation: 0.25 * torque_scale * torque_scale, bodies, is_moved })
    }

    /// q₁ − q₁₀ = Σ cₖ (q₂ − q₂₀)ᵏ, k = 0 to 4.
    fn coupled(&mut self, e: Element<'d>, robot: &mut Robot) -> Result<(), Diagnostic> {
        let find = |key: &str| -> Result<Option<usize>, Diagnostic> {
            let Some(name) = e.attribute(key) else { return Ok(None) };
            let found = self.joints.get(name).copied();
            found.map(Some).ok_or_else(|| e.error(format!("there is no joint `{name}`")))
        };
        let (first, second) = (find("joint1")?, find("joint2")?);
        let c = e.numbers("polycoef")?.unwrap_or_else(|| vec![0.0, 1.0]);
        let get = |k: usize| c.get(k).copied().unwrap_or(if k == 1 { 1.0 } else { 0.0 });
        let (Some(first), Some(second)) = (first, second) else {
            return Err(e.error("a joint that is held at a position has no counterpart").with_help("remove the joint"));
        };
        let n = |j: usize| robot.joints[j].kind.dofs();
        if n(first) != 1 || n(second) != 1 {
            return Err(e.error("coupled joints have one degree of freedom each"));
        }
        // coordinates here are zero at the reference
        e.change("a gear between two joints: a [[coupling]]");
        let name = e.peek("name").map_or_else(|| format!("{}-follows", robot.joints[first].name), str::to_owned);
        let (at, joints, higher) = (e.location(), [second, first], [get(2), get(3), get(4)]);
        robot.gears.push(Gear { name, at, joints, ratio: get(1), offset: get(0), higher });
        Ok(())
    }
}
