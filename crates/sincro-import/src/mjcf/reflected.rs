//! Armature and damping of actuators: those of the joint on which they act, by the square of the gear.

use sincro_scene::diagnostic::Diagnostic;

use super::Reader;
use crate::findings::Findings;
use crate::robot::{Robot, TendonPath};
use crate::source::Element;

/// Property that an actuator gives what it acts on.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Reflected {
    Armature,
    Damping,
}

impl<'d> Reader<'d> {
    /// Gives joints the armature or damping of all actuators; `tendons` are the elements of tendons.
    pub(super) fn reflect(
        &self,
        property: Reflected,
        actuators: Element<'d>,
        tendons: &[Element<'d>],
        robot: &mut Robot,
        findings: &mut Findings,
    ) {
        for element in self.files.elements(actuators) {
            let done = self.reflect_one(property, element, tendons, robot);
            findings.take(done);
        }
    }

    fn reflect_one(
        &self,
        property: Reflected,
        e: Element<'d>,
        tendons: &[Element<'d>],
        robot: &mut Robot,
    ) -> Result<(), Diagnostic> {
        // an error of the record is one of the actuator, which comes later
        let Ok(record) = self.defaults.actuator(e) else { return Ok(()) };
        let (key, numbers) = match property {
            Reflected::Armature => ("armature", [record.armature, 0.0, 0.0]),
            Reflected::Damping => ("damping", record.damping),
        };
        match numbers {
            [0.0, 0.0, 0.0] => return Ok(()),
            [x, 0.0, 0.0] if x > 0.0 => {}
            [_, 0.0, 0.0] => return Err(e.error(format!("`{key}` of an actuator is negative"))),
            _ => return Err(e.error(format!("`{key}` of an actuator is a polynomial, which has no counterpart"))),
        }
        let Some((joint, coefficient)) = self.only_joint(e, tendons, robot)? else {
            return Err(e
                .error(format!("`{key}` of an actuator acts on what is not one joint, and has no counterpart"))
                .with_help("of an actuator on a joint with one degree of freedom, or a tendon of one, it has"));
        };
        let own = numbers[0] * (record.gear[0] * coefficient).powi(2);
        let joint = &mut robot.joints[joint];
        let list = if property == Reflected::Armature { &mut joint.armature } else { &mut joint.damping };
        *list = vec![list.first().copied().unwrap_or(0.0) + own];
        e.change(&format!("its `{key}` is that of joint `{}`, by {own}", joint.name));
        Ok(())
    }

    /// The joint with one degree of freedom on which an actuator acts, and the length for a unit of its coordinate.
    fn only_joint(
        &self,
        e: Element<'d>,
        tendons: &[Element<'d>],
        robot: &Robot,
    ) -> Result<Option<(usize, f64)>, Diagnostic> {
        if let Some(name) = e.peek("joint").or(e.peek("jointinparent")) {
            let joint = self.joints.get(name).filter(|joint| robot.joints[**joint].kind.dofs() == 1);
            return Ok(joint.map(|joint| (*joint, 1.0)));
        }
        let Some(name) = e.peek("tendon") else { return Ok(None) };
        let Some(tendon) = tendons.iter().find(|tendon| tendon.peek("name") == Some(name)) else { return Ok(None) };
        Ok(match self.known_tendon(*tendon, robot)?.path {
            Ok(TendonPath::Joints(shares)) => <[_; 1]>::try_from(shares).ok().map(|[share]| share),
            _ => None,
        })
    }
}
