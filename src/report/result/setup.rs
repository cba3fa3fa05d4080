//! What was run, and on what.

use crate::format::Scene;
use crate::machine::Machine;
use crate::mesh::BoundKind;
use crate::method::bvh::{LEAF_LAYOUT, LEAF_SIZE, LeafLayout};
use crate::method::knob::DELTA;
use crate::method::{Knobs, Registered};
use crate::rays::Camera;
use crate::run::Compute;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// Everything that a run depends on.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Setup {
    /// The scene.
    pub scene: SceneFacts,
    /// The method.
    pub method: MethodFacts,
    /// The camera; absent if the rays are a file's.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub view: Option<ViewFacts>,
    /// Frames after one another that the camera moves through, where there are several; `view` is the first.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub frames: Option<u32>,
    /// The file of rays, if they are of one.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub rays: Option<RayFileFacts>,
    /// How compute is simulated.
    pub compute: Compute,
    /// The machine.
    pub machine: MachineFacts,
}

impl Setup {
    /// Which rays, in words: `64x48 rays from 2 bounding radii`.
    pub fn rays_in_words(&self) -> String {
        let of_view = |view: &ViewFacts| {
            let place = view.distance.map_or_else(|| format!("{:?}", view.eye), |distance| format!("{distance} bounding radii"));
            let frames = self.frames.map_or(String::new(), |frames| format!("{frames} frames of "));
            let order = view.tiles_in_turn.map_or(String::new(), |tiles| format!(", of {tiles} tiles in turn"));
            format!("{frames}{}x{} rays from {place}{order}", view.size[0], view.size[1])
        };
        let of_file = |rays: &RayFileFacts| format!("{} {} of {}", rays.count, if rays.count == 1 { "ray" } else { "rays" }, rays.file);
        self.view.as_ref().map(of_view).or_else(|| self.rays.as_ref().map(of_file)).unwrap_or_default()
    }

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
    /// What its displacement bounds cover; `largest` is not written.
    #[serde(default = "BoundKind::unnamed", skip_serializing_if = "BoundKind::is_unnamed")]
    pub bounds: BoundKind,
    /// Of the models of a description: figures above are of all of them.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub models: Option<ModelsFacts>,
}

impl From<&Scene> for SceneFacts {
    fn from(scene: &Scene) -> Self {
        let name = scene.meta().name.clone();
        let (base_triangles, finest_triangles) = (scene.trees() as u64, scene.finest_triangles());
        Self { name, levels: scene.levels(), base_triangles, finest_triangles, bounds: scene.meta().bounds, models: None }
    }
}

impl SceneFacts {
    /// Those of models that a description places together: triangles are counted as often as they stand somewhere. A model alone in one place keeps its name; else `description`
    /// is named. `xxh3` is [`ModelsFacts::xxh3`]; each model comes with the number of its places.
    pub fn of_models(description: &str, xxh3: String, models: &[(&Scene, u64)]) -> Self {
        let own = |&(scene, places): &(&Scene, u64)| {
            let Self { name, levels, base_triangles, finest_triangles, .. } = Self::from(scene);
            ModelFacts { name, levels, base_triangles, finest_triangles, places }
        };
        let all: Vec<ModelFacts> = models.iter().map(own).collect();
        let sum = |of: fn(&ModelFacts) -> u64| all.iter().map(|own| own.places * of(own)).sum::<u64>();
        let places = all.iter().map(|own| own.places).sum::<u64>();
        let name = match &all[..] {
            [alone] if places == 1 => alone.name.clone(),
            _ => format!("{description}, {places} models"),
        };
        Self {
            name,
            levels: all.iter().map(|own| own.levels).max().unwrap_or(0),
            base_triangles: sum(|own| own.base_triangles),
            finest_triangles: sum(|own| own.finest_triangles),
            bounds: models.first().map_or_else(BoundKind::unnamed, |(scene, _)| scene.meta().bounds),
            models: Some(ModelsFacts { description: description.to_owned(), xxh3, models: all }),
        }
    }
}

/// What a description places together.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ModelsFacts {
    /// The description's file.
    pub description: String,
    /// XXH3 of the bytes of the description and of the files that it names, each once, one behind the other in its order: 64 bits, hexadecimal.
    pub xxh3: String,
    /// The models, in its order.
    pub models: Vec<ModelFacts>,
}

/// A model of a description.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ModelFacts {
    /// Its name.
    pub name: String,
    /// Number of splits N.
    pub levels: u32,
    /// Triangles of its base mesh, counted once.
    pub base_triangles: u64,
    /// Triangles at full resolution, counted once.
    pub finest_triangles: u64,
    /// Where it stands: so many places.
    pub places: u64,
}

/// What a method is.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct MethodFacts {
    /// Its name in the registry, such as `lod`.
    pub name: String,
    /// Quality of the level of detail; a BVH is always at full resolution.
    #[serde(with = "quality", default, skip_serializing_if = "Option::is_none")]
    pub delta: Option<f64>,
    /// Leaves of a BVH, such as `line 4`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub leaves: Option<String>,
    /// What else was chosen for the frame, such as the `level` of discrete level of detail.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub choices: BTreeMap<String, String>,
    /// Its knobs, by name: the chosen values, or those by default.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub knobs: BTreeMap<String, String>,
    /// Size of its memory in bytes.
    pub bytes: u64,
}

/// A layout, and the most triangles that its leaves have where `size` is asked for.
fn leaves_of(layout: &str, size: &str) -> String {
    let most = LeafLayout::named(layout).map(LeafLayout::most_triangles);
    match (most, size.parse::<u32>()) {
        (Some(most), Ok(size)) => format!("{layout} {}", size.min(most)),
        _ => format!("{layout} {size}"),
    }
}

impl MethodFacts {
    /// A method with its knobs, what it chose for the frame, and the size of its memory.
    pub fn new(method: &Registered, knobs: &Knobs, choices: &[(&'static str, String)], bytes: u64) -> Self {
        let leaves = [&LEAF_LAYOUT, &LEAF_SIZE].map(|knob| knobs.get(knob).filter(|_| method.has(knob.name)));
        Self {
            name: method.name.to_owned(),
            delta: method.has(DELTA.name).then(|| knobs.delta()),
            leaves: if let [Some(layout), Some(size)] = leaves { Some(leaves_of(layout, size)) } else { None },
            knobs: method.knobs.iter().filter_map(|knob| Some((knob.name.to_owned(), knobs.get(knob)?.to_owned()))).collect(),
            choices: choices.iter().map(|(name, value)| ((*name).to_owned(), value.clone())).collect(),
            bytes,
        }
    }

    /// What tells it from the same method with other knobs, each as text.
    pub fn details(&self) -> Vec<String> {
        let delta = self.delta.map(|delta| format!("delta {delta}"));
        let leaves = self.leaves.as_ref().map(|leaves| format!("leaves {leaves}"));
        let choices = self.choices.iter().map(|(name, value)| format!("{name} {value}"));
        let said = |name: &str| [DELTA.name, LEAF_LAYOUT.name, LEAF_SIZE.name].contains(&name) || self.choices.contains_key(name);
        let others = self.knobs.iter().filter(|(name, _)| !said(name)).map(|(name, value)| format!("{name} {value}"));
        delta.into_iter().chain(choices).chain(others).chain(leaves).collect()
    }
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
    /// Tiles whose rays the machine was handed in turn, if it is not tile by tile ([`Camera::in_turn`]).
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub tiles_in_turn: Option<u32>,
}

impl ViewFacts {
    /// A camera.
    pub fn new(camera: &Camera) -> Self {
        let tiles_in_turn = Some(camera.tiles_in_turn()).filter(|&tiles| tiles > 1);
        Self { size: [camera.width, camera.height], eye: camera.eye.to_array(), distance: camera.placed, tiles_in_turn }
    }
}

/// A file of rays.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RayFileFacts {
    /// Its name, without folders.
    pub file: String,
    /// How many rays it has.
    pub count: u64,
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
