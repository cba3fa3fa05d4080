  // Inside ray_context, besides ray_context.svh: though epochs come again, no line is taken by another ray than the one that asked for it. Any one request is watched, with the number of its
  // ray, counted to far more than there are epochs. Memory answers a request once or never, and never one that the context has given up.
  (* anyseq *) logic watch, is_watched;
  logic                        watching_q, watched_place_q;
  logic [15:0]                 ray_number_q, watched_number_q;
  logic [lod_pkg::EPOCH_W-1:0] watched_epoch_q;
  logic [lod_pkg::OWED_W-1:0]           others_q;  // requests without an answer besides
  logic                        begins;
  assign begins = fetch_grant_i && watch && !watching_q;
  always_ff @(posedge clk_i) begin
    if (!rst_ni) begin
      watching_q   <= 1'b0;
      others_q     <= '0;
      ray_number_q <= '0;
    end else begin
      if (setup_valid_i) ray_number_q <= ray_number_q + 16'd1;
      if (begins) begin
        watching_q       <= 1'b1;
        watched_place_q  <= fetch_place_o;
        watched_epoch_q  <= epoch_q;
        watched_number_q <= ray_number_q;
      end else if ((line_valid_i && is_watched) || gives_up) watching_q <= 1'b0;
      others_q <= gives_up ? '0 : others_q + lod_pkg::OWED_W'(fetch_grant_i && !begins) - lod_pkg::OWED_W'(line_valid_i && !is_watched);
    end
  end

  // Rays between that of the watched request and this one; lines that this one waits for.
  logic [15:0] between;
  logic [1:0]  waited_for;
  assign between    = ray_number_q - watched_number_q;
  assign waited_for = 2'(waiting_q[0]) + 2'(waiting_q[1]);

  always_comb begin
    assume (!live || !line_valid_i || !is_watched || (watching_q && line_i.epoch == watched_epoch_q && line_i.tag[1:0] == {1'b0, watched_place_q}));
    assume (!live || !line_valid_i || is_watched || others_q != '0);
    if (live) begin
      assert (!line_valid_i || !is_watched || arrived == '0 || watched_number_q == ray_number_q);
      // Hold the induction together.
      assert (owed_q == others_q + lod_pkg::OWED_W'(watching_q));
      assert (!watching_q || others_q != '1);
      assert (owed_q <= lod_pkg::OWED_W'({behind_q, 1'b0}) + lod_pkg::OWED_W'(2));
      if (traverses) assert (owed_q <= lod_pkg::OWED_W'({behind_q, 1'b0}) + lod_pkg::OWED_W'(waited_for));
      if (state_q == lod_pkg::SETUP || state_q == lod_pkg::SETUP_WAIT) assert (behind_q != '1 || owed_q == '0);
      if (watching_q) assert (between <= 16'(behind_q) && epoch_q - watched_epoch_q == between[lod_pkg::EPOCH_W-1:0]);
    end
    cover (live && watching_q && between == 16'd1 && arrived != '0 && line_valid_i && !is_watched);
  end
