//! A camera's rays as a job has them.

use super::Camera;
use super::camera::{CameraError, MAX_PIXELS, MAX_SIDE};
use crate::format::JobView;
use glam::DVec3;

impl Camera {
    /// Its rays at quality `delta`, of a camera that sees its whole frame.
    pub fn job_view(&self, delta: f64) -> JobView {
        JobView {
            size: [self.width, self.height],
            delta: delta.to_string(),
            eye: self.eye.to_array(),
            forward: self.forward.to_array(),
            right: self.right.to_array(),
            above: self.above.to_array(),
            shift: self.shift,
            cone: self.tan_theta,
        }
    }

    /// A camera with these rays: what rays do not follow from is not theirs.
    ///
    /// # Errors
    /// There are none, or too many.
    pub fn of_job(view: &JobView) -> Result<Self, CameraError> {
        let [width, height] = view.size;
        let pixels = u64::from(width) * u64::from(height);
        if pixels == 0 || width.max(height) > MAX_SIDE || pixels > MAX_PIXELS {
            return Err(CameraError::Field("size", format!("at most {MAX_SIDE} pixels wide and high, and {MAX_PIXELS} in all")));
        }
        let [eye, forward, right, above] = [view.eye, view.forward, view.right, view.above].map(DVec3::from_array);
        Ok(Self {
            eye,
            target: eye + forward,
            up: above,
            fov: 0.0,
            placed: None,
            radii: 0.0,
            forward,
            right,
            above,
            shift: view.shift,
            middle: view.size.map(|n| 0.5 * f64::from(n)),
            width,
            height,
            samples: 1,
            stride: 1,
            tan_theta: view.cone,
            tiles_in_turn: 1,
        })
    }
}

#[cfg(test)]
mod tests {
    use crate::mesh::Placement;
    use crate::rays::{Camera, ModelSpace, View};

    #[test]
    fn a_view_gives_the_same_rays_back() {
        let space = ModelSpace {
            placement: Placement { offset: [1.0, 0.3, 0.0], scale: 0.1 },
            lo: [-10, -20, -30],
            hi: [10, 20, 31],
            zeros: [0; 2],
        };
        let view = View { eye: Some([1.1, 7.0, 9.3]), ..View::default() };
        let camera = Camera::new(&view, &space, 19, 13).unwrap().shifted([0.25, 0.0]);
        for delta in [1.0, 0.3, f64::INFINITY] {
            let job = camera.job_view(delta);
            let text = serde_json::to_string(&job).unwrap();
            let back = Camera::of_job(&serde_json::from_str(&text).unwrap()).unwrap();
            assert_eq!((back.job_view(delta), job.quality()), (job, Some(delta)));
            assert!((0..19).flat_map(|x| (0..13).map(move |y| (x, y))).all(|(x, y)| back.ray(x, y) == camera.ray(x, y)));
        }
        assert!(Camera::of_job(&crate::format::JobView { size: [0, 4], ..camera.job_view(1.0) }).is_err());
        assert_ne!(camera.job_view(1.0), camera.with_samples(2).unwrap().job_view(1.0));
    }
}
