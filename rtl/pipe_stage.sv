`default_nettype none

/// The one elastic register: holds at most one item, takes the next in the cycle in which its own leaves.
///
/// A chain of them is a pipeline that squeezes its bubbles out under back-pressure. `ready_o` depends on `ready_i` without a register, so the chain's enables
/// are an OR over the valid bits behind; latency 1, interval 1. Only the valid bit is reset.
module pipe_stage #(
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

  logic         valid_q;
  logic [W-1:0] data_q;

  assign ready_o = ready_i || !valid_q;
  assign valid_o = valid_q;
  assign data_o  = data_q;

  always_ff @(posedge clk_i) begin
    if (!rst_ni) valid_q <= 1'b0;
    else if (ready_o) valid_q <= valid_i;
  end

  always_ff @(posedge clk_i) begin
    // Whether valid or not: one gate and one net less before the enables, which are the slowest paths of long pipelines.
    if (ready_o) data_q <= data_i;
  end

endmodule

`default_nettype wire
