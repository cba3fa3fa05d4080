//! Pictures for the tests: the pairs of `pairs/` with the figures of other programs, and noise.

use image::{Rgb, RgbImage};
use std::path::Path;

/// A pair of pictures, and its line of `figures.json`.
pub(super) struct Pair {
    pub(super) a: RgbImage,
    pub(super) b: RgbImage,
    line: String,
}

impl Pair {
    pub(super) fn name(&self) -> &str {
        self.line.split('"').nth(3).unwrap()
    }

    /// A figure by name; none where it is null.
    pub(super) fn figure(&self, name: &str) -> Option<f64> {
        let (_, rest) = self.line.split_once(&format!("\"{name}\": ")).unwrap();
        rest.split([',', '}']).next().unwrap().parse().ok()
    }
}

/// All pairs.
pub(super) fn pairs() -> Vec<Pair> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("pairs");
    let figures = std::fs::read_to_string(folder.join("figures.json")).unwrap();
    let lines = figures.lines().filter(|line| line.contains("\"pair\": "));
    let all: Vec<Pair> = lines
        .map(|line| {
            let name = line.split('"').nth(3).unwrap();
            let [a, b] = ["a", "b"].map(|side| image::open(folder.join(format!("{name}_{side}.png"))).unwrap().to_rgb8());
            Pair { a, b, line: line.to_owned() }
        })
        .collect();
    assert!(all.len() >= 6);
    all
}

/// Independent codes, another picture for each seed.
pub(super) fn noise([width, height]: [u32; 2], seed: u32) -> RgbImage {
    let code = |x: u32, y: u32, k: u32| {
        let mixed = (x ^ y.rotate_left(11) ^ k.rotate_left(22) ^ seed.rotate_left(27)).wrapping_mul(0x9E37_79B9);
        ((mixed ^ mixed >> 15).wrapping_mul(0x85EB_CA6B) >> 24) as u8
    };
    RgbImage::from_fn(width, height, |x, y| Rgb([0, 1, 2].map(|k| code(x, y, k))))
}

/// What `work` gives with so many threads.
pub(super) fn with_threads<T: Send>(threads: usize, work: impl FnOnce() -> T + Send) -> T {
    rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap().install(work)
}
