//! The golden traverser: what a ray meets by the definition, bit for bit.

use crate::cast::LodrayHit;
use crate::error::{Refused, done, guarded, refused};
use crate::pointers::{array, end, handle, room, shared};
use crate::ports::{LodrayHitOut, LodrayRayIn, LodraySecondaryIn};
use crate::rays::{LodrayRay, entered, quality, rays_at};
use crate::scene::LodrayScene;
use lodray::hardware::ports::{HitOut, RayIn};
use lodray::num::{RayT, U};
use lodray::scene::Golden;
use lodray::study::pruned::check_normals;
use std::ffi::c_int;

/// The golden traverser of a scene: exact arithmetic, no block of the hardware, slow. It does not change: any number of threads may use it at once.
pub struct LodrayGolden(pub(crate) Golden);

/// What a ray of the world meets by the definition.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LodrayGoldenHit {
    /// In the world, as `lodray_method_cast` has it.
    pub hit: LodrayHit,
    /// 1: the ray meets the model's box, so that hardware is given it. 0: all that follows is 0.
    pub entered: u8,
    /// The ray as hardware is given it; its tag is its number among the rays.
    pub in_i: LodrayRayIn,
    /// The range of t that counts, for hardware that takes one.
    pub secondary_i: LodraySecondaryIn,
    /// What hardware must give.
    pub out_o: LodrayHitOut,
}

/// The golden traverser of a scene. It unpacks the scene: some twenty bytes for each finest triangle. Null if the scene is. End it with `lodray_golden_end`; the scene may be closed before.
///
/// # Safety
/// The scene is open.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn lodray_golden_new(scene: *const LodrayScene) -> *mut LodrayGolden {
    guarded(std::ptr::null_mut(), || {
        // SAFETY: the caller's promise.
        let scene = unsafe { shared("scene", scene) }?;
        Ok(handle(LodrayGolden(scene.0.golden())))
    })
}

/// Ends a golden traverser. Null does nothing.
///
/// # Safety
/// It is null, or of `lodray_golden_new`, and nobody uses it any more.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn lodray_golden_end(golden: *mut LodrayGolden) {
    // SAFETY: the caller's promise.
    unsafe { end(golden) };
}

/// Writes what each ray of the world meets first at quality `delta`, in floats and as hardware must give it, in their order, found by all threads of the machine.
///
/// # Safety
/// The traverser is alive, there are `count` rays, and `hits` has room for as many.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn lodray_golden_cast(
    golden: *const LodrayGolden,
    rays: *const LodrayRay,
    count: u64,
    delta: f64,
    hits: *mut LodrayGoldenHit,
) -> c_int {
    done(|| {
        // SAFETY: the caller's promise.
        let (golden, rays, hits) = unsafe { (shared("golden", golden)?, rays_at(rays, count)?, room("hits", hits, count)?) };
        check_normals(golden.0.scene(), "a hit's normal")?;
        let judged = golden.0.cast(&rays, quality(delta)?);
        for ((tag, hit), judged) in (0u32..).zip(hits.iter_mut()).zip(judged) {
            let (in_i, secondary_i) = judged.ray.map(|ray| entered(tag, &ray)).unwrap_or_default();
            let out =
                HitOut { tag: U::new(tag.into()), found: judged.hit.is_some(), hit: judged.hit.unwrap_or_default(), ..HitOut::default() };
            let out_o = if judged.ray.is_some() { LodrayHitOut::of(&out) } else { LodrayHitOut::default() };
            hit.write(LodrayGoldenHit { hit: LodrayHit::of(&judged.row), entered: judged.ray.is_some().into(), in_i, secondary_i, out_o });
        }
        Ok(())
    })
}

/// Writes 1 for each ray of the world that meets anything at quality `delta`, 0 for each other.
///
/// # Safety
/// The traverser is alive, there are `count` rays, and `met` has room for as many.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn lodray_golden_cast_any(
    golden: *const LodrayGolden,
    rays: *const LodrayRay,
    count: u64,
    delta: f64,
    met: *mut u8,
) -> c_int {
    done(|| {
        // SAFETY: the caller's promise.
        let (golden, rays, met) = unsafe { (shared("golden", golden)?, rays_at(rays, count)?, room("met", met, count)?) };
        for (met, judged) in met.iter_mut().zip(golden.0.cast(&rays, quality(delta)?)) {
            met.write(judged.hit.is_some().into());
        }
        Ok(())
    })
}

/// Writes what hardware must give for each of its own rays: `out_o` of `in_i`. Of `secondary_i`, which may be null, the range of t counts; a ray for which any hit serves gets
/// its closest, of which only `found` must be the hardware's. Rays that start on a surface (`fraction`, `prior`) are refused.
///
/// # Safety
/// The traverser is alive, there are `count` rays, and as many `secondary_i` if it is not null; `out_o` has room for as many.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn lodray_golden_trace(
    golden: *const LodrayGolden,
    in_i: *const LodrayRayIn,
    secondary_i: *const LodraySecondaryIn,
    count: u64,
    out_o: *mut LodrayHitOut,
) -> c_int {
    done(|| {
        // SAFETY: the caller's promise.
        let (golden, rays, out) = unsafe { (shared("golden", golden)?, array("in_i", in_i, count)?, room("out_o", out_o, count)?) };
        // SAFETY: the caller's promise.
        let ranges = if secondary_i.is_null() { &[] } else { unsafe { array("secondary_i", secondary_i, count) }? };
        for (k, (ray, out)) in rays.iter().zip(out).enumerate() {
            let range = range(&format!("secondary_i[{k}]"), &ranges.get(k).copied().unwrap_or_else(LodraySecondaryIn::primary))?;
            out.write(LodrayHitOut::of(&expected(&golden.0, &ray.wire(&format!("in_i[{k}]"))?, range)));
        }
        Ok(())
    })
}

/// What hardware must give for a ray.
pub(crate) fn expected(golden: &Golden, ray: &RayIn, range: [RayT; 2]) -> HitOut {
    let hit = golden.closest(&ray.ray, range);
    HitOut { tag: ray.tag, found: hit.is_some(), hit: hit.unwrap_or_default(), ..HitOut::default() }
}

/// The steps of t that count.
fn range(name: &str, secondary: &LodraySecondaryIn) -> Result<[RayT; 2], Refused> {
    let wire = secondary.wire(name)?;
    if wire.prior || wire.fraction != [U::ZERO; 3] {
        return refused(format!("{name}: the golden traverser takes no rays that start on a surface"));
    }
    Ok([wire.t_min, wire.t_max])
}
