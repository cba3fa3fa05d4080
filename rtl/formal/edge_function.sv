`default_nettype none

/// The normal of an edge, seen from both ends.

/// q x p is -(p x q), for products that do not depend on the order of their factors.
module cross_product_opposite (
  input logic                             clk_i,
  input logic                             rst_ni,
  input logic [3*lod_pkg::RELATIVE_W-1:0] p_i,
  input logic [3*lod_pkg::RELATIVE_W-1:0] q_i
);

  localparam int unsigned N_W = lod_pkg::NORMAL_W;

  logic [3*N_W-1:0] there, back;
  cross_product #(.W(lod_pkg::RELATIVE_W)) u_there (
    .clk_i, .rst_ni, .valid_i(1'b1), .ready_o(), .p_i, .q_i, .valid_o(), .ready_i(1'b1), .cross_o(there)
  );
  cross_product #(.W(lod_pkg::RELATIVE_W)) u_back (
    .clk_i, .rst_ni, .valid_i(1'b1), .ready_o(), .p_i(q_i), .q_i(p_i), .valid_o(), .ready_i(1'b1), .cross_o(back)
  );

  always_comb begin
    for (int unsigned k = 0; k < 3; k++) assert (back[k*N_W +: N_W] == -there[k*N_W +: N_W]);
    cover (p_i != q_i);
  end

endmodule

`default_nettype wire
