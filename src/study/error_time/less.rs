//! What a view costs in error, area and bytes where a scene and a unit have no more than it needs.

use super::measure::Bench;
use super::stage::{Cameras, Stage};
use crate::bvh::over_trees;
use crate::format::{Job, Scene};
use crate::hardware::unit_gates;
use crate::method::lod;
use crate::picture::Frame;
use crate::plan::{Measure, Narrowest, Plan, Reach, Within};
use crate::rays::{Camera, ModelSpace};
use crate::report::error_time::LeftOut;
use crate::report::result::MachineFacts;
use crate::scene::Target;
use crate::study::{Chosen, StudyError, busy};
use image::RgbImage;

/// A scene with less in it, and its unit.
struct Less {
    scene: Scene,
    plan: Plan,
}

impl Less {
    /// What the rays of a camera read of a scene, and the unit for that.
    fn of(scene: &Scene, camera: &Camera, delta: f64) -> Result<Self, StudyError> {
        let reach = Reach::of(scene);
        reach.add(camera, delta);
        let scene = reach.pruned(Job { views: vec![camera.job_view(delta)], ..Job::default() })?;
        let measure = Measure::of(&scene);
        let mut plan = Plan::new(true);
        plan.add(&scene.meta().name, &measure.needs());
        plan.add_rays(&measure.rays(camera, delta));
        Ok(Self { scene, plan })
    }
}

impl Bench<'_> {
    /// The view with lod as it is by default: all of the scene on the machines' own units; what the view needs on units for that; and the same on the coarsest grids within
    /// each of so many pixels. Nothing if none are asked for.
    pub fn left_out(&self, cameras: &Cameras, full: &RgbImage, truth: &Frame) -> Result<Vec<LeftOut>, StudyError> {
        let camera = &cameras.frame;
        let within = &self.plan.within;
        // It is one of the methods where this is asked for.
        let lod = self.plan.jobs.methods.iter().find(|chosen| *chosen.method == lod::METHOD);
        let Some(base) = lod.filter(|_| !within.is_empty()) else { return Ok(Vec::new()) };
        let knobs = base.method.error.map_or_else(|| base.knobs.clone(), |error| base.knobs.clone().without(error.knob));
        let chosen = Chosen { method: base.method, knobs };
        let seen = |what: String, grids: Option<Within>, [scene, all]: [&Scene; 2], targets: &[Target]| -> Result<LeftOut, StudyError> {
            let (space, method) = (ModelSpace::of(scene), chosen.make(scene, self.cache, self.progress)?.0);
            let stage = Stage { scene, all, space: &space, method: &*method, chosen: &chosen, targets };
            let seen = self.seen(&stage, cameras, full)?;
            let geometry = self.surface(&stage, &cameras.few, truth).errors;
            let point = self.point(&format!("delta {}", chosen.delta()), 1, &seen.results, seen.errors, geometry)?;
            let mut left = LeftOut {
                what,
                pixels: grids.map_or(0.0, |grids| grids.pixels),
                coordinate_zeros: scene.meta().coordinate_zeros,
                direction_zeros: scene.meta().direction_zeros,
                point,
            };
            for (costs, target) in left.point.costs.iter_mut().zip(targets) {
                costs.unit_gates = lod::METHOD.unit.and_then(|unit| unit_gates(unit, &target.machine.description.units.config()));
            }
            Ok(left)
        };
        let own = &self.plan.jobs.targets;
        let mut all = vec![seen("whole".to_owned(), None, [self.scene; 2], own)?];
        let mut add = |what: String, grids: Option<Within>, scene: &Scene| -> Result<(), StudyError> {
            let less = busy(self.progress, "leaving out", || Less::of(scene, camera, chosen.delta()))?;
            let mut targets = own.clone();
            targets.iter_mut().for_each(|target| in_machine(&less.plan, &what, &mut target.machine));
            all.push(seen(what, grids, [&less.scene, scene], &targets)?);
            Ok(())
        };
        add("lossless".to_owned(), None, self.scene)?;
        for &pixels in within {
            let grids = Within::of(self.scene, &Narrowest::of(&self.space, camera), pixels);
            let coarse =
                busy(self.progress, "coarser grids", || self.scene.coarsened([grids.coordinate_zeros, grids.direction_zeros], over_trees))?;
            add(format!("within {pixels}"), Some(grids), &coarse)?;
        }
        Ok(all)
    }
}

/// Has a machine's units as the plan of this file has them.
pub fn in_machine(plan: &Plan, name: &str, machine: &mut MachineFacts) {
    let units = &mut machine.description.units;
    let own = plan.hardware(&units.config());
    // Contexts, edges, boxes and bits of a cycle are the machine's own where no frame was simulated.
    (units.contexts, units.edges_per_cycle) = (own.contexts as u32, own.edges_per_cycle.count()); // at most 64
    units.lod_edges_per_cycle = own.lod_edges_per_cycle.count();
    units.boxes_per_cycle = own.boxes_per_cycle.count();
    (units.divide_bits, units.setup_bits) = (own.divide_bits, own.setup_bits);
    (units.setup_copies, units.divide_copies) = (own.setup_copies, own.divide_copies);
    units.like = Some(own);
    machine.set.push(format!("plan={name}"));
}
