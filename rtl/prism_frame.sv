`default_nettype none

/// A node and a ray in the node's local space, as the prisms of its children are tested. Twin of src/block/prism_frame.rs (docs/numbers.md, "Prisms").
///
/// z is the axis along which the ray moves most, x and y the next ones; axes are mirrored so that d >= 0. Local coordinates: steps of 2^shift units from the first
/// full-resolution corner, rounded down, then mirrored. u, v: how far that corner lies beside the ray, in quarters of a step times d_z / 2^k.
/// Legal: what `ray_setup` gives for a ray that moves; |points| <= 0x7FFE_0000. Its last register is a `pipe_skid`. Latency PRISM_FRAME_LATENCY = 6; interval 1.
module prism_frame #(
  parameter int unsigned TAG_W = 8
) (
  input  logic                      clk_i,
  input  logic                      rst_ni,
  input  logic                      valid_i,
  output logic                      ready_o,
  input  lod_pkg::prism_frame_in_t  in_i,
  input  logic [TAG_W-1:0]          tag_i,
  output logic                      valid_o,
  input  logic                      ready_i,
  output lod_pkg::prism_frame_out_t out_o,
  output logic [TAG_W-1:0]          tag_o
);

  localparam int unsigned COORD_W = lod_pkg::POINT_W / 3;
  // Difference of two coordinates, and its magnitude or one less.
  localparam int unsigned DIFF_W = COORD_W + 1;
  localparam int unsigned D_W = 30;
  localparam int unsigned MOMENT_W = lod_pkg::MOMENT_W / 3;
  localparam int unsigned RECIPROCAL_W = lod_pkg::RECIPROCAL_W;
  localparam int unsigned LOCAL_W = lod_pkg::LOCAL_W / 3;
  localparam int unsigned STEP_W = 10;
  localparam int unsigned NARROW_W = 12;
  localparam int unsigned PRODUCT_W = COORD_W + D_W + 1;
  // Products below 2^61, moments below 2^62.
  localparam int unsigned SUM_W = MOMENT_W + 1;
  localparam int unsigned SOFT_W = STEP_W + NARROW_W;
  localparam int unsigned DIFFS_W = 15 * DIFF_W;
  localparam int unsigned CORNERS_W = 15 * LOCAL_W;
  localparam bit MORPHS = lod_pkg::LOD_TEST != 0;
  if (lod_pkg::PRISM_FRAME_LATENCY != 3 + lod_pkg::multiplier_latency(COORD_W, D_W + 1)) begin : g_illegal_latency
    $error("prism_frame: lod_pkg::PRISM_FRAME_LATENCY must be %0d", 3 + lod_pkg::multiplier_latency(COORD_W, D_W + 1));
  end

  // Stage 1: the axis along which the ray moves most; what belongs to it and to the next ones; differences, and all bits that any has.
  logic [2:0]                      mirrors, mirror_1, turned_mirror;
  logic [2:0][D_W-1:0]             d, turned_d, d_1;
  logic [2:0][COORD_W-1:0]         origins, first, turned_first, first_1;
  logic [2:0][MOMENT_W-1:0]        moments;
  logic [2:0][RECIPROCAL_W-1:0]    reciprocals;
  logic                            z_main, y_main;
  logic [MOMENT_W-1:0]             moment_u, moment_v, moment_u_1, moment_v_1;
  logic [COORD_W-1:0]              origin, origin_1;
  logic [RECIPROCAL_W-1:0]         reciprocal, reciprocal_1;
  logic [14:0][DIFF_W-1:0]         diffs;
  logic [14:0][COORD_W-1:0]        sizes;
  logic [17:0][COORD_W-1:0]        moved_by;
  logic [17:0]                     is_moved;
  logic [DIFFS_W-1:0]              turned_diffs, diffs_1;
  logic [COORD_W-1:0]              bits, bits_1;
  logic [2:0][COORD_W-1:0]         morphs, turned_morphs, morphs_1;
  logic                            moves, moves_1, valid_1, ready_1;
  logic [TAG_W-1:0]                tag_1;
  assign mirrors     = {in_i.ray.z.mirror, in_i.ray.y.mirror, in_i.ray.x.mirror};
  assign d           = {in_i.ray.z.d, in_i.ray.y.d, in_i.ray.x.d};
  assign origins     = {in_i.ray.z.origin, in_i.ray.y.origin, in_i.ray.x.origin};
  assign moments     = {in_i.ray.moment.z, in_i.ray.moment.y, in_i.ray.moment.x};
  assign reciprocals = {in_i.ray.z.reciprocal, in_i.ray.y.reciprocal, in_i.ray.x.reciprocal};
  assign z_main      = d[2] >= d[0] && d[2] >= d[1];
  assign y_main      = d[1] >= d[0];
  assign origin      = z_main ? origins[2] : y_main ? origins[1] : origins[0];
  assign reciprocal  = z_main ? reciprocals[2] : y_main ? reciprocals[1] : reciprocals[0];
  // c_zx; and -c_yz, which is a number of as many bits.
  assign moment_u    = z_main ? moments[1] : y_main ? moments[0] : moments[2];
  assign moment_v    = -(z_main ? moments[0] : y_main ? moments[2] : moments[1]);
  for (genvar c = 0; c < 3; c++) begin : g_axis
    localparam int unsigned Y_MAIN = (c + 2) % 3;
    localparam int unsigned X_MAIN = (c + 1) % 3;
    logic [COORD_W-1:0] a;
    assign a        = in_i.full[0][(2-c)*COORD_W +: COORD_W];
    assign first[c] = mirrors[c] ? -a : a;
    assign turned_mirror[c] = z_main ? mirrors[c] : y_main ? mirrors[Y_MAIN] : mirrors[X_MAIN];
    assign turned_d[c]      = z_main ? d[c] : y_main ? d[Y_MAIN] : d[X_MAIN];
    assign turned_first[c]  = z_main ? first[c] : y_main ? first[Y_MAIN] : first[X_MAIN];
    assign turned_morphs[c] = z_main ? morphs[c] : y_main ? morphs[Y_MAIN] : morphs[X_MAIN];
    for (genvar p = 0; p < 5; p++) begin : g_turned
      assign turned_diffs[(3*p+c)*DIFF_W +: DIFF_W] = z_main ? diffs[3*p+c] : y_main ? diffs[3*p+Y_MAIN] : diffs[3*p+X_MAIN];
    end
  end
  // Of the same magnitude or one less: that of the corner with number 1 + i / 3.
  for (genvar i = 0; i < 15; i++) begin : g_diff
    logic signed [COORD_W-1:0] at, from;
    assign at       = in_i.full[1+i/3][(2-i%3)*COORD_W +: COORD_W];
    assign from     = in_i.full[0][(2-i%3)*COORD_W +: COORD_W];
    assign diffs[i] = DIFF_W'(at) - DIFF_W'(from);
    assign sizes[i] = diffs[i][COORD_W-1:0] ^ {COORD_W{diffs[i][DIFF_W-1]}};
  end
  for (genvar i = 0; i < 18; i++) begin : g_morph
    logic signed [COORD_W-1:0] at, from;
    logic [DIFF_W-1:0]         by;
    assign at          = MORPHS ? in_i.morphed[i/3][(2-i%3)*COORD_W +: COORD_W] : from;
    assign from        = in_i.full[i/3][(2-i%3)*COORD_W +: COORD_W];
    assign by          = DIFF_W'(at) - DIFF_W'(from);
    assign moved_by[i] = by[COORD_W-1:0] ^ {COORD_W{by[DIFF_W-1]}};
    assign is_moved[i] = by != '0;
  end
  always_comb begin
    bits   = '0;
    morphs = '0;
    for (int unsigned i = 0; i < 15; i++) bits = bits | sizes[i];
    for (int unsigned i = 0; i < 18; i++) morphs[i%3] = morphs[i%3] | moved_by[i];
  end
  assign moves = is_moved != '0;
  pipe_stage #(.W(DIFFS_W + COORD_W + 3 * COORD_W + 1 + 3 + 3 * D_W + 3 * COORD_W + COORD_W + 2 * MOMENT_W + RECIPROCAL_W + TAG_W)) u_1 (
    .clk_i, .rst_ni, .valid_i, .ready_o,
    .data_i({turned_diffs, bits, turned_morphs, moves, turned_mirror, turned_d, turned_first, origin, moment_u, moment_v, reciprocal, tag_i}),
    .valid_o(valid_1), .ready_i(ready_1),
    .data_o({diffs_1, bits_1, morphs_1, moves_1, mirror_1, d_1, first_1, origin_1, moment_u_1, moment_v_1, reciprocal_1, tag_1})
  );

  // Across the ray: A_x d_z - A_z d_x, and with y; as long as stages 2 to 4.
  logic [3:0]                       ready_product, valid_product;
  logic [3:0][PRODUCT_W-1:0]        product;
  logic                             ready_5;
  for (genvar k = 0; k < 4; k++) begin : g_product
    logic [COORD_W-1:0] a;
    logic [D_W-1:0]     b;
    assign a = k % 2 == 0 ? first_1[k/2] : first_1[2];
    assign b = k % 2 == 0 ? d_1[2] : d_1[k/2];
    multiplier #(.A_W(COORD_W), .B_W(D_W + 1)) u_product (
      .clk_i, .rst_ni, .valid_i(valid_1), .ready_o(ready_product[k]), .a_i(a), .b_i({1'b0, b}),
      .valid_o(valid_product[k]), .ready_i(ready_5), .product_o(product[k])
    );
  end

  // Stage 2: the shift, the size of d, where the first corner lies along the ray.
  logic [4:0]               shift, shift_2, size, size_2;
  logic [DIFF_W-1:0]        along, along_2;
  logic [DIFFS_W-1:0]       diffs_2;
  logic [2:0][COORD_W-1:0]  morphs_2;
  logic                     moves_2, valid_2, ready_2;
  logic [2:0]               mirror_2;
  logic [2:0][D_W-1:0]      d_2;
  logic [MOMENT_W-1:0]      moment_u_2, moment_v_2;
  logic [RECIPROCAL_W-1:0]  reciprocal_2;
  logic [TAG_W-1:0]         tag_2;
  always_comb begin
    shift = '0;
    for (int unsigned k = STEP_W; k <= COORD_W; k++) if (bits_1[k-1]) shift = 5'(k - (STEP_W - 1));
    size = '0;
    for (int unsigned k = 1; k <= D_W; k++) if (d_1[2][k-1]) size = 5'(k);
  end
  logic signed [COORD_W-1:0] first_z, origin_z;
  assign {first_z, origin_z} = {first_1[2], origin_1};
  assign along               = DIFF_W'(first_z) - DIFF_W'(origin_z);
  pipe_stage #(.W(DIFFS_W + 3 * COORD_W + 1 + 5 + 5 + 3 + 3 * D_W + DIFF_W + 2 * MOMENT_W + RECIPROCAL_W + TAG_W)) u_2 (
    .clk_i, .rst_ni, .valid_i(valid_1), .ready_o(ready_1),
    .data_i({diffs_1, morphs_1, moves_1, shift, size, mirror_1, d_1, along, moment_u_1, moment_v_1, reciprocal_1, tag_1}),
    .valid_o(valid_2), .ready_i(ready_2),
    .data_o({diffs_2, morphs_2, moves_2, shift_2, size_2, mirror_2, d_2, along_2, moment_u_2, moment_v_2, reciprocal_2, tag_2})
  );

  // Stage 3: local corners, morphs in steps, D.
  logic [CORNERS_W-1:0]       corners, corners_3;
  logic [2:0][COORD_W:0]      wide_steps;
  logic [2:0]                 beyond;
  logic                       wide, wide_3;
  logic [2:0][STEP_W-1:0]     steps, steps_3;
  logic [2:0][NARROW_W-1:0]   narrow, narrow_3;
  logic [4:0]                 shift_3, size_3;
  logic                       flipped_3, valid_3, ready_3;
  logic [DIFF_W-1:0]          along_3;
  logic [MOMENT_W-1:0]        moment_u_3, moment_v_3;
  logic [RECIPROCAL_W-1:0]    reciprocal_3;
  logic [TAG_W-1:0]           tag_3;
  for (genvar i = 0; i < 15; i++) begin : g_local
    logic signed [DIFF_W-1:0]  diff, shifted;
    logic [LOCAL_W-1:0]        low;
    logic                      unused_high;
    assign diff    = diffs_2[i*DIFF_W +: DIFF_W];
    assign shifted = diff >>> shift_2;
    assign low     = shifted[LOCAL_W-1:0];
    assign corners[i*LOCAL_W +: LOCAL_W] = mirror_2[i%3] ? -low : low;
    assign unused_high = ^shifted[DIFF_W-1:LOCAL_W];
  end
  for (genvar c = 0; c < 3; c++) begin : g_steps
    logic [D_W-1:0] normalised;
    logic           unused_low;
    assign wide_steps[c] = ((COORD_W+1)'(morphs_2[c]) >> shift_2) + (COORD_W+1)'(moves_2);
    assign beyond[c]     = wide_steps[c][COORD_W:STEP_W] != '0;
    assign steps[c]      = wide ? '0 : wide_steps[c][STEP_W-1:0];
    assign normalised    = d_2[c] << (5'(D_W) - size_2);
    assign narrow[c]     = normalised[D_W-1 -: NARROW_W];
    assign unused_low    = ^normalised[D_W-NARROW_W-1:0];
  end
  assign wide = beyond != '0;
  pipe_stage #(.W(CORNERS_W + 1 + 3 * STEP_W + 3 * NARROW_W + 5 + 5 + 1 + DIFF_W + 2 * MOMENT_W + RECIPROCAL_W + TAG_W)) u_3 (
    .clk_i, .rst_ni, .valid_i(valid_2), .ready_o(ready_2),
    .data_i({corners, wide, steps, narrow, shift_2, size_2, ^mirror_2, along_2, moment_u_2, moment_v_2, reciprocal_2, tag_2}),
    .valid_o(valid_3), .ready_i(ready_3),
    .data_o({corners_3, wide_3, steps_3, narrow_3, shift_3, size_3, flipped_3, along_3, moment_u_3, moment_v_3, reciprocal_3, tag_3})
  );

  // Stage 4: how far morphs reach across the ray, in products.
  logic [3:0][SOFT_W-1:0]     reach_of, soft_4;
  logic [1:0]                 moved, moved_4;
  logic [CORNERS_W-1:0]       corners_4;
  logic                       wide_4, flipped_4, valid_4;
  logic [STEP_W-1:0]          soft_z_4;
  logic [2:0][NARROW_W-1:0]   narrow_4;
  logic [4:0]                 shift_4, size_4;
  logic [DIFF_W-1:0]          along_4;
  logic [MOMENT_W-1:0]        moment_u_4, moment_v_4;
  logic [RECIPROCAL_W-1:0]    reciprocal_4;
  logic [TAG_W-1:0]           tag_4;
  for (genvar c = 0; c < 2; c++) begin : g_reach
    assign reach_of[2*c]   = SOFT_W'(steps_3[c]) * SOFT_W'(narrow_3[2]);
    assign reach_of[2*c+1] = SOFT_W'(steps_3[2]) * SOFT_W'(narrow_3[c]);
    assign moved[c]    = (steps_3[c] | steps_3[2]) != '0;
  end
  pipe_stage #(.W(4 * SOFT_W + 2 + CORNERS_W + 1 + STEP_W + 3 * NARROW_W + 5 + 5 + 1 + DIFF_W + 2 * MOMENT_W + RECIPROCAL_W + TAG_W)) u_4 (
    .clk_i, .rst_ni, .valid_i(valid_3), .ready_o(ready_3),
    .data_i({reach_of, moved, corners_3, wide_3, steps_3[2], narrow_3, shift_3, size_3, flipped_3, along_3, moment_u_3, moment_v_3, reciprocal_3, tag_3}),
    .valid_o(valid_4), .ready_i(ready_5),
    .data_o({soft_4, moved_4, corners_4, wide_4, soft_z_4, narrow_4, shift_4, size_4, flipped_4, along_4, moment_u_4, moment_v_4, reciprocal_4, tag_4})
  );

  // Stage 5: sums.
  logic [1:0][SUM_W-1:0]      across, across_5;
  logic [1:0][12:0]           soft_sum, soft_5;
  logic [CORNERS_W-1:0]       corners_5;
  logic                       wide_5, flipped_5, valid_5, ready_6;
  logic [STEP_W-1:0]          soft_z_5;
  logic [2:0][NARROW_W-1:0]   narrow_5;
  logic [4:0]                 shift_5;
  logic [5:0]                 amount, amount_5;
  logic [DIFF_W-1:0]          along_5;
  logic [RECIPROCAL_W-1:0]    reciprocal_5;
  logic [TAG_W-1:0]           tag_5;
  for (genvar c = 0; c < 2; c++) begin : g_across
    logic signed [PRODUCT_W-1:0] a, b;
    logic signed [MOMENT_W-1:0]  moment;
    logic [SOFT_W:0]             sum;
    logic                        unused_low;
    assign {a, b}      = {product[2*c], product[2*c+1]};
    assign moment      = c == 0 ? moment_u_4 : moment_v_4;
    assign across[c]   = SUM_W'(a) - SUM_W'(b) + SUM_W'(moment);
    assign sum         = (SOFT_W+1)'(soft_4[2*c]) + (SOFT_W+1)'(soft_4[2*c+1]);
    assign soft_sum[c] = moved_4[c] ? sum[SOFT_W -: 13] + 13'd3 : '0;
    assign unused_low  = ^sum[SOFT_W-13:0];
  end
  assign amount = 6'(shift_4) + 6'(size_4);
  pipe_stage #(.W(2 * SUM_W + 2 * 13 + CORNERS_W + 1 + STEP_W + 3 * NARROW_W + 5 + 6 + 1 + DIFF_W + RECIPROCAL_W + TAG_W)) u_5 (
    .clk_i, .rst_ni, .valid_i(valid_4), .ready_o(ready_5),
    .data_i({across, soft_sum, corners_4, wide_4, soft_z_4, narrow_4, shift_4, amount, flipped_4, along_4, reciprocal_4, tag_4}),
    .valid_o(valid_5), .ready_i(ready_6),
    .data_o({across_5, soft_5, corners_5, wide_5, soft_z_5, narrow_5, shift_5, amount_5, flipped_5, along_5, reciprocal_5, tag_5})
  );

  // Stage 6: in quarters of a step, rounded down, and one more; whether that is in range.
  logic [1:0][12:0]          side;
  logic [1:0]                far;
  lod_pkg::prism_frame_out_t out;
  for (genvar c = 0; c < 2; c++) begin : g_side
    logic signed [SUM_W+1:0] whole, shifted;
    logic [13:0]             up;
    assign whole   = {across_5[c], 2'b00};
    assign shifted = whole >>> amount_5;
    assign up      = shifted[13:0] + 14'd1;
    assign far[c]  = shifted[SUM_W+1:13] != {(SUM_W-11){shifted[13]}} || up[13] != up[12];
    assign side[c] = far[c] ? '0 : up[12:0];
  end
  assign out.frame.open       = wide_5 || far != '0;
  assign out.frame.flipped    = flipped_5;
  assign out.frame.shift      = shift_5;
  assign out.frame.d          = narrow_5;
  assign out.frame.u          = side[0];
  assign out.frame.v          = side[1];
  assign out.frame.z          = along_5;
  assign out.frame.soft_u     = soft_5[0];
  assign out.frame.soft_v     = soft_5[1];
  assign out.frame.soft_z     = soft_z_5;
  assign out.frame.reciprocal = reciprocal_5;
  assign out.corners[0]       = '0;
  for (genvar p = 0; p < 5; p++) begin : g_corner
    assign out.corners[p+1] = {corners_5[3*p*LOCAL_W +: LOCAL_W], corners_5[(3*p+1)*LOCAL_W +: LOCAL_W], corners_5[(3*p+2)*LOCAL_W +: LOCAL_W]};
  end
  pipe_skid #(.W(lod_pkg::PRISM_FRAME_OUT_W + TAG_W)) u_out (
    .clk_i, .rst_ni, .valid_i(valid_5), .ready_o(ready_6), .data_i({out, tag_5}),
    .valid_o, .ready_i, .data_o({out_o, tag_o})
  );

  logic unused;
  assign unused = ^{in_i.ray.x.ceil, in_i.ray.y.ceil, in_i.ray.z.ceil, ready_product, valid_product};

endmodule

`default_nettype wire
