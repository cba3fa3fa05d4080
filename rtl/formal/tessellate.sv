/// The inserted vertices. Coordinates in units; a vertex of grid g has its low g bits zero.

/// One coordinate, full width: the midpoint is exact, the morphed vertex lies between it and the stored one, on the grid, and nothing overflows.
module morph_between (
  input logic                             clk_i,
  input logic                             rst_ni,
  input logic signed [31:0]               a_i,
  input logic signed [31:0]               b_i,
  input logic signed [31:0]               q_i,
  input logic [lod_pkg::EDGE_STATE_W-1:0] s_i,
  input logic [3:0]                       grid_i
);

  logic signed [31:0] morphed, low, high;
  logic               valid, ready;
  morph_coordinate u_morph (
    .clk_i, .rst_ni, .valid_i(1'b1), .ready_o(ready), .a_i, .b_i, .q_i, .s_i, .grid_i, .valid_o(valid), .ready_i(1'b1), .morphed_o(morphed)
  );

  logic signed [32:0] sum;
  logic signed [31:0] m;
  logic        [31:0] corner_grid, vertex_grid;
  assign sum         = 33'(a_i) + 33'(b_i);
  assign m           = sum[32:1];
  assign vertex_grid = (32'd1 << grid_i) - 32'd1;
  assign corner_grid = {vertex_grid[30:0], 1'b1};
  assign low         = m < q_i ? m : q_i;
  assign high        = m < q_i ? q_i : m;

  always_comb begin
    assume (grid_i <= 4'(lod_pkg::MAX_LEVELS - 1) && s_i <= lod_pkg::EDGE_STATE_W'(lod_pkg::S_ONE));
    assume ((a_i & corner_grid) == '0 && (b_i & corner_grid) == '0 && (q_i & vertex_grid) == '0);
    // Parity: the midpoint of two corners is whole, and on the grid of the vertex.
    assert (!sum[0] && (m & vertex_grid) == '0);
    assert (low <= morphed && morphed <= high);
    assert ((morphed & vertex_grid) == '0);
    assert (s_i != '0 || morphed == m);
    assert (s_i != lod_pkg::EDGE_STATE_W'(lod_pkg::S_ONE) || morphed == q_i);
    assert (valid && ready);
    cover (grid_i == 4'd9 && s_i == 9'd128 && morphed != m && morphed != q_i && q_i < m);
    cover (grid_i == 4'd0 && m < -32'sd2000000000 && q_i > 32'sd2000000000 && s_i == 9'd255);
  end

endmodule

/// The edge of two triangles, seen from both: whichever corners the two triangles do not share, and from whichever end, the vertex inserted on it is the same.
module tessellate_shared (
  input logic                    clk_i,
  input logic                    rst_ni,
  input lod_pkg::tessellate_in_t in_i,
  input lod_pkg::tessellate_in_t other_i,
  input logic [1:0]              edge_i,
  input logic [1:0]              other_edge_i,
  input logic                    reversed_i
);

  localparam int unsigned W = lod_pkg::POINT_W;

  lod_pkg::tessellate_out_t out, other;
  logic [3:0]               unused_handshake;
  logic [15:0]              unused_tags;
  tessellate u_one (
    .clk_i, .rst_ni, .valid_i(1'b1), .ready_o(unused_handshake[0]), .in_i, .tag_i(8'd0),
    .valid_o(unused_handshake[1]), .ready_i(1'b1), .out_o(out), .tag_o(unused_tags[7:0])
  );
  tessellate u_other (
    .clk_i, .rst_ni, .valid_i(1'b1), .ready_o(unused_handshake[2]), .in_i(other_i), .tag_i(8'd0),
    .valid_o(unused_handshake[3]), .ready_i(1'b1), .out_o(other), .tag_o(unused_tags[15:8])
  );

  // {first end, second end, stored vertex, state} of an edge, and its morphed vertex.
  localparam int unsigned EDGE_W = 3 * W + lod_pkg::EDGE_STATE_W;
  logic [EDGE_W-1:0] here, there;
  logic [W-1:0]      vertex_here, vertex_there;
  always_comb begin
    unique case (edge_i)
      2'd0: {here, vertex_here} = {in_i.p1, in_i.p2, in_i.q0, in_i.s0, out.q0};
      2'd1: {here, vertex_here} = {in_i.p2, in_i.p0, in_i.q1, in_i.s1, out.q1};
      default: {here, vertex_here} = {in_i.p0, in_i.p1, in_i.q2, in_i.s2, out.q2};
    endcase
    unique case (other_edge_i)
      2'd0: {there, vertex_there} = {other_i.p1, other_i.p2, other_i.q0, other_i.s0, other.q0};
      2'd1: {there, vertex_there} = {other_i.p2, other_i.p0, other_i.q1, other_i.s1, other.q1};
      default: {there, vertex_there} = {other_i.p0, other_i.p1, other_i.q2, other_i.s2, other.q2};
    endcase
  end

  always_comb begin
    assume (in_i.grid == other_i.grid);
    assume (reversed_i ? here == {there[EDGE_W-W-1 -: W], there[EDGE_W-1 -: W], there[EDGE_W-2*W-1:0]} : here == there);
    assert (vertex_here == vertex_there);
    cover (reversed_i && edge_i == 2'd0 && other_edge_i == 2'd2 && in_i.p0 != other_i.p2);
    cover (!reversed_i && edge_i == 2'd1 && other_edge_i == 2'd0 && in_i.s1 == 9'd77);
  end

endmodule
