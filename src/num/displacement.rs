//! Compact vertices: an inserted vertex as its displacement from the midpoint of its edge, in steps that follow from the edge's bound code.

use super::{BoundScale, SHORT_SHIFT};
use serde::{Deserialize, Serialize};

/// How a scene stores its inserted vertices. The default is what scenes are made with where nobody asks.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum VertexForm {
    /// Coordinates of 28 bits: a line for three.
    Exact,
    /// Displacements of 13 bits a coordinate: less than half a line for three.
    #[default]
    Compact,
    /// The same, but of [`SHORT_BITS`](super::SHORT_BITS) bits in last splits, of which four then share a line.
    Short,
}

impl VertexForm {
    /// All.
    pub const ALL: [Self; 3] = [Self::Exact, Self::Compact, Self::Short];

    /// Its name in options and files.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Exact => "exact",
            Self::Compact => "compact",
            Self::Short => "short",
        }
    }

    /// Lines of an L0 record.
    #[inline(always)]
    pub const fn record_lines(self) -> usize {
        match self {
            Self::Exact => 2,
            Self::Compact | Self::Short => 1,
        }
    }

    /// Lines of the inserted vertices of four siblings that are last splits, apart from what else they have.
    #[inline(always)]
    pub const fn sibling_lines(self) -> usize {
        match self {
            Self::Exact => 4,
            Self::Compact => 2,
            Self::Short => 1,
        }
    }

    /// Vertices are stored as displacements: [`VertexForm::Compact`] or [`VertexForm::Short`].
    #[inline(always)]
    pub const fn is_compact(self) -> bool {
        matches!(self, Self::Compact | Self::Short)
    }

    /// Zero bits at the bottom of a vertex of `level` (0: of the base mesh), in a model of so many `levels` of which every coordinate has `zeros`.
    pub fn zero_bits(self, levels: u32, level: u32, zeros: u32) -> u32 {
        let finer = levels - level;
        match self {
            Self::Exact => (finer + zeros).max(super::PADDING_BITS),
            // Midpoints of finer levels keep the padding.
            Self::Compact | Self::Short if level > 0 => finer + zeros.max(super::PADDING_BITS),
            Self::Compact | Self::Short => (finer + zeros.max(super::PADDING_BITS)).max(super::BASE_ZERO_BITS),
        }
    }
}

/// Units per step of the displacement of a vertex on an edge with bound code `code`, as a shift: its bound is below 4096 steps; at least `zero_bits`, those of
/// the vertex. At most [`MAX_DISPLACEMENT_SHIFT`](super::MAX_DISPLACEMENT_SHIFT).
#[inline(always)]
pub fn displacement_shift(scale: BoundScale, code: u8, zero_bits: u32) -> u32 {
    let octave = (u64::from(code) + scale.offset.get()) >> 4; // at most 527 / 16 = 32: the bound is below 2^(octave + 1)
    zero_bits.max((octave as u32).saturating_sub(11))
}

/// A component of a displacement (at most its edge's bound in magnitude) in steps of 2^shift units, rounded towards zero: 13 bits.
#[inline]
pub fn displacement_steps(units: i64, shift: u32) -> i32 {
    let steps = units.unsigned_abs() >> shift;
    (if units < 0 { -steps.cast_signed() } else { steps.cast_signed() }) as i32 // at most 4095 in magnitude
}

/// What is left of a displacement's steps where they have [`SHORT_BITS`](super::SHORT_BITS) bits: the leading ones, rounded towards zero.
#[inline]
pub fn short_steps(steps: i32) -> i32 {
    steps / (1 << SHORT_SHIFT) * (1 << SHORT_SHIFT)
}

/// A coordinate of the vertex that lies `steps` of 2^shift units from the midpoint of `a` and `b`, whose sum is even. What leads beyond 32 bits, in no scene
/// that was checked, ends at their limits.
#[inline(always)]
pub fn displaced(a: i32, b: i32, steps: i32, shift: u32) -> i32 {
    let q = ((i64::from(a) + i64::from(b)) >> 1) + (i64::from(steps) << shift);
    q.clamp(i64::from(i32::MIN), i64::from(i32::MAX)) as i32 // clamped
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::num::{LARGEST_BOUND, MAX_BOUND_OFFSET, MAX_DISPLACEMENT_SHIFT, U, bound_decode, bound_encode, bound_scale};
    use proptest::prelude::*;

    #[test]
    fn shifts_by_hand() {
        let scale = BoundScale { offset: U::new(0) };
        assert_eq!(displacement_shift(scale, 255, 4), 4); // 15 - 11
        assert_eq!(displacement_shift(scale, 255, 3), 4);
        assert_eq!(displacement_shift(scale, 0, 0), 0);
        let scale = BoundScale { offset: U::new(MAX_BOUND_OFFSET) };
        assert_eq!(displacement_shift(scale, 255, 4), MAX_DISPLACEMENT_SHIFT);
        assert_eq!(displacement_steps(-4095, 4), -255);
        assert_eq!(displacement_steps(4095, 4), 255);
        assert_eq!(displaced(-32, 64, -3, 4), 16 - 48);
        assert_eq!((short_steps(4095), short_steps(63), short_steps(-63), short_steps(-65)), (4032, 0, 0, -64));
    }

    proptest! {
        #[test]
        fn a_displacement_within_its_bound_has_thirteen_bits_and_never_gets_longer(
            largest in 1..=LARGEST_BOUND, part in 0.0f64..=1.0, along in -1.0f64..=1.0, zero in 4u32..14
        ) {
            let scale = bound_scale(largest);
            let bound = ((largest as f64 * part) as u64).min(largest);
            let code = bound_encode(scale, bound);
            let shift = displacement_shift(scale, code, zero);
            let units = (bound as f64 * along) as i64;
            let steps = displacement_steps(units, shift);
            prop_assert!((-4096..4096).contains(&steps));
            let back = i64::from(steps) << shift;
            prop_assert!(back.abs() <= units.abs() && (units - back).abs() < 1 << shift);
            // A step is at most 1/2048 of its bound, unless its grid is coarser.
            prop_assert!(shift == zero || bound_decode(scale, code) >= 1 << (shift + 11));
        }
    }
}
