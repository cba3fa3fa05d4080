`default_nettype none

/// The odd multiples of a divisor that a `divide_step` of BITS bits takes: once, three times, up to 2^BITS - 1 times, lowest first.
///
/// Each takes one sum. Legal: BITS 1 to 3. Combinational.
module divide_multiples #(
  parameter int unsigned W = 34,
  parameter int unsigned BITS = 1
) (
  input  logic [W-1:0]                       divisor_i,
  output logic [2**(BITS-1)-1:0][W+BITS-1:0] odd_o
);

  localparam int unsigned MULTIPLE_W = W + BITS;
  logic [MULTIPLE_W-1:0] divisor;
  assign divisor = MULTIPLE_W'(divisor_i);

  for (genvar k = 0; k < 2**(BITS-1); k++) begin : g_odd
    // 1, 1 + 2, 1 + 4, 8 - 1.
    if (k == 0) begin : g_once
      assign odd_o[k] = divisor;
    end else if (k < 3) begin : g_sum
      assign odd_o[k] = divisor + (divisor << k);
    end else begin : g_difference
      assign odd_o[k] = (divisor << 3) - divisor;
    end
  end

endmodule

`default_nettype wire
