//! The named cases: stiff models, stiff rays, stiff cones.

use super::model::Model;
use super::rays::{Aim, BOUNCES, Bounce, Cones, PIXEL, Views};
use super::shapes::{Base, Place, bipyramid, bumpy, cube, fan, flat, octahedron, sheet, stretched, surface, tetrahedron, together};
use crate::format::SceneError;
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

/// A named case.
#[derive(Clone, Copy, Debug)]
pub struct Case {
    /// Name on the command line and in tables.
    pub name: &'static str,
    /// What is hard about it.
    pub about: &'static str,
    /// Makes its models.
    pub models: fn(Scale) -> Result<Vec<Model>, SceneError>,
    /// Families of rays, one after the other.
    pub aims: &'static [Aim],
    /// Cones of the rays that no camera makes.
    pub cones: Cones,
    /// Cameras.
    pub views: Views,
    /// Every how many rays the golden traverser is asked; 1 where nothing else can judge.
    pub every: u64,
    /// Its part of all rays: 32, or less where a ray takes long.
    pub share: u64,
}

/// Every how many rays of a closed model the golden traverser is asked.
pub const SAMPLE: u64 = 256;

const ALL: &[Aim] =
    &[Aim::Edges, Aim::View, Aim::Edges, Aim::Grazing, Aim::Inside, Aim::AlongEdge, Aim::Edges, Aim::AxisParallel, Aim::BoxFace];
const LENS: &[f64] = &[PIXEL];
const USUAL: Views = Views { distances: &[1.2, 2.5, 20.0], deltas: &[0.25, 1.0, 8.0], tangents: LENS };
/// Close enough to see single units.
const CLOSE: Views = Views { distances: &[1e-5, 1e-3, 1e-1, 2.5], ..USUAL };
const CLOSED: Case =
    Case { name: "", about: "", models: edges_exact, aims: ALL, cones: Cones::Mixed, views: USUAL, every: SAMPLE, share: 32 };
const OPEN: Case = Case { every: 1, share: 1, aims: OPEN_AIMS, ..CLOSED };
const OPEN_AIMS: &[Aim] =
    &[Aim::Edges, Aim::View, Aim::Grazing, Aim::Inside, Aim::AlongEdge, Aim::AxisParallel, Aim::BoxFace, Aim::OnSurface];

/// All cases, in the order of tables.
pub const CASES: &[Case] = &[
    Case { name: "needles", about: "balls stretched 1e2, 1e4 and 1e6 times along one axis", models: needles, ..CLOSED },
    Case { name: "slivers", about: "triangles up to 1e6 times longer than high", models: slivers, share: 8, ..CLOSED },
    Case { name: "zero-area", about: "base and inner triangles shrunk to segments and points", models: zero_area, ..CLOSED },
    Case { name: "coincident", about: "every triangle two and four times in one place", models: coincident, ..CLOSED },
    Case { name: "scales", about: "parts of 1e-6, 1e-3, 1, 1e3 and 1e6 in one model", models: scales, views: CLOSE, ..CLOSED },
    Case { name: "huge", about: "a model of 1e30 units", models: |_| scaled(1e30), ..CLOSED },
    Case { name: "tiny", about: "a model of 1e-30 units", models: |_| scaled(1e-30), ..CLOSED },
    Case { name: "offset", about: "models 1e3, 1e6 and 1e9 of their sizes from the origin", models: offset, ..CLOSED },
    Case { name: "spikes", about: "displacement 1000 times the edge", models: spikes, share: 8, ..CLOSED },
    Case { name: "flat", about: "perfectly flat parts, and all flat", models: flat_parts, ..CLOSED },
    Case { name: "one-triangle", about: "L0 of one triangle, N = 0 to 8", models: one_triangle, ..OPEN },
    Case { name: "million", about: "L0 of a million triangles", models: million, ..CLOSED },
    Case { name: "levels-0-8", about: "N = 0 to 8", models: |s| levels(s, 0..=8), views: CLOSE, ..CLOSED },
    Case {
        name: "levels-9-10",
        about: "N = 9 and 10, beyond 8: base vertices lose bits",
        models: |s| levels(s, 9..=10),
        views: CLOSE,
        ..CLOSED
    },
    Case { name: "inside", about: "origins inside the model", models: balls, aims: &[Aim::Inside], ..CLOSED },
    Case {
        name: "on-surface",
        about: "origins at vertices, on edges and on triangles",
        models: both,
        aims: &[Aim::OnSurface],
        every: 1,
        share: 1,
        ..CLOSED
    },
    Case {
        name: "near-and-far",
        about: "cameras 1e-4 to 1e6 radii from what they see",
        models: balls,
        aims: &[Aim::View],
        views: Views { distances: &[1e-4, 1e-3, 1e-2, 1e-1, 1.0, 2.5, 1e1, 1e2, 1e3, 1e4, 1e5, 1e6], ..USUAL },
        ..CLOSED
    },
    Case {
        name: "cone-angles",
        about: "cone half angles 0, 1e-9, a pixel, 45 degrees, and 90 less 1e-6 and 1e-12",
        models: balls,
        views: Views { tangents: &[0.0, 1.7e-11, PIXEL, 1.0, 5.7e7, 5.7e13], ..USUAL },
        cones: Cones::Listed(&[
            (1.0, 0.0, 0.0),
            (1.0, 1e3, 1.7e-11),
            (1.0, 0.0, PIXEL),
            (1.0, 5e6, 1.0),
            (1.0, 0.0, 5.7e7),
            (1.0, 0.0, 5.7e13),
        ]),
        ..CLOSED
    },
    Case {
        name: "deltas",
        about: "delta 0, 1e-300, 1e-6, 1e-2, 1, 1e2, 1e6, 1e300 and infinite",
        models: balls,
        views: Views { deltas: &[0.0, 1e-300, 1e-6, 1e-2, 1.0, 1e2, 1e6, 1e300, f64::INFINITY], ..USUAL },
        cones: Cones::Listed(&[
            (0.0, 1e6, PIXEL),
            (1e-300, 1e6, PIXEL),
            (1e-6, 1e6, PIXEL),
            (1e-2, 1e5, PIXEL),
            (1.0, 1e6, PIXEL),
            (1e2, 1e6, PIXEL),
            (1e6, 1e6, PIXEL),
            (1e300, 1e6, PIXEL),
            (f64::INFINITY, 1e6, PIXEL),
        ]),
        ..CLOSED
    },
    Case { name: "axis-parallel", about: "rays along axes through vertices", models: both, aims: &[Aim::AxisParallel], ..CLOSED },
    Case { name: "grazing", about: "rays in the planes of triangles and a unit off", models: both, aims: &[Aim::Grazing], ..CLOSED },
    Case {
        name: "edges",
        about: "rays along edges, through points of edges and vertices",
        models: both,
        aims: &[Aim::AlongEdge, Aim::Edges],
        ..CLOSED
    },
    Case { name: "box-faces", about: "rays in planes of box codes and hits on them", models: both, aims: &[Aim::BoxFace], ..CLOSED },
    Case { name: "turned", about: "closed, but some triangles turned: parity only", models: turned, ..CLOSED },
    Case { name: "open", about: "open sheets, also folded ones", models: open, ..OPEN },
    Case { name: "non-manifold", about: "five triangles on an edge, loose and turned ones", models: non_manifold, ..OPEN },
    Case { name: "rebuilds", about: "rebuilt again and again, points jump by the whole box", models: rebuilds, share: 8, ..CLOSED },
    Case { name: "leave", about: "paths of up to 8 rays from hits anywhere", models: both, aims: ALL_PATHS, ..PATHS },
    Case {
        name: "leave-edges",
        about: "paths from edges, vertices and borders of trees, to vertices",
        models: both,
        aims: &[Aim::Leaving(&[Aim::Edges, Aim::AlongEdge], &[Bounce::Vertex, Bounce::Diffuse])],
        ..PATHS
    },
    Case {
        name: "leave-grazing",
        about: "paths along the planes of what they leave",
        models: both,
        aims: &[Aim::Leaving(STARTS, &[Bounce::Grazing])],
        ..PATHS
    },
    Case { name: "mirrors", about: "chains of mirrors", models: both, aims: &[Aim::Leaving(STARTS, &[Bounce::Mirror])], ..PATHS },
    Case { name: "sheets", about: "paths between sheets a few steps of the grid apart, and in acute corners", models: sheets, ..PATHS },
    Case { name: "leave-needles", about: "paths on stretched balls", models: needles, ..PATHS },
    Case { name: "leave-slivers", about: "paths on triangles up to 1e6 times longer than high", models: slivers, share: 4, ..PATHS },
    Case { name: "leave-flat", about: "paths on zero area and in one plane", models: flats, ..PATHS },
    Case { name: "leave-coincident", about: "paths on triangles two and four times in one place", models: coincident, ..PATHS },
    Case { name: "leave-scales", about: "paths between parts of 1e-6 to 1e6", models: scales, views: CLOSE, ..PATHS },
    Case { name: "leave-spikes", about: "paths where displacement is 1000 times the edge", models: spikes, share: 4, ..PATHS },
    Case { name: "leave-levels", about: "paths at N = 0 to 8", models: |s| levels(s, 0..=8), views: CLOSE, ..PATHS },
    Case { name: "leave-deep", about: "paths at N = 9 and 10", models: |s| levels(s, 9..=10), views: CLOSE, ..PATHS },
    Case {
        name: "leave-deltas",
        about: "paths at delta 0 to infinite, each ray another",
        models: balls,
        cones: Cones::Listed(&[
            (0.0, 1e6, PIXEL),
            (1e-2, 1e5, PIXEL),
            (1.0, 1e6, PIXEL),
            (1.0, 0.0, 1.0),
            (1e2, 1e6, PIXEL),
            (f64::INFINITY, 1e6, PIXEL),
        ]),
        ..PATHS
    },
    Case { name: "leave-turned", about: "paths where some triangles are turned: parity only", models: turned, ..PATHS },
    Case { name: "leave-open", about: "paths on open sheets", models: open, every: 1, share: 1, ..PATHS },
    Case { name: "leave-non-manifold", about: "paths on edges of five triangles", models: non_manifold, every: 1, share: 1, ..PATHS },
];

const ALL_PATHS: &[Aim] = &[Aim::Leaving(STARTS, &BOUNCES)];
/// A path is up to eight rays, and each is traced three times.
const PATHS: Case = Case { aims: ALL_PATHS, every: 64, share: 8, ..CLOSED };

/// Where the paths of the lab begin: on edges and vertices, and anywhere.
const STARTS: &[Aim] = &[Aim::Edges, Aim::View, Aim::Grazing, Aim::Edges, Aim::AxisParallel];

/// A ray family of real scenes.
const FILE: Case = Case { name: "", about: "", ..CLOSED };

/// The families that run on a scene of one's own; the models are given, not made.
pub const FILE_CASES: &[Case] = &[
    Case {
        name: "edges",
        about: "edges and vertices, within one unit of them, and along them",
        aims: &[Aim::Edges, Aim::AlongEdge],
        ..FILE
    },
    Case {
        name: "grazing",
        about: "in the planes of triangles, along axes, in planes of box codes",
        aims: &[Aim::Grazing, Aim::AxisParallel, Aim::BoxFace],
        ..FILE
    },
    Case { name: "inside", about: "origins inside the model's box", aims: &[Aim::Inside], ..FILE },
    Case { name: "on-surface", about: "origins on the surface", aims: &[Aim::OnSurface], every: 1, share: 1, ..FILE },
    Case {
        name: "cameras",
        aims: &[Aim::View],
        about: "cameras 1e-3 to 1e6 radii from what they see",
        views: Views { distances: &[1e-3, 1e-1, 1.0, 2.5, 1e1, 1e3, 1e6], ..USUAL },
        ..FILE
    },
    Case {
        name: "cone-angles",
        about: "cone half angles 0 to nearly 90 degrees",
        aims: &[Aim::View, Aim::Edges],
        views: Views { tangents: &[0.0, 1.7e-11, PIXEL, 1.0, 5.7e13], ..USUAL },
        cones: Cones::Listed(&[(1.0, 0.0, 0.0), (1.0, 1e3, 1.7e-11), (1.0, 0.0, PIXEL), (1.0, 5e6, 1.0), (1.0, 0.0, 5.7e13)]),
        ..FILE
    },
    Case {
        name: "deltas",
        about: "delta 0 to infinite",
        aims: &[Aim::View],
        views: Views { deltas: &[0.0, 1e-300, 1e-2, 1.0, 1e2, 1e300, f64::INFINITY], ..USUAL },
        ..FILE
    },
];

/// Each of these with exact and with compact vertices.
fn list(models: impl IntoIterator<Item = (String, Surface)>) -> Result<Vec<Model>, SceneError> {
    let both = |(name, surface): (String, Surface)| {
        VertexForm::ALL.map(|form| Model::of_surface(format!("{name}, {} vertices", form.name()), &surface, form))
    };
    models.into_iter().flat_map(both).collect()
}

fn needles(_: Scale) -> Result<Vec<Model>, SceneError> {
    let ball = |aspect: f64, levels| {
        (
            format!("aspect {aspect:e}, N = {levels}"),
            surface(levels, &octahedron(), stretched([1.0 / aspect, 1.0, 1.0 / aspect], [0.0; 3], bumpy(0.3, 1))),
        )
    };
    list([ball(1e2, 4), ball(1e4, 3), ball(1e6, 0), ball(1e6, 3)])
}

fn slivers(_: Scale) -> Result<Vec<Model>, SceneError> {
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

fn zero_area(_: Scale) -> Result<Vec<Model>, SceneError> {
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

fn coincident(_: Scale) -> Result<Vec<Model>, SceneError> {
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

fn scales(_: Scale) -> Result<Vec<Model>, SceneError> {
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

fn scaled(by: f64) -> Result<Vec<Model>, SceneError> {
    list([0, 4].map(|levels| (format!("N = {levels}"), surface(levels, &octahedron(), stretched([by; 3], [0.0; 3], bumpy(0.4, 6))))))
}

fn offset(_: Scale) -> Result<Vec<Model>, SceneError> {
    let at =
        |far: f64| (format!("{far:e} away"), surface(4, &octahedron(), stretched([1.0; 3], [far, -far / 3.0, far / 7.0], bumpy(0.4, 7))));
    list([at(1e3), at(1e6), at(1e9)])
}

fn spikes(_: Scale) -> Result<Vec<Model>, SceneError> {
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
fn sheets(_: Scale) -> Result<Vec<Model>, SceneError> {
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

fn flats(scale: Scale) -> Result<Vec<Model>, SceneError> {
    let mut models = zero_area(scale)?;
    models.extend(flat_parts(scale)?);
    Ok(models)
}

fn flat_parts(_: Scale) -> Result<Vec<Model>, SceneError> {
    let half = |p: Place| if p.flat[2] > 0.0 { p.flat.map(|v| v * (1.0 + 0.1 * p.noise(9)[0])) } else { p.flat };
    list([("flat cube".to_owned(), surface(4, &cube(), flat)), ("half flat".to_owned(), surface(4, &cube(), half))])
}

fn one_triangle(scale: Scale) -> Result<Vec<Model>, SceneError> {
    let base: Base = (vec![[-1.0, -0.9, 0.1], [1.0, -0.7, -0.2], [0.1, 1.0, 0.3]], vec![[0, 1, 2]]);
    let most = if scale == Scale::Small { 5 } else { 8 };
    let rough = |p: Place| [0, 1, 2].map(|k| p.flat[k] + 0.2 * p.noise(10)[k] / f64::from(1u32 << p.level));
    list([0, 1, 2, most].map(|levels| (format!("N = {levels}"), surface(levels, &base, rough))))
}

fn million(scale: Scale) -> Result<Vec<Model>, SceneError> {
    let base = if scale == Scale::Small { 8192 } else { 1_000_000 };
    list([("sphere, N = 1".to_owned(), generated(&Options { levels: Some(1), base: Some(base), ..Options::new(Scene::Sphere) })?)])
}

fn levels(scale: Scale, all: std::ops::RangeInclusive<u32>) -> Result<Vec<Model>, SceneError> {
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

fn balls(_: Scale) -> Result<Vec<Model>, SceneError> {
    list([
        ("smooth ball".to_owned(), surface(4, &octahedron(), bumpy(0.05, 12))),
        ("rough ball".to_owned(), surface(4, &octahedron(), bumpy(0.8, 13))),
    ])
}

/// Every point on a grid of 64 steps, so that many edges and planes have short exact directions.
fn coarse(levels: u32, base: &Base, seed: u64) -> Surface {
    surface(levels, base, |p| [0, 1, 2].map(|k| ((p.flat[k] + 0.4 * p.noise(seed)[k]) * 32.0).round().clamp(-32.0, 32.0) / 32.0))
}

fn edges_exact(_: Scale) -> Result<Vec<Model>, SceneError> {
    list([
        ("cube".to_owned(), surface(3, &cube(), flat)),
        ("flat octahedron".to_owned(), surface(3, &octahedron(), flat)),
        ("coarse cube, N = 0".to_owned(), coarse(0, &cube(), 14)),
        ("coarse octahedron, N = 2".to_owned(), coarse(2, &octahedron(), 15)),
        ("coarse cube, N = 3".to_owned(), coarse(3, &cube(), 16)),
    ])
}

fn both(scale: Scale) -> Result<Vec<Model>, SceneError> {
    let mut models = edges_exact(scale)?;
    models.extend(balls(scale)?);
    Ok(models)
}

fn turned(_: Scale) -> Result<Vec<Model>, SceneError> {
    let (v, mut t) = octahedron();
    t.iter_mut().step_by(3).for_each(|t| t.swap(1, 2));
    list([("N = 0".to_owned(), coarse(0, &(v.clone(), t.clone()), 17)), ("N = 4".to_owned(), surface(4, &(v, t), bumpy(0.4, 18)))])
}

fn open(_: Scale) -> Result<Vec<Model>, SceneError> {
    let folded = |p: Place| [0, 1, 2].map(|k| p.flat[k] + 0.7 * p.noise(19)[k] / f64::from(1u32 << p.level));
    list([
        ("flat sheet".to_owned(), surface(3, &sheet(4), flat)),
        ("coarse sheet".to_owned(), coarse(2, &sheet(3), 20)),
        ("folded sheet".to_owned(), surface(3, &sheet(2), folded)),
    ])
}

fn non_manifold(_: Scale) -> Result<Vec<Model>, SceneError> {
    let rough = |p: Place| [0, 1, 2].map(|k| p.flat[k] + 0.2 * p.noise(21)[k] / f64::from(1u32 << p.level));
    list([
        ("fan, N = 0".to_owned(), coarse(0, &fan(), 22)),
        ("fan, N = 3".to_owned(), surface(3, &fan(), rough)),
        ("coarse fan".to_owned(), coarse(2, &fan(), 23)),
    ])
}

fn rebuilds(scale: Scale) -> Result<Vec<Model>, SceneError> {
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

/// A rebuild in ten leaves all points where they are: the next one jumps from there.
fn now_and_then_flat(n: u64, jumped: Surface) -> Surface {
    if n % 10 == 9 { surface(jumped.levels, &octahedron(), flat) } else { jumped }
}

/// The case that the hunt takes its first rays from.
pub(super) fn hunting_case() -> Case {
    const AIMS: &[Aim] = &[Aim::Edges, Aim::AlongEdge, Aim::Grazing, Aim::AxisParallel, Aim::BoxFace];
    Case { name: "hunt", aims: AIMS, every: 1, share: 1, ..CLOSED }
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
    let form = VertexForm::ALL[random.below(2) as usize];
    // By way of its integers, as a kept ray's model is made again.
    Model::of_hierarchy("hunted", quantise(&surface, BoundKind::Largest, form, 0)?)
}
