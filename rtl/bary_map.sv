`default_nettype none

/// Hit mapping: a point of a coarse triangle to the full-resolution triangle and barycentrics. Twin of src/block/bary_map.rs (paper sections 3.6 and 5, figures 7 and 10).
///
/// `bary_step` as many times as `levels` says, one a stage; the sum of the barycentrics stays 1 exactly and no memory is read.
/// Legal: b0 + b1 + b2 = 2^31, levels 0 to MAX_LEVELS, node below 4^(MAX_LEVELS - levels). Latency BARY_MAP_LATENCY = MAX_LEVELS, interval 1.
module bary_map #(
  parameter int unsigned TAG_W = 8
) (
  input  logic                   clk_i,
  input  logic                   rst_ni,
  input  logic                   valid_i,
  output logic                   ready_o,
  input  lod_pkg::bary_map_in_t  in_i,
  input  logic [TAG_W-1:0]       tag_i,
  output logic                   valid_o,
  input  logic                   ready_i,
  output lod_pkg::bary_map_out_t out_o,
  output logic [TAG_W-1:0]       tag_o
);

  localparam int unsigned LEVELS = lod_pkg::MAX_LEVELS;
  localparam int unsigned NODE_W = lod_pkg::NODE_W;
  localparam int unsigned B_W = lod_pkg::BARY_W;
  localparam int unsigned STATE_W = 4 + NODE_W + 3 * B_W + TAG_W;
  if (lod_pkg::BARY_MAP_LATENCY != LEVELS) begin : g_illegal_latency
    $error("bary_map: lod_pkg::BARY_MAP_LATENCY must be %0d", LEVELS);
  end

  // Levels still to go down, node, barycentrics and tag between the stages.
  logic [LEVELS:0]              valid, ready;
  logic [LEVELS:0][STATE_W-1:0] state;
  assign valid[0]      = valid_i;
  assign ready_o       = ready[0];
  assign state[0]      = {in_i.levels, in_i.node[NODE_W-1:0], in_i.b2, in_i.b1, in_i.b0, tag_i};
  assign valid_o       = valid[LEVELS];
  assign ready[LEVELS] = ready_i;

  for (genvar k = 0; k < LEVELS; k++) begin : g_level
    logic [3:0]          left, left_next;
    logic [NODE_W-1:0]   node, node_next;
    // Flat: Yosys loses the width of packed arrays inside a generate block.
    logic [3*B_W-1:0]    b, b_step, b_next;
    logic [TAG_W-1:0]    tag;
    logic [1:0]          child;
    assign {left, node, b, tag} = state[k];
    bary_step u_step (.b_i(b), .child_o(child), .b_o(b_step));
    // A legal node has room for two more bits while levels are left.
    assign left_next = left == '0 ? '0 : left - 4'd1;
    assign node_next = left == '0 ? node : {node[NODE_W-3:0], child};
    assign b_next    = left == '0 ? b : b_step;
    pipe_stage #(.W(STATE_W)) u_stage (
      .clk_i, .rst_ni, .valid_i(valid[k]), .ready_o(ready[k]), .data_i({left_next, node_next, b_next, tag}),
      .valid_o(valid[k+1]), .ready_i(ready[k+1]), .data_o(state[k+1])
    );
  end

  logic [3:0]          unused_left;
  logic [NODE_W-1:0]   node;
  logic [2:0][B_W-1:0] b;
  assign {unused_left, node, b, tag_o} = state[LEVELS];
  assign out_o = {lod_pkg::NODE_INDEX_W'(node), b[0], b[1], b[2]};

  if (lod_pkg::NODE_INDEX_W > NODE_W) begin : g_room
    logic unused_node;
    assign unused_node = ^in_i.node[lod_pkg::NODE_INDEX_W-1:NODE_W];
  end

endmodule

`default_nettype wire
