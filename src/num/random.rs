//! Numbers that look random and are the same everywhere: SplitMix64 (Steele, Lea, Flood 2014).

/// What the generator adds to its state for each number: 2^64 over the golden ratio.
pub const STEP: u64 = 0x9E37_79B9_7F4A_7C15;

/// SplitMix64's mixer: another 64 bits for each 64 bits.
#[inline]
pub const fn mix(v: u64) -> u64 {
    let v = (v ^ (v >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
    let v = (v ^ (v >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
    v ^ (v >> 31)
}

/// A hash of two numbers.
#[inline]
pub const fn mix_two(seed: u64, index: u64) -> u64 {
    mix(seed.wrapping_mul(STEP) ^ index.wrapping_add(1).wrapping_mul(0xD1B5_4A32_D192_ED03))
}

/// A small generator.
#[derive(Clone, Debug)]
pub struct Random(u64);

impl Random {
    /// The generator of `seed`.
    pub const fn new(seed: u64) -> Self {
        Self(seed)
    }

    /// The generator of the `number`-th item of `seed`: the same whatever thread makes it.
    pub const fn of(seed: u64, number: u64) -> Self {
        Self(seed ^ number.wrapping_mul(0xD6E8_FEB8_6659_FD93))
    }

    /// The next 64 bits.
    pub const fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(STEP);
        mix(self.0)
    }

    /// Below `n`.
    pub fn below(&mut self, n: u64) -> u64 {
        ((u128::from(self.next()) * u128::from(n)) >> 64) as u64 // the high half is below n
    }

    /// From -1 to 1.
    pub fn signed(&mut self) -> f64 {
        (self.next() >> 11) as f64 / f64::from(1u32 << 31) / f64::from(1u32 << 21) - 1.0
    }

    /// From `-n` to `n`.
    pub fn within(&mut self, n: u64) -> i64 {
        self.below(2 * n + 1).cast_signed() - n.cast_signed()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_numbers_are_those_of_splitmix64() {
        // Of the authors' own program, seed 1234567.
        let mut random = Random::new(1_234_567);
        let wanted = [6_457_827_717_110_365_317, 3_203_168_211_198_807_973, 9_817_491_932_198_370_423, 4_593_380_528_125_082_431];
        assert_eq!([(); 4].map(|()| random.next()), wanted);
    }

    #[test]
    fn draws_keep_to_their_ranges_and_reach_the_ends() {
        let mut random = Random::of(1, 2);
        let drawn: Vec<i64> = (0..1000).map(|_| random.within(2)).collect();
        assert!((-2..=2).all(|v| drawn.contains(&v)) && drawn.iter().all(|v| (-2..=2).contains(v)));
        assert!((0..1000).all(|_| random.below(7) < 7));
        let signed: Vec<f64> = (0..1000).map(|_| random.signed()).collect();
        assert!(signed.iter().all(|v| (-1.0..1.0).contains(v)) && signed.iter().any(|&v| v < -0.9) && signed.iter().any(|&v| v > 0.9));
    }
}
