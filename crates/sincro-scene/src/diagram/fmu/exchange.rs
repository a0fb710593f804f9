//! Model exchange: the continuous states of the FMU are integrated with the run, its events handled with the event
//! iteration of the standard.
//!
//! The states of the block are those of the FMU over a power of two near their nominal values, so that error control,
//! which is relative to max(|x|, 1), is relative to them; scaling so is exact. The memory holds
//!
//! | numbers | meaning |
//! |---|---|
//! | 1 | count of events, that of the start included; NaN after a failure |
//! | 1 | next time event `[s]` |
//! | number of states | scales of the states |
//! | number of event indicators | +1 where the indicator was above zero after the last event, else −1 |
//! | numbers of the discrete inputs | their values at the last event |
//!
//! Source: keys `fmi-2` and `fmi-3`, chapter 3 of each.

use core::ops::Range;

use sincro_blocks::block::{At, SAME_INSTANT};
use sincro_math::Real;

use super::{FmuBlock, Work};
use crate::fmu::{FmuEvents, FmuInstance};

/// Places of the numbers in the memory of the block.
#[derive(Clone, Debug)]
pub(super) struct ExchangeMemory {
    pub scales: Range<usize>,
    domains: Range<usize>,
    discrete: Range<usize>,
}

impl ExchangeMemory {
    pub fn n_numbers(&self) -> usize {
        self.discrete.end
    }
}

/// Index of the next time event in the memory.
const NEXT: usize = 1;

impl FmuBlock {
    pub(super) fn exchange_memory(&self) -> ExchangeMemory {
        let n_discrete: usize =
            self.inputs.iter().zip(&self.is_discrete).filter(|(_, is)| **is).map(|(port, _)| port.width).sum();
        let scales = 2..2 + self.n_states;
        let domains = scales.end..scales.end + self.n_crossings;
        let discrete = domains.end..domains.end + n_discrete;
        ExchangeMemory { scales, domains, discrete }
    }

    pub(super) fn start_exchange<R: Real>(&self, memory: &mut [R]) {
        memory.fill(R::zero());
        memory[NEXT] = R::splat(f64::INFINITY);
        memory[self.exchange_memory().scales].fill(R::one());
    }

    pub(super) fn scheduled_exchange_event<R: Real>(&self, memory: &[R]) -> f64 {
        let is_at_work = memory[0].lane(0) > 0.0;
        if is_at_work { memory[NEXT].lane(0) } else { f64::INFINITY }
    }

    pub(super) fn exchange_outputs<R: Real>(&self, at: &At<'_, R>, work: &mut Work, y: &mut [R]) -> Result<(), String> {
        let (instance, buffers, _) = work.instance(self.model()?, self.setup(), at.memory[0].lane(0), at.t)?;
        let states = (at.states, at.memory);
        self.bring(instance, at.t, states, &mut buffers.states)?;
        let chosen = |k: usize| self.feeds_through[k] && !self.is_discrete[k];
        self.set_inputs(at, (&mut *instance, &mut buffers.inputs), chosen)?;
        self.get_outputs(instance, &mut buffers.outputs)?;
        for (y, x) in y.iter_mut().zip(&buffers.outputs) {
            *y = R::splat(*x);
        }
        self.add_slopes(at, (instance, buffers), chosen, y, true)
    }

    pub(super) fn exchange_derivatives<R: Real>(
        &self,
        at: &At<'_, R>,
        work: &mut Work,
        derivatives: &mut [R],
    ) -> Result<(), String> {
        let (instance, buffers, _) = work.instance(self.model()?, self.setup(), at.memory[0].lane(0), at.t)?;
        self.bring(instance, at.t, (at.states, at.memory), &mut buffers.states)?;
        let chosen = |k: usize| !self.is_discrete[k];
        self.set_inputs(at, (&mut *instance, &mut buffers.inputs), chosen)?;
        buffers.derivatives.resize(derivatives.len(), 0.0);
        instance.derivatives(&mut buffers.derivatives)?;
        let scales = &at.memory[self.exchange_memory().scales];
        for ((slope, x), scale) in derivatives.iter_mut().zip(&buffers.derivatives).zip(scales) {
            *slope = R::splat(x / scale.lane(0));
        }
        self.add_slopes(at, (instance, buffers), chosen, derivatives, false)
    }

    /// Event indicators as zero-crossing functions: above zero where the indicator has left the domain, above zero or
    /// not, in which it was after the last event.
    pub(super) fn exchange_crossings<R: Real>(
        &self,
        at: &At<'_, R>,
        work: &mut Work,
        values: &mut [R],
    ) -> Result<(), String> {
        if values.is_empty() {
            return Ok(());
        }
        let (instance, buffers, _) = work.instance(self.model()?, self.setup(), at.memory[0].lane(0), at.t)?;
        self.bring(instance, at.t, (at.states, at.memory), &mut buffers.states)?;
        self.set_inputs(at, (&mut *instance, &mut buffers.inputs), |k| !self.is_discrete[k])?;
        buffers.indicators.resize(values.len(), 0.0);
        instance.event_indicators(&mut buffers.indicators)?;
        let domains = &at.memory[self.exchange_memory().domains];
        for ((value, x), domain) in values.iter_mut().zip(&buffers.indicators).zip(domains) {
            let was_above = domain.lane(0) > 0.0;
            let beyond = if was_above { -x } else { *x };
            // zero counts as not above
            *value = R::splat(if was_above && beyond == 0.0 { f64::MIN_POSITIVE } else { beyond });
        }
        Ok(())
    }

    /// Handles what has happened at the present instant; returns true if there was an event.
    pub(super) fn handle_exchange_events<R: Real>(
        &self,
        at: &At<'_, R>,
        work: &mut Work,
        (memory, states): (&mut [R], &mut [R]),
        is_step_end: bool,
    ) -> Result<bool, String> {
        let count = memory[0].lane(0);
        let (instance, buffers, is_new) = work.instance(self.model()?, self.setup(), count, at.t)?;
        let known = |k: usize| is_step_end || self.feeds_through[k];
        if is_new {
            let places = self.read_inputs(at, &mut buffers.inputs, known);
            let events = instance.start(at.t, (&places, &buffers.inputs))?;
            self.take_events(at, (instance, &mut buffers.states), (memory, states), events)?;
            self.remember_discrete(at, memory);
            work.count = count + 1.0;
            return Ok(true);
        }
        let is_due = memory[NEXT].lane(0) <= at.t + SAME_INSTANT;
        let t = if is_due { memory[NEXT].lane(0).max(at.t) } else { at.t };
        self.bring(instance, t, (states, memory), &mut buffers.states)?;
        let inputs = |k: usize| known(k) && !self.is_discrete[k];
        self.set_inputs(at, (&mut *instance, &mut buffers.inputs), inputs)?;
        let asked = is_step_end && instance.complete_step()?;
        let jumped = self.has_discrete_input_changed(at, memory);
        if !(asked || is_due || jumped || self.has_crossed(instance, &mut buffers.indicators, memory)?) {
            return Ok(false);
        }
        let places = self.read_inputs(at, &mut buffers.inputs, |k| self.is_discrete[k]);
        let events = instance.handle_events((&places, &buffers.inputs))?;
        if events.next <= t {
            return Err(format!("its next time event at {} s is not after the present one at {t} s", events.next));
        }
        self.take_events(at, (instance, &mut buffers.states), (memory, states), events)?;
        self.remember_discrete(at, memory);
        work.count = count + 1.0;
        Ok(true)
    }

    /// Interface and parameters, of which instances are made.
    fn setup(&self) -> (crate::fmu::FmuInterface, &[(usize, Vec<f64>)]) {
        (self.interface, &self.parameters)
    }

    /// Brings the instance to time and states.
    fn bring<R: Real>(
        &self,
        instance: &mut dyn FmuInstance,
        t: f64,
        (states, memory): (&[R], &[R]),
        buffer: &mut Vec<f64>,
    ) -> Result<(), String> {
        let scales = &memory[self.exchange_memory().scales];
        buffer.clear();
        buffer.extend(states.iter().zip(scales).map(|(x, scale)| x.lane(0) * scale.lane(0)));
        instance.set_continuous_states(t, buffer)
    }

    /// Takes over what events have changed: states, their nominal values, the next time event, domains of indicators.
    fn take_events<R: Real>(
        &self,
        at: &At<'_, R>,
        (instance, buffer): (&mut dyn FmuInstance, &mut Vec<f64>),
        (memory, states): (&mut [R], &mut [R]),
        events: FmuEvents,
    ) -> Result<(), String> {
        if events.ends {
            return Err(format!("it ended the simulation at t = {} s", at.t));
        }
        let places = self.exchange_memory();
        let n = self.n_states;
        buffer.resize(2 * n, 0.0);
        let (values, nominals) = buffer.split_at_mut(n);
        instance.continuous_states(values, nominals)?;
        for k in 0..n {
            let scale = power_of_two_near(nominals[k]);
            memory[places.scales.start + k] = R::splat(scale);
            states[k] = R::splat(values[k] / scale);
        }
        buffer.clear();
        buffer.resize(self.n_crossings, 0.0);
        instance.event_indicators(buffer)?;
        for (domain, x) in memory[places.domains].iter_mut().zip(&*buffer) {
            *domain = R::splat(if *x > 0.0 { 1.0 } else { -1.0 });
        }
        memory[0] += R::one();
        memory[NEXT] = R::splat(events.next);
        Ok(())
    }

    /// Returns true if an indicator has left its domain.
    fn has_crossed<R: Real>(
        &self,
        instance: &mut dyn FmuInstance,
        indicators: &mut Vec<f64>,
        memory: &[R],
    ) -> Result<bool, String> {
        indicators.resize(self.n_crossings, 0.0);
        if indicators.is_empty() {
            return Ok(false);
        }
        instance.event_indicators(indicators)?;
        let domains = &memory[self.exchange_memory().domains];
        Ok(indicators.iter().zip(domains).any(|(x, domain)| (*x > 0.0) != (domain.lane(0) > 0.0)))
    }

    fn discrete_inputs<'a, R: Real>(&'a self, at: &'a At<'_, R>) -> impl Iterator<Item = R> + 'a {
        let ports = self.inputs.iter().enumerate().filter(|(k, _)| self.is_discrete[*k]);
        ports.flat_map(move |(k, port)| (0..port.width).map(move |i| at.component(k, i)))
    }

    fn has_discrete_input_changed<R: Real>(&self, at: &At<'_, R>, memory: &[R]) -> bool {
        let held = &memory[self.exchange_memory().discrete];
        self.discrete_inputs(at).zip(held).any(|(x, held)| x.lane(0) != held.lane(0))
    }

    fn remember_discrete<R: Real>(&self, at: &At<'_, R>, memory: &mut [R]) {
        for (held, x) in memory[self.exchange_memory().discrete].iter_mut().zip(self.discrete_inputs(at)) {
            *held = x;
        }
    }
}

/// Power of two nearest to a nominal value, 1 for what is none.
fn power_of_two_near(nominal: f64) -> f64 {
    let size = nominal.abs();
    if !size.is_normal() {
        return 1.0;
    }
    // its exponent alone, one higher from √2 on
    let exponent = size.to_bits() >> 52;
    let floor = f64::from_bits(exponent << 52);
    if size > core::f64::consts::SQRT_2 * floor { 2.0 * floor } else { floor }
}

#[cfg(test)]
mod tests {
    use super::power_of_two_near;

    #[test]
    fn scales_are_powers_of_two() {
        let scales = [1.0, 1e5, -1e-6, 0.0, f64::NAN, 3.0, 1.4].map(power_of_two_near);
        assert_eq!(scales, [1.0, 131_072.0, 2.0_f64.powi(-20), 1.0, 1.0, 4.0, 1.0]);
    }
}
