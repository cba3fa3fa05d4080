  // Inside hit_queue: any one item is watched from its push to its pop.
  (* anyseq *) logic watch;
  logic             live_q;  // reset has been
  logic [LEN_W-1:0] inside_q;  // pushes less pops
  logic             watching_q;
  logic [LEN_W-1:0] ahead_q;  // items before the watched one
  logic [W-1:0]     watched_q;
  (* hierconn *) logic [INDEX_W-1:0] \u_items.shown_place , \u_items.other_place ;
  (* hierconn *) logic [W-1:0] \u_items.shown , \u_items.other ;
  initial live_q = 1'b0;
  always_ff @(posedge clk_i) begin
    if (!rst_ni) begin
      live_q     <= 1'b1;
      inside_q   <= '0;
      watching_q <= 1'b0;
    end else begin
      inside_q <= inside_q + LEN_W'(push_i) - LEN_W'(pop_i);
      if (push_i && watch && !watching_q) begin
        watching_q <= 1'b1;
        ahead_q    <= inside_q - LEN_W'(pop_i);
        watched_q  <= data_i;
      end else if (watching_q && pop_i) begin
        watching_q <= ahead_q != '0;
        ahead_q    <= ahead_q - LEN_W'(1);
      end
    end
  end

  // Place of the item that has n before it.
  function automatic logic [INDEX_W-1:0] at(input logic [LEN_W-1:0] n);
    at = INDEX_W'(32'(head_q) + 32'(n) >= DEPTH ? 32'(head_q) + 32'(n) - DEPTH : 32'(head_q) + 32'(n));
  endfunction

  assign {\u_items.shown_place , \u_items.other_place } = {at(ahead_q), head_q};

  always_comb begin
    // What the unit keeps to.
    assume (!(push_i && !pop_i && inside_q == LEN_W'(DEPTH)) && !(pop_i && inside_q == '0));
    assume (live_q || !rst_ni);
    if (live_q) begin
      assert (empty_o == (inside_q == '0));
      // It comes out when as many have left as were before it: not lost, not doubled, not out of turn.
      assert (!(watching_q && ahead_q == '0) || data_o == watched_q);
      assert (!watching_q || ahead_q < inside_q);
      // Hold the induction together.
      assert (len_q == inside_q && inside_q <= LEN_W'(DEPTH));
      assert (32'(head_q) < DEPTH && tail_q == at(inside_q));
      assert (!watching_q || \u_items.shown  == watched_q);
      assert (empty_o || data_o == \u_items.other );
    end
    cover (live_q && watching_q && ahead_q == '0 && pop_i && push_i && head_q == LAST);
    cover (live_q && inside_q == LEN_W'(DEPTH) && watching_q && ahead_q == LEN_W'(DEPTH - 1));
  end

