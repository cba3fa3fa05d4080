//! What a step of a division takes.

use super::Registers;

/// The multiples of a divisor that a step of so many bits compares with (`divide_multiples`, `divide_step`).
#[derive(Clone, Copy)]
pub struct DivisorMultiples {
    /// Bits of the divisor.
    pub width: u32,
    /// Bits of the quotient in a step.
    pub bits: u32,
}

impl DivisorMultiples {
    /// All of them: comparisons of a step, and choices.
    pub const fn compared(self) -> u32 {
        (1 << self.bits) - 1
    }

    /// The odd ones: the others are these, shifted.
    const fn odd(self) -> u32 {
        1 << (self.bits - 1)
    }

    /// Bits added to make the odd ones.
    pub const fn add_bits(self) -> u32 {
        (self.odd() - 1) * (self.width + self.bits)
    }

    /// Registers of the odd ones: each as wide as the largest.
    pub const fn registers(self) -> Registers {
        // The divisor itself has no bits above its own.
        Registers::bits(self.odd() * (self.width + self.bits)).without(self.bits + self.unused())
    }

    /// Registers of those besides the divisor.
    pub const fn registers_besides(self) -> Registers {
        Registers::bits((self.odd() - 1) * (self.width + self.bits)).without(self.unused())
    }

    /// Three times the divisor has a bit less than five and seven times.
    const fn unused(self) -> u32 {
        if self.bits > 2 { 1 } else { 0 }
    }
}
