//! Scenes.

use crate::arrays::{contiguous, knobs, shaped, triples};
use crate::camera::{Place, PyCamera, camera};
use crate::error_time::{Study, error_time};
use crate::errors::{of_file, raised, refused};
use crate::method::PySceneMethod;
use crate::plan::plan;
use crate::told::{Told, beside};
use crate::values::{Size, document, named, to_python, triple, whole, whole_or_none, within};
use lodray::format::audit::audit;
use lodray::format::{RefitOptions, Scene, export_level, level_mesh, write_and_rename};
use lodray::mesh::procedural::{MAX_TREES, MAX_WALLS, Options};
use lodray::mesh::{DEFAULT_CREASE_ANGLE, DEFAULT_MAX_ERROR, RemeshOptions, TriangleMesh, read};
use lodray::num::MAX_LEVELS;
use lodray::rays::ModelSpace;
use lodray::scene::BuildOptions;
use lodray::study::Progress;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use serde_json::{Value, json};
use std::path::PathBuf;
use std::sync::Arc;

/// A model with its levels of detail, as the hardware reads it.
///
/// Made by `Scene.build` of a mesh, `Scene.exact` of the very triangles of a mesh, `Scene.generate`, or `Scene.open` of a file.
/// A scene does not change, and may be used by several threads.
#[pyclass(name = "Scene", frozen, module = "lodray")]
pub struct PyScene(pub Scene);

/// Vertices, and three of them for each face.
type Mesh = (Vec<[f64; 3]>, Vec<[u32; 3]>);

/// Vertices and faces of NumPy's as the library takes them.
fn mesh_of(vertices: &Bound<'_, PyAny>, faces: &Bound<'_, PyAny>) -> PyResult<Mesh> {
    let vertices = contiguous("vertices", vertices)?;
    let faces = contiguous("faces", faces)?;
    let small = |face: &[i64; 3]| -> Option<[u32; 3]> {
        let [a, b, c] = face.map(|v| u32::try_from(v).ok());
        Some([a?, b?, c?])
    };
    let each = triples::<i64>("faces", &faces)?.iter().enumerate();
    let checked =
        each.map(|(k, face)| small(face).ok_or_else(|| refused(format!("faces: face {k} is {face:?}, and indices are from 0 on"))));
    Ok((triples::<f64>("vertices", &vertices)?.to_vec(), checked.collect::<PyResult<_>>()?))
}

impl PyScene {
    /// The method of this name with knobs turned.
    fn made(&self, py: Python<'_>, name: &str, given: Option<&Bound<'_, PyDict>>) -> PyResult<PySceneMethod> {
        let turned = knobs(given)?;
        let made = beside(py, None, |_| {
            let turned: Vec<_> = turned.iter().map(|(name, value)| (name.as_str(), value.as_str())).collect();
            self.0.method_with(name, &turned)
        })?;
        Ok(PySceneMethod(Arc::new(made.map_err(raised)?)))
    }

    /// A level that it has; the finest if none is named.
    fn level(&self, level: Option<i128>) -> PyResult<u32> {
        let finest = self.0.levels();
        level.map_or(Ok(finest), |level| within("level", level, 0..=finest))
    }
}

#[pymethods]
impl PyScene {
    /// Opens a scene file, as `lodray build` and `Scene.save` write them. It is checked, and mapped rather than read.
    ///
    /// So nothing may change the file in place while the scene is in use: hits would be wrong, and where it was cut short the process ends.
    /// `Scene.save` under the same name does no harm: it puts another file in its place.
    ///
    /// Raises LodrayFileError: there is no such file, or it cannot be read; LodrayError: it is damaged.
    #[staticmethod]
    fn open(py: Python<'_>, path: PathBuf) -> PyResult<Self> {
        Ok(Self(beside(py, None, |_| Scene::open(&path))?.map_err(raised)?))
    }

    /// A scene of a mesh, with levels of detail.
    ///
    /// The mesh is made anew, so that rays meet triangles of the scene, which lie within max_error of its own. `Scene.exact` keeps those.
    ///
    /// mesh: vertices, an array of shape (n, 3), with faces, whole numbers of shape (m, 3); or the path of an OBJ, PLY, glTF, GLB or STL file.
    /// max_error: largest distance between mesh and result, both ways, in percent of the diagonal of the mesh's box: above 0, at most 100; 0.3 if None.
    /// levels: 1-to-4 splits, 0 to 10; as many as the mesh's triangles ask for if None.
    /// base: a base mesh of so many triangles, 1 or more, whatever is lost; as few as keep within max_error if None.
    /// crease_angle: edges that bend by more degrees stay sharp, 0 to 180; 50 if None.
    /// own_triangles: the mesh's triangles as base triangles that are not split; triangles without area and repeated ones are left out. None of the four above goes with it.
    /// bounds: what displacement bounds cover, "largest" or "total"; "total" if None.
    /// vertex_form: how inserted vertices are stored, "compact", "short" or "exact"; "compact" if None, and "exact" with own_triangles.
    /// name: what to call the scene; the file's name without ending if it is empty.
    /// keep_mesh: keeps the mesh too, for the methods over it (input-bvh and others).
    /// progress: called now and then as progress(what, done, of).
    ///
    /// Raises LodrayError: an index out of range, a coordinate that is not finite, no triangle, or a mesh that cannot be remeshed so;
    /// LodrayFileError: a file that cannot be read. What of the mesh is lost is a UserWarning, and so is a result that is further from it than max_error,
    /// or folded.
    #[staticmethod]
    #[pyo3(signature = (mesh, faces=None, *, max_error=None, levels=None, base=None, crease_angle=None, own_triangles=false, bounds=None, vertex_form=None, name="", keep_mesh=false, progress=None))]
    #[expect(clippy::too_many_arguments, reason = "keywords of Python")]
    fn build(
        mesh: &Bound<'_, PyAny>,
        faces: Option<&Bound<'_, PyAny>>,
        max_error: Option<f64>,
        #[pyo3(from_py_with = whole_or_none)] levels: Option<i128>,
        #[pyo3(from_py_with = whole_or_none)] base: Option<i128>,
        crease_angle: Option<f64>,
        own_triangles: bool,
        bounds: Option<&str>,
        vertex_form: Option<&str>,
        name: &str,
        keep_mesh: bool,
        progress: Option<&Bound<'_, PyAny>>,
    ) -> PyResult<Self> {
        let py = mesh.py();
        let source = match faces {
            Some(faces) => Err(mesh_of(mesh, faces)?),
            None => Ok(mesh.extract::<PathBuf>().map_err(|_| refused("faces: missing; without them the mesh is the path of a file"))?),
        };
        let of_remeshing = [
            ("max_error", max_error.is_some()),
            ("levels", levels.is_some()),
            ("base", base.is_some()),
            ("crease_angle", crease_angle.is_some()),
        ];
        if let Some((name, _)) = of_remeshing.into_iter().find(|(_, given)| own_triangles && *given) {
            return Err(refused(format!("{name}: goes with no own_triangles, which are neither remeshed nor split")));
        }
        let levels = levels.map(|levels| within("levels", levels, 0..=MAX_LEVELS)).transpose()?;
        let base_triangles = base.map(|base| within("base", base, 1..=usize::MAX)).transpose()?;
        let (max_error, crease_angle) = (max_error.unwrap_or(DEFAULT_MAX_ERROR), crease_angle.unwrap_or(DEFAULT_CREASE_ANGLE));
        if !(max_error > 0.0 && max_error <= 100.0) {
            return Err(refused(format!("max_error: {max_error} is not above 0 and at most 100 percent")));
        }
        if !(0.0..=180.0).contains(&crease_angle) {
            return Err(refused(format!("crease_angle: {crease_angle} is not from 0 to 180 degrees")));
        }
        let usual = if own_triangles { BuildOptions::own_triangles() } else { BuildOptions::default() };
        let stem = source.as_ref().ok().and_then(|path| path.file_stem());
        let stem = stem.map_or_else(String::new, |stem| stem.to_string_lossy().into_owned());
        let options = BuildOptions {
            name: if name.is_empty() { stem } else { name.to_owned() },
            remesh: (!own_triangles).then_some(RemeshOptions { levels, base_triangles, max_error, reserve: 0.0, crease_angle }),
            bounds: bounds.map_or(Ok(usual.bounds), |bounds| named("bounds", bounds))?,
            vertices: vertex_form.map_or(Ok(usual.vertices), |form| named("vertex_form", form))?,
            ..usual
        };
        let made = beside(py, progress, |told: &Told| {
            let (of, mesh) = match &source {
                Ok(path) => (path.display().to_string(), read(path).map_err(raised)?),
                Err((vertices, faces)) => {
                    let mut mesh = TriangleMesh::from_parts(vertices, faces, &[], Vec::new()).map_err(raised)?;
                    // As of a file.
                    mesh.warnings.extend(mesh.report.flat().into_iter().chain(mesh.report.repeated()));
                    ("mesh".to_owned(), mesh)
                }
            };
            let lose = |lost: &str| told.note(&format!("warning: {of}: {lost}"));
            for lost in &mesh.warnings {
                lose(lost);
            }
            let scene = Scene::of_mesh(&mesh, &options, &|what, done, of| told.say(what, done, Some(of))).map_err(raised)?;
            if let Some(lost) = scene.meta().origin["remesh"]["warning"].as_str() {
                lose(lost);
            }
            if !keep_mesh {
                return Ok(scene);
            }
            let own = BuildOptions { name: options.name.clone(), ..BuildOptions::own_triangles() };
            Ok(scene.with_input(Scene::of_mesh(&mesh, &own, &|_, _, _| ()).map_err(raised)?))
        })?;
        made.map(Self)
    }

    /// The scene of these very triangles, for exact rays: (scene, faces).
    ///
    /// vertices: an array of shape (n, 3); faces: whole numbers of shape (m, 3). None is split or left out, but those that have two
    /// corners at one place, which no ray meets.
    /// The result's faces, int64 of shape (number of triangles,), are the numbers of the given ones. A ray that meets nothing has triangle -1,
    /// which would be the last: take faces[hits["triangle"][hits["tree"] >= 0]], the faces of the rays that met any.
    /// Vertices are within half a step of their places, of which the largest side of the mesh's box has 2^28.
    ///
    /// Raises LodrayError: an index out of range, a coordinate that is not finite, or no triangle.
    #[staticmethod]
    fn exact<'py>(vertices: &Bound<'py, PyAny>, faces: &Bound<'py, PyAny>) -> PyResult<(Self, Bound<'py, PyAny>)> {
        let py = vertices.py();
        let (vertices, faces) = mesh_of(vertices, faces)?;
        let given = beside(py, None, |_| Scene::as_given(&vertices, &faces))?.map_err(raised)?;
        let (count, faces) = (given.faces.len(), given.faces.into_iter().map(i64::from).collect());
        Ok((Self(given.scene), shaped::<i64>(py, faces, &[count])?))
    }

    /// A procedural scene: terrain, cloth, sphere, spikes, room, wall, street, pot or drape.
    ///
    /// levels: 1-to-4 splits, 0 to 10. base: base triangles, 1 to 2^27, rounded up to what is possible. seed: 0 to 2^64 - 1. roughness: above 0 and below 1.
    /// walls: of a room, quads along each wall, 1 to 1024. width: of a terrain, world units across, 0.5 to 1024. What is None has the scene's own value.
    ///
    /// Raises LodrayError: there is no such scene, or a value is out of its range.
    #[staticmethod]
    #[pyo3(signature = (scene, *, levels=None, base=None, seed=0, roughness=None, walls=None, width=None))]
    #[expect(clippy::too_many_arguments, reason = "keywords of Python")]
    fn generate(
        py: Python<'_>,
        scene: &str,
        #[pyo3(from_py_with = whole_or_none)] levels: Option<i128>,
        #[pyo3(from_py_with = whole_or_none)] base: Option<i128>,
        #[pyo3(from_py_with = whole)] seed: i128,
        roughness: Option<f64>,
        #[pyo3(from_py_with = whole_or_none)] walls: Option<i128>,
        width: Option<f64>,
    ) -> PyResult<Self> {
        let options = Options {
            scene: named("scene", scene)?,
            levels: levels.map(|levels| within("levels", levels, 0..=MAX_LEVELS)).transpose()?,
            base: base.map(|base| within("base", base, 1..=MAX_TREES as u32)).transpose()?,
            seed: within("seed", seed, 0..=u64::MAX)?,
            roughness,
            walls: walls.map(|walls| within("walls", walls, 1..=MAX_WALLS)).transpose()?,
            width,
        };
        Ok(Self(beside(py, None, |_| Scene::generate(&options))?.map_err(raised)?))
    }

    /// What the scene is: a dictionary of numbers, and how it was made (`origin`).
    #[getter]
    fn info<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let (scene, space) = (&self.0, ModelSpace::of(&self.0));
        let mut info = serde_json::to_value(scene.meta()).map_err(raised)?;
        let size: [f64; 3] = std::array::from_fn(|k| space.placement.scale * (f64::from(space.hi[k]) - f64::from(space.lo[k])));
        let more = json!({
            "bytes": scene.bytes().len(),
            "base_triangles": scene.trees(),
            "finest_triangles": scene.finest_triangles(),
            "trees_by_depth": scene.trees_by_depth(),
            "hierarchy_bytes_per_triangle": scene.bytes_per_triangle(),
            "size": size,
            "centre": space.centre(),
            "radius": space.radius(),
            "unit": space.placement.scale,
        });
        if let (Value::Object(info), Value::Object(more)) = (&mut info, more) {
            info.extend(more);
        }
        to_python(py, &info)
    }

    /// Checks everything that a scene promises: a dictionary with each check, and `passed`.
    fn verify<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let report = beside(py, None, |_| audit(&self.0))?;
        let all = document(py, &report)?;
        all.set_item("passed", report.passed())?;
        Ok(all)
    }

    /// Writes the scene to a file, which `Scene.open` and the program read.
    ///
    /// Raises LodrayFileError: it cannot be written.
    fn save(&self, py: Python<'_>, path: PathBuf) -> PyResult<()> {
        beside(py, None, |_| self.0.save(&path))?.map_err(raised)
    }

    /// Writes a level as OBJ, 0 to the finest, which it is if None: a dictionary of level, and of how many vertices and faces there are.
    ///
    /// Raises LodrayError: there is no such level; LodrayFileError: it cannot be written.
    #[pyo3(signature = (path, level=None))]
    fn export<'py>(
        &self,
        py: Python<'py>,
        path: PathBuf,
        #[pyo3(from_py_with = whole_or_none)] level: Option<i128>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let level = self.level(level)?;
        let counts = beside(py, None, |_| {
            let mut counts = None;
            let written = write_and_rename(&path, |out| {
                counts = Some(export_level(&self.0, level, out)?);
                Ok(())
            });
            written.map(|()| counts).map_err(|error| of_file(format!("cannot write {}: {error}", path.display()), &error))
        })??;
        document(py, &counts.map(|counts| json!({ "level": level, "vertices": counts.vertices, "faces": counts.faces })))
    }

    /// A level, 0 to the finest, which it is if None: (vertices, faces), arrays of float64 of shape (n, 3) and of int64 of shape (m, 3).
    ///
    /// They are what `export` writes, in the same order: at the finest level the `triangle` of a hit is a row of faces.
    ///
    /// Raises LodrayError: there is no such level.
    #[pyo3(signature = (level=None))]
    fn mesh<'py>(
        &self,
        py: Python<'py>,
        #[pyo3(from_py_with = whole_or_none)] level: Option<i128>,
    ) -> PyResult<(Bound<'py, PyAny>, Bound<'py, PyAny>)> {
        let level = self.level(level)?;
        let mesh = beside(py, None, |_| level_mesh(&self.0, level))?.map_err(raised)?;
        let faces: Vec<i64> = mesh.faces.as_flattened().iter().map(|&id| id as i64).collect();
        let vertices = shaped::<f64>(py, mesh.vertices.as_flattened().to_vec(), &[mesh.vertices.len(), 3])?;
        Ok((vertices, shaped::<i64>(py, faces, &[mesh.faces.len(), 3])?))
    }

    /// The scene with its vertices elsewhere: a frame of an animation. Its triangles, splits and the tree of its BVH stay.
    ///
    /// vertices: where those of the finest level are now, an array of shape (n, 3), in the order of `mesh()`.
    /// normals: "smooth", made anew, or "keep". grid: where steps of coordinates lie: "new", as for a scene built from these vertices, or
    /// "keep", so that what does not move keeps its coordinates.
    ///
    /// Raises LodrayError: another number of vertices, or one that is not finite.
    #[pyo3(signature = (vertices, *, normals="smooth", grid="new"))]
    fn refit(&self, vertices: &Bound<'_, PyAny>, normals: &str, grid: &str) -> PyResult<Self> {
        let options = RefitOptions { shading: named("normals", normals)?, grid: named("grid", grid)? };
        let py = vertices.py();
        let vertices = contiguous("vertices", vertices)?;
        let positions = triples::<f64>("vertices", &vertices)?;
        Ok(Self(beside(py, None, |_| self.0.refit(positions, options))?.map_err(raised)?))
    }

    /// A way to find hits, to be used many times: lod, bvh and others (`lodray.methods()`), with its knobs as keywords, such as delta=0.5.
    ///
    /// Raises LodrayError: there is no such method or knob, or the scene lacks what it needs.
    #[pyo3(signature = (name="lod", **knobs))]
    fn method(&self, py: Python<'_>, name: &str, knobs: Option<&Bound<'_, PyDict>>) -> PyResult<PySceneMethod> {
        self.made(py, name, knobs)
    }

    /// What every ray meets first: an array of lodray.HIT of shape (n,).
    ///
    /// rays, directions: origins in world units and directions of any length but 0, arrays of shape (n, 3), or one of them of shape (3,) for all;
    /// or one array in place of both: of type lodray.RAY, or of rows of 6, 8, 10, 11 or 12 numbers as files of rays have them. `help(lodray)` has the fields
    /// of lodray.RAY and lodray.HIT. An array of lodray.RAY may have any shape, as that of `Camera.rays`; its hits are flat, row after row.
    /// Contiguous arrays of float64 are not copied. Other threads of Python run meanwhile; they must not change the arrays.
    /// Arrays are of whole or floating numbers; dates, texts, bools and complex numbers are refused, and so are masked entries.
    /// radius, cone: of each ray's cone, the radius at its origin in world units and the tangent of its half angle, 0 or more: what lod may leave out. 0 is full detail.
    /// t_min, t_max: distances from the origin that count, in world units, 0 <= t_min <= t_max; 0 and inf if None.
    /// Each of these four is a number or an array of shape (n,). Ends are as rounded: what lies at one to within the rounding of the ray may count or not.
    /// follow: a ray that names an earlier one starts exactly at that one's hit.
    /// progress: called as progress(what, done, of), twenty times a second at most; what it raises ends the work.
    /// knobs: those of the method, such as delta=0.5. `Scene.method` keeps what a method needs, so that it is made but once.
    ///
    /// A ray that meets nothing has t = inf, and -1 or no number elsewhere.
    /// Raises LodrayError: a ray that cannot be, by its number.
    #[pyo3(signature = (rays, directions=None, *, method="lod", radius=None, cone=None, t_min=None, t_max=None, follow=true, progress=None, **knobs))]
    #[expect(clippy::too_many_arguments, reason = "keywords of Python")]
    fn cast<'py>(
        &self,
        rays: &Bound<'py, PyAny>,
        directions: Option<&Bound<'py, PyAny>>,
        method: &str,
        radius: Option<Bound<'py, PyAny>>,
        cone: Option<Bound<'py, PyAny>>,
        t_min: Option<Bound<'py, PyAny>>,
        t_max: Option<Bound<'py, PyAny>>,
        follow: bool,
        progress: Option<&Bound<'py, PyAny>>,
        knobs: Option<&Bound<'py, PyDict>>,
    ) -> PyResult<Bound<'py, PyAny>> {
        self.made(rays.py(), method, knobs)?.cast(rays, directions, radius, cone, t_min, t_max, follow, progress)
    }

    /// Every hit of every ray: (hits, ray), arrays of lodray.HIT and of int64, both of shape (number of hits,).
    ///
    /// They are in the order of the rays, and of each ray nearest first; ray says whose they are. Of a closed surface each crossing is
    /// there once, also where a ray goes through an edge or a vertex. Arguments are those of `cast`.
    /// Raises LodrayError: a ray that cannot be, or a method that finds but the closest (reference).
    #[pyo3(signature = (rays, directions=None, *, method="lod", radius=None, cone=None, t_min=None, t_max=None, progress=None, **knobs))]
    #[expect(clippy::too_many_arguments, reason = "keywords of Python")]
    fn all_hits<'py>(
        &self,
        rays: &Bound<'py, PyAny>,
        directions: Option<&Bound<'py, PyAny>>,
        method: &str,
        radius: Option<Bound<'py, PyAny>>,
        cone: Option<Bound<'py, PyAny>>,
        t_min: Option<Bound<'py, PyAny>>,
        t_max: Option<Bound<'py, PyAny>>,
        progress: Option<&Bound<'py, PyAny>>,
        knobs: Option<&Bound<'py, PyDict>>,
    ) -> PyResult<(Bound<'py, PyAny>, Bound<'py, PyAny>)> {
        self.made(rays.py(), method, knobs)?.all_hits(rays, directions, radius, cone, t_min, t_max, progress)
    }

    /// Whether every ray meets anything: an array of bool of shape (n,). Arguments are those of `cast`.
    #[pyo3(signature = (rays, directions=None, *, method="lod", radius=None, cone=None, t_min=None, t_max=None, progress=None, **knobs))]
    #[expect(clippy::too_many_arguments, reason = "keywords of Python")]
    fn occluded<'py>(
        &self,
        rays: &Bound<'py, PyAny>,
        directions: Option<&Bound<'py, PyAny>>,
        method: &str,
        radius: Option<Bound<'py, PyAny>>,
        cone: Option<Bound<'py, PyAny>>,
        t_min: Option<Bound<'py, PyAny>>,
        t_max: Option<Bound<'py, PyAny>>,
        progress: Option<&Bound<'py, PyAny>>,
        knobs: Option<&Bound<'py, PyDict>>,
    ) -> PyResult<Bound<'py, PyAny>> {
        self.made(rays.py(), method, knobs)?.occluded(rays, directions, radius, cone, t_min, t_max, progress)
    }

    /// How many fronts and backs every ray meets: an array of int64 of shape (n, 2). Arguments are those of `cast`.
    ///
    /// A ray that starts in a closed body meets one back more than fronts.
    #[pyo3(signature = (rays, directions=None, *, method="lod", radius=None, cone=None, t_min=None, t_max=None, progress=None, **knobs))]
    #[expect(clippy::too_many_arguments, reason = "keywords of Python")]
    fn count<'py>(
        &self,
        rays: &Bound<'py, PyAny>,
        directions: Option<&Bound<'py, PyAny>>,
        method: &str,
        radius: Option<Bound<'py, PyAny>>,
        cone: Option<Bound<'py, PyAny>>,
        t_min: Option<Bound<'py, PyAny>>,
        t_max: Option<Bound<'py, PyAny>>,
        progress: Option<&Bound<'py, PyAny>>,
        knobs: Option<&Bound<'py, PyDict>>,
    ) -> PyResult<Bound<'py, PyAny>> {
        self.made(rays.py(), method, knobs)?.count(rays, directions, radius, cone, t_min, t_max, progress)
    }

    /// A camera on the scene.
    ///
    /// size: (width, height) in pixels, each from 1 to 65536, and at most 2^26 pixels; (1024, 1024) by default.
    /// distance: from the target in bounding radii, above 0; if None the picture just holds the whole scene.
    /// eye, target, up: (x, y, z) in world units; if None the target is the scene's centre, up (0, 1, 0), and the eye in direction (0.35, 0.5, 1) from the target. With a distance, eye is only a direction.
    /// yaw, pitch: degrees around the up axis and above, in place of an eye; 0 for one that is None if the other is not.
    /// fov: vertical view angle in degrees, above 0 and below 180; 37.85 if None, the paper's camera.
    ///
    /// Raises LodrayError: a value that leaves no view.
    #[pyo3(signature = (*, size=Size([1024, 1024]), distance=None, eye=None, target=None, up=None, yaw=None, pitch=None, fov=None))]
    #[expect(clippy::too_many_arguments, reason = "keywords of Python")]
    fn camera(
        &self,
        size: Size,
        distance: Option<f64>,
        eye: Option<Vec<f64>>,
        target: Option<Vec<f64>>,
        up: Option<Vec<f64>>,
        yaw: Option<f64>,
        pitch: Option<f64>,
        fov: Option<f64>,
    ) -> PyResult<PyCamera> {
        let (eye, target, up) = (triple("eye", eye)?, triple("target", target)?, triple("up", up)?);
        camera(&ModelSpace::of(&self.0), size.0, &Place { distance, eye, target, up, yaw, pitch, fov })
    }

    /// A picture of a camera's view, or what its rays met.
    ///
    /// what: "image", an array of uint8 of shape (height, width, 3), sRGB; "hits", an array of lodray.HIT of shape (height, width), whose fields
    /// are distance (t), level, normal and more, pixel by pixel. samples: of a pixel of an image, a square from 1 to 65536; hits have one ray for each pixel.
    /// shading: of an image, "full", "level", "weighted" or "facets", which it is if None. method, knobs: as for `cast`.
    /// Without a camera the picture just holds the whole scene, in 1024 x 1024 pixels.
    ///
    /// Raises LodrayError: an argument that is none of these, too many samples in all, a camera from where the scene cannot be seen, or rays, also
    /// those of more samples, that are none of the job that the scene was pruned for.
    #[pyo3(signature = (camera=None, *, what="image", samples=1, shading=None, method="lod", progress=None, **knobs))]
    #[expect(clippy::too_many_arguments, reason = "keywords of Python")]
    fn render<'py>(
        &self,
        py: Python<'py>,
        camera: Option<&Bound<'py, PyCamera>>,
        what: &str,
        #[pyo3(from_py_with = whole)] samples: i128,
        shading: Option<&str>,
        method: &str,
        progress: Option<&Bound<'py, PyAny>>,
        knobs: Option<&Bound<'py, PyDict>>,
    ) -> PyResult<Bound<'py, PyAny>> {
        self.made(py, method, knobs)?.render(py, camera, what, samples, shading, progress)
    }

    /// What frames cost on a machine: time, energy, traffic, and what limits it, as a dictionary: what `lodray simulate --json` prints.
    ///
    /// machine: a Machine, the name of one, the path of a description or a dictionary; of a list of them the result is a list, of rays that
    /// were traced once. rays: an array as for `cast`, in place of a camera's. compute: "free", or "units" for traversal units that take time.
    /// frames, turn: so many frames after one another, 1 to 10000, the camera turned by so many degrees from one to the next, -360 to 360.
    /// Without camera and rays the camera just holds the whole scene, in 1024 x 1024 pixels.
    /// tiles_in_turn: rays of so many tiles that lie far apart in turn, a power of two up to 64, in place of tile by tile.
    ///
    /// Raises LodrayError: a machine that cannot be, or on which the frame does not end.
    #[pyo3(signature = (machine, camera=None, *, rays=None, method="lod", compute="free", frames=1, turn=3.0, tiles_in_turn=1, progress=None, **knobs))]
    #[expect(clippy::too_many_arguments, reason = "keywords of Python")]
    fn simulate<'py>(
        &self,
        machine: &Bound<'py, PyAny>,
        camera: Option<&Bound<'py, PyCamera>>,
        rays: Option<&Bound<'py, PyAny>>,
        method: &str,
        compute: &str,
        #[pyo3(from_py_with = whole)] frames: i128,
        turn: f64,
        #[pyo3(from_py_with = whole)] tiles_in_turn: i128,
        progress: Option<&Bound<'py, PyAny>>,
        knobs: Option<&Bound<'py, PyDict>>,
    ) -> PyResult<Bound<'py, PyAny>> {
        self.made(machine.py(), method, knobs)?.simulate(machine, camera, rays, compute, frames, turn, tiles_in_turn, progress)
    }

    /// What an error costs, for every method: the document that `lodray error-time` writes, as a dictionary.
    ///
    /// distances: of the eye in bounding radii, one or more. size: of the frame whose costs are simulated, (1920, 1080) pixels by default. methods: names, one or more, lod
    /// and bvh by default; those over the mesh need keep_mesh. machine: as for `simulate`, "haydel2023" if None. compute: "free" or "units".
    /// values: a list for each knob by which methods trade error, such as {"delta": [0.5, 1, 2]}, in place of their own.
    /// samples: of a pixel, a square from 1 to 65536. error_size: most columns and rows that errors are measured with, 1 to 65536. most_samples: of a pixel of the
    /// picture that stands for what should be seen, a square up to 65536; 0 for none. out: a folder for pictures and for views that are done, with which
    /// a run that is started again goes on; one that is removed if None.
    ///
    /// `lodray.table` makes rows of the document for pandas and polars.
    /// Raises LodrayError: an argument that is none of these, a knob by which no method trades error, a method that cannot run, another run, of the
    /// program or of Python, that is writing to out; LodrayFileError: a folder that cannot be made or written to. Lines of out that are no results, or
    /// another version's, are set aside in files beside them, which a UserWarning names; their views are done again.
    #[pyo3(signature = (distances, *, size=Size([1920, 1080]), methods=vec!["lod".to_owned(), "bvh".to_owned()], machine=None, compute="free", values=None, samples=1, error_size=192, most_samples=0, out=None, progress=None))]
    #[expect(clippy::too_many_arguments, reason = "keywords of Python")]
    fn error_time<'py>(
        &self,
        py: Python<'py>,
        distances: Vec<f64>,
        size: Size,
        methods: Vec<String>,
        machine: Option<&Bound<'py, PyAny>>,
        compute: &str,
        values: Option<&Bound<'py, PyDict>>,
        #[pyo3(from_py_with = whole)] samples: i128,
        #[pyo3(from_py_with = whole)] error_size: i128,
        #[pyo3(from_py_with = whole)] most_samples: i128,
        out: Option<PathBuf>,
        progress: Option<&Bound<'py, PyAny>>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let study = Study { distances, size: size.0, methods, compute, values, samples, error_size, most_samples, out };
        error_time(py, &self.0, study, machine, progress)
    }

    /// What a traversal unit for this scene needs, and what can be left out of it: a dictionary of `plan`, `savings` (a list of rows), `data`,
    /// and the gates of the unit and of the full one.
    ///
    /// distances: the unit is for views from these distances in bounding radii only, of this size, (1024, 1024)
    /// pixels by default, and quality delta, 0 or more; for any rays without them.
    ///
    /// Raises LodrayError: a distance that is not above 0, a scene that was pruned for a job.
    #[pyo3(signature = (distances=vec![], *, size=Size([1024, 1024]), delta=1.0, progress=None))]
    fn plan<'py>(
        &self,
        py: Python<'py>,
        distances: Vec<f64>,
        size: Size,
        delta: f64,
        progress: Option<&Bound<'py, PyAny>>,
    ) -> PyResult<Bound<'py, PyAny>> {
        plan(py, &self.0, &distances, size.0, delta, progress)
    }

    fn __repr__(&self) -> String {
        let (scene, name) = (&self.0, &self.0.meta().name);
        format!("Scene('{name}', {} base triangles, {} levels)", scene.trees(), scene.levels())
    }
}
