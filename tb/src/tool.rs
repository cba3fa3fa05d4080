//! Verilator itself: where it is, which one it is, and a run of it; and slang, a second reader of the RTL.

use crate::Error;
use crate::sources::{self, Sources};
use lodray::hardware::Hardware;
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
        let output = format!("{}{}", String::from_utf8_lossy(&out.stdout), String::from_utf8_lossy(&out.stderr)).trim().to_owned();
        Err(Error::Refused { top: top.to_owned(), output })
    }
}

/// Lints a top of `rtl/` with the sizes of this hardware and every warning on; a warning is an error.
pub fn lint(top: &str, parameters: &[(&str, u64)], hardware: &Hardware) -> Result<(), Error> {
    let package: Vec<PathBuf> = sources::package(hardware)?.into_iter().collect();
    let sources = Sources::with(&package, top)?;
    let mut arguments = vec!["--lint-only".to_owned(), "-Wall".to_owned(), "--top-module".to_owned(), top.to_owned()];
    arguments.extend(parameters.iter().map(|(name, value)| format!("-G{name}={value}")));
    arguments.extend(sources.arguments());
    Verilator::find()?.run(top, &arguments)
}

/// Elaborates all of `rtl/` with slang, which takes the standard by its word, with the sizes of this hardware; `options` are slang's. A warning is an error.
pub fn elaborate(options: &[&str], hardware: &Hardware) -> Result<(), Error> {
    slang("scripts/elaborate.py", options, hardware).map(drop)
}

/// Bits of the registers that a top declares, with everything in it: variables that are written at a clock edge, memories too.
pub fn registers(top: &str, parameters: &[(&str, u64)], hardware: &Hardware) -> Result<u32, Error> {
    let given: Vec<String> = parameters.iter().map(|(name, value)| format!("-G{name}={value}")).collect();
    let mut options = vec!["--top", top];
    options.extend(given.iter().map(String::as_str));
    let said = slang("scripts/registers.py", &options, hardware)?;
    said.trim().parse().map_err(|_| Error::Refused { top: top.to_owned(), output: said })
}

/// Runs one of the scripts that use slang on all of `rtl/`; what it printed.
fn slang(script: &str, options: &[&str], hardware: &Hardware) -> Result<String, Error> {
    let python = sources::root().join("target/tools/slang/bin/python3");
    if !python.is_file() {
        return Err(Error::ToolMissing(format!("no file {}", python.display())));
    }
    let folder = sources::rtl();
    let entries = std::fs::read_dir(&folder).map_err(Error::file(&folder))?;
    let mut files: Vec<PathBuf> = entries.flatten().map(|e| e.path()).filter(|p| p.extension().is_some_and(|e| e == "sv")).collect();
    // The package comes before its users.
    files.sort_by_key(|path| (!path.ends_with("lod_pkg.sv"), path.clone()));
    if let (Some(package), Some(first)) = (sources::package(hardware)?, files.first_mut()) {
        *first = package;
    }
    let mut command = Command::new(&python);
    let out = command.arg(script).args(options).args(&files).current_dir(sources::root()).output();
    let out = out.map_err(Error::file(&python))?;
    if out.status.success() {
        return Ok(String::from_utf8_lossy(&out.stdout).into_owned());
    }
    let output = format!("{}{}", String::from_utf8_lossy(&out.stdout), String::from_utf8_lossy(&out.stderr)).trim().to_owned();
    Err(Error::Refused { top: "rtl".to_owned(), output })
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
