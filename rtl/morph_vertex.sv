`default_nettype none

/// An inserted vertex at full resolution, and morphed between the midpoint of its morphed edge and there (paper section 3.4). Coordinate by coordinate:
///
/// full: g = v, or for a displacement (fa + fb) / 2 + v 2^shift; morphed: m + (floor((g - m) s / 256) with its low `grid` bits cleared), m = (pa + pb) / 2. Midpoints
/// are exact. s = 0 gives m, s = 256 gives g; the result lies between m and g. Legal: ends multiples of 2^(grid+1), g of 2^grid, none beyond 0x7FFE_0000 in
/// magnitude, grid 0 to 15, s 0 to 256, displacements of 13 bits. Latency TESSELLATE_LATENCY; interval 1.
module morph_vertex (
  input  logic                             clk_i,
  input  logic                             rst_ni,
  input  logic                             valid_i,
  output logic                             ready_o,
  input  logic                             compact_i,
  input  logic [4:0]                       shift_i,
  input  logic [3:0]                       grid_i,
  input  logic [lod_pkg::EDGE_STATE_W-1:0] s_i,
  input  logic [lod_pkg::KEPT_POINT_W-1:0] fa_i,
  input  logic [lod_pkg::KEPT_POINT_W-1:0] fb_i,
  input  logic [lod_pkg::KEPT_POINT_W-1:0] pa_i,
  input  logic [lod_pkg::KEPT_POINT_W-1:0] pb_i,
  input  logic [lod_pkg::POINT_W-1:0]      v_i,
  output logic                             valid_o,
  input  logic                             ready_i,
  output logic [lod_pkg::KEPT_POINT_W-1:0] full_o,
  output logic [lod_pkg::KEPT_POINT_W-1:0] morphed_o
);

  localparam int unsigned V_W = lod_pkg::POINT_W / 3;
  localparam int unsigned W = lod_pkg::COORDINATE_W;
  localparam int unsigned ZEROS = lod_pkg::COORDINATE_ZEROS;
  localparam int unsigned STEPS_W = lod_pkg::DISPLACEMENT_W / 3;
  localparam int unsigned SHIFT_W = 5;
  localparam int unsigned GRID_W = 4;
  localparam int unsigned MOST_GRID = 15;
  localparam int unsigned DIFFERENCE_W = W + 1;
  // s is unsigned: one bit more as a signed number.
  localparam int unsigned STATE_W = lod_pkg::EDGE_STATE_W;
  localparam int unsigned S_W = STATE_W + 1;
  localparam int unsigned PRODUCT_W = DIFFERENCE_W + S_W;
  localparam int unsigned PRODUCT_LATENCY = lod_pkg::multiplier_latency(DIFFERENCE_W, S_W);
  localparam int unsigned FRACTION_W = 8;
  // Where nothing is morphed the vertex is all there is.
  localparam bit MORPHING = lod_pkg::LOD_TEST != 0;
  localparam int unsigned LATENCY = MORPHING ? PRODUCT_LATENCY + 5 : 2;
  if (lod_pkg::TESSELLATE_LATENCY != LATENCY) begin : g_illegal_latency
    $error("morph_vertex: lod_pkg::TESSELLATE_LATENCY must be %0d", LATENCY);
  end

  // Midpoint: a 33-bit sum, even, so exact in 32 bits again. A vertex that is stored itself takes the place of the midpoint, without a displacement.
  logic [2:0][V_W-1:0]     v;
  logic [2:0][W-1:0]       base, base_q;
  logic [2:0][STEPS_W-1:0] steps, steps_q;
  logic [SHIFT_W-1:0]      shift_q;
  logic                    valid_m, ready_m;
  assign v = v_i;
  for (genvar k = 0; k < 3; k++) begin : g_midpoint
    logic signed [W-1:0] fa, fb;
    logic [W:0]          sum;
    logic                unused_even;
    assign {fa, fb}    = {fa_i[k*W +: W], fb_i[k*W +: W]};
    assign sum         = (W+1)'(fa) + (W+1)'(fb);
    assign base[k]     = compact_i ? sum[W:1] : W'(v[k] >> ZEROS);
    assign steps[k]    = compact_i ? v[k][STEPS_W-1:0] : '0;
    assign unused_even = sum[0];
  end

  // g: 32 bits for legal displacements.
  logic [2:0][W-1:0] g;
  for (genvar k = 0; k < 3; k++) begin : g_full
    logic signed [STEPS_W-1:0] displacement;
    assign displacement = steps_q[k];
    // Steps have all the zeros that are left out.
    assign g[k]         = base_q[k] + (W'(displacement) << (shift_q - SHIFT_W'(ZEROS)));
  end

  if (MORPHING) begin : g_morph
    // The midpoint of the edge as morphed goes along. Flat: Yosys loses the width of packed arrays inside a generate block.
    logic [3*W-1:0]     m, m_q, g_q, m_g;
    logic [GRID_W-1:0]  grid_m, grid_g;
    logic [STATE_W-1:0] s_m, s_g;
    logic               valid_g, ready_g;
    for (genvar k = 0; k < 3; k++) begin : g_between
      logic signed [W-1:0] pa, pb;
      logic [W:0]          sum;
      logic                unused_even;
      assign {pa, pb}    = {pa_i[k*W +: W], pb_i[k*W +: W]};
      assign sum         = (W+1)'(pa) + (W+1)'(pb);
      assign m[k*W +: W] = sum[W:1];
      assign unused_even = sum[0];
    end
    pipe_stage #(.W(3 * (2 * W + STEPS_W) + SHIFT_W + STATE_W + GRID_W)) u_midpoint (
      .clk_i, .rst_ni, .valid_i, .ready_o, .data_i({base, steps, m, shift_i, s_i, grid_i}),
      .valid_o(valid_m), .ready_i(ready_m), .data_o({base_q, steps_q, m_q, shift_q, s_m, grid_m})
    );
    pipe_stage #(.W(6 * W + STATE_W + GRID_W)) u_full (
      .clk_i, .rst_ni, .valid_i(valid_m), .ready_o(ready_m), .data_i({g, m_q, s_m, grid_m}),
      .valid_o(valid_g), .ready_i(ready_g), .data_o({g_q, m_g, s_g, grid_g})
    );

    // g - m: 33 bits.
    logic [3*DIFFERENCE_W-1:0] difference, difference_q;
    logic [3*W-1:0]            g_d, m_d;
    logic [GRID_W-1:0]         grid_d;
    logic [STATE_W-1:0]        s_d;
    logic                      valid_d, ready_d;
    for (genvar k = 0; k < 3; k++) begin : g_difference
      logic signed [W-1:0] to, from;
      assign {to, from} = {g_q[k*W +: W], m_g[k*W +: W]};
      assign difference[k*DIFFERENCE_W +: DIFFERENCE_W] = DIFFERENCE_W'(to) - DIFFERENCE_W'(from);
    end
    pipe_stage #(.W(3 * DIFFERENCE_W + 6 * W + STATE_W + GRID_W)) u_difference (
      .clk_i, .rst_ni, .valid_i(valid_g), .ready_o(ready_g), .data_i({difference, g_q, m_g, s_g, grid_g}),
      .valid_o(valid_d), .ready_i(ready_d), .data_o({difference_q, g_d, m_d, s_d, grid_d})
    );

    // (g - m) s: 33 bits times 9. The step, on the grid.
    logic [2:0]        valid_product, ready_product;
    logic [3*W-1:0]    step, step_q, g_p, m_p, g_s, m_s, morphed;
    logic [GRID_W-1:0] grid_p;
    logic              valid_p, ready_p, valid_s, ready_s;
    pipe_delay #(.W(6 * W + GRID_W), .STAGES(PRODUCT_LATENCY)) u_beside (
      .clk_i, .rst_ni, .valid_i(valid_d), .ready_o(ready_d), .data_i({g_d, m_d, grid_d}),
      .valid_o(valid_p), .ready_i(ready_p), .data_o({g_p, m_p, grid_p})
    );
    for (genvar k = 0; k < 3; k++) begin : g_step
      logic [PRODUCT_W-1:0] product;
      logic [W-1:0]         on_grid;
      logic                 unused_bits;
      multiplier #(.A_W(DIFFERENCE_W), .B_W(S_W)) u_product (
        .clk_i, .rst_ni, .valid_i(valid_d), .ready_o(ready_product[k]), .a_i(difference_q[k*DIFFERENCE_W +: DIFFERENCE_W]), .b_i({1'b0, s_d}),
        .valid_o(valid_product[k]), .ready_i(ready_p), .product_o(product)
      );
      always_comb begin
        on_grid = product[FRACTION_W +: W];
        for (int unsigned i = 0; i < MOST_GRID - ZEROS; i++) begin
          if (grid_p > GRID_W'(i + ZEROS)) on_grid[i] = 1'b0;
        end
      end
      assign step[k*W +: W] = on_grid;
      assign unused_bits    = ^{product[PRODUCT_W-1:FRACTION_W+W], product[FRACTION_W-1:0]};
    end
    pipe_stage #(.W(9 * W)) u_step (
      .clk_i, .rst_ni, .valid_i(valid_p), .ready_o(ready_p), .data_i({step, g_p, m_p}),
      .valid_o(valid_s), .ready_i(ready_s), .data_o({step_q, g_s, m_s})
    );

    // It and m add up to 32 bits again, between m and g.
    for (genvar k = 0; k < 3; k++) begin : g_morphed
      assign morphed[k*W +: W] = m_s[k*W +: W] + step_q[k*W +: W];
    end
    pipe_stage #(.W(6 * W)) u_out (
      .clk_i, .rst_ni, .valid_i(valid_s), .ready_o(ready_s), .data_i({g_s, morphed}), .valid_o, .ready_i, .data_o({full_o, morphed_o})
    );

    logic unused_lockstep;
    assign unused_lockstep = ^{valid_product, ready_product};
  end else begin : g_no_morph
    logic unused_morph;
    pipe_stage #(.W(3 * (W + STEPS_W) + SHIFT_W)) u_midpoint (
      .clk_i, .rst_ni, .valid_i, .ready_o, .data_i({base, steps, shift_i}),
      .valid_o(valid_m), .ready_i(ready_m), .data_o({base_q, steps_q, shift_q})
    );
    pipe_stage #(.W(3 * W)) u_full (
      .clk_i, .rst_ni, .valid_i(valid_m), .ready_o(ready_m), .data_i(g), .valid_o, .ready_i, .data_o(full_o)
    );
    assign morphed_o    = full_o;
    assign unused_morph = ^{grid_i, s_i, pa_i, pb_i};
  end

endmodule

`default_nettype wire
