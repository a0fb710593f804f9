//! Inner diagrams dissolve: every block gets a path, every input the outputs that reach it, through however many ports.

use core::ops::Range;

use super::{Flat, FlatNode, Input, Interface, LATE, Place, Problem, Spot, Terminal, listed};
use crate::diagram::{Diagram, Entry, What};
use crate::endpoint::{Endpoint, WORLD};
use crate::instance::Template;
use crate::library::routing::Mux;
use crate::suggest;

pub(super) fn flatten(diagram: &Diagram, interface: &Interface) -> Result<Flat, Vec<Problem>> {
    let world = |n: usize| FlatNode {
        path: WORLD.into(),
        place: Place { diagram: Vec::new(), what: Spot::Entry(WORLD.into()) },
        template: None,
        sample_time: None,
        unit: None,
        inputs: Vec::new(),
        input_names: Vec::new(),
        output_names: Vec::new(),
        in_widths: Vec::with_capacity(n),
        out_widths: Vec::new(),
        in_units: Vec::new(),
        out_units: Vec::new(),
    };
    let flat = Flat { nodes: vec![world(0), world(0)], measurements: [Vec::new(), Vec::new()], commands: Vec::new() };
    let mut work = Flattening { interface, flat, scopes: Vec::new(), problems: Vec::new() };
    let root = work.collect(diagram, Vec::new(), None, None);
    if work.problems.is_empty() {
        work.connect(root);
    }
    if work.problems.is_empty() { Ok(work.flat) } else { Err(work.problems) }
}

/// A diagram in its place.
struct Scope<'a> {
    diagram: &'a Diagram,
    path: Vec<String>,
    /// The scope around it and its name there.
    parent: Option<(usize, String)>,
    /// By entry: the node, or the scope of an inner diagram.
    members: Vec<Member>,
}

#[derive(Clone, Copy)]
enum Member {
    Node(usize),
    Scope(usize),
}

struct Flattening<'a> {
    interface: &'a Interface,
    flat: Flat,
    scopes: Vec<Scope<'a>>,
    problems: Vec<Problem>,
}

impl<'a> Flattening<'a> {
    fn problem(&mut self, path: &[String], what: Spot, message: impl Into<String>, help: impl Into<String>) {
        let place = Place { diagram: path.to_vec(), what };
        self.problems.push(Problem { place, message: message.into(), help: help.into() });
    }

    /// Makes nodes of all blocks of a diagram and of those inside it.
    fn collect(
        &mut self,
        diagram: &'a Diagram,
        path: Vec<String>,
        parent: Option<(usize, String)>,
        sample_time: Option<f64>,
    ) -> usize {
        let index = self.scopes.len();
        self.scopes.push(Scope { diagram, path: path.clone(), parent, members: Vec::new() });
        for (k, entry) in diagram.entries.iter().enumerate() {
            self.check_name(diagram, entry, k, &path);
            let (own, inherited) = (entry.sample_time.map(|ts| (ts, false)), sample_time.map(|ts| (ts, true)));
            let member = match &entry.what {
                What::Block(template) => {
                    let place = Place { diagram: path.clone(), what: Spot::Entry(entry.name.clone()) };
                    Member::Node(self.node(&path, entry, template.as_ref(), own.or(inherited), place))
                }
                What::Diagram(_, inner) => {
                    let mut deeper = path.clone();
                    deeper.push(entry.name.clone());
                    let around = Some((index, entry.name.clone()));
                    Member::Scope(self.collect(inner, deeper, around, own.or(inherited).map(|ts| ts.0)))
                }
            };
            self.scopes[index].members.push(member);
        }
        index
    }

    fn check_name(&mut self, diagram: &Diagram, entry: &Entry, k: usize, path: &[String]) {
        let name = &entry.name;
        let spot = || Spot::Entry(name.clone());
        let good = |c: char| c.is_alphanumeric() || matches!(c, '_' | '-');
        if name.is_empty() || !name.chars().all(good) {
            self.problem(
                path,
                spot(),
                format!("`{name}` is no name of a block"),
                "names have letters, digits, `_`, `-`",
            );
        }
        if name == WORLD {
            self.problem(path, spot(), "`world` is the world itself", "give the block another name");
        }
        if diagram.entries[..k].iter().any(|e| e.name == *name) {
            self.problem(path, spot(), format!("there are two blocks `{name}`"), "rename one of them");
        }
        if diagram.inputs.iter().chain(&diagram.outputs).any(|port| port == name) {
            let message = format!("`{name}` is a port of the diagram and a block in it");
            self.problem(path, spot(), message, "rename the block");
        }
    }

    fn node(
        &mut self,
        path: &[String],
        entry: &Entry,
        template: &dyn Template,
        sample_time: Option<(f64, bool)>,
        place: Place,
    ) -> usize {
        let ports = template.ports();
        let mut whole = path.to_vec();
        whole.push(entry.name.clone());
        self.flat.nodes.push(FlatNode {
            path: whole.join("/"),
            place,
            template: Some(template.boxed_clone()),
            sample_time,
            unit: entry.unit.clone(),
            inputs: Vec::new(),
            in_widths: vec![None; ports.inputs.len()],
            out_widths: vec![None; ports.outputs.len()],
            in_units: Vec::new(),
            out_units: Vec::new(),
            input_names: ports.inputs,
            output_names: ports.outputs,
        });
        self.flat.nodes.len() - 1
    }

    /// Connects every input of every block, and the world's commands.
    fn connect(&mut self, root: usize) {
        for scope in 0..self.scopes.len() {
            self.check_wires(scope);
        }
        if !self.problems.is_empty() {
            return;
        }
        for scope in 0..self.scopes.len() {
            for k in 0..self.scopes[scope].members.len() {
                if let Member::Node(node) = self.scopes[scope].members[k] {
                    self.connect_block(scope, k, node);
                }
            }
        }
        self.connect_world(root);
    }

    fn connect_block(&mut self, scope: usize, entry: usize, node: usize) {
        let name = self.scopes[scope].diagram.entries[entry].name.clone();
        for port in 0..self.flat.nodes[node].input_names.len() {
            let port_name = self.flat.nodes[node].input_names[port].clone();
            match self.wire_into(scope, &name, &port_name) {
                Some(wire) => {
                    if let Some(input) = self.gather(scope, wire, 0) {
                        self.flat.nodes[node].inputs.push(input);
                    }
                }
                None => {
                    let path = self.scopes[scope].path.clone();
                    let whole = if self.flat.nodes[node].input_names.len() == 1 {
                        format!("the input of `{name}` is not connected")
                    } else {
                        format!("the input `{port_name}` of `{name}` is not connected")
                    };
                    let target = self.flat.input_name(node, port);
                    let short = target.rsplit('/').next().unwrap_or(&target).to_owned();
                    self.problem(&path, Spot::Entry(name.clone()), whole, format!("add a wire \"… -> {short}\""));
                }
            }
        }
    }

    fn connect_world(&mut self, root: usize) {
        let diagram = self.scopes[root].diagram;
        for (k, wire) in diagram.wires.iter().enumerate() {
            if wire.to.block != WORLD {
                continue;
            }
            let Some(terminal) = find(&self.interface.commands, &wire.to.port) else { continue };
            let Some(input) = self.gather(root, k, 0) else { continue };
            let Terminal { names, width, unit, .. } = self.interface.commands[terminal].clone();
            let world = &mut self.flat.nodes[LATE];
            world.inputs.push(input);
            world.input_names.push(names[0].clone());
            world.in_widths.push(Some(width));
            world.in_units.push(unit);
            self.flat.commands.push(terminal);
        }
    }

    /// Number of the wire into a port.
    fn wire_into(&self, scope: usize, block: &str, port: &str) -> Option<usize> {
        let only = |names: &[String]| names.len() == 1 && names[0] == port;
        let single = self.target_ports(scope, block).is_some_and(|names| only(&names));
        self.scopes[scope]
            .diagram
            .wires
            .iter()
            .position(|w| w.to.block == block && (w.to.port == port || (w.to.port.is_empty() && single)))
    }

    /// Input ports of an entry.
    fn target_ports(&self, scope: usize, block: &str) -> Option<Vec<String>> {
        let k = self.scopes[scope].diagram.entries.iter().position(|e| e.name == block)?;
        Some(match self.scopes[scope].members[k] {
            Member::Node(node) => self.flat.nodes[node].input_names.clone(),
            Member::Scope(inner) => self.scopes[inner].diagram.inputs.clone(),
        })
    }

    /// Output ports of an entry.
    fn source_ports(&self, scope: usize, block: &str) -> Option<Vec<String>> {
        let k = self.scopes[scope].diagram.entries.iter().position(|e| e.name == block)?;
        Some(match self.scopes[scope].members[k] {
            Member::Node(node) => self.flat.nodes[node].output_names.clone(),
            Member::Scope(inner) => self.scopes[inner].diagram.outputs.clone(),
        })
    }

    /// Looks at both ends of all wires of a diagram, and at the ports of the diagram itself.
    fn check_wires(&mut self, scope: usize) {
        let diagram = self.scopes[scope].diagram;
        let path = self.scopes[scope].path.clone();
        for k in 0..diagram.wires.len() {
            for end in &diagram.wires[k].from {
                self.check_source(scope, k, end);
            }
            self.check_target(scope, k);
        }
        for port in &diagram.outputs {
            if !diagram.wires.iter().any(|w| w.to.block == *port && w.to.port.is_empty()) {
                let message = format!("the output `{port}` of the diagram is not connected");
                self.problem(&path, Spot::Port(port.clone()), message, format!("add a wire \"… -> {port}\""));
            }
        }
        // an inner diagram's inputs are connected in the diagram around it
        for entry in diagram.entries.iter().filter(|e| matches!(e.what, What::Diagram(..))) {
            for port in self.target_ports(scope, &entry.name).unwrap_or_default() {
                if self.wire_into(scope, &entry.name, &port).is_none() {
                    let message = format!("the input `{port}` of `{}` is not connected", entry.name);
                    let help = format!("add a wire \"… -> {}.{port}\"", entry.name);
                    self.problem(&path, Spot::Entry(entry.name.clone()), message, help);
                }
            }
        }
    }

    fn check_source(&mut self, scope: usize, wire: usize, end: &Endpoint) {
        let diagram = self.scopes[scope].diagram;
        let path = self.scopes[scope].path.clone();
        let spot = Spot::From(wire);
        if end.block == WORLD {
            let names = self.interface.measurements.iter().flat_map(|t| t.names.iter().map(String::as_str));
            if !path.is_empty() {
                let help = "bring the signal in through a port: inputs = [\"…\"]";
                self.problem(&path, spot, format!("`{end}`: an inner diagram does not see the world"), help);
            } else if find(&self.interface.measurements, &end.port).is_none() {
                let help = suggest::help(&end.port, names, "the world has no such signal; `sincro check` lists them");
                self.problem(&path, spot, format!("the world has no signal `{}`", end.port), help);
            }
            return;
        }
        if diagram.inputs.contains(&end.block) && end.port.is_empty() {
            return;
        }
        match self.source_ports(scope, &end.block) {
            None => self.unknown_block(scope, spot, &end.block, &diagram.inputs),
            Some(ports) => self.check_port(&path, spot, end, &ports, "output"),
        }
    }

    fn check_target(&mut self, scope: usize, k: usize) {
        let diagram = self.scopes[scope].diagram;
        let path = self.scopes[scope].path.clone();
        let end = &diagram.wires[k].to;
        let spot = Spot::To(k);
        if end.range.is_some() {
            let help = "a wire fills a whole port; choose components where it begins";
            return self.problem(&path, spot, format!("`{end}` is a part of a port"), help);
        }
        if end.block == WORLD {
            let names = self.interface.commands.iter().flat_map(|t| t.names.iter().map(String::as_str));
            if !path.is_empty() {
                let help = "lead the signal out through a port: outputs = [\"…\"]";
                self.problem(&path, spot, format!("`{end}`: an inner diagram does not see the world"), help);
            } else if find(&self.interface.commands, &end.port).is_none() {
                let help = suggest::help(&end.port, names, "the scene has no motor that takes commands");
                self.problem(&path, spot, format!("the world takes no `{}`", end.port), help);
            } else {
                self.check_single(scope, k);
            }
            return;
        }
        if diagram.outputs.contains(&end.block) && end.port.is_empty() {
            return self.check_single(scope, k);
        }
        match self.target_ports(scope, &end.block) {
            None => self.unknown_block(scope, spot, &end.block, &diagram.outputs),
            Some(ports) => {
                let before = self.problems.len();
                self.check_port(&path, spot, end, &ports, "input");
                if self.problems.len() == before {
                    self.check_single(scope, k);
                }
            }
        }
    }

    /// A port takes one wire.
    fn check_single(&mut self, scope: usize, k: usize) {
        let diagram = self.scopes[scope].diagram;
        let end = &diagram.wires[k].to;
        let same = |other: &Endpoint| -> bool {
            if end.block == WORLD && other.block == WORLD {
                let terminal = |e: &Endpoint| find(&self.interface.commands, &e.port);
                return terminal(end) == terminal(other);
            }
            other.block == end.block && (other.port == end.port || other.port.is_empty() || end.port.is_empty())
        };
        if let Some(first) = diagram.wires[..k].iter().position(|w| same(&w.to)) {
            let first = diagram.wires[first].from.iter().map(ToString::to_string).collect::<Vec<_>>().join(", ");
            let path = self.scopes[scope].path.clone();
            let message = format!("two wires go into `{end}`; the other comes from `{first}`");
            self.problem(&path, Spot::To(k), message, "add the signals in a `sum`, or choose in a `switch`");
        }
    }

    fn unknown_block(&mut self, scope: usize, spot: Spot, name: &str, ports: &[String]) {
        let path = self.scopes[scope].path.clone();
        let entries = &self.scopes[scope].diagram.entries;
        let names = entries.iter().map(|e| e.name.as_str()).chain(ports.iter().map(String::as_str));
        let fallback = "declare it, or write `/…` for a signal of the world";
        let help = suggest::help(name, names, fallback);
        self.problem(&path, spot, format!("there is no block `{name}`"), help);
    }

    fn check_port(&mut self, path: &[String], spot: Spot, end: &Endpoint, ports: &[String], word: &str) {
        let whole = |port: &String| format!("{}.{port}", end.block);
        if end.port.is_empty() {
            if ports.len() != 1 {
                let (message, help) = if ports.is_empty() {
                    (format!("`{}` has no {word}", end.block), "remove the wire, or use another block".to_owned())
                } else {
                    let message = format!("`{}` has {} {word}s", end.block, ports.len());
                    (message, format!("say which: {}", listed(ports.iter().map(whole))))
                };
                self.problem(path, spot, message, help);
            }
        } else if !ports.contains(&end.port) {
            let all = if ports.is_empty() { "it has none".into() } else { format!("it has {}", listed(ports)) };
            let help = suggest::help(&end.port, ports.iter().map(String::as_str), &all);
            self.problem(path, spot, format!("`{}` has no {word} `{}`", end.block, end.port), help);
        }
    }

    /// Where a wire's numbers come from; several sources are put together by a block of their own.
    fn gather(&mut self, scope: usize, wire: usize, depth: usize) -> Option<Input> {
        let ends = &self.scopes[scope].diagram.wires[wire].from;
        if let [end] = &ends[..] {
            return self.resolve(scope, wire, end, depth);
        }
        let path = self.scopes[scope].path.clone();
        let target = self.scopes[scope].diagram.wires[wire].to.to_string();
        let mux = Mux::new(ends.len());
        let name = format!("[{target}]");
        let entry = Entry { name, what: What::Block(Box::new(mux.clone())), sample_time: None, unit: None };
        let place = Place { diagram: path.clone(), what: Spot::From(wire) };
        let node = self.node(&path, &entry, &mux, None, place.clone());
        for end in ends {
            let input = self.resolve(scope, wire, end, depth)?;
            self.flat.nodes[node].inputs.push(input);
        }
        Some(Input { node, port: 0, range: None, place })
    }

    /// The output that an endpoint stands for, through however many ports of diagrams.
    fn resolve(&mut self, scope: usize, wire: usize, end: &Endpoint, depth: usize) -> Option<Input> {
        let path = self.scopes[scope].path.clone();
        let place = Place { diagram: path.clone(), what: Spot::From(wire) };
        if depth > 1000 {
            let help = "put a block between the ports";
            self.problem(&path, Spot::From(wire), "ports lead from one to the next in a circle", help);
            return None;
        }
        if end.block == WORLD {
            let (node, port) = self.world_port(&end.port)?;
            return Some(Input { node, port, range: end.range.clone(), place });
        }
        let diagram = self.scopes[scope].diagram;
        if diagram.inputs.contains(&end.block) && end.port.is_empty() {
            let Some((around, name)) = self.scopes[scope].parent.clone() else {
                let message = format!("`{}` is an input of the outermost diagram", end.block);
                self.problem(&path, Spot::From(wire), message, "only inner diagrams have ports");
                return None;
            };
            let outer = self.wire_into(around, &name, &end.block)?;
            let input = self.gather(around, outer, depth + 1)?;
            return Some(self.narrowed(input, end.range.clone(), place));
        }
        let k = diagram.entries.iter().position(|e| e.name == end.block)?;
        match self.scopes[scope].members[k] {
            Member::Node(node) => {
                let names = &self.flat.nodes[node].output_names;
                let port = if end.port.is_empty() { 0 } else { names.iter().position(|n| *n == end.port)? };
                Some(Input { node, port, range: end.range.clone(), place })
            }
            Member::Scope(inner) => {
                let inside = self.scopes[inner].diagram;
                let port = if end.port.is_empty() { inside.outputs.first()? } else { &end.port };
                let wire = inside.wires.iter().position(|w| w.to.block == *port && w.to.port.is_empty())?;
                let input = self.gather(inner, wire, depth + 1)?;
                Some(self.narrowed(input, end.range.clone(), place))
            }
        }
    }

    /// Components of what may itself be components.
    fn narrowed(&mut self, input: Input, range: Option<Range<usize>>, place: Place) -> Input {
        let range = match (input.range, range) {
            (None, range) | (range, None) => range,
            // a range beyond the first is found out by the widths
            (Some(whole), Some(part)) => Some(whole.start + part.start..whole.start + part.end),
        };
        Input { node: input.node, port: input.port, range, place }
    }

    /// The node and port of a measurement, which is in use from now on.
    fn world_port(&mut self, name: &str) -> Option<(usize, usize)> {
        let terminal = find(&self.interface.measurements, name)?;
        let Terminal { names, width, unit, is_special } = &self.interface.measurements[terminal];
        let node = usize::from(*is_special);
        if let Some(port) = self.flat.measurements[node].iter().position(|t| *t == terminal) {
            return Some((node, port));
        }
        self.flat.measurements[node].push(terminal);
        let world = &mut self.flat.nodes[node];
        world.output_names.push(names[0].clone());
        world.out_widths.push(Some(*width));
        world.out_units.push(unit.clone());
        Some((node, world.output_names.len() - 1))
    }
}

/// Number of the terminal of a name.
fn find(terminals: &[Terminal], name: &str) -> Option<usize> {
    terminals.iter().position(|t| t.names.iter().any(|n| n == name))
}
