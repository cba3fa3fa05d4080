`default_nettype none

/// The LOD test where another ray may decide about each edge (paper section 3.8): each edge as lod_test has it for the ray that decides about it. Twin of
/// src/block/lod_test_by.rs.
///
/// by[k]: who decides about edge k, 0 the ray, 1 and 2 its viewers. Both ends of an edge are taken along its own viewer: six distances where one ray has three.
/// Legal as in lod_test, for all three rays; by[k] <= 2. The whole of every coordinate and direction is taken: rays from a surface have no zeros to leave out.
/// EDGES_PER_CYCLE = 3: latency LOD_TEST_BY_3_LATENCY, interval 1; 78 multipliers. 1: latency LOD_TEST_BY_1_LATENCY, interval LOD_TEST_BY_1_INTERVAL; 26.
module lod_test_by #(
  parameter int unsigned TAG_W = 8,
  parameter int unsigned EDGES_PER_CYCLE = lod_pkg::LOD_EDGES_PER_CYCLE
) (
  input  logic                      clk_i,
  input  logic                      rst_ni,
  input  logic                      valid_i,
  output logic                      ready_o,
  input  lod_pkg::lod_test_by_in_t  in_i,
  input  logic [TAG_W-1:0]          tag_i,
  output logic                      valid_o,
  input  logic                      ready_i,
  output lod_pkg::lod_test_out_t    out_o,
  output logic [TAG_W-1:0]          tag_o
);

  localparam int unsigned V_W = 3 * lod_pkg::WHOLE_RELATIVE_W;
  localparam int unsigned S_W = lod_pkg::EDGE_STATE_W;
  localparam int unsigned EDGE_W = 2 * V_W + lod_pkg::DIRECTION_W + lod_pkg::CONE_W + lod_pkg::BOUND_CODE_W;
  localparam int unsigned EDGE_LATENCY = lod_pkg::LOD_EDGE_BY_LATENCY;
  // Stages of an edge that are a `pipe_skid`: what goes beside it has its own there.
  localparam int unsigned ALONG_LATENCY = lod_pkg::dot_product_latency(V_W / 3, lod_pkg::DIRECTION_W / 3);
  localparam logic [63:0] EDGE_SKIDS = 64'd1 << (ALONG_LATENCY - 3) | 64'd1 << ALONG_LATENCY | 64'd1 << (EDGE_LATENCY - lod_pkg::EDGE_OPENING_LATENCY);

  if (lod_pkg::LOD_TEST_BY_3_LATENCY != EDGE_LATENCY + 2) begin : g_illegal_latency
    $error("lod_test_by: lod_pkg::LOD_TEST_BY_3_LATENCY must be %0d", EDGE_LATENCY + 2);
  end
  if (lod_pkg::LOD_TEST_BY_1_LATENCY != EDGE_LATENCY + 4 || lod_pkg::LOD_TEST_BY_1_INTERVAL != 3) begin : g_illegal_timing
    $error("lod_test_by: edges in turn make lod_pkg::LOD_TEST_BY_1_LATENCY %0d and LOD_TEST_BY_1_INTERVAL 3", EDGE_LATENCY + 4);
  end

  // The edges: their ends as their viewers see them, those's directions and cones, the codes.
  logic [2:0][lod_pkg::POINT_W-1:0]      corner;
  logic [2:0][lod_pkg::BOUND_CODE_W-1:0] codes;
  logic [2:0][EDGE_W-1:0]                edges;
  assign corner = {in_i.p2, in_i.p1, in_i.p0};
  assign codes  = {in_i.e2, in_i.e1, in_i.e0};
  for (genvar k = 0; k < 3; k++) begin : g_viewer
    lod_pkg::ray_t viewer;
    assign viewer   = in_i.by[k] == 2'd0 ? in_i.ray : in_i.by[k] == 2'd1 ? in_i.first : in_i.second;
    assign edges[k] = {lod_pkg::whole_relative(corner[(k+1)%3], viewer.origin), lod_pkg::whole_relative(corner[(k+2)%3], viewer.origin),
                       viewer.direction, viewer.cone, codes[k]};
  end

  logic                valid_edges, ready_edges, open;
  logic [2:0][S_W-1:0] s;
  logic [TAG_W-1:0]    tag;
  if (EDGES_PER_CYCLE == 3) begin : g_parallel
    logic [3*EDGE_W-1:0]   edges_q;
    lod_pkg::bound_scale_t scale_q;
    logic                  valid_taken, ready_taken;
    logic [2:0]            ready_edge, valid_edge, opens;
    pipe_stage #(.W(3 * EDGE_W + lod_pkg::BOUND_SCALE_W)) u_taken (
      .clk_i, .rst_ni, .valid_i, .ready_o, .data_i({edges, in_i.scale}),
      .valid_o(valid_taken), .ready_i(ready_taken), .data_o({edges_q, scale_q})
    );
    for (genvar k = 0; k < 3; k++) begin : g_edge
      logic [V_W-1:0]                   a, b;
      lod_pkg::direction_t              direction;
      lod_pkg::cone_t                   cone;
      logic [lod_pkg::BOUND_CODE_W-1:0] code;
      assign {a, b, direction, cone, code} = edges_q[k*EDGE_W +: EDGE_W];
      lod_edge_by u_edge (
        .clk_i, .rst_ni, .valid_i(valid_taken), .ready_o(ready_edge[k]), .a_i(a), .b_i(b), .direction_i(direction), .cone_i(cone),
        .code_i(code), .scale_i(scale_q), .valid_o(valid_edge[k]), .ready_i(ready_edges), .open_o(opens[k]), .s_o(s[k])
      );
    end
    pipe_delay #(.W(TAG_W), .STAGES(1 + EDGE_LATENCY), .SKIDS(EDGE_SKIDS << 1)) u_tag (
      .clk_i, .rst_ni, .valid_i, .ready_o(), .data_i(tag_i), .valid_o(), .ready_i(ready_edges), .data_o(tag)
    );
    assign ready_taken = ready_edge[0];
    assign valid_edges = valid_edge[0];
    assign open        = opens != '0;

    logic unused_lockstep;
    assign unused_lockstep = ^{ready_edge[2:1], valid_edge[2:1]};
  end else if (EDGES_PER_CYCLE == 1) begin : g_serial
    // The triangle under way: its edges move up with each pass, and it makes room with the last one.
    localparam int unsigned PASS_W = 2;
    logic [3*EDGE_W-1:0]   edges_q;
    lod_pkg::bound_scale_t scale_q;
    logic [TAG_W-1:0]      tag_q;
    logic                  busy, ready_pass;
    logic [PASS_W-1:0]     pass;
    three_passes u_passes (.clk_i, .rst_ni, .valid_i, .ready_o, .busy_o(busy), .ready_i(ready_pass), .pass_o(pass));
    always_ff @(posedge clk_i) begin
      if (ready_o && valid_i) {edges_q, scale_q, tag_q} <= {edges, in_i.scale, tag_i};
      else if (ready_pass) edges_q[2*EDGE_W-1:0] <= edges_q[3*EDGE_W-1:EDGE_W];
    end

    logic [V_W-1:0]                   a, b;
    lod_pkg::direction_t              direction;
    lod_pkg::cone_t                   cone;
    logic [lod_pkg::BOUND_CODE_W-1:0] code;
    logic                             valid_state, ready_state, open_state;
    logic [S_W-1:0]                   state;
    assign {a, b, direction, cone, code} = edges_q[EDGE_W-1:0];
    lod_edge_by u_edge (
      .clk_i, .rst_ni, .valid_i(busy), .ready_o(ready_pass), .a_i(a), .b_i(b), .direction_i(direction), .cone_i(cone),
      .code_i(code), .scale_i(scale_q), .valid_o(valid_state), .ready_i(ready_state), .open_o(open_state), .s_o(state)
    );
    logic [PASS_W-1:0] pass_state;
    pipe_delay #(.W(PASS_W + TAG_W), .STAGES(EDGE_LATENCY), .SKIDS(EDGE_SKIDS)) u_tag (
      .clk_i, .rst_ni, .valid_i(busy), .ready_o(), .data_i({pass, tag_q}),
      .valid_o(), .ready_i(ready_state), .data_o({pass_state, tag})
    );

    // The first two states wait for the third.
    logic           last_state, open0_q, open1_q;
    logic [S_W-1:0] s0_q, s1_q;
    assign last_state  = pass_state == 2;
    assign valid_edges = valid_state && last_state;
    assign ready_state = ready_edges || !last_state;
    always_ff @(posedge clk_i) begin
      if (valid_state && !last_state) {open0_q, s0_q, open1_q, s1_q} <= {open1_q, s1_q, open_state, state};
    end
    assign open = open0_q || open1_q || open_state;
    assign s    = {state, s1_q, s0_q};
  end else begin : g_illegal_edges
    $error("lod_test_by: EDGES_PER_CYCLE = %0d, must be 1 or 3", EDGES_PER_CYCLE);
  end

  pipe_stage #(.W(lod_pkg::LOD_TEST_OUT_W + TAG_W)) u_out (
    .clk_i, .rst_ni, .valid_i(valid_edges), .ready_o(ready_edges), .data_i({open, s[0], s[1], s[2], tag}),
    .valid_o, .ready_i, .data_o({out_o, tag_o})
  );

endmodule

`default_nettype wire
