//! The four children of a tree's node against a ray: their prisms, tested and sorted (paper figure 9, with prisms for its boxes).
//!
//! One [`PrismFrame`], four [`PrismTest`] (or fewer, through which the children go in turn) and one [`ChildSort`] in a row.
//! Legal: what the parts ask for.

use super::child_sort::{self, ChildSort};
use super::child_test::{self, sort};
use super::parts::{Parts, Registers, TAG};
use super::prism_frame::{self, PrismFrame};
use super::prism_test::{self, PrismTest};
use super::ray_setup;
use super::{Block, BoxesPerCycle, Form, Timing};
use crate::num::prism::child;
use crate::num::{Point, RayT, TNear, U, Wire, wire_struct};

wire_struct! {
    /// Input of [`ChildPrisms`].
    pub struct In {
        /// The ray's constants.
        ray: ray_setup::Out,
        /// t of the closest hit so far.
        t_max: RayT,
        /// Exponent of reaches; at its largest, all children are met.
        reach: U<3>,
        /// Exponent of heights.
        height: U<4>,
        /// Codes of child k at 5k to 5k + 4: reach beyond the edges (p1, p2), (p2, p0), (p0, p1), height below and above.
        planes: [U<3>; 20],
        /// Corners and inserted vertices of full resolution: p0, p1, p2, q0, q1, q2.
        full: [Point; 6],
        /// The same as morphed for this ray.
        morphed: [Point; 6],
    }
}

/// The block.
pub struct ChildPrisms;

/// Prism tests of the RTL as it stands.
const TESTS: BoxesPerCycle = BoxesPerCycle::One;

impl ChildPrisms {
    /// Timing of the RTL with so many prism tests: each pass but the first takes a cycle more.
    pub const fn with_tests(tests: BoxesPerCycle) -> Timing {
        let passes = tests.passes(4);
        let latency = PrismFrame::TIMING.latency + PrismTest::TIMING.latency + ChildSort::TIMING.latency + passes - 1;
        Timing { latency, interval: passes }
    }
}

impl Block for ChildPrisms {
    const NAME: &'static str = "child_prisms";
    const TIMING: Timing = Self::with_tests(TESTS);
    type In = In;
    type Out = child_test::Out;
    fn parts(form: &Form) -> Parts {
        let (frame, test, sort) = (PrismFrame::parts(form), PrismTest::parts(form), ChildSort::parts(form));
        // Codes and the ray's end beside the frame.
        let (framed, tested) = (PrismFrame::TIMING.latency, PrismTest::TIMING.latency);
        let codes = Registers::line(TNear::WIDTH + 4 * 5 * 3 + 3 + 4 + TAG, framed, 1);
        let (side_by_side, passes) = (TESTS.side_by_side(4), TESTS.passes(4));
        // A tag of one bit for which there is no use; the first test's is of use.
        let child = PrismTest::registers(1).without(tested + 2);
        let pass = passes.ilog2();
        let turns = Registers::bits(2 * pass + (4 - side_by_side) * (1 + TNear::WIDTH));
        let tests = PrismTest::registers(TAG + pass) + (side_by_side - 1) * child + turns;
        let four = |[count, a, b]: [u32; 3]| [4 * count, a, b];
        Parts {
            products: frame.products.into_iter().chain(test.products.into_iter().map(four)).collect(),
            add_bits: frame.add_bits + 4 * test.add_bits + sort.add_bits,
            select_bits: frame.select_bits + 4 * test.select_bits + sort.select_bits,
            registers: PrismFrame::registers(1).without(PrismFrame::TIMING.latency + 1)
                + codes
                + tests.in_turns(passes)
                + ChildSort::registers(4 * TNear::WIDTH + TAG),
        }
    }
    #[inline(always)]
    fn eval(i: &In) -> child_test::Out {
        let prism_frame::Out { frame, corners } = PrismFrame::eval(&prism_frame::In { ray: i.ray, full: i.full, morphed: i.morphed });
        let mut tests = child_sort::In::default();
        for k in 0..4 {
            let planes = std::array::from_fn(|j| i.planes[5 * k + j]);
            let input = prism_test::In { frame, t_max: i.t_max, corners: child(&corners, k), planes, reach: i.reach, height: i.height };
            let test = PrismTest::eval(&input);
            tests.hit[k] = test.hit;
            tests.t_near[k] = test.t_near;
        }
        sort(&tests)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::block::ray_setup::RaySetup;
    use crate::num::prism::{HEIGHT, OPEN, area, local_corners, normal};
    use crate::num::{COORD_LIMIT, Direction, Random};

    /// A point of a child's prism in units, rounded, or of what morphed corners add to it; weights in 2^-20.
    struct Target {
        child: usize,
        at: [i64; 3],
    }

    fn random_points(random: &mut Random, middle: [i64; 3], bits: u64, flat: bool) -> [[i32; 3]; 6] {
        std::array::from_fn(|_| {
            std::array::from_fn(|c| {
                let by = if flat && c == 1 { random.within(2) } else { random.within((1 << bits) - 1) };
                (middle[c] + by).clamp(-i64::from(COORD_LIMIT), i64::from(COORD_LIMIT)) as i32
            })
        })
    }

    /// A point of the prism of child `k` that is whole in units, or none: nearest to a random one, checked exactly.
    fn inside(random: &mut Random, full: &[[i32; 3]; 6], planes: &[u64; 20], reach: u64, height: u64, k: usize) -> Option<[i64; 3]> {
        let (local, shift) = local_corners(full);
        let l = child(&local, k);
        let n = normal(area(l));
        let code = |j: usize| planes[5 * k + j] as f64;
        let step = 0.5f64.powi(reach as i32 + 1);
        // Weights of the outer triangle's corners, some of them 0.
        let mut w = [0, 1, 2].map(|_| if random.below(4) == 0 { 0.0 } else { random.below(1 << 20) as f64 });
        let sum: f64 = w.iter().sum();
        if sum == 0.0 {
            return None;
        }
        w = w.map(|w| w / sum);
        let all: f64 = (0..3).map(|j| code(j) * step).sum();
        let b: [f64; 3] = std::array::from_fn(|j| w[j] * (1.0 + all) - code(j) * step);
        let h = match random.below(3) {
            0 => -code(3),
            1 => code(4),
            _ => code(4) - (code(3) + code(4)) * random.below(1 << 20) as f64 / f64::from(1 << 20),
        } * 0.5f64.powi(height as i32);
        let at: [i64; 3] = std::array::from_fn(|c| {
            let local: f64 = (0..3).map(|j| b[j] * f64::from(l[j][c])).sum::<f64>() + h * f64::from(HEIGHT) * f64::from(n[c]);
            i64::from(full[0][c]) + (local * (1u64 << shift) as f64).round() as i64
        });
        holds(full, planes, reach, height, k, at).then_some(at)
    }

    /// Whether the prism of child `k` holds this point, in whole numbers.
    fn holds(full: &[[i32; 3]; 6], planes: &[u64; 20], reach: u64, height: u64, k: usize, at: [i64; 3]) -> bool {
        let (local, shift) = local_corners(full);
        let l = child(&local, k);
        let (cross, n) = (area(l).map(i128::from), normal(area(l)).map(i128::from));
        let whole: i128 = (0..3).map(|c| cross[c] * n[c]).sum();
        let x: [i128; 3] = std::array::from_fn(|c| i128::from(at[c]) - i128::from(full[0][c]) - (i128::from(l[0][c]) << shift));
        let dot = |a: [i128; 3], b: [i128; 3]| a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
        let times = |a: [i128; 3], b: [i128; 3]| [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
        let [e, f] = [1, 2].map(|i: usize| std::array::from_fn::<i128, 3, _>(|c| i128::from(l[i][c] - l[0][c])));
        let (b1, b2, rise) = (dot(x, times(f, n)), dot(x, times(n, e)), dot(x, cross));
        let scale = whole << shift;
        let reaches = |number: i128, j: usize| (number << (reach + 1)) >= -i128::from(planes[5 * k + j]) * scale;
        let heights = (rise << height) >= -i128::from(planes[5 * k + 3]) * scale * i128::from(HEIGHT)
            && (rise << height) <= i128::from(planes[5 * k + 4]) * scale * i128::from(HEIGHT);
        let limit = i64::from(COORD_LIMIT);
        whole > 0 && reaches(scale - b1 - b2, 0) && reaches(b1, 1) && reaches(b2, 2) && heights && at.iter().all(|c| c.abs() <= limit)
    }

    /// Rays through whole points of a prism, or of what lies between it and morphed corners, meet it, no later than t_near says.
    #[test]
    fn no_ray_misses_a_point_of_a_prism() {
        let (mut tested, mut culled, mut near) = (0u64, 0u64, 0u64);
        for number in 0..300_000 {
            let mut random = Random::of(11, number);
            let bits = 3 + random.below(27);
            let middle = [(); 3].map(|()| random.within(1 << 29));
            let flat = random.below(3) == 0;
            let full = random_points(&mut random, middle, bits, flat);
            let codes = random.below(8);
            let planes: [u64; 20] = [(); 20].map(|()| random.below(codes + 1));
            let (reach, height) = (random.below(u64::from(OPEN)), random.below(16));
            let k = random.below(4) as usize;
            let Some(mut at) = inside(&mut random, &full, &planes, reach, height, k) else { continue };
            let morph = random.below(2) == 0;
            let by = random.below(bits);
            let morphed: [[i32; 3]; 6] = full.map(|p| {
                p.map(|c| {
                    if morph {
                        (i64::from(c) + (random.within(1 << bits) >> by)).clamp(-i64::from(COORD_LIMIT), i64::from(COORD_LIMIT)) as i32
                    } else {
                        c
                    }
                })
            });
            let corner = random.below(3) as usize;
            if morph && random.below(2) == 0 && holds(&full, &planes, reach, height, k, child(&full, k)[corner].map(i64::from)) {
                // A morphed corner itself.
                at = child(&morphed, k)[corner].map(i64::from);
            }
            let target = Target { child: k, at };
            // o = x - m d, exactly; the point lies at t = m |d|.
            let d = loop {
                let down = random.below(29);
                let d = [(); 3].map(|()| random.within(1 << 29) >> random.below(down + 1));
                if d != [0; 3] {
                    break d;
                }
            };
            let most = (0..3)
                .map(|c| {
                    if d[c] == 0 {
                        i64::MAX
                    } else {
                        ((i64::from(COORD_LIMIT) - (target.at[c] * d[c].signum()).abs().min(i64::from(COORD_LIMIT))) / d[c].abs()).max(0)
                    }
                })
                .min()
                .unwrap_or(0);
            let m = if most == 0 { 0 } else { random.below(most as u64 + 1) as i64 };
            let origin: [i64; 3] = std::array::from_fn(|c| target.at[c] - m * d[c]);
            if origin.iter().any(|c| c.abs() > i64::from(COORD_LIMIT)) {
                continue;
            }
            let ray = RaySetup::eval(&ray_setup::In {
                origin: Point::new(origin[0], origin[1], origin[2]),
                direction: Direction::new(d[0], d[1], d[2]),
            });
            let input = In {
                ray,
                t_max: RayT::MAX,
                reach: U::new(reach),
                height: U::new(height),
                planes: planes.map(U::new),
                full: full.map(Point::from_i32),
                morphed: morphed.map(Point::from_i32),
            };
            let out = ChildPrisms::eval(&input);
            let met = |out: &child_test::Out, child: usize| out.order.iter().take(out.met() as usize).any(|k| k.get() as usize == child);
            assert!(met(&out, target.child), "{number}: {input:?}");
            // t in steps of 2^16 units of a direction of 2^30.
            let t_near = out.t_near[target.child].get() as f64;
            assert!(t_near * 65_536.0 <= m as f64 * f64::from(1 << 30), "{number}: {t_near} {m} {d:?} {:?} {input:?}", target.at);
            tested += 1;
            culled += u64::from(out.met() < 4);
            near += u64::from(out.t_near[target.child].get() > 0);
        }
        println!("{tested} rays, {culled} missed a sibling, {near} with a distance");
        assert!(tested > 50_000 && culled > 10_000 && near > 1_000, "{tested} rays, {culled} missed a sibling, {near} with a distance");
    }
}
