//! Springs and dampers along paths, elastic gears and bushings: their forces on links, at one instant or at the end of
//! a linearly implicit step, and their power. Torques of those on joints are in [`torques`](super::torques).

use sincro_math::{Branches, Real, dot};

use super::Mechanism;

use crate::actuation::bushing::BushingMotion;
use crate::actuation::spring_damper::{Line, Path, PathLength};
use crate::constraint::implicit_forces::ImplicitForces;
use crate::model::Model;
use crate::recursions::kinematics;
use crate::scratch::Scratch;
use crate::spatial::Force;

/// Springs and dampers of a model in the last evaluation.
#[derive(Clone, Debug)]
pub(super) struct Lines<R> {
    /// Straight lines of all paths, one path after the other.
    lines: Vec<Line<R>>,
    /// Length of each path.
    lengths: Vec<PathLength<R>>,
    /// Deflection of each bushing.
    bushings: Vec<BushingMotion<R>>,
    /// κ = h (c + h k) of each row of a linearly implicit step.
    kappa: Vec<R>,
    /// Power of the forces that were added to the external wrenches `[W]`.
    power: R,
    implicit: Option<Box<ImplicitForces<R>>>,
}

impl<R: Real> Mechanism<R> {
    /// Branches that force laws in pieces take in the state `y`: of ropes and nonlinear springs along paths and of
    /// joints, of gears with backlash.
    pub(super) fn branches_of_laws(&mut self, y: &[R]) -> Branches {
        self.set_coordinates(y);
        let (v, mut branches) = (&y[self.layout.velocities()], Branches::default());
        kinematics::motions(&self.model, &self.q, v, v, &mut self.scratch);
        let (model, q) = (&self.model, &self.q);
        for element in &model.spring_dampers {
            let at = element.length(q, v, |link| (self.scratch.links[link].v, self.scratch.poses[link]));
            element.note_branches(at.length, at.rate, &mut branches);
        }
        for gear in &model.elastic_gears {
            let (x, rate) = gear.error(q, v);
            gear.note_branch(x, rate, &mut branches);
        }
        for spring in &model.nonlinear_springs {
            let dof = &model.dofs[spring.dof];
            let x = (q[dof.q_idx as usize] - dof.rest).lane(0);
            spring.law.note_branches(x, v[spring.dof].lane(0), &mut branches);
        }
        branches
    }
}

impl<R: Real> Lines<R> {
    pub fn new(model: &Model<R>) -> Self {
        let n = model.spring_dampers.len();
        let m = ImplicitForces::n_rows(model);
        // solves linear systems: lanes leave implicit methods to one world at a time
        let implicit = if R::IS_SCALAR { ImplicitForces::new(model) } else { None };
        let n_lines = model.spring_dampers.iter().map(|element| element.segments().len()).sum();
        Self {
            lines: Vec::with_capacity(n_lines),
            lengths: Vec::with_capacity(n),
            bushings: Vec::with_capacity(model.bushings.len()),
            kappa: vec![R::zero(); m],
            power: R::zero(),
            implicit,
        }
    }

    /// Bytes on the heap.
    pub fn heap_bytes(&self) -> usize {
        size_of_val(&*self.lines)
            + size_of_val(&*self.lengths)
            + size_of_val(&*self.bushings)
            + size_of_val(&*self.kappa)
            + self.implicit.as_ref().map_or(0, |implicit| implicit.heap_bytes())
    }

    /// Adds the wrenches of all elements to those on links, after kinematics at the velocities `v`; of a linearly
    /// implicit step, with the steps of dampers and springs `[s]`, those known before its accelerations.
    #[inline(always)]
    pub fn add_wrenches(
        &mut self,
        model: &Model<R>,
        scratch: &Scratch<R>,
        (q, v, commands): (&[R], &[R], &[R]),
        implicit: Option<(f64, f64)>,
        external: &mut [Force<R>],
    ) {
        self.lines.clear();
        self.lengths.clear();
        self.power = R::zero();
        for (element, kappa) in model.spring_dampers.iter().zip(&mut self.kappa) {
            let first = self.lines.len();
            let at = match &element.path {
                Path::Joints(shares) => PathLength::of_joints(shares, q, v),
                Path::Lines(segments) => {
                    let line_of = |link: usize| (scratch.links[link].v, scratch.poses[link]);
                    self.lines.extend(segments.iter().map(|segment| segment.line(line_of)));
                    PathLength::of_lines(&self.lines[first..])
                }
            };
            self.lengths.push(at);
            let steps = implicit.map(|steps| (R::splat(steps.0), R::splat(steps.1)));
            let (k, c) = steps.map_or((R::zero(), R::zero()), |_| element.implicit_terms(at.length, at.rate));
            if let Some((of_dampers, of_springs)) = steps {
                *kappa = of_dampers * (c + of_springs * k);
            }
            if element.segments().is_empty() {
                continue;
            }
            let mut force = element.forces(at.length, at.rate, commands).total();
            if let Some((_, of_springs)) = steps {
                // spring at x + h ẋ: what is known now
                force -= of_springs * k * at.rate;
            }
            for (segment, line) in element.segments().iter().zip(&self.lines[first..]) {
                for (end, at) in segment.ends.iter().enumerate() {
                    if let Some(link) = at.link {
                        external[link] += segment.wrench(end, line, force, &scratch.poses[link]);
                    }
                }
            }
            self.power += force * at.rate;
        }
        if let Some(steps) = implicit {
            let (of_dampers, of_springs) = (R::splat(steps.0), R::splat(steps.1));
            for (gear, kappa) in model.elastic_gears.iter().zip(&mut self.kappa[model.spring_dampers.len()..]) {
                let (x, rate) = gear.error(q, v);
                let (k, c) = gear.implicit_terms(x, rate);
                *kappa = of_dampers * (c + of_springs * k);
            }
        }
        self.add_bushing_wrenches(model, scratch, implicit, external);
        if R::IS_SCALAR
            && let (Some(_), Some(forces)) = (implicit, &mut self.implicit)
        {
            forces.place(model, (&self.lines, &self.bushings), scratch, v);
        }
    }

    /// Adds the wrenches of bushings, as [`Lines::add_wrenches`].
    #[inline(always)]
    fn add_bushing_wrenches(
        &mut self,
        model: &Model<R>,
        scratch: &Scratch<R>,
        implicit: Option<(f64, f64)>,
        external: &mut [Force<R>],
    ) {
        self.bushings.clear();
        let first = model.spring_dampers.len() + model.elastic_gears.len();
        for (element, kappa) in model.bushings.iter().zip(self.kappa[first..].chunks_exact_mut(6)) {
            let mut at = element.motion(|link| (scratch.links[link].v, scratch.poses[link]));
            let mut force = element.force(&at);
            if let Some(steps) = implicit {
                let ahead = element.implicit(&mut at, (R::splat(steps.0), R::splat(steps.1)), kappa);
                force.iter_mut().zip(ahead).for_each(|(force, ahead)| *force += ahead);
            }
            for (end, frame) in element.ends.iter().enumerate() {
                if let Some(link) = frame.link {
                    external[link] += element.wrench(end, &at, &force, &scratch.poses[link]);
                }
            }
            self.power += dot(&force, &at.rates);
            self.bushings.push(at);
        }
    }

    /// Forces at the end of a linearly implicit step, factored, after forward dynamics gave `v_dot` without them.
    #[inline(always)]
    pub fn factor(&mut self, model: &Model<R>, scratch: &Scratch<R>, v_dot: &[R]) -> Option<&mut ImplicitForces<R>> {
        if !R::IS_SCALAR {
            return None;
        }
        let forces = self.implicit.as_deref_mut()?;
        forces.factor(model, scratch, self.kappa.iter().copied(), v_dot);
        Some(forces)
    }

    /// Work done by the elements beside that of the wrenches they added, and power dissipated `[W]`: over other joint
    /// rates `v` at the same poses, if they are given, of a linearly implicit step. The elastic part of a force stores
    /// its power.
    pub fn power(&mut self, model: &Model<R>, commands: &[R], v: Option<&[R]>) -> (R, R) {
        if R::IS_SCALAR
            && let (Some(v), Some(forces)) = (v, &mut self.implicit)
        {
            forces.rates_at(model, v, &mut self.lengths, &mut self.bushings);
        }
        let (mut work, mut heat) = (-self.power, R::zero());
        for (element, at) in model.spring_dampers.iter().zip(&self.lengths) {
            let forces = element.forces(at.length, at.rate, commands);
            work += forces.actuator * at.rate;
            heat -= forces.damping * at.rate;
        }
        for (element, at) in model.bushings.iter().zip(&self.bushings) {
            heat -= dot(&element.dissipative(at.rates), &at.rates);
        }
        (work, heat)
    }
}
