//! Machines by name.

use super::args::Change;
use super::output::toml_in_one_line;
use lodray::machine::{Machine, MachineError};
use lodray::report::result::MachineFacts;
use lodray::sim::energy;
use std::path::{Path, PathBuf};

/// The machine of a shipped name or a description's path, changed by what errors call `set`.
pub fn machine(name: &str, changes: &[Change], set: &str) -> anyhow::Result<MachineFacts> {
    let (path, is_path) = (Path::new(name), is_path(name));
    let mut description = if is_path { Machine::load(path) } else { Machine::shipped(name) }.map_err(in_one_line)?;
    let pairs: Vec<_> = changes.iter().map(|change| (change.key.as_str(), change.value.as_str())).collect();
    description.set_all(&pairs).map_err(|error| anyhow::anyhow!("{set} {error}"))?;
    let label = if is_path { path.file_stem().unwrap_or_default().to_string_lossy().into_owned() } else { name.to_owned() };
    Ok(MachineFacts { label, set: changes.iter().map(ToString::to_string).collect(), description })
}

/// The files that a machine of this name was read from; none if it comes with the program.
pub fn machine_files(name: &str, machine: &MachineFacts) -> Result<Vec<PathBuf>, MachineError> {
    if !is_path(name) {
        return Ok(Vec::new());
    }
    let file = Path::new(name);
    let description = &machine.description;
    let tables = energy::files(description)?.into_iter();
    let beside = |path: String| file.parent().unwrap_or(Path::new("")).join(path);
    // Those that are not there come with the program.
    let named = tables.chain([description.dram.device.clone()]).map(beside).filter(|path| path.exists());
    Ok(std::iter::once(file.to_owned()).chain(named).collect())
}

/// Whether a machine's name is that of a file.
pub fn is_path(name: &str) -> bool {
    let path = Path::new(name);
    path.components().count() > 1 || path.extension().is_some_and(|e| e == "toml")
}

/// What is wrong with a machine, in one line.
fn in_one_line(error: MachineError) -> anyhow::Error {
    match error {
        MachineError::Toml { file, source } => toml_in_one_line(&file, &source),
        MachineError::NotShipped { name, .. } if !name.contains('/') => {
            let name = name.trim_end_matches(".toml");
            anyhow::anyhow!("there is no machine {name}; there are: {}; a file's name ends in .toml", Machine::all_shipped().join(", "))
        }
        other => other.into(),
    }
}
