//! `unit`: the traversal unit of a machine, and its RTL.

use super::args::Change;
use super::machines::{machine, machine_files};
use super::output::{check_target, print_json, print_line, print_table, remark, write_file};
use lodray::hardware::{Hardware, block_gates, context_gates, unit_gates};
use lodray::method::lod;
use lodray::study::grouped;
use serde::Serialize;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

#[derive(clap::Args)]
pub struct Args {
    /// Machine: the name of one that comes with the program, or a file
    #[arg(long, value_name = "NAME|FILE", default_value = "haydel2023")]
    machine: String,
    /// Change a value of the machine, such as units.contexts=32; may be repeated
    #[arg(long, value_name = "KEY=VALUE")]
    set: Vec<Change>,
    /// Write the unit's rtl/lod_pkg.sv to this file; with it, rtl/ is that unit
    #[arg(long, value_name = "FILE")]
    package: Option<PathBuf>,
    /// Print its figures as JSON
    #[arg(long)]
    json: bool,
}

/// A unit in numbers.
#[derive(Serialize)]
pub struct UnitFacts {
    levels: u32,
    stored_levels: u32,
    bvh_depth: u32,
    stack_entries: u32,
    contexts: usize,
    edges_per_cycle: u32,
    lod_edges_per_cycle: u32,
    divide_bits: u32,
    setup_bits: u32,
    setup_copies: u32,
    divide_copies: u32,
    boxes_per_cycle: u32,
    index_bits: u32,
    lod_test: bool,
    start_radius: bool,
    hit_mapping: bool,
    compact_vertices: bool,
    exact_vertices: bool,
    coordinate_zeros: u32,
    direction_zeros: u32,
    /// Modules of its blocks: of those that take turns the one that has all of them.
    blocks: Vec<&'static str>,
    /// Gate equivalents of the whole: its blocks, and the contexts.
    gates: f64,
    /// Registers of a context, in bits.
    context_bits: u32,
    /// Gate equivalents of one, with its logic and its memories.
    context_gates: f64,
}

impl UnitFacts {
    /// Those of the unit of `hardware`.
    pub fn of(hardware: &Hardware) -> Self {
        let blocks = lod::METHOD.unit.into_iter().flat_map(|unit| hardware.blocks(unit.blocks));
        Self {
            levels: hardware.levels,
            stored_levels: hardware.stored_levels(),
            bvh_depth: hardware.bvh_depth,
            stack_entries: hardware.stack_entries(),
            contexts: hardware.contexts,
            edges_per_cycle: hardware.edges_per_cycle.count(),
            lod_edges_per_cycle: hardware.lod_edges_per_cycle.count(),
            divide_bits: hardware.divide_bits,
            setup_bits: hardware.setup_bits,
            setup_copies: hardware.setup_copies,
            divide_copies: hardware.divide_copies,
            boxes_per_cycle: hardware.boxes_per_cycle.count(),
            index_bits: hardware.index_bits,
            lod_test: hardware.chooses_levels(),
            start_radius: hardware.start_radius,
            hit_mapping: hardware.hit_mapping,
            compact_vertices: hardware.compact_vertices,
            exact_vertices: hardware.exact_vertices,
            coordinate_zeros: hardware.coordinate_zeros,
            direction_zeros: hardware.direction_zeros,
            blocks: blocks.map(|operation| hardware.module(operation)).collect(),
            gates: gates(hardware),
            context_bits: hardware.context_registers(true).kept,
            context_gates: context_gates(hardware, true),
        }
    }
}

/// Gate equivalents of a unit: its blocks, and its contexts.
pub fn gates(hardware: &Hardware) -> f64 {
    lod::METHOD.unit.and_then(|unit| unit_gates(unit, hardware)).unwrap_or(0.0)
}

#[derive(Serialize)]
struct Document<'a> {
    machine: &'a str,
    set: &'a [String],
    /// How many units the machine has.
    units: u64,
    unit: UnitFacts,
}

pub fn run(args: &Args) -> anyhow::Result<ExitCode> {
    let facts = machine(&args.machine, &args.set, "--set")?;
    let (cores, units) = (&facts.description.cores, &facts.description.units);
    let (hardware, count) = (units.config(), u64::from(cores.groups) * u64::from(units.per_group));
    if let Some(package) = &args.package {
        let files = machine_files(&args.machine, &facts)?;
        check_target(package, &files.iter().map(PathBuf::as_path).collect::<Vec<&Path>>())?;
    }
    if args.json {
        print_json(&Document { machine: &facts.label, set: &facts.set, units: count, unit: UnitFacts::of(&hardware) })?;
    } else {
        let one = gates(&hardware);
        let all = if count > 1 { format!("; all {count} have {}", whole(one * count as f64)) } else { String::new() };
        print_line(&format!("a unit of {} has {} GE (gate equivalents){all}", facts.title(), whole(one)))?;
        print_table(&table(&hardware))?;
    }
    if let Some(package) = &args.package {
        write_file(package, hardware.package())?;
        remark(&format!("the RTL's sizes in {}", package.display()))?;
    }
    Ok(ExitCode::SUCCESS)
}

/// Gate equivalents as a whole number, in groups of three digits.
fn whole(gates: f64) -> String {
    grouped(gates.round() as u64) // far below 2^53
}

/// A line for each block, and one for the contexts.
fn table(hardware: &Hardware) -> String {
    let mut rows = vec![["", "how many", "cycles an item", "GE, all of them"].map(str::to_owned)];
    for operation in lod::METHOD.unit.into_iter().flat_map(|unit| hardware.blocks(unit.blocks)) {
        let [copies, interval] = [hardware.copies(operation), hardware.interval(operation)].map(|count| count.to_string());
        rows.push([operation.name().to_owned(), copies, interval, block_gates(operation, hardware).map_or_else(String::new, whole)]);
    }
    let contexts = hardware.contexts as f64 * context_gates(hardware, true);
    rows.push(["contexts".to_owned(), hardware.contexts.to_string(), String::new(), whole(contexts)]);
    let widths: [usize; 4] = std::array::from_fn(|column| rows.iter().map(|row| row[column].len()).max().unwrap_or(0));
    let row = |[name, count, interval, gates]: &[String; 4]| {
        format!("{name:0$}  {count:>1$}  {interval:>2$}  {gates:>3$}", widths[0], widths[1], widths[2], widths[3])
    };
    rows.iter().map(row).collect::<Vec<_>>().join("\n")
}
