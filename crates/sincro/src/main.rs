//! The program `sincro`; see [`sincro::command_line`].

use std::process::ExitCode;

fn main() -> ExitCode {
    sincro::command_line::run(std::env::args_os()).into()
}
