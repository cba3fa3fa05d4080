`default_nettype none

/// Who decides about edges (paper section 3.8).

/// An edge of three base triangles, at whichever place and from whichever end: that of the last hit and two others. They have the same decider for it, one of the two viewers, whatever their other
/// corners are; a triangle that shares no edge with that of the last hit has the ray itself everywhere.
module tree_deciders_shared (
  input logic                             clk_i,
  input logic                             rst_ni,
  input logic [27:0]                      last_i,
  input logic [2:0][lod_pkg::POINT_W-1:0] corner_i,
  input logic [2:0]                       second_i,
  // Edge of the last hit's triangle; the places of its twins in the two others, from the other end or not, their numbers and third corners.
  input logic [1:0]                       edge_i,
  input logic [1:0][1:0]                  place_i,
  input logic [1:0]                       turned_i,
  input logic [1:0][27:0]                 tree_i,
  input logic [1:0][lod_pkg::POINT_W-1:0] third_i,
  // A triangle of any corners.
  input logic [27:0]                      other_i,
  input logic [2:0][lod_pkg::POINT_W-1:0] other_corner_i
);

  localparam int unsigned P_W = lod_pkg::POINT_W;

  // The ends of each edge of a triangle.
  logic [2:0][2*P_W-1:0] ends, other_ends;
  for (genvar k = 0; k < 3; k++) begin : g_ends
    assign ends[k]       = {corner_i[(k+1)%3], corner_i[(k+2)%3]};
    assign other_ends[k] = {other_corner_i[(k+1)%3], other_corner_i[(k+2)%3]};
  end

  logic [P_W-1:0] a, b;
  assign {a, b} = edge_i == 2'd0 ? ends[0] : edge_i == 2'd1 ? ends[1] : ends[2];

  // Triangles: the last hit's, its two neighbours, another.
  logic [3:0][2:0][P_W-1:0]          corner;
  logic [3:0][27:0]                  tree;
  logic [3:0][1:0]                   inner;
  logic [3:0][5:0]                   edges;
  logic [1:0][2*P_W-1:0]             there;
  assign corner[0] = corner_i;
  assign corner[3] = other_corner_i;
  assign tree      = {other_i, tree_i[1], tree_i[0], last_i};
  for (genvar n = 0; n < 2; n++) begin : g_neighbour
    assign there[n]    = turned_i[n] ? {b, a} : {a, b};
    assign corner[1+n] = place_i[n] == 2'd0 ? {there[n][P_W-1:0], there[n][P_W +: P_W], third_i[n]}
                       : place_i[n] == 2'd1 ? {there[n][P_W +: P_W], third_i[n], there[n][P_W-1:0]}
                       : {third_i[n], there[n][P_W-1:0], there[n][P_W +: P_W]};
  end
  for (genvar n = 0; n < 4; n++) begin : g_triangle
    lod_pkg::tree_deciders_in_t  in;
    lod_pkg::tree_deciders_out_t out;
    assign {inner[n], edges[n]} = out;
    assign in = {last_i, corner_i[0], corner_i[1], corner_i[2], second_i, tree[n], corner[n][0], corner[n][1], corner[n][2]};
    tree_deciders #(.TAG_W(1)) u_deciders (
      .clk_i, .rst_ni, .valid_i(1'b1), .ready_o(), .in_i(in), .tag_i(1'b0), .valid_o(), .ready_i(1'b1), .out_o(out), .tag_o()
    );
  end

  // Who decides about the shared edge.
  logic [1:0]      decided;
  logic [1:0][1:0] decider;
  assign decided = edge_i == 2'd0 ? edges[0][1:0] : edge_i == 2'd1 ? edges[0][3:2] : edges[0][5:4];
  for (genvar n = 0; n < 2; n++) begin : g_decider
    assign decider[n] = place_i[n] == 2'd0 ? edges[1+n][1:0] : place_i[n] == 2'd1 ? edges[1+n][3:2] : edges[1+n][5:4];
  end

  // Ends that an edge of another triangle has in common with one of the last hit's.
  logic [8:0] common;
  logic [2:0] foreign;
  for (genvar k = 0; k < 3; k++) begin : g_edge
    for (genvar i = 0; i < 3; i++) begin : g_common
      logic [P_W-1:0] p, q;
      assign {p, q}        = ends[i];
      assign common[3*k+i] = other_ends[k] == {p, q} || other_ends[k] == {q, p};
    end
    assign foreign[k] = common[3*k +: 3] == '0;
  end

  always_comb begin
    assume (edge_i != 2'd3 && place_i[0] != 2'd3 && place_i[1] != 2'd3);
    // Three different corners: a base triangle of two or of one has edges with the same ends.
    assume (corner_i[0] != corner_i[1] && corner_i[1] != corner_i[2] && corner_i[2] != corner_i[0]);
    for (int unsigned n = 0; n < 2; n++) assume (tree_i[n] != last_i);
    assert (inner[0] == 2'd1);
    for (int unsigned k = 0; k < 3; k++) assert (edges[0][2*k +: 2] == (second_i[k] ? 2'd2 : 2'd1));
    for (int unsigned n = 0; n < 2; n++) begin
      assert (decider[n] == decided);
      assert (inner[1+n] == 2'd0);
    end
    if (other_i != last_i) begin
      assert (inner[3] == 2'd0);
      for (int unsigned k = 0; k < 3; k++) assert ((edges[3][2*k +: 2] == 2'd0) == foreign[k]);
    end
    cover (decided == 2'd2 && place_i[0] != edge_i && turned_i == 2'b10);
    cover (other_i != last_i && foreign == 3'b101 && edges[3][3:2] == 2'd1);
  end

endmodule

/// An edge of a node lies on a base edge iff both its ends do. Corners of the nodes on the way down, as weights of the base corners that are 0 or not: corner k of child k stays, the others are
/// midpoints, which lie on an edge iff both ends of what they halve do.
module node_deciders_exact (
  input logic                          clk_i,
  input logic                          rst_ni,
  input logic [lod_pkg::DECIDER_W-1:0] inner_i,
  input logic [2:0][lod_pkg::DECIDER_W-1:0] edges_i,
  input logic [3:0]                    level_i,
  input logic [lod_pkg::NODE_INDEX_W-1:0] node_i
);

  localparam int unsigned DIGITS = lod_pkg::NODE_INDEX_W / 2;

  lod_pkg::node_deciders_out_t out;
  node_deciders #(.TAG_W(1)) u_deciders (
    .clk_i, .rst_ni, .valid_i(1'b1), .ready_o(), .in_i({inner_i, edges_i, level_i, node_i}), .tag_i(1'b0),
    .valid_o(), .ready_i(1'b1), .out_o(out), .tag_o()
  );

  // Of corner j, bit k: it lies on base edge k, so its weight of corner k is 0. The last digit of a node is the step down to itself.
  logic [9*(DIGITS+1)-1:0] on;
  assign on[9*DIGITS +: 9] = {3'b011, 3'b101, 3'b110};
  for (genvar n = 0; n < DIGITS; n++) begin : g_level
    logic [1:0] child;
    logic [8:0] above, below;
    assign child = node_i[2*n +: 2];
    assign above = on[9*(n+1) +: 9];
    for (genvar j = 0; j < 3; j++) begin : g_corner
      // The corners that it halves the edge of: those that are not j in the middle, else its own and the child's, which for corner j of child j is one.
      localparam int unsigned J1 = (j + 1) % 3;
      localparam int unsigned J2 = (j + 2) % 3;
      logic [2:0] own;
      assign own             = child == 2'd0 ? above[2:0] : child == 2'd1 ? above[5:3] : above[8:6];
      assign below[3*j +: 3] = child == 2'd3 ? above[3*J1 +: 3] & above[3*J2 +: 3] : above[3*j +: 3] & own;
    end
    assign on[9*n +: 9] = level_i > 4'(n) ? below : above;
  end

  logic [2:0] on_base;
  for (genvar k = 0; k < 3; k++) begin : g_edge
    assign on_base[k] = on[3*((k+1)%3)+k] && on[3*((k+2)%3)+k];
  end

  always_comb begin
    assume (level_i <= 4'(DIGITS));
    for (int unsigned k = 0; k < 3; k++) assert (out.by[k] == (on_base[k] ? edges_i[k] : inner_i));
    cover (level_i == 4'(DIGITS) && on_base == 3'b010 && edges_i[1] == 2'd2 && inner_i == 2'd1);
    cover (level_i == 4'd3 && on_base == '0);
  end

endmodule

`default_nettype wire
