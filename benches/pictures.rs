//! How far pictures are from each other: FLIP, its figures and SSIM of 1024x1024, one core.

use criterion::{Criterion, SamplingMode, criterion_group, criterion_main};
use image::{Rgb, RgbImage};
use lodray::picture::{ErrorSpread, PIXELS_PER_DEGREE, flip, structural_similarity};
use std::hint::black_box;

const SIDE: u32 = 1024;

/// Waves of all lengths, moved by `shift` pixels.
fn waves(shift: u32) -> RgbImage {
    RgbImage::from_fn(SIDE, SIDE, |x, y| {
        let [x, y] = [x + shift, y].map(f64::from);
        let wave = |k: i32| (127.5 + 127.0 * ((x * f64::from(k + 1) + y * y / f64::from(64 << k)) / 23.0).sin()) as u8; // 0.5 to 254.5
        Rgb([wave(0), wave(1), wave(2)])
    })
}

fn benches(c: &mut Criterion) {
    let [a, b] = [0, 2].map(waves);
    let one = rayon::ThreadPoolBuilder::new().num_threads(1).build().expect("a thread");
    let map = flip(&a, &b, PIXELS_PER_DEGREE);
    let mut group = c.benchmark_group("pictures of 1024x1024, one core");
    group.sample_size(10).sampling_mode(SamplingMode::Flat);
    group.bench_function("FLIP", |bench| bench.iter(|| one.install(|| black_box(flip(&a, &b, PIXELS_PER_DEGREE)).len())));
    group.bench_function("figures of FLIP's map", |bench| bench.iter(|| black_box(ErrorSpread::of(map.iter().map(|&v| f64::from(v))))));
    group.bench_function("SSIM", |bench| bench.iter(|| one.install(|| black_box(structural_similarity(&a, &b)))));
    group.finish();
}

criterion_group!(pictures, benches);
criterion_main!(pictures);
