//! Foreign FMUs as blocks of diagrams know them: by their numbers.

use std::sync::Arc;

use sincro_scene::fmu::{
    FmuDimension, FmuEvents, FmuExchange, FmuInstance, FmuInterface, FmuModel, FmuValues, FmuVariable,
};

use super::ForeignFmu;
use super::description::{ClockRule, ForeignVariable, NumberKind};
use super::instance::Instance;

/// FMU with the variables that are numbers, arrays of numbers or triggered clocks.
#[derive(Debug)]
pub(super) struct Model {
    pub fmu: Arc<ForeignFmu>,
    interfaces: Vec<FmuInterface>,
    variables: Vec<FmuVariable>,
    /// For each variable: how the library knows it.
    access: Arc<[Access]>,
    exchange: FmuExchange,
}

/// Variable as the library knows it.
#[derive(Clone, Debug)]
pub(super) struct Access {
    /// Type; none for clocks.
    kind: Option<NumberKind>,
    reference: u32,
    dimensions: Vec<FmuDimension>,
    start: f64,
}

impl Model {
    pub fn new(fmu: Arc<ForeignFmu>) -> Self {
        let description = &fmu.description;
        let of_triggered = description.clocks.iter().filter(|clock| clock.rule == ClockRule::Triggered);
        let triggered: Vec<u32> = of_triggered.map(|clock| clock.reference).collect();
        let is_clock = |v: &ForeignVariable| v.kind.is_none() && triggered.contains(&v.reference);
        let chosen: Vec<usize> = (0..description.variables.len())
            .filter(|k| description.variables[*k].kind.is_some() || is_clock(&description.variables[*k]))
            .collect();
        // places among all variables to places among those chosen
        let place = |k: usize| chosen.binary_search(&k).ok();
        let dimension = |of: &FmuDimension| match *of {
            FmuDimension::Parameter(k) => FmuDimension::Parameter(place(k).unwrap_or(usize::MAX)),
            fixed => fixed,
        };
        let variables: Vec<FmuVariable> = chosen
            .iter()
            .map(|k| {
                let v = &description.variables[*k];
                FmuVariable {
                    name: v.name.clone(),
                    causality: v.causality.clone(),
                    unit: v.unit.clone(),
                    dimensions: v.dimensions.iter().map(dimension).collect(),
                    start: v.start,
                    is_real: v.kind.is_some_and(NumberKind::is_real),
                    is_discrete: v.is_discrete,
                    feeds_through: v.feeds_through,
                    is_clock: v.kind.is_none(),
                }
            })
            .collect();
        let access = chosen.iter().zip(&variables).map(|(k, variable)| Access {
            kind: description.variables[*k].kind,
            reference: description.variables[*k].reference,
            dimensions: variable.dimensions.clone(),
            start: variable.start.unwrap_or(0.0),
        });
        let exchange = FmuExchange {
            states: description.states.iter().filter_map(|k| place(*k)).collect(),
            crossings: description.indicators.iter().filter_map(|k| place(*k)).collect(),
            n_crossings: description.n_indicators,
        };
        let interfaces = fmu.description.interfaces.iter().map(|interface| interface.kind).collect();
        Self { interfaces, access: access.collect(), variables, exchange, fmu: fmu.clone() }
    }
}

impl FmuModel for Model {
    fn name(&self) -> &str {
        &self.fmu.description.name
    }

    fn interfaces(&self) -> &[FmuInterface] {
        &self.interfaces
    }

    fn variables(&self) -> &[FmuVariable] {
        &self.variables
    }

    fn exchange(&self) -> &FmuExchange {
        &self.exchange
    }

    fn can_save(&self, interface: FmuInterface) -> bool {
        self.fmu.description.interface(interface).is_some_and(|of| of.can_save && of.can_serialize)
    }

    fn instantiate(
        &self,
        interface: FmuInterface,
        parameters: &[(usize, Vec<f64>)],
    ) -> Result<Box<dyn FmuInstance>, String> {
        let new = BlockInstance::new(&self.fmu, self.access.clone(), interface, parameters)?;
        let is_structural = |k: usize| self.variables[k].causality == "structuralParameter";
        let (structure, others): (Vec<_>, Vec<_>) = parameters.iter().partition(|(k, _)| is_structural(*k));
        if !structure.is_empty() {
            new.instance.configure(|_| structure.iter().try_for_each(|(k, x)| new.set_one(*k, x)))?;
        }
        others.iter().try_for_each(|(k, x)| new.set_one(*k, x))?;
        Ok(Box::new(new))
    }
}

/// Instance with the sizes of its variables.
#[derive(Debug)]
struct BlockInstance {
    instance: Instance,
    access: Arc<[Access]>,
    widths: Vec<usize>,
}

impl BlockInstance {
    fn new(
        fmu: &Arc<ForeignFmu>,
        access: Arc<[Access]>,
        interface: FmuInterface,
        parameters: &[(usize, Vec<f64>)],
    ) -> Result<Self, String> {
        let value = |k: usize| {
            let set = parameters.iter().find(|(of, _)| *of == k).and_then(|(_, values)| values.first());
            set.copied().or_else(|| Some(access.get(k)?.start)).unwrap_or(0.0)
        };
        let size = |dimension: &FmuDimension| match *dimension {
            FmuDimension::Fixed(n) => n,
            FmuDimension::Parameter(k) => value(k) as usize,
        };
        let widths = access.iter().map(|of| of.dimensions.iter().map(size).fold(1, usize::saturating_mul)).collect();
        let instance = Instance::new(fmu, interface, &fmu.description.name)?;
        Ok(Self { instance, widths, access })
    }

    fn set_one(&self, place: usize, values: &[f64]) -> Result<(), String> {
        let kind = self.access[place].kind.ok_or("a clock has no value")?;
        self.instance.set(kind, &[self.access[place].reference], values)
    }

    /// Calls `visit` with type, value references and number of numbers of variables of one type in a row.
    fn each_run(
        &self,
        places: &[usize],
        mut visit: impl FnMut(&Instance, NumberKind, &[u32], usize) -> Result<(), String>,
    ) -> Result<(), String> {
        for run in places.chunk_by(|a, b| self.access[*a].kind == self.access[*b].kind) {
            let kind = self.access[run[0]].kind.ok_or("a clock has no value")?;
            let references: Vec<u32> = run.iter().map(|k| self.access[*k].reference).collect();
            visit(&self.instance, kind, &references, run.iter().map(|k| self.widths[*k]).sum())?;
        }
        Ok(())
    }

    fn set_numbers(&self, (places, values): FmuValues<'_>) -> Result<(), String> {
        let mut rest = values;
        self.each_run(places, |instance, kind, references, n| {
            let (own, others) = rest.split_at_checked(n).ok_or("there are not as many values as numbers")?;
            rest = others;
            instance.set(kind, references, own)
        })
    }

    fn references(&self, places: &[usize]) -> Vec<u32> {
        places.iter().map(|k| self.access[*k].reference).collect()
    }
}

impl FmuInstance for BlockInstance {
    fn start(&mut self, t: f64, inputs: FmuValues<'_>) -> Result<FmuEvents, String> {
        let (access, widths) = (self.access.clone(), self.widths.clone());
        self.instance.start(t, |instance| set_each(instance, &access, &widths, inputs))
    }

    fn set(&mut self, (places, values): FmuValues<'_>) -> Result<(), String> {
        if places.first().is_some_and(|k| self.access[*k].kind.is_none()) {
            let clocks = self.references(places);
            return clocks.iter().zip(values).try_for_each(|(clock, t)| self.instance.trigger(*clock, *t));
        }
        self.set_numbers((places, values))
    }

    fn get(&mut self, places: &[usize], values: &mut [f64]) -> Result<(), String> {
        let mut rest = values;
        self.each_run(places, |instance, kind, references, n| {
            let (own, others) = std::mem::take(&mut rest).split_at_mut_checked(n).ok_or("there are too few places")?;
            rest = others;
            instance.get(kind, references, own)
        })
    }

    fn step(&mut self, t: f64, h: f64) -> Result<(), String> {
        if self.instance.step(t, h)? { Ok(()) } else { Err("it ended the simulation".into()) }
    }

    fn save(&mut self) -> Result<Vec<u8>, String> {
        self.instance.to_bytes()
    }

    fn restore(&mut self, state: &[u8]) -> Result<(), String> {
        self.instance.restore_bytes(state)
    }

    fn continuous_states(&mut self, states: &mut [f64], nominals: &mut [f64]) -> Result<(), String> {
        self.instance.continuous_states(states, nominals)
    }

    fn set_continuous_states(&mut self, t: f64, states: &[f64]) -> Result<(), String> {
        self.instance.set_continuous_states(t, states)
    }

    fn derivatives(&mut self, derivatives: &mut [f64]) -> Result<(), String> {
        self.instance.derivatives(derivatives)
    }

    fn event_indicators(&mut self, indicators: &mut [f64]) -> Result<(), String> {
        self.instance.event_indicators(indicators)
    }

    fn complete_step(&mut self) -> Result<bool, String> {
        self.instance.complete_step()
    }

    fn handle_events(&mut self, inputs: FmuValues<'_>) -> Result<FmuEvents, String> {
        let (access, widths) = (self.access.clone(), self.widths.clone());
        self.instance.handle_events(|instance| set_each(instance, &access, &widths, inputs))
    }

    fn directional_derivative(
        &mut self,
        unknowns: &[usize],
        knowns: &[usize],
        seed: &[f64],
        change: &mut [f64],
    ) -> Result<bool, String> {
        let is_real = |k: &usize| self.access[*k].kind.is_some_and(NumberKind::is_real);
        if !unknowns.iter().chain(knowns).all(is_real) {
            return Ok(false);
        }
        let references = (&*self.references(unknowns), &*self.references(knowns));
        self.instance.directional_derivative(references, seed, change)
    }
}

/// Sets variables one by one.
fn set_each(instance: &Instance, access: &[Access], widths: &[usize], inputs: FmuValues<'_>) -> Result<(), String> {
    let mut rest = inputs.1;
    for k in inputs.0 {
        let (own, others) = rest.split_at_checked(widths[*k]).ok_or("there are too few values")?;
        rest = others;
        let kind = access[*k].kind.ok_or("a clock has no value")?;
        instance.set(kind, &[access[*k].reference], own)?;
    }
    Ok(())
}
