//! Links on fixed joints merged into the bodies that carry them, on request.
//!
//! A link that is merged stays as a frame under its name, so that everything that refers to it finds it: its mass,
//! what shows and what touches pass to the nearest link that moves on its own.

use sincro_dynamics::model::MassProperties;
use sincro_dynamics::spatial::Vec3;

use crate::policy::properties;
use crate::robot::{Geometry, Inertial, JointKind, Placement, Robot, SensorKind, turned_inertia};
use crate::source::{ElementStatus, Ledger};

/// Merges all links on fixed joints that hang on another link; returns the names of those that lost mass or geometry.
pub(crate) fn merge_fixed(robot: &mut Robot, ledger: &Ledger) -> Vec<String> {
    let mut merged = Vec::new();
    for link in leaves_first(robot) {
        let Some(j) = robot.joint_of(link) else { continue };
        let joint = &robot.joints[j];
        let (JointKind::Fixed, Some(parent)) = (joint.kind, joint.parent) else { continue };
        let place = joint.pose.then(&robot.links[link].pose);
        let element = joint.element;
        for sensor in robot.sensors.iter_mut().filter(|s| s.link == link && s.kind == SensorKind::Contact) {
            (sensor.link, sensor.pose) = (parent, place.then(&sensor.pose));
        }
        let child = &mut robot.links[link];
        let inertial = child.inertial.take();
        let (visuals, collisions) = (std::mem::take(&mut child.visuals), std::mem::take(&mut child.collisions));
        if inertial.is_none() && visuals.is_empty() && collisions.is_empty() {
            continue;
        }
        let moved = |piece: Geometry| Geometry { pose: place.then(&piece.pose), ..piece };
        let name = robot.links[link].name.clone();
        let carrier = &mut robot.links[parent];
        carrier.visuals.extend(visuals.into_iter().map(moved));
        carrier.collisions.extend(collisions.into_iter().map(moved));
        if let Some(inertial) = inertial {
            let there = placed(&inertial, &place);
            carrier.inertial = Some(carrier.inertial.map_or(there, |own| sum(&own, &there)));
        }
        let words = format!("link `{name}` is merged into `{}`; a frame stays", carrier.name);
        ledger.judge_place(element, ElementStatus::Changed, &words);
        merged.push(name);
    }
    merged.reverse();
    merged
}

/// Links in an order in which each comes before the one that carries it.
fn leaves_first(robot: &Robot) -> Vec<usize> {
    let carriers = robot.carriers();
    let depth = |link: usize| {
        let above = |at: &usize| carriers[*at].and_then(|j| robot.joints[j].parent);
        // a chain is as long as there are links at most
        std::iter::successors(Some(link), above).take(robot.links.len()).count()
    };
    let mut order: Vec<usize> = (0..robot.links.len()).collect();
    order.sort_by_cached_key(|link| std::cmp::Reverse(depth(*link)));
    order
}

/// Mass properties in the axes of a frame in which their own stands at `place`.
fn placed(inertial: &Inertial, place: &Placement) -> Inertial {
    if place.is_identity() {
        return *inertial;
    }
    let pose = place.pose();
    let center_of_mass = pose.point(Vec3(inertial.center_of_mass)).0;
    Inertial { mass: inertial.mass, center_of_mass, inertia: turned_inertia(&pose.rot, inertial.inertia) }
}

/// Mass properties of two bodies that are one, in the same axes.
fn sum(a: &Inertial, b: &Inertial) -> Inertial {
    if a.mass + b.mass == 0.0 {
        return *a;
    }
    let MassProperties { mass, center_of_mass, inertia } = MassProperties::sum(&[a, b].map(properties));
    Inertial { mass, center_of_mass, inertia }
}
