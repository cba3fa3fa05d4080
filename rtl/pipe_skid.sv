`default_nettype none

/// An elastic register that cuts the chain of readies: `ready_o` is a register, so no path leads from `ready_i` to it.
///
/// What `pipe_stage` does, at the price of a second register, which takes the item that arrives in the cycle in which the receiver stops. Holds at most
/// two items; latency 1, interval 1. Only the valid bits are reset.
module pipe_skid #(
  parameter int unsigned W = 1
) (
  input  logic         clk_i,
  input  logic         rst_ni,
  input  logic         valid_i,
  output logic         ready_o,
  input  logic [W-1:0] data_i,
  output logic         valid_o,
  input  logic         ready_i,
  output logic [W-1:0] data_o
);

  logic         valid_q, spare_valid_q, move;
  logic [W-1:0] data_q, spare_q;

  assign move    = ready_i || !valid_q;
  assign ready_o = !spare_valid_q;
  assign valid_o = valid_q;
  assign data_o  = data_q;

  always_ff @(posedge clk_i) begin
    if (!rst_ni) begin
      valid_q       <= 1'b0;
      spare_valid_q <= 1'b0;
    end else begin
      if (move) valid_q <= valid_i || spare_valid_q;
      // What comes while the receiver stands still waits in the spare register, and no more comes until that is empty.
      spare_valid_q <= !move && (spare_valid_q || valid_i);
    end
  end

  always_ff @(posedge clk_i) begin
    if (move) data_q <= spare_valid_q ? spare_q : data_i;
    if (ready_o) spare_q <= data_i;
  end

endmodule

`default_nettype wire
