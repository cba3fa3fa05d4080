//! The `lodray` program.

mod cli;

use clap::Parser;
use std::process::ExitCode;

fn main() -> ExitCode {
    match cli::run(cli::Cli::parse()) {
        Ok(code) => code,
        Err(error) => {
            // The whole chain on one line: what was tried, then why it failed.
            eprintln!("error: {error:#}");
            ExitCode::FAILURE
        }
    }
}
