`default_nettype none

/// The multiplier and its adder tree.

/// The adder tree over limb products is exact: no level wraps. A product of two limbs is at most 2^34 in magnitude, one of a factor of n limbs and a limb 2^(17 n + 17).
module limb_sum_exact #(
  parameter int unsigned N = 4,
  parameter int unsigned W = 36,
  parameter int unsigned STEP = 17
) (
  input logic           clk_i,
  input logic           rst_ni,
  input logic [N*W-1:0] data_i
);

  localparam int unsigned SUM_W = W + (N - 1) * STEP;
  localparam int unsigned WIDE = SUM_W + 4;

  logic signed [SUM_W-1:0] sum;
  limb_sum #(.N(N), .W(W), .STEP(STEP)) u_sum (.clk_i, .rst_ni, .valid_i(1'b1), .ready_o(), .data_i, .valid_o(), .ready_i(1'b1), .sum_o(sum));

  logic signed [WIDE-1:0] exact;
  logic signed [W-1:0]    limb;
  logic                   legal;
  always_comb begin
    exact = '0;
    legal = 1'b1;
    limb  = '0;
    for (int unsigned k = 0; k < N; k++) begin
      limb  = data_i[k*W +: W];
      exact = exact + (WIDE'(limb) <<< (k * STEP));
      // Up to 2^(W-2) in magnitude.
      legal = legal && (limb[W-1:W-2] == 2'b00 || limb[W-1:W-2] == 2'b11 || (limb[W-1:W-2] == 2'b01 && limb[W-3:0] == '0));
    end
  end

  always_comb begin
    assume (legal);
    assert (WIDE'(sum) == exact);
    cover (data_i[W-1 -: 2] == 2'b01 && data_i[N*W-1 -: 2] == 2'b01);
    cover (exact < 0 && data_i[W-1] == 1'b0);
  end

endmodule

/// The whole, narrow: with limbs of three bits the factors have four and two of them, as those of an edge function's dots do with limbs of 17.
module multiplier_exact #(
  parameter int unsigned A_W = 11,
  parameter int unsigned B_W = 6
) (
  input logic                  clk_i,
  input logic                  rst_ni,
  input logic signed [A_W-1:0] a_i,
  input logic signed [B_W-1:0] b_i
);

  localparam int unsigned WIDE = A_W + B_W;
  logic signed [WIDE-1:0] product, expected;
  multiplier #(.A_W(A_W), .B_W(B_W)) u_product (
    .clk_i, .rst_ni, .valid_i(1'b1), .ready_o(), .a_i, .b_i, .valid_o(), .ready_i(1'b1), .product_o(product)
  );
  assign expected = WIDE'(a_i) * WIDE'(b_i);

  always_comb begin
    assert (product == expected);
    cover (a_i == {1'b1, {(A_W-1){1'b0}}} && b_i == {1'b1, {(B_W-1){1'b0}}});
    cover (a_i < 0 && b_i > 0);
  end

endmodule

`default_nettype wire
