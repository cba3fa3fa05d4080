/// The displacement bound from its code.

/// The bound is floor(code^2 mantissa / 2^shift) and grows with the code, for mantissas of a few bits.
module bound_decode_exact (
  input logic                      clk_i,
  input logic                      rst_ni,
  input lod_pkg::bound_decode_in_t in_i
);

  lod_pkg::bound_decode_out_t out;
  bound_decode #(.TAG_W(1)) u_decode (
    .clk_i, .rst_ni, .valid_i(1'b1), .ready_o(), .in_i, .tag_i(1'b0), .valid_o(), .ready_i(1'b1), .out_o(out), .tag_o()
  );

  logic [47:0] code, expected;
  assign code     = 48'(in_i.code);
  assign expected = (code * code * 48'(in_i.scale.mantissa)) >> in_i.scale.shift;

  always_comb begin
    assume (in_i.scale.mantissa < 18'd64);
    assert (48'(out.h) == expected);
    assert (in_i.code != '0 || out.h == '0);
    cover (in_i.code == 10'd1023 && in_i.scale.mantissa == 18'd63 && in_i.scale.shift == 6'd3);
  end

endmodule
