//! [`Model`]: a compiled top, from which simulations are made.

use crate::library::Functions;
use crate::{Build, Error, Port, ports};
use std::path::Path;

/// A compiled and loaded top; [`crate::Sim::new`] makes simulations of it.
pub struct Model {
    pub(crate) functions: Functions,
    top: String,
    ports: Vec<Port>,
}

impl Model {
    pub(crate) fn load(build: &Build, library: &Path) -> Result<Self, Error> {
        let (functions, ports) = Functions::load(library)?;
        Ok(Self { functions, top: build.top().to_owned(), ports })
    }

    /// The name of the top.
    pub fn top(&self) -> &str {
        &self.top
    }

    /// Its ports, in the order of the module.
    pub fn ports(&self) -> &[Port] {
        &self.ports
    }

    /// Widths of `in_i`, `out_o` and the tag, if the top has the ports of a block.
    pub(crate) fn block(&self) -> Option<(u32, u32, u32)> {
        ports::block(&self.ports)
    }
}
