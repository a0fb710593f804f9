//! Diagrams far larger than anyone draws by hand, and such as grow without end: opened fast, or refused.

use std::time::Instant;

use sincro_testing::scenes;

/// Opens the folder of the sprung arm with a diagram; what is said, and how long it took `[s]`.
fn open(diagram: &str) -> (String, f64) {
    let folder = scenes::sprung_arm();
    let experiment = "title = \"T\"\nscene = \"scene.toml\"\ndiagram = \"diagram.toml\"\nduration = 1.0\nstep = 0.01\nrecord = [\"/shoulder.position\"]\n";
    folder.write("experiment.toml", experiment);
    folder.write("diagram.toml", diagram);
    let clock = Instant::now();
    let said = folder.load(&[]).map_or_else(|message| message, |_| "loads".into());
    (said, clock.elapsed().as_secs_f64())
}

fn gains(numbers: impl Iterator<Item = usize>) -> String {
    numbers.map(|k| format!("[[block]]\nname = \"g{k}\"\ntype = \"gain\"\ngain = 1\n")).collect()
}

fn chain(n: usize) -> String {
    (1..n).map(|k| format!("\"g{} -> g{k}\",\n", k - 1)).collect()
}

/// Generous: what is quadratic takes minutes.
const SECONDS: f64 = 20.0;

#[track_caller]
fn assert_said(what: &str, diagram: &str, expected: &str) {
    let (said, seconds) = open(diagram);
    println!("{what}: {seconds:.2} s");
    assert!(said.contains(expected), "{what}: {}", said.chars().take(2000).collect::<String>());
    assert!(seconds < SECONDS, "{what}: {seconds} s");
}

#[test]
fn a_long_chain_opens_fast_in_either_order() {
    for n in [1000, 5000] {
        let wires = format!("wires = [\"/shoulder.position -> g0\",\n{}]\n", chain(n));
        assert_said(&format!("chain of {n}"), &format!("{wires}{}", gains(0..n)), "loads");
        assert_said(&format!("chain of {n}, last first"), &format!("{wires}{}", gains((0..n).rev())), "loads");
    }
}

#[test]
fn a_long_loop_is_found_fast() {
    let n = 5000;
    let wires = format!("wires = [\"g{} -> g0\",\n{}]\n", n / 2, chain(n));
    assert_said("loop", &format!("{wires}{}", gains(0..n)), "algebraic loop: g0 -> g1 -> g2");
}

#[test]
fn a_hundred_thousand_wires_open_fast() {
    let n = 100_000;
    let wires: String = (0..n).map(|k| format!("\"/shoulder.position -> m.u{}\",\n", k + 1)).collect();
    let mux = "[[block]]\nname = \"m\"\ntype = \"mux\"\ninputs = 10000\n";
    assert_said("wires into ports that there are not", &format!("wires = [{wires}]\n{mux}"), "has no input");
    let wires: String = (0..n).map(|_| "\"/shoulder.position -> g0\",\n".to_owned()).collect();
    assert_said("wires into one port", &format!("wires = [{wires}]\n{}", gains(0..1)), "two wires go into `g0`");
    let wires: String = (0..n).map(|_| "\"a b\",\n".to_owned()).collect();
    assert_said("wires that are none", &format!("wires = [{wires}]\n"), "is no wire");
}

fn nested(n: usize, block: impl Fn(usize) -> String, wires: &str) -> String {
    let top = "wires = [\"/shoulder.position -> x -> end\"]\n[[block]]\nname = \"end\"\ntype = \"terminator\"\n[[block]]\nname = \"x\"\ntype = \"d0\"\n";
    let ports = "inputs = [\"u\"]\noutputs = [\"y\"]\n";
    let definition = |k| format!("[[diagram]]\nname = \"d{k}\"\n{ports}wires = {wires}\n{}", block(k));
    let last = format!("[[diagram]]\nname = \"d{n}\"\n{ports}wires = [\"u -> y\"]\n");
    format!("{top}{}{last}", (0..n).map(definition).collect::<String>())
}

fn inner(name: &str, k: usize) -> String {
    format!("[[diagram.block]]\nname = \"{name}\"\ntype = \"d{}\"\n", k + 1)
}

#[test]
fn deep_nesting_is_possible_and_endless_growth_refused() {
    let one = |k| inner("i", k);
    assert_said("200 deep", &nested(200, one, "[\"u -> i -> y\"]"), "loads");
    assert_said("300 deep", &nested(300, one, "[\"u -> i -> y\"]"), "more than 256 diagrams are nested");
    let two = |k| format!("{}{}", inner("i", k), inner("j", k));
    assert_said("2^40 blocks", &nested(40, two, "[\"u -> i -> j -> y\"]"), "more than 100000 blocks");
    // each puts its input together with itself
    assert_said("2^40 components", &nested(40, one, "[\"[u, u] -> i\", \"i -> y\"]"), "more than 100000 blocks");
    let wires: String = (1..60).map(|k| format!("\"[g{}, g{}] -> g{k}\",", k - 1, k - 1)).collect();
    let wide = format!("wires = [\"/shoulder.position -> g0\", {wires}]\n{}", gains(0..60));
    assert_said("a width of 2^59", &wide, "at most 1000000 are possible");
}
