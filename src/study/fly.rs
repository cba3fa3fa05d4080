//! A flight: frames of a camera that moves a little from one to the next, and what pops between them.

use super::progress::{Progress, Silent};
use super::shot::Shot;
use super::world_shot::WorldShot;
use crate::format::Scene;
use crate::method::Method;
use crate::paths::World;
use crate::picture::{Pops, Shader, Shading, popping};
use crate::rays::{Camera, ModelSpace, Sight};
use crate::step::MapError;
use serde::Serialize;

/// What flies where.
pub struct Fly<'a> {
    /// The scene.
    pub scene: &'a Scene,
    /// How its rays find their hits.
    pub method: &'a dyn Method,
    /// Quality.
    pub delta: f64,
    /// The frames' cameras, of one size.
    pub cameras: &'a [Camera],
}

/// A frame of a flight.
#[derive(Clone, Debug, Serialize)]
pub struct Flown {
    /// Its number, from 0.
    pub frame: usize,
    /// Where the eye is.
    pub eye: [f64; 3],
    /// How far the eye moved since the frame before, in world units.
    pub moved: f64,
    /// Mean level of the triangles that were met.
    pub mean_level: f64,
    /// What the method chose for the frame.
    pub choices: Vec<(&'static str, String)>,
    /// What popped since the frame before; none of the first, nor among several models, which may move themselves.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub pops: Option<Pops>,
}

/// Flies; `each` sees every frame. `progress` is told of frames.
///
/// # Errors
/// What `each` says: the flight ends there.
pub fn fly<E>(what: &Fly<'_>, progress: &dyn Progress, each: &mut dyn FnMut(usize, &Shot) -> Result<(), E>) -> Result<Vec<Flown>, E> {
    let (space, method) = (ModelSpace::of(what.scene), what.method);
    let surface = method.surface(what.scene);
    let shader = Shader::new(surface, &space, Shading::Full);
    let bar = progress.begin("flying", Some(what.cameras.len() as u64));
    let (mut flown, mut before): (Vec<Flown>, Option<Shot>) = (Vec::new(), None);
    for (frame, camera) in what.cameras.iter().enumerate() {
        let now = Shot::plain(method, what.scene, &space, camera, what.delta, ("", &Silent));
        each(frame, &now)?;
        let sight = Sight::new(camera, &space, what.delta);
        let last = frame.checked_sub(1).map(|last| &what.cameras[last]);
        // Pops are of rays between pixels, and what a pruned scene has serves the cameras' own.
        let seen = before.as_ref().zip(last).filter(|_| what.scene.meta().is_whole());
        let pops = seen.map(|(then, last)| popping(method, surface, &shader, &then.frame, [last, camera], &sight));
        flown.push(Flown {
            frame,
            eye: camera.eye.to_array(),
            moved: last.map_or(0.0, |last| (camera.eye - last.eye).length()),
            mean_level: now.stats.mean_level,
            choices: method.choices(&sight),
            pops,
        });
        before = Some(now);
        bar.step(1);
    }
    Ok(flown)
}

/// Frames of several models, each a world of its own; `each` sees every frame. `progress` is told of frames.
///
/// # Errors
/// The models have more lines than can be numbered; besides what `each` says: the flight ends there.
pub fn fly_models<'a, E: From<MapError>>(
    world_of: &dyn Fn(usize) -> World<'a>,
    cameras: &[Camera],
    progress: &dyn Progress,
    each: &mut dyn FnMut(usize, &Shot) -> Result<(), E>,
) -> Result<Vec<Flown>, E> {
    let bar = progress.begin("flying", Some(cameras.len() as u64));
    let mut flown: Vec<Flown> = Vec::new();
    for (frame, camera) in cameras.iter().enumerate() {
        let world = world_of(frame);
        let shaders = world.shaders(Shading::Full);
        let shot = WorldShot::of(&world, &shaders, [camera, camera], ("", &Silent))?.shot;
        each(frame, &shot)?;
        let moved = frame.checked_sub(1).map_or(0.0, |last| (camera.eye - cameras[last].eye).length());
        flown.push(Flown {
            frame,
            eye: camera.eye.to_array(),
            moved,
            mean_level: shot.stats.mean_level,
            choices: world.choices(),
            pops: None,
        });
        bar.step(1);
    }
    Ok(flown)
}
