//! The ports of the traversal unit as structs, field for field those of `lod_pkg` in SystemVerilog (docs/integration.md says what each means).

use crate::error::Refused;
use crate::widths::{three, unsigned, vector};
use lodray::hardware::ports::{Corners, HitOut, MemoryAnswer, MemoryRequest, RayIn, SceneConfig, SecondaryIn};
use lodray::method::Hit;
use lodray::num::{BoundScale, Cone, Ray, U};
use lodray::sim::unit::{Inputs, Outputs};

/// A ray in the units of the model, as the hardware takes it (`ray_t`).
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct LodrayModelRay {
    /// Origin in units.
    pub origin: [i32; 3],
    /// Direction: each below 2^30 in magnitude, the length close to 2^30 - 1.
    pub direction: [i32; 3],
    /// The cone tolerates floor((offset + l * slope) / 2^shift) units at distance l. 53 bits.
    pub cone_offset: u64,
    /// 18 bits.
    pub cone_slope: u32,
    /// 6 bits.
    pub cone_shift: u32,
}

/// A ray to trace (`ray_in_t`).
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct LodrayRayIn {
    /// Any number: it comes back with the hit.
    pub tag: u32,
    /// The ray.
    pub ray: LodrayModelRay,
}

/// What a ray has beyond a primary one (`secondary_in_t`). Of a primary ray all is 0 but `t_max`, which is LODRAY_T_MAX.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct LodraySecondaryIn {
    /// The first t that counts, in steps of 2^-32 of the direction. 35 bits.
    pub t_min: u64,
    /// The last t that counts. 35 bits.
    pub t_max: u64,
    /// 1: any hit serves, not only the closest.
    pub any: u8,
    /// What the exact start has beyond the ray's origin, in steps of 2^-31 units. 31 bits each.
    pub fraction: [u32; 3],
    /// 1: rays before it decide about levels of detail around its start; what follows is theirs.
    pub prior: u8,
    /// Base triangle of the last hit. 28 bits.
    pub last: u32,
    /// Its corner 0 in units.
    pub a0: [i32; 3],
    /// Its corner 1.
    pub a1: [i32; 3],
    /// Its corner 2.
    pub a2: [i32; 3],
    /// Of its edges (1, 2), (2, 0), (0, 1): 1 where the second ray decides.
    pub by_second: [u8; 3],
    /// The ray that decides inside it, and about its other edges.
    pub first: LodrayModelRay,
    /// The second ray.
    pub second: LodrayModelRay,
}

/// A ray traced (`hit_out_t`, with its `hit_t`).
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct LodrayHitOut {
    /// The ray's tag.
    pub tag: u32,
    /// 0, or why the ray ended early: 1 memory, 2 late, 3 image, 4 visits, 5 stack, 6 scene, 7 aborted. All that follows is 0 then.
    pub error: u32,
    /// 1: the ray met something. All that follows is 0 if not.
    pub found: u8,
    /// 1: it met the front face.
    pub front: u8,
    /// Ray parameter in steps of 2^-32 of the direction.
    pub t: u64,
    /// Base triangle.
    pub tree: u32,
    /// Level of the triangle that was met.
    pub level: u32,
    /// Its node on that level.
    pub node: u32,
    /// Weight of its corner 0: 2^31 is 1.
    pub b0: u32,
    /// Weight of its corner 1.
    pub b1: u32,
    /// Weight of its corner 2.
    pub b2: u32,
    /// Triangle of the finest level there: number tree * 4^N + full_node of all.
    pub full_node: u32,
    /// Weight of the finest triangle's corner 0.
    pub full_b0: u32,
    /// Weight of its corner 1.
    pub full_b1: u32,
    /// Weight of its corner 2.
    pub full_b2: u32,
}

/// Corners of the triangle that was met, as it was tested, in units (`corners_t`); 0 but for hardware whose rays can start there.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct LodrayCorners {
    /// Corner 0.
    pub p0: [i32; 3],
    /// Corner 1.
    pub p1: [i32; 3],
    /// Corner 2.
    pub p2: [i32; 3],
}

/// A memory line that is asked for (`memory_request_t`).
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct LodrayMemoryRequest {
    /// Comes back with the line.
    pub tag: u8,
    /// This too.
    pub epoch: u8,
    /// Which line: byte address / 32.
    pub address: u64,
}

/// A memory line that comes (`memory_answer_t`).
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct LodrayMemoryAnswer {
    /// Tag of the request.
    pub tag: u8,
    /// Its epoch.
    pub epoch: u8,
    /// 1: there is no such line, or it could not be read.
    pub error: u8,
    /// Its 32 bytes: word 0 has those of the lowest addresses, each little-endian.
    pub line: [u64; 4],
}

/// What the unit is told of the scene (`scene_config_t`).
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct LodraySceneConfig {
    /// Number of splits N.
    pub levels: u32,
    /// Zero bits at the bottom of all coordinates.
    pub zeros: u32,
    /// 1: inserted vertices are stored as displacements.
    pub compact: u8,
    /// 1: those of last splits have 7 bits a coordinate.
    pub short_splits: u8,
    /// Scale of the displacement bounds.
    pub scale_offset: u32,
    /// First line of the quad-BVH's nodes.
    pub nodes: u64,
    /// First line of the L0 records.
    pub records: u64,
    /// First line of the splits.
    pub splits: u64,
    /// First line of the vertex data.
    pub vertices: u64,
    /// First split of each level from 1 on.
    pub split_starts: [u32; 8],
    /// Where the vertices of each level from 1 on begin.
    pub vertex_starts: [u32; 9],
    /// The most entries that a ray can visit.
    pub visits: u32,
    /// Cycles, less one, after which a line may count as late. 20 bits.
    pub answer_limit: u32,
}

/// The input ports in a cycle.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct LodrayInputs {
    /// 1: a ray is offered.
    pub valid_i: u8,
    /// The ray; not looked at if none is offered.
    pub in_i: LodrayRayIn,
    /// Comes with the ray; looked at by hardware whose rays can start on a surface alone.
    pub secondary_i: LodraySecondaryIn,
    /// 1: a hit would be taken.
    pub ready_i: u8,
    /// 1: a memory request would be taken.
    pub mem_ready_i: u8,
    /// 1: a memory line comes.
    pub mem_valid_i: u8,
    /// The line; not looked at if none comes.
    pub mem_i: LodrayMemoryAnswer,
    /// 1: every ray under way ends.
    pub flush_i: u8,
}

/// The output ports in a cycle.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct LodrayOutputs {
    /// 1: a ray would be taken.
    pub ready_o: u8,
    /// 1: a hit is offered.
    pub valid_o: u8,
    /// The hit; 0 if none is offered.
    pub out_o: LodrayHitOut,
    /// Comes with the hit.
    pub corners_o: LodrayCorners,
    /// 1: a memory line is asked for.
    pub mem_valid_o: u8,
    /// Which; 0 if none is asked for.
    pub mem_o: LodrayMemoryRequest,
    /// 1: a ray is under way, or something waits at a port.
    pub busy_o: u8,
}

/// The largest t of a ray: t_max of a primary one.
pub const LODRAY_T_MAX: u64 = 34359738367;
const _: () = assert!(LODRAY_T_MAX == lodray::num::RayT::MAX.get());

impl LodrayModelRay {
    pub(crate) fn wire(&self, name: &str) -> Result<Ray, Refused> {
        let cone = Cone {
            offset: unsigned(&format!("{name}.cone_offset"), self.cone_offset)?,
            slope: unsigned(&format!("{name}.cone_slope"), self.cone_slope.into())?,
            shift: unsigned(&format!("{name}.cone_shift"), self.cone_shift.into())?,
        };
        let origin = vector(&format!("{name}.origin"), self.origin)?;
        Ok(Ray { origin, direction: vector(&format!("{name}.direction"), self.direction)?, cone })
    }

    pub(crate) fn of(ray: &Ray) -> Self {
        let Ray { origin, direction, cone } = *ray;
        Self {
            origin: three(origin),
            direction: three(direction),
            cone_offset: cone.offset.get(),
            cone_slope: narrow(cone.slope),
            cone_shift: narrow(cone.shift),
        }
    }
}

impl LodrayRayIn {
    pub(crate) fn wire(&self, name: &str) -> Result<RayIn, Refused> {
        Ok(RayIn { tag: U::new(self.tag.into()), ray: self.ray.wire(&format!("{name}.ray"))? })
    }

    pub(crate) fn of(ray: &RayIn) -> Self {
        Self { tag: narrow(ray.tag), ray: LodrayModelRay::of(&ray.ray) }
    }
}

impl LodraySecondaryIn {
    pub(crate) fn wire(&self, name: &str) -> Result<SecondaryIn, Refused> {
        let field = |field: &str| format!("{name}.{field}");
        let [x, y, z] = self.fraction.map(|f| unsigned(&field("fraction"), f.into()));
        Ok(SecondaryIn {
            t_min: unsigned(&field("t_min"), self.t_min)?,
            t_max: unsigned(&field("t_max"), self.t_max)?,
            any: self.any != 0,
            fraction: [x?, y?, z?],
            prior: self.prior != 0,
            last: unsigned(&field("last"), self.last.into())?,
            a0: vector(&field("a0"), self.a0)?,
            a1: vector(&field("a1"), self.a1)?,
            a2: vector(&field("a2"), self.a2)?,
            by_second: self.by_second.map(|by| by != 0),
            first: self.first.wire(&field("first"))?,
            second: self.second.wire(&field("second"))?,
        })
    }

    /// That of a primary ray.
    pub(crate) fn primary() -> Self {
        Self { t_max: LODRAY_T_MAX, ..Self::default() }
    }
}

impl LodrayHitOut {
    pub(crate) fn of(out: &HitOut) -> Self {
        let HitOut { tag, error, found, hit } = *out;
        Self {
            tag: narrow(tag),
            error: narrow(error),
            found: found.into(),
            front: hit.front.into(),
            t: hit.t.get(),
            tree: narrow(hit.tree),
            level: narrow(hit.level),
            node: narrow(hit.node),
            b0: narrow(hit.b0),
            b1: narrow(hit.b1),
            b2: narrow(hit.b2),
            full_node: narrow(hit.full_node),
            full_b0: narrow(hit.full_b0),
            full_b1: narrow(hit.full_b1),
            full_b2: narrow(hit.full_b2),
        }
    }

    pub(crate) fn wire(&self, name: &str) -> Result<HitOut, Refused> {
        let field = |field: &str| format!("{name}.{field}");
        let hit = Hit {
            t: unsigned(&field("t"), self.t)?,
            front: self.front != 0,
            tree: unsigned(&field("tree"), self.tree.into())?,
            level: unsigned(&field("level"), self.level.into())?,
            node: unsigned(&field("node"), self.node.into())?,
            b0: U::new(self.b0.into()),
            b1: U::new(self.b1.into()),
            b2: U::new(self.b2.into()),
            full_node: unsigned(&field("full_node"), self.full_node.into())?,
            full_b0: U::new(self.full_b0.into()),
            full_b1: U::new(self.full_b1.into()),
            full_b2: U::new(self.full_b2.into()),
        };
        let error = unsigned(&field("error"), self.error.into())?;
        Ok(HitOut { tag: U::new(self.tag.into()), error, found: self.found != 0, hit })
    }
}

impl LodrayCorners {
    fn of(corners: &Corners) -> Self {
        Self { p0: three(corners.p0), p1: three(corners.p1), p2: three(corners.p2) }
    }
}

impl LodrayMemoryRequest {
    pub(crate) fn of(request: &MemoryRequest) -> Self {
        // Eight bits each.
        let (tag, epoch) = (request.tag.get() as u8, request.epoch.get() as u8);
        Self { tag, epoch, address: request.address.get() }
    }
}

impl LodrayMemoryAnswer {
    pub(crate) fn wire(&self) -> MemoryAnswer {
        let line = self.line.map(U::new);
        MemoryAnswer { tag: U::new(self.tag.into()), epoch: U::new(self.epoch.into()), error: self.error != 0, line }
    }
}

impl LodraySceneConfig {
    pub(crate) fn of(config: &SceneConfig) -> Self {
        Self {
            levels: narrow(config.levels),
            zeros: narrow(config.zeros),
            compact: config.compact.into(),
            short_splits: config.short_splits.into(),
            scale_offset: narrow(config.scale.offset),
            nodes: config.nodes.get(),
            records: config.records.get(),
            splits: config.splits.get(),
            vertices: config.vertices.get(),
            split_starts: config.split_starts.map(narrow),
            vertex_starts: config.vertex_starts.map(narrow),
            visits: narrow(config.visits),
            answer_limit: narrow(config.answer_limit),
        }
    }

    pub(crate) fn wire(&self, name: &str) -> Result<SceneConfig, Refused> {
        let field = |field: &str| format!("{name}.{field}");
        let address = |of: &str, line| unsigned(&field(of), line);
        let mut config = SceneConfig {
            levels: unsigned(&field("levels"), self.levels.into())?,
            zeros: unsigned(&field("zeros"), self.zeros.into())?,
            compact: self.compact != 0,
            short_splits: self.short_splits != 0,
            scale: BoundScale { offset: unsigned(&field("scale_offset"), self.scale_offset.into())? },
            nodes: address("nodes", self.nodes)?,
            records: address("records", self.records)?,
            splits: address("splits", self.splits)?,
            vertices: address("vertices", self.vertices)?,
            visits: U::new(self.visits.into()),
            answer_limit: unsigned(&field("answer_limit"), self.answer_limit.into())?,
            ..SceneConfig::default()
        };
        for (start, &given) in config.split_starts.iter_mut().zip(&self.split_starts) {
            *start = unsigned(&field("split_starts"), given.into())?;
        }
        for (start, &given) in config.vertex_starts.iter_mut().zip(&self.vertex_starts) {
            *start = unsigned(&field("vertex_starts"), given.into())?;
        }
        Ok(config)
    }
}

impl LodrayInputs {
    pub(crate) fn wire(&self, is_secondary: bool) -> Result<Inputs, Refused> {
        let is_offered = self.valid_i != 0;
        let secondary = if is_offered && is_secondary { self.secondary_i.wire("secondary_i")? } else { SecondaryIn::default() };
        Ok(Inputs {
            ray: if is_offered { Some(self.in_i.wire("in_i")?) } else { None },
            secondary,
            hit_ready: self.ready_i != 0,
            mem_ready: self.mem_ready_i != 0,
            answer: (self.mem_valid_i != 0).then(|| self.mem_i.wire()),
            flush: self.flush_i != 0,
        })
    }
}

impl LodrayOutputs {
    pub(crate) fn of(outputs: &Outputs) -> Self {
        Self {
            ready_o: outputs.ready.into(),
            valid_o: outputs.hit.is_some().into(),
            out_o: outputs.hit.map_or(LodrayHitOut::default(), |hit| LodrayHitOut::of(&hit)),
            corners_o: LodrayCorners::of(&outputs.corners),
            mem_valid_o: outputs.mem.is_some().into(),
            mem_o: outputs.mem.map_or(LodrayMemoryRequest::default(), |request| LodrayMemoryRequest::of(&request)),
            busy_o: outputs.busy.into(),
        }
    }
}

/// A number of at most 32 bits.
fn narrow<const W: u32>(of: U<W>) -> u32 {
    const { assert!(W <= 32) };
    of.get() as u32
}
