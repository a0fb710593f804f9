//! `cargo xtask`: the project's own chores, in Rust alone.
//!
//! - `check`: formatting, lints, tidiness, tests, packages, documentation; ends with a summary. `--tested`: without the
//!   tests of the release build, where these have just run.
//! - `tidy`: the checks of `check` that need no compiler: tree, arrows, words, manifests.
//! - `bless`: rewrites generated files (schemas, trace hashes) after a change that is meant.
//! - `dist`: builds the program and the library of FMUs as they are given away (profile `dist`), packs them as
//!   `.tar.gz` and `.deb`; fails if one is too large. `--glibc 2.28`: for systems with that glibc or a newer one (needs
//!   `cargo-zigbuild`).
//! - `judge NAME`: compares with other programs and public files, and writes the page of it.
//! - `book-links`: preprocessor that `mdbook build` calls; see `book.toml`.
//! - `api-sample`: prints 30 public items with their documentation, drawn at random, for a person to grade.

mod book;
mod dist;
mod examples;
mod glossary;
mod items;
mod judge;
mod modules;
mod package;
mod sample;
mod tidy;
mod words;

use std::path::{Path, PathBuf};
use std::process::{Command, ExitCode};

fn main() -> ExitCode {
    match std::env::args().nth(1).as_deref() {
        Some("check") => check(),
        Some("bless") => bless(),
        Some("tidy") => exit(tidy::check(&root())),
        Some("dist") => exit(dist()),
        Some("judge") => exit(judge::run(&root(), std::env::args().nth(2).as_deref())),
        Some("book-links") => exit(book::preprocess()),
        Some("api-sample") => exit(sample::print(&root())),
        _ => {
            eprintln!(
                "usage: cargo xtask check [--tested] | tidy | bless | dist [--glibc VERSION] | judge NAME | book-links | api-sample"
            );
            ExitCode::from(2)
        }
    }
}

fn dist() -> bool {
    let arguments: Vec<String> = std::env::args().skip(2).collect();
    let request = match dist::Request::read(&arguments) {
        Ok(request) => request,
        Err(message) => {
            eprintln!("{message}");
            return false;
        }
    };
    let build: Vec<String> = request.build();
    let build: Vec<&str> = build.iter().map(String::as_str).collect();
    runs(&mut cargo(&build)) && request.holds(&root()) && dist::pack(&root(), &request)
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

fn exit(holds: bool) -> ExitCode {
    if holds { ExitCode::SUCCESS } else { ExitCode::FAILURE }
}

/// Runs a command; true if it succeeded.
fn runs(command: &mut Command) -> bool {
    println!("$ {command:?}");
    command.status().is_ok_and(|status| status.success())
}

/// All checks. `--tested` leaves out the tests of the default build: `.ci/run` has just made them.
fn check() -> ExitCode {
    let is_tested = std::env::args().any(|argument| argument == "--tested");
    let package = ["package", "--workspace", "--no-verify", "--allow-dirty", "--offline", "--quiet"];
    let lints =
        ["clippy", "--workspace", "--all-targets", "--release", "--features", "sincro/jit", "--", "-D", "warnings"];
    // one debug build, with the feature whose code the tests of the default build do not have
    let debug = ["test", "--package", "sincro-sim", "--package", "sincro-compile", "--features", "sincro-sim/jit"];
    let regressions = [&debug[..], &["--test", "regressions"]].concat();
    let compiled = [&debug[..], &["--test", "jit", "--test", "compiled_equations"]].concat();
    let steps = [
        ("formatting", runs(&mut cargo(&["fmt", "--all", "--check"]))),
        ("tidy", tidy::check(&root())),
        ("lints", runs(&mut cargo(&lints))),
        ("tests", is_tested || runs(&mut cargo(&["test", "--workspace", "--release"]))),
        // the committed hashes were made by a release build
        ("the same bits in a debug build", runs(cargo(&regressions).env("SINCRO_COMPILE", "off"))),
        ("equations compiled in memory", runs(&mut cargo(&compiled))),
        ("packages", runs(&mut cargo(&package))),
        (
            "documentation",
            runs(cargo(&["doc", "--workspace", "--no-deps", "--release"]).env("RUSTDOCFLAGS", "-D warnings")),
        ),
    ];
    println!();
    for (name, holds) in &steps {
        println!("{}  {name}", if *holds { "ok  " } else { "FAIL" });
    }
    exit(steps.iter().all(|(_, holds)| *holds))
}

fn bless() -> ExitCode {
    let packages = ["--package", "sincro-scene", "--package", "sincro-sim", "--package", "sincro-remote"];
    exit(runs(cargo(&["test", "--release"]).args(packages).env("SINCRO_BLESS", "1")))
}
