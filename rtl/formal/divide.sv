`default_nettype none

/// Restoring division, step by step.

/// The multiples up to 2^BITS times a divisor, each of which is an odd one shifted, and for each but the last whether the next is it and the divisor: `next_o`.
module divide_chain #(
  parameter int unsigned W = 34,
  parameter int unsigned BITS = 1
) (
  input  logic [2**(BITS-1)-1:0][W+BITS-1:0] odd_i,
  output logic [2**BITS:0][W+BITS:0]         multiple_o,
  output logic [2**BITS-1:0]                 next_o
);

  assign multiple_o[0] = '0;
  for (genvar k = 1; k <= 2**BITS; k++) begin : g_multiple
    localparam int unsigned TWOS = (k % 8 == 0) ? 3 : (k % 4 == 0) ? 2 : (k % 2 == 0) ? 1 : 0;
    assign multiple_o[k] = {1'b0, odd_i[k >> (TWOS + 1)]} << TWOS;
    assign next_o[k-1]   = multiple_o[k] == multiple_o[k-1] + (W+BITS+1)'(odd_i[0]);
  end

endmodule

/// The odd multiples that are made of a divisor are that, and none wraps.
module divide_multiples_exact #(
  parameter int unsigned W = 34,
  parameter int unsigned BITS = 1
) (
  input logic [W-1:0] divisor_i
);

  localparam int unsigned ODDS = 2**(BITS-1);
  logic [ODDS-1:0][W+BITS-1:0] odd;
  logic [2**BITS:0][W+BITS:0]  multiple;
  logic [2**BITS-1:0]          next;
  divide_multiples #(.W(W), .BITS(BITS)) u_multiples (.divisor_i, .odd_o(odd));
  divide_chain #(.W(W), .BITS(BITS)) u_chain (.odd_i(odd), .multiple_o(multiple), .next_o(next));

  always_comb begin
    assert (next == '1 && odd[0] == (W+BITS)'(divisor_i));
    cover (odd[ODDS-1][W+BITS-1 -: 2] != '0 && multiple[1] != '0);
  end

endmodule

/// The odd multiples of a divisor are at most those of one at least as large.
module divide_multiples_order #(
  parameter int unsigned W = 34,
  parameter int unsigned BITS = 1
) (
  input logic [W-1:0] low_i,
  input logic [W-1:0] high_i
);

  logic [2**(BITS-1)-1:0][W+BITS-1:0] low, high;
  divide_multiples #(.W(W), .BITS(BITS)) u_low (.divisor_i(low_i), .odd_o(low));
  divide_multiples #(.W(W), .BITS(BITS)) u_high (.divisor_i(high_i), .odd_o(high));

  always_comb begin
    assume (low_i <= high_i);
    cover (low_i < high_i && low_i[W-1]);
  end
  for (genvar k = 0; k < 2**(BITS-1); k++) begin : g_odd
    always_comb assert (low[k] <= high[k]);
  end

endmodule

/// One step: the remainder stays below the divisor, and the old one, shifted by a digit, is the quotient's digit times the divisor and the new one. The odd
/// multiples are any; what is said of a digit needs no more of them than that the multiple by one more is the next.
module divide_step_exact #(
  parameter int unsigned W = 34,
  parameter int unsigned BITS = 1
) (
  input logic [W-1:0]                       remainder_i,
  input logic [2**(BITS-1)-1:0][W+BITS-1:0] odd_i
);

  logic [BITS-1:0]            digit;
  logic [W-1:0]               remainder, divisor;
  logic [2**BITS:0][W+BITS:0] multiple;
  logic [2**BITS-1:0]         next;
  divide_step #(.W(W), .BITS(BITS)) u_step (.remainder_i, .odd_i, .quotient_o(digit), .remainder_o(remainder));
  divide_chain #(.W(W), .BITS(BITS)) u_chain (.odd_i, .multiple_o(multiple), .next_o(next));
  assign divisor = odd_i[0][W-1:0];

  always_comb begin
    assume (odd_i[0][W+BITS-1:W] == '0 && remainder_i < divisor);
    cover (next == '1 && digit == '1 && remainder != '0 && divisor[W-1]);
    cover (next == '1 && digit == '0 && divisor[W-1]);
  end
  for (genvar k = 0; k < 2**BITS; k++) begin : g_digit
    always_comb begin
      assert (!next[k] || digit != BITS'(k) || remainder < divisor);
      assert (!next[k] || digit != BITS'(k) || {1'b0, remainder_i, {BITS{1'b0}}} == multiple[k] + (W+BITS+1)'(remainder));
    end
  end

endmodule

/// One step of two divisions: of a larger remainder by a smaller divisor comes the larger digit, or the same and again the larger remainder. The odd multiples
/// are any that are ordered and do not wrap, and likewise.
module divide_step_order #(
  parameter int unsigned W = 34,
  parameter int unsigned BITS = 1
) (
  input logic [W-1:0]                       high_remainder_i,
  input logic [2**(BITS-1)-1:0][W+BITS-1:0] high_odd_i,
  input logic [W-1:0]                       low_remainder_i,
  input logic [2**(BITS-1)-1:0][W+BITS-1:0] low_odd_i
);

  logic [BITS-1:0]            high_digit, low_digit;
  logic [W-1:0]               high, low;
  logic [2**BITS:0][W+BITS:0] high_multiple, low_multiple;
  logic [2**BITS-1:0]         high_next, low_next;
  divide_step #(.W(W), .BITS(BITS)) u_high (.remainder_i(high_remainder_i), .odd_i(high_odd_i), .quotient_o(high_digit), .remainder_o(high));
  divide_step #(.W(W), .BITS(BITS)) u_low (.remainder_i(low_remainder_i), .odd_i(low_odd_i), .quotient_o(low_digit), .remainder_o(low));

  divide_chain #(.W(W), .BITS(BITS)) u_high_chain (.odd_i(high_odd_i), .multiple_o(high_multiple), .next_o(high_next));
  divide_chain #(.W(W), .BITS(BITS)) u_low_chain (.odd_i(low_odd_i), .multiple_o(low_multiple), .next_o(low_next));

  for (genvar k = 1; k < 2**BITS; k++) begin : g_multiple
    always_comb assume (high_multiple[k] <= low_multiple[k] && !low_multiple[k][W+BITS]);
  end
  for (genvar k = 0; k < 2**BITS; k++) begin : g_digit
    always_comb assert (!high_next[k] || !low_next[k] || high_digit != BITS'(k) || low_digit != BITS'(k) || high >= low);
  end
  always_comb begin
    assume (high_odd_i[0][W+BITS-1:W] == '0 && (W+BITS)'(high_remainder_i) < high_odd_i[0]);
    assume (low_odd_i[0][W+BITS-1:W] == '0 && (W+BITS)'(low_remainder_i) < low_odd_i[0]);
    assume (high_remainder_i >= low_remainder_i);
    assert (high_digit >= low_digit);
    cover (high_next == '1 && low_next == '1 && high_digit == '1 && low_digit == '1 && high > low && low_odd_i[0][W-1]);
    cover (high_next == '1 && low_next == '1 && high_digit == '1 && low_digit == '0);
  end

endmodule

`default_nettype wire
