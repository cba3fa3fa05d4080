`default_nettype none

/// One step of a restoring division: the next quotient bit and remainder of remainder_i / divisor_i.
///
/// quotient_bit_o = (2 remainder_i >= divisor_i), remainder_o = 2 remainder_i - quotient_bit_o * divisor_i.
/// Invariant: remainder_i < divisor_i gives remainder_o < divisor_i. From remainder n, k steps yield the k bits of floor(2^k n / divisor), highest
/// first. Legal: remainder_i < divisor_i. Combinational.
module divide_step #(
  parameter int unsigned W = 34
) (
  input  logic [W-1:0] remainder_i,
  input  logic [W-1:0] divisor_i,
  output logic         quotient_bit_o,
  output logic [W-1:0] remainder_o
);

  // Twice the remainder less the divisor: at least -divisor, below divisor; its sign is the borrow.
  logic [W:0] difference;
  assign difference     = {remainder_i, 1'b0} - {1'b0, divisor_i};
  assign quotient_bit_o = !difference[W];
  // Where the divisor is not taken, 2 remainder_i < divisor_i fits W bits.
  assign remainder_o = quotient_bit_o ? difference[W-1:0] : {remainder_i[W-2:0], 1'b0};

endmodule

`default_nettype wire
