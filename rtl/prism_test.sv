`default_nettype none

/// Ray against the prism of a node's child: division-free, and never a miss of what the prism holds. Twin of src/block/prism_test.rs (docs/numbers.md, "Prisms").
///
/// Across the ray, with corners c_i, e_m = c_(m+2) - c_(m+1), E_m = c_(m+1) x c_(m+2), A = E_0 + E_1 + E_2, N' the normal, K_i = N' x c_i: met if E_m, moved by the heights'
/// (K_(m+2) - K_(m+1)) height, is within [-reach_m A, (1 + reach_(m+1) + reach_(m+2)) A], 0 within the K_i let out by the reaches, and the prism not wholly behind the origin or beyond
/// `t_max`. A miss gives t_near = 0, and so does a prism that is not bounded.
/// Legal: a frame of `prism_frame` with corners of a child of its node. Stages 7 and 13 are a `pipe_skid`. Latency PRISM_TEST_LATENCY = 14; interval 1.
module prism_test #(
  parameter int unsigned TAG_W = 8
) (
  input  logic                    clk_i,
  input  logic                    rst_ni,
  input  logic                    valid_i,
  output logic                    ready_o,
  input  lod_pkg::prism_test_in_t in_i,
  input  logic [TAG_W-1:0]        tag_i,
  output logic                    valid_o,
  input  logic                    ready_i,
  output lod_pkg::box_test_out_t  out_o,
  output logic [TAG_W-1:0]        tag_o
);

  localparam int unsigned L_W = lod_pkg::LOCAL_W / 3;
  localparam int unsigned D_W = 12;
  localparam int unsigned T_W = lod_pkg::T_NEAR_W;
  localparam int unsigned Z_W = 33;
  localparam int unsigned RECIPROCAL_W = lod_pkg::RECIPROCAL_W;
  localparam int unsigned MANTISSA_W = 18;
  // Local coordinates times D: below 2^21. Edges are below 2^10, and so their products below 2^20.
  localparam int unsigned LD_W = 22;
  localparam int unsigned EDGE_W = 11;
  localparam int unsigned EE_W = 21;
  localparam int unsigned AREA_W = 22;
  // Corners across the ray, their products and cross products; A of a triangle in a square of 8190.
  localparam int unsigned C_W = 14;
  localparam int unsigned CC_W = 27;
  localparam int unsigned E_W = 28;
  localparam int unsigned A_W = 27;
  // Softness, and a margin: at most 2 8190 8236 + 2.
  localparam int unsigned SOFT_W = 14;
  localparam int unsigned MARGIN_W = 28;
  // The normal: 127 4095 in a product with D, 4063 across the ray; times corners.
  localparam int unsigned N_W = 8;
  localparam int unsigned ND_W = 20;
  localparam int unsigned ACROSS_W = 13;
  localparam int unsigned NC_W = 26;
  localparam int unsigned K_W = 27;
  // What reaches and heights add.
  localparam int unsigned OUT_W = 29;
  localparam int unsigned SIDE_W = 32;
  localparam int unsigned SWEEP_W = 30;
  localparam int unsigned ZSUM_W = 16;
  localparam int unsigned FAR_W = 16;
  localparam int unsigned PLACE_W = 40;
  localparam int unsigned NEAR_W = 16;
  if (lod_pkg::PRISM_TEST_LATENCY != 14) begin : g_illegal_latency
    $error("prism_test: lod_pkg::PRISM_TEST_LATENCY must be 14");
  end

  // What only waits: codes, and what is along the ray.
  localparam int unsigned CODES_W = 9 + 6 + 3 + 4;
  localparam int unsigned RAY_W = 10 + Z_W + 5 + RECIPROCAL_W + T_W + 1 + TAG_W;

  // Stage 1: corners times D; edges; the nearest and farthest corner.
  logic [2:0][L_W-1:0]     x, y, z, z_1;
  logic [D_W-1:0]          dx, dy, dz;
  logic [11:0][LD_W-1:0]   turned, turned_1;
  logic [5:0][EDGE_W-1:0]  edges, edges_1;
  logic [L_W-1:0]          low, high, low_1, high_1;
  logic [2:0]              down, up;
  logic                    open, valid_1, ready_1;
  logic [CODES_W-1:0]      codes, codes_1, codes_2, codes_3, codes_4, codes_5, codes_6, codes_7, codes_8, codes_9, codes_10, codes_11;
  logic [RAY_W-1:0]        ray, ray_1, ray_2, ray_3, ray_4, ray_5, ray_6;
  logic [3*D_W-1:0]        d_1, d_2, d_3, d_4, d_5;
  logic [25:0]             sides_1;
  logic [25:0]             softs_1;
  assign {dz, dy, dx} = in_i.frame.d;
  for (genvar k = 0; k < 3; k++) begin : g_corner
    logic signed [L_W-1:0]  at_x, at_y, at_z;
    logic signed [L_W+D_W:0] xz, zx, yz, zy;
    logic                    unused_signs;
    assign {x[k], y[k], z[k]}  = in_i.corners[k];
    assign {at_x, at_y, at_z}  = in_i.corners[k];
    assign xz = (L_W+D_W+1)'(at_x) * $signed((L_W+D_W+1)'(dz));
    assign zx = (L_W+D_W+1)'(at_z) * $signed((L_W+D_W+1)'(dx));
    assign yz = (L_W+D_W+1)'(at_y) * $signed((L_W+D_W+1)'(dz));
    assign zy = (L_W+D_W+1)'(at_z) * $signed((L_W+D_W+1)'(dy));
    assign turned[4*k +: 4] = {zy[LD_W-1:0], yz[LD_W-1:0], zx[LD_W-1:0], xz[LD_W-1:0]};
    assign unused_signs     = ^{xz[L_W+D_W:LD_W], zx[L_W+D_W:LD_W], yz[L_W+D_W:LD_W], zy[L_W+D_W:LD_W]};
  end
  // (p0, p1) and (p0, p2), x first.
  assign edges = {z[2] - z[0], y[2] - y[0], x[2] - x[0], z[1] - z[0], y[1] - y[0], x[1] - x[0]};
  logic signed [L_W-1:0] z0, z1, z2, lower, higher;
  assign {z0, z1, z2} = {z[0], z[1], z[2]};
  assign lower        = z0 < z1 ? z0 : z1;
  assign higher       = z0 < z1 ? z1 : z0;
  assign low          = lower < z2 ? lower : z2;
  assign high         = higher > z2 ? higher : z2;
  assign down         = in_i.frame.flipped ? in_i.planes[4] : in_i.planes[3];
  assign up           = in_i.frame.flipped ? in_i.planes[3] : in_i.planes[4];
  assign open         = in_i.frame.open || in_i.reach == '1;
  assign codes        = {in_i.planes[2], in_i.planes[1], in_i.planes[0], up, down, in_i.reach, in_i.height};
  assign ray          = {in_i.frame.soft_z, in_i.frame.z, in_i.frame.shift, in_i.frame.reciprocal,
                         in_i.t_max[lod_pkg::RAY_T_W-1:lod_pkg::T_NEAR_TO_T_SHIFT], open, tag_i};
  pipe_stage #(.W(12 * LD_W + 6 * EDGE_W + 5 * L_W + 3 * D_W + 26 + 26 + CODES_W + RAY_W)) u_1 (
    .clk_i, .rst_ni, .valid_i, .ready_o,
    .data_i({turned, edges, z, low, high, in_i.frame.d, in_i.frame.v, in_i.frame.u, in_i.frame.soft_v, in_i.frame.soft_u, codes, ray}),
    .valid_o(valid_1), .ready_i(ready_1), .data_o({turned_1, edges_1, z_1, low_1, high_1, d_1, sides_1, softs_1, codes_1, ray_1})
  );

  // Stage 2: corners across the ray; products of edges; how softness all is; corners from the nearest and the farthest.
  logic [2:0][2:0]        reaches_1;
  logic [2:0]             down_1, up_1, reach_1, tallest;
  logic [3:0]             height_1;
  logic [5:0][C_W-1:0]    c, c_2, c_3, c_4, c_5, c_6, c_7;
  logic [5:0][EE_W-1:0]   areas, areas_2;
  logic [5:0]             around, wide_reach, wide_height;
  logic [4:0]             all_reaches;
  logic [1:0][SOFT_W-1:0] softness, soft_2, soft_3, soft_4, soft_5, soft_6, soft_7;
  logic [5:0][L_W-1:0]    from_ends, from_ends_2;
  logic [L_W-1:0]         low_2, high_2;
  logic                   valid_2, ready_2;
  assign {reaches_1, up_1, down_1, reach_1, height_1} = codes_1;
  for (genvar i = 0; i < 6; i++) begin : g_across
    logic signed [LD_W:0]     difference, quarters;
    logic signed [LD_W-1:0]   plus, minus;
    logic signed [12:0]       side;
    logic                     unused_high;
    assign plus       = turned_1[2*i];
    assign minus      = turned_1[2*i+1];
    assign side       = sides_1[i%2*13 +: 13];
    assign difference = (LD_W+1)'(plus) - (LD_W+1)'(minus);
    assign quarters   = difference >>> 10;
    assign c[i]       = quarters[C_W-1:0] + C_W'(side);
    assign unused_high = ^quarters[LD_W:C_W];
  end
  for (genvar i = 0; i < 6; i++) begin : g_area
    // e1 f2, e2 f1, e2 f0, e0 f2, e0 f1, e1 f0.
    localparam int unsigned E = i == 0 || i == 5 ? 1 : i == 1 || i == 2 ? 2 : 0;
    localparam int unsigned F = i == 0 || i == 3 ? 2 : i == 1 || i == 4 ? 1 : 0;
    logic signed [EDGE_W-1:0]   e, f;
    logic signed [2*EDGE_W-1:0] product;
    logic                       unused_sign;
    assign {e, f}      = {edges_1[E], edges_1[3+F]};
    assign product     = (2*EDGE_W)'(e) * (2*EDGE_W)'(f);
    assign areas[i]    = product[EE_W-1:0];
    assign unused_sign = product[2*EDGE_W-1];
  end
  assign all_reaches = 5'(reaches_1[0]) + 5'(reaches_1[1]) + 5'(reaches_1[2]);
  assign tallest     = down_1 > up_1 ? down_1 : up_1;
  assign wide_reach  = ({1'b0, all_reaches} + {all_reaches, 1'b0}) >> (4'(reach_1) + 4'd1);
  assign wide_height = {2'd0, tallest, 1'b0} >> height_1;
  assign around      = 6'd4 + wide_reach + wide_height;
  for (genvar i = 0; i < 2; i++) begin : g_softness
    assign softness[i] = SOFT_W'(softs_1[i*13 +: 13]) + SOFT_W'(around);
  end
  for (genvar k = 0; k < 3; k++) begin : g_ends
    assign from_ends[k]   = low_1 - z_1[k];
    assign from_ends[3+k] = high_1 - z_1[k];
  end
  pipe_stage #(.W(6 * C_W + 6 * EE_W + 2 * SOFT_W + 8 * L_W + 3 * D_W + CODES_W + RAY_W)) u_2 (
    .clk_i, .rst_ni, .valid_i(valid_1), .ready_o(ready_1), .data_i({c, areas, softness, from_ends, low_1, high_1, d_1, codes_1, ray_1}),
    .valid_o(valid_2), .ready_i(ready_2), .data_o({c_2, areas_2, soft_2, from_ends_2, low_2, high_2, d_2, codes_2, ray_2})
  );

  // Stage 3: edges across the ray, products of corners, twice the triangle's area, how far reaches go along the ray.
  logic [2:0][2:0]         reaches_2;
  logic [12:0]             unused_codes_2;
  logic [5:0][C_W-1:0]     sides, sides_3;
  logic [5:0][CC_W-1:0]    products, products_3;
  logic [2:0][AREA_W-1:0]  area, area_3;
  logic [1:0][ZSUM_W-1:0]  zsum, zsum_3;
  logic [L_W-1:0]          low_3, high_3;
  logic                    valid_3, ready_3;
  assign {reaches_2, unused_codes_2} = codes_2;
  for (genvar m = 0; m < 3; m++) begin : g_edge
    localparam int unsigned A = (m + 1) % 3;
    localparam int unsigned B = (m + 2) % 3;
    logic signed [C_W-1:0]   au, av, bu, bv;
    logic signed [2*C_W-1:0] plus, minus;
    logic signed [EE_W-1:0]  p, q;
    logic                    unused_signs;
    assign {av, au, bv, bu}   = {c_2[2*A+1], c_2[2*A], c_2[2*B+1], c_2[2*B]};
    assign sides[2*m]         = bu - au;
    assign sides[2*m+1]       = bv - av;
    assign plus               = (2*C_W)'(au) * (2*C_W)'(bv);
    assign minus              = (2*C_W)'(av) * (2*C_W)'(bu);
    assign products[2*m +: 2] = {minus[CC_W-1:0], plus[CC_W-1:0]};
    assign {p, q}             = {areas_2[2*m], areas_2[2*m+1]};
    assign area[m]            = AREA_W'(p) - AREA_W'(q);
    assign unused_signs       = ^{plus[2*C_W-1], minus[2*C_W-1]};
  end
  for (genvar i = 0; i < 2; i++) begin : g_zsum
    logic signed [L_W-1:0] from0, from1, from2;
    assign {from2, from1, from0} = from_ends_2[3*i +: 3];
    assign zsum[i] = ZSUM_W'(from0) * ZSUM_W'(reaches_2[0]) + ZSUM_W'(from1) * ZSUM_W'(reaches_2[1]) + ZSUM_W'(from2) * ZSUM_W'(reaches_2[2]);
  end
  pipe_stage #(.W(6 * C_W + 6 * C_W + 6 * CC_W + 3 * AREA_W + 2 * ZSUM_W + 2 * L_W + 2 * SOFT_W + 3 * D_W + CODES_W + RAY_W)) u_3 (
    .clk_i, .rst_ni, .valid_i(valid_2), .ready_o(ready_2),
    .data_i({c_2, sides, products, area, zsum, low_2, high_2, soft_2, d_2, codes_2, ray_2}),
    .valid_o(valid_3), .ready_i(ready_3),
    .data_o({c_3, sides_3, products_3, area_3, zsum_3, low_3, high_3, soft_3, d_3, codes_3, ray_3})
  );

  // Stage 4: E; products of margins; magnitudes of the area and by how much it is shifted; ends along the ray.
  logic [2:0]              reach_3;
  logic [3:0]              unused_height_3;
  logic [14:0]             unused_codes_3;
  logic [2:0][E_W-1:0]     e, e_4, e_5, e_6, e_7, e_8, e_9, e_10, e_11;
  logic [5:0][CC_W-1:0]    edge_softs, edge_softs_4;
  logic [2:0]              negative, negative_4;
  logic [2:0][AREA_W-2:0]  magnitude, magnitude_4;
  logic [AREA_W-2:0]       any;
  logic [3:0]              shift, shift_4;
  logic [1:0][ZSUM_W-1:0]  ends, ends_4, ends_5, ends_6;
  logic                    valid_4, ready_4;
  assign {unused_codes_3, reach_3, unused_height_3} = codes_3;
  for (genvar m = 0; m < 3; m++) begin : g_e
    logic signed [CC_W-1:0]   plus, minus;
    logic [C_W-1:0]           side_u, side_v;
    logic [C_W-2:0]           u, v;
    logic [AREA_W-1:0]        turned_area;
    logic                     unused_bits;
    assign {minus, plus}        = products_3[2*m +: 2];
    assign e[m]                 = E_W'(plus) - E_W'(minus);
    assign side_u               = sides_3[2*m][C_W-1] ? -sides_3[2*m] : sides_3[2*m];
    assign side_v               = sides_3[2*m+1][C_W-1] ? -sides_3[2*m+1] : sides_3[2*m+1];
    assign {u, v}               = {side_u[C_W-2:0], side_v[C_W-2:0]};
    assign edge_softs[2*m +: 2] = {CC_W'(v) * CC_W'(soft_3[0]), CC_W'(u) * CC_W'(soft_3[1])};
    assign negative[m]          = area_3[m][AREA_W-1];
    assign turned_area          = negative[m] ? -area_3[m] : area_3[m];
    assign magnitude[m]         = turned_area[AREA_W-2:0];
    assign unused_bits          = ^{side_u[C_W-1], side_v[C_W-1], turned_area[AREA_W-1]};
  end
  always_comb begin
    any   = magnitude[0] | magnitude[1] | magnitude[2];
    shift = '0;
    for (int unsigned k = N_W; k < AREA_W; k++) if (any[k-1]) shift = 4'(k - (N_W - 1));
  end
  for (genvar i = 0; i < 2; i++) begin : g_end
    logic signed [ZSUM_W-1:0] sum, by;
    logic signed [L_W-1:0]    from;
    assign sum     = zsum_3[i];
    assign by      = sum >>> (4'(reach_3) + 4'd1);
    assign from    = i == 0 ? low_3 : high_3;
    assign ends[i] = ZSUM_W'(from) + by;
  end
  pipe_stage #(.W(6 * C_W + 3 * E_W + 6 * CC_W + 3 + 3 * (AREA_W - 1) + 4 + 2 * ZSUM_W + 2 * SOFT_W + 3 * D_W + CODES_W + RAY_W)) u_4 (
    .clk_i, .rst_ni, .valid_i(valid_3), .ready_o(ready_3),
    .data_i({c_3, e, edge_softs, negative, magnitude, shift, ends, soft_3, d_3, codes_3, ray_3}),
    .valid_o(valid_4), .ready_i(ready_4),
    .data_o({c_4, e_4, edge_softs_4, negative_4, magnitude_4, shift_4, ends_4, soft_4, d_4, codes_4, ray_4})
  );

  // Stage 5: A, the normal, margins.
  logic [A_W-1:0]           whole, whole_5, whole_6;
  logic [2:0][N_W-1:0]      n, n_5;
  logic [2:0][MARGIN_W-1:0] margin, margin_5, margin_6, margin_7;
  logic                     valid_5, ready_5;
  assign whole = e_4[0][A_W-1:0] + e_4[1][A_W-1:0] + e_4[2][A_W-1:0];
  for (genvar m = 0; m < 3; m++) begin : g_n
    logic [AREA_W-2:0] shifted;
    logic              unused_high;
    assign shifted     = magnitude_4[m] >> shift_4;
    assign n[m]        = negative_4[m] ? -shifted[N_W-1:0] : shifted[N_W-1:0];
    assign margin[m]   = MARGIN_W'(edge_softs_4[2*m]) + MARGIN_W'(edge_softs_4[2*m+1]) + MARGIN_W'(2);
    assign unused_high = ^shifted[AREA_W-2:N_W];
  end
  pipe_stage #(.W(6 * C_W + 3 * E_W + A_W + 3 * N_W + 3 * MARGIN_W + 2 * ZSUM_W + 2 * SOFT_W + 3 * D_W + CODES_W + RAY_W)) u_5 (
    .clk_i, .rst_ni, .valid_i(valid_4), .ready_o(ready_4), .data_i({c_4, e_4, whole, n, margin, ends_4, soft_4, d_4, codes_4, ray_4}),
    .valid_o(valid_5), .ready_i(ready_5), .data_o({c_5, e_5, whole_5, n_5, margin_5, ends_5, soft_5, d_5, codes_5, ray_5})
  );

  // Stage 6: the normal times D, reaches times A, heights along the ray.
  logic [2:0][2:0]          reaches_5;
  logic [2:0]               down_5, up_5, reach_5;
  logic [3:0]               height_5;
  logic [3:0][ND_W-1:0]     turned_n, turned_n_6;
  logic [2:0][OUT_W-1:0]    out, out_6;
  logic [1:0][12:0]         rise, rise_6;
  logic [D_W-1:0]           dx_5, dy_5, dz_5;
  logic                     valid_6, ready_6;
  assign {reaches_5, up_5, down_5, reach_5, height_5} = codes_5;
  assign {dz_5, dy_5, dx_5}                           = d_5;
  for (genvar k = 0; k < 4; k++) begin : g_turn
    logic signed [N_W-1:0]   of;
    logic signed [N_W+D_W:0] product;
    logic [D_W-1:0]          by;
    logic                    unused_sign;
    assign of          = k == 0 ? n_5[0] : k == 2 ? n_5[1] : n_5[2];
    assign by          = k == 1 ? dx_5 : k == 3 ? dy_5 : dz_5;
    assign product     = (N_W+D_W+1)'(of) * $signed((N_W+D_W+1)'(by));
    assign turned_n[k] = product[ND_W-1:0];
    assign unused_sign = product[N_W+D_W];
  end
  for (genvar m = 0; m < 3; m++) begin : g_out
    logic signed [A_W-1:0] of;
    logic signed [A_W+2:0] product, shifted;
    logic                  unused_sign;
    assign of          = whole_5;
    assign product     = (A_W+3)'(of) * $signed((A_W+3)'(reaches_5[m]));
    assign shifted     = product >>> (4'(reach_5) + 4'd1);
    assign out[m]      = shifted[OUT_W-1:0];
    assign unused_sign = shifted[A_W+2];
  end
  for (genvar i = 0; i < 2; i++) begin : g_rise
    logic signed [N_W-1:0] along;
    logic signed [12:0]    product, shifted;
    logic [2:0]            code;
    assign along   = n_5[2];
    assign code    = i == 0 ? down_5 : up_5;
    assign product = (13'(along) * $signed(13'(code))) <<< 2;
    assign shifted = (i == 0 ? -product : product) >>> height_5;
    assign rise[i] = shifted;
  end
  pipe_stage #(.W(6 * C_W + 3 * E_W + A_W + 4 * ND_W + 3 * OUT_W + 2 * 13 + 3 * MARGIN_W + 2 * ZSUM_W + 2 * SOFT_W + CODES_W + RAY_W)) u_6 (
    .clk_i, .rst_ni, .valid_i(valid_5), .ready_o(ready_5), .data_i({c_5, e_5, whole_5, turned_n, out, rise, margin_5, ends_5, soft_5, codes_5, ray_5}),
    .valid_o(valid_6), .ready_i(ready_6),
    .data_o({c_6, e_6, whole_6, turned_n_6, out_6, rise_6, margin_6, ends_6, soft_6, codes_6, ray_6})
  );

  // Stage 7: the normal across the ray; both ends of each side; ends along the ray.
  logic [1:0][ACROSS_W-1:0]     across, across_7;
  logic [2:0][SIDE_W-1:0]       near, near_7, far, far_7;
  logic [1:0][FAR_W-1:0]        reach_z, reach_z_7;
  logic [9:0]                   soft_z;
  logic signed [Z_W-1:0]        z_6, z_7;
  logic [4:0]                   shift_6, shift_7;
  logic [RECIPROCAL_W-1:0]      reciprocal_6, reciprocal_7, reciprocal_8;
  logic [T_W-1:0]               t_max_6, t_max_7, t_max_8, t_max_9, t_max_10;
  logic                         open_6, open_7, open_8, open_9, open_10, open_11, open_12, open_13;
  logic [TAG_W-1:0]             tag_6, tag_7, tag_8, tag_9, tag_10, tag_11, tag_12, tag_13;
  logic                         valid_7, ready_7;
  assign {soft_z, z_6, shift_6, reciprocal_6, t_max_6, open_6, tag_6} = ray_6;
  for (genvar i = 0; i < 2; i++) begin : g_n_across
    logic signed [ND_W-1:0] plus, minus;
    logic signed [ND_W:0]   difference, shifted;
    logic                   unused_high;
    assign {minus, plus} = {turned_n_6[2*i+1], turned_n_6[2*i]};
    assign difference    = (ND_W+1)'(plus) - (ND_W+1)'(minus);
    assign shifted       = difference >>> 8;
    assign across[i]     = shifted[ACROSS_W-1:0];
    assign unused_high   = ^shifted[ND_W:ACROSS_W];
  end
  for (genvar m = 0; m < 3; m++) begin : g_side
    logic signed [OUT_W-1:0] own, a, b;
    logic signed [A_W-1:0]   of;
    assign {own, a, b} = {out_6[m], out_6[(m+1)%3], out_6[(m+2)%3]};
    assign of          = whole_6;
    assign near[m]     = SIDE_W'(0) - SIDE_W'(own);
    assign far[m]      = SIDE_W'(of) + SIDE_W'(a) + SIDE_W'(b);
  end
  logic signed [12:0]      rise_down, rise_up, least_rise, most_rise;
  logic signed [ZSUM_W-1:0] low_end, high_end;
  assign {rise_up, rise_down} = rise_6;
  assign least_rise           = rise_down < rise_up ? rise_down : rise_up;
  assign most_rise            = rise_down < rise_up ? rise_up : rise_down;
  assign {high_end, low_end}  = ends_6;
  assign reach_z[0]           = low_end + FAR_W'(least_rise) - FAR_W'(soft_z);
  assign reach_z[1]           = high_end + FAR_W'(most_rise) + FAR_W'(soft_z) + FAR_W'(2);
  pipe_skid #(.W(6 * C_W + 3 * E_W + 2 * ACROSS_W + 6 * SIDE_W + 3 * MARGIN_W + 2 * SOFT_W + 2 * FAR_W + Z_W + 5 + RECIPROCAL_W + T_W + 1 + TAG_W + CODES_W)) u_7 (
    .clk_i, .rst_ni, .valid_i(valid_6), .ready_o(ready_6),
    .data_i({c_6, e_6, across, near, far, margin_6, soft_6, reach_z, z_6, shift_6, reciprocal_6, t_max_6, open_6, tag_6, codes_6}),
    .valid_o(valid_7), .ready_i(ready_7),
    .data_o({c_7, e_7, across_7, near_7, far_7, margin_7, soft_7, reach_z_7, z_7, shift_7, reciprocal_7, t_max_7, open_7, tag_7, codes_7})
  );

  // Stage 8: products of the normal; sides with their margins; the prism's place along the ray.
  logic [5:0][NC_W-1:0]     normals, normals_8;
  logic [1:0][NC_W-1:0]     normal_softs, normal_softs_8;
  logic [2:0][SIDE_W-1:0]   least, least_8, least_9, least_10, least_11, most, most_8, most_9, most_10, most_11;
  logic [NEAR_W-1:0]        near_z, near_z_8;
  logic                     ahead, ahead_8, ahead_9, ahead_10, ahead_11, ahead_12, valid_8, ready_8;
  logic signed [ACROSS_W-1:0] nu, nv;
  logic [ACROSS_W-1:0]      turned_nu, turned_nv;
  logic [ACROSS_W-2:0]      abs_nu, abs_nv;
  logic                     unused_n;
  assign {nv, nu}  = across_7;
  assign turned_nu = nu < 0 ? -nu : nu;
  assign turned_nv = nv < 0 ? -nv : nv;
  assign abs_nu    = turned_nu[ACROSS_W-2:0];
  assign abs_nv    = turned_nv[ACROSS_W-2:0];
  assign unused_n  = ^{turned_nu[ACROSS_W-1], turned_nv[ACROSS_W-1]};
  assign normal_softs = {NC_W'(abs_nv) * NC_W'(soft_7[0]), NC_W'(abs_nu) * NC_W'(soft_7[1])};
  for (genvar k = 0; k < 3; k++) begin : g_k
    logic signed [C_W-1:0]          u, v;
    logic signed [C_W+ACROSS_W-1:0] plus, minus;
    logic signed [SIDE_W-1:0]       one, other, lesser, larger;
    logic                           unused_signs;
    assign {v, u}            = {c_7[2*k+1], c_7[2*k]};
    assign plus              = (C_W+ACROSS_W)'(nu) * (C_W+ACROSS_W)'(v);
    assign minus             = (C_W+ACROSS_W)'(nv) * (C_W+ACROSS_W)'(u);
    assign normals[2*k +: 2] = {minus[NC_W-1:0], plus[NC_W-1:0]};
    assign {one, other}      = {near_7[k], far_7[k]};
    assign lesser            = one < other ? one : other;
    assign larger            = one < other ? other : one;
    assign least[k]          = lesser - SIDE_W'(margin_7[k]);
    assign most[k]           = larger + SIDE_W'(margin_7[k]);
    assign unused_signs      = ^{plus[C_W+ACROSS_W-1], minus[C_W+ACROSS_W-1]};
  end
  logic signed [PLACE_W-1:0] low_place, high_place;
  logic signed [FAR_W-1:0]   low_steps, high_steps;
  logic                      unused_place;
  assign {high_steps, low_steps} = reach_z_7;
  assign low_place    = PLACE_W'(z_7) + (PLACE_W'(low_steps) << shift_7);
  assign high_place   = PLACE_W'(z_7) + (PLACE_W'(high_steps) << shift_7);
  assign near_z       = low_place < 0 ? '0 : low_place[PLACE_W-1:lod_pkg::BOX_SHIFT+NEAR_W] != '0 ? '1 : low_place[lod_pkg::BOX_SHIFT +: NEAR_W];
  assign ahead        = !high_place[PLACE_W-1];
  assign unused_place = ^{low_place[lod_pkg::BOX_SHIFT-1:0], high_place[PLACE_W-2:0]};
  pipe_stage #(.W(3 * E_W + 6 * NC_W + 2 * NC_W + 6 * SIDE_W + NEAR_W + 1 + RECIPROCAL_W + T_W + 1 + TAG_W + CODES_W)) u_8 (
    .clk_i, .rst_ni, .valid_i(valid_7), .ready_o(ready_7),
    .data_i({e_7, normals, normal_softs, least, most, near_z, ahead, reciprocal_7, t_max_7, open_7, tag_7, codes_7}),
    .valid_o(valid_8), .ready_i(ready_8),
    .data_o({e_8, normals_8, normal_softs_8, least_8, most_8, near_z_8, ahead_8, reciprocal_8, t_max_8, open_8, tag_8, codes_8})
  );

  // Stage 9: K, the margin of the strip, the entry distance in a product.
  logic [2:0][K_W-1:0]              k, k_9, k_10;
  logic [K_W-1:0]                   strip, strip_9, strip_10, strip_11, strip_12;
  logic [NEAR_W+MANTISSA_W-1:0]     entry, entry_9;
  logic [MANTISSA_W-1:0]            mantissa;
  logic [4:0]                       right, right_9;
  logic                             valid_9, ready_9;
  assign {mantissa, right} = reciprocal_8;
  for (genvar i = 0; i < 3; i++) begin : g_cross
    logic signed [NC_W-1:0] plus, minus;
    assign {minus, plus} = normals_8[2*i +: 2];
    assign k[i]          = K_W'(plus) - K_W'(minus);
  end
  assign strip = K_W'(normal_softs_8[0]) + K_W'(normal_softs_8[1]);
  assign entry = (NEAR_W+MANTISSA_W)'(near_z_8) * (NEAR_W+MANTISSA_W)'(mantissa);
  pipe_stage #(.W(3 * E_W + 3 * K_W + K_W + 6 * SIDE_W + NEAR_W + MANTISSA_W + 5 + 1 + T_W + 1 + TAG_W + CODES_W)) u_9 (
    .clk_i, .rst_ni, .valid_i(valid_8), .ready_o(ready_8),
    .data_i({e_8, k, strip, least_8, most_8, entry, right, ahead_8, t_max_8, open_8, tag_8, codes_8}),
    .valid_o(valid_9), .ready_i(ready_9),
    .data_o({e_9, k_9, strip_9, least_9, most_9, entry_9, right_9, ahead_9, t_max_9, open_9, tag_9, codes_9})
  );

  // Stage 10: how the normal moves each side; the ends of the strip; the entry distance.
  logic [2:0][K_W-1:0]           by, by_10;
  logic [K_W-1:0]                lowest, lowest_10, lowest_11, lowest_12, highest, highest_10, highest_11, highest_12;
  logic [NEAR_W+MANTISSA_W-1:0]  shifted_entry;
  logic [T_W-1:0]                t, t_10, t_11, t_12, t_13;
  logic signed [K_W-1:0]         k0, k1, k2, lower_k, higher_k;
  logic                          valid_10, ready_10;
  assign {k0, k1, k2}  = {k_9[0], k_9[1], k_9[2]};
  assign by            = {k_9[1] - k_9[0], k_9[0] - k_9[2], k_9[2] - k_9[1]};
  assign lower_k       = k0 < k1 ? k0 : k1;
  assign higher_k      = k0 < k1 ? k1 : k0;
  assign lowest        = lower_k < k2 ? lower_k : k2;
  assign highest       = higher_k > k2 ? higher_k : k2;
  assign shifted_entry = entry_9 >> right_9;
  assign t             = shifted_entry[NEAR_W+MANTISSA_W-1:T_W] != '0 ? '1 : shifted_entry[T_W-1:0];
  pipe_stage #(.W(3 * E_W + 3 * K_W + 3 * K_W + 3 * K_W + 6 * SIDE_W + T_W + 1 + T_W + 1 + TAG_W + CODES_W)) u_10 (
    .clk_i, .rst_ni, .valid_i(valid_9), .ready_o(ready_9),
    .data_i({e_9, by, k_9, strip_9, lowest, highest, least_9, most_9, t, ahead_9, t_max_9, open_9, tag_9, codes_9}),
    .valid_o(valid_10), .ready_i(ready_10),
    .data_o({e_10, by_10, k_10, strip_10, lowest_10, highest_10, least_10, most_10, t_10, ahead_10, t_max_10, open_10, tag_10, codes_10})
  );

  // Stage 11: heights times that; corners from the ends of the strip; whether the prism begins before t_max.
  logic [2:0]                 down_10, up_10, unused_reach_10;
  logic [8:0]                 unused_reaches_10;
  logic [3:0]                 height_10;
  logic [5:0][SWEEP_W-1:0]    sweeps, sweeps_11;
  logic [5:0][K_W-1:0]        from_strip, from_strip_11;
  logic                       soon, soon_11, soon_12, valid_11, ready_11;
  assign {unused_reaches_10, up_10, down_10, unused_reach_10, height_10} = codes_10;
  for (genvar m = 0; m < 3; m++) begin : g_sweep
    logic signed [K_W-1:0]     of;
    logic signed [SWEEP_W-1:0] product_down, product_up, lowered, raised;
    assign of              = by_10[m];
    assign product_down    = SWEEP_W'(of) * $signed(SWEEP_W'(down_10));
    assign product_up      = SWEEP_W'(of) * $signed(SWEEP_W'(up_10));
    assign lowered         = -product_down >>> height_10;
    assign raised          = product_up >>> height_10;
    assign sweeps[2*m]     = lowered;
    assign sweeps[2*m+1]   = raised;
    assign from_strip[m]   = lowest_10 - k_10[m];
    assign from_strip[3+m] = highest_10 - k_10[m];
  end
  assign soon = t_10 <= t_max_10;
  pipe_stage #(.W(3 * E_W + 6 * SWEEP_W + 6 * K_W + 3 * K_W + 6 * SIDE_W + T_W + 1 + 1 + 1 + TAG_W + CODES_W)) u_11 (
    .clk_i, .rst_ni, .valid_i(valid_10), .ready_o(ready_10),
    .data_i({e_10, sweeps, from_strip, strip_10, lowest_10, highest_10, least_10, most_10, t_10, ahead_10, soon, open_10, tag_10, codes_10}),
    .valid_o(valid_11), .ready_i(ready_11),
    .data_o({e_11, sweeps_11, from_strip_11, strip_11, lowest_11, highest_11, least_11, most_11, t_11, ahead_11, soon_11, open_11, tag_11, codes_11})
  );

  // Stage 12: E against its sides; how far reaches let the strip out.
  logic [2:0][2:0]           reaches_11;
  logic [5:0]                unused_heights_11;
  logic [3:0]                unused_height_11;
  logic [2:0]                reach_11, reach_12;
  logic [5:0]                fits, fits_12;
  logic [1:0][SIDE_W-1:0]    let_out, let_out_12;
  logic                      valid_12, ready_12;
  assign {reaches_11, unused_heights_11, reach_11, unused_height_11} = codes_11;
  for (genvar m = 0; m < 3; m++) begin : g_fits
    logic signed [SWEEP_W-1:0] one, other, lesser, larger;
    logic signed [E_W-1:0]     of;
    logic signed [SIDE_W-1:0]  from, to;
    logic signed [SIDE_W:0]    highest_e, lowest_e;
    assign {other, one}       = sweeps_11[2*m +: 2];
    assign lesser             = one < other ? one : other;
    assign larger             = one < other ? other : one;
    assign {of, from, to}     = {e_11[m], least_11[m], most_11[m]};
    assign highest_e          = (SIDE_W+1)'(of) + (SIDE_W+1)'(larger);
    assign lowest_e           = (SIDE_W+1)'(of) + (SIDE_W+1)'(lesser);
    assign fits[2*m +: 2]   = {lowest_e <= (SIDE_W+1)'(to), highest_e >= (SIDE_W+1)'(from)};
  end
  for (genvar i = 0; i < 2; i++) begin : g_let_out
    logic signed [K_W-1:0] from0, from1, from2;
    assign {from2, from1, from0} = from_strip_11[3*i +: 3];
    assign let_out[i] = SIDE_W'(from0) * SIDE_W'(reaches_11[0]) + SIDE_W'(from1) * SIDE_W'(reaches_11[1]) + SIDE_W'(from2) * SIDE_W'(reaches_11[2]);
  end
  pipe_stage #(.W(6 + 2 * SIDE_W + 3 * K_W + 3 + T_W + 1 + 1 + 1 + TAG_W)) u_12 (
    .clk_i, .rst_ni, .valid_i(valid_11), .ready_o(ready_11),
    .data_i({fits, let_out, strip_11, lowest_11, highest_11, reach_11, t_11, ahead_11, soon_11, open_11, tag_11}),
    .valid_o(valid_12), .ready_i(ready_12),
    .data_o({fits_12, let_out_12, strip_12, lowest_12, highest_12, reach_12, t_12, ahead_12, soon_12, open_12, tag_12})
  );

  // Stage 13: the strip.
  logic                     meets, meets_13, valid_13, ready_13;
  logic signed [SIDE_W-1:0] low_sum, high_sum, low_by, high_by, from_low, from_high;
  logic signed [K_W-1:0]    low_k, high_k;
  logic signed [SIDE_W-1:0] strip_margin;
  assign {high_sum, low_sum} = let_out_12;
  assign {low_k, high_k}     = {lowest_12, highest_12};
  assign strip_margin        = SIDE_W'(strip_12);
  assign low_by              = low_sum >>> (4'(reach_12) + 4'd1);
  assign high_by             = high_sum >>> (4'(reach_12) + 4'd1);
  assign from_low            = SIDE_W'(low_k) + low_by;
  assign from_high           = SIDE_W'(high_k) + high_by;
  assign meets              = fits_12 == '1 && ahead_12 && soon_12 && from_low <= strip_margin && from_high >= -strip_margin;
  pipe_skid #(.W(1 + T_W + 1 + TAG_W)) u_13 (
    .clk_i, .rst_ni, .valid_i(valid_12), .ready_o(ready_12), .data_i({meets, t_12, open_12, tag_12}),
    .valid_o(valid_13), .ready_i(ready_13), .data_o({meets_13, t_13, open_13, tag_13})
  );

  // Stage 14: what is not bounded is met at once.
  logic           hit;
  logic [T_W-1:0] t_near;
  assign hit    = meets_13 || open_13;
  assign t_near = meets_13 && !open_13 ? t_13 : '0;
  pipe_stage #(.W(1 + T_W + TAG_W)) u_out (
    .clk_i, .rst_ni, .valid_i(valid_13), .ready_o(ready_13), .data_i({hit, t_near, tag_13}),
    .valid_o, .ready_i, .data_o({out_o, tag_o})
  );

  logic unused;
  assign unused = ^{in_i.t_max[lod_pkg::T_NEAR_TO_T_SHIFT-1:0], unused_codes_2, unused_codes_3, unused_height_3, unused_reaches_10, unused_reach_10,
                    unused_heights_11, unused_height_11};

endmodule

`default_nettype wire
