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
  localparam logic signed [31:0] LIMIT = 32'sh7ffe_0000;
  localparam logic signed [25:0] MOST = 26'sd32767;

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
      logic signed [31:0] fa, fb, fc, pa, pb, pc;
      logic signed [15:0] from, low, high;
      // In codes, with room for steps of 24 bits: floors, ceilings, planes.
      logic signed [25:0] fla, flb, flc, fha, fhb, fhc, pla, plb, plc, pha, phb, phc, f_low, f_high, p_low, p_high;
      logic signed [25:0] down, up, base, lo, hi, tree_lo, tree_hi, node_lo, node_hi;
      // In units, with room.
      logic signed [33:0] wide_lo, wide_hi;
      assign {fa, fb, fc} = {full[c][2*P_W+AT +: 32], full[c][P_W+AT +: 32], full[c][AT +: 32]};
      assign {pa, pb, pc} = {morphed[c][2*P_W+AT +: 32], morphed[c][P_W+AT +: 32], morphed[c][AT +: 32]};
      assign from         = origin[k];
      assign low          = out.bounds[c][(5-k)*16 +: 16];
      assign high         = out.bounds[c][(2-k)*16 +: 16];
      assign {base, lo, hi}     = {26'(from), 26'(low), 26'(high)};
      assign {wide_lo, wide_hi} = {34'(lo) <<< 16, 34'(hi) <<< 16};

      assign down = ((26'(in_i.planes[6*c+k]) * (in_i.halves[k] ? 26'd3 : 26'd2)) << in_i.exponents[k]) >> 1;
      assign up   = ((26'(in_i.planes[6*c+3+k]) * (in_i.halves[k] ? 26'd3 : 26'd2)) << in_i.exponents[k]) >> 1;

      assign {fla, flb, flc} = {26'(fa >>> 16), 26'(fb >>> 16), 26'(fc >>> 16)};
      assign {pla, plb, plc} = {26'(pa >>> 16), 26'(pb >>> 16), 26'(pc >>> 16)};
      assign {fha, fhb, fhc} = {fla + 26'(fa[15:0] != '0), flb + 26'(fb[15:0] != '0), flc + 26'(fc[15:0] != '0)};
      assign {pha, phb, phc} = {pla + 26'(pa[15:0] != '0), plb + 26'(pb[15:0] != '0), plc + 26'(pc[15:0] != '0)};
      assign f_low   = fla < flb ? (fla < flc ? fla : flc) : (flb < flc ? flb : flc);
      assign f_high  = fha > fhb ? (fha > fhc ? fha : fhc) : (fhb > fhc ? fhb : fhc);
      assign p_low   = pla < plb ? (pla < plc ? pla : plc) : (plb < plc ? plb : plc);
      assign p_high  = pha > phb ? (pha > phc ? pha : phc) : (phb > phc ? phb : phc);
      assign tree_lo = f_low - down < -MOST ? -MOST : f_low - down;
      assign tree_hi = f_high + up > MOST ? MOST : f_high + up;
      assign node_lo = base + down > MOST ? MOST : base + down;
      assign node_hi = base + up > MOST ? MOST : base + up;

      assign legal[3*c+k] = fa <= LIMIT && fa >= -LIMIT && fb <= LIMIT && fb >= -LIMIT && fc <= LIMIT && fc >= -LIMIT && from != 16'sh8000
        && pa <= LIMIT && pa >= -LIMIT && pb <= LIMIT && pb >= -LIMIT && pc <= LIMIT && pc >= -LIMIT;
      assign low_exact[3*c+k]  = lo == (!in_i.tree ? node_lo : tree_lo < p_low ? tree_lo : p_low);
      assign high_exact[3*c+k] = hi == (!in_i.tree ? node_hi : tree_hi > p_high ? tree_hi : p_high);
      assign holds[3*c+k] = !in_i.tree || (wide_lo <= 34'(fa) && wide_lo <= 34'(fb) && wide_lo <= 34'(fc) && wide_lo <= 34'(pa) && wide_lo <= 34'(pb) && wide_lo <= 34'(pc)
        && wide_hi >= 34'(fa) && wide_hi >= 34'(fb) && wide_hi >= 34'(fc) && wide_hi >= 34'(pa) && wide_hi >= 34'(pb) && wide_hi >= 34'(pc));
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
    cover (in_i.tree && in_i.p0.x == LIMIT && out.bounds[0][32 +: 16] == 16'd32766 && in_i.planes[3] == 7'd9);
    cover (in_i.tree && out.bounds[3][80 +: 16] == 16'h8001 && in_i.planes[18] == 7'd127 && in_i.exponents[0] == 4'd8);
    cover (in_i.tree && in_i.halves[1] && in_i.exponents[1] == '0 && in_i.planes[7] == 7'd3 && out.bounds[1][64 +: 16] == 16'd100);
    cover (!in_i.tree && out.bounds[2][0 +: 16] == 16'd32767 && out.bounds[2][48 +: 16] == 16'h8001);
  end

endmodule

`default_nettype wire
