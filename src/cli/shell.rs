//! `completions` and `man`: what shells and `man` know of the program, made from its command line.

use super::output::{print_line, remark};
use anyhow::Context;
use clap::Command;
use clap_complete::Shell;
use std::path::PathBuf;
use std::process::ExitCode;

const NAME: &str = "lodray";

#[derive(clap::Args)]
pub struct CompletionsArgs {
    /// Shell
    shell: Shell,
}

#[derive(clap::Args)]
pub struct ManArgs {
    /// Folder for the pages: lodray.1, and one for each command
    folder: PathBuf,
}

/// Prints the script that completes commands and options of `program` in a shell.
pub fn completions(args: &CompletionsArgs, mut program: Command) -> anyhow::Result<ExitCode> {
    let mut script = Vec::new();
    clap_complete::generate(args.shell, &mut program, NAME, &mut script);
    print_line(String::from_utf8(script)?.trim_end())?;
    Ok(ExitCode::SUCCESS)
}

/// Writes the manual pages of `program`.
pub fn man(args: &ManArgs, program: Command) -> anyhow::Result<ExitCode> {
    let shown = args.folder.display();
    std::fs::create_dir_all(&args.folder).with_context(|| format!("cannot make folder {shown}"))?;
    clap_mangen::generate_to(program, &args.folder).with_context(|| format!("cannot write to {shown}"))?;
    remark(&format!("pages in {shown}: man -l {}", args.folder.join("lodray.1").display()))?;
    Ok(ExitCode::SUCCESS)
}
