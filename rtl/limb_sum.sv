`default_nettype none

/// Elastic adder tree over the limbs of a sum: `sum_o` = sum over k of data_i[k] * 2^(k STEP), each data_i[k] a signed number of W bits.
///
/// One level per stage: neighbours are added, of which the lower STEP bits pass by the adder; the rest of the tree is this module again, over half
/// as many numbers STEP bits wider. Legal: N >= 1, STEP < W, and each level's sums must fit W + STEP bits, as those of the limb products of one
/// multiplication do (a run of n limbs times an 18-bit limb: 17 n + 19 bits). Latency: clog2(N).
/// An odd number above 1 comes with hardware that leaves out low zeros (`Hardware::coordinate_zeros`). LAST_IS_SKID makes the last level's register a `pipe_skid`.
module limb_sum #(
  parameter int unsigned N = 2,
  parameter int unsigned W = 36,
  parameter int unsigned STEP = 17,
  parameter bit LAST_IS_SKID = 1'b0,
  localparam int unsigned SUM_W = W + (N - 1) * STEP
) (
  input  logic             clk_i,
  input  logic             rst_ni,
  input  logic             valid_i,
  output logic             ready_o,
  input  logic [N*W-1:0]   data_i,
  output logic             valid_o,
  input  logic             ready_i,
  output logic [SUM_W-1:0] sum_o
);

  if (N < 1) begin : g_illegal_n
    $error("limb_sum: N = %0d, must be at least 1", N);
  end
  if (STEP >= W) begin : g_illegal_step
    $error("limb_sum: STEP = %0d, must be below W = %0d", STEP, W);
  end

  if (N <= 1) begin : g_one
    assign valid_o = valid_i;
    assign ready_o = ready_i;
    assign sum_o   = data_i;

    logic unused_clocks;
    assign unused_clocks = clk_i ^ rst_ni;
  end else begin : g_level
    localparam int unsigned HALF = (N + 1) / 2;
    localparam int unsigned PAIR_W = W + STEP;
    localparam int unsigned REST_W = PAIR_W + (HALF - 1) * 2 * STEP;

    logic [HALF*PAIR_W-1:0] pairs, pairs_q;
    logic                   valid_q, ready_q;
    logic [REST_W-1:0]      rest;

    for (genvar k = 0; k < HALF; k++) begin : g_pair
      logic [W-1:0] low;
      assign low = data_i[2*k*W +: W];
      if (2 * k + 1 < N) begin : g_add
        logic [W-1:0] high, upper;
        assign high  = data_i[(2*k+1)*W +: W];
        assign upper = high + {{STEP{low[W-1]}}, low[W-1:STEP]};
        assign pairs[k*PAIR_W +: PAIR_W] = {upper, low[STEP-1:0]};
      end else begin : g_pass
        assign pairs[k*PAIR_W +: PAIR_W] = {{STEP{low[W-1]}}, low};
      end
    end

    pipe_delay #(.W(HALF * PAIR_W), .STAGES(1), .SKIDS(64'(LAST_IS_SKID && HALF == 1))) u_level (
      .clk_i, .rst_ni, .valid_i, .ready_o, .data_i(pairs),
      .valid_o(valid_q), .ready_i(ready_q), .data_o(pairs_q)
    );
    limb_sum #(.N(HALF), .W(PAIR_W), .STEP(2 * STEP), .LAST_IS_SKID(LAST_IS_SKID)) u_rest (
      .clk_i, .rst_ni, .valid_i(valid_q), .ready_o(ready_q), .data_i(pairs_q),
      .valid_o, .ready_i, .sum_o(rest)
    );

    // Without a last neighbour the top STEP bits repeat the sign.
    assign sum_o = rest[SUM_W-1:0];
    if (REST_W > SUM_W) begin : g_odd
      logic [REST_W-SUM_W-1:0] unused_signs;
      assign unused_signs = rest[REST_W-1:SUM_W];
    end
  end

endmodule

`default_nettype wire
