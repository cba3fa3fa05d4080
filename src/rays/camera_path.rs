//! A camera that moves: frames after one another.

use super::{Camera, Eye, ModelSpace, Query, RaySource};
use glam::{DQuat, DVec3};

/// The frames of a camera that moves, in order; at least one.
#[derive(Clone, Debug, PartialEq)]
pub struct CameraPath {
    cameras: Vec<Camera>,
}

impl Camera {
    /// The same camera, turned by `degrees` about the up axis through its target, counter-clockwise as seen from above.
    #[must_use]
    pub fn turned(self, degrees: f64) -> Self {
        // What is up is never 0: the camera was made with it.
        let turn = DQuat::from_axis_angle(self.up.normalize_or(DVec3::Y), degrees.to_radians());
        Self {
            eye: self.target + turn * (self.eye - self.target),
            forward: turn * self.forward,
            right: turn * self.right,
            above: turn * self.above,
            ..self
        }
    }
}

impl CameraPath {
    /// These frames.
    ///
    /// # Panics
    /// There is none.
    pub fn new(cameras: Vec<Camera>) -> Self {
        assert!(!cameras.is_empty(), "a path has one frame or more");
        Self { cameras }
    }

    /// `frames` frames of a camera that turns by `degrees` about its target from one to the next; one at least.
    pub fn turning(camera: &Camera, frames: u32, degrees: f64) -> Self {
        Self { cameras: (0..frames.max(1)).map(|frame| camera.turned(f64::from(frame) * degrees)).collect() }
    }

    /// Its frames.
    pub fn cameras(&self) -> &[Camera] {
        &self.cameras
    }

    /// The frame of a batch, and the batch within it.
    fn frame(&self, batch: usize) -> (usize, usize) {
        let mut within = batch;
        for (frame, camera) in self.cameras.iter().enumerate() {
            if within < camera.batches() {
                return (frame, within);
            }
            within -= camera.batches();
        }
        panic!("there is no batch {batch}")
    }
}

impl RaySource for CameraPath {
    fn rays(&self) -> u64 {
        self.cameras.iter().map(RaySource::rays).sum()
    }

    fn batches(&self) -> usize {
        self.cameras.iter().map(RaySource::batches).sum()
    }

    /// Rays of a frame are numbered behind those of the frames before.
    fn batch(&self, batch: usize, each: &mut dyn FnMut(u64, &Query)) {
        let (frame, within) = self.frame(batch);
        let before: u64 = self.cameras[..frame].iter().map(RaySource::rays).sum();
        self.cameras[frame].batch(within, &mut |number, query| each(before + number, query));
    }

    fn frame_starts(&self) -> Vec<usize> {
        let mut start = 0;
        let starts = self.cameras[..self.cameras.len() - 1].iter().map(|camera| {
            start += camera.batches();
            start
        });
        starts.collect()
    }

    /// Of all frames: what a method chooses once, it chooses for all of them.
    fn least_radius(&self, space: &ModelSpace) -> f64 {
        self.cameras.iter().map(|camera| camera.least_radius(space)).fold(f64::INFINITY, f64::min)
    }

    /// Of all frames, as above.
    fn eyes(&self, space: &ModelSpace) -> Vec<Eye> {
        self.cameras.iter().flat_map(|camera| camera.eyes(space)).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::Placement;
    use crate::rays::View;

    fn camera(up: Option<[f64; 3]>) -> (Camera, ModelSpace) {
        let space =
            ModelSpace { placement: Placement { offset: [0.0; 3], scale: 0.1 }, lo: [-10, -20, -30], hi: [10, 20, 30], zeros: [0; 2] };
        let view = View { eye: Some([1.0, 2.0, 7.0]), target: Some([0.5, 0.0, 1.0]), up, ..View::default() };
        (Camera::new(&view, &space, 19, 13).unwrap(), space)
    }

    #[test]
    fn a_turn_keeps_distance_and_pixels_and_four_right_angles_come_back() {
        for up in [None, Some([0.0, 0.0, 1.0]), Some([1.0, 2.0, -0.5])] {
            let (camera, space) = camera(up);
            let quarter = camera.turned(90.0);
            let radius = |camera: &Camera| (camera.eye - camera.target).length();
            assert!((radius(&quarter) - radius(&camera)).abs() < 1e-12);
            assert!((quarter.eye - camera.target).dot(camera.up) - (camera.eye - camera.target).dot(camera.up) < 1e-12);
            // As if it had been made there.
            let view = View { eye: Some(quarter.eye.to_array()), target: Some(quarter.target.to_array()), up, ..View::default() };
            let made = Camera::new(&view, &space, 19, 13).unwrap();
            for (x, y) in [(0, 0), (18, 12), (7, 3)] {
                let [a, b] = [&quarter, &made].map(|camera| DVec3::from_array(camera.ray(x, y).direction));
                assert!((a - b).length() < 1e-12);
            }
            let back = (0..4).fold(camera, |camera, _| camera.turned(90.0));
            assert!((back.eye - camera.eye).length() < 1e-12);
        }
        // From the front to the side of +x.
        let (camera, _) = camera(None);
        let at = |camera: &Camera| camera.eye - camera.target;
        assert!((at(&camera.turned(90.0)) - DVec3::new(at(&camera).z, at(&camera).y, -at(&camera).x)).length() < 1e-12);
    }

    #[test]
    fn a_path_gives_every_ray_of_its_frames_in_order() {
        let (camera, space) = camera(None);
        let path = CameraPath::turning(&camera, 3, 10.0);
        assert_eq!((path.rays(), path.batches()), (3 * camera.rays(), 3 * camera.batches()));
        assert_eq!(path.frame_starts(), [camera.batches(), 2 * camera.batches()]);
        let mut seen = vec![0; path.rays() as usize];
        for batch in 0..path.batches() {
            path.batch(batch, &mut |number, query| {
                seen[number as usize] += 1;
                let (frame, pixel) = (number / camera.rays(), (number % camera.rays()) as u32);
                assert_eq!(*query, camera.turned(10.0 * frame as f64).ray(pixel % 19, pixel / 19));
            });
        }
        assert!(seen.iter().all(|&times| times == 1));
        let least = |camera: &Camera| camera.least_radius(&space);
        let radii = path.cameras().iter().map(least).collect::<Vec<_>>();
        assert!(radii.contains(&path.least_radius(&space)) && radii.iter().all(|&radius| radius >= path.least_radius(&space)));
        assert!(CameraPath::new(vec![camera]).frame_starts().is_empty());
    }
}
