//! As many levels as a mesh needs.

use super::*;

#[test]
fn the_finest_level_has_as_many_triangles_as_the_mesh_or_few_more() {
    // Dense for their shape: removal leaves few triangles, and splitting brings back as many as there were.
    for (name, original) in [("sphere", sphere(40)), ("wave", wave(60)), ("sphere, twice as fine", sphere(80))] {
        let (surface, report) = fit(&original, RemeshOptions::default());
        let (input, finest) = (original.triangles.len() as u64, report.finest_triangles);
        assert!(
            surface.levels >= 2 && (input..=2 * input).contains(&finest),
            "{name}: {input} triangles became {finest} of {} levels",
            surface.levels
        );
        assert!(
            report.warning.is_none() && report.distance.from_original.max.max(report.distance.to_original.max) <= 0.3,
            "{name}: {report:?}"
        );
        // Neither a level more nor one less with enough triangles has fewer bytes, a tree being reckoned at eight finest triangles.
        let bytes = |report: &RemeshReport| report.finest_triangles + 8 * report.base_triangles as u64;
        for levels in [surface.levels - 1, surface.levels + 1] {
            let other = fit(&original, RemeshOptions { levels: Some(levels), ..RemeshOptions::default() }).1;
            assert!(
                other.finest_triangles < input || bytes(&other) >= bytes(&report),
                "{name}: {levels} levels: {other:?}, not {report:?}"
            );
        }
    }
}

#[test]
fn what_cannot_be_coarser_is_not_split() {
    // Every vertex of a cube of two triangles a side is a corner.
    let (surface, report) = fit(&cube(1), RemeshOptions::default());
    assert_eq!((surface.levels, report.base_triangles, report.finest_triangles), (0, 12, 12));
    // A base of a given size has the levels that make it enough.
    for (base, levels) in [(1000, 3), (200, 4), (50, 5)] {
        let original = sphere(40);
        let (surface, report) = fit(&original, RemeshOptions { base_triangles: Some(base), ..RemeshOptions::default() });
        assert_eq!((surface.levels, report.base_triangles), (levels, base));
        assert!(report.finest_triangles >= original.triangles.len() as u64);
    }
}
