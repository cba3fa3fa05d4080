//! Verilator itself: where it is, which one it is, and a run of it.

use crate::Error;
use crate::sources;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::OnceLock;
use xxhash_rust::xxh3::xxh3_128;

/// A Verilator: its binary, which needs neither Perl nor make.
#[derive(Clone, Debug)]
pub struct Verilator {
    binary: PathBuf,
    root: PathBuf,
    hash: u128,
}

impl Verilator {
    /// The one of `LODRAY_VERILATOR` (its root, or `verilator_bin` in the `bin` of its root), else the one of `scripts/tools`.
    pub fn find() -> Result<Self, Error> {
        static FOUND: OnceLock<Verilator> = OnceLock::new();
        if let Some(found) = FOUND.get() {
            return Ok(found.clone());
        }
        let binary = match std::env::var_os("LODRAY_VERILATOR") {
            Some(given) => {
                let given = PathBuf::from(given);
                if given.is_dir() { given.join("bin/verilator_bin") } else { given }
            }
            None => installed()?,
        };
        let missing = || Error::ToolMissing(format!("no file {}", binary.display()));
        let binary = binary.canonicalize().map_err(|_| missing())?;
        let root = binary.parent().and_then(Path::parent).ok_or_else(missing)?.to_path_buf();
        if !root.join("include/verilated.cpp").is_file() {
            return Err(Error::ToolMissing(format!("no include/verilated.cpp in {}", root.display())));
        }
        let hash = xxh3_128(&std::fs::read(&binary).map_err(Error::file(&binary))?);
        Ok(FOUND.get_or_init(|| Self { binary, root, hash }).clone())
    }

    /// The one of the distribution's packages, years older; none where `scripts/tools` found no such package.
    pub fn of_distribution() -> Result<Option<Self>, Error> {
        let folder = sources::root().join("target/tools/verilator-distribution");
        if folder.join("none").is_file() {
            return Ok(None);
        }
        let (binary, root) = (folder.join("usr/bin/verilator_bin"), folder.join("usr/share/verilator"));
        if !binary.is_file() {
            return Err(Error::ToolMissing(format!("no file {}", binary.display())));
        }
        let hash = xxh3_128(&std::fs::read(&binary).map_err(Error::file(&binary))?);
        Ok(Some(Self { binary, root, hash }))
    }

    /// The folder with Verilator's own C++ sources.
    pub fn include(&self) -> PathBuf {
        self.root.join("include")
    }

    /// Hash of the binary: the packaged one states no version.
    pub fn hash(&self) -> u128 {
        self.hash
    }

    /// Runs it in the root of the repository; what it said is the error.
    pub fn run(&self, top: &str, arguments: &[String]) -> Result<(), Error> {
        let out = Command::new(&self.binary)
            .env("VERILATOR_ROOT", &self.root)
            .current_dir(sources::root())
            .args(arguments)
            .output()
            .map_err(Error::file(&self.binary))?;
        if out.status.success() {
            return Ok(());
        }
        Err(Error::refused(top, &out))
    }
}

/// Where `scripts/tools` puts it.
fn installed() -> Result<PathBuf, Error> {
    let lib = sources::root().join("target/tools/verilator/lib");
    let versions = std::fs::read_dir(&lib).map_err(|_| Error::ToolMissing(format!("no folder {}", lib.display())))?;
    versions
        .flatten()
        .map(|python| python.path().join("site-packages/verilator/bin/verilator_bin"))
        .find(|binary| binary.is_file())
        .ok_or_else(|| Error::ToolMissing(format!("no verilator_bin below {}", lib.display())))
}
