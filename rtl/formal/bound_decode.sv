`default_nettype none

/// The displacement bound from its code.

/// The bound is floor(code^2 mantissa / 2^shift); code 0 gives 0. The product is the operator, in one piece.
module bound_decode_exact (
  input logic                      clk_i,
  input logic                      rst_ni,
  input lod_pkg::bound_decode_in_t in_i
);

  lod_pkg::bound_decode_out_t out;
  bound_decode #(.TAG_W(1)) u_decode (
    .clk_i, .rst_ni, .valid_i(1'b1), .ready_o(), .in_i, .tag_i(1'b0), .valid_o(), .ready_i(1'b1), .out_o(out), .tag_o()
  );

  logic [19:0] code, square;
  logic [39:0] wide_square, mantissa, product, expected;
  assign code        = {10'd0, in_i.code};
  assign square      = code * code;
  assign wide_square = {20'd0, square};
  assign mantissa    = {22'd0, in_i.scale.mantissa};
  assign product     = wide_square * mantissa;
  assign expected    = product >> in_i.scale.shift;

  always_comb begin
    assert (out.h == expected[32:0]);
    assert (in_i.code != '0 || out.h == '0);
    cover (in_i.code == 10'd1023 && in_i.scale.mantissa == 18'd63 && in_i.scale.shift == 6'd3);
  end

endmodule

`default_nettype wire
