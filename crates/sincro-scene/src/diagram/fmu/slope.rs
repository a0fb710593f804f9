//! Derivatives of an FMU with respect to its inputs and states, for linearisation: its directional derivatives where it
//! has them, else central differences.

use sincro_blocks::block::At;
use sincro_math::Real;

use super::FmuBlock;
use super::work::Buffers;
use crate::fmu::FmuInstance;

/// Distance of central differences, relative to max(|x|, scale): the cube root of the rounding error.
const DISTANCE: f64 = 6e-6;

/// Number that is varied: a component of an input, or a state.
#[derive(Clone, Copy, Debug)]
enum Known {
    Input { port: usize, component: usize },
    State(usize),
}

impl FmuBlock {
    /// Adds to `values`, outputs or derivatives of the states, their change with inputs and states, where numbers carry
    /// derivatives. The instance has been brought to the instant.
    pub(super) fn add_slopes<R: Real>(
        &self,
        at: &At<'_, R>,
        (instance, buffers): (&mut dyn FmuInstance, &mut Buffers),
        chosen: impl Fn(usize) -> bool,
        values: &mut [R],
        of_outputs: bool,
    ) -> Result<(), String> {
        if size_of::<R>() == size_of::<f64>() {
            return Ok(());
        }
        let ports = self.inputs.iter().enumerate().filter(|(k, _)| chosen(*k));
        let inputs = ports.flat_map(|(port, of)| (0..of.width).map(move |component| Known::Input { port, component }));
        let knowns: Vec<Known> = inputs.chain((0..self.n_states).map(Known::State)).collect();
        let scales = &at.memory[self.exchange_memory().scales];
        for (place, known) in knowns.iter().enumerate() {
            let seed = match *known {
                Known::Input { port, .. } => 1.0 / self.inputs[port].factor(),
                Known::State(k) => scales[k].lane(0),
            };
            let change = match self.exact_change(instance, &knowns, (place, seed), &chosen)? {
                Some(change) => change,
                None => self.differences(at, (&mut *instance, buffers), (*known, seed))?,
            };
            let n_outputs = self.n_outputs();
            let factors: Vec<f64> = if of_outputs {
                let of_port = |port: &super::Port| vec![port.factor(); port.width];
                self.outputs.iter().flat_map(of_port).zip(&change[..n_outputs]).map(|(f, x)| f * x).collect()
            } else {
                scales.iter().zip(&change[n_outputs..]).map(|(scale, x)| x / scale.lane(0)).collect()
            };
            let of_known = match *known {
                Known::Input { port, component } => at.component(port, component),
                Known::State(k) => at.states[k],
            };
            for (value, factor) in values.iter_mut().zip(factors) {
                *value += of_known.map(|_| (0.0, factor));
            }
        }
        Ok(())
    }

    fn n_outputs(&self) -> usize {
        self.outputs.iter().map(|port| port.width).sum()
    }

    /// Change of outputs and derivatives by the FMU's own directional derivatives; none if it has none.
    fn exact_change(
        &self,
        instance: &mut dyn FmuInstance,
        knowns: &[Known],
        (place, seed): (usize, f64),
        chosen: impl Fn(usize) -> bool,
    ) -> Result<Option<Vec<f64>>, String> {
        let mut seeds = vec![0.0; knowns.len()];
        seeds[place] = seed;
        let outputs: Vec<usize> = self.outputs.iter().map(|port| port.place).collect();
        let inputs = self.inputs.iter().enumerate().filter(|(k, _)| chosen(*k));
        let inputs: Vec<usize> = inputs.map(|(_, port)| port.place).collect();
        let mut change = vec![0.0; self.n_outputs() + self.n_states];
        let has = instance.directional_derivative(&outputs, &inputs, &seeds, &mut change)?;
        Ok(has.then_some(change))
    }

    /// The same by central differences, per change of the number at the port or of the scaled state.
    fn differences<R: Real>(
        &self,
        at: &At<'_, R>,
        (instance, buffers): (&mut dyn FmuInstance, &mut Buffers),
        (known, seed): (Known, f64),
    ) -> Result<Vec<f64>, String> {
        let scales = &at.memory[self.exchange_memory().scales];
        let x: Vec<f64> = at.states.iter().zip(scales).map(|(x, scale)| x.lane(0) * scale.lane(0)).collect();
        let present = match known {
            Known::Input { port, component } => self.inputs[port].to_fmu(at.component(port, component).lane(0)),
            Known::State(k) => x[k],
        };
        let distance = DISTANCE * present.abs().max(seed.abs());
        let mut ends = [vec![], vec![]];
        for (end, offset) in ends.iter_mut().zip([distance, -distance]) {
            self.vary(at, instance, known, &x, present + offset)?;
            self.evaluate_all(instance, buffers, end)?;
        }
        self.vary(at, instance, known, &x, present)?;
        Ok(ends[0].iter().zip(&ends[1]).map(|(more, less)| (more - less) / (2.0 * distance) * seed).collect())
    }

    /// Sets one input or state to another value.
    fn vary<R: Real>(
        &self,
        at: &At<'_, R>,
        instance: &mut dyn FmuInstance,
        known: Known,
        x: &[f64],
        value: f64,
    ) -> Result<(), String> {
        match known {
            Known::Input { port, component } => {
                let own = &self.inputs[port];
                let mut values: Vec<f64> = (0..own.width).map(|i| own.to_fmu(at.component(port, i).lane(0))).collect();
                values[component] = value;
                instance.set((&[own.place], &values))
            }
            Known::State(k) => {
                let mut x = x.to_vec();
                x[k] = value;
                instance.set_continuous_states(at.t, &x)
            }
        }
    }

    /// Outputs and derivatives, in the units of the FMU.
    fn evaluate_all(
        &self,
        instance: &mut dyn FmuInstance,
        buffers: &mut Buffers,
        all: &mut Vec<f64>,
    ) -> Result<(), String> {
        let places: Vec<usize> = self.outputs.iter().map(|port| port.place).collect();
        buffers.outputs.resize(self.n_outputs(), 0.0);
        instance.get(&places, &mut buffers.outputs)?;
        all.clone_from(&buffers.outputs);
        buffers.derivatives.resize(self.n_states, 0.0);
        instance.derivatives(&mut buffers.derivatives)?;
        all.extend_from_slice(&buffers.derivatives);
        Ok(())
    }
}
