//! The signals of the waveform: names, widths and values, in one walk over the unit.

use crate::block::{Block, child_test, hit_select, lod_test};
use crate::hardware::ports::{Corners, Epoch, HitOut, MemoryAnswer, MemoryRequest, RayIn, SceneConfig, SecondaryIn};
use crate::method::{Entry, STACK_ENTRIES};
use crate::num::{BitVec, Layout, Point, Wire};
use crate::sim::unit::context::Context;
use crate::sim::unit::fitted::{Fitted, ForSecondary};
use crate::sim::unit::register::Pipeline;
use crate::sim::unit::wires::{Link, Wires};
use crate::sim::unit::{Inputs, TraversalUnit};
use vcd::Value;

/// Bits of a signal, the most significant first.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Vector(Vec<Value>);

impl Vector {
    /// The bits.
    pub fn bits(&self) -> &[Value] {
        &self.0
    }

    fn of<T: Wire>(value: &T) -> Self {
        Self::of_bits(&value.to_bits())
    }

    fn of_bits(bits: &BitVec) -> Self {
        let bit = |k: u32| Value::from(bits.words()[(k / 64) as usize] >> (k % 64) & 1 == 1);
        Self((0..bits.width()).rev().map(bit).collect())
    }

    /// The low `width` bits of a small number.
    fn number(value: u64, width: u32) -> Self {
        let mut bits = BitVec::zero(width);
        bits.words_mut()[0] = value;
        Self::of_bits(&bits)
    }

    fn flag(value: bool) -> Self {
        Self(vec![value.into()])
    }

    fn unknown(width: u32) -> Self {
        Self(vec![Value::X; width as usize])
    }

    /// A register's value.
    fn register<T: Wire>(value: Option<T>) -> Self {
        value.map_or(Self::unknown(T::WIDTH), |value| Self::of(&value))
    }

    /// What is offered, or all zero.
    fn offer<T: Wire>(value: Option<&T>) -> Self {
        value.map_or(Self::number(0, T::WIDTH), Self::of)
    }

    /// Makes `width` bits from bit `low` on unknown.
    fn blur(mut self, low: u32, width: u32) -> Self {
        let end = self.0.len() - low as usize;
        self.0[end - width as usize..end].fill(Value::X);
        self
    }
}

/// What a signal shows in a cycle.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Shown {
    /// Its bits.
    Bits(Vector),
    /// A name: of what a signal beside it stands for.
    Text(&'static str),
}

/// Hears of every signal, always in the same order.
pub trait Visitor {
    /// A scope begins.
    fn enter(&mut self, scope: &str);
    /// It ends.
    fn leave(&mut self);
    /// A signal in it.
    fn signal(&mut self, name: &str, value: Vector);
    /// A name that one of the RTL's signals stands for.
    fn text(&mut self, name: &str, value: &'static str);
}

/// A signal of type `T`: as in the RTL's waveforms a struct is a scope of its fields, and an array its elements, unless they are single bits.
fn typed<T: Wire>(to: &mut impl Visitor, name: &str, value: &Vector) {
    descend(to, name, T::LAYOUT, &value.0);
}

fn descend(to: &mut impl Visitor, name: &str, layout: Layout, bits: &[Value]) {
    match layout {
        Layout::Struct(fields) => {
            to.enter(name);
            let mut rest = bits;
            for field in fields {
                let (value, behind) = rest.split_at(field.width as usize);
                descend(to, field.name, field.layout, value);
                rest = behind;
            }
            to.leave();
        }
        Layout::Array(elements) if bits.len() > elements as usize => {
            for (k, value) in bits.chunks(bits.len() / elements as usize).rev().enumerate() {
                to.signal(&format!("{name}[{k}]"), Vector(value.to_vec()));
            }
        }
        _ => to.signal(name, Vector(bits.to_vec())),
    }
}

/// Width of a counter from 0 to `most`.
fn counter_width(most: usize) -> u32 {
    usize::BITS - most.leading_zeros()
}

/// All signals of a cycle but the clock.
pub fn walk(unit: &TraversalUnit, inputs: &Inputs, wires: &Wires, to: &mut impl Visitor) {
    let outputs = unit.outputs();
    to.enter("traversal_unit");
    to.signal("rst_ni", Vector::flag(true));
    typed::<SceneConfig>(to, "scene_i", &Vector::of(&unit.scene));
    to.signal("flush_i", Vector::flag(inputs.flush));
    to.signal("busy_o", Vector::flag(outputs.busy));
    to.signal("valid_i", Vector::flag(inputs.ray.is_some()));
    to.signal("ready_o", Vector::flag(outputs.ready));
    typed::<RayIn>(to, "in_i", &Vector::offer(inputs.ray.as_ref()));
    if unit.hardware.secondary {
        typed::<SecondaryIn>(to, "secondary_i", &Vector::offer(inputs.ray.as_ref().map(|_| &inputs.secondary)));
    }
    to.signal("valid_o", Vector::flag(outputs.hit.is_some()));
    to.signal("ready_i", Vector::flag(inputs.hit_ready));
    typed::<HitOut>(to, "out_o", &Vector::register(outputs.hit));
    if unit.hardware.secondary {
        typed::<Corners>(to, "corners_o", &Vector::register(outputs.hit.map(|_| outputs.corners)));
    }
    to.signal("mem_valid_o", Vector::flag(outputs.mem.is_some()));
    to.signal("mem_ready_i", Vector::flag(inputs.mem_ready));
    typed::<MemoryRequest>(to, "mem_o", &Vector::register(outputs.mem));
    to.signal("mem_valid_i", Vector::flag(inputs.answer.is_some()));
    to.signal("mem_ready_o", Vector::flag(true));
    typed::<MemoryAnswer>(to, "mem_i", &Vector::offer(inputs.answer.as_ref()));

    for (k, context) in unit.contexts.iter().enumerate() {
        to.enter(&format!("g_context[{k}]"));
        to.enter("u_context");
        context_signals(context, to);
        to.leave();
        to.leave();
    }

    in_turns(to, "u_setup", &unit.ray_setup, &wires.setup, 6);
    block_waiting(to, &unit.node_address, &wires.fetch, 8 + Epoch::WIDTH, inputs.mem_ready);
    children(to, unit, wires);
    if unit.hardware.has_deciders() {
        block(to, &unit.tree_deciders, &wires.decide, 6);
    }
    fitted(to, &unit.lod_test, &wires.lod, 6);
    block(to, &unit.tessellate, &wires.morph, 6);
    fitted(to, &unit.tri_test, &wires.tri, 8);
    to.enter("u_queue");
    to.signal("len_q", Vector::number(unit.queue.len() as u64, counter_width(4 * unit.contexts.len())));
    to.leave();
    in_turns(to, "u_divide", &unit.hit_divide, &wires.divide, 10);
    comparison(to, unit, wires);
    block(to, &unit.bary_map, &wires.map, 6);
    to.leave();
}

/// Registers of a context, by their names in the RTL.
fn context_signals(c: &Context, to: &mut impl Visitor) {
    to.signal("state_q", Vector::number(c.state as u64, 5));
    to.text("state", c.state.name());
    to.signal("fetch_q", c.fetch.known().map_or(Vector::unknown(2), |fetch| Vector::number(fetch as u64, 2)));
    typed::<Entry>(to, "entry", &Vector::register(c.entry.known()));
    to.signal("tree_q", Vector::register(c.tree.known()));
    to.signal("depth_q", Vector::register(c.depth.known()));
    for (name, points) in [("f", c.f), ("p", c.p), ("g", c.g), ("q", c.q)] {
        for k in 0..3 {
            typed::<Point>(to, &format!("{name}{k}"), &Vector::register(points.known().map(|points| points[k])));
        }
    }
    typed::<lod_test::Out>(to, "lod_q", &Vector::register(c.lod.known()));
    to.signal("want_q", Vector::number(c.want.into(), 2));
    to.signal("waiting_q", Vector::number(c.waiting.into(), 2));
    to.signal("epoch_q", Vector::of(&c.epoch));
    to.signal("owed_q", Vector::of(&c.owed));
    to.signal("behind_q", Vector::of(&c.behind));
    to.signal("rested_q", Vector::flag(c.rested));
    to.signal("visits_q", Vector::register(c.visits_left.known()));
    typed::<child_test::Out>(to, "sorted_q", &Vector::register(c.sorted.known()));
    to.signal("count_q", Vector::register(c.count.known()));
    to.signal("four_q", Vector::register(c.four.known()));
    to.signal("left_q", Vector::register(c.left.known()));
    to.signal("next_q", Vector::register(c.next.known()));
    to.signal("pending_q", Vector::register(c.pending.known()));
    to.enter("u_closest");
    to.signal("known_q", Vector::register(c.closest.known.known()));
    to.signal("t_max_q", Vector::register(c.closest.t_max.known()));
    to.signal("id_q", Vector::register(c.closest.id.known()));
    to.leave();
    to.enter("u_stack");
    to.signal("len_q", Vector::number(c.stack.len() as u64, counter_width(STACK_ENTRIES)));
    to.leave();
}

/// A block whose consumer is always ready.
fn block<B: Block>(to: &mut impl Visitor, pipeline: &Pipeline<B>, link: &Link<B::In>, tag_width: u32)
where
    B::Out: Copy,
{
    block_waiting(to, pipeline, link, tag_width, true);
}

/// A block of which there are two forms, in the one that the unit has.
fn fitted<B: ForSecondary>(to: &mut impl Visitor, block_of: &Fitted<B>, link: &Link<B::In>, tag_width: u32)
where
    B::Out: Copy,
    <B::Primary as Block>::Out: Copy,
{
    match block_of {
        Fitted::Primary(of) => {
            let &Link { ref input, ready, winner } = link;
            let input = input.as_ref().map(|(input, tag)| (B::of_primary(input), *tag));
            block(to, of, &Link { input, ready, winner }, tag_width);
        }
        Fitted::Secondary(of) => block(to, of, link, tag_width),
    }
}

/// Blocks that take turns, of either form, as one that takes items more often: with the operands of both forms, and a consumer that is always ready.
fn in_turns<B: ForSecondary>(to: &mut impl Visitor, scope: &str, block_of: &Fitted<B>, link: &Link<B::In>, tag_width: u32)
where
    B::Out: Copy,
    <B::Primary as Block>::Out: Copy,
{
    let (input, tag) = link.input.as_ref().map(|(input, tag)| (input, *tag)).unzip();
    to.enter(scope);
    to.signal("valid_i", Vector::flag(link.input.is_some()));
    to.signal("ready_o", Vector::flag(link.ready));
    typed::<B::In>(to, "in_i", &Vector::offer(input));
    to.signal("tag_i", Vector::number(tag.map_or(0, u64::from), tag_width));
    let (out, tag) = block_of.offered().unzip();
    to.signal("valid_o", Vector::flag(tag.is_some()));
    typed::<B::Out>(to, "out_o", &Vector::register(out));
    to.signal("tag_o", tag.map_or(Vector::unknown(tag_width), |tag| Vector::number(tag.into(), tag_width)));
    to.leave();
}

fn block_waiting<B: Block>(to: &mut impl Visitor, pipeline: &Pipeline<B>, link: &Link<B::In>, tag_width: u32, consumer_ready: bool)
where
    B::Out: Copy,
{
    let input = Vector::offer(link.input.as_ref().map(|(input, _)| input));
    let tag = Vector::number(link.input.as_ref().map_or(0, |(_, tag)| (*tag).into()), tag_width);
    block_ports(to, pipeline, link, [input, tag], consumer_ready);
}

fn block_ports<B: Block>(to: &mut impl Visitor, pipeline: &Pipeline<B>, link: &Link<B::In>, [input, tag]: [Vector; 2], consumer_ready: bool)
where
    B::Out: Copy,
{
    let tag_width = tag.0.len() as u32; // at most sixteen bits
    to.enter(&format!("u_{}", B::NAME));
    to.signal("valid_i", Vector::flag(link.input.is_some()));
    to.signal("ready_o", Vector::flag(link.ready));
    typed::<B::In>(to, "in_i", &input);
    to.signal("tag_i", tag);
    to.signal("valid_o", Vector::flag(pipeline.offered().is_some()));
    to.signal("ready_i", Vector::flag(consumer_ready));
    // Where nothing is offered the RTL's registers hold anything.
    let (out, tag) = pipeline.offered().unzip();
    typed::<B::Out>(to, "out_o", &Vector::register(out));
    to.signal("tag_o", tag.map_or(Vector::unknown(tag_width), |tag| Vector::number(tag.into(), tag_width)));
    to.leave();
}

/// `child_test` sees the triangle's registers even where it does not use them: before the first tree they are unknown.
fn children(to: &mut impl Visitor, unit: &TraversalUnit, wires: &Wires) {
    const CORNERS: u32 = 3 * Point::WIDTH;
    let link = &wires.child;
    let mut input = Vector::offer(link.input.as_ref().map(|(input, _)| input));
    if let Some(context) = link.winner.map(|k| &unit.contexts[k]) {
        // The last fields: corners and inserted vertices at full resolution, then the same as morphed.
        for (behind, points) in [(3, context.f), (2, context.g), (1, context.p), (0, context.q)] {
            if points.known().is_none() {
                input = input.blur(behind * CORNERS, CORNERS);
            }
        }
    }
    let tag = Vector::number(link.input.as_ref().map_or(0, |(_, tag)| (*tag).into()), 6);
    block_ports(to, &unit.child_test, link, [input, tag], true);
}

/// `hit_select` sees a side and an id that are unknown before the first hit, and the tag of the division whether that is done or not.
fn comparison(to: &mut impl Visitor, unit: &TraversalUnit, wires: &Wires) {
    let link = &wires.select;
    let mut input = Vector::offer(link.input.as_ref().map(|(input, _)| input));
    let mut owner = Vector::unknown(6);
    if let Some((_, tag)) = &link.input {
        owner = Vector::number((*tag).into(), 6);
        if unit.contexts[usize::from(*tag)].closest.id.known().is_none() {
            let behind = |name| hit_select::In::FIELDS.iter().rev().take_while(|field| field.name != name).map(|field| field.width).sum();
            input = input.blur(behind("best_id"), 1 + hit_select::FullId::WIDTH);
        }
    }
    block_ports(to, &unit.hit_select, link, [input, owner], true);
}
