//! Scenes, and their files as the memory of a unit.

use crate::error::{LODRAY_ERROR, done, guarded};
use crate::pointers::{end, handle, place, shared, text};
use lodray::format::Scene;
use lodray::mesh::procedural::Options;
use lodray::num::LINE_BYTES;
use lodray::rays::ModelSpace;
use std::ffi::{c_char, c_int};

/// A model with its levels of detail, as the hardware reads it. It does not change: any number of threads may use it at once.
pub struct LodrayScene(pub(crate) Scene);

/// What a scene is.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LodraySceneInfo {
    /// Number of splits N: each base triangle has 4^N finest triangles.
    pub levels: u32,
    /// Base triangles.
    pub trees: u64,
    /// Centre of the box of all vertices, in world units.
    pub centre: [f64; 3],
    /// Bounding radius: half the diagonal of that box, in world units.
    pub radius: f64,
    /// World length of a unit of the model.
    pub unit: f64,
    /// World position of the model's origin.
    pub offset: [f64; 3],
}

/// Opens a scene file, which `lodray build` or `lodray generate` wrote; it is checked. Null if it cannot be opened. End it with `lodray_scene_close`.
///
/// # Safety
/// `path` is a text that ends with a zero byte.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn lodray_scene_open(path: *const c_char) -> *mut LodrayScene {
    guarded(std::ptr::null_mut(), || {
        // SAFETY: the caller's promise.
        let path = unsafe { text("path", path) }?;
        Ok(handle(LodrayScene(Scene::open(path.as_ref())?)))
    })
}

/// A generated scene: terrain, cloth, sphere, spikes, room, wall, street, pot or drape. `levels` (0 to 10) and `base` (base triangles) have the scene's own
/// values if they are negative. Null if there is no such scene. End it with `lodray_scene_close`.
///
/// # Safety
/// `name` is a text that ends with a zero byte.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn lodray_scene_generate(name: *const c_char, levels: c_int, base: c_int, seed: u64) -> *mut LodrayScene {
    guarded(std::ptr::null_mut(), || {
        // SAFETY: the caller's promise.
        let name = unsafe { text("name", name) }?;
        let kind = serde_json::from_value(name.into())?;
        let options = Options { levels: u32::try_from(levels).ok(), base: u32::try_from(base).ok(), seed, ..Options::new(kind) };
        Ok(handle(LodrayScene(Scene::generate(&options)?)))
    })
}

/// Ends a scene; what was made of it stays. Null does nothing.
///
/// # Safety
/// The scene is null, or open, and nobody uses it or its image any more.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn lodray_scene_close(scene: *mut LodrayScene) {
    // SAFETY: the caller's promise.
    unsafe { end(scene) };
}

/// Writes the scene to a file, which `lodray_scene_open` and the program read.
///
/// # Safety
/// The scene is open, `path` a text that ends with a zero byte.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn lodray_scene_save(scene: *const LodrayScene, path: *const c_char) -> c_int {
    done(|| {
        // SAFETY: the caller's promise.
        let (scene, path) = unsafe { (shared("scene", scene)?, text("path", path)?) };
        Ok(scene.0.save(path.as_ref())?)
    })
}

/// Writes what the scene is to `info`.
///
/// # Safety
/// The scene is open, `info` has room for one.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn lodray_scene_info(scene: *const LodrayScene, info: *mut LodraySceneInfo) -> c_int {
    done(|| {
        // SAFETY: the caller's promise.
        let (scene, info) = unsafe { (shared("scene", scene)?, place("info", info)?) };
        let space = ModelSpace::of(&scene.0);
        info.write(LodraySceneInfo {
            levels: scene.0.levels(),
            trees: scene.0.trees() as u64,
            centre: space.centre(),
            radius: space.radius(),
            unit: space.placement.scale,
            offset: space.placement.offset,
        });
        Ok(())
    })
}

/// The unit's memory: the scene's file, byte for byte; line k is the 32 bytes from 32 k on. Writes how many bytes there are to `bytes`. The image belongs to the
/// scene and is good until that is closed. Null if the scene is.
///
/// # Safety
/// The scene is open, `bytes` has room for one.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn lodray_scene_image(scene: *const LodrayScene, bytes: *mut u64) -> *const u8 {
    guarded(std::ptr::null(), || {
        // SAFETY: the caller's promise.
        let (scene, bytes) = unsafe { (shared("scene", scene)?, place("bytes", bytes)?) };
        let image = scene.0.bytes();
        bytes.write(image.len() as u64);
        Ok(image.as_ptr())
    })
}

/// Writes a line of the image to `line`, four words of 64 bits, the first with the bytes of the lowest addresses. 1: there is such a line; 0: there is none, and
/// `line` is all 0, which a memory answers with an error.
///
/// # Safety
/// The scene is open, `line` has room for four words.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn lodray_scene_line(scene: *const LodrayScene, address: u64, line: *mut u64) -> c_int {
    guarded(LODRAY_ERROR, || {
        // SAFETY: the caller's promise.
        let (scene, line) = unsafe { (shared("scene", scene)?, place("line", line.cast::<[u64; 4]>())?) };
        let words = words(scene.0.bytes(), address);
        line.write(words.unwrap_or_default());
        Ok(words.is_some().into())
    })
}

/// The four words of a line, if all its bytes are there.
pub(crate) fn words(image: &[u8], address: u64) -> Option<[u64; 4]> {
    let first = usize::try_from(address.checked_mul(LINE_BYTES)?).ok()?;
    let line: &[u8; LINE_BYTES as usize] = image.get(first..)?.first_chunk()?;
    let (words, _) = line.as_chunks::<8>();
    Some(std::array::from_fn(|k| u64::from_le_bytes(words[k])))
}
