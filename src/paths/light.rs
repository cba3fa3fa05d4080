//! Lights.

use super::random::{cone_direction, cosine_direction, cosine_pdf, share};
use crate::num::Random;
use glam::DVec3;
use serde::Deserialize;
use std::f64::consts::{PI, TAU};

/// A light; its light is linear, in any one unit.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize)]
#[serde(tag = "kind", rename_all = "lowercase", deny_unknown_fields)]
pub enum Light {
    /// A point.
    Point {
        /// Where, in the world.
        position: [f64; 3],
        /// Radiant intensity.
        intensity: [f64; 3],
    },
    /// A parallelogram that shines to the side of `along` x `across`.
    Area {
        /// One corner.
        corner: [f64; 3],
        /// To the next one.
        along: [f64; 3],
        /// To the one before.
        across: [f64; 3],
        /// Radiance.
        radiance: [f64; 3],
    },
    /// A disc infinitely far away.
    Sun {
        /// Towards it.
        direction: [f64; 3],
        /// Its half angle in degrees, above 0; the sun's is 0.27.
        half_angle: f64,
        /// Irradiance on a surface that faces it.
        irradiance: [f64; 3],
    },
}

/// What shines from where nothing is: a sky above a ground.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Environment {
    /// Radiance straight up.
    pub zenith: [f64; 3],
    /// At the horizon.
    pub horizon: [f64; 3],
    /// From below.
    pub ground: [f64; 3],
    /// What is up.
    #[serde(default = "upwards")]
    pub up: [f64; 3],
}

/// Up, if nothing says so.
pub(super) fn upwards() -> [f64; 3] {
    [0.0, 1.0, 0.0]
}

/// Light that a surface may get.
#[derive(Clone, Copy, Debug)]
pub(super) struct Sent {
    /// Where it comes from.
    pub direction: DVec3,
    /// How far; infinite from no place.
    pub distance: f64,
    /// Tangent of half the angle that the whole light fills, about.
    pub spread: f64,
    /// What comes, by its likelihood.
    pub light: DVec3,
    /// Likelihood per solid angle; none of a point, which no other way finds.
    pub pdf: Option<f64>,
}

/// Light that a ray runs into.
#[derive(Clone, Copy, Debug)]
pub(super) struct Seen {
    pub distance: f64,
    pub radiance: DVec3,
    /// How likely [`Light::send`] finds its direction.
    pub pdf: f64,
}

fn radiance_of_sun(irradiance: DVec3, cosine: f64) -> DVec3 {
    irradiance / (PI * (1.0 - cosine * cosine))
}

impl Light {
    /// Light for a point, in a random direction.
    pub(super) fn send(&self, to: DVec3, random: &mut Random) -> Option<Sent> {
        match *self {
            Self::Point { position, intensity } => {
                let way = DVec3::from_array(position) - to;
                let distance = way.length();
                let light = DVec3::from_array(intensity) / (distance * distance);
                (distance > 0.0).then(|| Sent { direction: way / distance, distance, spread: 0.0, light, pdf: None })
            }
            Self::Area { corner, along, across, radiance } => {
                let [corner, along, across] = [corner, along, across].map(DVec3::from_array);
                let (way, normal) = (corner + along * share(random) + across * share(random) - to, along.cross(across));
                let (distance, area) = (way.length(), normal.length());
                let cosine = -way.dot(normal) / (distance * area);
                let pdf = distance * distance / (cosine * area);
                let spread = 0.5 * (area * cosine.max(0.0)).sqrt() / distance;
                let light = DVec3::from_array(radiance) / pdf;
                (cosine > 0.0).then(|| Sent { direction: way / distance, distance, spread, light, pdf: Some(pdf) })
            }
            Self::Sun { direction, half_angle, irradiance } => {
                let (axis, angle) = (DVec3::from_array(direction).normalize(), half_angle.to_radians());
                let pdf = 1.0 / (TAU * (1.0 - angle.cos()));
                let light = radiance_of_sun(DVec3::from_array(irradiance), angle.cos()) / pdf;
                let direction = cone_direction(axis, angle.cos(), random);
                Some(Sent { direction, distance: f64::INFINITY, spread: angle.tan(), light, pdf: Some(pdf) })
            }
        }
    }

    /// What a ray sees of it, if nothing is before it.
    pub(super) fn seen(&self, origin: DVec3, towards: DVec3) -> Option<Seen> {
        match *self {
            Self::Point { .. } => None,
            Self::Area { corner, along, across, radiance } => {
                let [corner, along, across] = [corner, along, across].map(DVec3::from_array);
                let normal = along.cross(across);
                let (area, facing) = (normal.length(), -towards.dot(normal));
                let distance = (origin - corner).dot(normal) / facing;
                let place = origin + towards * distance - corner;
                let [u, v] = [place.cross(across).dot(normal), along.cross(place).dot(normal)].map(|c| c / (area * area));
                let is_met = facing > 0.0 && distance > 0.0 && (0.0..=1.0).contains(&u) && (0.0..=1.0).contains(&v);
                let pdf = distance * distance / facing;
                is_met.then(|| Seen { distance, radiance: DVec3::from_array(radiance), pdf })
            }
            Self::Sun { direction, half_angle, irradiance } => {
                let cosine = half_angle.to_radians().cos();
                let is_met = towards.dot(DVec3::from_array(direction).normalize()) >= cosine;
                let radiance = radiance_of_sun(DVec3::from_array(irradiance), cosine);
                is_met.then(|| Seen { distance: f64::INFINITY, radiance, pdf: 1.0 / (TAU * (1.0 - cosine)) })
            }
        }
    }
}

impl Environment {
    /// Radiance from a direction.
    pub(super) fn radiance(&self, towards: DVec3) -> DVec3 {
        let height = towards.dot(DVec3::from_array(self.up).normalize());
        let [zenith, horizon, ground] = [self.zenith, self.horizon, self.ground].map(DVec3::from_array);
        // Most of the change is near the horizon.
        if height >= 0.0 { horizon.lerp(zenith, height.sqrt()) } else { horizon.lerp(ground, (-10.0 * height).min(1.0)) }
    }

    /// Light for a surface with this normal, in a random direction.
    pub(super) fn send(&self, normal: DVec3, random: &mut Random) -> Sent {
        let direction = cosine_direction(normal, random);
        let pdf = Self::pdf(normal, direction).max(1e-12);
        Sent { direction, distance: f64::INFINITY, spread: 1.0, light: self.radiance(direction) / pdf, pdf: Some(pdf) }
    }

    /// How likely that finds a direction.
    pub(super) fn pdf(normal: DVec3, direction: DVec3) -> f64 {
        cosine_pdf(normal.dot(direction))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// What is sent is what is seen where it comes from.
    #[test]
    fn what_is_sent_is_seen() {
        let lights = [
            Light::Area { corner: [0.0, 2.0, 0.0], along: [1.0, 0.0, 0.0], across: [0.0, 0.5, 1.0], radiance: [1.0, 2.0, 3.0] },
            Light::Sun { direction: [1.0, 2.0, 0.0], half_angle: 2.0, irradiance: [3.0, 2.0, 1.0] },
        ];
        let mut random = Random::new(5);
        for light in lights {
            let mut sent = 0;
            for k in 0..1_000 {
                let to = DVec3::new(0.3, f64::from(k % 7), -0.2);
                let Some(from) = light.send(to, &mut random) else { continue };
                sent += 1;
                let seen = light.seen(to, from.direction).unwrap();
                let pdf = from.pdf.unwrap();
                assert!((seen.pdf / pdf - 1.0).abs() < 1e-6 && (seen.radiance - from.light * pdf).abs().max_element() < 1e-6, "{light:?}");
                assert!(seen.distance == from.distance || (seen.distance / from.distance - 1.0).abs() < 1e-9);
            }
            assert!(sent > 200, "{light:?}: {sent}");
            assert!(light.seen(DVec3::ZERO, DVec3::new(0.0, -1.0, 0.0)).is_none());
        }
    }

    #[test]
    fn a_sun_gives_its_irradiance_and_a_point_falls_off() {
        let sun = Light::Sun { direction: [0.0, 0.0, 1.0], half_angle: 0.5, irradiance: [3.0, 2.0, 1.0] };
        let mut random = Random::new(6);
        let mean =
            (0..1_000).map(|_| sun.send(DVec3::ZERO, &mut random).unwrap()).map(|s| s.light * s.direction.z).sum::<DVec3>() / 1_000.0;
        assert!((mean - DVec3::new(3.0, 2.0, 1.0)).abs().max_element() < 1e-3, "{mean}");
        let point = Light::Point { position: [0.0, 0.0, 2.0], intensity: [4.0; 3] };
        let sent = point.send(DVec3::ZERO, &mut random).unwrap();
        assert_eq!((sent.light, sent.distance, sent.direction), (DVec3::ONE, 2.0, DVec3::Z));
    }
}
