//! The cycle model of the traversal unit: its ports, cycle by cycle.

use crate::error::{Refused, done, guarded, refused};
use crate::pointers::{end, exclusive, handle, place, shared};
use crate::ports::{LodrayInputs, LodrayOutputs, LodraySceneConfig};
use lodray::block::EdgesPerCycle;
use lodray::hardware::Hardware;
use lodray::sim::unit::TraversalUnit;
use std::ffi::c_int;

/// The cycle model of `rtl/traversal_unit.sv`: the same at every port in every cycle. One thread at a time may use it.
pub struct LodrayUnit {
    unit: TraversalUnit,
    is_secondary: bool,
}

/// Sizes of a unit; what is 0 is as in `rtl/lod_pkg.sv`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct LodrayHardware {
    /// Rays under way, 1 to 64; 0: 4.
    pub contexts: u32,
    /// Edge functions that the triangle test evaluates in a cycle, 1 or 3; 0: 1.
    pub edges_per_cycle: u32,
    /// 1: rays can start on a surface, count only hits within a range of t, and end at any of them.
    pub secondary: u8,
}

impl LodrayHardware {
    fn hardware(&self) -> Result<Hardware, Refused> {
        let usual = Hardware::DEFAULT;
        let edges = if self.edges_per_cycle == 0 { usual.edges_per_cycle.count() } else { self.edges_per_cycle };
        let Some(edges_per_cycle) = EdgesPerCycle::new(edges) else {
            return refused(format!("hardware: edges_per_cycle must be 1 or 3, but is {edges}"));
        };
        let contexts = if self.contexts == 0 { usual.contexts } else { self.contexts as usize };
        let hardware = Hardware { contexts, edges_per_cycle, secondary: self.secondary != 0, ..usual };
        hardware.validate()?;
        Ok(hardware)
    }
}

/// A unit behind its reset, for the scene of `config`; `hardware` is null for that of `rtl/lod_pkg.sv`. Null if there is no such unit. End it with `lodray_unit_end`.
///
/// # Safety
/// `config`, and `hardware` if it is not null, are such structs.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn lodray_unit_begin(config: *const LodraySceneConfig, hardware: *const LodrayHardware) -> *mut LodrayUnit {
    guarded(std::ptr::null_mut(), || {
        // SAFETY: the caller's promise.
        let config = unsafe { shared("config", config) }?.wire("config")?;
        // SAFETY: the caller's promise.
        let hardware = if hardware.is_null() { &LodrayHardware::default() } else { unsafe { shared("hardware", hardware) }? };
        let hardware = hardware.hardware()?;
        Ok(handle(LodrayUnit { unit: TraversalUnit::new(hardware, config), is_secondary: hardware.secondary }))
    })
}

/// Ends a unit. Null does nothing.
///
/// # Safety
/// The unit is null, or of `lodray_unit_begin`, and nobody uses it any more.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn lodray_unit_end(unit: *mut LodrayUnit) {
    // SAFETY: the caller's promise.
    unsafe { end(unit) };
}

/// Writes the output ports of this cycle. They come from registers: inputs of the same cycle do not change them.
///
/// # Safety
/// The unit is alive, `outputs` has room for one.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn lodray_unit_outputs(unit: *const LodrayUnit, outputs: *mut LodrayOutputs) -> c_int {
    done(|| {
        // SAFETY: the caller's promise.
        let (unit, outputs) = unsafe { (shared("unit", unit)?, place("outputs", outputs)?) };
        outputs.write(LodrayOutputs::of(&unit.unit.outputs()));
        Ok(())
    })
}

/// The rising edge that ends this cycle, with these inputs. What is offered must stand still until it is taken: a ray at `valid_i` and `ready_o`, a hit at `valid_o` and
/// `ready_i`, a request at `mem_valid_o` and `mem_ready_i`, all in the same cycle. Nothing has happened if it fails.
///
/// # Safety
/// The unit is alive, `inputs` such a struct.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn lodray_unit_step(unit: *mut LodrayUnit, inputs: *const LodrayInputs) -> c_int {
    done(|| {
        // SAFETY: the caller's promise.
        let (unit, inputs) = unsafe { (exclusive("unit", unit)?, shared("inputs", inputs)?) };
        let inputs = inputs.wire(unit.is_secondary)?;
        unit.unit.tick(&inputs);
        Ok(())
    })
}

/// The rising edge that ends this cycle, with `rst_ni` low.
///
/// # Safety
/// The unit is alive.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn lodray_unit_reset(unit: *mut LodrayUnit) -> c_int {
    done(|| {
        // SAFETY: the caller's promise.
        unsafe { exclusive("unit", unit) }?.unit.reset();
        Ok(())
    })
}

/// Another scene from this cycle on: only while `busy_o` is 0.
///
/// # Safety
/// The unit is alive, `config` such a struct.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn lodray_unit_scene(unit: *mut LodrayUnit, config: *const LodraySceneConfig) -> c_int {
    done(|| {
        // SAFETY: the caller's promise.
        let (unit, config) = unsafe { (exclusive("unit", unit)?, shared("config", config)?.wire("config")?) };
        if unit.unit.outputs().busy {
            return refused("config: rays are under way");
        }
        unit.unit.set_scene(config);
        Ok(())
    })
}
