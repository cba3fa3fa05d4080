`default_nettype none

/// Whole steps along an axis of a group of boxes: floor(w 2^exponent / 2) codes of 2^16 units, w being v (2 + half) for v steps (docs/numbers.md).
///
/// At most 2^16 - 1, from where on every box code that they are added to or taken from saturates. Combinational.
module box_steps #(
  parameter int unsigned W = 9
) (
  input  logic [W-1:0] w_i,
  input  logic [3:0]   exponent_i,
  output logic [15:0]  steps_o
);

  localparam int unsigned STEPS_W = 16;
  // 15 at most to the left; the half is the lowest bit.
  localparam int unsigned SHIFTED_W = W + 15;

  logic [SHIFTED_W-1:0] shifted;
  logic                 unused_half;
  assign shifted     = SHIFTED_W'(w_i) << exponent_i;
  assign steps_o     = shifted[SHIFTED_W-1:STEPS_W+1] != '0 ? '1 : shifted[STEPS_W:1];
  assign unused_half = shifted[0];

endmodule

`default_nettype wire
