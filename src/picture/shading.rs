//! What light comes back from what was hit: headlight shading, by the normals of the full resolution or by what level of detail leaves of them.
//!
//! Level of detail shows a smooth surface where there is a rough one. Samples that are spread evenly over the smooth one are not spread evenly over what
//! would be seen of the rough one: facets that face the eye show more of themselves, and the others hide behind them. `docs/appearance.md` has what was
//! tried and measured.

use crate::format::Scene;
use crate::mesh::lattice;
use crate::method::SurfaceHit;
use crate::rays::{ModelSpace, Query};
use glam::{DMat3, DVec3, Vec3};
use serde::{Deserialize, Serialize};
use std::ops::AddAssign;

/// Base colour of a scene without materials.
const GREY: Vec3 = Vec3::splat(0.8);
/// Background, linear.
pub(super) const BACKGROUND: Vec3 = Vec3::new(0.012, 0.016, 0.024);

/// Least cosines that weights divide by, of a facet's normal to the plane that was met, and of the plane to the view.
const LEAST_TILT: f32 = 0.05;
const LEAST_VIEW: f32 = 0.02;

/// Which normals a picture is shaded with.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Shading {
    /// Of the full-resolution hit, every sample alike: the paper's.
    Full,
    /// Of the triangle that was met, as it was morphed.
    Level,
    /// Of the full-resolution hit, every sample by the area that its facet shows.
    Weighted,
    /// Of all full-resolution triangles below a pixel's part of the one that was met, by what is seen of each.
    #[default]
    Facets,
}

impl Shading {
    /// All.
    pub const ALL: [Self; 4] = [Self::Full, Self::Level, Self::Weighted, Self::Facets];

    /// Its name in options and reports.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Full => "full",
            Self::Level => "level",
            Self::Weighted => "weighted",
            Self::Facets => "facets",
        }
    }

    /// One line about it.
    pub const fn help(self) -> &'static str {
        match self {
            Self::Full => "Normals of the full-resolution hit, all samples alike",
            Self::Level => "The normal of the triangle that was met",
            Self::Weighted => "Normals of the full-resolution hit, by the area that its facet shows",
            Self::Facets => {
                "Normals of all full-resolution triangles in a pixel's part of the triangle that was met, by what is seen of them"
            }
        }
    }
}

/// Shades what a scene's rays hit.
#[derive(Clone, Copy)]
pub struct Shader<'a> {
    scene: &'a Scene,
    /// World units to one of the model's.
    scale: f64,
    /// What turns areas along normals of the model's world into those of the scene that it stands in, if that is another.
    outward: Option<DMat3>,
    shading: Shading,
}

/// Light of one pixel, linear.
#[derive(Clone, Copy, Debug, Default)]
pub struct Light {
    sum: Vec3,
    weight: f32,
    /// The same where every hit has weight 1: what is left if no facet faces the eye.
    plain: Vec3,
    hits: u32,
    samples: u32,
}

impl Light {
    /// The mean over the samples: of hits by their weights, and of the background.
    pub fn mean(&self) -> Vec3 {
        if self.hits == 0 {
            return BACKGROUND;
        }
        let (hits, samples) = (self.hits as f32, self.samples as f32); // a few thousand at most
        let surface = if self.weight > 0.0 { self.sum / self.weight } else { self.plain / hits };
        (surface * hits + BACKGROUND * (samples - hits)) / samples
    }

    /// Samples that hit, of all.
    pub fn coverage(&self) -> f32 {
        self.hits as f32 / self.samples.max(1) as f32
    }
}

impl AddAssign for Light {
    /// More samples of the same pixel.
    fn add_assign(&mut self, other: Self) {
        self.sum += other.sum;
        self.weight += other.weight;
        self.plain += other.plain;
        self.hits += other.hits;
        self.samples += other.samples;
    }
}

impl<'a> Shader<'a> {
    /// Of a scene where `space` has it.
    pub fn new(scene: &'a Scene, space: &ModelSpace, shading: Shading) -> Self {
        Self { scene, scale: space.placement.scale, outward: None, shading }
    }

    /// The same of a model that stands in a larger scene, whose rays and distances are that one's: `outward` turns areas along normals, of the model's world, into those of the
    /// scene.
    #[must_use]
    pub fn standing(self, outward: DMat3) -> Self {
        Self { outward: Some(outward), ..self }
    }

    /// Full-resolution shading normal of a hit, of length 1, as rays see it.
    pub fn normal(&self, hit: &SurfaceHit) -> Vec3 {
        self.turned(hit.normal(self.scene))
    }

    /// A normal of the model, as rays see it.
    fn turned(&self, normal: Vec3) -> Vec3 {
        match self.outward {
            Some(outward) => (outward * normal.as_dvec3()).normalize_or_zero().as_vec3(),
            None => normal,
        }
    }

    /// Twice the area of a triangle along its normal, in units^2, as rays see it.
    fn area_vector(&self, corners: [[i32; 3]; 3]) -> Vec3 {
        let area = area_vector(corners);
        self.outward.map_or(area, |outward| (outward * area.as_dvec3()).as_vec3())
    }

    /// Adds a sample of a pixel: a ray, and what it hit.
    pub fn add(&self, light: &mut Light, ray: &Query, hit: Option<&SurfaceHit>) {
        light.samples += 1;
        let Some(hit) = hit else { return };
        light.hits += 1;
        let view = -DVec3::from_array(ray.direction).as_vec3();
        let material = self.scene.material(hit.tree as usize);
        let colour = self.scene.colour(material).map_or(GREY, Vec3::from_array);
        let [cosine, weight] = self.cosine(ray, view, hit);
        light.sum += colour * lit(cosine) * weight;
        light.weight += weight;
        if weight == 0.0 {
            light.plain += colour * lit(cosine);
        }
    }

    /// Cosine of what is seen to the view, and its weight in the pixel.
    fn cosine(&self, ray: &Query, view: Vec3, hit: &SurfaceHit) -> [f32; 2] {
        let normal = self.normal(hit);
        let full = normal.dot(view).abs();
        // What was met is the full resolution: nothing was left out.
        let is_finest = u32::from(hit.level) == self.scene.levels();
        let Some(plane) = hit.plane_normal().filter(|_| self.shading != Shading::Full && !is_finest) else { return [full, 1.0] };
        let plane = self.turned(plane);
        let plane = if plane.dot(view) < 0.0 { -plane } else { plane };
        let facing = plane.dot(view).max(LEAST_VIEW);
        match self.shading {
            Shading::Full => [full, 1.0],
            Shading::Level => [plane.dot(view), 1.0],
            Shading::Weighted => {
                let normal = if normal.dot(plane) < 0.0 { -normal } else { normal };
                let cosine = normal.dot(view);
                [full, cosine.max(0.0) / (normal.dot(plane).max(LEAST_TILT) * facing)]
            }
            Shading::Facets => self.patch(ray, view, hit, facing).unwrap_or([full, 0.0]),
        }
    }

    /// Mean cosine of the facets in the part of the met triangle that a pixel shows, and how much of them is seen for what is seen of it; none if no facet
    /// faces the eye.
    fn patch(&self, ray: &Query, view: Vec3, hit: &SurfaceHit, facing: f32) -> Option<[f32; 2]> {
        let (tree, level, levels) = (hit.tree as usize, u32::from(hit.level), self.scene.levels());
        let met = f64::from(self.area_vector(self.scene.triangle(tree, level, hit.node as usize)).length()) * self.scale * self.scale * 0.5;
        let pixel = (2.0 * (ray.radius + ray.tan_theta * hit.distance)).powi(2) / f64::from(facing);
        // Below it, the node of about a pixel's area around the hit.
        let splits = (0.5 * (met / pixel).log2()).round();
        let below = if splits > 0.0 { (splits as u32).min(levels - level) } else { 0 };
        let top = level + below;
        let node = (hit.full_node >> (2 * (levels - top))) as usize;
        // Of how much of the plane a facet stands: all alike, as samples are.
        let share = (met * 0.25f64.powi(below as i32) / (0.5 * self.scale * self.scale)) as f32 * facing; // at most ten splits
        let mut facets = Facets { shader: self, tree, view, turn: if hit.front { 1.0 } else { -1.0 }, sum: 0.0, weight: 0.0 };
        facets.down(top, node, self.scene.triangle(tree, top, node));
        (facets.weight > 0.0 && share > 0.0).then(|| [facets.sum / facets.weight, facets.weight / share])
    }
}

/// Headlight, from a cosine.
fn lit(cosine: f32) -> f32 {
    0.06 + 0.94 * cosine
}

/// Twice the area of a triangle along its normal, units^2.
fn area_vector(corners: [[i32; 3]; 3]) -> Vec3 {
    let [a, b, c] = corners.map(|p| DVec3::from_array(p.map(f64::from)));
    // Below 2^66.
    (b - a).cross(c - a).as_vec3()
}

/// Sums over full-resolution triangles below a node.
struct Facets<'a> {
    shader: &'a Shader<'a>,
    tree: usize,
    view: Vec3,
    /// -1 where back faces are seen.
    turn: f32,
    sum: f32,
    weight: f32,
}

impl Facets<'_> {
    /// Adds those below a node with these corners.
    fn down(&mut self, level: u32, node: usize, p: [[i32; 3]; 3]) {
        let levels = self.shader.scene.levels();
        if level == levels {
            self.facet(node as u32, p); // at most 2^20
            return;
        }
        let q = self.shader.scene.inserted(self.tree, level, node, p);
        for (k, corners) in [[p[0], q[2], q[1]], [q[2], p[1], q[0]], [q[1], q[0], p[2]], q].into_iter().enumerate() {
            self.down(level + 1, 4 * node + k, corners);
        }
    }

    fn facet(&mut self, node: u32, corners: [[i32; 3]; 3]) {
        let area = self.shader.area_vector(corners) * self.turn;
        let seen = area.dot(self.view);
        if seen <= 0.0 {
            return;
        }
        // Of a facet the area seen is its own times the cosine; of that, others hide the more the flatter it is seen: cosine^(1/2) is left.
        let weight = seen * (seen / area.length()).sqrt();
        let levels = self.shader.scene.levels();
        let points = lattice::node(levels, levels, node);
        let normal: Vec3 = points.into_iter().map(|p| Vec3::from_array(self.shader.scene.normal_at(self.tree, p))).sum();
        self.sum += weight * self.shader.turned(normal.normalize_or_zero()).dot(self.view).abs();
        self.weight += weight;
    }
}
