//! Files of results: of `simulate`, one or several, and the lines of `sweep`.

use super::json::{fault, fault_at};
use super::output::warn;
use super::sweep::Row;
use lodray::report::page::Simulation;
use lodray::report::result::SimResult;

/// All results of the file of that name; none for jobs that failed. A last line that was cut, as where a run was killed, is left out, and that is said.
pub fn results(text: &str, file: &str) -> anyhow::Result<Vec<Option<Simulation>>> {
    let alone = |result: SimResult| Some(Simulation { scene: None, result, image: None });
    let row = |row: Row| row.result.map(|result| Simulation { scene: Some(row.scene), result, image: row.image });
    let plain = |error: serde_json::Error| anyhow::anyhow!(fault_at(&error));
    Ok(match text.trim_start().chars().next() {
        Some('[') => serde_json::from_str::<Vec<SimResult>>(text).map_err(plain)?.into_iter().map(alone).collect(),
        _ if text.trim_start().starts_with("{\"key\"") => {
            let lines = (1..).zip(text.lines()).filter(|(_, line)| !line.trim().is_empty());
            let wrong = |number, e: serde_json::Error| anyhow::anyhow!("line {number}, column {}: {}", e.column(), fault(&e));
            let read = |(number, line): (usize, &str)| serde_json::from_str(line).map(row).map_err(|e| wrong(number, e));
            let mut found: Vec<_> = lines.map(read).collect();
            let is_cut = !text.ends_with('\n') && found.len() > 1;
            if let Some(Err(why)) = found.pop_if(|last| is_cut && last.is_err()) {
                warn(&format!("warning: {file}: {why}; this last line was cut, and is left out"));
            }
            found.into_iter().collect::<anyhow::Result<_>>()?
        }
        _ => vec![alone(serde_json::from_str(text).map_err(plain)?)],
    })
}
