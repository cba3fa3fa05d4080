`default_nettype none

/// The LOD test as a whole.

/// One edge in six triangles, at each place and from either end: whatever their third corners and other bounds are, the edge's state is the same. The dots of
/// the corners are free; tolerance, bound and opening show what they are made from.
module lod_edge_shared (
  input logic                                clk_i,
  input logic                                rst_ni,
  input lod_pkg::ray_t                       ray_i,
  input lod_pkg::bound_scale_t               scale_i,
  input lod_pkg::point_t                     a_i,
  input lod_pkg::point_t                     b_i,
  input logic [lod_pkg::BOUND_CODE_W-1:0]    code_i,
  // What the six do not share: their third corner and other bounds.
  input logic [6*lod_pkg::POINT_W-1:0]       points_i,
  input logic [6*2*lod_pkg::BOUND_CODE_W-1:0] codes_i
);

  localparam int unsigned P_W = lod_pkg::POINT_W;
  localparam int unsigned C_W = lod_pkg::BOUND_CODE_W;
  localparam int unsigned S_W = lod_pkg::EDGE_STATE_W;

  logic [6*S_W-1:0] state;
  logic [5:0]       refine;
  for (genvar k = 0; k < 6; k++) begin : g_triangle
    localparam int unsigned PLACE = k % 3;
    logic [P_W-1:0] first, second, c;
    logic [C_W-1:0] e1, e2;
    assign {first, second} = k < 3 ? {a_i, b_i} : {b_i, a_i};
    assign c               = points_i[k*P_W +: P_W];
    assign {e1, e2}        = codes_i[k*2*C_W +: 2*C_W];

    lod_pkg::lod_test_in_t  in;
    lod_pkg::lod_test_out_t out;
    if (PLACE == 0) begin : g_0
      assign in = {ray_i, c, first, second, code_i, e1, e2, scale_i};
      assign state[k*S_W +: S_W] = out.s0;
    end else if (PLACE == 1) begin : g_1
      assign in = {ray_i, second, c, first, e1, code_i, e2, scale_i};
      assign state[k*S_W +: S_W] = out.s1;
    end else begin : g_2
      assign in = {ray_i, first, second, c, e1, e2, code_i, scale_i};
      assign state[k*S_W +: S_W] = out.s2;
    end
    assign refine[k] = out.refine == (out.s0 != '0 || out.s1 != '0 || out.s2 != '0);
    lod_test #(.TAG_W(1), .EDGES_PER_CYCLE(3)) u_test (
      .clk_i, .rst_ni, .valid_i(1'b1), .ready_o(), .in_i(in), .tag_i(1'b0), .valid_o(), .ready_i(1'b1), .out_o(out), .tag_o()
    );
  end

  always_comb begin
    for (int unsigned k = 1; k < 6; k++) assert (state[k*S_W +: S_W] == state[0 +: S_W]);
    // The triangle is refined iff some edge opens.
    assert (refine == '1);
    cover (state[S_W-1:0] == 9'd9 && a_i.x != b_i.x && points_i[P_W-1:0] != points_i[P_W +: P_W]);
  end

endmodule

`default_nettype wire
