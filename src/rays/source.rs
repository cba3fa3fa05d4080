//! Where rays come from.

use super::{Camera, Eye, ModelSpace, Query, TILE};

/// Rays in batches; a group of cores takes a batch at a time.
pub trait RaySource: Sync {
    /// Rays in all.
    fn rays(&self) -> u64;

    /// How many batches there are.
    fn batches(&self) -> usize;

    /// Tells `each` the number and the query of every ray of a batch, in their order.
    fn batch(&self, batch: usize, each: &mut dyn FnMut(u64, &Query));

    /// Some ray starts behind the end of another.
    fn is_ordered(&self) -> bool {
        false
    }

    /// The first batches of the frames behind the first, in order: rays of a frame come when all of the frames before have ended.
    fn frame_starts(&self) -> Vec<usize> {
        Vec::new()
    }

    /// A radius, in world units, that no ray's cone falls below within the model's box: the cone's at the box's distance from the ray's origin.
    fn least_radius(&self, space: &ModelSpace) -> f64;

    /// Where its rays start that meet the model's box, in world units: one for each camera.
    fn eyes(&self, space: &ModelSpace) -> Vec<Eye>;
}

/// What a method may choose by once for all rays of a frame.
#[derive(Clone, Debug, PartialEq)]
pub struct Sight {
    /// Quality of the level of detail: 0 the base mesh, infinite full detail; what it promises: `docs/error-bound.md`.
    pub delta: f64,
    /// A radius that no ray's cone falls below within the model's box, in units of the model.
    pub least_radius: f64,
    /// Where rays start, in units of the model: for what chooses by parts of the model. Of frames after one another, one for each.
    pub eyes: Vec<Eye>,
    /// The frame whose rays are traced, where it is one of several, the first being 0: for what chooses anew for each.
    pub frame: Option<usize>,
}

impl Sight {
    /// What the rays of `source` see of a model at this quality.
    pub fn new(source: &dyn RaySource, space: &ModelSpace, delta: f64) -> Self {
        let eyes = source.eyes(space).into_iter().map(|eye| eye.in_units(space)).collect();
        Self { delta, least_radius: source.least_radius(space) / space.placement.scale, eyes, frame: None }
    }

    /// The same for the rays of one frame of several.
    #[must_use]
    pub fn of_frame(&self, frame: usize) -> Self {
        Self { frame: Some(frame), ..self.clone() }
    }

    /// The same for all frames.
    #[must_use]
    pub fn whole(&self) -> Self {
        Self { frame: None, ..self.clone() }
    }

    /// A radius that no ray's cone falls below within this part of the model, in its units.
    pub fn least_radius_in(&self, lo: [f64; 3], hi: [f64; 3]) -> f64 {
        self.eyes.iter().map(|eye| eye.least_radius(lo, hi)).fold(f64::INFINITY, f64::min)
    }
}

impl RaySource for Camera {
    fn rays(&self) -> u64 {
        u64::from(self.width) * u64::from(self.height)
    }

    /// Tiles of 8 x 8 pixels, row by row from the top left; of several in turn the n-th batches hold the n-th parts of tiles that lie as far apart.
    fn batches(&self) -> usize {
        let [tiles, in_turn] = [tiles(self), self.tiles_in_turn() as usize];
        tiles.div_ceil(in_turn) * in_turn
    }

    fn batch(&self, batch: usize, each: &mut dyn FnMut(u64, &Query)) {
        let (tiles, in_turn) = (tiles(self), self.tiles_in_turn() as usize);
        let columns = self.width.div_ceil(TILE) as usize;
        // Which of the tiles of each part of the picture, and which of its rays.
        let (apart, part) = (tiles.div_ceil(in_turn), (TILE * TILE) as usize / in_turn);
        let (first, rays) = (batch / in_turn, batch % in_turn * part..(batch % in_turn + 1) * part);
        for ray in rays {
            for tile in (first..tiles).step_by(apart) {
                // Of a picture of at most 2^16 columns and rows.
                let x = (tile % columns) as u32 * TILE + ray as u32 % TILE;
                let y = (tile / columns) as u32 * TILE + ray as u32 / TILE;
                if x < self.width && y < self.height {
                    each(u64::from(y) * u64::from(self.width) + u64::from(x), &self.ray(x, y));
                }
            }
        }
    }

    fn least_radius(&self, space: &ModelSpace) -> f64 {
        self.tan_theta * space.distance_to(self.eye.to_array())
    }

    fn eyes(&self, _: &ModelSpace) -> Vec<Eye> {
        vec![Eye::at(self.eye.to_array(), self.tan_theta).looking(self.view_cone())]
    }
}

/// Tiles of a camera's picture.
fn tiles(camera: &Camera) -> usize {
    camera.width.div_ceil(TILE) as usize * camera.height.div_ceil(TILE) as usize
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::Placement;
    use crate::rays::View;

    #[test]
    fn a_camera_gives_each_pixel_once_and_knows_how_near_the_model_is() {
        let space = ModelSpace {
            placement: Placement { offset: [1.0, 0.0, 0.0], scale: 0.5 },
            lo: [-10, -20, -30],
            hi: [10, 20, 30],
            zeros: [0; 2],
        };
        let view = View { eye: Some([1.0, 0.0, 115.0]), target: Some([1.0, 0.0, 0.0]), ..View::default() };
        let camera = Camera::new(&view, &space, 19, 13).unwrap();
        let mut seen = vec![0; 19 * 13];
        for batch in 0..camera.batches() {
            let mut rays = 0;
            camera.batch(batch, &mut |number, query| {
                seen[number as usize] += 1;
                assert_eq!(*query, camera.ray(number as u32 % 19, number as u32 / 19));
                rays += 1;
            });
            assert!((1..=64).contains(&rays));
        }
        assert_eq!((seen, camera.rays()), (vec![1; 19 * 13], 19 * 13));
        let sight = Sight::new(&camera, &space, 2.0);
        assert!((sight.least_radius - camera.tan_theta * 200.0).abs() < 1e-9, "{sight:?}");
        let inside = Camera::new(&View { eye: Some([2.0, 1.0, 3.0]), ..view }, &space, 4, 4).unwrap();
        assert_eq!(Sight::new(&inside, &space, 2.0).least_radius, 0.0);
    }

    #[test]
    fn tiles_in_turn_give_each_pixel_once_and_batches_of_many_tiles() {
        let space = ModelSpace { placement: Placement { offset: [0.0; 3], scale: 1.0 }, lo: [-10; 3], hi: [10; 3], zeros: [0; 2] };
        let view = View { eye: Some([0.0, 0.0, 50.0]), target: Some([0.0; 3]), ..View::default() };
        for [width, height] in [[64, 64], [61, 35], [3, 3]] {
            let plain = Camera::new(&view, &space, width, height).unwrap();
            for tiles in [1, 2, 4, 8, 16, 32, 64] {
                let camera = plain.in_turn(tiles);
                let mut seen = vec![0; (width * height) as usize];
                let mut most = 0;
                for batch in 0..camera.batches() {
                    let mut of_tiles = std::collections::BTreeSet::new();
                    let mut rays = 0;
                    camera.batch(batch, &mut |number, query| {
                        let [x, y] = [number as u32 % width, number as u32 / width];
                        assert_eq!(*query, plain.ray(x, y));
                        seen[number as usize] += 1;
                        of_tiles.insert([x / TILE, y / TILE]);
                        rays += 1;
                    });
                    assert!(rays <= 64 && of_tiles.len() <= tiles as usize);
                    most = most.max(of_tiles.len());
                }
                assert!(seen.iter().all(|&times| times == 1), "{width}x{height}, {tiles} in turn");
                let all = (width.div_ceil(TILE) * height.div_ceil(TILE)) as usize;
                assert_eq!(most, all.div_ceil(all.div_ceil(tiles as usize)), "{all} tiles, {tiles} in turn");
            }
        }
        assert!([1, 4, 64].into_iter().all(crate::rays::may_be_in_turn) && ![0, 3, 128].into_iter().any(crate::rays::may_be_in_turn));
    }

    #[test]
    fn a_camera_sees_nothing_outside_of_its_cone() {
        let space = ModelSpace { placement: Placement { offset: [0.0; 3], scale: 1.0 }, lo: [-10; 3], hi: [10; 3], zeros: [0; 2] };
        let view = View { eye: Some([0.0, 0.0, 50.0]), target: Some([0.0; 3]), ..View::default() };
        for camera in [Camera::new(&view, &space, 31, 9).unwrap(), Camera::new(&view, &space, 9, 31).unwrap()] {
            let cone = camera.view_cone();
            let apex = camera.eye.to_array();
            for pixel in 0..31 * 9 {
                let direction = camera.ray(pixel % camera.width, pixel / camera.width).direction;
                let point = std::array::from_fn(|k| apex[k] + 7.0 * direction[k]);
                assert!(!cone.misses(apex, point, 1e-9));
            }
            // A pixel at a corner lies on its side but for half a pixel.
            let corner = camera.ray(0, 0).direction;
            let along: f64 = (0..3).map(|k| corner[k] * cone.axis[k]).sum();
            assert!((along.powi(-2) - 1.0).sqrt() > 0.85 * cone.tangent);
            assert!(cone.misses(apex, [0.0, 0.0, 60.0], 9.9) && !cone.misses(apex, [0.0, 0.0, 60.0], 10.1));
            assert!(cone.misses(apex, [1000.0, 0.0, 49.0], 10.0));
        }
    }
}
