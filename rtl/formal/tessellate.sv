`default_nettype none

/// The inserted vertices. Coordinates in units; a vertex of grid g has its low g bits zero.

/// One vertex at full resolution, full width: midpoints are exact, it is the stored one or its displacement from the midpoint of the full-resolution edge, and nothing
/// overflows.
module morph_full (
  input logic                        clk_i,
  input logic                        rst_ni,
  input logic                        compact_i,
  input logic [4:0]                  shift_i,
  input logic [lod_pkg::POINT_W-1:0] fa_i,
  input logic [lod_pkg::POINT_W-1:0] fb_i,
  input logic [lod_pkg::POINT_W-1:0] v_i,
  input logic [3:0]                  grid_i
);

  localparam logic signed [39:0] LIMIT = 40'sh00_7ffe_0000;

  logic [lod_pkg::POINT_W-1:0] full;
  logic                        valid, ready;
  morph_vertex u_morph (
    .clk_i, .rst_ni, .valid_i(1'b1), .ready_o(ready), .compact_i, .shift_i, .grid_i, .s_i('0), .fa_i, .fb_i, .pa_i('0), .pb_i('0), .v_i,
    .valid_o(valid), .ready_i(1'b1), .full_o(full), .morphed_o()
  );

  logic [31:0] corner_grid, vertex_grid;
  assign vertex_grid = (32'd1 << grid_i) - 32'd1;
  assign corner_grid = {vertex_grid[30:0], 1'b1};

  logic [2:0] legal, middle, exact;
  for (genvar k = 0; k < 3; k++) begin : g_coordinate
    logic signed [31:0] a, b, v, got;
    logic signed [32:0] sum;
    // With room for displacements of 13 bits, shifted by 21.
    logic signed [39:0] wide_a, wide_b, half_sum, g;
    assign {a, b}           = {fa_i[32*k +: 32], fb_i[32*k +: 32]};
    assign {v, got}         = {v_i[32*k +: 32], full[32*k +: 32]};
    assign {wide_a, wide_b} = {40'(a), 40'(b)};
    assign sum              = 33'(a) + 33'(b);
    assign half_sum         = 40'(sum) >>> 1;
    assign g                = compact_i ? half_sum + (40'(v) <<< shift_i) : 40'(v);
    assign legal[k] = ((a | b) & corner_grid) == '0 && wide_a <= LIMIT && wide_a >= -LIMIT && wide_b <= LIMIT && wide_b >= -LIMIT
      && (!compact_i || (v >= -32'sd4096 && v <= 32'sd4095)) && g <= LIMIT && g >= -LIMIT;
    // Parity: the midpoint of two corners is whole, and on the grid of the vertex.
    assign middle[k] = !sum[0] && (half_sum[31:0] & vertex_grid) == '0;
    assign exact[k]  = 40'(got) == g;
  end

  always_comb begin
    assume (shift_i <= 5'd21);
    assume (legal == '1);
    assert (middle == '1);
    assert (exact == '1);
    assert (valid && ready);
    cover (compact_i && shift_i == 5'd21 && v_i[31:0] == 32'hffff_f830 && full[31:0] == 32'h8002_0000);
    cover (!compact_i && v_i[31:0] == 32'h7ffe_0000 && fa_i[31:0] == 32'h8002_0000 && fb_i[31:0] == 32'h8002_0000);
  end

endmodule

/// One morphed vertex, full width, with the vertex at full resolution free: it lies between the midpoint of the morphed edge and that, on the grid, and nothing overflows.
module morph_between (
  input logic                             clk_i,
  input logic                             rst_ni,
  input logic [lod_pkg::POINT_W-1:0]      pa_i,
  input logic [lod_pkg::POINT_W-1:0]      pb_i,
  input logic [lod_pkg::EDGE_STATE_W-1:0] s_i,
  input logic [3:0]                       grid_i
);

  logic [lod_pkg::POINT_W-1:0] full, morphed;
  logic                        valid, ready;
  morph_vertex u_morph (
    .clk_i, .rst_ni, .valid_i(1'b1), .ready_o(ready), .compact_i(1'b0), .shift_i('0), .grid_i, .s_i, .fa_i('0), .fb_i('0), .pa_i, .pb_i, .v_i('0),
    .valid_o(valid), .ready_i(1'b1), .full_o(full), .morphed_o(morphed)
  );

  logic [31:0] corner_grid, vertex_grid;
  assign vertex_grid = (32'd1 << grid_i) - 32'd1;
  assign corner_grid = {vertex_grid[30:0], 1'b1};

  logic [2:0] legal, between, ends, further;
  for (genvar k = 0; k < 3; k++) begin : g_coordinate
    logic signed [31:0] a, b, g, q, m, low, high;
    logic signed [32:0] sum;
    assign {a, b, g, q} = {pa_i[32*k +: 32], pb_i[32*k +: 32], full[32*k +: 32], morphed[32*k +: 32]};
    assign sum          = 33'(a) + 33'(b);
    assign m            = sum[32:1];
    assign low          = m < g ? m : g;
    assign high         = m < g ? g : m;
    assign legal[k]     = (a & corner_grid) == '0 && (b & corner_grid) == '0 && (g & vertex_grid) == '0;
    assign between[k]   = low <= q && q <= high && (q & vertex_grid) == '0;
    assign ends[k]      = (s_i != '0 || q == m) && (s_i != lod_pkg::EDGE_STATE_W'(lod_pkg::S_ONE) || q == g);
    assign further[k]   = q != m && q != g;
  end

  for (genvar k = 0; k < 3; k++) begin : g_proved
    always_comb begin
      assert (between[k]);
      assert (ends[k]);
    end
  end
  always_comb begin
    assume (s_i <= lod_pkg::EDGE_STATE_W'(lod_pkg::S_ONE));
    assume (legal == '1);
    assert (valid && ready);
    cover (grid_i == 4'd9 && s_i == 9'd128 && further == '1 && full[31]);
    cover (grid_i == 4'd0 && pa_i[31:0] == 32'h8002_0000 && pb_i[31:0] == 32'h8002_0000 && full[31:0] == 32'h7ffe_0000 && s_i == 9'd255);
  end

endmodule

/// The steps of a displacement: 2^e units, e = max(grid + padding, floor((code + offset) / 16) - 11), from the midpoint of the edge's own ends.
module tessellate_displacement (
  input logic                    clk_i,
  input logic                    rst_ni,
  input lod_pkg::tessellate_in_t in_i,
  input logic [7:0]              tag_i
);

  localparam int unsigned P_W = lod_pkg::POINT_W;

  lod_pkg::tessellate_out_t out;
  logic [7:0]               tag;
  logic                     valid, ready;
  tessellate u_tessellate (.clk_i, .rst_ni, .valid_i(1'b1), .ready_o(ready), .in_i, .tag_i, .valid_o(valid), .ready_i(1'b1), .out_o(out), .tag_o(tag));

  logic [2:0][P_W-1:0] f, v, g;
  logic [2:0][7:0]     code;
  assign f    = {in_i.f2, in_i.f1, in_i.f0};
  assign v    = {in_i.v2, in_i.v1, in_i.v0};
  assign g    = {out.g2, out.g1, out.g0};
  assign code = {in_i.e2, in_i.e1, in_i.e0};

  logic [8:0] exact, short;
  logic [2:0] coarser;
  for (genvar i = 0; i < 3; i++) begin : g_vertex
    logic signed [15:0] octave, zero, e;
    assign octave     = (16'(code[i]) + 16'(in_i.scale.offset)) >> 4;
    assign zero       = 16'(in_i.grid) + 16'(in_i.padding);
    assign e          = octave - 16'sd11 > zero ? octave - 16'sd11 : zero;
    assign coarser[i] = e > zero;
    for (genvar k = 0; k < 3; k++) begin : g_coordinate
      logic signed [31:0] a, b, d;
      logic signed [32:0] sum;
      assign a   = f[(i+1)%3][32*k +: 32];
      assign b   = f[(i+2)%3][32*k +: 32];
      assign d   = v[i][32*k +: 32];
      assign sum = 33'(a) + 33'(b);
      assign short[3*i+k] = d >= -32'sd4096 && d <= 32'sd4095;
      assign exact[3*i+k] = g[i][32*k +: 32] == (in_i.compact ? sum[32:1] + (d << e[4:0]) : d);
    end
  end

  always_comb begin
    assume (in_i.scale.offset <= 9'd272 && in_i.padding <= 3'd4);
    assume (!in_i.compact || short == '1);
    assert (exact == '1);
    assert (tag == tag_i && valid && ready);
    cover (in_i.compact && coarser == 3'b101 && in_i.grid == 4'd9 && in_i.padding == 3'd4);
    cover (in_i.compact && coarser == '0 && in_i.grid == 4'd0 && in_i.e1 == '1);
  end

endmodule

/// One edge in six triangles, at each place and from either end, in either form: whatever their other corners, vertices, codes and states are, the vertex on that
/// edge is the same, at full resolution and as morphed.
module tessellate_shared (
  input logic                                  clk_i,
  input logic                                  rst_ni,
  input logic                                  compact_i,
  input logic [3:0]                            grid_i,
  input logic [2:0]                            padding_i,
  input lod_pkg::bound_scale_t                 scale_i,
  input lod_pkg::point_t                       full_a_i,
  input lod_pkg::point_t                       full_b_i,
  input lod_pkg::point_t                       a_i,
  input lod_pkg::point_t                       b_i,
  input lod_pkg::point_t                       v_i,
  input logic [lod_pkg::BOUND_CODE_W-1:0]      code_i,
  input logic [lod_pkg::EDGE_STATE_W-1:0]      s_i,
  // What the six do not share: their third corner in both forms, other vertices, codes and states.
  input logic [6*4*lod_pkg::POINT_W-1:0]       points_i,
  input logic [6*2*lod_pkg::BOUND_CODE_W-1:0]  codes_i,
  input logic [6*2*lod_pkg::EDGE_STATE_W-1:0]  states_i
);

  localparam int unsigned P_W = lod_pkg::POINT_W;
  localparam int unsigned C_W = lod_pkg::BOUND_CODE_W;
  localparam int unsigned S_W = lod_pkg::EDGE_STATE_W;

  logic [6*2*P_W-1:0] vertex;
  for (genvar k = 0; k < 6; k++) begin : g_triangle
    localparam int unsigned PLACE = k % 3;
    logic [P_W-1:0] full_first, full_second, first, second, full_c, c, v1, v2;
    logic [C_W-1:0] e1, e2;
    logic [S_W-1:0] s1, s2;
    assign {full_first, full_second} = k < 3 ? {full_a_i, full_b_i} : {full_b_i, full_a_i};
    assign {first, second}           = k < 3 ? {a_i, b_i} : {b_i, a_i};
    assign {full_c, c, v1, v2}       = points_i[k*4*P_W +: 4*P_W];
    assign {e1, e2}                  = codes_i[k*2*C_W +: 2*C_W];
    assign {s1, s2}                  = states_i[k*2*S_W +: 2*S_W];

    lod_pkg::tessellate_in_t  in;
    lod_pkg::tessellate_out_t out;
    if (PLACE == 0) begin : g_0
      assign in = {compact_i, grid_i, padding_i, scale_i, code_i, e1, e2, s_i, s1, s2, full_c, full_first, full_second, c, first, second, v_i, v1, v2};
      assign vertex[k*2*P_W +: 2*P_W] = {out.g0, out.q0};
    end else if (PLACE == 1) begin : g_1
      assign in = {compact_i, grid_i, padding_i, scale_i, e1, code_i, e2, s1, s_i, s2, full_second, full_c, full_first, second, c, first, v1, v_i, v2};
      assign vertex[k*2*P_W +: 2*P_W] = {out.g1, out.q1};
    end else begin : g_2
      assign in = {compact_i, grid_i, padding_i, scale_i, e1, e2, code_i, s1, s2, s_i, full_first, full_second, full_c, first, second, c, v1, v2, v_i};
      assign vertex[k*2*P_W +: 2*P_W] = {out.g2, out.q2};
    end
    tessellate #(.TAG_W(1)) u_tessellate (
      .clk_i, .rst_ni, .valid_i(1'b1), .ready_o(), .in_i(in), .tag_i(1'b0), .valid_o(), .ready_i(1'b1), .out_o(out), .tag_o()
    );
  end

  always_comb begin
    for (int unsigned k = 1; k < 6; k++) assert (vertex[k*2*P_W +: 2*P_W] == vertex[0 +: 2*P_W]);
    cover (s_i == 9'd77 && compact_i && vertex[P_W-1:0] != vertex[P_W +: P_W]);
    cover (s_i == 9'd77 && !compact_i && vertex[P_W-1:0] != v_i);
  end

endmodule

`default_nettype wire
