//! A block that is an FMU: co-simulation or scheduled execution at the block's sample time, or model exchange, whose
//! states are integrated with the run.
//!
//! Unlike other blocks it has a state that does not stand in the diagram's memory, but in the FMU: see [`Work`].

mod exchange;
mod ports;
mod slope;
mod stepped;
mod work;

use std::sync::{Arc, Mutex, PoisonError};

use sincro_blocks::block::{At, Block, Memory, Node, Ports, SampleTimeKind};
use sincro_blocks::kind::{Category, Described, Kind, Parameter, ValueKind};
use sincro_blocks::reader::Reader;
use sincro_blocks::unit::Unit;
use sincro_math::Real;

use super::robot::Item;
use crate::fmu::{FmuInstance, FmuInterface, FmuLoader, FmuModel};
use ports::{Port, PortReader};
pub use work::Work;

/// FMU as a block of a diagram.
#[derive(Clone, Debug)]
pub struct FmuBlock {
    model: Option<Arc<dyn FmuModel>>,
    interface: FmuInterface,
    inputs: Vec<Port>,
    outputs: Vec<Port>,
    parameters: Vec<(usize, Vec<f64>)>,
    /// For each input: true if an output may depend on it at the same instant.
    feeds_through: Vec<bool>,
    /// For each input: true if the FMU takes it at events only (model exchange).
    is_discrete: Vec<bool>,
    n_states: usize,
    n_crossings: usize,
    fault: Arc<Mutex<Option<String>>>,
}

pub(super) const ITEM: Item =
    Item { kind: FmuBlock::KIND, read: |reader, context| Box::new(FmuBlock::with_loader(reader, context.fmus)) };

/// Words of the parameter `interface`, and what they stand for; the first one is the default.
const INTERFACES: [(&str, Option<FmuInterface>); 4] = [
    ("any", None),
    ("co-simulation", Some(FmuInterface::CoSimulation)),
    ("model-exchange", Some(FmuInterface::ModelExchange)),
    ("scheduled-execution", Some(FmuInterface::ScheduledExecution)),
];

impl Described for FmuBlock {
    const KIND: &'static Kind = &Kind {
        name: "fmu",
        category: Category::Scripts,
        summary: "A functional mock-up unit (FMI 2.0 or 3.0): stepped at its samples (co-simulation, scheduled \
                  execution), or integrated with the run (model exchange).",
        equation: "y = outputs of the FMU at t; then it steps to the next sample under u, or x' = f(x, u, t) is integrated",
        parameters: &[
            Parameter::required("file", ValueKind::Text, "FMU of the scene folder; its code runs in this program"),
            Parameter::optional(
                "interface",
                ValueKind::Choice(&["any", "co-simulation", "model-exchange", "scheduled-execution"]),
                "interface by which it is simulated; any: co-simulation where the file has it",
                "any",
            ),
            Parameter::optional("inputs", ValueKind::Texts, "names of its inputs that are ports", "none"),
            Parameter::optional("outputs", ValueKind::Texts, "names of its outputs that are ports", "none"),
            Parameter::optional(
                "parameters",
                ValueKind::NumberLists,
                "start values of its variables, lists for arrays, in SI units",
                "none",
            ),
            Parameter::optional(
                "units",
                ValueKind::Names,
                "units of ports and parameters that are not SI units",
                "none",
            ),
        ],
    };

    fn read(p: &mut Reader<'_>) -> Self {
        Self::with_loader(p, None)
    }
}

impl FmuBlock {
    /// Reads its parameters; `loader` reads its file.
    fn with_loader(p: &mut Reader<'_>, loader: Option<&dyn FmuLoader>) -> Self {
        let mut new = Self {
            model: None,
            interface: FmuInterface::CoSimulation,
            inputs: Vec::new(),
            outputs: Vec::new(),
            parameters: Vec::new(),
            feeds_through: Vec::new(),
            is_discrete: Vec::new(),
            n_states: 0,
            n_crossings: 0,
            fault: Arc::default(),
        };
        let Some(loader) = loader else {
            p.fault(
                "file",
                "this program cannot load FMUs",
                "it was built without `sincro-fmu`; use the `sincro` command",
            );
            return new;
        };
        let Some(bytes) = p.binary_file("file") else { return new };
        match loader.read(&bytes) {
            Ok(model) => new.read_ports(p, &model),
            Err(message) => {
                p.fault("file", message, "take a whole FMU of FMI 2.0 or 3.0 that has a library for this platform")
            }
        }
        new
    }

    fn read_ports(&mut self, p: &mut Reader<'_>, model: &Arc<dyn FmuModel>) {
        let asked = INTERFACES[p.choice("interface")].1;
        match asked.or_else(|| model.interfaces().first().copied()) {
            Some(interface) if model.interfaces().contains(&interface) => self.interface = interface,
            _ => {
                let there = INTERFACES.iter().filter(|(_, of)| of.is_some_and(|of| model.interfaces().contains(&of)));
                let there: Vec<&str> = there.map(|(word, _)| *word).collect();
                let help = format!("it has: {}", there.join(", "));
                p.fault("interface", "the FMU does not have this interface", help);
            }
        }
        let given = if p.has("parameters") { p.named_lists("parameters") } else { Vec::new() };
        let variables = model.variables();
        let mut reader = PortReader::new(p, &**model, &given);
        self.inputs = reader.ports(p, "inputs", "input");
        self.outputs = reader.ports(p, "outputs", "output");
        self.parameters = reader.parameters(p, &given);
        let is_exchange = self.interface == FmuInterface::ModelExchange;
        let of_inputs = |is: &dyn Fn(usize) -> bool| self.inputs.iter().map(|port| is(port.place)).collect();
        self.is_discrete = of_inputs(&|k| is_exchange && variables[k].is_discrete);
        self.feeds_through = of_inputs(&|k| variables[k].feeds_through || (is_exchange && variables[k].is_discrete));
        if let Some(clock) = self.inputs.iter().find(|port| variables[port.place].is_clock)
            && self.interface != FmuInterface::ScheduledExecution
        {
            let message = format!("the input `{}` of the FMU is a clock, which its importer triggers", clock.name);
            p.fault("inputs", message, "clocks are triggered in scheduled execution alone");
        }
        if is_exchange {
            let exchange = model.exchange();
            let size = |places: &[usize]| places.iter().map(|k| reader.width(&variables[*k])).sum::<usize>();
            (self.n_states, self.n_crossings) =
                (size(&exchange.states), size(&exchange.crossings) + exchange.n_crossings);
        }
        reader.finish(p);
        self.model = Some(model.clone());
    }

    /// The result; an error is noted, unless the state was lost before: that reason is the one that counts.
    fn note<T>(&self, count: f64, result: Result<T, String>) -> Option<T> {
        result
            .map_err(|message| {
                if count.is_nan() {
                    return;
                }
                let name = self.model.as_ref().map_or("", |model| model.name());
                let message = format!("the FMU `{name}`: {message}");
                *self.fault.lock().unwrap_or_else(PoisonError::into_inner) = Some(message);
            })
            .ok()
    }

    fn model(&self) -> Result<&dyn FmuModel, String> {
        self.model.as_deref().ok_or_else(|| "it was not read".to_owned())
    }

    /// Sets the inputs that are `chosen`.
    fn set_inputs<R: Real>(
        &self,
        at: &At<'_, R>,
        (instance, values): (&mut dyn FmuInstance, &mut Vec<f64>),
        chosen: impl Fn(usize) -> bool,
    ) -> Result<(), String> {
        let places = self.read_inputs(at, values, chosen);
        if places.is_empty() { Ok(()) } else { instance.set((&places, values)) }
    }

    /// Writes the inputs that are `chosen` into `values`, in the units of the FMU, and returns their places.
    fn read_inputs<R: Real>(
        &self,
        at: &At<'_, R>,
        values: &mut Vec<f64>,
        chosen: impl Fn(usize) -> bool,
    ) -> Vec<usize> {
        values.clear();
        let ports = self.inputs.iter().enumerate().filter(|(k, _)| chosen(*k));
        ports
            .map(|(k, port)| {
                values.extend((0..port.width).map(|i| port.to_fmu(at.component(k, i).lane(0))));
                port.place
            })
            .collect()
    }

    /// Reads the outputs into `values`, in the units of the ports.
    fn get_outputs(&self, instance: &mut dyn FmuInstance, values: &mut Vec<f64>) -> Result<(), String> {
        let places: Vec<usize> = self.outputs.iter().map(|port| port.place).collect();
        values.resize(self.outputs.iter().map(|port| port.width).sum(), 0.0);
        instance.get(&places, values)?;
        let mut rest = values.as_mut_slice();
        for port in &self.outputs {
            let (own, others) = rest.split_at_mut(port.width);
            own.iter_mut().for_each(|x| *x = port.of_fmu(*x));
            rest = others;
        }
        Ok(())
    }
}

impl Block for FmuBlock {
    type Work<R: Real> = Work;

    fn ports(&self) -> Ports {
        let names = |ports: &[Port]| ports.iter().map(|port| port.name.clone()).collect();
        Ports { inputs: names(&self.inputs), outputs: names(&self.outputs) }
    }

    fn widths(&self, inputs: &[Option<usize>]) -> Result<Vec<Option<usize>>, String> {
        for (port, width) in self.inputs.iter().zip(inputs) {
            if width.is_some_and(|n| n != port.width && n != 1) {
                return Err(match port.width {
                    1 => format!("`{}` takes one number", port.name),
                    n => format!("`{}` takes {n} numbers, or one for all", port.name),
                });
            }
        }
        Ok(self.outputs.iter().map(|port| Some(port.width)).collect())
    }

    fn units(&self, inputs: &[Option<Unit>]) -> Result<Vec<Option<Unit>>, String> {
        for (port, unit) in self.inputs.iter().zip(inputs) {
            if let (Some(taken), Some(given)) = (&port.unit, unit)
                && !taken.is_same(given)
            {
                return Err(format!(
                    "`{}` takes {taken}, not {given}; `units` of the block can change that",
                    port.name
                ));
            }
        }
        Ok(self.outputs.iter().map(|port| port.unit.clone()).collect())
    }

    fn sample_time_kind(&self) -> SampleTimeKind {
        match self.interface {
            FmuInterface::ModelExchange => SampleTimeKind::Continuous,
            _ => SampleTimeKind::Discrete,
        }
    }

    fn has_direct_feedthrough(&self, input: usize) -> bool {
        self.feeds_through[input]
    }

    fn memory(&self, _: &Node) -> Memory {
        match self.interface {
            FmuInterface::ModelExchange => {
                Memory { continuous: self.n_states, discrete: self.exchange_memory().n_numbers() }
            }
            _ => Memory::DISCRETE,
        }
    }

    fn start<R: Real>(&self, _: &Node, _: &mut [R], memory: &mut [R]) {
        if self.interface == FmuInterface::ModelExchange {
            self.start_exchange(memory);
        }
    }

    fn output<R: Real>(&self, at: &At<'_, R>, work: &mut Work, y: &mut [R]) {
        let count = at.memory[0].lane(0);
        let evaluated = match self.interface {
            FmuInterface::ModelExchange => self.exchange_outputs(at, work, y),
            _ => self.stepped_outputs(at, work, y),
        };
        if self.note(count, evaluated).is_none() {
            y.fill(R::splat(f64::NAN));
        }
    }

    fn derivatives<R: Real>(&self, at: &At<'_, R>, work: &mut Work, derivatives: &mut [R]) {
        let count = at.memory[0].lane(0);
        let evaluated = self.exchange_derivatives(at, work, derivatives);
        if self.note(count, evaluated).is_none() {
            derivatives.fill(R::splat(f64::NAN));
        }
    }

    fn update<R: Real>(&self, at: &At<'_, R>, work: &mut Work, memory: &mut [R], _: &mut [R]) {
        if self.interface == FmuInterface::ModelExchange {
            return;
        }
        let steps = memory[0].lane(0);
        let stepped = self.step(at, work, steps);
        let made = self.note(steps, stepped).is_some();
        work.count = steps + 1.0;
        memory[0] = R::splat(if made { steps + 1.0 } else { f64::NAN });
    }

    fn zero_crossing_count(&self) -> Option<usize> {
        (self.interface == FmuInterface::ModelExchange).then_some(self.n_crossings)
    }

    fn zero_crossings<R: Real>(&self, at: &At<'_, R>, work: &mut Work, values: &mut [R]) {
        let count = at.memory[0].lane(0);
        let evaluated = self.exchange_crossings(at, work, values);
        if self.note(count, evaluated).is_none() {
            values.fill(R::splat(f64::NAN));
        }
    }

    fn scheduled_event<R: Real>(&self, memory: &[R]) -> f64 {
        self.scheduled_exchange_event(memory)
    }

    fn handle_events<R: Real>(
        &self,
        at: &At<'_, R>,
        work: &mut Work,
        (memory, states): (&mut [R], &mut [R]),
        is_step_end: bool,
    ) -> bool {
        let count = memory[0].lane(0);
        if count.is_nan() {
            return false;
        }
        let handled = self.handle_exchange_events(at, work, (memory, states), is_step_end);
        self.note(count, handled).unwrap_or_else(|| {
            memory[0] = R::splat(f64::NAN);
            true
        })
    }

    fn save_outside<R: Real>(&self, work: &Work, memory: &[R]) -> Option<Vec<u8>> {
        let can_save = self.model.as_ref().is_some_and(|model| model.can_save(self.interface));
        if can_save { work.save_after(memory[0].lane(0)) } else { None }
    }

    fn restore_outside<R: Real>(&self, work: &mut Work, saved: Option<&[u8]>, memory: &[R]) {
        work.restore(saved, memory[0].lane(0));
    }

    fn fault(&self) -> Option<String> {
        self.fault.lock().unwrap_or_else(PoisonError::into_inner).clone()
    }
}
