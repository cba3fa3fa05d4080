//! One run, one folder: what a run writes into a folder is not mixed with the files of another.
//!
//! A run writes into a staging folder inside of its own, and only when it has succeeded its files take their places, those of the run before that
//! it does not make go, and its record comes last. A run that fails or is killed leaves the folder as it was.

mod record;

use super::common::Invocation;
use super::output::{check_target, is_same_target};
use anyhow::{Context, anyhow, ensure};
use lodray::format::Staging;
use lodray::mesh::named_files;
use lodray::study::aside;
use std::collections::BTreeSet;
use std::fs;
use std::io::ErrorKind;
use std::path::{Path, PathBuf};

pub use record::Input;
use record::NAME as RECORD;
pub use record::Record;

/// What may be replaced.
#[derive(clap::Args)]
pub struct Overrule {
    /// Write even to a folder that holds a run of another command, or files of these names that no run has made
    ///
    /// Once this run has succeeded, its files replace those, and the other run's are removed. Other files stay.
    #[arg(long)]
    force: bool,
}

/// Long help of an option for an output folder.
pub fn one_run(what: &str) -> String {
    format!(
        "{what}

A folder belongs to one run: {RECORD} there says which (command, version, hashes of the inputs, files).
A later run of the same command replaces that run's files and removes those that it no longer makes.
A run of another command is refused, and so is one that would replace files that no record lists,
unless --force is given. Nothing is replaced or removed before the new run has succeeded."
    )
}

/// A run's folder.
pub struct RunFolder {
    path: PathBuf,
    staging: Staging,
    /// Files of earlier runs.
    old: BTreeSet<String>,
    /// The files that it is about to write, as far as that is known.
    names: Vec<String>,
    record: Record,
    force: bool,
    /// After the staging folder: fields are dropped in their order.
    made: Made,
}

impl RunFolder {
    /// Makes the folder, or takes it over, for a run that is about to write files of these names; refuses before any work is done, and
    /// none of `inputs` is overwritten.
    pub fn open<'a>(path: &Path, names: impl IntoIterator<Item = &'a str>, inputs: &[&Path], overrule: &Overrule) -> anyhow::Result<Self> {
        let (shown, force) = (path.display(), overrule.force);
        let made = Made::make(path)?;
        let inputs = with_named(inputs);
        let inputs: Vec<_> = inputs.iter().map(PathBuf::as_path).collect();
        let names: Vec<_> = names.into_iter().collect();
        names.iter().chain([&RECORD]).try_for_each(|name| check_target(&path.join(name), &inputs))?;
        let staging = Staging::open(path).with_context(|| format!("cannot write to {shown}"))?;
        let staging = staging.with_context(|| format!("{shown}: another run is writing to this folder"))?;
        let record = Record::new(Invocation::of_process(), inputs.iter().map(|input| Input::read(input)).collect::<anyhow::Result<_>>()?);
        let before = earlier(path, &record.command, overrule)?;
        let old = before.map_or_else(BTreeSet::new, |before| before.files);
        let own = names.iter().map(|&name| name.to_owned()).collect();
        let folder = Self { path: path.to_owned(), staging, old, names: own, record, force, made };
        names.iter().try_for_each(|name| folder.check_free(name))?;
        Ok(folder)
    }

    /// Refuses another file to write, after the run, that would replace one of its own.
    pub fn spares(&self, other: Option<&Path>) -> anyhow::Result<()> {
        let own = self.names.iter().chain(&self.old).map(String::as_str).chain([RECORD]);
        match other.filter(|other| own.into_iter().any(|name| is_same_target(&self.path.join(name), other))) {
            Some(other) => anyhow::bail!("cannot write {}: it is a file of the run", other.display()),
            None => Ok(()),
        }
    }

    /// Where the run writes its files, all of them whole when [`RunFolder::finish`] is called.
    pub fn staging(&self) -> &Path {
        self.staging.path()
    }

    /// Says something of the run.
    pub fn note(&mut self, text: String) {
        self.record.notes.push(text);
    }

    /// Refuses a file that no run has made, which this one would go on with: it may be another program's.
    pub fn continues(&self, name: &str) -> anyhow::Result<()> {
        self.check_free(name)
    }

    /// A file that the run writes in its place and that a later run goes on with, whatever becomes of this one.
    pub fn keep(&mut self, name: &str) -> anyhow::Result<()> {
        self.record.files.insert(name.to_owned());
        self.made.stay();
        self.unfinished()
    }

    /// Lists the files beside the lines of `path` in which lines were set aside.
    pub fn keep_aside(&mut self, path: &Path) -> anyhow::Result<()> {
        let names = aside(path).into_iter().filter(|file| file.exists());
        names.filter_map(|file| file.file_name().map(|name| name.to_string_lossy().into_owned())).try_for_each(|name| self.keep(&name))
    }

    /// A file that no record lists is not replaced.
    fn check_free(&self, name: &str) -> anyhow::Result<()> {
        let target = self.path.join(name);
        let is_free = self.force || self.old.contains(name) || self.record.files.contains(name) || target.symlink_metadata().is_err();
        let shown = target.display();
        ensure!(is_free, "{shown} is there, and no {RECORD} says that a run has made it: take another folder, or --force to replace it");
        Ok(())
    }

    /// Notes that the folder has files of two runs.
    fn unfinished(&self) -> anyhow::Result<()> {
        let mut record = self.record.clone();
        record.files.extend(self.old.iter().cloned());
        record.unfinished = true;
        record.write(&self.path)
    }

    /// Puts the run's files into their places, removes those of earlier runs that it has not made, and writes its record.
    pub fn finish(mut self) -> anyhow::Result<()> {
        let staged = self.staging.names().with_context(|| format!("cannot read {}", self.staging().display()))?;
        staged.iter().try_for_each(|name| self.check_free(name))?;
        self.record.files.extend(staged.iter().cloned());
        self.unfinished()?;
        self.made.stay();
        for name in &staged {
            let target = self.path.join(name);
            fs::rename(self.staging().join(name), &target).with_context(|| format!("cannot write {}", target.display()))?;
        }
        for name in self.old.difference(&self.record.files) {
            let gone = self.path.join(name);
            match fs::remove_file(&gone) {
                Err(error) if error.kind() != ErrorKind::NotFound => {
                    return Err(error).with_context(|| format!("cannot remove {}, a file of an earlier run", gone.display()));
                }
                _ => {}
            }
        }
        self.record.write(&self.path)
    }
}

/// The record of the run whose folder it is, if there is one; refuses a folder of another command's run.
pub fn earlier(path: &Path, command: &str, overrule: &Overrule) -> anyhow::Result<Option<Record>> {
    let (shown, force) = (path.display(), overrule.force);
    let before = match Record::read(path) {
        // Then it is a file like any other.
        Err(_) if force => None,
        other => other.map_err(|error| anyhow!("{error:#}; take another folder, or --force to replace it"))?,
    };
    if let Some(old) = before.as_ref().map(|before| &before.command).filter(|old| !force && *old != command) {
        anyhow::bail!(
            "{shown} holds a run of `{old}`, and `{command}` does not mix with it: take another folder, or --force to replace it"
        );
    }
    Ok(before)
}

/// Inputs, each with the files that are read with it.
pub fn with_named<T: AsRef<Path>>(inputs: &[T]) -> Vec<PathBuf> {
    inputs.iter().map(AsRef::as_ref).flat_map(|input: &Path| std::iter::once(input.to_path_buf()).chain(named_files(input))).collect()
}

/// Folders that were made for a run, the innermost first; they go again if nothing is in them.
struct Made(Vec<PathBuf>);

impl Made {
    fn make(path: &Path) -> anyhow::Result<Self> {
        let missing = path.ancestors().take_while(|folder| !folder.as_os_str().is_empty() && !folder.exists());
        let made = Self(missing.map(Path::to_owned).collect());
        fs::create_dir_all(path).with_context(|| format!("cannot make folder {}", path.display()))?;
        Ok(made)
    }

    fn stay(&mut self) {
        self.0.clear();
    }
}

impl Drop for Made {
    fn drop(&mut self) {
        // Those above a folder that is not empty are not empty either.
        let _ = self.0.iter().try_for_each(fs::remove_dir);
    }
}
