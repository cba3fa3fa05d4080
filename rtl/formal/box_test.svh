  // Inside box_test, with the differences of products and the entry distance free: what stands around them neither wraps nor rounds inwards.
  localparam int unsigned WIDE = 64;
  logic [2:0] mirrored, nearest, limits;
  for (genvar k = 0; k < 3; k++) begin : g_formal
    logic signed [CODE_W-1:0]   stored_low, stored_high, low, high;
    logic signed [CEIL_W-1:0]   from;
    logic signed [MOMENT_W-1:0] c;
    logic signed [LIMIT_W-1:0]  floor_c, floor_back;
    logic signed [WIDE-1:0]     wide_low, wide_high, wide_stored_low, wide_stored_high, wide_from, wide_c, distance, back;
    assign {stored_low, stored_high, low, high} = {stored_lo[k], stored_hi[k], lo[k], hi[k]};
    assign {from, c, floor_c, floor_back}       = {ceil[k], moment[k], limit[k], turned[k]};
    assign {wide_low, wide_high, wide_from, wide_c} = {WIDE'(low), WIDE'(high), WIDE'(from), WIDE'(c)};
    assign {wide_stored_low, wide_stored_high}  = {WIDE'(stored_low), WIDE'(stored_high)};
    assign distance    = wide_low - wide_from;
    assign back        = -wide_c;
    assign mirrored[k] = mirror[k] ? wide_low == -wide_stored_high && wide_high == -wide_stored_low : low == stored_low && high == stored_high;
    assign nearest[k]  = {{(WIDE-NEAR_W){1'b0}}, near[k]} == (distance < 0 ? 64'd0 : distance) && reached[k] == (wide_high >= wide_from);
    assign limits[k]   = WIDE'(floor_c) == wide_c >>> lod_pkg::BOX_SHIFT && WIDE'(floor_back) == back >>> lod_pkg::BOX_SHIFT;
  end

  // What is legal: codes within +-32767; a ceiling of a coordinate; a moment that has an opposite.
  logic legal;
  always_comb begin
    legal = 1'b1;
    for (int unsigned k = 0; k < 3; k++) begin
      legal = legal && stored_lo[k] != 16'h8000 && stored_hi[k] != 16'h8000 && moment[k] != {1'b1, {(MOMENT_W-1){1'b0}}};
      legal = legal && (ceil[k][16:15] == 2'b00 || ceil[k][16:15] == 2'b11 || ceil[k] == 17'h0_8000);
    end
  end

  always_comb begin
    assume (legal);
    assert (mirrored == '1);
    assert (nearest == '1);
    assert (limits == '1);
    // Culled only behind the closest hit: t_near 2^18 > t_max.
    assert (out_o.hit == (slabs_last && {entry, {lod_pkg::T_NEAR_TO_T_SHIFT{1'b0}}} <= in_i.t_max));
    assert (out_o.t_near == (out_o.hit ? entry : '0));
    cover (out_o.hit && mirror == '1 && near[0] == '1);
    cover (cut == '1 && !out_o.hit && slabs_last);
  end

