`default_nettype none

/// Every width, size and packed struct of the design. Printed by `Hardware::package` in Rust (src/hardware) and never edited: `scripts/package` writes it again.
///
/// A struct `foo::In` in Rust is `foo_in_t` here, field for field, the first field most significant; `[T; N]` is `logic [N-1:0][W-1:0]`, element
/// 0 least significant (arrays of structs are kept flat, because free synthesis tools mistake them). `tests/mirror` reads it back and compares the two.
package lod_pkg;

  // This hardware: `Hardware` in Rust, which prints this file. All that follows from these is made smaller or larger with them.
  localparam int unsigned MAX_LEVELS = 10;          // splits N of a model
  localparam int unsigned STORED_LEVELS = 10;       // of a tree at most: below, there are triangles
  localparam int unsigned MAX_BVH_DEPTH = 24;       // quad-BVH nodes on a path from the root to a tree
  localparam int unsigned CONTEXTS = 4;             // rays under way in a traversal unit, if its parameter does not say otherwise
  localparam int unsigned CONTEXT_W = 6;            // bits of a context's number
  localparam int unsigned EDGES_PER_CYCLE = 1;      // edge functions that tri_test evaluates in a cycle, if its parameter does not say otherwise
  localparam int unsigned LOD_EDGES_PER_CYCLE = 1;  // edges of a triangle that lod_test takes in a cycle, likewise
  localparam int unsigned DIVIDE_BITS = 3;          // bits of a quotient that hit_divide finds in a cycle, if its parameter does not say otherwise
  localparam int unsigned SETUP_BITS = 3;           // of each reciprocal that ray_setup finds, likewise
  localparam int unsigned SETUP_COPIES = 1;         // ray_setup blocks that take turns
  localparam int unsigned DIVIDE_COPIES = 1;        // hit_divide blocks, likewise
  localparam int unsigned BOXES_PER_CYCLE = 2;      // boxes that child_test tests in a cycle, if its parameter does not say otherwise
  localparam int unsigned LINK_REGISTERS = 0;       // between contexts and blocks: 0, 1 for operands, or 2 for results and answers of memory too
  localparam int unsigned INDEX_W = 28;             // of the number of a quad-BVH node, of a tree and its place, and of a node, where it is kept
  localparam int unsigned LOD_TEST = 1;             // levels of detail are chosen, and triangles morphed: 1, or 0 if all rays are of full detail or of none
  localparam int unsigned START_RADIUS = 1;         // cones can have a radius where their rays start
  localparam int unsigned HIT_MAPPING = 1;          // hits can be above the finest level
  localparam int unsigned COMPACT_VERTICES = 1;     // inserted vertices can be displacements, and L0 records of one line
  localparam int unsigned EXACT_VERTICES = 1;       // they can be stored as they are, and L0 records have two lines
  localparam int unsigned COORDINATE_ZEROS = 0;     // zero bits at the bottom of every coordinate, which it leaves out
  localparam int unsigned DIRECTION_ZEROS = 0;      // of every component of a direction
  localparam int unsigned SECONDARY = 0;            // rays can start on a surface, count hits of a range of t only, and end at any of them

  // Widths (docs/numbers.md).
  localparam int unsigned RAY_T_W = 35;                                         // t in steps of 2^-32
  localparam int unsigned T_NEAR_W = 17;                                        // t_near in steps of 2^16 units
  localparam int unsigned BARY_W = 32;                                          // 2^31 = 1
  localparam int unsigned EDGE_STATE_W = 9;                                     // 256 = 1
  localparam int unsigned DISTANCE_W = 34;                                      // l = (p - x).d / 2^30, signed: 64 - 30 bits
  localparam int unsigned TOLERANCE_W = 34;                                     // D, clamped to this width
  localparam int unsigned BOUND_CODE_W = 8;
  localparam int unsigned BOUND_W = 33;                                         // |q - m| < 2^32.8
  localparam int unsigned LINE_ADDRESS_W = 36;                                  // 2 TiB of 32-byte lines
  localparam int unsigned EPOCH_W = 8;                                          // of the number of a context's ray, which its lines come back with
  localparam int unsigned BEHIND_W = 4;                                         // of the number of rays that a context takes while it is owed lines, and of ticks in an age
  localparam int unsigned OWED_W = 6;                                           // of the number of lines that a context has asked for and that have not come
  localparam int unsigned ANSWER_LIMIT_W = 20;                                  // of the cycles after which a line may be late
  localparam int unsigned NODE_INDEX_W = 20;                                    // of a node at the ports: 4^10 nodes on the last level that there can be
  localparam int unsigned FULL_ID_W = 48;                                       // 28 bits of tree, 2 of each of ten levels
  localparam int unsigned COORDINATE_W = 32;                                    // a coordinate without the bits that are always 0
  localparam int unsigned COMPONENT_W = 31;                                     // a component of a direction, likewise
  localparam int unsigned RELATIVE_W = 33;                                      // difference of two coordinates
  localparam int unsigned NORMAL_W = 66;                                        // component of p x q: two products of two differences
  localparam int unsigned EDGE_FUNCTION_W = 96;                                 // |p x q| |d| < 2^96
  localparam int unsigned EDGE_ZEROS = 2 * COORDINATE_ZEROS + DIRECTION_ZEROS;  // at the bottom of an edge function
  localparam int unsigned SIGNED_EDGE_W = EDGE_FUNCTION_W + 1 - EDGE_ZEROS;
  localparam int unsigned T_NUMERATOR_W = 99;                                   // |a| |b| |c| < 2^98.4
  localparam int unsigned SIGNED_T_NUMERATOR_W = T_NUMERATOR_W + 1 - 3 * COORDINATE_ZEROS;
  localparam int unsigned DECIDER_W = 2;                                        // of who decides about an edge: 0 the ray itself, 1 and 2 its viewers
  localparam int unsigned FRACTION_W = 31;                                      // of the fraction of an exact start, in each coordinate
  localparam int unsigned WHOLE_RELATIVE_W = 33;                                // difference of two coordinates with all their bits
  localparam int unsigned WHOLE_NORMAL_W = 66;                                  // component of p x q of such
  localparam int unsigned EXACT_NORMAL_W = 98;                                  // of an exact start: |p x q| < 2^65.6 in steps of 2^-31
  localparam int unsigned EXACT_EDGE_W = EDGE_FUNCTION_W + FRACTION_W + 1;      // its product with d, likewise
  localparam int unsigned EXACT_T_W = T_NUMERATOR_W + FRACTION_W + 1;           // and a.(b x c)

  // Sizes.
  localparam int unsigned COORD_LIMIT = 2147352576;  // of a coordinate in magnitude
  localparam int unsigned MAX_BOUND_OFFSET = 272;    // of a scale of displacement bounds
  localparam int unsigned SCENE_LEVELS = 10;         // the most splits N of a scene: where hits cannot be mapped, those that are stored
  localparam int unsigned MAX_CONTEXTS = 64;         // that CONTEXT_W can number
  localparam int unsigned STACK_ENTRIES = 103;       // 3 (MAX_BVH_DEPTH + STORED_LEVELS) + 1: each level leaves at most three siblings waiting
  localparam int unsigned KEPT_ENTRY_W = 75;         // of a stack entry, where it is kept
  localparam int unsigned SPLIT_TRIANGLES = 9;       // of a context: one of each level that splits into nodes
  localparam int unsigned NODE_W = 20;               // of a node within its level: two bits of each level
  localparam int unsigned KEPT_NODE_W = 20;          // where it is kept: two bits of each stored level

  // Scales.
  localparam int unsigned BOX_SHIFT = 16;
  localparam int unsigned T_NEAR_TO_T_SHIFT = 18;
  localparam int unsigned S_ONE = 256;

  // Cycles from an input taken to its output offered, and (where not 1) from one input taken to the next: `Block::timing` in Rust.
  localparam int unsigned BARY_MAP_LATENCY = 10;
  localparam int unsigned BOUND_DECODE_LATENCY = 3;
  localparam int unsigned BOX_DECODE_LATENCY = 2;
  localparam int unsigned BOX_DECODE8_LATENCY = 2;
  localparam int unsigned BOX_TEST_LATENCY = 8;
  localparam int unsigned BOX_TEST32_LATENCY = 9;
  localparam int unsigned CHILD_BOXES_LATENCY = 3;
  localparam int unsigned CHILD_SORT_LATENCY = 3;
  localparam int unsigned CHILD_SORT6_LATENCY = 5;
  localparam int unsigned HIT_DIVIDE_LATENCY = 13;
  localparam int unsigned HIT_DIVIDE_INTERVAL = 13;
  localparam int unsigned HIT_SELECT_LATENCY = 3;
  localparam int unsigned LOD_TEST_LATENCY = 30;
  localparam int unsigned LOD_TEST_INTERVAL = 3;
  localparam int unsigned LOD_TEST_1_LATENCY = 30;     // of the form with one edge a cycle
  localparam int unsigned LOD_TEST_1_INTERVAL = 3;
  localparam int unsigned LOD_TEST_3_LATENCY = 25;     // of the form with three
  localparam int unsigned LOD_TEST_BY_LATENCY = 27;
  localparam int unsigned LOD_TEST_BY_INTERVAL = 3;
  localparam int unsigned LOD_TEST_BY_1_LATENCY = 27;  // of the form with one edge a cycle
  localparam int unsigned LOD_TEST_BY_1_INTERVAL = 3;
  localparam int unsigned LOD_TEST_BY_3_LATENCY = 25;  // of the form with three
  localparam int unsigned NODE_ADDRESS_LATENCY = 2;
  localparam int unsigned NODE_DECIDERS_LATENCY = 1;
  localparam int unsigned PRISM_FRAME_LATENCY = 6;
  localparam int unsigned PRISM_TEST_LATENCY = 14;
  localparam int unsigned RAY_SETUP_LATENCY = 11;
  localparam int unsigned RAY_SETUP_INTERVAL = 11;
  localparam int unsigned START_DIVIDE_LATENCY = 13;
  localparam int unsigned START_DIVIDE_INTERVAL = 13;
  localparam int unsigned START_SETUP_LATENCY = 11;
  localparam int unsigned START_SETUP_INTERVAL = 11;
  localparam int unsigned START_TEST_LATENCY = 22;
  localparam int unsigned START_TEST_INTERVAL = 3;
  localparam int unsigned START_TEST_1_LATENCY = 22;   // of the form with one edge a cycle
  localparam int unsigned START_TEST_1_INTERVAL = 3;
  localparam int unsigned START_TEST_3_LATENCY = 21;   // of the form with three
  localparam int unsigned TESSELLATE_LATENCY = 7;
  localparam int unsigned TREE_DECIDERS_LATENCY = 2;
  localparam int unsigned TRI_TEST_LATENCY = 20;
  localparam int unsigned TRI_TEST_INTERVAL = 3;
  localparam int unsigned TRI_TEST_1_LATENCY = 20;     // of the form with one edge a cycle
  localparam int unsigned TRI_TEST_1_INTERVAL = 3;
  localparam int unsigned TRI_TEST_3_LATENCY = 18;     // of the form with three
  localparam int unsigned CHILD_TEST_LATENCY = 15;
  localparam int unsigned CHILD_TEST_INTERVAL = 2;
  localparam int unsigned CHILD_PRISMS_LATENCY = 26;
  localparam int unsigned CHILD_PRISMS_INTERVAL = 4;
  localparam int unsigned SETUP_INTERVAL = 11;         // of all copies of ray_setup or start_setup together
  localparam int unsigned DIVIDE_INTERVAL = 13;        // of all copies of hit_divide or start_divide together

  // Cycles of parts of blocks.
  localparam int unsigned ENTRY_DISTANCE_LATENCY = 5;  // of the box tests
  localparam int unsigned EDGE_PRODUCT_STAGES = 2;     // registers of the products of a cross product
  localparam int unsigned EDGE_DOT_STAGES = 2;         // of those with a direction
  localparam int unsigned T_DOT_STAGES = 2;            // of those of t, which take as long
  localparam int unsigned EDGE_FUNCTION_LATENCY = 14;  // of tri_test
  localparam int unsigned TRI_DECIDE_LATENCY = 3;      // of tri_test and start_test
  localparam int unsigned START_PRODUCT_STAGES = 2;    // registers of the products of exact numbers
  localparam int unsigned START_EDGE_LATENCY = 16;     // of start_test
  localparam int unsigned CONE_TOLERANCE_LATENCY = 7;  // of lod_test
  localparam int unsigned EDGE_OPENING_LATENCY = 9;    // of lod_test
  localparam int unsigned LOD_EDGE_BY_LATENCY = 23;    // of lod_test_by
  localparam int unsigned MULTIPLIER_LIMB_W = 17;      // a factor of multiplier is cut into limbs of so many bits, the highest signed with up to one more

  // Bit k: stage k of the box tests is a `pipe_skid`. Two registers follow it.
  localparam logic [63:0] BOX_TEST_SKIDS = 64'd1 << (BOX_TEST_LATENCY - 3);
  localparam logic [63:0] BOX_TEST32_SKIDS = 64'd1 << (BOX_TEST32_LATENCY - 3);

  // Limbs of a factor of `multiplier`.
  function automatic int unsigned multiplier_limbs(input int unsigned w);
    multiplier_limbs = w <= MULTIPLIER_LIMB_W + 1 ? 1 : (w - 1 + MULTIPLIER_LIMB_W - 1) / MULTIPLIER_LIMB_W;
  endfunction

  // Cycles of `multiplier`: the limb products, then one tree level each.
  function automatic int unsigned multiplier_latency(input int unsigned a_w, input int unsigned b_w);
    multiplier_latency = 1 + $clog2(multiplier_limbs(a_w)) + $clog2(multiplier_limbs(b_w));
  endfunction

  // Cycles of `dot_product`: factors, products, two sums; of `cross_product`: factors, products in EDGE_PRODUCT_STAGES, differences.
  function automatic int unsigned dot_product_latency(input int unsigned a_w, input int unsigned b_w);
    dot_product_latency = 1 + multiplier_latency(a_w, b_w) + 2;
  endfunction
  function automatic int unsigned cross_product_latency(input int unsigned w);
    cross_product_latency = 1 + EDGE_PRODUCT_STAGES - 1 + multiplier_latency(w, w) + 1;
  endfunction

  // Vertex position or ray origin in units.
  typedef struct packed {
    logic signed [31:0] x;
    logic signed [31:0] y;
    logic signed [31:0] z;
  } point_t;
  localparam int unsigned POINT_W = 3 * 32;

  // Ray direction: each component below 2^30 in magnitude.
  typedef struct packed {
    logic signed [30:0] x;
    logic signed [30:0] y;
    logic signed [30:0] z;
  } direction_t;
  localparam int unsigned DIRECTION_W = 3 * 31;

  // Stored vertex: units / 16.
  typedef struct packed {
    logic signed [27:0] x;
    logic signed [27:0] y;
    logic signed [27:0] z;
  } stored_point_t;
  localparam int unsigned STORED_POINT_W = 3 * 28;

  // Stored corner of a base triangle of compact vertices: units / 1024.
  typedef struct packed {
    logic signed [21:0] x;
    logic signed [21:0] y;
    logic signed [21:0] z;
  } stored_corner_t;
  localparam int unsigned STORED_CORNER_W = 3 * 22;

  // Displacement of a compact vertex from the midpoint of its edge, in steps.
  typedef struct packed {
    logic signed [12:0] x;
    logic signed [12:0] y;
    logic signed [12:0] z;
  } displacement_t;
  localparam int unsigned DISPLACEMENT_W = 3 * 13;

  // Its leading bits, in a last split of short vertices.
  typedef struct packed {
    logic signed [6:0] x;
    logic signed [6:0] y;
    logic signed [6:0] z;
  } short_displacement_t;
  localparam int unsigned SHORT_DISPLACEMENT_W = 3 * 7;

  // Corner of a box in steps of 2^16 units.
  typedef struct packed {
    logic signed [15:0] x;
    logic signed [15:0] y;
    logic signed [15:0] z;
  } code3_t;
  localparam int unsigned CODE3_W = 3 * 16;

  // Local coordinates of a corner, mirrored.
  typedef struct packed {
    logic signed [10:0] x;
    logic signed [10:0] y;
    logic signed [10:0] z;
  } local_t;
  localparam int unsigned LOCAL_W = 3 * 11;

  // Moment of a ray: origin cross direction.
  typedef struct packed {
    logic signed [62:0] x;
    logic signed [62:0] y;
    logic signed [62:0] z;
  } moment_t;
  localparam int unsigned MOMENT_W = 3 * 63;

  // Scale of the displacement bounds of one model: a code other than 0 stands for `2^((code + offset) / 16)` units, rounded (`bound_decode`).
  typedef struct packed {
    logic [8:0] offset;  // Added to every code but 0, at most MAX_BOUND_OFFSET.
  } bound_scale_t;
  localparam int unsigned BOUND_SCALE_W = 9;

  // Ray cone: tolerated displacement at distance l is `floor((offset + l * slope) / 2^shift)` units, clamped to 0 ..= 2^34-1.
  typedef struct packed {
    logic [52:0] offset;  // (2/delta) r0 in steps of 2^-shift units.
    logic [17:0] slope;   // (2/delta) tan(theta) in steps of 2^-shift.
    logic [5:0] shift;    // Right shift.
  } cone_t;
  localparam int unsigned CONE_W = 53 + 18 + 6;

  // A ray in model space.
  typedef struct packed {
    point_t origin;         // Origin in units.
    direction_t direction;  // Direction, length close to 2^30 - 1.
    cone_t cone;            // Its cone and the wanted quality.
  } ray_t;
  localparam int unsigned RAY_W = POINT_W + DIRECTION_W + CONE_W;

  // Where a ray starts: a whole point, or a point of a triangle, exact in steps of 2^-31 units.
  typedef struct packed {
    point_t point;               // Coordinates rounded down to units.
    logic [2:0][30:0] fraction;  // What is left of each, in steps of 2^-31 units.
  } start_t;
  localparam int unsigned START_W = POINT_W + 3 * 31;

  // A box in steps of 2^16 units, rounded outwards.
  typedef struct packed {
    code3_t lo;  // Lower corner.
    code3_t hi;  // Upper corner.
  } box16_t;
  localparam int unsigned BOX16_W = CODE3_W + CODE3_W;

  // Reciprocal of one direction component, rounded down.
  typedef struct packed {
    logic [17:0] mantissa;  // Mantissa.
    logic [4:0] shift;      // Right shift.
  } reciprocal_t;
  localparam int unsigned RECIPROCAL_W = 18 + 5;

  // Constants of one axis.
  typedef struct packed {
    logic mirror;                // The direction component is negative: mirror.
    logic [29:0] d;              // Its magnitude.
    logic signed [31:0] origin;  // Mirrored origin in units.
    logic signed [16:0] ceil;    // ceil(x / 2^16).
    reciprocal_t reciprocal;     // 2^30 / d, rounded down.
  } axis_t;
  localparam int unsigned AXIS_W = 1 + 30 + 32 + 17 + RECIPROCAL_W;

  // Input of ray_setup.
  typedef struct packed {
    point_t origin;         // Origin in units.
    direction_t direction;  // Direction.
  } ray_setup_in_t;
  localparam int unsigned RAY_SETUP_IN_W = POINT_W + DIRECTION_W;

  // Output of ray_setup.
  typedef struct packed {
    axis_t x;         // First axis.
    axis_t y;         // Second axis.
    axis_t z;         // Third axis.
    moment_t moment;  // c_yz, c_zx, c_xy (the moment x cross d, mirrored).
  } ray_setup_out_t;
  localparam int unsigned RAY_SETUP_OUT_W = AXIS_W + AXIS_W + AXIS_W + MOMENT_W;

  // Input of bound_decode.
  typedef struct packed {
    logic [BOUND_CODE_W-1:0] code;  // The stored code.
    bound_scale_t scale;            // The model's scale.
  } bound_decode_in_t;
  localparam int unsigned BOUND_DECODE_IN_W = BOUND_CODE_W + BOUND_SCALE_W;

  // Output of bound_decode.
  typedef struct packed {
    logic [BOUND_W-1:0] h;  // Displacement bound in units.
  } bound_decode_out_t;
  localparam int unsigned BOUND_DECODE_OUT_W = BOUND_W;

  // Input of lod_test.
  typedef struct packed {
    ray_t ray;                    // The ray.
    point_t p0;                   // Corner p0 of the (morphed) triangle.
    point_t p1;                   // Corner p1.
    point_t p2;                   // Corner p2.
    logic [BOUND_CODE_W-1:0] e0;  // Bound code of edge (p1, p2).
    logic [BOUND_CODE_W-1:0] e1;  // Bound code of edge (p2, p0).
    logic [BOUND_CODE_W-1:0] e2;  // Bound code of edge (p0, p1).
    bound_scale_t scale;          // The model's bound scale.
  } lod_test_in_t;
  localparam int unsigned LOD_TEST_IN_W = RAY_W + POINT_W + POINT_W + POINT_W + BOUND_CODE_W + BOUND_CODE_W + BOUND_CODE_W + BOUND_SCALE_W;

  // Output of lod_test.
  typedef struct packed {
    logic refine;                 // Some edge state is not 0: go down.
    logic [EDGE_STATE_W-1:0] s0;  // State of edge (p1, p2).
    logic [EDGE_STATE_W-1:0] s1;  // State of edge (p2, p0).
    logic [EDGE_STATE_W-1:0] s2;  // State of edge (p0, p1).
  } lod_test_out_t;
  localparam int unsigned LOD_TEST_OUT_W = 1 + EDGE_STATE_W + EDGE_STATE_W + EDGE_STATE_W;

  // Input of tessellate.
  typedef struct packed {
    logic compact;                // Stored vertices are displacements.
    logic [3:0] grid;             // Zero bits at the bottom of an inserted vertex as morphed.
    logic [2:0] padding;          // How many more it has as stored.
    bound_scale_t scale;          // The model's bound scale.
    logic [BOUND_CODE_W-1:0] e0;  // Bound code of edge (p1, p2).
    logic [BOUND_CODE_W-1:0] e1;  // Bound code of edge (p2, p0).
    logic [BOUND_CODE_W-1:0] e2;  // Bound code of edge (p0, p1).
    logic [EDGE_STATE_W-1:0] s0;  // State of edge (p1, p2).
    logic [EDGE_STATE_W-1:0] s1;  // State of edge (p2, p0).
    logic [EDGE_STATE_W-1:0] s2;  // State of edge (p0, p1).
    point_t f0;                   // Corner p0 of full resolution.
    point_t f1;                   // Corner p1 of full resolution.
    point_t f2;                   // Corner p2 of full resolution.
    point_t p0;                   // Corner p0 as morphed for this ray.
    point_t p1;                   // Corner p1.
    point_t p2;                   // Corner p2.
    point_t v0;                   // Stored vertex on (p1, p2), or its displacement.
    point_t v1;                   // On (p2, p0).
    point_t v2;                   // On (p0, p1).
  } tessellate_in_t;
  localparam int unsigned TESSELLATE_IN_W = 1 + 4 + 3 + BOUND_SCALE_W + BOUND_CODE_W + BOUND_CODE_W + BOUND_CODE_W + EDGE_STATE_W + EDGE_STATE_W + EDGE_STATE_W + POINT_W + POINT_W + POINT_W + POINT_W + POINT_W + POINT_W + POINT_W + POINT_W + POINT_W;

  // Output of tessellate: the inserted vertices of full resolution, and as morphed.
  typedef struct packed {
    point_t g0;  // Full resolution, on (p1, p2).
    point_t g1;  // On (p2, p0).
    point_t g2;  // On (p0, p1).
    point_t q0;  // Morphed, on (p1, p2).
    point_t q1;  // On (p2, p0).
    point_t q2;  // On (p0, p1).
  } tessellate_out_t;
  localparam int unsigned TESSELLATE_OUT_W = POINT_W + POINT_W + POINT_W + POINT_W + POINT_W + POINT_W;

  // Input of child_boxes.
  typedef struct packed {
    logic tree;                  // Children of a tree's node; else of a quad-BVH node.
    code3_t origin;              // Lower corner of a quad-BVH node's frame.
    logic [2:0] halves;          // Steps along x, y, z are half as long again.
    logic [2:0][3:0] exponents;  // Powers of two of these steps.
    logic [23:0][4:0] planes;    // Steps of child k: lower x, y, z and upper x, y, z at 6k to 6k + 5.
    point_t f0;                  // Corner p0 of full resolution.
    point_t f1;                  // Corner p1 of full resolution.
    point_t f2;                  // Corner p2 of full resolution.
    point_t g0;                  // Inserted vertex of full resolution on (p1, p2).
    point_t g1;                  // On (p2, p0).
    point_t g2;                  // On (p0, p1).
    point_t p0;                  // Corner p0 as morphed for this ray.
    point_t p1;                  // Corner p1.
    point_t p2;                  // Corner p2.
    point_t q0;                  // Inserted vertex on (p1, p2) as morphed for this ray.
    point_t q1;                  // On (p2, p0).
    point_t q2;                  // On (p0, p1).
  } child_boxes_in_t;
  localparam int unsigned CHILD_BOXES_IN_W = 1 + CODE3_W + 3 + 3 * 4 + 24 * 5 + POINT_W + POINT_W + POINT_W + POINT_W + POINT_W + POINT_W + POINT_W + POINT_W + POINT_W + POINT_W + POINT_W + POINT_W;

  // Output of child_boxes.
  typedef struct packed {
    logic [3:0][BOX16_W-1:0] bounds;  // Box of child k.
  } child_boxes_out_t;
  localparam int unsigned CHILD_BOXES_OUT_W = 4 * BOX16_W;

  // Input of box_decode.
  typedef struct packed {
    code3_t origin;              // Lower corner of the node's frame.
    logic [2:0] halves;          // Steps along x, y, z are half as long again.
    logic [2:0][3:0] exponents;  // Powers of two of these steps.
    logic [2:0][4:0] lo;         // Steps of the lower corner.
    logic [2:0][4:0] hi;         // Steps of the upper corner.
  } box_decode_in_t;
  localparam int unsigned BOX_DECODE_IN_W = CODE3_W + 3 + 3 * 4 + 3 * 5 + 3 * 5;

  // Output of box_decode.
  typedef struct packed {
    box16_t bounds;  // The box.
  } box_decode_out_t;
  localparam int unsigned BOX_DECODE_OUT_W = BOX16_W;

  // Input of box_decode8.
  typedef struct packed {
    code3_t origin;              // Lower corner of the node's frame.
    logic [2:0] halves;          // Steps along x, y, z are half as long again.
    logic [2:0][3:0] exponents;  // Powers of two of these steps.
    logic [2:0][7:0] lo;         // Steps of the lower corner.
    logic [2:0][7:0] hi;         // Steps of the upper corner.
  } box_decode8_in_t;
  localparam int unsigned BOX_DECODE8_IN_W = CODE3_W + 3 + 3 * 4 + 3 * 8 + 3 * 8;

  // Output of box_decode8.
  typedef struct packed {
    box16_t bounds;  // The box.
  } box_decode8_out_t;
  localparam int unsigned BOX_DECODE8_OUT_W = BOX16_W;

  // Input of box_test.
  typedef struct packed {
    ray_setup_out_t ray;        // The ray's constants.
    logic [RAY_T_W-1:0] t_max;  // t of the closest hit so far.
    box16_t bounds;             // The box.
  } box_test_in_t;
  localparam int unsigned BOX_TEST_IN_W = RAY_SETUP_OUT_W + RAY_T_W + BOX16_W;

  // Output of both box tests.
  typedef struct packed {
    logic hit;                    // The ray meets the box before `t_max`.
    logic [T_NEAR_W-1:0] t_near;  // Lower bound of the entry distance.
  } box_test_out_t;
  localparam int unsigned BOX_TEST_OUT_W = 1 + T_NEAR_W;

  // Input of box_test32.
  typedef struct packed {
    ray_setup_out_t ray;        // The ray's constants.
    logic [RAY_T_W-1:0] t_max;  // t of the closest hit so far.
    point_t lo;                 // Lower corner in units.
    point_t hi;                 // Upper corner in units.
  } box_test32_in_t;
  localparam int unsigned BOX_TEST32_IN_W = RAY_SETUP_OUT_W + RAY_T_W + POINT_W + POINT_W;

  // Input of child_sort.
  typedef struct packed {
    logic [3:0] hit;                   // Child k is hit.
    logic [3:0][T_NEAR_W-1:0] t_near;  // Entry distance of child k.
  } child_sort_in_t;
  localparam int unsigned CHILD_SORT_IN_W = 4 + 4 * T_NEAR_W;

  // Output of child_sort.
  typedef struct packed {
    logic [2:0] count;       // Number of children hit, 0 to 4.
    logic [3:0][1:0] order;  // Child numbers, nearest first.
  } child_sort_out_t;
  localparam int unsigned CHILD_SORT_OUT_W = 3 + 4 * 2;

  // Input of child_sort6.
  typedef struct packed {
    logic [5:0] hit;                   // Child k is hit.
    logic [5:0][T_NEAR_W-1:0] t_near;  // Entry distance of child k.
  } child_sort6_in_t;
  localparam int unsigned CHILD_SORT6_IN_W = 6 + 6 * T_NEAR_W;

  // Output of child_sort6.
  typedef struct packed {
    logic [2:0] count;       // Number of children hit, 0 to 6.
    logic [5:0][2:0] order;  // Child numbers, nearest first.
  } child_sort6_out_t;
  localparam int unsigned CHILD_SORT6_OUT_W = 3 + 6 * 3;

  // Input of child_test.
  typedef struct packed {
    ray_setup_out_t ray;         // The ray's constants.
    logic [RAY_T_W-1:0] t_max;   // t of the closest hit so far.
    logic [3:0] present;         // Child k exists.
    logic tree;                  // Children of a tree's node; else of a quad-BVH node.
    code3_t origin;              // Lower corner of a quad-BVH node's frame.
    logic [2:0] halves;          // Steps along x, y, z are half as long again.
    logic [2:0][3:0] exponents;  // Powers of two of these steps.
    logic [23:0][4:0] planes;    // Steps of child k: lower x, y, z and upper x, y, z at 6k to 6k + 5.
    point_t f0;                  // Corner p0 of full resolution of the parent.
    point_t f1;                  // Corner p1 of full resolution.
    point_t f2;                  // Corner p2 of full resolution.
    point_t g0;                  // Its inserted vertex of full resolution on (p1, p2).
    point_t g1;                  // On (p2, p0).
    point_t g2;                  // On (p0, p1).
    point_t p0;                  // Corner p0 of the parent as morphed for this ray.
    point_t p1;                  // Corner p1.
    point_t p2;                  // Corner p2.
    point_t q0;                  // Its inserted vertex on (p1, p2), as morphed for this ray.
    point_t q1;                  // On (p2, p0).
    point_t q2;                  // On (p0, p1).
  } child_test_in_t;
  localparam int unsigned CHILD_TEST_IN_W = RAY_SETUP_OUT_W + RAY_T_W + 4 + 1 + CODE3_W + 3 + 3 * 4 + 24 * 5 + POINT_W + POINT_W + POINT_W + POINT_W + POINT_W + POINT_W + POINT_W + POINT_W + POINT_W + POINT_W + POINT_W + POINT_W;

  // Output of child_test.
  typedef struct packed {
    logic [2:0] count;                 // Number of children hit, 0 to 4.
    logic [3:0][1:0] order;            // Child numbers, nearest first.
    logic [3:0][T_NEAR_W-1:0] t_near;  // Entry distance of child k; 0 if it is missed.
  } child_test_out_t;
  localparam int unsigned CHILD_TEST_OUT_W = 3 + 4 * 2 + 4 * T_NEAR_W;

  // Input of tri_test.
  typedef struct packed {
    point_t origin;         // Origin of the ray.
    direction_t direction;  // Its direction.
    point_t p0;             // Corner a = p0.
    point_t p1;             // Corner b = p1.
    point_t p2;             // Corner c = p2.
  } tri_test_in_t;
  localparam int unsigned TRI_TEST_IN_W = POINT_W + DIRECTION_W + POINT_W + POINT_W + POINT_W;

  // Output of tri_test.
  typedef struct packed {
    logic hit;                        // The ray meets the triangle.
    logic front;                      // It meets its front (counter-clockwise) face.
    logic [EDGE_FUNCTION_W-1:0] v;    // Weight of p1 times det.
    logic [EDGE_FUNCTION_W-1:0] w;    // Weight of p2 times det.
    logic [EDGE_FUNCTION_W-1:0] det;  // u + v + w.
    logic [T_NUMERATOR_W-1:0] t_num;  // t times det.
  } tri_test_out_t;
  localparam int unsigned TRI_TEST_OUT_W = 1 + 1 + EDGE_FUNCTION_W + EDGE_FUNCTION_W + EDGE_FUNCTION_W + T_NUMERATOR_W;

  // Input of hit_divide.
  typedef struct packed {
    logic [T_NUMERATOR_W-1:0] numerator;      // Numerator.
    logic [EDGE_FUNCTION_W-1:0] denominator;  // Denominator, not 0.
  } hit_divide_in_t;
  localparam int unsigned HIT_DIVIDE_IN_W = T_NUMERATOR_W + EDGE_FUNCTION_W;

  // Output of hit_divide.
  typedef struct packed {
    logic [RAY_T_W-1:0] quotient;  // The quotient.
  } hit_divide_out_t;
  localparam int unsigned HIT_DIVIDE_OUT_W = RAY_T_W;

  // Input of hit_select.
  typedef struct packed {
    logic [3:0] levels;             // Number of splits N.
    logic known;                    // There is a closest hit so far.
    logic [RAY_T_W-1:0] best_t;     // Its t.
    logic best_front;               // It is on a front face.
    logic [FULL_ID_W-1:0] best_id;  // Its id.
    logic [RAY_T_W-1:0] t;          // t of the new hit.
    logic front;                    // It is on a front face.
    logic [27:0] tree;              // Its base triangle.
    logic [3:0] level;              // Its level.
    logic [NODE_INDEX_W-1:0] node;  // Its node on that level.
  } hit_select_in_t;
  localparam int unsigned HIT_SELECT_IN_W = 4 + 1 + RAY_T_W + 1 + FULL_ID_W + RAY_T_W + 1 + 28 + 4 + NODE_INDEX_W;

  // Output of hit_select.
  typedef struct packed {
    logic closer;              // The new hit is the closest now.
    logic [FULL_ID_W-1:0] id;  // Its id.
  } hit_select_out_t;
  localparam int unsigned HIT_SELECT_OUT_W = 1 + FULL_ID_W;

  // Input of bary_map.
  typedef struct packed {
    logic [3:0] levels;             // Levels to go down: N - n.
    logic [NODE_INDEX_W-1:0] node;  // Node on level n.
    logic [BARY_W-1:0] b0;          // Weight of p0.
    logic [BARY_W-1:0] b1;          // Weight of p1.
    logic [BARY_W-1:0] b2;          // Weight of p2.
  } bary_map_in_t;
  localparam int unsigned BARY_MAP_IN_W = 4 + NODE_INDEX_W + BARY_W + BARY_W + BARY_W;

  // Output of bary_map.
  typedef struct packed {
    logic [NODE_INDEX_W-1:0] node;  // Node on level N.
    logic [BARY_W-1:0] b0;          // Weight of its corner 0.
    logic [BARY_W-1:0] b1;          // Weight of its corner 1.
    logic [BARY_W-1:0] b2;          // Weight of its corner 2.
  } bary_map_out_t;
  localparam int unsigned BARY_MAP_OUT_W = NODE_INDEX_W + BARY_W + BARY_W + BARY_W;

  // Input of node_address.
  typedef struct packed {
    logic [LINE_ADDRESS_W-1:0] base;  // First line of the section.
    logic [27:0] start;               // First record of the level, or where the tree at place 0 would have it; 0 outside of trees.
    logic [27:0] place;               // The tree's place among those of the level; 0 outside of trees.
    logic [3:0] level;                // Level of the node within its tree; 0 outside of trees.
    logic [27:0] index;               // Number of the record in its tree on its level.
    logic scale;                      // Records have 2^scale lines.
    logic low;                        // Which of them.
  } node_address_in_t;
  localparam int unsigned NODE_ADDRESS_IN_W = LINE_ADDRESS_W + 28 + 28 + 4 + 28 + 1 + 1;

  // Output of node_address.
  typedef struct packed {
    logic [LINE_ADDRESS_W-1:0] address;  // The line.
  } node_address_out_t;
  localparam int unsigned NODE_ADDRESS_OUT_W = LINE_ADDRESS_W;

  // Input of tree_deciders.
  typedef struct packed {
    logic [27:0] last;   // Base triangle of the last hit.
    point_t a0;          // Its corner p0.
    point_t a1;          // Its corner p1.
    point_t a2;          // Its corner p2.
    logic [2:0] second;  // Of its edges (p1, p2), (p2, p0), (p0, p1): the second viewer decides, not the first.
    logic [27:0] tree;   // The base triangle entered.
    point_t p0;          // Its corner p0.
    point_t p1;          // Its corner p1.
    point_t p2;          // Its corner p2.
  } tree_deciders_in_t;
  localparam int unsigned TREE_DECIDERS_IN_W = 28 + POINT_W + POINT_W + POINT_W + 3 + 28 + POINT_W + POINT_W + POINT_W;

  // Output of tree_deciders.
  typedef struct packed {
    logic [DECIDER_W-1:0] inner;       // Who decides about inner edges.
    logic [2:0][DECIDER_W-1:0] edges;  // About base edge (p1, p2), (p2, p0), (p0, p1), and parts of it.
  } tree_deciders_out_t;
  localparam int unsigned TREE_DECIDERS_OUT_W = DECIDER_W + 3 * DECIDER_W;

  // Input of node_deciders.
  typedef struct packed {
    tree_deciders_out_t tree;       // Who decides in its tree.
    logic [3:0] level;              // Its level.
    logic [NODE_INDEX_W-1:0] node;  // Its number on that level.
  } node_deciders_in_t;
  localparam int unsigned NODE_DECIDERS_IN_W = TREE_DECIDERS_OUT_W + 4 + NODE_INDEX_W;

  // Output of node_deciders.
  typedef struct packed {
    logic [2:0][DECIDER_W-1:0] by;  // Who decides about edge (p1, p2), (p2, p0), (p0, p1).
  } node_deciders_out_t;
  localparam int unsigned NODE_DECIDERS_OUT_W = 3 * DECIDER_W;

  // Input of lod_test_by.
  typedef struct packed {
    ray_t ray;                      // The ray.
    ray_t first;                    // Its first viewer.
    ray_t second;                   // Its second viewer.
    logic [2:0][DECIDER_W-1:0] by;  // Who decides about edge (p1, p2), (p2, p0), (p0, p1): 0 the ray, 1 and 2 its viewers.
    point_t p0;                     // Corner p0 of the (morphed) triangle.
    point_t p1;                     // Corner p1.
    point_t p2;                     // Corner p2.
    logic [BOUND_CODE_W-1:0] e0;    // Bound code of edge (p1, p2).
    logic [BOUND_CODE_W-1:0] e1;    // Bound code of edge (p2, p0).
    logic [BOUND_CODE_W-1:0] e2;    // Bound code of edge (p0, p1).
    bound_scale_t scale;            // The model's bound scale.
  } lod_test_by_in_t;
  localparam int unsigned LOD_TEST_BY_IN_W = RAY_W + RAY_W + RAY_W + 3 * DECIDER_W + POINT_W + POINT_W + POINT_W + BOUND_CODE_W + BOUND_CODE_W + BOUND_CODE_W + BOUND_SCALE_W;

  // Input of start_setup.
  typedef struct packed {
    start_t start;          // Where the ray starts.
    direction_t direction;  // Direction.
  } start_setup_in_t;
  localparam int unsigned START_SETUP_IN_W = START_W + DIRECTION_W;

  // What numerators have below whole numbers, in steps of 2^-31: nothing for a ray from a whole point.
  typedef struct packed {
    logic [30:0] v;  // Of v.
    logic [30:0] w;  // Of w.
    logic [30:0] t;  // Of t.
  } below_t;
  localparam int unsigned BELOW_W = 31 + 31 + 31;

  // Input of start_test.
  typedef struct packed {
    start_t start;          // Where the ray starts.
    direction_t direction;  // Its direction.
    point_t p0;             // Corner a = p0.
    point_t p1;             // Corner b = p1.
    point_t p2;             // Corner c = p2.
  } start_test_in_t;
  localparam int unsigned START_TEST_IN_W = START_W + DIRECTION_W + POINT_W + POINT_W + POINT_W;

  // Output of start_test.
  typedef struct packed {
    tri_test_out_t test;  // As the triangle test has it, its numerators rounded down.
    below_t below;        // What is left of them.
  } start_test_out_t;
  localparam int unsigned START_TEST_OUT_W = TRI_TEST_OUT_W + BELOW_W;

  // Input of start_divide.
  typedef struct packed {
    logic [T_NUMERATOR_W-1:0] numerator;      // Numerator, rounded down.
    logic [30:0] low;                         // What is left of it, in steps of 2^-31.
    logic [EDGE_FUNCTION_W-1:0] denominator;  // Denominator, not 0.
  } start_divide_in_t;
  localparam int unsigned START_DIVIDE_IN_W = T_NUMERATOR_W + 31 + EDGE_FUNCTION_W;

  // What the children of a node share.
  typedef struct packed {
    logic open;               // All children are met.
    logic flipped;            // An odd number of axes is mirrored: below a triangle and above it change places.
    logic [4:0] shift;        // Units of a local step: 2^shift.
    logic [2:0][11:0] d;      // D, x first.
    logic signed [12:0] u;    // Of the first corner across the ray.
    logic signed [12:0] v;    // Likewise, of y.
    logic signed [32:0] z;    // Of the first corner along z from the ray's origin, in units.
    logic [12:0] soft_u;      // Most that morphed corners lie beside full-resolution ones, in quarters of a step.
    logic [12:0] soft_v;      // Likewise.
    logic [9:0] soft_z;       // Along z, in steps.
    reciprocal_t reciprocal;  // Of d along z.
  } frame_t;
  localparam int unsigned FRAME_W = 1 + 1 + 5 + 3 * 12 + 13 + 13 + 33 + 13 + 13 + 10 + RECIPROCAL_W;

  // Input of prism_frame.
  typedef struct packed {
    ray_setup_out_t ray;               // The ray's constants.
    logic [5:0][POINT_W-1:0] full;     // Corners and inserted vertices of full resolution: p0, p1, p2, q0, q1, q2.
    logic [5:0][POINT_W-1:0] morphed;  // The same as morphed for this ray.
  } prism_frame_in_t;
  localparam int unsigned PRISM_FRAME_IN_W = RAY_SETUP_OUT_W + 6 * POINT_W + 6 * POINT_W;

  // Output of prism_frame.
  typedef struct packed {
    frame_t frame;              // What the children share.
    logic [5:0][32:0] corners;  // The corners and inserted vertices in local coordinates.
  } prism_frame_out_t;
  localparam int unsigned PRISM_FRAME_OUT_W = FRAME_W + 6 * 33;

  // Input of prism_test.
  typedef struct packed {
    frame_t frame;              // What the children share.
    logic [RAY_T_W-1:0] t_max;  // t of the closest hit so far.
    logic [2:0][32:0] corners;  // The child's corners.
    logic [4:0][2:0] planes;    // Codes: reach beyond the edges (p1, p2), (p2, p0), (p0, p1), height below and above.
    logic [2:0] reach;          // Exponent of reaches.
    logic [3:0] height;         // Exponent of heights.
  } prism_test_in_t;
  localparam int unsigned PRISM_TEST_IN_W = FRAME_W + RAY_T_W + 3 * 33 + 5 * 3 + 3 + 4;

  // Input of child_prisms.
  typedef struct packed {
    ray_setup_out_t ray;               // The ray's constants.
    logic [RAY_T_W-1:0] t_max;         // t of the closest hit so far.
    logic [2:0] reach;                 // Exponent of reaches; at its largest, all children are met.
    logic [3:0] height;                // Exponent of heights.
    logic [19:0][2:0] planes;          // Codes of child k at 5k to 5k + 4: reach beyond the edges (p1, p2), (p2, p0), (p0, p1), height below and above.
    logic [5:0][POINT_W-1:0] full;     // Corners and inserted vertices of full resolution: p0, p1, p2, q0, q1, q2.
    logic [5:0][POINT_W-1:0] morphed;  // The same as morphed for this ray.
  } child_prisms_in_t;
  localparam int unsigned CHILD_PRISMS_IN_W = RAY_SETUP_OUT_W + RAY_T_W + 3 + 4 + 20 * 3 + 6 * POINT_W + 6 * POINT_W;

  // What traversal needs of a tree's node that splits into nodes: its inserted vertices, and of its four children bound codes and boxes. 32 bytes.
  typedef struct packed {
    displacement_t v0;                    // Inserted vertex q0, if they are compact (else zero): its displacement from the midpoint of its edge between full-resolution corners, in steps of displacement_shift.
    displacement_t v1;                    // The same of q1.
    displacement_t v2;                    // Of q2.
    logic [8:0][BOUND_CODE_W-1:0] codes;  // Codes of the nine different edges: 3k, 3k + 1, 3k + 2 of e0, e1, e2 of child k < 3; child 3 has 0, 4 and 8 (codes_of).
    logic [3:0] reserved;                 // Zero.
    logic [2:0] halves;                   // Steps along x, y, z are half as long again.
    logic [2:0][3:0] exponents;           // Powers of two of these steps.
    logic [23:0][1:0] planes;             // Child k: below in x, y, z and above in x, y, z at 6k to 6k + 5.
  } split_record_t;
  localparam int unsigned SPLIT_RECORD_W = DISPLACEMENT_W + DISPLACEMENT_W + DISPLACEMENT_W + 9 * BOUND_CODE_W + 4 + 3 + 3 * 4 + 24 * 2;

  // A quad-BVH node: 32 bytes. Its boxes lie in a frame of its own: box_steps of their axis from its origin.
  typedef struct packed {
    logic reserved;              // Zero.
    logic [3:0][1:0] kinds;      // Kind of each child: 0 empty, 1 inner node, 2 leaf.
    logic [3:0][1:0] counts;     // Leaf: number of triangles or trees minus one; else 0.
    logic [27:0] first_node;     // The first inner child.
    logic [27:0] first_leaf;     // The first triangle slot or tree of the first leaf.
    code3_t origin;              // Lower corner of the frame.
    logic [2:0] halves;          // Steps along x, y, z are half as long again.
    logic [2:0][3:0] exponents;  // Powers of two of these steps.
    logic [23:0][4:0] planes;    // Child k: lower corner x, y, z and upper corner x, y, z at 6k to 6k + 5; zero in an empty slot.
  } bvh_node_t;
  localparam int unsigned BVH_NODE_W = 1 + 4 * 2 + 4 * 2 + 28 + 28 + CODE3_W + 3 + 3 * 4 + 24 * 5;

  // Three points of 28-bit coordinates (the stored part: units / 16): one 32-byte line.
  typedef struct packed {
    logic [3:0] reserved;  // Zero.
    stored_point_t v0;     // q0 (or p0 beside an L0 record).
    stored_point_t v1;     // q1 (or p1).
    stored_point_t v2;     // q2 (or p2).
  } vertex_data_t;
  localparam int unsigned VERTEX_DATA_W = 4 + STORED_POINT_W + STORED_POINT_W + STORED_POINT_W;

  // Inserted vertices of a last split, compact: displacements as in a split_record. 16 bytes.
  typedef struct packed {
    logic [10:0] reserved;  // Zero.
    displacement_t v0;      // Of q0.
    displacement_t v1;      // Of q1.
    displacement_t v2;      // Of q2.
  } displacements_t;
  localparam int unsigned DISPLACEMENTS_W = 11 + DISPLACEMENT_W + DISPLACEMENT_W + DISPLACEMENT_W;

  // Inserted vertices of a last split, short: the leading bits of displacements, of which the others are zero. 63 bits.
  typedef struct packed {
    short_displacement_t v0;  // Of q0.
    short_displacement_t v1;  // Of q1.
    short_displacement_t v2;  // Of q2.
  } short_displacements_t;
  localparam int unsigned SHORT_DISPLACEMENTS_W = SHORT_DISPLACEMENT_W + SHORT_DISPLACEMENT_W + SHORT_DISPLACEMENT_W;

  // What traversal needs of a base triangle: 32 bytes.
  typedef struct packed {
    logic [3:0] depth;            // Levels of the tree that are stored, 0 to N: below them is nothing that a ray could want.
    logic [27:0] place;           // Its place among the trees of each level (`layout.rs`).
    logic [BOUND_CODE_W-1:0] e0;  // Code of edge (p1, p2) of the root; zero if depth is 0, like the others.
    logic [BOUND_CODE_W-1:0] e1;  // Code of edge (p2, p0).
    logic [BOUND_CODE_W-1:0] e2;  // Code of edge (p0, p1).
    logic [1:0] reserved;         // Zero.
    stored_corner_t p0;           // Corner p0 in steps of 2^BASE_ZERO_BITS units, if vertices are compact; else zero, and the corners are in a second line.
    stored_corner_t p1;           // Corner p1.
    stored_corner_t p2;           // Corner p2.
  } l0_record_t;
  localparam int unsigned L0_RECORD_W = 4 + 28 + BOUND_CODE_W + BOUND_CODE_W + BOUND_CODE_W + 2 + STORED_CORNER_W + STORED_CORNER_W + STORED_CORNER_W;

  // One waiting node.
  typedef struct packed {
    logic [T_NEAR_W-1:0] t_near;  // Lower bound of the distance to its box.
    logic [1:0] kind;             // 0: quad-BVH node `index`; 1: tree `index`; 2: node `index` on `level` of the current tree.
    logic [3:0] level;            // Level within the tree, 1 to 9; else 0.
    logic [27:0] index;           // Which one.
    logic [BOUND_CODE_W-1:0] e0;  // Bound code of edge (p1, p2) of a tree's node; else 0.
    logic [BOUND_CODE_W-1:0] e1;  // Bound code of edge (p2, p0).
    logic [BOUND_CODE_W-1:0] e2;  // Bound code of edge (p0, p1).
  } stack_entry_t;
  localparam int unsigned STACK_ENTRY_W = T_NEAR_W + 2 + 4 + 28 + BOUND_CODE_W + BOUND_CODE_W + BOUND_CODE_W;

  // The hit record.
  typedef struct packed {
    logic [RAY_T_W-1:0] t;               // Ray parameter in steps of 2^-32 of the direction.
    logic front;                         // The front face was met.
    logic [27:0] tree;                   // Base triangle.
    logic [3:0] level;                   // Level of the triangle that was met, 0 to N.
    logic [NODE_INDEX_W-1:0] node;       // Its node on that level.
    logic [BARY_W-1:0] b0;               // Weight of its p0, 2^31 = 1.
    logic [BARY_W-1:0] b1;               // Weight of its p1.
    logic [BARY_W-1:0] b2;               // Weight of its p2.
    logic [NODE_INDEX_W-1:0] full_node;  // Node on level N: the full-resolution triangle is `tree * 4^N + full_node`.
    logic [BARY_W-1:0] full_b0;          // Weight of the full-resolution triangle's corner 0.
    logic [BARY_W-1:0] full_b1;          // Weight of corner 1.
    logic [BARY_W-1:0] full_b2;          // Weight of corner 2.
  } hit_t;
  localparam int unsigned HIT_W = RAY_T_W + 1 + 28 + 4 + NODE_INDEX_W + BARY_W + BARY_W + BARY_W + NODE_INDEX_W + BARY_W + BARY_W + BARY_W;

  // The model that the rays meet, and what bounds their ways; held still while rays are under way.
  typedef struct packed {
    logic [3:0] levels;                       // Number of splits N.
    logic [4:0] zeros;                        // Zero bits at the bottom of all coordinates: of morphed triangles too, and of the rays' origins.
    logic compact;                            // Inserted vertices are stored as displacements from the midpoints of their edges.
    logic short_splits;                       // Those of last splits have 7 bits a coordinate. Of no meaning where vertices are no displacements.
    bound_scale_t scale;                      // Scale of the displacement bounds.
    logic [LINE_ADDRESS_W-1:0] nodes;         // First line of the quad-BVH's nodes.
    logic [LINE_ADDRESS_W-1:0] records;       // First line of the L0 records.
    logic [LINE_ADDRESS_W-1:0] splits;        // First line of the splits.
    logic [LINE_ADDRESS_W-1:0] vertices;      // First line of the vertex data.
    logic [7:0][27:0] split_starts;           // First split of each level from 1 on.
    logic [8:0][27:0] vertex_starts;          // Exact vertices: first line of each level from 1 on. Compact ones: the two lines, or short ones the line, that the tree at place 0 would have for the first four nodes there, modulo 2^28.
    logic [31:0] visits;                      // The most entries that a ray can visit: quad-BVH nodes, trees, and nodes of trees. A ray that would visit more is in a loop.
    logic [ANSWER_LIMIT_W-1:0] answer_limit;  // Cycles, less one, after which a line that is waited for counts as late if it has not come in as many more.
  } scene_config_t;
  localparam int unsigned SCENE_CONFIG_W = 4 + 5 + 1 + 1 + BOUND_SCALE_W + LINE_ADDRESS_W + LINE_ADDRESS_W + LINE_ADDRESS_W + LINE_ADDRESS_W + 8 * 28 + 9 * 28 + 32 + ANSWER_LIMIT_W;

  // A ray to trace.
  typedef struct packed {
    logic [31:0] tag;  // Comes back with the hit.
    ray_t ray;         // The ray in model space.
  } ray_in_t;
  localparam int unsigned RAY_IN_W = 32 + RAY_W;

  // What a ray has that starts on a surface or wants less than the closest hit: comes with the ray, to hardware for such rays (secondary); other hardware does not look at it. Of a primary ray all is 0 but `t_max`, which has all bits.
  typedef struct packed {
    logic [RAY_T_W-1:0] t_min;   // The smallest t that counts.
    logic [RAY_T_W-1:0] t_max;   // The largest t that counts.
    logic any;                   // Any hit serves: the ray ends with the closest of the first triangles tested together of which one is met.
    logic [2:0][30:0] fraction;  // What its start has beyond the ray's origin, in steps of 2^-31 units.
    logic prior;                 // Rays before it decide about levels around its start; all that follows is theirs.
    logic [27:0] last;           // Base triangle of the last hit.
    point_t a0;                  // Its corner p0.
    point_t a1;                  // Its corner p1.
    point_t a2;                  // Its corner p2.
    logic [2:0] by_second;       // Of its edges (p1, p2), (p2, p0), (p0, p1): the second ray decides, not the first.
    ray_t first;                 // The ray that decides inside it, and about its other edges.
    ray_t second;                // The second ray.
  } secondary_in_t;
  localparam int unsigned SECONDARY_IN_W = RAY_T_W + RAY_T_W + 1 + 3 * 31 + 1 + 28 + POINT_W + POINT_W + POINT_W + 3 + RAY_W + RAY_W;

  // Corners of the triangle of a hit, as it was tested: what the exact start of rays from there is made of.
  typedef struct packed {
    point_t p0;  // Its corner p0.
    point_t p1;  // Its corner p1.
    point_t p2;  // Its corner p2.
  } corners_t;
  localparam int unsigned CORNERS_W = POINT_W + POINT_W + POINT_W;

  // A ray traced.
  typedef struct packed {
    logic [31:0] tag;   // The ray's tag.
    logic [2:0] error;  // Why it ended early: a code of `ray_error_t`. 0: it did not.
    logic found;        // The ray met something; 0 if it ended early.
    hit_t hit;          // What; all zero if nothing.
  } hit_out_t;
  localparam int unsigned HIT_OUT_W = 32 + 3 + 1 + HIT_W;

  // A memory line asked for.
  typedef struct packed {
    logic [7:0] tag;                     // Ray context (upper six bits) and place of the line in its record (lower two).
    logic [EPOCH_W-1:0] epoch;           // Of the context's rays, the one that asks: comes back with the line.
    logic [LINE_ADDRESS_W-1:0] address;  // The line.
  } memory_request_t;
  localparam int unsigned MEMORY_REQUEST_W = 8 + EPOCH_W + LINE_ADDRESS_W;

  // A memory line that came.
  typedef struct packed {
    logic [7:0] tag;            // Tag of the request.
    logic [EPOCH_W-1:0] epoch;  // Its epoch.
    logic error;                // There is no such line, or it could not be read.
    logic [3:0][63:0] line;     // Its 32 bytes, word 0 first.
  } memory_answer_t;
  localparam int unsigned MEMORY_ANSWER_W = 8 + EPOCH_W + 1 + 4 * 64;

  // What the memories of a unit take for test, which mean nothing to what it computes.
  typedef struct packed {
    logic flip;        // Words are written with the wrong parity.
    logic [6:0] pins;  // For the pins of a compiled memory: margins, modes.
  } memory_test_t;
  localparam int unsigned MEMORY_TEST_W = 1 + 7;

  // What a context is doing: for who looks from outside, at a ray that is stuck too. What the state gives no meaning to is 0.
  typedef struct packed {
    logic [4:0] state;          // Its state.
    logic rests;                // It takes no ray before the lines that it is owed have come.
    logic [EPOCH_W-1:0] epoch;  // Number of its ray, or of the one before.
    logic [OWED_W-1:0] owed;    // Lines that it has asked for and that have not come, of rays before too.
    logic [1:0] want;           // Lines wanted and not yet asked for, by place.
    logic [1:0] waiting;        // Lines asked for and not there, by place.
    logic [6:0] stacked;        // Entries on its stack.
    logic [31:0] tag;           // Tag of its ray.
    logic [2:0] error;          // Why its ray ends early: a code of `ray_error_t`.
    logic [1:0] kind;           // Kind of the entry under visit.
    logic [3:0] level;          // Its level in its tree.
    logic [27:0] index;         // Its index.
    logic [31:0] visits;        // Entries that the ray may still visit.
    logic [2:0] left;           // Triangles still to be sent.
    logic [2:0] pending;        // Triangles without a verdict.
  } context_view_t;
  localparam int unsigned CONTEXT_VIEW_W = 5 + 1 + EPOCH_W + OWED_W + 2 + 2 + 7 + 32 + 3 + 2 + 4 + 28 + 32 + 3 + 3;

  // What a unit did since its counters were cleared, each modulo 2^32.
  typedef struct packed {
    logic [31:0] cycles;         // Cycles.
    logic [31:0] busy;           // Those in which a ray was under way, or something waited at a port.
    logic [31:0] rays;           // Rays taken.
    logic [31:0] hits;           // Rays done that met something.
    logic [31:0] misses;         // Rays done that met nothing.
    logic [31:0] errors;         // Rays that ended early.
    logic [31:0] requests;       // Lines asked for.
    logic [31:0] answers;        // Lines that came.
    logic [31:0] compared;       // Triangles met, as each is compared with the closest.
    logic [31:0] rays_wait;      // Cycles in which a ray waited at the port.
    logic [31:0] hits_wait;      // Cycles in which a hit waited at the port.
    logic [31:0] requests_wait;  // Cycles in which a request waited at the port.
    logic [9:0][31:0] taken;     // What blocks and ports took from contexts: ray_setup, node_address, child_test, tree_deciders, lod_test, tessellate, tri_test, hit_divide (but for t), bary_map, hits.
    logic [9:0][31:0] refused;   // Cycles in which a context asked for each of them and none was served.
  } unit_counters_t;
  localparam int unsigned UNIT_COUNTERS_W = 32 + 32 + 32 + 32 + 32 + 32 + 32 + 32 + 32 + 32 + 32 + 32 + 10 * 32 + 10 * 32;

  // State of a context.
  typedef enum logic [4:0] {
    IDLE        = 5'd0,
    SETUP       = 5'd1,
    SETUP_WAIT  = 5'd2,
    VISIT       = 5'd3,
    FETCH       = 5'd4,
    CHILD       = 5'd5,
    CHILD_WAIT  = 5'd6,
    PUSH        = 5'd7,
    POP         = 5'd8,
    DECIDE      = 5'd9,
    DECIDE_WAIT = 5'd10,
    LOD         = 5'd11,
    LOD_WAIT    = 5'd12,
    MORPH       = 5'd13,
    MORPH_WAIT  = 5'd14,
    TRI         = 5'd15,
    DIVIDE_V    = 5'd16,
    DIVIDE_W    = 5'd17,
    DIVIDE_WAIT = 5'd18,
    SUM         = 5'd19,
    MAP         = 5'd20,
    MAP_WAIT    = 5'd21,
    DONE        = 5'd22
  } context_state_t;

  // What a context fetches.
  typedef enum logic [1:0] {
    NODE   = 2'd0,  // quad-BVH node
    RECORD = 2'd1,  // L0 record
    SPLIT  = 2'd2   // split: of a node whose children are nodes its record, and inserted vertices where they are not in that
  } fetch_t;

  // Why a ray ended early.
  typedef enum logic [2:0] {
    ERROR_NONE    = 3'd0,
    ERROR_MEMORY  = 3'd1,  // a line came with an error
    ERROR_LATE    = 3'd2,  // a line did not come in time
    ERROR_IMAGE   = 3'd3,  // a line holds what no scene of this configuration has there
    ERROR_VISITS  = 3'd4,  // more entries were visited than the scene has
    ERROR_STACK   = 3'd5,  // more entries wait than the stack has room for
    ERROR_SCENE   = 3'd6,  // the scene is not for this hardware
    ERROR_ABORTED = 3'd7   // the unit was flushed
  } ray_error_t;

  // Coordinates and directions as they are kept, without the bits that are always 0; and as they were.
  typedef struct packed {
    logic signed [COORDINATE_W-1:0] x;
    logic signed [COORDINATE_W-1:0] y;
    logic signed [COORDINATE_W-1:0] z;
  } kept_point_t;
  localparam int unsigned KEPT_POINT_W = 3 * COORDINATE_W;
  localparam int unsigned KEPT_DIRECTION_W = 3 * COMPONENT_W;
  function automatic kept_point_t keep_point(input point_t p);
    keep_point = {COORDINATE_W'(p.x >>> COORDINATE_ZEROS), COORDINATE_W'(p.y >>> COORDINATE_ZEROS), COORDINATE_W'(p.z >>> COORDINATE_ZEROS)};
  endfunction
  function automatic point_t whole_point(input kept_point_t p);
    whole_point = {32'(p.x) << COORDINATE_ZEROS, 32'(p.y) << COORDINATE_ZEROS, 32'(p.z) << COORDINATE_ZEROS};
  endfunction
  typedef struct packed {
    logic signed [COMPONENT_W-1:0] x;
    logic signed [COMPONENT_W-1:0] y;
    logic signed [COMPONENT_W-1:0] z;
  } kept_direction_t;
  function automatic kept_direction_t keep_direction(input direction_t d);
    keep_direction = {COMPONENT_W'(d.x >>> DIRECTION_ZEROS), COMPONENT_W'(d.y >>> DIRECTION_ZEROS), COMPONENT_W'(d.z >>> DIRECTION_ZEROS)};
  endfunction
  function automatic direction_t whole_direction(input kept_direction_t d);
    whole_direction = {31'(d.x) << DIRECTION_ZEROS, 31'(d.y) << DIRECTION_ZEROS, 31'(d.z) << DIRECTION_ZEROS};
  endfunction

  // Constants of a ray as a context keeps them.
  localparam int unsigned KEPT_D_W = 30 - DIRECTION_ZEROS;
  localparam int unsigned MOMENT_ZEROS = COORDINATE_ZEROS + DIRECTION_ZEROS;
  localparam int unsigned KEPT_MOMENT_W = 63 - MOMENT_ZEROS;
  typedef struct packed {
    logic mirror;
    logic [KEPT_D_W-1:0] d;
    logic [COORDINATE_W-1:0] origin;
    logic signed [16:0] ceil;
    reciprocal_t reciprocal;
  } kept_axis_t;
  typedef struct packed {
    kept_axis_t x;
    kept_axis_t y;
    kept_axis_t z;
    logic [2:0][KEPT_MOMENT_W-1:0] moment;
  } kept_setup_t;
  function automatic kept_axis_t keep_axis(input axis_t a);
    keep_axis = {a.mirror, KEPT_D_W'(a.d >> DIRECTION_ZEROS), COORDINATE_W'(a.origin >>> COORDINATE_ZEROS), a.ceil, a.reciprocal};
  endfunction
  function automatic axis_t whole_axis(input kept_axis_t a);
    whole_axis = {a.mirror, 30'(a.d) << DIRECTION_ZEROS, 32'(a.origin) << COORDINATE_ZEROS, a.ceil, a.reciprocal};
  endfunction
  function automatic kept_setup_t keep_setup(input ray_setup_out_t r);
    keep_setup = {keep_axis(r.x), keep_axis(r.y), keep_axis(r.z), KEPT_MOMENT_W'(r.moment.x >>> MOMENT_ZEROS),
                  KEPT_MOMENT_W'(r.moment.y >>> MOMENT_ZEROS), KEPT_MOMENT_W'(r.moment.z >>> MOMENT_ZEROS)};
  endfunction
  function automatic ray_setup_out_t whole_setup(input kept_setup_t r);
    whole_setup = {whole_axis(r.x), whole_axis(r.y), whole_axis(r.z), 63'(r.moment[2]) << MOMENT_ZEROS, 63'(r.moment[1]) << MOMENT_ZEROS, 63'(r.moment[0]) << MOMENT_ZEROS};
  endfunction

  // A corner or an inserted vertex where no model has one: beyond the largest coordinate, or not on a grid of so many zero bits, 16 at most.
  function automatic logic misplaced(input point_t p, input logic [4:0] zeros);
    logic signed [31:0] most;
    logic [15:0] off_grid;
    most      = $signed(32'(COORD_LIMIT));
    off_grid  = (p.x[15:0] | p.y[15:0] | p.z[15:0]) & ~(16'hFFFF << zeros);
    misplaced = off_grid != '0 || p.x > most || p.x < -most || p.y > most || p.y < -most || p.z > most || p.z < -most;
  endfunction

  // A corner as seen from an origin.
  function automatic logic [3*RELATIVE_W-1:0] relative_corner(input kept_point_t p, input kept_point_t x);
    relative_corner = {RELATIVE_W'(p.x) - RELATIVE_W'(x.x), RELATIVE_W'(p.y) - RELATIVE_W'(x.y), RELATIVE_W'(p.z) - RELATIVE_W'(x.z)};
  endfunction

  // The same with all bits, for rays from exact starts and their viewers.
  function automatic logic [3*WHOLE_RELATIVE_W-1:0] whole_relative(input point_t p, input point_t x);
    whole_relative = {WHOLE_RELATIVE_W'(p.x) - WHOLE_RELATIVE_W'(x.x), WHOLE_RELATIVE_W'(p.y) - WHOLE_RELATIVE_W'(x.y),
                      WHOLE_RELATIVE_W'(p.z) - WHOLE_RELATIVE_W'(x.z)};
  endfunction

  // Kinds of stack entries.
  localparam logic [1:0] ENTRY_BVH_NODE = 2'd0;
  localparam logic [1:0] ENTRY_TREE = 2'd1;
  localparam logic [1:0] ENTRY_TREE_NODE = 2'd2;

  // They as they are kept: indices of this hardware's bits, and level and codes only where trees have nodes.
  localparam int unsigned WIDE_ENTRY_W = STACK_ENTRY_W - 28 + INDEX_W;
  function automatic logic [KEPT_ENTRY_W-1:0] keep_entry(input stack_entry_t e);
    keep_entry = KEPT_ENTRY_W'({e.level, e.e0, e.e1, e.e2, e.t_near, e.kind, INDEX_W'(e.index)});
  endfunction
  function automatic stack_entry_t whole_entry(input logic [KEPT_ENTRY_W-1:0] kept);
    logic [WIDE_ENTRY_W-1:0] wide;
    wide = WIDE_ENTRY_W'(kept);
    whole_entry = {wide[INDEX_W+2 +: T_NEAR_W], wide[INDEX_W +: 2], wide[WIDE_ENTRY_W-1 -: 4], 28'(wide[INDEX_W-1:0]), wide[INDEX_W+2+T_NEAR_W +: 3*BOUND_CODE_W]};
  endfunction

  // What a division is for.
  localparam logic [1:0] DIVIDE_FOR_T = 2'd0;
  localparam logic [1:0] DIVIDE_FOR_V = 2'd1;
  localparam logic [1:0] DIVIDE_FOR_W = 2'd2;

  // Tags within the unit: a context's number, and two bits of a triangle's number or of a line's place; a division's has what it is for in front, a line's the epoch behind.
  localparam int unsigned PLACE_TAG_W = CONTEXT_W + 2;
  localparam int unsigned DIVIDE_TAG_W = 2 + PLACE_TAG_W;
  localparam int unsigned FETCH_TAG_W = PLACE_TAG_W + EPOCH_W;

  // A hit on its way to the closest.
  typedef struct packed {
    below_t below;                // What its numerators have below whole numbers: 0 where all rays start at whole points, and kept nowhere.
    logic [CONTEXT_W-1:0] owner;  // Its context.
    logic [1:0] number;           // Which of the context's triangles.
    tri_test_out_t test;          // Its numerators.
  } queued_hit_t;
  localparam int unsigned QUEUED_HIT_W = BELOW_W + CONTEXT_W + 2 + TRI_TEST_OUT_W;
  localparam int unsigned KEPT_HIT_W = QUEUED_HIT_W - (1 - SECONDARY) * BELOW_W;

  // The hit port's word, with the corners of the triangle in front where rays can start on it.
  localparam int unsigned TOLD_W = HIT_OUT_W + SECONDARY * CORNERS_W;

endpackage

`default_nettype wire
