//! Time of both measures at 1024x1024, the processor's time of the whole process: `RAYON_NUM_THREADS=1 cargo run --release --example time`.

use image::{Rgb, RgbImage};
use std::time::Instant;

/// Seconds of the processor so far, in hundredths.
fn processor() -> f64 {
    let stat = std::fs::read_to_string("/proc/self/stat").unwrap();
    let fields: Vec<&str> = stat.rsplit_once(')').unwrap().1.split_whitespace().collect();
    (fields[11].parse::<f64>().unwrap() + fields[12].parse::<f64>().unwrap()) / 100.0
}

fn time(name: &str, work: impl Fn() -> f64) {
    let (mut best, runs, before) = (f64::INFINITY, 20, processor());
    let mut result = 0.0;
    for _ in 0..runs {
        let start = Instant::now();
        result = work();
        best = best.min(start.elapsed().as_secs_f64());
    }
    println!(
        "{name}: {:.3} s of the processor in the mean, shortest {best:.3} s by the clock ({result})",
        (processor() - before) / f64::from(runs)
    );
}

fn main() {
    let picture = |shift: u32| {
        RgbImage::from_fn(1024, 1024, |x, y| {
            let wave = |k: u32| (127.0 + 127.0 * (f64::from((x + shift) * (k + 1) + y * y / (64 << k)) / 23.0).sin()) as u8;
            Rgb([wave(0), wave(1), wave(2)])
        })
    };
    let [a, b] = [0, 2].map(picture);
    time("flip", || f64::from(flip::flip(&a, &b, flip::PIXELS_PER_DEGREE)[12345]));
    let map = flip::flip(&a, &b, flip::PIXELS_PER_DEGREE);
    time("figures of the map", || flip::FlipError::of(&map).mean);
    time("structural_similarity", || flip::structural_similarity(&a, &b).unwrap());
}
