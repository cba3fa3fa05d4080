  // Inside arbiter: the winner is the first request at or after the place behind the last one taken, cyclically.
  logic       live_q;  // reset has been
  logic [7:0] next_q;  // that place
  initial live_q = 1'b0;
  always_ff @(posedge clk_i) begin
    if (!rst_ni) begin
      live_q <= 1'b1;
      next_q <= '0;
    end else if (take_i && request_i != '0) begin
      next_q <= 32'(index_o) == N - 1 ? '0 : 8'(index_o) + 8'd1;
    end
  end

  logic [7:0] place;
  logic       found;
  always_comb begin
    {found, place} = '0;
    for (int unsigned k = 0; k < 2 * N; k++) begin
      if (!found && k >= 32'(next_q) && request_i[k % N]) {found, place} = {1'b1, 8'(k % N)};
    end
  end

  always_comb begin
    if (live_q) begin
      assert (grant_o == (found ? N'(1) << place : '0));
      assert (found == (request_i != '0));
      assert (!found || 8'(index_o) == place);
      // Holds the induction together: the bits behind the last winner, none if that was the last of all.
      assert (32'(next_q) < N && behind_q == (next_q == '0 ? '0 : ~((N'(1) << next_q) - N'(1))));
    end
    cover (live_q && next_q == 8'(N - 1) && grant_o == N'(2));
    cover (live_q && next_q == 8'd2 && take_i && 32'(index_o) == N - 1);
  end

