//! What a scene and a job need of a traversal unit, and so what can be left out.
//!
//! [`SceneNeeds`] is measured on every node of a scene's trees and quad-BVH, [`RayNeeds`] on every ray of a job. All are exact: a width is the least that holds
//! every number met, a level is unneeded only if no ray of the job can go down to it. [`Speed`] is simulated: what keeps a share of the job's frame rate.

mod data;
mod measure;
mod needs;
mod possible;
mod rays;
mod reach;
mod region;
mod report;
mod scene;
mod speed;
mod within;

pub use data::Data;
pub use measure::Measure;
pub use possible::Impossible;
pub use rays::RayNeeds;
pub use reach::Reach;
pub use report::{Part, Saving, savings};
pub use scene::SceneNeeds;
pub use speed::Speed;
pub use within::{Narrowest, Within};

use crate::format::{Job, JobRegion, JobView};
use crate::hardware::Hardware;
use crate::num::{BOX_SHIFT, MOST_DIRECTION_ZEROS};
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use thiserror::Error;

/// What is needed for some scenes and a job, as `lodray plan` writes it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct Plan {
    /// Version of the program that wrote it.
    pub program: String,
    /// Names of the scenes.
    pub scenes: Vec<String>,
    /// Of the scenes, each the most of all.
    pub scene: SceneNeeds,
    /// Of the rays of the job; nothing where no job was given: any ray can come.
    pub rays: Option<RayNeeds>,
    /// The grids that the scenes are to be on, if they were asked for: `lodray prune` puts them there.
    pub within: Option<Within>,
    /// Of the machine's units, if it was searched for. Whatever does not fit, it is not this.
    pub speed: Option<Speed>,
    /// The views of the job, by the name of the scene that they are of.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub views: BTreeMap<String, Vec<JobView>>,
    /// And its regions.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub regions: BTreeMap<String, Vec<JobRegion>>,
}

/// A scene or a ray that a plan is too narrow for.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
#[error("{what} does not fit the plan: {field} is {value}, and the plan has {planned}")]
pub struct Misfit {
    what: String,
    field: String,
    value: u64,
    planned: u64,
}

impl Plan {
    /// The plan of no scene and no ray.
    pub fn new(rays: bool) -> Self {
        let program = env!("CARGO_PKG_VERSION").to_owned();
        let rays = rays.then(RayNeeds::default);
        Self {
            program,
            scenes: Vec::new(),
            scene: SceneNeeds::default(),
            rays,
            within: None,
            speed: None,
            views: BTreeMap::new(),
            regions: BTreeMap::new(),
        }
    }

    /// Makes room for a scene.
    pub fn add(&mut self, name: &str, needs: &SceneNeeds) {
        self.scenes.push(name.to_owned());
        self.scene = self.scene.with(needs);
    }

    /// Makes room for rays, if the plan is of some.
    pub fn add_rays(&mut self, needs: &RayNeeds) {
        self.rays = self.rays.as_ref().map(|rays| rays.with(needs));
    }

    /// Adds a view of a scene, whose file has this name, once.
    pub fn add_view(&mut self, name: &str, view: JobView) {
        let views = self.views.entry(name.to_owned()).or_default();
        if !views.contains(&view) {
            views.push(view);
        }
    }

    /// Adds a region of a scene likewise.
    pub fn add_region(&mut self, name: &str, region: JobRegion) {
        let regions = self.regions.entry(name.to_owned()).or_default();
        if !regions.contains(&region) {
            regions.push(region);
        }
    }

    /// The rays of a scene, by the name in its file; nothing if there are none of it.
    pub fn job(&self, name: &str) -> Option<Job> {
        let (views, regions) = (self.views.get(name), self.regions.get(name));
        (views.is_some() || regions.is_some()).then(|| Job {
            views: views.cloned().unwrap_or_default(),
            regions: regions.cloned().unwrap_or_default(),
            unshaded: false,
        })
    }

    /// A hardware for it, `hardware` in all that a plan does not say.
    pub fn hardware(&self, hardware: &Hardware) -> Hardware {
        let SceneNeeds { levels, stored_levels, bvh_depth, stack_entries, .. } = self.scene;
        let (levels, bvh_depth) = (levels.clamp(Hardware::LEAST_LEVELS, hardware.levels), bvh_depth.clamp(1, hardware.bvh_depth));
        // Nodes of the deepest level that rays reach are nodes, and not triangles, where trees are stored deeper.
        let reached = self.rays.map_or(stored_levels, |rays| stored_levels.min(rays.deepest_level + 1));
        let most = self.features(&Hardware {
            levels,
            fewer_stored_levels: Some(reached.min(levels)),
            bvh_depth,
            fewer_stack_entries: None,
            ..*hardware
        });
        let fewer_stack_entries = Some(stack_entries.clamp(2, most.stack_entries()));
        let speed = self.speed.as_ref().map_or(*hardware, |speed| speed.units.config());
        let [coordinate_zeros, direction_zeros] = self.zeros();
        Hardware { fewer_stack_entries, coordinate_zeros, direction_zeros, ..most.as_fast_as(&speed) }
    }

    /// A hardware with no more of these than the plan needs.
    fn features(&self, hardware: &Hardware) -> Hardware {
        let SceneNeeds { bvh_node_bits, tree_bits, compact, exact, .. } = self.scene;
        let any = RayNeeds { lod_test: true, hit_mapping: self.scene.levels > 0, start_radius: true, ..RayNeeds::default() };
        let rays = self.rays.unwrap_or(any);
        Hardware {
            index_bits: bvh_node_bits.max(tree_bits).clamp(hardware.node_bits(), hardware.index_bits),
            lod_test: rays.lod_test && hardware.lod_test,
            start_radius: rays.start_radius && hardware.start_radius,
            hit_mapping: rays.hit_mapping && hardware.hit_mapping,
            compact_vertices: compact,
            exact_vertices: exact,
            ..*hardware
        }
    }

    /// Zero bits at the bottom of coordinates and of directions that a hardware can leave out.
    fn zeros(&self) -> [u32; 2] {
        let of_rays = self.rays.map_or(0, |rays| rays.direction_zeros);
        [self.scene.coordinate_zeros.min(BOX_SHIFT), self.scene.direction_zeros.max(of_rays).min(MOST_DIRECTION_ZEROS)]
    }

    /// Has the scenes on coarser grids.
    pub fn coarsen(&mut self, within: Within) {
        self.scene.coordinate_zeros = self.scene.coordinate_zeros.max(within.coordinate_zeros);
        self.scene.direction_zeros = self.scene.direction_zeros.max(within.direction_zeros);
        self.within = Some(within);
    }

    /// Checks that a scene fits.
    ///
    /// # Errors
    /// The first field that is too narrow.
    pub fn check(&self, name: &str, needs: &SceneNeeds) -> Result<(), Misfit> {
        fits(&format!("scene {name}"), &self.scene, needs)
    }

    /// Checks that the rays of a job fit; any do if the plan is of none.
    ///
    /// # Errors
    /// The first field that is too narrow.
    pub fn check_rays(&self, what: &str, needs: &RayNeeds) -> Result<(), Misfit> {
        self.rays.as_ref().map_or(Ok(()), |rays| fits(what, rays, needs))
    }
}

/// The numbers of a struct of needs, by name.
fn numbers<T: Serialize>(of: &T) -> BTreeMap<String, u64> {
    let value = serde_json::to_value(of).unwrap_or_default();
    let fields = value.as_object().into_iter().flatten();
    // What is true is needed, as what is 1 is.
    let number = |value: &serde_json::Value| value.as_u64().or_else(|| value.as_bool().map(u64::from));
    fields.filter_map(|(name, value)| Some((name.clone(), number(value)?))).collect()
}

fn fits<T: Serialize>(what: &str, planned: &T, needs: &T) -> Result<(), Misfit> {
    let planned = numbers(planned);
    for (field, value) in numbers(needs) {
        let has = planned.get(&field).copied().unwrap_or(0);
        // Of zeros at the bottom of numbers a scene must have as many as were left out.
        let narrow = if field.ends_with("-zeros") { value < has } else { value > has };
        if narrow {
            return Err(Misfit { what: what.to_owned(), field, value, planned: has });
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_field_one_too_narrow_is_named() {
        let wide = SceneNeeds { levels: 5, bvh_depth: 5, coordinate_zeros: 3, ..SceneNeeds::default() };
        let mut plan = Plan::new(false);
        plan.add("wide", &wide);
        assert_eq!(plan.check("wide", &wide), Ok(()));
        let named = |needs: SceneNeeds| plan.check("it", &needs).expect_err("too narrow").to_string();
        assert_eq!(named(SceneNeeds { levels: 6, ..wide }), "scene it does not fit the plan: levels is 6, and the plan has 5");
        assert_eq!(
            named(SceneNeeds { coordinate_zeros: 2, ..wide }),
            "scene it does not fit the plan: coordinate-zeros is 2, and the plan has 3"
        );
        // Each field that there is.
        for field in numbers(&wide).keys() {
            let mut value = serde_json::to_value(wide).expect("numbers");
            let old = &value[field];
            value[field] = match (old.as_bool(), old.as_u64()) {
                (Some(_), _) => true.into(),
                (_, Some(old)) if field.ends_with("-zeros") => (old - 1).into(),
                (_, old) => (old.expect("a number") + 1).into(),
            };
            let narrow: SceneNeeds = serde_json::from_value(value).expect("needs");
            assert!(named(narrow).contains(&format!(": {field} is ")), "{field}");
        }
    }
}
