`default_nettype none

/// The four children in one memory line: their boxes as `child_test` takes them, and one of them as a stack entry.
///
/// The line is a quad-BVH node (`tree_i` low) or the split of node `node_i` on `level_i` (`tree_i` high). The entry is that of the child
/// at place `count_i` - 1 of the order; it means nothing while `count_i` is 0. Combinational.
module child_records (
  input  logic                              tree_i,
  input  logic [255:0]                      line_i,
  input  logic [3:0]                        level_i,
  input  logic [lod_pkg::KEPT_NODE_W-1:0]        node_i,
  input  logic [2:0]                        count_i,
  input  logic [3:0][1:0]                   order_i,
  input  logic [3:0][lod_pkg::T_NEAR_W-1:0] t_near_i,
  // Of a node: no scene has one of such kinds, or with its frame there.
  output logic                              wrong_o,
  output logic [3:0]                        present_o,
  output lod_pkg::code3_t                   origin_o,
  output logic [2:0]                        halves_o,
  output logic [2:0][3:0]                   exponents_o,
  output logic [23:0][4:0]                  planes_o,
  output lod_pkg::stack_entry_t             entry_o
);

  localparam logic [1:0] EMPTY = 2'd0;
  localparam logic [1:0] INNER = 2'd1;
  localparam logic [1:0] LEAF = 2'd2;

  lod_pkg::bvh_node_t      node;
  lod_pkg::split_record_t split;
  logic [1:0]              place, child;

  assign node  = line_i;
  assign split = line_i;
  // 0 to 3 while count_i is 1 to 4, when it is used.
  assign place = 2'(count_i - 3'd1);
  assign child = order_i[place];

  // There are three kinds of slots, and no box code is below -32767.
  always_comb begin
    wrong_o = node.origin.x == 16'sh8000 || node.origin.y == 16'sh8000 || node.origin.z == 16'sh8000;
    for (int unsigned k = 0; k < 4; k++) if (node.kinds[k] == 2'd3) wrong_o = 1'b1;
  end

  // A split's boxes have no frame of their own, and its planes are narrower.
  assign origin_o    = tree_i ? '0 : node.origin;
  assign halves_o    = tree_i ? split.halves : node.halves;
  assign exponents_o = tree_i ? split.exponents : node.exponents;
  always_comb begin
    for (int unsigned k = 0; k < 4; k++) present_o[k] = tree_i || node.kinds[k] != EMPTY;
    for (int unsigned k = 0; k < 24; k++) planes_o[k] = tree_i ? {3'd0, split.planes[k]} : node.planes[k];
  end

  // Inner children are consecutive nodes and leaves consecutive trees, in the order of their slots: how many there are before this child.
  logic [1:0] inner_before;
  logic [3:0] leaves_before;
  always_comb begin
    inner_before  = '0;
    // At most three slots of four things.
    leaves_before = '0;
    for (int unsigned k = 0; k < 3; k++) begin
      if (child > 2'(k) && node.kinds[k] == INNER) inner_before = inner_before + 2'd1;
      if (child > 2'(k) && node.kinds[k] == LEAF) leaves_before = leaves_before + 4'(node.counts[k]) + 4'd1;
    end
  end

  always_comb begin
    entry_o        = '0;
    entry_o.t_near = t_near_i[child];
    if (tree_i) begin
      entry_o.kind  = lod_pkg::ENTRY_TREE_NODE;
      // Level N - 1 at most has boxes: children of level N - 2 at most, node_i below 4^(N - 2).
      entry_o.level = level_i + 4'd1;
      entry_o.index = 28'({node_i, child});
      // The edges of child 3 are those opposite the node's corners in the others.
      unique case (child)
        2'd0: {entry_o.e2, entry_o.e1, entry_o.e0} = split.codes[2:0];
        2'd1: {entry_o.e2, entry_o.e1, entry_o.e0} = split.codes[5:3];
        2'd2: {entry_o.e2, entry_o.e1, entry_o.e0} = split.codes[8:6];
        2'd3: {entry_o.e2, entry_o.e1, entry_o.e0} = {split.codes[8], split.codes[4], split.codes[0]};
      endcase
    end else begin
      // Inner nodes and leaves have the kinds of their entries one lower; empty slots are never hit.
      entry_o.kind  = node.kinds[child] - 2'd1;
      entry_o.index = node.kinds[child] == INNER ? node.first_node + 28'(inner_before) : node.first_leaf + 28'(leaves_before);
    end
  end

endmodule

`default_nettype wire
