`default_nettype none

/// The states of a triangle's edges at three edges per cycle (lod_test).
///
/// open_o: some edge is open, its state not 0. Both come from the last registers through a few gates.
/// Legal as in lod_test. Latency: lod_pkg::LOD_TEST_3_LATENCY - 1; interval 1. 42 multipliers of 18 x 18 bits.
module lod_edges_parallel #(
  parameter int unsigned TAG_W = 8
) (
  input  logic                                  clk_i,
  input  logic                                  rst_ni,
  input  logic                                  valid_i,
  output logic                                  ready_o,
  input  logic [2:0][3*lod_pkg::RELATIVE_W-1:0] corners_i,
  input  logic [lod_pkg::KEPT_DIRECTION_W-1:0]  direction_i,
  input  lod_pkg::cone_t                        cone_i,
  input  logic [2:0][lod_pkg::BOUND_CODE_W-1:0] codes_i,
  input  lod_pkg::bound_scale_t                 scale_i,
  input  logic [TAG_W-1:0]                      tag_i,
  output logic                                  valid_o,
  input  logic                                  ready_i,
  output logic                                  open_o,
  output logic [2:0][lod_pkg::EDGE_STATE_W-1:0] s_o,
  output logic [TAG_W-1:0]                      tag_o
);

  localparam int unsigned W = lod_pkg::RELATIVE_W;
  localparam int unsigned COMPONENT_W = lod_pkg::COMPONENT_W;
  localparam int unsigned L_W = lod_pkg::DISTANCE_W;
  localparam int unsigned D_W = lod_pkg::TOLERANCE_W;
  localparam int unsigned H_W = lod_pkg::BOUND_W;
  localparam int unsigned CODE_W = lod_pkg::BOUND_CODE_W;
  // (p - x).d: |p - x| < 2^32 sqrt 3 and |d| <= 2^30, so below 2^62.8, partial sums too (Cauchy-Schwarz), less the zeros of both.
  localparam int unsigned ALONG_W = W + COMPONENT_W;

  localparam int unsigned ALONG_LATENCY = 1 + lod_pkg::dot_product_latency(W, COMPONENT_W);
  localparam int unsigned NEARER_LATENCY = ALONG_LATENCY + 1;
  localparam int unsigned LIMITS_LATENCY = NEARER_LATENCY + lod_pkg::CONE_TOLERANCE_LATENCY;
  localparam int unsigned LATENCY = LIMITS_LATENCY + lod_pkg::EDGE_OPENING_LATENCY;
  if (lod_pkg::BOUND_DECODE_LATENCY > lod_pkg::CONE_TOLERANCE_LATENCY) begin : g_illegal_decode
    $error("lod_edges_parallel: lod_pkg::BOUND_DECODE_LATENCY is above CONE_TOLERANCE_LATENCY = %0d", lod_pkg::CONE_TOLERANCE_LATENCY);
  end

  // Stages that are a `pipe_skid`: the last of the distances' multipliers, the nearer end and the first of the openings. What goes beside them has
  // its own at the same stages.
  localparam logic [63:0] NEARER_SKIDS = 64'd1 << (ALONG_LATENCY - 3) | 64'd1 << (NEARER_LATENCY - 1);
  localparam logic [63:0] SKIDS = NEARER_SKIDS | 64'd1 << LIMITS_LATENCY;

  logic [2:0][3*W-1:0]      corners_q;
  logic [3*COMPONENT_W-1:0] direction_q;
  logic                     valid_relative, ready_relative;
  pipe_stage #(.W(9 * W + 3 * COMPONENT_W)) u_relative (
    .clk_i, .rst_ni, .valid_i, .ready_o, .data_i({corners_i, direction_i}),
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
  lod_pkg::cone_t cone_q;
  pipe_delay #(.W(lod_pkg::CONE_W), .STAGES(NEARER_LATENCY), .SKIDS(NEARER_SKIDS)) u_cone (
    .clk_i, .rst_ni, .valid_i, .ready_o(), .data_i(cone_i), .valid_o(), .ready_i(ready_nearer), .data_o(cone_q)
  );
  logic [2:0][CODE_W-1:0] codes_q;
  lod_pkg::bound_scale_t  scale_q;
  logic                   valid_codes, ready_codes;
  pipe_delay #(
    .W(3 * CODE_W + lod_pkg::BOUND_SCALE_W), .STAGES(LIMITS_LATENCY - lod_pkg::BOUND_DECODE_LATENCY), .SKIDS(NEARER_SKIDS)
  ) u_codes (
    .clk_i, .rst_ni, .valid_i, .ready_o(), .data_i({codes_i, scale_i}),
    .valid_o(valid_codes), .ready_i(ready_codes), .data_o({codes_q, scale_q})
  );

  logic [2:0] ready_tolerance, valid_tolerance, ready_decode, ready_opening, valid_opening, open;
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
      .valid_o(valid_opening[k]), .ready_i, .s_o(s_o[k])
    );
  end
  assign ready_nearer = ready_tolerance[0];
  assign ready_codes  = ready_decode[0];
  assign valid_o      = valid_opening[0];
  assign open_o       = open != 0;

  pipe_delay #(.W(TAG_W), .STAGES(LATENCY), .SKIDS(SKIDS)) u_tag (
    .clk_i, .rst_ni, .valid_i, .ready_o(), .data_i(tag_i), .valid_o(), .ready_i, .data_o(tag_o)
  );

  logic unused_lockstep;
  assign unused_lockstep = ^{valid_dot[2:1], ready_dot[2:1], ready_tolerance[2:1], valid_tolerance[2:1], ready_decode[2:1],
                             ready_opening[2:1], valid_opening[2:1]};

endmodule

`default_nettype wire
