//! What a view costs in error, area and bytes where a scene and a unit have no more than it needs.

use super::measure::Bench;
use super::stage::{Cameras, Stage};
use crate::cli::bars::Bars;
use crate::cli::output::busy;
use crate::cli::plan::in_machine;
use image::RgbImage;
use lodray::bvh::over_trees;
use lodray::format::{Job, Scene};
use lodray::hardware::unit_gates;
use lodray::method::lod;
use lodray::picture::Frame;
use lodray::plan::{Measure, Narrowest, Plan, Reach, Within};
use lodray::rays::{Camera, ModelSpace};
use lodray::report::error_time::LeftOut;
use lodray::scene::Target;
use lodray::study::Chosen;

/// A scene with less in it, and its unit.
struct Less {
    scene: Scene,
    plan: Plan,
}

impl Less {
    /// What the rays of a camera read of a scene, and the unit for that.
    fn of(scene: &Scene, camera: &Camera, delta: f64) -> anyhow::Result<Self> {
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
    pub fn left_out(&self, cameras: &Cameras, full: &RgbImage, truth: &Frame) -> anyhow::Result<Vec<LeftOut>> {
        let camera = &cameras.frame;
        let within = &self.plan.within;
        // It is one of the methods where this is asked for.
        let lod = self.plan.jobs.methods.iter().find(|chosen| *chosen.method == lod::METHOD);
        let Some(base) = lod.filter(|_| !within.is_empty()) else { return Ok(Vec::new()) };
        let knobs = base.method.error.map_or_else(|| base.knobs.clone(), |error| base.knobs.clone().without(error.knob));
        let chosen = Chosen { method: base.method, knobs };
        let seen = |what: String, grids: Option<Within>, [scene, all]: [&Scene; 2], targets: &[Target]| -> anyhow::Result<LeftOut> {
            let (space, method) = (ModelSpace::of(scene), chosen.make(scene, self.cache, &Bars)?.0);
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
        let mut add = |what: String, grids: Option<Within>, scene: &Scene| -> anyhow::Result<()> {
            let less = busy("leaving out", || Less::of(scene, camera, chosen.delta()))?;
            let mut targets = own.clone();
            targets.iter_mut().for_each(|target| in_machine(&less.plan, &what, &mut target.machine));
            all.push(seen(what, grids, [&less.scene, scene], &targets)?);
            Ok(())
        };
        add("lossless".to_owned(), None, self.scene)?;
        for &pixels in within {
            let grids = Within::of(self.scene, &Narrowest::of(&self.space, camera), pixels);
            let coarse = busy("coarser grids", || self.scene.coarsened([grids.coordinate_zeros, grids.direction_zeros], over_trees))?;
            add(format!("within {pixels}"), Some(grids), &coarse)?;
        }
        Ok(all)
    }
}
