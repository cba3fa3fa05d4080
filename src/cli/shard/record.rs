//! Which run the shards of a folder are of.

use crate::cli::common::Invocation;
use crate::cli::output::write_file;
use anyhow::{Context, anyhow, ensure};
use lodray::study::fault_at;
use lodray::study::shards::FOLDER;
use std::io::ErrorKind;
use std::path::Path;

/// The command that all shards of a folder are of.
const NAME: &str = "command.json";

fn read(folder: &Path) -> anyhow::Result<Option<Invocation>> {
    let path = folder.join(NAME);
    let text = match std::fs::read_to_string(&path) {
        Err(error) if error.kind() == ErrorKind::NotFound => return Ok(None),
        other => other.with_context(|| format!("cannot read {}", path.display()))?,
    };
    let parsed = serde_json::from_str(&text)
        .map_err(|error| anyhow!("{} does not say whose shards these are: {}", path.display(), fault_at(&error)));
    parsed.map(Some)
}

/// Notes in the folder of shards which run they are of; refuses those of another.
pub fn write(folder: &Path, run: &Invocation) -> anyhow::Result<()> {
    match read(folder)? {
        Some(before) => {
            let shown = |of: &Invocation| format!("`{} {}`", of.command, of.arguments.join(" "));
            let (old, new) = (shown(&before), shown(run));
            ensure!(before == *run, "{} holds shards of {old}, and {new} does not mix with them: take another folder", folder.display());
            Ok(())
        }
        // Whoever else writes it just now writes the same.
        None => write_file(&folder.join(NAME), serde_json::to_string_pretty(run)? + "\n"),
    }
}

/// The command line of the run whose shards are in a folder of results.
pub fn recorded(out: &Path) -> anyhow::Result<Invocation> {
    read(&out.join(FOLDER))?.with_context(|| format!("{}: there are no shards of a run ({FOLDER}/{NAME})", out.display()))
}
