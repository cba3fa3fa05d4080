//! A flight: frames of a camera that moves a little from one to the next, and what pops between them.

use super::progress::Progress;
use super::shot::Shot;
use crate::format::Scene;
use crate::method::Method;
use crate::picture::{Pops, Seen, popping};
use crate::rays::{Camera, ModelSpace, Sight};
use serde::Serialize;

/// What flies where.
pub struct Fly<'a> {
    /// The scene.
    pub scene: &'a Scene,
    /// How its rays find their hits.
    pub method: &'a dyn Method,
    /// Full resolution by any method.
    pub full: &'a dyn Method,
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
    /// What popped since the frame before; none of the first.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub pops: Option<Pops>,
}

/// Flies; `each` sees every frame as the method has it. `progress` is told of frames.
pub fn fly<E>(what: &Fly<'_>, progress: &dyn Progress, each: &mut dyn FnMut(usize, &Shot) -> Result<(), E>) -> Result<Vec<Flown>, E> {
    let space = ModelSpace::of(what.scene);
    let silent = super::progress::Silent;
    let bar = progress.begin("flying", Some(what.cameras.len() as u64));
    let (mut flown, mut before): (Vec<Flown>, Option<[Shot; 2]>) = (Vec::new(), None);
    for (frame, camera) in what.cameras.iter().enumerate() {
        let shot = |method, delta| Shot::plain(method, what.scene, &space, camera, delta, ("", &silent));
        let now = [shot(what.method, what.delta), shot(what.full, f64::INFINITY)];
        each(frame, &now[0])?;
        let last = frame.checked_sub(1).map(|last| &what.cameras[last]);
        let pops = before
            .as_ref()
            .zip(last)
            .map(|(then, last)| popping(what.method.surface(what.scene), &space, [seen(then, last), seen(&now, camera)]));
        flown.push(Flown {
            frame,
            eye: camera.eye.to_array(),
            moved: last.map_or(0.0, |last| (camera.eye - last.eye).length()),
            mean_level: now[0].stats.mean_level,
            choices: what.method.choices(&Sight::new(camera, &space, what.delta)),
            pops,
        });
        before = Some(now);
        bar.step(1);
    }
    Ok(flown)
}

fn seen<'a>([own, full]: &'a [Shot; 2], camera: &'a Camera) -> Seen<'a> {
    Seen { frame: &own.frame, image: &own.image, full: &full.image, camera }
}
