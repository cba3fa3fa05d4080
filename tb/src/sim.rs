//! [`Sim`]: one simulated top, driven port by port and cycle by cycle.
//!
//! A cycle: [`Sim::poke`] the inputs, [`Sim::eval`], [`Sim::peek`] the outputs, [`Sim::clock`] to end it.

use crate::library::Instance;
use crate::{Direction, Error, Model};
use lodray::num::Wire;
use std::ffi::CString;
use std::os::unix::ffi::OsStrExt;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};

/// A port of one model, found by [`Sim::port`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PortId {
    index: u32,
    width: u32,
    direction: Direction,
}

/// A simulated top. Registers start with random values of the seed; `rst_ni` is the caller's.
pub struct Sim {
    instance: Instance,
    model: Arc<Model>,
    buffer: Vec<u64>,
}

// SAFETY: an instance has no ties to the thread that made it: the shim tells Verilator's runtime its context at every entry.
unsafe impl Send for Sim {}

impl Sim {
    /// A new simulation.
    pub fn new(model: &Arc<Model>, seed: u64) -> Self {
        let words = model.ports().iter().map(crate::Port::words).max().unwrap_or(1);
        // SAFETY: the function is the shim's.
        let instance = unsafe { (model.functions.new)(seed) };
        Self { instance, model: model.clone(), buffer: vec![0; words] }
    }

    /// The port of that name, which must have this width and direction.
    pub fn port(&self, name: &str, width: u32, direction: Direction) -> Result<PortId, Error> {
        let ports = self.model.ports();
        let wrong = |what: String| Error::Ports { top: self.model.top().to_owned(), what };
        let index = ports.iter().position(|port| port.name == name).ok_or_else(|| wrong(format!("no port {name}")))?;
        let port = &ports[index];
        if port.width != width || port.direction != direction {
            return Err(wrong(format!("port {name} has {} bits and goes {:?}, not {width} and {direction:?}", port.width, port.direction)));
        }
        Ok(PortId { index: index as u32, width, direction }) // tops have few ports
    }

    /// Sets an input. Panics if the port is an output or the value of another width.
    pub fn poke<T: Wire>(&mut self, port: PortId, value: &T) {
        assert!(port.direction == Direction::In && port.width == T::WIDTH, "poke of {} bits at {port:?}", T::WIDTH);
        value.to_words(&mut self.buffer[..T::WIDTH.div_ceil(64) as usize]);
        // SAFETY: the index is of this shim's table, and the buffer holds the widest port.
        unsafe { (self.model.functions.poke)(self.instance, port.index, self.buffer.as_ptr()) };
    }

    /// Reads a port. Panics if the value has another width.
    pub fn peek<T: Wire>(&mut self, port: PortId) -> T {
        assert!(port.width == T::WIDTH, "peek of {} bits at {port:?}", T::WIDTH);
        self.buffer.fill(0);
        // SAFETY: as above.
        unsafe { (self.model.functions.peek)(self.instance, port.index, self.buffer.as_mut_ptr()) };
        T::from_words(&self.buffer)
    }

    /// Lets the outputs follow the inputs within this cycle.
    pub fn eval(&mut self) {
        // SAFETY: the instance lives as long as `self`.
        unsafe { (self.model.functions.eval)(self.instance) };
    }

    /// The rising edge that ends this cycle.
    pub fn clock(&mut self) {
        // SAFETY: as above.
        unsafe { (self.model.functions.clock)(self.instance) };
    }

    /// Cycles ended so far.
    pub fn cycle(&self) -> u64 {
        // SAFETY: as above.
        unsafe { (self.model.functions.cycle)(self.instance) }
    }

    /// Whether an assertion of the RTL has failed; Verilator prints which.
    pub fn failed(&self) -> bool {
        // SAFETY: as above.
        unsafe { (self.model.functions.failed)(self.instance) != 0 }
    }

    /// Starts a waveform (VCD); the model must be built with [`crate::Build::trace`]. Cycle c has its values from time 10 c + 5 to 10 c + 9,
    /// the rising edge that ends it is at 10 (c + 1).
    pub fn open_vcd(&mut self, path: &Path) -> Result<(), Error> {
        let open = self
            .model
            .functions
            .vcd_open
            .ok_or_else(|| Error::Ports { top: self.model.top().to_owned(), what: "built without waveforms".to_owned() })?;
        let name = c_path(path)?;
        // SAFETY: the instance lives as long as `self`, and the name ends with a zero.
        match unsafe { open(self.instance, name.as_ptr()) } {
            0 => Err(Error::file(path)(std::io::Error::other("cannot be written"))),
            _ => Ok(()),
        }
    }

    /// Ends the waveform.
    pub fn close_vcd(&mut self) {
        if let Some(close) = self.model.functions.vcd_close {
            // SAFETY: the instance lives as long as `self`.
            unsafe { close(self.instance) };
        }
    }

    pub(crate) fn instance(&mut self) -> Instance {
        self.instance
    }

    pub(crate) fn model(&self) -> &Arc<Model> {
        &self.model
    }
}

/// A path as the shim takes it.
pub(crate) fn c_path(path: &Path) -> Result<CString, Error> {
    CString::new(path.as_os_str().as_bytes()).map_err(|nul| Error::file(path)(std::io::Error::other(nul)))
}

impl Drop for Sim {
    fn drop(&mut self) {
        static COUNT: AtomicU64 = AtomicU64::new(0);
        if let (Some(coverage), Some(folder)) = (self.model.functions.coverage, std::env::var_os("LODRAY_COVERAGE")) {
            let number = COUNT.fetch_add(1, Ordering::Relaxed);
            let folder = crate::root().join(PathBuf::from(folder));
            let path = folder.join(format!("{}-{}-{number}.dat", self.model.top(), std::process::id()));
            match std::fs::create_dir_all(&folder).map_err(Error::file(&folder)).and_then(|()| c_path(&path)) {
                // SAFETY: the instance still lives, and the name ends with a zero.
                Ok(name) => unsafe { coverage(self.instance, name.as_ptr()) },
                Err(error) => eprintln!("no coverage data: {error}"),
            }
        }
        // SAFETY: nothing uses the instance after this.
        unsafe { (self.model.functions.delete)(self.instance) };
    }
}
