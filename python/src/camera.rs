//! Cameras.

use crate::arrays::rays;
use crate::errors::{raised, refused};
use crate::told::{FEW, Told, at_once, beside};
use lodray::mesh::Placement;
use lodray::rays::{Camera, DEFAULT_VIEW_ANGLE_DEGREES, ModelSpace, Query, RAY_COLUMNS, View};
use pyo3::IntoPyObjectExt;
use pyo3::prelude::*;
use rayon::prelude::*;

/// A pinhole camera on a scene: made by `Scene.camera`. It does not change, and those with the same rays are equal. It can be pickled.
#[pyclass(name = "Camera", frozen, module = "lodray")]
pub struct PyCamera {
    camera: Camera,
    /// What it was made of.
    view: View,
    space: ModelSpace,
}

/// The same in numbers of Python: size, eye, direction, target, up, distance and view angle, and of the model's space offset, scale, and corners.
type State =
    ([u32; 2], Option<[f64; 3]>, Option<[f64; 3]>, Option<[f64; 3]>, Option<[f64; 3]>, Option<f64>, f64, [f64; 3], f64, [i32; 3], [i32; 3]);

/// Where a camera is, as the program's options have it.
pub struct Place {
    /// Distance from the target in bounding radii.
    pub distance: Option<f64>,
    /// The eye.
    pub eye: Option<[f64; 3]>,
    /// Where it looks.
    pub target: Option<[f64; 3]>,
    /// What is up.
    pub up: Option<[f64; 3]>,
    /// Degrees around the up axis.
    pub yaw: Option<f64>,
    /// Degrees above the model.
    pub pitch: Option<f64>,
    /// Vertical view angle in degrees.
    pub fov: Option<f64>,
}

/// A camera on a model.
pub fn camera(space: &ModelSpace, size: [u32; 2], place: &Place) -> PyResult<PyCamera> {
    let &Place { distance, eye, target, up, yaw, pitch, fov } = place;
    let view = View { eye, direction: None, target, up, distance, fov: fov.unwrap_or(DEFAULT_VIEW_ANGLE_DEGREES) };
    let view = match (eye, yaw, pitch) {
        (_, None, None) => view,
        (Some(_), ..) => return Err(refused("eye: goes with neither yaw nor pitch")),
        (None, yaw, pitch) => view.around(yaw.unwrap_or(0.0), pitch.unwrap_or(0.0)),
    };
    PyCamera::new(view, *space, size)
}

impl PyCamera {
    fn new(view: View, space: ModelSpace, [width, height]: [u32; 2]) -> PyResult<Self> {
        let camera = Camera::new(&view, &space, width, height).map_err(raised)?;
        Ok(Self { camera, view, space })
    }
}

/// The camera that was pickled as this.
#[pyfunction]
pub fn _camera(state: State) -> PyResult<PyCamera> {
    let (size, eye, direction, target, up, distance, fov, offset, scale, lo, hi) = state;
    // How many zero bits rays have is nothing to a camera.
    let space = ModelSpace { placement: Placement { offset, scale }, lo, hi, zeros: [0; 2] };
    PyCamera::new(View { eye, direction, target, up, distance, fov }, space, size)
}

#[pymethods]
impl PyCamera {
    /// The eye in world space: (x, y, z).
    #[getter]
    fn eye(&self) -> [f64; 3] {
        self.camera.eye.to_array()
    }

    /// The point it looks at: (x, y, z).
    #[getter]
    fn target(&self) -> [f64; 3] {
        self.camera.target.to_array()
    }

    /// What is up: (x, y, z).
    #[getter]
    fn up(&self) -> [f64; 3] {
        self.camera.up.to_array()
    }

    /// Vertical view angle in degrees.
    #[getter]
    fn fov(&self) -> f64 {
        self.camera.fov
    }

    /// Columns and rows of pixels.
    #[getter]
    fn size(&self) -> (u32, u32) {
        let [width, height] = self.camera.pixels();
        (width, height)
    }

    /// Distance from the target in bounding radii of the scene.
    #[getter]
    fn distance(&self) -> f64 {
        self.camera.radii
    }

    /// Tangent of the half angle of every pixel's cone.
    #[getter]
    fn cone(&self) -> f64 {
        self.camera.tan_theta
    }

    /// The rays of its pixels: an array of lodray.RAY of shape (height, width), the first row at the top.
    ///
    /// `Scene.cast` of it has hits of shape (height * width,). A ray takes 96 bytes. Control-C stops it, and other threads run meanwhile.
    fn rays<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let [width, height] = self.camera.pixels();
        let count = width as usize * height as usize;
        let work = |told: &Told| {
            let mut all = vec![0.0; count * RAY_COLUMNS];
            (0..height).into_par_iter().zip(all.par_chunks_mut(width as usize * RAY_COLUMNS)).for_each(|(y, row)| {
                // Before the row: each thread has many parts left when the work is to stop.
                told.step(1);
                for (x, ray) in (0..width).zip(row.as_chunks_mut().0) {
                    let Query { origin: [a, b, c], direction: [u, v, w], radius, tan_theta, t_min, t_max, .. } = self.camera.ray(x, y);
                    *ray = [a, b, c, u, v, w, radius, tan_theta, t_min, t_max, 0.0, -1.0];
                }
            });
            all
        };
        let all = if (count as u64) < FEW { at_once(py, work) } else { beside(py, None, work)? };
        rays(py, all)?.call_method1("reshape", (height, width))
    }

    fn __copy__(slf: Py<Self>) -> Py<Self> {
        slf
    }

    fn __deepcopy__(slf: Py<Self>, _memo: &Bound<'_, PyAny>) -> Py<Self> {
        slf
    }

    /// Cameras are the same that have the same rays.
    fn __eq__(&self, other: &Self) -> bool {
        self.camera == other.camera
    }

    fn __hash__(&self, py: Python<'_>) -> PyResult<isize> {
        let ([x, y, z], [u, v, w]) = (self.eye(), self.target());
        (x, y, z, u, v, w, self.fov(), self.size()).into_bound_py_any(py)?.hash()
    }

    fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<(Bound<'py, PyAny>, (State,))> {
        let View { eye, direction, target, up, distance, fov } = self.view;
        let ModelSpace { placement: Placement { offset, scale }, lo, hi, .. } = self.space;
        let state = (self.camera.pixels(), eye, direction, target, up, distance, fov, offset, scale, lo, hi);
        Ok((py.import("lodray._lodray")?.getattr("_camera")?, (state,)))
    }

    fn __repr__(&self) -> String {
        let ([width, height], eye, target) = (self.camera.pixels(), self.camera.eye.to_array(), self.camera.target.to_array());
        format!("Camera(size=({width}, {height}), eye={eye:?}, target={target:?}, fov={})", self.camera.fov)
    }
}

/// The camera that was given, or the program's usual one.
pub fn given(camera: Option<&Bound<'_, PyCamera>>, space: &ModelSpace) -> PyResult<Camera> {
    match camera {
        Some(camera) => Ok(camera.get().camera),
        None => Camera::new(&View::default(), space, 1024, 1024).map_err(raised),
    }
}
