`default_nettype none

/// The tolerated displacement, with its product.

/// D is clamp(floor((offset + l slope) / 2^shift)), narrow in l.
module cone_tolerance_exact (
  input logic                           clk_i,
  input logic                           rst_ni,
  input logic [lod_pkg::DISTANCE_W-1:0] l_i,
  input lod_pkg::cone_t                 cone_i
);

  logic [lod_pkg::TOLERANCE_W-1:0] d;
  cone_tolerance u_tolerance (
    .clk_i, .rst_ni, .valid_i(1'b1), .ready_o(), .l_i, .cone_i, .valid_o(), .ready_i(1'b1), .d_o(d)
  );

  localparam logic signed [63:0] LARGEST = (64'sd1 <<< lod_pkg::TOLERANCE_W) - 64'sd1;
  logic signed [lod_pkg::DISTANCE_W-1:0] near;
  logic signed [63:0]                    l, slope, offset, shifted, expected;
  assign near     = l_i;
  assign l        = 64'(near);
  assign slope    = {46'd0, cone_i.slope};
  assign offset   = {11'd0, cone_i.offset};
  assign shifted  = (offset + l * slope) >>> cone_i.shift;
  assign expected = shifted < 0 ? 64'sd0 : shifted > LARGEST ? LARGEST : shifted;

  always_comb begin
    assert (64'(d) == expected);
    cover (l < 0 && cone_i.slope > 18'd1000 && cone_i.slope < 18'd2000 && d == 34'd99);
    cover (l > 0 && cone_i.slope > 18'd200000 && d == 34'd99);
  end

endmodule

`default_nettype wire
