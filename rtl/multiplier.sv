`default_nettype none

/// Elastic signed x signed multiplier of any widths: product_o = a_i * b_i, exact.
///
/// The factors are cut into limbs of 17 bits, unsigned but for the highest, which is signed and has up to 18 bits; each product of two limbs is one
/// 18 x 18 signed multiplier of the FPGA. The limb products are registered, then added: first along a, then along b, one tree level per stage.
/// FACTOR_STAGES registers of its own before the multipliers of the FPGA help where factors come from afar, and PRODUCT_STAGES, of which one is always
/// there, where products have a long way. LAST_IS_SKID makes the last register a `pipe_skid`, which cuts the chain of readies.
/// Legal: A_W, B_W, PRODUCT_STAGES >= 1. Latency: FACTOR_STAGES + PRODUCT_STAGES - 1 + lod_pkg::multiplier_latency(A_W, B_W); interval 1.
module multiplier #(
  parameter int unsigned A_W = 33,
  parameter int unsigned B_W = 33,
  parameter int unsigned FACTOR_STAGES = 0,
  parameter int unsigned PRODUCT_STAGES = 1,
  parameter bit LAST_IS_SKID = 1'b0
) (
  input  logic               clk_i,
  input  logic               rst_ni,
  input  logic               valid_i,
  output logic               ready_o,
  input  logic [A_W-1:0]     a_i,
  input  logic [B_W-1:0]     b_i,
  output logic               valid_o,
  input  logic               ready_i,
  output logic [A_W+B_W-1:0] product_o
);

  if (A_W < 1 || B_W < 1 || PRODUCT_STAGES < 1) begin : g_illegal_widths
    $error("multiplier: A_W = %0d, B_W = %0d, PRODUCT_STAGES = %0d, all must be at least 1", A_W, B_W, PRODUCT_STAGES);
  end

  localparam int unsigned LIMB_W = lod_pkg::MULTIPLIER_LIMB_W;
  localparam int unsigned A_LIMBS = lod_pkg::multiplier_limbs(A_W);
  localparam int unsigned B_LIMBS = lod_pkg::multiplier_limbs(B_W);
  // All limbs but the highest are unsigned: one bit more makes them signed.
  localparam int unsigned A_EXT_W = A_LIMBS * LIMB_W + 1;
  localparam int unsigned B_EXT_W = B_LIMBS * LIMB_W + 1;
  localparam int unsigned FACTOR_W = LIMB_W + 1;
  localparam int unsigned LIMB_PRODUCT_W = 2 * FACTOR_W;
  // A factor of n limbs is a signed number of 17 n + 1 bits.
  localparam int unsigned ROW_W = A_EXT_W + FACTOR_W;
  localparam int unsigned FULL_W = A_EXT_W + B_EXT_W;
  localparam int unsigned PRODUCT_W = A_W + B_W;
  localparam int unsigned LIMB_PRODUCTS_W = A_LIMBS * B_LIMBS * LIMB_PRODUCT_W;

  logic signed [A_W-1:0] a_near;
  logic signed [B_W-1:0] b_near;
  logic                  valid_factors, ready_factors;
  pipe_delay #(.W(A_W + B_W), .STAGES(FACTOR_STAGES)) u_factors (
    .clk_i, .rst_ni, .valid_i, .ready_o, .data_i({a_i, b_i}),
    .valid_o(valid_factors), .ready_i(ready_factors), .data_o({a_near, b_near})
  );

  logic signed [A_EXT_W-1:0] a;
  logic signed [B_EXT_W-1:0] b;
  assign a = A_EXT_W'(a_near);
  assign b = B_EXT_W'(b_near);

  logic [LIMB_PRODUCTS_W-1:0] limb_products, limb_products_q;
  logic                       valid_products, ready_products;

  for (genvar j = 0; j < B_LIMBS; j++) begin : g_row
    for (genvar i = 0; i < A_LIMBS; i++) begin : g_limb
      logic signed [FACTOR_W-1:0] x, y;
      // The highest limb takes its sign along; the others get a zero.
      assign x = {i == A_LIMBS - 1 && a[A_EXT_W-1], a[i*LIMB_W +: LIMB_W]};
      assign y = {j == B_LIMBS - 1 && b[B_EXT_W-1], b[j*LIMB_W +: LIMB_W]};
      assign limb_products[(j*A_LIMBS+i)*LIMB_PRODUCT_W +: LIMB_PRODUCT_W] = LIMB_PRODUCT_W'(x) * LIMB_PRODUCT_W'(y);
    end
  end

  pipe_delay #(.W(LIMB_PRODUCTS_W), .STAGES(PRODUCT_STAGES), .SKIDS(64'(LAST_IS_SKID && A_LIMBS * B_LIMBS == 1) << (PRODUCT_STAGES - 1))) u_products (
    .clk_i, .rst_ni, .valid_i(valid_factors), .ready_o(ready_factors), .data_i(limb_products),
    .valid_o(valid_products), .ready_i(ready_products), .data_o(limb_products_q)
  );

  // Rows: a times one limb of b each, in lockstep.
  logic [B_LIMBS-1:0]       valid_row, ready_row;
  logic [B_LIMBS*ROW_W-1:0] rows;
  logic                     valid_rows, ready_rows;
  for (genvar j = 0; j < B_LIMBS; j++) begin : g_row_sum
    limb_sum #(.N(A_LIMBS), .W(LIMB_PRODUCT_W), .STEP(LIMB_W), .LAST_IS_SKID(LAST_IS_SKID && B_LIMBS == 1)) u_row (
      .clk_i, .rst_ni, .valid_i(valid_products), .ready_o(ready_row[j]),
      .data_i(limb_products_q[j*A_LIMBS*LIMB_PRODUCT_W +: A_LIMBS*LIMB_PRODUCT_W]),
      .valid_o(valid_row[j]), .ready_i(ready_rows), .sum_o(rows[j*ROW_W +: ROW_W])
    );
  end
  assign ready_products = ready_row[0];
  assign valid_rows     = valid_row[0];
  if (B_LIMBS > 1) begin : g_lockstep
    logic unused_lockstep;
    assign unused_lockstep = ^{valid_row[B_LIMBS-1:1], ready_row[B_LIMBS-1:1]};
  end

  logic [FULL_W-1:0] full;
  limb_sum #(.N(B_LIMBS), .W(ROW_W), .STEP(LIMB_W), .LAST_IS_SKID(LAST_IS_SKID)) u_sum (
    .clk_i, .rst_ni, .valid_i(valid_rows), .ready_o(ready_rows), .data_i(rows),
    .valid_o, .ready_i, .sum_o(full)
  );

  // The upper limbs' room above the product only repeats its sign.
  assign product_o = full[PRODUCT_W-1:0];
  if (FULL_W > PRODUCT_W) begin : g_room
    logic [FULL_W-PRODUCT_W-1:0] unused_signs;
    assign unused_signs = full[FULL_W-1:PRODUCT_W];
  end

endmodule

`default_nettype wire
