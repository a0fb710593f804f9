//! Texts of the exported files: header, source, description.

use core::fmt::Write;

use sincro_blocks::program::{Program as Diagram, Rate};
use sincro_dynamics::world::MethodKind;
use sincro_math::record::{Operation, Program};

use super::Request;
use super::names::{self, Named, comment_text, identifiers};
use super::parts::{Function, Parts};
use crate::c::{Dialect, number, scalar_support, statements};
use crate::diagram::{ByTick, CompiledBlock, CompiledDiagram, Computed};

/// Fields of the plant's structure in C, with their numbers; those without any are left out.
fn fields(request: &Request<'_>) -> Vec<(&'static str, &'static str, Vec<Named>)> {
    let [q, v, elements, commands] = names::of_state(request.model);
    [
        ("q", "coordinates", q),
        ("v", "velocities", v),
        ("elements", "states of rotors, windings and activations", elements),
        ("commands", "commands of motors, forces and rotors", commands),
    ]
    .into_iter()
    .filter(|(_, _, numbers)| !numbers.is_empty())
    .collect()
}

fn described(named: &Named) -> String {
    match named.unit.as_str() {
        "" | "1" => comment_text(&named.name),
        unit => comment_text(&format!("{} [{unit}]", named.name)),
    }
}

/// Enumeration of the indices of a list; a comment for an empty one, which C has no enumeration for.
fn enumeration(prefix: &str, list: impl Iterator<Item = (usize, String, String)>) -> String {
    let list: Vec<(usize, String, String)> = list.collect();
    if list.is_empty() {
        return String::from("/* none */\n");
    }
    let names = identifiers(list.iter().map(|(_, name, _)| name.as_str()));
    let mut text = String::from("enum {\n");
    for ((index, _, comment), name) in list.iter().zip(&names) {
        _ = writeln!(text, "    {prefix}_{name} = {index}, /* {comment} */");
    }
    text + "};\n"
}

pub(super) fn header(request: &Request<'_>, parts: &Parts) -> String {
    let (name, upper) = (request.name, request.name.to_uppercase());
    let mut text = format!(
        "/* {}\n   Written by sincro {}. SI units: angles in rad, lengths in m. C99 and C++, without any library. */\n#ifndef {upper}_H\n#define {upper}_H\n\n#ifdef __cplusplus\nextern \"C\" {{\n#endif\n",
        comment_text(request.title),
        env!("CARGO_PKG_VERSION")
    );
    let fields = fields(request);
    _ = writeln!(text, "\n/* ---- plant ---- */\n");
    for (field, what, numbers) in &fields {
        _ = writeln!(text, "/* {what} */\n#define {upper}_N_{} {}", field.to_uppercase(), numbers.len());
        let prefix = format!("{upper}_{}", field.to_uppercase());
        let all = numbers.iter().enumerate().map(|(k, named)| (k, named.name.clone(), described(named)));
        _ = writeln!(text, "{}", enumeration(&prefix, all));
    }
    if parts.step.is_some() {
        _ = writeln!(text, "/* State of the plant, and the commands that it is under. */\ntypedef struct {{");
        for (field, what, _) in &fields {
            _ = writeln!(text, "    double {field}[{upper}_N_{}]; /* {what} */", field.to_uppercase());
        }
        if fields.is_empty() {
            // C has no structure without members
            _ = writeln!(text, "    unsigned char nothing; /* no joint, no state */");
        }
        _ = writeln!(text, "}} {name}_plant;\n");
        _ = writeln!(text, "/* Sets the initial state and the constant commands of the scene. */");
        _ = writeln!(text, "void {name}_plant_init({name}_plant *plant);\n");
        _ = writeln!(text, "/* One step of {} s, {}. */", number(request.h), method_name(request.method));
        _ = writeln!(text, "void {name}_plant_step({name}_plant *plant);\n");
    }
    for function in &parts.functions {
        _ = writeln!(text, "/* {} */\n{};\n", function.comment, signature(name, function));
    }
    if let (Some(of_scene), Some(_)) = (request.diagram, &parts.controller) {
        text += &controller_header(request, of_scene.wiring.program(), parts);
    }
    _ = writeln!(text, "/* ---- self-test ({name}_test.c) ---- */\n");
    _ = writeln!(text, "/* Returns 1 if every bit is as expected: no operation contracted or reordered. */");
    _ = writeln!(text, "int {name}_self_test(void);\n");
    text + "#ifdef __cplusplus\n}\n#endif\n\n#endif\n"
}

fn controller_header(request: &Request<'_>, diagram: &Diagram, parts: &Parts) -> String {
    let (name, upper) = (request.name, request.name.to_uppercase());
    let mut text = String::from("/* ---- controller ---- */\n\n");
    let is_source = |step: usize| {
        let controller = parts.controller.as_ref().expect("there is one");
        controller.blocks.iter().any(|b| b.step == step && matches!(b.output, Computed::Source))
    };
    let measured = request.diagram.into_iter().flat_map(|d| d.wiring.early.iter().chain(&d.wiring.late));
    let catalogue = sincro_scene::record::catalogue(request.model);
    let mut inputs = Vec::new();
    for reading in measured {
        for (k, probe) in reading.probes.iter().enumerate() {
            let entry = catalogue.iter().find(|entry| entry.probe == *probe);
            let named = entry.map_or(Named { name: "measurement".into(), unit: String::new() }, |entry| Named {
                name: entry.name.clone(),
                unit: entry.unit.to_string(),
            });
            inputs.push((reading.at + k, named.name.clone(), described(&named)));
        }
    }
    if !inputs.is_empty() {
        _ = writeln!(text, "/* measurements, to be written before each evaluation: indices in `signals` */");
        text += &enumeration(&format!("{upper}_MEASURED"), inputs.into_iter());
    }
    let component = |path: &str, k: usize, n: usize| if n > 1 { format!("{path}[{k}]") } else { path.to_owned() };
    let sources: Vec<_> = (diagram.steps.iter().enumerate())
        .filter(|(k, _)| is_source(*k))
        .flat_map(|(_, step)| {
            let n = step.out.len();
            step.out.clone().enumerate().map(move |(k, signal)| {
                let path = component(&step.path, k, n);
                (signal, path.clone(), comment_text(&format!("{path} ({})", step.template.kind().name)))
            })
        })
        .collect();
    if !sources.is_empty() {
        _ = writeln!(
            text,
            "\n/* sources of the diagram, to be written before each evaluation: indices in `signals` */"
        );
        text += &enumeration(&format!("{upper}_SOURCE"), sources.into_iter());
    }
    let [.., commands] = names::of_state(request.model);
    let given = diagram.commands.iter().map(|command| {
        let named = &commands[command.terminal];
        (command.signal.start, named.name.clone(), described(named))
    });
    _ = writeln!(text, "\n/* commands, to be read after each evaluation: indices in `signals` */");
    text += &enumeration(&format!("{upper}_COMMANDED"), given);
    _ = writeln!(
        text,
        "\n/* Signals and memory of the controller. */\ntypedef struct {{\n    double signals[{}];",
        diagram.n_signals.max(1)
    );
    if diagram.n_memory > 0 {
        _ = writeln!(text, "    double memory[{}];", diagram.n_memory);
    }
    _ = writeln!(text, "    unsigned long tick; /* base steps of {} s since the start */", number(diagram.step));
    _ = writeln!(text, "}} {name}_controller;\n");
    _ = writeln!(text, "void {name}_controller_init({name}_controller *controller);\n");
    _ = writeln!(
        text,
        "/* Evaluates the blocks that are due at this tick: measurements and sources in, commands out. */\nvoid {name}_controller_evaluate({name}_controller *controller);\n"
    );
    _ = writeln!(
        text,
        "/* Takes what the blocks remember to the next tick, and counts it; once after each evaluation. */\nvoid {name}_controller_update({name}_controller *controller);\n"
    );
    if parts.measure.is_some() && parts.step.is_some() {
        _ = writeln!(
            text,
            "/* ---- lock-step: measure, evaluate; command, update, step ---- */\n\nvoid {name}_measure(const {name}_plant *plant, {name}_controller *controller);\nvoid {name}_command(const {name}_controller *controller, {name}_plant *plant);\n"
        );
    }
    text
}

fn method_name(method: MethodKind) -> &'static str {
    match method {
        MethodKind::SemiImplicitEuler => "semi-implicit Euler",
        MethodKind::Rk4 => "Runge-Kutta of order 4",
        MethodKind::Implicit => "linearly implicit, order 2",
        MethodKind::DormandPrince => "Dormand-Prince",
        MethodKind::DormandPrince8 => "Dormand-Prince of order 8",
        MethodKind::Stiff => "stiff",
    }
}

fn signature(name: &str, function: &Function) -> String {
    let inputs = function.inputs.iter().filter(|(_, n)| *n > 0).map(|(field, n)| format!("const double {field}[{n}]"));
    let outputs = function.outputs.iter().filter(|(_, n)| *n > 0).map(|(field, n)| format!("double {field}[{n}]"));
    let all: Vec<String> = inputs.chain(outputs).collect();
    if all.is_empty() {
        return format!("void {name}_{}(void)", function.name);
    }
    format!("void {name}_{}({})", function.name, all.join(", "))
}

/// Element of one of several arrays that follow each other.
fn element(arrays: &[(String, usize)], mut k: usize) -> String {
    for (array, n) in arrays {
        if k < *n {
            return format!("{array}[{k}]");
        }
        k -= n;
    }
    unreachable!("an index beyond the arrays")
}

pub(super) fn source(request: &Request<'_>, parts: &Parts) -> String {
    let name = request.name;
    let prefix = format!("{name}_");
    let dialect = Dialect::Double { prefix: &prefix };
    let mut text = format!(
        "/* {} See {name}.h.\n   Every operation is rounded by itself: contraction to fused operations must be off. */\n#include <stdint.h>\n#include \"{name}.h\"\n\n#if defined(__clang__)\n#pragma STDC FP_CONTRACT OFF\n#elif defined(__GNUC__)\n#pragma GCC optimize (\"fp-contract=off\", \"no-tree-slp-vectorize\")\n#else\n#pragma STDC FP_CONTRACT OFF\n#endif\n#if defined(__FAST_MATH__)\n#error \"-ffast-math changes results: compile without it\"\n#endif\n\n",
        comment_text(request.title),
    );
    text += &used_support(&prefix, parts);
    let sizes = crate::plant::state_sizes(request.model);
    let of_plant: Vec<(String, usize)> =
        ["q", "v", "elements", "commands"].iter().zip(sizes).map(|(field, n)| (format!("plant->{field}"), n)).collect();
    if let Some(step) = &parts.step {
        text += "\n/* ---- plant ---- */\n";
        let none = if sizes.iter().all(|n| *n == 0) { "    (void)plant;\n" } else { "" };
        let initial = request.initial;
        _ = writeln!(text, "\nvoid {name}_plant_init({name}_plant *plant) {{");
        let commands: Vec<f64> = request.commands.iter().map(|signal| signal.value(0.0)).collect();
        for (field, values) in
            [("q", &initial.q), ("v", &initial.v), ("elements", &initial.rotors), ("commands", &commands)]
        {
            for (k, value) in values.iter().enumerate() {
                _ = writeln!(text, "    plant->{field}[{k}] = {};", number(*value));
            }
        }
        _ = writeln!(text, "{none}}}\n\nvoid {name}_plant_step({name}_plant *plant) {{");
        text += none;
        let at = |k: usize| element(&of_plant, k);
        text += &statements(step, dialect, at, at);
        text += "}\n";
    }
    for function in &parts.functions {
        let arrays = |list: &[(&str, usize)]| -> Vec<(String, usize)> {
            list.iter().map(|(field, n)| ((*field).to_owned(), *n)).collect()
        };
        let (inputs, outputs) = (arrays(&function.inputs), arrays(&function.outputs));
        _ = writeln!(text, "\n{} {{", signature(name, function));
        let program = &function.program;
        text += &unused(&inputs, program);
        let (from, to) = (|k| element(&inputs, k), |k| element(&outputs, k));
        text += &statements(program, dialect, from, to);
        text += "}\n";
    }
    if let (Some(of_scene), Some(controller)) = (request.diagram, &parts.controller) {
        let diagram = of_scene.wiring.program();
        text += &controller_source(name, &prefix, diagram, controller);
        if let (Some((signals, program)), true) = (&parts.measure, parts.step.is_some()) {
            _ = writeln!(
                text,
                "\n/* ---- lock-step ---- */\n\nvoid {name}_measure(const {name}_plant *plant, {name}_controller *controller) {{"
            );
            if signals.is_empty() {
                text += "    (void)plant;\n    (void)controller;\n";
            }
            let at = |k: usize| element(&of_plant, k);
            let to = |k: usize| format!("controller->signals[{}]", signals[k]);
            text += &statements(program, dialect, at, to);
            _ = writeln!(
                text,
                "}}\n\nvoid {name}_command(const {name}_controller *controller, {name}_plant *plant) {{"
            );
            if diagram.commands.is_empty() {
                text += "    (void)controller;\n    (void)plant;\n";
            }
            for command in &diagram.commands {
                _ = writeln!(
                    text,
                    "    plant->commands[{}] = controller->signals[{}];",
                    command.terminal, command.signal.start
                );
            }
            text += "}\n";
        }
    }
    text
}

/// Statements that keep compilers quiet about arguments that a program does not read.
fn unused(inputs: &[(String, usize)], program: &Program) -> String {
    let mut first = 0;
    let mut text = String::new();
    for (name, n) in inputs.iter().filter(|(_, n)| *n > 0) {
        let range = first..first + n;
        let is_read =
            program.operations().iter().any(|x| matches!(x, Operation::Input(k) if range.contains(&(*k as usize))));
        if !is_read {
            _ = writeln!(text, "    (void){name};");
        }
        first = range.end;
    }
    text
}

/// Support, without the functions that nothing calls.
fn used_support(prefix: &str, parts: &Parts) -> String {
    let of_blocks = parts.controller.iter().flat_map(|c| &c.blocks).flat_map(|block| {
        let output = if let Computed::Program(by_tick) = &block.output { Some(by_tick) } else { None };
        output.into_iter().chain(&block.update).flat_map(|b| b.first.iter().chain([&b.later]))
    });
    let programs = (parts.functions.iter().map(|f| &f.program)).chain(&parts.step).chain(of_blocks);
    let programs: Vec<_> = programs.chain(parts.measure.as_ref().map(|(_, program)| program)).collect();
    let uses = |wanted: &dyn Fn(&Operation) -> bool| programs.iter().any(|p| p.operations().iter().any(wanted));
    scalar_support(
        prefix,
        uses(&|x| matches!(x, Operation::Abs(_))),
        uses(&|x| matches!(x, Operation::Sqrt(_))),
        uses(&|x| matches!(x, Operation::Sin(_) | Operation::Cos(_))),
    )
}

fn controller_source(name: &str, prefix: &str, diagram: &Diagram, controller: &CompiledDiagram) -> String {
    let mut text = format!(
        "\n/* ---- controller ---- */\n\nvoid {name}_controller_init({name}_controller *controller) {{\n    int k;\n    for (k = 0; k < {}; k++) controller->signals[k] = 0.0;\n",
        diagram.n_signals
    );
    for (k, value) in controller.signals.iter().enumerate().filter(|(_, x)| x.to_bits() != 0) {
        _ = writeln!(text, "    controller->signals[{k}] = {};", number(*value));
    }
    for (k, value) in controller.memory.iter().enumerate() {
        _ = writeln!(text, "    controller->memory[{k}] = {};", number(*value));
    }
    text += "    controller->tick = 0;\n}\n";
    let n_signals = diagram.n_signals;
    let input = |k: usize| match k.checked_sub(n_signals) {
        None => format!("signals[{k}]"),
        Some(k) => format!("memory[{k}]"),
    };
    let body = |by_tick: &ByTick, to: &dyn Fn(usize) -> String| -> String {
        let of = |program| indented(&statements(program, Dialect::Double { prefix }, input, to));
        match &by_tick.first {
            None => of(&by_tick.later),
            Some(first) => format!(
                "        if (controller->tick == 0) {{\n{}        }} else {{\n{}        }}\n",
                indented(&of(first)),
                indented(&of(&by_tick.later))
            ),
        }
    };
    let section = |block: &CompiledBlock, body: String| -> String {
        let step = &diagram.steps[block.step];
        let due = match step.rate {
            Rate::Sampled(every) if every > 1 => format!("if (controller->tick % {every} == 0) "),
            _ => String::new(),
        };
        format!("    /* {} ({}) */\n    {due}{{\n{body}    }}\n", comment_text(&step.path), step.template.kind().name)
    };
    let pointers = |n_memory: usize| {
        let memory = if n_memory > 0 { "    double *memory = controller->memory;\n" } else { "" };
        format!(
            "    double *signals = controller->signals;\n{memory}    (void)signals;\n{}",
            if n_memory > 0 { "    (void)memory;\n" } else { "" }
        )
    };
    _ = write!(
        text,
        "\nvoid {name}_controller_evaluate({name}_controller *controller) {{\n{}",
        pointers(diagram.n_memory)
    );
    for block in &controller.blocks {
        let Computed::Program(by_tick) = &block.output else { continue };
        let out = diagram.steps[block.step].out.clone();
        text += &section(block, body(by_tick, &|k| format!("signals[{}]", out.start + k)));
    }
    _ = write!(
        text,
        "}}\n\nvoid {name}_controller_update({name}_controller *controller) {{\n{}",
        pointers(diagram.n_memory)
    );
    for block in &controller.blocks {
        let Some(by_tick) = &block.update else { continue };
        let memory = diagram.steps[block.step].memory.clone();
        text += &section(block, body(by_tick, &|k| format!("memory[{}]", memory.start + k)));
    }
    text + "    controller->tick += 1;\n}\n"
}

fn indented(text: &str) -> String {
    text.lines().map(|line| format!("    {line}\n")).collect()
}

pub(super) fn readme(request: &Request<'_>, parts: &Parts, n_steps: usize, hash: u64) -> String {
    let name = request.name;
    let mut text = format!(
        "# {}\n\nWritten by sincro {} from the scene `{name}`: C99 without any library, without allocation, without state of its own.\n\n| part | operations |\n|---|---|\n",
        request.title,
        env!("CARGO_PKG_VERSION")
    );
    for (part, n) in parts.sizes() {
        _ = writeln!(text, "| {part} | {n} |");
    }
    if !parts.missing.is_empty() {
        _ = writeln!(text, "\nNot exported:\n");
        for (part, why) in &parts.missing {
            _ = writeln!(text, "- {part}: {why}");
        }
    }
    let run = if n_steps > 0 {
        format!(", and of every state of the experiment over {n_steps} steps")
    } else {
        String::new()
    };
    _ = write!(
        text,
        r"
## Compile and test

```sh
cc -std=c99 -O2 -ffp-contract=off {name}.c {name}_test.c -o {name}_test && ./{name}_test
```

The self-test hashes every bit of what the functions give at {samples} random states{run}; it expects
`{hash:016x}`, the bits that sincro gives. GCC and Clang, all optimisation levels, any IEEE processor. `-ffast-math` is
refused; `-ffp-contract=off` is set in the file too, and `-fno-tree-slp-vectorize` of GCC, whose vectorizer fuses
operations on processors with FMA all the same. Where a compiler contracts, the self-test fails.

On a microcontroller without a C library define `SINCRO_NO_STDIO` for the test (its exit status is the result), or
`SINCRO_NO_MAIN` and call `{name}_self_test()`.

## Use

",
        samples = super::parts::N_SAMPLES
    );
    if parts.step.is_some() && parts.is_closed && parts.controller.is_some() {
        _ = write!(
            text,
            r"```c
{name}_plant plant;
{name}_controller controller;
{name}_plant_init(&plant);
{name}_controller_init(&controller);
for (;;) {{
    {name}_measure(&plant, &controller);         /* or write your sensors into controller.signals */
    /* write the sources into controller.signals, if there are any: see {name}.h */
    {name}_controller_evaluate(&controller);
    {name}_command(&controller, &plant);         /* or send controller.signals to your motors */
    {name}_controller_update(&controller);
    {name}_plant_step(&plant);                   /* {h} s */
}}
```
",
            h = number(request.h)
        );
    } else if parts.step.is_some() {
        _ = write!(
            text,
            "```c\n{name}_plant plant;\n{name}_plant_init(&plant);\nfor (;;) {{\n    {name}_plant_step(&plant); /* {} s */\n}}\n```\n",
            number(request.h)
        );
    }
    text + &format!(
        "\nAll functions with their arguments, names and units: `{name}.h`. Numbers are in SI units; angles beyond ±1e6 rad give NaN.\n"
    )
}
