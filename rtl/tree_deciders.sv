`default_nettype none

/// Which ray decides in a base triangle: 0 the ray itself, 1 and 2 its viewers (paper section 3.8). Twin of src/block/tree_deciders.rs.
///
/// In the base triangle of the last hit the first viewer decides inside, and about each base edge the one that `second` tells. Of another triangle, a base edge is
/// decided as the last hit's with the same two ends, in either order (the first such one), and everything else by the ray itself. Legal: any.
/// Latency TREE_DECIDERS_LATENCY = 2; interval 1.
module tree_deciders #(
  parameter int unsigned TAG_W = 8
) (
  input  logic                        clk_i,
  input  logic                        rst_ni,
  input  logic                        valid_i,
  output logic                        ready_o,
  input  lod_pkg::tree_deciders_in_t  in_i,
  input  logic [TAG_W-1:0]            tag_i,
  output logic                        valid_o,
  input  logic                        ready_i,
  output lod_pkg::tree_deciders_out_t out_o,
  output logic [TAG_W-1:0]            tag_o
);

  localparam int unsigned POINT_W = lod_pkg::POINT_W;
  if (lod_pkg::TREE_DECIDERS_LATENCY != 2) begin : g_illegal_latency
    $error("tree_deciders: lod_pkg::TREE_DECIDERS_LATENCY must be 2");
  end

  // Corner i of the last hit's triangle is corner j of this one: bit 3 i + j.
  logic [2:0][POINT_W-1:0] last, corner;
  logic [8:0]              equal, equal_q;
  assign last   = {in_i.a2, in_i.a1, in_i.a0};
  assign corner = {in_i.p2, in_i.p1, in_i.p0};
  for (genvar i = 0; i < 3; i++) begin : g_last
    for (genvar j = 0; j < 3; j++) begin : g_corner
      assign equal[3*i+j] = last[i] == corner[j];
    end
  end

  logic             valid_equal, ready_equal, same_q;
  logic [2:0]       second_q;
  logic [TAG_W-1:0] tag_q;
  pipe_stage #(.W(9 + 1 + 3 + TAG_W)) u_equal (
    .clk_i, .rst_ni, .valid_i, .ready_o, .data_i({equal, in_i.tree == in_i.last, in_i.second, tag_i}),
    .valid_o(valid_equal), .ready_i(ready_equal), .data_o({equal_q, same_q, second_q, tag_q})
  );

  logic [1:0]      inner;
  logic [2:0][1:0] edges;
  assign inner = same_q ? 2'd1 : 2'd0;
  for (genvar k = 0; k < 3; k++) begin : g_edge
    localparam int unsigned A = (k + 1) % 3;
    localparam int unsigned B = (k + 2) % 3;
    // Edge i of the last hit's triangle has the ends of this one.
    logic [2:0] shared;
    logic       second;
    for (genvar i = 0; i < 3; i++) begin : g_shared
      localparam int unsigned P = (i + 1) % 3;
      localparam int unsigned Q = (i + 2) % 3;
      assign shared[i] = (equal_q[3*P+A] && equal_q[3*Q+B]) || (equal_q[3*P+B] && equal_q[3*Q+A]);
    end
    assign second   = same_q ? second_q[k] : shared[0] ? second_q[0] : shared[1] ? second_q[1] : second_q[2];
    assign edges[k] = !same_q && shared == '0 ? 2'd0 : second ? 2'd2 : 2'd1;
  end

  pipe_stage #(.W(lod_pkg::TREE_DECIDERS_OUT_W + TAG_W)) u_out (
    .clk_i, .rst_ni, .valid_i(valid_equal), .ready_o(ready_equal), .data_i({inner, edges, tag_q}),
    .valid_o, .ready_i, .data_o({out_o, tag_o})
  );

endmodule

`default_nettype wire
