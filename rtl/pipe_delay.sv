`default_nettype none

/// `STAGES` elastic registers in a row: keeps a value in step with a pipeline of that latency beside it.
///
/// Pipelines of equal latency that see the same `valid_i` and `ready_i` move in lockstep, so one of them may speak for all. 0 stages are a wire.
/// Bit k of SKIDS makes stage k a `pipe_skid`, which cuts the chain of readies: pipelines in lockstep must have theirs at the same stages.
module pipe_delay #(
  parameter int unsigned W = 1,
  parameter int unsigned STAGES = 1,
  parameter bit [63:0] SKIDS = '0
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

  logic [STAGES:0]        valid;
  logic [STAGES:0]        ready;
  logic [STAGES:0][W-1:0] data;

  assign valid[0] = valid_i;
  assign data[0]  = data_i;
  assign ready_o  = ready[0];

  for (genvar k = 0; k < STAGES; k++) begin : g_stage
    if (SKIDS[k]) begin : g_skid
      pipe_skid #(.W(W)) u_stage (
        .clk_i, .rst_ni,
        .valid_i(valid[k]), .ready_o(ready[k]), .data_i(data[k]),
        .valid_o(valid[k+1]), .ready_i(ready[k+1]), .data_o(data[k+1])
      );
    end else begin : g_plain
      pipe_stage #(.W(W)) u_stage (
        .clk_i, .rst_ni,
        .valid_i(valid[k]), .ready_o(ready[k]), .data_i(data[k]),
        .valid_o(valid[k+1]), .ready_i(ready[k+1]), .data_o(data[k+1])
      );
    end
  end

  if (STAGES == 0) begin : g_wire
    logic unused_clock;
    assign unused_clock = clk_i ^ rst_ni;
  end

  assign valid_o       = valid[STAGES];
  assign data_o        = data[STAGES];
  assign ready[STAGES] = ready_i;

endmodule

`default_nettype wire
