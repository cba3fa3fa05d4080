//! Planes of boxes in few bits: whole steps along an axis.

/// Steps along an axis of a group of boxes: (2 + half) 2^exponent / 2 codes of 2^16 units each.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct BoxStep {
    /// Half as long again.
    pub half: bool,
    /// Power of two, 0 to 15.
    pub exponent: u32,
}

/// Codes of 2^16 units in `steps` (up to 8 bits) steps: floor((2 + half) steps 2^exponent / 2), below 2^24.
#[inline(always)]
pub const fn box_steps(half: bool, exponent: u32, steps: u32) -> u32 {
    // 8 bits times 2 or 3: 10 bits, and 15 more; halved.
    ((2 * steps + (steps & (half as u32).wrapping_neg())) << exponent) >> 1
}

impl BoxStep {
    /// The shortest step of which `most` reach `extent` codes.
    pub fn reaching(extent: u32, most: u32) -> Self {
        let all = (0..16).flat_map(|exponent| [false, true].map(|half| Self { half, exponent }));
        all.into_iter().find(|step| step.codes(most) >= extent).unwrap_or(Self { half: true, exponent: 15 })
    }

    /// Codes in so many steps.
    #[inline(always)]
    pub const fn codes(self, steps: u32) -> u32 {
        box_steps(self.half, self.exponent, steps)
    }

    /// The most steps that do not pass `codes`.
    pub fn below(self, codes: u32) -> u32 {
        let guess = (u64::from(codes) * 2 + 2) >> self.exponent;
        let mut steps = (if self.half { guess / 3 } else { guess / 2 }) as u32; // not more than codes + 1
        while self.codes(steps) > codes {
            steps -= 1;
        }
        steps
    }

    /// The fewest steps that reach `codes`.
    pub fn above(self, codes: u32) -> u32 {
        let steps = self.below(codes);
        if self.codes(steps) < codes { steps + 1 } else { steps }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn steps_by_hand() {
        assert_eq!([0, 1, 2, 127].map(|v| box_steps(false, 0, v)), [0, 1, 2, 127]);
        assert_eq!([0, 1, 2, 3].map(|v| box_steps(true, 0, v)), [0, 1, 3, 4]);
        assert_eq!([1, 3].map(|v| box_steps(true, 4, v)), [24, 72]);
        assert_eq!(box_steps(true, 15, 127), 381 << 14);
        assert_eq!(box_steps(true, 15, 255), 765 << 14);
        assert_eq!(BoxStep::reaching(0, 31), BoxStep::default());
        assert_eq!(BoxStep::reaching(47, 31), BoxStep { half: false, exponent: 1 });
        assert_eq!(BoxStep::reaching(46, 31), BoxStep { half: true, exponent: 0 });
    }

    proptest! {
        #[test]
        fn the_shortest_step_reaches_and_rounding_is_by_less_than_one(extent in 0u32..=65_534, codes in 0u32..=65_534, most in prop::sample::select(vec![31u32, 127, 255])) {
            let (step, codes) = (BoxStep::reaching(extent, most), codes.min(extent));
            prop_assert!(step.codes(most) >= extent);
            let (below, above) = (step.below(codes), step.above(codes));
            prop_assert!(step.codes(below) <= codes && step.codes(below + 1) > codes);
            prop_assert!(step.codes(above) >= codes && (above == 0 || step.codes(above - 1) < codes));
            prop_assert!(above <= most);
        }
    }
}
