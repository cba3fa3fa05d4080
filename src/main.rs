//! The `lodray` program.

mod cli;

use clap::Parser;
use lodray::study::one_line;
use std::process::ExitCode;

fn main() -> ExitCode {
    cli::set_color(cli::color(std::env::args_os().skip(1)));
    match cli::Cli::try_parse().map_or_else(|error| refused_or_shown(&error), cli::run) {
        Ok(code) => code,
        Err(error) => {
            cli::complain("error:", &one_line(&*error));
            ExitCode::FAILURE
        }
    }
}

/// Ends with a complaint about the command line, or shows the help that it asks for.
fn refused_or_shown(error: &clap::Error) -> anyhow::Result<ExitCode> {
    if error.use_stderr() {
        error.exit();
    }
    cli::unless_closed(error.print())?;
    Ok(ExitCode::SUCCESS)
}
