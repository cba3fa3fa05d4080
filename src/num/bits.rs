//! Bits of a packed struct: bit 0 is the least significant bit of word 0.

/// A bit vector of stated width, least significant word first.
#[derive(Clone, PartialEq, Eq, Debug, Hash)]
pub struct BitVec {
    words: Vec<u64>,
    width: u32,
}

impl BitVec {
    /// `width` bits, all zero.
    pub fn zero(width: u32) -> Self {
        Self { words: vec![0; width.div_ceil(64) as usize], width }
    }

    /// Width in bits.
    pub fn width(&self) -> u32 {
        self.width
    }

    /// The words, least significant first; bits above the width are zero.
    pub fn words(&self) -> &[u64] {
        &self.words
    }

    /// The words, writable.
    pub fn words_mut(&mut self) -> &mut [u64] {
        &mut self.words
    }
}

/// Reads fields from the most significant end of a little-endian word array.
pub struct BitReader<'a> {
    words: &'a [u64],
    top: u32,
}

impl<'a> BitReader<'a> {
    /// A reader whose first field ends below bit `top` (the width of the whole struct).
    #[inline(always)]
    pub fn new(words: &'a [u64], top: u32) -> Self {
        Self { words, top }
    }

    /// The next `width` bits (1 to 64), zero-extended.
    #[inline(always)]
    pub fn take(&mut self, width: u32) -> u64 {
        self.top -= width;
        let (word, bit) = ((self.top / 64) as usize, self.top % 64);
        let mut v = self.words[word] >> bit;
        if bit + width > 64 {
            v |= self.words[word + 1] << (64 - bit);
        }
        if width == 64 { v } else { v & ((1 << width) - 1) }
    }

    /// The next `width` bits (1 to 64), sign-extended.
    #[inline(always)]
    pub fn take_signed(&mut self, width: u32) -> i64 {
        let v = self.take(width) << (64 - width);
        v.cast_signed() >> (64 - width)
    }
}

/// Writes fields from the most significant end of a little-endian word array that starts as zero.
pub struct BitWriter<'a> {
    words: &'a mut [u64],
    top: u32,
}

impl<'a> BitWriter<'a> {
    /// A writer whose first field ends below bit `top` (the width of the whole struct).
    #[inline(always)]
    pub fn new(words: &'a mut [u64], top: u32) -> Self {
        Self { words, top }
    }

    /// Writes the low `width` bits (1 to 64) of `v`.
    #[inline(always)]
    pub fn put(&mut self, v: u64, width: u32) {
        let v = if width == 64 { v } else { v & ((1 << width) - 1) };
        self.top -= width;
        let (word, bit) = ((self.top / 64) as usize, self.top % 64);
        self.words[word] |= v << bit;
        if bit + width > 64 {
            self.words[word + 1] |= v >> (64 - bit);
        }
    }
}
