//! Cones along paths: how much a ray stands for, from the eye over all its bounces (paper section 3.7; ray cones: Akenine-Moeller et al. 2021).
//!
//! A cone's radius where a ray hits is its radius where the next one starts: what the LOD test sees is the width along the whole path. Its spread then
//! depends on what scattered it.

use super::bsdf::Lobe;
use serde::Deserialize;

/// How cones spread after a hit; tangents of half angles.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Cones {
    /// Of a ray that is scattered evenly. No size is right for all: what it meets is seen blurred over a hemisphere, but its noise is not.
    pub diffuse: f64,
    /// Of a glossy one, for alpha = 1, added to what a mirror would make of it.
    pub glossy: f64,
    /// Of a ray to a light, for the whole angle that the light fills.
    pub light: f64,
    /// How much of a surface's curvature counts: 1 all, 0 none.
    pub curvature: f64,
}

impl Default for Cones {
    fn default() -> Self {
        Self { diffuse: 0.1, glossy: 0.25, light: 0.25, curvature: 1.0 }
    }
}

/// A ray's cone, in world units.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct PathCone {
    /// Radius where it starts.
    pub radius: f64,
    /// Growth per unit of length.
    pub spread: f64,
}

impl PathCone {
    /// The radius so far along the ray.
    pub fn at(&self, distance: f64) -> f64 {
        self.radius + self.spread * distance
    }

    /// The cone of a ray that is scattered so, by a surface of this curvature (1 / radius, positive where it bulges towards the ray) and distribution width `alpha`, at this distance.
    ///
    /// A hollow mirror can make a cone narrower; it is not followed through its focus, but never made narrower than parallel.
    pub(super) fn scattered(&self, distance: f64, lobe: Lobe, curvature: f64, alpha: f64, by: &Cones) -> Self {
        let radius = self.at(distance);
        let mirrored = (self.spread + 2.0 * curvature * by.curvature * radius).max(0.0);
        let spread = match lobe {
            Lobe::Mirror => mirrored,
            Lobe::Glossy => mirrored + by.glossy * alpha,
            Lobe::Diffuse => by.diffuse,
            // Snell's law for small angles: a surface that bulges towards the ray gathers light where it gets denser behind it.
            Lobe::Through { eta } => {
                (self.spread / eta - curvature * by.curvature * radius * (1.0 - 1.0 / eta)).max(0.0) + by.glossy * alpha
            }
        };
        Self { radius, spread }
    }

    /// The cone of a ray to a light that fills an angle of half tangent `spread`.
    pub(super) fn lit(&self, distance: f64, spread: f64, by: &Cones) -> Self {
        Self { radius: self.at(distance), spread: by.light * spread }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cones_go_on_where_they_were_and_spread_by_what_they_meet() {
        let cone = PathCone { radius: 0.5, spread: 0.1 };
        let by = Cones { diffuse: 0.7, glossy: 0.4, light: 0.5, curvature: 1.0 };
        let after = |lobe, curvature| cone.scattered(5.0, lobe, curvature, 0.25, &by);
        assert_eq!(after(Lobe::Mirror, 0.0), PathCone { radius: 1.0, spread: 0.1 });
        assert_eq!(after(Lobe::Mirror, 0.2), PathCone { radius: 1.0, spread: 0.5 });
        assert_eq!(after(Lobe::Mirror, -3.0), PathCone { radius: 1.0, spread: 0.0 });
        assert_eq!(after(Lobe::Glossy, 0.0), PathCone { radius: 1.0, spread: 0.2 });
        assert_eq!(after(Lobe::Diffuse, 9.0), PathCone { radius: 1.0, spread: 0.7 });
        let glass = |eta, curvature| cone.scattered(5.0, Lobe::Through { eta }, curvature, 0.0, &by).spread;
        assert!((glass(2.0, 0.0) - 0.05).abs() < 1e-12 && (glass(0.5, 0.0) - 0.2).abs() < 1e-12 && glass(2.0, 0.2) == 0.0);
        assert!((glass(2.0, -0.2) - 0.15).abs() < 1e-12);
        assert_eq!(cone.lit(5.0, 0.3, &by), PathCone { radius: 1.0, spread: 0.15 });
    }
}
