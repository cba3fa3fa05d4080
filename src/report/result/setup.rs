//! What was run, and on what.

use crate::format::Scene;
use crate::render::Camera;
use crate::sim::machine::Machine;
use serde::{Deserialize, Serialize};

/// Everything that a run depends on.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Setup {
    /// The scene.
    pub scene: SceneFacts,
    /// The method.
    pub method: MethodFacts,
    /// The camera.
    pub view: ViewFacts,
    /// How compute is simulated.
    pub compute: Compute,
    /// The machine.
    pub machine: MachineFacts,
}

impl Setup {
    /// Rays that the machine holds at once.
    pub fn contexts(&self) -> u64 {
        let Machine { cores, units, .. } = &self.machine.description;
        let per_group = match self.compute {
            Compute::Free => u64::from(cores.per_group) * u64::from(cores.rays_in_flight),
            Compute::Units => u64::from(units.per_group) * u64::from(units.contexts),
        };
        u64::from(cores.groups) * per_group
    }
}

/// How compute is simulated.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Compute {
    /// It takes no time, as in the paper.
    Free,
    /// Traversal units, cycle by cycle.
    Units,
}

impl Compute {
    /// Both.
    pub const ALL: [Self; 2] = [Self::Free, Self::Units];

    /// Its name in options and reports.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Free => "free",
            Self::Units => "units",
        }
    }
}

/// What a scene is.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SceneFacts {
    /// Its name.
    pub name: String,
    /// Number of splits N.
    pub levels: u32,
    /// Triangles of the base mesh.
    pub base_triangles: u64,
    /// Triangles at full resolution.
    pub finest_triangles: u64,
}

impl From<&Scene> for SceneFacts {
    fn from(scene: &Scene) -> Self {
        let name = scene.meta().name.clone();
        Self { name, levels: scene.levels(), base_triangles: scene.trees() as u64, finest_triangles: scene.finest_triangles() }
    }
}

/// What a method is.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct MethodFacts {
    /// `lod`, `bvh` or `bvh32`.
    pub name: String,
    /// Quality of the level of detail; a BVH is always at full resolution.
    #[serde(with = "quality", default, skip_serializing_if = "Option::is_none")]
    pub delta: Option<f64>,
    /// Leaves of a BVH, such as `line 4`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub leaves: Option<String>,
    /// Size of its memory in bytes.
    pub bytes: u64,
}

/// Where the camera is.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ViewFacts {
    /// Columns and rows.
    pub size: [u32; 2],
    /// The eye in world space.
    pub eye: [f64; 3],
    /// Its distance from the target in bounding radii, if that is how it was placed.
    pub distance: Option<f64>,
}

impl ViewFacts {
    /// A camera, placed at `distance` if it was.
    pub fn new(camera: &Camera, distance: Option<f64>) -> Self {
        Self { size: [camera.width, camera.height], eye: camera.eye.to_array(), distance }
    }
}

/// What a machine is.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct MachineFacts {
    /// What to call it: the name of its file, without folder and ending.
    pub label: String,
    /// What was changed of it, each as `key=value`.
    pub set: Vec<String>,
    /// All of it, changes included.
    pub description: Machine,
}

impl MachineFacts {
    /// Label and changes.
    pub fn title(&self) -> String {
        std::iter::once(self.label.as_str()).chain(self.set.iter().map(String::as_str)).collect::<Vec<_>>().join(" ")
    }
}

/// A quality as a number, or `"inf"`, for which JSON has no number.
mod quality {
    use serde::{Deserialize, Deserializer, Serialize, Serializer, de::Error};

    #[derive(Serialize, Deserialize)]
    #[serde(untagged)]
    enum Quality {
        Number(f64),
        Word(String),
    }

    #[expect(clippy::ref_option, reason = "the signature that serde calls")]
    pub fn serialize<S: Serializer>(value: &Option<f64>, to: S) -> Result<S::Ok, S::Error> {
        let quality = value.map(|v| if v.is_finite() { Quality::Number(v) } else { Quality::Word("inf".to_owned()) });
        quality.serialize(to)
    }

    pub fn deserialize<'de, D: Deserializer<'de>>(from: D) -> Result<Option<f64>, D::Error> {
        match Option::<Quality>::deserialize(from)? {
            None => Ok(None),
            Some(Quality::Number(v)) => Ok(Some(v)),
            Some(Quality::Word(word)) if word == "inf" => Ok(Some(f64::INFINITY)),
            Some(Quality::Word(word)) => Err(D::Error::custom(format!("'{word}' is not a quality"))),
        }
    }
}
