`default_nettype none

/// The opening shown as what it is made from: the low bits of the bound, and the bit of the tolerance that they choose.
///
/// Stands for rtl/edge_opening.sv where a property holds for every opening that depends on bound and tolerance alone: if this one is the same for every bound,
/// the tolerances are the same in every bit.
module edge_opening (
  input  logic                             clk_i,
  input  logic                             rst_ni,
  input  logic                             valid_i,
  output logic                             ready_o,
  input  logic [lod_pkg::BOUND_W-1:0]      h_i,
  input  logic [lod_pkg::TOLERANCE_W-1:0]  d_i,
  output logic                             open_o,
  output logic                             valid_o,
  input  logic                             ready_i,
  output logic [lod_pkg::EDGE_STATE_W-1:0] s_o
);

  assign {ready_o, valid_o} = {ready_i, valid_i};
  assign s_o    = {h_i[7:0], d_i[h_i[5:0] < 6'(lod_pkg::TOLERANCE_W) ? h_i[5:0] : 6'd0]};
  assign open_o = s_o != '0;

endmodule

`default_nettype wire
