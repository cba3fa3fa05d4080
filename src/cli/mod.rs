//! The command line: one file per subcommand.

mod aim;
mod args;
mod bars;
mod build;
mod cache;
mod cast;
mod cluster;
mod common;
mod compare;
mod comparison;
mod crack;
mod demo;
mod error_time;
mod export;
mod facts;
mod fly;
mod folder;
mod form;
mod frames;
mod generate;
mod import;
mod info;
mod input;
mod lines;
mod machines;
mod made;
mod memory;
mod merge;
mod mesh;
mod method;
mod names;
mod original;
mod output;
mod paths;
mod pictures;
mod plan;
mod prune;
mod refit;
mod render;
mod report;
mod shard;
mod shell;
mod simulate;
mod stability;
mod subdivide;
mod sweep;
mod terminal;
mod trace;
mod unit;
mod verify;
mod words;

pub use output::unless_closed;
pub use terminal::{color, complain, set_color};

use clap::{CommandFactory, Parser, Subcommand};
use std::ffi::OsString;
use std::process::ExitCode;

/// Level of detail for ray tracing hardware, bit for bit.
#[derive(Parser)]
#[command(version, about, max_term_width = 110)]
pub struct Cli {
    #[command(subcommand)]
    command: Command,
    #[command(flatten)]
    common: common::Common,
}

#[derive(Subcommand)]
enum Command {
    /// Render a built-in scene from three distances, LOD beside BVH and full resolution
    Demo(demo::Args),
    /// Make a procedural scene
    Generate(generate::Args),
    /// Make a scene from a mesh (OBJ, PLY, glTF, GLB or STL): made anew with splits, or subdivided, or displaced
    Build(build::Args),
    /// Make a description of several models from a glTF scene: a scene file for each mesh, and a place for each node
    Import(import::Args),
    /// Print what a scene file holds
    Info(info::Args),
    /// Audit a scene file: recompute every promise from the vertices
    Verify(verify::Args),
    /// Find what a traversal unit can leave out for some scenes and views, and what that saves
    Plan(plan::Args),
    /// Show the traversal unit of a machine, block by block, and write its RTL's sizes
    Unit(unit::Args),
    /// Remove the levels of a scene that no ray of a plan's views reaches; the hits of these rays stay the same, other rays are refused
    Prune(prune::Args),
    /// Move the vertices of a scene: its trees stay, boxes and bounds are made anew; one scene, or one for each frame
    Refit(refit::Args),
    /// Render a scene, or several models
    #[command(after_long_help = words::RENDER)]
    Render(render::Args),
    /// Fly a camera through a scene: numbered pictures, and what pops from one to the next
    Fly(fly::Args),
    /// Simulate a frame on a machine: time, caches, memory and energy
    #[command(after_long_help = words::SIMULATE)]
    Simulate(simulate::Args),
    /// Simulate many frames on many machines, from a list of jobs; what was interrupted goes on where it was
    Sweep(sweep::Args),
    /// Put the shards of a sweep, error-time or stability together: what a run of all jobs would have written
    Merge(merge::Args),
    /// Write what runs a sweep, error-time or stability in shards on a computing cluster: files for Slurm or Snakemake (the method `cluster` is another thing: simulate --method)
    Cluster(cluster::Args),
    /// Put two results of simulations side by side
    #[command(after_long_help = words::SIMULATE)]
    Compare(compare::Args),
    /// Measure what an error costs: errors of methods against time, energy and traffic
    ErrorTime(error_time::Args),
    /// Show results as one page, with nothing to fetch: diagrams, tables, pictures, and how they were made
    Report(report::Args),
    /// Follow one ray through the traversal unit: as a waveform, or as text
    Trace(trace::Args),
    /// Count the memory lines that a frame touches, LOD against every BVH layout, by distance
    #[command(after_long_help = words::LINES)]
    Lines(lines::Args),
    /// Trace paths through a scene described in TOML, with shadows, mirrors and light from surface to surface: a picture, or what each bounce costs on a machine
    #[command(after_long_help = words::PATHS)]
    Paths(paths::Args),
    /// Cast the rays of a file (NumPy) at a scene, with any method, and write what they meet (NumPy)
    #[command(after_long_help = words::CAST)]
    Cast(cast::Args),
    /// Shoot rays at edges and vertices of a closed scene and count misses and double hits
    #[command(after_long_help = words::CRACK)]
    Crack(crack::Args),
    /// Test stiff and extreme cases: misses, double hits, errors against exact arithmetic, overflows
    #[command(after_long_help = words::STABILITY)]
    Stability(stability::Args),
    /// Write one level of a scene as an OBJ mesh
    #[command(after_long_help = words::EXPORT)]
    Export(export::Args),
    /// Print a script that completes commands and options in a shell
    #[command(after_help = words::COMPLETIONS)]
    Completions(shell::CompletionsArgs),
    /// Write manual pages for man
    Man(shell::ManArgs),
}

/// Runs the program; the exit code is that of a finding (a breach in an audit), errors are errors.
///
/// # Errors
/// Whatever went wrong, one line.
pub fn run(cli: Cli) -> anyhow::Result<ExitCode> {
    cli.common.apply()?;
    match cli.command {
        Command::Demo(args) => demo::run(&args),
        Command::Generate(args) => generate::run(&args),
        Command::Build(args) => build::run(&args),
        Command::Import(args) => import::run(&args),
        Command::Info(args) => info::run(&args),
        Command::Verify(args) => verify::run(&args),
        Command::Plan(args) => plan::run(&args),
        Command::Unit(args) => unit::run(&args),
        Command::Prune(args) => prune::run(&args),
        Command::Refit(args) => refit::run(&args),
        Command::Render(args) => render::run(&args),
        Command::Fly(args) => fly::run(&args),
        Command::Simulate(args) => simulate::run(&args),
        Command::Sweep(args) => sweep::run(&args),
        Command::Merge(args) => merged(&args),
        Command::Cluster(args) => cluster::run(&args, planned),
        Command::Compare(args) => compare::run(&args),
        Command::ErrorTime(args) => error_time::run(&args),
        Command::Report(args) => report::run(&args),
        Command::Trace(args) => trace::run(&args),
        Command::Lines(args) => lines::run(&args),
        Command::Paths(args) => paths::run(&args),
        Command::Cast(args) => cast::run(&args),
        Command::Crack(args) => crack::run(&args),
        Command::Stability(args) => stability::run(&args),
        Command::Export(args) => export::run(&args),
        Command::Completions(args) => shell::completions(&args, Cli::command()),
        Command::Man(args) => shell::man(&args, Cli::command()),
    }
}

/// Finishes the run whose shards are to be merged.
fn merged(args: &merge::Args) -> anyhow::Result<ExitCode> {
    match parsed(&merge::finished(args)?)? {
        Command::Sweep(args) => sweep::merge(&args),
        Command::ErrorTime(args) => error_time::merge(&args),
        Command::Stability(args) => stability::merge(&args),
        _ => anyhow::bail!("merge: the shards are of a command that has none: only {SPLIT} have"),
    }
}

/// What shards of a command line would do.
fn planned(words: &[OsString]) -> anyhow::Result<shard::Planned> {
    let words: Vec<OsString> = std::iter::once("lodray".into()).chain(words.iter().cloned()).collect();
    match parsed(&words)? {
        Command::Sweep(args) => sweep::planned(&args),
        Command::ErrorTime(args) => error_time::planned(&args),
        Command::Stability(args) => stability::planned(&args),
        _ => anyhow::bail!("only the jobs of {SPLIT} can be split into shards"),
    }
}

/// Commands that have shards.
const SPLIT: &str = "sweep, error-time and stability";

/// A command line that is not this process's own.
fn parsed(words: &[OsString]) -> anyhow::Result<Command> {
    Cli::try_parse_from(words).map(|cli| cli.command).map_err(|error| {
        let said = error.to_string();
        // The message; usage follows behind an empty line.
        let message: Vec<_> = said.lines().map(str::trim).take_while(|line| !line.is_empty()).collect();
        let message = message.join(" ");
        let shown: Vec<_> = words.iter().map(|word| word.to_string_lossy()).collect();
        anyhow::anyhow!("`{}`: {}", shown.join(" "), message.trim_start_matches("error: "))
    })
}
