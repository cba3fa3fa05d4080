`default_nettype none

/// The bound shown as the code that it is made from.
///
/// Stands for rtl/bound_decode.sv where a property holds for every bound that depends on the code and the model's scale alone.
module bound_decode #(
  parameter int unsigned TAG_W = 8
) (
  input  logic                       clk_i,
  input  logic                       rst_ni,
  input  logic                       valid_i,
  output logic                       ready_o,
  input  lod_pkg::bound_decode_in_t  in_i,
  input  logic [TAG_W-1:0]           tag_i,
  output logic                       valid_o,
  input  logic                       ready_i,
  output lod_pkg::bound_decode_out_t out_o,
  output logic [TAG_W-1:0]           tag_o
);

  assign {ready_o, valid_o, tag_o} = {ready_i, valid_i, tag_i};
  assign out_o = lod_pkg::BOUND_DECODE_OUT_W'(in_i.code);

endmodule

`default_nettype wire
