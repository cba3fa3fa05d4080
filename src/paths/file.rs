//! The description of a scene for path tracing: models, materials, lights, cameras, in TOML.

use super::checked::{Checked, EXPOSURE, FINITE, HALF_ANGLE, INDEX, LIGHT, NOT_NEGATIVE, PLACE, ROUGHNESS, SCALE, SHARE, VIEW, one};
use super::cone::Cones;
use super::copies::CopiesTable;
use super::light::{Environment, Light, upwards};
use super::material::Material;
use super::moves::MovesTable;
use super::pose::Pose;
use crate::mesh::procedural;
use glam::DVec3;
use serde::Deserialize;
use std::collections::BTreeMap;
use std::fs;
use std::io;
use std::path::Path;
use thiserror::Error;

/// Why a description was refused.
#[derive(Debug, Error)]
pub enum SceneFileError {
    /// The file cannot be read.
    #[error("{file}: {source}")]
    Read {
        /// Which.
        file: String,
        /// Why.
        source: io::Error,
    },
    /// Not TOML, a key missing or unknown, or a value of the wrong type.
    #[error("{file}: {source}")]
    Toml {
        /// Which.
        file: String,
        /// Where and why.
        source: Box<toml::de::Error>,
    },
    /// A value that cannot be.
    #[error("{file}: {key} {rule}")]
    Invalid {
        /// Which file.
        file: String,
        /// The key, dotted.
        key: String,
        /// What it must be, and what it is.
        rule: String,
    },
}

/// A whole scene.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SceneFile {
    /// What is rendered.
    #[serde(default)]
    pub picture: PictureTable,
    /// How cones spread.
    #[serde(default)]
    pub cones: Cones,
    /// Where from; the first is taken unless another is asked for.
    pub camera: Vec<CameraTable>,
    /// The models.
    pub model: Vec<ModelTable>,
    /// Materials by name.
    #[serde(default)]
    pub material: BTreeMap<String, Material>,
    /// Lights.
    #[serde(default)]
    pub light: Vec<Light>,
    /// What shines where nothing is.
    pub environment: Option<Environment>,
    /// When, from 0 to 1: where models stand that move.
    #[serde(skip)]
    pub time: f64,
}

/// What is rendered.
#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct PictureTable {
    /// Columns.
    pub width: u32,
    /// Rows.
    pub height: u32,
    /// Paths of a pixel.
    pub samples: u32,
    /// Bounces.
    pub depth: u32,
    /// Seed.
    pub seed: u64,
    /// Lights are asked for light.
    pub shadow_rays: bool,
    /// Of the picture for a screen: 2^exposure times as bright.
    pub exposure: f64,
}

impl Default for PictureTable {
    fn default() -> Self {
        Self { width: 640, height: 480, samples: 16, depth: 3, seed: 0, shadow_rays: true, exposure: 0.0 }
    }
}

/// A camera.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct CameraTable {
    /// Its name.
    #[serde(default)]
    pub name: String,
    /// Where it is.
    pub eye: [f64; 3],
    /// What it looks at.
    pub target: [f64; 3],
    /// What is up.
    #[serde(default = "upwards")]
    pub up: [f64; 3],
    /// Degrees from bottom to top.
    #[serde(default = "view_angle")]
    pub fov: f64,
}

fn view_angle() -> f64 {
    crate::rays::DEFAULT_VIEW_ANGLE_DEGREES
}

/// A model: a file, or what is generated.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ModelTable {
    /// Scene file or mesh file, beside the description.
    pub file: Option<String>,
    /// Splits of a hierarchy over a mesh file.
    pub levels: Option<u32>,
    /// A procedural scene.
    pub generate: Option<MeshTable>,
    /// Name of the material of all its triangles.
    pub material: Option<String>,
    /// Names of materials by the number that the model gives them.
    #[serde(default)]
    pub materials: Vec<String>,
    /// Degrees about x, then y, then z.
    #[serde(default)]
    pub rotate: [f64; 3],
    /// Scale.
    #[serde(default = "one")]
    pub scale: f64,
    /// Where its origin goes.
    #[serde(default)]
    pub translate: [f64; 3],
    /// Three rows of four in place of the three above: any map with an inverse, the last column being where the origin goes.
    pub matrix: Option<[[f64; 4]; 3]>,
    /// More of it, in a grid.
    pub copies: Option<CopiesTable>,
    /// How it moves from the first frame of a sequence to the last; each of its copies does.
    pub moves: Option<MovesTable>,
}

impl ModelTable {
    /// Where it stands at a time from 0 to 1: once, or where each of its copies does.
    ///
    /// # Panics
    /// Its matrix is no pose, which no description has that was read.
    pub fn poses(&self, time: f64) -> Vec<Pose> {
        let own = match self.matrix {
            Some(rows) => Pose::affine(rows).expect("checked when it was read"),
            None => Pose::new(self.rotate, self.scale, self.translate),
        };
        let first: Vec<Pose> = match self.copies {
            None => vec![own],
            Some(copies) => {
                // Turned and scaled about the model's own origin, wherever that stands.
                let at = own.origin();
                copies.poses().map(|copy| own.about(at, &copy)).collect()
            }
        };
        match self.moves {
            // At the first frame it stands where the description has it, bit for bit.
            Some(moves) if time != 0.0 => first.iter().map(|pose| moves.at(pose, time)).collect(),
            _ => first,
        }
    }

    /// It is the same model as another, whatever its place and materials.
    pub fn is_of(&self, other: &Self) -> bool {
        (&self.file, self.levels, self.generate) == (&other.file, other.levels, other.generate)
    }
}

/// A procedural scene.
#[derive(Clone, Copy, Debug, Deserialize, PartialEq)]
#[serde(deny_unknown_fields)]
pub struct MeshTable {
    /// Which.
    pub scene: procedural::Scene,
    /// Splits.
    pub levels: Option<u32>,
    /// Wanted base triangles.
    pub base: Option<u32>,
    /// Seed.
    #[serde(default)]
    pub seed: u64,
    /// Roughness.
    pub roughness: Option<f64>,
    /// Quads along each wall of a room.
    pub walls: Option<u32>,
    /// World units across a terrain.
    pub width: Option<f64>,
}

impl From<MeshTable> for procedural::Options {
    fn from(MeshTable { scene, levels, base, seed, roughness, walls, width }: MeshTable) -> Self {
        Self { scene, levels, base, seed, roughness, walls, width }
    }
}

/// Most paths of a pixel.
pub const MOST_SAMPLES: u32 = 1 << 20;
/// Most bounces.
pub const MOST_DEPTH: u32 = 64;

impl SceneFile {
    /// Reads a description.
    ///
    /// # Errors
    /// Names file and key.
    pub fn read(path: &Path) -> Result<Self, SceneFileError> {
        let file = path.display().to_string();
        let text = fs::read_to_string(path).map_err(|source| SceneFileError::Read { file: file.clone(), source })?;
        Self::parse(&text, &file)
    }

    /// Parses one; `file` is what errors call it.
    ///
    /// # Errors
    /// Names file and key.
    pub fn parse(text: &str, file: &str) -> Result<Self, SceneFileError> {
        let own: Self = toml::from_str(text).map_err(|source| SceneFileError::Toml { file: file.to_owned(), source: Box::new(source) })?;
        let mut checked = Checked::default();
        own.check(&mut checked);
        match checked.0 {
            Some((key, rule)) => Err(SceneFileError::Invalid { file: file.to_owned(), key, rule }),
            None => Ok(own),
        }
    }

    /// The camera of this name, or the first.
    pub fn camera(&self, name: Option<&str>) -> Option<&CameraTable> {
        name.map_or(self.camera.first(), |name| self.camera.iter().find(|own| own.name == name))
    }

    fn check(&self, to: &mut Checked) {
        let PictureTable { width, height, samples, depth, exposure, .. } = self.picture;
        to.whole("picture.width", width, 1, crate::rays::MAX_SIDE);
        to.whole("picture.height", height, 1, crate::rays::MAX_SIDE);
        to.whole("picture.samples", samples, 1, MOST_SAMPLES);
        to.whole("picture.depth", depth, 0, MOST_DEPTH);
        to.number("picture.exposure", exposure, EXPOSURE);
        let Cones { diffuse, glossy, light, curvature } = self.cones;
        for (key, value) in [("diffuse", diffuse), ("glossy", glossy), ("light", light), ("curvature", curvature)] {
            to.number(&format!("cones.{key}"), value, NOT_NEGATIVE);
        }
        if self.camera.is_empty() {
            to.fail("camera", "must have at least one");
        }
        for (k, camera) in self.camera.iter().enumerate() {
            let key = |name: &str| format!("camera[{k}].{name}");
            to.triple(&key("eye"), camera.eye, PLACE);
            to.triple(&key("target"), camera.target, PLACE);
            to.direction(&key("up"), camera.up);
            let [eye, target, up] = [camera.eye, camera.target, camera.up].map(DVec3::from_array);
            match (target - eye).try_normalize() {
                None => to.fail(key("eye"), format!("must be another place than target, but both are {:?}", camera.eye)),
                // As nearly along the view as a camera refuses.
                Some(view) if up.normalize_or_zero().cross(view).length() < 1e-9 => {
                    to.fail(key("up"), format!("must not lie along the view, but is {:?}", camera.up));
                }
                Some(_) => {}
            }
            to.number(&key("fov"), camera.fov, VIEW);
            if self.camera[..k].iter().any(|before| before.name == camera.name) {
                to.fail(key("name"), format!("must differ from the others', but '{}' is there twice", camera.name));
            }
        }
        if self.model.is_empty() {
            to.fail("model", "must have at least one");
        }
        self.model.iter().enumerate().for_each(|(k, model)| self.check_model(to, k, model));
        for (name, material) in &self.material {
            check_material(to, &format!("material.{name}"), material);
        }
        self.light.iter().enumerate().for_each(|(k, light)| check_light(to, &format!("light[{k}]"), light));
        if let Some(Environment { zenith, horizon, ground, up }) = self.environment {
            for (key, colour) in [("zenith", zenith), ("horizon", horizon), ("ground", ground)] {
                to.triple(&format!("environment.{key}"), colour, LIGHT);
            }
            to.direction("environment.up", up);
        }
        if self.light.is_empty() && self.environment.is_none() {
            to.fail("light", "must have at least one, or there must be an environment");
        }
    }

    fn check_model(&self, to: &mut Checked, k: usize, model: &ModelTable) {
        let key = |name: &str| format!("model[{k}].{name}");
        if model.file.is_some() == model.generate.is_some() {
            to.fail(format!("model[{k}]"), "must have one of file and generate");
        }
        if let Some(generate) = model.generate
            && let Err(error) = procedural::Options::from(generate).check()
        {
            to.fail(key("generate"), format!("cannot be: {error}"));
        }
        if let Some(levels) = model.levels {
            to.whole(&key("levels"), levels, 0, crate::num::MAX_LEVELS);
            if model.file.is_none() {
                to.fail(key("levels"), "is of mesh files; what is generated has its own");
            }
        }
        if let Some(rows) = model.matrix {
            for (row, values) in rows.iter().enumerate() {
                values.iter().enumerate().for_each(|(k, &value)| to.number(&key(&format!("matrix[{row}][{k}]")), value, PLACE));
            }
            if (model.rotate, model.scale, model.translate) != ([0.0; 3], 1.0, [0.0; 3]) {
                to.fail(key("matrix"), "must not be there beside rotate, scale or translate");
            }
            if let Err(error) = Pose::affine(rows) {
                to.fail(key("matrix"), error.to_string());
            }
        }
        if let Some(copies) = model.copies {
            copies.check(to, &key("copies"));
        }
        if let Some(moves) = model.moves {
            moves.check(to, &key("moves"));
        }
        to.triple(&key("rotate"), model.rotate, FINITE);
        to.number(&key("scale"), model.scale, SCALE);
        to.triple(&key("translate"), model.translate, PLACE);
        if model.material.is_some() && !model.materials.is_empty() {
            to.fail(key("materials"), "must not be there beside material");
        }
        for name in model.material.iter().chain(&model.materials) {
            if !self.material.contains_key(name) {
                to.fail(key("material"), format!("must be the name of a material, but is '{name}'"));
            }
        }
    }

    /// Where models stand at its time: the number of each in its table, and its pose.
    pub fn places(&self) -> Vec<(usize, Pose)> {
        self.model.iter().enumerate().flat_map(|(k, model)| model.poses(self.time).into_iter().map(move |pose| (k, pose))).collect()
    }

    /// The same scene at another time, from 0 to 1.
    #[must_use]
    pub fn at(&self, time: f64) -> Self {
        Self { time, ..self.clone() }
    }

    /// Some model moves.
    pub fn moves(&self) -> bool {
        self.model.iter().any(|model| model.moves.is_some())
    }

    /// The materials of a model, by number; its own colours, scattered evenly, if it names none.
    pub fn materials(&self, model: &ModelTable) -> Vec<Material> {
        let named: Vec<_> = model.material.iter().chain(&model.materials).filter_map(|name| self.material.get(name).copied()).collect();
        if named.is_empty() { vec![Material::Diffuse { albedo: None }] } else { named }
    }
}

fn check_material(to: &mut Checked, key: &str, material: &Material) {
    match *material {
        Material::Diffuse { albedo } => to.triple(&format!("{key}.albedo"), albedo.unwrap_or_default(), SHARE),
        Material::Mirror { reflectance } => to.triple(&format!("{key}.reflectance"), reflectance, SHARE),
        Material::Glossy { reflectance, roughness, albedo } => {
            to.triple(&format!("{key}.reflectance"), reflectance, SHARE);
            to.triple(&format!("{key}.albedo"), albedo, SHARE);
            to.number(&format!("{key}.roughness"), roughness, ROUGHNESS);
        }
        Material::Glass { index, roughness } => {
            to.number(&format!("{key}.index"), index, INDEX);
            to.number(&format!("{key}.roughness"), roughness, SHARE);
        }
    }
}

fn check_light(to: &mut Checked, key: &str, light: &Light) {
    match *light {
        Light::Point { position, intensity } => {
            to.triple(&format!("{key}.position"), position, PLACE);
            to.triple(&format!("{key}.intensity"), intensity, LIGHT);
        }
        Light::Area { corner, along, across, radiance } => {
            to.triple(&format!("{key}.corner"), corner, PLACE);
            for (name, side) in [("along", along), ("across", across)] {
                to.direction(&format!("{key}.{name}"), side);
                to.triple(&format!("{key}.{name}"), side, PLACE);
            }
            to.triple(&format!("{key}.radiance"), radiance, LIGHT);
            let [a, b] = [along, across].map(DVec3::from_array);
            if a.cross(b) == DVec3::ZERO {
                to.fail(key, "must have an area: along and across must not be parallel");
            }
        }
        Light::Sun { direction, half_angle, irradiance } => {
            to.direction(&format!("{key}.direction"), direction);
            to.number(&format!("{key}.half_angle"), half_angle, HALF_ANGLE);
            to.triple(&format!("{key}.irradiance"), irradiance, LIGHT);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const GOOD: &str = r#"
[[camera]]
eye = [0, 0, 5]
target = [0, 0, 0]
[[model]]
generate = { scene = "sphere", levels = 2 }
material = "clay"
[material.clay]
kind = "glossy"
reflectance = [0.04, 0.04, 0.04]
roughness = 0.5
albedo = [0.5, 0.4, 0.3]
[[light]]
kind = "point"
position = [1, 2, 3]
intensity = [1, 1, 1]
"#;

    /// The material there.
    const GLOSSY: &str = "kind = \"glossy\"\nreflectance = [0.04, 0.04, 0.04]\nroughness = 0.5\nalbedo = [0.5, 0.4, 0.3]";

    #[test]
    fn a_scene_is_read_with_its_defaults() {
        let scene = SceneFile::parse(GOOD, "a.toml").unwrap();
        assert_eq!((scene.picture.width, scene.picture.depth, scene.cones), (640, 3, Cones::default()));
        assert_eq!(scene.materials(&scene.model[0]), vec![scene.material["clay"]]);
        assert!(scene.camera(None).is_some() && scene.camera(Some("side")).is_none());
    }

    #[test]
    fn each_bad_value_is_named_with_file_and_key() {
        let copies = |of: &str| format!("material = \"clay\"\ncopies = {{ {of}, step = [1, 1, 1] }}");
        for (from, to, wanted) in [
            ("eye = [0, 0, 5]", "eye = [0, nan, 5]", "a.toml: camera[0].eye[1] must be from -1e12 to 1e12, but is NaN"),
            (
                "target = [0, 0, 0]",
                "target = [0, 0, 0]\nfov = 180",
                "a.toml: camera[0].fov must be above 0 and below 180 degrees, but is 180",
            ),
            ("roughness = 0.5", "roughness = 0", "a.toml: material.clay.roughness must be above 0 and at most 1, but is 0"),
            ("\"clay\"\n", "\"gold\"\n", "a.toml: model[0].material must be the name of a material, but is 'gold'"),
            ("levels = 2", "levels = 11", "a.toml: model[0].generate cannot be: 11 levels are too many: 0 to 10 are possible"),
            ("generate", "file = \"a.obj\"\ngenerate", "a.toml: model[0] must have one of file and generate"),
            ("intensity = [1, 1, 1]", "intensity = [1, -1, 1]", "a.toml: light[0].intensity[1] must be from 0 to 1e15, but is -1"),
            ("material = \"clay\"", "material = \"clay\"\nscale = 0", "a.toml: model[0].scale must be from 1e-12 to 1e12, but is 0"),
            (
                "eye = [0, 0, 5]",
                "eye = [1e300, 0, 5]",
                &format!("a.toml: camera[0].eye[0] must be from -1e12 to 1e12, but is 1{}", "0".repeat(300)),
            ),
            ("eye = [0, 0, 5]", "eye = [0, 0, 0]", "a.toml: camera[0].eye must be another place than target, but both are [0.0, 0.0, 0.0]"),
            (
                "target = [0, 0, 0]",
                "target = [0, 0, 0]\nup = [0, 0, -2]",
                "a.toml: camera[0].up must not lie along the view, but is [0.0, 0.0, -2.0]",
            ),
            ("target = [0, 0, 0]", "target = [0, 0, 0]\nup = [0, 0, 0]", "a.toml: camera[0].up must not be zero"),
            ("target = [0, 0, 0]", "target = [0, inf, 0]", "a.toml: camera[0].target[1] must be from -1e12 to 1e12, but is inf"),
            (
                "intensity = [1, 1, 1]",
                "intensity = [1, 1, 1e38]",
                &format!("a.toml: light[0].intensity[2] must be from 0 to 1e15, but is {}", 1e38),
            ),
            ("intensity = [1, 1, 1]", "intensity = [nan, 1, 1]", "a.toml: light[0].intensity[0] must be from 0 to 1e15, but is NaN"),
            (
                "position = [1, 2, 3]",
                "position = [1, -1e13, 3]",
                "a.toml: light[0].position[1] must be from -1e12 to 1e12, but is -10000000000000",
            ),
            ("albedo = [0.5, 0.4, 0.3]", "albedo = [0.5, 1.4, 0.3]", "a.toml: material.clay.albedo[1] must be from 0 to 1, but is 1.4"),
            (
                "material = \"clay\"",
                "material = \"clay\"\nmatrix = [[1, 0, 0, 0], [0, 1, 0, nan], [0, 0, 1, 0]]",
                "a.toml: model[0].matrix[1][3] must be from -1e12 to 1e12, but is NaN",
            ),
            (
                "material = \"clay\"",
                "material = \"clay\"\nscale = 2\nmatrix = [[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0]]",
                "a.toml: model[0].matrix must not be there beside rotate, scale or translate",
            ),
            (
                "material = \"clay\"",
                "material = \"clay\"\nmatrix = [[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 0, 0]]",
                &format!("a.toml: model[0].matrix {}", Pose::affine([[1.0, 0.0, 0.0, 0.0], [0.0, 1.0, 0.0, 0.0], [0.0; 4]]).unwrap_err()),
            ),
            (
                "material = \"clay\"",
                &copies("count = [0, 1, 1]"),
                "a.toml: model[0].copies.count must be from 1 to 1048576 in all, but is [0, 1, 1]",
            ),
            (
                "material = \"clay\"",
                &copies("count = [4096, 4096, 4096]"),
                "a.toml: model[0].copies.count must be from 1 to 1048576 in all, but is [4096, 4096, 4096]",
            ),
            (
                "material = \"clay\"",
                &copies("count = [1, 1, 1], jitter = 2"),
                "a.toml: model[0].copies.jitter must be from 0 to 1, but is 2",
            ),
            (
                "material = \"clay\"",
                &copies("count = [1, 1, 1], least = 0"),
                "a.toml: model[0].copies.least must be above 0 and at most 1, but is 0",
            ),
            ("material = \"clay\"", &copies("count = [1, 1, 1], turn = [0, 0, 0]"), "a.toml: model[0].copies.turn must not be zero"),
            (
                "material = \"clay\"",
                "material = \"clay\"\nmoves = { by = [0, 1e13, 0] }",
                "a.toml: model[0].moves.by[1] must be from -1e12 to 1e12, but is 10000000000000",
            ),
            (
                "material = \"clay\"",
                "material = \"clay\"\nmoves = { turn = [0, 1, 0], degrees = inf }",
                "a.toml: model[0].moves.degrees must be a finite number, but is inf",
            ),
            (GLOSSY, "kind = \"glass\"\nindex = 1", "a.toml: material.clay.index must be from 1.05 to 4, but is 1"),
            (GLOSSY, "kind = \"glass\"\nindex = 1.5\nroughness = 2", "a.toml: material.clay.roughness must be from 0 to 1, but is 2"),
        ] {
            assert!(GOOD.contains(from), "{from}");
            assert_eq!(SceneFile::parse(&GOOD.replace(from, to), "a.toml").unwrap_err().to_string(), wanted);
        }
        for (from, to, wanted) in
            [("albedo", "albeda", "albeda"), ("\"point\"", "\"lamp\"", "lamp"), ("[[camera]]", "[[camara]]", "camara")]
        {
            let error = SceneFile::parse(&GOOD.replace(from, to), "a.toml").unwrap_err().to_string();
            assert!(error.starts_with("a.toml: TOML parse error at line ") && error.contains(wanted), "{error}");
        }
    }
}
