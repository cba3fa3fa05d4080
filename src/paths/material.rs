//! What surfaces do to light.

use super::random::{basis, cosine_direction, cosine_pdf, share};
use crate::num::Random;
use glam::DVec3;
use serde::Deserialize;
use std::f64::consts::{PI, TAU};

/// A surface's material; colours are linear, 0 to 1 each.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize)]
#[serde(tag = "kind", rename_all = "lowercase", deny_unknown_fields)]
pub enum Material {
    /// Lambert's: light comes back evenly.
    Diffuse {
        /// Share of the light that comes back; the scene's own colours if none.
        albedo: Option<[f64; 3]>,
    },
    /// Microfacets: the distribution of Trowbridge and Reitz (GGX), Smith's shadowing, Schlick's reflectance (Walter et al. 2007, Heitz 2014); what is not reflected comes back evenly
    /// by `albedo`.
    Glossy {
        /// Share that is reflected straight on.
        reflectance: [f64; 3],
        /// Above 0, at most 1; its square is the width alpha of the distribution.
        roughness: f64,
        /// Share of the rest that comes back evenly.
        #[serde(default)]
        albedo: [f64; 3],
    },
    /// A perfect mirror.
    Mirror {
        /// Share that is reflected, straight on; more of it flat (Schlick).
        reflectance: [f64; 3],
    },
}

/// Which way light is scattered.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Lobe {
    /// Evenly.
    Diffuse,
    /// About the mirror's direction.
    Glossy,
    /// In the mirror's direction alone.
    Mirror,
}

/// A scattered ray.
#[derive(Clone, Copy, Debug)]
pub(super) struct Scatter {
    pub direction: DVec3,
    /// What light from there counts: value times cosine by likelihood.
    pub weight: DVec3,
    /// Likelihood per solid angle; none of a mirror, whose direction is the only one.
    pub pdf: Option<f64>,
    pub lobe: Lobe,
}

/// Schlick's reflectance.
fn schlick(f0: DVec3, cosine: f64) -> DVec3 {
    f0 + (DVec3::ONE - f0) * (1.0 - cosine.clamp(0.0, 1.0)).powi(5)
}

/// Smith's Lambda of the distribution of width `alpha`.
fn lambda(alpha: f64, cosine: f64) -> f64 {
    let c2 = (cosine * cosine).min(1.0);
    if c2 == 0.0 { f64::INFINITY } else { 0.5 * ((1.0 + alpha * alpha * (1.0 - c2) / c2).sqrt() - 1.0) }
}

/// Density of microfacets whose normal has this cosine to the surface's.
fn facets(alpha: f64, cosine: f64) -> f64 {
    let a2 = alpha * alpha;
    let d = cosine * cosine * (a2 - 1.0) + 1.0;
    a2 / (PI * d * d)
}

/// A microfacet's normal as often as it is seen from `view` (Heitz 2018), the surface's normal being `n`.
fn seen_facet(n: DVec3, view: DVec3, alpha: f64, random: &mut Random) -> DVec3 {
    let [x, y] = basis(n);
    let stretched = DVec3::new(alpha * view.dot(x), alpha * view.dot(y), view.dot(n)).normalize();
    let across = stretched.x * stretched.x + stretched.y * stretched.y;
    let t1 = if across > 0.0 { DVec3::new(-stretched.y, stretched.x, 0.0) / across.sqrt() } else { DVec3::X };
    let t2 = stretched.cross(t1);
    let (r, angle) = (share(random).sqrt(), TAU * share(random));
    let (p1, s) = (r * angle.cos(), 0.5 * (1.0 + stretched.z));
    let p2 = (1.0 - s) * (1.0 - p1 * p1).max(0.0).sqrt() + s * r * angle.sin();
    let h = t1 * p1 + t2 * p2 + stretched * (1.0 - p1 * p1 - p2 * p2).max(0.0).sqrt();
    (x * (alpha * h.x) + y * (alpha * h.y) + n * h.z.max(0.0)).normalize()
}

/// The glossy part, of which nothing is known but its numbers.
struct Gloss {
    f0: DVec3,
    albedo: DVec3,
    alpha: f64,
}

impl Gloss {
    /// How often the glossy part is sampled, seen at this cosine.
    fn share(&self, cosine: f64) -> f64 {
        let (glossy, even) = (schlick(self.f0, cosine).max_element(), self.albedo.max_element() * (1.0 - self.f0.max_element()));
        if glossy + even > 0.0 { glossy / (glossy + even) } else { 1.0 }
    }

    fn eval(&self, n: DVec3, view: DVec3, light: DVec3) -> (DVec3, f64) {
        let (cv, cl) = (n.dot(view), n.dot(light));
        if cv <= 0.0 || cl <= 0.0 {
            return (DVec3::ZERO, 0.0);
        }
        let h = (view + light).normalize();
        let (d, lv, ll) = (facets(self.alpha, n.dot(h)), lambda(self.alpha, cv), lambda(self.alpha, cl));
        let f = schlick(self.f0, view.dot(h));
        let glossy = f * (d / (1.0 + lv + ll) / (4.0 * cv));
        let even = self.albedo * (DVec3::ONE - schlick(self.f0, cv)) * (cl / PI);
        let by_facets = d / ((1.0 + lv) * 4.0 * cv);
        let share = self.share(cv);
        (glossy + even, share * by_facets + (1.0 - share) * cosine_pdf(cl))
    }
}

impl Material {
    /// What of light from `light` goes to `view`, times the cosine, and how likely [`Self::sample`] finds it; `own` is the scene's colour, `n` on the side of `view`.
    pub(super) fn eval(&self, own: DVec3, n: DVec3, view: DVec3, light: DVec3) -> (DVec3, f64) {
        match *self {
            Self::Diffuse { albedo } => {
                let cosine = n.dot(light).max(0.0);
                (albedo.map_or(own, DVec3::from_array) * (cosine / PI), cosine_pdf(cosine))
            }
            Self::Glossy { .. } => self.gloss().eval(n, view, light),
            Self::Mirror { .. } => (DVec3::ZERO, 0.0),
        }
    }

    /// Scatters a ray that comes from `view`; `None` if it is swallowed.
    pub(super) fn sample(&self, own: DVec3, n: DVec3, view: DVec3, random: &mut Random) -> Option<Scatter> {
        let cosine = n.dot(view);
        match *self {
            Self::Diffuse { albedo } => {
                let direction = cosine_direction(n, random);
                let weight = albedo.map_or(own, DVec3::from_array);
                Some(Scatter { direction, weight, pdf: Some(cosine_pdf(n.dot(direction))), lobe: Lobe::Diffuse })
            }
            Self::Mirror { reflectance } => {
                let direction = n * (2.0 * cosine) - view;
                let weight = schlick(DVec3::from_array(reflectance), cosine);
                (cosine > 0.0).then_some(Scatter { direction, weight, pdf: None, lobe: Lobe::Mirror })
            }
            Self::Glossy { .. } => {
                let gloss = self.gloss();
                if cosine <= 0.0 {
                    return None;
                }
                let (direction, lobe) = if share(random) < gloss.share(cosine) {
                    let h = seen_facet(n, view, gloss.alpha, random);
                    (h * (2.0 * view.dot(h)) - view, Lobe::Glossy)
                } else {
                    (cosine_direction(n, random), Lobe::Diffuse)
                };
                let (value, pdf) = gloss.eval(n, view, direction);
                (pdf > 0.0).then(|| Scatter { direction, weight: value / pdf, pdf: Some(pdf), lobe })
            }
        }
    }

    /// Width alpha of the distribution of microfacets; 0 of a mirror.
    pub(super) fn alpha(&self) -> f64 {
        match *self {
            Self::Glossy { roughness, .. } => roughness * roughness,
            _ => 0.0,
        }
    }

    /// Its numbers, if it is glossy; a mirror has others.
    fn gloss(&self) -> Gloss {
        let Self::Glossy { reflectance, albedo, .. } = *self else { return Gloss { f0: DVec3::ZERO, albedo: DVec3::ZERO, alpha: 1.0 } };
        Gloss { f0: DVec3::from_array(reflectance), albedo: DVec3::from_array(albedo), alpha: self.alpha().max(1e-4) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const GLOSSY: Material = Material::Glossy { reflectance: [0.9, 0.5, 0.04], roughness: 0.6, albedo: [0.0, 0.3, 0.8] };

    fn view(cosine: f64) -> DVec3 {
        DVec3::new((1.0f64 - cosine * cosine).sqrt(), 0.0, cosine)
    }

    /// The mean of what is sampled is the integral over all directions, whichever way it is taken.
    #[test]
    fn samples_have_the_likelihood_that_is_said_and_give_no_light() {
        for material in [GLOSSY, Material::Diffuse { albedo: Some([0.2, 0.5, 1.0]) }] {
            for cosine in [0.2, 0.7, 1.0] {
                let (v, n) = (view(cosine), DVec3::Z);
                let mut random = Random::new(3);
                let count = 200_000;
                let (mut by_samples, mut evenly, mut whole) = (DVec3::ZERO, DVec3::ZERO, 0.0);
                for _ in 0..count {
                    if let Some(scatter) = material.sample(DVec3::ONE, n, v, &mut random).filter(|s| s.direction.z > 0.0) {
                        by_samples += scatter.weight / f64::from(count);
                    }
                    let d = cosine_direction(n, &mut random);
                    let (value, pdf) = material.eval(DVec3::ONE, n, v, d);
                    evenly += value / cosine_pdf(d.z) / f64::from(count);
                    whole += pdf / cosine_pdf(d.z) / f64::from(count);
                }
                assert!((by_samples - evenly).abs().max_element() < 0.02, "{material:?} {cosine}: {by_samples} {evenly}");
                assert!(by_samples.max_element() <= 1.01 && whole <= 1.01, "{material:?} {cosine}: {by_samples} {whole}");
            }
        }
    }

    #[test]
    fn it_is_the_same_both_ways_and_a_mirror_mirrors() {
        let mut random = Random::new(4);
        let even = Material::Glossy { reflectance: [0.9, 0.5, 0.04], roughness: 0.6, albedo: [0.0; 3] };
        for _ in 0..1_000 {
            let (a, b) = (cosine_direction(DVec3::Z, &mut random), cosine_direction(DVec3::Z, &mut random));
            let (ab, ba) = (even.eval(DVec3::ONE, DVec3::Z, a, b).0 / b.z, even.eval(DVec3::ONE, DVec3::Z, b, a).0 / a.z);
            assert!((ab - ba).abs().max_element() <= 1e-9 * ab.max_element(), "{ab} {ba}");
        }
        let mirror = Material::Mirror { reflectance: [0.5; 3] };
        let scatter = mirror.sample(DVec3::ONE, DVec3::Z, view(0.6), &mut random).unwrap();
        assert!((scatter.direction - DVec3::new(-0.8, 0.0, 0.6)).length() < 1e-12 && scatter.pdf.is_none());
        assert!(mirror.sample(DVec3::ONE, DVec3::Z, -view(0.6), &mut random).is_none());
    }
}
