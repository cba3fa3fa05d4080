`default_nettype none

/// The boxes of the four children of a node for this ray. Twin of src/block/child_boxes.rs (paper section 3.4).
///
/// A child of a tree's node, of corners F at full resolution and P as morphed: lo = min(max(-32767, min floor(F) - steps), min floor(P)) and hi =
/// max(min(32767, max ceil(F) + steps), max ceil(P)) in codes of 2^16 units, steps = floor(v (2 + half) 2^exponent / 2) of its plane v. A child of a quad-BVH node:
/// min(32767, origin + steps) for both; all corners at full resolution are the origin there.
/// Legal: |points| <= 0x7FFE_0000, so that ceilings fit 16 bits, origin >= -32767; any where they do not count. Its last register is a `pipe_skid`.
/// Latency CHILD_BOXES_LATENCY = 3, interval 1.
module child_boxes #(
  parameter int unsigned TAG_W = 8
) (
  input  logic                      clk_i,
  input  logic                      rst_ni,
  input  logic                      valid_i,
  output logic                      ready_o,
  input  lod_pkg::child_boxes_in_t  in_i,
  input  logic [TAG_W-1:0]          tag_i,
  output logic                      valid_o,
  input  logic                      ready_i,
  output lod_pkg::child_boxes_out_t out_o,
  output logic [TAG_W-1:0]          tag_o
);

  localparam int unsigned CODE_W = lod_pkg::CODE3_W / 3;
  localparam int unsigned POINT_W = lod_pkg::POINT_W / 3;
  localparam int unsigned PLANE_W = 5;
  // A floor, and whether anything was cut off: a ceiling is their sum, and ceilings are ordered as these are.
  localparam int unsigned EXACT_W = CODE_W + 1;
  // Times 2 or 3: at most 93.
  localparam int unsigned PRODUCT_W = PLANE_W + 2;
  // A code and 16 bits of steps: within 2^17 in magnitude.
  localparam int unsigned SUM_W = CODE_W + 2;
  localparam logic [CODE_W-1:0] MOST = CODE_W'(32767);
  if (lod_pkg::CHILD_BOXES_LATENCY != 3) begin : g_illegal_latency
    $error("child_boxes: lod_pkg::CHILD_BOXES_LATENCY must be 3");
  end

  // The node's triangle at full resolution, then as morphed: three corners and three inserted vertices.
  logic [11:0][lod_pkg::POINT_W-1:0] points;
  logic [2:0][CODE_W-1:0]            origin;
  assign points = {in_i.q2, in_i.q1, in_i.q0, in_i.p2, in_i.p1, in_i.p0, in_i.g2, in_i.g1, in_i.g0, in_i.f2, in_i.f1, in_i.f0};
  assign origin = {in_i.origin.z, in_i.origin.y, in_i.origin.x};

  // Stage 1: codes; of two inserted vertices the smaller and the larger. Triangle t has its corners along an axis at 9 t + 3 axis, and so its pairs; pair j is that
  // of child j < 3, on the two edges that meet at corner j.
  logic [17:0][EXACT_W-1:0] corner_codes, corner_codes_q, inserted_codes, high_pairs, high_pairs_q;
  logic [17:0][CODE_W-1:0]  low_pairs, low_pairs_q;
  logic [17:0]              rises;
  logic [5:0]               last_rises, last_rises_q;
  for (genvar i = 0; i < 18; i++) begin : g_pair
    localparam int unsigned TRIANGLE = i / 9;
    localparam int unsigned AXIS = i / 3 % 3;
    localparam int unsigned FIRST = i - i % 3;
    logic [POINT_W-1:0]        p, q;
    logic signed [EXACT_W-1:0] a, b;
    logic                      framed;
    assign p                 = points[6*TRIANGLE+i%3][(2-AXIS)*POINT_W +: POINT_W];
    assign q                 = points[6*TRIANGLE+3+i%3][(2-AXIS)*POINT_W +: POINT_W];
    assign framed            = TRIANGLE == 0 && !in_i.tree;
    assign corner_codes[i]   = framed ? {origin[AXIS], 1'b0} : {p[POINT_W-1:lod_pkg::BOX_SHIFT], p[lod_pkg::BOX_SHIFT-1:0] != '0};
    assign inserted_codes[i] = {q[POINT_W-1:lod_pkg::BOX_SHIFT], q[lod_pkg::BOX_SHIFT-1:0] != '0};
    assign a                 = inserted_codes[FIRST+(i+1)%3];
    assign b                 = inserted_codes[FIRST+(i+2)%3];
    assign rises[i]          = a < b;
    assign low_pairs[i]      = framed ? origin[AXIS] : rises[i] ? a[EXACT_W-1:1] : b[EXACT_W-1:1];
    assign high_pairs[i]     = framed ? {origin[AXIS], 1'b0} : rises[i] ? b : a;
  end
  // Whether the first inserted vertex is below the second.
  for (genvar l = 0; l < 6; l++) begin : g_last
    assign last_rises[l] = rises[3*l+2];
  end

  // And the planes, v (2 + half).
  logic [23:0][PRODUCT_W-1:0] products, products_q;
  logic [2:0][3:0]            exponents_q;
  logic                       tree_pairs, valid_pairs, ready_pairs;
  logic [TAG_W-1:0]           tag_pairs;
  for (genvar i = 0; i < 24; i++) begin : g_product
    assign products[i] = PRODUCT_W'({in_i.planes[i], 1'b0}) + (in_i.halves[i%3] ? PRODUCT_W'(in_i.planes[i]) : '0);
  end
  pipe_stage #(.W(18 * (2 * EXACT_W + CODE_W) + 6 + 24 * PRODUCT_W + 3 * 4 + 1 + TAG_W)) u_pairs (
    .clk_i, .rst_ni, .valid_i, .ready_o, .data_i({corner_codes, low_pairs, high_pairs, last_rises, products, in_i.exponents, in_i.tree, tag_i}),
    .valid_o(valid_pairs), .ready_i(ready_pairs), .data_o({corner_codes_q, low_pairs_q, high_pairs_q, last_rises_q, products_q, exponents_q, tree_pairs, tag_pairs})
  );

  // Stage 2: the smallest and the largest code of each child's corners. Child 3 has all three inserted vertices: of the first two one cannot be the smallest, so the
  // smallest is that of the pair without it, and so with the largest. Child c's are at 3 c + axis.
  logic [11:0][CODE_W-1:0]  full_low, low, low_q, high, high_q;
  logic [11:0][EXACT_W-1:0] full_high;
  for (genvar i = 0; i < 24; i++) begin : g_ends
    localparam int unsigned CHILD = i / 3 % 4;
    localparam int unsigned AT = i % 12;
    localparam int unsigned LINE = i / 12 * 3 + i % 3;
    logic signed [CODE_W-1:0]  a, b, lowest;
    logic signed [EXACT_W-1:0] c, d, highest;
    if (CHILD < 3) begin : g_corner
      assign a       = corner_codes_q[3*LINE+CHILD][EXACT_W-1:1];
      assign b       = low_pairs_q[3*LINE+CHILD];
      assign lowest  = a < b ? a : b;
      assign c       = corner_codes_q[3*LINE+CHILD];
      assign d       = high_pairs_q[3*LINE+CHILD];
      assign highest = c > d ? c : d;
    end else begin : g_centre
      assign {a, b}  = {low_pairs_q[3*LINE+1], low_pairs_q[3*LINE]};
      assign lowest  = last_rises_q[LINE] ? a : b;
      assign {c, d}  = {high_pairs_q[3*LINE+1], high_pairs_q[3*LINE]};
      assign highest = last_rises_q[LINE] ? d : c;
    end
    if (i < 12) begin : g_full
      assign full_low[AT]  = lowest;
      assign full_high[AT] = highest;
    end else begin : g_morphed
      // At most 32766 for legal corners.
      assign low[AT]  = lowest;
      assign high[AT] = highest[EXACT_W-1:1] + CODE_W'(highest[0]);
    end
  end

  // And the planes that the full-resolution triangle, or the origin, gives.
  logic [11:0][SUM_W-1:0] outer_low, outer_low_q, outer_high, outer_high_q;
  logic                   tree_q, valid_ends, ready_ends;
  logic [TAG_W-1:0]       tag_ends;
  for (genvar i = 0; i < 12; i++) begin : g_outer
    localparam int unsigned LOW = i / 3 * 6 + i % 3;
    localparam int unsigned HIGH = LOW + 3;
    logic signed [CODE_W-1:0]  from_low;
    logic signed [EXACT_W-1:0] from_high;
    logic [CODE_W-1:0]         down, up;
    logic                      unused_low, unused_high;
    assign {from_low, from_high} = {full_low[i], full_high[i]};
    box_steps #(.W(PRODUCT_W)) u_down (.w_i(products_q[LOW]), .exponent_i(exponents_q[LOW%3]), .steps_o(down));
    box_steps #(.W(PRODUCT_W)) u_up (.w_i(products_q[HIGH]), .exponent_i(exponents_q[HIGH%3]), .steps_o(up));
    // The floor -+ steps, the carry as a bit below; the floor, whether anything was cut off, and steps.
    assign {outer_low[i], unused_low}   = {SUM_W'(from_low), tree_pairs} + {{2'd0, down} ^ {SUM_W{tree_pairs}}, tree_pairs};
    assign {outer_high[i], unused_high} = (SUM_W+1)'(from_high) + {2'd0, up, 1'b1};
  end
  pipe_stage #(.W(12 * 2 * (SUM_W + CODE_W) + 1 + TAG_W)) u_ends (
    .clk_i, .rst_ni, .valid_i(valid_pairs), .ready_o(ready_pairs), .data_i({outer_low, outer_high, low, high, tree_pairs, tag_pairs}),
    .valid_o(valid_ends), .ready_i(ready_ends), .data_o({outer_low_q, outer_high_q, low_q, high_q, tree_q, tag_ends})
  );

  // Stage 3: these as far as codes reach, or the morphed triangle, if there is one, where it reaches further, always within the range.
  logic                     widens;
  logic [3:0][6*CODE_W-1:0] bounds;
  assign widens = lod_pkg::LOD_TEST != 0 && tree_q;
  for (genvar i = 0; i < 12; i++) begin : g_plane
    localparam int unsigned CHILD = i / 3;
    localparam int unsigned AXIS = i % 3;
    logic signed [CODE_W-1:0] least, most;
    logic signed [SUM_W-1:0]  lower, upper;
    logic                     above, below, beyond;
    assign {least, most, lower, upper} = {low_q[i], high_q[i], outer_low_q[i], outer_high_q[i]};
    assign above  = !lower[SUM_W-1] && lower[SUM_W-2:CODE_W-1] != '0;
    assign below  = lower[SUM_W-1] && (lower[SUM_W-2:CODE_W-1] != '1 || lower[CODE_W-2:0] == '0);
    assign beyond = !upper[SUM_W-1] && upper[SUM_W-2:CODE_W-1] != '0;
    assign bounds[CHILD][(5-AXIS)*CODE_W +: CODE_W] = widens && SUM_W'(least) < lower ? least
                                                    : above ? MOST : below ? -MOST : lower[CODE_W-1:0];
    assign bounds[CHILD][(2-AXIS)*CODE_W +: CODE_W] = widens && SUM_W'(most) > upper ? most : beyond ? MOST : upper[CODE_W-1:0];
  end
  pipe_skid #(.W(4 * 6 * CODE_W + TAG_W)) u_out (
    .clk_i, .rst_ni, .valid_i(valid_ends), .ready_o(ready_ends), .data_i({bounds, tag_ends}),
    .valid_o, .ready_i, .data_o({out_o, tag_o})
  );

endmodule

`default_nettype wire
