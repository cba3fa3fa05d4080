`default_nettype none

/// A dot product as a free variable: it shows the low halves of x and y of its first vector, which take any values however the vectors are differences.
///
/// Stands for rtl/dot_product.sv where a property holds for whatever the dots of the corners are, the same for the same corner.
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

  assign {ready_o, valid_o} = {ready_i, valid_i};
  assign sum_o = SUM_W'({a_i[2*A_W +: 32], a_i[A_W +: 32]});

endmodule

`default_nettype wire
