//! What surfaces do to light, from the numbers of a material: how much, and in which directions a path goes on (the field's BSDF).

mod albedo;
mod facets;
mod glass;
mod gloss;
mod lobe;

use super::material::Material;
use super::random::{basis, cosine_direction, cosine_pdf};
use crate::num::Random;
use facets::schlick;
use glam::DVec3;
use glass::Glass;
use gloss::Gloss;
pub(super) use lobe::Lobe;
use lobe::Local;
use std::f64::consts::PI;

/// A scattered ray.
#[derive(Clone, Copy, Debug)]
pub(super) struct Scatter {
    pub direction: DVec3,
    /// What radiance from there counts: value times cosine by likelihood.
    pub weight: DVec3,
    /// Likelihood per solid angle; none where the direction is the only one.
    pub pdf: Option<f64>,
    pub lobe: Lobe,
}

/// A place on a surface.
#[derive(Clone, Copy, Debug)]
pub(super) struct Place {
    /// The scene's own colour.
    pub colour: DVec3,
    /// On the side that is looked at.
    pub normal: DVec3,
    /// That is the front.
    pub front: bool,
}

/// What a material does to light.
#[derive(Clone, Debug)]
pub(super) enum Bsdf {
    Diffuse { albedo: Option<DVec3> },
    Gloss(Box<Gloss>),
    Mirror { f0: DVec3 },
    Glass(Box<Glass>),
}

impl Bsdf {
    /// Of a material; tables of facets are made here.
    pub fn of(material: &Material) -> Self {
        match *material {
            Material::Diffuse { albedo } => Self::Diffuse { albedo: albedo.map(DVec3::from_array) },
            Material::Glossy { reflectance, roughness, albedo } => {
                Self::Gloss(Box::new(Gloss::new(DVec3::from_array(reflectance), DVec3::from_array(albedo), roughness)))
            }
            Material::Mirror { reflectance } => Self::Mirror { f0: DVec3::from_array(reflectance) },
            Material::Glass { index, roughness } => Self::Glass(Box::new(Glass::new(index, roughness))),
        }
    }

    /// Light goes through.
    pub fn is_clear(&self) -> bool {
        matches!(self, Self::Glass(_))
    }

    /// Lights that are asked for light send none, or not all of what there is: what counts is what a scattered ray runs into.
    pub fn must_be_followed(&self) -> bool {
        matches!(self, Self::Mirror { .. } | Self::Glass(_))
    }

    /// What of radiance from `light` goes to `view`, times the cosine, and how likely [`Self::sample`] finds it.
    pub fn eval(&self, at: &Place, view: DVec3, light: DVec3) -> (DVec3, f64) {
        match self {
            Self::Diffuse { albedo } => {
                let cosine = at.normal.dot(light).max(0.0);
                (albedo.unwrap_or(at.colour) * (cosine / PI), cosine_pdf(cosine))
            }
            Self::Gloss(gloss) => {
                let frame = Frame::of(at.normal);
                gloss.eval(frame.local(view), frame.local(light))
            }
            Self::Mirror { .. } => (DVec3::ZERO, 0.0),
            Self::Glass(glass) => {
                let frame = Frame::of(at.normal);
                glass.eval(at.front, frame.local(view), frame.local(light))
            }
        }
    }

    /// Scatters a ray that comes from `view`; `None` if it is swallowed.
    pub fn sample(&self, at: &Place, view: DVec3, random: &mut Random) -> Option<Scatter> {
        let cosine = at.normal.dot(view);
        let local = match self {
            Self::Diffuse { albedo } => {
                let direction = cosine_direction(at.normal, random);
                let weight = albedo.unwrap_or(at.colour);
                return Some(Scatter { direction, weight, pdf: Some(cosine_pdf(at.normal.dot(direction))), lobe: Lobe::Diffuse });
            }
            Self::Mirror { f0 } => {
                let direction = at.normal * (2.0 * cosine) - view;
                let weight = schlick(*f0, cosine);
                return (cosine > 0.0).then_some(Scatter { direction, weight, pdf: None, lobe: Lobe::Mirror });
            }
            Self::Gloss(gloss) => gloss.sample(Frame::of(at.normal).local(view), random),
            Self::Glass(glass) => glass.sample(at.front, Frame::of(at.normal).local(view), random),
        };
        let Local { light, weight, pdf, lobe } = local?;
        Some(Scatter { direction: Frame::of(at.normal).back(light), weight, pdf, lobe })
    }
}

impl Material {
    /// Width alpha of the distribution of microfacets; 0 without any.
    pub(super) fn alpha(&self) -> f64 {
        match *self {
            Self::Glossy { roughness, .. } | Self::Glass { roughness, .. } => roughness * roughness,
            Self::Diffuse { .. } | Self::Mirror { .. } => 0.0,
        }
    }
}

/// Axes whose third is a normal.
struct Frame([DVec3; 3]);

impl Frame {
    fn of(normal: DVec3) -> Self {
        let [x, y] = basis(normal);
        Self([x, y, normal])
    }

    fn local(&self, v: DVec3) -> DVec3 {
        DVec3::from_array(self.0.map(|axis| axis.dot(v)))
    }

    fn back(&self, v: DVec3) -> DVec3 {
        let [x, y, z] = self.0;
        x * v.x + y * v.y + z * v.z
    }
}

#[cfg(test)]
mod tests;
