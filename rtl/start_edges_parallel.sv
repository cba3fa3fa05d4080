`default_nettype none

/// The edge functions and the t numerator of a triangle and a ray from an exact start, at one triangle per cycle.
///
/// u = d.(b x c), v = d.(c x a), w = d.(a x b), each with its tie sign, t_num = a.(b x c) = A.(b x c) - f.(B x C) / 2^31, all in steps of 2^-31; a_i, b_i, c_i are relative
/// to the whole point of the start, f_i is its fraction. Legal as in start_edge; |a| |b| |c| < 2^98.4 units.
/// Latency: 2 + lod_pkg::START_EDGE_LATENCY; interval 1. 312 multipliers of 18 x 18 bits.
module start_edges_parallel #(
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
  localparam int unsigned D_W = lod_pkg::DIRECTION_W;
  localparam int unsigned EDGE_W = lod_pkg::EXACT_EDGE_W;
  localparam int unsigned T_W = lod_pkg::EXACT_T_W;
  // f.(B x C): below 2^31.8 2^65.6.
  localparam int unsigned LESS_W = 99;
  localparam int unsigned CROSS_LATENCY = lod_pkg::cross_product_latency(W);
  // Both dot products take as long as that of an edge function.
  localparam int unsigned PRODUCT_STAGES = lod_pkg::START_PRODUCT_STAGES;
  localparam int unsigned LESS_STAGES = PRODUCT_STAGES + lod_pkg::dot_product_latency(E_W, W) - lod_pkg::dot_product_latency(N_W, F_W + 1);
  localparam logic [63:0] CROSS_SKIDS = 64'd1 << (CROSS_LATENCY - 1);
  localparam logic [63:0] EDGE_SKIDS = CROSS_SKIDS | 64'd1 << (lod_pkg::START_EDGE_LATENCY - 3);
  if (lod_pkg::START_EDGE_LATENCY != CROSS_LATENCY + PRODUCT_STAGES + lod_pkg::dot_product_latency(E_W, W)) begin : g_illegal_latency
    $error("start_edges_parallel: a.(b x c) and the edge functions must have one latency");
  end

  logic [3*W-1:0]      a, b, c;
  logic [3*F_W-1:0]    f;
  lod_pkg::direction_t d;
  logic [TAG_W-1:0]    tag, tag_edges;
  logic                valid_relative, ready_relative;
  pipe_stage #(.W(9 * W + 3 * F_W + D_W + TAG_W)) u_relative (
    .clk_i, .rst_ni, .valid_i, .ready_o, .data_i({a_i, b_i, c_i, f_i, d_i, tag_i}),
    .valid_o(valid_relative), .ready_i(ready_relative), .data_o({a, b, c, f, d, tag})
  );

  logic [3*N_W-1:0]  normal_bc;
  logic [3*E_W-1:0]  exact_bc;
  logic              valid_normal, ready_normal, valid_edges, ready_edges, tie_u, tie_v, tie_w;
  logic [EDGE_W-1:0] u, v, w;
  start_edge u_u (
    .clk_i, .rst_ni, .valid_i(valid_relative), .ready_o(ready_relative), .p_i(b), .q_i(c), .f_i(f), .d_i(d),
    .valid_normal_o(valid_normal), .ready_normal_o(ready_normal), .normal_o(normal_bc), .exact_o(exact_bc),
    .valid_o(valid_edges), .ready_i(ready_edges), .value_o(u), .tie_o(tie_u)
  );
  start_edge u_v (
    .clk_i, .rst_ni, .valid_i(valid_relative), .ready_o(), .p_i(c), .q_i(a), .f_i(f), .d_i(d),
    .valid_normal_o(), .ready_normal_o(), .normal_o(), .exact_o(), .valid_o(), .ready_i(ready_edges), .value_o(v), .tie_o(tie_v)
  );
  start_edge u_w (
    .clk_i, .rst_ni, .valid_i(valid_relative), .ready_o(), .p_i(a), .q_i(b), .f_i(f), .d_i(d),
    .valid_normal_o(), .ready_normal_o(), .normal_o(), .exact_o(), .valid_o(), .ready_i(ready_edges), .value_o(w), .tie_o(tie_w)
  );

  // a and f meet b x c as it leaves u_u's sum.
  logic [3*W-1:0]       a_beside;
  logic [3*F_W-1:0]     f_beside;
  logic [3*(F_W+1)-1:0] f_signed;
  pipe_delay #(.W(3 * W + 3 * F_W), .STAGES(CROSS_LATENCY + 1), .SKIDS(CROSS_SKIDS)) u_beside (
    .clk_i, .rst_ni, .valid_i(valid_relative), .ready_o(), .data_i({a, f}),
    .valid_o(), .ready_i(ready_normal), .data_o({a_beside, f_beside})
  );
  for (genvar k = 0; k < 3; k++) begin : g_fraction
    assign f_signed[k*(F_W+1) +: F_W+1] = {1'b0, f_beside[k*F_W +: F_W]};
  end
  logic [T_W-1:0]           t_of_a;
  logic signed [LESS_W-1:0] less;
  dot_product #(.A_W(E_W), .B_W(W), .SUM_W(T_W), .PRODUCT_STAGES(PRODUCT_STAGES)) u_t_of_a (
    .clk_i, .rst_ni, .valid_i(valid_normal), .ready_o(), .a_i(exact_bc), .b_i(a_beside),
    .valid_o(), .ready_i(ready_edges), .sum_o(t_of_a)
  );
  dot_product #(.A_W(N_W), .B_W(F_W + 1), .SUM_W(LESS_W), .PRODUCT_STAGES(LESS_STAGES)) u_less (
    .clk_i, .rst_ni, .valid_i(valid_normal), .ready_o(), .a_i(normal_bc), .b_i(f_signed),
    .valid_o(), .ready_i(ready_edges), .sum_o(less)
  );

  pipe_delay #(.W(TAG_W), .STAGES(lod_pkg::START_EDGE_LATENCY), .SKIDS(EDGE_SKIDS)) u_tag (
    .clk_i, .rst_ni, .valid_i(valid_relative), .ready_o(), .data_i(tag), .valid_o(), .ready_i(ready_edges), .data_o(tag_edges)
  );

  logic [T_W-1:0] t_num;
  assign t_num = t_of_a - T_W'(less);
  pipe_stage #(.W(3 * EDGE_W + 3 + T_W + TAG_W)) u_difference (
    .clk_i, .rst_ni, .valid_i(valid_edges), .ready_o(ready_edges), .data_i({u, v, w, tie_u, tie_v, tie_w, t_num, tag_edges}),
    .valid_o, .ready_i, .data_o({u_o, v_o, w_o, tie_u_o, tie_v_o, tie_w_o, t_num_o, tag_o})
  );

endmodule

`default_nettype wire
