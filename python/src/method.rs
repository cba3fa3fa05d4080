//! Ways to find hits, and rays cast with them.

use crate::arrays::{Asked, Rays, hit_bytes, hits, pack, shaped};
use crate::camera::{PyCamera, given};
use crate::errors::{raised, refused};
use crate::simulate::{Frame, simulate};
use crate::told::{FEW, Told, at_once, beside};
use crate::values::{named, whole, within};
use lodray::method::Crossings;
use lodray::picture::{Shader, Shading};
use lodray::rays::{ModelSpace, RayFile, RayRows, RaySource, Sight};
use lodray::run;
use lodray::scene::SceneMethod;
use lodray::study::Shot;
use lodray::study::pruned::{check, check_normals, check_rays, check_shading};
use pyo3::prelude::*;
use std::error::Error;
use std::sync::Arc;

/// Rays that are cast before their hits are written where they go: beside them little memory is needed.
const PART: usize = 1 << 20;

/// What goes wrong on another thread, in words.
type Words = Box<dyn Error + Send + Sync>;

/// A way to find hits in a scene, with all that it needs: made by `Scene.method`, to be used as often as wanted and by any thread.
#[pyclass(name = "SceneMethod", frozen, module = "lodray")]
pub struct PySceneMethod(pub Arc<SceneMethod>);

/// Most samples of a pixel: 256 along its side.
pub const MOST_SAMPLES: u32 = 1 << 16;

/// What a picture can be of.
const PICTURES: [&str; 2] = ["image", "hits"];

impl PySceneMethod {
    /// Does what `of` does with rays, on this thread if they are few; the interpreter is free meanwhile.
    fn over<T: Send>(
        &self,
        py: Python<'_>,
        rays: &Rays<'_>,
        progress: Option<&Bound<'_, PyAny>>,
        of: impl Fn(&SceneMethod, RayRows<'_>, &Told) -> Result<T, Words> + Send + Sync,
    ) -> PyResult<T> {
        let rows = rays.rows()?;
        let work = |told: &Told| {
            if !self.0.scene().meta().is_whole() {
                check_rays(self.0.scene(), &RayFile::new(rows.queries()), self.0.knobs().delta())?;
            }
            of(&self.0, rows, told)
        };
        let done = if rows.rays() < FEW && progress.is_none() { at_once(py, work) } else { beside(py, progress, work)? };
        done.map_err(|error| crate::errors::raised_by(&*error))
    }

    /// What `of` says of every ray of each part of many.
    fn in_parts<T>(
        rows: RayRows<'_>,
        told: &Told,
        mut of: impl FnMut(RayRows<'_>, &(dyn Fn(u64) + Sync)) -> Result<Vec<T>, Words>,
    ) -> Result<Vec<T>, Words> {
        told.say("casting", 0, Some(rows.batches() as u64));
        let mut all = Vec::with_capacity(rows.rays() as usize);
        for first in (0..rows.rays() as usize).step_by(PART) {
            all.append(&mut of(rows.part(first, PART), &|batches| told.step(batches))?);
        }
        Ok(all)
    }
}

/// Hits of rays that start where earlier ones hit.
fn followed(method: &SceneMethod, rows: RayRows<'_>, told: &Told) -> Result<Vec<u8>, Words> {
    let rays = RayFile::new(rows.queries());
    told.say("casting", 0, Some(rays.rays()));
    let met = run::cast_following(method.method(), method.traced(), &rays, &method.sight(&rays), &|rays| told.step(rays))?;
    packed(&met.hits)
}

fn packed(hits: &[run::HitRow]) -> Result<Vec<u8>, Words> {
    let mut out = vec![0; hits.len() * hit_bytes()];
    pack(hits, &mut out).map_err(|error| error.to_string())?;
    Ok(out)
}

#[pymethods]
impl PySceneMethod {
    /// The method's name.
    #[getter]
    fn name(&self) -> &'static str {
        self.0.registered().name
    }

    /// What every ray meets first: an array of lodray.HIT of shape (n,). See Scene.cast.
    #[pyo3(signature = (rays, directions=None, *, radius=None, cone=None, t_min=None, t_max=None, follow=true, progress=None))]
    #[expect(clippy::too_many_arguments, reason = "keywords of Python")]
    pub fn cast<'py>(
        &self,
        rays: &Bound<'py, PyAny>,
        directions: Option<&Bound<'py, PyAny>>,
        radius: Option<Bound<'py, PyAny>>,
        cone: Option<Bound<'py, PyAny>>,
        t_min: Option<Bound<'py, PyAny>>,
        t_max: Option<Bound<'py, PyAny>>,
        follow: bool,
        progress: Option<&Bound<'py, PyAny>>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let py = rays.py();
        let rays = Rays::of(rays, directions, &Asked { radius, cone, t_min, t_max })?;
        let packed = self.over(py, &rays, progress, |method, rows, told| {
            check_normals(method.traced(), "a hit's normal")?;
            if follow && rows.are_ordered() {
                return followed(method, rows, told);
            }
            let sight = method.sight(&rows);
            told.say("casting", 0, Some(rows.batches() as u64));
            let mut out = vec![0; rows.rays() as usize * hit_bytes()];
            for (k, out) in out.chunks_mut(PART * hit_bytes()).enumerate() {
                let part = rows.part(k * PART, PART);
                let hits = run::cast(method.method(), method.traced(), &part, &sight, &|batches| told.step(batches));
                pack(&hits, out).map_err(|error| error.to_string())?;
            }
            Ok(out)
        })?;
        hits(py, packed)
    }

    /// Every hit of every ray: (hits, ray). See Scene.all_hits.
    #[pyo3(signature = (rays, directions=None, *, radius=None, cone=None, t_min=None, t_max=None, progress=None))]
    #[expect(clippy::too_many_arguments, reason = "keywords of Python")]
    pub fn all_hits<'py>(
        &self,
        rays: &Bound<'py, PyAny>,
        directions: Option<&Bound<'py, PyAny>>,
        radius: Option<Bound<'py, PyAny>>,
        cone: Option<Bound<'py, PyAny>>,
        t_min: Option<Bound<'py, PyAny>>,
        t_max: Option<Bound<'py, PyAny>>,
        progress: Option<&Bound<'py, PyAny>>,
    ) -> PyResult<(Bound<'py, PyAny>, Bound<'py, PyAny>)> {
        let py = rays.py();
        let rays = Rays::of(rays, directions, &Asked { radius, cone, t_min, t_max })?;
        let (out, numbers) = self.over(py, &rays, progress, |method, rows, told| {
            check_normals(method.traced(), "a hit's normal")?;
            let sight = method.sight(&rows);
            let (mut out, mut numbers, mut first) = (Vec::new(), Vec::new(), 0);
            told.say("casting", 0, Some(rows.batches() as u64));
            while first < rows.rays() as usize {
                let part = rows.part(first, PART);
                let of_each = run::cast_all(method.method(), method.traced(), &part, &sight, &|batches| told.step(batches))?;
                for (ray, hits) in (first as i64..).zip(&of_each) {
                    numbers.extend(hits.iter().map(|_| ray));
                }
                out.append(&mut packed(&of_each.concat())?);
                first += PART;
            }
            Ok((out, numbers))
        })?;
        let count = numbers.len();
        Ok((hits(py, out)?, shaped::<i64>(py, numbers, &[count])?))
    }

    /// Whether every ray meets anything: an array of bool of shape (n,). See Scene.occluded.
    #[pyo3(signature = (rays, directions=None, *, radius=None, cone=None, t_min=None, t_max=None, progress=None))]
    #[expect(clippy::too_many_arguments, reason = "keywords of Python")]
    pub fn occluded<'py>(
        &self,
        rays: &Bound<'py, PyAny>,
        directions: Option<&Bound<'py, PyAny>>,
        radius: Option<Bound<'py, PyAny>>,
        cone: Option<Bound<'py, PyAny>>,
        t_min: Option<Bound<'py, PyAny>>,
        t_max: Option<Bound<'py, PyAny>>,
        progress: Option<&Bound<'py, PyAny>>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let py = rays.py();
        let rays = Rays::of(rays, directions, &Asked { radius, cone, t_min, t_max })?;
        let met = self.over(py, &rays, progress, |method, rows, told| {
            let sight = method.sight(&rows);
            Self::in_parts(rows, told, |part, done| Ok(run::cast_any(method.method(), &part, &sight, done)))
        })?;
        let count = met.len();
        shaped(py, met, &[count])
    }

    /// How many fronts and backs every ray meets: an array of int64 of shape (n, 2). See Scene.count.
    #[pyo3(signature = (rays, directions=None, *, radius=None, cone=None, t_min=None, t_max=None, progress=None))]
    #[expect(clippy::too_many_arguments, reason = "keywords of Python")]
    pub fn count<'py>(
        &self,
        rays: &Bound<'py, PyAny>,
        directions: Option<&Bound<'py, PyAny>>,
        radius: Option<Bound<'py, PyAny>>,
        cone: Option<Bound<'py, PyAny>>,
        t_min: Option<Bound<'py, PyAny>>,
        t_max: Option<Bound<'py, PyAny>>,
        progress: Option<&Bound<'py, PyAny>>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let py = rays.py();
        let rays = Rays::of(rays, directions, &Asked { radius, cone, t_min, t_max })?;
        let counts = self.over(py, &rays, progress, |method, rows, told| {
            let sight = method.sight(&rows);
            Self::in_parts(rows, told, |part, done| Ok(run::cast_counting(method.method(), &part, &sight, done)?))
        })?;
        let count = counts.len();
        let both = counts.into_iter().flat_map(|Crossings { front, back }| [front, back].map(i64::from)).collect();
        shaped(py, both, &[count, 2])
    }

    /// A picture, or what its rays met. See Scene.render.
    #[pyo3(signature = (camera=None, *, what="image", samples=1, shading=None, progress=None))]
    pub fn render<'py>(
        &self,
        py: Python<'py>,
        camera: Option<&Bound<'py, PyCamera>>,
        what: &str,
        #[pyo3(from_py_with = whole)] samples: i128,
        shading: Option<&str>,
        progress: Option<&Bound<'py, PyAny>>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let samples: u32 = within("samples", samples, 1..=MOST_SAMPLES)?;
        if !PICTURES.contains(&what) {
            return Err(refused(format!("what: '{what}' is none of {}", PICTURES.join(", "))));
        }
        let (method, scene) = (&*self.0, self.0.traced());
        let (space, delta) = (ModelSpace::of(scene), method.knobs().delta());
        let camera = given(camera, &space)?;
        check(scene, &camera, delta).map_err(raised)?;
        check_normals(scene, "a picture").map_err(raised)?;
        let [width, height] = camera.pixels().map(|n| n as usize);
        if what == "hits" {
            if samples != 1 {
                return Err(refused("samples: of a pixel of an image; hits are of one ray for each pixel"));
            }
            if shading.is_some() {
                return Err(refused("shading: is of an image; hits have the shading normal at full resolution"));
            }
            let packed = beside(py, progress, |told| {
                told.say("tracing", 0, Some(camera.batches() as u64));
                let sight = Sight::new(&camera, &space, delta);
                packed(&run::cast(method.method(), scene, &camera, &sight, &|batches| told.step(batches)))
            })?;
            let packed = packed.map_err(|error| crate::errors::raised_by(&*error))?;
            return hits(py, packed)?.call_method1("reshape", (height, width));
        }
        let shading = shading.map_or(Ok(Shading::Facets), |shading| named("shading", shading))?;
        check_shading(scene, shading).map_err(raised)?;
        let side = samples.isqrt();
        if side * side != samples {
            return Err(refused(format!("samples: {samples} is no square")));
        }
        let sampled = camera.with_samples(side).map_err(raised)?;
        check(scene, &sampled, delta).map_err(raised)?;
        let image = beside(py, progress, |told| {
            let shader = Shader::new(scene, &space, shading);
            Shot::of(method.method(), &shader, &space, [&camera, &sampled], delta, ("tracing", told)).image.into_raw()
        })?;
        shaped(py, image, &[height, width, 3])
    }

    /// What frames cost on a machine: a dictionary. See Scene.simulate.
    #[pyo3(signature = (machine, camera=None, *, rays=None, compute="free", frames=1, turn=3.0, tiles_in_turn=1, progress=None))]
    #[expect(clippy::too_many_arguments, reason = "keywords of Python")]
    pub fn simulate<'py>(
        &self,
        machine: &Bound<'py, PyAny>,
        camera: Option<&Bound<'py, PyCamera>>,
        rays: Option<&Bound<'py, PyAny>>,
        compute: &str,
        #[pyo3(from_py_with = whole)] frames: i128,
        turn: f64,
        #[pyo3(from_py_with = whole)] tiles_in_turn: i128,
        progress: Option<&Bound<'py, PyAny>>,
    ) -> PyResult<Bound<'py, PyAny>> {
        simulate(&self.0, machine, &Frame::new(camera, rays, frames, turn, tiles_in_turn)?, compute, progress)
    }

    fn __repr__(&self) -> String {
        format!("SceneMethod('{}' of '{}')", self.0.registered().name, self.0.scene().meta().name)
    }
}
