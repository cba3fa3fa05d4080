//! Boxes in the frames of quad-BVH nodes, and of nodes of six.

/// The suite of a block with planes of so many bits; from the exponent `far` on they reach over all codes.
macro_rules! frames {
    ($module:ident, $Block:ident, $plane:literal, $far:literal) => {
        use crate::draw::Draw;
        use crate::suite::{Category, Suite};
        use lodray::block::$module::{In, Out, $Block};
        use lodray::num::{S, U, Vec3};

        const MOST: i64 = 32767;

        fn origin(draw: &mut Draw) -> Vec3<16> {
            Vec3::new(draw.signed(MOST), draw.signed(MOST), draw.signed(MOST))
        }

        fn random(draw: &mut Draw) -> In {
            In {
                origin: origin(draw),
                halves: [0; 3].map(|_| draw.once_in(2)),
                exponents: [0; 3].map(|_| U::new(draw.below(16))),
                lo: [0; 3].map(|_| draw.bits()),
                hi: [0; 3].map(|_| draw.bits()),
            }
        }

        /// Steps of which the last plane does not reach far beyond the range of codes.
        fn plausible(draw: &mut Draw) -> In {
            In { exponents: [0; 3].map(|_| U::new(draw.below(16 - $plane))), ..random(draw) }
        }

        fn at_the_origin(draw: &mut Draw) -> In {
            In { lo: [U::ZERO; 3], hi: [U::ZERO; 3], ..random(draw) }
        }

        fn all_of_space(draw: &mut Draw) -> In {
            let origin = Vec3::new(-MOST, -MOST, -MOST);
            In {
                origin,
                halves: [draw.once_in(2); 3],
                exponents: [U::new($far + draw.below(16 - $far)); 3],
                lo: [U::ZERO; 3],
                hi: [U::MAX; 3],
            }
        }

        /// A half, rounded down.
        fn halves(draw: &mut Draw) -> In {
            In { halves: [true; 3], exponents: [U::ZERO; 3], ..random(draw) }
        }

        /// Around the last code: one before it, it, one beyond.
        fn last_codes(draw: &mut Draw) -> In {
            let input = plausible(draw);
            let place = |axis: usize, v: U<$plane>, beside: i64| (MOST + beside - steps(&input, axis, v)).max(-MOST);
            let mut from = |axis: usize| {
                let beside = draw.beside();
                S::new(place(axis, input.hi[axis], beside).min(MOST))
            };
            In { origin: Vec3 { x: from(0), y: from(1), z: from(2) }, ..input }
        }

        /// Codes from the origin along an axis.
        fn steps(i: &In, axis: usize, v: U<$plane>) -> i64 {
            let twice = (v.get() * (2 + u64::from(i.halves[axis]))) << i.exponents[axis].get();
            (twice / 2).cast_signed()
        }

        fn legal(i: &In) -> bool {
            i.origin.get().iter().all(|&v| v >= -MOST)
        }

        fn largest(o: &Out) -> i64 {
            o.bounds.hi.get().into_iter().max().unwrap_or(0)
        }

        type Is = Category<$Block>;

        pub fn suite() -> Suite<$Block> {
            Suite::new(
                legal,
                vec![
                    Is::any("random", random),
                    Is::often("within the range", plausible, |_, o| largest(o) < MOST),
                    Is::all("at the origin", at_the_origin, |i, o| o.bounds.lo == i.origin && o.bounds.hi == i.origin),
                    Is::all("all of space", all_of_space, |_, o| o.bounds.lo.get() == [-MOST; 3] && o.bounds.hi.get() == [MOST; 3]),
                    Is::all("halves of a code", halves, |i, o| {
                        (0..3).all(|k| o.bounds.lo.get()[k] == (i.origin.get()[k] + (i.lo[k].get() * 3 / 2).cast_signed()).min(MOST))
                    }),
                    Is::often("around the last code", last_codes, |_, o| largest(o) == MOST),
                ],
                vec![
                    ("the last code, not beyond it", |i, o| {
                        (0..3).any(|k| i.origin.get()[k] + steps(i, k, i.hi[k]) == MOST && o.bounds.hi.get()[k] == MOST)
                    }),
                    ("one beyond it", |i, _| (0..3).any(|k| i.origin.get()[k] + steps(i, k, i.hi[k]) == MOST + 1)),
                    ("the last code before it", |_, o| o.bounds.hi.get().contains(&(MOST - 1))),
                ],
                vec![
                    ("exponent", 0..=15, |i, _| i.exponents[1].get()),
                    ("halves", 0..=7, |i, _| i.halves.iter().fold(0, |all, &half| all << 1 | u64::from(half))),
                    ("plane", 0..=(1 << $plane) - 1, |i, _| i.hi[2].get()),
                ],
            )
        }

        crate::suite::modes!(suite());
    };
}
pub(crate) use frames;

frames!(box_decode, BoxDecode, 5, 12);
