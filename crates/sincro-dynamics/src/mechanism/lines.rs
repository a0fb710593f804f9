//! Springs and dampers between two points, and elastic gears: their forces on links, at one instant or at the end of a
//! linearly implicit step, and their power.

use sincro_math::Real;

use crate::actuation::spring_damper::Line;
use crate::constraint::implicit_forces::ImplicitForces;
use crate::model::Model;
use crate::scratch::Scratch;
use crate::spatial::Force;

/// Springs and dampers of a model in the last evaluation.
#[derive(Clone, Debug)]
pub(super) struct Lines<R> {
    lines: Vec<Line<R>>,
    /// κ = h (c + h k) of each, of a linearly implicit step.
    kappa: Vec<R>,
    /// Power of the forces that were added to the external wrenches `[W]`.
    power: R,
    implicit: Option<Box<ImplicitForces<R>>>,
}

impl<R: Real> Lines<R> {
    pub fn new(model: &Model<R>) -> Self {
        let n = model.spring_dampers.len();
        let m = n + model.elastic_gears.len();
        // solves linear systems: lanes leave implicit methods to one world at a time
        let implicit = if R::IS_SCALAR { ImplicitForces::new(model) } else { None };
        Self { lines: Vec::with_capacity(n), kappa: vec![R::zero(); m], power: R::zero(), implicit }
    }

    /// Bytes on the heap.
    pub fn heap_bytes(&self) -> usize {
        size_of_val(&*self.lines)
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
        self.power = R::zero();
        for (element, kappa) in model.spring_dampers.iter().zip(&mut self.kappa) {
            let line = element.line(|link| (scratch.links[link].v, scratch.poses[link]));
            let mut force = element.forces(line.length, line.rate, commands).total();
            if let Some(steps) = implicit {
                let (of_dampers, of_springs) = (R::splat(steps.0), R::splat(steps.1));
                let (k, c) = element.implicit_terms(line.length, line.rate);
                // spring at x + h ẋ: what is known now
                force -= of_springs * k * line.rate;
                *kappa = of_dampers * (c + of_springs * k);
            }
            for (end, at) in element.ends.iter().enumerate() {
                if let Some(link) = at.link {
                    external[link] += element.wrench(end, &line, force, &scratch.poses[link]);
                }
            }
            self.power += force * line.rate;
            self.lines.push(line);
        }
        if let Some(steps) = implicit {
            let (of_dampers, of_springs) = (R::splat(steps.0), R::splat(steps.1));
            for (gear, kappa) in model.elastic_gears.iter().zip(&mut self.kappa[model.spring_dampers.len()..]) {
                let (x, rate) = gear.error(q, v);
                let (k, c) = gear.implicit_terms(x, rate);
                *kappa = of_dampers * (c + of_springs * k);
            }
        }
        if R::IS_SCALAR
            && let (Some(_), Some(forces)) = (implicit, &mut self.implicit)
        {
            forces.place(model, &self.lines, scratch, v);
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
            let lines = &mut self.lines;
            forces.rates_at(model, v, |k, rate| lines[k].rate = rate);
        }
        let (mut work, mut heat) = (-self.power, R::zero());
        for (element, line) in model.spring_dampers.iter().zip(&self.lines) {
            let forces = element.forces(line.length, line.rate, commands);
            work += forces.actuator * line.rate;
            heat -= forces.damping * line.rate;
        }
        (work, heat)
    }
}
