//! Frames on machines.

use crate::arrays::{Asked, Rays};
use crate::camera::{PyCamera, given};
use crate::errors::{raised, refused};
use crate::machine::machines;
use crate::told::beside;
use crate::values::{document, named, within};
use lodray::method::packet::takes_packets;
use lodray::rays::{MOST_IN_TURN, ModelSpace, RayFile, may_be_in_turn};
use lodray::run::{self, Compute};
use lodray::scene::{Pass, PassRays, SceneMethod, Target};
use lodray::study::pruned::{check, check_rays};
use lodray::study::{Turning, simulate as pass_on};
use pyo3::prelude::*;
use pyo3::types::{PyList, PyTuple};
use std::path::PathBuf;

/// The rays of a frame, or of several.
pub struct Frame<'a, 'py> {
    /// Those of a camera.
    camera: Option<&'a Bound<'py, PyCamera>>,
    /// Or of an array.
    rays: Option<&'a Bound<'py, PyAny>>,
    /// Frames after one another.
    frames: u32,
    /// Degrees between them.
    turn: f64,
    /// Tiles whose rays are handed out in turn.
    tiles_in_turn: u32,
}

impl<'a, 'py> Frame<'a, 'py> {
    /// A frame, checked.
    pub fn new(
        camera: Option<&'a Bound<'py, PyCamera>>,
        rays: Option<&'a Bound<'py, PyAny>>,
        frames: i128,
        turn: f64,
        tiles_in_turn: i128,
    ) -> PyResult<Self> {
        if !(-360.0..=360.0).contains(&turn) {
            return Err(refused(format!("turn: {turn} is not from -360 to 360 degrees")));
        }
        let frames = within("frames", frames, 1..=10_000)?;
        let in_turn = u32::try_from(tiles_in_turn).ok().filter(|&tiles| may_be_in_turn(tiles));
        let in_turn = in_turn.ok_or_else(|| refused(format!("tiles_in_turn: {tiles_in_turn}; a power of two from 1 to {MOST_IN_TURN}")))?;
        Ok(Self { camera, rays, frames, turn, tiles_in_turn: in_turn })
    }

    fn rays(&self, method: &SceneMethod) -> PyResult<PassRays> {
        let (scene, delta) = (method.scene(), method.knobs().delta());
        if let Some(rays) = self.rays {
            if self.camera.is_some() || self.frames != 1 || self.tiles_in_turn != 1 {
                return Err(refused("rays: go with neither a camera nor frames nor tiles in turn"));
            }
            let rays = RayFile::new(Rays::of(rays, None, &Asked::default())?.rows()?.queries());
            check_rays(scene, &rays, delta).map_err(raised)?;
            return Ok(PassRays::File(rays, PathBuf::from("rays")));
        }
        let camera = given(self.camera, &ModelSpace::of(scene))?;
        if self.tiles_in_turn > 1 && takes_packets(method.knobs()) {
            return Err(refused("tiles_in_turn: packets take the rays of one tile"));
        }
        let turning = Turning { frames: self.frames, degrees: self.turn };
        let rays = if self.frames > 1 { PassRays::Path(turning.path(&camera)) } else { PassRays::Camera(camera) };
        match &rays {
            PassRays::Path(path) => path.cameras().iter().try_for_each(|camera| check(scene, camera, delta)),
            _ => check(scene, &camera, delta),
        }
        .map_err(raised)?;
        Ok(rays.in_turn(self.tiles_in_turn))
    }
}

/// The figures of a frame on a machine, or on each of several: they are traced once for all.
pub fn simulate<'py>(
    method: &SceneMethod,
    on: &Bound<'py, PyAny>,
    frame: &Frame<'_, 'py>,
    compute: &str,
    progress: Option<&Bound<'py, PyAny>>,
) -> PyResult<Bound<'py, PyAny>> {
    let compute: Compute = named("compute", compute)?;
    let targets: Vec<_> = machines(on)?.into_iter().map(|machine| Target { machine, compute, window: None }).collect();
    targets.iter().try_for_each(|target| run::check(&target.machine.description, compute)).map_err(raised)?;
    if method.registered().name == "reference" {
        return Err(refused("method: reference is no hardware"));
    }
    let rays = frame.rays(method)?;
    let outcomes = beside(on.py(), progress, |told| {
        let (scene, space) = (method.scene(), ModelSpace::of(method.scene()));
        let pass = Pass { scene, space: &space, registered: method.registered(), knobs: method.knobs(), method: method.method(), rays };
        pass_on(&pass, &targets, told)
    })?;
    let results = outcomes.into_iter().map(|outcome| outcome.map(|(result, _)| result)).collect::<Result<Vec<_>, _>>().map_err(raised)?;
    let several = on.is_instance_of::<PyList>() || on.is_instance_of::<PyTuple>();
    match results.as_slice() {
        [one] if !several => document(on.py(), one),
        all => document(on.py(), &all),
    }
}
