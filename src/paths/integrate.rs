//! Paths: what light comes back along a camera's ray.
//!
//! At every hit each light is asked for light, and a shadow ray says whether it comes; then the material scatters the path on. Light that a scattered ray runs into counts
//! by how likely the other way would have found it (Veach and Guibas 1995, the balance heuristic), so that each is counted once.

use super::cone::Cones;
use super::light::{Environment, Light, Sent};
use super::random::share;
use super::world::{Listener, Met, Surface, World, WorldRay};
use crate::method::{Departure, Tracer};
use crate::num::Random;
use crate::rays::Camera;
use glam::DVec3;
use serde::Serialize;
use std::ops::AddAssign;

/// Shadow rays end this much before their light, of the way there, so that what lies in an area light's plane does not hide it.
const SHORT: f64 = 1e-6;

/// What is traced.
pub struct Paths<'a> {
    /// The models.
    pub world: &'a World<'a>,
    /// Rays begin here; one sample a pixel.
    pub camera: Camera,
    /// Lights.
    pub lights: &'a [Light],
    /// What shines where nothing is.
    pub environment: Option<Environment>,
    /// How cones spread.
    pub cones: Cones,
    /// Bounces: 0 is what the camera sees, with its shadows; where lights are asked, a mirror or glass at the last hit sends one more ray, which only looks for light.
    pub depth: u32,
    /// Lights are asked for light, by shadow rays; if not, scattered rays must run into it.
    pub shadow_rays: bool,
    /// Paths of a pixel.
    pub samples: u32,
    /// Another seed, other paths.
    pub seed: u64,
}

/// Rays by what they are.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize)]
pub struct PathCounts {
    /// Rays of each bounce; of the camera first.
    pub rays: Vec<u64>,
    /// Those that met something.
    pub hits: Vec<u64>,
    /// Rays of each bounce's hits that only ask for light.
    pub shadow_rays: Vec<u64>,
    /// Those that something stopped.
    pub shadowed: Vec<u64>,
    /// Departures whose level of detail a third ray had decided too, and lost.
    pub crowded: u64,
}

impl PathCounts {
    fn of_depth(depth: u32) -> Self {
        let none = || vec![0; depth as usize + 1];
        Self { rays: none(), hits: none(), shadow_rays: none(), shadowed: none(), crowded: 0 }
    }

    /// Rays of all kinds.
    pub fn all(&self) -> u64 {
        self.rays.iter().chain(&self.shadow_rays).sum()
    }
}

impl AddAssign<&Self> for PathCounts {
    fn add_assign(&mut self, other: &Self) {
        for (own, other) in [
            (&mut self.rays, &other.rays),
            (&mut self.hits, &other.hits),
            (&mut self.shadow_rays, &other.shadow_rays),
            (&mut self.shadowed, &other.shadowed),
        ] {
            own.iter_mut().zip(other).for_each(|(own, other)| *own += other);
        }
        self.crowded += other.crowded;
    }
}

/// A path under way.
pub(super) struct Path {
    random: Random,
    ray: WorldRay,
    from: Option<(usize, Departure)>,
    bounce: u32,
    weight: DVec3,
    /// Likelihood of its direction, and the normal where it started; none from a camera or a mirror.
    likely: Option<(f64, DVec3)>,
    pub light: DVec3,
    /// Of the first hit's shadow rays, those that reached their light, and all.
    pub lit: [u32; 2],
    /// Number of its last ray, if rays are listened to.
    last: Option<u64>,
    pub is_over: bool,
}

/// Traces paths; for one thread.
pub struct PathTracer<'a> {
    paths: &'a Paths<'a>,
    tracers: Vec<Box<dyn Tracer + 'a>>,
    /// What was traced.
    pub counts: PathCounts,
}

impl<'a> Paths<'a> {
    /// A tracer.
    pub fn tracer(&'a self) -> PathTracer<'a> {
        PathTracer { paths: self, tracers: self.world.tracers(), counts: PathCounts::of_depth(self.depth) }
    }

    /// Nothing traced.
    pub fn no_counts(&self) -> PathCounts {
        PathCounts::of_depth(self.depth)
    }

    /// The path of a sample of a pixel: its random numbers are its own.
    pub(super) fn start(&self, x: u32, y: u32, sample: u32) -> Path {
        let pixel = u64::from(y) * u64::from(self.camera.width) + u64::from(x);
        let mut random = Random::of(self.seed, pixel * u64::from(self.samples) + u64::from(sample) + 1);
        // One path goes through the pixel's centre: pictures of one sample are those of other commands.
        let place = |at: u32, random: &mut Random| f64::from(at) + if self.samples > 1 { share(random) } else { 0.5 };
        let query = self.camera.ray_at(place(x, &mut random), place(y, &mut random));
        Path {
            random,
            ray: WorldRay::of(&query),
            from: None,
            bounce: 0,
            weight: DVec3::ONE,
            likely: None,
            light: DVec3::ZERO,
            lit: [0; 2],
            last: None,
            is_over: false,
        }
    }
}

impl PathTracer<'_> {
    /// Light of a sample of a pixel; and how many of its first hit's shadow rays reached their light, of how many.
    pub fn sample(&mut self, x: u32, y: u32, sample: u32) -> (DVec3, [u32; 2]) {
        let mut path = self.paths.start(x, y, sample);
        while !path.is_over {
            self.advance(&mut path, None);
        }
        (path.light, path.lit)
    }

    /// Traces a path's next ray and what its hit asks for.
    pub(super) fn advance(&mut self, path: &mut Path, mut listener: Option<&mut Listener<'_>>) {
        let paths = self.paths;
        let bounce = path.bounce as usize;
        let number = listener.as_ref().map(|listener| listener.number);
        let heard = listener.as_mut().map(|listener| listener.ray(path.last));
        let from = path.from.as_ref().map(|(of, from)| (*of, from));
        let met = paths.world.trace(&mut self.tracers, &path.ray, from, heard);
        self.run_into(path, met.as_ref());
        if path.bounce > paths.depth {
            // The ray behind the last hit asks for light alone, as a shadow ray does.
            self.counts.shadow_rays[paths.depth as usize] += 1;
            self.counts.shadowed[paths.depth as usize] += u64::from(met.is_some());
            path.is_over = true;
            return;
        }
        self.counts.rays[bounce] += 1;
        let Some(met) = met else {
            path.is_over = true;
            return;
        };
        self.counts.hits[bounce] += 1;
        self.counts.crowded += u64::from(met.landing.departure.crowded);
        let surface = paths.world.surface(&met, path.ray.direction);
        let position = path.ray.origin + path.ray.direction * met.distance;
        if paths.shadow_rays {
            self.ask_lights(path, &met, &surface, position, listener, number);
        }
        // Of a mirror or glass lights cannot be asked at the last hit: one more ray looks for them.
        let goes_on = path.bounce < paths.depth || (paths.shadow_rays && surface.bsdf.must_be_followed());
        path.is_over = !goes_on || !self.scatter(path, &met, &surface, position);
        path.last = number;
        path.bounce += 1;
    }

    /// Light that the path's ray runs into before it meets anything.
    fn run_into(&self, path: &mut Path, met: Option<&Met>) {
        let paths = self.paths;
        let share = |other: f64| match path.likely {
            Some((own, _)) if paths.shadow_rays => own / (own + other),
            _ => 1.0,
        };
        let farthest = met.map_or(f64::INFINITY, |met| met.distance);
        let mut light = DVec3::ZERO;
        for seen in paths.lights.iter().filter_map(|light| light.seen(path.ray.origin, path.ray.direction)) {
            // From infinitely far away it comes if nothing is met.
            if seen.distance < farthest || met.is_none() {
                light += seen.radiance * share(seen.pdf);
            }
        }
        if let (None, Some(environment)) = (met, &paths.environment) {
            let other = path.likely.map_or(0.0, |(_, normal)| Environment::pdf(normal, path.ray.direction));
            light += environment.radiance(path.ray.direction) * share(other);
        }
        path.light += path.weight * light;
    }

    /// Light that lights send to a hit.
    fn ask_lights(
        &mut self,
        path: &mut Path,
        met: &Met,
        surface: &Surface<'_>,
        position: DVec3,
        mut listener: Option<&mut Listener<'_>>,
        number: Option<u64>,
    ) {
        let paths = self.paths;
        let view = -path.ray.direction;
        for k in 0..=paths.lights.len() {
            let sent: Option<Sent> = match paths.lights.get(k) {
                Some(light) => light.send(position, &mut path.random),
                None => paths.environment.as_ref().map(|environment| environment.send(surface.place.normal, &mut path.random)),
            };
            let Some(sent) = sent else { continue };
            let (value, own) = surface.bsdf.eval(&surface.place, view, sent.direction);
            if value.max_element() <= 0.0 {
                continue;
            }
            // At the last hit no scattered ray could have found it, where none is followed.
            let share = match sent.pdf {
                Some(pdf) if path.bounce < paths.depth || surface.bsdf.must_be_followed() => pdf / (pdf + own),
                _ => 1.0,
            };
            let reaches = paths.world.leaves(met, sent.direction, surface.goes_through(sent.direction)) && {
                let ray = WorldRay {
                    origin: position,
                    direction: sent.direction,
                    cone: path.ray.cone.lit(met.distance, sent.spread, &paths.cones),
                    t_min: 0.0,
                    t_max: sent.distance * (1.0 - SHORT),
                    any: true,
                };
                let heard = listener.as_mut().map(|listener| listener.ray(number));
                let shadowed = paths.world.trace(&mut self.tracers, &ray, Some((met.instance, &met.landing.departure)), heard).is_some();
                self.counts.shadow_rays[path.bounce as usize] += 1;
                self.counts.shadowed[path.bounce as usize] += u64::from(shadowed);
                !shadowed
            };
            if path.bounce == 0 {
                path.lit[0] += u32::from(reaches);
                path.lit[1] += 1;
            }
            if reaches {
                path.light += path.weight * value * sent.light * share;
            }
        }
    }

    /// Sends the path on; false if it is swallowed.
    fn scatter(&self, path: &mut Path, met: &Met, surface: &Surface<'_>, position: DVec3) -> bool {
        let paths = self.paths;
        let Some(scatter) = surface.bsdf.sample(&surface.place, -path.ray.direction, &mut path.random) else { return false };
        let through = surface.goes_through(scatter.direction);
        if scatter.weight.max_element() <= 0.0 || !paths.world.leaves(met, scatter.direction, through) {
            return false;
        }
        path.weight *= scatter.weight;
        let cone = path.ray.cone.scattered(met.distance, scatter.lobe, surface.curvature, surface.alpha, &paths.cones);
        path.ray = WorldRay { origin: position, direction: scatter.direction.normalize(), cone, ..path.ray };
        path.from = Some((met.instance, met.landing.departure));
        path.likely = scatter.pdf.map(|pdf| (pdf, surface.place.normal));
        true
    }
}
