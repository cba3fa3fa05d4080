//! FLIP and SSIM: the figures that flip-evaluator and scikit-image give for the pairs of `data/pictures` (made by its make.py), and what holds for
//! any two pictures.

use image::imageops::rotate90;
use image::{Rgb, RgbImage};
use lodray::picture::{ErrorSpread, PIXELS_PER_DEGREE, PictureError, compare, flip, structural_similarity};
use serde_json::Value;
use std::path::Path;

/// Figures of the FLIP of a pair.
fn flip_of(a: &RgbImage, b: &RgbImage, pixels_per_degree: f64) -> ErrorSpread {
    PictureError::of(a, b, pixels_per_degree).flip
}

/// Two pictures, and their line of `figures.json`.
struct Pair {
    a: RgbImage,
    b: RgbImage,
    figures: Value,
}

impl Pair {
    fn name(&self) -> &str {
        self.figures["pair"].as_str().unwrap()
    }

    /// A figure by name; none where it is null.
    fn figure(&self, name: &str) -> Option<f64> {
        self.figures.get(name).unwrap_or_else(|| panic!("no {name}")).as_f64()
    }
}

fn pairs() -> Vec<Pair> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data/pictures");
    let all: Value = serde_json::from_slice(&std::fs::read(folder.join("figures.json")).unwrap()).unwrap();
    assert_eq!(all["pixels_per_degree"], PIXELS_PER_DEGREE);
    let pairs = all["pairs"].as_array().unwrap().iter().map(|figures| {
        let side = |side| image::open(folder.join(format!("{}_{side}.png", figures["pair"].as_str().unwrap()))).unwrap().to_rgb8();
        Pair { a: side("a"), b: side("b"), figures: figures.clone() }
    });
    let pairs: Vec<_> = pairs.collect();
    assert!(pairs.len() >= 6);
    pairs
}

/// Independent codes, another picture for each seed.
fn noise([width, height]: [u32; 2], seed: u32) -> RgbImage {
    let code = |x: u32, y: u32, k: u32| {
        let mixed = (x ^ y.rotate_left(11) ^ k.rotate_left(22) ^ seed.rotate_left(27)).wrapping_mul(0x9E37_79B9);
        ((mixed ^ mixed >> 15).wrapping_mul(0x85EB_CA6B) >> 24) as u8
    };
    RgbImage::from_fn(width, height, |x, y| Rgb([0, 1, 2].map(|k| code(x, y, k))))
}

/// What `work` gives with so many threads.
fn with_threads<T: Send>(threads: usize, work: impl FnOnce() -> T + Send) -> T {
    rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap().install(work)
}

/// `definition` is the program in f64 of make.py, straight from the paper: far closer than flip-evaluator, of which roundings leave edges in flat pictures.
#[test]
fn flip_is_that_of_the_reference_and_of_the_definition() {
    for pair in pairs() {
        let [error, at_30] = [PIXELS_PER_DEGREE, 30.0].map(|degree| flip_of(&pair.a, &pair.b, degree));
        for (name, ours, tolerance) in [
            ("flip_mean", error.mean, 1e-4),
            ("flip_mean_at_30", at_30.mean, 1e-4),
            ("definition_mean", error.mean, 2e-7),
            ("definition_mean_at_30", at_30.mean, 2e-7),
            ("definition_maximum", error.maximum, 1e-6),
        ] {
            let theirs = pair.figure(name).unwrap();
            assert!((ours - theirs).abs() < tolerance, "{} {name}: {ours} {theirs}", pair.name());
        }
    }
}

#[test]
fn ssim_is_that_of_the_reference() {
    for pair in pairs() {
        let (ours, theirs) = (structural_similarity(&pair.a, &pair.b), pair.figure("ssim"));
        assert_eq!(ours.is_some(), theirs.is_some(), "{}", pair.name());
        if let Some((ours, theirs)) = ours.zip(theirs) {
            assert!((ours - theirs).abs() < 1e-6, "{}: {ours} {theirs}", pair.name());
        }
    }
}

#[test]
fn all_figures_of_a_pair_stand_together_and_survive_json() {
    for pair in pairs() {
        let error = PictureError::of(&pair.a, &pair.b, PIXELS_PER_DEGREE);
        let numbers = compare(&pair.a, &pair.b);
        assert_eq!((error.rmse, error.psnr_db, error.off), (numbers.rmse, numbers.psnr_db, numbers.differing));
        assert_eq!(error.ssim, structural_similarity(&pair.a, &pair.b));
        let map = flip(&pair.a, &pair.b, PIXELS_PER_DEGREE);
        assert_eq!(Some(error.flip), ErrorSpread::of(map.into_iter().map(f64::from)));
        assert_eq!(serde_json::from_str::<PictureError>(&serde_json::to_string(&error).unwrap()).unwrap(), error);
    }
}

#[test]
fn equal_pictures_do_not_differ() {
    for size in [[0, 0], [1, 1], [3, 500], [500, 3], [70, 65]] {
        let picture = noise(size, 1);
        let error = PictureError::of(&picture, &picture, PIXELS_PER_DEGREE);
        let ssim = (size[0].min(size[1]) >= 11).then_some(1.0);
        assert_eq!(error, PictureError { rmse: 0.0, psnr_db: None, ssim, flip: ErrorSpread::default(), off: 0.0 }, "{size:?}");
        assert_eq!(flip(&picture, &picture, PIXELS_PER_DEGREE).len(), (size[0] * size[1]) as usize);
    }
}

#[test]
fn no_window_of_ssim_lies_within_a_small_picture() {
    for size in [[0, 0], [1, 1], [3, 500], [500, 3], [10, 11], [11, 10]] {
        assert_eq!(structural_similarity(&noise(size, 1), &noise(size, 2)), None, "{size:?}");
    }
    for size in [[11, 11], [11, 500], [500, 11]] {
        assert!(structural_similarity(&noise(size, 1), &noise(size, 2)).is_some_and(|s| s.abs() < 0.5), "{size:?}");
    }
}

#[test]
fn pictures_on_their_side_have_their_map_on_its_side() {
    // 149 rows are two bands and a part of FLIP's and of SSIM's.
    for size in [[1, 1], [3, 500], [129, 40], [40, 149]] {
        let [a, b] = [1, 2].map(|seed| noise(size, seed));
        let map = flip(&a, &b, PIXELS_PER_DEGREE);
        assert!(map.iter().all(|v| (0.0..=1.0).contains(v)) && map == flip(&b, &a, PIXELS_PER_DEGREE));
        let turned = flip(&rotate90(&a), &rotate90(&b), PIXELS_PER_DEGREE);
        let [width, height] = size.map(|side| side as usize);
        for (k, &value) in turned.iter().enumerate() {
            let (x, y) = (k % height, k / height);
            assert!((value - map[(height - 1 - x) * width + y]).abs() < 1e-6, "{size:?} {k}");
        }
        let similarity = structural_similarity(&a, &b);
        assert_eq!(structural_similarity(&b, &a), similarity);
        if let Some((one, turned)) = similarity.zip(structural_similarity(&rotate90(&a), &rotate90(&b))) {
            assert!((one - turned).abs() < 1e-13, "{size:?}");
        }
    }
}

#[test]
fn the_same_bits_with_any_number_of_threads() {
    let [a, b] = [1, 2].map(|seed| noise([75, 333], seed));
    let of = |threads| {
        let map = || {
            (
                flip(&a, &b, PIXELS_PER_DEGREE).iter().map(|v| v.to_bits()).collect::<Vec<_>>(),
                structural_similarity(&a, &b).map(f64::to_bits),
            )
        };
        with_threads(threads, map)
    };
    assert!(of(1) == of(2) && of(1) == of(7));
}

#[test]
fn any_distance_from_the_monitor_gives_values_from_0_to_1() {
    let [a, b] = [1, 2].map(|seed| noise([40, 30], seed));
    for pixels_per_degree in [f64::NEG_INFINITY, 0.0, 1.0, 5.0, 67.0, 1000.0, 1e300, f64::NAN] {
        assert!(flip(&a, &b, pixels_per_degree).iter().all(|v| (0.0..=1.0).contains(v)), "{pixels_per_degree}");
    }
    assert_eq!(flip(&a, &b, 1e9), flip(&a, &b, 1000.0));
}
