// The C interface of lodray. Printed from the declarations in c/src by scripts/header, and never edited; docs/c-interface.md has a first program.
//
// What is made (`_new`, `_open`, `_generate`, `_begin`) is ended by its own function (`_end`, `_close`), once. Arrays are the caller's: the library reads or writes them during
// the call alone. A function that fails returns NULL or LODRAY_ERROR, has written nothing that counts, and `lodray_last_error` says why.


#ifndef LODRAY_H
#define LODRAY_H

#include <stddef.h>
#include <stdint.h>

// A function did what it was asked for.
#define LODRAY_OK 0

// A function could not do it: `lodray_last_error` says why.
#define LODRAY_ERROR -1

// The largest t of a ray: t_max of a primary one.
#define LODRAY_T_MAX 34359738367

// Words of `scene_config_t`.
#define LODRAY_SCENE_CONFIG_WORDS 22

// Words of `ray_in_t`.
#define LODRAY_RAY_IN_WORDS 10

// Words of `secondary_in_t`.
#define LODRAY_SECONDARY_IN_WORDS 32

// Words of `hit_out_t`.
#define LODRAY_HIT_OUT_WORDS 11

// Words of `memory_request_t`.
#define LODRAY_MEMORY_REQUEST_WORDS 2

// Words of `memory_answer_t`.
#define LODRAY_MEMORY_ANSWER_WORDS 9

// Words of a memory line.
#define LODRAY_LINE_WORDS 8

// The golden traverser of a scene: exact arithmetic, no block of the hardware, slow. It does not change: any number of threads may use it at once.
typedef struct LodrayGolden LodrayGolden;

// A way to find hits in a scene, with what it needs for that. It does not change: any number of threads may use it at once.
typedef struct LodrayMethod LodrayMethod;

// A model with its levels of detail, as the hardware reads it. It does not change: any number of threads may use it at once.
typedef struct LodrayScene LodrayScene;

// The cycle model of `rtl/traversal_unit.sv`: the same at every port in every cycle. One thread at a time may use it.
typedef struct LodrayUnit LodrayUnit;

// What a scene is.
typedef struct LodraySceneInfo {
  // Number of splits N: each base triangle has 4^N finest triangles.
  uint32_t levels;
  // Base triangles.
  uint64_t trees;
  // Centre of the box of all vertices, in world units.
  double centre[3];
  // Bounding radius: half the diagonal of that box, in world units.
  double radius;
  // World length of a unit of the model.
  double unit;
  // World position of the model's origin.
  double offset[3];
} LodraySceneInfo;

// What the unit is told of the scene (`scene_config_t`).
typedef struct LodraySceneConfig {
  // Number of splits N.
  uint32_t levels;
  // Zero bits at the bottom of all coordinates.
  uint32_t zeros;
  // 1: inserted vertices are stored as displacements.
  uint8_t compact;
  // 1: those of last splits have 7 bits a coordinate.
  uint8_t short_splits;
  // Scale of the displacement bounds.
  uint32_t scale_offset;
  // First line of the quad-BVH's nodes.
  uint64_t nodes;
  // First line of the L0 records.
  uint64_t records;
  // First line of the splits.
  uint64_t splits;
  // First line of the vertex data.
  uint64_t vertices;
  // First split of each level from 1 on.
  uint32_t split_starts[8];
  // Where the vertices of each level from 1 on begin.
  uint32_t vertex_starts[9];
  // The most entries that a ray can visit.
  uint32_t visits;
  // Cycles, less one, after which a line may count as late. 20 bits.
  uint32_t answer_limit;
} LodraySceneConfig;

// A ray in the world. Set `t_max` (INFINITY if every distance counts): of a ray that is all 0 nothing counts.
typedef struct LodrayRay {
  // Where it starts, in world units.
  double origin[3];
  // Where it goes: of any length but 0.
  double direction[3];
  // Radius of its cone at the origin, in world units: what a level of detail may leave out. 0 or more.
  double radius;
  // How much the radius grows for each unit of length: the tangent of the cone's half angle. 0 or more.
  double cone;
  // Nothing nearer counts: a distance from the origin in world units.
  double t_min;
  // Nothing farther counts.
  double t_max;
} LodrayRay;

// A ray in the units of the model, as the hardware takes it (`ray_t`).
typedef struct LodrayModelRay {
  // Origin in units.
  int32_t origin[3];
  // Direction: each below 2^30 in magnitude, the length close to 2^30 - 1.
  int32_t direction[3];
  // The cone tolerates floor((offset + l * slope) / 2^shift) units at distance l. 53 bits.
  uint64_t cone_offset;
  // 18 bits.
  uint32_t cone_slope;
  // 6 bits.
  uint32_t cone_shift;
} LodrayModelRay;

// A ray to trace (`ray_in_t`).
typedef struct LodrayRayIn {
  // Any number: it comes back with the hit.
  uint32_t tag;
  // The ray.
  struct LodrayModelRay ray;
} LodrayRayIn;

// What a ray has beyond a primary one (`secondary_in_t`). Of a primary ray all is 0 but `t_max`, which is LODRAY_T_MAX.
typedef struct LodraySecondaryIn {
  // The first t that counts, in steps of 2^-32 of the direction. 35 bits.
  uint64_t t_min;
  // The last t that counts. 35 bits.
  uint64_t t_max;
  // 1: any hit serves, not only the closest.
  uint8_t any;
  // What the exact start has beyond the ray's origin, in steps of 2^-31 units. 31 bits each.
  uint32_t fraction[3];
  // 1: rays before it decide about levels of detail around its start; what follows is theirs.
  uint8_t prior;
  // Base triangle of the last hit. 28 bits.
  uint32_t last;
  // Its corner 0 in units.
  int32_t a0[3];
  // Its corner 1.
  int32_t a1[3];
  // Its corner 2.
  int32_t a2[3];
  // Of its edges (1, 2), (2, 0), (0, 1): 1 where the second ray decides.
  uint8_t by_second[3];
  // The ray that decides inside it, and about its other edges.
  struct LodrayModelRay first;
  // The second ray.
  struct LodrayModelRay second;
} LodraySecondaryIn;

// Where a ray met the surface, in the world.
typedef struct LodrayHit {
  // Distance from the origin in world units; infinite if nothing was met. What follows is -1 then, or no number.
  double t;
  // Triangle of the finest level, of all: tree * 4^N + node there.
  int64_t triangle;
  // Base triangle.
  int32_t tree;
  // Level of the triangle that was met.
  int32_t level;
  // Its node on that level.
  int32_t node;
  // 1 if the front face was met, 0 if the back.
  int32_t front;
  // Point in world space.
  double point[3];
  // Shading normal of length 1.
  float normal[3];
  // Weights of the corners of the triangle that was met.
  float barycentrics[3];
  // Weights of those of the finest triangle.
  float finest_barycentrics[3];
} LodrayHit;

// A ray traced (`hit_out_t`, with its `hit_t`).
typedef struct LodrayHitOut {
  // The ray's tag.
  uint32_t tag;
  // 0, or why the ray ended early: 1 memory, 2 late, 3 image, 4 visits, 5 stack, 6 scene, 7 aborted. All that follows is 0 then.
  uint32_t error;
  // 1: the ray met something. All that follows is 0 if not.
  uint8_t found;
  // 1: it met the front face.
  uint8_t front;
  // Ray parameter in steps of 2^-32 of the direction.
  uint64_t t;
  // Base triangle.
  uint32_t tree;
  // Level of the triangle that was met.
  uint32_t level;
  // Its node on that level.
  uint32_t node;
  // Weight of its corner 0: 2^31 is 1.
  uint32_t b0;
  // Weight of its corner 1.
  uint32_t b1;
  // Weight of its corner 2.
  uint32_t b2;
  // Triangle of the finest level there: number tree * 4^N + full_node of all.
  uint32_t full_node;
  // Weight of the finest triangle's corner 0.
  uint32_t full_b0;
  // Weight of its corner 1.
  uint32_t full_b1;
  // Weight of its corner 2.
  uint32_t full_b2;
} LodrayHitOut;

// What a ray of the world meets by the definition.
typedef struct LodrayGoldenHit {
  // In the world, as `lodray_method_cast` has it.
  struct LodrayHit hit;
  // 1: the ray meets the model's box, so that hardware is given it. 0: all that follows is 0.
  uint8_t entered;
  // The ray as hardware is given it; its tag is its number among the rays.
  struct LodrayRayIn in_i;
  // The range of t that counts, for hardware that takes one.
  struct LodraySecondaryIn secondary_i;
  // What hardware must give.
  struct LodrayHitOut out_o;
} LodrayGoldenHit;

// Sizes of a unit; what is 0 is as in `rtl/lod_pkg.sv`.
typedef struct LodrayHardware {
  // Rays under way, 1 to 64; 0: 4.
  uint32_t contexts;
  // Edge functions that the triangle test evaluates in a cycle, 1 or 3; 0: 1.
  uint32_t edges_per_cycle;
  // 1: rays can start on a surface, count only hits within a range of t, and end at any of them.
  uint8_t secondary;
} LodrayHardware;

// Corners of the triangle that was met, as it was tested, in units (`corners_t`); 0 but for hardware whose rays can start there.
typedef struct LodrayCorners {
  // Corner 0.
  int32_t p0[3];
  // Corner 1.
  int32_t p1[3];
  // Corner 2.
  int32_t p2[3];
} LodrayCorners;

// A memory line that is asked for (`memory_request_t`).
typedef struct LodrayMemoryRequest {
  // Comes back with the line.
  uint8_t tag;
  // This too.
  uint8_t epoch;
  // Which line: byte address / 32.
  uint64_t address;
} LodrayMemoryRequest;

// The output ports in a cycle.
typedef struct LodrayOutputs {
  // 1: a ray would be taken.
  uint8_t ready_o;
  // 1: a hit is offered.
  uint8_t valid_o;
  // The hit; 0 if none is offered.
  struct LodrayHitOut out_o;
  // Comes with the hit.
  struct LodrayCorners corners_o;
  // 1: a memory line is asked for.
  uint8_t mem_valid_o;
  // Which; 0 if none is asked for.
  struct LodrayMemoryRequest mem_o;
  // 1: a ray is under way, or something waits at a port.
  uint8_t busy_o;
} LodrayOutputs;

// A memory line that comes (`memory_answer_t`).
typedef struct LodrayMemoryAnswer {
  // Tag of the request.
  uint8_t tag;
  // Its epoch.
  uint8_t epoch;
  // 1: there is no such line, or it could not be read.
  uint8_t error;
  // Its 32 bytes: word 0 has those of the lowest addresses, each little-endian.
  uint64_t line[4];
} LodrayMemoryAnswer;

// The input ports in a cycle.
typedef struct LodrayInputs {
  // 1: a ray is offered.
  uint8_t valid_i;
  // The ray; not looked at if none is offered.
  struct LodrayRayIn in_i;
  // Comes with the ray; looked at by hardware whose rays can start on a surface alone.
  struct LodraySecondaryIn secondary_i;
  // 1: a hit would be taken.
  uint8_t ready_i;
  // 1: a memory request would be taken.
  uint8_t mem_ready_i;
  // 1: a memory line comes.
  uint8_t mem_valid_i;
  // The line; not looked at if none comes.
  struct LodrayMemoryAnswer mem_i;
  // 1: every ray under way ends.
  uint8_t flush_i;
} LodrayInputs;

#ifdef __cplusplus
extern "C" {
#endif // __cplusplus

// Why the last function failed that failed in this thread; an empty text if none did. It is good until the next one fails in this thread.
const char *lodray_last_error(void);

// The version of the library, such as "0.2.0".
const char *lodray_version(void);

// Opens a scene file, which `lodray build` or `lodray generate` wrote; it is checked. Null if it cannot be opened. End it with `lodray_scene_close`.
//
// Needs: `path` is a text that ends with a zero byte.
struct LodrayScene *lodray_scene_open(const char *path);

// A generated scene: terrain, cloth, sphere, spikes, room, wall, street, pot or drape. `levels` (0 to 10) and `base` (base triangles) have the scene's own
// values if they are negative. Null if there is no such scene. End it with `lodray_scene_close`.
//
// Needs: `name` is a text that ends with a zero byte.
struct LodrayScene *lodray_scene_generate(const char *name, int levels, int base, uint64_t seed);

// Ends a scene; what was made of it stays. Null does nothing.
//
// Needs: The scene is null, or open, and nobody uses it or its image any more.
void lodray_scene_close(struct LodrayScene *scene);

// Writes the scene to a file, which `lodray_scene_open` and the program read.
//
// Needs: The scene is open, `path` a text that ends with a zero byte.
int lodray_scene_save(const struct LodrayScene *scene, const char *path);

// Writes what the scene is to `info`.
//
// Needs: The scene is open, `info` has room for one.
int lodray_scene_info(const struct LodrayScene *scene, struct LodraySceneInfo *info);

// The unit's memory: the scene's file, byte for byte; line k is the 32 bytes from 32 k on. Writes how many bytes there are to `bytes`. The image belongs to the
// scene and is good until that is closed. Null if the scene is.
//
// Needs: The scene is open, `bytes` has room for one.
const uint8_t *lodray_scene_image(const struct LodrayScene *scene, uint64_t *bytes);

// Writes a line of the image to `line`, four words of 64 bits, the first with the bytes of the lowest addresses. 1: there is such a line; 0: there is none, and
// `line` is all 0, which a memory answers with an error.
//
// Needs: The scene is open, `line` has room for four words.
int lodray_scene_line(const struct LodrayScene *scene, uint64_t address, uint64_t *line);

// Writes what a unit is told of the scene whose image (`lodray_scene_image`) lies in its memory from line 0 on.
//
// Needs: The scene is open, `config` has room for one.
int lodray_scene_config(const struct LodrayScene *scene, struct LodraySceneConfig *config);

// Rounds a ray to the integers that the hardware takes, at quality `delta` (0 the base mesh, 1 a pixel's cone, INFINITY full detail), and gives it a tag. 1: it does;
// 0: the ray misses the model's box, so there is nothing to trace, and nothing is written. What counts of `t_min` and `t_max` goes to `secondary`, which may be null: hardware for primary
// rays counts every distance.
//
// Needs: The scene is open, `ray` a ray; `in_i`, and `secondary` if it is not null, have room for one.
int lodray_ray_enter(const struct LodrayScene *scene,
                     const struct LodrayRay *ray,
                     double delta,
                     uint32_t tag,
                     struct LodrayRayIn *in_i,
                     struct LodraySecondaryIn *secondary);

// Writes the rays of a picture of `width` x `height` pixels, row by row from the upper left, each with the cone of its pixel: a camera that looks at the centre of the
// scene from `distance` bounding radii, as `lodray render --distance` does.
//
// Needs: The scene is open, `rays` has room for width * height.
int lodray_camera_rays(const struct LodrayScene *scene,
                       double distance,
                       uint32_t width,
                       uint32_t height,
                       struct LodrayRay *rays);

// The method of this name ("lod", "bvh", ...), with knobs as the program's options have them: "delta=0.5 leaf-layout=block", parted by spaces; null if none is turned.
// Null if there is no such method or knob: the error lists those that there are. End it with `lodray_method_end`; the scene may be closed before.
//
// Needs: The scene is open; `name`, and `knobs` if it is not null, are texts that end with a zero byte.
struct LodrayMethod *lodray_method_new(const struct LodrayScene *scene,
                                       const char *name,
                                       const char *knobs);

// Ends a method. Null does nothing.
//
// Needs: The method is null, or of `lodray_method_new`, and nobody uses it any more.
void lodray_method_end(struct LodrayMethod *method);

// Writes the closest hit of each ray, in their order, found by all threads of the machine.
//
// Needs: The method is alive, there are `count` rays, and `hits` has room for as many.
int lodray_method_cast(const struct LodrayMethod *method, const struct LodrayRay *rays, uint64_t count, struct LodrayHit *hits);

// Writes 1 for each ray that meets anything, 0 for each other: any hit serves, so it takes less time.
//
// Needs: The method is alive, there are `count` rays, and `met` has room for as many.
int lodray_method_cast_any(const struct LodrayMethod *method, const struct LodrayRay *rays, uint64_t count, uint8_t *met);

// The golden traverser of a scene. It unpacks the scene: some twenty bytes for each finest triangle. Null if the scene is. End it with `lodray_golden_end`; the scene may be closed before.
//
// Needs: The scene is open.
struct LodrayGolden *lodray_golden_new(const struct LodrayScene *scene);

// Ends a golden traverser. Null does nothing.
//
// Needs: It is null, or of `lodray_golden_new`, and nobody uses it any more.
void lodray_golden_end(struct LodrayGolden *golden);

// Writes what each ray of the world meets first at quality `delta`, in floats and as hardware must give it, in their order, found by all threads of the machine.
//
// Needs: The traverser is alive, there are `count` rays, and `hits` has room for as many.
int lodray_golden_cast(const struct LodrayGolden *golden,
                       const struct LodrayRay *rays,
                       uint64_t count,
                       double delta,
                       struct LodrayGoldenHit *hits);

// Writes 1 for each ray of the world that meets anything at quality `delta`, 0 for each other.
//
// Needs: The traverser is alive, there are `count` rays, and `met` has room for as many.
int lodray_golden_cast_any(const struct LodrayGolden *golden, const struct LodrayRay *rays, uint64_t count, double delta, uint8_t *met);

// Writes what hardware must give for each of its own rays: `out_o` of `in_i`. Of `secondary_i`, which may be null, the range of t counts; a ray for which any hit serves gets
// its closest, of which only `found` must be the hardware's. Rays that start on a surface (`fraction`, `prior`) are refused.
//
// Needs: The traverser is alive, there are `count` rays, and as many `secondary_i` if it is not null; `out_o` has room for as many.
int lodray_golden_trace(const struct LodrayGolden *golden,
                        const struct LodrayRayIn *in_i,
                        const struct LodraySecondaryIn *secondary_i,
                        uint64_t count,
                        struct LodrayHitOut *out_o);

// A unit behind its reset, for the scene of `config`; `hardware` is null for that of `rtl/lod_pkg.sv`. Null if there is no such unit. End it with `lodray_unit_end`.
//
// Needs: `config`, and `hardware` if it is not null, are such structs.
struct LodrayUnit *lodray_unit_begin(const struct LodraySceneConfig *config,
                                     const struct LodrayHardware *hardware);

// Ends a unit. Null does nothing.
//
// Needs: The unit is null, or of `lodray_unit_begin`, and nobody uses it any more.
void lodray_unit_end(struct LodrayUnit *unit);

// Writes the output ports of this cycle. They come from registers: inputs of the same cycle do not change them.
//
// Needs: The unit is alive, `outputs` has room for one.
int lodray_unit_outputs(const struct LodrayUnit *unit, struct LodrayOutputs *outputs);

// The rising edge that ends this cycle, with these inputs. What is offered must stand still until it is taken: a ray at `valid_i` and `ready_o`, a hit at `valid_o` and
// `ready_i`, a request at `mem_valid_o` and `mem_ready_i`, all in the same cycle. Nothing has happened if it fails.
//
// Needs: The unit is alive, `inputs` such a struct.
int lodray_unit_step(struct LodrayUnit *unit,
                     const struct LodrayInputs *inputs);

// The rising edge that ends this cycle, with `rst_ni` low.
//
// Needs: The unit is alive.
int lodray_unit_reset(struct LodrayUnit *unit);

// Another scene from this cycle on: only while `busy_o` is 0.
//
// Needs: The unit is alive, `config` such a struct.
int lodray_unit_scene(struct LodrayUnit *unit, const struct LodraySceneConfig *config);

// Writes the bits of `scene_i` for the scene whose image lies in memory from line 0 on.
//
// Needs: The scene is open, `bits` has room for LODRAY_SCENE_CONFIG_WORDS.
int lodray_scene_config_bits(const struct LodrayScene *scene, uint32_t *bits);

// Writes the bits of a line of the scene's image. 1: there is such a line; 0: there is none, and all bits are 0.
//
// Needs: The scene is open, `bits` has room for LODRAY_LINE_WORDS.
int lodray_line_bits(const struct LodrayScene *scene, uint64_t address, uint32_t *bits);

// Writes the bits of `in_i` for pixel (x, y) of the camera of `lodray_camera_rays`; the ray's tag is y * width + x. 1: it does; 0: the ray misses the model's box, and all bits are 0.
//
// Needs: The scene is open, `bits` has room for LODRAY_RAY_IN_WORDS.
int lodray_camera_ray_bits(const struct LodrayScene *scene,
                           double distance,
                           double delta,
                           uint32_t width,
                           uint32_t height,
                           uint32_t x,
                           uint32_t y,
                           uint32_t *bits);

// Writes the bits of `out_o` that hardware must give for the primary ray of these bits of `in_i`.
//
// Needs: The traverser is alive, `in_i` has LODRAY_RAY_IN_WORDS, `out_o` room for LODRAY_HIT_OUT_WORDS.
int lodray_golden_trace_bits(const struct LodrayGolden *golden, const uint32_t *in_i, uint32_t *out_o);

// Writes the bits of a ray.
//
// Needs: `ray` is such a struct, `bits` has room for LODRAY_RAY_IN_WORDS.
int lodray_ray_in_to_bits(const struct LodrayRayIn *ray, uint32_t *bits);

// Reads a ray from its bits.
//
// Needs: `bits` has LODRAY_RAY_IN_WORDS, `ray` room for one.
int lodray_ray_in_from_bits(const uint32_t *bits, struct LodrayRayIn *ray);

// Writes the bits of what a ray has beyond a primary one.
//
// Needs: `secondary` is such a struct, `bits` has room for LODRAY_SECONDARY_IN_WORDS.
int lodray_secondary_in_to_bits(const struct LodraySecondaryIn *secondary, uint32_t *bits);

// Writes the bits of a hit.
//
// Needs: `hit` is such a struct, `bits` has room for LODRAY_HIT_OUT_WORDS.
int lodray_hit_out_to_bits(const struct LodrayHitOut *hit, uint32_t *bits);

// Reads a hit from its bits.
//
// Needs: `bits` has LODRAY_HIT_OUT_WORDS, `hit` room for one.
int lodray_hit_out_from_bits(const uint32_t *bits, struct LodrayHitOut *hit);

// Reads a memory request from its bits.
//
// Needs: `bits` has LODRAY_MEMORY_REQUEST_WORDS, `request` room for one.
int lodray_memory_request_from_bits(const uint32_t *bits, struct LodrayMemoryRequest *request);

// Writes the bits of a memory answer.
//
// Needs: `answer` is such a struct, `bits` has room for LODRAY_MEMORY_ANSWER_WORDS.
int lodray_memory_answer_to_bits(const struct LodrayMemoryAnswer *answer, uint32_t *bits);

#ifdef __cplusplus
}  // extern "C"
#endif  // __cplusplus

#endif  /* LODRAY_H */
