`default_nettype none

/// Restoring division, step by step.

/// One step: the remainder stays below the divisor, and twice the old one is the quotient's bit times the divisor and the new one.
module divide_step_exact #(
  parameter int unsigned W = 34
) (
  input logic [W-1:0] remainder_i,
  input logic [W-1:0] divisor_i
);

  logic         quotient_bit;
  logic [W-1:0] remainder;
  divide_step #(.W(W)) u_step (.remainder_i, .divisor_i, .quotient_bit_o(quotient_bit), .remainder_o(remainder));

  always_comb begin
    assume (remainder_i < divisor_i);
    assert (remainder < divisor_i);
    assert ({1'b0, remainder_i, 1'b0} == (quotient_bit ? {2'b0, divisor_i} : '0) + {2'b0, remainder});
    cover (quotient_bit && remainder != '0 && divisor_i[W-1]);
    cover (!quotient_bit && divisor_i[W-1]);
  end

endmodule

/// One step of two divisions: of a larger remainder by a smaller divisor comes the larger bit, or the same bit and again the larger remainder.
module divide_step_order #(
  parameter int unsigned W = 34
) (
  input logic [W-1:0] high_remainder_i,
  input logic [W-1:0] high_divisor_i,
  input logic [W-1:0] low_remainder_i,
  input logic [W-1:0] low_divisor_i
);

  logic         high_bit, low_bit;
  logic [W-1:0] high, low;
  divide_step #(.W(W)) u_high (.remainder_i(high_remainder_i), .divisor_i(high_divisor_i), .quotient_bit_o(high_bit), .remainder_o(high));
  divide_step #(.W(W)) u_low (.remainder_i(low_remainder_i), .divisor_i(low_divisor_i), .quotient_bit_o(low_bit), .remainder_o(low));

  always_comb begin
    assume (high_remainder_i < high_divisor_i && low_remainder_i < low_divisor_i);
    assume (high_remainder_i >= low_remainder_i && high_divisor_i <= low_divisor_i);
    assert (high_bit >= low_bit && (high_bit != low_bit || high >= low));
    cover (high_bit && low_bit && high > low && low_divisor_i[W-1]);
    cover (high_bit && !low_bit);
  end

endmodule

`default_nettype wire
