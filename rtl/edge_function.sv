`default_nettype none

/// Edge function of a ray and an edge (p, q) seen from the ray's origin: value_o = d.(p x q), exact, and the sign it counts with if it is 0.
///
/// tie_o: the first non-zero component of p x q (x, y, z) is positive; if p x q = 0, that of q - p is; if p = q, true. normal_o is p x q, offered
/// lod_pkg::cross_product_latency(RELATIVE_W) after the input, for neighbours in lockstep.
/// Legal: |p_i|, |q_i| < 2^32, |d| <= 2^30, so |value| <= 3 * 2^64 * 2^30 < 2^96 (Hadamard), and so are its partial sums.
/// Latency: lod_pkg::EDGE_FUNCTION_LATENCY; interval 1.
module edge_function (
  input  logic                                 clk_i,
  input  logic                                 rst_ni,
  input  logic                                 valid_i,
  output logic                                 ready_o,
  input  logic [3*lod_pkg::RELATIVE_W-1:0]     p_i,
  input  logic [3*lod_pkg::RELATIVE_W-1:0]     q_i,
  input  logic [lod_pkg::KEPT_DIRECTION_W-1:0]      d_i,
  output logic [3*lod_pkg::NORMAL_W-1:0]       normal_o,
  output logic                                 valid_o,
  input  logic                                 ready_i,
  output logic [lod_pkg::SIGNED_EDGE_W-1:0]    value_o,
  output logic                                 tie_o
);

  localparam int unsigned W = lod_pkg::RELATIVE_W;
  localparam int unsigned N_W = lod_pkg::NORMAL_W;
  localparam int unsigned D_W = lod_pkg::COMPONENT_W;
  localparam int unsigned CROSS_LATENCY = lod_pkg::cross_product_latency(W);
  localparam int unsigned PRODUCT_STAGES = lod_pkg::EDGE_DOT_STAGES;
  localparam int unsigned DOT_LATENCY = PRODUCT_STAGES - 1 + lod_pkg::dot_product_latency(N_W, D_W);
  if (lod_pkg::EDGE_FUNCTION_LATENCY != CROSS_LATENCY + DOT_LATENCY) begin : g_illegal_latency
    $error("edge_function: lod_pkg::EDGE_FUNCTION_LATENCY must be %0d", CROSS_LATENCY + DOT_LATENCY);
  end

  // p x q, with d and the sign of q - p beside it.
  logic [3*N_W-1:0] normal;
  logic             valid_normal, ready_normal;
  cross_product #(.W(W)) u_cross (
    .clk_i, .rst_ni, .valid_i, .ready_o, .p_i, .q_i,
    .valid_o(valid_normal), .ready_i(ready_normal), .cross_o(normal)
  );
  assign normal_o = normal;

  logic signed [W-1:0] px, py, pz, qx, qy, qz;
  assign {px, py, pz} = p_i;
  assign {qx, qy, qz} = q_i;
  logic along_positive;
  assign along_positive = qx != px ? qx > px : qy != py ? qy > py : qz >= pz;

  logic [3*D_W-1:0] d_q;
  logic             along_positive_q;
  pipe_delay #(.W(3 * D_W + 1), .STAGES(CROSS_LATENCY), .SKIDS(64'd1 << (CROSS_LATENCY - 1))) u_beside_cross (
    .clk_i, .rst_ni, .valid_i, .ready_o(), .data_i({d_i, along_positive}),
    .valid_o(), .ready_i(ready_normal), .data_o({d_q, along_positive_q})
  );

  dot_product #(.A_W(N_W), .B_W(D_W), .SUM_W(lod_pkg::SIGNED_EDGE_W), .PRODUCT_STAGES(PRODUCT_STAGES)) u_dot (
    .clk_i, .rst_ni, .valid_i(valid_normal), .ready_o(ready_normal), .a_i(normal), .b_i(d_q),
    .valid_o, .ready_i, .sum_o(value_o)
  );

  logic signed [N_W-1:0] nx, ny, nz;
  assign {nx, ny, nz} = normal;
  logic tie;
  assign tie = nx != 0 ? !nx[N_W-1] : ny != 0 ? !ny[N_W-1] : nz != 0 ? !nz[N_W-1] : along_positive_q;
  pipe_delay #(.W(1), .STAGES(DOT_LATENCY), .SKIDS(64'd1 << (DOT_LATENCY - 3))) u_tie (
    .clk_i, .rst_ni, .valid_i(valid_normal), .ready_o(), .data_i(tie), .valid_o(), .ready_i, .data_o(tie_o)
  );

endmodule

`default_nettype wire
