//! Time on the host: a sample of a view's rays, one thread, settings in turns so that what else runs on the machine meets all of them.

use super::row::HostTime;
use crate::method::{Method, trace_together};
use crate::rays::{Camera, ModelSpace, Query, Sight, TILE};
use crate::step::NoSteps;
use std::time::Instant;

/// How often each setting has its turn.
const TURNS: usize = 7;

/// A setting to be timed.
pub struct Timed<'a> {
    pub name: &'static str,
    pub words: &'a str,
    pub method: &'a dyn Method,
    pub delta: f64,
}

/// Times about `most` rays, evenly spread over the picture in tiles of 8 x 8, of each setting.
pub fn host_times(settings: &[Timed<'_>], camera: &Camera, space: &ModelSpace, most: u32) -> Vec<HostTime> {
    let tiles = u64::from(camera.width.div_ceil(TILE)) * u64::from(camera.height.div_ceil(TILE));
    let columns = u64::from(camera.width.div_ceil(TILE));
    let step = (tiles * u64::from(TILE * TILE)).div_ceil(u64::from(most)).max(1);
    let mut queries: Vec<Query> = Vec::new();
    for tile in (0..tiles).step_by(step as usize) {
        // Columns and rows are below 2^16.
        let [left, top] = [tile % columns, tile / columns].map(|at| at as u32 * TILE);
        for y in top..camera.height.min(top + TILE) {
            queries.extend((left..camera.width.min(left + TILE)).map(|x| camera.ray(x, y)));
        }
    }
    let sights: Vec<Sight> = settings.iter().map(|setting| Sight::new(camera, space, setting.delta)).collect();
    let mut tracers: Vec<_> = settings.iter().zip(&sights).map(|(setting, sight)| setting.method.tracer(sight)).collect();
    let mut times = vec![Vec::with_capacity(TURNS); settings.len()];
    for _ in 0..TURNS {
        for (tracer, times) in tracers.iter_mut().zip(&mut times) {
            let begun = Instant::now();
            let hits = match tracer.lanes() {
                1 => queries.iter().filter(|query| tracer.hit(query).is_some()).count(),
                _ => trace_together(&mut **tracer, &queries, &mut NoSteps).iter().flatten().count(),
            };
            std::hint::black_box(hits);
            times.push(begun.elapsed().as_secs_f64() * 1e9 / queries.len() as f64);
        }
    }
    let of = |(setting, nanoseconds): (&Timed<'_>, Vec<f64>)| {
        let mut sorted = nanoseconds.clone();
        sorted.sort_unstable_by(f64::total_cmp);
        HostTime {
            method: setting.name.to_owned(),
            setting: setting.words.to_owned(),
            rays: queries.len() as u64,
            median: sorted[TURNS / 2],
            spread: 0.5 * (sorted[TURNS - 1 - TURNS / 4] - sorted[TURNS / 4]),
            nanoseconds,
        }
    };
    settings.iter().zip(times).map(of).collect()
}
