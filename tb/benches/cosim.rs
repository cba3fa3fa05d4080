//! Transactions per second of the block checks: RTL, Rust block, comparison and timing together, free-running and stalled.
//!
//! Rays point from anywhere to near the triangle, so that hits, misses and every edge state occur.

use criterion::{BenchmarkId, Criterion, SamplingMode, Throughput, criterion_group, criterion_main};
use lodray::block::{Block, Timing, bary_map, bound_decode, box_test, child_sort, hit_divide, lod_test, ray_setup, tri_test};
use lodray::num::{Box16, Cone, Direction, Point, Random, Ray, U, Vec3, WU, bound_scale};
use std::fmt::Debug;
use tb::{Build, Mode, Plan, check_block};

const TRANSACTIONS: u64 = 1 << 18;

struct Rng(Random);

impl Rng {
    fn draw(&mut self, bits: u32) -> u64 {
        self.0.next() >> (64 - bits)
    }

    fn signed(&mut self, bits: u32) -> i64 {
        self.draw(bits).cast_signed() - (1 << (bits - 1))
    }

    fn point(&mut self, bits: u32) -> Point {
        Vec3::new(self.signed(bits), self.signed(bits), self.signed(bits))
    }

    /// Towards the middle, give or take.
    fn direction(&mut self, origin: Point) -> Direction {
        let [x, y, z] = origin.get().map(|v| (-v) / 8 + self.signed(22));
        Vec3::new(x, y, z)
    }
}

fn rate<B: Block>(c: &mut Criterion, name: &str, build: &Build, timing: Timing, make: impl Fn(&mut Rng) -> B::In)
where
    B::In: Debug + Copy,
    B::Out: Debug,
{
    let count = TRANSACTIONS / u64::from(timing.interval);
    let mut rng = Rng(Random::new(1));
    let inputs: Vec<B::In> = (0..count).map(|_| make(&mut rng)).collect();
    let mut group = c.benchmark_group(name);
    group.throughput(Throughput::Elements(count)).sample_size(10).sampling_mode(SamplingMode::Flat);
    for mode in [Mode::Free, Mode::Stalled] {
        let plan = Plan::new(mode, 1).timing(timing);
        group.bench_function(BenchmarkId::from_parameter(format!("{mode:?}")), |b| {
            b.iter(|| check_block::<B>(build, &plan, inputs.iter().copied()).unwrap_or_else(|error| panic!("{error}")));
        });
    }
    group.finish();
}

/// A block with its default parameters.
fn plain<B: Block>(c: &mut Criterion, make: impl Fn(&mut Rng) -> B::In)
where
    B::In: Debug + Copy,
    B::Out: Debug,
{
    rate::<B>(c, B::NAME, &Build::block::<B>(), B::TIMING, make);
}

fn triangle(rng: &mut Rng) -> tri_test::In {
    let origin = rng.point(30);
    tri_test::In { origin, direction: rng.direction(origin), p0: rng.point(24), p1: rng.point(24), p2: rng.point(24) }
}

fn benches(c: &mut Criterion) {
    let scale = bound_scale(1 << 20);
    plain::<bound_decode::BoundDecode>(c, |rng| bound_decode::In { code: U::new(rng.draw(10)), scale });
    plain::<child_sort::ChildSort>(c, |rng| child_sort::In {
        hit: [(); 4].map(|()| rng.draw(1) == 1),
        t_near: [(); 4].map(|()| U::new(rng.draw(17))),
    });
    plain::<bary_map::BaryMap>(c, |rng| {
        let levels = rng.draw(8) % 11;
        let (b0, b1) = (rng.draw(30), rng.draw(30));
        let node = U::new(rng.draw(20) >> (2 * levels));
        bary_map::In { levels: U::new(levels), node, b0: U::new(b0), b1: U::new(b1), b2: U::new((1 << 31) - b0 - b1) }
    });
    plain::<box_test::BoxTest>(c, |rng| {
        let origin = rng.point(30);
        let ray = ray_setup::RaySetup::eval(&ray_setup::In { origin, direction: rng.direction(origin) });
        let lo: [i64; 3] = [(); 3].map(|()| rng.signed(10));
        let hi = lo.map(|v| v + rng.draw(8).cast_signed());
        let bounds = Box16 { lo: Vec3::new(lo[0], lo[1], lo[2]), hi: Vec3::new(hi[0], hi[1], hi[2]) };
        box_test::In { ray, t_max: U::new(rng.draw(35)), bounds }
    });
    plain::<lod_test::LodTest>(c, |rng| {
        let origin = rng.point(30);
        let cone = Cone { offset: U::new(rng.draw(20)), slope: U::new(rng.draw(14)), shift: U::new(rng.draw(4)) };
        let ray = Ray { origin, direction: rng.direction(origin), cone };
        let [e0, e1, e2] = [(); 3].map(|()| U::new(rng.draw(10)));
        lod_test::In { ray, p0: rng.point(24), p1: rng.point(24), p2: rng.point(24), e0, e1, e2, scale }
    });
    plain::<hit_divide::HitDivide>(c, |rng| {
        let denominator = 1 + u128::from(rng.draw(60));
        hit_divide::In { numerator: WU::new(denominator * u128::from(rng.draw(33))), denominator: WU::new(denominator) }
    });
    plain::<tri_test::TriTest>(c, triangle);
    let one = Build::block::<tri_test::TriTest>().parameter("EDGES_PER_CYCLE", 1);
    rate::<tri_test::TriTest>(c, "tri_test, one edge per cycle", &one, tri_test::TriTest::ONE_EDGE, triangle);
}

criterion_group!(cosim, benches);
criterion_main!(cosim);
