use crate::draw::Draw;
use crate::suite::Suite;
use lodray::block::child_sort::{ChildSort, In};
use lodray::num::U;

fn random(draw: &mut Draw) -> In {
    In { hit: [0; 4].map(|_| draw.once_in(2)), t_near: [0; 4].map(|_| draw.bits()) }
}

/// Few different distances.
fn equal(draw: &mut Draw) -> In {
    let base = draw.bits::<16>().get();
    In { hit: [0; 4].map(|_| !draw.once_in(4)), t_near: [0; 4].map(|_| U::new(base + draw.below(2))) }
}

/// One bit decides.
fn close(draw: &mut Draw) -> In {
    let base = draw.bits::<17>().get();
    In { hit: [true; 4], t_near: [0; 4].map(|_| U::new(base ^ (1 << draw.below(17)))) }
}

#[test]
fn rtl_equals_rust() {
    Suite::<ChildSort>::new(
        &[("random", random), ("equal t_near", equal), ("one bit apart", close)],
        &[
            ("none hit", |_, o| o.count.get() == 0),
            ("all hit", |_, o| o.count.get() == 4),
            ("all equal", |i, o| o.count.get() == 4 && i.t_near.iter().all(|t| *t == i.t_near[0])),
            ("reversed", |_, o| o.order.map(U::get) == [3, 2, 1, 0]),
            ("largest distance", |i, _| i.t_near.contains(&U::MAX)),
        ],
    )
    .run();
}
