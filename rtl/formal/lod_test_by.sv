`default_nettype none

/// The LOD test of rays that start on a surface, as a whole.

/// One edge in six triangles, at each place and from either end, and in each the ray that decides about it at whichever of the three places: whatever else differs, the other rays included, the
/// edge's state is the same. The dots of the corners are free; tolerance, bound and opening show what they are made from.
module lod_edge_by_shared (
  input logic                                   clk_i,
  input logic                                   rst_ni,
  input lod_pkg::ray_t                          decider_i,
  input lod_pkg::bound_scale_t                  scale_i,
  input lod_pkg::point_t                        a_i,
  input lod_pkg::point_t                        b_i,
  input logic [lod_pkg::BOUND_CODE_W-1:0]       code_i,
  // What the six do not share: the decider's place, their other rays and deciders, their third corner and other bounds.
  input logic [5:0][1:0]                        by_i,
  input logic [5:0][1:0][1:0]                   others_by_i,
  input logic [5:0][1:0][lod_pkg::RAY_W-1:0]    others_i,
  input logic [5:0][lod_pkg::POINT_W-1:0]       points_i,
  input logic [5:0][2*lod_pkg::BOUND_CODE_W-1:0] codes_i
);

  localparam int unsigned P_W = lod_pkg::POINT_W;
  localparam int unsigned C_W = lod_pkg::BOUND_CODE_W;
  localparam int unsigned R_W = lod_pkg::RAY_W;
  localparam int unsigned S_W = lod_pkg::EDGE_STATE_W;

  logic [5:0][S_W-1:0] state;
  logic [5:0]          refine;
  for (genvar k = 0; k < 6; k++) begin : g_triangle
    localparam int unsigned PLACE = k % 3;
    logic [P_W-1:0] first, second, c;
    logic [C_W-1:0] e1, e2;
    logic [1:0]     by1, by2;
    logic [3*R_W-1:0] rays;
    assign {first, second} = k < 3 ? {a_i, b_i} : {b_i, a_i};
    assign c               = points_i[k];
    assign {e1, e2}        = codes_i[k];
    assign {by1, by2}      = others_by_i[k];
    // The ray and its viewers, the decider among them.
    assign rays = by_i[k] == 2'd0 ? {decider_i, others_i[k][0], others_i[k][1]}
                : by_i[k] == 2'd1 ? {others_i[k][0], decider_i, others_i[k][1]} : {others_i[k][0], others_i[k][1], decider_i};

    lod_pkg::lod_test_by_in_t in;
    lod_pkg::lod_test_out_t   out;
    if (PLACE == 0) begin : g_0
      assign in = {rays, {by2, by1, by_i[k]}, c, first, second, code_i, e1, e2, scale_i};
      assign state[k] = out.s0;
    end else if (PLACE == 1) begin : g_1
      assign in = {rays, {by2, by_i[k], by1}, second, c, first, e1, code_i, e2, scale_i};
      assign state[k] = out.s1;
    end else begin : g_2
      assign in = {rays, {by_i[k], by2, by1}, first, second, c, e1, e2, code_i, scale_i};
      assign state[k] = out.s2;
    end
    assign refine[k] = out.refine == (out.s0 != '0 || out.s1 != '0 || out.s2 != '0);
    lod_test_by #(.TAG_W(1), .EDGES_PER_CYCLE(3)) u_test (
      .clk_i, .rst_ni, .valid_i(1'b1), .ready_o(), .in_i(in), .tag_i(1'b0), .valid_o(), .ready_i(1'b1), .out_o(out), .tag_o()
    );
  end

  always_comb begin
    for (int unsigned k = 0; k < 6; k++) assume (by_i[k] != 2'd3);
    for (int unsigned k = 1; k < 6; k++) assert (state[k] == state[0]);
    // The triangle is refined iff some edge opens.
    assert (refine == '1);
    cover (state[0] == 9'd9 && a_i.x != b_i.x && by_i[0] != by_i[1] && by_i[1] != by_i[2] && points_i[0] != points_i[1]);
  end

endmodule

`default_nettype wire
