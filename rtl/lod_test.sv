`default_nettype none

/// Does a node's triangle serve this ray, and if not, how far do its edges open? (paper section 3.7) Twin of src/block/lod_test.rs.
///
/// Per edge (a, b) with bound h: l = floor(min((a-x).d, (b-x).d) / 2^30), D = clamp(floor((offset + l slope) / 2^shift), 0, 2^34 - 1);
/// s = 0 iff h <= D, s = 256 iff h >= 2D (and h > D), else clamp(floor((h-D) 256 / D), 1, 255). refine iff some s is not 0.
/// Legal: points and origin with |v| < 2^31, |d| <= 2^30 and each |d_i| < 2^30.
/// EDGES_PER_CYCLE = 3: latency LOD_TEST_3_LATENCY, interval 1; 42 multipliers. 1: latency LOD_TEST_1_LATENCY, interval LOD_TEST_1_INTERVAL; 14.
module lod_test #(
  parameter int unsigned TAG_W = 8,
  parameter int unsigned EDGES_PER_CYCLE = lod_pkg::LOD_EDGES_PER_CYCLE
) (
  input  logic                   clk_i,
  input  logic                   rst_ni,
  input  logic                   valid_i,
  output logic                   ready_o,
  input  lod_pkg::lod_test_in_t  in_i,
  input  logic [TAG_W-1:0]       tag_i,
  output logic                   valid_o,
  input  logic                   ready_i,
  output lod_pkg::lod_test_out_t out_o,
  output logic [TAG_W-1:0]       tag_o
);

  localparam int unsigned W = lod_pkg::RELATIVE_W;
  localparam int unsigned S_W = lod_pkg::EDGE_STATE_W;

  localparam int unsigned NEARER_LATENCY = 1 + lod_pkg::dot_product_latency(W, lod_pkg::COMPONENT_W) + 1;
  localparam int unsigned LATENCY = NEARER_LATENCY + lod_pkg::CONE_TOLERANCE_LATENCY + lod_pkg::EDGE_OPENING_LATENCY + 1;
  if (lod_pkg::LOD_TEST_3_LATENCY != LATENCY) begin : g_illegal_latency
    $error("lod_test: lod_pkg::LOD_TEST_3_LATENCY must be %0d", LATENCY);
  end
  if (lod_pkg::LOD_TEST_1_LATENCY != LATENCY + 5 || lod_pkg::LOD_TEST_1_INTERVAL != 3) begin : g_illegal_timing
    $error("lod_test: corners and edges in turn make lod_pkg::LOD_TEST_1_LATENCY %0d and LOD_TEST_1_INTERVAL 3", LATENCY + 5);
  end

  // Corners relative to the origin.
  lod_pkg::kept_point_t origin;
  logic [2:0][3*W-1:0]  corners;
  assign origin     = lod_pkg::keep_point(in_i.ray.origin);
  assign corners[0] = lod_pkg::relative_corner(lod_pkg::keep_point(in_i.p0), origin);
  assign corners[1] = lod_pkg::relative_corner(lod_pkg::keep_point(in_i.p1), origin);
  assign corners[2] = lod_pkg::relative_corner(lod_pkg::keep_point(in_i.p2), origin);

  lod_pkg::cone_t cone;
  assign cone = {lod_pkg::START_RADIUS != 0 ? in_i.ray.cone.offset : '0, in_i.ray.cone.slope, in_i.ray.cone.shift};

  logic                valid_edges, ready_edges, open;
  logic [2:0][S_W-1:0] s;
  logic [TAG_W-1:0]    tag;
  if (EDGES_PER_CYCLE == 3) begin : g_parallel
    lod_edges_parallel #(.TAG_W(TAG_W)) u_edges (
      .clk_i, .rst_ni, .valid_i, .ready_o, .corners_i(corners), .direction_i(lod_pkg::keep_direction(in_i.ray.direction)), .cone_i(cone),
      .codes_i({in_i.e2, in_i.e1, in_i.e0}), .scale_i(in_i.scale), .tag_i,
      .valid_o(valid_edges), .ready_i(ready_edges), .open_o(open), .s_o(s), .tag_o(tag)
    );
  end else if (EDGES_PER_CYCLE == 1) begin : g_serial
    lod_edges_serial #(.TAG_W(TAG_W)) u_edges (
      .clk_i, .rst_ni, .valid_i, .ready_o, .corners_i(corners), .direction_i(lod_pkg::keep_direction(in_i.ray.direction)), .cone_i(cone),
      .codes_i({in_i.e2, in_i.e1, in_i.e0}), .scale_i(in_i.scale), .tag_i,
      .valid_o(valid_edges), .ready_i(ready_edges), .open_o(open), .s_o(s), .tag_o(tag)
    );
  end else begin : g_illegal_edges
    $error("lod_test: EDGES_PER_CYCLE = %0d, must be 1 or 3", EDGES_PER_CYCLE);
  end

  pipe_stage #(.W(lod_pkg::LOD_TEST_OUT_W + TAG_W)) u_out (
    .clk_i, .rst_ni, .valid_i(valid_edges), .ready_o(ready_edges), .data_i({open, s[0], s[1], s[2], tag}),
    .valid_o, .ready_i, .data_o({out_o, tag_o})
  );

endmodule

`default_nettype wire
