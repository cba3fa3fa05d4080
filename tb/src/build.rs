//! What to build: a top, its sources, parameters and options.

use crate::sources::{self, Sources, root};
use crate::{Error, Model, compile};
use lodray::block::Block;
use lodray::hardware::Hardware;
use std::fmt::Display;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// A model to be built. Two builds of equal content, parameters and options share one shared library, across tests and runs.
#[derive(Clone, Debug)]
pub struct Build {
    pub(crate) top: String,
    pub(crate) parameters: Vec<(String, String)>,
    pub(crate) trace: bool,
    pub(crate) coverage: bool,
    files: Files,
}

#[derive(Clone, Debug)]
enum Files {
    /// Of `rtl/`, and these.
    Rtl(Vec<PathBuf>),
    /// These alone, as a synthesis tool wrote them.
    Netlist(Vec<PathBuf>),
}

impl Build {
    /// A top of `rtl/`.
    pub fn rtl(top: &str) -> Self {
        Self::of(top, Files::Rtl(Vec::new()))
    }

    /// The RTL of a block.
    pub fn block<B: Block>() -> Self {
        Self::rtl(B::NAME)
    }

    /// A top of one of these files, which may use the modules of `rtl/`.
    pub fn with_files(top: &str, files: Vec<PathBuf>) -> Self {
        Self::of(top, Files::Rtl(files))
    }

    /// A top of these Verilog files alone: what synthesis made of the RTL. Its parameters are settled, warnings are not errors.
    pub fn netlist(top: &str, files: Vec<PathBuf>) -> Self {
        Self::of(top, Files::Netlist(files))
    }

    fn of(top: &str, files: Files) -> Self {
        let coverage = std::env::var_os("LODRAY_COVERAGE").is_some();
        Self { top: top.to_owned(), parameters: Vec::new(), trace: false, coverage, files }
    }

    /// With the sizes of this hardware: the package that it prints in place of that of `rtl/`.
    pub fn hardware(mut self, hardware: &Hardware) -> Result<Self, Error> {
        if let Files::Rtl(extra) = &mut self.files {
            extra.extend(sources::package(hardware)?);
        }
        Ok(self)
    }

    /// Sets a parameter of the top.
    pub fn parameter(mut self, name: &str, value: impl Display) -> Self {
        self.parameters.push((name.to_owned(), value.to_string()));
        self
    }

    /// Lets the model write waveforms.
    pub fn trace(mut self) -> Self {
        self.trace = true;
        self
    }

    /// Lets the model count lines and toggles, as the environment variable `LODRAY_COVERAGE` does for all.
    pub fn coverage(mut self) -> Self {
        self.coverage = true;
        self
    }

    /// The name of the top.
    pub fn top(&self) -> &str {
        &self.top
    }

    /// Whether the top is a synthesised netlist.
    pub(crate) fn is_netlist(&self) -> bool {
        matches!(self.files, Files::Netlist(_))
    }

    pub(crate) fn sources(&self) -> Result<Sources, Error> {
        match &self.files {
            Files::Rtl(extra) => Sources::with(extra, &self.top),
            Files::Netlist(files) => Sources::exactly(files),
        }
    }

    /// Builds it, or takes what an earlier build left, and loads it; with `LODRAY_NETLISTS`, that folder's netlist of it.
    pub fn model(&self) -> Result<Arc<Model>, Error> {
        match (&self.files, std::env::var_os("LODRAY_NETLISTS")) {
            (Files::Rtl(extra), Some(folder)) if extra.is_empty() => compile::model(&self.synthesised(&root().join(folder))),
            _ => compile::model(self),
        }
    }

    /// The netlist that a folder holds of it: the parameters are in the file's name (`tri_test-EDGES_PER_CYCLE=1.v`), and settled.
    fn synthesised(&self, folder: &Path) -> Self {
        let parameters: String = self.parameters.iter().map(|(name, value)| format!("-{name}={value}")).collect();
        let file = folder.join(format!("{}{parameters}.v", self.top));
        Self { parameters: Vec::new(), files: Files::Netlist(vec![file]), ..self.clone() }
    }
}
