  // Inside pipe_stage: it holds what it took last until that is taken from it, so none is lost, doubled or passed by another.
  logic         live_q;  // reset has been
  logic         held_q;  // an item was taken and not given
  logic [W-1:0] item_q;
  initial live_q = 1'b0;
  always_ff @(posedge clk_i) begin
    if (!rst_ni) {live_q, held_q} <= 2'b10;
    else if (valid_i && ready_o) {held_q, item_q} <= {1'b1, data_i};
    else if (valid_o && ready_i) held_q <= 1'b0;
  end

  always_comb begin
    if (live_q) begin
      assert (valid_o == held_q);
      assert (!held_q || data_o == item_q);
      // Room as soon as there is none inside or it leaves: no stall of its own.
      assert (ready_o == (!held_q || ready_i));
    end
    cover (live_q && held_q && valid_i && !ready_i);
    cover (live_q && held_q && valid_i && ready_o && data_i != item_q);
  end

