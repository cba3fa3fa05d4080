/// The edge of two triangles, seen from both sides.

/// From its other end an edge has the opposite normal p x q, and the opposite sign where its function is 0, unless its ends are one point.
module edge_function_opposite (
  input logic                             clk_i,
  input logic                             rst_ni,
  input logic [3*lod_pkg::RELATIVE_W-1:0] p_i,
  input logic [3*lod_pkg::RELATIVE_W-1:0] q_i,
  input logic [lod_pkg::DIRECTION_W-1:0]  d_i
);

  localparam int unsigned N_W = lod_pkg::NORMAL_W;

  logic [3*N_W-1:0] there, back;
  logic             tie_there, tie_back;
  edge_function u_there (
    .clk_i, .rst_ni, .valid_i(1'b1), .ready_o(), .p_i, .q_i, .d_i, .normal_o(there), .valid_o(), .ready_i(1'b1), .value_o(), .tie_o(tie_there)
  );
  edge_function u_back (
    .clk_i, .rst_ni, .valid_i(1'b1), .ready_o(), .p_i(q_i), .q_i(p_i), .d_i, .normal_o(back), .valid_o(), .ready_i(1'b1), .value_o(), .tie_o(tie_back)
  );

  localparam logic [N_W-1:0] LEAST = {1'b1, {(N_W-1){1'b0}}};
  always_comb begin
    // Products are below 2^64 in magnitude, so that their differences are far from the least number of 66 bits.
    for (int unsigned k = 0; k < 3; k++) assume (there[k*N_W +: N_W] != LEAST && back[k*N_W +: N_W] != LEAST);
    for (int unsigned k = 0; k < 3; k++) assert (back[k*N_W +: N_W] == -there[k*N_W +: N_W]);
    assert (p_i == q_i || tie_back == !tie_there);
    assert (p_i != q_i || (tie_there && tie_back && there == '0));
    cover (p_i != q_i && there == '0 && tie_there);
    cover (there[3*N_W-1 -: N_W] == '0 && there[2*N_W-1 -: N_W] == N_W'(6) && tie_there);
  end

endmodule
