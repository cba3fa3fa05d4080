//! Errors of one hit against exact arithmetic: rounding of t and barycentrics in units in the last place, displacement in pixels.

use super::dyadic::Dyadic;
use super::model::Model;
use super::rays::PIXEL;
use crate::golden::Fractions;
use crate::method::Hit;
use crate::rays::{ModelRay, Query};
use num_bigint::BigInt;
use num_traits::ToPrimitive;

/// Distance of `rounded` from numerator 2^bits / denominator, in steps.
fn steps_off(rounded: u64, numerator: i128, bits: u32, denominator: i128) -> f64 {
    let exact: BigInt = BigInt::from(numerator) << bits;
    let off = exact - BigInt::from(rounded) * denominator;
    let off = off.magnitude();
    // Both to their leading 64 bits and more: relative error below 2^-60.
    off.to_f64().unwrap_or(f64::INFINITY) / (denominator as f64)
}

/// Error of the hit's t in steps of 2^-32: below 1 if it was rounded down once.
pub fn t_error(hit: &Hit, exact: &Fractions) -> f64 {
    steps_off(hit.t.get(), exact.t_num, 32, exact.det)
}

/// Worst error of the hit's three weights in steps of 2^-31: below 1 for two of them, below 2 for what is left to the first.
pub fn bary_error(hit: &Hit, exact: &Fractions) -> f64 {
    let weights = [hit.b0, hit.b1, hit.b2];
    (0..3).map(|k| steps_off(weights[k].get(), exact.weights[k], 31, exact.det)).fold(0.0, f64::max)
}

/// Hits nearer to the eye than so many units have no displacement in pixels: 2e-6 half widths of the model.
pub const NEAREST: f64 = 4096.0;

/// How far rounding moved the hit of a camera's ray, in pixels of a picture of 1024 rows at its distance: the distance of the hit from the ray as it was in the world (its
/// origin, direction and t were rounded), and of the hit's place on the full-resolution surface from where it was before rounding to units.
///
/// The first is computed without rounding from the `f64` numbers of ray and model. `None` for hits within
/// [`NEAREST`] units of the eye: a pixel's size goes to 0 there.
pub fn pixels_off(model: &Model, world: &Query, ray: &ModelRay, hit: &Hit) -> Option<f64> {
    let placement = model.space.placement;
    let (x, d) = (ray.ray.origin.get(), ray.ray.direction.get());
    // From the eye to the hit: scale (x + d t / 2^32) + offset - origin.
    let to_hit: [Dyadic; 3] = std::array::from_fn(|k| {
        let at = Dyadic::new((BigInt::from(x[k]) << 32) + BigInt::from(d[k]) * hit.t.get(), -32);
        let at = &(&Dyadic::of(placement.scale) * &at) + &Dyadic::of(placement.offset[k]);
        &at - &Dyadic::of(world.origin[k])
    });
    let w = world.direction.map(Dyadic::of);
    let cross: [f64; 3] = std::array::from_fn(|k| {
        let (i, j) = ((k + 1) % 3, (k + 2) % 3);
        (&(&to_hit[i] * &w[j]) - &(&to_hit[j] * &w[i])).to_f64()
    });
    let distance = length(to_hit.map(|v| v.to_f64()));
    let beside = length(cross) / length(world.direction);
    let full = [hit.full_b0, hit.full_b1, hit.full_b2].map(|b| b.get() as u32); // at most 2^31
    let moved = model.moved(hit.tree.get() as u32, hit.full_node.get() as u32, full); // 28 and 20 bits
    let pixel = 2.0 * PIXEL * distance;
    (distance >= NEAREST * placement.scale).then(|| (beside + moved) / pixel)
}

/// Scaled first, so that squares stay within the range of `f64`.
fn length(v: [f64; 3]) -> f64 {
    let most = v.iter().fold(0.0f64, |m, c| m.max(c.abs()));
    if most > 0.0 { most * v.iter().map(|c| (c / most).powi(2)).sum::<f64>().sqrt() } else { 0.0 }
}
