//! Output: progress on a terminal, JSON or text on standard output, files; and the opening of scenes.

use super::common::is_quiet;
use super::terminal::{columns, complain, fit};
use anyhow::Context;
use indicatif::{MultiProgress, ProgressBar, ProgressDrawTarget, ProgressStyle};
use lodray::format::{Scene, remove_abandoned, temporary_beside, write_and_rename};
use lodray::mesh::MeshFormat;
use lodray::study::pruned::{check_normals, check_whole};
use serde::Serialize;
use std::path::Path;
use std::sync::LazyLock;
use std::time::Duration;

/// All that is shown of progress, one under the other: standard error, if it is a terminal and nobody wants quiet.
static PROGRESS: LazyLock<MultiProgress> = LazyLock::new(|| {
    // indicatif draws only on terminals.
    MultiProgress::with_draw_target(if is_quiet() { ProgressDrawTarget::hidden() } else { ProgressDrawTarget::stderr() })
});

/// A progress bar on standard error; silent where that is not a terminal.
pub fn progress(steps: u64, what: &str) -> ProgressBar {
    let style = ProgressStyle::with_template("{msg:24} {wide_bar} {percent:>3}% {eta:>4}").unwrap_or_else(|_| ProgressStyle::default_bar());
    PROGRESS.add(ProgressBar::new(steps)).with_style(style).with_message(what.to_owned())
}

/// A spinner for work of unknown length.
pub fn spinner(what: &str) -> ProgressBar {
    let spinner = PROGRESS.add(ProgressBar::no_length()).with_style(ProgressStyle::default_spinner()).with_message(what.to_owned());
    if !spinner.is_hidden() {
        spinner.enable_steady_tick(Duration::from_millis(100));
    }
    spinner
}

/// Does work of unknown length; a spinner says what on a terminal.
pub fn busy<T>(what: &str, work: impl FnOnce() -> T) -> T {
    let spinner = spinner(what);
    let done = work();
    spinner.finish_and_clear();
    done
}

/// Prints `value` as one JSON document.
pub fn print_json(value: &impl Serialize) -> anyhow::Result<()> {
    print_line(&serde_json::to_string_pretty(value)?)
}

/// Prints a line.
pub fn print_line(text: &str) -> anyhow::Result<()> {
    use std::io::Write;
    unless_closed(writeln!(std::io::stdout().lock(), "{text}"))
}

/// What printing came to; a closed pipe is not an error.
pub fn unless_closed(printed: std::io::Result<()>) -> anyhow::Result<()> {
    match printed {
        Err(e) if e.kind() != std::io::ErrorKind::BrokenPipe => Err(e).context("cannot write to standard output"),
        _ => Ok(()),
    }
}

/// Prints a table, which fits the terminal.
pub fn print_table(text: &str) -> anyhow::Result<()> {
    print_line(&columns().map_or_else(|| text.to_owned(), |columns| fit(text, columns)))
}

/// Prints a closing remark, such as where files went, unless nobody wants any.
pub fn remark(text: &str) -> anyhow::Result<()> {
    if is_quiet() { Ok(()) } else { print_line(text) }
}

/// Says where the words of a command's table are explained.
pub fn explain(command: &str) -> anyhow::Result<()> {
    remark(&format!("(lodray help {command} explains the words)"))
}

/// What a TOML reader complains of, in one line: its error is several, with a picture of the place; the first and the last of it say all.
pub fn toml_in_one_line(file: &str, error: &toml::de::Error) -> anyhow::Error {
    let picture = error.to_string();
    anyhow::anyhow!("{file}: {}: {}", picture.lines().next().unwrap_or_default(), brief(&in_plain_words(error.message())))
}

/// A message of the reader of TOML, with what numbers may be in place of Rust's names for them.
pub fn in_plain_words(message: &str) -> String {
    let most = |name| match name {
        "u16" => Some(u64::from(u16::MAX)),
        "u32" => Some(u64::from(u32::MAX)),
        "u64" | "usize" => Some(u64::MAX),
        _ => None,
    };
    match message.rsplit_once("expected ") {
        Some((start, name)) if let Some(most) = most(name) => format!("{start}expected a whole number from 0 to {most}"),
        Some((start, "f32" | "f64")) => format!("{start}expected a number"),
        _ => message.to_owned(),
    }
}

/// Most bytes of a word, and of an error, that quotes a file.
const LONGEST_WORD: usize = 200;
const LONGEST_ERROR: usize = 1500;

/// An error that quotes a file, whatever the file has there: the beginnings of long words, and of all.
pub fn brief(text: &str) -> String {
    let cut = |text: &str, longest: usize| match text.char_indices().find(|(at, character)| at + character.len_utf8() > longest) {
        Some((at, _)) => format!("{}...", &text[..at]),
        None => text.to_owned(),
    };
    cut(&text.split(' ').map(|word| cut(word, LONGEST_WORD)).collect::<Vec<_>>().join(" "), LONGEST_ERROR)
}

/// Says on standard error what a user should know of a run that went well.
pub fn warn(text: &str) {
    let (label, rest) = text.split_once(' ').unwrap_or((text, ""));
    complain(label, rest);
}

/// The text of a file; the error names it.
pub fn read_text(path: &Path) -> anyhow::Result<String> {
    let of = || format!("cannot read {}", path.display());
    let bytes = std::fs::read(path).with_context(of)?;
    String::from_utf8(bytes).map_err(|_| anyhow::anyhow!("it is no text").context(of()))
}

/// Writes a whole file; the error names it.
pub fn write_file(path: &Path, bytes: impl AsRef<[u8]>) -> anyhow::Result<()> {
    write_and_rename(path, |out| out.write_all(bytes.as_ref())).with_context(|| format!("cannot write {}", path.display()))
}

/// Opens a scene file for any rays: refuses one that was pruned for a job.
pub fn open(path: &Path) -> anyhow::Result<Scene> {
    let scene = open_any(path)?;
    check_whole(&scene).with_context(|| path.display().to_string())?;
    check_normals(&scene, "this")?;
    Ok(scene)
}

/// Opens a scene file, which may have been pruned for a job: whoever traces rays on it asks `study::pruned::check` first. The error names the file, and for a mesh says how to
/// make a scene of it.
pub fn open_any(path: &Path) -> anyhow::Result<Scene> {
    busy("opening", || Scene::open(path)).or_else(|error| {
        if path.is_file() && MeshFormat::of(path).is_some() {
            let (mesh, scene) = (path.display(), path.with_extension("lod"));
            anyhow::bail!("{mesh}: this is a mesh, not a scene: `lodray build {mesh} -o {}` makes one of it", scene.display());
        }
        Err(error.into())
    })
}

/// Refuses an output file that cannot be written, or that is one of the inputs, before any work is done; what killed runs have left beside it is removed.
pub fn check_target(path: &Path, inputs: &[&Path]) -> anyhow::Result<()> {
    let shown = path.display();
    let parent = path.parent().filter(|p| !p.as_os_str().is_empty()).unwrap_or(Path::new("."));
    anyhow::ensure!(path != Path::new("-"), "cannot write {shown}: what is written here is a file, and ./- is one of that name");
    anyhow::ensure!(!path.is_dir(), "cannot write {shown}: it is a folder");
    anyhow::ensure!(parent.is_dir(), "cannot write {shown}: folder {} does not exist", parent.display());
    // Renaming a file to the name of a device would take the device away.
    anyhow::ensure!(path.is_file() || !path.exists(), "cannot write {shown}: it is not an ordinary file");
    let same = |input: &Path| input.canonicalize().is_ok_and(|input| path.canonicalize().is_ok_and(|path| path == input));
    anyhow::ensure!(!inputs.iter().any(|input| same(input)), "cannot write {shown}: it is the input file");
    remove_abandoned(parent);
    temporary_beside(path).with_context(|| format!("cannot write {shown}"))?;
    Ok(())
}

/// Whether two files that are to be written are one: they need not be there yet, but their folders are.
pub fn is_same_target(a: &Path, b: &Path) -> bool {
    let place = |path: &Path| {
        let folder = path.parent().filter(|parent| !parent.as_os_str().is_empty()).unwrap_or(Path::new("."));
        Some((folder.canonicalize().ok()?, path.file_name()?.to_owned()))
    };
    place(a).is_some_and(|a| place(b) == Some(a))
}

/// A number with four digits that count and no idle zeros.
pub fn plain(value: f64) -> String {
    let size = value.abs();
    if value != 0.0 && !(1e-4..1e7).contains(&size) {
        return format!("{value:.3e}");
    }
    let decimals = if size > 0.0 { (3.0 - size.log10().floor()).max(0.0) as usize } else { 0 };
    let text = format!("{value:.decimals$}");
    if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.').to_owned() } else { text }
}

#[cfg(test)]
mod tests {
    #[test]
    fn numbers_have_four_digits() {
        let shown = [0.0, 2.0, 0.5, -1.23456, 123.456, 98765.4, 0.000_123_456, 1e-9, 2.5e9, f64::INFINITY].map(super::plain);
        assert_eq!(shown, ["0", "2", "0.5", "-1.235", "123.5", "98765", "0.0001235", "1.000e-9", "2.500e9", "inf"]);
    }

    #[test]
    fn errors_are_as_they_are_but_for_long_words_and_long_ones() {
        use super::brief;
        assert_eq!(brief("unknown field `a`,  expected `b`"), "unknown field `a`,  expected `b`");
        assert_eq!(brief(&format!("no {} here", "\u{e9}".repeat(1000))), format!("no {}... here", "\u{e9}".repeat(100)));
        assert_eq!(brief(&"word ".repeat(1000)), format!("{}...", "word ".repeat(300)));
    }
}
