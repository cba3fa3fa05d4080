  // Inside axi_read_adapter: of any one place, one beat of any number is watched; its data are in its place of the line.
  (* anyconst *) logic [ID_W-1:0] watched;
  (* anyconst *) logic [3:0] which;
  logic              live_q;  // reset has been
  logic [3:0]        count_q;  // beats of the place's burst that came
  logic [DATA_W-1:0] data_q, answered_data_q;  // the data of that beat
  logic              beat, answered_q;
  assign beat = axi_rvalid_i && axi_rready_o && axi_rid_i == watched;
  initial live_q = 1'b0;
  always_ff @(posedge clk_i) begin
    if (!rst_ni) begin
      live_q <= 1'b1;
      {count_q, answered_q} <= '0;
    end else begin
      answered_q      <= beat && axi_rlast_i;
      answered_data_q <= count_q == which ? axi_rdata_i : data_q;
      if (beat) count_q <= axi_rlast_i ? 4'd0 : count_q + 4'd1;
      if (beat && count_q == which) data_q <= axi_rdata_i;
    end
  end

  // Where that beat is in the line, and among those that came: the latest are on top.
  logic [LINE_W-1:0]        whole;
  logic [LINE_W-DATA_W-1:0] came;
  logic [DATA_W-1:0]        line_there, beat_there;
  assign whole      = mem_o.line;
  assign came       = g_beats.beats_q[watched];
  assign line_there = DATA_W'(whole >> (32'(which) * DATA_W));
  assign beat_there = DATA_W'(came >> ((BEATS - 1 - 32'(count_q) + 32'(which)) * DATA_W));

  always_comb begin
    assume (live_q || !rst_ni);
    assume (32'(watched) < READS && 32'(which) < BEATS);
    // What a bus keeps to: ids that there are, and the last beat of a burst is marked, no other.
    assume (!axi_rvalid_i || 32'(axi_rid_i) < READS);
    assume (!beat || axi_rlast_i == (32'(count_q) == BEATS - 1));
    if (live_q) begin
      assert (!answered_q || (mem_valid_o && line_there == answered_data_q));
      // Hold the induction together.
      assert (32'(count_q) < BEATS);
      assert (count_q <= which || beat_there == data_q);
    end
    cover (live_q && answered_q && which == 4'd1 && axi_rvalid_i && axi_rid_i != watched);
  end
