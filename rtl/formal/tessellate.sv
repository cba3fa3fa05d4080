`default_nettype none

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

/// One edge in six triangles, at each place and from either end: whatever their other corners, vertices and states are, the vertex on that edge is the same.
module tessellate_shared (
  input logic                                  clk_i,
  input logic                                  rst_ni,
  input logic [3:0]                            grid_i,
  input lod_pkg::point_t                       a_i,
  input lod_pkg::point_t                       b_i,
  input lod_pkg::point_t                       q_i,
  input logic [lod_pkg::EDGE_STATE_W-1:0]      s_i,
  // What the six do not share: their third corner, other vertices and states.
  input logic [6*3*lod_pkg::POINT_W-1:0]       points_i,
  input logic [6*2*lod_pkg::EDGE_STATE_W-1:0]  states_i
);

  localparam int unsigned P_W = lod_pkg::POINT_W;
  localparam int unsigned S_W = lod_pkg::EDGE_STATE_W;

  logic [6*P_W-1:0] vertex;
  for (genvar k = 0; k < 6; k++) begin : g_triangle
    localparam int unsigned PLACE = k % 3;
    logic [P_W-1:0] first, second, c, q1, q2;
    logic [S_W-1:0] s1, s2;
    assign {first, second} = k < 3 ? {a_i, b_i} : {b_i, a_i};
    assign {c, q1, q2}     = points_i[k*3*P_W +: 3*P_W];
    assign {s1, s2}        = states_i[k*2*S_W +: 2*S_W];

    lod_pkg::tessellate_in_t  in;
    lod_pkg::tessellate_out_t out;
    if (PLACE == 0) begin : g_0
      assign in = {grid_i, s_i, s1, s2, c, first, second, q_i, q1, q2};
      assign vertex[k*P_W +: P_W] = out.q0;
    end else if (PLACE == 1) begin : g_1
      assign in = {grid_i, s1, s_i, s2, second, c, first, q1, q_i, q2};
      assign vertex[k*P_W +: P_W] = out.q1;
    end else begin : g_2
      assign in = {grid_i, s1, s2, s_i, first, second, c, q1, q2, q_i};
      assign vertex[k*P_W +: P_W] = out.q2;
    end
    tessellate #(.TAG_W(1)) u_tessellate (
      .clk_i, .rst_ni, .valid_i(1'b1), .ready_o(), .in_i(in), .tag_i(1'b0), .valid_o(), .ready_i(1'b1), .out_o(out), .tag_o()
    );
  end

  always_comb begin
    for (int unsigned k = 1; k < 6; k++) assert (vertex[k*P_W +: P_W] == vertex[0 +: P_W]);
    cover (s_i == 9'd77 && vertex[P_W-1:0] != q_i);
  end

endmodule

`default_nettype wire
