//! A block written in Lua: outputs and memory as functions of time, inputs and memory.
//!
//! What it remembers stands in the diagram's memory, not in the script, so that snapshots hold all of it. It is
//! evaluated at ticks only: a script has no derivatives.

use std::sync::{Arc, Mutex, PoisonError};

use sincro_blocks::block::{At, Block, Memory, Node, Ports, SampleTimeKind};
use sincro_blocks::kind::{Category, Described, Kind, Parameter, ValueKind};
use sincro_blocks::reader::Reader;
use sincro_math::Real;

use super::robot::Item;
use crate::script::{ScriptParser, ScriptedLaw, ScriptedLawSpec};

/// Lua code as a block of a diagram, evaluated at ticks.
#[derive(Clone, Debug)]
pub struct LuaBlock {
    spec: ScriptedLawSpec,
    initial: Vec<f64>,
    /// The law as it was read; copies are made for every run.
    law: Option<Box<dyn ScriptedLaw>>,
    fault: Arc<Mutex<Option<String>>>,
}

pub(super) const ITEM: Item =
    Item { kind: LuaBlock::KIND, read: |reader, context| Box::new(LuaBlock::with_parser(reader, context.parser)) };

impl Described for LuaBlock {
    const KIND: &'static Kind = &Kind {
        name: "lua",
        category: Category::Scripts,
        summary: "A law written in Lua, evaluated at ticks.",
        equation: "y = output(t, u, memory), then update(t, u, memory) changes memory",
        parameters: &[
            Parameter::optional(
                "code",
                ValueKind::Text,
                "Lua text with `output` and, if there is memory, `update`",
                "none",
            ),
            Parameter::optional("file", ValueKind::Text, "Lua file of the scene folder, in place of `code`", "none"),
            Parameter::optional(
                "inputs",
                ValueKind::Texts,
                "names of the inputs: `u.NAME` is a number, of a vector a list",
                "u",
            ),
            Parameter::optional(
                "outputs",
                ValueKind::Texts,
                "names of the outputs in the order of their return, `y[3]` a list of three",
                "y",
            ),
            Parameter::optional(
                "memory",
                ValueKind::Names,
                "numbers that it keeps, `memory.NAME`, and where they start",
                "none",
            ),
            Parameter::optional("parameters", ValueKind::Names, "numbers that the text knows by name", "none"),
        ],
    };

    fn read(p: &mut Reader<'_>) -> Self {
        Self::with_parser(p, None)
    }
}

impl LuaBlock {
    /// Reads its parameters; `parser` reads its text.
    fn with_parser(p: &mut Reader<'_>, parser: Option<&dyn ScriptParser>) -> Self {
        let code = match (p.has("code"), p.has("file")) {
            (true, false) => p.text("code"),
            (false, true) => p.text_file("file"),
            (both, _) => {
                let message = if both { "`code` and `file` are both given" } else { "`lua` needs `code` or `file`" };
                p.fault("code", message, "give one of them");
                String::new()
            }
        };
        let inputs = p.texts("inputs");
        let outputs: Vec<(String, usize)> = p.texts("outputs").iter().map(|text| width_of(p, text)).collect();
        let named = |p: &mut Reader<'_>, key: &str| if p.has(key) { p.named_numbers(key) } else { Vec::new() };
        let (memory, parameters) = (named(p, "memory"), named(p, "parameters"));
        for name in inputs.iter().chain(outputs.iter().map(|(name, _)| name)) {
            p.check_name(if inputs.contains(name) { "inputs" } else { "outputs" }, name);
        }
        let (names, initial) = memory.into_iter().unzip();
        let spec = ScriptedLawSpec { code, inputs, outputs, memory: names, parameters };
        let law = if spec.code.is_empty() { None } else { law(p, parser, &spec) };
        Self { spec, initial, law, fault: Arc::default() }
    }
}

/// The law of a text; what is wrong with it is noted.
fn law(p: &mut Reader<'_>, parser: Option<&dyn ScriptParser>, spec: &ScriptedLawSpec) -> Option<Box<dyn ScriptedLaw>> {
    let key = if p.has("file") { "file" } else { "code" };
    let Some(parser) = parser else {
        p.fault(key, "this program cannot run Lua", "it was built without `sincro-lua`; use the `sincro` command");
        return None;
    };
    match parser.law(spec) {
        Ok(law) => Some(law),
        Err(message) => {
            p.fault(
                key,
                message,
                "it has functions `output(t, u, memory)` and, if there is memory, `update(t, u, memory)`",
            );
            None
        }
    }
}

/// `y[3]` as `y` and 3.
fn width_of(p: &mut Reader<'_>, text: &str) -> (String, usize) {
    let Some((name, rest)) = text.split_once('[') else { return (text.to_owned(), 1) };
    let width = rest.strip_suffix(']').and_then(|n| n.parse::<usize>().ok()).filter(|n| (1..10_000).contains(n));
    if width.is_none() {
        p.fault(
            "outputs",
            format!("`{text}` is no output"),
            "write a name, or a name and how many numbers it has: y[3]",
        );
    }
    (name.to_owned(), width.unwrap_or(1))
}

/// A law at work with room for numbers on their way in and out.
#[derive(Debug, Default)]
pub struct Work {
    law: Option<Box<dyn ScriptedLaw>>,
    inputs: Vec<Vec<f64>>,
    memory: Vec<f64>,
    outputs: Vec<f64>,
}

impl Clone for Work {
    fn clone(&self) -> Self {
        let law = self.law.as_ref().map(|law| law.boxed_clone());
        Self { law, inputs: self.inputs.clone(), memory: self.memory.clone(), outputs: self.outputs.clone() }
    }
}

impl Work {
    fn take<R: Real>(&mut self, at: &At<'_, R>, memory: &[R]) {
        let n = at.node.inputs.len();
        self.inputs.resize(n, Vec::new());
        for (k, input) in self.inputs.iter_mut().enumerate() {
            input.clear();
            input.extend(at.input(k).iter().map(|x| x.lane(0)));
        }
        self.memory.clear();
        self.memory.extend(memory.iter().map(|x| x.lane(0)));
        self.outputs.resize(at.node.n_out(), 0.0);
    }
}

impl LuaBlock {
    fn note(&self, result: Result<(), String>) -> bool {
        if let Err(message) = &result {
            *self.fault.lock().unwrap_or_else(PoisonError::into_inner) = Some(message.clone());
        }
        result.is_ok()
    }
}

impl Block for LuaBlock {
    type Work<R: Real> = Work;

    fn ports(&self) -> Ports {
        Ports {
            inputs: self.spec.inputs.clone(),
            outputs: self.spec.outputs.iter().map(|(name, _)| name.clone()).collect(),
        }
    }

    fn widths(&self, _: &[Option<usize>]) -> Result<Vec<Option<usize>>, String> {
        Ok(self.spec.outputs.iter().map(|(_, width)| Some(*width)).collect())
    }

    fn sample_time_kind(&self) -> SampleTimeKind {
        SampleTimeKind::Discrete
    }

    fn memory(&self, _: &Node) -> Memory {
        Memory { continuous: 0, discrete: self.initial.len() }
    }

    fn start<R: Real>(&self, _: &Node, _: &mut [R], memory: &mut [R]) {
        for (m, x) in memory.iter_mut().zip(&self.initial) {
            *m = R::splat(*x);
        }
    }

    fn work<R: Real>(&self) -> Work {
        Work { law: self.law.as_ref().map(|law| law.boxed_clone()), ..Work::default() }
    }

    fn output<R: Real>(&self, at: &At<'_, R>, work: &mut Work, y: &mut [R]) {
        work.take(at, at.memory);
        let Work { law: Some(law), inputs, memory, outputs } = work else { return };
        let is_good = self.note(law.output(at.t, inputs, memory, outputs));
        for (y, x) in y.iter_mut().zip(outputs) {
            *y = R::splat(if is_good { *x } else { f64::NAN });
        }
    }

    fn update<R: Real>(&self, at: &At<'_, R>, work: &mut Work, memory: &mut [R], _: &mut [R]) {
        if memory.is_empty() {
            return;
        }
        work.take(at, memory);
        let Work { law: Some(law), inputs, memory: kept, .. } = work else { return };
        let is_good = self.note(law.update(at.t, inputs, kept));
        for (m, x) in memory.iter_mut().zip(kept) {
            *m = R::splat(if is_good { *x } else { f64::NAN });
        }
    }

    fn fault(&self) -> Option<String> {
        self.fault.lock().unwrap_or_else(PoisonError::into_inner).clone()
    }
}
