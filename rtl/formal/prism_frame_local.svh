  // Inside prism_frame: local coordinates have their bits, and no more are dropped than must be; mirrored ones are the same with the other sign.
  localparam logic signed [DIFF_W-1:0] LEAST = -33'sd512;
  localparam logic signed [DIFF_W-1:0] MOST = 33'sd511;
  logic [14:0] fits_now, fits_before, mirrored_right;
  for (genvar i = 0; i < 15; i++) begin : g_formal
    logic signed [DIFF_W-1:0]  of, now, before;
    logic signed [LOCAL_W-1:0] got;
    assign of     = diffs_2[i*DIFF_W +: DIFF_W];
    assign now    = of >>> shift_2;
    assign before = of >>> (shift_2 - 5'd1);
    assign got    = corners[i*LOCAL_W +: LOCAL_W];
    assign fits_now[i]       = now >= LEAST && now <= MOST;
    assign fits_before[i]    = before >= LEAST && before <= MOST;
    assign mirrored_right[i] = DIFF_W'(got) == (mirror_2[i%3] ? -now : now);
  end
  for (genvar i = 0; i < 15; i++) begin : g_proved
    always_comb begin
      assert (fits_now[i]);
      assert (mirrored_right[i]);
    end
  end
  always_comb begin
    assert (shift_2 <= 5'd23);
    assert (shift_2 == '0 || fits_before != '1);
    cover (shift_2 == 5'd23 && mirror_2 == 3'b101);
    cover (shift_2 == '0 && diffs_2[0 +: DIFF_W] == LEAST);
    cover (shift_2 == 5'd7 && corners[0 +: LOCAL_W] == LOCAL_W'(512));
  end
