//! [`Failure`]: where the RTL and the Rust block part, with all that is needed to see it again.

use crate::Mode;
use lodray::num::{BitReader, Wire};
use std::fmt;
use std::path::PathBuf;

/// The first difference of a check.
#[derive(Clone, Debug)]
pub struct Failure {
    /// The top.
    pub top: String,
    /// How it was driven.
    pub mode: Mode,
    /// The seed that shows it again.
    pub seed: u64,
    /// Number of the transaction, from 0.
    pub index: u64,
    /// Cycle in its batch.
    pub cycle: u64,
    /// Its input, or the one that was due when a rule was broken.
    pub input: String,
    /// What differs.
    pub fault: Fault,
    /// The waveform, if `LODRAY_WAVES` asked for one.
    pub waves: Option<PathBuf>,
}

/// What differs.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Fault {
    /// The output: a line for each field that differs, then both outputs.
    Output(String),
    /// The tag.
    Tag {
        /// Sent with the input.
        expected: u64,
        /// Come with the output.
        got: u64,
    },
    /// Cycles from input to output.
    Latency {
        /// Stated (when stalled: the least possible).
        expected: u32,
        /// Measured.
        got: u64,
    },
    /// Cycles from the input before to this one.
    Interval {
        /// Stated.
        expected: u32,
        /// Measured.
        got: u64,
    },
    /// Cycle in which an output was first offered, when stalled: it had its latency behind it, and the interval from the output before.
    Late {
        /// The first in which it could have been.
        least: u64,
        /// Measured.
        got: u64,
    },
    /// An input was refused, when stalled, though the interval from the input before was over and the block had room.
    Refused {
        /// Items in it.
        inside: u64,
        /// The fewest that fill it: latency over interval.
        least: u64,
    },
    /// A rule of the handshake.
    Rule(&'static str),
}

impl fmt::Display for Fault {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Output(text) => write!(f, "another output\n{text}"),
            Self::Tag { expected, got } => write!(f, "tag {got:#x} instead of {expected:#x}"),
            Self::Latency { expected, got } => write!(f, "latency {got} instead of {expected}"),
            Self::Interval { expected, got } => write!(f, "interval {got} instead of {expected}"),
            Self::Late { least, got } => write!(f, "offered in cycle {got} instead of {least}"),
            Self::Refused { inside, least } => {
                write!(f, "the input was refused with {inside} items inside, of {least} or more that it holds")
            }
            Self::Rule(text) => f.write_str(text),
        }
    }
}

impl fmt::Display for Failure {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { top, mode, seed, index, cycle, input, fault, waves } = self;
        writeln!(f, "{top}, {mode:?}, transaction {index}, cycle {cycle} of its batch: {fault}")?;
        writeln!(f, "  input: {input}")?;
        match waves {
            Some(path) => write!(f, "  waveform: {}", path.display())?,
            None => write!(f, "  for a waveform set LODRAY_WAVES to a folder")?,
        }
        write!(f, "\n  replay: LODRAY_SEED={seed}")
    }
}

impl std::error::Error for Failure {}

/// The fields in which two outputs differ, and both outputs.
pub(crate) fn difference<T: Wire + fmt::Debug>(expected: &[u64], got: &[u64]) -> String {
    let mut text = String::new();
    let (mut a, mut b) = (BitReader::new(expected, T::WIDTH), BitReader::new(got, T::WIDTH));
    for field in T::FIELDS {
        let (a, b) = (hex(&mut a, field.width), hex(&mut b, field.width));
        if a != b {
            text += &format!("  {}: expected 0x{a}, got 0x{b}\n", field.name);
        }
    }
    text + &format!("  expected: {:?}\n  got:      {:?}", T::from_words(expected), T::from_words(got))
}

/// The next `width` bits as hexadecimal digits.
fn hex(bits: &mut BitReader<'_>, width: u32) -> String {
    let mut text = String::new();
    let mut left = width;
    while left > 0 {
        let part = if left.is_multiple_of(64) { 64 } else { left % 64 };
        let digits = part.div_ceil(4) as usize; // at most 16
        text += &format!("{:0digits$x}", bits.take(part));
        left -= part;
    }
    text
}
