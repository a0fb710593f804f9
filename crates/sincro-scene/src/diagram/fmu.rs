//! A block that is an FMU: co-simulation at the block's sample time.
//!
//! Unlike other blocks it has a state that does not stand in the diagram's memory, but in the FMU. The memory counts
//! its steps, so that a run that goes back to a snapshot, or a copy of it, is refused and not silently wrong; to its
//! start it can always go back.

use std::sync::{Arc, Mutex, PoisonError};

use sincro_blocks::block::{At, Block, Memory, Node, Ports, SampleTimeKind};
use sincro_blocks::kind::{Category, Described, Kind, Parameter, ValueKind};
use sincro_blocks::reader::Reader;
use sincro_blocks::unit::Unit;
use sincro_math::Real;

use super::robot::Item;
use crate::fmu::{FmuInstance, FmuLoader, FmuModel};
use crate::suggest;

/// FMU as a block of a diagram: co-simulation at the block's sample time.
#[derive(Clone, Debug)]
pub struct FmuBlock {
    model: Option<Arc<dyn FmuModel>>,
    /// Names of ports, and places of their variables.
    inputs: Vec<(String, usize)>,
    outputs: Vec<(String, usize)>,
    units: Vec<Option<Unit>>,
    parameters: Vec<(usize, f64)>,
    has_feedthrough: bool,
    fault: Arc<Mutex<Option<String>>>,
}

pub(super) const ITEM: Item =
    Item { kind: FmuBlock::KIND, read: |reader, context| Box::new(FmuBlock::with_loader(reader, context.fmus)) };

impl Described for FmuBlock {
    const KIND: &'static Kind = &Kind {
        name: "fmu",
        category: Category::Scripts,
        summary: "A functional mock-up unit (FMI 2.0 or 3.0) in co-simulation, with a step at each sample.",
        equation: "y = outputs of the FMU at t; then it steps to the next sample under u",
        parameters: &[
            Parameter::required("file", ValueKind::Text, "FMU of the scene folder; its code runs in this program"),
            Parameter::optional("inputs", ValueKind::Texts, "names of its inputs that are ports", "none"),
            Parameter::optional("outputs", ValueKind::Texts, "names of its outputs that are ports", "none"),
            Parameter::optional("parameters", ValueKind::Names, "start values of its parameters", "none"),
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
            inputs: Vec::new(),
            outputs: Vec::new(),
            units: Vec::new(),
            parameters: Vec::new(),
            has_feedthrough: true,
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
        let model = match loader.read(&bytes) {
            Ok(model) => model,
            Err(message) => {
                p.fault("file", message, "export it for co-simulation and for this platform");
                return new;
            }
        };
        new.inputs = ports(p, "inputs", "input", &*model);
        new.outputs = ports(p, "outputs", "output", &*model);
        if p.has("parameters") {
            for (name, value) in p.named_numbers("parameters") {
                new.parameters.extend(place(p, "parameters", &name, "parameter", &*model).map(|k| (k, value)));
            }
        }
        let variables = model.variables();
        let unit = |k: usize| variables[k].2.and_then(|text| Unit::parse(&text.replace('.', "·")).ok());
        new.units = new.outputs.iter().map(|(_, k)| unit(*k)).collect();
        new.has_feedthrough = model.has_feedthrough();
        new.model = Some(model.clone());
        new
    }

    /// The result; an error is noted, unless the step before has failed: its reason is the one that counts.
    fn note<T>(&self, steps: f64, result: Result<T, String>) -> Option<T> {
        result
            .map_err(|message| {
                if steps.is_nan() {
                    return;
                }
                let name = self.model.as_ref().map_or("", |model| model.name());
                let message = format!("the FMU `{name}`: {message}");
                *self.fault.lock().unwrap_or_else(PoisonError::into_inner) = Some(message);
            })
            .ok()
    }

    /// The instance after `steps` steps; made at the first call.
    fn instance<'a>(&self, work: &'a mut Work, steps: f64, t: f64) -> Result<&'a mut dyn FmuInstance, String> {
        if steps == 0.0 && work.steps != 0.0 {
            *work = Work::default();
        }
        if work.steps != steps {
            return Err(format!("its state after {steps} steps is not part of what was saved or copied"));
        }
        let slot = work.instance.get_mut().unwrap_or_else(PoisonError::into_inner);
        if slot.is_none() {
            if steps != 0.0 {
                return Err("a copy of a run cannot go on: its state cannot be copied".into());
            }
            let model = self.model.as_ref().ok_or("it was not read")?;
            *slot = Some(model.instantiate(t, &self.parameters)?);
        }
        slot.as_deref_mut().ok_or_else(|| "it was not made".into()).map(|instance| instance as &mut dyn FmuInstance)
    }

    fn set_inputs<R: Real>(&self, at: &At<'_, R>, instance: &mut dyn FmuInstance) -> Result<(), String> {
        let places: Vec<usize> = self.inputs.iter().map(|(_, k)| *k).collect();
        let values: Vec<f64> = (0..places.len()).map(|k| at.scalar(k).lane(0)).collect();
        instance.set(&places, &values)
    }
}

/// Ports of one causality: those that are named, or all.
fn ports(p: &mut Reader<'_>, key: &str, causality: &str, model: &dyn FmuModel) -> Vec<(String, usize)> {
    let places: Vec<usize> = if p.has(key) {
        p.texts(key).iter().filter_map(|name| place(p, key, name, causality, model)).collect()
    } else {
        let variables = model.variables();
        (0..variables.len()).filter(|k| variables[*k].1 == causality).collect()
    };
    let variables = model.variables();
    let mut ports: Vec<(String, usize)> = Vec::new();
    for k in places {
        let name = port_name(variables[k].0);
        if ports.iter().any(|(known, _)| *known == name) {
            let help = format!("give `{key}` with one of them");
            p.fault(key, format!("two {causality}s of the FMU would be the port `{name}`"), help);
        }
        ports.push((name, k));
    }
    ports
}

/// Place of a variable that is named.
fn place(p: &mut Reader<'_>, key: &str, name: &str, causality: &str, model: &dyn FmuModel) -> Option<usize> {
    let variables = model.variables();
    let found = variables.iter().position(|(known, of, _)| *known == name && *of == causality);
    if found.is_none() {
        let known: Vec<&str> = variables.iter().filter(|(_, of, _)| *of == causality).map(|(name, ..)| *name).collect();
        let help = suggest::help(name, &known, "there are");
        p.fault(key, format!("the FMU has no {causality} `{name}`"), help);
    }
    found
}

/// Name of a port: letters, digits and `_`.
fn port_name(variable: &str) -> String {
    let plain: String = variable.chars().map(|c| if c.is_ascii_alphanumeric() { c } else { '_' }).collect();
    let plain = plain.trim_matches('_');
    if plain.starts_with(|c: char| c.is_ascii_alphabetic()) { plain.to_owned() } else { format!("p{plain}") }
}

/// An instance at work.
#[derive(Debug, Default)]
pub struct Work {
    instance: Mutex<Option<Box<dyn FmuInstance>>>,
    /// Steps that it has made.
    steps: f64,
}

/// A copy has no instance: it can begin anew, but not go on.
impl Clone for Work {
    fn clone(&self) -> Self {
        Self { instance: Mutex::default(), steps: self.steps }
    }
}

impl Block for FmuBlock {
    type Work<R: Real> = Work;

    fn ports(&self) -> Ports {
        let names = |ports: &[(String, usize)]| ports.iter().map(|(name, _)| name.clone()).collect();
        Ports { inputs: names(&self.inputs), outputs: names(&self.outputs) }
    }

    fn widths(&self, inputs: &[Option<usize>]) -> Result<Vec<Option<usize>>, String> {
        match inputs.iter().position(|width| width.is_some_and(|n| n != 1)) {
            Some(k) => Err(format!("`{}` takes one number", self.inputs[k].0)),
            None => Ok(vec![Some(1); self.outputs.len()]),
        }
    }

    fn units(&self, _: &[Option<Unit>]) -> Result<Vec<Option<Unit>>, String> {
        Ok(self.units.clone())
    }

    fn sample_time_kind(&self) -> SampleTimeKind {
        SampleTimeKind::Discrete
    }

    fn has_direct_feedthrough(&self, _: usize) -> bool {
        self.has_feedthrough
    }

    fn memory(&self, _: &Node) -> Memory {
        Memory::DISCRETE
    }

    fn output<R: Real>(&self, at: &At<'_, R>, work: &mut Work, y: &mut [R]) {
        let steps = at.memory[0].lane(0);
        let mut evaluate = || {
            let instance = self.instance(work, steps, at.t)?;
            if self.has_feedthrough {
                self.set_inputs(at, instance)?;
            }
            let places: Vec<usize> = self.outputs.iter().map(|(_, k)| *k).collect();
            let mut values = vec![0.0; places.len()];
            instance.get(&places, &mut values)?;
            Ok(values)
        };
        let values = self.note(steps, evaluate());
        for (k, y) in y.iter_mut().enumerate() {
            *y = R::splat(values.as_ref().map_or(f64::NAN, |values| values[k]));
        }
    }

    fn update<R: Real>(&self, at: &At<'_, R>, work: &mut Work, memory: &mut [R], _: &mut [R]) {
        let steps = memory[0].lane(0);
        let mut step = || {
            let instance = self.instance(work, steps, at.t)?;
            self.set_inputs(at, instance)?;
            instance.step(at.t, at.node.period())
        };
        let made = self.note(steps, step());
        work.steps = steps + 1.0;
        memory[0] = R::splat(if made.is_some() { steps + 1.0 } else { f64::NAN });
    }

    fn fault(&self) -> Option<String> {
        self.fault.lock().unwrap_or_else(PoisonError::into_inner).clone()
    }
}
