//! Integers whose width is part of the type.
//!
//! `S<W>` / `U<W>`: signed / unsigned, up to 64 bits, held in an `i64` / `u64`. `WS<W>` / `WU<W>`: the same up to 127 bits, held
//! in an `i128` / `u128`. Constructing a value outside the width panics in builds with debug assertions (all tests); block code
//! proves beside each construction that it cannot happen.

use std::fmt;

macro_rules! fixed_int {
    ($(#[$doc:meta])* $name:ident, $repr:ty, $min:expr, $max:expr) => {
        $(#[$doc])*
        #[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Default)]
        #[repr(transparent)]
        pub struct $name<const W: u32>($repr);

        impl<const W: u32> $name<W> {
            /// Smallest value of this width.
            pub const MIN: Self = Self($min(W));
            /// Largest value of this width.
            pub const MAX: Self = Self($max(W));
            /// Zero.
            pub const ZERO: Self = Self(0);

            /// The value `v`; it must lie in `MIN..=MAX` (checked where debug assertions are on).
            #[inline(always)]
            pub const fn new(v: $repr) -> Self {
                debug_assert!(v >= $min(W) && v <= $max(W), "value does not fit its stated width");
                Self(v)
            }

            /// The value `v`, or `None` outside `MIN..=MAX`.
            #[inline]
            pub const fn checked(v: $repr) -> Option<Self> {
                if v >= $min(W) && v <= $max(W) { Some(Self(v)) } else { None }
            }

            /// The nearest value to `v` in `MIN..=MAX`.
            #[inline]
            pub const fn saturating(v: $repr) -> Self {
                if v < $min(W) {
                    Self::MIN
                } else if v > $max(W) {
                    Self::MAX
                } else {
                    Self(v)
                }
            }

            /// The plain integer.
            #[inline(always)]
            pub const fn get(self) -> $repr {
                self.0
            }
        }

        impl<const W: u32> fmt::Debug for $name<W> {
            fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                fmt::Display::fmt(&self.0, f)
            }
        }

        impl<const W: u32> fmt::Display for $name<W> {
            fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                fmt::Display::fmt(&self.0, f)
            }
        }
    };
}

const fn s_min(w: u32) -> i64 {
    assert!(w >= 1 && w <= 64);
    if w == 64 { i64::MIN } else { -(1 << (w - 1)) }
}
const fn s_max(w: u32) -> i64 {
    assert!(w >= 1 && w <= 64);
    if w == 64 { i64::MAX } else { (1 << (w - 1)) - 1 }
}
const fn u_min(_: u32) -> u64 {
    0
}
const fn u_max(w: u32) -> u64 {
    assert!(w >= 1 && w <= 64);
    if w == 64 { u64::MAX } else { (1 << w) - 1 }
}
const fn ws_min(w: u32) -> i128 {
    assert!(w >= 1 && w <= 127);
    -(1 << (w - 1))
}
const fn ws_max(w: u32) -> i128 {
    assert!(w >= 1 && w <= 127);
    (1 << (w - 1)) - 1
}
const fn wu_min(_: u32) -> u128 {
    0
}
const fn wu_max(w: u32) -> u128 {
    assert!(w >= 1 && w <= 127);
    (1 << w) - 1
}

fixed_int!(
    /// Signed, `W` bits (1 to 64).
    S, i64, s_min, s_max
);
fixed_int!(
    /// Unsigned, `W` bits (1 to 64).
    U, u64, u_min, u_max
);
fixed_int!(
    /// Wide signed, `W` bits (1 to 127).
    WS, i128, ws_min, ws_max
);
fixed_int!(
    /// Wide unsigned, `W` bits (1 to 127).
    WU, u128, wu_min, wu_max
);

impl<const W: u32> S<W> {
    /// The low `W` bits of `v`, as hardware keeps them.
    #[inline(always)]
    pub const fn wrapping(v: i64) -> Self {
        Self(v << (64 - W) >> (64 - W))
    }

    /// The value as a 32-bit integer; only widths up to 32 compile. It tells the compiler that a 32 x 32 -> 64-bit multiplier will do.
    #[inline(always)]
    pub const fn narrow(self) -> i32 {
        const { assert!(W <= 32) };
        self.0 as i32 // at most 32 bits by its width
    }
}

impl<const W: u32> U<W> {
    /// The low `W` bits of `v`, as hardware keeps them.
    #[inline(always)]
    pub const fn wrapping(v: u64) -> Self {
        Self(v & Self::MAX.0)
    }

    /// The value as a 32-bit signed integer; only widths up to 31 compile.
    #[inline(always)]
    pub const fn narrow(self) -> i32 {
        const { assert!(W <= 31) };
        self.0 as i32 // at most 31 bits by its width
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn limits_follow_the_width() {
        assert_eq!((S::<33>::MIN.get(), S::<33>::MAX.get()), (-(1 << 32), (1 << 32) - 1));
        assert_eq!(S::<64>::MIN.get(), i64::MIN);
        assert_eq!(U::<10>::MAX.get(), 1023);
        assert_eq!(U::<64>::MAX.get(), u64::MAX);
        assert_eq!(WU::<99>::MAX.get(), (1 << 99) - 1);
        assert_eq!(WS::<67>::MIN.get(), -(1 << 66));
    }

    #[test]
    fn checked_and_saturating_agree_with_the_limits() {
        assert_eq!(U::<9>::checked(511).map(U::get), Some(511));
        assert_eq!(U::<9>::checked(512), None);
        assert_eq!(S::<16>::saturating(40_000).get(), 32_767);
        assert_eq!(S::<16>::saturating(-40_000).get(), -32_768);
    }

    #[test]
    fn wrapping_keeps_the_low_bits() {
        assert_eq!([S::<16>::wrapping(40_000), S::<16>::wrapping(-40_000), S::<16>::wrapping(7)].map(S::get), [-25_536, 25_536, 7]);
        assert_eq!([U::<9>::wrapping(513), U::<9>::wrapping(511)].map(U::get), [1, 511]);
        assert_eq!((S::<64>::wrapping(i64::MIN).get(), U::<64>::wrapping(u64::MAX).get()), (i64::MIN, u64::MAX));
    }

    #[test]
    #[cfg(debug_assertions)]
    #[should_panic(expected = "does not fit")]
    fn construction_out_of_range_panics() {
        let _ = U::<9>::new(512);
    }
}
