//! Rays in the world, and as the hardware takes them.

use crate::error::{LODRAY_ERROR, Refused, done, guarded, refused};
use crate::pointers::{array, place, room, shared};
use crate::ports::{LodrayModelRay, LodrayRayIn, LodraySecondaryIn};
use crate::scene::LodrayScene;
use lodray::rays::{Camera, Column, ModelRay, ModelSpace, Query, RAY_COLUMNS, RayRows, View};
use std::ffi::c_int;

/// A ray in the world. Set `t_max` (INFINITY if every distance counts): of a ray that is all 0 nothing counts.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
pub struct LodrayRay {
    /// Where it starts, in world units.
    pub origin: [f64; 3],
    /// Where it goes: of any length but 0.
    pub direction: [f64; 3],
    /// Radius of its cone at the origin, in world units: what a level of detail may leave out. 0 or more.
    pub radius: f64,
    /// How much the radius grows for each unit of length: the tangent of the cone's half angle. 0 or more.
    pub cone: f64,
    /// Nothing nearer counts: a distance from the origin in world units.
    pub t_min: f64,
    /// Nothing farther counts.
    pub t_max: f64,
}

/// Numbers of a ray.
const COLUMNS: usize = size_of::<LodrayRay>() / size_of::<f64>();

/// Rays of C, checked.
pub(crate) fn rows(rays: &[LodrayRay]) -> Result<RayRows<'_>, Refused> {
    let values: &[f64] = bytemuck::cast_slice(rays);
    let column = |k: usize| match k {
        k if k < COLUMNS => Column::Each { values, step: COLUMNS, first: k },
        k if k < RAY_COLUMNS - 1 => Column::All(0.0),
        // No ray starts behind another.
        _ => Column::All(-1.0),
    };
    Ok(RayRows::new(std::array::from_fn(column))?)
}

/// The one ray of a pointer to it.
fn query(ray: &LodrayRay) -> Result<Query, Refused> {
    rows(std::slice::from_ref(ray))?.query(0).map_err(Refused)
}

/// A quality that can be.
pub(crate) fn quality(delta: f64) -> Result<f64, Refused> {
    if delta >= 0.0 { Ok(delta) } else { refused(format!("delta: {delta} is not from 0 to infinity")) }
}

/// The ray and its range as ports have them.
pub(crate) fn entered(tag: u32, ray: &ModelRay) -> (LodrayRayIn, LodraySecondaryIn) {
    let [t_min, t_max] = ray.range.map(|t| t.get());
    (LodrayRayIn { tag, ray: LodrayModelRay::of(&ray.ray) }, LodraySecondaryIn { t_min, t_max, ..LodraySecondaryIn::default() })
}

/// Rounds a ray to the integers that the hardware takes, at quality `delta` (0 the base mesh, 1 a pixel's cone, INFINITY full detail), and gives it a tag. 1: it does;
/// 0: the ray misses the model's box, so there is nothing to trace, and nothing is written. What counts of `t_min` and `t_max` goes to `secondary`, which may be null: hardware for primary
/// rays counts every distance.
///
/// # Safety
/// The scene is open, `ray` a ray; `in_i`, and `secondary` if it is not null, have room for one.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn lodray_ray_enter(
    scene: *const LodrayScene,
    ray: *const LodrayRay,
    delta: f64,
    tag: u32,
    in_i: *mut LodrayRayIn,
    secondary: *mut LodraySecondaryIn,
) -> c_int {
    guarded(LODRAY_ERROR, || {
        // SAFETY: the caller's promise.
        let (scene, ray, in_i) = unsafe { (shared("scene", scene)?, shared("ray", ray)?, place("in_i", in_i)?) };
        let Some(ray) = ModelSpace::of(&scene.0).enter(&query(ray)?, quality(delta)?) else { return Ok(0) };
        let (ray, range) = entered(tag, &ray);
        in_i.write(ray);
        if !secondary.is_null() {
            // SAFETY: the caller's promise.
            unsafe { place("secondary", secondary) }?.write(range);
        }
        Ok(1)
    })
}

/// Writes the rays of a picture of `width` x `height` pixels, row by row from the upper left, each with the cone of its pixel: a camera that looks at the centre of the
/// scene from `distance` bounding radii, as `lodray render --distance` does.
///
/// # Safety
/// The scene is open, `rays` has room for width * height.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn lodray_camera_rays(
    scene: *const LodrayScene,
    distance: f64,
    width: u32,
    height: u32,
    rays: *mut LodrayRay,
) -> c_int {
    done(|| {
        // SAFETY: the caller's promise.
        let scene = unsafe { shared("scene", scene) }?;
        let camera = camera(scene, distance, width, height)?;
        // SAFETY: the caller's promise.
        let rays = unsafe { room("rays", rays, u64::from(width) * u64::from(height)) }?;
        for (k, ray) in (0..).zip(rays) {
            ray.write(LodrayRay::of(&camera.ray(k % width, k / width)));
        }
        Ok(())
    })
}

/// The camera of [`lodray_camera_rays`].
pub(crate) fn camera(scene: &LodrayScene, distance: f64, width: u32, height: u32) -> Result<Camera, Refused> {
    Ok(Camera::new(&View { distance: Some(distance), ..View::default() }, &ModelSpace::of(&scene.0), width, height)?)
}

impl LodrayRay {
    fn of(query: &Query) -> Self {
        let Query { origin, direction, radius, tan_theta, t_min, t_max, .. } = *query;
        Self { origin, direction, radius, cone: tan_theta, t_min, t_max }
    }
}

/// Rays at a pointer, checked.
///
/// # Safety
/// As of [`array()`].
pub(crate) unsafe fn rays_at<'a>(rays: *const LodrayRay, count: u64) -> Result<RayRows<'a>, Refused> {
    // SAFETY: the caller's promise.
    rows(unsafe { array("rays", rays, count) }?)
}
