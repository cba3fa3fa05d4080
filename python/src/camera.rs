//! Cameras.

use crate::arrays::rays;
use crate::errors::{raised, refused};
use lodray::rays::{Camera, DEFAULT_VIEW_ANGLE_DEGREES, ModelSpace, Query, View};
use pyo3::prelude::*;

/// A pinhole camera on a scene: made by `Scene.camera`.
#[pyclass(name = "Camera", frozen, module = "lodray")]
pub struct PyCamera(pub Camera);

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
    let [width, height] = size;
    // The program's words for what it calls by options.
    Camera::new(&view, space, width, height).map(PyCamera).map_err(|error| refused(error.to_string().replace("--", "")))
}

#[pymethods]
impl PyCamera {
    /// The eye in world space: (x, y, z).
    #[getter]
    fn eye(&self) -> [f64; 3] {
        self.0.eye.to_array()
    }

    /// The point it looks at: (x, y, z).
    #[getter]
    fn target(&self) -> [f64; 3] {
        self.0.target.to_array()
    }

    /// What is up: (x, y, z).
    #[getter]
    fn up(&self) -> [f64; 3] {
        self.0.up.to_array()
    }

    /// Vertical view angle in degrees.
    #[getter]
    fn fov(&self) -> f64 {
        self.0.fov
    }

    /// Columns and rows of pixels.
    #[getter]
    fn size(&self) -> (u32, u32) {
        let [width, height] = self.0.pixels();
        (width, height)
    }

    /// Distance from the target in bounding radii of the scene.
    #[getter]
    fn distance(&self) -> f64 {
        self.0.radii
    }

    /// Tangent of the half angle of every pixel's cone.
    #[getter]
    fn cone(&self) -> f64 {
        self.0.tan_theta
    }

    /// The rays of its pixels: an array of lodray.RAY of shape (height, width), the first row at the top.
    fn rays<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let [width, height] = self.0.pixels();
        let row = |(x, y)| {
            let Query { origin: [a, b, c], direction: [u, v, w], radius, tan_theta, t_min, t_max, .. } = self.0.ray(x, y);
            [a, b, c, u, v, w, radius, tan_theta, t_min, t_max, 0.0, -1.0]
        };
        let rows = (0..height).flat_map(|y| (0..width).map(move |x| (x, y))).flat_map(row).collect();
        rays(py, rows)?.call_method1("reshape", (height, width))
    }

    fn __repr__(&self) -> String {
        let ([width, height], eye, target) = (self.0.pixels(), self.0.eye.to_array(), self.0.target.to_array());
        format!("Camera(size=({width}, {height}), eye={eye:?}, target={target:?}, fov={})", self.0.fov)
    }
}

/// The camera that was given, or the program's usual one.
pub fn given(camera: Option<&Bound<'_, PyCamera>>, space: &ModelSpace) -> PyResult<Camera> {
    match camera {
        Some(camera) => Ok(camera.get().0),
        None => Camera::new(&View::default(), space, 1024, 1024).map_err(raised),
    }
}
