//! Facets that mirror, over a body that scatters evenly.
//!
//! Light that a facet sends to another one comes back evenly, coloured by the mean of its reflections (Kulla and Conty 2017). What the facets do not reflect goes into the body, whose
//! part depends alike on both directions, so that it is the same both ways (Kelemen and Szirmay-Kalos 2001). Reflectance 1, or an albedo of 1, gives all light back.

use super::albedo::Mirrored;
use super::facets::{Facets, schlick};
use super::lobe::{Lobe, Local};
use crate::num::Random;
use crate::paths::random::{cosine_direction, cosine_pdf, share};
use glam::DVec3;
use std::f64::consts::PI;

#[derive(Clone, Debug)]
pub struct Gloss {
    f0: DVec3,
    albedo: DVec3,
    facets: Facets,
    curves: Mirrored,
    /// 1 less the mean of what comes back at once.
    lost: f64,
    /// Colour of what comes back later.
    later: DVec3,
    /// 1 less the mean of all that facets reflect.
    left: DVec3,
}

impl Gloss {
    pub fn new(f0: DVec3, albedo: DVec3, roughness: f64) -> Self {
        let facets = Facets::of_roughness(roughness);
        let curves = Mirrored::of(facets);
        let (all, flat) = (curves.all.mean(), curves.flat.mean());
        // The mean of Schlick's reflectance over all directions.
        let mean = f0 + (DVec3::ONE - f0) / 21.0;
        let later = mean * mean * all / (DVec3::ONE - mean * (1.0 - all));
        let left = DVec3::ONE - (f0 * (all - flat) + flat + later * (1.0 - all));
        Self { f0, albedo, facets, curves, lost: 1.0 - all, later, left }
    }

    /// Light that facets send on at once.
    fn at_once(&self, cosine: f64) -> DVec3 {
        let (all, flat) = (self.curves.all.at(cosine), self.curves.flat.at(cosine));
        self.f0 * (all - flat) + flat
    }

    /// What facets do not reflect at all.
    fn body(&self, cosine: f64) -> DVec3 {
        (DVec3::ONE - self.at_once(cosine) - self.later * (1.0 - self.curves.all.at(cosine))).max(DVec3::ZERO)
    }

    /// What comes back evenly, as a value times the cosine of `light`.
    fn evenly(&self, view: f64, light: f64) -> DVec3 {
        let lost = |cosine: f64| 1.0 - self.curves.all.at(cosine);
        let later = if self.lost > 1e-9 { self.later * (lost(view) * lost(light) / self.lost) } else { DVec3::ZERO };
        let body = self.albedo * self.body(view) * self.body(light) / self.left.max(DVec3::splat(1e-9));
        (later + body) * (light / PI)
    }

    /// How often a facet is sampled.
    fn share(&self, cosine: f64) -> f64 {
        let (at_once, all) = (self.at_once(cosine), self.curves.all.at(cosine));
        let evenly = self.later * (1.0 - all) + self.albedo * self.body(cosine);
        let (facet, even) = (at_once.max_element(), evenly.max_element());
        if facet + even > 0.0 { facet / (facet + even) } else { 1.0 }
    }

    /// Value times cosine, and likelihood; the normal is (0, 0, 1).
    pub fn eval(&self, view: DVec3, light: DVec3) -> (DVec3, f64) {
        if view.z <= 0.0 || light.z <= 0.0 {
            return (DVec3::ZERO, 0.0);
        }
        let h = (view + light).normalize();
        let at_once =
            schlick(self.f0, view.dot(h)) * (self.facets.density(h.z) * self.facets.seen_from_both(view.z, light.z) / (4.0 * view.z));
        let by_facets = self.facets.seen_facet_pdf(view, h) / (4.0 * view.dot(h));
        let share = self.share(view.z);
        (at_once + self.evenly(view.z, light.z), share * by_facets + (1.0 - share) * cosine_pdf(light.z))
    }

    pub fn sample(&self, view: DVec3, random: &mut Random) -> Option<Local> {
        if view.z <= 0.0 {
            return None;
        }
        let (light, lobe) = if share(random) < self.share(view.z) {
            let h = self.facets.seen_facet(view, [share(random), share(random)]);
            (h * (2.0 * view.dot(h)) - view, Lobe::Glossy)
        } else {
            (cosine_direction(DVec3::Z, random), Lobe::Diffuse)
        };
        let (value, pdf) = self.eval(view, light);
        (pdf > 0.0).then(|| Local { light, weight: value / pdf, pdf: Some(pdf), lobe })
    }
}
