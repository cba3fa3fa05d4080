`default_nettype none

/// State of an edge with displacement bound h of which the ray tolerates D: how far it opens, 256 = 1.
///
/// s = 0 iff h <= D, s = 256 iff h >= 2 D (and h > D), else clamp(floor((h - D) 256 / D), 1, 255): there 0 < h - D < D, so that the quotient is the
/// 8 bits of a restoring division, one step per stage. open_o = (h > D) = (s != 0). Both come from the last register through a few gates.
/// Its first stage is a `pipe_skid`. Legal: any. Latency: lod_pkg::EDGE_OPENING_LATENCY; interval 1.
module edge_opening (
  input  logic                             clk_i,
  input  logic                             rst_ni,
  input  logic                             valid_i,
  output logic                             ready_o,
  input  logic [lod_pkg::BOUND_W-1:0]      h_i,
  input  logic [lod_pkg::TOLERANCE_W-1:0]  d_i,
  output logic                             open_o,
  output logic                             valid_o,
  input  logic                             ready_i,
  output logic [lod_pkg::EDGE_STATE_W-1:0] s_o
);

  localparam int unsigned D_W = lod_pkg::TOLERANCE_W;
  localparam int unsigned S_W = lod_pkg::EDGE_STATE_W;
  localparam int unsigned BITS = S_W - 1;
  if (lod_pkg::EDGE_OPENING_LATENCY != BITS + 1) begin : g_illegal_latency
    $error("edge_opening: lod_pkg::EDGE_OPENING_LATENCY must be %0d", BITS + 1);
  end

  // Stage 0 compares; stage k takes step k of the division.
  localparam int unsigned STATE_W = 2 + D_W + D_W + BITS;
  logic [BITS:0]              valid, ready;
  logic [BITS:0][STATE_W-1:0] state;

  logic [D_W-1:0] h, excess;
  assign h      = D_W'(h_i);
  assign excess = h - d_i;  // used where h > D
  pipe_skid #(.W(STATE_W)) u_compare (
    .clk_i, .rst_ni, .valid_i, .ready_o, .data_i({h > d_i, {1'b0, h} >= {d_i, 1'b0}, d_i, excess, {BITS{1'b0}}}),
    .valid_o(valid[0]), .ready_i(ready[0]), .data_o(state[0])
  );

  for (genvar k = 0; k < BITS; k++) begin : g_step
    logic            open, full, quotient_bit;
    logic [D_W-1:0]  divisor, remainder, remainder_next;
    logic [BITS-1:0] quotient;
    assign {open, full, divisor, remainder, quotient} = state[k];
    // Steps shift in from below; no bit has reached the top before the last one.
    logic unused_top;
    assign unused_top = quotient[BITS-1];
    divide_step #(.W(D_W)) u_step (
      .remainder_i(remainder), .odd_i({1'b0, divisor}), .quotient_o(quotient_bit), .remainder_o(remainder_next)
    );
    pipe_stage #(.W(STATE_W)) u_stage (
      .clk_i, .rst_ni, .valid_i(valid[k]), .ready_o(ready[k]),
      .data_i({open, full, divisor, remainder_next, quotient[BITS-2:0], quotient_bit}),
      .valid_o(valid[k+1]), .ready_i(ready[k+1]), .data_o(state[k+1])
    );
  end

  logic            open, full;
  logic [BITS-1:0] quotient;
  assign open        = state[BITS][STATE_W-1];
  assign full        = state[BITS][STATE_W-2];
  assign quotient    = state[BITS][BITS-1:0];
  assign valid_o     = valid[BITS];
  assign ready[BITS] = ready_i;
  assign open_o      = open;
  assign s_o         = !open ? '0 : full ? S_W'(lod_pkg::S_ONE) : quotient == 0 ? S_W'(1) : S_W'(quotient);

endmodule

`default_nettype wire
