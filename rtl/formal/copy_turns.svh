  // Inside copy_turns: each copy holds an item for LATENCY cycles, gives its result then, and can take an item in that cycle again.
  localparam int unsigned AGE_W = $clog2(LATENCY + 1);
  logic                         live_q;  // reset has been
  logic [COPIES-1:0][AGE_W-1:0] left_q;  // cycles until a copy gives its result; 0: it can take an item
  initial live_q = 1'b0;
  for (genvar k = 0; k < COPIES; k++) begin : g_left
    always_ff @(posedge clk_i) begin
      if (!rst_ni) left_q[k] <= '0;
      else if (valid_i && ready_o && turn_o[k]) left_q[k] <= AGE_W'(LATENCY - 1);
      else if (left_q[k] != '0) left_q[k] <= left_q[k] - AGE_W'(1);
    end
  end
  always_ff @(posedge clk_i) if (!rst_ni) live_q <= 1'b1;

  always_comb begin
    assume (live_q || !rst_ni);
    // A copy that holds nothing can take an item.
    for (int unsigned k = 0; k < COPIES; k++) assume (left_q[k] != '0 || ready_i[k]);
    if (live_q) begin
      // One copy has its turn, and it can take the item.
      assert (turn_o != '0 && (turn_o & (turn_o - COPIES'(1))) == '0);
      for (int unsigned k = 0; k < COPIES; k++) begin
        assert (!(valid_i && ready_o && turn_o[k]) || left_q[k] == '0);
        // No two results come in the same cycle.
        for (int unsigned other = 0; other < COPIES; other++) assert (k == other || left_q[k] == '0 || left_q[k] != left_q[other]);
      end
      // Together they take an item every INTERVAL cycles, and no sooner: the one before is as long ago.
      assert (32'(g_turns.wait_q) < INTERVAL);
      // Holds the induction together: who took an item `age` turns ago is as many intervals ahead of who would take one now, and of who took one later.
      for (int unsigned k = 0; k < COPIES; k++) begin
        for (int unsigned age = 1; age <= COPIES; age++) begin
          assert (!turn_o[(k + age) % COPIES] || left_q[k] == '0 || 32'(left_q[k]) + age * INTERVAL <= LATENCY + 32'(g_turns.wait_q));
          for (int unsigned later = 1; later < age; later++) begin
            assert (!turn_o[(k + age) % COPIES] || left_q[k] == '0 || left_q[k] + AGE_W'((age - later) * INTERVAL) <= left_q[(k + age - later) % COPIES]);
          end
        end
      end
    end
    cover (live_q && turn_o[COPIES-1] && valid_i && ready_o && left_q != '0);
  end
