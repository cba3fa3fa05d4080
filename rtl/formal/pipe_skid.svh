  // Inside pipe_skid: a queue of two, first in, first out.
  logic         live_q;  // reset has been
  logic [1:0]   count_q;  // items taken and not given
  logic [W-1:0] first_q, second_q;
  logic         take, give;
  assign take = valid_i && ready_o;
  assign give = valid_o && ready_i;
  initial live_q = 1'b0;
  always_ff @(posedge clk_i) begin
    if (!rst_ni) begin
      live_q  <= 1'b1;
      count_q <= '0;
    end else begin
      count_q <= count_q + 2'(take) - 2'(give);
      if (take && count_q == 2'(give)) first_q <= data_i;
      else if (give) first_q <= second_q;
      if (take) second_q <= data_i;
    end
  end

  always_comb begin
    if (live_q) begin
      assert (count_q <= 2'd2);
      assert (valid_o == (count_q != '0));
      assert (ready_o == (count_q != 2'd2));
      assert (count_q == '0 || data_o == first_q);
      // Holds the induction together: the second item stands in the spare register.
      assert (count_q != 2'd2 || spare_q == second_q);
    end
    cover (live_q && count_q == 2'd2 && first_q != second_q && give);
    cover (live_q && take && give);
  end

