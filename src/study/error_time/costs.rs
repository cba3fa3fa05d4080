//! What frames cost on the machines.

use super::stage::Stage;
use crate::num::LINE_BYTES;
use crate::rays::Camera;
use crate::report::error_time::{Costs, Energy, WarmCosts};
use crate::report::result::SimResult;
use crate::scene::{Pass, PassRays};
use crate::study::{StudyError, Turning};

/// The results of a stage on its machines; if there is a turn, with what a warm frame takes.
pub(super) fn simulated(stage: &Stage<'_>, frame: &Camera, turning: Option<Turning>) -> Result<Vec<SimResult>, StudyError> {
    let &Stage { scene, space, chosen, method, targets, .. } = stage;
    let run = |rays| -> Result<Vec<SimResult>, StudyError> {
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
