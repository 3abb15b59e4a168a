//! The `ambray` program; everything is in the library beside it.
#![forbid(unsafe_code)]

use std::process::ExitCode;

fn main() -> ExitCode {
    ambray_cli::run(std::env::args_os())
}
