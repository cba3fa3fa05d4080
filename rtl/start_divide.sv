`default_nettype none

/// The division of hits of rays from exact starts: quotient = floor((numerator + low / 2^31) * 2^32 / denominator), saturating at 35 bits. Twin of
/// src/block/start_divide.rs.
///
/// As hit_divide, but that each step brings down the next DIVIDE_BITS bits of low where that brings down zeros. The divisor is 2^ZEROS denominator, so that many of the lowest bits of what a step
/// subtracts from are not touched, and as it brings down no more of them, they take no part in its choice: they are put to the remainder behind it. Legal: denominator > 0, DIVIDE_BITS 1 to 3.
/// Latency and interval are constant: one cycle to take the input and the divisor's multiples, then the steps for 35 bits: 35, 18 or 12. It holds one item.
/// With lod_pkg::DIVIDE_BITS they are START_DIVIDE_LATENCY.
module start_divide #(
  parameter int unsigned TAG_W = 8,
  parameter int unsigned DIVIDE_BITS = lod_pkg::DIVIDE_BITS
) (
  input  logic                     clk_i,
  input  logic                     rst_ni,
  input  logic                     valid_i,
  output logic                     ready_o,
  input  lod_pkg::start_divide_in_t in_i,
  input  logic [TAG_W-1:0]         tag_i,
  output logic                     valid_o,
  input  logic                     ready_i,
  output lod_pkg::hit_divide_out_t out_o,
  output logic [TAG_W-1:0]         tag_o
);

  localparam int unsigned QUOTIENT_W = lod_pkg::RAY_T_W;
  // 2^35 = 8 * 2^32.
  localparam int unsigned WHOLE_W = QUOTIENT_W - 32;
  localparam int unsigned STEPS = (QUOTIENT_W + DIVIDE_BITS - 1) / DIVIDE_BITS;
  // What the steps give beyond the quotient: bits that are 0 above it, as the divisor is larger by as many.
  localparam int unsigned SPARE_W = STEPS * DIVIDE_BITS - QUOTIENT_W;
  localparam int unsigned ZEROS = WHOLE_W + SPARE_W;
  // 8 denominator or 16, and with it every remainder.
  localparam int unsigned DIVISOR_W = lod_pkg::EDGE_FUNCTION_W + ZEROS;
  // Of a multiple of the denominator.
  localparam int unsigned MULTIPLE_W = lod_pkg::EDGE_FUNCTION_W + DIVIDE_BITS;
  localparam int unsigned ODDS = 2**(DIVIDE_BITS-1);
  localparam int unsigned LOW_W = lod_pkg::FRACTION_W;
  localparam int unsigned STEP_W = $clog2(STEPS + 1);

  if (lod_pkg::T_NUMERATOR_W > DIVISOR_W) begin : g_illegal_width
    $error("start_divide: a numerator of %0d bits does not fit the remainder's %0d", lod_pkg::T_NUMERATOR_W, DIVISOR_W);
  end
  if (DIVIDE_BITS > ZEROS) begin : g_illegal_bits
    $error("start_divide: steps of %0d bits reach above the divisor's %0d zeros", DIVIDE_BITS, ZEROS);
  end
  if (DIVIDE_BITS == lod_pkg::DIVIDE_BITS && (lod_pkg::START_DIVIDE_LATENCY != STEPS + 1 || lod_pkg::START_DIVIDE_INTERVAL != STEPS + 1)) begin : g_illegal_timing
    $error("start_divide: lod_pkg::START_DIVIDE_LATENCY and START_DIVIDE_INTERVAL must be %0d", STEPS + 1);
  end

  logic                            busy_q, stepping;
  logic [STEP_W-1:0]               steps_left_q;
  logic [DIVISOR_W-1:0]            remainder_q, remainder;
  logic [ODDS-1:0][MULTIPLE_W-1:0] odd, odd_q;
  logic [LOW_W-1:0]                low_q;
  logic                            saturated_q;
  logic [DIVIDE_BITS-1:0]          digit;
  logic [QUOTIENT_W-1:0]           quotient_q;
  logic [TAG_W-1:0]                tag_q;

  assign stepping = busy_q && steps_left_q != 0;
  assign valid_o  = busy_q && steps_left_q == 0;
  assign ready_o  = !busy_q || (valid_o && ready_i);
  assign out_o    = quotient_q;
  assign tag_o    = tag_q;

  divide_multiples #(.W(lod_pkg::EDGE_FUNCTION_W), .BITS(DIVIDE_BITS)) u_multiples (.divisor_i(in_i.denominator), .odd_o(odd));

  logic [ODDS-1:0][DIVISOR_W+DIVIDE_BITS-1:0] odd_divisor;
  for (genvar k = 0; k < ODDS; k++) begin : g_odd
    assign odd_divisor[k] = {odd_q[k], {ZEROS{1'b0}}};
  end
  divide_step #(.W(DIVISOR_W), .BITS(DIVIDE_BITS)) u_step (
    .remainder_i(remainder_q), .odd_i(odd_divisor), .quotient_o(digit), .remainder_o(remainder)
  );

  always_ff @(posedge clk_i) begin
    if (!rst_ni) begin
      busy_q       <= 1'b0;
      steps_left_q <= '0;
    end else if (ready_o) begin
      busy_q       <= valid_i;
      steps_left_q <= STEP_W'(STEPS);
    end else if (stepping) begin
      steps_left_q <= steps_left_q - 1;
    end
  end

  always_ff @(posedge clk_i) begin
    if (ready_o && valid_i) begin
      remainder_q <= DIVISOR_W'(in_i.numerator);
      low_q       <= in_i.low;
      odd_q       <= odd;
      saturated_q <= in_i.numerator[lod_pkg::T_NUMERATOR_W-1:WHOLE_W] >= in_i.denominator;
      tag_q       <= tag_i;
    end else if (stepping) begin
      remainder_q <= remainder | DIVISOR_W'(low_q[LOW_W-1 -: DIVIDE_BITS]);
      low_q       <= low_q << DIVIDE_BITS;
      quotient_q  <= {quotient_q[QUOTIENT_W-DIVIDE_BITS-1:0], digit | {DIVIDE_BITS{saturated_q}}};
    end
  end

endmodule

`default_nettype wire
