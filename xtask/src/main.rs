//! `cargo xtask`: the project's own chores, in Rust alone.
//!
//! - `check`: formatting, lints, tidiness, tests, documentation; stops at the end with a summary.
//! - `tidy`: the part of `check` that compiles nothing.
//! - `bless`: rewrites generated files (schemas, trace hashes) after a change that is meant.

mod modules;
mod tidy;

use std::path::{Path, PathBuf};
use std::process::{Command, ExitCode};

fn main() -> ExitCode {
    match std::env::args().nth(1).as_deref() {
        Some("check") => check(),
        Some("tidy") => ExitCode::from(u8::from(!tidy::check(&root()))),
        Some("bless") => bless(),
        _ => {
            eprintln!("usage: cargo xtask check | tidy | bless");
            ExitCode::from(2)
        }
    }
}

/// The workspace's folder.
fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("..")
}

fn cargo(arguments: &[&str]) -> Command {
    let mut command = Command::new(std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into()));
    command.args(arguments).current_dir(root());
    command
}

/// Runs a command; whether it succeeded.
fn runs(command: &mut Command) -> bool {
    println!("$ {command:?}");
    command.status().is_ok_and(|status| status.success())
}

fn check() -> ExitCode {
    let debug_regressions = ["test", "--package", "sincro-sim", "--test", "regressions"];
    let steps = [
        ("formatting", runs(&mut cargo(&["fmt", "--all", "--check"]))),
        ("tidy", tidy::check(&root())),
        ("lints", runs(&mut cargo(&["clippy", "--workspace", "--all-targets", "--release", "--", "-D", "warnings"]))),
        ("tests", runs(&mut cargo(&["test", "--workspace", "--release"]))),
        // the committed hashes were made by a release build
        ("the same bits in a debug build", runs(&mut cargo(&debug_regressions))),
        (
            "documentation",
            runs(cargo(&["doc", "--workspace", "--no-deps", "--release"]).env("RUSTDOCFLAGS", "-D warnings")),
        ),
    ];
    println!();
    for (name, holds) in &steps {
        println!("{}  {name}", if *holds { "ok  " } else { "FAIL" });
    }
    if steps.iter().all(|(_, holds)| *holds) { ExitCode::SUCCESS } else { ExitCode::FAILURE }
}

fn bless() -> ExitCode {
    let done = runs(cargo(&["test", "--package", "sincro-sim", "--release"]).env("SINCRO_BLESS", "1"));
    if done { ExitCode::SUCCESS } else { ExitCode::FAILURE }
}
