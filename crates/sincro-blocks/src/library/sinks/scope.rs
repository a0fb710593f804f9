//! Names signals that are to be recorded and plotted together.

use crate::library::prelude::*;

/// Block `scope`: plot of its inputs over time. It computes nothing: the program that runs the diagram records its
/// inputs.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Scope {
    /// Title of the plot; empty for the name of the block.
    pub title: String,
    /// Names of the input ports.
    pub inputs: Vec<String>,
}

impl Scope {
    /// Creates the block with this number of inputs (at least 1), named `u`, or `u1`, `u2` …
    #[must_use]
    pub fn new(inputs: usize) -> Self {
        Self { title: String::new(), inputs: Ports::numbered(inputs).inputs }
    }
}

impl Described for Scope {
    const KIND: &'static Kind = &Kind {
        name: "scope",
        category: Category::Sinks,
        summary: "A plot of its inputs over time.",
        equation: "u1, u2, … are recorded and plotted",
        parameters: &[
            Parameter::optional("title", ValueKind::Text, "heading of the plot; if empty, the name of the block", ""),
            Parameter::optional("inputs", ValueKind::Count, "number of inputs", "1"),
            Parameter::optional("names", ValueKind::Texts, "names of the inputs, instead of their number", "[]"),
        ],
    };

    fn read(p: &mut Reader<'_>) -> Self {
        let title = p.text("title");
        if !p.has("names") {
            return Self { title, ..Self::new(p.input_count("inputs")) };
        }
        if p.has("inputs") {
            p.fault("inputs", "`inputs` is given beside `names`", "there are as many inputs as names: leave it out");
        }
        let inputs = p.texts("names");
        if inputs.is_empty() {
            p.fault("names", "`names` is empty", "give a name for every input");
        }
        let is_port = |name: &str| {
            name.starts_with(|c: char| c.is_ascii_alphabetic())
                && name.chars().all(|c| c.is_ascii_alphanumeric() || c == '_')
        };
        for (k, name) in inputs.iter().enumerate() {
            if !is_port(name) {
                let help = "names of inputs have letters, digits and `_` and begin with a letter";
                p.fault("names", format!("`{name}` cannot be the name of an input"), help);
            }
            if inputs[..k].contains(name) {
                p.fault("names", format!("`{name}` is there twice"), "every input has its own name");
            }
        }
        Self { title, inputs }
    }
}

impl Block for Scope {
    type Work<R: Real> = ();
    const IN_LANES: bool = true;

    fn ports(&self) -> Ports {
        Ports { inputs: self.inputs.clone(), outputs: Vec::new() }
    }

    fn widths(&self, _: &[Option<usize>]) -> Result<Vec<Option<usize>>, String> {
        Ok(Vec::new())
    }

    #[inline(always)]
    fn output<R: Real>(&self, _: &At<'_, R>, (): &mut (), _: &mut [R]) {}

    fn label(&self) -> String {
        self.title.clone()
    }
}
