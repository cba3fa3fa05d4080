//! The pinhole camera.

use super::{DEFAULT_DIRECTION, ModelSpace, Query, View, ViewCone, orbit};
use glam::DVec3;
use std::ops::Range;
use thiserror::Error;

/// Room around the model's bounding sphere where the eye is placed so that all of it is seen, in radii.
const MARGIN: f64 = 0.02;

/// Farthest that the eye is placed so, in bounding radii.
const FARTHEST: f64 = 1e6;

/// Most columns and rows of a picture.
pub const MAX_SIDE: u32 = 1 << 16;
/// Most pixels of a picture: traced pixels and their shading then stay below 8 GB.
pub const MAX_PIXELS: u64 = 1 << 26;

/// Columns and rows of a camera's tile: a batch of its rays.
pub const TILE: u32 = 8;

/// Most tiles whose rays are handed out in turn: of each there is one ray in a batch.
pub const MOST_IN_TURN: u32 = TILE * TILE;

/// Whether rays of so many tiles can be handed out in turn: the rays of a tile are divided evenly over batches.
pub fn may_be_in_turn(tiles: u32) -> bool {
    tiles.is_power_of_two() && tiles <= MOST_IN_TURN
}

/// A view that cannot be.
#[derive(Clone, Debug, Error, PartialEq)]
pub enum CameraError {
    /// Not a number a camera can use.
    #[error("{0} must be {1}")]
    Field(&'static str, String),
}

fn field<T>(name: &'static str, must_be: impl Into<String>) -> Result<T, CameraError> {
    Err(CameraError::Field(name, must_be.into()))
}

/// A camera with its image size.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Camera {
    /// Eye in world space.
    pub eye: DVec3,
    /// Where it looks.
    pub target: DVec3,
    /// What was asked to be up.
    pub up: DVec3,
    /// Vertical view angle in degrees.
    pub fov: f64,
    /// Distance from the target in bounding radii, if the eye was placed by it.
    pub placed: Option<f64>,
    /// Distance from the target in bounding radii.
    pub radii: f64,
    pub(super) forward: DVec3,
    /// To the next sample on the right, and up, for a picture plane at distance 1.
    pub(super) right: DVec3,
    pub(super) above: DVec3,
    /// Where the picture's rays begin, in samples to the right and down.
    pub(super) shift: [f64; 2],
    /// The middle of the whole frame, in samples to the right and down.
    pub(super) middle: [f64; 2],
    /// Columns of samples: of pixels, where a pixel has one.
    pub width: u32,
    /// Rows of samples.
    pub height: u32,
    /// Samples along a side of a pixel.
    pub samples: u32,
    /// Of the frame's columns and rows of pixels it sees one in so many; 1 for all.
    pub stride: u32,
    /// Tangent of the half angle of every pixel's cone: half a pixel at the picture's centre.
    pub tan_theta: f64,
    /// Tiles whose rays a machine is handed in turn: 1, or a larger power of two up to [`MOST_IN_TURN`].
    pub(super) tiles_in_turn: u32,
}

impl Camera {
    /// The camera of `view` on a model, for a picture of `width` x `height` pixels.
    ///
    /// # Errors
    /// Names the field that is not finite, not positive, or leaves no direction.
    pub fn new(view: &View, space: &ModelSpace, width: u32, height: u32) -> Result<Self, CameraError> {
        let finite = |v: Option<[f64; 3]>, name| match v {
            Some(v) if !v.iter().all(|c| c.is_finite()) => field(name, "three finite numbers"),
            v => Ok(v.map(DVec3::from_array)),
        };
        let (eye, target, up) = (finite(view.eye, "--eye")?, finite(view.target, "--target")?, finite(view.up, "--up")?);
        let direction = finite(view.direction, "the direction of the eye")?;
        if !(view.fov > 0.0 && view.fov < 180.0) {
            return field("--fov", "between 0 and 180 degrees");
        }
        if width == 0 || height == 0 || width > MAX_SIDE || height > MAX_SIDE || u64::from(width) * u64::from(height) > MAX_PIXELS {
            return field("--size", format!("at most {MAX_SIDE} pixels wide and high, and {MAX_PIXELS} in all"));
        }
        let half_height = half_tangent(view.fov);
        let half_width = half_height * f64::from(width) / f64::from(height);
        let target = target.unwrap_or_else(|| DVec3::from_array(space.centre()));
        let (eye, placed) = match (eye, view.distance) {
            (Some(eye), None) => (eye, None),
            (eye, distance) => {
                let default = || direction.unwrap_or_else(|| orbit::turned(up, DVec3::from_array(DEFAULT_DIRECTION)));
                let Some(direction) = eye.map_or_else(default, |e| e - target).try_normalize() else {
                    return field("--eye", "different from --target");
                };
                let distance = match distance {
                    Some(distance) if distance > 0.0 && distance.is_finite() => distance,
                    Some(_) => return field("--distance", "a positive number of bounding radii"),
                    None => {
                        let (side, above) = across(-direction, up)?;
                        let centre = DVec3::from_array(space.centre()) - target;
                        fit([(side, half_width), (above, half_height)], -direction, centre / space.radius())?
                    }
                };
                (target + direction * (distance * space.radius()), Some(distance))
            }
        };
        let Some(forward) = (target - eye).try_normalize() else { return field("--eye", "different from --target") };
        let (side, above) = across(forward, up)?;
        let pixel = 2.0 * half_height / f64::from(height);
        Ok(Self {
            eye,
            target,
            up: up.unwrap_or(DVec3::Y),
            fov: view.fov,
            placed,
            radii: placed.unwrap_or_else(|| (target - eye).length() / space.radius()),
            forward,
            right: side * pixel,
            above: above * pixel,
            shift: [0.0; 2],
            middle: [width, height].map(|n| 0.5 * f64::from(n)),
            width,
            height,
            samples: 1,
            stride: 1,
            tan_theta: 0.5 * pixel,
            tiles_in_turn: 1,
        })
    }

    /// The same camera for the simulator, its rays in batches of so many tiles that lie far apart, of each as many: a group of cores then has rays of all of them at a time, of sky and of surface,
    /// and its units are not full in one block for one tile and in another for the next. For traversal of single rays: packets are of one tile.
    ///
    /// # Panics
    /// It is no number of tiles that can be handed out in turn.
    #[must_use]
    pub fn in_turn(self, tiles: u32) -> Self {
        assert!(may_be_in_turn(tiles), "{tiles} tiles in turn");
        Self { tiles_in_turn: tiles, ..self }
    }

    /// Tiles whose rays a machine is handed in turn; 1: tile by tile.
    pub fn tiles_in_turn(&self) -> u32 {
        self.tiles_in_turn
    }

    /// A cone around all its rays.
    pub fn view_cone(&self) -> ViewCone {
        // From the middle of the whole frame to its borders.
        let side = |k: usize| self.middle[k] + self.shift[k].abs();
        let tangent = (side(0) * self.right.length()).hypot(side(1) * self.above.length());
        ViewCone { axis: self.forward.to_array(), tangent }
    }

    /// Tangent of the half angle of the cones of a camera that sees so many degrees from bottom to top in so many rows of pixels.
    pub fn cone(fov: f64, height: u32) -> f64 {
        half_tangent(fov) / f64::from(height)
    }

    /// The same picture with `side` x `side` samples in each pixel, on a regular grid, each with the cone of the whole pixel: what level of detail
    /// leaves out is what a pixel does not show, however often it is sampled.
    ///
    /// # Errors
    /// There are none, or too many in all.
    pub fn with_samples(self, side: u32) -> Result<Self, CameraError> {
        let [width, height] = self.pixels().map(|n| u64::from(n) * u64::from(side));
        if side == 0 || width.max(height) > u64::from(MAX_SIDE) || width * height > MAX_PIXELS {
            return field(
                "samples",
                format!("at least one, and with the picture's size at most {MAX_PIXELS} in all and {MAX_SIDE} along a side"),
            );
        }
        let scale = f64::from(side) / f64::from(self.samples);
        Ok(Self {
            right: self.right / scale,
            above: self.above / scale,
            shift: self.shift.map(|s| s * scale),
            middle: self.middle.map(|s| s * scale),
            width: width as u32, // at most MAX_SIDE
            height: height as u32,
            samples: side,
            ..self
        })
    }

    /// Of the same frame the middle one in every `stride` columns and rows of pixels, each with its own samples and cone: a small picture of what the
    /// large one has, pixel by pixel. A frame has one column and row at least.
    #[must_use]
    pub fn every(self, stride: u32) -> Self {
        let [width, height] = self.pixels();
        let stride = stride.clamp(1, width.min(height));
        let [width, height] = [width, height].map(|n| n / stride * self.samples);
        Self { width, height, stride: self.stride * stride, ..self }
    }

    /// The same with all rays moved by so many pixels to the right and down.
    #[must_use]
    pub fn shifted(self, pixels: [f64; 2]) -> Self {
        let shift = std::array::from_fn(|k| self.shift[k] + pixels[k] * f64::from(self.samples));
        Self { shift, ..self }
    }

    /// Columns and rows of pixels.
    pub fn pixels(&self) -> [u32; 2] {
        [self.width, self.height].map(|n| n / self.samples)
    }

    /// The ray through the centre of pixel (`x`, `y`), row 0 at the top.
    pub fn ray(&self, x: u32, y: u32) -> Query {
        // The frame has at most 2^16 columns and rows of samples.
        let [x, y] = [x, y].map(|n| (n / self.samples * self.stride + self.stride / 2) * self.samples + n % self.samples);
        self.ray_at(f64::from(x) + 0.5, f64::from(y) + 0.5)
    }

    /// The ray through position (`x`, `y`) of the whole frame, in pixels.
    pub fn ray_at(&self, x: f64, y: f64) -> Query {
        let [x, y] = [x + self.shift[0] - self.middle[0], y + self.shift[1] - self.middle[1]];
        let direction = self.forward + self.right * x - self.above * y;
        Query::new(self.eye.to_array(), direction.normalize().to_array()).with_cone(0.0, self.tan_theta)
    }

    /// Where a direction forwards from the eye is in the whole frame, in pixels; the inverse of [`Self::ray_at`].
    fn project(&self, v: DVec3) -> [f64; 2] {
        let v = v / v.dot(self.forward);
        let along = |axis: DVec3| v.dot(axis) / axis.length_squared();
        let [x, y] = [self.middle[0] + along(self.right), self.middle[1] - along(self.above)];
        [x - self.shift[0], y - self.shift[1]]
    }

    /// Columns and rows outside which no ray meets the model's enlarged box.
    pub fn window(&self, space: &ModelSpace) -> [Range<u32>; 2] {
        // In units, as rays enter the box, and from the eye.
        let eye = DVec3::from_array(space.to_units(self.eye.to_array()));
        let corners = space.enlarged().map(|c| DVec3::from_array(c) - eye);
        let sizes = [self.width, self.height];
        let near = 1e-3 * space.radius() / space.placement.scale;
        if !corners.iter().all(|c| c.dot(self.forward) >= near) {
            // Beside or behind the eye: anywhere.
            return sizes.map(|n| 0..n);
        }
        let points = corners.map(|c| self.project(c));
        std::array::from_fn(|k| {
            let least = points.iter().map(|p| p[k]).fold(f64::INFINITY, f64::min);
            let most = points.iter().map(|p| p[k]).fold(f64::NEG_INFINITY, f64::max);
            // A pixel more, for rounding. Where the frame's pixels are left out, of one that is not all samples count.
            let [own, step] = if self.stride == 1 { [1, 1] } else { [self.samples, self.samples * self.stride] }.map(f64::from);
            let pixel = |v: f64| (v * own).clamp(0.0, f64::from(sizes[k])) as u32; // at most MAX_SIDE
            pixel(((least.floor() - 1.0) / step).floor())..pixel(((most.ceil() + 1.0) / step).ceil())
        })
    }
}

/// Unit vectors to the right and up in the picture of an eye that looks along `forward`.
fn across(forward: DVec3, up: Option<DVec3>) -> Result<(DVec3, DVec3), CameraError> {
    let side = forward.cross(up.unwrap_or(DVec3::Y));
    // Nearly along the view direction, rounding would decide what is up.
    let clear = side.length() > 1e-9 * up.unwrap_or(DVec3::Y).length();
    let side = match side.try_normalize().filter(|_| clear) {
        Some(side) => side,
        // Looking straight up or down: any other axis serves.
        None if up.is_none() => forward.cross(DVec3::NEG_Z).normalize(),
        None => return field("--up", format!("neither 0 nor along the view direction {}", shown(forward))),
    };
    Ok((side, side.cross(forward)))
}

/// Distance from the target, in bounding radii, at which a picture holds the bounding sphere and its margin. `half` are the picture's axes with the
/// tangents of their half angles; `centre` is that of the sphere as seen from the target, in radii.
fn fit(half: [(DVec3, f64); 2], forward: DVec3, centre: DVec3) -> Result<f64, CameraError> {
    let radius = 1.0 + MARGIN;
    let mut distance = radius;
    for (axis, tangent) in half {
        for axis in [axis, -axis] {
            // The plane through the eye and that border of the picture; its normal points inwards.
            let inwards = (axis + forward * tangent).normalize();
            distance = distance.max((radius - centre.dot(inwards)) / forward.dot(inwards));
        }
    }
    let distance = (distance * 100.0).ceil() / 100.0;
    if distance <= FARTHEST {
        Ok(distance)
    } else {
        field("--distance", format!("given: at this --fov the whole model is seen from beyond {FARTHEST} bounding radii only"))
    }
}

/// A vector as an option takes it.
fn shown(v: DVec3) -> String {
    format!("{},{},{}", v.x, v.y, v.z)
}

/// Half the height of a picture at distance 1.
fn half_tangent(fov: f64) -> f64 {
    (0.5 * fov.to_radians()).tan()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::Placement;
    use crate::rays::DEFAULT_VIEW_ANGLE_DEGREES;

    fn space() -> ModelSpace {
        let side = 1 << 20;
        ModelSpace { placement: Placement { offset: [0.0; 3], scale: 1.0 / f64::from(side) }, lo: [-side; 3], hi: [side; 3], zeros: [0; 2] }
    }

    #[test]
    fn the_default_angle_is_that_of_a_35_mm_lens() {
        assert!((DEFAULT_VIEW_ANGLE_DEGREES - 2.0 * (12.0f64 / 35.0).atan().to_degrees()).abs() < 1e-9);
    }

    #[test]
    fn samples_fill_their_pixel_with_its_cone_and_shifts_are_in_pixels() {
        let one = Camera::new(&View::default(), &space(), 30, 20).unwrap();
        let four = one.with_samples(4).unwrap();
        assert_eq!((four.pixels(), four.width, four.height, four.tan_theta), ([30, 20], 120, 80, one.tan_theta));
        let near = |a: Query, b: Query| (DVec3::from_array(a.direction) - DVec3::from_array(b.direction)).length() < 1e-12;
        for (x, y) in [(0, 0), (17, 3), (29, 19)] {
            for (i, j) in [(0, 0), (3, 1)] {
                let [u, v] = [(x, i), (y, j)].map(|(pixel, k)| f64::from(pixel) + (f64::from(k) + 0.5) / 4.0);
                assert!(near(four.ray(4 * x + i, 4 * y + j), one.ray_at(u, v)));
                let moved = one.shifted([0.5, -1.0]);
                assert!(near(moved.with_samples(4).unwrap().ray(4 * x + i, 4 * y + j), one.ray_at(u + 0.5, v - 1.0)));
                assert!(near(four.shifted([0.5, -1.0]).ray(4 * x + i, 4 * y + j), one.ray_at(u + 0.5, v - 1.0)));
            }
            assert!(near(four.with_samples(1).unwrap().ray(x, y), one.ray(x, y)));
        }
        assert_eq!(one.with_samples(1), Ok(one));
        assert!(one.with_samples(0).is_err() && one.with_samples(1 << 12).is_err() && one.with_samples(1 << 31).is_err());
    }

    #[test]
    fn every_so_many_columns_and_rows_have_the_rays_of_the_frame() {
        let frame = Camera::new(&View { distance: Some(4.0), ..View::default() }, &space(), 32, 21).unwrap();
        for (stride, pixels) in [(1, [32, 21]), (2, [16, 10]), (5, [6, 4]), (99, [1, 1])] {
            let few = frame.every(stride);
            assert_eq!((few.pixels(), few.tan_theta), (pixels, frame.tan_theta));
            let stride = stride.min(21);
            for (x, y) in [(0, 0), (pixels[0] / 2, pixels[1] / 3), (pixels[0] - 1, pixels[1] - 1)] {
                assert_eq!(few.ray(x, y), frame.ray(x * stride + stride / 2, y * stride + stride / 2));
                let [few, frame] = [few, frame].map(|camera| camera.with_samples(3).unwrap().shifted([0.5, 0.25]));
                assert_eq!(few.ray(3 * x + 2, 3 * y), frame.ray(3 * (x * stride + stride / 2) + 2, 3 * (y * stride + stride / 2)));
            }
            // What misses outside of the frame's window misses outside of this one's.
            let few = few.with_samples(2).unwrap();
            let [columns, rows] = few.window(&space());
            for (x, y) in (0..few.width).flat_map(|x| (0..few.height).map(move |y| (x, y))) {
                assert!(columns.contains(&x) && rows.contains(&y) || space().enter(&few.ray(x, y), 1.0).is_none(), "{stride}: {x}, {y}");
            }
        }
        assert_eq!((frame.every(1), frame.every(2).every(2).stride), (frame, 4));
    }

    #[test]
    fn distance_is_in_bounding_radii_and_the_cone_is_half_a_pixel() {
        let camera = Camera::new(&View { distance: Some(4.0), ..View::default() }, &space(), 64, 32).unwrap();
        assert!((camera.eye.length() - 4.0 * 3f64.sqrt()).abs() < 1e-9);
        assert!((camera.tan_theta - 12.0 / 35.0 / 32.0).abs() < 1e-12);
        let middle = camera.ray_at(32.0, 16.0);
        assert!((DVec3::from_array(middle.direction) - camera.forward).length() < 1e-12);
    }

    #[test]
    fn the_default_view_holds_the_bounding_sphere_tightly() {
        let space = ModelSpace { lo: [-(1 << 20), -300_000, 5], ..space() };
        let (centre, radius) = (DVec3::from_array(space.centre()), space.radius());
        let sphere: Vec<DVec3> = (0..200)
            .flat_map(|i| {
                (0..400).map(move |j| (f64::from(i) / 199.0 * std::f64::consts::PI, f64::from(j) / 400.0 * std::f64::consts::TAU))
            })
            .map(|(a, b)| centre + radius * DVec3::new(a.sin() * b.cos(), a.cos(), a.sin() * b.sin()))
            .collect();
        for (width, height) in [(64, 64), (300, 200), (50, 700), (1, 1)] {
            for fov in [1.0, DEFAULT_VIEW_ANGLE_DEGREES, 100.0, 170.0] {
                for target in [None, Some([0.3, 0.1, -0.2])] {
                    let view = View { fov, target, ..View::default() };
                    let camera = Camera::new(&view, &space, width, height).unwrap();
                    // How far towards a border the sphere reaches, 1 being the border.
                    let reach = sphere.iter().map(|&p| {
                        let [x, y] = camera.project(p - camera.eye);
                        (2.0 * x / f64::from(width) - 1.0).abs().max((2.0 * y / f64::from(height) - 1.0).abs())
                    });
                    let reach = reach.fold(0.0, f64::max);
                    assert!(reach < 1.0, "{width}x{height} {fov} {target:?}: {reach}");
                    let closer = View { distance: Some(0.95 * camera.placed.unwrap()), ..view };
                    let closer = Camera::new(&closer, &space, width, height).unwrap();
                    // Below about 0.95 of the distance and its margin of 0.02 a sphere is cut; at wide angles the eye would be within it.
                    let cut = sphere.iter().any(|&p| {
                        let [x, y] = closer.project(p - closer.eye);
                        let behind = (p - closer.eye).dot(closer.forward) <= 0.0;
                        behind || x < 0.0 || y < 0.0 || x > f64::from(width) || y > f64::from(height)
                    });
                    assert!(cut, "{width}x{height} {fov} {target:?}: not tight");
                }
            }
        }
    }

    #[test]
    fn rays_outside_the_window_miss_and_the_window_is_tight() {
        let space = ModelSpace { lo: [-(1 << 20), -300_000, 5], ..space() };
        let mut narrow = 0;
        for k in 0..60 {
            let (a, b) = (f64::from(k) * 0.7, f64::from(k % 7) - 3.0);
            let direction = Some([a.cos(), 0.4 * b, a.sin()]);
            let distance = Some([0.1, 0.6, 1.0, 1.5, 4.0, 30.0][k as usize % 6]);
            let target = (k % 3 == 0).then_some([0.9, -0.2, 0.8]);
            let camera = Camera::new(&View { direction, distance, target, fov: 60.0, ..View::default() }, &space, 45, 35).unwrap();
            let camera = camera.with_samples(2).unwrap().shifted([f64::from(k % 3), -0.5 * f64::from(k % 4)]);
            let [columns, rows] = camera.window(&space);
            let hit = |x, y| space.enter(&camera.ray(x, y), 1.0).is_some();
            for (x, y) in (0..90).flat_map(|x| (0..70).map(move |y| (x, y))) {
                assert!(columns.contains(&x) && rows.contains(&y) || !hit(x, y), "{k}: ({x}, {y}) outside {columns:?} {rows:?}");
            }
            if rows != (0..70) && !rows.is_empty() && !columns.is_empty() {
                narrow += 1;
                assert!(rows.clone().take(4).any(|y| (0..90).any(|x| hit(x, y))) || rows.start == 0, "{k}: {rows:?}");
            }
        }
        assert!(narrow > 20, "{narrow}");
    }

    #[test]
    fn the_default_distance_can_be_given_as_a_number() {
        let camera = Camera::new(&View::default(), &space(), 64, 64).unwrap();
        assert_eq!(camera.placed, Some(3.15));
        assert_eq!(Camera::new(&View { distance: Some(3.15), ..View::default() }, &space(), 64, 64), Ok(camera));
        assert!((camera.radii - 3.15).abs() < 1e-12);
        let eye = View { eye: Some([0.0, 0.0, 9.0]), ..View::default() };
        let camera = Camera::new(&eye, &space(), 64, 64).unwrap();
        assert_eq!((camera.placed, camera.radii), (None, 9.0 / space().radius()));
    }

    #[test]
    fn views_that_cannot_be_name_their_field() {
        let refuse = |view: View| Camera::new(&view, &space(), 8, 8).unwrap_err().to_string();
        assert!(refuse(View { fov: 180.0, ..View::default() }).contains("--fov"));
        assert!(refuse(View { fov: 1e-7, ..View::default() }).contains("--distance"));
        assert!(refuse(View { distance: Some(-1.0), ..View::default() }).contains("--distance"));
        assert!(refuse(View { eye: Some([0.0; 3]), target: Some([0.0; 3]), ..View::default() }).contains("--eye"));
        assert!(refuse(View { eye: Some([f64::NAN; 3]), ..View::default() }).contains("--eye"));
        for up in [[0.0; 3], [0.0, 0.0, 7.0], [1e-12, 0.0, 1.0]] {
            let said = refuse(View { eye: Some([0.0, 0.0, 4.0]), up: Some(up), ..View::default() });
            assert_eq!(said, "--up must be neither 0 nor along the view direction 0,0,-1");
        }
        assert!(Camera::new(&View { eye: Some([0.0, 4.0, 0.0]), ..View::default() }, &space(), 8, 8).is_ok(), "straight down");
    }
}
