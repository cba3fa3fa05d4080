//! Rays that come from a scene in which the model stands somewhere.

use super::model::Model;
use super::rays::{Shot, pick};
use crate::num::{DIRECTION_SCALE, Random, Ray};
use crate::paths::Pose;
use crate::rays::Query;
use glam::DVec3;

/// A pose: squeezed along two directions by up to 10^5.9, just within what a pose may be; of any size, mirrored or not, up to a million sizes away.
fn pose(model: &Model, random: &mut Random) -> Pose {
    loop {
        let vector = |random: &mut Random| DVec3::new(random.signed(), random.signed(), random.signed());
        // Two rotations around a stretch along axes: any map, its stretches known.
        let turn = |random: &mut Random| {
            let (x, y) = (vector(random).try_normalize().unwrap_or(DVec3::X), vector(random));
            let z = x.cross(y).try_normalize().unwrap_or(x.any_orthonormal_vector());
            [x, z.cross(x), z]
        };
        let (before, after) = (turn(random), turn(random));
        let stretch =
            [1.0, 10f64.powf(-5.9 * random.signed().abs()), pick(&[1.0, -1.0], random) * 10f64.powf(-5.9 * random.signed().abs())];
        let size = pick(&[1e-6, 1e-3, 1.0, 1e3, 1e6], random);
        let away = vector(random) * (pick(&[0.0, 1.0, 1e3, 1e6], random) * size * model.space.radius());
        let linear = |row: usize, column: usize| -> f64 { (0..3).map(|k| size * after[k][row] * stretch[k] * before[k][column]).sum() };
        let rows = [0, 1, 2].map(|row| [linear(row, 0), linear(row, 1), linear(row, 2), away[row]]);
        if let Ok(pose) = Pose::affine(rows) {
            return pose;
        }
    }
}

/// Takes a ray out to such a scene, in floats, and back into fixed point, as rays of a scene come in. Gives none if it then misses the model's box. Its cone stays.
pub(super) fn placed(model: &Model, shot: &Shot, random: &mut Random) -> Option<Shot> {
    let (pose, placement) = (pose(model, random), model.space.placement);
    let own = DVec3::from_array(placement.offset) + DVec3::from_array(shot.ray.origin.get().map(|v| v as f64)) * placement.scale;
    let direction = DVec3::from_array(shot.ray.direction.get().map(|v| v as f64 / f64::from(DIRECTION_SCALE)));
    let direction = pose.way(direction).try_normalize()?;
    let (query, _) = pose.enter(&Query::new(pose.out(own).to_array(), direction.to_array()));
    let ray = model.space.enter(&query, 1.0)?.ray;
    Some(Shot { ray: Ray { cone: shot.ray.cone, ..ray }, view: None, other: shot.other })
}
