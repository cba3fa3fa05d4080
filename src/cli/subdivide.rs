//! `build --subdivide`: a mesh whose own faces are split, by Loop's or Catmull and Clark's rules or where they lie, with a displacement map over them.

use super::form::FormArgs;
use super::memory::check_memory;
use super::mesh::{MeshArgs, Source};
use super::names::Named;
use super::output::{busy, warn};
use anyhow::Context;
use lodray::format::Scene;
use lodray::mesh::{
    CornerTexture, Displacement, HeightMap, SubdivideError, Surface, TriangleMesh, catmull_clark_surface, check_subdivision, displace,
    flat_surface, levels_for_map, loop_surface,
};
use lodray::num::MAX_LEVELS;
use lodray::scene::BuildOptions;
use serde_json::json;
use std::path::{Path, PathBuf};

/// Splits of a mesh without a map if none are asked for.
const DEFAULT_LEVELS: u32 = 3;

/// Where splits put vertices.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Rule {
    Loop,
    CatmullClark,
    Flat,
}

impl Named for Rule {
    const ALL: &'static [Self] = &[Self::Loop, Self::CatmullClark, Self::Flat];

    fn name(self) -> &'static str {
        match self {
            Self::Loop => "loop",
            Self::CatmullClark => "catmull-clark",
            Self::Flat => "flat",
        }
    }

    fn about(self) -> &'static str {
        match self {
            Self::Loop => "On the limit surface of Loop's rules, whose control net the mesh is",
            Self::CatmullClark => {
                "On the limit surface of Catmull and Clark's rules, whose control net the mesh's polygons are: two base triangles for each quad"
            }
            Self::Flat => "On the triangles themselves",
        }
    }
}

/// How a mesh is split, if it is not made anew.
#[derive(clap::Args)]
pub struct SubdivideArgs {
    /// Split the mesh's own faces rather than make a base mesh
    #[arg(long, value_name = "RULE", value_parser = super::names::named::<Rule>(), conflicts_with_all = ["max_error", "base"])]
    subdivide: Option<Rule>,
    /// Displacement map: PNG or JPEG (black is height 0, white 1) or OpenEXR, laid over the mesh by its texture coordinates, repeated beyond them. Splits the mesh as --subdivide says (default flat)
    #[arg(long, value_name = "FILE", requires = "amount", conflicts_with_all = ["max_error", "base"])]
    displace: Option<PathBuf>,
    /// How far a height of 1 moves the surface along its normal, in the mesh's own units
    #[arg(long, value_name = "DISTANCE", requires = "displace", value_parser = finite, allow_negative_numbers = true)]
    amount: Option<f64>,
    /// Height that moves nothing (default 0)
    #[arg(long, value_name = "HEIGHT", requires = "displace", value_parser = finite, allow_negative_numbers = true)]
    middle: Option<f64>,
}

impl SubdivideArgs {
    /// Whether the mesh's own faces are split.
    pub fn is_wanted(&self) -> bool {
        self.subdivide.is_some() || self.displace.is_some()
    }

    /// Where splits put vertices.
    fn rule(&self) -> Rule {
        self.subdivide.unwrap_or(Rule::Flat)
    }

    /// Whether edges may stay sharp by their angle: other rules have the whole surface smooth.
    pub fn has_creases(&self) -> bool {
        self.rule() == Rule::Flat
    }

    /// The displacement map's file.
    pub fn map(&self) -> Option<&Path> {
        self.displace.as_deref()
    }

    /// Makes the scene. What is lost of the mesh is an error if `strict`; without `levels`, splits are three, or as many as give a point for each texel of the map.
    pub fn make(
        &self,
        source: &Source,
        reading: &MeshArgs,
        levels: Option<u32>,
        crease_angle: f64,
        form: FormArgs,
        strict: bool,
    ) -> anyhow::Result<Scene> {
        let displacement = self.displacement()?;
        let mesh = reading.read(source, strict)?;
        let name = || source.path.display().to_string();
        let rule = self.rule();
        if rule != Rule::Flat && !mesh.normals.is_empty() {
            source.lost("its shading normals are not kept: the subdivided surface has its own", strict)?;
        }
        let triangles = mesh.triangles.len() as u64;
        let levels = levels.unwrap_or_else(|| match &displacement {
            Some(by) => levels_for_map(&mesh.texture, &by.map, MAX_LEVELS),
            None => DEFAULT_LEVELS,
        });
        check_subdivision(triangles, levels).with_context(name)?;
        // The last net of Loop's rules, its limit and the surface together at their peak: 101 were measured on a scan of 69,451 triangles, split three times.
        const BYTES_PER_TRIANGLE: u64 = 105;
        check_memory(levels, triangles << (2 * levels), BYTES_PER_TRIANGLE, "take fewer levels or a smaller mesh").with_context(name)?;
        let (mut surface, texture) = busy("subdividing", || split(rule, &mesh, levels, crease_angle)).with_context(name)?;
        let mut origin = json!({ "rule": rule.name(), "levels": levels });
        if let (Some(by), Some(map)) = (&displacement, &self.displace) {
            let done = busy("displacing", || displace(&mut surface, &texture, by)).with_context(name)?;
            let file = map.file_name().map_or_else(String::new, |name| name.to_string_lossy().into_owned());
            origin["displace"] = json!({ "map": file, "size": by.map.size(), "amount": by.amount, "middle": by.middle, "moved": done });
            if done.seam_points > 0 {
                let of =
                    "points of shared edges lie on seams of the map or on creases, and go to the mean of their places, which are at most";
                warn(&format!("note: {}: {} {of} {:.3e} apart", source.path.display(), done.seam_points, done.seam_gap));
            }
        }
        let form =
            BuildOptions { name: source.name(), ..form.options() }.with_origin("subdivide", origin).with_origin("mesh", json!(mesh.report));
        drop(mesh);
        busy("encoding", || Scene::of_surface(&surface, &form)).with_context(name)
    }

    fn displacement(&self) -> anyhow::Result<Option<Displacement>> {
        let Some(file) = &self.displace else { return Ok(None) };
        let map = busy("reading the map", || HeightMap::read(file)).with_context(|| file.display().to_string())?;
        Ok(Some(Displacement { map, amount: self.amount.unwrap_or(0.0), middle: self.middle.unwrap_or(0.0) }))
    }
}

/// The split surface, and the texture coordinates of its base triangles.
fn split(rule: Rule, mesh: &TriangleMesh, levels: u32, crease_angle: f64) -> Result<(Surface, CornerTexture), SubdivideError> {
    let surface = match rule {
        Rule::Loop => loop_surface(mesh, levels)?,
        Rule::Flat => flat_surface(mesh, levels, crease_angle)?,
        Rule::CatmullClark => return catmull_clark_surface(mesh, levels),
    };
    Ok((surface, mesh.texture.clone()))
}

fn finite(s: &str) -> Result<f64, String> {
    s.parse::<f64>().ok().filter(|v| v.is_finite()).ok_or_else(|| format!("'{s}' is not a number"))
}
