//! Documents of error against cost: of a tiny scene, and a large one made of it.

use lodray::picture::save_png;
use lodray::report::error_time::*;
use lodray_test_support::program::Desk;
use std::fs;
use std::path::{Path, PathBuf};

/// `error-time` of the scene in `a.lod`, into the desk's own folder.
pub fn of(desk: &Desk) -> ErrorTime {
    desk.run(
        "error-time a.lod -o . --size 160x120 --error-size 80 --distances 0.7,2,6 --samples 1,4 --values delta=0.25,1,4 --most-samples 64 --no-host --within 0.0001,1 --quiet",
    );
    serde_json::from_str(&desk.text("error-time.json")).unwrap()
}

/// The costs of a document, wherever they stand.
pub fn costs(of: &mut ErrorTime) -> impl Iterator<Item = &mut Costs> {
    let points = of.points.iter_mut().chain(of.left_out.iter_mut().map(|left| &mut left.point)).flat_map(|point| &mut point.costs);
    points.chain(of.sizes.iter_mut().flat_map(|size| &mut size.costs))
}

/// A document for each view of `whole`, of that view alone.
pub fn by_view(whole: &ErrorTime) -> Vec<ErrorTime> {
    let of = |own: usize| {
        let mut all = whole.clone();
        let only = |view: &mut usize| {
            let is = *view == own;
            *view = 0;
            is
        };
        all.views = vec![whole.views[own].clone()];
        all.points.retain_mut(|point| only(&mut point.view));
        all.left_out.retain_mut(|left| only(&mut left.point.view));
        all.sizes.retain_mut(|size| only(&mut size.view));
        all.equal_error.retain_mut(|equal| only(&mut equal.view));
        all.pictures.retain_mut(|picture| only(&mut picture.view));
        all.traces.retain_mut(|grid| only(&mut grid.view));
        all
    };
    (0..whole.views.len()).map(of).collect()
}

/// All files of a folder and its folders, by their paths within it; `within` is where it lies itself.
pub fn below(folder: &Path, within: &Path) -> Vec<(PathBuf, Vec<u8>)> {
    let entries = fs::read_dir(folder).unwrap().map(|entry| entry.unwrap());
    let of_entry = |entry: fs::DirEntry| {
        let (path, name) = (entry.path(), within.join(entry.file_name()));
        if path.is_dir() { below(&path, &name) } else { vec![(name, fs::read(&path).unwrap())] }
    };
    entries.flat_map(of_entry).collect()
}

/// The same of `scenes` scenes at `distances` distances, with pictures of `side` that are hard to compress: for the weight of a large page.
pub fn enlarged(one: &ErrorTime, folder: &Path, scenes: usize, distances: usize, side: u32) -> ErrorTime {
    let mut noise = 1u32;
    for k in 0..4 {
        let mut draw = |_, y: u32| {
            noise = noise.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            let v = ((noise >> 27) + y * 200 / side) as u8;
            image::Rgb([v, v, v.wrapping_add(9)])
        };
        save_png(&image::RgbImage::from_fn(side, side, &mut draw), &[], &folder.join(format!("noise-{k}.png"))).unwrap();
    }
    let mut all = ErrorTime {
        views: Vec::new(),
        points: Vec::new(),
        pictures: Vec::new(),
        traces: Vec::new(),
        equal_error: Vec::new(),
        scenes: Vec::new(),
        ..one.clone()
    };
    for scene in 0..scenes {
        all.scenes.push(SceneEntry { name: format!("scene {scene}"), ..one.scenes[0].clone() });
        for k in 0..distances {
            let view = all.views.len();
            all.views.push(ViewEntry { scene, distance: 0.5 * 2f64.powi(k as i32), size: [side, side], every: 1, ..one.views[0].clone() });
            all.points.extend(one.points.iter().filter(|p| p.view == 0).map(|p| Point { view, ..p.clone() }));
            all.traces.extend(one.traces.iter().filter(|t| t.view == 0).map(|t| TraceGrid { view, size: [side, side], ..t.clone() }));
            all.equal_error.extend(one.equal_error.iter().filter(|e| e.view == 0).map(|e| EqualError { view, ..e.clone() }));
            let picture = |(k, p): (usize, &PictureEntry)| PictureEntry { view, file: format!("noise-{}.png", k % 4), ..p.clone() };
            all.pictures.extend(one.pictures.iter().filter(|p| p.view == 0).enumerate().map(picture));
        }
    }
    all
}
