//! Output: progress on a terminal, JSON or text on standard output, folders.

use anyhow::Context;
use indicatif::{ProgressBar, ProgressStyle};
use lodray::format::Scene;
use serde::Serialize;
use std::path::Path;

/// A progress bar on standard error; silent where that is not a terminal.
pub fn progress(steps: u64, what: &str) -> ProgressBar {
    // indicatif draws only on terminals.
    let style = ProgressStyle::with_template("{msg:24} {wide_bar} {percent:>3}% {eta:>4}").unwrap_or_else(|_| ProgressStyle::default_bar());
    ProgressBar::new(steps).with_style(style).with_message(what.to_owned())
}

/// Prints `value` as one JSON document.
pub fn print_json(value: &impl Serialize) -> anyhow::Result<()> {
    print_line(&serde_json::to_string_pretty(value)?)
}

/// Prints a line; a closed pipe is not an error.
pub fn print_line(text: &str) -> anyhow::Result<()> {
    use std::io::{ErrorKind, Write};
    match writeln!(std::io::stdout(), "{text}") {
        Err(e) if e.kind() != ErrorKind::BrokenPipe => Err(e.into()),
        _ => Ok(()),
    }
}

/// Opens a scene file; the error names it.
pub fn open(path: &Path) -> anyhow::Result<Scene> {
    Ok(Scene::open(path)?)
}

/// Makes the output folder.
pub fn folder(path: &Path) -> anyhow::Result<()> {
    std::fs::create_dir_all(path).with_context(|| format!("cannot make folder {}", path.display()))
}

/// Refuses an output file whose folder does not exist before any work is done.
pub fn check_target(path: &Path) -> anyhow::Result<()> {
    anyhow::ensure!(!path.is_dir(), "{} is a folder, not a file to write", path.display());
    let parent = path.parent().filter(|p| !p.as_os_str().is_empty()).unwrap_or(Path::new("."));
    anyhow::ensure!(parent.is_dir(), "cannot write {}: folder {} does not exist", path.display(), parent.display());
    Ok(())
}

/// 12345678 as "12,345,678".
pub fn grouped(n: u64) -> String {
    let digits = n.to_string();
    let mut out = String::new();
    for (i, c) in digits.chars().enumerate() {
        if i > 0 && (digits.len() - i).is_multiple_of(3) {
            out.push(',');
        }
        out.push(c);
    }
    out
}

#[cfg(test)]
mod tests {
    #[test]
    fn digits_are_grouped() {
        assert_eq!([0, 999, 1000, 8_388_608].map(super::grouped), ["0", "999", "1,000", "8,388,608"]);
    }
}
