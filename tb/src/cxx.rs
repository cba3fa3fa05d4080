//! The C++ compiler: objects of generated files, and of Verilator's own runtime, which is compiled once for all models.

use crate::{Error, Verilator};
use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::{Condvar, LazyLock, Mutex, PoisonError};
use xxhash_rust::xxh3::Xxh3;

const FLAGS: [&str; 6] = ["-std=c++17", "-fPIC", "-w", "-fvisibility=hidden", "-DVL_TIME_CONTEXT", "-DVM_SC=0"];
/// For what runs in every cycle, and for what runs once. With more the compiler takes longer than the usual tests save.
const FAST: &str = "-O1";
const SLOW: &str = "-O0";
/// How the names of files end that run once.
const SLOW_ENDING: &str = "__Slow.cpp";
/// Files are compiled together up to this size.
const UNIT_BYTES: u64 = 1_500_000;
/// The runtime's files, and the options that need them.
const RUNTIME: [(&str, Need); 4] =
    [("verilated", Need::Always), ("verilated_threads", Need::Always), ("verilated_vcd_c", Need::Trace), ("verilated_cov", Need::Coverage)];

#[derive(Clone, Copy, PartialEq, Eq)]
enum Need {
    Always,
    Trace,
    Coverage,
}

/// Verilator's headers, compiled for files that run in every cycle and for those that run once.
struct Headers {
    fast: PathBuf,
    slow: PathBuf,
}

/// The compiler, set up for models with or without waveforms and coverage.
pub(crate) struct Compiler {
    command: String,
    include: PathBuf,
    trace: bool,
    coverage: bool,
}

impl Compiler {
    /// The one of `CXX`, else `c++`.
    pub fn new(verilator: &Verilator, trace: bool, coverage: bool) -> Self {
        let command = std::env::var("CXX").unwrap_or_else(|_| "c++".to_owned());
        Self { command, include: verilator.include(), trace, coverage }
    }

    /// All that makes its output what it is.
    pub fn identify(&self, hash: &mut Xxh3) {
        for text in [self.command.as_str(), FAST, SLOW].into_iter().chain(FLAGS) {
            hash.update(text.as_bytes());
            hash.update(&[0]);
        }
    }

    /// A shared library of all `.cpp` files of a folder and the runtime.
    pub fn library(&self, folder: &Path, runtime: &Path) -> Result<PathBuf, Error> {
        let units = units(folder)?;
        let headers = Headers { fast: self.header(runtime, FAST)?, slow: self.header(runtime, SLOW)? };
        let mut objects = self.objects(folder, &units, Some(&headers))?;
        let needed = RUNTIME.into_iter().filter(|(_, need)| match need {
            Need::Always => true,
            Need::Trace => self.trace,
            Need::Coverage => self.coverage,
        });
        objects.extend(needed.map(|(name, _)| runtime.join(name).with_extension("o")));
        let library = folder.join("whole.so");
        let mut link = vec!["-shared".to_owned(), "-pthread".to_owned(), "-o".to_owned(), library.display().to_string()];
        link.extend(objects.iter().map(|path| path.display().to_string()));
        self.run(&link)?;
        Ok(library)
    }

    /// The folder with the runtime's objects, made if it is not there. They do not depend on a model's options.
    pub fn runtime(&self, verilator: &Verilator, cache: &Path) -> Result<PathBuf, Error> {
        static MAKING: Mutex<()> = Mutex::new(());
        let _making = MAKING.lock().unwrap_or_else(PoisonError::into_inner);
        let mut hash = Xxh3::new();
        hash.update(&verilator.hash().to_le_bytes());
        self.identify(&mut hash);
        let runtime = cache.join(format!("runtime-{:032x}", hash.digest128()));
        if runtime.is_dir() {
            return Ok(runtime);
        }
        let work = tempfile::Builder::new().prefix("build-").tempdir_in(cache).map_err(Error::file(cache))?;
        let sources = RUNTIME.map(|(name, _)| self.include.join(name).with_extension("cpp"));
        self.objects(work.path(), &sources, None)?;
        match std::fs::rename(work.path(), &runtime) {
            // Another process was faster.
            Err(_) if runtime.is_dir() => Ok(runtime),
            result => result.map(|()| runtime.clone()).map_err(Error::file(&runtime)),
        }
    }

    /// Verilator's headers, compiled for files of this level of optimisation, in the runtime's folder: most of a small file's time goes into them.
    fn header(&self, runtime: &Path, level: &str) -> Result<PathBuf, Error> {
        static MAKING: Mutex<()> = Mutex::new(());
        let _making = MAKING.lock().unwrap_or_else(PoisonError::into_inner);
        let header = runtime.join(format!("verilated{level}-{}{}.h", u8::from(self.trace), u8::from(self.coverage)));
        let compiled = header.with_extension("h.gch");
        if !compiled.is_file() {
            let work = tempfile::tempdir_in(runtime).map_err(Error::file(runtime))?;
            let text = if self.trace { "#include \"verilated.h\"\n#include \"verilated_vcd_c.h\"\n" } else { "#include \"verilated.h\"\n" };
            let (source, made) = (work.path().join("verilated-all.h"), work.path().join("made"));
            std::fs::write(&source, text).map_err(Error::file(&source))?;
            let mut arguments = self.options(level, runtime);
            arguments.extend(["-x", "c++-header", "-o"].map(str::to_owned));
            arguments.extend([made.display().to_string(), source.display().to_string()]);
            self.run(&arguments)?;
            // Both may be there from another process by now, which made the same. What was compiled comes last: it is what the next one looks for.
            std::fs::rename(&source, &header).map_err(Error::file(&header))?;
            std::fs::rename(&made, &compiled).map_err(Error::file(&compiled))?;
        }
        Ok(header)
    }

    /// What all runs for files of a folder have in common, at one level of optimisation.
    fn options(&self, level: &str, folder: &Path) -> Vec<String> {
        let mut options: Vec<String> = FLAGS.map(str::to_owned).to_vec();
        options.push(level.to_owned());
        for (name, on) in [("VM_TRACE", self.trace), ("VM_TRACE_VCD", self.trace), ("VM_COVERAGE", self.coverage)] {
            options.push(format!("-D{name}={}", u32::from(on)));
        }
        for include in [folder, &self.include, &self.include.join("vltstd")] {
            options.extend(["-isystem".to_owned(), include.display().to_string()]);
        }
        options
    }

    /// Compiles each file, as many at once as there are cores.
    fn objects(&self, folder: &Path, sources: &[PathBuf], headers: Option<&Headers>) -> Result<Vec<PathBuf>, Error> {
        std::thread::scope(|scope| {
            let jobs: Vec<_> = sources.iter().map(|source| scope.spawn(|| self.object(folder, source, headers))).collect();
            jobs.into_iter().map(|job| job.join().unwrap_or_else(|panic| std::panic::resume_unwind(panic))).collect()
        })
    }

    fn object(&self, folder: &Path, source: &Path, headers: Option<&Headers>) -> Result<PathBuf, Error> {
        let stem = source.file_stem().unwrap_or_default().to_string_lossy();
        let object = folder.join(format!("{stem}.o"));
        let is_slow = source.to_string_lossy().ends_with(SLOW_ENDING);
        let mut arguments = self.options(if is_slow { SLOW } else { FAST }, folder);
        if let Some(Headers { fast, slow }) = headers {
            arguments.extend(["-include".to_owned(), if is_slow { slow } else { fast }.display().to_string()]);
        }
        arguments.extend(["-c", "-o"].map(str::to_owned));
        arguments.extend([object.display().to_string(), source.display().to_string()]);
        self.run(&arguments)?;
        Ok(object)
    }

    /// One run; no more of them at once than there are cores.
    fn run(&self, arguments: &[String]) -> Result<(), Error> {
        let _permit = Permit::take();
        let out = Command::new(&self.command).args(arguments).output().map_err(Error::file(&self.command))?;
        if out.status.success() {
            return Ok(());
        }
        let output = String::from_utf8_lossy(&out.stderr).trim().to_owned();
        Err(Error::Compiler { compiler: self.command.clone(), output })
    }
}

/// Joins the `.cpp` files of a folder into fewer ones: most of a small file's time goes into Verilator's headers.
fn units(folder: &Path) -> Result<Vec<PathBuf>, Error> {
    let mut files = Vec::new();
    for entry in std::fs::read_dir(folder).map_err(Error::file(folder))? {
        let entry = entry.map_err(Error::file(folder))?;
        let (name, path) = (entry.file_name().to_string_lossy().into_owned(), entry.path());
        if name.ends_with(".cpp") {
            let size = std::fs::metadata(&path).map_err(Error::file(&path))?.len();
            files.push((name.ends_with(SLOW_ENDING), name, size));
        }
    }
    files.sort();
    let mut units: Vec<(bool, String, u64)> = Vec::new();
    for (slow, name, size) in files {
        let include = format!("#include \"{name}\"\n");
        match units.last_mut() {
            Some(unit) if unit.0 == slow && (slow || unit.2 + size <= UNIT_BYTES) => {
                unit.1 += &include;
                unit.2 += size;
            }
            _ => units.push((slow, include, size)),
        }
    }
    let written = units.into_iter().enumerate().map(|(k, (slow, text, _))| {
        let path = folder.join(format!("unit{k}{}", if slow { SLOW_ENDING } else { ".cpp" }));
        std::fs::write(&path, text).map_err(Error::file(&path)).map(|()| path)
    });
    written.collect()
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
