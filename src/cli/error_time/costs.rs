//! What frames cost on the machines: of a view's own size, and of others.

use super::measure::{Bench, Stage};
use crate::cli::frames::Turning;
use crate::cli::sweep::ViewJob;
use crate::cli::workers::at_once;
use lodray::num::LINE_BYTES;
use lodray::rays::Camera;
use lodray::report::error_time::{Costs, Energy, SizeCosts, WarmCosts};
use lodray::report::result::SimResult;
use lodray::scene::{Pass, PassRays};

/// Sizes of the frame at which methods are compared, where they are no larger than the view's own, which is the last.
const SIZES: [[u32; 2]; 5] = [[128, 128], [256, 256], [512, 512], [1024, 1024], [1920, 1080]];

/// The results of a stage on its machines; if there is a turn, with what a warm frame takes.
pub(super) fn simulated(stage: &Stage<'_>, frame: &Camera, turning: Option<Turning>) -> anyhow::Result<Vec<SimResult>> {
    let &Stage { scene, space, chosen, method, targets, .. } = stage;
    let run = |rays| -> anyhow::Result<Vec<SimResult>> {
        let pass = Pass { scene, space, registered: chosen.method, knobs: &chosen.knobs, method, rays };
        pass.run(targets, &mut |_| ()).into_iter().map(|outcome| Ok(outcome?.0)).collect()
    };
    let mut results = run(PassRays::Camera(*frame))?;
    if let Some(turning) = turning {
        let several = run(PassRays::Path(turning.path(frame)))?;
        results.iter_mut().zip(several).for_each(|(result, several)| result.warm = several.warm);
    }
    Ok(results)
}

/// Those of [`SIZES`] with fewer pixels than `own`, and `own`.
fn sizes(own: [u32; 2]) -> Vec<[u32; 2]> {
    let pixels = |[width, height]: [u32; 2]| u64::from(width) * u64::from(height);
    SIZES.into_iter().filter(|&size| pixels(size) < pixels(own)).chain([own]).collect()
}

impl Bench<'_> {
    /// What each method costs as it is if nothing is chosen, at several sizes of a view's frame.
    pub(super) fn sizes(&self, view: &ViewJob) -> anyhow::Result<Vec<SizeCosts>> {
        let mut all = Vec::new();
        for size in sizes(view.size) {
            let frame = ViewJob { size, ..view.clone() }.camera(&self.space)?;
            let defaults = self.defaults(&frame);
            let results = at_once(&defaults, |(at, setting)| simulated(&self.stage(*at, setting), &frame, None));
            for ((_, setting), results) in defaults.iter().zip(results) {
                all.push(SizeCosts {
                    view: 0,
                    size,
                    method: setting.chosen.method.name.to_owned(),
                    setting: setting.words.clone(),
                    costs: results?.iter().enumerate().map(|(machine, result)| costs(machine, result)).collect(),
                });
            }
        }
        Ok(all)
    }
}

/// The costs of a result.
pub(super) fn costs(machine: usize, result: &SimResult) -> Costs {
    let energy = &result.energy;
    Costs {
        machine,
        compute: result.setup.compute.name().to_owned(),
        cycles: result.cycles,
        milliseconds: result.milliseconds,
        energy: Energy {
            unit: energy.unit.clone(),
            total: energy.total,
            l1: energy.l1.total,
            l2: energy.l2.total,
            dram: energy.dram.total,
            compute: energy.compute.total,
            leakage: energy.leakage.total,
        },
        dram_lines: result.dram.reads + result.dram.writes,
        dram_bytes: (result.traffic.bytes_per_ray.dram * result.rays as f64).round() as u64,
        l1_requests_per_ray: result.accesses_per_ray,
        unit_gates: None,
        warm: result.warm.map(|warm| WarmCosts {
            milliseconds: warm.cycles / (f64::from(result.setup.machine.description.cores.clock_mhz) * 1e3),
            energy: warm.energy,
            dram_lines: warm.dram_bytes / LINE_BYTES as f64,
        }),
    }
}

#[cfg(test)]
mod tests {
    use super::sizes;

    #[test]
    fn no_size_is_larger_than_the_named_one() {
        assert_eq!(sizes([1920, 1080]), [[128, 128], [256, 256], [512, 512], [1024, 1024], [1920, 1080]]);
        assert_eq!(sizes([512, 512]), [[128, 128], [256, 256], [512, 512]]);
        assert_eq!(sizes([1000, 100]), [[128, 128], [256, 256], [1000, 100]]);
        assert_eq!(sizes([48, 48]), [[48, 48]]);
    }
}
