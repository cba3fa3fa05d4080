`default_nettype none

/// The edge functions and the t numerator of a triangle at one triangle per cycle: three edge functions, and b x c shared by u and t_num.
///
/// u = d.(b x c), v = d.(c x a), w = d.(a x b), each with its tie sign, t_num = a.(b x c); a, b, c relative to the ray's origin.
/// Legal as in edge_function; |a| |b| |c| < 2^98.4. Latency: 1 + lod_pkg::EDGE_FUNCTION_LATENCY; interval 1. 168 multipliers of 18 x 18 bits.
module tri_edges_parallel #(
  parameter int unsigned TAG_W = 8
) (
  input  logic                                    clk_i,
  input  logic                                    rst_ni,
  input  logic                                    valid_i,
  output logic                                    ready_o,
  input  logic [3*lod_pkg::RELATIVE_W-1:0]        a_i,
  input  logic [3*lod_pkg::RELATIVE_W-1:0]        b_i,
  input  logic [3*lod_pkg::RELATIVE_W-1:0]        c_i,
  input  logic [lod_pkg::KEPT_DIRECTION_W-1:0]         d_i,
  input  logic [TAG_W-1:0]                        tag_i,
  output logic                                    valid_o,
  input  logic                                    ready_i,
  output logic [lod_pkg::SIGNED_EDGE_W-1:0]       u_o,
  output logic [lod_pkg::SIGNED_EDGE_W-1:0]       v_o,
  output logic [lod_pkg::SIGNED_EDGE_W-1:0]       w_o,
  output logic                                    tie_u_o,
  output logic                                    tie_v_o,
  output logic                                    tie_w_o,
  output logic [lod_pkg::SIGNED_T_NUMERATOR_W-1:0] t_num_o,
  output logic [TAG_W-1:0]                        tag_o
);

  localparam int unsigned W = lod_pkg::RELATIVE_W;
  localparam int unsigned N_W = lod_pkg::NORMAL_W;
  localparam int unsigned D_W = lod_pkg::KEPT_DIRECTION_W;
  localparam int unsigned CROSS_LATENCY = lod_pkg::cross_product_latency(W);
  localparam int unsigned PRODUCT_STAGES = lod_pkg::T_DOT_STAGES;
  // Where the cross products and the multipliers of the dot products end in a `pipe_skid`, so does what goes beside them.
  localparam logic [63:0] CROSS_SKIDS = 64'd1 << (CROSS_LATENCY - 1);
  localparam logic [63:0] EDGE_SKIDS = CROSS_SKIDS | 64'd1 << (lod_pkg::EDGE_FUNCTION_LATENCY - 3);
  if (lod_pkg::EDGE_FUNCTION_LATENCY != CROSS_LATENCY + PRODUCT_STAGES - 1 + lod_pkg::dot_product_latency(N_W, W)) begin : g_illegal_latency
    $error("tri_edges_parallel: a.(b x c) and the edge functions must have one latency");
  end

  logic [3*W-1:0]   a, b, c;
  logic [D_W-1:0]   d;
  logic [TAG_W-1:0] tag;
  logic             valid_relative, ready_relative;
  pipe_stage #(.W(9 * W + D_W + TAG_W)) u_relative (
    .clk_i, .rst_ni, .valid_i, .ready_o, .data_i({a_i, b_i, c_i, d_i, tag_i}),
    .valid_o(valid_relative), .ready_i(ready_relative), .data_o({a, b, c, d, tag})
  );

  logic [3*N_W-1:0] normal_bc;
  edge_function u_u (
    .clk_i, .rst_ni, .valid_i(valid_relative), .ready_o(ready_relative), .p_i(b), .q_i(c), .d_i(d), .normal_o(normal_bc),
    .valid_o, .ready_i, .value_o(u_o), .tie_o(tie_u_o)
  );
  edge_function u_v (
    .clk_i, .rst_ni, .valid_i(valid_relative), .ready_o(), .p_i(c), .q_i(a), .d_i(d), .normal_o(),
    .valid_o(), .ready_i, .value_o(v_o), .tie_o(tie_v_o)
  );
  edge_function u_w (
    .clk_i, .rst_ni, .valid_i(valid_relative), .ready_o(), .p_i(a), .q_i(b), .d_i(d), .normal_o(),
    .valid_o(), .ready_i, .value_o(w_o), .tie_o(tie_w_o)
  );

  // a meets b x c as it leaves u_u's cross product.
  logic [3*W-1:0] a_beside;
  logic           valid_normal, ready_normal;
  pipe_delay #(.W(3 * W), .STAGES(CROSS_LATENCY), .SKIDS(CROSS_SKIDS)) u_beside_cross (
    .clk_i, .rst_ni, .valid_i(valid_relative), .ready_o(), .data_i(a),
    .valid_o(valid_normal), .ready_i(ready_normal), .data_o(a_beside)
  );
  dot_product #(.A_W(N_W), .B_W(W), .SUM_W(lod_pkg::SIGNED_T_NUMERATOR_W), .PRODUCT_STAGES(PRODUCT_STAGES)) u_t_num (
    .clk_i, .rst_ni, .valid_i(valid_normal), .ready_o(ready_normal), .a_i(normal_bc), .b_i(a_beside),
    .valid_o(), .ready_i, .sum_o(t_num_o)
  );

  pipe_delay #(.W(TAG_W), .STAGES(lod_pkg::EDGE_FUNCTION_LATENCY), .SKIDS(EDGE_SKIDS)) u_tag (
    .clk_i, .rst_ni, .valid_i(valid_relative), .ready_o(), .data_i(tag), .valid_o(), .ready_i, .data_o(tag_o)
  );

endmodule

`default_nettype wire
