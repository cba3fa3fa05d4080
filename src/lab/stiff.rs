//! Stiff and extreme models: what the lab's cases shoot at.

use super::model::Model;
use super::shapes::{Base, Place, bipyramid, bumpy, cube, fan, flat, octahedron, sheet, stretched, surface, tetrahedron, together};
use crate::format::{RefitOptions, SceneError};
use crate::mesh::procedural::{self, Options, Scene};
use crate::mesh::{BoundKind, Surface, quantise};
use crate::num::{Random, VertexForm};

/// How large models may be.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Scale {
    /// Built in a second or two: for tests.
    Small,
    /// As the case asks for.
    Full,
}

/// Each of these with vertices of each form.
fn list(models: impl IntoIterator<Item = (String, Surface)>) -> Result<Vec<Model>, SceneError> {
    let both = |(name, surface): (String, Surface)| {
        VertexForm::ALL.map(|form| Model::of_surface(format!("{name}, {} vertices", form.name()), &surface, form))
    };
    models.into_iter().flat_map(both).collect()
}

pub(super) fn needles(_: Scale) -> Result<Vec<Model>, SceneError> {
    let ball = |aspect: f64, levels| {
        (
            format!("aspect {aspect:e}, N = {levels}"),
            surface(levels, &octahedron(), stretched([1.0 / aspect, 1.0, 1.0 / aspect], [0.0; 3], bumpy(0.3, 1))),
        )
    };
    list([ball(1e2, 4), ball(1e4, 3), ball(1e6, 0), ball(1e6, 3)])
}

pub(super) fn slivers(_: Scale) -> Result<Vec<Model>, SceneError> {
    let rim = |count: u32, levels| {
        (format!("{count} slivers, N = {levels}"), surface(levels, &bipyramid(count), stretched([1e-2, 1e-2, 1.0], [0.0; 3], flat)))
    };
    // Flat triangles of height 1e-6 over edges of 2: a box pressed flat along a diagonal.
    let pressed = surface(3, &cube(), |p: Place| {
        let [x, y, z] = p.flat;
        [x, x + 1e-6 * y, z + 1e-6 * p.noise(2)[0]]
    });
    list([rim(100, 1), rim(400, 0), ("pressed cube".to_owned(), pressed)])
}

pub(super) fn zero_area(_: Scale) -> Result<Vec<Model>, SceneError> {
    let (v, t) = octahedron();
    // Two corners in one place: four triangles become segments. All on a line. All corners but one in one place.
    let mut twin = v.clone();
    twin[2] = twin[0];
    let line: Vec<_> = (0..6).map(|k| [f64::from(k) * 0.25, f64::from(k) * 0.5, f64::from(k)]).collect();
    let mut point = vec![[0.5; 3]; 6];
    point[1] = [-1.0, 0.3, 0.2];
    let sink = |levels| surface(levels, &octahedron(), |p| if p.level == 0 { p.flat } else { [0.25, 0.125, 0.5] });
    list([
        ("two corners in one place".to_owned(), surface(3, &(twin, t.clone()), flat)),
        ("on a line".to_owned(), surface(2, &(line, t.clone()), flat)),
        ("to a point".to_owned(), surface(2, &(point, t), flat)),
        ("inserted vertices in one place".to_owned(), sink(3)),
        ("the same, N = 1".to_owned(), sink(1)),
    ])
}

pub(super) fn coincident(_: Scale) -> Result<Vec<Model>, SceneError> {
    let (v, t) = octahedron();
    let twice: Vec<_> = t.iter().chain(&t).copied().collect();
    let both_ways: Vec<_> = t.iter().flat_map(|&[a, b, c]| [[a, b, c], [a, c, b], [b, c, a], [c, b, a]]).collect();
    let apart = together([(octahedron(), 1.0, [0.0; 3]), (octahedron(), 1.0, [0.0; 3])]);
    list([
        ("twice".to_owned(), surface(3, &(v.clone(), twice), bumpy(0.4, 3))),
        ("twice, vertices of their own".to_owned(), surface(3, &apart, stretched([1.0; 3], [0.0; 3], |p| p.flat))),
        ("four times, both ways".to_owned(), surface(2, &(v, both_ways), bumpy(0.4, 4))),
    ])
}

pub(super) fn scales(_: Scale) -> Result<Vec<Model>, SceneError> {
    let part = |size: f64, at: [f64; 3]| (octahedron(), size, at);
    let base = together([
        part(1e6, [0.0; 3]),
        part(1e3, [1.5e6, 1e5, 3e5]),
        part(1.0, [1.2e6, 1.3e6, 0.0]),
        part(1e-3, [0.0, 1.5e6, 1.0]),
        part(1e-6, [-1.4e6; 3]),
    ]);
    let ripple = |p: Place| p.flat.map(|v| v * (1.0 + 0.05 * p.noise(5)[1] / f64::from(1u32 << p.level)));
    list([("five parts, N = 0".to_owned(), surface(0, &base, flat)), ("N = 3".to_owned(), surface(3, &base, ripple))])
}

pub(super) fn scaled(by: f64) -> Result<Vec<Model>, SceneError> {
    list([0, 4].map(|levels| (format!("N = {levels}"), surface(levels, &octahedron(), stretched([by; 3], [0.0; 3], bumpy(0.4, 6))))))
}

pub(super) fn offset(_: Scale) -> Result<Vec<Model>, SceneError> {
    let at =
        |far: f64| (format!("{far:e} away"), surface(4, &octahedron(), stretched([1.0; 3], [far, -far / 3.0, far / 7.0], bumpy(0.4, 7))));
    list([at(1e3), at(1e6), at(1e9)])
}

pub(super) fn spikes(_: Scale) -> Result<Vec<Model>, SceneError> {
    // Edges of the finest level are about 0.1 of a ball of 0.01; one vertex in nine leaves it by a thousand times that.
    let spiky = |levels: u32| {
        let edge = 1.5 / f64::from(1u32 << levels);
        surface(levels, &octahedron(), move |p| {
            let ball = bumpy(0.0, 0)(p);
            let noise = p.noise(8);
            if noise[0] > 0.8 && p.level > 0 { [0, 1, 2].map(|k| ball[k] + 1000.0 * edge * noise[k]) } else { ball }
        })
    };
    let options = Options { levels: Some(4), base: Some(128), ..Options::new(Scene::Spikes) };
    list([
        ("N = 2".to_owned(), spiky(2)),
        ("N = 4".to_owned(), spiky(4)),
        ("needles of the procedural scene".to_owned(), generated(&options)?),
    ])
}

fn generated(options: &Options) -> Result<Surface, SceneError> {
    procedural::generate(options).map_err(|e| SceneError::Build(e.to_string()))
}

/// Five plates, each on top of the other a few steps of the grid apart, plane and bumpy; and two pyramids with an acute rim.
pub(super) fn sheets(_: Scale) -> Result<Vec<Model>, SceneError> {
    let plates = together((0..5).map(|k| (cube(), 1.0, [0.0, 0.0, 2.5 * f64::from(k)])));
    let pressed = |by: f64, noise: f64| {
        let bump = move |p: Place| if p.level == 0 { p.flat } else { [p.flat[0], p.flat[1], p.flat[2] + noise * p.noise(24)[2]] };
        stretched([1.0, 1.0, by], [0.0; 3], bump)
    };
    list([
        ("plates, N = 0".to_owned(), surface(0, &plates, pressed(2f64.powi(-25), 0.0))),
        ("bumpy plates".to_owned(), surface(3, &plates, pressed(2f64.powi(-22), 0.2))),
        ("bumpy plates that nearly touch".to_owned(), surface(3, &plates, pressed(2f64.powi(-18), 0.24))),
        ("acute rim".to_owned(), surface(2, &bipyramid(5), stretched([1.0, 1.0, 1e-7], [0.0; 3], flat))),
        ("acute rim, bumpy".to_owned(), surface(3, &bipyramid(5), stretched([1.0, 1.0, 1e-4], [0.0; 3], bumpy(0.3, 25)))),
    ])
}

pub(super) fn flats(scale: Scale) -> Result<Vec<Model>, SceneError> {
    let mut models = zero_area(scale)?;
    models.extend(flat_parts(scale)?);
    Ok(models)
}

pub(super) fn flat_parts(_: Scale) -> Result<Vec<Model>, SceneError> {
    let half = |p: Place| if p.flat[2] > 0.0 { p.flat.map(|v| v * (1.0 + 0.1 * p.noise(9)[0])) } else { p.flat };
    list([("flat cube".to_owned(), surface(4, &cube(), flat)), ("half flat".to_owned(), surface(4, &cube(), half))])
}

pub(super) fn one_triangle(scale: Scale) -> Result<Vec<Model>, SceneError> {
    let base: Base = (vec![[-1.0, -0.9, 0.1], [1.0, -0.7, -0.2], [0.1, 1.0, 0.3]], vec![[0, 1, 2]]);
    let most = if scale == Scale::Small { 5 } else { 8 };
    let rough = |p: Place| [0, 1, 2].map(|k| p.flat[k] + 0.2 * p.noise(10)[k] / f64::from(1u32 << p.level));
    list([0, 1, 2, most].map(|levels| (format!("N = {levels}"), surface(levels, &base, rough))))
}

pub(super) fn million(scale: Scale) -> Result<Vec<Model>, SceneError> {
    let base = if scale == Scale::Small { 8192 } else { 1_000_000 };
    list([("sphere, N = 1".to_owned(), generated(&Options { levels: Some(1), base: Some(base), ..Options::new(Scene::Sphere) })?)])
}

pub(super) fn levels(scale: Scale, all: std::ops::RangeInclusive<u32>) -> Result<Vec<Model>, SceneError> {
    let enough = |&n: &u32| scale == Scale::Full || n <= 6 || n == 9;
    list(all.filter(enough).map(|levels| (format!("N = {levels}"), round_surface(levels))))
}

fn round_surface(levels: u32) -> Surface {
    surface(levels, &tetrahedron(), bumpy(0.5, 11))
}

/// A bumpy closed model of `levels` splits with exact vertices.
///
/// # Errors
/// Memory cannot be had.
pub fn round_model(levels: u32) -> Result<Model, SceneError> {
    Model::of_surface(format!("N = {levels}"), &round_surface(levels), VertexForm::Exact)
}

pub(super) fn balls(_: Scale) -> Result<Vec<Model>, SceneError> {
    list([
        ("smooth ball".to_owned(), surface(4, &octahedron(), bumpy(0.05, 12))),
        ("rough ball".to_owned(), surface(4, &octahedron(), bumpy(0.8, 13))),
    ])
}

/// Every point on a grid of 64 steps, so that many edges and planes have short exact directions.
fn coarse(levels: u32, base: &Base, seed: u64) -> Surface {
    surface(levels, base, |p| [0, 1, 2].map(|k| ((p.flat[k] + 0.4 * p.noise(seed)[k]) * 32.0).round().clamp(-32.0, 32.0) / 32.0))
}

pub(super) fn edges_exact(_: Scale) -> Result<Vec<Model>, SceneError> {
    list([
        ("cube".to_owned(), surface(3, &cube(), flat)),
        ("flat octahedron".to_owned(), surface(3, &octahedron(), flat)),
        ("coarse cube, N = 0".to_owned(), coarse(0, &cube(), 14)),
        ("coarse octahedron, N = 2".to_owned(), coarse(2, &octahedron(), 15)),
        ("coarse cube, N = 3".to_owned(), coarse(3, &cube(), 16)),
    ])
}

pub(super) fn both(scale: Scale) -> Result<Vec<Model>, SceneError> {
    let mut models = edges_exact(scale)?;
    models.extend(balls(scale)?);
    Ok(models)
}

pub(super) fn turned(_: Scale) -> Result<Vec<Model>, SceneError> {
    let (v, mut t) = octahedron();
    t.iter_mut().step_by(3).for_each(|t| t.swap(1, 2));
    list([("N = 0".to_owned(), coarse(0, &(v.clone(), t.clone()), 17)), ("N = 4".to_owned(), surface(4, &(v, t), bumpy(0.4, 18)))])
}

pub(super) fn open(_: Scale) -> Result<Vec<Model>, SceneError> {
    let folded = |p: Place| [0, 1, 2].map(|k| p.flat[k] + 0.7 * p.noise(19)[k] / f64::from(1u32 << p.level));
    list([
        ("flat sheet".to_owned(), surface(3, &sheet(4), flat)),
        ("coarse sheet".to_owned(), coarse(2, &sheet(3), 20)),
        ("folded sheet".to_owned(), surface(3, &sheet(2), folded)),
    ])
}

pub(super) fn non_manifold(_: Scale) -> Result<Vec<Model>, SceneError> {
    let rough = |p: Place| [0, 1, 2].map(|k| p.flat[k] + 0.2 * p.noise(21)[k] / f64::from(1u32 << p.level));
    list([
        ("fan, N = 0".to_owned(), coarse(0, &fan(), 22)),
        ("fan, N = 3".to_owned(), surface(3, &fan(), rough)),
        ("coarse fan".to_owned(), coarse(2, &fan(), 23)),
    ])
}

pub(super) fn rebuilds(scale: Scale) -> Result<Vec<Model>, SceneError> {
    let count = if scale == Scale::Small { 6 } else { 48 };
    let jump = |n: u64| {
        surface(1 + n as u32 % 4, &octahedron(), move |p| {
            // To a corner of the box, or anywhere in it.
            let noise = p.noise(100 + n);
            if n.is_multiple_of(2) { noise.map(f64::signum) } else { noise }
        })
    };
    list((0..count).map(|n| (format!("rebuild {n}"), now_and_then_flat(n, jump(n)))))
}

/// Models whose vertices jump, each from where the one before left them.
pub(super) fn refits(scale: Scale) -> Result<Vec<Model>, SceneError> {
    let count = if scale == Scale::Small { 6 } else { 18 };
    let mut all = Vec::new();
    for form in VertexForm::ALL {
        let rest = Model::of_surface("at rest", &surface(3, &octahedron(), bumpy(0.3, 1)), form)?;
        let mut refit = rest.scene.refitting().map_err(|error| SceneError::Build(error.to_string()))?;
        let (first, mut random) = (refit.positions(), Random::of(77, form as u64));
        for n in 0..count {
            let mut move_to = |p: &[f64; 3]| {
                let noise: [f64; 3] = std::array::from_fn(|_| random.signed());
                match n % 6 {
                    0 => [p[0], p[1], 0.25],
                    1 => noise.map(f64::signum),
                    2 => [1e6 * p[0], p[1] + 1e-3 * noise[1], p[2]],
                    3 => [p[0], 0.5 * p[0], 2.0 * p[0]],
                    4 => [0, 1, 2].map(|k| p[k] + 0.02 * noise[k]),
                    _ => [0.5, 0.25, p[2].signum()],
                }
            };
            let positions: Vec<_> = first.iter().map(&mut move_to).collect();
            let moved = refit.move_to(&positions, RefitOptions::default()).map_err(|error| SceneError::Build(error.to_string()))?;
            all.push(Model::of_scene(format!("refit {n}, {} vertices", form.name()), moved.clone()));
        }
    }
    Ok(all)
}

/// A rebuild in ten leaves all points where they are: the next one jumps from there.
fn now_and_then_flat(n: u64, jumped: Surface) -> Surface {
    if n % 10 == 9 { surface(jumped.levels, &octahedron(), flat) } else { jumped }
}

/// A small model for the hunt: on a coarse grid, so that ties are near, or bumpy; closed, or a fan; of either form.
pub(super) fn adversary(random: &mut Random) -> Result<Model, SceneError> {
    let levels = random.below(3) as u32;
    let base = [octahedron, tetrahedron, cube, fan][random.below(4) as usize]();
    let seed = random.next();
    let surface = match random.below(3) {
        0 => coarse(levels, &base, seed),
        1 => surface(levels, &base, |p| [0, 1, 2].map(|k| p.flat[k] + 0.3 * p.noise(seed)[k] / f64::from(1u32 << p.level))),
        // Nearly flat, with displacement of a few steps of the grid.
        _ => surface(levels, &base, |p| [0, 1, 2].map(|k| p.flat[k] + (3.0 * p.noise(seed)[k]).round() * 2f64.powi(-26))),
    };
    let form = VertexForm::ALL[random.below(3) as usize];
    // By way of its integers, as a kept ray's model is made again.
    Model::of_hierarchy("hunted", quantise(&surface, BoundKind::Largest, form, 0)?)
}
