`default_nettype none

/// The order of six children.

/// The numbers are a permutation; hit children first, nearer before farther, equal ones by number; missed ones follow by number; the count is that of the hits.
module child_sort6_order (
  input logic                     clk_i,
  input logic                     rst_ni,
  input lod_pkg::child_sort6_in_t in_i,
  input logic [7:0]               tag_i
);

  lod_pkg::child_sort6_out_t out;
  logic [7:0]               tag;
  logic                     valid, ready;
  child_sort6 u_sort (.clk_i, .rst_ni, .valid_i(1'b1), .ready_o(ready), .in_i, .tag_i, .valid_o(valid), .ready_i(1'b1), .out_o(out), .tag_o(tag));

  logic [5:0] seen;
  always_comb begin
    seen = '0;
    for (int unsigned k = 0; k < 6; k++) seen[out.order[k]] = 1'b1;
  end

  // Place k comes before place k + 1.
  logic [4:0] ordered;
  for (genvar k = 0; k < 5; k++) begin : g_place
    logic [2:0]                   a, b;
    logic                         hit_a, hit_b;
    logic [lod_pkg::T_NEAR_W-1:0] t_a, t_b;
    assign {a, b}         = {out.order[k], out.order[k+1]};
    assign {hit_a, hit_b} = {in_i.hit[a], in_i.hit[b]};
    assign {t_a, t_b}     = {in_i.t_near[a], in_i.t_near[b]};
    assign ordered[k]     = hit_a != hit_b ? hit_a : (!hit_a || t_a == t_b) ? a < b : t_a < t_b;
  end

  always_comb begin
    assert (seen == '1);
    assert (ordered == '1);
    assert (out.count == 3'(in_i.hit[0]) + 3'(in_i.hit[1]) + 3'(in_i.hit[2]) + 3'(in_i.hit[3]) + 3'(in_i.hit[4]) + 3'(in_i.hit[5]));
    assert (tag == tag_i && valid && ready);
    cover (out.count == 3'd6 && out.order[0] == 3'd5 && out.order[5] == 3'd0);
    cover (in_i.hit == '1 && in_i.t_near[0] == in_i.t_near[5] && in_i.t_near[1] == in_i.t_near[2]);
    cover (out.count == 3'd0);
  end

endmodule

`default_nettype wire
