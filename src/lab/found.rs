//! Rays worth keeping, each with its model: breaches, and the nearest approaches of a hunt. Complete in themselves, so that they can be shot again.

use super::goal::Goal;
use super::model::Model;
use crate::format::SceneError;
use crate::mesh::{BoundKind, EdgeCodes, Hierarchy, Placement, lattice};
use crate::num::{Cone, Direction, Point, Ray, S, U, VertexForm};
use serde::{Deserialize, Serialize};

/// A ray and its model.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Found {
    /// What was approached; none for a breach.
    pub goal: Option<Goal>,
    /// How near.
    pub value: f64,
    /// Origin of the ray in units.
    pub origin: [i64; 3],
    /// Its direction.
    pub direction: [i64; 3],
    /// Offset, slope and shift of its cone.
    pub cone: [u64; 3],
    /// Splits of the model.
    pub levels: u32,
    /// How its inserted vertices are stored; `exact` is not written.
    #[serde(default = "unnamed", skip_serializing_if = "is_unnamed")]
    pub vertices: VertexForm,
    /// Base triangles.
    pub triangles: Vec<[u32; 3]>,
    /// Points of all trees in units, tree by tree.
    pub points: Vec<[i32; 3]>,
}

/// What records mean that name no form: those from before there was a choice.
fn unnamed() -> VertexForm {
    VertexForm::Exact
}

fn is_unnamed(form: &VertexForm) -> bool {
    *form == unnamed()
}

/// Models with more points than this are not repeated with every ray: such a ray names its scene by the file that it was found in.
const MOST_POINTS: usize = 2_000;

impl Found {
    /// Notes a ray at a model.
    pub fn new(goal: Option<Goal>, value: f64, h: &Hierarchy, ray: &Ray) -> Self {
        let small = h.points.len() <= MOST_POINTS;
        Self {
            goal,
            value,
            origin: ray.origin.get(),
            direction: ray.direction.get(),
            cone: [ray.cone.offset.get(), ray.cone.slope.get(), ray.cone.shift.get()],
            levels: h.levels,
            vertices: h.vertices,
            triangles: if small { h.triangles.clone() } else { Vec::new() },
            points: if small { h.points.clone() } else { Vec::new() },
        }
    }

    /// What orders records of one goal and value.
    pub(super) fn key(&self) -> impl Ord {
        (self.origin, self.direction, self.cone, self.points.clone())
    }

    /// The ray, or `None` if a number does not fit its format.
    pub fn ray(&self) -> Option<Ray> {
        let fits = |v: [i64; 3]| v.into_iter().all(|c| S::<32>::checked(c).is_some());
        let short = self.direction.into_iter().all(|c| S::<31>::checked(c).is_some());
        let ([x, y, z], [dx, dy, dz]) = (self.origin, self.direction);
        let [offset, slope, shift] = self.cone;
        let cone = Cone { offset: U::checked(offset)?, slope: U::checked(slope)?, shift: U::checked(shift)? };
        (fits(self.origin) && short).then(|| Ray { origin: Point::new(x, y, z), direction: Direction::new(dx, dy, dz), cone })
    }

    /// The model.
    ///
    /// # Errors
    /// The record holds none, or one that cannot be encoded.
    pub fn model(&self) -> Result<Model, SceneError> {
        let wrong = |what: &str| SceneError::Build(format!("found: {what}"));
        let vertices = self.triangles.iter().flatten().max().map_or(0, |&v| v.saturating_add(1));
        if self.levels > crate::num::MAX_LEVELS || self.triangles.is_empty() {
            return Err(wrong("no model"));
        }
        if self.points.len() != self.triangles.len() * lattice::len(self.levels) {
            return Err(wrong("wrong number of points"));
        }
        let hierarchy = Hierarchy {
            levels: self.levels,
            placement: Placement { offset: [0.0; 3], scale: 1.0 },
            base_vertices: vertices,
            triangles: self.triangles.clone(),
            points: self.points.clone(),
            bounds: EdgeCodes { kind: BoundKind::Largest, ..EdgeCodes::default() },
            vertices: self.vertices,
            zeros: 0,
        };
        Model::of_hierarchy("found", hierarchy)
    }
}
