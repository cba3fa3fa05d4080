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

    /// Registers of the odd ones beside each other: each as wide as the largest.
    pub const fn registers(self) -> Registers {
        // Above, the divisor and three times it are narrower. Below, three times it has its lowest bit, five times two of its, and seven times its lowest and
        // the second of three times it.
        let without = [1, 2 + 1, 3 + 1 + 5];
        Registers::bits(self.odd() * (self.width + self.bits)).without(self.of(without))
    }

    /// Registers of those besides the divisor, where it is kept elsewhere.
    pub const fn registers_besides(self) -> Registers {
        // Three times the divisor is narrower than the others, which have their lowest bits from it: five times one, seven times two.
        let without = [0, 0, 1 + 3];
        Registers::bits((self.odd() - 1) * (self.width + self.bits)).without(self.of(without))
    }

    /// That of so many bits of a step.
    const fn of(self, by_bits: [u32; 3]) -> u32 {
        let [one, two, three] = by_bits;
        match self.bits {
            1 => one,
            2 => two,
            _ => three,
        }
    }
}
