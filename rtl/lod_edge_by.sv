`default_nettype none

/// The state of an edge between two points as one ray sees them (lod_test_by): two distances along it, the nearer one's tolerance, and the opening.
///
/// a_i, b_i: the ends relative to the ray's origin. open_o: the state is not 0. Both come from the last registers through a few gates.
/// Legal as in lod_test_by. Latency: lod_pkg::LOD_EDGE_BY_LATENCY; interval 1. 26 multipliers of 18 x 18 bits. Stages that are a `pipe_skid`: the
/// last of the distances' multipliers, the nearer end, the first of the opening.
module lod_edge_by (
  input  logic                                  clk_i,
  input  logic                                  rst_ni,
  input  logic                                  valid_i,
  output logic                                  ready_o,
  input  logic [3*lod_pkg::WHOLE_RELATIVE_W-1:0] a_i,
  input  logic [3*lod_pkg::WHOLE_RELATIVE_W-1:0] b_i,
  input  lod_pkg::direction_t                   direction_i,
  input  lod_pkg::cone_t                        cone_i,
  input  logic [lod_pkg::BOUND_CODE_W-1:0]      code_i,
  input  lod_pkg::bound_scale_t                 scale_i,
  output logic                                  valid_o,
  input  logic                                  ready_i,
  output logic                                  open_o,
  output logic [lod_pkg::EDGE_STATE_W-1:0]      s_o
);

  localparam int unsigned W = lod_pkg::WHOLE_RELATIVE_W;
  localparam int unsigned COMPONENT_W = lod_pkg::DIRECTION_W / 3;
  localparam int unsigned L_W = lod_pkg::DISTANCE_W;
  // (p - x).d: |p - x| < 2^32 sqrt 3 and |d| <= 2^30, so below 2^62.8, partial sums too (Cauchy-Schwarz).
  localparam int unsigned ALONG_W = W + COMPONENT_W;
  localparam int unsigned ALONG_LATENCY = lod_pkg::dot_product_latency(W, COMPONENT_W);
  localparam int unsigned LIMITS_LATENCY = ALONG_LATENCY + 1 + lod_pkg::CONE_TOLERANCE_LATENCY;
  localparam logic [63:0] NEARER_SKIDS = 64'd1 << (ALONG_LATENCY - 3) | 64'd1 << ALONG_LATENCY;
  if (lod_pkg::LOD_EDGE_BY_LATENCY != LIMITS_LATENCY + lod_pkg::EDGE_OPENING_LATENCY) begin : g_illegal_latency
    $error("lod_edge_by: lod_pkg::LOD_EDGE_BY_LATENCY must be %0d", LIMITS_LATENCY + lod_pkg::EDGE_OPENING_LATENCY);
  end
  if (lod_pkg::BOUND_DECODE_LATENCY > lod_pkg::CONE_TOLERANCE_LATENCY) begin : g_illegal_decode
    $error("lod_edge_by: lod_pkg::BOUND_DECODE_LATENCY is above CONE_TOLERANCE_LATENCY = %0d", lod_pkg::CONE_TOLERANCE_LATENCY);
  end

  // Distances of the ends along the ray, in whole units.
  logic                  valid_along, ready_along, unused_valid, unused_ready;
  logic [ALONG_W-1:0]    along_a, along_b;
  logic signed [L_W-1:0] a, b;
  dot_product #(.A_W(W), .B_W(COMPONENT_W), .SUM_W(ALONG_W)) u_along_a (
    .clk_i, .rst_ni, .valid_i, .ready_o, .a_i(a_i), .b_i(direction_i),
    .valid_o(valid_along), .ready_i(ready_along), .sum_o(along_a)
  );
  dot_product #(.A_W(W), .B_W(COMPONENT_W), .SUM_W(ALONG_W)) u_along_b (
    .clk_i, .rst_ni, .valid_i, .ready_o(unused_ready), .a_i(b_i), .b_i(direction_i),
    .valid_o(unused_valid), .ready_i(ready_along), .sum_o(along_b)
  );
  assign a = along_a[ALONG_W-1 -: L_W];
  assign b = along_b[ALONG_W-1 -: L_W];
  logic [2*(ALONG_W-L_W)-1:0] unused_fraction;
  assign unused_fraction = {along_a[ALONG_W-L_W-1:0], along_b[ALONG_W-L_W-1:0]};

  // The nearer end; the floor of a minimum is the minimum of the floors.
  logic [L_W-1:0] nearer_q;
  logic           valid_nearer, ready_nearer;
  pipe_skid #(.W(L_W)) u_nearer (
    .clk_i, .rst_ni, .valid_i(valid_along), .ready_o(ready_along), .data_i(a < b ? a : b),
    .valid_o(valid_nearer), .ready_i(ready_nearer), .data_o(nearer_q)
  );

  // Its D, and the edge's bound in time for it.
  lod_pkg::cone_t cone_q;
  pipe_delay #(.W(lod_pkg::CONE_W), .STAGES(ALONG_LATENCY + 1), .SKIDS(NEARER_SKIDS)) u_cone (
    .clk_i, .rst_ni, .valid_i, .ready_o(), .data_i(cone_i), .valid_o(), .ready_i(ready_nearer), .data_o(cone_q)
  );
  logic [lod_pkg::TOLERANCE_W-1:0] d;
  logic                            valid_tolerance, ready_opening;
  cone_tolerance u_tolerance (
    .clk_i, .rst_ni, .valid_i(valid_nearer), .ready_o(ready_nearer), .l_i(nearer_q), .cone_i(cone_q),
    .valid_o(valid_tolerance), .ready_i(ready_opening), .d_o(d)
  );
  lod_pkg::bound_decode_in_t  code;
  lod_pkg::bound_decode_out_t bound;
  logic                       valid_code, ready_code;
  pipe_delay #(
    .W(lod_pkg::BOUND_DECODE_IN_W), .STAGES(LIMITS_LATENCY - lod_pkg::BOUND_DECODE_LATENCY), .SKIDS(NEARER_SKIDS)
  ) u_code (
    .clk_i, .rst_ni, .valid_i, .ready_o(), .data_i({code_i, scale_i}), .valid_o(valid_code), .ready_i(ready_code), .data_o(code)
  );
  bound_decode #(.TAG_W(1)) u_bound (
    .clk_i, .rst_ni, .valid_i(valid_code), .ready_o(ready_code), .in_i(code), .tag_i(1'b0),
    .valid_o(), .ready_i(ready_opening), .out_o(bound), .tag_o()
  );

  edge_opening u_opening (
    .clk_i, .rst_ni, .valid_i(valid_tolerance), .ready_o(ready_opening), .h_i(bound.h), .d_i(d), .open_o,
    .valid_o, .ready_i, .s_o
  );

endmodule

`default_nettype wire
