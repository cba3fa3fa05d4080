  // Inside ray_context, besides ray_context.svh: levels stay in range, whatever memory holds. Entries of a tree lie above all others on the stack, so they are gone before another tree is entered.
  localparam int unsigned PLACES = lod_pkg::STACK_ENTRIES;
  localparam int unsigned PLACES_W = $clog2(PLACES + 1);
  (* hierconn *) logic [PLACES_W-1:0] \u_stack.len_q ;

  // Kind and level of each entry that waits; what a pop gives is what was pushed there (`traversal_stack_order`).
  logic [PLACES-1:0][1:0] kinds_q;
  logic [PLACES-1:0][3:0] levels_q;
  logic [PLACES_W-1:0]    waiting, last;
  assign waiting = \u_stack.len_q ;
  assign last    = waiting - PLACES_W'(1);
  always_ff @(posedge clk_i) begin
    if (push) begin
      kinds_q[waiting]  <= child_entry.kind;
      levels_q[waiting] <= child_entry.level;
    end
  end
  always_comb begin
    assume (waiting == '0 || (top.kind == kinds_q[last] && top.level == levels_q[last]));
  end

  // What child_test gives are children that there are, four at most.
  logic given_are_there;
  always_comb begin
    given_are_there = child_i.count <= 3'd4;
    for (int unsigned k = 0; k < 4; k++) if (k < 32'(child_i.count) && !present[child_i.order[k]]) given_are_there = 1'b0;
    assume (!child_valid_i || given_are_there);
  end

  // Nodes are below the root and above what is stored of their tree, in every place; and above all else.
  logic some_node, nodes_fit, nodes_above, kinds_known;
  always_comb begin
    {some_node, nodes_fit, nodes_above, kinds_known} = 4'b0111;
    for (int unsigned k = 0; k < PLACES; k++) begin
      if (k < 32'(waiting)) begin
        if (kinds_q[k] == 2'd3) kinds_known = 1'b0;
        if (kinds_q[k] == lod_pkg::ENTRY_TREE_NODE) begin
          some_node = 1'b1;
          if (levels_q[k] == '0 || levels_q[k] >= depth) nodes_fit = 1'b0;
          if (k + 1 < 32'(waiting) && kinds_q[(k+1) % PLACES] != lod_pkg::ENTRY_TREE_NODE) nodes_above = 1'b0;
        end
      end
    end
  end

  logic sorted_are_there;
  always_comb begin
    sorted_are_there = 1'b1;
    for (int unsigned k = 0; k < 4; k++) if (k < 32'(count_q) && !present[sorted_q.order[k]]) sorted_are_there = 1'b0;
  end

  // In a tree, or between trees and quad-BVH nodes.
  logic line_matters, in_tree;
  assign line_matters = state_q == lod_pkg::FETCH || state_q == lod_pkg::CHILD || state_q == lod_pkg::CHILD_WAIT || state_q == lod_pkg::PUSH;
  assign in_tree      = (state_q >= lod_pkg::LOD && state_q <= lod_pkg::MORPH_WAIT) || (line_matters && split_there);

  always_comb begin
    if (live && traverses) begin
      assert (32'(waiting) <= PLACES);
      assert (nodes_fit);
      assert (nodes_above);
      assert (kinds_known);
      assert (!some_node || depth <= scene_i.levels && depth <= 4'(lod_pkg::STORED_LEVELS));
      // A record is fetched for a tree's entry, whose level and node are the root's.
      if (state_q == lod_pkg::FETCH && fetch_q == lod_pkg::RECORD) assert (entry.kind == lod_pkg::ENTRY_TREE);
      // A node under visit, and where it is.
      if (in_tree) assert (level < depth && depth <= scene_i.levels && depth <= 4'(lod_pkg::STORED_LEVELS));
      if (state_q == lod_pkg::VISIT && entry.kind == lod_pkg::ENTRY_TREE_NODE) assert (entry.level != '0 && entry.level < depth && depth <= scene_i.levels && depth <= 4'(lod_pkg::STORED_LEVELS));
      // Who tessellates has fetched vertices; children are of a node or a split.
      if (state_q == lod_pkg::MORPH || state_q == lod_pkg::MORPH_WAIT) assert (fetch_q == lod_pkg::SPLIT);
      if (line_matters) assert (fetch_q <= lod_pkg::SPLIT);
      if (line_matters && state_q != lod_pkg::FETCH) assert (fetch_q != lod_pkg::RECORD);
      if (line_matters && state_q != lod_pkg::FETCH && !split_there) assert (!wrong_node);
      // Children under way are there, and what is visited is of a kind that there is.
      if (state_q == lod_pkg::PUSH) assert (count_q <= 3'd4 && sorted_are_there);
      if (state_q == lod_pkg::VISIT) assert (entry.kind != 2'd3);
      // Only nodes that split into nodes have children to test.
      if (line_matters && split_there && state_q != lod_pkg::FETCH) assert (!last_split);
      // No node of a tree waits while another is looked for.
      if (state_q == lod_pkg::VISIT && entry.kind != lod_pkg::ENTRY_TREE_NODE) assert (!some_node);
      if (line_matters && !split_there) assert (!some_node);
      // The split triangles that are written and read are there.
      if (morph_valid_i && !last_split) assert (32'(level) < SPLITS);
      if (enter_node) assert (32'(entry.level) - 1 < SPLITS);
    end
    cover (live && state_q == lod_pkg::VISIT && entry.kind == lod_pkg::ENTRY_TREE);
  end
