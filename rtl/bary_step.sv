`default_nettype none

/// One level of the hit mapping: child number and barycentrics in it (paper figure 10).
///
/// If b_k > 1/2 for one k (at most one can be, as they add up to 1): child k, b_k' = 2 b_k - 1 and the others doubled; else child 3 and each b' = 1 - 2b. Exactly 1/2 goes
/// to the centre. 1 is 2^31. Legal: b0 + b1 + b2 = 2^31. Combinational.
module bary_step (
  input  logic [2:0][lod_pkg::BARY_W-1:0] b_i,
  output logic [1:0]                      child_o,
  output logic [2:0][lod_pkg::BARY_W-1:0] b_o
);

  localparam int unsigned W = lod_pkg::BARY_W;
  localparam logic [W-1:0] ONE = {1'b1, {(W-1){1'b0}}};

  logic [2:0] above;
  always_comb begin
    // Above 2^30: 2^31 itself, or 2^30 and something.
    for (int unsigned k = 0; k < 3; k++) above[k] = b_i[k][W-1] || (b_i[k][W-2] && b_i[k][W-3:0] != '0);
  end

  assign child_o = above[0] ? 2'd0 : above[1] ? 2'd1 : above[2] ? 2'd2 : 2'd3;

  always_comb begin
    for (int unsigned k = 0; k < 3; k++) begin
      // 2b - 1 changes the top bit alone; where no b is above 1/2, 2b is at most 1.
      if (above == '0) b_o[k] = ONE - {b_i[k][W-2:0], 1'b0};
      else if (above[k]) b_o[k] = {!b_i[k][W-2], b_i[k][W-3:0], 1'b0};
      else b_o[k] = {b_i[k][W-2:0], 1'b0};
    end
  end

endmodule

`default_nettype wire
