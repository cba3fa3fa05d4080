  // Inside prism_test, with the triangle's area free: the normal has its leading seven bits, rounded towards zero, so that it mirrors with the triangle.
  logic [2:0] exact, few, fewer;
  for (genvar m = 0; m < 3; m++) begin : g_formal
    logic signed [AREA_W-1:0] of, size, shifted, before;
    logic signed [N_W-1:0]    got;
    assign of         = area_3[m];
    assign size       = of < 0 ? -of : of;
    assign shifted    = size >> shift_4;
    assign before     = size >> (shift_4 - 4'd1);
    assign got        = n[m];
    assign exact[m]   = AREA_W'(got) == (of < 0 ? -shifted : shifted);
    assign few[m]   = shifted[AREA_W-1:N_W-1] == '0;
    assign fewer[m] = before[AREA_W-1:N_W-1] == '0;
  end
  for (genvar m = 0; m < 3; m++) begin : g_proved
    always_comb begin
      assert (exact[m]);
      assert (few[m]);
    end
  end
  always_comb begin
    // Not the one number whose magnitude has a bit more: two products below 2^20.
    assume (area_3[0] != {1'b1, {(AREA_W-1){1'b0}}} && area_3[1] != {1'b1, {(AREA_W-1){1'b0}}} && area_3[2] != {1'b1, {(AREA_W-1){1'b0}}});
    assert (shift_4 == '0 || fewer != '1);
    cover (shift_4 == 4'd14 && n[0] == 8'h81);
    cover (shift_4 == '0 && n[1] == 8'd127);
    cover (shift_4 == 4'd3 && n[2] == 8'd0 && area_3[2] != '0);
  end
