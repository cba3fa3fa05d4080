  // Inside bound_decode, with the product free: the two shifts are one, and the bound never falls when the product grows.
  (* anyseq *) logic [PRODUCT_W-1:0] other;
  logic [PRODUCT_W-1:0] shifted, shifted_other;
  assign shifted       = product[PRODUCT_W-1:0] >> in_i.scale.shift;
  assign shifted_other = other >> in_i.scale.shift;

  always_comb begin
    // Both factors are unsigned.
    assume (product[PRODUCT_W+1:PRODUCT_W] == '0);
    // A legal scale: its largest bound fits.
    assume (shifted[PRODUCT_W-1:H_W] == '0);
    assert (PRODUCT_W'(out_o.h) == shifted);
    assert (other > product[PRODUCT_W-1:0] || PRODUCT_W'(out_o.h) >= shifted_other);
    assert (square == SQUARE_W'(in_i.code) * SQUARE_W'(in_i.code) && tag_o == tag_i);
    cover (out_o.h == '1 && in_i.scale.shift == 6'd5);
    cover (out_o.h == 33'd1 && in_i.scale.shift == 6'd37);
  end

