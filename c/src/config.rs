//! What a unit is told of a scene (`scene_i`).

use crate::error::done;
use crate::pointers::{place, shared};
use crate::ports::LodraySceneConfig;
use crate::scene::LodrayScene;
use lodray::sim::unit::file_config;
use std::ffi::c_int;

/// Writes what a unit is told of the scene whose image (`lodray_scene_image`) lies in its memory from line 0 on.
///
/// # Safety
/// The scene is open, `config` has room for one.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn lodray_scene_config(scene: *const LodrayScene, config: *mut LodraySceneConfig) -> c_int {
    done(|| {
        // SAFETY: the caller's promise.
        let (scene, config) = unsafe { (shared("scene", scene)?, place("config", config)?) };
        config.write(LodraySceneConfig::of(&file_config(&scene.0)));
        Ok(())
    })
}
