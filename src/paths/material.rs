//! Materials as a description names them.

use serde::Deserialize;

/// A surface's material; colours are linear, 0 to 1 each.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize)]
#[serde(tag = "kind", rename_all = "lowercase", deny_unknown_fields)]
pub enum Material {
    /// Lambert's: light comes back evenly.
    Diffuse {
        /// Share of the light that comes back; the scene's own colours if none.
        albedo: Option<[f64; 3]>,
    },
    /// Microfacets that mirror, over a body that scatters evenly what they do not reflect.
    Glossy {
        /// Share that is reflected straight on; more of it flat (Schlick).
        reflectance: [f64; 3],
        /// Above 0, at most 1; its square is the width alpha of the distribution.
        roughness: f64,
        /// Share of the rest that the body sends back.
        #[serde(default)]
        albedo: [f64; 3],
    },
    /// A perfect mirror.
    Mirror {
        /// Share that is reflected, straight on; more of it flat (Schlick).
        reflectance: [f64; 3],
    },
    /// A clear body, whose inside is behind front faces.
    Glass {
        /// Index of refraction, 1.05 to 4; that of the air is 1.
        index: f64,
        /// 0, the default, is smooth; else at most 1, its square being the width alpha of the distribution of microfacets.
        #[serde(default)]
        roughness: f64,
    },
}
