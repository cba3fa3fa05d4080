  // Inside child_boxes, with the ends of each child's two triangles free: the box is the smallest that holds the morphed triangle and, as far as codes reach, the
  // full-resolution one let out by the stored steps; for a quad-BVH node, whose ends at full resolution are the origin, it lies its steps from there.
  localparam int unsigned WIDE = 26;
  localparam logic signed [WIDE-1:0] LAST = 26'sd32767;
  localparam logic signed [WIDE-1:0] EDGE = 26'sd32766;

  logic [11:0] legal, low_exact, high_exact;
  for (genvar i = 0; i < 12; i++) begin : g_formal
    localparam int unsigned PLANE = i / 3 * 6 + i % 3;
    logic signed [CODE_W-1:0]  got_low, got_high, full_least, high_floor, least, most;
    logic signed [EXACT_W-1:0] full_most;
    logic signed [WIDE-1:0]    from_low, from_high, morphed_low, morphed_high, down, up, tree_low, tree_high, node_low, node_high;
    assign {got_low, got_high} = {out_o.bounds[i/3][(5-i%3)*CODE_W +: CODE_W], out_o.bounds[i/3][(2-i%3)*CODE_W +: CODE_W]};
    assign {full_least, full_most, least, most} = {full_low[i], full_high[i], low[i], high[i]};
    assign from_low  = WIDE'(full_least);
    assign high_floor = full_most[EXACT_W-1:1];
    assign from_high = WIDE'(high_floor) + WIDE'(full_most[0]);
    assign {morphed_low, morphed_high} = {WIDE'(least), WIDE'(most)};
    assign down = ((WIDE'(in_i.planes[PLANE]) * (in_i.halves[i%3] ? WIDE'(3) : WIDE'(2))) << in_i.exponents[i%3]) >> 1;
    assign up   = ((WIDE'(in_i.planes[PLANE+3]) * (in_i.halves[i%3] ? WIDE'(3) : WIDE'(2))) << in_i.exponents[i%3]) >> 1;
    assign tree_low  = from_low - down < -LAST ? -LAST : from_low - down;
    assign tree_high = from_high + up > LAST ? LAST : from_high + up;
    assign node_low  = from_low + down > LAST ? LAST : from_low + down;
    assign node_high = from_high + up > LAST ? LAST : from_high + up;
    // Codes of legal corners, or of a legal origin.
    assign legal[i]  = !in_i.tree ? from_low >= -LAST && from_high >= -LAST && !full_most[0]
      : from_low >= -EDGE && from_low <= EDGE && from_high >= -EDGE && from_high <= EDGE
        && morphed_low >= -EDGE && morphed_high <= EDGE;
    assign low_exact[i]  = WIDE'(got_low) == (!in_i.tree ? node_low : tree_low < morphed_low ? tree_low : morphed_low);
    assign high_exact[i] = WIDE'(got_high) == (!in_i.tree ? node_high : tree_high > morphed_high ? tree_high : morphed_high);
  end

  for (genvar i = 0; i < 12; i++) begin : g_proved
    always_comb begin
      assert (low_exact[i]);
      assert (high_exact[i]);
    end
  end
  always_comb begin
    assume (legal == '1);
    assert (tag_o == tag_i && valid_o == valid_i && ready_o == ready_i);
    cover (in_i.tree && out_o.bounds[0][32 +: 16] == 16'd32766 && in_i.planes[3] == 5'd9);
    cover (in_i.tree && out_o.bounds[3][80 +: 16] == 16'h8001 && in_i.planes[18] == 5'd31 && in_i.exponents[0] == 4'd10);
    cover (in_i.tree && in_i.halves[1] && in_i.exponents[1] == '0 && in_i.planes[7] == 5'd3 && out_o.bounds[1][64 +: 16] == 16'd100);
    cover (!in_i.tree && out_o.bounds[2][0 +: 16] == 16'd32767 && out_o.bounds[2][48 +: 16] == 16'h8001);
  end

