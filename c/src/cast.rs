//! Rays cast by a method, by its name.

use crate::error::{done, guarded, refused};
use crate::pointers::{end, handle, room, shared, text};
use crate::rays::{LodrayRay, rays_at};
use crate::scene::LodrayScene;
use lodray::run::HitRow;
use lodray::scene::SceneMethod;
use lodray::study::pruned::check_normals;
use std::ffi::{c_char, c_int};

/// A way to find hits in a scene, with what it needs for that. It does not change: any number of threads may use it at once.
pub struct LodrayMethod(SceneMethod);

/// Where a ray met the surface, in the world.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LodrayHit {
    /// Distance from the origin in world units; infinite if nothing was met. What follows is -1 then, or no number.
    pub t: f64,
    /// Triangle of the finest level, of all: tree * 4^N + node there.
    pub triangle: i64,
    /// Base triangle.
    pub tree: i32,
    /// Level of the triangle that was met.
    pub level: i32,
    /// Its node on that level.
    pub node: i32,
    /// 1 if the front face was met, 0 if the back.
    pub front: i32,
    /// Point in world space.
    pub point: [f64; 3],
    /// Shading normal of length 1.
    pub normal: [f32; 3],
    /// Weights of the corners of the triangle that was met.
    pub barycentrics: [f32; 3],
    /// Weights of those of the finest triangle.
    pub finest_barycentrics: [f32; 3],
}

impl LodrayHit {
    pub(crate) fn of(row: &HitRow) -> Self {
        let HitRow { t, tree, level, node, triangle, barycentrics, finest_barycentrics, point, normal, front, .. } = *row;
        Self { t, triangle, tree, level, node, front, point, normal, barycentrics, finest_barycentrics }
    }
}

/// The method of this name ("lod", "bvh", ...), with knobs as the program's options have them: "delta=0.5 leaf-layout=block", parted by spaces; null if none is turned.
/// Null if there is no such method or knob: the error lists those that there are. End it with `lodray_method_end`; the scene may be closed before.
///
/// # Safety
/// The scene is open; `name`, and `knobs` if it is not null, are texts that end with a zero byte.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn lodray_method_new(scene: *const LodrayScene, name: *const c_char, knobs: *const c_char) -> *mut LodrayMethod {
    guarded(std::ptr::null_mut(), || {
        // SAFETY: the caller's promise.
        let (scene, name) = unsafe { (shared("scene", scene)?, text("name", name)?) };
        // SAFETY: the caller's promise.
        let knobs = if knobs.is_null() { "" } else { unsafe { text("knobs", knobs) }? };
        let mut turned = Vec::new();
        for knob in knobs.split_whitespace() {
            let Some(pair) = knob.split_once('=') else { return refused(format!("knobs: '{knob}' is not NAME=VALUE")) };
            turned.push(pair);
        }
        Ok(handle(LodrayMethod(scene.0.method_with(name, &turned)?)))
    })
}

/// Ends a method. Null does nothing.
///
/// # Safety
/// The method is null, or of `lodray_method_new`, and nobody uses it any more.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn lodray_method_end(method: *mut LodrayMethod) {
    // SAFETY: the caller's promise.
    unsafe { end(method) };
}

/// Writes the closest hit of each ray, in their order, found by all threads of the machine.
///
/// # Safety
/// The method is alive, there are `count` rays, and `hits` has room for as many.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn lodray_method_cast(
    method: *const LodrayMethod,
    rays: *const LodrayRay,
    count: u64,
    hits: *mut LodrayHit,
) -> c_int {
    done(|| {
        // SAFETY: the caller's promise.
        let (method, rays, hits) = unsafe { (shared("method", method)?, rays_at(rays, count)?, room("hits", hits, count)?) };
        check_normals(method.0.scene(), "a hit's normal")?;
        for (hit, row) in hits.iter_mut().zip(method.0.cast(&rays)) {
            hit.write(LodrayHit::of(&row));
        }
        Ok(())
    })
}

/// Writes 1 for each ray that meets anything, 0 for each other: any hit serves, so it takes less time.
///
/// # Safety
/// The method is alive, there are `count` rays, and `met` has room for as many.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn lodray_method_cast_any(method: *const LodrayMethod, rays: *const LodrayRay, count: u64, met: *mut u8) -> c_int {
    done(|| {
        // SAFETY: the caller's promise.
        let (method, rays, met) = unsafe { (shared("method", method)?, rays_at(rays, count)?, room("met", met, count)?) };
        for (met, any) in met.iter_mut().zip(method.0.meets(&rays)) {
            met.write(any.into());
        }
        Ok(())
    })
}
