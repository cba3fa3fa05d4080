  // Inside axi_read_adapter, the register of requests a wire: one place of any number is watched, from a request that takes it to its answer.
  (* anyconst *) logic [ID_W-1:0] watched;
  logic             live_q;  // reset has been
  logic             due_q;  // a request has its id, and the last beat has not come
  logic [TAG_W-1:0] asked_q;  // its tag and epoch
  logic             bad_q;  // a beat of it was no OKAY
  logic             asks, beat, answered_q, answered_bad_q;
  logic [TAG_W-1:0] answered_tag_q;
  assign asks = axi_arvalid_o && axi_arready_i && axi_arid_o == watched;
  assign beat = axi_rvalid_i && axi_rready_o && axi_rid_i == watched;
  initial live_q = 1'b0;
  always_ff @(posedge clk_i) begin
    if (!rst_ni) begin
      live_q <= 1'b1;
      {due_q, bad_q, answered_q} <= '0;
    end else begin
      answered_q     <= beat && axi_rlast_i;
      answered_tag_q <= asked_q;
      answered_bad_q <= bad_q || axi_rresp_i != 2'b00;
      if (beat) {due_q, bad_q} <= {!axi_rlast_i, (bad_q || axi_rresp_i != 2'b00) && !axi_rlast_i};
      if (asks) {due_q, asked_q} <= {1'b1, mem_i.tag, mem_i.epoch};
    end
  end

  always_comb begin
    assume (live_q || !rst_ni);
    assume (32'(watched) < READS);
    // A memory answers what was asked.
    assume (!axi_rvalid_i || (32'(axi_rid_i) < READS && taken_q[axi_rid_i]));
    if (live_q) begin
      // No id is outstanding twice, none that there is not, and a request waits only if all are.
      assert (!axi_arvalid_o || 32'(axi_arid_o) < READS);
      assert (!(axi_arvalid_o && axi_arid_o == watched) || !due_q);
      assert (mem_ready_o == (axi_arready_i && taken_q != '1));
      assert (axi_arvalid_o == (mem_valid_i && taken_q != '1));
      // An answer comes one cycle behind its last beat, with its request's tag and error.
      assert (!answered_q || (mem_valid_o && {mem_o.tag, mem_o.epoch} == answered_tag_q && mem_o.error == answered_bad_q));
      // Hold the induction together.
      assert (taken_q[watched] == due_q && wrong_q[watched] == bad_q);
      assert (!due_q || tags_q[watched] == asked_q);
    end
    cover (live_q && asks && taken_q == READS'(7'h3f));
    cover (live_q && answered_q && answered_bad_q && answered_tag_q == '1 && asks);
  end
