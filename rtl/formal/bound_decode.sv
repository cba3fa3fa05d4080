`default_nettype none

/// The displacement bound from its code.

/// The bound is 0 for code 0, else floor(M 2^floor(k / 16) / 256) with k = code + offset, M being the least number whose 16th power is 2^(128 + k mod 16) or
/// more; it does not wrap.
module bound_decode_exact (
  input logic                      clk_i,
  input logic                      rst_ni,
  input lod_pkg::bound_decode_in_t in_i,
  input logic [7:0]                tag_i
);

  lod_pkg::bound_decode_out_t out;
  logic [7:0]                 tag;
  logic                       valid, ready;
  bound_decode u_decode (.clk_i, .rst_ni, .valid_i(1'b1), .ready_o(ready), .in_i, .tag_i, .valid_o(valid), .ready_i(1'b1), .out_o(out), .tag_o(tag));

  // 2^(i / 16) in steps of 1/256, i = 0 last.
  localparam logic [16*9-1:0] ROOTS = {9'd491, 9'd470, 9'd450, 9'd431, 9'd413, 9'd395, 9'd379, 9'd363, 9'd347, 9'd332, 9'd318, 9'd305, 9'd292, 9'd280, 9'd268, 9'd256};
  for (genvar i = 0; i < 16; i++) begin : g_root
    localparam logic [159:0] M = {151'd0, ROOTS[9*i +: 9]};
    localparam logic [159:0] BEFORE = M - 160'd1;
    localparam logic [159:0] M4 = M * M * M * M;
    localparam logic [159:0] BEFORE4 = BEFORE * BEFORE * BEFORE * BEFORE;
    localparam logic [159:0] LEAST = 160'd1 << (128 + i);
    always_comb assert (M4 * M4 * M4 * M4 >= LEAST && BEFORE4 * BEFORE4 * BEFORE4 * BEFORE4 < LEAST);
  end

  logic [9:0]  k;
  logic [8:0]  mantissa;
  logic [47:0] expected;
  assign mantissa = 9'(ROOTS >> (8'd9 * {4'd0, k[3:0]}));
  assign k        = {2'd0, in_i.code} + {1'b0, in_i.scale.offset};
  assign expected = in_i.code == '0 ? '0 : ({39'd0, mantissa} << k[9:4]) >> 8;

  always_comb begin
    // The largest offset that there is.
    assume (in_i.scale.offset <= 9'd272);
    assert (48'(out.h) == expected);
    assert (tag == tag_i && valid && ready);
    cover (out.h > 33'h1_ea00_0000 && in_i.code == '1);
    cover (out.h == '0 && k == 10'd272);
    cover (out.h == 33'd1 && k[3:0] == 4'd15);
  end

endmodule

/// A larger code or a larger offset never gives a smaller bound.
module bound_decode_monotone (
  input logic                      clk_i,
  input logic                      rst_ni,
  input lod_pkg::bound_decode_in_t low_i,
  input lod_pkg::bound_decode_in_t high_i
);

  lod_pkg::bound_decode_out_t low, high;
  bound_decode #(.TAG_W(1)) u_low (
    .clk_i, .rst_ni, .valid_i(1'b1), .ready_o(), .in_i(low_i), .tag_i(1'b0), .valid_o(), .ready_i(1'b1), .out_o(low), .tag_o()
  );
  bound_decode #(.TAG_W(1)) u_high (
    .clk_i, .rst_ni, .valid_i(1'b1), .ready_o(), .in_i(high_i), .tag_i(1'b0), .valid_o(), .ready_i(1'b1), .out_o(high), .tag_o()
  );

  always_comb begin
    assume (high_i.scale.offset <= 9'd272 && low_i.scale.offset <= high_i.scale.offset && low_i.code <= high_i.code);
    assert (low.h <= high.h);
    cover (low.h != '0 && low.h < high.h && low_i.scale == high_i.scale);
  end

endmodule

`default_nettype wire
