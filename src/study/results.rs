//! Files of results: of one frame or several, and the lines of a sweep.

use super::fault::fault;
use super::progress::Progress;
use super::rows::Row;
use crate::report::page::Simulation;
use crate::report::result::SimResult;
use thiserror::Error;

/// What is no result.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
#[error("line {line}, column {column}: {what}")]
pub struct NoResult {
    /// The line, from 1.
    pub line: usize,
    /// The column, from 1.
    pub column: usize,
    /// What is wrong there.
    pub what: String,
}

/// All results of `text`, the file of that name; none for jobs that failed. A last line that was cut, as where a run was killed, is left out, and that is noted.
///
/// # Errors
/// Something else in it is no result.
pub fn results(text: &str, file: &str, progress: &dyn Progress) -> Result<Vec<Option<Simulation>>, NoResult> {
    let alone = |result: SimResult| Some(Simulation { scene: None, result, image: None });
    let row = |row: Row| row.result.map(|result| Simulation { scene: Some(row.scene), result, image: row.image });
    let wrong = |line, error: serde_json::Error| NoResult { line, column: error.column(), what: fault(&error) };
    let plain = |error: serde_json::Error| wrong(error.line(), error);
    Ok(match text.trim_start().chars().next() {
        Some('[') => serde_json::from_str::<Vec<SimResult>>(text).map_err(plain)?.into_iter().map(alone).collect(),
        _ if text.trim_start().starts_with("{\"key\"") => {
            let lines = (1..).zip(text.lines()).filter(|(_, line)| !line.trim().is_empty());
            let read = |(number, line): (usize, &str)| serde_json::from_str(line).map(row).map_err(|error| wrong(number, error));
            let mut found: Vec<_> = lines.map(read).collect();
            let is_cut = !text.ends_with('\n') && found.len() > 1;
            if let Some(Err(why)) = found.pop_if(|last| is_cut && last.is_err()) {
                progress.note(&format!("warning: {file}: {why}; this last line was cut, and is left out"));
            }
            found.into_iter().collect::<Result<_, _>>()?
        }
        _ => vec![alone(serde_json::from_str(text).map_err(plain)?)],
    })
}
