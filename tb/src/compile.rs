//! From a [`Build`] to a loaded shared library: Verilator, the C++ compiler, and a cache under `target/verilator`.
//!
//! A library stands in the cache under two names: the hash of all that goes into Verilator, and the hash of the C++ that comes out, so that
//! a change that does not reach a top (another block's latency in the package) costs no compilation. Each name appears when its file is
//! whole: processes that build the same one at the same time do so twice, and neither sees half of it. Threads of one process build it once.

use crate::cxx::Compiler;
use crate::sources::root;
use crate::{Build, Error, Model, Verilator, ports};
use std::collections::HashMap;
use std::path::{Path, PathBuf};
use std::sync::{Arc, LazyLock, Mutex, PoisonError};
use xxhash_rust::xxh3::Xxh3;

const SHIM: &str = include_str!("../shim/shim.cpp");
/// Unknown and initial values are random, so that nothing comes to rely on them. Functions are short: the C++ compiler takes more than in
/// proportion to their length, and many files are compiled at once.
const FLAGS: [&str; 12] = [
    "--cc",
    "--no-timing",
    "--assert",
    "--x-initial",
    "unique",
    "--x-assign",
    "unique",
    "--prefix",
    "Vtop",
    "-O3",
    "--output-split-cfuncs",
    "1000",
];
/// A synthesis tool's output is checked as a netlist, not as a text.
const NETLIST_FLAGS: [&str; 1] = ["-Wno-fatal"];

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
    compiler: Compiler,
    arguments: Vec<String>,
    key: u128,
}

impl<'a> Job<'a> {
    fn new(build: &'a Build) -> Result<Self, Error> {
        let verilator = Verilator::find()?;
        let compiler = Compiler::new(&verilator, build.trace, build.coverage);
        let sources = build.sources()?;
        let mut arguments: Vec<String> = FLAGS.map(str::to_owned).to_vec();
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

        let mut job = Self { build, verilator, compiler, arguments, key: 0 };
        let mut hash = job.hash();
        for argument in &job.arguments {
            update(&mut hash, argument.as_bytes());
        }
        for (_, content) in sources.contents() {
            update(&mut hash, content);
        }
        job.key = hash.digest128();
        Ok(job)
    }

    /// The hash of the tools.
    fn hash(&self) -> Xxh3 {
        let mut hash = Xxh3::new();
        hash.update(&self.verilator.hash().to_le_bytes());
        self.compiler.identify(&mut hash);
        update(&mut hash, SHIM.as_bytes());
        hash
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
        let generated = self.verilate(work.path())?;
        let by_output = cache.join(format!("cxx-{generated:032x}.so"));
        if !by_output.is_file() {
            let runtime = self.compiler.runtime(&self.verilator, &cache)?;
            let whole = self.compiler.library(work.path(), &runtime)?;
            std::fs::rename(&whole, &by_output).map_err(Error::file(&by_output))?;
        }
        // It may be there from another process by now, or the file system may know no links: the first name serves as well.
        let _ = std::fs::hard_link(&by_output, &library);
        Ok(by_output)
    }

    /// Writes the C++ of the model and the shim into a folder; returns the hash of all of it.
    fn verilate(&self, folder: &Path) -> Result<u128, Error> {
        let mut arguments = vec!["--Mdir".to_owned(), folder.display().to_string()];
        arguments.extend_from_slice(&self.arguments);
        self.verilator.run(&self.build.top, &arguments)?;
        let header = folder.join("Vtop.h");
        let header = std::fs::read_to_string(&header).map_err(Error::file(&header))?;
        write(&folder.join("ports.h"), &ports::table(&ports::parse(&self.build.top, &header)?))?;
        write(&folder.join("shim.cpp"), SHIM)?;

        let mut files = Vec::new();
        for entry in std::fs::read_dir(folder).map_err(Error::file(folder))? {
            let path = entry.map_err(Error::file(folder))?.path();
            files.extend(Some(path).filter(|path| path.extension().is_some_and(|e| e == "cpp" || e == "h")));
        }
        files.sort();
        let mut hash = self.hash();
        for path in files {
            update(&mut hash, path.file_name().unwrap_or_default().as_encoded_bytes());
            update(&mut hash, &std::fs::read(&path).map_err(Error::file(&path))?);
        }
        Ok(hash.digest128())
    }
}

/// Adds one text with its length, so that no two lists of texts are the same.
fn update(hash: &mut Xxh3, text: &[u8]) {
    hash.update(&text.len().to_le_bytes());
    hash.update(text);
}

fn write(path: &Path, text: &str) -> Result<(), Error> {
    std::fs::write(path, text).map_err(Error::file(path))
}
