//! How much of the light that comes in at an angle microfacets send on at once. What is missing went from facet to facet: it is given back evenly (Kulla and Conty 2017).

use super::facets::{Facets, flat, fresnel, refracted};
use glam::DVec3;

/// Cosines that a curve has values at: their square roots are evenly spaced, as most happens where light comes in flat.
const NODES: usize = 48;
/// Facets of a value.
const FACETS: u32 = 4096;

/// Something that depends on a cosine from 0 to 1.
#[derive(Clone, Debug)]
pub struct Curve {
    values: Vec<f64>,
}

impl Curve {
    fn of(value: impl Fn(f64) -> f64) -> Self {
        let root = |k: usize| k as f64 / (NODES - 1) as f64;
        Self { values: (0..NODES).map(|k| value((root(k) * root(k)).max(1e-6))).collect() }
    }

    /// Its value, between two nodes a straight line in the root of the cosine.
    pub fn at(&self, cosine: f64) -> f64 {
        let place = cosine.clamp(0.0, 1.0).sqrt() * (NODES - 1) as f64;
        let k = (place as usize).min(NODES - 2); // at most NODES - 1
        self.values[k] + (self.values[k + 1] - self.values[k]) * (place - k as f64)
    }

    /// The mean over a hemisphere of light from everywhere: of 2 cosine d(cosine). Exact for the curve as it is interpolated (Gauss, three points, in the root).
    pub fn mean(&self) -> f64 {
        let points = [(-(0.6f64.sqrt()), 5.0 / 18.0), (0.0, 4.0 / 9.0), (0.6f64.sqrt(), 5.0 / 18.0)];
        let width = 1.0 / (NODES - 1) as f64;
        let pieces = (0..NODES - 1).flat_map(|k| points.map(|(x, weight)| (width * (k as f64 + 0.5 + 0.5 * x), weight * width)));
        pieces.map(|(root, weight)| weight * 4.0 * root.powi(3) * self.at(root * root)).sum()
    }
}

/// Two numbers from 0 to 1, all of them spread evenly (Hammersley).
fn spread(k: u32) -> [f64; 2] {
    [(f64::from(k) + 0.5) / f64::from(FACETS), f64::from(k.reverse_bits()) / 4_294_967_296.0]
}

/// The mean of `value` over the facets that are seen at a cosine: it takes the direction and a facet.
fn over_facets(facets: Facets, cosine: f64, value: impl Fn(DVec3, DVec3) -> f64) -> f64 {
    let view = DVec3::new((1.0 - cosine * cosine).max(0.0).sqrt(), 0.0, cosine);
    (0..FACETS).map(|k| value(view, facets.seen_facet(view, spread(k)))).sum::<f64>() / f64::from(FACETS)
}

/// What a facet mirrors, if none of it meets another facet.
fn mirrored(facets: Facets, view: DVec3, h: DVec3) -> f64 {
    let light = h * (2.0 * view.dot(h)) - view;
    if light.z > 0.0 { facets.seen_from_both(view.z, light.z) / facets.seen_share(view.z) } else { 0.0 }
}

/// Of facets that mirror.
#[derive(Clone, Debug)]
pub struct Mirrored {
    /// All of what is sent on at once, if facets reflect everything.
    pub all: Curve,
    /// The part that Schlick's rule adds, of 1 - f0.
    pub flat: Curve,
}

impl Mirrored {
    /// By quadrature.
    pub fn of(facets: Facets) -> Self {
        Self {
            all: Curve::of(|cosine| over_facets(facets, cosine, |view, h| mirrored(facets, view, h))),
            flat: Curve::of(|cosine| over_facets(facets, cosine, |view, h| mirrored(facets, view, h) * flat(view.dot(h)))),
        }
    }
}

/// Of facets that reflect or refract, behind which the index of refraction is `eta` times as large: energy, not radiance.
pub fn refracting(facets: Facets, eta: f64) -> Curve {
    Curve::of(|cosine| {
        over_facets(facets, cosine, |view, h| {
            let reflectance = fresnel(view.dot(h), eta);
            let through = refracted(view, h, eta).filter(|light| light.z < 0.0).map_or(0.0, |light| facets.seen_share(light.z));
            reflectance * mirrored(facets, view, h) + (1.0 - reflectance) * through
        })
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn means_of_curves_by_hand() {
        assert!((Curve::of(|_| 1.0).mean() - 1.0).abs() < 1e-12);
        // 2/5 of what is the root: 4 t^4 from 0 to 1 is 4/5.
        assert!((Curve::of(f64::sqrt).mean() - 0.8).abs() < 1e-4);
        assert!((Curve::of(|c| c).at(0.37) - 0.37).abs() < 1e-3);
    }

    #[test]
    fn rough_facets_lose_what_is_known() {
        // Straight on, alpha 1, of what reflects everything: the integral over all facets with heights correlated, by another quadrature.
        let facets = Facets::of_roughness(1.0);
        let n = 2_000;
        let sum: f64 = (0..n)
            .map(|k| {
                // h.z from 0 to 1; light at twice the angle; d(l) = 4 h.z d(h).
                let z = (f64::from(k) + 0.5) / f64::from(n);
                let light = 2.0 * z * z - 1.0;
                if light <= 0.0 {
                    return 0.0;
                }
                let value = facets.density(z) * facets.seen_from_both(1.0, light) / 4.0;
                std::f64::consts::TAU * value * 4.0 * z / f64::from(n)
            })
            .sum();
        assert!((Mirrored::of(facets).all.at(1.0) - sum).abs() < 2e-3, "{sum}");
        assert!(Mirrored::of(Facets::of_roughness(0.1)).all.at(0.8) > 0.999);
    }
}
