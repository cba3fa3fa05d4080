`default_nettype none

/// The displacement that a ray cone tolerates at distance l along the ray: D = clamp(floor((offset + l slope) / 2^shift), 0, 2^34 - 1).
///
/// slope - 2^17 is a signed number of 18 bits, one limb of a multiplier: offset + l slope = (offset + l 2^17) + l (slope - 2^17).
/// Legal: any. Latency: lod_pkg::CONE_TOLERANCE_LATENCY; interval 1.
module cone_tolerance (
  input  logic                            clk_i,
  input  logic                            rst_ni,
  input  logic                            valid_i,
  output logic                            ready_o,
  input  logic [lod_pkg::DISTANCE_W-1:0]  l_i,
  input  lod_pkg::cone_t                  cone_i,
  output logic                            valid_o,
  input  logic                            ready_i,
  output logic [lod_pkg::TOLERANCE_W-1:0] d_o
);

  localparam int unsigned L_W = lod_pkg::DISTANCE_W;
  localparam int unsigned D_W = lod_pkg::TOLERANCE_W;
  localparam int unsigned SLOPE_W = 18;
  localparam int unsigned SHIFT_W = 6;
  // l slope: 52 bits signed; with the 53 bits unsigned of offset: 55 signed. offset + l 2^17: the same.
  localparam int unsigned SUM_W = 55;
  localparam int unsigned FACTOR_STAGES = 1;
  localparam int unsigned PRODUCT_LATENCY = FACTOR_STAGES + lod_pkg::multiplier_latency(L_W, SLOPE_W);
  if (lod_pkg::CONE_TOLERANCE_LATENCY != PRODUCT_LATENCY + 4) begin : g_illegal_latency
    $error("cone_tolerance: lod_pkg::CONE_TOLERANCE_LATENCY must be %0d", PRODUCT_LATENCY + 4);
  end

  // l (slope - 2^17), and offset + l 2^17 beside it.
  logic signed [L_W+SLOPE_W-1:0] product;
  logic                          valid_product, ready_product;
  multiplier #(.A_W(L_W), .B_W(SLOPE_W), .FACTOR_STAGES(FACTOR_STAGES)) u_product (
    .clk_i, .rst_ni, .valid_i, .ready_o, .a_i(l_i), .b_i({!cone_i.slope[SLOPE_W-1], cone_i.slope[SLOPE_W-2:0]}),
    .valid_o(valid_product), .ready_i(ready_product), .product_o(product)
  );
  logic signed [L_W-1:0] l;
  logic [SUM_W-1:0]      base, base_q;
  logic [SHIFT_W-1:0]    shift_base_q;
  assign l    = l_i;
  assign base = SUM_W'(cone_i.offset) + (SUM_W'(l) << (SLOPE_W - 1));
  pipe_delay #(.W(SUM_W + SHIFT_W), .STAGES(PRODUCT_LATENCY)) u_base (
    .clk_i, .rst_ni, .valid_i, .ready_o(), .data_i({base, cone_i.shift}),
    .valid_o(), .ready_i(ready_product), .data_o({base_q, shift_base_q})
  );

  logic signed [SUM_W-1:0]   sum, sum_q;
  logic        [SHIFT_W-1:0] shift_sum_q;
  logic                      valid_sum, ready_sum;
  assign sum = base_q + SUM_W'(product);
  pipe_stage #(.W(SUM_W + SHIFT_W)) u_sum (
    .clk_i, .rst_ni, .valid_i(valid_product), .ready_o(ready_product), .data_i({sum, shift_base_q}),
    .valid_o(valid_sum), .ready_i(ready_sum), .data_o({sum_q, shift_sum_q})
  );

  // The shift, coarse then fine.
  localparam int unsigned FINE_W = 4;
  logic signed [SUM_W-1:0]  coarse, coarse_q, fine, fine_q;
  logic        [FINE_W-1:0] shift_coarse_q;
  logic                     valid_coarse, ready_coarse, valid_fine, ready_fine;
  assign coarse = sum_q >>> {shift_sum_q[SHIFT_W-1:FINE_W], {FINE_W{1'b0}}};
  pipe_stage #(.W(SUM_W + FINE_W)) u_coarse (
    .clk_i, .rst_ni, .valid_i(valid_sum), .ready_o(ready_sum), .data_i({coarse, shift_sum_q[FINE_W-1:0]}),
    .valid_o(valid_coarse), .ready_i(ready_coarse), .data_o({coarse_q, shift_coarse_q})
  );
  assign fine = coarse_q >>> shift_coarse_q;
  pipe_stage #(.W(SUM_W)) u_fine (
    .clk_i, .rst_ni, .valid_i(valid_coarse), .ready_o(ready_coarse), .data_i(fine),
    .valid_o(valid_fine), .ready_i(ready_fine), .data_o(fine_q)
  );

  logic [D_W-1:0] d;
  assign d = fine_q[SUM_W-1] ? '0 : fine_q[SUM_W-2:D_W] != 0 ? '1 : fine_q[D_W-1:0];
  pipe_stage #(.W(D_W)) u_clamp (
    .clk_i, .rst_ni, .valid_i(valid_fine), .ready_o(ready_fine), .data_i(d), .valid_o, .ready_i, .data_o(d_o)
  );

endmodule

`default_nettype wire
