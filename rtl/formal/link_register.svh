  // Inside link_register: what is taken is what the block takes in the next cycle, which is free then.
  logic         live_q;  // reset has been
  logic         taken_q;
  logic [W-1:0] item_q;
  logic [7:0]   since_q;  // cycles since the last item was taken, up to INTERVAL
  initial live_q = 1'b0;
  always_ff @(posedge clk_i) begin
    if (!rst_ni) begin
      live_q  <= 1'b1;
      taken_q <= 1'b0;
      since_q <= 8'(INTERVAL);
    end else begin
      taken_q <= valid_i && ready_o;
      since_q <= valid_i && ready_o ? 8'd1 : since_q == 8'(INTERVAL) ? since_q : since_q + 8'd1;
    end
    item_q <= data_i;
  end

  // A block that takes an input every INTERVAL cycles: its ready, from what it was given.
  logic [7:0] free_in_q;
  always_ff @(posedge clk_i) free_in_q <= !rst_ni ? '0 : valid_o ? 8'(INTERVAL) - 8'd1 : free_in_q == '0 ? '0 : free_in_q - 8'd1;

  always_comb begin
    assume (ready_i == (free_in_q == '0));
    assume (live_q || !rst_ni);
    if (live_q) begin
      // As soon as the block will be free, and no sooner: it always is when something comes.
      assert (ready_o == (since_q == 8'(INTERVAL)));
      assert (!valid_o || ready_i);
      assert (valid_o == taken_q && (!valid_o || data_o == item_q));
      // Holds the induction together.
      assert (since_q >= 8'd1 && since_q <= 8'(INTERVAL) && 8'(wait_q) == 8'(INTERVAL) - since_q);
      assert (taken_q ? since_q == 8'd1 && free_in_q == '0 : free_in_q == (since_q == 8'(INTERVAL) ? '0 : 8'(INTERVAL) + 8'd1 - since_q) || (since_q == 8'(INTERVAL) && free_in_q <= 8'd1));
    end
    cover (live_q && valid_o && valid_i && !ready_o);
    cover (live_q && valid_i && ready_o && 8'(free_in_q) == 8'd1);
  end
