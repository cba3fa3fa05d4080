
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
