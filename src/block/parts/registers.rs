//! Registers by what holds them.

use std::iter::Sum;
use std::ops::{Add, Mul};

/// Bits of registers: those that the RTL declares, and of them those that synthesis keeps. It drops bits that nothing reads, that never
/// change, and that repeat a sign.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Registers {
    /// As the RTL declares them.
    pub declared: u32,
    /// As they are built.
    pub kept: u32,
    /// Of these, those that an operation writes, each as often as it does.
    pub written: u32,
}

impl Registers {
    /// So many bits, all of use.
    pub const fn bits(bits: u32) -> Self {
        Self::of_use(bits, bits)
    }

    /// So many bits, of which so many are of use.
    pub const fn of_use(declared: u32, kept: u32) -> Self {
        Self { declared, kept, written: kept }
    }

    /// `stages` elastic registers in a row (`pipe_stage`, `pipe_delay`), of which `skids` are a `pipe_skid`: each has a valid bit, and a `pipe_skid` has
    /// everything twice.
    pub const fn line(width: u32, stages: u32, skids: u32) -> Self {
        Self::bits((width + 1) * (stages + skids))
    }

    /// An elastic register.
    pub const fn stage(width: u32) -> Self {
        Self::line(width, 1, 0)
    }

    /// An elastic register that cuts the chain of readies.
    pub const fn skid(width: u32) -> Self {
        Self::line(width, 1, 1)
    }

    /// Of these, `bits` are of no use.
    pub const fn without(self, bits: u32) -> Self {
        Self { kept: self.kept - bits, written: self.written - bits, ..self }
    }

    /// An operation passes through them in so many turns.
    pub const fn in_turns(self, turns: u32) -> Self {
        Self { written: turns * self.written, ..self }
    }
}

impl Add for Registers {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        Self { declared: self.declared + other.declared, kept: self.kept + other.kept, written: self.written + other.written }
    }
}

impl Mul<Registers> for u32 {
    type Output = Registers;
    fn mul(self, one: Registers) -> Registers {
        Registers { declared: self * one.declared, kept: self * one.kept, written: self * one.written }
    }
}

impl Sum for Registers {
    fn sum<I: Iterator<Item = Self>>(all: I) -> Self {
        all.fold(Self::default(), Add::add)
    }
}
