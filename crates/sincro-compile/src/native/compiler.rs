//! The system's C compiler as a process.

use std::io::{Read, Write};
use std::path::Path;
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

/// Longest time for a compilation.
const TIME_LIMIT: Duration = Duration::from_secs(60);

/// Options of the compiler for this processor: the instruction set of its lanes (eight: AVX-512, four: AVX2), neither
/// fused operations nor others that change a bit.
pub(super) fn options() -> Vec<&'static str> {
    let mut options = vec![
        "-O2",
        "-fschedule-insns",
        "-fsched-pressure",
        "-fno-math-errno",
        "-ffp-contract=off",
        "-fPIC",
        "-shared",
        "-nostdlib",
        "-w",
    ];
    match sincro_math::lanes::width() {
        8 => options.extend(["-mavx512f", "-mavx512dq", "-mavx512vl", "-mprefer-vector-width=512"]),
        4 => options.push("-mavx2"),
        _ => {}
    }
    options
}

/// Name of the compiler: `CC` of the environment, or `cc`.
pub(super) fn name() -> String {
    std::env::var("CC").ok().filter(|name| !name.trim().is_empty()).unwrap_or_else(|| "cc".to_owned())
}

/// Compiles `text` to the shared library `to`; an error says why not, in words that continue "it is not compiled: ".
pub(super) fn run(text: &str, options: &[&str], to: &Path) -> Result<(), String> {
    let name = name();
    // `CC` may have options of its own
    let mut words = name.split_whitespace();
    let program = words.next().unwrap_or("cc");
    let mut child = Command::new(program)
        .args(words)
        .args(options)
        .arg("-o")
        .arg(to)
        .args(["-x", "c", "-"])
        .stdin(Stdio::piped())
        .stdout(Stdio::null())
        .stderr(Stdio::piped())
        .spawn()
        .map_err(|error| format!("the C compiler `{name}` cannot be started: {error}"))?;
    if let Some(mut input) = child.stdin.take() {
        // a compiler that reads no further says why
        _ = input.write_all(text.as_bytes());
    }
    let deadline = Instant::now() + TIME_LIMIT;
    let status = loop {
        match child.try_wait() {
            Ok(Some(status)) => break status,
            Ok(None) if Instant::now() < deadline => std::thread::sleep(Duration::from_millis(2)),
            ended => {
                _ = child.kill();
                _ = child.wait();
                return Err(match ended {
                    Err(error) => format!("the C compiler `{name}` was lost: {error}"),
                    Ok(_) => format!("the C compiler `{name}` took more than {} s", TIME_LIMIT.as_secs()),
                });
            }
        }
    };
    if status.success() {
        return Ok(());
    }
    let mut message = String::new();
    if let Some(stderr) = child.stderr.take() {
        // the start says what is wrong
        _ = stderr.take(2000).read_to_string(&mut message);
    }
    let first = message.lines().find(|line| line.contains("error")).unwrap_or("no message");
    Err(format!("the C compiler `{name}` failed ({status}): {}", first.trim()))
}
