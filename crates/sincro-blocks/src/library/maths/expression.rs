//! `y = formula(u1, u2, …, t)`.
//!
//! The language is that of [`sincro_math::expression`]. It has no brackets for components, so:
//!
//! - **one** formula is evaluated component by component: its inputs are scalars or vectors of one width, and so is
//!   `y`;
//! - **several** formulas give one component of `y` each, and every input is a scalar: a wire takes it from a vector,
//!   as in `"arm.q[0]"` to `"torque.q1"`.

use crate::library::prelude::*;
use sincro_math::expression::{Expression as Parsed, is_name};

/// Block `expression`: formulas of its inputs, the diagram's parameters and the time `t` `[s]`, one component of the
/// output for each.
///
/// A formula that jumps with time, such as `if(t < 1, 0, 1)`, is no time event for the integrator: a `step` into an
/// input is one.
#[derive(Clone, Debug, PartialEq)]
pub struct Expression {
    /// Names of the input ports in the formulas.
    pub inputs: Vec<String>,
    /// Formulas of the components of the output; their names are `inputs`, then `t` `[s]`.
    pub formulas: Vec<Formula>,
}

/// Values of all names of the formulas, and the stack on which they are computed.
#[derive(Clone, Debug, Default)]
pub struct Work<R> {
    values: Vec<R>,
    stack: Vec<R>,
}

impl Expression {
    /// Creates a block of one formula; its inputs are the names in it other than `t`, in the order in which they first
    /// appear.
    ///
    /// # Panics
    ///
    /// If the formula does not parse.
    #[must_use]
    pub fn new(formula: &str) -> Self {
        let mut inputs = Parsed::names_in(formula).unwrap_or_else(|e| panic!("`{formula}`: {}", e.message));
        inputs.retain(|name| name != "t");
        let names: Vec<&str> = inputs.iter().map(String::as_str).chain(["t"]).collect();
        let expression = Parsed::parse(formula, &names).unwrap_or_else(|e| panic!("`{formula}`: {}", e.message));
        let formulas = vec![Formula { expression, n_names: names.len(), constants: Vec::new() }];
        Self { inputs, formulas }
    }

    fn uses_time(&self) -> bool {
        self.formulas.iter().any(|formula| formula.expression.uses(self.inputs.len()))
    }
}

/// The formulas, each with the path to its text.
fn texts(p: &mut Reader<'_>) -> Vec<(Vec<String>, String)> {
    match (p.has("expression"), p.has("expressions")) {
        (true, false) => vec![(vec!["expression".into()], p.text("expression"))],
        (false, true) => {
            let texts = p.texts("expressions");
            if texts.is_empty() {
                p.fault("expressions", "there are no formulas", "give one for every component of the output");
            }
            let path = |k: usize| vec!["expressions".to_owned(), k.to_string()];
            texts.into_iter().enumerate().map(|(k, text)| (path(k), text)).collect()
        }
        (both, _) => {
            let message = if both { "there are two kinds of formulas" } else { "there is no formula" };
            p.fault("expression", message, "give either expression = \"…\" or expressions = [\"…\", \"…\"]");
            Vec::new()
        }
    }
}

/// The names that the formulas use, but for `t` and the diagram's parameters.
fn inferred(p: &Reader<'_>, texts: &[(Vec<String>, String)]) -> Vec<String> {
    let mut names: Vec<String> = Vec::new();
    // a formula that does not parse is reported when it is read with its names
    for name in texts.iter().filter_map(|(_, text)| Parsed::names_in(text).ok()).flatten() {
        if name != "t" && !p.scope().contains_key(&name) && !names.contains(&name) {
            names.push(name);
        }
    }
    names
}

fn declared(p: &mut Reader<'_>) -> Vec<String> {
    let names = p.texts("inputs");
    for (k, name) in names.iter().enumerate() {
        if name == "t" {
            p.fault("inputs", "`t` is the time in formulas", "give the input another name");
        }
        if names[..k].contains(name) {
            p.fault("inputs", format!("`{name}` is there twice"), "every input has its own name");
        }
    }
    names
}

impl Described for Expression {
    const KIND: &'static Kind = &Kind {
        name: "expression",
        category: Category::Maths,
        summary: "Computes formulas of its inputs, the diagram's parameters and the time.",
        equation: "y = expression(u1, u2, …, t), component by component; or yᵢ = expressionsᵢ of scalar inputs",
        parameters: &[
            Parameter::optional(
                "expression",
                ValueKind::Text,
                "formula such as `k*(u1 - u2)^2`; t is the time [s]",
                "none",
            ),
            Parameter::optional("expressions", ValueKind::Texts, "instead: a formula for every component of y", "[]"),
            Parameter::optional(
                "inputs",
                ValueKind::Texts,
                "names of the inputs; if left out, the names in the formulas in the order in which they first appear, \
                 but for `t` and the diagram's parameters",
                "[]",
            ),
        ],
    };

    fn read(p: &mut Reader<'_>) -> Self {
        let texts = texts(p);
        let inputs = if p.has("inputs") { declared(p) } else { inferred(p, &texts) };
        let is_port = |name: &str| is_name(name) && !name.contains(['.', '\'']);
        for name in inputs.iter().filter(|name| !is_port(name)) {
            let help =
                "names of inputs have letters, digits and `_` and begin with a letter; wires bring them from anywhere";
            p.fault("inputs", format!("`{name}` cannot be the name of an input"), help);
        }
        let names: Vec<&str> = inputs.iter().map(String::as_str).chain(["t"]).collect();
        let read = |(path, text): &(Vec<String>, String)| {
            let path: Vec<&str> = path.iter().map(String::as_str).collect();
            p.formula(&path, text, &names)
        };
        let formulas = texts.iter().filter_map(read).collect();
        Self { inputs, formulas }
    }
}

impl Block for Expression {
    type Work<R: Real> = Work<R>;
    const IN_LANES: bool = true;

    fn runs_in_lanes(&self) -> bool {
        !self.uses_time()
    }

    fn ports(&self) -> Ports {
        Ports { inputs: self.inputs.clone(), outputs: vec!["y".into()] }
    }

    fn widths(&self, inputs: &[Option<usize>]) -> Result<Vec<Option<usize>>, String> {
        if self.formulas.len() == 1 {
            return Ok(vec![elementwise(inputs, &[])?]);
        }
        match inputs.iter().position(|width| width.is_some_and(|w| w != 1)) {
            Some(k) => Err(format!(
                "with several formulas every input is a scalar, `{}` has {} components",
                self.inputs[k],
                inputs[k].unwrap_or(0)
            )),
            None => Ok(vec![Some(self.formulas.len())]),
        }
    }

    fn sample_time_kind(&self) -> SampleTimeKind {
        if self.uses_time() { SampleTimeKind::TimeVarying } else { SampleTimeKind::Inherited }
    }

    fn unit_rule(&self) -> UnitRule {
        UnitRule::Formulas(self.formulas.iter().map(|formula| formula.expression.clone()).collect())
    }

    fn work<R: Real>(&self) -> Work<R> {
        let mut values = vec![R::zero(); self.inputs.len() + 1];
        // all formulas know the same parameters
        values.extend(self.formulas.first().iter().flat_map(|f| &f.constants).map(|x| R::splat(*x)));
        let depth = self.formulas.iter().map(|f| f.expression.stack_depth()).max().unwrap_or(0);
        Work { values, stack: Vec::with_capacity(depth) }
    }

    #[inline(always)]
    fn output<R: Real>(&self, at: &At<'_, R>, work: &mut Work<R>, y: &mut [R]) {
        work.values[self.inputs.len()] = R::splat(at.t);
        for (i, y) in y.iter_mut().enumerate() {
            for k in 0..self.inputs.len() {
                work.values[k] = at.component(k, i);
            }
            let formula = if self.formulas.len() == 1 { &self.formulas[0] } else { &self.formulas[i] };
            *y = formula.expression.eval(&work.values, &mut work.stack);
        }
    }

    fn label(&self) -> String {
        match &self.formulas[..] {
            [formula] if formula.expression.text().chars().count() <= 24 => formula.expression.text().to_owned(),
            _ => "f(u)".into(),
        }
    }
}
