`default_nettype none

/// Is a new hit closer than the closest so far? Twin of src/block/hit_select.rs.
///
/// Smaller t first; at equal t a front face before a back face; then smaller id: the first full-resolution triangle below, tree 4^N + node 4^(N - level).
/// Equal t and id: the same triangle, not closer.
/// Legal: level <= levels <= MAX_LEVELS, node below 4^level, best_id below 2^28 4^MAX_LEVELS. Latency HIT_SELECT_LATENCY = 3, interval 1.
module hit_select #(
  parameter int unsigned TAG_W = 8
) (
  input  logic                     clk_i,
  input  logic                     rst_ni,
  input  logic                     valid_i,
  output logic                     ready_o,
  input  lod_pkg::hit_select_in_t  in_i,
  input  logic [TAG_W-1:0]         tag_i,
  output logic                     valid_o,
  input  logic                     ready_i,
  output lod_pkg::hit_select_out_t out_o,
  output logic [TAG_W-1:0]         tag_o
);

  localparam int unsigned TREE_W = 28;
  localparam int unsigned NODE_W = lod_pkg::NODE_W;
  localparam int unsigned ID_W = TREE_W + NODE_W;
  if (lod_pkg::HIT_SELECT_LATENCY != 3) begin : g_illegal_latency
    $error("hit_select: lod_pkg::HIT_SELECT_LATENCY must be 3");
  end

  // Stage 1: distances and sides compared, the tree at its place.
  logic              nearer, level_with;
  logic [ID_W-1:0]   tree;
  logic [3:0]        below;
  assign nearer     = !in_i.known || {in_i.t, !in_i.front} < {in_i.best_t, !in_i.best_front};
  assign level_with = in_i.t == in_i.best_t && in_i.front == in_i.best_front;
  assign tree       = ID_W'(in_i.tree) << {in_i.levels, 1'b0};
  assign below      = in_i.levels - in_i.level;

  logic              valid_tree, ready_tree, nearer_tree, level_tree;
  logic [ID_W-1:0]   tree_q, best_tree;
  logic [3:0]        below_q;
  logic [NODE_W-1:0] node_q;
  logic [TAG_W-1:0]  tag_tree;
  pipe_stage #(.W(2 + 2 * ID_W + 4 + NODE_W + TAG_W)) u_tree (
    .clk_i, .rst_ni, .valid_i, .ready_o, .data_i({nearer, level_with, tree, in_i.best_id[ID_W-1:0], below, in_i.node[NODE_W-1:0], tag_i}),
    .valid_o(valid_tree), .ready_i(ready_tree), .data_o({nearer_tree, level_tree, tree_q, best_tree, below_q, node_q, tag_tree})
  );

  // Stage 2: the node below it. A node of level n is below 4^n, so shifted below 4^N: the fields do not overlap.
  logic [NODE_W-1:0] node;
  logic [ID_W-1:0]   id;
  assign node = node_q << {below_q, 1'b0};
  assign id   = tree_q | ID_W'(node);

  logic             valid_id, ready_id, nearer_id, level_id;
  logic [ID_W-1:0]  id_q, best_id;
  logic [TAG_W-1:0] tag_id;
  pipe_stage #(.W(2 + 2 * ID_W + TAG_W)) u_id (
    .clk_i, .rst_ni, .valid_i(valid_tree), .ready_o(ready_tree), .data_i({nearer_tree, level_tree, id, best_tree, tag_tree}),
    .valid_o(valid_id), .ready_i(ready_id), .data_o({nearer_id, level_id, id_q, best_id, tag_id})
  );

  // Stage 3: the verdict.
  logic            closer, closer_out;
  logic [ID_W-1:0] id_out;
  assign closer = nearer_id || (level_id && id_q < best_id);
  pipe_stage #(.W(1 + ID_W + TAG_W)) u_out (
    .clk_i, .rst_ni, .valid_i(valid_id), .ready_o(ready_id), .data_i({closer, id_q, tag_id}),
    .valid_o, .ready_i, .data_o({closer_out, id_out, tag_o})
  );
  assign out_o = {closer_out, lod_pkg::FULL_ID_W'(id_out)};

  if (lod_pkg::NODE_INDEX_W > NODE_W) begin : g_room
    logic unused_room;
    assign unused_room = ^{in_i.best_id[lod_pkg::FULL_ID_W-1:ID_W], in_i.node[lod_pkg::NODE_INDEX_W-1:NODE_W]};
  end

endmodule

`default_nettype wire
