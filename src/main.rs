//! The `lodray` program.

mod cli;

use clap::Parser;
use lodray::study::one_line;
use std::process::ExitCode;

fn main() -> ExitCode {
    cli::set_color(cli::color(std::env::args_os().skip(1)));
    match cli::run(cli::Cli::parse()) {
        Ok(code) => code,
        Err(error) => {
            cli::complain("error:", &one_line(&*error));
            ExitCode::FAILURE
        }
    }
}
