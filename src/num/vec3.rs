//! Exact integer vectors.

use super::{BitReader, BitWriter, Field, Layout, S, Wire};

/// Three signed components of `W` bits.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default, Hash)]
pub struct Vec3<const W: u32> {
    /// First component.
    pub x: S<W>,
    /// Second component.
    pub y: S<W>,
    /// Third component.
    pub z: S<W>,
}

impl<const W: u32> Vec3<W> {
    /// The vector (x, y, z); each must fit `W` bits.
    #[inline(always)]
    pub const fn new(x: i64, y: i64, z: i64) -> Self {
        Self { x: S::new(x), y: S::new(y), z: S::new(z) }
    }

    const fn component(name: &'static str) -> Field {
        Field { name, width: W, layout: Layout::Signed, kind: "S<W>", doc: &[] }
    }

    /// The components as plain integers, x first.
    #[inline(always)]
    pub const fn get(self) -> [i64; 3] {
        [self.x.get(), self.y.get(), self.z.get()]
    }
}

impl Vec3<32> {
    /// From 32-bit components; always fits.
    #[inline(always)]
    pub fn from_i32([x, y, z]: [i32; 3]) -> Self {
        Self::new(i64::from(x), i64::from(y), i64::from(z))
    }
}

impl<const W: u32> Wire for Vec3<W> {
    const WIDTH: u32 = 3 * W;
    const FIELDS: &'static [Field] = &[Self::component("x"), Self::component("y"), Self::component("z")];
    #[inline(always)]
    fn put(&self, w: &mut BitWriter<'_>) {
        self.x.put(w);
        self.y.put(w);
        self.z.put(w);
    }
    #[inline(always)]
    fn take(r: &mut BitReader<'_>) -> Self {
        let x = S::take(r);
        let y = S::take(r);
        let z = S::take(r);
        Self { x, y, z }
    }
}
