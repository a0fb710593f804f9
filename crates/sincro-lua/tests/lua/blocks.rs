//! Laws in Lua as blocks of a diagram.

use sincro_dynamics::world::MethodKind;
use sincro_scene::diagnostic::Diagnostics;
use sincro_sim::Loaded;
use sincro_sim::results::Status;
use sincro_sim::run::LockStep;

use super::world::{EXPERIMENT, PENDULUM, open, run};

/// The pendulum with a block of these keys between its angle and its motor.
fn with_block(keys: &str) -> Result<Loaded, Diagnostics> {
    let experiment = format!("diagram = \"law.toml\"\n{EXPERIMENT}");
    let diagram = format!(
        "wires = [\"/hinge.position -> law\", \"law -> /hinge\"]\n[[block]]\nname = \"law\"\ntype = \"lua\"\n{keys}\n"
    );
    open(&[("scene.toml", PENDULUM), ("experiment.toml", &experiment), ("law.toml", &diagram), ("law.lua", INTEGRAL)])
}

/// An integral controller: what it remembers stands in `memory`.
const INTEGRAL: &str = "function output(t, u, memory)
  return -kp * u.u - memory.sum
end
function update(t, u, memory)
  memory.sum = memory.sum + 0.01 * u.u
end
";

#[test]
fn what_a_block_remembers_is_in_the_snapshot() {
    let keys = "file = \"law.lua\"\nmemory = { sum = 0.25 }\nparameters = { kp = 20 }";
    let loaded = with_block(keys).unwrap_or_else(|problems| panic!("{problems}"));
    let mut run = LockStep::new(&loaded, MethodKind::Rk4, false);
    let mut trace = run.trace();
    run.start().unwrap();
    let go = |run: &mut LockStep, trace: &mut _, n: usize| {
        for _ in 0..n {
            run.advance().unwrap();
            run.hash_into(trace);
        }
    };
    go(&mut run, &mut trace, 50);
    let snapshot = run.snapshot(trace);
    go(&mut run, &mut trace, 50);
    let mut other = LockStep::new(&loaded, MethodKind::Rk4, false);
    other.restore(&snapshot);
    let mut resumed = snapshot.trace;
    go(&mut other, &mut resumed, 50);
    assert_eq!(resumed, trace);
}

#[test]
fn a_block_cannot_remember_behind_the_diagrams_back() {
    let keys = "code = \"n = 0\\nfunction output(t, u) n = n + 1 return n end\"";
    let Status::Stopped { reason, .. } = run(&with_block(keys).unwrap()).status else { panic!("it ran") };
    let expected = "line 2, `function output(t, u) n = n + 1 return n end`: `n` cannot be set: a block keeps what it remembers in `memory`";
    assert!(reason.contains(expected) && reason.contains("block `law` (lua) failed in tick 0"), "{reason}");
}

#[test]
fn what_is_wrong_with_a_block_is_told_before_anything_runs() {
    let refused = |keys: &str| with_block(keys).unwrap_err().to_string();
    let cases = [
        ("code = \"x = = 3\"", "line 1, `x = = 3`: unexpected symbol near '='"),
        ("code = \"x = 3\"", "the text has no function `output`"),
        ("code = \"function output(t, u) return 1 end\"\nmemory = { a = 1 }", "the text has no function `update`"),
        ("", "`lua` needs `code` or `file`"),
        ("code = \"x\"\nfile = \"law.lua\"", "`code` and `file` are both given"),
        ("file = \"other.lua\"", "there is no file"),
        ("code = \"function output() return 1 end\"\noutputs = [\"y[x]\"]", "`y[x]` is no output"),
        ("code = \"while true do end\"", "one call took more than 20000000 instructions"),
    ];
    for (keys, expected) in cases {
        let text = refused(keys);
        assert!(text.contains("law.toml:") && text.contains(expected), "{keys}: {text}");
    }
}

#[test]
fn outputs_of_the_wrong_form_stop_the_run() {
    let cases = [
        ("return 'x'", "output: `y` is a string, expected a number"),
        ("return 1, 2", "output: 2 values are returned, the block has 1 outputs"),
        ("return { 1, 2 }", "output: `y` has 2 numbers, expected 1"),
        ("return u.w + 1", "attempt to perform arithmetic on a nil value (field 'w')"),
        ("return 0 / 0", "gave"),
    ];
    for (text, expected) in cases {
        let keys = format!("code = \"function output(t, u) {text} end\"");
        let Status::Stopped { reason, .. } = run(&with_block(&keys).unwrap()).status else { panic!("{text} ran") };
        assert!(reason.contains(expected), "{text}: {reason}");
    }
}
