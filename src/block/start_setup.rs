//! Per-ray constants of the box tests for an exact start (`docs/numbers.md`, "Start").
//!
//! The ray starts at x = X + f / 2^31 with X whole and 0 <= f < 2^31. All is as [`RaySetup`] has it for X, but `moment`, which is that of x rounded down, c_ij = floor(x_i d_j - x_j d_i), and
//! `ceil_i` = ceil(x_i / 2^16); the mirrored origin stays that of X.
//! Legal: as [`RaySetup`], for X.

use super::parts::{Multiplier, Parts, Registers};
use super::ray_setup::{self, Axis, RaySetup};
use super::{Block, Form, Timing};
use crate::num::{BOX_SHIFT, Direction, S, START_BITS, Start, Vec3, Wire, wire_struct};

wire_struct! {
    /// Input of [`StartSetup`].
    pub struct In {
        /// Where the ray starts.
        start: Start,
        /// Direction.
        direction: Direction,
    }
}

/// The block.
pub struct StartSetup;

/// Of x_i d_j - x_j d_i what the fraction adds, rounded down: below 2^31 with its sign.
const MORE: u32 = 32;

impl Block for StartSetup {
    const NAME: &'static str = "start_setup";
    /// As long as [`RaySetup`]: what the fraction adds is there before the reciprocals are.
    const TIMING: Timing = RaySetup::TIMING;
    type In = In;
    type Out = ray_setup::Out;
    fn timing(form: &Form) -> Timing {
        RaySetup::timing(form)
    }
    fn parts(form: &Form) -> Parts {
        let of_whole = RaySetup::parts(form);
        let (component, fraction, moment) = (Direction::WIDTH / 3, START_BITS + 1, Vec3::<63>::WIDTH / 3);
        let product = Multiplier { unsigned: 1, ..Multiplier::new(fraction, component).near() };
        // Fraction and direction; how many products were begun; the first of two, that it is there, which axis they are for, and what the fraction adds.
        let around = Registers::bits(3 * START_BITS + 3 * component + 3 + moment - 1 + 1 + 2 + 3 * MORE);
        let registers = of_whole.registers + (product.registers() + around).in_turns(RaySetup::timing(form).interval);
        Parts {
            products: [of_whole.products, vec![[6, component, fraction]]].concat(),
            add_bits: of_whole.add_bits + 2 * 3 * moment + 3 * (17 + BOX_SHIFT),
            select_bits: of_whole.select_bits + 3 * moment,
            registers,
        }
    }
    #[inline]
    fn eval(input: &In) -> ray_setup::Out {
        let In { start, direction } = *input;
        let ray_setup::Out { x, y, z, moment } = RaySetup::eval(&ray_setup::In { origin: start.point, direction });
        let axes = [x, y, z];
        let fraction: [i64; 3] = std::array::from_fn(|k| {
            let f = start.fraction[k].get().cast_signed();
            if axes[k].mirror { -f } else { f }
        });
        // Products below 2^61, and what is left of their difference below 2^31; the sum stays below 2^62 like the moment of any point.
        let more =
            |i: usize, j: usize| (fraction[i] * axes[j].d.get().cast_signed() - fraction[j] * axes[i].d.get().cast_signed()) >> START_BITS;
        let [yz, zx, xy] = moment.get();
        let [x, y, z] = [0, 1, 2].map(|k| {
            // With a fraction ahead of it a whole point's ceiling is that of the next one.
            let ahead = i64::from(fraction[k] > 0);
            Axis { ceil: S::new((axes[k].origin.get() + ahead + ((1 << BOX_SHIFT) - 1)) >> BOX_SHIFT), ..axes[k] }
        });
        ray_setup::Out { x, y, z, moment: Vec3::new(yz + more(1, 2), zx + more(2, 0), xy + more(0, 1)) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::num::{Point, Random, U};

    fn point(random: &mut Random, most: u64) -> Point {
        let [x, y, z] = [(); 3].map(|()| random.within(most));
        Point::new(x, y, z)
    }

    fn any_direction(random: &mut Random) -> Direction {
        let [x, y, z] = [(); 3].map(|()| random.within(1 << 29) * i64::from(random.below(5) > 0));
        Direction::new(x, y, z)
    }

    #[test]
    fn constants_are_those_of_the_exact_start() {
        for number in 0..20_000 {
            let mut random = Random::of(2, number);
            let start = Start {
                point: point(&mut random, (1 << 31) - 2),
                fraction: [(); 3].map(|()| U::new(random.below(1 << 31) * random.below(2))),
            };
            let direction = any_direction(&mut random);
            let out = StartSetup::eval(&In { start, direction });
            let (whole, d) = (start.point.get(), direction.get());
            let x: [i128; 3] = std::array::from_fn(|k| (i128::from(whole[k]) << START_BITS) + i128::from(start.fraction[k].get()));
            // Mirrored.
            let m: [i128; 3] = std::array::from_fn(|k| if d[k] < 0 { -x[k] } else { x[k] });
            let size = |k: usize| i128::from(d[k].abs());
            let axes = [out.x, out.y, out.z];
            for k in 0..3 {
                let ceil = -((-m[k]) >> (START_BITS + BOX_SHIFT));
                assert_eq!((i128::from(axes[k].ceil.get()), axes[k].mirror), (ceil, d[k] < 0), "{start:?} {d:?}");
            }
            let moment = [(1, 2), (2, 0), (0, 1)].map(|(i, j)| (m[i] * size(j) - m[j] * size(i)) >> START_BITS);
            assert_eq!(out.moment.get().map(i128::from), moment, "{start:?} {d:?}");
        }
    }

    #[test]
    fn from_a_whole_point_it_is_the_rays_constants() {
        for number in 0..20_000 {
            let mut random = Random::of(3, number);
            let (origin, direction) = (point(&mut random, (1 << 31) - 1), any_direction(&mut random));
            let start = Start { point: origin, fraction: Default::default() };
            assert_eq!(StartSetup::eval(&In { start, direction }), RaySetup::eval(&ray_setup::In { origin, direction }));
        }
    }
}
