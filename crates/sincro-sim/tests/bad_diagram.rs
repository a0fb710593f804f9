//! Wrong diagrams: what is said, and where.
//!
//! Each case states a whole diagram file and the whole message.

use sincro_testing::{SceneFolder, scenes};

/// The sprung arm with a diagram, and two motors that take commands.
fn folder(diagram: &str) -> SceneFolder {
    let folder = scenes::sprung_arm();
    folder.change("scene.toml", "damping = 0.5", "damping = 0.5\nmotor = { mode = \"torque\" }");
    folder.change("experiment.toml", "scene = \"scene.toml\"", "scene = \"scene.toml\"\ndiagram = \"diagram.toml\"");
    folder.write("diagram.toml", diagram);
    folder
}

/// Diagnostics of a diagram.
fn said(diagram: &str, settings: &[&str]) -> String {
    match folder(diagram).load(settings) {
        Ok(_) => "loads".into(),
        Err(message) => message,
    }
}

/// `[[block]]` tables from `name type parameters…`, a block a line.
fn blocks(list: &str) -> String {
    let block = |line: &str| {
        let mut words = line.trim().splitn(3, ' ');
        let (name, kind) = (words.next().unwrap_or(""), words.next().unwrap_or(""));
        let rest = words.next().unwrap_or("").replace("; ", "\n");
        format!("[[block]]\nname = \"{name}\"\ntype = \"{kind}\"\n{rest}\n")
    };
    list.lines().filter(|line| !line.trim().is_empty()).map(block).collect()
}

/// `wires = […]`, a wire a line, then the blocks.
fn drawn(wires: &[&str], list: &str) -> String {
    let wires: Vec<String> = wires.iter().map(|wire| format!("  \"{wire}\",\n")).collect();
    format!("wires = [\n{}]\n{}", wires.concat(), blocks(list))
}

#[test]
fn every_wrong_diagram_is_refused_with_place_and_help() {
    let mut wrong = Vec::new();
    for (wires, list, expected) in CASES {
        let found = said(&drawn(wires, list), &[]);
        if found != *expected {
            wrong.push(format!("{wires:?} {list}\nfound\n{found}\nexpected\n{expected}\n"));
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn every_wrong_definition_is_refused_with_place_and_help() {
    let mut wrong = Vec::new();
    for (text, expected) in DEFINITIONS {
        let found = said(text, &[]);
        if found != *expected {
            wrong.push(format!("{text}\nfound\n{found}\nexpected\n{expected}\n"));
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn settings_of_blocks_are_refused_with_help() {
    let diagram = drawn(&["/shoulder.position -> pid -> /shoulder"], "pid pid kp = 1");
    let mut wrong = Vec::new();
    for (setting, expected) in SETTINGS {
        let found = said(&diagram, &[setting]);
        if found != *expected {
            wrong.push(format!("{setting}\nfound\n{found}\nexpected\n{expected}\n"));
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

/// Wires, blocks, and what is said.
const CASES: &[(&[&str], &str, &str)] = &[
    (
        &[],
        "a gian gain = 1",
        r##"diagram.toml:5:8: error: there is no block type `gian` (block `a`)
  help: did you mean `gain`?"##,
    ),
    (
        &[],
        "a fuzzy-logic",
        r##"diagram.toml:5:8: error: there is no block type `fuzzy-logic` (block `a`)
  help: `sincro blocks` lists every block with its parameters"##,
    ),
    (
        &["a -> b"],
        "a constant value = 1\nb terminator\nb terminator",
        r##"diagram.toml:13:8: error: there are two blocks `b`
  help: rename one of them"##,
    ),
    (
        &[],
        "world constant value = 1",
        r##"diagram.toml:4:8: error: `world` is the world itself
  help: give the block another name"##,
    ),
    (
        &[],
        "a.b constant value = 1",
        r##"diagram.toml:4:8: error: `a.b` is no name of a block
  help: names have letters, digits, `_`, `-`"##,
    ),
    (
        &[],
        " constant value = 1",
        r##"diagram.toml:6:1: error: unquoted keys cannot be empty, expected letters, numbers, `-`, `_`
  help: the file is TOML: https://toml.io/en/v1.1.0"##,
    ),
    (
        &["a b"],
        "a constant value = 1",
        r##"diagram.toml:2:3: error: `a b` is no wire
  help: write "FROM -> TO", such as "error -> pid -> /motor1""##,
    ),
    (
        &["a ->"],
        "a constant value = 1",
        r##"diagram.toml:2:8: error: nothing stands here
  help: ends of wires are `block`, `block.port`, `block.port[0]`, or `/joint.position` of the world"##,
    ),
    (
        &["-> a"],
        "a gain gain = 1",
        r##"diagram.toml:2:4: error: nothing stands here
  help: ends of wires are `block`, `block.port`, `block.port[0]`, or `/joint.position` of the world"##,
    ),
    (
        &["a -> b ->"],
        "a constant value = 1\nb gain gain = 1",
        r##"diagram.toml:2:13: error: nothing stands here
  help: ends of wires are `block`, `block.port`, `block.port[0]`, or `/joint.position` of the world"##,
    ),
    (
        &["a -> -> b"],
        "a constant value = 1\nb gain gain = 1",
        r##"diagram.toml:2:9: error: nothing stands here
  help: ends of wires are `block`, `block.port`, `block.port[0]`, or `/joint.position` of the world"##,
    ),
    (
        &["[a, -> b"],
        "a constant value = 1\nb gain gain = 1",
        r##"diagram.toml:2:4: error: `[` without `]`
  help: ends of wires are `block`, `block.port`, `block.port[0]`, or `/joint.position` of the world"##,
    ),
    (
        &["[a, ] -> b"],
        "a constant value = 1\nb gain gain = 1",
        r##"diagram.toml:2:8: error: nothing stands here
  help: ends of wires are `block`, `block.port`, `block.port[0]`, or `/joint.position` of the world"##,
    ),
    (
        &["[] -> b"],
        "b gain gain = 1",
        r##"diagram.toml:2:5: error: nothing stands here
  help: ends of wires are `block`, `block.port`, `block.port[0]`, or `/joint.position` of the world"##,
    ),
    (
        &["a -> [b, c]"],
        "a constant value = 1\nb gain gain = 1\nc gain gain = 1",
        r##"diagram.toml:2:9: error: a wire ends at one port; write a wire for each
  help: ends of wires are `block`, `block.port`, `block.port[0]`, or `/joint.position` of the world"##,
    ),
    (
        &["a[ -> b"],
        "a constant value = 1\nb gain gain = 1",
        r##"diagram.toml:2:5: error: `[` without `]`
  help: ends of wires are `block`, `block.port`, `block.port[0]`, or `/joint.position` of the world"##,
    ),
    (
        &["a[x] -> b"],
        "a constant value = 1\nb gain gain = 1",
        r##"diagram.toml:2:5: error: `[x]` is no choice of components: write [2] or [0:3]
  help: ends of wires are `block`, `block.port`, `block.port[0]`, or `/joint.position` of the world"##,
    ),
    (
        &["a[1:1] -> b"],
        "a constant value = 1\nb gain gain = 1",
        r##"diagram.toml:2:5: error: `[1:1]` is no choice of components: write [2] or [0:3]
  help: ends of wires are `block`, `block.port`, `block.port[0]`, or `/joint.position` of the world"##,
    ),
    (
        &["a[18446744073709551615] -> b"],
        "a constant value = 1\nb gain gain = 1",
        r##"diagram.toml:2:5: error: `[18446744073709551615]` is no choice of components: write [2] or [0:3]
  help: ends of wires are `block`, `block.port`, `block.port[0]`, or `/joint.position` of the world"##,
    ),
    (
        &["a b -> c"],
        "a constant value = 1\nc gain gain = 1",
        r##"diagram.toml:2:4: error: `a b` is no port
  help: ends of wires are `block`, `block.port`, `block.port[0]`, or `/joint.position` of the world"##,
    ),
    (
        &["target -> pid"],
        "traget constant value = 1\npid gain gain = 1",
        r##"diagram.toml:2:4: error: there is no block `target`
  help: did you mean `traget`?"##,
    ),
    (
        &["a -> pdi"],
        "a constant value = 1\npid gain gain = 1",
        r##"diagram.toml:2:9: error: there is no block `pdi`
  help: the diagram has `a` and `pid`; `/…` is a signal of the world"##,
    ),
    (
        &["a -> sum.u3", "a -> sum.u1", "a -> sum.u2"],
        "a constant value = 1\nsum sum",
        r##"diagram.toml:2:9: error: `sum` has no input `u3`
  help: it has `u1` and `u2`"##,
    ),
    (
        &["a -> sum"],
        "a constant value = 1\nsum sum",
        r##"diagram.toml:2:9: error: `sum` has 2 inputs
  help: say which: `sum.u1` and `sum.u2`"##,
    ),
    (
        &["a.z -> b"],
        "a constant value = 1\nb gain gain = 1",
        r##"diagram.toml:2:4: error: `a` has no output `z`
  help: it has `y`"##,
    ),
    (
        &["a -> b", "b -> a"],
        "a constant value = 1\nb gain gain = 1",
        r##"diagram.toml:3:9: error: `a` has no input
  help: remove the wire, or use another block"##,
    ),
    (
        &["a -> b.setpiont", "a -> b.measurement"],
        "a constant value = 1\nb pid kp = 1; separate = true",
        r##"diagram.toml:2:9: error: `b` has no input `setpiont`
  help: did you mean `setpoint`?"##,
    ),
    (
        &["t -> b"],
        "t terminator\nb gain gain = 1",
        r##"diagram.toml:2:4: error: `t` has no output
  help: remove the wire, or use another block"##,
    ),
    (
        &["a -> b[0]"],
        "a constant value = 1\nb gain gain = 1",
        r##"diagram.toml:2:9: error: `b[0]` is a part of a port
  help: a wire fills a whole port; choose components where it begins"##,
    ),
    (
        &[],
        "b gain gain = 1",
        r##"diagram.toml:4:8: error: the input of `b` is not connected
  help: add a wire "… -> b""##,
    ),
    (
        &["a -> sum.u1"],
        "a constant value = 1\nsum sum",
        r##"diagram.toml:9:8: error: the input `u2` of `sum` is not connected
  help: add a wire "… -> sum.u2""##,
    ),
    (
        &["a -> b", "c -> b"],
        "a constant value = 1\nc constant value = 1\nb gain gain = 1",
        r##"diagram.toml:3:9: error: two wires go into `b`; the other comes from `a`
  help: add the signals in a `sum`, or choose in a `switch`"##,
    ),
    (
        &["a -> b", "c -> b.u"],
        "a constant value = 1\nc constant value = 1\nb gain gain = 1",
        r##"diagram.toml:3:9: error: two wires go into `b.u`; the other comes from `a`
  help: add the signals in a `sum`, or choose in a `switch`"##,
    ),
    (
        &["a -> /shoulder", "a -> /shoulder.command"],
        "a constant value = 1",
        r##"diagram.toml:3:9: error: two wires go into `/shoulder.command`; the other comes from `a`
  help: add the signals in a `sum`, or choose in a `switch`"##,
    ),
    (
        &["a -> sum.u1", "b -> sum.u2"],
        "a constant value = [1, 2]\nb constant value = [1, 2, 3]\nsum sum",
        r##"diagram.toml:14:8: error: sizes do not fit in `sum`: input 1 has 2 components, input 2 has 3 (`u1` gets 2 from `a`, `u2` gets 3 from `b`)
  help: choose components with `[i]` or `[i:j]`, put signals together with `[a, b]`, or change the parameters"##,
    ),
    (
        &["a[2] -> b"],
        "a constant value = [1, 2]\nb gain gain = 1",
        r##"diagram.toml:2:4: error: `a` has 2 components: there is no [2]
  help: components are counted from 0 to 1"##,
    ),
    (
        &["a -> /shoulder"],
        "a constant value = [1, 2]",
        r##"diagram.toml:2:4: error: `a` has 2 components, `/shoulder` takes 1
  help: choose one: `a[0]`"##,
    ),
    (
        &["/shoulder/rod.position[3] -> b"],
        "b gain gain = 1",
        r##"diagram.toml:2:4: error: `/shoulder/rod.position` has 3 components: there is no [3]
  help: components are counted from 0 to 2"##,
    ),
    (
        &["a -> b"],
        "a constant value = [1, 2]\nb gain gain = [1, 2, 3]",
        r##"diagram.toml:9:8: error: sizes do not fit in `b`: input 1 has 2 components, `gain` has 3 (`u` gets 2 from `a`)
  help: choose components with `[i]` or `[i:j]`, put signals together with `[a, b]`, or change the parameters"##,
    ),
    (
        &["a -> d"],
        "a constant value = 1\nd unit-delay sample_time = 0.015",
        r##"diagram.toml:11:15: error: the sample time 0.015 s of `d` is no multiple of the base step 0.01 s
  help: use 0.01 s or 0.02 s, or another `step` in the experiment"##,
    ),
    (
        &["a -> d"],
        "a constant value = 1\nd unit-delay sample_time = 0.003",
        r##"diagram.toml:11:15: error: the sample time 0.003 s of `d` is no multiple of the base step 0.01 s
  help: use 0.01 s or more, or a smaller `step` in the experiment"##,
    ),
    (
        &["a -> d"],
        "a constant value = 1\nd unit-delay sample_time = 0",
        r##"diagram.toml:11:15: error: the sample time 0 s of `d` is not greater than 0
  help: use a multiple of the base step 0.01 s, or leave it out"##,
    ),
    (
        &["a -> d"],
        "a constant value = 1\nd unit-delay sample_time = -0.01",
        r##"diagram.toml:11:15: error: the sample time -0.01 s of `d` is not greater than 0
  help: use a multiple of the base step 0.01 s, or leave it out"##,
    ),
    (
        &["a -> x"],
        "a constant value = 1\nx integrator sample_time = 0.01",
        r##"diagram.toml:11:15: error: `x` is a continuous block (integrator) and cannot have a sample time
  help: leave `sample_time` out, or use a block of the discrete category"##,
    ),
    (
        &["a -> x"],
        "a constant value = 1\nx transfer-function numerator = [1]; denominator = [1, 1]; sample_time = 0.01",
        r##"diagram.toml:13:15: error: `x` is a continuous block (transfer-function) and cannot have a sample time
  help: leave `sample_time` out, or use a block of the discrete category"##,
    ),
    (
        &["one -> a.u1", "c -> a.u2", "a -> b -> c"],
        "one constant value = 1\na sum\nb gain gain = 2\nc gain gain = 2",
        r##"diagram.toml:11:8: error: algebraic loop: a -> b -> c -> a
  help: each of these needs the output of the one before it at the same instant. Break the loop with a block that does not pass its input on at once: `unit-delay` (one sample), or `low-pass` or `integrator` (continuous)"##,
    ),
    (
        &["g -> g"],
        "g gain gain = 0.5",
        r##"diagram.toml:5:8: error: algebraic loop: g -> g
  help: each of these needs the output of the one before it at the same instant. Break the loop with a block that does not pass its input on at once: `unit-delay` (one sample), or `low-pass` or `integrator` (continuous)"##,
    ),
    (
        &["/shoulder.acceleration -> g -> /shoulder"],
        "g gain gain = 0.5",
        r##"diagram.toml:5:8: error: algebraic loop: g -> world's accelerations -> g
  help: each of these needs the output of the one before it at the same instant. Break the loop with a block that does not pass its input on at once: `unit-delay` (one sample), or `low-pass` or `integrator` (continuous)"##,
    ),
    (
        &["a.y -> b", "b -> a", "c -> d", "d -> c", "b -> e -> f"],
        "a gain gain = 1\nb gain gain = 1\nc gain gain = 1\nd gain gain = 1\ne gain gain = 1\nf gain gain = 1",
        r##"diagram.toml:9:8: error: algebraic loop: a -> b -> a
  help: each of these needs the output of the one before it at the same instant. Break the loop with a block that does not pass its input on at once: `unit-delay` (one sample), or `low-pass` or `integrator` (continuous)
diagram.toml:17:8: error: algebraic loop: c -> d -> c
  help: each of these needs the output of the one before it at the same instant. Break the loop with a block that does not pass its input on at once: `unit-delay` (one sample), or `low-pass` or `integrator` (continuous)"##,
    ),
    (
        &["a -> g"],
        "a constant value = 1\ng transfer-function numerator = [1, 0, 0]; denominator = [1, 1]",
        r##"diagram.toml:11:13: error: block `g`: improper transfer function: numerator of degree 2, denominator of degree 1
  help: divide by another pole s·τ + 1 with a small τ, or use `derivative`"##,
    ),
    (
        &["a -> g"],
        "a constant value = 1\ng transfer-function numerator = [1]; denominator = [0]",
        r##"diagram.toml:12:15: error: block `g`: the denominator is zero
  help: give its coefficients, highest power first: [1, 2] is s + 2"##,
    ),
    (&[], "a constant value = '2*(k + 1'", r##"diagram.toml:6:12: error: block `a`: `(` is never closed"##),
    (
        &[],
        "a constant value = '2*k + mass'",
        r##"diagram.toml:6:16: error: block `a`: unknown name `mass`
  help: it knows k"##,
    ),
    (
        &[],
        "a constant value = [1, '2 +* k']",
        r##"diagram.toml:6:17: error: block `a`: a value is missing before `*`"##,
    ),
    (
        &[],
        "a constant",
        r##"diagram.toml:4:8: error: block `a`: `constant` needs the parameter `value`: constant output
  help: give value = …"##,
    ),
    (
        &[],
        "a constant vaule = 1",
        r##"diagram.toml:4:8: error: block `a`: `constant` needs the parameter `value`: constant output
  help: give value = …
diagram.toml:6:1: error: block `a`: `constant` has no parameter `vaule`
  help: did you mean `value`? it has value"##,
    ),
    (
        &[],
        "a constant value = true",
        r##"diagram.toml:6:9: error: block `a`: `value` is not a number
  help: write a number, or a formula of the diagram's parameters in quotes"##,
    ),
    (
        &[],
        "a constant value = inf",
        r##"diagram.toml:6:9: error: block `a`: `value` is inf
  help: it must be a finite number"##,
    ),
    (
        &[],
        "a constant value = nan",
        r##"diagram.toml:6:9: error: block `a`: `value` is NaN
  help: it must be a finite number"##,
    ),
    (
        &[],
        "a constant value = []",
        r##"diagram.toml:6:9: error: block `a`: `value` is empty
  help: give at least one number"##,
    ),
    (
        &[],
        "a constant value = 2020-01-01",
        r##"diagram.toml:6:9: error: block `a`: `value` is not a number
  help: write a number, or a formula of the diagram's parameters in quotes"##,
    ),
    (
        &[],
        "a constant value = 99999999999999999999",
        r##"diagram.toml:6:9: error: block `a`: `value` is not a number
  help: write a number, or a formula of the diagram's parameters in quotes"##,
    ),
    (
        &[],
        "a constant value = '1/0'",
        r##"diagram.toml:6:9: error: block `a`: `value`: `1/0` is inf
  help: it must be a finite number"##,
    ),
    (
        &[],
        "a constant value = { x = 1 }",
        r##"diagram.toml:6:9: error: block `a`: `value` is not a number
  help: write a number, or a formula of the diagram's parameters in quotes"##,
    ),
    (
        &["a -> f"],
        "a constant value = 1\nf low-pass time_constant = -0.1",
        r##"diagram.toml:11:17: error: block `f`: `time_constant` has -0.1
  help: every number must be greater than 0"##,
    ),
    (
        &["a -> f"],
        "a constant value = 1\nf low-pass time_constant = 0",
        r##"diagram.toml:11:17: error: block `f`: `time_constant` has 0
  help: every number must be greater than 0"##,
    ),
    (
        &["a -> f"],
        "a constant value = 1\nf pid kp = 1; kd = 1; filter_time_constant = 0",
        r##"diagram.toml:13:24: error: block `f`: `filter_time_constant` is 0
  help: a derivative needs a lag: give a tenth of the shortest time that matters, or less"##,
    ),
    (
        &["a -> f"],
        "a constant value = 1\nf pid kp = 1; anti_windup = 'clampin'",
        r##"diagram.toml:12:15: error: block `f`: `anti_windup` is `clampin`
  help: did you mean `clamping`? it is one of back-calculation, clamping, none"##,
    ),
    (
        &["a -> f"],
        "a constant value = 1\nf pid kp = 1; separate = 1",
        r##"diagram.toml:12:12: error: block `f`: `separate` is not true or false
  help: write true or false"##,
    ),
    (
        &["a -> f"],
        "a constant value = 1\nf pid kp = 1; lower = 2; upper = 1",
        r##"diagram.toml:12:9: error: block `f`: `lower` 2 is above `upper` 1
  help: exchange them"##,
    ),
    (
        &["a -> f"],
        "a constant value = 1\nf delay samples = -1",
        r##"diagram.toml:11:11: error: block `f`: `samples` is -1
  help: it must be a whole number from 0 on"##,
    ),
    (
        &["a -> f"],
        "a constant value = 1\nf delay samples = 1.5",
        r##"diagram.toml:11:11: error: block `f`: `samples` is 1.5
  help: it must be a whole number from 0 on"##,
    ),
    (
        &["a -> f"],
        "a constant value = 1\nf delay samples = 999999999",
        r##"diagram.toml:9:8: error: `f` keeps 999999999 numbers; a diagram may have 50000000
  help: delay by fewer samples, or a narrower signal"##,
    ),
    (
        &["a -> f"],
        "a constant value = 1\nf transport-delay delay = 1e300",
        r##"diagram.toml:9:8: error: `f`: a delay of 1.00e300 s is 1.00e302 base steps of 0.01 s
  help: at most 10000000 steps are remembered: take a larger `step`"##,
    ),
    (
        &["a -> f"],
        "a constant value = 1\nf demux sizes = [1e300, 1e300]",
        r##"diagram.toml:11:9: error: block `f`: `sizes` has 1.00e300
  help: sizes are whole numbers from 1 on"##,
    ),
    (
        &["a -> f"],
        "a constant value = 1\nf mux inputs = 999999999",
        r##"diagram.toml:11:10: error: block `f`: `inputs` is 999999999
  help: a block has at most 10000"##,
    ),
    (
        &["a -> f.x"],
        "a constant value = 1\nf expression inputs = ['x']; expression = 'x + z'",
        r##"diagram.toml:12:19: error: block `f`: unknown name `z`
  help: it knows x, t, k"##,
    ),
    (
        &["a -> f.x"],
        "a constant value = 1\nf expression",
        r##"diagram.toml:9:8: error: block `f`: there is no formula
  help: give either expression = "…" or expressions = ["…", "…"]"##,
    ),
    (
        &["a -> f"],
        "a constant value = 1\nf lookup-table breakpoints = [1, 0]; values = [1, 2]",
        r##"diagram.toml:11:15: error: block `f`: `breakpoints` has 0 after 1
  help: breakpoints must rise from one to the next"##,
    ),
    (
        &["a -> f"],
        "a constant value = 1\nf state-space a = [[1, 2], [3]]; b = [1, 1]; c = [[1, 0]]",
        r##"diagram.toml:11:5: error: block `f`: row 0 of `a` has 2 numbers, row 1 has 1
  help: all rows of a matrix are of the same length
diagram.toml:13:5: error: block `f`: `c` is 1 × 2, `a` is 1 × 1: both need a column for each state
  help: with n states, m inputs and p outputs a is n × n, b n × m, c p × n and d p × m"##,
    ),
    (
        &[],
        "a table file = 'nowhere.csv'; columns = ['x']",
        r##"diagram.toml:6:8: error: block `a`: the table has no rows
  help: give at least one
diagram.toml:7:11: error: block `a`: there is no file `nowhere.csv` (files there: `reference.csv`)
  help: the path is relative to the scene's folder"##,
    ),
    (&[], "a constant value = 1; sample_time = 'k +'", r##"diagram.toml:7:19: error: a value is missing at the end"##),
    (
        &[],
        "a constant value = 1; unit = 3",
        r##"diagram.toml:7:8: error: `unit` is the number 3, expected a string or a list of strings
  help: Unit of its outputs, such as `N·m`, or a list of one for each component; compared where two units meet."##,
    ),
    (
        &["a -> s.u1", "b -> s.u2"],
        "a constant value = 1; unit = 'rad'\nb constant value = 1; unit = 'deg'\ns sum",
        r##"diagram.toml:16:8: error: units do not fit in `s`: rad and deg are not the same (`u1` gets rad from `a`, `u2` gets deg from `b`)
  help: convert one of them with a `gain` and declare its `unit`"##,
    ),
    (
        &["/shoulder.position -> s.u1", "/shoulder.velocity -> s.u2"],
        "s sum",
        r##"diagram.toml:6:8: error: units do not fit in `s`: rad and rad/s are not the same (`u1` gets rad from `/shoulder.position`, `u2` gets rad/s from `/shoulder.velocity`)
  help: convert one of them with a `gain` and declare its `unit`"##,
    ),
    (
        &["a -> /shoulder"],
        "a constant value = 1; unit = 'rad'",
        r##"diagram.toml:2:4: error: `a` is in rad, `/shoulder` takes N·m
  help: convert it with a `gain` and declare its `unit`"##,
    ),
    (
        &[],
        "a constant value = 1; unit = 'parsec'",
        r##"diagram.toml:7:8: error: `parsec` is no unit
  help: units are products such as N·m/rad, m/s^2, kg·m²"##,
    ),
    (
        &[],
        "a constant value = 1; unit = 'm^-128'",
        r##"diagram.toml:7:8: error: `m^-128` is no unit
  help: units are products such as N·m/rad, m/s^2, kg·m²"##,
    ),
    (
        &[],
        "a constant value = 1; unit = 'J^9*J^9*J^9*J^9*J^9*J^9*J^9*J^9'",
        r##"diagram.toml:7:8: error: `J^9*J^9*J^9*J^9*J^9*J^9*J^9*J^9` has too high a power
  help: units are products such as N·m/rad, m/s^2, kg·m²"##,
    ),
    (
        &["/shoulder.position -> d"],
        "d unit-delay unit = 'deg'",
        r##"diagram.toml:7:8: error: `d` is declared in deg, its signal is in rad
  help: declare unit = "rad", or leave it out"##,
    ),
    (
        &["/shoulder.positon -> g"],
        "g gain gain = 1",
        r##"diagram.toml:2:4: error: the world has no signal `/shoulder.positon`
  help: did you mean `/shoulder.position`?"##,
    ),
    (
        &["/elbow.velocity -> g"],
        "g gain gain = 1",
        r##"diagram.toml:2:4: error: the world has no signal `/elbow.velocity`
  help: did you mean `/shoulder.velocity`?"##,
    ),
    (
        &["world -> g"],
        "g gain gain = 1",
        r##"diagram.toml:2:4: error: `world` is all signals of the world
  help: say which of its signals: `/joint.position`, `/body.position`, `world.q`, `world.v` …"##,
    ),
    (
        &["world.x -> g"],
        "g gain gain = 1",
        r##"diagram.toml:2:4: error: the world has no signal `x`
  help: `sincro check --signals` lists what can be measured"##,
    ),
    (
        &["world.q[2] -> g"],
        "g gain gain = 1",
        r##"diagram.toml:2:4: error: `world.q` has 2 components: there is no [2]
  help: components are counted from 0 to 1"##,
    ),
    (
        &["a -> /elbow"],
        "a constant value = 1",
        r##"diagram.toml:2:9: error: the world takes no command `/elbow`
  help: commands go to the joints with a motor: `/shoulder` and `/shoulder/rod/tip/wrist`"##,
    ),
    (
        &["a -> /shoulder/rod"],
        "a constant value = 1",
        r##"diagram.toml:2:9: error: `/shoulder/rod` has no motor that takes commands
  help: commands go to the joints with a motor: `/shoulder` and `/shoulder/rod/tip/wrist`"##,
    ),
    (
        &["a -> world"],
        "a constant value = 1",
        r##"diagram.toml:2:9: error: the world takes no command `world`
  help: commands go to the joints with a motor: `/shoulder` and `/shoulder/rod/tip/wrist`"##,
    ),
    (
        &["a -> world.q"],
        "a constant value = 1",
        r##"diagram.toml:2:9: error: the world takes no command `world.q`
  help: commands go to the joints with a motor: `/shoulder` and `/shoulder/rod/tip/wrist`"##,
    ),
    (
        &["/shoulder -> g"],
        "g gain gain = 1",
        r##"diagram.toml:2:4: error: the world has no signal `/shoulder`
  help: it has `/shoulder.acceleration`, `/shoulder.applied_torque`, `/shoulder.damping_torque`, `/shoulder.motor_torque`, `/shoulder.motor_torque_now`, `/shoulder.position`, `/shoulder.spring_torque` and `/shoulder.velocity`"##,
    ),
    (
        &["größe -> verstärker", "größe -> verstaerker"],
        "größe constant value = 1\nverstärker gain gain = 1",
        r##"diagram.toml:3:13: error: there is no block `verstaerker`
  help: did you mean `verstärker`?"##,
    ),
    (
        &["größe→b"],
        "größe constant value = 1\nb gain gain = 1",
        r##"diagram.toml:2:3: error: `größe→b` is no wire
  help: write "FROM -> TO", such as "error -> pid -> /motor1""##,
    ),
];

/// Diagrams with definitions, and what is said.
const DEFINITIONS: &[(&str, &str)] = &[
    // an input, an output and a parameter
    (
        "wires = [\"loop -> g\"]\n[[block]]\nname = \"loop\"\ntype = \"pi\"\nkq = 2\n[[block]]\nname = \"g\"\ntype = \"gain\"\ngain = 1\n\
      [[diagram]]\nname = \"pi\"\ninputs = [\"e\"]\noutputs = [\"u\"]\nparameters = { kp = 1 }\n[[diagram.block]]\nname = \"p\"\ntype = \"gain\"\ngain = \"kp\"\n",
        r##"diagram.toml:5:1: error: the diagram `pi` has no parameter `kq`
  help: parameters: `kp`"##,
    ),
    (
        "wires = [\"one -> loop -> g\"]\n[[block]]\nname = \"one\"\ntype = \"constant\"\nvalue = 1\n[[block]]\nname = \"loop\"\ntype = \"pi\"\n[[block]]\nname = \"again\"\ntype = \"pi\"\n[[block]]\nname = \"g\"\ntype = \"gain\"\ngain = 1\n\
      [[diagram]]\nname = \"pi\"\ninputs = [\"e\"]\noutputs = [\"u\", \"v\"]\nwires = [\"e -> p\", \"u -> p\", \"p -> e\", \"/shoulder.position -> u\", \"e.x -> q\"]\n[[diagram.block]]\nname = \"p\"\ntype = \"gain\"\ngain = 1\n",
        r##"diagram.toml:1:18: error: `loop` has 2 outputs
  help: say which: `loop.u` and `loop.v`
diagram.toml:10:8: error: the input `e` of `again` is not connected
  help: add a wire "… -> again.e"
diagram.toml:19:11: error: the output `v` of the diagram is not connected
  help: add a wire "… -> v"
diagram.toml:20:21: error: `u` is an output of the diagram
  help: a wire ends there: turn it round
diagram.toml:20:26: error: two wires go into `p`; the other comes from `e`
  help: add the signals in a `sum`, or choose in a `switch`
diagram.toml:20:36: error: `e` is an input of the diagram
  help: a wire begins there: turn it round
diagram.toml:20:41: error: `/shoulder.position`: an inner diagram does not see the world
  help: bring the signal in through a port: inputs = ["…"]
diagram.toml:20:68: error: `e` is a port of the diagram and has no port `x` of its own
  help: write `e`
diagram.toml:20:75: error: there is no block `q`
  help: the diagram has `p`, `u` and `v`; `/…` is a signal of the world"##,
    ),
    // algebraic loop through a definition
    (
        "wires = [\"loop -> loop\"]\n[[block]]\nname = \"loop\"\ntype = \"pi\"\n[[diagram]]\nname = \"pi\"\ninputs = [\"e\"]\noutputs = [\"u\"]\nwires = [\"e -> p -> u\"]\n[[diagram.block]]\nname = \"p\"\ntype = \"gain\"\ngain = 1\n",
        r##"diagram.toml:11:8: error: algebraic loop: loop/p -> loop/p
  help: each of these needs the output of the one before it at the same instant. Break the loop with a block that does not pass its input on at once: `unit-delay` (one sample), or `low-pass` or `integrator` (continuous)"##,
    ),
    // ports in a circle
    (
        "wires = [\"loop -> loop\", \"loop -> g\"]\n[[block]]\nname = \"loop\"\ntype = \"pi\"\n[[block]]\nname = \"g\"\ntype = \"gain\"\ngain = 1\n[[diagram]]\nname = \"pi\"\ninputs = [\"e\"]\noutputs = [\"u\"]\nwires = [\"e -> u\"]\n",
        r##"diagram.toml:13:11: error: ports lead from one to the next in a circle
  help: put a block between the ports"##,
    ),
    // components of components
    (
        "wires = [\"a[0] -> p -> g\"]\n[[block]]\nname = \"a\"\ntype = \"constant\"\nvalue = [1, 2, 3]\n[[block]]\nname = \"p\"\ntype = \"pass\"\n[[block]]\nname = \"g\"\ntype = \"gain\"\ngain = 1\n[[diagram]]\nname = \"pass\"\ninputs = [\"e\"]\noutputs = [\"u\"]\nwires = [\"e[1] -> u\"]\n",
        r##"diagram.toml:17:11: error: `e` has 1 component: there is no [1]
  help: write `e`"##,
    ),
    // itself, a library block's name, twice
    (
        "[[block]]\nname = \"x\"\ntype = \"a\"\n[[diagram]]\nname = \"a\"\n[[diagram.block]]\nname = \"inner\"\ntype = \"b\"\n[[diagram]]\nname = \"b\"\n[[diagram.block]]\nname = \"one\"\ntype = \"a\"\n[[diagram.block]]\nname = \"two\"\ntype = \"a\"\n",
        r##"diagram.toml:13:8: error: the diagram `a` contains itself: a -> b -> a
  help: break the circle of definitions
diagram.toml:16:8: error: the diagram `a` contains itself: a -> b -> a
  help: break the circle of definitions"##,
    ),
    (
        "[[diagram]]\nname = \"gain\"\n[[diagram]]\nname = \"jacobian\"\n[[diagram]]\nname = \"x\"\n[[diagram]]\nname = \"x\"\n",
        r##"diagram.toml:2:8: error: `gain` is a block of the library
  help: give the diagram another name
diagram.toml:4:8: error: `jacobian` is a block of the library
  help: give the diagram another name
diagram.toml:8:8: error: `x` is another diagram of this file
  help: give the diagram another name"##,
    ),
    // names of ports and parameters
    (
        "[[block]]\nname = \"x\"\ntype = \"a\"\n[[diagram]]\nname = \"a\"\ninputs = [\"u\", \"u\", \"w.v\", \"world\"]\nparameters = { t = 1, unit = 2, \"2k\" = 3, q = \"k\" }\n[[diagram.block]]\nname = \"u\"\ntype = \"constant\"\nvalue = \"q\"\n",
        r##"diagram.toml:7:16: error: `t` cannot be the name of a parameter
  help: letters, digits and `_`, beginning with a letter; `t` and `pi` have a meaning of their own
diagram.toml:7:23: error: `unit` cannot be the name of a parameter
  help: every block has a key of that name
diagram.toml:7:33: error: `2k` cannot be the name of a parameter
  help: letters, digits and `_`, beginning with a letter; `t` and `pi` have a meaning of their own
diagram.toml:7:48: error: unknown name `k`
  help: it knows no names: there are no parameters"##,
    ),
    (
        "[[block]]\nname = \"x\"\ntype = \"a\"\n[[diagram]]\nname = \"a\"\ninputs = [\"u\", \"u\", \"w.v\", \"world\"]\n[[diagram.block]]\nname = \"u\"\ntype = \"constant\"\nvalue = 1\n",
        r##"diagram.toml:4:1: error: there are two inputs `u`
  help: rename one of them
diagram.toml:4:1: error: `w.v` is no name of a port
  help: names have letters, digits, `_`, `-`; `world` is the world itself
diagram.toml:4:1: error: `world` is no name of a port
  help: names have letters, digits, `_`, `-`; `world` is the world itself
diagram.toml:8:8: error: `u` is a port of the diagram and a block in it
  help: rename the block"##,
    ),
    // sample times: of the file, of the block, of the definition
    (
        "sample_time = 0.015\n[[block]]\nname = \"x\"\ntype = \"clock\"\n",
        r##"diagram.toml:1:15: error: the sample time 0.015 s of `x` is no multiple of the base step 0.01 s
  help: use 0.01 s or 0.02 s, or another `step` in the experiment"##,
    ),
    (
        "sample_time = 0.01\nwires = [\"one -> x\"]\n[[block]]\nname = \"one\"\ntype = \"constant\"\nvalue = 1\n[[block]]\nname = \"x\"\ntype = \"integrator\"\n",
        r##"diagram.toml:1:15: error: `x` is a continuous block (integrator) and cannot have a sample time
  help: leave `sample_time` out, or use a block of the discrete category"##,
    ),
    (
        "[[block]]\nname = \"x\"\ntype = \"a\"\nsample_time = 0.025\n[[diagram]]\nname = \"a\"\nsample_time = 0.01\n[[diagram.block]]\nname = \"c\"\ntype = \"clock\"\n",
        r##"diagram.toml:4:15: error: the sample time 0.025 s of `x/c` is no multiple of the base step 0.01 s
  help: use 0.02 s or 0.03 s, or another `step` in the experiment"##,
    ),
    (
        "[[block]]\nname = \"x\"\ntype = \"a\"\n[[diagram]]\nname = \"a\"\nsample_time = 0.025\nwires = [\"c -> i\"]\n[[diagram.block]]\nname = \"c\"\ntype = \"clock\"\n[[diagram.block]]\nname = \"i\"\ntype = \"integrator\"\n",
        r##"diagram.toml:6:15: error: the sample time 0.025 s of `x/c` is no multiple of the base step 0.01 s
  help: use 0.02 s or 0.03 s, or another `step` in the experiment
diagram.toml:6:15: error: `x/i` is a continuous block (integrator) and cannot have a sample time
  help: its diagram has one: leave the diagram's sample time out, or use a block of the discrete category"##,
    ),
    (
        "sample_time = \"2*ts\"\n[parameters]\nts = 0.01\nx = \"ts + y\"\npi = 3\n",
        r##"diagram.toml:4:11: error: unknown name `y`
  help: it knows k, ts
diagram.toml:5:1: error: `pi` cannot be the name of a parameter
  help: letters, digits and `_`, beginning with a letter; `t` and `pi` have a meaning of their own"##,
    ),
    // keys and types of the file
    ("", r##"loads"##),
    (
        "wire = []\n",
        r##"diagram.toml:1:1: error: unknown key `wire`
  help: did you mean `wires`? keys here: `block`, `diagram`, `parameters`, `sample_time`, `wires`"##,
    ),
    (
        "wires = \"a -> b\"\n",
        r##"diagram.toml:1:9: error: `wires` is the string "a -> b", expected a list of strings
  help: Wires such as `"error -> pid -> /motor1"`, `"plant.x[0] -> error.u2"`, `"[a, b] -> norm"`; `/…` are the world's signals."##,
    ),
    ("wires = [1]\n", r##"diagram.toml:1:10: error: `wires[0]` is the number 1, expected a string"##),
    (
        "[[block]]\nname = \"x\"\n",
        r##"diagram.toml:2:8: error: `type` is missing in block `x`
  help: `type`: What it is: a block of the library, or a diagram of this file."##,
    ),
    (
        "[[block]]\ntype = \"gain\"\n",
        r##"diagram.toml:1:1: error: `name` is missing in `block[0]`
  help: `name`: Letters, digits, `_` and `-`."##,
    ),
    (
        "[block]\nname = \"x\"\n",
        r##"diagram.toml:1:1: error: `block` is a table, expected a list of tables
  help: Blocks."##,
    ),
    (
        "[[diagram]]\ninputs = \"u\"\n",
        r##"diagram.toml:1:1: error: `name` is missing in `diagram[0]`
  help: `name`: What blocks of this type give as `type`.
diagram.toml:2:10: error: `inputs` is the string "u", expected a list of strings
  help: Names of the ports through which signals come in."##,
    ),
    (
        "a = = 3\n",
        r##"diagram.toml:1:5: error: extra `=`, expected nothing
  help: the file is TOML: https://toml.io/en/v1.1.0
diagram.toml:1:7: error: unexpected key or value, expected newline, `#`
  help: the file is TOML: https://toml.io/en/v1.1.0"##,
    ),
];

/// Settings on a diagram with a pid in it, and what is said.
const SETTINGS: &[(&str, &str)] = &[
    ("pid.kp=3", r##"loads"##),
    ("diagram.pid.kp=3", r##"loads"##),
    (
        "pdi.kp=3",
        r##"--set:1:1: error: `pdi.kp`: the diagram has no block `pdi`
  help: blocks: `pid`"##,
    ),
    ("shoulder.damping=3", r##"loads"##),
    (
        "pid.kq=3",
        r##"--set:1:1: error: block `pid`: `pid` has no parameter `kq`
  help: it has kp, ki, kd, filter_time_constant, lower, upper, anti_windup, tracking_time_constant, output_time_constant, separate, setpoint_weight, derivative_setpoint_weight, feedforward, initial, initial_input"##,
    ),
    (
        "pid.kp=true",
        r##"--set:1:8: error: block `pid`: `kp` is not a number
  help: write a number, or a formula of the diagram's parameters in quotes"##,
    ),
    (
        "pid.kp=fast",
        r##"--set:1:8: error: block `pid`: unknown name `fast`
  help: it knows k"##,
    ),
    (
        "pid.type=pdi",
        r##"--set:1:10: error: there is no block type `pdi` (block `pid`)
  help: `sincro blocks` lists every block with its parameters"##,
    ),
    (
        "pid=3",
        r##"--set:1:1: error: `pid`: a scene or experiment has no `pid`
  help: keys: `spring_damper`, `wind`, `air_density`, `plot`, `seed`, `body`, `title`, `units` and 39 more"##,
    ),
    (
        "diagram.pid=3",
        r##"--set:1:1: error: `diagram.pid` names a block, none of its parameters
  help: write diagram.pid.PARAMETER=VALUE"##,
    ),
    (
        "diagram.=3",
        r##"--set:1:1: error: `diagram.` names nothing
  help: write BLOCK.PARAMETER=VALUE, such as pid.kp=3"##,
    ),
    (
        ".=3",
        r##"--set:1:1: error: `.` names nothing
  help: write BLOCK.PARAMETER=VALUE, such as pid.kp=3"##,
    ),
    ("pid.kp.x=3", r##"--set:1:1: error: `pid.kp.x`: there is nothing inside a number"##),
    ("pid.kp[1]=3", r##"--set:1:1: error: `pid.kp[1]`: there is nothing inside a number"##),
    (
        "sample_time=0.003",
        r##"--set:1:1: error: `sample_time`: a scene or experiment has no `sample_time`
  help: keys: `plot`, `parameters`, `simulation_step`, `frame`, `campaign`, `spring_damper`, `rest_speed`, `initial_pose` and 39 more"##,
    ),
    (
        "diagram.sample_time=0.003",
        r##"--set:1:21: error: `pid` is a continuous block (pid) and cannot have a sample time
  help: leave `sample_time` out, or use a block of the discrete category"##,
    ),
    (
        "diagram=nowhere.toml",
        r##"--set:1:9: error: there is no file `nowhere.toml`
  help: files there: `diagram.toml`, `experiment.toml`, `scene.toml`"##,
    ),
    (
        "diagram=scene.toml",
        r##"scene.toml:1:1: error: unknown key `gravity`
  help: keys here: `block`, `diagram`, `parameters`, `sample_time`, `wires`
scene.toml:3:3: error: unknown key `joint`
  help: keys here: `block`, `diagram`, `parameters`, `sample_time`, `wires`
scene.toml:12:3: error: unknown key `body`
  help: keys here: `block`, `diagram`, `parameters`, `sample_time`, `wires`
scene.toml:18:3: error: unknown key `frame`
  help: keys here: `block`, `diagram`, `parameters`, `sample_time`, `wires`"##,
    ),
];
