//! Flattening of inner diagrams: every block gets a path, every input the outputs that reach it, through however many
//! ports.

use std::collections::BTreeMap;

use super::{Diagnostic, Element, Flat, FlatNode, Input, Interface, LATE, Place, Terminal, listed};
use crate::diagram::{Content, Diagram, Entry};
use crate::endpoint::{Endpoint, WORLD};
use crate::instance::DynBlock;
use crate::library::routing::Mux;
use crate::suggest;

pub(super) fn flatten(diagram: &Diagram, interface: &Interface) -> Result<Flat, Vec<Diagnostic>> {
    let world = |n: usize| FlatNode {
        path: WORLD.into(),
        place: Place { diagram: Vec::new(), element: Element::Entry(WORLD.into()) },
        template: None,
        sample_time: None,
        unit: Vec::new(),
        inputs: Vec::new(),
        input_names: Vec::new(),
        output_names: Vec::new(),
        in_widths: Vec::with_capacity(n),
        out_widths: Vec::new(),
        in_units: Vec::new(),
        out_units: Vec::new(),
        component_units: Vec::new(),
    };
    let flat = Flat {
        nodes: vec![world(0), world(0)],
        measurements: [Vec::new(), Vec::new()],
        commands: Vec::new(),
        aliases: Vec::new(),
    };
    let mut work = Flattening {
        measurements: by_name(&interface.measurements),
        commands: by_name(&interface.commands),
        in_use: BTreeMap::new(),
        interface,
        flat,
        scopes: Vec::new(),
        problems: Vec::new(),
    };
    let root = work.collect(diagram, Vec::new(), None, None);
    if work.problems.is_empty() {
        work.connect(root);
    }
    if work.problems.is_empty() { Ok(work.flat) } else { Err(work.problems) }
}

/// Most blocks of a diagram with all that is inside it: definitions that use definitions grow fast.
const MAX_BLOCKS: usize = 100_000;

/// A diagram in its place.
struct Scope<'a> {
    diagram: &'a Diagram,
    path: Vec<String>,
    /// The scope around it and its name there.
    parent: Option<(usize, String)>,
    /// By entry: the node, or the scope of an inner diagram.
    members: Vec<Member>,
    /// Number of the first entry of each name.
    entries: BTreeMap<&'a str, usize>,
    /// Number of the first wire into each block and port, as they are written.
    wires_into: BTreeMap<(&'a str, &'a str), usize>,
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
    problems: Vec<Diagnostic>,
    /// Terminals of the interface by name.
    measurements: BTreeMap<&'a str, usize>,
    commands: BTreeMap<&'a str, usize>,
    /// Node and port of the measurements in use, by terminal.
    in_use: BTreeMap<usize, (usize, usize)>,
}

impl<'a> Flattening<'a> {
    fn problem(&mut self, path: &[String], element: Element, message: impl Into<String>, help: impl Into<String>) {
        let place = Place { diagram: path.to_vec(), element };
        self.problems.push(Diagnostic { place, message: message.into(), help: help.into() });
    }

    /// Returns true while similar names are still looked for: after many problems that would only take time.
    fn helps(&self) -> bool {
        self.problems.len() < 100
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
        let (mut entries, mut wires_into) = (BTreeMap::new(), BTreeMap::new());
        for (k, entry) in diagram.entries.iter().enumerate() {
            entries.entry(entry.name.as_str()).or_insert(k);
        }
        for (k, wire) in diagram.wires.iter().enumerate() {
            wires_into.entry((wire.to.block.as_str(), wire.to.port.as_str())).or_insert(k);
        }
        self.scopes.push(Scope { diagram, path: path.clone(), parent, members: Vec::new(), entries, wires_into });
        self.check_ports(index);
        for (k, entry) in diagram.entries.iter().enumerate() {
            if self.flat.nodes.len() > MAX_BLOCKS {
                let message = format!("the diagram has more than {MAX_BLOCKS} blocks");
                // said once, where the limit was passed
                if self.problems.iter().all(|p| p.message != message) {
                    let help = "count what the definitions inside definitions come to";
                    self.problem(&path, Element::Entry(entry.name.clone()), message, help);
                }
                break;
            }
            self.check_name(index, entry, k);
            let (own, inherited) = (entry.sample_time.map(|ts| (ts, false)), sample_time.map(|ts| (ts, true)));
            let member = match &entry.content {
                Content::Block(template) => {
                    let place = Place { diagram: path.clone(), element: Element::Entry(entry.name.clone()) };
                    Member::Node(self.node(&path, entry, template.as_ref(), own.or(inherited), place))
                }
                Content::Diagram(_, inner) => {
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

    /// Names of the ports of a diagram.
    fn check_ports(&mut self, scope: usize) {
        let diagram = self.scopes[scope].diagram;
        let path = self.scopes[scope].path.clone();
        for (list, word) in [(&diagram.inputs, "inputs"), (&diagram.outputs, "outputs")] {
            for (k, port) in list.iter().enumerate() {
                let spot = Element::Port(port.clone());
                if !is_name(port) || port == WORLD {
                    let message = format!("`{port}` is no name of a port");
                    self.problem(
                        &path,
                        spot,
                        message,
                        "names have letters, digits, `_`, `-`; `world` is the world itself",
                    );
                } else if list[..k].contains(port) {
                    self.problem(&path, spot, format!("there are two {word} `{port}`"), "rename one of them");
                }
            }
        }
    }

    fn check_name(&mut self, scope: usize, entry: &Entry, k: usize) {
        let diagram = self.scopes[scope].diagram;
        let path = &self.scopes[scope].path.clone();
        let name = &entry.name;
        let spot = || Element::Entry(name.clone());
        if !is_name(name) {
            let help = "names have letters, digits, `_`, `-`";
            self.problem(path, spot(), format!("`{name}` is no name of a block"), help);
        }
        if name == WORLD {
            self.problem(path, spot(), "`world` is the world itself", "give the block another name");
        }
        if self.scopes[scope].entries.get(name.as_str()).is_some_and(|first| *first < k) {
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
        template: &dyn DynBlock,
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
            component_units: Vec::new(),
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
        if self.problems.is_empty() {
            for scope in 0..self.scopes.len() {
                self.name_outputs(scope);
            }
        }
    }

    /// The output ports of an inner diagram as names of what they give; a unit that is declared of a diagram is that of
    /// its output.
    fn name_outputs(&mut self, scope: usize) {
        let (diagram, path) = (self.scopes[scope].diagram, self.scopes[scope].path.join("/"));
        let Some((around, name)) = self.scopes[scope].parent.clone() else { return };
        let declared = self.scopes[around].diagram.entry(&name).map_or_else(Vec::new, |entry| entry.unit.clone());
        if !declared.is_empty() && diagram.outputs.len() != 1 {
            let message = format!("`{name}` has {} outputs, its `unit` is that of one", diagram.outputs.len());
            let path = self.scopes[around].path.clone();
            self.problem(&path, Element::Unit(name), message, "declare units of blocks in the diagram");
        }
        for port in &diagram.outputs {
            let wire = diagram.wires.iter().position(|w| w.to.block == *port && w.to.port.is_empty());
            let Some(wire) = wire.filter(|&w| diagram.wires[w].from.len() == 1) else { continue };
            let name = if diagram.outputs.len() == 1 { path.clone() } else { format!("{path}.{port}") };
            if let Some(input) = self.resolve(scope, wire, &diagram.wires[wire].from[0], 0) {
                let node = &mut self.flat.nodes[input.node];
                let is_whole = diagram.outputs.len() == 1 && input.range.is_none();
                if is_whole && node.template.is_some() && node.unit.is_empty() {
                    node.unit.clone_from(&declared);
                }
                self.flat.aliases.push((name, input));
            }
        }
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
                    self.problem(&path, Element::Entry(name.clone()), whole, format!("add a wire \"… -> {short}\""));
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
            let Some(&terminal) = self.commands.get(wire.to.port.as_str()) else { continue };
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
        let is_only = self.target_ports(scope, block).is_some_and(|names| names.len() == 1 && names[0] == port);
        let wires = &self.scopes[scope].wires_into;
        let unnamed = if is_only { wires.get(&(block, "")) } else { None };
        [wires.get(&(block, port)), unnamed].into_iter().flatten().min().copied()
    }

    /// Content of an entry.
    fn member(&self, scope: usize, block: &str) -> Option<Member> {
        let scope = &self.scopes[scope];
        scope.entries.get(block).map(|k| scope.members[*k])
    }

    /// Input ports of an entry.
    fn target_ports(&self, scope: usize, block: &str) -> Option<&[String]> {
        Some(match self.member(scope, block)? {
            Member::Node(node) => &self.flat.nodes[node].input_names,
            Member::Scope(inner) => &self.scopes[inner].diagram.inputs,
        })
    }

    /// Output ports of an entry.
    fn source_ports(&self, scope: usize, block: &str) -> Option<&[String]> {
        Some(match self.member(scope, block)? {
            Member::Node(node) => &self.flat.nodes[node].output_names,
            Member::Scope(inner) => &self.scopes[inner].diagram.outputs,
        })
    }

    /// Looks at both ends of all wires of a diagram, and at the ports of the diagram itself.
    fn check_wires(&mut self, scope: usize) {
        let diagram = self.scopes[scope].diagram;
        let path = self.scopes[scope].path.clone();
        let mut taken = BTreeMap::new();
        for k in 0..diagram.wires.len() {
            for end in &diagram.wires[k].from {
                self.check_source(scope, k, end);
            }
            if self.check_target(scope, k) {
                self.check_single(scope, k, &mut taken);
            }
        }
        for port in &diagram.outputs {
            if !self.scopes[scope].wires_into.contains_key(&(port.as_str(), "")) {
                let message = format!("the output `{port}` of the diagram is not connected");
                self.problem(&path, Element::Port(port.clone()), message, format!("add a wire \"… -> {port}\""));
            }
        }
        // an inner diagram's inputs are connected in the diagram around it
        for entry in diagram.entries.iter().filter(|e| matches!(e.content, Content::Diagram(..))) {
            for port in self.target_ports(scope, &entry.name).unwrap_or_default().to_vec() {
                if self.wire_into(scope, &entry.name, &port).is_none() {
                    let message = format!("the input `{port}` of `{}` is not connected", entry.name);
                    let help = format!("add a wire \"… -> {}.{port}\"", entry.name);
                    self.problem(&path, Element::Entry(entry.name.clone()), message, help);
                }
            }
        }
    }

    fn check_source(&mut self, scope: usize, wire: usize, end: &Endpoint) {
        let diagram = self.scopes[scope].diagram;
        let path = self.scopes[scope].path.clone();
        let spot = Element::From(wire);
        if end.block == WORLD {
            if !path.is_empty() {
                let help = "bring the signal in through a port: inputs = [\"…\"]";
                self.problem(&path, spot, format!("`{end}`: an inner diagram does not see the world"), help);
            } else if end.port.is_empty() {
                let help = "say which of its signals: `/joint.position`, `/body.position`, `world.q`, `world.v` …";
                self.problem(&path, spot, "`world` is all signals of the world", help);
            } else if let Some(terminal) = self.measurements.get(end.port.as_str()) {
                if self.interface.measurements[*terminal].width == 0 {
                    let help = "the scene has no joint that moves";
                    self.problem(&path, spot, format!("`{end}` has no components"), help);
                }
            } else {
                let help = self.measurements_like(&end.port);
                self.problem(&path, spot, format!("the world has no signal `{}`", end.port), help);
            }
            return;
        }
        if diagram.inputs.contains(&end.block) && end.port.is_empty() {
            return;
        }
        match self.source_ports(scope, &end.block) {
            None => self.unknown_block(scope, spot, end, &diagram.inputs, &diagram.outputs),
            Some(ports) => {
                if let Some((message, help)) = misnamed_port(end, ports, "output", self.helps()) {
                    self.problem(&path, spot, message, help);
                }
            }
        }
    }

    /// Help for a measurement that is not there.
    fn measurements_like(&self, name: &str) -> String {
        let of_it = format!("{name}.");
        let names = self.measurements.keys().copied();
        let own: Vec<&str> = names.clone().filter(|known| known.starts_with(&of_it)).collect();
        match own.len() {
            0 => suggest::help(name, names, "`sincro check --signals` lists what can be measured"),
            1..=8 => format!("it has {}", listed(own)),
            n => format!("it has {} and {} more", listed(&own[..8]).replace(" and ", ", "), n - 8),
        }
    }

    /// Returns true if a wire ends at a port that there is.
    fn check_target(&mut self, scope: usize, k: usize) -> bool {
        let diagram = self.scopes[scope].diagram;
        let path = self.scopes[scope].path.clone();
        let end = &diagram.wires[k].to;
        let spot = Element::To(k);
        let before = self.problems.len();
        if end.range.is_some() {
            let help = "a wire fills a whole port; choose components where it begins";
            self.problem(&path, spot, format!("`{end}` is a part of a port"), help);
        } else if end.block == WORLD {
            self.check_command(&path, spot, end);
        } else if diagram.outputs.contains(&end.block) && end.port.is_empty() {
            return true;
        } else {
            match self.target_ports(scope, &end.block) {
                None => self.unknown_block(scope, spot, end, &diagram.outputs, &diagram.inputs),
                Some(ports) => {
                    if let Some((message, help)) = misnamed_port(end, ports, "input", self.helps()) {
                        self.problem(&path, spot, message, help);
                    }
                }
            }
        }
        self.problems.len() == before
    }

    fn check_command(&mut self, path: &[String], spot: Element, end: &Endpoint) {
        if !path.is_empty() {
            let help = "lead the signal out through a port: outputs = [\"…\"]";
            self.problem(path, spot, format!("`{end}`: an inner diagram does not see the world"), help);
        } else if !self.commands.contains_key(end.port.as_str()) {
            let joint = end.port.strip_suffix(".command").unwrap_or(&end.port);
            let is_joint = self.measurements.contains_key(format!("{joint}.motor_torque").as_str());
            let is_there = ["position", "velocity", "position.x", "quaternion.w", "position.1"]
                .iter()
                .any(|quantity| self.measurements.contains_key(format!("{joint}.{quantity}").as_str()));
            let all: Vec<&str> =
                self.interface.commands.iter().filter_map(|t| t.names.first()).map(String::as_str).collect();
            let otherwise = match &all[..] {
                [] => {
                    "the scene has no motor that takes commands: give a joint motor = { mode = \"torque\" }".to_owned()
                }
                _ => format!("commands go to the joints with a motor: {}", listed(all)),
            };
            let (message, help) = match (is_joint, is_there) {
                (true, _) => (format!("the motor of `{joint}` is free and takes no command"), otherwise),
                (_, true) => (format!("`{joint}` has no motor that takes commands"), otherwise),
                _ => {
                    let help = suggest::help(&end.port, self.commands.keys().copied(), &otherwise);
                    (format!("the world takes no command `{end}`"), help)
                }
            };
            self.problem(path, spot, message, help);
        }
    }

    /// A port takes one wire; `taken` are the wires into the ports so far.
    fn check_single(&mut self, scope: usize, k: usize, taken: &mut BTreeMap<(&'a str, String), usize>) {
        let diagram = self.scopes[scope].diagram;
        let end = &diagram.wires[k].to;
        let port = match self.target_ports(scope, &end.block) {
            _ if end.block == WORLD => self.commands[end.port.as_str()].to_string(),
            Some([only]) => only.clone(),
            _ => end.port.clone(),
        };
        let first = *taken.entry((&end.block, port)).or_insert(k);
        if first != k {
            let ends = diagram.wires[first].from.iter().map(ToString::to_string).collect::<Vec<_>>();
            let path = self.scopes[scope].path.clone();
            let message = format!("two wires go into `{end}`; the other comes from `{}`", ends.join(", "));
            self.problem(&path, Element::To(k), message, "add the signals in a `sum`, or choose in a `switch`");
        }
    }

    /// `ports` are those of the diagram that a wire may have here, `others` those at its other side.
    fn unknown_block(&mut self, scope: usize, spot: Element, end: &Endpoint, ports: &[String], others: &[String]) {
        let (path, name) = (self.scopes[scope].path.clone(), &end.block);
        let (message, help) = if ports.contains(name) {
            let message = format!("`{name}` is a port of the diagram and has no port `{}` of its own", end.port);
            (message, format!("write `{name}`"))
        } else if others.contains(name) {
            let is_source = matches!(spot, Element::From(_));
            let (what, does) = if is_source { ("output", "ends") } else { ("input", "begins") };
            (format!("`{name}` is an {what} of the diagram"), format!("a wire {does} there: turn it round"))
        } else {
            let entries = &self.scopes[scope].diagram.entries;
            let names = entries.iter().map(|e| e.name.as_str()).chain(ports.iter().map(String::as_str));
            let known: Vec<&str> = names.clone().take(9).collect();
            let otherwise = match known.len() {
                1..=8 => format!("the diagram has {}; `/…` is a signal of the world", listed(known)),
                _ => "declare it, or write `/…` for a signal of the world".into(),
            };
            let near = names.take(if self.helps() { usize::MAX } else { 0 });
            (format!("there is no block `{name}`"), suggest::help(name, near, &otherwise))
        };
        self.problem(&path, spot, message, help);
    }

    /// Source of a wire's numbers; several are put together by a block of their own.
    fn gather(&mut self, scope: usize, wire: usize, depth: usize) -> Option<Input> {
        let ends = &self.scopes[scope].diagram.wires[wire].from;
        if let [end] = &ends[..] {
            return self.resolve(scope, wire, end, depth);
        }
        let path = self.scopes[scope].path.clone();
        if self.flat.nodes.len() > MAX_BLOCKS {
            let message = format!("the diagram has more than {MAX_BLOCKS} blocks");
            let help = "each `[a, b]` in a wire is one, also those that lead through ports";
            self.problem(&path, Element::From(wire), message, help);
            return None;
        }
        let target = self.scopes[scope].diagram.wires[wire].to.to_string();
        let mux = Mux::new(ends.len());
        let name = format!("[{target}]");
        let entry = Entry { name, content: Content::Block(Box::new(mux.clone())), sample_time: None, unit: Vec::new() };
        let place = Place { diagram: path.clone(), element: Element::From(wire) };
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
        let place = Place { diagram: path.clone(), element: Element::From(wire) };
        if depth > 1000 {
            let help = "put a block between the ports";
            self.problem(&path, Element::From(wire), "ports lead from one to the next in a circle", help);
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
                self.problem(&path, Element::From(wire), message, "only inner diagrams have ports");
                return None;
            };
            let outer = self.wire_into(around, &name, &end.block)?;
            let input = self.gather(around, outer, depth + 1)?;
            return self.narrowed(input, end, place);
        }
        match self.member(scope, &end.block)? {
            Member::Node(node) => {
                let names = &self.flat.nodes[node].output_names;
                let port = if end.port.is_empty() { 0 } else { names.iter().position(|n| *n == end.port)? };
                Some(Input { node, port, range: end.range.clone(), place })
            }
            Member::Scope(inner) => {
                let inside = self.scopes[inner].diagram;
                let port = if end.port.is_empty() { inside.outputs.first()? } else { &end.port };
                let wire = *self.scopes[inner].wires_into.get(&(port.as_str(), ""))?;
                let input = self.gather(inner, wire, depth + 1)?;
                self.narrowed(input, end, place)
            }
        }
    }

    /// Components of what may itself be components.
    fn narrowed(&mut self, input: Input, end: &Endpoint, place: Place) -> Option<Input> {
        let range = match (input.range, end.range.clone()) {
            (None, range) | (range, None) => range,
            (Some(whole), Some(part)) if part.end > whole.len() => {
                let name = Endpoint { range: None, ..end.clone() };
                self.problems.push(super::widths::beyond(&name.to_string(), whole.len(), &part, place));
                return None;
            }
            (Some(whole), Some(part)) => Some(whole.start + part.start..whole.start + part.end),
        };
        Some(Input { node: input.node, port: input.port, range, place })
    }

    /// The node and port of a measurement, which is in use from now on.
    fn world_port(&mut self, name: &str) -> Option<(usize, usize)> {
        let terminal = *self.measurements.get(name)?;
        if let Some(found) = self.in_use.get(&terminal) {
            return Some(*found);
        }
        let Terminal { names, width, unit, is_special } = &self.interface.measurements[terminal];
        let node = usize::from(*is_special);
        self.flat.measurements[node].push(terminal);
        let world = &mut self.flat.nodes[node];
        world.output_names.push(names[0].clone());
        world.out_widths.push(Some(*width));
        world.out_units.push(unit.clone());
        let found = (node, world.output_names.len() - 1);
        self.in_use.insert(terminal, found);
        Some(found)
    }
}

/// Error of an end of a wire that names no port of its block, and a help.
fn misnamed_port(end: &Endpoint, ports: &[String], word: &str, helps: bool) -> Option<(String, String)> {
    let block = &end.block;
    if end.port.is_empty() {
        return match ports.len() {
            1 => None,
            0 => Some((format!("`{block}` has no {word}"), "remove the wire, or use another block".into())),
            n => {
                let all = listed(ports.iter().map(|port| format!("{block}.{port}")));
                Some((format!("`{block}` has {n} {word}s"), format!("say which: {all}")))
            }
        };
    }
    if ports.contains(&end.port) {
        return None;
    }
    let all = if ports.is_empty() { "it has none".into() } else { format!("it has {}", listed(ports)) };
    let near = ports.iter().map(String::as_str).take(if helps { usize::MAX } else { 0 });
    let help = suggest::help(&end.port, near, &all);
    Some((format!("`{block}` has no {word} `{}`", end.port), help))
}

fn is_name(text: &str) -> bool {
    !text.is_empty() && text.chars().all(|c| c.is_alphanumeric() || matches!(c, '_' | '-'))
}

/// Numbers of terminals by their names; the first of a name stands.
fn by_name(terminals: &[Terminal]) -> BTreeMap<&str, usize> {
    let all = terminals.iter().enumerate().rev();
    all.flat_map(|(k, terminal)| terminal.names.iter().map(move |name| (name.as_str(), k))).collect()
}
