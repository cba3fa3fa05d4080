`default_nettype none

/// The division of hits: quotient = floor(numerator * 2^32 / denominator), saturating at 35 bits. Twin of src/block/hit_divide.rs.
///
/// The quotient fits iff numerator < 8 denominator; it is then floor(2^35 numerator / (8 denominator)): one restoring step for each of 35 bits, from
/// the numerator as first remainder. Otherwise every bit is set. Legal: denominator > 0.
/// Latency and interval: HIT_DIVIDE_LATENCY, constant: one cycle to take the input, 35 steps. It holds one item.
module hit_divide #(
  parameter int unsigned TAG_W = 8
) (
  input  logic                     clk_i,
  input  logic                     rst_ni,
  input  logic                     valid_i,
  output logic                     ready_o,
  input  lod_pkg::hit_divide_in_t  in_i,
  input  logic [TAG_W-1:0]         tag_i,
  output logic                     valid_o,
  input  logic                     ready_i,
  output lod_pkg::hit_divide_out_t out_o,
  output logic [TAG_W-1:0]         tag_o
);

  localparam int unsigned QUOTIENT_W = lod_pkg::RAY_T_W;
  // 2^35 = 8 * 2^32.
  localparam int unsigned WHOLE_W = QUOTIENT_W - 32;
  // 8 denominator, and with it every remainder.
  localparam int unsigned DIVISOR_W = lod_pkg::EDGE_FUNCTION_W + WHOLE_W;
  localparam int unsigned STEP_W = $clog2(QUOTIENT_W + 1);

  if (lod_pkg::T_NUMERATOR_W > DIVISOR_W) begin : g_illegal_width
    $error("hit_divide: a numerator of %0d bits does not fit the remainder's %0d", lod_pkg::T_NUMERATOR_W, DIVISOR_W);
  end
  if (lod_pkg::HIT_DIVIDE_LATENCY != QUOTIENT_W + 1 || lod_pkg::HIT_DIVIDE_INTERVAL != QUOTIENT_W + 1) begin : g_illegal_timing
    $error("hit_divide: lod_pkg::HIT_DIVIDE_LATENCY and HIT_DIVIDE_INTERVAL must be %0d", QUOTIENT_W + 1);
  end

  logic                  busy_q, stepping;
  logic [STEP_W-1:0]     steps_left_q;
  logic [DIVISOR_W-1:0]  remainder_q, divisor_q, remainder;
  logic                  saturated_q, quotient_bit;
  logic [QUOTIENT_W-1:0] quotient_q;
  logic [TAG_W-1:0]      tag_q;

  assign stepping = busy_q && steps_left_q != 0;
  assign valid_o  = busy_q && steps_left_q == 0;
  assign ready_o  = !busy_q || (valid_o && ready_i);
  assign out_o    = quotient_q;
  assign tag_o    = tag_q;

  divide_step #(.W(DIVISOR_W)) u_step (
    .remainder_i(remainder_q), .divisor_i(divisor_q), .quotient_bit_o(quotient_bit), .remainder_o(remainder)
  );

  always_ff @(posedge clk_i) begin
    if (!rst_ni) begin
      busy_q       <= 1'b0;
      steps_left_q <= '0;
    end else if (ready_o) begin
      busy_q       <= valid_i;
      steps_left_q <= STEP_W'(QUOTIENT_W);
    end else if (stepping) begin
      steps_left_q <= steps_left_q - 1;
    end
  end

  always_ff @(posedge clk_i) begin
    if (ready_o && valid_i) begin
      remainder_q <= DIVISOR_W'(in_i.numerator);
      divisor_q   <= {in_i.denominator, {WHOLE_W{1'b0}}};
      saturated_q <= in_i.numerator[lod_pkg::T_NUMERATOR_W-1:WHOLE_W] >= in_i.denominator;
      tag_q       <= tag_i;
    end else if (stepping) begin
      remainder_q <= remainder;
      quotient_q  <= {quotient_q[QUOTIENT_W-2:0], quotient_bit || saturated_q};
    end
  end

endmodule

`default_nettype wire
