`default_nettype none

/// One coordinate of an inserted vertex, morphed between edge midpoint and stored position (paper section 3.4).
///
/// m = (a + b) / 2, exact; result m + (floor((q - m) s / 256) with its low `grid` bits cleared). s = 0 gives m, s = 256 gives q; the result lies between
/// m and q. Legal: a and b multiples of 2^(grid+1), q of 2^grid, grid 0 to 9, s 0 to 256. Latency TESSELLATE_LATENCY; interval 1.
module morph_coordinate (
  input  logic                             clk_i,
  input  logic                             rst_ni,
  input  logic                             valid_i,
  output logic                             ready_o,
  input  logic [31:0]                      a_i,
  input  logic [31:0]                      b_i,
  input  logic [31:0]                      q_i,
  input  logic [lod_pkg::EDGE_STATE_W-1:0] s_i,
  input  logic [3:0]                       grid_i,
  output logic                             valid_o,
  input  logic                             ready_i,
  output logic [31:0]                      morphed_o
);

  localparam int unsigned W = 32;
  localparam int unsigned DIFFERENCE_W = W + 1;
  // s is unsigned: one bit more as a signed number.
  localparam int unsigned S_W = lod_pkg::EDGE_STATE_W + 1;
  localparam int unsigned PRODUCT_W = DIFFERENCE_W + S_W;
  localparam int unsigned PRODUCT_LATENCY = lod_pkg::multiplier_latency(DIFFERENCE_W, S_W);
  localparam int unsigned FRACTION_W = 8;
  if (lod_pkg::TESSELLATE_LATENCY != PRODUCT_LATENCY + 4) begin : g_illegal_latency
    $error("morph_coordinate: lod_pkg::TESSELLATE_LATENCY must be %0d", PRODUCT_LATENCY + 4);
  end

  // Midpoint: a 33-bit sum, even, so exact in 32 bits again.
  logic signed [W-1:0]     a, b, q;
  logic [W:0]              sum;
  logic                    valid_m, ready_m, unused_even;
  logic [W-1:0]            m_q, q_m;
  logic [S_W-2:0]          s_m;
  logic [3:0]              grid_m;
  assign {a, b}      = {a_i, b_i};
  assign sum         = (W+1)'(a) + (W+1)'(b);
  assign unused_even = sum[0];
  pipe_stage #(.W(2 * W + S_W - 1 + 4)) u_midpoint (
    .clk_i, .rst_ni, .valid_i, .ready_o, .data_i({sum[W:1], q_i, s_i, grid_i}),
    .valid_o(valid_m), .ready_i(ready_m), .data_o({m_q, q_m, s_m, grid_m})
  );

  // q - m: 33 bits.
  logic signed [W-1:0]     m;
  logic [DIFFERENCE_W-1:0] difference, difference_q;
  logic                    valid_d, ready_d;
  logic [W-1:0]            m_d;
  logic [S_W-2:0]          s_d;
  logic [3:0]              grid_d;
  assign {m, q}     = {m_q, q_m};
  assign difference = DIFFERENCE_W'(q) - DIFFERENCE_W'(m);
  pipe_stage #(.W(DIFFERENCE_W + W + S_W - 1 + 4)) u_difference (
    .clk_i, .rst_ni, .valid_i(valid_m), .ready_o(ready_m), .data_i({difference, m_q, s_m, grid_m}),
    .valid_o(valid_d), .ready_i(ready_d), .data_o({difference_q, m_d, s_d, grid_d})
  );

  // (q - m) s: 33 bits times 9.
  logic [PRODUCT_W-1:0] product;
  logic                 valid_p, ready_p;
  logic [W-1:0]         m_p;
  logic [3:0]           grid_p;
  multiplier #(.A_W(DIFFERENCE_W), .B_W(S_W)) u_product (
    .clk_i, .rst_ni, .valid_i(valid_d), .ready_o(ready_d), .a_i(difference_q), .b_i({1'b0, s_d}),
    .valid_o(valid_p), .ready_i(ready_p), .product_o(product)
  );
  pipe_delay #(.W(W + 4), .STAGES(PRODUCT_LATENCY)) u_beside (
    .clk_i, .rst_ni, .valid_i(valid_d), .ready_o(), .data_i({m_d, grid_d}),
    .valid_o(), .ready_i(ready_p), .data_o({m_p, grid_p})
  );

  // The step, on the grid: it and m add up to 32 bits again, between m and q.
  logic [W-1:0] step, step_q, m_s, morphed;
  logic         valid_s, ready_s, unused_bits;
  always_comb begin
    step = product[FRACTION_W +: W];
    for (int unsigned k = 0; k < lod_pkg::MAX_LEVELS; k++) begin
      if (grid_p > 4'(k)) step[k] = 1'b0;
    end
  end
  assign unused_bits = ^{product[PRODUCT_W-1:FRACTION_W+W], product[FRACTION_W-1:0]};
  pipe_stage #(.W(2 * W)) u_step (
    .clk_i, .rst_ni, .valid_i(valid_p), .ready_o(ready_p), .data_i({step, m_p}),
    .valid_o(valid_s), .ready_i(ready_s), .data_o({step_q, m_s})
  );
  assign morphed = m_s + step_q;
  pipe_stage #(.W(W)) u_out (
    .clk_i, .rst_ni, .valid_i(valid_s), .ready_o(ready_s), .data_i(morphed), .valid_o, .ready_i, .data_o(morphed_o)
  );

endmodule

`default_nettype wire
