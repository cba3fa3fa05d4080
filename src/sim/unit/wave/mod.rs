//! One ray's waveform (VCD) from the cycle model, with the RTL's hierarchy and signal names, and save files for viewers.
//!
//! The clock has a period of 10 ns; cycle c begins with the rising edge at 10 c ns, where all values change. What no register has held yet is `x`.

mod save;
mod signals;

pub use save::{gtkwave_save, surfer_commands};

use super::environment::{RunReport, UnitPort, run};
use super::{Inputs, Latency, Outputs, SceneMemory, Traffic, TraversalUnit, UnitError};
use crate::num::Ray;
use signals::{Shown, Vector, Visitor, walk};
use std::collections::BTreeMap;
use std::io;
use vcd::{IdCode, ReferenceIndex, SimulationCommand, TimescaleUnit, Value, VarType};

/// Nanoseconds of a cycle.
pub const PERIOD: u64 = 10;
/// Idle cycles before the ray comes and after its hit is taken.
const IDLE_BEFORE: u32 = 2;
const IDLE_AFTER: u32 = 3;

/// Takes `ray` through an idle `unit` with a memory of this latency, a few idle cycles before and behind.
///
/// # Errors
/// As [`run`].
pub fn one_ray(unit: &mut impl UnitPort, memory: &SceneMemory<'_>, latency: u32, ray: &Ray) -> Result<RunReport, UnitError> {
    let idle = Inputs { hit_ready: true, mem_ready: true, ..Inputs::default() };
    (0..IDLE_BEFORE).for_each(|_| unit.tick(&idle));
    let report = run(unit, memory, &Traffic::smooth(Latency::Fixed(latency)), std::slice::from_ref(ray))?;
    (0..IDLE_AFTER).for_each(|_| unit.tick(&idle));
    Ok(report)
}

/// A unit whose every cycle goes into a waveform.
pub struct Waves {
    unit: TraversalUnit,
    writer: vcd::Writer<Vec<u8>>,
    clock: IdCode,
    /// Identifier and last value of each signal, in the order of the walk.
    signals: Vec<(IdCode, Shown)>,
    widths: BTreeMap<String, u32>,
    cycle: u64,
    error: Option<io::Error>,
}

impl Waves {
    /// Starts a waveform of `unit`.
    ///
    /// # Errors
    /// Only what the writer of waveforms says; memory takes everything.
    pub fn new(unit: TraversalUnit) -> io::Result<Self> {
        let mut writer = vcd::Writer::new(Vec::new());
        writer.version("lodray, cycle model of traversal_unit")?;
        writer.timescale(1, TimescaleUnit::NS)?;
        let mut declare =
            Declare { writer: &mut writer, signals: Vec::new(), path: Vec::new(), widths: BTreeMap::new(), clock: None, error: None };
        let inputs = Inputs::default();
        walk(&unit, &inputs, &unit.wires(&inputs), &mut declare);
        let Declare { signals, widths, clock, error, .. } = declare;
        let clock = match (clock, error) {
            (Some(clock), None) => clock,
            (_, error) => return Err(error.unwrap_or_else(|| io::Error::other("no clock"))),
        };
        writer.enddefinitions()?;
        Ok(Self { unit, writer, clock, signals, widths, cycle: 0, error: None })
    }

    /// Cycles so far.
    pub fn cycles(&self) -> u64 {
        self.cycle
    }

    /// Width of every signal by its path.
    pub fn widths(&self) -> &BTreeMap<String, u32> {
        &self.widths
    }

    /// Ends the waveform and gives the file's bytes.
    ///
    /// # Errors
    /// As [`Self::new`].
    pub fn finish(mut self) -> io::Result<Vec<u8>> {
        if let Some(error) = self.error {
            return Err(error);
        }
        self.writer.timestamp(PERIOD * self.cycle)?;
        Ok(std::mem::take(self.writer.writer()))
    }

    fn dump(&mut self, inputs: &Inputs) -> io::Result<()> {
        let mut now = Collect(Vec::with_capacity(self.signals.len()));
        walk(&self.unit, inputs, &self.unit.wires(inputs), &mut now);
        let writer = &mut self.writer;
        writer.timestamp(PERIOD * self.cycle)?;
        if self.cycle == 0 {
            writer.begin(SimulationCommand::Dumpvars)?;
        }
        writer.change_scalar(self.clock, Value::V1)?;
        for ((id, last), value) in self.signals.iter_mut().zip(now.0) {
            if self.cycle == 0 || *last != value {
                match &value {
                    Shown::Text(text) => writer.change_string(*id, text)?,
                    Shown::Bits(value) => match value.bits() {
                        [bit] => writer.change_scalar(*id, *bit)?,
                        bits => writer.change_vector(*id, bits.iter().copied())?,
                    },
                }
                *last = value;
            }
        }
        if self.cycle == 0 {
            writer.end()?;
        }
        writer.timestamp(PERIOD * self.cycle + PERIOD / 2)?;
        writer.change_scalar(self.clock, Value::V0)
    }
}

impl UnitPort for Waves {
    fn outputs(&mut self) -> Outputs {
        self.unit.outputs()
    }
    fn tick(&mut self, inputs: &Inputs) {
        if self.error.is_none() {
            self.error = self.dump(inputs).err();
        }
        self.unit.tick(inputs);
        self.cycle += 1;
    }
    fn describe(&mut self) -> String {
        self.unit.describe()
    }
}

/// Declares every signal.
struct Declare<'a> {
    writer: &'a mut vcd::Writer<Vec<u8>>,
    signals: Vec<(IdCode, Shown)>,
    path: Vec<String>,
    widths: BTreeMap<String, u32>,
    clock: Option<IdCode>,
    error: Option<io::Error>,
}

impl Declare<'_> {
    fn keep<T>(&mut self, result: io::Result<T>) -> Option<T> {
        result.map_err(|error| self.error = Some(error)).ok()
    }

    fn add(&mut self, kind: VarType, width: u32, name: &str, range: Option<ReferenceIndex>, value: Shown) {
        let id = self.writer.add_var(kind, width, name, range);
        self.widths.insert(format!("{}.{name}", self.path.join(".")), width);
        if let Some(id) = self.keep(id) {
            self.signals.push((id, value));
        }
    }
}

impl Visitor for Declare<'_> {
    fn enter(&mut self, scope: &str) {
        let done = self.writer.add_module(scope);
        self.keep(done);
        self.path.push(scope.to_owned());
        if self.clock.is_none() {
            let clock = self.writer.add_wire(1, "clk_i");
            self.clock = self.keep(clock);
        }
    }
    fn leave(&mut self) {
        let done = self.writer.upscope();
        self.keep(done);
        self.path.pop();
    }
    fn signal(&mut self, name: &str, value: Vector) {
        let width = value.bits().len();
        // Signals have a few thousand bits at most.
        let range = (width > 1).then_some(ReferenceIndex::Range(width as i32 - 1, 0));
        self.add(VarType::Wire, width as u32, name, range, Shown::Bits(value));
    }
    fn text(&mut self, name: &str, value: &'static str) {
        self.add(VarType::String, 1, name, None, Shown::Text(value));
    }
}

/// Collects every signal's value.
struct Collect(Vec<Shown>);

impl Visitor for Collect {
    fn enter(&mut self, _: &str) {}
    fn leave(&mut self) {}
    fn signal(&mut self, _: &str, value: Vector) {
        self.0.push(Shown::Bits(value));
    }
    fn text(&mut self, _: &str, value: &'static str) {
        self.0.push(Shown::Text(value));
    }
}
