`default_nettype none

/// A box in the frame of a node of six.

/// Each plane is min(32767, origin + floor(v (2 + half) 2^exponent / 2)): nothing wraps.
module box_decode8_exact (
  input logic                     clk_i,
  input logic                     rst_ni,
  input lod_pkg::box_decode8_in_t in_i,
  input logic [7:0]               tag_i
);

  localparam logic signed [31:0] MOST = 32'sd32767;

  lod_pkg::box_decode8_out_t out;
  logic [7:0]                tag;
  logic                      valid, ready;
  box_decode8 u_decode (.clk_i, .rst_ni, .valid_i(1'b1), .ready_o(ready), .in_i, .tag_i, .valid_o(valid), .ready_i(1'b1), .out_o(out), .tag_o(tag));

  logic [2:0][15:0] origin, lo, hi;
  logic [2:0]       legal, exact;
  assign origin = {in_i.origin.z, in_i.origin.y, in_i.origin.x};
  assign lo     = {out.bounds.lo.z, out.bounds.lo.y, out.bounds.lo.x};
  assign hi     = {out.bounds.hi.z, out.bounds.hi.y, out.bounds.hi.x};
  for (genvar k = 0; k < 3; k++) begin : g_axis
    logic signed [15:0] from, low, high;
    logic signed [31:0] below, above;
    assign {from, low, high} = {origin[k], lo[k], hi[k]};
    assign below    = 32'(from) + (((32'(in_i.lo[k]) * (in_i.halves[k] ? 32'd3 : 32'd2)) << in_i.exponents[k]) >> 1);
    assign above    = 32'(from) + (((32'(in_i.hi[k]) * (in_i.halves[k] ? 32'd3 : 32'd2)) << in_i.exponents[k]) >> 1);
    assign legal[k] = from != 16'sh8000;
    assign exact[k] = 32'(low) == (below > MOST ? MOST : below) && 32'(high) == (above > MOST ? MOST : above);
  end

  always_comb begin
    assume (legal == '1);
    assert (exact == '1);
    assert (tag == tag_i && valid && ready);
    cover (out.bounds.lo.x == 16'sd32767 && out.bounds.lo.y == -16'sd32767 && out.bounds.hi.y == 16'sd32767 && in_i.hi[1] == 8'd255);
    cover (in_i.halves[2] && in_i.exponents[2] == '0 && in_i.hi[2] == 8'd3 && out.bounds.hi.z == in_i.origin.z + 16'sd4);
  end

endmodule

`default_nettype wire
