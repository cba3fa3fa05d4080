`default_nettype none

/// The boxes of a node's children.

/// The box of a tree's child is the smallest box of codes that holds its morphed triangle, and the codes around its full-resolution triangle let out by the stored steps as far as
/// codes reach; that of a node's child lies its steps from the origin. Rounded outwards, and nothing wraps.
module child_boxes_exact (
  input logic                     clk_i,
  input logic                     rst_ni,
  input lod_pkg::child_boxes_in_t in_i,
  input logic [7:0]               tag_i
);

  localparam int unsigned P_W = lod_pkg::POINT_W;
  localparam logic signed [33:0] LIMIT = 34'sh0_7ffe_0000;
  localparam logic signed [33:0] MOST = 34'sd32767;

  lod_pkg::child_boxes_out_t out;
  logic [7:0]                tag;
  logic                      valid, ready;
  child_boxes u_boxes (.clk_i, .rst_ni, .valid_i(1'b1), .ready_o(ready), .in_i, .tag_i, .valid_o(valid), .ready_i(1'b1), .out_o(out), .tag_o(tag));

  // Corners of the four children (docs/numbers.md), at full resolution and as morphed.
  logic [3:0][3*P_W-1:0] full, morphed;
  assign full    = {in_i.g0, in_i.g1, in_i.g2, in_i.g1, in_i.g0, in_i.f2, in_i.g2, in_i.f1, in_i.g0, in_i.f0, in_i.g2, in_i.g1};
  assign morphed = {in_i.q0, in_i.q1, in_i.q2, in_i.q1, in_i.q0, in_i.p2, in_i.q2, in_i.p1, in_i.q0, in_i.p0, in_i.q2, in_i.q1};
  logic [2:0][15:0] origin;
  assign origin = {in_i.origin.z, in_i.origin.y, in_i.origin.x};

  logic [11:0] legal, low_exact, high_exact, holds;
  for (genvar c = 0; c < 4; c++) begin : g_child
    for (genvar k = 0; k < 3; k++) begin : g_axis
      localparam int unsigned AT = (2 - k) * 32;
      // In units and in codes, with room.
      logic signed [31:0] f0, f1, f2, p0, p1, p2;
      logic signed [15:0] from, low, high;
      logic signed [33:0] fa, fb, fc, pa, pb, pc, f_least, f_most, p_least, p_most, f_floor, f_ceil, p_floor, p_ceil;
      logic signed [33:0] down, up, base, lo, hi, tree_lo, tree_hi, node_lo, node_hi;
      assign {f0, f1, f2} = {full[c][2*P_W+AT +: 32], full[c][P_W+AT +: 32], full[c][AT +: 32]};
      assign {p0, p1, p2} = {morphed[c][2*P_W+AT +: 32], morphed[c][P_W+AT +: 32], morphed[c][AT +: 32]};
      assign {fa, fb, fc} = {34'(f0), 34'(f1), 34'(f2)};
      assign {pa, pb, pc} = {34'(p0), 34'(p1), 34'(p2)};
      assign from = origin[k];
      assign low  = out.bounds[c][(5-k)*16 +: 16];
      assign high = out.bounds[c][(2-k)*16 +: 16];
      assign {base, lo, hi} = {34'(from), 34'(low), 34'(high)};

      assign down = ((34'(in_i.planes[6*c+k]) * (in_i.halves[k] ? 34'd3 : 34'd2)) << in_i.exponents[k]) >> 1;
      assign up   = ((34'(in_i.planes[6*c+3+k]) * (in_i.halves[k] ? 34'd3 : 34'd2)) << in_i.exponents[k]) >> 1;

      assign f_least = fa < fb ? (fa < fc ? fa : fc) : (fb < fc ? fb : fc);
      assign f_most  = fa > fb ? (fa > fc ? fa : fc) : (fb > fc ? fb : fc);
      assign p_least = pa < pb ? (pa < pc ? pa : pc) : (pb < pc ? pb : pc);
      assign p_most  = pa > pb ? (pa > pc ? pa : pc) : (pb > pc ? pb : pc);
      assign f_floor = f_least >>> 16;
      assign p_floor = p_least >>> 16;
      assign f_ceil  = (f_most + 34'sd65535) >>> 16;
      assign p_ceil  = (p_most + 34'sd65535) >>> 16;

      assign tree_lo = f_floor - down < -MOST ? -MOST : f_floor - down;
      assign tree_hi = f_ceil + up > MOST ? MOST : f_ceil + up;
      assign node_lo = base + down > MOST ? MOST : base + down;
      assign node_hi = base + up > MOST ? MOST : base + up;

      assign legal[3*c+k] = fa <= LIMIT && fa >= -LIMIT && fb <= LIMIT && fb >= -LIMIT && fc <= LIMIT && fc >= -LIMIT && from != 16'sh8000
        && pa <= LIMIT && pa >= -LIMIT && pb <= LIMIT && pb >= -LIMIT && pc <= LIMIT && pc >= -LIMIT;
      assign low_exact[3*c+k]  = lo == (!in_i.tree ? node_lo : tree_lo < p_floor ? tree_lo : p_floor);
      assign high_exact[3*c+k] = hi == (!in_i.tree ? node_hi : tree_hi > p_ceil ? tree_hi : p_ceil);
      // In units: the corners of both triangles.
      assign holds[3*c+k] = !in_i.tree || (lo <<< 16 <= fa && lo <<< 16 <= fb && lo <<< 16 <= fc && lo <<< 16 <= pa && lo <<< 16 <= pb && lo <<< 16 <= pc
        && hi <<< 16 >= fa && hi <<< 16 >= fb && hi <<< 16 >= fc && hi <<< 16 >= pa && hi <<< 16 >= pb && hi <<< 16 >= pc);
    end
  end

  for (genvar i = 0; i < 12; i++) begin : g_proved
    always_comb begin
      assert (low_exact[i]);
      assert (high_exact[i]);
      assert (holds[i]);
    end
  end
  always_comb begin
    assume (legal == '1);
    assert (tag == tag_i && valid && ready);
    cover (in_i.tree && in_i.p0.x == LIMIT[31:0] && out.bounds[0][32 +: 16] == 16'd32766 && in_i.planes[3] == 7'd9);
    cover (in_i.tree && out.bounds[3][80 +: 16] == 16'h8001 && in_i.planes[18] == 7'd127 && in_i.exponents[0] == 4'd8);
    cover (in_i.tree && in_i.halves[1] && in_i.exponents[1] == '0 && in_i.planes[7] == 7'd3 && out.bounds[1][64 +: 16] == 16'd100);
    cover (!in_i.tree && out.bounds[2][0 +: 16] == 16'd32767 && out.bounds[2][48 +: 16] == 16'h8001);
  end

endmodule

`default_nettype wire
