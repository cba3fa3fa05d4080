`default_nettype none

/// The state of an edge from its bound h and the tolerated displacement D.

/// The cases at full width: closed, fully open, between.
module edge_opening_cases (
  input logic                            clk_i,
  input logic                            rst_ni,
  input logic [lod_pkg::BOUND_W-1:0]     h_i,
  input logic [lod_pkg::TOLERANCE_W-1:0] d_i
);

  logic [lod_pkg::EDGE_STATE_W-1:0] s;
  logic                             open, valid, ready;
  edge_opening u_opening (
    .clk_i, .rst_ni, .valid_i(1'b1), .ready_o(ready), .h_i, .d_i, .open_o(open), .valid_o(valid), .ready_i(1'b1), .s_o(s)
  );

  localparam int unsigned WIDE = lod_pkg::TOLERANCE_W + 2;
  logic [WIDE-1:0] h, d;
  assign {h, d} = {WIDE'(h_i), WIDE'(d_i)};

  always_comb begin
    assert ((s == '0) == (h <= d));
    assert ((s == lod_pkg::EDGE_STATE_W'(lod_pkg::S_ONE)) == (h > d && h >= 2 * d));
    assert (s <= lod_pkg::EDGE_STATE_W'(lod_pkg::S_ONE));
    assert (open == (s != '0) && valid && ready);
    cover (h_i == '1 && d_i[32:0] == '1 && d_i[33]);
    cover (d_i == '0 && h_i == 33'd1);
    cover (s == 9'd1);
    cover (s == 9'd255 && d_i[31]);
  end

endmodule

/// A larger bound or a smaller tolerance never closes the edge: the whole, narrow.
module edge_opening_monotone (
  input logic                            clk_i,
  input logic                            rst_ni,
  input logic [lod_pkg::BOUND_W-1:0]     high_h_i,
  input logic [lod_pkg::TOLERANCE_W-1:0] high_d_i,
  input logic [lod_pkg::BOUND_W-1:0]     low_h_i,
  input logic [lod_pkg::TOLERANCE_W-1:0] low_d_i
);

  logic [lod_pkg::EDGE_STATE_W-1:0] high, low;
  edge_opening u_high (
    .clk_i, .rst_ni, .valid_i(1'b1), .ready_o(), .h_i(high_h_i), .d_i(high_d_i), .open_o(), .valid_o(), .ready_i(1'b1), .s_o(high)
  );
  edge_opening u_low (
    .clk_i, .rst_ni, .valid_i(1'b1), .ready_o(), .h_i(low_h_i), .d_i(low_d_i), .open_o(), .valid_o(), .ready_i(1'b1), .s_o(low)
  );

  always_comb begin
    assume (high_h_i >= low_h_i && high_d_i <= low_d_i);
    assert (high >= low);
    cover (high == 9'd200 && low == 9'd100 && high_h_i > low_h_i && high_d_i < low_d_i);
  end

endmodule

/// The whole division, narrow: the state is the formula.
module edge_opening_exact (
  input logic                            clk_i,
  input logic                            rst_ni,
  input logic [lod_pkg::BOUND_W-1:0]     h_i,
  input logic [lod_pkg::TOLERANCE_W-1:0] d_i
);

  logic [lod_pkg::EDGE_STATE_W-1:0] s;
  edge_opening u_opening (
    .clk_i, .rst_ni, .valid_i(1'b1), .ready_o(), .h_i, .d_i, .open_o(), .valid_o(), .ready_i(1'b1), .s_o(s)
  );

  localparam int unsigned WIDE = lod_pkg::TOLERANCE_W + 9;
  logic [WIDE-1:0] h, d, quotient, expected;
  assign {h, d}   = {WIDE'(h_i), WIDE'(d_i)};
  assign quotient = ((h - d) << 8) / d;
  assign expected = h <= d ? '0 : h >= 2 * d ? WIDE'(256) : quotient == '0 ? WIDE'(1) : quotient > WIDE'(255) ? WIDE'(255) : quotient;

  always_comb begin
    assert (WIDE'(s) == expected);
    cover (s == 9'd255);
    cover (s == 9'd1);
    cover (s == 9'd256);
  end

endmodule

`default_nettype wire
