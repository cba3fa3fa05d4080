`default_nettype none

/// Elastic dot product of two signed vectors: sum_o = a.x b.x + a.y b.y + a.z b.z.
///
/// Vectors are {x, y, z}. Legal: any for which the sum and its partial sums fit SUM_W bits, signed. Latency: PRODUCT_STAGES - 1 +
/// lod_pkg::dot_product_latency(A_W, B_W), which is that of the multipliers with one factor stage and of two sums; interval 1. The last stage of the
/// multipliers, the third from the end, is a `pipe_skid`.
module dot_product #(
  parameter int unsigned A_W = 33,
  parameter int unsigned B_W = 31,
  parameter int unsigned SUM_W = A_W + B_W,
  parameter int unsigned PRODUCT_STAGES = 1
) (
  input  logic             clk_i,
  input  logic             rst_ni,
  input  logic             valid_i,
  output logic             ready_o,
  input  logic [3*A_W-1:0] a_i,
  input  logic [3*B_W-1:0] b_i,
  output logic             valid_o,
  input  logic             ready_i,
  output logic [SUM_W-1:0] sum_o
);

  localparam int unsigned PRODUCT_W = A_W + B_W;
  if (SUM_W < PRODUCT_W) begin : g_illegal_sum
    $error("dot_product: SUM_W = %0d, must be at least A_W + B_W = %0d", SUM_W, PRODUCT_W);
  end

  logic signed [PRODUCT_W-1:0] x, y, z;
  logic                        valid_products, ready_products;
  multiplier #(.A_W(A_W), .B_W(B_W), .FACTOR_STAGES(1), .PRODUCT_STAGES(PRODUCT_STAGES), .LAST_IS_SKID(1'b1)) u_x (
    .clk_i, .rst_ni, .valid_i, .ready_o, .a_i(a_i[2*A_W +: A_W]), .b_i(b_i[2*B_W +: B_W]),
    .valid_o(valid_products), .ready_i(ready_products), .product_o(x)
  );
  multiplier #(.A_W(A_W), .B_W(B_W), .FACTOR_STAGES(1), .PRODUCT_STAGES(PRODUCT_STAGES), .LAST_IS_SKID(1'b1)) u_y (
    .clk_i, .rst_ni, .valid_i, .ready_o(), .a_i(a_i[A_W +: A_W]), .b_i(b_i[B_W +: B_W]),
    .valid_o(), .ready_i(ready_products), .product_o(y)
  );
  multiplier #(.A_W(A_W), .B_W(B_W), .FACTOR_STAGES(1), .PRODUCT_STAGES(PRODUCT_STAGES), .LAST_IS_SKID(1'b1)) u_z (
    .clk_i, .rst_ni, .valid_i, .ready_o(), .a_i(a_i[0 +: A_W]), .b_i(b_i[0 +: B_W]),
    .valid_o(), .ready_i(ready_products), .product_o(z)
  );

  logic        [SUM_W-1:0]     xy, xy_q;
  logic signed [PRODUCT_W-1:0] z_q;
  logic                        valid_xy, ready_xy;
  assign xy = SUM_W'(x) + SUM_W'(y);
  pipe_stage #(.W(SUM_W + PRODUCT_W)) u_xy (
    .clk_i, .rst_ni, .valid_i(valid_products), .ready_o(ready_products), .data_i({xy, z}),
    .valid_o(valid_xy), .ready_i(ready_xy), .data_o({xy_q, z_q})
  );

  logic [SUM_W-1:0] xyz;
  assign xyz = xy_q + SUM_W'(z_q);
  pipe_stage #(.W(SUM_W)) u_xyz (
    .clk_i, .rst_ni, .valid_i(valid_xy), .ready_o(ready_xy), .data_i(xyz),
    .valid_o, .ready_i, .data_o(sum_o)
  );

endmodule

`default_nettype wire
