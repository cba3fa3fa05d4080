//! Microfacets: the distribution of Trowbridge and Reitz (GGX) with Smith's shadowing (Walter et al. 2007, Heitz 2014). The surface's normal is (0, 0, 1) here.

use glam::DVec3;
use std::f64::consts::{PI, TAU};

/// The narrowest distribution: narrower ones are mirrors in all but name.
const LEAST_ALPHA: f64 = 1e-4;

/// Microfacets of width alpha, above 0 and at most 1.
#[derive(Clone, Copy, Debug)]
pub struct Facets {
    alpha: f64,
}

impl Facets {
    /// Those of a roughness: its square is alpha.
    pub fn of_roughness(roughness: f64) -> Self {
        Self { alpha: (roughness * roughness).max(LEAST_ALPHA) }
    }

    /// Density of facets whose normal has this cosine to the surface's.
    pub fn density(self, cosine: f64) -> f64 {
        let a2 = self.alpha * self.alpha;
        let d = cosine * cosine * (a2 - 1.0) + 1.0;
        a2 / (PI * d * d)
    }

    /// Smith's Lambda for a direction of this cosine, on either side.
    pub fn lambda(self, cosine: f64) -> f64 {
        let c2 = (cosine * cosine).min(1.0);
        if c2 == 0.0 { f64::INFINITY } else { 0.5 * ((1.0 + self.alpha * self.alpha * (1.0 - c2) / c2).sqrt() - 1.0) }
    }

    /// Share of the facets that nothing hides from a direction.
    pub fn seen_share(self, cosine: f64) -> f64 {
        1.0 / (1.0 + self.lambda(cosine))
    }

    /// Share that is seen from two directions on the same side; heights correlated, so more than the product of both.
    pub fn seen_from_both(self, a: f64, b: f64) -> f64 {
        1.0 / (1.0 + self.lambda(a) + self.lambda(b))
    }

    /// A facet's normal as often as it is seen from `view` (Heitz 2018), by two numbers from 0 to 1.
    pub fn seen_facet(self, view: DVec3, [u, v]: [f64; 2]) -> DVec3 {
        let alpha = self.alpha;
        let stretched = DVec3::new(alpha * view.x, alpha * view.y, view.z).normalize();
        let across = stretched.x * stretched.x + stretched.y * stretched.y;
        let t1 = if across > 0.0 { DVec3::new(-stretched.y, stretched.x, 0.0) / across.sqrt() } else { DVec3::X };
        let t2 = stretched.cross(t1);
        let (r, angle) = (u.sqrt(), TAU * v);
        let (p1, s) = (r * angle.cos(), 0.5 * (1.0 + stretched.z));
        let p2 = (1.0 - s) * (1.0 - p1 * p1).max(0.0).sqrt() + s * r * angle.sin();
        let h = t1 * p1 + t2 * p2 + stretched * (1.0 - p1 * p1 - p2 * p2).max(0.0).sqrt();
        DVec3::new(alpha * h.x, alpha * h.y, h.z.max(0.0)).normalize()
    }

    /// Likelihood of such a facet, per solid angle of its normal `h`.
    pub fn seen_facet_pdf(self, view: DVec3, h: DVec3) -> f64 {
        self.seen_share(view.z) * self.density(h.z) * view.dot(h).max(0.0) / view.z
    }
}

/// Schlick's reflectance of what reflects `f0` straight on.
pub fn schlick(f0: DVec3, cosine: f64) -> DVec3 {
    f0 + (DVec3::ONE - f0) * flat(cosine)
}

/// What Schlick adds where light comes in flat: of 1 - f0.
pub fn flat(cosine: f64) -> f64 {
    (1.0 - cosine.clamp(0.0, 1.0)).powi(5)
}

/// Fresnel's reflectance of a boundary behind which the index of refraction is `eta` times as large; 1 where all is reflected.
pub fn fresnel(cosine: f64, eta: f64) -> f64 {
    let c = cosine.abs().min(1.0);
    let g2 = eta * eta - 1.0 + c * c;
    if g2 <= 0.0 {
        return 1.0;
    }
    let g = g2.sqrt();
    let (less, more) = (g - c, g + c);
    let [polarised, other] = [less / more, (c * more - 1.0) / (c * less + 1.0)];
    0.5 * polarised * polarised * (1.0 + other * other)
}

/// Where `view` goes on behind a facet of normal `h` on its side (Snell's law); nowhere if all is reflected.
pub fn refracted(view: DVec3, h: DVec3, eta: f64) -> Option<DVec3> {
    let c = view.dot(h);
    let s2 = (1.0 - c * c) / (eta * eta);
    (s2 < 1.0).then(|| h * (c / eta - (1.0 - s2).sqrt()) - view / eta)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn fresnel_by_hand_and_snell() {
        // ((n - 1) / (n + 1))^2 straight on; all beyond the critical angle of 41.8 degrees; 1 when flat.
        assert!((fresnel(1.0, 1.5) - 0.04).abs() < 1e-12 && (fresnel(1.0, 1.0 / 1.5) - 0.04).abs() < 1e-12);
        assert_eq!((fresnel(0.7, 1.0 / 1.5), fresnel(0.0, 1.5)), (1.0, 1.0));
        // At Brewster's angle half of what is reflected of the other polarisation is missing: 0.5 ((n^2 - 1) / (n^2 + 1))^2.
        let brewster = 1.5f64.atan().cos();
        assert!((fresnel(brewster, 1.5) - 0.5 * (1.25f64 / 3.25).powi(2)).abs() < 1e-12);
        let view = DVec3::new(0.6, 0.0, 0.8);
        let down = refracted(view, DVec3::Z, 1.5).unwrap();
        assert!((down - DVec3::new(-0.4, 0.0, -(1.0f64 - 0.16).sqrt())).length() < 1e-12);
        // The same both ways: the reflectance of a boundary is that of its other side.
        assert!((fresnel(0.8, 1.5) - fresnel(down.z, 1.0 / 1.5)).abs() < 1e-12);
        assert!((refracted(down, DVec3::NEG_Z, 1.0 / 1.5).unwrap() - view).length() < 1e-12);
        assert!(refracted(view, DVec3::Z, 0.5).is_none());
    }

    #[test]
    fn facets_that_are_seen_fill_what_is_seen() {
        // The facets' projected area along the normal is 1, and so is the likelihood of all that are seen.
        for roughness in [0.3, 0.6, 1.0] {
            let facets = Facets::of_roughness(roughness);
            for z in [0.1f64, 0.5, 1.0] {
                let view = DVec3::new((1.0 - z * z).sqrt(), 0.0, z);
                let (mut area, mut seen) = (0.0, 0.0);
                let n = 400;
                for i in 0..n {
                    for j in 0..n {
                        // Normals as dense as their cosine, in tangents so that narrow distributions are met too.
                        let tan2 = facets.alpha * facets.alpha * (f64::from(i) + 0.5) / (f64::from(n) - f64::from(i) - 0.5);
                        let cosine = 1.0 / (1.0 + tan2).sqrt();
                        let angle = TAU * (f64::from(j) + 0.5) / f64::from(n);
                        let sine = (1.0 - cosine * cosine).sqrt();
                        let h = DVec3::new(sine * angle.cos(), sine * angle.sin(), cosine);
                        // Likelihood of h under this choice is density(h) times its cosine.
                        let weight = 1.0 / (facets.density(cosine) * cosine) / f64::from(n * n);
                        area += facets.density(cosine) * cosine * weight;
                        seen += facets.seen_facet_pdf(view, h) * weight;
                    }
                }
                assert!((area - 1.0).abs() < 1e-9 && (seen - 1.0).abs() < 0.02, "{roughness} {z}: {area} {seen}");
            }
        }
    }
}
