`default_nettype none

/// The edge functions and the t numerator of a triangle and a ray from an exact start, at one edge per cycle: one edge function that u, v and w pass through in turn.
///
/// The corners rotate, so that each pass takes (b, c): pass 0 gives u = d.(b x c), pass 1 v = d.(c x a), pass 2 w = d.(a x b), each with its tie sign. Beside it
/// t_num = A.(b x c) - f.(B x C) / 2^31 grows by one component per pass: the y and z of both b x c wait for passes 1 and 2. All in steps of 2^-31; a_i, b_i, c_i are relative to
/// the whole point of the start, f_i is its fraction. Legal as in start_edge; |a| |b| |c| < 2^98.4 units.
/// Latency: 3 + lod_pkg::START_EDGE_LATENCY; interval 3. 104 multipliers of 18 x 18 bits.
module start_edges_serial #(
  parameter int unsigned TAG_W = 8
) (
  input  logic                                   clk_i,
  input  logic                                   rst_ni,
  input  logic                                   valid_i,
  output logic                                   ready_o,
  input  logic [3*lod_pkg::WHOLE_RELATIVE_W-1:0] a_i,
  input  logic [3*lod_pkg::WHOLE_RELATIVE_W-1:0] b_i,
  input  logic [3*lod_pkg::WHOLE_RELATIVE_W-1:0] c_i,
  input  logic [3*lod_pkg::FRACTION_W-1:0]          f_i,
  input  lod_pkg::direction_t                    d_i,
  input  logic [TAG_W-1:0]                       tag_i,
  output logic                                   valid_o,
  input  logic                                   ready_i,
  output logic [lod_pkg::EXACT_EDGE_W-1:0]       u_o,
  output logic [lod_pkg::EXACT_EDGE_W-1:0]       v_o,
  output logic [lod_pkg::EXACT_EDGE_W-1:0]       w_o,
  output logic                                   tie_u_o,
  output logic                                   tie_v_o,
  output logic                                   tie_w_o,
  output logic [lod_pkg::EXACT_T_W-1:0]          t_num_o,
  output logic [TAG_W-1:0]                       tag_o
);

  localparam int unsigned W = lod_pkg::WHOLE_RELATIVE_W;
  localparam int unsigned N_W = lod_pkg::WHOLE_NORMAL_W;
  localparam int unsigned E_W = lod_pkg::EXACT_NORMAL_W;
  localparam int unsigned F_W = lod_pkg::FRACTION_W;
  localparam int unsigned T_W = lod_pkg::EXACT_T_W;
  localparam int unsigned EDGE_W = lod_pkg::EXACT_EDGE_W;
  localparam int unsigned PASS_W = 2;
  localparam int unsigned NORMAL_LATENCY = lod_pkg::cross_product_latency(W) + 1;
  // Both products take as long.
  localparam int unsigned PRODUCT_LATENCY = lod_pkg::multiplier_latency(E_W, W);
  localparam int unsigned LESS_STAGES = 1 + PRODUCT_LATENCY - lod_pkg::multiplier_latency(N_W, F_W + 1);
  if (lod_pkg::START_EDGE_LATENCY != NORMAL_LATENCY + 1 + PRODUCT_LATENCY + 3) begin : g_illegal_latency
    $error("start_edges_serial: the path of t_num must have the latency of the edge function");
  end

  // The triangle under way: it turns with each pass and makes room with the last one.
  logic [3*W-1:0]      a_q, b_q, c_q;
  logic [3*F_W-1:0]    f_q;
  lod_pkg::direction_t d_q;
  logic [TAG_W-1:0]    tag_q;
  logic                busy, ready_pass;
  logic [PASS_W-1:0]   pass;

  three_passes u_passes (.clk_i, .rst_ni, .valid_i, .ready_o, .busy_o(busy), .ready_i(ready_pass), .pass_o(pass));

  always_ff @(posedge clk_i) begin
    if (ready_o && valid_i) begin
      {a_q, b_q, c_q}   <= {a_i, b_i, c_i};
      {f_q, d_q, tag_q} <= {f_i, d_i, tag_i};
    end else if (ready_pass) begin
      {a_q, b_q, c_q} <= {b_q, c_q, a_q};
    end
  end

  // Edge function of this pass.
  logic [3*N_W-1:0]  normal;
  logic [3*E_W-1:0]  exact;
  logic              valid_normal, ready_normal, valid_value, ready_value, tie, unused_ready;
  logic [EDGE_W-1:0] value;
  start_edge u_edge (
    .clk_i, .rst_ni, .valid_i(busy), .ready_o(ready_pass), .p_i(b_q), .q_i(c_q), .f_i(f_q), .d_i(d_q),
    .valid_normal_o(valid_normal), .ready_normal_o(unused_ready), .normal_o(normal), .exact_o(exact),
    .valid_o(valid_value), .ready_i(ready_value), .value_o(value), .tie_o(tie)
  );

  // Components of A and f that this pass takes to t_num: x, y, z in passes 0, 1, 2, in which the turning triangle has a at a_q, c_q, b_q.
  logic [W-1:0]   a_k, a_k_beside;
  logic [F_W-1:0] f_k, f_k_beside;
  assign a_k = pass == 0 ? a_q[2*W +: W] : pass == 1 ? c_q[W +: W] : b_q[0 +: W];
  assign f_k = pass == 0 ? f_q[2*F_W +: F_W] : pass == 1 ? f_q[F_W +: F_W] : f_q[0 +: F_W];

  logic [PASS_W-1:0] pass_normal;
  logic [TAG_W-1:0]  tag_normal;
  pipe_delay #(.W(W + F_W + PASS_W + TAG_W), .STAGES(NORMAL_LATENCY), .SKIDS(64'd1 << (NORMAL_LATENCY - 2))) u_beside_normal (
    .clk_i, .rst_ni, .valid_i(busy), .ready_o(), .data_i({a_k, f_k, pass, tag_q}),
    .valid_o(), .ready_i(ready_normal), .data_o({a_k_beside, f_k_beside, pass_normal, tag_normal})
  );

  logic [E_W-1:0] ey_q, ez_q, e_k;
  logic [N_W-1:0] ny_q, nz_q, n_k;
  always_ff @(posedge clk_i) begin
    if (valid_normal && ready_normal && pass_normal == 0) {ey_q, ez_q, ny_q, nz_q} <= {exact[2*E_W-1:0], normal[2*N_W-1:0]};
  end
  assign e_k = pass_normal == 0 ? exact[2*E_W +: E_W] : pass_normal == 1 ? ey_q : ez_q;
  assign n_k = pass_normal == 0 ? normal[2*N_W +: N_W] : pass_normal == 1 ? ny_q : nz_q;

  logic [E_W-1:0]    e_k_q;
  logic [N_W-1:0]    n_k_q;
  logic [W-1:0]      a_k_q;
  logic [F_W-1:0]    f_k_q;
  logic              valid_factors, ready_factors;
  logic [PASS_W-1:0] pass_factors;
  logic [TAG_W-1:0]  tag_factors;
  pipe_stage #(.W(E_W + N_W + W + F_W + PASS_W + TAG_W)) u_factors (
    .clk_i, .rst_ni, .valid_i(valid_normal), .ready_o(ready_normal), .data_i({e_k, n_k, a_k_beside, f_k_beside, pass_normal, tag_normal}),
    .valid_o(valid_factors), .ready_i(ready_factors), .data_o({e_k_q, n_k_q, a_k_q, f_k_q, pass_factors, tag_factors})
  );

  logic [T_W-1:0]            product;
  logic signed [N_W+F_W:0]   less;
  logic                      valid_product, ready_product;
  multiplier #(.A_W(E_W), .B_W(W)) u_product (
    .clk_i, .rst_ni, .valid_i(valid_factors), .ready_o(ready_factors), .a_i(e_k_q), .b_i(a_k_q),
    .valid_o(valid_product), .ready_i(ready_product), .product_o(product)
  );
  multiplier #(.A_W(N_W), .B_W(F_W + 1), .PRODUCT_STAGES(LESS_STAGES)) u_less (
    .clk_i, .rst_ni, .valid_i(valid_factors), .ready_o(), .a_i(n_k_q), .b_i({1'b0, f_k_q}),
    .valid_o(), .ready_i(ready_product), .product_o(less)
  );
  logic [PASS_W-1:0] pass_product;
  logic [TAG_W-1:0]  tag_product;
  pipe_delay #(.W(PASS_W + TAG_W), .STAGES(PRODUCT_LATENCY)) u_beside_product (
    .clk_i, .rst_ni, .valid_i(valid_factors), .ready_o(), .data_i({pass_factors, tag_factors}),
    .valid_o(), .ready_i(ready_product), .data_o({pass_product, tag_product})
  );

  // What this component comes to. A `pipe_skid`, as the edge function has one at this stage.
  logic [T_W-1:0]    difference, difference_q;
  logic              valid_difference, ready_difference;
  logic [PASS_W-1:0] pass_difference;
  logic [TAG_W-1:0]  tag_difference;
  assign difference = product - T_W'(less);
  pipe_skid #(.W(T_W + PASS_W + TAG_W)) u_difference (
    .clk_i, .rst_ni, .valid_i(valid_product), .ready_o(ready_product), .data_i({difference, pass_product, tag_product}),
    .valid_o(valid_difference), .ready_i(ready_difference), .data_o({difference_q, pass_difference, tag_difference})
  );

  // The sum so far, then one stage more for the second sum of the edge function.
  logic [T_W-1:0]    t_num, t_num_q;
  logic [PASS_W-1:0] pass_value;
  assign t_num = difference_q + (pass_difference == 0 ? '0 : t_num_q);
  always_ff @(posedge clk_i) begin
    if (valid_difference && ready_difference) t_num_q <= t_num;
  end
  logic              valid_sum, ready_sum;
  logic [PASS_W-1:0] pass_sum;
  logic [TAG_W-1:0]  tag_sum;
  pipe_stage #(.W(PASS_W + TAG_W)) u_beside_sum (
    .clk_i, .rst_ni, .valid_i(valid_difference), .ready_o(ready_difference), .data_i({pass_difference, tag_difference}),
    .valid_o(valid_sum), .ready_i(ready_sum), .data_o({pass_sum, tag_sum})
  );
  pipe_stage #(.W(T_W + PASS_W + TAG_W)) u_t_num (
    .clk_i, .rst_ni, .valid_i(valid_sum), .ready_o(ready_sum), .data_i({t_num_q, pass_sum, tag_sum}),
    .valid_o(), .ready_i(ready_value), .data_o({t_num_o, pass_value, tag_o})
  );

  // u and v wait for w.
  logic last;
  assign last        = pass_value == 2;
  assign valid_o     = valid_value && last;
  assign ready_value = ready_i || !last;
  always_ff @(posedge clk_i) begin
    if (valid_value && !last) {u_o, tie_u_o, v_o, tie_v_o} <= {v_o, tie_v_o, value, tie};
  end
  assign w_o     = value;
  assign tie_w_o = tie;

endmodule

`default_nettype wire
