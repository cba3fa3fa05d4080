`default_nettype none

/// Order of six children by entry distance, for nodes of six. Twin of src/block/child_sort6.rs.
///
/// Hit children first, nearer before farther, equal distances by child number; missed ones follow by number. A network of twelve comparators in five steps on the
/// keys {missed, t_near, number}, all different; a missed child's distance counts as 0. Legal: anything. Latency CHILD_SORT6_LATENCY = 5, interval 1.
module child_sort6 #(
  parameter int unsigned TAG_W = 8
) (
  input  logic                      clk_i,
  input  logic                      rst_ni,
  input  logic                      valid_i,
  output logic                      ready_o,
  input  lod_pkg::child_sort6_in_t  in_i,
  input  logic [TAG_W-1:0]          tag_i,
  output logic                      valid_o,
  input  logic                      ready_i,
  output lod_pkg::child_sort6_out_t out_o,
  output logic [TAG_W-1:0]          tag_o
);

  localparam int unsigned STEPS = 5;
  // {missed, t_near, number}.
  localparam int unsigned KEY_W = 1 + lod_pkg::T_NEAR_W + 3;
  localparam int unsigned STAGE_W = 3 + 6 * KEY_W + TAG_W;
  // In each step, whom key k is compared with; itself if with none.
  localparam logic [STEPS*18-1:0] PARTNER = {
    3'd5, 3'd3, 3'd4, 3'd1, 3'd2, 3'd0,
    3'd4, 3'd5, 3'd2, 3'd3, 3'd0, 3'd1,
    3'd2, 3'd4, 3'd0, 3'd5, 3'd1, 3'd3,
    3'd5, 3'd3, 3'd4, 3'd1, 3'd2, 3'd0,
    3'd0, 3'd2, 3'd1, 3'd4, 3'd3, 3'd5
  };
  if (lod_pkg::CHILD_SORT6_LATENCY != STEPS) begin : g_illegal_latency
    $error("child_sort6: lod_pkg::CHILD_SORT6_LATENCY must be 5");
  end

  // Before step s, and behind the last.
  logic [STEPS:0][5:0][KEY_W-1:0]   keys;
  // Behind its comparators.
  logic [STEPS-1:0][5:0][KEY_W-1:0] sorted;
  logic [STEPS:0][2:0]              count;
  logic [STEPS:0]                   valid, ready;
  logic [STEPS:0][TAG_W-1:0]        tag;

  always_comb begin
    count[0] = '0;
    for (int unsigned k = 0; k < 6; k++) begin
      keys[0][k] = {!in_i.hit[k], in_i.t_near[k] & {lod_pkg::T_NEAR_W{in_i.hit[k]}}, 3'(k)};
      count[0]   = count[0] + 3'(in_i.hit[k]);
    end
  end
  assign valid[0] = valid_i;
  assign tag[0]   = tag_i;
  assign ready_o  = ready[0];

  for (genvar s = 0; s < STEPS; s++) begin : g_step
    for (genvar k = 0; k < 6; k++) begin : g_key
      localparam int unsigned P = 32'(PARTNER[18*s+3*k+:3]);
      if (P == k) begin : g_kept
        assign sorted[s][k] = keys[s][k];
      end else if (P > k) begin : g_less
        assign sorted[s][k] = keys[s][k] < keys[s][P] ? keys[s][k] : keys[s][P];
      end else begin : g_greater
        assign sorted[s][k] = keys[s][P] < keys[s][k] ? keys[s][k] : keys[s][P];
      end
    end
    pipe_stage #(.W(STAGE_W)) u_stage (
      .clk_i, .rst_ni, .valid_i(valid[s]), .ready_o(ready[s]), .data_i({count[s], sorted[s], tag[s]}),
      .valid_o(valid[s+1]), .ready_i(ready[s+1]), .data_o({count[s+1], keys[s+1], tag[s+1]})
    );
  end

  assign valid_o      = valid[STEPS];
  assign ready[STEPS] = ready_i;
  assign tag_o        = tag[STEPS];
  assign out_o.count  = count[STEPS];
  // The last stage keeps whole keys; only the numbers leave.
  logic unused_keys;
  always_comb begin
    unused_keys = 1'b0;
    for (int unsigned k = 0; k < 6; k++) begin
      out_o.order[k] = keys[STEPS][k][2:0];
      unused_keys    = unused_keys ^ (^keys[STEPS][k][KEY_W-1:3]);
    end
  end

endmodule

`default_nettype wire
