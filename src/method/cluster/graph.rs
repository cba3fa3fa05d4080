//! Clusters of triangles, and groups of them that a simplification replaces together.
//!
//! A cluster is of one group, and is a part of the simplification of another, unless it is of the mesh itself. Whoever decides about a group decides about all of its clusters and about
//! all of its simplification at once, and no edge at the border of a group is simplified with it: so what is chosen covers the model without a gap, as long as all groups below one whose
//! simplification is chosen would do too ([`super::cut`]).

use super::snapped::{Grid, Place, Snapped};
use crate::bvh::Box32;
use std::ops::Range;

/// A sphere, in units.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sphere {
    /// Its centre.
    pub centre: [f64; 3],
    /// Its radius.
    pub radius: f64,
}

impl Sphere {
    /// Around a box.
    pub fn around(bounds: &Box32) -> Self {
        let centre = std::array::from_fn(|k| 0.5 * (f64::from(bounds.lo[k]) + f64::from(bounds.hi[k])));
        let half: f64 = (0..3).map(|k| (f64::from(bounds.hi[k]) - centre[k]).powi(2)).sum();
        Self { centre, radius: half.sqrt() }
    }

    /// One that holds both.
    #[must_use]
    pub fn with(self, other: Self) -> Self {
        let apart: [f64; 3] = std::array::from_fn(|k| other.centre[k] - self.centre[k]);
        let distance = apart.iter().map(|c| c * c).sum::<f64>().sqrt();
        if distance + other.radius <= self.radius {
            return self;
        }
        if distance + self.radius <= other.radius {
            return other;
        }
        let radius = 0.5 * (distance + self.radius + other.radius);
        let along = (radius - self.radius) / distance;
        Self { centre: std::array::from_fn(|k| self.centre[k] + along * apart[k]), radius }
    }
}

/// A cluster.
#[derive(Clone, Copy, Debug)]
pub struct Cluster {
    /// Its first triangle among those of all clusters.
    pub first: u32,
    /// Its triangles, 1 to 256.
    pub count: u32,
    /// The group that it is of.
    pub group: u32,
    /// The group whose simplification it is a part of; none if it is of the mesh itself.
    pub refined: Option<u32>,
    /// Its box, in units.
    pub bounds: Box32,
}

impl Cluster {
    /// Its triangles.
    pub fn triangles(&self) -> Range<usize> {
        self.first as usize..(self.first + self.count) as usize
    }
}

/// Clusters that are replaced together.
#[derive(Clone, Copy, Debug)]
pub struct Group {
    /// Its first cluster; the others follow.
    pub first: u32,
    /// How many.
    pub count: u32,
    /// What of the surface may have moved, at most, if its simplification stands for it, in units, as the simplifier has it: no bound. Infinite if it has none.
    pub error: f64,
    /// Around all that it stands for, those of the groups below it included.
    pub sphere: Sphere,
    /// The box of the same.
    pub bounds: Box32,
}

impl Group {
    /// Its clusters.
    pub fn clusters(&self) -> Range<usize> {
        self.first as usize..(self.first + self.count) as usize
    }

    /// Nothing coarser stands for it.
    pub fn is_last(&self) -> bool {
        self.error.is_infinite()
    }
}

/// All clusters of a mesh; groups stand behind those whose simplifications they hold.
pub struct Graph {
    /// Where vertices lie.
    pub grid: Grid,
    /// Vertices.
    pub places: Vec<Place>,
    /// Vertices of all triangles, cluster by cluster.
    pub triangles: Vec<[u32; 3]>,
    /// The clusters, group by group.
    pub clusters: Vec<Cluster>,
    /// The groups.
    pub groups: Vec<Group>,
    /// Triangles of the mesh.
    pub finest: usize,
    /// Finest triangles of the scene that became none on the grid.
    pub collapsed: usize,
}

/// What a builder says of a group.
pub(super) struct Made {
    /// Vertices of the triangles of its clusters, and the groups whose simplifications these are parts of.
    pub clusters: Vec<(Vec<[u32; 3]>, Option<u32>)>,
    /// In units; infinite if it is never simplified.
    pub error: f64,
    /// What it says of its extent, beyond what follows from its clusters.
    pub sphere: Option<Sphere>,
}

impl Graph {
    /// Of groups, each behind those whose simplifications it holds.
    pub(super) fn new(mesh: Snapped, made: Vec<Made>) -> Self {
        let Snapped { grid, places, triangles: own, collapsed, .. } = mesh;
        let (mut triangles, mut clusters, mut groups) = (Vec::new(), Vec::<Cluster>::new(), Vec::<Group>::with_capacity(made.len()));
        for (number, Made { clusters: own, mut error, sphere }) in (0..).zip(made) {
            let first = clusters.len() as u32;
            let mut extent: Option<(Box32, Sphere)> = None;
            for (corners, refined) in own {
                let boxes = corners.iter().map(|t| Box32::of_triangle(t.map(|v| grid.point(places[v as usize]))));
                let Some(bounds) = boxes.reduce(|all, own| all.union(&own)) else { continue };
                clusters.push(Cluster { first: triangles.len() as u32, count: corners.len() as u32, group: number, refined, bounds });
                triangles.extend(corners);
                let mut grow = |bounds: Box32, sphere: Sphere| {
                    extent = Some(extent.map_or((bounds, sphere), |(all, around)| (all.union(&bounds), around.with(sphere))));
                };
                grow(bounds, Sphere::around(&bounds));
                if let Some(below) = refined.map(|below| groups[below as usize]) {
                    grow(below.bounds, below.sphere);
                    // What is off below is off above.
                    error = error.max(below.error);
                }
            }
            let (bounds, around) = extent.unwrap_or((Box32 { lo: grid.lo, hi: grid.lo }, Sphere { centre: [0.0; 3], radius: 0.0 }));
            let mut sphere = sphere.map_or(around, |own| own.with(around));
            // So that roundings let no group's sphere out of that of the group above.
            sphere.radius *= 1.0 + 1e-9;
            groups.push(Group { first, count: clusters.len() as u32 - first, error, sphere, bounds });
        }
        Self { grid, places, triangles, clusters, groups, finest: own.len(), collapsed }
    }

    /// Corners of a triangle, in units.
    #[inline]
    pub fn corners(&self, triangle: usize) -> [[i32; 3]; 3] {
        self.triangles[triangle].map(|vertex| self.grid.point(self.places[vertex as usize]))
    }

    /// Groups that nothing coarser stands for: where every choice begins.
    pub fn last(&self) -> impl Iterator<Item = u32> {
        (0..).zip(&self.groups).filter(|(_, group)| group.is_last()).map(|(number, _)| number)
    }

    /// Clusters that nothing coarser stands for, and triangles of those.
    pub fn roots(&self) -> [usize; 2] {
        let groups = || self.groups.iter().filter(|group| group.is_last());
        let triangles = |group: &Group| self.clusters[group.clusters()].iter().map(|cluster| cluster.count as usize).sum::<usize>();
        [groups().map(|group| group.count as usize).sum(), groups().map(triangles).sum()]
    }
}
