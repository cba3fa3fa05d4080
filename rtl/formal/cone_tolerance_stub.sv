`default_nettype none

/// The tolerance shown as the distance that it is made from.
///
/// Stands for rtl/cone_tolerance.sv where a property holds for every tolerance that depends on the distance and the ray's cone alone.
module cone_tolerance (
  input  logic                            clk_i,
  input  logic                            rst_ni,
  input  logic                            valid_i,
  output logic                            ready_o,
  input  logic [lod_pkg::DISTANCE_W-1:0]  l_i,
  input  lod_pkg::cone_t                  cone_i,
  output logic                            valid_o,
  input  logic                            ready_i,
  output logic [lod_pkg::TOLERANCE_W-1:0] d_o
);

  assign {ready_o, valid_o, d_o} = {ready_i, valid_i, lod_pkg::TOLERANCE_W'(l_i)};

endmodule

`default_nettype wire
