//! The order of the four children, and of six.

/// The suite of a block that sorts so many children.
macro_rules! sorts {
    ($module:ident, $Block:ident, $n:literal) => {
        use crate::draw::Draw;
        use crate::suite::{Category, Suite};
        use lodray::block::$module::{In, Out, $Block};
        use lodray::num::U;

        fn random(draw: &mut Draw) -> In {
            In { hit: [0; $n].map(|_| draw.once_in(2)), t_near: [0; $n].map(|_| draw.bits()) }
        }

        /// Two distances.
        fn few(draw: &mut Draw) -> In {
            let base = draw.bits::<16>().get();
            In { hit: [0; $n].map(|_| !draw.once_in(8)), t_near: [0; $n].map(|_| U::new(base + draw.below(2))) }
        }

        fn equal(draw: &mut Draw) -> In {
            In { t_near: [draw.bits(); $n], ..random(draw) }
        }

        /// One bit decides.
        fn close(draw: &mut Draw) -> In {
            let base = draw.bits::<17>().get();
            In { hit: [true; $n], t_near: [0; $n].map(|_| U::new(base ^ (1 << draw.below(17)))) }
        }

        fn hits(draw: &mut Draw, hit: bool) -> In {
            In { hit: [hit; $n], ..random(draw) }
        }

        /// The missed are nearer than the hit.
        fn missed_first(draw: &mut Draw) -> In {
            let hit = random(draw).hit;
            In { hit, t_near: hit.map(|hit| if hit { U::new(1 << 16 | draw.below(1 << 16)) } else { U::new(draw.below(1 << 16)) }) }
        }

        fn is_equal(i: &In) -> bool {
            let mut hit = i.t_near.iter().zip(i.hit).filter(|(_, hit)| *hit).map(|(t, _)| t);
            hit.next().is_some_and(|first| hit.any(|t| t == first))
        }

        /// Number of the permutation, from 0: for each place, how many of the later ones are smaller.
        fn rank(o: &Out) -> u64 {
            let order = o.order.map(U::get);
            let smaller = |k: usize| order[k..].iter().filter(|&&v| v < order[k]).count() as u64;
            (0..$n).fold(0, |rank, k| rank * ($n - k) as u64 + smaller(k))
        }

        type Is = Category<$Block>;

        pub fn suite() -> Suite<$Block> {
            Suite::new(
                |_| true,
                vec![
                    Is::any("random", random),
                    Is::often("two distances", few, |i, _| is_equal(i)),
                    Is::all("all distances equal", equal, |i, o| {
                        let order = o.order.map(|k| k.get() as usize);
                        order.windows(2).all(|w| i.hit[w[0]] != i.hit[w[1]] || w[0] < w[1])
                    }),
                    Is::any("one bit apart", close),
                    Is::all("none hit", |d| hits(d, false), |_, o| o.count.get() == 0 && o.order.map(U::get).into_iter().eq(0..$n)),
                    Is::all("all hit", |d| hits(d, true), |_, o| o.count.get() == $n),
                    Is::often("missed ones nearer", missed_first, |_, o| (1..$n).contains(&o.count.get())),
                ],
                vec![
                    ("largest distance, hit", |i, _| i.hit[0] && i.t_near[0] == U::MAX),
                    ("distance 0, hit", |i, _| i.hit[$n - 1] && i.t_near[$n - 1] == U::ZERO),
                ],
                vec![
                    ("count", 0..=$n, |_, o| o.count.get()),
                    ("permutation", 0..=(1..=$n).product::<u64>() - 1, |_, o| rank(o)),
                    ("children hit", 0..=(1 << $n) - 1, |i, _| (0..$n).map(|k| u64::from(i.hit[k]) << k).sum()),
                ],
            )
        }

        crate::suite::modes!(suite());
    };
}
pub(crate) use sorts;

sorts!(child_sort, ChildSort, 4);
