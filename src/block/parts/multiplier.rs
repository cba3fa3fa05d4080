//! `rtl/multiplier.sv`, and the products of vectors made of it.

use super::Registers;

/// A factor is cut into limbs of so many bits, the highest signed with up to one more.
pub const LIMB: u32 = 17;

/// Registers of the products of an edge function, where nothing beside them takes longer.
pub const EDGE_PRODUCT_STAGES: u32 = 2;

/// Limbs of a signed factor of `width` bits.
pub(super) const fn limbs(width: u32) -> u32 {
    if width <= LIMB + 1 { 1 } else { (width - 1).div_ceil(LIMB) }
}

/// Levels of a tree over `n` numbers.
const fn levels(n: u32) -> u32 {
    n.next_power_of_two().ilog2()
}

/// Cycles of a multiplier of signed factors: the limb products, then one tree level each.
pub const fn multiplier_latency(a: u32, b: u32) -> u32 {
    1 + levels(limbs(a)) + levels(limbs(b))
}

/// Cycles of `dot_product`: factors, products, two sums.
pub const fn dot_product_latency(a: u32, b: u32) -> u32 {
    1 + multiplier_latency(a, b) + 2
}

/// Cycles of `cross_product`: factors, products in [`EDGE_PRODUCT_STAGES`], differences.
pub const fn cross_product_latency(width: u32) -> u32 {
    1 + EDGE_PRODUCT_STAGES - 1 + multiplier_latency(width, width) + 1
}

/// A `multiplier`: signed factors of `a` and `b` bits, with registers beside them, and what is read of the product.
#[derive(Clone, Copy, Debug)]
pub(in crate::block) struct Multiplier {
    pub a: u32,
    pub b: u32,
    /// Factors that are unsigned numbers: their top bit is always 0.
    pub unsigned: u32,
    pub factor_stages: u32,
    pub product_stages: u32,
    /// The last register is a `pipe_skid`.
    pub last_is_skid: bool,
    /// Bits of the product from `low` (up to 17, which no sum touches) to below `high` are read.
    pub low: u32,
    pub high: u32,
}

impl Multiplier {
    /// Signed factors, nothing beside them, all of the product read.
    pub const fn new(a: u32, b: u32) -> Self {
        Self { a, b, unsigned: 0, factor_stages: 0, product_stages: 1, last_is_skid: false, low: 0, high: a + b }
    }

    /// A register of its own beside each factor.
    pub const fn near(self) -> Self {
        Self { factor_stages: 1, ..self }
    }

    /// Its registers, from the factors to the product.
    pub fn registers(self) -> Registers {
        let (la, lb) = (limbs(self.a), limbs(self.b));
        let factors = self.factor_stages * Registers::stage(self.a + self.b).without(self.unsigned);
        // Every pair of limbs, with room for signs; a product has as many bits as its factors together.
        let pairs = (0..lb).flat_map(|j| (0..la).map(move |i| (i, j)));
        let kept = pairs.map(|(i, j)| self.kept(run(self.a, i, 1) + run(self.b, j, 1), i + j)).sum::<u32>();
        let copies = self.product_stages + u32::from(self.last_is_skid && la * lb == 1);
        let products = copies * Registers::of_use(la * lb * 2 * (LIMB + 1) + 1, kept + 1);
        let row = |j| {
            self.tree(la, 2 * (LIMB + 1), self.last_is_skid && lb == 1, |from, many| {
                self.kept(run(self.a, from, many) + run(self.b, j, 1), from + j)
            })
        };
        let rows: Registers = (0..lb).map(row).sum();
        let sum =
            self.tree(lb, LIMB * la + 1 + LIMB + 1, self.last_is_skid, |from, many| self.kept(self.a + run(self.b, from, many), from));
        factors + products + rows + sum
    }

    /// `limb_sum`: the registers of a tree over `n` numbers of `width` bits, a limb apart. `kept` tells the bits of use of the sum of `many` of them from the
    /// number `from` on.
    fn tree(&self, n: u32, width: u32, last_is_skid: bool, kept: impl Fn(u32, u32) -> u32) -> Registers {
        let mut registers = Registers::default();
        let (mut left, mut many, mut width) = (n, 1, width);
        while left > 1 {
            left = left.div_ceil(2);
            width += many * LIMB;
            many *= 2;
            let used = (0..left).map(|k| kept(k * many, many.min(n - k * many))).sum::<u32>();
            let copies = 1 + u32::from(last_is_skid && left == 1);
            registers = registers + copies * Registers::of_use(left * width + 1, used + 1);
        }
        registers
    }

    /// Bits that are read of a number of `width` bits that stands at limb `place` of the product.
    fn kept(&self, width: u32, place: u32) -> u32 {
        let from = LIMB * place;
        (from + width).min(self.high).saturating_sub(from.max(self.low))
    }
}

/// Bits of `many` limbs of a factor of `width` bits from limb `from` on, as a signed number.
fn run(width: u32, from: u32, many: u32) -> u32 {
    // But for the highest limb they are unsigned: one bit more.
    (width - LIMB * from).min(LIMB * many + 1)
}

/// `dot_product`: three products, x + y beside z, and their sum, of which bits from `low` on are read. Its factors have registers of their own.
pub(in crate::block) fn dot_product(a: u32, b: u32, sum: u32, product_stages: u32, low: u32) -> Registers {
    let product = Multiplier { product_stages, last_is_skid: true, ..Multiplier::new(a, b).near() };
    3 * product.registers() + Registers::stage(sum + a + b) + Registers::stage(sum).without(low)
}

/// `cross_product`: six products and three differences.
pub(in crate::block) fn cross_product(width: u32) -> Registers {
    let product = Multiplier { product_stages: EDGE_PRODUCT_STAGES, ..Multiplier::new(width, width).near() };
    6 * product.registers() + Registers::skid(3 * 2 * width)
}
