//! Colours as the eye takes them: channels that contrast is filtered in, and distances between what is seen then.
//!
//! Constants are those of Andersson et al., "FLIP: A Difference Evaluator for Alternating Images", HPG 2020.

use glam::{DMat3, DVec3};
use image::Rgb;

/// Linear sRGB to CIE XYZ as fractions of white, row after row. Each row is its primaries' shares in integers, divided by their sum:
/// white, all three at 1, is (1, 1, 1), so the reference white appears nowhere else.
const SHARES: [[f64; 3]; 3] =
    [[10_135_552.0, 8_788_810.0, 4_435_075.0], [2_613_072.0, 8_788_810.0, 887_015.0], [1_425_312.0, 8_788_810.0, 70_074_185.0]];

/// Exponent of a colour difference: large ones are told apart less well than small ones.
const DIFFERENCE_EXPONENT: f32 = 0.7;
/// Differences below this share of the largest one get ...
const KNEE: f64 = 0.4;
/// ... this share of the values from 0 to 1.
const BELOW_KNEE: f64 = 0.95;

/// Conversions, and the largest difference of colours.
pub(super) struct Colours {
    /// Linear value, 0 to 1, of each sRGB code.
    linear: [f64; 256],
    to_xyz: DMat3,
    to_rgb: DMat3,
    /// Largest difference of two colours, with its exponent.
    largest: f64,
}

impl Colours {
    pub(super) fn new() -> Self {
        let rows = SHARES.map(|row| DVec3::from_array(row) / row.iter().sum::<f64>());
        let to_xyz = DMat3::from_cols(rows[0], rows[1], rows[2]).transpose();
        let linear = std::array::from_fn(|code| {
            let v = code as f64 / 255.0;
            if v <= 0.040_45 { v / 12.92 } else { ((v + 0.055) / 1.055).powf(2.4) }
        });
        let mut colours = Self { linear, to_xyz, to_rgb: to_xyz.inverse(), largest: 1.0 };
        let [green, blue] = [DVec3::Y, DVec3::Z].map(|primary| colours.appearance(primary));
        colours.largest = f64::from((distance(green, blue) as f32).powf(DIFFERENCE_EXPONENT));
        colours
    }

    /// Brightness (0 to 1), red against green and blue against yellow. YCxCz without its factors and its offset: they are undone after
    /// the filters, which are linear, so they change nothing.
    pub(super) fn channels(&self, pixel: Rgb<u8>) -> [f64; 3] {
        let xyz = self.to_xyz * DVec3::from_array(pixel.0.map(|code| self.linear[usize::from(code)]));
        [xyz.y, xyz.x - xyz.y, xyz.y - xyz.z]
    }

    /// What filtered channels look like: L*a*b* with paler colours in the dark.
    pub(super) fn seen(&self, [brightness, red_green, blue_yellow]: [f64; 3]) -> DVec3 {
        let xyz = DVec3::new(brightness + red_green, brightness, brightness - blue_yellow);
        // Filtered channels may be what no monitor shows.
        self.appearance((self.to_rgb * xyz).clamp(DVec3::ZERO, DVec3::ONE))
    }

    /// Hunt-adjusted L*a*b* of a linear colour: L* from 0 to 100, and a* and b* times L* / 100.
    fn appearance(&self, linear: DVec3) -> DVec3 {
        let [x, y, z] = (self.to_xyz * linear).to_array().map(compressed);
        let lightness = 116.0 * y - 16.0;
        DVec3::new(lightness, 0.01 * lightness * 500.0 * (x - y), 0.01 * lightness * 200.0 * (y - z))
    }

    /// How different two appearances are, 0 to 1.
    pub(super) fn difference(&self, a: DVec3, b: DVec3) -> f64 {
        // At most 1, but for roundings.
        let share = (f64::from((distance(a, b) as f32).powf(DIFFERENCE_EXPONENT)) / self.largest).min(1.0);
        if share < KNEE { share * (BELOW_KNEE / KNEE) } else { BELOW_KNEE + (share - KNEE) / (1.0 - KNEE) * (1.0 - BELOW_KNEE) }
    }
}

/// HyAB: lightness apart from colour, since large differences of the two do not blend as lengths do.
fn distance(a: DVec3, b: DVec3) -> f64 {
    let d = a - b;
    d.x.abs() + (d.y * d.y + d.z * d.z).sqrt()
}

/// The curve of CIE L*a*b*: a cube root, straight near 0.
fn compressed(v: f64) -> f64 {
    const END: f64 = 6.0 / 29.0;
    if v <= END * END * END {
        return v / (3.0 * END * END) + 4.0 / 29.0;
    }
    cube_root(v)
}

/// Cube root of a positive number, to 1e-12 of it: a guess that is right to 5 %, and two of Halley's steps, each of which leaves two
/// thirds of the error's cube. A few times as fast as `f64::cbrt`.
fn cube_root(v: f64) -> f64 {
    // A third of the exponent, and of the mantissa with it. What is added makes up for the bias that is lost, and evens out the error.
    let guess = f64::from_bits(v.to_bits() / 3 + 0x2A9F_7893_0000_0000);
    let step = |root: f64| {
        let cube = root * root * root;
        root * ((cube + 2.0 * v) / (2.0 * cube + v))
    };
    step(step(guess))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn white_is_white_and_black_is_black() {
        let colours = Colours::new();
        let seen = |code| colours.seen(colours.channels(Rgb([code; 3])));
        assert!((seen(255) - DVec3::new(100.0, 0.0, 0.0)).length() < 1e-10 && seen(0).length() < 1e-10);
        assert!((seen(119).x - 50.0).abs() < 0.1); // L* of #777777 is 50.03
    }

    #[test]
    fn cube_roots_are_cube_roots() {
        for v in (1..=300_000).flat_map(|k| [-300, -3, 0, 300].map(|exponent| f64::from(k) * 1e-5 * 10f64.powi(exponent))) {
            assert!((cube_root(v) / v.cbrt() - 1.0).abs() < 1e-12, "{v}");
        }
    }

    #[test]
    fn no_colours_differ_more_than_green_and_blue() {
        let colours = Colours::new();
        let pixel = |k: u32| Rgb([k % 5, k / 5 % 5, k / 25].map(|step| (64 * step).min(255) as u8));
        let all: Vec<DVec3> = (0..125).map(|k| colours.seen(colours.channels(pixel(k)))).collect();
        let most = distance(colours.appearance(DVec3::Y), colours.appearance(DVec3::Z));
        assert!(all.iter().all(|&a| all.iter().all(|&b| distance(a, b) < most + 1e-9)));
        assert_eq!(colours.difference(colours.appearance(DVec3::Y), colours.appearance(DVec3::Z)), 1.0);
    }
}
