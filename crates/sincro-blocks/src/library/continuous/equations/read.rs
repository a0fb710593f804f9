//! From texts to formulas with slots, with everything that is wrong noted at its place.

use sincro_math::expression::Expression;

use super::{Equations, Output, Rate, Source, State};
use crate::reader::{Reader, Value};

/// An equation, cut at its `=`.
struct Equation {
    /// Number in the list.
    number: usize,
    /// The name without its primes.
    name: String,
    /// 1 or 2.
    order: usize,
    /// Its right-hand side, with blanks for what stands before it: columns stay those of the whole.
    right: String,
}

/// All names that formulas know, in the order of their slots.
#[derive(Default)]
struct Names {
    list: Vec<String>,
}

impl Names {
    /// Adds a name; a fault if it is taken or cannot be one.
    fn add(&mut self, p: &mut Reader<'_>, key: &str, name: &str) {
        if self.list.iter().any(|known| known == name) {
            let help = "inputs, states, parameters and definitions share one list of names, and `t` is the time";
            p.fault(key, format!("`{name}` has two meanings"), help);
        } else {
            p.check_name(key, name);
        }
        self.list.push(name.to_owned());
    }

    fn formula(&self, p: &mut Reader<'_>, path: &[&str], text: &str) -> Expression {
        let names: Vec<&str> = self.list.iter().map(String::as_str).collect();
        p.formula(path, text, &names).map_or_else(nothing, |formula| formula.expression)
    }
}

/// Stand-in for a formula that does not parse.
fn nothing() -> Expression {
    Expression::parse("0", &[]).expect("a number is a formula")
}

pub(super) fn read(p: &mut Reader<'_>) -> Equations {
    let inputs = p.texts("inputs");
    inputs.iter().for_each(|name| check_port(p, "inputs", name));
    let equations = cut(p);
    let coordinates = p.texts("coordinates");
    let mut states = states(p, &equations, &coordinates);
    set_initial(p, &mut states);

    let mut names = Names::default();
    inputs.iter().for_each(|name| names.add(p, "inputs", name));
    for state in &states {
        let is_coordinate = coordinates.iter().any(|q| *q == state.name.trim_end_matches('\''));
        names.add(p, if is_coordinate { "coordinates" } else { "equations" }, &state.name);
    }
    names.list.push("t".into());
    let constants = constants(p, &mut names);
    let definitions = definitions(p, &mut names);

    let right_sides = equations.iter().map(|e| names.formula(p, &["equations", &e.number.to_string()], &e.right));
    let right_sides = right_sides.collect();
    let (mass_matrix, forces) = robot(p, &names, coordinates.len());
    let outputs = outputs(p, &names, &states);

    let mut new = Equations {
        needed: vec![false; definitions.len()],
        has_direct_feedthrough: vec![false; inputs.len()],
        inputs,
        states,
        constants,
        definitions,
        right_sides,
        mass_matrix,
        forces,
        outputs,
    };
    if new.states.is_empty() {
        let help = "give equations = [\"x' = …\"], or coordinates with mass_matrix and forces";
        p.fault("equations", "there is no equation", help);
    }
    find_needed(&mut new);
    new
}

/// The equations, each cut at its first `=` that is not part of a comparison.
fn cut(p: &mut Reader<'_>) -> Vec<Equation> {
    let mut equations = Vec::new();
    for (number, text) in p.texts("equations").into_iter().enumerate() {
        let left = text.split_once('=').map(|(left, _)| left);
        let name = left.map_or("", |left| left.trim().trim_end_matches('\''));
        let order = left.map_or(0, |left| left.trim().len() - name.len());
        if name.is_empty() || !matches!(order, 1 | 2) {
            let message = format!("`{text}` is no differential equation of first or second order");
            p.fault_at(&["equations", &number.to_string()], None, message, "write \"x' = …\" or \"q'' = …\"");
            continue;
        }
        let right_begins = left.map_or(0, str::len) + 1;
        let right = " ".repeat(right_begins) + &text[right_begins..];
        equations.push(Equation { number, name: name.to_owned(), order, right });
    }
    equations
}

fn states(p: &mut Reader<'_>, equations: &[Equation], coordinates: &[String]) -> Vec<State> {
    let mut states: Vec<State> = Vec::new();
    let mut seen: Vec<&str> = Vec::new();
    for (k, equation) in equations.iter().enumerate() {
        let name = equation.name.as_str();
        if seen.contains(&name) {
            let message = format!("there are two equations for `{name}`");
            p.fault_at(&["equations", &equation.number.to_string()], None, message, "leave one of them out");
            continue;
        }
        seen.push(name);
        add_states(&mut states, name, equation.order, Rate::RightSide(k));
    }
    for (k, name) in coordinates.iter().enumerate() {
        if seen.contains(&name.as_str()) {
            let message = format!("there are two equations for `{name}`");
            p.fault_at(&["coordinates", &k.to_string()], None, message, "a coordinate needs no other equation");
            continue;
        }
        seen.push(name);
        add_states(&mut states, name, 2, Rate::Acceleration(k));
    }
    states
}

fn add_states(states: &mut Vec<State>, name: &str, order: usize, rate: Rate) {
    if order == 2 {
        let velocity = states.len() + 1;
        states.push(State { name: name.to_owned(), initial: 0.0, rate: Rate::State(velocity) });
        states.push(State { name: format!("{name}'"), initial: 0.0, rate });
    } else {
        states.push(State { name: name.to_owned(), initial: 0.0, rate });
    }
}

fn set_initial(p: &mut Reader<'_>, states: &mut [State]) {
    for (name, x) in p.named_numbers("initial") {
        match states.iter_mut().find(|state| state.name == name) {
            Some(state) => state.initial = x,
            None => {
                let known: Vec<&str> = states.iter().map(|state| state.name.as_str()).collect();
                let help = format!("the states are {}", known.join(", "));
                p.fault_at(&["initial", &name], None, format!("`{name}` is no state"), help);
            }
        }
    }
}

/// The parameters, then those of the diagram that no other name hides.
fn constants(p: &mut Reader<'_>, names: &mut Names) -> Vec<f64> {
    let mut values = Vec::new();
    for (name, x) in p.named_numbers("parameters") {
        names.add(p, "parameters", &name);
        values.push(x);
    }
    for (name, x) in p.scope() {
        if !names.list.contains(name) {
            names.list.push(name.clone());
            values.push(*x);
        }
    }
    values
}

fn definitions(p: &mut Reader<'_>, names: &mut Names) -> Vec<Expression> {
    let mut definitions = Vec::new();
    for (name, text) in p.named_texts("where") {
        definitions.push(names.formula(p, &["where", &name], &text));
        names.add(p, "where", &name);
    }
    definitions
}

/// Mass matrix and forces of `n` coordinates.
fn robot(p: &mut Reader<'_>, names: &Names, n: usize) -> (Vec<Expression>, Vec<Expression>) {
    let forces = p.texts("forces");
    if forces.len() != n {
        let message = format!("`forces` has {} formulas, `coordinates` {n} names", forces.len());
        p.fault("forces", message, "give one for each coordinate");
    }
    let rows: Vec<Vec<String>> = rows_of_texts(p);
    if rows.len() != n || rows.iter().any(|row| row.len() != n) {
        let size = rows.first().map_or(0, Vec::len);
        let message = format!("`mass_matrix` is {} × {size}, `coordinates` has {n} names", rows.len());
        p.fault("mass_matrix", message, format!("give {n} rows of {n} formulas"));
        return (vec![nothing(); n * n], vec![nothing(); n]);
    }
    let mut matrix = Vec::new();
    for (i, row) in rows.iter().enumerate() {
        for (k, text) in row.iter().enumerate() {
            matrix.push(names.formula(p, &["mass_matrix", &i.to_string(), &k.to_string()], text));
        }
    }
    let force = |(k, text): (usize, &String)| names.formula(p, &["forces", &k.to_string()], text);
    let mut forces: Vec<Expression> = forces.iter().enumerate().map(force).collect();
    forces.resize(n, nothing());
    (matrix, forces)
}

/// The mass matrix as it is written.
fn rows_of_texts(p: &mut Reader<'_>) -> Vec<Vec<String>> {
    let rows: Vec<&Value> = match p.raw("mass_matrix") {
        None => return Vec::new(),
        Some(Value::List(rows)) => rows.iter().collect(),
        // of one coordinate
        Some(entry) => vec![entry],
    };
    let mut texts = Vec::new();
    for (i, row) in rows.into_iter().enumerate() {
        let entries: Vec<&Value> = match row {
            Value::List(entries) => entries.iter().collect(),
            entry => vec![entry],
        };
        let mut out = Vec::new();
        for (k, entry) in entries.into_iter().enumerate() {
            out.push(match entry {
                Value::Text(text) => text.clone(),
                Value::Number(x) => format!("{x:?}"),
                _ => {
                    let path = ["mass_matrix", &i.to_string(), &k.to_string()];
                    p.fault_at(&path, None, "this is not a formula", "put it in quotes");
                    "0".into()
                }
            });
        }
        texts.push(out);
    }
    texts
}

fn outputs(p: &mut Reader<'_>, names: &Names, states: &[State]) -> Vec<Output> {
    if !p.has("outputs") {
        let output = |(k, state): (usize, &State)| Output { port: port_of(&state.name), source: Source::State(k) };
        let outputs: Vec<Output> = states.iter().enumerate().map(output).collect();
        for (k, output) in outputs.iter().enumerate() {
            if outputs[..k].iter().any(|other| other.port == output.port) {
                let message = format!("two states would be the output `{}`", output.port);
                p.fault("equations", message, "rename one of them, or give `outputs`");
            }
        }
        return outputs;
    }
    let mut outputs = Vec::new();
    for (port, text) in p.named_texts("outputs") {
        check_port(p, "outputs", &port);
        let formula = names.formula(p, &["outputs", &port], &text);
        let state = states.iter().position(|state| state.name == text.trim());
        outputs.push(Output { port, source: state.map_or(Source::Formula(formula), Source::State) });
    }
    if outputs.is_empty() {
        p.fault("outputs", "`outputs` is empty", "leave it out to have every state as an output");
    }
    outputs
}

/// `q_dot` for the state `q'`.
fn port_of(state: &str) -> String {
    state.strip_suffix('\'').map_or_else(|| state.to_owned(), |name| format!("{name}_dot"))
}

/// A port's name can be written in a wire.
fn check_port(p: &mut Reader<'_>, key: &str, name: &str) {
    if !name.chars().all(|c| c.is_alphanumeric() || c == '_') {
        p.fault(key, format!("`{name}` cannot be the name of a port"), "use letters, digits and `_`");
    }
}

/// Finds the definitions and inputs that the outputs depend on.
fn find_needed(new: &mut Equations) {
    let first = new.first_definition();
    let formulas: Vec<Expression> = new.outputs.iter().filter_map(|y| formula(&y.source)).cloned().collect();
    // a definition uses earlier ones only: backwards, each is settled before those it uses
    for k in (0..new.definitions.len()).rev() {
        let later = (k + 1..new.definitions.len()).filter(|&m| new.needed[m]).map(|m| &new.definitions[m]);
        let is_used = formulas.iter().chain(later).any(|formula| formula.uses(first + k));
        new.needed[k] = is_used;
    }
    for input in 0..new.inputs.len() {
        let needed = new.definitions.iter().zip(&new.needed).filter(|(_, needed)| **needed).map(|(f, _)| f);
        new.has_direct_feedthrough[input] = formulas.iter().chain(needed).any(|formula| formula.uses(input));
    }
}

fn formula(source: &Source) -> Option<&Expression> {
    match source {
        Source::Formula(formula) => Some(formula),
        Source::State(_) => None,
    }
}
