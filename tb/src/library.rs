//! The C interface of `shim.cpp`, found in a compiled model.

use crate::{Direction, Error, Port};
use libloading::Library;
use std::ffi::{CStr, c_char, c_int, c_void};
use std::path::Path;

/// One simulated top, owned by the shim.
pub(crate) type Instance = *mut c_void;

#[repr(C)]
struct RawPort {
    name: *const c_char,
    width: u32,
    output: u32,
}

/// The shim's `Batch`, field for field.
#[repr(C)]
pub(crate) struct RawBatch {
    pub input: *const u64,
    pub tags: *const u64,
    pub out: *mut u64,
    pub out_tags: *mut u64,
    pub presented: *mut u64,
    pub accepted: *mut u64,
    pub offered: *mut u64,
    pub delivered: *mut u64,
    pub in_stride: u64,
    pub out_stride: u64,
    pub count: u64,
    pub seed: u64,
    pub patience: u64,
    pub quiet: u64,
    pub vcd_from: u64,
    pub vcd_to: u64,
    pub vcd: *const c_char,
    pub stalled: u32,
    pub violation: u32,
    pub cycles: u64,
    pub received: u64,
}

/// The functions, and the library that they stand in.
pub(crate) struct Functions {
    pub new: unsafe extern "C" fn(u64) -> Instance,
    pub delete: unsafe extern "C" fn(Instance),
    pub poke: unsafe extern "C" fn(Instance, u32, *const u64),
    pub peek: unsafe extern "C" fn(Instance, u32, *mut u64),
    pub eval: unsafe extern "C" fn(Instance),
    pub clock: unsafe extern "C" fn(Instance),
    pub cycle: unsafe extern "C" fn(Instance) -> u64,
    pub failed: unsafe extern "C" fn(Instance) -> c_int,
    pub vcd_open: Option<unsafe extern "C" fn(Instance, *const c_char) -> c_int>,
    pub vcd_close: Option<unsafe extern "C" fn(Instance)>,
    pub coverage: Option<unsafe extern "C" fn(Instance, *const c_char)>,
    pub run: Option<unsafe extern "C" fn(Instance, *mut RawBatch)>,
    _library: Library,
}

impl Functions {
    /// Loads a model and reads its ports.
    pub fn load(path: &Path) -> Result<(Self, Vec<Port>), Error> {
        let failed = |source| Error::Load { path: path.to_path_buf(), source };
        // SAFETY: the library was compiled from the shim and a Verilator model; loading it runs only their static initialisers.
        let library = unsafe { Library::new(path) }.map_err(failed)?;
        macro_rules! function {
            ($name:literal) => {
                // SAFETY: the field that takes it has the type that `shim.cpp` declares.
                *unsafe { library.get($name) }.map_err(failed)?
            };
        }
        macro_rules! optional {
            ($name:literal) => {
                // SAFETY: as above; a model without this option has no such symbol.
                unsafe { library.get($name) }.ok().map(|symbol| *symbol)
            };
        }
        let ports: unsafe extern "C" fn(*mut u32) -> *const RawPort = function!(b"lodray_ports");
        let mut count = 0u32;
        // SAFETY: it sets `count` and returns a static array of that length.
        let ports = unsafe { std::slice::from_raw_parts(ports(&mut count), count as usize) };
        let ports = ports
            .iter()
            .map(|port| Port {
                // SAFETY: the names are string literals of the shim, copied here.
                name: unsafe { CStr::from_ptr(port.name) }.to_string_lossy().into_owned(),
                width: port.width,
                direction: if port.output == 0 { Direction::In } else { Direction::Out },
            })
            .collect();
        let functions = Self {
            new: function!(b"lodray_new"),
            delete: function!(b"lodray_delete"),
            poke: function!(b"lodray_poke"),
            peek: function!(b"lodray_peek"),
            eval: function!(b"lodray_eval"),
            clock: function!(b"lodray_clock"),
            cycle: function!(b"lodray_cycle"),
            failed: function!(b"lodray_failed"),
            vcd_open: optional!(b"lodray_vcd_open"),
            vcd_close: optional!(b"lodray_vcd_close"),
            coverage: optional!(b"lodray_coverage"),
            run: optional!(b"lodray_run"),
            _library: library,
        };
        Ok((functions, ports))
    }
}
