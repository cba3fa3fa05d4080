`default_nettype none

/// The widened box of a child.

/// It is the smallest box of codes that holds the stored box and the three corners: rounded outwards, and nothing wraps.
module widen_box_outwards (
  input logic                   clk_i,
  input logic                   rst_ni,
  input lod_pkg::widen_box_in_t in_i,
  input logic [7:0]             tag_i
);

  localparam logic signed [33:0] LIMIT = 34'h0_7ffe_0000;

  lod_pkg::widen_box_out_t out;
  logic [7:0]              tag;
  logic                    valid, ready;
  widen_box u_widen (.clk_i, .rst_ni, .valid_i(1'b1), .ready_o(ready), .in_i, .tag_i, .valid_o(valid), .ready_i(1'b1), .out_o(out), .tag_o(tag));

  // Per coordinate: the box before and after, and the corners.
  logic [47:0] lo_before, lo, hi_before, hi;
  logic [95:0] p0, p1, p2;
  assign {lo_before, hi_before} = in_i.bounds;
  assign {lo, hi}               = out.bounds;
  assign {p0, p1, p2}           = {in_i.p0, in_i.p1, in_i.p2};

  logic [2:0] legal, holds, tight;
  for (genvar k = 0; k < 3; k++) begin : g_axis
    // In units, with room.
    logic signed [31:0] p, q, r, l, h, l_before, h_before;
    logic signed [33:0] a, b, c, low, high, low_before, high_before;
    assign {p, q, r}            = {p0[k*32 +: 32], p1[k*32 +: 32], p2[k*32 +: 32]};
    assign {l, h}               = {lo[k*16 +: 16], 16'd0, hi[k*16 +: 16], 16'd0};
    assign {l_before, h_before} = {lo_before[k*16 +: 16], 16'd0, hi_before[k*16 +: 16], 16'd0};
    assign {a, b, c}            = {34'(p), 34'(q), 34'(r)};
    assign {low, high}          = {34'(l), 34'(h)};
    assign {low_before, high_before} = {34'(l_before), 34'(h_before)};
    assign legal[k] = a <= LIMIT && a >= -LIMIT && b <= LIMIT && b >= -LIMIT && c <= LIMIT && c >= -LIMIT;
    assign holds[k] = low <= a && low <= b && low <= c && low <= low_before && high >= a && high >= b && high >= c && high >= high_before;
    // A step further in, something would stick out.
    assign tight[k] = (low + 34'sd65536 > a || low + 34'sd65536 > b || low + 34'sd65536 > c || low + 34'sd65536 > low_before)
      && (high - 34'sd65536 < a || high - 34'sd65536 < b || high - 34'sd65536 < c || high - 34'sd65536 < high_before);
  end

  always_comb begin
    assume (legal == '1);
    assert (holds == '1);
    assert (tight == '1);
    assert (tag == tag_i && valid && ready);
    cover (p0[31:0] == LIMIT[31:0] && out.bounds.hi.z == 16'sd32766);
    cover (p1[31:0] == 32'h8002_0000 && out.bounds.lo.z == -16'sd32766 && in_i.bounds.lo.z == 16'sd7);
  end

endmodule

`default_nettype wire
