  // Inside cone_tolerance, with the product free in its range: D is the clamped floor of the exact sum, and grows with it.
  localparam int unsigned WIDE = 64;
  logic signed [WIDE-1:0] wide_l, wide_product, exact, shifted, expected, shifted_other, expected_other;
  logic        [WIDE-1:0] wide_offset;
  (* anyseq *) logic signed [WIDE-1:0] other;
  localparam logic signed [WIDE-1:0] LARGEST = (64'sd1 <<< D_W) - 64'sd1;
  localparam logic signed [WIDE-1:0] PRODUCT_LIMIT = 64'sd1 <<< (L_W - 1 + SLOPE_W - 1);
  assign wide_l         = WIDE'(l);
  assign wide_product   = WIDE'(product);
  assign wide_offset    = WIDE'(cone_i.offset);
  assign exact          = $signed(wide_offset) + (wide_l <<< (SLOPE_W - 1)) + wide_product;
  assign shifted        = exact >>> cone_i.shift;
  assign expected       = shifted < 0 ? 64'sd0 : shifted > LARGEST ? LARGEST : shifted;
  assign shifted_other  = other >>> cone_i.shift;
  assign expected_other = shifted_other < 0 ? 64'sd0 : shifted_other > LARGEST ? LARGEST : shifted_other;

  always_comb begin
    // A product of l, at least -2^33, and slope - 2^17, at least -2^17.
    assume (wide_product <= PRODUCT_LIMIT && wide_product >= -PRODUCT_LIMIT);
    // No sum wraps.
    assert (sum == exact[SUM_W-1:0] && exact == WIDE'(sum));
    assert (WIDE'(d_o) == expected);
    assert (other > exact || expected_other <= WIDE'(d_o));
    cover (d_o == '1 && cone_i.shift == 6'd5 && exact[40:5] != '1);
    cover (d_o == 34'd12345 && cone_i.shift == 6'd21);
    cover (d_o == '0 && exact < 0 && cone_i.shift == 6'd63);
  end

