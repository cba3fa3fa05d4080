`default_nettype none

/// An elastic register as the wire that it is for the function of a block: what goes in comes out, without time.
///
/// Stands, by their names, for rtl/pipe_stage.sv and rtl/pipe_skid.sv where a property is about values. That the register passes every item on, unchanged and in order, is a property of its own.
module elastic #(
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

  assign {ready_o, valid_o, data_o} = {ready_i, valid_i, data_i};

  logic unused_clock;
  assign unused_clock = clk_i ^ rst_ni;

endmodule

`default_nettype wire
