`default_nettype none

/// The closest hit of one ray so far, and the way from its numerators to the hit record.
///
/// A result of `hit_select` that is closer takes the place of the hit before, where it counts: not before `t_min_i`, nor beyond the largest t, which `t_max_o` is without one. At the end b1 and b2 come from two divisions,
/// b0 = 2^31 - b1 - b2 follows in the cycle of `sum_i`, and `bary_map` gives the full-resolution triangle. No reset: `clear_i` comes first.
module closest_hit (
  input  logic                               clk_i,
  input  logic [3:0]                         levels_i,
  input  logic                               clear_i,
  input  logic [lod_pkg::RAY_T_W-1:0]        t_min_i,
  input  logic [lod_pkg::RAY_T_W-1:0]        largest_t_i,
  output logic                               known_o,
  output logic [lod_pkg::RAY_T_W-1:0]        t_max_o,
  output logic [lod_pkg::FULL_ID_W-1:0]      id_o,
  // A hit was compared; which one it is.
  input  logic                               select_valid_i,
  input  lod_pkg::hit_select_out_t           select_i,
  input  logic [lod_pkg::RAY_T_W-1:0]        t_i,
  input  logic [lod_pkg::INDEX_W-1:0]        tree_i,
  input  logic [3:0]                         level_i,
  input  logic [lod_pkg::KEPT_NODE_W-1:0]    node_i,
  input  logic                               front_i,
  input  logic [lod_pkg::EDGE_FUNCTION_W-1:0] v_i,
  input  logic [lod_pkg::EDGE_FUNCTION_W-1:0] w_i,
  input  logic [lod_pkg::EDGE_FUNCTION_W-1:0] det_i,
  input  logic [lod_pkg::FRACTION_W-1:0]      v_below_i,
  input  logic [lod_pkg::FRACTION_W-1:0]      w_below_i,
  // It is the closest now.
  output logic                               closer_o,
  // Barycentrics: the division of v, or of w.
  input  logic                               divide_v_i,
  output lod_pkg::start_divide_in_t          divide_o,
  input  logic                               divide_valid_i,
  input  logic [1:0]                         divide_what_i,
  input  lod_pkg::hit_divide_out_t           divide_i,
  input  logic                               sum_i,
  output lod_pkg::bary_map_in_t              map_o,
  input  logic                               map_valid_i,
  input  lod_pkg::bary_map_out_t             map_i,
  output lod_pkg::hit_t                      hit_o
);

  // Numerators without their zeros.
  localparam int unsigned EDGE_W = lod_pkg::SIGNED_EDGE_W - 1;
  localparam int unsigned ZEROS = lod_pkg::EDGE_ZEROS;
  // Where weights of the full-resolution triangle would lie in a numerator, and whether there is room for them and its node.
  localparam int unsigned FULL_AT = lod_pkg::BARY_W;
  localparam bit FULL_WITHIN = lod_pkg::HIT_MAPPING != 0 && EDGE_W >= 2 * lod_pkg::BARY_W + lod_pkg::NODE_INDEX_W;

  logic                                known_q;
  logic [lod_pkg::RAY_T_W-1:0]         t_max_q;
  logic [lod_pkg::FULL_ID_W-1:0]       id_q;
  logic [lod_pkg::INDEX_W-1:0]         tree_q;
  logic                                front_q;
  // The numerators v, w and det, and at their lower ends, once they have been divided, b1, b2 and b0: the quotient of v comes before w is asked for, so b1 may not lie in another.
  logic [EDGE_W-1:0]                   v_q, w_q, det_q;
  logic [lod_pkg::BARY_W-1:0]          b0, b1, b2;

  assign {b1, b2, b0} = {v_q[lod_pkg::BARY_W-1:0], w_q[lod_pkg::BARY_W-1:0], det_q[lod_pkg::BARY_W-1:0]};

  assign {known_o, t_max_o, id_o} = {known_q, t_max_q, id_q};

  // Where all t count there is nothing to compare.
  assign closer_o = select_valid_i && select_i.closer && (lod_pkg::SECONDARY == 0 || (t_i >= t_min_i && t_i <= t_max_q));

  always_ff @(posedge clk_i) begin
    if (clear_i) begin
      known_q <= 1'b0;
      t_max_q <= largest_t_i;
    end else if (closer_o) begin
      known_q <= 1'b1;
      t_max_q <= t_i;
    end
    if (closer_o) begin
      id_q    <= select_i.id;
      tree_q  <= tree_i;
      front_q <= front_i;
    end
  end

  // Numerators, and what takes their place.
  logic              quotient_of_v, quotient_of_w, map_within;
  logic [EDGE_W-1:0] v_mapped, w_mapped, det_mapped;
  assign quotient_of_v = divide_valid_i && divide_what_i == lod_pkg::DIVIDE_FOR_V;
  assign quotient_of_w = divide_valid_i && divide_what_i == lod_pkg::DIVIDE_FOR_W;
  always_ff @(posedge clk_i) begin
    if (closer_o) {v_q, w_q, det_q} <= {EDGE_W'(v_i >> ZEROS), EDGE_W'(w_i >> ZEROS), EDGE_W'(det_i >> ZEROS)};
    else begin
      // An edge function is at most det, so quotients are at most 2^32; their last bit is dropped: 32 bits.
      if (quotient_of_v) v_q[lod_pkg::BARY_W-1:0] <= divide_i.quotient[lod_pkg::BARY_W:1];
      if (quotient_of_w) w_q[lod_pkg::BARY_W-1:0] <= divide_i.quotient[lod_pkg::BARY_W:1];
      // Both were rounded down and v + w <= det: not negative.
      if (sum_i) det_q[lod_pkg::BARY_W-1:0] <= 32'h8000_0000 - b1 - b2;
      if (map_within) {v_q, w_q, det_q} <= {v_mapped, w_mapped, det_mapped};
    end
  end

  // What v and w have below whole numbers.
  logic [lod_pkg::FRACTION_W-1:0] low;
  if (lod_pkg::SECONDARY != 0) begin : g_below
    logic [lod_pkg::FRACTION_W-1:0] v_below_q, w_below_q;
    always_ff @(posedge clk_i) begin
      if (closer_o) {v_below_q, w_below_q} <= {v_below_i, w_below_i};
    end
    assign low = divide_v_i ? v_below_q : w_below_q;
  end else begin : g_whole
    logic unused_below;
    assign low          = '0;
    assign unused_below = ^{v_below_i, w_below_i, t_min_i};
  end

  // Edge functions fit a numerator of t: 96 bits of 99.
  logic [EDGE_W-1:0] numerator;
  assign numerator = divide_v_i ? v_q : w_q;
  always_comb begin
    divide_o.numerator   = lod_pkg::T_NUMERATOR_W'(numerator) << ZEROS;
    divide_o.low         = low;
    divide_o.denominator = lod_pkg::EDGE_FUNCTION_W'(det_q) << ZEROS;
  end

  // Level and node, where trees have any but their roots.
  logic [3:0]                       level;
  logic [lod_pkg::NODE_INDEX_W-1:0] node;
  if (lod_pkg::STORED_LEVELS != 0) begin : g_place
    logic [3:0]                      level_q;
    logic [lod_pkg::KEPT_NODE_W-1:0] node_q;
    always_ff @(posedge clk_i) begin
      if (closer_o) {level_q, node_q} <= {level_i, node_i};
    end
    assign {level, node} = {level_q, lod_pkg::NODE_INDEX_W'(node_q)};
  end else begin : g_root
    logic unused_place;
    assign {level, node} = '0;
    assign unused_place  = ^{level_i, node_i};
  end

  // The full-resolution triangle: this one, where all hits are on such. It comes last, when the numerators are done with, and lies above the weights where there is room.
  lod_pkg::bary_map_out_t full;
  if (FULL_WITHIN) begin : g_within
    assign map_within = map_valid_i;
    always_comb begin
      v_mapped   = v_q;
      w_mapped   = w_q;
      det_mapped = det_q;
      v_mapped[FULL_AT +: lod_pkg::BARY_W]   = map_i.b1;
      w_mapped[FULL_AT +: lod_pkg::BARY_W]   = map_i.b2;
      det_mapped[FULL_AT +: lod_pkg::BARY_W] = map_i.b0;
      v_mapped[EDGE_W-1 -: lod_pkg::NODE_INDEX_W] = map_i.node;
    end
    assign full = {v_q[EDGE_W-1 -: lod_pkg::NODE_INDEX_W], det_q[FULL_AT +: lod_pkg::BARY_W], v_q[FULL_AT +: lod_pkg::BARY_W], w_q[FULL_AT +: lod_pkg::BARY_W]};
  end else if (lod_pkg::HIT_MAPPING != 0) begin : g_full
    lod_pkg::bary_map_out_t full_q;
    always_ff @(posedge clk_i) begin
      if (map_valid_i) full_q <= map_i;
    end
    assign full       = full_q;
    assign map_within = 1'b0;
    assign {v_mapped, w_mapped, det_mapped} = '0;
  end else begin : g_finest
    logic unused_map;
    assign map_within = 1'b0;
    assign {v_mapped, w_mapped, det_mapped} = '0;
    assign full       = {node, b0, b1, b2};
    assign unused_map = ^{map_valid_i, map_i};
  end

  // The hit's level is at most N.
  always_comb begin
    map_o.levels = levels_i - level;
    map_o.node   = node;
    map_o.b0     = b0;
    map_o.b1     = b1;
    map_o.b2     = b2;
  end
  always_comb begin
    hit_o.t         = t_max_q;
    hit_o.front     = front_q;
    hit_o.tree      = 28'(tree_q);
    hit_o.level     = level;
    hit_o.node      = node;
    hit_o.b0        = b0;
    hit_o.b1        = b1;
    hit_o.b2        = b2;
    hit_o.full_node = full.node;
    hit_o.full_b0   = full.b0;
    hit_o.full_b1   = full.b1;
    hit_o.full_b2   = full.b2;
  end

endmodule

`default_nettype wire
