`default_nettype none

/// The end of the triangle test.

/// Hit iff the three signs agree, some function is not 0 and the triangle lies ahead; then the numbers are the magnitudes, and no sum wraps.
module tri_decide_exact (
  input logic                                           clk_i,
  input logic                                           rst_ni,
  input logic signed [lod_pkg::SIGNED_EDGE_W-1:0]        u_i,
  input logic signed [lod_pkg::SIGNED_EDGE_W-1:0]        v_i,
  input logic signed [lod_pkg::SIGNED_EDGE_W-1:0]        w_i,
  input logic [2:0]                                     tie_i,
  input logic signed [lod_pkg::SIGNED_T_NUMERATOR_W-1:0] t_num_i,
  input logic [7:0]                                     tag_i
);

  localparam int unsigned EDGE_W = lod_pkg::SIGNED_EDGE_W;
  localparam int unsigned T_W = lod_pkg::SIGNED_T_NUMERATOR_W;
  localparam int unsigned WIDE = T_W + 2;

  lod_pkg::tri_test_out_t out;
  logic [7:0]             tag;
  tri_decide u_decide (
    .clk_i, .rst_ni, .valid_i(1'b1), .ready_o(), .u_i, .v_i, .w_i, .tie_u_i(tie_i[2]), .tie_v_i(tie_i[1]), .tie_w_i(tie_i[0]),
    .t_num_i, .tag_i, .valid_o(), .ready_i(1'b1), .out_o(out), .tag_o(tag)
  );

  logic signed [WIDE-1:0] u, v, w, det, t_num;
  logic [2:0]             positive;
  logic                   hit;
  assign {u, v, w, t_num} = {WIDE'(u_i), WIDE'(v_i), WIDE'(w_i), WIDE'(t_num_i)};
  assign det      = u + v + w;
  assign positive = {u > 0 || (u == 0 && tie_i[2]), v > 0 || (v == 0 && tie_i[1]), w > 0 || (w == 0 && tie_i[0])};
  assign hit      = (positive == '0 || positive == '1) && det != 0 && t_num != 0 && (t_num > 0) == (det > 0);

  localparam logic signed [WIDE-1:0] EDGE_LIMIT = WIDE'(1) <<< (EDGE_W - 1);
  localparam logic signed [WIDE-1:0] T_LIMIT = WIDE'(1) <<< (T_W - 1);
  always_comb begin
    // Hadamard's bounds: of the edge functions, of their sum (the same for the triangle's own edges) and of the numerator of t.
    assume (u < EDGE_LIMIT && u > -EDGE_LIMIT && v < EDGE_LIMIT && v > -EDGE_LIMIT && w < EDGE_LIMIT && w > -EDGE_LIMIT);
    assume (det < EDGE_LIMIT && det > -EDGE_LIMIT && t_num < T_LIMIT && t_num > -T_LIMIT);
    assert (out.hit == hit);
    assert (tag == tag_i);
    if (hit) begin
      assert (out.front == (det < 0));
      assert (WIDE'(out.det) == (det < 0 ? -det : det) && WIDE'(out.v) == (det < 0 ? -v : v) && WIDE'(out.w) == (det < 0 ? -w : w));
      assert (WIDE'(out.t_num) == (det < 0 ? -t_num : t_num));
      // The weights of v and w are at most 1 together, so that 1 less both is not negative.
      assert (WIDE'(out.v) + WIDE'(out.w) <= WIDE'(out.det));
    end else begin
      assert (out == '0);
    end
    cover (hit && det < 0 && u == 0 && v == 0 && tie_i == 3'b000);
    cover (!hit && u == 0 && v > 0 && w > 0 && t_num > 0 && tie_i == 3'b000);
    cover (hit && out.det[95]);
  end

endmodule

`default_nettype wire
