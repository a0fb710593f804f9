//! Co-simulation and scheduled execution: the FMU steps from sample to sample.

use sincro_blocks::block::At;
use sincro_math::Real;

use super::{FmuBlock, Work};
use crate::fmu::{FmuInstance, FmuInterface};

impl FmuBlock {
    /// Outputs at a sample.
    pub(super) fn stepped_outputs<R: Real>(&self, at: &At<'_, R>, work: &mut Work, y: &mut [R]) -> Result<(), String> {
        let setup = (self.interface, &*self.parameters);
        let (instance, buffers, is_new) = work.instance(self.model()?, setup, at.memory[0].lane(0), at.t)?;
        let chosen = |k: usize| self.feeds_through[k] && !self.is_clock(k);
        if is_new {
            let places = self.read_inputs(at, &mut buffers.inputs, chosen);
            if instance.start(at.t, (&places, &buffers.inputs))?.ends {
                return Err("it ended the simulation at its start".into());
            }
        }
        self.set_inputs(at, (instance, &mut buffers.inputs), chosen)?;
        self.get_outputs(instance, &mut buffers.outputs)?;
        for (y, x) in y.iter_mut().zip(&buffers.outputs) {
            *y = R::splat(*x);
        }
        Ok(())
    }

    /// The step from a sample to the next one, after `steps` of them.
    pub(super) fn step<R: Real>(&self, at: &At<'_, R>, work: &mut Work, steps: f64) -> Result<(), String> {
        let setup = (self.interface, &*self.parameters);
        let (instance, buffers, _) = work.instance(self.model()?, setup, steps, at.t)?;
        self.set_inputs(at, (&mut *instance, &mut buffers.inputs), |k| !self.is_clock(k))?;
        if self.interface == FmuInterface::ScheduledExecution {
            self.trigger_clocks(at, instance)?;
        }
        instance.step(at.t, at.node.period())
    }

    /// Clocks tick whose input is not 0 at the sample.
    fn trigger_clocks<R: Real>(&self, at: &At<'_, R>, instance: &mut dyn FmuInstance) -> Result<(), String> {
        let ticks = |k: &usize| self.is_clock(*k) && at.scalar(*k).lane(0) != 0.0;
        let places: Vec<usize> = (0..self.inputs.len()).filter(ticks).map(|k| self.inputs[k].place).collect();
        if places.is_empty() { Ok(()) } else { instance.set((&places, &vec![at.t; places.len()])) }
    }

    /// Returns true if an input is a clock that the diagram triggers.
    fn is_clock(&self, input: usize) -> bool {
        self.model.as_ref().is_some_and(|model| model.variables()[self.inputs[input].place].is_clock)
    }
}
