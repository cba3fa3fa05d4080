  // Inside lod_edges_serial, its elastic registers as wires: one triangle at the corners, one at the edges. Distance, bound, tolerance and opening show what they
  // are made from (the stubs), so an edge's state tells whose ends and whose code it is of.
  localparam int unsigned BESIDE_ALL_W = lod_pkg::KEPT_DIRECTION_W + CONE_W + 3 * CODE_W + SCALE_W + TAG_W;
  logic                    live_q;  // reset has been
  logic                    held_q, edge_held_q;
  logic [2:0][3*W-1:0]     taken_q, edge_taken_q;
  logic [BESIDE_ALL_W-1:0] beside_q, edge_beside_q;
  logic                    handed;
  initial live_q = 1'b0;
  assign handed = busy && pass == 2 && ready_pass;
  always_ff @(posedge clk_i) begin
    if (!rst_ni) begin
      {live_q, held_q, edge_held_q} <= 3'b100;
    end else begin
      if (valid_i && ready_o) {held_q, taken_q, beside_q} <= {1'b1, corners_i, direction_i, cone_i, codes_i, scale_i, tag_i};
      else if (handed) held_q <= 1'b0;
      if (handed) {edge_held_q, edge_taken_q, edge_beside_q} <= {1'b1, taken_q, beside_q};
      else if (valid_o && ready_i) edge_held_q <= 1'b0;
    end
  end

  // Distances of both triangles' corners in the order in which they go through: p1, p2, p0.
  logic [2:0][3*W-1:0] order;
  logic [2:0][L_W-1:0] near, far;
  assign order = {taken_q[0], taken_q[2], taken_q[1]};
  for (genvar k = 0; k < 3; k++) begin : g_shown
    localparam int unsigned CORNER = (k + 1) % 3;
    assign far[k]  = {taken_q[CORNER][2*W +: 32], taken_q[CORNER][W+30 +: 2]};
    assign near[k] = {edge_taken_q[CORNER][2*W +: 32], edge_taken_q[CORNER][W+30 +: 2]};
  end

  // What the states must be.
  lod_pkg::cone_t                       edge_cone;
  lod_pkg::bound_scale_t                edge_scale;
  logic [2:0][CODE_W-1:0]               codes;
  logic [TAG_W-1:0]                     edge_tag;
  logic [lod_pkg::KEPT_DIRECTION_W-1:0] unused_direction;
  logic [2:0][S_W-1:0]                  wanted;
  assign {unused_direction, edge_cone, codes, edge_scale, edge_tag} = edge_beside_q;
  for (genvar k = 0; k < 3; k++) begin : g_wanted
    logic [L_W-1:0] nearer;
    assign nearer    = $signed(near[k]) < $signed(near[(k+1)%3]) ? near[k] : near[(k+1)%3];
    assign wanted[k] = {codes[k], nearer[codes[k][5:0] < 6'(lod_pkg::TOLERANCE_W) ? codes[k][5:0] : 6'd0]};
  end

  always_comb begin
    if (live_q) begin
      assert (busy == held_q && edge_busy == edge_held_q && pass <= 2 && edge_pass <= 2);
      assert (ready_o == (!held_q || handed));
      if (held_q) begin
        assert ({direction_q, cone_q, codes_q, scale_q, tag_q} == beside_q);
        assert (corners_q[0] == order[pass]);
        assert (pass == 2 || corners_q[1] == order[pass+1]);
        assert (pass != 0 || corners_q[2] == order[2]);
        assert (pass == 0 || l2_q == far[pass-1]);
        assert (pass != 2 || l1_q == far[0]);
      end
      if (edge_held_q) begin
        assert ({edge_cone_q, edge_scale_q, edge_tag_q} == {edge_cone, edge_scale, edge_tag});
        assert (edge_l_q[0] == near[edge_pass] && edge_l_q[1] == near[edge_pass == 2 ? 0 : edge_pass+1]);
        assert (edge_l_q[2] == near[edge_pass == 0 ? 2 : edge_pass-1]);
        assert (edge_codes_q[0] == codes[edge_pass]);
        assert (edge_pass == 2 || edge_codes_q[1] == codes[edge_pass+1]);
        assert (edge_pass != 0 || edge_codes_q[2] == codes[2]);
        assert (edge_pass == 0 || {open1_q, s1_q} == {wanted[edge_pass-1] != '0, wanted[edge_pass-1]});
        assert (edge_pass != 2 || {open0_q, s0_q} == {wanted[0] != '0, wanted[0]});
      end
      // A triangle's states come out together, in their places and with its own tag.
      assert (valid_o == (edge_held_q && edge_pass == 2));
      if (valid_o) begin
        assert (tag_o == edge_tag && s_o == wanted && open_o == (wanted != '0));
      end
    end
    cover (live_q && valid_o && ready_i && handed && valid_i && s_o[0] != s_o[1] && s_o[1] != s_o[2]);
    cover (live_q && valid_o && !ready_i && held_q && pass == 2);
  end
