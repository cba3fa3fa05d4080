`default_nettype none

/// Which ray decides about the edges of a node of a tree, by who decides in the tree. Twin of src/block/node_deciders.rs.
///
/// Edge k of a child lies on edge k of its parent in the children at its ends: all but child k and the middle one, 3. So it lies on base edge k if none of the node's
/// digits, two bits of each level, is k or 3. Legal: level <= 10, node < 4^level. Latency NODE_DECIDERS_LATENCY = 1; interval 1.
module node_deciders #(
  parameter int unsigned TAG_W = 8
) (
  input  logic                        clk_i,
  input  logic                        rst_ni,
  input  logic                        valid_i,
  output logic                        ready_o,
  input  lod_pkg::node_deciders_in_t  in_i,
  input  logic [TAG_W-1:0]            tag_i,
  output logic                        valid_o,
  input  logic                        ready_i,
  output lod_pkg::node_deciders_out_t out_o,
  output logic [TAG_W-1:0]            tag_o
);

  localparam int unsigned DIGITS = lod_pkg::NODE_INDEX_W / 2;
  if (lod_pkg::NODE_DECIDERS_LATENCY != 1) begin : g_illegal_latency
    $error("node_deciders: lod_pkg::NODE_DECIDERS_LATENCY must be 1");
  end

  logic [2:0][1:0] by;
  for (genvar k = 0; k < 3; k++) begin : g_edge
    logic [DIGITS-1:0] leaves;
    for (genvar n = 0; n < DIGITS; n++) begin : g_digit
      assign leaves[n] = in_i.level > 4'(n) && (in_i.node[2*n +: 2] == 2'(k) || in_i.node[2*n +: 2] == 2'd3);
    end
    assign by[k] = leaves == '0 ? in_i.tree.edges[k] : in_i.tree.inner;
  end

  pipe_stage #(.W(lod_pkg::NODE_DECIDERS_OUT_W + TAG_W)) u_out (
    .clk_i, .rst_ni, .valid_i, .ready_o, .data_i({by, tag_i}), .valid_o, .ready_i, .data_o({out_o, tag_o})
  );

endmodule

`default_nettype wire
