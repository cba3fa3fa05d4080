//! `lines`: the distinct 32-byte lines that a frame touches, by distance, LOD against full-resolution BVH layouts, over the finest level and over the mesh that it was built from.

use super::args::{CameraArgs, radii};
use super::cache::CacheArgs;
use super::input::{InputArgs, with_input_if_found};
use super::output::{explain, open, print_json, print_table, progress};
use crate::cli::bars::Bars;
use indicatif::ProgressBar;
use lodray::bvh::{BvhError, Options};
use lodray::format::Scene;
use lodray::mesh::Hierarchy;
use lodray::method::bvh::{
    FullBuilder, FullBvh, FullOptions, FullTree, LeafLayout, Leaves, NoStore, NodeBoxes, NodeOrder, TreeKey, TreeStore,
};
use lodray::method::{Knobs, knob, lod};
use lodray::picture::{FrameStats, distinct_lines, render};
use lodray::rays::{Camera, ModelSpace, Sight};
use lodray::study::{Cache, Lookup, grouped};
use serde::Serialize;
use std::path::PathBuf;
use std::process::ExitCode;
use std::sync::Arc;

/// Size of the frames: a quarter of the rays of a picture. Each is traced once for each tree of the table.
const SIZE: &str = "512x512";

#[derive(clap::Args)]
#[command(mut_arg("size", |size| size.help("Picture size in pixels").default_value(SIZE)))]
pub struct Args {
    /// Scene file
    scene: PathBuf,
    /// Distances in bounding radii
    #[arg(
        long,
        value_delimiter = ',',
        default_value = "1.2,2,4,8,16,32",
        value_parser = radii,
        allow_hyphen_values = true,
        conflicts_with = "distance"
    )]
    distances: Vec<f64>,
    #[arg(long, help = knob::DELTA.help, default_value = "1", value_parser = knob::quality, allow_hyphen_values = true)]
    delta: f64,
    /// Count every BVH layout: wider boxes, nodes of six, other leaves (default the three that need least)
    #[arg(long)]
    all: bool,
    #[command(flatten)]
    camera: CameraArgs,
    #[command(flatten)]
    input: InputArgs,
    #[command(flatten)]
    cache: CacheArgs,
    /// Print the figures as JSON
    #[arg(long)]
    json: bool,
}

/// Distinct lines of one structure at each distance.
#[derive(Serialize)]
struct Row {
    structure: String,
    distinct_lines: Vec<u64>,
}

#[derive(Serialize)]
struct Report {
    distances: Vec<f64>,
    delta: f64,
    /// Shares of the LOD frame's distinct lines that are L0 nodes and records.
    base_share: Vec<f64>,
    mean_level: Vec<f64>,
    rows: Vec<Row>,
    /// Best BVH with boxes of up to 16 bits over LOD.
    ratio: Vec<f64>,
    /// The same of those over the mesh that the scene was built from, if that is at hand.
    #[serde(skip_serializing_if = "Option::is_none")]
    ratio_of_mesh: Option<Vec<f64>>,
}

/// Boxes, largest number of triangles of a leaf, and leaf layouts that are counted: blocks in nodes of local boxes, since one of these had the
/// fewest lines in every view of docs/figures.md, or all.
fn layouts(all: bool) -> Vec<(NodeBoxes, u32, &'static [LeafLayout])> {
    const ALONE: &[LeafLayout] = &[LeafLayout::Indexed, LeafLayout::Packed, LeafLayout::Line];
    let blocks = [4, 8, 16].map(|size| (size, &[LeafLayout::Block][..]));
    if !all {
        return blocks.map(|(size, layouts)| (NodeBoxes::Local, size, layouts)).to_vec();
    }
    let kinds = [1, 2, 4].map(|size| (size, ALONE)).into_iter().chain(blocks);
    let boxes = [NodeBoxes::Local, NodeBoxes::Six, NodeBoxes::Codes, NodeBoxes::Wide];
    boxes.into_iter().flat_map(|boxes| kinds.clone().map(move |(size, layouts)| (boxes, size, layouts))).collect()
}

pub fn run(args: &Args) -> anyhow::Result<ExitCode> {
    let cache = args.cache.cache(None)?;
    let scene = with_input_if_found(open(&args.scene)?, &args.scene, &args.input, "no BVH of the mesh is counted")?;
    let space = ModelSpace::of(&scene);
    let cameras = args.distances.iter().map(|&d| args.camera.camera(&space, Some(d))).collect::<Result<Vec<_>, _>>()?;
    let layouts = layouts(args.all);
    let rows = cameras.iter().map(|camera| u64::from(camera.height)).sum::<u64>();
    let over = 1 + u64::from(scene.input().is_some());
    let frames = 2 + over * layouts.iter().map(|(_, _, leaves)| leaves.len() as u64).sum::<u64>();
    let bar = progress(frames * rows, "tracing");

    let method = (lod::METHOD.make)(&scene, &Knobs::default(), &NoStore)?;
    let count = |delta: f64| -> Vec<_> {
        bar.set_message("tracing");
        cameras.iter().map(|camera| render(&*method, &space, camera, delta, &|| bar.inc(1)).1).collect()
    };
    let distinct = |stats: &[FrameStats]| stats.iter().map(|s| s.distinct_lines()).collect::<Vec<u64>>();

    let lod = count(args.delta);
    let mut rows = vec![
        Row { structure: "LOD".to_owned(), distinct_lines: distinct(&lod) },
        Row { structure: "LOD structure at full detail".to_owned(), distinct_lines: distinct(&count(f64::INFINITY)) },
    ];
    let subject = Subject { cameras: &cameras, layouts: &layouts, cache: &cache, bar: &bar };
    let best = subject.count(&scene, "", &mut rows)?;
    let of_mesh = scene.input().map(|input| subject.count(input, " of the mesh", &mut rows)).transpose()?;
    bar.finish_and_clear();

    let over_lod = |best: &[u64]| best.iter().zip(&rows[0].distinct_lines).map(|(&b, &l)| b as f64 / l.max(1) as f64).collect();
    let (ratio, ratio_of_mesh) = (over_lod(&best), of_mesh.as_deref().map(over_lod));
    let map = cameras.first().map(|camera| method.map(&Sight::new(camera, &space, args.delta))).unwrap_or_default();
    let base = |s: &FrameStats| {
        let is_base = |kind: &str| map.sections().any(|(_, section)| section.base && section.name == kind);
        let of = s.lines.iter().filter(|k| is_base(k.kind)).map(|k| k.distinct).sum::<u64>();
        of as f64 / s.distinct_lines().max(1) as f64
    };
    let report = Report {
        distances: args.distances.clone(),
        delta: args.delta,
        base_share: lod.iter().map(base).collect(),
        mean_level: lod.iter().map(|s| s.mean_level).collect(),
        rows,
        ratio,
        ratio_of_mesh,
    };
    if args.json {
        print_json(&report)?
    } else {
        print_table(&table(&report))?;
        explain("lines")?;
    }
    Ok(ExitCode::SUCCESS)
}

/// What is counted of BVHs.
struct Subject<'a> {
    cameras: &'a [Camera],
    layouts: &'a [(NodeBoxes, u32, &'static [LeafLayout])],
    cache: &'a Cache,
    bar: &'a ProgressBar,
}

impl Subject<'_> {
    /// Counts the lines of every BVH over the finest triangles of `scene`; gives the fewest, those of wide boxes aside.
    fn count(&self, scene: &Scene, of: &str, rows: &mut Vec<Row>) -> Result<Vec<u64>, BvhError> {
        let (hierarchy, space, bar) = (scene.decode(), ModelSpace::of(scene), self.bar);
        let mut trees = Trees::new(scene, self.cache, &hierarchy);
        let mut best = vec![u64::MAX; self.cameras.len()];
        for &(boxes, size, leaves) in self.layouts {
            let options = |layout| FullOptions::new(size, boxes, layout);
            // Layouts of one tree are counted together.
            for group in leaves.chunk_by(|&a, &b| options(a).tree == options(b).tree) {
                bar.set_message("building the BVH");
                let bvh = trees.bvh(&options(group[0]))?;
                let others = group[1..].iter().map(|&layout| trees.leaves(layout)).collect::<Result<Vec<_>, _>>()?;
                let others: Vec<_> = others.iter().map(AsRef::as_ref).collect();
                bar.set_message("tracing");
                let steps = group.len() as u64;
                let frame = |camera| distinct_lines(&bvh, &others, &space, camera, &|rows| bar.inc(steps * rows));
                let frames: Vec<_> = self.cameras.iter().map(frame).collect();
                for (k, layout) in group.iter().enumerate() {
                    let lines: Vec<u64> = frames.iter().map(|frame| frame[k]).collect();
                    if boxes != NodeBoxes::Wide {
                        best.iter_mut().zip(&lines).for_each(|(b, &n)| *b = n.min(*b));
                    }
                    let nodes = match boxes {
                        NodeBoxes::Local => "BVH 5-bit",
                        NodeBoxes::Six => "BVH6 8-bit",
                        NodeBoxes::Oriented => "BVH6 8-bit oriented",
                        NodeBoxes::Codes => "BVH 16-bit",
                        NodeBoxes::Wide => "BVH 32-bit",
                    };
                    rows.push(Row { structure: format!("{nodes}{of}, {layout:?}, {size} a leaf"), distinct_lines: lines });
                }
            }
        }
        Ok(best)
    }
}

/// BVHs over a scene that share what they can: the binary tree that all collapse, the nodes of layouts of equal cost, and the triangles.
struct Trees<'a> {
    scene: &'a Scene,
    cache: &'a Cache,
    hierarchy: &'a Hierarchy,
    /// Made when the cache lacks a tree.
    builder: Option<FullBuilder<'a>>,
    /// The last tree, and its options.
    tree: Option<((Options, NodeBoxes, NodeOrder), Arc<FullTree>)>,
    /// Leaves of each layout over the triangles of the last tree: those of the binary tree in its order, the same for all but local boxes, nodes of six and blocks.
    leaves: Vec<Arc<Leaves>>,
}

impl<'a> Trees<'a> {
    fn new(scene: &'a Scene, cache: &'a Cache, hierarchy: &'a Hierarchy) -> Self {
        Self { scene, cache, hierarchy, builder: None, tree: None, leaves: Vec::new() }
    }

    fn bvh(&mut self, options: &FullOptions) -> Result<FullBvh, BvhError> {
        let nodes = self.tree(options)?.nodes();
        Ok(FullBvh { levels: self.hierarchy.levels, nodes, leaves: self.leaves(options.layout)? })
    }

    fn tree(&mut self, options: &FullOptions) -> Result<Arc<FullTree>, BvhError> {
        let shape = (options.tree, options.boxes, options.order);
        if let Some((_, tree)) = self.tree.as_ref().filter(|(of, _)| *of == shape) {
            return Ok(Arc::clone(tree));
        }
        let key = || TreeKey::new(self.scene, options, self.scene.levels());
        let tree = Lookup::new(self.cache, &Bars).tree(&key, self.scene.finest_triangles(), &mut || {
            let builder = match self.builder.take() {
                Some(builder) => builder,
                None => FullBuilder::new(self.hierarchy)?,
            };
            self.builder.insert(builder).tree(options)
        })?;
        if self.tree.as_ref().is_none_or(|(_, before)| !before.has_leaves_of(&tree)) {
            self.leaves = Vec::new();
        }
        let tree = Arc::new(tree);
        self.tree = Some((shape, Arc::clone(&tree)));
        Ok(tree)
    }

    /// Those of the last tree.
    fn leaves(&mut self, layout: LeafLayout) -> Result<Arc<Leaves>, BvhError> {
        if let Some(made) = self.leaves.iter().find(|leaves| leaves.layout() == layout) {
            return Ok(Arc::clone(made));
        }
        let (_, tree) = self.tree.as_ref().ok_or(BvhError::OtherHierarchy)?;
        let made = Arc::new(tree.leaves(self.hierarchy, layout)?);
        self.leaves.push(Arc::clone(&made));
        Ok(made)
    }
}

fn table(r: &Report) -> String {
    let width = r.rows.iter().map(|row| row.structure.len() + 1).max().unwrap_or(0).max(32);
    let line = |name: &str, cells: Vec<String>| {
        let cells: String = cells.iter().map(|c| format!("{c:>13}")).collect();
        format!("{name:<width$}{cells}\n")
    };
    let decimals = |v: &[f64]| v.iter().map(|x| format!("{x:.2}")).collect::<Vec<_>>();
    let mut text = line("distance (bounding radii)", r.distances.iter().map(f64::to_string).collect());
    for row in &r.rows {
        text += &line(&row.structure, row.distinct_lines.iter().map(|&n| grouped(n)).collect());
    }
    text += &line("best BVH / LOD", decimals(&r.ratio));
    if let Some(ratio) = &r.ratio_of_mesh {
        text += &line("best BVH of the mesh / LOD", decimals(ratio));
    }
    text += &line("share of L0 in LOD's lines", decimals(&r.base_share));
    text += &line("mean level", decimals(&r.mean_level));
    text.trim_end().to_owned()
}
