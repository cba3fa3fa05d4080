//! `completions` and `man`: what shells and `man` know of the program, made from its command line.

use super::output::{print_line, remark, write_file};
use anyhow::Context;
use clap::Command;
use clap_complete::Shell;
use std::path::{Path, PathBuf};
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

/// Writes the page of a command, and those of its own commands.
fn pages(of: &Command, folder: &Path) -> anyhow::Result<()> {
    let page = clap_mangen::Man::new(of.clone());
    let mut text = Vec::new();
    page.render(&mut text)?;
    write_file(&folder.join(page.get_filename()), text)?;
    of.get_subcommands().filter(|own| !own.is_hide_set()).try_for_each(|own| pages(own, folder))
}

/// Writes the manual pages of `program`.
pub fn man(args: &ManArgs, program: Command) -> anyhow::Result<ExitCode> {
    let shown = args.folder.display();
    std::fs::create_dir_all(&args.folder).with_context(|| format!("cannot make folder {shown}"))?;
    let mut program = program.disable_help_subcommand(true);
    program.build();
    pages(&program, &args.folder)?;
    remark(&format!("pages in {shown}: man -l {}", args.folder.join("lodray.1").display()))?;
    Ok(ExitCode::SUCCESS)
}
