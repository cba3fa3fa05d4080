`default_nettype none

/// The hit mapping. Barycentrics are weights of the corners, 2^31 = 1.

/// One level down: the point stays where it is, and its new weights are weights.
module bary_step_point (
  input logic [2:0][lod_pkg::BARY_W-1:0] b_i
);

  localparam int unsigned W = lod_pkg::BARY_W;
  localparam int unsigned WIDE = W + 4;
  localparam logic [WIDE-1:0] ONE = WIDE'(1) << (W - 1);

  logic [1:0]          child;
  logic [2:0][W-1:0]   b;
  logic [WIDE-1:0]     b0, b1, b2, c0, c1, c2;
  bary_step u_step (.b_i, .child_o(child), .b_o(b));
  assign {b2, b1, b0} = {WIDE'(b_i[2]), WIDE'(b_i[1]), WIDE'(b_i[0])};
  assign {c2, c1, c0} = {WIDE'(b[2]), WIDE'(b[1]), WIDE'(b[0])};

  always_comb begin
    assume (b0 + b1 + b2 == ONE);
    // The sum is kept, and no weight is negative (which would be above 1 here).
    assert (c0 + c1 + c2 == ONE);
    assert (c0 <= ONE && c1 <= ONE && c2 <= ONE);
    // Twice the weights of the parent's corners, put together from those of the child's: (p0, q2, q1), (q2, p1, q0), (q1, q0, p2) or (q0, q1, q2), q_i the
    // midpoint of the two corners that are not p_i.
    unique case (child)
      2'd0: assert (2 * b0 == 2 * c0 + c1 + c2 && 2 * b1 == c1 && 2 * b2 == c2);
      2'd1: assert (2 * b0 == c0 && 2 * b1 == c0 + 2 * c1 + c2 && 2 * b2 == c2);
      2'd2: assert (2 * b0 == c0 && 2 * b1 == c1 && 2 * b2 == c0 + c1 + 2 * c2);
      2'd3: assert (2 * b0 == c1 + c2 && 2 * b1 == c0 + c2 && 2 * b2 == c0 + c1);
    endcase
    cover (child == 2'd0);
    cover (child == 2'd1);
    cover (child == 2'd2);
    cover (child == 2'd3);
  end

endmodule

/// The child that the step picks: corner child k iff b_k is above 1/2, else the centre, which has 1/2 itself.
module bary_step_child (
  input logic [2:0][lod_pkg::BARY_W-1:0] b_i
);

  localparam int unsigned W = lod_pkg::BARY_W;
  localparam int unsigned WIDE = W + 2;
  localparam logic [W-1:0] HALF = W'(1) << (W - 2);

  logic [1:0]        child;
  logic [2:0][W-1:0] b;
  bary_step u_step (.b_i, .child_o(child), .b_o(b));

  always_comb begin
    assume (WIDE'(b_i[0]) + WIDE'(b_i[1]) + WIDE'(b_i[2]) == WIDE'(1) << (W - 1));
    assert ((child == 2'd0) == (b_i[0] > HALF));
    assert ((child == 2'd1) == (b_i[1] > HALF));
    assert ((child == 2'd2) == (b_i[2] > HALF));
    cover (b_i[0] == HALF && b_i[1] == HALF);
    cover (b_i[2] > HALF);
  end

  logic unused_b;
  assign unused_b = ^b;

endmodule

/// All levels, on the node: one child number is appended for each, and none changes nothing.
module bary_map_node (
  input logic                   clk_i,
  input logic                   rst_ni,
  input lod_pkg::bary_map_in_t  in_i,
  input logic [7:0]             tag_i
);

  localparam int unsigned NODE_W = lod_pkg::NODE_INDEX_W;

  lod_pkg::bary_map_out_t out;
  logic [7:0]             tag;
  logic                   valid, ready;
  bary_map u_map (.clk_i, .rst_ni, .valid_i(1'b1), .ready_o(ready), .in_i, .tag_i, .valid_o(valid), .ready_i(1'b1), .out_o(out), .tag_o(tag));

  always_comb begin
    assume (in_i.levels <= 4'(lod_pkg::MAX_LEVELS));
    // The node is below 4^(10 - levels).
    assume ((in_i.node >> (NODE_W - 2 * in_i.levels)) == '0);
    assert ((out.node >> (2 * in_i.levels)) == in_i.node);
    assert (in_i.levels != '0 || (out.node == in_i.node && out.b0 == in_i.b0 && out.b1 == in_i.b1 && out.b2 == in_i.b2));
    assert (tag == tag_i && valid && ready);
    cover (in_i.levels == 4'd10 && out.node[19:18] == 2'd2 && out.node[1:0] == 2'd1);
    cover (in_i.levels == 4'd3 && in_i.node == 20'h3fff);
  end

endmodule

`default_nettype wire
