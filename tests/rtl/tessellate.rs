use crate::draw::{Draw, POINT_MAX};
use crate::suite::Suite;
use lodray::block::tessellate::{In, Tessellate};
use lodray::num::{EdgeState, Point, S_ONE, U};

fn on_grid(draw: &mut Draw, grid: u64) -> Point {
    let [x, y, z] = draw.point(POINT_MAX).get().map(|v| v >> grid << grid).map(|v| if v < -POINT_MAX { v + (1 << grid) } else { v });
    Point::new(x, y, z)
}

fn with_states(draw: &mut Draw, mut state: impl FnMut(&mut Draw) -> EdgeState) -> In {
    let grid = draw.below(10);
    let [s0, s1, s2] = [0; 3].map(|_| state(draw));
    let [p0, p1, p2] = [0; 3].map(|_| on_grid(draw, grid + 1));
    let [q0, q1, q2] = [0; 3].map(|_| on_grid(draw, grid));
    In { grid: U::new(grid), s0, s1, s2, p0, p1, p2, q0, q1, q2 }
}

fn random(draw: &mut Draw) -> In {
    with_states(draw, |draw| U::new(draw.below(S_ONE + 1)))
}

fn border_states(draw: &mut Draw) -> In {
    with_states(draw, |draw| U::new([0, 1, S_ONE - 1, S_ONE][draw.below(4) as usize]))
}

/// Inserted vertices next to the midpoint, where rounding to the grid decides.
fn near_midpoint(draw: &mut Draw) -> In {
    let input = random(draw);
    let grid = input.grid.get();
    let mut beside = |a: Point, b: Point| {
        let [x, y, z] = [0, 1, 2].map(|k| {
            let m = (a.get()[k] + b.get()[k]) / 2;
            (m + (draw.signed(3) << grid)).clamp(-POINT_MAX >> grid << grid, POINT_MAX >> grid << grid).max(-POINT_MAX + (1 << grid) - 1)
        });
        let [x, y, z] = [x, y, z].map(|v| v >> grid << grid);
        Point::new(x, y, z)
    };
    let (q0, q1, q2) = (beside(input.p1, input.p2), beside(input.p2, input.p0), beside(input.p0, input.p1));
    In { q0, q1, q2, ..input }
}

#[test]
fn rtl_equals_rust() {
    Suite::<Tessellate>::new(
        &[("random", random), ("states at the borders", border_states), ("beside the midpoint", near_midpoint)],
        &[
            ("s = 0 gives the midpoint", |i, o| i.s0.get() == 0 && 2 * o.q0.get()[0] == i.p1.get()[0] + i.p2.get()[0]),
            ("s = 1 gives the stored vertex", |i, o| i.s1.get() == S_ONE && o.q1 == i.q1),
            ("s just above 0", |i, _| i.s2.get() == 1),
            ("s just below 1", |i, _| i.s2.get() == S_ONE - 1),
            ("grid 0", |i, _| i.grid.get() == 0),
            ("grid 9", |i, _| i.grid.get() == 9),
            ("largest step", |i, _| (i.q0.get()[0] - (i.p1.get()[0] + i.p2.get()[0]) / 2).abs() > (1 << 32) - 2048),
        ],
    )
    .run();
}
