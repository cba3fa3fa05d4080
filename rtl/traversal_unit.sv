`default_nettype none

/// The traversal loop of the paper's figure 9 for several rays at once: rays in, memory lines in, closest hits out.
///
/// `CONTEXTS` ray contexts (state machines) share one of each block; docs/traversal-unit.md gives every state, arbitration and port rule, and
/// `src/sim/unit` is the cycle model. A result always has a place, so no block ever waits for its consumer; only the memory and hit ports stall.
/// Between contexts and blocks, and from memory's answers to contexts, are wires, or `lod_pkg::LINK_REGISTERS` registers.
/// Memory: one 32-byte line a request, any latency and order of answers, at most two outstanding a ray; answers are always taken.
/// Hits: smaller t first, then smaller triangle; every field as at full resolution (paper section 3.6).
/// Every ray that is taken gives exactly one hit, whatever memory holds or does; one that cannot go on gives an error (docs/integration.md).
module traversal_unit #(
  parameter int unsigned CONTEXTS = lod_pkg::CONTEXTS,
  parameter int unsigned EDGES_PER_CYCLE = lod_pkg::EDGES_PER_CYCLE,
  // Counters and a look into each context; a parity bit in every memory; clocks of blocks and contexts that stand still while nothing is to do.
  parameter int unsigned WATCH = 0,
  parameter int unsigned MEMORY_PARITY = 0,
  parameter int unsigned CLOCK_GATES = 0
) (
  input  logic                     clk_i,
  input  logic                     rst_ni,
  input  lod_pkg::scene_config_t   scene_i,
  input  logic                     flush_i,
  output logic                     busy_o,
  // For test and debugging: pins of memories, and whether one gave another word than it took; the context looked at, and what it is doing; counters.
  input  lod_pkg::memory_test_t    memory_test_i,
  output logic                     memory_fault_o,
  input  logic [5:0]               view_context_i,
  output lod_pkg::context_view_t   view_o,
  input  logic                     counters_clear_i,
  output lod_pkg::unit_counters_t  counters_o,
  input  logic                     valid_i,
  output logic                     ready_o,
  input  lod_pkg::ray_in_t         in_i,
  input  lod_pkg::secondary_in_t   secondary_i,
  output logic                     valid_o,
  input  logic                     ready_i,
  output lod_pkg::hit_out_t        out_o,
  output lod_pkg::corners_t        corners_o,
  output logic                     mem_valid_o,
  input  logic                     mem_ready_i,
  output lod_pkg::memory_request_t mem_o,
  input  logic                     mem_valid_i,
  output logic                     mem_ready_o,
  input  lod_pkg::memory_answer_t  mem_i
);

  localparam int unsigned N = CONTEXTS;
  localparam int unsigned CONTEXT_W = lod_pkg::CONTEXT_W;
  localparam bit WATCHED = WATCH != 0;
  localparam bit PARITY = MEMORY_PARITY != 0;
  localparam bit GATED = CLOCK_GATES != 0;
  localparam bit SECONDARY = lod_pkg::SECONDARY != 0;
  localparam bit DECIDING = SECONDARY && lod_pkg::LOD_TEST != 0;

  if (CONTEXTS < 1 || CONTEXTS > lod_pkg::MAX_CONTEXTS) begin : g_illegal_contexts
    $error("traversal_unit: CONTEXTS = %0d, must be 1 to %0d", CONTEXTS, lod_pkg::MAX_CONTEXTS);
  end
  if (lod_pkg::DIVIDE_INTERVAL <= lod_pkg::HIT_SELECT_LATENCY) begin : g_illegal_latency
    $error("traversal_unit: two hits would meet in hit_select");
  end

  // ---- Rays in: the free context of the lowest number ----

  logic [N-1:0] idle, free, take;

  assign ready_o = free != '0;
  assign take    = valid_i ? free & (~free + N'(1)) : '0;
  // A ray that ended early has left node_address two cycles before its hit leaves, or what it asked for waits at the port.
  assign busy_o  = idle != '1 || valid_o || mem_valid_o;

  // ---- Is the scene one for this hardware? ----

  logic       fits;
  logic [5:0] zeros;
  assign zeros = 6'(scene_i.levels) + 6'(scene_i.zeros);
  assign fits  = scene_i.levels <= 4'(lod_pkg::SCENE_LEVELS) && 6'(scene_i.zeros) + 6'd1 > 6'(lod_pkg::COORDINATE_ZEROS) && zeros <= 6'(lod_pkg::BOX_SHIFT)
              && (scene_i.compact ? lod_pkg::COMPACT_VERTICES != 0 : lod_pkg::EXACT_VERTICES != 0)
              && scene_i.scale.offset <= lod_pkg::BOUND_SCALE_W'(lod_pkg::MAX_BOUND_OFFSET);

  // ---- Ticks of the limit of answers, the same for all contexts: what is waited for through two of them is late ----

  logic                               tick;
  logic [lod_pkg::ANSWER_LIMIT_W-1:0] ticks_q;
  assign tick = ticks_q >= scene_i.answer_limit;

  // An age of ticks: what a context rests for has come by then, or comes no more.
  logic                         age;
  logic [lod_pkg::BEHIND_W-1:0] age_ticks_q;
  assign age = tick && age_ticks_q == '1;

  always_ff @(posedge clk_i) begin
    if (!rst_ni || tick) ticks_q <= '0;
    else ticks_q <= ticks_q + lod_pkg::ANSWER_LIMIT_W'(1);
    if (!rst_ni) age_ticks_q <= '0;
    else if (tick) age_ticks_q <= age_ticks_q + lod_pkg::BEHIND_W'(1);
  end

  // ---- Requests of the contexts, and the winners' operands ----

  logic [N-1:0] setup_request, setup_grant, setup_for;
  logic [N-1:0][lod_pkg::START_SETUP_IN_W-1:0] setup_data;
  logic setup_clk, setup_in_valid, setup_in_ready, setup_made_valid;
  lod_pkg::start_setup_in_t setup_in;
  lod_pkg::ray_setup_out_t setup_made, setup_out;
  logic [CONTEXT_W-1:0] setup_in_tag, setup_made_tag;

  station #(.N(N), .IN_W(lod_pkg::START_SETUP_IN_W), .OUT_W(lod_pkg::RAY_SETUP_OUT_W), .INTERVAL(lod_pkg::SETUP_INTERVAL), .CLOCK_GATES(GATED)) u_setup_station (
    .clk_i, .rst_ni,
    .request_i(setup_request), .data_i(setup_data), .grant_o(setup_grant), .for_o(setup_for), .valid_o(), .out_o(setup_out), .tag_o(),
    .block_clk_o(setup_clk), .block_valid_o(setup_in_valid), .block_ready_i(setup_in_ready), .block_data_o(setup_in), .block_index_o(setup_in_tag),
    .made_valid_i(setup_made_valid), .made_i(setup_made), .made_tag_i(setup_made_tag)
  );

  // Where all rays start at whole points, what the operands have for others is 0.
  setup_copies #(.TAG_W(CONTEXT_W)) u_setup (
    .clk_i(setup_clk), .rst_ni,
    .valid_i(setup_in_valid), .ready_o(setup_in_ready), .in_i(setup_in), .tag_i(setup_in_tag),
    .valid_o(setup_made_valid), .out_o(setup_made), .tag_o(setup_made_tag)
  );

  logic [N-1:0] child_request, child_grant, child_for;
  logic [N-1:0][lod_pkg::CHILD_TEST_IN_W-1:0] child_data;
  logic child_clk, child_in_valid, child_in_ready, child_made_valid;
  lod_pkg::child_test_in_t child_in;
  lod_pkg::child_test_out_t child_made, child_out;
  logic [CONTEXT_W-1:0] child_in_tag, child_made_tag;

  station #(.N(N), .IN_W(lod_pkg::CHILD_TEST_IN_W), .OUT_W(lod_pkg::CHILD_TEST_OUT_W), .INTERVAL(4 / lod_pkg::BOXES_PER_CYCLE), .CLOCK_GATES(GATED)) u_child_station (
    .clk_i, .rst_ni,
    .request_i(child_request), .data_i(child_data), .grant_o(child_grant), .for_o(child_for), .valid_o(), .out_o(child_out), .tag_o(),
    .block_clk_o(child_clk), .block_valid_o(child_in_valid), .block_ready_i(child_in_ready), .block_data_o(child_in), .block_index_o(child_in_tag),
    .made_valid_i(child_made_valid), .made_i(child_made), .made_tag_i(child_made_tag)
  );

  child_test #(.TAG_W(CONTEXT_W)) u_child_test (
    .clk_i(child_clk), .rst_ni,
    .valid_i(child_in_valid), .ready_o(child_in_ready), .in_i(child_in), .tag_i(child_in_tag),
    .valid_o(child_made_valid), .ready_i(1'b1), .out_o(child_made), .tag_o(child_made_tag)
  );

  logic [N-1:0] decide_request, decide_grant, decide_for;
  logic decide_clk, decide_in_valid, decide_in_ready;
  lod_pkg::tree_deciders_in_t decide_in;
  logic [CONTEXT_W-1:0] decide_in_tag;
  logic [N-1:0][lod_pkg::TREE_DECIDERS_IN_W-1:0] decide_data;
  logic decide_made_valid;
  lod_pkg::tree_deciders_out_t decide_made, decide_out;
  logic [CONTEXT_W-1:0] decide_made_tag;

  station #(.N(N), .IN_W(lod_pkg::TREE_DECIDERS_IN_W), .OUT_W(lod_pkg::TREE_DECIDERS_OUT_W), .INTERVAL(1), .CLOCK_GATES(GATED)) u_decide_station (
    .clk_i, .rst_ni,
    .request_i(decide_request), .data_i(decide_data), .grant_o(decide_grant), .for_o(decide_for), .valid_o(), .out_o(decide_out), .tag_o(),
    .block_clk_o(decide_clk), .block_valid_o(decide_in_valid), .block_ready_i(decide_in_ready), .block_data_o(decide_in), .block_index_o(decide_in_tag),
    .made_valid_i(decide_made_valid), .made_i(decide_made), .made_tag_i(decide_made_tag)
  );

  if (DECIDING) begin : g_deciders
    tree_deciders #(.TAG_W(CONTEXT_W)) u_tree_deciders (
      .clk_i(decide_clk), .rst_ni,
      .valid_i(decide_in_valid), .ready_o(decide_in_ready), .in_i(decide_in), .tag_i(decide_in_tag),
      .valid_o(decide_made_valid), .ready_i(1'b1), .out_o(decide_made), .tag_o(decide_made_tag)
    );
  end else begin : g_no_deciders
    logic unused_decide;
    assign {decide_in_ready, decide_made_valid, decide_made, decide_made_tag} = '0;
    assign unused_decide = ^{decide_clk, decide_in_valid, decide_in, decide_in_tag};
  end

  logic [N-1:0] lod_request, lod_grant, lod_for;
  logic [N-1:0][lod_pkg::LOD_TEST_BY_IN_W-1:0] lod_data;
  logic lod_clk, lod_in_valid, lod_in_ready, lod_made_valid;
  lod_pkg::lod_test_by_in_t lod_in;
  lod_pkg::lod_test_out_t lod_made, lod_out;
  logic [CONTEXT_W-1:0] lod_in_tag, lod_made_tag;

  station #(.N(N), .IN_W(lod_pkg::LOD_TEST_BY_IN_W), .OUT_W(lod_pkg::LOD_TEST_OUT_W), .INTERVAL(3 / lod_pkg::LOD_EDGES_PER_CYCLE), .CLOCK_GATES(GATED)) u_lod_station (
    .clk_i, .rst_ni,
    .request_i(lod_request), .data_i(lod_data), .grant_o(lod_grant), .for_o(lod_for), .valid_o(), .out_o(lod_out), .tag_o(),
    .block_clk_o(lod_clk), .block_valid_o(lod_in_valid), .block_ready_i(lod_in_ready), .block_data_o(lod_in), .block_index_o(lod_in_tag),
    .made_valid_i(lod_made_valid), .made_i(lod_made), .made_tag_i(lod_made_tag)
  );

  if (DECIDING) begin : g_lod_test_by
    lod_test_by #(.TAG_W(CONTEXT_W)) u_lod_test_by (
      .clk_i(lod_clk), .rst_ni,
      .valid_i(lod_in_valid), .ready_o(lod_in_ready), .in_i(lod_in), .tag_i(lod_in_tag),
      .valid_o(lod_made_valid), .ready_i(1'b1), .out_o(lod_made), .tag_o(lod_made_tag)
    );
  end else if (lod_pkg::LOD_TEST != 0) begin : g_lod_test
    lod_pkg::lod_test_in_t own_in;
    logic unused_others;
    always_comb begin
      own_in.ray   = lod_in.ray;
      own_in.p0    = lod_in.p0;
      own_in.p1    = lod_in.p1;
      own_in.p2    = lod_in.p2;
      own_in.e0    = lod_in.e0;
      own_in.e1    = lod_in.e1;
      own_in.e2    = lod_in.e2;
      own_in.scale = lod_in.scale;
    end
    assign unused_others = ^{lod_in.first, lod_in.second, lod_in.by};
    lod_test #(.TAG_W(CONTEXT_W)) u_lod_test (
      .clk_i(lod_clk), .rst_ni,
      .valid_i(lod_in_valid), .ready_o(lod_in_ready), .in_i(own_in), .tag_i(lod_in_tag),
      .valid_o(lod_made_valid), .ready_i(1'b1), .out_o(lod_made), .tag_o(lod_made_tag)
    );
  end else begin : g_no_lod_test
    logic unused_lod;
    assign {lod_in_ready, lod_made_valid, lod_made, lod_made_tag} = '0;
    assign unused_lod = ^{lod_clk, lod_in_valid, lod_in, lod_in_tag};
  end

  // The vertices are taken out of their line once the context is chosen.
  localparam int unsigned MORPH_OWN_W = lod_pkg::TESSELLATE_IN_W - 3 * lod_pkg::POINT_W;
  localparam int unsigned MORPH_LINE_W = 3 * lod_pkg::STORED_POINT_W;
  localparam int unsigned MORPH_W = MORPH_OWN_W + MORPH_LINE_W + 3;

  logic [N-1:0] morph_request, morph_grant, morph_for;
  logic [N-1:0][MORPH_W-1:0] morph_data;
  logic [MORPH_OWN_W-1:0] morph_own;
  logic [MORPH_LINE_W-1:0] morph_line;
  logic morph_short;
  logic [1:0] morph_place;
  logic morph_clk, morph_in_valid, morph_in_ready, morph_made_valid;
  lod_pkg::tessellate_in_t morph_in;
  lod_pkg::tessellate_out_t morph_made, morph_out;
  logic [CONTEXT_W-1:0] morph_in_tag, morph_made_tag;

  station #(.N(N), .IN_W(MORPH_W), .OUT_W(lod_pkg::TESSELLATE_OUT_W), .INTERVAL(1), .CLOCK_GATES(GATED)) u_morph_station (
    .clk_i, .rst_ni,
    .request_i(morph_request), .data_i(morph_data), .grant_o(morph_grant), .for_o(morph_for), .valid_o(), .out_o(morph_out), .tag_o(),
    .block_clk_o(morph_clk), .block_valid_o(morph_in_valid), .block_ready_i(morph_in_ready), .block_data_o({morph_own, morph_line, morph_short, morph_place}), .block_index_o(morph_in_tag),
    .made_valid_i(morph_made_valid), .made_i(morph_made), .made_tag_i(morph_made_tag)
  );

  lod_pkg::vertex_data_t   inserted;
  lod_pkg::displacements_t halved, displacements;
  lod_pkg::short_displacements_t sibling;
  logic [1:0][lod_pkg::SHORT_DISPLACEMENTS_W-1:0] low_siblings, high_siblings;
  logic [3*lod_pkg::POINT_W-1:0] morph_vertices;
  assign inserted      = 256'(morph_line);
  assign halved        = 128'(morph_line >> (morph_place[0] ? 128 : 0));
  assign {high_siblings, low_siblings} = morph_line;
  assign sibling       = morph_place[1] ? high_siblings[morph_place[0]] : low_siblings[morph_place[0]];
  assign displacements = morph_short ? {11'd0, sibling.v0.x, 6'd0, sibling.v0.y, 6'd0, sibling.v0.z, 6'd0,
                                        sibling.v1.x, 6'd0, sibling.v1.y, 6'd0, sibling.v1.z, 6'd0,
                                        sibling.v2.x, 6'd0, sibling.v2.y, 6'd0, sibling.v2.z, 6'd0} : halved;
  always_comb begin
    // The first bit of the operands: displacements.
    if (morph_own[MORPH_OWN_W-1]) begin
      morph_vertices = {32'(displacements.v0.x), 32'(displacements.v0.y), 32'(displacements.v0.z),
                        32'(displacements.v1.x), 32'(displacements.v1.y), 32'(displacements.v1.z),
                        32'(displacements.v2.x), 32'(displacements.v2.y), 32'(displacements.v2.z)};
    end else begin
      morph_vertices = {inserted.v0.x, 4'd0, inserted.v0.y, 4'd0, inserted.v0.z, 4'd0,
                        inserted.v1.x, 4'd0, inserted.v1.y, 4'd0, inserted.v1.z, 4'd0,
                        inserted.v2.x, 4'd0, inserted.v2.y, 4'd0, inserted.v2.z, 4'd0};
    end
  end
  assign morph_in = {morph_own, morph_vertices};

  if (lod_pkg::STORED_LEVELS != 0) begin : g_tessellate
    tessellate #(.TAG_W(CONTEXT_W)) u_tessellate (
      .clk_i(morph_clk), .rst_ni,
      .valid_i(morph_in_valid), .ready_o(morph_in_ready), .in_i(morph_in), .tag_i(morph_in_tag),
      .valid_o(morph_made_valid), .ready_i(1'b1), .out_o(morph_made), .tag_o(morph_made_tag)
    );
  end else begin : g_no_tessellate
    logic unused_morph;
    assign {morph_in_ready, morph_made_valid, morph_made, morph_made_tag} = '0;
    assign unused_morph = ^{morph_clk, morph_in_valid, morph_in, morph_in_tag};
  end

  // What a context asks of the inserted vertices that come, as it keeps them: whether one is beyond the largest coordinate, and the bits that may have to be 0.
  lod_pkg::point_t come0, come1, come2;
  logic            morph_beyond;
  logic [15:0]     morph_bits;
  assign come0        = lod_pkg::whole_point(lod_pkg::keep_point(morph_out.g0));
  assign come1        = lod_pkg::whole_point(lod_pkg::keep_point(morph_out.g1));
  assign come2        = lod_pkg::whole_point(lod_pkg::keep_point(morph_out.g2));
  // On a grid of no zero bits they all are.
  assign morph_beyond = lod_pkg::misplaced(come0, 5'd0) || lod_pkg::misplaced(come1, 5'd0) || lod_pkg::misplaced(come2, 5'd0);
  assign morph_bits   = come0.x[15:0] | come0.y[15:0] | come0.z[15:0] | come1.x[15:0] | come1.y[15:0] | come1.z[15:0] | come2.x[15:0] | come2.y[15:0] | come2.z[15:0];

  logic [N-1:0] map_request, map_grant, map_for;
  logic [N-1:0][lod_pkg::BARY_MAP_IN_W-1:0] map_data;
  logic map_clk, map_in_valid, map_in_ready, map_made_valid;
  lod_pkg::bary_map_in_t map_in;
  lod_pkg::bary_map_out_t map_made, map_out;
  logic [CONTEXT_W-1:0] map_in_tag, map_made_tag;

  station #(.N(N), .IN_W(lod_pkg::BARY_MAP_IN_W), .OUT_W(lod_pkg::BARY_MAP_OUT_W), .INTERVAL(1), .CLOCK_GATES(GATED)) u_map_station (
    .clk_i, .rst_ni,
    .request_i(map_request), .data_i(map_data), .grant_o(map_grant), .for_o(map_for), .valid_o(), .out_o(map_out), .tag_o(),
    .block_clk_o(map_clk), .block_valid_o(map_in_valid), .block_ready_i(map_in_ready), .block_data_o(map_in), .block_index_o(map_in_tag),
    .made_valid_i(map_made_valid), .made_i(map_made), .made_tag_i(map_made_tag)
  );

  if (lod_pkg::HIT_MAPPING != 0) begin : g_bary_map
    bary_map #(.TAG_W(CONTEXT_W)) u_bary_map (
      .clk_i(map_clk), .rst_ni,
      .valid_i(map_in_valid), .ready_o(map_in_ready), .in_i(map_in), .tag_i(map_in_tag),
      .valid_o(map_made_valid), .ready_i(1'b1), .out_o(map_made), .tag_o(map_made_tag)
    );
  end else begin : g_no_bary_map
    logic unused_map;
    assign {map_in_ready, map_made_valid, map_made, map_made_tag} = '0;
    assign unused_map = ^{map_clk, map_in_valid, map_in, map_in_tag};
  end

  // ---- Memory: requests carry the place of their line and the epoch of their ray besides the operands ----

  localparam int unsigned FETCH_W = 1 + lod_pkg::EPOCH_W + lod_pkg::NODE_ADDRESS_IN_W;

  logic [N-1:0] fetch_request, fetch_grant;
  logic [N-1:0][FETCH_W-1:0] fetch_data;
  logic fetch_in_valid, fetch_in_ready, fetch_place;
  lod_pkg::node_address_in_t fetch_in;
  lod_pkg::node_address_out_t fetch_out;
  logic [CONTEXT_W-1:0] fetch_in_tag;
  logic [lod_pkg::EPOCH_W-1:0] fetch_in_epoch, fetch_epoch;
  logic [lod_pkg::PLACE_TAG_W-1:0] fetch_tag;

  shared_input #(.N(N), .W(FETCH_W)) u_fetch_input (
    .clk_i, .rst_ni,
    .request_i(fetch_request), .data_i(fetch_data), .grant_o(fetch_grant),
    .valid_o(fetch_in_valid), .ready_i(fetch_in_ready), .data_o({fetch_place, fetch_in_epoch, fetch_in}), .index_o(fetch_in_tag)
  );

  node_address #(.TAG_W(lod_pkg::FETCH_TAG_W)) u_node_address (
    .clk_i, .rst_ni,
    .valid_i(fetch_in_valid), .ready_o(fetch_in_ready), .in_i(fetch_in), .tag_i({fetch_in_tag, 1'b0, fetch_place, fetch_in_epoch}),
    .valid_o(mem_valid_o), .ready_i(mem_ready_i), .out_o(fetch_out), .tag_o({fetch_tag, fetch_epoch})
  );

  // Corners of an L0 record, in the line that comes: beyond the largest coordinate, or with fewer zero bits than levels and zeros.
  lod_pkg::kept_point_t corner0, corner1, corner2;
  logic                 line_misplaced;
  base_corners u_corners (.compact_i(scene_i.compact), .line_i(mem_i.line), .corner0_o(corner0), .corner1_o(corner1), .corner2_o(corner2));
  // 16 at most, in a scene that fits.
  assign line_misplaced = lod_pkg::misplaced(lod_pkg::whole_point(corner0), zeros[4:0]) || lod_pkg::misplaced(lod_pkg::whole_point(corner1), zeros[4:0])
                       || lod_pkg::misplaced(lod_pkg::whole_point(corner2), zeros[4:0]);

  logic                    line_valid, line_is_misplaced;
  lod_pkg::memory_answer_t line;
  shared_output #(.W(lod_pkg::MEMORY_ANSWER_W), .TAG_W(1)) u_line_output (
    .clk_i, .rst_ni,
    .valid_i(mem_valid_i), .out_i(mem_i), .tag_i(line_misplaced),
    .valid_o(line_valid), .out_o(line), .tag_o(line_is_misplaced)
  );

  // The same corners as contexts take them.
  lod_pkg::kept_point_t line_corner0, line_corner1, line_corner2;
  base_corners u_line_corners (
    .compact_i(scene_i.compact), .line_i(line.line), .corner0_o(line_corner0), .corner1_o(line_corner1), .corner2_o(line_corner2)
  );

  // The port has room for the number of any context that there can be.
  always_comb begin
    mem_o.tag     = 8'(fetch_tag);
    mem_o.epoch   = fetch_epoch;
    mem_o.address = fetch_out.address;
  end
  assign mem_ready_o = 1'b1;

  // ---- Triangles: the tag carries the triangle's number too ----

  localparam int unsigned TRI_W = 2 + lod_pkg::START_TEST_IN_W;

  logic [N-1:0] tri_request, tri_grant, tri_for;
  logic [N-1:0][TRI_W-1:0] tri_data;
  logic tri_clk, tri_in_valid, tri_in_ready, tri_made_valid, tri_valid;
  logic [1:0] tri_in_number, tri_number;
  lod_pkg::start_test_in_t tri_in;
  lod_pkg::tri_test_out_t tri_made, tri_out;
  lod_pkg::below_t tri_made_below, tri_below;
  logic [CONTEXT_W-1:0] tri_in_tag, tri_owner;
  logic [lod_pkg::PLACE_TAG_W-1:0] tri_made_tag;

  station #(.N(N), .IN_W(TRI_W), .OUT_W(lod_pkg::START_TEST_OUT_W), .TAG_W(lod_pkg::PLACE_TAG_W), .INTERVAL(3 / EDGES_PER_CYCLE), .EACH(4), .CLOCK_GATES(GATED)) u_tri_station (
    .clk_i, .rst_ni,
    .request_i(tri_request), .data_i(tri_data), .grant_o(tri_grant), .for_o(tri_for), .valid_o(tri_valid), .out_o({tri_out, tri_below}), .tag_o({tri_owner, tri_number}),
    .block_clk_o(tri_clk), .block_valid_o(tri_in_valid), .block_ready_i(tri_in_ready), .block_data_o({tri_in_number, tri_in}), .block_index_o(tri_in_tag),
    .made_valid_i(tri_made_valid), .made_i({tri_made, tri_made_below}), .made_tag_i(tri_made_tag)
  );

  if (SECONDARY) begin : g_start_test
    start_test #(.TAG_W(lod_pkg::PLACE_TAG_W), .EDGES_PER_CYCLE(EDGES_PER_CYCLE)) u_start_test (
      .clk_i(tri_clk), .rst_ni,
      .valid_i(tri_in_valid), .ready_o(tri_in_ready), .in_i(tri_in), .tag_i({tri_in_tag, tri_in_number}),
      .valid_o(tri_made_valid), .ready_i(1'b1), .out_o({tri_made, tri_made_below}), .tag_o(tri_made_tag)
    );
  end else begin : g_tri_test
    lod_pkg::tri_test_in_t whole_in;
    logic unused_fraction;
    always_comb begin
      whole_in.origin    = tri_in.start.point;
      whole_in.direction = tri_in.direction;
      whole_in.p0        = tri_in.p0;
      whole_in.p1        = tri_in.p1;
      whole_in.p2        = tri_in.p2;
    end
    assign unused_fraction = ^tri_in.start.fraction;
    assign tri_made_below  = '0;
    tri_test #(.TAG_W(lod_pkg::PLACE_TAG_W), .EDGES_PER_CYCLE(EDGES_PER_CYCLE)) u_tri_test (
      .clk_i(tri_clk), .rst_ni,
      .valid_i(tri_in_valid), .ready_o(tri_in_ready), .in_i(whole_in), .tag_i({tri_in_tag, tri_in_number}),
      .valid_o(tri_made_valid), .ready_i(1'b1), .out_o(tri_made), .tag_o(tri_made_tag)
    );
  end

  // ---- Hits wait for their division ----

  logic queue_pop, queue_empty, queue_fault;
  lod_pkg::queued_hit_t head, compared, chosen;
  logic [lod_pkg::KEPT_HIT_W-1:0] kept_head, chosen_q;

  assign head   = lod_pkg::QUEUED_HIT_W'(kept_head);
  assign chosen = lod_pkg::QUEUED_HIT_W'(chosen_q);

  hit_queue #(.W(lod_pkg::KEPT_HIT_W), .DEPTH(4 * CONTEXTS), .PARITY(PARITY)) u_queue (
    .clk_i, .rst_ni, .test_i(memory_test_i),
    .push_i(tri_valid && tri_out.hit), .data_i(lod_pkg::KEPT_HIT_W'({tri_below, tri_owner, tri_number, tri_out})),
    .pop_i(queue_pop), .data_o(kept_head), .empty_o(queue_empty), .fault_o(queue_fault)
  );

  // ---- Divisions: waiting hits first, then barycentrics of finished rays ----

  localparam int unsigned DIVIDE_W = 2 + lod_pkg::START_DIVIDE_IN_W;

  logic [N-1:0] divide_request, divide_grant;
  logic [N-1:0][DIVIDE_W-1:0] divide_data;
  logic own_valid, divide_in_ready, divide_link_valid, divide_link_ready, divide_link_pop, divide_made_valid, divide_valid;
  logic [1:0] own_what, divide_what, divide_number;
  lod_pkg::start_divide_in_t own_in, divide_in, divide_link;
  lod_pkg::hit_divide_out_t divide_made, divide_out;
  logic [CONTEXT_W-1:0] own_tag, divide_owner;
  logic [lod_pkg::DIVIDE_TAG_W-1:0] divide_in_tag, divide_link_tag, divide_made_tag;
  logic [lod_pkg::KEPT_HIT_W-1:0] divide_link_hit, divide_made_hit, candidate;

  shared_input #(.N(N), .W(DIVIDE_W)) u_divide_input (
    .clk_i, .rst_ni,
    .request_i(divide_request), .data_i(divide_data), .grant_o(divide_grant),
    .valid_o(own_valid), .ready_i(divide_in_ready && queue_empty), .data_o({own_what, own_in}), .index_o(own_tag)
  );

  lod_pkg::start_divide_in_t head_in;
  always_comb begin
    head_in.numerator   = head.test.t_num;
    head_in.low         = head.below.t;
    head_in.denominator = head.test.det;
  end
  assign divide_in     = queue_empty ? own_in : head_in;
  assign divide_in_tag = queue_empty ? {own_what, own_tag, 2'd0} : {lod_pkg::DIVIDE_FOR_T, head.owner, head.number};
  assign queue_pop     = divide_in_ready && !queue_empty;

  // The hit goes along, as far as the division.
  if (lod_pkg::LINK_REGISTERS != 0) begin : g_divide_register
    link_register #(.W(lod_pkg::START_DIVIDE_IN_W + lod_pkg::DIVIDE_TAG_W + lod_pkg::KEPT_HIT_W), .INTERVAL(lod_pkg::DIVIDE_INTERVAL)) u_register (
      .clk_i, .rst_ni,
      .valid_i(own_valid || !queue_empty), .ready_o(divide_in_ready), .data_i({divide_in, divide_in_tag, kept_head}),
      .valid_o(divide_link_valid), .ready_i(divide_link_ready), .data_o({divide_link, divide_link_tag, divide_link_hit})
    );
    assign divide_link_pop = divide_link_valid && divide_link_tag[lod_pkg::DIVIDE_TAG_W-1 -: 2] == lod_pkg::DIVIDE_FOR_T;
  end else begin : g_divide_wires
    assign divide_in_ready   = divide_link_ready;
    assign divide_link_valid = own_valid || !queue_empty;
    assign divide_link       = divide_in;
    assign divide_link_tag   = divide_in_tag;
    assign divide_link_hit   = kept_head;
    assign divide_link_pop   = queue_pop;
  end

  logic divide_clk;
  block_clock #(.MOST(lod_pkg::DIVIDE_COPIES), .GATED(GATED)) u_divide_clock (
    .clk_i, .rst_ni, .valid_i(divide_link_valid), .ready_i(divide_link_ready), .made_i(divide_made_valid), .clk_o(divide_clk)
  );

  divide_copies #(.TAG_W(lod_pkg::DIVIDE_TAG_W)) u_divide (
    .clk_i(divide_clk), .rst_ni,
    .valid_i(divide_link_valid), .ready_o(divide_link_ready), .in_i(divide_link), .tag_i(divide_link_tag),
    .keep_i(divide_link_pop), .with_i(divide_link_hit),
    .valid_o(divide_made_valid), .out_o(divide_made), .tag_o(divide_made_tag), .with_o(divide_made_hit)
  );

  shared_output #(.W(lod_pkg::HIT_DIVIDE_OUT_W + lod_pkg::KEPT_HIT_W), .TAG_W(lod_pkg::DIVIDE_TAG_W)) u_divide_output (
    .clk_i, .rst_ni,
    .valid_i(divide_made_valid), .out_i({divide_made, divide_made_hit}), .tag_i(divide_made_tag),
    .valid_o(divide_valid), .out_o({divide_out, candidate}), .tag_o({divide_what, divide_owner, divide_number})
  );

  // ---- Is it the closest? The hit follows its division, and then its comparison ----

  logic [N-1:0][lod_pkg::HIT_SELECT_IN_W-1:0] select_data;
  logic t_valid, select_valid;
  lod_pkg::hit_select_in_t select_in;
  lod_pkg::hit_select_out_t select_out;
  logic [CONTEXT_W-1:0] select_owner;
  logic [lod_pkg::RAY_T_W-1:0] chosen_t_q;

  assign compared = lod_pkg::QUEUED_HIT_W'(candidate);
  assign t_valid  = divide_valid && divide_what == lod_pkg::DIVIDE_FOR_T;

  always_comb begin
    select_in = '0;
    for (int unsigned k = 0; k < N; k++) begin
      if (t_valid && divide_owner == CONTEXT_W'(k)) select_in = select_in | select_data[k];
    end
  end

  hit_select #(.TAG_W(CONTEXT_W)) u_hit_select (
    .clk_i, .rst_ni,
    .valid_i(t_valid), .ready_o(), .in_i(select_in), .tag_i(divide_owner),
    .valid_o(select_valid), .ready_i(1'b1), .out_o(select_out), .tag_o(select_owner)
  );

  always_ff @(posedge clk_i) begin
    if (t_valid) begin
      chosen_q   <= candidate;
      chosen_t_q <= divide_out.quotient;
    end
  end

  // ---- Hits out ----

  logic [N-1:0] hit_request, hit_grant;
  logic [N-1:0][lod_pkg::HIT_OUT_W-1:0] hit_data;
  logic [N-1:0][lod_pkg::CORNERS_W-1:0] corners_data;
  logic [N-1:0][lod_pkg::TOLD_W-1:0] told_data;
  localparam int unsigned ALL_TOLD_W = lod_pkg::CORNERS_W + lod_pkg::HIT_OUT_W;
  logic hit_in_valid, hit_in_ready;
  lod_pkg::hit_out_t hit_in;
  lod_pkg::corners_t corners_in;
  lod_pkg::corners_t corners_told;
  lod_pkg::hit_out_t hit_told;
  logic [ALL_TOLD_W-1:0] told_in, told_out;
  logic [lod_pkg::TOLD_W-1:0] told_chosen, told_q;

  for (genvar k = 0; k < N; k++) begin : g_told
    assign told_data[k] = lod_pkg::TOLD_W'({corners_data[k], hit_data[k]});
  end

  shared_input #(.N(N), .W(lod_pkg::TOLD_W)) u_hit_input (
    .clk_i, .rst_ni,
    .request_i(hit_request), .data_i(told_data), .grant_o(hit_grant),
    .valid_o(hit_in_valid), .ready_i(hit_in_ready), .data_o(told_chosen), .index_o()
  );

  // All zero if nothing was met.
  assign told_in              = ALL_TOLD_W'(told_chosen);
  assign {corners_in, hit_in} = told_in;
  assign corners_told         = hit_in.found ? corners_in : lod_pkg::CORNERS_W'(0);
  always_comb begin
    hit_told.tag   = hit_in.tag;
    hit_told.error = hit_in.error;
    hit_told.found = hit_in.found;
    hit_told.hit   = hit_in.found ? hit_in.hit : lod_pkg::HIT_W'(0);
  end
  pipe_stage #(.W(lod_pkg::TOLD_W)) u_hit_stage (
    .clk_i, .rst_ni,
    .valid_i(hit_in_valid), .ready_o(hit_in_ready), .data_i(lod_pkg::TOLD_W'({corners_told, hit_told})),
    .valid_o, .ready_i, .data_o(told_q)
  );
  assign told_out           = ALL_TOLD_W'(told_q);
  assign {corners_o, out_o} = told_out;

  // ---- The contexts ----

  logic [N-1:0][lod_pkg::CONTEXT_VIEW_W-1:0] views;
  logic [N-1:0] context_faults;

  for (genvar k = 0; k < N; k++) begin : g_context
    localparam logic [CONTEXT_W-1:0] ME = CONTEXT_W'(k);

    // Idle, it looks at rays and at lines that come late; while it rests, at ages too.
    logic context_clk, line_comes;
    assign line_comes = line_valid && line.tag[7:2] == 6'(ME);
    clock_gate #(.GATED(GATED)) u_clock (.clk_i, .enable_i(!rst_ni || !idle[k] || !free[k] || take[k] || line_comes), .clk_o(context_clk));

    ray_context #(.WATCH(WATCHED), .MEMORY_PARITY(PARITY)) u_context (
      .clk_i(context_clk), .rst_ni, .memory_test_i, .scene_i, .fits_i(fits), .flush_i, .tick_i(tick), .age_i(age),
      .view_o(views[k]), .fault_o(context_faults[k]),
      .idle_o(idle[k]), .free_o(free[k]), .take_i(take[k]), .ray_i(in_i), .secondary_i,
      .setup_request_o(setup_request[k]), .setup_o(setup_data[k]), .setup_grant_i(setup_grant[k]),
      .setup_valid_i(setup_for[k]), .setup_i(setup_out),
      .child_request_o(child_request[k]), .child_o(child_data[k]), .child_grant_i(child_grant[k]),
      .child_valid_i(child_for[k]), .child_i(child_out),
      .decide_request_o(decide_request[k]), .decide_o(decide_data[k]), .decide_grant_i(decide_grant[k]),
      .decide_valid_i(decide_for[k]), .decide_i(decide_out),
      .lod_request_o(lod_request[k]), .lod_o(lod_data[k]), .lod_grant_i(lod_grant[k]),
      .lod_valid_i(lod_for[k]), .lod_i(lod_out),
      .morph_request_o(morph_request[k]), .morph_o(morph_data[k][MORPH_W-1:MORPH_LINE_W+3]), .morph_line_o(morph_data[k][MORPH_LINE_W+2:3]),
      .morph_short_o(morph_data[k][2]), .morph_place_o(morph_data[k][1:0]),
      .morph_grant_i(morph_grant[k]),
      .morph_valid_i(morph_for[k]), .morph_i(morph_out), .morph_beyond_i(morph_beyond), .morph_bits_i(morph_bits),
      .map_request_o(map_request[k]), .map_o(map_data[k]), .map_grant_i(map_grant[k]),
      .map_valid_i(map_for[k]), .map_i(map_out),
      .fetch_request_o(fetch_request[k]), .fetch_place_o(fetch_data[k][FETCH_W-1]),
      .fetch_epoch_o(fetch_data[k][FETCH_W-2 -: lod_pkg::EPOCH_W]),
      .fetch_o(fetch_data[k][lod_pkg::NODE_ADDRESS_IN_W-1:0]), .fetch_grant_i(fetch_grant[k]),
      .line_valid_i(line_comes), .line_i(line), .line_misplaced_i(line_is_misplaced),
      .line_corners_i({line_corner2, line_corner1, line_corner0}),
      .tri_request_o(tri_request[k]), .tri_number_o(tri_data[k][TRI_W-1:TRI_W-2]),
      .tri_o(tri_data[k][TRI_W-3:0]), .tri_grant_i(tri_grant[k]),
      .tri_miss_i(tri_for[k] && !tri_out.hit),
      .hit_number_i(divide_number), .hit_front_i(compared.test.front), .hit_t_i(divide_out.quotient), .select_o(select_data[k]),
      .select_valid_i(select_valid && select_owner == ME), .select_i(select_out),
      .chosen_t_i(chosen_t_q), .chosen_i(chosen),
      .divide_request_o(divide_request[k]), .divide_what_o(divide_data[k][DIVIDE_W-1:DIVIDE_W-2]),
      .divide_o(divide_data[k][DIVIDE_W-3:0]), .divide_grant_i(divide_grant[k]),
      .divide_valid_i(divide_valid && divide_owner == ME), .divide_what_i(divide_what), .divide_i(divide_out),
      .hit_request_o(hit_request[k]), .hit_o(hit_data[k]), .corners_o(corners_data[k]), .hit_grant_i(hit_grant[k])
    );
  end

  assign memory_fault_o = queue_fault || context_faults != '0;

  // ---- For who looks from outside ----

  if (WATCHED) begin : g_watch
    // The order of `Resource` in the cycle model: what `taken` and `refused` count.
    logic [9:0] asks, grants;
    assign asks   = {hit_request != '0, map_request != '0, divide_request != '0, tri_request != '0, morph_request != '0,
                     lod_request != '0, decide_request != '0, child_request != '0, fetch_request != '0, setup_request != '0};
    assign grants = {hit_grant != '0, map_grant != '0, divide_grant != '0, tri_grant != '0, morph_grant != '0,
                     lod_grant != '0, decide_grant != '0, child_grant != '0, fetch_grant != '0, setup_grant != '0};

    unit_counters u_counters (
      .clk_i, .rst_ni, .clear_i(counters_clear_i), .busy_i(busy_o),
      .ray_valid_i(valid_i), .ray_ready_i(ready_o),
      .hit_valid_i(valid_o), .hit_ready_i(ready_i), .hit_found_i(out_o.found), .hit_error_i(out_o.error != '0),
      .request_valid_i(mem_valid_o), .request_ready_i(mem_ready_i), .answer_valid_i(mem_valid_i), .compared_i(t_valid),
      .asks_i(asks), .grants_i(grants), .counters_o
    );

    always_comb begin
      view_o = '0;
      for (int unsigned k = 0; k < N; k++) begin
        if (view_context_i == 6'(k)) view_o = views[k];
      end
    end
  end else begin : g_no_watch
    logic unused_watch;
    assign unused_watch = ^{views, view_context_i, counters_clear_i};
    assign view_o       = '0;
    assign counters_o   = '0;
  end

endmodule

`default_nettype wire
