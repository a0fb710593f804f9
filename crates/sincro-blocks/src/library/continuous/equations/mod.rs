//! A plant written as formulas: `x' = f(x, u, t)`, `q'' = f(q, q', u, t)`, or `mass_matrix(q)·q'' = forces`.
//!
//! Formulas know, in this order of slots: the inputs, the states, the time `t` `[s]`, the parameters, and the
//! definitions of `where`, each of which may use those before it.

mod read;
mod solve;

use std::collections::BTreeMap;

use sincro_math::Real;
use sincro_math::expression::Expression;

use crate::block::{At, Block, Memory, Node, Ports, SampleTimeKind};
use crate::kind::{Category, Described, Kind, Parameter, ValueKind};
use crate::reader::{NoFiles, ParameterError, Reader, Value};

/// Block `equations`: differential equations of first and second order, written as text.
///
/// `x' = …` has the state `x`; `q'' = …` has the states `q` and `q'`, and so has every name in `coordinates`. Without
/// `outputs` there is an output for every state, named as the state, but `q_dot` for `q'`: wires know no primes. Only
/// inputs that a formula of `outputs` uses have direct feedthrough. A singular mass matrix gives accelerations that are
/// not finite.
#[derive(Clone, Debug, PartialEq)]
pub struct Equations {
    inputs: Vec<String>,
    states: Vec<State>,
    /// Values of the parameters' slots.
    constants: Vec<f64>,
    /// The formulas of `where`.
    definitions: Vec<Expression>,
    /// Right-hand sides of the equations.
    right_sides: Vec<Expression>,
    /// n × n, row by row.
    mass_matrix: Vec<Expression>,
    /// n.
    forces: Vec<Expression>,
    outputs: Vec<Output>,
    /// True for the definitions that the outputs need.
    needed: Vec<bool>,
    /// True for the inputs that the outputs need.
    has_direct_feedthrough: Vec<bool>,
}

#[derive(Clone, Debug, PartialEq)]
struct State {
    /// As formulas know it: `q` or `q'`.
    name: String,
    initial: f64,
    rate: Rate,
}

/// Source of the derivative of a state.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Rate {
    /// It is another state.
    State(usize),
    /// A right-hand side.
    RightSide(usize),
    /// A coordinate's acceleration, from the mass matrix.
    Acceleration(usize),
}

#[derive(Clone, Debug, PartialEq)]
struct Output {
    port: String,
    source: Source,
}

#[derive(Clone, Debug, PartialEq)]
enum Source {
    State(usize),
    Formula(Expression),
}

/// Values of all names, the formulas' stack, the mass matrix and the forces.
#[derive(Clone, Debug)]
pub struct Work<R> {
    values: Vec<R>,
    stack: Vec<R>,
    matrix: Vec<R>,
    forces: Vec<R>,
}

impl<R> Default for Work<R> {
    fn default() -> Self {
        Self { values: Vec::new(), stack: Vec::new(), matrix: Vec::new(), forces: Vec::new() }
    }
}

impl Equations {
    /// Creates the block from parameters, by key and value as in a file: `inputs`, `equations`, `outputs`, `where`, and
    /// so on.
    ///
    /// # Errors
    ///
    /// All errors of the parameters: unknown keys, formulas that do not parse, sizes that do not fit.
    ///
    /// ```
    /// use sincro_blocks::library::continuous::Equations;
    ///
    /// let given = [("inputs", vec!["u"]), ("equations", vec!["q'' = u - 9.81*sin(q)"])];
    /// let pendulum = Equations::new(given.map(|(key, texts)| (key, texts.into()))).unwrap();
    /// # let _ = pendulum;
    /// ```
    pub fn new<'a>(parameters: impl IntoIterator<Item = (&'a str, Value)>) -> Result<Self, Vec<ParameterError>> {
        let given: BTreeMap<String, Value> = parameters.into_iter().map(|(key, x)| (key.to_owned(), x)).collect();
        let scope = BTreeMap::new();
        let mut reader = Reader::new(Self::KIND, &given, &scope, &NoFiles);
        let new = Self::read(&mut reader);
        let faults = reader.finish();
        if faults.is_empty() { Ok(new) } else { Err(faults) }
    }

    /// Slots: inputs, states, time, constants, definitions.
    fn first_definition(&self) -> usize {
        self.inputs.len() + self.states.len() + 1 + self.constants.len()
    }

    /// Puts the values of all names into their slots. `is_read` tells the inputs that are known, `is_needed` the
    /// definitions.
    fn fill<R: Real>(
        &self,
        at: &At<'_, R>,
        work: &mut Work<R>,
        is_read: impl Fn(usize) -> bool,
        is_needed: impl Fn(usize) -> bool,
    ) {
        let Work { values, stack, .. } = work;
        let n = self.inputs.len();
        for k in 0..n {
            values[k] = if is_read(k) { at.scalar(k) } else { R::zero() };
        }
        let time = n + self.states.len();
        values[n..time].copy_from_slice(at.states);
        values[time] = R::splat(at.time());
        for (k, x) in self.constants.iter().enumerate() {
            values[time + 1 + k] = R::splat(*x);
        }
        for (k, definition) in self.definitions.iter().enumerate().filter(|(k, _)| is_needed(*k)) {
            values[self.first_definition() + k] = definition.eval(values, stack);
        }
    }

    /// `mass_matrix·a = forces`; the accelerations are left in `work.forces`.
    fn accelerate<R: Real>(&self, work: &mut Work<R>) {
        let Work { values, stack, matrix, forces } = work;
        for (entry, formula) in matrix.iter_mut().zip(&self.mass_matrix) {
            *entry = formula.eval(values, stack);
        }
        for (force, formula) in forces.iter_mut().zip(&self.forces) {
            *force = formula.eval(values, stack);
        }
        solve::solve(matrix, forces);
    }
}

impl Described for Equations {
    const KIND: &'static Kind = &Kind {
        name: "equations",
        category: Category::Continuous,
        summary: "A plant written as differential equations of first and second order, or with a mass matrix.",
        equation: "x' = f(x, u, t), q'' = f(q, q', u, t), mass_matrix(q)·q'' = forces(q, q', u, t)",
        parameters: &[
            Parameter::optional("inputs", ValueKind::Texts, "names of the inputs, each a scalar", "[]"),
            Parameter::optional("equations", ValueKind::Texts, "such as \"x' = -a*x + u\" or \"q'' = u/J\"", "[]"),
            Parameter::optional(
                "coordinates",
                ValueKind::Texts,
                "names q whose accelerations the mass matrix gives",
                "[]",
            ),
            Parameter::optional(
                "mass_matrix",
                ValueKind::Matrix,
                "rows of formulas, one row for each coordinate",
                "[]",
            ),
            Parameter::optional(
                "forces",
                ValueKind::Texts,
                "formulas of mass_matrix·q'', one for each coordinate",
                "[]",
            ),
            Parameter::optional("parameters", ValueKind::Names, "numbers that formulas know by name", "{}"),
            Parameter::optional("where", ValueKind::Names, "formulas with a name, each may use those before it", "{}"),
            Parameter::optional(
                "initial",
                ValueKind::Names,
                "states at the start, such as { q = 0.1, \"q'\" = 0 }; else 0",
                "{}",
            ),
            Parameter::optional(
                "outputs",
                ValueKind::Names,
                "formulas of the outputs; else every state, q' as q_dot",
                "{}",
            ),
        ],
    };

    fn read(p: &mut Reader<'_>) -> Self {
        read::read(p)
    }
}

impl Block for Equations {
    type Work<R: Real> = Work<R>;

    fn ports(&self) -> Ports {
        Ports { inputs: self.inputs.clone(), outputs: self.outputs.iter().map(|y| y.port.clone()).collect() }
    }

    fn widths(&self, inputs: &[Option<usize>]) -> Result<Vec<Option<usize>>, String> {
        for (name, width) in self.inputs.iter().zip(inputs) {
            if let Some(width) = width
                && *width != 1
            {
                return Err(format!("`{name}` takes one number, it has {width} components"));
            }
        }
        Ok(vec![Some(1); self.outputs.len()])
    }

    fn sample_time_kind(&self) -> SampleTimeKind {
        SampleTimeKind::Continuous
    }

    fn has_direct_feedthrough(&self, input: usize) -> bool {
        self.has_direct_feedthrough[input]
    }

    fn memory(&self, _: &Node) -> Memory {
        Memory { continuous: self.states.len(), discrete: 0 }
    }

    fn start<R: Real>(&self, _: &Node, states: &mut [R], _: &mut [R]) {
        for (x, state) in states.iter_mut().zip(&self.states) {
            *x = R::splat(state.initial);
        }
    }

    fn work<R: Real>(&self) -> Work<R> {
        let formulas = self.definitions.iter().chain(&self.right_sides).chain(&self.mass_matrix).chain(&self.forces);
        let of_outputs = self.outputs.iter().filter_map(|y| match &y.source {
            Source::Formula(formula) => Some(formula),
            Source::State(_) => None,
        });
        let depth = formulas.chain(of_outputs).map(Expression::stack_depth).max().unwrap_or(0);
        Work {
            values: vec![R::zero(); self.first_definition() + self.definitions.len()],
            stack: Vec::with_capacity(depth),
            matrix: vec![R::zero(); self.mass_matrix.len()],
            forces: vec![R::zero(); self.forces.len()],
        }
    }

    fn output<R: Real>(&self, at: &At<'_, R>, work: &mut Work<R>, y: &mut [R]) {
        if self.outputs.iter().any(|y| matches!(y.source, Source::Formula(_))) {
            self.fill(at, work, |input| self.has_direct_feedthrough[input], |definition| self.needed[definition]);
        }
        for (y, output) in y.iter_mut().zip(&self.outputs) {
            *y = match &output.source {
                Source::State(k) => at.states[*k],
                Source::Formula(formula) => formula.eval(&work.values, &mut work.stack),
            };
        }
    }

    fn derivatives<R: Real>(&self, at: &At<'_, R>, work: &mut Work<R>, derivatives: &mut [R]) {
        self.fill(at, work, |_| true, |_| true);
        self.accelerate(work);
        for (rate, state) in derivatives.iter_mut().zip(&self.states) {
            *rate = match state.rate {
                Rate::State(k) => at.states[k],
                Rate::RightSide(k) => self.right_sides[k].eval(&work.values, &mut work.stack),
                Rate::Acceleration(k) => work.forces[k],
            };
        }
    }

    fn label(&self) -> String {
        let second = |state: &&State| state.name.ends_with('\'');
        match (self.mass_matrix.is_empty(), self.states.iter().filter(second).count()) {
            (false, _) => "M(q)q'' = τ".into(),
            (true, 0) => "x' = f(x, u)".into(),
            (true, _) => "q'' = f(q, q', u)".into(),
        }
    }
}
