`default_nettype none

/// Does a node's triangle serve this ray, and if not, how far do its edges open? (paper section 3.7) Twin of src/block/lod_test.rs.
///
/// Per edge (a, b) with bound h: l = floor(min((a-x).d, (b-x).d) / 2^30), D = clamp(floor((offset + l slope) / 2^shift), 0, 2^34 - 1);
/// s = 0 iff h <= D, s = 256 iff h >= 2D (and h > D), else clamp(floor((h-D) 256 / D), 1, 255). refine iff some s is not 0.
/// Legal: points and origin with |v| < 2^31, |d| <= 2^30 and each |d_i| < 2^30. Latency: LOD_TEST_LATENCY; interval 1.
module lod_test #(
  parameter int unsigned TAG_W = 8
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
  localparam int unsigned COMPONENT_W = lod_pkg::COMPONENT_W;
  localparam int unsigned L_W = lod_pkg::DISTANCE_W;
  localparam int unsigned D_W = lod_pkg::TOLERANCE_W;
  localparam int unsigned H_W = lod_pkg::BOUND_W;
  localparam int unsigned S_W = lod_pkg::EDGE_STATE_W;
  localparam int unsigned CODE_W = lod_pkg::BOUND_CODE_W;
  // (p - x).d: |p - x| < 2^32 sqrt 3 and |d| <= 2^30, so below 2^62.8, partial sums too (Cauchy-Schwarz), less the zeros of both.
  localparam int unsigned ALONG_W = W + COMPONENT_W;

  localparam int unsigned ALONG_LATENCY = 1 + lod_pkg::dot_product_latency(W, COMPONENT_W);
  localparam int unsigned NEARER_LATENCY = ALONG_LATENCY + 1;
  localparam int unsigned LIMITS_LATENCY = NEARER_LATENCY + lod_pkg::CONE_TOLERANCE_LATENCY;
  localparam int unsigned LATENCY = LIMITS_LATENCY + lod_pkg::EDGE_OPENING_LATENCY + 1;
  if (lod_pkg::LOD_TEST_LATENCY != LATENCY) begin : g_illegal_latency
    $error("lod_test: lod_pkg::LOD_TEST_LATENCY must be %0d", LATENCY);
  end
  if (lod_pkg::BOUND_DECODE_LATENCY > lod_pkg::CONE_TOLERANCE_LATENCY) begin : g_illegal_decode
    $error("lod_test: lod_pkg::BOUND_DECODE_LATENCY is above CONE_TOLERANCE_LATENCY = %0d", lod_pkg::CONE_TOLERANCE_LATENCY);
  end

  // Stages that are a `pipe_skid`: the last of the distances' multipliers, the nearer end and the first of the openings. What goes beside them has
  // its own at the same stages.
  localparam logic [63:0] NEARER_SKIDS = 64'd1 << (ALONG_LATENCY - 3) | 64'd1 << (NEARER_LATENCY - 1);
  localparam logic [63:0] SKIDS = NEARER_SKIDS | 64'd1 << LIMITS_LATENCY;

  // Corners relative to the origin.
  lod_pkg::kept_point_t      origin;
  logic [2:0][3*W-1:0]       corners, corners_q;
  logic [3*COMPONENT_W-1:0]  direction_q;
  logic                            valid_relative, ready_relative;
  assign origin     = lod_pkg::keep_point(in_i.ray.origin);
  assign corners[0] = lod_pkg::relative_corner(lod_pkg::keep_point(in_i.p0), origin);
  assign corners[1] = lod_pkg::relative_corner(lod_pkg::keep_point(in_i.p1), origin);
  assign corners[2] = lod_pkg::relative_corner(lod_pkg::keep_point(in_i.p2), origin);
  pipe_stage #(.W(9 * W + 3 * COMPONENT_W)) u_relative (
    .clk_i, .rst_ni, .valid_i, .ready_o, .data_i({corners, lod_pkg::keep_direction(in_i.ray.direction)}),
    .valid_o(valid_relative), .ready_i(ready_relative), .data_o({corners_q, direction_q})
  );

  // Distances of the corners along the ray, in whole units.
  logic [2:0]          valid_dot, ready_dot;
  logic                ready_along;
  logic [2:0][L_W-1:0] l;
  for (genvar k = 0; k < 3; k++) begin : g_corner
    logic [ALONG_W-1:0] along;
    dot_product #(.A_W(W), .B_W(COMPONENT_W), .SUM_W(ALONG_W)) u_along (
      .clk_i, .rst_ni, .valid_i(valid_relative), .ready_o(ready_dot[k]), .a_i(corners_q[k]), .b_i(direction_q),
      .valid_o(valid_dot[k]), .ready_i(ready_along), .sum_o(along)
    );
    assign l[k] = along[ALONG_W-1 -: L_W];

    logic [ALONG_W-L_W-1:0] unused_fraction;
    assign unused_fraction = along[ALONG_W-L_W-1:0];
  end
  assign ready_relative = ready_dot[0];

  // The nearer end of each edge; the floor of a minimum is the minimum of the floors.
  logic [2:0][L_W-1:0] nearer, nearer_q;
  for (genvar k = 0; k < 3; k++) begin : g_nearer
    logic signed [L_W-1:0] a, b;
    assign a         = l[(k+1)%3];
    assign b         = l[(k+2)%3];
    assign nearer[k] = a < b ? a : b;
  end
  logic valid_nearer, ready_nearer;
  pipe_skid #(.W(3 * L_W)) u_nearer (
    .clk_i, .rst_ni, .valid_i(valid_dot[0]), .ready_o(ready_along), .data_i(nearer),
    .valid_o(valid_nearer), .ready_i(ready_nearer), .data_o(nearer_q)
  );

  // D of each edge, and its bound in time for it.
  lod_pkg::cone_t cone, cone_q;
  assign cone = {lod_pkg::START_RADIUS != 0 ? in_i.ray.cone.offset : '0, in_i.ray.cone.slope, in_i.ray.cone.shift};
  pipe_delay #(.W(lod_pkg::CONE_W), .STAGES(NEARER_LATENCY), .SKIDS(NEARER_SKIDS)) u_cone (
    .clk_i, .rst_ni, .valid_i, .ready_o(), .data_i(cone), .valid_o(), .ready_i(ready_nearer), .data_o(cone_q)
  );
  logic [2:0][CODE_W-1:0] codes_q;
  lod_pkg::bound_scale_t  scale_q;
  logic                   valid_codes, ready_codes;
  pipe_delay #(
    .W(3 * CODE_W + lod_pkg::BOUND_SCALE_W), .STAGES(LIMITS_LATENCY - lod_pkg::BOUND_DECODE_LATENCY), .SKIDS(NEARER_SKIDS)
  ) u_codes (
    .clk_i, .rst_ni, .valid_i, .ready_o(), .data_i({in_i.e2, in_i.e1, in_i.e0, in_i.scale}),
    .valid_o(valid_codes), .ready_i(ready_codes), .data_o({codes_q, scale_q})
  );

  logic [2:0]          ready_tolerance, valid_tolerance, ready_decode, ready_opening, valid_opening, open;
  logic [2:0][S_W-1:0] s;
  logic                ready_out;
  for (genvar k = 0; k < 3; k++) begin : g_edge
    logic [D_W-1:0]             d;
    lod_pkg::bound_decode_in_t  code;
    lod_pkg::bound_decode_out_t bound;
    cone_tolerance u_tolerance (
      .clk_i, .rst_ni, .valid_i(valid_nearer), .ready_o(ready_tolerance[k]), .l_i(nearer_q[k]), .cone_i(cone_q),
      .valid_o(valid_tolerance[k]), .ready_i(ready_opening[0]), .d_o(d)
    );
    assign code = {codes_q[k], scale_q};
    bound_decode #(.TAG_W(1)) u_bound (
      .clk_i, .rst_ni, .valid_i(valid_codes), .ready_o(ready_decode[k]), .in_i(code), .tag_i(1'b0),
      .valid_o(), .ready_i(ready_opening[0]), .out_o(bound), .tag_o()
    );
    logic [H_W-1:0] h;
    assign h = bound.h;
    edge_opening u_opening (
      .clk_i, .rst_ni, .valid_i(valid_tolerance[0]), .ready_o(ready_opening[k]), .h_i(h), .d_i(d), .open_o(open[k]),
      .valid_o(valid_opening[k]), .ready_i(ready_out), .s_o(s[k])
    );
  end
  assign ready_nearer = ready_tolerance[0];
  assign ready_codes  = ready_decode[0];

  logic [TAG_W-1:0] tag;
  pipe_delay #(.W(TAG_W), .STAGES(LATENCY - 1), .SKIDS(SKIDS)) u_tag (
    .clk_i, .rst_ni, .valid_i, .ready_o(), .data_i(tag_i), .valid_o(), .ready_i(ready_out), .data_o(tag)
  );
  pipe_stage #(.W(lod_pkg::LOD_TEST_OUT_W + TAG_W)) u_out (
    .clk_i, .rst_ni, .valid_i(valid_opening[0]), .ready_o(ready_out), .data_i({open != 0, s[0], s[1], s[2], tag}),
    .valid_o, .ready_i, .data_o({out_o, tag_o})
  );

  logic unused_lockstep;
  assign unused_lockstep = ^{valid_dot[2:1], ready_dot[2:1], ready_tolerance[2:1], valid_tolerance[2:1], ready_decode[2:1],
                             ready_opening[2:1], valid_opening[2:1]};

endmodule

`default_nettype wire
