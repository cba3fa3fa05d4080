//! From a [`Build`] to a loaded shared library: Verilator, the C++ compiler, and a cache under `target/verilator`.
//!
//! A library is named by the hash of all that goes into it, and moved to its place when it is whole: processes that build the same one at
//! the same time do so twice, and neither sees half of it. Threads of one process build it once.

use crate::sources::root;
use crate::{Build, Error, Model, Verilator, ports};
use std::collections::HashMap;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::{Arc, Condvar, LazyLock, Mutex, PoisonError};
use xxhash_rust::xxh3::Xxh3;

const SHIM: &str = include_str!("../shim/shim.cpp");
/// Warnings that only a synthesis tool's output has: it is checked as a netlist, not as a text.
const NETLIST_FLAGS: [&str; 1] = ["-Wno-fatal"];
const VERILATOR_FLAGS: [&str; 10] =
    ["--cc", "--no-timing", "--assert", "--x-initial", "unique", "--x-assign", "unique", "--prefix", "Vtop", "-O3"];
const CXX_FLAGS: [&str; 6] = ["-std=c++17", "-fPIC", "-w", "-fvisibility=hidden", "-DVL_TIME_CONTEXT", "-DVM_SC=0"];
/// For what runs in every cycle, and for what runs once.
const FAST: &str = "-O2";
const SLOW: &str = "-O1";

type Slot = Arc<Mutex<Option<Arc<Model>>>>;

/// The model of a build, from this process, from the cache, or built now.
pub(crate) fn model(build: &Build) -> Result<Arc<Model>, Error> {
    static LOADED: LazyLock<Mutex<HashMap<u128, Slot>>> = LazyLock::new(Mutex::default);
    let job = Job::new(build)?;
    let slot = LOADED.lock().unwrap_or_else(PoisonError::into_inner).entry(job.key).or_default().clone();
    let mut slot = slot.lock().unwrap_or_else(PoisonError::into_inner);
    if let Some(model) = &*slot {
        return Ok(model.clone());
    }
    let library = job.library()?;
    let model = Arc::new(Model::load(build, &library)?);
    *slot = Some(model.clone());
    Ok(model)
}

struct Job<'a> {
    build: &'a Build,
    verilator: Verilator,
    arguments: Vec<String>,
    compiler: String,
    key: u128,
}

impl<'a> Job<'a> {
    fn new(build: &'a Build) -> Result<Self, Error> {
        let verilator = Verilator::find()?;
        let sources = build.sources()?;
        let compiler = std::env::var("CXX").unwrap_or_else(|_| "c++".to_owned());
        let mut arguments: Vec<String> = VERILATOR_FLAGS.map(str::to_owned).to_vec();
        arguments.extend(["--top-module".to_owned(), build.top.clone()]);
        if build.is_netlist() {
            arguments.extend(NETLIST_FLAGS.map(str::to_owned));
        } else {
            arguments.push("-Wall".to_owned());
        }
        arguments.extend(build.parameters.iter().map(|(name, value)| format!("-G{name}={value}")));
        if build.trace {
            arguments.extend(["--trace-vcd", "--trace-structs"].map(str::to_owned));
        }
        if build.coverage {
            arguments.extend(["--coverage-line", "--coverage-toggle"].map(str::to_owned));
        }
        arguments.extend(sources.arguments());

        let mut hash = Xxh3::new();
        hash.update(&verilator.hash().to_le_bytes());
        for text in [SHIM, &compiler, FAST, SLOW].into_iter().chain(CXX_FLAGS).chain(arguments.iter().map(String::as_str)) {
            hash.update(text.as_bytes());
            hash.update(&[0]);
        }
        for (_, content) in sources.contents() {
            hash.update(&content.len().to_le_bytes());
            hash.update(content);
        }
        Ok(Self { build, verilator, arguments, compiler, key: hash.digest128() })
    }

    /// The shared library, built if it is not there.
    fn library(&self) -> Result<PathBuf, Error> {
        let cache = root().join("target/verilator");
        let library = cache.join(format!("{}-{:032x}.so", self.build.top, self.key));
        if library.is_file() {
            return Ok(library);
        }
        std::fs::create_dir_all(&cache).map_err(Error::file(&cache))?;
        let work = tempfile::Builder::new().prefix("build-").tempdir_in(&cache).map_err(Error::file(&cache))?;
        let folder = work.path();

        let mut arguments = vec!["--Mdir".to_owned(), folder.display().to_string()];
        arguments.extend_from_slice(&self.arguments);
        self.verilator.run(&self.build.top, &arguments)?;

        let header = folder.join("Vtop.h");
        let header = std::fs::read_to_string(&header).map_err(Error::file(&header))?;
        write(&folder.join("ports.h"), &ports::table(&ports::parse(&self.build.top, &header)?))?;
        write(&folder.join("shim.cpp"), SHIM)?;

        let mut sources = self.runtime();
        for entry in std::fs::read_dir(folder).map_err(Error::file(folder))? {
            let path = entry.map_err(Error::file(folder))?.path();
            if path.extension().is_some_and(|e| e == "cpp") {
                sources.push(path);
            }
        }
        let objects = self.objects(folder, &sources)?;
        let whole = folder.join("whole.so");
        let mut link = vec!["-shared".to_owned(), "-o".to_owned(), whole.display().to_string()];
        link.extend(objects.iter().map(|path| path.display().to_string()));
        link.push("-pthread".to_owned());
        self.compile(&link)?;
        std::fs::rename(&whole, &library).map_err(Error::file(&library))?;
        Ok(library)
    }

    /// Verilator's own sources that the model needs.
    fn runtime(&self) -> Vec<PathBuf> {
        let names = [
            ("verilated.cpp", true),
            ("verilated_threads.cpp", true),
            ("verilated_vcd_c.cpp", self.build.trace),
            ("verilated_cov.cpp", self.build.coverage),
        ];
        names.into_iter().filter(|(_, needed)| *needed).map(|(name, _)| self.verilator.include().join(name)).collect()
    }

    /// Compiles each file, as many at once as there are cores.
    fn objects(&self, folder: &Path, sources: &[PathBuf]) -> Result<Vec<PathBuf>, Error> {
        std::thread::scope(|scope| {
            let jobs: Vec<_> = sources.iter().map(|source| scope.spawn(|| self.object(folder, source))).collect();
            jobs.into_iter().map(|job| job.join().unwrap_or_else(|panic| std::panic::resume_unwind(panic))).collect()
        })
    }

    fn object(&self, folder: &Path, source: &Path) -> Result<PathBuf, Error> {
        let stem = source.file_stem().unwrap_or_default().to_string_lossy();
        let own = source.starts_with(folder);
        let object = folder.join(format!("{stem}.o"));
        let mut arguments: Vec<String> = CXX_FLAGS.map(str::to_owned).to_vec();
        arguments.push(if own && stem.ends_with("__Slow") { SLOW } else { FAST }.to_owned());
        for (name, on) in [("VM_TRACE", self.build.trace), ("VM_TRACE_VCD", self.build.trace), ("VM_COVERAGE", self.build.coverage)] {
            arguments.push(format!("-D{name}={}", u32::from(on)));
        }
        for include in [folder, &self.verilator.include(), &self.verilator.include().join("vltstd")] {
            arguments.extend(["-isystem".to_owned(), include.display().to_string()]);
        }
        arguments.extend(["-c", "-o"].map(str::to_owned));
        arguments.extend([object.display().to_string(), source.display().to_string()]);
        self.compile(&arguments)?;
        Ok(object)
    }

    /// One run of the compiler; no more of them at once than there are cores.
    fn compile(&self, arguments: &[String]) -> Result<(), Error> {
        let _permit = Permit::take();
        let out = Command::new(&self.compiler).args(arguments).output().map_err(Error::file(&self.compiler))?;
        if out.status.success() {
            return Ok(());
        }
        let output = String::from_utf8_lossy(&out.stderr).trim().to_owned();
        Err(Error::Compiler { compiler: self.compiler.clone(), top: self.build.top.clone(), output })
    }
}

fn write(path: &Path, text: &str) -> Result<(), Error> {
    std::fs::write(path, text).map_err(Error::file(path))
}

/// The right to run one compiler.
struct Permit;

static FREE: LazyLock<(Mutex<usize>, Condvar)> =
    LazyLock::new(|| (Mutex::new(std::thread::available_parallelism().map_or(1, usize::from)), Condvar::new()));

impl Permit {
    fn take() -> Self {
        let (free, changed) = &*FREE;
        let free = free.lock().unwrap_or_else(PoisonError::into_inner);
        let mut free = changed.wait_while(free, |free| *free == 0).unwrap_or_else(PoisonError::into_inner);
        *free -= 1;
        Self
    }
}

impl Drop for Permit {
    fn drop(&mut self) {
        let (free, changed) = &*FREE;
        *free.lock().unwrap_or_else(PoisonError::into_inner) += 1;
        changed.notify_one();
    }
}
