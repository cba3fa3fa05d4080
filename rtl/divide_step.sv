`default_nettype none

/// One step of a restoring division: the next BITS bits of the quotient, a digit, and the next remainder of remainder_i / divisor.
///
/// quotient_o = floor(2^BITS remainder_i / divisor), remainder_o = 2^BITS remainder_i - quotient_o * divisor. odd_i: the divisor's odd multiples below 2^BITS, from
/// `divide_multiples`; all multiples are compared side by side, so that a step is one subtraction deep, and as many choices as the digit has bits.
/// Invariant: remainder_i < divisor gives remainder_o < divisor. From remainder n, k steps yield the k digits of floor(2^(k BITS) n / divisor), highest
/// first. Legal: remainder_i < divisor, BITS 1 to 3. Combinational.
module divide_step #(
  parameter int unsigned W = 34,
  parameter int unsigned BITS = 1
) (
  input  logic [W-1:0]                       remainder_i,
  input  logic [2**(BITS-1)-1:0][W+BITS-1:0] odd_i,
  output logic [BITS-1:0]                    quotient_o,
  output logic [W-1:0]                       remainder_o
);

  localparam int unsigned DIGITS = 2**BITS;
  localparam int unsigned SHIFTED_W = W + BITS;
  if (BITS < 1 || BITS > 3) begin : g_illegal_bits
    $error("divide_step: BITS = %0d, must be 1 to 3", BITS);
  end

  logic [SHIFTED_W-1:0]        shifted;
  logic [DIGITS-1:1]           fits;
  logic [DIGITS-1:0][W-1:0]    remainder, chosen;
  logic [DIGITS-1:0][BITS-1:0] digit, chosen_digit;
  assign shifted = {remainder_i, {BITS{1'b0}}};

  // The multiple fits iff there is no borrow. What is left of the largest that fits is below the divisor: W bits.
  assign remainder[0] = shifted[W-1:0];
  assign digit[0]     = '0;
  for (genvar k = 1; k < DIGITS; k++) begin : g_multiple
    localparam int unsigned TWOS = (k % 4 == 0) ? 2 : (k % 2 == 0) ? 1 : 0;
    logic [SHIFTED_W:0] difference;
    logic               unused_high;
    assign difference   = {1'b0, shifted} - {1'b0, odd_i[k >> (TWOS + 1)] << TWOS};
    assign fits[k]      = !difference[SHIFTED_W];
    assign remainder[k] = difference[W-1:0];
    assign digit[k]     = BITS'(k);
    assign unused_high  = ^difference[SHIFTED_W-1:W];
  end
  // A choice is between two neighbouring ranges of digits; the lowest digit of the upper one decides.
  always_comb begin
    chosen       = remainder;
    chosen_digit = digit;
    for (int unsigned level = 0; level < BITS; level++) begin
      for (int unsigned k = 0; k < (DIGITS >> (level + 1)); k++) begin
        chosen[k]       = fits[(2 * k + 1) << level] ? chosen[2*k+1] : chosen[2*k];
        chosen_digit[k] = fits[(2 * k + 1) << level] ? chosen_digit[2*k+1] : chosen_digit[2*k];
      end
    end
  end
  assign remainder_o = chosen[0];
  assign quotient_o  = chosen_digit[0];

endmodule

`default_nettype wire
