`default_nettype none

/// The edge functions and the t numerator of a triangle at one edge per cycle: one edge function that u, v and w pass through in turn.
///
/// The corners rotate, so that each pass takes (b, c): pass 0 gives u = d.(b x c), pass 1 v = d.(c x a), pass 2 w = d.(a x b), each with its tie
/// sign. Beside it t_num = a.(b x c) grows by one component per pass: the y and z of b x c wait for passes 1 and 2.
/// Legal as in edge_function; |a| |b| |c| < 2^98.4. Latency: 3 + lod_pkg::EDGE_FUNCTION_LATENCY; interval 3. 56 multipliers of 18 x 18 bits.
module tri_edges_serial #(
  parameter int unsigned TAG_W = 8
) (
  input  logic                                     clk_i,
  input  logic                                     rst_ni,
  input  logic                                     valid_i,
  output logic                                     ready_o,
  input  logic [3*lod_pkg::RELATIVE_W-1:0]         a_i,
  input  logic [3*lod_pkg::RELATIVE_W-1:0]         b_i,
  input  logic [3*lod_pkg::RELATIVE_W-1:0]         c_i,
  input  logic [lod_pkg::KEPT_DIRECTION_W-1:0]          d_i,
  input  logic [TAG_W-1:0]                         tag_i,
  output logic                                     valid_o,
  input  logic                                     ready_i,
  output logic [lod_pkg::SIGNED_EDGE_W-1:0]        u_o,
  output logic [lod_pkg::SIGNED_EDGE_W-1:0]        v_o,
  output logic [lod_pkg::SIGNED_EDGE_W-1:0]        w_o,
  output logic                                     tie_u_o,
  output logic                                     tie_v_o,
  output logic                                     tie_w_o,
  output logic [lod_pkg::SIGNED_T_NUMERATOR_W-1:0] t_num_o,
  output logic [TAG_W-1:0]                         tag_o
);

  localparam int unsigned W = lod_pkg::RELATIVE_W;
  localparam int unsigned N_W = lod_pkg::NORMAL_W;
  localparam int unsigned T_W = lod_pkg::SIGNED_T_NUMERATOR_W;
  localparam int unsigned EDGE_W = lod_pkg::SIGNED_EDGE_W;
  localparam int unsigned PASS_W = 2;
  localparam int unsigned CROSS_LATENCY = lod_pkg::cross_product_latency(W);
  localparam int unsigned PRODUCT_STAGES = lod_pkg::T_DOT_STAGES;
  localparam int unsigned PRODUCT_LATENCY = PRODUCT_STAGES - 1 + lod_pkg::multiplier_latency(N_W, W);
  if (lod_pkg::EDGE_FUNCTION_LATENCY != CROSS_LATENCY + 1 + PRODUCT_LATENCY + 2) begin : g_illegal_latency
    $error("tri_edges_serial: the path of t_num must have the latency of the edge function");
  end

  // The triangle under way: it turns with each pass and makes room with the last one.
  logic [3*W-1:0]                  a_q, b_q, c_q;
  logic [lod_pkg::KEPT_DIRECTION_W-1:0] d_q;
  logic [TAG_W-1:0]                tag_q;
  logic                            busy, ready_pass;
  logic [PASS_W-1:0]               pass;

  three_passes u_passes (.clk_i, .rst_ni, .valid_i, .ready_o, .busy_o(busy), .ready_i(ready_pass), .pass_o(pass));

  always_ff @(posedge clk_i) begin
    if (ready_o && valid_i) begin
      {a_q, b_q, c_q} <= {a_i, b_i, c_i};
      {d_q, tag_q}    <= {d_i, tag_i};
    end else if (ready_pass) begin
      {a_q, b_q, c_q} <= {b_q, c_q, a_q};
    end
  end

  // Edge function of this pass.
  logic [3*N_W-1:0]  normal;
  logic              valid_value, ready_value, tie;
  logic [EDGE_W-1:0] value;
  edge_function u_edge (
    .clk_i, .rst_ni, .valid_i(busy), .ready_o(ready_pass), .p_i(b_q), .q_i(c_q), .d_i(d_q), .normal_o(normal),
    .valid_o(valid_value), .ready_i(ready_value), .value_o(value), .tie_o(tie)
  );

  // Component of a that this pass adds to t_num: x, y, z in passes 0, 1, 2, in which the turning triangle has a at a_q, c_q, b_q.
  logic [W-1:0] a_k, a_k_beside;
  assign a_k = pass == 0 ? a_q[2*W +: W] : pass == 1 ? c_q[W +: W] : b_q[0 +: W];

  logic              valid_normal, ready_normal;
  logic [PASS_W-1:0] pass_normal;
  logic [TAG_W-1:0]  tag_normal;
  pipe_delay #(.W(W + PASS_W + TAG_W), .STAGES(CROSS_LATENCY), .SKIDS(64'd1 << (CROSS_LATENCY - 1))) u_beside_cross (
    .clk_i, .rst_ni, .valid_i(busy), .ready_o(), .data_i({a_k, pass, tag_q}),
    .valid_o(valid_normal), .ready_i(ready_normal), .data_o({a_k_beside, pass_normal, tag_normal})
  );

  logic [N_W-1:0] ny_q, nz_q, n_k;
  always_ff @(posedge clk_i) begin
    if (valid_normal && ready_normal && pass_normal == 0) {ny_q, nz_q} <= normal[2*N_W-1:0];
  end
  assign n_k = pass_normal == 0 ? normal[2*N_W +: N_W] : pass_normal == 1 ? ny_q : nz_q;

  logic [N_W-1:0]    n_k_q;
  logic [W-1:0]      a_k_q;
  logic              valid_factors, ready_factors;
  logic [PASS_W-1:0] pass_factors;
  logic [TAG_W-1:0]  tag_factors;
  pipe_stage #(.W(N_W + W + PASS_W + TAG_W)) u_factors (
    .clk_i, .rst_ni, .valid_i(valid_normal), .ready_o(ready_normal), .data_i({n_k, a_k_beside, pass_normal, tag_normal}),
    .valid_o(valid_factors), .ready_i(ready_factors), .data_o({n_k_q, a_k_q, pass_factors, tag_factors})
  );

  logic signed [N_W+W-1:0] product;
  logic                    valid_product, ready_product;
  multiplier #(.A_W(N_W), .B_W(W), .PRODUCT_STAGES(PRODUCT_STAGES), .LAST_IS_SKID(1'b1)) u_product (
    .clk_i, .rst_ni, .valid_i(valid_factors), .ready_o(ready_factors), .a_i(n_k_q), .b_i(a_k_q),
    .valid_o(valid_product), .ready_i(ready_product), .product_o(product)
  );
  logic [PASS_W-1:0] pass_product;
  logic [TAG_W-1:0]  tag_product;
  pipe_delay #(.W(PASS_W + TAG_W), .STAGES(PRODUCT_LATENCY), .SKIDS(64'd1 << (PRODUCT_LATENCY - 1))) u_beside_product (
    .clk_i, .rst_ni, .valid_i(valid_factors), .ready_o(), .data_i({pass_factors, tag_factors}),
    .valid_o(), .ready_i(ready_product), .data_o({pass_product, tag_product})
  );

  // The sum so far, then one stage more for the second sum of the edge function.
  logic [T_W-1:0]    t_num, t_num_q;
  logic [PASS_W-1:0] pass_value;
  assign t_num = T_W'(product) + (pass_product == 0 ? '0 : t_num_q);
  always_ff @(posedge clk_i) begin
    if (valid_product && ready_product) t_num_q <= t_num;
  end
  logic              valid_sum, ready_sum;
  logic [PASS_W-1:0] pass_sum;
  logic [TAG_W-1:0]  tag_sum;
  pipe_stage #(.W(PASS_W + TAG_W)) u_beside_sum (
    .clk_i, .rst_ni, .valid_i(valid_product), .ready_o(ready_product), .data_i({pass_product, tag_product}),
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
