//! Ports as bits: packed structs of `lod_pkg`, for testbenches in SystemVerilog (DPI) and others that know words alone.
//!
//! Bits lie in words of 32, the least significant first, as DPI-C has `bit [W-1:0]`; those above the width are 0.

use crate::error::{LODRAY_ERROR, Refused, done, guarded, refused};
use crate::golden::{LodrayGolden, expected};
use crate::pointers::{array, place, room, shared};
use crate::ports::{LodrayHitOut, LodrayMemoryAnswer, LodrayMemoryRequest, LodrayRayIn, LodraySecondaryIn};
use crate::rays::{camera, quality};
use crate::scene::{LodrayScene, words};
use lodray::hardware::ports::{HitOut, MemoryAnswer, MemoryRequest, RayIn, SceneConfig, SecondaryIn};
use lodray::num::{LINE_BYTES, RayT, U, Wire};
use lodray::rays::ModelSpace;
use lodray::sim::unit::file_config;
use std::ffi::c_int;

/// Words of `scene_config_t`.
pub const LODRAY_SCENE_CONFIG_WORDS: usize = 22;
/// Words of `ray_in_t`.
pub const LODRAY_RAY_IN_WORDS: usize = 10;
/// Words of `secondary_in_t`.
pub const LODRAY_SECONDARY_IN_WORDS: usize = 32;
/// Words of `hit_out_t`.
pub const LODRAY_HIT_OUT_WORDS: usize = 11;
/// Words of `memory_request_t`.
pub const LODRAY_MEMORY_REQUEST_WORDS: usize = 2;
/// Words of `memory_answer_t`.
pub const LODRAY_MEMORY_ANSWER_WORDS: usize = 9;
/// Words of a memory line.
pub const LODRAY_LINE_WORDS: usize = 8;

const fn is_width<T: Wire>(words: usize) -> bool {
    T::WIDTH.div_ceil(32) as usize == words
}
const _: () = assert!(is_width::<SceneConfig>(LODRAY_SCENE_CONFIG_WORDS));
const _: () = assert!(is_width::<RayIn>(LODRAY_RAY_IN_WORDS));
const _: () = assert!(is_width::<SecondaryIn>(LODRAY_SECONDARY_IN_WORDS));
const _: () = assert!(is_width::<HitOut>(LODRAY_HIT_OUT_WORDS));
const _: () = assert!(is_width::<MemoryRequest>(LODRAY_MEMORY_REQUEST_WORDS));
const _: () = assert!(is_width::<MemoryAnswer>(LODRAY_MEMORY_ANSWER_WORDS));
const _: () = assert!(LODRAY_LINE_WORDS * 4 == LINE_BYTES as usize);

/// Writes the bits of a value to as many words as it has.
///
/// # Safety
/// `bits` is null, or has room for them.
unsafe fn write<T: Wire>(name: &str, bits: *mut u32, value: &T) -> Result<(), Refused> {
    // SAFETY: the caller's promise.
    let room = unsafe { room(name, bits, T::WIDTH.div_ceil(32).into()) }?;
    let packed = value.to_bits();
    // The lower half of each word, then the upper.
    let halves = packed.words().iter().flat_map(|&word| [word as u32, (word >> 32) as u32]);
    for (place, half) in room.iter_mut().zip(halves) {
        place.write(half);
    }
    Ok(())
}

/// The value whose bits these are; those above its width are not looked at.
///
/// # Safety
/// `bits` is null, or has as many words as it takes.
unsafe fn read<T: Wire>(name: &str, bits: *const u32) -> Result<T, Refused> {
    // SAFETY: the caller's promise.
    let halves = unsafe { array(name, bits, T::WIDTH.div_ceil(32).into()) }?;
    let words: Vec<u64> = halves.chunks(2).map(|pair| pair.iter().rev().fold(0, |word, &half| word << 32 | u64::from(half))).collect();
    Ok(T::from_words(&words))
}

/// Writes the bits of `scene_i` for the scene whose image lies in memory from line 0 on.
///
/// # Safety
/// The scene is open, `bits` has room for LODRAY_SCENE_CONFIG_WORDS.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn lodray_scene_config_bits(scene: *const LodrayScene, bits: *mut u32) -> c_int {
    done(|| {
        // SAFETY: the caller's promise.
        unsafe { write("bits", bits, &file_config(&shared("scene", scene)?.0)) }
    })
}

/// Writes the bits of a line of the scene's image. 1: there is such a line; 0: there is none, and all bits are 0.
///
/// # Safety
/// The scene is open, `bits` has room for LODRAY_LINE_WORDS.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn lodray_line_bits(scene: *const LodrayScene, address: u64, bits: *mut u32) -> c_int {
    guarded(LODRAY_ERROR, || {
        // SAFETY: the caller's promise.
        let scene = unsafe { shared("scene", scene) }?;
        let line = words(scene.0.bytes(), address);
        // SAFETY: the caller's promise.
        unsafe { write("bits", bits, &line.unwrap_or_default().map(U::<64>::new)) }?;
        Ok(line.is_some().into())
    })
}

/// Writes the bits of `in_i` for pixel (x, y) of the camera of `lodray_camera_rays`; the ray's tag is y * width + x. 1: it does; 0: the ray misses the model's box, and all bits are 0.
///
/// # Safety
/// The scene is open, `bits` has room for LODRAY_RAY_IN_WORDS.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn lodray_camera_ray_bits(
    scene: *const LodrayScene,
    distance: f64,
    delta: f64,
    width: u32,
    height: u32,
    x: u32,
    y: u32,
    bits: *mut u32,
) -> c_int {
    guarded(LODRAY_ERROR, || {
        // SAFETY: the caller's promise.
        let scene = unsafe { shared("scene", scene) }?;
        let camera = camera(scene, distance, width, height)?;
        if x >= width || y >= height {
            return refused(format!("pixel ({x}, {y}) is outside of {width} x {height}"));
        }
        let ray = ModelSpace::of(&scene.0).enter(&camera.ray(x, y), quality(delta)?);
        let bits_of = |ray| RayIn { tag: U::new(u64::from(y * width + x)), ray };
        let of = ray.map(|ray| bits_of(ray.ray));
        // SAFETY: the caller's promise.
        unsafe { write("bits", bits, &of.unwrap_or_default()) }?;
        Ok(of.is_some().into())
    })
}

/// Writes the bits of `out_o` that hardware must give for the primary ray of these bits of `in_i`.
///
/// # Safety
/// The traverser is alive, `in_i` has LODRAY_RAY_IN_WORDS, `out_o` room for LODRAY_HIT_OUT_WORDS.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn lodray_golden_trace_bits(golden: *const LodrayGolden, in_i: *const u32, out_o: *mut u32) -> c_int {
    done(|| {
        // SAFETY: the caller's promise.
        let (golden, ray) = unsafe { (shared("golden", golden)?, read::<RayIn>("in_i", in_i)?) };
        let out = expected(&golden.0, &ray, [RayT::ZERO, RayT::MAX]);
        // SAFETY: the caller's promise.
        unsafe { write("out_o", out_o, &out) }
    })
}

/// Writes the bits of a ray.
///
/// # Safety
/// `ray` is such a struct, `bits` has room for LODRAY_RAY_IN_WORDS.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn lodray_ray_in_to_bits(ray: *const LodrayRayIn, bits: *mut u32) -> c_int {
    done(|| {
        // SAFETY: the caller's promise.
        unsafe { write("bits", bits, &shared("ray", ray)?.wire("ray")?) }
    })
}

/// Reads a ray from its bits.
///
/// # Safety
/// `bits` has LODRAY_RAY_IN_WORDS, `ray` room for one.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn lodray_ray_in_from_bits(bits: *const u32, ray: *mut LodrayRayIn) -> c_int {
    done(|| {
        // SAFETY: the caller's promise.
        let (bits, ray) = unsafe { (read("bits", bits)?, place("ray", ray)?) };
        ray.write(LodrayRayIn::of(&bits));
        Ok(())
    })
}

/// Writes the bits of what a ray has beyond a primary one.
///
/// # Safety
/// `secondary` is such a struct, `bits` has room for LODRAY_SECONDARY_IN_WORDS.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn lodray_secondary_in_to_bits(secondary: *const LodraySecondaryIn, bits: *mut u32) -> c_int {
    done(|| {
        // SAFETY: the caller's promise.
        unsafe { write("bits", bits, &shared("secondary", secondary)?.wire("secondary")?) }
    })
}

/// Writes the bits of a hit.
///
/// # Safety
/// `hit` is such a struct, `bits` has room for LODRAY_HIT_OUT_WORDS.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn lodray_hit_out_to_bits(hit: *const LodrayHitOut, bits: *mut u32) -> c_int {
    done(|| {
        // SAFETY: the caller's promise.
        unsafe { write("bits", bits, &shared("hit", hit)?.wire("hit")?) }
    })
}

/// Reads a hit from its bits.
///
/// # Safety
/// `bits` has LODRAY_HIT_OUT_WORDS, `hit` room for one.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn lodray_hit_out_from_bits(bits: *const u32, hit: *mut LodrayHitOut) -> c_int {
    done(|| {
        // SAFETY: the caller's promise.
        let (bits, hit) = unsafe { (read("bits", bits)?, place("hit", hit)?) };
        hit.write(LodrayHitOut::of(&bits));
        Ok(())
    })
}

/// Reads a memory request from its bits.
///
/// # Safety
/// `bits` has LODRAY_MEMORY_REQUEST_WORDS, `request` room for one.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn lodray_memory_request_from_bits(bits: *const u32, request: *mut LodrayMemoryRequest) -> c_int {
    done(|| {
        // SAFETY: the caller's promise.
        let (bits, request) = unsafe { (read("bits", bits)?, place("request", request)?) };
        request.write(LodrayMemoryRequest::of(&bits));
        Ok(())
    })
}

/// Writes the bits of a memory answer.
///
/// # Safety
/// `answer` is such a struct, `bits` has room for LODRAY_MEMORY_ANSWER_WORDS.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn lodray_memory_answer_to_bits(answer: *const LodrayMemoryAnswer, bits: *mut u32) -> c_int {
    done(|| {
        // SAFETY: the caller's promise.
        unsafe { write("bits", bits, &shared("answer", answer)?.wire()) }
    })
}
