//! A plan as a table: what is needed, what there is, and what leaving out the rest saves.

use super::{Data, Plan, Speed};
use crate::hardware::Hardware;
use crate::num::MAX_DISPLACEMENT_SHIFT;
use serde::Serialize;

/// What a line is about.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Part {
    /// How deep and how large the hierarchy is.
    Structure,
    /// Widths of numbers.
    Numbers,
    /// What rays ask for.
    Features,
    /// How fast units are.
    Speed,
    /// Bytes of the scenes.
    Data,
}

/// A line: something of which a plan needs less than there is.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Saving {
    /// What it is about.
    pub part: Part,
    /// What it is, in words.
    pub what: &'static str,
    /// How much is needed.
    pub needed: String,
    /// How much there is.
    pub full: String,
    /// Why no more is needed.
    pub reason: String,
    /// What is saved, where the unit or the file can leave it out; empty where it cannot yet.
    pub saved: String,
}

struct Table {
    lines: Vec<Saving>,
}

impl Table {
    fn add(&mut self, part: Part, what: &'static str, [needed, full]: [u32; 2], reason: &str, saved: String) {
        if needed < full {
            self.lines.push(Saving { part, what, needed: needed.to_string(), full: full.to_string(), reason: reason.to_owned(), saved });
        }
    }

    fn bits(&mut self, what: &'static str, needed_of_full: [u32; 2], reason: &str) {
        self.add(Part::Numbers, what, needed_of_full, reason, String::new());
    }

    fn feature(&mut self, what: &'static str, needed: bool, reason: &str, saved: String) {
        if !needed {
            let (needed, full) = ("no".to_owned(), "yes".to_owned());
            self.lines.push(Saving { part: Part::Features, what, needed, full, reason: reason.to_owned(), saved });
        }
    }
}

impl Table {
    /// What a machine's units are more than fast enough by; in all else they are as `hardware`.
    fn speed(&mut self, speed: &Speed, hardware: &Hardware) {
        let Speed { units, own, .. } = speed;
        let reason = format!("keeps {:.1} % of the frame rate", 100.0 * speed.kept);
        for (what, needed_of_full) in [
            ("contexts of a unit", [units.contexts, own.contexts]),
            ("edge functions a cycle", [units.edges_per_cycle, own.edges_per_cycle]),
            ("edges of the LOD test a cycle", [units.lod_edges_per_cycle, own.lod_edges_per_cycle]),
            ("boxes a cycle", [units.boxes_per_cycle, own.boxes_per_cycle]),
            ("bits of a hit's division a cycle", [units.divide_bits, own.divide_bits]),
            ("bits of a reciprocal a cycle", [units.setup_bits, own.setup_bits]),
            ("blocks of a ray's constants", [units.setup_copies, own.setup_copies]),
            ("blocks of a hit's division", [units.divide_copies, own.divide_copies]),
            ("units of a group", [units.per_group, own.per_group]),
        ] {
            self.add(Part::Speed, what, needed_of_full, &reason, String::new());
        }
        let gates = |units| Speed::gates(units, hardware);
        let (needed, full) = (gates(units), gates(own));
        if needed < full {
            let million = |gates: f64| format!("{:.3}", 1e-6 * gates);
            let (reason, saved) =
                ("all of these together".to_owned(), format!("{} million gate equivalents of a group", million(full - needed)));
            self.lines.push(Saving {
                part: Part::Speed,
                what: "million gate equivalents",
                needed: million(needed),
                full: million(full),
                reason,
                saved,
            });
        }
    }
}

/// What `plan` leaves out of `full`, and of the data of its scenes.
pub fn savings(plan: &Plan, full: &Hardware, data: Option<&Data>) -> Vec<Saving> {
    let (scene, own) = (&plan.scene, plan.hardware(full));
    let context = |hardware: &Hardware| hardware.context_registers(true).kept;
    let without = |less: Hardware| format!("{} bits of a context", context(full) - context(&less));
    let mut table = Table { lines: Vec::new() };
    // Each by itself, with the stack that follows from it; numbers of nodes and lines besides all others.
    let levels = without(Hardware { levels: own.levels, ..*full });
    table.add(Part::Structure, "levels", [own.levels, full.levels], "no scene has more", levels);
    let reason = if plan.rays.is_some() { "no tree is stored deeper, or no ray goes there" } else { "no tree is stored deeper" };
    let saved = without(Hardware { fewer_stored_levels: own.fewer_stored_levels, ..*full });
    table.add(Part::Structure, "stored levels", [own.stored_levels(), full.stored_levels()], reason, saved);
    let depth = without(Hardware { bvh_depth: own.bvh_depth, ..*full });
    table.add(Part::Structure, "quad-BVH depth", [own.bvh_depth, full.bvh_depth], "no path to a tree is longer", depth);
    let stack = without(Hardware { fewer_stack_entries: own.fewer_stack_entries, ..*full });
    let reason = "the most siblings that can wait on a path";
    table.add(Part::Structure, "stack entries", [own.stack_entries(), full.stack_entries()], reason, stack);
    if context(&own) != context(full) {
        let (needed, of) = (context(&own).to_string(), context(full).to_string());
        let (reason, saved) = ("all of these together".to_owned(), without(own));
        table.lines.push(Saving { part: Part::Structure, what: "bits of a context", needed, full: of, reason, saved });
    }
    let (form, zeros) = (own.form(), |coordinate_zeros, direction_zeros| without(Hardware { coordinate_zeros, direction_zeros, ..*full }));
    let reason = "all end in zeros, of morphed triangles and origins too";
    table.add(Part::Numbers, "coordinate without its zeros", [form.coordinate(), 32], reason, zeros(own.coordinate_zeros, 0));
    let reason = "all components end in zeros";
    table.add(Part::Numbers, "direction without its zeros", [form.component(), 31], reason, zeros(0, own.direction_zeros));
    let besides = |more: Hardware| format!("{} bits of a context", context(&more) - context(&own));
    let index = besides(Hardware { index_bits: full.index_bits, ..own });
    table.bits("number of a quad-BVH node", [scene.bvh_node_bits, 28], "so many are there");
    table.bits("number of a tree", [scene.tree_bits, 28], "so many are there");
    table.add(Part::Numbers, "number of either, or of a node", [own.index_bits, 28], "the larger of both", index);
    table.bits("number of a memory line", [scene.line_bits, 32], "so many have the scene's sections");
    table.bits("coordinate", [scene.coordinate_bits, 32], "none is larger");
    table.bits("box code of a frame", [scene.frame_bits, 16], "none is larger");
    table.bits("plane of a quad-BVH node", [scene.node_plane_bits, 5], "none is larger");
    table.bits("plane of a split", [scene.split_plane_bits, 2], "none is larger");
    table.add(Part::Numbers, "exponent of a node's steps", [scene.node_exponent, 15], "none is larger", String::new());
    table.add(Part::Numbers, "exponent of a split's steps", [scene.split_exponent, 15], "none is larger", String::new());
    table.bits("bound code", [scene.code_bits, 8], "none is larger");
    table.bits("displacement bound", [scene.bound_bits, 33], "none is larger");
    table.bits("displacement", [scene.displacement_bits, 13], "none is larger");
    table.add(
        Part::Numbers,
        "shift of a displacement",
        [scene.displacement_shift, MAX_DISPLACEMENT_SHIFT],
        "none is larger",
        String::new(),
    );
    if let Some(rays) = &plan.rays {
        table.bits("component of a direction", [rays.direction_bits, 31], "none is larger");
        table.bits("offset of a cone", [rays.cone_offset_bits, 53], "none is larger");
        table.bits("slope of a cone", [rays.cone_slope_bits, 18], "none is larger");
        table.add(Part::Numbers, "shift of a cone", [rays.cone_shift, 63], "none is larger", String::new());
        let saved = format!("lod_test, morphs of tessellate, {}", without(Hardware { lod_test: false, ..*full }));
        table.feature("choice of a level, and morphs", rays.lod_test, "every quality is 0 or infinite: edges are closed or open", saved);
        let saved = format!("bary_map, {}", without(Hardware { hit_mapping: false, ..*full }));
        table.feature("hits mapped to full resolution", rays.hit_mapping, "every hit is on a triangle of the finest level", saved);
        let saved = without(Hardware { start_radius: false, ..*full });
        table.feature("radius where a ray starts", rays.start_radius, "no ray has one", saved);
    }
    let saved = "selections in tessellate".to_owned();
    table.feature("vertices as displacements", scene.compact, "no scene has compact vertices", saved.clone());
    table.feature("vertices as they are", scene.exact, "no scene has exact vertices", saved);
    if let Some(speed) = &plan.speed {
        table.speed(speed, &own);
    }
    if let Some(data) = data {
        let mut less = |to: u64, reason, saved: &str| {
            if to < data.stored {
                let (needed, full) = (format!("{:.2}", data.per_triangle(to)), format!("{:.2}", data.per_triangle(data.stored)));
                let (what, saved) = ("bytes a finest triangle", saved.to_owned());
                table.lines.push(Saving { part: Part::Data, what, needed, full, reason: String::from(reason), saved });
            }
        };
        less(data.above_flat, "below a node with three codes of 0 no ray reads", "");
        less(data.reached, "no ray of the job goes deeper in its tree", "lodray prune");
    }
    table.lines
}
