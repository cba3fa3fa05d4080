//! The named cases: stiff models, stiff rays, stiff cones.

use super::model::Model;
use super::rays::{Aim, BOUNCES, Bounce, Cones, PIXEL, Views};
use super::stiff::{
    Scale, balls, both, coincident, edges_exact, flat_parts, flats, levels, million, needles, non_manifold, offset, one_triangle, open,
    rebuilds, refits, scaled, scales, sheets, slivers, spikes, turned, zero_area,
};
use crate::format::SceneError;

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
    /// Rays go together, in packets of 32.
    pub is_packed: bool,
    /// Rays come from a scene in which the model stands somewhere: stretched, mirrored, far away.
    pub is_placed: bool,
}

/// Every how many rays of a closed model the golden traverser is asked.
pub const SAMPLE: u64 = 256;

const ALL: &[Aim] =
    &[Aim::Edges, Aim::View, Aim::Edges, Aim::Grazing, Aim::Inside, Aim::AlongEdge, Aim::Edges, Aim::AxisParallel, Aim::BoxFace];
const LENS: &[f64] = &[PIXEL];
const USUAL: Views = Views { distances: &[1.2, 2.5, 20.0], deltas: &[0.25, 1.0, 8.0], tangents: LENS };
/// Close enough to see single units.
const CLOSE: Views = Views { distances: &[1e-5, 1e-3, 1e-1, 2.5], ..USUAL };
const CLOSED: Case = Case {
    name: "",
    about: "",
    models: edges_exact,
    aims: ALL,
    cones: Cones::Mixed,
    views: USUAL,
    every: SAMPLE,
    share: 32,
    is_packed: false,
    is_placed: false,
};
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
    Case {
        name: "refits",
        about: "refitted one after the other: to a plane, a line, a point, a million times as long, to corners of the box, and back",
        models: refits,
        share: 8,
        ..CLOSED
    },
    Case { name: "packets", about: "32 rays together, a pencil or each from elsewhere", models: both, is_packed: true, ..CLOSED },
    Case {
        name: "packets-stiff",
        about: "the same on needles, and on triangles two and four times in one place",
        models: |s| Ok(needles(s)?.into_iter().chain(coincident(s)?).collect()),
        is_packed: true,
        share: 8,
        ..CLOSED
    },
    Case {
        name: "instances",
        about: "rays from scenes in which the model is up to 1e6 times as long in one direction, 1e-6 to 1e6 as large, mirrored, and up to a million sizes away",
        models: both,
        is_placed: true,
        ..CLOSED
    },
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

/// The case that the hunt takes its first rays from.
pub(super) fn hunting_case() -> Case {
    const AIMS: &[Aim] = &[Aim::Edges, Aim::AlongEdge, Aim::Grazing, Aim::AxisParallel, Aim::BoxFace];
    Case { name: "hunt", aims: AIMS, every: 1, share: 1, ..CLOSED }
}
