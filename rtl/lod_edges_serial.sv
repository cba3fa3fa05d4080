`default_nettype none

/// The states of a triangle's edges at one edge per cycle: one distance, one tolerance and one opening that corners and edges pass through in turn.
///
/// Corners p1, p2, p0 go through the dot product; when the third distance comes, all are handed on at once, and turn there while the next triangle's
/// come, so that each pass takes the ends of one edge: (p1, p2), (p2, p0), (p0, p1). open_o: some edge is open, its state not 0.
/// Legal as in lod_test. Latency: lod_pkg::LOD_TEST_1_LATENCY - 1; interval 3. 14 multipliers of 18 x 18 bits.
module lod_edges_serial #(
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
  localparam int unsigned CONE_W = lod_pkg::CONE_W;
  localparam int unsigned SCALE_W = lod_pkg::BOUND_SCALE_W;
  localparam int unsigned CODE_W = lod_pkg::BOUND_CODE_W;
  localparam int unsigned S_W = lod_pkg::EDGE_STATE_W;
  localparam int unsigned PASS_W = 2;
  // (p - x).d: |p - x| < 2^32 sqrt 3 and |d| <= 2^30, so below 2^62.8, partial sums too (Cauchy-Schwarz), less the zeros of both.
  localparam int unsigned ALONG_W = W + COMPONENT_W;
  localparam int unsigned ALONG_LATENCY = lod_pkg::dot_product_latency(W, COMPONENT_W);
  localparam int unsigned LIMITS_LATENCY = 1 + lod_pkg::CONE_TOLERANCE_LATENCY;
  if (lod_pkg::BOUND_DECODE_LATENCY > lod_pkg::CONE_TOLERANCE_LATENCY) begin : g_illegal_decode
    $error("lod_edges_serial: lod_pkg::BOUND_DECODE_LATENCY is above CONE_TOLERANCE_LATENCY = %0d", lod_pkg::CONE_TOLERANCE_LATENCY);
  end

  // The triangle under way: its corners turn with each pass, and it makes room with the last one.
  logic [2:0][3*W-1:0]                  corners_q;
  logic [lod_pkg::KEPT_DIRECTION_W-1:0] direction_q;
  lod_pkg::cone_t                       cone_q;
  logic [2:0][CODE_W-1:0]               codes_q;
  lod_pkg::bound_scale_t                scale_q;
  logic [TAG_W-1:0]                     tag_q;
  logic                                 busy, ready_pass;
  logic [PASS_W-1:0]                    pass;
  three_passes u_passes (.clk_i, .rst_ni, .valid_i, .ready_o, .busy_o(busy), .ready_i(ready_pass), .pass_o(pass));
  always_ff @(posedge clk_i) begin
    if (ready_o && valid_i) begin
      corners_q                                       <= {corners_i[0], corners_i[2], corners_i[1]};
      {direction_q, cone_q, codes_q, scale_q, tag_q}  <= {direction_i, cone_i, codes_i, scale_i, tag_i};
    end else if (ready_pass) begin
      corners_q[1:0] <= corners_q[2:1];
    end
  end

  // Distance of this pass's corner along the ray, in whole units.
  logic [ALONG_W-1:0] along;
  logic [L_W-1:0]     l;
  logic               valid_along, ready_along;
  dot_product #(.A_W(W), .B_W(COMPONENT_W), .SUM_W(ALONG_W)) u_along (
    .clk_i, .rst_ni, .valid_i(busy), .ready_o(ready_pass), .a_i(corners_q[0]), .b_i(direction_q),
    .valid_o(valid_along), .ready_i(ready_along), .sum_o(along)
  );
  assign l = along[ALONG_W-1 -: L_W];
  logic [ALONG_W-L_W-1:0] unused_fraction;
  assign unused_fraction = along[ALONG_W-L_W-1:0];

  // What the edges need of the triangle besides. Its last multiplier stage is a `pipe_skid`, so this has one there too.
  localparam int unsigned BESIDE_W = CONE_W + 3 * CODE_W + SCALE_W + TAG_W;
  logic [PASS_W-1:0]   pass_along;
  logic [BESIDE_W-1:0] beside_along;
  pipe_delay #(.W(PASS_W + BESIDE_W), .STAGES(ALONG_LATENCY), .SKIDS(64'd1 << (ALONG_LATENCY - 3))) u_beside (
    .clk_i, .rst_ni, .valid_i(busy), .ready_o(), .data_i({pass, cone_q, codes_q, scale_q, tag_q}),
    .valid_o(), .ready_i(ready_along), .data_o({pass_along, beside_along})
  );

  // The distances of p1 and p2 wait for that of p0.
  logic           last_along;
  logic [L_W-1:0] l1_q, l2_q;
  assign last_along = pass_along == 2;
  always_ff @(posedge clk_i) begin
    if (valid_along && !last_along) {l1_q, l2_q} <= {l2_q, l};
  end

  // The triangle whose edges are under way, likewise: distances and codes turn.
  logic [2:0][L_W-1:0]    edge_l_q;
  lod_pkg::cone_t         edge_cone_q;
  logic [2:0][CODE_W-1:0] edge_codes_q;
  lod_pkg::bound_scale_t  edge_scale_q;
  logic [TAG_W-1:0]       edge_tag_q;
  logic                   edge_busy, ready_edge, edge_free;
  logic [PASS_W-1:0]      edge_pass;
  assign ready_along = edge_free || !last_along;
  three_passes u_edge_passes (
    .clk_i, .rst_ni, .valid_i(valid_along && last_along), .ready_o(edge_free), .busy_o(edge_busy), .ready_i(ready_edge), .pass_o(edge_pass)
  );
  always_ff @(posedge clk_i) begin
    if (edge_free && valid_along && last_along) begin
      edge_l_q                                               <= {l, l2_q, l1_q};
      {edge_cone_q, edge_codes_q, edge_scale_q, edge_tag_q}  <= beside_along;
    end else if (ready_edge) begin
      edge_l_q          <= {edge_l_q[0], edge_l_q[2:1]};
      edge_codes_q[1:0] <= edge_codes_q[2:1];
    end
  end

  // The nearer end of this pass's edge; the floor of a minimum is the minimum of the floors.
  logic signed [L_W-1:0] a, b;
  logic [L_W-1:0]        nearer_q;
  lod_pkg::cone_t        nearer_cone_q;
  logic                  valid_nearer, ready_nearer;
  assign a = edge_l_q[0];
  assign b = edge_l_q[1];
  pipe_skid #(.W(L_W + CONE_W)) u_nearer (
    .clk_i, .rst_ni, .valid_i(edge_busy), .ready_o(ready_edge), .data_i({a < b ? a : b, edge_cone_q}),
    .valid_o(valid_nearer), .ready_i(ready_nearer), .data_o({nearer_q, nearer_cone_q})
  );

  // Its D, and its bound in time for it.
  logic [lod_pkg::TOLERANCE_W-1:0] d;
  logic                            valid_tolerance, ready_opening;
  cone_tolerance u_tolerance (
    .clk_i, .rst_ni, .valid_i(valid_nearer), .ready_o(ready_nearer), .l_i(nearer_q), .cone_i(nearer_cone_q),
    .valid_o(valid_tolerance), .ready_i(ready_opening), .d_o(d)
  );
  lod_pkg::bound_decode_in_t  code;
  lod_pkg::bound_decode_out_t bound;
  logic                       valid_code, ready_code;
  pipe_delay #(.W(CODE_W + SCALE_W), .STAGES(LIMITS_LATENCY - lod_pkg::BOUND_DECODE_LATENCY), .SKIDS(64'd1)) u_code (
    .clk_i, .rst_ni, .valid_i(edge_busy), .ready_o(), .data_i({edge_codes_q[0], edge_scale_q}),
    .valid_o(valid_code), .ready_i(ready_code), .data_o(code)
  );
  bound_decode #(.TAG_W(1)) u_bound (
    .clk_i, .rst_ni, .valid_i(valid_code), .ready_o(ready_code), .in_i(code), .tag_i(1'b0),
    .valid_o(), .ready_i(ready_opening), .out_o(bound), .tag_o()
  );

  logic           valid_opening, ready_state, open;
  logic [S_W-1:0] s;
  edge_opening u_opening (
    .clk_i, .rst_ni, .valid_i(valid_tolerance), .ready_o(ready_opening), .h_i(bound.h), .d_i(d), .open_o(open),
    .valid_o(valid_opening), .ready_i(ready_state), .s_o(s)
  );
  logic [PASS_W-1:0] pass_state;
  pipe_delay #(
    .W(PASS_W + TAG_W), .STAGES(LIMITS_LATENCY + lod_pkg::EDGE_OPENING_LATENCY), .SKIDS(64'd1 | 64'd1 << LIMITS_LATENCY)
  ) u_tag (
    .clk_i, .rst_ni, .valid_i(edge_busy), .ready_o(), .data_i({edge_pass, edge_tag_q}),
    .valid_o(), .ready_i(ready_state), .data_o({pass_state, tag_o})
  );

  // The first two states wait for the third.
  logic           last_state, open0_q, open1_q;
  logic [S_W-1:0] s0_q, s1_q;
  assign last_state  = pass_state == 2;
  assign valid_o     = valid_opening && last_state;
  assign ready_state = ready_i || !last_state;
  always_ff @(posedge clk_i) begin
    if (valid_opening && !last_state) {open0_q, s0_q, open1_q, s1_q} <= {open1_q, s1_q, open, s};
  end
  assign open_o = open0_q || open1_q || open;
  assign s_o    = {s, s1_q, s0_q};

endmodule

`default_nettype wire
