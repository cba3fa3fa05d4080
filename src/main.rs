//! The `lodray` program.

mod cli;

use clap::Parser;
use std::process::ExitCode;

fn main() -> ExitCode {
    cli::set_color(cli::color(std::env::args_os().skip(1)));
    match cli::run(cli::Cli::parse()) {
        Ok(code) => code,
        Err(error) => {
            cli::complain("error:", &one_line(&error));
            ExitCode::FAILURE
        }
    }
}

/// The whole chain on one line: what was tried, then why it failed, leaving out causes that the error before already spells out.
fn one_line(error: &anyhow::Error) -> String {
    error.chain().map(ToString::to_string).fold(String::new(), |line, cause| match line.as_str() {
        "" => cause,
        said if said.ends_with(&cause) => line,
        _ => format!("{line}: {cause}"),
    })
}
