`default_nettype none

/// A step of a division as a free variable: any digit, and any remainder below the divisor after one below it.
///
/// Stands for rtl/divide_step.sv where a property holds for whatever the digits are; that a step keeps its remainder below the divisor is `divide_step_exact`.
module divide_step #(
  parameter int unsigned W = 34,
  parameter int unsigned BITS = 1
) (
  input  logic [W-1:0]                       remainder_i,
  input  logic [2**(BITS-1)-1:0][W+BITS-1:0] odd_i,
  output logic [BITS-1:0]                    quotient_o,
  output logic [W-1:0]                       remainder_o
);

  (* anyseq *) logic [W-1:0]    remainder;
  (* anyseq *) logic [BITS-1:0] quotient;
  assign {quotient_o, remainder_o} = {quotient, remainder};
  always_comb assume ((W+BITS)'(remainder_i) >= odd_i[0] || (W+BITS)'(remainder) < odd_i[0]);

endmodule

`default_nettype wire
