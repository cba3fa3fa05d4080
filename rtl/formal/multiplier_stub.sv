`default_nettype none

/// A product as the operator, in one piece.
///
/// Stands for rtl/multiplier.sv where a property is about what is done with products; that the multiplier is exact is a property of its own.
module multiplier #(
  parameter int unsigned A_W = 33,
  parameter int unsigned B_W = 33,
  parameter int unsigned FACTOR_STAGES = 0,
  parameter int unsigned PRODUCT_STAGES = 1,
  parameter bit LAST_IS_SKID = 1'b0
) (
  input  logic               clk_i,
  input  logic               rst_ni,
  input  logic               valid_i,
  output logic               ready_o,
  input  logic [A_W-1:0]     a_i,
  input  logic [B_W-1:0]     b_i,
  output logic               valid_o,
  input  logic               ready_i,
  output logic [A_W+B_W-1:0] product_o
);

  logic signed [A_W+B_W-1:0] a, b;
  assign a = {{B_W{a_i[A_W-1]}}, a_i};
  assign b = {{A_W{b_i[B_W-1]}}, b_i};
  assign {ready_o, valid_o} = {ready_i, valid_i};
  assign product_o = a * b;

endmodule

`default_nettype wire
