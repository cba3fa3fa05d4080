//! Which files of `rtl/` a top needs: its own, those of the modules it names, and theirs.
//!
//! A file bears the name of its module, so a word of the text that is the name of a file counts as a use of it. A change in one block
//! then rebuilds only the tops above it.

use crate::Error;
use lodray::hardware::Hardware;
use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};
use xxhash_rust::xxh3::xxh3_128;

const PACKAGE: &str = "lod_pkg";
const WAIVERS: &str = "lint.vlt";
/// Folder of what is bound to modules in simulation, `MODULE_rules.sv`.
const RULES: &str = "rules";

/// The root of the repository.
pub fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR")).parent().unwrap_or(Path::new("."))
}

/// The folder of the RTL: `rtl/`, or the one that `LODRAY_RTL` names.
pub fn rtl() -> PathBuf {
    std::env::var_os("LODRAY_RTL").map_or_else(|| root().join("rtl"), |given| root().join(given))
}

/// The package of this hardware as a file below `target/hardware`; none if it is that of the default, which is the one of [`rtl`].
pub(crate) fn package(hardware: &Hardware) -> Result<Option<PathBuf>, Error> {
    let text = hardware.package();
    if text == Hardware::default().package() {
        return Ok(None);
    }
    let folder = root().join("target/hardware").join(format!("{:032x}", xxh3_128(text.as_bytes())));
    let path = folder.join(format!("{PACKAGE}.sv"));
    if !path.is_file() {
        std::fs::create_dir_all(&folder).map_err(Error::file(&folder))?;
        // Whole or not there: other processes read it.
        let whole = tempfile::NamedTempFile::new_in(&folder).map_err(Error::file(&folder))?;
        std::fs::write(whole.path(), &text).map_err(Error::file(&path))?;
        whole.persist(&path).map_err(|error| Error::File { path: path.clone(), source: error.error })?;
    }
    Ok(Some(path))
}

/// Source files in the order of the command line, with their content.
#[derive(Clone, Debug)]
pub(crate) struct Sources {
    files: Vec<(PathBuf, Vec<u8>)>,
}

impl Sources {
    /// Those of a top in one of the given files or in [`rtl`].
    pub fn with(extra: &[PathBuf], top: &str) -> Result<Self, Error> {
        Self::within(&rtl(), extra, top)
    }

    /// Exactly these.
    pub fn exactly(files: &[PathBuf]) -> Result<Self, Error> {
        let read = |path: &PathBuf| Ok((path.clone(), std::fs::read(path).map_err(Error::file(path))?));
        Ok(Self { files: files.iter().map(read).collect::<Result<_, Error>>()? })
    }

    /// All of [`rtl`] with the package of this hardware, which comes before its users.
    pub fn all(hardware: &Hardware) -> Result<Self, Error> {
        let folder = rtl();
        let entries = std::fs::read_dir(&folder).map_err(Error::file(&folder))?;
        let mut files: Vec<PathBuf> = entries.flatten().map(|e| e.path()).filter(|p| p.extension().is_some_and(|e| e == "sv")).collect();
        files.sort_by_key(|path| (!path.ends_with("lod_pkg.sv"), path.clone()));
        if let (Some(package), Some(first)) = (package(hardware)?, files.first_mut()) {
            *first = package;
        }
        Self::exactly(&files)
    }

    fn within(folder: &Path, extra: &[PathBuf], top: &str) -> Result<Self, Error> {
        let mut known: BTreeMap<String, PathBuf> = BTreeMap::new();
        for entry in std::fs::read_dir(folder).map_err(Error::file(folder))? {
            let path = entry.map_err(Error::file(folder))?.path();
            add(&mut known, path);
        }
        for path in extra {
            add(&mut known, path.clone());
        }
        let mut needed = BTreeSet::new();
        let mut waiting = vec![top.to_owned()];
        while let Some(module) = waiting.pop() {
            let Some(path) = known.get(&module) else {
                return Err(Error::Ports { top: top.to_owned(), what: format!("no file {module}.sv in {}", folder.display()) });
            };
            if needed.insert(module) {
                let text = std::fs::read_to_string(path).map_err(Error::file(path))?;
                waiting.extend(words(&text).filter(|word| known.contains_key(*word)).map(str::to_owned));
            }
        }
        let mut files: Vec<PathBuf> = Vec::new();
        files.extend(Some(folder.join(WAIVERS)).filter(|path| path.is_file()));
        let rules: Vec<PathBuf> =
            needed.iter().map(|module| folder.join(RULES).join(format!("{module}_rules.sv"))).filter(|path| path.is_file()).collect();
        if needed.remove(PACKAGE) {
            files.push(known[PACKAGE].clone());
        }
        files.extend(needed.iter().map(|module| known[module].clone()));
        files.extend(rules);
        Self::exactly(&files)
    }

    /// The files as arguments, relative to the root where they are below it.
    pub fn arguments(&self) -> impl Iterator<Item = String> {
        self.contents().map(|(path, _)| path.display().to_string())
    }

    /// The files' names and contents: all that the result of a build takes from them.
    pub fn contents(&self) -> impl Iterator<Item = (&Path, &[u8])> {
        self.files.iter().map(|(path, content)| (path.strip_prefix(root()).unwrap_or(path), content.as_slice()))
    }
}

fn add(known: &mut BTreeMap<String, PathBuf>, path: PathBuf) {
    if path.extension().is_some_and(|e| e == "sv")
        && let Some(stem) = path.file_stem().and_then(|s| s.to_str())
    {
        known.insert(stem.to_owned(), path);
    }
}

/// The words of a text, comments left out.
fn words(text: &str) -> impl Iterator<Item = &str> {
    text.lines()
        .map(|line| line.split("//").next().unwrap_or(line))
        .flat_map(|line| line.split(|c: char| !(c.is_ascii_alphanumeric() || c == '_')))
        .filter(|word| !word.is_empty())
}
