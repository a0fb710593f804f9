//! The command line `sincro` as a program.

use std::path::Path;
use std::process::Command;

/// A program under test.
#[derive(Clone, Copy, Debug)]
pub struct CommandLine {
    program: &'static str,
}

/// Result of one call: output as text and exit status.
#[derive(Clone, Debug)]
pub struct Exit {
    /// Standard output.
    pub stdout: String,
    /// Standard error.
    pub stderr: String,
    /// Exit status; −1 if a signal ended the program.
    pub status: i32,
}

impl Exit {
    fn of(command: &mut Command) -> Self {
        let output = command.output().unwrap();
        let text = |bytes: Vec<u8>| String::from_utf8(bytes).unwrap();
        Self { stdout: text(output.stdout), stderr: text(output.stderr), status: output.status.code().unwrap_or(-1) }
    }
}

impl CommandLine {
    /// The program at a path: `CommandLine::new(env!("CARGO_BIN_EXE_sincro"))`.
    #[must_use]
    pub const fn new(program: &'static str) -> Self {
        Self { program }
    }

    /// A command that is still to be started.
    #[must_use]
    pub fn command(self, arguments: &[&str]) -> Command {
        let mut command = Command::new(self.program);
        command.args(arguments);
        command
    }

    /// Calls the program and waits for its end.
    #[must_use]
    pub fn call(self, arguments: &[&str]) -> Exit {
        Exit::of(&mut self.command(arguments))
    }

    /// Calls the program in a folder and waits for its end: standard output, standard error, exit status.
    #[must_use]
    pub fn call_in(self, folder: &Path, arguments: &[&str]) -> (String, String, i32) {
        let exit = Exit::of(self.command(arguments).current_dir(folder));
        (exit.stdout, exit.stderr, exit.status)
    }

    /// `run SCENE --out OUT` with more flags.
    #[must_use]
    pub fn run(self, scene: &Path, out: &Path, more: &[&str]) -> Exit {
        let fixed = ["run", scene.to_str().unwrap(), "--out", out.to_str().unwrap()];
        self.call(&[&fixed, more].concat())
    }
}
