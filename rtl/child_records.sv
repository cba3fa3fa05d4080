`default_nettype none

/// The four children in two memory lines: boxes for `child_test`, and one of them as a stack entry.
///
/// The lines are a quad-BVH node (`tree_i` low) or a sibling group of bound data of node `node_i` on `level_i` (`tree_i` high). The entry is that of the child at
/// place `count_i` - 1 of the order; it means nothing while `count_i` is 0. Combinational.
module child_records (
  input  logic                                tree_i,
  input  logic [255:0]                        line0_i,
  input  logic [255:0]                        line1_i,
  input  logic [3:0]                          level_i,
  input  logic [lod_pkg::NODE_W-1:0]          node_i,
  input  logic [2:0]                          count_i,
  input  logic [3:0][1:0]                     order_i,
  input  logic [3:0][lod_pkg::T_NEAR_W-1:0]   t_near_i,
  output logic [3:0]                          present_o,
  output logic [3:0][lod_pkg::BOX16_W-1:0]    bounds_o,
  output lod_pkg::stack_entry_t               entry_o
);

  logic [3:0][127:0]    records;
  logic [1:0]           place, child;
  lod_pkg::bvh_child_t  child_node;
  lod_pkg::bound_data_t child_bounds;

  assign records      = {line1_i, line0_i};
  // 0 to 3 while count_i is 1 to 4, when it is used.
  assign place        = 2'(count_i - 3'd1);
  assign child        = order_i[place];
  assign child_node   = records[child];
  assign child_bounds = records[child];

  always_comb begin
    for (int unsigned k = 0; k < 4; k++) begin
      bounds_o[k] = records[k][lod_pkg::BOX16_W-1:0];
      // The two top bits of a quad-BVH slot are its kind, 0 if it is empty.
      present_o[k] = tree_i || records[k][127:126] != 2'd0;
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
      {entry_o.e0, entry_o.e1, entry_o.e2} = {child_bounds.e0, child_bounds.e1, child_bounds.e2};
    end else begin
      // Inner nodes and leaves have the kinds of their entries one lower; empty slots are never hit.
      entry_o.kind  = child_node.child.kind - 2'd1;
      entry_o.index = child_node.child.index;
    end
  end

endmodule

`default_nettype wire
