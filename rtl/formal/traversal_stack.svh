  // Inside traversal_stack: one place of any depth is watched; what was pushed there last is what is popped from there.
  (* anyconst *) logic [LEN_W-1:0] place;
  logic                  live_q;  // reset has been
  logic [LEN_W-1:0]      depth_q;  // pushes less pops
  lod_pkg::stack_entry_t watched_q;
  (* hierconn *) logic [INDEX_W-1:0] \u_entries.shown_place , \u_entries.other_place ;
  (* hierconn *) logic [lod_pkg::KEPT_ENTRY_W-1:0] \u_entries.shown ;
  assign {\u_entries.shown_place , \u_entries.other_place } = {INDEX_W'(place), INDEX_W'(0)};
  (* hierconn *) logic [lod_pkg::KEPT_ENTRY_W-1:0] \u_entries.word_q ;
  initial live_q = 1'b0;
  always_ff @(posedge clk_i) begin
    if (!rst_ni) begin
      live_q  <= 1'b1;
      depth_q <= '0;
    end else begin
      depth_q <= clear_i ? '0 : depth_q + LEN_W'(push_i) - LEN_W'(pop_i);
      if (push_i && depth_q == place) watched_q <= entry_i;
    end
  end

  always_comb begin
    assume (place < LEN_W'(DEPTH));
    // What the unit keeps to.
    assume (32'(push_i) + 32'(pop_i) + 32'(clear_i) <= 1);
    assume (!(push_i && depth_q == LEN_W'(DEPTH)) && !(pop_i && (depth_q == '0 || stale_q)));
    // Before the first reset nothing is known, and the block's own assertions need not hold.
    assume (live_q || !rst_ni);
    if (live_q) begin
      assert (empty_o == (depth_q == '0) && full_o == (depth_q == LEN_W'(DEPTH)));
      assert (depth_q != place + LEN_W'(1) || stale_q || entry_o == watched_q);
      // Nothing is read where the memory has no word.
      assert (!reads || 32'(next_top) < DEPTH);
      // Hold the induction together.
      assert (len_q == depth_q && depth_q <= LEN_W'(DEPTH));
      assert (depth_q <= place || \u_entries.shown  == lod_pkg::keep_entry(watched_q));
      assert (depth_q != place + LEN_W'(1) || stale_q || \u_entries.word_q == lod_pkg::keep_entry(watched_q));
    end
    cover (live_q && pop_i && depth_q == place + LEN_W'(1) && place == LEN_W'(3) && watched_q.index == 28'd77);
    cover (live_q && clear_i && depth_q == LEN_W'(2));
  end

