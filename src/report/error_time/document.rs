//! `error-time.json` as it is written and read: nothing in it depends on the host, and every number is finite or absent.

use crate::picture::{PictureError, SurfaceError};
use crate::report::result::MachineFacts;
use serde::{Deserialize, Serialize};
use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

/// What `kind` says of such a document.
pub const KIND: &str = "error-time";
/// Its version.
pub const VERSION: u32 = 2;

/// Error against cost, of scenes, views, methods and machines.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct ErrorTime {
    /// [`KIND`].
    pub kind: String,
    /// [`VERSION`].
    pub version: u32,
    /// Name and version of the program that made it.
    pub program: String,
    /// What was asked for.
    pub options: Options,
    /// Scenes.
    pub scenes: Vec<SceneEntry>,
    /// Machines.
    pub machines: Vec<MachineFacts>,
    /// Methods.
    pub methods: Vec<MethodEntry>,
    /// Views.
    pub views: Vec<ViewEntry>,
    /// What was measured: one for each view, method, setting and number of samples.
    pub points: Vec<Point>,
    /// What methods cost at an error that all reach.
    #[serde(default)]
    pub equal_error: Vec<EqualError>,
    /// Pictures, in files beside the document.
    #[serde(default)]
    pub pictures: Vec<PictureEntry>,
    /// The steps of a coarse grid of rays.
    #[serde(default)]
    pub traces: Vec<TraceGrid>,
    /// What methods cost at other sizes of the frame.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub sizes: Vec<SizeCosts>,
    /// What scenes and units cost in error with less in them, if that was asked for.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub left_out: Vec<LeftOut>,
}

impl ErrorTime {
    /// The frames' sizes in words, of one scene or of all, such as `1920x1080`.
    pub fn sizes_in_words(&self, scene: Option<usize>) -> String {
        let mut sizes: Vec<String> = Vec::new();
        for view in self.views.iter().filter(|view| scene.is_none_or(|scene| view.scene == scene)) {
            let [width, height] = view.size;
            let words = format!("{width}x{height}");
            if !sizes.contains(&words) {
                sizes.push(words);
            }
        }
        sizes.join(", ")
    }

    /// Its pictures, each with its file, where the document lies in `folder`.
    pub fn picture_files(&self, folder: &Path) -> Vec<(PictureEntry, PathBuf)> {
        self.pictures.iter().map(|picture| (picture.clone(), folder.join(&picture.file))).collect()
    }

    /// Machines and kinds of compute that costs are of, in order.
    pub fn targets(&self) -> Vec<(usize, String)> {
        let costs = self.points.iter().flat_map(|point| &point.costs);
        let all: BTreeSet<_> = costs.map(|costs| (costs.machine, costs.compute.clone())).collect();
        all.into_iter().collect()
    }
}

/// What was asked for.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Options {
    /// Most columns and rows of pictures, and of rays whose errors are measured.
    pub error_size: u32,
    /// Samples per pixel.
    pub samples: Vec<u32>,
    /// How pictures are shaded.
    pub shading: String,
    /// Of the display that FLIP assumes.
    pub pixels_per_degree: f64,
    /// Of these rays one in so many columns and rows is held against the nearest point of the full-resolution surface.
    pub nearest_stride: u32,
}

/// A scene.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct SceneEntry {
    /// Its name.
    pub name: String,
    /// Its file, without folders.
    pub file: String,
    /// Checksum of the file.
    pub hash: String,
    /// Number of splits N.
    pub levels: u32,
    /// Triangles of the base mesh.
    pub base_triangles: u64,
    /// Triangles at full resolution.
    pub finest_triangles: u64,
    /// What its displacement bounds cover.
    pub bounds: String,
    /// Triangles of the mesh that it was built from, which errors are then against; absent where that is not at hand, and errors are against the finest level.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub input_triangles: Option<u64>,
}

/// A method.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct MethodEntry {
    /// Its name in the registry.
    pub name: String,
    /// The knob that was swept; absent if it has none.
    #[serde(default)]
    pub knob: Option<String>,
    /// There is nothing between the knob's values.
    #[serde(default)]
    pub in_steps: bool,
    /// One line about it.
    pub help: String,
}

/// A view of a scene.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct ViewEntry {
    /// Number of the scene.
    pub scene: usize,
    /// Distance of the eye from the target in bounding radii.
    pub distance: f64,
    /// The eye.
    pub eye: [f64; 3],
    /// Columns and rows of the frame: of what is simulated, and whose pixels errors are in.
    pub size: [u32; 2],
    /// Errors and pictures are of the middle one in every so many columns and rows of the frame.
    pub every: u32,
    /// The picture that stands for the truth of what a viewer sees, if there is one.
    #[serde(default)]
    pub converged: Option<Converged>,
    /// Full resolution with the camera shifted by half a pixel: an error that no level of detail makes.
    #[serde(default)]
    pub shift: Vec<Shift>,
}

/// A picture with so many samples that more change little.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Converged {
    /// Samples per pixel.
    pub samples: u32,
    /// Its standard error, channels from 0 to 255.
    pub standard_error: f64,
}

/// The error of a shift by half a pixel.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Shift {
    /// Samples per pixel.
    pub samples: u32,
    /// How far the shifted picture is from the other.
    pub picture: PictureError,
}

/// A method with a setting, of a view.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Point {
    /// Number of the view.
    pub view: usize,
    /// Name of the method.
    pub method: String,
    /// Its setting in words.
    pub setting: String,
    /// It is the one that the method has if nothing is chosen.
    #[serde(default)]
    pub is_default: bool,
    /// Its knobs.
    #[serde(default)]
    pub knobs: BTreeMap<String, String>,
    /// What it chose once for the frame.
    #[serde(default)]
    pub choices: BTreeMap<String, String>,
    /// Samples per pixel.
    pub samples: u32,
    /// Size of its memory in bytes.
    pub bytes: u64,
    /// The same for each finest triangle, or for each triangle of the input where the method is over that.
    pub bytes_per_triangle: f64,
    /// How far its surface is from that of full resolution: of the input where that is at hand, else of the finest level.
    pub geometry: SurfaceError,
    /// How far its surface is from the finest level's, where full resolution is the input's; absent for methods over the input.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub finest: Option<SurfaceError>,
    /// How far its picture is from full resolution with the same samples.
    pub picture: PictureError,
    /// How far its picture is from the converged one.
    #[serde(default)]
    pub viewed: Option<PictureError>,
    /// How bright it is for the converged one.
    #[serde(default)]
    pub appearance: Option<Appearance>,
    /// What it costs, by machine and kind of compute.
    pub costs: Vec<Costs>,
}

/// A method as it is if nothing is chosen, on a view's frame of another size, one sample a pixel.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct SizeCosts {
    /// Number of the view.
    pub view: usize,
    /// Columns and rows of the frame.
    pub size: [u32; 2],
    /// Name of the method.
    pub method: String,
    /// Its setting in words.
    pub setting: String,
    /// What it costs, by machine and kind of compute.
    pub costs: Vec<Costs>,
}

/// A view with one ray a pixel, of a scene that has no more than the view needs, on units for that.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct LeftOut {
    /// `whole`: nothing was left out; `lossless`: what moves no hit; `within P`: also what moves nothing by more than P pixels.
    pub what: String,
    /// How many pixels that is; 0 for none.
    pub pixels: f64,
    /// Zero bits at the bottom of coordinates.
    pub coordinate_zeros: u32,
    /// Zero bits at the bottom of components of directions.
    pub direction_zeros: u32,
    /// What was measured: errors are against full resolution of the whole scene, and the unit's area is its own.
    pub point: Point,
}

/// Luminance against that of the converged picture, linear, over the pixels that are wholly surface in both: what is left of an error if the surface is where it
/// should be.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Appearance {
    /// Mean luminance of the converged picture, 0 to 1.
    pub converged: f64,
    /// Mean luminance over that, 1 for the same.
    pub mean_ratio: f64,
    /// Root mean square difference.
    pub rmse: f64,
}

impl Appearance {
    /// Of two pictures' luminances, not a number where a pixel does not count; none if none does.
    pub fn of(picture: &[f32], converged: &[f32]) -> Option<Self> {
        let (mut count, mut sum, mut own, mut squares) = (0.0, 0.0, 0.0, 0.0);
        for (&a, &b) in picture.iter().zip(converged).filter(|(a, b)| !a.is_nan() && !b.is_nan()) {
            let (a, b) = (f64::from(a), f64::from(b));
            count += 1.0;
            own += a;
            sum += b;
            squares += (a - b) * (a - b);
        }
        (sum > 0.0).then(|| Self { converged: sum / count, mean_ratio: own / sum, rmse: (squares / count).sqrt() })
    }
}

/// What a frame costs on a machine.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Costs {
    /// Number of the machine.
    pub machine: usize,
    /// How compute is simulated.
    pub compute: String,
    /// Cycles.
    pub cycles: u64,
    /// The same in milliseconds.
    pub milliseconds: f64,
    /// Energy by part.
    pub energy: Energy,
    /// Lines of memory read and written.
    pub dram_lines: u64,
    /// The same in bytes.
    pub dram_bytes: u64,
    /// Lines asked of the L1s for each ray.
    pub l1_requests_per_ray: f64,
    /// Area of a traversal unit for the method, in gate equivalents; absent where no area is known.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub unit_gates: Option<f64>,
    /// The same frame behind others, if that was measured.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub warm: Option<WarmCosts>,
}

/// A frame behind others whose lines the caches still hold: the mean of the second half of some frames of a camera that turns.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct WarmCosts {
    /// Milliseconds.
    pub milliseconds: f64,
    /// Energy, in the unit of the frame's.
    pub energy: f64,
    /// Lines of memory read and written.
    pub dram_lines: f64,
}

/// Energy by part, all of it in `unit`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Energy {
    /// Of all figures here.
    pub unit: String,
    /// Sum of the parts.
    pub total: f64,
    /// The L1s, without leakage.
    pub l1: f64,
    /// The L2, without leakage.
    pub l2: f64,
    /// Memory.
    pub dram: f64,
    /// All that computes, without leakage.
    pub compute: f64,
    /// Leakage of what is on the chip.
    pub leakage: f64,
}

/// What methods cost where their error is the same.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct EqualError {
    /// Number of the view.
    pub view: usize,
    /// Samples per pixel.
    pub samples: u32,
    /// Which error.
    pub error: String,
    /// Its level.
    pub level: f64,
    /// Which cost.
    pub cost: String,
    /// Number of the machine.
    pub machine: usize,
    /// How compute is simulated.
    pub compute: String,
    /// Our cost, as [`super::cost_at`] has it; absent if no setting is near enough.
    pub ours: Option<f64>,
    /// Our setting that has it; absent where the cost lies between two.
    #[serde(default)]
    pub setting: Option<String>,
    /// What is to be said of it.
    #[serde(default)]
    pub why: Option<String>,
    /// The others.
    pub methods: Vec<EqualCost>,
    /// Those of them whose knob has steps, at the setting that they have if nothing is chosen, whatever its error is: without hindsight.
    #[serde(default)]
    pub own_rule: Vec<EqualCost>,
}

/// What one method costs there.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct EqualCost {
    /// Name of the method.
    pub method: String,
    /// The setting whose cost it is, where it is that of one.
    #[serde(default)]
    pub setting: Option<String>,
    /// Its cost.
    pub cost: Option<f64>,
    /// Its cost over ours.
    pub ratio: Option<f64>,
    /// Why there is none, or what else is to be said of it.
    #[serde(default)]
    pub why: Option<String>,
}

/// A picture in a file.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct PictureEntry {
    /// Number of the view.
    pub view: usize,
    /// Name of the method, or `full`.
    pub method: String,
    /// Its setting in words.
    pub setting: String,
    /// Samples per pixel.
    pub samples: u32,
    /// `image`, `error` or `levels`.
    pub kind: String,
    /// Where it is, relative to the document.
    pub file: String,
}

/// The steps of a coarse grid of rays: one in the middle of each of `grid` cells of the picture, row by row from the top.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct TraceGrid {
    /// Number of the view.
    pub view: usize,
    /// Name of the method.
    pub method: String,
    /// Its setting in words.
    pub setting: String,
    /// Columns and rows of the picture.
    pub size: [u32; 2],
    /// Columns and rows of the grid.
    pub grid: [u32; 2],
    /// What lines hold, by the number that steps give.
    pub sections: Vec<String>,
    /// The command that follows a ray of it, but for the pixel; absent for methods that `trace` does not know.
    #[serde(default)]
    pub command: Option<String>,
    /// The rays.
    pub rays: Vec<TracedRay>,
}

/// A ray of a [`TraceGrid`].
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct TracedRay {
    /// Its pixel, column and row.
    pub pixel: [u32; 2],
    /// What it hit.
    #[serde(default)]
    pub hit: Option<TracedHit>,
    /// Its steps: [`crate::report::inspect`] says how they are written.
    pub steps: String,
}

/// What a ray hit.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct TracedHit {
    /// Base triangle.
    pub tree: u32,
    /// Level of the triangle that was met.
    pub level: u32,
    /// Its node.
    pub node: u32,
    /// Distance from the origin in world units.
    pub distance: f64,
}
