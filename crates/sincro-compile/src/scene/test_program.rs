//! The self-test in C, and the hash that it must find.

use core::fmt::Write;

use super::Request;
use super::parts::{Function, N_SAMPLES, Parts, sample};
use crate::c::number;
use crate::diagram::Computed;
use crate::diagram::is_due;

/// Longest table of values of sources in a self-test; a longer experiment is tested over its first part.
const MAX_CHANGES: usize = 20_000;

/// Self-test of an exported scene.
pub(super) struct TestProgram {
    pub text: String,
    pub hash: u64,
    pub n_steps: usize,
}

/// FNV-1a over the bytes of numbers, low byte first. Source: Fowler, Noll, Vo; 64 bits.
struct Hash(u64);

impl Hash {
    fn add(&mut self, x: f64) {
        let bits = if x.is_nan() { 0x7ff8_0000_0000_0000 } else { x.to_bits() };
        for byte in bits.to_le_bytes() {
            self.0 = (self.0 ^ u64::from(byte)).wrapping_mul(0x100_0000_01b3);
        }
    }
}

/// Value of a source that changes at a tick.
struct Change {
    tick: usize,
    signal: usize,
    value: f64,
}

impl TestProgram {
    pub(super) fn new(request: &Request<'_>, parts: &Parts) -> Self {
        let mut hash = Hash(0xcbf2_9ce4_8422_2325);
        for function in &parts.functions {
            for k in 0..N_SAMPLES {
                let results = function.program.evaluate(&sample(k, function.program.n_inputs()), 0);
                results.into_iter().for_each(|x| hash.add(x));
            }
        }
        let (mut changes, mut n_steps) = (Vec::new(), 0);
        if parts.is_closed {
            (changes, n_steps) = source_changes(request, parts);
            for tick in &request.reference[..=n_steps] {
                [&tick.q, &tick.v, &tick.rotors].into_iter().flatten().for_each(|x| hash.add(*x));
            }
        }
        let text = text(request, parts, &changes, n_steps, hash.0);
        Self { text, hash: hash.0, n_steps }
    }
}

/// Changes of the controller's sources over the reference run, and the number of steps that they cover.
fn source_changes(request: &Request<'_>, parts: &Parts) -> (Vec<Change>, usize) {
    let n_steps = request.reference.len().saturating_sub(1);
    let (Some(diagram), Some(controller)) = (request.diagram, &parts.controller) else { return (Vec::new(), n_steps) };
    let (steps, mut changes) = (&diagram.wiring.program().steps, Vec::new());
    let mut held = controller.signals.clone();
    for (tick, reference) in request.reference.iter().enumerate() {
        let sources = controller.blocks.iter().filter(|block| matches!(block.output, Computed::Source));
        for block in sources.filter(|block| is_due(steps[block.step].rate, tick as u64)) {
            for signal in steps[block.step].out.clone() {
                let value = reference.signals[signal];
                if value.to_bits() != held[signal].to_bits() {
                    held[signal] = value;
                    changes.push(Change { tick, signal, value });
                }
            }
        }
        if changes.len() > MAX_CHANGES {
            changes.retain(|change| change.tick < tick);
            return (changes, tick - 1);
        }
    }
    (changes, n_steps)
}

fn text(request: &Request<'_>, parts: &Parts, changes: &[Change], n_steps: usize, hash: u64) -> String {
    let name = request.name;
    let mut text = format!(
        r#"/* Self-test of {name}: every bit of what the functions give, and of every state of the experiment, by a hash.
   Exit status 0 if it is the expected one. Without an operating system: call {name}_self_test(). */
#include <stdint.h>
#include "{name}.h"

#define EXPECTED_HASH UINT64_C(0x{hash:016x})

static uint64_t hash;

static void add(const double *x, int n) {{
    int k, byte;
    for (k = 0; k < n; k++) {{
        union {{ double number; uint64_t bits; }} both;
        both.number = x[k];
        if (x[k] != x[k]) both.bits = UINT64_C(0x7ff8000000000000);
        for (byte = 0; byte < 8; byte++) {{
            hash = (hash ^ ((both.bits >> (8 * byte)) & 0xff)) * UINT64_C(0x100000001b3);
        }}
    }}
}}
"#
    );
    if !parts.functions.is_empty() {
        text += &functions_test(name, &parts.functions);
    }
    if parts.is_closed {
        text += &experiment_test(request, parts, changes, n_steps);
    }
    _ = write!(
        text,
        r"
/* Returns 1 if every bit is as expected. */
int {name}_self_test(void) {{
    hash = UINT64_C(0xcbf29ce484222325);
{}{}    return hash == EXPECTED_HASH;
}}

uint64_t {name}_self_test_hash(void) {{
    return hash;
}}

#if !defined(SINCRO_NO_MAIN)
#if __STDC_HOSTED__ && !defined(SINCRO_NO_STDIO)
#include <stdio.h>
int main(void) {{
    const int is_good = {name}_self_test();
    printf(is_good ? {ok} : {bad}, (unsigned long)(hash >> 32), (unsigned long)(hash & 0xffffffffu));
    return is_good ? 0 : 1;
}}
#else
int main(void) {{
    return {name}_self_test() ? 0 : 1;
}}
#endif
#endif
",
        if parts.functions.is_empty() { "" } else { "    functions();\n" },
        if parts.is_closed { "    experiment();\n" } else { "" },
        ok = format_args!("\"{name}: %08lx%08lx, as expected\\n\""),
        bad = format_args!(
            "\"{name}: %08lx%08lx, not {hash:016x}: this compiler contracts or reorders operations; try \"\n           \"-ffp-contract=off -fno-tree-slp-vectorize, and not -ffast-math\\n\""
        ),
    );
    text
}

fn functions_test(name: &str, functions: &[Function]) -> String {
    let most = |of: &dyn Fn(&Function) -> usize| functions.iter().map(of).max().unwrap_or(0).max(1);
    let n_inputs = most(&|f| f.program.n_inputs());
    let n_outputs = most(&|f| f.program.outputs().len());
    let mut text = format!(
        r"
/* Pseudo-random number n of stream k in [-2, 2). */
static double sample(uint64_t k, uint64_t n) {{
    uint64_t z = k + (n + 1) * UINT64_C(0x9e3779b97f4a7c15);
    z = (z ^ (z >> 30)) * UINT64_C(0xbf58476d1ce4e5b9);
    z = (z ^ (z >> 27)) * UINT64_C(0x94d049bb133111eb);
    z = z ^ (z >> 31);
    return (double)(z >> 11) * {} - 2.0;
}}

static void functions(void) {{
    static double in[{n_inputs}], out[{n_outputs}];
    uint64_t k;
    int n;
",
        number(4.0 / (1u64 << 53) as f64)
    );
    for function in functions {
        let (mut arguments, mut at) = (Vec::new(), 0);
        for (_, n) in function.inputs.iter().filter(|(_, n)| *n > 0) {
            arguments.push(format!("in + {at}"));
            at += n;
        }
        let mut at = 0;
        for (_, n) in function.outputs.iter().filter(|(_, n)| *n > 0) {
            arguments.push(format!("out + {at}"));
            at += n;
        }
        _ = writeln!(
            text,
            "    for (k = 0; k < {N_SAMPLES}; k++) {{\n        for (n = 0; n < {}; n++) in[n] = sample(k, (uint64_t)n);\n        {name}_{}({});\n        add(out, {at});\n    }}",
            function.program.n_inputs(),
            function.name,
            arguments.join(", ")
        );
    }
    text + "}\n"
}

fn experiment_test(request: &Request<'_>, parts: &Parts, changes: &[Change], n_steps: usize) -> String {
    let name = request.name;
    let mut text = String::new();
    if !changes.is_empty() {
        text += "\n/* Values of the sources, where they change. */\nstatic const struct { int tick, signal; double value; } changes[] = {\n";
        for Change { tick, signal, value } in changes {
            _ = writeln!(text, "    {{{tick}, {signal}, {}}},", number(*value));
        }
        text += "};\n";
    }
    let adds: String =
        [("q", request.model.n_q()), ("v", request.model.n_v()), ("elements", request.model.n_rotor_states())]
            .into_iter()
            .filter(|(_, n)| *n > 0)
            .map(|(field, n)| format!("        add(plant.{field}, {n});\n"))
            .collect();
    if parts.controller.is_none() {
        return text
            + &format!(
                r"
static void experiment(void) {{
    static {name}_plant plant;
    int tick;
    {name}_plant_init(&plant);
    for (tick = 0;; tick++) {{
{adds}        if (tick == {n_steps}) break;
        {name}_plant_step(&plant);
    }}
}}
"
            );
    }
    let sources = if changes.is_empty() {
        String::new()
    } else {
        format!(
            "        for (; next < {0} && changes[next].tick == tick; next++) {{\n            controller.signals[changes[next].signal] = changes[next].value;\n        }}\n",
            changes.len()
        )
    };
    let next = if changes.is_empty() { "" } else { "    int next = 0;\n" };
    text + &format!(
        r"
static void experiment(void) {{
    static {name}_plant plant;
    static {name}_controller controller;
    int tick;
{next}    {name}_plant_init(&plant);
    {name}_controller_init(&controller);
    for (tick = 0;; tick++) {{
        {name}_measure(&plant, &controller);
{sources}        {name}_controller_evaluate(&controller);
{adds}        if (tick == {n_steps}) break;
        {name}_command(&controller, &plant);
        {name}_controller_update(&controller);
        {name}_plant_step(&plant);
    }}
}}
"
    )
}
