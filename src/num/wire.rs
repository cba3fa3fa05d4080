//! [`Wire`]: a struct as bits, laid out as a SystemVerilog packed struct.

use super::{BitReader, BitVec, BitWriter, S, U, WS, WU};

/// One field of a [`Wire`] struct, in declaration order.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Field {
    /// The name, the same as in the SystemVerilog packed struct.
    pub name: &'static str,
    /// Its width in bits.
    pub width: u32,
    /// What its bits are.
    pub layout: Layout,
    /// Its type as the source has it: a struct, a named format, or a plain number of bits.
    pub kind: &'static str,
    /// Its description, one text a line.
    pub doc: &'static [&'static str],
}

/// What the bits of a [`Wire`] value are.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Layout {
    /// An unsigned number or a flag.
    Unsigned,
    /// A signed number.
    Signed,
    /// That many elements of equal width.
    Array(u32),
    /// A struct of these fields.
    Struct(&'static [Field]),
}

/// A value with a fixed number of bits. Of a struct the first field is the most significant; of an array `[T; N]`, as of `logic [N-1:0]`,
/// element 0 is the least significant.
pub trait Wire: Sized {
    /// Width in bits.
    const WIDTH: u32;
    /// The fields of a struct, most significant first; empty for plain integers and arrays.
    const FIELDS: &'static [Field] = &[];
    /// The description of a struct, one text a line.
    const DOC: &'static [&'static str] = &[];
    /// What the bits are.
    const LAYOUT: Layout = Layout::Struct(Self::FIELDS);

    /// Appends the bits, most significant first.
    fn put(&self, w: &mut BitWriter<'_>);
    /// Reads what [`Wire::put`] wrote.
    fn take(r: &mut BitReader<'_>) -> Self;

    /// The bits as a vector of `WIDTH` bits.
    fn to_bits(&self) -> BitVec {
        let mut bits = BitVec::zero(Self::WIDTH);
        self.put(&mut BitWriter::new(bits.words_mut(), Self::WIDTH));
        bits
    }

    /// The value whose bits these are; `words` holds at least `WIDTH` bits, least significant word first.
    #[inline(always)]
    fn from_words(words: &[u64]) -> Self {
        Self::take(&mut BitReader::new(words, Self::WIDTH))
    }

    /// Writes the bits into `words`, which hold at least `WIDTH` bits and are overwritten.
    #[inline(always)]
    fn to_words(&self, words: &mut [u64]) {
        words.fill(0);
        self.put(&mut BitWriter::new(words, Self::WIDTH));
    }
}

impl<const W: u32> Wire for U<W> {
    const WIDTH: u32 = W;
    const LAYOUT: Layout = Layout::Unsigned;
    #[inline(always)]
    fn put(&self, w: &mut BitWriter<'_>) {
        w.put(self.get(), W);
    }
    #[inline(always)]
    fn take(r: &mut BitReader<'_>) -> Self {
        Self::new(r.take(W))
    }
}

impl<const W: u32> Wire for S<W> {
    const WIDTH: u32 = W;
    const LAYOUT: Layout = Layout::Signed;
    #[inline(always)]
    fn put(&self, w: &mut BitWriter<'_>) {
        w.put(self.get().cast_unsigned(), W);
    }
    #[inline(always)]
    fn take(r: &mut BitReader<'_>) -> Self {
        Self::new(r.take_signed(W))
    }
}

#[inline]
fn put_wide(v: u128, width: u32, w: &mut BitWriter<'_>) {
    let [low, high] = [v as u64, (v >> 64) as u64]; // the two halves of a u128
    if width > 64 {
        w.put(high, width - 64);
    }
    w.put(low, width.min(64));
}

#[inline]
fn take_wide(width: u32, r: &mut BitReader<'_>) -> u128 {
    let high = if width > 64 { u128::from(r.take(width - 64)) << 64 } else { 0 };
    high | u128::from(r.take(width.min(64)))
}

impl<const W: u32> Wire for WU<W> {
    const WIDTH: u32 = W;
    const LAYOUT: Layout = Layout::Unsigned;
    fn put(&self, w: &mut BitWriter<'_>) {
        put_wide(self.get(), W, w);
    }
    fn take(r: &mut BitReader<'_>) -> Self {
        Self::new(take_wide(W, r))
    }
}

impl<const W: u32> Wire for WS<W> {
    const WIDTH: u32 = W;
    const LAYOUT: Layout = Layout::Signed;
    fn put(&self, w: &mut BitWriter<'_>) {
        put_wide(self.get().cast_unsigned(), W, w);
    }
    fn take(r: &mut BitReader<'_>) -> Self {
        let v = take_wide(W, r) << (128 - W);
        Self::new(v.cast_signed() >> (128 - W))
    }
}

impl Wire for bool {
    const WIDTH: u32 = 1;
    const LAYOUT: Layout = Layout::Unsigned;
    #[inline(always)]
    fn put(&self, w: &mut BitWriter<'_>) {
        w.put(u64::from(*self), 1);
    }
    #[inline(always)]
    fn take(r: &mut BitReader<'_>) -> Self {
        r.take(1) == 1
    }
}

impl<T: Wire + Copy + Default, const N: usize> Wire for [T; N] {
    const WIDTH: u32 = T::WIDTH * N as u32; // N is a small array length
    const LAYOUT: Layout = Layout::Array(N as u32);
    #[inline(always)]
    fn put(&self, w: &mut BitWriter<'_>) {
        for v in self.iter().rev() {
            v.put(w);
        }
    }
    #[inline(always)]
    fn take(r: &mut BitReader<'_>) -> Self {
        let mut out = [T::default(); N];
        for v in out.iter_mut().rev() {
            *v = T::take(r);
        }
        out
    }
}

/// Declares a struct and its [`Wire`] layout, most significant field first.
macro_rules! wire_struct {
    ($(#[doc = $doc:literal])* $vis:vis struct $name:ident { $($(#[doc = $fdoc:literal])* $field:ident : $ty:ty),+ $(,)? }) => {
        $(#[doc = $doc])*
        #[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
        $vis struct $name { $($(#[doc = $fdoc])* pub $field: $ty),+ }

        impl $crate::num::Wire for $name {
            const WIDTH: u32 = 0 $(+ <$ty as $crate::num::Wire>::WIDTH)+;
            const DOC: &'static [&'static str] = &[$($doc),*];
            const FIELDS: &'static [$crate::num::Field] = &[
                $($crate::num::Field {
                    name: stringify!($field),
                    width: <$ty as $crate::num::Wire>::WIDTH,
                    layout: <$ty as $crate::num::Wire>::LAYOUT,
                    kind: stringify!($ty),
                    doc: &[$($fdoc),*],
                }),+
            ];
            #[inline(always)]
            fn put(&self, w: &mut $crate::num::BitWriter<'_>) {
                $($crate::num::Wire::put(&self.$field, w);)+
            }
            #[inline(always)]
            fn take(r: &mut $crate::num::BitReader<'_>) -> Self {
                $(let $field = <$ty as $crate::num::Wire>::take(r);)+
                Self { $($field),+ }
            }
        }
    };
}
pub(crate) use wire_struct;

#[cfg(test)]
mod tests {
    use super::*;
    use crate::num::Vec3;
    use proptest::prelude::*;

    wire_struct! {
        struct Probe { a: U<3>, v: Vec3<28>, w: WU<99>, n: WS<67>, l: [U<9>; 3], f: bool }
    }

    #[test]
    fn the_first_field_is_the_most_significant_and_element_0_the_least() {
        wire_struct! { struct Small { a: U<4>, b: S<4>, l: [U<4>; 2] } }
        let v = Small { a: U::new(0xa), b: S::new(-1), l: [U::new(1), U::new(2)] };
        assert_eq!(v.to_bits().words(), &[0xaf21]);
        assert_eq!(Small::WIDTH, 16);
        assert_eq!(Small::FIELDS[2], Field { name: "l", width: 8, layout: Layout::Array(2), kind: "[U<4>; 2]", doc: &[] });
    }

    proptest! {
        #[test]
        fn bits_give_the_struct_back(a in 0u64..8, x in -(1i64 << 27)..1 << 27, w in 0u128..1 << 99,
                                     n in -(1i128 << 66)..1 << 66, l in prop::array::uniform3(0u64..512), f: bool) {
            let v = Probe { a: U::new(a), v: Vec3::new(x, -x.max(1 - (1 << 27)), 5), w: WU::new(w), n: WS::new(n), l: l.map(U::new), f };
            let bits = v.to_bits();
            prop_assert_eq!(bits.width(), 3 + 84 + 99 + 67 + 27 + 1);
            prop_assert_eq!(Probe::from_words(bits.words()), v);
        }
    }
}
