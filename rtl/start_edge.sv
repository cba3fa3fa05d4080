`default_nettype none

/// Edge function of a ray from an exact start and an edge: value_o = d.(p x q) in steps of 2^-31, exact, and the sign it counts with if it is 0.
///
/// The ray starts at X + f / 2^31; p_i and q_i are the edge's ends relative to X, f_i the fraction, unsigned, 31 bits a component. Then p x q of the exact start is
/// P x Q 2^31 + f x (P - Q) in steps of 2^-31: exact_o; normal_o is P x Q. Both are offered cross_product_latency(WHOLE_RELATIVE_W) + 1 after the input, for neighbours in
/// lockstep. tie_o: the first non-zero component of the exact p x q (x, y, z) is positive, or there is none.
/// Legal: |P_i|, |Q_i|, |P_i - Q_i| < 2^32, |d| <= 2^30, so |p x q| < 2^65.6, |value| < 2^96 and its partial sums too, in units (Hadamard).
/// Latency: lod_pkg::START_EDGE_LATENCY; interval 1.
module start_edge (
  input  logic                                   clk_i,
  input  logic                                   rst_ni,
  input  logic                                   valid_i,
  output logic                                   ready_o,
  input  logic [3*lod_pkg::WHOLE_RELATIVE_W-1:0] p_i,
  input  logic [3*lod_pkg::WHOLE_RELATIVE_W-1:0] q_i,
  input  logic [3*lod_pkg::FRACTION_W-1:0]          f_i,
  input  lod_pkg::direction_t                    d_i,
  output logic                                   valid_normal_o,
  output logic                                   ready_normal_o,
  output logic [3*lod_pkg::WHOLE_NORMAL_W-1:0]   normal_o,
  output logic [3*lod_pkg::EXACT_NORMAL_W-1:0]   exact_o,
  output logic                                   valid_o,
  input  logic                                   ready_i,
  output logic [lod_pkg::EXACT_EDGE_W-1:0]       value_o,
  output logic                                   tie_o
);

  localparam int unsigned W = lod_pkg::WHOLE_RELATIVE_W;
  localparam int unsigned N_W = lod_pkg::WHOLE_NORMAL_W;
  localparam int unsigned E_W = lod_pkg::EXACT_NORMAL_W;
  localparam int unsigned F_W = lod_pkg::FRACTION_W;
  localparam int unsigned D_W = lod_pkg::DIRECTION_W / 3;
  localparam int unsigned SUM_W = E_W + D_W;
  localparam int unsigned CROSS_LATENCY = lod_pkg::cross_product_latency(W);
  localparam int unsigned PRODUCT_STAGES = lod_pkg::START_PRODUCT_STAGES;
  localparam int unsigned DOT_LATENCY = PRODUCT_STAGES - 1 + lod_pkg::dot_product_latency(E_W, D_W);
  if (lod_pkg::START_EDGE_LATENCY != CROSS_LATENCY + 1 + DOT_LATENCY) begin : g_illegal_latency
    $error("start_edge: lod_pkg::START_EDGE_LATENCY must be %0d", CROSS_LATENCY + 1 + DOT_LATENCY);
  end

  // P x Q and f x (P - Q), with d beside them.
  logic [3*W-1:0] f, difference;
  for (genvar k = 0; k < 3; k++) begin : g_component
    assign f[k*W +: W]          = W'(f_i[k*F_W +: F_W]);
    assign difference[k*W +: W] = p_i[k*W +: W] - q_i[k*W +: W];
  end
  logic [3*N_W-1:0] normal, turned;
  logic             valid_cross, ready_cross, unused_valid, unused_ready;
  cross_product #(.W(W)) u_cross (
    .clk_i, .rst_ni, .valid_i, .ready_o, .p_i, .q_i,
    .valid_o(valid_cross), .ready_i(ready_cross), .cross_o(normal)
  );
  cross_product #(.W(W)) u_turned (
    .clk_i, .rst_ni, .valid_i, .ready_o(unused_ready), .p_i(f), .q_i(difference),
    .valid_o(unused_valid), .ready_i(ready_cross), .cross_o(turned)
  );
  logic [3*D_W-1:0] d_cross, d_exact;
  pipe_delay #(.W(3 * D_W), .STAGES(CROSS_LATENCY), .SKIDS(64'd1 << (CROSS_LATENCY - 1))) u_beside_cross (
    .clk_i, .rst_ni, .valid_i, .ready_o(), .data_i(d_i), .valid_o(), .ready_i(ready_cross), .data_o(d_cross)
  );

  // The exact p x q.
  logic [3*E_W-1:0] exact;
  for (genvar k = 0; k < 3; k++) begin : g_exact
    // |P x Q| < 2^65.6: with the fraction's bits below it, 97 and its sign.
    logic signed [N_W+F_W-1:0] whole;
    logic signed [N_W-1:0]     more;
    assign whole               = {normal[k*N_W +: N_W], {F_W{1'b0}}};
    assign more                = turned[k*N_W +: N_W];
    assign exact[k*E_W +: E_W] = E_W'(whole) + E_W'(more);
  end
  logic valid_exact, ready_exact;
  pipe_stage #(.W(3 * E_W + 3 * N_W + 3 * D_W)) u_exact (
    .clk_i, .rst_ni, .valid_i(valid_cross), .ready_o(ready_cross), .data_i({exact, normal, d_cross}),
    .valid_o(valid_exact), .ready_i(ready_exact), .data_o({exact_o, normal_o, d_exact})
  );
  assign valid_normal_o = valid_exact;
  assign ready_normal_o = ready_exact;

  logic [SUM_W-1:0] sum;
  dot_product #(.A_W(E_W), .B_W(D_W), .SUM_W(SUM_W), .PRODUCT_STAGES(PRODUCT_STAGES)) u_dot (
    .clk_i, .rst_ni, .valid_i(valid_exact), .ready_o(ready_exact), .a_i(exact_o), .b_i(d_exact),
    .valid_o, .ready_i, .sum_o(sum)
  );
  // The bits above only repeat its sign.
  assign value_o = sum[lod_pkg::EXACT_EDGE_W-1:0];
  logic [SUM_W-lod_pkg::EXACT_EDGE_W-1:0] unused_sign;
  assign unused_sign = sum[SUM_W-1:lod_pkg::EXACT_EDGE_W];

  logic signed [E_W-1:0] nx, ny, nz;
  assign {nx, ny, nz} = exact_o;
  logic tie;
  assign tie = nx != 0 ? !nx[E_W-1] : ny != 0 ? !ny[E_W-1] : !nz[E_W-1];
  pipe_delay #(.W(1), .STAGES(DOT_LATENCY), .SKIDS(64'd1 << (DOT_LATENCY - 3))) u_tie (
    .clk_i, .rst_ni, .valid_i(valid_exact), .ready_o(), .data_i(tie), .valid_o(), .ready_i, .data_o(tie_o)
  );

endmodule

`default_nettype wire
