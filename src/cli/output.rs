//! Output: progress on a terminal, JSON or text on standard output, folders.

use anyhow::Context;
use indicatif::{ProgressBar, ProgressStyle};
use lodray::format::{Scene, temporary_beside};
use lodray::mesh::MeshFormat;
use serde::Serialize;
use std::path::Path;
use std::time::Duration;

/// A progress bar on standard error; silent where that is not a terminal.
pub fn progress(steps: u64, what: &str) -> ProgressBar {
    // indicatif draws only on terminals.
    let style = ProgressStyle::with_template("{msg:24} {wide_bar} {percent:>3}% {eta:>4}").unwrap_or_else(|_| ProgressStyle::default_bar());
    ProgressBar::new(steps).with_style(style).with_message(what.to_owned())
}

/// Does work of unknown length; a spinner says what on a terminal.
pub fn busy<T>(what: &str, work: impl FnOnce() -> T) -> T {
    let spinner = ProgressBar::new_spinner().with_message(what.to_owned());
    if !spinner.is_hidden() {
        spinner.enable_steady_tick(Duration::from_millis(100));
    }
    let done = work();
    spinner.finish_and_clear();
    done
}

/// Prints `value` as one JSON document.
pub fn print_json(value: &impl Serialize) -> anyhow::Result<()> {
    print_line(&serde_json::to_string_pretty(value)?)
}

/// Prints a line; a closed pipe is not an error.
pub fn print_line(text: &str) -> anyhow::Result<()> {
    use std::io::{ErrorKind, Write};
    match writeln!(std::io::stdout().lock(), "{text}") {
        Err(e) if e.kind() != ErrorKind::BrokenPipe => Err(e).context("cannot write to standard output"),
        _ => Ok(()),
    }
}

/// Opens a scene file; the error names it, and for a mesh says how to make a scene of it.
pub fn open(path: &Path) -> anyhow::Result<Scene> {
    busy("opening", || Scene::open(path)).or_else(|error| {
        if path.is_file() && MeshFormat::of(path).is_some() {
            let (mesh, scene) = (path.display(), path.with_extension("lod"));
            anyhow::bail!("{mesh}: this is a mesh, not a scene: `lodray build {mesh} -o {}` makes one of it", scene.display());
        }
        Err(error.into())
    })
}

/// Makes the output folder and refuses it if `names` cannot be written there, before any work is done.
pub fn folder<'a>(path: &Path, names: impl IntoIterator<Item = &'a str>, input: Option<&Path>) -> anyhow::Result<()> {
    std::fs::create_dir_all(path).with_context(|| format!("cannot make folder {}", path.display()))?;
    names.into_iter().try_for_each(|name| check_target(&path.join(name), input))
}

/// Refuses an output file that cannot be written, or that is the input, before any work is done.
pub fn check_target(path: &Path, input: Option<&Path>) -> anyhow::Result<()> {
    let shown = path.display();
    let parent = path.parent().filter(|p| !p.as_os_str().is_empty()).unwrap_or(Path::new("."));
    anyhow::ensure!(!path.is_dir(), "cannot write {shown}: it is a folder");
    anyhow::ensure!(parent.is_dir(), "cannot write {shown}: folder {} does not exist", parent.display());
    // Renaming a file to the name of a device would take the device away.
    anyhow::ensure!(path.is_file() || !path.exists(), "cannot write {shown}: it is not an ordinary file");
    let same = |input: &Path| input.canonicalize().is_ok_and(|input| path.canonicalize().is_ok_and(|path| path == input));
    anyhow::ensure!(!input.is_some_and(same), "cannot write {shown}: it is the input file");
    temporary_beside(path).with_context(|| format!("cannot write {shown}"))?;
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
