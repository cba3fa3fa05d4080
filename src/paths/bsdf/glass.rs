//! Clear bodies: smooth, or with facets that reflect and refract (Walter et al. 2007).
//!
//! Radiance that goes into a denser body grows by the square of the index. Light that facets send to others comes out evenly on both sides, in the shares that
//! make both ways alike (Kulla and Conty 2017): nothing is swallowed.

use super::albedo::{Curve, refracting};
use super::facets::{Facets, fresnel, refracted};
use super::lobe::{Lobe, Local};
use crate::num::Random;
use crate::paths::random::{cosine_direction, cosine_pdf, share};
use glam::DVec3;
use std::f64::consts::PI;

#[derive(Clone, Debug)]
pub struct Glass {
    /// Index of refraction of the body, the air's being 1.
    index: f64,
    /// Its facets, and what they send on at once from outside and from inside; none if it is smooth.
    rough: Option<(Facets, [Side; 2])>,
}

/// One side of rough glass.
#[derive(Clone, Debug)]
struct Side {
    /// Light that facets send on at once.
    at_once: Curve,
    /// 1 less its mean.
    lost: f64,
    /// Share of the rest that stays on this side.
    stays: f64,
}

impl Side {
    fn rest(&self, cosine: f64) -> f64 {
        1.0 - self.at_once.at(cosine)
    }

    /// As likely as what light from everywhere loses here, by its cosine.
    fn even(&self, cosine: f64) -> f64 {
        if self.lost > 1e-9 { self.rest(cosine) * cosine / (PI * self.lost) } else { cosine / PI }
    }
}

impl Glass {
    pub fn new(index: f64, roughness: f64) -> Self {
        let rough = (roughness > 0.0).then(|| {
            let facets = Facets::of_roughness(roughness);
            let curves = [refracting(facets, index), refracting(facets, 1.0 / index)];
            let lost = curves.each_ref().map(|curve| 1.0 - curve.mean());
            let [outside, inside] = [lost[0], lost[1] * index * index];
            // What goes through is the same both ways if (1 - stays) outside is (1 - stays) inside, each with its square of the index.
            let through = if outside + inside > 0.0 { [inside / (outside + inside), outside / (outside + inside)] } else { [0.5; 2] };
            let [a, b] = curves;
            let side = |at_once, k: usize| Side { at_once, lost: lost[k], stays: 1.0 - through[k] };
            (facets, [side(a, 0), side(b, 1)])
        });
        Self { index, rough }
    }

    /// How many times as large the index is behind the surface.
    fn eta(&self, front: bool) -> f64 {
        if front { self.index } else { 1.0 / self.index }
    }

    /// Value times cosine, and likelihood; the normal is (0, 0, 1) on the side of `view`, which is outside if it is of a front face. Nothing of smooth glass.
    pub fn eval(&self, front: bool, view: DVec3, light: DVec3) -> (DVec3, f64) {
        let Some((facets, sides)) = self.rough.as_ref().filter(|_| view.z > 0.0 && light.z != 0.0) else { return (DVec3::ZERO, 0.0) };
        let [own, other] = if front { [&sides[0], &sides[1]] } else { [&sides[1], &sides[0]] };
        let (eta, rest, cosine) = (self.eta(front), own.rest(view.z), light.z.abs());
        let (value, by_facets, stays) = if light.z > 0.0 {
            let h = (view + light).normalize();
            let reflectance = fresnel(view.dot(h), eta);
            let at_once = reflectance * facets.density(h.z) * facets.seen_from_both(view.z, light.z) / (4.0 * view.z);
            let by_facets = reflectance * facets.seen_facet_pdf(view, h) / (4.0 * view.dot(h));
            (at_once + rest * own.stays * own.even(cosine), by_facets, own.stays)
        } else {
            let towards = view + light * eta;
            let h = towards.normalize_or_zero() * towards.z.signum();
            let (cv, cl) = (view.dot(h), light.dot(h));
            let spread = (cv + eta * cl) * (cv + eta * cl);
            let (mut at_once, mut by_facets) = (0.0, 0.0);
            if cv > 0.0 && cl < 0.0 && spread > 0.0 {
                let passes = 1.0 - fresnel(cv, eta);
                let seen = facets.seen_share(view.z) * facets.seen_share(light.z);
                at_once = passes * facets.density(h.z) * seen * cv * -cl / (view.z * spread);
                by_facets = passes * facets.seen_facet_pdf(view, h) * eta * eta * -cl / spread;
            }
            let stays = 1.0 - own.stays;
            (at_once + rest * stays * other.even(cosine) / (eta * eta), by_facets, stays)
        };
        (DVec3::splat(value), (1.0 - rest) * by_facets + rest * stays * cosine_pdf(cosine))
    }

    pub fn sample(&self, front: bool, view: DVec3, random: &mut Random) -> Option<Local> {
        if view.z <= 0.0 {
            return None;
        }
        let eta = self.eta(front);
        let Some((facets, sides)) = &self.rough else {
            let mirrored = DVec3::new(-view.x, -view.y, view.z);
            if share(random) < fresnel(view.z, eta) {
                return Some(Local { light: mirrored, weight: DVec3::ONE, pdf: None, lobe: Lobe::Mirror });
            }
            let light = refracted(view, DVec3::Z, eta)?;
            return Some(Local { light, weight: DVec3::splat(1.0 / (eta * eta)), pdf: None, lobe: Lobe::Through { eta } });
        };
        let own = &sides[usize::from(!front)];
        let (light, lobe) = if share(random) < own.rest(view.z) {
            let light = cosine_direction(DVec3::Z, random);
            (if share(random) < own.stays { light } else { -light }, Lobe::Diffuse)
        } else {
            let h = facets.seen_facet(view, [share(random), share(random)]);
            if share(random) < fresnel(view.dot(h), eta) {
                let light = h * (2.0 * view.dot(h)) - view;
                (Some(light).filter(|light| light.z > 0.0)?, Lobe::Glossy)
            } else {
                (refracted(view, h, eta).filter(|light| light.z < 0.0)?, Lobe::Through { eta })
            }
        };
        let (value, pdf) = self.eval(front, view, light);
        (pdf > 0.0).then(|| Local { light, weight: value / pdf, pdf: Some(pdf), lobe })
    }
}
