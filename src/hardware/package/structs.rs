//! Packed structs from [`Wire`] types: names, order, widths and descriptions of the fields are those of the source.

use crate::block::{self, Block};
use crate::format::{BvhNode, Displacements, L0Record, ShortDisplacements, SplitRecord, VertexData};
use crate::hardware::ports::{
    ContextView, Corners, HitOut, MemoryAnswer, MemoryRequest, MemoryTest, RayIn, SceneConfig, SecondaryIn, UnitCounters,
};
use crate::method::{Entry, Hit};
use crate::num::{self, Box16, Field, Layout, Wire};
use std::fmt::Write;

/// Blocks that have the output of another.
const SHARED: [&str; 6] = ["box_test32", "prism_test", "child_prisms", "lod_test_by", "start_setup", "start_divide"];

/// A packed struct: its name without `_t`, its description and its fields.
pub(super) struct Struct {
    name: String,
    doc: String,
    fields: &'static [Field],
}

/// The struct of a type, with the first paragraph of its own description.
fn of<T: Wire>(name: impl Into<String>) -> Struct {
    let first = T::DOC.split(|line| line.trim().is_empty()).next().unwrap_or_default();
    Struct { name: name.into(), doc: plain(first), fields: T::FIELDS }
}

/// A vector of three equal components.
fn vector<const W: u32>(name: &str, doc: &str) -> Struct {
    Struct { name: name.to_owned(), doc: doc.to_owned(), fields: num::Vec3::<W>::FIELDS }
}

/// Every struct that Rust has a type of, each behind those that it contains.
pub(super) fn all() -> Vec<Struct> {
    let mut all = vec![
        vector::<32>("point", "Vertex position or ray origin in units."),
        vector::<31>("direction", "Ray direction: each component below 2^30 in magnitude."),
        vector::<28>("stored_point", "Stored vertex: units / 16."),
        vector::<22>("stored_corner", "Stored corner of a base triangle of compact vertices: units / 1024."),
        vector::<13>("displacement", "Displacement of a compact vertex from the midpoint of its edge, in steps."),
        vector::<7>("short_displacement", "Its leading bits, in a last split of short vertices."),
        vector::<16>("code3", "Corner of a box in steps of 2^16 units."),
        vector::<11>("local", "Local coordinates of a corner, mirrored."),
        vector::<63>("moment", "Moment of a ray: origin cross direction."),
        of::<num::BoundScale>("bound_scale"),
        of::<num::Cone>("cone"),
        of::<num::Ray>("ray"),
        of::<num::Start>("start"),
        of::<Box16>("box16"),
        of::<block::ray_setup::Reciprocal>("reciprocal"),
        of::<block::ray_setup::Axis>("axis"),
    ];
    macro_rules! blocks {
        ($($block:ty),+ $(,)?) => { $(
            all.push(of::<<$block as Block>::In>(format!("{}_in", <$block>::NAME)));
            if !SHARED.contains(&<$block>::NAME) {
                all.push(of::<<$block as Block>::Out>(format!("{}_out", <$block>::NAME)));
            }
        )+ };
    }
    blocks!(
        block::ray_setup::RaySetup,
        block::bound_decode::BoundDecode,
        block::lod_test::LodTest,
        block::tessellate::Tessellate,
        block::child_boxes::ChildBoxes,
        block::box_decode::BoxDecode,
        block::box_decode8::BoxDecode8,
        block::box_test::BoxTest,
        block::box_test32::BoxTest32,
        block::child_sort::ChildSort,
        block::child_sort6::ChildSort6,
        block::child_test::ChildTest,
        block::tri_test::TriTest,
        block::hit_divide::HitDivide,
        block::hit_select::HitSelect,
        block::bary_map::BaryMap,
        block::node_address::NodeAddress,
        block::tree_deciders::TreeDeciders,
        block::node_deciders::NodeDeciders,
        block::lod_test_by::LodTestBy,
        block::start_setup::StartSetup,
    );
    all.push(of::<block::start_test::Below>("below"));
    blocks!(block::start_test::StartTest, block::start_divide::StartDivide);
    all.push(of::<block::prism_frame::Frame>("frame"));
    blocks!(block::prism_frame::PrismFrame, block::prism_test::PrismTest, block::child_prisms::ChildPrisms);
    all.extend([
        of::<SplitRecord>("split_record"),
        of::<BvhNode>("bvh_node"),
        of::<VertexData>("vertex_data"),
        of::<Displacements>("displacements"),
        of::<ShortDisplacements>("short_displacements"),
        of::<L0Record>("l0_record"),
        of::<Entry>("stack_entry"),
        of::<Hit>("hit"),
        of::<SceneConfig>("scene_config"),
        of::<RayIn>("ray_in"),
        of::<SecondaryIn>("secondary_in"),
        of::<Corners>("corners"),
        of::<HitOut>("hit_out"),
        of::<MemoryRequest>("memory_request"),
        of::<MemoryAnswer>("memory_answer"),
        of::<MemoryTest>("memory_test"),
        of::<ContextView>("context_view"),
        of::<UnitCounters>("unit_counters"),
    ]);
    all
}

impl Struct {
    /// The typedef and the width; `all` are those that may be fields.
    pub(super) fn print(&self, all: &[Self], out: &mut String) {
        let fields: Vec<(String, String)> = self.fields.iter().map(|field| bits(field, all)).collect();
        let lines: Vec<String> = self.fields.iter().zip(&fields).map(|(field, (kind, _))| format!("    {kind} {};", field.name)).collect();
        let longest = lines.iter().map(String::len).max().unwrap_or(0);
        let _ = write!(out, "\n  // {}\n  typedef struct packed {{\n", self.doc);
        for (line, field) in lines.iter().zip(self.fields) {
            let _ = match plain(field.doc).as_str() {
                "" => writeln!(out, "{line}"),
                doc => writeln!(out, "{line:longest$}  // {doc}"),
            };
        }
        let widths: Vec<&str> = fields.iter().map(|(_, width)| width.as_str()).collect();
        let width = match self.fields {
            // A vector: its components have no names of their own.
            [first, ..] if first.doc.is_empty() => format!("{} * {}", widths.len(), widths[0]),
            _ => widths.join(" + "),
        };
        let _ = write!(out, "  }} {}_t;\n  localparam int unsigned {}_W = {width};\n", self.name, self.name.to_uppercase());
    }
}

/// Type and width of a field, as the package writes them.
fn bits(field: &Field, all: &[Struct]) -> (String, String) {
    match field.layout {
        Layout::Struct(fields) => match all.iter().find(|of| of.fields == fields) {
            Some(of) => (format!("{}_t", of.name), format!("{}_W", of.name.to_uppercase())),
            None => unreachable!("{}: {} stands in the list", field.name, field.kind),
        },
        Layout::Array(count) => {
            let element = field.kind.trim_start_matches('[').split(';').next().unwrap_or_default();
            let high = count - 1;
            match width_of(element, field.width / count).as_str() {
                "1" => (format!("logic [{high}:0]"), count.to_string()),
                width => (format!("logic [{high}:0][{}:0]", high_of(width)), format!("{count} * {width}")),
            }
        }
        Layout::Unsigned | Layout::Signed => {
            let sign = if field.layout == Layout::Signed { " signed" } else { "" };
            match width_of(field.kind, field.width).as_str() {
                "1" => (format!("logic{sign}"), "1".to_owned()),
                width => (format!("logic{sign} [{}:0]", high_of(width)), width.to_owned()),
            }
        }
    }
}

/// The width of a type: by name if the type has one (`BoundCode` is `BOUND_CODE_W`), else its number.
fn width_of(kind: &str, width: u32) -> String {
    let name = kind.rsplit("::").next().unwrap_or(kind);
    if name == "bool" || name.ends_with('>') { width.to_string() } else { format!("{}_W", snake(name).to_uppercase()) }
}

/// The highest bit of a width.
fn high_of(width: &str) -> String {
    width.parse::<u32>().map_or_else(|_| format!("{width}-1"), |number| (number - 1).to_string())
}

/// A description as one line, names of blocks as the RTL has them.
fn plain(doc: &[&str]) -> String {
    let text = doc.iter().map(|line| line.trim()).collect::<Vec<_>>().join(" ");
    let mut parts = text.split("[`");
    let mut out = parts.next().unwrap_or_default().to_owned();
    for part in parts {
        match part.split_once("`]") {
            Some((name, rest)) => {
                let name = name.rsplit("::").next().unwrap_or(name);
                out += &if name.contains(|c: char| c.is_ascii_lowercase()) { snake(name) } else { name.to_owned() };
                // Where the link leads is nothing to the RTL.
                out += rest.strip_prefix('(').and_then(|rest| rest.split_once(')')).map_or(rest, |(_, rest)| rest);
            }
            None => out += part,
        }
    }
    out
}

/// `BoundCode` as `bound_code`.
fn snake(name: &str) -> String {
    let mut out = String::new();
    for (at, letter) in name.char_indices() {
        if letter.is_ascii_uppercase() && at > 0 {
            out.push('_');
        }
        out.push(letter.to_ascii_lowercase());
    }
    out
}
